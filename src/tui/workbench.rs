//! The main loop of the workbench: takes events, changes the state, carries out the effects, draws.

use std::fs;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::app::App;
use super::app::actions::{Action, Effect};
use super::input::{self, Event, Events};
use super::session::Autosave;
use super::session::Claim;
use super::session::journal::JournalWriter;
use super::settings::Settings;
use super::solver::on_demand;
use super::store::{self, State};
use super::tab::Origin;
use super::terminal::Screen;
use super::theme::Look;
use super::update::{self, update};
use super::worker::Workers;
use crate::case::rexs;
use crate::system::terminal::{SIGCONT, SIGTSTP, SIGWINCH};

/// Time between two frames of the animation.
const TICK: Duration = Duration::from_millis(83);

/// How the workbench ended.
pub(super) enum End {
    /// The user quit; no unsaved edits are to be kept.
    Left,
    /// The terminal is closed.
    Lost,
    Signal(i32),
}

pub(super) fn session(
    named: Option<PathBuf>,
    events: Events,
    mut screen: Screen,
    journal_writer: &Arc<JournalWriter>,
) -> io::Result<End> {
    let is_named = named.is_some();
    let path = named.or_else(|| store::recents().into_iter().next());
    let loaded = path.as_deref().map(store::load).transpose();
    screen.enter()?;
    events.listen()?;
    let settings = Settings::read();
    let look = Look::of(|name| std::env::var_os(name));
    let look =
        settings.look(look, |name| std::env::var_os(name).is_some_and(|value| !value.is_empty()));
    let start = |document, path| -> io::Result<App> {
        let mut app = App::at_start(document, path, look, screen.size()?);
        app.settings = settings;
        update::settle(&mut app);
        Ok(app)
    };
    let app = match (path, loaded) {
        (Some(path), Ok(Some(document))) => {
            store::add_recent(&path);
            let mut app = start(*document, Some(rexs::case_path(&path)))?;
            app.tab.origin = if is_named { Origin::Given } else { Origin::LastCase };
            app
        }
        (Some(path), Err(faults)) => {
            let mut app = start(store::built_in(), None)?;
            app.tab.in_place_of = Some(path.clone());
            if is_named {
                update(&mut app, Action::Loaded(path, Err(faults)));
            } else {
                let reason = faults.into_iter().next().unwrap_or_default();
                app.complain(format!("the last case cannot be opened: {reason}"));
            }
            app
        }
        _ => start(store::built_in(), None)?,
    };
    screen.take_mouse(settings.mouse)?;
    screen.draw(&app)?;
    let workers = Workers::start(Arc::new(events.action_sender()))?;
    let autosave = Autosave::new(State::find(), Arc::clone(journal_writer));
    let mut workbench =
        Workbench { app, screen, events, workers, autosave, alarm: None, chosen: None };
    workbench.app.complete();
    workbench.act(Action::Tick)?;
    workbench.stay()
}

/// Carries out an effect on files and returns its result as an action. Ignores other effects.
pub fn perform(effect: Effect, autosave: &mut Autosave) -> Option<Action> {
    match effect {
        Effect::Load(path) => {
            let path = store::at_home(&path);
            let result = store::load(&path);
            return Some(Action::Loaded(path, result));
        }
        Effect::Save(saving, next) => {
            let result = autosave.save(&saving);
            return Some(Action::Saved(saving.path, next, result));
        }
        Effect::Adopt(journal) => autosave.adopt(journal),
        Effect::Remember(path) => store::add_recent(&path),
        Effect::Keep(settings) => {
            let reason = settings.keep().err()?;
            return Some(Action::Failed(format!("the settings are not saved: {reason}")));
        }
        // A journal that cannot be deleted is offered again at the next start.
        Effect::Forget(journals) => {
            for journal in &journals {
                drop(fs::remove_file(journal));
            }
        }
        Effect::Journals => return Some(Action::Journals(autosave.ended_sessions())),
        _ => {}
    }
    None
}

/// The result of opening a case under autosave, as an action.
pub fn claimed(claim: Result<Claim, String>) -> Action {
    claim.map_or_else(Action::Failed, |claim| Action::Claimed(Box::new(claim)))
}

/// The running workbench.
struct Workbench {
    app: App,
    screen: Screen,
    events: Events,
    workers: Workers,
    autosave: Autosave,
    /// Time of the next frame of the animation.
    alarm: Option<Instant>,
    /// Settings to save after all waiting events: several changes cause one write.
    chosen: Option<Settings>,
}

impl Workbench {
    fn stay(mut self) -> io::Result<End> {
        // Claims of the first case arrive after the first frame.
        let mut batch = Vec::new();
        let end = loop {
            if let Some(end) = self.take(batch)? {
                break end;
            }
            batch = self.events.batch(self.alarm, self.autosave.deadline());
        };
        self.keep_settings();
        if matches!(end, End::Left) {
            self.autosave.end();
        }
        Ok(end)
    }

    // Applies all waiting events and draws one frame if the state changed. Returns how the
    // workbench ended, if it has ended.
    fn take(&mut self, batch: Vec<Event>) -> io::Result<Option<End>> {
        let mut events = batch.into_iter().peekable();
        let mut has_changed = false;
        while let Some(event) = events.peek() {
            match *event {
                Event::Lost => return Ok(Some(End::Lost)),
                Event::Tick => self.alarm = Some(Instant::now() + TICK),
                Event::Signal(signal) => {
                    has_changed = true;
                    match signal {
                        SIGTSTP => self.suspend()?,
                        SIGCONT => self.screen.resume()?,
                        SIGWINCH => {
                            let size = self.screen.size()?;
                            self.act(Action::Resize(size))?;
                        }
                        _ => return Ok(Some(End::Signal(signal))),
                    }
                }
                _ => {}
            }
            let Some(action) = input::take_action(&mut events, self.app.place()) else {
                continue;
            };
            has_changed = true;
            if self.act(action)? {
                return Ok(Some(End::Left));
            }
            self.keep()?;
        }
        self.keep_settings();
        if self.keep()? || has_changed {
            self.screen.draw(&self.app)?;
        }
        self.autosave.keep_if_due(Instant::now());
        self.workers.watch(self.app.files());
        Ok(None)
    }

    // Returns whether the workbench ends.
    fn act(&mut self, action: Action) -> io::Result<bool> {
        let mut actions = vec![action];
        while let Some(action) = actions.pop() {
            for effect in update(&mut self.app, action) {
                match effect {
                    Effect::Quit => return Ok(true),
                    Effect::Redraw => {
                        on_demand("screen");
                        self.screen.clear()?;
                    }
                    Effect::Suspend => self.suspend()?,
                    Effect::Work(number, work) => self.workers.work(number, work)?,
                    Effect::Cancel(slot) => self.workers.cancel(slot),
                    Effect::Keep(settings) => self.chosen = Some(settings),
                    Effect::Copy(text) => self.screen.copy(&text)?,
                    Effect::Mouse(takes) => self.screen.take_mouse(takes)?,
                    Effect::Play(plays) => self.alarm = plays.then(|| Instant::now() + TICK),
                    other => actions.extend(perform(other, &mut self.autosave)),
                }
            }
        }
        Ok(false)
    }

    fn keep_settings(&mut self) {
        let effect = self.chosen.take().map(Effect::Keep);
        if let Some(action) = effect.and_then(|keep| perform(keep, &mut self.autosave)) {
            update(&mut self.app, action);
        }
    }

    // Returns whether there were claims.
    fn keep(&mut self) -> io::Result<bool> {
        let claims = self.autosave.follow(&self.app.sheets(), Instant::now());
        let has_changed = !claims.is_empty();
        for claim in claims {
            self.act(claimed(claim))?;
        }
        Ok(has_changed)
    }

    // The journal is written first, because the suspension may last long.
    fn suspend(&mut self) -> io::Result<()> {
        self.keep()?;
        self.autosave.keep();
        self.screen.suspend()
    }
}
