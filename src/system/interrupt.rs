//! Ctrl-C of the commands: heeded by work that takes long, and the end of the program otherwise.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

use signal_hook::consts::SIGINT;

/// The state of Ctrl-C in this process.
struct CtrlC {
    was_pressed: Arc<AtomicBool>,
    /// Whether Ctrl-C ends the program, because no work heeds it.
    is_default: Arc<AtomicBool>,
}

static CTRL_C: LazyLock<CtrlC> = LazyLock::new(|| {
    let state = CtrlC {
        was_pressed: Arc::default(),
        is_default: Arc::new(AtomicBool::new(true)),
    };
    let is_default = Arc::clone(&state.is_default);
    // Where the system refuses, Ctrl-C ends the program as it always does.
    if signal_hook::flag::register_conditional_default(SIGINT, is_default).is_ok() {
        drop(signal_hook::flag::register(
            SIGINT,
            Arc::clone(&state.was_pressed),
        ));
    }
    state
});

/// Work that heeds Ctrl-C by itself, so that it can remove its progress bar.
pub(crate) struct Interrupt(&'static CtrlC);

impl Interrupt {
    /// Ctrl-C does not end the program until this is dropped.
    pub(crate) fn heeded() -> Interrupt {
        let state = &*CTRL_C;
        state.was_pressed.store(false, Ordering::Relaxed);
        state.is_default.store(false, Ordering::Relaxed);
        Interrupt(state)
    }

    /// Whether the work continues.
    pub(crate) fn go_on(&self) -> bool {
        !self.0.was_pressed.load(Ordering::Relaxed)
    }

    /// Ends the program as Ctrl-C does, so that its caller sees the cause.
    pub(crate) fn end() {
        drop(signal_hook::low_level::emulate_default_handler(SIGINT));
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        self.0.is_default.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ctrl_c_ends_the_program_again_once_no_work_heeds_it() {
        for _ in 0..2 {
            let interrupt = Interrupt::heeded();
            assert!(interrupt.go_on());
            signal_hook::low_level::raise(SIGINT).expect("a signal");
            assert!(!interrupt.go_on());
            assert!(!CTRL_C.is_default.load(Ordering::Relaxed));
            drop(interrupt);
            assert!(CTRL_C.is_default.load(Ordering::Relaxed));
        }
    }
}
