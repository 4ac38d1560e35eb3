//! The study commands: their tables, errors and files.

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::Command;
use std::time::Duration;

use crate::program::{program as command, run as printed, stdout_of, words};
use serde_json::Value;

const TABLE_1: &str = "cases/zhou-chen-2014.toml";

fn lines(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_relief_states_what_a_drawing_needs_and_marks_the_relief_to_specify() {
    let text = stdout_of(&["relief", "cases/mill-coarse-slow.toml", "--load", "50..100%"]);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let map = &text[text.rfind("  amount").expect("a map")..];
    assert_eq!(map.matches('*').count(), 1, "{map}");
    assert!(text.contains("Tip relief for 50 to 100 % of 35000 N m"), "{text}");
    for stated in ["C_a, um", "L_Ca, mm", "roll angle, deg", "d_Ca, mm", "shape"] {
        let line = text.lines().find(|line| line.contains(stated)).expect(stated);
        assert!(stated == "shape" || line.matches("+-").count() == 2, "{line}");
    }
}

#[test]
fn the_formats_of_a_relief_agree_and_the_chosen_relief_solves_without_contact() {
    let arguments = ["relief", TABLE_1, "--spectrum", "50%:0.3, 100%:0.7", "--tolerance-length"];
    let with = |format| stdout_of(&[&arguments[..], &["0.2 mm", "--format", format]].concat());
    let json = &lines(&with("json"))[0];
    assert_eq!((&json["minimise"], &json["tolerance_length"]), (&"te".into(), &2e-4.into()));
    assert_eq!(json["shares"], serde_json::json!([0.3, 0.7]));
    let csv = with("csv");
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let header = reader.headers().unwrap().clone();
    let best = reader.records().flatten().find(|record| &record[1] == "true").unwrap();
    let cell = |key: &str| {
        let at = header.iter().position(|column| column == key).unwrap();
        best[at].parse::<f64>().unwrap()
    };
    let relief = &json["relief"]["driven"];
    assert_eq!(relief["tip_relief"], cell("driven.tip_relief [m]"));
    assert_eq!(relief["begin_diameter"], cell("driven.begin_diameter [m]"));
    let set = |gear: &str, key: &str| {
        format!("{gear}.{key}={} m", json["relief"][gear][key].as_f64().unwrap())
    };
    let shape = format!("model.relief_shape={}", json["relief"]["shape"].as_str().unwrap());
    let mut solve = vec!["solve".to_owned(), TABLE_1.to_owned()];
    for gear in ["driver", "driven"] {
        let keys = ["tip_relief", "tip_relief_length"].map(|key| set(gear, key));
        solve.extend(keys.into_iter().flat_map(|setting| ["--set".to_owned(), setting]));
    }
    let more = ["--set", &shape, "--method", "static", "--format", "json"].map(str::to_owned);
    solve.extend(more);
    let solve: Vec<&str> = solve.iter().map(String::as_str).collect();
    assert_eq!(lines(&stdout_of(&solve))[0]["outcome"], "no-corner-contact");
    let picture = [&["plot"], &solve[1..solve.len() - 2], &["--chart", "relief"]].concat();
    assert!(stdout_of(&picture).contains("K-chart"));
}

#[test]
fn a_relief_over_the_face_has_a_crowning_and_is_drawn_with_its_tolerances() {
    let search = format!(
        "relief {TABLE_1} --set 'pair.helix_angle=12 deg' --set model.slices=9 --load 100% --set \
         model.tooth_compliance=kuang-yang --misalignment '6 um' --minimise peak"
    );
    let text = stdout_of(&words(&search));
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    for stated in ["misalignment +-6 um", "  crowning C_b, um", "peak line load, N/mm"] {
        assert!(text.contains(stated), "{stated}: {text}");
    }
    let json = &lines(&stdout_of(&words(&format!("{search} --format json"))))[0];
    assert_eq!((&json["method"], &json["misalignment"]), (&"static".into(), &6e-6.into()));
    assert!(json["relief"]["driver"]["crowning"].as_f64().unwrap() > 0.0, "{json}");
    assert!(json["choices"][0]["worst_peak_line_load"].as_f64().unwrap() > 1e5, "{json}");
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("relief.svg");
    stdout_of(&words(&format!("{search} --out {}", picture.display())));
    assert!(fs::read_to_string(picture).unwrap().contains("driven gear, tolerance"));
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
        let (code, _, errors) = printed(&["relief", TABLE_1, option, value]);
        let expected = format!("error: invalid value '{value}' for '{option}");
        assert!(code == 2 && errors.starts_with(&expected), "{errors}");
    }
}

#[test]
fn a_sweep_is_a_table_with_the_varied_fields_in_their_own_units() {
    let text = stdout_of(&words(&format!(
        "sweep {TABLE_1} --vary 'operation.speed=1000..2000 rpm' --points 3 --only F_S,contact_ratio"
    )));
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows[0], "operation.speed [rpm],impact_force [N],contact_ratio [1],outcome");
    assert_eq!(rows.len(), 4);
    assert!(rows[1].starts_with("1000,") && rows[2].starts_with("1500,"));
    assert!(rows[3].starts_with("2000,2191.0161533226"), "{text}");
    assert!(rows[3].contains(",1.55"), "{text}");
    assert!(rows[3].ends_with(",corner-contact"));
}

#[test]
fn a_sweep_shows_the_gap_of_no_contact_as_empty_cells() {
    let arguments = ["sweep", TABLE_1, "--vary", "driven.tip_relief=0,60 um"];
    let text = stdout_of(&arguments);
    assert_eq!(text.lines().nth(2), Some("60,,no-corner-contact"));
    let json = lines(&stdout_of(&[&arguments[..], &["--format", "json"]].concat()));
    assert_eq!(json[1]["outcome"], "no-corner-contact");
    assert_eq!(json[1]["quantities"], serde_json::json!({}));
    assert_eq!(json[1]["varied"]["driven.tip_relief"]["unit"], "um");
    assert_eq!(json[0]["quantities"]["impact_force"]["unit"], "N");
}

#[test]
fn refused_points_are_counted_and_named() {
    let arguments = ["sweep", TABLE_1, "--vary", "driver.bore_radius=40,50,60 mm"];
    let (code, text, errors) = printed(&arguments);
    assert_eq!(code, 0);
    assert_eq!(text.lines().nth(2), Some("50,,refused"));
    assert!(
        errors.starts_with(
            "cases/zhou-chen-2014.toml: 2 of 3 points refused, the first at \
             driver.bore_radius = 50 mm: driver.bore_radius: the bore radius 50 mm is not below"
        ),
        "{errors}"
    );
    let (_, text, _) = printed(&[&arguments[..], &["--format", "json"]].concat());
    let refusal = &lines(&text)[2]["refusal"];
    assert_eq!(refusal["field"], "driver.bore_radius");
    assert!(refusal["cause"].is_string() && refusal["fix"].is_string());
    let (code, _, _) = printed(&["sweep", TABLE_1, "--vary", "driver.bore_radius=50,60 mm"]);
    assert_eq!(code, 3);
}

#[test]
fn a_bad_sweep_gets_place_cause_and_fix() {
    let vary = |text: &'static str| vec!["sweep", TABLE_1, "--vary", text];
    let with = |text, more: &[&'static str]| [vary(text).as_slice(), more].concat();
    for (arguments, part) in [
        (vary("operation.sped=1..2 rpm"), "--vary operation.sped=1..2 rpm: unknown key"),
        (vary("operation.speed=30..5 rpm"), "the range is reversed: 30 rpm is above 5 rpm"),
        (vary("title=a..b"), "title is a text"),
        (vary("driven.tip_relief=-5..5 um"), "below the limit of 0 um"),
        (with("operation.speed=1..2 rpm", &["--points", "0"]), "1000000 points, and not 0"),
        (with("operation.speed=1..2 rpm", &["--points", "x"]), "write a whole number"),
        (with("operation.speed=1..2 rpm", &["--vary", "operation.speed=3..4 rpm"]), "varied twice"),
        (with("operation.power=1..2 kW", &["--vary", "operation.torque=3..4 N m"]), "exclude"),
        (with("operation.speed=1..2 rpm", &["--set", "operation.speed=3 rpm"]), "--vary replaces"),
        (with("operation.speed=1..2 rpm", &["--only", "force"]), "unknown quantity"),
        (with("operation.speed=1..2 rpm", &["--jobs", "0"]), "--jobs"),
        (with("operation.speed=1..2 rpm", &["--out", TABLE_1]), "choose another name"),
    ] {
        let (code, text, errors) = printed(&arguments);
        assert_eq!((code, text.as_str()), (2, ""), "{arguments:?}: {errors}");
        assert!(errors.contains(part), "{arguments:?}: {errors}");
    }
}

#[test]
fn a_varied_field_without_effect_is_named() {
    let arguments = ["sweep", TABLE_1, "--vary", "model.damping_ratio=0..1", "--points", "2"];
    let (code, _, errors) = printed(&arguments);
    assert_eq!(code, 0);
    assert!(errors.contains("model.damping_ratio changes no quantity: only the method dynamic"));
}

#[test]
fn a_varied_field_may_be_missing_in_the_case() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let text = fs::read_to_string(TABLE_1).unwrap();
    assert!(text.contains("speed = \"2000 rpm\"\n"));
    fs::write(&path, text.replace("speed = \"2000 rpm\"\n", "")).unwrap();
    let arguments = ["sweep", path.to_str().unwrap(), "--vary", "operation.speed=2000 rpm"];
    let text = stdout_of(&arguments);
    let row = text.lines().last().unwrap();
    assert!(row.starts_with("2000,2191.0161533226"), "{text}");
    assert!(row.ends_with(",corner-contact"), "{text}");
}

#[test]
fn a_file_has_the_same_bytes_as_standard_output_for_any_number_of_jobs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rows.csv");
    let arguments = ["sweep", TABLE_1, "--vary", "operation.speed=500..9000 rpm"];
    let stream = stdout_of(&arguments);
    for jobs in ["1", "3"] {
        let to_file = ["--jobs", jobs, "--out", path.to_str().unwrap()];
        assert_eq!(stdout_of(&[&arguments[..], &to_file].concat()), "");
        assert_eq!(fs::read_to_string(&path).unwrap(), stream);
    }
    let missing = folder.path().join("missing/rows.csv");
    let to_nowhere = ["--out", missing.to_str().unwrap()];
    let (code, _, errors) = printed(&[&arguments[..], &to_nowhere].concat());
    assert!(code == 5 && errors.contains("create the folder"), "{errors}");
}

#[test]
fn ctrl_c_ends_a_study_and_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("rows.csv");
    let mut child = command(&["sweep", TABLE_1, "--method", "dynamic", "--points", "1000000"])
        .args(["--vary", "operation.speed=500..9000 rpm", "--out"])
        .arg(&path)
        .spawn()
        .unwrap();
    // The temporary file shows that the study is running.
    while fs::read_dir(folder.path()).unwrap().next().is_none() {
        std::thread::sleep(Duration::from_millis(5));
        assert!(child.try_wait().unwrap().is_none());
    }
    std::thread::sleep(Duration::from_millis(100));
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert!(sent.success());
    assert_eq!(child.wait().unwrap().signal(), Some(2));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_search_prints_its_crossing_with_bracket_and_segments() {
    let arguments = [
        "seek",
        TABLE_1,
        "--vary",
        "deviations.base_pitch=0..40 um",
        "--until",
        "impact_force<=2000 N",
    ];
    let text = stdout_of(&arguments);
    insta::assert_snapshot!("seek_zhou", text);
    let found = &lines(&stdout_of(&[&arguments[..], &["--format", "json"]].concat()))[0];
    assert_eq!(found["answer"], "crossings");
    assert_eq!((&found["unit"], &found["vary"]), (&"um".into(), &"deviations.base_pitch".into()));
    let bracket = &found["crossings"][0];
    let [from, to] = ["from", "to"].map(|end| bracket[end]["at"].as_f64().unwrap());
    assert!(from < to && to - from <= 1e-9 * to);
    assert_eq!(bracket["from"]["state"], "met");
    assert_eq!(found["segments"][1]["state"], "not-met");
    let never = ["--vary", "driven.tip_relief=0..20 um", "--until", "impact_force<9 N"];
    assert!(stdout_of(&[&["seek", TABLE_1], &never[..]].concat()).ends_with("\n  never\n"));
}

#[test]
fn a_bad_search_gets_place_cause_and_fix() {
    for (vary, until, part) in [
        ("operation.speed=1..2 rpm", "impact_forc<=1 N", "--until impact_forc<=1 N: unknown"),
        ("operation.speed=1..2 rpm", "dynamic_peak_force<=1 N", "method exact does not compute"),
        ("operation.speed=1,2 rpm", "impact_force<=1 N", "this is not a range"),
        ("driver.teeth=18..30", "impact_force<=1 N", "use sweep --vary 'driver.teeth=18..30'"),
    ] {
        let (code, _, errors) = printed(&["seek", TABLE_1, "--vary", vary, "--until", until]);
        assert!(code == 2 && errors.contains(part), "{vary} {until}: {errors}");
    }
}

/// Table 1 with distributions, in a temporary folder.
fn with_spread(lines: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let text = fs::read_to_string(TABLE_1).unwrap();
    fs::write(&path, format!("{text}\n[spread]\n{lines}\n")).unwrap();
    let path = path.to_str().unwrap().to_owned();
    (folder, path)
}

#[test]
fn a_tolerance_study_prints_percentiles_probabilities_and_the_ranking() {
    let (_folder, case) = with_spread(
        "\"deviations.base_pitch\" = { normal = \"3 um\" }\n\
         \"operation.speed\" = { uniform = \"50 rpm\" }\n\
         \"driven.tip_relief\" = { truncated = \"4 um\" }",
    );
    let arguments =
        ["tolerance", &case, "--set", "driven.tip_relief=8 um", "--samples", "2000", "--seed", "7"];
    let text = stdout_of(&arguments);
    insta::assert_snapshot!("tolerance_zhou", text);
    assert!(text.lines().all(|line| line.chars().count() <= 80));
    let found = &lines(&stdout_of(&[&arguments[..], &["--format", "json"]].concat()))[0];
    let force = &found["quantities"]["impact_force"];
    assert_eq!((&found["solved"], &force["ranked"]), (&2000.into(), &2000.into()));
    let ranking = force["ranking"].as_array().unwrap();
    let total: f64 = ranking.iter().map(|share| share["total"]["value"].as_f64().unwrap()).sum();
    assert!((total - 1.0).abs() < 0.05, "{total}");
    let rows = stdout_of(&[&arguments[..], &["--format", "csv", "--ranking", "100"]].concat());
    assert_eq!(
        rows.lines().next(),
        Some(
            "sample,set,deviations.base_pitch [m],operation.speed [rad/s],driven.tip_relief [m],\
             impact_force [N],outcome"
        )
    );
    assert_eq!(rows.lines().count(), 1 + 2000 + 400);
}

#[test]
fn a_percentile_of_few_samples_has_no_interval() {
    let (_folder, case) = with_spread("\"deviations.base_pitch\" = { normal = \"3 um\" }");
    let of = |samples: &str| {
        let arguments = ["tolerance", &case, "--samples", samples];
        let text = stdout_of(&arguments);
        let json = stdout_of(&[&arguments[..], &["--format", "json"]].concat());
        let figures = lines(&json)[0]["quantities"]["impact_force"]["figures"].clone();
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
    for (lines, code, part) in [
        ("\"title\" = { normal = \"1 um\" }", 3, "title is not a number and has no distribution"),
        (
            "\"driven.teeth\" = { normal = 1 }",
            3,
            "`tipstrike sweep --vary 'driven.teeth=FROM..TO'` varies driven.teeth",
        ),
        (
            "\"deviations.base_pitch\" = { uniform = [\"1 um\", \"2 um\"] }",
            3,
            "this is not a distribution: write { uniform = \"1 um\" }",
        ),
        (
            "\"pair.module\" = { normal = \"1 mm\", uniform = \"1 mm\" }",
            3,
            "write { normal = \"1 mm\" }, or uniform, triangular or truncated in place of normal",
        ),
        ("\"driver.profile_shift\" = { truncated = [] }", 3, "write { truncated = 0.01 }"),
        ("\"pair.module\" = { normal = \"0 mm\" }", 3, "is not above 0"),
        ("\"pair.module\" = { grade = 7 }", 3, "a grade gives a base pitch deviation"),
        ("\"deviations.base_pitch\" = { grade = 12 }", 3, "from 1 to 11"),
        ("\"pair.module\" = { triangle = \"1 mm\" }", 3, "did you mean triangular?"),
        ("\"driven.tip_relief\" = { uniform = \"1 um\" }", 3, "outside the field's range"),
        ("\"operation.torque\" = { uniform = \"1 N m\" }", 3, "has no value to spread around"),
    ] {
        let (_folder, case) = with_spread(lines);
        let (ended, _, errors) = printed(&["tolerance", &case]);
        assert!(ended == code && errors.contains(part), "{lines}: {errors}");
        assert!(errors.contains("case.toml:"), "{errors}");
    }
    let (code, _, errors) = printed(&["tolerance", TABLE_1]);
    assert!(
        code == 3 && errors.contains("no distributions: write under [spread] a line such as"),
        "{errors}"
    );
    let (code, _, errors) = printed(&["tolerance", TABLE_1, "--samples", "1"]);
    assert!(code == 2 && errors.contains("write a number from 2"), "{errors}");
}

#[test]
fn a_tolerance_study_explains_a_quantity_that_its_method_does_not_compute() {
    let (_folder, case) = with_spread("\"deviations.base_pitch\" = { normal = \"2 um\" }");
    let arguments = ["tolerance", &case, "--samples", "20", "--only", "dynamic_peak_force"];
    let reason = "method exact does not compute this quantity; dynamic and auto do";
    let text = stdout_of(&arguments);
    assert!(text.contains(&format!("(dynamic_peak_force)\n  {reason}\n")), "{text}");
    let found = &lines(&stdout_of(&[&arguments[..], &["--format", "json"]].concat()))[0];
    let quantities = &found["quantities"];
    assert_eq!(quantities["dynamic_peak_force"]["no_value"], reason);
    assert_eq!(quantities["impact_force"].get("no_value"), None);
}

#[test]
fn a_sweep_explains_a_column_that_its_methods_do_not_compute() {
    let vary = ["sweep", TABLE_1, "--vary", "deviations.base_pitch=10,20 um"];
    let only = ["--only", "impact_force,dynamic_peak_force"];
    let (code, rows, errors) = printed(&[&vary[..], &only].concat());
    assert!(code == 0 && rows.lines().count() == 3, "{rows}");
    assert_eq!(
        errors,
        "dynamic_peak_force has no values: method exact does not compute this quantity; dynamic \
         and auto do\n"
    );
    let methods = ["--vary", "model.method=exact,dynamic"];
    let (code, _, errors) = printed(&[&vary[..], &only, &methods].concat());
    assert_eq!((code, errors.as_str()), (0, ""));
}

#[test]
fn refused_points_with_one_reason_share_one_line() {
    let vary = ["--vary", "pair.module=0.5..5 mm", "--points", "200"];
    let (code, rows, errors) = printed(&[&["sweep", TABLE_1][..], &vary].concat());
    let refused = rows.lines().filter(|row| row.ends_with("refused")).count();
    assert!(code == 0 && refused > 50, "{rows}");
    assert_eq!(errors.lines().count(), 1, "{errors}");
    let start =
        format!("{TABLE_1}: {refused} of 200 points refused, the first at pair.module = 0.5 mm");
    assert!(errors.starts_with(&start), "{errors}");
}

#[test]
fn a_search_and_a_tolerance_say_that_a_varied_field_changes_nothing() {
    let graded = ["--set", "driver.grade=6", "--set", "driven.grade=6"];
    let seek =
        ["seek", "--vary", "deviations.base_pitch=0..40 um", "--until", "impact_force<=2500 N"];
    let (_folder, spread) = with_spread("\"deviations.base_pitch\" = { normal = \"4 um\" }");
    let tolerance = ["tolerance", "--samples", "100", &spread];
    for command in [&[&seek[..], &[TABLE_1]].concat()[..], &tolerance] {
        let (_, _, errors) = printed(&[command, &graded].concat());
        assert!(errors.contains("deviations.base_pitch changes no quantity: "), "{errors}");
    }
}
