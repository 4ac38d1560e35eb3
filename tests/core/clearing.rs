//! The required additional tip relief: with it the method finds no corner contact, with slightly
//! less it does.
//!
//! `TIPSTRIKE_PAIRS=600 cargo test --test core clearing:: -- --nocapture` checks 600 pairs.
use crate::pairs;
use crate::support::pairs_or;

use tipstrike::case::units::{Dimension, System, factor, parse};
use tipstrike::case::{EXAMPLES, Example};
use tipstrike::model::inputs::{Gear, Method, ReliefShape};
use tipstrike::model::{Inputs, Outcome, Solution, Stage, Stages, auto, solve};
use tipstrike::report::digest::relief as relief_words;

const METHODS: [Method; 4] = [Method::Paper, Method::Exact, Method::Static, Method::Dynamic];

/// The spur pairs of the examples: `core::helical` checks the others.
fn examples() -> impl Iterator<Item = (&'static str, Inputs)> {
    let inputs = |example: &'static Example| {
        (example.name, example.document().case.inputs().expect("a valid case"))
    };
    EXAMPLES.iter().map(inputs).filter(|(_, inputs)| inputs.helix_angle == 0.0)
}

/// Realistic pairs, some of them near resonance, with little damping, or with a long relief.
fn built(number: u64) -> Inputs {
    let mut inputs = pairs::numbered(number);
    match number % 5 {
        1 => inputs.damping_ratio = 0.01,
        2 => inputs.driven.tip_relief = 0.3 * inputs.base_pitch_deviation,
        3 => inputs.driven.tip_relief_length = Some(4.0 * inputs.module),
        4 => std::mem::swap(&mut inputs.driver, &mut inputs.driven),
        _ => {}
    }
    inputs
}

/// A solve of the stages for outcome and required relief.
fn solved(inputs: &Inputs) -> Option<Solution> {
    solve(inputs, Stages::of(Stage::Clearing).with(Stage::Position)).ok()
}

/// Whether the tooth strikes by the method with another tip relief of the driven gear.
fn strikes(inputs: &Inputs, tip_relief: f64) -> bool {
    let relieved = Inputs { driven: Gear { tip_relief, ..inputs.driven }, ..inputs.clone() };
    let stages = inputs
        .method
        .stages()
        .within(Stages::of(Stage::Dynamic).with(Stage::Position).and(Stages::of(Stage::Static)));
    solve(&relieved, stages).expect("a solution").outcome == Outcome::CornerContact
}

/// Checks the promise of the answer: no relief without corner contact, otherwise the relief at
/// which striking ends.
fn assert_kept(name: &str, inputs: &Inputs, solution: &Solution) {
    let clearing = solution.clearing.expect("the stage ran");
    let given = inputs.driven.tip_relief;
    if solution.outcome == Outcome::NoCornerContact {
        assert_eq!((clearing.relief, clearing.withheld), (None, None), "{name}");
        return;
    }
    let relief = clearing.relief.unwrap_or_else(|| panic!("{name}: {:?}", clearing.withheld));
    assert!(!strikes(inputs, given + relief * (1.0 + 1e-9) + 1e-18), "{name} {relief:e}");
    let less = (relief * (1.0 - 1e-4)).min(relief - 2e-12).max(0.0);
    assert!(strikes(inputs, given + less), "{name}: less than {relief:e} stops it");
}

/// Whether small causes have large effects in the motion.
fn rattles(solution: &Solution) -> bool {
    solution.dynamic.as_ref().is_some_and(|dynamic| dynamic.contact_lost)
}

#[test]
fn the_required_relief_prevents_contact_and_less_does_not_for_any_shape_and_length() {
    let mut striking = [0; METHODS.len()];
    for (name, inputs) in examples() {
        let pitch =
            solve(&inputs, Stages::of(Stage::Geometry)).expect("a geometry").geometry.base_pitch;
        let lengths = [None, Some(0.3 * pitch), Some(1.3 * pitch)];
        for (method, striking) in METHODS.into_iter().zip(&mut striking) {
            for (shape, length) in
                ReliefShape::ALL.into_iter().flat_map(|shape| lengths.map(|length| (shape, length)))
            {
                let driven = Gear { tip_relief_length: length, ..inputs.driven };
                let inputs = Inputs { method, relief_shape: shape, driven, ..inputs.clone() };
                let solution = solved(&inputs).expect("a solution");
                let name = format!("{name}, {}, {shape:?} over {length:?}", method.name());
                assert_kept(&name, &inputs, &solution);
                *striking += u32::from(solution.outcome == Outcome::CornerContact);
            }
        }
    }
    assert!(striking.iter().all(|&count| count >= 12), "{striking:?}");
}

/// In a rattling pair small causes have large effects: only the tried reliefs are checked.
#[test]
fn where_contact_is_lost_the_relief_found_and_fifty_greater_ones_stop_it() {
    let mut looked_at = 0;
    for number in [9, 28, 88] {
        let inputs = Inputs { method: Method::Dynamic, ..pairs::numbered(number) };
        let solution = solved(&inputs).expect("a solution");
        assert!(rattles(&solution), "pair {number}");
        let Some(relief) = solution.clearing.and_then(|clearing| clearing.relief) else { continue };
        looked_at += 1;
        let tried = (0..=50).map(|step| 1.0 + 0.02 * f64::from(step));
        let touching: Vec<f64> = tried
            .filter(|part| strikes(&inputs, inputs.driven.tip_relief + part * relief))
            .collect();
        assert!(touching.len() <= 1, "pair {number}: {relief:e} and {touching:?} times as much");
    }
    assert!(looked_at >= 2, "{looked_at}");
}

/// The additional and the total relief of a sentence, each with its unit.
fn figures(sentence: &str) -> (String, Option<String>) {
    let words: Vec<&str> = sentence.split(' ').collect();
    let total =
        sentence.split_once("driven gear, ").and_then(|(_, rest)| rest.split_once(" in all"));
    (words[2..4].join(" "), total.map(|(total, _)| total.to_owned()))
}

#[test]
fn the_required_relief_prevents_contact_when_it_is_typed_in() {
    let mut looked_at = 0;
    for (number, method) in
        (0..pairs_or(20)).flat_map(|number| METHODS.map(|method| (number, method)))
    {
        for given in [0.0, 3.217e-6] {
            let mut inputs = Inputs { method, ..pairs::numbered(number) };
            inputs.driven.tip_relief = given;
            let Some(solution) = solved(&inputs).filter(|solution| !rattles(solution)) else {
                continue;
            };
            for system in System::ALL {
                let Some(words) = relief_words(&solution, system, false) else { continue };
                let read = |text: &str| parse(text, Dimension::Length, "").expect("a length");
                let (more, total) = figures(&words);
                let in_all = total.as_deref().map(read);
                let sum = given + read(&more);
                for relief in in_all.into_iter().chain([sum]) {
                    assert!(!strikes(&inputs, relief), "{number} {} {given:e}", method.name());
                    looked_at += 1;
                }
            }
        }
    }
    assert!(looked_at > 100, "{looked_at}");
}

#[test]
fn a_bracket_that_differs_in_its_last_digits_is_printed_as_it_is() {
    let table_1 = examples().find(|(name, _)| name.contains("zhou")).expect("Table 1").1;
    let whole = solved(&table_1).expect("a solution").deviation.total;
    for rest in [1e-15, 1e-12, 1e-9, 1e-6, 0.05 * table_1.module] {
        let mut inputs = table_1.clone();
        if rest < whole {
            inputs.driven.tip_relief = whole - rest;
        } else {
            inputs.deflection = Some(rest);
        }
        let solution = solved(&inputs).expect("a solution");
        let relief = solution.clearing.and_then(|clearing| clearing.relief);
        let total = solution.deviation.total;
        let more = relief.expect("a relief") - total;
        let last_digits = 8.0 * f64::EPSILON * (inputs.driven.tip_relief + total);
        assert!((0.0..=last_digits).contains(&more), "{rest:e}: {more:e}");
        assert!(total > 0.99 * rest - 1e-20);
    }
}

/// The sum of the given and the required relief, written in a unit and read back.
fn applied(inputs: &Inputs, relief: f64, unit: &str) -> f64 {
    let sum = inputs.driven.tip_relief + relief;
    let factor = factor(unit).expect("a unit");
    let text = format!("{} {unit}", sum / factor);
    parse(&text, Dimension::Length, "").unwrap_or_else(|error| panic!("{text}: {error:?}"))
}

/// Whatever the unit, the required relief in full digits is enough, more is enough, too, and less by
/// the resolution of the method is not.
#[test]
fn the_required_relief_in_full_digits_is_enough_in_every_unit() {
    let mut looked_at = [0; METHODS.len()];
    let mut failed = Vec::new();
    for (at, (method, count)) in METHODS.into_iter().zip([120, 120, 100, 18]).enumerate() {
        let count = count.max(pairs_or(0));
        for number in 0..count {
            let mut inputs = Inputs { method, ..built(number) };
            let module = inputs.module;
            match number % 4 {
                1 => inputs.driven.tip_radius = Some(0.05 * module),
                2 => inputs.driver.tip_radius = Some(0.1 * module),
                3 => inputs.driver.root_relief = 0.7e-3 * module,
                _ => {}
            }
            inputs.driven.tip_relief =
                [0.0, 1e-6, 3.217e-6, 0.1e-3 * module][number as usize / 4 % 4];
            let solution = solved(&inputs).filter(|solution| !rattles(solution));
            let relief = solution.as_ref().and_then(|solution| solution.clearing?.relief);
            let Some((solution, relief)) = solution.zip(relief) else { continue };
            looked_at[at] += 1;
            for unit in ["m", "mm", "um", "in", "thou"] {
                let relief = applied(&inputs, relief, unit);
                if strikes(&inputs, relief) {
                    failed.push(format!("pair {number}, {}: {relief:e} in {unit}", method.name()));
                }
            }
            for part in [1.05, 1.25, 2.0] {
                if strikes(&inputs, inputs.driven.tip_relief + part * relief) {
                    failed.push(format!("pair {number}, {}: {part} {relief:e}", method.name()));
                }
            }
            let less = if method.shares_load() {
                (relief * (1.0 - 1e-4)).min(relief - 2e-12)
            } else {
                let size = inputs.driven.tip_relief + solution.deviation.total + module;
                relief - 32.0 * f64::EPSILON * size
            };
            // A relief that reaches F also eases the pair ahead: less relief can then be enough.
            let is_long = inputs.driven.tip_relief_length.is_some();
            if !is_long && !strikes(&inputs, inputs.driven.tip_relief + less.max(0.0)) {
                let name = method.name();
                failed.push(format!("pair {number}, {name}: less than {relief:e} is enough"));
            }
        }
    }
    println!("{looked_at:?} {failed:#?}");
    assert!(failed.is_empty(), "{} of {looked_at:?}", failed.len());
    assert!(looked_at[1] > 90 && looked_at[2] > 70 && looked_at[3] > 9, "{looked_at:?}");
}

#[test]
fn auto_tells_the_relief_of_the_method_that_it_took() {
    let mut taken = Vec::new();
    for (name, inputs) in examples() {
        let chosen =
            solved(&Inputs { method: Method::Auto, ..inputs.clone() }).expect("a solution");
        let own = solved(&auto::taken(&inputs, chosen.method)).expect("a solution");
        let relief = |solution: &Solution| solution.clearing.expect("the stage ran").relief;
        assert_eq!(relief(&chosen), relief(&own), "{name}");
        assert_eq!(chosen.outcome, own.outcome, "{name}");
        taken.push(chosen.method);
    }
    assert!(taken.contains(&Method::Dynamic), "{taken:?}");
}

#[test]
fn it_is_sought_where_it_is_asked_for_and_nowhere_else() {
    for (name, inputs) in examples() {
        for method in METHODS {
            let inputs = Inputs { method, ..inputs.clone() };
            let without =
                solve(&inputs, Stages::EVERY.without(Stage::Clearing)).expect("a solution");
            assert!(without.clearing.is_none() && !without.ran.has(Stage::Clearing), "{name}");
            let alone = solve(&inputs, Stages::of(Stage::Clearing)).expect("a solution");
            assert!(!alone.ran.has(Stage::Friction) && !alone.ran.has(Stage::Stations), "{name}");
            let runs = alone.clearing.expect("the stage ran").runs;
            let most = if method == Method::Dynamic { 16 } else { 6 };
            assert!(runs == 0 || method.shares_load() && runs <= most, "{name} {}", method.name());
        }
    }
}
