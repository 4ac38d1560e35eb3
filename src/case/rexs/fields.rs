//! Converts the components of a spur stage to the fields of pair, gears and deviations.

use super::gear::{DRIVEN, DRIVER, Gear, Keys};
use super::model::{Component, Model};
use super::relief;
use super::source::{Problem, Reading, Values, Wanted, agreed, found};
use super::stage::TEETH;
use crate::case::units::{self, Dimension};

/// Reads every field except the fields of the operation.
pub(super) fn read(model: &Model, stage: &Component, gears: [&Component; 2], values: &mut Values) {
    let [driver, driven] = gears.map(|gear| Gear::new(model, gear));
    let module = Wanted::length("normal_module");
    let module = values
        .shared("pair.module", module, [&driver, &driven], |gear| module.read(gear.component));
    let angle = Wanted::new("normal_pressure_angle", Dimension::Angle, "deg");
    let angle = values
        .shared("pair.pressure_angle", angle, [&driver, &driven], |gear| gear.of_flanks(angle));
    values.put(
        "pair.centre_distance",
        found(Wanted::length("center_distance").read(stage), "the model gives no center_distance"),
    );
    for (keys, gear) in [(&DRIVER, &driver), (&DRIVEN, &driven)] {
        body(values, keys, gear, module);
        let base = angle.and_then(|angle| base_diameter(gear, module?, angle));
        heights(values, keys, gear);
        relief::read(model, keys, gear, base, values);
    }
    deviations(values, stage, [&driver, &driven]);
}

impl Values {
    /// A value that both gears must share, in SI. Different values are no valid pair.
    fn shared(
        &mut self,
        key: &'static str,
        wanted: Wanted,
        gears: [&Gear; 2],
        read: impl Fn(&Gear) -> Result<Option<Reading>, Problem>,
    ) -> Option<f64> {
        let both = read(gears[0]).and_then(|first| Ok((first, read(gears[1])?)));
        let reading = both.and_then(|(first, second)| agreed(first, second));
        let value = reading.as_ref().ok().and_then(Option::as_ref);
        let value = value.map(|reading| reading.value);
        self.put_equal(key, reading, wanted.id);
        value
    }

    /// Writes a value that must be unique. Refuses the stage if the model gives two values.
    fn put_equal(
        &mut self,
        key: &'static str,
        reading: Result<Option<Reading>, Problem>,
        id: &str,
    ) {
        match reading {
            Err(problem) if problem.is_unequal => self.refusals.push(problem.words),
            reading => self.put(key, found(reading, &none(id))),
        }
    }
}

/// Teeth, profile shift, sizes and material.
fn body(values: &mut Values, keys: &Keys, gear: &Gear, module: Option<f64>) {
    let own = |wanted: Wanted| found(wanted.read(gear.component), &none(wanted.id));
    values.put(keys.teeth, own(TEETH));
    let shift = profile_shift(gear, module);
    values.put_equal(keys.profile_shift, shift, "addendum_modification_coefficient");
    values.put(keys.face_width, own(Wanted::length("face_width")));
    let bore = Wanted::length("inner_diameter").read(gear.component);
    let radius = bore.map(|bore| bore.map(|bore| derived(&bore, 0.5, "mm", "half of")));
    values.put(keys.bore_radius, found(radius, &none("inner_diameter")));
    let of_material = |id, dimension, unit| {
        let wanted = Wanted::new(id, dimension, unit);
        let reading = wanted.first(gear.materials.iter().copied());
        found(reading, &format!("no material of the gear has {id}"))
    };
    values.put(keys.young, of_material("elastic_modulus", Dimension::Pressure, "MPa"));
    values.put(keys.poisson, of_material("poisson_ratio", Dimension::Number, ""));
    values.put(keys.density, of_material("density", Dimension::Density, "kg/dm3"));
    let chamfer = gear.of_flanks(Wanted::length("tooth_tip_chamfer"));
    values.put(keys.tip_chamfer, found(chamfer, &none("tooth_tip_chamfer")));
}

fn none(attribute: &str) -> String {
    format!("the model gives no {attribute}")
}

/// The reading multiplied by a factor, in a unit.
fn derived(reading: &Reading, factor: f64, unit: &str, words: &str) -> Reading {
    let value = reading.value * factor;
    Reading {
        text: units::text(value, unit),
        value,
        source: format!("{words} {} = {}", reading.source, reading.text),
    }
}

/// The nominal coefficient, or that of the nominal shift, or that of the finished gear.
fn profile_shift(gear: &Gear, module: Option<f64>) -> Result<Option<Reading>, Problem> {
    let coefficient = |id| gear.of_flanks(Wanted::number(id));
    if let Some(reading) = coefficient("addendum_modification_coefficient")? {
        return Ok(Some(reading));
    }
    let shift = gear.of_flanks(Wanted::length("addendum_modification"))?;
    if let (Some(shift), Some(module)) = (shift, module) {
        return Ok(Some(derived(&shift, 1.0 / module, "", "the module and")));
    }
    coefficient("addendum_modification_coefficient_after_finishing")
}

/// The base diameter d_b = m z cos α, in m.
fn base_diameter(gear: &Gear, module: f64, angle: f64) -> Option<f64> {
    let teeth = TEETH.read(gear.component).ok()??;
    Some(module * teeth.value * angle.cos())
}

/// Tip and root diameters, or addendum and dedendum of the basic profile.
fn heights(values: &mut Values, keys: &Keys, gear: &Gear) {
    let diameter = |id| Wanted::length(id).read(gear.component);
    match diameter("tip_diameter") {
        Ok(None) => values.put(
            keys.addendum,
            found(
                gear.of_flanks(Wanted::number("addendum_coefficient_basic_profile")),
                "the model gives neither tip_diameter nor the basic profile",
            ),
        ),
        given => values.put(keys.tip_diameter, found(given, &none("tip_diameter"))),
    }
    match diameter("root_diameter") {
        // The addendum of the rack cuts the dedendum of the gear.
        Ok(None) => values.put(
            keys.dedendum,
            found(
                Wanted::number("addendum_coefficient_reference_profile")
                    .first(gear.racks.iter().copied()),
                "the model gives neither root_diameter nor the rack",
            ),
        ),
        given => values.put(keys.root_diameter, found(given, &none("root_diameter"))),
    }
}

const PITCH_DEVIATIONS_OF_STAGE: [&str; 2] = [
    "transverse_base_pitch_deviation_iso_6336_2019",
    "transverse_base_pitch_deviation_iso_6336_2006",
];

fn deviations(values: &mut Values, stage: &Component, gears: [&Gear; 2]) {
    let micrometres = |id| Wanted::new(id, Dimension::Length, "um");
    let of_stage = PITCH_DEVIATIONS_OF_STAGE.iter().map(|id| micrometres(id).read(stage));
    let of_gears = || {
        let deviation = micrometres("base_pitch_deviation_din_3962_1978");
        let [first, second] = gears.map(|gear| deviation.read(gear.component));
        Ok(greater(first?, second?))
    };
    let deviation = of_stage
        .reduce(|first, next| if matches!(first, Ok(None)) { next } else { first })
        .filter(|reading| !matches!(reading, Ok(None)))
        .unwrap_or_else(of_gears);
    values
        .put("deviations.base_pitch", found(deviation, "the model gives no base pitch deviation"));
    let least = Wanted::length("minimum_normal_backlash").read(stage);
    let greatest = Wanted::length("maximum_normal_backlash").read(stage);
    let backlash = least.and_then(|least| agreed(least, greatest?));
    values.put("deviations.backlash", found(backlash, "the model gives no normal backlash"));
}

fn greater(first: Option<Reading>, second: Option<Reading>) -> Option<Reading> {
    match (first, second) {
        (Some(first), Some(second)) if second.value > first.value => Some(second),
        (first, second) => first.or(second),
    }
}
