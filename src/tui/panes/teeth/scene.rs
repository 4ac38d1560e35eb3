//! The visible parts of the pair: strokes, points with names placed without overlap, and their
//! drawing in cells: with the canvas of ratatui and the selected marker, or with letters in ASCII.

use nalgebra::Point2;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::{Color, Style};
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Line};
use unicode_width::UnicodeWidthStr;

use super::Picture;
use super::strokes::{Dash, Ink, Pen, Stroke};
use super::window::{Window, unit_of_length};
use crate::case::units::System;
use crate::model::ContactState;
use crate::model::contact_state::{first_contact, shares_load};
use crate::model::outline::{
    GearPose, Placed, driven_tangent_point, driver_tangent_point, on_line_of_action, tip_point,
};
use crate::model::position::tip_at;
use crate::numeric::decimal::significant;

/// Dashes and gaps, in dots.
const LINE_OF_ACTION: Dash = Dash { on: 5.0, off: 4.0 };
const CIRCLE: Dash = Dash { on: 0.0, off: 4.0 };
const PATH: Dash = Dash { on: 0.0, off: 2.0 };
/// The start of the path of the tip, as a multiple of the angle from D to E.
const PATH_FROM: f64 = 2.5;

/// The greatest distance between a point and its name, in columns and rows.
const NEAR: (i32, i32) = (8, 3);

/// Letters with their dots, four rows of two.
#[rustfmt::skip]
const LETTERS: [(char, &[u8]); 14] = [
    ('.', &[0b_01_00_00_00, 0b_10_00_00_00, 0b_00_01_00_00, 0b_00_10_00_00]),
    ('\'', &[0b_00_00_00_01, 0b_00_00_00_10, 0b_00_00_01_00, 0b_00_00_10_00, 0b_00_00_01_01, 0b_00_00_10_10]),
    (',', &[0b_01_01_00_00, 0b_10_10_00_00, 0b_01_10_00_00]),
    ('`', &[0b_00_00_10_01]),
    ('"', &[0b_00_00_00_11]),
    ('_', &[0b_11_00_00_00]),
    ('-', &[0b_00_00_11_00, 0b_00_11_00_00, 0b_00_01_10_00, 0b_00_10_01_00, 0b_00_01_11_00, 0b_00_10_11_00]),
    ('|', &[0b_01_01_01_01, 0b_10_10_10_10, 0b_00_01_01_01, 0b_00_10_10_10, 0b_01_01_01_00, 0b_10_10_10_00]),
    ('/', &[0b_01_01_10_10, 0b_01_10_10_10, 0b_01_01_01_10, 0b_01_10_10_00, 0b_00_01_10_10, 0b_00_01_01_10, 0b_01_01_10_00, 0b_01_11_10_10]),
    ('\\', &[0b_10_10_01_01, 0b_10_01_01_01, 0b_10_10_10_01, 0b_10_01_01_00, 0b_00_10_01_01, 0b_00_10_10_01, 0b_10_10_01_00, 0b_10_11_01_01]),
    (':', &[0b_00_01_01_00, 0b_00_10_10_00]),
    ('=', &[0b_11_00_11_00, 0b_00_11_00_11, 0b_11_00_00_11, 0b_00_11_11_00]),
    ('+', &[0b_01_01_11_01, 0b_10_10_11_10, 0b_01_11_01_01, 0b_10_11_10_10, 0b_11_01_01_01, 0b_11_10_10_10]),
    ('#', &[0b_11_11_11_11]),
];

/// The visible parts of the pair.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The visible part of the plane.
    pub window: Window,
    /// The strokes in drawing order.
    pub strokes: Vec<Stroke>,
    /// Points with a name, the most important first.
    pub(crate) points: Vec<Named>,
    /// Candidate positions for the name of each gear, the best first.
    pub(crate) bodies: [Vec<Point2<f64>>; 2],
    /// The exaggeration of the opening.
    pub factor: Option<f64>,
    /// Ends of the scale bar.
    pub(crate) bar: (Point2<f64>, Point2<f64>),
}

/// A point with a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Named {
    /// The position.
    pub(crate) at: Point2<f64>,
    pub(crate) name: &'static str,
}

impl Scene {
    /// The visible parts on a screen with a size.
    #[must_use]
    pub fn of(picture: &Picture, moment: Option<&ContactState>, size: Size) -> Scene {
        let Picture { inputs, solution, view, .. } = *picture;
        let window = Window::of(*view, inputs, solution, size, picture.drawn_marker());
        let factor = moment.map(|moment| view.factor(inputs, solution, moment));
        let angle = moment.map_or(0.0, |moment| moment.roll_angle_driver);
        let lead = moment.zip(factor).map_or(0.0, |(moment, factor)| moment.lead(factor))
            / solution.geometry.driver.base;
        let placing = GearPose::nominal(inputs, &solution.geometry, angle);
        let mut pen = Pen::new(&window);
        construction(&mut pen, picture);
        pen.gear(&placing.driven, 0.0, inputs.driven.bore_radius, [Ink::Driven, Ink::StruckDriven]);
        pen.gear(
            &placing.driver,
            -lead,
            inputs.driver.bore_radius,
            [Ink::Driver, Ink::StruckDriver],
        );
        let points = distinct(points(picture), &window);
        let contacts = moment
            .into_iter()
            .flat_map(|moment| contacts(picture, moment))
            .map(|at| (at, Ink::Contact));
        for (at, ink) in points.iter().map(|point| (point.at, Ink::Mark)).chain(contacts) {
            pen.cross(at, ink);
        }
        let bar = pen.bar(picture.units);
        Scene {
            strokes: pen.strokes,
            points,
            bodies: [bodies(&placing.driver), bodies(&placing.driven)],
            factor,
            bar,
            window,
        }
    }
}

/// The marks and words on the picture, so that no two words overlap.
#[derive(Debug)]
pub struct Labels {
    area: Rect,
    marks: Vec<Position>,
    words: Vec<Rect>,
}

impl Labels {
    /// No labels yet, on a picture in an area.
    #[must_use]
    pub fn new(area: Rect) -> Labels {
        Labels { area, marks: Vec::new(), words: Vec::new() }
    }

    /// Writes the scale, the factor, and every name that fits. Returns their cells.
    pub fn draw(mut self, scene: &Scene, picture: &Picture, buffer: &mut Buffer) -> Vec<Rect> {
        let theme = picture.look.theme;
        self.draw_scale(scene, picture, buffer);
        self.draw_factor(scene, Ink::Mark.style(theme), buffer);
        let cells: Vec<_> = scene
            .points
            .iter()
            .filter_map(|point| Some((point.name, self.cell(scene, point.at)?)))
            .collect();
        self.marks.extend(cells.iter().map(|(_, at)| *at));
        for (name, at) in cells {
            self.put_beside(name, at, usize::MAX, Ink::Mark.style(theme), buffer);
        }
        for (name, at) in self.ways_out(scene, picture) {
            self.put_beside(name, at, 0, theme.faint, buffer);
        }
        for (name, places, ink) in
            [("driver", &scene.bodies[0], Ink::Driver), ("driven", &scene.bodies[1], Ink::Driven)]
        {
            self.put_inside(name, scene, places, ink.style(theme), buffer);
        }
        self.words
    }

    /// Writes the length of the scale bar beside it.
    fn draw_scale(&mut self, scene: &Scene, picture: &Picture, buffer: &mut Buffer) {
        let Some((start, end)) = self.cell(scene, scene.bar.0).zip(self.cell(scene, scene.bar.1))
        else {
            return;
        };
        let text = length((scene.bar.1 - scene.bar.0).norm(), picture.units);
        let style = Ink::Mark.style(picture.look.theme);
        let line = Rect { y: end.y, height: 1, ..self.area };
        self.put(&text, Rect { x: end.x + 2, width: text.width() as u16, ..line }, style, buffer);
        self.words.push(Rect { x: start.x, width: end.x + 1 - start.x, ..line });
    }

    /// Writes the exaggeration of the gap in the first free corner, otherwise at any free position.
    fn draw_factor(&mut self, scene: &Scene, style: Style, buffer: &mut Buffer) {
        let Some(factor) = scene.factor else { return };
        let text = format!("gap x{}", times(factor));
        let width = text.width() as u16;
        let (left, right) =
            (self.area.x + 1, self.area.right().saturating_sub(width + 1).max(self.area.x));
        let (top, bottom) = (self.area.y, self.area.bottom() - 1);
        let corners =
            [(right, top), (left, top), (right, bottom), (left, bottom.saturating_sub(1))];
        let edges =
            [top, bottom].into_iter().flat_map(|y| (left..=right).rev().map(move |x| (x, y)));
        let inside = (top..=bottom).flat_map(|y| (left..=right).rev().map(move |x| (x, y)));
        let mut rooms = corners.into_iter().chain(edges).chain(inside).map(|(x, y)| Rect {
            x,
            y,
            width,
            height: 1,
        });
        let free = rooms.find(|room| self.is_free(*room) && covered(*room, buffer) == 0);
        self.put(&text, free.unwrap_or(Rect { x: right, y: top, width, height: 1 }), style, buffer);
    }

    /// The points where the line of action leaves the window towards a hidden point of tangency.
    fn ways_out(&self, scene: &Scene, picture: &Picture) -> Vec<(&'static str, Position)> {
        let geometry = &picture.solution.geometry;
        let (first, second) = (driver_tangent_point(geometry), driven_tangent_point(geometry));
        let Some((from, to)) = scene.window.clip(first, second) else {
            return Vec::new();
        };
        let at = |part: f64| first + (second - first) * part;
        let inward = 1e-9 * (to - from);
        let ends = [("to N1", first, from + inward), ("to N2", second, to - inward)];
        let out_of_sight = ends.into_iter().filter(|(_, end, _)| !scene.window.sees(*end));
        out_of_sight
            .filter_map(|(name, _, part)| Some((name, self.cell(scene, at(part))?)))
            .collect()
    }

    fn cell(&self, scene: &Scene, at: Point2<f64>) -> Option<Position> {
        let (x, y) = scene.window.cell(at)?;
        Some(Position { x: self.area.x + x, y: self.area.y + y })
    }

    /// Writes a name next to its point if it covers nothing there. Otherwise writes it close to its
    /// point, if no other point is nearer, or where it covers the fewest cells, at most `most`.
    fn put_beside(
        &mut self,
        name: &str,
        at: Position,
        most: usize,
        style: Style,
        buffer: &mut Buffer,
    ) {
        let width = i32::from(name.width() as u16);
        let places = [
            (1, 0),
            (2, -1),
            (2, 1),
            (-width, 0),
            (-width - 1, -1),
            (-width - 1, 1),
            (-width / 2, -1),
            (-width / 2, 1),
        ];
        let further = std::iter::once_with(|| further(width)).flatten();
        let rooms = places
            .into_iter()
            .chain(further)
            .filter_map(|(right, down)| self.room(at, right, down, width));
        let mut least: Option<(usize, Rect)> = None;
        for room in rooms.filter(|room| self.is_free(*room) && self.is_nearest(*room, at)) {
            let over = covered(room, buffer);
            if least.is_none_or(|(least, _)| over < least) {
                least = Some((over, room));
            }
            if over == 0 {
                break;
            }
        }
        if let Some((_, room)) = least.filter(|(over, _)| *over <= most) {
            self.put(name, room, style, buffer);
        }
    }

    /// Whether a word is nearest to its own mark.
    fn is_nearest(&self, room: Rect, at: Position) -> bool {
        let from = |mark: &Position| {
            let off =
                (i32::from(room.x) - i32::from(mark.x), i32::from(room.y) - i32::from(mark.y));
            distance(off, i32::from(room.width))
        };
        self.marks.iter().all(|mark| *mark == at || from(mark) > from(&at))
    }

    /// Writes a name at the first position where it covers nothing.
    fn put_inside(
        &mut self,
        name: &str,
        scene: &Scene,
        places: &[Point2<f64>],
        style: Style,
        buffer: &mut Buffer,
    ) {
        let width = i32::from(name.width() as u16);
        let cells = places.iter().filter_map(|place| self.cell(scene, *place));
        let mut rooms = cells.filter_map(|at| self.room(at, -width / 2, 0, width));
        let found = rooms.find(|room| self.is_free(*room) && covered(*room, buffer) == 0);
        if let Some(room) = found {
            self.put(name, room, style, buffer);
        }
    }

    /// The cells of a word at an offset from a position; `None` if they leave the picture.
    fn room(&self, at: Position, right: i32, down: i32, width: i32) -> Option<Rect> {
        let (x, y) = (
            u16::try_from(i32::from(at.x) + right).ok()?,
            u16::try_from(i32::from(at.y) + down).ok()?,
        );
        let room = Rect { x, y, width: u16::try_from(width).ok()?, height: 1 };
        (self.area.intersection(room) == room).then_some(room)
    }

    /// Whether the cells contain no mark and no word, and no word is beside them.
    fn is_free(&self, room: Rect) -> bool {
        let spaced = Rect { x: room.x.saturating_sub(1), width: room.width + 2, ..room };
        !self.marks.iter().any(|mark| room.contains(*mark))
            && !self.words.iter().any(|word| word.intersects(spaced))
    }

    fn put(&mut self, text: &str, room: Rect, style: Style, buffer: &mut Buffer) {
        let room = room.intersection(self.area);
        buffer.set_stringn(room.x, room.y, text, room.width.into(), Style::reset().patch(style));
        self.words.push(room);
    }
}

/// Draws the strokes of a scene.
pub fn draw_strokes(scene: &Scene, picture: &Picture, area: Rect, buffer: &mut Buffer) {
    let canvas = Canvas::default()
        .marker(picture.drawn_marker())
        .x_bounds(scene.window.across())
        .y_bounds(scene.window.upright())
        .paint(|context| {
            for stroke in &scene.strokes {
                context.draw(&Line::new(
                    stroke.from.x,
                    stroke.from.y,
                    stroke.to.x,
                    stroke.to.y,
                    stroke.ink.number(),
                ));
            }
        });
    canvas.render(area, buffer);
    for position in area.positions() {
        if let Some(cell) = buffer.cell_mut(position) {
            finish(cell, picture);
        }
    }
}

/// Draws base circles, line of action, path of contact, and path of the tip before it.
fn construction(pen: &mut Pen, picture: &Picture) {
    let geometry = &picture.solution.geometry;
    let centre = Point2::new(geometry.centre_distance, 0.0);
    pen.circle(Point2::origin(), geometry.driver.base, Some(CIRCLE), Ink::Construction);
    pen.circle(centre, geometry.driven.base, Some(CIRCLE), Ink::Construction);
    let line = |from: f64, to: f64| {
        move |part: f64| on_line_of_action(geometry, from + part * (to - from))
    };
    pen.curve(
        line(0.0, geometry.tangent_length),
        geometry.tangent_length,
        Some(LINE_OF_ACTION),
        Ink::Construction,
    );
    pen.curve(line(geometry.start, geometry.end), geometry.end - geometry.start, None, Ink::Path);
    let from = PATH_FROM * first_contact(picture.solution).unwrap_or(0.0);
    let path = |part: f64| tip_point(geometry, &tip_at(geometry, part * from));
    pen.curve(path, from * geometry.driven.tip, Some(PATH), Ink::Path);
}

/// D, E, D', the pitch point, the end of contact, the points of tangency and the centres. D' is the
/// driven tip at the end of the impact, at most at E. `static` and `dynamic` have no D'.
fn points(picture: &Picture) -> Vec<Named> {
    let Picture { inputs, solution, .. } = *picture;
    let geometry = &solution.geometry;
    let mut points = Vec::new();
    let mut add = |name, at| points.push(Named { at, name });
    let start = on_line_of_action(geometry, geometry.start);
    let contact = first_contact(solution);
    let on_way = |angle: f64| tip_point(geometry, &tip_at(geometry, angle));
    let turn = solution
        .impact
        .map(|impact| inputs.driven_speed() * impact.duration)
        .filter(|_| !shares_load(solution));
    if let Some(contact) = contact {
        add("D", on_way(contact));
    }
    match contact.zip(turn) {
        Some((contact, turn)) if turn < contact => {
            add("E", start);
            add("D'", on_way(contact - turn));
        }
        Some(_) => add("E=D'", start),
        None => add("E", start),
    }
    add("P", on_line_of_action(geometry, geometry.start + geometry.approach_length));
    add("B", on_line_of_action(geometry, geometry.end));
    add("N1", driver_tangent_point(geometry));
    add("N2", driven_tangent_point(geometry));
    add("O1", Point2::origin());
    add("O2", Point2::new(geometry.centre_distance, 0.0));
    points
}

/// The visible points without those closer than two columns to a previous point.
fn distinct(points: Vec<Named>, window: &Window) -> Vec<Named> {
    let mut kept: Vec<Named> = Vec::new();
    for point in points.into_iter().filter(|point| window.sees(point.at)) {
        if kept.iter().all(|other| (other.at - point.at).norm() >= 2.0 * window.column()) {
            kept.push(point);
        }
    }
    kept
}

/// The contact points: of the incoming pair from the first contact on, and of the pairs ahead of
/// it, one base pitch apart on the path of contact.
fn contacts(picture: &Picture, moment: &ContactState) -> Vec<Point2<f64>> {
    let geometry = &picture.solution.geometry;
    let incoming = geometry.start - moment.roll_angle_driver * geometry.driver.base;
    let ahead = (1..10).map(|pair| incoming + f64::from(pair) * geometry.base_pitch);
    let touching = ahead.filter(|length| (geometry.start..=geometry.end).contains(length));
    let own = moment.touches().then_some(moment.point);
    touching.map(|length| on_line_of_action(geometry, length)).chain(own).collect()
}

/// Positions inside a gear: on the centre lines of the teeth, from the middle of a tooth to the
/// centre.
fn bodies(gear: &Placed) -> Vec<Point2<f64>> {
    let circles = gear.outline.profile().circles();
    let depth = circles.tip - circles.root;
    let radii = [0.5, 0.0, -0.5, -1.2, -2.5, -5.0].map(|part| circles.root + part * depth);
    let inside = radii.into_iter().filter(|radius| *radius > 0.0);
    let on_teeth = inside.flat_map(|radius| {
        [0, 1, -1, 2, -2].map(|number| gear.tooth(number) * Point2::new(radius, 0.0))
    });
    on_teeth.collect()
}

/// The distance in columns between a point and a word at an offset from it.
fn distance((right, down): (i32, i32), width: i32) -> i32 {
    right.max(1 - width - right).max(0) + 2 * down.abs()
}

/// Offsets of a word from its point, the nearest first.
fn further(width: i32) -> Vec<(i32, i32)> {
    let columns = |down: i32| (-NEAR.0 - width..=NEAR.0).map(move |right| (right, down));
    let mut places: Vec<(i32, i32)> = (-NEAR.1..=NEAR.1).flat_map(columns).collect();
    places.sort_by_key(|&place| distance(place, width));
    places
}

/// The number of cells that are not blank.
fn covered(room: Rect, buffer: &Buffer) -> usize {
    room.positions()
        .filter(|position| {
            buffer.cell(*position).is_some_and(|cell| !cell.symbol().trim().is_empty())
        })
        .count()
}

/// A length in a suitable unit.
fn length(length: f64, system: System) -> String {
    let (unit, name) = unit_of_length(length, system);
    format!("{} {name}", significant(length / unit, 1))
}

/// A factor as text: a whole number, or with one decimal.
fn times(factor: f64) -> String {
    if (factor - factor.round()).abs() < 1e-9 {
        format!("{factor:.0}")
    } else {
        format!("{factor:.1}")
    }
}

/// Sets the style of a cell of the canvas, and its letter in ASCII mode.
fn finish(cell: &mut Cell, picture: &Picture) {
    let theme = picture.look.theme;
    let Some(ink) = Ink::of(cell.fg) else { return };
    let style =
        if picture.is_stale { ink.style(theme).patch(theme.faint) } else { ink.style(theme) };
    let below = Ink::of(cell.bg).map(|ink| ink.style(theme).fg);
    let both = below.is_some_and(|below| below.is_none() || below == style.fg);
    (cell.fg, cell.bg) = (Color::Reset, Color::Reset);
    cell.set_style(style);
    if both {
        cell.set_symbol("█");
    } else if let Some(Some(colour)) = below {
        cell.set_bg(colour);
    }
    if picture.look.ascii {
        let letter = cell.symbol().chars().next().and_then(pattern).map_or(' ', letter);
        cell.set_char(letter);
    }
}

/// The dots of a Braille character row by row, the left dot first; the top left dot is the lowest
/// bit.
fn pattern(sign: char) -> Option<u8> {
    const PLACES: [u8; 8] = [0, 2, 4, 1, 3, 5, 6, 7];
    let dots = u32::from(sign).checked_sub(0x2800).and_then(|dots| u8::try_from(dots).ok())?;
    Some(
        (0..8)
            .filter(|bit| dots & 1 << bit != 0)
            .fold(0, |pattern, bit| pattern | 1 << PLACES[bit]),
    )
}

/// The letter most similar to a pattern of dots.
fn letter(pattern: u8) -> char {
    let off = |covers: &[u8]| covers.iter().map(|dots| (dots ^ pattern).count_ones()).min();
    if pattern == 0 {
        ' '
    } else {
        LETTERS.iter().min_by_key(|(_, covers)| off(covers)).map_or('*', |&(letter, _)| letter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_are_read_row_by_row() {
        assert_eq!(pattern('⠁'), Some(0b_00_00_00_01));
        assert_eq!(pattern('⡀'), Some(0b_01_00_00_00));
        assert_eq!(pattern('⢸'), Some(0b_10_10_10_10));
        assert_eq!(pattern('⣿'), Some(0xff));
        assert_eq!((pattern('x'), pattern(' ')), (None, None));
    }

    #[test]
    fn letters_follow_the_direction_of_a_line() {
        let drawn =
            "⣀⠤⠒⠉⢸⡇⡜⢣⣿⠈⡀".chars().map(|sign| letter(pattern(sign).unwrap())).collect::<String>();
        assert_eq!(drawn, r#"_--"||/\#'."#);
        assert!((1..=u8::MAX).all(|pattern| letter(pattern).is_ascii_graphic()));
        assert_eq!(letter(0), ' ');
    }
}
