//! Compliance of the teeth along the flanks of the path of contact, as series that are cheap to
//! evaluate.

use super::contact::ContactLaw;
use super::tooth::Tooth;
use super::{ContactPlace, Elasticity, Teeth};
use crate::model::Refusal;
use crate::model::geometry::{Circles, Geometry};
use crate::numeric::chebyshev::Series;
use crate::numeric::{root, steps};

/// Tolerance of the last terms of a series, relative to the compliance at the tip. Smaller than the
/// tolerances of the callers.
const REST: f64 = 3e-14;

/// Tooth compliances q₁ and q₂ and the contact offsets of both gears as functions of the distance
/// of the load point from N₁ and N₂.
#[derive(Debug, Clone, PartialEq)]
pub struct Flanks {
    /// Those of driver and driven gear; `None` if the case gives the compliance.
    series: Option<[Flank; 2]>,
    /// Decrease of q_H per unit of ln a if the tooth model includes the contact.
    slope: Option<f64>,
}

const TOOTH: usize = 0;
const OFFSET: usize = 1;

/// One flank: tooth compliance and contact offset.
#[derive(Debug, Clone, PartialEq)]
struct Flank {
    series: Series<2>,
    /// Range of distances with a known compliance, in m.
    ends: (f64, f64),
    /// Square of the distance of the tip corner; infinite if the model has no corner.
    corner: f64,
    /// r_b, in m.
    base: f64,
}

impl Flank {
    fn of(tooth: &Tooth, circles: &Circles, (from, to): (f64, f64)) -> Result<Flank, Refusal> {
        let (base, radius) = (circles.base, tooth.last_radius(0.0));
        let last = circles.curvature_at(radius).min(to);
        let at = |curvature: f64| {
            let radius = base.hypot(curvature);
            let contact = tooth.contact(radius)?.map_or(0.0, |contact| contact.offset);
            Ok([tooth.at(radius)?, contact])
        };
        let rest = REST * at(to)?[TOOTH];
        let series = Series::of(from.min(last), last, &|_, _| [rest; 2], &at)?;
        let corner = if radius.is_finite() { circles.sharp().tip_curvature } else { f64::INFINITY };
        Ok(Flank { series, ends: (from.min(last), last), corner: corner * corner, base })
    }

    /// The values for a contact at this distance. The load moves off the corner of the tip if its
    /// pressure would extend beyond the corner.
    fn at(&self, curvature: f64, half_width: f64) -> [f64; 2] {
        let place = curvature.min(self.ends.1).min(self.at_corner(half_width));
        self.series.at(place)
    }

    /// Distance of the load whose pressure ends at the corner of the tip, in m.
    fn at_corner(&self, half_width: f64) -> f64 {
        let square = self.corner - 2.0 * self.base * half_width;
        square.max(0.0).sqrt().max(self.ends.0)
    }

    /// The limit that determines the place of a load: the contact, the corner of the tip, or the
    /// greatest distance with a known compliance; and the place by each limit.
    fn limit(&self, (curvature, half_width): (f64, f64)) -> (usize, [f64; 3]) {
        let places = [curvature, self.at_corner(half_width), self.ends.1];
        let least = places.iter().copied().fold(f64::INFINITY, f64::min);
        (places.iter().position(|place| *place <= least).unwrap_or(0), places)
    }

    /// Places between the ends at which another limit begins to determine the load.
    fn bends(&self, (from, to): (f64, f64), load: impl Fn(f64) -> (f64, f64)) -> Vec<f64> {
        if self.corner.is_infinite() || from >= to {
            return Vec::new();
        }
        let limit = |place: f64| self.limit(load(place)).0;
        let mut bends = Vec::new();
        let mut before = (from, limit(from));
        for place in steps(from, to, 8).skip(1) {
            let here = (place, limit(place));
            if before.1 != here.1 {
                let difference = |at: f64| {
                    let (_, places) = self.limit(load(at));
                    places[before.1] - places[here.1]
                };
                bends.push(root::between(before.0, here.0, difference));
            }
            before = here;
        }
        bends
    }
}

impl Flanks {
    /// Both flanks, from the far end of the path of contact to the tip.
    ///
    /// # Errors
    /// Those of the teeth, see [`Teeth`].
    pub fn new(teeth: &Teeth) -> Result<Flanks, Refusal> {
        let Teeth { geometry, driver, driven, elasticity } = teeth;
        if elasticity.given.is_some() {
            return Ok(Flanks { series: None, slope: None });
        }
        let contacts = [
            driver.contact(geometry.driver.tip)?,
            driven.contact(geometry.driven.tip).map_err(Refusal::at_driven)?,
        ];
        let lowest = geometry.tangent_length - geometry.end;
        let highest = |circles: &Circles| circles.sharp().tip_curvature;
        let ends =
            [(geometry.start, highest(&geometry.driver)), (lowest, highest(&geometry.driven))];
        Ok(Flanks {
            series: Some([
                Flank::of(driver, &geometry.driver, ends[0])?,
                Flank::of(driven, &geometry.driven, ends[1]).map_err(Refusal::at_driven)?,
            ]),
            slope: match contacts {
                [Some(driver), Some(driven)] => Some(driver.slope + driven.slope),
                _ => None,
            },
        })
    }

    /// Places between the ends at which a load begins or stops to move off the corner of a tip.
    /// `load` gives the distances of the load points from N₁ and N₂ and the half-width of the
    /// contact.
    pub fn bends(&self, ends: (f64, f64), load: impl Fn(f64) -> ((f64, f64), f64)) -> Vec<f64> {
        let Some([driver, driven]) = &self.series else {
            return Vec::new();
        };
        let mut bends = driver.bends(ends, |at| {
            let ((driver, _), half_width) = load(at);
            (driver, half_width)
        });
        bends.extend(driven.bends(ends, |at| {
            let ((_, driven), half_width) = load(at);
            (driven, half_width)
        }));
        bends
    }

    /// The flanks with the gears swapped.
    pub fn swapped(&self) -> Flanks {
        let swapped = |[driver, driven]: [Flank; 2]| [driven, driver];
        Flanks { series: self.series.clone().map(swapped), slope: self.slope }
    }

    /// Compliances of a pair under a given force, in m²/N: of driver and of driven gear without the
    /// contact, and of the contact. The load points are at the distances `arms` from N₁ and N₂.
    ///
    /// # Errors
    /// Those of the contact.
    pub fn at_load(
        &self,
        elasticity: &Elasticity,
        geometry: &Geometry,
        place: &ContactPlace,
        arms: (f64, f64),
        force: f64,
    ) -> Result<[f64; 3], Refusal> {
        if let Some(table) = elasticity.given {
            let part = geometry.part_of_path(arms);
            let [driver, driven] = table.teeth(part);
            return Ok([driver, driven, table.contact.at(part)]);
        }
        let half_width = elasticity.half_width(place, force);
        let [driver, driven] = [(0, arms.0), (1, arms.1)].map(|(gear, curvature)| {
            self.series.as_ref().map_or([0.0; 2], |both| both[gear].at(curvature, half_width))
        });
        let spring = match self.slope {
            Some(slope) => {
                let offset = driver[OFFSET] + driven[OFFSET];
                let teeth = driver[TOOTH] + driven[TOOTH];
                elasticity.spring(place, teeth, ContactLaw { offset, slope })
            }
            None => elasticity.contact_spring(geometry, place)?,
        };
        Ok([driver[TOOTH], driven[TOOTH], spring.compliance(force)?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::inputs::{Inputs, ToothCompliance};
    use crate::model::sample::standard_pair;

    #[test]
    fn the_series_agree_with_the_teeth_on_the_line_of_action() {
        for model in ToothCompliance::ALL {
            let inputs = Inputs { tooth_compliance: Some(model), ..standard_pair(20, 33, 4e-3) };
            let geometry = geometry::<f64>(&inputs.shape()).unwrap();
            let elasticity = inputs.elasticity();
            let teeth = Teeth::of(&elasticity, &geometry).unwrap();
            let flanks = Flanks::new(&teeth).unwrap();
            for step in 0..=40 {
                let along =
                    geometry.start + (geometry.end - geometry.start) * f64::from(step) / 40.0;
                let place = ContactPlace::on_line_of_action(&geometry, along);
                let arms = (along, geometry.tangent_length - along);
                for force in [1e2, 1e3, 3e4] {
                    let found = flanks.at_load(&elasticity, &geometry, &place, arms, force);
                    let found: f64 = found.unwrap().iter().sum();
                    let expected = teeth.pair_at_load(&place, force).unwrap();
                    assert!(
                        (found / expected - 1.0).abs() < 1e-12,
                        "{model:?} at {step} under {force} N: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_pressure_of_a_load_at_the_tip_ends_at_its_corner() {
        let inputs = standard_pair(20, 33, 4e-3);
        let geometry = geometry::<f64>(&inputs.shape()).unwrap();
        let elasticity = inputs.elasticity();
        let teeth = Teeth::of(&elasticity, &geometry).unwrap();
        let at_tip = ContactPlace::on_line_of_action(&geometry, geometry.end);
        let arc = |place: &ContactPlace| {
            let (tip, radius) = (geometry.driver.tip, place.radius_driver);
            (tip - radius) * (tip + radius) / (2.0 * geometry.driver.base)
        };
        for force in [5e3, 2e4, 8e4] {
            let half_width = elasticity.half_width(&at_tip, force);
            let moved = teeth.under(&at_tip, force);
            let off = arc(&moved) / half_width - 1.0;
            assert!(off.abs() < 1e-9, "error under {force} N: {off:e}");
            assert_eq!(moved.radius_driven.to_bits(), at_tip.radius_driven.to_bits());
        }
        let light = [1.0, 100.0].map(|force| arc(&teeth.under(&at_tip, force)) / inputs.module);
        assert!(light.iter().all(|arc| (arc - 0.02).abs() < 1e-3), "{light:?}");
    }
}
