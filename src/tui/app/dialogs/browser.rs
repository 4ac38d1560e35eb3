//! The file browser: a folder on the left, the recent cases below it, the preview of the selected
//! line on the right.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::text::Line as Words;
use ratatui::widgets::{Clear, Widget};

use super::boxes::{self, PreviewPane};
use super::{Dialog, Surroundings};
use crate::case::Example;
use crate::case::units::System;
use crate::tui::app::App;
use crate::tui::app::actions::{Change, Slot, Work};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::store::folder::{
    Entry, Listing, Preview, SearchResult, Target, beneath, find, list, place_of,
};
use crate::tui::text;
use crate::tui::theme::Theme;

/// The full width, and a limited number of lines.
const SIZE: Size = Size { width: u16::MAX, height: 34 };
/// Number of visible recent cases.
const RECENTS: usize = 6;

/// The sources of the lines, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// The folder, with its parent.
    Folder,
    /// The cases in the folders below.
    Below,
    Examples,
    Recents,
}

use Source::{Below, Examples, Folder, Recents};

/// The functions that open a file or an example.
pub(crate) type Opens = (fn(&mut App, PathBuf), fn(&mut App, &'static Example));

/// A folder and the recent cases.
#[derive(Debug, Clone)]
pub struct Browser {
    open: Opens,
    /// The typed text: a part of a name, or a path.
    pub(crate) input: Line,
    /// The start folder or the entered folder, relative to the working directory if possible.
    base: PathBuf,
    /// The folder part of the typed path, which the listing belongs to.
    typed_folder: String,
    /// The content of the folder; `None` while it is being read.
    listing: Option<Listing>,
    /// The folder of the requested search below, and its result.
    sought: Option<(PathBuf, String)>,
    below: Option<SearchResult>,
    /// The lines of each source.
    entries: [Vec<Entry>; 4],
    /// The matching lines: their source and their index in it.
    matches: Vec<(Source, usize)>,
    /// The index of the selected line among the matches.
    selected: usize,
    /// Whether to select a recent case rather than one of the folder.
    prefers_recents: bool,
    /// The entry to select: the present case, or the folder from which the user went up.
    came_from: Option<OsString>,
    preview: PreviewPane,
    /// Whether Enter waits for the listing of the typed folder.
    is_accepting: bool,
}

impl Browser {
    /// A browser in the folder of the present case; selects the recent cases if they are preferred.
    #[must_use]
    pub(crate) fn beside(path: Option<&Path>, prefers_recents: bool, open: Opens) -> Browser {
        Browser {
            open,
            input: Line::default(),
            base: path.and_then(Path::parent).map(Path::to_owned).unwrap_or_default(),
            typed_folder: String::new(),
            listing: None,
            sought: None,
            below: None,
            entries: [Vec::new(), Vec::new(), Entry::examples(), Vec::new()],
            matches: Vec::new(),
            selected: 0,
            prefers_recents,
            came_from: path.and_then(Path::file_name).map(ToOwned::to_owned),
            preview: PreviewPane::default(),
            is_accepting: false,
        }
    }

    /// The work that lists the folder.
    #[must_use]
    pub(crate) fn list(&self) -> Work {
        let asked = self.asked();
        let show = |app: &mut App, listing| {
            if app.browser().is_some_and(|browser| browser.take(listing)) {
                app.accept();
            }
        };
        Work::new(Slot::Folder, |running| Some(list(asked, running.path.to_owned())), show)
            .at(self.place())
    }

    // At most one search for each folder.
    fn search(&mut self) -> Option<Work> {
        let asked = self.asked();
        if !self.searches_below() || self.sought.as_ref() == Some(&asked) {
            return None;
        }
        self.sought = Some(asked.clone());
        let search = Work::new(
            Slot::Search,
            move |running| find(asked, running.path, &|_| running.is_wanted()),
            |app, found| {
                if let Some(browser) = app.browser() {
                    browser.take_below(found);
                }
            },
        );
        Some(search.at(self.place()))
    }

    /// The path of the typed folder.
    fn place(&self) -> PathBuf {
        place_of(&self.base, &self.typed_folder)
    }

    /// Enters the selected folder, or writes the selected name into the line.
    pub(crate) fn complete(&mut self) -> Vec<Work> {
        match self.target().cloned() {
            Some(Target::Folder(folder)) => {
                self.enter(folder);
                return vec![self.list()];
            }
            Some(Target::File(path)) => self.input = path.display().to_string().into(),
            Some(Target::Example(example)) => self.input = example.name.into(),
            None => return Vec::new(),
        }
        self.typed()
    }

    /// Selects the first recent case, or goes back to the folder.
    pub(crate) fn select_recents(&mut self) {
        self.prefers_recents = self.source() != Some(Recents);
        self.select_first();
    }

    /// Enters the parent folder, as a full path if known, and returns the work that lists it.
    pub(crate) fn leave(&mut self) -> Work {
        self.enter(self.above());
        self.list()
    }

    fn above(&self) -> PathBuf {
        match &self.listing {
            Some(Listing { folder, .. }) => folder.parent().unwrap_or(folder).to_owned(),
            None => beneath(&self.base, &self.typed_folder).join(".."),
        }
    }

    fn enter(&mut self, folder: PathBuf) {
        let left = self.listing.as_ref().filter(|_| folder == self.above());
        self.came_from = left.and_then(|left| left.folder.file_name().map(ToOwned::to_owned));
        self.base = folder;
        (self.input, self.typed_folder, self.listing) = (Line::default(), String::new(), None);
        (self.prefers_recents, self.is_accepting) = (false, false);
        self.entries[Folder as usize].clear();
        self.refit();
    }

    /// The folder and the typed part of the requested listing.
    fn asked(&self) -> (PathBuf, String) {
        (self.base.clone(), self.typed_folder.clone())
    }

    /// The typed path up to its last slash, and the rest. A lone `~` is the home folder.
    fn split(&self) -> (&str, &str) {
        let typed = self.input.value();
        let name = typed.rfind('/').map_or(0, |slash| slash + 1);
        if typed == "~" { (typed, "") } else { typed.split_at(name) }
    }

    // The part of a name to search for below and among the examples; hidden names are only searched
    // in this folder.
    fn searches_below(&self) -> bool {
        let wanted = self.split().1;
        !wanted.is_empty() && !wanted.starts_with(['.', '~'])
    }

    /// Shows a listing if it belongs to the present folder. Returns whether Enter waits for it.
    fn take(&mut self, listing: Listing) -> bool {
        if listing.asked != self.asked() {
            return false;
        }
        let found: Vec<Entry> = listing.entries.iter().flatten().cloned().collect();
        self.listing = Some(listing);
        let up = Entry::up(self.above());
        self.entries[Folder as usize] = std::iter::once(up).chain(found).collect();
        self.refit();
        let came_from = self.came_from.take();
        let is_it = |entry: &Entry| match &entry.target {
            Target::File(path) | Target::Folder(path) => {
                !entry.folded.is_empty() && path.file_name() == came_from.as_deref()
            }
            Target::Example(_) => false,
        };
        let at = self.in_folder().position(is_it).filter(|_| !self.prefers_recents);
        self.selected = at.unwrap_or(self.selected);
        std::mem::take(&mut self.is_accepting)
    }

    /// Shows the cases in the folders below; a selection before them does not change.
    fn take_below(&mut self, below: SearchResult) {
        let selected = self.selected;
        let is_above = self.source() == Some(Folder);
        self.entries[Below as usize].clone_from(&below.cases);
        self.below = Some(below);
        self.refit();
        self.selected = if is_above { selected } else { self.selected };
    }

    /// Shows the recent cases.
    pub fn remember(&mut self, recents: Vec<Entry>) {
        self.entries[Recents as usize] = recents;
        self.refit();
    }

    fn is_searched(&self) -> bool {
        self.below.as_ref().is_some_and(|below| below.asked == self.asked())
    }

    /// The matching lines of the folder itself.
    fn in_folder(&self) -> impl Iterator<Item = &Entry> {
        let own = self.matches.iter().take_while(|(source, _)| *source == Folder);
        own.map(|&(_, at)| &self.entries[Folder as usize][at])
    }

    fn entry(&self, at: usize) -> Option<&Entry> {
        let &(source, at) = self.matches.get(at)?;
        self.entries[source as usize].get(at)
    }

    /// The number of lines before the recent cases.
    fn before_recents(&self) -> usize {
        self.matches.partition_point(|(source, _)| *source != Recents)
    }

    fn source(&self) -> Option<Source> {
        self.matches.get(self.selected).map(|(source, _)| *source)
    }

    /// The target of the selected line.
    fn target(&self) -> Option<&Target> {
        self.entry(self.selected).map(|entry| &entry.target)
    }

    // Hidden entries match only if the user types their dot.
    fn refit(&mut self) {
        let (wanted, typed) = (self.split().1.to_lowercase(), self.input.value().to_lowercase());
        let (is_below, has_dot) = (self.searches_below(), wanted.starts_with('.'));
        let is_own = self.is_searched();
        let fits = |source: Source, entry: &Entry| match source {
            Folder => (has_dot || !entry.folded.starts_with('.')) && entry.folded.contains(&wanted),
            Below => is_own && is_below && entry.folded.contains(&wanted),
            Examples => is_below && entry.folded.contains(&typed),
            Recents => entry.folded.contains(&typed),
        };
        let sources = [Folder, Below, Examples, Recents].into_iter();
        let all = sources.flat_map(|source| {
            self.entries[source as usize].iter().enumerate().map(move |one| (source, one))
        });
        let fitting = all.filter(|(source, (_, entry))| fits(*source, entry));
        self.matches = fitting.map(|(source, (at, _))| (source, at)).collect();
        self.select_first();
    }

    // Selects the entry with the typed name, otherwise one that begins with it, otherwise the first
    // one that is not the parent folder.
    fn select_first(&mut self) {
        let wanted = self.split().1.to_lowercase();
        let at = |is_it: &dyn Fn(&str) -> bool| {
            self.in_folder().position(|entry| is_it(entry.folded.as_str()))
        };
        let best = at(&|name| name == wanted && !name.is_empty())
            .or_else(|| at(&|name| !name.is_empty() && name.starts_with(&wanted)))
            .unwrap_or(0);
        let recents = self.before_recents();
        let is_recent = self.prefers_recents || recents == 0;
        self.selected = if is_recent && recents < self.matches.len() { recents } else { best };
    }

    // The folder, and the recent cases with their title below it.
    fn lists(&self, area: Rect) -> [Rect; 2] {
        let recents = self.matches.len() - self.before_recents();
        let recents = recents.min(RECENTS).min(usize::from(area.height) / 3);
        let height = if recents == 0 { 0 } else { recents as u16 + 1 };
        let above = Rect { height: area.height - height, ..area };
        [above, Rect { y: above.bottom(), height, ..area }]
    }

    fn draw_lists(&self, area: Rect, theme: &Theme, buffer: &mut Buffer) {
        let [above, below] = self.lists(area);
        let recents = self.before_recents();
        let name = |at: usize| {
            let name = self.entry(at).map_or("", |entry| &entry.name);
            let is_path = name.trim_end_matches('/').contains('/') && at < recents;
            if is_path {
                text::cut_front(name, area.width.saturating_sub(2).into())
            } else {
                name.to_owned()
            }
        };
        boxes::draw_window(recents, name, Some(self.selected), above, theme, buffer);
        self.draw_state(above, theme, buffer);
        if !below.is_empty() {
            let area = text::titled("Recent cases", below, theme, buffer);
            let name = |at: usize| name(recents + at);
            let count = self.matches.len() - recents;
            let selected = self.selected.checked_sub(recents);
            boxes::draw_window(count, name, selected, area, theme, buffer);
        }
    }

    // Why the folder has no more lines, below them.
    fn draw_state(&self, area: Rect, theme: &Theme, buffer: &mut Buffer) {
        let count = self.before_recents();
        let state = match &self.listing {
            None => "reading ...",
            Some(listing) => match &listing.entries {
                Err(reason) => reason,
                Ok(_) if listing.is_cut() => "The list is not complete.",
                Ok(entries) if entries.is_empty() => "No folders and no *.toml here.",
                Ok(_) if count > 0 => return,
                Ok(_) if self.searches_below() && !self.is_searched() => "Searching below ...",
                Ok(_) => "No match here or below.",
            },
        };
        let lines: Vec<_> = boxes::said(state, theme.note, area.width).collect();
        let above = (count as u16).min(area.height.saturating_sub(3));
        let below = Rect { y: area.y + above, height: area.height - above, ..area };
        Clear.render(Rect { height: below.height.min(lines.len() as u16), ..below }, buffer);
        text::draw_lines(&lines, below, buffer);
    }

    fn preview_lines(&self, width: u16, theme: &Theme) -> Vec<Words<'static>> {
        let mut lines = Vec::new();
        if let (Some(Target::File(path)), Some(Recents)) = (self.target(), self.source()) {
            let path = text::cut_front(&path.display().to_string(), width.into());
            lines.push(Words::styled(path, theme.faint));
        }
        lines.extend(self.preview.lines(width, theme));
        lines
    }
}

impl Dialog for Browser {
    fn place(&self) -> Place {
        Place::BROWSE
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Work> {
        self.is_accepting = false;
        let mut works = Vec::new();
        let folder = self.split().0.to_owned();
        if folder != self.typed_folder {
            (self.typed_folder, self.listing) = (folder, None);
            self.entries[Folder as usize].clear();
            works.push(self.list());
        }
        self.refit();
        works.extend(self.search());
        works
    }

    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        let last = self.matches.len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }

    fn click(&mut self, at: Position, screen: Rect) -> bool {
        let [above, below] = self.lists(boxes::halves(body(boxes::inside(SIZE, screen)))[0]);
        let recents = self.before_recents();
        let selected = Some(self.selected).filter(|&selected| selected < recents);
        let in_folder = boxes::line_at(recents, selected, above, at);
        let below = Rect { y: below.y + 1, height: below.height.saturating_sub(1), ..below };
        let recent = || {
            let count = self.matches.len() - recents;
            boxes::line_at(count, self.selected.checked_sub(recents), below, at)
        };
        let line = in_folder.or_else(|| recent().map(|line| recents + line));
        line.is_some_and(|line| boxes::select(&mut self.selected, line))
    }

    // Without a match, opens the typed path.
    fn accept(&mut self, _: &Surroundings<'_>) -> Option<Change> {
        let is_typed = !self.input.value().is_empty() && !self.prefers_recents;
        if self.listing.is_none() && is_typed {
            self.is_accepting = true;
            return None;
        }
        let (open, begin) = self.open;
        let path = match self.target() {
            Some(Target::Folder(_)) => {
                let works = self.complete();
                return Some(Change::of(|app| app.start_all(works)));
            }
            Some(&Target::Example(example)) => {
                return Some(Change::of(move |app| {
                    app.prompts.pop();
                    begin(app, example);
                }));
            }
            Some(Target::File(path)) => path.clone(),
            None if self.input.value().is_empty() => return None,
            None => beneath(&self.base, self.input.value()),
        };
        Some(Change::of(move |app| open(app, path)))
    }

    fn preview(&mut self, units: System) -> Option<Work> {
        let target = self.target().cloned();
        self.preview.request(target, units)
    }

    fn show(&mut self, target: &Target, preview: Preview) {
        self.preview.show(target, preview);
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let inner = boxes::frame("Open a case", SIZE, area, theme, buffer);
        let folder = self.listing.as_ref().map(|listing| listing.folder.display().to_string());
        let width = usize::from(inner.width);
        let folder = text::cut_front(&folder.unwrap_or_default(), width);
        buffer.set_stringn(inner.x, inner.y, folder, width, theme.title);
        let [left, right] = boxes::halves(body(inner));
        self.draw_lists(left, theme, buffer);
        boxes::draw_details(|width| self.preview_lines(width, theme), right, buffer);
        let line = Rect { y: inner.y + 1, height: inner.height.saturating_sub(1).min(1), ..inner };
        if self.input.value().is_empty() {
            let how = "  type part of a name or a path; ~ is the home folder";
            buffer.set_stringn(line.x, line.y, how, width, theme.faint);
        }
        text::edited(&self.input, line, theme.focus, buffer)
    }
}

fn body(inner: Rect) -> Rect {
    Rect { y: inner.y + 2, height: inner.height.saturating_sub(2), ..inner }
}
