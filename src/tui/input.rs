//! Reads the terminal: keys, mouse reports and pastes, in a thread that sleeps until bytes arrive.

mod decoder;
mod sequence;

use std::io;
use std::thread;
use std::time::{Duration, Instant};

use crossterm::event::Event;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, read};

use super::terminal::is_in_foreground;
use decoder::Decoder;

/// Less than the terminal's own buffer, so that a full read means that more bytes are ready.
const BUFFER: usize = 1024;
/// Time between two looks while the shell has the terminal and its keys.
const BACKGROUND: Duration = Duration::from_millis(50);

/// Reads the terminal and passes each input to `send`, until `send` returns false or the terminal
/// is gone.
pub(super) fn read_all(mut send: impl FnMut(Event) -> bool) {
    let stdin = io::stdin();
    let mut decoder = Decoder::default();
    let mut buffer = [0; BUFFER];
    let mut inputs = Vec::new();
    loop {
        let start = Instant::now();
        match wait(&stdin, decoder.patience()) {
            Ok(None) => decoder.expire(&mut inputs),
            // The shell has the terminal: a read would stop the process.
            Ok(Some(state)) if !state.contains(PollFlags::HUP) && !is_in_foreground() => {
                thread::sleep(BACKGROUND);
            }
            Ok(Some(state)) => {
                decoder.has_waited(start.elapsed());
                match read(&stdin, &mut buffer) {
                    Ok(0) if state.contains(PollFlags::HUP) => return,
                    Ok(count) => decoder.feed(&buffer[..count], count == BUFFER, &mut inputs),
                    Err(Errno::INTR | Errno::AGAIN) => {}
                    Err(_) => return,
                }
            }
            Err(Errno::INTR) => {}
            Err(_) => return,
        }
        if !inputs.drain(..).all(&mut send) {
            return;
        }
    }
}

/// The state of the terminal once it has bytes or hangs up; `None` after `patience`.
fn wait(stdin: &io::Stdin, patience: Option<Duration>) -> Result<Option<PollFlags>, Errno> {
    let patience = patience.and_then(|patience| Timespec::try_from(patience).ok());
    let mut line = [PollFd::new(stdin, PollFlags::IN)];
    match poll(&mut line, patience.as_ref()) {
        Ok(0) => Ok(None),
        Ok(_) => Ok(Some(line[0].revents())),
        Err(error) => Err(error),
    }
}
