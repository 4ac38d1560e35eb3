//! How deviations of both gears and a backlash make the incoming tooth early.
use crate::support::standard_pair;

use tipstrike::case::{Case, Spread};
use tipstrike::model::inputs::{Combination, Method};
use tipstrike::model::{Inputs, QUANTITIES, Quantity, Solution, Stage, Stages, solve};
use tipstrike::study::batch::Control;
use tipstrike::study::tolerance::{Size, Tolerance};

fn error(driver: f64, driven: f64, combination: Combination) -> f64 {
    let mut inputs = Inputs { combination, method: Method::Exact, ..standard_pair(20, 30, 5e-3) };
    (inputs.driver.base_pitch, inputs.driven.base_pitch) = (Some(driver), Some(driven));
    solve(&inputs, Stages::of(Stage::Deviation)).unwrap().deviation.equivalent_error
}

#[test]
fn unknown_deviations_add_as_squares_and_known_ones_with_their_signs() {
    let (twelve, five) = (12e-6, 5e-6);
    for (driver, driven, combination, expected) in [
        (twelve, twelve, Combination::Independent, twelve * 2f64.sqrt()),
        (twelve, five, Combination::Independent, 13e-6),
        (-twelve, -five, Combination::Independent, -13e-6),
        (0.0, -five, Combination::Independent, -five),
        // Deviations of unlike sign are known.
        (twelve, -twelve, Combination::Independent, 0.0),
        (-five, twelve, Combination::Independent, 7e-6),
        (twelve, twelve, Combination::Sum, 24e-6),
        (twelve, -five, Combination::Sum, 7e-6),
    ] {
        let found = error(driver, driven, combination);
        assert!((found - expected).abs() < 1e-18, "{driver}, {driven}: {found}");
    }
}

#[test]
fn deviations_drawn_gear_by_gear_are_summed() {
    let error = |keys: &[&str]| {
        let mut case = Case::table_1();
        for key in ["driver.base_pitch", "driven.base_pitch"] {
            case.set(key, "12 um").unwrap();
        }
        case.set("deviations.base_pitch", "12 um").unwrap();
        if keys.len() == 1 {
            case.set("driver.base_pitch", "").unwrap();
            case.set("driven.base_pitch", "").unwrap();
        }
        let narrow = |key: &&str| Spread::new(key, "uniform 1e-9 um").unwrap();
        case.spread = keys.iter().map(narrow).collect();
        let inputs = case.inputs().unwrap();
        let only: Vec<&Quantity> = Quantity::find("equivalent_error").into_iter().collect();
        let size = Size { samples: 8, seed: 1, ranked: None };
        let study = Tolerance::of(&case, &inputs, &only, size).unwrap();
        study.run(&inputs, &Control::PLAIN).unwrap().value(0, 0).unwrap()
    };
    let close = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-6;
    assert!(close(error(&["driver.base_pitch", "driven.base_pitch"]), 24e-6));
    assert!(close(error(&["deviations.base_pitch"]), 12e-6 * 2f64.sqrt()));
}

/// Every value that is not one of the back flanks.
fn of_drive_flanks(solution: &Solution) -> Vec<Option<f64>> {
    let of_drive =
        |quantity: &&Quantity| quantity.needs != tipstrike::model::quantities::Need::Backlash;
    QUANTITIES.iter().filter(of_drive).map(|quantity| quantity.finite_value(solution)).collect()
}

#[test]
fn a_backlash_leaves_the_drive_flanks_alone_in_every_method_but_paper() {
    let solved = |method, backlash| {
        let inputs =
            Inputs { method, backlash, base_pitch_deviation: 16e-6, ..standard_pair(20, 30, 5e-3) };
        solve(&inputs, Stages::EVERY).unwrap()
    };
    for method in Method::ALL {
        let [without, with] = [0.0, 100e-6].map(|backlash| solved(method, backlash));
        let is_same = of_drive_flanks(&without) == of_drive_flanks(&with);
        assert_eq!(is_same, method != Method::Paper, "{}", method.name());
    }
    let paper = solved(Method::Paper, 10e-6).deviation.equivalent_error;
    assert!((paper - (32e-6 - 10e-6) / 2f64.sqrt()).abs() < 1e-18);
}
