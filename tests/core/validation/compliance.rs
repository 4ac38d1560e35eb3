//! The other tooth compliances compared with the finite elements.

use std::fmt::Write as _;

use serde_json::Value;
use tipstrike::model::Inputs;
use tipstrike::model::compliance::tooth::Tooth;
use tipstrike::model::geometry::geometry;
use tipstrike::model::inputs::ToothCompliance;

use crate::support::standard_pair;

const FRACTIONS: [f64; 6] = [0.05, 0.25, 0.5, 0.75, 0.95, 1.0];

/// The gears of `tests/reference/field/teeth.json`, each paired with an equal gear.
fn gears() -> Vec<Inputs> {
    let rows: Vec<Value> =
        serde_json::from_str(include_str!("../../reference/field/teeth.json")).unwrap();
    let mut found: Vec<Inputs> = Vec::new();
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap();
        let teeth = number("teeth") as u32;
        let mut inputs = standard_pair(teeth, teeth, 1e-3);
        inputs.pressure_angle = number("pressure_angle_deg").to_radians();
        for gear in [&mut inputs.driver, &mut inputs.driven] {
            gear.profile_shift = number("profile_shift");
            gear.dedendum = number("dedendum");
            gear.bore_radius = 1e-3 * number("bore_radius");
            gear.poisson = number("poisson");
        }
        if found.last() != Some(&inputs) {
            found.push(inputs);
        }
    }
    found
}

/// Differences of a model from the field over the flank of a gear, in %; `None` outside its range.
fn differences(inputs: &Inputs, model: ToothCompliance) -> Option<[f64; 6]> {
    let covered = Inputs { tooth_compliance: Some(model), ..inputs.clone() };
    if !(model.model().covers)(&covered) {
        return None;
    }
    let geometry = geometry::<f64>(&inputs.shape()).ok()?;
    let (gear, circles) = (inputs.elasticity().driver, &geometry.driver);
    let tooth = |model| Tooth::of(model, &gear, circles).ok();
    let (own, field) = (tooth(model)?, tooth(ToothCompliance::FINITE_ELEMENT)?);
    let form = tipstrike::model::profile::Profile::of(&gear.rack, circles).form_radius();
    let at = |part: f64| {
        let radius = form + part * (circles.tip - form);
        100.0 * (own.at(radius).unwrap() / field.at(radius).unwrap() - 1.0)
    };
    Some(FRACTIONS.map(at))
}

fn range(values: &[f64]) -> String {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!("{least:+.0} to {most:+.0} %")
}

/// The section of the page.
pub(super) fn section() -> String {
    let mut text = "\n## Tooth compliances against the finite elements\n\nCompliance of one tooth without \
        contact over the flank, from 5 % of its height to the tip, against `finite-element` without the \
        twist of the body: the gears of `tests/reference/field`, which other finite elements check. \
        Above 0 the model is too soft. The foundation of the beam is fitted for r_f/r_h from 1.4 to 7 \
        and half angles of the tooth at the root up to 0.12 rad, so thin rims and small gears are \
        outside its range.\n\n\
        | gear | r_f/r_h | beam | at half height | kuang-yang |\n|---|---|---|---|---|\n"
        .to_owned();
    for inputs in gears() {
        let gear = &inputs.driver;
        let root = geometry::<f64>(&inputs.shape()).unwrap().driver.root;
        let beam = differences(&inputs, ToothCompliance::BEAM);
        let fit = differences(&inputs, ToothCompliance::KUANG_YANG);
        let shown = |found: Option<[f64; 6]>| {
            found.map_or("outside its range".to_owned(), |found| range(&found))
        };
        let middle = beam.map_or("-".to_owned(), |beam| format!("{:+.0} %", beam[2]));
        writeln!(
            text,
            "| z {}, x {}, {:.0} deg | {:.2} | {} | {middle} | {} |",
            gear.teeth,
            gear.profile_shift,
            inputs.pressure_angle.to_degrees(),
            root / gear.bore_radius,
            shown(beam),
            shown(fit)
        )
        .unwrap();
    }
    text
}

/// Bodies with r_f/r_h from 2 to 5 and a tooth within or close to the range of the foundation.
#[test]
fn the_beam_is_up_to_22_percent_softer_than_the_field_where_its_foundation_is_fitted() {
    let mut seen = 0;
    for inputs in gears() {
        let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
        let body = circles.root / inputs.driver.bore_radius;
        if body < 2.0 || inputs.driver.teeth < 17 {
            continue;
        }
        let found = differences(&inputs, ToothCompliance::BEAM).unwrap();
        assert!(found.iter().all(|off| (0.0..=22.0).contains(off)), "{}", inputs.driver.teeth);
        seen += 1;
    }
    assert!(seen >= 3, "{seen}");
}
