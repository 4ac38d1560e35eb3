//! The range of gaps in which a mesh is computed: widened until a result needs no pair beyond it.

use std::sync::Arc;

use super::{Mesh, MeshInputs};
use crate::model::{Refusal, Solution};

/// The first range of gaps of the mesh, in m: a power of √2, so that cases with similar load,
/// deviation and reliefs have the same range. A deviation above the deflection lets the pairs lose
/// contact and move farther. Few motions need a larger range.
fn first_reach(inputs: &MeshInputs, solution: &Solution) -> f64 {
    const TIMES: f64 = 2.5;
    const TIMES_APART: f64 = 4.0;
    let deviation = &solution.deviation;
    let (deflection, error) = (deviation.loaded_deflection(), deviation.equivalent_error.abs());
    let times = if error > deflection { TIMES_APART } else { TIMES };
    let reach = times * (deflection + error + inputs.reliefs.sum());
    (0.5 * (2.0 * reach.log2()).ceil()).exp2()
}

/// The meshes of a pair with geometry, load and deviation of a solution, each with a larger range of
/// gaps than the one before. Every result uses the first mesh that is wide enough for it, because
/// the range changes its last digits.
pub(in crate::model) struct Meshes<'a> {
    inputs: &'a MeshInputs,
    solution: &'a Solution,
    /// A mesh of the same geometry.
    alike: Option<&'a Arc<Mesh>>,
    first_reach: f64,
    computed: Vec<Arc<Mesh>>,
}

impl<'a> Meshes<'a> {
    /// `alike` is a mesh of the same geometry, if known, and `same` one of the same inputs.
    pub(in crate::model) fn new(
        inputs: &'a MeshInputs,
        solution: &'a Solution,
        alike: Option<&'a Arc<Mesh>>,
        same: Option<&Arc<Mesh>>,
    ) -> Meshes<'a> {
        let first_reach = first_reach(inputs, solution);
        let is_first = |mesh: &&Arc<Mesh>| mesh.reach.to_bits() == first_reach.to_bits();
        let computed = same.filter(is_first).cloned().into_iter().collect();
        Meshes { inputs, solution, alike, first_reach, computed }
    }

    /// The result of `find` on the first mesh that is wide enough for it.
    ///
    /// # Errors
    /// Those of [`Mesh::new`] and of `find`.
    pub(in crate::model) fn find<T>(
        &mut self,
        find: impl Fn(&Arc<Mesh>) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        let mut number = 0;
        loop {
            let mesh = self.mesh(number)?;
            match find(&mesh) {
                Err(Refusal::BeyondReach) if !mesh.is_whole => number += 1,
                found => return found,
            }
        }
    }

    fn mesh(&mut self, number: usize) -> Result<Arc<Mesh>, Refusal> {
        const FURTHER: f64 = 4.0;
        if let Some(mesh) = self.computed.get(number) {
            return Ok(Arc::clone(mesh));
        }
        let Solution { geometry, mesh_force, deviation, .. } = self.solution;
        let load = (*mesh_force, deviation.equivalent_error);
        let last = self.computed.last();
        let reach = last.map_or(self.first_reach, |mesh| FURTHER * mesh.reach);
        let mesh = Arc::new(match last.or(self.alike) {
            Some(earlier) => Mesh::after(earlier, self.inputs, geometry, load, reach)?,
            None => Mesh::new(self.inputs, geometry, load, reach)?,
        });
        self.computed.push(Arc::clone(&mesh));
        Ok(mesh)
    }

    /// The widest mesh, and whether it is another one than `same`, which stays if no result needs a
    /// wider one.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub(in crate::model) fn last(
        mut self,
        same: Option<Arc<Mesh>>,
    ) -> Result<(Arc<Mesh>, bool), Refusal> {
        match same {
            Some(same) if self.computed.len() <= 1 => Ok((same, false)),
            _ => {
                self.mesh(0)?;
                Ok((self.computed.swap_remove(self.computed.len() - 1), true))
            }
        }
    }
}

/// The result of a stage whose refusal does not affect other results.
pub(in crate::model) fn late<T>(
    mesh: &Mesh,
    found: Result<T, Refusal>,
) -> Result<Result<T, Refusal>, Refusal> {
    match found {
        Err(Refusal::Stopped) => Err(Refusal::Stopped),
        Err(Refusal::BeyondReach) if !mesh.is_whole => Err(Refusal::BeyondReach),
        found => Ok(found),
    }
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::dynamic::{Settings, dynamic};
    use crate::model::inputs::{Inputs, Method};
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};

    #[test]
    fn a_motion_beyond_the_computed_gaps_is_refused() {
        let inputs = Inputs {
            method: Method::Dynamic,
            base_pitch_deviation: 12e-6,
            ..standard_pair(20, 30, 5e-3)
        };
        let solution = solve(&inputs, Stages::of(Stage::Dynamic)).unwrap();
        let stations = &solution.dynamic.as_ref().unwrap().stations;
        let most = stations.iter().map(|station| station.transmission_error);
        let most = most.fold(0.0, f64::max) + solution.deviation.equivalent_error;
        let motion = |reach: f64| {
            let load = (solution.mesh_force, solution.deviation.equivalent_error);
            let mesh = Mesh::new(&inputs.mesh(), &solution.geometry, load, reach)?;
            let settings = Settings::of(&inputs, solution.reduced_mass);
            dynamic(&mesh, &settings, &|_| true)
        };
        assert_eq!(motion(0.95 * most).err(), Some(Refusal::BeyondReach));
        assert_eq!(motion(4.0 * most).err(), None);
    }
}
