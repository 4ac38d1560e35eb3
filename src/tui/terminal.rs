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
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Size};
use unicode_width::UnicodeWidthStr;

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
    backend: CrosstermBackend<BufWriter<Stdout>>,
    /// The shown frame, and the next one.
    frames: [Buffer; 2],
    /// The shown text cursor.
    cursor: Option<Position>,
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
        let frames = blank(capped(backend.size()?));
        Ok(Screen { backend, frames, cursor: None, is_back: false, has_mouse: false })
    }

    /// The size of the drawn part of the terminal.
    ///
    /// # Errors
    /// Returns an error if the terminal does not report its size.
    pub(super) fn size(&self) -> io::Result<Size> {
        Ok(capped(self.backend.size()?))
    }

    /// Draws the state.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn draw(&mut self, app: &App) -> io::Result<()> {
        if !IS_TAKEN.load(Ordering::Relaxed) {
            return Ok(());
        }
        let [shown, next] = &mut self.frames;
        next.reset();
        let cursor = view::draw(app, next.area, next);
        self.backend.draw(changed(shown, next).into_iter())?;
        if let Some(cursor) = cursor {
            self.backend.set_cursor_position(cursor)?;
        }
        match (self.cursor, cursor) {
            (None, Some(_)) => self.backend.show_cursor()?,
            (Some(_), None) => self.backend.hide_cursor()?,
            _ => (),
        }
        Backend::flush(&mut self.backend)?;
        self.frames.swap(0, 1);
        self.cursor = cursor;
        Ok(())
    }

    /// Makes the next frame draw every cell.
    ///
    /// # Errors
    /// Returns an error if the terminal is closed.
    pub(super) fn clear(&mut self) -> io::Result<()> {
        self.frames = blank(self.size()?);
        self.backend.clear()
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
        self.enter()
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
        self.enter()
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
        (self.frames, self.cursor) = (blank(self.size()?), None);
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
        &mut self.backend
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

fn blank(size: Size) -> [Buffer; 2] {
    [Buffer::empty(size.into()), Buffer::empty(size.into())]
}

/// The cells that a frame changes. Of a changed row with wide characters every cell is drawn, so that
/// no half of a character remains.
fn changed<'n>(shown: &Buffer, next: &'n Buffer) -> Vec<(u16, u16, &'n Cell)> {
    let width = usize::from(next.area.width).max(1);
    let rows = shown.content.chunks(width).zip(next.content.chunks(width));
    let mut changes = Vec::new();
    for (y, (before, now)) in (0..).zip(rows) {
        if before.iter().zip(now).all(|(before, now)| is_same(before, now)) {
            continue;
        }
        let is_wide = |cell: &Cell| cell.symbol().len() > 1 && cell.symbol().width() != 1;
        let is_whole = before.iter().chain(now).any(is_wide);
        let mut end = 0;
        for (x, (before, now)) in (0..).zip(before.iter().zip(now)) {
            if x >= end && (is_whole || !is_same(before, now)) {
                changes.push((x, y, now));
                end = x + if is_whole { now.symbol().width() as u16 } else { 1 };
            }
        }
    }
    changes
}

/// Whether two cells look the same; `Cell::eq` takes five times as long.
fn is_same(one: &Cell, other: &Cell) -> bool {
    let is_same_text = one.symbol().bytes().eq(other.symbol().bytes());
    is_same_text && (one.fg, one.bg, one.modifier) == (other.fg, other.bg, other.modifier)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_writes_its_changed_cells_and_whole_rows_of_wide_characters() {
        let changes = |shown: [&str; 2], next: [&str; 2]| {
            let next = Buffer::with_lines(next);
            let changes = changed(&Buffer::with_lines(shown), &next);
            changes
                .iter()
                .map(|(x, y, cell)| (*x, *y, cell.symbol().to_owned()))
                .collect::<Vec<_>>()
        };
        let cells = |cells: &[(u16, u16, &str)]| {
            cells.iter().map(|&(x, y, text)| (x, y, text.to_owned())).collect::<Vec<_>>()
        };
        assert_eq!(changes(["5 mm", "ΔV"], ["5 um", "ΔV"]), cells(&[(2, 0, "u")]));
        assert_eq!(
            changes(["歯a", "b  "], ["xya", "b  "]),
            cells(&[(0, 0, "x"), (1, 0, "y"), (2, 0, "a")])
        );
        assert_eq!(changes(["xya", "b  "], ["歯a", "b  "]), cells(&[(0, 0, "歯"), (2, 0, "a")]));
    }

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
