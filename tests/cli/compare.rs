//! The commands with variants, and comparisons of cases.

use std::fs;

use clap::CommandFactory;
use serde_json::Value;
use tempfile::TempDir;
use tipstrike::cli::Arguments;

use crate::program::{has, in_a_line, run, table_1_with as with};

const TABLE_1: &str = "cases/zhou-chen-2014.toml";

const VARIANTS: &str = r#"
[variants.relieved]
"driven.tip_relief" = "30 um"

[variants.slow]
operation.speed = "500 rpm"
operation.torque = "30 N m"
limits.impact_force = "900 N"

[variants.far.pair]
centre_distance = "200 mm"
"#;

fn case() -> (TempDir, String) {
    with(VARIANTS)
}

fn json(arguments: &[&str]) -> Value {
    let (code, text, errors) = run(arguments);
    assert_eq!(code, 0, "{errors}");
    serde_json::from_str(&text).unwrap()
}

#[test]
fn each_variant_equals_a_solve_with_its_overrides() {
    let (_folder, case) = case();
    let compared = json(&["compare", &case, "--format", "json"]);
    let columns = compared["columns"].as_array().unwrap();
    let names: Vec<&Value> = columns.iter().map(|column| &column["variant"]).collect();
    assert_eq!(names, [&Value::Null, &"relieved".into(), &"slow".into(), &"far".into()]);
    let of_slow = ["--set", "operation.speed=500 rpm", "--set", "operation.torque=30 N m"];
    for (column, settings) in [
        (&columns[0], &[][..]),
        (&columns[1], &["--set", "driven.tip_relief=30 um"]),
        (&columns[2], &of_slow),
    ] {
        let solved = json(&[&["solve", &case, "--format", "json"], settings].concat());
        for (key, quantity) in solved["quantities"].as_object().unwrap() {
            assert_eq!(column["quantities"][key]["value"], quantity["value"], "{key}");
        }
        assert_eq!(column["outcome"], solved["outcome"]);
    }
    let difference = &columns[1]["quantities"]["total_deviation"];
    assert!((difference["difference"].as_f64().unwrap() + 30e-6).abs() < 1e-12);
    assert_eq!(difference.get("percent"), None);
    assert!(columns[2]["quantities"]["impact_force"]["percent"].as_f64().unwrap() < 0.0);
}

/// `auto` chooses `static` for the slow variant alone.
#[test]
fn the_columns_of_auto_have_one_method() {
    let (_folder, case) = with("[variants.slow]\noperation.speed = \"100 rpm\"\n");
    let only = ["--only", "dynamic_peak_force", "--method", "auto"];
    let compared = json(&[&["compare", &case, "--format", "json"], &only[..]].concat());
    for column in compared["columns"].as_array().unwrap() {
        assert_eq!(column["method"], "dynamic");
        assert!(column["quantities"]["dynamic_peak_force"]["value"].is_f64(), "{column}");
    }
    let text = in_a_line(&run(&[&["compare", &case], &only[..]].concat()).1);
    has(&text, &["(dynamic for equal columns; alone auto takes static, as in solve)"]);
    let alone = ["solve", &case, "--variant", "slow", "--method", "auto", "--format", "json"];
    assert_eq!(json(&alone)["method"], "static");
}

#[test]
fn a_refused_variant_keeps_its_column_and_names_the_reason() {
    let (_folder, case) = case();
    let (code, text, errors) = run(&["compare", &case]);
    assert_eq!(code, 0);
    let reason = "variants.far.pair.centre_distance: the tips do not reach each other";
    assert!(errors.starts_with(&format!("{case}:66:19: {reason}")), "{errors}");
    assert!(errors.ends_with("(with --variant far)\n"), "{errors}");
    has(&text, &["Refused: pair.centre_distance"]);
    let pairs = ["cases/zhou-chen-2014.toml", "cases/tip-relief-enough.toml"];
    let text = text + &run(&[&["compare"], &pairs[..]].concat()).1;
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    let (code, text, _) = run(&["compare", &case, "--variant", "far", "--format", "csv"]);
    assert_eq!(code, 0);
    assert_eq!(text.lines().nth(2), Some("outcome,,corner-contact,refused,"));
    let refused = ["compare", &case, "--set", "pair.centre_distance=200 mm"];
    assert_eq!(run(&refused).0, 3);
}

#[test]
fn cases_and_variants_are_compared_with_differences_and_units() {
    let (_folder, case) = case();
    let only = ["--only", "F_S,total_deviation,u", "--variant", "relieved,slow"];
    for (name, format) in [("compare_text", "text"), ("compare_markdown", "md")] {
        let (_, text, _) = run(&[&["compare", &case, "--format", format], &only[..]].concat());
        insta::assert_snapshot!(name, text.replace(&case, "gear.toml"));
    }
    let relieved = "cases/tip-relief-enough.toml";
    let (code, text, _) = run(&["compare", TABLE_1, relieved, "--only", "F_S", "--format", "csv"]);
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    assert_eq!((code, &names[2..4]), (0, &[TABLE_1, relieved][..]));
}

#[test]
fn every_command_that_takes_a_case_takes_a_variant() {
    let (_folder, case) = case();
    let page = format!("{case}.md");
    let vary = "deviations.base_pitch=0..20 um";
    // The other required arguments of a command.
    let needed: &[(&str, &[&str])] = &[
        ("seek", &["--vary", vary, "--until", "impact_force<=1 kN"]),
        ("sweep", &["--vary", vary, "--points", "3"]),
        ("report", &["--out", &page]),
    ];
    let all = Arguments::command();
    let takes = |command: &&clap::Command| {
        let mut arguments = command.get_arguments();
        arguments.any(|argument| argument.get_long() == Some("variant"))
    };
    let names: Vec<&str> =
        all.get_subcommands().filter(takes).map(clap::Command::get_name).collect();
    assert!(names.len() >= 11, "{names:?}");
    for name in names {
        let before: &[&str] = if name == "explain" { &["impact_force"] } else { &[] };
        let after = needed.iter().find(|(own, _)| *own == name);
        let after = after.map_or(&[][..], |(_, arguments)| arguments);
        let wrong = ["--variant", "releived"];
        let (code, _, errors) = run(&[&[name], before, &[case.as_str()], after, &wrong].concat());
        assert!(code == 2 && errors.contains("did you mean relieved?"), "{name}: {errors}");
    }
    // A setting replaces the override of a variant.
    let set = ["--set", "driven.tip_relief=12 um", "--only", "F_S", "--format", "json"];
    let [varied, plain] = [&["--variant", "relieved"][..], &[]]
        .map(|variant| json(&[&["solve", &case][..], variant, &set].concat()));
    assert_eq!(varied["quantities"], plain["quantities"]);
    let (_, own, _) = run(&["explain", "impact_force", &case]);
    let (code, varied, _) = run(&["explain", "impact_force", &case, "--variant", "slow"]);
    assert!(code == 0 && own != varied);
    let (code, text, _) = run(&["check", &case, "--variant", "slow"]);
    assert_eq!(code, 0, "{text}");
    has(&text, &["900", "case.toml:slow"]);
    let (code, _, errors) = run(&["solve", &case, "--variant", "far"]);
    assert_eq!(code, 3);
    has(&errors, &["variants.far.pair.centre_distance", "(with --variant far)\n"]);
}

#[test]
fn a_comparison_with_nothing_or_with_an_unknown_variant_is_wrong_usage() {
    let (_folder, case) = case();
    for (arguments, words) in [
        (&["compare", TABLE_1][..], "the case has no variants"),
        (&["compare", &case, "--variant", "lsow"], "did you mean slow?"),
    ] {
        let (code, _, errors) = run(arguments);
        assert!(code == 2 && errors.contains(words), "{errors}");
    }
}

/// `static` and `dynamic` define the equivalent error without the reliefs, `exact` with them.
#[test]
fn a_column_has_the_values_and_the_definitions_of_its_own_solve() {
    let (_folder, case) = with(
        "\n[variants.rest]\nmodel.method = \"static\"\n\
        [variants.motion]\nmodel.method = \"dynamic\"\n",
    );
    let case = case.as_str();
    let text = fs::read_to_string(case).unwrap();
    fs::write(case, text.replace("tip_relief = \"0 um\"", "tip_relief = \"9 um\"")).unwrap();
    let compared = json(&["compare", case, "--format", "json"]);
    for (column, method) in
        compared["columns"].as_array().unwrap().iter().zip(["exact", "static", "dynamic"])
    {
        let solved = json(&["solve", case, "--method", method, "--format", "json"]);
        assert_eq!(column["method"], method);
        for (key, quantity) in solved["quantities"].as_object().unwrap() {
            let found = &column["quantities"][key];
            for member in ["value", "of"] {
                assert_eq!(found[member], quantity[member], "{method} {key} {member}");
            }
        }
        let error = &column["quantities"]["equivalent_error"];
        assert_eq!(error.get("difference"), None, "{method}: {error}");
    }
    let only = ["--only", "equivalent_error", "--variant", "rest,motion"];
    let shared = json(&[&["compare", case, "--format", "json"], &only[..]].concat());
    let between = &shared["columns"][2]["quantities"]["equivalent_error"];
    assert_eq!(between.get("difference"), None, "{between}");
}
