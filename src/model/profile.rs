//! The profile of a tooth: the involute and the trochoidal fillet of the cutting rack.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Point2;

use super::geometry::{Circles, involute};
use super::inputs::{Gear, Inputs};
use crate::numeric::root::last_where;

/// A tooth's profile in a frame whose x axis is the tooth's centre line, from the gear's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Profile {
    /// Reference, base and tip radius, in m.
    circles: Circles,
    /// Half of the tooth's angle at the base circle, in rad.
    base_half_angle: f64,
    /// Half of the pitch angle π/z, in rad.
    half_pitch: f64,
    /// Radius of the rack's rounding, in m.
    rounding: f64,
    /// Depth of the rounding's centre below the reference circle, in m.
    centre_depth: f64,
    /// Distance of the rounding's centre from the centre line of the rack's tooth, in m.
    centre_offset: f64,
    /// The junction of fillet and involute.
    pub junction: Junction,
}

/// Thickness of a tooth at its tip circle in the normal section, in m: s_an = s_at cos β_a with
/// tan β_a = tan β r_a/r (ISO 21771).
pub(super) fn normal_tip_thickness(inputs: &Inputs, gear: &Gear, circles: &Circles) -> f64 {
    let slope = inputs.helix_angle.tan() * circles.tip / circles.reference;
    Profile::of(&Rack::of(inputs, gear), circles).tip_thickness() / slope.hypot(1.0)
}

/// The junction of fillet and involute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Junction {
    /// Angle of the rack's normal on the fillet at the junction, in rad; π/2 at the root.
    pub normal: f64,
    /// Roll angle of the involute at the junction, in rad.
    pub roll: f64,
    /// Whether the fillet cuts the involute off above the base circle.
    pub undercut: bool,
}

impl Profile {
    /// The profile that a rack with the standard tip rounding cuts.
    pub fn of(rack: &Rack, circles: &Circles) -> Profile {
        Profile::cut_by(rack, circles, RACK_ROUNDING)
    }

    /// The profile cut by a rack with a tip rounding of `rounding` modules. If the tip is too
    /// narrow, its rounding is the largest possible one.
    pub fn cut_by(rack: &Rack, circles: &Circles, rounding: f64) -> Profile {
        let flank = Profile::without_junction(rack, circles, rounding);
        Profile { junction: flank.find_junction(rack.pressure_angle), ..flank }
    }

    /// The profile without the search for the junction, for the involute alone.
    pub(super) fn of_flank(rack: &Rack, circles: &Circles) -> Profile {
        Profile::without_junction(rack, circles, RACK_ROUNDING)
    }

    fn without_junction(rack: &Rack, circles: &Circles, rounding: f64) -> Profile {
        let (module, alpha, shift) = (rack.module, rack.pressure_angle, rack.profile_shift);
        let half_pitch = PI / rack.teeth;
        let (sine, cosine) = alpha.sin_cos();
        let flank_room = PI / 4.0 - rack.dedendum * sine / cosine;
        let rounding = rack.fitting(rounding);
        Profile {
            circles: circles.sharp(),
            base_half_angle: half_pitch / 2.0
                + 2.0 * shift * alpha.tan() / rack.teeth
                + involute(alpha),
            half_pitch,
            rounding: rounding * module,
            centre_depth: (rack.dedendum - rounding - shift) * module,
            centre_offset: (flank_room - rounding * (1.0 - sine) / cosine) * module,
            junction: Junction { normal: alpha, roll: 0.0, undercut: false },
        }
    }

    /// Half of the pitch angle π/z, in rad.
    pub fn half_pitch(&self) -> f64 {
        self.half_pitch
    }

    /// Half of the tooth's angle at the base circle, in rad, for flanks without undercut.
    pub fn base_half_angle(&self) -> f64 {
        self.base_half_angle
    }

    /// The circles of the gear.
    pub fn circles(&self) -> &Circles {
        &self.circles
    }

    /// Half of the tooth's angle at the root circle, in rad.
    pub fn root_half_angle(&self) -> f64 {
        self.half_pitch - self.centre_offset / self.circles.reference
    }

    /// Roll angle of the involute at a radius, √(radius² − r_b²)/r_b, in rad.
    pub fn roll_at(&self, radius: f64) -> f64 {
        let base = self.circles.base;
        ((radius - base).max(0.0) * (radius + base)).sqrt() / base
    }

    /// Angle between the force on the flank and the normal of the tooth's centre line at a roll
    /// angle, in rad.
    pub fn load_angle(&self, roll: f64) -> f64 {
        roll - self.base_half_angle
    }

    /// Depth from the flank to the centre line along the line of force at a radius, in m.
    pub fn depth_along_force(&self, radius: f64) -> f64 {
        let roll = self.roll_at(radius);
        self.involute_at(roll).half_thickness / self.load_angle(roll).cos()
    }

    /// Radius of the junction: the form circle of the tooth, in m.
    pub fn form_radius(&self) -> f64 {
        self.circles.base.hypot(self.circles.base * self.junction.roll)
    }

    /// Half of the tooth's angle at the involute's roll angle, in rad; negative beyond the
    /// intersection of the flanks.
    pub(super) fn half_angle(&self, roll: f64) -> f64 {
        self.base_half_angle - roll + roll.atan()
    }

    /// Roll angle of the involute on the tip circle, in rad.
    pub(super) fn tip_roll(&self) -> f64 {
        self.circles.tip_curvature / self.circles.base
    }

    /// Thickness of the tooth at its tip circle, in m; negative if the flanks meet below.
    pub fn tip_thickness(&self) -> f64 {
        2.0 * self.circles.tip * self.half_angle(self.tip_roll())
    }

    /// Roll angle at which the involute ends, in rad: on the tip circle, or before at the
    /// intersection of the flanks.
    pub(super) fn flank_end(&self) -> f64 {
        let tip = self.tip_roll();
        last_where(self.junction.roll.min(tip), tip, |roll| self.half_angle(roll) >= 0.0)
    }

    /// Angle of the rack's normal at which the fillet ends, in rad: at the junction, or before on
    /// the tip circle.
    pub(super) fn fillet_end(&self) -> f64 {
        -last_where(-FRAC_PI_2, -self.junction.normal, |normal| {
            self.fillet_at(-normal).radius() <= self.circles.tip
        })
    }

    /// The involute at a roll angle: the point at the end of the tangent unwound from the base
    /// circle.
    pub fn involute_at(&self, roll: f64) -> Section {
        let base = self.circles.base;
        let (sine, cosine) = self.load_angle(roll).sin_cos();
        Section {
            along: base * (cosine + roll * sine),
            half_thickness: base * (roll * cosine - sine),
            slope: base * roll * cosine,
        }
    }

    /// The fillet point with the angle `normal` of the rack's normal, π/2 at the root.
    ///
    /// # Source
    /// Rolling of the rack's line on the reference circle: every normal passes through the pitch
    /// point (Litvin 1994, "Gear Geometry and Applied Theory").
    pub fn fillet_at(&self, normal: f64) -> Section {
        let (radius, depth) = (self.circles.reference, self.centre_depth);
        let (sine, cosine) = normal.sin_cos();
        let reach = self.rounding + depth / sine;
        let reach_slope = -depth * cosine / (sine * sine);
        let (across, up) = (-reach * cosine, radius - reach * sine);
        let (across_slope, up_slope) =
            (-reach_slope * cosine + reach * sine, -reach_slope * sine - reach * cosine);
        let turn = (self.centre_offset - depth * cosine / sine) / radius - self.half_pitch;
        let turn_slope = depth / (sine * sine) / radius;
        let (turn_sine, turn_cosine) = turn.sin_cos();
        let half_thickness = across * turn_cosine - up * turn_sine;
        Section {
            along: across * turn_sine + up * turn_cosine,
            half_thickness,
            slope: across_slope * turn_sine + up_slope * turn_cosine + turn_slope * half_thickness,
        }
    }

    /// Product of the fillet's radius and its change with the angle of the rack's normal, in m².
    ///
    /// # Formula
    /// ```text
    /// r² = l² + R² − 2 R (e sin t + h),  l = e + h/sin t
    /// ```
    pub fn fillet_rise(&self, normal: f64) -> f64 {
        let (sine, cosine) = normal.sin_cos();
        let reach = self.rounding + self.centre_depth / sine;
        let reach_slope = -self.centre_depth * cosine / (sine * sine);
        reach * reach_slope - self.circles.reference * self.rounding * cosine
    }

    /// The junction of fillet and involute: the end of the rack's flank, or the crossing on an
    /// undercut tooth.
    fn find_junction(&self, alpha: f64) -> Junction {
        let base = self.circles.base;
        let (sine, _) = alpha.sin_cos();
        let roll =
            (self.circles.reference * sine - self.rounding - self.centre_depth / sine) / base;
        if roll >= 0.0 {
            return Junction { normal: alpha, roll, undercut: false };
        }
        let normal = self.crossing(alpha);
        let section = self.fillet_at(normal);
        Junction { normal, roll: self.roll_at(section.radius()), undercut: true }
    }

    /// The angle of the rack's normal where the fillet of an undercut tooth crosses the involute,
    /// by bisection.
    fn crossing(&self, alpha: f64) -> f64 {
        const SAMPLES: usize = 64;
        const HALVINGS: usize = 50;
        let at = |step: usize| FRAC_PI_2 - (FRAC_PI_2 - alpha) * step as f64 / SAMPLES as f64;
        let Some(step) = (1..=SAMPLES).find(|&step| self.outside_involute(at(step))) else {
            return alpha;
        };
        let (mut outside, mut inside) = (at(step), at(step - 1));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (outside + inside);
            if self.outside_involute(middle) {
                outside = middle;
            } else {
                inside = middle;
            }
        }
        0.5 * (outside + inside)
    }

    /// Whether the fillet is above the base circle and outside of the involute.
    fn outside_involute(&self, normal: f64) -> bool {
        let section = self.fillet_at(normal);
        let radius = section.radius();
        radius > self.circles.base
            && section.half_thickness.atan2(section.along) > self.half_angle(self.roll_at(radius))
    }
}

/// Tip rounding of the standard basic rack, in modules (ISO 53, profile A).
pub const RACK_ROUNDING: f64 = 0.38;

/// The rack that cuts a gear: the inputs of the tooth profile besides its circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rack {
    /// Module m, in m.
    pub module: f64,
    /// Pressure angle α, in rad.
    pub pressure_angle: f64,
    /// Number of teeth z of the gear.
    pub teeth: f64,
    /// Profile shift coefficient x.
    pub profile_shift: f64,
    /// Dedendum coefficient h_fP*.
    pub dedendum: f64,
    /// Tip rounding in modules, if the tip is wide enough.
    pub rounding: f64,
}

impl Rack {
    /// The rack of a gear of the pair in the transverse section.
    pub fn of(inputs: &Inputs, gear: &Gear) -> Rack {
        let (shape, transverse) = (inputs.gear_shape(gear), inputs.transverse_pressure_angle());
        // The rounding has the height of that of the normal section.
        let height = |angle: f64| 1.0 - angle.sin();
        let is_spur = inputs.helix_angle == 0.0;
        let steeper =
            if is_spur { 1.0 } else { height(inputs.pressure_angle) / height(transverse) };
        Rack {
            module: inputs.transverse_module(),
            pressure_angle: transverse,
            teeth: gear.teeth.into(),
            profile_shift: shape.profile_shift,
            dedendum: shape.dedendum,
            rounding: RACK_ROUNDING * inputs.helix_cosine() * steeper,
        }
    }

    /// Radius of the rack's tip rounding, in modules.
    fn rounding(&self) -> f64 {
        self.fitting(self.rounding)
    }

    /// The given rounding, or the largest one that fits the tip, in modules.
    fn fitting(&self, rounding: f64) -> f64 {
        let (sine, cosine) = self.pressure_angle.sin_cos();
        let room = (PI / 4.0 * cosine - self.dedendum * sine) / (1.0 - sine);
        rounding.min(room).max(0.0)
    }

    /// Least profile shift without undercut, h_fP* − ρ_fP* (1 − sin α) − z sin²α/2.
    pub fn least_shift(&self) -> f64 {
        let sine = self.pressure_angle.sin();
        self.dedendum - self.rounding() * (1.0 - sine) - self.teeth * sine * sine / 2.0
    }
}

/// A section of the tooth across its centre line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Distance from the gear's centre along the centre line, in m.
    pub along: f64,
    /// Half of the thickness, in m.
    pub half_thickness: f64,
    /// Change of `along` with the parameter.
    pub slope: f64,
}

impl Section {
    fn radius(&self) -> f64 {
        self.along.hypot(self.half_thickness)
    }

    /// The end of the section on the flank, y above 0.
    pub fn point(&self) -> Point2<f64> {
        Point2::new(self.along, self.half_thickness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    /// Profiles of ordinary, shifted and undercut teeth, with the module.
    fn profiles() -> Vec<(String, Profile, f64)> {
        let mut found = Vec::new();
        for (teeth, shift, degrees) in [
            (20, 0.0, 20.0),
            (12, 0.5, 20.0),
            (100, -0.3, 20.0),
            (40, 1.1, 20.0),
            (9, 0.0, 20.0),
            (12, -0.2, 20.0),
            (30, 0.2, 30.0),
            (25, 0.0, 14.5),
        ] {
            let mut inputs = standard_pair(teeth, 60, 5e-3);
            inputs.driven.addendum = 0.3;
            inputs.pressure_angle = f64::to_radians(degrees);
            inputs.driver.profile_shift = shift;
            let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
            found.push((
                format!("z {teeth} x {shift} alpha {degrees}"),
                Profile::of(&Rack::of(&inputs, &inputs.driver), &circles),
                inputs.module,
            ));
        }
        found
    }

    #[test]
    fn fillet_meets_the_involute_at_the_junction() {
        for (name, profile, module) in profiles() {
            let fillet = profile.fillet_at(profile.junction.normal);
            let flank = profile.involute_at(profile.junction.roll);
            let gap =
                (fillet.along - flank.along).hypot(fillet.half_thickness - flank.half_thickness);
            assert!(gap < 1e-9 * module, "{name}: {gap:e} m apart, {:?}", profile.junction);
        }
    }

    #[test]
    fn teeth_below_the_limit_are_undercut() {
        let undercut: Vec<_> = profiles()
            .into_iter()
            .filter(|(_, profile, _)| profile.junction.undercut)
            .map(|(name, ..)| name)
            .collect();
        assert_eq!(undercut, ["z 9 x 0 alpha 20", "z 12 x -0.2 alpha 20", "z 25 x 0 alpha 14.5"]);
    }

    #[test]
    fn fillet_starts_on_the_root_circle() {
        for (name, profile, module) in profiles() {
            let root = profile.fillet_at(FRAC_PI_2);
            let radius = root.along.hypot(root.half_thickness);
            assert!(
                (radius - profile.circles.root).abs() < 1e-12 * module,
                "{name}: root at {radius}"
            );
            let angle = root.half_thickness.atan2(root.along);
            assert!(
                (angle - profile.root_half_angle()).abs() < 1e-12,
                "{name}: half angle {angle}"
            );
        }
    }

    #[test]
    fn thickness_at_the_reference_circle_agrees_with_the_rack() {
        for (name, profile, module) in profiles() {
            let section = profile.involute_at(profile.roll_at(profile.circles.reference));
            let angle = section.half_thickness.atan2(section.along);
            let twice = 2.0 * profile.half_pitch - 2.0 * angle;
            let shift = (profile.circles.reference - profile.circles.root) / module - 1.25;
            let alpha = (profile.circles.base / profile.circles.reference).acos();
            let space = profile.circles.reference * twice / module;
            assert!(
                (space - (PI / 2.0 + 2.0 * shift * alpha.tan())).abs() < 1e-9,
                "{name}: space {space}"
            );
        }
    }

    #[test]
    fn slopes_are_the_derivatives() {
        const STEP: f64 = 1e-6;
        for (name, profile, module) in profiles() {
            for part in [0.1, 0.5, 0.9] {
                let normal = profile.junction.normal + part * (FRAC_PI_2 - profile.junction.normal);
                let rise =
                    profile.fillet_at(normal + STEP).along - profile.fillet_at(normal - STEP).along;
                assert!(
                    (rise / (2.0 * STEP) - profile.fillet_at(normal).slope).abs() < 1e-6 * module,
                    "{name}: fillet at {normal}"
                );
                let roll = profile.junction.roll + part * 0.1;
                let rise =
                    profile.involute_at(roll + STEP).along - profile.involute_at(roll - STEP).along;
                assert!(
                    (rise / (2.0 * STEP) - profile.involute_at(roll).slope).abs() < 1e-6 * module,
                    "{name}: involute at {roll}"
                );
            }
        }
    }
}
