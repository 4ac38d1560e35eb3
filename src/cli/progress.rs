//! Progress of a long command: a bar on the error stream, if that is a terminal, and Ctrl-C.

use crate::study::batch::Control;
use crate::system::interrupt::Interrupt;
use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::cell::Cell;
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Delay before the bar appears.
const QUIET: Duration = Duration::from_secs(1);

/// A progress bar; it is only shown on a terminal.
pub(super) struct Bar {
    begun: Instant,
    shown: ProgressBar,
    is_up: Cell<bool>,
}

impl Bar {
    /// A bar for parts with a name.
    pub(super) fn new(what: &'static str) -> Bar {
        let shown = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {eta} left") {
            shown.set_style(style.progress_chars("=> "));
        }
        shown.set_message(what);
        Bar { begun: Instant::now(), shown, is_up: Cell::new(false) }
    }

    /// A bar that also shows the rate.
    pub(super) fn with_rate(what: &'static str) -> Bar {
        let bar = Bar::new(what);
        let template = "{bar:30} {human_pos}/{human_len} {msg}, {rate}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
                // Errors of the bar are ignored.
                let _ = write!(out, "{}/s", HumanCount(state.per_sec() as u64));
            };
            let style = style.with_key("rate", rate);
            bar.shown.set_style(style.progress_chars("=> "));
        }
        bar
    }

    /// Shows the number of completed parts and their total.
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

    /// Removes the bar.
    pub(super) fn clear(&self) {
        self.shown.finish_and_clear();
    }

    /// Removes the bar after a signal. After Ctrl-C the terminal appends `^C` to the bar, which
    /// fills its line, so that the cursor is on the next line.
    pub(super) fn clear_after(&self, interrupt: &Interrupt) {
        const LINE_ABOVE: &[u8] = b"\x1b[A\x1b[2K";
        self.clear();
        if self.is_up.get() && interrupt.is_ctrl_c() {
            drop(io::stderr().write_all(LINE_ABOVE));
        }
    }
}

/// Runs work that reports the number of completed parts and their total, with a bar during long
/// work. The work stops if the report returns false, and Ctrl-C then ends the program.
pub(super) fn follow<T>(
    what: &'static str,
    work: impl FnOnce(&dyn Fn(usize, usize) -> bool) -> T,
) -> T {
    let (bar, interrupt) = (Bar::new(what), Interrupt::install());
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

/// A running study: its threads, its bar and Ctrl-C.
pub(super) struct Running {
    bar: Bar,
    interrupt: Interrupt,
    jobs: Option<usize>,
}

impl Running {
    /// A study with a number of threads; `what` is the name of its points.
    pub(super) fn new(what: &'static str, jobs: Option<u16>) -> Running {
        Running {
            bar: Bar::with_rate(what),
            interrupt: Interrupt::install(),
            jobs: jobs.map(usize::from),
        }
    }

    /// Runs a part of the study and shows its progress.
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
