//! The end of the process by a signal or a closed terminal. It writes the journal first, restores
//! the terminal, and ends the process by the signal that it received. A blocked main loop delays
//! this only briefly.
//!
//! Every signal that would end the process is blocked in every thread, and one thread reads them. A
//! fault of the process itself is not handled: a real SIGSEGV, a stack overflow, or an abort, such
//! as after a failed allocation, ends the process immediately and leaves the terminal as it is. The
//! journal of the last two seconds is lost then. `reset` repairs the terminal.

use std::io;
use std::process;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::Duration;

use super::events::Event;
use super::terminal::{expect_end, force_restore};
use crate::system::signals::{BlockedSignals, die_of};
use crate::system::terminal::wait_for_hang_up;

/// Time for the main loop to end by itself.
const GRACE: Duration = Duration::from_millis(700);
/// The exit code if the terminal is closed.
pub(super) const TERMINAL_LOST: u8 = 5;

type LastWords = Arc<dyn Fn() + Send + Sync>;

/// Waits for signals and for the end of the terminal, each in a sleeping thread. Calls `last_words`
/// first when the process ends.
pub(super) fn listen(
    signals: BlockedSignals,
    sender: &SyncSender<Event>,
    last_words: impl Fn() + Send + Sync + 'static,
) -> io::Result<()> {
    let last_words: LastWords = Arc::new(last_words);
    let (words, to_end) = (Arc::clone(&last_words), sender.clone());
    signals.for_each_deadly(move |signal| end(&words, &to_end, &Event::Signal(signal)))?;
    let to_pass = sender.clone();
    // A separate thread, because a blocked main loop takes no events and must still end.
    signals.for_each_passing(move |signal| to_pass.send(Event::Signal(signal)).is_ok())?;
    let gone = sender.clone();
    // A process outside the session of the terminal receives no signal when the terminal closes.
    thread::Builder::new().name("line".to_owned()).spawn(move || {
        if wait_for_hang_up(&io::stdin()) {
            end(&last_words, &gone, &Event::Lost);
        }
    })?;
    Ok(())
}

// The main loop ends by itself, unless it is blocked, such as in a write to a terminal that accepts
// no more bytes.
fn end(last_words: &LastWords, sender: &SyncSender<Event>, cause: &Event) -> ! {
    expect_end();
    last_words();
    drop(sender.try_send(cause.clone()));
    thread::sleep(GRACE);
    force_restore();
    match cause {
        Event::Signal(signal) => die_of(*signal),
        _ => process::exit(TERMINAL_LOST.into()),
    }
}
