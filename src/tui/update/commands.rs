//! The commands of the user: the table of their keys, names, sentences and functions, the help page,
//! the palette, and the settings.

use std::collections::BTreeSet;

use crossterm::event::KeyCode::{
    BackTab, Backspace, Delete, Down, End, Enter, Esc, Home, Left, PageDown, PageUp, Right, Tab, Up,
};
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::symbols::Marker;
use tui_input::InputRequest as Line;

use super::{dialogs, edit, export, files, navigation, panes, study, trade, variants};
use crate::case::{Acting, FIELDS, Field, relevance};
use crate::model::inputs::Method;
use crate::tui::app::App;
use crate::tui::app::actions::{Action, Binding, Effect};
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::page::Page;
use crate::tui::dialogs::picker::{Context, Item, Pick, Picker};
use crate::tui::keys::{
    self, ALT, CTRL, Chord, Place, SHIFT, alt, ctrl, function, key, letter, with,
};
use crate::tui::layout::Pane;
use crate::tui::panes::chart::ChartCommand as Chart;
use crate::tui::panes::results::Results;
use crate::tui::panes::teeth::TeethCommand as Teeth;
use crate::tui::rows;
use crate::tui::session::save::Next;
use crate::tui::settings::marker_name;

/// A command of the status line that the palette leaves out.
const LEAVE_FIELD: &str = "leave field";
const UNICODE: &str = "drawn in Unicode; a locale without UTF-8 keeps it for this session only";

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

/// The action of a key in a place.
#[must_use]
pub fn of_key(event: KeyEvent, place: Place) -> Option<Action> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let chord = Chord::of(event);
    called(chord, place).map(Action::Do).or_else(|| typed(chord, place))
}

fn called(chord: Chord, place: Place) -> Option<&'static Binding> {
    let mut bound = BINDINGS.iter().filter(|binding| binding.places.meets(place));
    bound.find(|binding| binding.chords.contains(&chord))
}

fn typed(chord: Chord, place: Place) -> Option<Action> {
    match chord {
        Chord(KeyCode::Char(letter), KeyModifiers::NONE) if place.meets(Place::TYPED) => {
            Some(Action::Insert(letter))
        }
        Chord(KeyCode::Char(letter), KeyModifiers::NONE) if place.meets(Place::OUTSIDE) => {
            Some(Action::Stray(letter))
        }
        _ => None,
    }
}

/// The rows of the command with a name.
pub fn named(name: &str) -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(move |binding| is_listed(binding) && binding.name == name)
}

/// The first key of the command with a name in a place, and its name in the palette if it has no
/// key. Esc precedes a key that a field takes as text.
pub(super) fn key_in(place: Place, name: &str) -> String {
    let key = |binding: &Binding| binding.chords.first().map(Chord::name);
    let mut here = named(name).filter(|binding| binding.places.meets(place));
    let after_esc = || named(name).find_map(key).map(|key| format!("Esc {key}"));
    here.find_map(key).or_else(after_esc).unwrap_or_else(|| {
        let leave = if place.meets(Place::COMMANDED) { "" } else { "Esc " };
        format!("{leave}:{name}")
    })
}

/// How a command relates to the focused pane and field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Scope {
    /// The command belongs to the focused pane or field.
    Own,
    /// The command works in every pane.
    Everywhere,
    /// The command belongs to another pane.
    Elsewhere,
}

/// The commands of the palette, those of the focused pane and field first.
pub(crate) fn items(app: &App) -> Vec<Item> {
    let mut seen = BTreeSet::new();
    let names = BINDINGS.iter().filter(|binding| is_listed(binding)).map(|binding| binding.name);
    let mut names: Vec<&str> = names.filter(|name| seen.insert(*name)).collect();
    names.sort_by_key(|name| scope(app, name));
    names.into_iter().filter_map(item).collect()
}

fn item(name: &'static str) -> Option<Item> {
    let keys = named(name).map(Binding::keys).filter(|keys| !keys.is_empty());
    Some(Item {
        pick: Pick::Run(name),
        name: name.to_owned(),
        about: named(name).next()?.sentence.to_owned(),
        keys: keys.collect::<Vec<_>>().join(", "),
    })
}

/// The scope of a command; in the form, the focused row decides too.
fn scope(app: &App, name: &str) -> Scope {
    let (place, pane, row) = (app.place(), app.layout.focus(), app.tab.form.focus);
    let field = rows::field(&app.tab.case, row);
    let is_of_row = match name {
        _ if pane != Pane::Form => None,
        "step" => Some(rows::stepped(&app.tab.case, row, 1).is_some()),
        "material" => Some(field.is_some_and(Field::is_of_gear)),
        "limit" => Some(field.is_none()),
        _ if name.starts_with("method") => {
            Some(field.is_some_and(|field| field.key == "model.method"))
        }
        _ => None,
    };
    if let Some(is_of_row) = is_of_row {
        return if is_of_row { Scope::Own } else { Scope::Everywhere };
    }
    let is_of_some = |places: Place| !places.holds(Place::OUTSIDE);
    let scope = |binding: &Binding| {
        let is_shown_here = binding.footer.meets(pane.place()) && is_of_some(binding.footer);
        match binding.places {
            places if is_of_some(places) && !places.meets(place) => Scope::Elsewhere,
            places if is_of_some(places) || is_shown_here => Scope::Own,
            _ => Scope::Everywhere,
        }
    };
    named(name).map(scope).min().unwrap_or(Scope::Everywhere)
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
    shown(Place::FIELD, &[key(Enter), letter('i')], edit::begin, "edit",
        "Type into the focused field; Esc leaves it."),
    shown(Place::RESULTS, &[key(Enter)], dialogs::explain, "explain",
        "Explain the selected result."),
    shown(Place::RESULTS, &[letter('v')], variants::next, "variants",
        "Show the variants of the case with their differences; again: the next variants, then the \
            methods."),
    shown(Place::TRADE, &[key(Enter)], trade::take, "apply setting",
        "Use the selected setting in the case."),
    shown(Place::TRADE, &[letter('m')], trade::measure, "measure",
        "Benchmark every method and setting with this case on this machine."),
    shown(Place::TRADE, &[letter('v')], trade::switch_view, "chart/table",
        "Switch between the chart of all settings and the table of methods and compliances."),
    helped(Place::TRADE, &[letter('l'), letter('j'), key(Right), key(Down)], |app| navigation::step(app, 1),
        "Select the next slower setting."),
    helped(Place::TRADE, &[letter('h'), letter('k'), key(Left), key(Up)], |app| navigation::step(app, -1),
        "Select the next faster setting."),
    shown(Place::CURSOR, &[letter(' ')], panes::play, "play",
        "Play the visible part of the contact, or stop."),
    helped(Place::CURSOR, &[letter('h'), key(Left)], |app| panes::step_cursor(app, -1),
        "Move the cursor one column towards D."),
    shown(Place::CURSOR, &[letter('l'), key(Right)], |app| panes::step_cursor(app, 1), "cursor",
        "Move the cursor one column towards E."),
    helped(Place::CURSOR, &[letter('H'), with(SHIFT, Left)], |app| panes::step_cursor(app, -10),
        "Move the cursor ten columns towards D."),
    helped(Place::CURSOR, &[letter('L'), with(SHIFT, Right)], |app| panes::step_cursor(app, 10),
        "Move the cursor ten columns towards E."),
    listed(Place::CURSOR, &[key(Home)], panes::cursor_to_start, "cursor to D",
        "Move the cursor to the first contact D."),
    listed(Place::CURSOR, &[key(End)], panes::cursor_to_end, "cursor to E",
        "Move the cursor to E, where the normal path of contact begins."),
    listed(Place::OUTSIDE, &[letter('a')], panes::ask_cursor, "cursor to angle",
        "Move the cursor to a roll angle, a time, D, E, B, L or the peak."),
    helped(Place::WORKER_CHART, &[letter('h'), key(Left)], |app| panes::run_chart(app, Chart::Move(-1)),
        "Move the cursor of a chart with its own axes one point left."),
    shown(Place::WORKER_CHART, &[letter('l'), key(Right)], |app| panes::run_chart(app, Chart::Move(1)), "point",
        "Move the cursor of a chart with its own axes one point right."),
    helped(Place::WORKER_CHART, &[letter('H'), with(SHIFT, Left)], |app| panes::run_chart(app, Chart::Move(-10)),
        "Move that cursor ten points left."),
    helped(Place::WORKER_CHART, &[letter('L'), with(SHIFT, Right)], |app| panes::run_chart(app, Chart::Move(10)),
        "Move that cursor ten points right."),
    listed(Place::CURSOR.or(Place::WORKER_CHART), &[letter('c')], panes::hide_cursor, "hide cursor", "Hide the cursor."),
    shown(Place::CHARTS, &[letter('j'), key(Down)], |app| panes::run_chart(app, Chart::Step(1)), "next chart", "Show the next chart."),
    listed(Place::CHARTS, &[letter('k'), key(Up)], |app| panes::run_chart(app, Chart::Step(-1)), "previous chart",
        "Show the previous chart."),
    shown(Place::CHART, &[letter('+'), letter('=')], |app| panes::run_chart(app, Chart::Zoom(1)), "zoom in",
        "Zoom the charts in, around the cursor or D."),
    shown(Place::CHART, &[letter('-')], |app| panes::run_chart(app, Chart::Zoom(-1)), "zoom out",
        "Zoom the charts out, up to the whole contact."),
    shown(Place::CHART, &[letter('0')], |app| panes::run_chart(app, Chart::Whole), "whole contact",
        "Show the whole contact in the charts, from D to the last contact."),
    shown(Place::CHART, &[letter('v')], |app| panes::run_chart(app, Chart::Strike), "strike",
        "Show the charts from D to shortly after E, or the whole contact."),
    shown(Place::CHART, &[letter('t')], |app| panes::run_chart(app, Chart::Time), "time axis",
        "Switch the x axis of the charts: roll angle before E or time after E."),
    shown(Place::TEETH, &[letter('+'), letter('=')], |app| panes::run_teeth(app, Teeth::Zoom(1)), "closer", "Zoom the teeth in."),
    shown(Place::TEETH, &[letter('-')], |app| panes::run_teeth(app, Teeth::Zoom(-1)), "farther",
        "Zoom the teeth out, up to the whole pair."),
    listed(Place::TEETH, &[letter('0')], |app| panes::run_teeth(app, Teeth::Reset), "reset teeth",
        "Show the teeth around the strike again."),
    shown(Place::TEETH, &[letter('v'), letter('j'), key(Down)], |app| panes::run_teeth(app, Teeth::Centre(1)), "view",
        "Switch the view of the teeth: strike, pitch point or whole pair."),
    helped(Place::TEETH, &[letter('k'), key(Up)], |app| panes::run_teeth(app, Teeth::Centre(-1)),
        "Show the previous view."),
    listed(Place::TEETH, &[letter('x')], |app| panes::run_teeth(app, Teeth::Gap), "gap",
        "Draw the gap between the teeth enlarged by the printed factor, or true to scale."),
    shown(Place::STUDY, &[key(Enter)], study::take, "use value",
        "Use the value at the cursor in the case."),
    helped(Place::STUDY, &[letter('h'), key(Left)], |app| study::move_cursor(app, -1, 0),
        "Move the cursor of the study left."),
    shown(Place::STUDY, &[letter('l'), key(Right)], |app| study::move_cursor(app, 1, 0), "move",
        "Move the cursor of the study right."),
    helped(Place::STUDY, &[with(SHIFT, Left)], |app| study::move_cursor(app, -10, 0),
        "Move the cursor of the study ten points left."),
    helped(Place::STUDY, &[with(SHIFT, Right)], |app| study::move_cursor(app, 10, 0),
        "Move the cursor of the study ten points right."),
    helped(Place::STUDY, &[letter('j'), key(Down)], |app| study::move_cursor(app, 0, -1),
        "Move the cursor of the map down."),
    helped(Place::STUDY, &[letter('k'), key(Up)], |app| study::move_cursor(app, 0, 1),
        "Move the cursor of the map up."),
    shown(Place::STUDY, &[letter('+'), letter('=')], |app| study::zoom(app, 1), "narrower",
        "Halve the range of the study around the present value."),
    shown(Place::STUDY, &[letter('-')], |app| study::zoom(app, -1), "wider",
        "Double the range of the study, up to the limits of the field."),
    listed(Place::STUDY, &[letter('0')], study::reset_range, "usual range",
        "Show the usual range of the study again."),
    shown(Place::STUDY, &[letter('s')], study::second, "second field",
        "Choose a second field for a map, or go back to the curve."),
    shown(Place::TOLERANCE, &[letter('j'), key(Down)], |app| study::scroll(app, 1), "scroll",
        "Scroll the tolerance one line down."),
    helped(Place::TOLERANCE, &[letter('k'), key(Up)], |app| study::scroll(app, -1),
        "Scroll the tolerance one line up."),
    shown(Place::TOLERANCE, &[letter('l'), key(Right), key(PageDown)], |app| study::page(app, 1),
        "next page", "Go to the next page of the tolerance."),
    helped(Place::TOLERANCE, &[letter('h'), key(Left), key(PageUp)], |app| study::page(app, -1),
        "Go to the previous page of the tolerance."),
    shown(Place::STUDY.or(Place::TOLERANCE), &[letter('d')], study::tolerance, "tolerance",
        "Sample the distributions of [spread], or show the curve again."),
    shown_in(Place::OUTSIDE, Place::COMMANDED, &[letter('/')], |app| list(app, Picker::places, ""), "search",
        "Find a field or a result by name, symbol, key or a word of its help."),
    shown_in(Place::FIELD, Place::WORK, &[alt('g')], edit::ask_material, "material",
        "Give this gear, or both gears, a material of the catalogue."),
    shown_in(Place::RESULTS, Place::OUTSIDE, &[letter('n')], dialogs::notes, "notes",
        "Show the outcome, the limits and every note in full."),
    shown_in(Place::RESULTS, Place::OUTSIDE, &[letter('f')], |app| app.shows_every_method = !app.shows_every_method, "other methods",
        "Show the free impact and the other methods beside the method of the case, or fold them."),
    shown_in(Place::RESULTS, Place::WORK, &[alt('l')], edit::ask_limit, "limit",
        "Set a limit on the selected result, or on a result from a list."),
    shown_in(Place::OUTSIDE, Place::COMMANDED, &[letter(':')], |app| list(app, Picker::commands, ""), "commands",
        "List commands, fields and results: type a few letters; Enter runs the command or goes \
            there."),
    shown(Place::OUTSIDE, &[letter('q')], files::quit, "quit", "Quit; asks if there are unsaved edits."),
    shown(Place::OUTSIDE, &[letter('?')], help_page, "help", "Show this page."),
    shown(Place::OUTSIDE, &[key(Tab)], |app| panes::step(app, 1), "next pane", "Go to the next pane."),
    listed(Place::OUTSIDE, &[key(BackTab)], |app| panes::step(app, -1), "previous pane",
        "Go to the previous pane."),
    shown(Place::OUTSIDE, &[letter('u')], edit::undo, "undo", "Undo the last edit."),
    shown(Place::OUTSIDE, &[letter('b')], variants::toggle_baseline, "baseline",
        "Pin the results as the baseline to compare with, or unpin them."),
    shown(Place::OUTSIDE, &[letter('y')], export::copy_value, "copy value",
        "Copy the focused value, or the values at the cursor, to the clipboard of the terminal."),
    shown(Place::OUTSIDE, &[letter('Y')], export::copy_results, "copy results",
        "Copy title, verdict, inputs and results with their units to the clipboard of the \
            terminal."),
    shown(Place::OUTSIDE, &[letter('z')], panes::zoom, "zoom",
        "Show the focused pane alone, or all panes."),
    listed(Place::OUTSIDE, &[letter('1')], |app| panes::show(app, Pane::Form), "form", "Go to the form."),
    listed(Place::OUTSIDE, &[letter('2')], |app| panes::show(app, Pane::Results), "results", "Go to the results."),
    listed(Place::OUTSIDE, &[letter('3')], |app| panes::show(app, Pane::Chart), "chart", "Go to the chart."),
    listed(Place::OUTSIDE, &[letter('4')], |app| panes::show(app, Pane::Teeth), "teeth", "Go to the teeth."),
    listed(Place::OUTSIDE, &[letter('5')], |app| panes::show(app, Pane::Trade), "trade",
        "Go to accuracy against run time."),
    listed(Place::OUTSIDE, &[letter('6')], |app| panes::show(app, Pane::Study), "study",
        "Go to the study: the selected result over a range of the focused field."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('j'), key(Down)], |app| navigation::step(app, 1), "Go to the next line."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('k'), key(Up)], |app| navigation::step(app, -1),
        "Go to the previous line."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('l'), key(Right)], |app| navigation::leap(app, 1),
        "Go to the next group, or page of results."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('h'), key(Left)], |app| navigation::leap(app, -1),
        "Go to the previous group, or page of results."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('g'), key(Home)], |app| navigation::go_to_end(app, -1), "Go to the first line."),
    helped(Place::FIELD.or(Place::RESULTS), &[letter('G'), key(End)], |app| navigation::go_to_end(app, 1), "Go to the last line."),
    // Everywhere.
    shown(Place::WORK, &[function(1), alt('h')], help_page, "help", "Show this page."),
    shown(Place::WORK, &[ctrl('s')], |app| files::save(app, Next::Stay), "save",
        "Save the case; the file keeps its comments and order."),
    shown(Place::WORK, &[ctrl('p')], |app| list(app, Picker::commands, ""), "commands",
        "List commands, fields and results: type a few letters; Enter runs the command or goes \
            there."),
    shown(Place::WORK, &[ctrl('o')], |app| dialogs::open_browser(app, false), "open", "Open another case in a tab."),
    shown(Place::WORK, &[ctrl('q')], files::quit, "quit", "Quit; asks if there are unsaved edits."),
    shown(Place::FORM, &[key(Esc)], navigation::leave, LEAVE_FIELD,
        "Leave the field and keep its value; letters and digits are then commands."),
    shown(Place::WORK, &[ctrl('t'), function(6)], edit::next_method, "method",
        "Switch the method: paper, exact, static, dynamic, auto."),
    listed(Place::WORK, &[], |app| edit::set_method(app, Method::Paper), "method paper",
        "Use the closed form as printed."),
    listed(Place::WORK, &[], |app| edit::set_method(app, Method::Exact), "method exact",
        "Use the closed form with the exact first contact."),
    listed(Place::WORK, &[], |app| edit::set_method(app, Method::Static), "method static",
        "Use the static load sharing of all pairs in contact."),
    listed(Place::WORK, &[], |app| edit::set_method(app, Method::Dynamic), "method dynamic",
        "Use the motion with inertia and damping."),
    listed(Place::WORK, &[], |app| edit::set_method(app, Method::Auto), "method auto",
        "Use the fastest of exact, static and dynamic within the tolerance."),
    shown(Place::WORK, &[ctrl('z')], edit::undo, "undo", "Undo the last edit."),
    shown(Place::WORK, &[function(5), alt('p')], panes::cycle_lower, "switch",
        "Switch the lower area: chart, teeth, trade, study."),
    listed(Place::WORK, &[function(9)], panes::zoom, "zoom",
        "Show the focused pane alone, or all panes."),
    listed(Place::WORK, &[function(4), with(CTRL, Down)], |app| navigation::turn(app, 1), "results down",
        "Scroll the results down."),
    listed(Place::WORK, &[function(3), with(CTRL, Up)], |app| navigation::turn(app, -1), "results up", "Scroll the results up."),
    listed(Place::WORK, &[function(2), alt('s')], |app| files::ask_where(app, Next::Stay), "save as", "Save under another name."),
    listed(Place::WORK, &[], files::ask_reload, "reload",
        "Read the file of the case again; asks if there are unsaved edits."),
    listed(Place::WORK, &[alt('x')], export::ask, "export",
        "Write the report (.html, .md, .csv, .json) or the shown chart or teeth (.svg) to a file."),
    listed(Place::WORK, &[ctrl('n')], files::fresh_tab, "new",
        "Start an empty case: required fields are marked, the others show their defaults."),
    listed(Place::WORK, &[alt('n')], edit::ask_example, "from example",
        "Start a case from one of the examples."),
    listed(Place::WORK, &[alt('t')], files::built_in, "Table 1",
        "Show the built-in example, Table 1 of the paper."),
    listed(Place::WORK.or(Place::BROWSE), &[alt('r')], dialogs::open_recent, "recent cases", "Open a recent case."),
    listed(Place::WORK, &[with(CTRL, PageDown)], |app| files::step_tab(app, 1), "next case",
        "Switch to the next tab."),
    listed(Place::WORK, &[with(CTRL, PageUp)], |app| files::step_tab(app, -1), "previous case",
        "Switch to the previous tab."),
    listed(Place::WORK, &[alt('w')], files::close, "close case",
        "Close the case and its tab; asks if there are unsaved edits."),
    helped(Place::WORK, &[alt('1')], |app| files::go_to_tab(app, 0),
        "Switch to the first tab; Alt-2 to Alt-9 switch to the others."),
    unlisted(&[alt('2')], |app| files::go_to_tab(app, 1)),
    unlisted(&[alt('3')], |app| files::go_to_tab(app, 2)),
    unlisted(&[alt('4')], |app| files::go_to_tab(app, 3)),
    unlisted(&[alt('5')], |app| files::go_to_tab(app, 4)),
    unlisted(&[alt('6')], |app| files::go_to_tab(app, 5)),
    unlisted(&[alt('7')], |app| files::go_to_tab(app, 6)),
    unlisted(&[alt('8')], |app| files::go_to_tab(app, 7)),
    unlisted(&[alt('9')], |app| files::go_to_tab(app, 8)),
    listed(Place::WORK, &[], |app| list(app, Picker::commands, "variant "), "variant",
        "Save the edits since the last save as a variant: type variant NAME. Without edits, load \
            that variant into the form."),
    listed(Place::WORK, &[alt('e')], navigation::fault, "next error",
        "Go to the next field with an error or a missing required value."),
    listed(Place::WORK, &[ctrl('y'), ctrl('r')], edit::redo, "redo", "Redo the last undone edit."),
    listed(Place::WORK, &[alt('b')], variants::toggle_baseline, "baseline",
        "Pin the results as the baseline to compare with, or unpin them."),
    listed(Place::OUTSIDE, &[letter('%')], |app| app.shows_cost = !app.shows_cost, "cost",
        "Show the stages and the microseconds of the last solve beside the results."),
    listed(Place::WORK, &[function(8), alt('m')], cycle_marker, "marker",
        "Switch the chart marker: Braille, blocks or dots."),
    listed(Place::WORK, &[], |app| app.want(Effect::Journals), "journals",
        "List the unsaved edits of ended sessions, and delete them on request."),
    listed(Place::WORK, &[], edit::ask_relief, "relief",
        "Find the tip relief to specify on both gears, and write it into the case."),
    listed(Place::WORK, &[], cycle_theme, "theme", "Switch the colours: quiet, contrast, mono."),
    listed(Place::WORK, &[], toggle_ascii, "ascii", "Switch between ASCII and Unicode."),
    listed(Place::WORK, &[], cycle_units, "units",
        "Switch results, hints, charts and teeth between metric and inch units."),
    listed(Place::WORK, &[], toggle_mouse, "mouse",
        "Switch the mouse on or off: a click selects, a second click is Enter. With the mouse on, \
            hold Shift to select text."),
    listed(Place::WORK, &[ctrl('l')], |app| app.want(Effect::Redraw), "redraw", "Redraw the screen."),
    listed(Place::WORK, &[alt('z')], |app| app.want(Effect::Suspend), "suspend", "Suspend to the shell; fg resumes."),
    shown_in(Place::FORM, Place::FORM.or(Place::FIELD), &[with(SHIFT, Up)], |app| edit::step(app, 1), "step",
        "Increase the last digit of the value by one."),
    helped(Place::FORM.or(Place::FIELD), &[with(SHIFT, Down)], |app| edit::step(app, -1),
        "Decrease the last digit of the value by one."),
    helped(Place::FORM.or(Place::FIELD), &[with(ALT, Up)], |app| edit::step(app, 10),
        "Increase the last digit of the value by ten."),
    helped(Place::FORM.or(Place::FIELD), &[with(ALT, Down)], |app| edit::step(app, -10),
        "Decrease the last digit of the value by ten."),
    helped(Place::FORM, &[key(Down), key(Tab), key(Enter)], |app| navigation::step(app, 1), "Go to the next field."),
    helped(Place::FORM, &[key(Up), key(BackTab)], |app| navigation::step(app, -1),
        "Go to the previous field."),
    helped(Place::FORM.or(Place::FIELD).or(Place::RESULTS), &[key(PageDown)], |app| navigation::leap(app, 1),
        "Go to the next group, or page of results."),
    helped(Place::FORM.or(Place::FIELD).or(Place::RESULTS), &[key(PageUp)], |app| navigation::leap(app, -1),
        "Go to the previous group, or page of results."),
    helped(Place::WORK, &[with(CTRL, Home)], |app| navigation::field(app, 0), "Go to the first field."),
    helped(Place::WORK, &[with(CTRL, End)], |app| navigation::field(app, usize::MAX), "Go to the last field."),
    helped(Place::CHOICE, &[key(Right), letter(' ')], |app| edit::cycle(app, 1),
        "Select the next choice."),
    helped(Place::CHOICE, &[key(Left)], |app| edit::cycle(app, -1), "Select the previous choice."),
    helped(Place::CHOICE, &[key(Backspace), key(Delete), ctrl('h')], |app| edit::handle(app, Line::DeleteLine),
        "Remove the choice: the default applies."),
    helped(Place::CHOICE, &[letter('?')], help_page, "Show this page."),
    helped(Place::OUTSIDE, &[key(Esc)], navigation::leave,
        "Stop the running work, hide the cursor or go back to the form; no edit is lost."),
    // In prompts.
    shown(Place::BROWSE, &[key(Tab)], dialogs::complete_path, "complete",
        "Open the selected folder, or complete the selected name."),
    shown(Place::BROWSE, &[with(ALT, Up)], dialogs::browse_up, "folder up",
        "Go to the parent folder; so does Backspace in an empty line."),
    shown(Place::EXPLAIN, &[key(Tab)], |app| dialogs::step_page(app, 1), "next field",
        "Select the next field that the result depends on."),
    helped(Place::EXPLAIN, &[key(BackTab)], |app| dialogs::step_page(app, -1), "Go to the previous field."),
    shown(Place::EXPLAIN, &[key(Enter)], dialogs::accept, "go to field",
        "Go to the selected field of the form."),
    helped(Place::EXPLAIN, &[letter('q')], navigation::leave, "Close the page."),
    helped(Place::ASK, &[key(Tab), key(Right), key(Down)], |app| navigation::step(app, 1),
        "Select the next button."),
    helped(Place::ASK, &[key(BackTab), key(Left), key(Up)], |app| navigation::step(app, -1),
        "Select the previous button."),
    helped(Place::LIST.or(Place::PAGE), &[key(Down)], |app| navigation::step(app, 1), "Go to the next line."),
    helped(Place::LIST.or(Place::PAGE), &[key(Up)], |app| navigation::step(app, -1),
        "Go to the previous line."),
    helped(Place::PICK, &[ctrl('n'), key(Tab)], |app| navigation::step(app, 1), "Go to the next line."),
    helped(Place::PICK, &[ctrl('p'), key(BackTab)], |app| navigation::step(app, -1),
        "Go to the previous line."),
    helped(Place::PAGE, &[letter('j')], |app| navigation::step(app, 1), "Go to the next line."),
    helped(Place::PAGE, &[letter('k')], |app| navigation::step(app, -1), "Go to the previous line."),
    shown(Place::LIST.or(Place::PAGE), &[key(PageDown)], |app| navigation::leap(app, 1), "next page", "Go to the next page."),
    helped(Place::PAGE, &[letter(' ')], |app| navigation::leap(app, 1), "Go to the next page."),
    helped(Place::LIST.or(Place::PAGE), &[key(PageUp)], |app| navigation::leap(app, -1),
        "Go to the previous page."),
    shown(Place::LIST.or(Place::PATH).or(Place::ASK), &[key(Enter)], dialogs::accept, "accept", "Accept."),
    helped(Place::READ, &[key(Enter), letter('q'), letter('?'), function(1)], navigation::leave, "Close the page."),
    shown(Place::PROMPT, &[key(Esc)], navigation::leave, "back", "Close; no edit is lost."),
    helped(Place::ALL, &[ctrl('c'), ctrl('\\')], navigation::cancel,
        "Close a dialog or stop the running work. Otherwise press twice to quit; asks before \
            unsaved edits are discarded."),
    // In an input line.
    helped(Place::LINE, &[key(Left)], |app| edit::handle(app, Line::GoToPrevChar),
        "Move one character left."),
    helped(Place::LINE, &[key(Right)], |app| edit::handle(app, Line::GoToNextChar),
        "Move one character right."),
    helped(Place::LINE, &[with(CTRL, Left), with(ALT, Left)], |app| edit::handle(app, Line::GoToPrevWord), "Move one word left."),
    helped(Place::LINE, &[with(CTRL, Right), with(ALT, Right)], |app| edit::handle(app, Line::GoToNextWord), "Move one word right."),
    helped(Place::LINE, &[key(Home), ctrl('a')], |app| edit::handle(app, Line::GoToStart),
        "Move to the start of the value."),
    helped(Place::LINE, &[key(End), ctrl('e')], |app| edit::handle(app, Line::GoToEnd),
        "Move to the end of the value."),
    helped(Place::LINE, &[key(Backspace), ctrl('h')], |app| edit::handle(app, Line::DeletePrevChar),
        "Delete the character before the cursor."),
    helped(Place::LINE, &[key(Delete), ctrl('d')], |app| edit::handle(app, Line::DeleteNextChar),
        "Delete the character after the cursor."),
    helped(Place::LINE, &[ctrl('w'), with(ALT, Backspace)], |app| edit::handle(app, Line::DeletePrevWord),
        "Delete the word before the cursor."),
    helped(Place::LINE, &[ctrl('k')], |app| edit::handle(app, Line::DeleteTillEnd),
        "Delete from the cursor to the end."),
    helped(Place::LINE.or(Place::CHOICE), &[ctrl('u')], |app| edit::handle(app, Line::DeleteLine),
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

fn help_page(app: &mut App) {
    app.prompts.push(Prompt::Read(Page::new("Help", help())));
}

/// Opens a list with a typed text, in the order of the focused pane and field.
fn list(app: &mut App, list: fn(&Context) -> Picker, typed: &str) {
    let inputs = &app.tab.inputs_so_far;
    let idle = |field: &usize| matches!(relevance(*field, inputs), Acting::No(_));
    let every = Results { shows_every_method: true, ..app.results() };
    let context = Context {
        results: every.listed().iter().map(|quantity| quantity.key).collect(),
        are_results_first: app.layout.focus() == Pane::Results,
        idle: (0..FIELDS.len()).filter(idle).collect(),
        commands: items(app),
    };
    let mut picker = list(&context);
    picker.input = typed.into();
    app.prompts.push(Prompt::Pick(picker));
}

fn cycle_marker(app: &mut App) {
    if app.look.ascii {
        app.say("the marker has no effect: the chart is drawn in ASCII");
        return;
    }
    app.settings.marker = match app.settings.marker {
        Marker::Braille => Marker::HalfBlock,
        Marker::HalfBlock => Marker::Dot,
        _ => Marker::Braille,
    };
    keep_settings(app, &format!("chart in {}", marker_name(app.settings.marker)));
}

fn cycle_theme(app: &mut App) {
    app.look.theme = app.look.theme.next();
    app.settings.theme = Some(app.look.theme);
    keep_settings(app, &format!("theme {}", app.look.theme.name));
}

/// Switches between ASCII and Unicode; Unicode only for this session if the environment lacks it.
fn toggle_ascii(app: &mut App) {
    app.look.ascii = !app.look.ascii;
    app.settings.ascii = app.look.ascii;
    keep_settings(app, if app.look.ascii { "drawn in ASCII" } else { UNICODE });
}

fn cycle_units(app: &mut App) {
    app.settings.units = app.settings.units.other();
    let units = app.settings.units.name();
    keep_settings(
        app,
        &format!("results, hints, charts and teeth in {units} units; the file keeps its own units"),
    );
}

fn toggle_mouse(app: &mut App) {
    app.settings.mouse = !app.settings.mouse;
    app.want(Effect::Mouse(app.settings.mouse));
    keep_settings(
        app,
        if app.settings.mouse {
            "the workbench uses the mouse; most terminals still select text with Shift held"
        } else {
            "the terminal uses the mouse"
        },
    );
}

fn keep_settings(app: &mut App, message: &str) {
    app.say(message);
    app.want(Effect::Keep(app.settings));
}

fn is_listed(binding: &Binding) -> bool {
    !binding.name.is_empty() && binding.places.meets(Place::WORK) && binding.name != LEAVE_FIELD
}

// For the status line, the palette and the help.
const fn shown(
    places: Place,
    chords: &'static [Chord],
    run: fn(&mut App),
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    shown_in(places, places, chords, run, name, sentence)
}

// For the palette and the help, and for the status line of some places.
const fn shown_in(
    footer: Place,
    places: Place,
    chords: &'static [Chord],
    run: fn(&mut App),
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    Binding { chords, places, name, sentence, footer, run }
}

// For the palette and the help.
const fn listed(
    places: Place,
    chords: &'static [Chord],
    run: fn(&mut App),
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    shown_in(Place::NONE, places, chords, run, name, sentence)
}

// For the help only.
const fn helped(
    places: Place,
    chords: &'static [Chord],
    run: fn(&mut App),
    sentence: &'static str,
) -> Binding {
    shown_in(Place::NONE, places, chords, run, "", sentence)
}

// A key that the sentence of another row describes.
const fn unlisted(chords: &'static [Chord], run: fn(&mut App)) -> Binding {
    helped(Place::WORK, chords, run, "")
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
            let mut commands: Vec<_> = bound.map(|one| one.sentence).collect();
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
                let sentence = |chord| called(chord, place).map(|binding| binding.sentence);
                let moved = sentence(keys::letter(letter));
                assert!(moved.is_some(), "{letter} in {place:?}");
                assert_eq!(moved, sentence(keys::key(arrow)), "{letter} in {place:?}");
            }
        }
    }

    #[test]
    fn one_name_has_one_sentence() {
        for binding in BINDINGS.iter().filter(|binding| is_listed(binding)) {
            assert!(named(binding.name).all(|other| other.sentence == binding.sentence));
        }
    }

    fn plain(letter: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE)
    }

    #[test]
    fn letters_are_text_and_not_commands_inside_a_field() {
        for letter in ('a'..='z').chain(['?', ' ', 'Q', ':', '/', '1']) {
            for place in [Place::TEXT, Place::PATH, Place::PICK] {
                assert!(
                    matches!(of_key(plain(letter), place), Some(Action::Insert(typed)) if typed == letter),
                    "{letter}"
                );
            }
        }
    }

    #[test]
    fn outside_a_field_no_letter_is_text() {
        let panes = Pane::ALL.map(Pane::place);
        for place in panes.into_iter().chain([Place::TOLERANCE, Place::WORKER_CHART, Place::READ]) {
            for letter in '!'..='~' {
                assert!(!matches!(of_key(plain(letter), place), Some(Action::Insert(_))));
            }
        }
    }
}
