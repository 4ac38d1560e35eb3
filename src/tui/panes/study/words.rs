//! The words of the study pane: its title, the values at the cursor, the refused points.

use unicode_width::UnicodeWidthStr;

use super::{StudyPane, axes, cursor, quantity};
use crate::case::FIELDS;
use crate::model::Outcome;
use crate::model::inputs::Method;
use crate::report::{shown_in, unit_beside};
use crate::study::axis::Axis;
use crate::study::batch::PointOutcome;
use crate::study::refusals::Refused;
use crate::tui::ascii::symbol;
use crate::tui::study::{End, Layer, LayerFound, Question, Shown, Whose};
use crate::tui::text;

/// The title in a room of that width.
pub(super) fn title(pane: &StudyPane<'_>, room: usize) -> String {
    let Some(shown) = pane
        .study
        .shown
        .as_ref()
        .filter(|_| pane.study.obstacle.is_none())
    else {
        return "Study".to_owned();
    };
    let state = progress(shown);
    let words = match &shown.request.question {
        Question::Tolerance(_) => vec!["Tolerance".to_owned()],
        Question::Grid(grid) => {
            let fields = |label: fn(&Axis) -> String| -> Vec<String> {
                grid.axes.iter().rev().map(label).collect()
            };
            let name = quantity(shown).map_or("", |known| known.symbol);
            let label = quantity(shown).map_or("", |known| known.label);
            let unit = quantity(shown).map_or("", |known| {
                let values = shown
                    .layers
                    .iter()
                    .flat_map(|found| found.values.iter().flatten());
                unit_beside(known, values.copied(), pane.units)
            });
            let unit = if unit == "1" { "" } else { unit };
            let unit = if unit.is_empty() {
                String::new()
            } else {
                format!(" in {unit}")
            };
            let long =
                fields(|axis| format!("{}{}", FIELDS[axis.field].full_label(), in_unit(axis)));
            let short = fields(|axis| format!("{}{}", FIELDS[axis.field].symbol, in_unit(axis)));
            vec![
                format!("Study: {name} {label}{unit} over {}", long.join(" and ")),
                format!("Study: {name}{unit} over {}", long.join(" and ")),
                format!("Study: {name}{unit} over {}", short.join(" and ")),
                format!("{name}{unit} over {}", short.join(" and ")),
            ]
        }
    };
    let all = words.iter().map(|words| format!("{words}{state}"));
    let all: Vec<String> = all
        .map(|words| symbol(&words, pane.look.ascii).into_owned())
        .collect();
    let fits = all.iter().find(|words| words.width() <= room);
    fits.cloned()
        .unwrap_or_else(|| text::cut(all.last().map_or("Study", String::as_str), room))
}

fn in_unit(axis: &Axis) -> String {
    if axis.unit.is_empty() {
        String::new()
    } else {
        format!(" in {}", axis.unit)
    }
}

/// How far an unfinished study is.
fn progress(shown: &Shown) -> String {
    match (&shown.end, &shown.request.question) {
        (Some(End::Whole), _) => String::new(),
        (Some(End::Stopped), _) => ", stopped".to_owned(),
        (Some(End::Failed(_)), _) => ", failed".to_owned(),
        (None, Question::Tolerance(_)) => format!(", {:.0} % solved", 100.0 * shown.part),
        (None, Question::Grid(grid)) => {
            let points: usize = grid.axes.iter().map(|axis| axis.points.len()).product();
            let solved: usize = shown.layers.iter().map(|found| found.outcomes.len()).sum();
            let all = (points * grid.layers.len()).max(1);
            format!(", {:.0} % solved", 100.0 * solved as f64 / all as f64)
        }
    }
}

/// The lines below the plot: the values at the cursor, then the refused points.
pub(super) fn below(pane: &StudyPane<'_>, shown: &Shown, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(End::Failed(reason)) = &shown.end {
        lines.extend(text::wrap(reason, width));
    }
    let line = at_cursor(pane, shown);
    lines.push(text::cut(&symbol(&line, pane.look.ascii), width));
    lines.extend(refused(shown).map(|line| text::cut(&line, width)));
    lines
}

/// The varied values at the cursor, and the value of each curve.
pub(super) fn at_cursor(pane: &StudyPane<'_>, shown: &Shown) -> String {
    let Question::Grid(grid) = &shown.request.question else {
        return String::new();
    };
    let (across, up) = axes(shown);
    let (x, y) = cursor(pane, shown);
    let width = across.map_or(0, |axis| axis.points.len());
    let setting = |axis: &Axis, at: usize| {
        let known = &FIELDS[axis.field];
        let name = if known.symbol.is_empty() {
            known.label
        } else {
            known.symbol
        };
        format!("{name} = {}", axis.with_unit(at))
    };
    let first = across.map(|axis| setting(axis, x));
    let settings: Vec<String> = first
        .into_iter()
        .chain(up.map(|axis| setting(axis, y)))
        .collect();
    let values: Vec<String> = grid
        .layers
        .iter()
        .zip(&shown.layers)
        .filter_map(|(layer, found)| value(pane, layer, found, y * width + x))
        .collect();
    format!("{}: {}", settings.join(", "), values.join(", "))
}

fn value(pane: &StudyPane<'_>, layer: &Layer, found: &LayerFound, at: usize) -> Option<String> {
    let name = match layer.whose {
        Whose::Active(Method::Auto) => "auto",
        Whose::Active(method) | Whose::Other(method) => method.name(),
        Whose::Baseline => "baseline",
    };
    let known = layer.quantity()?;
    let words = match (found.outcomes.get(at)?, found.values.get(at)?) {
        (_, Some(value)) => format!("{} {}", known.symbol, shown_in(known, *value, pane.units)),
        (PointOutcome::Refused, None) => "refused".to_owned(),
        (PointOutcome::Solved(Outcome::NoCornerContact), None) => "no contact".to_owned(),
        (PointOutcome::Solved(_), None) => "no value".to_owned(),
    };
    Some(format!("{name} {words}"))
}

/// The refused points of the first curve that has some: how many, and why.
fn refused(shown: &Shown) -> impl Iterator<Item = String> {
    let found = shown.layers.iter().find(|found| found.refusals.total() > 0);
    let refused = found
        .map(|found| found.refusals.0.clone())
        .unwrap_or_default();
    refused.into_iter().map(|refused| {
        let Refused { count, problem, .. } = &refused;
        let points = if *count == 1 { "point" } else { "points" };
        format!(
            "{count} {points} refused: {}: {}",
            problem.cause, problem.fix
        )
    })
}

/// The hint line while the pane has the focus.
pub(super) fn hint(pane: &StudyPane<'_>) -> String {
    const KEYS: &str = "h, l move the cursor, + and - zoom, Enter uses the value, s adds a second field, d shows the tolerance.";
    let shown = pane
        .study
        .shown
        .as_ref()
        .filter(|_| pane.study.obstacle.is_none());
    match shown.map(|shown| (shown, &shown.request.question)) {
        Some((shown, Question::Grid(_))) => format!("{}. {KEYS}", at_cursor(pane, shown)),
        Some((_, Question::Tolerance(_))) => {
            "j, k scroll the page, Esc stops the sampling, d shows the field again.".to_owned()
        }
        None => KEYS.to_owned(),
    }
}
