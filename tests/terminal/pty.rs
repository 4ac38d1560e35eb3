//! The built program on a real terminal: it types, saves, quits, and restores the terminal.
use crate::tty::{Launch, PROGRAM, TABLE_1, Tty, journals};

use std::fs;
use std::process::{Command, Stdio};

#[test]
fn it_types_saves_quits_and_gives_the_terminal_back() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty.assert_taken();
    tty.type_for("\x151 in", "*unsaved*");
    tty.wait_for("1 in");
    tty.type_for("\x13", "saved ");
    tty.quit();
    tty.assert_restored();
    let saved = fs::read_to_string(tty.case()).expect("it is there");
    assert_eq!(saved, TABLE_1.replace("\"5 mm\"", "\"1 in\""));
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
        tty.type_for("\x151.25 in", "1.25 in");
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
fn the_last_case_is_opened_again_and_a_broken_one_is_reported() {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty.quit();
    let mut tty = Launch::of(tty.folder.clone()).shown("case.toml (last case; Alt-T: Table 1)");
    tty.quit();
    fs::write(tty.case(), "no case").expect("room on the disk");
    let mut tty = Launch::of(tty.folder.clone()).shown("the last case cannot be opened");
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
        assert!(words.contains("tipstrike solve") && words.lines().count() == 1, "{term:?}");
    }
}
