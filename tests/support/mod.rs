//! What several tests share: cases, values, counts, and work on all cores.

use std::path::{Path, PathBuf};
use std::{env, fs, thread};

use tipstrike::case::{Case, Document};
use tipstrike::model::inputs::{Drive, Gear};
use tipstrike::model::{Inputs, Quantity, Solution};

/// A path in the source folder.
pub(crate) fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The inputs of a case file of the source folder.
pub(crate) fn inputs(file: &str) -> Inputs {
    let document = Document::read(&path(file)).unwrap_or_else(|error| panic!("{error}"));
    document.case.inputs().unwrap_or_else(|problems| panic!("{file}: {}", problems[0]))
}

pub(crate) fn case(name: &str) -> Inputs {
    inputs(&format!("cases/{name}.toml"))
}

pub(crate) fn files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(path(folder)).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let is_case = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "toml");
    let mut paths: Vec<PathBuf> = paths.filter(is_case).collect();
    paths.sort();
    paths
}

pub(crate) fn cases_with_answers(folder: &str) -> Vec<(String, Inputs, serde_json::Value)> {
    let of = |path: PathBuf| {
        let answers = fs::read_to_string(path.with_extension("json")).expect("answers");
        let name = path.to_str().expect("a name in UTF-8").to_owned();
        let inputs = inputs(&name);
        (name, inputs, serde_json::from_str(&answers).expect("JSON"))
    };
    files(folder).into_iter().map(of).collect()
}

/// A standard steel pair without deviation, 10 mm wide, 100 N m at 2000 rpm.
pub(crate) fn standard_pair(driver_teeth: u32, driven_teeth: u32, module: f64) -> Inputs {
    let table_1 = Case::table_1().inputs().expect("the built-in case is valid");
    let gear =
        |teeth| Gear { teeth, face_width: 10e-3, bore_radius: 0.0, young: 206e9, ..table_1.driver };
    Inputs {
        module,
        driver: gear(driver_teeth),
        driven: gear(driven_teeth),
        base_pitch_deviation: 0.0,
        drive: Drive::Torque(100.0),
        deflection: None,
        tooth_compliance: None,
        ..table_1.clone()
    }
}

pub(crate) fn value(solution: &Solution, key: &str) -> Option<f64> {
    (Quantity::find(key).unwrap_or_else(|| panic!("no quantity {key}")).value)(solution)
}

/// The relative difference; the absolute difference from 0.
pub(crate) fn off(found: f64, expected: f64) -> f64 {
    if expected == 0.0 { found.abs() } else { (found / expected - 1.0).abs() }
}

/// The greatest value less the least one.
pub(crate) fn range(values: &[f64]) -> f64 {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
}

/// The number of pairs that `TIPSTRIKE_PAIRS` asks for, or the usual one.
pub(crate) fn pairs_or(usual: u64) -> u64 {
    env::var("TIPSTRIKE_PAIRS").map_or(usual, |count| count.parse().expect("a count"))
}

/// The results of a number of runs, which all cores and at least two threads share.
pub(crate) fn on_all_cores<T: Send>(count: u64, run: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let cores = thread::available_parallelism().map_or(2, usize::from).max(2) as u64;
    let share = |first: u64| (first..count).step_by(cores as usize).map(&run).collect::<Vec<T>>();
    thread::scope(|scope| {
        let share = &share;
        let shares: Vec<_> = (0..cores).map(|first| scope.spawn(move || share(first))).collect();
        shares.into_iter().flat_map(|share| share.join().expect("no panic")).collect()
    })
}
