//! Bytes into the built program on a real terminal: it stays, it leaves when told to, and gives the terminal back.

use std::fs;
use std::io::Write;
use std::process::Command;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use tempfile::TempDir;

use crate::hold;

const PROGRAM: &str = env!("CARGO_BIN_EXE_tipstrike");
const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");
/// Far longer than anything takes; only a failing test waits for it.
const PATIENCE: Duration = Duration::from_secs(20);
/// The program has taken what came when it writes nothing for so long. Longer than it waits for the rest of a sequence.
const QUIET: Duration = Duration::from_millis(90);

/// What terminals send, whole, in part, and what none should.
#[rustfmt::skip]
const SEQUENCES: [&[u8]; 57] = [
    b"\x1b[A", b"\x1b[B", b"\x1b[C", b"\x1b[D", b"\x1b[H", b"\x1b[F", b"\x1b[Z", b"\x1bOP", b"\x1bOQ", b"\x1b[15~", b"\x1b[17~",
    b"\x1b[19~", b"\x1b[1;5B", b"\x1b[1;5H", b"\x1b[5~", b"\x1b[6~", b"\x1b[3~", b"\x1b", b"\x1b[", b"\x1bO", b"\x1b[1;",
    b"\x1b[<", b"\x1b[?", b"\x1b[M", b"\x1b[M !!", b"\x1b[<0;10;10M", b"\x1b[<64;999999;1m", b"\x1b[I", b"\x1b[O", b"\x1b[5;5R",
    b"\x1b[?1;2c", b"\x1b[?1u", b"\x1b[97;5u", b"\x1b[99999999999999999999~", b"\x1b[1;99999999A", b"\x1b]11;rgb:00\x07",
    b"\x1bP1$r\x1b\\", b"\x1b[200~", b"\x1b[201~", b"\x1b[200~5 mm\x1b[201~", b"\x1b\x1b[A", b"\xc3", b"\xa9", b"\xf0\x9f",
    b"\xff\xfe", b"\xc0\x80", b"\xf5\x80\x80\x80", b"\xed\xa0\x80", b"\x11", b"\x13", b"\x0f", b"\x15", b"\x1a", b"\x03", b"\r",
    b"\t", b"5 mm",
];

/// What an impatient user tries, key after key: to end a paste; to end a mouse report or an answer of the terminal, which
/// swallow every key up to their last letter; to close a prompt; to quit; to discard.
const WAYS_OUT: [&[u8]; 5] = [b"\x1b[201~", b"mu", b"\x1b", b"\x11", b"d"];

/// The program on a terminal of its own.
struct Session {
    master: Box<dyn MasterPty + Send>,
    writer: Box<dyn Write + Send>,
    output: Receiver<Vec<u8>>,
    written: Vec<u8>,
    child: Box<dyn Child + Send + Sync>,
    before: String,
    folder: TempDir,
}

#[test]
fn whatever_bytes_come_it_leaves_when_told_to_and_gives_the_terminal_back() {
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
fn reports_that_nobody_asked_for_are_survived() {
    for report in
        [&b"\x1b[M5\x1b["[..], b"\x1b[M   ", b"\x1b[<0;0;0M", b"\x1b[0;0R", b"\x1b[32;0;0M", b"\x1b[<", b"\x1b[?", b"\x1b[200~"]
    {
        survive(&[report.to_vec()], &[]);
    }
}

#[test]
fn floods_are_survived() {
    let keys = [&b"7"[..], b"\x1b[B", b"\x7f", b"\x1b[C", b"\t", b"m"].concat();
    let flood = keys.repeat(100_000 / 6);
    let paste = |end: &[u8]| [b"\x1b[200~", "5 mm\r\n歯".repeat(1 << 17).as_bytes(), end].concat();
    let broken = b"\xff\xc3\x28\xf0\x9f\x1b[\xe2\x82".repeat(5000);
    for bytes in [flood, paste(b"\x1b[201~"), paste(b""), broken, b"\x1b".repeat(20_000)] {
        survive(&[bytes], &[(10, 30), (0, 0), (24, 80)]);
    }
}

/// Without the keys that stop the program until its shell brings it back, without those that the terminal turns into
/// signals once its own modes are back while the program ends (Ctrl-C, Ctrl-\\), and without paths out of its folder.
fn harmless(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.retain(|byte| !b"\x03\x1c\x1azZ/".contains(byte));
    bytes
}

fn cut(bytes: &[u8], cuts: &[Index]) -> Vec<Vec<u8>> {
    let mut places: Vec<usize> = cuts.iter().map(|cut| cut.index(bytes.len() + 1)).chain([0, bytes.len()]).collect();
    places.sort_unstable();
    places.windows(2).map(|pair| bytes[pair[0]..pair[1]].to_vec()).collect()
}

fn survive(pieces: &[Vec<u8>], sizes: &[(u16, u16)]) {
    let mut session = Session::open();
    session.pour(pieces.to_vec(), sizes);
    let code = session.leave();
    let words = String::from_utf8_lossy(&session.written).into_owned();
    assert!(!words.contains("fault of the program"), "{words:?}");
    assert_eq!(code, 0, "{words:?}");
    session.assert_restored();
}

impl Session {
    fn open() -> Session {
        let folder = tempfile::tempdir().expect("a folder");
        let case = folder.path().join("case.toml");
        fs::write(&case, TABLE_1).expect("room on the disk");
        let pair = native_pty_system().openpty(PtySize { rows: 24, cols: 80, ..PtySize::default() }).expect("a pseudo terminal");
        let mut command = CommandBuilder::new(PROGRAM);
        command.arg(&case);
        command.cwd(folder.path());
        let variables =
            [("XDG_STATE_HOME", folder.path().to_str().expect("a name")), ("TERM", "xterm-256color"), ("LC_ALL", "C.UTF-8")];
        for (name, value) in variables {
            command.env(name, value);
        }
        let before = modes(&*pair.master);
        let mut reader = pair.master.try_clone_reader().expect("a reader");
        let writer = pair.master.take_writer().expect("a writer");
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
        let mut session = Session { master: pair.master, writer, output, written: Vec::new(), child, before, folder };
        session.wait_for("Corner");
        session
    }

    /// All the bytes, from a thread of their own since a terminal takes only so much at a time; new sizes meanwhile.
    fn pour(&mut self, pieces: Vec<Vec<u8>>, sizes: &[(u16, u16)]) {
        let mut writer = std::mem::replace(&mut self.writer, Box::new(std::io::sink()));
        let pouring = thread::spawn(move || {
            // A program that has left takes nothing more.
            pieces.iter().try_for_each(|piece| writer.write_all(piece).and_then(|()| writer.flush())).ok();
            writer
        });
        let mut sizes = sizes.iter();
        let end = Instant::now() + PATIENCE;
        while !pouring.is_finished() || sizes.len() > 0 {
            if let Some(&(rows, cols)) = sizes.next() {
                self.master.resize(PtySize { rows, cols, ..PtySize::default() }).expect("a new size");
            }
            self.take_output(Duration::from_millis(5));
            assert!(Instant::now() < end, "it takes no more keys");
        }
        self.writer = pouring.join().expect("all is poured");
    }

    /// Try every way out until the program has left; its exit code.
    fn leave(&mut self) -> u32 {
        let end = Instant::now() + PATIENCE;
        for keys in WAYS_OUT.into_iter().cycle() {
            while self.take_output(QUIET) {
                assert!(Instant::now() < end, "it never stops writing: {:?}", String::from_utf8_lossy(&self.written));
            }
            if let Some(status) = self.child.try_wait().expect("our own child") {
                // Until the terminal says that nobody is left to write.
                while let Ok(bytes) = self.output.recv_timeout(PATIENCE) {
                    self.written.extend(bytes);
                }
                return status.exit_code();
            }
            assert!(Instant::now() < end, "it does not leave: {:?}", String::from_utf8_lossy(&self.written));
            // It may leave at any time.
            self.writer.write_all(keys).and_then(|()| self.writer.flush()).ok();
        }
        unreachable!("the keys go round and round")
    }

    fn wait_for(&mut self, text: &str) {
        let end = Instant::now() + PATIENCE;
        while !String::from_utf8_lossy(&self.written).contains(text) {
            assert!(Instant::now() < end, "{text:?} is never shown");
            self.take_output(QUIET);
        }
    }

    /// Whether something came within the time.
    fn take_output(&mut self, time: Duration) -> bool {
        match self.output.recv_timeout(time) {
            Ok(bytes) => self.written.extend(bytes),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return false,
        }
        true
    }

    /// The terminal is as it was, and no process is left on it.
    fn assert_restored(&self) {
        assert_eq!(modes(&*self.master), self.before);
        let mut screen = vt100::Parser::default();
        screen.process(&self.written);
        let screen = screen.screen();
        assert!(!screen.alternate_screen() && !screen.hide_cursor() && !screen.bracketed_paste());
        let id = self.child.process_id().expect("the program had an id").to_string();
        let left = Command::new("ps").args(["-o", "pid=", "-s", &id]).output().expect("ps is there");
        assert_eq!(String::from_utf8_lossy(&left.stdout).trim(), "", "a process is left");
        let case = fs::read_to_string(self.folder.path().join("case.toml")).expect("the case is there");
        assert!(tipstrike::case::Document::parse("case.toml", &case).is_ok(), "what is saved opens again: {case}");
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // A test that failed leaves nothing behind.
        self.child.kill().ok();
    }
}

fn modes(master: &(dyn MasterPty + Send)) -> String {
    format!("{:?}", master.get_termios().expect("a terminal has modes"))
}
