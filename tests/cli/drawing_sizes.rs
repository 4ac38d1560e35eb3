//! Sizes from drawings: diametral pitch, tip and root diameters instead of module, addendum and
//! dedendum coefficients.
use std::fs;

use crate::program::{has, json, page, program, ran, texts};
use serde_json::Value;
use tipstrike::case::fields::index_of;
use tipstrike::case::{Case, Document, FIELDS};

const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");

/// Table 1 with a diametral pitch of 8 and the circles of standard teeth of this size.
fn drawing() -> String {
    let text = TABLE_1
        .replace("module = \"5 mm\"", "diametral_pitch = \"8 1/in\"")
        .replace("bore_radius = \"20 mm\"", "bore_radius = \"0.5 in\"");
    let diameters = "tip_diameter = \"2.75 in\"\nroot_diameter = \"2.1875 in\"\n";
    text.replace("addendum = 1.0\n", diameters)
}

/// The exit code and the outputs of a run beside the file `case.toml`.
fn run(case: &str, arguments: &[&str]) -> (i32, String, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), case).unwrap();
    texts(program(arguments).current_dir(folder.path()).output().unwrap())
}

#[test]
fn a_case_from_a_drawing_has_the_results_of_its_coefficients() {
    let coefficients = TABLE_1
        .replace("module = \"5 mm\"", "module = \"0.125 in\"")
        .replace("bore_radius = \"20 mm\"", "bore_radius = \"0.5 in\"");
    for method in ["paper", "exact", "static"] {
        let solve = ["solve", "case.toml", "--format", "json", "--method", method];
        let [own, expected] = [&drawing(), &coefficients].map(|case| {
            let (_, text, errors) = run(case, &solve);
            assert_eq!(errors, "");
            serde_json::from_str::<Value>(&text).unwrap()["quantities"].take()
        });
        let expected = expected.as_object().unwrap();
        assert_eq!(own.as_object().unwrap().len(), expected.len());
        for (key, quantity) in expected {
            let (own, expected) = (&own[key]["value"], &quantity["value"]);
            let Some(number) = expected.as_f64() else {
                assert_eq!(own, expected, "{key}");
                continue;
            };
            let off = (own.as_f64().unwrap() - number).abs();
            assert!(off <= 1e-9 * number.abs(), "{method}, {key}: {own}, not {number}");
        }
    }
}

#[test]
fn both_ways_to_give_one_size_are_refused_at_the_second() {
    for (from, to, message) in [
        (
            "[driver]\n",
            "[driver]\ntip_diameter = \"110 mm\"\n",
            "driver.tip_diameter: driver.addendum and driver.tip_diameter are both given: remove one",
        ),
        ("[pair]\n", "[pair]\ndiametral_pitch = \"8 1/in\"\n", "are both given: remove one"),
        ("module = \"5 mm\"\n", "", "neither pair.module nor pair.diametral_pitch is given"),
    ] {
        has(&run(&TABLE_1.replace(from, to), &["solve", "case.toml"]).2, &[message]);
    }
}

#[test]
fn a_diameter_beyond_the_range_of_its_coefficient_is_refused_with_the_range() {
    for (key, diameter, message) in [
        (
            "driver.tip_diameter",
            "130 mm",
            "130 mm gives the addendum coefficient 3.000, above the limit of 2: \
             write a diameter from 101 to 120 mm",
        ),
        (
            "driven.root_diameter",
            "99 mm",
            "99 mm gives the dedendum coefficient 0.1000, below the limit of 0.5: \
             write a diameter from 80 to 95 mm",
        ),
        ("driver.root_diameter", "3 in", "gives the dedendum coefficient"),
    ] {
        let (code, _, found) = ran(&format!("solve TABLE_1 --set '{key}={diameter}'"));
        assert!(code == 3 && found.contains(key) && found.contains(message), "{found}");
    }
    let sweep = "sweep TABLE_1 --vary 'driven.tip_diameter=110,";
    let rows = ran(&format!("{sweep}130 mm' --only contact_ratio")).1;
    let last = rows.lines().last().unwrap();
    assert!(last.starts_with("130,") && last.contains("refused"), "{rows}");
    let errors = ran(&format!("{sweep}120 mm'")).2;
    has(&errors, &["at driven.tip_diameter = 120 mm: driven.tip_diameter: interference"]);
}

#[test]
fn a_setting_replaces_its_alternative_and_a_sweep_varies_it() {
    let with = |set: &str| {
        let solve = format!("solve TABLE_1 --only contact_ratio --format json --set '{set}'");
        json(&solve)["quantities"]["contact_ratio"]["value"].as_f64().unwrap()
    };
    assert!((with("driven.tip_diameter=109 mm") - with("driven.addendum=0.9")).abs() < 1e-12);
    let sweep = "sweep TABLE_1 --vary 'driven.tip_diameter=109..110 mm' --points 2";
    let rows = page(&format!("{sweep} --only contact_ratio"));
    let first: f64 = rows.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((first - with("driven.addendum=0.9")).abs() < 1e-12, "{rows}");
    let both = "sweep TABLE_1 --vary 'pair.module=4..5 mm' --set 'pair.diametral_pitch=8 1/in'";
    has(&ran(both).2, &["--vary replaces this value"]);
}

#[test]
fn saving_keeps_the_size_that_the_user_wrote() {
    let mut document = Document::parse("case.toml", drawing()).unwrap();
    document.case.set("driver.teeth", "20").unwrap();
    assert_eq!(document.render(), drawing());
    document.case.set("driver.addendum", "0.9").unwrap();
    let text = document.render();
    assert_eq!(text.matches("tip_diameter").count(), 1, "{text}");
    let read = Document::parse("case.toml", &text).unwrap().case;
    assert_eq!(read, document.case);
}

#[test]
fn the_page_of_a_quantity_shows_the_coefficient_that_a_diameter_gives() {
    let (_, page, _) = run(&drawing(), &["explain", "contact_ratio", "case.toml"]);
    has(&page, &["driver.tip_diameter", "2.75 in", "3.175 mm"]);
    assert!(!page.contains("driver.addendum "), "{page}");
}

#[test]
fn a_value_follows_from_each_alternative() {
    let drawn = Document::parse("case.toml", drawing()).unwrap().case;
    let derived =
        |case: &Case, key: &str| case.derived(index_of(key).unwrap(), &case.inputs().unwrap());
    let table_1 = Case::table_1();
    for (case, key, expected) in [
        (&drawn, "pair.module", 3.175e-3),
        (&drawn, "driver.addendum", 1.0),
        (&drawn, "driven.dedendum", 1.25),
        (&table_1, "pair.diametral_pitch", 200.0),
        (&table_1, "driver.tip_diameter", 0.11),
        (&table_1, "driven.root_diameter", 0.0875),
    ] {
        let found = derived(case, key).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-12, "{key}: {found}");
    }
    assert_eq!(derived(&drawn, "pair.diametral_pitch"), None, "it is given");
    for field in &FIELDS {
        let other = field.partner().map(|other| &FIELDS[other]);
        assert!(other.is_none_or(|other| other.alternative == Some(field.key)));
    }
}
