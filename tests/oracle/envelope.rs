//! Random gear pairs of the whole envelope and of its corners.

use std::f64::consts::{PI, SQRT_2};

use tipstrike::model::Inputs;
use tipstrike::model::inputs::{
    ContactCompliance, Drive, Gear, InertiaModel, Method, ToothCompliance,
};

/// A small random generator with a named sequence (splitmix64, Steele, Lea & Flood 2014), the same
/// on every machine.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A uniform value between two values.
    pub(crate) fn even(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A value between two positive values, uniform in its logarithm.
    pub(crate) fn decades(&mut self, from: f64, to: f64) -> f64 {
        self.even(from.ln(), to.ln()).exp()
    }

    pub(crate) fn chance(&mut self, share: f64) -> bool {
        self.even(0.0, 1.0) < share
    }

    pub(crate) fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[(self.bits() % choices.len() as u64) as usize]
    }
}

/// A region of the envelope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Corner {
    Anywhere,
    /// Inside the fit of Eq. 56, so that forces have a closed form.
    Fit,
    /// N₁E almost 0: close to interference.
    StartNearTangent,
    /// γ₂ near 0: contact starts at the pitch point.
    StartNearPitch,
    /// α_w far below α.
    FlatAngle,
    /// A very short path of contact.
    ShortPath,
    /// The sliding velocity almost 0.
    SlidingNearZero,
    /// Deflection and error almost cancel.
    Cancelling,
}

impl Corner {
    pub(crate) const ALL: [Corner; 8] = [
        Corner::Anywhere,
        Corner::Fit,
        Corner::StartNearTangent,
        Corner::StartNearPitch,
        Corner::FlatAngle,
        Corner::ShortPath,
        Corner::SlidingNearZero,
        Corner::Cancelling,
    ];
}

/// A pair of a region of the envelope.
pub(crate) fn pair(random: &mut Random, corner: Corner) -> Inputs {
    let fit = match corner {
        Corner::Anywhere => false,
        Corner::Fit => true,
        _ => random.chance(0.5),
    };
    let mut inputs = anywhere(random, fit);
    match corner {
        Corner::Anywhere | Corner::Fit | Corner::Cancelling => {}
        Corner::StartNearTangent => start_near_tangent(random, &mut inputs),
        Corner::StartNearPitch | Corner::SlidingNearZero => start_near_pitch(random, &mut inputs),
        Corner::FlatAngle => flat_angle(random, &mut inputs),
        Corner::ShortPath => short_path(random, &mut inputs),
    }
    deviate(random, &mut inputs);
    shorten(&mut inputs.driver);
    shorten(&mut inputs.driven);
    match corner {
        Corner::SlidingNearZero => sliding_near_zero(random, &mut inputs),
        Corner::Cancelling => cancelling(random, &mut inputs),
        _ => {}
    }
    inputs
}

/// The contact compliances of the oracle. The order of this list determines the frozen rows.
const CONTACT_MODELS: [ContactCompliance; 3] =
    [ContactCompliance::LOGARITHMIC, ContactCompliance::CONSTANT, ContactCompliance::WEBER];

/// Limits the addendum to a possible tooth.
fn shorten(gear: &mut Gear) {
    gear.addendum = gear.addendum.clamp(-1.0, 2.0);
}

/// A pair without deviation.
fn anywhere(random: &mut Random, fit: bool) -> Inputs {
    let module = random.decades(0.05e-3, 50e-3);
    let (first, second) = teeth(random, fit);
    let pressure_angle = random.even(14.5, 30.0).to_radians();
    let driver = gear(random, module, pressure_angle, first, fit);
    let driven = gear(random, module, pressure_angle, second, fit);
    let speed = random.decades(1e-3, 1e6) * PI / 30.0;
    let torque = random.decades(1e-6, 1e7) * module * f64::from(first) / 2.0 * pressure_angle.cos();
    Inputs {
        module,
        pressure_angle,
        driver,
        driven,
        drive: if random.chance(0.5) {
            Drive::Torque(torque)
        } else {
            Drive::Power(torque * speed)
        },
        speed,
        method: random.one_of(&[Method::Exact, Method::Exact, Method::Exact, Method::Paper]),
        tooth_compliance: fit.then_some(ToothCompliance::KUANG_YANG),
        contact_compliance: random.one_of(&CONTACT_MODELS),
        // The oracle has only the disc up to the base circle.
        inertia: InertiaModel::BaseCircle,
        stations: Some(8),
        ..Inputs::default()
    }
}

/// Tooth numbers with a ratio of 1/50..50.
fn teeth(random: &mut Random, fit: bool) -> (u32, u32) {
    const MOST_RATIO: f64 = 50.0;
    let (least, most) = if fit { (12.0, 100.0) } else { (5.0, 1000.0) };
    let first = random.decades(least, most).round();
    let second =
        random.decades((first / MOST_RATIO).max(least), (first * MOST_RATIO).min(most)).round();
    if random.chance(0.5) { (first as u32, second as u32) } else { (second as u32, first as u32) }
}

fn gear(random: &mut Random, module: f64, pressure_angle: f64, teeth: u32, fit: bool) -> Gear {
    let profile_shift = match (random.chance(0.25), fit) {
        (true, _) => 0.0,
        (false, true) => random.even(-0.6, 0.6),
        (false, false) => random.even(-0.7, 1.2),
    };
    let reference = module * f64::from(teeth) / 2.0;
    let body = (reference + module * (profile_shift - 1.25)).min(reference * pressure_angle.cos());
    let bore =
        if random.chance(0.2) { 0.0 } else { body * random.one_of(&[0.3, 0.7, 0.999, 1.0 - 1e-9]) };
    Gear {
        teeth,
        profile_shift,
        addendum: if random.chance(0.5) { 1.0 } else { random.even(0.3, 1.3) },
        face_width: random.decades(1e-4, 1.0),
        bore_radius: bore,
        young: if fit { random.decades(1e10, 1e12) } else { random.decades(1e6, 1e12) },
        poisson: random.even(0.0, 0.49),
        density: random.decades(500.0, 20e3),
        tip_chamfer: if random.chance(0.8) { 0.0 } else { module * random.decades(1e-3, 0.1) },
        tip_radius: if random.chance(0.8) {
            None
        } else {
            Some(module * random.decades(1e-3, 0.3))
        },
        ..Gear::default()
    }
}

/// A deviation from 1e-15 m to 5 % of the module, uniform in its logarithm.
fn deviate(random: &mut Random, inputs: &mut Inputs) {
    let total = random.decades(1e-15, 0.05 * inputs.module);
    let share = random.one_of(&[0.0, 0.0, 0.3, 0.9, 1.0]);
    inputs.base_pitch_deviation = share * total / SQRT_2;
    inputs.deflection = Some((1.0 - share) * total);
    let computed = inputs.tooth_compliance.is_some() && random.chance(0.15);
    if computed {
        inputs.deflection = None;
        inputs.base_pitch_deviation = random.one_of(&[0.0, 5e-6]);
    }
}

/// Line of action without backlash, in double precision: r_b1, r_b2 and tan α_w.
struct Line {
    driver_base: f64,
    driven_base: f64,
    tangent: f64,
}

impl Line {
    fn of(inputs: &Inputs) -> Option<Line> {
        let alpha = inputs.pressure_angle;
        let base = |gear: &Gear| inputs.module * f64::from(gear.teeth) / 2.0 * alpha.cos();
        let (driver_base, driven_base) = (base(&inputs.driver), base(&inputs.driven));
        if let Some(distance) = inputs.centre_distance {
            let tangent = (distance / (driver_base + driven_base)).powi(2) - 1.0;
            return Some(Line { driver_base, driven_base, tangent: tangent.sqrt() });
        }
        let shifts = inputs.driver.profile_shift + inputs.driven.profile_shift;
        let teeth = f64::from(inputs.driver.teeth + inputs.driven.teeth);
        let involute = alpha.tan() - alpha + 2.0 * shifts * alpha.tan() / teeth;
        if involute <= 0.0 {
            return None;
        }
        let mut angle = (3.0 * involute).cbrt().min(1.5);
        for _ in 0..60 {
            angle -= (angle.tan() - angle - involute) / angle.tan().powi(2);
        }
        Some(Line { driver_base, driven_base, tangent: angle.tan() })
    }

    fn length(&self) -> f64 {
        (self.driver_base + self.driven_base) * self.tangent
    }
}

/// Gives the gear the addendum at which its tip has the radius of curvature `curvature`.
fn reach(gear: &mut Gear, module: f64, base: f64, curvature: f64) {
    let reference = module * f64::from(gear.teeth) / 2.0;
    gear.tip_chamfer = 0.0;
    gear.addendum = (base.hypot(curvature) - reference) / module - gear.profile_shift;
}

fn start_near_tangent(random: &mut Random, inputs: &mut Inputs) {
    let Some(line) = Line::of(inputs) else { return };
    let near = random.decades(1e-12, 1e-1);
    reach(&mut inputs.driven, inputs.module, line.driven_base, line.length() * (1.0 - near));
}

fn start_near_pitch(random: &mut Random, inputs: &mut Inputs) {
    let Some(line) = Line::of(inputs) else { return };
    let near = random.decades(1e-12, 1e-1) * random.one_of(&[1.0, 1.0, -1.0]);
    reach(
        &mut inputs.driven,
        inputs.module,
        line.driven_base,
        line.driven_base * line.tangent * (1.0 + near),
    );
}

fn flat_angle(random: &mut Random, inputs: &mut Inputs) {
    let Some(line) = Line::of(inputs) else { return };
    let angle = random.decades(1e-5, 0.2);
    inputs.centre_distance = Some((line.driver_base + line.driven_base) / angle.cos());
    let Some(line) = Line::of(inputs) else { return };
    let from_pitch = line.driven_base / (line.driver_base + line.driven_base);
    let driven = line.length() * random.even(from_pitch, 1.0);
    reach(&mut inputs.driven, inputs.module, line.driven_base, driven);
    reach(
        &mut inputs.driver,
        inputs.module,
        line.driver_base,
        line.length() * random.even(1.0, 1.5) - driven,
    );
}

fn short_path(random: &mut Random, inputs: &mut Inputs) {
    let Some(line) = Line::of(inputs) else { return };
    let start = line.length() * random.even(0.1, 0.6);
    reach(&mut inputs.driven, inputs.module, line.driven_base, line.length() - start);
    reach(
        &mut inputs.driver,
        inputs.module,
        line.driver_base,
        start * (1.0 + random.decades(1e-12, 1e-1)),
    );
}

/// Moves D to where the tip does not slide, as far as the deviation allows.
fn sliding_near_zero(random: &mut Random, inputs: &mut Inputs) {
    use tipstrike::model::{Stage, Stages, solve};
    inputs.deflection = inputs.deflection.or(Some(1e-6 * inputs.module));
    let Some(line) = Line::of(inputs) else { return };
    let (mut low, mut high) = (0.5, 1.5);
    for _ in 0..random.one_of(&[8, 16, 24, 32, 48]) {
        let middle = f64::midpoint(low, high);
        reach(
            &mut inputs.driven,
            inputs.module,
            line.driven_base,
            line.driven_base * line.tangent * middle,
        );
        let velocity =
            solve(inputs, Stages::of(Stage::Velocity)).ok().and_then(|solution| solution.velocity);
        match velocity {
            Some(velocity) if velocity.sliding > 0.0 => high = middle,
            _ => low = middle,
        }
    }
}

/// A relief that cancels almost the whole deviation.
fn cancelling(random: &mut Random, inputs: &mut Inputs) {
    let rest = inputs.deflection.unwrap_or(1e-9) + SQRT_2 * inputs.base_pitch_deviation;
    let (length, method) = (rest * random.decades(1e1, 1e6), inputs.method);
    inputs.driven.tip_relief = length;
    inputs.deflection = match method {
        Method::Paper => Some(rest + length / SQRT_2),
        _ => Some(rest + length),
    };
    inputs.base_pitch_deviation = 0.0;
}
