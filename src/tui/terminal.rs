//! The terminal: its modes, and their restoration on every exit.

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

/// Large enough for one write per frame; the standard buffer would make ten.
const FRAME: usize = 64 * 1024;

/// Whether the terminal is in the modes of the workbench.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);
static IS_ENDING: AtomicBool = AtomicBool::new(false);
/// A signal that ends the process arrives within this time.
const NOTICE: Duration = Duration::from_millis(50);

static LAST_PANIC: Mutex<Option<String>> = Mutex::new(None);

/// The screen of the terminal. Dropping it restores the terminal.
pub(super) struct Screen {
    terminal: Terminal<CappedBackend<CrosstermBackend<BufWriter<Stdout>>>>,
    /// The signal of our own suspension has not arrived yet.
    is_back: bool,
    /// Whether mouse reports are on.
    has_mouse: bool,
}

/// The reason if there is no terminal for a workbench.
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

/// Holds the message of a panic until the terminal is restored. A panic of the worker is reported
/// on the screen.
pub(super) fn hold_panics() {
    panic::set_hook(Box::new(|panic: &PanicHookInfo<'_>| {
        *LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic.to_string());
    }));
}

/// The message of the last panic.
#[must_use]
pub(super) fn last_panic() -> Option<String> {
    LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// Marks that a signal will end the process soon.
pub(super) fn expect_end() {
    IS_ENDING.store(true, Ordering::Relaxed);
}

/// Whether the process ends without a terminal: the `kill` of a shell sends a signal to a stopped
/// job and continues it in the background. Entering the terminal would stop it again.
fn ends_in_background() -> bool {
    if is_in_foreground() {
        return false;
    }
    thread::sleep(NOTICE);
    IS_ENDING.load(Ordering::Relaxed)
}

// In the background the terminal has the modes of the shell.
fn restore_modes() -> io::Result<()> {
    if is_in_foreground() { disable_raw_mode() } else { Ok(()) }
}

/// Restores the terminal while the main loop is blocked. If the terminal accepts no bytes, only its
/// modes are restored.
pub(super) fn force_restore() {
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
    /// A screen of the size of the terminal. The terminal does not change until [`Screen::enter`].
    ///
    /// # Errors
    /// Returns an error if the terminal does not report its size.
    pub(super) fn new() -> io::Result<Screen> {
        // Otherwise NO_COLOR would also remove bold and reverse; our own theme has no colour then.
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
    /// Returns an error if the terminal does not report its size.
    pub(super) fn size(&self) -> io::Result<Size> {
        self.terminal.size()
    }

    /// Draws the state.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
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

    /// Makes the next frame draw every cell.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn clear(&mut self) -> io::Result<()> {
        // `Terminal::clear` would request the cursor position and wait for the reply.
        let size = self.terminal.size()?;
        self.terminal.resize(size.into())
    }

    /// Restores the terminal and stops the process until the shell continues it.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
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

    /// Enters the terminal again after a stop without a signal, whatever modes the shell has set.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn resume(&mut self) -> io::Result<()> {
        // Only if necessary: for a moment the terminal has the modes of the shell and would swallow
        // a Ctrl-Q.
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

    /// Turns mouse reports on or off.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
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

    /// Copies a text to the clipboard of the user's terminal (OSC 52). The base64 encoding contains
    /// no control characters.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn copy(&mut self, text: &str) -> io::Result<()> {
        execute!(self.output(), CopyToClipboard::to_clipboard_from(text))
    }

    /// Enters the modes of the workbench.
    ///
    /// # Errors
    /// Returns an error if the terminal does not respond.
    pub(super) fn enter(&mut self) -> io::Result<()> {
        enable_raw_mode()?;
        IS_TAKEN.store(true, Ordering::Relaxed);
        // A terminal that is still in the alternate screen, such as after a lost connection, shows
        // its old content there, and erases with its last colour.
        execute!(
            self.output(),
            EnterAlternateScreen,
            EnableBracketedPaste,
            Hide,
            ResetColor,
            Clear(ClearType::All)
        )?;
        if self.has_mouse { execute!(self.output(), EnableMouseCapture) } else { Ok(()) }
    }

    fn leave(&mut self) -> io::Result<()> {
        if self.has_mouse {
            execute!(self.output(), DisableMouseCapture)?;
        }
        let written = execute!(self.output(), DisableBracketedPaste, Show, LeaveAlternateScreen);
        IS_TAKEN.store(false, Ordering::Relaxed);
        restore_modes().and(written)
    }

    fn output(&mut self) -> &mut impl Write {
        &mut self.terminal.backend_mut().backend
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // A closed terminal needs no restoration.
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
