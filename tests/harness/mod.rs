//! A workbench without a terminal: keys in, screen out, files in a temporary folder.

#![allow(dead_code, reason = "each test file uses its own part")]

use std::cell::RefCell;
use std::collections::VecDeque;
use std::fmt::Debug;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;
use tempfile::TempDir;
use tipstrike::case::Document;
use tipstrike::study::trade::Time;
use tipstrike::tui::testing::commands::named as command;
use tipstrike::tui::testing::store::recents;
use tipstrike::tui::testing::{
    Action, Answer, App, Autosave, Effect, JournalWriter, Look, MONO, Prompt, Settings, Slot,
    State, Work, effects, of_key, opened, solver, store, update, view,
};

pub(crate) const SMALL: Size = Size { width: 80, height: 24 };
pub(crate) const LARGE: Size = Size { width: 140, height: 45 };
pub(crate) const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");

#[expect(clippy::struct_excessive_bools, reason = "each flag records a requested effect")]
pub(crate) struct Desk {
    pub(crate) app: App,
    /// Saves, locks and journals as in the program.
    pub(crate) autosave: Autosave,
    state: TempDir,
    pub(crate) folder: TempDir,
    pub(crate) has_quit: bool,
    pub(crate) has_cancelled: bool,
    pub(crate) has_mouse: bool,
    pub(crate) ticks: bool,
    pub(crate) has_redrawn: bool,
    pub(crate) is_suspended: bool,
    pub(crate) copied: Option<String>,
    pub(crate) kept: Option<Settings>,
    pub(crate) recents: Vec<PathBuf>,
    /// Whether the focus only passes a field, whose study is not needed.
    is_passing: bool,
}

impl Desk {
    /// A workbench on the built-in case, which is solved once per size.
    pub(crate) fn new(size: Size) -> Desk {
        static SOLVED: Mutex<Vec<App>> = Mutex::new(Vec::new());
        let mut solved = SOLVED.lock().unwrap_or_else(PoisonError::into_inner);
        let known = solved.iter().find(|app| app.layout.size == size).cloned();
        let app = known.unwrap_or_else(|| {
            let app = opened(store::built_in(), None, Look::FULL, size);
            solved.push(app.clone());
            app
        });
        Desk::with(app)
    }

    /// A workbench with a state, in an empty folder.
    pub(crate) fn with(app: App) -> Desk {
        Desk::in_folder(app, tempfile::tempdir().expect("a folder"))
    }

    fn in_folder(mut app: App, folder: TempDir) -> Desk {
        // Each setting of a benchmark runs once.
        app.patience = Duration::ZERO;
        let state = tempfile::tempdir().expect("a folder");
        Desk {
            app,
            autosave: autosave(state.path()),
            state,
            folder,
            has_quit: false,
            has_cancelled: false,
            has_mouse: false,
            ticks: false,
            has_redrawn: false,
            is_suspended: false,
            copied: None,
            kept: None,
            recents: Vec::new(),
            is_passing: false,
        }
    }

    /// A workbench on a file with a text.
    pub(crate) fn on(size: Size, name: &str, text: &str) -> Desk {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join(name), text).expect("room on the disk");
        Desk::of_file(size, folder, name)
    }

    /// A workbench on an existing file of the folder.
    pub(crate) fn at(folder: TempDir, name: &str) -> Desk {
        Desk::of_file(SMALL, folder, name)
    }

    fn of_file(size: Size, folder: TempDir, name: &str) -> Desk {
        let path = folder.path().join(name);
        let document = Document::read(&path).expect("a good case");
        let app = opened(document, Some(path), Look::FULL, size);
        Desk::in_folder(app, folder)
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).expect("room on the disk");
        path
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("the file is there")
    }

    /// Presses keys by their names: `Ctrl-S`, `Alt-S`, `F1`, `Down`; anything else is typed letter
    /// by letter.
    pub(crate) fn keys(&mut self, keys: &[&str]) -> &mut Desk {
        for key in keys {
            match named(key) {
                Some(event) => self.press(event),
                None => self.type_in(key),
            }
        }
        self
    }

    pub(crate) fn type_in(&mut self, text: &str) {
        for letter in text.chars() {
            self.press(KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE));
        }
    }

    pub(crate) fn press(&mut self, event: KeyEvent) {
        if let Some(action) = of_key(event, self.app.place()) {
            self.act(action);
        }
    }

    /// The effects of a key, which are not carried out.
    pub(crate) fn effects(&mut self, key: &str) -> Vec<Effect> {
        let letter = || KeyCode::Char(key.chars().next().expect("a key")).into();
        let event = named(key).unwrap_or_else(letter);
        let action = of_key(event, self.app.place()).expect("an action");
        update(&mut self.app, action)
    }

    /// Runs the command with a name.
    pub(crate) fn run(&mut self, name: &str) {
        self.act(run(name));
    }

    /// Plays to the end in 40 to 60 frames; returns the last cursor.
    pub(crate) fn played(&mut self, keys: &[&str]) -> f64 {
        self.keys(keys);
        assert!(self.ticks);
        let frames = (0..200).take_while(|_| {
            self.act(Action::Tick);
            self.ticks
        });
        assert!((40..60).contains(&frames.count()) && !self.app.is_playing);
        self.app.cursor.expect("a cursor")
    }

    /// Applies the results of work.
    pub(crate) fn take(&mut self, results: Vec<Action>) {
        for action in results {
            self.act(action);
        }
    }

    /// The answer to the last request of the current case.
    pub(crate) fn whole_answer(&self) -> Answer {
        solver::answer(&self.app.tab.request())
    }

    /// Shows an answer of the solver.
    pub(crate) fn show(&mut self, answer: Answer) {
        self.app.take(answer);
        self.act(Action::Tick);
    }

    /// Applies an action and carries out its effects immediately.
    pub(crate) fn act(&mut self, action: Action) {
        let mut actions = VecDeque::from([action]);
        while let Some(action) = actions.pop_front() {
            for effect in update(&mut self.app, action) {
                match effect {
                    // Only the last answer of a solve.
                    Effect::Work(number, work) if work.slot == Slot::Solve => {
                        let all = results(number, work);
                        let before = all.len().saturating_sub(2);
                        actions.extend(all.into_iter().skip(before));
                    }
                    Effect::Work(_, work) if work.slot == Slot::Recents => {
                        show_recents(&mut self.app, &self.recents);
                    }
                    Effect::Work(_, work) if self.is_passing && work.slot == Slot::Study => (),
                    Effect::Work(number, work) => actions.extend(results(number, work)),
                    Effect::Quit => self.has_quit = true,
                    Effect::Copy(text) => self.copied = Some(text),
                    Effect::Mouse(takes) => self.has_mouse = takes,
                    Effect::Play(plays) => self.ticks = plays,
                    Effect::Cancel(_) => self.has_cancelled = true,
                    Effect::Redraw => self.has_redrawn = true,
                    Effect::Suspend => self.is_suspended = true,
                    Effect::Keep(settings) => self.kept = Some(settings),
                    Effect::Remember(_) => (),
                    other => actions.extend(effects::perform(other, &mut self.autosave)),
                }
            }
        }
        for claim in self.autosave.follow(&self.app.sheets(), Instant::now()) {
            update(&mut self.app, effects::claimed(claim));
        }
    }

    /// Carries out an effect as the program does.
    pub(crate) fn perform(&mut self, effect: Effect) {
        let action = effects::perform(effect, &mut self.autosave);
        self.act(action.expect("a result"));
    }

    /// Goes to a field by its key.
    pub(crate) fn go_to(&mut self, key: &str) -> &mut Desk {
        let field = tipstrike::case::fields::index_of(key).expect("a field of that key");
        for at in 0..=field {
            self.is_passing = at < field;
            self.keys(&[if at == 0 { "Ctrl-Home" } else { "Down" }]);
        }
        assert_eq!(self.app.tab.form.focus, field);
        self
    }

    /// Replaces the text of a field.
    pub(crate) fn fill(&mut self, key: &str, text: &str) -> &mut Desk {
        self.go_to(key);
        if !self.app.has_line() {
            self.keys(&["Enter"]);
        }
        self.keys(&["Ctrl-U", text])
    }

    /// The text of a field of the case; empty without a value.
    pub(crate) fn text(&self, key: &str) -> &str {
        let field = tipstrike::case::fields::index_of(key).expect("a field of that key");
        self.app.tab.case.text(field).unwrap_or_default()
    }

    /// The screen as text, with `DIR` for the folder of the test, without trailing blanks.
    pub(crate) fn screen(&self) -> String {
        let folder = self.folder.path().display().to_string();
        let rows = self.rows().into_iter();
        let lines = rows.map(|row| row.replace(&folder, "DIR").trim_end().to_owned());
        lines.collect::<Vec<_>>().join("\n")
    }

    pub(crate) fn shows(&self, text: &str) -> bool {
        self.rows().join("\n").contains(text)
    }

    /// Checks a condition; a failure prints the screen.
    #[track_caller]
    pub(crate) fn assert(&self, holds: bool) {
        assert!(holds, "{}", self.screen());
    }

    /// Checks a condition at a step of a test.
    #[track_caller]
    pub(crate) fn assert_at(&self, step: impl Debug, holds: bool) {
        assert!(holds, "{step:?}\n{}", self.screen());
    }

    /// The first line of the screen with a text; empty without one.
    pub(crate) fn line_with(&self, text: &str) -> String {
        self.screen().lines().find(|line| line.contains(text)).unwrap_or_default().to_owned()
    }

    #[track_caller]
    pub(crate) fn assert_shows(&self, text: &str) -> &Desk {
        self.has(&[text])
    }

    /// Checks that the screen has every text.
    #[track_caller]
    pub(crate) fn has(&self, texts: &[&str]) -> &Desk {
        for text in texts {
            self.assert_at(text, self.shows(text));
        }
        self
    }

    /// Checks that the screen has none of the texts.
    #[track_caller]
    pub(crate) fn lacks(&self, texts: &[&str]) -> &Desk {
        for text in texts {
            self.assert_at(text, !self.shows(text));
        }
        self
    }

    fn rows(&self) -> Vec<String> {
        let buffer = self.buffer();
        let rows = buffer.content.chunks(usize::from(buffer.area.width.max(1)));
        rows.map(|row| row.iter().map(Cell::symbol).collect()).collect()
    }

    /// The screen with its styles.
    pub(crate) fn buffer(&self) -> Buffer {
        let mut buffer = Buffer::empty(self.app.layout.size.into());
        view::draw(&self.app, &mut buffer);
        buffer
    }
}

/// A terminal without Unicode sees only ASCII, in the same places.
pub(crate) fn assert_ascii(desk: &mut Desk) {
    let look = std::mem::replace(&mut desk.app.look, Look { theme: &MONO, ascii: true });
    let screen = desk.screen();
    assert!(screen.is_ascii(), "{screen}");
    desk.app.look = look;
}

/// Sets the same times on every machine: each setting takes a tenth longer than the previous one.
pub(crate) fn time_evenly(desk: &mut Desk) {
    let traded = desk.app.tab.traded.as_mut().expect("a measurement");
    let trade = traded.trade.as_mut().expect("it is whole");
    for (number, one) in trade.settings.iter_mut().enumerate() {
        let seconds = 4e-6 * 1.1f64.powi(i32::try_from(number).expect("few settings"));
        let figures = one.found.as_mut().expect("every method answers");
        figures.time = Time { seconds, ..figures.time };
    }
    traded.marked = trade.recommended().map(|measured| measured.setting);
}

/// Shows recent cases in the open browser.
pub(crate) fn show_recents(app: &mut App, paths: &[PathBuf]) {
    if let Some(Prompt::Browse(browser)) = app.prompts.last_mut() {
        browser.remember(recents::looked_at(paths.to_vec()));
    }
}

pub(crate) fn run(name: &str) -> Action {
    Action::Do(command(name).next().expect("a command of that name"), 1)
}

/// All results of work, which runs at once.
pub(crate) fn results(number: u64, work: Work) -> Vec<Action> {
    let sent = RefCell::new(Vec::new());
    work.run(number, &|| true, &|action| sent.borrow_mut().push(action));
    sent.into_inner()
}

pub(crate) fn requested(effects: Vec<Effect>, slot: Slot) -> Option<(u64, Work)> {
    effects.into_iter().find_map(|effect| match effect {
        Effect::Work(number, work) if work.slot == slot => Some((number, work)),
        _ => None,
    })
}

/// An autosave with its state in a folder, and without a writer thread.
pub(crate) fn autosave(folder: &Path) -> Autosave {
    let state = State { folder: Some(folder.to_owned()), ..State::default() };
    Autosave::new(state, Arc::new(JournalWriter::default()))
}

/// The name of a case file.
pub(crate) fn name(path: &Path) -> &str {
    path.to_str().expect("a name in UTF-8")
}

/// The press of a key by its name, or of a letter.
pub(crate) fn event(key: &str) -> KeyEvent {
    let letter =
        || KeyEvent::new(KeyCode::Char(key.chars().next().expect("a key")), KeyModifiers::NONE);
    named(key).unwrap_or_else(letter)
}

/// The screen, with lines cut at the name of the test folder, whose length varies.
pub(crate) fn without_folder(desk: &Desk) -> String {
    let lines = desk.screen();
    let kept = lines.lines().map(|line| match line.find("DIR") {
        Some(at) => format!("{}.", &line[..at + 3]),
        None => line.to_owned(),
    });
    kept.collect::<Vec<_>>().join("\n")
}

pub(crate) fn named(key: &str) -> Option<KeyEvent> {
    use KeyCode::{
        BackTab, Backspace, Delete, Down, End, Enter, Esc, Home, Left, PageDown, PageUp, Right,
        Tab, Up,
    };
    let (modifiers, name) = match key.split_once('-') {
        Some(("Ctrl", name)) => (KeyModifiers::CONTROL, name),
        Some(("Alt", name)) => (KeyModifiers::ALT, name),
        Some(("Shift", name)) => (KeyModifiers::SHIFT, name),
        _ => (KeyModifiers::NONE, key),
    };
    let all = [
        Up, Down, Left, Right, Home, End, PageUp, PageDown, Tab, BackTab, Enter, Esc, Backspace,
        Delete,
    ];
    let code = match all.into_iter().find(|code| format!("{code:?}") == name) {
        Some(code) => code,
        None if name == "Space" => KeyCode::Char(' '),
        None if modifiers != KeyModifiers::NONE => {
            KeyCode::Char(name.chars().next()?.to_ascii_lowercase())
        }
        None => KeyCode::F(name.strip_prefix('F')?.parse().ok()?),
    };
    Some(KeyEvent::new(code, modifiers))
}
