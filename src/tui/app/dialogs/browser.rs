//! The file browser: a folder on the left, the recent cases below it, the preview of the selected
//! line on the right.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::text::{Line as Words, Span, Text};
use ratatui::widgets::{Clear, Widget};

use super::{Dialog, PreviewPane, Window, draw_details, halves, said};
use crate::case::Example;
use crate::tui::app::App;
use crate::tui::app::actions::{Change, Running, Slot, Work};
use crate::tui::layout::Place;
use crate::tui::settings::{Look, Theme};
use crate::tui::store::folder::{Entry, Listing, Target, beneath, find, list, place_of};
use crate::tui::text;
use crate::tui::text::Line;

/// The full width, and a limited number of lines.
const SIZE: Size = Size { width: u16::MAX, height: 34 };
/// Number of visible recent cases.
const RECENTS: usize = 6;

/// The sources of the lines, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
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

/// The folder of the browser, and the folders typed after it.
type Asked = (PathBuf, String);

/// A folder and the recent cases.
#[derive(Debug, Clone)]
pub struct Browser {
    open: Opens,
    /// The typed text: a part of a name, or a path.
    pub(crate) input: Line,
    /// The start folder or the entered folder, relative to the working directory if possible, and
    /// the folder part of the typed path, which the listing belongs to.
    asked: Asked,
    /// The content of the folder; `None` while it is being read.
    listing: Option<Listing>,
    /// The folder of the requested search below, and whether the search has ended.
    sought: Option<(Asked, bool)>,
    /// The lines, in the order of their sources.
    lines: Vec<(Source, Entry)>,
    /// The indices of the matching lines.
    matches: Vec<usize>,
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
    pub(crate) fn beside(path: Option<&Path>, prefers_recents: bool, open: Opens) -> Browser {
        let base = path.and_then(Path::parent).map(Path::to_owned).unwrap_or_default();
        Browser {
            open,
            input: Line::default(),
            asked: (base, String::new()),
            listing: None,
            sought: None,
            lines: Entry::examples().into_iter().map(|entry| (Examples, entry)).collect(),
            matches: Vec::new(),
            selected: 0,
            prefers_recents,
            came_from: path.and_then(Path::file_name).map(ToOwned::to_owned),
            preview: PreviewPane::default(),
            is_accepting: false,
        }
    }

    /// The work that lists the folder.
    pub(crate) fn list(&self) -> Work {
        let shown = self.shown();
        let show = |app: &mut App, listing| {
            if app.browser().is_some_and(|browser| browser.take(listing)) {
                app.accept();
            }
        };
        let list = move |running: &Running<'_>| Some(list(&shown, running.path.to_owned()));
        Work::new(Slot::Folder, list, show).at(self.folder())
    }

    // At most one search for each folder.
    fn search(&mut self) -> Option<Work> {
        let is_known = self.sought.as_ref().is_some_and(|(asked, _)| *asked == self.asked);
        if !self.searches_below() || is_known {
            return None;
        }
        let (asked, shown) = (self.asked.clone(), self.shown());
        self.sought = Some((asked.clone(), false));
        let search =
            move |running: &Running<'_>| find(&shown, running.path, &|| running.is_wanted());
        let show = |app: &mut App, cases| {
            if let Some(browser) = app.browser() {
                browser.take_below(asked, cases);
            }
        };
        Some(Work::new(Slot::Search, search, show).at(self.folder()))
    }

    /// The path of the typed folder, as far as it is typed.
    fn shown(&self) -> PathBuf {
        beneath(&self.asked.0, &self.asked.1)
    }

    /// The path of the typed folder.
    fn folder(&self) -> PathBuf {
        place_of(&self.asked.0, &self.asked.1)
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
            None => self.shown().join(".."),
        }
    }

    fn enter(&mut self, folder: PathBuf) {
        let left = self.listing.as_ref().filter(|_| folder == self.above());
        self.came_from = left.and_then(|left| left.folder.file_name().map(ToOwned::to_owned));
        (self.input, self.asked, self.listing) = (Line::default(), (folder, String::new()), None);
        (self.prefers_recents, self.is_accepting) = (false, false);
        self.show(Folder, Vec::new());
    }

    /// The typed path up to its last slash, and the rest. A lone `~` is the home folder.
    fn split(&self) -> (&str, &str) {
        let typed = self.input.value();
        let name = typed.rfind('/').map_or(0, |slash| slash + 1);
        if typed == "~" { (typed, "") } else { typed.split_at(name) }
    }

    // Whether the part of a name is also searched below and among the examples; hidden names are
    // only searched in this folder.
    fn searches_below(&self) -> bool {
        let wanted = self.split().1;
        !wanted.is_empty() && !wanted.starts_with(['.', '~'])
    }

    /// Shows the entries of a source.
    fn show(&mut self, source: Source, entries: Vec<Entry>) {
        self.lines.retain(|(own, _)| *own != source);
        self.lines.extend(entries.into_iter().map(|entry| (source, entry)));
        self.lines.sort_by_key(|(source, _)| *source);
        self.refit();
    }

    /// Shows a listing. Returns whether Enter waits for it.
    fn take(&mut self, listing: Listing) -> bool {
        let found: Vec<Entry> = listing.entries.iter().flatten().cloned().collect();
        self.listing = Some(listing);
        let up = Entry::up(self.above());
        self.show(Folder, std::iter::once(up).chain(found).collect());
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
    fn take_below(&mut self, asked: Asked, cases: Vec<Entry>) {
        let before = Some(self.selected).filter(|_| self.source() == Some(Folder));
        self.sought = Some((asked, true));
        self.show(Below, cases);
        self.selected = before.unwrap_or(self.selected);
    }

    /// Shows the recent cases.
    pub fn remember(&mut self, recents: Vec<Entry>) {
        self.show(Recents, recents);
    }

    fn is_searched(&self) -> bool {
        matches!(&self.sought, Some((asked, true)) if *asked == self.asked)
    }

    /// The matching lines of the folder itself.
    fn in_folder(&self) -> impl Iterator<Item = &Entry> {
        let lines = self.matches.iter().map(|&at| &self.lines[at]);
        lines.take_while(|(source, _)| *source == Folder).map(|(_, entry)| entry)
    }

    fn line(&self, at: usize) -> Option<&(Source, Entry)> {
        self.lines.get(*self.matches.get(at)?)
    }

    /// The number of lines before the recent cases.
    fn before_recents(&self) -> usize {
        self.matches.partition_point(|&at| self.lines[at].0 != Recents)
    }

    fn source(&self) -> Option<Source> {
        self.line(self.selected).map(|(source, _)| *source)
    }

    /// The target of the selected line.
    fn target(&self) -> Option<&Target> {
        self.line(self.selected).map(|(_, entry)| &entry.target)
    }

    // Hidden entries match only if the user types their dot.
    fn refit(&mut self) {
        let (wanted, typed) = (self.split().1.to_lowercase(), self.input.value().to_lowercase());
        let (is_below, has_dot) = (self.searches_below(), wanted.starts_with('.'));
        let is_own = self.is_searched();
        let fits = |(source, Entry { folded, .. }): &(Source, Entry)| match source {
            Folder => (has_dot || !folded.starts_with('.')) && folded.contains(&wanted),
            Below => is_own && is_below && folded.contains(&wanted),
            Examples => is_below && folded.contains(&typed),
            Recents => folded.contains(&typed),
        };
        self.matches = (0..self.lines.len()).filter(|&at| fits(&self.lines[at])).collect();
        self.select_first();
    }

    // Selects the entry with the typed name, with or without its ending, otherwise one that begins
    // with the name, otherwise the first one that is not the parent folder.
    fn select_first(&mut self) {
        let wanted = self.split().1.to_lowercase();
        let at = |is_it: &dyn Fn(&str) -> bool| {
            self.in_folder().position(|entry| !entry.folded.is_empty() && is_it(&entry.folded))
        };
        let is_it = |name: &str| name == wanted || name.strip_suffix(".toml") == Some(&wanted);
        let best = at(&is_it).or_else(|| at(&|name| name.starts_with(&wanted)));
        let recents = self.before_recents();
        let is_recent = (self.prefers_recents || recents == 0) && recents < self.matches.len();
        self.selected = if is_recent { recents } else { best.unwrap_or(0) };
    }

    // The list of the folder and the list of recent cases, with the area of its title above it.
    fn windows(&self, area: Rect) -> [Window; 2] {
        let recents = self.before_recents();
        let count = self.matches.len() - recents;
        let shown = count.min(RECENTS).min(usize::from(area.height) / 3);
        let height = if shown == 0 { 0 } else { shown as u16 + 1 };
        let above = Rect { height: area.height - height, ..area };
        let below = Rect { y: above.bottom(), height, ..area };
        let selected = self.selected;
        [
            Window {
                count: recents,
                selected: (selected < recents).then_some(selected),
                area: above,
            },
            Window { count, selected: selected.checked_sub(recents), area: below },
        ]
    }

    fn draw_lists(&self, area: Rect, theme: &Theme, buffer: &mut Buffer) {
        let [above, below] = self.windows(area);
        let name = |at: usize| self.line(at).map_or("", |(_, entry)| entry.name.as_str());
        let in_folder = |at: usize| {
            let name = name(at);
            if name.trim_end_matches('/').contains('/') {
                text::cut_front(name, area.width.saturating_sub(2).into())
            } else {
                name.to_owned()
            }
        };
        above.draw(in_folder, theme, buffer);
        self.draw_state(above.area, theme, buffer);
        if !below.area.is_empty() {
            let title = text::titled(None, "Recent cases", theme.title, area.width, theme);
            let area = text::framed(&title, below.area, buffer);
            let recents = above.count;
            Window { area, ..below }.draw(|at| name(recents + at).to_owned(), theme, buffer);
        }
    }

    // Why the folder has no more lines, below them.
    fn draw_state(&self, area: Rect, theme: &Theme, buffer: &mut Buffer) {
        let count = self.before_recents();
        let state = match self.listing.as_ref().map(|listing| (listing, &listing.entries)) {
            None => "reading ...",
            Some((_, Err(reason))) => reason,
            Some((listing, Ok(_))) if listing.is_cut() => "The list is not complete.",
            Some((_, Ok(entries))) if entries.is_empty() => "No folders and no *.toml here.",
            Some(_) if count > 0 => return,
            Some(_) if self.searches_below() && !self.is_searched() => "Searching below ...",
            Some(_) => "No match here or below.",
        };
        let lines = said(state, theme.note, area.width);
        let above = (count as u16).min(area.height.saturating_sub(3));
        let below = Rect { y: area.y + above, height: area.height - above, ..area };
        Clear.render(Rect { height: below.height.min(lines.len() as u16), ..below }, buffer);
        Text::from(lines).render(below, buffer);
    }

    fn preview_lines(&self, width: u16, look: Look) -> Vec<Words<'static>> {
        let mut lines = Vec::new();
        if let Some((Recents, Entry { target: Target::File(path), .. })) = self.line(self.selected)
        {
            let path = text::cut_front(&path.display().to_string(), width.into());
            lines.push(Words::styled(path, look.theme.faint));
        }
        lines.extend(self.preview.lines(width, look));
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
        if folder == self.asked.1 {
            self.refit();
        } else {
            (self.asked.1, self.listing) = (folder, None);
            self.show(Folder, Vec::new());
            works.push(self.list());
        }
        works.extend(self.search());
        works
    }

    fn step(&mut self, by: isize, _: &App) {
        let last = self.matches.len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }

    fn click(&mut self, at: Position, app: &App) -> bool {
        let [above, mut recents] = self.windows(halves(text::split(app.inside(SIZE), 2)[1])[0]);
        recents.area = text::split(recents.area, 1)[1];
        let recent = || recents.line_at(at).map(|line| above.count + line);
        let line = above.line_at(at).or_else(recent);
        line.is_some_and(|line| std::mem::replace(&mut self.selected, line) == line)
    }

    // Without a match, opens the typed path.
    fn accept(&mut self, _: &App) -> Option<Change> {
        let typed = self.input.value();
        if self.listing.is_none() && !typed.is_empty() && !self.prefers_recents {
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
            None if typed.is_empty() => return None,
            None => beneath(&self.asked.0, typed),
        };
        Some(Change::of(move |app| open(app, path)))
    }

    fn preview(&mut self) -> Option<(&mut PreviewPane, Option<Target>)> {
        let target = self.target().cloned();
        Some((&mut self.preview, target))
    }

    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position> {
        let theme = app.look.theme;
        let inner = app.frame("Open a case", SIZE, buffer);
        let folder = self.listing.as_ref().map(|listing| listing.folder.display().to_string());
        let width = usize::from(inner.width);
        let folder = text::cut_front(&folder.unwrap_or_default(), width);
        Span::styled(folder, theme.title).render(inner, buffer);
        let [left, right] = halves(text::split(inner, 2)[1]);
        self.draw_lists(left, theme, buffer);
        draw_details(|width| self.preview_lines(width, app.look), right, buffer);
        let [line, _] = text::split(text::split(inner, 1)[1], 1);
        if self.input.value().is_empty() {
            let how = "  type part of a name or a path; ~ is the home folder";
            Span::styled(how, theme.faint).render(line, buffer);
        }
        text::edited(&self.input, line, theme.focus, buffer)
    }
}
