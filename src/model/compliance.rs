//! Compliance of the teeth and of their contact, per unit width.
//!
//! [`tooth::MODELS`] and [`contact::MODELS`] list the models.

pub mod contact;
pub mod flanks;
pub mod tooth;

use super::Refusal;
use super::geometry::Geometry;
use super::given::GivenCompliance;
use super::inputs::{ContactCompliance, Gear, Inputs, ToothCompliance};
use super::pair_forces::{PITCHES, Pair, PairSet};
use super::position::TipContact;
use crate::numeric::chebyshev::TERMS;
use crate::numeric::real::Lanes;
use contact::{ContactLaw, ContactSpring};
use tooth::Tooth;

pub use super::field::ElasticGear;
pub use tooth::{contact_of, model_of, without_field};

/// Elasticity of a pair: the inputs of its compliances besides the geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    /// Model of the teeth.
    pub tooth: ToothCompliance,
    /// Model of the contact.
    pub contact: ContactCompliance,
    /// The driver.
    pub driver: ElasticGear,
    /// The driven gear.
    pub driven: ElasticGear,
    /// The table of the case, if it gives the compliance.
    pub given: Option<GivenCompliance>,
    /// Common face width b, in m.
    pub width: f64,
    /// Whether the force on a pair may displace others.
    pub has_neighbours: bool,
}

impl Inputs {
    /// Elasticity of the pair.
    pub fn elasticity(&self) -> Elasticity {
        let gear = |gear: &Gear| ElasticGear::of(self, gear);
        let tooth = model_of(self);
        Elasticity {
            tooth,
            // A tooth compliance that includes the contact needs no contact model.
            contact: if tooth.model().has_contact {
                ContactCompliance::ALL[0]
            } else {
                self.contact_compliance
            },
            driver: gear(&self.driver),
            driven: gear(&self.driven),
            given: self.given_compliance.filter(|_| tooth.reads_table()),
            width: self.common_width(),
            has_neighbours: self.tooth_coupling && tooth.model().has_coupling,
        }
    }
}

/// Compliance of the two teeth at D, contact excluded, per unit width, in m²/N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TeethCompliance {
    /// The model.
    pub model: ToothCompliance,
    /// Driver's tooth q₁, loaded at O₁D.
    pub driver: f64,
    /// Driven tooth q₂, loaded at its tip.
    pub driven: f64,
}

impl TeethCompliance {
    /// q₁ + q₂, in m²/N.
    pub fn sum(&self) -> f64 {
        self.driver + self.driven
    }
}

/// Contact of two flanks: the load radii and the reduced curvature, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPlace {
    /// Radius of the load point on the driver.
    pub radius_driver: f64,
    /// Radius of the load point on the driven gear.
    pub radius_driven: f64,
    /// Reduced radius of curvature ρ_S.
    pub curvature_radius: f64,
}

impl ContactPlace {
    /// The point of the line of action at the distance `along` from N₁.
    pub fn on_line_of_action(geometry: &Geometry, along: f64) -> ContactPlace {
        let rest = geometry.tangent_length - along;
        let radius = |base: f64, length: f64| (base * base + length * length).sqrt();
        ContactPlace {
            radius_driver: radius(geometry.driver.base, along),
            radius_driven: radius(geometry.driven.base, rest),
            curvature_radius: along * rest / geometry.tangent_length,
        }
    }

    /// The place with the gears swapped.
    pub fn swapped(self) -> ContactPlace {
        ContactPlace {
            radius_driver: self.radius_driven,
            radius_driven: self.radius_driver,
            ..self
        }
    }

    /// The driven tip on the driver's flank.
    pub fn at_tip(tip_radius: Option<f64>, geometry: &Geometry, tip: &TipContact) -> ContactPlace {
        ContactPlace {
            radius_driver: tip.radius_driver,
            radius_driven: tip.radius_driven,
            curvature_radius: super::position::reduced_curvature(tip_radius, geometry, tip),
        }
    }
}

/// Both teeth of a pair, prepared for any place of contact.
#[derive(Debug, Clone)]
pub struct Teeth {
    elasticity: Elasticity,
    geometry: Geometry,
    driver: Tooth,
    driven: Tooth,
}

impl Teeth {
    /// Prepares the teeth of a pair by the model of the case.
    ///
    /// # Errors
    /// Those of a model that builds an object per gear.
    pub fn of(elasticity: &Elasticity, geometry: &Geometry) -> Result<Teeth, Refusal> {
        Ok(Teeth {
            elasticity: *elasticity,
            geometry: *geometry,
            driver: Tooth::of(elasticity.tooth, &elasticity.driver, &geometry.driver)?,
            driven: Tooth::of(elasticity.tooth, &elasticity.driven, &geometry.driven)
                .map_err(Refusal::at_driven)?,
        })
    }

    /// The geometry of the pair.
    pub fn geometry(&self) -> &Geometry {
        &self.geometry
    }

    /// 1/E' of the pair, in 1/Pa.
    pub fn give(&self) -> f64 {
        self.elasticity.give()
    }

    /// Common face width b, in m.
    pub fn width(&self) -> f64 {
        self.elasticity.width
    }

    /// Compliance of the two teeth at a place, in m²/N.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn at(&self, place: &ContactPlace) -> Result<TeethCompliance, Refusal> {
        let [driver, driven] = match self.given_at(place) {
            Some((given, part)) => given.teeth(part),
            None => self.both(place, Tooth::at)?,
        };
        Ok(TeethCompliance { model: self.elasticity.tooth, driver, driven })
    }

    /// The table of the case, if it gives the compliance, and the part of the path.
    fn given_at(&self, place: &ContactPlace) -> Option<(GivenCompliance, f64)> {
        let Geometry { driver, driven, .. } = &self.geometry;
        let arms =
            (driver.curvature_at(place.radius_driver), driven.curvature_at(place.radius_driven));
        Some((self.elasticity.given?, self.geometry.part_of_path(arms)))
    }

    /// A value of driver and driven gear at a place.
    fn both<T>(
        &self,
        place: &ContactPlace,
        of: impl Fn(&Tooth, f64) -> Result<T, Refusal>,
    ) -> Result<[T; 2], Refusal> {
        let driver = of(&self.driver, place.radius_driver)?;
        Ok([driver, of(&self.driven, place.radius_driven).map_err(Refusal::at_driven)?])
    }

    /// The contact laws of driver and driven gear at a place. `None` for a model without contact.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn contacts(&self, place: &ContactPlace) -> Result<[Option<ContactLaw>; 2], Refusal> {
        if let Some((given, part)) = self.given_at(place) {
            let half = ContactLaw { offset: 0.5 * given.contact.at(part), slope: 0.0 };
            return Ok([Some(half); 2]);
        }
        self.both(place, Tooth::contact)
    }

    /// The contact at a place: by the tooth model if it includes the contact, otherwise by the
    /// contact model of the case.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the models.
    pub fn spring(&self, place: &ContactPlace) -> Result<ContactSpring, Refusal> {
        match self.contacts(place)? {
            [Some(driver), Some(driven)] => {
                let teeth = self.at(place)?.sum();
                Ok(self.elasticity.spring(place, teeth, driver + driven))
            }
            _ => self.elasticity.contact_spring(&self.geometry, place),
        }
    }

    /// The place where the load acts on both teeth under a force, in N. If the pressure would
    /// extend beyond the corner of a tip, the load moves until the pressure ends at the corner.
    pub fn under(&self, place: &ContactPlace, force: f64) -> ContactPlace {
        if !self.driver.has_corner() && !self.driven.has_corner() {
            return *place;
        }
        let half_width = self.elasticity.half_width(place, force);
        let moved = |radius: f64, tooth: &Tooth| radius.min(tooth.last_radius(half_width));
        ContactPlace {
            radius_driver: moved(place.radius_driver, &self.driver),
            radius_driven: moved(place.radius_driven, &self.driven),
            ..*place
        }
    }

    /// Displacement of a pair by a unit force on the pair `pitches` later, in m²/N. Equal to the
    /// displacement of the later pair by a force on this pair. `later` and `earlier` are the
    /// contact places.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn coupling(
        &self,
        later: &ContactPlace,
        earlier: &ContactPlace,
        pitches: i32,
    ) -> Result<f64, Refusal> {
        if !self.is_coupled() {
            return Ok(0.0);
        }
        if let Some((given, one)) = self.given_at(later) {
            let other = self.given_at(earlier).map_or(one, |(_, other)| other);
            return Ok(if pitches.abs() == 1 { given.next(one, other) } else { 0.0 });
        }
        // The force pushes a driver's tooth back towards the later pairs, and a driven tooth
        // towards the earlier pairs.
        let driver = self.driver.neighbour(earlier.radius_driver, later.radius_driver, pitches)?;
        let driven = self
            .driven
            .neighbour(earlier.radius_driven, later.radius_driven, -pitches)
            .map_err(Refusal::at_driven)?;
        Ok(driver + driven)
    }

    /// Pairs without gaps at contact places one base pitch apart, per unit width under a force, in N.
    /// The rearmost is the first, `first` pitches ahead of the incoming pair.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the models.
    pub fn pair_set(
        &self,
        first: i32,
        places: &[ContactPlace],
        force: f64,
    ) -> Result<PairSet, Refusal> {
        let (mut pairs, mut couplings) = (Vec::new(), Vec::new());
        for (ahead, place) in (first..).zip(places) {
            let stiffness = 1.0 / self.pair_at_load(place, force)?;
            pairs.push(Pair { ahead, stiffness, gap: 0.0, weight: 1.0 });
            let mut behind = [0.0; PITCHES];
            let rear = places[..couplings.len()].iter().rev();
            for ((pitches, rear), coupling) in (1..).zip(rear).zip(&mut behind) {
                *coupling = self.coupling(rear, place, pitches)?;
            }
            couplings.push(behind);
        }
        Ok(PairSet::new(pairs, couplings))
    }

    /// Whether the force on a pair displaces others.
    pub fn is_coupled(&self) -> bool {
        self.elasticity.has_neighbours
    }

    /// The place on driver and driven gear by which [`Teeth::couplings`] names where a pair
    /// touches.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the model.
    pub fn abscissas(&self, place: &ContactPlace) -> Result<[f64; 2], Refusal> {
        match self.given_at(place) {
            Some((_, part)) => Ok([part; 2]),
            None => self.both(place, Tooth::abscissa),
        }
    }

    /// The same as [`Teeth::coupling`] at several [places](Teeth::abscissas) at once.
    pub fn couplings(
        &self,
        later: [Lanes<TERMS>; 2],
        earlier: [Lanes<TERMS>; 2],
        pitches: i32,
    ) -> Lanes<TERMS> {
        if let Some(given) = self.elasticity.given {
            let next = |lane: usize| given.next(later[0].0[lane], earlier[0].0[lane]);
            let is_next = pitches.abs() == 1;
            return Lanes(std::array::from_fn(|lane| if is_next { next(lane) } else { 0.0 }));
        }
        self.driver.neighbours([earlier[0], later[0]], pitches)
            + self.driven.neighbours([earlier[1], later[1]], -pitches)
    }

    /// Compliance of the pair at a place under a given force, in m²/N, with the load
    /// [moved](Teeth::under) off the corner of a tip.
    ///
    /// # Errors
    /// A [`Refusal`] outside the range of the models.
    pub fn pair_at_load(&self, place: &ContactPlace, force: f64) -> Result<f64, Refusal> {
        let place = self.under(place, force);
        let spring = self.spring(&place)?;
        Ok(self.at(&place)?.sum() + spring.compliance(force)?)
    }
}
