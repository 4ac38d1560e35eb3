//! The first frame is on the terminal about as soon as vim's: a ratio in the same run, which holds on any machine.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on says why")]
#![allow(clippy::print_stdout, reason = "the figures of the README")]
#![cfg(all(feature = "cli", feature = "tui"))]

use std::io::Read;
use std::num::NonZero;
use std::path::Path;
use std::sync::mpsc::channel;
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{CommandBuilder, PtySize, native_pty_system};

const ROWS: u16 = 40;
const COLUMNS: u16 = 120;
const PATIENCE: Duration = Duration::from_secs(20);

/// Start a program on a terminal of its own; how long until its screen shows the text, and how many bytes that took.
fn first_frame(program: &str, arguments: &[&str], state: &Path, text: &str) -> (Duration, usize) {
    let size = PtySize { rows: ROWS, cols: COLUMNS, ..PtySize::default() };
    let pair = native_pty_system().openpty(size).expect("a pseudo terminal");
    let mut command = CommandBuilder::new(program);
    command.args(arguments);
    for (name, value) in [("XDG_STATE_HOME", state.to_str().expect("UTF-8")), ("TERM", "xterm-256color"), ("LC_ALL", "C.UTF-8")] {
        command.env(name, value);
    }
    let mut reader = pair.master.try_clone_reader().expect("a reader");
    let (sender, output) = channel();
    thread::spawn(move || {
        let mut buffer = [0; 16384];
        while let Ok(count @ 1..) = reader.read(&mut buffer) {
            if sender.send(buffer[..count].to_vec()).is_err() {
                return;
            }
        }
    });
    let cells = |count| NonZero::new(count).expect("a screen has cells");
    let mut screen = vt100::Parser::new(cells(ROWS), cells(COLUMNS), 0);
    let start = Instant::now();
    let mut child = pair.slave.spawn_command(command).expect("the program starts");
    let mut bytes = 0;
    while !screen.screen().contents().contains(text) {
        let part = output.recv_timeout(PATIENCE).expect("the first frame comes");
        bytes += part.len();
        screen.process(&part);
    }
    let time = start.elapsed();
    child.kill().expect("our own child");
    child.wait().expect("our own child");
    (time, bytes)
}

#[test]
fn the_first_frame_comes_within_two_and_a_half_times_vims() {
    const PAIRS: usize = 15;
    const MOST: f64 = 2.5;
    const MOST_BYTES: usize = 9000;
    let folder = tempfile::tempdir().expect("a folder");
    let case = folder.path().join("case.toml");
    std::fs::write(&case, include_str!("../cases/zhou-chen-2014.toml")).expect("room on the disk");
    let case = case.to_str().expect("UTF-8");
    if std::process::Command::new("vim").arg("--version").output().is_err() {
        println!("vim is not installed: nothing to hold the first frame against");
        return;
    }
    let mut ratios = Vec::new();
    for _ in 0..PAIRS {
        let (ours, bytes) = first_frame(env!("CARGO_BIN_EXE_tipstrike"), &[case], folder.path(), "F1 help");
        let (vims, _) = first_frame("vim", &["-u", "NONE", case], folder.path(), "format = 1");
        println!("tipstrike {ours:.1?}, vim -u NONE {vims:.1?}, {bytes} bytes");
        assert!(bytes <= MOST_BYTES, "the first frame takes {bytes} bytes");
        ratios.push(ours.as_secs_f64() / vims.as_secs_f64());
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[PAIRS / 2];
    println!("median ratio {median:.2}");
    assert!(median <= MOST, "the first frame takes {median:.2} times vim's: {ratios:.2?}");
}
