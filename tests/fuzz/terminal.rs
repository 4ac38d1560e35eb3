//! Random bytes for the built program on a real terminal: it keeps running, quits on request, and
//! restores the terminal.

use std::process::Command;
use std::time::{Duration, Instant};
use std::{fs, thread};

use portable_pty::ExitStatus;
use proptest::prelude::*;
use proptest::sample::{Index, select};

use tipstrike::case::Document;
use tipstrike::tui::testing::Journal;

use crate::hold;
use crate::tty::{PATIENCE, Tty, journals};

/// The program has processed its input if it writes nothing for this time, which is longer than its
/// timeout for a sequence.
const QUIET: Duration = Duration::from_millis(120);

/// Sequences of terminals, complete and partial, and invalid ones.
#[rustfmt::skip]
const SEQUENCES: [&[u8]; 60] = [
    b"\x1b[A", b"\x1b[B", b"\x1b[C", b"\x1b[D", b"\x1b[H", b"\x1b[F", b"\x1b[Z", b"\x1bOP", b"\x1bOQ", b"\x1b[15~", b"\x1b[17~",
    b"\x1b[19~", b"\x1b[1;5B", b"\x1b[1;5H", b"\x1b[5~", b"\x1b[6~", b"\x1b[3~", b"\x1b", b"\x1b[", b"\x1bO", b"\x1b[1;",
    b"\x1b[<", b"\x1b[?", b"\x1b[M", b"\x1b[M !!", b"\x1b[<0;10;10M", b"\x1b[<64;999999;1m", b"\x1b[I", b"\x1b[O", b"\x1b[5;5R",
    b"\x1b[?1;2c", b"\x1b[?1u", b"\x1b[97;5u", b"\x1b[99999999999999999999~", b"\x1b[1;99999999A", b"\x1b]11;rgb:00\x07",
    b"\x1bP1$r\x1b\\", b"\x1b[200~", b"\x1b[201~", b"\x1b[200~5 mm\x1b[201~", b"\x1b\x1b[A", b"\xc3", b"\xa9", b"\xf0\x9f",
    b"\xff\xfe", b"\xc0\x80", b"\xf5\x80\x80\x80", b"\xed\xa0\x80", b"\x11", b"\x13", b"\x0f", b"\x15", b"\x1a", b"\x03", b"\r", b"\x1c", b"\x1bz", b"\x10suspend\r",
    b"\t", b"5 mm",
];

/// Keys that close a prompt, quit, and discard.
const WAYS_OUT: [&[u8]; 3] = [b"\x1b", b"\x11", b"d"];

/// Ways to end: by itself, or by Ctrl-C or Ctrl-\ while it is suspended and the terminal belongs to
/// the shell.
const ENDS: [&str; 2] = ["Interrupt", "Quit"];

#[test]
fn after_any_input_the_workbench_quits_and_restores_the_terminal() {
    let piece = prop_oneof![
        8 => select(&SEQUENCES[..]).prop_map(<[u8]>::to_vec),
        2 => prop::collection::vec(any::<u8>(), 1..40),
        2 => "[ -~]{1,12}".prop_map(String::into_bytes),
    ];
    let sizes = prop::collection::vec((0..=60u16, 0..=200u16), 0..4);
    let cuts = prop::collection::vec(any::<Index>(), 0..30);
    hold(14, &(prop::collection::vec(piece, 1..400), cuts, sizes), |(pieces, cuts, sizes)| {
        survive(&cut(&harmless(pieces.concat()), &cuts), &sizes);
    });
}

#[test]
fn floods_are_survived() {
    let keys = [&b"7"[..], b"\x1b[B", b"\x7f", b"\x1b[C", b"\t", b"m"].concat();
    let flood = keys.repeat(1000);
    let paste = |end: &[u8]| [b"\x1b[200~", "5 mm\r\n歯".repeat(1 << 13).as_bytes(), end].concat();
    let broken = b"\xff\xc3\x28\xf0\x9f\x1b[\xe2\x82".repeat(2000);
    let floods = [flood, paste(b"\x1b[201~"), paste(b""), broken, b"\x1b".repeat(5000)];
    // Each program waits for its terminal most of the time.
    thread::scope(|scope| {
        for bytes in floods {
            scope.spawn(|| survive(&[bytes], &[(10, 30), (0, 0), (24, 80)]));
        }
    });
}

/// Removes paths outside the folder.
fn harmless(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.retain(|&byte| byte != b'/');
    bytes
}

fn cut(bytes: &[u8], cuts: &[Index]) -> Vec<Vec<u8>> {
    let mut places: Vec<usize> =
        cuts.iter().map(|cut| cut.index(bytes.len() + 1)).chain([0, bytes.len()]).collect();
    places.sort_unstable();
    places.windows(2).map(|pair| bytes[pair[0]..pair[1]].to_vec()).collect()
}

fn survive(pieces: &[Vec<u8>], sizes: &[(u16, u16)]) {
    let mut tty = Tty::open();
    tty.written = Some(Vec::new());
    tty.wait_for("Corner");
    tty.pour(pieces.to_vec(), sizes);
    let status = leave(&mut tty);
    let words = words(&tty);
    assert!(!words.contains("fault of the program"), "{words:?}");
    let is_by_key = status.signal().is_some_and(|name| ENDS.contains(&name));
    assert!(status.success() || is_by_key, "{status}: {words:?}");
    tty.assert_restored();
    assert_nothing_left(&tty, &status);
}

/// Tries every key that quits until the program has ended.
fn leave(tty: &mut Tty) -> ExitStatus {
    let end = Instant::now() + PATIENCE;
    for keys in WAYS_OUT.into_iter().cycle() {
        tty.settle(QUIET);
        if tty.has_ended() {
            return tty.wait_for_end();
        }
        assert!(Instant::now() < end, "it does not leave: {:?}", words(tty));
        tty.wake();
        // The program may end at any time.
        tty.try_to_type(keys).ok();
    }
    unreachable!("the keys go round and round")
}

fn words(tty: &Tty) -> String {
    String::from_utf8_lossy(tty.written.as_deref().unwrap_or_default()).into_owned()
}

/// Checks that no process remains on the terminal, that the case opens again, and that the journals
/// of undiscarded edits are complete.
fn assert_nothing_left(tty: &Tty, status: &ExitStatus) {
    let left = Command::new("ps")
        .args(["-o", "pid=", "-s", &tty.id().to_string()])
        .output()
        .expect("ps is there");
    assert_eq!(String::from_utf8_lossy(&left.stdout).trim(), "", "a process is left");
    let kept = journals(tty.folder.path());
    assert!(kept.is_empty() || !status.success(), "edits that were thrown away are kept");
    for text in kept.iter().map(|path| fs::read_to_string(path).expect("it is there")) {
        assert!(Journal::from_text(&text).is_some(), "{text}");
    }
    let case = fs::read_to_string(tty.case()).expect("the case is there");
    assert!(Document::parse("case.toml", &case).is_ok(), "a saved case opens again: {case}");
}
