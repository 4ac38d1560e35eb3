//! The circles of one gear, with the rounding of its tip.

use super::shape::GearShape;
use crate::model::Refusal;
use crate::numeric::Real;

/// Circles of one gear, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circles<T = f64> {
    /// Reference radius r = m z/2.
    pub reference: T,
    /// Base radius r_b = r cos α.
    pub base: T,
    /// Active tip radius r_a after the chamfer.
    pub tip: T,
    /// Radius of curvature of the involute at its end, L_f: √(r_a² − r_b²) at a sharp tip.
    pub tip_curvature: T,
    /// Radius r_e of the rounding of the tip's edge; 0 for a sharp tip.
    pub edge: T,
    /// Root radius r_f = r + m (x − h_fP*).
    pub root: T,
}

/// Circles of one gear, cut by a rack of a module in m and a pressure angle in rad.
///
/// # Errors
/// [`Refusal::PointedRack`], [`Refusal::TipInsideBase`], and for the rounding of the tip
/// [`Refusal::RoundingInsideBase`] and [`Refusal::RoundingTooWide`]. Each names the field of the
/// driver.
pub fn circles<T: Real>(
    module: f64,
    pressure_angle: f64,
    gear: &GearShape,
) -> Result<Circles<T>, Refusal> {
    let (module, alpha): (T, T) = (module.into(), pressure_angle.into());
    let (half, two): (T, T) = (0.5.into(), 2.0.into());
    let shift: T = gear.profile_shift.into();
    let reference = module * T::count(gear.teeth) * half;
    let base = reference * alpha.sine_cosine().1;
    let above_reference = |diameter: f64| <T as From<f64>>::from(diameter) * half - reference;
    let height =
        gear.tip_diameter.map_or_else(|| module * (shift + gear.addendum.into()), above_reference)
            - gear.tip_chamfer.into();
    let half_sine = (alpha * half).sine_cosine().0;
    let most_dedendum = std::f64::consts::FRAC_PI_4 / pressure_angle.tan();
    if gear.dedendum >= most_dedendum {
        return Err(Refusal::PointedRack {
            field: "driver.dedendum",
            dedendum: gear.dedendum,
            limit: most_dedendum,
        });
    }
    let over_base = two * reference * half_sine * half_sine + height;
    if over_base <= T::zero() {
        let is_cut = over_base + gear.tip_chamfer.into() > T::zero();
        return Err(Refusal::TipInsideBase {
            field: if is_cut { "driver.tip_chamfer" } else { "driver.addendum" },
            tip: (reference + height).rounded(),
            base: base.rounded(),
        });
    }
    let tip = reference + height;
    let edge: T = gear.tip_radius.unwrap_or(0.0).into();
    let centre_over_base = over_base - edge;
    if centre_over_base <= T::zero() {
        return Err(Refusal::RoundingInsideBase {
            field: "driver.tip_radius",
            radius: edge.rounded(),
            limit: over_base.rounded(),
        });
    }
    let centre_curvature = (centre_over_base * (tip - edge + base)).root();
    if edge > T::zero() {
        check_room(pressure_angle, gear, [base, centre_curvature, edge].map(Real::rounded))?;
    }
    Ok(Circles {
        reference,
        base,
        tip,
        tip_curvature: centre_curvature + edge,
        edge,
        root: reference
            + gear
                .root_diameter
                .map_or_else(|| module * (shift - gear.dedendum.into()), above_reference),
    })
}

/// Refuses a rounding that is too large for the tooth: its arc would begin beyond the centre line
/// of the tooth.
///
/// # Formula
/// ```text
/// (π/2 + 2 x tan α)/z + inv α − inv acos(rb/rC) − re/rb >= 0
/// ```
fn check_room(
    pressure_angle: f64,
    gear: &GearShape,
    [base, centre_curvature, radius]: [f64; 3],
) -> Result<(), Refusal> {
    let tangent = pressure_angle.tan();
    let half_angle = (std::f64::consts::FRAC_PI_2 + 2.0 * gear.profile_shift * tangent)
        / f64::from(gear.teeth)
        + tangent
        - pressure_angle;
    let roll = centre_curvature / base;
    let room = half_angle - (roll - roll.atan()) - radius / base;
    if room < 0.0 {
        return Err(Refusal::RoundingTooWide {
            field: "driver.tip_radius",
            radius,
            lack: -room * base,
        });
    }
    Ok(())
}

impl<T: Real> Circles<T> {
    pub(in crate::model) fn rounded(self) -> Circles {
        Circles {
            reference: self.reference.rounded(),
            base: self.base.rounded(),
            tip: self.tip.rounded(),
            tip_curvature: self.tip_curvature.rounded(),
            edge: self.edge.rounded(),
            root: self.root.rounded(),
        }
    }
}

impl Circles {
    /// The circles of the gear with a sharp tip.
    #[must_use]
    pub fn sharp(&self) -> Circles {
        if self.edge <= 0.0 {
            return *self;
        }
        Circles {
            tip_curvature: ((self.tip - self.base) * (self.tip + self.base)).sqrt(),
            edge: 0.0,
            ..*self
        }
    }

    /// Radius at which the involute ends, in m: the tip radius for a sharp tip.
    #[must_use]
    pub fn involute_end(&self) -> f64 {
        if self.edge <= 0.0 { self.tip } else { self.base.hypot(self.tip_curvature) }
    }
}
