//! A pseudo-terminal with a program: keys in, screen and bytes out, files in a folder.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::{Read, Write};
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, ExitStatus, MasterPty, PtySize, native_pty_system};
use tempfile::TempDir;

pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_tipstrike");
pub(crate) const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");
/// Far longer than any wait; only a failing test reaches it. Any machine sends a flood in this
/// time, unless the other end blocks.
const STUCK: Duration = Duration::from_secs(120);
pub(crate) const PATIENCE: Duration = Duration::from_secs(20);

/// Reads per second of a slow line.
const BEATS: usize = 100;

/// Greatest size of the emulated screen, in cells.
const MOST_ROWS: u16 = 600;
const MOST_COLUMNS: u16 = 1200;

/// The program to start, and its terminal.
pub(crate) struct Launch {
    pub(crate) folder: Arc<TempDir>,
    command: Vec<OsString>,
    variables: Vec<(String, String)>,
    size: (u16, u16),
}

/// A terminal with a running program.
pub(crate) struct Tty {
    pub(crate) folder: Arc<TempDir>,
    pub(crate) child: Box<dyn Child + Send + Sync>,
    /// All output, if it is recorded.
    pub(crate) written: Option<Vec<u8>>,
    line: Option<Line>,
    screen: vt100::Parser,
    /// The modes of the terminal before the start of the program.
    before: String,
}

/// Our end of the terminal; dropping it and its reader hangs up the terminal.
struct Line {
    master: Box<dyn MasterPty + Send>,
    writer: Box<dyn Write + Send>,
    output: Receiver<Vec<u8>>,
    reader: JoinHandle<()>,
    is_stalled: Arc<AtomicBool>,
    /// Bytes read per second; 0 for all available bytes.
    pace: Arc<AtomicUsize>,
}

impl Launch {
    /// The workbench on a case in a temporary folder.
    pub(crate) fn on_table_1() -> Launch {
        let launch = Launch::of(Arc::new(tempfile::tempdir().expect("a folder")));
        fs::write(launch.case(), TABLE_1).expect("room on the disk");
        let case = launch.case();
        launch.argument(case)
    }

    /// The workbench in an existing folder.
    pub(crate) fn of(folder: Arc<TempDir>) -> Launch {
        // The program sees no file of the user or of another test.
        let place = |name: &str| folder.path().join(name).display().to_string();
        let variables = [
            ("HOME", place("")),
            ("XDG_STATE_HOME", place("")),
            ("XDG_CONFIG_HOME", place("")),
            ("XDG_RUNTIME_DIR", place("run")),
            ("TMPDIR", place("tmp")),
            ("TERM", "xterm-256color".to_owned()),
            ("LC_ALL", "C.UTF-8".to_owned()),
        ];
        let variables = variables.map(|(name, value)| (name.to_owned(), value)).to_vec();
        Launch { command: vec![PROGRAM.into()], variables, size: (24, 80), folder }
    }

    pub(crate) fn argument(mut self, argument: impl AsRef<OsStr>) -> Launch {
        self.command.push(argument.as_ref().to_owned());
        self
    }

    /// Runs through another program, such as `strace`.
    pub(crate) fn through(mut self, wrapper: &[&str]) -> Launch {
        self.command.splice(0..0, wrapper.iter().map(OsString::from));
        self
    }

    /// Makes system calls fail, optionally those on one file only.
    pub(crate) fn under_fault(self, calls: &str, fault: &str, file: Option<&Path>) -> Launch {
        let file = file.map(|file| file.to_str().expect("a name in UTF-8"));
        let (trace, inject) = (format!("trace={calls}"), format!("inject={calls}:{fault}"));
        let start = ["strace", "-f", "-qq", "-o", "/dev/null"];
        let only = file.map_or(Vec::new(), |file| vec!["-P", file]);
        self.through(&[&start[..], &only, &["-e", &trace, "-e", &inject, "--"]].concat())
    }

    /// Runs another program.
    pub(crate) fn instead(mut self, program: &str) -> Launch {
        self.command[0] = program.into();
        self
    }

    pub(crate) fn variable(mut self, name: &str, value: &str) -> Launch {
        self.variables.push((name.to_owned(), value.to_owned()));
        self
    }

    pub(crate) fn size(mut self, rows: u16, columns: u16) -> Launch {
        self.size = (rows, columns);
        self
    }

    pub(crate) fn case(&self) -> PathBuf {
        self.folder.path().join("case.toml")
    }

    /// Starts the program and waits for a text.
    pub(crate) fn shown(self, text: &str) -> Tty {
        let mut tty = self.start();
        tty.wait_for(text);
        tty
    }

    pub(crate) fn start(self) -> Tty {
        let (rows, cols) = self.size;
        let pair = native_pty_system()
            .openpty(PtySize { rows, cols, ..PtySize::default() })
            .expect("a pseudo terminal");
        let mut command = CommandBuilder::new(&self.command[0]);
        command.args(&self.command[1..]);
        command.cwd(self.folder.path());
        for (name, value) in &self.variables {
            command.env(name, value);
        }
        let before = modes(&*pair.master);
        assert!(before.contains("ECHO") && before.contains("ICANON"), "a fresh terminal echoes");
        let mut reader = pair.master.try_clone_reader().expect("a reader");
        let writer = pair.master.take_writer().expect("a writer");
        let child = pair.slave.spawn_command(command).expect("the program starts");
        let (sender, output) = channel();
        let is_stalled = Arc::new(AtomicBool::new(false));
        let stalled = Arc::clone(&is_stalled);
        let pace = Arc::new(AtomicUsize::new(0));
        let their_pace = Arc::clone(&pace);
        let reader = thread::spawn(move || {
            let mut buffer = [0; 16384];
            loop {
                let pace = their_pace.load(Ordering::Relaxed);
                let most =
                    if pace == 0 { buffer.len() } else { (pace / BEATS).clamp(1, buffer.len()) };
                let Ok(count @ 1..) = reader.read(&mut buffer[..most]) else { return };
                if sender.send(buffer[..count].to_vec()).is_err() {
                    return;
                }
                if pace > 0 {
                    thread::sleep(Duration::from_secs(1) / u32::try_from(BEATS).unwrap_or(1));
                }
                while stalled.load(Ordering::Relaxed) && Arc::strong_count(&stalled) > 1 {
                    thread::sleep(Duration::from_millis(5));
                }
            }
        });
        let line = Some(Line { master: pair.master, writer, output, reader, is_stalled, pace });
        let screen = vt100::Parser::new(cells(rows), cells(cols), 0);
        Tty { folder: self.folder, child, written: None, line, screen, before }
    }
}

impl Tty {
    /// The workbench on Table 1.
    pub(crate) fn open() -> Tty {
        Launch::on_table_1().start()
    }

    pub(crate) fn case(&self) -> PathBuf {
        self.folder.path().join("case.toml")
    }

    pub(crate) fn screen(&self) -> &vt100::Screen {
        self.screen.screen()
    }

    fn line(&mut self) -> &mut Line {
        self.line.as_mut().expect("the terminal has not hung up")
    }

    pub(crate) fn type_in(&mut self, keys: impl AsRef<[u8]>) {
        self.try_to_type(keys.as_ref()).expect("the terminal accepts keys");
    }

    /// Sends keys; fails if the program has ended.
    pub(crate) fn try_to_type(&mut self, keys: &[u8]) -> std::io::Result<()> {
        let writer = &mut self.line().writer;
        writer.write_all(keys).and_then(|()| writer.flush())
    }

    /// Sends keys from a separate thread, because a terminal accepts a limited number at a time.
    /// Changes the size in the meantime.
    pub(crate) fn pour(&mut self, pieces: Vec<Vec<u8>>, sizes: &[(u16, u16)]) {
        let mut writer = std::mem::replace(&mut self.line().writer, Box::new(std::io::sink()));
        let pouring = thread::spawn(move || {
            let pour = |piece: &Vec<u8>| writer.write_all(piece).and_then(|()| writer.flush());
            pieces.iter().try_for_each(pour).ok();
            writer
        });
        let mut sizes = sizes.iter();
        let end = Instant::now() + STUCK;
        while !pouring.is_finished() || sizes.len() > 0 {
            if let Some(&(rows, columns)) = sizes.next() {
                self.resize(rows, columns);
            }
            self.take_output(Duration::from_millis(5));
            self.wake();
            assert!(Instant::now() < end, "it accepts no more keys");
        }
        self.line().writer = pouring.join().expect("all is poured");
    }

    pub(crate) fn resize(&mut self, rows: u16, columns: u16) {
        self.line()
            .master
            .resize(PtySize { rows, cols: columns, ..PtySize::default() })
            .expect("a new size");
        let (rows, columns) = (rows.min(MOST_ROWS), columns.min(MOST_COLUMNS));
        if let (Some(rows), Some(columns)) = (NonZero::new(rows), NonZero::new(columns)) {
            self.screen.screen_mut().set_size(rows, columns);
        }
    }

    pub(crate) fn shows(&self, text: &str) -> bool {
        self.screen().contents().contains(text)
    }

    /// Waits for a text, then for the rest of its frame, which may arrive in parts.
    pub(crate) fn wait_for(&mut self, text: &str) {
        self.wait_until(&format!("{text:?} on the screen"), |tty| tty.shows(text));
        self.settle(Duration::from_millis(10));
    }

    pub(crate) fn type_for(&mut self, keys: impl AsRef<[u8]>, text: &str) {
        self.type_in(keys);
        self.wait_for(text);
    }

    pub(crate) fn wait_until(&mut self, what: &str, is_so: impl Fn(&mut Tty) -> bool) {
        let end = Instant::now() + PATIENCE;
        while !is_so(self) {
            assert!(Instant::now() < end, "{what} {}", self.screen().contents());
            self.take_output(Duration::from_millis(5));
        }
    }

    /// The number of bytes that arrive within the time.
    pub(crate) fn take_output(&mut self, time: Duration) -> usize {
        let Some(line) = &self.line else {
            thread::sleep(time);
            return 0;
        };
        match line.output.recv_timeout(time) {
            Ok(bytes) => {
                self.screen.process(&bytes);
                self.written.iter_mut().for_each(|written| written.extend(&bytes));
                bytes.len()
            }
            Err(RecvTimeoutError::Timeout) => 0,
            Err(RecvTimeoutError::Disconnected) => {
                thread::sleep(time);
                0
            }
        }
    }

    /// Reads until nothing arrives for `quiet`. Returns the number of bytes.
    pub(crate) fn settle(&mut self, quiet: Duration) -> usize {
        let end = Instant::now() + PATIENCE;
        let mut total = 0;
        loop {
            match self.take_output(quiet) {
                0 => return total,
                count => total += count,
            }
            assert!(Instant::now() < end, "it never stops writing:\n{}", self.screen().contents());
        }
    }

    pub(crate) fn id(&self) -> u32 {
        self.child.process_id().expect("the program has an id")
    }

    pub(crate) fn send_signal(&self, name: &str) {
        signal(name, &self.id().to_string());
    }

    /// Sends a signal and waits for the end.
    pub(crate) fn end_by(&mut self, signal: &str) -> ExitStatus {
        self.send_signal(signal);
        self.wait_for_end()
    }

    /// Continues the program if it has suspended itself.
    pub(crate) fn wake(&self) {
        if self.state() == Some('T') {
            self.send_signal("CONT");
        }
    }

    pub(crate) fn has_ended(&mut self) -> bool {
        self.child.try_wait().expect("our own child").is_some()
    }

    pub(crate) fn wait_for_end(&mut self) -> ExitStatus {
        let end = Instant::now() + PATIENCE;
        loop {
            if let Some(status) = self.child.try_wait().expect("our own child") {
                // Until the terminal reports that no writer is left.
                while self.take_output(Duration::from_millis(50)) > 0 {}
                return status;
            }
            assert!(Instant::now() < end, "{}", self.screen().contents());
            self.take_output(Duration::from_millis(5));
        }
    }

    /// Quits a workbench without unsaved edits.
    pub(crate) fn quit(&mut self) {
        self.type_in("\x11");
        assert_eq!(self.wait_for_end().exit_code(), 0);
    }

    /// Quits a workbench and discards its unsaved edits.
    pub(crate) fn discard(&mut self) {
        self.type_in("\x11");
        self.wait_for("Discard");
        self.type_in("d");
        assert_eq!(self.wait_for_end().exit_code(), 0);
    }

    /// Checks a condition; a failure prints the screen.
    #[track_caller]
    pub(crate) fn assert(&self, holds: bool) {
        assert!(holds, "{}", self.screen().contents());
    }

    /// Closes the terminal, as a broken connection does.
    pub(crate) fn hang_up(&mut self) {
        let Line { master, writer, output, reader, .. } =
            self.line.take().expect("the terminal has not hung up");
        drop(output);
        drop(writer);
        // The reader sleeps on a copy of our end until bytes arrive: the test writes to the other
        // end itself.
        let other_end = master.tty_name().expect("the terminal has a name");
        let end = Instant::now() + PATIENCE;
        while !reader.is_finished() {
            let terminal = fs::OpenOptions::new().write(true).open(&other_end);
            terminal.and_then(|mut terminal| terminal.write_all(b" ")).ok();
            assert!(Instant::now() < end, "the reader stays");
            thread::sleep(Duration::from_millis(2));
        }
    }

    /// Sends a signal to the foreground program of this terminal.
    pub(crate) fn send_to_program(&self, name: &str) {
        let front = self.line.as_ref().and_then(|line| line.master.process_group_leader());
        signal(name, &front.expect("something is in front").to_string());
    }

    /// Stops reading, and makes the program draw until the terminal accepts no more bytes.
    pub(crate) fn stall(&mut self) {
        self.line().is_stalled.store(true, Ordering::Relaxed);
        for _ in 0..60 {
            self.type_in("\x0c");
            thread::sleep(Duration::from_millis(3));
        }
    }

    /// Limits the line to a number of bytes per second; 0 for no limit.
    pub(crate) fn set_pace(&mut self, bytes_a_second: usize) {
        self.line().pace.store(bytes_a_second, Ordering::Relaxed);
    }

    pub(crate) fn modes(&self) -> String {
        modes(&*self.line.as_ref().expect("the terminal has not hung up").master)
    }

    /// Checks that the terminal is restored: modes, screen, cursor, paste.
    pub(crate) fn assert_restored(&self) {
        assert_eq!(self.modes(), self.before, "the modes are unchanged");
        assert!(!self.screen().alternate_screen(), "the alternate screen is left");
        assert!(!self.screen().hide_cursor(), "the cursor is shown");
        assert!(!self.screen().bracketed_paste(), "pastes are plain again");
    }

    /// Checks that the terminal has the modes of the workbench.
    pub(crate) fn assert_taken(&self) {
        assert!(self.screen().alternate_screen() && self.screen().bracketed_paste());
        assert_ne!(self.modes(), self.before);
    }

    /// The resident memory of the program, in KiB.
    pub(crate) fn resident(&self) -> u64 {
        let status = fs::read_to_string(format!("/proc/{}/status", self.id())).expect("it runs");
        number_after(&status, "VmRSS:")
    }

    /// The state of the process: `T` if it is stopped.
    pub(crate) fn state(&self) -> Option<char> {
        stat(self.id())?.first()?.chars().next()
    }
}

impl Drop for Tty {
    fn drop(&mut self) {
        // A failed test must leave no process behind.
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

fn signal(name: &str, process: &str) {
    let status = Command::new("kill").args([&format!("-{name}"), process]).status();
    assert!(status.is_ok_and(|status| status.success()), "{name} {process}");
}

/// The fields of a process's state after its name: state, parent, group, ...; 11 and 12 are its
/// ticks in user and system mode.
pub(crate) fn stat(process: u32) -> Option<Vec<String>> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    Some(text.rsplit_once(')')?.1.split_whitespace().map(str::to_owned).collect())
}

/// The number after a name in a file of `/proc`.
pub(crate) fn number_after(text: &str, name: &str) -> u64 {
    let rest = text.split_once(name).map_or("", |(_, rest)| rest);
    rest.split_whitespace().next().and_then(|number| number.parse().ok()).unwrap_or(0)
}

/// The journals of unsaved edits in a state folder.
pub(crate) fn journals(state: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(state.join("tipstrike/journals")).into_iter().flatten().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    paths
}

/// Whether a required tool is installed; reports a missing tool, so that a skipped test is visible.
pub(crate) fn is_there(tool: &str) -> bool {
    let found = Command::new("sh")
        .args(["-c", "command -v \"$0\" >/dev/null", tool])
        .status()
        .is_ok_and(|status| status.success());
    if !found {
        skip(&format!("{tool} is not installed"));
    }
    found
}

/// Whether the program has faults on request; reports a release build, which has none.
pub(crate) fn has_faults_on_demand() -> bool {
    if !cfg!(debug_assertions) {
        skip("a release has no faults on demand");
    }
    cfg!(debug_assertions)
}

/// Reports a skipped test directly, because the harness hides the output of passing tests;
/// `.ci/run` counts these reports.
pub(crate) fn skip(why: &str) {
    let line = format!("SKIPPED {}: {why}\n", thread::current().name().unwrap_or("a test"));
    std::io::stderr().write_all(line.as_bytes()).ok();
    if let Some(file) = std::env::var_os("TIPSTRIKE_SKIPPED") {
        let file = fs::OpenOptions::new().append(true).create(true).open(file);
        file.and_then(|mut file| file.write_all(line.as_bytes())).ok();
    }
}

pub(crate) fn cells(count: u16) -> NonZero<u16> {
    NonZero::new(count).unwrap_or(NonZero::<u16>::MIN)
}

fn modes(master: &(dyn MasterPty + Send)) -> String {
    format!("{:?}", master.get_termios().expect("a terminal has modes"))
}
