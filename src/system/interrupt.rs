//! Signals that end the commands, such as Ctrl-C: long work handles them, otherwise they end the
//! program.

use std::fs;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

use signal_hook::consts::{SIGINT, SIGTERM};

/// Signals that end a program by default.
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];
#[cfg(unix)]
const SIGNALS: [i32; 8] = {
    use signal_hook::consts::{SIGALRM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU};
    [SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGALRM, SIGXCPU]
};

/// No signal has this number.
const NONE: usize = 0;

struct Signals {
    received: Arc<AtomicUsize>,
    /// Number of [`Interrupt`]s that handle the signals.
    heeding: AtomicUsize,
    /// Whether a signal ends the program, because no work handles it.
    is_default: Arc<AtomicBool>,
}

static STATE: LazyLock<Signals> = LazyLock::new(|| {
    let state = Signals {
        received: Arc::new(AtomicUsize::new(NONE)),
        heeding: AtomicUsize::new(0),
        is_default: Arc::new(AtomicBool::new(true)),
    };
    for signal in handled() {
        let is_default = Arc::clone(&state.is_default);
        // If the system refuses the handler, the signal still ends the program.
        if signal_hook::flag::register_conditional_default(signal, is_default).is_ok() {
            let received = Arc::clone(&state.received);
            drop(signal_hook::flag::register_usize(signal, received, signal as usize));
        }
    }
    state
});

/// The signals to handle. Those that the caller ignores stay ignored: a handler of SIGHUP would undo
/// `nohup`.
fn handled() -> impl Iterator<Item = i32> {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mut lines = status.lines();
    let ignored = lines.find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok());
    // Bit 0 is SIGHUP.
    let ignored = ignored.unwrap_or(1);
    SIGNALS.into_iter().filter(move |signal| {
        [SIGINT, SIGTERM].contains(signal) || (ignored >> (signal - 1)) & 1 == 0
    })
}

/// Guard of work that handles the signals itself, so that it can remove its progress bar and its
/// temporary file.
pub(crate) struct Interrupt(&'static Signals);

impl Interrupt {
    /// Keeps the signals from ending the program until the last guard is dropped.
    pub(crate) fn install() -> Interrupt {
        let state = &*STATE;
        if state.heeding.fetch_add(1, Ordering::Relaxed) == 0 {
            state.received.store(NONE, Ordering::Relaxed);
        }
        state.is_default.store(false, Ordering::Relaxed);
        Interrupt(state)
    }

    /// Whether the work continues.
    pub(crate) fn go_on(&self) -> bool {
        self.0.received.load(Ordering::Relaxed) == NONE
    }

    /// Whether it was Ctrl-C.
    pub(crate) fn is_ctrl_c(&self) -> bool {
        self.0.received.load(Ordering::Relaxed) == SIGINT as usize
    }

    /// Ends the program by the default action of the signal, so that the caller sees the cause.
    pub(crate) fn end() {
        let received = STATE.received.load(Ordering::Relaxed);
        let signal = SIGNALS.into_iter().find(|&signal| signal as usize == received);
        let signal = signal.unwrap_or(SIGINT);
        drop(signal_hook::low_level::emulate_default_handler(signal));
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        if self.0.heeding.fetch_sub(1, Ordering::Relaxed) == 1 {
            self.0.is_default.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signals_end_the_program_again_once_no_work_heeds_them() {
        for signal in handled() {
            let interrupt = Interrupt::install();
            assert!(interrupt.go_on());
            signal_hook::low_level::raise(signal).expect("a signal");
            assert!(!interrupt.go_on());
            assert_eq!(interrupt.is_ctrl_c(), signal == SIGINT);
            drop(Interrupt::install());
            assert!(!interrupt.go_on() && !STATE.is_default.load(Ordering::Relaxed));
            drop(interrupt);
            assert!(STATE.is_default.load(Ordering::Relaxed));
        }
    }
}
