//! Masses of the gears at their base circles, from the moments of inertia of outline or disc, or given
//! by the case.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Refusal;
use super::geometry::{Circles, Geometry};
use super::inputs::{Gear, InertiaModel, Inputs, Method};
use super::profile::{Profile, Rack};
use super::tip_gap::TipContact;
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
    pub fn of<T: Real>(bodies: &[Body; 2], geometry: &Geometry<T>) -> Result<Masses, Refusal> {
        let [driver, driven] = bodies;
        let driver = Inertia::of(driver, &geometry.driver)?;
        let driven = Inertia::of(driven, &geometry.driven)?;
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
    #[must_use]
    pub fn reduced(&self) -> f64 {
        self.driver * self.driven / (self.driver + self.driven)
    }

    /// Effective mass of Eq. 50, M = J₁ J₂/(J₁ r_b2'² + J₂ r_b1²), in kg: the reduced mass with the
    /// driven gear's arm at D instead of its base radius.
    #[must_use]
    pub fn effective(&self, geometry: &Geometry, tip: &TipContact) -> f64 {
        let arm = tip.normal_radius_driven / geometry.driven.base;
        self.driver * self.driven / (self.driver * arm * arm + self.driven)
    }
}

/// Relative tolerance of the integral over the fillet.
const TOLERANCE: f64 = 1e-14;

/// A gear's body: the inputs of its inertia besides its circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Body {
    /// The given moment of inertia of all parts that turn with the gear, in kg m².
    Given(f64),
    /// The outline of the gear.
    Outline(Blank, Rack, f64),
    /// A disc up to the base circle, Eq. 47.
    BaseCircle(Blank),
}

/// Bore, width and density of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Blank {
    /// Key of the field of the bore.
    pub bore_field: &'static str,
    /// Bore radius r_h, in m.
    pub bore_radius: f64,
    /// Face width b, in m.
    pub face_width: f64,
    /// Density ρ, in kg/m³.
    pub density: f64,
}

impl Inputs {
    /// Bodies of driver and driven gear. The method `paper` uses the disc of Eq. 47.
    #[must_use]
    pub fn bodies(&self) -> [Body; 2] {
        let body = |bore_field, gear: &Gear| {
            let blank = Blank {
                bore_field,
                bore_radius: gear.bore_radius,
                face_width: gear.face_width,
                density: gear.density,
            };
            match (self.inertia_model(), gear.inertia) {
                (_, Some(given)) => Body::Given(given),
                (InertiaModel::Outline, None) => {
                    let addendum = gear.addendum_coefficient(self.module);
                    Body::Outline(blank, Rack::of(self, gear), addendum)
                }
                (InertiaModel::BaseCircle, None) => Body::BaseCircle(blank),
            }
        };
        [body("driver.bore_radius", &self.driver), body("driven.bore_radius", &self.driven)]
    }

    /// The inertia model of a gear without a given inertia. The method `paper` has only one model.
    #[must_use]
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
    pub fn of<T: Real>(body: &Body, circles: &Circles<T>) -> Result<Inertia, Refusal> {
        let disc = |blank: &Blank, is_fallback| {
            disc(blank, circles).map(|moment| Inertia { moment, is_fallback })
        };
        match body {
            Body::Given(moment) => Ok(Inertia { moment: *moment, is_fallback: false }),
            Body::BaseCircle(blank) => disc(blank, false),
            Body::Outline(blank, rack, addendum) => {
                let circles = whole(&circles.rounded(), rack, *addendum);
                check_bore(blank, "root", circles.root)?;
                let section =
                    polar_moment(&Profile::of(rack, &circles), rack.teeth, blank.bore_radius);
                match section {
                    Some(section) => Ok(Inertia {
                        moment: blank.density * blank.face_width * section,
                        is_fallback: false,
                    }),
                    None => disc(blank, true),
                }
            }
        }
    }
}

/// The circles of the gear without chamfer and rounding of the tip.
fn whole(circles: &Circles, rack: &Rack, addendum: f64) -> Circles {
    let tip = circles.reference + rack.module * (addendum + rack.profile_shift);
    Circles { tip, tip_curvature: ((tip - circles.base) * (tip + circles.base)).sqrt(), ..*circles }
}

/// J of the disc to the base circle, in kg m².
fn disc<T: Real>(blank: &Blank, circles: &Circles<T>) -> Result<f64, Refusal> {
    let (base, bore): (T, T) = (circles.base, blank.bore_radius.into());
    check_bore(blank, "root", circles.root.rounded())?;
    check_bore(blank, "base", base.rounded())?;
    let (wall, base, bore) = ((base - bore).rounded(), base.rounded(), blank.bore_radius);
    let fourth_powers = wall * (base + bore) * (base * base + bore * bore);
    Ok(PI * blank.density * blank.face_width / 2.0 * fourth_powers)
}

fn check_bore(blank: &Blank, circle: &'static str, limit: f64) -> Result<(), Refusal> {
    if blank.bore_radius >= limit {
        return Err(Refusal::BoreTooLarge {
            field: blank.bore_field,
            bore: blank.bore_radius,
            circle,
            limit,
        });
    }
    Ok(())
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
#[must_use]
pub fn polar_moment(profile: &Profile, teeth: u32, bore_radius: f64) -> Option<f64> {
    let root = profile.circles().root;
    let ring = PI / 2.0
        * (root - bore_radius)
        * (root + bore_radius)
        * (root * root + bore_radius * bore_radius);
    let fillet = fillet_moment(profile)?;
    Some(ring + 2.0 * f64::from(teeth) * (flank_moment(profile)? + fillet))
}

/// ∫ θ r³ dr over the involute in closed form. `None` if the involute begins beyond its end.
///
/// # Formula
/// ```text
/// r = rb √(1 + φ²),  θ = θ_b − φ + atan φ
/// rb⁴ [θ (1 + φ²)²/4 + φ³/12 + φ⁵/20]
/// ```
fn flank_moment(profile: &Profile) -> Option<f64> {
    let base = profile.circles().base;
    let half_angle = |roll: f64| profile.base_half_angle() - roll + roll.atan();
    let (start, tip) = (profile.junction.roll, profile.circles().tip_curvature / base);
    if half_angle(start) <= 0.0 {
        return None;
    }
    if tip <= start {
        return Some(0.0);
    }
    let end = if half_angle(tip) < 0.0 {
        last_where(start, tip, |roll| half_angle(roll) > 0.0)
    } else {
        tip
    };
    let primitive = |roll: f64| {
        let square = roll * roll;
        half_angle(roll) * (1.0 + square) * (1.0 + square) / 4.0
            + square * roll * (1.0 / 12.0 + square / 20.0)
    };
    Some(base.powi(4) * (primitive(end) - primitive(start)))
}

/// ∫ θ r³ dr over the fillet, at most to the tip circle. `None` if both sides of the fillet meet.
fn fillet_moment(profile: &Profile) -> Option<f64> {
    let tip = profile.circles().tip;
    let end = -last_where(-FRAC_PI_2, -profile.junction.normal, |normal| {
        let section = profile.fillet_at(-normal);
        section.along.hypot(section.half_thickness) <= tip
    });
    let is_whole = std::cell::Cell::new(true);
    let moment = quadrature::adaptive(FRAC_PI_2, end, TOLERANCE, |normal| {
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

/// The greatest value at which a condition is true, by bisection. The condition is true at `from`
/// and changes at most once.
fn last_where(from: f64, to: f64, is_true: impl Fn(f64) -> bool) -> f64 {
    const HALVINGS: usize = 60;
    if is_true(to) {
        return to;
    }
    let (mut low, mut high) = (from, to);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if is_true(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
