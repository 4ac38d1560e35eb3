//! The work-precision table of the cases in `cases/`: computed, stored and compared.
#![allow(dead_code, reason = "test and bench each use their own part")]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::Duration;

use tipstrike::case::file::Document;
use tipstrike::model::Inputs;
use tipstrike::model::impact::StiffnessModels;
use tipstrike::model::inputs::Method;
use tipstrike::report::trade::{duration, percent};
use tipstrike::study::trade::{Differences, METHODS, Setting, Subject, Trade, greatest, trade};

/// Errors below this are rounding and may differ between machines.
const ROUNDING: f64 = 1e-11;

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

/// A power of ten as a file reader parses it.
pub(crate) fn tidy(tolerance: f64) -> f64 {
    format!("{tolerance:.0e}").parse().expect("a number")
}

/// A setting over all cases.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) setting: String,
    /// Median time, in s.
    pub(crate) seconds: Option<f64>,
    /// Median evaluations of the motion.
    pub(crate) evaluations: Option<f64>,
    /// Median and greatest numerical error of the numbers, of the curve, and in total.
    pub(crate) errors: [Option<(f64, f64)>; 3],
}

pub(crate) struct Table(pub(crate) Vec<Row>);

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/trade/table.md")
}

/// Every case and its trade study, in the order of `cases`.
pub(crate) fn trades(patience: Duration) -> Vec<(String, Trade)> {
    let made = |path: PathBuf| {
        let inputs = Inputs { within: 0.05, ..inputs(&path) };
        let found = trade(&inputs, patience, &|| true, &mut |_| ());
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        (name, found.unwrap_or_else(|refusal| panic!("{}: {refusal}", path.display())))
    };
    cases().into_iter().map(made).collect()
}

/// The trade study of every case, computed once for all tests of a program; the times are those of
/// a loaded machine.
pub(crate) fn traded_once() -> &'static [(String, Trade)] {
    static TRADES: LazyLock<Vec<(String, Trade)>> = LazyLock::new(|| trades(Duration::ZERO));
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

    /// Writes the errors beside the stored times, which only the benchmark measures.
    pub(crate) fn keep_errors(&self) {
        const TIMES: usize = 4;
        let stored = std::fs::read_to_string(path()).expect("the stored table");
        let made = self.markdown();
        let line = |made: &str| {
            let name = made.split('|').nth(1);
            let mut lines = stored.lines();
            let times = lines.find(|line| line.split('|').nth(1) == name);
            let times = times.unwrap_or("| | - | - |").split('|').skip(2).take(TIMES - 2);
            let before = made.split('|').take(2).chain(times);
            let cells: Vec<&str> = before.chain(made.split('|').skip(TIMES)).collect();
            cells.join("|") + "\n"
        };
        let text: String = made.lines().map(line).collect();
        std::fs::write(path(), text).expect("the table is written");
    }

    pub(crate) fn markdown(&self) -> String {
        let mut text = "| setting | time | evaluations | numbers | curve | total \
                |\n|---|---|---|---|---|---|\n"
            .to_owned();
        for row in &self.0 {
            let time = row.seconds.map_or_else(|| "-".to_owned(), duration);
            let evaluations =
                row.evaluations.map_or_else(|| "-".to_owned(), |count| format!("{count:.0}"));
            let errors = row.errors.map(|error| {
                error.map_or_else(
                    || "-".to_owned(),
                    |(median, most)| format!("{median:.1e} / {most:.1e}"),
                )
            });
            writeln!(text, "| {} | {time} | {evaluations} | {} |", row.setting, errors.join(" | "))
                .expect("a string");
        }
        text
    }

    /// The lines of docs/speed.md: a selection of the stored lines.
    pub(crate) fn of_docs() -> Vec<String> {
        let text = std::fs::read_to_string(path()).expect("the stored table");
        let names: Vec<String> = settings()
            .iter()
            .filter(|setting| is_listed(setting))
            .map(|setting| format!("| {setting} |"))
            .collect();
        let lines = text.lines().enumerate();
        let found =
            lines.filter(|(at, line)| *at < 2 || names.iter().any(|name| line.starts_with(name)));
        found.map(|(_, line)| line.to_owned()).collect()
    }

    /// The lines of docs/speed.md about every compliance: time and total error of each method, from
    /// the stored lines.
    pub(crate) fn of_compliances() -> Vec<String> {
        let text = std::fs::read_to_string(path()).expect("the stored table");
        let table_1 = tipstrike::case::Case::table_1();
        let pair = table_1.inputs().expect("the built-in case is valid");
        let cell = |method: Method, models: StiffnessModels| {
            let setting = Setting { models: Some(models), ..Setting::usual(method, &pair) };
            let mut lines = text.lines().map(|line| line.split(" | ").collect::<Vec<_>>());
            let line = lines.find(|cells| cells[0] == format!("| {setting}"));
            let line = line.unwrap_or_else(|| panic!("no {setting}"));
            let total = line[5].trim_end_matches(" |").split(" / ");
            let total: Vec<String> =
                total.map(|total| percent(total.parse().expect("a number"))).collect();
            format!("{}, {} %", line[1], total.join(" / "))
        };
        let row = |models: StiffnessModels| {
            let cells = METHODS.map(|method| cell(method, models));
            format!("| {} | {} |", models.names(), cells.join(" | "))
        };
        let heads = ["| compliance | paper | exact | static | dynamic |", "|---|---|---|---|---|"];
        let rows = StiffnessModels::covering(&pair).map(row);
        heads.map(str::to_owned).into_iter().chain(rows).collect()
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

/// Writes the lines of docs/speed.md between its marks.
pub(crate) fn write_docs() {
    const MARKS: [&str; 2] =
        ["<!-- speed against accuracy -->\n", "<!-- /speed against accuracy -->"];
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/speed.md");
    let text = std::fs::read_to_string(&path).expect("docs/speed.md");
    let (before, rest) = text.split_once(MARKS[0]).expect("the first mark");
    let (_, after) = rest.split_once(MARKS[1]).expect("the second mark");
    let lines = Table::of_docs().join("\n");
    let text = format!("{before}{}{lines}\n{}{after}", MARKS[0], MARKS[1]);
    let (before, rest) = text.split_once(COMPLIANCE_MARKS[0]).expect("the first mark");
    let (_, after) = rest.split_once(COMPLIANCE_MARKS[1]).expect("the second mark");
    let lines = Table::of_compliances().join("\n");
    let text = format!("{before}{}{lines}\n{}{after}", COMPLIANCE_MARKS[0], COMPLIANCE_MARKS[1]);
    std::fs::write(&path, text).expect("docs/speed.md is written");
}

const COMPLIANCE_MARKS: [&str; 2] = ["<!-- compliances -->\n", "<!-- /compliances -->"];

/// Whether docs/speed.md lists the setting.
fn is_listed(setting: &Setting) -> bool {
    let few = setting.stations.is_none_or(|stations| [8, 64, 1024].contains(&stations));
    // At the coarsest and at the default tolerance; every other tolerance once.
    few && !setting.accurate && has_default_compliance(setting)
}

fn has_default_compliance(setting: &Setting) -> bool {
    let usual = settings().into_iter().find(|usual| usual.method == setting.method);
    usual.is_none_or(|usual| usual.models == setting.models)
}

fn row(setting: &Setting, trades: &[(String, Trade)]) -> Row {
    let found: Vec<_> = trades
        .iter()
        .flat_map(|(_, trade)| &trade.settings)
        .filter(|measured| measured.setting == *setting)
        .collect();
    let figures = || found.iter().filter_map(|measured| measured.found.as_ref().ok());
    let numbers =
        figures().filter_map(|figures| greatest(&without_curve(&figures.numerical))).collect();
    let curve =
        figures().filter_map(|figures| figures.numerical[Subject::Curve as usize]).collect();
    let total = found.iter().filter_map(|measured| measured.total()).collect();
    Row {
        setting: setting.to_string(),
        seconds: median(figures().map(|figures| figures.time.seconds).collect())
            .map(|(median, _)| median),
        evaluations: median(
            figures().filter_map(|figures| figures.evaluations).map(|count| count as f64).collect(),
        )
        .map(|(median, _)| median),
        errors: [numbers, curve, total].map(median),
    }
}

fn without_curve(differences: &Differences) -> Differences {
    let mut numbers = *differences;
    numbers[Subject::Curve as usize] = None;
    numbers
}

pub(crate) fn median(mut values: Vec<f64>) -> Option<(f64, f64)> {
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
        seconds: None,
        evaluations: cells[2].parse().ok(),
        errors: [error(cells[3]), error(cells[4]), error(cells[5])],
    }
}
