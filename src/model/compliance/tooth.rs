//! The list of tooth compliances. A new model needs one file in this folder and one entry in
//! [`MODELS`].

pub mod beam;
pub mod finite_element;
pub mod from_table;
pub mod kuang_yang;

use std::sync::Arc;

use super::ElasticGear;
use super::contact::ContactLaw;
use crate::model::Refusal;
use crate::model::explanation::{Context, Finding, Step};
use crate::model::field::Field;
use crate::model::geometry::{Circles, Geometry};
use crate::model::inputs::{ContactCompliance, GearSide, Inputs, Method, ToothCompliance};
use crate::numeric::chebyshev::TERMS;
use crate::numeric::real::Lanes;

/// Every model.
pub const MODELS: [&ToothModel; 4] =
    [&kuang_yang::MODEL, &beam::MODEL, &finite_element::MODEL, &from_table::MODEL];

/// A model of the compliance of one tooth.
#[derive(Debug)]
pub struct ToothModel {
    /// The name in a case file.
    pub name: &'static str,
    /// The index in a symbol such as F_fit,log.
    pub index: &'static str,
    /// The range, in words.
    pub range: &'static str,
    /// Whether the pair is in the range.
    pub covers: fn(&Inputs) -> bool,
    /// The reason why a pair is outside the range, as the end of a sentence.
    pub why_outside: fn(&Inputs) -> String,
    /// Compares a pair with the range, for an explanation.
    pub check: fn(&Context) -> Option<Finding>,
    /// The note for a pair outside the range: its code and its message.
    pub outside: fn(&Inputs, &Geometry) -> Option<(&'static str, String)>,
    /// The code of the note if the range determined this model.
    pub chosen: &'static str,
    /// Whether the compliance depends on the root of the tooth, and therefore on the dedendum.
    pub reads_root: bool,
    /// Whether the model includes the contact, so that the contact compliance of the case is not
    /// used.
    pub has_contact: bool,
    /// Whether the force on a tooth displaces its neighbours, see [`Tooth::neighbour`].
    pub has_coupling: bool,
    /// The steps of q_1 and q_2, and of q_H if the model includes the contact.
    pub steps: &'static [Step],
    /// Prepares the tooth of a gear.
    pub tooth: fn(&ElasticGear, &Circles) -> Result<Kind, Refusal>,
}

/// A tooth by one of the models.
#[derive(Debug, Clone)]
pub enum Kind {
    /// The stiffness is linear in the radius of the load point.
    Line(StiffnessLine),
    /// Computed from the circles and the radius of the load point at each call.
    Beam(Circles),
    /// The finite elements of the gear.
    Field(Arc<Field>),
    /// The table of the case, which [`Teeth`](super::Teeth) reads by the place of the pair.
    Given,
}

/// N/(µm mm) in Pa.
const NEWTON_PER_MICRON_MILLIMETRE: f64 = 1e9;

/// The stiffness of a tooth, linear in the height of the load point above the reference circle.
#[derive(Debug, Clone, Copy)]
pub struct StiffnessLine {
    /// Stiffness at the reference circle, in N/(µm mm).
    pub at_reference: f64,
    /// Increase per unit of height, in N/(µm mm).
    pub per_height: f64,
    /// Radius of the reference circle, in m.
    pub reference: f64,
    /// The unit of the height, in m.
    pub height: f64,
}

impl StiffnessLine {
    /// Compliance of the tooth loaded at a radius, in m²/N.
    ///
    /// # Errors
    /// [`Refusal::HeightOutsideFit`] if the stiffness is not above 0.
    pub fn compliance(&self, radius: f64) -> Result<f64, Refusal> {
        let height = (radius - self.reference) / self.height;
        let stiffness =
            NEWTON_PER_MICRON_MILLIMETRE * (self.at_reference + self.per_height * height);
        if stiffness > 0.0 {
            Ok(1.0 / stiffness)
        } else {
            Err(Refusal::HeightOutsideFit { height })
        }
    }
}

/// One tooth of a gear, prepared for any load point.
#[derive(Debug, Clone)]
pub struct Tooth {
    gear: ElasticGear,
    kind: Kind,
}

impl Tooth {
    /// The tooth of a gear by a model.
    ///
    /// # Errors
    /// Those of the model if it builds an object for the gear.
    pub fn of(
        model: ToothCompliance,
        gear: &ElasticGear,
        circles: &Circles,
    ) -> Result<Tooth, Refusal> {
        Ok(Tooth { gear: *gear, kind: (model.model().tooth)(gear, &gear.circles(circles)?)? })
    }

    /// Compliance of the tooth loaded at a radius, contact excluded, in m²/N.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn at(&self, radius: f64) -> Result<f64, Refusal> {
        let radius = radius + self.gear.rise;
        let normal = match &self.kind {
            Kind::Line(line) => line.compliance(radius)?,
            Kind::Beam(circles) => beam::tooth(&self.gear, circles, radius)?,
            Kind::Field(field) => {
                self.check_radius(field, radius)?;
                field.depth(radius, 0.0) / self.gear.young
            }
            Kind::Given => 0.0,
        };
        Ok(self.gear.oblique * normal)
    }

    /// The contact law of the tooth loaded at a radius. `None` for a model without contact.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn contact(&self, radius: f64) -> Result<Option<ContactLaw>, Refusal> {
        let Some(field) = self.field() else {
            return Ok(None);
        };
        let radius = radius + self.gear.rise;
        self.check_radius(field, radius)?;
        let (module, young) = (self.gear.rack.module, self.gear.young / self.gear.oblique);
        let contact = field.surface(radius, module) - field.depth(radius, 0.0);
        let slope = field.surface_slope();
        let offset = (contact + slope * module.ln()) / young;
        Ok(Some(ContactLaw { offset, slope: slope / young }))
    }

    /// Displacement of another tooth's flank at radius `measured`, along its own line of force, for
    /// a load of 1 N/m on this tooth at radius `loaded`, in m²/N. The other tooth is `pitches`
    /// ahead in the direction of the force; teeth behind have negative numbers.
    ///
    /// Excludes the twist of the body about its bore, and without a bore the shift of the body. 0
    /// for a model without coupling, for the loaded tooth itself, and for teeth more than
    /// [`PITCHES`](crate::model::field::PITCHES) away.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn neighbour(&self, loaded: f64, measured: f64, pitches: i32) -> Result<f64, Refusal> {
        let Some(field) = self.field() else {
            return Ok(0.0);
        };
        let [loaded, measured] = [loaded, measured].map(|radius| radius + self.gear.rise);
        self.check_radius(field, loaded)?;
        self.check_radius(field, measured)?;
        Ok(self.gear.oblique * field.cross(loaded, measured, pitches) / self.gear.young)
    }

    /// Whether the model has the corner of the tip, so that [`Tooth::last_radius`] can be finite.
    pub fn has_corner(&self) -> bool {
        self.field().is_some()
    }

    /// The place at a radius by which [`Tooth::neighbours`] names load and displacement.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn abscissa(&self, radius: f64) -> Result<f64, Refusal> {
        let Some(field) = self.field() else {
            return Ok(radius);
        };
        let radius = radius + self.gear.rise;
        self.check_radius(field, radius)?;
        Ok(field.abscissa(radius))
    }

    /// The same as [`Tooth::neighbour`] at several pairs of [places](Tooth::abscissa) at once:
    /// those of the loads and those of the displacements.
    pub fn neighbours(&self, places: [Lanes<TERMS>; 2], pitches: i32) -> Lanes<TERMS> {
        let per_young = self.gear.oblique / self.gear.young;
        self.field().map_or(Lanes::all(0.0), |field| field.cross_at(places, pitches) * per_young)
    }

    /// Radius in m of the load whose pressure over ± `half_width` ends at the corner of the tip. A
    /// load farther out acts at this radius. Infinite for a model without a corner.
    pub fn last_radius(&self, half_width: f64) -> f64 {
        let last = |field: &Field| field.last_radius(half_width) - self.gear.rise;
        self.field().map_or(f64::INFINITY, last)
    }

    fn field(&self) -> Option<&Field> {
        if let Kind::Field(field) = &self.kind { Some(field) } else { None }
    }

    /// Refuses a load below the form circle.
    fn check_radius(&self, field: &Field, radius: f64) -> Result<(), Refusal> {
        let [form, _] = field.radii();
        if radius < form {
            let [radius, form] = [radius, form].map(|radius| radius - self.gear.rise);
            return Err(Refusal::BelowFormCircle { gear: GearSide::Driver, radius, form });
        }
        Ok(())
    }
}

/// The models in order of preference if the case names none and gives no compliance.
pub fn preferences(inputs: &Inputs) -> [&'static ToothModel; 3] {
    if inputs.method == Method::Paper {
        [&kuang_yang::MODEL, &beam::MODEL, &finite_element::MODEL]
    } else {
        [&finite_element::MODEL, &beam::MODEL, &kuang_yang::MODEL]
    }
}

/// The tooth compliance of a pair: the choice of the case, the table of the case, or the first of the
/// [`preferences`] that covers the pair. If none covers the pair, the beam, whose refusal gives the reason.
pub fn model_of(inputs: &Inputs) -> ToothCompliance {
    let by_range = || {
        let covering = preferences(inputs).into_iter().find(|model| (model.covers)(inputs));
        ToothCompliance::named(covering.unwrap_or(&beam::MODEL).name)
    };
    let given = inputs.given_compliance.map(|_| ToothCompliance::FROM_TABLE);
    inputs.tooth_compliance.or(given).unwrap_or_else(by_range)
}

/// A tooth compliance that is quick to build, if the model of the pair needs finite elements.
pub fn without_field(inputs: &Inputs) -> Option<ToothCompliance> {
    let has_field = model_of(inputs) == ToothCompliance::FINITE_ELEMENT;
    has_field.then_some(ToothCompliance::BEAM)
}

/// The contact compliance of a pair; `None` if the tooth compliance includes the contact.
pub fn contact_of(inputs: &Inputs) -> Option<ContactCompliance> {
    let has_contact = model_of(inputs).model().has_contact;
    (!has_contact).then_some(inputs.contact_compliance)
}

impl ToothCompliance {
    /// Every model that computes the compliance, in the order of the list.
    pub const ALL: [ToothCompliance; 3] =
        [ToothCompliance::KUANG_YANG, ToothCompliance::BEAM, ToothCompliance::FINITE_ELEMENT];
    /// Every model, in the order of the list.
    pub const CHOICES: [ToothCompliance; MODELS.len()] = [
        ToothCompliance::KUANG_YANG,
        ToothCompliance::BEAM,
        ToothCompliance::FINITE_ELEMENT,
        ToothCompliance::FROM_TABLE,
    ];

    /// The names in a case file.
    pub const NAMES: [&str; MODELS.len()] =
        [MODELS[0].name, MODELS[1].name, MODELS[2].name, MODELS[3].name];

    /// One sentence for each model, for the form.
    pub const HELP: &str = "kuang-yang: Eq. 56, for z 12..100, |x| <= 0.6, 20 deg full-depth steel. \
        beam: potential energy on the true profile, in plane strain. finite-element: plane strain of \
        the whole gear with its contact, the default except in method paper. given: the table \
        [compliance] of the case, the default with this table.";

    /// Whether the model takes the compliances that the case gives.
    pub fn reads_table(self) -> bool {
        self == ToothCompliance::FROM_TABLE
    }

    /// The entry of the list.
    pub fn model(self) -> &'static ToothModel {
        MODELS.into_iter().find(|model| model.name == self.name()).unwrap_or(MODELS[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    #[test]
    fn a_model_has_coupling_where_a_force_displaces_the_next_tooth() {
        let inputs = standard_pair(20, 30, 5e-3);
        let geometry = geometry::<f64>(&inputs.shape()).unwrap();
        let gear = inputs.elasticity().driver;
        let [loaded, measured] = [0.95, 0.97].map(|part| part * geometry.driver.tip);
        for model in ToothCompliance::ALL {
            let tooth = Tooth::of(model, &gear, &geometry.driver).unwrap();
            let neighbour = tooth.neighbour(loaded, measured, 1).unwrap();
            assert_eq!(neighbour != 0.0, model.model().has_coupling, "{}", model.name());
        }
    }

    #[test]
    fn every_pair_is_covered_by_a_model() {
        for teeth in [5, 12, 20, 100, 1000] {
            let inputs = standard_pair(teeth, 60, 5e-3);
            let model = model_of(&inputs).model();
            assert!((model.covers)(&inputs), "z {teeth}: {}", model.name);
        }
    }
}
