//! The built program as scripts use it: input, output and exit codes.

use crate::program::{has, output as run, program, stdout_of, words};
use serde_json::Value;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::process::{Output, Stdio};
use tipstrike::case::EXAMPLES;

const TABLE_1: &str = "cases/zhou-chen-2014.toml";

fn run_with_input(arguments: &[&str], input: &str) -> Output {
    let mut child = program(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout_of(arguments)).unwrap()
}

/// A copy of Table 1 with a change, in a temporary folder.
fn changed(from: &str, to: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(TABLE_1).unwrap();
    assert!(text.contains(from));
    let path = folder.path().join("case.toml");
    fs::write(&path, text.replacen(from, to, 1)).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

fn in_a_line(page: &str) -> String {
    page.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn a_solve_prints_a_report_for_a_person() {
    let page = stdout_of(&["solve", TABLE_1]);
    assert!(page.starts_with("Zhou & Chen 2014, Table 1\n"), "{page}");
    let sentence = "Corner contact 1.366 deg before E: impact force 2191.0 N (1.44 times the mesh \
        force); 47.4 um of tip relief on the driven gear prevents it.";
    assert!(in_a_line(&page).contains(sentence), "{page}");
    assert!(!page.contains("paper 84.649 N") && !page.contains("the impact lasts"), "{page}");
    let checked = stdout_of(&["check", TABLE_1]);
    assert!(checked.starts_with(&format!("{TABLE_1}: {sentence}\n")), "{checked}");
    assert!(!page.contains("Stations"), "{page}");
    assert!(stdout_of(&["solve", TABLE_1, "--stations", "4"]).contains("Stations from D to E"));
}

#[test]
fn json_has_the_promised_shape() {
    let solved = json(&["solve", TABLE_1, "--format", "json"]);
    assert_eq!(solved["case"], TABLE_1);
    assert_eq!(solved["title"], "Zhou & Chen 2014, Table 1");
    assert_eq!(solved["format"], 1);
    assert_eq!(solved["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(
        (&solved["method"], &solved["outcome"]),
        (&"exact".into(), &"corner-contact".into())
    );
    let force = &solved["quantities"]["impact_force"];
    assert!((force["value"].as_f64().unwrap() - 2191.016).abs() < 5e-4);
    assert_eq!(force["unit"], "N");
    let stages = solved["stages"].as_array().unwrap();
    assert_eq!(stages[0], "geometry");
    assert!(stages.contains(&"stations".into()) && stages.contains(&"clearing-relief".into()));
    assert!(
        solved["notes"]
            .as_array()
            .unwrap()
            .iter()
            .all(|note| note["code"].is_string() && note["message"].is_string())
    );
}

#[test]
fn json_stations_run_from_d_to_e() {
    let solved = json(&["solve", TABLE_1, "--format", "json", "--stations", "10"]);
    let stations = solved["stations"].as_array().unwrap();
    assert_eq!(stations.len(), 11);
    let force = |station: &Value| station["impact_force"].as_f64().unwrap();
    assert!((force(&stations[0]) - 2191.016).abs() < 5e-4);
    assert!((force(&stations[9]) - 219.977).abs() < 5e-4);
    assert!(force(&stations[10]).abs() < f64::MIN_POSITIVE);
    assert_eq!(
        stations[0]["roll_angle_driven"],
        solved["quantities"]["approach_angle_driven"]["value"]
    );
    let without = json(&["solve", TABLE_1, "--format", "json", "--only", "impact_force"]);
    assert_eq!(without.get("stations"), None);
}

#[test]
fn an_absent_value_is_omitted_and_the_outcome_gives_the_reason() {
    let on_time = ["--set", "deviations.base_pitch=0 um", "--set", "model.deflection=0 um"];
    let solved = json(&[&["solve", TABLE_1, "--format", "json"], &on_time[..]].concat());
    assert_eq!(solved["outcome"], "no-corner-contact");
    assert_eq!(solved["quantities"].get("impact_force"), None);
    assert_eq!(solved["quantities"]["total_deviation"]["value"], 0.0);
    assert!(
        stdout_of(&[&["solve", TABLE_1], &on_time[..]].concat())
            .contains("No corner contact: the tip clears the flank before E, Δ = 0 um")
    );
}

#[test]
fn a_selected_quantity_without_a_value_gives_the_reason() {
    let without_motion = stdout_of(&["solve", TABLE_1, "--only", "F_d,max,F_S"]);
    has(
        &without_motion,
        &[
            "  F_S impact force 2191.0 N",
            "  F_d,max has no value: method exact does not compute this quantity",
        ],
    );
    let relief = "driven.tip_relief=80 um";
    let without_contact = stdout_of(&["solve", TABLE_1, "--only", "F_S", "--set", relief]);
    has(&without_contact, &["  F_S has no value: no corner contact: "]);
}

#[test]
fn the_outcome_does_not_depend_on_the_requested_quantities() {
    // Between the relief that prevents corner contact by the printed equations, 61.8 um, and Δ = 0
    // by Eq. 1 as printed, 66.9 um.
    let relieved = ["--set", "driven.tip_relief=64 um", "--method", "paper", "--format", "json"];
    for only in [&[][..], &["--only", "total_deviation"], &["--only", "base_pitch"]] {
        let solved = json(&[&["solve", TABLE_1], &relieved[..], only].concat());
        assert_eq!(solved["outcome"], "no-corner-contact", "{only:?}");
    }
}

#[test]
fn only_requested_quantities_are_computed_and_printed() {
    let solved = json(&["solve", TABLE_1, "--only", "approach_angle_driven", "--format", "json"]);
    assert_eq!(
        solved["stages"],
        serde_json::json!(["geometry", "load", "masses", "deviation", "position"])
    );
    assert_eq!(
        solved["quantities"].as_object().unwrap().keys().collect::<Vec<_>>(),
        ["approach_angle_driven"]
    );
    let solved =
        json(&["solve", TABLE_1, "--only", "stick_limit,contact_ratio", "--format", "json"]);
    assert_eq!(solved["stages"].as_array().unwrap().last().unwrap(), "velocity");
    assert_eq!(solved["quantities"].as_object().unwrap().len(), 2);
}

#[test]
fn csv_has_a_row_a_case_with_units_in_the_header() {
    let table = stdout_of(&words(&format!(
        "solve {TABLE_1} {TABLE_1} --only impact_force,contact_ratio --format csv"
    )));
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(
        reader.headers().unwrap(),
        &["case", "method", "outcome", "impact_force [N]", "contact_ratio [1]"][..]
    );
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 2);
    assert_eq!((&rows[0][0], &rows[0][1], &rows[0][2]), (TABLE_1, "exact", "corner-contact"));
    assert!((rows[0][3].parse::<f64>().unwrap() - 2191.016).abs() < 5e-4);
}

#[test]
fn csv_with_stations_has_a_row_a_station() {
    let table = stdout_of(&["solve", TABLE_1, "--stations", "10", "--format", "csv"]);
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 12);
    assert!(lines[0].starts_with("case,roll_angle_driver [rad],"), "{}", lines[0]);
    assert!(lines[11].ends_with(",0.0"), "{}", lines[11]);
}

#[test]
fn settings_and_method_change_the_case() {
    let value = |arguments: &[&str]| {
        let common = ["solve", TABLE_1, "--format", "json", "--only", "impact_force"];
        json(&[&common[..], arguments].concat())["quantities"]["impact_force"]["value"]
            .as_f64()
            .unwrap()
    };
    assert!((value(&["--method", "paper"]) - 84.649).abs() < 5e-4);
    assert!((value(&["--set", "model.method=paper"]) - 84.649).abs() < 5e-4);
    assert!(value(&["--set", "operation.speed=4000 rpm"]) > 4000.0);
}

/// Runs that print no results: the exit code and a part of the message.
#[test]
fn a_command_that_cannot_run_has_an_exit_code_and_a_message() {
    let (_folder, newer) = changed("format = 1", "format = 2");
    let jammed = ["--set", "pair.centre_distance=80 mm"];
    let beyond = ["--set", "driver.teeth=120", "--set", "driven.teeth=120"];
    let runs: [(&[&str], &[&str], i32, &str); 26] = [
        (&["solve", TABLE_1, "--only", "impact_forc"], &[], 2, "did you mean impact_force?"),
        (&["solve", TABLE_1, "--set", "pair.modul=5 mm"], &[], 2, "pair.module"),
        (&["solve", TABLE_1, "--set", "pair.module"], &[], 2, "KEY=VALUE"),
        (&["solve", TABLE_1, "--set", "pair.module=5"], &[], 2, "5 mm"),
        (&["solve", TABLE_1, "--set", "pair.module=5 kg"], &[], 2, "mm"),
        (&["solve", TABLE_1, "--set", "driver.teeth=2"], &[], 2, "5"),
        (&["solve"], &[], 2, "CASE"),
        (&["solve", TABLE_1, "--stations", "0"], &[], 2, "stations"),
        (&["solve", TABLE_1, "--method", "guess"], &[], 2, "guess"),
        (&["--wrong"], &[], 2, "--wrong"),
        (&["solve", TABLE_1, "--only", "impact_force"], &beyond, 3, "outside the Kuang-Yang fit"),
        (&["solve", &newer], &[], 4, "format"),
        (&["check", "no-such-file.toml"], &[], 5, "no-such-file.toml"),
        (&["check", "cases"], &[], 5, "cases"),
        (&["explain", "impact_forc"], &[], 2, "did you mean impact_force?"),
        (&["explain"], &[], 2, "QUANTITY"),
        (&["explain", "impact_force", "--set", "pair.modul=5 mm"], &[], 2, "pair.module"),
        (&["explain", "impact_force"], &jammed, 3, "pair.centre_distance"),
        (&["explain", "impact_force", "no-such-file.toml"], &[], 5, "no-such-file.toml"),
        (&["trade", TABLE_1, "--within", "0"], &[], 2, "above 0"),
        (&["trade", TABLE_1, "--within", "-5%"], &[], 2, "above 0"),
        (&["trade", TABLE_1, "--within", "nan"], &[], 2, "above 0"),
        (&["trade"], &[], 2, "CASE"),
        (&["trade", TABLE_1], &jammed, 3, "pair.centre_distance"),
        (&["trade", "no-such-file.toml"], &[], 5, "no-such-file.toml"),
        (&["man", "nonsense"], &[], 2, "nonsense"),
    ];
    for (arguments, more, exit, says) in runs {
        let output = run(&[arguments, more].concat());
        assert_eq!((code(&output), out(&output).as_str()), (exit, ""), "{arguments:?}");
        assert!(err(&output).contains(says), "{arguments:?}: {}", err(&output));
    }
}

#[test]
fn standard_input_is_a_case() {
    let text = fs::read_to_string(TABLE_1).unwrap();
    let output = run_with_input(&["solve", "-", "--format", "json"], &text);
    assert_eq!((code(&output), err(&output).as_str()), (0, ""));
    assert_eq!(serde_json::from_str::<Value>(&out(&output)).unwrap()["case"], "-");
}

#[test]
fn several_cases_give_one_object_per_line_and_an_invalid_one_stops_no_other() {
    let (_folder, bad) = changed("teeth = 20", "teeth = \"many\"");
    let output = run(&["solve", &bad, "no-such-file.toml", TABLE_1, TABLE_1, "--format", "json"]);
    assert_eq!(code(&output), 5);
    assert_eq!(
        out(&output).lines().filter(|line| serde_json::from_str::<Value>(line).is_ok()).count(),
        2
    );
    assert!(err(&output).contains("case.toml:"), "{}", err(&output));
    assert!(err(&output).contains("no-such-file.toml"), "{}", err(&output));
}

#[test]
fn every_fault_of_a_bad_case_has_its_place_on_one_line() {
    let (_folder, path) = changed(
        "module = \"5 mm\"\npressure_angle = \"20 deg\"",
        "module = 5\npressure_angel = \"20 deg\"",
    );
    for format in ["text", "json", "csv"] {
        let output = run(&["solve", &path, "--format", format]);
        assert_eq!((code(&output), out(&output).as_str()), (3, ""));
        let errors = err(&output);
        assert_eq!(errors.lines().count(), 2, "{errors}");
        assert!(errors.lines().all(|line| line.starts_with(&format!("{path}:1"))), "{errors}");
    }
}

#[test]
fn a_refusal_of_the_model_has_the_place_of_its_field() {
    let (_folder, path) = changed("addendum = 1.0", "addendum = 0.3");
    let output = run(&words(&format!(
        "solve {path} --set driven.addendum=0.3 --set model.deflection= --format json"
    )));
    assert_eq!((code(&output), out(&output).as_str()), (3, ""));
    assert!(err(&output).contains("--set driven.addendum=0.3: "), "{}", err(&output));
    let (_folder, path) =
        changed("module = \"5 mm\"", "module = \"5 mm\"\ncentre_distance = \"80 mm\"");
    let output = run(&["solve", &path]);
    assert_eq!((code(&output), out(&output).as_str()), (3, ""));
    assert!(err(&output).starts_with(&format!("{path}:12:")), "{}", err(&output));
    assert!(err(&output).contains(": pair.centre_distance: "), "{}", err(&output));
}

#[test]
fn a_force_outside_a_formulas_range_is_withheld_with_a_note() {
    let beyond = ["--set", "driver.teeth=120", "--set", "driven.teeth=120"];
    let solved = json(&[&["solve", TABLE_1, "--format", "json"], &beyond[..]].concat());
    assert!(solved["quantities"]["approach_angle_driven"]["value"].as_f64().unwrap() > 0.0);
    assert_eq!(solved["quantities"].get("impact_force"), None);
    assert_eq!(solved["notes"][0]["code"], "teeth-outside-fit");
}

#[test]
fn each_limit_has_its_line_whether_or_not_another_can_be_computed() {
    let (_folder, path) = changed("teeth = 20", "teeth = 120");
    let limits =
        "[limits]\ncontact_ratio = 1.5\nimpact_force = \"2500 N\"\nnormal_velocity = \"90 m/s\"\n";
    fs::write(
        &path,
        fs::read_to_string(&path).unwrap().replace("[limits]\nimpact_force = \"2500 N\"", limits),
    )
    .unwrap();
    let output = run(&["check", &path]);
    let text = out(&output);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((code(&output), lines.len()), (3, 4), "{lines:?}");
    let lines = &lines[1..];
    assert!(
        lines[0].starts_with(&format!("EXCEEDED {path}: contact_ratio 1."))
            && lines[0].contains("> 1.5"),
        "{}",
        lines[0]
    );
    assert!(
        lines[1].starts_with(&format!(
            "unknown {path}: impact_force cannot be computed: tooth number outside"
        )),
        "{}",
        lines[1]
    );
    assert!(lines[1].ends_with("(limit 2500 N)"), "{}", lines[1]);
    assert!(lines[2].starts_with(&format!("ok {path}: normal_velocity ")), "{}", lines[2]);
    assert_eq!(err(&output).lines().count(), 1, "{}", err(&output));
    assert!(err(&output).contains("outside the Kuang-Yang fit"), "{}", err(&output));
}

#[test]
fn a_refused_case_reports_each_limit_as_not_computable() {
    let (_folder, path) =
        changed("module = \"5 mm\"", "module = \"5 mm\"\ncentre_distance = \"80 mm\"");
    let output = run(&["check", &path]);
    assert_eq!(code(&output), 3);
    let expected = format!(
        "unknown {path}: impact_force cannot be computed: the centre distance jams the mesh"
    );
    assert!(out(&output).starts_with(&expected), "{}", out(&output));
    assert!(err(&output).contains(": pair.centre_distance: "), "{}", err(&output));
}

#[test]
fn a_check_is_a_verdict_a_line() {
    let checked = stdout_of(&["check", TABLE_1]);
    let line = format!("ok {TABLE_1}: impact_force 2191.0 N <= 2500 N (88 %)\n");
    assert!(checked.lines().count() == 2 && checked.ends_with(&line), "{checked}");
    let (_folder, strict) =
        changed("impact_force = \"2500 N\"", "impact_force = \"2 kN\"\ncontact_ratio = 1.7");
    let output = run(&["check", &strict, TABLE_1]);
    assert_eq!((code(&output), err(&output).as_str()), (1, ""));
    let lines: Vec<String> = out(&output).lines().map(str::to_owned).collect();
    assert_eq!(lines[1], format!("EXCEEDED {strict}: impact_force 2191.0 N > 2 kN (110 %)"));
    assert!(lines[2].starts_with("ok "), "{}", lines[2]);
    let (_folder, free) = changed("[limits]\nimpact_force = \"2500 N\"", "");
    assert!(stdout_of(&["check", &free]).ends_with(&format!("\nok {free}: no limits\n")));
}

#[test]
fn json_marks_the_quantities_of_the_free_impact() {
    for (method, of) in [
        ("exact", Value::Null),
        ("static", "free-impact".into()),
        ("dynamic", "free-impact".into()),
    ] {
        let quantities =
            &json(&["solve", TABLE_1, "--format", "json", "--method", method])["quantities"];
        for key in ["impact_force", "impact_duration", "normal_velocity", "friction_ratio"] {
            assert_eq!(quantities[key]["of"], of, "{method} {key}");
        }
        for key in [
            "mesh_force",
            "total_deviation",
            "contact_ratio",
            "static_peak_force",
            "dynamic_peak_force",
        ] {
            assert_eq!(quantities[key]["of"], Value::Null, "{method} {key}");
        }
    }
}

#[test]
fn the_results_of_a_method_come_before_the_free_impact() {
    for (method, first) in [("static", "static: force at E"), ("dynamic", "dynamic: peak before E")]
    {
        let text = stdout_of(&["solve", TABLE_1, "--method", method]);
        let (own, free) =
            text.split_once("Free impact at D, closed form: first contact D").unwrap();
        assert!(own.contains(first) && free.contains("F_S      impact force"), "{text}");
        assert!(
            free.contains(
                "ok        impact_force 2011.2 N <= 2500 N (80 %) for the free impact. Method"
            ),
            "{text}"
        );
        let page = stdout_of(&["explain", "impact_force", TABLE_1, "--method", method]);
        assert!(page.contains("This is the free impact; "), "{page}");
        assert!(
            !page.contains(&format!("{method} 2011.2 N"))
                && page.contains("exact with the deflection that"),
            "{page}"
        );
    }
    assert!(!stdout_of(&["solve", TABLE_1]).contains("Free impact"));
}

#[test]
fn the_printed_relief_prevents_contact_and_a_little_less_does_not() {
    const CASE: &str = "cases/nasa-lewis-28-28.toml";
    for (method, given) in ["paper", "exact", "static", "dynamic"]
        .into_iter()
        .flat_map(|method| [(method, 0.0), (method, 3.7)])
    {
        let with = |relief: f64, format: &'static str| {
            let set = format!("driven.tip_relief={relief:.6} um");
            vec![
                "solve".to_owned(),
                CASE.into(),
                "--method".into(),
                method.into(),
                "--set".into(),
                set,
                "--format".into(),
                format.into(),
            ]
        };
        let run = |options: Vec<String>| {
            stdout_of(&options.iter().map(String::as_str).collect::<Vec<_>>())
        };
        let text = run(with(given, "text")).split_whitespace().collect::<Vec<_>>().join(" ");
        let words =
            [" um of tip relief on the driven gear", " um more tip relief on the driven gear"];
        let before = words.iter().find_map(|words| Some(text.split_once(words)?.0));
        let amount = before.and_then(|before| before.rsplit(' ').next()).unwrap_or_default();
        let amount: f64 = amount.parse().unwrap_or_else(|_| panic!("{method}: {text}"));
        for (part, outcome) in [(1.0, "no-corner-contact"), (0.99, "corner-contact")] {
            let solved: Value =
                serde_json::from_str(&run(with(given + amount * part, "json"))).unwrap();
            assert_eq!(solved["outcome"], outcome, "{method} from {given}: {text}");
        }
    }
}

#[test]
fn the_page_of_a_result_by_auto_shows_the_chosen_tolerance() {
    let page = stdout_of(&["explain", "dynamic_peak_force", TABLE_1, "--method", "auto"]);
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(page.contains("method dynamic, chosen by auto"), "{page}");
    has(
        &page,
        &["at most 1e-3 (chosen by auto for model.within = 0.05; model.tolerance = 1e-6 is not \
                used)"],
    );
    assert!(
        page.contains("model.within = ") && !page.contains("model.tolerance = 1e-6,"),
        "{page}"
    );
    let given = stdout_of(&["explain", "dynamic_peak_force", TABLE_1, "--method", "dynamic"]);
    assert!(given.contains("at most model.tolerance = 1e-6"), "{given}");
}

#[test]
fn a_limit_is_tried_on_another_method_and_on_a_changed_field() {
    let dynamic = stdout_of(&["check", TABLE_1, "--method", "dynamic"]);
    let beside = "for the free impact. Method dynamic: dynamic_peak_approach_force 1410.8 N; this quantity \
            has no limit";
    let held = format!("ok {TABLE_1}: impact_force 2011.2 N <= 2500 N (80 %) {beside}\n");
    assert!(dynamic.ends_with(&held), "{dynamic}");
    let by_auto = stdout_of(&["check", TABLE_1, "--method", "auto"]);
    assert_eq!(by_auto, dynamic, "the name means the same whatever the method");
    let (_folder, own) = changed(
        "impact_force = \"2500 N\"",
        "dynamic_peak_approach_force = \"2500 N\"\ncontact_ratio = 1.7",
    );
    let own = stdout_of(&["check", &own, "--method", "dynamic"]);
    assert!(
        !own.contains("free impact")
            && own.contains("dynamic_peak_approach_force 1410.8 N <= 2500 N (56 %)\n"),
        "{own}"
    );
    let relieved = stdout_of(&["check", TABLE_1, "--set", "driven.tip_relief=60 um"]);
    let line =
        format!("\nok {TABLE_1}: impact_force does not occur: no corner contact (limit 2500 N)\n");
    assert!(relieved.ends_with(&line), "{relieved}");
}

#[test]
fn a_bad_case_outranks_an_exceeded_limit() {
    let (_folder, strict) = changed("\"2500 N\"", "\"2 N\"");
    let (_other, bad) = changed("teeth = 20", "teeth = 0");
    let output = run(&["check", &bad, &strict]);
    assert_eq!(code(&output), 3);
    assert!(out(&output).contains("\nEXCEEDED "), "{}", out(&output));
}

#[test]
fn no_control_of_a_file_or_a_name_reaches_the_terminal() {
    let (folder, _) = changed("format", "format");
    let text = fs::read_to_string(TABLE_1).unwrap();
    let hostile =
        text.replace("title = \"Zhou", "title = \"\\u001b[2J\\u009b\\u007f\\u202E\\u200b Zhou");
    let path = folder.path().join("\u{1b}[31m\u{202e}.toml");
    fs::write(&path, &hostile).unwrap();
    let path = path.to_str().unwrap();
    let broken = folder.path().join("\u{1b}]0;\u{7}.toml");
    fs::write(&broken, hostile.replace("teeth", "te\u{1b}eth")).unwrap();
    let runs: [&[&str]; 9] = [
        &["solve", path],
        &["solve", path, "--format", "json"],
        &["solve", path, "--format", "csv"],
        &["check", path],
        &["explain", "impact_force", path],
        &["explain", "impact_force", path, "--format", "json"],
        &["solve", broken.to_str().unwrap()],
        &["solve", "no-such\u{9b}file"],
        &["solve", TABLE_1, "--\u{1b}[2J"],
    ];
    for arguments in runs {
        let output = run(arguments);
        let shown = out(&output) + &err(&output);
        let raw = shown
            .chars()
            .find(|&c| c.is_control() && c != '\n' || ('\u{200b}'..='\u{202e}').contains(&c));
        assert_eq!(raw, None, "{arguments:?}: {shown}");
    }
    let solved = json(&["solve", path, "--format", "json"]);
    assert_eq!(solved["case"], path);
    assert!(solved["title"].as_str().unwrap().starts_with("\u{1b}[2J\u{9b}\u{7f}\u{202e}"));
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
    assert_eq!(stdout_of(&["new", path]), "");
    let mut text = fs::read_to_string(path).unwrap();
    assert_eq!(stdout_of(&["new"]), text);
    assert!(text.contains("\nmethod = \"auto\"\n"), "{text}");
    let output = run(&["solve", path]);
    assert_eq!((code(&output), out(&output).as_str()), (3, ""));
    let missing = err(&output);
    assert_eq!(missing.lines().count(), REQUIRED.len(), "{missing}");
    for ((key, value), fault) in REQUIRED.iter().zip(missing.lines()) {
        let (table, name) = key.split_once('.').unwrap();
        let empty = format!("{name} = \"\"  # required");
        let line = fault[path.len() + 1..].split(':').next().unwrap();
        let line: usize = line.parse().unwrap();
        assert!(
            text.lines().nth(line - 1).unwrap().starts_with(&empty)
                && fault.contains(&format!(": {key}: "))
                && fault.contains(&format!("write {name} = "))
                && fault.ends_with(&format!(" under [{table}]")),
            "{fault}\n{text}"
        );
        let value = if name == "teeth" { (*value).to_owned() } else { format!("\"{value}\"") };
        text = text.replacen(&empty, &format!("{name} = {value}  # required"), 1);
    }
    let solved = run_with_input(&["solve", "-"], &text);
    assert_eq!((code(&solved), err(&solved).as_str()), (0, ""));
    assert!(out(&solved).contains("orner contact"), "{}", out(&solved));
}

#[test]
fn settings_complete_a_new_case() {
    let text = stdout_of(&["new"]);
    let settings = REQUIRED.map(|(key, value)| format!("{key}={value}"));
    let mut words = vec!["solve", "-"];
    for setting in &settings {
        words.extend(["--set", setting]);
    }
    let solved = run_with_input(&words, &text);
    assert_eq!((code(&solved), err(&solved).as_str()), (0, ""));
    words.truncate(words.len() - 2);
    let incomplete = run_with_input(&words, &text);
    let missing = err(&incomplete);
    assert!(
        code(&incomplete) == 3 && missing.lines().count() == 1 && missing.contains("speed"),
        "{missing}"
    );
}

#[test]
fn a_quantity_is_known_by_a_symbol_of_its_own() {
    let of = |name: &str| stdout_of(&["explain", name]);
    assert_eq!(of("F_S"), of("impact_force"));
    assert_eq!(
        stdout_of(&["solve", TABLE_1, "--only", "F_S"]),
        stdout_of(&["solve", TABLE_1, "--only", "impact_force"])
    );
    let page =
        stdout_of(&["solve", TABLE_1, "--method", "dynamic", "--only", "F_d,max,F_st,E,Δf_0"]);
    let rows =
        ["F_d,max dynamic: peak force", "F_st,E  static: force at E", "Δf_0    error without"];
    assert!(rows.iter().all(|row| page.contains(row)), "{page}");
}

#[test]
fn the_angle_of_the_verdict_is_a_row_of_the_table() {
    for (method, label) in [
        ("exact", "driver angle before E"),
        ("static", "static: driver angle"),
        ("dynamic", "dynamic: driver angle"),
    ] {
        let page = stdout_of(&["solve", TABLE_1, "--method", method]);
        let (_, rest) = page.split_once("Corner contact ").unwrap_or_else(|| panic!("{page}"));
        let (angle, _) = rest.split_once(" before E").unwrap();
        let row = page.lines().find(|line| line.contains(label)).unwrap();
        assert!(row.contains(angle), "{row}");
    }
}

#[test]
fn one_method_governs_and_the_others_follow_in_a_line() {
    let solve = |options: &[&str]| {
        let page = stdout_of(&[&["solve", TABLE_1, "--method", "dynamic"], options].concat());
        in_a_line(&page)
    };
    let page = solve(&[]);
    for line in [
        "up to 1410.8 N on the tip (0.93 times the mesh force), 2003.0 N on a tooth (1.31 times the \
            force at rest); 38.9 um of tip relief on the driven gear prevents it.",
        "Free-impact estimate with the given deflection: 2191.0 N, 1.366 deg before E.",
    ] {
        assert!(page.contains(line), "{line}: {page}");
    }
    let differing = solve(&["--set", "driven.tip_relief=39 um"]);
    let line = "static and exact find corner contact; dynamic governs: the case selects it, and it \
            includes inertia.";
    assert!(differing.contains(line), "{differing}");
    assert!(!page.contains("governs"), "{page}");
}

#[test]
fn a_new_case_overwrites_nothing() {
    let (_folder, path) = changed("format", "format");
    let before = fs::read(&path).unwrap();
    let output = run(&["new", &path]);
    assert_eq!((code(&output), out(&output).as_str()), (5, ""));
    assert_eq!(fs::read(&path).unwrap(), before);
}

#[test]
fn a_new_case_starts_from_an_example_in_every_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let path = path.to_str().unwrap();
    let elsewhere =
        |arguments: &[&str]| program(arguments).current_dir(folder.path()).output().unwrap();
    let listed = out(&elsewhere(&["new", "--list"]));
    for example in EXAMPLES {
        let text = fs::read_to_string(format!(
            concat!(env!("CARGO_MANIFEST_DIR"), "/cases/{}.toml"),
            example.name
        ))
        .unwrap();
        assert_eq!(out(&elsewhere(&["new", "--from", example.name])), text, "the very file");
        assert!(listed.contains(example.name));
    }
    has(&listed, &["impact force 2191.0 N", "ok impact_force"]);
    assert_eq!(code(&elsewhere(&["new", "--from", "fzg-type-c", path])), 0);
    assert!(stdout_of(&["solve", path]).contains("FZG type C"));
    let again = elsewhere(&["new", "--from", "fzg-type-c", path]);
    assert!(code(&again) == 5 && err(&again).contains("the file exists"));
    let slip = elsewhere(&["new", "--from", "fzg-type"]);
    assert!(code(&slip) == 2 && err(&slip).contains("fzg-type-c"), "{}", err(&slip));
    assert_eq!(code(&elsewhere(&["new", "--list", path])), 2);
}

#[test]
fn the_fields_are_listed_for_people_and_for_scripts() {
    let table = stdout_of(&["fields"]);
    assert!(table.lines().all(|line| line.chars().count() <= 100));
    assert!(
        table.lines().any(|line| line.starts_with("pair.module ") && line.contains("0.05..50")),
        "{table}"
    );
    let lines = stdout_of(&["fields", "--format", "json"]);
    let fields: Vec<Value> =
        lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(fields.len(), tipstrike::case::FIELDS.len());
    assert!(stdout_of(&["fields", "--results"]).contains("impact_force "));
}

#[test]
fn a_quantity_is_explained_for_people_and_for_scripts() {
    let page = stdout_of(&["explain", "impact_force"]);
    assert!(page.starts_with("impact force, F_S (Eq. 57)\nF_S = 2191.0 N\n"), "{page}");
    assert!(page.contains("F_S = ΔV_n √(b M/q_s)"), "{page}");
    assert_eq!(
        stdout_of(&["explain", "impact_force", TABLE_1]).lines().skip(3).collect::<Vec<_>>(),
        page.lines().skip(3).collect::<Vec<_>>()
    );
    let paper = json(&words(&format!(
        "explain approach_angle_driver {TABLE_1} --method paper --format json"
    )));
    assert_eq!(
        (&paper["key"], &paper["method"]),
        (&"approach_angle_driver".into(), &"paper".into())
    );
    assert_eq!(paper["derivation"][0]["formula"], "ε_e + ε_d");
    assert_eq!(paper["derivation"][0]["numbers"], "0.027207 deg + 0.025368 deg");
    assert_eq!(
        (&paper["validity"][0]["inside"], &paper["corrections"][0]["equation"]),
        (&false.into(), &"Eqs. 7-20".into())
    );
    let faster =
        json(&words("explain normal_velocity --set 'operation.speed=4000 rpm' --format json"));
    let effect = faster["sensitivity"]
        .as_array()
        .unwrap()
        .iter()
        .find(|effect| effect["key"] == "operation.speed")
        .unwrap();
    assert_eq!((&effect["text"], &effect["change"]), (&"4000 rpm".into(), &"+1.00 %".into()));
    let on_time = stdout_of(&["explain", "impact_force", "cases/tip-relief-enough.toml"]);
    assert!(on_time.contains("No value: no corner contact"), "{on_time}");
    assert!(stdout_of(&["fields", "--results"]).ends_with(
        "`tipstrike explain KEY [CASE]` shows the formula of a quantity with the numbers of a \
            case.\n"
    ));
}

#[test]
fn a_trade_recommends_a_setting_within_the_tolerance() {
    let page = stdout_of(&["trade", TABLE_1]);
    has(&page, &["Reference: dynamic with finite-element, 4096 stations and tolerance 1e-12"]);
    assert!(page.contains("\nWithin 5.0 %: dynamic with"), "{page}");
    let traded = json(&["trade", TABLE_1, "--within", "40%", "--format", "json"]);
    assert_eq!((&traded["case"], &traded["within"]), (&TABLE_1.into(), &0.4.into()));
    let recommended = &traded["recommended"];
    assert_eq!(recommended["qualifies"], true);
    assert!(recommended["total"].as_f64().unwrap() <= 0.4, "{recommended}");
    let own: Vec<&Value> = traded["settings"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|one| one["current"] == true)
        .collect();
    assert_eq!(
        (own.len(), &own[0]["method"], &own[0]["stations"]),
        (1, &"exact".into(), &64.into())
    );
}

#[test]
fn every_shell_has_completions_and_the_manual_a_name() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(stdout_of(&["completions", shell]).contains("tipstrike"), "{shell}");
    }
    let page = stdout_of(&["man"]);
    assert!(page.contains(".SH NAME\ntipstrike"), "{page}");
    assert!(page.contains(".SH \"EXIT STATUS\""), "{page}");
    assert!(stdout_of(&["man", "solve"]).contains("stations"));
}

#[test]
fn help_and_version_are_results() {
    assert!(stdout_of(&["--version"]).starts_with("tipstrike "));
    assert!(stdout_of(&["--help"]).contains("completions"));
    assert!(stdout_of(&["solve", "--help"]).contains("--only"));
}

#[test]
fn a_closed_reader_ends_the_program_without_a_message() {
    let mut child = program(&["solve", TABLE_1, "--stations", "10000", "--format", "csv"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut first).unwrap();
    assert!(first.starts_with("case,"));
    let output = child.wait_with_output().unwrap();
    assert_eq!((code(&output), err(&output).as_str()), (0, ""));
}

#[test]
#[cfg(target_os = "linux")]
fn an_output_that_cannot_be_written_is_no_success() {
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = program(&["solve", TABLE_1]).stdout(full).output().unwrap();
    assert_eq!(code(&output), 5);
    assert!(err(&output).contains("standard output"), "{}", err(&output));
}

#[test]
fn no_colour_and_no_escape_is_written_anywhere() {
    for arguments in [&["--help"][..], &["solve", "--help"], &["solve"], &["man"]] {
        let output =
            program(arguments).env("CLICOLOR_FORCE", "1").env_remove("NO_COLOR").output().unwrap();
        assert!(!(out(&output) + &err(&output)).contains('\u{1b}'), "{arguments:?}");
    }
}
