//! Input: the bytes of the terminal become keys, mouse reports and pastes, and these become actions.
//!
//! The reader of crossterm keeps an unfinished sequence for ever: after `ESC [ ? 2026 ; 2 $ y`,
//! `ESC [ <` or a paste without an end, it takes every key, also Ctrl-Q, as a part of it. Here an
//! unfinished sequence never delays later keys.

use std::io::{self, ErrorKind};
use std::iter::Peekable;
use std::mem;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crossterm::event::{
    Event as Input, KeyCode, KeyEvent, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};
use ratatui::layout::Position;

use super::app::actions::Action;
use super::layout::Place;
use super::update::commands::of_key;
use crate::system::terminal::{self, is_in_foreground, read, wait_for_input};

/// Less than the terminal's own buffer, so that a full read means that more bytes are ready.
const BUFFER: usize = 1024;
/// Polling interval while the shell is in the foreground.
const BACKGROUND: Duration = Duration::from_millis(50);

/// Timeout for the rest of a sequence after `Esc` alone.
const ESCAPE: Duration = Duration::from_millis(50);
/// Timeout for a sequence or a character.
const SEQUENCE: Duration = Duration::from_millis(100);
/// Timeout for a pause in a paste. A connection that loses packets pauses for some hundred
/// milliseconds.
const PASTE: Duration = Duration::from_secs(1);
const LONGEST_SEQUENCE: usize = 4096;
/// Greatest number of bytes of a paste; the rest is dropped.
const LONGEST_PASTE: usize = 1 << 20;
const PASTE_END: &[u8] = b"\x1b[201~";
const ESC: u8 = 0x1b;

const CHANNEL: usize = 4096;
/// A batch is drawn after this time, even if more events are waiting.
const BATCH: Duration = Duration::from_millis(50);
/// Lines per step of the mouse wheel.
const WHEEL: isize = 3;

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

/// Keys, signals and results, through one bounded channel.
#[derive(Debug)]
pub(crate) struct Events {
    sender: SyncSender<Event>,
    receiver: Receiver<Event>,
}

impl Events {
    pub(crate) fn new() -> Events {
        let (sender, receiver) = sync_channel(CHANNEL);
        Events { sender, receiver }
    }

    /// Starts a thread that reads the terminal.
    pub(crate) fn listen(&self) -> io::Result<()> {
        let keys = self.sender.clone();
        let listen = move || {
            let send = |input| keys.send(Event::Input(input)).is_ok();
            // The workbench must not run without keys, whatever ends this reader. If the receiver
            // is closed, the workbench is ending.
            drop(catch_unwind(AssertUnwindSafe(|| read_all(send))));
            drop(keys.send(Event::Lost));
        };
        thread::Builder::new().name("keys".to_owned()).spawn(listen).map(drop)
    }

    /// A sender for the code that ends the workbench.
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
    pub(crate) fn batch(&self, alarm: Option<Instant>, deadline: Option<Instant>) -> Vec<Event> {
        let first = match alarm.into_iter().chain(deadline).min() {
            None => self.receiver.recv().unwrap_or(Event::Lost),
            Some(until) => {
                match self.receiver.recv_timeout(until.saturating_duration_since(Instant::now())) {
                    Ok(event) => event,
                    Err(RecvTimeoutError::Timeout) if alarm == Some(until) => Event::Tick,
                    Err(RecvTimeoutError::Timeout) => return Vec::new(),
                    Err(RecvTimeoutError::Disconnected) => Event::Lost,
                }
            }
        };
        let end = Instant::now() + BATCH;
        let more = self.receiver.try_iter().take_while(|_| Instant::now() < end);
        std::iter::once(first).chain(more).collect()
    }
}

/// The action of an input in a place; a run of typed letters becomes one action.
pub fn take_action(
    inputs: &mut Peekable<impl Iterator<Item = Event>>,
    place: Place,
) -> Option<Action> {
    match inputs.next()? {
        Event::Input(Input::Key(key)) => match of_key(key, place)? {
            Action::Insert(letter) if place.is_line() => Some(typed(letter, inputs, place)),
            action => Some(action),
        },
        Event::Input(Input::Paste(text)) => Some(Action::Paste(text)),
        Event::Action(action) => Some(action),
        Event::Input(Input::Mouse(mouse)) => {
            let at = Position::new(mouse.column, mouse.row);
            match mouse.kind {
                MouseEventKind::Down(MouseButton::Left) => Some(Action::Click(at)),
                MouseEventKind::ScrollDown => Some(Action::Wheel(at, WHEEL)),
                MouseEventKind::ScrollUp => Some(Action::Wheel(at, -WHEEL)),
                _ => None,
            }
        }
        Event::Tick => Some(Action::Tick),
        Event::Input(_) | Event::Signal(_) | Event::Lost => None,
    }
}

fn typed(letter: char, inputs: &mut Peekable<impl Iterator<Item = Event>>, place: Place) -> Action {
    let mut run = String::from(letter);
    while let Some(Event::Input(Input::Key(key))) = inputs.peek()
        && let Some(Action::Insert(letter)) = of_key(*key, place)
    {
        run.push(letter);
        inputs.next();
    }
    if run.len() == letter.len_utf8() { Action::Insert(letter) } else { Action::Paste(run) }
}

/// Reads the terminal, sleeping until bytes arrive, and passes each input to `send`, until `send`
/// returns false or the terminal closes.
fn read_all(mut send: impl FnMut(Input) -> bool) {
    let stdin = io::stdin();
    let (mut decoder, mut buffer, mut inputs) = (Decoder::default(), [0; BUFFER], Vec::new());
    loop {
        let start = Instant::now();
        match wait_for_input(&stdin, decoder.patience()) {
            Ok(terminal::Input::None) => decoder.expire(&mut inputs),
            // The shell is in the foreground: a read would stop the process.
            Ok(terminal::Input::Ready) if !is_in_foreground() => thread::sleep(BACKGROUND),
            Ok(state) => {
                decoder.has_waited(start.elapsed());
                match read(&stdin, &mut buffer) {
                    Ok(0) if state == terminal::Input::HungUp => return,
                    Ok(count) => decoder.feed(&buffer[..count], count == BUFFER, &mut inputs),
                    Err(error)
                        if matches!(
                            error.kind(),
                            ErrorKind::Interrupted | ErrorKind::WouldBlock
                        ) => {}
                    Err(_) => return,
                }
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(_) => return,
        }
        if !inputs.drain(..).all(&mut send) {
            return;
        }
    }
}

#[derive(Debug, Default)]
struct Decoder {
    /// The bytes of the unfinished sequence or character.
    bytes: Vec<u8>,
    /// The bytes of the unfinished paste.
    paste: Option<Vec<u8>>,
    /// A read ended with the Esc of the sequence: a following letter is a key of its own.
    is_apart: bool,
    /// The Esc of the sequence may begin the terminator of a text.
    ends_text: bool,
    /// Timeout for the next byte.
    patience: Duration,
}

/// What the bytes of a sequence are.
enum Step {
    Unfinished,
    Done(Option<Input>),
    Paste,
    /// The last byte begins another sequence.
    Restart(Option<Input>),
}

impl Decoder {
    /// Timeout for the next byte; `None` if nothing is unfinished.
    fn patience(&self) -> Option<Duration> {
        (self.paste.is_some() || !self.bytes.is_empty()).then_some(self.patience)
    }

    fn has_waited(&mut self, time: Duration) {
        self.patience = self.patience.saturating_sub(time);
    }

    /// Decodes the bytes of one read. `is_full` if more bytes may be ready.
    fn feed(&mut self, bytes: &[u8], is_full: bool, inputs: &mut Vec<Input>) {
        // Pastes arrive in bulk. In a paste without an end, a control character that arrives alone
        // after a pause is a key, such as Ctrl-Q.
        let has_paused = self.patience + SEQUENCE <= PASTE;
        let is_whole = self.paste.as_ref().is_some_and(|paste| part_of_end(paste) == 0);
        let is_key = matches!(bytes, [0..=0x08 | 0x0b | 0x0c | 0x0e..=0x1a | 0x1c..=0x1f]);
        if is_whole && has_paused && is_key {
            self.expire(inputs);
        }
        for &byte in bytes {
            self.take(byte, inputs);
        }
        self.is_apart |= self.bytes == [ESC] && !is_full;
    }

    /// Ends the unfinished sequence after its timeout.
    fn expire(&mut self, inputs: &mut Vec<Input>) {
        let Decoder { bytes, paste, .. } = mem::take(self);
        inputs.extend(match (paste, &bytes[..]) {
            // A single Esc is a key.
            (Some(paste), _) => Some(pasted(&paste[..paste.len() - part_of_end(&paste)])),
            (None, [ESC]) => Some(Input::Key(KeyCode::Esc.into())),
            // No sequence ends after its first letter: the user pressed Alt.
            (None, &[ESC, letter @ ..0x80]) => Some(of_byte(letter, KeyModifiers::ALT)),
            _ => None,
        });
    }

    fn take(&mut self, byte: u8, inputs: &mut Vec<Input>) {
        if let Some(paste) = &mut self.paste {
            paste.push(byte);
            if paste.ends_with(PASTE_END) {
                inputs.push(pasted(&paste[..paste.len() - PASTE_END.len()]));
                *self = Decoder::default();
            } else {
                if paste.len() >= LONGEST_PASTE + PASTE_END.len() {
                    paste.remove(LONGEST_PASTE);
                }
                self.patience = if byte == ESC { SEQUENCE } else { PASTE };
            }
            return;
        }
        self.bytes.push(byte);
        if self.bytes.len() <= 2 {
            self.patience = if byte == ESC { ESCAPE } else { SEQUENCE };
        }
        match self.step() {
            Step::Unfinished if self.bytes.len() <= LONGEST_SEQUENCE + 2 => {}
            Step::Unfinished => *self = Decoder::default(),
            Step::Done(input) => {
                inputs.extend(input);
                *self = Decoder::default();
            }
            Step::Paste => {
                let paste = Some(Vec::new());
                *self = Decoder { paste, patience: PASTE, ..Decoder::default() };
            }
            Step::Restart(input) => {
                inputs.extend(input);
                let ends_text = byte == ESC && self.bytes.get(1).is_some_and(|&byte| is_text(byte));
                *self = Decoder { ends_text, ..Decoder::default() };
                self.take(byte, inputs);
            }
        }
    }

    fn step(&self) -> Step {
        match self.bytes[..] {
            [ESC] | [ESC, b'[' | b'O'] => Step::Unfinished,
            [ESC, b'\\'] if self.ends_text => Step::Done(None),
            [ESC, byte] if self.is_apart || byte == ESC => {
                Step::Restart(Some(Input::Key(KeyCode::Esc.into())))
            }
            [ESC, byte] if is_text(byte) => Step::Unfinished,
            [0x80..=0xff, ..] => in_letter(&self.bytes, KeyModifiers::NONE),
            [ESC, 0x80..=0xff, ..] => in_letter(&self.bytes[1..], KeyModifiers::ALT),
            [byte] => Step::Done(Some(of_byte(byte, KeyModifiers::NONE))),
            [ESC, byte] => Step::Done(Some(of_byte(byte, KeyModifiers::ALT))),
            [ESC, b'[', b'M', .., 0..b' '] => Step::Restart(None),
            // Button, column and row, one byte each.
            [ESC, b'[', b'M', button, column, row] => Step::Done(mouse(
                button.checked_sub(32),
                [column, row].map(|byte| byte.checked_sub(32).map(u16::from)),
            )),
            [ESC, b'[', b'M', ..] => Step::Unfinished,
            [ESC, b'[', ref parameters @ .., last] => match last {
                // A function key of the Linux console.
                b'[' if parameters.is_empty() => Step::Unfinished,
                b' '..=b'?' => Step::Unfinished,
                b'~' if parameters == b"200" => Step::Paste,
                b'@'..=b'~' => Step::Done(csi(parameters, last)),
                _ => Step::Restart(None),
            },
            [ESC, b'O', ref parameters @ .., last] => match last {
                b'0'..=b'9' | b';' => Step::Unfinished,
                b'@'..=b'~' => Step::Done(ss3(parameters, last)),
                _ => Step::Restart(None),
            },
            [_, _, .., 0x07] => Step::Done(None),
            [_, _, .., ESC] => Step::Restart(None),
            [_, letter, 0..b' '] => Step::Restart(Some(of_byte(letter, KeyModifiers::ALT))),
            [.., 0..b' '] => Step::Restart(None),
            _ => Step::Unfinished,
        }
    }
}

/// Whether a letter after Esc begins a text reply.
fn is_text(byte: u8) -> bool {
    matches!(byte, b']' | b'P' | b'X' | b'^' | b'_')
}

/// Number of bytes at the end of a paste that may begin its end mark.
fn part_of_end(paste: &[u8]) -> usize {
    (1..PASTE_END.len()).rev().find(|&count| paste.ends_with(&PASTE_END[..count])).unwrap_or(0)
}

fn pasted(bytes: &[u8]) -> Input {
    Input::Paste(String::from_utf8_lossy(bytes).into_owned())
}

/// A character of several bytes.
fn in_letter(bytes: &[u8], modifiers: KeyModifiers) -> Step {
    match str::from_utf8(bytes) {
        Ok(text) => Step::Done(text.chars().next().map(|letter| of_letter(letter, modifiers))),
        Err(error) if error.error_len().is_none() => Step::Unfinished,
        Err(_) if bytes.len() > 1 => Step::Restart(None),
        Err(_) => Step::Done(None),
    }
}

fn of_byte(byte: u8, modifiers: KeyModifiers) -> Input {
    let ctrl = modifiers | KeyModifiers::CONTROL;
    let key = match byte {
        b'\r' => KeyEvent::new(KeyCode::Enter, modifiers),
        b'\t' => KeyEvent::new(KeyCode::Tab, modifiers),
        0x7f => KeyEvent::new(KeyCode::Backspace, modifiers),
        0 => KeyEvent::new(KeyCode::Char(' '), ctrl),
        1..=0x1a => KeyEvent::new(KeyCode::Char((byte + b'a' - 1).into()), ctrl),
        0x1c..=0x1f => KeyEvent::new(KeyCode::Char((byte - 0x1c + b'4').into()), ctrl),
        _ => return of_letter(byte.into(), modifiers),
    };
    Input::Key(key)
}

fn of_letter(letter: char, modifiers: KeyModifiers) -> Input {
    Input::Key(KeyEvent::new(KeyCode::Char(letter), modifiers))
}

/// `Esc [`, the parameters and a final letter.
fn csi(parameters: &[u8], last: u8) -> Option<Input> {
    let text = str::from_utf8(parameters).ok()?;
    let report = |text: &str, offset: u8| {
        let mut parts = text.split(';');
        let button = parts.next()?.parse::<u8>().ok().and_then(|code| code.checked_sub(offset));
        let mut place = || parts.next()?.parse().ok();
        mouse(button, [place(), place()])
    };
    if let Some(text) = text.strip_prefix('<') {
        // A report with a small m is of a released button.
        return if last == b'M' { report(text, 0) } else { None };
    }
    if text == "[" {
        let number = last.checked_sub(b'A').filter(|&number| number < 5)?;
        return Some(Input::Key(KeyCode::F(1 + number).into()));
    }
    if !text.chars().all(|letter| letter.is_ascii_digit() || ";:".contains(letter)) {
        return None;
    }
    let parts: Vec<&str> = text.split(';').collect();
    let modifiers = held(parts.get(1).copied());
    match last {
        b'M' => report(text, 32),
        b'u' => key(of_number(parts[0], modifiers?)?, modifiers),
        b'~' if parts[0] == "27" => key(of_number(parts.get(2)?, modifiers?)?, modifiers),
        b'~' => key(numbered(parts[0])?, modifiers),
        b'Z' => key(KeyCode::BackTab, Some(KeyModifiers::SHIFT)),
        // The position of the cursor.
        b'R' => None,
        _ => lettered(&parts, last),
    }
}

/// `Esc O`, the parameters and a final letter.
fn ss3(parameters: &[u8], last: u8) -> Option<Input> {
    lettered(&str::from_utf8(parameters).ok()?.split(';').collect::<Vec<_>>(), last)
}

fn lettered(parts: &[&str], last: u8) -> Option<Input> {
    let code = match last {
        b'A' => KeyCode::Up,
        b'B' => KeyCode::Down,
        b'C' => KeyCode::Right,
        b'D' => KeyCode::Left,
        b'F' => KeyCode::End,
        b'H' => KeyCode::Home,
        b'P'..=b'S' => KeyCode::F(1 + last - b'P'),
        _ => return None,
    };
    // Old terminals omit the first parameter, which is 1.
    key(code, held(parts.get(1).or(parts.first()).copied()))
}

fn numbered(number: &str) -> Option<KeyCode> {
    Some(match number.parse::<u8>().ok()? {
        1 | 7 => KeyCode::Home,
        2 => KeyCode::Insert,
        3 => KeyCode::Delete,
        4 | 8 => KeyCode::End,
        5 => KeyCode::PageUp,
        6 => KeyCode::PageDown,
        number @ 11..=15 => KeyCode::F(number - 10),
        number @ 17..=21 => KeyCode::F(number - 11),
        number @ 23..=24 => KeyCode::F(number - 12),
        _ => return None,
    })
}

/// A key from the number of its character.
fn of_number(number: &str, held: KeyModifiers) -> Option<KeyCode> {
    Some(match number.split(':').next()?.parse::<u32>().ok()? {
        0x1b => KeyCode::Esc,
        0x0d => KeyCode::Enter,
        0x09 if held.contains(KeyModifiers::SHIFT) => KeyCode::BackTab,
        0x09 => KeyCode::Tab,
        0x7f => KeyCode::Backspace,
        57344..=63743 => return None,
        number => KeyCode::Char(char::from_u32(number)?),
    })
}

fn key(code: KeyCode, held: Option<KeyModifiers>) -> Option<Input> {
    Some(Input::Key(KeyEvent::new(code, held?)))
}

/// Parses `modifiers:kind`, where modifiers are bits plus one; `None` for a released key.
fn held(parameter: Option<&str>) -> Option<KeyModifiers> {
    const BITS: [(u8, KeyModifiers); 3] =
        [(1, KeyModifiers::SHIFT), (2, KeyModifiers::ALT), (4, KeyModifiers::CONTROL)];
    let mut parts = parameter.unwrap_or_default().split(':');
    let mask = match parts.next() {
        None | Some("") => 0,
        Some(mask) => mask.parse::<u8>().ok()?.saturating_sub(1),
    };
    let held = BITS.iter().filter(|(bit, _)| mask & bit != 0);
    (parts.next() != Some("3")).then(|| held.map(|&(_, modifier)| modifier).collect())
}

/// A click or a step of the wheel, with Shift, Alt or Ctrl; the first column is 1 in a report.
fn mouse(button: Option<u8>, [column, row]: [Option<u16>; 2]) -> Option<Input> {
    let kind = match button? & !0b1_1100 {
        0 => MouseEventKind::Down(MouseButton::Left),
        64 => MouseEventKind::ScrollUp,
        65 => MouseEventKind::ScrollDown,
        _ => return None,
    };
    let (column, row) = (column?.checked_sub(1)?, row?.checked_sub(1)?);
    Some(Input::Mouse(MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE }))
}

#[cfg(test)]
mod tests;
