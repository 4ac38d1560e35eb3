//! Compliance of the teeth and of the contact between them, per unit width.

pub mod beam;
pub mod contact;
pub mod flanks;
pub mod kuang_yang;
pub mod profile;

use super::Refusal;
use super::geometry::{Circles, Geometry};
use super::inputs::{Gear, Inputs, ToothCompliance};
use super::tip_gap::TipContact;

/// Compliance of the two teeth at D, contact excluded, per unit width, in m²/N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TeethCompliance {
    /// The method that served.
    pub model: ToothCompliance,
    /// Driver's tooth q₁, loaded at O₁D.
    pub driver: f64,
    /// Driven tooth q₂, loaded at its tip.
    pub driven: f64,
}

impl TeethCompliance {
    /// q₁ + q₂, in m²/N.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.driver + self.driven
    }
}

/// Where two flanks touch: the load radii and the reduced curvature, in m.
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
    #[must_use]
    pub fn on_line_of_action(geometry: &Geometry, along: f64) -> ContactPlace {
        let rest = geometry.tangent_length - along;
        ContactPlace {
            radius_driver: geometry.driver.base.hypot(along),
            radius_driven: geometry.driven.base.hypot(rest),
            curvature_radius: along * rest / geometry.tangent_length,
        }
    }

    /// The driven tip on the driver's flank.
    #[must_use]
    pub fn at_tip(inputs: &Inputs, geometry: &Geometry, tip: &TipContact) -> ContactPlace {
        ContactPlace {
            radius_driver: tip.radius_driver,
            radius_driven: geometry.driven.tip,
            curvature_radius: super::position::reduced_curvature(
                inputs.driven.tip_radius,
                geometry,
                tip,
            ),
        }
    }
}

/// Compliance of the two teeth at a place, in m²/N.
///
/// # Errors
/// A [`Refusal`] outside the range of the fit.
pub fn teeth(
    inputs: &Inputs,
    geometry: &Geometry,
    place: &ContactPlace,
) -> Result<TeethCompliance, Refusal> {
    Ok(TeethCompliance {
        model: model_of(inputs),
        driver: tooth(
            inputs,
            &inputs.driver,
            &geometry.driver,
            place.radius_driver,
        )?,
        driven: tooth(
            inputs,
            &inputs.driven,
            &geometry.driven,
            place.radius_driven,
        )?,
    })
}

/// Compliance of one tooth loaded at a radius, in m²/N.
fn tooth(inputs: &Inputs, gear: &Gear, circles: &Circles, radius: f64) -> Result<f64, Refusal> {
    match model_of(inputs) {
        ToothCompliance::KuangYang => kuang_yang::tooth(inputs.module, gear, circles, radius),
        ToothCompliance::Beam => beam::tooth(inputs, gear, circles, radius),
    }
}

/// The tooth compliance that serves the pair: the case's own choice, else Kuang and Yang's inside
/// its range.
#[must_use]
pub fn model_of(inputs: &Inputs) -> ToothCompliance {
    let chosen = if kuang_yang::covers(inputs) {
        ToothCompliance::KuangYang
    } else {
        ToothCompliance::Beam
    };
    inputs.tooth_compliance.unwrap_or(chosen)
}

/// Compliance of a pair at a place under a given force, in m²/N.
///
/// # Errors
/// A [`Refusal`] outside the range of the fit.
pub fn pair_at_load(
    inputs: &Inputs,
    geometry: &Geometry,
    place: &ContactPlace,
    force: f64,
) -> Result<f64, Refusal> {
    let contact = contact::spring(inputs, geometry, place)?.compliance(force)?;
    Ok(teeth(inputs, geometry, place)?.sum() + contact)
}
