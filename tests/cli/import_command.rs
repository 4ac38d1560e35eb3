//! Imports of REXS models: values with their sources, refusals by name, limited reading.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::program::{has, program, texts};
use tipstrike::case::rexs::{Imported, import, read_document};
use tipstrike::case::sanitize::is_hidden;
use tipstrike::case::{Document, fields};
use zip::write::SimpleFileOptions;

fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/rexs").join(name)
}

fn run(arguments: &[&str]) -> (i32, String, String) {
    texts(program(arguments).current_dir(model("")).output().unwrap())
}

/// The refusal of a model, imported without a stage id.
fn refusal_of(bytes: &[u8]) -> String {
    import(Path::new("m.rexs"), bytes, None).unwrap_err()
}

fn imported(bytes: &[u8], stage: Option<&str>) -> Imported {
    import(Path::new("m.rexs"), bytes, stage).unwrap()
}

fn edited(name: &str, from: &str, to: &str) -> Vec<u8> {
    let text = fs::read_to_string(model(name)).unwrap();
    assert!(text.contains(from), "{from}");
    text.replace(from, to).into_bytes()
}

#[test]
fn a_spur_stage_becomes_a_case_with_the_source_of_each_value() {
    let (code, case, message) = run(&["import", "two-stages-1.0.rexs"]);
    insta::assert_snapshot!("import_two_stages", format!("exit {code}\n{message}\n{case}"));
    let read_back = Document::parse("case.toml", &case).unwrap();
    assert!(read_back.case.inputs().is_ok());
}

/// The values of an imported stage, in SI.
fn assert_values(document: &Document, expected: &[(&str, f64)]) {
    for &(key, expected) in expected {
        let found = document.case.value(fields::index_of(key).unwrap());
        let found = found.unwrap_or_else(|| panic!("{key} is empty"));
        assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{key}: {found}");
    }
}

#[test]
fn units_signs_and_load_cases_of_a_model_become_si_values() {
    let expected = [
        ("pair.module", 5e-3),
        ("pair.centre_distance", 0.15),
        // In the model, gear_2 is the driver.
        ("driver.teeth", 20.0),
        ("driven.teeth", 40.0),
        ("driver.bore_diameter", 0.04),
        ("driver.tip_diameter", 0.11),
        ("driver.root_diameter", 0.0875),
        ("driver.young", 205e9),
        ("driver.density", 7850.0),
        ("driver.tip_relief", 20e-6),
        // From the diameters 110 mm and 107.5 mm with d_b = 100 mm cos 20 deg.
        ("driver.tip_relief_length", 2.485297e-3),
        ("deviations.base_pitch", 16e-6),
        ("operation.power", 15e3),
        ("operation.speed", 209.43951023931953),
    ];
    assert_values(&read_document(&model("spur-2.0.rexsj")).unwrap(), &expected);
}

fn hand(document: &Document) -> Option<&str> {
    document.case.text(fields::index_of("pair.driver_hand").unwrap())
}

#[test]
fn every_public_sample_opens_solves_and_says_what_is_left_out() {
    for (name, kind) in [
        ("gearbox-1.0.rexsz", "stage 6 \"Stirnradstufe\": a helical stage (23/67 teeth, 30 deg)"),
        ("planetary-1.1.rexsz", "a spur stage of planetary_stage 9 (17/22 teeth), imported"),
        ("planetary-1.1-json.rexsz", "a spur stage of planetary_stage 9 (17/22 teeth), imported"),
    ] {
        let solve = ["solve", name, "--only", "static_peak_force", "--format", "json"];
        let (code, json, message) = run(&solve);
        assert_eq!(code, 0, "{message}");
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert!(json["method"] == "static" || name.starts_with('p'), "{json}");
        let others = "`tipstrike import --stage` imports";
        has(&message, &[kind, "driver.tip_relief", others]);
        assert!(message.lines().all(|line| line.starts_with(name)), "{message}");
    }
}

#[test]
fn a_helical_gear_train_gives_every_stage_its_hand_speed_and_torque() {
    let bytes = fs::read(model("gearbox-1.0.rexsz")).unwrap();
    let [first, second, third] = ["6", "37", "55"].map(|id| imported(&bytes, Some(id)).document);
    let (speed, torque) = (1400.0 * std::f64::consts::PI / 30.0, 4.724562306435156);
    let angle = |degrees: f64| ("pair.helix_angle", degrees.to_radians());
    let at =
        |ratio: f64| [("operation.speed", speed / ratio), ("operation.torque", torque * ratio)];
    let of_first = [angle(30.0), ("driven.profile_shift", 0.5131), ("pair.face_offset", 2.5e-3)];
    assert_values(&first, &[&of_first[..], &at(1.0)].concat());
    assert_values(&second, &[&[angle(10.0)][..], &at(67.0 / 23.0)].concat());
    assert_values(&third, &at(67.0 / 23.0 * 76.0 / 13.0));
    assert_eq!([&first, &second, &third].map(hand), [Some("right"), Some("left"), Some("right")]);
    for document in [first, second, third] {
        assert!(document.case.inputs().is_ok());
    }
}

#[test]
fn a_sun_gear_turns_relative_to_its_carrier_and_shares_its_load() {
    let imported = imported(&fs::read(model("planetary-1.1.rexsz")).unwrap(), None);
    let speed = 1500.0 * std::f64::consts::PI / 30.0 * 61.0 / 78.0;
    assert_values(
        &imported.document,
        &[("operation.speed", speed), ("operation.torque", 1591.5494309189535 / 3.0)],
    );
    assert!(imported.remarks.iter().any(|remark| remark.contains("3 planets")));
}

/// The spur model with its pinion right-handed, its wheel by `wheel`, and modifications of the
/// pinion along the face.
fn helical(wheel: &str, speed: f64) -> Vec<u8> {
    let parts = [
        ("helix_slope", "\"helix_slope\", \"floating_point\": 0.012"),
        ("helix_crowning", "\"helix_crowning_amount_datum_face\", \"floating_point\": 0.004"),
        ("end_relief_datum_face", "\"end_relief_depth_datum_face\", \"floating_point\": 0.02"),
        ("profile_crowning", "\"profile_crowning_amount\", \"floating_point\": 0.001"),
    ];
    let added = (70..).zip(parts).map(|(id, (kind, attribute))| {
        let component = format!(
            "{{\"id\": {id}, \"type\": \"{kind}\", \"attributes\": [{{\"id\": {attribute}}}]}},"
        );
        let reference = format!(
            "{{\"id\": {id}, \"type\": \"reference\", \"refs\": [{{\"id\": 15, \"role\": \"origin\"}}, \
                {{\"id\": {id}, \"role\": \"referenced\"}}]}},"
        );
        (component, reference)
    });
    let (components, references): (Vec<_>, Vec<_>) = added.unzip();
    let (components, references) = (components.concat(), references.concat());
    let text = fs::read_to_string(model("spur-2.0.rexsj")).unwrap();
    let angle = "\"helix_angle_reference_diameter\", \"unit\": \"deg\", \"floating_point\": ";
    let pinion_side = "{\"id\": \"support_vector\", \"unit\": \"mm\", \"floating_point_array\": [3.0, 0.0, 0.0]}, \
        {\"id\": \"u_axis_vector\", \"unit\": \"mm\", \"floating_point_array\": [1.0, 0.0, 0.0]}, ";
    let wheel_side = "{\"id\": \"support_vector\", \"unit\": \"mm\", \"floating_point_array\": [5.0, 150.0, 0.0]}, ";
    let pinion = "\"name\": \"Pinion\", \"attributes\": [";
    let gear = "\"name\": \"Wheel\", \"attributes\": [";
    text.replace(&format!("{angle}0.0"), &format!("{angle}15.0"))
        .replace(pinion, &format!("{pinion}{pinion_side}"))
        .replace(gear, &format!("{gear}{wheel_side}{wheel}"))
        .replacen("\"components\": [\n", &format!("\"components\": [\n{components}\n"), 1)
        .replacen("\"relations\": [\n", &format!("\"relations\": [\n{references}\n"), 1)
        .replace("\"floating_point\": 2000.0", &format!("\"floating_point\": {speed}"))
        .into_bytes()
}

fn wheel_of(angle: &str) -> String {
    format!("{{\"id\": \"helix_angle_{angle}}}, ")
}

#[test]
fn helix_angle_and_modifications_along_the_face_become_fields_by_their_side() {
    let wheel = wheel_of("reference_diameter\", \"unit\": \"deg\", \"floating_point\": -15.0");
    for (speed, offset, end, other) in [
        (2000.0, 2e-3, "driver.end_relief_minus", "driver.end_relief_plus"),
        (-2000.0, -2e-3, "driver.end_relief_plus", "driver.end_relief_minus"),
    ] {
        let imported = imported(&helical(&wheel, speed), None);
        assert_values(
            &imported.document,
            &[
                ("pair.helix_angle", 15f64.to_radians()),
                ("pair.face_offset", offset),
                ("driver.helix_slope", 12e-6),
                ("driver.crowning", 4e-6),
                (end, 20e-6),
                (other, 0.0),
            ],
        );
        assert_eq!(hand(&imported.document), Some("right"));
        assert!(imported.remarks.contains(&"left out: profile_crowning 73".to_owned()));
    }
    // sin beta_b = sin beta cos alpha_n.
    let base = (15f64.to_radians().sin() * 20f64.to_radians().cos()).asin().to_degrees();
    let text = String::from_utf8(helical(&wheel, 2000.0)).unwrap();
    let text =
        text.replace("reference_diameter", "base_diameter").replace("15.0}", &format!("{base}}}"));
    let imported = imported(text.as_bytes(), None);
    assert_values(&imported.document, &[("pair.helix_angle", 15f64.to_radians())]);
}

#[test]
fn stages_that_are_no_external_cylindrical_pair_are_refused_by_name() {
    for (angle, reason) in [
        (
            "-16.0",
            "is 15 deg, helix_angle_reference_diameter of cylindrical_gear 16 \"Wheel\" is 16 deg",
        ),
        ("15.0", "the hand of the driver by"),
    ] {
        let wheel = wheel_of(&format!(
            "reference_diameter\", \"unit\": \"deg\", \"floating_point\": {angle}"
        ));
        has(&refusal_of(&helical(&wheel, 2000.0)), &[reason]);
    }
    let spur = "spur-2.0.rexsj";
    for (name, from, to, reason) in [
        (
            spur,
            "deg\", \"floating_point\": 0.0",
            "deg\", \"floating_point\": 50.0",
            "more than 45 deg",
        ),
        ("two-stages-1.0.rexs", "\"cylindrical_stage\"", "\"bevel_stage\"", "is a bevel stage"),
        (
            spur,
            "16, \"type\": \"cylindrical_gear\"",
            "16, \"type\": \"ring_gear\"",
            "with a ring gear",
        ),
    ] {
        has(&refusal_of(&edited(name, from, to)), &[reason]);
    }
    let (_, _, message) = run(&["import", "two-stages-1.0.rexs", "--stage", "8"]);
    has(&message, &["the model has no stage \"8\""]);
    let (code, _, message) = run(&["import", "planetary-1.1.rexsz", "--stage", "9"]);
    assert_eq!(code, 3);
    has(&message, &["stage 9 \"Planetenstufe [9]\" is a planetary stage"]);
}

#[test]
fn unequal_flanks_and_load_cases_are_named_and_no_value_is_guessed() {
    let flank = "362\" name=\"\" type=\"flank_geometry\">\n      <attribute id=\"normal_pressure_angle\" \
        unit=\"°\">";
    let [own, other] = ["20.0", "25.0"].map(|angle| flank.to_owned() + angle);
    let unequal = edited("two-stages-1.0.rexs", &own, &other);
    let message = refusal_of(&unequal);
    has(&message, &["of flank_geometry 361 is 20 deg", "362 is 25 deg"]);
    let cases = edited(
        "spur-2.0.rexsj",
        "\"load_cases\": [",
        "\"load_cases\": [{\"id\": 2, \"components\": [{\"id\": 12, \"attributes\": [{\"id\": \
            \"rotational_speed\", \"unit\": \"1 / min\", \"floating_point\": 500.0}]}]}, ",
    );
    let imported = imported(&cases, None);
    let speed = imported.absent.iter().find(|(key, _)| *key == "operation.speed").unwrap();
    assert!(speed.1.contains("500 rpm in load case 2, 2000 rpm in load case 1"), "{}", speed.1);
}

#[test]
fn values_that_cannot_be_read_or_occur_twice_stay_empty_and_are_named() {
    let module = "<attribute id=\"normal_module\" unit=\"mm\">3.0</attribute>";
    let with = |value: &str| edited("two-stages-1.0.rexs", module, value);
    for (value, reason) in [
        (module.replace("3.0", "NaN"), "`NaN mm` is not a finite number"),
        (module.replace("3.0", "three"), "`three mm` does not begin with a number"),
        (module.replace("mm", "furlong"), "the unit \"furlong\" is unknown here"),
        (format!("{module}{}", module.replace("3.0", "4.0")), "\"Stirnrad pos=1\" is 3 mm, 4 mm"),
        (String::new(), "the model gives no normal_module"),
    ] {
        let imported = imported(&with(&value), None);
        let (_, found) = imported.absent.iter().find(|(key, _)| *key == "pair.module").unwrap();
        assert!(found.contains(reason), "{value}: {found}");
    }
    let twice = edited("two-stages-1.0.rexs", "component id=\"52\"", "component id=\"23\"");
    assert!(refusal_of(&twice).contains("two components have the id \"23\""));
    let rounded = edited("two-stages-1.0.rexs", "unit=\"°\">-0.0<", "unit=\"°\">1e-12<");
    assert!(import(Path::new("m.rexs"), &rounded, None).is_ok());
}

#[test]
fn entities_bombs_and_texts_of_another_kind_are_refused() {
    for cut in ["", "<a>", "</a>", "<a", "<!--", "</model>a", "</model><model/>"] {
        let text = format!("<model version=\"1.0\">{cut}");
        has(&refusal_of(text.as_bytes()), &["this is not XML"]);
    }
    let deep = "{\"model\":".to_owned() + &"[".repeat(100_000);
    let entity = b"<!DOCTYPE m [<!ENTITY a \"aaaa\">]><model version=\"1.0\">&a;</model>";
    for (bytes, reason) in [
        (&entity[..], "declares a document type"),
        (b"<model version=\"1.0\">\n &a;</model>", "m.rexs: 2:2: this is not XML"),
        (deep.as_bytes(), "in JSON"),
        (b"solid", "neither XML nor JSON"),
        (b"<model version=\"3.1\"/>", "REXS version \"3.1\""),
        (b"<model version=\"1.3\"/>", "no gear stage"),
        (b"<gear/>", "the root element is \"gear\""),
        (b"PK\x03\x04 broken", "cannot be unpacked"),
        (&zipped(&[("a.rexs", 17 << 20)]), "longer than 16 MiB unpacked"),
        (&zipped(&[("a.rexs", 9), ("b.rexs", 9)]), "has 2 models"),
        (&zipped(&[("a.txt", 9)]), "has 0 models"),
    ] {
        has(&refusal_of(bytes), &[reason]);
    }
}

/// A model in XML with this text as its components and relations.
fn with_parts(parts: &str) -> Vec<u8> {
    format!("<model version=\"1.0\">{parts}</model>").into_bytes()
}

#[test]
fn a_hostile_model_is_refused_with_its_limit_within_five_seconds() {
    let each =
        |count: usize, part: &dyn Fn(usize) -> String| -> String { (0..count).map(part).collect() };
    let nested = |count: usize| each(count, &|at| format!("<a xmlns:n{at}=\"u{at}\">"));
    let component =
        |kind: &'static str| move |at: usize| format!("<component id=\"{at}\" type=\"{kind}\"/>");
    let components = |parts: String| with_parts(&format!("<components>{parts}</components>"));
    let relations = |parts: String| with_parts(&format!("<relations>{parts}</relations>"));
    let reference = |at: usize| format!("<ref role=\"part\" id=\"{at}\"/>");
    let json =
        |parts: String| format!("{{\"model\":{{\"version\":\"1.0\",{parts}}}}}").into_bytes();
    let long = "n".repeat(10_000_000);
    let names = each(400_000, &|at| format!(" a{at}=\"\""));
    let values = "<attribute id=\"a\">1</attribute>".repeat(200_000);
    let loads = "{\"id\":1},".repeat(40_000);
    let loads = format!("{{\"load_cases\":[{{\"id\":1,\"components\":[{loads}{{\"id\":1}}]}}]}}");
    let one = format!("<relation>{}</relation>", reference(7));
    let files = b"PK\x01\x02".repeat(2000);
    for (name, bytes, limit) in [
        ("spaces.rexs", nested(8000).into_bytes(), "the root element is \"a\""),
        ("deep.rexs", with_parts(&nested(8000)), "this is not XML"),
        ("attributes.rexs", with_parts(&format!("<a {names}/>")), "no gear stage"),
        ("elements.rexs", with_parts(&"<a/>".repeat(4_000_000)), "2000000 elements"),
        ("stages.rexs", components(each(30_000, &component("cylindrical_stage"))), "200 stages"),
        ("entries.rexs", components("<component/>".repeat(1_300_000)), "250000 entries"),
        (
            "values.rexs",
            components(format!("<component id=\"1\">{values}</component>")),
            "1000 attributes of one component",
        ),
        ("relations.rexs", relations(one.repeat(60_000)), "1000 relations of one component"),
        (
            "references.rexs",
            relations(format!("<relation>{}</relation>", each(60_000, &reference))),
            "50 references of one relation",
        ),
        ("name.rexs", components(format!("<component id=\"{long}\"/>")), "1000 bytes in a name"),
        ("large.rexs", vec![b' '; 17 << 20], "longer than 16384 KiB"),
        (
            "lists.rexsj",
            json(format!("\"a\":{}", "[".repeat(1_000_000))),
            "250000 objects and lists",
        ),
        (
            "objects.rexsj",
            json(format!("\"components\":[{}[2]]", "[1],".repeat(3_000_000))),
            "250000 objects and lists",
        ),
        (
            "loads.rexsj",
            json(format!("\"load_spectrum\":{loads}")),
            "1000 load cases of one component",
        ),
        ("files.rexsz", [b"PK\x03\x04", &files[..]].concat(), "more than 1000 files"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let start = Instant::now();
        let (code, case, message) = run(&["import", path.to_str().unwrap()]);
        let time = start.elapsed();
        assert!(message.contains(limit), "{name}: {message}");
        assert_eq!((message.lines().count(), case.as_str()), (1, ""), "{name}");
        assert!(message.len() < 400, "{name}: {message}");
        assert!(code == 3 || name == "large.rexs" && code == 5, "{name}: {code}");
        assert!(time < Duration::from_secs(5), "{name}: {time:?}");
    }
}

#[test]
fn a_large_model_of_an_ordinary_kind_is_imported() {
    let table = format!("<array>{}</array>", "<c>1.0</c>".repeat(1_000_000));
    let xml = edited(
        "two-stages-1.0.rexs",
        "<component id=\"5\" name=\"RW3\" type=\"shaft\"/>",
        &format!("<component id=\"5\"><attribute id=\"t\">{table}</attribute></component>"),
    );
    assert!(import(Path::new("m.rexs"), &xml, None).is_ok());
    let table = format!("[{}1.0]", "1.0, ".repeat(2_000_000));
    let json = edited(
        "spur-2.0.rexsj",
        "\"attributes\": [",
        &format!("\"attributes\": [{{\"id\": \"t\", \"array\": {table}}}, "),
    );
    assert!(import(Path::new("m.rexsj"), &json, None).is_ok());
}

#[test]
fn the_output_has_no_hidden_character_and_the_case_keeps_its_title() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("controls.rexs");
    let bytes = edited(
        "two-stages-1.0.rexs",
        "\"Stirnradstufe\"",
        "\"&#x9b;31m \u{202e}live&#xfeff;\u{200b} \u{e0001}&#10;\\end&quot;\"",
    );
    fs::write(&path, bytes).unwrap();
    let (code, case, message) = run(&["import", path.to_str().unwrap()]);
    assert_eq!(code, 0, "{message}");
    let hidden = |text: &str| text.replace('\n', "").chars().find(|&c| is_hidden(c));
    assert_eq!((hidden(&case), hidden(&message)), (None, None));
    let read_back = Document::parse("case.toml", &case).unwrap();
    let title = read_back.case.text(fields::index_of("title").unwrap());
    let expected = "\u{9b}31m \u{202e}live\u{feff}\u{200b} \u{e0001}\n\\end\"";
    assert_eq!(title, Some(expected));
}

/// An archive of files of spaces.
fn zipped(files: &[(&str, usize)]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut archive = zip::ZipWriter::new(&mut bytes);
    for (name, length) in files {
        archive.start_file(*name, SimpleFileOptions::default()).unwrap();
        archive.write_all(&vec![b' '; *length]).unwrap();
    }
    archive.finish().unwrap();
    bytes.into_inner()
}

#[test]
fn import_writes_a_new_file_and_solve_reads_a_model_directly() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("case.toml");
    let out = out.to_str().unwrap();
    let (code, case, _) = run(&["import", "spur-2.0.rexsj", "--out", out]);
    assert_eq!((code, case.as_str()), (0, ""));
    let (again, _, message) = run(&["import", "spur-2.0.rexsj", "--out", out]);
    assert_eq!(again, 5);
    assert!(message.contains("the file exists"), "{message}");
    let quantity = ["--only", "impact_force", "--format", "csv"];
    let (_, of_case, _) = run(&[&["solve", out][..], &quantity].concat());
    let (code, of_model, message) = run(&[&["solve", "spur-2.0.rexsj"][..], &quantity].concat());
    let last = |text: &str| text.trim_end().rsplit(',').next().unwrap().to_owned();
    assert_eq!((code, last(&of_model)), (0, last(&of_case)));
    assert!(message.contains("driven.young"), "{message}");
}

#[test]
fn no_cut_or_damaged_model_stops_the_program() {
    for name in ["two-stages-1.0.rexs", "spur-2.0.rexsj", "planetary-1.1.rexsz"] {
        let whole = fs::read(model(name)).unwrap();
        for at in (0..whole.len()).step_by(whole.len() / 150) {
            drop(import(Path::new(name), &whole[..at], None));
            let mut damaged = whole.clone();
            damaged[at] = b'9';
            drop(import(Path::new(name), &damaged, None));
        }
    }
}
