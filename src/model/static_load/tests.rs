//! Tests the load on a part of the mesh against the load on the whole mesh.

use super::*;
use crate::model::inputs::{Inputs, Method};
use crate::model::sample::standard_pair;
use crate::model::{Stage, Stages, solve};
use std::sync::Arc;

fn mesh(teeth: u32, deviation: f64, friction: Option<f64>) -> Arc<Mesh> {
    mesh_of(&Inputs {
        method: Method::Static,
        base_pitch_deviation: deviation,
        friction_coefficient: friction,
        ..standard_pair(teeth, 2 * teeth, 2e-3)
    })
}

/// The mesh of a large driver and a pinion, both with rounded tips and a relief.
fn rounded_mesh(deviation: f64, friction: Option<f64>) -> Arc<Mesh> {
    let mut inputs = Inputs {
        method: Method::Static,
        base_pitch_deviation: deviation,
        friction_coefficient: friction,
        ..standard_pair(300, 20, 2e-3)
    };
    inputs.driven.tip_relief = 10e-6;
    (inputs.driver.tip_radius, inputs.driven.tip_radius) = (Some(0.1e-3), Some(0.1e-3));
    mesh_of(&inputs)
}

fn mesh_of(inputs: &Inputs) -> Arc<Mesh> {
    let solution = solve(inputs, Stages::of(Stage::Static)).unwrap();
    solution.mesh.unwrap()
}

#[test]
fn pairs_far_from_contact_change_no_result() {
    for (teeth, deviation, friction) in [
        (20, 0.0, None),
        (60, 12e-6, Some(0.1)),
        (200, -8e-6, None),
        (500, 0.0, None),
    ] {
        let mesh = mesh(teeth, deviation, friction);
        let gap = near_gap(&mesh);
        let near = mesh.within(gap);
        assert!(near.ends().0 > mesh.ends().0 && near.ends().1 < mesh.ends().1);
        let of = |part: &Mesh, gap: f64| {
            let load = load_within((&mesh, part), gap, Spacing::Even(32)).unwrap();
            [
                load.peak_force,
                load.force_at_start,
                load.transmission_error,
                load.first_contact_angle.unwrap_or(0.0),
                load.last_contact_angle.unwrap_or(0.0),
            ]
        };
        let (found, expected) = (of(&near, gap), of(&mesh, f64::INFINITY));
        for (found, expected) in found.into_iter().zip(expected) {
            let off = (found - expected).abs();
            assert!(
                off <= 1e-10 * expected.abs(),
                "z {teeth}: {found} {expected}"
            );
        }
    }
}

#[test]
fn a_part_of_the_mesh_too_small_for_the_deflection_is_refused() {
    let mesh = mesh(60, 0.0, None);
    let gap = 0.1 * near_gap(&mesh);
    let found = load_within((&mesh, &mesh.within(gap)), gap, Spacing::Even(32));
    assert_eq!(found, Err(Refusal::BeyondReach));
}

#[test]
fn no_station_exceeds_the_peaks() {
    let sharp = |teeth: u32, deviation, friction| mesh(teeth, deviation, friction);
    // Friction lets the curves jump at the pitch point, a rounded tip at E and B.
    for (name, mesh) in [
        ("deviation", sharp(20, 16e-6, None)),
        ("no deviation", sharp(20, 0.0, None)),
        ("friction", sharp(60, 12e-6, Some(0.1))),
        ("many teeth", sharp(200, 8e-6, None)),
        ("late tooth", rounded_mesh(-6e-6, Some(0.08))),
        ("rounded tips", rounded_mesh(0.0, None)),
    ] {
        let load = static_load(&mesh, Spacing::Even(2048)).unwrap();
        let force = load.stations.iter().map(|station| station.force);
        let found = load.peak_force / force.fold(0.0, f64::max) - 1.0;
        assert!((-1e-12..1e-3).contains(&found), "{name}: {found:e}");
        let displacements = load
            .stations
            .iter()
            .map(|station| station.transmission_error);
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, most) =
            displacements.fold(nothing, |(least, most), x| (x.min(least), x.max(most)));
        let found = load.transmission_error / (most - least) - 1.0;
        assert!((-1e-12..2e-3).contains(&found), "{name}: {found:e}");
    }
}
