//! Reads the terminal: keys, mouse reports and pastes, in a thread that sleeps until bytes arrive.
//! An unfinished sequence never delays later keys.
//!
//! The reader of crossterm keeps such a sequence for ever: after `ESC [ ? 2026 ; 2 $ y`, `ESC [ <` or
//! a paste without an end, it takes every key, also Ctrl-Q, as a part of it.

use std::io::{self, ErrorKind};
use std::mem;
use std::thread;
use std::time::{Duration, Instant};

use crossterm::event::{
    Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, MouseButton, MouseEvent, MouseEventKind,
};

use crate::system::terminal::{Input, is_in_foreground, read, wait_for_input};

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
const PASTE_START: (&[u8], u8) = (b"200", b'~');
const PASTE_END: &[u8] = b"\x1b[201~";

const ESC: u8 = 0x1b;
const BELL: u8 = 0x07;

/// Reads the terminal and passes each input to `send`, until `send` returns false or the terminal
/// closes.
pub(super) fn read_all(mut send: impl FnMut(Event) -> bool) {
    let stdin = io::stdin();
    let mut decoder = Decoder::default();
    let mut buffer = [0; BUFFER];
    let mut inputs = Vec::new();
    loop {
        let start = Instant::now();
        match wait_for_input(&stdin, decoder.patience()) {
            Ok(Input::None) => decoder.expire(&mut inputs),
            // The shell is in the foreground: a read would stop the process.
            Ok(Input::Ready) if !is_in_foreground() => {
                thread::sleep(BACKGROUND);
            }
            Ok(state) => {
                decoder.has_waited(start.elapsed());
                match read(&stdin, &mut buffer) {
                    Ok(0) if state == Input::HungUp => return,
                    Ok(count) => decoder.feed(&buffer[..count], count == BUFFER, &mut inputs),
                    Err(error) if is_passing(&error) => {}
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

fn is_passing(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::WouldBlock)
}

#[derive(Debug, Default)]
struct Decoder {
    state: State,
    /// The bytes since the state began.
    bytes: Vec<u8>,
    /// Timeout for the next byte of the state.
    patience: Duration,
}

impl Decoder {
    /// Timeout for the next byte; `None` if nothing is unfinished.
    fn patience(&self) -> Option<Duration> {
        (self.state != State::Ground).then_some(self.patience)
    }

    fn has_waited(&mut self, time: Duration) {
        self.patience = self.patience.saturating_sub(time);
    }

    /// Decodes the bytes of one read. `is_full` if more bytes may be ready.
    fn feed(&mut self, bytes: &[u8], is_full: bool, inputs: &mut Vec<Event>) {
        if self.is_key_after_a_paste(bytes) {
            self.expire(inputs);
        }
        for &byte in bytes {
            self.take(byte, inputs);
        }
        if let State::Escape { is_apart, .. } = &mut self.state {
            *is_apart |= !is_full;
        }
    }

    /// Pastes arrive in bulk. In a paste without an end, a control character that arrives alone
    /// after a pause is a key, such as Ctrl-Q.
    fn is_key_after_a_paste(&self, bytes: &[u8]) -> bool {
        let has_paused = self.patience + SEQUENCE <= PASTE;
        let is_key = matches!(bytes, [0..=0x08 | 0x0b | 0x0c | 0x0e..=0x1a | 0x1c..=0x1f]);
        self.state == State::Paste { matched: 0 } && has_paused && is_key
    }

    /// Ends the unfinished sequence after its timeout.
    fn expire(&mut self, inputs: &mut Vec<Event>) {
        let bytes = mem::take(&mut self.bytes);
        match mem::take(&mut self.state) {
            State::Escape { .. } => inputs.push(plain(KeyCode::Esc)),
            // No sequence ends after its first letter: the user pressed Alt.
            State::Csi if bytes.is_empty() => inputs.push(with_alt(b'[')),
            State::Ss3 if bytes.is_empty() => inputs.push(with_alt(b'O')),
            State::Text { introducer } if bytes.is_empty() => inputs.push(with_alt(introducer)),
            // A single Esc is a key.
            State::Paste { .. } => inputs.push(paste(&bytes)),
            _ => {}
        }
    }

    fn take(&mut self, byte: u8, inputs: &mut Vec<Event>) {
        match self.state {
            State::Ground => self.begin(byte, KeyModifiers::NONE, inputs),
            State::Escape { is_apart, ends_text } => {
                self.after_escape(byte, is_apart, ends_text, inputs);
            }
            State::Letter { modifiers } => self.in_letter(byte, modifiers, inputs),
            State::Csi => self.in_csi(byte, inputs),
            State::Ss3 => self.in_ss3(byte, inputs),
            State::Mouse => self.in_mouse(byte, inputs),
            State::Text { introducer } => self.in_text(byte, introducer, inputs),
            State::Paste { matched } => self.in_paste(byte, matched, inputs),
        }
    }

    fn enter(&mut self, state: State, patience: Duration) {
        self.bytes.clear();
        self.state = state;
        self.patience = patience;
    }

    /// Drops the unfinished sequence; the byte begins a new state.
    fn restart(&mut self, byte: u8, inputs: &mut Vec<Event>) {
        self.enter(State::Ground, Duration::ZERO);
        self.take(byte, inputs);
    }

    fn keep(&mut self, byte: u8) {
        self.bytes.push(byte);
        if self.bytes.len() > LONGEST_SEQUENCE {
            self.enter(State::Ground, Duration::ZERO);
        }
    }

    fn begin(&mut self, byte: u8, modifiers: KeyModifiers, inputs: &mut Vec<Event>) {
        match byte {
            ESC => {
                let state = State::Escape { is_apart: false, ends_text: false };
                self.enter(state, ESCAPE);
            }
            0x80.. => {
                self.enter(State::Letter { modifiers }, SEQUENCE);
                self.in_letter(byte, modifiers, inputs);
            }
            _ => {
                self.enter(State::Ground, Duration::ZERO);
                inputs.push(of_byte(byte, modifiers));
            }
        }
    }

    fn after_escape(&mut self, byte: u8, apart: bool, ends_text: bool, inputs: &mut Vec<Event>) {
        match byte {
            b'[' => self.enter(State::Csi, SEQUENCE),
            b'O' => self.enter(State::Ss3, SEQUENCE),
            b'\\' if ends_text => self.enter(State::Ground, Duration::ZERO),
            _ if apart || byte == ESC => {
                inputs.push(plain(KeyCode::Esc));
                self.restart(byte, inputs);
            }
            b']' | b'P' | b'X' | b'^' | b'_' => {
                self.enter(State::Text { introducer: byte }, SEQUENCE);
            }
            _ => self.begin(byte, KeyModifiers::ALT, inputs),
        }
    }

    fn in_letter(&mut self, byte: u8, modifiers: KeyModifiers, inputs: &mut Vec<Event>) {
        self.bytes.push(byte);
        match str::from_utf8(&self.bytes) {
            Ok(text) => {
                inputs.extend(text.chars().map(|letter| of_letter(letter, modifiers)));
                self.enter(State::Ground, Duration::ZERO);
            }
            Err(error) if error.error_len().is_none() => {}
            Err(_) if self.bytes.len() > 1 => self.restart(byte, inputs),
            Err(_) => self.enter(State::Ground, Duration::ZERO),
        }
    }

    fn in_csi(&mut self, byte: u8, inputs: &mut Vec<Event>) {
        match byte {
            b'M' if self.bytes.is_empty() => self.enter(State::Mouse, SEQUENCE),
            // A function key of the Linux console.
            b'[' if self.bytes.is_empty() => self.keep(byte),
            b' '..=b'?' => self.keep(byte),
            b'@'..=b'~' if (&*self.bytes, byte) == PASTE_START => {
                self.enter(State::Paste { matched: 0 }, PASTE);
            }
            b'@'..=b'~' => {
                inputs.extend(csi(&self.bytes, byte));
                self.enter(State::Ground, Duration::ZERO);
            }
            _ => self.restart(byte, inputs),
        }
    }

    fn in_ss3(&mut self, byte: u8, inputs: &mut Vec<Event>) {
        match byte {
            b'0'..=b'9' | b';' => self.keep(byte),
            b'@'..=b'~' => {
                inputs.extend(ss3(&self.bytes, byte));
                self.enter(State::Ground, Duration::ZERO);
            }
            _ => self.restart(byte, inputs),
        }
    }

    fn in_mouse(&mut self, byte: u8, inputs: &mut Vec<Event>) {
        if byte < b' ' {
            return self.restart(byte, inputs);
        }
        self.keep(byte);
        if let [button, column, row] = self.bytes[..] {
            inputs.extend(mouse(button, column, row));
            self.enter(State::Ground, Duration::ZERO);
        }
    }

    fn in_text(&mut self, byte: u8, introducer: u8, inputs: &mut Vec<Event>) {
        match byte {
            BELL => self.enter(State::Ground, Duration::ZERO),
            ESC => {
                let state = State::Escape { is_apart: false, ends_text: true };
                self.enter(state, ESCAPE);
            }
            0..b' ' if self.bytes.is_empty() => {
                inputs.push(with_alt(introducer));
                self.restart(byte, inputs);
            }
            0..b' ' => self.restart(byte, inputs),
            _ => self.keep(byte),
        }
    }

    fn in_paste(&mut self, byte: u8, matched: usize, inputs: &mut Vec<Event>) {
        let is_next = PASTE_END.get(matched) == Some(&byte);
        let matched = if is_next {
            matched + 1
        } else {
            self.paste(&PASTE_END[..matched]);
            if byte != ESC {
                self.paste(&[byte]);
            }
            usize::from(byte == ESC)
        };
        if matched == PASTE_END.len() {
            inputs.push(paste(&self.bytes));
            self.enter(State::Ground, Duration::ZERO);
            return;
        }
        self.state = State::Paste { matched };
        self.patience = if matched == 1 { SEQUENCE } else { PASTE };
    }

    fn paste(&mut self, bytes: &[u8]) {
        let room = LONGEST_PASTE.saturating_sub(self.bytes.len());
        self.bytes.extend(&bytes[..bytes.len().min(room)]);
    }
}

/// `Esc [ M` and three bytes.
fn mouse(button: u8, column: u8, row: u8) -> Option<Event> {
    let place = |byte: u8| byte.checked_sub(33).map(u16::from);
    at(button.checked_sub(32)?, place(column)?, place(row)?)
}

#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
enum State {
    #[default]
    Ground,
    /// After Esc.
    Escape {
        /// A read ended with the Esc: a following letter is a key of its own.
        is_apart: bool,
        /// The Esc may begin the terminator of a text.
        ends_text: bool,
    },
    /// Inside a character of several bytes.
    Letter { modifiers: KeyModifiers },
    /// After `Esc [`.
    Csi,
    /// After `Esc O`.
    Ss3,
    /// After `Esc [ M`: button, column and row, one byte each.
    Mouse,
    /// Inside a text reply: from `Esc ]`, `Esc P`, `Esc X`, `Esc ^` or `Esc _` on.
    Text { introducer: u8 },
    /// Inside a paste, with the number of bytes that match its end.
    Paste { matched: usize },
}

fn paste(bytes: &[u8]) -> Event {
    Event::Paste(String::from_utf8_lossy(bytes).into_owned())
}

fn plain(code: KeyCode) -> Event {
    Event::Key(code.into())
}

fn with_alt(letter: u8) -> Event {
    of_letter(letter.into(), KeyModifiers::ALT)
}

fn of_byte(byte: u8, modifiers: KeyModifiers) -> Event {
    let ctrl = modifiers | KeyModifiers::CONTROL;
    let key = match byte {
        b'\r' => KeyEvent::new(KeyCode::Enter, modifiers),
        b'\t' => KeyEvent::new(KeyCode::Tab, modifiers),
        0x7f => KeyEvent::new(KeyCode::Backspace, modifiers),
        0 => KeyEvent::new(KeyCode::Char(' '), ctrl),
        1..=0x1a => KeyEvent::new(KeyCode::Char((byte + b'a' - 1).into()), ctrl),
        ESC => KeyEvent::new(KeyCode::Esc, modifiers),
        0x1c..=0x1f => KeyEvent::new(KeyCode::Char((byte - 0x1c + b'4').into()), ctrl),
        _ => return of_letter(byte.into(), modifiers),
    };
    Event::Key(key)
}

fn of_letter(letter: char, modifiers: KeyModifiers) -> Event {
    let shift = if letter.is_uppercase() { KeyModifiers::SHIFT } else { KeyModifiers::NONE };
    Event::Key(KeyEvent::new(KeyCode::Char(letter), modifiers | shift))
}

/// `Esc [`, the parameters and a final letter.
fn csi(parameters: &[u8], last: u8) -> Option<Event> {
    let text = str::from_utf8(parameters).ok()?;
    if let Some(report) = text.strip_prefix('<') {
        return sgr_mouse(report, last);
    }
    if text == "[" {
        let number = last.checked_sub(b'A').filter(|&number| number < 5)?;
        return Some(Event::Key(KeyCode::F(1 + number).into()));
    }
    let is_plain = |letter: char| letter.is_ascii_digit() || ";:".contains(letter);
    if !text.chars().all(is_plain) {
        return None;
    }
    let parts: Vec<&str> = text.split(';').collect();
    match last {
        b'M' => rxvt_mouse(&parts),
        b'u' => key(code_of(parts[0], held(parts.get(1))?.0)?, parts.get(1)),
        b'~' if parts[0] == "27" => {
            key(code_of(parts.get(2)?, held(parts.get(1))?.0)?, parts.get(1))
        }
        b'~' => key((numbered(parts[0])?, KeyModifiers::NONE), parts.get(1)),
        b'Z' => Some(Event::Key(KeyEvent::new(KeyCode::BackTab, KeyModifiers::SHIFT))),
        // The position of the cursor.
        b'R' => None,
        _ => lettered(&parts, last),
    }
}

/// `Esc O`, the parameters and a final letter.
fn ss3(parameters: &[u8], last: u8) -> Option<Event> {
    let text = str::from_utf8(parameters).ok()?;
    lettered(&text.split(';').collect::<Vec<_>>(), last)
}

fn lettered(parts: &[&str], last: u8) -> Option<Event> {
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
    let held = parts.get(1).or(parts.first().filter(|part| !part.is_empty()));
    key((code, KeyModifiers::NONE), held)
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
        number @ 23..=26 => KeyCode::F(number - 12),
        number @ 28..=29 => KeyCode::F(number - 13),
        number @ 31..=34 => KeyCode::F(number - 14),
        _ => return None,
    })
}

/// A key from its number in Unicode or in the kitty protocol, and the modifiers that its character
/// already includes.
fn code_of(number: &str, held: KeyModifiers) -> Option<(KeyCode, KeyModifiers)> {
    let mut numbers = number.split(':').map(|number| number.parse::<u32>().ok());
    let code = match numbers.next()?? {
        0x1b => KeyCode::Esc,
        0x0d => KeyCode::Enter,
        0x09 if held.contains(KeyModifiers::SHIFT) => KeyCode::BackTab,
        0x09 => KeyCode::Tab,
        0x7f => KeyCode::Backspace,
        number @ 57376..=57398 => KeyCode::F(u8::try_from(number - 57376 + 13).ok()?),
        number @ 57399..=57427 => keypad(number - 57399)?,
        57344..=63743 => return None,
        number => KeyCode::Char(char::from_u32(number)?),
    };
    let shifted = numbers.next().flatten().and_then(char::from_u32);
    Some(match shifted {
        Some(letter) if held.contains(KeyModifiers::SHIFT) => {
            (KeyCode::Char(letter), KeyModifiers::SHIFT)
        }
        _ => (code, KeyModifiers::NONE),
    })
}

fn keypad(number: u32) -> Option<KeyCode> {
    use KeyCode::{Delete, Down, End, Enter, Home, Insert, Left, PageDown, PageUp, Right, Up};
    const MOVES: [KeyCode; 10] =
        [Left, Right, Up, Down, PageUp, PageDown, Home, End, Insert, Delete];
    let number = usize::try_from(number).ok()?;
    match number {
        15 => Some(Enter),
        18.. => MOVES.get(number - 18).copied(),
        _ => "0123456789./*-+\n=,".chars().nth(number).map(KeyCode::Char),
    }
}

/// A key with the modifiers of a parameter, without those that its character already includes.
fn key((code, shown): (KeyCode, KeyModifiers), parameter: Option<&&str>) -> Option<Event> {
    let (modifiers, kind) = held(parameter)?;
    let key = KeyEvent::new_with_kind(code, modifiers - shown, kind);
    Some(Event::Key(key))
}

/// Parses `modifiers:kind`, where modifiers are bits plus one. Locks are ignored.
fn held(parameter: Option<&&str>) -> Option<(KeyModifiers, KeyEventKind)> {
    const BITS: [KeyModifiers; 6] = [
        KeyModifiers::SHIFT,
        KeyModifiers::ALT,
        KeyModifiers::CONTROL,
        KeyModifiers::SUPER,
        KeyModifiers::HYPER,
        KeyModifiers::META,
    ];
    let mut parts = parameter.copied().unwrap_or_default().split(':');
    let mask = match parts.next() {
        None | Some("") => 0,
        Some(mask) => mask.parse::<u8>().ok()?.saturating_sub(1),
    };
    let kind = match parts.next() {
        Some("2") => KeyEventKind::Repeat,
        Some("3") => KeyEventKind::Release,
        _ => KeyEventKind::Press,
    };
    let bits = BITS.iter().enumerate();
    let held = bits.filter(|(bit, _)| mask & (1 << bit) != 0);
    Some((held.map(|(_, &modifier)| modifier).collect(), kind))
}

fn rxvt_mouse(parts: &[&str]) -> Option<Event> {
    let (button, column, row) = report(parts)?;
    at(button.checked_sub(32)?, column, row)
}

fn sgr_mouse(text: &str, last: u8) -> Option<Event> {
    let (button, column, row) = report(&text.split(';').collect::<Vec<_>>())?;
    let event = at(button, column, row)?;
    match (last, event) {
        (b'M', event) => Some(event),
        (b'm', Event::Mouse(mouse)) => {
            let kind = match mouse.kind {
                MouseEventKind::Down(button) => MouseEventKind::Up(button),
                kind => kind,
            };
            Some(Event::Mouse(MouseEvent { kind, ..mouse }))
        }
        _ => None,
    }
}

/// Button, column and row; the first column is 1 in the report and 0 here.
fn report(parts: &[&str]) -> Option<(u8, u16, u16)> {
    let place = |part: &str| part.parse::<u16>().ok()?.checked_sub(1);
    let [button, column, row, ..] = parts else {
        return None;
    };
    Some((button.parse().ok()?, place(column)?, place(row)?))
}

/// Bits of `button` from the lowest: button (2), Shift, Alt, Ctrl, motion, button (2).
fn at(button: u8, column: u16, row: u16) -> Option<Event> {
    const BITS: [(u8, KeyModifiers); 3] =
        [(4, KeyModifiers::SHIFT), (8, KeyModifiers::ALT), (16, KeyModifiers::CONTROL)];
    let number = (button & 0b11) | ((button & 0b1100_0000) >> 4);
    let moves = button & 0b10_0000 != 0;
    let of = [MouseButton::Left, MouseButton::Middle, MouseButton::Right];
    let kind = match (number, moves) {
        (0..=2, false) => MouseEventKind::Down(of[usize::from(number)]),
        (0..=2, true) => MouseEventKind::Drag(of[usize::from(number)]),
        (3, false) => MouseEventKind::Up(MouseButton::Left),
        (3..=5, true) => MouseEventKind::Moved,
        (4, false) => MouseEventKind::ScrollUp,
        (5, false) => MouseEventKind::ScrollDown,
        (6, false) => MouseEventKind::ScrollLeft,
        (7, false) => MouseEventKind::ScrollRight,
        _ => return None,
    };
    let held = BITS.iter().filter(|(bit, _)| button & bit != 0);
    Some(Event::Mouse(MouseEvent {
        kind,
        column,
        row,
        modifiers: held.map(|&(_, modifier)| modifier).collect(),
    }))
}

#[cfg(test)]
mod tests;
