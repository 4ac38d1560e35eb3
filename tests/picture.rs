//! The README's picture is what the workbench shows: `TIPSTRIKE_REGENERATE=1 cargo test --test picture` draws it anew.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on says why")]
#![cfg(feature = "tui")]

mod desk;

use std::fmt::Write;

use desk::Desk;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;
use ratatui::style::{Color, Modifier};

const SIZE: Size = Size { width: 110, height: 36 };
const CELL: (f64, f64) = (8.4, 18.0);
const MARGIN: f64 = 12.0;

#[test]
fn the_picture_of_the_readme() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/workbench.svg");
    let picture = picture(&Desk::new(SIZE).buffer(SIZE));
    if std::env::var_os("TIPSTRIKE_REGENERATE").is_some() {
        std::fs::write(path, &picture).expect("the picture is written");
    }
    let kept = std::fs::read_to_string(path).unwrap_or_default();
    assert!(kept == picture, "assets/workbench.svg is not what the workbench shows: draw it anew with TIPSTRIKE_REGENERATE=1");
}

/// A screen as SVG: a text a row, cut where the style changes, each piece at its column.
fn picture(buffer: &Buffer) -> String {
    let (width, height) = (f64::from(SIZE.width) * CELL.0 + 2.0 * MARGIN, f64::from(SIZE.height) * CELL.1 + 2.0 * MARGIN);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.1} {height:.1}\" font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" font-size=\"14\">\n\
         <title>The tipstrike workbench on Table 1</title>\n<rect width=\"100%\" height=\"100%\" rx=\"8\" fill=\"#1b1f24\"/>\n"
    );
    for (y, row) in buffer.content.chunks(usize::from(SIZE.width)).enumerate() {
        let mut from = 0;
        for piece in row.chunk_by(|a, b| look(a) == look(b)) {
            add(&mut svg, piece, from, y);
            from += piece.len();
        }
    }
    svg + "</svg>\n"
}

/// One piece of a row in one style.
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
    if text.trim().is_empty() {
        return;
    }
    let ink = if reversed { "#1b1f24" } else { fill };
    let weight = if bold { " font-weight=\"bold\"" } else { "" };
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    let baseline = y + 0.75 * CELL.1;
    writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{baseline:.1}\" textLength=\"{length:.1}\" fill=\"{ink}\"{weight} xml:space=\"preserve\">{text}</text>"
    )
    .expect("room");
}

/// Colour, bold and reversed.
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
