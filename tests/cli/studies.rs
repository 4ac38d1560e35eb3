//! The study commands: their tables, errors and files.

use std::fs;

use crate::program::{has, json, page, ran, table_1_with};
use serde_json::Value;

const TABLE_1: &str = "cases/zhou-chen-2014.toml";

/// The objects that a command prints, one per line.
fn objects(line: &str) -> Vec<Value> {
    let (_, text, _) = ran(line);
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn the_formats_of_a_relief_agree_and_the_chosen_relief_solves_without_contact() {
    let command = "relief TABLE_1 --spectrum '50%:0.6, 100%:1.4' --tolerance-length '0.2 mm'";
    let found = json(&format!("{command} --format json"));
    assert_eq!((&found["minimise"], &found["tolerance_length"]), (&"te".into(), &2e-4.into()));
    assert_eq!(found["shares"], serde_json::json!([0.3, 0.7]));
    has(&page(command), &["50%:0.3, 100%:0.7 (shares of the sum 2)"]);
    let csv = page(&format!("{command} --format csv"));
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let header = reader.headers().unwrap().clone();
    let best = reader.records().flatten().find(|record| &record[1] == "true").unwrap();
    let cell = |key: &str| {
        let at = header.iter().position(|column| column == key).unwrap();
        best[at].parse::<f64>().unwrap()
    };
    let relief = &found["relief"]["driven"];
    assert_eq!(relief["tip_relief"], cell("driven.tip_relief [m]"));
    assert_eq!(relief["begin_diameter"], cell("driven.begin_diameter [m]"));
    let shape = found["relief"]["shape"].as_str().unwrap();
    let mut case = format!("TABLE_1 --method static --set model.relief_shape={shape}");
    for (gear, key) in
        ["driver", "driven"].iter().flat_map(|gear| ["", "_length"].map(|key| (gear, key)))
    {
        let value = found["relief"][gear][format!("tip_relief{key}")].as_f64().unwrap();
        case = format!("{case} --set '{gear}.tip_relief{key}={value} m'");
    }
    let solved = json(&format!("solve {case} --format json"));
    assert_eq!(solved["outcome"], "no-corner-contact");
    has(&page(&format!("plot {case} --chart relief")), &["K-chart"]);
}

#[test]
fn a_relief_over_the_face_has_a_crowning_and_is_drawn_with_its_tolerances() {
    let search = "relief TABLE_1 --set 'pair.helix_angle=12 deg' --set model.slices=9 --load 100% \
        --set model.tooth_compliance=kuang-yang --misalignment '6 um' --minimise peak";
    let json = json(&format!("{search} --format json"));
    assert_eq!((&json["method"], &json["misalignment"]), (&"static".into(), &6e-6.into()));
    assert!(json["relief"]["driver"]["crowning"].as_f64().unwrap() > 0.0, "{json}");
    assert!(json["choices"][0]["worst_peak_line_load"].as_f64().unwrap() > 1e5, "{json}");
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("relief.svg");
    page(&format!("{search} --out {}", picture.display()));
    has(&fs::read_to_string(picture).unwrap(), &["limits of the tolerances"]);
}

#[test]
fn a_bad_option_of_a_relief_gets_its_fix() {
    for (option, value) in [
        ("--tolerance", "-5 um"),
        ("--tolerance-length", "5 mm"),
        ("--load", "-5..100%"),
        ("--spectrum", "50%"),
        ("--minimise", "noise"),
    ] {
        let (code, _, errors) = ran(&format!("relief TABLE_1 {option} '{value}'"));
        let expected = format!("error: invalid value '{value}' for '{option}");
        assert!(code == 2 && errors.starts_with(&expected), "{errors}");
    }
}

#[test]
fn a_sweep_is_a_table_with_the_varied_fields_in_their_own_units() {
    let text = page(
        "sweep TABLE_1 --vary 'operation.speed=1000..2000 rpm' --points 3 --only F_S,contact_ratio",
    );
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows[0], "operation.speed [rpm],impact_force [N],contact_ratio [1],outcome,method");
    assert_eq!(rows.len(), 4);
    for (row, start) in rows[1..].iter().zip(["1000,", "1500,", "2000,2191.0161533226"]) {
        assert!(row.starts_with(start) && row.contains(",1.55"), "{row}");
        assert!(row.ends_with(",corner-contact,exact"), "{row}");
    }
    let both = page("sweep TABLE_1 --vary 'driver.grade,driven.grade=5..6' --only total_deviation");
    let rows: Vec<&str> = both.lines().collect();
    assert!(rows[0].starts_with("driver.grade,driven.grade,total_deviation [m],"), "{both}");
    assert!(rows[1].starts_with("5,5,") && rows[2].starts_with("6,6,"), "{both}");
}

#[test]
fn a_sweep_shows_the_gap_of_no_contact_as_empty_cells() {
    let command = "sweep TABLE_1 --vary 'driven.tip_relief=0,60 um'";
    assert_eq!(page(command).lines().nth(2), Some("60,,no-corner-contact,exact"));
    let json = objects(&format!("{command} --format json"));
    assert_eq!(json[1]["outcome"], "no-corner-contact");
    assert_eq!(json[1]["quantities"], serde_json::json!({}));
    assert_eq!(json[1]["varied"]["driven.tip_relief"]["unit"], "um");
    assert_eq!(json[0]["quantities"]["impact_force"]["unit"], "N");
}

#[test]
fn refused_points_are_counted_and_named_with_those_of_one_reason_in_one_line() {
    let command = "sweep TABLE_1 --vary 'driver.bore_radius=40,50,60 mm'";
    let (code, text, errors) = ran(command);
    assert_eq!((code, text.lines().nth(2)), (0, Some("50,,refused,exact")));
    let start = "cases/zhou-chen-2014.toml: 2 of 3 points refused, the first at driver.bore_radius = 50 \
        mm: driver.bore_radius: the bore radius 50 mm is not below";
    assert!(errors.starts_with(start), "{errors}");
    let refusal = &objects(&format!("{command} --format json"))[2]["refusal"];
    assert_eq!(refusal["field"], "driver.bore_radius");
    assert!(refusal["cause"].is_string() && refusal["fix"].is_string());
    assert_eq!(ran("sweep TABLE_1 --vary 'driver.bore_radius=50,60 mm'").0, 3);
    let (code, rows, errors) = ran("sweep TABLE_1 --vary 'pair.module=0.5..5 mm' --points 200");
    let refused = rows.lines().filter(|row| row.ends_with(",refused,exact")).count();
    assert!(code == 0 && refused > 50, "{rows}");
    assert_eq!(errors.lines().count(), 1, "{errors}");
    has(&errors, &[&format!("{refused} of 200 points refused, the first at pair.module = 0.5 mm")]);
}

#[test]
fn a_bad_study_gets_place_cause_and_fix() {
    for (line, part) in [
        ("sweep operation.sped=1..2 rpm", "--vary operation.sped=1..2 rpm: unknown key"),
        ("sweep operation.speed=1..2 rpm' --points '0", "1000000 points, and not 0"),
        ("sweep operation.speed=1..2 rpm' --points 'x", "write a whole number"),
        ("sweep operation.speed=1..2 rpm' --vary 'operation.speed=3..4 rpm", "varied twice"),
        ("sweep operation.power=1..2 kW' --vary 'operation.torque=3..4 N m", "exclude"),
        ("sweep operation.speed=1..2 rpm' --set 'operation.speed=3 rpm", "--vary replaces"),
        ("sweep operation.speed=1..2 rpm' --only 'force", "unknown quantity"),
        ("sweep operation.speed=1..2 rpm' --jobs '0", "--jobs"),
        ("sweep operation.speed=1..2 rpm' --out 'TABLE_1", "choose another name"),
        (
            "seek operation.speed=1..2 rpm' --until 'impact_forc<=1 N",
            "--until impact_forc<=1 N: unknown",
        ),
        (
            "seek operation.speed=1..2 rpm' --until 'dynamic_peak_force<=1 N",
            "method exact does not compute",
        ),
    ] {
        let (command, vary) = line.split_once(' ').unwrap();
        let (code, text, errors) = ran(&format!("{command} TABLE_1 --vary '{vary}'"));
        assert_eq!((code, text.as_str()), (2, ""), "{line}: {errors}");
        assert!(errors.contains(part), "{line}: {errors}");
    }
}

#[test]
fn a_varied_field_without_effect_is_named() {
    let (code, _, errors) = ran("sweep TABLE_1 --vary model.damping_ratio=0..1 --points 2");
    assert_eq!(code, 0);
    has(&errors, &["model.damping_ratio changes no quantity: only the method dynamic"]);
    let (_, _, errors) = ran("sweep TABLE_1 --vary 'driver.base_pitch=-8..8 um' --points 3");
    has(&errors, &["of unlike sign, they add as a sum"]);
    let (_folder, case) = with_spread("\"deviations.base_pitch\" = { normal = \"4 um\" }");
    let seek =
        "seek TABLE_1 --vary 'deviations.base_pitch=0..40 um' --until 'impact_force<=2500 N'";
    let tolerance = format!("tolerance --samples 100 {case}");
    for command in [seek, tolerance.as_str()] {
        let (_, _, errors) = ran(&format!("{command} --set driver.grade=6 --set driven.grade=6"));
        has(&errors, &["deviations.base_pitch changes no quantity: "]);
    }
}

#[test]
fn a_varied_field_may_be_missing_in_the_case() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let text = fs::read_to_string(TABLE_1).unwrap();
    assert!(text.contains("speed = \"2000 rpm\"\n"));
    fs::write(&path, text.replace("speed = \"2000 rpm\"\n", "")).unwrap();
    let text = page(&format!("sweep {} --vary 'operation.speed=2000 rpm'", path.display()));
    let row = text.lines().last().unwrap();
    assert!(row.starts_with("2000,2191.0161533226"), "{text}");
    assert!(row.ends_with(",corner-contact,exact"), "{text}");
}

#[test]
fn a_file_has_the_same_bytes_as_standard_output_for_any_number_of_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rows.csv");
    let command = "sweep TABLE_1 --vary 'operation.speed=500..9000 rpm'";
    let stream = page(command);
    for jobs in ["1", "3"] {
        assert_eq!(page(&format!("{command} --jobs {jobs} --out {}", path.display())), "");
        assert_eq!(fs::read_to_string(&path).unwrap(), stream);
    }
    let missing = folder.path().join("missing/rows.csv");
    let (code, _, errors) = ran(&format!("{command} --out {}", missing.display()));
    assert!(code == 5 && errors.contains("create the folder"), "{errors}");
}

#[test]
fn a_search_prints_its_crossing_with_bracket_and_segments() {
    let command =
        "seek TABLE_1 --vary 'deviations.base_pitch=0..40 um' --until 'impact_force<=2000 N'";
    insta::assert_snapshot!("seek_zhou", page(command));
    let found = json(&format!("{command} --format json"));
    assert_eq!(found["answer"], "crossings");
    let nominal = command.replace("2000 N", "1.312039 x nominal");
    let relative = json(&format!("{nominal} --format json"));
    let at = |found: &Value| found["crossings"][0]["from"]["at"].as_f64().unwrap();
    assert!((at(&relative) / at(&found) - 1.0).abs() < 1e-3, "{relative}");
    assert_eq!((&found["unit"], &found["vary"]), (&"um".into(), &"deviations.base_pitch".into()));
    let bracket = &found["crossings"][0];
    let [from, to] = ["from", "to"].map(|end| bracket[end]["at"].as_f64().unwrap());
    assert!(from < to && to - from <= 1e-9 * to);
    assert_eq!(bracket["from"]["state"], "met");
    assert_eq!(found["segments"][1]["state"], "not-met");
    let never = page("seek TABLE_1 --vary 'driven.tip_relief=0..20 um' --until 'impact_force<9 N'");
    assert!(never.ends_with("\n  never\n"), "{never}");
}

/// Table 1 with distributions, in a temporary folder.
fn with_spread(lines: &str) -> (tempfile::TempDir, String) {
    table_1_with(&format!("\n[spread]\n{lines}\n"))
}

#[test]
fn a_tolerance_study_prints_percentiles_probabilities_and_the_ranking() {
    let (_folder, case) = with_spread(
        "\"deviations.base_pitch\" = { normal = \"3 um\" }\n\
         \"operation.speed\" = { uniform = \"50 rpm\" }\n\
         \"driven.tip_relief\" = { truncated = \"4 um\" }",
    );
    let command =
        format!("tolerance {case} --set 'driven.tip_relief=8 um' --samples 2000 --seed 7");
    let text = page(&command);
    insta::assert_snapshot!("tolerance_zhou", text);
    assert!(text.lines().all(|line| line.chars().count() <= 80));
    let found = json(&format!("{command} --format json"));
    let force = &found["quantities"]["impact_force"];
    assert_eq!((&found["solved"], &force["ranked"]), (&2000.into(), &2000.into()));
    let ranking = force["ranking"].as_array().unwrap();
    let total: f64 = ranking.iter().map(|share| share["total"]["value"].as_f64().unwrap()).sum();
    assert!((total - 1.0).abs() < 0.05, "{total}");
    let rows = page(&format!("{command} --format csv --ranking 100"));
    let header = "sample,set,deviations.base_pitch [m],operation.speed [rad/s],driven.tip_relief [m],\
        impact_force [N],outcome,method";
    assert_eq!((rows.lines().next(), rows.lines().count()), (Some(header), 1 + 2000 + 400));
}

#[test]
fn a_percentile_of_few_samples_has_no_interval() {
    let (_folder, case) = with_spread("\"deviations.base_pitch\" = { normal = \"3 um\" }");
    let of = |samples: &str| {
        let command = format!("tolerance {case} --samples {samples}");
        let text = page(&command);
        let found = json(&format!("{command} --format json"));
        let figures = &found["quantities"]["impact_force"]["figures"];
        let without = text.matches("(no 95 % interval below 59 values)").count();
        let has = ["p5", "p50", "p95"].map(|name| {
            let figure = &figures[name];
            assert!(figure["value"].is_number(), "{text}");
            figure.get("from").is_some() && figure.get("to").is_some()
        });
        (without, has)
    };
    assert_eq!(of("58"), (2, [false, true, false]));
    assert_eq!(of("59"), (0, [true, true, true]));
}

#[test]
fn a_bad_distribution_gets_place_cause_and_fix() {
    for (lines, part) in [
        ("\"title\" = { normal = \"1 um\" }", "title is not a number and has no distribution"),
        (
            "\"driven.teeth\" = { normal = 1 }",
            "`tipstrike sweep --vary 'driven.teeth=FROM..TO'` varies driven.teeth",
        ),
        (
            "\"deviations.base_pitch\" = { uniform = [\"1 um\", \"2 um\"] }",
            "this is not a distribution: write { uniform = \"1 um\" }",
        ),
        (
            "\"pair.module\" = { normal = \"1 mm\", uniform = \"1 mm\" }",
            "write { normal = \"1 mm\" }, or uniform, triangular or truncated in place of normal",
        ),
        ("\"driver.profile_shift\" = { truncated = [] }", "write { truncated = 0.01 }"),
        ("\"pair.module\" = { normal = \"0 mm\" }", "is not above 0"),
        ("\"pair.module\" = { grade = 7 }", "a grade gives a base pitch deviation"),
        ("\"deviations.base_pitch\" = { grade = 12 }", "from 1 to 11"),
        ("\"pair.module\" = { triangle = \"1 mm\" }", "did you mean triangular?"),
        ("\"deviations.backlash\" = { uniform = \"1 um\" }", "outside the field's range"),
        ("\"operation.torque\" = { uniform = \"1 N m\" }", "has no value to spread around"),
    ] {
        let (_folder, case) = with_spread(lines);
        let (code, _, errors) = ran(&format!("tolerance {case}"));
        assert_eq!(code, 3, "{lines}");
        has(&errors, &[part, "case.toml:"]);
    }
    for (options, code, part) in [
        ("", 3, "no distributions: write under [spread] a line such as"),
        ("--samples 1", 2, "write a number from 2"),
    ] {
        let (ended, _, errors) = ran(&format!("tolerance TABLE_1 {options}"));
        assert!(ended == code && errors.contains(part), "{errors}");
    }
}

#[test]
fn every_fault_of_the_distributions_is_reported_at_once() {
    let lines = "\"deviations.base_pich\" = { gauss = 1 }\n\"pair.module\" = { gauss = \"4 kg\" }";
    let (_folder, case) = with_spread(lines);
    let (_, _, errors) = ran(&format!("tolerance {case}"));
    has(&errors, &["did you mean deviations.base_pitch?", "is a unit of mass"]);
    assert_eq!(errors.matches("unknown distribution `gauss`").count(), 2, "{errors}");
}

#[test]
fn the_contact_at_the_exit_has_a_name_in_every_study() {
    let vary = "--vary 'driver.tip_relief=0..90 um'";
    let options = "--method static --set 'driven.tip_relief=80 um' --set limits.impact_force=";
    for pair in ["", "--set 'pair.helix_angle=12 deg' --set model.slices=17"] {
        let until = "--until exit_outcome=no-corner-contact --points 19 --format json";
        let found = json(&format!("seek TABLE_1 {options} {pair} {vary} {until}"));
        let least = found["crossings"][0]["to"]["at"].as_f64().unwrap();
        // The headline has the same relief, rounded up.
        let headline = page(&format!("check TABLE_1 {options} {pair}"));
        let named = headline.rsplit("; at least ").next().unwrap();
        let named: f64 = named.split(' ').next().unwrap().parse().unwrap();
        assert!(least - 0.1 < named && named < 1.005 * least + 0.1, "{named} {least}");
    }
    let rows = page(&format!("sweep TABLE_1 {options} {vary} --points 2 --only F_st,B"));
    has(
        &rows,
        &["outcome,method,exit_outcome\n", "static,corner-contact\n90,0.0,no-corner-contact"],
    );
    let (_folder, case) = with_spread("\"driver.tip_relief\" = { uniform = \"30 um\" }");
    let nominal = "--set 'driver.tip_relief=40 um' --samples 200 --format json";
    let found = json(&format!("tolerance {case} {options} {nominal}"));
    let part = found["exit_corner_contact"]["value"].as_f64().unwrap();
    assert!(0.0 < part && part < 1.0 && found["corner_contact"]["value"] == 0.0, "{found}");
}

#[test]
fn a_study_explains_a_quantity_that_its_methods_do_not_compute() {
    let (_folder, case) = with_spread("\"deviations.base_pitch\" = { normal = \"2 um\" }");
    let command = format!("tolerance {case} --samples 20 --only dynamic_peak_force");
    let reason = "method exact does not compute this quantity; dynamic and auto do";
    has(&page(&command), &[&format!("(dynamic_peak_force)\n  {reason}\n")]);
    let quantities = &json(&format!("{command} --format json"))["quantities"];
    assert_eq!(quantities["dynamic_peak_force"]["no_value"], reason);
    assert_eq!(quantities["impact_force"].get("no_value"), None);
    let sweep = "sweep TABLE_1 --vary 'deviations.base_pitch=10,20 um' --only \
        impact_force,dynamic_peak_force";
    let (code, rows, errors) = ran(sweep);
    assert!(code == 0 && rows.lines().count() == 3, "{rows}");
    assert_eq!(errors, format!("dynamic_peak_force has no values: {reason}\n"));
    let (code, _, errors) = ran(&format!("{sweep} --vary model.method=exact,dynamic"));
    assert_eq!((code, errors.as_str()), (0, ""));
}
