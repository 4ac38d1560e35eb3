//! Method `dynamic` compared with the integrators of SciPy on the same pair: `cargo bench --bench
//! scipy` prints how many times as long SciPy takes for the same measured error, `-- CASE.toml` for
//! another case of `tests/reference/mesh`.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a benchmark prints its results"
)]

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde_json::Value;
use tipstrike::case::file::Document;
use tipstrike::model::dynamic::{Settings, dynamic};
use tipstrike::model::inputs::Method;
use tipstrike::model::stations::Spacing;
use tipstrike::model::{Inputs, Quantity, Solution, Stage, Stages, solve};

/// The compared quantities, with the names of their errors in the SciPy script.
const KEYS: [(&str, &str); 3] = [
    ("dynamic_peak_force", "error_peak"),
    ("dynamic_peak_approach_force", "error_approach"),
    ("dynamic_first_contact_angle", "error_first"),
];

/// A setting of tipstrike: greatest error, time of a whole solve, and time of the motion on an
/// existing mesh.
struct Ours {
    tolerance: f64,
    error: f64,
    whole: f64,
    run: f64,
}

/// A run of SciPy.
struct Theirs {
    name: String,
    error: f64,
    run: f64,
}

impl Ours {
    fn tell(&self) {
        let (whole, run) = (1e3 * self.whole, 1e3 * self.run);
        println!(
            "  tolerance {:.0e}: error {:.1e}, {whole:.3} ms whole, {run:.3} ms run",
            self.tolerance, self.error
        );
    }
}

impl Theirs {
    /// Ratios of the times of SciPy to those of our fastest setting with at most the same error:
    /// whole, and motion only.
    fn ratios(&self, setup: f64, ours: &[Ours]) -> Option<(f64, f64)> {
        let no_worse = ours.iter().filter(|own| own.error <= self.error);
        let own = no_worse.min_by(|one, other| one.whole.total_cmp(&other.whole))?;
        Some(((setup + self.run) / own.whole, self.run / own.run))
    }
}

fn main() {
    let arguments: Vec<String> =
        std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    if arguments.iter().any(|argument| argument == "--test") {
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let case = arguments
        .first()
        .map_or_else(|| root.join("tests/reference/mesh/table-1.toml"), PathBuf::from);
    match scipy(root, &case) {
        Some((setup, theirs)) => compare(&case, setup, &theirs),
        None => println!("SKIPPED: python3 with scipy is not here, so nothing is compared"),
    }
}

fn compare(case: &Path, setup: f64, theirs: &[Theirs]) {
    let reference = std::fs::read_to_string(case.with_extension("json")).expect("a reference");
    let reference: Value = serde_json::from_str(&reference).expect("JSON");
    let ours: Vec<Ours> =
        (3..=11).map(|exponent| our_own(case, &reference, 10f64.powi(-exponent))).collect();
    println!("{}: ours", case.display());
    ours.iter().for_each(Ours::tell);
    println!(
        "SciPy, set-up {:.1} ms; how many times as long as ours for no smaller an error:",
        1e3 * setup
    );
    let mut least = (f64::INFINITY, f64::INFINITY);
    for run in theirs {
        let shown = format!("  {}: error {:.1e}, {:.1} ms", run.name, run.error, 1e3 * run.run);
        match run.ratios(setup, &ours) {
            Some((whole, alone)) => {
                println!("{shown}: {whole:.0} times whole, {alone:.0} times the run alone");
                least = (least.0.min(whole), least.1.min(alone));
            }
            None => println!("{shown}: nearer than any of ours"),
        }
    }
    println!("least: {:.0} times whole, {:.0} times the run alone", least.0, least.1);
}

/// Set-up time and all runs of the SciPy script; `None` if SciPy is not installed.
fn scipy(root: &Path, case: &Path) -> Option<(f64, Vec<Theirs>)> {
    let output = Command::new("python3")
        .arg(root.join("benches/scipy_dynamic.py"))
        .arg(case)
        .args(["--repeat", "3"])
        .output();
    let output = output.ok().filter(|output| output.status.success())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let lines: Vec<Value> =
        text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let setup = lines.first()?["setup_seconds"].as_f64()?;
    Some((setup, lines[1..].iter().map(their_own).collect()))
}

fn our_own(case: &Path, reference: &Value, tolerance: f64) -> Ours {
    let document = Document::read(case).unwrap_or_else(|error| panic!("{error}"));
    let inputs = document.case.inputs().unwrap_or_else(|problems| panic!("{}", problems[0]));
    // The quantities of the SciPy run need no stations.
    let inputs = Inputs { method: Method::Dynamic, tolerance, stations: Some(1), ..inputs };
    let wanted = Stages::of(Stage::Dynamic);
    let solved = || solve(black_box(&inputs), wanted).unwrap_or_else(|refusal| panic!("{refusal}"));
    let solution = solved();
    let mesh = solution.mesh.clone().expect("a mesh");
    let settings = Settings {
        mass: solution.reduced_mass,
        damping_ratio: inputs.damping_ratio,
        backlash: None,
        warmup_cycles: inputs.warmup_cycles,
        tolerance,
        spacing: Spacing::of(&inputs),
        approach_samples: 0,
    };
    let run = || dynamic(black_box(&mesh), &settings, &|_| true).is_ok();
    Ours {
        tolerance,
        error: error(&solution, reference),
        whole: least_time(|| solved().dynamic.is_some()),
        run: least_time(run),
    }
}

/// The greatest relative error over the quantities of the reference.
fn error(solution: &Solution, reference: &Value) -> f64 {
    let off = |key: &str| {
        let expected = reference[key].as_f64()?;
        let found = (Quantity::find(key)?.value)(solution)?;
        Some((found / expected - 1.0).abs())
    };
    KEYS.iter().filter_map(|(key, _)| off(key)).fold(0.0, f64::max)
}

/// The least time of many runs, as for SciPy.
fn least_time(work: impl Fn() -> bool) -> f64 {
    let time = || {
        let begin = Instant::now();
        black_box(work());
        begin.elapsed().as_secs_f64()
    };
    (0..50).map(|_| time()).fold(f64::INFINITY, f64::min)
}

fn their_own(line: &Value) -> Theirs {
    let error = KEYS.iter().filter_map(|(_, name)| line[name].as_f64()).fold(0.0, f64::max);
    let split = if line["split"] == true { ", restarted at kinks" } else { "" };
    let name =
        format!("{} at {}{split}", line["method"].as_str().unwrap_or_default(), line["rtol"]);
    Theirs { name, error, run: line["seconds"].as_f64().expect("a time") }
}
