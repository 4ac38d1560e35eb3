//! Output, wake-ups and remains of the workbench on a real terminal: every exit, every terminal,
//! counted bytes.
use crate::tty::{
    self, Launch, PATIENCE, TABLE_1, Tty, cells, has_faults_on_demand, is_there, journals,
    number_after,
};

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// The output is complete if nothing arrives for this time.
const QUIET: Duration = Duration::from_millis(150);

fn opened(launch: Launch) -> Tty {
    let mut tty = launch.shown("quit");
    tty.settle(QUIET);
    tty
}

#[test]
fn a_panic_of_the_screen_restores_the_terminal_and_keeps_the_edits() {
    if !has_faults_on_demand() {
        return;
    }
    let mut tty = opened(Launch::on_table_1().variable("TIPSTRIKE_FAULT", "screen"));
    tty.type_for("\x151.25 in", "1.25 in");
    tty.type_in("\x0c");
    assert_eq!(tty.wait_for_end().exit_code(), 101);
    tty.assert_restored();
    tty.assert(tty.shows("internal error") && tty.shows("unsaved edits are kept"));
    let kept = fs::read_to_string(&journals(tty.folder.path())[0]);
    assert!(kept.is_ok_and(|kept| kept.contains("1.25 in")));
}

#[test]
fn a_panic_of_the_worker_is_reported_and_the_workbench_continues() {
    if !has_faults_on_demand() {
        return;
    }
    let mut tty = opened(Launch::on_table_1().variable("TIPSTRIKE_FAULT", "solver"));
    tty.type_for("\x156 mm", "the solver failed");
    assert!(tty.screen().alternate_screen(), "the screen is still ours");
    tty.type_in("\x157 mm\x13");
    let case = tty.case();
    tty.wait_until("the save", |_| {
        fs::read_to_string(&case).is_ok_and(|text| text.contains("\"7 mm\""))
    });
    tty.wait_until("the mark to go", |tty| !tty.shows("*unsaved*"));
    tty.quit();
    tty.assert_restored();
}

/// A shell in the folder.
fn shell(launch: &Launch) -> Tty {
    let shell = Launch::of(launch.folder.clone()).variable("PS1", "ready> ").instead("bash");
    shell.argument("--norc").argument("-i").shown("ready>")
}

fn is_back(tty: &mut Tty) -> bool {
    tty.screen().alternate_screen() && tty.shows("quit")
}

/// Starts the workbench in a shell.
fn start_in(tty: &mut Tty, case: &Path) {
    tty.type_in(format!("{} {}\r", tty::PROGRAM, case.display()));
    tty.wait_until("the workbench", is_back);
}

#[test]
fn a_shell_stops_and_resumes_the_workbench() {
    if !is_there("bash") {
        return;
    }
    let launch = Launch::on_table_1();
    let case = launch.case();
    let mut tty = shell(&launch);
    let ours = tty.modes();
    for _ in 0..2 {
        start_in(&mut tty, &case);
        let taken = tty.modes();
        for by_key in [false, true] {
            if by_key {
                tty.type_in("\x1bz");
            } else {
                tty.send_to_program("TSTP");
            }
            tty.wait_until("the shell", |tty| {
                !tty.screen().alternate_screen() && tty.shows("Stopped")
            });
            tty.settle(QUIET);
            assert_eq!(tty.modes(), ours, "the shell has its modes");
            assert!(!tty.screen().hide_cursor() && !tty.screen().application_cursor());
            tty.type_in("fg\r");
            tty.wait_until("the workbench", is_back);
            tty.settle(QUIET);
            assert_eq!(tty.modes(), taken, "the workbench has its modes");
        }
        // An unannounced stop, during which the shell writes over the screen.
        tty.send_to_program("STOP");
        tty.wait_for("Stopped");
        tty.settle(QUIET);
        tty.type_in("fg\r");
        tty.wait_until("a new picture", |tty| is_back(tty) && !tty.shows("Stopped"));
        tty.settle(QUIET);
        assert_eq!(tty.modes(), taken, "the workbench has its modes");
        tty.type_in("\x11");
        tty.wait_until("the shell", |tty| !tty.screen().alternate_screen());
        tty.settle(QUIET);
        assert_eq!(tty.modes(), ours);
    }
    tty.type_in("exit\r");
    tty.wait_for_end();
}

#[test]
fn a_shell_ends_a_stopped_workbench_without_resuming_it() {
    if !is_there("bash") {
        return;
    }
    let launch = Launch::on_table_1();
    let case = launch.case();
    for stop in ["TSTP", "STOP"] {
        let mut tty = shell(&launch);
        let ours = tty.modes();
        start_in(&mut tty, &case);
        tty.settle(QUIET);
        tty.send_to_program(stop);
        tty.wait_for("Stopped");
        tty.type_in("kill %1\r");
        // The shell reports an end with its next prompt.
        tty.wait_until("its end", |tty| {
            tty.type_in("\r");
            tty.settle(QUIET);
            tty.shows("Terminated") && !tty.screen().alternate_screen()
        });
        assert_eq!(tty.modes(), ours, "{stop}: the shell has its modes");
        tty.type_in("exit\r");
        tty.wait_for_end();
    }
}

#[test]
fn a_terminal_that_accepts_no_bytes_does_not_block_the_end() {
    let mut tty = opened(Launch::on_table_1());
    tty.type_for("\x151.25 in", "1.25 in");
    // Nobody reads: once the buffer of the terminal is full, a write blocks.
    tty.stall();
    tty.send_signal("TERM");
    let start = Instant::now();
    while !tty.has_ended() {
        assert!(start.elapsed() < PATIENCE, "it waits for a terminal that accepts no bytes");
        std::thread::sleep(Duration::from_millis(5));
    }
    println!("gone after {:.1?}", start.elapsed());
    let kept = journals(tty.folder.path());
    assert!(fs::read_to_string(&kept[0]).is_ok_and(|text| text.contains("1.25 in")), "{kept:?}");
}

#[test]
fn a_stuck_workbench_ended_by_a_signal_leaves_no_modes_behind() {
    if !has_faults_on_demand() {
        return;
    }
    let mut tty = opened(Launch::on_table_1().variable("TIPSTRIKE_FAULT", "stuck screen"));
    tty.type_in("\x0c");
    tty.settle(QUIET);
    tty.send_signal("TERM");
    assert_eq!(tty.wait_for_end().signal(), Some("Terminated"));
    tty.assert_restored();
}

#[test]
fn a_slow_line_is_not_flooded_and_the_way_out_stays_open() {
    const PACE: usize = 6000;
    const KEYS: usize = 3000;
    let mut tty = opened(Launch::on_table_1().size(40, 120));
    let before = tty.resident();
    tty.written = Some(Vec::new());
    tty.set_pace(PACE);
    // More frames than the queue of the system holds, each key separate.
    let keys = [&b"\x0c"[..], b"\x1b[B", b"\x0c", b"\x1b[A"];
    for key in (0..KEYS).map(|at| keys[at % keys.len()]) {
        tty.type_in(key);
        tty.take_output(Duration::from_micros(500));
    }
    let grown = tty.resident().saturating_sub(before);
    let start = Instant::now();
    tty.type_in("\x11");
    while !tty.has_ended() {
        assert!(start.elapsed() < PATIENCE, "it no longer reads events");
        tty.take_output(Duration::from_millis(5));
    }
    let left = start.elapsed();
    tty.set_pace(0);
    assert_eq!(tty.wait_for_end().exit_code(), 0);
    let written = tty.written.as_ref().map_or(0, Vec::len);
    println!("{KEYS} keys: {written} bytes, {grown} KiB more, gone after {left:.1?}");
    // A frame per key would be 9 MB; the system buffers 64 KiB, and one frame and the share of the
    // line are in transit.
    assert!(written <= 200 << 10, "{written} bytes");
    assert!(grown <= 2 << 10, "{grown} KiB");
    tty.assert_restored();
}

#[test]
fn a_storm_of_sizes_ends_in_the_right_picture() {
    let mut tty = opened(Launch::on_table_1());
    let sizes: Vec<_> =
        (0..400u16).map(|at| (at * 7 % 61, at * 13 % 201)).chain([(24, 80)]).collect();
    tty.pour(vec![b"\t".repeat(200)], &sizes);
    tty.settle(QUIET);
    tty.wait_for("Corner contact");
    let plain = opened(Launch::on_table_1());
    let words = |tty: &Tty| {
        tty.screen().contents().lines().next().map(|line| line.split_whitespace().count())
    };
    assert_eq!(words(&tty), words(&plain));
    tty.quit();
    tty.assert_restored();
}

#[test]
fn every_kind_of_terminal_gets_its_character_set_and_colours() {
    // Each terminal, each locale, and no colours with both character sets.
    for (term, locale, colour) in [
        ("xterm", "C.UTF-8", ""),
        ("xterm-256color", "C.UTF-8", ""),
        ("screen", "C.UTF-8", ""),
        ("tmux-256color", "C.UTF-8", ""),
        ("vt100", "C.UTF-8", ""),
        ("linux", "C.UTF-8", ""),
        ("xterm", "C", ""),
        ("screen", "POSIX", ""),
        ("linux", "de_DE.ISO-8859-1", ""),
        ("xterm-256color", "C.UTF-8", "1"),
        ("vt100", "C", "1"),
    ] {
        let launch = Launch::on_table_1().variable("TERM", term);
        let launch = launch.variable("LC_ALL", locale).variable("NO_COLOR", colour);
        let mut tty = launch.shown("quit");
        let screen = tty.screen();
        let is_ascii = ["linux", "vt100"].contains(&term) || locale != "C.UTF-8";
        assert_eq!(screen.contents().is_ascii(), is_ascii, "{term} {locale}");
        let plain = vt100::Color::Default;
        let (mut is_coloured, mut bold, mut inverse) = (false, 0, 0);
        for (row, column) in (0..24).flat_map(|row| (0..80).map(move |column| (row, column))) {
            let cell = screen.cell(row, column).expect("a cell");
            is_coloured |= (cell.fgcolor(), cell.bgcolor()) != (plain, plain);
            bold += usize::from(cell.bold());
            inverse += usize::from(cell.inverse());
        }
        assert_eq!(is_coloured, colour.is_empty(), "{term} {locale} NO_COLOR={colour:?}");
        assert!(bold > 0 && inverse > 0, "without colours, bold and reverse remain");
        tty.quit();
    }
    for term in ["dumb", ""] {
        let mut tty = Launch::on_table_1().variable("TERM", term).start();
        tty.written = Some(Vec::new());
        assert_eq!(tty.wait_for_end().exit_code(), 2);
        let words = tty.written.clone().unwrap_or_default();
        assert!(!words.contains(&0x1b), "{words:?}");
        tty.assert_restored();
        assert!(tty.shows("tipstrike solve"));
    }
}

#[test]
fn a_flood_and_a_long_paste_are_cheap_and_press_no_button() {
    let mut tty = opened(Launch::on_table_1());
    tty.written = Some(Vec::new());
    let start = Instant::now();
    tty.pour(vec![b"7".repeat(100_000)], &[]);
    tty.settle(QUIET);
    let written = tty.written.as_ref().map_or(0, Vec::len);
    println!("100,000 keys: {written} bytes out, {:.0?} with {QUIET:?} of quiet", start.elapsed());
    assert!(written <= 64 << 10, "{written} bytes");
    // Into a question, a megabyte of the first letters of every button.
    tty.type_for("\x11", "Discard");
    tty.pour(
        vec![b"\x1b[200~".to_vec(), b"dscyn\r \x11\x03".repeat(1 << 17), b"\x1b[201~".to_vec()],
        &[],
    );
    tty.settle(QUIET);
    assert!(!tty.has_ended() && tty.shows("Discard"), "{}", tty.screen().contents());
    tty.type_in("d");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
    assert_eq!(fs::read_to_string(tty.case()).expect("it is there"), TABLE_1);
}

#[test]
fn a_reply_that_nobody_asked_for_and_an_unfinished_sequence_leave_the_keys_alive() {
    for stray in [
        &b"\x1b[?2026;2$y"[..],
        b"\x1b[<",
        b"\x1b[1;",
        b"\x1b[1111",
        b"\x1b[M ",
        b"\x1bP1$r0",
        b"\x1b]11;rgb:00",
        b"\x1b[M5\x1b[",
        b"\x1b[M   ",
        b"\x1b[<0;0;0M",
        b"\x1b[0;0R",
        b"\x1b[32;0;0M",
        b"\x1b[?",
        b"\x1b[200~",
    ] {
        let mut tty = opened(Launch::on_table_1());
        tty.type_in(stray);
        tty.settle(QUIET);
        let is_paste = stray.ends_with(b"~");
        if is_paste {
            tty.type_in("\x1b");
            tty.settle(QUIET);
        }
        tty.type_in("\x15");
        tty.type_for("1.25 in", "1.25 in");
        // A control character ends an unfinished sequence without a delay.
        let stray = if is_paste { b"" } else { stray };
        tty.type_for([stray, b"\x11"].concat(), "Discard");
        tty.type_in("d");
        assert_eq!(tty.wait_for_end().exit_code(), 0, "{stray:?}");
    }
}

#[test]
fn a_paste_without_an_end_ends_after_a_silence() {
    let mut tty = opened(Launch::on_table_1());
    tty.type_for("\x15\x1b[200~1.25 in", "1.25 in");
    tty.discard();
}

#[test]
fn an_old_picture_in_the_alternate_screen_is_cleared() {
    let mut tty = Launch::on_table_1().start();
    tty.written = Some(Vec::new());
    tty.wait_for("quit");
    tty.settle(QUIET);
    // The terminal after a lost connection: full of old content, with a background colour for
    // erasing, and already in the alternate screen, so that entering it does not clear it.
    let mut old = vt100::Parser::new(cells(24), cells(80), 0);
    old.process("\x1b[44mX".repeat(24 * 80).as_bytes());
    let written = String::from_utf8(tty.written.clone().unwrap_or_default()).expect("words");
    old.process(written.replace("\x1b[?1049h", "").as_bytes());
    assert_eq!(old.screen().contents(), tty.screen().contents());
    assert_eq!(old.screen().contents_formatted(), tty.screen().contents_formatted());
    tty.quit();
}

#[test]
fn the_largest_terminal_costs_little_memory() {
    let mut tty = opened(Launch::on_table_1());
    for (rows, columns) in [(3000, 3000), (u16::MAX, u16::MAX)] {
        tty.resize(rows, columns);
        tty.wait_for("Corner contact");
        tty.settle(QUIET);
        let resident = tty.resident();
        println!("{columns}x{rows}: {resident} KiB");
        assert!(resident <= 150 << 10, "{columns}x{rows}: {resident} KiB");
        let outside = tty.screen().rows(1000, 200).any(|row| !row.is_empty());
        let below = tty.screen().rows(0, 1200).skip(500);
        assert!(!outside && below.into_iter().all(|row| row.is_empty()));
    }
    tty.resize(24, 80);
    tty.settle(QUIET);
    tty.wait_for("Corner contact");
    tty.quit();
}

#[test]
fn a_title_of_combining_marks_does_not_flood_the_terminal() {
    let launch = Launch::on_table_1();
    let title = format!("title = \"e{}", "\u{301}".repeat(400_000));
    let text = TABLE_1.replacen("title = \"", &title, 1);
    fs::write(launch.case(), text).expect("room on the disk");
    let mut tty = launch.start();
    tty.written = Some(Vec::new());
    tty.wait_for("quit");
    tty.settle(QUIET);
    tty.type_in("7");
    tty.settle(QUIET);
    let written = tty.written.as_ref().map_or(0, Vec::len);
    println!("{written} bytes");
    assert!(written <= 12 << 10, "{written} bytes");
}

#[test]
fn an_idle_workbench_sleeps_and_is_small() {
    const IDLE: Duration = Duration::from_secs(3);
    let mut tty = opened(Launch::on_table_1());
    tty.settle(Duration::from_millis(500));
    let before = wake_ups(tty.id());
    assert!(before > 0, "/proc reports wake-ups");
    assert_eq!(tty.take_output(IDLE), 0, "it writes while idle");
    assert_eq!(wake_ups(tty.id()) - before, 0, "it wakes while idle");
    let resident = tty.resident();
    println!("{resident} KiB resident");
    assert!(resident <= 30 << 10, "{resident} KiB");
    tty.quit();
}

/// The number of times that the system scheduled its threads.
fn wake_ups(process: u32) -> u64 {
    let tasks = fs::read_dir(format!("/proc/{process}/task")).expect("it runs").flatten();
    let switches = |text: String| {
        number_after(&text, "\nvoluntary_ctxt_switches:")
            + number_after(&text, "nonvoluntary_ctxt_switches:")
    };
    tasks.filter_map(|task| fs::read_to_string(task.path().join("status")).ok()).map(switches).sum()
}

#[test]
fn a_typed_digit_costs_few_bytes() {
    for (rows, columns) in [(24, 80), (40, 120)] {
        let mut tty = opened(Launch::on_table_1().size(rows, columns));
        // In a field without effect on the results, only the field is written.
        tty.type_in("\x1b[1;5H\x1b[B\x15");
        tty.settle(QUIET);
        // The first key of a visit also writes the mark of unsaved edits into the header.
        let first = each_key(&mut tty, "0")[0];
        let alone = largest(each_key(&mut tty, "123456789"));
        tty.type_in("\x1b[1;5H\x1b[B\x1b[B\x155.");
        tty.settle(QUIET);
        let whole = largest(each_key(&mut tty, "00123456789123456789"));
        println!(
            "{columns}x{rows}: {alone} bytes for a field alone ({first} with the mark), {whole} \
                with results and chart"
        );
        assert!(alone <= 120, "{columns}x{rows}: {alone} bytes for a field alone");
        assert!(first <= 600 && whole <= 600, "{columns} {rows} {whole}");
        tty.discard();
    }
}

fn each_key(tty: &mut Tty, keys: &str) -> Vec<usize> {
    let one = |key: char| {
        tty.type_in(key.to_string());
        tty.settle(QUIET)
    };
    keys.chars().map(one).collect()
}

fn largest(counts: Vec<usize>) -> usize {
    println!("{counts:?}");
    counts.into_iter().max().unwrap_or(0)
}
