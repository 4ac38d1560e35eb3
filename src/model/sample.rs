//! A standard pair for tests.

use super::geometry::Circles;
use super::inputs::{Drive, Gear, Inputs};
use super::profile::Rack;

/// A standard steel pair without deviation, 10 mm wide, 100 N m at 1000 rpm.
pub(crate) fn standard_pair(driver_teeth: u32, driven_teeth: u32, module: f64) -> Inputs {
    let gear = |teeth| Gear {
        teeth,
        face_width: 10e-3,
        young: 206e9,
        poisson: 0.3,
        density: 7800.0,
        ..Gear::default()
    };
    Inputs {
        module,
        pressure_angle: 20f64.to_radians(),
        driver: gear(driver_teeth),
        driven: gear(driven_teeth),
        drive: Drive::Torque(100.0),
        speed: 1000f64 * std::f64::consts::PI / 30.0,
        ..Inputs::default()
    }
}

/// The circles of a gear that a rack cuts, with an addendum coefficient.
pub(crate) fn circles(rack: &Rack, addendum: f64) -> Circles {
    let reference = rack.module * rack.teeth / 2.0;
    let base = reference * rack.pressure_angle.cos();
    let tip = reference + rack.module * (rack.profile_shift + addendum);
    Circles {
        reference,
        base,
        tip,
        edge: 0.0,
        tip_curvature: ((tip - base) * (tip + base)).max(0.0).sqrt(),
        root: reference + rack.module * (rack.profile_shift - rack.dedendum),
    }
}
