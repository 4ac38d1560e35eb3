//! The pictures of the README are screens of the workbench: `TIPSTRIKE_REGENERATE=1 cargo test
//! --test picture` draws them again.
use crate::harness::{Desk, LARGE};

use std::fmt::Write;

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};
use tipstrike::case::{Document, EXAMPLES};
use tipstrike::tui::testing::Look;

const CELL: (f64, f64) = (8.4, 18.0);
const MARGIN: f64 = 12.0;

/// The name of a picture, its title, and the keys to its screen.
const PICTURES: [(&str, &str, &[&str]); 3] = [
    ("workbench", "The tipstrike workbench on Table 1", &[]),
    ("explanation", "The impact force explained", &["Esc", "2", "Enter"]),
    ("browser", "Opening a case", &["Ctrl-O", "Up", "Up", "Up"]),
];

#[test]
fn the_pictures_of_the_readme() {
    for (name, title, keys) in PICTURES {
        let path = format!("{}/assets/{name}.svg", env!("CARGO_MANIFEST_DIR"));
        let picture = taken(title, keys);
        if std::env::var_os("TIPSTRIKE_REGENERATE").is_some() {
            std::fs::write(&path, &picture).expect("the picture is written");
        }
        let kept = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(kept == picture, "{name}");
    }
}

/// The picture of a screen, in a folder with the examples.
fn taken(title: &str, keys: &[&str]) -> String {
    let mut desk = Desk::new(LARGE);
    std::fs::create_dir(desk.path("gears")).expect("a folder");
    for example in EXAMPLES {
        desk.write(&format!("gears/{}.toml", example.name), example.text);
    }
    desk.recents = vec![desk.path("gears/zhou-chen-2014.toml"), desk.path("gears/gone.toml")];
    let path = desk.path("gears/zhou-chen-2014.toml");
    desk.app = tipstrike::tui::testing::opened(
        Document::read(&path).expect("a good case"),
        Some(path),
        Look::FULL,
        LARGE,
    );
    desk.keys(keys);
    // The folder of a test has a different name in each run.
    let folder = desk.folder.path().display().to_string();
    let stand_in = format!("{:<1$}", "/home/me/drives", folder.chars().count());
    picture(title, &desk.buffer()).replace(&folder, &stand_in)
}

/// A screen as SVG: one text per row, split where the style changes, each piece at its column.
fn picture(title: &str, buffer: &Buffer) -> String {
    let (columns, rows) = (buffer.area.width, buffer.area.height);
    let (width, height) =
        (f64::from(columns) * CELL.0 + 2.0 * MARGIN, f64::from(rows) * CELL.1 + 2.0 * MARGIN);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" font-size=\"14\">\n\
         <title>{title}</title>\n<rect width=\"100%\" height=\"100%\" rx=\"8\" fill=\"#1b1f24\"/>\n"
    );
    for (y, row) in buffer.content.chunks(usize::from(columns)).enumerate() {
        let mut from = 0;
        for piece in row.chunk_by(|a, b| look(a) == look(b)) {
            add(&mut svg, piece, from, y);
            from += piece.len();
        }
    }
    svg + "</svg>\n"
}

fn add(svg: &mut String, piece: &[Cell], column: usize, row: usize) {
    let text: String = piece.iter().map(Cell::symbol).collect();
    let (x, y) = (MARGIN + column as f64 * CELL.0, MARGIN + row as f64 * CELL.1);
    let (fill, bold, reversed) = look(&piece[0]);
    let length = piece.len() as f64 * CELL.0;
    if reversed {
        let height = CELL.1;
        writeln!(svg, "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{length:.1}\" height=\"{height}\" fill=\"{fill}\"/>")
            .expect("room");
    }
    let ink = if reversed { "#1b1f24" } else { fill };
    let weight = if bold { " font-weight=\"bold\"" } else { "" };
    let baseline = y + 0.75 * CELL.1;
    let dots: String = text
        .chars()
        .enumerate()
        .flat_map(|(at, cell)| dots(cell, x + at as f64 * CELL.0, y))
        .collect();
    if !dots.is_empty() {
        writeln!(
            svg,
            "<path d=\"{dots}\" stroke=\"{ink}\" stroke-width=\"2\" stroke-linecap=\"round\"/>"
        )
        .expect("room");
    }
    let text = text.replace(is_dotted, " ");
    for (start, words) in stretches(&text) {
        let (x, length) = (x + start as f64 * CELL.0, words.chars().count() as f64 * CELL.0);
        let words = words.replace('&', "&amp;").replace('<', "&lt;");
        writeln!(svg, "<text x=\"{x:.1}\" y=\"{baseline:.1}\" textLength=\"{length:.1}\" fill=\"{ink}\"{weight}>{words}</text>")
            .expect("room");
    }
}

/// Braille is drawn as dots, because few fonts have it at the width of their letters.
fn is_dotted(cell: char) -> bool {
    ('\u{2800}'..='\u{28ff}').contains(&cell)
}

fn dots(cell: char, x: f64, y: f64) -> Vec<String> {
    const PLACES: [(u8, u8); 8] = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3)];
    let set = if is_dotted(cell) { u32::from(cell) - 0x2800 } else { 0 };
    let at = |(column, row): (u8, u8)| {
        let (x, y) = (
            x + (0.25 + 0.5 * f64::from(column)) * CELL.0,
            y + (0.125 + 0.25 * f64::from(row)) * CELL.1,
        );
        format!("M{x:.1} {y:.1}h0")
    };
    (0..8).filter(|bit| set >> bit & 1 == 1).map(|bit| at(PLACES[bit])).collect()
}

/// The pieces between gaps of two or more blanks, each with its column, so that columns are aligned
/// in any font.
fn stretches(text: &str) -> Vec<(usize, &str)> {
    let mut column = 0;
    let mut found = Vec::new();
    for part in text.split("  ") {
        let words = part.trim_start_matches(' ');
        let start = column + part.chars().count() - words.chars().count();
        if !words.trim_end().is_empty() {
            found.push((start, words.trim_end()));
        }
        column += part.chars().count() + 2;
    }
    found
}

/// Colour, bold and reverse.
fn look(cell: &Cell) -> (&'static str, bool, bool) {
    let dim = cell.modifier.contains(Modifier::DIM);
    let fill = match cell.fg {
        Color::Cyan => "#56b6c2",
        Color::Red => "#e06c75",
        Color::Yellow => "#e5c07b",
        Color::Green => "#98c379",
        Color::Magenta => "#c678dd",
        _ if dim => "#7f8794",
        _ => "#d7dae0",
    };
    (fill, cell.modifier.contains(Modifier::BOLD), cell.modifier.contains(Modifier::REVERSED))
}
