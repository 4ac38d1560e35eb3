//! The face width: independent answers for pairs in slices, and what must hold for every pair.
use crate::support::{inputs, standard_pair};

use serde_json::Value;
use tipstrike::case::file::Document;
use tipstrike::model::inputs::{Drive, Hand, Method};
use tipstrike::model::slices::Face;
use tipstrike::model::slices::balance::Until;
use tipstrike::model::{ContactState, Inputs, Outcome, Quantity, Solution, Stage, Stages, solve};

const STATIC: Stages = Stages::of(Stage::Static).and(Stages::of(Stage::StaticSpectrum));

/// The case and the answers of a file of the references.
fn reference(name: &str) -> (Inputs, Value) {
    let path = format!("{}/tests/reference/helical/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the reference");
    let all: Value = serde_json::from_str(&text).expect("JSON");
    let case = all["case"].as_str().expect("a case");
    let document = Document::parse(name, case).unwrap_or_else(|faults| panic!("{}", faults[0]));
    let inputs = document.case.inputs().unwrap_or_else(|faults| panic!("{}", faults[0].cause));
    (Inputs { method: Method::Static, ..inputs }, all["results"].clone())
}

/// The names of the references, and whether their slices are coupled.
const REFERENCES: [(&str, bool); 8] = [
    ("01-spur", false),
    ("02-beta8", false),
    ("03-iso-tr-6336-30-example-1", false),
    ("04-beta20-relief-crowning", false),
    ("05-spur-misaligned-crowned", false),
    ("06-beta25-left-offset", false),
    ("07-beta30-coupled", true),
    ("08-beta33-rounded", true),
];

#[track_caller]
fn close(name: &str, found: f64, expected: &Value, tolerance: f64) {
    let expected = expected.as_f64().unwrap_or_else(|| panic!("{name} has no answer"));
    let off = if expected == 0.0 { found.abs() } else { (found / expected - 1.0).abs() };
    assert!(off <= tolerance, "{name}: {found:e} for {expected:e}, off by {off:.1e}");
}

#[test]
fn geometry_agrees_to_1e_12() {
    for (name, _) in REFERENCES {
        let (inputs, answers) = reference(name);
        let solution = solve(&inputs, Stages::of(Stage::Load)).expect(name);
        let (geometry, answers) = (&solution.geometry, &answers["geometry"]);
        let pairs = [
            ("transverse_module", inputs.transverse_module()),
            ("transverse_pressure_angle", inputs.transverse_pressure_angle()),
            ("base_helix_angle", inputs.base_helix_angle()),
            ("working_pressure_angle", geometry.working_pressure_angle),
            ("centre_distance", geometry.centre_distance),
            ("base_pitch", geometry.base_pitch),
            ("path_start", geometry.start),
            ("path_end", geometry.end),
            ("common_face_width", inputs.common_width()),
            ("transverse_contact_ratio", geometry.contact_ratio),
            ("mesh_force", solution.mesh_force),
        ];
        for (key, found) in pairs {
            close(&format!("{name}: {key}"), found, &answers[key], 1e-12);
        }
        for (at, circles) in [&geometry.driver, &geometry.driven].into_iter().enumerate() {
            for (key, found) in [
                ("reference_radius", circles.reference),
                ("base_radius", circles.base),
                ("tip_radius", circles.tip),
                ("root_radius", circles.root),
            ] {
                close(&format!("{name}: {key}"), found, &answers[key][at], 1e-12);
            }
        }
        let helix = &solution.helix;
        close(name, helix.overlap_ratio, &answers["overlap_ratio"], 1e-12);
        close(name, helix.axial_force.abs(), &answers["axial_force"], 1e-12);
        if solution.is_helical() {
            close(name, helix.axial_pitch, &answers["axial_pitch"], 1e-12);
        }
        for (at, found) in helix.virtual_teeth.into_iter().enumerate() {
            close(name, found, &answers["virtual_teeth"][at], 1e-12);
        }
    }
}

/// The load at rest with many slices: the answers have an error of about 1e-6 themselves.
#[test]
fn first_contact_and_loads_agree_with_an_independent_solution() {
    for (name, is_coupled) in REFERENCES {
        let (mut inputs, answers) = reference(name);
        inputs.slices = Some(if is_coupled { 2049 } else { 1025 });
        let tolerance = if is_coupled { 1e-4 } else { 1e-5 };
        let solution = solve(&inputs, STATIC).expect(name);
        let load = solution.static_load.as_ref().expect(name);
        let passage = &answers["passage"];
        let within = |key: &str, found: f64, expected: &Value| {
            close(&format!("{name}: {key}"), found, expected, tolerance);
        };
        within("peak force", load.peak_force, &passage["peak_force"]);
        let spectrum = solution.static_spectrum.expect(name).expect(name).spectrum;
        let te = &answers["cycle"]["transmission_error"];
        close(&format!("{name}: TE"), spectrum.peak_to_peak, te, 3.0 * tolerance);
        let angle = Quantity::find("static_first_contact_angle").unwrap().finite_value(&solution);
        within("first contact angle", angle.unwrap(), &passage["first_contact_angle"]);
        let Some(face) = &solution.face_load else { continue };
        let cycle = solution.face_cycle.as_ref().expect(name);
        within("first contact", face.first.path, &passage["first_transverse_place"]);
        within("first z", face.first.z, &passage["first_z"]);
        within("last z", face.last.z, &passage["last_z"]);
        within("mean x", cycle.mean_displacement, &answers["cycle"]["x_mean"]);
        inputs.base_pitch_deviation = 0.0;
        let even = solve(&inputs, Stages::of(Stage::Static)).expect(name);
        let even = even.face_load.expect(name);
        let peaks = [
            (Some(even.peak), "peak"),
            (even.before_start, "peak_before_E"),
            (even.after_end, "peak_after_B"),
        ];
        for (peak, key) in peaks {
            match peak {
                Some(peak) => within(key, peak.line_load, &answers[key]["line_load"]),
                None => assert!(answers[key].is_null(), "{name}: {key}"),
            }
        }
    }
}

fn helical() -> Inputs {
    let mut inputs = standard_pair(23, 41, 3e-3);
    (inputs.driver.face_width, inputs.driven.face_width) = (25e-3, 25e-3);
    inputs.method = Method::Static;
    inputs.drive = Drive::Torque(250.0);
    inputs.base_pitch_deviation = 6e-6;
    inputs.helix_angle = 18f64.to_radians();
    inputs
}

fn values(solution: &Solution) -> [f64; 8] {
    let load = solution.static_load.as_ref().expect("a load");
    let spectrum = solution.static_spectrum.expect("a spectrum").expect("a spectrum").spectrum;
    [
        load.first_contact_angle.unwrap_or(0.0),
        load.force_at_start,
        load.peak_force,
        load.transmission_error,
        spectrum.peak_to_peak,
        spectrum.amplitudes[0],
        spectrum.amplitudes[1],
        spectrum.amplitudes[3],
    ]
}

/// Nothing jumps between a spur pair and one that is almost spur.
#[test]
fn a_small_helix_angle_or_misalignment_changes_nothing() {
    let spur = Inputs { helix_angle: 0.0, ..helical() };
    let expected = values(&solve(&spur, STATIC).expect("a spur pair"));
    let almost = [
        ("helix angle", Inputs { helix_angle: 1e-6f64.to_radians(), ..spur.clone() }),
        ("misalignment", Inputs { misalignment: 1e-12, ..spur.clone() }),
    ];
    for (name, inputs) in almost {
        let solution = solve(&inputs, STATIC).expect(name);
        assert!(solution.face_load.is_some(), "{name} has no slices");
        for (found, expected) in values(&solution).into_iter().zip(expected) {
            let off = (found / expected - 1.0).abs();
            assert!(off < 1e-6, "{name}: {found:e} for {expected:e}");
        }
    }
}

/// A pair of the other hand and with the opposite misalignment is the mirror image.
#[test]
fn the_other_hand_and_misalignment_mirror_the_load() {
    let one = Inputs { misalignment: 7e-6, ..helical() };
    let other = Inputs { misalignment: -7e-6, driver_hand: Hand::Left, ..helical() };
    let [one, other] = [one, other].map(|inputs| solve(&inputs, STATIC).expect("a load"));
    let [this, that] = [&one, &other].map(|solution| solution.face_load.as_ref().expect("slices"));
    assert_eq!(this.first.z.to_bits(), (-that.first.z).to_bits());
    assert!((this.peak.place.z + that.peak.place.z).abs() < 1e-9);
    for (one, other) in values(&one).into_iter().zip(values(&other)) {
        assert!((one / other - 1.0).abs() < 1e-9, "{one:e} {other:e}");
    }
    let row = this.pattern.len() / 2;
    let mirrored = that.pattern[row].iter().rev();
    let most = this.peak.line_load;
    for (one, other) in this.pattern[row].iter().zip(mirrored) {
        assert!((one - other).abs() < 1e-6 * most, "{one:e} {other:e}");
    }
}

/// Nothing jumps: a step changes a value by about as much as the steps beside it.
#[test]
fn first_contact_and_forces_are_continuous_over_helix_angle_and_misalignment() {
    let at = |degrees: f64, misalignment: f64| {
        let inputs = Inputs { helix_angle: degrees.to_radians(), misalignment, ..helical() };
        let solution = solve(&inputs, Stages::of(Stage::Static)).expect("a load");
        let load = solution.static_load.expect("a load");
        let angle = load.first_contact_angle.unwrap_or(0.0);
        [angle, load.stations[0].normal_velocity, load.peak_force, load.force_at_start]
    };
    let over_helix: Vec<_> = (0..=60).map(|half| at(0.5 * f64::from(half), 7e-6)).collect();
    let over_tilt: Vec<_> = (-50..=50).map(|um| at(18.0, 1e-6 * f64::from(um))).collect();
    for (rows, name) in [(over_helix, "helix angle"), (over_tilt, "misalignment")] {
        for value in 0..4 {
            let size = rows.iter().map(|row| row[value].abs()).fold(0.0, f64::max);
            for four in rows.windows(4) {
                let [before, change, after] =
                    [0, 1, 2].map(|at| (four[at + 1][value] - four[at][value]).abs());
                let most = 2.0 * before.max(after) + 1e-3 * size;
                assert!(change <= most, "{name}, value {value}: {change:e} at {four:?}");
            }
        }
    }
}

#[test]
fn a_corner_contact_is_found_and_relief_removes_it() {
    let inputs = helical();
    let wanted = STATIC.and(Stages::of(Stage::Clearing));
    let solution = solve(&inputs, wanted).expect("a load");
    assert_eq!(solution.outcome, Outcome::CornerContact);
    let face = solution.face_load.as_ref().expect("slices");
    assert!(face.before_start.is_some_and(|peak| peak.line_load < face.peak.line_load * 1.001));
    let more = solution.clearing.expect("a relief").relief.expect("a relief");
    let many = Inputs { slices: Some(129), ..inputs.clone() };
    let many = solve(&many, Stages::of(Stage::Clearing)).expect("a load").clearing;
    let by_many = many.expect("a relief").relief.expect("a relief");
    assert!((more / by_many - 1.0).abs() < 1e-4, "{more:e} for {by_many:e}");
    let mut relieved = inputs;
    relieved.driven.tip_relief += 1.001 * more;
    let outcome = solve(&relieved, STATIC).expect("a load").outcome;
    assert_eq!(outcome, Outcome::NoCornerContact);
}

const MOVING: Stages = Stages::of(Stage::Dynamic).with(Stage::SteadyMotion);

/// Results of the motion.
fn moved(inputs: &Inputs) -> [f64; 8] {
    let solution = solve(inputs, MOVING).expect("a motion");
    let motion = solution.dynamic.expect("a motion");
    let steady = solution.steady.expect("a motion").expect("a steady motion");
    [
        motion.first_contact_angle.unwrap_or(0.0),
        motion.peak_approach_force,
        motion.peak_force,
        motion.last_contact_angle.unwrap_or(0.0),
        motion.friction_work.unwrap_or(0.0),
        steady.spectrum.peak_to_peak,
        steady.spectrum.amplitudes[0],
        steady.tooth_force,
    ]
}

/// The motion of a spur pair is computed by power series, that of slices in steps.
#[test]
fn a_small_helix_angle_does_not_change_the_motion() {
    let spur = Inputs {
        method: Method::Dynamic,
        friction_coefficient: Some(0.05),
        tolerance: 1e-8,
        slices: Some(9),
        speed: 150.0,
        ..standard_pair(20, 35, 3e-3)
    };
    let spur = Inputs { base_pitch_deviation: 8e-6, ..spur };
    assert!(spur.face().is_none());
    let helical = Inputs { helix_angle: 1e-6_f64.to_radians(), ..spur.clone() };
    for (at, (one, other)) in moved(&spur).into_iter().zip(moved(&helical)).enumerate() {
        let off = (other / one - 1.0).abs();
        // The friction work is a sum over samples.
        let tolerance = if at == 4 { 1e-4 } else { 1e-6 };
        assert!(off <= tolerance, "{at}: {other:e} for {one:e}, off by {off:.1e}");
    }
}

/// With the usual slices and tolerance, after a slight first touch and with a bend of the force at E.
#[test]
fn an_impact_of_slices_that_are_alike_ends_with_that_of_the_spur_pair() {
    for (case, deviation, speed, torque, damping_ratio, relief) in [
        ("tip-relief-enough", 3e-6, 94.25, 30.0, 0.15, 5e-6),
        ("hydro-speed-up", 15e-6, 94.25, 5.0, 0.07, 20e-6),
    ] {
        let mut spur = inputs(&format!("cases/{case}.toml"));
        (spur.method, spur.base_pitch_deviation) = (Method::Dynamic, deviation);
        (spur.speed, spur.drive, spur.damping_ratio) =
            (speed, Drive::Torque(torque), damping_ratio);
        (spur.driven.tip_relief, spur.driver.root_relief) = (relief, 0.0);
        let [one, other] = [0.0, 1e-6_f64.to_radians()].map(|helix_angle| {
            let inputs = Inputs { helix_angle, ..spur.clone() };
            let solution = solve(&inputs, Stages::of(Stage::Dynamic)).expect("a motion");
            solution.dynamic.expect("a motion").impact_duration.expect("an impact")
        });
        assert!((other / one - 1.0).abs() < 1e-5, "{case}, {speed}: {other:e} for {one:e}");
    }
}

#[test]
fn a_slow_motion_has_the_load_at_rest_and_a_smaller_tolerance_the_same_motion() {
    let pair = Inputs { method: Method::Dynamic, ..helical() };
    let still = solve(&Inputs { method: Method::Static, ..pair.clone() }, STATIC).expect("a load");
    let slow = solve(&Inputs { speed: 3.0, ..pair.clone() }, MOVING).expect("a motion");
    let peak = still.static_load.unwrap().peak_force;
    let slow_peak = slow.dynamic.unwrap().peak_force;
    assert!((slow_peak / peak - 1.0).abs() < 2e-3, "{slow_peak} for {peak}");
    let [at_rest, line_load] =
        [still.face_load.unwrap(), slow.face_motion.unwrap()].map(|face| face.peak.line_load);
    assert!((line_load / at_rest - 1.0).abs() < 2e-3, "{line_load} for {at_rest}");
    let with = |tolerance: f64| Inputs { tolerance, slices: Some(33), ..pair.clone() };
    for (one, other) in moved(&with(1e-4)).into_iter().zip(moved(&with(1e-7))) {
        assert!((one - other).abs() <= 1e-3 * other.abs(), "{one:e} for {other:e}");
    }
}

#[test]
fn the_relief_that_clears_the_motion_clears_it() {
    let pair = Inputs { method: Method::Dynamic, ..helical() };
    let solution = solve(&pair, MOVING.with(Stage::Clearing)).expect("a motion");
    let more = solution.clearing.expect("a relief").relief.expect("a relief");
    for (part, strikes) in [(0.999, true), (1.01, false)] {
        let mut relieved = pair.clone();
        relieved.driven.tip_relief += part * more;
        let found = solve(&relieved, Stages::of(Stage::Dynamic)).expect("a motion");
        let force = found.dynamic.expect("a motion").peak_approach_force;
        assert_eq!([found.outcome == Outcome::CornerContact, force > 0.0], [strikes; 2], "{part}");
    }
}

/// Tip forces and transmission error, in all harmonics, by the usual slices against many slices.
#[test]
fn the_usual_slices_strike_and_excite_within_1e_3_of_many() {
    const PLACES: usize = 512;
    for (degrees, width, misalignment, [relief, length]) in [
        (20.0, 25e-3, 0.0, [0.0; 2]),
        (30.0, 40e-3, 20e-6, [0.0; 2]),
        (4.0, 75e-3, 0.0, [0.0; 2]),
        (25.0, 45e-3, 15e-6, [0.0; 2]),
        (15.0, 20e-3, 10e-6, [20e-6, 3e-3]),
    ] {
        let mut pair = Inputs { misalignment, ..helical() };
        pair.helix_angle = f64::to_radians(degrees);
        for gear in [&mut pair.driver, &mut pair.driven] {
            (gear.face_width, gear.tip_relief) = (width, relief);
            gear.tip_relief_length = Some(length).filter(|length| *length > 0.0);
        }
        let solution = solve(&pair, Stages::of(Stage::Static)).expect("a load");
        let mesh = solution.mesh.as_ref().expect("a mesh");
        let error = |slices| -> Vec<f64> {
            let inputs = Inputs { slices, ..pair.clone() }.face().expect("a face");
            let face = Face::new(&inputs, &solution.geometry, mesh).expect("slices");
            let place = |step: usize| mesh.base_pitch * step as f64 / PLACES as f64;
            let at = |step| face.loads(place(step), 0.0, Until::Force(mesh.force));
            (0..PLACES).map(|step| at(step).expect("a load").displacement).collect()
        };
        let (usual, many) = (error(None), error(Some(513)));
        let off: Vec<f64> = usual.iter().zip(&many).map(|(usual, many)| usual - many).collect();
        let amplitude = |values: &[f64], order: usize| {
            let turn = std::f64::consts::TAU * order as f64 / PLACES as f64;
            let turned = |of: fn(f64) -> f64| (0..PLACES).map(move |at| of(turn * at as f64));
            let part = |of| turned(of).zip(values).map(|(part, value)| part * value).sum::<f64>();
            2.0 * part(f64::cos).hypot(part(f64::sin)) / PLACES as f64
        };
        let first = amplitude(&many, 1);
        for order in 1..PLACES / 2 {
            let off = amplitude(&off, order) / first;
            assert!(off < 1e-3, "{degrees} deg, {width} m, order {order}: {off:.1e}");
        }
        let load = |slices| solve(&Inputs { slices, ..pair.clone() }, STATIC).expect("a load");
        let (usual, many) = (load(None), load(Some(513)));
        let spectrum = usual.static_spectrum.expect("a spectrum").expect("a spectrum").spectrum;
        assert!((spectrum.amplitudes[0] / first - 1.0).abs() < 1e-3);
        let of = |found: &Solution| {
            let peak = found.face_load.as_ref().expect("slices").peak.line_load;
            let greatest = found.face_cycle.as_ref().expect("slices").peak_line_load;
            values(found).into_iter().chain([peak, greatest])
        };
        for (usual, many) in of(&usual).zip(of(&many)) {
            assert!((usual - many).abs() <= 1e-3 * many, "{degrees} deg: {usual:e} {many:e}");
        }
    }
}

/// With the load in proportion to the face width.
#[test]
fn faces_of_1_mm_to_1_m_have_alike_loads() {
    let of_width = |width: f64| {
        let mut pair = Inputs { helix_angle: 12f64.to_radians(), ..helical() };
        (pair.driver.face_width, pair.driven.face_width) = (width, width);
        pair.drive = Drive::Torque(1e4 * width);
        let solution = solve(&pair, Stages::of(Stage::StaticSpectrum)).expect("a load");
        let cycle = solution.face_cycle.expect("slices");
        (cycle.mean_displacement, cycle.peak_line_load / cycle.mean_line_load)
    };
    let (widest, _) = of_width(1.0);
    for width in [1e-3, 1e-2, 0.1] {
        let (displacement, factor) = of_width(width);
        assert!((0.9..1.2).contains(&(displacement / widest)), "{width}: {displacement:e}");
        assert!((1.0..1.1).contains(&factor), "{width}: {factor}");
    }
}

#[test]
fn what_slices_cannot_answer_is_refused_by_name() {
    let code = |inputs: Inputs| solve(&inputs, STATIC).expect_err("a refusal").code();
    assert_eq!(code(Inputs { slices: Some(3), ..helical() }), "too-few-slices");
    let mut short = helical();
    (short.driver.addendum, short.driven.addendum) = (0.45, 0.45);
    (short.driver.face_width, short.driven.face_width) = (2e-3, 2e-3);
    assert_eq!(code(short), "total-contact-ratio-below-1");
    let mut long = helical();
    (long.driven.end_reliefs, long.driven.end_relief_length) = ([5e-6; 2], Some(15e-3));
    assert_eq!(code(long), "end-reliefs-overlap");
    assert_eq!(code(Inputs { method: Method::Paper, ..helical() }), "not-over-face");
    let mut light = Inputs { backlash: 1e-6, base_pitch_deviation: 4e-5, ..helical() };
    (light.drive, light.speed) = (Drive::Torque(1.0), 900.0);
    let light = Inputs { method: Method::Dynamic, ..light };
    let refusal = solve(&light, Stages::of(Stage::Dynamic)).expect_err("back flanks");
    assert_eq!(refusal.code(), "back-flanks-over-face");
    let inputs = Inputs { method: Method::Exact, ..helical() };
    let exact = solve(&inputs, Stages::CLOSED_FORM).expect("a place");
    assert!(exact.position.is_some() && exact.impact.is_none());
    assert_eq!(exact.withheld.map(|refusal| refusal.code()), Some("not-over-face"));
    assert!(ContactState::at(&inputs, &exact, 0.0).expect("a state").interpolated.is_none());
}
