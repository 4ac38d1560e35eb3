//! Scaling laws: a pair with other lengths and times has the same result in other units, and so has
//! a pair written in inches, psi and horsepower.
//!
//! `TIPSTRIKE_PAIRS=20000 cargo test --test core scaling:: -- --nocapture` checks 20,000 pairs.
use crate::envelope::Random;
use crate::pairs;
use crate::support::{on_all_cores, pairs_or};

use tipstrike::case::units::{Dimension, factor as unit_factor};
use tipstrike::case::{Case, Document, FIELDS, fields};
use tipstrike::model::inputs::{
    ContactCompliance, Drive, Gear, InertiaModel, Method, ReliefShape, ToothCompliance,
};
use tipstrike::model::{Inputs, QUANTITIES, Quantity, Solution, Stage, Stages, notes, solve};
use tipstrike::report::stations::{Column, columns};

/// Lengths times `length`, times times `time`, forces times `length`², so that every stress is
/// unchanged.
pub(crate) fn scaled(inputs: &Inputs, length: f64, time: f64) -> Inputs {
    let gear = |gear: &Gear| Gear {
        face_width: gear.face_width * length,
        bore_radius: gear.bore_radius * length,
        density: gear.density * (time / length).powi(2),
        tip_relief: gear.tip_relief * length,
        root_relief: gear.root_relief * length,
        tip_relief_length: gear.tip_relief_length.map(|of| of * length),
        root_relief_length: gear.root_relief_length.map(|of| of * length),
        tip_chamfer: gear.tip_chamfer * length,
        tip_radius: gear.tip_radius.map(|radius| radius * length),
        base_pitch: gear.base_pitch.map(|deviation| deviation * length),
        inertia: gear.inertia.map(|inertia| inertia * length.powi(3) * time.powi(2)),
        ..*gear
    };
    Inputs {
        module: inputs.module * length,
        centre_distance: inputs.centre_distance.map(|distance| distance * length),
        driver: gear(&inputs.driver),
        driven: gear(&inputs.driven),
        base_pitch_deviation: inputs.base_pitch_deviation * length,
        backlash: inputs.backlash * length,
        drive: match inputs.drive {
            Drive::Power(power) => Drive::Power(power * length.powi(3) / time),
            Drive::Torque(torque) => Drive::Torque(torque * length.powi(3)),
        },
        speed: inputs.speed / time,
        deflection: inputs.deflection.map(|deflection| deflection * length),
        ..inputs.clone()
    }
}

pub(crate) fn factor(unit: &str, length: f64, time: f64) -> f64 {
    match unit {
        "m" | "N/m" => length,
        "s" => time,
        "Hz" | "rad/s" => time.recip(),
        "m/s" => length / time,
        "N" => length.powi(2),
        "kg" => length * time.powi(2),
        "kg m2" => length.powi(3) * time.powi(2),
        "J" => length.powi(3),
        "m2/N" | "1" | "rad" | "Pa" | "N/m2" => 1.0,
        _ => panic!("no factor for {unit}"),
    }
}

/// An ordinary pair with one or more of the features that a drawing can have.
fn pair(number: u64) -> Inputs {
    let mut inputs = pairs::numbered(number);
    let random = &mut Random::new(number + 77_777);
    let module = inputs.module;
    for gear in [&mut inputs.driver, &mut inputs.driven] {
        gear.young = random.decades(70e9, 250e9);
        gear.poisson = random.even(0.2, 0.35);
        gear.density = random.decades(1500.0, 9000.0);
        gear.bore_radius = module * random.even(0.0, 5.0);
        if random.chance(0.3) {
            gear.tip_radius = Some(module * random.even(0.01, 0.15));
        }
        if random.chance(0.3) {
            gear.tip_relief_length = Some(module * random.even(0.5, 3.0));
        }
        if random.chance(0.2) {
            gear.root_relief = module * random.even(0.0, 3e-3);
        }
    }
    if random.chance(0.4) {
        inputs.friction_coefficient = Some(random.even(0.02, 0.2));
    }
    if random.chance(0.3) {
        inputs.backlash = module * random.decades(3e-3, 0.1);
    }
    if random.chance(0.3) {
        inputs.base_pitch_deviation *= -1.0;
    }
    if random.chance(0.3) {
        inputs.drive = Drive::Power(inputs.torque() * inputs.speed);
    }
    inputs.relief_shape = random.one_of(&ReliefShape::ALL);
    inputs.inertia = random.one_of(&InertiaModel::ALL);
    inputs.contact_compliance = random.one_of(&[
        ContactCompliance::LOGARITHMIC,
        ContactCompliance::CONSTANT,
        ContactCompliance::WEBER,
    ]);
    inputs.tooth_compliance = inputs.tooth_compliance.or(Some(ToothCompliance::BEAM));
    inputs.stations = Some(12);
    inputs
}

/// A value with its name, unit and scale: differences are relative to the scale if that is greater.
type Value = (String, &'static str, Option<f64>, f64);

/// Every value of a solution: quantities, then the columns of the stations.
fn values(solution: &Solution) -> Vec<Value> {
    let quantity = |quantity: &Quantity| {
        let value = (quantity.value)(solution);
        (quantity.key.to_owned(), quantity.unit, value, 0.0)
    };
    // The standard has constants with dimensions: 100 N/mm, 206 GPa.
    let scales = |quantity: &&Quantity| !quantity.key.starts_with("iso_");
    let mut all: Vec<Value> = QUANTITIES.iter().filter(scales).map(quantity).collect();
    let rest = solution.static_load.as_ref().map(|load| (Method::Static, &load.stations));
    let motion = solution.dynamic.as_ref().map(|motion| (Method::Dynamic, &motion.stations));
    let curves = [Some((Method::Exact, &solution.stations)), rest, motion];
    let mut rows = Vec::new();
    for (method, stations) in curves.into_iter().flatten() {
        for station in stations {
            let value = |of: &Column| (of.key, of.unit, (of.value)(solution, station));
            rows.push(columns(method).map(value).collect::<Vec<_>>());
        }
    }
    let largest = |name: &str| {
        let column = rows.iter().flatten().filter(|column| column.0 == name);
        column.fold(0.0, |most: f64, column| most.max(column.2.unwrap_or(0.0).abs()))
    };
    for (index, row) in rows.iter().enumerate() {
        for &(name, unit, value) in row {
            all.push((format!("{name} {index}"), unit, value, largest(name)));
        }
    }
    all
}

/// Compares two solutions of which the second has other lengths and times.
fn differences(
    (one, other): (&Solution, &Solution),
    (length, time): (f64, f64),
    permitted: f64,
) -> Vec<String> {
    let mut found = Vec::new();
    if (one.outcome, &one.withheld.map(|refusal| refusal.code()))
        != (other.outcome, &other.withheld.map(|refusal| refusal.code()))
    {
        found.push(format!("{:?} {:?}", one.outcome, other.outcome));
    }
    let (these, those) = (values(one), values(other));
    if these.len() != those.len() {
        found.push(format!("{} values, {} values", these.len(), those.len()));
    }
    for ((name, unit, was, scale), (_, _, is, _)) in these.into_iter().zip(those) {
        let by = factor(unit, length, time);
        // The search for the relief ends with a bracket of at most 1 pm or 5e-5 of the relief.
        let permitted = if name == "clearing_relief" && one.method.shares_load() {
            1e-4 + 2e-12 / was.unwrap_or(f64::INFINITY).min(is.unwrap_or(f64::INFINITY))
        } else {
            permitted
        };
        let off = match (was, is) {
            (Some(was), Some(is)) => {
                let size = was.abs().max(scale) * by;
                (is - was * by).abs() / if size > 0.0 { size } else { 1.0 }
            }
            (None, None) => 0.0,
            _ => f64::INFINITY,
        };
        if off.is_nan() || off > permitted {
            found.push(format!("{name} {was:?} {:?}: {off:.1e}", is.map(|is| is / by)));
        }
    }
    found
}

fn solved(inputs: &Inputs, stages: Stages) -> Result<Solution, String> {
    solve(inputs, stages).map_err(|refusal| refusal.code().to_owned())
}

/// Compares every pair with `other` of the pair, by every method. Prints and counts what differs.
fn check(pairs: u64, other: impl Fn(&Inputs, &mut Random) -> (Inputs, (f64, f64)) + Sync) {
    let of = |number: u64| {
        let random = &mut Random::new(number + 5);
        let mut found = Vec::new();
        for (method, every, permitted) in [
            (Method::Paper, 1, 1e-7),
            (Method::Exact, 1, 1e-8),
            (Method::Static, 4, 1e-8),
            (Method::Dynamic, 40, 1e-6),
        ] {
            if !number.is_multiple_of(every) {
                continue;
            }
            // The series of the motion end at the tolerance.
            let inputs = Inputs { method, tolerance: 1e-9, ..pair(number) };
            let (scaled, factors) = other(&inputs, random);
            // The spread of the stiffness models builds the field of each gear, and the run over the
            // speed is a hundred motions.
            let stages = if number.is_multiple_of(500) {
                method.stages()
            } else {
                method.stages().without(Stage::Band).without(Stage::SpeedRun)
            };
            let name =
                |what: &str| format!("pair {number} {} times {factors:?}: {what}", method.name());
            match (solved(&inputs, stages), solved(&scaled, stages)) {
                (Ok(one), Ok(other)) => {
                    let all = differences((&one, &other), factors, permitted);
                    found.extend(all.iter().map(|what| name(what)));
                    let codes = |inputs: &Inputs, solution: &Solution| -> Vec<&str> {
                        let all = notes(inputs, solution);
                        all.into_iter().map(|note| note.code).collect()
                    };
                    let (was, is) = (codes(&inputs, &one), codes(&scaled, &other));
                    if was != is {
                        found.push(name(&format!("{was:?} {is:?}")));
                    }
                }
                (Err(one), Err(other)) if one == other => {}
                (one, other) => {
                    found.push(name(&format!("{:?} {:?}", one.err(), other.err())));
                }
            }
        }
        found
    };
    let found = on_all_cores(pairs, of).concat();
    for line in &found {
        println!("{line}");
    }
    assert!(found.is_empty(), "{} differences", found.len());
}

#[test]
fn every_result_follows_lengths_and_times() {
    check(pairs_or(2000), |inputs, random| {
        let factors = (random.decades(0.3, 3.0), random.decades(0.3, 3.0));
        (scaled(inputs, factors.0, factors.1), factors)
    });
}

/// The text of a value in SI, in the unit of the inch system.
fn imperial(value: f64, dimension: Dimension) -> String {
    let unit = match dimension {
        Dimension::Length => "in",
        Dimension::Angle => "deg",
        Dimension::Pressure => "psi",
        Dimension::Density => "lb/in3",
        Dimension::Power => "hp",
        Dimension::Torque => "lbf in",
        Dimension::AngularVelocity => "rpm",
        _ => return format!("{value}"),
    };
    format!("{:e} {unit}", value / unit_factor(unit).expect("a unit"))
}

/// The inputs of the pair as a case in inches, psi and horsepower.
fn written(inputs: &Inputs) -> Inputs {
    let mut case = Case::empty();
    let mut write = |key: &str, value: f64| {
        let field = fields::index_of(key).unwrap_or_else(|| panic!("no field {key}"));
        if let fields::Kind::Number(dimension, ..) = FIELDS[field].kind {
            case.write(field, &imperial(value, dimension));
        }
    };
    write("pair.module", inputs.module);
    write("pair.pressure_angle", inputs.pressure_angle);
    for (name, gear) in [("driver", &inputs.driver), ("driven", &inputs.driven)] {
        let optional =
            [("tip_relief_length", gear.tip_relief_length), ("tip_radius", gear.tip_radius)];
        let given = [
            ("face_width", gear.face_width),
            ("bore_radius", gear.bore_radius),
            ("young", gear.young),
            ("density", gear.density),
            ("tip_relief", gear.tip_relief),
            ("root_relief", gear.root_relief),
        ];
        let given = given.map(|(key, value)| (key, Some(value)));
        for (key, value) in given.into_iter().chain(optional) {
            if let Some(value) = value {
                write(&format!("{name}.{key}"), value);
            }
        }
    }
    write("deviations.base_pitch", inputs.base_pitch_deviation);
    write("deviations.backlash", inputs.backlash);
    write("operation.speed", inputs.speed);
    match inputs.drive {
        Drive::Power(power) => write("operation.power", power),
        Drive::Torque(torque) => write("operation.torque", torque),
    }
    let mut read = inputs.clone();
    for field in (0..FIELDS.len()).filter(|&field| case.text(field).is_some()) {
        tipstrike::case::put_field(&case, field, &mut read)
            .unwrap_or_else(|problem| panic!("{problem:?}"));
    }
    read
}

#[test]
fn a_case_in_inches_and_horsepower_has_the_results_of_the_same_case_in_metric_units() {
    check(pairs_or(800), |inputs, _| (written(inputs), (1.0, 1.0)));
}

/// At E the time is 0, and rounding of the end of a step before E is not a loss of contact.
#[test]
fn the_duration_of_an_impact_that_lasts_beyond_the_start_of_contact_follows_the_size() {
    const CASE: &str = r#"format = 1
pair = { module = "10.996 mm", pressure_angle = "20.0 deg" }
driver = { teeth = 20, profile_shift = 0.321, face_width = "127.81 mm", bore_radius = "20.06 mm", young = "203.6 GPa", poisson = 0.4, density = "2509 kg/m3", tip_relief = "17.5 um" }
driven = { teeth = 52, profile_shift = 0.353, face_width = "115.25 mm", bore_radius = "107.87 mm", young = "92.1 GPa", poisson = 0.22, density = "5420 kg/m3" }
deviations = { base_pitch = "42.3 um" }
operation = { torque = "699.034 N m", speed = "7959.0 rpm" }
model = { method = "dynamic", tooth_compliance = "kuang-yang" }
"#;
    let case = Document::parse("CASE", CASE).expect("a case").case;
    let inputs = case.inputs().expect("valid inputs");
    let duration = |inputs: &Inputs| {
        let solution = solve(inputs, Stages::of(Stage::Dynamic)).expect("a solution");
        let motion = solution.dynamic.expect("a motion");
        motion.impact_duration.expect("an impact")
    };
    let given = duration(&inputs);
    for step in 0..60 {
        let size = 0.31 + 0.0137 * f64::from(step);
        let found = duration(&scaled(&inputs, size, size)) / size;
        assert!((found / given - 1.0).abs() < 1e-7, "{found:e} for {given:e} at {size}");
    }
}
