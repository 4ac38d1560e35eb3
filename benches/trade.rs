//! Accuracy against run time over the cases in `cases/`: `cargo bench --bench trade` prints the
//! table and draws the picture. With `TIPSTRIKE_REGENERATE=1` it writes `tests/trade/table.md`,
//! `assets/trade.svg` and the lines of docs/speed.md.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a benchmark prints its results"
)]

#[path = "../tests/trade/table.rs"]
mod table;

use table::{Row, Table};
use tipstrike::model::inputs::Method;
use tipstrike::report::chart::{Axis, Chart, Kind, Point, Series};
use tipstrike::report::svg;
use tipstrike::report::trade::{plotted_error, power_of_time};
use tipstrike::study::trade::{METHODS, STEADY, Setting, Subject};

fn main() {
    // `cargo test --benches` and `cargo bench -- --test` only check that the benchmark starts.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let trades = table::trades(STEADY);
    let made = Table::of(&trades);
    println!("{}", made.markdown());
    println!("{}", models(&trades));
    if std::env::var_os("TIPSTRIKE_REGENERATE").is_some() {
        made.keep();
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/trade.svg");
        std::fs::write(path, picture(&made)).expect("the picture is written");
        table::write_docs();
    }
}

/// The model error of each method, one line per case.
fn models(trades: &[(String, tipstrike::study::trade::Trade)]) -> String {
    let mut lines =
        vec!["| case | paper | exact | static |".to_owned(), "|---|---|---|---|".to_owned()];
    for (name, trade) in trades {
        let percent = |method: Method| {
            let mut models = trade.finest.iter();
            let off = models
                .find(|model| model.setting.method == method)
                .map_or([None; Subject::ALL.len()], |model| model.off);
            let needed = Subject::NEEDED.map(|subject| {
                off[subject as usize].map_or("-".to_owned(), |off| format!("{:.1}", 100.0 * off))
            });
            needed.join(" / ")
        };
        lines.push(format!(
            "| `{name}` | {} | {} | {} |",
            percent(Method::Paper),
            percent(Method::Exact),
            percent(Method::Static)
        ));
    }
    lines.join("\n")
}

/// Numerical error against time: one curve per method over its stations, and one over the
/// tolerances.
fn picture(table: &Table) -> String {
    let table_1 = tipstrike::case::Case::table_1();
    let pair = table_1.inputs().expect("the built-in case is valid");
    let stations = METHODS
        .map(|method| (format!("{}: stations", method.name()), Setting::usual(method, &pair), 1));
    let tolerances = ("dynamic: tolerance".to_owned(), Setting::usual(Method::Dynamic, &pair), 0);
    let series: Vec<Series> = stations
        .into_iter()
        .chain([tolerances])
        .map(|(name, usual, error)| {
            let alike = |setting: &Setting| {
                let same = if error == 1 {
                    setting.tolerance == usual.tolerance
                } else {
                    setting.stations == usual.stations
                };
                setting.is_finer_or_coarser(&usual)
                    && setting.accurate == usual.accurate
                    && setting.stations.is_some()
                    && same
            };
            let mut settings: Vec<Setting> = table::settings().into_iter().filter(alike).collect();
            settings.sort_by(|one, other| {
                other.tolerance.unwrap_or(0.0).total_cmp(&one.tolerance.unwrap_or(0.0))
            });
            let points = settings.iter().filter_map(|setting| {
                let row: &Row = table.0.iter().find(|row| row.setting == setting.to_string())?;
                let error = plotted_error(row.errors[error]?.0);
                Some(((row.seconds?.log10(), error.log10()), *setting == usual))
            });
            let (points, are_usual): (Vec<_>, Vec<bool>) = points.unzip();
            let usual = are_usual.iter().position(|is_usual| *is_usual);
            Series { name, pieces: vec![points], kind: Kind::Marks(usual) }
        })
        .collect();
    let axis = |name: &str, of: fn(&Point) -> f64, label: fn(f64) -> String| {
        let points = series.iter().flat_map(|series| series.pieces.iter().flatten());
        Axis::logarithmic(name, points.map(of), label)
    };
    let up = "relative error of the curve (stations), the numbers (tolerance)";
    svg::draw(&Chart {
        title: "Numerical error against time: median over the cases of cases/".to_owned(),
        across: axis("time of a whole solve", |point| point.0, power_of_time),
        up: axis(up, |point| point.1, |error| format!("{error:.0e}")),
        series,
        ..Chart::default()
    })
}
