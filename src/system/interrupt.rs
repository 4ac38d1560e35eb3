//! Ctrl-C and SIGTERM of the commands: long work handles them, otherwise they end the program.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

use signal_hook::consts::{SIGINT, SIGTERM};

/// The handled signals. SIGHUP is not one of them: a handler would undo `nohup`.
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

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
    for signal in SIGNALS {
        let is_default = Arc::clone(&state.is_default);
        // If the system refuses the handler, the signal still ends the program.
        if signal_hook::flag::register_conditional_default(signal, is_default).is_ok() {
            let received = Arc::clone(&state.received);
            drop(signal_hook::flag::register_usize(
                signal,
                received,
                signal as usize,
            ));
        }
    }
    state
});

/// Guard of work that handles Ctrl-C and SIGTERM itself, so that it can remove its progress bar and
/// its temporary file.
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
        let signal = SIGNALS
            .into_iter()
            .find(|&signal| signal as usize == received);
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
        for signal in SIGNALS {
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
