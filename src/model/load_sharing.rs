//! The methods in which every pair in contact takes its share of the load: as much of the mesh as
//! they need, then `static` and `dynamic`.

use std::sync::Arc;

use super::dynamic::{Dynamic, Settings, dynamic};
use super::mesh::{Mesh, MeshInputs};
use super::request::Request;
use super::spacing::{Resolution, Spacing};
use super::stage::{Stage, Stages};
use super::static_load::{StaticLoad, static_load};
use super::{Outcome, Refusal, Solution};

/// What the wanted methods found.
struct Shared {
    mesh: Arc<Mesh>,
    static_load: Option<StaticLoad>,
    dynamic: Option<Dynamic>,
    ran: Stages,
}

/// Add to the solution what the wanted stages find. Whether the tooth strikes is then what the last
/// of them says.
///
/// # Errors
/// Those of [`Mesh::new`], [`static_load`] and [`dynamic`].
pub(super) fn share(
    solution: &mut Solution,
    asked: &Request<'_>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<(), Refusal> {
    let shared = within_reach(solution, asked, go_on)?;
    let present = [Stage::Mesh, Stage::Static, Stage::Dynamic]
        .into_iter()
        .filter(|&stage| asked.wanted.has(stage));
    solution.stages = present.fold(solution.stages, Stages::with);
    solution.ran = solution.ran.and(shared.ran);
    let static_angle = shared
        .static_load
        .as_ref()
        .map(|load| load.first_contact_angle);
    let dynamic_angle = shared
        .dynamic
        .as_ref()
        .map(|dynamic| dynamic.first_contact_angle);
    if let Some(angle) = dynamic_angle.or(static_angle) {
        solution.outcome = if angle.is_some() {
            Outcome::CornerContact
        } else {
            Outcome::NoCornerContact
        };
    }
    let limited = [
        shared.static_load.as_ref().map(|load| load.resolution),
        shared.dynamic.as_ref().map(|dynamic| dynamic.resolution),
    ];
    let resolution = limited
        .into_iter()
        .flatten()
        .fold(Resolution::Full, Resolution::and);
    solution.stations_withheld = solution.stations_withheld.or(resolution.refusal());
    solution.mesh = Some(shared.mesh);
    solution.static_load = shared.static_load;
    solution.dynamic = shared.dynamic;
    Ok(())
}

/// The mesh is computed no further than the pairs yield: where that was not far enough, again and
/// further. An earlier mesh that reaches further serves earlier results alone, since another reach
/// changes the last digits of new ones.
fn within_reach(
    solution: &Solution,
    asked: &Request<'_>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Shared, Refusal> {
    let inputs = asked.inputs.mesh();
    let first = first_reach(&inputs, solution);
    let serves = |mesh: &&Arc<Mesh>| mesh.reach().to_bits() == first.to_bits() || all_kept(asked);
    if let Some(mesh) = asked
        .kept(Stage::Mesh)
        .and_then(|earlier| earlier.mesh.as_ref())
        .filter(serves)
    {
        let mesh = mesh.turning_at(asked.inputs.speed);
        match run(&mesh, solution.reduced_mass, asked, Stages::NONE, go_on) {
            Err(Refusal::BeyondReach) if !mesh.is_whole() => (),
            found => return found,
        }
    }
    asked.note(Stage::Mesh, |_| false);
    on_mesh(&inputs, solution, |mesh| {
        run(
            mesh,
            solution.reduced_mass,
            asked,
            Stages::NONE.with(Stage::Mesh),
            go_on,
        )
    })
}

/// Whether every wanted result on the mesh is an earlier one.
fn all_kept(asked: &Request<'_>) -> bool {
    [Stage::Static, Stage::Dynamic]
        .into_iter()
        .filter(|&stage| asked.wanted.has(stage))
        .all(|stage| asked.kept(stage).is_some())
}

/// Up to what gaps the mesh is computed at first, in m.
fn first_reach(inputs: &MeshInputs, solution: &Solution) -> f64 {
    const TIMES: f64 = 8.0;
    let deviation = &solution.deviation;
    let yields =
        deviation.loaded_deflection() + deviation.equivalent_error.abs() + inputs.reliefs.sum();
    TIMES * yields
}

/// What `find` finds on the mesh of a pair with the geometry, the load and the deviation of the
/// solution, of which the pair may differ in its reliefs.
///
/// # Errors
/// Those of [`Mesh::new`] and of `find`.
pub(super) fn on_mesh<T>(
    inputs: &MeshInputs,
    solution: &Solution,
    find: impl Fn(&Arc<Mesh>) -> Result<T, Refusal>,
) -> Result<T, Refusal> {
    const FURTHER: f64 = 16.0;
    let deviation = &solution.deviation;
    let mut reach = first_reach(inputs, solution);
    let mut known = solution.mesh.as_ref().map(|mesh| Arc::clone(mesh.flanks()));
    loop {
        let (force, error) = (solution.mesh_force, deviation.equivalent_error);
        let geometry = &solution.geometry;
        let mesh = Arc::new(match &known {
            Some(flanks) => Mesh::of_flanks(inputs, geometry, flanks, (force, error), reach)?,
            None => Mesh::new(inputs, geometry, force, error, reach)?,
        });
        known.get_or_insert_with(|| Arc::clone(mesh.flanks()));
        match find(&mesh) {
            Err(Refusal::BeyondReach) if !mesh.is_whole() => reach *= FURTHER,
            found => return found,
        }
    }
}

/// The wanted methods on this mesh, as far as nothing earlier holds.
fn run(
    mesh: &Arc<Mesh>,
    mass: f64,
    asked: &Request<'_>,
    mut ran: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Shared, Refusal> {
    let (inputs, wanted) = (asked.inputs, asked.wanted);
    let spacing = Spacing::of(inputs);
    let held = asked
        .kept(Stage::Static)
        .and_then(|earlier| earlier.static_load.clone());
    let static_load = if !wanted.has(Stage::Static) || held.is_some() {
        held.filter(|_| wanted.has(Stage::Static))
    } else {
        ran = ran.with(Stage::Static);
        Some(static_load(mesh, spacing)?)
    };
    let held = asked
        .kept(Stage::Dynamic)
        .and_then(|earlier| earlier.dynamic.clone());
    let dynamic = if !wanted.has(Stage::Dynamic) || held.is_some() {
        held.filter(|_| wanted.has(Stage::Dynamic))
    } else {
        ran = ran.with(Stage::Dynamic);
        Some(dynamic(mesh, &Settings::of(inputs, mass), go_on)?)
    };
    Ok(Shared {
        mesh: Arc::clone(mesh),
        static_load,
        dynamic,
        ran,
    })
}
