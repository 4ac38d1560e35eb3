//! The one table of keys, names and sentences, from which key map, status line, palette and help
//! are derived.

use crossterm::event::KeyCode;
use tui_input::InputRequest as Line;

use super::Command as Do;
use super::{Binding, Command};
use crate::model::inputs::Method;
use crate::tui::keys::{ALT, CTRL, Chord, Place, SHIFT, alt, ctrl, function, key, letter, with};
use crate::tui::pane::Pane;
use crate::tui::panes::chart::ChartCommand as Chart;
use crate::tui::panes::teeth::TeethCommand as Teeth;

// In the status line, the palette and the help.
const fn shown(
    places: Place,
    chords: &'static [Chord],
    command: Command,
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    shown_in(places, places, chords, command, name, sentence)
}

// In the palette and the help, and in the status line where it is wanted most.
const fn shown_in(
    footer: Place,
    places: Place,
    chords: &'static [Chord],
    command: Command,
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    Binding {
        chords,
        command,
        places,
        name,
        sentence,
        footer,
    }
}

// In the palette and the help.
const fn listed(
    places: Place,
    chords: &'static [Chord],
    command: Command,
    name: &'static str,
    sentence: &'static str,
) -> Binding {
    shown_in(Place::NONE, places, chords, command, name, sentence)
}

// In the help alone.
const fn told(
    places: Place,
    chords: &'static [Chord],
    command: Command,
    sentence: &'static str,
) -> Binding {
    shown_in(Place::NONE, places, chords, command, "", sentence)
}

/// Every key of the workbench, in the order of the help; the status line shows as many as fit.
#[rustfmt::skip]
pub static BINDINGS: &[Binding] = &[
    // Outside a field, where letters are commands.
    shown(Place::FIELD, &[key(KeyCode::Enter), letter('i')], Do::StartEdit, "edit", "Type into the focused field; Esc leaves it."),
    shown(Place::RESULTS, &[key(KeyCode::Enter)], Do::Explain, "explain", "Where the marked result comes from."),
    shown(Place::TRADE, &[key(KeyCode::Enter)], Do::TakeSetting, "take setting", "Make the marked setting the case's."),
    shown(Place::TRADE, &[letter('m')], Do::Measure, "measure", "Measure error and time of every method and setting on this case."),
    told(Place::TRADE, &[letter('l'), letter('j'), key(KeyCode::Right), key(KeyCode::Down)], Do::Next, "The next slower setting."),
    told(Place::TRADE, &[letter('h'), letter('k'), key(KeyCode::Left), key(KeyCode::Up)], Do::Previous, "The next quicker setting."),
    shown(Place::CURSOR, &[letter(' ')], Do::Play, "play", "Run the cursor over the visible part of the contact, or stop it."),
    told(Place::CURSOR, &[letter('h'), key(KeyCode::Left)], Do::CursorBy(-1), "The cursor a column towards D."),
    shown(Place::CURSOR, &[letter('l'), key(KeyCode::Right)], Do::CursorBy(1), "cursor", "The cursor a column towards E."),
    told(Place::CURSOR, &[letter('H'), with(SHIFT, KeyCode::Left)], Do::CursorBy(-10), "The cursor ten columns towards D."),
    told(Place::CURSOR, &[letter('L'), with(SHIFT, KeyCode::Right)], Do::CursorBy(10), "The cursor ten columns towards E."),
    listed(Place::CURSOR, &[key(KeyCode::Home)], Do::CursorToD, "cursor to D", "The cursor to the first contact D."),
    listed(Place::CURSOR, &[key(KeyCode::End)], Do::CursorToE, "cursor to E", "The cursor to E, where the normal path of contact begins."),
    listed(Place::OUTSIDE, &[letter('a')], Do::CursorTo, "cursor to angle", "The cursor to a roll angle or a time, or to D, E, B, L or the peak."),
    listed(Place::CURSOR, &[letter('c')], Do::CursorAway, "cursor away", "Take the cursor away."),
    shown(Place::CHART, &[letter('j'), key(KeyCode::Down)], Do::Chart(Chart::Step(1)), "next chart", "Show the next chart."),
    listed(Place::CHART, &[letter('k'), key(KeyCode::Up)], Do::Chart(Chart::Step(-1)), "previous chart", "Show the previous chart."),
    shown(Place::CHART, &[letter('+'), letter('=')], Do::Chart(Chart::Zoom(1)), "zoom in", "Zoom the charts in, around the cursor or D."),
    shown(Place::CHART, &[letter('-')], Do::Chart(Chart::Zoom(-1)), "zoom out", "Zoom the charts out, at most to the whole contact."),
    shown(Place::CHART, &[letter('0')], Do::Chart(Chart::Whole), "whole contact", "Show the whole contact in the charts, from D to the last contact."),
    shown(Place::CHART, &[letter('v')], Do::Chart(Chart::Strike), "strike", "Show the charts from D to a little after E, or the whole contact."),
    shown(Place::CHART, &[letter('t')], Do::Chart(Chart::Time), "time axis", "Switch the x axis between the time after E and the roll angle before E."),
    shown(Place::TEETH, &[letter('+'), letter('=')], Do::Teeth(Teeth::Zoom(1)), "closer", "Zoom the teeth in."),
    shown(Place::TEETH, &[letter('-')], Do::Teeth(Teeth::Zoom(-1)), "farther", "Zoom the teeth out, at most to the whole pair."),
    listed(Place::TEETH, &[letter('0')], Do::Teeth(Teeth::Reset), "first view", "Show the teeth around the strike."),
    shown(Place::TEETH, &[letter('v'), letter('j'), key(KeyCode::Down)], Do::Teeth(Teeth::Centre(1)), "view", "Show the teeth around the strike, around the pitch point, or the whole pair."),
    told(Place::TEETH, &[letter('k'), key(KeyCode::Up)], Do::Teeth(Teeth::Centre(-1)), "Show the previous view."),
    listed(Place::TEETH, &[letter('x')], Do::Teeth(Teeth::Gap), "gap", "Exaggerate the gap between the teeth by the factor shown, or draw it true to scale."),
    shown_in(Place::OUTSIDE, Place::COMMANDED, &[letter('/')], Do::SearchField, "search", "Find a field or a result by its name, symbol, key or a word of its help."),
    shown_in(Place::FIELD, Place::WORK, &[alt('g')], Do::Material, "material", "Give this gear, or both, a material of the catalogue."),
    shown_in(Place::RESULTS, Place::OUTSIDE, &[letter('n')], Do::Notes, "notes", "The outcome, the gauges and every note of the model in full."),
    shown_in(Place::RESULTS, Place::WORK, &[alt('l')], Do::Limit, "limit", "Hold a result to a limit: the marked one, or one of a list."),
    shown_in(Place::OUTSIDE, Place::COMMANDED, &[letter(':')], Do::Palette, "commands", "Every command by name, and every field and result: type a few letters, Enter runs it or goes there."),
    shown(Place::OUTSIDE, &[letter('q')], Do::Quit, "quit", "Quit; asks when something is unsaved."),
    shown(Place::OUTSIDE, &[letter('?')], Do::Help, "help", "This page."),
    shown(Place::OUTSIDE, &[key(KeyCode::Tab)], Do::NextPane, "next pane", "The next pane."),
    listed(Place::OUTSIDE, &[key(KeyCode::BackTab)], Do::PreviousPane, "previous pane", "The pane before."),
    shown(Place::OUTSIDE, &[letter('u')], Do::Undo, "undo", "Undo the edits of the last field."),
    shown(Place::OUTSIDE, &[letter('b')], Do::PinBaseline, "baseline", "Pin the results as the baseline to compare others with, or unpin them."),
    shown(Place::OUTSIDE, &[letter('y')], Do::CopyValue, "copy value", "Copy the focused value, in chart and teeth the reading at the cursor, to the clipboard of your own terminal."),
    shown(Place::OUTSIDE, &[letter('Y')], Do::CopyResults, "copy results", "Copy all results to the clipboard of your own terminal."),
    shown(Place::OUTSIDE, &[letter('z')], Do::Zoom, "zoom", "Give the focused pane the screen, or take it back."),
    listed(Place::OUTSIDE, &[letter('1')], Do::Show(Pane::Form), "form", "Go to the form."),
    listed(Place::OUTSIDE, &[letter('2')], Do::Show(Pane::Results), "results", "Go to the results."),
    listed(Place::OUTSIDE, &[letter('3')], Do::Show(Pane::Chart), "chart", "Go to the chart."),
    listed(Place::OUTSIDE, &[letter('4')], Do::Show(Pane::Teeth), "teeth", "Go to the teeth."),
    listed(Place::OUTSIDE, &[letter('5')], Do::Show(Pane::Trade), "trade", "Go to error against time."),
    told(Place::FIELD.or(Place::RESULTS), &[letter('j'), key(KeyCode::Down)], Do::Next, "The next line."),
    told(Place::FIELD.or(Place::RESULTS), &[letter('k'), key(KeyCode::Up)], Do::Previous, "The line before."),
    told(Place::FIELD.or(Place::RESULTS), &[letter('l'), key(KeyCode::Right)], Do::NextGroup, "The next group, or page of results."),
    told(Place::FIELD.or(Place::RESULTS), &[letter('h'), key(KeyCode::Left)], Do::PreviousGroup, "The group before, or page of results."),
    told(Place::FIELD.or(Place::RESULTS), &[letter('g'), key(KeyCode::Home)], Do::First, "The first line."),
    told(Place::FIELD.or(Place::RESULTS), &[letter('G'), key(KeyCode::End)], Do::Last, "The last line."),
    // Everywhere.
    shown(Place::WORK, &[function(1), alt('h')], Do::Help, "help", "This page."),
    shown(Place::WORK, &[ctrl('s')], Do::Save, "save", "Save the case; comments and order of the file stay."),
    shown(Place::WORK, &[ctrl('p')], Do::Palette, "commands", "Every command by name, and every field and result: type a few letters, Enter runs it or goes there."),
    shown(Place::WORK, &[ctrl('o')], Do::Open, "open", "Open another case, in a tab of its own."),
    shown(Place::WORK, &[ctrl('q')], Do::Quit, "quit", "Quit; asks when something is unsaved."),
    shown(Place::FORM, &[key(KeyCode::Esc)], Do::Leave, "leave field", "Leave the field: letters are commands then."),
    shown(Place::WORK, &[ctrl('t'), function(6)], Do::ToggleMethod, "method", "Next method: paper, exact, static, dynamic, auto."),
    listed(Place::WORK, &[], Do::Method(Method::Paper), "method paper", "Solve by the closed form as it is printed."),
    listed(Place::WORK, &[], Do::Method(Method::Exact), "method exact", "Solve by the closed form, from the first contact where the gap closes."),
    listed(Place::WORK, &[], Do::Method(Method::Static), "method static", "Solve for how the pairs in contact share the load at rest."),
    listed(Place::WORK, &[], Do::Method(Method::Dynamic), "method dynamic", "Solve for the pair in motion, with inertia."),
    listed(Place::WORK, &[], Do::Method(Method::Auto), "method auto", "Solve by the cheapest of exact, static and dynamic that is good enough."),
    shown(Place::WORK, &[ctrl('z')], Do::Undo, "undo", "Undo the edits of the last field."),
    shown(Place::WORK, &[function(5), alt('p')], Do::CycleLower, "switch", "Switch the lower area: chart, teeth, trade."),
    listed(Place::WORK, &[function(9)], Do::Zoom, "zoom", "Give the focused pane the screen, or take it back."),
    listed(Place::WORK, &[function(4), with(CTRL, KeyCode::Down)], Do::ResultsDown, "results down", "Further down in the results."),
    listed(Place::WORK, &[function(3), with(CTRL, KeyCode::Up)], Do::ResultsUp, "results up", "Back up in the results."),
    listed(Place::WORK, &[function(2), alt('s')], Do::SaveAs, "save as", "Save under another name."),
    listed(Place::WORK, &[ctrl('n')], Do::New, "new", "Start an empty case: required fields are marked, the others show their defaults."),
    listed(Place::WORK, &[alt('n')], Do::Example, "from example", "Start a case from one of the examples."),
    listed(Place::WORK, &[alt('t')], Do::BuiltIn, "Table 1", "Show the built-in example, Table 1 of the paper."),
    listed(Place::WORK.or(Place::BROWSE), &[alt('r')], Do::Recent, "recent cases", "Open one of the cases that were open last."),
    listed(Place::WORK, &[with(CTRL, KeyCode::PageDown)], Do::NextTab, "next case", "Switch to the next open case, in its tab."),
    listed(Place::WORK, &[with(CTRL, KeyCode::PageUp)], Do::PreviousTab, "previous case", "Switch to the open case before, in its tab."),
    listed(Place::WORK, &[alt('w')], Do::CloseTab, "close case", "Close the case and its tab; asks when it is unsaved."),
    told(Place::WORK, &[alt('1')], Do::Tab(0), "The first open case; the second and so on by Alt-2 to Alt-9."),
    told(Place::WORK, &[alt('2')], Do::Tab(1), ""),
    told(Place::WORK, &[alt('3')], Do::Tab(2), ""),
    told(Place::WORK, &[alt('4')], Do::Tab(3), ""),
    told(Place::WORK, &[alt('5')], Do::Tab(4), ""),
    told(Place::WORK, &[alt('6')], Do::Tab(5), ""),
    told(Place::WORK, &[alt('7')], Do::Tab(6), ""),
    told(Place::WORK, &[alt('8')], Do::Tab(7), ""),
    told(Place::WORK, &[alt('9')], Do::Tab(8), ""),
    listed(Place::WORK, &[alt('e')], Do::NextFault, "next fault", "The next field that is wrong."),
    listed(Place::WORK, &[ctrl('y'), ctrl('r')], Do::Redo, "redo", "Redo what was undone."),
    listed(Place::WORK, &[alt('b')], Do::PinBaseline, "baseline", "Pin the results as the baseline to compare others with, or unpin them."),
    listed(Place::OUTSIDE, &[letter('%')], Do::ShowCost, "cost", "Tell beside the results which stages the last solve ran, and in how many microseconds."),
    listed(Place::WORK, &[function(8), alt('m')], Do::CycleMarker, "marker", "Draw the chart in Braille, blocks or dots."),
    listed(Place::WORK, &[], Do::CycleTheme, "theme", "Change the colours: quiet, contrast, mono."),
    listed(Place::WORK, &[], Do::ToggleAscii, "ascii", "Draw with ASCII alone, or with the whole of Unicode."),
    listed(Place::WORK, &[], Do::CycleUnits, "units", "Show results, hints, charts and teeth in metric or in inch units."),
    listed(Place::WORK, &[], Do::ToggleMouse, "mouse", "Take the mouse (a press marks, a second one does what Enter does; with Shift held most terminals still select text), or leave it to the terminal."),
    listed(Place::WORK, &[ctrl('l')], Do::Redraw, "redraw", "Draw the screen anew."),
    listed(Place::WORK, &[alt('z')], Do::Suspend, "suspend", "Suspend to the shell; fg comes back."),
    shown_in(Place::FORM, Place::FORM.or(Place::FIELD), &[with(SHIFT, KeyCode::Up)], Do::Step(1), "step", "The value one step up: its last digit moves."),
    told(Place::FORM.or(Place::FIELD), &[with(SHIFT, KeyCode::Down)], Do::Step(-1), "The value one step down."),
    told(Place::FORM.or(Place::FIELD), &[with(ALT, KeyCode::Up)], Do::Step(10), "The value ten steps up."),
    told(Place::FORM.or(Place::FIELD), &[with(ALT, KeyCode::Down)], Do::Step(-10), "The value ten steps down."),
    told(Place::FORM, &[key(KeyCode::Down), key(KeyCode::Tab), key(KeyCode::Enter)], Do::Next, "The next field."),
    told(Place::FORM, &[key(KeyCode::Up), key(KeyCode::BackTab)], Do::Previous, "The field before."),
    told(Place::FORM.or(Place::FIELD).or(Place::RESULTS), &[key(KeyCode::PageDown)], Do::NextGroup, "The next group, or page of results."),
    told(Place::FORM.or(Place::FIELD).or(Place::RESULTS), &[key(KeyCode::PageUp)], Do::PreviousGroup, "The group before, or page of results."),
    told(Place::WORK, &[with(CTRL, KeyCode::Home)], Do::FirstField, "The first field."),
    told(Place::WORK, &[with(CTRL, KeyCode::End)], Do::LastField, "The last field."),
    told(Place::CHOICE, &[key(KeyCode::Right), letter(' ')], Do::NextChoice, "The next of the names."),
    told(Place::CHOICE, &[key(KeyCode::Left)], Do::PreviousChoice, "The name before."),
    told(Place::CHOICE, &[key(KeyCode::Backspace), key(KeyCode::Delete), ctrl('h')], Do::Edit(Line::DeleteLine), "Back to what holds without a choice."),
    told(Place::CHOICE, &[letter('?')], Do::Help, "This page."),
    told(Place::OUTSIDE, &[key(KeyCode::Esc)], Do::Leave, "Stop what runs, take the cursor away, back to the form; nothing is lost."),
    // In prompts.
    shown(Place::BROWSE, &[key(KeyCode::Tab)], Do::Complete, "take over", "Go into the marked folder, or write the marked name into the line."),
    shown(Place::BROWSE, &[with(ALT, KeyCode::Up)], Do::FolderUp, "folder up", "The folder above; so does Backspace in an empty line."),
    shown(Place::EXPLAIN, &[key(KeyCode::Tab)], Do::NextReason, "next field", "The next of the fields that the result depends on."),
    told(Place::EXPLAIN, &[key(KeyCode::BackTab)], Do::PreviousReason, "The field before."),
    shown(Place::EXPLAIN, &[key(KeyCode::Enter)], Do::Accept, "go to field", "Go to the marked field of the form."),
    told(Place::EXPLAIN, &[letter('q')], Do::Leave, "Close the page."),
    told(Place::ASK, &[key(KeyCode::Tab), key(KeyCode::Right), key(KeyCode::Down)], Do::Next, "The next button."),
    told(Place::ASK, &[key(KeyCode::BackTab), key(KeyCode::Left), key(KeyCode::Up)], Do::Previous, "The button before."),
    told(Place::LIST.or(Place::PAGE), &[key(KeyCode::Down)], Do::Next, "The next line."),
    told(Place::LIST.or(Place::PAGE), &[key(KeyCode::Up)], Do::Previous, "The line before."),
    told(Place::PICK, &[ctrl('n'), key(KeyCode::Tab)], Do::Next, "The next line."),
    told(Place::PICK, &[ctrl('p'), key(KeyCode::BackTab)], Do::Previous, "The line before."),
    told(Place::PAGE, &[letter('j')], Do::Next, "The next line."),
    told(Place::PAGE, &[letter('k')], Do::Previous, "The line before."),
    shown(Place::LIST.or(Place::PAGE), &[key(KeyCode::PageDown)], Do::NextGroup, "next page", "The next page."),
    told(Place::PAGE, &[letter(' ')], Do::NextGroup, "The next page."),
    told(Place::LIST.or(Place::PAGE), &[key(KeyCode::PageUp)], Do::PreviousGroup, "The page before."),
    shown(Place::LIST.or(Place::PATH).or(Place::ASK), &[key(KeyCode::Enter)], Do::Accept, "accept", "Do it."),
    told(Place::READ, &[key(KeyCode::Enter), letter('q'), letter('?'), function(1)], Do::Leave, "Close the page."),
    shown(Place::PROMPT, &[key(KeyCode::Esc)], Do::Leave, "back", "Close; nothing is lost."),
    told(Place::ALL, &[ctrl('c'), ctrl('\\')], Do::Cancel, "Close a prompt, stop what runs; else twice it quits, and asks when something is unsaved."),
    // In a line of text.
    told(Place::LINE, &[key(KeyCode::Left)], Do::Edit(Line::GoToPrevChar), "A character to the left."),
    told(Place::LINE, &[key(KeyCode::Right)], Do::Edit(Line::GoToNextChar), "A character to the right."),
    told(Place::LINE, &[with(CTRL, KeyCode::Left), with(ALT, KeyCode::Left)], Do::Edit(Line::GoToPrevWord), "A word to the left."),
    told(Place::LINE, &[with(CTRL, KeyCode::Right), with(ALT, KeyCode::Right)], Do::Edit(Line::GoToNextWord), "A word to the right."),
    told(Place::LINE, &[key(KeyCode::Home), ctrl('a')], Do::Edit(Line::GoToStart), "To the start of the text."),
    told(Place::LINE, &[key(KeyCode::End), ctrl('e')], Do::Edit(Line::GoToEnd), "To the end of the text."),
    told(Place::LINE, &[key(KeyCode::Backspace), ctrl('h')], Do::Edit(Line::DeletePrevChar), "Delete the character before."),
    told(Place::LINE, &[key(KeyCode::Delete), ctrl('d')], Do::Edit(Line::DeleteNextChar), "Delete the character after."),
    told(Place::LINE, &[ctrl('w'), with(ALT, KeyCode::Backspace)], Do::Edit(Line::DeletePrevWord), "Delete the word before."),
    told(Place::LINE, &[ctrl('k')], Do::Edit(Line::DeleteTillEnd), "Delete to the end."),
    told(Place::LINE.or(Place::CHOICE), &[ctrl('u')], Do::Edit(Line::DeleteLine), "Empty the field: what then holds is shown in brackets."),
];
