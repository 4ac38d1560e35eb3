//! The dialogs over the panes: their interface, and the boxes in which they are drawn. Each file
//! contains the state, keys, update and drawing of one dialog; what a dialog changes in the
//! workbench, the caller gives to it.

pub(crate) mod browser;
pub(crate) mod page;
pub(crate) mod picker;
pub(crate) mod question;
mod relief;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Line as Words, Span, Text};
use ratatui::widgets::{Block, Borders, Clear, Padding, Widget};
use unicode_width::UnicodeWidthStr;

use super::App;
use super::actions::{Change, Choice, Running, Slot, Work};
use crate::case::units::System;
use crate::tui::layout::Place;
use crate::tui::settings::{Look, Theme};
use crate::tui::store::folder::{self, Preview, Target};
use crate::tui::text;
use crate::tui::text::Line;
use crate::tui::text::printable;

use browser::Browser;
use page::{Explanation, Page};
use picker::Picker;
use question::{PathDialog, Question};
pub(crate) use relief::ReliefDialog;

/// Greatest width of a box.
const WIDEST: u16 = 100;
/// Least width, with room for four buttons.
const NARROWEST: u16 = 52;

/// The interface of a dialog. By default it ignores a key.
pub(crate) trait Dialog {
    /// The place that decides the meaning of keys.
    fn place(&self) -> Place;

    /// Draws the dialog over the screen and returns the position of the text cursor.
    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position>;

    /// The change of the state by Enter.
    fn accept(&mut self, _app: &App) -> Option<Change> {
        None
    }

    /// The edited line of text.
    fn input(&mut self) -> Option<&mut Line> {
        None
    }

    /// Handles a change of the edited line.
    fn typed(&mut self) -> Vec<Work> {
        Vec::new()
    }

    /// Moves by `by` lines.
    fn step(&mut self, _by: isize, _app: &App) {}

    /// Moves by `by` pages.
    fn turn(&mut self, by: isize, app: &App) {
        self.step(by * app.page_height(), app);
    }

    /// Handles the mouse wheel.
    fn wheel(&mut self, by: isize, app: &App) {
        self.step(by, app);
    }

    /// Handles a mouse click. Returns whether it accepts.
    fn click(&mut self, _at: Position, _app: &App) -> bool {
        false
    }

    /// Selects another field behind an explained result.
    fn select_field(&mut self, _by: isize, _app: &App) {}

    /// The preview of the selection.
    fn preview(&mut self) -> Option<(&mut PreviewPane, Option<Target>)> {
        None
    }
}

/// An open dialog.
#[derive(Debug, Clone)]
pub enum Prompt {
    /// The file browser.
    Browse(Box<Browser>),
    /// A line of text: a path to save or to export to, a range, or an angle.
    Path(PathDialog),
    /// A question with buttons.
    Ask(Question),
    /// A page of text.
    Read(Page),
    /// The explanation of a result.
    Explain(Explanation),
    /// The tip relief to specify.
    Relief(Box<ReliefDialog>),
    /// A list to pick from.
    Pick(Picker),
}

impl Prompt {
    pub(crate) fn dialog(&self) -> &dyn Dialog {
        match self {
            Prompt::Browse(dialog) => &**dialog,
            Prompt::Path(dialog) => dialog,
            Prompt::Ask(dialog) => dialog,
            Prompt::Read(dialog) => dialog,
            Prompt::Explain(dialog) => dialog,
            Prompt::Relief(dialog) => &**dialog,
            Prompt::Pick(dialog) => dialog,
        }
    }

    /// The dialog, to change it.
    pub(crate) fn dialog_mut(&mut self) -> &mut dyn Dialog {
        match self {
            Prompt::Browse(dialog) => &mut **dialog,
            Prompt::Path(dialog) => dialog,
            Prompt::Ask(dialog) => dialog,
            Prompt::Read(dialog) => dialog,
            Prompt::Explain(dialog) => dialog,
            Prompt::Relief(dialog) => &mut **dialog,
            Prompt::Pick(dialog) => dialog,
        }
    }
}

impl App {
    /// Passes control to the topmost dialog; `None` if there is no dialog.
    pub(crate) fn with_dialog<T>(
        &mut self,
        act: impl FnOnce(&mut dyn Dialog, &App) -> T,
    ) -> Option<T> {
        let mut prompt = self.prompts.pop()?;
        let result = act(prompt.dialog_mut(), self);
        self.prompts.push(prompt);
        Some(result)
    }

    pub(crate) fn ask(&mut self, question: Question) {
        self.prompts.push(Prompt::Ask(question));
    }

    pub(crate) fn pick(&mut self, picker: Picker) {
        self.prompts.push(Prompt::Pick(picker));
    }

    /// Enter in the topmost dialog.
    pub(crate) fn accept(&mut self) {
        if let Some(change) = self.with_dialog(|dialog, app| dialog.accept(app)).flatten() {
            change.apply(self);
        }
    }

    /// The open dialog of a kind; the help or a question may cover it.
    pub(crate) fn dialog_of<'a, T>(
        &'a mut self,
        of: impl Fn(&'a mut Prompt) -> Option<T>,
    ) -> Option<T> {
        self.prompts.iter_mut().rev().find_map(of)
    }

    /// The file browser, if it is open.
    pub(crate) fn browser(&mut self) -> Option<&mut Browser> {
        self.dialog_of(|prompt| match prompt {
            Prompt::Browse(browser) => Some(&mut **browser),
            _ => None,
        })
    }

    /// Goes to the parent folder in the file browser.
    pub(crate) fn browse_up(&mut self) {
        let work = self.browser().map(Browser::leave);
        self.start_all(work);
    }

    /// Handles a change of the line of the topmost dialog.
    pub(crate) fn line_changed(&mut self) {
        let prompt = self.prompts.last_mut();
        let works = prompt.map_or_else(Vec::new, |prompt| prompt.dialog_mut().typed());
        self.start_all(works);
    }

    /// Starts the preview of a new selection.
    pub(crate) fn preview(&mut self) {
        let units = self.settings.units;
        let prompt = self.prompts.last_mut();
        let preview = prompt.and_then(|prompt| prompt.dialog_mut().preview());
        let work = preview.and_then(|(pane, target)| pane.request(target, units));
        self.start_all(work);
    }

    /// Closes the path or question with this title, if it is open.
    pub(crate) fn close_titled(&mut self, title: &str) {
        self.prompts.retain(|prompt| match prompt {
            Prompt::Path(dialog) => dialog.title != title,
            Prompt::Ask(question) => question.title != title,
            _ => true,
        });
    }
}

// Closes the dialog, then carries out the choice.
fn closing(choice: &Choice) -> Change {
    let change = choice.change();
    Change::of(|app| {
        app.prompts.pop();
        change.apply(app);
    })
}

// The boxes of dialogs.
impl App {
    /// The size inside the largest box.
    fn room(&self) -> Size {
        let Size { width, height } = self.layout.size;
        Size::new(width.min(WIDEST).saturating_sub(4), height.saturating_sub(4))
    }

    /// Number of lines of a page in the largest box.
    fn page_height(&self) -> isize {
        isize::from(self.room().height.cast_signed()).max(1)
    }

    /// The first visible line after a scroll by `by` of the lines in the largest box.
    fn scrolled(&self, top: usize, by: isize, count: usize) -> usize {
        top.saturating_add_signed(by).min(count.saturating_sub(self.room().height.into()))
    }

    fn outside(&self, wanted: Size) -> Rect {
        let room = self.room();
        let height = wanted.height.clamp(1, room.height.max(1)) + 2;
        let width = wanted.width.max(NARROWEST).min(room.width) + 4;
        let (width, height) = (Constraint::Length(width), Constraint::Length(height));
        let screen = Rect::from(self.layout.size);
        screen.centered(width, height).intersection(screen)
    }

    /// The area inside a box, which is as large as wanted if there is room.
    fn inside(&self, wanted: Size) -> Rect {
        Block::bordered().padding(Padding::horizontal(1)).inner(self.outside(wanted))
    }

    /// Clears a box with a border and returns its inside.
    fn frame(&self, title: &str, wanted: Size, buffer: &mut Buffer) -> Rect {
        let area = self.outside(wanted);
        Clear.render(area, buffer);
        let title = text::cut(title, usize::from(area.width).saturating_sub(6));
        let title = Words::styled(format!(" {title} "), self.look.theme.title);
        Block::bordered().title(title).render(area, buffer);
        self.inside(wanted)
    }

    /// A box that shows the lines from `top`, with a scroll bar if they do not fit.
    fn page_box(&self, title: &str, lines: &[Words<'_>], top: usize, buffer: &mut Buffer) {
        let inner = self.frame(title, Size::new(WIDEST, extent(lines).height), buffer);
        lines.iter().skip(top).cloned().collect::<Text<'_>>().render(inner, buffer);
        text::scroll_bar_beside(top, lines.len(), inner, buffer);
    }
}

/// A list on the left and its details on the right.
fn halves(area: Rect) -> [Rect; 2] {
    Layout::horizontal([Constraint::Percentage(40), Constraint::Fill(1)]).spacing(1).areas(area)
}

/// Draws the details on the right of a list.
fn draw_details(lines: impl FnOnce(u16) -> Vec<Words<'static>>, area: Rect, buffer: &mut Buffer) {
    let beside = Block::new().borders(Borders::LEFT).padding(Padding::left(1));
    let inner = beside.inner(area);
    beside.render(area, buffer);
    text::draw_lines(lines(inner.width), inner, buffer);
}

/// The lines of a list in its area, app the selected one; only visible lines are built.
struct Window {
    count: usize,
    selected: Option<usize>,
    area: Rect,
}

impl Window {
    fn top(&self) -> usize {
        let end = self.selected.map_or(0, |selected| selected + 1);
        end.saturating_sub(self.area.height.into())
    }

    fn draw(&self, line: impl Fn(usize) -> String, theme: &Theme, buffer: &mut Buffer) {
        for (at, row) in (self.top()..self.count).zip(self.area.rows()) {
            let (sign, style) =
                if self.selected == Some(at) { ("▸", theme.focus) } else { (" ", Style::new()) };
            let line = text::cut(&format!("{sign} {}", line(at)), self.area.width.into());
            Span::styled(line, style).render(row, buffer);
        }
    }

    /// The index of the line at a cell, if any.
    fn line_at(&self, at: Position) -> Option<usize> {
        let line = self.area.contains(at).then(|| self.top() + usize::from(at.y - self.area.y));
        line.filter(|&line| line < self.count)
    }
}

/// The size of lines of text.
fn extent(lines: &[Words<'_>]) -> Size {
    let width = lines.iter().map(Words::width).max().unwrap_or(0);
    let size = |length: usize| u16::try_from(length).unwrap_or(u16::MAX);
    Size::new(size(width), size(lines.len()))
}

/// The lines of a text in a width.
fn said(text: &str, style: Style, width: u16) -> Vec<Words<'static>> {
    let lines = text::wrap(text, width.into()).into_iter();
    lines.map(|line| Span::styled(line, style).into()).collect()
}

/// A line in lines of a width; continuation lines begin below the second column of the line, if it
/// has one.
fn wrapped(line: &str, width: u16) -> Vec<String> {
    let width = usize::from(width);
    if line.width() <= width {
        return vec![printable(line).into_owned()];
    }
    let lead = line.len() - line.trim_start().len();
    let gap = line[lead..].find("  ").map(|at| lead + at);
    let column = gap.map(|gap| line.len() - line[gap..].trim_start().len());
    let (head, text) = line.split_at(column.filter(|_| line.is_ascii()).unwrap_or(lead));
    let mut lines = text::wrap(text, width.saturating_sub(head.len()));
    for (at, line) in lines.iter_mut().enumerate() {
        let lead = if at == 0 { head } else { &" ".repeat(head.len()) };
        line.insert_str(0, lead);
    }
    lines
}

/// The preview of the selected line of a list.
#[derive(Debug, Clone, Default)]
pub(crate) struct PreviewPane {
    /// The target of the last request.
    target: Option<Target>,
    /// The preview, once it is computed.
    preview: Option<Preview>,
}

impl PreviewPane {
    /// The work of the preview, once for each selection.
    fn request(&mut self, target: Option<Target>, units: System) -> Option<Work> {
        if target == self.target {
            return None;
        }
        (self.target, self.preview) = (target.clone(), None);
        let own = target?;
        let path = own.path();
        let find =
            move |running: &Running<'_>| folder::preview(&own, units, &|_| running.is_wanted());
        let show = |app: &mut App, preview| {
            if let Some((pane, _)) = app.dialog_of(|prompt| prompt.dialog_mut().preview()) {
                pane.preview = Some(preview);
            }
        };
        Some(Work::new(Slot::Preview, find, show).at(path))
    }

    /// The lines of the preview in a width.
    fn lines(&self, width: u16, look: Look) -> Vec<Words<'static>> {
        let theme = look.theme;
        match (&self.target, &self.preview) {
            (None, _) => Vec::new(),
            (_, None) => vec![Words::styled("reading ...", theme.faint)],
            (_, Some(preview)) => {
                let spelled = |text| text::symbol(text, look.ascii);
                let lines = preview.iter();
                lines.flat_map(|(text, tone)| said(&spelled(text), tone(theme), width)).collect()
            }
        }
    }
}
