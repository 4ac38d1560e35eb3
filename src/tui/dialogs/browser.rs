//! The file browser: a folder on the left, the recent cases below it, the preview of the selected
//! line on the right.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;

use super::picker::Pick;
use super::{Dialog, Outcome, Surroundings, boxes};
use crate::case::units::System;
use crate::case::{EXAMPLES, Example};
use crate::tui::jobs::Job;
use crate::tui::keys::Place;
use crate::tui::line::Line as Text;
use crate::tui::store::Recent;
use crate::tui::store::folder::{self, Entry, Listing, Preview, SearchResult, Viewport, beneath};
use crate::tui::text;
use crate::tui::theme::Theme;

/// The full width, and a limited number of lines.
const SIZE: Size = Size { width: u16::MAX, height: 34 };
/// Number of visible recent cases.
const RECENTS: usize = 6;

impl Browser {
    /// The job that lists the folder.
    #[must_use]
    pub(crate) fn list(&self) -> Job {
        Job::Folder(self.asks(), self.place())
    }

    fn place(&self) -> PathBuf {
        folder::place_of(&self.base, &self.typed_folder)
    }

    /// Enters the selected folder, or writes the selected name into the line.
    pub(crate) fn complete(&mut self) -> Vec<Job> {
        match self.marked_sight() {
            Some(Viewport::Folder(folder)) => {
                self.enter(folder);
                return vec![self.list()];
            }
            Some(Viewport::File(path)) => self.input = path.display().to_string().into(),
            Some(Viewport::Example(example)) => self.input = example.name.into(),
            None => return Vec::new(),
        }
        self.typed()
    }

    /// A browser in the folder of the present case; selects the recent cases if they are preferred.
    #[must_use]
    pub(crate) fn beside(path: Option<&Path>, prefers_recents: bool) -> Browser {
        let base = path.and_then(Path::parent).map(Path::to_owned).unwrap_or_default();
        let came_from = path.and_then(Path::file_name).map(ToOwned::to_owned);
        Browser { base, prefers_recents, came_from, ..Browser::default() }
    }

    /// The folder and the typed part of the requested listing.
    #[must_use]
    fn asks(&self) -> (PathBuf, String) {
        (self.base.clone(), self.typed_folder.clone())
    }

    /// The typed path up to its last slash, and the rest. A lone `~` is the home folder.
    #[must_use]
    pub(crate) fn split(&self) -> (&str, &str) {
        let typed = self.input.value();
        if typed == "~" {
            (typed, "")
        } else {
            typed.split_at(typed.rfind('/').map_or(0, |slash| slash + 1))
        }
    }

    /// Updates the matches after typing. Returns whether the text names another folder.
    pub(crate) fn follow(&mut self) -> bool {
        let (folder, _) = self.split();
        let is_other = folder != self.typed_folder;
        if is_other {
            folder.to_owned().clone_into(&mut self.typed_folder);
            self.listing = None;
        }
        self.refit();
        is_other
    }

    /// Shows a listing if it belongs to the present folder.
    pub(crate) fn take(&mut self, listing: Listing) {
        if listing.asked == self.asks() {
            self.listing = Some(listing);
            self.refit();
            let came_from = self.came_from.take();
            let is_it = |entry: &Entry| Some(&entry.file) == came_from.as_ref();
            let at = self.entries().position(is_it).map(|at| at + usize::from(self.has_up()));
            self.marked = at.filter(|_| !self.prefers_recents).unwrap_or(self.marked);
        }
    }

    /// Whether the listing has arrived for which Enter waits; once.
    pub(crate) fn accepts_now(&mut self) -> bool {
        self.listing.is_some() && std::mem::take(&mut self.is_accepting)
    }

    /// The folder in which to search for cases below; at most one search for each folder.
    fn seek(&mut self) -> Option<(PathBuf, String)> {
        let is_sought = self.sought.as_ref() == Some(&self.asks());
        if is_sought || self.wanted().is_none() {
            return None;
        }
        self.sought = Some(self.asks());
        self.sought.clone()
    }

    /// Whether the search in the folders below is still running.
    fn is_seeking(&self) -> bool {
        self.wanted().is_some() && self.own_below().is_none()
    }

    /// Shows the cases in the folders below; a selection before them does not change.
    pub(crate) fn take_below(&mut self, below: SearchResult) {
        self.below = Some(below);
        let marked = self.marked;
        let is_above = marked < self.count_of_folder() && !self.fitting.is_empty();
        self.refit();
        self.marked = if is_above { marked } else { self.marked };
    }

    /// Shows the recent cases.
    pub fn remember(&mut self, recents: Vec<Recent>) {
        self.recents = recents;
        self.refit();
    }

    /// Selects the first recent case, or goes back to the folder.
    pub(crate) fn select_recents(&mut self) {
        self.prefers_recents = !self.marks_recent();
        self.mark_first();
    }

    /// Whether the list includes the parent folder.
    fn has_up(&self) -> bool {
        self.listing.is_some() && self.split().1.is_empty()
    }

    /// The matching entries of the folder.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &Entry> {
        let entries = self.listing.as_ref().and_then(|listing| listing.entries.as_ref().ok());
        self.fitting.iter().filter_map(move |&at| entries?.get(at))
    }

    /// The number of lines of the folder.
    fn count_of_folder(&self) -> usize {
        self.fitting.len()
            + self.fitting_below.len()
            + self.fitting_examples.len()
            + usize::from(self.has_up())
    }

    /// The number of matching recent cases.
    fn count_of_recents(&self) -> usize {
        self.fitting_recents.len()
    }

    /// Whether a recent case is selected.
    fn marks_recent(&self) -> bool {
        self.count_of_recents() > 0 && self.marked >= self.count_of_folder()
    }

    /// A line by its index, those of the folder first.
    #[must_use]
    pub(crate) fn line(&self, at: usize) -> Option<Line<'_>> {
        if self.has_up() && at == 0 {
            return Some(Line::Up);
        }
        let in_folder = at - usize::from(self.has_up());
        if let Some(&entry) = self.fitting.get(in_folder) {
            return self.listing.as_ref()?.entries.as_ref().ok()?.get(entry).map(Line::Entry);
        }
        let beyond = in_folder - self.fitting.len();
        if let Some(&case) = self.fitting_below.get(beyond) {
            return self.below.as_ref()?.cases.get(case).map(Line::Found);
        }
        let beyond = beyond - self.fitting_below.len();
        if let Some(&example) = self.fitting_examples.get(beyond) {
            return EXAMPLES.get(example).map(Line::Example);
        }
        let recent = *self.fitting_recents.get(beyond - self.fitting_examples.len())?;
        self.recents.get(recent).map(Line::Recent)
    }

    /// The preview target of a line.
    #[must_use]
    pub(crate) fn sight(&self, line: Line<'_>) -> Viewport {
        match line {
            Line::Up => Viewport::Folder(self.above()),
            Line::Recent(recent) => Viewport::File(recent.path.clone()),
            Line::Example(example) => Viewport::Example(example),
            Line::Found(case) => Viewport::File(
                self.below.as_ref().map_or_else(|| case.way.clone(), |below| below.path(case)),
            ),
            Line::Entry(entry) => {
                let path = beneath(&self.base, &self.typed_folder).join(&entry.file);
                if entry.is_folder { Viewport::Folder(path) } else { Viewport::File(path) }
            }
        }
    }

    /// The preview target of the selected line.
    fn marked_sight(&self) -> Option<Viewport> {
        self.line(self.marked).map(|line| self.sight(line))
    }

    /// The typed path.
    fn typed_path(&self) -> PathBuf {
        beneath(&self.base, self.input.value())
    }

    /// Moves the selection by `by` lines, within the list.
    pub(crate) fn mark(&mut self, by: isize) {
        let last = (self.count_of_folder() + self.count_of_recents()).saturating_sub(1);
        self.marked = self.marked.saturating_add_signed(by).min(last);
    }

    /// Enters a folder.
    pub(crate) fn enter(&mut self, folder: PathBuf) {
        self.came_from = (folder == self.above())
            .then(|| self.listing.as_ref()?.folder.file_name().map(ToOwned::to_owned))
            .flatten();
        self.base = folder;
        (self.input, self.typed_folder, self.listing) = (Text::default(), String::new(), None);
        (self.prefers_recents, self.is_accepting) = (false, false);
        self.refit();
    }

    /// The parent folder, as a full path if known.
    #[must_use]
    pub(crate) fn above(&self) -> PathBuf {
        let known = self
            .listing
            .as_ref()
            .map(|listing| listing.folder.parent().unwrap_or(&listing.folder).to_owned());
        known.unwrap_or_else(|| beneath(&self.base, &self.typed_folder).join(".."))
    }

    /// The preview to request, once for each selection.
    pub(crate) fn look(&mut self) -> Option<Viewport> {
        let sight = self.marked_sight();
        if sight == self.looked_at {
            return None;
        }
        self.looked_at.clone_from(&sight);
        sight
    }

    /// Shows a preview if it belongs to the last request.
    pub(crate) fn show(&mut self, sight: Viewport, preview: Preview) {
        if self.looked_at.as_ref() == Some(&sight) {
            self.preview = Some((sight, preview));
        }
    }

    // Hidden entries match only if the user types their dot.
    fn refit(&mut self) {
        let wanted = self.split().1.to_lowercase();
        let fits = |entry: &Entry| {
            (wanted.starts_with('.') || !entry.name.starts_with('.'))
                && entry.folded.contains(&wanted)
        };
        let entries = self
            .listing
            .as_ref()
            .and_then(|listing| listing.entries.as_ref().ok())
            .map(Vec::as_slice);
        let places = |fits: &mut dyn Iterator<Item = bool>| {
            fits.enumerate().filter_map(|(at, fits)| fits.then_some(at)).collect()
        };
        let fitting = places(&mut entries.unwrap_or_default().iter().map(fits));
        let typed = self.input.value().to_lowercase();
        let fitting_recents =
            places(&mut self.recents.iter().map(|recent| recent.folded.contains(&typed)));
        let (fitting_below, fitting_examples) = match self.wanted() {
            None => (Vec::new(), Vec::new()),
            Some(wanted) => {
                let cases =
                    self.own_below().map(|below| below.cases.as_slice()).unwrap_or_default();
                let below = places(&mut cases.iter().map(|case| case.folded.contains(&wanted)));
                (below, places(&mut EXAMPLES.iter().map(|example| example.name.contains(&typed))))
            }
        };
        (self.fitting, self.fitting_recents) = (fitting, fitting_recents);
        (self.fitting_below, self.fitting_examples) = (fitting_below, fitting_examples);
        self.mark_first();
    }

    // The part of a name to search for below and among the examples; hidden names are only searched
    // in this folder.
    fn wanted(&self) -> Option<String> {
        let wanted = self.split().1;
        (!wanted.is_empty() && !wanted.starts_with(['.', '~'])).then(|| wanted.to_lowercase())
    }

    fn own_below(&self) -> Option<&SearchResult> {
        self.below.as_ref().filter(|below| below.asked == self.asks())
    }

    // Selects the first line that is not the parent folder, if any.
    fn mark_first(&mut self) {
        let folder = self.count_of_folder();
        let is_recent = self.count_of_recents() > 0 && (self.prefers_recents || folder == 0);
        self.marked = if is_recent {
            folder
        } else {
            usize::from(self.has_up() && !self.fitting.is_empty()) + self.best()
        };
    }

    // The index of the entry with the typed name, otherwise of one that begins with it.
    fn best(&self) -> usize {
        let wanted = self.split().1.to_lowercase();
        let at = |is_it: &dyn Fn(&Entry) -> bool| self.entries().position(is_it);
        let begins = || at(&|entry| entry.folded.starts_with(&wanted));
        if wanted.is_empty() {
            0
        } else {
            at(&|entry| entry.folded == wanted).or_else(begins).unwrap_or(0)
        }
    }
}

impl Dialog for Browser {
    fn place(&self) -> Place {
        Place::BROWSE
    }

    fn input(&mut self) -> Option<&mut Text> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Job> {
        self.is_accepting = false;
        let list = self.follow().then(|| self.list());
        let below = self.seek().map(|asked| Job::Search(asked, self.place()));
        list.into_iter().chain(below).collect()
    }

    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        self.mark(by);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        self.mark(by * boxes::page_height(around.screen));
    }

    fn click(&mut self, at: Position, screen: Size) -> bool {
        line_at(self, screen, at).is_some_and(|line| boxes::select(&mut self.marked, line))
    }

    // Without a match, opens the typed path.
    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        let is_typed = !self.input.value().is_empty() && !self.prefers_recents;
        if self.listing.is_none() && is_typed {
            self.is_accepting = true;
            return Outcome::none();
        }
        match self.marked_sight() {
            Some(Viewport::Folder(_)) => Outcome::Jobs(self.complete()),
            Some(Viewport::File(path)) => Outcome::Open(path),
            Some(Viewport::Example(example)) => Outcome::Pick(Pick::Begin(example)),
            None if self.input.value().is_empty() => Outcome::none(),
            None => Outcome::Open(self.typed_path()),
        }
    }

    fn preview(&mut self, units: System) -> Option<Job> {
        Some(Job::Preview(self.look()?, units))
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw(self, area, around.look.theme, buffer)
    }
}

/// A folder and the recent cases.
#[derive(Debug, Clone, Default)]
pub struct Browser {
    /// The typed text: a part of a name, or a path.
    pub(crate) input: Text,
    /// The content of the folder; `None` while it is being read.
    pub(crate) listing: Option<Listing>,
    /// The recent cases.
    pub(crate) recents: Vec<Recent>,
    /// The index of the selected line among the matches: first those of the folder, then the recent
    /// cases.
    pub(crate) marked: usize,
    /// The preview of the selected line, once it is read.
    pub(crate) preview: Option<(Viewport, Preview)>,
    /// The start folder or the entered folder, relative to the working directory if possible.
    base: PathBuf,
    /// The folder part of the typed path, which the listing belongs to.
    typed_folder: String,
    /// Indices of the matching entries of the listing.
    fitting: Vec<usize>,
    /// The cases in the folders below, once a search is requested.
    below: Option<SearchResult>,
    /// The folder of that search.
    sought: Option<(PathBuf, String)>,
    /// Indices of the matching cases in the folders below.
    fitting_below: Vec<usize>,
    /// Indices of the matching examples.
    fitting_examples: Vec<usize>,
    /// Indices of the matching recent cases.
    fitting_recents: Vec<usize>,
    /// Whether to select a recent case rather than one of the folder.
    prefers_recents: bool,
    /// The entry to select: the present case, or the folder from which the user went up.
    came_from: Option<OsString>,
    /// The last requested preview.
    looked_at: Option<Viewport>,
    /// Whether Enter waits for the listing of the typed folder.
    is_accepting: bool,
}

/// A line that can be selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Line<'b> {
    /// The parent folder.
    Up,
    /// An entry of the folder.
    Entry(&'b Entry),
    /// A case in a folder below.
    Found(&'b folder::FoundCase),
    /// An example.
    Example(&'static Example),
    /// A recent case.
    Recent(&'b Recent),
}

fn draw(browser: &Browser, screen: Rect, theme: &Theme, buffer: &mut Buffer) -> Option<Position> {
    let inner = boxes::frame("Open a case", SIZE, screen, theme, buffer);
    let folder = browser
        .listing
        .as_ref()
        .map_or_else(String::new, |listing| listing.folder.display().to_string());
    let width = usize::from(inner.width);
    buffer.set_stringn(inner.x, inner.y, text::cut_front(&folder, width), width, theme.title);
    let body = below_line(inner);
    let (left, right) = boxes::halves(body, buffer);
    draw_lists(browser, left, theme, buffer);
    draw_preview(browser, right, theme, buffer);
    let line = Rect { y: inner.y + 1, height: inner.height.saturating_sub(1).min(1), ..inner };
    if browser.input.value().is_empty() {
        buffer.set_stringn(
            line.x + 1,
            line.y,
            " type part of a name or a path; ~ is the home folder",
            width - 1,
            theme.faint,
        );
    }
    text::edited(&browser.input, line, theme.focus, buffer)
}

// The index of the line of the lists at a cell, if any.
fn line_at(browser: &Browser, screen: Size, at: Position) -> Option<usize> {
    let inner = boxes::inside(SIZE, Rect::from((Position::ORIGIN, screen)));
    let (above, below) = stacked(browser, boxes::parted(below_line(inner)).0);
    let first = browser.count_of_folder();
    let in_folder =
        boxes::line_at(first, Some(browser.marked).filter(|&marked| marked < first), above, at);
    let recents = Rect { y: below.y + 1, height: below.height.saturating_sub(1), ..below };
    let recent = || {
        boxes::line_at(browser.count_of_recents(), browser.marked.checked_sub(first), recents, at)
    };
    in_folder.or_else(|| recent().map(|line| first + line))
}

fn below_line(inner: Rect) -> Rect {
    Rect { y: inner.y + 2, height: inner.height.saturating_sub(2), ..inner }
}

// Splits an area into the folder and, below it, the recent cases with their title, if any.
fn stacked(browser: &Browser, area: Rect) -> (Rect, Rect) {
    let recents = browser.count_of_recents().min(RECENTS).min(usize::from(area.height) / 3);
    let height = if recents == 0 { 0 } else { recents as u16 + 1 };
    let above = Rect { height: area.height - height, ..area };
    (above, Rect { y: above.bottom(), height, ..area })
}

fn draw_lists(browser: &Browser, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let (above, below) = stacked(browser, area);
    draw_folder(browser, above, theme, buffer);
    if !below.is_empty() {
        let area = text::titled("Recent cases", below, theme, buffer);
        let first = browser.count_of_folder();
        let name = |at: usize| line_of(browser, first + at);
        let marked = browser.marked.checked_sub(first);
        boxes::draw_window(browser.count_of_recents(), name, marked, area, theme, buffer);
    }
}

fn draw_folder(browser: &Browser, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let count = browser.count_of_folder();
    let marked = Some(browser.marked).filter(|&marked| marked < count);
    let room = usize::from(area.width).saturating_sub(2);
    let line = |at: usize| match browser.line(at) {
        Some(Line::Found(case)) => text::cut_front(&case.name, room),
        _ => line_of(browser, at),
    };
    boxes::draw_window(count, line, marked, area, theme, buffer);
    let said = match &browser.listing {
        None => "reading ...",
        Some(listing) => match &listing.entries {
            Err(reason) => reason,
            Ok(_) if listing.is_cut => "The list is not complete.",
            Ok(entries) if entries.is_empty() => "No folders and no *.toml here.",
            Ok(_) if count == 0 && browser.is_seeking() => "Searching below ...",
            Ok(_) if count == 0 => "No match here or below.",
            Ok(_) => return,
        },
    };
    let from = area.y + u16::try_from(count).unwrap_or(u16::MAX).min(area.height.saturating_sub(3));
    for (line, y) in text::wrap(said, area.width.into()).iter().zip(from..area.bottom()) {
        buffer.set_stringn(
            area.x,
            y,
            format!("{line:<0$}", usize::from(area.width)),
            area.width.into(),
            theme.note,
        );
    }
}

fn line_of(browser: &Browser, at: usize) -> String {
    match browser.line(at) {
        None => String::new(),
        Some(Line::Up) => "../".to_owned(),
        Some(Line::Entry(entry)) if entry.is_folder => format!("{}/", entry.name),
        Some(Line::Entry(entry)) => entry.name.clone(),
        Some(Line::Found(case)) => case.name.clone(),
        Some(Line::Example(example)) => format!("{}  (example)", example.name),
        Some(Line::Recent(recent)) => {
            let name = recent
                .path
                .file_name()
                .map(|name| name.to_string_lossy().into_owned())
                .unwrap_or_default();
            let folder = recent
                .path
                .parent()
                .and_then(Path::file_name)
                .map(|name| name.to_string_lossy().into_owned());
            let missing = if recent.is_missing { "  (missing)" } else { "" };
            let folder = folder.map_or_else(String::new, |folder| format!("  in {folder}/"));
            format!("{name}{missing}{folder}")
        }
    }
}

fn draw_preview(browser: &Browser, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let Some(sight) = browser.marked_sight() else {
        return;
    };
    let is_missing =
        matches!(browser.line(browser.marked), Some(Line::Recent(recent)) if recent.is_missing);
    let preview =
        browser.preview.as_ref().filter(|(own, _)| *own == sight).map(|(_, preview)| preview);
    let mut lines = Vec::new();
    if let (Viewport::File(path), true) = (&sight, browser.marks_recent()) {
        lines.push((text::cut_front(&path.display().to_string(), area.width.into()), theme.faint));
    }
    match preview {
        _ if is_missing => {
            lines.push(("The file does not exist any more.".to_owned(), theme.problem));
        }
        None => lines.push(("reading ...".to_owned(), theme.faint)),
        Some(preview) => lines.extend(lines_of(preview, area.width.into(), theme)),
    }
    for ((line, style), y) in lines.iter().zip(area.top()..area.bottom()) {
        buffer.set_stringn(area.x, y, line, area.width.into(), *style);
    }
}

fn lines_of(preview: &Preview, width: usize, theme: &Theme) -> Vec<(String, Style)> {
    match preview {
        Preview::Case(case, is_newer) => {
            let newer =
                is_newer.then(|| ("Newer format: opens read-only.".to_owned(), theme.problem));
            newer.into_iter().chain(boxes::digest_lines(case, width, theme)).collect()
        }
        Preview::Folder(cases, folders) => {
            let counted = |count: usize, one: &str| {
                if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") }
            };
            vec![(
                format!(
                    "A folder with {}, {}.",
                    counted(*cases, "case"),
                    counted(*folders, "folder")
                ),
                Style::new(),
            )]
        }
        Preview::Draft(fields) => {
            let head = text::wrap("Required values are missing:", width)
                .into_iter()
                .map(|line| (line, theme.note));
            let fields = fields.iter().map(|field| (text::cut(field, width), Style::new()));
            head.chain(fields).collect()
        }
        Preview::Faults(faults, more) => {
            let head = text::wrap("It cannot be opened:", width)
                .into_iter()
                .map(|line| (line, theme.problem));
            let faults = faults
                .iter()
                .flat_map(|fault| text::wrap(fault, width))
                .map(|line| (line, Style::new()));
            let more = (*more > 0).then(|| (format!("and {more} more"), Style::new()));
            head.chain(faults).chain(more).collect()
        }
    }
}
