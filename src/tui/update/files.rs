//! The open cases: opening, reading again, saving, their tabs and claims, and quitting, with a
//! question before edits are discarded.

use std::path::{Path, PathBuf};

use super::{edit, export, key_of};
use crate::case::file::Saved;
use crate::case::{Case, Document, EXAMPLES, Example, rexs};
use crate::tui::app::App;
use crate::tui::app::actions::{Choice, Effect, Running, Slot, Work};
use crate::tui::app::dialogs::Prompt;
use crate::tui::app::dialogs::page::Page;
use crate::tui::app::dialogs::picker::{Item, Picker};
use crate::tui::app::dialogs::question::{PathDialog, Question};
use crate::tui::app::tab::{Origin, Tab};
use crate::tui::layout::Pane;
use crate::tui::session::{
    self, Access, Claim, Found, NEWER, Next, Offer, Over, SaveFault, Saving, Written,
};
use crate::tui::solver::Wanted;
use crate::tui::store::folder::Target;
use crate::tui::text::{CASE_ENDING, Line};
use crate::tui::{rows, store};

const UNSAVED: &str = "Unsaved edits";
const SAVE_AS: &str = "Save as";
const HOW: &str =
    "A name or a path; ~ is the home folder, .toml is added if missing. Asks before overwriting.";

/// Quits, or asks if there are unsaved edits or text typed into a dialog.
pub(super) fn quit(app: &mut App) {
    app.close_titled(UNSAVED);
    let unsaved: Vec<_> = app.tabs().filter(|tab| tab.is_unsaved()).map(Tab::name).collect();
    let count = unsaved.len();
    // A suggested text is selected until the user types.
    let lines = app.prompts.iter_mut().filter_map(|prompt| prompt.dialog_mut().input());
    let mut typed = lines.filter(|line| line.selected().is_none() && !line.value().is_empty());
    if let Some(line) = typed.next().filter(|_| count == 0) {
        let text = format!("The dialog has not used its text: {}", line.value());
        return app.ask(Question::new(UNSAVED, text, [("Quit", going(Next::Quit)), cancel()]));
    }
    if count < 2 {
        let only = app.tabs().position(Tab::is_unsaved).unwrap_or(app.place_of_tab);
        // A dialog belongs to the case that is shown.
        if only != app.place_of_tab {
            while super::close(app) {}
        }
        go_to_tab(app, only);
        return ask_or_go(app, Next::Quit);
    }
    let text = format!("{count} cases have unsaved edits: {}.", unsaved.join(", "));
    let buttons =
        [("Save all", going(Next::SaveRest)), ("Discard all", going(Next::Quit)), cancel()];
    app.ask(Question::new(UNSAVED, text, buttons));
}

// Goes on, or asks before the edits of the current case are discarded.
pub(super) fn ask_or_go(app: &mut App, next: Next) {
    if !app.tab.is_unsaved() {
        return go(app, next);
    }
    let reload = match next {
        Next::Load(_) => " Discard reads the file again without the edits.",
        _ => "",
    };
    let text = format!("{} has unsaved edits.{reload}", app.tab.name());
    let after = next.clone();
    let saving = Choice::of(move |app| save(app, after.clone()));
    app.ask(Question::new(UNSAVED, text, [("Save", saving), ("Discard", going(next)), cancel()]));
}

fn going(next: Next) -> Choice {
    Choice::of(move |app| go(app, next.clone()))
}

fn cancel() -> (&'static str, Choice) {
    ("Cancel", Choice::none())
}

/// Asks after a save that would overwrite a file or that has no lock.
fn ask_refused(app: &mut App, path: &Path, fault: SaveFault, next: &Next) {
    let (name, after) = (path.display(), next.clone());
    let save_as = Choice::of(move |app| {
        if !matches!(app.prompts.last(), Some(Prompt::Path(dialog)) if dialog.title == SAVE_AS) {
            ask_where(app, after.clone());
        }
    });
    let save_as = ("Save as", save_as);
    let overwrite = |stamp| {
        let (path, next) = (path.to_owned(), next.clone());
        let write = move |app: &mut App| {
            write(app, path.clone(), Over::Seen(stamp), next.clone());
        };
        ("Overwrite", Choice::of(write))
    };
    app.ask(match fault {
        SaveFault::Exists(Found { stamp, lines }) => {
            let text = format!("{name} exists. Overwrite replaces it with the form.");
            let buttons = [overwrite(stamp), save_as, cancel()];
            Question::new("The file exists", text, buttons).with(lines)
        }
        SaveFault::Changed(Found { stamp, lines }) => {
            let text = format!(
                "{name} was changed after it was opened here. Reload discards the edits in the \
                 form."
            );
            let reload = ("Reload", going(Next::Load(path.to_owned())));
            let buttons = [reload, save_as, overwrite(stamp), cancel()];
            Question::new("The file has changed on disk", text, buttons).with(lines)
        }
        SaveFault::Held(holder) => {
            let text = format!("{name} is not saved: another session has it open: {holder}.");
            Question::new("Open elsewhere", text, [save_as, cancel()]).on(0)
        }
        SaveFault::Failed(reason) => return app.complain(format!("not saved: {reason}")),
    });
}

// Offers edits that an earlier session could not save.
fn ask_recovery(app: &mut App, name: &str, offer: Offer) {
    let changed = if offer.is_file_changed { " The file has changed since." } else { "" };
    let text = format!(
        "Unsaved edits of {name}, {} old.{changed} Value in the file -> edited value:",
        offer.age
    );
    let details = offer.changes.iter().map(session::line).collect();
    let buttons = [
        ("Discard", forgetting(vec![offer.journal.clone()])),
        ("Recover", Choice::of(move |app| recover(app, &offer))),
        ("Later", Choice::none()),
    ];
    app.ask(Question::new("Unsaved edits found", text, buttons).with(details).on(1));
}

fn forgetting(journals: Vec<PathBuf>) -> Choice {
    Choice::of(move |app| app.want(Effect::Forget(journals.clone())))
}

/// Saves to the file of the case, or asks for a path.
pub(super) fn save(app: &mut App, next: Next) {
    if refuse_faulty(app) {
        return;
    }
    match app.tab.path.clone() {
        Some(path) => write(app, path, Over::Own, next),
        None => ask_where(app, next),
    }
}

/// Asks for a path to save to.
pub(super) fn ask_where(app: &mut App, next: Next) {
    if refuse_faulty(app) {
        return;
    }
    let path = app.tab.path.as_deref().unwrap_or(Path::new("case.toml"));
    let input = Line::named(path.display().to_string());
    let dialog = PathDialog::new(SAVE_AS, HOW, input, save_under);
    app.prompts.push(Prompt::Path(PathDialog { next, ..dialog }));
}

/// Opens a file that was read; reports its faults, if any.
pub(super) fn loaded(app: &mut App, path: PathBuf, result: Result<Box<Document>, Vec<String>>) {
    match result {
        Ok(document) if is_open_as_another(app, &document, &path) => (),
        Ok(document) => {
            app.prompts.clear();
            let case_path = rexs::case_path(&path);
            let is_model = rexs::is_model(&path);
            app.want(Effect::Remember(path));
            show_tab(app, *document, case_path);
            if app.tab.access == Access::Newer {
                app.complain(NEWER);
            } else if is_model {
                app.say(
                    "one stage of the model, as a new case; `tipstrike import` lists the other stages and \
                     the fields that stay empty",
                );
            } else {
                app.say(format!("opened {}", app.tab.name()));
            }
        }
        Err(faults) => {
            app.message = None;
            let title = format!("{} cannot be opened", path.display());
            app.prompts.push(Prompt::Read(Page::new(title, Some(faults))));
        }
    }
}

/// Handles the result of a save.
pub(super) fn saved(
    app: &mut App,
    path: PathBuf,
    next: Next,
    result: Result<Box<Written>, SaveFault>,
) {
    let asked = app.tab.saving.take();
    let Written { document, saved } = match result {
        Ok(written) => *written,
        Err(fault) => return ask_refused(app, &path, fault, &next),
    };
    app.close_titled(SAVE_AS);
    // Later edits are not saved and remain.
    let is_as_asked = asked.is_none_or(|asked| asked == app.tab.case);
    if is_as_asked && app.tab.case != document.case {
        app.tab.case = document.case.clone();
        app.focus_on(app.tab.form.focus);
    }
    app.tab.read_line_anew();
    (app.tab.document, app.tab.is_outdated) = (document, false);
    (app.tab.in_place_of, app.tab.origin) = (None, Origin::Given);
    let how = match saved {
        Saved::Written => "",
        Saved::Recreated => ": the file was deleted, and this save created it again",
    };
    let missing = match app.tab.problems.len() {
        0 => String::new(),
        1 => "; 1 required value is missing".to_owned(),
        count => format!("; {count} required values are missing"),
    };
    app.say(format!("saved {}{how}{missing}", app.in_message(&path)));
    app.tab.path = Some(path.clone());
    app.want(Effect::Remember(path));
    go(app, next);
}

/// Opens a file. If the case is already open, goes to its tab with its unsaved edits.
pub(super) fn open(app: &mut App, path: PathBuf) {
    if let Some(at) = place_of(app, &path) {
        app.prompts.clear();
        go_to_tab(app, at);
        app.say(format!("{} is open already", app.tab.name()));
    } else if rexs::is_model(&path) {
        app.prompts.clear();
        app.say(format!("reading {}", app.in_message(&path)));
        let path = store::at_home(&path);
        let own = path.clone();
        // The heaviest model takes longer than a frame.
        let load = move |_: &Running<'_>| Some(store::load(&path));
        app.start(Work::new(Slot::Model, load, move |app, result| loaded(app, own, result)));
    } else {
        app.want(Effect::Load(path));
    }
}

/// Saves under the typed name.
fn save_under(app: &mut App, name: &str, next: Next) {
    if name.trim().is_empty() {
        return app.complain("type a name for the file");
    }
    let own = app.tab.path.as_deref();
    let is_own = own == Some(Path::new(name));
    let path = if is_own { name.into() } else { store::at_home(&named(name.trim())) };
    let over = if own == Some(&*path) { Over::Own } else { Over::Nothing };
    write(app, path, over, next);
}

/// Switches to the tab with an index, if it exists.
pub(super) fn go_to_tab(app: &mut App, at: usize) {
    let now = app.place_of_tab;
    if at == now || at > app.others.len() {
        return;
    }
    app.tab.history.end_visit();
    let taken = if at > now { at - 1 } else { at };
    let next = app.others.remove(taken);
    let before = std::mem::replace(&mut app.tab, next);
    app.others.insert(if at > now { now } else { now - 1 }, before);
    app.place_of_tab = at;
    leave_pattern(app);
    let study = &mut app.tab.study;
    study.waits |= study.request.is_none() && app.layout.plan().shows(Pane::Study);
    // The worker may have dropped a request of this tab for a later one.
    if !app.tab.is_settled {
        app.tab.requested = Wanted::NOTHING;
    }
    app.follow();
}

/// Switches to the next or previous tab, wrapping around.
pub(super) fn step_tab(app: &mut App, by: isize) {
    let count = app.others.len() + 1;
    if count == 1 {
        app.say("only one case is open");
    }
    go_to_tab(app, (app.place_of_tab + count).saturating_add_signed(by) % count);
}

/// Shows the built-in case, in a new tab if another case is in use.
pub(super) fn built_in(app: &mut App) {
    let at = app.tabs().position(Tab::is_built_in);
    match at {
        Some(at) => go_to_tab(app, at),
        None => add_tab(app, Origin::Given, store::built_in()),
    }
}

/// Starts an empty case in a new tab, at its first required field.
pub(super) fn fresh_tab(app: &mut App) {
    add_tab(app, Origin::New, Document::new(Case::fresh()));
    if let Some(first) = app.tab.problems.iter().map(|(row, _)| *row).min() {
        app.focus_on(first);
    }
    app.layout.focus = Pane::Form;
    app.is_editing = true;
    let missing = app.tab.problems.len();
    app.say(format!(
        "new case: {missing} required fields are empty, the others show their defaults; \
         {} starts from an example",
        key_of(app, "from example")
    ));
}

/// Opens the list of examples.
pub(super) fn ask_example(app: &mut App) {
    let item = |example: &'static Example| {
        let title = example.document().case.title().to_owned();
        let choice = Choice::of(move |app| begin_example(app, example));
        Item::named(choice, example.name.to_owned(), title).previewing(Target::Example(example))
    };
    app.pick(Picker::new("New case from an example", EXAMPLES.iter().map(item), &[]));
}

/// Starts a case from an example in a new tab.
pub(super) fn begin_example(app: &mut App, example: &'static Example) {
    add_tab(app, Origin::Example(example.name), example.document());
    app.say(format!("new case from {}; it has no file yet", example.name));
}

/// Shows the result of opening a case.
pub(super) fn claimed(app: &mut App, claim: Claim) {
    let Some(at) = app.tabs().position(|tab| tab.id == claim.id) else {
        return;
    };
    if !claim.is_silent() {
        go_to_tab(app, at);
    }
    let Claim { id, access, offers, notices } = claim;
    if let Access::Held(holder) = &access {
        app.complain(format!("read-only: open in {holder}; F2 saves under another name"));
    }
    if let Some(tab) = app.tab_with(id).filter(|tab| tab.access != Access::Newer) {
        tab.access = access;
    }
    if !notices.is_empty() {
        let said = app.message.take().map(|message| message.text);
        app.complain(said.into_iter().chain(notices).collect::<Vec<_>>().join("; "));
    }
    let name = app.tab.name();
    // The latest is on top.
    for offer in offers.into_iter().rev() {
        ask_recovery(app, &name, offer);
    }
}

/// Shows the journals of ended sessions.
pub(super) fn list_journals(app: &mut App, journals: Vec<(PathBuf, String)>) {
    if journals.is_empty() {
        return app.say("no ended session left unsaved edits");
    }
    let (places, details) = journals.into_iter().unzip();
    let text =
        "Sessions ended with these unsaved edits. A case offers its edits when it is opened.";
    let buttons = [("Delete all", forgetting(places)), ("Close", Choice::none())];
    app.ask(Question::new(UNSAVED, text.to_owned(), buttons).with(details));
}

/// Restores the kept edits into the form as one edit, which undo reverts.
fn recover(app: &mut App, offer: &Offer) {
    let mut case = app.tab.case.clone();
    let changes = offer.changes.iter();
    let refused = changes.filter_map(|change| case.apply(&change.key, change.to.as_deref()).err());
    let refused: Vec<_> = refused.collect();
    app.tab.history.end_visit();
    app.tab.before_edit(app.tab.form.focus);
    app.replace_case(case, app.tab.form.focus);
    if let Some(problem) = refused.first() {
        app.complain(format!("some edits are not restored, and the journal stays: {problem}"));
    } else {
        app.say("the edits are restored, not saved yet");
        app.want(Effect::Adopt(offer.journal.clone()));
    }
}

/// Reads the file again, or asks if edits would be discarded.
pub(super) fn ask_reload(app: &mut App) {
    let Some(path) = app.tab.path.clone() else {
        return app.say("this case has no file to read again");
    };
    ask_or_go(app, Next::Load(path));
}

/// Handles a possible change of the file of an open case: a case without edits is replaced.
pub(super) fn file_changed(app: &mut App, path: &Path, found: Result<Box<Document>, Vec<String>>) {
    let Some(tab) = app.tabs_mut().find(|tab| tab.path.as_deref() == Some(path)) else {
        return;
    };
    let (id, name) = (tab.id, tab.short_name());
    tab.is_outdated = true;
    let document = match found {
        Ok(document) if document.stamp() == tab.document.stamp() => {
            // A link may lead to a copy now.
            (tab.document, tab.is_outdated) = (*document, false);
            return;
        }
        Ok(document) => document,
        Err(faults) => {
            let fault = faults.into_iter().next().unwrap_or_default();
            app.complain(format!("{name} changed on disk and cannot be read: {fault}"));
            return;
        }
    };
    if tab.is_unsaved() {
        let reload = key_of(app, "reload");
        app.complain(format!(
            "{name} changed on disk: {reload} reads it and asks about your edits"
        ));
        return;
    }
    app.say(format!("read {name} again: it changed on disk"));
    let (shown, changed) = (app.place_of_tab, app.tabs().position(|tab| tab.id == id));
    go_to_tab(app, changed.unwrap_or(shown));
    let (case, tab) = (document.case.clone(), &mut app.tab);
    if !matches!(tab.access, Access::Held(_)) {
        tab.access = Access::of(&document);
    }
    (tab.document, tab.is_outdated) = (*document, false);
    edit::replace(app, case);
    go_to_tab(app, shown);
}

/// Ends the workbench, or asks if an export is running.
fn leave(app: &mut App) {
    let Some(path) = &app.exporting else {
        return app.want(Effect::Quit);
    };
    let text = format!("The export to {} still runs.", path.display());
    let quit = ("Quit without the export", Choice::of(|app| app.want(Effect::Quit)));
    app.close_titled(export::EXPORT_RUNS);
    app.ask(Question::new(export::EXPORT_RUNS, text, [("Wait", Choice::none()), quit]).on(0));
}

/// Carries out the step after a save.
fn go(app: &mut App, next: Next) {
    match next {
        Next::Stay => (),
        Next::Quit => leave(app),
        Next::Load(path) => app.want(Effect::Load(path)),
        Next::Close => close_tab(app),
        Next::SaveRest => {
            let unsaved = app.tabs().position(Tab::is_unsaved);
            let Some(unsaved) = unsaved else { return leave(app) };
            go_to_tab(app, unsaved);
            save(app, Next::SaveRest);
        }
    }
}

// A path through a link names the same file, and hence the same case.
fn is_open_as_another(app: &mut App, document: &Document, path: &Path) -> bool {
    let is_it = |tab: &Tab| {
        tab.path.as_deref().is_some_and(|own| own != path)
            && document.path().is_some()
            && tab.document.path() == document.path()
    };
    let Some(at) = app.tabs().position(is_it) else {
        return false;
    };
    app.prompts.clear();
    go_to_tab(app, at);
    app.say(format!("{} is open already, as {}", path.display(), app.tab.name()));
    true
}

fn place_of(app: &App, path: &Path) -> Option<usize> {
    let path = rexs::case_path(path);
    app.tabs().position(|tab| tab.path.as_deref() == Some(&path))
}

// A file with invalid values could not be opened again; a file with missing values can.
fn refuse_faulty(app: &mut App) -> bool {
    let wrong = app.tab.problems.iter().find(|(row, _)| !rows::lacks(&app.tab.case, *row));
    let wrong = wrong.map(|(row, _)| *row);
    if let Some(row) = wrong {
        app.focus_on(row);
        let name = rows::full_label(&app.tab.case, row);
        app.complain(format!("not saved: fix {name} first; the edits stay in the form"));
    }
    wrong.is_some()
}

fn write(app: &mut App, path: PathBuf, over: Over, next: Next) {
    let document = app.tab.as_edited();
    app.tab.saving = Some(app.tab.case.clone());
    app.want(Effect::Save(Box::new(Saving { document, path, over }), next));
}

// The list of cases in a folder shows only names with the extension.
fn named(name: &str) -> PathBuf {
    let last = name.rsplit('/').next().unwrap_or_default();
    let extension = last.rsplit_once('.').filter(|(stem, _)| !stem.is_empty());
    let has_extension = |(_, extension): (&str, &str)| extension.chars().all(char::is_alphabetic);
    let is_whole = matches!(last, "" | "." | ".." | "~") || extension.is_some_and(has_extension);
    PathBuf::from(if is_whole { name.to_owned() } else { format!("{name}{CASE_ENDING}") })
}

/// Shows a document: in the tab of its path, instead of the unchanged built-in case, or in a new
/// tab.
fn show_tab(app: &mut App, document: Document, path: PathBuf) {
    let own = app.tabs().position(|tab| tab.path.as_ref() == Some(&path));
    go_to_tab(app, own.unwrap_or(app.place_of_tab));
    let (id, replaces) = (app.tab.id, own.is_some() || app.tab.is_untouched());
    put_tab(app, Tab::new(document, Some(path)), replaces);
    if own.is_some() {
        // A file that is read again keeps its tab.
        app.tab.id = id;
    }
}

/// Closes the current case; after the last one the built-in case is shown.
fn close_tab(app: &mut App) {
    let name = app.tab.name();
    if app.others.is_empty() {
        put_tab(app, Tab::new(store::built_in(), None), true);
        return app.say(format!("closed {name}: this is the built-in Table 1"));
    }
    let closed = app.place_of_tab;
    go_to_tab(app, if closed == 0 { 1 } else { closed - 1 });
    app.others.remove(if closed == 0 { 0 } else { closed - 1 });
    app.place_of_tab = closed.saturating_sub(1);
    app.say(format!("closed {name}"));
}

/// Shows a new case in a new tab, or instead of the unchanged built-in case.
fn add_tab(app: &mut App, origin: Origin, document: Document) {
    let replaces = app.tab.is_untouched();
    put_tab(app, Tab { origin, ..Tab::new(document, None) }, replaces);
}

/// Shows the first chart instead of the contact pattern beside a case that has no pattern.
fn leave_pattern(app: &mut App) {
    if app.chart.is_pattern() && app.tab.inputs_so_far.face().is_none() {
        app.chart.selected = 0;
    }
}

fn put_tab(app: &mut App, tab: Tab, replaces: bool) {
    let focus = app.tab.form.focus;
    app.last_id += 1;
    let before = std::mem::replace(&mut app.tab, Tab { id: app.last_id, ..tab });
    if !replaces {
        app.others.insert(app.place_of_tab, before);
        app.place_of_tab += 1;
    }
    leave_pattern(app);
    app.layout.is_zoomed = false;
    app.layout.focus = Pane::Form;
    app.tab.study.waits = app.layout.plan().shows(Pane::Study);
    app.cursor = None;
    app.solve();
    app.focus_on(focus);
}
