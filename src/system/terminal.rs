//! The terminal and the signals of the workbench: waits for the terminal, foreground of this
//! process, signals read by dedicated threads, and the end by a signal.

use std::io::{self, Stdin, Stdout};
#[cfg(not(target_os = "linux"))]
use std::sync::Arc;
use std::time::Duration;
use std::{process, thread};

use nix::sys::signal::{SigSet, Signal};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use rustix::process::getpgrp;
use rustix::termios::tcgetpgrp;
pub(crate) use signal_hook::consts::{SIGCONT, SIGTSTP, SIGWINCH};
use signal_hook::low_level::{emulate_default_handler, raise};

/// The state of the terminal after a wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Input {
    /// No bytes and no hang-up.
    None,
    Ready,
    HungUp,
}

/// Whether this process, and not the shell, is in the foreground of the terminal.
pub(crate) fn is_in_foreground() -> bool {
    tcgetpgrp(io::stdin()).map_or(true, |group| group == getpgrp())
}

/// Waits until the terminal has bytes or hangs up, at most for `patience`.
pub(crate) fn wait_for_input(stdin: &Stdin, patience: Option<Duration>) -> io::Result<Input> {
    let patience = patience.and_then(|patience| Timespec::try_from(patience).ok());
    let mut line = [PollFd::new(stdin, PollFlags::IN)];
    Ok(match poll(&mut line, patience.as_ref())? {
        0 => Input::None,
        _ if line[0].revents().contains(PollFlags::HUP) => Input::HungUp,
        _ => Input::Ready,
    })
}

/// Reads the available bytes of the terminal without the buffer of the standard input.
pub(crate) fn read(stdin: &Stdin, buffer: &mut [u8]) -> io::Result<usize> {
    Ok(rustix::io::read(stdin, buffer)?)
}

/// Waits until the terminal hangs up. Returns false if the system cannot report that.
pub(crate) fn wait_for_hang_up(stdin: &Stdin) -> bool {
    loop {
        // `poll` reports a hang-up even without requested events; the reader thread reads the keys.
        let mut line = [PollFd::new(stdin, PollFlags::empty())];
        match poll(&mut line, None::<&Timespec>) {
            Err(Errno::INTR) => {}
            Err(_) => return false,
            Ok(_) => {
                return line[0].revents().intersects(PollFlags::HUP | PollFlags::ERR);
            }
        }
    }
}

/// Writes the bytes if the terminal accepts bytes now. Bypasses the lock of the standard output,
/// because the workbench may hold that lock.
pub(crate) fn write_if_ready(stdout: &Stdout, bytes: &[u8]) {
    let mut line = [PollFd::new(stdout, PollFlags::OUT)];
    if poll(&mut line, Some(&Timespec::default())) == Ok(1) {
        let _ = rustix::io::write(stdout, bytes);
    }
}

/// Signals that neither end the process nor inform it, or that have another handler: the signals of
/// a write beyond a limit and to a closed pipe.
const OTHERS: [Signal; 6] = [
    Signal::SIGCHLD,
    Signal::SIGPIPE,
    Signal::SIGTTIN,
    Signal::SIGTTOU,
    Signal::SIGURG,
    Signal::SIGXFSZ,
];
/// Signals after which the workbench continues.
const PASSING: [Signal; 3] = [Signal::SIGTSTP, Signal::SIGCONT, Signal::SIGWINCH];
/// A shell adds this to the number of the signal that ended a program.
const SIGNALLED: i32 = 128;

/// The blocked signals, which a dedicated thread reads.
#[derive(Clone, Copy)]
pub(crate) struct BlockedSignals {
    /// Those that end the process.
    pub(crate) deadly: SigSet,
    /// Those after which the workbench continues.
    pub(crate) passing: SigSet,
}

/// Blocks the signals in this thread and in all threads that it starts later.
pub(crate) fn hold() -> io::Result<BlockedSignals> {
    let passing: SigSet = PASSING.into_iter().collect();
    let deadly = deadly();
    deadly.thread_block()?;
    passing.thread_block()?;
    Ok(BlockedSignals { deadly, passing })
}

fn deadly() -> SigSet {
    let mut deadly = SigSet::all();
    for signal in OTHERS.into_iter().chain(PASSING) {
        deadly.remove(signal);
    }
    deadly
}

/// Stops this process until the shell continues it.
pub(crate) fn stop() -> io::Result<()> {
    emulate_default_handler(SIGTSTP)
}

/// Ends the process by the signal, so that its parent sees the signal.
pub(crate) fn die_of(signal: i32) -> ! {
    // The handler of Rust consumes the first SIGSEGV or SIGBUS and restores the default action.
    for _ in 0..2 {
        drop(raise(signal));
        let _ = deadly().thread_unblock();
    }
    // The signal is ignored, such as SIGHUP under `nohup`.
    process::exit(SIGNALLED + signal)
}

/// Runs `act` for each of the blocked signals, in a thread of this name, until it returns false.
#[cfg(target_os = "linux")]
pub(crate) fn for_each(
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

/// Runs `act` for each of the blocked signals, in a thread of this name, until it returns false.
#[cfg(not(target_os = "linux"))]
pub(crate) fn for_each(
    name: &str,
    signals: SigSet,
    act: impl Fn(i32) -> bool + Send + 'static,
) -> io::Result<()> {
    // Some systems drop a signal without a handler even while it is blocked.
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
