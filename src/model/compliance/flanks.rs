//! Compliance of the teeth along the flanks that the path of contact uses, computed once and then
//! cheap.

use super::tooth::Tooth;
use super::{ContactPlace, ElasticGear, Elasticity, contact};
use crate::model::Refusal;
use crate::model::geometry::{Circles, Geometry};
use crate::numeric::chebyshev::Series;

/// What the last terms of a series may be, over the compliance at the tip: less than what those who
/// use it allow.
const REST: f64 = 3e-14;

/// Tooth compliances q₁ and q₂ over the distance of the load point from N₁ and N₂.
#[derive(Debug, Clone, PartialEq)]
pub struct Flanks {
    driver: Series<1>,
    driven: Series<1>,
}

impl Flanks {
    /// Both flanks, from the far end of the path of contact to the tip.
    ///
    /// # Errors
    /// Those of the teeth, see [`Teeth`](super::Teeth).
    pub fn new(elasticity: &Elasticity, geometry: &Geometry) -> Result<Flanks, Refusal> {
        let of = |gear: &ElasticGear, circles: &Circles, from: f64, to: f64| {
            let tooth = Tooth::of(elasticity.tooth, gear, circles)?;
            let at = |curvature: f64| tooth.at(circles.base.hypot(curvature)).map(|found| [found]);
            let rest = REST * at(to)?[0];
            Series::of(from, to, &|_, _| [rest], &at)
        };
        let (start, end) = (geometry.start, geometry.end);
        let lowest = geometry.tangent_length - end;
        Ok(Flanks {
            driver: of(&elasticity.driver, &geometry.driver, start, end)?,
            driven: of(
                &elasticity.driven,
                &geometry.driven,
                lowest,
                geometry.driven.tip_curvature,
            )?,
        })
    }

    /// How often the compliance of a tooth was computed.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.driver.evaluations() + self.driven.evaluations()
    }

    /// The same flanks with the gears swapped.
    #[must_use]
    pub fn swapped(&self) -> Flanks {
        Flanks {
            driver: self.driven.clone(),
            driven: self.driver.clone(),
        }
    }

    /// Compliance of a pair under a given force, in m²/N, where its load points lie `driver` from
    /// N₁ and `driven` from N₂.
    ///
    /// # Errors
    /// Those of the contact.
    pub fn pair_at_load(
        &self,
        elasticity: &Elasticity,
        geometry: &Geometry,
        place: &ContactPlace,
        (driver, driven): (f64, f64),
        force: f64,
    ) -> Result<f64, Refusal> {
        let contact = contact::spring(elasticity, geometry, place)?.compliance(force)?;
        Ok(self.driver.one(0, driver) + self.driven.one(0, driven) + contact)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::compliance::pair_at_load;
    use crate::model::geometry::geometry;
    use crate::model::inputs::{Inputs, ToothCompliance};
    use crate::model::sample::standard_pair;

    #[test]
    fn every_place_of_the_line_of_action_has_the_compliance_of_its_teeth() {
        for model in ToothCompliance::ALL {
            let inputs = Inputs {
                tooth_compliance: Some(model),
                ..standard_pair(20, 33, 4e-3)
            };
            let geometry = geometry::<f64>(&inputs.shape()).unwrap();
            let elasticity = inputs.elasticity();
            let flanks = Flanks::new(&elasticity, &geometry).unwrap();
            for step in 0..=40 {
                let along =
                    geometry.start + (geometry.end - geometry.start) * f64::from(step) / 40.0;
                let place = ContactPlace::on_line_of_action(&geometry, along);
                let arms = (along, geometry.tangent_length - along);
                let found = flanks
                    .pair_at_load(&elasticity, &geometry, &place, arms, 1000.0)
                    .unwrap();
                let expected = pair_at_load(&elasticity, &geometry, &place, 1000.0).unwrap();
                assert!(
                    (found / expected - 1.0).abs() < 1e-12,
                    "{model:?} at {step}: {found} {expected}"
                );
            }
        }
    }
}
