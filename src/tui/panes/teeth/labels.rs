//! Names of points, the scale and the factor, placed without overlap.

use nalgebra::Point2;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::ink::Ink;
use super::picture::Picture;
use super::scene::Scene;
use super::window::unit_of_length;
use crate::case::units::System;
use crate::model::gear_pose::{driven_tangent_point, driver_tangent_point};
use crate::numeric::decimal::significant;

/// The greatest distance between a point and its name, in columns and rows.
const NEAR: (i32, i32) = (8, 3);

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
