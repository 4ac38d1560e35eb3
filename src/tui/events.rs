//! Incoming events: keys, signals and results through one bounded channel, read in batches.

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crossterm::event::{Event as Input, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Position;

use super::app::actions::Action;
use super::input;
use super::keys::Place;
use super::update::commands::of_key;

/// An event from outside the state.
#[derive(Debug)]
pub enum Event {
    /// Input from the terminal.
    Input(Input),
    /// The number of a signal.
    Signal(i32),
    /// A result of a worker, or an error of the journal.
    Action(Action),
    /// Time for the next frame of an animation.
    Tick,
    /// The terminal is closed.
    Lost,
}

/// The receiver of events.
#[derive(Debug)]
pub(crate) struct Events {
    sender: SyncSender<Event>,
    receiver: Receiver<Event>,
}

const CHANNEL: usize = 4096;
/// A batch is drawn after this time, even if more events are waiting.
const BATCH: Duration = Duration::from_millis(50);
/// Lines per step of the mouse wheel.
const WHEEL: isize = 3;

impl Events {
    /// A channel without senders.
    #[must_use]
    pub(crate) fn new() -> Events {
        let (sender, receiver) = sync_channel(CHANNEL);
        Events { sender, receiver }
    }

    /// Starts a thread that reads the terminal.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(crate) fn listen(&self) -> io::Result<()> {
        let keys = self.sender.clone();
        thread::Builder::new().name("keys".to_owned()).spawn(move || read_terminal(&keys))?;
        Ok(())
    }

    /// A sender for the code that ends the workbench.
    #[must_use]
    pub(crate) fn sender(&self) -> SyncSender<Event> {
        self.sender.clone()
    }

    /// Sends actions as events.
    pub(crate) fn action_sender(&self) -> impl Fn(Action) -> bool + Send + Sync + 'static {
        let sender = self.sender.clone();
        move |action| sender.send(Event::Action(action)).is_ok()
    }

    /// Waits for an event and returns all waiting events. Returns a tick after `alarm` without
    /// events, and nothing after `deadline`.
    #[must_use]
    pub(crate) fn batch(&self, alarm: Option<Instant>, deadline: Option<Instant>) -> Vec<Event> {
        let Some(first) = self.first(alarm, deadline) else {
            return Vec::new();
        };
        let mut batch = vec![first];
        let end = Instant::now() + BATCH;
        while Instant::now() < end {
            match self.receiver.try_recv() {
                Ok(event) => batch.push(event),
                Err(_) => break,
            }
        }
        batch
    }

    fn first(&self, alarm: Option<Instant>, deadline: Option<Instant>) -> Option<Event> {
        let Some(until) = alarm.into_iter().chain(deadline).min() else {
            return Some(self.receiver.recv().unwrap_or(Event::Lost));
        };
        match self.receiver.recv_timeout(until.saturating_duration_since(Instant::now())) {
            Ok(event) => Some(event),
            Err(RecvTimeoutError::Timeout) => (alarm == Some(until)).then_some(Event::Tick),
            Err(RecvTimeoutError::Disconnected) => Some(Event::Lost),
        }
    }
}

/// The action of an input in a place; a run of typed letters becomes one action.
pub fn take_action(
    inputs: &mut std::iter::Peekable<impl Iterator<Item = Event>>,
    place: Place,
) -> Option<Action> {
    match inputs.next()? {
        Event::Input(Input::Key(key)) => match of_key(key, place)? {
            Action::Insert(letter) if place.is_line() => Some(typed(letter, inputs, place)),
            action => Some(action),
        },
        Event::Input(Input::Paste(text)) => Some(Action::Paste(text)),
        Event::Action(action) => Some(action),
        Event::Input(Input::Mouse(mouse)) => of_mouse(mouse),
        Event::Tick => Some(Action::Tick),
        Event::Input(_) | Event::Signal(_) | Event::Lost => None,
    }
}

fn of_mouse(mouse: MouseEvent) -> Option<Action> {
    let at = Position::new(mouse.column, mouse.row);
    match mouse.kind {
        MouseEventKind::Down(MouseButton::Left) => Some(Action::Click(at)),
        MouseEventKind::ScrollDown => Some(Action::Wheel(at, WHEEL)),
        MouseEventKind::ScrollUp => Some(Action::Wheel(at, -WHEEL)),
        _ => None,
    }
}

fn typed(
    letter: char,
    inputs: &mut std::iter::Peekable<impl Iterator<Item = Event>>,
    place: Place,
) -> Action {
    let mut run = String::from(letter);
    while let Some(letter) = inputs.peek().and_then(|next| letter_of(next, place)) {
        run.push(letter);
        inputs.next();
    }
    if run.len() == letter.len_utf8() { Action::Insert(letter) } else { Action::Paste(run) }
}

fn letter_of(event: &Event, place: Place) -> Option<char> {
    let Event::Input(Input::Key(key)) = event else {
        return None;
    };
    match of_key(*key, place)? {
        Action::Insert(letter) => Some(letter),
        _ => None,
    }
}

fn read_terminal(sender: &SyncSender<Event>) {
    let send = |input| sender.send(Event::Input(input)).is_ok();
    // The workbench must not run without keys, whatever ends this reader. If the receiver is
    // closed, the workbench is ending.
    drop(catch_unwind(AssertUnwindSafe(|| input::read_all(send))));
    drop(sender.send(Event::Lost));
}

#[cfg(test)]
mod tests {
    use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

    use super::*;

    fn keys(codes: &[KeyCode]) -> Vec<Event> {
        codes
            .iter()
            .map(|&code| Event::Input(Input::Key(KeyEvent::new(code, KeyModifiers::NONE))))
            .collect()
    }

    #[test]
    fn a_run_of_letters_becomes_one_action() {
        let mut inputs =
            keys(&"16 um".chars().map(KeyCode::Char).collect::<Vec<_>>()).into_iter().peekable();
        let action = take_action(&mut inputs, Place::TEXT);
        assert!(matches!(action, Some(Action::Paste(text)) if text == "16 um"));
        let mut inputs = keys(&[KeyCode::Char('s'), KeyCode::Char('d')]).into_iter().peekable();
        assert!(matches!(take_action(&mut inputs, Place::ASK), Some(Action::Insert('s'))));
    }
}
