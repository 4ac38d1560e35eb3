//! Harmonics and dynamic factors of the periodic mesh compared with direct sampling and with an
//! integrator of fixed steps.
use std::cell::Cell;
use std::f64::consts::TAU;

use crate::support::{case, range, value};
use tipstrike::model::inputs::{Drive, Method, ToothCompliance};
use tipstrike::model::mesh::Mesh;
use tipstrike::model::solve::speeds;
use tipstrike::model::speeds::{SPEEDS, SpeedCurve};
use tipstrike::model::static_load::{HARMONICS, balance};
use tipstrike::model::{Inputs, Note, Refusal, Solution, Stages, Steady, notes, solve};

fn solved(inputs: &Inputs) -> Solution {
    let inputs = Inputs { method: Method::Dynamic, ..inputs.clone() };
    solve(&inputs, Stages::EVERY).unwrap_or_else(|refusal| panic!("{refusal}"))
}

fn steady(solution: &Solution) -> &Steady {
    let found = solution.steady.as_ref().expect("the stage ran");
    found.as_ref().unwrap_or_else(|refusal| panic!("{refusal}"))
}

fn amplitudes(samples: &[f64]) -> Vec<f64> {
    let count = samples.len() as f64;
    let amplitude = |order: usize| {
        let mut sums = [0.0; 2];
        for (at, value) in samples.iter().enumerate() {
            let phase = TAU * order as f64 * at as f64 / count;
            sums = [sums[0] + value * phase.cos(), sums[1] + value * phase.sin()];
        }
        2.0 * sums[0].hypot(sums[1]) / count
    };
    (1..=HARMONICS).map(amplitude).collect()
}

#[test]
fn harmonics_at_rest_are_those_of_many_samples() {
    const SAMPLES: usize = 1 << 14;
    for name in ["zhou-chen-2014", "fzg-type-c", "high-contact-ratio"] {
        let solution = solved(&case(name));
        let mesh = solution.mesh.as_ref().unwrap().without_error();
        let samples: Vec<f64> = (0..SAMPLES)
            .map(|at| (at as f64 + 0.5) / SAMPLES as f64 * mesh.base_pitch)
            .map(|s| balance(&mesh, s, s).displacement)
            .collect();
        let found = solution.static_spectrum.unwrap().unwrap().spectrum;
        let scale = found.peak_to_peak;
        for (order, (own, other)) in (1..).zip(found.amplitudes.iter().zip(amplitudes(&samples))) {
            let is_near = (own - other).abs() < 1e-6 * scale;
            assert!(is_near, "{name}, harmonic {order}: {own:e} and {other:e}");
        }
        assert!((range(&samples) / scale - 1.0).abs() < 1e-4, "{name}");
    }
}

/// The last of many base pitches by classical Runge-Kutta steps without events: displacements, the
/// greatest sum of forces and the greatest force of a tooth.
fn plain(mesh: &Mesh, inputs: &Inputs, mass: f64, laps: u32, steps: u32) -> (Vec<f64>, f64, f64) {
    let damping = 2.0 * inputs.damping_ratio * (mesh.mean_stiffness() * mass).sqrt();
    let forces = |part: f64, x: f64| {
        let s = part.rem_euclid(1.0) * mesh.base_pitch;
        mesh.pair_set(s, s).forces(x)
    };
    let slope = |part: f64, [x, v]: [f64; 2]| {
        let total: f64 = forces(part, x).iter().sum();
        let drag = if total > 0.0 { damping * v } else { 0.0 };
        [v, (mesh.force - total - drag) / mass]
    };
    let h = mesh.base_pitch / mesh.speed / f64::from(steps);
    let (mut y, mut samples) = ([balance(mesh, 0.0, 0.0).displacement, 0.0], Vec::new());
    let (mut of_mesh, mut of_tooth) = (0.0f64, 0.0f64);
    let step_on = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
    for lap in 0..laps {
        for step in 0..steps {
            let at = |part: f64| (f64::from(step) + part) / f64::from(steps);
            let one = slope(at(1e-9), y);
            let two = slope(at(0.5), step_on(y, one, 0.5 * h));
            let three = slope(at(0.5), step_on(y, two, 0.5 * h));
            let four = slope(at(1.0 - 1e-9), step_on(y, three, h));
            if lap + 1 == laps {
                let forces = forces(at(0.0), y[0]);
                samples.push(y[0]);
                of_mesh = of_mesh.max(forces.iter().sum());
                of_tooth = forces.into_iter().fold(of_tooth, f64::max);
            }
            let all = [one, two, three, four];
            let rise = |index: usize| {
                let [one, two, three, four] = all.map(|slope| slope[index]);
                h / 6.0 * (one + 2.0 * (two + three) + four)
            };
            y = [y[0] + rise(0), y[1] + rise(1)];
        }
    }
    (samples, of_mesh, of_tooth)
}

/// At a tenth of resonance, at a subharmonic, and with loss of contact beside resonance.
#[test]
fn the_steady_motion_is_that_of_plain_steps() {
    let table_1 = case("zhou-chen-2014");
    let natural = solved(&table_1).resonance.unwrap().natural_frequency;
    let resonance = TAU * natural / f64::from(table_1.driver.teeth);
    for (part, damping_ratio, laps, is_lost) in
        [(0.12, 0.07, 8, false), (0.5, 0.07, 30, true), (0.9, 0.02, 200, true)]
    {
        let inputs = Inputs {
            speed: part * resonance,
            drive: Drive::Torque(table_1.torque()),
            damping_ratio,
            tooth_compliance: Some(ToothCompliance::KUANG_YANG),
            ..table_1.clone()
        };
        let solution = solved(&inputs);
        let found = steady(&solution);
        assert_eq!((found.contact_lost, found.periods), (is_lost, 1), "{part}");
        let mesh = solution.mesh.as_ref().unwrap().without_error();
        let (samples, of_mesh, of_tooth) = plain(&mesh, &inputs, solution.reduced_mass, laps, 4000);
        let scale = found.spectrum.peak_to_peak;
        let pairs = found.spectrum.amplitudes.iter().zip(amplitudes(&samples));
        for (order, (own, other)) in (1..).zip(pairs) {
            let is_near = (own - other).abs() < 2e-5 * scale;
            assert!(is_near, "{part}, harmonic {order}: {own:e} and {other:e}");
        }
        for (own, other) in
            [(scale, range(&samples)), (found.mesh_force, of_mesh), (found.tooth_force, of_tooth)]
        {
            assert!((own / other - 1.0).abs() < 2e-4, "{part}: {own} and {other}");
        }
    }
}

#[test]
fn an_undamped_motion_has_no_steady_state_and_the_rest_of_the_solve_stays() {
    let inputs = Inputs { damping_ratio: 0.0, warmup_cycles: 2, ..case("zhou-chen-2014") };
    let solution = solved(&inputs);
    assert!(solution.dynamic.is_some() && solution.static_spectrum.is_some());
    assert!(matches!(solution.steady, Some(Err(Refusal::NoSteadyMotion { .. }))));
}

/// With little damping at half the resonance speed the back flanks strike, and the note and the
/// quantities report this. A wide backlash or none does not affect the working flanks.
#[test]
fn a_pair_with_little_damping_rattles_across_its_backlash() {
    let pair = |backlash: f64| Inputs {
        backlash,
        speed: 400.0 * std::f64::consts::PI,
        damping_ratio: 0.02,
        ..case("fzg-type-c")
    };
    let keys = [
        "dynamic_back_strikes",
        "dynamic_peak_back_force",
        "steady_back_strikes",
        "steady_back_force",
    ];
    let rattling = solved(&pair(2e-6));
    for key in keys {
        assert!(value(&rattling, key).unwrap() > 0.0, "{key}");
    }
    let is_strike = |note: &Note| note.code == "back-flank-strikes";
    let note = notes(&pair(2e-6), &rattling).into_iter().find(is_strike);
    let message = note.unwrap().message;
    assert!(message.contains("across the backlash of 2.000 um"), "{message}");
    let wide = solved(&pair(3e-3));
    assert_eq!(keys.map(|key| value(&wide, key)), [Some(0.0); 4]);
    let without = solved(&pair(0.0));
    assert_eq!(keys.map(|key| value(&without, key)), [None; 4]);
    assert!(!notes(&pair(0.0), &without).iter().any(is_strike));
    let [far, none] = [&wide, &without].map(|solution| steady(solution).spectrum.peak_to_peak);
    assert!((far / none - 1.0).abs() < 1e-8, "{far} {none}: no back flank is reached");
}

#[test]
fn the_run_over_the_speed_passes_through_the_steady_motion_of_the_case() {
    let inputs = case("fzg-type-c");
    let curve =
        speeds(&inputs, &mut |_| (), &|_, _| true).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_eq!(curve.up.len(), SPEEDS);
    assert!(!curve.is_cut);
    // If the run-down finds the motion of the run-up, a plain solve finds it too.
    let jumps: Vec<f64> = curve.jumps().map(|point| point.speed).collect();
    let known = curve.up.iter().flatten().rev();
    let up = known
        .filter(|point| !jumps.contains(&point.speed))
        .nth(SPEEDS / 10)
        .expect("a speed without jump");
    let solution = solved(&Inputs {
        speed: up.speed,
        drive: Drive::Torque(inputs.torque()),
        ..inputs.clone()
    });
    let peak_to_peak = steady(&solution).spectrum.peak_to_peak;
    let off = up.peak_to_peak / peak_to_peak - 1.0;
    assert!(off.abs() < 1e-4, "{off:e}");
    let last = curve.speeds[SPEEDS - 1];
    assert!(curve.speeds[0] < curve.resonance && curve.resonance < last);
    // The caller may stop it.
    let shown = Cell::new(0);
    let mut show = |_: &SpeedCurve| shown.set(shown.get() + 1);
    let stopped = speeds(&inputs, &mut show, &|_, _| shown.get() < 3);
    assert_eq!((stopped, shown.get()), (Err(Refusal::Stopped), 3));
    // With little damping and loss of contact, the run-down keeps a motion that the run-up has not.
    let little = Inputs { damping_ratio: 0.02, ..case("zhou-chen-2014") };
    let curve =
        speeds(&little, &mut |_| (), &|_, _| true).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert!(curve.jumps().count() > 1, "{}", curve.jumps().count());
}
