//! The built program on a real terminal: it types, saves, quits, and restores the terminal.
use crate::tty;

use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

use tty::{Launch, PROGRAM, TABLE_1, Tty, journals};

#[test]
fn it_types_saves_quits_and_gives_the_terminal_back() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty.assert_taken();
    tty.type_in("\x151 in");
    tty.wait_for("*unsaved*");
    tty.wait_for("1 in");
    tty.type_in("\x13");
    tty.wait_for("saved ");
    tty.quit();
    tty.assert_restored();
    assert_eq!(
        fs::read_to_string(tty.case()).expect("it is there"),
        TABLE_1.replace("\"5 mm\"", "\"1 in\"")
    );
}

/// Signals that end a process, and their descriptions by the system.
const DEADLY: [(&str, &str); 24] = [
    ("HUP", "Hangup"),
    ("INT", "Interrupt"),
    ("QUIT", "Quit"),
    ("ILL", "Illegal instruction"),
    ("TRAP", "Trace/breakpoint trap"),
    ("ABRT", "Aborted"),
    ("BUS", "Bus error"),
    ("FPE", "Floating point exception"),
    ("USR1", "User defined signal 1"),
    ("SEGV", "Segmentation fault"),
    ("USR2", "User defined signal 2"),
    ("ALRM", "Alarm clock"),
    ("TERM", "Terminated"),
    ("STKFLT", "Stack fault"),
    ("XCPU", "CPU time limit exceeded"),
    ("VTALRM", "Virtual timer expired"),
    ("PROF", "Profiling timer expired"),
    ("29", "I/O possible"),
    ("PWR", "Power failure"),
    ("SYS", "Bad system call"),
    ("34", "Real-time signal 0"),
    ("41", "Real-time signal 7"),
    ("63", "Real-time signal 29"),
    ("64", "Real-time signal 30"),
];

#[test]
fn every_deadly_signal_restores_the_terminal_keeps_the_edit_and_ends_the_process() {
    for (signal, name) in DEADLY {
        let mut tty = Tty::open();
        tty.wait_for("Corner contact");
        tty.type_in("\x151.25 in");
        tty.wait_for("1.25 in");
        tty.send_signal(signal);
        assert_eq!(tty.wait_for_end().signal(), Some(name), "{signal}");
        tty.assert_restored();
        let kept = journals(tty.folder.path());
        assert_eq!(kept.len(), 1, "{signal}");
        let journal = fs::read_to_string(&kept[0]).expect("it is there");
        assert!(journal.contains("1.25 in"), "{signal}: {journal}");
    }
}

#[test]
fn the_workbench_suspends_and_resumes() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty.send_signal("TSTP");
    tty.wait_until("the alternate screen to be left", |tty| !tty.screen().alternate_screen());
    tty.wait_until("it to stop", |tty| tty.state() == Some('T'));
    tty.assert_restored();
    tty.send_signal("CONT");
    tty.wait_until("the workbench to resume", |tty| {
        tty.screen().alternate_screen() && tty.shows("Corner contact")
    });
    tty.quit();
    tty.assert_restored();
}

#[test]
fn nothing_is_written_while_idle() {
    let mut tty = Tty::open();
    tty.wait_for("quit");
    while tty.take_output(Duration::from_millis(300)) > 0 {}
    assert_eq!(tty.take_output(Duration::from_secs(2)), 0);
    tty.quit();
}

#[test]
fn a_flood_of_keys_does_not_block_the_workbench() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty.pour(vec!["7".repeat(100_000).into_bytes()], &[]);
    tty.wait_for("777777");
    tty.type_in("\x15");
    tty.type_in("5 mm");
    tty.wait_until("the end of the flood", |tty| tty.shows("5 mm") && !tty.shows("*unsaved*"));
    tty.quit();
}

#[test]
fn a_paste_presses_no_button() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty.type_in("\x15\x1b[200~3\x03\x11\rmm\x1b[201~");
    tty.wait_for("3 mm");
    assert!(!tty.has_ended());
    tty.discard();
}

#[test]
fn a_terminal_without_unicode_gets_ascii_and_no_color_no_colour() {
    let mut tty = Launch::on_table_1().variable("TERM", "linux").variable("NO_COLOR", "1").start();
    tty.wait_for("quit");
    let screen = tty.screen();
    assert!(screen.contents().is_ascii(), "{}", screen.contents());
    let cells = (0..24).flat_map(|row| (0..80).filter_map(move |column| screen.cell(row, column)));
    let (mut bold, mut inverse) = (0, 0);
    for cell in cells {
        assert_eq!(
            (cell.fgcolor(), cell.bgcolor()),
            (vt100::Color::Default, vt100::Color::Default)
        );
        bold += usize::from(cell.bold());
        inverse += usize::from(cell.inverse());
    }
    assert!(bold > 0 && inverse > 0, "without colours, bold and reverse remain");
    tty.quit();
}

#[test]
fn a_terminal_that_changes_its_size_is_followed() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    for (rows, columns) in [(10, 30), (45, 140), (3, 200), (24, 80)] {
        tty.resize(rows, columns);
    }
    tty.wait_for("Corner contact");
    tty.quit();
}

#[test]
fn the_last_case_is_opened_again_and_a_broken_one_is_reported() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty.quit();
    let mut tty = Launch::of(tty.folder.clone()).start();
    tty.wait_for("case.toml (last case; Alt-T: Table 1)");
    tty.quit();
    fs::write(tty.case(), "no case").expect("room on the disk");
    let mut tty = Launch::of(tty.folder.clone()).start();
    tty.wait_for("the last case cannot be opened");
    assert!(tty.shows("built-in Table 1"));
    tty.quit();
}

#[test]
fn standard_input_is_refused_as_a_case_and_not_waited_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut tty = Launch::of(folder.into()).argument("-").start();
    tty.wait_for("the workbench does not read standard input");
    tty.type_in("q\x11");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
}

#[test]
fn without_a_terminal_it_names_the_headless_command() {
    for term in [Some("dumb"), Some("xterm"), None] {
        let mut command = Command::new(PROGRAM);
        command.stdin(Stdio::null()).env_remove("TERM");
        if let Some(term) = term {
            command.env("TERM", term);
        }
        let output = command.output().expect("the program starts");
        let words = String::from_utf8(output.stderr).expect("words");
        assert_eq!(output.status.code(), Some(2), "{term:?}");
        assert!(output.stdout.is_empty(), "{term:?}");
        assert!(
            words.contains("tipstrike solve") && words.lines().count() == 1,
            "{term:?}: {words}"
        );
    }
}

#[test]
fn a_dumb_terminal_is_refused() {
    let mut tty = Launch::on_table_1().variable("TERM", "dumb").start();
    assert_eq!(tty.wait_for_end().exit_code(), 2);
    tty.assert_restored();
    assert!(tty.shows("tipstrike solve"));
}
