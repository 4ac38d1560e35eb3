//! Tooth compliance by finite elements of the whole gear.

use super::{Kind, ToothModel};
use crate::model::Refusal;
use crate::model::compliance::{ContactPlace, ElasticGear, Teeth};
use crate::model::explanation::Formula::{Text, Words};
use crate::model::explanation::{Context, Finding, Step, step};
use crate::model::geometry::Geometry;
use crate::model::inputs::{Inputs, ToothCompliance};

/// The entry of the list.
pub const MODEL: ToothModel = ToothModel {
    name: "finite-element",
    index: "fe",
    range: "any gear whose teeth have a tip, a neck and an involute, with a rim below them",
    covers,
    why_outside: |inputs| refusal(inputs).map_or(String::new(), |refusal| refusal.to_string()),
    check,
    outside,
    chosen: "tooth-compliance-finite-element",
    reads_root: true,
    has_contact: true,
    has_coupling: true,
    steps: STEPS,
    tooth: |gear, _| Ok(Kind::Field(gear.field()?)),
};

impl ToothCompliance {
    /// Finite elements of the whole gear in plane strain.
    pub const FINITE_ELEMENT: ToothCompliance = ToothCompliance::named(MODEL.name);
}

const STEPS: &[Step] = &[
    step("q_1", "driver loaded at O1D, contact left out", "um mm/N", Words(FORMULA), |k| {
        Some(k.solution.compliance?.driver)
    }),
    step(
        "q_2",
        "driven gear loaded at its tip, contact left out",
        "um mm/N",
        Words(FORMULA),
        |k| Some(k.solution.compliance?.driven),
    ),
    step(
        "q_H",
        "contact at the impact force: surface less centre line",
        "um mm/N",
        Text("q_H1 + q_H2 + 2 ln(m/a_H)/(π E')"),
        |k| {
            let (teeth, place) = at_d(k)?;
            teeth.spring(&place).ok()?.compliance(k.solution.impact?.force).ok()
        },
    ),
    step(
        "q_H1",
        "contact of the driver at O1D for a half-width of one module",
        "um mm/N",
        Words(CONTACT),
        |k| at_one_module(k, 0),
    ),
    step(
        "q_H2",
        "contact of the driven tip for a half-width of one module",
        "um mm/N",
        Words(CONTACT),
        |k| at_one_module(k, 1),
    ),
];

const FORMULA: &str = "finite elements of the whole gear in plane strain, clamped at the bore: the \
    displacement of the tooth's centre line along the force, less the twist of the body about the bore \
    r_b² (1 + ν)/(2π E) (1/r_h² - 1/r_f²), and without a bore less its shift";

const CONTACT: &str = "displacement of the flank under an elliptical pressure less that of the centre \
    line, by the same finite elements; any other half-width adds 2 (1 - ν²)/(π E) ln(m/a)";

/// The teeth and the place of their contact at D.
fn at_d(k: &Context) -> Option<(Teeth, ContactPlace)> {
    let (geometry, tip) = (&k.solution.geometry, k.solution.position?.contact);
    let place = ContactPlace::at_tip(k.inputs.driven.tip_radius, geometry, &tip);
    Some((Teeth::of(&k.inputs.elasticity(), geometry).ok()?, place))
}

fn at_one_module(k: &Context, gear: usize) -> Option<f64> {
    let (teeth, place) = at_d(k)?;
    let law = teeth.contacts(&place).ok()?[gear]?;
    Some(law.offset - law.slope * k.inputs.module.ln())
}

/// The refusal of the first gear without a field.
fn refusal(inputs: &Inputs) -> Option<Refusal> {
    let gears = [&inputs.driver, &inputs.driven].map(|gear| ElasticGear::of(inputs, gear));
    gears.iter().find_map(|gear| gear.check_field().err())
}

fn covers(inputs: &Inputs) -> bool {
    refusal(inputs).is_none()
}

fn check(context: &Context) -> Option<Finding> {
    let Inputs { driver, driven, .. } = context.inputs;
    let refusal = refusal(context.inputs);
    let solid = "; a gear without a bore has no clamped circle, and the shift of its body is left \
        out: even a small bore adds the shift, a step at r_h = 0";
    let is_solid = driver.bore_radius.min(driven.bore_radius) == 0.0;
    let have = "both gears have finite elements".to_owned() + if is_solid { solid } else { "" };
    let here = refusal.map_or(have, |found| found.to_string());
    Finding::new(format!("finite elements: {}", MODEL.range), here, refusal.is_none())
}

fn outside(inputs: &Inputs, _: &Geometry) -> Option<(&'static str, String)> {
    refusal(inputs).map(|refusal| ("no-field", refusal.to_string()))
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::model::field::Field;
    use crate::model::inputs::Drive;
    use crate::model::sample::standard_pair;
    use crate::model::{Stages, solve};

    fn fields(inputs: &Inputs) -> [Arc<Field>; 2] {
        let elasticity = inputs.elasticity();
        [elasticity.driver, elasticity.driven].map(|gear| gear.field().unwrap())
    }

    #[test]
    fn an_edit_of_load_deviation_or_relief_builds_no_field() {
        let before = standard_pair(23, 31, 5e-3);
        let [driver, driven] = fields(&before);
        let edits: [fn(&mut Inputs); 7] = [
            |inputs| inputs.drive = Drive::Torque(200.0),
            |inputs| inputs.speed *= 2.0,
            |inputs| inputs.base_pitch_deviation = 20e-6,
            |inputs| inputs.driven.tip_relief = 30e-6,
            |inputs| inputs.driver.face_width *= 2.0,
            |inputs| inputs.driver.young *= 1.1,
            |inputs| inputs.driver.density *= 1.1,
        ];
        for edit in edits {
            let mut after = before.clone();
            edit(&mut after);
            assert!(solve(&after, Stages::CLOSED_FORM).is_ok());
            let [new_driver, new_driven] = fields(&after);
            assert!(Arc::ptr_eq(&driver, &new_driver) && Arc::ptr_eq(&driven, &new_driven));
        }
    }

    #[test]
    fn a_change_of_one_gear_builds_one_field_and_equal_gears_share_a_field() {
        let mut inputs = standard_pair(27, 27, 4e-3);
        let [driver, driven] = fields(&inputs);
        assert!(Arc::ptr_eq(&driver, &driven));
        inputs.driven.bore_radius = 10e-3;
        let [kept, bored] = fields(&inputs);
        assert!(Arc::ptr_eq(&driver, &kept) && !Arc::ptr_eq(&driver, &bored));
    }

    #[test]
    fn a_gear_without_a_field_is_solved_by_the_beam_and_a_note_says_why() {
        let mut inputs = standard_pair(12, 40, 5e-3);
        inputs.driver.profile_shift = 0.2;
        inputs.driver.bore_radius = 0.999 * 5e-3 * (6.0 - 1.25 + 0.2) + 0.5e-6;
        inputs.driver.poisson = 0.495;
        inputs.base_pitch_deviation = 20e-6;
        assert_eq!(inputs.elasticity().tooth, ToothCompliance::BEAM);
        let solution = solve(&inputs, Stages::CLOSED_FORM).unwrap();
        let notes = crate::model::notes(&inputs, &solution);
        let note = notes.iter().find(|note| note.code == "tooth-compliance-beam");
        let message = &note.unwrap().message;
        assert!(message.contains("no finite elements for the gear with 12 teeth"), "{message}");
    }
}
