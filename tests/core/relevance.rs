//! The relevance of each field in the form agrees with the effect of the field in the model.
use std::collections::BTreeSet;

use tipstrike::case::fields::{Field, Kind, index_of};
use tipstrike::case::{Acting, Case, EXAMPLES, FIELDS, relevance};
use tipstrike::model::{self, QUANTITIES, Solution, Stage, Stages};

/// Every case in `cases/`, and Table 1 with the fields that these omit, so that every field can
/// have an effect.
fn samples() -> Vec<Case> {
    let mut found: Vec<Case> = EXAMPLES.iter().map(|example| example.document().case).collect();
    let changed = |changes: &[(&str, &str)]| {
        let mut case = Case::table_1();
        for (key, text) in changes {
            case.set(key, text).expect("a change that fits");
        }
        case
    };
    let relieved = [
        ("driver.tip_relief", "10 um"),
        ("driver.root_relief", "4 um"),
        ("driven.tip_relief", "5 um"),
        ("driven.root_relief", "3 um"),
        ("driver.tip_relief_length", "3 mm"),
        ("driven.tip_relief_length", "3 mm"),
    ];
    let (computed, radius) = (("model.deflection", ""), ("driven.tip_radius", "0.4 mm"));
    let (free, friction) =
        (("model.tooth_compliance", ""), ("operation.friction_coefficient", "0.06"));
    let (beam, weber) = (("model.tooth_compliance", "beam"), ("model.contact_compliance", "weber"));
    let (other, torque) = (("driver.tip_radius", "0.4 mm"), ("operation.torque", "70 N m"));
    let (auto, constant) = (("model.stations", "auto"), ("model.contact_compliance", "constant"));
    found.extend([
        changed(&[computed, free, friction]),
        changed(&[beam, weber, computed]),
        changed(&[radius, other, torque]),
        changed(&[&relieved[..], &[("pair.centre_distance", "100.2 mm")]].concat()),
        changed(&[auto, constant, radius]),
    ]);
    found
}

/// Other texts for the field: near its value, and across its range.
fn others(field: &Field, index: usize, case: &Case) -> Vec<String> {
    match field.kind {
        Kind::Text => vec!["other words".to_owned()],
        Kind::List(_) => vec!["0.1, 0.2".to_owned()],
        Kind::Choice(names, _) => names.iter().map(|name| (*name).to_owned()).collect(),
        Kind::Count(from, to, _) if case.effective(index).is_none_or(|now| now == "none") => {
            [from, to].map(|count| count.to_string()).into()
        }
        Kind::Count(..) => {
            [1, 10, -1].into_iter().filter_map(|by| case.stepped(index, by)).collect()
        }
        Kind::Number(_, range, _) => {
            let factor = tipstrike::case::units::factor(range.unit).unwrap();
            let derived = || case.derived(index, &case.inputs().ok()?);
            let now = case.value(index).or_else(derived);
            let near = [1.02, 0.98, 1.3].map(|times| now.map(|value| value / factor * times));
            let across = [0.0, 1e-5, 1e-3, 0.02, 0.3, 0.5005]
                .map(|part| Some(range.from + (range.to - range.from) * part));
            let text = |value: f64| format!("{value} {}", range.unit).trim_end().to_owned();
            near.into_iter()
                .chain(across)
                .flatten()
                .filter(|value| (range.from..=range.to).contains(value))
                .map(text)
                .collect()
        }
    }
}

/// Solves every stage of the method except the motion in time, which is slow.
fn solve(case: &Case) -> Option<Solution> {
    let shares = case.inputs().ok()?.method.shares_load();
    let wanted = if shares { Stages::of(Stage::Static).and(Stages::ALL) } else { Stages::ALL };
    model::solve(&case.inputs().ok()?, wanted).ok()
}

/// Every quantity to the last bit, and every station.
fn results(solution: &Solution) -> (Vec<Option<u64>>, String) {
    let quantities =
        QUANTITIES.iter().map(|quantity| (quantity.value)(solution).map(f64::to_bits)).collect();
    (quantities, format!("{:?} {:?}", solution.outcome, solution.stations))
}

/// Compares the relevance of every field of every sample, optionally of the idle ones only, with
/// the model by one method. Returns the fields reported as relevant, and those with an effect.
fn hold(
    method: &str,
    samples: &[Case],
    but_idle: bool,
) -> (BTreeSet<&'static str>, BTreeSet<&'static str>) {
    let (mut said, mut found) = (BTreeSet::new(), BTreeSet::new());
    for case in samples {
        let mut case = case.clone();
        case.set("model.method", method).unwrap();
        let (Ok(inputs), Some(before)) = (case.inputs(), solve(&case)) else { continue };
        for (index, field) in FIELDS.iter().enumerate() {
            let acting = relevance(index, &inputs);
            if acting == Acting::Yes {
                said.insert(field.key);
            }
            if acting == Acting::Yes && (but_idle || found.contains(field.key)) {
                continue;
            }
            for text in others(field, index, &case) {
                let mut changed = case.clone();
                if changed.set(field.key, &text).is_err() {
                    continue;
                }
                let after = solve(&changed);
                // A refusal by the method is an effect, too.
                if after.is_none() && acting == Acting::Yes && changed.inputs().is_ok() {
                    found.insert(field.key);
                }
                if after.is_none_or(|after| results(&after) == results(&before)) {
                    continue;
                }
                found.insert(field.key);
                let given = case.text(index).is_some();
                assert!(acting == Acting::Yes || !given, "{method} {} {acting:?}", field.key);
            }
        }
    }
    (said, found)
}

#[test]
fn the_relevant_fields_are_those_that_change_a_result() {
    for method in ["paper", "exact"] {
        let (said, found) = hold(method, &samples(), false);
        let idle: Vec<_> = said.difference(&found).collect();
        assert!(idle.is_empty(), "{method} {idle:?}");
        let more: Vec<_> = found.difference(&said).collect();
        assert!(more.is_empty(), "method {method}: reported as idle, but has an effect: {more:?}");
    }
}

#[test]
fn an_idle_field_changes_no_result_of_a_shared_load() {
    let mut few = Case::table_1();
    few.set("model.stations", "4").unwrap();
    hold("static", &[few], true);
}

#[test]
fn each_method_has_its_idle_fields() {
    let idle = |method: &str, key: &str| {
        let mut case = Case::table_1();
        case.set("model.method", method).unwrap();
        relevance(index_of(key).unwrap(), &case.inputs().unwrap()) != Acting::Yes
    };
    for (key, methods) in [
        ("driver.tip_relief", &["paper", "exact"][..]),
        ("driven.tip_relief", &[]),
        ("driver.tip_relief_length", &["paper", "exact"]),
        ("model.deflection", &["static", "dynamic"]),
        ("model.damping_ratio", &["paper", "exact", "static"]),
        ("model.within", &["paper", "exact", "static", "dynamic"]),
        ("operation.friction_coefficient", &["paper", "exact"]),
        ("driver.density", &[]),
    ] {
        let mut found = vec!["paper", "exact", "static", "dynamic", "auto"];
        found.retain(|method| idle(method, key));
        assert_eq!(found, methods, "{key}");
    }
}

#[test]
fn an_invalid_case_is_described_as_far_as_it_can_be_read() {
    let mut case = Case::table_1();
    case.write(index_of("pair.module").unwrap(), "five");
    let inputs = case.read().0;
    assert!(matches!(relevance(index_of("driver.tip_relief").unwrap(), &inputs), Acting::No(_)));
    assert_eq!(relevance(index_of("driven.tip_relief").unwrap(), &inputs), Acting::Yes);
}

#[test]
fn a_field_stays_in_use_while_a_required_value_is_missing() {
    let case = Case::table_1();
    let whole = case.inputs().unwrap();
    for missing in ["operation.speed", "operation.power", "driver.teeth"] {
        let mut partial = case.clone();
        partial.write(index_of(missing).unwrap(), "");
        let inputs = partial.read().0;
        for key in ["operation.power", "operation.speed", "pair.module", "driver.face_width"] {
            let field = index_of(key).unwrap();
            assert_eq!(relevance(field, &inputs), relevance(field, &whole), "{key} {missing}");
        }
    }
}
