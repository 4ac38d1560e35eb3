//! The teeth pane: the pair true to scale, and the values at the cursor.

mod view;

use std::fmt;

use nalgebra::{Point2, Vector2};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Context, Line as Segment};
use unicode_width::UnicodeWidthStr;

use super::plot::bounds;
use crate::case::units::System;
use crate::case::units::shown;
use crate::model::{ContactState, Inputs, Solution, contact_state};
use crate::report::stations::{COLUMNS, Column};
use crate::report::teeth::{Ink, Scene, Window, scale_bar};
use crate::tui::ascii::symbol;
use crate::tui::text;
use crate::tui::theme::Look;

pub use view::{Centre, TeethView};

/// Least width and height of the picture, in cells.
const SMALLEST: (u16, u16) = (12, 4);
/// Least heights of a pane with two and with three lines of values. The number of lines does not
/// depend on the values, so that the picture keeps its size.
const TWO_LINES_FROM: u16 = 13;
const THREE_LINES_FROM: u16 = 20;
/// Cells of a value with its symbol and unit.
const VALUE: u16 = 18;
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
/// The text of a missing number.
const NONE: &str = "–";

/// A command of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TeethCommand {
    /// Zooms in by steps; zooms out if negative.
    Zoom(i32),
    /// Restores the initial view.
    Reset,
    /// Selects the view `by` places further, wrapping around.
    Centre(isize),
    /// Switches the exaggeration of the gap.
    Gap,
}

impl TeethView {
    /// Runs a command on the view of a solved pair, if there is one. Returns a message.
    ///
    /// # Errors
    /// Returns an error if the command needs a solved pair.
    pub(crate) fn run(
        &mut self,
        command: TeethCommand,
        solved: Option<(&Inputs, &Solution)>,
    ) -> Result<Option<String>, &'static str> {
        let before = *self;
        Ok(match command {
            TeethCommand::Zoom(steps) => {
                let (inputs, solution) = solved.ok_or("no valid results to show")?;
                *self = self.zoomed(steps, inputs, solution);
                let end =
                    if steps > 0 { "closest zoom" } else { "the teeth pane shows the whole pair" };
                (*self == before).then(|| end.to_owned())
            }
            TeethCommand::Reset => {
                *self = TeethView::default();
                None
            }
            TeethCommand::Centre(by) => {
                *self = TeethView { centre: self.centre.beside(by), zoom: 0, ..*self };
                Some(format!("view: {}", self.centre.name()))
            }
            TeethCommand::Gap => {
                self.has_true_gap = !self.has_true_gap;
                let gap = if self.has_true_gap {
                    "drawn true to scale"
                } else {
                    "exaggerated by the factor shown"
                };
                Some(format!("gap {gap}"))
            }
        })
    }
}

/// The input of the picture.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// The pair.
    pub inputs: &'a Inputs,
    /// The solution of the model.
    pub solution: &'a Solution,
    /// The driver's roll angle before E, in rad. By default D, or E without corner contact.
    pub cursor: Option<f64>,
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
    #[must_use]
    pub fn angle(&self) -> f64 {
        let contact = || contact_state::first_contact_of_driver(self.solution).unwrap_or(0.0);
        self.cursor.filter(|cursor| cursor.is_finite()).unwrap_or_else(contact)
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

/// Draws the teeth, and below them the values at the cursor.
pub fn draw(picture: &Picture, area: Rect, buffer: &mut Buffer) {
    let area = area.intersection(buffer.area);
    let (inputs, solution) = (picture.inputs, picture.solution);
    let moment = ContactState::at(inputs, solution, picture.angle());
    let values = moment
        .as_ref()
        .map(|moment| readings(moment, (inputs, solution), picture.units))
        .unwrap_or_default();
    let in_line = usize::from(area.width.saturating_sub(1) / VALUE).max(1);
    let most =
        1 + u16::from(area.height >= TWO_LINES_FROM) + u16::from(area.height >= THREE_LINES_FROM);
    let lines = (values.len().div_ceil(in_line).max(1) as u16).min(most);
    let [plot, below] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(lines)]).areas(area);
    for (values, row) in values.chunks(in_line).zip(below.rows()) {
        let values = values.iter().map(|value| {
            let text = symbol(&value.to_string(), picture.look.ascii).into_owned();
            text::padded(&text, usize::from(VALUE))
        });
        Line::raw(format!(" {}", values.collect::<String>())).render(row, buffer);
    }
    if plot.width >= SMALLEST.0 && plot.height >= SMALLEST.1 {
        Painter::new(picture, plot).draw(moment.as_ref(), buffer);
    }
}

/// Draws a picture into an area with the canvas of ratatui.
struct Painter<'a> {
    picture: &'a Picture<'a>,
    area: Rect,
    marker: Marker,
    /// The dots of a cell, horizontally and vertically.
    dots: (u16, u16),
    window: Window,
}

/// Indices of the styles of marks and contacts, after those of the lines.
const MARK: u8 = 6;
const CONTACT: u8 = 7;

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
        let ([left, right], [low, high]) = self.bounds();
        let canvas = Canvas::default()
            .marker(self.marker)
            .x_bounds([left, right])
            .y_bounds([low, high])
            .paint(|context| self.draw_scene(&scene, context));
        canvas.render(self.area, buffer);
        self.set_styles(buffer);
        for (at, word, style) in self.words(&scene, moment.map(|_| factor)) {
            let room = self.area.right().saturating_sub(at.x).into();
            buffer.set_stringn(at.x, at.y, word, room, Style::reset().patch(style));
        }
    }

    fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let (low, high) =
            (self.window.centre - self.window.half, self.window.centre + self.window.half);
        (bounds(low.x, high.x), bounds(low.y, high.y))
    }

    fn dot_height(&self) -> f64 {
        self.window.dot * view::CELL_HEIGHT * f64::from(self.dots.0) / f64::from(self.dots.1)
    }

    fn column(&self) -> f64 {
        self.window.dot * f64::from(self.dots.0)
    }

    fn draw_scene(&self, scene: &Scene, context: &mut Context) {
        for (ink, points) in &scene.lines {
            let (style, dash) = match ink {
                Ink::BaseCircle => (0, Some((0.0, 4.0))),
                Ink::LineOfAction => (0, Some((5.0, 4.0))),
                Ink::PathOfContact => (1, None),
                Ink::TipPath => (1, Some((0.0, 2.0))),
                Ink::DrivenBore | Ink::Driven => (2, None),
                Ink::IncomingTooth => (3, None),
                Ink::DriverBore | Ink::Driver => (4, None),
                Ink::StruckTooth => (5, None),
            };
            match dash {
                None => points.windows(2).for_each(|ends| stroke(context, ends[0], ends[1], style)),
                Some(dash) => self.draw_dashed(points, dash, style, context),
            }
        }
        // A cross of five dots, or one dot if a cell has one dot.
        let arm = f64::from(u8::from(self.dots.0 > 1));
        let arms =
            [Vector2::new(arm * self.window.dot, 0.0), Vector2::new(0.0, arm * self.dot_height())];
        let marks = scene.distinct_points(&self.window, 2.0 * self.column());
        let marks = marks.into_iter().map(|(_, at)| (at, MARK));
        let contacts = scene.contacts.iter().filter(|at| self.window.sees(**at));
        for (at, style) in marks.chain(contacts.map(|at| (*at, CONTACT))) {
            for arm in arms {
                stroke(context, at - arm, at + arm, style);
            }
        }
    }

    /// Draws dashes and gaps of a length in dots; dashes of length 0 are dots.
    fn draw_dashed(
        &self,
        points: &[Point2<f64>],
        (on, off): (f64, f64),
        style: u8,
        context: &mut Context,
    ) {
        let mut before = 0.0;
        for ends in points.windows(2) {
            let (from, way) = (ends[0], ends[1] - ends[0]);
            let length = way.norm() / self.window.dot;
            let at = |dots: f64| from + way * (dots / length).clamp(0.0, 1.0);
            if self.window.clip(from, ends[1]).is_some() {
                let first = ((before - on) / (on + off)).ceil() as i64;
                let starts = (first..).map(|dash| dash as f64 * (on + off) - before);
                for start in starts.take_while(|start| *start < length) {
                    stroke(context, at(start), at(start + on), style);
                }
            }
            before += length;
        }
    }

    /// The words of the picture: the gears, the scale and the factor of the gap in the corners, and
    /// names beside their points, of points close together only the most important one.
    fn words(&self, scene: &Scene, factor: Option<f64>) -> Vec<Word> {
        let (area, theme) = (self.area, self.picture.look.theme);
        let beside = |(name, point): (&str, Point2<f64>), style: Style| {
            let at = self.cell(point)?;
            let last = area.right().saturating_sub(name.width() as u16).max(area.x);
            Some((Position { x: (at.x + 1).min(last), ..at }, name.to_owned(), style))
        };
        let names = scene.distinct_points(&self.window, APART * self.column());
        let has_room = |name: &&(&str, Point2<f64>)| {
            let room = self.column() * (name.0.width() + 1) as f64;
            name.1.x + room < self.window.centre.x + self.window.half.x
        };
        let names = names.iter().filter(has_room).filter_map(|name| beside(*name, theme.focus));
        let exits = scene.exits.iter().filter_map(|exit| beside(*exit, theme.faint));
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
        exits.chain(names).chain(corners).collect()
    }

    /// The cell of a visible point.
    fn cell(&self, point: Point2<f64>) -> Option<Position> {
        let ([left, _], [_, high]) = self.bounds();
        let dot = |off: f64, size: f64, dots: u16| (off / size).round() as u16 / dots;
        self.window.sees(point).then(|| Position {
            x: self.area.x + dot(point.x - left, self.window.dot, self.dots.0),
            y: self.area.y + dot(high - point.y, self.dot_height(), self.dots.1),
        })
    }

    /// Sets the styles of the cells. The canvas stores only colours: the number of a colour is the
    /// index of its style.
    fn set_styles(&self, buffer: &mut Buffer) {
        let theme = self.picture.look.theme;
        let bold = |style: Style| style.add_modifier(Modifier::BOLD);
        let (driven, driver) = (theme.driven, theme.driver);
        let (marks, contacts) = (theme.focus, theme.active);
        let styles =
            [theme.faint, theme.path, driven, bold(driven), driver, bold(driver), marks, contacts];
        let faint = if self.picture.is_stale { theme.faint } else { Style::new() };
        let style_of = |colour: Color| match colour {
            Color::Indexed(number) => styles.get(usize::from(number)).copied(),
            _ => None,
        };
        for position in self.area.positions() {
            let cell = &mut buffer[position];
            let Some(style) = style_of(cell.fg) else { continue };
            // A half block has two colours, for its upper and its lower half.
            let below = style_of(cell.bg).map(|style| style.fg);
            (cell.fg, cell.bg) = (Color::Reset, Color::Reset);
            cell.set_style(style.patch(faint));
            match below {
                Some(Some(colour)) if Some(colour) != style.fg => _ = cell.set_bg(colour),
                Some(_) => _ = cell.set_symbol("█"),
                None => (),
            }
        }
    }
}

fn stroke(context: &mut Context, from: Point2<f64>, to: Point2<f64>, style: u8) {
    context.draw(&Segment::new(from.x, from.y, to.x, to.y, Color::Indexed(style)));
}

/// Every value of the method at a contact state, and the opening, in a fixed order.
#[must_use]
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
    Some(Reading { symbol: column.symbol, number, unit })
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

#[cfg(test)]
mod tests {
    use ratatui::layout::Size;

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
                (row / column - view::CELL_HEIGHT).abs() < 1e-9
                    && (column / painter.column() - 1.0).abs() < 1e-9
            );
            for (right, up) in [(0.02, -0.03), (-0.99, 0.99), (0.999, 0.999), (0.51, 0.13)] {
                let point = centre + Vector2::new(right * half.x, up * half.y);
                let mut buffer = Buffer::empty(size);
                let (across, upright) = painter.bounds();
                Canvas::default()
                    .marker(painter.marker)
                    .x_bounds(across)
                    .y_bounds(upright)
                    .paint(|context| stroke(context, point, point, MARK))
                    .render(size, &mut buffer);
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
