//! Masses of the gears at their base circles, from the moments of inertia of outline or disc, or given
//! by the case.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Refusal;
use super::geometry::{Circles, Geometry};
use super::inputs::{Gear, GearSide, InertiaModel, Inputs, Method};
use super::position::TipContact;
use super::profile::{Profile, Rack};
use crate::numeric::{Real, quadrature};

/// Masses of the two gears at their base circles J/r_b², in kg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Masses {
    pub(super) driver: f64,
    pub(super) driven: f64,
    /// Moments of inertia of driver and driven gear.
    pub(super) inertias: [Inertia; 2],
}

impl Masses {
    /// Masses of the two gears.
    ///
    /// # Formula
    /// ```text
    /// m_red,i = J_i/rb_i²
    /// ```
    ///
    /// # Source
    /// Zhou & Chen 2014, Eq. 46. Corrected: Eq. 46 divides by the width and so gives kg/m instead
    /// of kg. [`Inertia::of`] gives J.
    ///
    /// # Errors
    /// [`Refusal::BoreTooLarge`] if a bore is larger than the body.
    pub fn of<T: Real>(inputs: &Inputs, geometry: &Geometry<T>) -> Result<Masses, Refusal> {
        let driver = Inertia::of(inputs, GearSide::Driver, &geometry.driver)?;
        let driven = Inertia::of(inputs, GearSide::Driven, &geometry.driven)?;
        let mass = |inertia: &Inertia, circles: &Circles<T>| {
            let base = circles.base.rounded();
            inertia.moment / (base * base)
        };
        Ok(Masses {
            driver: mass(&driver, &geometry.driver),
            driven: mass(&driven, &geometry.driven),
            inertias: [driver, driven],
        })
    }

    /// Reduced mass of Eq. 33, 1/m_red = 1/m_red,1 + 1/m_red,2, in kg.
    pub fn reduced(&self) -> f64 {
        self.driver * self.driven / (self.driver + self.driven)
    }

    /// Effective mass of Eq. 50, M = J₁ J₂/(J₁ r_b2'² + J₂ r_b1²), in kg: the reduced mass with the
    /// driven gear's arm at D instead of its base radius.
    pub fn effective(&self, geometry: &Geometry, tip: &TipContact) -> f64 {
        let arm = tip.normal_radius_driven / geometry.driven.base;
        self.driver * self.driven / (self.driver * arm * arm + self.driven)
    }
}

/// Relative tolerance of the integral over the fillet.
const TOLERANCE: f64 = 1e-14;

impl Inputs {
    /// The inputs of a gear's inertia besides its circles.
    pub(super) fn body(&self, gear: &Gear) -> impl PartialEq + use<> {
        let section = || (Rack::of(self, gear), self.gear_shape(gear).addendum);
        let section = (self.inertia_model() == InertiaModel::Outline).then(section);
        let blank = || (gear.bore_radius, gear.face_width, gear.density, section);
        (gear.inertia, gear.inertia.is_none().then(blank))
    }

    /// The inertia model of a gear without a given inertia. The method `paper` has only one model.
    pub fn inertia_model(&self) -> InertiaModel {
        match self.method {
            Method::Paper => InertiaModel::BaseCircle,
            _ => self.inertia,
        }
    }
}

/// Moment of inertia of a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// J, in kg m².
    pub moment: f64,
    /// Whether the disc replaces an outline that encloses no tooth.
    pub is_fallback: bool,
}

impl Inertia {
    /// Moment of inertia of a gear.
    ///
    /// # Formula
    /// ```text
    /// outline:      J = ρ b I_p,   I_p of the outline
    /// base-circle:  J = π ρ b/2 (rb⁴ − rh⁴)
    /// ```
    ///
    /// # Source
    /// Zhou & Chen 2014, Eq. 47, without a spurious g; [`polar_moment`].
    ///
    /// # Errors
    /// [`Refusal::BoreTooLarge`] if the bore is larger than the body.
    pub fn of<T: Real>(
        inputs: &Inputs,
        side: GearSide,
        circles: &Circles<T>,
    ) -> Result<Inertia, Refusal> {
        let gear = inputs.gear(side);
        if let Some(moment) = gear.inertia {
            return Ok(Inertia { moment, is_fallback: false });
        }
        let bore = gear.bore_radius;
        let check = |circle, limit| {
            let is_too_large = bore >= limit;
            let refusal = Refusal::BoreTooLarge { gear: side, bore, circle, limit };
            if is_too_large { Err(refusal) } else { Ok(()) }
        };
        check("root", circles.root.rounded())?;
        let is_outline = inputs.inertia_model() == InertiaModel::Outline;
        if is_outline {
            let rack = Rack::of(inputs, gear);
            let addendum = inputs.gear_shape(gear).addendum;
            let profile = Profile::of(&rack, &whole(&circles.rounded(), &rack, addendum));
            if let Some(section) = polar_moment(&profile, rack.teeth, bore) {
                let moment = gear.density * gear.face_width * section;
                return Ok(Inertia { moment, is_fallback: false });
            }
        }
        check("base", circles.base.rounded())?;
        let wall = (circles.base - bore.into()).rounded();
        let base = circles.base.rounded();
        let fourth_powers = wall * (base + bore) * (base * base + bore * bore);
        let moment = PI * gear.density * gear.face_width / 2.0 * fourth_powers;
        Ok(Inertia { moment, is_fallback: is_outline })
    }
}

/// The circles of the gear without chamfer and rounding of the tip.
fn whole(circles: &Circles, rack: &Rack, addendum: f64) -> Circles {
    let tip = circles.reference + rack.module * (addendum + rack.profile_shift);
    Circles { tip, tip_curvature: circles.curvature_at(tip), ..*circles }
}

/// Polar moment of area of the gear's section, in m⁴. J is this moment times density and face
/// width. `None` if the undercut cuts the teeth through.
///
/// # Formula
/// ```text
/// π/2 (r_f⁴ − r_h⁴) + z ∫ 2 θ(r) r³ dr,  r = r_f .. r_a
/// ```
/// θ is half of the tooth's angle. A pointed tooth ends at the intersection of its flanks.
///
/// # Source
/// The profile cut by the rack, see [`Profile`].
pub fn polar_moment(profile: &Profile, teeth: f64, bore_radius: f64) -> Option<f64> {
    let root = profile.circles().root;
    let ring = PI / 2.0
        * (root - bore_radius)
        * (root + bore_radius)
        * (root * root + bore_radius * bore_radius);
    let fillet = fillet_moment(profile)?;
    Some(ring + 2.0 * teeth * (flank_moment(profile)? + fillet))
}

/// ∫ θ r³ dr over the involute in closed form. `None` if the involute begins beyond its end.
///
/// # Formula
/// ```text
/// r = rb √(1 + φ²),  θ = θ_b − φ + atan φ
/// rb⁴ [θ (1 + φ²)²/4 + φ³/12 + φ⁵/20]
/// ```
fn flank_moment(profile: &Profile) -> Option<f64> {
    let start = profile.junction.roll;
    if profile.half_angle(start) <= 0.0 {
        return None;
    }
    if profile.tip_roll() <= start {
        return Some(0.0);
    }
    let primitive = |roll: f64| {
        let square = roll * roll;
        profile.half_angle(roll) * (1.0 + square) * (1.0 + square) / 4.0
            + square * roll * (1.0 / 12.0 + square / 20.0)
    };
    Some(profile.circles().base.powi(4) * (primitive(profile.flank_end()) - primitive(start)))
}

/// ∫ θ r³ dr over the fillet, at most to the tip circle. `None` if both sides of the fillet meet.
fn fillet_moment(profile: &Profile) -> Option<f64> {
    let is_whole = std::cell::Cell::new(true);
    let moment = quadrature::adaptive(FRAC_PI_2, profile.fillet_end(), TOLERANCE, |normal| {
        let section = profile.fillet_at(normal);
        if section.half_thickness <= 0.0 {
            is_whole.set(false);
        }
        let squared =
            section.along * section.along + section.half_thickness * section.half_thickness;
        section.half_thickness.atan2(section.along) * squared * profile.fillet_rise(normal)
    });
    is_whole.get().then_some(moment)
}
