//! Tip and root relief of a gear from the components of its flanks.

use super::gear::{Gear, Keys};
use super::model::{Component, Model};
use super::source::{Found, Reading, Values, Wanted, agreed, found};
use crate::case::sanitize::quoted;
use crate::case::units;

/// Reads amount, length and shape of both reliefs; `base` is the base diameter, in m.
pub(super) fn read(
    model: &Model,
    keys: &Keys,
    gear: &Gear,
    base: Option<f64>,
    values: &mut Values,
) {
    let tip = of_flanks(model, gear, "tip_relief");
    let root = of_flanks(model, gear, "root_relief");
    let depth = both(&tip, |relief| Wanted::length("tip_relief_depth").read(relief));
    values.put(keys.tip_relief, found(depth, "the model gives no tip relief"));
    if tip.iter().flatten().next().is_some() {
        let diameter = Wanted::length("tip_diameter").read(gear.component);
        let diameter = diameter.ok().flatten().map(|diameter| diameter.value);
        let length = both(&tip, |relief| tip_length(relief, diameter, base));
        let missing = "the model gives neither its length nor its start diameter";
        values.put(keys.tip_relief_length, found(length, missing));
    }
    let depth = both(&root, |relief| Wanted::length("root_relief_depth").read(relief));
    values.put(keys.root_relief, found(depth, "the model gives no root relief"));
    if root.iter().flatten().next().is_some() {
        let wanted = Wanted::length("root_relief_datum_length");
        let length = both(&root, |relief| wanted.read(relief));
        values.put(keys.root_relief_length, found(length, "the model gives no length"));
    }
    for relief in tip.iter().chain(&root).flatten() {
        shape(relief, values);
    }
}

/// The reliefs of a type on the left and on the right flank. A relief of the gear applies to both.
fn of_flanks<'a>(model: &'a Model, gear: &Gear<'a>, kind: &'a str) -> [Vec<&'a Component>; 2] {
    let of_gear: Vec<&Component> = model.linked(&gear.component.id, kind).collect();
    let [left, right] = &gear.flanks;
    [left, right].map(|flank| {
        let own: Vec<&Component> =
            flank.iter().flat_map(|part| model.linked(&part.id, kind)).collect();
        if own.is_empty() { of_gear.clone() } else { own }
    })
}

/// The common value of both flanks. A flank without the relief has the value 0.
fn both<E: Into<String>>(
    reliefs: &[Vec<&Component>; 2],
    read: impl Fn(&Component) -> Result<Option<Reading>, E>,
) -> Result<Option<Reading>, String> {
    let [left, right] = reliefs;
    let only = |flank: &[&Component]| match flank {
        [] => Ok(None),
        [only] => read(only).map_err(Into::into),
        [first, ..] => Err(format!("{} is not the only relief of its flank", first.label())),
    };
    match (left.is_empty(), right.is_empty()) {
        (true, false) | (false, true) => Err("only one flank has the relief".to_owned()),
        _ => Ok(agreed(only(left)?, only(right)?)?),
    }
}

/// The length along the path of contact: the given length, or from the start diameter of the
/// relief.
fn tip_length(
    relief: &Component,
    tip: Option<f64>,
    base: Option<f64>,
) -> Result<Option<Reading>, String> {
    if let Some(length) = Wanted::length("tip_relief_datum_length").read(relief)? {
        return Ok(Some(length));
    }
    let Some(start) = Wanted::length("tip_relief_datum_diameter").read(relief)? else {
        return Ok(None);
    };
    let (Some(tip), Some(base)) = (tip, base) else {
        return Ok(None);
    };
    let roll = |diameter: f64| (diameter * diameter - base * base).max(0.0).sqrt() / 2.0;
    let value = roll(tip) - roll(start.value);
    let micrometres = (value * 1e9).round() / 1e3;
    Ok(Some(Reading {
        text: format!("{} mm", units::text(micrometres / 1e3, "")),
        value,
        source: format!("{} = {}", start.source, start.text),
    }))
}

fn shape(relief: &Component, values: &mut Values) {
    const KEY: &str = "model.relief_shape";
    let Some(shape) = relief.attribute("shape_of_relief") else {
        return;
    };
    let source = format!("shape_of_relief of {}", relief.label());
    let found = match shape.value.as_str() {
        "linear" | "parabolic" => Found::Value { text: shape.value.clone(), source },
        other => {
            Found::Absent(format!("{source} is {}; a case has linear or parabolic", quoted(other)))
        }
    };
    values.put_once(KEY, found);
}
