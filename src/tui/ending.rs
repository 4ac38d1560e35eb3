//! Ends that come from outside: what is typed is kept first, and nothing that is stuck holds the
//! workbench for long.

use std::io;
use std::process;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::thread;
use std::time::Duration;

use crossterm::terminal::disable_raw_mode;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use signal_hook::consts::{
    SIGCONT, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGUSR1, SIGUSR2, SIGXCPU,
};
use signal_hook::iterator::Signals;

use super::events::Event;

/// Signals that would end the workbench as it stands: by a terminal that is gone, by hand, by a
/// system that needs its time back.
const ENDING: [i32; 7] = [SIGHUP, SIGTERM, SIGINT, SIGQUIT, SIGXCPU, SIGUSR1, SIGUSR2];
/// So long may the workbench take to end.
const GRACE: Duration = Duration::from_millis(700);
/// A program that a signal ends has this and the signal's number as its exit code.
pub(super) const SIGNALLED: i32 = 128;
/// The exit code where the terminal is gone.
pub(super) const TERMINAL_LOST: u8 = 5;

type LastWords = Arc<dyn Fn() + Send + Sync>;

/// Listen to signals, and for the end of the terminal, each in a thread that sleeps until it comes.
/// Whatever ends the workbench is told to `last_words` before anything else.
pub(super) fn listen(
    sender: SyncSender<Event>,
    last_words: impl Fn() + Send + Sync + 'static,
) -> io::Result<()> {
    let last_words: LastWords = Arc::new(last_words);
    let (caught, gone, words) = (sender.clone(), sender, Arc::clone(&last_words));
    let mut signals = Signals::new(ENDING.into_iter().chain([SIGTSTP, SIGCONT]))?;
    thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || {
            for signal in signals.forever() {
                if ENDING.contains(&signal) {
                    end(&words, &caught, Event::Signal(signal), SIGNALLED + signal);
                } else if caught.send(Event::Signal(signal)).is_err() {
                    return;
                }
            }
        })?;
    // Whoever is not of the terminal's session has no signal when it goes.
    thread::Builder::new()
        .name("line".to_owned())
        .spawn(move || {
            if is_gone(None) {
                end(&last_words, &gone, Event::Lost, TERMINAL_LOST.into());
            }
        })?;
    Ok(())
}

// The workbench ends as it should, unless it is stuck, such as in a write to a terminal that takes
// nothing more.
fn end(last_words: &LastWords, sender: &SyncSender<Event>, event: Event, code: i32) {
    last_words();
    if is_gone(Some(&Timespec::default())) {
        hush();
    }
    drop(sender.try_send(event));
    thread::sleep(GRACE);
    drop(disable_raw_mode());
    process::exit(code);
}

/// Whether nobody is at the other end any more, after waiting so long for that.
fn is_gone(patience: Option<&Timespec>) -> bool {
    let stdin = io::stdin();
    loop {
        // The end of a terminal is told without being asked for; its keys are not our business.
        let mut line = [PollFd::new(&stdin, PollFlags::empty())];
        match poll(&mut line, patience) {
            Err(Errno::INTR) => {}
            Err(_) => return false,
            Ok(_) => {
                return line[0]
                    .revents()
                    .intersects(PollFlags::HUP | PollFlags::ERR);
            }
        }
    }
}

// At the end of a terminal the reader of keys would ask for more again and again: it is given a
// line that stays silent.
fn hush() {
    if let Ok((silent, other_end)) = rustix::pipe::pipe() {
        let _ = rustix::stdio::dup2_stdin(silent);
        // Closed, it would be the end once more.
        std::mem::forget(other_end);
    }
}
