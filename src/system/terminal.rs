//! Waits for the terminal, and which processes the terminal belongs to.

use std::io::{self, Stdin, Stdout};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use rustix::process::getpgrp;
use rustix::termios::tcgetpgrp;

/// The state of the terminal after a wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Input {
    /// Neither bytes nor a hang-up.
    None,
    Ready,
    HungUp,
}

/// Whether the terminal belongs to this process rather than to the shell.
pub(crate) fn is_in_foreground() -> bool {
    tcgetpgrp(io::stdin()).map_or(true, |group| group == getpgrp())
}

/// Waits until the terminal has bytes or hangs up, or until `patience` has passed.
pub(crate) fn wait_for_input(stdin: &Stdin, patience: Option<Duration>) -> io::Result<Input> {
    let patience = patience.and_then(|patience| Timespec::try_from(patience).ok());
    let mut line = [PollFd::new(stdin, PollFlags::IN)];
    Ok(match poll(&mut line, patience.as_ref())? {
        0 => Input::None,
        _ if line[0].revents().contains(PollFlags::HUP) => Input::HungUp,
        _ => Input::Ready,
    })
}

/// Reads the bytes that the terminal has, past the buffer of the standard input.
pub(crate) fn read(stdin: &Stdin, buffer: &mut [u8]) -> io::Result<usize> {
    Ok(rustix::io::read(stdin, buffer)?)
}

/// Waits until nobody is at the other end of the terminal. False if that cannot be known.
pub(crate) fn wait_for_hang_up(stdin: &Stdin) -> bool {
    loop {
        // `poll` reports a hang-up even without requested events; keys are left to the reader.
        let mut line = [PollFd::new(stdin, PollFlags::empty())];
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

/// Writes the bytes if the terminal accepts bytes now, past the lock of the standard output, which
/// the workbench may hold.
pub(crate) fn write_if_ready(stdout: &Stdout, bytes: &[u8]) {
    let mut line = [PollFd::new(stdout, PollFlags::OUT)];
    if poll(&mut line, Some(&Timespec::default())) == Ok(1) {
        let _ = rustix::io::write(stdout, bytes);
    }
}
