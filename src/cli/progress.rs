//! What goes on while a command takes long: a progress bar on the error stream, where that is a
//! terminal, and Ctrl-C.

use crate::study::batch::Control;
use crate::system::interrupt::Interrupt;
use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::cell::Cell;
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// How long nothing is shown.
const QUIET: Duration = Duration::from_secs(1);

/// The bar. What is not a terminal sees nothing of it.
pub(super) struct Bar {
    begun: Instant,
    shown: ProgressBar,
    is_up: Cell<bool>,
}

impl Bar {
    /// A bar of so many of these.
    pub(super) fn new(what: &'static str) -> Bar {
        let shown = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {eta} left") {
            shown.set_style(style.progress_chars("=> "));
        }
        shown.set_message(what);
        Bar {
            begun: Instant::now(),
            shown,
            is_up: Cell::new(false),
        }
    }

    /// The same with the rate.
    pub(super) fn with_rate(what: &'static str) -> Bar {
        let bar = Bar::new(what);
        let template = "{bar:30} {human_pos}/{human_len} {msg}, {rate}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
                // A bar that cannot be written is left out.
                let _ = write!(out, "{}/s", HumanCount(state.per_sec() as u64));
            };
            let style = style.with_key("rate", rate);
            bar.shown.set_style(style.progress_chars("=> "));
        }
        bar
    }

    /// Shows how many are done of how many.
    pub(super) fn set(&self, done: usize, of: usize) {
        if !self.is_up.get() {
            if self.begun.elapsed() < QUIET || !io::stderr().is_terminal() {
                return;
            }
            self.is_up.set(true);
            self.shown.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.shown.set_length(of as u64);
        self.shown.set_position(done as u64);
    }

    /// Leave no trace.
    pub(super) fn clear(&self) {
        self.shown.finish_and_clear();
    }

    /// The same after a signal. After Ctrl-C the terminal has written `^C` behind the bar, which
    /// fills its line, and so on the next one.
    pub(super) fn clear_after(&self, interrupt: &Interrupt) {
        const LINE_ABOVE: &[u8] = b"\x1b[A\x1b[2K";
        self.clear();
        if self.is_up.get() && interrupt.is_ctrl_c() {
            drop(io::stderr().write_all(LINE_ABOVE));
        }
    }
}

/// Runs work that reports how many parts of how many are done, with a bar while it takes long. The
/// work stops where the report returns false, and Ctrl-C then ends the program.
pub(super) fn follow<T>(
    what: &'static str,
    work: impl FnOnce(&dyn Fn(usize, usize) -> bool) -> T,
) -> T {
    let (bar, interrupt) = (Bar::new(what), Interrupt::heeded());
    let done = work(&|done, of| {
        bar.set(done, of);
        interrupt.go_on()
    });
    if interrupt.go_on() {
        bar.clear();
    } else {
        bar.clear_after(&interrupt);
        Interrupt::end();
    }
    done
}

/// A study that runs: its threads, its bar and Ctrl-C.
pub(super) struct Running {
    bar: Bar,
    interrupt: Interrupt,
    jobs: Option<usize>,
}

impl Running {
    /// A study of so many threads, whose points have this name.
    pub(super) fn new(what: &'static str, jobs: Option<u16>) -> Running {
        Running {
            bar: Bar::with_rate(what),
            interrupt: Interrupt::heeded(),
            jobs: jobs.map(usize::from),
        }
    }

    /// Runs a part of the study, and shows its progress.
    pub(super) fn run<T, E>(&self, study: impl FnOnce(&Control) -> Result<T, E>) -> Result<T, E> {
        let interrupt = &self.interrupt;
        let done = study(&Control {
            jobs: self.jobs,
            go_on: &|| interrupt.go_on(),
            progress: &|done, of| self.bar.set(done, of),
        });
        if done.is_err() && !self.interrupt.go_on() {
            self.bar.clear_after(&self.interrupt);
        } else {
            self.bar.clear();
        }
        done
    }
}
