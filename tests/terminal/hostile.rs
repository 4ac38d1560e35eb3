//! No byte of a file, a name or an error controls a terminal: on any screen of any size, and in the
//! output of any command.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};
use crate::tty::{Launch, PROGRAM};

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;
use std::process::Command;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use tempfile::TempDir;
use tipstrike::case::sanitize::is_hidden;
use tipstrike::case::{Change, Document};
use tipstrike::tui::testing::{Access, Action, Claim, Found, Look, Next, Offer, SaveFault, view};

/// Escape sequences, C1 controls, direction overrides, zero-width characters, line ends.
const HOSTILE: &str = "\u{1b}[2J\u{1b}]0;x\u{7}\u{9b}31m\u{90}q\u{9c}\u{202e}\u{2066}\u{200b}\u{feff}\u{7f}\r\n\t\u{8}x";
const ESCAPED: &str =
    r"\u001b[2J\u001b]0;x\u0007\u009b31m\u0090q\u009c\u202e\u2066\u200b\ufeff\u007f\r\n\t\bx";

fn hostile_case() -> String {
    let text = TABLE_1.replacen("title = \"", &format!("title = \"{ESCAPED}"), 1);
    assert!(text.contains("notes = \""));
    text.replacen("notes = \"", &format!("notes = \"{ESCAPED}"), 1)
}

/// A folder with valid and invalid cases, with names and contents full of control characters.
fn folder() -> (TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().expect("a folder");
    let good = hostile_case();
    let bad = [
        good.replacen("module = \"5 mm\"", &format!("module = \"5 {ESCAPED}\""), 1),
        good.replacen("method = \"exact\"", &format!("method = \"{ESCAPED}\""), 1),
        good.replacen("[pair]", &format!("[pair]\n\"{ESCAPED}\" = 1"), 1),
        good.replacen("[pair]", &format!("[\"{ESCAPED}\"]\n[pair]"), 1),
        good.replacen("[pair]", &format!("{HOSTILE}\n[pair]"), 1),
        good.replacen("module = \"5 mm\"", &format!("module = {HOSTILE}"), 1),
        good.replacen("format = 1", "format = 2", 1),
        format!("{good}\n[limits]\n\"{ESCAPED}\" = \"{ESCAPED}\"\n"),
        HOSTILE.to_owned(),
    ];
    let named = |(number, text): (usize, String)| {
        let name =
            [format!("{number}{}", HOSTILE.replace('/', "")).as_bytes(), b"\xff.toml"].concat();
        let path = folder.path().join(OsStr::from_bytes(&name));
        fs::write(&path, text).expect("room on the disk");
        path
    };
    let paths = std::iter::once(good.clone()).chain(bad).enumerate().map(named).collect();
    (folder, paths)
}

#[test]
fn no_command_prints_a_control_character() {
    let (folder, paths) = folder();
    let mut runs = 0;
    let others = [OsStr::new(HOSTILE), folder.path().as_os_str()];
    for path in paths.iter().map(|path| path.as_os_str()).chain(others) {
        for words in [
            &["solve"][..],
            &["solve", "--format", "csv"],
            &["solve", "--format", "json"],
            &["check"],
            &["solve", "--set", &format!("title={HOSTILE}")],
            &["solve", "--set", &format!("{HOSTILE}=1")],
            &["solve", "--only", HOSTILE],
            &["solve", "--method", HOSTILE],
            &["solve", "--format", HOSTILE],
            &[HOSTILE],
            &["new"],
            &["completions", HOSTILE],
            &["man", HOSTILE],
        ] {
            let mut command = Command::new(PROGRAM);
            // Some arguments are names of new files.
            command.args(words).arg(path).env("TERM", "xterm").current_dir(folder.path());
            let output = command.output().expect("it starts");
            for bytes in [&output.stdout, &output.stderr] {
                let text = std::str::from_utf8(bytes).expect("words in UTF-8");
                let raw = text.chars().find(|&letter| letter != '\n' && is_hidden(letter));
                assert_eq!(raw, None, "{words:?} {path:?}: {text:?}");
            }
            runs += 1;
        }
    }
    assert!(runs > 100);
}

/// The keys to every screen of the workbench.
#[rustfmt::skip]
const SCREENS: [&[&str]; 33] = [
    &[], &["F1"], &["F1", "PageDown"], &["Ctrl-P"], &["Ctrl-O"], &["F2"], &["Ctrl-Q"], &["Ctrl-C"], &["Esc", "/"],
    &["Esc", "2"], &["Esc", "3"], &["Esc", "4"], &["Esc", "5"], &["Esc", "2", "Enter"], &["Ctrl-N"], &["Ctrl-S"],
    &["Alt-R"], &["Alt-N"], &["Alt-G"], &["Alt-L"], &["Esc", "2", "n"], &["Esc", "2", "Enter", "Tab"], &["Alt-W"], &["Esc", "?"],
    &["Ctrl-P", "th"], &["Esc", "3", "l", "z"], &["Esc", "4", "Space"], &["Esc", "2", "G", "b"], &["Ctrl-N", "Ctrl-U", "Alt-1"],
    &["Ctrl-U", "5 kg"], &["Ctrl-U", "Ctrl-Q"], &["F5", "F8"], &["Ctrl-End", "F4", "F4", "Ctrl-T"],
];

fn on(text: &str, size: Size, look: Look) -> Desk {
    let mut desk = Desk::new(size);
    let path = desk.write(&HOSTILE.replace('/', ""), text);
    let document = Document::read(&path).expect("it opens");
    desk.app = tipstrike::tui::testing::opened(document, Some(path), look, size);
    desk
}

fn assert_harmless(buffer: &Buffer, what: &str) {
    for cell in &buffer.content {
        assert!(!cell.symbol().chars().any(is_hidden), "{what}: {:?}", cell.symbol());
    }
}

#[test]
fn no_screen_shows_a_control() {
    let (_folder, paths) = folder();
    for (keys, size) in SCREENS.iter().flat_map(|keys| [SMALL, LARGE].map(|size| (keys, size))) {
        let mut desk = on(&hostile_case(), size, Look::FULL);
        for name in [HOSTILE, "b\u{202e}.toml"] {
            desk.write(&name.replace('/', ""), TABLE_1);
        }
        desk.recents = paths.clone();
        desk.fill("title", HOSTILE).act(Action::Paste(HOSTILE.to_owned()));
        desk.keys(keys);
        desk.act(Action::Paste(HOSTILE.to_owned()));
        assert_harmless(&desk.buffer(), &format!("{keys:?}"));
        for path in &paths {
            let faults = vec![format!("{HOSTILE}: {}", path.display())];
            desk.act(Action::Loaded(path.clone(), Err(faults)));
            assert_harmless(&desk.buffer(), &format!("{keys:?} {path:?}"));
            desk.keys(&["Esc"]);
        }
        for action in foreign_texts() {
            let what = format!("{keys:?} {action:?}");
            desk.act(action);
            assert_harmless(&desk.buffer(), &what);
        }
    }
}

/// Messages with foreign texts: file names, locks, journals.
fn foreign_texts() -> Vec<Action> {
    let words = || HOSTILE.to_owned();
    let saved = |fault| Action::Saved(HOSTILE.into(), Next::Stay, Err(fault));
    let change = Change { key: "title".to_owned(), from: Some(words()), to: Some(words()) };
    let offer = Offer {
        journal: HOSTILE.into(),
        age: words(),
        changes: vec![change],
        is_file_changed: true,
    };
    let found = || Found { lines: vec![words()], stamp: None };
    let claim =
        Claim { id: 0, access: Access::Held(words()), offers: vec![offer], notices: vec![words()] };
    vec![
        Action::Failed(words()),
        saved(SaveFault::Exists(found())),
        saved(SaveFault::Changed(found())),
        saved(SaveFault::Held(words())),
        saved(SaveFault::Failed(words())),
        Action::Claimed(Box::new(claim)),
    ]
}

#[test]
fn every_size_is_drawn_on_every_screen() {
    for keys in SCREENS {
        let mut desk = on(TABLE_1, SMALL, Look::FULL);
        desk.keys(keys);
        let widths = (0..=90u16).step_by(13).chain([60, 80, 140, 200]);
        let heights = || (0..=30u16).step_by(5).chain([16, 17, 24, 60, 80]);
        for (width, height) in widths.flat_map(|width| heights().map(move |height| (width, height)))
        {
            let size = Size { width, height };
            desk.act(Action::Resize(size));
            desk.app.look.ascii = !desk.app.look.ascii;
            let area = Rect::new(0, 0, width, height);
            let mut buffer = Buffer::empty(area);
            let cursor = view::draw(&desk.app, &mut buffer);
            assert!(cursor.is_none_or(|cursor| area.contains(cursor)), "{keys:?} {size:?}");
        }
        desk.act(Action::Resize(SMALL));
        assert_harmless(&desk.buffer(), "back at its size");
    }
}

#[test]
fn only_text_and_screen_sequences_reach_a_terminal() {
    let (_folder, paths) = folder();
    for path in &paths {
        let launch = Launch::of(tempfile::tempdir().expect("a folder").into()).argument(path);
        let mut tty = launch.start();
        tty.written = Some(Vec::new());
        tty.wait_for("tipstrike");
        for key in ["\x0f", "\x1b"] {
            tty.type_in(key);
            tty.settle(std::time::Duration::from_millis(100));
        }
        tty.type_in("\x11");
        tty.wait_for_end();
        let written = tty.written.clone().unwrap_or_default();
        assert_eq!(not_of_a_screen(&written), None, "{path:?}");
    }
}

/// The first position that is not text, a line end, or CSI with plain parameters and one of our
/// final letters.
fn not_of_a_screen(bytes: &[u8]) -> Option<String> {
    let text = std::str::from_utf8(bytes).ok()?;
    let mut rest = text;
    while let Some(letter) = rest.chars().next() {
        let length = match letter {
            '\u{1b}' => sequence(rest),
            '\n' | '\r' => Some(1),
            letter if is_hidden(letter) => None,
            letter => Some(letter.len_utf8()),
        };
        match length {
            Some(length) => rest = &rest[length..],
            None => return Some(rest.chars().take(20).collect()),
        }
    }
    None
}

fn sequence(text: &str) -> Option<usize> {
    let inner = text.strip_prefix("\u{1b}[")?;
    let end = inner.find(|letter: char| !letter.is_ascii_digit() && !";?:".contains(letter))?;
    let last = inner[end..].chars().next()?;
    "HmJKhlABCDr".contains(last).then_some(2 + end + 1)
}
