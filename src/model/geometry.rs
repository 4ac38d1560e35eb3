//! Involute geometry of the pair: circles, line of action, start of contact.

mod circles;
mod shape;
mod tip_losses;

use nalgebra::{Matrix2, Rotation2, Vector2};
use twofloat::TwoFloat;

use super::Refusal;
use crate::numeric::Real;
pub use circles::{Circles, circles};
pub use shape::{GearShape, GeometryInputs, PairShape};
pub use tip_losses::TipLosses;
use tip_losses::tip_losses;

/// A difference below this part of its terms is computed in double-double arithmetic, because f64
/// would lose two or more digits.
pub(super) const LEAST_REST: f64 = 1.0 / 64.0;

/// Geometry of the pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry<T = f64> {
    /// Transmission ratio i = z₂/z₁.
    pub ratio: T,
    /// Circles of the driver.
    pub driver: Circles<T>,
    /// Circles of the driven gear.
    pub driven: Circles<T>,
    /// Centre distance a, in m.
    pub centre_distance: T,
    /// Working pressure angle α_w, in rad.
    pub working_pressure_angle: T,
    /// Base pitch p_b = π m cos α, in m.
    pub base_pitch: T,
    /// N₁E: from the driver's point of tangency to the start of contact, in m.
    pub start: T,
    /// N₁B: from the driver's point of tangency to the end of contact, in m.
    pub end: T,
    /// N₁N₂, in m.
    pub tangent_length: T,
    /// E to the pitch point: the path of approach, in m.
    pub approach_length: T,
    /// Contact ratio ε = EB/p_b.
    pub contact_ratio: T,
    /// The parts of the path of contact that chamfers and roundings of the tips remove.
    pub tip_losses: TipLosses,
    /// γ₂: angle at O₂ between the centre line and the tip at E, in rad. For a rounded tip, the
    /// centre of its arc replaces the tip.
    pub start_angle_driven: T,
    /// Sine and cosine of γ₂.
    pub start_direction_driven: Vector2<T>,
    /// The point E relative to O₁ with the centre line along x, in m. For a rounded tip, the centre
    /// of its arc.
    pub start_point: Vector2<T>,
}

/// Geometry of the pair, by ISO 21771.
///
/// # Formula
/// ```text
/// rb = r cos α,  ra = r + m (ha* + x) − chamfer,  pb = π m cos α
/// inv αw = inv α + 2 (x1 + x2) tan α/(z1 + z2)  without a given centre distance,
/// otherwise cos αw = (rb1 + rb2)/a
/// N1E = N1N2 − √(ra2² − rb2²),  N1B = √(ra1² − rb1²),  ε = (N1B − N1E)/pb
/// γ2 = ∠(O2O1, O2E)
/// ```
/// A rounded tip is an arc of radius re inside the tip circle, tangent to the tip circle and to the
/// flank. It ends the involute at the radius of curvature L_f instead of √(ra² − rb²). γ₂ and E are
/// those of the centre C of the arc:
/// ```text
/// rC = ra − re,  L_C = √(rC² − rb²),  L_f = L_C + re,  N1C = N1E + re
/// ```
/// inv t = tan t − t. The formulas avoid differences of squares: r_a − r_b = 2 r sin²(α/2) + m
/// (h_a* + x) and N₁N₂ = (r_b1 + r_b2) tan α_w.
///
/// # Source
/// ISO 21771:2007; Zhou & Chen 2014, Eqs. 8, 9 (γ₂), 16 and 20 (N₁E, here without the rounded
/// contact ratio).
///
/// # Errors
/// A [`Refusal`] if the pair has no line of action, a tip is inside its base circle, or the driven
/// tip would touch the driver below its base circle.
pub fn geometry<T: Real>(shape: &PairShape) -> Result<Geometry<T>, Refusal> {
    let alpha: T = shape.pressure_angle.into();
    let driver: Circles<T> = circles(shape.module, shape.pressure_angle, &shape.driver)?;
    let driven: Circles<T> =
        circles(shape.module, shape.pressure_angle, &shape.driven).map_err(Refusal::at_driven)?;
    let base_sum = driver.base + driven.base;
    let (centre_distance, tangent) = working_tangent(shape, alpha, base_sum)?;
    let tangent_length = base_sum * tangent;
    let start = tangent_length - driven.tip_curvature;
    if start <= T::zero() {
        return Err(Refusal::Interference { start: start.rounded() });
    }
    let base_pitch = T::PI * shape.module.into() * alpha.sine_cosine().1;
    let approach_length = driven.tip_curvature - driven.base * tangent;
    let (centre_approach, centre_curvature) =
        (approach_length - driven.edge, driven.tip_curvature - driven.edge);
    let working_pressure_angle = tangent.angle_to(T::one());
    let end = driver.tip_curvature;
    let tip_losses = tip_losses(shape, &driver.rounded(), &driven.rounded());
    if end <= start {
        let whole = (end - start).rounded() + tip_losses.total;
        return Err(Refusal::NoPath {
            start: start.rounded(),
            end: end.rounded(),
            is_distance_given: shape.centre_distance.is_some(),
            cut: tip_losses.greatest.filter(|_| whole > 0.0),
        });
    }
    let contact_ratio = (end - start).over(base_pitch);
    let towards_start = Vector2::new(centre_approach, driven.base + centre_curvature * tangent);
    let is_rounded = driver.edge > T::zero() || driven.edge > T::zero();
    if let Some(field) = tip_losses.greatest.filter(|_| is_rounded)
        && contact_ratio < T::one()
    {
        return Err(Refusal::RoundingBreaksContact { field, ratio: contact_ratio.rounded() });
    }
    Ok(Geometry {
        ratio: T::count(shape.driven.teeth).over(T::count(shape.driver.teeth)),
        driver,
        driven,
        centre_distance,
        working_pressure_angle,
        base_pitch,
        start,
        end,
        tangent_length,
        approach_length,
        contact_ratio,
        tip_losses,
        start_angle_driven: towards_start.x.angle_to(towards_start.y),
        start_direction_driven: towards_start
            * T::one().over(towards_start.dot(&towards_start).root()),
        start_point: foot(driver.base, start + driven.edge, working_pressure_angle),
    })
}

/// Geometry of the pair in double-double arithmetic, if the case requests it or small differences
/// of `plain` need it. `plain` is `None` if f64 cannot compute the geometry.
///
/// # Errors
/// Those of [`geometry`].
pub(super) fn precise(
    inputs: &GeometryInputs,
    plain: Option<&Geometry>,
) -> Result<Option<Geometry<TwoFloat>>, Refusal> {
    let close_call = plain.is_none_or(|geometry| geometry.needs_precision(inputs.bores));
    (inputs.is_accurate || close_call).then(|| geometry(&inputs.shape)).transpose()
}

/// tan t.
fn tangent_of<T: Real>(angle: T) -> T {
    let (sine, cosine) = angle.sine_cosine();
    sine.over(cosine)
}

/// The point of a flank with the radius of curvature `curvature` on a contact normal at `angle`,
/// relative to O₁.
pub(super) fn foot<T: Real>(base: T, curvature: T, angle: T) -> Vector2<T> {
    turned(angle) * Vector2::new(base, -curvature)
}

/// Rotation of the plane by an angle.
fn turned<T: Real>(angle: T) -> Rotation2<T> {
    let (sine, cosine) = angle.sine_cosine();
    Rotation2::from_matrix_unchecked(Matrix2::new(cosine, -sine, sine, cosine))
}

/// Centre distance and tan α_w.
fn working_tangent<T: Real>(shape: &PairShape, alpha: T, base_sum: T) -> Result<(T, T), Refusal> {
    if let Some(given) = shape.centre_distance {
        let distance: T = given.into();
        if distance <= base_sum {
            return Err(Refusal::CentreDistanceJams { distance: given, least: base_sum.rounded() });
        }
        return Ok((
            distance,
            ((distance - base_sum) * (distance + base_sum)).root().over(base_sum),
        ));
    }
    let angle = alpha + working_angle_rise(shape, alpha)?;
    let (sine, cosine) = angle.sine_cosine();
    Ok((base_sum.over(cosine), sine.over(cosine)))
}

/// α_w − α of the mesh without backlash, by Newton's method on the involute function.
///
/// The involute function is convex, so that steps from the right of the root stay on the right.
fn working_angle_rise<T: Real>(shape: &PairShape, alpha: T) -> Result<T, Refusal> {
    const LARGEST_ANGLE: f64 = 1.4;
    const STEPS: usize = 40;
    let (driver, driven) = (&shape.driver, &shape.driven);
    let two: T = 2.0.into();
    let tangent = tangent_of(alpha);
    let shifts = <T as From<f64>>::from(driver.profile_shift) + driven.profile_shift.into();
    let rise = (two * shifts * tangent).over(T::count(driver.teeth + driven.teeth));
    if tangent - alpha + rise <= T::zero() {
        return Err(Refusal::ShiftsLeaveNoMesh { sum: shifts.rounded() });
    }
    let largest = <T as From<f64>>::from(LARGEST_ANGLE) - alpha;
    let parabola = rise.over(tangent * tangent);
    let mut angle = if parabola < largest { parabola } else { largest };
    for _ in 0..STEPS {
        let step_tangent = tangent_of(angle);
        let opened =
            (step_tangent * (T::one() + tangent * tangent)).over(T::one() - tangent * step_tangent);
        let slope = (tangent + opened) * (tangent + opened);
        let step = (opened - angle - rise).over(slope);
        angle -= step;
        if step.rounded().abs() <= T::EPSILON {
            break;
        }
    }
    Ok(angle)
}

impl Geometry {
    /// Length of the path of contact with one additional pair in contact, (ε − ⌈ε⌉ + 1) p_b, in m.
    /// For 1 < ε < 2 this is the length of double contact at each end.
    #[must_use]
    pub fn shared_length(&self) -> f64 {
        (self.contact_ratio - self.contact_ratio.ceil() + 1.0) * self.base_pitch
    }

    /// Whether f64 loses digits in a small difference: N₁E, the path of contact, EP, r_a − r_b, a −
    /// (r_b1 + r_b2), the wall between bore and base circle, or ε − 1 with rounded tips.
    #[must_use]
    pub fn needs_precision(&self, bores: [f64; 2]) -> bool {
        const FLAT: f64 = 0.125;
        const SHORT: f64 = 1.0 / 32.0;
        let short_tip = |circles: &Circles| circles.tip_curvature < SHORT * circles.base;
        let thin_wall =
            |bore: f64, circles: &Circles| circles.base - bore < LEAST_REST * circles.base;
        self.start < LEAST_REST * self.tangent_length
            || self.approach_length.abs() < LEAST_REST * self.driven.tip_curvature
            || self.end - self.start < LEAST_REST * self.end
            || self.tangent_length < FLAT * (self.driver.base + self.driven.base)
            || short_tip(&self.driver)
            || short_tip(&self.driven)
            || thin_wall(bores[0], &self.driver)
            || thin_wall(bores[1], &self.driven)
            || self.is_rounded() && (self.contact_ratio - 1.0).abs() < LEAST_REST
    }

    fn is_rounded(&self) -> bool {
        self.driver.edge > 0.0 || self.driven.edge > 0.0
    }

    /// Normal backlash from the centre distance, 2 (r_b1 + r_b2) (inv α_w − inv α_w0), in m. α_w0
    /// is the working pressure angle without backlash. A negative value means that the teeth jam
    /// (ISO 21771).
    #[must_use]
    pub fn backlash(&self, shape: &PairShape) -> f64 {
        let involute = |angle: f64| angle.tan() - angle;
        let alpha = shape.pressure_angle;
        let shifts = shape.driver.profile_shift + shape.driven.profile_shift;
        let without = involute(alpha)
            + 2.0 * shifts * alpha.tan() / f64::from(shape.driver.teeth + shape.driven.teeth);
        2.0 * (self.driver.base + self.driven.base)
            * (involute(self.working_pressure_angle) - without)
    }
}

impl<T: Real> Geometry<T> {
    pub(super) fn rounded(self) -> Geometry {
        Geometry {
            ratio: self.ratio.rounded(),
            driver: self.driver.rounded(),
            driven: self.driven.rounded(),
            centre_distance: self.centre_distance.rounded(),
            working_pressure_angle: self.working_pressure_angle.rounded(),
            base_pitch: self.base_pitch.rounded(),
            start: self.start.rounded(),
            end: self.end.rounded(),
            tangent_length: self.tangent_length.rounded(),
            approach_length: self.approach_length.rounded(),
            contact_ratio: self.contact_ratio.rounded(),
            tip_losses: self.tip_losses,
            start_angle_driven: self.start_angle_driven.rounded(),
            start_direction_driven: self.start_direction_driven.map(Real::rounded),
            start_point: self.start_point.map(Real::rounded),
        }
    }
}
