//! A pair to start tests from.

use super::inputs::{ContactCompliance, Drive, Gear, Inputs, ReliefShape, Rung};

/// A standard steel pair without deviation, 10 mm wide, 100 N m at 1000 rpm.
pub(crate) fn standard_pair(driver_teeth: u32, driven_teeth: u32, module: f64) -> Inputs {
    let gear = |teeth| Gear {
        teeth,
        profile_shift: 0.0,
        addendum: 1.0,
        dedendum: 1.25,
        face_width: 10e-3,
        bore_radius: 0.0,
        young: 206e9,
        poisson: 0.3,
        density: 7800.0,
        tip_relief: 0.0,
        root_relief: 0.0,
        tip_relief_length: None,
        root_relief_length: None,
        tip_chamfer: 0.0,
        tip_radius: None,
    };
    Inputs {
        module,
        pressure_angle: 20f64.to_radians(),
        centre_distance: None,
        driver: gear(driver_teeth),
        driven: gear(driven_teeth),
        base_pitch_deviation: 0.0,
        backlash: 0.0,
        drive: Drive::Torque(100.0),
        speed: 1000f64 * std::f64::consts::PI / 30.0,
        friction_coefficient: None,
        rung: Rung::Exact,
        deflection: None,
        tooth_compliance: None,
        contact_compliance: ContactCompliance::Logarithmic,
        stations: Some(64),
        relief_shape: ReliefShape::Linear,
        damping_ratio: 0.07,
        warmup_cycles: 20,
        tolerance: 1e-6,
        within: 0.05,
        station_tolerance: 1e-3,
        accurate: false,
    }
}
