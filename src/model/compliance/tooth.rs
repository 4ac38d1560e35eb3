//! The list of tooth compliances. A new model needs one file in this folder and one entry in
//! [`MODELS`].

pub mod beam;
pub mod finite_element;
pub mod kuang_yang;

use std::fmt::Debug;
use std::sync::Arc;

pub use finite_element::{field_gear, field_of};

use super::ElasticGear;
use super::contact::ContactLaw;
use super::list::listed;
use crate::model::Refusal;
use crate::model::explanation::{Context, Finding, Step};
use crate::model::geometry::{Circles, Geometry};
use crate::model::inputs::{ContactCompliance, Inputs, Method, ToothCompliance};
use crate::numeric::chebyshev::TERMS;
use crate::numeric::real::Lanes;

/// Every model.
pub const MODELS: [&ToothModel; 3] = [&kuang_yang::MODEL, &beam::MODEL, &finite_element::MODEL];

/// A model of the compliance of one tooth.
#[derive(Debug)]
pub struct ToothModel {
    /// The name in a case file.
    pub name: &'static str,
    /// The index in a symbol such as F_fit,log.
    pub index: &'static str,
    /// Help text in the form, without a full stop.
    pub help: &'static str,
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
    /// Computation of the compliance.
    pub compliance: Compliance,
}

type ByRadius = fn(&ElasticGear, &Circles, f64) -> Result<f64, Refusal>;
type Line = fn(&ElasticGear, &Circles) -> Result<StiffnessLine, Refusal>;
type Build = fn(&ElasticGear, &Circles) -> Result<Arc<dyn LoadedTooth>, Refusal>;

/// The form of a compliance function for one tooth, contact excluded, per unit width, in m²/N.
#[derive(Debug, Clone, Copy)]
pub enum Compliance {
    /// Computed from the radius of the load point at each call.
    AtRadius(ByRadius),
    /// The stiffness is linear in the radius of the load point.
    Line(Line),
    /// Uses an object that is built once per gear and evaluated at each radius.
    PerGear(Build),
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

/// The teeth of one gear under a load, built by a [`Compliance::PerGear`].
pub trait LoadedTooth: Debug + Send + Sync {
    /// Compliance of the tooth loaded at a radius, contact excluded, in m²/N.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    fn at(&self, gear: &ElasticGear, radius: f64) -> Result<f64, Refusal>;

    /// The contact law of the tooth loaded at a radius. `None` for a model without contact.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    fn contact(&self, _gear: &ElasticGear, _radius: f64) -> Result<Option<ContactLaw>, Refusal> {
        Ok(None)
    }

    /// See [`Tooth::neighbour`], with the radii of load and displacement. 0 for a model without
    /// coupling.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    fn neighbour(
        &self,
        _gear: &ElasticGear,
        _radii: [f64; 2],
        _pitches: i32,
    ) -> Result<f64, Refusal> {
        Ok(0.0)
    }

    /// See [`Tooth::abscissa`].
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    fn abscissa(&self, radius: f64) -> Result<f64, Refusal> {
        Ok(radius)
    }

    /// See [`Tooth::neighbours`]; 0 for a model of single teeth.
    fn neighbours(
        &self,
        _gear: &ElasticGear,
        _places: [Lanes<TERMS>; 2],
        _pitches: i32,
    ) -> Lanes<TERMS> {
        Lanes::all(0.0)
    }

    /// See [`Tooth::last_radius`]. Infinite for a model without a corner.
    fn last_radius(&self, _half_width: f64) -> f64 {
        f64::INFINITY
    }
}

/// One tooth of a gear, prepared for any load point.
#[derive(Debug, Clone)]
pub struct Tooth {
    gear: ElasticGear,
    circles: Circles,
    serves: Serves,
}

#[derive(Debug, Clone)]
enum Serves {
    AtRadius(ByRadius),
    Line(StiffnessLine),
    Built(Arc<dyn LoadedTooth>),
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
        Tooth::by(&model.model().compliance, gear, circles)
    }

    fn by(
        compliance: &Compliance,
        gear: &ElasticGear,
        circles: &Circles,
    ) -> Result<Tooth, Refusal> {
        let serves = match compliance {
            Compliance::AtRadius(of) => Serves::AtRadius(*of),
            Compliance::Line(of) => Serves::Line(of(gear, circles)?),
            Compliance::PerGear(build) => Serves::Built(build(gear, circles)?),
        };
        Ok(Tooth { gear: *gear, circles: *circles, serves })
    }

    /// Compliance of the tooth loaded at a radius, in m²/N.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn at(&self, radius: f64) -> Result<f64, Refusal> {
        match &self.serves {
            Serves::AtRadius(of) => of(&self.gear, &self.circles, radius),
            Serves::Line(line) => line.compliance(radius),
            Serves::Built(built) => built.at(&self.gear, radius),
        }
    }

    /// The contact law of the tooth loaded at a radius. `None` for a model without contact.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn contact(&self, radius: f64) -> Result<Option<ContactLaw>, Refusal> {
        match &self.serves {
            Serves::AtRadius(_) | Serves::Line(_) => Ok(None),
            Serves::Built(built) => built.contact(&self.gear, radius),
        }
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
        match &self.serves {
            Serves::AtRadius(_) | Serves::Line(_) => Ok(0.0),
            Serves::Built(built) => built.neighbour(&self.gear, [loaded, measured], pitches),
        }
    }

    /// Whether the model has the corner of the tip, so that [`Tooth::last_radius`] can be finite.
    #[must_use]
    pub fn has_corner(&self) -> bool {
        matches!(self.serves, Serves::Built(_))
    }

    /// The place at a radius by which [`Tooth::neighbours`] names load and displacement.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn abscissa(&self, radius: f64) -> Result<f64, Refusal> {
        match &self.serves {
            Serves::AtRadius(_) | Serves::Line(_) => Ok(radius),
            Serves::Built(built) => built.abscissa(radius),
        }
    }

    /// The same as [`Tooth::neighbour`] at several pairs of [places](Tooth::abscissa) at once:
    /// those of the loads and those of the displacements.
    #[must_use]
    pub fn neighbours(&self, places: [Lanes<TERMS>; 2], pitches: i32) -> Lanes<TERMS> {
        match &self.serves {
            Serves::AtRadius(_) | Serves::Line(_) => Lanes::all(0.0),
            Serves::Built(built) => built.neighbours(&self.gear, places, pitches),
        }
    }

    /// Radius in m of the load whose pressure over ± `half_width` ends at the corner of the tip. A
    /// load farther out acts at this radius. Infinite for a model without a corner.
    #[must_use]
    pub fn last_radius(&self, half_width: f64) -> f64 {
        match &self.serves {
            Serves::AtRadius(_) | Serves::Line(_) => f64::INFINITY,
            Serves::Built(built) => built.last_radius(half_width),
        }
    }
}

/// The models in order of preference if the case names none.
#[must_use]
pub fn preferences(inputs: &Inputs) -> [&'static ToothModel; MODELS.len()] {
    if inputs.method == Method::Paper {
        [&kuang_yang::MODEL, &beam::MODEL, &finite_element::MODEL]
    } else {
        [&finite_element::MODEL, &beam::MODEL, &kuang_yang::MODEL]
    }
}

/// The tooth compliance of a pair: the choice of the case, or the first of the [`preferences`] that
/// covers the pair. If none covers the pair, the beam, whose refusal gives the reason.
#[must_use]
pub fn model_of(inputs: &Inputs) -> ToothCompliance {
    let by_range = || {
        let covering = preferences(inputs).into_iter().find(|model| (model.covers)(inputs));
        ToothCompliance::named(covering.unwrap_or(&beam::MODEL).name)
    };
    inputs.tooth_compliance.unwrap_or_else(by_range)
}

/// A tooth compliance that is quick to build, if the model of the pair needs an elastic field.
#[must_use]
pub fn without_field(inputs: &Inputs) -> Option<ToothCompliance> {
    let has_field = model_of(inputs) == ToothCompliance::FINITE_ELEMENT;
    has_field.then_some(ToothCompliance::BEAM)
}

/// The contact compliance of a pair; `None` if the tooth compliance includes the contact.
#[must_use]
pub fn contact_of(inputs: &Inputs) -> Option<ContactCompliance> {
    let has_contact = model_of(inputs).model().has_contact;
    (!has_contact).then_some(inputs.contact_compliance)
}

listed!(ToothCompliance, ToothModel);

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    static BUILT: AtomicUsize = AtomicUsize::new(0);

    #[derive(Debug)]
    struct Field(f64);

    impl LoadedTooth for Field {
        fn at(&self, _: &ElasticGear, radius: f64) -> Result<f64, Refusal> {
            Ok(self.0 * radius)
        }
    }

    #[test]
    fn an_object_of_a_gear_is_built_once_for_every_load_point() {
        let build = Compliance::PerGear(|gear, _| {
            BUILT.fetch_add(1, Ordering::Relaxed);
            Ok(Arc::new(Field(1.0 / gear.young)))
        });
        let inputs = standard_pair(20, 30, 5e-3);
        let geometry = geometry::<f64>(&inputs.shape()).unwrap();
        let gear = inputs.elasticity().driver;
        let tooth = Tooth::by(&build, &gear, &geometry.driver).unwrap();
        for radius in [0.048, 0.05, 0.052] {
            assert_eq!(tooth.at(radius), Ok(1.0 / inputs.driver.young * radius));
        }
        assert_eq!(BUILT.load(Ordering::Relaxed), 1);
    }

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
