//! The rungs in which every pair in contact takes its share of the load: as much of the mesh as they need, then `static`
//! and `dynamic`.

use super::dynamic::{Dynamic, Settings, dynamic};
use super::inputs::Inputs;
use super::mesh::Mesh;
use super::spacing::Spacing;
use super::stage::{Stage, Stages};
use super::static_load::{StaticLoad, static_load};
use super::{Outcome, Refusal, Solution};

/// What the wanted rungs found.
struct Shared {
    mesh_stiffness: f64,
    static_load: Option<StaticLoad>,
    dynamic: Option<Dynamic>,
}

/// Add to the solution what the wanted stages find. Whether the tooth strikes is then what the last of them says.
///
/// # Errors
/// Those of [`Mesh::new`], [`static_load`] and [`dynamic`].
pub(super) fn share(
    solution: &mut Solution,
    inputs: &Inputs,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<(), Refusal> {
    let shared = within_reach(solution, inputs, wanted, go_on)?;
    let ran = [Stage::Mesh, Stage::Static, Stage::Dynamic].into_iter().filter(|&stage| wanted.has(stage));
    solution.stages = ran.fold(solution.stages, Stages::with);
    let static_angle = shared.static_load.as_ref().map(|load| load.first_contact_angle);
    let dynamic_angle = shared.dynamic.as_ref().map(|dynamic| dynamic.first_contact_angle);
    if let Some(angle) = dynamic_angle.or(static_angle) {
        solution.outcome = if angle.is_some() { Outcome::CornerContact } else { Outcome::NoCornerContact };
    }
    solution.mesh_stiffness = Some(shared.mesh_stiffness);
    solution.static_load = shared.static_load;
    solution.dynamic = shared.dynamic;
    Ok(())
}

/// The mesh is computed no further than the pairs yield: where that was not far enough, again and further.
fn within_reach(solution: &Solution, inputs: &Inputs, wanted: Stages, go_on: &dyn Fn(f64) -> bool) -> Result<Shared, Refusal> {
    const AT_FIRST: f64 = 8.0;
    const FURTHER: f64 = 16.0;
    let reliefs = [&inputs.driver, &inputs.driven].map(|gear| gear.tip_relief + gear.root_relief);
    let deviation = &solution.deviation;
    let yields = deviation.combined_deflection + deviation.equivalent_error.abs() + reliefs.iter().sum::<f64>();
    let mut reach = AT_FIRST * yields;
    loop {
        let mesh = Mesh::new(inputs, &solution.geometry, solution.mesh_force, deviation.equivalent_error, reach)?;
        match run(&mesh, solution.reduced_mass, inputs, wanted, go_on) {
            Err(Refusal::BeyondReach) if !mesh.is_whole() => reach *= FURTHER,
            found => return found,
        }
    }
}

fn run(mesh: &Mesh, mass: f64, inputs: &Inputs, wanted: Stages, go_on: &dyn Fn(f64) -> bool) -> Result<Shared, Refusal> {
    let settings = Settings {
        mass,
        damping_ratio: inputs.damping_ratio,
        warmup_cycles: inputs.warmup_cycles,
        tolerance: inputs.tolerance,
        spacing: Spacing::of(inputs),
    };
    Ok(Shared {
        mesh_stiffness: mesh.mean_stiffness,
        static_load: wanted.has(Stage::Static).then(|| static_load(mesh, Spacing::of(inputs))).transpose()?,
        dynamic: wanted.has(Stage::Dynamic).then(|| dynamic(mesh, &settings, go_on)).transpose()?,
    })
}
