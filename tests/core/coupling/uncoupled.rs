//! The motion of a pair whose neighbouring teeth do not displace each other.

use tipstrike::model::budget::{MOTION_WORK, Meter};
use tipstrike::model::dynamic::{Dynamic, Settings, approach, dynamic};
use tipstrike::model::inputs::Gear;
use tipstrike::model::mesh::Mesh;
use tipstrike::model::{Inputs, Solution};

/// Greatest gap of the mesh, in m.
const REACH: f64 = 4e-4;

/// The mesh of a pair with additional tip relief of the driven gear, in m.
fn mesh(inputs: &Inputs, solution: &Solution, relief: f64) -> Option<Mesh> {
    let driven = Gear { tip_relief: inputs.driven.tip_relief + relief, ..inputs.driven };
    let inputs = Inputs { driven, ..inputs.clone() };
    let (force, error) = (solution.mesh_force, solution.deviation.equivalent_error);
    let mesh = Mesh::new(&inputs.mesh(), &solution.geometry, (force, error), REACH, None);
    Some(mesh.ok()?.uncoupled())
}

/// The motion by method `dynamic` without coupling.
pub(crate) fn motion(inputs: &Inputs, solution: &Solution) -> Option<Dynamic> {
    let settings = Settings::of(inputs, solution.reduced_mass);
    dynamic(&mesh(inputs, solution, 0.0)?, &settings, &|_| true).ok()
}

/// The required additional tip relief without coupling, in m: the greatest of a grid of reliefs at
/// which the tooth touches, refined.
pub(crate) fn required_relief(inputs: &Inputs, solution: &Solution) -> Option<f64> {
    const GRID: f64 = 2e-6;
    const MOST: i32 = 60;
    let settings = Settings::of(inputs, solution.reduced_mass);
    let touches = |relief: f64| {
        let meter = Meter::new(MOTION_WORK);
        let found = approach(&mesh(inputs, solution, relief)?, &settings, &meter, &|_| true);
        Some(found.ok()?.lead > 0.0)
    };
    let mut last = None;
    for step in (0..=MOST).rev() {
        if touches(GRID * f64::from(step))? {
            last = Some(step);
            break;
        }
    }
    let mut ends = [0.0, 1.0].map(|aside| GRID * (f64::from(last.unwrap_or(0)) + aside));
    last?;
    for _ in 0..12 {
        let middle = f64::midpoint(ends[0], ends[1]);
        ends[usize::from(!touches(middle)?)] = middle;
    }
    Some(ends[1])
}
