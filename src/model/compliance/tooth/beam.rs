//! Tooth compliance by the potential-energy method, with the foundation of the fillet.

use std::f64::consts::FRAC_PI_2;

use super::{Kind, ToothModel};
use crate::model::compliance::ElasticGear;
use crate::model::explanation::Formula::Words;
use crate::model::explanation::{Context, Finding, Step, four, step};
use crate::model::geometry::{Circles, Geometry};
use crate::model::inputs::{Gear, GearSide, Inputs, ToothCompliance};
use crate::model::profile::{Profile, Rack, Section};
use crate::model::{Refusal, field, geometry};
use crate::numeric::{quadrature, root};

/// The entry of the list.
pub const MODEL: ToothModel = ToothModel {
    name: "beam",
    index: "beam",
    range: "any tooth number, profile shift and pressure angle that leave a tooth",
    covers,
    why_outside: |_| "the beam finds no tooth at the load point".to_owned(),
    check,
    outside,
    chosen: "tooth-compliance-beam",
    reads_root: true,
    has_contact: false,
    has_coupling: false,
    steps: STEPS,
    tooth: |_, circles| Ok(Kind::Beam(*circles)),
};

impl ToothCompliance {
    /// Potential-energy method on the true profile, with the foundation of the fillet.
    pub const BEAM: ToothCompliance = ToothCompliance::named(MODEL.name);
}

const FORMULA: &str = "quadrature of bending, shear and compression over the tooth profile in plane strain, up to \
    the crossing of force and centre line (Weber & Banaschek 1953), plus the foundation (Sainsot, Velex & \
    Duverger 2004) less the twist of the body about its bore";

const STEPS: &[Step] = &[
    step("q_1", "driver's tooth loaded at O1D", "um mm/N", Words(FORMULA), |k| {
        Some(k.solution.compliance?.driver)
    }),
    step("q_2", "driven tooth loaded at its tip", "um mm/N", Words(FORMULA), |k| {
        Some(k.solution.compliance?.driven)
    }),
];

/// Relative tolerance of the quadrature.
const TOLERANCE: f64 = 1e-11;

/// Compliance of one tooth loaded at a radius, contact excluded, in m²/N.
///
/// # Formula
/// ```text
/// q = ∫ ((x_F − x)² cos² a1/I + sin² a1/A) (1 − ν²)/E + 1.2 cos² a1/(G A) dx + q_f
/// I = 2 hx³/3,  A = 2 hx,  G = E/(2 (1 + ν)),  x_F = r_b/cos a1
/// ```
/// q is per unit width. The force acts at the angle a₁ to the normal of the tooth's centre line. x
/// runs along the centre line from the root to the point x_F, where the force crosses it. h_x is
/// half of the thickness at x. If the force crosses below the junction of fillet and involute, the
/// sections between are subtracted with the thickness of the involute.
///
/// # Source
/// Weber & Banaschek 1953 ("Formänderung und Profilrücknahme bei gerad- und schrägverzahnten
/// Rädern"): plane strain, up to the crossing of force and centre line. The deformation between the
/// flank and this point belongs to the contact. Integrated over the true profile: the involute and
/// the trochoidal fillet of the cutting rack. q_f: see `foundation`.
///
/// # Valid for
/// Any tooth number, shift and pressure angle that leave a tooth. Linear elasticity of one tooth on
/// its own body, without the twist of the body about its bore. The compliance is 4 to 22 % above
/// the finite elements for bodies with r_f/r_h from 2 to 5 within the range of the foundation, and 50
/// to 200 % above it on thin rims and on the thick teeth of small gears.
///
/// # Errors
/// [`Refusal::PointedTip`] if the tooth has no thickness at the load point,
/// [`Refusal::BelowFormCircle`] if the load point is on the fillet, [`Refusal::CutThrough`] if the
/// undercut leaves no neck.
pub fn tooth(gear: &ElasticGear, circles: &Circles, radius: f64) -> Result<f64, Refusal> {
    tooth_within(gear, circles, radius, TOLERANCE)
}

/// [`tooth`] with a given relative tolerance of the quadrature.
fn tooth_within(
    gear: &ElasticGear,
    circles: &Circles,
    radius: f64,
    tolerance: f64,
) -> Result<f64, Refusal> {
    let profile = Profile::of(&gear.rack, circles);
    let roll = profile.roll_at(radius);
    if roll <= profile.junction.roll {
        return Err(Refusal::BelowFormCircle {
            gear: GearSide::Driver,
            radius,
            form: profile.form_radius(),
        });
    }
    let load = profile.involute_at(roll);
    if load.half_thickness <= 0.0 {
        return Err(Refusal::PointedTip {
            gear: GearSide::Driver,
            thickness: 2.0 * load.half_thickness,
        });
    }
    let angle = profile.load_angle(roll);
    let beam = Beam {
        crossing: circles.base / angle.cos(),
        sine: angle.sin(),
        cosine: angle.cos(),
        poisson: gear.poisson,
    };
    let fillet = quadrature::adaptive(profile.junction.normal, FRAC_PI_2, tolerance, |normal| {
        -beam.energy(&profile.fillet_at(normal))
    });
    let crossing = beam.crossing_roll(&profile, roll);
    let flank = quadrature::adaptive(profile.junction.roll, crossing, tolerance, |roll| {
        beam.energy(&profile.involute_at(roll))
    });
    let compliance = (fillet + flank + foundation(&profile, gear, circles, angle)) / gear.young;
    let has_neck = compliance.is_finite() && compliance > 0.0;
    if has_neck {
        Ok(compliance)
    } else {
        Err(Refusal::CutThrough { gear: GearSide::Driver, shift: gear.rack.profile_shift })
    }
}

/// A tooth as a cantilever under a force that crosses its centre line.
struct Beam {
    /// Distance of the crossing from the gear's centre, in m.
    crossing: f64,
    sine: f64,
    cosine: f64,
    poisson: f64,
}

impl Beam {
    /// Roll angle of the involute at the height of the crossing, for a load at the roll angle
    /// `roll`.
    fn crossing_roll(&self, profile: &Profile, roll: f64) -> f64 {
        // If the force is normal to the centre line, the section at the load has this height.
        let normal = roll - profile.load_angle(roll);
        let other = normal.max(2.0 * normal - roll);
        root::between(other, roll, |roll| profile.involute_at(roll).along - self.crossing)
    }

    /// Compliance times E of a section per unit of the profile parameter. Infinite if the section
    /// has no thickness.
    fn energy(&self, section: &Section) -> f64 {
        let half = section.half_thickness.max(0.0);
        let arm = (self.crossing - section.along) * self.cosine;
        let strain = plane_strain(self.poisson);
        let bending = strain * 1.5 * arm * arm / (half * half * half);
        let shear = 2.4 * (1.0 + self.poisson) * self.cosine * self.cosine;
        let straining = (shear + strain * self.sine * self.sine) / (2.0 * half);
        (bending + straining) * section.slope
    }
}

/// Ratio of the strain in plane strain to that in plane stress: 1 − ν².
fn plane_strain(poisson: f64) -> f64 {
    1.0 - poisson * poisson
}

/// r_f/r_bore for a gear without a bore.
const SOLID_BODY: f64 = 3.0;
/// ν of the coefficients of the foundation.
const FOUNDATION_POISSON: f64 = 0.3;
/// Fitted range of r_f/r_bore.
const FOUNDATION_BODY: (f64, f64) = (1.4, 7.0);
/// Fitted range of the half tooth angle at the root, in rad.
const FOUNDATION_ANGLE: (f64, f64) = (0.01, 0.12);

/// Whether the beam has a compliance at both tips.
fn covers(inputs: &Inputs) -> bool {
    let answers = |gear: &Gear| {
        let gear = ElasticGear::of(inputs, gear);
        let (module, alpha) = (gear.rack.module, gear.rack.pressure_angle);
        geometry::circles(module, alpha, &gear.shape)
            .is_ok_and(|circles| tooth(&gear, &circles, circles.tip).is_ok())
    };
    answers(&inputs.driver) && answers(&inputs.driven)
}

fn check(context: &Context) -> Option<Finding> {
    let [driver, driven] = foundations(context.inputs, &context.solution.geometry);
    let body = |of: &Foundation| {
        let no_bore = "none (no bore: computed with h = 3, without shift)";
        if of.body.is_finite() { four(of.body) } else { no_bore.to_owned() }
    };
    let here = format!(
        "h {} and {}, θ {} and {} rad",
        body(&driver),
        body(&driven),
        four(driver.angle),
        four(driven.angle)
    );
    let ((body_from, body_to), (angle_from, angle_to)) = (FOUNDATION_BODY, FOUNDATION_ANGLE);
    let range = format!(
        "foundation of the beam: h = r_f/r_h {body_from}..{body_to}, half angle at the root θ {angle_from}..{angle_to} rad; \
        outside, the nearest end of the range is used"
    );
    Finding::new(range, here, driver.is_inside() && driven.is_inside())
}

fn outside(inputs: &Inputs, geometry: &Geometry) -> Option<(&'static str, String)> {
    let gears = ["driver", "driven gear"].into_iter().zip(foundations(inputs, geometry));
    let (name, Foundation { body, angle }) = gears.into_iter().find(|(_, of)| !of.is_inside())?;
    let bore = if body.is_finite() {
        format!("r_f/r_bore is {body:.3}")
    } else {
        "body has no bore".to_owned()
    };
    let ((body_from, body_to), (angle_from, angle_to)) = (FOUNDATION_BODY, FOUNDATION_ANGLE);
    let message = format!(
        "the {name}'s {bore} and its half angle at the root {} rad, outside the range \
            {body_from}..{body_to} and {angle_from}..{angle_to} of the foundation: the nearest end of \
            the range is used",
        four(angle)
    );
    Some(("foundation-outside-range", message))
}

/// The position of a gear in the range of the foundation.
struct Foundation {
    body: f64,
    angle: f64,
}

/// The positions of driver and driven gear.
fn foundations(inputs: &Inputs, geometry: &Geometry) -> [Foundation; 2] {
    let gears = [(&inputs.driver, &geometry.driver), (&inputs.driven, &geometry.driven)];
    gears.map(|(gear, circles)| Foundation {
        body: circles.root / gear.bore_radius,
        angle: Profile::of(&Rack::of(inputs, gear), circles).root_half_angle(),
    })
}

impl Foundation {
    fn is_inside(&self) -> bool {
        let within = |value: f64, (from, to): (f64, f64)| (from..=to).contains(&value);
        (!self.body.is_finite() || within(self.body, FOUNDATION_BODY))
            && within(self.angle, FOUNDATION_ANGLE)
    }
}

/// Compliance of the body under the tooth, times E.
///
/// # Formula
/// ```text
/// q_f E = (1 − ν²)/0.91 cos² a1 (L (u/S)² + M (u/S) + P (1 + Q tan² a1)) − q_T − q_V,
/// X = A/θ² + B h² + C h/θ + D/θ + E h + F,   q_T = r_b² (1 + ν)/(2π) (1/r_h² − 1/r_f²),
/// q_V = (3 − 4ν)(1 + ν)/(4π (1 − ν)) ln h without a bore, else 0
/// ```
/// q_T is the twist of the body about its bore, which belongs to the shaft, and q_V the shift of
/// the body. u is the distance from the root circle to the line of force along the centre line. S =
/// 2 θ r_f is the thickness at the root, θ half of the tooth's angle at the root, and h =
/// r_f/r_bore.
///
/// # Source
/// Sainsot, Velex & Duverger 2004, J. Mech. Des. 126(4), 748-752, in plane strain with ν = 0.3. L
/// is 6.82 to 6.94; the half plane has 24 (1 − ν²)/π = 6.95 (in plane stress 24/π = 7.64).
///
/// # Valid for
/// h = 1.4..7 and θ = 0.01..0.12. Outside, L, M, P, Q and q_T use the nearest value of the range. A
/// gear without a bore uses h = 3.
fn foundation(profile: &Profile, gear: &ElasticGear, circles: &Circles, angle: f64) -> f64 {
    const L: [f64; 6] = [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045];
    const M: [f64; 6] = [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086];
    const P: [f64; 6] = [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236];
    const Q: [f64; 6] = [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904];
    let (sine, cosine) = angle.sin_cos();
    let half_angle = profile.root_half_angle();
    let held_at = if gear.bore_radius > 0.0 { gear.bore_radius } else { circles.root / SOLID_BODY };
    let ratio = (circles.root / held_at).clamp(FOUNDATION_BODY.0, FOUNDATION_BODY.1);
    let theta = half_angle.clamp(FOUNDATION_ANGLE.0, FOUNDATION_ANGLE.1);
    let [l, m, p, q] = [L, M, P, Q].map(|[a, b, c, d, e, f]| {
        a / (theta * theta) + b * ratio * ratio + c * ratio / theta + d / theta + e * ratio + f
    });
    let arm = (circles.base / cosine - circles.root) / (2.0 * half_angle * circles.root);
    let held = cosine * cosine * (l * arm * arm + m * arm + p) + p * q * sine * sine;
    let twist = field::body_twist(circles.base, circles.root, circles.root / ratio, gear.poisson);
    let shift =
        if gear.bore_radius > 0.0 { 0.0 } else { field::body_shift(gear.poisson) * ratio.ln() };
    plane_strain(gear.poisson) / plane_strain(FOUNDATION_POISSON) * held - twist - shift
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    #[test]
    fn a_tooth_cut_through_by_the_undercut_is_refused() {
        let mut inputs = standard_pair(5, 44, 1e-3);
        inputs.tooth_compliance = Some(ToothCompliance::BEAM);
        inputs.driven.addendum = -0.5;
        inputs.pressure_angle = 0.477;
        for (shift, whole) in [(-0.2, true), (-0.64, false)] {
            inputs.driver.profile_shift = shift;
            let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
            let found = tooth(&inputs.elasticity().driver, &circles, circles.tip);
            let is_refused = matches!(found, Err(Refusal::CutThrough { .. }));
            assert_eq!((found.is_ok(), is_refused), (whole, !whole), "x {shift}");
        }
    }

    /// Tests teeth of all kinds, also pointed and undercut teeth.
    #[test]
    fn quadrature_is_converged_to_1e_10() {
        let mut solved = 0;
        for teeth in [5, 6, 8, 10, 12, 14, 17, 20, 28, 40, 80, 200, 1000] {
            for degrees in [14.5, 17.5, 20.0, 25.0, 28.0, 30.0] {
                for shift in [-0.7, -0.4, 0.0, 0.3, 0.8, 1.2] {
                    solved += converged_loads(teeth, degrees, shift);
                }
            }
        }
        assert!(solved > 1000, "{solved}");
    }

    /// The number of loads along the flank with a compliance. Each compliance must agree with that
    /// of a much finer quadrature.
    fn converged_loads(teeth: u32, degrees: f64, shift: f64) -> usize {
        let mut inputs = standard_pair(teeth, 60, 5e-3);
        inputs.tooth_compliance = Some(ToothCompliance::BEAM);
        inputs.pressure_angle = degrees.to_radians();
        inputs.driver.profile_shift = shift;
        inputs.driven.addendum = 0.2;
        let Ok(geometry) = geometry::<f64>(&inputs.shape()) else {
            return 0;
        };
        let circles = &geometry.driver;
        let gear = inputs.elasticity().driver;
        let form = Profile::of(&gear.rack, circles).form_radius();
        let loads = [0.05, 0.5, 1.0].map(|part| form + part * (circles.tip - form));
        let by = |radius, tolerance| tooth_within(&gear, circles, radius, tolerance).ok();
        let found =
            loads.iter().filter_map(|&radius| Some((by(radius, TOLERANCE)?, by(radius, 1e-15)?)));
        found
            .inspect(|(found, exact)| {
                assert!(
                    (found / exact - 1.0).abs() < 1e-10,
                    "z {teeth} alpha {degrees} x {shift}: {found}, {exact}"
                );
            })
            .count()
    }
}
