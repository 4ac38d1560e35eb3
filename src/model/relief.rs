//! Tip and root relief along the flanks.

use std::f64::consts::FRAC_PI_2;

use super::Refusal;
use super::geometry::Geometry;
use super::inputs::{Gear, GearSide, Inputs, ReliefShape};

/// Reliefs of the pair given by the case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reliefs {
    /// Shape of the reliefs along the path of contact.
    pub shape: ReliefShape,
    /// Of the driver.
    pub driver: GearReliefs,
    /// Of the driven gear.
    pub driven: GearReliefs,
}

/// Reliefs of one gear, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearReliefs {
    /// Material removed at the tip.
    pub tip: f64,
    /// Material removed at the root.
    pub root: f64,
    /// Length of the tip relief along the path of contact.
    pub tip_length: Option<f64>,
    /// Length of the root relief along the path of contact.
    pub root_length: Option<f64>,
}

impl Inputs {
    /// Reliefs of the pair.
    pub fn reliefs(&self) -> Reliefs {
        let of = |gear: &Gear| GearReliefs {
            tip: gear.tip_relief,
            root: gear.root_relief,
            tip_length: gear.tip_relief_length,
            root_length: gear.root_relief_length,
        };
        Reliefs { shape: self.relief_shape, driver: of(&self.driver), driven: of(&self.driven) }
    }
}

/// Refuses a relief that removes a whole tooth from both flanks.
///
/// # Formula
/// ```text
/// C < r_b (π/2 + 2 x tan α_n)/z + r_b inv α_t
/// ```
/// The right side is half the thickness of the tooth at the base circle, along which C is measured.
///
/// # Errors
/// [`Refusal::ReliefTooLarge`].
pub(super) fn check_reliefs(inputs: &Inputs, geometry: &Geometry) -> Result<(), Refusal> {
    /// No tooth is thinner, in modules.
    const SMALL: f64 = 0.1;
    let gears = [
        (GearSide::Driver, &inputs.driver, &geometry.driver),
        (GearSide::Driven, &inputs.driven, &geometry.driven),
    ];
    for (side, gear, circles) in gears {
        let reliefs = [gear.tip_relief, gear.root_relief];
        if reliefs.iter().all(|relief| *relief <= SMALL * inputs.module) {
            continue;
        }
        let angle = inputs.transverse_pressure_angle();
        let (tangent, normal) = (angle.tan(), inputs.pressure_angle.tan());
        let at_reference = (FRAC_PI_2 + 2.0 * gear.profile_shift * normal) / f64::from(gear.teeth);
        let half = circles.base * (at_reference + tangent - angle);
        if let Some(at) = reliefs.iter().position(|relief| *relief >= half) {
            let (is_at_tip, relief) = (at == 0, reliefs[at]);
            return Err(Refusal::ReliefTooLarge { gear: side, is_at_tip, relief, half });
        }
    }
    Ok(())
}

impl Reliefs {
    /// The sum of all reliefs, in m.
    pub fn sum(&self) -> f64 {
        (self.driver.tip + self.driver.root) + (self.driven.tip + self.driven.root)
    }
}

/// Relief of both flanks at their contact, as a function of the radii of curvature.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    shape: ReliefShape,
    driver: [Ramp; 2],
    driven: [Ramp; 2],
}

/// One relief: the full amount at the radius of curvature `full`, 0 from `none` on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Ramp {
    amount: f64,
    full: f64,
    none: f64,
}

impl Relief {
    /// The reliefs of the pair.
    ///
    /// The default length of a relief is [`Geometry::shared_length`]: for 1 < ε < 2 up to the start
    /// of single-tooth contact, the long relief.
    pub fn of(reliefs: &Reliefs, geometry: &Geometry) -> Relief {
        let usual = geometry.shared_length();
        let ramps = |gear: &GearReliefs, tip: f64, root: f64| {
            let tip_length = gear.tip_length.unwrap_or(usual);
            let root_length = gear.root_length.unwrap_or(usual);
            [
                Ramp { amount: gear.tip, full: tip, none: tip - tip_length },
                Ramp { amount: gear.root, full: root, none: root + root_length },
            ]
        };
        let (start, end, length) = (geometry.start, geometry.end, geometry.tangent_length);
        Relief {
            shape: reliefs.shape,
            driver: ramps(&reliefs.driver, end, start),
            driven: ramps(&reliefs.driven, length - start, length - end),
        }
    }

    /// Relief of both flanks at these radii of curvature, in m.
    ///
    /// # Formula
    /// ```text
    /// C1a h((N1B − ρ1)/L1a) + C1f h((ρ1 − N1E)/L1f)
    ///     + C2a h((N2E − ρ2)/L2a) + C2f h((ρ2 − N2B)/L2f)
    /// h(t) = 1 − t  linear,  (1 − t)²  parabolic;  1 for t < 0,  0 for t > 1
    /// ```
    /// Before E the driven tip touches the driver above the point of E. There the driver's root
    /// relief decreases, and the relief of the driven tip is at its full amount.
    pub fn at(&self, driver: f64, driven: f64) -> f64 {
        let sum = |ramps: &[Ramp; 2], curvature: f64| -> f64 {
            ramps.iter().map(|ramp| ramp.at(curvature, self.shape)).sum()
        };
        sum(&self.driver, driver) + sum(&self.driven, driven)
    }

    /// The path of contact on unrelieved flanks over the base pitch.
    pub fn unrelieved_contact_ratio(&self, geometry: &Geometry) -> f64 {
        let on_driven = |ramp: &Ramp| geometry.tangent_length - ramp.none;
        let ([tip, root], [other_tip, other_root]) = (&self.driver, &self.driven);
        let first = [(root, root.none), (other_tip, on_driven(other_tip))].into_iter();
        let last = [(tip, tip.none), (other_root, on_driven(other_root))].into_iter();
        let is_given = |(ramp, _): &(&Ramp, f64)| ramp.amount > 0.0;
        let from = first.filter(is_given).map(|(_, end)| end).fold(geometry.start, f64::max);
        let to = last.filter(is_given).map(|(_, end)| end).fold(geometry.end, f64::min);
        (to - from) / geometry.base_pitch
    }

    /// Radii of curvature of the driver's flank at which a relief ends.
    pub fn ends_on_driver(&self) -> impl Iterator<Item = f64> {
        ends(&self.driver)
    }

    /// Radii of curvature of the driven flank at which a relief ends.
    pub fn ends_on_driven(&self) -> impl Iterator<Item = f64> {
        ends(&self.driven)
    }

    /// Effect of the rounding of a radius of curvature on the relief of both flanks, in m. Limits
    /// the precision of a steep relief.
    pub fn rounding(&self) -> f64 {
        let ramps = self.driver.iter().chain(&self.driven);
        ramps.map(Ramp::rounding).sum()
    }

    /// Upper bound of the relief of both flanks together, in m.
    pub fn most(&self) -> f64 {
        self.driver.iter().chain(&self.driven).map(|ramp| ramp.amount).sum()
    }
}

fn ends(ramps: &[Ramp; 2]) -> impl Iterator<Item = f64> {
    ramps.iter().filter(|ramp| ramp.amount > 0.0).flat_map(|ramp| [ramp.none, ramp.full])
}

impl Ramp {
    /// See [`Relief::rounding`]. A parabola is twice as steep as its chord.
    fn rounding(&self) -> f64 {
        let radius = self.full.abs().max(self.none.abs());
        2.0 * self.amount * f64::EPSILON * radius / (self.full - self.none).abs()
    }

    fn at(&self, curvature: f64, shape: ReliefShape) -> f64 {
        let left = ((curvature - self.none) / (self.full - self.none)).clamp(0.0, 1.0);
        match shape {
            ReliefShape::Linear => self.amount * left,
            ReliefShape::Parabolic => self.amount * left * left,
        }
    }
}
