//! Methods `static` and `dynamic`, compared with an independent computation of the same pairs.
use serde_json::Value;

use crate::support::{cases_with_answers, off, range, value};
use tipstrike::model::inputs::Method;
use tipstrike::model::mesh::Mesh;
use tipstrike::model::static_load::balance;
use tipstrike::model::{Inputs, Outcome, Solution, Stages, Station, solve};

/// A pair of the reference with its answers.
struct Row {
    name: String,
    inputs: Inputs,
    answers: Value,
}

fn rows() -> Vec<Row> {
    let row = |(name, inputs, answers)| Row { name, inputs, answers };
    cases_with_answers("tests/reference/mesh").into_iter().map(row).collect()
}

impl Row {
    fn answer(&self, key: &str) -> Option<f64> {
        self.answers[key].as_f64()
    }

    fn solved(&self, tolerance: f64) -> Solution {
        let inputs = Inputs { method: Method::Dynamic, tolerance, ..self.inputs.clone() };
        solve(&inputs, Stages::EVERY).unwrap_or_else(|refusal| panic!("{}: {refusal}", self.name))
    }

    /// The greatest relative error over the quantities of a method.
    fn worst(&self, solution: &Solution, keys: &[&str]) -> f64 {
        keys.iter().map(|key| self.off(solution, key)).fold(0.0, f64::max)
    }

    /// The relative error of a quantity; an absent quantity must be absent in both.
    fn off(&self, solution: &Solution, key: &str) -> f64 {
        match (value(solution, key), self.answer(key)) {
            (Some(found), Some(expected)) => off(found, expected),
            (None, None) => 0.0,
            (found, expected) => panic!("{}: {key} is {found:?} and not {expected:?}", self.name),
        }
    }

    fn samples(&self, key: &str) -> Vec<(f64, f64)> {
        let pairs = self.answers[key].as_array().expect("samples");
        pairs.iter().map(|pair| (pair[0].as_f64().unwrap(), pair[1].as_f64().unwrap())).collect()
    }
}

const STATIC: [&str; 4] = [
    "static_first_contact_angle",
    "static_force_at_start",
    "static_peak_force",
    "static_last_contact_angle",
];
const DYNAMIC: [&str; 3] =
    ["dynamic_first_contact_angle", "dynamic_peak_approach_force", "dynamic_peak_force"];

#[test]
fn static_quantities_and_curves_of_every_row() {
    for row in rows() {
        let solution = row.solved(1e-3);
        let worst = row.worst(&solution, &STATIC);
        assert!(worst < 1e-11, "{}: off by {worst:e}", row.name);
        let mean = solution.mesh.as_ref().expect("a mesh").mean_stiffness();
        let expected = row.answer("mean_mesh_stiffness").unwrap();
        assert!(off(mean, expected) < 1e-12, "{}: {mean}", row.name);
        let (force, error) = (solution.mesh_force, solution.deviation.equivalent_error);
        let mesh = Mesh::new(&row.inputs.mesh(), &solution.geometry, (force, error), 1e-3, None)
            .expect("a mesh");
        for (angle, expected) in row.samples("static_samples") {
            let s = -angle * mesh.base_radii.1;
            let found = balance(&mesh, s, s).force;
            let is_near = (found - expected).abs() < 1e-11 * force;
            assert!(is_near, "{}: {found} and not {expected} at {angle}", row.name);
        }
    }
}

#[test]
fn dynamic_quantities_and_curves_of_every_row() {
    for row in rows() {
        let inputs = Inputs {
            method: Method::Dynamic,
            tolerance: 1e-10,
            stations: Some(4000),
            ..row.inputs.clone()
        };
        let solution = solve(&inputs, Stages::EVERY).unwrap();
        let worst = row.worst(&solution, &DYNAMIC);
        assert!(worst < 1e-9, "{}: off by {worst:e}", row.name);
        let dynamic = solution.dynamic.as_ref().unwrap();
        assert_eq!(row.answers["dynamic_contact_lost"], dynamic.contact_lost, "{}", row.name);
        for (time, expected) in row.samples("dynamic_samples") {
            let (found, spread) = between(&dynamic.stations, time);
            // At a corner of the curve, where a pair enters or leaves, the accuracy of the cubic is
            // limited by the distance of the stations.
            let allowed = 1e-8 * solution.mesh_force + 0.05 * spread;
            let is_near = (found - expected).abs() < allowed;
            assert!(is_near, "{}: {found} and not {expected} at {time}", row.name);
        }
    }
}

/// The force at a time by the cubic through the four stations around it, with the spread of their
/// forces; 0 outside the contact.
fn between(stations: &[Station], time: f64) -> (f64, f64) {
    let after = stations.partition_point(|station| station.time().unwrap() < time);
    if after == 0 || after == stations.len() {
        return (0.0, 0.0);
    }
    let first = after.saturating_sub(2).min(stations.len() - 4);
    let four = &stations[first..first + 4];
    let weight = |own: usize| {
        let others = (0..4).filter(|&other| other != own).map(|other| {
            let (own, other) = (four[own].time().unwrap(), four[other].time().unwrap());
            (time - other) / (own - other)
        });
        others.product::<f64>()
    };
    let forces: Vec<f64> = four.iter().map(|station| station.force).collect();
    ((0..4).map(|own| weight(own) * forces[own]).sum(), range(&forces))
}

#[test]
fn the_tolerance_is_a_promise_on_the_peak_force() {
    for row in rows() {
        for exponent in 3..=10 {
            let tolerance = 10f64.powi(-exponent);
            let solution = row.solved(tolerance);
            let off = row.off(&solution, "dynamic_peak_force");
            assert!(off <= tolerance.max(1e-11), "{} at {tolerance:e}: off by {off:e}", row.name);
        }
    }
}

#[test]
fn friction_work_of_a_vanishing_coefficient_is_the_integral_of_force_and_sliding() {
    const COEFFICIENT: f64 = 1e-9;
    for row in rows() {
        let inputs = Inputs {
            friction_coefficient: Some(COEFFICIENT),
            method: Method::Dynamic,
            tolerance: 1e-9,
            ..row.inputs.clone()
        };
        let work = solve(&inputs, Stages::EVERY).unwrap().dynamic.unwrap().friction_work.unwrap();
        let expected = COEFFICIENT * row.answer("sliding_integral").unwrap();
        assert!(off(work, expected) <= 1e-6, "{}: {work} and not {expected}", row.name);
    }
}

#[test]
fn the_tooth_strikes_if_the_reference_has_a_first_contact() {
    for row in rows() {
        let strikes = row.answer("dynamic_first_contact_angle").is_some();
        let solution = row.solved(1e-6);
        assert_eq!(solution.outcome == Outcome::CornerContact, strikes, "{}", row.name);
        // Without a strike the impact has no duration.
        assert_eq!(solution.dynamic.unwrap().impact_duration.is_some(), strikes, "{}", row.name);
    }
}
