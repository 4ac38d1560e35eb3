//! The driven tip and its gap to the driver's flank, the first contact D, and the velocities there.

use super::geometry::{Geometry, LEAST_REST, PairShape, foot};
use super::inputs::{Inputs, Method};
use super::{Deviation, Refusal, geometry};
use crate::numeric::real::{exponential_near_zero, logarithm_near_one};
use crate::numeric::{Real, quadrature, root};
use nalgebra::Vector2;
use twofloat::TwoFloat;

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
pub fn reduced_curvature(tip_radius: Option<f64>, geometry: &Geometry, tip: &TipContact) -> f64 {
    let driven = tip_radius.unwrap_or(geometry.driven.tip_curvature);
    tip.curvature_driver * driven / (tip.curvature_driver + driven)
}

/// The first contact of the tip by the method. `None` if no tooth strikes. `precise`, the geometry in
/// double-double arithmetic, makes all digits of the exact position correct.
///
/// # Errors
/// A [`Refusal`] if D does not exist or is beyond the driver's tip.
pub(super) fn position(
    inputs: &Inputs,
    geometry: &Geometry,
    precise: Option<&Geometry<TwoFloat>>,
    deviation: &Deviation<TwoFloat>,
) -> Result<Option<Position>, Refusal> {
    let plain = deviation.rounded();
    if plain.total <= 0.0 {
        return Ok(None);
    }
    let angle = match inputs.method {
        Method::Paper => printed_contact(geometry, &plain),
        _ => first_contact(geometry, plain.total)?,
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

/// The angle u at which the tip has closed the gap Δ, `S(u) = Δ`.
///
/// Newton's method of fourth order for ln S over ln u. Starts from the series and ends with a step
/// that uses all digits of the gap.
///
/// # Errors
/// [`Refusal::NoFirstContact`] if the steps do not converge, because no angle closes such a
/// deviation.
pub(super) fn first_contact(geometry: &Geometry, deviation: f64) -> Result<f64, Refusal> {
    const STEPS: usize = 60;
    /// After a step of this size one more step uses all digits.
    const SETTLED: f64 = 1e-4;
    /// The fourth power of such a step is below rounding.
    const EXACT: f64 = 2e-4;
    const ON_THE_WAY: f64 = 1e8;
    let mut angle = GapSeries::of(geometry).angle(geometry, deviation);
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
struct GapSeries {
    /// 1/S2, in 1/m.
    per_curve: f64,
    /// c1 to c3.
    terms: [f64; 3],
}

impl GapSeries {
    /// The series of a pair.
    fn of(geometry: &Geometry) -> GapSeries {
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

/// A place of the driven tip on its circle and the driver's flank that it would touch.
///
/// For a rounded tip, the centre C of its arc moves on a smaller circle. C meets the involute
/// parallel to the driver's flank, at the distance r_e.
///
/// Changes since E are stored as increments, so that values near E keep their digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipContact<T = f64> {
    /// Driven gear's angle before E, u, in rad.
    pub angle: T,
    /// Angle at O₂ between the centre line and the tip, or the centre of its arc, γ₂ + u, in rad.
    pub polar_angle: T,
    /// O₁D, in m.
    pub radius_driver: T,
    /// O₂D, in m: the tip radius for a sharp tip.
    pub radius_driven: T,
    /// Radius of curvature of the driver's flank ρ₁ = N₁'D, in m.
    pub curvature_driver: T,
    /// Growth of ρ₁ since E, in m.
    pub curvature_growth: T,
    /// Rise of the contact normal's angle over E, χ − α_w, in rad.
    pub normal_turn: T,
    /// Distance from O₂ to the contact normal r_b2', in m.
    pub normal_radius_driven: T,
    /// r_b2 − r_b2' = dS/du, in m.
    pub normal_radius_drop: T,
    /// Growth of N₂'D since E, in m.
    pub normal_length_growth: T,
    /// N₂'D along the contact normal, in m.
    pub normal_length_driven: T,
    /// Arm of the sliding velocity ΔV_τ/ω₂ = N₂'D − i ρ₁, in m.
    pub sliding_arm: T,
}

/// The driven tip at the angle `angle` before E.
///
/// # Formula
/// ```text
/// Q = 4 a ra2 sin(u/2) sin(γ2 + u/2),  O1D² = O1E² + Q,  ρ1 = √(N1E² + Q),  Δρ1 = Q/(ρ1 + N1E)
/// Δβ1 = atan2(rb1 Δρ1, rb1² + ρ1 N1E),  Δψ = atan2(E × D, E · D),  Δχ = Δψ + Δβ1
/// rb2 − rb2' = 2 a sin(αw + Δχ/2) sin(Δχ/2),  N2'D = N2E + 2 a cos(αw + Δχ/2) sin(Δχ/2) − Δρ1
/// a sin(αw + Δχ/2) = N1N2 cos(Δχ/2) + (rb1 + rb2) sin(Δχ/2), likewise the cosine
/// N2'D − i ρ1 = (1 + i) EP + Δ(N2'D) − i Δρ1
/// ```
/// For a rounded tip ra2, N1E, γ2, E and D are those of the arc's centre C in Q, Δβ1 and Δψ. Then
/// ρ1 = N1'C − re and O1D² = rb1² + ρ1². E and D are relative to O₁, D − E is the chord of the tip
/// circle, EP the path of approach and Δ the growth since E.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 7, 24-28, 48, 49, rewritten as increments from E. Eq. 27 is corrected to
/// the law of cosines.
///
/// # Valid for
/// Any angle with the tip outside the driver's base circle (`N1E² + Q > 0`).
#[inline]
pub fn tip_at<T: Real>(geometry: &Geometry<T>, angle: T) -> TipContact<T> {
    let (half, two): (T, T) = (0.5.into(), 2.0.into());
    let (base, edge) = (geometry.driver.base, geometry.driven.edge);
    let start = geometry.start + edge;
    let (half_sine, half_cosine) = (angle * half).sine_cosine();
    let [[start_sine, start_cosine]] = geometry.start_direction_driven.data.0;
    let middle_sine = start_sine * half_cosine + start_cosine * half_sine;
    let middle_cosine = start_cosine * half_cosine - start_sine * half_sine;
    let chord_length = two * (geometry.driven.tip - edge) * half_sine;

    let grown_square = two * geometry.centre_distance * chord_length * middle_sine;
    let centre_curvature = (start * start + grown_square).root();
    let curvature_growth = grown_square.over(centre_curvature + start);

    let from = geometry.start_point;
    let chord = Vector2::new(middle_sine, middle_cosine) * chord_length;
    let polar = Turn { along: from.dot(&from) + from.dot(&chord), across: from.perp(&chord) };
    let flank =
        Turn { along: base * base + centre_curvature * start, across: base * curvature_growth };
    let normal = polar.and(&flank);

    let normal_turn = normal.angle();
    let (sine, cosine) = normal.half();
    let bases = base + geometry.driven.base;
    let tangent_length = geometry.start + geometry.driven.tip_curvature;
    let normal_radius_drop = two * sine * (tangent_length * cosine + bases * sine);
    let normal_length_growth =
        two * sine * (bases * cosine - tangent_length * sine) - curvature_growth;
    let normal_radius_driven = geometry.driven.base - normal_radius_drop;
    let normal_length_driven = geometry.driven.tip_curvature + normal_length_growth;
    let (curvature_driver, radius_driven) = if edge > T::zero() {
        let square = normal_radius_driven * normal_radius_driven
            + normal_length_driven * normal_length_driven;
        (geometry.start + curvature_growth, square.root())
    } else {
        (centre_curvature, geometry.driven.tip)
    };
    TipContact {
        angle,
        polar_angle: geometry.start_angle_driven + angle,
        radius_driver: (base * base + curvature_driver * curvature_driver).root(),
        radius_driven,
        curvature_driver,
        curvature_growth,
        normal_turn,
        normal_radius_driven,
        normal_radius_drop,
        normal_length_growth,
        normal_length_driven,
        sliding_arm: (T::one() + geometry.ratio) * geometry.approach_length + normal_length_growth
            - geometry.ratio * curvature_growth,
    }
}

/// A rotation by less than half a revolution, as the image of the x axis.
struct Turn<T> {
    along: T,
    across: T,
}

impl<T: Real> Turn<T> {
    /// The composition of two rotations: the product of complex numbers.
    fn and(&self, other: &Turn<T>) -> Turn<T> {
        Turn {
            along: self.along * other.along - self.across * other.across,
            across: self.along * other.across + self.across * other.along,
        }
    }

    fn angle(&self) -> T {
        self.across.angle_to(self.along)
    }

    /// Sine and cosine of half the angle.
    fn half(&self) -> (T, T) {
        let two: T = 2.0.into();
        let length = (self.along * self.along + self.across * self.across).root();
        let sum = length + self.along;
        let scale = T::one().over((two * length * sum).root());
        (self.across * scale, sum * scale)
    }
}

/// Normal gap S(u) that the tip has closed at the angle u before E, in m, in closed form.
///
/// # Formula
/// ```text
/// S(u) = Δρ1 + rb2 u − rb1 Δχ
/// ```
/// The three terms grow as u and their sum as u². The relative loss of precision is about ε r_b2
/// u/S; see [`gap_by_quadrature`].
pub fn gap<T: Real>(geometry: &Geometry<T>, tip: &TipContact<T>) -> T {
    tip.curvature_growth + geometry.driven.base * tip.angle - geometry.driver.base * tip.normal_turn
}

/// Normal gap S(u), in m, in closed form, or by quadrature if the largest term exceeds the sum by
/// more than the factor `loss`.
pub(super) fn gap_without(loss: f64, geometry: &Geometry, tip: &TipContact) -> f64 {
    let closed = gap(geometry, tip);
    if largest_term(geometry, tip) > loss * closed {
        gap_by_quadrature(geometry, tip)
    } else {
        closed
    }
}

/// The largest term of the gap in closed form, in m, to within a factor of 2.
pub(super) fn largest_term(geometry: &Geometry, tip: &TipContact) -> f64 {
    tip.curvature_growth.abs().max(geometry.driven.base * tip.angle)
}

/// Normal gap S(u), in m, as the integral of dS/du = r_b2 − r_b2', without cancellation.
///
/// The integrand has its branch point at ρ₁ = 0. Near this point the variable of integration is ρ₁,
/// in which the integrand is smooth.
pub fn gap_by_quadrature(geometry: &Geometry, tip: &TipContact) -> f64 {
    let edge = geometry.driven.edge;
    if tip.curvature_driver + edge < std::f64::consts::SQRT_2 * (geometry.start + edge) {
        return tip.angle
            * quadrature::unit_interval(|part| {
                tip_at(geometry, part * tip.angle).normal_radius_drop
            });
    }
    let arm = geometry.centre_distance * (geometry.driven.tip - edge);
    tip.curvature_growth
        * quadrature::unit_interval(|part| {
            let curvature = geometry.start + part * tip.curvature_growth;
            let angle = angle_at_curvature(geometry, curvature);
            let slope = (curvature + edge) / (arm * (geometry.start_angle_driven + angle).sin());
            tip_at(geometry, angle).normal_radius_drop * slope
        })
}

/// The angle u at which the driver's flank has the radius of curvature ρ₁: the inverse of `ρ1² =
/// N1E² + Q(u)`.
pub(super) fn angle_at_curvature(geometry: &Geometry, curvature: f64) -> f64 {
    angle_by_growth(
        geometry,
        (curvature - geometry.start) * (curvature + geometry.start + 2.0 * geometry.driven.edge),
    )
}

/// The angle u at which O₁D² and ρ₁² (for a rounded tip O₁C² and N₁'C²) have grown by
/// `grown_square`: the inverse of Q(u). NaN if the tip circle does not reach so far.
pub fn angle_by_growth(geometry: &Geometry, grown_square: f64) -> f64 {
    let tip = geometry.driven.tip - geometry.driven.edge;
    let fallen = grown_square / (2.0 * geometry.centre_distance * tip);
    let [[sine, cosine]] = geometry.start_direction_driven.data.0;
    let risen = fallen * (2.0 * cosine - fallen);
    let end_sine = (sine * sine + risen).sqrt();
    let sine_growth = if sine > 0.0 { risen / (end_sine + sine) } else { end_sine - sine };
    (cosine * sine_growth + fallen * sine).atan2(cosine * (cosine - fallen) + sine * end_sine)
}

/// The pair with `tip` as reference instead of E, so that [`tip_at`] gives increments from `tip`
/// with full precision near it. Changes only the inputs of `tip_at`; the sliding arm of the result
/// has no meaning.
pub fn seen_from(geometry: &Geometry, tip: &TipContact) -> Geometry {
    let mut moved = *geometry;
    moved.driven.base = tip.normal_radius_driven;
    moved.driven.tip_curvature = tip.normal_length_driven;
    moved.start = tip.curvature_driver;
    moved.start_angle_driven = tip.polar_angle;
    let (sine, cosine) = tip.polar_angle.sin_cos();
    moved.start_direction_driven = Vector2::new(sine, cosine);
    moved.working_pressure_angle += tip.normal_turn;
    moved.start_point =
        foot(geometry.driver.base, moved.start + moved.driven.edge, moved.working_pressure_angle);
    moved
}

impl TipContact {
    /// Distance of D from the point of tangency on the driven base circle, √(O₂D² − r_b2²), in m.
    /// The tooth's compliance uses the load at this place of the flank.
    pub(super) fn load_arm_driven(&self, geometry: &Geometry) -> f64 {
        if geometry.driven.edge <= 0.0 {
            return geometry.driven.tip_curvature;
        }
        geometry.driven.curvature_at(self.radius_driven)
    }

    /// Whether f64 loses digits because the tip nearly rolls, is nearly on the centre line, or its
    /// normal nearly passes through O₂.
    pub(super) fn needs_precision(&self, geometry: &Geometry) -> bool {
        let sliding_terms =
            self.normal_length_driven.abs() + geometry.ratio * self.curvature_driver;
        self.sliding_arm.abs() < LEAST_REST * sliding_terms
            || self.polar_angle.abs() < LEAST_REST * self.angle
            || self.normal_radius_driven.abs() < LEAST_REST * geometry.driven.base
    }
}

impl<T: Real> TipContact<T> {
    pub(super) fn rounded(self) -> TipContact {
        TipContact {
            angle: self.angle.rounded(),
            polar_angle: self.polar_angle.rounded(),
            radius_driver: self.radius_driver.rounded(),
            radius_driven: self.radius_driven.rounded(),
            curvature_driver: self.curvature_driver.rounded(),
            curvature_growth: self.curvature_growth.rounded(),
            normal_turn: self.normal_turn.rounded(),
            normal_radius_driven: self.normal_radius_driven.rounded(),
            normal_radius_drop: self.normal_radius_drop.rounded(),
            normal_length_growth: self.normal_length_growth.rounded(),
            normal_length_driven: self.normal_length_driven.rounded(),
            sliding_arm: self.sliding_arm.rounded(),
        }
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
