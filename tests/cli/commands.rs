//! The built program as scripts use it: input, output and exit codes.

use crate::program::{has, json, page, prints, program, ran, run, texts};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::process::Stdio;
use tipstrike::case::EXAMPLES;

const TABLE_1: &str = "cases/zhou-chen-2014.toml";

fn run_with_input(arguments: &[&str], input: &str) -> (i32, String, String) {
    let (piped, mut command) = (Stdio::piped, program(arguments));
    command.stdin(piped()).stdout(piped()).stderr(piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    texts(child.wait_with_output().unwrap())
}

/// A copy of Table 1 with a change, in a temporary folder.
fn changed(from: &str, to: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(TABLE_1).unwrap();
    assert!(text.contains(from));
    let path = folder.path().join("case.toml");
    fs::write(&path, text.replacen(from, to, 1)).unwrap();
    (folder, path.to_str().unwrap().to_owned())
}

/// Commands with a part of their pages; a part behind `!` is absent. The snapshots of `reports` have
/// the whole text of a solve.
#[test]
fn pages_for_a_person() {
    let dynamic = "solve TABLE_1 --method dynamic";
    prints(&[
        ("solve TABLE_1 --set pair.driver_hand=left", &["pair.driver_hand = left", "!Stations"]),
        ("solve TABLE_1 --stations 4", &["Stations from D to E"]),
        (
            "solve TABLE_1 --set 'deviations.base_pitch=0 um' --set 'model.deflection=0 um'",
            &["No corner contact: the tip clears the flank before E, Δ = 0 um"],
        ),
        // A selected quantity without a value gives the reason.
        (
            "solve TABLE_1 --only F_d,max,F_S",
            &["free impact 2191.0 N", "dynamic_peak_force has no value: method exact does not"],
        ),
        (
            "solve TABLE_1 --only F_S --set 'driven.tip_relief=80 um'",
            &["impact_force has no value: no corner contact: "],
        ),
        // One method governs, and the others follow in a line.
        (dynamic, &["!Free-impact estimate", "!governs"]),
        (
            "solve TABLE_1 --method dynamic --set 'driven.tip_relief=39 um'",
            &["static and exact find corner contact; dynamic governs: the case selects it"],
        ),
        (
            "explain dynamic_peak_force TABLE_1 --method auto",
            &[
                "at most 1e-3 (chosen by auto for model.within = 0.05; model.tolerance = 1e-6 is not used)",
                "!model.tolerance = 1e-6,",
            ],
        ),
        (
            "explain dynamic_peak_force TABLE_1 --method dynamic",
            &["at most model.tolerance = 1e-6"],
        ),
        ("explain impact_force", &["F_S = 2191.0 N ", "F_S = ΔV_n √(b M/q_s)"]),
        ("explain impact_force cases/tip-relief-enough.toml", &["No value: no corner contact"]),
        ("explain impact_force TABLE_1 --method dynamic", &["This is the free impact. Method "]),
        ("trade TABLE_1", &[" Within 5.0 %: dynamic with"]),
        ("fields", &["pair.module m module; 0.05..50 mm; "]),
        ("fields --results", &["impact_force "]),
        ("man", &[".SH NAME tipstrike", ".SH \"EXIT STATUS\""]),
        ("man solve", &["stations"]),
        ("--version", &["tipstrike "]),
        ("--help", &["completions"]),
        ("solve --help", &["--only"]),
    ]);
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        has(&page(&format!("completions {shell}")), &["tipstrike"]);
    }
    assert!(page("fields").lines().all(|line| line.chars().count() <= 100));
    for (one, other) in [
        ("explain F_S", "explain impact_force"),
        ("solve TABLE_1 --only F_S", "solve TABLE_1 --only impact_force"),
    ] {
        assert_eq!(page(one), page(other), "a quantity is known by its symbol");
    }
    let own = page("explain impact_force TABLE_1");
    let built_in = page("explain impact_force");
    assert!(own.lines().skip(3).eq(built_in.lines().skip(3)));
}

#[test]
fn json_has_the_promised_shape() {
    let solved = json("solve TABLE_1 --format json");
    let expected: [(&str, Value); 6] = [
        ("case", TABLE_1.into()),
        ("title", "Zhou & Chen 2014, Table 1".into()),
        ("format", 1.into()),
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("method", "exact".into()),
        ("outcome", "corner-contact".into()),
    ];
    for (key, value) in expected {
        assert_eq!(solved[key], value);
    }
    let force = &solved["quantities"]["impact_force"];
    assert!((force["value"].as_f64().unwrap() - 2191.016).abs() < 5e-4);
    assert_eq!(force["unit"], "N");
    let stages = solved["stages"].as_array().unwrap();
    assert_eq!(stages[0], "geometry");
    assert!(stages.contains(&"stations".into()) && stages.contains(&"clearing-relief".into()));
    let is_whole = |note: &Value| note["code"].is_string() && note["message"].is_string();
    assert!(solved["notes"].as_array().unwrap().iter().all(is_whole));
}

#[test]
fn an_absent_value_is_omitted_and_the_outcome_does_not_depend_on_the_selection() {
    let solved = json(
        "solve TABLE_1 --format json --set 'deviations.base_pitch=0 um' --set 'model.deflection=0 um'",
    );
    assert_eq!(solved["outcome"], "no-corner-contact");
    assert_eq!(solved["quantities"].get("impact_force"), None);
    assert_eq!(solved["quantities"]["total_deviation"]["value"], 0.0);
    // Between the relief that prevents corner contact by the printed equations, 61.8 um, and Δ = 0
    // by Eq. 1 as printed, 66.9 um.
    for only in ["", "--only total_deviation", "--only base_pitch"] {
        let relieved = "--set 'driven.tip_relief=64 um' --method paper --format json";
        let solved = json(&format!("solve TABLE_1 {relieved} {only}"));
        assert_eq!(solved["outcome"], "no-corner-contact", "{only:?}");
    }
    // A force outside the range of a formula is withheld with a note.
    let beyond = "solve TABLE_1 --format json --set driver.teeth=120 --set driven.teeth=120";
    let solved = json(beyond);
    assert!(solved["quantities"]["approach_angle_driven"]["value"].as_f64().unwrap() > 0.0);
    assert_eq!(solved["quantities"].get("impact_force"), None);
    assert_eq!(solved["notes"][0]["code"], "teeth-outside-fit");
}

#[test]
fn only_requested_quantities_are_computed_and_printed() {
    let solved = json("solve TABLE_1 --only approach_angle_driven --format json");
    assert_eq!(
        solved["stages"],
        serde_json::json!(["geometry", "load", "masses", "deviation", "position"])
    );
    let keys = |solved: &Value| solved["quantities"].as_object().unwrap().len();
    assert!(keys(&solved) == 1 && solved["quantities"]["approach_angle_driven"].is_object());
    let solved = json("solve TABLE_1 --only stick_limit,contact_ratio --format json");
    assert_eq!(solved["stages"].as_array().unwrap().last().unwrap(), "velocity");
    assert_eq!(keys(&solved), 2);
}

#[test]
fn csv_has_a_row_a_case_or_a_station_with_units_in_the_header() {
    let table = page("solve TABLE_1 TABLE_1 --only impact_force,contact_ratio --format csv");
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(
        reader.headers().unwrap(),
        &["case", "method", "outcome", "impact_force [N]", "contact_ratio [1]"][..]
    );
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 2);
    assert_eq!((&rows[0][0], &rows[0][1], &rows[0][2]), (TABLE_1, "exact", "corner-contact"));
    assert!((rows[0][3].parse::<f64>().unwrap() - 2191.016).abs() < 5e-4);
    let table = page("solve TABLE_1 --stations 10 --format csv");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 12);
    assert!(lines[0].starts_with("case,roll_angle_driver [rad],"), "{}", lines[0]);
    assert!(lines[11].ends_with(",0.0"), "{}", lines[11]);
}

/// Runs that print no results: the exit code and a part of the message.
#[test]
fn a_command_that_cannot_run_has_an_exit_code_and_a_message() {
    let (_folder, newer) = changed("format = 1", "format = 2");
    let newer = format!("solve {newer}");
    for (line, exit, says) in [
        ("solve TABLE_1 --only impact_forc", 2, "did you mean impact_force?"),
        ("solve TABLE_1 --set pair.module", 2, "KEY=VALUE"),
        ("solve TABLE_1 --set driver.teeth=2", 2, "5"),
        ("solve", 2, "CASE"),
        ("solve TABLE_1 --stations 0", 2, "stations"),
        ("solve TABLE_1 --method guess", 2, "guess"),
        ("--wrong", 2, "--wrong"),
        (
            "solve TABLE_1 --only impact_force --set driver.teeth=120 --set driven.teeth=120",
            3,
            "outside the Kuang-Yang fit",
        ),
        (newer.as_str(), 4, "format"),
        ("check no-such-file.toml", 5, "no-such-file.toml"),
        ("check cases", 5, "cases"),
        ("explain impact_forc", 2, "did you mean impact_force?"),
        ("explain", 2, "QUANTITY"),
        ("explain impact_force --set 'pair.modul=5 mm'", 2, "pair.module"),
        ("explain impact_force --set 'pair.centre_distance=80 mm'", 3, "pair.centre_distance"),
        ("explain impact_force no-such-file.toml", 5, "no-such-file.toml"),
        ("trade TABLE_1 --within 0", 2, "above 0"),
        ("trade TABLE_1 --within -5%", 2, "above 0"),
        ("trade TABLE_1 --within nan", 2, "above 0"),
        ("trade", 2, "CASE"),
        ("trade TABLE_1 --set 'pair.centre_distance=80 mm'", 3, "pair.centre_distance"),
        ("trade no-such-file.toml", 5, "no-such-file.toml"),
        ("man nonsense", 2, "nonsense"),
    ] {
        let (code, text, errors) = ran(line);
        assert_eq!((code, text.as_str()), (exit, ""), "{line}");
        assert!(errors.contains(says), "{line}: {errors}");
    }
}

#[test]
fn standard_input_is_a_case() {
    let text = fs::read_to_string(TABLE_1).unwrap();
    let (code, text, errors) = run_with_input(&["solve", "-", "--format", "json"], &text);
    assert_eq!((code, errors.as_str()), (0, ""));
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap()["case"], "-");
}

#[test]
fn several_cases_give_one_object_per_line_and_an_invalid_one_stops_no_other() {
    let (_folder, bad) = changed("teeth = 20", "teeth = \"many\"");
    let (code, text, errors) =
        ran(&format!("solve {bad} no-such-file.toml TABLE_1 TABLE_1 --format json"));
    let objects = text.lines().filter(|line| serde_json::from_str::<Value>(line).is_ok());
    assert_eq!((code, objects.count()), (5, 2));
    has(&errors, &["case.toml:", "no-such-file.toml"]);
}

#[test]
fn every_fault_of_a_bad_case_has_its_place_on_one_line() {
    let (_folder, path) = changed(
        "module = \"5 mm\"\npressure_angle = \"20 deg\"",
        "module = 5\npressure_angel = \"20 deg\"",
    );
    for format in ["text", "json", "csv"] {
        let (code, text, errors) = ran(&format!("solve {path} --format {format}"));
        assert_eq!((code, text.as_str()), (3, ""));
        assert_eq!(errors.lines().count(), 2, "{errors}");
        assert!(errors.lines().all(|line| line.starts_with(&format!("{path}:1"))), "{errors}");
    }
}

#[test]
fn a_refusal_of_the_model_has_the_place_of_its_field_and_leaves_limits_open() {
    let (_folder, path) = changed("addendum = 1.0", "addendum = 0.3");
    let settings = "--set driven.addendum=0.3 --set model.deflection=";
    let (code, text, errors) = ran(&format!("solve {path} {settings} --format json"));
    assert_eq!((code, text.as_str()), (3, ""));
    has(&errors, &["--set driven.addendum=0.3: "]);
    let (_folder, path) =
        changed("module = \"5 mm\"", "module = \"5 mm\"\ncentre_distance = \"80 mm\"");
    let (code, text, errors) = run(&["solve", &path]);
    assert_eq!((code, text.as_str()), (3, ""));
    assert!(errors.starts_with(&format!("{path}:12:")), "{errors}");
    has(&errors, &[": pair.centre_distance: "]);
    let (code, text, errors) = run(&["check", &path]);
    let expected = format!(
        "unknown {path}: impact force F_S cannot be computed: the centre distance jams the mesh"
    );
    assert!(code == 3 && text.starts_with(&expected), "{text}");
    has(&errors, &[": pair.centre_distance: "]);
}

#[test]
fn each_limit_has_its_line_whether_or_not_another_can_be_computed() {
    let limits =
        "[limits]\ncontact_ratio = 1.5\nimpact_force = \"2500 N\"\nnormal_velocity = \"90 m/s\"\n";
    let (_folder, path) = changed("[limits]\nimpact_force = \"2500 N\"", limits);
    let (code, text, errors) = ran(&format!("check {path} --set driver.teeth=120"));
    assert_eq!((code, text.lines().count()), (3, 4), "{text}");
    let force = "impact force F_S cannot be computed: tooth number outside";
    for (line, (standing, says, part)) in text.lines().skip(1).zip([
        ("EXCEEDED", "contact ratio ε 1.", "> 1.5"),
        ("unknown", force, "(limit 2500 N)"),
        ("ok", "approach velocity at D ΔV_n ", "m/s"),
    ]) {
        let start = format!("{standing} {path}: {says}");
        assert!(line.starts_with(&start) && line.contains(part), "{line}");
    }
    assert_eq!(errors.lines().count(), 1, "{errors}");
    has(&errors, &["outside the Kuang-Yang fit"]);
}

#[test]
fn a_check_is_a_verdict_a_line() {
    let checked = page("check TABLE_1");
    let line = format!("ok {TABLE_1}: impact force F_S 2191.0 N <= 2500 N (88 %)\n");
    assert!(checked.lines().count() == 2 && checked.ends_with(&line), "{checked}");
    let (_folder, strict) =
        changed("impact_force = \"2500 N\"", "impact_force = \"2 kN\"\ncontact_ratio = 1.7");
    let (code, text, errors) = run(&["check", &strict, TABLE_1]);
    assert_eq!((code, errors.as_str()), (1, ""));
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[1], format!("EXCEEDED {strict}: impact force F_S 2191.0 N > 2 kN (110 %)"));
    assert!(lines[2].starts_with("ok "), "{}", lines[2]);
    let (_folder, free) = changed("[limits]\nimpact_force = \"2500 N\"", "");
    assert!(page(&format!("check {free}")).ends_with(&format!("\nok {free}: no limits\n")));
    let (_other, bad) = changed("teeth = 20", "teeth = 0");
    let (code, text, _) = run(&["check", &bad, &strict]);
    assert!(code == 3 && text.contains("\nEXCEEDED "), "a bad case outranks a limit: {text}");
}

#[test]
fn json_marks_the_quantities_of_the_free_impact() {
    for (method, of) in [
        ("exact", Value::Null),
        ("static", "free-impact".into()),
        ("dynamic", "free-impact".into()),
    ] {
        let solved = json(&format!("solve TABLE_1 --format json --method {method}"));
        for key in ["impact_force", "impact_duration", "normal_velocity", "friction_ratio"] {
            assert_eq!(solved["quantities"][key]["of"], of, "{method} {key}");
        }
        for key in ["mesh_force", "total_deviation", "contact_ratio", "static_peak_force"] {
            assert_eq!(solved["quantities"][key]["of"], Value::Null, "{method} {key}");
        }
    }
}

/// The required values of a case, by key.
const REQUIRED: [(&str, &str); 7] = [
    ("pair.module", "4 mm"),
    ("driver.teeth", "17"),
    ("driver.face_width", "20 mm"),
    ("driven.teeth", "40"),
    ("driven.face_width", "22 mm"),
    ("operation.power", "5 kW"),
    ("operation.speed", "1500 rpm"),
];

#[test]
fn a_new_case_names_its_missing_values_until_they_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new.toml");
    let path = path.to_str().unwrap();
    assert_eq!(page(&format!("new {path}")), "");
    let mut text = fs::read_to_string(path).unwrap();
    let fresh = text.clone();
    assert_eq!(page("new"), text);
    assert!(text.contains("\nmethod = \"auto\"\n"), "{text}");
    let (code, output, missing) = run(&["solve", path]);
    assert_eq!((code, output.as_str()), (3, ""));
    assert_eq!(missing.lines().count(), REQUIRED.len(), "{missing}");
    for ((key, value), fault) in REQUIRED.iter().zip(missing.lines()) {
        let (table, name) = key.split_once('.').unwrap();
        let empty = format!("{name} = \"\"  # required");
        let line = fault[path.len() + 1..].split(':').next().unwrap();
        let line: usize = line.parse().unwrap();
        assert!(text.lines().nth(line - 1).unwrap().starts_with(&empty), "{fault}\n{text}");
        has(fault, &[&format!(": {key}: "), &format!("write {name} = ")]);
        assert!(fault.ends_with(&format!(" under [{table}]")), "{fault}");
        let value = if name == "teeth" { (*value).to_owned() } else { format!("\"{value}\"") };
        text = text.replacen(&empty, &format!("{name} = {value}  # required"), 1);
    }
    let (code, solved, errors) = run_with_input(&["solve", "-"], &text);
    assert_eq!((code, errors.as_str()), (0, ""));
    has(&solved, &["orner contact"]);
    // The settings of the command line complete a new case, too.
    let settings = REQUIRED.map(|(key, value)| format!("{key}={value}"));
    let mut words = vec!["solve", "-"];
    words.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    let (code, _, errors) = run_with_input(&words, &fresh);
    assert_eq!((code, errors.as_str()), (0, ""));
    words.truncate(words.len() - 2);
    let (code, _, missing) = run_with_input(&words, &fresh);
    assert!(code == 3 && missing.lines().count() == 1 && missing.contains("speed"), "{missing}");
}

#[test]
fn a_new_case_starts_from_an_example_in_every_folder_and_overwrites_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let path = path.to_str().unwrap();
    let elsewhere =
        |arguments: &[&str]| texts(program(arguments).current_dir(folder.path()).output().unwrap());
    let (_, listed, _) = elsewhere(&["new", "--list"]);
    for example in EXAMPLES {
        let file = format!("{}/cases/{}.toml", env!("CARGO_MANIFEST_DIR"), example.name);
        let text = fs::read_to_string(file).unwrap();
        assert_eq!(elsewhere(&["new", "--from", example.name]).1, text, "the very file");
        assert!(listed.contains(example.name));
    }
    has(&listed, &["free impact 2191.0 N", "ok impact force F_S"]);
    assert_eq!(elsewhere(&["new", "--from", "fzg-type-c", path]).0, 0);
    for (arguments, exit, says) in [
        (&["new", "--from", "zhou-chen-2014", path][..], 5, "the file exists"),
        (&["new", path], 5, "the file exists"),
        (&["new", "--from", "fzg-type"], 2, "fzg-type-c"),
        (&["new", "--list", path], 2, "--list"),
    ] {
        let (code, output, errors) = elsewhere(arguments);
        assert_eq!((code, output.as_str()), (exit, ""), "{arguments:?}");
        has(&errors, &[says]);
    }
    has(&page(&format!("solve {path}")), &["FZG type C"]);
}

#[test]
fn fields_explanations_and_trades_are_data_for_scripts() {
    let lines = page("fields --format json");
    let is_object = |line: &str| serde_json::from_str::<Value>(line).unwrap().is_object();
    assert_eq!(lines.lines().filter(|line| is_object(line)).count(), tipstrike::case::FIELDS.len());
    let paper = json("explain approach_angle_driver TABLE_1 --method paper --format json");
    for (found, expected) in [
        (&paper["key"], "approach_angle_driver"),
        (&paper["method"], "paper"),
        (&paper["derivation"][0]["formula"], "ε_e + ε_d"),
        (&paper["derivation"][0]["numbers"], "0.027207 deg + 0.025368 deg"),
        (&paper["corrections"][0]["equation"], "Eqs. 7-20"),
    ] {
        assert_eq!(found, expected);
    }
    assert_eq!(paper["validity"][0]["inside"], false);
    let faster = json("explain normal_velocity --set 'operation.speed=4000 rpm' --format json");
    let mut effects = faster["sensitivity"].as_array().unwrap().iter();
    let effect = effects.find(|effect| effect["key"] == "operation.speed").unwrap();
    assert_eq!((&effect["text"], &effect["change"]), (&"4000 rpm".into(), &"+1.00 %".into()));
    let traded = json("trade TABLE_1 --within 40% --format json");
    assert_eq!((&traded["case"], &traded["within"]), (&TABLE_1.into(), &0.4.into()));
    let recommended = &traded["recommended"];
    assert_eq!(recommended["qualifies"], true);
    assert!(recommended["total"].as_f64().unwrap() <= 0.4, "{recommended}");
    let settings = traded["settings"].as_array().unwrap().iter();
    let own: Vec<&Value> = settings.filter(|one| one["current"] == true).collect();
    assert!(own.len() == 1 && own[0]["method"] == "exact" && own[0]["stations"] == 64);
}

#[test]
fn no_colour_and_no_escape_is_written_anywhere() {
    for arguments in [&["--help"][..], &["solve", "--help"], &["solve"], &["man"]] {
        let mut coloured = program(arguments);
        coloured.env("CLICOLOR_FORCE", "1").env_remove("NO_COLOR");
        let (_, text, errors) = texts(coloured.output().unwrap());
        assert!(!(text + &errors).contains('\u{1b}'), "{arguments:?}");
    }
}
