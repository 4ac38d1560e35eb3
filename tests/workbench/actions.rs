//! Every line of the table of actions: keys in, screen out. A line without a test fails here.
use crate::harness::{Desk, LARGE, TABLE_1, time_evenly};
use std::collections::{BTreeMap, BTreeSet};

use tipstrike::tui::testing::BINDINGS;

const SPREAD: &str = "\n[spread]\n\"deviations.base_pitch\" = { normal = \"2 um\" }\n";

/// Keys before, the key, keys after, and a text on the screen or an effect that is absent without
/// the key. `:name` runs a command of the palette.
#[rustfmt::skip]
const ACTIONS: &[(&str, &str, &str, &str)] = &[
    // In the form, outside its fields.
    ("Esc", "Enter", "7", "module               7 mm"),
    ("Esc", "/", "", "Go to a field"),
    ("Esc", "j", "", "Pd diametral pitch,"),
    ("Esc G", "k", "", "Upper limit of impact force"),
    ("Esc", "l", "", "z1 driver number of teeth,"),
    ("Esc", "h", "", "title. A name"),
    ("Esc", "g", "", "title. A name"),
    ("Esc", "G", "", "Distribution of base pitch deviation"),
    ("Ctrl-U 2 Space m m Down Down Down", "Alt-E", "", "rh1 driver bore radius,"),
    // In the results.
    ("Esc 2", "Enter", "", "impact force, F_S (Eq. 57)"),
    ("Esc 2", "n", "", "Outcome, limits, notes"),
    ("Esc 2", "Alt-L", "", "ok impact force F_S 2191.0 N <= 2500 N (88 %)"),
    ("Esc 2", "l", "", "O2D driven radius at D, rounding"),
    ("Esc 2 l", "h", "", "2 Results 1-21/6"),
    ("Esc 2", "j", "", "T_S impact duration, by the method"),
    ("Esc 2 j j", "k", "", "T_S impact duration, by the method"),
    ("Esc 2", "G", "", "(corner_pressure)."),
    ("Esc 2 G", "g", "", "F_S impact force, Eq. 57"),
    ("Ctrl-T Esc 2", "f", "G", " free: "),
    // Accuracy against run time.
    ("Esc 5 m", "Enter", "", "; Ctrl-Z undoes"),
    ("Esc 5", "m", "", "Within 5.0 %: dynamic with"),
    ("Esc 5 m", "v", "", "▸ 5 Run time and difference from the reference"),
    ("Esc 5 m h", "l", "", " within 5.0 %; numbers"),
    ("Esc 5 m", "h", "", "] not within 5.0 %"),
    // The study.
    ("Esc", "6", "", "▸ 6 Study"),
    ("Esc 6 l", "Enter", "", "; Ctrl-Z undoes"),
    ("Esc 6 l l", "h", "", "m = 5.05 mm:"),
    ("Esc 6", "l", "", "m = 5.05 mm:"),
    ("Esc 6", "G", "", "m = 7.5 mm:"),
    ("Esc 6 G", "g", "", "m = 2.5 mm:"),
    ("Esc 6", "Shift-Left", "", "m = 4.5 mm:"),
    ("Esc 6", "Shift-Right", "", "m = 5.5 mm:"),
    ("Esc 6 s driven.tip_relief Enter", "k", "", "Ca2 = 10 um:"),
    ("Esc 6 s driven.tip_relief Enter k", "j", "", "Ca2 = 0 um:"),
    ("Esc 6", "+", "l", "m = 5.025 mm:"),
    ("Esc 6 +", "-", "l", "m = 5.05 mm:"),
    ("Esc 6 +", "0", "l", "m = 5.05 mm:"),
    ("Esc 6", "s", "", "Second field of the map"),
    ("Esc 6", "r", "", "Range of the study"),
    ("Esc 6", "v", "", "exact F_S in N"),
    ("Esc 6", "p", "", "Field of the study"),
    ("Esc 6", "o", "", "Result of the study"),
    ("", ":sweep", "", "Range of the study"),
    ("", "Alt-D", "", "(no distribution)"),
    ("Esc 6", "d", "", "▸ 6 Tolerance 1 to 14 of 28"),
    ("Esc 6 d", "j", "", "▸ 6 Tolerance 2 to 15 of 28"),
    ("Esc 6 d j j", "k", "", "▸ 6 Tolerance 2 to 15 of 28"),
    ("Esc 6 d", "l", "", "▸ 6 Tolerance 14 to 27 of 28"),
    ("Esc 6 d", "N", "", "Samples of the tolerance"),
    ("Esc 6 d l", "h", "", "▸ 6 Tolerance 1 to 14 of 28"),
    ("Esc 2", "v", "", "the case has no variants"),
    ("", ":variant", "", "Commands"),
    ("", ":about", "", "Texts for r"),
    ("X", ":reload", "", "[> Cancel <]"),
    ("", ":journals", "", "no ended session left unsaved edits"),
    ("", ":seek", "", "tipstrike seek CASE --vary"),
    ("", ":relief", "", "Loads, tolerances, te|peak|entry"),
    // Chart and teeth.
    ("Esc 3", "Space", "", "[ticks]"),
    ("Esc 3 l l", "h", "", "1.3663 deg of the driver before E: F_S 2191.0 N"),
    ("Esc 3", "l", "", "1.3663 deg of the driver before E: F_S 2191.0 N"),
    ("Esc 3 l L", "H", "", "1.3663 deg of the driver before E: F_S 2191.0 N"),
    ("Esc 3 l", "L", "", "1.1636 deg of the driver before E"),
    ("Esc 3 l l l", "Home", "", "1.3663 deg of the driver before E: F_S 2191.0 N"),
    ("Esc 3", "a", "peak", "= 1.3663 deg (113.9 us) before E"),
    ("Esc 3", "End", "", "At E: F_S 0 N"),
    ("Esc 3 l", "c", "", "Cursor hidden"),
    ("Esc 3 k k", "l", "l", "harmonic of the mesh frequency 2.000: at rest"),
    ("Esc 3 k k l l", "h", "", "harmonic of the mesh frequency 1.000: at rest"),
    ("Esc 3 k k l", "L", "", "harmonic of the mesh frequency 10.00: at rest"),
    ("Esc 3 k k l l", "H", "", "harmonic of the mesh frequency 1.000: at rest"),
    ("Esc 3 k k", "End", "", "harmonic of the mesh frequency 10.00: at rest"),
    ("Esc 3 k k", "a", "", "harmonic of the mesh frequency 1.000: at rest"),
    ("Esc 3", "j", "", "▸ 3 Gap S in um over roll angle"),
    ("Esc 3 j j", "k", "", "▸ 3 Gap S in um over roll angle"),
    ("Esc 3", "+", "", "-1.2          -1.0          -0.8 "),
    ("Esc 3 + +", "-", "", "-1.2          -1.0          -0.8 "),
    ("Esc 3 + +", "0", "", "-0.5                       0 "),
    ("Esc 3", "v", "", "the charts show the strike"),
    ("Esc 3", "t", "", "Force F_S in N over time after E in us"),
    ("Esc 4", "+", "", "┤ 5 mm"),
    ("Esc 4 +", "-", "", "┤ 10 mm"),
    ("Esc 4 + +", "0", "", "┤ 10 mm"),
    ("Esc 4", "v", "", "view: the pitch point"),
    ("Esc 4", "k", "", "view: the pair"),
    ("Esc 4", "x", "", "gap drawn true to scale"),
    // Outside a field, in every pane.
    ("Esc 3", ":", "", "Commands"),
    ("Esc 3", "q", "", "[quit]"),
    ("Esc 3", "?", "", "Every valid edit"),
    ("Esc", "Tab", "", "▸ 2 Results"),
    ("Esc", "BackTab", "", "▸ 6"),
    ("X Esc", "u", "", "module               5 mm "),
    ("Esc", "b", "", "baseline: case.toml as it is now"),
    ("Esc", "y", "", "[copied 5 mm]"),
    ("Esc 6", "y", "", "Command of the study"),
    ("Esc", "Y", "", "# Zhou & Chen 2014, Table 1"),
    ("Esc 3", "z", "", "  2500 ┤"),
    ("Esc 3", "1", "", "▸ 1 Form"),
    ("Esc", "2", "", "▸ 2 Results"),
    ("Esc", "3", "", "▸ 3"),
    ("Esc", "4", "", "▸ 4"),
    ("Esc", "5", "", "▸ 5"),
    ("Esc", "%", "", "stages in"),
    ("Esc 4", "Esc", "", "▸ 1 Form"),
    // Everywhere.
    ("", "F1", "", "Every valid edit"),
    ("X", "Ctrl-S", "", "not saved: fix"),
    ("", "Ctrl-P", "", "Commands"),
    ("", "Ctrl-O", "", "Open a case"),
    ("", "Ctrl-Q", "", "[quit]"),
    ("", "Esc", "", "Enter edit"),
    ("", "Ctrl-T", "", "method static"),
    ("", ":method_paper", "", "method paper"),
    ("Ctrl-T", ":method_exact", "", "method exact"),
    ("", ":method_static", "", "method static"),
    ("", ":method_dynamic", "", "method dynamic"),
    ("", ":method_auto", "", "method auto"),
    ("X", "Ctrl-Z", "", "module               5 mm "),
    ("", "F5", "", "No benchmark yet"),
    ("Esc 4", "F9", "", "┤ 5 mm"),
    ("", "F4", "", "μ_stick  stick limit"),
    ("F4", "F3", "", "θ_1      driver angle b"),
    ("", "F2", "", "Save as"),
    ("", "Alt-X", "", "Export"),
    ("", "Ctrl-N", "", "7 required values are missing"),
    ("", "Alt-N", "", "New case from an example"),
    ("", "Alt-T", "", "[2 built-in Table 1]"),
    ("", "Alt-R", "", "Recent cases"),
    ("Ctrl-N", "Ctrl-PageDown", "", "[1 case.toml]"),
    ("Ctrl-N", "Ctrl-PageUp", "", "[1 case.toml]"),
    ("Ctrl-N", "Alt-W", "", "closed new case"),
    ("Ctrl-N", "Alt-1", "", "[1 case.toml]"),
    ("Ctrl-N Alt-1", "Alt-2", "", "[2 new case]"),
    ("X Ctrl-Z", "Ctrl-Y", "", "redo: module: 5 mm -> X"),
    ("", "Alt-B", "", "baseline: case.toml as it is now"),
    ("", "F8", "", "chart in halfblock"),
    ("", ":theme", "", "theme contrast"),
    ("", ":ascii", "", "drawn in ASCII"),
    ("", ":units", "", "492.56"),
    ("", ":mouse", "", "[mouse]"),
    ("", "Ctrl-L", "", "[redrawn]"),
    ("", "Alt-Z", "", "[suspended]"),
    ("", "Alt-G", "", "Material of both gears"),
    ("", "Alt-L", "", "Set a limit on a result"),
    // In a field.
    ("", "Shift-Up", "", "module               6 mm"),
    ("", "Shift-Down", "", "4 mm"),
    ("", "Alt-Up", "", "module               15 mm"),
    ("Shift-Up Alt-Up", "Alt-Down", "", "module               6 mm"),
    ("", "Down", "", "Pd diametral pitch,"),
    ("Down", "Up", "", "m module,"),
    ("", "PageDown", "", "z1 driver number of teeth,"),
    ("", "PageUp", "", "title. A name"),
    ("Esc 3", "Ctrl-Home", "", "title. A name"),
    ("", "Ctrl-End", "", "Distribution of base pitch deviation"),
    // In a field with choices.
    ("METHOD", "Right", "", "‹ static ›"),
    ("METHOD", "Left", "", "‹ paper ›"),
    ("METHOD Right", "Backspace", "", "‹ (auto) ›"),
    ("METHOD", "?", "", "Every valid edit"),
    // In prompts.
    ("Ctrl-O", "Tab", "", "│ DIR/case.toml"),
    ("Ctrl-O sub/", "Alt-Up", "", "▸ sub/"),
    ("Ctrl-O", "Alt-R", "", "▸ other.toml  in "),
    ("X Ctrl-Q", "Tab", "", "[> Save <]"),
    ("X Ctrl-Q", "BackTab", "", "[> Discard <]"),
    ("Ctrl-P", "Down", "", "▸ cursor to angle "),
    ("Ctrl-P Down Down", "Up", "", "▸ cursor to angle "),
    ("Ctrl-P", "Tab", "", "▸ cursor to angle "),
    ("Ctrl-P Down Down", "BackTab", "", "▸ cursor to angle "),
    ("Esc 2 j j Enter j", "j", "", "m      pair.module"),
    ("Esc 2 j j Enter j j", "k", "", "│ θ_1 = 1.366 deg"),
    ("Esc 2 j j Enter", "PageDown", "", "pair.centre_distance = no backlash"),
    ("Esc 2 j j Enter", "Space", "", "pair.centre_distance = no backlash"),
    ("Esc 2 j j Enter PageDown PageDown", "PageUp", "", "│ θ_1 = 1.366 deg"),
    ("Ctrl-P units", "Enter", "", "492.56"),
    ("F1", "Enter", "", "▸ Form"),
    ("Ctrl-P", "Esc", "", "▸ Form"),
    ("Ctrl-P", "F1", "", "In a list or a line of text"),
    ("X Ctrl-P", "Ctrl-Q", "", "[> Cancel <]"),
    ("", "Ctrl-C", "", "Ctrl-C again to quit"),
    // In an explanation.
    ("Esc 2 j j Enter", "Tab", "", "▸pair.module"),
    ("Esc 2 j j Enter", "BackTab", "", "▸model.accurate"),
    ("Esc 2 j j Enter Tab Tab Tab", "Enter", "", "z1 driver number of teeth,"),
    ("Esc 2 j j Enter", "q", "", "▸ 2 Results"),
    // In an input line.
    ("End", "Left", "X", "5 mXm"),
    ("Home", "Right", "X", "5X mm"),
    ("End", "Ctrl-Left", "X", "5 Xmm"),
    ("Home", "Ctrl-Right", "X", "5 Xmm"),
    ("", "Home", "X", "X5 mm"),
    ("Home", "End", "X", "5 mmX"),
    ("End", "Backspace", "X", "5 mX"),
    ("Home", "Delete", "", "module                mm"),
    ("", "Ctrl-W", "X", "5 X"),
    ("Home Right", "Ctrl-K", "X", "module               5X    "),
    ("End", "Ctrl-U", "X", " X "),
];

fn bench() -> Desk {
    let mut desk = Desk::on(LARGE, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    std::fs::create_dir(desk.path("sub")).expect("a folder");
    desk.recents = vec![desk.write("other.toml", &TABLE_1.replace("2000 rpm", "900 rpm"))];
    desk
}

fn press(desk: &mut Desk, keys: &str) {
    for key in keys.split_whitespace() {
        match key.strip_prefix(':').filter(|name| !name.is_empty()) {
            Some(name) => desk.keys(&["Esc", ":", &name.replace('_', " "), "Enter"]),
            None if key == "METHOD" => desk.go_to("model.method"),
            None => desk.keys(&[key]),
        };
        if key == "m" && desk.app.tab.traded.as_ref().is_some_and(|traded| traded.trade.is_some()) {
            time_evenly(desk);
        }
    }
}

/// The screen and the effects.
fn out(desk: &Desk) -> String {
    let flags = [
        (desk.has_quit, "[quit]"),
        (desk.has_mouse, "[mouse]"),
        (desk.ticks, "[ticks]"),
        (desk.has_redrawn, "[redrawn]"),
        (desk.is_suspended, "[suspended]"),
    ];
    let flags = flags.into_iter().filter(|(is_set, _)| *is_set).map(|(_, name)| name);
    let copied = desk.copied.as_ref().map(|text| format!("[copied {text}]")).unwrap_or_default();
    format!("{}\n{}{copied}", desk.screen(), flags.collect::<String>())
}

/// The line of the table for a key in the present state.
fn called(desk: &Desk, key: &str) -> Option<usize> {
    if let Some(name) = key.strip_prefix(':').filter(|name| !name.is_empty()) {
        return BINDINGS
            .iter()
            .position(|binding| binding.name == name.replace('_', " ") && binding.keys.is_empty());
    }
    let key = if key == "BackTab" { "Shift-Tab" } else { key };
    let place = desk.app.place();
    BINDINGS.iter().position(|binding| binding.places.meets(place) && binding.way(key).is_some())
}

#[test]
fn every_key_has_the_effect_of_its_line() {
    let (mut covered, mut wrong) = (BTreeSet::new(), Vec::new());
    let mut screens_without = BTreeMap::new();
    for (before, key, after, says) in ACTIONS {
        let mut with = bench();
        press(&mut with, before);
        covered.insert(
            called(&with, key).unwrap_or_else(|| panic!("{key} after {before:?} has no command")),
        );
        let without = screens_without.entry((before, after)).or_insert_with(|| {
            if after.is_empty() {
                return out(&with);
            }
            let mut without = bench();
            press(&mut without, &format!("{before} {after}"));
            out(&without)
        });
        press(&mut with, &format!("{key} {after}"));
        let with = out(&with);
        if !with.contains(says) || without.contains(says) {
            let new: Vec<&str> = with.lines().filter(|line| !without.contains(line)).collect();
            let (first, last) = (new.iter().take(3), new.iter().rev().take(4));
            let lines: Vec<_> =
                first.chain(last).map(|line| line.chars().take(90).collect::<String>()).collect();
            wrong.push(format!(
                "{key} after {before:?} must show {says:?}; the screen is:\n{}",
                lines.join("\n")
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    // The contact pattern needs a helical pair; `charts` tests its keys.
    covered.extend(BINDINGS.iter().position(|binding| binding.name == "slice"));
    let missing: Vec<String> = (0..BINDINGS.len())
        .filter(|at| !covered.contains(at) && !BINDINGS[*at].sentence.is_empty())
        .map(|at| {
            format!("{} {}: {}", BINDINGS[at].keys(), BINDINGS[at].name, BINDINGS[at].sentence)
        })
        .collect();
    assert!(missing.is_empty(), "no test has these lines of the table:\n{}", missing.join("\n"));
}

#[test]
fn the_help_has_every_key_with_its_sentence() {
    let lines = tipstrike::tui::testing::help::lines();
    for binding in BINDINGS.iter().filter(|binding| !binding.sentence.is_empty()) {
        let keys =
            if binding.keys.is_empty() { format!(":{}", binding.name) } else { binding.keys() };
        let stands = |line: &String| {
            line.trim_start()
                .strip_prefix(&keys)
                .is_some_and(|rest| rest.trim_start() == binding.sentence)
        };
        assert!(lines.iter().any(stands), "{keys}: {}", binding.sentence);
    }
}

#[test]
fn the_cases_by_their_numbers() {
    let mut desk = bench();
    desk.keys(&["Ctrl-N", "X"].repeat(8));
    assert_eq!(desk.app.tabs().count(), 9);
    for number in 1..=9 {
        desk.keys(&[&format!("Alt-{number}")]).assert_shows(&format!("[{number} "));
    }
}
