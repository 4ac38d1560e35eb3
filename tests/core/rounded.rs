//! Rounded tips, compared with answers of another program with 50 digits, and with sharp tips.

use tipstrike::case::fields::key_of;
use tipstrike::model::inputs::{Method, ToothCompliance};
use tipstrike::model::{Inputs, Refusal, Solution, Stage, Stages, Station, solve};

use crate::support::{self, cases_with_answers, standard_pair};

fn value(solution: &Solution, key: &str) -> f64 {
    let geometry = &solution.geometry;
    match key {
        "path_start" => geometry.start,
        "path_end" => geometry.end,
        "involute_end_radius_driver" => geometry.driver.involute_end(),
        "involute_end_radius_driven" => geometry.driven.involute_end(),
        "tip_centre_radius_driven" => geometry.driven.tip - geometry.driven.edge,
        _ => support::value(solution, key).unwrap(),
    }
}

#[test]
fn every_rounded_pair_agrees_within_1e_11() {
    let pairs = cases_with_answers("tests/reference/rounded");
    assert_eq!(pairs.len(), 12);
    for (name, inputs, answers) in pairs {
        let solution = solve(&inputs, Stages::ALL).unwrap();
        for (key, expected) in answers.as_object().unwrap() {
            let Some(expected) = expected.as_f64() else {
                assert_eq!(expected, solution.outcome.name(), "{name}");
                continue;
            };
            let found = value(&solution, key);
            let off = (found / expected - 1.0).abs();
            assert!(off < 1e-11, "{name}: {key} is {found}, expected {expected}");
        }
    }
}

/// A loaded pair with a deviation and with tips of one radius.
fn pair(method: Method, tip_radius: Option<f64>) -> Inputs {
    let mut inputs = standard_pair(20, 33, 4e-3);
    (inputs.method, inputs.base_pitch_deviation) = (method, 12e-6);
    (inputs.driver.tip_radius, inputs.driven.tip_radius) = (tip_radius, tip_radius);
    inputs
}

#[test]
fn a_vanishing_tip_radius_gives_the_geometry_of_a_sharp_tip() {
    let keys = "contact_ratio approach_angle_driven contact_radius_driver contact_radius_driven \
        contact_normal_radius_driven normal_velocity sliding_velocity";
    let sharp = solve(&pair(Method::Exact, None), Stages::ALL).unwrap();
    for radius in [1e-6, 1e-8, 1e-10] {
        let rounded = solve(&pair(Method::Exact, Some(radius)), Stages::ALL).unwrap();
        for key in keys.split(' ') {
            let off = (value(&rounded, key) / value(&sharp, key) - 1.0).abs();
            assert!(off < 20.0 * radius / 4e-3, "{key} off by {off:e} at {radius:e} m");
        }
    }
}

/// The station at E' of a solve by `static` or `dynamic`.
fn station_at_start(solution: &Solution) -> &Station {
    let rest = solution.static_load.as_ref().map(|load| &load.stations);
    let motion = solution.dynamic.as_ref().map(|dynamic| &dynamic.stations);
    let stations = motion.or(rest).expect("a method that shares the load");
    let mut at_start = stations.iter().filter(|station| station.roll_angle_driven == 0.0);
    at_start.next().expect("a station at E'")
}

#[test]
fn contact_on_the_line_of_action_begins_on_the_flank_and_not_on_the_arc() {
    for method in [Method::Static, Method::Dynamic] {
        let at = |radius| {
            let inputs = Inputs { friction_coefficient: None, ..pair(method, radius) };
            solve(&inputs, Stages::of(method_stage(method))).unwrap()
        };
        let (sharp, rounded) = (at(None), at(Some(1e-9)));
        let compliances = [&sharp, &rounded]
            .map(|solution| station_at_start(solution).pair_compliance.expect("a load"));
        let off = compliances[1] / compliances[0] - 1.0;
        assert!(off.abs() < 1e-5, "{method:?}: {compliances:?}");
        let (mesh, station) = (rounded.mesh.as_ref().unwrap(), station_at_start(&rounded));
        let pairs = mesh.pair_set(0.0, 1e-7 * mesh.base_pitch);
        let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0).unwrap();
        let force = pairs.forces(station.transmission_error().expect("a load"))[incoming];
        let off = station.force / force - 1.0;
        assert!(force > 0.0 && off.abs() < 1e-9, "{method:?}: {off:e}");
        if method == Method::Static {
            let [sharp, rounded] =
                [&sharp, &rounded].map(|solution| value(solution, "static_force_at_start"));
            assert!((rounded / sharp - 1.0).abs() < 1e-5, "{rounded} and {sharp}");
            assert_eq!(rounded.to_bits(), station.force.to_bits());
        }
    }
}

fn method_stage(method: Method) -> Stage {
    if method == Method::Static { Stage::Static } else { Stage::Dynamic }
}

#[test]
fn a_tip_radius_moves_the_first_contact_of_every_method_but_paper() {
    for method in [Method::Exact, Method::Static, Method::Dynamic] {
        let key = match method {
            Method::Static => "static_first_contact_angle",
            Method::Dynamic => "dynamic_first_contact_angle",
            _ => "approach_angle_driven",
        };
        let [sharp, rounded] =
            [None, Some(0.4e-3)].map(|radius| solve(&pair(method, radius), Stages::EVERY).unwrap());
        let ratios = [&sharp, &rounded].map(|solution| value(solution, "contact_ratio"));
        assert!(ratios[1] < 0.98 * ratios[0], "{method:?}: contact ratios {ratios:?}");
        let angles = [&sharp, &rounded].map(|solution| value(solution, key));
        assert!((angles[1] / angles[0] - 1.0).abs() > 0.01, "{method:?}: first contact {angles:?}");
    }
    let [sharp, rounded] = [None, Some(0.4e-3)]
        .map(|radius| solve(&pair(Method::Paper, radius), Stages::ALL).unwrap());
    assert_eq!(sharp.geometry, rounded.geometry);
    assert_eq!(sharp.position.unwrap().contact, rounded.position.unwrap().contact);
}

#[test]
fn a_tip_radius_at_run_out_moves_the_last_contact() {
    let mut inputs = pair(Method::Static, None);
    let sharp = solve(&inputs, Stages::EVERY).unwrap();
    inputs.driver.tip_radius = Some(0.4e-3);
    let rounded = solve(&inputs, Stages::EVERY).unwrap();
    assert_eq!(sharp.geometry.start.to_bits(), rounded.geometry.start.to_bits());
    let key = "static_last_contact_angle";
    let (sharp, rounded) = (value(&sharp, key), value(&rounded, key));
    assert!((rounded / sharp - 1.0).abs() > 0.01, "last contact {sharp} and {rounded}");
}

#[test]
fn a_tip_radius_beyond_its_limits_is_refused_by_name() {
    let refusal = |change: &dyn Fn(&mut Inputs)| {
        let mut inputs = pair(Method::Exact, None);
        change(&mut inputs);
        solve(&inputs, Stages::ALL).unwrap_err()
    };
    let too_wide = refusal(&|inputs| inputs.driven.tip_radius = Some(0.75 * inputs.module));
    assert!(matches!(too_wide, Refusal::RoundingTooWide { .. }), "{too_wide}");
    assert_eq!(key_of(too_wide.at()), "driven.tip_radius");
    let inside = refusal(&|inputs| inputs.driver.tip_radius = Some(2.0 * inputs.module));
    assert!(matches!(inside, Refusal::RoundingInsideBase { .. }), "{inside}");
    let apart = refusal(&|inputs| {
        (inputs.driver.addendum, inputs.driven.addendum) = (0.6, 0.6);
        let radius = Some(0.25 * inputs.module);
        (inputs.driver.tip_radius, inputs.driven.tip_radius) = (radius, radius);
    });
    assert!(matches!(apart, Refusal::RoundingBreaksContact { .. }), "{apart}");
}

/// Chamfer and tip radius of a gear, times the module.
type Tip = (f64, Option<f64>);

/// The refusal of z 20/33 with such tips at a part of the reference centre distance: its code and
/// field.
fn refusal_of(method: Method, [driver, driven]: [Tip; 2], distance: f64) -> [&'static str; 2] {
    let mut inputs = pair(method, None);
    let module = inputs.module;
    for (gear, (chamfer, radius)) in [(&mut inputs.driver, driver), (&mut inputs.driven, driven)] {
        gear.tip_chamfer = chamfer * module;
        gear.tip_radius = radius.map(|radius| radius * module);
    }
    let teeth = f64::from(inputs.driver.teeth + inputs.driven.teeth);
    inputs.centre_distance = Some(distance * 0.5 * module * teeth);
    (inputs.deflection, inputs.tooth_compliance) = (None, Some(ToothCompliance::BEAM));
    let refusal = solve(&inputs, Stages::ALL).unwrap_err();
    [refusal.code(), key_of(refusal.at())]
}

/// The refusal of a path that the tips shorten names the field that shortens it the most.
#[test]
fn a_refused_path_names_the_chamfer_or_radius_that_causes_it() {
    let (sharp, round) = ((0.0, None), (0.0, Some(0.1)));
    for (tips, distance, field) in [
        ([(0.8, Some(0.1)), sharp], 1.0, "driver.tip_chamfer"),
        ([(0.8, None), round], 1.0, "driver.tip_chamfer"),
        ([round, (0.8, None)], 1.0, "driven.tip_chamfer"),
        ([(0.5, None), (0.6, Some(0.1))], 1.0, "driven.tip_chamfer"),
        ([(0.0, Some(0.2)), sharp], 1.025, "driver.tip_radius"),
    ] {
        let refusal = refusal_of(Method::Exact, tips, distance);
        assert_eq!(refusal, ["tip-radius-breaks-contact", field], "{tips:?}");
    }
    for (method, tips, distance, field) in [
        (Method::Exact, [(0.9, None), sharp], 1.0, "driver.tip_chamfer"),
        (Method::Static, [sharp, (0.8, None)], 1.0, "driven.tip_chamfer"),
        (Method::Exact, [sharp, sharp], 1.03, "driven.addendum"),
    ] {
        let refusal = refusal_of(method, tips, distance);
        assert_eq!(refusal, ["contact-ratio-below-1", field], "{tips:?}");
    }
    for (tips, distance, refusal) in [
        ([(1.58, None), sharp], 1.0, ["no-path", "driver.tip_chamfer"]),
        ([sharp, sharp], 1.2, ["no-path", "pair.centre_distance"]),
        ([sharp, (9.0, None)], 1.0, ["tip-inside-base", "driven.tip_chamfer"]),
    ] {
        assert_eq!(refusal_of(Method::Exact, tips, distance), refusal, "{tips:?}");
    }
}

/// A driven gear with five teeth: a large deviation turns the contact normal past its centre, where
/// the contact leaves the tip arc.
#[test]
fn a_contact_beyond_the_arc_of_the_tip_is_refused() {
    let mut inputs = standard_pair(20, 5, 4e-3);
    inputs.pressure_angle = 28f64.to_radians();
    inputs.driven.addendum = 0.6;
    inputs.deflection = Some(1e-6);
    inputs.tooth_compliance = Some(ToothCompliance::BEAM);
    inputs.driven.tip_radius = Some(0.05e-3);
    for (deviation, is_beyond) in [(1e-3, false), (2e-3, true)] {
        inputs.base_pitch_deviation = deviation;
        let solved = solve(&inputs, Stages::CLOSED_FORM);
        let refusal = match &solved {
            Ok(solution) => solution.withheld,
            Err(refusal) => Some(*refusal),
        };
        let beyond = matches!(refusal, Some(Refusal::BeyondRounding { .. }));
        assert_eq!(beyond, is_beyond, "{deviation}: {refusal:?}");
        if let Some(refusal) = refusal.filter(|_| beyond) {
            assert_eq!(refusal.code(), "beyond-tip-rounding");
            assert!(refusal.to_string().contains("rb2' is -"), "{refusal}");
        }
    }
}
