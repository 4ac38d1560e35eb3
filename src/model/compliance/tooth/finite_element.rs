//! Tooth compliance from the elastic field of the gear, by finite elements.

use std::sync::Arc;

use super::{Compliance, LoadedTooth, ToothModel};
use crate::model::Refusal;
use crate::model::compliance::contact::ContactLaw;
use crate::model::compliance::{ContactPlace, ElasticGear, Teeth};
use crate::model::explanation::Formula::{Text, Words};
use crate::model::explanation::{Context, Finding, Step};
use crate::model::field::{Field, FieldGear};
use crate::model::geometry::{Circles, Geometry};
use crate::model::inputs::{Inputs, ToothCompliance};
use crate::numeric::chebyshev::TERMS;
use crate::numeric::real::Lanes;

/// The entry of the list.
pub const MODEL: ToothModel = ToothModel {
    name: "finite-element",
    index: "fe",
    help: "plane strain of the whole gear with its contact, the default except in method paper",
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
    compliance: Compliance::PerGear(build),
};

impl ToothCompliance {
    /// Finite elements of the whole gear in plane strain.
    pub const FINITE_ELEMENT: ToothCompliance = ToothCompliance::named(MODEL.name);
}

#[rustfmt::skip]
const STEPS: &[Step] = &[
    Step {
        symbol: "q_1",
        meaning: "driver loaded at O1D, contact left out",
        unit: "um mm/N",
        formula: Words(FORMULA),
        value: |k| Some(k.solution.compliance?.driver),
    },
    Step {
        symbol: "q_2",
        meaning: "driven gear loaded at its tip, contact left out",
        unit: "um mm/N",
        formula: Words(FORMULA),
        value: |k| Some(k.solution.compliance?.driven),
    },
    Step {
        symbol: "q_H",
        meaning: "contact at the impact force: surface less centre line",
        unit: "um mm/N",
        formula: Text("q_H1 + q_H2 + 2 ln(m/a_H)/(π E')"),
        value: |k| teeth(k, |teeth, place| {
            teeth.spring(place).ok()?.compliance(k.solution.impact?.force).ok()
        }),
    },
    Step {
        symbol: "q_H1",
        meaning: "contact of the driver at O1D for a half-width of one module",
        unit: "um mm/N",
        formula: Words(CONTACT),
        value: |k| teeth(k, |teeth, place| Some(at_one_module(k, teeth.contacts(place).ok()?[0]?))),
    },
    Step {
        symbol: "q_H2",
        meaning: "contact of the driven tip for a half-width of one module",
        unit: "um mm/N",
        formula: Words(CONTACT),
        value: |k| teeth(k, |teeth, place| Some(at_one_module(k, teeth.contacts(place).ok()?[1]?))),
    },
];

const FORMULA: &str = "finite elements of the whole gear in plane strain, clamped at the bore: the \
    displacement of the tooth's centre line along the force, less the twist of the body about the bore \
    r_b² (1 + ν)/(2π E) (1/r_h² - 1/r_f²), and without a bore less its shift";

const CONTACT: &str = "displacement of the flank under an elliptical pressure less that of the centre \
    line, by the same finite elements; any other half-width adds 2 (1 - ν²)/(π E) ln(m/a)";

/// A value of the pair at D.
fn teeth(k: &Context, value: impl Fn(&Teeth, &ContactPlace) -> Option<f64>) -> Option<f64> {
    let (elasticity, geometry) = (k.inputs.elasticity(), &k.solution.geometry);
    let tip = k.solution.position?.contact;
    let place = ContactPlace::at_tip(k.inputs.driven.tip_radius, geometry, &tip);
    value(&Teeth::of(&elasticity, geometry).ok()?, &place)
}

fn at_one_module(k: &Context, law: ContactLaw) -> f64 {
    law.offset - law.slope * k.inputs.module.ln()
}

/// The refusal of the first gear without a field.
fn refusal(inputs: &Inputs) -> Option<Refusal> {
    let gears = [&inputs.driver, &inputs.driven].map(|gear| ElasticGear::of(inputs, gear));
    gears.iter().find_map(|gear| field_gear(gear).check().err())
}

fn covers(inputs: &Inputs) -> bool {
    refusal(inputs).is_none()
}

fn check(context: &Context) -> Option<Finding> {
    let refusal = refusal(context.inputs);
    let here = refusal.map_or("both gears have a field".to_owned(), |found| found.to_string());
    Finding::new(format!("finite elements: {}", MODEL.range), here, refusal.is_none())
}

fn outside(inputs: &Inputs, _: &Geometry) -> Option<(&'static str, String)> {
    refusal(inputs).map(|refusal| ("no-field", refusal.to_string()))
}

/// The field of a gear, built if no recent solve has built it.
///
/// # Errors
/// [`Refusal::NoField`] if the gear has no field.
pub fn field_of(gear: &ElasticGear) -> Result<Arc<Field>, Refusal> {
    field_gear(gear).field()
}

/// All inputs of a gear's field.
#[must_use]
pub fn field_gear(gear: &ElasticGear) -> FieldGear {
    FieldGear {
        rack: gear.rack,
        shape: gear.shape,
        bore_radius: gear.bore_radius,
        poisson: gear.poisson,
    }
}

/// The teeth of one gear in its elastic field.
///
/// # Formula
/// ```text
/// q(r; a) = q(r) + q_H(r; m) + 2 (1 − ν²)/(π E) ln(m/a)
/// ```
/// q is the displacement of the tooth's centre line along a force at radius r. q_H is the
/// additional displacement of the flank under an elliptical pressure over ± a.
///
/// # Source
/// [`Field`]: finite elements on half a pitch of the whole gear, in plane strain.
///
/// # Valid for
/// A flank above the form circle. A load within 0.02 modules of the tip's corner acts at this
/// distance. Under the mesh force the distance is at least the half-width of the contact, so that
/// the pressure ends at the corner ([`Teeth::under`]). An impact uses the 0.02 modules.
///
/// # Errors
/// [`Refusal::NoField`] if the gear has no field.
fn build(gear: &ElasticGear, _: &Circles) -> Result<Arc<dyn LoadedTooth>, Refusal> {
    Ok(field_of(gear)?)
}

/// Refuses a load below the form circle.
fn check_radius(field: &Field, radius: f64) -> Result<(), Refusal> {
    let [form, _] = field.radii();
    if radius < form {
        return Err(Refusal::BelowFormCircle { field: "driven.addendum", radius, form });
    }
    Ok(())
}

impl LoadedTooth for Field {
    fn at(&self, gear: &ElasticGear, radius: f64) -> Result<f64, Refusal> {
        check_radius(self, radius)?;
        Ok(self.depth(radius, 0.0) / gear.young)
    }

    fn contact(&self, gear: &ElasticGear, radius: f64) -> Result<Option<ContactLaw>, Refusal> {
        check_radius(self, radius)?;
        let module = gear.rack.module;
        let contact = self.surface(radius, module) - self.depth(radius, 0.0);
        let slope = self.surface_slope();
        Ok(Some(ContactLaw {
            offset: (contact + slope * module.ln()) / gear.young,
            slope: slope / gear.young,
        }))
    }

    fn neighbour(
        &self,
        gear: &ElasticGear,
        [loaded, measured]: [f64; 2],
        pitches: i32,
    ) -> Result<f64, Refusal> {
        check_radius(self, loaded)?;
        check_radius(self, measured)?;
        Ok(self.cross(loaded, measured, pitches) / gear.young)
    }

    fn abscissa(&self, radius: f64) -> Result<f64, Refusal> {
        check_radius(self, radius)?;
        Ok(Field::abscissa(self, radius))
    }

    fn neighbours(
        &self,
        gear: &ElasticGear,
        places: [Lanes<TERMS>; 2],
        pitches: i32,
    ) -> Lanes<TERMS> {
        self.cross_at(places, pitches) * gear.young.recip()
    }

    fn last_radius(&self, half_width: f64) -> f64 {
        Field::last_radius(self, half_width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Drive;
    use crate::model::sample::standard_pair;
    use crate::model::{Stages, solve};

    fn fields(inputs: &Inputs) -> [Arc<Field>; 2] {
        let elasticity = inputs.elasticity();
        [elasticity.driver, elasticity.driven].map(|gear| field_of(&gear).unwrap())
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
