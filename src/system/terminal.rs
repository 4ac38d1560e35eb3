//! Waits for the terminal, and checks whether this process is in its foreground.

use std::io::{self, Stdin, Stdout};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;
use rustix::process::getpgrp;
use rustix::termios::tcgetpgrp;

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
