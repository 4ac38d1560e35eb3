//! Tests of a case without a file.
#![expect(clippy::float_cmp, reason = "a value is read to the last bit")]

use super::fields::index_of;
use super::{Case, Document, Limit, Problem};
use crate::model::Quantity;
use crate::model::inputs::Drive;

fn field(key: &str) -> usize {
    index_of(key).unwrap()
}

fn quantity(key: &str) -> &'static Quantity {
    Quantity::find(key).unwrap()
}

fn with(changes: &[(&str, &str)]) -> Case {
    let mut case = Case::table_1();
    for (key, text) in changes {
        case.write(field(key), text);
    }
    case
}

#[track_caller]
fn only_problem(case: &Case) -> Problem {
    let problems = case.inputs().unwrap_err();
    assert_eq!(problems.len(), 1, "{problems:?}");
    problems.into_iter().next().unwrap()
}

#[test]
fn table_1_is_valid_and_in_si() {
    let inputs = Case::table_1().inputs().unwrap();
    assert_eq!((inputs.driver.teeth, inputs.driven.teeth), (20, 20));
    assert_eq!(inputs.module, 5e-3);
    assert_eq!(inputs.driver.young, 205e9);
    assert_eq!(inputs.base_pitch_deviation, 16e-6);
    assert_eq!(inputs.deflection, Some(24.7e-6));
    assert_eq!(inputs.drive, Drive::Power(15000.0));
    assert_eq!(inputs.stations, Some(64));
}

#[test]
fn defaults_replace_missing_values() {
    let mut case = Case::empty();
    for (key, text) in [
        ("pair.module", "5 mm"),
        ("driver.teeth", "20"),
        ("driver.face_width", "8 mm"),
        ("driven.teeth", "30"),
        ("driven.face_width", "8 mm"),
        ("operation.torque", "70 N m"),
        ("operation.speed", "2000 rpm"),
    ] {
        case.write(field(key), text);
    }
    let inputs = case.inputs().unwrap();
    assert_eq!(inputs.driver.young, 206e9);
    assert_eq!(inputs.driven.addendum, 1.0);
    assert_eq!(inputs.deflection, None);
    assert_eq!(inputs.drive, Drive::Torque(70.0));
    assert_eq!(case.effective(field("driver.young")), Some("206 GPa"));
    assert_eq!(case.effective(field("model.deflection")), Some("from the load"));
    assert_eq!(case.effective(field("operation.power")), None);
}

#[test]
fn the_ends_of_a_range_are_inside_in_any_unit() {
    for (key, text) in [
        ("pair.module", "0.05 mm"),
        ("pair.module", "50 um"),
        ("pair.module", "5 cm"),
        ("pair.pressure_angle", "14.5 deg"),
        ("pair.pressure_angle", "30°"),
        ("pair.pressure_angle", "870 arcmin"),
        ("driver.face_width", "1 m"),
        ("driver.profile_shift", "-0.7"),
        ("driver.poisson", "0.499"),
        ("operation.speed", "1e6 rpm"),
        ("model.stations", "10000"),
        ("driver.teeth", "5"),
    ] {
        let case = with(&[(key, text)]);
        assert_eq!(case.check_field(field(key)), Ok(()), "{key} = {text}");
    }
}

#[test]
fn a_ratio_beyond_fifty_is_refused_and_a_bore_just_below_the_root_circle_is_not() {
    let far = [("driver.teeth", "12"), ("driven.teeth", "601"), ("driver.bore_radius", "")];
    assert!(only_problem(&with(&far)).cause.contains("601/12"));
    let near = [("driver.teeth", "12"), ("driven.teeth", "600"), ("driver.bore_radius", "")];
    assert!(with(&near).inputs().is_ok());
    assert!(with(&[("driven.bore_radius", "43.7 mm")]).inputs().is_ok());
}

#[test]
fn all_problems_are_reported_in_the_order_of_the_fields() {
    let case = with(&[
        ("model.method", "exat"),
        ("pair.module", "5"),
        ("driven.teeth", "20.5"),
        ("operation.speed", ""),
    ]);
    let problems = case.inputs().unwrap_err();
    let fields: Vec<&str> = problems.iter().map(|problem| problem.field.as_str()).collect();
    assert_eq!(fields, ["pair.module", "driven.teeth", "operation.speed", "model.method"]);
    assert_eq!(problems[3].fix, "did you mean exact?");
}

#[test]
fn set_accepts_the_keys_of_the_command_line() {
    let mut case = Case::table_1();
    case.set("pair.module", "4 mm").unwrap();
    case.set("driver.profile_shift", "0.3").unwrap();
    case.set("model.method", "\"paper\"").unwrap();
    case.set("limits.impact_force", "3 kN").unwrap();
    case.set("limits.dynamic_factor", "1.5").unwrap();
    case.set("operation.torque", "70 N m").unwrap();
    case.set("model.deflection", "").unwrap();
    let inputs = case.inputs().unwrap();
    assert_eq!((inputs.module, inputs.driver.profile_shift), (4e-3, 0.3));
    assert_eq!(inputs.drive, Drive::Torque(70.0));
    assert_eq!(inputs.deflection, None);
    let limits: Vec<_> =
        case.limits.iter().map(|limit| (limit.quantity.key, limit.value)).collect();
    assert_eq!(limits, [("impact_force", 3000.0), ("dynamic_factor", 1.5)]);
}

#[test]
fn a_value_replaces_the_empty_alternative_of_a_new_file() {
    let new = Document::new(Case::empty()).render();
    let mut document = Document::parse_draft("new.toml", &new).unwrap();
    document.case.set("operation.torque", "100 N m").unwrap();
    document.case.set("pair.diametral_pitch", "5 1/in").unwrap();
    let text = document.render();
    assert!(text.contains("torque = \"100 N m\"") && text.contains("speed = \"\""), "{text}");
    assert!(!text.contains("power = \"\"") && !text.contains("module = \"\""), "{text}");
}

#[test]
fn a_relative_limit_is_saved_and_read_again() {
    let mut case = Case::table_1();
    for (quantity, text) in
        [("mesh_force", "2 x impact_force"), ("dynamic_factor", "3 x contact_ratio")]
    {
        case.set_limit(quantity, text).unwrap();
        let limit = case.limits.iter().find(|limit| limit.quantity.key == quantity).unwrap();
        assert_eq!(
            (limit.value, limit.of.map(|of| of.key)),
            (text[..1].parse().unwrap(), Some(&text[4..]))
        );
    }
    let text = Document::new(case.clone()).render();
    assert_eq!(Document::parse("case.toml", &text).unwrap().case.limits, case.limits);
}

#[test]
fn a_form_accepts_an_incomplete_limit() {
    let mut case = Case::table_1();
    case.write_limit(quantity("impact_force"), "2600");
    assert_eq!(case.limits[0].value, f64::INFINITY);
    let problem = only_problem(&case);
    assert_eq!(problem.field, "limits.impact_force");
    assert!(problem.fix.contains("\"2600 N\""), "{}", problem.fix);
    assert_eq!(case, case.clone());
    case.write_limit(quantity("impact_force"), "2600 N");
    assert_eq!((case.limits.len(), case.limits[0].value), (1, 2600.0));
    case.write_limit(quantity("normal_velocity"), "");
    assert!(case.inputs().is_ok());
    case.drop_empty(Some("normal_velocity"));
    assert_eq!(case.limits.len(), 2);
    case.drop_empty(None);
    assert_eq!(case.limits.len(), 1);
}

#[test]
fn a_limit_of_zero_needs_no_unit_and_a_written_grade_has_its_keys_as_the_fix() {
    let zeros = |known: &Quantity| ["0", " -0.0 ", "0e3"].map(|text| Limit::new(known.key, text));
    assert!(Quantity::all().flat_map(zeros).all(|limit| limit.unwrap().value == 0.0));
    let text = crate::case::EXAMPLES[0].text;
    for zero in ["0", "\"0\""] {
        let text = text.replace("\"2500 N\"", zero);
        assert_eq!(Document::parse("zero", &text).unwrap().case.limits[0].value, 0.0);
    }
    let mut case = Case::table_1();
    for (key, fix) in [
        ("deviations.base_pitch", "set driver.grade = 6 and driven.grade = 6"),
        ("driven.base_pitch", "set driven.grade = 6"),
    ] {
        assert_eq!(case.set(key, "grade 6").unwrap_err().fix, fix);
    }
}
