//! A given compliance: of another program or of a measurement.

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
