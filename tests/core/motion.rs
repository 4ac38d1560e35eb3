//! Properties of method `dynamic` for any pair: rest, free oscillation, energy, and the static load
//! at low speed.
use tipstrike::case::Document;

use crate::support::case;
use tipstrike::model::inputs::{Drive, Method, ToothCompliance};
use tipstrike::model::mesh::Mesh;
use tipstrike::model::static_load::balance;
use tipstrike::model::{Dynamic, Inputs, Solution, Stages, Station, notes, solve};

fn dynamic(inputs: &Inputs) -> (Solution, Dynamic) {
    let inputs = Inputs { method: Method::Dynamic, ..inputs.clone() };
    let solution = solve(&inputs, Stages::EVERY).unwrap_or_else(|refusal| panic!("{refusal}"));
    let dynamic = solution.dynamic.clone().expect("the method ran");
    (solution, dynamic)
}

fn mesh(inputs: &Inputs, solution: &Solution) -> Mesh {
    let error = solution.deviation.equivalent_error;
    Mesh::new(&inputs.mesh(), &solution.geometry, (solution.mesh_force, error), 2e-3, None)
        .expect("a mesh")
}

/// At lower speed the force differs less from the shared load at rest at the same place.
#[test]
fn slow_gears_carry_the_static_load() {
    let table_1 = case("zhou-chen-2014");
    let torque = Drive::Torque(table_1.torque());
    let mut before = f64::INFINITY;
    for slower in [30.0, 300.0, 3000.0] {
        let inputs = Inputs {
            speed: table_1.speed / slower,
            drive: torque,
            tolerance: 1e-9,
            ..table_1.clone()
        };
        let (solution, dynamic) = dynamic(&inputs);
        let mesh = mesh(&inputs, &solution);
        let off = |station: &Station| {
            let s = -station.roll_angle_driven * mesh.base_radii.1;
            (station.force - balance(&mesh, s, s).force).abs() / solution.mesh_force
        };
        let worst = dynamic.stations.iter().map(off).fold(0.0, f64::max);
        assert!(worst < before / 5.0 || worst < 1e-6, "{slower} {worst:e} {before:e}");
        before = worst;
    }
    assert!(before < 2e-3, "{before:e}");
}

/// The end of the first impact depends on the force and not on the integration steps: neither their
/// length nor rounding at their borders changes it.
#[test]
fn the_end_of_the_first_impact_does_not_depend_on_the_tolerance() {
    let text = r#"
        format = 1
        pair = { module = "1.5 mm", pressure_angle = "20 deg" }
        driver = { teeth = 47, face_width = "13.867 mm", bore_radius = "6 mm", young = "206 GPa", density = "7850 kg/m3", tip_relief = "5.77 um" }
        driven = { teeth = 83, profile_shift = -0.2, face_width = "13.867 mm", bore_radius = "6 mm", young = "206 GPa", density = "7850 kg/m3", tip_relief = "5.77 um" }
        deviations = { base_pitch = "19.48 um" }
        operation = { torque = "62.5624 N m", speed = "5000 rpm" }
    "#;
    let fine = Document::parse("fine", text).expect("a case").case.inputs().expect("valid");
    let mut seen = 0;
    for inputs in [fine, case("zhou-chen-2014"), case("nasa-lewis-28-28"), case("turbo-fine-fast")]
    {
        let drive = Drive::Torque(inputs.torque());
        for faster in [0.4, 0.5, 0.65, 0.8, 1.0, 1.0149, 1.25, 1.6066, 2.0] {
            let at = |tolerance: f64| {
                let speed = inputs.speed * faster;
                dynamic(&Inputs { speed, drive, tolerance, deflection: None, ..inputs.clone() })
                    .1
                    .impact_duration
            };
            let Some(reference) = at(1e-11) else { continue };
            for tolerance in [1e-4, 1e-6, 1e-8] {
                let found = at(tolerance).expect("it strikes at every tolerance");
                let off = (found / reference - 1.0).abs();
                assert!(off < 10.0 * tolerance.sqrt(), "{faster} {tolerance:e} {found:e}");
            }
            seen += 1;
        }
    }
    assert!(seen > 25, "{seen}");
}

#[test]
fn a_periodic_warm_up_ends_early_without_a_change() {
    let run = |damping_ratio: f64, warmup_cycles: u32| {
        let inputs =
            Inputs { damping_ratio, warmup_cycles, tolerance: 1e-8, ..case("zhou-chen-2014") };
        dynamic(&inputs).1
    };
    let (short, long) = (run(0.07, 20), run(0.07, 1000));
    assert!(long.evaluations < short.evaluations * 11 / 10, "{}", long.evaluations);
    let off = long.peak_force / short.peak_force - 1.0;
    assert!(off.abs() < 1e-10, "{off:e}");
    // In an undamped oscillation no base pitch repeats the previous one.
    let off = run(1e-3, 40).peak_force / run(1e-3, 20).peak_force - 1.0;
    assert!(off.abs() > 1e-8, "{off:e}");
}

#[test]
fn a_run_stops_on_request() {
    let inputs = Inputs { method: Method::Dynamic, ..case("zhou-chen-2014") };
    let refused = tipstrike::model::solve_while(&inputs, Stages::EVERY, &|part| part < 0.5);
    assert_eq!(refused.unwrap_err().code(), "stopped");
}

#[test]
fn a_too_slow_motion_is_refused_and_auto_chooses_static() {
    let slow = Inputs { speed: 1e-4, drive: Drive::Torque(70.0), ..case("zhou-chen-2014") };
    let by = |method| solve(&Inputs { method, ..slow.clone() }, Stages::EVERY);
    assert_eq!(by(Method::Dynamic).unwrap_err().code(), "too-slow");
    assert_eq!(by(Method::Auto).unwrap().method, Method::Static);
}

#[test]
fn friction_that_would_lock_the_gears_is_refused_and_less_makes_the_force_jump_at_the_pitch_point()
{
    let with = |coefficient: f64| Inputs {
        method: Method::Static,
        friction_coefficient: Some(coefficient),
        ..case("zhou-chen-2014")
    };
    assert_eq!(solve(&with(2.0), Stages::EVERY).unwrap_err().code(), "friction-locks");
    let solution = solve(&with(0.1), Stages::EVERY).unwrap();
    let jump = solution.static_load.unwrap().pitch_jump.expect("friction jumps");
    // One pair carries at the pitch point: F (1 -+ mu rho/rb) = F0 on its two sides.
    let arm = 0.1 * (solution.geometry.start + solution.geometry.approach_length)
        / solution.geometry.driver.base;
    let expected = solution.mesh_force * (1.0 / (1.0 + arm) - 1.0 / (1.0 - arm));
    assert!((jump / expected - 1.0).abs() < 1e-6, "{jump} and not {expected}");
}

/// The stiffness of a pair rises in one step where the contact leaves the tip radius, and the
/// displacement does not.
#[test]
fn with_a_tip_radius_the_force_of_slow_gears_rises_with_the_stiffness() {
    let mut inputs = Inputs {
        method: Method::Dynamic,
        base_pitch_deviation: 20e-6,
        tooth_compliance: Some(ToothCompliance::FINITE_ELEMENT),
        drive: Drive::Torque(80.0),
        ..crate::support::standard_pair(59, 70, 1e-3)
    };
    inputs.driven.tip_radius = Some(0.145e-3);
    for speed in [20.0, 2.0, 0.2] {
        let inputs = Inputs { speed, ..inputs.clone() };
        let (solution, found) = dynamic(&inputs);
        let rise = mesh(&inputs, &solution).stiffness_step();
        assert!((1.1..1.2).contains(&rise), "{rise}");
        let at_rest = solution.static_load.as_ref().expect("the load at rest").peak_force;
        let off = found.peak_force / (rise * at_rest) - 1.0;
        assert!(off.abs() < 2e-3, "{speed} rad/s: {off:e} off {rise} times {at_rest}");
        let codes: Vec<_> = notes(&inputs, &solution).into_iter().map(|note| note.code).collect();
        assert!(codes.contains(&"stiffness-step"), "{codes:?}");
    }
}
