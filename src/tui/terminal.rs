//! The terminal: its modes, and giving it back as it was found on every way out.

use std::ffi::OsString;
use std::io::{self, BufWriter, IsTerminal, Stdout, Write};
use std::panic::{self, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crossterm::clipboard::CopyToClipboard;
use crossterm::cursor::{Hide, Show};
use crossterm::event::{
    DisableBracketedPaste, DisableMouseCapture, EnableBracketedPaste, EnableMouseCapture,
};
use crossterm::execute;
use crossterm::style::{ResetColor, force_color_output};
use crossterm::terminal::{
    Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Size;

use super::app::App;
use super::capped_backend::CappedBackend;
use super::view;
use crate::system::signals;
use crate::system::terminal::{is_in_foreground, write_if_ready};

/// One write a frame, where the standard buffer would make ten.
const FRAME: usize = 64 * 1024;

/// Whether the terminal is in the modes of the workbench.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);
static IS_ENDING: AtomicBool = AtomicBool::new(false);
/// A signal that ends the process is known after this time.
const NOTICE: Duration = Duration::from_millis(50);

static LAST_PANIC: Mutex<Option<String>> = Mutex::new(None);

/// The picture on the terminal. Dropping it gives the terminal back.
pub(super) struct Screen {
    terminal: Terminal<CappedBackend<CrosstermBackend<BufWriter<Stdout>>>>,
    /// The signal that ended our own suspension is still to come.
    is_back: bool,
    /// Whether the mouse is ours.
    has_mouse: bool,
}

/// Why there is no terminal for a workbench, if so.
#[must_use]
pub(super) fn missing(variable: impl Fn(&str) -> Option<OsString>) -> Option<&'static str> {
    let term = variable("TERM").unwrap_or_default();
    if term.is_empty() {
        return Some("TERM is not set");
    }
    if term == "dumb" {
        return Some("TERM is dumb");
    }
    let is_terminal = io::stdin().is_terminal() && io::stdout().is_terminal();
    (!is_terminal).then_some("standard input and output are not a terminal")
}

/// Keep the message of a panic until the terminal is restored. The screen reports a panic of the
/// worker.
pub(super) fn hold_panics() {
    panic::set_hook(Box::new(|panic: &PanicHookInfo<'_>| {
        *LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic.to_string());
    }));
}

/// The words of the last panic.
#[must_use]
pub(super) fn last_panic() -> Option<String> {
    LAST_PANIC
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .take()
}

/// A signal ends the process soon.
pub(super) fn expect_end() {
    IS_ENDING.store(true, Ordering::Relaxed);
}

/// Whether the process ends without a terminal: the `kill` of a shell sends a signal to a stopped
/// job and continues it in the background. Taking the terminal would stop it again.
fn ends_in_background() -> bool {
    if is_in_foreground() {
        return false;
    }
    thread::sleep(NOTICE);
    IS_ENDING.load(Ordering::Relaxed)
}

// In the background the modes are those of the shell.
fn restore_modes() -> io::Result<()> {
    if is_in_foreground() {
        disable_raw_mode()
    } else {
        Ok(())
    }
}

/// Gives the terminal back while the workbench is stuck. A terminal that accepts no bytes gets its
/// modes back alone.
pub(super) fn give_back_by_force() {
    if !IS_TAKEN.load(Ordering::Relaxed) {
        return;
    }
    drop(restore_modes());
    let mut sequences = Vec::new();
    let is_made = execute!(
        sequences,
        DisableMouseCapture,
        DisableBracketedPaste,
        ResetColor,
        Show,
        LeaveAlternateScreen
    );
    if is_made.is_ok() {
        write_if_ready(&io::stdout(), &sequences);
    }
}

impl Screen {
    /// A picture of the size of the terminal, which is left alone until [`Screen::enter`].
    ///
    /// # Errors
    /// When the terminal does not report its size.
    pub(super) fn new() -> io::Result<Screen> {
        // Else NO_COLOR takes bold and reverse away too; our own theme has no colour then.
        force_color_output(true);
        let backend = CrosstermBackend::new(BufWriter::with_capacity(FRAME, io::stdout()));
        Ok(Screen {
            terminal: Terminal::new(CappedBackend::new(backend))?,
            is_back: false,
            has_mouse: false,
        })
    }

    /// The size of the terminal.
    ///
    /// # Errors
    /// When the terminal does not say.
    pub(super) fn size(&self) -> io::Result<Size> {
        self.terminal.size()
    }

    /// Draw the state.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub(super) fn draw(&mut self, app: &App) -> io::Result<()> {
        if !IS_TAKEN.load(Ordering::Relaxed) {
            return Ok(());
        }
        self.terminal.draw(|frame| {
            if let Some(cursor) = view::draw(app, frame.area(), frame.buffer_mut()) {
                frame.set_cursor_position(cursor);
            }
        })?;
        Ok(())
    }

    /// Forget what is on the screen, so that the next frame draws every cell.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub(super) fn clear(&mut self) -> io::Result<()> {
        // `Terminal::clear` would ask the terminal where its cursor is, and wait for the answer.
        let size = self.terminal.size()?;
        self.terminal.resize(size.into())
    }

    /// Give the terminal back to the shell and stop, until the shell brings us back.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub(super) fn suspend(&mut self) -> io::Result<()> {
        self.leave()?;
        signals::stop()?;
        self.is_back = true;
        if ends_in_background() {
            return Ok(());
        }
        self.enter()?;
        self.clear()
    }

    /// Take the terminal again after a stop without a signal, whatever the shell did with it.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub(super) fn resume(&mut self) -> io::Result<()> {
        // For a moment the terminal is in the shell's modes, in which it would eat a Ctrl-Q: only
        // where it must be.
        if std::mem::take(&mut self.is_back) {
            return Ok(());
        }
        if ends_in_background() {
            return Ok(());
        }
        disable_raw_mode()?;
        self.enter()?;
        self.clear()
    }

    /// Take the mouse, or leave it to the terminal.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub(super) fn take_mouse(&mut self, takes: bool) -> io::Result<()> {
        if self.has_mouse == takes {
            return Ok(());
        }
        self.has_mouse = takes;
        if takes {
            execute!(self.output(), EnableMouseCapture)
        } else {
            execute!(self.output(), DisableMouseCapture)
        }
    }

    /// Hand a text to the clipboard of the user's own terminal (OSC 52). In base64 nothing of it
    /// controls a terminal.
    ///
    /// # Errors
    /// When the terminal is gone.
    pub(super) fn copy(&mut self, text: &str) -> io::Result<()> {
        execute!(self.output(), CopyToClipboard::to_clipboard_from(text))
    }

    /// Takes the terminal.
    ///
    /// # Errors
    /// When the terminal does not answer.
    pub(super) fn enter(&mut self) -> io::Result<()> {
        enable_raw_mode()?;
        IS_TAKEN.store(true, Ordering::Relaxed);
        // A terminal that is still in the alternate screen, as after a lost connection, shows its
        // old picture there, and erases with the colour that was last set.
        execute!(
            self.output(),
            EnterAlternateScreen,
            EnableBracketedPaste,
            Hide,
            ResetColor,
            Clear(ClearType::All)
        )?;
        if self.has_mouse {
            execute!(self.output(), EnableMouseCapture)
        } else {
            Ok(())
        }
    }

    fn leave(&mut self) -> io::Result<()> {
        if self.has_mouse {
            execute!(self.output(), DisableMouseCapture)?;
        }
        let written = execute!(
            self.output(),
            DisableBracketedPaste,
            Show,
            LeaveAlternateScreen
        );
        IS_TAKEN.store(false, Ordering::Relaxed);
        restore_modes().and(written)
    }

    fn output(&mut self) -> &mut impl Write {
        &mut self.terminal.backend_mut().backend
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // On a terminal that is gone there is nothing to give back.
        if IS_TAKEN.load(Ordering::Relaxed) {
            drop(self.leave());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dumb_or_unnamed_terminal_is_none() {
        assert_eq!(missing(|_| None), Some("TERM is not set"));
        assert_eq!(missing(|_| Some("dumb".into())), Some("TERM is dumb"));
    }
}
