//! Realistic gear pairs: steel, usual loads and speeds, some with relief.

use tipstrike::case::Case;
use tipstrike::model::Inputs;
use tipstrike::model::inputs::{Drive, Gear, InertiaModel, ToothCompliance};

use super::envelope::Random;

/// One pair of a numbered sequence.
pub(crate) fn numbered(number: u64) -> Inputs {
    let random = &mut Random::new(number + 1);
    let built = Case::table_1().inputs().expect("the built-in case is valid");
    let module = random.decades(1e-3, 12e-3);
    let (driver, driven) =
        (gear(random, &built.driver, module), gear(random, &built.driven, module));
    let base_pitch_deviation = random.decades(2e-6, 40e-6);
    let load = random.decades(20e3, 500e3);
    let torque =
        load * driver.face_width.min(driven.face_width) * module * f64::from(driver.teeth) / 2.0;
    Inputs {
        module,
        driver,
        driven,
        base_pitch_deviation,
        drive: Drive::Torque(torque),
        speed: random.decades(1.0, 1500.0),
        damping_ratio: random.even(0.03, 0.12),
        tooth_compliance: random.one_of(&[
            None,
            Some(ToothCompliance::KUANG_YANG),
            Some(ToothCompliance::BEAM),
        ]),
        deflection: None,
        inertia: InertiaModel::BaseCircle,
        ..built
    }
}

fn gear(random: &mut Random, built: &Gear, module: f64) -> Gear {
    let teeth = random.even(17.0, 80.0) as u32;
    let profile_shift = if random.chance(0.5) { 0.0 } else { random.even(-0.3, 0.5) };
    let face_width = module * random.even(4.0, 16.0);
    let tip_relief = if random.chance(0.3) { module * random.even(0.0, 8e-3) } else { 0.0 };
    Gear { teeth, profile_shift, face_width, tip_relief, bore_radius: 0.0, ..*built }
}
