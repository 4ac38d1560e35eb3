//! The teeth pane: the pair true to scale, and the values at the cursor.

mod view;

use std::fmt;

use nalgebra::{Point2, Vector2};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Context, Line};
use unicode_width::UnicodeWidthStr;

use super::plot::bounds;
use crate::case::units::System;
use crate::case::units::system::shown;
use crate::model::{ContactState, Inputs, Solution, contact_state};
use crate::report::stations::{COLUMNS, Column};
use crate::report::teeth::{Ink, Scene, Window, scale_bar};
use crate::tui::ascii::symbol;
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

/// Letters with similar patterns of dots.
#[rustfmt::skip]
const LETTERS: [(char, &str); 14] = [
    ('.', "⡀⢀⠄⠠"), ('\'', "⠁⠈⠂⠐⠃⠘"), (',', "⡄⢠⡠"), ('`', "⠑"), ('"', "⠉"), ('_', "⣀"), ('-', "⠒⠤⠔⠢⠖⠲"),
    ('|', "⡇⢸⠇⠸⡆⢰"), ('/', "⡜⡸⡎⡰⠜⠎⡔⡼"), ('\\', "⢣⢇⢱⢆⠣⠱⢢⢧"), (':', "⠆⠰"), ('=', "⣒⠭⣉⠶"),
    ('+', "⡗⢺⡧⢼⣇⣸"), ('#', "⣿"),
];

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
    let in_line = (area.width.saturating_sub(1) / VALUE).max(1);
    let lines = (values.len() as u16).div_ceil(in_line).max(1).min(
        1 + u16::from(area.height >= TWO_LINES_FROM) + u16::from(area.height >= THREE_LINES_FROM),
    );
    let plot = Rect { height: area.height.saturating_sub(lines), ..area };
    for (value, place) in values.iter().zip(0..lines * in_line) {
        let (column, row) = (1 + place % in_line * VALUE, place / in_line);
        if row < area.height && column < area.width {
            let text = symbol(&value.to_string(), picture.look.ascii).into_owned();
            let room = usize::from(area.width - column);
            buffer.set_stringn(area.x + column, plot.bottom() + row, text, room, Style::new());
        }
    }
    if plot.width >= SMALLEST.0 && plot.height >= SMALLEST.1 {
        Painter::new(picture, plot).draw(moment.as_ref(), buffer);
    }
}

/// Draws a picture into an area: with the canvas of ratatui and the selected marker, or with letters
/// in ASCII, which are chosen from the dots of Braille.
struct Painter<'a> {
    picture: &'a Picture<'a>,
    area: Rect,
    marker: Marker,
    /// The dots of a cell, horizontally and vertically.
    dots: (u16, u16),
    window: Window,
    /// The canvas stores only colours: the number of a colour is an index into these styles until
    /// the cells get their style.
    styles: [Style; 8],
}

/// Indices of the styles of marks and contacts.
const MARK: usize = 6;
const CONTACT: usize = 7;

/// A word on the picture.
type Word = (Rect, String, Style);

impl<'a> Painter<'a> {
    fn new(picture: &'a Picture<'a>, area: Rect) -> Painter<'a> {
        let marker = if picture.look.ascii { Marker::Braille } else { picture.marker };
        let dots = match marker {
            Marker::Braille | Marker::Octant => (2, 4),
            Marker::Sextant => (2, 3),
            Marker::Quadrant => (2, 2),
            Marker::HalfBlock => (1, 2),
            _ => (1, 1),
        };
        let theme = picture.look.theme;
        let bold = |style: Style| style.add_modifier(Modifier::BOLD);
        let [driven, driver] = [theme.driven, theme.driver];
        let styles = [
            theme.faint,
            theme.path,
            driven,
            bold(driven),
            driver,
            bold(driver),
            theme.focus,
            theme.active,
        ];
        let window = picture.view.window(picture.inputs, picture.solution, area.as_size(), dots);
        Painter { picture, area, marker, dots, window, styles }
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
        for position in self.area.positions() {
            self.finish(&mut buffer[position]);
        }
        for (room, word, style) in self.words(&scene, moment.map(|_| factor)) {
            buffer.set_stringn(
                room.x,
                room.y,
                word,
                room.width.into(),
                Style::reset().patch(style),
            );
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
        let marks = self.named(scene).into_iter().map(|(_, at)| (at, MARK));
        let contacts = scene.contacts.iter().filter(|at| self.window.sees(**at));
        for (at, style) in marks.chain(contacts.map(|at| (*at, CONTACT))) {
            for arm in arms {
                stroke(context, at - arm, at + arm, style);
            }
        }
        let (from, to) = self.bar().0;
        stroke(context, from, to, MARK);
        let up = Vector2::new(0.0, self.dot_height());
        for end in [from, to] {
            stroke(context, end, end + up, MARK);
        }
    }

    /// Draws dashes and gaps of a length in dots; dashes of length 0 are dots.
    fn draw_dashed(
        &self,
        points: &[Point2<f64>],
        (on, off): (f64, f64),
        style: usize,
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

    /// The ends of the scale bar in the lower left corner, and its length as text.
    fn bar(&self) -> ((Point2<f64>, Point2<f64>), String) {
        let Window { centre, half, dot } = self.window;
        let (length, text) = scale_bar(BAR * 2.0 * half.x, self.picture.units);
        let from = centre - half + Vector2::new(2.0 * dot, 0.25 * self.dot_height());
        ((from, from + Vector2::new(length, 0.0)), text)
    }

    fn named(&self, scene: &Scene) -> Vec<(&'static str, Point2<f64>)> {
        scene.distinct_points(&self.window, 2.0 * self.column())
    }

    /// The words of the picture: the gears, the scale and the factor of the gap in the corners, and
    /// each name beside its point where it covers no mark and no other word.
    fn words(&self, scene: &Scene, factor: Option<f64>) -> Vec<Word> {
        let (area, theme) = (self.area, self.picture.look.theme);
        let corner = |text: String, x: u16, y: u16, style: Style| {
            let width = (text.width() as u16).min(area.right().saturating_sub(x));
            (Rect { x, y, width, height: 1 }, text, style)
        };
        let ending = |text: &str| area.right().saturating_sub(text.len() as u16 + 1);
        let ((from, to), length) = self.bar();
        let [from, to] = [from, to].map(|end| self.cell(end).map_or(area.x, |cell| cell.x));
        let bottom = area.bottom() - 1;
        let mut words = vec![
            corner(" driver ".to_owned(), area.x, area.y, theme.driver),
            corner(" driven".to_owned(), ending(" driven"), area.y, theme.driven),
            corner(length, to + 2, bottom, theme.focus),
        ];
        words.extend(factor.map(|factor| {
            let text = format!("gap x{}", (10.0 * factor).round() / 10.0);
            let x = ending(&text);
            corner(text, x, bottom, theme.focus)
        }));
        let mut taken = vec![Rect { x: from, y: bottom, width: to + 1 - from, height: 1 }];
        taken.extend(words.iter().map(|(room, ..)| *room));
        let named = self.named(scene);
        let marks: Vec<Position> = named.iter().filter_map(|(_, at)| self.cell(*at)).collect();
        let points = named.iter().map(|point| (*point, theme.focus));
        for ((name, at), style) in points.chain(scene.exits.iter().map(|exit| (*exit, theme.faint)))
        {
            let width = i32::try_from(name.width()).unwrap_or_default();
            let sides = [(1, 0), (-width, 0), (2, -1), (2, 1), (-width - 1, -1), (-width - 1, 1)];
            let room = |(right, down): (i32, i32)| {
                let at = self.cell(at)?;
                let x = u16::try_from(i32::from(at.x) + right).ok()?;
                let y = u16::try_from(i32::from(at.y) + down).ok()?;
                let room = Rect { x, y, width: width as u16, height: 1 };
                let spaced = Rect { x: x.saturating_sub(1), width: room.width + 2, ..room };
                let is_free = area.intersection(room) == room
                    && !marks.iter().any(|mark| room.contains(*mark))
                    && !taken.iter().any(|word| word.intersects(spaced));
                is_free.then_some(room)
            };
            if let Some(room) = sides.into_iter().find_map(room) {
                taken.push(room);
                words.push((room, name.to_owned(), style));
            }
        }
        words
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

    /// Sets the style of a cell of the canvas, and its letter in ASCII mode.
    fn finish(&self, cell: &mut Cell) {
        let faint =
            if self.picture.is_stale { self.picture.look.theme.faint } else { Style::new() };
        let style_of = |colour: Color| match colour {
            Color::Indexed(number) => self.styles.get(usize::from(number)).copied(),
            _ => None,
        };
        let Some(style) = style_of(cell.fg).map(|style| style.patch(faint)) else { return };
        // A half block has two colours, for its upper and its lower half.
        let below = style_of(cell.bg).map(|style| style.fg);
        (cell.fg, cell.bg) = (Color::Reset, Color::Reset);
        cell.set_style(style);
        match below {
            Some(Some(colour)) if Some(colour) != style.fg => {
                cell.set_bg(colour);
            }
            Some(_) => {
                cell.set_symbol("█");
            }
            None => (),
        }
        if self.picture.look.ascii {
            cell.set_char(cell.symbol().chars().next().map_or(' ', letter));
        }
    }
}

fn stroke(context: &mut Context, from: Point2<f64>, to: Point2<f64>, style: usize) {
    context.draw(&Line::new(from.x, from.y, to.x, to.y, Color::Indexed(style as u8)));
}

/// The letter most similar to a pattern of dots.
fn letter(pattern: char) -> char {
    let off = |dots: char| (u32::from(dots) ^ u32::from(pattern)).count_ones();
    let least_off = |dots: &str| dots.chars().map(off).min();
    let nearest = LETTERS.iter().min_by_key(|(_, dots)| least_off(dots));
    nearest.filter(|_| !matches!(pattern, ' ' | '\u{2800}')).map_or(' ', |(letter, _)| *letter)
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
    let interpolated =
        moment.interpolated.as_ref().and_then(|one| column.of(solution, &one.station));
    let value = interpolated.or_else(|| without_contact(moment, key));
    if value.is_none() && !column.methods.contains(&solution.method) {
        return None;
    }
    let digits = moment
        .interpolated
        .as_ref()
        .map_or(column.digits, |interpolated| column.digits_of(interpolated));
    let usual = if column.shown == "1" { "" } else { system.unit(column.shown) };
    let (number, unit) = value.map_or((None, usual), |value| {
        let (number, unit) =
            shown(column.resolved(value, inputs, solution), column.shown, digits, system);
        (Some(number), unit)
    });
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

    #[test]
    fn letters_follow_the_direction_of_a_line() {
        let drawn = "⣀⠤⠒⠉⢸⡇⡜⢣⣿⠈⡀".chars().map(letter).collect::<String>();
        assert_eq!(drawn, r#"_--"||/\#'."#);
        assert!(('\u{2801}'..='\u{28ff}').all(|pattern| letter(pattern).is_ascii_graphic()));
        assert_eq!((letter('\u{2800}'), letter(' ')), (' ', ' '));
    }

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
            let words = painter.words(&scene, Some(20.0));
            for (at, (room, word, _)) in words.iter().enumerate() {
                assert_eq!(painter.area.intersection(*room), *room, "{word}");
                let names = words[..at].iter().filter(|_| at >= 4);
                assert!(names.into_iter().all(|(other, ..)| !other.intersects(*room)), "{word}");
            }
        });
    }
}
