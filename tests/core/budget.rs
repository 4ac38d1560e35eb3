//! Every solve ends within its work budget, for every valid case.
//!
//! `TIPSTRIKE_PAIRS=1000000 cargo test --release --test core budget:: -- --nocapture` draws a
//! million cases instead of 48.
use std::collections::BTreeMap;

use crate::envelope::Random;
use crate::support::{inputs, on_all_cores, pairs_or};
use tipstrike::case::Case;
use tipstrike::case::fields::{AUTO, FIELDS, Kind, Range, index_of, key_of};
use tipstrike::model::budget::{MOTION_WORK, SEARCH_TRIES, SEARCH_WORK};
use tipstrike::model::compliance::{ElasticGear, model_of};
use tipstrike::model::inputs::{Method, ToothCompliance};
use tipstrike::model::{Inputs, QUANTITIES, Refusal, Solution, Stage, Stages, notes, solve};

/// Greatest heap of one solve, in bytes.
const MOST_BYTES: u64 = 64 << 20;

/// Work above the budget of a search, which ends after the mesh or step that exceeds the budget.
const MARGIN: u64 = 100_000;

/// Numbers of fields that are changed from the ordinary pair.
const MOVED: [usize; 7] = [1, 2, 3, 5, 8, 15, 45];

/// Everything that `solve` prints except the run over the speed, and the stations.
fn every_quantity() -> Stages {
    let quick = QUANTITIES.iter().filter(|quantity| quantity.stage != Stage::SpeedRun);
    quick.fold(Stages::STATIONS, |stages, quantity| stages.and(Stages::of(quantity.stage)))
}

/// Table 1 with changed fields.
fn changed(changes: &[(&str, &str)]) -> Case {
    let mut case = Case::table_1();
    for (key, text) in changes {
        case.write(index_of(key).expect("a field"), text);
    }
    case
}

/// The pair of Table 1 with computed deflection.
fn ordinary() -> Case {
    changed(&[("model.deflection", "")])
}

/// One valid case of a numbered sequence, the same on every machine.
pub(crate) fn drawn(number: u64) -> Case {
    let mut random = Random::new(number + 1);
    loop {
        let case = attempt(&mut random, number);
        if case.inputs().is_ok() {
            return case;
        }
    }
}

/// Table 1 with some fields anywhere in their ranges. Choices are drawn in every case, and the
/// methods alternate.
fn attempt(random: &mut Random, number: u64) -> Case {
    let mut case = ordinary();
    let is_choice = |field: &usize| matches!(FIELDS[*field].kind, Kind::Choice(..));
    let (choices, mut others): (Vec<usize>, Vec<usize>) = (0..FIELDS.len())
        .filter(|&field| {
            let known = &FIELDS[field];
            !matches!(known.kind, Kind::Text) && known.table() != "compliance"
        })
        .partition(is_choice);
    for _ in 0..random.one_of(&MOVED).min(others.len()) {
        let at = random.even(0.0, others.len() as f64) as usize;
        move_field(&mut case, others.swap_remove(at), random);
    }
    for field in choices {
        move_field(&mut case, field, random);
    }
    let method = Method::ALL[(number % Method::ALL.len() as u64) as usize];
    case.set("model.method", method.name()).expect("a method");
    case
}

fn move_field(case: &mut Case, field: usize, random: &mut Random) {
    let known = &FIELDS[field];
    let text = match known.kind {
        Kind::Text | Kind::List(_) => return,
        Kind::Choice(names, _) => random.one_of(names).to_owned(),
        Kind::Count(..) if known.takes_auto() && random.chance(0.25) => AUTO.to_owned(),
        Kind::Count(from, to, _) => {
            let count = anywhere(f64::from(from), f64::from(to), random).round() as u32;
            count.clamp(from, to).to_string()
        }
        Kind::Number(_, Range { from, to, unit }, _) => {
            format!("{:e} {unit}", anywhere(from, to, random)).trim_end().to_owned()
        }
    };
    case.write(field, &text);
    if let Some(other) = known.partner() {
        case.write(other, "");
    }
}

/// Every gear that the form accepts has a field, or a named refusal with a note that the beam
/// replaces the field.
#[test]
fn every_valid_gear_has_a_field_or_the_beam_with_a_note() {
    const CASES: u64 = 100;
    let mut seen = BTreeMap::new();
    for number in 0..CASES {
        let mut case = drawn(number);
        for (key, value) in [("model.tooth_compliance", ""), ("model.method", "exact")] {
            case.set(key, value).expect("a field");
        }
        let Ok(inputs) = case.inputs() else { continue };
        let gears = [&inputs.driver, &inputs.driven];
        let refused =
            gears.into_iter().find_map(|gear| ElasticGear::of(&inputs, gear).build_field().err());
        let served = model_of(&inputs);
        let what = refused.map_or("field", |refusal| refusal.code());
        *seen.entry(what).or_insert(0) += 1;
        let Some(refusal) = refused else {
            assert_eq!(served, ToothCompliance::FINITE_ELEMENT, "{number}");
            continue;
        };
        // A pair that no compliance solves has no such note.
        let Ok(solution) = solve(&inputs, Stages::CLOSED_FORM) else { continue };
        if solution.withheld.is_some() {
            continue;
        }
        assert!(matches!(refusal, Refusal::NoField { .. }), "{number}: {refusal}");
        assert_eq!(served, ToothCompliance::BEAM, "{number}: {refusal}");
        let notes = notes(&inputs, &solution);
        let note = notes.iter().find(|note| note.code == "tooth-compliance-beam");
        assert!(
            note.is_some_and(|note| note.message.contains(&refusal.to_string()))
                || solution.compliance.is_none(),
            "{number}: {notes:?}"
        );
    }
    println!("{seen:?}");
    assert!(seen.len() > 1 && seen["field"] > 25, "{seen:?}");
}

/// An end of a range, or any value in it with logarithmic distribution; for a range around 0,
/// twelve decades of either sign.
fn anywhere(from: f64, to: f64, random: &mut Random) -> f64 {
    const DECADES: f64 = 1e-12;
    let of = |end: f64, random: &mut Random| {
        end.signum() * random.decades(DECADES * end.abs(), end.abs())
    };
    match random.one_of(&[0, 1, 2, 2]) {
        0 => from,
        1 => to,
        _ if from > 0.0 => random.decades(from, to),
        _ if from < 0.0 && random.chance(0.5) => of(from, random),
        _ => of(to, random),
    }
}

/// Solves a case within its budget. Returns the outcome; every number of the answer or refusal must
/// be finite.
fn ended(name: &str, inputs: &Inputs) -> String {
    let mut solved = Err(Refusal::Stopped);
    let info = allocation_counter::measure(|| solved = solve(inputs, every_quantity()));
    assert!(info.bytes_max <= MOST_BYTES, "{name}: {} bytes", info.bytes_max);
    if let Ok(solution) = &solved {
        assert_within_budget(name, solution);
    }
    outcome(name, inputs, &solved)
}

fn assert_within_budget(name: &str, solution: &Solution) {
    let mesh = solution.mesh.as_ref().map_or(0, |mesh| mesh.work());
    let motion = solution.dynamic.as_ref().map_or(0, |dynamic| dynamic.work);
    assert!(motion <= MOTION_WORK, "{name}: {motion} of the motion");
    assert!(mesh <= MARGIN, "{name}: {mesh} of the mesh");
    if let Some(search) = solution.clearing {
        assert!(search.runs <= SEARCH_TRIES, "{name}: {} tries", search.runs);
        assert!(search.work <= SEARCH_WORK + MARGIN, "{name}: {} of the search", search.work);
    }
}

/// The outcome as a short text; every number of the answer must be finite.
fn outcome(name: &str, inputs: &Inputs, solved: &Result<Solution, Refusal>) -> String {
    let sound = |sentence: &str| {
        let mut words = sentence.split(|letter: char| !letter.is_alphanumeric());
        let is_none = |word| matches!(word, "NaN" | "inf" | "infinity");
        assert!(!words.any(is_none), "{name}: {sentence}");
    };
    match solved {
        Err(refusal) => {
            sound(&format!("{refusal} {}", refusal.fix()));
            format!("refused: {}", refusal.code())
        }
        Ok(solution) => {
            for quantity in QUANTITIES {
                let value = (quantity.value)(solution);
                assert!(value.is_none_or(f64::is_finite), "{name}: {} {value:?}", quantity.key);
            }
            for note in notes(inputs, solution) {
                sound(&note.message);
            }
            let relief = solution.clearing.and_then(|clearing| clearing.withheld);
            let stations = solution.stations_withheld;
            let withheld = [relief, stations].into_iter().flatten();
            let codes = withheld.map(|refusal| format!(", {}", refusal.code()));
            format!("{}{}", solution.outcome.name(), codes.collect::<String>())
        }
    }
}

#[test]
fn a_valid_case_however_extreme_ends_within_its_budget() {
    let all = on_all_cores(pairs_or(48), |number| {
        let inputs = drawn(number).inputs().expect("a valid case");
        ended(&format!("case {number}"), &inputs)
    });
    let mut outcomes = BTreeMap::<&str, u64>::new();
    for outcome in &all {
        *outcomes.entry(outcome).or_default() += 1;
    }
    println!("{outcomes:#?}");
    let count = |start: &str| {
        let all = outcomes.iter().filter(|(outcome, _)| outcome.starts_with(start));
        all.map(|(_, count)| count).sum::<u64>()
    };
    let (answered, refused) = (count("c"), count("refused"));
    let least = pairs_or(48) / 5;
    assert!(answered > least && refused > least, "{answered} and {refused}");
}

/// Cases that took more than 20 s in the past, from a random search: with their outcome, and the
/// required additional tip relief in um.
const SLOW: [(&str, &str, &str); 5] = [
    ("1210-dynamic", "corner-contact", "22.628"),
    ("2171-auto", "corner-contact, clearing-relief-not-found", ""),
    ("3502-dynamic", "corner-contact", "22.627"),
    ("3598-dynamic", "corner-contact", "39.436"),
    ("739-auto", "corner-contact", "22.628"),
];

#[test]
fn cases_that_took_more_than_20_s_end_within_their_budget() {
    for (name, expected, relief) in SLOW {
        let inputs = inputs(&format!("tests/slow/{name}.toml"));
        assert_eq!(ended(name, &inputs), expected, "{name}");
        let solution = solve(&inputs, Stages::of(Stage::Clearing)).expect("a solution");
        let found = solution.clearing.and_then(|clearing| clearing.relief);
        let shown = found.map_or(String::new(), |relief| format!("{:.3}", 1e6 * relief));
        assert_eq!(shown, relief, "{name}");
    }
}

/// The case with the largest memory of 120,000: a long motion whose curve needs many stations.
#[test]
fn the_case_with_the_longest_curve_stays_within_the_memory_of_a_solve() {
    let number = 112_869;
    let inputs = drawn(number).inputs().expect("a valid case");
    ended("case 112869", &inputs);
}

/// Contact and loss of contact alternate at the end of a relief if the load deflects the teeth by
/// less than the accuracy of the gap.
#[test]
fn next_to_no_load_and_next_to_no_relief_length_take_an_ordinary_search() {
    for (key, value) in [
        ("operation.power", "1e-2 W"),
        ("operation.power", "1e-6 W"),
        ("operation.power", "1e-12 W"),
        ("driven.tip_relief_length", "0.0001 mm"),
    ] {
        let case = changed(&[("model.method", "dynamic"), (key, value)]);
        let inputs = case.inputs().expect("a valid case");
        let solution = solve(&inputs, Stages::EVERY).expect("a solution");
        let clearing = solution.clearing.expect("the stage ran");
        assert!(clearing.relief.is_some(), "{key} {value}: {clearing:?}");
        assert!(clearing.work < SEARCH_WORK / 2, "{key} {value}: {clearing:?}");
    }
}

#[test]
fn a_search_that_exceeds_its_budget_prints_its_bracket_and_keeps_the_other_results() {
    let (cycles, damping) = (("model.warmup_cycles", "10000"), ("model.damping_ratio", "0"));
    let case = changed(&[("model.method", "dynamic"), cycles, damping]);
    let inputs = case.inputs().expect("a valid case");
    let solution = solve(&inputs, Stages::EVERY).expect("a solution");
    assert!(solution.dynamic.is_some_and(|dynamic| dynamic.peak_force > 0.0));
    let refusal = solution.clearing.and_then(|clearing| clearing.withheld).expect("a refusal");
    assert_eq!(refusal.code(), "clearing-relief-not-found");
    let sentence = refusal.to_string();
    assert!(sentence.starts_with("the search stopped after ") && sentence.contains(" motions: "));
    assert!(sentence.contains("touches before E with "), "{sentence}");
}

#[test]
fn a_motion_whose_steps_need_more_memory_than_a_solve_may_take_is_refused() {
    let case = changed(&[
        ("model.method", "dynamic"),
        ("operation.power", ""),
        ("operation.torque", "71.6 N m"),
        ("operation.speed", "0.25 rpm"),
    ]);
    let inputs = case.inputs().expect("a valid case");
    assert_eq!(ended("0.25 rpm", &inputs), "refused: motion-too-large");
    let refusal = solve(&inputs, Stages::of(Stage::Dynamic)).unwrap_err();
    assert_eq!(key_of(refusal.at()), "operation.speed");
    let fix = "give a higher speed, or set model.method to static";
    assert!(refusal.fix().starts_with(fix), "{}", refusal.fix());
    let sentence = refusal.to_string();
    assert!(sentence.contains("memory") && !sentence.contains("100"), "{sentence}");
}
