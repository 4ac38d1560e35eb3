//! Search for the angle before E at which the driven tip first touches.

use crate::model::Refusal;
use crate::model::geometry::Geometry;
use crate::model::tip_gap::{
    TipContact, angle_at_curvature, gap, gap_without, largest_term, tip_at,
};
use crate::numeric::real::{exponential, logarithm};

/// Limit of the search, in rad. Larger angles never bring a tip back into contact.
pub(super) const LARGEST_ANGLE: f64 = 1.5;

/// Greatest loss of precision of the closed-form gap, as a factor; it corresponds to 5e-14 of u.
/// Beyond it the quadrature, ten times as costly, computes the gap.
pub(super) const KEPT_DIGITS: f64 = 512.0;

/// The angle u at which the tip has closed the gap Δ, `S(u) = Δ`. `series` belongs to the geometry.
///
/// Newton's method of fourth order for ln S over ln u. Starts from the series and ends with a step
/// that uses all digits of the gap.
///
/// # Errors
/// [`Refusal::NoFirstContact`] if the steps do not converge, because no angle closes such a
/// deviation.
pub(in crate::model) fn first_contact(
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
        angle *= exponential(step.clamp(-2.0, 2.0));
        if has_digits && step.abs() < EXACT {
            return Ok(angle);
        }
        if step.abs() < SETTLED {
            let tip = tip_at(geometry, angle);
            return Ok(
                angle * exponential(logarithmic_step(geometry, &tip, deviation, KEPT_DIGITS))
            );
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
pub(in crate::model) struct GapSeries {
    /// 1/S2, in 1/m.
    per_curve: f64,
    /// c1 to c3.
    terms: [f64; 3],
}

impl GapSeries {
    /// The series of a pair.
    pub(in crate::model) fn of(geometry: &Geometry) -> GapSeries {
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
