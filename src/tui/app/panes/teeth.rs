//! The teeth pane: the pair true to scale, the visible part of it, and the values at the cursor.

use std::fmt;

use nalgebra::{Point2, Vector2};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect, Size};
use ratatui::style::Style;
use ratatui::symbols::Marker;

use super::plot::{Plot, bounds, put};
use crate::case::units::{System, shown};
use crate::model::contact_state::{Phase, first_contact_of_driver, first_contact_point};
use crate::model::outline::on_line_of_action;
use crate::model::{ContactState, Geometry, Inputs, Interpolated, Quantity, Solution};
use crate::report::chart::{Point, Span};
use crate::report::charts::Pattern;
use crate::report::stations::{COLUMNS, Column};
use crate::report::teeth::{Ink, Scene, Window, round_down, scale_bar};
use crate::tui::app::App;
use crate::tui::layout::Pane;
use crate::tui::settings::Look;
use crate::tui::text::{self, symbol};

/// Least width and height of the picture, in cells.
const SMALLEST: (u16, u16) = (12, 4);
/// Least heights of a pane with two and with three lines of values. The number of lines does not
/// depend on the values, so that the picture keeps its size.
const TWO_LINES_FROM: u16 = 13;
const THREE_LINES_FROM: u16 = 20;
/// Cells of a value with its symbol, unit and a blank.
const VALUE: u16 = 19;
/// The least distance of points with names, in columns.
const APART: f64 = 5.0;
/// The greatest length of the scale bar, as a fraction of the width.
const BAR: f64 = 0.25;

/// Significant digits of the opening.
const GAP_DIGITS: usize = 4;
/// The key of the opening, which is not a column of the stations.
const OPEN: &str = "open";
/// The values at the cursor. The opening precedes the gap, which includes it.
const VALUES: [&str; 12] = [
    "roll_angle_driver",
    "impact_force",
    "force",
    OPEN,
    "gap",
    "normal_velocity",
    "sliding_velocity",
    "load_share",
    "transmission_error",
    "radius_driver",
    "roll_angle_driven",
    "time",
];
/// The signs of the lines in ASCII, in the order of the layers: base circles, line of action, path of
/// contact, path of the tip, driven gear, its incoming tooth, driver, its struck tooth, named points,
/// contacts.
const SIGNS: [char; 10] = ['.', '-', '=', ':', '*', '*', '#', '#', '+', 'X'];
/// The text of a missing number.
const NONE: &str = "–";

/// The input of the picture.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// The pair.
    pub inputs: &'a Inputs,
    /// The solution of the model.
    pub solution: &'a Solution,
    /// The driver's roll angle before E, in rad. By default D, or E without corner contact.
    pub cursor: Option<f64>,
    /// The plane across the axis in which the teeth are drawn, from the middle of the face, in m.
    pub z: f64,
    /// The visible part of the plane.
    pub view: &'a TeethView,
    /// The capabilities of the terminal.
    pub look: Look,
    /// The marker of a dot.
    pub marker: Marker,
    /// The display units.
    pub units: System,
    /// Whether the results are older than the form.
    pub is_stale: bool,
}

impl Picture<'_> {
    /// The displayed roll angle of the driver before E, in rad.
    pub fn angle(&self) -> f64 {
        let contact = || first_contact_of_driver(self.solution).unwrap_or(0.0);
        self.cursor.filter(|cursor| cursor.is_finite()).unwrap_or_else(contact)
    }

    /// The state of the teeth, and the values of a pair with slices in the plane of the cursor.
    fn state(&self) -> (Option<ContactState>, Vec<Reading>) {
        let (inputs, solution, angle, z) = (self.inputs, self.solution, self.angle(), self.z);
        let pattern = Pattern::of(inputs, solution).filter(|_| self.cursor.is_some());
        let Some(pattern) = pattern else {
            return (ContactState::at(inputs, solution, angle), Vec::new());
        };
        let in_plane = angle - pattern.ahead(z);
        let load = pattern.line_load(-in_plane, z);
        // A flank without load is apart at least by its own gap.
        let opening = |opening: f64| if load > 0.0 { 0.0 } else { opening.max(pattern.gap(z)) };
        let state = ContactState::at(inputs, solution, in_plane).map(|state| ContactState {
            opening: opening(state.opening),
            interpolated: Interpolated::at(inputs, solution, angle),
            ..state
        });
        let reading = |symbol, value, unit| {
            let (number, unit) = shown(value, unit, GAP_DIGITS, self.units);
            Reading { symbol, number: Some(number), unit }
        };
        (state, vec![reading("z", z, "mm"), reading("p", load, "N/mm")])
    }
}

/// A value at the cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// The symbol.
    pub symbol: &'static str,
    /// The number, if any.
    pub number: Option<String>,
    pub(crate) unit: &'static str,
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.number {
            None => write!(f, "{} {NONE}", self.symbol),
            Some(number) if self.unit.is_empty() => write!(f, "{} {number}", self.symbol),
            Some(number) => write!(f, "{} {number} {}", self.symbol, self.unit),
        }
    }
}

impl App {
    /// The picture of the teeth, if the active method has results.
    pub(crate) fn picture(&self) -> Option<Picture<'_>> {
        Some(Picture {
            inputs: &self.tab.answer.as_ref()?.inputs,
            solution: self.tab.solution()?,
            cursor: self.cursor,
            z: self.chart.z,
            view: &self.teeth,
            look: self.look,
            marker: self.settings.marker,
            units: self.settings.units,
            is_stale: self.tab.shows_last_valid(),
        })
    }
}

/// Draws the pane.
pub(crate) fn draw_pane(app: &App, buffer: &mut Buffer) {
    let stale = if app.tab.shows_last_valid() { "LAST VALID, " } else { "" };
    let words = format!("{stale}Teeth, true to scale, around {}", app.teeth.centre.name());
    let inner = app.draw_title(Pane::Teeth, &words, buffer);
    match (app.picture(), &app.tab.answer) {
        (Some(picture), _) => draw(&picture, inner, buffer),
        (None, Some(_)) => text::draw_words("This method has no valid results.", inner, buffer),
        (None, None) => text::draw_words("No results yet.", inner, buffer),
    }
}

/// Draws the teeth, and below them the values at the cursor.
pub fn draw(picture: &Picture, area: Rect, buffer: &mut Buffer) {
    let area = area.intersection(buffer.area);
    let (inputs, solution) = (picture.inputs, picture.solution);
    let (moment, mut values) = picture.state();
    let of_moment = moment.iter();
    values.extend(of_moment.flat_map(|moment| readings(moment, (inputs, solution), picture.units)));
    let in_line = usize::from(area.width.saturating_sub(1) / VALUE).max(1);
    let most =
        1 + u16::from(area.height >= TWO_LINES_FROM) + u16::from(area.height >= THREE_LINES_FROM);
    let lines = (values.len().div_ceil(in_line).max(1) as u16).min(most);
    let [plot, below] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(lines)]).areas(area);
    for (values, row) in values.chunks(in_line).zip(below.rows()) {
        let values = values.iter().map(|value| {
            let text = symbol(&value.to_string(), picture.look.ascii).into_owned();
            text::padded(&text, usize::from(VALUE) - 1) + " "
        });
        text::put(&format!(" {}", values.collect::<String>()), row, Style::new(), buffer);
    }
    if plot.width >= SMALLEST.0 && plot.height >= SMALLEST.1 {
        Painter::new(picture, plot).draw(moment.as_ref(), buffer);
    }
}

/// Draws a picture into an area.
struct Painter<'a> {
    picture: &'a Picture<'a>,
    area: Rect,
    marker: Marker,
    /// The dots of a cell, horizontally and vertically.
    dots: (u16, u16),
    window: Window,
}

/// A word on the picture.
type Word = (Position, String, Style);

impl<'a> Painter<'a> {
    fn new(picture: &'a Picture<'a>, area: Rect) -> Painter<'a> {
        let marker = if picture.look.ascii { Marker::Braille } else { picture.marker };
        let dots = match marker {
            Marker::Braille => (2, 4),
            Marker::HalfBlock => (1, 2),
            _ => (1, 1),
        };
        let window = picture.view.window(picture.inputs, picture.solution, area.as_size(), dots);
        Painter { picture, area, marker, dots, window }
    }

    fn draw(&self, moment: Option<&ContactState>, buffer: &mut Buffer) {
        let Picture { inputs, solution, view, .. } = *self.picture;
        let factor = moment.map_or(1.0, |moment| view.factor(inputs, solution, moment));
        let lead = moment.map_or(0.0, |moment| moment.lead(factor));
        let scene = Scene::of(inputs, solution, moment, lead, &self.window);
        let curves = self.layers(&scene);
        let curves: Vec<_> = curves.iter().map(|(pieces, style)| (&pieces[..], *style)).collect();
        if self.picture.look.ascii {
            for (curve, sign) in curves.iter().zip(SIGNS) {
                put(&self.plot().layer(&[*curve], Marker::Custom(sign)), buffer);
            }
        } else {
            put(&self.plot().layer(&curves, self.marker), buffer);
        }
        for (at, word, style) in self.words(&scene, moment.map(|_| factor)) {
            buffer.set_string(at.x, at.y, word, Style::reset().patch(style));
        }
    }

    /// The area as a plot without axes.
    fn plot(&self) -> Plot {
        let (low, high) =
            (self.window.centre - self.window.half, self.window.centre + self.window.half);
        let span = |from, to| Span::of(bounds(from, to).into_iter());
        let (across, up) = (span(low.x, high.x), span(low.y, high.y));
        Plot { cells: self.area, across, up, is_map: false }
    }

    fn dot_height(&self) -> f64 {
        self.window.dot * CELL_HEIGHT * f64::from(self.dots.0) / f64::from(self.dots.1)
    }

    fn column(&self) -> f64 {
        self.window.dot * f64::from(self.dots.0)
    }

    /// The lines of the scene by their styles, in drawing order; the last ones are the crosses of
    /// the named points and of the contacts.
    fn layers(&self, scene: &Scene) -> Vec<(Vec<Vec<Point>>, Style)> {
        let theme = self.picture.look.theme;
        let [driven, driver] = [theme.driven, theme.driver];
        let styles = [
            theme.faint,
            theme.faint,
            theme.path,
            theme.path,
            driven,
            driven.bold(),
            driver,
            driver.bold(),
            theme.focus,
            theme.active,
        ];
        let mut layers = styles.map(|style| (Vec::new(), style)).to_vec();
        for (ink, points) in &scene.lines {
            let (at, dash) = match ink {
                Ink::BaseCircle => (0, Some((0.0, 4.0))),
                Ink::LineOfAction => (1, Some((5.0, 4.0))),
                Ink::PathOfContact => (2, None),
                Ink::TipPath => (3, Some((0.0, 2.0))),
                Ink::DrivenBore | Ink::Driven => (4, None),
                Ink::IncomingTooth => (5, None),
                Ink::DriverBore | Ink::Driver => (6, None),
                Ink::StruckTooth => (7, None),
            };
            match dash {
                None => layers[at].0.push(points.iter().map(|point| (point.x, point.y)).collect()),
                Some(dash) => layers[at].0.extend(self.dashes(points, dash)),
            }
        }
        // A cross of five dots, or one dot if a cell has one dot.
        let arm = f64::from(u8::from(self.dots.0 > 1));
        let (x, y) = (arm * self.window.dot, arm * self.dot_height());
        let cross = |at: Point2<f64>| {
            [vec![(at.x - x, at.y), (at.x + x, at.y)], vec![(at.x, at.y - y), (at.x, at.y + y)]]
        };
        let marks = scene.distinct_points(&self.window, 2.0 * self.column());
        layers[8].0.extend(marks.into_iter().flat_map(|(_, at)| cross(at)));
        let contacts = scene.contacts.iter().filter(|at| self.window.sees(**at));
        layers[9].0.extend(contacts.flat_map(|at| cross(*at)));
        if self.picture.is_stale {
            for (_, style) in &mut layers {
                *style = style.patch(theme.faint);
            }
        }
        layers
    }

    /// Dashes and gaps of a length in dots along a line; dashes of length 0 are dots.
    fn dashes(&self, points: &[Point2<f64>], (on, off): (f64, f64)) -> Vec<Vec<Point>> {
        let (mut before, mut dashes) = (0.0, Vec::new());
        for ends in points.windows(2) {
            let (from, way) = (ends[0], ends[1] - ends[0]);
            let length = way.norm() / self.window.dot;
            let at = |dots: f64| from + way * (dots / length).clamp(0.0, 1.0);
            if self.window.clip(from, ends[1]).is_some() {
                let first = ((before - on) / (on + off)).ceil() as i64;
                let starts = (first..).map(|dash| dash as f64 * (on + off) - before);
                let starts = starts.take_while(|start| *start < length);
                let dash = |start: f64| [start, start + on].map(at).map(|end| (end.x, end.y));
                dashes.extend(starts.map(|start| dash(start).to_vec()));
            }
            before += length;
        }
        dashes
    }

    /// The words of the picture: the gears, the scale and the factor of the gap in the corners, and
    /// names beside their points, of points close together only the most important one.
    fn words(&self, scene: &Scene, factor: Option<f64>) -> Vec<Word> {
        let (area, theme) = (self.area, self.picture.look.theme);
        let beside = |(name, point): (&str, Point2<f64>)| {
            let at = self.cell(point)?;
            let at = Position { x: at.x + 1, ..at };
            let has_room = usize::from(at.x) + name.len() <= area.right().into();
            has_room.then(|| (at, name.to_owned(), theme.focus))
        };
        let names = scene.distinct_points(&self.window, APART * self.column());
        let names = names.into_iter().filter_map(beside);
        let (length, name) = scale_bar(BAR * 2.0 * self.window.half.x, self.picture.units);
        let columns = (length / self.column()).round() as usize;
        let bar = format!("├{}┤ {name}", "─".repeat(columns.max(2) - 2));
        let gap = factor.map(|factor| format!("gap x{}", (10.0 * factor).round() / 10.0));
        let gap = gap.unwrap_or_default();
        let at = |word: &str, is_right: bool, y: u16| {
            let right = area.right().saturating_sub(word.len() as u16 + 1).max(area.x);
            Position { x: if is_right { right } else { area.x }, y }
        };
        let (top, bottom) = (area.y, area.bottom() - 1);
        let corners = [
            (at("", false, top), " driver ".to_owned(), theme.driver),
            (at(" driven", true, top), " driven".to_owned(), theme.driven),
            (at("", false, bottom), bar, theme.focus),
            (at(&gap, true, bottom), gap, theme.focus),
        ];
        names.chain(corners).collect()
    }

    /// The cell of a visible point.
    fn cell(&self, point: Point2<f64>) -> Option<Position> {
        let (left, high) = (self.plot().across.from, self.plot().up.to);
        let dot = |off: f64, size: f64, dots: u16| (off / size).round() as u16 / dots;
        self.window.sees(point).then(|| Position {
            x: self.area.x + dot(point.x - left, self.window.dot, self.dots.0),
            y: self.area.y + dot(high - point.y, self.dot_height(), self.dots.1),
        })
    }
}

/// Every value of the method at a contact state, and the opening, in a fixed order.
pub fn readings(
    moment: &ContactState,
    solved: (&Inputs, &Solution),
    system: System,
) -> Vec<Reading> {
    let value = |key: &&str| match *key {
        OPEN => Some(open(moment, system)),
        key => reading(moment, key, solved, system),
    };
    VALUES.iter().filter_map(value).collect()
}

fn open(moment: &ContactState, system: System) -> Reading {
    let (number, unit) = shown(moment.opening, "um", GAP_DIGITS, system);
    Reading { symbol: OPEN, number: Some(number), unit }
}

fn reading(
    moment: &ContactState,
    key: &str,
    (inputs, solution): (&Inputs, &Solution),
    system: System,
) -> Option<Reading> {
    let column: &Column = COLUMNS.iter().find(|column| column.key == key)?;
    let interpolated = moment.interpolated.as_ref();
    let value = interpolated.and_then(|one| column.of(solution, &one.station));
    let value = value.or_else(|| without_contact(moment, key));
    if value.is_none() && !column.methods.contains(&solution.method) {
        return None;
    }
    let digits = interpolated.map_or(column.digits, |one| column.digits_of(one));
    let shown = value
        .map(|value| shown(column.resolved(value, inputs, solution), column.shown, digits, system));
    let (number, unit) = shown.map_or((None, ""), |(number, unit)| (Some(number), unit));
    Some(Reading { symbol: symbol_at(moment, column, solution), number, unit })
}

/// The symbol of a value: a roll angle has the symbol of the results at the first contact alone.
fn symbol_at(moment: &ContactState, column: &Column, solution: &Solution) -> &'static str {
    let (of_results, elsewhere) = match column.key {
        "roll_angle_driver" => ("approach_angle_driver", "θ"),
        "roll_angle_driven" => ("approach_angle_driven", "θ/i"),
        _ => return column.symbol,
    };
    let contact = first_contact_of_driver(solution);
    let is_first =
        contact.is_some_and(|first| (first - moment.roll_angle_driver).abs() < 1e-9 * first);
    let of_method = Quantity::find(of_results).and_then(|free| free.by(solution.method));
    of_method.filter(|_| is_first).map_or(elsewhere, |quantity| quantity.symbol)
}

/// The value from the involutes, if the method has none.
fn without_contact(moment: &ContactState, key: &str) -> Option<f64> {
    match key {
        "roll_angle_driver" => Some(moment.roll_angle_driver),
        "roll_angle_driven" => Some(moment.roll_angle_driven),
        "radius_driver" => Some(moment.radius_driver),
        "normal_velocity" => Some(moment.normal_velocity),
        "sliding_velocity" => Some(moment.sliding_velocity),
        "gap" => Some(moment.gap),
        _ => None,
    }
}

/// The height of a cell over its width.
const CELL_HEIGHT: f64 = 2.0;
/// Bounds of the width of a cell, in m. Outside them, differences of coordinates are lost or
/// overflow.
const CELL: (f64, f64) = (1e-12, 1e6);
/// The size of the whole pair over the size of the gears.
const MARGIN: f64 = 1.04;

/// The least height of the picture around the strike without zoom, in modules and in distances from
/// D to E.
const STRIKE: (f64, f64) = (3.4, 4.0);
/// The height of the picture around the pitch point, relative to the distance from it to the
/// farther end of the path of contact.
const PATH: f64 = 2.4;
/// The last zoom step in. Each step is √2, and the last step shows some micrometres of a typical
/// gear.
const LAST_STEP_IN: i32 = 20;
/// The last zoom step out, enough for two gears of 1000 teeth.
const LAST_STEP_OUT: i32 = -24;
/// The exaggerated deviation as a fraction of the picture's height, and its greatest value in
/// modules.
const SHARE: f64 = 0.1;
const MOST_DEVIATION: f64 = 0.2;
/// The greatest exaggerated opening, in modules.
const MOST_OPENING: f64 = 0.3;
/// The greatest exaggeration.
const MOST_FACTOR: f64 = 1000.0;

/// The view of the teeth pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TeethView {
    /// The point in the middle of the pane.
    pub centre: Centre,
    /// Zoom steps of √2: in above 0, out below.
    pub zoom: i32,
    /// Whether the gap is drawn true to scale rather than exaggerated.
    pub has_true_gap: bool,
}

/// The centre of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Centre {
    /// D, or E without corner contact.
    #[default]
    Strike,
    /// The pitch point.
    PitchPoint,
    /// The whole pair.
    Pair,
}

impl Centre {
    const ALL: [Centre; 3] = [Centre::Strike, Centre::PitchPoint, Centre::Pair];

    /// The centre `by` places further, wrapping around.
    pub(crate) fn beside(self, by: isize) -> Centre {
        let count = Centre::ALL.len();
        Centre::ALL[(self as usize + count).saturating_add_signed(by) % count]
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Centre::Strike => "the strike",
            Centre::PitchPoint => "the pitch point",
            Centre::Pair => "the pair",
        }
    }
}

impl TeethView {
    /// The view zoomed in by `steps`, or out if negative, at most to the whole pair.
    pub fn zoomed(self, steps: i32, inputs: &Inputs, solution: &Solution) -> TeethView {
        let unzoomed = TeethView { zoom: 0, ..self }.extent(inputs, solution);
        let beyond = 2.0 * (whole(&solution.geometry).x / unzoomed).log2().ceil();
        let last_out = (-beyond.max(0.0) as i32).max(LAST_STEP_OUT);
        TeethView { zoom: self.zoom.saturating_add(steps).max(last_out).min(LAST_STEP_IN), ..self }
    }

    /// The length of the shorter side of the picture, in m.
    pub fn extent(&self, inputs: &Inputs, solution: &Solution) -> f64 {
        let geometry = &solution.geometry;
        let way_from = |length: f64| {
            let from = on_line_of_action(geometry, length);
            first_contact_point(solution).map_or(0.0, |contact| (contact - from).norm())
        };
        let pitch_point = geometry.start + geometry.approach_length;
        let unzoomed = match self.centre {
            Centre::Strike => (STRIKE.0 * inputs.module).max(STRIKE.1 * way_from(geometry.start)),
            Centre::PitchPoint => {
                PATH * way_from(pitch_point)
                    .max(geometry.end - pitch_point)
                    .max(geometry.approach_length)
                    .max(inputs.module)
            }
            Centre::Pair => whole(geometry).x,
        };
        let steps = self.zoom.clamp(LAST_STEP_OUT, LAST_STEP_IN);
        unzoomed * 2f64.powf(-0.5 * f64::from(steps))
    }

    /// The visible part of the plane on a screen with a size and with so many dots per cell. The
    /// scale is the same in both directions, and as little as possible outside the pair is visible.
    fn window(self, inputs: &Inputs, solution: &Solution, size: Size, dots: (u16, u16)) -> Window {
        let geometry = &solution.geometry;
        // The canvas is measured between the middles of its outermost dots.
        let span = |cells: u16, dots: u16| (f64::from(cells) - 1.0 / f64::from(dots)).max(0.5);
        let (wide, high) = (span(size.width, dots.0), CELL_HEIGHT * span(size.height, dots.1));
        let whole = whole(geometry);
        let fitting = (whole.x / wide).max(whole.y / high);
        let extent = self.extent(inputs, solution);
        let cell = match self.centre {
            Centre::Pair => fitting * extent / whole.x,
            Centre::Strike | Centre::PitchPoint => extent / wide.min(high),
        };
        let cell = cell.min(fitting).max(CELL.0).min(CELL.1);
        let half = Vector2::new(wide, high) * (0.5 * cell);
        let pair = 0.5 * (geometry.centre_distance + geometry.driven.tip - geometry.driver.tip);
        let middle = Point2::new(pair, 0.0);
        let start = on_line_of_action(geometry, geometry.start);
        let at = match self.centre {
            Centre::Strike => first_contact_point(solution).unwrap_or(start),
            Centre::PitchPoint => {
                on_line_of_action(geometry, geometry.start + geometry.approach_length)
            }
            Centre::Pair => middle,
        };
        let room = (0.5 * whole - half).sup(&Vector2::zeros());
        let centre = middle + (at - middle).inf(&room).sup(&-room);
        Window { centre, half, dot: cell / f64::from(dots.0) }
    }

    /// The exaggeration of the opening, 1 if the opening is visible true to scale.
    ///
    /// The factor is a round number that makes the deviation at most 10 % of the picture's height.
    /// The factor decreases far from the flank, so that the struck tooth does not move, and is 1
    /// after B.
    fn factor(self, inputs: &Inputs, solution: &Solution, moment: &ContactState) -> f64 {
        if self.has_true_gap || moment.phase == Phase::RunOut {
            return 1.0;
        }
        let room = (SHARE * self.extent(inputs, solution)).min(MOST_DEVIATION * inputs.module);
        let fitted = round_down(room / solution.deviation.total.abs()).min(MOST_FACTOR);
        fitted.min(MOST_OPENING * inputs.module / moment.opening).max(1.0)
    }
}

/// The width and height of the whole pair with a margin, in m.
fn whole(geometry: &Geometry) -> Vector2<f64> {
    let (driver, driven) = (geometry.driver.tip, geometry.driven.tip);
    MARGIN * Vector2::new(geometry.centre_distance + driver + driven, 2.0 * driver.max(driven))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;
    use ratatui::layout::Size;
    use unicode_width::UnicodeWidthStr;

    use super::*;
    use crate::case::Case;
    use crate::model::{self, Stages};

    /// Calls a function with painters of Table 1: every view, marker and size.
    fn for_each_painter(mut call: impl FnMut(&Painter<'_>)) {
        let inputs = Case::table_1().inputs().unwrap();
        let solution = model::solve(&inputs, Stages::CLOSED_FORM).unwrap();
        for centre in [Centre::Strike, Centre::PitchPoint, Centre::Pair] {
            for zoom in [-6, -3, 0, 2, 8, 20] {
                for marker in [Marker::Braille, Marker::HalfBlock, Marker::Dot] {
                    for size in [Size::new(80, 24), Size::new(30, 40), Size::new(12, 4)] {
                        let picture = Picture {
                            inputs: &inputs,
                            solution: &solution,
                            cursor: None,
                            z: 0.0,
                            view: &TeethView { centre, zoom, ..TeethView::default() },
                            look: Look::FULL,
                            marker,
                            units: System::Metric,
                            is_stale: false,
                        };
                        call(&Painter::new(&picture, Rect::from((Position::ORIGIN, size))));
                    }
                }
            }
        }
    }

    #[test]
    fn a_point_is_drawn_in_its_cell_and_the_scale_is_the_same_in_both_directions() {
        for_each_painter(|painter| {
            let Window { centre, half, .. } = painter.window;
            let size = painter.area;
            let dots = |cells: u16, dots: u16| f64::from(cells * dots - 1);
            let (column, row) = (
                2.0 * half.x / dots(size.width, painter.dots.0) * f64::from(painter.dots.0),
                2.0 * half.y / dots(size.height, painter.dots.1) * f64::from(painter.dots.1),
            );
            assert!(
                (row / column - CELL_HEIGHT).abs() < 1e-9
                    && (column / painter.column() - 1.0).abs() < 1e-9
            );
            for (right, up) in [(0.02, -0.03), (-0.99, 0.99), (0.999, 0.999), (0.51, 0.13)] {
                let point = centre + Vector2::new(right * half.x, up * half.y);
                let dot = [vec![(point.x, point.y)]];
                let buffer = painter.plot().layer(&[(&dot, Style::new())], painter.marker);
                let drawn = size.positions().find(|position| buffer[*position].symbol() != " ");
                assert_eq!(drawn, painter.cell(point), "{size:?} {right} {up}");
            }
        });
    }

    #[test]
    fn no_two_names_overlap_and_every_word_is_inside() {
        for_each_painter(|painter| {
            let Picture { inputs, solution, .. } = *painter.picture;
            let scene = Scene::of(inputs, solution, None, 0.0, &painter.window);
            let points = scene.distinct_points(&painter.window, APART * painter.column());
            let words = painter.words(&scene, Some(20.0));
            let room = |(at, word, _): &Word| Rect::new(at.x, at.y, word.width() as u16, 1);
            let is_name = |word: &Word| points.iter().any(|point| point.0 == word.1);
            for (at, word) in words.iter().enumerate() {
                assert!(painter.area.contains(word.0), "{word:?}");
                let mut others = words[..at].iter().filter(|other| is_name(other));
                let covers = |other: &Word| room(other).intersects(room(word));
                assert!(!is_name(word) || !others.any(covers), "{word:?}");
            }
        });
    }
}
