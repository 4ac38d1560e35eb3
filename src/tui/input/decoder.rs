//! Splits the bytes of the terminal into keys, sequences and pastes. An unfinished sequence never
//! delays later keys: a timeout, the next Esc or a control character ends it.

use std::mem;
use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyModifiers};

use super::sequence;

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

#[derive(Debug, Default)]
pub(super) struct Decoder {
    state: State,
    /// The bytes since the state began.
    bytes: Vec<u8>,
    /// Timeout for the next byte of the state.
    patience: Duration,
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

impl Decoder {
    /// Timeout for the next byte; `None` if nothing is unfinished.
    pub(super) fn patience(&self) -> Option<Duration> {
        (self.state != State::Ground).then_some(self.patience)
    }

    pub(super) fn has_waited(&mut self, time: Duration) {
        self.patience = self.patience.saturating_sub(time);
    }

    /// Decodes the bytes of one read. `is_full` if more bytes may be ready.
    pub(super) fn feed(&mut self, bytes: &[u8], is_full: bool, inputs: &mut Vec<Event>) {
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
    pub(super) fn expire(&mut self, inputs: &mut Vec<Event>) {
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
                self.after_escape(byte, is_apart, ends_text, inputs)
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
                inputs.extend(sequence::csi(&self.bytes, byte));
                self.enter(State::Ground, Duration::ZERO);
            }
            _ => self.restart(byte, inputs),
        }
    }

    fn in_ss3(&mut self, byte: u8, inputs: &mut Vec<Event>) {
        match byte {
            b'0'..=b'9' | b';' => self.keep(byte),
            b'@'..=b'~' => {
                inputs.extend(sequence::ss3(&self.bytes, byte));
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
            inputs.extend(sequence::mouse(button, column, row));
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

#[cfg(test)]
mod tests;
