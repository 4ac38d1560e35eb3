//! Where the driven tip first touches the driver's flank: D.

use nalgebra::Vector2;
use twofloat::TwoFloat;

use super::geometry::{self, Geometry, LEAST_REST};
use super::inputs::{Inputs, Rung};
use super::{Deviation, Refusal};
use crate::numeric::{Real, quadrature};

/// Half a turn and more never brings a tip back: no contact is sought beyond, in rad.
const LARGEST_ANGLE: f64 = 1.5;

/// A place of the driven tip on its circle, and the driver's flank that it would touch there.
///
/// What changes from E is carried as an increment, so that nothing is lost close to E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipContact<T = f64> {
    /// Driven gear's angle before E, u, in rad.
    pub angle: T,
    /// O₁D, in m.
    pub radius_driver: T,
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
    /// Gap that the tip has closed there, S(u), in m: Δ in the rung `exact`, far less in `paper`.
    pub closed_gap: f64,
}

/// The driven tip at the angle `angle` before E.
///
/// # Formula
/// ```text
/// Q = 4 a ra2 sin(u/2) sin(γ2 + u/2),  O1D² = O1E² + Q,  ρ1 = √(N1E² + Q),  Δρ1 = Q/(ρ1 + N1E)
/// Δβ1 = atan2(rb1 Δρ1, rb1² + ρ1 N1E),  Δψ = atan2(E × D, E · D),  Δχ = Δψ + Δβ1
/// rb2 − rb2' = 2 a sin(αw + Δχ/2) sin(Δχ/2),  N2'D = N2E + 2 a cos(αw + Δχ/2) sin(Δχ/2) − Δρ1
/// N2'D − i ρ1 = (1 + i) EP + Δ(N2'D) − i Δρ1
/// ```
/// where E and D are seen from O₁, D − E is the chord of the tip circle, EP is the path of approach and Δ the growth
/// since E.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 7, 24-28, 48, 49, rewritten as increments from E; Eq. 27 mended to the law of cosines.
///
/// # Valid for
/// Any angle at which the tip lies outside the driver's base circle (`N1E² + Q > 0`).
pub fn tip_at<T: Real>(geometry: &Geometry<T>, angle: T) -> TipContact<T> {
    let (half, two): (T, T) = (0.5.into(), 2.0.into());
    let (base, start) = (geometry.driver.base, geometry.start);
    let half_sine = (angle * half).sine_cosine().0;
    let (middle_sine, middle_cosine) = (geometry.start_angle_driven + angle * half).sine_cosine();
    let chord_length = two * geometry.driven.tip * half_sine;

    let grown_square = two * geometry.centre_distance * chord_length * middle_sine;
    let curvature_driver = (start * start + grown_square).root();
    let curvature_growth = grown_square.over(curvature_driver + start);
    let flank_turn = (base * curvature_growth).angle_to(base * base + curvature_driver * start);

    let from = geometry.start_point;
    let chord = Vector2::new(middle_sine, middle_cosine) * chord_length;
    let polar_turn = from.perp(&chord).angle_to(from.dot(&from) + from.dot(&chord));

    let normal_turn = polar_turn + flank_turn;
    let turn_chord = two * geometry.centre_distance * (normal_turn * half).sine_cosine().0;
    let (sine, cosine) = (geometry.working_pressure_angle + normal_turn * half).sine_cosine();
    let normal_radius_drop = turn_chord * sine;
    let normal_length_growth = turn_chord * cosine - curvature_growth;
    TipContact {
        angle,
        radius_driver: (base * base + curvature_driver * curvature_driver).root(),
        curvature_driver,
        curvature_growth,
        normal_turn,
        normal_radius_driven: geometry.driven.base - normal_radius_drop,
        normal_radius_drop,
        normal_length_growth,
        normal_length_driven: geometry.driven.tip_curvature + normal_length_growth,
        sliding_arm: (T::one() + geometry.ratio) * geometry.approach_length + normal_length_growth
            - geometry.ratio * curvature_growth,
    }
}

/// Normal gap S(u) that the tip has closed at the angle u before E, in m, in closed form.
///
/// # Formula
/// ```text
/// S(u) = Δρ1 + rb2 u − rb1 Δχ
/// ```
/// The three terms grow as u and their sum as u², so that about ε r_b2 u/S is lost; see [`gap_by_quadrature`].
pub fn gap<T: Real>(geometry: &Geometry<T>, tip: &TipContact<T>) -> T {
    tip.curvature_growth + geometry.driven.base * tip.angle - geometry.driver.base * tip.normal_turn
}

/// Normal gap S(u), in m, as the integral of dS/du = r_b2 − r_b2', which cancels nothing.
///
/// The integrand has its branch point where ρ₁ = 0. Where that is near, ρ₁ itself is the variable, in which the
/// integrand is smooth.
#[must_use]
pub fn gap_by_quadrature(geometry: &Geometry, tip: &TipContact) -> f64 {
    if tip.curvature_driver < std::f64::consts::SQRT_2 * geometry.start {
        return tip.angle * quadrature::unit_interval(|part| tip_at(geometry, part * tip.angle).normal_radius_drop);
    }
    let arm = geometry.centre_distance * geometry.driven.tip;
    tip.curvature_growth
        * quadrature::unit_interval(|part| {
            let curvature = geometry.start + part * tip.curvature_growth;
            let angle = angle_at_curvature(geometry, curvature);
            let slope = curvature / (arm * (geometry.start_angle_driven + angle).sin());
            tip_at(geometry, angle).normal_radius_drop * slope
        })
}

/// The angle u at which the driver's flank has the radius of curvature ρ₁: the inverse of `ρ1² = N1E² + Q(u)`.
fn angle_at_curvature(geometry: &Geometry, curvature: f64) -> f64 {
    angle_by_growth(geometry, (curvature - geometry.start) * (curvature + geometry.start))
}

/// The angle u at which O₁D² and ρ₁² have grown by `grown_square`: the inverse of Q(u). NaN where the tip circle does not
/// reach so far.
#[must_use]
pub fn angle_by_growth(geometry: &Geometry, grown_square: f64) -> f64 {
    let fallen = grown_square / (2.0 * geometry.centre_distance * geometry.driven.tip);
    let (sine, cosine) = geometry.start_angle_driven.sin_cos();
    let risen = fallen * (2.0 * cosine - fallen);
    let end_sine = (sine * sine + risen).sqrt();
    let sine_growth = if sine > 0.0 { risen / (end_sine + sine) } else { end_sine - sine };
    (cosine * sine_growth + fallen * sine).atan2(cosine * (cosine - fallen) + sine * end_sine)
}

/// The pair as seen from `tip` in place of E, so that [`tip_at`] gives what changes from there and loses nothing close to
/// it. Only what `tip_at` reads is moved, and its sliding arm has no meaning then.
#[must_use]
pub fn seen_from(geometry: &Geometry, tip: &TipContact) -> Geometry {
    let mut moved = *geometry;
    moved.driven.base = tip.normal_radius_driven;
    moved.driven.tip_curvature = tip.normal_length_driven;
    moved.start = tip.curvature_driver;
    moved.start_angle_driven += tip.angle;
    moved.working_pressure_angle += tip.normal_turn;
    moved.start_point = geometry::foot(geometry.driver.base, moved.start, moved.working_pressure_angle);
    moved
}

/// The angle u at which the tip has closed the gap Δ: `S(u) = Δ`.
///
/// Newton's method on ln S against ln u from the parabola at E, until a last step with the gap by quadrature, or in
/// closed form where that has kept its digits.
///
/// # Errors
/// [`Refusal::NoFirstContact`] where the steps do not settle: no turn of the gear would bridge such a deviation.
fn first_contact(geometry: &Geometry, deviation: f64) -> Result<f64, Refusal> {
    const STEPS: usize = 60;
    const SETTLED: f64 = 1e-4;
    const KEPT_DIGITS: f64 = 64.0;
    let mut angle = (2.0 * deviation / gap_curvature_at_start(geometry)).sqrt();
    for _ in 0..STEPS {
        let tip = tip_at(geometry, angle);
        let step = logarithmic_step(&tip, gap(geometry, &tip), deviation);
        if !step.is_finite() || angle > LARGEST_ANGLE {
            break;
        }
        angle *= step.clamp(-2.0, 2.0).exp();
        if step.abs() < SETTLED {
            let tip = tip_at(geometry, angle);
            let lost = geometry.driven.base * angle > KEPT_DIGITS * deviation;
            let closed = if lost { gap_by_quadrature(geometry, &tip) } else { gap(geometry, &tip) };
            return Ok(angle * (1.0 + logarithmic_step(&tip, closed, deviation)));
        }
    }
    Err(Refusal::NoFirstContact { deviation })
}

/// Newton's step of ln u towards `S = deviation`.
fn logarithmic_step(tip: &TipContact, closed: f64, deviation: f64) -> f64 {
    (deviation / closed).ln() * closed / (tip.angle * tip.normal_radius_drop)
}

/// The angle u improved by Newton steps in double-double arithmetic, in which the closed form of the gap keeps its
/// digits down to the smallest deviations.
fn refine(geometry: &Geometry<TwoFloat>, angle: f64, deviation: TwoFloat) -> TwoFloat {
    const STEPS: usize = 3;
    (0..STEPS).fold(angle.into(), |angle, _| {
        let tip = tip_at(geometry, angle);
        angle - (gap(geometry, &tip) - deviation).over(tip.normal_radius_drop)
    })
}

/// S''(0) = (ρ1E + ρ2E) ρ2E/ρ1E, in m.
fn gap_curvature_at_start(geometry: &Geometry) -> f64 {
    let (driver, driven) = (geometry.start, geometry.driven.tip_curvature);
    (driver + driven) * driven / driver
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
/// Zhou & Chen 2014, Eqs. 11-20. Mended: the differences of arctangents (Eqs. 14, 17-19), which jump by π where
/// Δf > N₁E, are taken as one; Eqs. 16 and 20 without the rounded contact ratio. Kept as printed: the result is linear
/// in Δ, where the tip's gap grows as u².
fn printed_contact<T: Real>(geometry: &Geometry<T>, deviation: &Deviation<T>) -> T {
    let base = geometry.driver.base;
    let turn = |from: T, by: T| (base * by).angle_to(base * base + from * (from - by));
    let error = deviation.equivalent_error;
    let ahead = geometry.start + geometry.base_pitch - error;
    (turn(geometry.start, error) + turn(ahead, deviation.combined_deflection)).over(geometry.ratio)
}

/// Reduced radius of curvature at the tip's contact ρ_S = ρ1 ρ2/(ρ1 + ρ2), in m; ρ2 is the driven flank's own at its
/// tip, or the radius of the tip's edge where the case gives one (Zhou & Chen 2014, below Eq. 32).
#[must_use]
pub fn reduced_curvature(inputs: &Inputs, geometry: &Geometry, tip: &TipContact) -> f64 {
    let driven = inputs.driven.tip_radius.unwrap_or(geometry.driven.tip_curvature);
    tip.curvature_driver * driven / (tip.curvature_driver + driven)
}

/// Where the tip first touches, by the rung; `None` where no tooth strikes. With `precise`, the same geometry in
/// double-double arithmetic, the exact position is good to the last digit.
///
/// # Errors
/// A [`Refusal`] where D does not exist or lies beyond the driver's tip.
pub fn position(
    inputs: &Inputs,
    geometry: &Geometry,
    precise: Option<&Geometry<TwoFloat>>,
    deviation: &Deviation<TwoFloat>,
) -> Result<Option<Position>, Refusal> {
    let plain = deviation.rounded();
    if plain.total <= 0.0 {
        return Ok(None);
    }
    let angle = match inputs.rung {
        Rung::Paper => printed_contact(geometry, &plain),
        Rung::Exact => first_contact(geometry, plain.total)?,
    };
    let contact = tip_at(geometry, angle);
    let close_call = contact.is_close_call(geometry) || inputs.rung == Rung::Paper && plain.equivalent_error < 0.0;
    let contact = match precise {
        Some(precise) => precise_contact(inputs, precise, deviation, angle),
        None if close_call => precise_contact(inputs, &geometry::geometry(inputs)?, deviation, angle),
        None => contact,
    };
    checked(inputs, geometry, &plain, contact)
}

/// The contact in double-double arithmetic, near the angle that f64 has found.
fn precise_contact(inputs: &Inputs, geometry: &Geometry<TwoFloat>, deviation: &Deviation<TwoFloat>, near: f64) -> TipContact {
    let angle = match inputs.rung {
        Rung::Paper => printed_contact(geometry, deviation),
        Rung::Exact => refine(geometry, near, deviation.total),
    };
    tip_at(geometry, angle).rounded()
}

/// The contact as a position, where there is one on the driver's flank.
fn checked(
    inputs: &Inputs,
    geometry: &Geometry,
    deviation: &Deviation,
    contact: TipContact,
) -> Result<Option<Position>, Refusal> {
    if contact.angle <= 0.0 {
        return Ok(None);
    }
    if !contact.radius_driver.is_finite() || contact.angle > LARGEST_ANGLE {
        return Err(Refusal::NoFirstContact { deviation: deviation.total });
    }
    if contact.radius_driver > geometry.driver.tip {
        return Err(Refusal::BeyondDriverTip { radius: contact.radius_driver, tip: geometry.driver.tip });
    }
    let closed_gap = match inputs.rung {
        Rung::Paper => gap_by_quadrature(geometry, &contact),
        Rung::Exact => deviation.total,
    };
    Ok(Some(Position {
        approach_angle_driver: contact.angle * inputs.ratio(),
        approach_angle_driven: contact.angle,
        contact,
        curvature_radius: reduced_curvature(inputs, geometry, &contact),
        closed_gap,
    }))
}

impl TipContact {
    /// Whether the tip all but rolls, or its normal all but passes through O₂: f64 loses digits in the small rest.
    fn is_close_call(&self, geometry: &Geometry) -> bool {
        let sliding_terms = self.normal_length_driven.abs() + geometry.ratio * self.curvature_driver;
        self.sliding_arm.abs() < LEAST_REST * sliding_terms || self.normal_radius_driven.abs() < LEAST_REST * geometry.driven.base
    }
}

impl<T: Real> TipContact<T> {
    /// Rounded to f64.
    fn rounded(self) -> TipContact {
        TipContact {
            angle: self.angle.rounded(),
            radius_driver: self.radius_driver.rounded(),
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
