//! Long work on a real terminal: the progress of the benchmark and Ctrl-C; keys and Esc while a
//! slow method runs.
use crate::tty;

use std::fs;
use std::time::{Duration, Instant};

use tty::{Launch, TABLE_1, Tty};

/// Table 1 by a method that takes seconds: the motion never becomes steady.
fn slow_case() -> String {
    const SLOW: &str = "[model]\nmethod = \"dynamic\"\ndamping_ratio = 0.0\nwarmup_cycles = 10000\ntolerance = \
            1e-11\n";
    TABLE_1.replace("[model]\nmethod = \"exact\"\n", SLOW)
}

/// The workbench, or a command, on that case.
fn launch(command: &[&str]) -> Launch {
    let launch = Launch::on_table_1();
    fs::write(launch.case(), slow_case()).expect("room on the disk");
    let case = launch.case();
    match command {
        [] => launch,
        words => words.iter().fold(Launch::of(launch.folder), Launch::argument).argument(case),
    }
}

/// The time until the screen shows the text.
fn time_until(tty: &mut Tty, text: &str) -> Duration {
    let begun = Instant::now();
    tty.wait_until(text, |tty| tty.shows(text));
    begun.elapsed()
}

fn warn_beyond(what: &str, time: Duration, limit: Duration) {
    println!("{what}: {time:.2?}");
    if time > limit {
        println!("WARNING: {what} took {time:.2?}, more than {limit:.2?}");
    }
}

#[test]
fn a_trade_shows_its_progress_and_ctrl_c_ends_it() {
    let mut tty = launch(&["trade"]).start();
    tty.wait_for("settings, ");
    tty.type_in("\x03");
    let begun = Instant::now();
    tty.wait_until("no bar", |tty| !tty.shows("settings"));
    let status = tty.wait_for_end();
    warn_beyond("Ctrl-C to the end", begun.elapsed(), Duration::from_millis(100));
    assert!(!status.success());
    tty.assert_restored();
    assert_eq!(tty.screen().contents().trim(), "", "no bar and no word are left");
}

#[test]
fn keys_are_answered_while_a_slow_method_runs() {
    let mut tty = launch(&[]).size(45, 140).start();
    tty.wait_for("dynamic pending");
    let mut times: Vec<Duration> = (1..=9)
        .map(|digit| {
            tty.type_in("\x15");
            tty.type_in(format!("{digit}5 mm"));
            time_until(&mut tty, &format!(" {digit}5 mm"))
        })
        .collect();
    // The solve of the last edit is running.
    tty.wait_for("dynamic pending");
    times.sort();
    warn_beyond(
        "key to echo while a slow method runs, median",
        times[times.len() / 2],
        Duration::from_millis(5),
    );
    tty.send_signal("TERM");
    tty.wait_for_end();
}

#[test]
fn esc_ends_a_measurement_at_once() {
    let mut tty = launch(&[]).size(45, 140).start();
    tty.wait_for("dynamic pending");
    tty.type_in("\x1b");
    tty.settle(Duration::from_millis(100));
    tty.type_in("5m");
    tty.wait_for("measuring");
    tty.type_in("\x1b");
    let time = time_until(&mut tty, "the benchmark is stopped");
    // 50 ms of silence distinguish a lone Esc from the start of an arrow key.
    warn_beyond("Esc to the end of a measurement", time, Duration::from_millis(150));
    tty.quit();
}
