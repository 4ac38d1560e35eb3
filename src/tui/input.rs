//! Reads the terminal: keys, mouse reports and pastes, in a thread that sleeps until bytes arrive.

mod decoder;
mod sequence;

use std::io::{self, ErrorKind};
use std::thread;
use std::time::{Duration, Instant};

use crossterm::event::Event;

use crate::system::terminal::{Input, is_in_foreground, read, wait_for_input};
use decoder::Decoder;

/// Less than the terminal's own buffer, so that a full read means that more bytes are ready.
const BUFFER: usize = 1024;
/// Polling interval while the shell is in the foreground.
const BACKGROUND: Duration = Duration::from_millis(50);

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
