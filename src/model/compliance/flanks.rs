//! Compliance of the teeth along the flanks that the path of contact uses, computed once and then
//! cheap.

use super::contact::{ContactLaw, HalfWidth, PairContact};
use super::tooth::Tooth;
use super::{ContactPlace, Elasticity};
use crate::model::Refusal;
use crate::model::geometry::{Circles, Geometry};
use crate::numeric::chebyshev::Series;

/// What the last terms of a series may be, over the compliance at the tip: less than what those who
/// use it allow.
const REST: f64 = 3e-14;

/// Tooth compliances q₁ and q₂ and the contact's parts of both gears over the distance of the load
/// point from N₁ and N₂.
#[derive(Debug, Clone, PartialEq)]
pub struct Flanks {
    driver: Flank,
    driven: Flank,
    /// What q_H loses for each unit of ln a, if the model of the teeth includes the contact.
    slope: Option<f64>,
}

const TOOTH: usize = 0;
const OFFSET: usize = 1;

/// One flank: its tooth compliance, and the offset of its contact.
#[derive(Debug, Clone, PartialEq)]
struct Flank {
    series: Series<2>,
    /// Distance from which the compliance is the same up to the tip, in m.
    last: f64,
}

impl Flank {
    fn of(tooth: &Tooth, circles: &Circles, (from, to): (f64, f64)) -> Result<Flank, Refusal> {
        let (base, radius) = (circles.base, tooth.last_radius());
        let last = ((radius - base) * (radius + base)).sqrt().min(to);
        let at = |curvature: f64| {
            let radius = base.hypot(curvature);
            let contact = tooth.contact(radius)?.map_or(0.0, |contact| contact.offset);
            Ok([tooth.at(radius)?, contact])
        };
        let rest = REST * at(to)?[TOOTH];
        let series = Series::of(from.min(last), last, &|_, _| [rest; 2], &at)?;
        Ok(Flank { series, last })
    }

    fn at(&self, curvature: f64) -> [f64; 2] {
        self.series.at(curvature.min(self.last))
    }
}

impl Flanks {
    /// Both flanks, from the far end of the path of contact to the tip.
    ///
    /// # Errors
    /// Those of the teeth, see [`Teeth`](super::Teeth).
    pub fn new(elasticity: &Elasticity, geometry: &Geometry) -> Result<Flanks, Refusal> {
        let tooth = |gear, circles| Tooth::of(elasticity.tooth, gear, circles);
        let (driver, driven) = (
            tooth(&elasticity.driver, &geometry.driver)?,
            tooth(&elasticity.driven, &geometry.driven).map_err(Refusal::at_driven)?,
        );
        let contacts = [
            driver.contact(geometry.driver.tip)?,
            driven
                .contact(geometry.driven.tip)
                .map_err(Refusal::at_driven)?,
        ];
        let lowest = geometry.tangent_length - geometry.end;
        let highest = |circles: &Circles| circles.sharp().tip_curvature;
        let ends = [
            (geometry.start, highest(&geometry.driver)),
            (lowest, highest(&geometry.driven)),
        ];
        Ok(Flanks {
            driver: Flank::of(&driver, &geometry.driver, ends[0])?,
            driven: Flank::of(&driven, &geometry.driven, ends[1]).map_err(Refusal::at_driven)?,
            slope: match contacts {
                [Some(driver), Some(driven)] => Some(driver.slope + driven.slope),
                _ => None,
            },
        })
    }

    /// How often the compliance of a tooth was computed.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.driver.series.evaluations() + self.driven.series.evaluations()
    }

    /// Distances from N₁ and N₂ at which the compliances bend: from there to the tip they are the
    /// same.
    #[must_use]
    pub fn bends(&self) -> [f64; 2] {
        [self.driver.last, self.driven.last]
    }

    /// The same flanks with the gears swapped.
    #[must_use]
    pub fn swapped(&self) -> Flanks {
        Flanks {
            driver: self.driven.clone(),
            driven: self.driver.clone(),
            slope: self.slope,
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
        let (driver, driven) = (self.driver.at(driver), self.driven.at(driven));
        let teeth = driver[TOOTH] + driven[TOOTH];
        let spring = match self.slope {
            Some(slope) => {
                let offset = driver[OFFSET] + driven[OFFSET];
                HalfWidth::of(elasticity).spring(place, teeth, ContactLaw { offset, slope })
            }
            None => PairContact::of(elasticity).spring(elasticity, geometry, place)?,
        };
        Ok(teeth + spring.compliance(force)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::compliance::Teeth;
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
            let teeth = Teeth::of(&elasticity, &geometry).unwrap();
            for step in 0..=40 {
                let along =
                    geometry.start + (geometry.end - geometry.start) * f64::from(step) / 40.0;
                let place = ContactPlace::on_line_of_action(&geometry, along);
                let arms = (along, geometry.tangent_length - along);
                let found = flanks
                    .pair_at_load(&elasticity, &geometry, &place, arms, 1000.0)
                    .unwrap();
                let expected = teeth.pair_at_load(&place, 1000.0).unwrap();
                assert!(
                    (found / expected - 1.0).abs() < 1e-12,
                    "{model:?} at {step}: {found} {expected}"
                );
            }
        }
    }
}
