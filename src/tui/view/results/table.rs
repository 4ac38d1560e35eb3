//! The table of quantities: a line each, the methods side by side, what this edit changed, the
//! difference to the baseline.

use ratatui::style::Style;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use super::{shown_in, text};
use crate::case::units::system::counted;
use crate::model::inputs::Method;
use crate::model::{Outcome, QUANTITIES, Quantity, Solution, Stages};
use crate::report;
use crate::report::groups::{self, FREE_IMPACT};
use crate::report::verdict::{Standing, verdict};
use crate::tui::app::App;
use crate::tui::ascii::symbol;
use crate::tui::solver::Answer;

/// What an engineer looks at first.
const FIRST: &[&str] = &[
    "impact_force",
    "impact_duration",
    "approach_angle_driven",
    "friction_ratio",
    "normal_velocity",
    "total_deviation",
];
/// The same, where every pair takes its share of the load.
const FIRST_OF_STATIC: &[&str] = &[
    "static_force_at_start",
    "static_peak_force",
    "static_first_contact_angle",
    "static_transmission_error",
    "mesh_force",
    "total_deviation",
];
/// The same with inertia.
const FIRST_OF_DYNAMIC: &[&str] = &[
    "dynamic_peak_approach_force",
    "dynamic_peak_force",
    "dynamic_impact_duration",
    "dynamic_first_contact_angle",
    "dynamic_contact_lost",
    "total_deviation",
];
/// The same, when no tooth strikes.
const FIRST_WITHOUT_CONTACT: &[&str] = &[
    "total_deviation",
    "dynamic_peak_force",
    "dynamic_contact_lost",
    "static_peak_force",
    "equivalent_error",
    "combined_deflection",
    "mesh_force",
    "contact_ratio",
];

const SYMBOL: usize = 7;
/// Beside labels there is room for the longest symbol.
const LONG_SYMBOL: usize = 9;
const LABEL: usize = 27;
/// A number and a blank behind it.
const VALUE: usize = 10;
const UNIT: usize = 7;
const EQUATION: usize = 12;
/// Labels are worth more than a further method from so many on.
const ENOUGH_METHODS: usize = 2;
/// Stands behind a value that the last edit changed.
const CHANGED: &str = "←";
/// The heading of the differences.
const TO_BASE: &str = "to base";
/// Below this part of the baseline a difference is none that a person reads.
const NO_DIFFERENCE: f64 = 5e-6;

/// The table.
pub(super) struct Table {
    /// The names of the columns.
    pub(super) heading: Line<'static>,
    /// A line for every quantity, and one above those of the free impact.
    pub(super) rows: Vec<Line<'static>>,
}

/// What has room in a line.
struct Columns {
    labels: bool,
    methods: Vec<Method>,
    /// So many cells for value, unit and difference together, where each has none of its own.
    shared: Option<usize>,
    /// How wide the difference is, where there is a baseline.
    difference: Option<usize>,
    equation: bool,
}

/// The quantities that some method has, in the order in which a person reads them: what matters
/// first, then the method's own.
pub(super) fn order(answer: &Answer) -> impl Iterator<Item = &'static Quantity> {
    let strikes = |solution: &Solution| solution.outcome == Outcome::CornerContact;
    let strikes = answer.of(answer.active).is_none_or(strikes);
    let first = match answer.active {
        _ if !strikes => FIRST_WITHOUT_CONTACT,
        Method::Static => FIRST_OF_STATIC,
        Method::Dynamic => FIRST_OF_DYNAMIC,
        Method::Paper | Method::Exact | Method::Auto => FIRST,
    };
    let stages = answer
        .methods
        .iter()
        .fold(Stages::NONE, |stages, (method, _)| {
            stages.and(method.stages())
        });
    let has_friction = answer.inputs.friction_coefficient.is_some();
    let is_told = move |quantity: &&Quantity| {
        !first.contains(&quantity.key) && (has_friction || !quantity.needs_friction())
    };
    let rest = groups::quantities(answer.active).filter(is_told);
    first
        .iter()
        .filter_map(|key| Quantity::find(key))
        .chain(rest)
        .filter(move |quantity| stages.has(quantity.stage))
}

/// How many quantities stand above the heading of those of the free impact, which the method
/// resolves itself.
pub(super) fn above_heading(answer: &Answer) -> Option<usize> {
    let own = || order(answer).position(Quantity::is_of_free_impact);
    answer.active.shares_load().then(own).flatten()
}

/// The line of a quantity, by their places.
pub(super) fn line_of(answer: &Answer, row: usize) -> usize {
    row + usize::from(above_heading(answer).is_some_and(|above| above <= row))
}

/// The quantity on a line, by their places; none on a heading.
pub(super) fn row_of(answer: &Answer, line: usize) -> Option<usize> {
    match above_heading(answer) {
        Some(above) if line == above => None,
        Some(above) if line > above => Some(line - 1),
        _ => Some(line),
    }
}

/// The whole table in that width, with so many of its lines out of sight above and below.
pub(super) fn lines(app: &App, answer: &Answer, width: usize, hidden: (usize, usize)) -> Table {
    let columns = Columns::of(app, answer, width);
    let faint = if app.is_stale() {
        app.look.theme.faint
    } else {
        Style::new()
    };
    let mut rows: Vec<Line<'static>> = order(answer)
        .map(|quantity| row(app, answer, quantity, &columns).patch_style(faint))
        .collect();
    if let Some(above) = above_heading(answer) {
        rows.insert(
            above,
            Line::styled(
                text::cut(&format!("{FREE_IMPACT}:"), width),
                app.look.theme.title,
            )
            .patch_style(faint),
        );
    }
    Table {
        heading: heading(app, answer, &columns, hidden).patch_style(faint),
        rows,
    }
}

impl Columns {
    // The difference takes the place of the equation, and on a narrow screen that of the other
    // methods.
    fn of(app: &App, answer: &Answer, width: usize) -> Columns {
        let has_base = app.baseline.is_some();
        let more = if has_base { VALUE } else { 0 };
        let room_beside = |names: usize| width.saturating_sub(names + UNIT + more) / VALUE;
        let beside_labels = room_beside(LONG_SYMBOL + LABEL);
        let methods = methods(
            answer,
            if beside_labels >= ENOUGH_METHODS {
                beside_labels
            } else {
                room_beside(SYMBOL)
            },
        );
        let with_labels = LONG_SYMBOL + LABEL + methods.len() * VALUE + UNIT + more;
        let least = SYMBOL + VALUE + UNIT + VALUE;
        let labels = width >= with_labels;
        Columns {
            labels,
            methods,
            shared: (has_base && width < least).then_some(width.saturating_sub(SYMBOL)),
            difference: has_base.then_some(VALUE - 1),
            equation: !has_base && width >= with_labels + EQUATION,
        }
    }
}

// The active method, and of the others as many as have room: the nearest below it first. What
// `static` says stands among what `dynamic` says.
fn methods(answer: &Answer, room: usize) -> Vec<Method> {
    let said = |method: Method| method == Method::Static && answer.active == Method::Dynamic;
    let mut methods: Vec<Method> = answer
        .methods
        .iter()
        .map(|(method, _)| *method)
        .filter(|&method| !said(method))
        .collect();
    while methods.len() > room.max(1) {
        let first = methods
            .iter()
            .position(|method| *method != answer.active)
            .unwrap_or(0);
        methods.remove(first);
    }
    methods
}

// How much is out of sight, in as many words as have room.
fn more(hidden: (usize, usize), room: usize) -> String {
    let words = match hidden {
        (0, 0) => String::new(),
        (0, below) => format!("{below} more below"),
        (above, 0) => format!("{above} above"),
        (above, below) => format!("{above} above, {below} more below"),
    };
    let short = if hidden.1 > 0 {
        format!("{} more", hidden.1)
    } else {
        String::new()
    };
    if words.len() < room { words } else { short }
}

fn heading(app: &App, answer: &Answer, columns: &Columns, hidden: (usize, usize)) -> Line<'static> {
    let indent = if columns.labels {
        LONG_SYMBOL + LABEL
    } else {
        SYMBOL
    };
    let mut spans = vec![Span::styled(
        format!("{:indent$}", more(hidden, indent)),
        app.look.theme.faint,
    )];
    for &method in &columns.methods {
        let is_active = method == answer.active;
        let name = if is_active {
            format!("▸{}", method.name())
        } else {
            method.name().to_owned()
        };
        let style = if is_active {
            app.look.theme.active
        } else {
            app.look.theme.other
        };
        spans.push(Span::styled(format!("{name:>0$} ", VALUE - 1), style));
    }
    if let Some(room) = columns.difference {
        let base = app
            .baseline
            .as_ref()
            .map(|baseline| baseline.answer.beside(answer.active));
        let other = base
            .filter(|&base| base != answer.active)
            .map(|method| format!("{TO_BASE}, {}", method.name()));
        if let Some(shared) = columns.shared {
            return shared_heading(
                app,
                answer,
                &other.unwrap_or_else(|| TO_BASE.to_owned()),
                hidden,
                SYMBOL + shared,
            );
        }
        let width = room + UNIT;
        let heading = other
            .filter(|heading| heading.len() <= width)
            .unwrap_or_else(|| TO_BASE.to_owned());
        spans.push(Span::styled(
            format!("{heading:>width$}"),
            app.look.theme.baseline,
        ));
    }
    Line::from(spans)
}

// In one line without columns; how much is out of sight is left out where there is no room.
fn shared_heading(
    app: &App,
    answer: &Answer,
    to_base: &str,
    hidden: (usize, usize),
    width: usize,
) -> Line<'static> {
    let method = format!("▸{}", answer.active.name());
    let left = width.saturating_sub(method.width() + to_base.width() + 2);
    let more = if left > 0 {
        more(hidden, left)
    } else {
        String::new()
    };
    let more = if more.width() <= left {
        more
    } else {
        String::new()
    };
    let gap = width.saturating_sub(more.width() + usize::from(!more.is_empty()) + method.width());
    let more = if more.is_empty() { more } else { more + " " };
    Line::from(vec![
        Span::styled(more, app.look.theme.faint),
        Span::styled(method, app.look.theme.active),
        Span::styled(format!("{to_base:>gap$}"), app.look.theme.baseline),
    ])
}

// The value with its unit and the difference, which gives up its blank, and the mark, where there
// is no room.
fn shared_row(number: &str, unit: &str, mark: &str, difference: &str, width: usize) -> [String; 2] {
    let joined = |parts: &[&str]| {
        parts
            .iter()
            .filter(|part| !part.trim().is_empty())
            .copied()
            .collect::<Vec<_>>()
            .join(" ")
    };
    let (value, marked) = (joined(&[number, unit]), joined(&[number, unit, mark]));
    let close = difference.replace(" %", "%");
    let sayings = [
        (&marked, difference),
        (&value, difference),
        (&value, close.as_str()),
    ];
    let fits = sayings
        .into_iter()
        .find(|(value, difference)| value.width() + 1 + difference.width() <= width);
    let (value, difference) = fits.unwrap_or((&value, close.as_str()));
    let gap = width.saturating_sub(value.width());
    let difference = text::cut(difference, gap.saturating_sub(1));
    [value.clone(), format!("{difference:>gap$}")]
}

// The unit, and behind it the mark.
fn unit_and_mark(unit: &str, mark: &'static str, style: Style) -> [Span<'static>; 2] {
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!("{unit} ")
    };
    let room = UNIT.saturating_sub(unit.width());
    let style = if mark.trim().is_empty() {
        Style::new()
    } else {
        style
    };
    [
        Span::raw(unit),
        Span::styled(format!("{mark:<room$}"), style),
    ]
}

fn row(app: &App, answer: &Answer, quantity: &Quantity, columns: &Columns) -> Line<'static> {
    let symbol = symbol(quantity.symbol_in(answer.active), app.look.ascii);
    let mut spans = if columns.labels {
        vec![
            Span::raw(text::padded(&symbol, LONG_SYMBOL)),
            Span::raw(text::padded(quantity.label_in(answer.active), LABEL)),
        ]
    } else {
        vec![Span::raw(text::padded(&symbol, SYMBOL))]
    };
    let value = |method: Method| {
        answer
            .of(method)
            .and_then(|solution| report::value_as_in(quantity, solution, answer.active))
    };
    let common = report::unit_beside(
        quantity,
        columns.methods.iter().filter_map(|&method| value(method)),
        app.settings.units,
    );
    let shown: Vec<(Method, Option<report::Shown>)> = columns
        .methods
        .iter()
        .map(|&method| {
            (
                method,
                value(method).map(|value| report::shown_with(quantity, value, common)),
            )
        })
        .collect();
    let unit = shown
        .iter()
        .rev()
        .find_map(|(_, shown)| shown.as_ref())
        .map_or("", |shown| shown.unit);
    let mark = mark(app, answer, quantity);
    // Only the widest unit leaves no place for the mark behind it.
    let is_behind = unit.width() + 1 < UNIT;
    for (method, shown) in shown {
        let number = shown.map_or_else(|| "–".to_owned(), |shown| shown.number);
        let is_active = method == answer.active;
        let style = if is_active {
            app.look.theme.focus
        } else {
            Style::new()
        };
        if let Some(width) = columns.shared {
            let gap = usize::from(symbol.width() >= SYMBOL);
            spans.push(Span::raw(" ".repeat(gap)));
            let width = width.saturating_sub(gap);
            let room = width.saturating_sub(number.width() + 1);
            let [value, difference] = shared_row(
                &number,
                unit,
                mark,
                &difference(app, answer, quantity, common, room),
                width,
            );
            spans.extend([
                Span::styled(value, style),
                Span::styled(difference, app.look.theme.baseline),
            ]);
            return Line::from(spans);
        }
        let beside = if is_active && !is_behind { mark } else { " " };
        spans.push(Span::styled(
            format!("{number:>0$}{beside}", VALUE - 1),
            style,
        ));
    }
    spans.extend(unit_and_mark(
        unit,
        if is_behind { mark } else { " " },
        app.look.theme.focus,
    ));
    if let Some(room) = columns.difference {
        let difference = difference(app, answer, quantity, common, room);
        spans.push(Span::styled(
            format!("{difference:>room$}"),
            app.look.theme.baseline,
        ));
    }
    if columns.equation {
        spans.push(Span::styled(
            format!(" {}", text::cut(quantity.equation, EQUATION - 1)),
            app.look.theme.faint,
        ));
    }
    Line::from(spans)
}

// Above its limit, or changed.
fn mark(app: &App, answer: &Answer, quantity: &Quantity) -> &'static str {
    let solution = answer.of(answer.active).filter(|_| !app.is_stale());
    let limit = app
        .case
        .limits
        .iter()
        .find(|limit| limit.quantity == quantity.key);
    let is_exceeded = limit
        .zip(solution)
        .is_some_and(|(limit, solution)| verdict(limit, solution).standing == Standing::Exceeded);
    match is_exceeded {
        true => "!",
        false if is_changed(app, answer, quantity) => CHANGED,
        false => " ",
    }
}

// Whether this visit of a field changed what is shown of the quantity.
fn is_changed(app: &App, answer: &Answer, quantity: &Quantity) -> bool {
    let Some(earlier) = app.earlier.as_ref().filter(|_| !app.is_stale()) else {
        return false;
    };
    let at = QUANTITIES
        .iter()
        .position(|known| known.key == quantity.key);
    let before = at.and_then(|at| earlier.get(at).copied().flatten());
    let now = answer.of(answer.active).and_then(quantity.value);
    let told = |value: Option<f64>| value.map(|value| shown_in(app, quantity, value));
    told(before) != told(now)
}

// The active method's value against the same method's of the baseline, in percent of it; where that
// says little, what it was.
fn difference(app: &App, answer: &Answer, quantity: &Quantity, unit: &str, room: usize) -> String {
    let now = value(answer, answer.active, quantity);
    match (now, base(app, answer, quantity).and_then(|(_, base)| base)) {
        (Some(now), Some(base)) => against(now, base).unwrap_or_else(|| was(base, unit, room)),
        (Some(_), None) => "was none".to_owned(),
        (None, Some(base)) => was(base, unit, room),
        (None, None) => String::new(),
    }
}

// What the baseline's value was, in the unit of the line, with as many digits as have room.
fn was(base: f64, unit: &str, room: usize) -> String {
    let words = (1..=3)
        .rev()
        .map(|digits| format!("was {}", counted(base, unit, digits)));
    words
        .into_iter()
        .find(|words| words.len() <= room)
        .unwrap_or_else(|| "was other".to_owned())
}

/// The quantity's value and that of the baseline, with the method of the latter where it is
/// another.
pub(super) fn compared(app: &App, answer: &Answer, quantity: &Quantity) -> Option<String> {
    let (method, base) = base(app, answer, quantity)?;
    let told = |value: Option<f64>| {
        value.map_or_else(
            || "none".to_owned(),
            |value| shown_in(app, quantity, value).to_string(),
        )
    };
    let whose = if method == answer.active {
        String::new()
    } else {
        format!(" ({})", method.name())
    };
    Some(format!(
        "{}; baseline{whose}: {}.",
        told(value(answer, answer.active, quantity)),
        told(base)
    ))
}

// The method and the value of the baseline.
fn base(app: &App, answer: &Answer, quantity: &Quantity) -> Option<(Method, Option<f64>)> {
    let base = &app.baseline.as_ref()?.answer;
    let method = base.beside(answer.active);
    Some((
        method,
        report::value_as_in(quantity, base.of(method)?, answer.active),
    ))
}

fn value(answer: &Answer, method: Method, quantity: &Quantity) -> Option<f64> {
    report::value_as_in(quantity, answer.of(method)?, answer.active)
}

// In percent, unless the value is more than so many times the baseline's.
fn against(now: f64, base: f64) -> Option<String> {
    const MOST_TIMES: f64 = 10.0;
    let part = (now - base) / base.abs();
    if now.to_bits() == base.to_bits() || part.abs() < NO_DIFFERENCE {
        return Some("=".to_owned());
    }
    if !part.is_finite() || now.abs() > MOST_TIMES * base.abs() {
        return None;
    }
    let percent = 100.0 * part;
    Some(match percent.abs() {
        size if size >= 100.0 => format!("{percent:+.0} %"),
        size if size >= 1.0 => format!("{percent:+.1} %"),
        _ => format!("{percent:+.3} %"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_told_in_percent_of_the_baseline_and_has_room() {
        for (now, base, told) in [
            (110.0, 100.0, "+10.0 %"),
            (99.99, 100.0, "-0.010 %"),
            (-2.0, -1.0, "-100 %"),
            (1.0, 1.0, "="),
            (0.0, 0.0, "="),
        ] {
            assert_eq!(against(now, base).as_deref(), Some(told), "{now} {base}");
            assert!(told.len() < VALUE);
        }
    }

    #[test]
    fn a_value_many_times_the_baselines_is_told_beside_what_that_was() {
        for (now, base, told) in [
            (1.0, 0.0, "was 0"),
            (18.0, 0.0169, "was 0.017"),
            (1e9, 1.0, "was 1.00"),
            (500.0, 47.3, "was 47.3"),
        ] {
            assert_eq!(against(now, base), None, "{now} {base}");
            assert_eq!(was(base, "1", VALUE - 1), told);
        }
    }
}
