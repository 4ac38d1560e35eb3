//! Compliance from a table of the case: of another program or of a measurement.

use super::tooth::{Kind, ToothModel};
use crate::model::explanation::Formula::Words;
use crate::model::explanation::{Step, step};
use crate::model::geometry::Geometry;
use crate::model::inputs::ToothCompliance;

/// Greatest number of coefficients of a curve.
pub const COEFFICIENTS: usize = 8;

/// A compliance along the path of contact, per unit width, in m²/N.
///
/// # Formula
/// ```text
/// q(t) = q (1 + c1 t + c2 t² + ..),   t = 2 s/g_a − 1, kept within −1 and 1
/// ```
/// s is the path of the pair since E, g_a the length of the path of contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Curve {
    /// q in the middle of the path, in m²/N.
    pub middle: f64,
    /// c1, c2, ..
    pub coefficients: [f64; COEFFICIENTS],
}

impl Curve {
    /// The compliance at t from −1 at E to 1 at B.
    pub fn at(&self, t: f64) -> f64 {
        let t = t.clamp(-1.0, 1.0);
        let sum = self.coefficients.iter().rev().fold(0.0, |sum, &factor| (sum + factor) * t);
        self.middle * (1.0 + sum)
    }

    /// The curve of the pair with the gears swapped.
    fn mirrored(mut self) -> Curve {
        for odd in self.coefficients.iter_mut().step_by(2) {
            *odd = -*odd;
        }
        self
    }
}

/// The table `[compliance]` of a case: compliances in the transverse section, per unit width.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GivenCompliance {
    /// Tooth and body of the driver, without the contact.
    pub driver: Curve,
    /// Tooth and body of the driven gear, without the contact.
    pub driven: Curve,
    /// Contact of both flanks.
    pub contact: Curve,
    /// Displacement of the next pair over that of the loaded pair, without the contact.
    pub cross: f64,
    /// Length L over which a force displaces the slices beside it, in m; `None` for independent
    /// slices.
    pub coupling_length: Option<f64>,
    /// Softening of the acute end of a helical tooth, times its compliance.
    pub end_acute: f64,
    /// Stiffening of the obtuse end, times its compliance.
    pub end_obtuse: f64,
    /// Length over which the effect of an end decays, in m.
    pub end_decay: Option<f64>,
}

impl GivenCompliance {
    /// The table with the gears swapped.
    pub fn swapped(self) -> GivenCompliance {
        GivenCompliance {
            driver: self.driven.mirrored(),
            driven: self.driver.mirrored(),
            contact: self.contact.mirrored(),
            ..self
        }
    }

    /// t of a contact with the load points at these distances from N₁ and N₂. Before E, where only
    /// the driven tip touches, and after B it is that of the end.
    pub fn part(geometry: &Geometry, (driver, driven): (f64, f64)) -> f64 {
        /// Of the path: the two distances of a contact on the line of action differ less.
        const SAME: f64 = 1e-9;
        let length = geometry.end - geometry.start;
        let by_driver = driver - geometry.start;
        let by_driven = geometry.tangent_length - geometry.start - driven;
        let is_on_line = (by_driver - by_driven).abs() <= SAME * length;
        match by_driver + by_driven {
            sum if is_on_line => sum / length - 1.0,
            sum if sum < length => -1.0,
            _ => 1.0,
        }
    }

    /// Compliance of both teeth without the contact, in m²/N.
    pub fn teeth(&self, t: f64) -> [f64; 2] {
        [self.driver.at(t), self.driven.at(t)]
    }

    /// Displacement of a pair at `one` by a unit force on the next pair at `other`, in m²/N.
    pub fn next(&self, one: f64, other: f64) -> f64 {
        let teeth = |t: f64| self.teeth(t).iter().sum::<f64>();
        self.cross * (teeth(one) * teeth(other)).sqrt()
    }
}

/// The entry of the list.
pub const MODEL: ToothModel = ToothModel {
    name: "given",
    index: "given",
    range: "a case with the table [compliance]",
    covers: |inputs| inputs.given_compliance.is_some(),
    why_outside: |_| "the case has no table [compliance]".to_owned(),
    check: |_| None,
    outside: |_, _| None,
    chosen: "tooth-compliance-given",
    reads_root: false,
    has_contact: true,
    has_coupling: true,
    steps: STEPS,
    tooth: |_, _| Ok(Kind::Given),
};

impl ToothCompliance {
    /// The table of the case.
    pub const GIVEN: ToothCompliance = ToothCompliance::named(MODEL.name);
}

const STEPS: &[Step] = &[
    step("q_1", "driver at D, contact left out", "um mm/N", Words(FORMULA), |k| {
        Some(k.solution.compliance?.driver)
    }),
    step("q_2", "driven gear at D, contact left out", "um mm/N", Words(FORMULA), |k| {
        Some(k.solution.compliance?.driven)
    }),
    step("q_H", "contact of both flanks", "um mm/N", Words(FORMULA), |k| {
        Some(k.inputs.given_compliance?.contact.at(-1.0))
    }),
];

const FORMULA: &str =
    "from the table [compliance] of the case: q (1 + c1 t + c2 t² + ..), t = 2 s/g_a - 1";
