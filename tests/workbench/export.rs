//! Reports and pictures written from the workbench.

use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use std::fs;

use tipstrike::tui::testing::{Effect, Slot};

/// A workbench on `pair.toml` with an unsaved edit.
fn edited() -> Desk {
    let mut desk = Desk::on(LARGE, "pair.toml", TABLE_1);
    desk.fill("deviations.base_pitch", "24 um");
    desk
}

fn names(desk: &Desk) -> Vec<String> {
    let entries = fs::read_dir(desk.folder.path()).expect("the folder");
    // The lock of the open case is a hidden file.
    let name = |entry: fs::DirEntry| entry.file_name().into_string().expect("a name");
    let mut names: Vec<String> = entries.map(|entry| name(entry.expect("an entry"))).collect();
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    names
}

#[test]
fn the_report_of_the_form_is_written_and_the_status_line_shows_its_path() {
    let mut desk = edited();
    desk.keys(&["Alt-X"]).has(&["Export", "pair.html"]);
    desk.keys(&["sent", "Enter"]);
    let page = desk.read("sent.html");
    assert!(page.contains("<html") && page.contains("24 um"), "the edit is in the page");
    assert!(desk.shows("exported to ") && desk.shows("sent.html") && desk.app.prompts.is_empty());
    assert!(desk.app.tab.is_unsaved(), "an export saves no case");
    desk.keys(&["Esc", ":", "units", "Enter", "Alt-X", "inch", "Enter"]);
    assert!(desk.read("inch.html").contains("<td class=\"unit\">lbf</td>"), "inch units");
}

#[test]
fn the_extension_and_the_focused_pane_select_the_content() {
    let cases = [
        ("1", "a.md", "# Zhou & Chen 2014, Table 1"),
        ("1", "a.csv", "case,"),
        ("1", "a.json", "{\"case\":"),
        ("3", "a.svg", "Force"),
        ("4", "b.svg", "Teeth at the first contact D"),
    ];
    for (pane, name, part) in cases {
        let mut desk = edited();
        let path = desk_path(&desk, name);
        desk.keys(&["Esc", pane, ":", "export", "Enter", "Ctrl-U", &path, "Enter"]);
        let text = desk.read(name);
        assert!(text.contains(part), "{name}: {text}");
    }
    let mut desk = edited();
    desk.keys(&["Esc", "3", "Alt-X"]).assert_shows("pair.svg");
}

fn desk_path(desk: &Desk, name: &str) -> String {
    desk.path(name).display().to_string()
}

#[test]
fn a_file_that_exists_is_replaced_on_demand_alone() {
    let mut desk = edited();
    desk.write("pair.html", "mine");
    desk.keys(&["Alt-X", "Enter"]).assert_shows("The file exists");
    desk.keys(&["Enter"]);
    assert_eq!(desk.read("pair.html"), "mine");
    assert!(desk.shows("Export"), "another name may be typed");
    desk.keys(&["Enter", "o"]);
    assert!(desk.read("pair.html").contains("24 um") && desk.app.prompts.is_empty());
}

#[test]
fn an_impossible_export_is_refused_and_writes_nothing() {
    let mut desk = edited();
    desk.keys(&["Alt-X", "Ctrl-U", &desk_path(&desk, "page.pdf"), "Enter"]);
    desk.assert_shows("not exported: unknown file extension");
    desk.keys(&["Ctrl-U", "Enter"]).assert_shows("a file needs a name");
    desk.keys(&["Esc"]);
    desk.fill("deviations.base_pitch", "24 lb");
    desk.keys(&["Alt-X"]).assert_shows("not exported: complete the fields marked with !");
    assert_eq!(names(&desk), ["pair.toml"]);
}

#[test]
fn one_export_runs_at_a_time_and_quitting_asks_about_it() {
    let mut desk = edited();
    desk.keys(&["Alt-X"]);
    // The export is requested and not carried out.
    let effects = desk.effects("Enter");
    assert!(matches!(effects.first(), Some(Effect::Work(_, work)) if work.slot == Slot::Export));
    desk.keys(&["Enter"]).assert_shows("still runs: wait for its end");
    desk.keys(&["Esc", "Esc", "Ctrl-S", "Ctrl-Q"]);
    desk.assert(desk.shows("An export runs") && !desk.has_quit);
    desk.keys(&["w", "Ctrl-Q", "q"]);
    assert!(desk.has_quit);
}

#[test]
fn a_picture_is_refused_by_name_if_no_chart_is_visible() {
    let mut desk = Desk::on(SMALL, "pair.toml", TABLE_1);
    desk.keys(&["Esc", "5", "Alt-X", "Ctrl-U", &desk_path(&desk, "a.svg"), "Enter"]);
    desk.assert_shows("not exported: no chart is visible");
    assert_eq!(names(&desk), ["pair.toml"]);
    desk.keys(&["Esc", "3", "Alt-X", "Ctrl-U", &desk_path(&desk, "a.svg"), "Enter"]);
    desk.assert_shows(": the chart force");
}
