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

use nix::sys::signal::{SigSet, Signal};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use signal_hook::low_level::raise;

use super::events::Event;
use super::terminal::{expect_end, give_back_by_force};

/// Signals that neither end the process nor tell it anything, or whose handler is elsewhere: those
/// of a write beyond a limit and to a closed pipe.
const OTHERS: [Signal; 6] = [
    Signal::SIGCHLD,
    Signal::SIGPIPE,
    Signal::SIGTTIN,
    Signal::SIGTTOU,
    Signal::SIGURG,
    Signal::SIGXFSZ,
];
/// Signals after which the workbench goes on.
const PASSING: [Signal; 3] = [Signal::SIGTSTP, Signal::SIGCONT, Signal::SIGWINCH];
/// So long may the workbench take to end.
const GRACE: Duration = Duration::from_millis(700);
/// A shell adds this to the number of the signal that ended a program.
const SIGNALLED: i32 = 128;
/// The exit code where the terminal is gone.
pub(super) const TERMINAL_LOST: u8 = 5;

type LastWords = Arc<dyn Fn() + Send + Sync>;

/// The signals that threads of this process do not get, so that one thread can read them.
#[derive(Clone, Copy)]
pub(super) struct HeldSignals {
    deadly: SigSet,
    passing: SigSet,
}

/// Blocks the signals in this thread and in all that it starts later.
pub(super) fn hold_signals() -> io::Result<HeldSignals> {
    let passing: SigSet = PASSING.into_iter().collect();
    let deadly = deadly();
    deadly.thread_block()?;
    passing.thread_block()?;
    Ok(HeldSignals { deadly, passing })
}

fn deadly() -> SigSet {
    let mut deadly = SigSet::all();
    for signal in OTHERS.into_iter().chain(PASSING) {
        deadly.remove(signal);
    }
    deadly
}

/// Waits for signals and for the end of the terminal, each in a thread that sleeps. `last_words`
/// run before anything else on the way to the end.
pub(super) fn listen(
    signals: HeldSignals,
    sender: &SyncSender<Event>,
    last_words: impl Fn() + Send + Sync + 'static,
) -> io::Result<()> {
    let HeldSignals { deadly, passing } = signals;
    let last_words: LastWords = Arc::new(last_words);
    let (words, to_end) = (Arc::clone(&last_words), sender.clone());
    for_each_signal("signals", deadly, move |signal| {
        end(&words, &to_end, &Event::Signal(signal))
    })?;
    let to_pass = sender.clone();
    // In a thread of its own: a workbench that is stuck takes no event, and must still end.
    for_each_signal("stops", passing, move |signal| {
        to_pass.send(Event::Signal(signal)).is_ok()
    })?;
    let gone = sender.clone();
    // Whoever is not of the terminal's session has no signal when it goes.
    thread::Builder::new()
        .name("line".to_owned())
        .spawn(move || {
            if is_gone() {
                end(&last_words, &gone, &Event::Lost);
            }
        })?;
    Ok(())
}

/// Ends the process by the signal, so that its parent sees which one it was.
pub(super) fn die_of(signal: i32) -> ! {
    // Rust's own handler takes the first SIGSEGV or SIGBUS, and then leaves the next to the system.
    for _ in 0..2 {
        drop(raise(signal));
        let _ = deadly().thread_unblock();
    }
    // Where the signal is ignored, as SIGHUP below `nohup`.
    process::exit(SIGNALLED + signal)
}

#[cfg(target_os = "linux")]
fn for_each_signal(
    name: &str,
    signals: SigSet,
    act: impl Fn(i32) -> bool + Send + 'static,
) -> io::Result<()> {
    use nix::sys::signalfd::{SfdFlags, SignalFd};

    let queue = SignalFd::with_flags(&signals, SfdFlags::SFD_CLOEXEC)?;
    let read = move || {
        loop {
            match queue.read_signal() {
                Ok(Some(signal)) if !act(i32::try_from(signal.ssi_signo).unwrap_or(0)) => return,
                Ok(_) | Err(nix::errno::Errno::EINTR) => {}
                Err(_) => return,
            }
        }
    };
    thread::Builder::new().name(name.to_owned()).spawn(read)?;
    Ok(())
}

#[cfg(not(target_os = "linux"))]
fn for_each_signal(
    name: &str,
    signals: SigSet,
    act: impl Fn(i32) -> bool + Send + 'static,
) -> io::Result<()> {
    // Some systems drop a signal that nobody handles even while it is blocked.
    for signal in PASSING {
        signal_hook::flag::register(signal as i32, Arc::default())?;
    }
    let read = move || {
        while let Ok(signal) = signals.wait() {
            if !act(signal as i32) {
                return;
            }
        }
    };
    thread::Builder::new().name(name.to_owned()).spawn(read)?;
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

/// Waits until nobody is at the other end any more.
fn is_gone() -> bool {
    let stdin = io::stdin();
    loop {
        // `poll` reports a hang-up even without requested events; keys are left to the reader.
        let mut line = [PollFd::new(&stdin, PollFlags::empty())];
        match poll(&mut line, None::<&Timespec>) {
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
