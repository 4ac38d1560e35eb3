//! The first contact D of the driven tip on the driver's flank, and its approach and sliding velocity.

use twofloat::TwoFloat;

use super::geometry::{Geometry, PairShape};
use super::inputs::{Inputs, Method};
pub use super::tip_gap::{TipContact, gap, gap_by_quadrature, tip_at};
use super::tip_gap::{angle_at_curvature, gap_without, largest_term};
use super::{Deviation, Refusal, geometry};
use crate::numeric::real::{exponential_near_zero, logarithm_near_one};
use crate::numeric::{Real, root};

/// Greatest loss of precision of the closed-form gap in double-double arithmetic, as a factor.
const LOST: f64 = 1e14;

/// The first contact D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Driver's angle from D to E, θ₁, in rad.
    pub approach_angle_driver: f64,
    /// Driven gear's angle from D to E, u, in rad.
    pub approach_angle_driven: f64,
    /// The contact at D.
    pub contact: TipContact,
    /// Reduced radius of curvature ρ_S at D, in m.
    pub curvature_radius: f64,
    /// Gap S(u) closed at D, in m: Δ in the method `exact`, much less in `paper`.
    pub closed_gap: f64,
}

/// The angle u after Newton steps in double-double arithmetic. There the closed-form gap keeps its
/// digits down to deviations of 1e-14 of its terms; for smaller deviations the angle stays
/// unchanged.
fn refine(geometry: &Geometry<TwoFloat>, angle: f64, deviation: TwoFloat) -> TwoFloat {
    const STEPS: usize = 3;
    let mut refined: TwoFloat = angle.into();
    for _ in 0..STEPS {
        let tip = tip_at(geometry, refined);
        if largest_term(&geometry.rounded(), &tip.rounded()) > LOST * deviation.rounded() {
            break;
        }
        refined -= (gap(geometry, &tip) - deviation).over(tip.normal_radius_drop);
    }
    refined
}

/// The driven gear's angle before E by the printed equations, which are linear in the deviation.
///
/// # Formula
/// ```text
/// εe = atan2(rb1 Δf, rb1² + N1E (N1E − Δf))
/// εd = atan2(rb1 δ, rb1² + (N1F − Δ)(N1F − Δf)),  N1F = N1E + pb
/// θ1 = εe + εd,  u = θ1/i
/// ```
///
/// # Source
/// Zhou & Chen 2014, Eqs. 11-20. Corrected: each difference of arctangents (Eqs. 14, 17-19), which
/// jumps by π for Δf > N₁E, is one arctangent; Eqs. 16 and 20 without the rounded contact ratio.
/// Kept as printed: the result is linear in Δ, although the tip's gap grows as u².
fn printed_contact<T: Real>(geometry: &Geometry<T>, deviation: &Deviation<T>) -> T {
    let [error, deflection] = printed_turns(geometry, deviation);
    (error + deflection).over(geometry.ratio)
}

/// The turns εe and εd of the driver in [`printed_contact`].
pub(super) fn printed_turns<T: Real>(geometry: &Geometry<T>, deviation: &Deviation<T>) -> [T; 2] {
    let base = geometry.driver.base;
    let turn = |from: T, by: T| (base * by).angle_to(base * base + from * (from - by));
    let error = deviation.equivalent_error;
    let ahead = geometry.start + geometry.base_pitch - error;
    [turn(geometry.start, error), turn(ahead, deviation.combined_deflection)]
}

/// The required additional tip relief of the driven gear by the printed equations, in m. `None` if
/// the tooth makes no contact before E.
///
/// # Formula
/// ```text
/// C  with  u(Δf − C/√2) = 0
/// ```
/// Eq. 1 as printed scales e_m. The relief is less than √2 Δ, because u reaches 0 at a small
/// positive Δ.
///
/// # Errors
/// Those of [`geometry`](geometry::geometry).
pub(super) fn printed_relief_to_clear(
    shape: &PairShape,
    deviation: &Deviation<TwoFloat>,
) -> Result<Option<f64>, Refusal> {
    const UP: f64 = 1.0 + 1e-14;
    let geometry = geometry::geometry::<TwoFloat>(shape)?;
    let left = |relief: f64| {
        let equivalent_error =
            deviation.equivalent_error - twofloat::consts::FRAC_1_SQRT_2 * TwoFloat::from(relief);
        printed_contact(&geometry, &Deviation { equivalent_error, ..*deviation }).rounded()
    };
    let all = std::f64::consts::SQRT_2 * deviation.total.rounded();
    Ok((left(0.0) > 0.0).then(|| UP * root::between(0.0, all, left)))
}

/// Reduced radius of curvature of the contact at the tip, ρ_S = ρ1 ρ2/(ρ1 + ρ2), in m. ρ2 is the
/// given tip radius, or without it the radius of curvature of the driven flank at its tip (Zhou &
/// Chen 2014, below Eq. 32).
#[must_use]
pub fn reduced_curvature(tip_radius: Option<f64>, geometry: &Geometry, tip: &TipContact) -> f64 {
    let driven = tip_radius.unwrap_or(geometry.driven.tip_curvature);
    tip.curvature_driver * driven / (tip.curvature_driver + driven)
}

/// The first contact of the tip by the method. `None` if no tooth strikes. `series` belongs to the
/// geometry. `precise`, the geometry in double-double arithmetic, makes all digits of the exact
/// position correct.
///
/// # Errors
/// A [`Refusal`] if D does not exist or is beyond the driver's tip.
pub(super) fn position(
    inputs: &Inputs,
    geometry: &Geometry,
    precise: Option<&Geometry<TwoFloat>>,
    series: &GapSeries,
    deviation: &Deviation<TwoFloat>,
) -> Result<Option<Position>, Refusal> {
    let plain = deviation.rounded();
    if plain.total <= 0.0 {
        return Ok(None);
    }
    let angle = match inputs.method {
        Method::Paper => printed_contact(geometry, &plain),
        _ => first_contact(geometry, series, plain.total)?,
    };
    let contact = tip_at(geometry, angle);
    let close_call = contact.needs_precision(geometry)
        || inputs.method == Method::Paper && plain.equivalent_error < 0.0;
    let (contact, closed_gap) = match precise {
        Some(precise) => precise_contact(inputs.method, precise, deviation, angle),
        None if close_call => {
            let precise = geometry::geometry(&inputs.shape())?;
            precise_contact(inputs.method, &precise, deviation, angle)
        }
        None if inputs.method == Method::Exact => (contact, plain.total),
        None => (contact, gap_without(KEPT_DIGITS, geometry, &contact)),
    };
    let closed_gap = if inputs.method == Method::Exact { plain.total } else { closed_gap };
    checked(inputs.driven.tip_radius, geometry, plain.total, contact, closed_gap)
}

/// The contact in double-double arithmetic, from the angle of the f64 search, and the closed gap.
fn precise_contact(
    method: Method,
    geometry: &Geometry<TwoFloat>,
    deviation: &Deviation<TwoFloat>,
    near: f64,
) -> (TipContact, f64) {
    let angle = match method {
        Method::Paper => printed_contact(geometry, deviation),
        _ => refine(geometry, near, deviation.total),
    };
    let tip = tip_at(geometry, angle);
    let contact = tip.rounded();
    let closed = gap(geometry, &tip).rounded();
    let lost = largest_term(&geometry.rounded(), &contact) > LOST * closed;
    (contact, if lost { gap_by_quadrature(&geometry.rounded(), &contact) } else { closed })
}

/// The contact as a position if it is on the driver's flank: ρ₁ must not grow by more than the path
/// of contact. This condition has less rounding than a comparison of O₁D with r_a1.
fn checked(
    tip_radius: Option<f64>,
    geometry: &Geometry,
    deviation: f64,
    contact: TipContact,
    closed_gap: f64,
) -> Result<Option<Position>, Refusal> {
    if contact.angle <= 0.0 {
        return Ok(None);
    }
    if !contact.radius_driver.is_finite() || contact.angle > LARGEST_ANGLE {
        return Err(Refusal::NoFirstContact { deviation });
    }
    if contact.curvature_growth > geometry.contact_ratio * geometry.base_pitch {
        return Err(Refusal::BeyondDriverTip {
            radius: contact.radius_driver,
            tip: geometry.driver.involute_end(),
        });
    }
    if geometry.driven.edge > 0.0 && contact.normal_radius_driven < 0.0 {
        return Err(Refusal::BeyondRounding { arm: contact.normal_radius_driven });
    }
    Ok(Some(Position {
        approach_angle_driver: contact.angle * geometry.ratio,
        approach_angle_driven: contact.angle,
        contact,
        curvature_radius: reduced_curvature(tip_radius, geometry, &contact),
        closed_gap,
    }))
}

/// Limit of the search, in rad. Larger angles never bring a tip back into contact.
const LARGEST_ANGLE: f64 = 1.5;

/// Greatest loss of precision of the closed-form gap, as a factor; it corresponds to 5e-14 of u.
/// Beyond it the quadrature, ten times as costly, computes the gap.
const KEPT_DIGITS: f64 = 512.0;

/// The angle u at which the tip has closed the gap Δ, `S(u) = Δ`. `series` belongs to the geometry.
///
/// Newton's method of fourth order for ln S over ln u. Starts from the series and ends with a step
/// that uses all digits of the gap.
///
/// # Errors
/// [`Refusal::NoFirstContact`] if the steps do not converge, because no angle closes such a
/// deviation.
pub(super) fn first_contact(
    geometry: &Geometry,
    series: &GapSeries,
    deviation: f64,
) -> Result<f64, Refusal> {
    const STEPS: usize = 60;
    /// After a step of this size one more step uses all digits.
    const SETTLED: f64 = 1e-4;
    /// The fourth power of such a step is below rounding.
    const EXACT: f64 = 2e-4;
    const ON_THE_WAY: f64 = 1e8;
    let mut angle = series.angle(geometry, deviation);
    for _ in 0..STEPS {
        let tip = tip_at(geometry, angle);
        let has_digits = largest_term(geometry, &tip) <= KEPT_DIGITS * gap(geometry, &tip);
        let step = logarithmic_step(geometry, &tip, deviation, ON_THE_WAY);
        if !step.is_finite() || angle > LARGEST_ANGLE {
            break;
        }
        angle *= exponential_near_zero(step.clamp(-2.0, 2.0));
        if has_digits && step.abs() < EXACT {
            return Ok(angle);
        }
        if step.abs() < SETTLED {
            let tip = tip_at(geometry, angle);
            return Ok(angle
                * exponential_near_zero(logarithmic_step(geometry, &tip, deviation, KEPT_DIGITS)));
        }
    }
    Err(Refusal::NoFirstContact { deviation })
}

/// The power series of the gap S about E, reversed.
///
/// # Formula
/// ```text
/// S = S2 u²/2 (1 + A u + B u² + C u³),  A = S3/(3 S2),  B = S4/(12 S2),  C = S5/(60 S2)
/// u = p (1 + c1 p + c2 p² + c3 p³),  p = √(2 S/S2)
/// ρ1 ρ1' = a ra2 sin η,  rb1 χ' = ρ1' + rb2',  S' = rb2 − rb2',  rb2' = a cos χ − rb1
/// ```
/// S2 to S5 are the derivatives of S at E. In the code p0 to p3 are those of ρ1', and x1 to x4
/// those of χ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GapSeries {
    /// 1/S2, in 1/m.
    per_curve: f64,
    /// c1 to c3.
    terms: [f64; 3],
}

impl GapSeries {
    /// The series of a pair.
    pub(super) fn of(geometry: &Geometry) -> GapSeries {
        let Geometry { driver, driven, .. } = geometry;
        let (curvature, tangent) = (geometry.start + driven.edge, geometry.tangent_length);
        let bases = driver.base + driven.base;
        let square = geometry.centre_distance * geometry.centre_distance;
        let inverse = curvature.recip();
        let x1 = (driven.tip_curvature - driven.edge) * inverse;
        let p0 = driver.base * x1 - driven.base;
        let p1 = (square - driver.base * bases - curvature * tangent - p0 * p0) * inverse;
        let p2 = -p0 - 3.0 * p0 * p1 * inverse;
        let p3 = -p1 - 3.0 * (p1 * p1 + p0 * p2 - p0 * p0 * p1 * inverse) * inverse;
        let per_base = driver.base.recip();
        let s2 = tangent * x1;
        let x2 = (p1 - s2) * per_base;
        let s3 = bases * x1 * x1 + tangent * x2;
        let x3 = (p2 - s3) * per_base;
        let s4 = 3.0 * bases * x1 * x2 + tangent * (x3 - x1 * x1 * x1);
        let x4 = (p3 - s4) * per_base;
        let s5 = bases * (3.0 * x2 * x2 + 4.0 * x1 * x3 - x1 * x1 * x1 * x1)
            + tangent * (x4 - 6.0 * x1 * x1 * x2);
        let per_curve = s2.recip();
        let (a, b, c) = (s3 * per_curve / 3.0, s4 * per_curve / 12.0, s5 * per_curve / 60.0);
        // The root of the bracket, as 1 + a1 u + a2 u² + a3 u³.
        let (a1, a2) = (0.5 * a, 0.5 * b - 0.125 * a * a);
        let a3 = 0.5 * c - 0.25 * a * b + 0.0625 * a * a * a;
        GapSeries { per_curve, terms: [-a1, 2.0 * a1 * a1 - a2, 5.0 * a1 * (a2 - a1 * a1) - a3] }
    }

    /// An angle u near `S(u) = deviation`, in rad. Uses the series, or its first term if the series
    /// does not converge, limited to the driver's tip.
    fn angle(&self, geometry: &Geometry, deviation: f64) -> f64 {
        let parabola = (2.0 * deviation * self.per_curve).sqrt();
        let [first, second, third] = self.terms;
        let first = first * parabola;
        let second = second * parabola * parabola;
        let third = third * parabola * parabola * parabola;
        // Treats the rest as a geometric series, because ρ1 has a branch point shortly before E.
        let rest = second / (1.0 - third / second);
        if first.abs() < 0.2 && rest.abs() < first.abs() {
            return (parabola * (1.0 + first + rest)).min(LARGEST_ANGLE);
        }
        parabola.min(angle_at_curvature(geometry, geometry.end)).min(LARGEST_ANGLE)
    }
}

/// Fourth-order step of ln u towards `S = deviation`. Uses the gap by quadrature if the largest
/// term of the closed form exceeds the sum by more than the factor `loss`.
///
/// # Formula
/// ```text
/// n = ln(Δ/S)/g,  step = n (1 − b n/2 + (2 b² + g b − q (1 + r − q)) n²/6)
/// g = u S'/S,  q = u S''/S',  r = u S'''/S'',  b = 1 + q − g
/// S'' = a sin χ χ',  S''' = a cos χ χ'² + a sin χ χ'',  χ' = ρ2/ρ1,  χ'' = (ρ1'' − S'')/rb1
/// ρ1' = rb1 χ' − rb2',  ρ1 ρ1'' = a ra2 cos η − ρ1'²
/// ```
/// This is the power series of ln u in ln S.
fn logarithmic_step(geometry: &Geometry, tip: &TipContact, deviation: f64, loss: f64) -> f64 {
    /// Farther away the higher orders can diverge.
    const NEAR: f64 = 0.1;
    let closed = gap_without(loss, geometry, tip);
    let (angle, slope) = (tip.angle, tip.normal_radius_drop);
    let growth = angle * slope / closed;
    let newton = logarithm_near_one((deviation - closed) / closed) / growth;
    if newton.abs() > NEAR {
        return newton;
    }
    let [second, third] = gap_derivatives(geometry, tip);
    let (curved, bent) = (angle * second / slope, angle * third / second);
    let off = 1.0 + curved - growth;
    let square = (2.0 * off * off + growth * off - curved * (1.0 + bent - curved)) / 6.0;
    newton * (1.0 - newton * (0.5 * off - newton * square))
}

/// S'' and S''' in m. For a rounded tip the lengths are those of the centre of its arc.
fn gap_derivatives(geometry: &Geometry, tip: &TipContact) -> [f64; 2] {
    let (base, edge) = (geometry.driver.base, geometry.driven.edge);
    let (curvature, length) = (tip.curvature_driver + edge, tip.normal_length_driven - edge);
    let (centre, radius) = (geometry.centre_distance, geometry.driven.tip - edge);
    let inverse = curvature.recip();
    let (bases, tangent) = (base + tip.normal_radius_driven, curvature + length);
    let turn = length * inverse;
    let second = tangent * turn;
    let growth = base * turn - tip.normal_radius_driven;
    let along = 0.5 * ((radius * radius - base * base) + (centre * centre - curvature * curvature));
    let bend = ((along - growth * growth) * inverse - second) / base;
    [second, bases * turn * turn + tangent * bend]
}

/// Velocities at D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Velocity {
    /// Approach velocity ΔV_n, in m/s.
    pub normal: f64,
    /// Sliding velocity ΔV_τ, in m/s.
    pub sliding: f64,
    /// Time from D to E, u/ω₂, in s.
    pub transit_time: f64,
    /// Friction coefficient below which sliding continues throughout the impact, ΔV_τ/(2 ΔV_n).
    pub stick_limit: f64,
}

/// Velocities of the tip against the flank, with the speed of the driven gear ω₂ in rad/s.
///
/// # Formula
/// ```text
/// ΔVn = ω1 rb1 − ω2 rb2' = ω2 (rb2 − rb2')
/// ΔVτ = ω2 N2'D − ω1 N1'D = ω2 (N2'D − i ρ1)
/// ```
/// Both arms are increments from [`tip_at`]. Differences of the products
/// would lose digits near E and the pitch point.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 21-28. Eq. 27 is corrected to the law of cosines: as printed, ΔV_n at E
/// is 1.32 m/s for Table 1 instead of 0. Eq. 22 is ΔV_Dτ although its label differs.
#[must_use]
pub fn velocity(driven_speed: f64, tip: &TipContact) -> Velocity {
    let normal = driven_speed * tip.normal_radius_drop;
    let sliding = driven_speed * tip.sliding_arm;
    Velocity {
        normal,
        sliding,
        transit_time: tip.angle / driven_speed,
        stick_limit: sliding / (2.0 * normal),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};

    /// A pair with a working pressure angle near 0: the parabola at E is far beyond D.
    #[test]
    fn the_contact_is_found_far_from_the_parabola() {
        let mut inputs = standard_pair(40, 40, 5e-3);
        let base = 0.1 * inputs.pressure_angle.cos();
        let angle = 3e-5f64;
        inputs.centre_distance = Some(2.0 * base / angle.cos());
        let curvature = 1.6 * base * angle;
        inputs.driven.addendum = (base.hypot(curvature) - 0.1) / inputs.module;
        for deviation in [1e-9, 1e-7, 1e-6, 1e-5, 2e-5] {
            inputs.deflection = Some(deviation);
            let solution = solve(&inputs, Stages::of(Stage::Position)).unwrap();
            let closed = gap(&solution.geometry, &solution.position.unwrap().contact);
            assert!((closed / deviation - 1.0).abs() < 1e-9, "{closed:e} closed of {deviation:e}");
        }
    }
}
