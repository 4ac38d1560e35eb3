//! The mesh of the back flanks: the mirrored mesh of the working flanks. Its pairs move from the
//! end of the path of contact to the start.

use std::sync::Arc;

use super::Mesh;
use crate::model::geometry::{Geometry, PairShape};

impl Mesh {
    /// The mesh of the back flanks as a function of the path of a back pair since B' in the mirror,
    /// in m. Back flanks have no deviation.
    ///
    /// # Formula
    /// ```text
    /// s' = EB − σ,   k'(s') = k(σ),   S'(s') = S(σ),   Q'_kj(s') = Q_jk(σ)
    /// ```
    /// σ is the path since E' in the mirror. The driver keeps its direction of rotation, so a back
    /// pair moves from B', where the driver's tip meets the root of the driven gear, to E'.
    ///
    /// # Valid for
    /// Symmetric teeth with the same reliefs on both flanks.
    #[must_use]
    pub fn back(&self) -> Mesh {
        let back = self.back.0.get_or_init(|| self.reversed());
        Mesh { speed: self.speed, driver_speed: self.driver_speed, ..back.clone() }
    }

    /// The path s' of a back pair with the incoming pair at E, from 0 to a base pitch, in m.
    #[must_use]
    pub fn back_place(&self) -> f64 {
        self.back_place
    }

    fn reversed(&self) -> Mesh {
        let zones = self.zones.iter().rev();
        let couplings = self.couplings.as_ref();
        Mesh {
            error: 0.0,
            pitch_point: self.length - self.pitch_point,
            zones: Arc::new(zones.map(|zone| zone.reversed(self.length)).collect()),
            couplings: couplings
                .map(|couplings| Arc::new(couplings.reversed(self.length, self.base_pitch))),
            sharing: Arc::default(),
            back: Arc::default(),
            ..self.clone()
        }
    }
}

/// The path s' of a back pair with the incoming pair at E, from 0 to a base pitch, in m.
///
/// # Formula
/// ```text
/// s' = s + EB − σ_0 + k p_b,   σ_0 = 2 EP + p_b/2 + r_b1 ψ_1 − r_b2 ψ_2
/// ψ = π/(2 z) + 2 x tan α/z + inv α − inv α_w
/// ```
/// ψ is half the angle of a tooth on its working pitch circle. The flanks of a driver's tooth cross
/// the two lines of action at the same distance from N1 after a rotation by 2 EP + 2 `r_b1` ψ_1.
/// Each gear has half of the backlash and turns by half of it until the back flanks touch, so that
/// σ_0 does not depend on the backlash.
pub(super) fn back_place(shape: &PairShape, geometry: &Geometry) -> f64 {
    let involute = |angle: f64| angle.tan() - angle;
    let alpha = shape.pressure_angle;
    let common = involute(alpha) - involute(geometry.working_pressure_angle);
    let half_tooth = |teeth: u32, shift: f64| {
        (std::f64::consts::FRAC_PI_2 + 2.0 * shift * alpha.tan()) / f64::from(teeth) + common
    };
    let (driver, driven) = (&shape.driver, &shape.driven);
    let start = 2.0 * geometry.approach_length
        + 0.5 * geometry.base_pitch
        + geometry.driver.base * half_tooth(driver.teeth, driver.profile_shift)
        - geometry.driven.base * half_tooth(driven.teeth, driven.profile_shift);
    (geometry.end - geometry.start - start).rem_euclid(geometry.base_pitch)
}

#[cfg(test)]
mod tests {
    use crate::model::inputs::{Method, ToothCompliance};
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};
    use crate::numeric::root;

    /// The back flank of a driver's tooth, turned with its working flank, crosses the other line of
    /// action at the place in the mesh.
    #[test]
    fn the_back_flanks_agree_with_turned_involutes() {
        let involute = |angle: f64| angle.tan() - angle;
        for (teeth, shifts, more) in [
            ((20, 30), (0.0, 0.0), None),
            ((17, 43), (0.3, -0.1), None),
            ((25, 25), (0.1, 0.2), Some(0.6e-3)),
        ] {
            let mut inputs = standard_pair(teeth.0, teeth.1, 5e-3);
            inputs.method = Method::Static;
            inputs.tooth_compliance = Some(ToothCompliance::KUANG_YANG);
            (inputs.driver.profile_shift, inputs.driven.profile_shift) = shifts;
            let wide =
                solve(&inputs, Stages::of(Stage::Geometry)).unwrap().geometry.centre_distance;
            inputs.centre_distance = more.map(|more| wide + more);
            let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
            let (geometry, mesh) = (&solution.geometry, solution.mesh.as_ref().unwrap());
            let (base, working) = (geometry.driver.base, geometry.working_pressure_angle);
            let at_reference = (std::f64::consts::FRAC_PI_2
                + 2.0 * shifts.0 * inputs.pressure_angle.tan())
                / f64::from(teeth.0);
            let half = |radius: f64| {
                at_reference + involute(inputs.pressure_angle) - involute((base / radius).acos())
            };
            // A point of a line of action at a distance from N1: its radius and its angle.
            let point = |along: f64, side: f64| {
                let (sine, cosine) = working.sin_cos();
                let x = base * cosine + along * sine;
                let y = side * (along * cosine - base * sine);
                (x.hypot(y), y.atan2(x))
            };
            let s = 0.3 * mesh.length;
            let (radius, angle) = point(geometry.start + s, 1.0);
            let tooth = angle - half(radius);
            let crosses = |along: f64| {
                let (radius, angle) = point(along, -1.0);
                angle - (tooth - half(radius))
            };
            let along = root::between(1e-6, 4.0 * mesh.length, crosses);
            let way = along - geometry.start + 0.5 * geometry.backlash(&inputs.shape());
            let expected = mesh.length - way - s;
            let pitches = (mesh.back_place() - expected) / mesh.base_pitch;
            assert!((pitches - pitches.round()).abs() < 1e-9, "{teeth:?}: {pitches}");
        }
    }
}
