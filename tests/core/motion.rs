//! Properties of method `dynamic` for any pair: rest, free oscillation, energy, and the static load
//! at low speed.
use tipstrike::case::Document;
use tipstrike::model::inputs::{Drive, Method, ToothCompliance};
use tipstrike::model::mesh::Mesh;
use tipstrike::model::static_load::balance;
use tipstrike::model::{Dynamic, Inputs, Solution, Stages, notes, solve};

fn case(name: &str) -> Inputs {
    let path = format!("{}/cases/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Document::read(path.as_ref())
        .unwrap_or_else(|error| panic!("{error}"))
        .case
        .inputs()
        .expect("a valid case")
}

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
        let off = |station: &tipstrike::model::Station| {
            let s = -station.roll_angle_driven * mesh.base_radii.1;
            (station.force - balance(&mesh, s, s).force).abs() / solution.mesh_force
        };
        let worst = dynamic.stations.iter().map(off).fold(0.0, f64::max);
        assert!(
            worst < before / 5.0 || worst < 1e-6,
            "{slower} times slower: {worst:e} after {before:e}"
        );
        before = worst;
    }
    assert!(before < 2e-3, "{before:e}");
}

/// The equation solved again, with forces directly from the mesh: classical Runge-Kutta steps of
/// fixed length without events. Returns the greatest force of the incoming tooth, from
/// `warmup_cycles` base pitches before E.
fn plain_peak(inputs: &Inputs, solution: &Solution, steps: u32) -> f64 {
    let mesh = mesh(inputs, solution);
    let mass = solution.reduced_mass;
    let damping = 2.0 * inputs.damping_ratio * (mesh.mean_stiffness() * mass).sqrt();
    let slope = |t: f64, [x, v]: [f64; 2]| {
        let s = t * mesh.speed;
        let pairs = mesh.pair_set(s, s);
        let forces = pairs.forces(x);
        let drag = if forces.iter().any(|&force| force > 0.0) { damping * v } else { 0.0 };
        [v, (mesh.force - forces.iter().sum::<f64>() - drag) / mass]
    };
    let along = |y: [f64; 2], slope: [f64; 2], h: f64| [y[0] + h * slope[0], y[1] + h * slope[1]];
    let start = -f64::from(inputs.warmup_cycles) * mesh.base_pitch;
    let from = start / mesh.speed;
    let h = (1.2 * mesh.length - start) / mesh.speed / f64::from(steps);
    let mut y = [balance(&mesh, start, start + 1e-9 * mesh.base_pitch).displacement, 0.0];
    let mut peak = 0.0f64;
    for step in 0..steps {
        let t = from + f64::from(step) * h;
        let one = slope(t, y);
        let two = slope(t + 0.5 * h, along(y, one, 0.5 * h));
        let three = slope(t + 0.5 * h, along(y, two, 0.5 * h));
        let four = slope(t + h, along(y, three, h));
        y = std::array::from_fn(|part| {
            y[part] + h / 6.0 * (one[part] + 2.0 * (two[part] + three[part]) + four[part])
        });
        let s = (t + h) * mesh.speed;
        let pairs = mesh.pair_set(s, s);
        let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0);
        peak = peak.max(incoming.map_or(0.0, |incoming| pairs.forces(y[0])[incoming]));
    }
    peak
}

#[test]
fn fixed_steps_give_the_same_peak() {
    for name in ["zhou-chen-2014", "nasa-lewis-28-28", "high-contact-ratio"] {
        let inputs = Inputs {
            tolerance: 1e-10,
            warmup_cycles: 3,
            tooth_compliance: Some(ToothCompliance::KUANG_YANG),
            ..case(name)
        };
        let (solution, found) = dynamic(&inputs);
        let off =
            |steps: u32| (plain_peak(&inputs, &solution, steps) / found.peak_force - 1.0).abs();
        let (coarse, fine) = (off(20_000), off(80_000));
        assert!(fine < 2e-7 && fine < 0.5 * coarse.max(4e-9), "{name}: {coarse:e} and {fine:e}");
    }
}

#[test]
fn the_error_falls_with_the_tolerance_and_the_effort_grows_slowly() {
    let inputs = case("zhou-chen-2014");
    let run = |tolerance: f64| dynamic(&Inputs { tolerance, ..inputs.clone() }).1;
    let reference = run(1e-12).peak_force;
    let mut effort = 0;
    for exponent in [3, 5, 7, 9] {
        let tolerance = 10f64.powi(-exponent);
        let found = run(tolerance);
        assert!(
            (found.peak_force / reference - 1.0).abs() <= tolerance,
            "{tolerance:e}: {}",
            found.peak_force
        );
        assert!(found.evaluations >= effort && (effort == 0 || found.evaluations < 3 * effort));
        effort = found.evaluations;
    }
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
                assert!(
                    off < 10.0 * tolerance.sqrt(),
                    "{faster} times as fast at {tolerance:e}: {found:e} s and not {reference:e} s"
                );
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
    assert!(
        long.evaluations < short.evaluations * 11 / 10,
        "{:?} {:?}",
        short.evaluations,
        long.evaluations
    );
    assert!(
        (long.peak_force / short.peak_force - 1.0).abs() < 1e-10,
        "{} {}",
        short.peak_force,
        long.peak_force
    );
    // In an undamped oscillation no base pitch repeats the previous one.
    let (short, long) = (run(1e-3, 20), run(1e-3, 40));
    assert!(
        (long.peak_force / short.peak_force - 1.0).abs() > 1e-8,
        "{} {}",
        short.peak_force,
        long.peak_force
    );
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
    let refused =
        solve(&Inputs { method: Method::Dynamic, ..slow.clone() }, Stages::EVERY).unwrap_err();
    assert_eq!(refused.code(), "too-slow");
    assert_eq!(
        solve(&Inputs { method: Method::Auto, ..slow }, Stages::EVERY).unwrap().method,
        Method::Static
    );
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
