//! The terminal: its modes, and their restoration on every exit.

use std::ffi::OsString;
use std::io::{self, BufWriter, IsTerminal, Stdout, Write};
use std::mem::{self, ManuallyDrop};
use std::panic::{self, PanicHookInfo};
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crossterm::clipboard::CopyToClipboard;
use crossterm::cursor::{Hide, MoveTo, Show};
use crossterm::event::{
    DisableBracketedPaste, DisableMouseCapture, EnableBracketedPaste, EnableMouseCapture,
};
use crossterm::execute;
use crossterm::style::{ResetColor, force_color_output};
use crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use ratatui::backend::CrosstermBackend;
use ratatui::layout::{Position, Rect, Size};
use ratatui::{Terminal, TerminalOptions, Viewport};

use super::app::App;
use super::input::Event;
use super::view;
use crate::system::terminal::{
    BlockedSignals, die_of, for_each, is_in_foreground, stop, wait_for_hang_up, write_if_ready,
};

/// Large enough for one write per frame; the standard buffer would make ten.
const FRAME: usize = 64 * 1024;

/// Whether the terminal is in the modes of the workbench.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

static LAST_PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Time for the main loop to end by itself.
const GRACE: Duration = Duration::from_millis(700);
/// The exit code if the terminal is closed.
pub(super) const TERMINAL_LOST: u8 = 5;

/// The largest drawn area: a failed allocation of its cells would end the process.
const LARGEST: Size = Size { width: 1000, height: 500 };

/// The screen of the terminal. Dropping it restores the terminal.
pub(super) struct Screen {
    /// Its own drop prints an error of a closed terminal, which panics if standard error is closed too.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<BufWriter<Stdout>>>>,
    /// The signal of our own suspension has not arrived yet.
    is_back: bool,
    /// Whether mouse reports are on.
    has_mouse: bool,
}

/// The reason if there is no terminal for a workbench.
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
pub(super) fn last_panic() -> Option<String> {
    LAST_PANIC.lock().unwrap_or_else(PoisonError::into_inner).take()
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
        // Its area is that of the drawn state, which may be older than the size of the terminal.
        let options = TerminalOptions { viewport: Viewport::Fixed(Rect::ZERO) };
        let terminal = ManuallyDrop::new(Terminal::with_options(backend, options)?);
        Ok(Screen { terminal, is_back: false, has_mouse: false })
    }

    /// The size of the drawn part of the terminal.
    ///
    /// # Errors
    /// Returns an error if the terminal does not report its size.
    pub(super) fn size(&self) -> io::Result<Size> {
        let size = self.terminal.size()?;
        Ok(Size::new(size.width.min(LARGEST.width), size.height.min(LARGEST.height)))
    }

    /// Draws the state.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn draw(&mut self, app: &App) -> io::Result<()> {
        if !IS_TAKEN.load(Ordering::Relaxed) {
            return Ok(());
        }
        if self.terminal.get_frame().area().as_size() != app.layout.size {
            self.clear(app.layout.size)?;
        }
        let cursor = view::draw(app, self.terminal.current_buffer_mut());
        self.terminal.flush()?;
        // With the cursor in one write: after a write, the terminal may take the processor.
        match cursor {
            Some(Position { x, y }) => execute!(self.output(), Show, MoveTo(x, y))?,
            None => execute!(self.output(), Hide)?,
        }
        self.terminal.swap_buffers();
        Ok(())
    }

    /// Makes the next frame of a size draw every cell.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn clear(&mut self, size: Size) -> io::Result<()> {
        self.terminal.resize(Rect::from(size))
    }

    /// Restores the terminal and stops the process until the shell continues it.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn suspend(&mut self) -> io::Result<()> {
        self.leave()?;
        stop()?;
        self.is_back = true;
        self.enter()
    }

    /// Enters the terminal again after a stop without a signal, whatever modes the shell has set.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn resume(&mut self) -> io::Result<()> {
        // Only if necessary: for a moment the terminal has the modes of the shell and would swallow
        // a Ctrl-Q.
        if mem::take(&mut self.is_back) { Ok(()) } else { self.enter() }
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

    /// Enters the modes of the workbench, unless the shell has the terminal: it continues a stopped
    /// job in the background to end it.
    ///
    /// # Errors
    /// Returns an error if the terminal does not respond.
    pub(super) fn enter(&mut self) -> io::Result<()> {
        if !is_in_foreground() {
            return Ok(());
        }
        if IS_TAKEN.swap(true, Ordering::Relaxed) {
            disable_raw_mode()?;
        }
        enable_raw_mode()?;
        // A terminal that is still in the alternate screen, such as after a lost connection, shows
        // its old content there, and erases with its last colour.
        execute!(self.output(), EnterAlternateScreen, EnableBracketedPaste, Hide, ResetColor)?;
        self.clear(self.size()?)?;
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
        self.terminal.backend_mut()
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

/// Waits for signals and for the end of the terminal, each in a sleeping thread. Calls `last_words`
/// first when the process ends.
pub(super) fn listen(
    signals: BlockedSignals,
    sender: &SyncSender<Event>,
    last_words: impl Fn() + Send + Sync + 'static,
) -> io::Result<()> {
    let last_words: LastWords = Arc::new(last_words);
    let (words, to_end) = (Arc::clone(&last_words), sender.clone());
    for_each("signals", signals.deadly, move |signal| end(&words, &to_end, Some(signal)))?;
    let to_pass = sender.clone();
    // A separate thread, because a blocked main loop takes no events and must still end.
    for_each("stops", signals.passing, move |signal| to_pass.send(Event::Signal(signal)).is_ok())?;
    let gone = sender.clone();
    // A process outside the session of the terminal receives no signal when the terminal closes.
    thread::Builder::new().name("line".to_owned()).spawn(move || {
        if wait_for_hang_up(&io::stdin()) {
            end(&last_words, &gone, None);
        }
    })?;
    Ok(())
}

// In the background the terminal has the modes of the shell.
fn restore_modes() -> io::Result<()> {
    if is_in_foreground() { disable_raw_mode() } else { Ok(()) }
}

/// Restores the terminal while the main loop is blocked. If the terminal accepts no bytes, only its
/// modes are restored.
fn force_restore() {
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

type LastWords = Arc<dyn Fn() + Send + Sync>;

// The main loop ends by itself, unless it is blocked, such as in a write to a terminal that accepts
// no more bytes.
fn end(last_words: &LastWords, sender: &SyncSender<Event>, signal: Option<i32>) -> ! {
    last_words();
    drop(sender.try_send(signal.map_or(Event::Lost, Event::Signal)));
    thread::sleep(GRACE);
    force_restore();
    match signal {
        Some(signal) => die_of(signal),
        None => process::exit(TERMINAL_LOST.into()),
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
