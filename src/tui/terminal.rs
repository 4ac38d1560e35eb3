//! The terminal: its modes, and their restoration on every exit.

use std::ffi::OsString;
use std::io::{self, BufWriter, IsTerminal, Stdout, Write};
use std::panic::{self, PanicHookInfo};
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, PoisonError};
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
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::layout::Size;
use ratatui::{Terminal, TerminalOptions, Viewport};

use super::app::App;
use super::input::Event;
use super::view;
use crate::system::terminal::{
    BlockedSignals, die_of, is_in_foreground, stop, wait_for_hang_up, write_if_ready,
};

/// Large enough for one write per frame; the standard buffer would make ten.
const FRAME: usize = 64 * 1024;

/// Whether the terminal is in the modes of the workbench.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);
static IS_ENDING: AtomicBool = AtomicBool::new(false);
/// A signal that ends the process arrives within this time.
const NOTICE: Duration = Duration::from_millis(50);

static LAST_PANIC: Mutex<Option<String>> = Mutex::new(None);

/// Time for the main loop to end by itself.
const GRACE: Duration = Duration::from_millis(700);
/// The exit code if the terminal is closed.
pub(super) const TERMINAL_LOST: u8 = 5;

/// The largest drawn area.
const LARGEST: Size = Size { width: 1000, height: 500 };

/// The screen of the terminal. Dropping it restores the terminal.
pub(super) struct Screen {
    terminal: Terminal<CrosstermBackend<BufWriter<Stdout>>>,
    drawn: Size,
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
        let drawn = capped(backend.size()?);
        let viewport = Viewport::Fixed(drawn.into());
        Ok(Screen {
            terminal: Terminal::with_options(backend, TerminalOptions { viewport })?,
            drawn,
            is_back: false,
            has_mouse: false,
        })
    }

    /// The size of the drawn part of the terminal.
    ///
    /// # Errors
    /// Returns an error if the terminal does not report its size.
    pub(super) fn size(&self) -> io::Result<Size> {
        Ok(capped(self.terminal.size()?))
    }

    /// Draws the state.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn draw(&mut self, app: &App) -> io::Result<()> {
        if !IS_TAKEN.load(Ordering::Relaxed) {
            return Ok(());
        }
        if self.size()? != self.drawn {
            self.clear()?;
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
        self.drawn = self.size()?;
        self.terminal.resize(self.drawn.into())
    }

    /// Restores the terminal and stops the process until the shell continues it.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn suspend(&mut self) -> io::Result<()> {
        self.leave()?;
        stop()?;
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
    signals.for_each_deadly(move |signal| end(&words, &to_end, Some(signal)))?;
    let to_pass = sender.clone();
    // A separate thread, because a blocked main loop takes no events and must still end.
    signals.for_each_passing(move |signal| to_pass.send(Event::Signal(signal)).is_ok())?;
    let gone = sender.clone();
    // A process outside the session of the terminal receives no signal when the terminal closes.
    thread::Builder::new().name("line".to_owned()).spawn(move || {
        if wait_for_hang_up(&io::stdin()) {
            end(&last_words, &gone, None);
        }
    })?;
    Ok(())
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
    // A signal ends the process soon.
    IS_ENDING.store(true, Ordering::Relaxed);
    last_words();
    drop(sender.try_send(signal.map_or(Event::Lost, Event::Signal)));
    thread::sleep(GRACE);
    force_restore();
    match signal {
        Some(signal) => die_of(signal),
        None => process::exit(TERMINAL_LOST.into()),
    }
}

/// The drawn part of a terminal of a size: a failed allocation of its cells would end the process.
fn capped(size: Size) -> Size {
    Size { width: size.width.min(LARGEST.width), height: size.height.min(LARGEST.height) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dumb_or_unnamed_terminal_is_none() {
        assert_eq!(missing(|_| None), Some("TERM is not set"));
        assert_eq!(missing(|_| Some("dumb".into())), Some("TERM is dumb"));
    }

    #[test]
    fn the_drawn_area_fits_the_terminal_and_its_cap() {
        for (size, drawn) in [((140, 45), (140, 45)), ((u16::MAX, 9), (1000, 9)), ((0, 0), (0, 0))]
        {
            assert_eq!(capped(Size::from(size)), Size::from(drawn));
        }
    }
}
