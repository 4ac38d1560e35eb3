//! The accuracy table: per quantity and decade of the deviation, the printed formulas and
//! tipstrike.

use std::fmt::Write;
use std::path::PathBuf;

use tipstrike::model::geometry::geometry;
use tipstrike::model::inputs::Method;
use tipstrike::model::position::{gap_by_quadrature, tip_at};
use tipstrike::model::{Quantity, solve};

use super::naive::Naive;
use super::rows::{self, Row};
use crate::envelope::Corner;
use crate::oracle;

/// Symbols of the table and the keys of the quantities; S has no key.
const QUANTITIES: [(&str, &str); 7] = [
    ("S", ""),
    ("u", "approach_angle_driven"),
    ("O1D", "contact_radius_driver"),
    ("r_b2'", "contact_normal_radius_driven"),
    ("ΔV_n", "normal_velocity"),
    ("ΔV_τ", "sliding_velocity"),
    ("F_S", "impact_force"),
];

/// Decades of Δ, in m.
const DECADES: [i32; 12] = [-15, -14, -13, -12, -11, -10, -9, -8, -7, -6, -5, -4];

/// Errors below this are rounding and may differ between machines.
const ROUNDING: f64 = 1e-16;

/// Median and greatest relative error.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    median: f64,
    greatest: f64,
}

/// A line of the table: a quantity by one kind of formula, over the decades.
struct Line {
    quantity: String,
    formula: String,
    cells: Vec<Option<Cell>>,
}

pub(crate) struct Table(Vec<Line>);

pub(crate) fn decade(row: &Row) -> i32 {
    row.answer("total_deviation").expect("a deviation").log10().floor() as i32
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/core/accuracy/table.md")
}

/// Stores the table beside the rows.
pub(crate) fn freeze() {
    std::fs::write(path(), Table::made(&rows::frozen()).markdown()).expect("the table is written");
}

impl Table {
    /// The table of the rows anywhere in the envelope and in the fit, by the exact position.
    pub(crate) fn made(rows: &[Row]) -> Table {
        let mut errors = vec![vec![Vec::new(); DECADES.len()]; 2 * QUANTITIES.len()];
        let plain = |row: &&Row| {
            matches!(row.corner, Corner::Anywhere | Corner::Fit)
                && row.inputs.method == Method::Exact
                && row.inputs.driven.tip_radius.is_none()
        };
        for row in rows.iter().filter(plain) {
            let Some(column) = DECADES.iter().position(|&of| of == decade(row)) else { continue };
            for (line, error) in errors_of(row).into_iter().flatten().enumerate() {
                errors[line][column].extend(error);
            }
        }
        let mut errors = errors.into_iter();
        let mut line = |quantity: &str, formula: &str| Line {
            quantity: quantity.to_owned(),
            formula: formula.to_owned(),
            cells: errors.next().expect("a line").into_iter().map(cell).collect(),
        };
        let both = QUANTITIES.map(|(symbol, _)| [line(symbol, "naive"), line(symbol, "tipstrike")]);
        Table(both.into_iter().flatten().collect())
    }

    pub(crate) fn stored() -> Table {
        let text = std::fs::read_to_string(path()).expect("the stored table");
        Table(text.lines().skip(2).map(read_line).collect())
    }

    pub(crate) fn markdown(&self) -> String {
        let mut text = "| quantity | formula |".to_owned();
        for decade in DECADES {
            write!(text, " 1e{decade} m |").expect("a string");
        }
        text += "\n|---|---|";
        text += &"---|".repeat(DECADES.len());
        for line in &self.0 {
            write!(text, "\n| {} | {} |", line.quantity, line.formula).expect("a string");
            for cell in &line.cells {
                let shown = cell.map_or("-".to_owned(), |cell| {
                    format!("{} / {}", short(cell.median), short(cell.greatest))
                });
                write!(text, " {shown} |").expect("a string");
            }
        }
        text + "\n"
    }

    /// Median errors of the printed formula and of tipstrike.
    pub(crate) fn median_at(&self, quantity: &str, decade: i32) -> (f64, f64) {
        let column = DECADES.iter().position(|&of| of == decade).expect("a decade");
        let of = |formula: &str| {
            let is_it = |line: &&Line| line.quantity == quantity && line.formula == formula;
            let line = self.0.iter().find(is_it).expect("a line");
            line.cells[column].expect("rows").median.max(ROUNDING)
        };
        (of("naive"), of("tipstrike"))
    }

    /// Checks that each cell has the same order of magnitude.
    pub(crate) fn agrees_with(&self, made: &Table) {
        assert_eq!(self.0.len(), made.0.len());
        for (stored, made) in self.0.iter().zip(&made.0) {
            let name = format!("{} {}", made.quantity, made.formula);
            assert_eq!(stored.quantity, made.quantity);
            for (stored, made) in stored.cells.iter().zip(&made.cells) {
                assert_eq!(stored.is_some(), made.is_some(), "{name}");
                let (Some(stored), Some(made)) = (stored, made) else { continue };
                for (stored, made) in
                    [(stored.median, made.median), (stored.greatest, made.greatest)]
                {
                    let ratio = stored.max(ROUNDING) / made.clamp(ROUNDING, 1.0);
                    assert!((0.1..=10.0).contains(&ratio), "{name} {made:e} {stored:e}");
                }
            }
        }
    }
}

/// Per quantity the error of the printed formula and of tipstrike.
fn errors_of(row: &Row) -> [[Option<f64>; 2]; 7] {
    let naive = Naive::of(&row.inputs);
    let solution = solve(&row.inputs, row.stages()).expect("a solution");
    let angle = row.answer("approach_angle_driven").expect("an angle");
    let exact_gap = oracle::gap_at(&row.inputs, angle).expect("a gap");
    let plain = geometry::<f64>(&row.inputs.shape()).expect("a geometry");
    let gap = gap_by_quadrature(&plain, &tip_at(&plain, angle));

    let deviation = row.answer("total_deviation").expect("a deviation");
    let naive_angle = naive.angle(deviation);
    let [radius, normal_radius, normal, sliding] = naive.at(naive_angle);
    let [u, radius, drop, normal, sliding] =
        [naive_angle, radius, normal_radius, normal, sliding].map(Some);
    let found = [None, u, radius, drop, normal, sliding, naive.force(naive_angle)];
    let mut errors = [[None; 2]; 7];
    for ((errors, (_, key)), found) in errors.iter_mut().zip(QUANTITIES).zip(found).skip(1) {
        let (Some(found), true) = (found, row.answers.contains_key(key)) else { continue };
        let ours = (Quantity::find(key).expect("a quantity").value)(&solution).expect("a value");
        *errors = [Some(row.off(key, found)), Some(row.off(key, ours))];
    }
    errors[0] = [Some(rows::off(naive.gap(angle), &exact_gap)), Some(rows::off(gap, &exact_gap))];
    errors
}

/// Median and greatest error; a value without correct digits has an error of 1.
fn cell(mut errors: Vec<f64>) -> Option<Cell> {
    for error in &mut errors {
        *error = error.min(1.0);
    }
    errors.sort_by(f64::total_cmp);
    Some(Cell { median: *errors.get(errors.len() / 2)?, greatest: *errors.last()? })
}

fn short(error: f64) -> String {
    if error == 0.0 { "0".to_owned() } else { format!("{error:.0e}") }
}

fn read_line(line: &str) -> Line {
    let words: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let cell = |text: &&str| {
        text.split_once(" / ")
            .map(|(median, greatest)| Cell { median: number(median), greatest: number(greatest) })
    };
    Line {
        quantity: words[0].to_owned(),
        formula: words[1].to_owned(),
        cells: words[2..].iter().map(cell).collect(),
    }
}
