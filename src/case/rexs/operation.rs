//! The driver of a stage, its speed and its torque.

use super::model::{Component, Model, find};
use super::source::{Found, Reading, Values, Wanted, found};
use super::stage::TEETH;
use crate::case::units::{self, Dimension};

const MOST_SHAFTS: usize = 10;
const SPEED: Wanted = Wanted::new("rotational_speed", Dimension::AngularVelocity, "rpm");
const TORQUE: Wanted = Wanted::new("torque_around_u_axis", Dimension::Torque, "N m");
const TORQUE_OF_GEAR: Wanted = Wanted::new("torque", Dimension::Torque, "N m");
const POWER: Wanted = Wanted::new("power", Dimension::Power, "kW");

/// The driver and the driven gear. A model may not name the driving gear.
pub(super) fn ordered<'a>(
    model: &'a Model,
    stage: &str,
    gears: [&'a Component; 2],
    values: &mut Values,
) -> [&'a Component; 2] {
    let [first, second] = gears;
    let drives = |gear: &Component| {
        let mut data = gear_data(model, stage, &gear.id);
        data.any(|data| data.is_true("is_driving_gear"))
    };
    match (drives(first), drives(second)) {
        (true, false) => gears,
        (false, true) => [second, first],
        _ => {
            let label = first.label();
            values.remarks.push(format!(
                "the model does not name the driving gear; the driver is gear_1, {label}"
            ));
            gears
        }
    }
}

/// The data of a gear for this stage only.
fn gear_data<'a>(
    model: &'a Model,
    stage: &'a str,
    gear: &'a str,
) -> impl Iterator<Item = &'a Component> {
    model
        .relations_of(gear)
        .filter(move |relation| {
            relation.kind == "stage_gear_data"
                && relation.role("stage") == Some(stage)
                && relation.role("gear") == Some(gear)
        })
        .filter_map(|relation| model.component(relation.role("stage_gear_data")?))
}

/// Reads speed and torque or power of the driver.
pub(super) fn read(model: &Model, stage: &str, gears: [&Component; 2], values: &mut Values) {
    let teeth = gears.map(|gear| TEETH.read(gear).ok().flatten());
    let ratio = match teeth {
        [Some(driver), Some(driven)] => driven.value / driver.value,
        _ => f64::NAN,
    };
    values.put(
        "operation.speed",
        found(speed(model, gears, ratio), "neither gear nor its shaft has a rotational_speed"),
    );
    match load(model, stage, gears, ratio) {
        Ok(Some((key, reading))) => values.put(key, reading.found()),
        Ok(None) => values.put(
            "operation.torque",
            Found::Absent("no load is given on a shaft that carries this gear alone".to_owned()),
        ),
        Err(reason) => values.put("operation.torque", Found::Absent(reason)),
    }
}

/// The speed of the driver or of its shaft, or the speed of the driven gear times the ratio.
fn speed(model: &Model, gears: [&Component; 2], ratio: f64) -> Result<Option<Reading>, String> {
    for (gear, factor) in gears.into_iter().zip([1.0, ratio]) {
        for part in std::iter::once(gear).chain(shafts(model, gear)?) {
            if let Some(reading) = value(model, part, SPEED)? {
                return Ok(Some(transferred(reading, factor, "rpm")));
            }
        }
    }
    Ok(None)
}

/// The torque or power of the driver, and its field.
fn load(
    model: &Model,
    stage: &str,
    gears: [&Component; 2],
    ratio: f64,
) -> Result<Option<(&'static str, Reading)>, String> {
    for (gear, factor) in gears.into_iter().zip([1.0, 1.0 / ratio]) {
        for data in gear_data(model, stage, &gear.id) {
            if let Some(torque) = value(model, data, TORQUE_OF_GEAR)?.filter(is_acting) {
                let torque = transferred(torque, factor, "N m");
                return Ok(Some(("operation.torque", torque)));
            }
        }
    }
    for (gear, factor) in gears.into_iter().zip([1.0, 1.0 / ratio]) {
        let shafts = shafts(model, gear)?.into_iter();
        for shaft in shafts.filter(|shaft| carries_one_gear(model, shaft)) {
            if let Some(found) = load_on(model, shaft, factor)? {
                return Ok(Some(found));
            }
        }
    }
    Ok(None)
}

/// The shafts of a gear: one in a usual model.
fn shafts<'a>(model: &'a Model, gear: &'a Component) -> Result<Vec<&'a Component>, String> {
    let assemblies = model.related("assembly", ("part", &gear.id), "assembly");
    let shafts = assemblies.filter(|assembly| assembly.kind == "shaft");
    let shafts: Vec<&Component> = shafts.take(MOST_SHAFTS + 1).collect();
    if shafts.len() > MOST_SHAFTS {
        let label = gear.label();
        return Err(format!("{label} is on more than {MOST_SHAFTS} shafts"));
    }
    Ok(shafts)
}

fn carries_one_gear(model: &Model, shaft: &Component) -> bool {
    let parts = model.related("assembly", ("assembly", &shaft.id), "part");
    parts.filter(|part| part.kind.ends_with("gear")).count() == 1
}

/// The load on a shaft if the shaft has exactly one load.
fn load_on(
    model: &Model,
    shaft: &Component,
    factor: f64,
) -> Result<Option<(&'static str, Reading)>, String> {
    let mut loads = Vec::new();
    for part in model.related("assembly", ("assembly", &shaft.id), "part") {
        if part.kind != "external_load" {
            continue;
        }
        if let Some(torque) = value(model, part, TORQUE)?.filter(is_acting) {
            loads.push(("operation.torque", transferred(torque, factor, "N m")));
        } else if let Some(power) = value(model, part, POWER)?.filter(is_acting) {
            loads.push(("operation.power", transferred(power, 1.0, "kW")));
        }
    }
    if loads.len() > 1 {
        return Err(format!("{} has several loads", shaft.label()));
    }
    Ok(loads.pop())
}

fn is_acting(reading: &Reading) -> bool {
    reading.value != 0.0
}

/// A value at the driver without its sign, which gives the direction.
fn transferred(reading: Reading, factor: f64, unit: &str) -> Reading {
    if (factor - 1.0).abs() < f64::EPSILON {
        let text = reading.text.trim_start_matches(['-', '+']).to_owned();
        return Reading { text, value: reading.value.abs(), ..reading };
    }
    let value = (reading.value * factor).abs();
    Reading {
        text: units::text(value, unit),
        value,
        source: format!("{} = {} and the ratio", reading.source, reading.text),
    }
}

/// A value of a component or of its load case. Several load cases must agree.
fn value(model: &Model, part: &Component, wanted: Wanted) -> Result<Option<Reading>, String> {
    let label = part.label();
    let mut cases: Vec<(&str, Reading)> = Vec::new();
    for (case, attributes) in model.loads_of(&part.id) {
        if let Some(attribute) = find(attributes, wanted.id) {
            let label = format!("{label} in load case {}", case.id);
            cases.push((case.id.as_str(), wanted.reading(attribute, &label)?));
        }
    }
    let Some((_, first)) = cases.first() else {
        return Ok(wanted.read(part)?);
    };
    if cases.iter().all(|(_, other)| other.text == first.text) {
        return Ok(Some(first.clone()));
    }
    let texts: Vec<String> = cases
        .iter()
        .map(|(case, reading)| format!("{} in load case {case}", reading.text))
        .collect();
    Err(format!("{} of {label} is {}", wanted.id, texts.join(", ")))
}
