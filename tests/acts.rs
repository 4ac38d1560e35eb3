//! What the form says of each field, whether it acts, is what the model does when the field changes.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "a test may stop at what it did not expect")]

use std::fs;

use tipstrike::case::fields::{Field, Kind, index_of};
use tipstrike::case::units;
use tipstrike::case::{Acting, Case, Document, FIELDS, acts};
use tipstrike::model::{self, QUANTITIES, Solution, Stages};

/// The rungs that the table is held for.
const RUNGS: [&str; 2] = ["paper", "exact"];

/// Every case of the house, and Table 1 with what the others leave out, so that whatever can act does.
fn samples() -> Vec<Case> {
    let mut found: Vec<Case> = Vec::new();
    let mut paths: Vec<_> = fs::read_dir("cases").expect("the folder of cases").map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        found.push(Document::read(&path).expect("a case of the house is good").case);
    }
    let changed = |changes: &[(&str, &str)]| {
        let mut case = Case::table_1();
        for (key, text) in changes {
            case.set(key, text).expect("a change that fits");
        }
        case
    };
    found.push(changed(&[("model.deflection", ""), ("model.tooth_compliance", ""), ("operation.friction_coefficient", "0.06")]));
    found.push(changed(&[("model.tooth_compliance", "beam"), ("model.contact_compliance", "weber"), ("model.deflection", "")]));
    found.push(changed(&[("driven.tip_radius", "0.4 mm"), ("driver.tip_radius", "0.4 mm"), ("operation.torque", "70 N m")]));
    found.push(changed(&[
        ("driver.tip_relief", "10 um"),
        ("driver.root_relief", "4 um"),
        ("driven.tip_relief", "5 um"),
        ("driven.root_relief", "3 um"),
        ("driver.tip_relief_length", "3 mm"),
        ("driven.tip_relief_length", "3 mm"),
        ("pair.centre_distance", "100.2 mm"),
    ]));
    found
}

/// Other texts that the field takes: near what holds in it, and across its range.
fn others(field: &Field, index: usize, case: &Case) -> Vec<String> {
    match field.kind {
        Kind::Text => vec!["other words".to_owned()],
        Kind::Choice(names, _) => names.iter().map(|name| (*name).to_owned()).collect(),
        Kind::Count(..) => ["1", "10", "-1"].iter().filter_map(|by| case.stepped(index, by.parse().unwrap())).collect(),
        Kind::Number(dimension, range, _) => {
            let held = case.effective(index).and_then(|text| units::parse(text, dimension, range.unit).ok());
            let factor = units::factor(range.unit).unwrap();
            let near = [1.02, 0.98, 1.3].map(|times| held.map(|value| value / factor * times));
            let mid = [1e-5, 1e-3, 0.02].map(|part| Some(range.from + (range.to - range.from) * part));
            let text = |value: f64| format!("{value} {}", range.unit).trim_end().to_owned();
            near.into_iter().chain(mid).flatten().filter(|value| (range.from..=range.to).contains(value)).map(text).collect()
        }
    }
}

fn solve(case: &Case) -> Option<Solution> {
    model::solve(&case.inputs().ok()?, Stages::ALL).ok()
}

/// Every quantity to the last bit, and every station.
fn told(solution: &Solution) -> (Vec<Option<u64>>, String) {
    let quantities = QUANTITIES.iter().map(|quantity| (quantity.value)(solution).map(f64::to_bits)).collect();
    (quantities, format!("{:?} {:?}", solution.outcome, solution.stations))
}

/// A change of the field that changes something, in words.
fn found_acting(index: usize, samples: &[Case]) -> Option<String> {
    let field = &FIELDS[index];
    for case in samples {
        let Some(before) = solve(case) else { continue };
        for text in others(field, index, case) {
            let mut changed = case.clone();
            if changed.set(field.key, &text).is_err() {
                continue;
            }
            if solve(&changed).is_some_and(|after| told(&after) != told(&before)) {
                return Some(format!("{} = {text}", field.key));
            }
        }
    }
    None
}

#[test]
fn what_acts_is_what_changes_a_result() {
    for rung in RUNGS {
        let samples: Vec<Case> = samples()
            .into_iter()
            .map(|mut case| {
                case.set("model.rung", rung).unwrap();
                case
            })
            .collect();
        for (index, field) in FIELDS.iter().enumerate() {
            let acting = acts(index, &samples[0]);
            let change = found_acting(index, &samples);
            match (acting, change) {
                (Acting::Yes, None) => panic!("rung {rung}: {} is said to act, and no change of it changes anything", field.key),
                (Acting::No(why) | Acting::Beside(why), Some(change)) => {
                    panic!("rung {rung}: {} is said not to act ({why}), and {change} changes something", field.key)
                }
                _ => (),
            }
        }
    }
}

#[test]
fn the_reason_is_a_short_sentence() {
    let case = Case::table_1();
    for index in 0..FIELDS.len() {
        let (Acting::No(why) | Acting::Beside(why)) = acts(index, &case) else { continue };
        assert!((10..=130).contains(&why.len()) && why.is_ascii() && !why.ends_with('.'), "{why}");
    }
}

#[test]
fn an_unknown_rung_uses_every_field_that_is_computed_with() {
    let mut case = Case::table_1();
    let tip_relief = index_of("driver.tip_relief").unwrap();
    assert!(matches!(acts(tip_relief, &case), Acting::No(_)));
    case.write(index_of("model.rung").unwrap(), "another");
    assert_eq!(acts(tip_relief, &case), Acting::Yes);
    assert!(matches!(acts(0, &case), Acting::Beside(_)));
}
