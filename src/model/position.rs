//! Where the driven tip first touches the driver's flank: D.

use twofloat::TwoFloat;

use super::geometry::{self, Geometry, PairShape};
use super::inputs::{Inputs, Method};
pub use super::tip_gap::{TipContact, gap, gap_by_quadrature, tip_at};
use super::tip_gap::{angle_at_curvature, gap_without, largest_term};
use super::{Deviation, Refusal};
use crate::numeric::near::{exponential, logarithm};
use crate::numeric::{Real, root};

/// Half a turn and more never brings a tip back: no contact is sought beyond, in rad.
const LARGEST_ANGLE: f64 = 1.5;

/// In double-double arithmetic the gap in closed form may lose this factor of its digits.
const LOST: f64 = 1e14;

/// The gap in closed form may lose this factor of its digits, 5e-14 of u, before the quadrature,
/// ten times as costly, serves.
const KEPT_DIGITS: f64 = 512.0;

/// How the first contact is searched for, apart from geometry and deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSearch {
    /// `paper` takes the printed equations, every other method the gap.
    pub method: Method,
    /// Shape of the pair, for a close call in double-double arithmetic.
    pub shape: PairShape,
    /// Radius of the edge of the driven tip, in m.
    pub tip_radius: Option<f64>,
}

impl Inputs {
    /// How the first contact is searched for.
    #[must_use]
    pub fn contact_search(&self) -> ContactSearch {
        ContactSearch {
            method: self.method,
            shape: self.shape(),
            tip_radius: self.driven.tip_radius,
        }
    }
}

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
    /// Gap that the tip has closed there, S(u), in m: Δ in the method `exact`, far less in `paper`.
    pub closed_gap: f64,
}

/// The angle u at which the tip has closed the gap Δ: `S(u) = Δ`.
///
/// Newton's method of fourth order on ln S against ln u, from [`near_start`], until a step with all
/// digits of the gap.
///
/// # Errors
/// [`Refusal::NoFirstContact`] where the steps do not settle: no turn of the gear would bridge such
/// a deviation.
pub(super) fn first_contact(geometry: &Geometry, deviation: f64) -> Result<f64, Refusal> {
    const STEPS: usize = 60;
    /// A last step with all digits follows a step as small as this.
    const SETTLED: f64 = 1e-4;
    /// The fourth power of such a step is rounding.
    const EXACT: f64 = 4e-4;
    const ON_THE_WAY: f64 = 1e8;
    let mut angle = near_start(geometry, deviation);
    for _ in 0..STEPS {
        let tip = tip_at(geometry, angle);
        let has_digits = largest_term(geometry, &tip) <= KEPT_DIGITS * gap(geometry, &tip);
        let step = logarithmic_step(geometry, &tip, deviation, ON_THE_WAY);
        if !step.is_finite() || angle > LARGEST_ANGLE {
            break;
        }
        angle *= exponential(step.clamp(-2.0, 2.0));
        if has_digits && step.abs() < EXACT {
            return Ok(angle);
        }
        if step.abs() < SETTLED {
            let tip = tip_at(geometry, angle);
            return Ok(angle * exponential(logarithmic_step(geometry, &tip, deviation, KEPT_DIGITS)));
        }
    }
    Err(Refusal::NoFirstContact { deviation })
}

/// An angle u near `S(u) = deviation`, in rad: by the reversed power series of S about E, or where
/// that does not converge by its first term, but no further than the driver's tip.
///
/// # Formula
/// ```text
/// S = S2 u²/2 (1 + A u + B u² + C u³),  A = S3/(3 S2),  B = S4/(12 S2),  C = S5/(60 S2)
/// ρ1 ρ1' = a ra2 sin η,  rb1 χ' = ρ1' + rb2',  S' = rb2 − rb2',  rb2' = a cos χ − rb1
/// ```
/// where S2 to S5 are the derivatives of S at E, p0 to p3 below those of ρ1' and x1 to x4 those of χ.
fn near_start(geometry: &Geometry, deviation: f64) -> f64 {
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
    let parabola = (2.0 * deviation * per_curve).sqrt();
    let first = -a1 * parabola;
    let second = (2.0 * a1 * a1 - a2) * parabola * parabola;
    let third = (5.0 * a1 * (a2 - a1 * a1) - a3) * parabola * parabola * parabola;
    // As if the rest of the series were geometric: ρ1 has a branch point not far before E.
    let rest = second / (1.0 - third / second);
    if first.abs() < 0.2 && rest.abs() < first.abs() {
        return (parabola * (1.0 + first + rest)).min(LARGEST_ANGLE);
    }
    parabola
        .min(angle_at_curvature(geometry, geometry.end))
        .min(LARGEST_ANGLE)
}

/// Step of ln u towards `S = deviation`, of fourth order, with the gap by quadrature where the terms
/// of its closed form outgrow their sum by more than the factor `loss`.
///
/// # Formula
/// ```text
/// n = ln(Δ/S)/g,  step = n (1 − b n/2 + (2 b² + g b − q (1 + r − q)) n²/6)
/// g = u S'/S,  q = u S''/S',  r = u S'''/S'',  b = 1 + q − g
/// S'' = a sin χ χ',  S''' = a cos χ χ'² + a sin χ χ'',  χ' = ρ2/ρ1,  χ'' = (ρ1'' − S'')/rb1
/// ρ1' = rb1 χ' − rb2',  ρ1 ρ1'' = a ra2 cos η − ρ1'²
/// ```
/// the power series of ln u in ln S.
fn logarithmic_step(geometry: &Geometry, tip: &TipContact, deviation: f64, loss: f64) -> f64 {
    /// Farther away the higher orders may lead astray.
    const NEAR: f64 = 0.1;
    let closed = gap_without(loss, geometry, tip);
    let (angle, slope) = (tip.angle, tip.normal_radius_drop);
    let growth = angle * slope / closed;
    let newton = logarithm((deviation - closed) / closed) / growth;
    if newton.abs() > NEAR {
        return newton;
    }
    let [second, third] = gap_derivatives(geometry, tip);
    let (curved, bent) = (angle * second / slope, angle * third / second);
    let off = 1.0 + curved - growth;
    let square = (2.0 * off * off + growth * off - curved * (1.0 + bent - curved)) / 6.0;
    newton * (1.0 - newton * (0.5 * off - newton * square))
}

/// S'' and S''' in m; of a rounded tip the lengths are those of the centre of its arc.
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

/// The angle u improved by Newton steps in double-double arithmetic, in which the closed form of
/// the gap keeps its digits down to deviations of 1e-14 of its terms; below, the angle stays as it
/// is.
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
/// Zhou & Chen 2014, Eqs. 11-20. Mended: the differences of arctangents (Eqs. 14, 17-19), which
/// jump by π where Δf > N₁E, are taken as one; Eqs. 16 and 20 without the rounded contact ratio.
/// Kept as printed: the result is linear in Δ, where the tip's gap grows as u².
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
    [
        turn(geometry.start, error),
        turn(ahead, deviation.combined_deflection),
    ]
}

/// Least tip relief of the driven gear, beyond what it has, with which the printed equations bring
/// the tooth in on time, in m; `None` where they do so anyhow.
///
/// # Formula
/// ```text
/// C/√2 where u(Δf − C/√2) = 0
/// ```
/// since Eq. 1 as printed scales e_m. Less than √2 Δ: for a small Δ left, u is not above 0 already.
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
        printed_contact(
            &geometry,
            &Deviation {
                equivalent_error,
                ..*deviation
            },
        )
        .rounded()
    };
    let all = std::f64::consts::SQRT_2 * deviation.total.rounded();
    Ok((left(0.0) > 0.0).then(|| UP * root::between(0.0, all, left)))
}

/// Reduced radius of curvature at the tip's contact ρ_S = ρ1 ρ2/(ρ1 + ρ2), in m; ρ2 is the driven
/// flank's own at its tip, or the radius of the tip's edge where the case gives one (Zhou & Chen
/// 2014, below Eq. 32).
#[must_use]
pub fn reduced_curvature(tip_radius: Option<f64>, geometry: &Geometry, tip: &TipContact) -> f64 {
    let driven = tip_radius.unwrap_or(geometry.driven.tip_curvature);
    tip.curvature_driver * driven / (tip.curvature_driver + driven)
}

/// Where the tip first touches, by the method; `None` where no tooth strikes. With `precise`, the
/// same geometry in double-double arithmetic, the exact position is good to the last digit.
///
/// # Errors
/// A [`Refusal`] where D does not exist or lies beyond the driver's tip.
pub fn position(
    search: &ContactSearch,
    geometry: &Geometry,
    precise: Option<&Geometry<TwoFloat>>,
    deviation: &Deviation<TwoFloat>,
) -> Result<Option<Position>, Refusal> {
    let plain = deviation.rounded();
    if plain.total <= 0.0 {
        return Ok(None);
    }
    let angle = match search.method {
        Method::Paper => printed_contact(geometry, &plain),
        _ => first_contact(geometry, plain.total)?,
    };
    let contact = tip_at(geometry, angle);
    let close_call = contact.is_close_call(geometry)
        || search.method == Method::Paper && plain.equivalent_error < 0.0;
    let (contact, closed_gap) = match precise {
        Some(precise) => precise_contact(search.method, precise, deviation, angle),
        None if close_call => {
            let precise = geometry::geometry(&search.shape)?;
            precise_contact(search.method, &precise, deviation, angle)
        }
        None if search.method == Method::Exact => (contact, plain.total),
        None => (contact, gap_without(KEPT_DIGITS, geometry, &contact)),
    };
    let closed_gap = if search.method == Method::Exact {
        plain.total
    } else {
        closed_gap
    };
    checked(
        search.tip_radius,
        geometry,
        plain.total,
        contact,
        closed_gap,
    )
}

/// The contact in double-double arithmetic, near the angle that f64 has found, and the gap closed
/// there.
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
    (
        contact,
        if lost {
            gap_by_quadrature(&geometry.rounded(), &contact)
        } else {
            closed
        },
    )
}

/// The contact as a position, where there is one on the driver's flank: ρ₁ has not grown by more
/// than the path of contact, which tells more sharply than O₁D against r_a1.
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
        return Err(Refusal::BeyondRounding {
            arm: contact.normal_radius_driven,
        });
    }
    Ok(Some(Position {
        approach_angle_driver: contact.angle * geometry.ratio,
        approach_angle_driven: contact.angle,
        contact,
        curvature_radius: reduced_curvature(tip_radius, geometry, &contact),
        closed_gap,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};

    /// A pair whose line of action is all but along the centre line's normal: the parabola at E is
    /// far beyond D.
    #[test]
    fn contact_is_found_where_the_parabola_is_far_beyond_it() {
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
            assert!(
                (closed / deviation - 1.0).abs() < 1e-9,
                "{closed:e} closed of {deviation:e}"
            );
        }
    }
}
