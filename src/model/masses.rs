//! Masses of the gears at their base circles.

use super::Refusal;
use super::geometry::{Circles, Geometry};
use super::inertia::{Body, Inertia};
use super::inputs::Inputs;
use super::tip_gap::TipContact;
use crate::numeric::Real;

/// Inputs of the masses, besides the geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassInputs {
    /// Bodies of driver and driven gear.
    pub bodies: [Body; 2],
}

impl MassInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> MassInputs {
        MassInputs { bodies: inputs.bodies() }
    }
}

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
    pub fn of<T: Real>(inputs: &MassInputs, geometry: &Geometry<T>) -> Result<Masses, Refusal> {
        let [driver, driven] = &inputs.bodies;
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
