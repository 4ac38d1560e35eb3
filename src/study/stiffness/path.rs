//! Stiffness of one pair and of the mesh over the path of contact, by every model.

use nalgebra::{DMatrix, DVector};

use crate::model::compliance::tooth::Tooth;
use crate::model::compliance::{ContactPlace, Elasticity, Teeth};
use crate::model::geometry::Geometry;
use crate::model::inputs::ToothCompliance;
use crate::model::{Inputs, Refusal};

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

/// Compares the models at `points` places from E to B, with the contact under the mesh force.
pub(super) fn compare(
    inputs: &Inputs,
    geometry: &Geometry,
    mesh_force: f64,
    points: usize,
) -> PathComparison {
    let models = ToothCompliance::ALL.to_vec();
    let elasticities: Vec<_> = models
        .iter()
        .map(|&tooth| {
            let inputs = Inputs { tooth_compliance: Some(tooth), ..inputs.clone() };
            (tooth.model().covers)(&inputs).then(|| inputs.elasticity())
        })
        .collect();
    let meshes: Vec<_> = elasticities
        .iter()
        .map(|elasticity| Mesh::of(elasticity.as_ref()?, geometry, mesh_force).ok())
        .collect();
    let length = geometry.end - geometry.start;
    let last = points.max(super::LEAST_POINTS) - 1;
    let at = |step: usize| {
        // The last place is B itself, so that rounding does not lose the pair.
        let way = if step == last { length } else { length * step as f64 / last as f64 };
        PathPoint {
            way,
            pair: meshes.iter().map(|mesh| mesh.as_ref()?.pair(way)).collect(),
            mesh: meshes.iter().map(|mesh| mesh.as_ref()?.whole(way)).collect(),
        }
    };
    PathComparison {
        base_radius: geometry.driver.base,
        width: inputs.common_width(),
        models,
        points: (0..=last).map(at).collect(),
    }
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

/// The pairs of a mesh by one model.
struct Mesh<'a> {
    teeth: Teeth,
    gears: [Tooth; 2],
    geometry: &'a Geometry,
    force: f64,
}

impl<'a> Mesh<'a> {
    fn of(
        elasticity: &'a Elasticity,
        geometry: &'a Geometry,
        force: f64,
    ) -> Result<Mesh<'a>, Refusal> {
        let gears = [
            Tooth::of(elasticity.tooth, &elasticity.driver, &geometry.driver)?,
            Tooth::of(elasticity.tooth, &elasticity.driven, &geometry.driven)?,
        ];
        Ok(Mesh { teeth: Teeth::of(elasticity, geometry)?, gears, geometry, force })
    }

    fn place(&self, way: f64) -> ContactPlace {
        let place = ContactPlace::on_line_of_action(self.geometry, self.geometry.start + way);
        self.teeth.under(&place, self.force)
    }

    fn pair(&self, way: f64) -> Option<f64> {
        let compliance = self.teeth.pair_at_load(&self.place(way), self.force);
        Some(1.0 / compliance.ok()?)
    }

    /// 1ᵀ Q⁻¹ 1, where Q is the compliance matrix of all pairs on the line of action.
    fn whole(&self, way: f64) -> Option<f64> {
        let (pitch, length) = (self.geometry.base_pitch, self.geometry.end - self.geometry.start);
        let first = (-way / pitch).ceil() as i32;
        let last = ((length - way) / pitch).floor() as i32;
        let pairs: Vec<(i32, ContactPlace)> = (first..=last)
            .map(|ahead| (ahead, self.place(way + f64::from(ahead) * pitch)))
            .collect();
        let mut matrix = DMatrix::zeros(pairs.len(), pairs.len());
        for (row, measured) in pairs.iter().enumerate() {
            for (column, loaded) in pairs.iter().enumerate() {
                matrix[(row, column)] = self.compliance(loaded, measured)?;
            }
        }
        let ones = DVector::from_element(pairs.len(), 1.0);
        Some(matrix.lu().solve(&ones)?.sum())
    }

    /// The force deflects the teeth of the driver towards later pairs and those of the driven gear
    /// towards earlier pairs.
    fn compliance(
        &self,
        (of, loaded): &(i32, ContactPlace),
        (at, measured): &(i32, ContactPlace),
    ) -> Option<f64> {
        if of == at {
            return self.teeth.pair_at_load(loaded, self.force).ok();
        }
        let [driver, driven] = &self.gears;
        let on_driver = driver.neighbour(loaded.radius_driver, measured.radius_driver, of - at);
        let on_driven = driven.neighbour(loaded.radius_driven, measured.radius_driven, at - of);
        Some(on_driver.ok()? + on_driven.ok()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    #[test]
    fn the_pair_at_the_end_of_the_path_carries_for_any_number_of_points() {
        let inputs = standard_pair(17, 19, 5e-3);
        let geometry = geometry::<f64>(&inputs.shape()).unwrap();
        let last = |points| {
            let found = compare(&inputs, &geometry, 2e3, points);
            found.points.last().unwrap().clone()
        };
        let expected = last(9);
        for points in 10..=60 {
            assert_eq!(last(points), expected, "{points} points");
        }
    }

    #[test]
    fn a_mesh_is_stiffer_than_a_pair_and_neighbours_make_it_softer_than_the_sum() {
        let inputs = standard_pair(22, 34, 5e-3);
        let geometry = geometry::<f64>(&inputs.shape()).unwrap();
        let found = compare(&inputs, &geometry, 2e3, 9);
        let of = |model: ToothCompliance| found.models.iter().position(|&own| own == model);
        let [beam, field] = [ToothCompliance::BEAM, ToothCompliance::FINITE_ELEMENT]
            .map(|model| of(model).unwrap());
        // At E a second pair is one base pitch ahead.
        let (first, length) = (&found.points[0], geometry.end - geometry.start);
        assert!(length > geometry.base_pitch);
        let second = compare_at(&inputs, &geometry, geometry.base_pitch);
        for (model, is_coupled) in [(beam, false), (field, true)] {
            let (mesh, pair) = (first.mesh[model].unwrap(), first.pair[model].unwrap());
            let sum = pair + second[model].unwrap();
            assert!(mesh > pair, "{mesh} {pair}");
            assert_eq!(mesh < 0.99 * sum, is_coupled, "{mesh} {sum}");
        }
    }

    /// Stiffness of the pair at one place by each model.
    fn compare_at(inputs: &Inputs, geometry: &Geometry, way: f64) -> Vec<Option<f64>> {
        let by = |tooth: ToothCompliance| {
            let inputs = Inputs { tooth_compliance: Some(tooth), ..inputs.clone() };
            let elasticity = inputs.elasticity();
            let mesh = Mesh::of(&elasticity, geometry, 2e3).ok()?;
            mesh.pair(way)
        };
        ToothCompliance::ALL.into_iter().map(by).collect()
    }
}
