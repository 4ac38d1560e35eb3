//! Tests the load on a part of the mesh against the load on the whole mesh.

use super::*;
use crate::model::inputs::{Drive, Inputs, Method, ReliefShape, ToothCompliance};
use crate::model::sample::standard_pair;
use crate::model::{Solution, Stage, Stages, solve};
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
    for (teeth, deviation, friction) in
        [(20, 0.0, None), (60, 12e-6, Some(0.1)), (200, -8e-6, None), (500, 0.0, None)]
    {
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
            assert!(off <= 1e-10 * expected.abs(), "z {teeth}: {found} {expected}");
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
        let displacements = load.stations.iter().filter_map(Station::transmission_error);
        let nothing = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, most) =
            displacements.fold(nothing, |(least, most), x| (x.min(least), x.max(most)));
        let found = load.transmission_error / (most - least) - 1.0;
        assert!((-1e-12..2e-3).contains(&found), "{name}: {found:e}");
    }
}

/// Ordinary pairs with friction, of which some deflect much more than others.
fn rubbing_meshes() -> Vec<Arc<Mesh>> {
    let mut meshes = Vec::new();
    for (index, (teeth, other)) in [(20, 20), (31, 44), (58, 64), (80, 23)].into_iter().enumerate()
    {
        for (step, friction) in [0.05, 0.1, 0.2].into_iter().enumerate() {
            for torque in [100.0, 270.0, 640.0, 1500.0, 2900.0] {
                let mut inputs = Inputs {
                    method: Method::Static,
                    base_pitch_deviation: 4e-6 * step as f64,
                    friction_coefficient: Some(friction),
                    drive: Drive::Torque(torque),
                    ..standard_pair(teeth, other, 3e-3)
                };
                inputs.driver.young /= 1.0 + 2.0 * index as f64;
                inputs.driven.tip_relief = 8e-6 * index as f64;
                if index == 2 {
                    inputs.driver.tip_radius = Some(0.1e-3);
                }
                if let Ok(Solution { mesh: Some(mesh), .. }) =
                    solve(&inputs, Stages::of(Stage::Static))
                {
                    meshes.push(mesh);
                }
            }
        }
    }
    meshes
}

/// Many places between the borders of the mesh and on both sides of each border.
fn dense(mesh: &Mesh, from: f64, to: f64) -> Vec<Place> {
    let borders = mesh.borders(from, to);
    let between = |ends: &[f64]| {
        let (from, to) = (ends[0], ends[1]);
        let beside = 1e-7 * (to - from);
        let at = move |step: i32| from + (to - from) * f64::from(step) / 512.0;
        let inner = (1..512).map(move |step| (at(step), at(step)));
        let ends = [(from, from + beside), (to, to - beside)];
        ends.into_iter().chain(inner)
    };
    borders.windows(2).flat_map(between).collect()
}

#[test]
fn the_tooth_carries_nowhere_before_its_first_and_after_its_last_contact() {
    let (mut jumps, mut looked_at) = (0, 0);
    for mesh in rubbing_meshes() {
        let load = static_load(&mesh, Spacing::Even(8)).unwrap();
        let (Some(first), Some(last)) = (load.first_contact_angle, load.last_contact_angle) else {
            continue;
        };
        let first = -first * mesh.base_radii.1;
        let last = mesh.length + last * mesh.base_radii.0;
        let aside = 1e-9 * mesh.base_pitch;
        let (from, to) = mesh.ends();
        let mut before = dense(&mesh, from, first - aside);
        before.extend(dense(&mesh, last + aside, to));
        for place in before {
            let lead = lead_of(&mesh, 0, place);
            assert!(lead <= 1e-15, "{lead:e} at {place:?} of {first:e} to {last:e}");
        }
        for inside in [first + aside, last - aside] {
            let lead = lead_of(&mesh, 0, (inside, inside));
            assert!(lead > 0.0, "{lead:e} beside {inside:e} of {first:e} to {last:e}");
        }
        let is_border = |border: &f64| (border - first).abs() <= aside;
        jumps += usize::from(mesh.borders(from, 0.0).iter().any(is_border));
        looked_at += 1;
    }
    assert!(looked_at >= 40, "{looked_at} with {jumps} first contacts by a jump of friction");
}

/// The first contact passes over a jump of friction at the pitch point of another pair.
#[test]
fn the_first_contact_follows_the_torque_over_a_jump_of_friction() {
    let mut inputs = Inputs {
        method: Method::Static,
        base_pitch_deviation: 10.3e-6,
        friction_coefficient: Some(0.202),
        relief_shape: ReliefShape::Parabolic,
        tooth_compliance: Some(ToothCompliance::KUANG_YANG),
        ..standard_pair(58, 64, 6e-3)
    };
    inputs.driver.profile_shift = 0.011;
    inputs.driver.young = 36.1e9;
    inputs.driver.tip_radius = Some(0.258e-3);
    inputs.driven.profile_shift = 0.221;
    inputs.driven.young = 157.3e9;
    inputs.driven.tip_relief = 34.5e-6;
    (inputs.driver.face_width, inputs.driven.face_width) = (70.56e-3, 70.56e-3);
    let angle = |torque: f64| {
        let mesh = mesh_of(&Inputs { drive: Drive::Torque(torque), ..inputs.clone() });
        let load = static_load(&mesh, Spacing::Even(8)).unwrap();
        load.first_contact_angle.unwrap()
    };
    let angles: Vec<f64> = (0..=60).map(|step| angle(2600.0 + 5.0 * f64::from(step))).collect();
    for pair in angles.windows(2) {
        let rise = pair[1] - pair[0];
        assert!((0.0..1e-4).contains(&rise), "{pair:?}");
    }
}

#[test]
fn a_sawtooth_has_the_harmonics_of_its_series() {
    let mut fourier = Fourier::new();
    for ends in [(0.0, 0.3), (0.3, 1.0)] {
        fourier.add(ends, |part| ends.0 + part * (ends.1 - ends.0));
    }
    for (order, amplitude) in (1..).zip(fourier.spectrum(1).amplitudes) {
        let expected = 1.0 / (std::f64::consts::PI * f64::from(order));
        assert!((amplitude / expected - 1.0).abs() < 1e-12, "{order}: {amplitude}");
    }
}

#[test]
fn two_periods_have_the_same_harmonics_as_one() {
    let mut fourier = Fourier::new();
    for _ in 0..2 {
        fourier.add((0.0, 1.0), |part| {
            5.0 + 0.3 * (TAU * part).sin() + 0.02 * (9.0 * TAU * part).cos()
        });
    }
    let found = fourier.spectrum(2).amplitudes;
    for (order, amplitude) in (1..).zip(found) {
        let expected = match order {
            1 => 0.3,
            9 => 0.02,
            _ => 0.0,
        };
        assert!((amplitude - expected).abs() < 1e-14, "{order}: {amplitude:e}");
    }
}
