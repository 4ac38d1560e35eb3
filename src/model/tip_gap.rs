//! The driven tip on its circle and its gap to the driver's flank.

use nalgebra::Vector2;

use super::geometry::{Geometry, LEAST_REST, foot};
use crate::numeric::{Real, quadrature};

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
#[must_use]
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
#[must_use]
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
#[must_use]
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
        let (radius, base) = (self.radius_driven, geometry.driven.base);
        ((radius - base) * (radius + base)).max(0.0).sqrt()
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
