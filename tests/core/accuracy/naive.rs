//! The printed formulas in doubles: the accuracy of a hand calculation or a script.

use std::f64::consts::PI;

use tipstrike::model::Inputs;
use tipstrike::model::inputs::{ContactCompliance, Gear, ToothCompliance};

/// The pair for the printed formulas.
pub(crate) struct Naive<'a> {
    inputs: &'a Inputs,
    base: [f64; 2],
    tip: f64,
    distance: f64,
    working: f64,
    start: f64,
    start_angle: f64,
}

/// The driven tip by the law of cosines.
struct Tip {
    radius: f64,
    curvature: f64,
    normal: f64,
    normal_radius: f64,
    normal_length: f64,
}

impl<'a> Naive<'a> {
    pub(crate) fn of(inputs: &'a Inputs) -> Naive<'a> {
        let reference = |gear: &Gear| inputs.module * f64::from(gear.teeth) / 2.0;
        let base = [&inputs.driver, &inputs.driven]
            .map(|gear| reference(gear) * inputs.pressure_angle.cos());
        let driven = &inputs.driven;
        let tip = reference(driven) + inputs.module * (driven.addendum + driven.profile_shift)
            - driven.tip_chamfer;
        let sum = base[0] + base[1];
        let given = |distance: f64| (distance, (sum / distance).acos());
        let (distance, working) = inputs.centre_distance.map_or_else(
            || {
                let working = working_angle(inputs);
                (sum / working.cos(), working)
            },
            given,
        );
        let start = distance * working.sin() - (tip * tip - base[1] * base[1]).sqrt();
        Naive {
            inputs,
            base,
            tip,
            distance,
            working,
            start,
            start_angle: (base[1] / tip).acos() - working,
        }
    }

    /// Eqs. 7, 24-28 and 49 with arc tangents and the law of cosines.
    fn tip_at(&self, angle: f64) -> Tip {
        let (tip, distance, base) = (self.tip, self.distance, self.base[0]);
        let (sine, cosine) = (self.start_angle + angle).sin_cos();
        let radius = (tip * tip + distance * distance - 2.0 * distance * tip * cosine).sqrt();
        let curvature = (radius * radius - base * base).sqrt();
        let normal = (tip * sine).atan2(distance - tip * cosine) + curvature.atan2(base);
        let normal_length = distance * normal.sin() - curvature;
        Tip {
            radius,
            curvature,
            normal,
            normal_radius: distance * normal.cos() - base,
            normal_length,
        }
    }

    /// S(u) as printed.
    pub(crate) fn gap(&self, angle: f64) -> f64 {
        let tip = self.tip_at(angle);
        (tip.curvature - self.start) + self.base[1] * angle
            - self.base[0] * (tip.normal - self.working)
    }

    /// u from S(u) = Δ by Newton's method.
    pub(crate) fn angle(&self, deviation: f64) -> f64 {
        let driven = (self.tip * self.tip - self.base[1] * self.base[1]).sqrt();
        let mut angle = (2.0 * deviation * self.start / ((self.start + driven) * driven)).sqrt();
        for _ in 0..40 {
            let slope = self.base[1] - self.tip_at(angle).normal_radius;
            angle -= (self.gap(angle) - deviation) / slope;
        }
        angle
    }

    /// O₁D, r_b2', ΔV_n and ΔV_τ.
    pub(crate) fn at(&self, angle: f64) -> [f64; 4] {
        let tip = self.tip_at(angle);
        let (driver, driven) = (self.inputs.speed, self.inputs.driven_speed());
        let normal = driver * self.base[0] - driven * tip.normal_radius;
        [tip.radius, tip.normal_radius, normal, driven * tip.normal_length - driver * tip.curvature]
    }

    /// F_S by Eq. 57 with Eq. 55 or a constant; `None` outside the range of Eq. 56.
    pub(crate) fn force(&self, angle: f64) -> Option<f64> {
        let inputs = self.inputs;
        let logarithmic = inputs.contact_compliance == ContactCompliance::LOGARITHMIC;
        if inputs.tooth_compliance != Some(ToothCompliance::KUANG_YANG) || !logarithmic {
            return None;
        }
        let (tip, [.., normal, _]) = (self.tip_at(angle), self.at(angle));
        let give: f64 = [&inputs.driver, &inputs.driven]
            .map(|gear| (1.0 - gear.poisson.powi(2)) / gear.young)
            .iter()
            .sum();
        let flank = inputs
            .driven
            .tip_radius
            .unwrap_or((self.tip * self.tip - self.base[1] * self.base[1]).sqrt());
        let curvature = tip.curvature * flank / (tip.curvature + flank);
        let inertia = |gear: &Gear, base: f64| {
            PI * gear.density * gear.face_width / 2.0 * (base.powi(4) - gear.bore_radius.powi(4))
        };
        let (first, second) =
            (inertia(&inputs.driver, self.base[0]), inertia(&inputs.driven, self.base[1]));
        let mass =
            first * second / (first * tip.normal_radius.powi(2) + second * self.base[0].powi(2));
        let teeth = self.tooth(&inputs.driver, tip.radius) + self.tooth(&inputs.driven, self.tip);
        let width = inputs.common_width();
        let mut force = normal * (width * mass / teeth).sqrt();
        for _ in 0..200 {
            let half_width = (4.0 * force / width * curvature * give / PI).sqrt();
            let compliance = teeth + give / PI * (1.27 + 0.781 * (inputs.module / half_width).ln());
            force = normal * (width * mass / compliance).sqrt();
        }
        Some(force)
    }

    /// Eq. 56.
    fn tooth(&self, gear: &Gear, radius: f64) -> f64 {
        let (z, x) = (f64::from(gear.teeth), gear.profile_shift);
        let a0 = 3.867 + 1.612 * z - 0.02916 * z.powi(2) + 0.0001553 * z.powi(3);
        let a1 = 17.060 + 0.7289 * z - 0.01728 * z.powi(2) + 0.0000999 * z.powi(3);
        let a2 = 2.637 - 1.222 * z + 0.02217 * z.powi(2) - 0.0001179 * z.powi(3);
        let a3 = -6.330 - 1.033 * z + 0.02068 * z.powi(2) - 0.0001130 * z.powi(3);
        let module = self.inputs.module;
        1e-9 / (a0 + a1 * x + (a2 + a3 * x) * (radius - module * z / 2.0) / ((1.0 + x) * module))
    }
}

/// α_w by Newton's method on the involute function.
fn working_angle(inputs: &Inputs) -> f64 {
    let alpha = inputs.pressure_angle;
    let shifts = inputs.driver.profile_shift + inputs.driven.profile_shift;
    let teeth = f64::from(inputs.driver.teeth + inputs.driven.teeth);
    let involute = alpha.tan() - alpha + 2.0 * shifts * alpha.tan() / teeth;
    let mut angle = (3.0 * involute).cbrt().min(1.5);
    for _ in 0..60 {
        angle -= (angle.tan() - angle - involute) / angle.tan().powi(2);
    }
    angle
}
