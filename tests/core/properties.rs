//! Properties of every pair of the envelope.
//!
//! `TIPSTRIKE_PAIRS=1000000 cargo test --release --test core properties::` checks a million pairs
//! instead of 12,000.
use crate::envelope::{Corner, Random, pair};
use crate::scaling::{factor, scaled};
use crate::support::{off, on_all_cores, pairs_or, value};

use std::collections::BTreeMap;

use tipstrike::model::inputs::{ContactCompliance, Method, ToothCompliance};
use tipstrike::model::{
    Geometry, Inputs, Outcome, QUANTITIES, Refusal, Solution, Stage, Stages, geometry, notes, solve,
};

/// Every closed form except the stiffness spread, which builds the field of each gear.
const WITHOUT_SPREAD: Stages = Stages::CLOSED_FORM.and(Stages::of(Stage::Stations));

fn pairs() -> u64 {
    pairs_or(12_000)
}

/// One pair of a numbered sequence, the same on every machine and on every thread.
fn numbered(number: u64) -> Inputs {
    let mut random = Random::new(number + 1);
    let corner = Corner::ALL[(number % Corner::ALL.len() as u64) as usize];
    let mut inputs = pair(&mut random, corner);
    // Finite elements are a thousand times as expensive: `examined` uses them occasionally.
    let models = [ToothCompliance::KUANG_YANG, ToothCompliance::BEAM];
    inputs.tooth_compliance = Some(random.one_of(&models));
    inputs.accurate = random.chance(0.25);
    inputs
}

/// The first `count` pairs for which `wanted` has an answer, with it.
fn some<T>(count: usize, wanted: impl Fn(Inputs) -> Option<T>) -> Vec<T> {
    (0..).filter_map(|number| wanted(numbered(number))).take(count).collect()
}

/// The result of a pair: its outcome, or the name of the refusal.
fn verdict(solved: &Result<Solution, Refusal>) -> String {
    match solved {
        Err(refusal) => refusal.code().to_owned(),
        Ok(solution) => solution.withheld.map_or(solution.outcome.name().to_owned(), |refusal| {
            format!("withheld: {}", refusal.code())
        }),
    }
}

/// Whether every number in a sentence is finite.
fn is_sound(sentence: &str) -> bool {
    !sentence
        .split(|letter: char| !letter.is_alphanumeric())
        .any(|word| matches!(word, "NaN" | "inf" | "infinity"))
}

/// Checks that all quantities, stations, notes and refusals have finite numbers. Returns the result
/// of the pair.
fn examined(number: u64) -> String {
    const WITH_FIELD: u64 = 1_009;
    let mut inputs = numbered(number);
    let wanted = if number.is_multiple_of(WITH_FIELD) {
        inputs.tooth_compliance = None;
        Stages::ALL
    } else {
        WITHOUT_SPREAD
    };
    let solved = solve(&inputs, wanted);
    match &solved {
        Err(refusal) => assert!(is_sound(&refusal.to_string()), "{refusal}: {inputs:?}"),
        Ok(solution) => examine(&inputs, solution),
    }
    verdict(&solved)
}

fn examine(inputs: &Inputs, solution: &Solution) {
    for quantity in QUANTITIES {
        let sound = (quantity.value)(solution).is_none_or(f64::is_finite);
        assert!(sound, "{} is not finite: {inputs:?}", quantity.key);
    }
    for key in "normal_velocity impact_force pair_compliance impact_duration effective_mass \
        hertz_half_width"
        .split(' ')
    {
        let is_positive = value(solution, key).is_none_or(|value| value > 0.0);
        assert!(is_positive, "{key} is not above 0: {inputs:?}");
    }
    for station in &solution.stations {
        let radius = station.radius_driver().expect("an impact");
        let numbers = [station.normal_velocity, station.sliding_velocity, station.force, radius];
        let angles = [station.roll_angle_driver, station.roll_angle_driven];
        assert!(numbers.iter().chain(&angles).all(|one| one.is_finite()), "{station:?} {inputs:?}");
    }
    for note in notes(inputs, solution) {
        assert!(is_sound(&note.message), "{}: {inputs:?}", note.message);
    }
    let struck = solution.outcome == Outcome::CornerContact;
    assert_eq!(struck, solution.position.is_some(), "{inputs:?}");
    let complete = solution.impact.is_some() && !solution.stations.is_empty();
    assert_eq!(struck && !complete, solution.withheld.is_some(), "{inputs:?}");
}

#[test]
fn every_pair_is_solved_or_refused_by_name() {
    let mut verdicts = BTreeMap::<String, u64>::new();
    for verdict in on_all_cores(pairs(), examined) {
        *verdicts.entry(verdict).or_default() += 1;
    }
    println!("{verdicts:#?}");
    let of_tips = verdicts.iter().filter(|(verdict, _)| verdict.starts_with("tip-radius"));
    let rounded_too_far: u64 = of_tips.map(|(_, count)| count).sum();
    assert!(verdicts["corner-contact"] > (pairs() - rounded_too_far) * 2 / 5, "{verdicts:?}");
}

/// Compares the default path with the accurate one, which the accuracy tests compare with the
/// oracle.
#[test]
fn default_path_is_nowhere_worse_than_1e_9() {
    let mut worst = (0.0, String::new());
    for number in 0..pairs() / 5 {
        let inputs = Inputs { accurate: false, ..numbered(number) };
        let solved = solve(&inputs, Stages::CLOSED_FORM);
        let precise = solve(&Inputs { accurate: true, ..inputs.clone() }, Stages::CLOSED_FORM);
        assert_eq!(verdict(&solved), verdict(&precise), "{inputs:?}");
        let (Ok(solved), Ok(precise)) = (solved, precise) else { continue };
        for quantity in QUANTITIES {
            let (Some(found), Some(expected)) =
                ((quantity.value)(&solved), (quantity.value)(&precise))
            else {
                continue;
            };
            if off(found, expected) > worst.0 {
                worst = (off(found, expected), format!("{}: {inputs:?}", quantity.key));
            }
        }
    }
    println!("worst {:e}: {}", worst.0, worst.1);
    assert!(worst.0 < 1e-9, "{:e}: {}", worst.0, worst.1);
}

#[test]
fn quantities_scale_with_the_units() {
    let checked = some(2_000, |inputs| {
        let plain = solve(&inputs, Stages::CLOSED_FORM).ok()?;
        for (length, time) in [(8.0, 1.0), (1.0, 0.25), (0.0625, 0.0625), (2.0, 32.0)] {
            let large = solve(&scaled(&inputs, length, time), Stages::CLOSED_FORM)
                .expect("as much a solution");
            for quantity in QUANTITIES {
                let (was, is) = ((quantity.value)(&plain), (quantity.value)(&large));
                let expected = was.map(|was| was * factor(quantity.unit, length, time));
                let is_scaled = match (is, expected) {
                    (Some(is), Some(expected)) => off(is, expected) < 1e-11,
                    (is, expected) => is == expected,
                };
                let key = quantity.key;
                assert!(is_scaled, "{key} {was:?} {is:?} times {length}, {time}: {inputs:?}");
            }
        }
        plain.impact
    });
    assert_eq!(checked.len(), 2_000);
}

/// A run-out is the run-in of the pair with exchanged gears: the part after the pitch point becomes
/// the part before it.
#[test]
fn swapped_gears_mirror_the_path_of_contact() {
    some(5_000, |inputs| {
        let swapped = Inputs { driver: inputs.driven, driven: inputs.driver, ..inputs.clone() };
        let here = geometry::geometry::<f64>(&inputs.shape()).ok()?;
        let there = geometry::geometry::<f64>(&swapped.shape()).ok()?;
        let close =
            |found: f64, expected: f64| (found - expected).abs() <= 1e-13 * here.tangent_length;
        let path = |one: &Geometry| one.contact_ratio * one.base_pitch;
        for (found, expected) in [
            (there.start, here.tangent_length - here.end),
            (there.end, here.tangent_length - here.start),
            (there.approach_length, here.end - here.start - here.approach_length),
            (path(&there), path(&here)),
        ] {
            assert!(close(found, expected), "{found} {expected}: {inputs:?}");
        }
        Some(())
    });
}

/// Eq. 55 adds the two materials, and Eq. 56 is for steel only.
#[test]
fn swapped_materials_strike_alike_in_the_fit() {
    some(1_000, |inputs| {
        let fit = Inputs { tooth_compliance: Some(ToothCompliance::KUANG_YANG), ..inputs };
        if fit.contact_compliance == ContactCompliance::WEBER {
            return None;
        }
        let mut swapped = fit.clone();
        (swapped.driver.young, swapped.driven.young) = (fit.driven.young, fit.driver.young);
        (swapped.driver.poisson, swapped.driven.poisson) = (fit.driven.poisson, fit.driver.poisson);
        let here = solve(&fit, Stages::CLOSED_FORM).ok()?.impact?;
        let there = solve(&swapped, Stages::CLOSED_FORM).expect("as much a solution").impact;
        assert_eq!(Some(here), there, "{fit:?}");
        Some(())
    });
}

/// The pair with a deviation of `total`, given entirely as deflection.
fn deviating(inputs: &Inputs, total: f64) -> Inputs {
    let mut inputs = Inputs {
        base_pitch_deviation: 0.0,
        backlash: 0.0,
        deflection: Some(total),
        ..inputs.clone()
    };
    inputs.driven.tip_relief = 0.0;
    inputs.driver.root_relief = 0.0;
    inputs
}

#[test]
fn angle_velocity_energy_and_mostly_force_rise_with_the_deviation() {
    const STEPS: i32 = 60;
    let keys = ["approach_angle_driven", "normal_velocity", "impact_energy", "impact_force"];
    some(500, |inputs| {
        // By beam theory a tooth is so much softer towards its tip that a soft driver may have a
        // smaller force with an earlier strike.
        let is_linear = inputs.tooth_compliance == Some(ToothCompliance::KUANG_YANG);
        let keys = &keys[..if is_linear { 4 } else { 3 }];
        let mut last = [0.0; 4];
        let mut solved = None;
        for step in 0..STEPS {
            let inputs = deviating(&inputs, 1e-15 * 1.6f64.powi(step));
            let Ok(solution) = solve(&inputs, Stages::CLOSED_FORM) else {
                break;
            };
            for (key, last) in keys.iter().zip(&mut last) {
                let Some(value) = value(&solution, key) else { continue };
                assert!(value > *last, "{key} falls from {last:e} to {value:e}: {inputs:?}");
                *last = value;
            }
            solved = solution.impact.or(solved);
        }
        solved
    });
}

/// Checks S(u) = Δ, and that S is the integral of its slope.
#[test]
fn gap_rises_with_the_angle() {
    use tipstrike::model::position::{gap_by_quadrature, tip_at};
    some(2_000, |inputs| {
        let solution =
            solve(&Inputs { method: Method::Exact, ..inputs.clone() }, Stages::CLOSED_FORM).ok()?;
        let angle = solution.position?.approach_angle_driven;
        let gap = |part: f64| {
            gap_by_quadrature(&solution.geometry, &tip_at(&solution.geometry, part * angle))
        };
        let gaps: Vec<f64> = (1..=16).map(|part| gap(f64::from(part) / 16.0)).collect();
        assert!(gaps[0] > 0.0 && gaps.is_sorted(), "{gaps:?}: {inputs:?}");
        Some(())
    });
}

#[test]
fn vanishing_deviation_meets_no_corner_contact_without_a_jump() {
    some(1_000, |inputs| {
        let exact = Inputs { method: Method::Exact, ..inputs };
        let at = |total: f64| solve(&deviating(&exact, total), Stages::CLOSED_FORM);
        let solution = at(1e-18).ok()?;
        let (force, angle) =
            (value(&solution, "impact_force")?, value(&solution, "approach_angle_driven")?);
        // If the tip is on the base circle, S(u) does not have this power yet.
        let driven = &solution.geometry.driven;
        if angle * driven.base > 0.1 * driven.tip_curvature {
            return None;
        }
        for exponent in [-20, -30, -60, -120, -200] {
            let small =
                at(10f64.powi(exponent)).unwrap_or_else(|refusal| panic!("{refusal}: {exact:?}"));
            let shrunk = 10f64.powi(exponent + 18);
            let ratio = value(&small, "approach_angle_driven").expect("an angle") / angle;
            let expected = 0.9 * shrunk.powf(2.0 / 3.0)..=1.1 * shrunk.sqrt();
            assert!(expected.contains(&ratio), "u falls to {ratio:e} at 1e{exponent} m: {exact:?}");
            let small = value(&small, "impact_force").expect("a force");
            assert!(small < 10.0 * force * shrunk.cbrt(), "{exact:?}");
        }
        for none in [0.0, -0.0, -1e-300, -1e-6] {
            let solution = at(none).expect("an outcome");
            let found = (solution.outcome, solution.position);
            assert_eq!(found, (Outcome::NoCornerContact, None), "{exact:?}");
        }
        Some(())
    });
}

#[test]
fn stations_fall_to_zero_at_the_end_and_stay_when_doubled() {
    some(1_000, |inputs| {
        let with = |stations| solve(&Inputs { stations, ..inputs.clone() }, WITHOUT_SPREAD).ok();
        let (coarse, fine) = (with(Some(8))?, with(Some(16))?);
        for (solution, whole) in [(&coarse, 9), (&fine, 17)] {
            let missing = solution.impact.is_some() && solution.stations.len() < whole;
            assert_eq!(missing, solution.stations_withheld.is_some(), "{inputs:?}");
        }
        if fine.stations_withheld.or(coarse.stations_withheld).is_some()
            || coarse.stations.is_empty()
        {
            return None;
        }
        let (coarse, fine) = (coarse.stations, fine.stations);
        assert_eq!((coarse.len(), fine.len()), (9, 17));
        assert!(fine.windows(2).all(|pair| pair[0].force > pair[1].force), "{inputs:?}");
        assert!(fine[16].force.abs() <= 0.0);
        assert!(coarse.iter().eq(fine.iter().step_by(2)), "{inputs:?}");
        Some(())
    });
}

#[test]
fn same_bits_on_one_thread_and_on_many() {
    const PAIRS: u64 = 400;
    let solved = |number: u64| format!("{:?}", solve(&numbered(number), WITHOUT_SPREAD));
    let mut alone: Vec<String> = (0..PAIRS).map(solved).collect();
    let mut shared = on_all_cores(PAIRS, solved);
    alone.sort();
    shared.sort();
    assert!(alone == shared);
}
