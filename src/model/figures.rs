//! The figures of ISO 21771, ISO 6336-1 and Hertz that engineers expect beside the corner contact.

use std::f64::consts::PI;

use super::deviation::{Origin, form_tolerance};
use super::inputs::{Gear, Inputs};
use super::position::{reduced_curvature, tip_at};
use super::profile::{Profile, Rack};
use super::{Geometry, Solution, Station};

/// Figures of the pair. Values of both gears are in the order driver, driven gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// Common face width, in m.
    pub width: f64,
    /// Thickness of the teeth at the reference circle, in m.
    pub tooth_thickness: [f64; 2],
    /// Thickness of the teeth between their flanks at the tip circle, in m.
    pub tip_thickness: [f64; 2],
    /// Distance of the tip circle from the root circle of the other gear, in m.
    pub tip_clearance: [f64; 2],
    /// F_t at the reference circle, in N.
    pub tangential_force: f64,
    /// Speed of the reference circles, in m/s.
    pub pitch_line_speed: f64,
    /// Sliding velocity at E and at B, in m/s.
    pub sliding: [f64; 2],
    /// Hertz pressure at the pitch point under the mesh force, in Pa.
    pub pitch_pressure: f64,
    /// Stiffness of the teeth by ISO 6336-1.
    pub stiffness: IsoStiffness,
    /// Dynamic factor of ISO 6336-1.
    pub dynamic: IsoDynamic,
}

impl Figures {
    /// The figures of a pair under a mesh force in N, with a reduced mass in kg.
    pub fn of(inputs: &Inputs, geometry: &Geometry, mesh_force: f64, mass: f64) -> Figures {
        let gears = [(&inputs.driver, &geometry.driver), (&inputs.driven, &geometry.driven)];
        let [driver, driven] = gears.map(|(gear, circles)| {
            let thickness = Profile::of_flank(&Rack::of(inputs, gear), circles).tip_thickness();
            (thickness, circles.tip + gear.tip_chamfer, circles.root)
        });
        let (base, width) = (geometry.driver.base, inputs.common_width());
        let tangential_force = mesh_force * base / geometry.driver.reference;
        let sliding = |along: f64| {
            inputs.driven_speed() * (geometry.tangent_length - along) - inputs.speed * along
        };
        let pitch = base * geometry.tangent_length / (base + geometry.driven.base);
        let line_load = tangential_force / width;
        let stiffness = IsoStiffness::of(inputs, geometry.contact_ratio, line_load);
        let helix = inputs.helix(geometry, mesh_force);
        let normal = inputs.base_helix_angle().cos().recip();
        let thickness = |gear: &Gear| {
            let shifted = 2.0 * gear.profile_shift * inputs.pressure_angle.tan();
            inputs.transverse_module() * (0.5 * PI + shifted)
        };
        Figures {
            width,
            tooth_thickness: [&inputs.driver, &inputs.driven].map(thickness),
            tip_thickness: [driver.0, driven.0],
            tip_clearance: [
                geometry.centre_distance - driver.1 - driven.2,
                geometry.centre_distance - driven.1 - driver.2,
            ],
            tangential_force,
            pitch_line_speed: inputs.speed * geometry.driver.reference,
            sliding: [geometry.start, geometry.end].map(sliding),
            pitch_pressure: Hertz::of(inputs).pressure(
                mesh_force * pitch_share(geometry.contact_ratio, helix.overlap_ratio),
                normal * pitch * (1.0 - pitch / geometry.tangent_length),
            ),
            stiffness,
            dynamic: IsoDynamic::of(
                inputs,
                geometry.contact_ratio + helix.overlap_ratio,
                line_load,
                &stiffness,
                mass,
            ),
        }
    }
}

/// Part of the mesh force on a contact line as long as the face is wide over cos β_b.
///
/// # Formula
/// ```text
/// 1 − ε_β + ε_β/ε_α up to ε_β = 1, then 1/ε_α
/// ```
///
/// # Source
/// Z_ε² of ISO 6336-2:2019, clause 8, with one pair in contact of a spur pair in place of (4 − ε_α)/3.
///
/// # Valid for
/// ε_α >= 1. In the moment with the least length of contact lines the share is up to 1.21 times as
/// large, at ε_α = 1.4 and ε_β = 0.6.
pub fn pitch_share(contact_ratio: f64, overlap_ratio: f64) -> f64 {
    let overlap = overlap_ratio.min(1.0);
    1.0 - overlap + overlap / contact_ratio
}

/// The stiffness of the teeth per width by ISO 6336-1, method B, in N/m².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsoStiffness {
    /// Theoretical single stiffness c'_th.
    pub theoretical: f64,
    /// Factor of the basic rack C_B.
    pub rack: f64,
    /// Single stiffness c'.
    pub single: f64,
    /// Mesh stiffness c_γα.
    pub mesh: f64,
}

/// Young's modulus of the steel of ISO 6336-1, in Pa.
const STEEL: f64 = 206e9;
/// Line load in N/m below which c' decreases.
const LOW_LOAD: f64 = 100e3;

impl IsoStiffness {
    fn of(inputs: &Inputs, contact_ratio: f64, line_load: f64) -> IsoStiffness {
        let gears = [&inputs.driver, &inputs.driven];
        let [driver, driven] = gears.map(|gear| gear.young);
        let ratio = 2.0 * driver * driven / ((driver + driven) * STEEL);
        let theoretical = theoretical_stiffness(
            gears.map(|gear| inputs.virtual_teeth(gear)),
            gears.map(|gear| gear.profile_shift),
        );
        let dedendums = gears.map(|gear| inputs.dedendum_of(gear));
        let rack = rack_factor(dedendums, inputs.pressure_angle);
        let single = single_stiffness(theoretical, rack, inputs.helix_cosine())
            * ratio
            * low_load(line_load);
        IsoStiffness { theoretical, rack, single, mesh: mesh_stiffness(single, contact_ratio) }
    }
}

/// Theoretical single stiffness c'_th of two gears with virtual numbers of teeth z_n, in N/m².
///
/// # Formula
/// ```text
/// c'_th = 1/q',   q' = C1 + C2/z_n1 + C3/z_n2 + C4 x1 + C5 x1/z_n1 + C6 x2 + C7 x2/z_n2
///                      + C8 x1² + C9 x2²   in mm µm/N, 1 the gear with fewer teeth
/// ```
///
/// # Source
/// ISO 6336-1:2019, clause 9 (tooth stiffness parameters), method B.
///
/// # Valid for
/// −0.5 <= x1 + x2 <= 2, x1 >= x2, line loads of 100 to 1600 N/mm.
pub fn theoretical_stiffness(virtual_teeth: [f64; 2], shifts: [f64; 2]) -> f64 {
    let swapped = usize::from(virtual_teeth[0] > virtual_teeth[1]);
    let ([z1, z2], [x1, x2]) = (
        [virtual_teeth[swapped], virtual_teeth[1 - swapped]],
        [shifts[swapped], shifts[1 - swapped]],
    );
    let give = 0.04723 + 0.15551 / z1 + 0.25791 / z2
        - 0.00635 * x1
        - 0.11654 * x1 / z1
        - 0.00193 * x2
        - 0.24188 * x2 / z2
        + 0.00529 * x1 * x1
        + 0.00182 * x2 * x2;
    1e9 / give
}

/// Factor C_B of the basic rack: the mean of (1 + 0.5 (1.2 − h_fP*)) (1 − 0.02 (20° − α_n)) of both
/// gears, with the normal pressure angle in rad (ISO 6336-1:2019, clause 9).
pub fn rack_factor(dedendums: [f64; 2], pressure_angle: f64) -> f64 {
    let depth = 1.0 + 0.25 * (2.4 - dedendums[0] - dedendums[1]);
    depth * (1.0 - 0.02 * (20.0 - pressure_angle.to_degrees()))
}

/// Single stiffness of steel gears c' = c'_th C_M C_R C_B cos β in N/m², with C_M = 0.8 and C_R = 1 of
/// a solid gear (ISO 6336-1:2019, clause 9).
pub fn single_stiffness(theoretical: f64, rack: f64, cos_helix_angle: f64) -> f64 {
    const MEASURED: f64 = 0.8;
    theoretical * MEASURED * rack * cos_helix_angle
}

/// Mesh stiffness c_γα = c' (0.75 ε_α + 0.25), in N/m² (ISO 6336-1:2019, clause 9).
pub fn mesh_stiffness(single: f64, contact_ratio: f64) -> f64 {
    single * (0.75 * contact_ratio + 0.25)
}

/// The factor of c' for a line load in N/m below 100 N/mm, (F_t/b/100)^(1/4).
fn low_load(line_load: f64) -> f64 {
    (line_load / LOW_LOAD).min(1.0).sqrt().sqrt()
}

/// The dynamic factor of ISO 6336-1, method B, and its terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsoDynamic {
    /// Base pitch deviation f_pb,eff, in m.
    pub pitch: f64,
    /// Profile form deviation f_fα,eff, in m.
    pub form: f64,
    /// Resonance ratio N with c_γα.
    pub resonance_ratio: f64,
    /// Resonance ratio N_S at which the main resonance begins.
    pub resonance_begin: f64,
    /// B_p, B_f and B_k.
    pub terms: [f64; 3],
    /// K_v.
    pub factor: f64,
}

/// Resonance ratio at the end of the main resonance, and at the begin of the supercritical range.
pub const RESONANCE_ENDS: [f64; 2] = [1.15, 1.5];

/// Lowest class of ISO 1328-1 in which ISO 6336-1 counts a tip relief.
pub const RELIEF_CLASS: u32 = 5;

impl Inputs {
    /// The flank tolerance class of a gear if it gives the base pitch deviation.
    pub fn class_of(&self, gear: &Gear) -> Option<u32> {
        gear.grade.filter(|_| self.base_pitch_of(gear).1 == Origin::Grade)
    }

    /// Profile form deviation of a gear in m: by its class, otherwise as large as its base pitch
    /// deviation.
    fn form_of(&self, gear: &Gear) -> f64 {
        let pitch = self.base_pitch_of(gear).0.abs();
        self.class_of(gear).map_or(pitch, |class| form_tolerance(class, self.module))
    }

    /// Whether ISO 6336-1 counts the tip relief: no gear has a class above 5.
    pub fn counts_relief(&self) -> bool {
        [&self.driver, &self.driven]
            .iter()
            .all(|gear| self.class_of(gear).is_none_or(|class| class <= RELIEF_CLASS))
    }
}

impl IsoDynamic {
    /// The dynamic factor at a line load in N/m without K_A, with a reduced mass in kg.
    ///
    /// # Formula
    /// ```text
    /// N = ω1 z1 √(m_red/(c_γα b)),   N_S = 0.5 + 0.35 √(F_t/b/100) up to 0.85
    /// B_p = c' f_pb/(F_t/b),   B_f = c' f_fα/(F_t/b),   B_k = |1 − c' C_a/(F_t/b)|
    /// ```
    /// [`dynamic_factor`] has K_v. Without allowances for running-in.
    ///
    /// # Source
    /// ISO 6336-1:2019, 6.5.
    fn of(
        inputs: &Inputs,
        contact_ratio: f64,
        line_load: f64,
        stiffness: &IsoStiffness,
        mass: f64,
    ) -> IsoDynamic {
        let gears = [&inputs.driver, &inputs.driven];
        let largest = |values: [f64; 2]| values[0].max(values[1]);
        let pitch = largest(inputs.base_pitches().map(f64::abs));
        let form = largest(gears.map(|gear| inputs.form_of(gear)));
        let relief = inputs.driven.tip_relief + inputs.driver.root_relief;
        let over_load = |length: f64| stiffness.single * length / line_load;
        let relieved = if inputs.counts_relief() { over_load(relief) } else { 0.0 };
        let terms = [over_load(pitch), over_load(form), (1.0 - relieved).abs()];
        let width = inputs.common_width();
        let resonance_ratio = inputs.speed
            * f64::from(inputs.driver.teeth)
            * (mass / (stiffness.mesh * width)).sqrt();
        let resonance_begin = 0.5 + 0.35 * (line_load / LOW_LOAD).min(1.0).sqrt();
        let factor = dynamic_factor(contact_ratio, resonance_ratio, resonance_begin, terms);
        IsoDynamic { pitch, form, resonance_ratio, resonance_begin, terms, factor }
    }
}

/// The dynamic factor K_v at a resonance ratio N with a total contact ratio, the begin N_S of the main
/// resonance, and the terms B_p, B_f, B_k.
///
/// # Formula
/// ```text
/// N <= N_S:   K_v = 1 + N (C_v1 B_p + C_v2 B_f + C_v3 B_k)
/// N <= 1.15:  K_v = 1 + C_v1 B_p + C_v2 B_f + C_v4 B_k
/// N >= 1.5:   K_v = C_v5 B_p + C_v6 B_f + C_v7
/// between 1.15 and 1.5 on the straight line
/// ```
///
/// # Source
/// ISO 6336-1:2019, 6.5, with the table of C_v1 to C_v7.
pub fn dynamic_factor(contact_ratio: f64, ratio: f64, begin: f64, terms: [f64; 3]) -> f64 {
    let [pitch, form, relief] = terms;
    let few = contact_ratio <= 2.0;
    let by = |constant: f64, many: f64| if few { constant } else { many };
    let form_share = by(0.34, 0.57 / (contact_ratio - 0.3));
    let below = by(0.23, 0.096 / (contact_ratio - 1.56));
    let within = by(0.9, (0.57 - 0.05 * contact_ratio) / (contact_ratio - 1.44));
    let above = by(0.47, 0.12 / (contact_ratio - 1.74));
    let rest = match contact_ratio {
        few if few <= 1.5 => 0.75,
        some if some <= 2.5 => 0.125 * (PI * (some - 2.0)).sin() + 0.875,
        _ => 1.0,
    };
    let [end, supercritical] = RESONANCE_ENDS;
    let deviations = 0.32 * pitch + form_share * form;
    let main = 1.0 + deviations + within * relief;
    let beyond = 0.47 * pitch + above * form + rest;
    if ratio <= begin {
        1.0 + ratio * (deviations + below * relief)
    } else if ratio <= end {
        main
    } else if ratio >= supercritical {
        beyond
    } else {
        beyond + (main - beyond) * (supercritical - ratio) / (supercritical - end)
    }
}

/// What a contact needs besides force and curvature for its Hertz pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// 1/E', in 1/Pa.
    give: f64,
    /// Common face width, in m.
    width: f64,
    /// cos β_b: the radii of curvature of the normal section are greater than those of the transverse
    /// section by its reciprocal.
    oblique: f64,
    /// Radii of the tip edges of driver and driven gear, in m.
    tip_radii: [Option<f64>; 2],
}

impl Hertz {
    /// The contact of a pair.
    pub fn of(inputs: &Inputs) -> Hertz {
        let give = |gear: &Gear| (1.0 - gear.poisson * gear.poisson) / gear.young;
        Hertz {
            give: give(&inputs.driver) + give(&inputs.driven),
            width: inputs.common_width(),
            oblique: inputs.base_helix_angle().cos(),
            tip_radii: [inputs.driver.tip_radius, inputs.driven.tip_radius],
        }
    }

    /// The greatest pressure of two cylinders under a force in N, with a reduced radius of curvature
    /// in m: √(F E'/(π b ρ)), in Pa (Hertz 1882).
    pub fn pressure(&self, force: f64, curvature: f64) -> f64 {
        (force / (PI * self.width * curvature * self.give)).sqrt()
    }

    /// The pressure under a transverse line load over the reduced radius of curvature of the transverse
    /// section, in N/m²: √(w cos β_b E'/(π ρ_t)), in Pa.
    fn of_line(&self, load_over_curvature: f64) -> f64 {
        (load_over_curvature * self.oblique / (PI * self.give)).sqrt()
    }
}

impl Solution {
    /// Whether the tips that can strike have sharp edges: that of the driven gear, and with a shared load
    /// that of the driver after B.
    pub fn has_sharp_tips(&self) -> bool {
        let [driver, driven] = self.kept.hertz.tip_radii;
        driven.is_none() && (driver.is_none() || !self.method.shares_load())
    }

    /// The Hertz pressure at a station, in Pa: of both flanks from E to B, and of the rounded tip edge
    /// on the flank before E and after B. `None` at a sharp edge, where no pressure is finite. In slices
    /// the greatest pressure of both flanks over the face width.
    pub fn pressure(&self, station: &Station) -> Option<f64> {
        let (geometry, hertz) = (&self.geometry, &self.kept.hertz);
        if self.has_slices() {
            return station.load_over_curvature().map(|load| hertz.of_line(load));
        }
        let along = geometry.start - station.roll_angle_driver * geometry.driver.base;
        let curvature = if station.roll_angle_driven > 0.0 {
            let radius = hertz.tip_radii[1]?;
            reduced_curvature(Some(radius), geometry, &tip_at(geometry, station.roll_angle_driven))
        } else if along <= geometry.end * (1.0 + f64::EPSILON) {
            along * (geometry.tangent_length - along) / geometry.tangent_length
        } else {
            let radius = hertz.tip_radii[0]?;
            let flank = geometry.flank_at_driver_tip((along - geometry.end) / geometry.driver.base);
            flank * radius / (flank + radius)
        };
        (curvature > 0.0).then(|| hertz.pressure(station.force, curvature))
    }
}

impl Geometry {
    /// Radius of curvature of the driven flank under the driver's tip, in m, at the driver's angle
    /// after B in rad.
    fn flank_at_driver_tip(&self, angle: f64) -> f64 {
        let centre = self.driver.tip - self.driver.edge;
        let polar = (self.driver.base / centre).acos() - self.working_pressure_angle + angle;
        let away = self.centre_distance - centre * polar.cos();
        self.driven.curvature_at(away.hypot(centre * polar.sin())) - self.driver.edge
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::profile::normal_tip_thickness;
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};

    fn assert_near(found: f64, expected: f64, digits: i32) {
        let off = (found / expected - 1.0).abs();
        assert!(off < 10f64.powi(-digits), "{found} for {expected}");
    }

    /// ISO/TR 6336-30:2017, example 1: m_n 8 mm, z 17/103, x 0.145/0, beta 15.8 deg, h_fP* 1.4, published
    /// c'_th 17.85584, c' 12.37047, c_γα 17.46485 N/(mm µm).
    #[test]
    fn the_stiffness_of_a_published_helical_pair_is_reproduced() {
        let (beta, alpha) = (15.8f64.to_radians(), 20f64.to_radians());
        let base_cos = 1.0 - (beta.sin() * alpha.cos()).powi(2);
        let virtual_teeth = [17.0, 103.0].map(|teeth| teeth / (base_cos * beta.cos()));
        assert_near(virtual_teeth[0], 18.905, 4);
        let theoretical = theoretical_stiffness(virtual_teeth, [0.145, 0.0]);
        assert_near(theoretical, 17.85584e9, 6);
        let swapped = theoretical_stiffness([virtual_teeth[1], virtual_teeth[0]], [0.0, 0.145]);
        assert_near(swapped, theoretical, 14);
        let single = single_stiffness(theoretical, rack_factor([1.4, 1.4], alpha), beta.cos());
        assert_near(single, 12.37047e9, 6);
        // Transverse contact ratio of the pair with a = 500 mm.
        let transverse = (alpha.tan() / beta.cos()).atan();
        let working = {
            let bases = 8.0 / beta.cos() * 60.0 * transverse.cos();
            (bases / 500.0).acos()
        };
        let path = |teeth: f64, shift: f64| {
            let reference = 4.0 * teeth / beta.cos();
            let tip = reference + 8.0 * (1.0 + shift);
            let base = reference * transverse.cos();
            ((tip * tip - base * base).sqrt(), base)
        };
        let ((one, base), (other, other_base)) = (path(17.0, 0.145), path(103.0, 0.0));
        let length = one + other - (base + other_base) * working.tan();
        let ratio = length / (PI * 8.0 / beta.cos() * transverse.cos());
        assert_near(mesh_stiffness(single, ratio), 17.46485e9, 3);
    }

    /// K_v by hand, with B_p = 0.5, B_f = 0.3, B_k = 0.4.
    #[test]
    fn the_dynamic_factor_has_four_ranges_without_jumps_beyond_the_main_resonance() {
        let of = |contact_ratio, ratio| dynamic_factor(contact_ratio, ratio, 0.85, [0.5, 0.3, 0.4]);
        assert_near(of(1.6, 0.5), 1.0 + 0.5 * (0.16 + 0.102 + 0.092), 14);
        assert_near(of(1.6, 1.0), 1.0 + 0.16 + 0.102 + 0.36, 14);
        let beyond = 0.235 + 0.141 + 0.875 - 0.125 * (0.4 * PI).sin();
        assert_near(of(1.6, 2.0), beyond, 14);
        assert_near(of(1.6, 1.325), f64::midpoint(1.622, beyond), 14);
        assert_near(of(1.6, 1.15 + 1e-12), of(1.6, 1.15), 10);
        assert_near(of(1.4, 3.0), 0.235 + 0.141 + 0.75, 14);
        let many = 1.0 + 0.5 * (0.16 + 0.57 / 2.3 * 0.3 + 0.096 / 1.04 * 0.4);
        assert_near(of(2.6, 0.5), many, 14);
    }

    /// The contact stress of ISO 6336-2 without its factors, Z_H Z_E √(F_t/(d1 b) (u + 1)/u), is the
    /// pressure at the pitch point.
    #[test]
    fn the_pressure_at_the_pitch_point_is_the_contact_stress_of_the_standard() {
        let mut inputs = standard_pair(20, 31, 5e-3);
        (inputs.driver.profile_shift, inputs.driven.profile_shift) = (0.2, 0.1);
        let solution = solve(&inputs, Stages::of(Stage::Figures)).unwrap();
        let (alpha, working) = (inputs.pressure_angle, solution.geometry.working_pressure_angle);
        let zone = (2.0 * working.cos() / (alpha.cos().powi(2) * working.sin())).sqrt();
        let elastic = (206e9 / (PI * 2.0 * (1.0 - 0.09))).sqrt();
        let (force, diameter, ratio) = (100.0 / 0.05, 0.1_f64, 31.0 / 20.0_f64);
        let stress = zone * elastic * (force / (diameter * 10e-3) * (ratio + 1.0) / ratio).sqrt();
        let figures = solution.figures.unwrap();
        assert_near(figures.pitch_pressure, stress, 12);
        assert_near(figures.tangential_force, 2000.0, 12);
        assert_near(figures.pitch_line_speed, PI * 0.1 * 1000.0 / 60.0, 12);
    }

    #[test]
    fn the_pressure_at_the_pitch_point_starts_from_that_of_a_spur_pair() {
        let pressure = |degrees: f64| {
            let helix_angle = degrees.to_radians();
            let inputs = Inputs { helix_angle, ..standard_pair(20, 31, 5e-3) };
            solve(&inputs, Stages::of(Stage::Figures)).unwrap().figures.unwrap().pitch_pressure
        };
        assert!((pressure(1e-4) / pressure(0.0) - 1.0).abs() < 1e-5);
        assert_near(pitch_share(1.6, 0.5), 0.8125, 14);
        assert_near(pitch_share(1.6, 2.3), 1.0 / 1.6, 14);
    }

    /// z 20/20, m 5 mm, x = 0: c = 0.25 m; the tip thickness by the involute function.
    #[test]
    fn the_tips_of_a_standard_pair_have_the_figures_of_a_hand_calculation() {
        let inputs = standard_pair(20, 20, 5e-3);
        let solution = solve(&inputs, Stages::of(Stage::Figures)).unwrap();
        let figures = solution.figures.unwrap();
        assert_near(figures.tip_clearance[0], 1.25e-3, 10);
        let at_tip = (20.0 * inputs.pressure_angle.cos() / 22.0).acos();
        let involute = |angle: f64| angle.tan() - angle;
        let half = PI / 40.0 + involute(inputs.pressure_angle) - involute(at_tip);
        assert_near(figures.tip_thickness[1], 0.11 * half, 12);
        assert_near(figures.tooth_thickness[1], 2.5e-3 * PI, 12);
        let [entry, exit] = figures.sliding;
        assert_near(entry, -exit, 12);
        // EP on both sides of the pitch point, with twice the speed.
        let approach = solution.geometry.approach_length;
        assert_near(entry, 2.0 * inputs.speed * approach, 12);
    }

    /// z 20, m_n 5 mm, β 20 deg, x 0.5: the helix angle at the tip circle is 22.55 deg.
    #[test]
    fn a_helical_tooth_is_thinner_in_the_normal_section() {
        let mut inputs = Inputs { helix_angle: 20_f64.to_radians(), ..standard_pair(20, 20, 5e-3) };
        inputs.driver.profile_shift = 0.5;
        let solution = solve(&inputs, Stages::of(Stage::Figures)).unwrap();
        let reference = 50e-3 / 20_f64.to_radians().cos();
        let at_tip = (20_f64.to_radians().tan() * (reference + 7.5e-3) / reference).atan();
        let thickness = solution.figures.unwrap().tooth_thickness[0] * 20_f64.to_radians().cos();
        assert_near(thickness, 5e-3 * (PI / 2.0 + 20_f64.to_radians().tan()), 12);
        let normal = normal_tip_thickness(&inputs, &inputs.driver, &solution.geometry.driver);
        assert_near(normal, solution.figures.unwrap().tip_thickness[0] * at_tip.cos(), 12);
    }

    #[test]
    fn the_pressure_of_a_corner_needs_a_tip_radius_and_is_symmetric() {
        let mut inputs = standard_pair(20, 20, 5e-3);
        (inputs.driver.tip_radius, inputs.driven.tip_radius) = (Some(0.3e-3), Some(0.3e-3));
        inputs.driven.face_width *= 2.0;
        let solution = solve(&inputs, Stages::of(Stage::Figures)).unwrap();
        let geometry = &solution.geometry;
        let angle = 0.02;
        let tip = tip_at(geometry, angle);
        assert_near(geometry.flank_at_driver_tip(angle), tip.curvature_driver, 9);
        inputs.base_pitch_deviation = 16e-6;
        let impact = solve(&inputs, Stages::of(Stage::Impact)).unwrap().impact.unwrap();
        let position = solve(&inputs, Stages::of(Stage::Position)).unwrap().position.unwrap();
        let pressure = Hertz::of(&inputs).pressure(impact.force, position.curvature_radius);
        assert_near(impact.corner_pressure.unwrap(), pressure, 9);
        inputs.driven.tip_radius = None;
        let sharp = solve(&inputs, Stages::of(Stage::Impact)).unwrap().impact.unwrap();
        assert_eq!(sharp.corner_pressure, None);
    }

    #[test]
    fn a_class_above_five_leaves_the_relief_out_and_gives_the_form_deviation() {
        let mut inputs = standard_pair(20, 20, 5e-3);
        inputs.driven.tip_relief = 20e-6;
        let dynamic = |inputs: &Inputs| {
            solve(inputs, Stages::of(Stage::Figures)).unwrap().figures.unwrap().dynamic
        };
        let relieved = dynamic(&inputs).terms[2];
        assert!(relieved < 1.0);
        // At the entry the tip of the driven gear meets the root of the driver.
        (inputs.driver.root_relief, inputs.driven.tip_relief) = (15e-6, 5e-6);
        inputs.driver.tip_relief = 7e-6;
        assert_near(dynamic(&inputs).terms[2], relieved, 12);
        inputs.driver.grade = Some(7);
        let found = dynamic(&inputs);
        assert_near(found.terms[2], 1.0, 15);
        // (0.55 · 5 + 5) · 2 = 15.5, rounded to 16 µm (halves away from zero).
        assert_near(found.form, 16e-6, 12);
        assert_near(found.pitch, 14e-6 * inputs.pressure_angle.cos(), 12);
    }
}
