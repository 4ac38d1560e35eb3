//! The texts of the study pane: its title, the values at the cursor, the refused points.

use unicode_width::UnicodeWidthStr;

use super::{NO_CONTACT, REFUSED, StudyPane, axes, cursor, page_height, top};
use crate::case::FIELDS;
use crate::model::Outcome;
use crate::model::inputs::Method;
use crate::report::{common_unit, shown_in};
use crate::study::axis::Axis;
use crate::study::batch::PointOutcome;
use crate::study::refusals::Refused;
use crate::tui::ascii::symbol;
use crate::tui::study::{
    End, Layer, LayerFound, LayerSource, SAMPLES, StudyParameters, StudyResults,
};
use crate::tui::text;

/// The longest title that fits a width.
pub(super) fn title(pane: &StudyPane<'_>, room: usize) -> String {
    let Some(shown) = pane.study.shown.as_ref().filter(|_| pane.study.obstacle.is_none()) else {
        return "Study".to_owned();
    };
    let state = progress(shown);
    let words = match &shown.request.parameters {
        StudyParameters::Tolerance(_) => vec![format!("Tolerance{}", position(pane, shown))],
        StudyParameters::Grid(grid) => {
            let fields = |label: fn(&Axis) -> String| -> Vec<String> {
                grid.axes.iter().rev().map(label).collect()
            };
            let Some(known) = shown.quantity() else {
                return "Study".to_owned();
            };
            let layer = grid.layers.first();
            let method = layer.map_or(Method::Exact, |layer| layer.inputs.method);
            let (name, label) = (known.symbol_in(method), known.label_in(method).trim_start());
            let values = shown.layers.iter().flat_map(|found| &found.values);
            let unit = match common_unit(known, values.flatten().copied(), pane.units) {
                "" | "1" => String::new(),
                unit => format!(" in {unit}"),
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
    let all: Vec<String> = all.map(|words| symbol(&words, pane.look.ascii).into_owned()).collect();
    let fits = all.iter().find(|words| words.width() <= room);
    fits.cloned().unwrap_or_else(|| text::cut(all.last().map_or("Study", String::as_str), room))
}

/// The visible lines of a tolerance, if some do not fit.
fn position(pane: &StudyPane<'_>, shown: &StudyResults) -> String {
    let (lines, height) = (shown.page.len(), page_height(pane));
    if lines <= height {
        return String::new();
    }
    let top = top(pane, shown);
    format!(" {} to {} of {lines}", top + 1, (top + height).min(lines))
}

fn in_unit(axis: &Axis) -> String {
    if axis.unit.is_empty() { String::new() } else { format!(" in {}", axis.unit) }
}

/// The progress of an unfinished study.
fn progress(shown: &StudyResults) -> String {
    match (&shown.end, &shown.request.parameters) {
        (Some(End::Whole), _) => String::new(),
        (Some(End::Stopped), _) => ", stopped".to_owned(),
        (Some(End::Failed(_)), _) => ", failed".to_owned(),
        (None, StudyParameters::Tolerance(_)) => format!(", {:.0} % solved", 100.0 * shown.part),
        (None, StudyParameters::Grid(grid)) => {
            let points: usize = grid.axes.iter().map(|axis| axis.points.len()).product();
            let solved: usize = shown.layers.iter().map(|found| found.outcomes.len()).sum();
            let all = (points * grid.layers.len()).max(1);
            format!(", {:.0} % solved", 100.0 * solved as f64 / all as f64)
        }
    }
}

/// The lines below the plot: the values at the cursor, then the refused points.
pub(super) fn below(pane: &StudyPane<'_>, shown: &StudyResults, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(End::Failed(reason)) = &shown.end {
        lines.extend(text::wrap(reason, width));
    }
    let line = at_cursor(pane, shown);
    lines.push(text::cut(&symbol(&line, pane.look.ascii), width));
    lines.extend(refused(shown).into_iter().flat_map(|line| text::wrap(&line, width)));
    lines
}

/// The varied values at the cursor, and the value of each curve.
pub(super) fn at_cursor(pane: &StudyPane<'_>, shown: &StudyResults) -> String {
    let StudyParameters::Grid(grid) = &shown.request.parameters else {
        return String::new();
    };
    let (across, up) = axes(shown);
    let (x, y) = cursor(pane, shown);
    let width = across.map_or(0, |axis| axis.points.len());
    let setting = |axis: &Axis, at: usize| {
        let known = &FIELDS[axis.field];
        let name = if known.symbol.is_empty() { known.label } else { known.symbol };
        format!("{name} = {}", axis.with_unit(at))
    };
    let first = across.map(|axis| setting(axis, x));
    let settings: Vec<String> = first.into_iter().chain(up.map(|axis| setting(axis, y))).collect();
    let values: Vec<String> = grid
        .layers
        .iter()
        .zip(&shown.layers)
        .filter_map(|(layer, found)| value(pane, layer, found, y * width + x))
        .collect();
    format!("{}: {}", settings.join(", "), values.join(", "))
}

fn value(pane: &StudyPane<'_>, layer: &Layer, found: &LayerFound, at: usize) -> Option<String> {
    let name = match layer.source {
        LayerSource::Active(method) | LayerSource::Other(method) => method.name(),
        LayerSource::Baseline => "baseline",
    };
    let known = layer.quantity()?;
    let words = match (found.outcomes.get(at)?, found.values.get(at)?) {
        (_, Some(value)) => format!(
            "{} {}",
            known.symbol_in(layer.inputs.method),
            shown_in(known, *value, pane.units)
        ),
        (PointOutcome::Refused, None) => "refused".to_owned(),
        (PointOutcome::Solved(Outcome::NoCornerContact), None) => "no contact".to_owned(),
        (PointOutcome::Solved(_), None) => "no value".to_owned(),
    };
    Some(format!("{name} {words}"))
}

/// The refused points of the first curve that has some: their number and the most frequent reason.
fn refused(shown: &StudyResults) -> Option<String> {
    let found = shown.layers.iter().find(|found| found.refusals.total() > 0)?;
    let reasons = found.refusals.0.iter();
    let Refused { count, problem, .. } = reasons.rev().max_by_key(|refused| refused.count)?;
    let total = found.refusals.total();
    let points = if total == 1 { "point" } else { "points" };
    let of_them = if *count < total { format!(", {count} of them") } else { String::new() };
    Some(format!("{total} {points} refused{of_them}: {}: {}", problem.cause, problem.fix))
}

/// The hint line while the pane has the focus: the values at the cursor if the pane cuts them,
/// otherwise the signs.
pub(super) fn hint(pane: &StudyPane<'_>) -> String {
    let shown = pane.study.shown.as_ref();
    let shown = shown.filter(|_| pane.study.obstacle.is_none());
    match shown.map(|shown| (shown, &shown.request.parameters)) {
        Some((shown, StudyParameters::Grid(_))) => {
            let line = at_cursor(pane, shown);
            if line.width() > room(pane.area.width) {
                format!("{line}.")
            } else {
                format!(
                    "● present value, ▴ cursor, {NO_CONTACT} no contact, {REFUSED} refused point."
                )
            }
        }
        Some((_, StudyParameters::Tolerance(_))) => {
            format!("{SAMPLES} samples draw every field of [spread] from its distribution.")
        }
        None => "The study varies the focused field over a range.".to_owned(),
    }
}

/// The number of columns of a line in a pane with a width.
pub(super) fn room(width: u16) -> usize {
    usize::from(width).saturating_sub(2)
}
