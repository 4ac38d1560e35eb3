//! The file browser: a folder on the left, the recent cases below it, the preview of the selected
//! line on the right.

use std::path::Path;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;

use super::picker::Pick;
use super::{Dialog, Outcome, Surroundings, boxes, digest};
use crate::case::units::System;
use crate::tui::actions::{Action, Effect};
use crate::tui::jobs::Job;
use crate::tui::keys::Place;
use crate::tui::line::Line as Text;
use crate::tui::store::preview::{Preview, Viewport};
use crate::tui::text;
use crate::tui::theme::Theme;

mod state;

pub(crate) use state::Browser;
use state::Line;

/// The full width, and a limited number of lines.
const SIZE: Size = Size { width: u16::MAX, height: 34 };
/// Number of visible recent cases.
const RECENTS: usize = 6;

impl Browser {
    /// The job that lists the folder.
    #[must_use]
    pub(crate) fn list(&self) -> Effect {
        let (base, typed) = self.asks();
        Effect::Job(Job::Folder(base, typed))
    }

    /// Enters the selected folder, or writes the selected name into the line.
    pub(crate) fn complete(&mut self) -> Vec<Effect> {
        match self.marked_sight() {
            Some(Viewport::Folder(folder)) => {
                self.enter(folder);
                return vec![self.list()];
            }
            Some(Viewport::File(path)) => self.input = path.display().to_string().into(),
            Some(Viewport::Example(example)) => self.input = example.name.into(),
            None => return Vec::new(),
        }
        self.typed()
    }
}

impl Dialog for Browser {
    fn place(&self) -> Place {
        Place::BROWSE
    }

    fn input(&mut self) -> Option<&mut Text> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Effect> {
        let list = self.follow().then(|| self.list());
        let below = self.seek();
        let below = below.map(|(base, typed)| Effect::Job(Job::Search(base, typed)));
        list.into_iter().chain(below).collect()
    }

    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        self.mark(by);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        self.mark(by * boxes::page_height(around.screen));
    }

    fn click(&mut self, at: Position, screen: Size) -> bool {
        line_at(self, screen, at).is_some_and(|line| boxes::select(&mut self.marked, line))
    }

    // Without a match, opens the typed path.
    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        match self.marked_sight() {
            Some(Viewport::Folder(_)) => Outcome::Effects(self.complete()),
            Some(Viewport::File(path)) => Outcome::Open(path),
            Some(Viewport::Example(example)) => Outcome::Pick(Pick::Begin(example)),
            None if self.input.value().is_empty() => Outcome::none(),
            None => Outcome::Open(self.typed_path()),
        }
    }

    fn receive(&mut self, result: Action) {
        match result {
            Action::Listed(listing) => self.take(*listing),
            Action::Found(below) => self.take_below(*below),
            Action::Previewed(sight, preview) => self.show(sight, *preview),
            Action::Recents(recents) => self.remember(recents),
            _ => (),
        }
    }

    fn preview(&mut self, units: System) -> Option<Effect> {
        Some(Effect::Job(Job::Preview(self.look()?, units)))
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw(self, area, around.look.theme, buffer)
    }
}

fn draw(browser: &Browser, screen: Rect, theme: &Theme, buffer: &mut Buffer) -> Option<Position> {
    let inner = boxes::frame("Open a case", SIZE, screen, theme, buffer);
    let folder = browser
        .listing
        .as_ref()
        .map_or_else(String::new, |listing| listing.folder.display().to_string());
    let width = usize::from(inner.width);
    buffer.set_stringn(inner.x, inner.y, text::cut_front(&folder, width), width, theme.title);
    let body = below_line(inner);
    let (left, right) = boxes::halves(body, buffer);
    draw_lists(browser, left, theme, buffer);
    draw_preview(browser, right, theme, buffer);
    let line = Rect { y: inner.y + 1, height: inner.height.saturating_sub(1).min(1), ..inner };
    if browser.input.value().is_empty() {
        buffer.set_stringn(
            line.x + 1,
            line.y,
            " type part of a name or a path; ~ is the home folder",
            width - 1,
            theme.faint,
        );
    }
    text::edited(&browser.input, line, theme.focus, buffer)
}

// The index of the line of the lists at a cell, if any.
fn line_at(browser: &Browser, screen: Size, at: Position) -> Option<usize> {
    let inner = boxes::inside(SIZE, Rect::from((Position::ORIGIN, screen)));
    let (above, below) = stacked(browser, boxes::parted(below_line(inner)).0);
    let first = browser.count_of_folder();
    let in_folder =
        boxes::line_at(first, Some(browser.marked).filter(|&marked| marked < first), above, at);
    let recents = Rect { y: below.y + 1, height: below.height.saturating_sub(1), ..below };
    let recent = || {
        boxes::line_at(browser.count_of_recents(), browser.marked.checked_sub(first), recents, at)
    };
    in_folder.or_else(|| recent().map(|line| first + line))
}

fn below_line(inner: Rect) -> Rect {
    Rect { y: inner.y + 2, height: inner.height.saturating_sub(2), ..inner }
}

// Splits an area into the folder and, below it, the recent cases with their title, if any.
fn stacked(browser: &Browser, area: Rect) -> (Rect, Rect) {
    let recents = browser.count_of_recents().min(RECENTS).min(usize::from(area.height) / 3);
    let height = if recents == 0 { 0 } else { recents as u16 + 1 };
    let above = Rect { height: area.height - height, ..area };
    (above, Rect { y: above.bottom(), height, ..area })
}

fn draw_lists(browser: &Browser, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let (above, below) = stacked(browser, area);
    draw_folder(browser, above, theme, buffer);
    if !below.is_empty() {
        let area = text::titled("Recent cases", below, theme, buffer);
        let first = browser.count_of_folder();
        let name = |at: usize| line_of(browser, first + at);
        let marked = browser.marked.checked_sub(first);
        boxes::draw_window(browser.count_of_recents(), name, marked, area, theme, buffer);
    }
}

fn draw_folder(browser: &Browser, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let count = browser.count_of_folder();
    let marked = Some(browser.marked).filter(|&marked| marked < count);
    let room = usize::from(area.width).saturating_sub(2);
    let line = |at: usize| match browser.line(at) {
        Some(Line::Found(case)) => text::cut_front(&case.name, room),
        _ => line_of(browser, at),
    };
    boxes::draw_window(count, line, marked, area, theme, buffer);
    let said = match &browser.listing {
        None => "reading ...",
        Some(listing) => match &listing.entries {
            Err(reason) => reason,
            Ok(_) if listing.is_cut => "The list is not complete.",
            Ok(entries) if entries.is_empty() => "No folders and no *.toml here.",
            Ok(_) if count == 0 && browser.is_seeking() => "Searching below ...",
            Ok(_) if count == 0 => "No match here or below.",
            Ok(_) => return,
        },
    };
    let from = area.y + u16::try_from(count).unwrap_or(u16::MAX).min(area.height.saturating_sub(3));
    for (line, y) in text::wrap(said, area.width.into()).iter().zip(from..area.bottom()) {
        buffer.set_stringn(
            area.x,
            y,
            format!("{line:<0$}", usize::from(area.width)),
            area.width.into(),
            theme.note,
        );
    }
}

fn line_of(browser: &Browser, at: usize) -> String {
    match browser.line(at) {
        None => String::new(),
        Some(Line::Up) => "../".to_owned(),
        Some(Line::Entry(entry)) if entry.is_folder => format!("{}/", entry.name),
        Some(Line::Entry(entry)) => entry.name.clone(),
        Some(Line::Found(case)) => case.name.clone(),
        Some(Line::Example(example)) => format!("{}  (example)", example.name),
        Some(Line::Recent(recent)) => {
            let name = recent
                .path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned())
                .unwrap_or_default();
            let folder = recent
                .path
                .parent()
                .and_then(Path::file_name)
                .map(|name| name.to_string_lossy().into_owned());
            let missing = if recent.is_missing { "  (missing)" } else { "" };
            let folder = folder.map_or_else(String::new, |folder| format!("  in {folder}/"));
            format!("{name}{missing}{folder}")
        }
    }
}

fn draw_preview(browser: &Browser, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let Some(sight) = browser.marked_sight() else {
        return;
    };
    let is_missing =
        matches!(browser.line(browser.marked), Some(Line::Recent(recent)) if recent.is_missing);
    let preview =
        browser.preview.as_ref().filter(|(own, _)| *own == sight).map(|(_, preview)| preview);
    let mut lines = Vec::new();
    if let (Viewport::File(path), true) = (&sight, browser.marks_recent()) {
        lines.push((text::cut_front(&path.display().to_string(), area.width.into()), theme.faint));
    }
    match preview {
        _ if is_missing => {
            lines.push(("The file does not exist any more.".to_owned(), theme.problem));
        }
        None => lines.push(("reading ...".to_owned(), theme.faint)),
        Some(preview) => lines.extend(lines_of(preview, area.width.into(), theme)),
    }
    for ((line, style), y) in lines.iter().zip(area.top()..area.bottom()) {
        buffer.set_stringn(area.x, y, line, area.width.into(), *style);
    }
}

fn lines_of(preview: &Preview, width: usize, theme: &Theme) -> Vec<(String, Style)> {
    match preview {
        Preview::Case(case, is_newer) => {
            let newer =
                is_newer.then(|| ("Newer format: opens read-only.".to_owned(), theme.problem));
            newer.into_iter().chain(digest::lines(case, width, theme)).collect()
        }
        Preview::Folder(cases, folders) => {
            let counted = |count: usize, one: &str| {
                if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") }
            };
            vec![(
                format!(
                    "A folder with {}, {}.",
                    counted(*cases, "case"),
                    counted(*folders, "folder")
                ),
                Style::new(),
            )]
        }
        Preview::Draft(fields) => {
            let head = text::wrap("Required values are missing:", width)
                .into_iter()
                .map(|line| (line, theme.note));
            let fields = fields.iter().map(|field| (text::cut(field, width), Style::new()));
            head.chain(fields).collect()
        }
        Preview::Faults(faults, more) => {
            let head = text::wrap("It cannot be opened:", width)
                .into_iter()
                .map(|line| (line, theme.problem));
            let faults = faults
                .iter()
                .flat_map(|fault| text::wrap(fault, width))
                .map(|line| (line, Style::new()));
            let more = (*more > 0).then(|| (format!("and {more} more"), Style::new()));
            head.chain(faults).chain(more).collect()
        }
    }
}
