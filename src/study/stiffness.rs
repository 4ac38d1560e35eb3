//! Tooth compliance over the flank of each gear, by every model and by finite elements.

use crate::model::compliance::tooth::Tooth;
use crate::model::compliance::{ContactPlace, ElasticGear, Elasticity, Teeth};
use crate::model::field::{Field, body_twist};
use crate::model::geometry::{Circles, Geometry, geometry, mesh_force};
use crate::model::inputs::{Gear, ToothCompliance};
use crate::model::masses::Masses;
use crate::model::profile::Profile;
use crate::model::{Inputs, Refusal};

/// The name of the finite elements among the models; a model of the list with this name has no column
/// of its own.
pub const FIELD: &str = "finite-element";

/// Places of the path of contact at which a chart draws the stiffness.
pub const PATH_POINTS: usize = 129;

/// Least number of points on a flank.
pub const LEAST_POINTS: usize = 2;
/// Greatest number of points on a flank.
pub const MOST_POINTS: usize = 10_000;

/// Radii at which a chart draws the compliance of a tooth.
pub const FLANK_POINTS: usize = 65;

/// The compliances of both gears over their flanks.
#[derive(Debug, Clone, PartialEq)]
pub struct Flanks {
    /// Hertz half-width of the contact at the pitch point under the mesh force, in m.
    pub contact_half_width: f64,
    /// The models in the order of [`Point::models`].
    pub models: Vec<ToothCompliance>,
    /// Driver and driven gear.
    pub gears: [GearComparison; 2],
}

/// The compliances of one gear.
#[derive(Debug, Clone, PartialEq)]
pub struct GearComparison {
    /// `driver` or `driven`.
    pub gear: &'static str,
    /// Number of teeth z.
    pub teeth: u32,
    /// Number of teeth of the virtual spur gear whose compliances these are; `None` for a spur gear.
    pub virtual_teeth: Option<f64>,
    /// Radius of the form circle, in m; of a helical gear, at the height of that of its virtual gear.
    pub form_radius: f64,
    /// Active tip radius, in m.
    pub tip_radius: f64,
    /// Radius of the working pitch circle, in m.
    pub pitch_radius: f64,
    /// Displacement of every tooth by the twist of the body about its bore, in m²/N; `None` for a
    /// gear without a bore or without a field.
    pub twist: Option<f64>,
    /// Why the gear has no field, if it has none.
    pub refusal: Option<Refusal>,
    /// Models without a value at one point or more.
    pub gaps: Vec<Gap>,
    /// From the form circle to the tip; empty if no involute is left between them.
    pub points: Vec<Point>,
}

impl GearComparison {
    /// Why the gear has no finite-element values at some radii, in a sentence; `None` if it has them
    /// at all radii.
    pub fn no_field(&self) -> Option<String> {
        Some(format!("no finite-element values: {}", self.field_refusal()?))
    }

    /// The reason alone.
    pub fn field_refusal(&self) -> Option<String> {
        match self.refusal {
            Some(Refusal::NoField { reason, .. }) => Some(reason.to_string()),
            Some(other) => Some(other.to_string()),
            None => self
                .points
                .iter()
                .any(|point| point.field.is_none())
                .then(|| "the contact under the mesh force is wider than the tooth".to_owned()),
        }
    }
}

/// A model without a value at one point of a flank or more.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    /// The model.
    pub model: ToothCompliance,
    /// The validity range that does not cover the gear, or the first refusal.
    pub reason: String,
}

/// The compliances of a tooth loaded at one radius, per unit width, in m²/N.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// Radius of the load, in m.
    pub radius: f64,
    /// Compliance of the tooth without contact by each model; `None` if the model does not cover
    /// the gear.
    pub models: Vec<Option<f64>>,
    /// Compliances of the finite elements.
    pub field: Option<FieldPoint>,
}

/// Compliances from the field of a gear, without the twist of its body, in m²/N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldPoint {
    /// Tooth and body without contact.
    pub depth: f64,
    /// Tooth and body with the contact.
    pub surface: f64,
    /// Displacement of the next tooth on the side that the force pushes to, at the same radius.
    pub ahead: f64,
    /// Displacement of the tooth on the other side, at the same radius.
    pub behind: f64,
}

/// Compares the models over both flanks, at `points` radii from the form circle to the tip. A helical
/// gear has the compliances of its [virtual spur gear](ElasticGear::of) at the same height.
///
/// # Errors
/// The refusals of the geometry, and [`Refusal::BoreTooLarge`].
pub fn compare_flanks(inputs: &Inputs, points: usize) -> Result<Flanks, Refusal> {
    let (geometry, mesh_force) = loaded(inputs)?;
    let elasticity = inputs.elasticity();
    let pitch_point = geometry.start + geometry.approach_length;
    let place = ContactPlace::on_line_of_action(&geometry, pitch_point);
    let half_width = elasticity.half_width(&place, mesh_force);
    let models: Vec<_> =
        ToothCompliance::ALL.into_iter().filter(|model| model.name() != FIELD).collect();
    let flank = |name, gear: &Gear, elastic: &ElasticGear, circles: &Circles, pitch_radius| {
        let normal = elastic.circles(circles)?;
        let form_radius = Profile::of(&elastic.rack, &normal).form_radius() - elastic.rise;
        // In equal steps from the form circle to the tip.
        let (form, tip, last) = (form_radius, circles.tip, points.max(LEAST_POINTS) - 1);
        let inner = (0..last).map(|step| form + (tip - form) * step as f64 / last as f64);
        let radii: Vec<f64> = if form < tip { inner.chain([tip]).collect() } else { Vec::new() };
        let (mut columns, mut gaps) = (Vec::new(), Vec::new());
        // The validity range is a property of each gear: that of a pair of two such gears.
        let pair = Inputs { driver: *gear, driven: *gear, ..inputs.clone() };
        for &model in &models {
            let tooth = if (model.model().covers)(&pair) {
                Tooth::of(model, elastic, circles).map_err(|refusal| refusal.to_string())
            } else {
                Err(format!("covers {} only", model.model().range))
            };
            let mut reason = tooth.as_ref().err().cloned();
            // The form circle itself belongs to the fillet.
            let least = form + STEP * (tip - form);
            let value = |&radius: &f64| match tooth.as_ref().ok()?.at(radius.max(least)) {
                Ok(value) => Some(value),
                Err(refusal) => {
                    reason = reason.take().or(Some(refusal.to_string()));
                    None
                }
            };
            columns.push(radii.iter().map(value).collect::<Vec<_>>());
            gaps.extend(reason.map(|reason| Gap { model, reason }));
        }
        let field = elastic.field();
        let known = field.as_ref().ok();
        let points = radii.iter().enumerate().map(|(index, &radius)| Point {
            radius,
            models: columns.iter().map(|column| column[index]).collect(),
            field: known.and_then(|field| field_point(field, elastic, radius, half_width)),
        });
        let bore = Some(gear.bore_radius).filter(|bore| *bore > 0.0 && known.is_some());
        let twist = |bore| body_twist(circles.base, circles.root, bore, gear.poisson) / gear.young;
        Ok(GearComparison {
            gear: name,
            teeth: gear.teeth,
            virtual_teeth: (inputs.helix_angle > 0.0).then_some(elastic.rack.teeth),
            form_radius,
            tip_radius: tip,
            pitch_radius,
            twist: bore.map(twist),
            refusal: field.as_ref().err().copied(),
            gaps,
            points: points.collect(),
        })
    };
    let (Elasticity { driver, driven, .. }, of) = (&elasticity, &geometry);
    let gears = [
        flank("driver", &inputs.driver, driver, &of.driver, place.radius_driver)?,
        flank("driven", &inputs.driven, driven, &of.driven, place.radius_driven)?,
    ];
    Ok(Flanks { contact_half_width: half_width, models, gears })
}

/// Geometry and mesh force of the pair, in N.
fn loaded(inputs: &Inputs) -> Result<(Geometry, f64), Refusal> {
    let geometry = geometry::<f64>(&inputs.shape())?;
    // Refuses a bore that leaves no gear body.
    Masses::of(inputs, &geometry)?;
    let mesh_force = mesh_force(inputs.torque(), &geometry);
    Ok((geometry, mesh_force))
}

/// The distance from the form circle at which a model has a value, relative to the flank.
const STEP: f64 = 1e-9;

/// The compliances of a gear at a radius. `None` if the contact under the mesh force is wider than the
/// tooth.
fn field_point(
    field: &Field,
    gear: &ElasticGear,
    radius: f64,
    half_width: f64,
) -> Option<FieldPoint> {
    let (radius, per_young) = (radius + gear.rise, gear.oblique / gear.young);
    let outer = radius.min(field.last_radius(half_width));
    (half_width < field.centre_depth(radius)).then(|| FieldPoint {
        depth: field.depth(radius, half_width) * per_young,
        surface: field.surface(outer, half_width) * per_young,
        ahead: field.cross(radius, radius, 1) * per_young,
        behind: field.cross(radius, radius, -1) * per_young,
    })
}

/// Stiffness over the path of contact.
#[derive(Debug, Clone, PartialEq)]
pub struct PathComparison {
    /// Base radius of the driver, in m: distance from E over this radius is the driver's roll angle
    /// after E.
    pub base_radius: f64,
    /// Common face width, in m.
    pub width: f64,
    /// The models in the order of [`PathPoint`].
    pub models: Vec<ToothCompliance>,
    /// From E to B.
    pub points: Vec<PathPoint>,
}

/// Stiffness at one place of the incoming pair, per unit width, in N/m².
#[derive(Debug, Clone, PartialEq)]
pub struct PathPoint {
    /// Distance of the contact from E along the line of action, in m.
    pub way: f64,
    /// Stiffness of the pair alone, contact included, by each model that covers the gears.
    pub pair: Vec<Option<f64>>,
    /// Stiffness of all pairs on the line of action, with the coupling of neighbouring teeth.
    pub mesh: Vec<Option<f64>>,
}

/// Compares the models at `points` places of the path of contact.
///
/// # Errors
/// As [`compare_flanks`].
pub fn compare_path(inputs: &Inputs, points: usize) -> Result<PathComparison, Refusal> {
    let (geometry, mesh_force) = loaded(inputs)?;
    let models = ToothCompliance::ALL.to_vec();
    let teeth: Vec<_> = models
        .iter()
        .map(|&tooth| {
            let inputs = Inputs { tooth_compliance: Some(tooth), ..inputs.clone() };
            let covers = (tooth.model().covers)(&inputs);
            covers.then(|| Teeth::of(&inputs.elasticity(), &geometry).ok()).flatten()
        })
        .collect();
    let length = geometry.end - geometry.start;
    let last = points.max(LEAST_POINTS) - 1;
    let at = |step: usize| {
        // The last place is B itself, so that rounding does not lose the pair.
        let way = if step == last { length } else { length * step as f64 / last as f64 };
        PathPoint {
            way,
            pair: teeth.iter().map(|teeth| pair(teeth.as_ref()?, way, mesh_force)).collect(),
            mesh: teeth.iter().map(|teeth| whole(teeth.as_ref()?, way, mesh_force)).collect(),
        }
    };
    Ok(PathComparison {
        base_radius: geometry.driver.base,
        width: inputs.common_width(),
        models,
        points: (0..=last).map(at).collect(),
    })
}

impl PathComparison {
    /// A model's stiffness of the whole mesh over the driver's roll angle after E, in rad and N/m;
    /// empty if the model does not cover the gears.
    pub fn mesh_curve(&self, model: usize) -> impl Iterator<Item = (f64, f64)> {
        let points = self.points.iter();
        points.filter_map(move |point| {
            Some((point.way / self.base_radius, point.mesh[model]? * self.width))
        })
    }
}

/// Stiffness of a pair alone per unit width, with the contact under a force.
fn pair(teeth: &Teeth, way: f64, force: f64) -> Option<f64> {
    Some(1.0 / teeth.pair_at_load(&place(teeth, way), force).ok()?)
}

fn place(teeth: &Teeth, way: f64) -> ContactPlace {
    let geometry = teeth.geometry();
    ContactPlace::on_line_of_action(geometry, geometry.start + way)
}

/// Stiffness of all pairs on the line of action per unit width.
fn whole(teeth: &Teeth, way: f64, force: f64) -> Option<f64> {
    let Geometry { base_pitch, start, end, .. } = *teeth.geometry();
    let first = (-way / base_pitch).ceil() as i32;
    let last = ((end - start - way) / base_pitch).floor() as i32;
    let place = |ahead: i32| place(teeth, way + f64::from(ahead) * base_pitch);
    let places: Vec<_> = (first..=last).map(|ahead| teeth.under(&place(ahead), force)).collect();
    Some(teeth.pair_set(first, &places, force).ok()?.forces(1.0).iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::sample::standard_pair;

    #[test]
    fn a_model_covers_each_gear_of_a_pair_on_its_own() {
        let mut inputs = standard_pair(20, 110, 5e-3);
        inputs.driver.bore_radius = 20e-3;
        inputs.driven.bore_radius = 60e-3;
        let found = compare_flanks(&inputs, 3).unwrap();
        let kuang_yang = |gear: &GearComparison| {
            let values = gear.points.iter().map(|point| point.models[0]);
            values.flatten().count()
        };
        assert_eq!(found.gears.each_ref().map(kuang_yang), [3, 0]);
        assert!(found.gears[0].gaps.is_empty());
        let [gap] = &found.gears[1].gaps[..] else {
            panic!("{:?}", found.gears[1].gaps);
        };
        assert_eq!(gap.model.name(), found.models[0].name());
    }

    #[test]
    fn compliance_falls_with_youngs_modulus_and_not_with_the_module() {
        let mut inputs = standard_pair(20, 30, 5e-3);
        inputs.driver.bore_radius = 20e-3;
        inputs.driven.bore_radius = 20e-3;
        let before = compare_flanks(&inputs, 5).unwrap();
        inputs.module *= 2.0;
        for gear in [&mut inputs.driver, &mut inputs.driven] {
            gear.young /= 3.0;
            gear.bore_radius *= 2.0;
        }
        let after = compare_flanks(&inputs, 5).unwrap();
        for (before, after) in before.gears.iter().zip(&after.gears) {
            assert_eq!(before.points.len(), 5);
            for (before, after) in before.points.iter().zip(&after.points) {
                let (before, after) = (before.field.unwrap(), after.field.unwrap());
                let ratio = after.ahead / before.ahead;
                assert!((ratio / 3.0 - 1.0).abs() < 1e-9, "{ratio}");
            }
            let twist = after.twist.unwrap() / before.twist.unwrap();
            assert!((twist / 3.0 - 1.0).abs() < 1e-9, "{twist}");
        }
    }

    /// The sum of both teeth and of both contacts is the compliance of the pair at the pitch point.
    #[test]
    fn the_flanks_of_a_helical_pair_have_the_compliances_of_its_path() {
        let angle = 20_f64.to_radians();
        let inputs = Inputs { helix_angle: angle, ..standard_pair(20, 35, 3e-3) };
        let found = compare_flanks(&inputs, 401).unwrap();
        for gear in &found.gears {
            assert!(gear.gaps.iter().all(|gap| gap.reason.starts_with("covers")), "{gear:?}");
            let depth = |point: &Point| point.field.unwrap().depth;
            // The load next to the tip acts at a distance from the corner.
            assert!(depth(&gear.points[400]) > 2.0 * depth(&gear.points[0]));
            for pair in gear.points[20..380].windows(2) {
                assert!(depth(&pair[1]) > depth(&pair[0]), "{pair:?}");
            }
        }
        let at_pitch = found.gears.each_ref().map(|gear| {
            let nearest = |point: &&Point| (1e9 * (point.radius - gear.pitch_radius).abs()) as u64;
            gear.points.iter().min_by_key(nearest).unwrap().field.unwrap().surface
        });
        let (geometry, force) = loaded(&inputs).unwrap();
        let teeth = Teeth::of(&inputs.elasticity(), &geometry).unwrap();
        let pair = 1.0 / pair(&teeth, geometry.approach_length, force).unwrap();
        let sum = at_pitch[0] + at_pitch[1];
        assert!((sum / pair - 1.0).abs() < 5e-3, "{sum} {pair}");
    }

    #[test]
    fn the_pair_at_the_end_of_the_path_carries_for_any_number_of_points() {
        let inputs = standard_pair(17, 19, 5e-3);
        let last = |points| compare_path(&inputs, points).unwrap().points.last().unwrap().clone();
        let expected = last(9);
        for points in 10..=60 {
            assert_eq!(last(points), expected, "{points} points");
        }
    }

    #[test]
    fn a_mesh_is_stiffer_than_a_pair_and_neighbours_make_it_softer_than_the_sum() {
        let inputs = standard_pair(22, 34, 5e-3);
        let (geometry, force) = loaded(&inputs).unwrap();
        let found = compare_path(&inputs, 9).unwrap();
        let of = |model: ToothCompliance| found.models.iter().position(|&own| own == model);
        let [beam, field] = [ToothCompliance::BEAM, ToothCompliance::FINITE_ELEMENT]
            .map(|model| of(model).unwrap());
        // At E a second pair is one base pitch ahead.
        let (first, length) = (&found.points[0], geometry.end - geometry.start);
        assert!(length > geometry.base_pitch);
        let second = |tooth: ToothCompliance| {
            let inputs = Inputs { tooth_compliance: Some(tooth), ..inputs.clone() };
            pair(&Teeth::of(&inputs.elasticity(), &geometry).unwrap(), geometry.base_pitch, force)
        };
        for (model, is_coupled) in [(beam, false), (field, true)] {
            let (mesh, pair) = (first.mesh[model].unwrap(), first.pair[model].unwrap());
            let sum = pair + second(found.models[model]).unwrap();
            assert!(mesh > pair, "{mesh} {pair}");
            assert_eq!(mesh < 0.99 * sum, is_coupled, "{mesh} {sum}");
        }
    }
}
