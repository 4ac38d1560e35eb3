//! Studies as whole processes: `cargo bench --bench studies` prints the times of tipstrike, of the
//! same study as a NumPy script on two threads, and of a loop over `tipstrike solve`. `PYTHON`
//! names a Python with NumPy.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a benchmark prints its results"
)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use serde_json::Value;

/// Runs of each command; the fastest counts.
const RUNS: usize = 5;

/// Solves in the loop over processes.
const PROCESSES: usize = 200;

fn main() {
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let case = case(folder.path());
    let case = case.to_str().expect("a plain path");
    tolerance(case);
    scaling(case);
    resonance(case);
    map(case);
    processes(case);
}

/// Table 1 with computed deflection, a relief, and distributions.
fn case(folder: &Path) -> PathBuf {
    let table_1 = concat!(env!("CARGO_MANIFEST_DIR"), "/cases/zhou-chen-2014.toml");
    let text = fs::read_to_string(table_1).expect("Table 1");
    let kept: Vec<&str> = text.lines().filter(|line| !line.starts_with("deflection")).collect();
    let (driver, driven) = kept.join("\n").split_once("[driven]").map_or_else(
        || panic!("no driven gear"),
        |(driver, driven)| (driver.to_owned(), driven.to_owned()),
    );
    let driven = driven
        .replacen("tip_relief = \"0 um\"", "tip_relief = \"24 um\"", 1)
        .replace("\"2500 N\"", "\"1000 N\"");
    let spread = "\n[spread]\n\"deviations.base_pitch\" = { normal = \"2 um\" }\n\
        \"operation.power\" = { uniform = \"1 kW\" }\n\"driven.tip_relief\" = { normal = \"3 um\" }\n";
    let path = folder.join("case.toml");
    fs::write(&path, format!("{driver}[driven]{driven}{spread}")).expect("a case");
    path
}

/// The time of the fastest of several runs, in seconds, and its output.
fn quickest(arguments: &[&str]) -> (f64, String) {
    let run = || {
        let begin = Instant::now();
        let output = Command::new(env!("CARGO_BIN_EXE_tipstrike"))
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .expect("the program starts");
        let seconds = begin.elapsed().as_secs_f64();
        assert!(output.status.success(), "{arguments:?}");
        (seconds, String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let runs = (0..RUNS).map(|_| run());
    runs.min_by(|one, other| one.0.total_cmp(&other.0)).expect("a run")
}

fn sampled<'a>(case: &'a str, samples: &'a str) -> Vec<&'a str> {
    vec!["tolerance", case, "--samples", samples, "--ranking", "0", "--format", "json"]
}

fn tolerance(case: &str) {
    // Two samples measure the start of the program.
    let (start, _) = quickest(&sampled(case, "2"));
    println!("tolerance of impact_force by method exact, three fields spread:");
    for samples in ["100000", "1000000"] {
        let (ours, text) = quickest(&sampled(case, samples));
        println!("  {samples} samples: ours {:.1} ms, start {:.1} ms", 1e3 * ours, 1e3 * start);
        let Some((whole, inside, theirs)) = numpy(samples) else {
            println!("  SKIPPED: python3 with NumPy is not here");
            continue;
        };
        println!(
            "    NumPy {:.1} ms, {:.1} times; without the start of either {:.1} ms, {:.1} times",
            1e3 * whole,
            whole / ours,
            1e3 * inside,
            inside / (ours - start)
        );
        let ours: Value = serde_json::from_str(&text).expect("JSON");
        compare_medians(&ours, &theirs);
    }
}

/// Checks that both programs solved the same study, each with its own samples.
fn compare_medians(ours: &Value, theirs: &Value) {
    let median = &ours["quantities"]["impact_force"]["figures"]["p50"]["value"];
    let ours = median.as_f64().expect("a median");
    let theirs = theirs["percentiles"][1].as_f64().expect("a median");
    println!("    median {ours:.1} N, NumPy {theirs:.1} N");
    assert!((ours / theirs - 1.0).abs() < 0.01, "another study");
}

/// Seconds of the process and of the study alone, with its results.
fn numpy(samples: &str) -> Option<(f64, f64, Value)> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/tolerance.py");
    let run = || {
        let begin = Instant::now();
        let output = Command::new(&python).args([script, samples]).output().ok()?;
        let whole = begin.elapsed().as_secs_f64();
        let found: Value = serde_json::from_slice(&output.stdout).ok()?;
        Some((whole, found["seconds"].as_f64()?, found))
    };
    let runs = (0..RUNS).map(|_| run()).collect::<Option<Vec<_>>>()?;
    runs.into_iter().min_by(|one, other| one.0.total_cmp(&other.0))
}

/// A resonance curve: the motion over the speed.
fn resonance_of<'a>(case: &'a str, points: &'a str) -> Vec<&'a str> {
    vec![
        "sweep",
        case,
        "--method",
        "dynamic",
        "--vary",
        "operation.speed=500..9000 rpm",
        "--points",
        points,
        "--only",
        "dynamic_peak_force",
    ]
}

/// The torque of the case at its speed.
const AT_ONE_TORQUE: [&str; 2] = ["--set", "operation.torque=71.6 N m"];

fn scaling(case: &str) {
    let with_jobs = |jobs| {
        let mut arguments = resonance_of(case, "2000");
        arguments.extend(["--jobs", jobs]);
        quickest(&arguments).0
    };
    let (one, two) = (with_jobs("1"), with_jobs("2"));
    println!(
        "2000 dynamic solves: {one:.3} s on one thread, {two:.3} s on two, {:.2} times",
        one / two
    );
}

fn resonance(case: &str) {
    let at_one_power = resonance_of(case, "10000");
    let mut at_one_torque = at_one_power.clone();
    at_one_torque.extend(AT_ONE_TORQUE);
    println!(
        "10000 dynamic solves over speed: {:.3} s at one torque, {:.3} s at one power",
        quickest(&at_one_torque).0,
        quickest(&at_one_power).0
    );
}

fn map(case: &str) {
    let arguments = [
        "sweep",
        case,
        "--method",
        "static",
        "--vary",
        "operation.torque=10..200 N m",
        "--vary",
        "driven.tip_relief=0..60 um",
        "--points",
        "60",
        "--points",
        "30",
        "--only",
        "static_transmission_error",
    ];
    println!("60 x 30 map of the static transmission error: {:.3} s", quickest(&arguments).0);
}

fn processes(case: &str) {
    let begin = Instant::now();
    for _ in 0..PROCESSES {
        let solved = Command::new(env!("CARGO_BIN_EXE_tipstrike"))
            .args(["solve", case, "--only", "impact_force", "--format", "csv"])
            .output()
            .expect("the program starts");
        assert!(solved.status.success());
    }
    let each = begin.elapsed().as_secs_f64() / PROCESSES as f64;
    println!(
        "a loop over `tipstrike solve`: {:.2} ms a solve, {:.0} s for 100000",
        1e3 * each,
        1e5 * each
    );
}
