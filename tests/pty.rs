//! The built program on a real terminal: it types, saves, leaves, and gives the terminal back as it found it.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on says why")]
#![cfg(all(feature = "cli", feature = "tui"))]

use std::ffi::OsStr;
use std::fs;
use std::io::{Read, Write};
use std::num::NonZero;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system};
use tempfile::TempDir;

const PROGRAM: &str = env!("CARGO_BIN_EXE_tipstrike");
const TABLE_1: &str = include_str!("../cases/zhou-chen-2014.toml");
/// Far longer than anything takes; only a failing test waits for it.
const PATIENCE: Duration = Duration::from_secs(20);

/// A terminal with the program in it.
struct Tty {
    master: Box<dyn MasterPty + Send>,
    writer: Box<dyn Write + Send>,
    output: Receiver<Vec<u8>>,
    screen: vt100::Parser,
    child: Box<dyn Child + Send + Sync>,
    folder: TempDir,
}

impl Tty {
    /// On a case in a folder of its own.
    fn open(variables: &[(&str, &str)]) -> Tty {
        let folder = tempfile::tempdir().expect("a folder");
        let case = folder.path().join("case.toml");
        fs::write(&case, TABLE_1).expect("room on the disk");
        Tty::start(folder, &[case.as_os_str()], variables)
    }

    fn start(folder: TempDir, arguments: &[&OsStr], variables: &[(&str, &str)]) -> Tty {
        let size = PtySize { rows: 24, cols: 80, ..PtySize::default() };
        let pair = native_pty_system().openpty(size).expect("a pseudo terminal");
        let mut command = CommandBuilder::new(PROGRAM);
        command.args(arguments);
        command.env("XDG_STATE_HOME", folder.path());
        command.env("TERM", "xterm-256color");
        command.env("LC_ALL", "C.UTF-8");
        for (name, value) in variables {
            command.env(name, value);
        }
        let mut reader = pair.master.try_clone_reader().expect("a reader");
        let writer = pair.master.take_writer().expect("a writer");
        let before = modes(&*pair.master);
        assert!(before.contains("ECHO") && before.contains("ICANON"), "a fresh terminal echoes");
        let child = pair.slave.spawn_command(command).expect("the program starts");
        let (sender, output) = channel();
        thread::spawn(move || {
            let mut buffer = [0; 4096];
            while let Ok(count @ 1..) = reader.read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        Tty { master: pair.master, writer, output, screen: vt100::Parser::new(cells(24), cells(80), 0), child, folder }
    }

    fn type_in(&mut self, keys: &str) {
        self.writer.write_all(keys.as_bytes()).and_then(|()| self.writer.flush()).expect("the terminal takes keys");
    }

    fn shows(&self, text: &str) -> bool {
        self.screen.screen().contents().contains(text)
    }

    fn wait_for(&mut self, text: &str) {
        self.wait_until(&format!("{text:?} on the screen"), |tty| tty.shows(text));
    }

    fn wait_until(&mut self, what: &str, is_so: impl Fn(&mut Tty) -> bool) {
        let end = Instant::now() + PATIENCE;
        while !is_so(self) {
            assert!(Instant::now() < end, "waited for {what} in vain:\n{}", self.screen.screen().contents());
            self.take_output(Duration::from_millis(20));
        }
    }

    /// How many bytes came within the time.
    fn take_output(&mut self, time: Duration) -> usize {
        match self.output.recv_timeout(time) {
            Ok(bytes) => {
                self.screen.process(&bytes);
                bytes.len()
            }
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => 0,
        }
    }

    fn send_signal(&self, name: &str) {
        let id = self.child.process_id().expect("the program has an id").to_string();
        let status = Command::new("kill").args([&format!("-{name}"), &id]).status().expect("kill is there");
        assert!(status.success());
    }

    fn wait_for_end(&mut self) -> ExitStatus {
        let end = Instant::now() + PATIENCE;
        loop {
            if let Some(status) = self.child.try_wait().expect("our own child") {
                while self.take_output(Duration::from_millis(50)) > 0 {}
                return status;
            }
            assert!(Instant::now() < end, "the program does not end");
            self.take_output(Duration::from_millis(10));
        }
    }

    fn case(&self) -> PathBuf {
        self.folder.path().join("case.toml")
    }

    /// The terminal as it was before: modes, screen, cursor, paste.
    fn assert_restored(&self, before: &str) {
        assert_eq!(modes(&*self.master), before, "the modes are what they were");
        let screen = self.screen.screen();
        assert!(!screen.alternate_screen(), "the alternate screen is left");
        assert!(!screen.hide_cursor(), "the cursor is shown");
        assert!(!screen.bracketed_paste(), "pastes are plain again");
    }
}

fn cells(count: u16) -> NonZero<u16> {
    NonZero::new(count).expect("a screen has cells")
}

fn modes(master: &(dyn MasterPty + Send)) -> String {
    format!("{:?}", master.get_termios().expect("a terminal has modes"))
}

#[test]
fn it_types_saves_quits_and_gives_the_terminal_back() {
    let mut tty = Tty::open(&[]);
    let before = before();
    tty.wait_for("Corner contact");
    assert!(tty.screen.screen().alternate_screen() && tty.screen.screen().bracketed_paste());
    assert_ne!(modes(&*tty.master), before);
    tty.type_in("\x151 in");
    tty.wait_for("*unsaved*");
    tty.wait_for("1 in");
    tty.type_in("\x13");
    tty.wait_for("saved ");
    tty.type_in("\x11");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
    tty.assert_restored(&before);
    assert_eq!(fs::read_to_string(tty.case()).expect("it is there"), TABLE_1.replace("\"5 mm\"", "\"1 in\""));
}

#[test]
fn a_signal_to_end_gives_the_terminal_back() {
    for (signal, code) in [("TERM", 128 + 15), ("HUP", 128 + 1), ("INT", 128 + 2)] {
        let mut tty = Tty::open(&[]);
        tty.wait_for("Corner contact");
        tty.send_signal(signal);
        assert_eq!(tty.wait_for_end().exit_code(), code, "{signal}");
        tty.assert_restored(&before());
    }
}

#[test]
fn it_suspends_and_comes_back() {
    let mut tty = Tty::open(&[]);
    tty.wait_for("Corner contact");
    tty.send_signal("TSTP");
    tty.wait_until("the alternate screen to be left", |tty| !tty.screen.screen().alternate_screen());
    tty.wait_until("it to stop", |tty| state_of(tty) == Some('T'));
    tty.assert_restored(&before());
    tty.send_signal("CONT");
    tty.wait_until("it to come back", |tty| tty.screen.screen().alternate_screen() && tty.shows("Corner contact"));
    tty.type_in("\x11");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
    tty.assert_restored(&before());
}

#[test]
fn nothing_is_written_while_idle() {
    let mut tty = Tty::open(&[]);
    tty.wait_for("quit");
    while tty.take_output(Duration::from_millis(300)) > 0 {}
    assert_eq!(tty.take_output(Duration::from_secs(2)), 0);
    tty.type_in("\x11");
    tty.wait_for_end();
}

#[test]
fn a_flood_of_keys_leaves_it_responsive() {
    let mut tty = Tty::open(&[]);
    tty.wait_for("Corner contact");
    let flood = "7".repeat(100_000);
    // A terminal takes only so much at a time: the flood comes from a thread of its own.
    let mut pouring = std::mem::replace(&mut tty.writer, Box::new(std::io::sink()));
    let poured = thread::spawn(move || {
        pouring.write_all(flood.as_bytes()).expect("the terminal takes keys");
        pouring
    });
    tty.wait_for("777777");
    while !poured.is_finished() {
        tty.take_output(Duration::from_millis(10));
    }
    tty.writer = poured.join().expect("the flood is over");
    tty.type_in("\x15");
    tty.type_in("5 mm");
    tty.wait_until("the end of the flood", |tty| tty.shows("5 mm") && !tty.shows("*unsaved*"));
    tty.type_in("\x11");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
}

#[test]
fn a_paste_presses_nothing() {
    let mut tty = Tty::open(&[]);
    tty.wait_for("Corner contact");
    tty.type_in("\x15\x1b[200~3 m\x03\x11\rm\x1b[201~");
    tty.wait_for("3 mm");
    assert!(tty.child.try_wait().expect("our own child").is_none());
    tty.type_in("\x11");
    tty.wait_for("Discard");
    tty.type_in("d");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
}

#[test]
fn a_terminal_without_unicode_gets_ascii_and_no_color_no_colour() {
    let mut tty = Tty::open(&[("TERM", "linux"), ("NO_COLOR", "1")]);
    tty.wait_for("quit");
    let screen = tty.screen.screen();
    assert!(screen.contents().is_ascii(), "{}", screen.contents());
    let cells = (0..24).flat_map(|row| (0..80).filter_map(move |column| screen.cell(row, column)));
    let (mut bold, mut inverse) = (0, 0);
    for cell in cells {
        assert_eq!((cell.fgcolor(), cell.bgcolor()), (vt100::Color::Default, vt100::Color::Default));
        bold += usize::from(cell.bold());
        inverse += usize::from(cell.inverse());
    }
    assert!(bold > 0 && inverse > 0, "without colours, bold and reverse remain");
    tty.type_in("\x11");
    tty.wait_for_end();
}

#[test]
fn a_terminal_that_changes_its_size_is_followed() {
    let mut tty = Tty::open(&[]);
    tty.wait_for("Corner contact");
    for (rows, columns) in [(10, 30), (45, 140), (3, 200), (24, 80)] {
        tty.master.resize(PtySize { rows, cols: columns, ..PtySize::default() }).expect("a new size");
        tty.screen.screen_mut().set_size(cells(rows), cells(columns));
    }
    tty.wait_for("Corner contact");
    tty.type_in("\x11");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
}

#[test]
fn the_last_case_is_opened_again_and_a_broken_one_is_told() {
    let mut tty = Tty::open(&[]);
    tty.wait_for("Corner contact");
    tty.type_in("\x11");
    tty.wait_for_end();
    let mut tty = Tty::start(tty.folder, &[], &[]);
    tty.wait_for("case.toml");
    tty.type_in("\x11");
    tty.wait_for_end();
    fs::write(tty.case(), "no case").expect("room on the disk");
    let mut tty = Tty::start(tty.folder, &[], &[]);
    tty.wait_for("the last case cannot be opened");
    assert!(tty.shows("built-in Table 1"));
    tty.type_in("\x11");
    tty.wait_for_end();
}

#[test]
fn standard_input_is_refused_as_a_case_and_not_waited_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut tty = Tty::start(folder, &[OsStr::new("-")], &[]);
    tty.wait_for("standard input is no case");
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
        assert!(words.contains("tipstrike solve") && words.lines().count() == 1, "{term:?}: {words}");
    }
}

#[test]
fn a_dumb_terminal_is_refused_even_if_it_is_one() {
    let mut tty = Tty::open(&[("TERM", "dumb")]);
    assert_eq!(tty.wait_for_end().exit_code(), 2);
    tty.assert_restored(&before());
    assert!(tty.shows("tipstrike solve"));
}

/// The modes of a terminal on which nothing runs.
fn before() -> String {
    let pair = native_pty_system().openpty(PtySize::default()).expect("a pseudo terminal");
    modes(&*pair.master)
}

/// The state of the process: `T` when it is stopped.
fn state_of(tty: &Tty) -> Option<char> {
    let id = tty.child.process_id()?.to_string();
    let output = Command::new("ps").args(["-o", "stat=", "-p", &id]).output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().chars().next()
}
