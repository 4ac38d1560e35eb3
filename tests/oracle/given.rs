//! The inputs of a solve with 90 digits.

use tipstrike::model::Inputs;
use tipstrike::model::inputs::{ContactCompliance, Drive, Method, ToothCompliance};

use super::number::{Big, big, whole};

pub(crate) struct Gear {
    pub(crate) teeth: i64,
    pub(crate) profile_shift: Big,
    pub(crate) addendum: Big,
    pub(crate) face_width: Big,
    pub(crate) bore_radius: Big,
    pub(crate) young: Big,
    pub(crate) poisson: Big,
    pub(crate) density: Big,
    pub(crate) tip_relief: Big,
    pub(crate) root_relief: Big,
    pub(crate) tip_chamfer: Big,
    pub(crate) tip_radius: Option<Big>,
}

impl Gear {
    fn of(gear: &tipstrike::model::inputs::Gear) -> Gear {
        Gear {
            teeth: gear.teeth.into(),
            profile_shift: big(gear.profile_shift),
            addendum: big(gear.addendum),
            face_width: big(gear.face_width),
            bore_radius: big(gear.bore_radius),
            young: big(gear.young),
            poisson: big(gear.poisson),
            density: big(gear.density),
            tip_relief: big(gear.tip_relief),
            root_relief: big(gear.root_relief),
            tip_chamfer: big(gear.tip_chamfer),
            tip_radius: gear.tip_radius.map(big),
        }
    }

    fn continuous(&mut self) -> Vec<&mut Big> {
        let always = [
            &mut self.profile_shift,
            &mut self.addendum,
            &mut self.face_width,
            &mut self.bore_radius,
            &mut self.young,
            &mut self.poisson,
            &mut self.density,
            &mut self.tip_relief,
            &mut self.root_relief,
            &mut self.tip_chamfer,
        ];
        always.into_iter().chain(&mut self.tip_radius).collect()
    }
}

/// The inputs of a solve.
pub(crate) struct Given {
    pub(crate) module: Big,
    pub(crate) pressure_angle: Big,
    pub(crate) centre_distance: Option<Big>,
    pub(crate) driver: Gear,
    pub(crate) driven: Gear,
    pub(crate) base_pitch_deviation: Big,
    pub(crate) backlash: Big,
    pub(crate) drive: Big,
    drive_is_power: bool,
    pub(crate) speed: Big,
    pub(crate) deflection: Option<Big>,
    pub(crate) method: Method,
    pub(crate) tooth_compliance: Option<ToothCompliance>,
    pub(crate) contact_compliance: ContactCompliance,
}

impl Given {
    pub(crate) fn of(inputs: &Inputs) -> Given {
        let (drive, drive_is_power) = match inputs.drive {
            Drive::Power(power) => (power, true),
            Drive::Torque(torque) => (torque, false),
        };
        Given {
            module: big(inputs.module),
            pressure_angle: big(inputs.pressure_angle),
            centre_distance: inputs.centre_distance.map(big),
            driver: Gear::of(&inputs.driver),
            driven: Gear::of(&inputs.driven),
            base_pitch_deviation: big(inputs.base_pitch_deviation),
            backlash: big(inputs.backlash),
            drive: big(drive),
            drive_is_power,
            speed: big(inputs.speed),
            deflection: inputs.deflection.map(big),
            method: inputs.method,
            tooth_compliance: inputs.tooth_compliance,
            contact_compliance: inputs.contact_compliance,
        }
    }

    /// Every input that is not a count or a choice.
    pub(crate) fn continuous(&mut self) -> Vec<&mut Big> {
        let always = [
            &mut self.module,
            &mut self.pressure_angle,
            &mut self.base_pitch_deviation,
            &mut self.backlash,
            &mut self.drive,
            &mut self.speed,
        ];
        let chosen = self.centre_distance.iter_mut().chain(&mut self.deflection);
        let gears = self.driver.continuous().into_iter().chain(self.driven.continuous());
        always.into_iter().chain(chosen).chain(gears).collect()
    }

    /// i = z₂/z₁.
    pub(crate) fn ratio(&self) -> Big {
        whole(self.driven.teeth) / self.driver.teeth
    }

    /// T₁.
    pub(crate) fn torque(&self) -> Big {
        if self.drive_is_power { &self.drive / &self.speed } else { self.drive.clone() }
    }

    /// b, the smaller face width.
    pub(crate) fn common_width(&self) -> Big {
        self.driver.face_width.clone().min(self.driven.face_width.clone())
    }
}
