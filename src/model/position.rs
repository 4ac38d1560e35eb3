//! The first contact D of the driven tip on the driver's flank.

mod search;

use twofloat::TwoFloat;

use super::geometry::{self, Geometry, PairShape};
use super::inputs::{Inputs, Method};
pub use super::tip_gap::{TipContact, gap, gap_by_quadrature, tip_at};
use super::tip_gap::{gap_without, largest_term};
use super::{Deviation, Refusal};
use crate::numeric::{Real, root};
pub(super) use search::{GapSeries, first_contact};
use search::{KEPT_DIGITS, LARGEST_ANGLE};

/// Greatest loss of precision of the closed-form gap in double-double arithmetic, as a factor.
const LOST: f64 = 1e14;

/// Inputs of the first contact, besides geometry and deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionInputs {
    /// `paper` uses the printed equations, every other method the gap.
    pub method: Method,
    /// Shape of the pair, to repeat the search in double-double arithmetic.
    pub shape: PairShape,
    /// Radius of the edge of the driven tip, in m.
    pub tip_radius: Option<f64>,
}

impl PositionInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> PositionInputs {
        PositionInputs {
            method: inputs.method,
            shape: inputs.shape(),
            tip_radius: inputs.driven.tip_radius,
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
    inputs: &PositionInputs,
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
            let precise = geometry::geometry(&inputs.shape)?;
            precise_contact(inputs.method, &precise, deviation, angle)
        }
        None if inputs.method == Method::Exact => (contact, plain.total),
        None => (contact, gap_without(KEPT_DIGITS, geometry, &contact)),
    };
    let closed_gap = if inputs.method == Method::Exact { plain.total } else { closed_gap };
    checked(inputs.tip_radius, geometry, plain.total, contact, closed_gap)
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
