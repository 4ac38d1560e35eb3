//! The commands of the user: the table of their keys, names, sentences and functions, the help page,
//! the palette, and the settings.

use std::collections::BTreeSet;

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use ratatui::symbols::Marker;
use tui_input::InputRequest as Line;

use super::{edit, export, files, panes, studies};
use crate::case::{FIELDS, Field};
use crate::model::inputs::Method;
use crate::model::{QUANTITIES, Quantity};
use crate::report::stations::GRAPHS;
use crate::report::verdict::Absence;
use crate::tui::app::App;
use crate::tui::app::actions::{Action, Binding, Choice, Effect, Run};
use crate::tui::app::dialogs::Prompt;
use crate::tui::app::dialogs::page::Page;
use crate::tui::app::dialogs::picker::{Item, Picker, Typed};
use crate::tui::app::panes::chart::OwnChart;
use crate::tui::app::panes::results::order;
use crate::tui::app::panes::study;
use crate::tui::app::panes::teeth::TeethView;
use crate::tui::layout::{Pane, Place};
use crate::tui::rows;
use crate::tui::session::Next;
use crate::tui::settings::marker_name;

const PREFIXES: [(KeyModifiers, &str); 3] = [
    (KeyModifiers::CONTROL, "Ctrl-"),
    (KeyModifiers::ALT, "Alt-"),
    (KeyModifiers::SHIFT, "Shift-"),
];

/// A command of the status line that the palette leaves out.
const LEAVE_FIELD: &str = "leave field";
const SEEK: &str =
    "in the shell: tipstrike seek CASE --vary 'KEY=FROM..TO' --until 'RESULT<=VALUE'";
const HELP: &str = "Show this page; over a dialog, its keys.";
const UNICODE: &str = "drawn in Unicode; a locale without UTF-8 keeps it for this session only";

const ABOUT_KEYS: [&str; 6] = [
    "Every valid edit updates the results and the chart.",
    "Enter a value with its unit: 5 mm, 16 um, 0.2 in, 15 kW, 20 hp, 2000 rpm, 20 deg. To a \
        number without a unit, the workbench adds the unit of the field.",
    "The frame of a pane shows the keys that select the pane: a digit outside a field, Esc and \
        the digit in a field. In a field, digits are part of the value; Ctrl-Z restores the former value.",
    "In an empty or fully selected field, / and : start a command.",
    "An empty field shows its default in brackets; (required) marks a missing required value.",
    "D is the first contact of the driven tip; E and B are the start and the end of the normal path \
        of contact, A and E in ISO 21771.",
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
        baseline has no value; \"not solved\": it was not computed when b pinned the baseline. \"was\" and a value: the program prints no percentage.",
    "Chart curves: dots or * the method of the case; · paper; ∘ exact; × static; + the baseline; \
        ╌ a reference value, such as Δ in the gap chart. Compared stiffness models alternate in the \
        columns that several of them cross. On the x axis: L last contact; d first contact of another \
        method.",
    "Lines of the teeth: solid: flanks (bold: incoming pair) and, from E to B, the path of \
        contact; dashed: line of action; dotted: base circles and the path of the driven tip \
        before E. Crosses: named points. Bold dots: contacts. In ASCII: * driven and # driving \
        flanks, = path of contact, - line of action, . base circles, : path of the tip, + points, \
        X contacts.",
];

/// The section about the relief dialog, whose keys are those of a list.
const IN_RELIEF: &str = "In the tip relief";
const ABOUT_RELIEF: [&str; 3] = [
    "Type the loads in percent of the load of the case, the tolerance of the amounts, if wanted that \
        of the lengths, and the figure to minimise: 50..130 %, 5 um, 0.2 mm, te. te: transmission \
        error; peak: greatest force of a tooth; entry: force before E.",
    "In place of a range, a load spectrum gives each load its share of the time: 50%:0.2, 100%:0.8. \
        misalignment 10 um is the deviation of the misalignment over the face width.",
    "Enter searches. Enter on a relief of the list writes its shape, amounts, lengths and tolerances \
        into the case as one edit. If no relief is advised by the figure to minimise, the relief of \
        the case is selected, and the text gives the reason.",
];

const PLACES: [(&str, Place); 18] = [
    ("Everywhere", Place::HELPED),
    ("Outside dialogs", Place::WORK),
    ("In a field", Place::TEXT),
    ("Outside a field (Esc leaves the field)", Place::FIELD),
    ("In a field of choices", Place::CHOICE),
    ("In the results", Place::RESULTS),
    ("In chart and teeth", Place::CURSOR),
    ("In a chart with its own axes", Place::OWN_CHART),
    ("In the contact pattern", Place::PATTERN),
    ("In accuracy against run time", Place::TRADE),
    ("In the study", Place::STUDY),
    ("In the tolerance", Place::TOLERANCE),
    (IN_RELIEF, Place::NONE),
    ("In a list or a line of text", Place::PICK.or(Place::PATH)),
    ("In the list of files", Place::BROWSE),
    ("In a question (or its first letter)", Place::ASK),
    ("In a page like this", Place::READ),
    ("In the explanation of a result", Place::EXPLAIN),
];

/// The action of a key in a place.
pub fn of_key(event: KeyEvent, place: Place) -> Option<Action> {
    if let Some((command, way)) = called(&name(event), place) {
        return Some(Action::Do(command, way));
    }
    match letter_of(event)? {
        letter if place.meets(Place::TYPED) => Some(Action::Insert(letter)),
        letter => place.meets(Place::OUTSIDE).then_some(Action::Stray(letter)),
    }
}

/// The name of a key with its modifiers, such as `Ctrl-S`, `Shift-Tab` or `x`.
fn name(event: KeyEvent) -> String {
    let (code, mut held) = (event.code, event.modifiers);
    // Shift is part of a letter and of Shift-Tab, and terminals differ in whether they report it.
    if matches!(code, KeyCode::Char(_) | KeyCode::BackTab) {
        held -= KeyModifiers::SHIFT;
    }
    let name = match code {
        // Ctrl-4 and Ctrl-\ are one byte, which the reader decodes as Ctrl-4.
        KeyCode::Char('4') if held == KeyModifiers::CONTROL => "\\".to_owned(),
        KeyCode::Char(' ') => "Space".to_owned(),
        KeyCode::Char(letter) if letter_of(event).is_some() => letter.to_string(),
        KeyCode::Char(letter) => letter.to_ascii_uppercase().to_string(),
        KeyCode::F(number) => format!("F{number}"),
        KeyCode::BackTab => "Shift-Tab".to_owned(),
        code => format!("{code:?}"),
    };
    let held = PREFIXES.iter().filter(|(one, _)| held.contains(*one));
    held.map(|(_, prefix)| *prefix).collect::<String>() + &name
}

/// The letter of a key without modifiers.
fn letter_of(event: KeyEvent) -> Option<char> {
    let is_plain = !event.modifiers.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT);
    event.code.as_char().filter(|_| is_plain)
}

fn called(key: &str, place: Place) -> Option<(&'static Binding, isize)> {
    let mut bound = BINDINGS.iter().filter(|binding| binding.places.meets(place));
    bound.find_map(|binding| Some((binding, binding.way(key)?)))
}

/// The name of the command of a letter in the form outside its fields.
pub(super) fn at_letter(letter: char) -> Option<&'static str> {
    let command = called(&letter.to_string(), Place::FIELD).filter(|_| letter.is_alphabetic());
    Some(command?.0.name)
}

/// The rows of the command with a name.
pub fn named(name: &str) -> impl Iterator<Item = &'static Binding> {
    BINDINGS.iter().filter(move |binding| is_listed(binding) && binding.name == name)
}

/// The first key of the command with a name in a place, and its name in the palette if it has no
/// key. Esc precedes a key that a field takes as text.
pub(super) fn key_in(place: Place, name: &str) -> String {
    let key =
        |binding: &Binding| Some(binding.first_key().to_owned()).filter(|key| !key.is_empty());
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
fn items(app: &App) -> Vec<Item> {
    let mut seen = BTreeSet::new();
    let names = BINDINGS.iter().filter(|binding| is_listed(binding)).map(|binding| binding.name);
    let mut names: Vec<&str> = names.filter(|name| seen.insert(*name)).collect();
    names.sort_by_key(|name| scope(app, name));
    let item = |name| {
        let keys = named(name).map(Binding::keys).filter(|keys| !keys.is_empty());
        let keys = keys.collect::<Vec<_>>().join(", ");
        let command = named(name).next()?;
        let choice = Choice::of(|app| command.run(app, 1));
        Some(Item::command(choice, name.to_owned(), command.sentence.to_owned(), keys))
    };
    names.into_iter().filter_map(item).collect()
}

/// What decides the order of fields and results in a list.
#[derive(Debug, Clone, Default)]
struct Context {
    /// The results that the pane lists, each other one with the reason of its absence.
    results: Vec<(&'static Quantity, Option<String>)>,
    /// Whether results precede fields with equal scores.
    are_results_first: bool,
    /// The fields without effect in the case.
    idle: Vec<usize>,
}

impl Context {
    fn of(app: &App) -> Context {
        let every = app.tab.answer.as_ref().map_or_else(Vec::new, |answer| order(answer, true));
        let result = |quantity: &'static Quantity| match app.tab.solution() {
            _ if every.iter().any(|listed| listed.key == quantity.key) => Some((quantity, None)),
            solution => Some((quantity, Some(Absence::of(quantity, solution?).to_string()))),
        };
        let is_idle = |at: &usize| rows::is_idle(&app.tab.case, *at, &app.tab.inputs_so_far);
        Context {
            results: QUANTITIES.iter().filter_map(result).collect(),
            are_results_first: app.layout.focus == Pane::Results,
            idle: (0..FIELDS.len()).filter(is_idle).collect(),
        }
    }

    /// The fields of the form and the results, in the preferred order.
    fn places(&self) -> impl Iterator<Item = Item> {
        let (of_fields, of_results) = if self.are_results_first { (2, 0) } else { (0, 2) };
        let fields = FIELDS.iter().enumerate().map(|(at, field)| {
            let loss = if self.idle.contains(&at) { IDLE } else { 0 };
            let order = of_fields + usize::from(field.key != FOREMOST);
            Item::field(Choice::of(move |app| panes::go_to(app, at)), field).ranked(loss, order)
        });
        let known = self.results.iter().map(|(quantity, absence)| {
            let Quantity { key, symbol, label, equation, .. } = *quantity;
            let name = format!("{symbol} {}", label.trim_start());
            let Some(reason) = absence else {
                let choice = Choice::of(move |app| panes::show_result(app, key));
                let about = format!("{name}, a result; {equation}");
                return Item::result(choice, quantity, about).ranked(0, of_results);
            };
            let about = format!("{name}, without a value: {reason}");
            let said = about.clone();
            let choice = Choice::of(move |app| app.say(said.clone()));
            Item::result(choice, quantity, about).ranked(IDLE, of_results)
        });
        let mut all: Vec<Item> = fields.collect();
        let at = if self.are_results_first { 0 } else { all.len() };
        all.splice(at..at, known);
        all.into_iter()
    }

    /// Every field of the form, and every result.
    fn search(&self) -> Picker {
        Picker::new("Go to a field or a result", self.places(), &[])
    }

    /// Every command; a typed word also finds charts, fields and results.
    fn palette(&self, commands: Vec<Item>) -> Picker {
        let graphs = GRAPHS.iter().map(|graph| {
            let symbols: Vec<_> = graph.all_columns().map(|column| column.symbol).collect();
            (graph.label, format!("Show {} over the driver's roll angle.", symbols.join(", ")))
        });
        let others = OwnChart::ALL.into_iter().map(|chart| {
            let [name, about, _] = chart.words();
            (name, about.to_owned())
        });
        let charts = graphs.chain(others).enumerate().map(|(at, (label, about))| {
            let choice = Choice::of(move |app| panes::select_chart(app, at));
            let name = format!("chart: {}", label.to_lowercase());
            Item::command(choice, name, about, String::new())
        });
        let items = commands.into_iter().chain(charts).chain(self.places());
        Picker::new("Commands", items, TYPED)
    }
}

/// Penalty of fields without effect and of results without a value: they follow similar fields, but a
/// typed symbol still finds them first.
const IDLE: u32 = 9;
/// The most frequent choice among fields with equal scores.
const FOREMOST: &str = "driven.tip_relief";

const TYPED: &[Typed] = &[
    Typed {
        name: "variant",
        about: |name| {
            format!("Keep the edits as variant {name}, or show that variant in the form.")
        },
        run: studies::keep_variant,
    },
    Typed {
        name: "about",
        about: |text| format!("Print {text} above the reports of the case."),
        run: edit::set_about,
    },
    Typed {
        name: "sweep",
        about: |text| format!("Study a result over {text}."),
        run: studies::set_range,
    },
    Typed {
        name: "tolerance",
        about: |count| format!("Sample the distributions of [spread] with {count} samples."),
        run: studies::set_samples,
    },
    Typed {
        name: "spread",
        about: |text| format!("Sample the focused field in the tolerance: {text}."),
        run: edit::set_spread,
    },
    Typed {
        name: "export",
        about: |name| format!("Write the report, the picture or the study to {name}."),
        run: |app, name| export::begin(app, name.into(), false),
    },
];

fn search(app: &mut App) {
    let picker = Context::of(app).search();
    app.pick(picker);
}

/// Opens the palette with a typed text.
fn type_command(app: &mut App, typed: &str) {
    let mut picker = Context::of(app).palette(items(app));
    picker.input = typed.into();
    app.pick(picker);
}

/// Lists the texts of `[about]`, or the usual names; a line goes to the palette for its change.
fn list_about(app: &mut App) {
    let known = app.tab.case.about.iter().map(|(name, text)| (name.clone(), text.clone()));
    let usual = ["project", "author"].map(|name| (name.to_owned(), String::new()));
    let is_new = |(name, _): &(String, _)| app.tab.case.about.iter().all(|own| own.0 != *name);
    let items = known.chain(usual.into_iter().filter(is_new)).map(|(name, text)| {
        let about = if text.is_empty() { "not set" } else { "Change this text, or delete it." };
        let command = format!("about {name} = {text}");
        let typed = command.clone();
        Item::command(
            Choice::of(move |app| type_command(app, &typed)),
            command,
            about.to_owned(),
            String::new(),
        )
    });
    let mut picker = Picker::new("Texts for reports: NAME = TEXT", items, TYPED);
    picker.input = "about ".into();
    app.pick(picker);
}

/// The scope of a command; in the form, the focused row decides too.
fn scope(app: &App, name: &str) -> Scope {
    let (place, pane, row) = (app.place(), app.layout.focus, app.tab.form.focus);
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
    match is_of_row {
        Some(true) => return Scope::Own,
        Some(false) => return Scope::Everywhere,
        None => {}
    }
    let is_of_some = |places: Place| !places.holds(Place::OUTSIDE);
    let scope = |binding: &Binding| {
        let is_shown_here = binding.status.meets(pane.place()) && is_of_some(binding.status);
        match binding.places {
            places if is_of_some(places) && !places.meets(place) => Scope::Elsewhere,
            places if is_of_some(places) || is_shown_here => Scope::Own,
            _ => Scope::Everywhere,
        }
    };
    named(name).map(scope).min().unwrap_or(Scope::Everywhere)
}

/// Every key of the workbench, in the order of the help; the status line shows as many as fit.
#[rustfmt::skip]
pub static BINDINGS: &[Binding] = &[
    // Outside fields, where letters are commands.
    row(Place::FIELD, "Enter i", "edit", edit::begin,
        "Type into the focused field; Esc leaves it.").shown(),
    row(Place::RESULTS, "Enter", "explain", panes::explain,
        "Explain the selected result.").shown(),
    row(Place::RESULTS, "v", "variants", studies::next_variants,
        "Show the variants of the case with their differences; again: the next variants, then the \
            methods.").shown(),
    row(Place::TRADE, "Enter", "apply setting", studies::take_setting,
        "Use the selected setting in the case.").shown(),
    row(Place::TRADE, "m", "measure", studies::measure,
        "Benchmark every method and setting with this case on this machine.").shown(),
    row(Place::TRADE, "v", "chart/table", studies::switch_view,
        "Switch between the chart of all settings and the table of methods and compliances.").shown(),
    pair(Place::TRADE, "l/h j/k Right/Left Down/Up", "", super::step,
        "Select the next slower or faster setting."),
    row(Place::CURSOR, "Space", "play", panes::play,
        "Play the visible part of the contact, or stop.").shown(),
    pair(Place::CURSOR, "l/h Right/Left", "cursor", panes::step_cursor,
        "Move the cursor one column towards E or D.").shown(),
    pair(Place::CURSOR, "L/H Shift-Right/Shift-Left", "", |app, by| panes::step_cursor(app, 10 * by),
        "Move the cursor ten columns towards E or D."),
    row(Place::CURSOR, "Home", "cursor to D", panes::cursor_to_start,
        "Move the cursor to the first contact D."),
    row(Place::CURSOR, "End", "cursor to E", |app| panes::put_cursor(app, Ok(0.0)),
        "Move the cursor to E, where the normal path of contact begins."),
    row(Place::OUTSIDE, "a", "cursor to angle", panes::ask_cursor,
        "Move the cursor to a roll angle, a time, D, E, B, L or the peak; in a chart with its own axes \
            to the next peak."),
    pair(Place::OWN_CHART, "l/h Right/Left", "point", panes::step_point,
        "One point right or left in a chart with its own axes.").shown(),
    pair(Place::OWN_CHART, "L/H Shift-Right/Shift-Left", "", |app, by| panes::step_point(app, 10 * by),
        "Move that cursor ten points right or left."),
    pair(Place::OWN_CHART, "End/Home", "", |app, by| panes::step_point(app, isize::MAX * by),
        "Move that cursor to the last or first point."),
    row(Place::CURSOR.or(Place::OWN_CHART), "c", "hide cursor", panes::hide_cursor, "Hide the cursor."),
    pair(Place::PATTERN, "Up/Down", "slice", panes::step_slice,
        "Move the cursor along the face to the next slice.").shown(),
    row(Place::CHARTS, "j Down", "next chart", |app| panes::step_chart(app, 1),
        "Show the next chart.").shown(),
    row(Place::CHARTS, "k Up", "previous chart", |app| panes::step_chart(app, -1),
        "Show the previous chart."),
    row(Place::CHART, "+ =", "zoom in", |app| panes::zoom_chart(app, 1),
        "Zoom the charts in, around the cursor or D.").shown(),
    row(Place::CHART, "-", "zoom out", |app| panes::zoom_chart(app, -1),
        "Zoom the charts out, up to the whole contact.").shown(),
    row(Place::CHART, "0", "whole contact", panes::show_whole,
        "Show the whole contact in the charts, from D to the last contact.").shown(),
    row(Place::CHART, "v", "strike", panes::show_strike,
        "Show the charts from D to shortly after E, or the whole contact.").shown(),
    row(Place::CHART, "t", "time axis", panes::switch_time,
        "Switch the x axis of the charts between roll angle and time.").shown(),
    row(Place::TEETH, "+ =", "closer", |app| panes::zoom_teeth(app, 1),
        "Zoom the teeth in.").shown(),
    row(Place::TEETH, "-", "farther", |app| panes::zoom_teeth(app, -1),
        "Zoom the teeth out, up to the whole pair.").shown(),
    row(Place::TEETH, "0", "reset teeth", |app| app.teeth = TeethView::default(),
        "Show the teeth around the strike again."),
    pair(Place::TEETH, "v j/k Down/Up", "view", panes::turn_teeth,
        "Switch the view of the teeth: strike, pitch point or whole pair.").shown(),
    row(Place::TEETH, "x", "gap", panes::switch_gap,
        "Draw the gap between the teeth enlarged by the printed factor, or true to scale."),
    row(Place::STUDY, "Enter", "use value", studies::take,
        "Use the value at the cursor in the case.").shown(),
    pair(Place::STUDY, "l/h Right/Left", "move", |app, by| studies::move_cursor(app, by, 0),
        "Move the cursor of the study right or left.").shown(),
    pair(Place::STUDY, "Shift-Right/Shift-Left", "", |app, by| studies::move_cursor(app, 10 * by, 0),
        "Move the cursor of the study ten points right or left."),
    pair(Place::STUDY, "G/g End/Home", "", |app, by| studies::move_cursor(app, isize::MAX * by, 0),
        "Move the cursor of the study to the last or first point."),
    pair(Place::STUDY, "k/j Up/Down", "", |app, by| studies::move_cursor(app, 0, by),
        "Move the cursor of the map up or down."),
    row(Place::STUDY, "+ =", "narrower", |app| studies::zoom(app, 1),
        "Halve the range of the study around the present value.").shown(),
    row(Place::STUDY, "-", "wider", |app| studies::zoom(app, -1),
        "Double the range of the study, up to the limits of the field."),
    row(Place::STUDY, "0", "usual range", |app| studies::zoom(app, -app.tab.study.state.zoom),
        "Show the usual range of the study again."),
    row(Place::STUDY, "r", "range", studies::ask_range,
        "Type the range of the study, such as 1000..3000 rpm, or two ranges for a map.").shown(),
    row(Place::STUDY, "v", "table", |app| app.tab.study.state.is_table = !app.tab.study.state.is_table,
        "Switch between the curve or map and the table of its points.").shown(),
    row(Place::STUDY.or(Place::TOLERANCE), "y", "copy command", export::copy_value,
        "Show the shell command that repeats the study, and copy it to the clipboard of the \
            terminal.").shown(),
    row(Place::STUDY, "p", "field", studies::first,
        "Choose the field of the study; the first line of the list is the focused field of the form.").shown(),
    row(Place::STUDY, "o", "result", studies::result,
        "Choose the result of the study; the first line of the list follows the selected result.").shown(),
    row(Place::STUDY, "s", "second field", studies::second,
        "Choose a second field for a map, or go back to the curve.").shown(),
    pair(Place::TOLERANCE, "j/k Down/Up", "scroll", studies::scroll,
        "Scroll the tolerance one line down or up.").shown(),
    pair(Place::TOLERANCE, "l/h Right/Left PageDown/PageUp", "next page", |app, by| app.tab.study.state.top = study::paged(app, by),
        "Go to the next or previous page of the tolerance.").shown(),
    row(Place::TOLERANCE, "N", "samples", studies::ask_samples,
        "Type the number of samples of the tolerance.").shown(),
    row(Place::STUDY.or(Place::TOLERANCE), "d", "tolerance", studies::tolerance,
        "Sample the distributions of [spread], or show the curve again.").shown(),
    row(Place::COMMANDED, "/", "search", search,
        "Find a field or a result by name, symbol, key or a word of its help.").shown_in(Place::OUTSIDE),
    row(Place::WORK, "Alt-G", "material", edit::ask_material,
        "Give this gear, or both gears, a material of the catalogue.").shown_in(Place::FIELD),
    row(Place::OUTSIDE, "n", "notes", panes::notes,
        "Show the outcome, the limits and every note in full; the pane leaves 12 rows, or two thirds of its \
            lines, to the results.").shown_in(Place::RESULTS),
    row(Place::OUTSIDE, "f", "other methods", |app| app.shows_every_method = !app.shows_every_method,
        "Show the free impact and the other methods beside the method of the case, or fold them.").shown_in(Place::RESULTS),
    row(Place::WORK, "Alt-L", "limit", edit::ask_limit,
        "Set a limit on the selected result, or on a result from a list.").shown_in(Place::RESULTS),
    row(Place::WORK, "Alt-D", "spread", edit::ask_spread,
        "Give the focused field a distribution for the tolerance, outside the form a field from a list; \
            an empty distribution is removed."),
    row(Place::COMMANDED, ":", "commands", |app| type_command(app, ""),
        "List commands, fields and results: type a few letters; Enter runs the command or goes \
            there.").shown_in(Place::OUTSIDE),
    row(Place::OUTSIDE, "q", "quit", files::quit, "Quit; asks if there are unsaved edits.").shown().unseen(),
    row(Place::OUTSIDE.or(Place::CHOICE), "?", "help", help_page, HELP)
        .shown_in(Place::OUTSIDE),
    row(Place::OUTSIDE, "Tab", "next pane", |app| panes::step(app, 1),
        "Go to the next pane.").shown(),
    row(Place::OUTSIDE, "Shift-Tab", "previous pane", |app| panes::step(app, -1),
        "Go to the previous pane."),
    row(Place::OUTSIDE, "u", "undo", edit::undo, "Undo the last edit.").shown(),
    row(Place::OUTSIDE, "b", "baseline", studies::toggle_baseline,
        "Pin the results as the baseline to compare with, or unpin them.").shown(),
    row(Place::VALUES, "y", "copy value", export::copy_value,
        "Copy the focused value or the values at the cursor to the clipboard of the terminal.").shown(),
    row(Place::OUTSIDE, "Y", "copy results", export::copy_results,
        "Copy title, verdict, inputs and results with their units to the clipboard of the \
            terminal.").shown(),
    row(Place::OUTSIDE, "z", "zoom", panes::zoom,
        "Show the focused pane alone, or all panes.").shown(),
    row(Place::OUTSIDE, "1", "form", |app| panes::show(app, Pane::Form), "Go to the form."),
    row(Place::OUTSIDE, "2", "results", |app| panes::show(app, Pane::Results),
        "Go to the results."),
    row(Place::OUTSIDE, "3", "chart", |app| panes::show(app, Pane::Chart), "Go to the chart."),
    row(Place::OUTSIDE, "4", "teeth", |app| panes::show(app, Pane::Teeth), "Go to the teeth."),
    row(Place::OUTSIDE, "5", "trade", |app| panes::show(app, Pane::Trade),
        "Go to accuracy against run time."),
    row(Place::OUTSIDE, "6", "study", studies::open,
        "Go to the study: the selected result over a range of a field. Pressed in the form, it takes the focused field."),
    pair(Place::FIELD.or(Place::RESULTS), "j/k Down/Up", "", super::step, "Go to the next or previous line."),
    pair(Place::FIELD.or(Place::RESULTS), "l/h Right/Left", "", super::leap,
        "Go to the next or previous group, or page of results."),
    pair(Place::FIELD.or(Place::RESULTS), "G/g End/Home", "", super::go_to_end, "Go to the last or first line."),
    // Everywhere.
    row(Place::HELPED, "F1 Alt-H", "help", help_page, HELP)
        .shown_in(Place::WORK.or(Place::PICK).or(Place::PATH).or(Place::ASK).or(Place::EXPLAIN)),
    row(Place::WORK, "Ctrl-S", "save", |app| files::save(app, Next::Stay),
        "Save the case; the file keeps its comments and order.").shown().unseen(),
    row(Place::WORK, "Ctrl-P", "commands", |app| type_command(app, ""),
        "List commands, fields and results: type a few letters; Enter runs the command or goes \
            there.").shown(),
    row(Place::WORK, "Ctrl-O", "open", |app| super::browse(app, false),
        "Open another case in a tab.").shown(),
    row(Place::ALL, "Ctrl-Q", "quit", files::quit,
        "Quit; asks if there are unsaved edits.").shown_in(Place::WORK).unseen(),
    row(Place::FORM, "Esc", LEAVE_FIELD, super::leave,
        "Leave the field and keep its value; letters and digits are then commands.").shown(),
    row(Place::WORK, "Ctrl-T F6", "method", |app| edit::set_method(app, None),
        "Switch the method: paper, exact, static, dynamic, auto.").shown(),
    row(Place::WORK, "", "method paper", |app| edit::set_method(app, Some(Method::Paper)),
        "Use the closed form as printed."),
    row(Place::WORK, "", "method exact", |app| edit::set_method(app, Some(Method::Exact)),
        "Use the closed form with the exact first contact."),
    row(Place::WORK, "", "method static", |app| edit::set_method(app, Some(Method::Static)),
        "Use the static load sharing of all pairs in contact."),
    row(Place::WORK, "", "method dynamic", |app| edit::set_method(app, Some(Method::Dynamic)),
        "Use the motion with inertia and damping."),
    row(Place::WORK, "", "method auto", |app| edit::set_method(app, Some(Method::Auto)),
        "Use the fastest of exact, static and dynamic within the tolerance."),
    row(Place::WORK, "Ctrl-Z", "undo", edit::undo, "Undo the last edit.").shown(),
    row(Place::WORK, "F5 Alt-P", "switch", panes::cycle_lower,
        "Switch the lower area: chart, teeth, trade, study.").shown(),
    row(Place::WORK, "F9", "zoom", panes::zoom, "Show the focused pane alone, or all panes."),
    row(Place::WORK, "F4 Ctrl-Down", "results down", |app| super::turn(app, 1),
        "Scroll the results down."),
    row(Place::WORK, "F3 Ctrl-Up", "results up", |app| super::turn(app, -1),
        "Scroll the results up."),
    row(Place::WORK, "F2 Alt-S", "save as", |app| files::ask_where(app, Next::Stay),
        "Save under another name."),
    row(Place::WORK, "", "reload", files::ask_reload,
        "Read the file of the case again; asks if there are unsaved edits."),
    row(Place::WORK, "Alt-X", "export", export::ask,
        "Write the report (.html, .md, .csv, .json), the shown chart or teeth (.svg), or the points of \
            the study (.csv, .json, .svg) to a file."),
    row(Place::WORK, "Ctrl-N", "new", files::fresh_tab,
        "Start an empty case: required fields are marked, the others show their defaults."),
    row(Place::WORK, "Alt-N", "from example", files::ask_example,
        "Start a case from one of the examples."),
    row(Place::WORK, "Alt-T", "Table 1", files::built_in,
        "Show the built-in example, Table 1 of the paper."),
    row(Place::WORK.or(Place::BROWSE), "Alt-R", "recent cases", |app| super::browse(app, true),
        "Open a recent case."),
    row(Place::WORK, "Ctrl-PageDown", "next case", |app| files::step_tab(app, 1),
        "Switch to the next tab."),
    row(Place::WORK, "Ctrl-PageUp", "previous case", |app| files::step_tab(app, -1),
        "Switch to the previous tab."),
    row(Place::WORK, "Alt-W", "close case", |app| files::ask_or_go(app, Next::Close),
        "Close the case and its tab; asks if there are unsaved edits."),
    pair(Place::WORK, "Alt-1..9", "", |app, number| files::go_to_tab(app, number.unsigned_abs() - 1),
        "Switch to the tab with this number."),
    row(Place::WORK, "", "variant", |app| type_command(app, "variant "),
        "Save the edits since the last save as a variant: type variant NAME. Without edits, load \
            that variant into the form."),
    row(Place::WORK, "", "about", list_about,
        "Name the project, author or drawing number for the reports: type about project = GB 12. An \
            empty text removes the line."),
    row(Place::WORK, "Alt-E", "next error", super::fault,
        "Go to the next field with an error or a missing required value."),
    row(Place::WORK, "Ctrl-Y Ctrl-R", "redo", edit::redo, "Redo the last undone edit."),
    row(Place::WORK, "Alt-B", "baseline", studies::toggle_baseline,
        "Pin the results as the baseline to compare with, or unpin them."),
    row(Place::OUTSIDE, "%", "cost", |app| app.shows_cost = !app.shows_cost,
        "Show the stages and the microseconds of the last solve beside the results."),
    row(Place::WORK, "F8 Alt-M", "marker", cycle_marker,
        "Switch the chart marker: Braille, blocks or dots."),
    row(Place::WORK, "", "journals", |app| app.want(Effect::Journals),
        "List the unsaved edits of ended sessions, and delete them on request."),
    row(Place::WORK, "", "sweep", studies::ask_range,
        "Study a result over one or two fields: type their ranges."),
    row(Place::WORK, "", "seek", |app| app.say(SEEK),
        "Find where a condition on a result changes, by the command in the shell."),
    row(Place::WORK, "", "relief", edit::ask_relief,
        "Find the tip relief to specify on both gears, and write it into the case."),
    row(Place::WORK, "", "theme", cycle_theme, "Switch the colours: quiet, contrast, mono."),
    row(Place::WORK, "", "ascii", toggle_ascii, "Switch between ASCII and Unicode."),
    row(Place::WORK, "", "units", cycle_units,
        "Switch results, hints, charts and teeth between metric and inch units."),
    row(Place::WORK, "", "mouse", toggle_mouse,
        "Switch the mouse on or off: a click selects, a second click is Enter. With the mouse on, \
            hold Shift to select text."),
    row(Place::WORK, "Ctrl-L", "redraw", |app| app.want(Effect::Redraw), "Redraw the screen."),
    row(Place::WORK, "Alt-Z", "suspend", |app| app.want(Effect::Suspend),
        "Suspend to the shell; fg resumes.").unseen(),
    pair(Place::FORM.or(Place::FIELD), "Shift-Up/Shift-Down", "step", edit::step,
        "Increase or decrease the last digit of the value by one.").shown_in(Place::FORM),
    pair(Place::FORM.or(Place::FIELD), "Alt-Up/Alt-Down", "", |app, by| edit::step(app, 10 * by),
        "Increase or decrease the last digit of the value by ten."),
    pair(Place::FORM, "Down/Up Tab/Shift-Tab Enter", "", super::step,
        "Go to the next or previous field."),
    pair(Place::FORM.or(Place::FIELD).or(Place::RESULTS), "PageDown/PageUp", "", super::leap,
        "Go to the next or previous group, or page of results."),
    pair(Place::WORK, "Ctrl-End/Ctrl-Home", "", super::end_of_form,
        "Go to the last or first field."),
    pair(Place::CHOICE, "Right/Left Space", "", edit::cycle, "Select the next or previous choice."),
    row(Place::CHOICE, "Backspace Delete Ctrl-H", "", |app| edit::handle(app, Line::DeleteLine),
        "Remove the choice: the default applies."),
    row(Place::OUTSIDE, "Esc", "", super::leave,
        "Stop the running work, hide the cursor or go back to the form; no edit is lost."),
    // In prompts.
    row(Place::BROWSE, "Tab", "complete", super::complete_path,
        "Open the selected folder, or complete the selected name.").shown(),
    row(Place::BROWSE, "Alt-Up", "folder up", App::browse_up,
        "Go to the parent folder; so does Backspace in an empty line.").shown(),
    pair(Place::EXPLAIN, "Tab/Shift-Tab", "next field", super::step_page,
        "Select the next or previous field that the result depends on.").shown(),
    row(Place::EXPLAIN, "Enter", "go to field", App::accept,
        "Go to the selected field of the form.").shown(),
    row(Place::EXPLAIN, "q", "", super::leave, "Close the page."),
    pair(Place::ASK, "Tab/Shift-Tab Right/Left Down/Up", "", super::step,
        "Select the next or previous button."),
    pair(Place::LIST.or(Place::PAGE), "Down/Up", "", super::step, "Go to the next or previous line."),
    pair(Place::PICK, "Ctrl-N/Ctrl-P Tab/Shift-Tab", "", super::step,
        "Go to the next or previous line."),
    pair(Place::PAGE, "j/k", "", super::step, "Go to the next or previous line."),
    pair(Place::LIST.or(Place::PAGE), "PageDown/PageUp", "next page", super::leap,
        "Go to the next or previous page.").shown(),
    pair(Place::PAGE, "Space", "", super::leap, "Go to the next page."),
    row(Place::LIST.or(Place::PATH).or(Place::ASK), "Enter", "accept", App::accept,
        "Accept.").shown(),
    row(Place::READ, "Enter q ? F1 Alt-H", "", super::leave, "Close the page."),
    row(Place::PROMPT, "Esc", "back", super::leave, "Close; no edit is lost.").shown(),
    row(Place::ALL, "Ctrl-C Ctrl-\\", "", super::cancel,
        "Close a dialog or stop the running work. Otherwise press twice to quit; asks before \
            unsaved edits are discarded.").unseen(),
    // In an input line.
    pair(Place::LINE, "Right/Left", "", |app, by| edit::handle(app, if by > 0 { Line::GoToNextChar } else { Line::GoToPrevChar }),
        "Move one character right or left."),
    pair(Place::LINE, "Ctrl-Right/Ctrl-Left Alt-Right/Alt-Left", "", |app, by| edit::handle(app, if by > 0 { Line::GoToNextWord } else { Line::GoToPrevWord }),
        "Move one word right or left."),
    row(Place::LINE, "Home Ctrl-A", "", |app| edit::handle(app, Line::GoToStart),
        "Move to the start of the value."),
    row(Place::LINE, "End Ctrl-E", "", |app| edit::handle(app, Line::GoToEnd),
        "Move to the end of the value."),
    row(Place::LINE, "Backspace Ctrl-H", "", |app| edit::handle(app, Line::DeletePrevChar),
        "Delete the character before the cursor."),
    row(Place::LINE, "Delete Ctrl-D", "", |app| edit::handle(app, Line::DeleteNextChar),
        "Delete the character after the cursor."),
    row(Place::LINE, "Ctrl-W Alt-Backspace", "", |app| edit::handle(app, Line::DeletePrevWord),
        "Delete the word before the cursor."),
    row(Place::LINE, "Ctrl-K", "", |app| edit::handle(app, Line::DeleteTillEnd),
        "Delete from the cursor to the end."),
    row(Place::LINE.or(Place::CHOICE), "Ctrl-U", "", |app| edit::handle(app, Line::DeleteLine),
        "Empty the field: it shows its default in brackets."),
];

/// The lines of the help.
pub fn help() -> Vec<String> {
    let mut lines: Vec<String> = ABOUT_KEYS.iter().map(|&line| line.to_owned()).collect();
    lines.extend(["", "Signs"].into_iter().chain(SIGNS).map(str::to_owned));
    // A row is listed in the first of its places.
    let home = |binding: &Binding| {
        PLACES.iter().position(|&(_, place)| match place {
            Place::HELPED | Place::WORK => binding.places.holds(place),
            _ => binding.places.meets(place),
        })
    };
    for (at, (title, place)) in PLACES.into_iter().enumerate() {
        lines.extend([String::new(), title.to_owned()]);
        let words = Some(ABOUT_RELIEF).filter(|_| title == IN_RELIEF);
        lines.extend(words.into_iter().flatten().map(str::to_owned));
        let mut here: Vec<_> = BINDINGS.iter().filter(|one| home(one) == Some(at)).collect();
        // Commands of every status line are listed first.
        here.sort_by_key(|binding| place == Place::WORK && !binding.status.holds(place));
        lines.extend(here.into_iter().map(|binding| {
            let name = || format!(":{}", binding.name);
            let keys = Some(binding.keys()).filter(|keys| !keys.is_empty()).unwrap_or_else(name);
            format!("  {keys:<24} {}", binding.sentence)
        }));
    }
    lines
}

fn help_page(app: &mut App) {
    let place = app.place();
    let is_own = |(_, own): &&(_, Place)| own.meets(place) && *own != Place::HELPED;
    let section = match app.prompts.last() {
        None => None,
        Some(Prompt::Relief(_)) => Some(IN_RELIEF),
        Some(_) => PLACES.iter().find(is_own).map(|(title, _)| *title),
    };
    let page = Page::new("Help", Some(help()));
    app.prompts.push(Prompt::Read(match section {
        Some(title) => page.at(title, app),
        None => page,
    }));
}

fn cycle_marker(app: &mut App) {
    if app.look.ascii {
        return app.say("the marker has no effect: the chart is drawn in ASCII");
    }
    if app.place().meets(Place::PATTERN) {
        return app.say("the marker has no effect: the contact pattern is drawn in shades");
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
    let what = "results, hints, charts and teeth";
    keep_settings(app, &format!("{what} in {units} units; the file keeps its own units"));
}

fn toggle_mouse(app: &mut App) {
    app.settings.mouse = !app.settings.mouse;
    app.want(Effect::Mouse(app.settings.mouse));
    let words = if app.settings.mouse {
        "the workbench uses the mouse; most terminals still select text with Shift held"
    } else {
        "the terminal uses the mouse"
    };
    keep_settings(app, words);
}

fn keep_settings(app: &mut App, message: &str) {
    app.say(message);
    app.want(Effect::Keep(app.settings));
}

fn is_listed(binding: &Binding) -> bool {
    !binding.name.is_empty() && binding.places.meets(Place::WORK) && binding.name != LEAVE_FIELD
}

// Without a name, only the help shows the row.
const fn row(
    places: Place,
    keys: &'static str,
    name: &'static str,
    run: fn(&mut App),
    sentence: &'static str,
) -> Binding {
    bound(places, keys, name, Run::Once(run), sentence)
}

// A row whose keys name a direction or a number.
const fn pair(
    places: Place,
    keys: &'static str,
    name: &'static str,
    run: fn(&mut App, isize),
    sentence: &'static str,
) -> Binding {
    bound(places, keys, name, Run::Way(run), sentence)
}

const fn bound(
    places: Place,
    keys: &'static str,
    name: &'static str,
    run: Run,
    sentence: &'static str,
) -> Binding {
    Binding { keys, places, name, sentence, status: Place::NONE, works_unseen: false, run }
}

#[cfg(test)]
mod tests;
