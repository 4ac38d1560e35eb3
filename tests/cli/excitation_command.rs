//! The command `excitation`: its series, its system integrated as another solver does, and its formats.
use crate::program;
use serde_json::Value;

const TABLE_1: &str = "cases/zhou-chen-2014.toml";
const FZG: &str = "cases/fzg-type-c.toml";
const HELICAL: [&str; 4] = ["--set", "pair.helix_angle=15 deg", "--set", "pair.driver_hand=right"];

fn json(command: &str, arguments: &[&str]) -> Value {
    let (code, text, errors) = program::run(&[&[command, "--format", "json"], arguments].concat());
    assert_eq!(code, 0, "{errors}");
    serde_json::from_str(&text).unwrap()
}

fn solved(arguments: &[&str], quantity: &str) -> f64 {
    let line = json("solve", &[&["--only", quantity], arguments].concat());
    line["quantities"][quantity]["value"].as_f64().unwrap()
}

fn rows(of: &Value, part: &str, key: &str) -> Vec<f64> {
    let rows = of[part].as_array().unwrap();
    rows.iter().map(|row| row[key].as_f64().unwrap()).collect()
}

fn constant(of: &Value, key: &str) -> f64 {
    of["constants"][key]["value"].as_f64().unwrap()
}

fn greatest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() <= tolerance, "{found}, expected {expected}");
}

#[test]
fn the_series_of_the_transmission_error_has_the_harmonics_of_the_solve() {
    for arguments in [[TABLE_1].as_slice(), &[FZG], &[&[TABLE_1][..], &HELICAL].concat()] {
        let found = json("excitation", &[arguments, &["--points", "64"]].concat());
        let [cosine, sine] = ["cosine", "sine"]
            .map(|of| rows(&found, "harmonics", &format!("transmission_error_{of}")));
        let at_rest = [arguments, &["--method", "static"]].concat();
        for order in [1, 2] {
            let name = format!("static_te_harmonic_{order}");
            let amplitude = f64::hypot(cosine[order], sine[order]);
            let tolerance = if arguments.len() == 1 { 1e-6 } else { 0.02 };
            assert_near(amplitude, solved(&at_rest, &name), tolerance);
        }
        let force = rows(&found, "passage", "tooth_force");
        assert_near(greatest(force), solved(&at_rest, "static_peak_force"), 0.02);
    }
}

/// The springs of a part: gap, stiffness of the mesh and stiffness of the tooth, by place.
fn springs(of: &Value) -> Vec<[Vec<f64>; 3]> {
    /// Warm-up, in base pitches.
    const WARM_UP: usize = 40;
    let named = |part: &str| -> Vec<String> {
        let row = of[part][0].as_object().unwrap();
        row.keys().filter_map(|key| key.strip_prefix("gap_")).map(str::to_owned).collect()
    };
    assert_eq!(named("period"), named("passage"));
    let series = |key: String| {
        let (period, passage) = (rows(of, "period", &key), rows(of, "passage", &key));
        let warm_up = period.iter().cycle().take(WARM_UP * period.len());
        warm_up.chain(&passage).copied().collect::<Vec<f64>>()
    };
    let kinds = ["gap", "stiffness", "tooth_stiffness"];
    let of_pair = |pair: &String| kinds.map(|kind| series(format!("{kind}_{pair}")));
    named("period").iter().map(of_pair).collect()
}

/// The greatest force of the incoming tooth, integrated with the exported values alone.
fn integrated(of: &Value) -> f64 {
    /// Steps of the method of Runge and Kutta between two places.
    const STEPS: usize = 8;
    let [mass, damping, force] =
        ["reduced_mass", "damping", "mesh_force"].map(|key| constant(of, key));
    let springs = springs(of);
    let places = springs[0][0].len();
    let warm_up = places - of["passage"].as_array().unwrap().len();
    let step =
        constant(of, "mesh_period") / (of["period"].as_array().unwrap().len() * STEPS) as f64;
    // Of the mesh (1) or of the tooth (2).
    let carried = |x: f64, place: usize, part: f64, kind: usize| -> f64 {
        let of_spring = |spring: &[Vec<f64>; 3]| {
            let at = |of: &[f64]| {
                let next = of[(place + 1).min(places - 1)];
                of[place] + part * (next - of[place])
            };
            at(&spring[kind]) * (x - at(&spring[0])).max(0.0)
        };
        springs.iter().map(of_spring).sum()
    };
    let (mut x, mut v, mut peak) = (rows(of, "period", "transmission_error")[0], 0.0, 0.0_f64);
    for place in 0..places - 1 {
        for number in 0..STEPS {
            let acceleration = |x: f64, v: f64, at: f64| {
                let part = (number as f64 + at) / STEPS as f64;
                (force - damping * v - carried(x, place, part, 1)) / mass
            };
            let a1 = acceleration(x, v, 0.0);
            let (x2, v2) = (x + 0.5 * step * v, v + 0.5 * step * a1);
            let a2 = acceleration(x2, v2, 0.5);
            let (x3, v3) = (x + 0.5 * step * v2, v + 0.5 * step * a2);
            let a3 = acceleration(x3, v3, 0.5);
            let (x4, v4) = (x + step * v3, v + step * a3);
            let a4 = acceleration(x4, v4, 1.0);
            x += step / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
            v += step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        }
        if place + 1 >= warm_up {
            peak = peak.max(carried(x, place + 1, 0.0, 2));
        }
    }
    peak
}

#[test]
fn the_exported_system_gives_the_peak_force_of_dynamic_while_contact_holds() {
    for (case, speed, deviation, model) in [
        (FZG, "1000 rpm", "0 um", "beam"),
        (FZG, "2175 rpm", "2 um", "finite-element"),
        (TABLE_1, "500 rpm", "4 um", "finite-element"),
        (TABLE_1, "3000 rpm", "0 um", "beam"),
    ] {
        let settings = [
            format!("operation.speed={speed}"),
            format!("deviations.base_pitch={deviation}"),
            format!("model.tooth_compliance={model}"),
            "model.warmup_cycles=40".to_owned(),
        ];
        let settings = settings.iter().flat_map(|setting| ["--set", setting]);
        let arguments: Vec<&str> =
            [case, "--method", "dynamic"].into_iter().chain(settings).collect();
        let only = ["--only", "dynamic_peak_force,dynamic_contact_lost"];
        let line = json("solve", &[&only[..], &arguments].concat());
        assert_eq!(line["quantities"]["dynamic_contact_lost"]["value"], false);
        let expected = line["quantities"]["dynamic_peak_force"]["value"].as_f64().unwrap();
        let found =
            integrated(&json("excitation", &[&arguments[..], &["--points", "512"]].concat()));
        println!("{case} {speed} {deviation} {model}: {found} {expected} {}", found / expected);
        assert_near(found, expected, 0.01);
    }
}

#[test]
fn csv_has_one_row_per_place_of_both_parts() {
    let arguments = ["excitation", TABLE_1, "--points", "16", "--format", "csv"];
    let (code, text, errors) = program::run(&arguments);
    assert_eq!((code, errors.as_str()), (0, ""));
    let start = "part,time [s],angle_driver [rad],way [m],mesh_stiffness [N/m],";
    let mut lines = text.lines();
    assert!(lines.next().unwrap().starts_with(start));
    let parts: Vec<&str> = lines.map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(parts.iter().filter(|part| **part == "period").count(), 16);
    assert_eq!((parts.len() - 17) % 16, 0);
    let (code, _, errors) = program::run(&["excitation", TABLE_1, "--points", "7"]);
    assert!(code == 2 && errors.contains("write a number from 8 to 4096"), "{errors}");
    let (code, text, _) = program::run(&["excitation", TABLE_1]);
    assert!(code == 0 && text.lines().all(|line| line.chars().count() <= 80), "{text}");
}
