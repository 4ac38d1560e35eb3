//! The commands of the user, the table of their keys, names and sentences, and the help page.

use crossterm::event::KeyCode;
use tui_input::InputRequest as Line;

use super::keys::{self, ALT, CTRL, Chord, Place, SHIFT, alt, ctrl, function, key, letter, with};
use super::layout::Pane;
use super::panes::chart::ChartCommand as Chart;
use super::panes::study::StudyCommand as Study;
use super::panes::teeth::TeethCommand as Teeth;
use crate::model::inputs::Method;

use Command as Do;

const ABOUT_KEYS: [&str; 6] = [
    "Every valid edit updates the results and the chart.",
    "Enter a value with its unit: 5 mm, 16 um, 0.2 in, 15 kW, 20 hp, 2000 rpm, 20 deg. To a \
        number without a unit, the workbench adds the unit of the field.",
    "The frame of a pane shows the keys that select the pane: a digit outside a field, Esc and \
        the digit in a field. In a field, digits are part of the value. Esc after the first digit \
        restores the value.",
    "In an empty or fully selected field, / and : start a command.",
    "An empty field shows its default in brackets; (required) marks a missing required value.",
    "D is the first contact of the driven tip, E the start of the normal path of contact. The \
        method paper uses the printed Eqs. 7-20; exact solves for D.",
];

/// The signs, by pane.
const SIGNS: [&str; 6] = [
    "Signs before a field: * changed since the last save; - no effect in this case; ! error or \
        missing required value; ▸ selected.",
    "Signs after a limit: ok, or EXCEEDED (! in a narrow pane), with the value in percent of the \
        limit; (!) the free impact meets the limit, but the force by the method exceeds the \
        limit.",
    "Signs after a result: ← changed by the last edit; ! above its limit; – no value. ▸ marks the \
        column of the case's method.",
    "Column vs baseline: the difference from the baseline; b pins the baseline. \"was none\": the \
        baseline has no value. \"was\" and a value: the program prints no percentage.",
    "Chart curves: dots or * the method of the case; · paper; ∘ exact; × static; + the baseline; \
        ╌ a reference value, such as Δ in the gap chart. Compared stiffness models alternate in the \
        columns that several of them cross. Points on the x axis: D first contact; E \
        and B ends of the path of contact; L last contact; d first contact of another method.",
    "Lines of the teeth: solid: flanks (bold: incoming pair) and, from E to B, the path of \
        contact; dashed: line of action; dotted: base circles and the path of the driven tip \
        before E. Crosses: named points. Bold dots: contacts.",
];

const PLACES: [(&str, Place); 14] = [
    ("Everywhere", Place::WORK),
    ("In a field", Place::TEXT),
    ("Outside a field (Esc leaves the field)", Place::FIELD),
    ("In a field of choices", Place::CHOICE),
    ("In the results", Place::RESULTS),
    ("In chart and teeth", Place::CURSOR),
    ("In accuracy against run time", Place::TRADE),
    ("In the study", Place::STUDY),
    ("In the tolerance", Place::TOLERANCE),
    ("In a list", Place::PICK),
    ("In the list of files", Place::BROWSE),
    ("In a question (or its first letter)", Place::ASK),
    ("In a page like this", Place::READ),
    ("In the explanation of a result", Place::EXPLAIN),
];

/// A command of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each has its sentence in the table of bindings")]
pub enum Command {
    Help,
    Palette,
    SearchField,
    Save,
    SaveAs,
    Reload,
    Journals,
    Relief,
    Export,
    Open,
    Recent,
    FolderUp,
    New,
    Example,
    BuiltIn,
    NextTab,
    PreviousTab,
    Tab(usize),
    CloseTab,
    ToggleMethod,
    Method(Method),
    Undo,
    Redo,
    Show(Pane),
    NextPane,
    PreviousPane,
    CycleLower,
    Zoom,
    ResultsUp,
    ResultsDown,
    Explain,
    Measure,
    TakeSetting,
    SwitchTradeView,
    Notes,
    NextReason,
    PreviousReason,
    PinBaseline,
    CopyValue,
    CopyResults,
    CursorBy(i16),
    CursorToD,
    CursorToE,
    CursorTo,
    CursorAway,
    Play,
    Chart(Chart),
    Teeth(Teeth),
    Study(Study),
    Variant,
    NextVariants,
    CycleMarker,
    ShowCost,
    CycleTheme,
    ToggleAscii,
    CycleUnits,
    ToggleMouse,
    Redraw,
    Suspend,
    Cancel,
    Quit,
    Next,
    Previous,
    NextGroup,
    PreviousGroup,
    First,
    Last,
    FirstField,
    NextFault,
    LastField,
    Step(i32),
    Material,
    Limit,
    NextChoice,
    PreviousChoice,
    StartEdit,
    Complete,
    Accept,
    Leave,
    Edit(Line),
}

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    /// The keys of the command; empty if only the palette runs it.
    pub chords: &'static [Chord],
    /// The command.
    pub(crate) command: Command,
    /// The places in which the keys work.
    pub places: Place,
    /// One or two words for status line and palette; empty if neither shows it.
    pub name: &'static str,
    /// One sentence for palette and help.
    pub sentence: &'static str,
    /// The places in which the status line shows it.
    pub(crate) footer: Place,
}

/// The command that a key calls in a place.
#[must_use]
pub(crate) fn called(chord: Chord, place: Place) -> Option<Command> {
    let bound = BINDINGS
        .iter()
        .find(|binding| binding.places.meets(place) && binding.chords.contains(&chord));
    bound.map(|binding| binding.command)
}

/// The commands of the palette: the first binding of each that has a name and does not belong to a
/// prompt.
pub fn commands() -> impl Iterator<Item = &'static Binding> {
    let is_first = |at: usize, command: Command| {
        !BINDINGS[..at].iter().any(|binding| is_listed(binding) && binding.command == command)
    };
    let listed = BINDINGS.iter().enumerate().filter(|(_, binding)| is_listed(binding));
    listed.filter(move |(at, binding)| is_first(*at, binding.command)).map(|(_, binding)| binding)
}

/// How a command relates to the focused pane and field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Scope {
    /// The command belongs to the focused pane or field.
    Own,
    /// The command works in every pane.
    Everywhere,
    /// The command belongs to another pane.
    Elsewhere,
}

/// The scope of a command if keys go to `place` and `pane` has the focus.
#[must_use]
pub(crate) fn scope(command: Command, place: Place, pane: Pane) -> Scope {
    let is_of_some = |places: Place| !places.holds(Place::OUTSIDE);
    let scope = |binding: &Binding| {
        let is_shown_here = binding.footer.meets(pane.place()) && is_of_some(binding.footer);
        match binding.places {
            places if is_of_some(places) && !places.meets(place) => Scope::Elsewhere,
            places if is_of_some(places) || is_shown_here => Scope::Own,
            _ => Scope::Everywhere,
        }
    };
    let bound = BINDINGS.iter().filter(|binding| is_listed(binding) && binding.command == command);
    bound.map(scope).min().unwrap_or(Scope::Everywhere)
}

/// Every key of the command outside prompts, as text.
pub(crate) fn keys_of(command: Command) -> String {
    let bound = BINDINGS
        .iter()
        .filter(|binding| binding.command == command && binding.places.meets(Place::WORK));
    bound.map(Binding::keys).filter(|keys| !keys.is_empty()).collect::<Vec<_>>().join(", ")
}

/// The first key of the command in a place, and its name in the palette if it has no key. Esc
/// precedes a key that a field takes as text.
pub(crate) fn key_in(place: Place, command: Command) -> String {
    let bound = || {
        BINDINGS
            .iter()
            .filter(|binding| binding.command == command && binding.places.meets(Place::WORK))
    };
    let key = |binding: &Binding| binding.chords.first().map(Chord::name);
    let mut here = bound().filter(|binding| binding.places.meets(place));
    let after_esc = || bound().find_map(key).map(|key| format!("Esc {key}"));
    here.find_map(key).or_else(after_esc).unwrap_or_else(|| {
        let leave = if place.meets(Place::COMMANDED) { "" } else { "Esc " };
        format!("{leave}:{}", bound().next().map_or("", |binding| binding.name))
    })
}

impl Binding {
    /// The keys as text, without Ctrl-H.
    #[must_use]
    pub fn keys(&self) -> String {
        let names = self.chords.iter().filter(|chord| **chord != keys::ctrl('h')).map(Chord::name);
        names.collect::<Vec<_>>().join(", ")
    }
}

/// Every key of the workbench, in the order of the help; the status line shows as many as fit.
#[rustfmt::skip]
pub static BINDINGS: &[Binding] = &[
    // Outside fields, where letters are commands.
    shown(Place::FIELD, &[key(KeyCode::Enter), letter('i')], Do::StartEdit, "edit",
        "Type into the focused field; Esc leaves it."),
    shown(Place::RESULTS, &[key(KeyCode::Enter)], Do::Explain, "explain",
        "Explain the selected result."),
    shown(Place::RESULTS, &[letter('v')], Do::NextVariants, "variants",
        "Show the variants of the case with their differences; again: the next variants, then the \
            methods."),
    shown(Place::TRADE, &[key(KeyCode::Enter)], Do::TakeSetting, "apply setting",
        "Use the selected setting in the case."),
    shown(Place::TRADE, &[letter('m')], Do::Measure, "measure",
        "Benchmark every method and setting with this case on this machine."),
    shown(Place::TRADE, &[letter('v')], Do::SwitchTradeView, "chart/table",
        "Switch between the chart of all settings and the table of methods and compliances."),
    helped(Place::TRADE, &[letter('l'), letter('j'), key(KeyCode::Right), key(KeyCode::Down)], Do::Next,
        "Select the next slower setting."),
    helped(Place::TRADE, &[letter('h'), letter('k'), key(KeyCode::Left), key(KeyCode::Up)], Do::Previous,
        "Select the next faster setting."),
    shown(Place::CURSOR, &[letter(' ')], Do::Play, "play",
        "Play the visible part of the contact, or stop."),
    helped(Place::CURSOR, &[letter('h'), key(KeyCode::Left)], Do::CursorBy(-1),
        "Move the cursor one column towards D."),
    shown(Place::CURSOR, &[letter('l'), key(KeyCode::Right)], Do::CursorBy(1), "cursor",
        "Move the cursor one column towards E."),
    helped(Place::CURSOR, &[letter('H'), with(SHIFT, KeyCode::Left)], Do::CursorBy(-10),
        "Move the cursor ten columns towards D."),
    helped(Place::CURSOR, &[letter('L'), with(SHIFT, KeyCode::Right)], Do::CursorBy(10),
        "Move the cursor ten columns towards E."),
    listed(Place::CURSOR, &[key(KeyCode::Home)], Do::CursorToD, "cursor to D",
        "Move the cursor to the first contact D."),
    listed(Place::CURSOR, &[key(KeyCode::End)], Do::CursorToE, "cursor to E",
        "Move the cursor to E, where the normal path of contact begins."),
    listed(Place::OUTSIDE, &[letter('a')], Do::CursorTo, "cursor to angle",
        "Move the cursor to a roll angle, a time, D, E, B, L or the peak."),
    listed(Place::CURSOR, &[letter('c')], Do::CursorAway, "hide cursor", "Hide the cursor."),
    shown(Place::CHARTS, &[letter('j'), key(KeyCode::Down)], Do::Chart(Chart::Step(1)), "next chart", "Show the next chart."),
    listed(Place::CHARTS, &[letter('k'), key(KeyCode::Up)], Do::Chart(Chart::Step(-1)), "previous chart",
        "Show the previous chart."),
    shown(Place::CHART, &[letter('+'), letter('=')], Do::Chart(Chart::Zoom(1)), "zoom in",
        "Zoom the charts in, around the cursor or D."),
    shown(Place::CHART, &[letter('-')], Do::Chart(Chart::Zoom(-1)), "zoom out",
        "Zoom the charts out, up to the whole contact."),
    shown(Place::CHART, &[letter('0')], Do::Chart(Chart::Whole), "whole contact",
        "Show the whole contact in the charts, from D to the last contact."),
    shown(Place::CHART, &[letter('v')], Do::Chart(Chart::Strike), "strike",
        "Show the charts from D to shortly after E, or the whole contact."),
    shown(Place::CHART, &[letter('t')], Do::Chart(Chart::Time), "time axis",
        "Switch the x axis of the charts: roll angle before E or time after E."),
    shown(Place::TEETH, &[letter('+'), letter('=')], Do::Teeth(Teeth::Zoom(1)), "closer", "Zoom the teeth in."),
    shown(Place::TEETH, &[letter('-')], Do::Teeth(Teeth::Zoom(-1)), "farther",
        "Zoom the teeth out, up to the whole pair."),
    listed(Place::TEETH, &[letter('0')], Do::Teeth(Teeth::Reset), "reset teeth",
        "Show the teeth around the strike again."),
    shown(Place::TEETH, &[letter('v'), letter('j'), key(KeyCode::Down)], Do::Teeth(Teeth::Centre(1)), "view",
        "Switch the view of the teeth: strike, pitch point or whole pair."),
    helped(Place::TEETH, &[letter('k'), key(KeyCode::Up)], Do::Teeth(Teeth::Centre(-1)),
        "Show the previous view."),
    listed(Place::TEETH, &[letter('x')], Do::Teeth(Teeth::Gap), "gap",
        "Draw the gap between the teeth enlarged by the printed factor, or true to scale."),
    shown(Place::STUDY, &[key(KeyCode::Enter)], Do::Study(Study::Take), "use value",
        "Use the value at the cursor in the case."),
    helped(Place::STUDY, &[letter('h'), key(KeyCode::Left)], Do::Study(Study::Move(-1, 0)),
        "Move the cursor of the study left."),
    shown(Place::STUDY, &[letter('l'), key(KeyCode::Right)], Do::Study(Study::Move(1, 0)), "move",
        "Move the cursor of the study right."),
    helped(Place::STUDY, &[with(SHIFT, KeyCode::Left)], Do::Study(Study::Move(-10, 0)),
        "Move the cursor of the study ten points left."),
    helped(Place::STUDY, &[with(SHIFT, KeyCode::Right)], Do::Study(Study::Move(10, 0)),
        "Move the cursor of the study ten points right."),
    helped(Place::STUDY, &[letter('j'), key(KeyCode::Down)], Do::Study(Study::Move(0, -1)),
        "Move the cursor of the map down."),
    helped(Place::STUDY, &[letter('k'), key(KeyCode::Up)], Do::Study(Study::Move(0, 1)),
        "Move the cursor of the map up."),
    shown(Place::STUDY, &[letter('+'), letter('=')], Do::Study(Study::Zoom(1)), "narrower",
        "Halve the range of the study around the present value."),
    shown(Place::STUDY, &[letter('-')], Do::Study(Study::Zoom(-1)), "wider",
        "Double the range of the study, up to the limits of the field."),
    listed(Place::STUDY, &[letter('0')], Do::Study(Study::Reset), "usual range",
        "Show the usual range of the study again."),
    shown(Place::STUDY, &[letter('s')], Do::Study(Study::Second), "second field",
        "Choose a second field for a map, or go back to the curve."),
    shown(Place::TOLERANCE, &[letter('j'), key(KeyCode::Down)], Do::Study(Study::Scroll(1)), "scroll",
        "Scroll the tolerance one line down."),
    helped(Place::TOLERANCE, &[letter('k'), key(KeyCode::Up)], Do::Study(Study::Scroll(-1)),
        "Scroll the tolerance one line up."),
    shown(Place::TOLERANCE, &[letter('l'), key(KeyCode::Right), key(KeyCode::PageDown)], Do::Study(Study::Page(1)),
        "next page", "Go to the next page of the tolerance."),
    helped(Place::TOLERANCE, &[letter('h'), key(KeyCode::Left), key(KeyCode::PageUp)], Do::Study(Study::Page(-1)),
        "Go to the previous page of the tolerance."),
    shown(Place::STUDY.or(Place::TOLERANCE), &[letter('d')], Do::Study(Study::Tolerance), "tolerance",
        "Sample the distributions of [spread], or show the curve again."),
    shown_in(Place::OUTSIDE, Place::COMMANDED, &[letter('/')], Do::SearchField, "search",
        "Find a field or a result by name, symbol, key or a word of its help."),
    shown_in(Place::FIELD, Place::WORK, &[alt('g')], Do::Material, "material",
        "Give this gear, or both gears, a material of the catalogue."),
    shown_in(Place::RESULTS, Place::OUTSIDE, &[letter('n')], Do::Notes, "notes",
        "Show the outcome, the limits and every note in full."),
    shown_in(Place::RESULTS, Place::WORK, &[alt('l')], Do::Limit, "limit",
        "Set a limit on the selected result, or on a result from a list."),
    shown_in(Place::OUTSIDE, Place::COMMANDED, &[letter(':')], Do::Palette, "commands",
        "List commands, fields and results: type a few letters; Enter runs the command or goes \
            there."),
    shown(Place::OUTSIDE, &[letter('q')], Do::Quit, "quit", "Quit; asks if there are unsaved edits."),
    shown(Place::OUTSIDE, &[letter('?')], Do::Help, "help", "Show this page."),
    shown(Place::OUTSIDE, &[key(KeyCode::Tab)], Do::NextPane, "next pane", "Go to the next pane."),
    listed(Place::OUTSIDE, &[key(KeyCode::BackTab)], Do::PreviousPane, "previous pane",
        "Go to the previous pane."),
    shown(Place::OUTSIDE, &[letter('u')], Do::Undo, "undo", "Undo the last edit."),
    shown(Place::OUTSIDE, &[letter('b')], Do::PinBaseline, "baseline",
        "Pin the results as the baseline to compare with, or unpin them."),
    shown(Place::OUTSIDE, &[letter('y')], Do::CopyValue, "copy value",
        "Copy the focused value, or the values at the cursor, to the clipboard of the terminal."),
    shown(Place::OUTSIDE, &[letter('Y')], Do::CopyResults, "copy results",
        "Copy title, verdict, inputs and results with their units to the clipboard of the \
            terminal."),
    shown(Place::OUTSIDE, &[letter('z')], Do::Zoom, "zoom",
        "Show the focused pane alone, or all panes."),
    listed(Place::OUTSIDE, &[letter('1')], Do::Show(Pane::Form), "form", "Go to the form."),
    listed(Place::OUTSIDE, &[letter('2')], Do::Show(Pane::Results), "results", "Go to the results."),
    listed(Place::OUTSIDE, &[letter('3')], Do::Show(Pane::Chart), "chart", "Go to the chart."),
    listed(Place::OUTSIDE, &[letter('4')], Do::Show(Pane::Teeth), "teeth", "Go to the teeth."),
    listed(Place::OUTSIDE, &[letter('5')], Do::Show(Pane::Trade), "trade",
        "Go to accuracy against run time."),
    listed(Place::OUTSIDE, &[letter('6')], Do::Show(Pane::Study), "study",
        "Go to the study: the selected result over a range of the focused field."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('j'), key(KeyCode::Down)], Do::Next, "Go to the next line."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('k'), key(KeyCode::Up)], Do::Previous,
        "Go to the previous line."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('l'), key(KeyCode::Right)], Do::NextGroup,
        "Go to the next group, or page of results."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('h'), key(KeyCode::Left)], Do::PreviousGroup,
        "Go to the previous group, or page of results."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('g'), key(KeyCode::Home)], Do::First, "Go to the first line."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('G'), key(KeyCode::End)], Do::Last, "Go to the last line."),
    // Everywhere.
    shown(Place::WORK, &[function(1), alt('h')], Do::Help, "help", "Show this page."),
    shown(Place::WORK, &[ctrl('s')], Do::Save, "save",
        "Save the case; the file keeps its comments and order."),
    shown(Place::WORK, &[ctrl('p')], Do::Palette, "commands",
        "List commands, fields and results: type a few letters; Enter runs the command or goes \
            there."),
    shown(Place::WORK, &[ctrl('o')], Do::Open, "open", "Open another case in a tab."),
    shown(Place::WORK, &[ctrl('q')], Do::Quit, "quit", "Quit; asks if there are unsaved edits."),
    shown(Place::FORM, &[key(KeyCode::Esc)], Do::Leave, "leave field",
        "Leave the field and keep its value; letters and digits are then commands."),
    shown(Place::WORK, &[ctrl('t'), function(6)], Do::ToggleMethod, "method",
        "Switch the method: paper, exact, static, dynamic, auto."),
    listed(Place::WORK, &[], Do::Method(Method::Paper), "method paper",
        "Use the closed form as printed."),
    listed(Place::WORK, &[], Do::Method(Method::Exact), "method exact",
        "Use the closed form with the exact first contact."),
    listed(Place::WORK, &[], Do::Method(Method::Static), "method static",
        "Use the static load sharing of all pairs in contact."),
    listed(Place::WORK, &[], Do::Method(Method::Dynamic), "method dynamic",
        "Use the motion with inertia and damping."),
    listed(Place::WORK, &[], Do::Method(Method::Auto), "method auto",
        "Use the fastest of exact, static and dynamic within the tolerance."),
    shown(Place::WORK, &[ctrl('z')], Do::Undo, "undo", "Undo the last edit."),
    shown(Place::WORK, &[function(5), alt('p')], Do::CycleLower, "switch",
        "Switch the lower area: chart, teeth, trade, study."),
    listed(Place::WORK, &[function(9)], Do::Zoom, "zoom",
        "Show the focused pane alone, or all panes."),
    listed(Place::WORK, &[function(4), with(CTRL, KeyCode::Down)], Do::ResultsDown, "results down",
        "Scroll the results down."),
    listed(Place::WORK, &[function(3), with(CTRL, KeyCode::Up)], Do::ResultsUp, "results up", "Scroll the results up."),
    listed(Place::WORK, &[function(2), alt('s')], Do::SaveAs, "save as", "Save under another name."),
    listed(Place::WORK, &[], Do::Reload, "reload",
        "Read the file of the case again; asks if there are unsaved edits."),
    listed(Place::WORK, &[alt('x')], Do::Export, "export",
        "Write the report (.html, .md, .csv, .json) or the shown chart or teeth (.svg) to a file."),
    listed(Place::WORK, &[ctrl('n')], Do::New, "new",
        "Start an empty case: required fields are marked, the others show their defaults."),
    listed(Place::WORK, &[alt('n')], Do::Example, "from example",
        "Start a case from one of the examples."),
    listed(Place::WORK, &[alt('t')], Do::BuiltIn, "Table 1",
        "Show the built-in example, Table 1 of the paper."),
    listed(Place::WORK.or(Place::BROWSE), &[alt('r')], Do::Recent, "recent cases", "Open a recent case."),
    listed(Place::WORK, &[with(CTRL, KeyCode::PageDown)], Do::NextTab, "next case",
        "Switch to the next tab."),
    listed(Place::WORK, &[with(CTRL, KeyCode::PageUp)], Do::PreviousTab, "previous case",
        "Switch to the previous tab."),
    listed(Place::WORK, &[alt('w')], Do::CloseTab, "close case",
        "Close the case and its tab; asks if there are unsaved edits."),
    helped(Place::WORK, &[alt('1')], Do::Tab(0),
        "Switch to the first tab; Alt-2 to Alt-9 switch to the others."),
    helped(Place::WORK, &[alt('2')], Do::Tab(1), ""),
    helped(Place::WORK, &[alt('3')], Do::Tab(2), ""),
    helped(Place::WORK, &[alt('4')], Do::Tab(3), ""),
    helped(Place::WORK, &[alt('5')], Do::Tab(4), ""),
    helped(Place::WORK, &[alt('6')], Do::Tab(5), ""),
    helped(Place::WORK, &[alt('7')], Do::Tab(6), ""),
    helped(Place::WORK, &[alt('8')], Do::Tab(7), ""),
    helped(Place::WORK, &[alt('9')], Do::Tab(8), ""),
    listed(Place::WORK, &[], Do::Variant, "variant",
        "Save the edits since the last save as a variant: type variant NAME. Without edits, load \
            that variant into the form."),
    listed(Place::WORK, &[alt('e')], Do::NextFault, "next error",
        "Go to the next field with an error or a missing required value."),
    listed(Place::WORK, &[ctrl('y'), ctrl('r')], Do::Redo, "redo", "Redo the last undone edit."),
    listed(Place::WORK, &[alt('b')], Do::PinBaseline, "baseline",
        "Pin the results as the baseline to compare with, or unpin them."),
    listed(Place::OUTSIDE, &[letter('%')], Do::ShowCost, "cost",
        "Show the stages and the microseconds of the last solve beside the results."),
    listed(Place::WORK, &[function(8), alt('m')], Do::CycleMarker, "marker",
        "Switch the chart marker: Braille, blocks or dots."),
    listed(Place::WORK, &[], Do::Journals, "journals",
        "List the unsaved edits of ended sessions, and delete them on request."),
    listed(Place::WORK, &[], Do::Relief, "relief",
        "Find the tip relief to specify on both gears, and write it into the case."),
    listed(Place::WORK, &[], Do::CycleTheme, "theme", "Switch the colours: quiet, contrast, mono."),
    listed(Place::WORK, &[], Do::ToggleAscii, "ascii", "Switch between ASCII and Unicode."),
    listed(Place::WORK, &[], Do::CycleUnits, "units",
        "Switch results, hints, charts and teeth between metric and inch units."),
    listed(Place::WORK, &[], Do::ToggleMouse, "mouse",
        "Switch the mouse on or off: a click selects, a second click is Enter. With the mouse on, \
            hold Shift to select text."),
    listed(Place::WORK, &[ctrl('l')], Do::Redraw, "redraw", "Redraw the screen."),
    listed(Place::WORK, &[alt('z')], Do::Suspend, "suspend", "Suspend to the shell; fg resumes."),
    shown_in(Place::FORM, Place::FORM.or(Place::FIELD), &[with(SHIFT, KeyCode::Up)], Do::Step(1), "step",
        "Increase the last digit of the value by one."),
    helped(Place::FORM.or(Place::FIELD), &[with(SHIFT, KeyCode::Down)], Do::Step(-1),
        "Decrease the last digit of the value by one."),
    helped(Place::FORM.or(Place::FIELD), &[with(ALT, KeyCode::Up)], Do::Step(10),
        "Increase the last digit of the value by ten."),
    helped(Place::FORM.or(Place::FIELD), &[with(ALT, KeyCode::Down)], Do::Step(-10),
        "Decrease the last digit of the value by ten."),
    helped(Place::FORM, &[key(KeyCode::Down), key(KeyCode::Tab), key(KeyCode::Enter)], Do::Next, "Go to the next field."),
    helped(Place::FORM, &[key(KeyCode::Up), key(KeyCode::BackTab)], Do::Previous,
        "Go to the previous field."),
    helped(Place::FORM.or(Place::FIELD).or(Place::RESULTS), &[key(KeyCode::PageDown)], Do::NextGroup,
        "Go to the next group, or page of results."),
    helped(Place::FORM.or(Place::FIELD).or(Place::RESULTS), &[key(KeyCode::PageUp)], Do::PreviousGroup,
        "Go to the previous group, or page of results."),
    helped(Place::WORK, &[with(CTRL, KeyCode::Home)], Do::FirstField, "Go to the first field."),
    helped(Place::WORK, &[with(CTRL, KeyCode::End)], Do::LastField, "Go to the last field."),
    helped(Place::CHOICE, &[key(KeyCode::Right), letter(' ')], Do::NextChoice,
        "Select the next choice."),
    helped(Place::CHOICE, &[key(KeyCode::Left)], Do::PreviousChoice, "Select the previous choice."),
    helped(Place::CHOICE, &[key(KeyCode::Backspace), key(KeyCode::Delete), ctrl('h')], Do::Edit(Line::DeleteLine),
        "Remove the choice: the default applies."),
    helped(Place::CHOICE, &[letter('?')], Do::Help, "Show this page."),
    helped(Place::OUTSIDE, &[key(KeyCode::Esc)], Do::Leave,
        "Stop the running work, hide the cursor or go back to the form; no edit is lost."),
    // In prompts.
    shown(Place::BROWSE, &[key(KeyCode::Tab)], Do::Complete, "complete",
        "Open the selected folder, or complete the selected name."),
    shown(Place::BROWSE, &[with(ALT, KeyCode::Up)], Do::FolderUp, "folder up",
        "Go to the parent folder; so does Backspace in an empty line."),
    shown(Place::EXPLAIN, &[key(KeyCode::Tab)], Do::NextReason, "next field",
        "Select the next field that the result depends on."),
    helped(Place::EXPLAIN, &[key(KeyCode::BackTab)], Do::PreviousReason, "Go to the previous field."),
    shown(Place::EXPLAIN, &[key(KeyCode::Enter)], Do::Accept, "go to field",
        "Go to the selected field of the form."),
    helped(Place::EXPLAIN, &[letter('q')], Do::Leave, "Close the page."),
    helped(Place::ASK, &[key(KeyCode::Tab), key(KeyCode::Right), key(KeyCode::Down)], Do::Next,
        "Select the next button."),
    helped(Place::ASK, &[key(KeyCode::BackTab), key(KeyCode::Left), key(KeyCode::Up)], Do::Previous,
        "Select the previous button."),
    helped(Place::LIST.or(Place::PAGE), &[key(KeyCode::Down)], Do::Next, "Go to the next line."),
    helped(Place::LIST.or(Place::PAGE), &[key(KeyCode::Up)], Do::Previous,
        "Go to the previous line."),
    helped(Place::PICK, &[ctrl('n'), key(KeyCode::Tab)], Do::Next, "Go to the next line."),
    helped(Place::PICK, &[ctrl('p'), key(KeyCode::BackTab)], Do::Previous,
        "Go to the previous line."),
    helped(Place::PAGE, &[letter('j')], Do::Next, "Go to the next line."),
    helped(Place::PAGE, &[letter('k')], Do::Previous, "Go to the previous line."),
    shown(Place::LIST.or(Place::PAGE), &[key(KeyCode::PageDown)], Do::NextGroup, "next page", "Go to the next page."),
    helped(Place::PAGE, &[letter(' ')], Do::NextGroup, "Go to the next page."),
    helped(Place::LIST.or(Place::PAGE), &[key(KeyCode::PageUp)], Do::PreviousGroup,
        "Go to the previous page."),
    shown(Place::LIST.or(Place::PATH).or(Place::ASK), &[key(KeyCode::Enter)], Do::Accept, "accept", "Accept."),
    helped(Place::READ, &[key(KeyCode::Enter), letter('q'), letter('?'), function(1)], Do::Leave, "Close the page."),
    shown(Place::PROMPT, &[key(KeyCode::Esc)], Do::Leave, "back", "Close; no edit is lost."),
    helped(Place::ALL, &[ctrl('c'), ctrl('\\')], Do::Cancel,
        "Close a dialog or stop the running work. Otherwise press twice to quit; asks before \
            unsaved edits are discarded."),
    // In an input line.
    helped(Place::LINE, &[key(KeyCode::Left)], Do::Edit(Line::GoToPrevChar),
        "Move one character left."),
    helped(Place::LINE, &[key(KeyCode::Right)], Do::Edit(Line::GoToNextChar),
        "Move one character right."),
    helped(Place::LINE, &[with(CTRL, KeyCode::Left), with(ALT, KeyCode::Left)], Do::Edit(Line::GoToPrevWord), "Move one word left."),
    helped(Place::LINE, &[with(CTRL, KeyCode::Right), with(ALT, KeyCode::Right)], Do::Edit(Line::GoToNextWord), "Move one word right."),
    helped(Place::LINE, &[key(KeyCode::Home), ctrl('a')], Do::Edit(Line::GoToStart),
        "Move to the start of the value."),
    helped(Place::LINE, &[key(KeyCode::End), ctrl('e')], Do::Edit(Line::GoToEnd),
        "Move to the end of the value."),
    helped(Place::LINE, &[key(KeyCode::Backspace), ctrl('h')], Do::Edit(Line::DeletePrevChar),
        "Delete the character before the cursor."),
    helped(Place::LINE, &[key(KeyCode::Delete), ctrl('d')], Do::Edit(Line::DeleteNextChar),
        "Delete the character after the cursor."),
    helped(Place::LINE, &[ctrl('w'), with(ALT, KeyCode::Backspace)], Do::Edit(Line::DeletePrevWord),
        "Delete the word before the cursor."),
    helped(Place::LINE, &[ctrl('k')], Do::Edit(Line::DeleteTillEnd),
        "Delete from the cursor to the end."),
    helped(Place::LINE.or(Place::CHOICE), &[ctrl('u')], Do::Edit(Line::DeleteLine),
        "Empty the field: it shows its default in brackets."),
];

/// The lines of the help.
#[must_use]
pub fn help() -> Vec<String> {
    let mut lines: Vec<String> = ABOUT_KEYS.iter().map(|&line| line.to_owned()).collect();
    lines.extend(["", "Signs"].into_iter().chain(SIGNS).map(str::to_owned));
    let mut is_listed = vec![false; BINDINGS.len()];
    for (title, place) in PLACES {
        lines.extend([String::new(), title.to_owned()]);
        let is_here = |binding: &Binding| {
            if place == Place::WORK {
                binding.places.holds(place)
            } else {
                binding.places.meets(place)
            }
        };
        let mut here: Vec<_> =
            (0..BINDINGS.len()).filter(|&at| !is_listed[at] && is_here(&BINDINGS[at])).collect();
        for &at in &here {
            is_listed[at] = true;
        }
        // Commands of every status line are listed first.
        here.sort_by_key(|&at| place == Place::WORK && !BINDINGS[at].footer.holds(place));
        lines.extend(here.into_iter().filter_map(|at| help_line(&BINDINGS[at])));
    }
    lines
}

fn is_listed(binding: &Binding) -> bool {
    !binding.name.is_empty()
        && binding.places.meets(Place::WORK)
        && binding.command != Command::Leave
}

// For the status line, the palette and the help.
const fn shown(
    places: Place,
    chords: &'static [Chord],
    command: Command,
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    shown_in(places, places, chords, command, name, sentence)
}

// For the palette and the help, and for the status line of some places.
const fn shown_in(
    footer: Place,
    places: Place,
    chords: &'static [Chord],
    command: Command,
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    Binding { chords, command, places, name, sentence, footer }
}

// For the palette and the help.
const fn listed(
    places: Place,
    chords: &'static [Chord],
    command: Command,
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    shown_in(Place::NONE, places, chords, command, name, sentence)
}

// For the help only.
const fn helped(
    places: Place,
    chords: &'static [Chord],
    command: Command,
    sentence: &'static str,
) -> Binding {
    shown_in(Place::NONE, places, chords, command, "", sentence)
}

fn help_line(binding: &Binding) -> Option<String> {
    let keys =
        if binding.chords.is_empty() { format!(":{}", binding.name) } else { binding.keys() };
    (!binding.sentence.is_empty()).then(|| format!("  {keys:<24} {}", binding.sentence))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_has_two_meanings_in_a_place() {
        for (index, binding) in BINDINGS.iter().enumerate() {
            for other in &BINDINGS[index + 1..] {
                let shared = binding.chords.iter().find(|chord| other.chords.contains(chord));
                assert!(
                    !binding.places.meets(other.places) || shared.is_none(),
                    "{shared:?}: {}",
                    binding.sentence
                );
            }
        }
    }

    /// Letters with similar meanings in several panes: move, more or less, start again, other view.
    const ALIKE: &str = "hjklgG+=-0v";

    #[test]
    fn a_letter_has_one_meaning_in_all_panes() {
        for letter in ('!'..='~').filter(|letter| !ALIKE.contains(*letter)) {
            let chord = keys::letter(letter);
            let bound = BINDINGS
                .iter()
                .filter(|one| one.places.meets(Place::OUTSIDE) && one.chords.contains(&chord));
            let mut commands: Vec<_> = bound.map(|one| one.command).collect();
            commands.dedup();
            assert!(commands.len() <= 1, "{letter}: {commands:?}");
        }
    }

    #[test]
    fn the_letters_that_move_do_so_in_every_pane() {
        for place in [
            Place::FIELD,
            Place::RESULTS,
            Place::CHART,
            Place::TEETH,
            Place::TRADE,
            Place::STUDY,
            Place::TOLERANCE,
        ] {
            for (letter, arrow) in [
                ('h', KeyCode::Left),
                ('j', KeyCode::Down),
                ('k', KeyCode::Up),
                ('l', KeyCode::Right),
            ] {
                let moved = called(keys::letter(letter), place);
                assert!(moved.is_some(), "{letter} in {place:?}");
                assert_eq!(moved, called(keys::key(arrow), place), "{letter} in {place:?}");
            }
        }
    }

    #[test]
    fn one_command_has_one_name_and_one_sentence() {
        for binding in BINDINGS.iter().filter(|binding| is_listed(binding)) {
            for other in BINDINGS.iter().filter(|other| is_listed(other)) {
                let same = binding.command == other.command;
                assert_eq!(same, binding.name == other.name, "{} {}", binding.name, other.name);
                assert!(!same || binding.sentence == other.sentence, "{}", binding.name);
            }
        }
    }
}
