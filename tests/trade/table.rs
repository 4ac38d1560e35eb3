//! The errors of the settings over the cases in `cases/`: computed, stored and compared.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::Duration;

use tipstrike::case::file::Document;
use tipstrike::model::Inputs;
use tipstrike::study::trade::{Differences, Setting, Subject, Trade, greatest, trade};

/// Errors below this are rounding and may differ between machines.
const ROUNDING: f64 = 1e-11;

/// The cases, by name.
pub(crate) fn cases() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let files =
        std::fs::read_dir(folder).expect("the cases").map(|entry| entry.expect("an entry").path());
    let mut cases: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    // The trade of a pair with slices has other settings.
    cases.retain(|path| inputs(path).face().is_none());
    cases.sort();
    cases
}

/// The inputs of a case without its tooth compliance, so that every case has the same settings.
pub(crate) fn inputs(path: &Path) -> Inputs {
    let document = Document::read(path).unwrap_or_else(|error| panic!("{error}"));
    let inputs = document
        .case
        .inputs()
        .unwrap_or_else(|problems| panic!("{}: {}", path.display(), problems[0]));
    Inputs { tooth_compliance: None, ..inputs }
}

/// Every setting that is compared in each case.
pub(crate) fn settings() -> Vec<Setting> {
    let table_1 = tipstrike::case::Case::table_1();
    Setting::all(&table_1.inputs().expect("the built-in case is valid"))
}

/// A setting over all cases.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// The setting as text.
    pub(crate) setting: String,
    /// Median and greatest numerical error of the numbers, of the curve, and in total.
    pub(crate) errors: [Option<(f64, f64)>; 3],
}

/// The table.
pub(crate) struct Table(pub(crate) Vec<Row>);

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/trade/table.md")
}

/// Every case and its trade study, in the order of `cases`.
fn trades() -> Vec<(String, Trade)> {
    let made = |path: PathBuf| {
        let inputs = Inputs { within: 0.05, ..inputs(&path) };
        let found = trade(&inputs, Duration::ZERO, &|| true, &mut |_| ());
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        (name, found.unwrap_or_else(|refusal| panic!("{}: {refusal}", path.display())))
    };
    cases().into_iter().map(made).collect()
}

/// The trade study of every case, computed once for all tests of a program; the times are those of
/// a loaded machine.
pub(crate) fn traded_once() -> &'static [(String, Trade)] {
    static TRADES: LazyLock<Vec<(String, Trade)>> = LazyLock::new(trades);
    &TRADES
}

impl Table {
    pub(crate) fn of(trades: &[(String, Trade)]) -> Table {
        Table(settings().iter().map(|setting| row(setting, trades)).collect())
    }

    pub(crate) fn stored() -> Table {
        let text = std::fs::read_to_string(path()).expect("the stored table");
        Table(text.lines().skip(2).map(read).collect())
    }

    pub(crate) fn keep(&self) {
        std::fs::write(path(), self.markdown()).expect("the table is written");
    }

    /// As Markdown.
    pub(crate) fn markdown(&self) -> String {
        let mut text = "| setting | numbers | curve | total |\n|---|---|---|---|\n".to_owned();
        for row in &self.0 {
            let shown = |(median, most)| format!("{median:.1e} / {most:.1e}");
            let errors = row.errors.map(|error| error.map_or("-".to_owned(), shown));
            writeln!(text, "| {} | {} |", row.setting, errors.join(" | ")).expect("a string");
        }
        text
    }

    /// Checks that no error of the other table is more than twice that of this table; times may
    /// differ.
    pub(crate) fn holds(&self, made: &Table) {
        let names =
            |table: &Table| table.0.iter().map(|row| row.setting.clone()).collect::<Vec<_>>();
        assert_eq!(names(self), names(made), "the stored table has other settings");
        for (stored, made) in self.0.iter().zip(&made.0) {
            for (stored_error, error) in stored.errors.iter().zip(&made.errors) {
                let held = match (stored_error, error) {
                    (Some(stored), Some(made)) => {
                        made.0 <= 2.0 * stored.0.max(ROUNDING)
                            && made.1 <= 2.0 * stored.1.max(ROUNDING)
                    }
                    (None, None) => true,
                    _ => false,
                };
                assert!(held, "{}: {stored_error:?} is stored and {error:?} is made", made.setting);
            }
        }
    }
}

fn row(setting: &Setting, trades: &[(String, Trade)]) -> Row {
    let all = trades.iter().flat_map(|(_, trade)| &trade.settings);
    let found: Vec<_> = all.filter(|measured| measured.setting == *setting).collect();
    let figures = || found.iter().filter_map(|measured| measured.found.as_ref().ok());
    let numbers =
        figures().filter_map(|figures| greatest(&without_curve(&figures.numerical))).collect();
    let curve =
        figures().filter_map(|figures| figures.numerical[Subject::Curve as usize]).collect();
    let total = found.iter().filter_map(|measured| measured.total()).collect();
    Row { setting: setting.to_string(), errors: [numbers, curve, total].map(median) }
}

fn without_curve(differences: &Differences) -> Differences {
    let mut numbers = *differences;
    numbers[Subject::Curve as usize] = None;
    numbers
}

/// Median and greatest.
fn median(mut values: Vec<f64>) -> Option<(f64, f64)> {
    values.sort_by(f64::total_cmp);
    Some((*values.get(values.len() / 2)?, *values.last()?))
}

fn read(line: &str) -> Row {
    let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let error =
        |text: &str| text.split_once(" / ").map(|(median, most)| (number(median), number(most)));
    Row {
        setting: cells[0].to_owned(),
        errors: [error(cells[1]), error(cells[2]), error(cells[3])],
    }
}
