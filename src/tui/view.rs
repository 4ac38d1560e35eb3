//! Draws the screen from the state.

pub(crate) mod status;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;

use super::app::App;
use super::ascii;
use super::header;
use super::layout::{self, SMALLEST};
use super::pane::Pane;
use super::panes::chart::{Charts, panels};
use super::panes::form::{self, Form};
use super::panes::results::{self, Results};
use super::panes::study::{self, StudyPane};
use super::panes::teeth;
use super::panes::trade::{self, TradePane};

use super::text;

/// Draws the whole screen. Returns the position of the text cursor, if any.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let cursor = if layout::is_too_small(area.as_size()) {
        too_small(area, buffer);
        None
    } else {
        draw_panes(app, area, buffer)
    };
    ascii::finish(buffer, app.look.ascii);
    cursor.filter(|&cursor| area.contains(cursor))
}

// Shows the longest message that fits.
fn too_small(area: Rect, buffer: &mut Buffer) {
    let needed = format!("{}x{}", SMALLEST.width, SMALLEST.height);
    let needs = format!("tipstrike needs {needed};");
    let this = format!("this is {}x{}.", area.width, area.height);
    let width = usize::from(area.width);
    let sayings = [
        vec![needs, this, "Nothing is lost.".to_owned()],
        vec![format!("needs {needed}")],
        vec![needed],
    ];
    let wrapped = |lines: &Vec<String>| {
        lines.iter().flat_map(|line| text::wrap(line, width)).collect::<Vec<_>>()
    };
    let is_whole = |lines: &Vec<String>| {
        lines.iter().flat_map(|line| line.split(' ')).all(|word| word.len() <= width)
    };
    let fits =
        |lines: &&Vec<String>| is_whole(lines) && wrapped(lines).len() <= usize::from(area.height);
    let lines = sayings.iter().find(fits).or(sayings.last()).map(wrapped).unwrap_or_default();
    for (line, y) in lines.iter().zip(area.top()..area.bottom()) {
        buffer.set_stringn(area.x, y, line, area.width.into(), Style::new());
    }
}

fn draw_panes(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let plan = app.layout.plan_on(area.as_size());
    header::draw(app, plan.header, buffer);
    let in_form = form::draw(&Form { area: plan.form, ..app.form() }, buffer);
    for pane in Pane::ALL {
        let area = plan.area(pane);
        if !area.is_empty() {
            draw_pane(app, pane, area, buffer);
        }
    }
    status::hint(app, plan.hint, buffer);
    status::keys(app, plan.keys, buffer);
    match app.prompts.last() {
        Some(prompt) => prompt.dialog().draw(&app.surroundings(), area, buffer),
        None => in_form,
    }
}

fn draw_pane(app: &App, pane: Pane, area: Rect, buffer: &mut Buffer) {
    match pane {
        Pane::Form => (),
        Pane::Results => {
            let results = app.results();
            results::draw(&Results { area, ..results }, buffer);
        }
        Pane::Chart => draw_charts(app, area, buffer),
        Pane::Teeth => draw_teeth(app, area, buffer),
        Pane::Trade => {
            let trade = app.trade();
            trade::draw(&TradePane { area, ..trade }, buffer);
        }
        Pane::Study => {
            let study = app.study();
            study::draw(&StudyPane { area, ..study }, buffer);
        }
    }
}

fn draw_charts(app: &App, area: Rect, buffer: &mut Buffer) {
    let (title, charts) = (app.title(Pane::Chart), app.charts());
    let charts = Charts { area, ..charts };
    let words = panels::first_title(&charts, title.room(area.width));
    title.draw(&words, area, buffer);
    panels::draw(&charts, buffer);
}

fn draw_teeth(app: &App, area: Rect, buffer: &mut Buffer) {
    let stale = if app.tab.shows_last_valid() { "LAST VALID, " } else { "" };
    let centre = app.teeth.centre.name();
    let words = format!("{stale}Teeth, true to scale, around {centre}");
    let inner = app.title(Pane::Teeth).draw(&words, area, buffer);
    if let Some(picture) = app.picture() {
        teeth::draw(&picture, inner, buffer);
    } else {
        let message = if app.tab.answer.is_some() {
            "  This method has no valid results."
        } else {
            "  No results yet."
        };
        buffer.set_stringn(inner.x, inner.y, message, inner.width.into(), Style::new());
    }
}
