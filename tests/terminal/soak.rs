//! A long session of random actions on a real terminal: no fault, constant memory, every file valid
//! at every moment, and the form equal to the file after a save.
use crate::tty;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use ratatui::layout::Size;
use tipstrike::case::Document;
use tipstrike::tui::testing::actions::Effect;
use tipstrike::tui::testing::rows;
use tipstrike::tui::testing::session::Journal;
use tipstrike::tui::testing::theme::Look;
use tipstrike::tui::testing::update::{opened, update};
use tty::{Launch, TABLE_1, Tty, journals};

/// Default number of actions; `TIPSTRIKE_SOAK` sets another one.
const FEW: usize = 1000;
/// Accepted growth: caches and histories fill once.
const MOST_GROWTH: u64 = 6 << 10;
const QUIET: Duration = Duration::from_millis(60);
/// Number of actions between two checks of the files, and between two comparisons of form and file.
const LOOK: usize = 100;
const COMPARE: usize = 500;
/// File extensions for `:export`.
const EXPORTS: [&str; 5] = [".html", ".md", ".csv", ".json", ".svg"];
/// Values that fix one field or another after random actions.
const FIXES: [&[u8]; 10] = [
    b"",
    b"5 mm",
    b"20 deg",
    b"22",
    b"0.25",
    b"200 GPa",
    b"7800 kg/m3",
    b"15 kW",
    b"2000 rpm",
    b"exact",
];
const MOST_FIXES: usize = 60;

/// The actions of a session. None leaves the folder, and the session refuses each question to quit.
#[rustfmt::skip]
const ACTIONS: [&[u8]; 77] = [
    // Edits.
    b"\x151.25 in", b"\x155 mm", b"\x1522", b"\x150.1", b"\x15no number", b"7", b"\x7f", b"\x1b[3~", b"\x17", b" ", b"+", b"-",
    b"\x1b[1;2A", b"\x1b[1;2B", b"\x1b[200~ 5 mm\x1b[201~", b"\x15\x1b[200~a\x07b\r\nc\x1b[201~", b"\x0b", b"\x01",
    // Navigation in form and results.
    b"\t", b"\x1b[Z", b"\x1b[A", b"\x1b[B", b"\x1b[C", b"\x1b[D", b"\x1b[5~", b"\x1b[6~", b"\x1b[1;5H", b"\x1b[1;5F", b"j", b"k",
    b"/", b"\r", b"\x1bOS",
    // Undo, redo, save, save elsewhere, methods.
    b"\x1a", b"\x1a\x1a", b"\x19", b"\x12", b"\x13", b"\x13", b"\x1bOQ\r", b"\x14",
    // Cases and tabs.
    b"\x0f", b"\x0fother\r", b"\x0fcase\r", b"\x0fcase\r", b"other\r", b"\x0e", b"\x1bw", b"\x1b1", b"\x1b2", b"\x1b[5;5~",
    b"\x1b[6;5~", b"\x1br", b"\x1bwd", b"\x1bwd",
    // Panes, cursor, teeth.
    b"1", b"2", b"3", b"4", b"\x1b[15~", b"\x1b[20~", b"b", b"y", b"v", b"x",
    // Help, palette, settings, redrawing.
    b"\x1bOP", b"\x10", b"\x10units\r", b"\x10ascii\r", b"\x10theme\r", b"\x10mouse\r", b"\x1bm", b"\x0c",
    // Back.
    b"\x1b", b"\x1b", b"\x1b\x1b", b"\x1b[<0;20;8M",
];

struct Soak {
    tty: Tty,
    random: u64,
    looks: usize,
    comparisons: usize,
    suspensions: usize,
    values: usize,
    saves: usize,
    /// The number of open cases at the last comparison, and the greatest number.
    tabs: usize,
    most_tabs: usize,
}

impl Soak {
    /// A separate random generator, so that every session is the same.
    fn next(&mut self, below: usize) -> usize {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        usize::try_from(self.random >> 33).unwrap_or(0) % below
    }

    fn step(&mut self) {
        match self.next(120) {
            0..3 => {
                let (rows, columns) = (self.next(60), self.next(200));
                self.tty.resize(rows as u16, columns as u16);
            }
            3 => self.tty.resize(24, 80),
            4 => self.cancel(),
            5 if self.next(2) == 0 => self.suspend(),
            _ => {
                let keys = ACTIONS[self.next(ACTIONS.len())];
                self.saves += usize::from(keys == b"\x13");
                self.tty.type_in(keys);
            }
        }
        self.tty.take_output(Duration::from_millis(1));
        // The palette also lists the command that suspends.
        self.tty.wake();
    }

    /// Ctrl-C or Ctrl-\, and no to the question.
    fn cancel(&mut self) {
        let key: &[u8] = if self.next(2) == 0 { b"\x03" } else { b"\x1c" };
        // In a suspended workbench such a key would end the process.
        self.be_there();
        self.press(key);
        self.press(b"\x1b");
    }

    fn be_there(&mut self) {
        self.tty.settle(QUIET);
        let is_back = |tty: &mut Tty| {
            tty.wake();
            tty.screen().alternate_screen()
        };
        self.tty.wait_until("the workbench to resume", is_back);
    }

    /// Presses a key and waits for its effects.
    fn press(&mut self, key: &[u8]) {
        self.tty.type_in(key);
        self.tty.settle(QUIET);
    }

    fn suspend(&mut self) {
        self.tty.send_signal("TSTP");
        self.tty.wait_until("it to stop", |tty| tty.state() == Some('T'));
        // Every edit must be in a journal, because the suspension may last long.
        for path in journals(self.tty.folder.path()) {
            let text = fs::read_to_string(&path).expect("it is there");
            assert!(Journal::from_text(&text).is_some(), "{text}");
        }
        self.tty.send_signal("CONT");
        self.be_there();
        self.suspensions += 1;
    }

    fn look(&mut self, step: usize) -> u64 {
        self.tty.settle(QUIET);
        assert!(!self.tty.has_ended(), "it ended at {step}:\n{}", self.tty.screen().contents());
        for path in files(self.tty.folder.path()) {
            let text = fs::read_to_string(&path).expect("it is there");
            assert!(
                Document::parse_draft("case", &text).is_ok(),
                "{} at {step}: {text}",
                path.display()
            );
            self.looks += 1;
        }
        self.tty.resident()
    }

    /// Saves the form, copies every value of it to the clipboard, and compares these with the
    /// values of the file.
    fn compare(&mut self) {
        self.tty.resize(24, 80);
        let Some(path) = self.saved() else {
            println!("not compared:\n{}", self.tty.screen().contents());
            return;
        };
        let form: Vec<_> = self.values_of_form();
        let file = values_of_file(&path);
        assert_eq!(
            form,
            file,
            "form and file of {}:\n{}",
            path.display(),
            self.tty.screen().contents()
        );
        self.comparisons += 1;
        self.values += form.len();
        // An edit, and no to the question whether to discard it.
        self.press(b"\x1b[1;5Hi");
        self.press(b"x\x11");
        assert!(!self.tty.has_ended(), "it quits with an unsaved edit");
        self.press(b"\x1b");
        self.press(b"\x1a");
        self.tabs = self.count_tabs();
        self.most_tabs = self.most_tabs.max(self.tabs);
    }

    /// The number of open cases: the tab before the first one is the last one.
    fn count_tabs(&mut self) -> usize {
        self.press(b"\x1b1\x1b[5;5~");
        let screen = self.tty.screen().contents();
        let current = screen
            .lines()
            .next()
            .and_then(|head| head.split_once('[')?.1.split(' ').next()?.parse().ok());
        current.unwrap_or(1)
    }

    /// Saves, and fixes invalid fields first. Returns the file, if the form has one.
    fn saved(&mut self) -> Option<PathBuf> {
        for keys in [b"\x1b", b"\x1b", b"\x1b", b"1", b"i", b"\x13"] {
            self.press(keys);
        }
        for fix in FIXES.iter().cycle().take(MOST_FIXES) {
            let (name, is_unsaved) = self.case()?;
            if name.starts_with("built-in") || name.starts_with("new case") {
                // Neither case has a file.
                for keys in
                    [&b"\x1b"[..], b"\x1b", b"\x1b", b"\x0f", b"\x15case.toml", b"\r", b"\x13"]
                {
                    self.press(keys);
                }
            } else if self.tty.shows("Reload") {
                // Another tab has the same file after a save under another name.
                self.press(b"o");
            } else if is_unsaved {
                // The first invalid field has the focus.
                self.press(b"\x1b");
                self.press(&[b"1i\x15", *fix, b"\x13"].concat());
            } else {
                // Names may end in invisible characters.
                let is_it = |path: &PathBuf| {
                    path.file_name().is_some_and(|own| own.to_string_lossy().trim() == name)
                };
                return files(self.tty.folder.path()).into_iter().find(is_it);
            }
        }
        None
    }

    /// The file of the visible case, and whether it has the mark of unsaved edits.
    fn case(&self) -> Option<(String, bool)> {
        let screen = self.tty.screen().contents();
        let head = screen.lines().next()?;
        let own = head
            .split_once('[')
            .and_then(|(_, rest)| Some(rest.split_once(']')?.0.split_once(' ')?.1));
        let (name, is_unsaved) = match own {
            Some(own) => (own.trim_end_matches('*'), own.ends_with('*')),
            None => (
                head.strip_prefix("tipstrike")?.trim_start().split("  ").next()?,
                head.contains("*unsaved*"),
            ),
        };
        let name = name.trim_end_matches("*unsaved*").trim();
        Some((name.rsplit_once('/').map_or(name, |(_, name)| name).to_owned(), is_unsaved))
    }

    /// Every value of the form, copied through the clipboard.
    fn values_of_form(&mut self) -> Vec<String> {
        self.press(b"\x1b");
        self.press(b"\x1b[1;5H");
        self.tty.written = Some(Vec::new());
        let count = 2 * rows::count(&tipstrike::case::Case::table_1());
        self.tty.type_in(b"yj".repeat(count));
        self.tty.settle(QUIET);
        let written = self.tty.written.take().unwrap_or_default();
        let text = String::from_utf8_lossy(&written);
        // The last line is copied repeatedly: there is no line after it.
        let mut values: Vec<_> = text
            .split("\x1b]52;c;")
            .skip(1)
            .map(|rest| decoded(rest.split(['\x1b', '\x07']).next()))
            .collect();
        let last = values.last().cloned();
        while values.len() > 1 && values.get(values.len() - 2) == last.as_ref() {
            values.pop();
        }
        values
    }
}

/// The case files in the folder, with any names; exported pages are not included.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let is_case = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_export = EXPORTS.iter().any(|ending| name.ends_with(ending));
        path.is_file() && !name.starts_with('.') && !is_export
    };
    let mut paths: Vec<_> = entries.map(|entry| entry.path()).filter(is_case).collect();
    paths.sort();
    paths
}

/// The clipboard text of each line of the form for a file.
fn values_of_file(path: &Path) -> Vec<String> {
    // A new case may be saved before its required fields have values.
    let text = fs::read_to_string(path).expect("it is there");
    let document =
        Document::parse_draft("case", &text).unwrap_or_else(|faults| panic!("{faults:?}"));
    let mut app = opened(document, Some(path.to_owned()), Look::FULL, Size::new(80, 24));
    let lines = 0..rows::count(&app.tab.case);
    let copied = lines.filter_map(|line| {
        app.tab.form.focus = line;
        let effects = update(&mut app, crate::harness::run("copy value"));
        effects
            .into_iter()
            .find_map(|effect| if let Effect::Copy(text) = effect { Some(text) } else { None })
    });
    copied.collect()
}

/// Decodes Base64 as terminals do.
fn decoded(text: Option<&str>) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bits, mut count, mut bytes) = (0_u32, 0, Vec::new());
    for letter in text.unwrap_or_default().bytes() {
        let Some(value) = LETTERS.iter().position(|&known| known == letter) else { continue };
        (bits, count) = ((bits << 6 | value as u32) & 0xffff, count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    String::from_utf8(bytes).expect("words in UTF-8")
}

#[test]
fn a_long_session_loses_nothing_and_does_not_grow() {
    let count =
        std::env::var("TIPSTRIKE_SOAK").ok().and_then(|count| count.parse().ok()).unwrap_or(FEW);
    // Memory that a thread frees remains in its glibc arena: with one arena the test measures what
    // the program itself keeps.
    let launch = Launch::on_table_1().variable("MALLOC_ARENA_MAX", "1");
    fs::write(launch.folder.path().join("other.toml"), TABLE_1).expect("room on the disk");
    let mut tty = launch.start();
    tty.wait_for("quit");
    let random = 0x9e37_79b9_7f4a_7c15;
    let mut soak = Soak {
        tty,
        random,
        looks: 0,
        comparisons: 0,
        suspensions: 0,
        values: 0,
        saves: 0,
        tabs: 1,
        most_tabs: 1,
    };
    let (begun, start) = (Instant::now(), soak.tty.resident());
    let (mut early, mut most, mut end) = (0, 0, start);
    for step in 1..=count {
        soak.step();
        if step % LOOK == 0 {
            end = soak.look(step);
            most = most.max(end);
            if step <= count / 4 {
                early = most;
            }
            if step % (count / 4).max(LOOK) == 0 {
                println!(
                    "{step}: {end} KiB, {} cases open, {:.0} s",
                    soak.tabs,
                    begun.elapsed().as_secs_f64()
                );
            }
        }
        if step % COMPARE == 0 {
            soak.compare();
        }
    }
    let Soak { looks, comparisons, suspensions, values, saves, most_tabs, .. } = soak;
    let rate = count as f64 / begun.elapsed().as_secs_f64();
    println!(
        "{count} actions, {rate:.0}/s: {start} KiB at first, {early} in the first quarter, {most} \
            at most, {end} at the end"
    );
    println!(
        "{looks} files parsed, {saves} saves asked for, {suspensions} suspensions, {most_tabs} \
            cases open at most"
    );
    println!("{comparisons} comparisons of form and file, {values} values");
    assert!(comparisons * COMPARE * 2 >= count, "too few comparisons: {comparisons}");
    assert!(most <= early + MOST_GROWTH && most <= 30 << 10, "{early} KiB, then {most} KiB");
}
