//! Draws strokes into cells: with the canvas of ratatui and the selected marker, or with letters in
//! ASCII mode.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Line};

use super::ink::Ink;
use super::picture::Picture;
use super::scene::Scene;

/// Draws the strokes of a scene.
pub fn draw(scene: &Scene, picture: &Picture, area: Rect, buffer: &mut Buffer) {
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
