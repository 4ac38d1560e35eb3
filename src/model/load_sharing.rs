//! The methods with load sharing: computes the mesh in the needed range, then `static` and
//! `dynamic`.

use std::sync::Arc;

use super::budget::{MOTION_WORK, Meter};
use super::dynamic::speeds::{SPEEDS, SpeedCurve, over_speed};
use super::dynamic::steady::{Steady, steady};
use super::dynamic::{Dynamic, MotionInputs, dynamic};
use super::mesh::{Mesh, MeshInputs};
use super::request::Request;
use super::spacing::Resolution;
use super::stage::{Stage, Stages};
use super::static_load::{StaticInputs, StaticLoad, static_load};
use super::static_spectrum::{Resonance, ResonanceInputs, StaticSpectrum, static_spectrum};
use super::{Outcome, Refusal, Solution};

/// The results of the wanted methods.
struct Shared {
    mesh: Arc<Mesh>,
    static_load: Option<StaticLoad>,
    dynamic: Option<Dynamic>,
    resonance: Option<Resonance>,
    static_spectrum: Option<Result<StaticSpectrum, Refusal>>,
    steady: Option<Result<Steady, Refusal>>,
    over_speed: Option<Result<Arc<SpeedCurve>, Refusal>>,
    ran: Stages,
}

/// The stages that are computed on a mesh.
const ON_MESH: [Stage; 6] = [
    Stage::Static,
    Stage::Dynamic,
    Stage::Resonance,
    Stage::StaticSpectrum,
    Stage::SteadyMotion,
    Stage::SpeedRun,
];

/// Adds the results of the wanted stages to the solution. The last of these methods decides whether
/// the tooth strikes.
///
/// # Errors
/// Those of [`Mesh::new`], [`static_load`] and [`dynamic`].
pub(super) fn share(
    solution: &mut Solution,
    asked: &Request<'_>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<(), Refusal> {
    let shared = run(solution, asked, go_on)?;
    let own = ON_MESH.into_iter().chain([Stage::Mesh]);
    let present = own.filter(|&stage| asked.wanted.has(stage));
    solution.stages = present.fold(solution.stages, Stages::with);
    solution.ran = solution.ran.and(shared.ran);
    let static_angle = shared.static_load.as_ref().map(|load| load.first_contact_angle);
    let dynamic_angle = shared.dynamic.as_ref().map(|dynamic| dynamic.first_contact_angle);
    if let Some(angle) = dynamic_angle.or(static_angle) {
        solution.outcome =
            if angle.is_some() { Outcome::CornerContact } else { Outcome::NoCornerContact };
    }
    let limited = [
        shared.static_load.as_ref().map(|load| load.resolution),
        shared.dynamic.as_ref().map(|dynamic| dynamic.resolution),
    ];
    let resolution = limited.into_iter().flatten().fold(Resolution::Full, Resolution::and);
    solution.stations_withheld = solution.stations_withheld.or(resolution.refusal());
    solution.mesh = Some(shared.mesh);
    solution.static_load = shared.static_load;
    solution.dynamic = shared.dynamic;
    solution.resonance = shared.resonance;
    solution.static_spectrum = shared.static_spectrum;
    solution.steady = shared.steady;
    solution.over_speed = shared.over_speed;
    Ok(())
}

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

/// The result of `find` on the mesh of a pair with geometry, load and deviation of the solution.
/// Only the reliefs may differ. `earlier` is a mesh of the same geometry, if known.
///
/// # Errors
/// Those of [`Mesh::new`] and of `find`.
pub(super) fn on_mesh<T>(
    inputs: &MeshInputs,
    solution: &Solution,
    earlier: Option<&Arc<Mesh>>,
    find: impl Fn(&Arc<Mesh>) -> Result<T, Refusal>,
) -> Result<T, Refusal> {
    Meshes { inputs, solution, earlier, computed: Vec::new() }.find(find)
}

/// The meshes of a pair, each with a larger range of gaps than the one before. Every result uses
/// the first mesh that is wide enough for it, because the range changes its last digits.
struct Meshes<'a> {
    inputs: &'a MeshInputs,
    solution: &'a Solution,
    /// A mesh of the same geometry.
    earlier: Option<&'a Arc<Mesh>>,
    computed: Vec<Arc<Mesh>>,
}

impl Meshes<'_> {
    fn find<T>(&mut self, find: impl Fn(&Arc<Mesh>) -> Result<T, Refusal>) -> Result<T, Refusal> {
        let mut number = 0;
        loop {
            let mesh = self.mesh(number)?;
            match find(&mesh) {
                Err(Refusal::BeyondReach) if !mesh.is_whole() => number += 1,
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
        let reach = last
            .map_or_else(|| first_reach(self.inputs, self.solution), |mesh| FURTHER * mesh.reach());
        let mesh = Arc::new(match last.or(self.earlier) {
            Some(earlier) => Mesh::after(earlier, self.inputs, geometry, load, reach)?,
            None => Mesh::new(self.inputs, geometry, load.0, load.1, reach)?,
        });
        self.computed.push(Arc::clone(&mesh));
        Ok(mesh)
    }
}

/// Runs the wanted stages and reuses valid earlier results.
fn run(
    solution: &Solution,
    asked: &Request<'_>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Shared, Refusal> {
    let (inputs, mass) = (asked.inputs, solution.reduced_mass);
    let of_mesh = inputs.mesh();
    let kept = asked.kept(Stage::Mesh).and_then(|earlier| earlier.mesh.clone());
    if kept.is_none() {
        asked.note(Stage::Mesh, |_| false);
    }
    let mut meshes = Meshes {
        inputs: &of_mesh,
        solution,
        earlier: asked.kept(Stage::Geometry).and_then(|earlier| earlier.mesh.as_ref()),
        computed: Vec::new(),
    };
    let first = first_reach(&of_mesh, solution);
    meshes
        .computed
        .extend(kept.iter().filter(|mesh| mesh.reach().to_bits() == first.to_bits()).cloned());
    let mut run = StageRun { asked, ran: Stages::NONE, meshes };
    let static_load = run.stage(
        Stage::Static,
        |earlier| earlier.static_load.clone(),
        |mesh| {
            let at_rest = StaticInputs::of(inputs);
            static_load(&mesh.turning_at(at_rest.speed), at_rest.spacing)
        },
    )?;
    let dynamic = run.stage(
        Stage::Dynamic,
        |earlier| earlier.dynamic.clone(),
        |mesh| {
            let motion = MotionInputs::of(inputs);
            let mesh = mesh.turning_at(motion.speed);
            dynamic(&mesh, &motion.settings(mass), go_on)
        },
    )?;
    let resonance = run.stage(
        Stage::Resonance,
        |earlier| earlier.resonance,
        |mesh| Ok(Resonance::of(&ResonanceInputs::of(inputs), mesh, mass)),
    )?;
    let static_spectrum = run.stage(
        Stage::StaticSpectrum,
        |earlier| earlier.static_spectrum,
        |mesh| late(mesh, static_spectrum(mesh)),
    )?;
    let steady = run.stage(
        Stage::SteadyMotion,
        |earlier| earlier.steady.clone(),
        |mesh| steady_motion(mesh, mass, &MotionInputs::steady(inputs), go_on),
    )?;
    let over_speed = run.stage(
        Stage::SpeedRun,
        |earlier| earlier.over_speed.clone(),
        |mesh| {
            let total = (2 * SPEEDS) as f64;
            let found = over_speed(inputs, solution, &mut |curve| {
                go_on(curve.up.iter().chain(&curve.down).flatten().count() as f64 / total)
            });
            late(mesh, found.map(Arc::new))
        },
    )?;
    let StageRun { mut ran, mut meshes, .. } = run;
    let mesh = match kept {
        // No stage needs a new mesh.
        Some(kept) if meshes.computed.len() <= 1 => kept,
        _ => {
            meshes.mesh(0)?;
            ran = ran.with(Stage::Mesh);
            meshes.computed.swap_remove(meshes.computed.len() - 1)
        }
    };
    Ok(Shared {
        mesh: mesh.turning_at(inputs.speed),
        static_load,
        dynamic,
        resonance,
        static_spectrum,
        steady,
        over_speed,
        ran,
    })
}

/// The steady motion, or the reason why there is none.
fn steady_motion(
    mesh: &Arc<Mesh>,
    mass: f64,
    motion: &MotionInputs,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Result<Steady, Refusal>, Refusal> {
    let mesh = &*mesh.turning_at(motion.speed);
    let meter = Meter::new(MOTION_WORK);
    let settings = motion.settings(mass);
    late(mesh, steady(mesh, &settings, None, &meter, go_on))
}

/// The result of a stage whose refusal does not affect other results.
fn late<T>(mesh: &Mesh, found: Result<T, Refusal>) -> Result<Result<T, Refusal>, Refusal> {
    match found {
        Err(Refusal::Stopped) => Err(Refusal::Stopped),
        Err(Refusal::BeyondReach) if !mesh.is_whole() => Err(Refusal::BeyondReach),
        found => Ok(found),
    }
}

/// The state of a run of stages.
struct StageRun<'a> {
    asked: &'a Request<'a>,
    ran: Stages,
    meshes: Meshes<'a>,
}

impl StageRun<'_> {
    /// The result of a wanted stage: the earlier result if it is valid, otherwise a new one.
    fn stage<T>(
        &mut self,
        stage: Stage,
        earlier: impl Fn(&Solution) -> Option<T>,
        new: impl Fn(&Arc<Mesh>) -> Result<T, Refusal>,
    ) -> Result<Option<T>, Refusal> {
        if !self.asked.wanted.has(stage) {
            return Ok(None);
        }
        if let Some(held) = self.asked.kept(stage).and_then(earlier) {
            return Ok(Some(held));
        }
        self.ran = self.ran.with(stage);
        self.meshes.find(new).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::{Inputs, Method};
    use crate::model::sample::standard_pair;
    use crate::model::solve;

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
            let mesh = Mesh::new(&inputs.mesh(), &solution.geometry, load.0, load.1, reach)?;
            let settings = MotionInputs::of(&inputs).settings(solution.reduced_mass);
            dynamic(&mesh, &settings, &|_| true)
        };
        assert_eq!(motion(0.95 * most).err(), Some(Refusal::BeyondReach));
        assert_eq!(motion(4.0 * most).err(), None);
    }
}
