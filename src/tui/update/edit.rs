//! Edits: typing, which changes the case immediately, selections from lists (a material for a gear,
//! a limit for a result), and the tip relief to specify.

use tui_input::InputRequest;

use crate::case::fields::{Absent, Kind, index_of};
use crate::case::{Case, FIELDS, Field, Limit, changes};
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::{self, relief};
use crate::study::relief::Demand;
use crate::tui::app::App;
use crate::tui::app::actions::Choice;
use crate::tui::app::dialogs::picker::{Item, Picker};
use crate::tui::app::dialogs::{Prompt, ReliefDialog};
use crate::tui::form_aids::materials::{self, Material};
use crate::tui::form_aids::step_limit;
use crate::tui::layout::Pane;
use crate::tui::rows::{self, Row};
use crate::tui::session;
use crate::tui::text::{self, Line};

/// Greatest length of a text; a longer one is not a value, title or path.
const LONGEST: usize = 4096;

/// Inserts a typed character, which outside a field is the command `outside`.
pub(super) fn insert(app: &mut App, letter: char, outside: Option<&str>) {
    if app.prompts.is_empty() && app.has_line() && !names(app).is_empty() {
        return choose_by_name(app, letter.encode_utf8(&mut [0; 4]));
    }
    let before = rows::text(&app.tab.case, app.tab.form.focus).map(str::to_owned);
    let row = rows::field(&app.tab.case, app.tab.form.focus);
    let is_value =
        row.is_some_and(|field| !matches!(field.kind, Kind::Text) && !field.takes_auto());
    let outside = outside.filter(|_| is_value);
    let is_announced = app.starts_new_edit() && (letter.is_ascii_digit() || outside.is_some());
    // Space completes the name of a distribution.
    let rest = Some(rest_of_shape(app)).filter(|_| letter == ' ').flatten();
    paste(app, &format!("{}{letter}", rest.unwrap_or_default()));
    if is_announced {
        announce(app, letter, before.as_deref(), outside);
    }
}

fn rest_of_shape(app: &App) -> Option<&'static str> {
    let is_in_form = app.prompts.is_empty() && app.has_line();
    let form = Some(&app.tab.form).filter(|_| is_in_form)?;
    rows::rest_of_shape(&app.tab.case, form.focus, form.input.value())
}

/// Inserts a pasted text into a line of text, without control characters. Several lines become one.
pub(super) fn paste(app: &mut App, text: &str) {
    let editing_case = app.prompts.is_empty();
    let takes_text = app.has_line();
    if editing_case && takes_text && !names(app).is_empty() {
        return choose_by_name(app, text.trim());
    }
    let line = match app.prompts.last_mut() {
        Some(prompt) => prompt.dialog_mut().input(),
        None => Some(&mut app.tab.form.input).filter(|_| takes_text),
    };
    let Some(line) = line else {
        return app.say("nothing to paste into: go to a field of the form, Enter edits it");
    };
    let room = LONGEST.saturating_sub(line.kept());
    let parts = text.split(['\n', '\r', '\t']);
    let text = match parts.clone().count() {
        1 => text.to_owned(),
        _ => parts.map(str::trim).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" "),
    };
    let typed: String = text.chars().filter(|&letter| text::is_safe(letter)).take(room).collect();
    if typed.is_empty() {
        return;
    }
    line.insert(&typed);
    if editing_case {
        write(app);
    } else {
        app.line_changed();
    }
}

/// Handles a key that moves the cursor or deletes text.
pub(super) fn handle(app: &mut App, request: InputRequest) {
    if request == InputRequest::DeletePrevChar
        && app.browser().is_some_and(|browser| browser.input.value().is_empty())
    {
        return app.browse_up();
    }
    if let Some(prompt) = app.prompts.last_mut() {
        let changed = prompt.dialog_mut().input().and_then(|input| input.handle(request));
        if changed.is_some_and(|changed| changed.value) {
            app.line_changed();
        }
    } else if app.tab.form.input.handle(request).is_some_and(|changed| changed.value) {
        write(app);
    }
}

/// Starts an edit of the focused field: typing replaces its value until the cursor moves.
pub(super) fn begin(app: &mut App) {
    app.layout.focus = Pane::Form;
    app.is_editing = true;
    app.tab.form.input.select_all();
}

/// Selects the next or the previous choice of the focused field.
pub(super) fn cycle(app: &mut App, by: isize) {
    choose(app, app.tab.form.focus, names(app), by);
}

/// Selects the choice beside the present one, in any field with choices.
pub(super) fn choose(app: &mut App, field: usize, names: &[&str], by: isize) {
    let now = names.iter().position(|name| *name == chosen(app, field));
    let count = names.len().max(1);
    let next = now.map_or(0, |now| (now + count).saturating_add_signed(by) % count);
    if let Some(name) = names.get(next) {
        set(app, field, name);
    }
}

/// Steps the value of the focused row by units of its last digit.
pub(super) fn step(app: &mut App, by: isize) {
    let Some(text) = rows::stepped(&app.tab.case, app.tab.form.focus, by) else {
        let label = rows::full_label(&app.tab.case, app.tab.form.focus);
        return app.say(format!("{label} has no step here"));
    };
    app.tab.form.input = Line::whole(text);
    write(app);
}

/// The choice of a field that applies.
pub(super) fn chosen(app: &App, field: usize) -> &str {
    match (app.tab.case.text(field), FIELDS[field].absent) {
        (Some(text), _) | (None, Absent::Default(text)) => text,
        _ => "",
    }
}

/// Selects a choice, in any field with choices.
pub(super) fn set(app: &mut App, field: usize, name: &str) {
    if chosen(app, field) == name {
        return;
    }
    app.tab.before_edit(field);
    app.tab.case.write(field, name);
    if field == app.tab.form.focus {
        app.tab.form.input = name.into();
    }
    checked(app);
}

/// Replaces the case of the form as one edit, and says what it did.
pub(super) fn replace_saying(app: &mut App, case: Case, words: &str) {
    let outcome = if case == app.tab.case { ", unchanged" } else { "; Ctrl-Z undoes" };
    replace(app, case);
    app.say(format!("{words}{outcome}"));
}

/// Replaces the case of the form as one edit.
pub(super) fn replace(app: &mut App, case: Case) {
    if case == app.tab.case {
        return;
    }
    app.tab.history.end_visit();
    let focus = app.tab.form.focus;
    app.tab.before_edit(focus);
    app.replace_case(case, focus);
}

pub(super) fn undo(app: &mut App) {
    travel(app, false, "undo");
}

pub(super) fn redo(app: &mut App) {
    travel(app, true, "redo");
}

fn travel(app: &mut App, forwards: bool, verb: &str) {
    // A row that is still empty is no edit.
    let focus = app.tab.form.focus;
    if rows::row(&app.tab.case, focus).entry().is_some()
        && rows::text(&app.tab.case, focus).is_none()
    {
        app.tab.case.drop_empty(None);
        app.tab.focus_on(focus);
    }
    let state = app.tab.history.travel(&app.tab.case, app.tab.form.focus, forwards);
    let Some((case, focus)) = state else {
        return app.say(format!("nothing to {verb}"));
    };
    app.tab.remember();
    let summary = session::summary(&changes::between(&app.tab.case, &case));
    app.replace_case(case, focus);
    app.say(format!("{verb}: {summary}"));
}

/// Selects a method, otherwise the next one.
pub(super) fn set_method(app: &mut App, method: Option<Method>) {
    let field = index_of("model.method").unwrap_or_default();
    match method {
        Some(method) => set(app, field, method.name()),
        None => choose(app, field, &Method::ALL.map(Method::name), 1),
    }
    let waits = if app.tab.is_stale() { ", solved once every field is valid" } else { "" };
    app.say(format!("method {}{waits}", chosen(app, field)));
}

/// Opens the list of materials for the gear of the focused field, otherwise for both gears.
pub(super) fn ask_material(app: &mut App) {
    let table = rows::field(&app.tab.case, app.tab.form.focus).map(Field::table);
    let (gears, title): (&[&str], _) = match table {
        Some("driver") => (&["driver"], "Material of the driver"),
        Some("driven") => (&["driven"], "Material of the driven gear"),
        _ => (&["driver", "driven"], "Material of both gears"),
    };
    let item = |material: &'static Material| {
        let Material { name, group, young, poisson, density, source, .. } = material;
        let about = format!("{young}, {poisson}, {density}, {group}; {source}");
        let choice = Choice::of(move |app| make_of_material(app, gears, material));
        Item::named(choice, name.clone(), about)
    };
    app.pick(Picker::new(title, materials::all().iter().map(item), &[]));
}

/// Sets the material of the gears as one edit, which undo reverts.
fn make_of_material(app: &mut App, gears: &[&str], material: &Material) {
    let mut case = app.tab.case.clone();
    let made = gears.iter().try_for_each(|gear| materials::apply(&mut case, gear, material));
    if let Err(problem) = made {
        return app.complain(problem.for_form().to_string());
    }
    let verb = if case == app.tab.case { "unchanged, from" } else { "from" };
    replace(app, case);
    let whose = if let [gear] = gears { gear } else { "both gears" };
    let values = material.texts().map(|(name, text)| {
        let symbol =
            FIELDS.iter().find(|field| field.name() == name).map_or("", |field| field.symbol);
        let name = symbol.trim_end_matches(|c: char| c.is_ascii_digit());
        format!("{} {text}", text::symbol(name, app.look.ascii))
    });
    app.say(format!("{whose}: {} {verb} {}", values.join(", "), material.name));
}

/// Sets a limit on the selected result if the results have the focus, otherwise opens the list of
/// results.
pub(super) fn ask_limit(app: &mut App) {
    match app.marked_result().filter(|_| app.layout.focus == Pane::Results) {
        Some(quantity) => hold_limit(app, quantity),
        None => app.pick(Picker::results("Set a limit on a result", hold_limit)),
    }
}

/// Goes to the limit of a quantity; a new limit starts with the present value of the quantity, or
/// empty without one.
fn hold_limit(app: &mut App, quantity: &'static Quantity) {
    let from = app.tab.form.focus;
    let is_new = rows::of_entry(&app.tab.case, quantity.key).is_none();
    if is_new {
        // The printed value of the quantity, rounded up so that the limit is met.
        let value = app.tab.solution().and_then(|solution| report::value(quantity, solution));
        let begin = |value: f64| {
            let text = report::shown_in(quantity, value, app.settings.units).to_string();
            let is_below = Limit::new(quantity.key, &text).is_ok_and(|limit| limit.value < value);
            let raised = step_limit(&text, quantity.key, 1).filter(|_| is_below);
            raised.unwrap_or(text)
        };
        if let Some(value) = value {
            let mut case = app.tab.case.clone();
            case.write_limit(quantity, &begin(value));
            replace(app, case);
        } else {
            app.tab.case.write_limit(quantity, "");
        }
    }
    let row = rows::of_entry(&app.tab.case, quantity.key);
    edit_row(app, row.unwrap_or(from), is_new.then_some(from));
}

fn edit_row(app: &mut App, row: usize, added_from: Option<usize>) {
    app.layout.focus = Pane::Form;
    app.is_editing = true;
    app.focus_on(row);
    app.tab.form.added_from = added_from;
}

/// Esc in a row that a command added: the case is as before, unless the row is edited.
pub(super) fn take_back(app: &mut App) {
    let Some(from) = app.tab.form.added_from else { return };
    if rows::text(&app.tab.case, app.tab.form.focus).is_some() {
        undo(app);
    } else {
        app.tab.case.drop_empty(None);
        app.focus_on(from);
    }
}

/// Goes to the distribution of the focused field, if it is a number; outside the form, opens the
/// list of fields.
pub(super) fn ask_spread(app: &mut App) {
    match spread_field(app) {
        Some(field) if app.layout.focus == Pane::Form => begin_spread(app, field),
        None if app.layout.focus == Pane::Form => app.complain(no_spread(app)),
        _ => app.pick(Picker::fields("Distribution of a field", true, begin_spread)),
    }
}

// Why the focused row has no distribution, with the fix.
fn no_spread(app: &App) -> String {
    let Some(known) = rows::field(&app.tab.case, app.tab.form.focus) else {
        return "a limit has no distribution: go to a field with a number, then Alt-D".to_owned();
    };
    let kind = match known.kind {
        Kind::Count(..) => "a whole number",
        Kind::Choice(..) => "a choice",
        Kind::List(_) => "a list",
        Kind::Number(..) | Kind::Text => "a text",
    };
    let other = match known.name() {
        "grade" => "the base pitch deviation f_pb",
        _ => "a field with a number",
    };
    format!("{} is {kind} and has no distribution: go to {other}, then Alt-D", known.full_label())
}

// The focused field, or the field of the focused distribution, if it can have a distribution.
fn spread_field(app: &App) -> Option<usize> {
    let field = match rows::row(&app.tab.case, app.tab.form.focus) {
        Row::Field(field) => field,
        Row::Spread(spread) => index_of(spread.field)?,
        Row::Limit(_) => return None,
    };
    matches!(FIELDS[field].kind, Kind::Number(..)).then_some(field)
}

/// Goes to the distribution of a field; a new one is empty.
fn begin_spread(app: &mut App, field: usize) {
    let Field { key, .. } = FIELDS[field];
    let from = app.tab.form.focus;
    let is_new = rows::of_entry(&app.tab.case, key).is_none();
    if is_new {
        app.tab.case.write_spread(key, "");
    }
    let row = rows::of_entry(&app.tab.case, key).unwrap_or(field);
    edit_row(app, row, is_new.then_some(from));
}

/// Gives the focused field a distribution such as `normal 4 um`; `none` removes it.
pub(super) fn set_spread(app: &mut App, text: &str) {
    let Some(field) = spread_field(app) else {
        return app.complain(no_spread(app));
    };
    let key = format!("spread.{}", FIELDS[field].key);
    let said = format!("spread of {}: {text}", FIELDS[field].full_label());
    apply(app, &key, Some(text).filter(|text| *text != "none"), &said);
}

/// Writes a value of the file that has no row in the form.
fn apply(app: &mut App, key: &str, text: Option<&str>, said: &str) {
    let mut case = app.tab.case.clone();
    match case.apply(key, text) {
        Ok(()) => replace_saying(app, case, said),
        Err(problem) => app.complain(problem.for_form().to_string()),
    }
}

/// Writes a line of `[about]`, such as `project = GB 12`; an empty text removes it.
pub(super) fn set_about(app: &mut App, text: &str) {
    let (name, value) = text.split_once('=').unwrap_or((text, ""));
    let (name, value) = (name.trim().trim_matches('"'), value.trim());
    if name.is_empty() || !text.contains('=') {
        return app.complain("type NAME = TEXT, such as drawing number = GB 12");
    }
    let said = format!("about: {name} = {}", session::shown(Some(value)));
    apply(app, &format!("about.{name}"), Some(value), &said);
}

/// Opens the dialog and starts the search with the last demand of the tab, or with the tolerances
/// of the case.
pub(super) fn ask_relief(app: &mut App) {
    let Some(inputs) = app.tab.inputs().cloned() else {
        return app.complain("no search: fix the fields marked with ! first");
    };
    let units = app.settings.units;
    let demand = app.tab.demand.clone().unwrap_or_else(|| {
        let [driver, driven, from, to] = relief::tolerances(&app.tab.case);
        let given = |off: f64| Some(off).filter(|off| *off > 0.0);
        let usual = Demand::usual(units);
        let tolerance = given(driver.max(driven)).unwrap_or(usual.tolerance);
        let written = rows::written_system(&app.tab.case, "driven.tip_relief").unwrap_or(units);
        let tolerance_length = given(from.max(to));
        Demand { tolerance, tolerance_length, units: written, ..usual }
    });
    let mut dialog = ReliefDialog::new(inputs, (demand.text(units), units), take_relief);
    app.start_all(dialog.search());
    app.prompts.push(Prompt::Relief(Box::new(dialog)));
}

/// Writes the relief and its tolerances into the form as one edit; the message has the shown texts.
fn take_relief(app: &mut App, values: &[(&'static str, String)], shown: &[(&'static str, String)]) {
    super::close(app);
    let words = shown.iter().filter_map(|(key, text)| {
        let Field { symbol, label, .. } = FIELDS[index_of(key)?];
        let name = if symbol.is_empty() { label } else { symbol };
        Some(format!("{} {text}", text::symbol(name, app.look.ascii)))
    });
    let mut words: Vec<String> = words.collect();
    if values.iter().any(|(key, text)| key.starts_with("spread.") && !text.is_empty()) {
        words.push("tolerances in [spread]".to_owned());
    }
    set_values(app, values, &words.join(", "));
}

/// Writes values of fields into the form as one edit, and says what it did.
pub(super) fn set_values(app: &mut App, values: &[(&'static str, String)], words: &str) {
    let mut case = app.tab.case.clone();
    for (key, text) in values {
        if let Err(problem) = case.set(key, text) {
            return app.complain(problem.for_form().to_string());
        }
    }
    replace_saying(app, case, words);
}

// Reports the effect of a digit or letter, because outside a field the same key shows a pane or is
// the command `outside`.
fn announce(app: &mut App, digit: char, before: Option<&str>, outside: Option<&str>) {
    let earlier = app.message.take();
    let earlier = earlier.map_or_else(String::new, |message| message.text + ". ");
    let label = rows::full_label(&app.tab.case, app.tab.form.focus);
    let edit = match session::shown(before) {
        text if before.is_some() => format!("{digit} replaces {text}. Ctrl-Z restores {text}"),
        _ => format!("{digit} starts a value. Ctrl-Z removes {digit}"),
    };
    let pane = Pane::of_digit(digit).map(|pane| format!("shows {}", pane.name()));
    let other = pane.or_else(|| outside.map(|name| format!("is {name}")));
    let other = other.map(|other| format!("; Esc {digit} {other}"));
    app.say(format!("{earlier}{label}: {edit}{}", other.unwrap_or_default()));
}

/// The choices of the focused row.
fn names(app: &App) -> &'static [&'static str] {
    rows::names(&app.tab.case, app.tab.form.focus)
}

// Selects the choice that begins with the letters typed so far, which are the part of the line before
// its selection; otherwise the next choice that begins with the typed letter alone.
fn choose_by_name(app: &mut App, typed: &str) {
    if typed.is_empty() {
        return;
    }
    let (field, names, typed) = (app.tab.form.focus, names(app), typed.to_lowercase());
    let line = &app.tab.form.input;
    let count = line.selected().map_or(0, |rest| rest.start);
    let begun = line.value().chars().take(count).collect::<String>() + &typed;
    let now = names.iter().position(|name| *name == chosen(app, field)).unwrap_or(0);
    let named = |start: &str, from: usize| {
        names.iter().cycle().skip(from).take(names.len()).find(|name| name.starts_with(start))
    };
    let longer = named(&begun, now).filter(|_| count > 0).map(|name| (name, &begun));
    let alone = || Some((named(&typed, now + 1)?, &typed)).filter(|_| count < 2);
    if let Some((name, typed)) = longer.or_else(alone) {
        set(app, field, name);
        app.tab.form.input = Line::begun(name, typed.chars().count());
    } else if let Some(pane) = typed.parse().ok().and_then(Pane::of_digit) {
        let pane = pane.name();
        app.say(format!(
            "no choice begins with {typed}. Esc leaves the field; then {typed} shows {pane}"
        ));
    } else {
        let start = text::printable(&begun);
        app.complain(format!(
            "no choice begins with {start}: a first letter or Space selects a choice"
        ));
    }
}

fn write(app: &mut App) {
    let focus = app.tab.form.focus;
    let text = completed(app);
    let is_other = rows::text(&app.tab.case, focus).unwrap_or_default() != text;
    if is_other {
        app.tab.before_edit(focus);
        rows::write(&mut app.tab.case, focus, &text);
    }
    if let Some(other) = rows::field(&app.tab.case, focus).and_then(Field::partner) {
        take_turns(app, focus, other);
    }
    if is_other {
        checked(app);
    }
}

// The typed text, a number with its unit; blanks around a number are removed.
fn completed(app: &App) -> String {
    let text = [app.tab.form.input.value(), &app.ending().unwrap_or_default()].concat();
    let is_words = rows::field(&app.tab.case, app.tab.form.focus)
        .is_some_and(|field| matches!(field.kind, Kind::Text));
    if is_words { text } else { text.trim().to_owned() }
}

// Of two fields that exclude each other, the edited one applies. Once it is empty again, the value
// of the other is restored. The status line reports this during typing.
fn take_turns(app: &mut App, field: usize, other: usize) {
    let before = app.tab.history.before_visit().and_then(|before| before.text(other));
    let Some(before) = before.map(str::to_owned) else { return };
    let (this, that) = (FIELDS[field].label, FIELDS[other].label);
    if app.tab.case.text(field).is_some() {
        app.tab.case.write(other, "");
        app.say(format!("{that} {before} replaced by the {this}"));
    } else if app.tab.case.text(other).is_none() {
        app.tab.case.write(other, &before);
        app.say(format!("{that} {before} restored"));
    }
}

fn checked(app: &mut App) {
    app.solve();
    app.follow();
}
