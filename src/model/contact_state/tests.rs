//! Compares the states over the whole engagement with the solutions.

use super::*;
use crate::model::inputs::Method;
use crate::model::sample::standard_pair;
use crate::model::{Stages, solve};

/// Pairs with a deviation of 30 µm: speed reducing, speed increasing, with profile shift, and
/// without deviation.
fn solved() -> Vec<(Inputs, Solution)> {
    let mut found = Vec::new();
    for (driver, driven, shift, deflection) in [
        (20, 20, 0.0, 30e-6),
        (20, 60, 0.2, 30e-6),
        (60, 20, -0.1, 30e-6),
        (33, 47, 0.3, 1e-6),
        (20, 20, 0.0, -20e-6),
    ] {
        let mut inputs = standard_pair(driver, driven, 5e-3);
        inputs.driver.profile_shift = shift;
        inputs.deflection = Some(deflection);
        let solution = solve(&inputs, Stages::ALL).unwrap();
        found.push((inputs, solution));
    }
    found
}

fn force(moment: &ContactState) -> Option<f64> {
    moment.interpolated.map(|one| one.station.force)
}

#[test]
fn values_at_d_and_at_the_stations_agree_with_the_solution() {
    for (inputs, solution) in solved() {
        let Some(position) = solution.position else {
            continue;
        };
        let moment = ContactState::at(&inputs, &solution, position.approach_angle_driver).unwrap();
        assert!(moment.opening.abs() < f64::MIN_POSITIVE);
        // The conversion of the angle to the driver and back is exact within rounding.
        let same = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-14;
        assert!(same(moment.radius_driver, position.contact.radius_driver));
        let expected = solution.impact.map(|impact| impact.force);
        assert_eq!(force(&moment).is_some(), expected.is_some());
        if let Some((found, expected)) = force(&moment).zip(expected) {
            assert!(same(found, expected), "{found} for {expected}");
        }
        for station in &solution.stations {
            let moment = ContactState::at(&inputs, &solution, station.roll_angle_driver).unwrap();
            let close =
                |found: f64, expected: f64| (found - expected).abs() <= 1e-9 * expected.abs();
            assert!(
                close(moment.normal_velocity, station.normal_velocity),
                "{moment:?} {station:?}"
            );
            assert!(
                close(moment.sliding_velocity, station.sliding_velocity),
                "{moment:?} {station:?}"
            );
            assert!(close(force(&moment).unwrap(), station.force), "{moment:?} {station:?}");
            assert!(
                close(moment.radius_driver, station.radius_driver().unwrap()),
                "{moment:?} {station:?}"
            );
        }
    }
}

#[test]
fn the_opening_closes_at_d_and_stays_closed() {
    for (inputs, solution) in solved() {
        let Some(position) = solution.position else {
            continue;
        };
        let at = |part: f64| {
            ContactState::at(&inputs, &solution, part * position.approach_angle_driver).unwrap()
        };
        let openings: Vec<f64> =
            (0..=30).map(|step| at(2.0 - f64::from(step) / 10.0).opening).collect();
        assert!(
            openings[..10].windows(2).all(|pair| pair[0] > pair[1] && pair[1] > 0.0),
            "{openings:?}"
        );
        assert!(openings[10..].iter().all(|opening| *opening == 0.0), "{openings:?}");
    }
}

#[test]
fn without_contact_the_flanks_keep_the_missing_gap() {
    let (inputs, solution) = solved().pop().unwrap();
    assert_eq!(solution.position, None);
    for angle in [0.0, -0.05] {
        let moment = ContactState::at(&inputs, &solution, angle).unwrap();
        assert!((moment.opening - 20e-6).abs() < 1e-15 && force(&moment).is_none(), "{moment:?}");
    }
}

/// An ordinary pair by the methods with load sharing.
fn shared() -> Vec<(Inputs, Solution)> {
    [Method::Static, Method::Dynamic]
        .map(|method| {
            let mut inputs = standard_pair(20, 30, 5e-3);
            (inputs.method, inputs.base_pitch_deviation) = (method, 10e-6);
            let solution = solve(&inputs, Stages::EVERY).unwrap();
            (inputs, solution)
        })
        .into()
}

#[test]
fn the_load_at_an_angle_agrees_with_the_stations() {
    for (inputs, solution) in shared() {
        let first = first_contact(&solution).unwrap() * inputs.ratio();
        let before = ContactState::at(&inputs, &solution, 1.001 * first).unwrap();
        assert!(
            before.opening > 0.0 && before.interpolated.is_none() && !before.touches(),
            "{before:?}"
        );
        let stations = solution
            .dynamic
            .as_ref()
            .map_or_else(|| &solution.static_load.as_ref().unwrap().stations, |run| &run.stations);
        for station in stations {
            let moment = ContactState::at(&inputs, &solution, station.roll_angle_driver).unwrap();
            let load = moment.interpolated.unwrap().station;
            assert!(
                (load.force - station.force).abs() < 1e-9 * (1.0 + station.force),
                "{load:?} {station:?}"
            );
            assert!(
                (moment.sliding_velocity - station.sliding_velocity).abs() < 1e-9,
                "{moment:?} {station:?}"
            );
            assert!(moment.opening == 0.0, "{moment:?}");
        }
    }
}

/// Asserts that the contact point and the sliding velocity agree on both sides.
fn assert_same_contact(inputs: &Inputs, before: &ContactState, after: &ContactState) {
    let way = (before.point - after.point).norm();
    let change = (before.sliding_velocity - after.sliding_velocity).abs();
    assert!(way < 1e-7 * inputs.module && change < 1e-6, "{before:?} {after:?}");
}

#[test]
fn values_are_continuous_at_b_and_the_tip_leaves_the_flank_afterwards() {
    for (inputs, solution) in solved() {
        let last =
            (solution.geometry.start - solution.geometry.end) / solution.geometry.driver.base;
        let at = |after: f64| ContactState::at(&inputs, &solution, last - after).unwrap();
        let (before, after) = (at(-1e-9), at(1e-9));
        assert_eq!((before.phase, after.phase), (Phase::Line, Phase::RunOut));
        assert_same_contact(&inputs, &before, &after);
        let gaps = [0.001, 0.01, 0.05].map(|after| at(after).gap);
        assert!(gaps[0] > 0.0 && gaps.is_sorted() && at(0.01).normal_velocity < 0.0, "{gaps:?}");
    }
}

#[test]
fn values_are_continuous_at_e() {
    for (inputs, solution) in solved() {
        let (before, after) = (
            ContactState::at(&inputs, &solution, 1e-9),
            ContactState::at(&inputs, &solution, -1e-9),
        );
        let (before, after) = (before.unwrap(), after.unwrap());
        assert_same_contact(&inputs, &before, &after);
    }
}

#[test]
fn angles_beyond_the_range_are_limited_to_its_ends() {
    let (mut inputs, solution) = solved().remove(0);
    inputs.method = Method::Paper;
    for angle in [1e300, -1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let moment = ContactState::at(&inputs, &solution, angle).unwrap();
        assert!(moment.roll_angle_driver.is_finite(), "{angle}: {moment:?}");
    }
}

mod interpolated {
    use super::super::*;
    use crate::model::inputs::{InertiaModel, Method};
    use crate::model::sample::standard_pair;
    use crate::model::{Stages, solve};

    fn solved(method: Method, stations: usize) -> (Inputs, Solution) {
        let mut inputs = standard_pair(20, 30, 5e-3);
        inputs.inertia = InertiaModel::BaseCircle;
        (inputs.method, inputs.base_pitch_deviation, inputs.stations) =
            (method, 10e-6, Some(stations));
        let solution = solve(&inputs, Stages::EVERY).unwrap();
        (inputs, solution)
    }

    fn curve(method: Method, stations: usize) -> (Inputs, Solution, Vec<(f64, f64)>) {
        let (inputs, solution) = solved(method, stations);
        let of = |stations: &[Station]| {
            stations.iter().map(|one| (one.roll_angle_driver, one.force)).collect()
        };
        let curve = match method {
            Method::Dynamic => of(&solution.dynamic.as_ref().unwrap().stations),
            Method::Static => of(&solution.static_load.as_ref().unwrap().stations),
            _ => solution.stations.iter().map(|one| (one.roll_angle_driver, one.force)).collect(),
        };
        (inputs, solution, curve)
    }

    fn force(interpolated: Interpolated) -> f64 {
        interpolated.station.force
    }

    #[test]
    fn values_between_stations_agree_with_those_of_a_finer_solve() {
        for (method, good_to) in
            [(Method::Exact, 1e-12), (Method::Static, 1e-9), (Method::Dynamic, 5e-3)]
        {
            let (inputs, coarse, _) = curve(method, 64);
            let (_, _, fine) = curve(method, 2048);
            let peak = fine.iter().map(|(_, force)| *force).fold(0.0, f64::max);
            let off = |(angle, expected): &(f64, f64)| {
                Some((force(Interpolated::at(&inputs, &coarse, *angle)?) - expected).abs())
            };
            let off: Vec<f64> = fine[1..fine.len() - 1].iter().filter_map(off).collect();
            assert!(off.len() > 2000, "{method:?} {}", off.len());
            let most = off.into_iter().fold(0.0, f64::max);
            assert!(most <= good_to * peak, "{method:?} {:e}", most / peak);
        }
    }

    /// Contact begins and ends without force. There the balance is a difference of large numbers.
    #[test]
    fn the_force_at_the_ends_of_contact_is_zero_without_rounding() {
        for (teeth, deviation) in [(30, 10e-6), (25, 16e-6), (41, 23e-6), (67, 7e-6)] {
            for method in [Method::Static, Method::Dynamic] {
                let mut inputs = standard_pair(20, teeth, 5e-3);
                (inputs.method, inputs.base_pitch_deviation) = (method, deviation);
                let solution = solve(&inputs, Stages::EVERY).unwrap();
                let stations = match method {
                    Method::Static => &solution.static_load.as_ref().unwrap().stations,
                    _ => &solution.dynamic.as_ref().unwrap().stations,
                };
                let of_stations = stations.iter().map(|station| station.force);
                let interpolated = stations.iter().map(|station| {
                    let angle = station.roll_angle_driver;
                    force(Interpolated::at(&inputs, &solution, angle).unwrap())
                });
                for force in of_stations.chain(interpolated) {
                    let is_rounding = force != 0.0 && force < 1e-9 * solution.mesh_force;
                    assert!(!is_rounding, "20/{teeth} {method:?}: {force:e} N");
                }
                assert_eq!(stations[0].force.to_bits(), 0f64.to_bits());
            }
        }
    }

    #[test]
    fn there_are_no_values_without_contact() {
        for method in [Method::Paper, Method::Exact, Method::Static, Method::Dynamic] {
            let (inputs, solution, curve) = curve(method, 64);
            let (first, last) = (curve[0].0, curve[curve.len() - 1].0);
            for angle in [first * 1.001, last - 1e-3, f64::NAN, f64::INFINITY] {
                assert_eq!(Interpolated::at(&inputs, &solution, angle), None, "{method:?} {angle}");
            }
            assert!(
                Interpolated::at(&inputs, &solution, first).is_some()
                    && Interpolated::at(&inputs, &solution, 0.5 * first).is_some()
            );
        }
    }
}
