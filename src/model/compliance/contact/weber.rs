//! Contact compliance from the depth to the centre line of each tooth, Weber & Banaschek 1953.

use std::f64::consts::PI;

use super::{ContactLaw, ContactModel, Law, at_impact, give, place_at_d};
use crate::model::Refusal;
use crate::model::compliance::{ContactPlace, ElasticGear, Elasticity};
use crate::model::explanation::Formula::{Text, Words};
use crate::model::explanation::Step;
use crate::model::geometry::Geometry;
use crate::model::inputs::ContactCompliance;
use crate::model::profile::{Profile, Rack};

#[rustfmt::skip]
pub(super) const MODEL: ContactModel = ContactModel {
    name: "weber",
    index: "weber",
    help: "Weber & Banaschek 1953, from the thickness of the teeth",
    reads_half_width: true,
    reads_root: true,
    steps: &[
        Step {
            symbol: "q_H",
            meaning: "contact at the impact force, Weber & Banaschek 1953",
            unit: "um mm/N",
            formula: Text("(1 - ν1²)/(π E1) (2 ln(2 h_1/a_H) - ν1/(1 - ν1)) + (1 - ν2²)/(π E2) (2 \
                ln(2 h_2/a_H) - ν2/(1 - ν2))"),
            value: at_impact,
        },
        Step {
            symbol: "h_1",
            meaning: "from the driver's flank at O1D to the centre line of its tooth, along the \
                force",
            unit: "mm",
            formula: Words("from the tooth profile"),
            value: |k| {
                let profile = Profile::of(&Rack::of(k.inputs, &k.inputs.driver), &k.solution.geometry.driver);
                Some(profile.depth_along_force(place_at_d(k)?.radius_driver))
            },
        },
        Step {
            symbol: "h_2",
            meaning: "from the driven tip to the centre line of its tooth, along the force",
            unit: "mm",
            formula: Words("from the tooth profile"),
            value: |k| {
                let profile = Profile::of(&Rack::of(k.inputs, &k.inputs.driven), &k.solution.geometry.driven);
                Some(profile.depth_along_force(place_at_d(k)?.radius_driven))
            },
        },
    ],
    law: Law::AtPlace(weber),
};

impl ContactCompliance {
    /// Weber & Banaschek 1953, from the depth to the tooth's centre line.
    pub const WEBER: ContactCompliance = ContactCompliance::named(MODEL.name);
}

/// Offset and slope of Weber's contact term.
///
/// # Formula
/// ```text
/// qH = Σ (1 − ν_i²)/(π E_i) (2 ln(2 h_i/a) − ν_i/(1 − ν_i))
/// ```
/// h_i is the depth from the contact to the centre line of the tooth along the line of force.
///
/// # Source
/// Weber & Banaschek 1953, "Formänderung und Profilrücknahme bei gerad- und schrägverzahnten
/// Rädern".
///
/// # Valid for
/// A half-width small against the depth h.
///
/// # Errors
/// [`Refusal::PointedTip`] if the tooth has no thickness at the load point.
fn weber(
    elasticity: &Elasticity,
    geometry: &Geometry,
    place: &ContactPlace,
) -> Result<ContactLaw, Refusal> {
    let of = |gear: &ElasticGear, depth: f64| {
        let scale = give(gear) / PI;
        ContactLaw {
            offset: scale * (2.0 * (2.0 * depth).ln() - gear.poisson / (1.0 - gear.poisson)),
            slope: 2.0 * scale,
        }
    };
    let driver =
        depth(&Profile::of_flank(&elasticity.driver.rack, &geometry.driver), place.radius_driver)?;
    let driven =
        depth(&Profile::of_flank(&elasticity.driven.rack, &geometry.driven), place.radius_driven)
            .map_err(Refusal::at_driven)?;
    Ok(of(&elasticity.driver, driver) + of(&elasticity.driven, driven))
}

/// Depth from the flank to the centre line of the tooth at a radius.
fn depth(profile: &Profile, radius: f64) -> Result<f64, Refusal> {
    let depth = profile.depth_along_force(radius);
    if depth > 0.0 {
        Ok(depth)
    } else {
        Err(Refusal::PointedTip { field: "driver.addendum", thickness: 2.0 * depth })
    }
}
