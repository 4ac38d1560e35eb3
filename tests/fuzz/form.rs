//! Keys, pastes and sizes in the workbench without a terminal: the state stays valid, the screen
//! safe, and no edit is lost.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use crossterm::event::{Event as Input, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use proptest::prelude::*;
use proptest::sample::select;
use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use tempfile::TempDir;
use tipstrike::case::fields::Kind;
use tipstrike::case::{Case, Document};
use tipstrike::model::Stage;
use tipstrike::model::inputs::Method;
use tipstrike::tui::testing::store::recents;
use tipstrike::tui::testing::{
    Action, App, Autosave, Effect, Event, JournalWriter, Look, Prompt, Request, Slot, State, Work,
    effects, opened, rows, solver, store, take_action, update, view,
};

use crate::values::{HOSTILE, field_and_text};
use crate::{hold_from, is_hostile, texts};

/// An event for the workbench.
#[derive(Debug, Clone)]
enum Happening {
    /// A key and its number of presses.
    Key(KeyEvent, usize),
    /// Letters typed one after the other.
    Type(String),
    Paste(String),
    /// A new size of the terminal.
    Resize(u16, u16),
    /// Typing a text into a field after clearing it, possibly incompletely.
    Fill(usize, String),
    /// Opening another case by this name, or the first of the list.
    Open(String),
    /// Another program writes the file, and then the workbench saves.
    Meddle(String),
}

/// A workbench in a temporary folder, and the expected state.
struct Bench {
    app: App,
    autosave: Autosave,
    folder: TempDir,
    _state: TempDir,
    /// The request that the worker has not answered.
    waiting: Option<Request>,
    /// The cases that a full undo may restore: every opened case.
    opened: Vec<Case>,
    /// The contents of files that the workbench has read or written.
    on_disk: Vec<Case>,
    /// The kinds of events so far.
    seen: BTreeSet<&'static str>,
    /// The number of events so far.
    taken: usize,
}

#[test]
fn any_typing_leaves_the_form_valid_and_the_screen_safe() {
    let draft = Document::new(Case::fresh()).render();
    let text = prop_oneof![texts::written(), texts::mutated(), Just(draft), Just(String::new())];
    let seen = RefCell::new(BTreeSet::new());
    let prompts = ["browse", "path", "ask", "page", "pick"];
    let ends = ["loaded", "not loaded", "saved", "not saved", "quit", "invalid", "refused"];
    let all: BTreeSet<_> = prompts.into_iter().chain(ends).collect();
    let events = (text, any::<bool>(), happenings());
    // More cases until the keys have got to all that the workbench does.
    for seed in (1..=3).take_while(|&seed| seed == 1 || *seen.borrow() != all) {
        hold_from(seed, 120, &events, |(text, ascii, happenings)| {
            let mut bench = Bench::on(&text, ascii);
            bench.assert_sound();
            for happening in happenings {
                bench.take(happening);
            }
            bench.assert_undone();
            seen.borrow_mut().append(&mut bench.seen);
        });
    }
    assert_eq!(*seen.borrow(), all, "the keys get too seldom to all that the workbench does");
}

fn happenings() -> impl Strategy<Value = Vec<Happening>> {
    let size =
        prop_oneof![(0..=200u16, 0..=60u16), (60..=100u16, 16..=30u16), (0..=4u16, 0..=4u16)];
    let letters = prop_oneof![
        select(&HOSTILE[..]).prop_map(str::to_owned),
        ".{0,8}",
        "[a-z0-9/.]{1,6}",
        "[0-9.e+-]{1,8} ?[a-z]{0,3}"
    ];
    let half = (field_and_text(), 0.0..1.5f64).prop_map(|((field, text), part)| {
        let letters = (text.chars().count() as f64 * part) as usize;
        Happening::Fill(field, text.chars().take(letters).collect())
    });
    let happening = prop_oneof![
        12 => (keys(), 1..4usize).prop_map(|(key, times)| Happening::Key(key, times)),
        3 => letters.clone().prop_map(Happening::Type),
        2 => letters.prop_map(Happening::Paste),
        1 => size.prop_map(|(width, height)| Happening::Resize(width, height)),
        8 => half,
        1 => select(vec!["", "", "cas", "none"]).prop_map(|name| Happening::Open(name.to_owned())),
        1 => texts::written().prop_map(Happening::Meddle),
    ];
    prop::collection::vec(happening, 0..40)
}

/// Every key that a terminal sends; keys of the table of bindings more often.
fn keys() -> impl Strategy<Value = KeyEvent> {
    use KeyCode::{
        BackTab, Backspace, CapsLock, Delete, Down, End, Enter, Esc, Home, Insert, Left, Null,
        PageDown, PageUp, Right, Tab, Up,
    };
    let named = [
        Backspace, Enter, Left, Right, Up, Down, Home, End, PageUp, PageDown, Tab, BackTab, Delete,
        Insert, Null, Esc, CapsLock,
    ];
    let code = prop_oneof![
        6 => select(named.to_vec()),
        2 => (0..=12u8).prop_map(KeyCode::F),
        1 => any::<char>().prop_map(KeyCode::Char),
        4 => select("acdehklnopqrstuwyz? ".chars().collect::<Vec<_>>()).prop_map(KeyCode::Char),
    ];
    let held = prop_oneof![
        6 => Just(KeyModifiers::NONE),
        6 => Just(KeyModifiers::CONTROL),
        2 => Just(KeyModifiers::ALT),
        1 => any::<u8>().prop_map(KeyModifiers::from_bits_truncate),
    ];
    let kind = prop_oneof![8 => Just(KeyEventKind::Press), 1 => Just(KeyEventKind::Repeat), 1 => Just(KeyEventKind::Release)];
    (code, held, kind).prop_map(|(code, held, kind)| KeyEvent::new_with_kind(code, held, kind))
}

fn key(code: KeyCode) -> KeyEvent {
    KeyEvent::new(code, KeyModifiers::NONE)
}

fn ctrl(letter: char) -> KeyEvent {
    KeyEvent::new(KeyCode::Char(letter), KeyModifiers::CONTROL)
}

fn presses(key: KeyEvent, times: usize) -> Vec<Event> {
    (0..times).map(|_| Event::Input(Input::Key(key))).collect()
}

/// All results of work, which runs at once.
fn results(number: u64, work: Work) -> Vec<Action> {
    let sent = RefCell::new(Vec::new());
    work.run(number, &|| true, &|action| sent.borrow_mut().push(action));
    sent.into_inner()
}

impl Bench {
    /// A workbench on a file with this text if it is a case, otherwise on the built-in case.
    fn on(text: &str, ascii: bool) -> Bench {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("case.toml");
        fs::write(&path, text).expect("room on the disk");
        let read = Document::read_draft(&path).ok();
        let path = read.is_some().then_some(path);
        let look = Look { ascii, ..Look::FULL };
        let size = Size { width: 80, height: 24 };
        let app = opened(read.unwrap_or_else(store::built_in), path, look, size);
        let home = tempfile::tempdir().expect("a folder");
        let state = State { folder: Some(home.path().to_owned()), ..State::default() };
        let first = app.tab.case.clone();
        let opened = vec![first, Case::table_1(), Case::fresh()];
        Bench {
            app,
            autosave: Autosave::new(state, Arc::new(JournalWriter::default())),
            folder,
            _state: home,
            waiting: None,
            on_disk: opened.clone(),
            opened,
            seen: BTreeSet::new(),
            taken: 0,
        }
    }

    fn take(&mut self, happening: Happening) {
        let letters = |text: String| {
            let press = |letter| Event::Input(Input::Key(key(KeyCode::Char(letter))));
            text.chars().map(press).collect::<Vec<_>>()
        };
        match happening {
            Happening::Key(key, times) => self.feed(presses(key, times)),
            Happening::Type(text) => self.feed(letters(text)),
            Happening::Paste(text) => self.feed([Event::Input(Input::Paste(text))]),
            Happening::Resize(width, height) => {
                self.feed([Event::Input(Input::Resize(width, height))]);
            }
            Happening::Fill(field, text) => {
                let first = KeyEvent::new(KeyCode::Home, KeyModifiers::CONTROL);
                let moves = [presses(first, 1), presses(key(KeyCode::Down), field)];
                let typed = [presses(ctrl('u'), 1), letters(text)];
                self.feed(moves.into_iter().chain(typed).flatten());
            }
            Happening::Open(name) => {
                let enter = presses(key(KeyCode::Enter), 1);
                self.feed([presses(ctrl('o'), 1), letters(name), enter].into_iter().flatten());
            }
            Happening::Meddle(text) => {
                fs::write(self.folder.path().join("case.toml"), text).expect("room on the disk");
                self.feed(presses(ctrl('s'), 1));
            }
        }
        // The worker often answers late.
        self.taken += 1;
        if self.taken.is_multiple_of(3) {
            self.answer();
        }
        self.look_around();
        self.assert_sound();
    }

    fn look_around(&mut self) {
        let prompt = self.app.prompts.last().map(|prompt| match prompt {
            Prompt::Browse(_) => "browse",
            Prompt::Path(_) => "path",
            Prompt::Ask(_) => "ask",
            Prompt::Read(_) | Prompt::Explain(_) | Prompt::Relief(_) => "page",
            Prompt::Pick(_) => "pick",
        });
        let invalid = (!self.app.tab.problems.is_empty()).then_some("invalid");
        let refused = self.app.tab.refusal.is_some().then_some("refused");
        self.seen.extend([prompt, invalid, refused].into_iter().flatten());
    }

    /// Applies a batch of events, as the main loop does.
    fn feed(&mut self, events: impl IntoIterator<Item = Event>) {
        let mut events = events.into_iter().peekable();
        while events.peek().is_some() {
            if let Some(action) = take_action(&mut events, self.app.place()) {
                self.act(action);
            }
        }
    }

    /// Applies an action and carries out its effects within the folder.
    fn act(&mut self, action: Action) {
        let mut actions = vec![action];
        while let Some(action) = actions.pop() {
            let was_asked = matches!(self.app.prompts.last(), Some(Prompt::Ask(_)));
            self.note(&action);
            let effects = update(&mut self.app, action);
            for effect in effects {
                actions.extend(self.perform(effect, was_asked));
            }
        }
        for claim in self.autosave.follow(&self.app.sheets(), Instant::now()) {
            update(&mut self.app, effects::claimed(claim));
        }
    }

    /// Stores the new content of a file that was read or written.
    fn note(&mut self, action: &Action) {
        let seen = match action {
            Action::Loaded(_, Ok(document)) => {
                self.opened.push(document.case.clone());
                self.on_disk.push(document.case.clone());
                "loaded"
            }
            Action::Saved(path, _, Ok(written)) => {
                self.on_disk.push(written.document.case.clone());
                let again = Document::read_draft(path).expect("a saved case opens");
                assert!(again.case == written.document.case, "the file has the values of the form");
                "saved"
            }
            Action::Loaded(..) => "not loaded",
            Action::Saved(..) => "not saved",
            _ => return,
        };
        self.seen.insert(seen);
    }

    fn perform(&mut self, effect: Effect, was_asked: bool) -> Vec<Action> {
        match effect {
            Effect::Quit => {
                let is_unsaved = self.app.tabs().any(tipstrike::tui::testing::Tab::is_unsaved);
                assert!(was_asked || !is_unsaved, "edits are not lost without a question");
                self.seen.insert("quit");
                Vec::new()
            }
            Effect::Load(path) => self.outside(Effect::Load(self.within(&path))),
            Effect::Save(mut saving, next) => {
                saving.path = self.within(&saving.path);
                self.outside(Effect::Save(saving, next))
            }
            Effect::Work(number, mut work) => match work.slot {
                Slot::Solve => {
                    let (request, valid) = (self.app.tab.request(), self.app.tab.case.inputs());
                    assert_eq!(valid.as_ref(), Ok(&request.inputs), "only valid cases are solved");
                    self.waiting = Some(request);
                    Vec::new()
                }
                Slot::Recents => {
                    if let Some(Prompt::Browse(browser)) = self.app.prompts.last_mut() {
                        let recent = self.folder.path().join("case.toml");
                        browser.remember(recents::looked_at(vec![recent]));
                    }
                    Vec::new()
                }
                // A search for a relief takes seconds, and no key needs its result.
                Slot::Study | Slot::Chart | Slot::Benchmark | Slot::Relief => Vec::new(),
                Slot::Preview if !work.path.starts_with(self.folder.path()) => Vec::new(),
                _ => {
                    if !work.path.as_os_str().is_empty() {
                        work.path = self.within(&work.path);
                    }
                    results(number, work)
                }
            },
            Effect::Play(plays) => {
                assert_eq!(plays, self.app.is_playing, "it ticks while something plays");
                Vec::new()
            }
            Effect::Copy(text) => {
                assert!(!text.is_empty() && text.len() <= 48 * 1024);
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn outside(&mut self, effect: Effect) -> Vec<Action> {
        effects::perform(effect, &mut self.autosave).into_iter().collect()
    }

    /// A path limited to the folder.
    fn within(&self, path: &Path) -> PathBuf {
        let inside = path.strip_prefix(self.folder.path()).unwrap_or(path);
        let names =
            inside.components().filter(|part| matches!(part, std::path::Component::Normal(_)));
        self.folder.path().join(names.collect::<PathBuf>())
    }

    fn answer(&mut self) {
        if let Some(request) = self.waiting.take() {
            let mut quick = request.clone();
            // Slices over the speed take seconds: the worker still computes them.
            if request.inputs.face().is_some() {
                quick.wanted.stages = request.wanted.stages.without(Stage::SpeedRun);
            }
            let answer = solver::answer(&quick);
            self.app.take(answer);
            self.act(Action::Tick);
        }
    }

    fn assert_sound(&self) {
        let app = &self.app;
        if rows::names(&app.tab.case, app.tab.form.focus).is_empty() {
            let line = [app.tab.form.input.value(), &app.ending().unwrap_or_default()].concat();
            let is_words = rows::field(&app.tab.case, app.tab.form.focus)
                .is_some_and(|field| matches!(field.kind, Kind::Text));
            // While a number is typed, its unit may be that of the field, and it may have
            // surrounding blanks.
            let said = if is_words || !app.has_line() { line.as_str() } else { line.trim() };
            let row = rows::text(&app.tab.case, app.tab.form.focus).unwrap_or_default();
            assert_eq!(said, row, "the line is the row's");
        }
        assert_eq!(app.tab.problems.is_empty(), app.tab.case.inputs().is_ok());
        let is_known = app.tabs().all(|tab| self.on_disk.contains(tab.document.loaded()));
        assert!(is_known, "the mark shows whether the file differs");
        let inputs = app.tab.case.inputs().ok();
        let is_pending = app.tab.is_stale() || self.waiting.is_some();
        if let (Some(inputs), Some(answer), false) = (inputs, &app.tab.answer, is_pending) {
            assert_eq!(answer.serial, app.tab.serial, "the results are those of the form");
            let chosen = inputs.method == Method::Auto || answer.pending.is_some();
            assert!(chosen || answer.active == inputs.method, "the method of the form is first");
        }
        let Size { width, height } = app.layout.size;
        self.draw(app.layout.size);
        if self.taken.is_multiple_of(3) {
            self.draw(Size { width: height, height: width.min(60) });
        }
    }

    fn draw(&self, size: Size) {
        let area = Rect::new(0, 0, size.width, size.height);
        let mut buffer = Buffer::empty(area);
        let mut app = self.app.clone();
        app.layout.size = size;
        let cursor = view::draw(&app, &mut buffer);
        assert!(cursor.is_none_or(|cursor| area.contains(cursor)), "{cursor:?} in {size:?}");
        for cell in &buffer.content {
            let is_wrong = |letter| is_hostile(letter) || self.app.look.ascii && !letter.is_ascii();
            assert!(!cell.symbol().contains(is_wrong), "{:?} on the screen", cell.symbol());
        }
        let symbols = buffer.content.iter().map(ratatui::buffer::Cell::symbol);
        let is_marked = symbols.collect::<String>().contains("*unsaved*");
        let is_alone = self.app.prompts.is_empty() && self.app.others.is_empty();
        if size.width >= 80 && size.height >= 24 && is_alone {
            assert_eq!(is_marked, self.app.tab.is_unsaved());
        }
    }

    /// Undoes all edits and expects the first case; redoes them and expects the last one.
    fn assert_undone(&mut self) {
        self.feed(presses(key(KeyCode::Esc), self.app.prompts.len()));
        self.repeat(ctrl('y'), "nothing to redo");
        let last = self.app.tab.case.clone();
        self.repeat(ctrl('z'), "nothing to undo");
        assert!(self.opened.contains(&self.app.tab.case), "undoing everything leads back");
        self.assert_sound();
        self.repeat(ctrl('y'), "nothing to redo");
        assert_eq!(self.app.tab.case, last, "redoing everything leads forward");
    }

    fn repeat(&mut self, key: KeyEvent, end: &str) {
        for _ in 0..1000 {
            self.feed(presses(key, 1));
            if self.app.message.as_ref().is_some_and(|message| message.text == end) {
                self.answer();
                return;
            }
        }
        panic!("{end:?} is never shown");
    }
}
