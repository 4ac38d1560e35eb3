//! Ends from outside: the journal is written first, the terminal is given back, and the process
//! ends by the signal that it got. A stuck workbench delays none of that for long.
//!
//! Every signal that would end the process is blocked in every thread, and one thread reads them.
//! Nothing catches a fault of the process itself: a real SIGSEGV, a stack that overflows, or an
//! abort, as after a failed allocation, ends it at once and leaves the terminal as it is. The
//! journal of the last two seconds is lost then. `reset` repairs the terminal.

use std::io;
use std::process;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::Duration;

use super::events::Event;
use super::terminal::{expect_end, give_back_by_force};
use crate::system::signals::{HeldSignals, die_of};
use crate::system::terminal::wait_for_hang_up;

/// So long may the workbench take to end.
const GRACE: Duration = Duration::from_millis(700);
/// The exit code where the terminal is gone.
pub(super) const TERMINAL_LOST: u8 = 5;

type LastWords = Arc<dyn Fn() + Send + Sync>;

/// Waits for signals and for the end of the terminal, each in a thread that sleeps. `last_words`
/// run before anything else on the way to the end.
pub(super) fn listen(
    signals: HeldSignals,
    sender: &SyncSender<Event>,
    last_words: impl Fn() + Send + Sync + 'static,
) -> io::Result<()> {
    let last_words: LastWords = Arc::new(last_words);
    let (words, to_end) = (Arc::clone(&last_words), sender.clone());
    signals.for_each_deadly(move |signal| end(&words, &to_end, &Event::Signal(signal)))?;
    let to_pass = sender.clone();
    // In a thread of its own: a workbench that is stuck takes no event, and must still end.
    signals.for_each_passing(move |signal| to_pass.send(Event::Signal(signal)).is_ok())?;
    let gone = sender.clone();
    // Whoever is not of the terminal's session has no signal when it goes.
    thread::Builder::new()
        .name("line".to_owned())
        .spawn(move || {
            if wait_for_hang_up(&io::stdin()) {
                end(&last_words, &gone, &Event::Lost);
            }
        })?;
    Ok(())
}

// The workbench ends by itself, unless it is stuck, such as in a write to a terminal that accepts
// nothing more.
fn end(last_words: &LastWords, sender: &SyncSender<Event>, cause: &Event) -> ! {
    expect_end();
    last_words();
    drop(sender.try_send(cause.clone()));
    thread::sleep(GRACE);
    give_back_by_force();
    match cause {
        Event::Signal(signal) => die_of(*signal),
        _ => process::exit(TERMINAL_LOST.into()),
    }
}
