//! The first frame is as fast as that of an editor, and a headless solve has no noticeable delay.
use crate::tty::{Launch, PROGRAM, is_there};

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Starts a program on a new terminal. Returns the time until its screen shows the text, and the
/// number of bytes.
fn first_frame(launch: Launch, text: &str) -> (Duration, usize) {
    let start = Instant::now();
    let mut tty = launch.size(40, 120).start();
    tty.written = Some(Vec::new());
    tty.wait_for(text);
    (start.elapsed(), tty.written.as_ref().map_or(0, Vec::len))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn the_first_frame_takes_at_most_two_and_a_half_times_that_of_vim() {
    const PAIRS: usize = 15;
    const MOST: f64 = 2.5;
    const MOST_BYTES: usize = 9000;
    if !is_there("vim") {
        return;
    }
    let (mut ratios, mut times) = (Vec::new(), Vec::new());
    for _ in 0..PAIRS {
        let (ours, bytes) = first_frame(Launch::on_table_1(), "F1 help");
        let vim = Launch::on_table_1().instead("vim").argument("-u").argument("NONE");
        let (vims, _) = first_frame(vim, "format = 1");
        println!("tipstrike {ours:.1?}, vim -u NONE {vims:.1?}, {bytes} bytes");
        assert!(bytes <= MOST_BYTES, "the first frame takes {bytes} bytes");
        ratios.push(ours.as_secs_f64() / vims.as_secs_f64());
        times.push(ours.as_secs_f64() * 1e3);
    }
    let (ratio, time) = (median(ratios), median(times));
    println!("median {time:.1} ms, {ratio:.2} times vim's");
    assert!(ratio <= MOST, "the first frame takes {ratio:.2} times vim's");
}

#[test]
fn a_headless_solve_is_soon_done() {
    const RUNS: usize = 1000;
    /// The promise, start-up included, in s.
    const MOST: f64 = 10e-3;
    /// On a slower machine: multiple of the start time of an empty program.
    const MOST_STARTS: f64 = 10.0;
    let launch = Launch::on_table_1();
    let case = launch.case();
    let run = |program: &str, words: &[&str]| {
        let start = Instant::now();
        let status = Command::new(program).args(words).arg(&case).stdout(Stdio::null()).status();
        assert!(status.is_ok_and(|status| status.success()), "{program}");
        start.elapsed().as_secs_f64()
    };
    // Other tests run in parallel: the least times are those of an undisturbed run.
    let (mut solve, mut nothing) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..RUNS {
        solve = solve.min(run(PROGRAM, &["solve"]));
        nothing = nothing.min(run("true", &[]));
        if solve <= MOST.max(MOST_STARTS * nothing) {
            break;
        }
    }
    let ratio = solve / nothing;
    println!("solve: {:.1} ms, {ratio:.1} times `true`", solve * 1e3);
    assert!(solve <= MOST || ratio <= MOST_STARTS, "{:.1} {ratio:.1}", solve * 1e3);
}
