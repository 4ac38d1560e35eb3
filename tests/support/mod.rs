//! Inputs that several tests share.

use tipstrike::case::Case;
use tipstrike::model::Inputs;
use tipstrike::model::inputs::{Drive, Gear};

/// A standard steel pair without deviation, 10 mm wide, 100 N m at 2000 rpm.
pub(crate) fn standard_pair(driver_teeth: u32, driven_teeth: u32, module: f64) -> Inputs {
    let table_1 = Case::table_1().inputs().expect("the built-in case is valid");
    let gear = |teeth| Gear {
        teeth,
        face_width: 10e-3,
        bore_radius: 0.0,
        young: 206e9,
        ..table_1.driver.clone()
    };
    Inputs {
        module,
        driver: gear(driver_teeth),
        driven: gear(driven_teeth),
        base_pitch_deviation: 0.0,
        drive: Drive::Torque(100.0),
        deflection: None,
        tooth_compliance: None,
        ..table_1.clone()
    }
}
