//! The lead of a pair over a step as a function of the displacement: force or overlap.

use crate::numeric::chebyshev;
use crate::numeric::polynomial::{Bernstein, Polynomial, first_fall, sign_changes};

/// Number of terms of a step's series, the fastest choice at tolerances from 1e-3 to 1e-11.
pub(super) const TERMS: usize = 28;

/// Number of terms of the incoming tooth's force, the product of stiffness and deflection.
pub(super) const FORCE_TERMS: usize = TERMS + chebyshev::TERMS;

/// A value of the mesh over a step.
pub(super) type Along = Polynomial<{ chebyshev::TERMS }>;

/// The force of a touching pair, or the overlap of another pair. A pair gains or loses contact
/// where its sign changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lead {
    /// x minus this gap, in m, for a pair that is an independent spring.
    Gap(Along),
    /// `slope · x − offset` of a coupled pair: its force in N if it touches, otherwise its overlap
    /// in m.
    Shared { slope: Along, offset: Along },
}

impl Lead {
    /// The first part of the step where the lead times `sign` falls below 0. If the pair `turned`
    /// at the beginning, the lead is 0 there within rounding.
    pub(super) fn first_fall(
        &self,
        ahead: &Polynomial<TERMS>,
        sign: f64,
        turned: bool,
    ) -> Option<f64> {
        match self {
            Lead::Gap(gap) => fall(&ahead.plus(-1.0, gap).scaled(sign), turned),
            Lead::Shared { .. } => fall(&self.over(ahead).scaled(sign), turned),
        }
    }

    /// The greatest value of the lead over a step, or `least` if that is greater.
    pub(super) fn most(&self, ahead: &Polynomial<TERMS>, least: f64) -> f64 {
        match self {
            Lead::Gap(gap) => most(&ahead.plus(-1.0, gap), least),
            Lead::Shared { .. } => most(&self.over(ahead), least),
        }
    }

    /// The lead for a displacement.
    pub(super) fn over(&self, ahead: &Polynomial<TERMS>) -> Polynomial<FORCE_TERMS> {
        match self {
            Lead::Gap(gap) => Polynomial::ZERO.plus(1.0, ahead).plus(-1.0, gap),
            Lead::Shared { slope, offset } => {
                ahead.times::<{ chebyshev::TERMS }, FORCE_TERMS>(slope).plus(-1.0, offset)
            }
        }
    }

    /// Whether the lead keeps its sign for all displacements in the range: above 0 for a touching
    /// pair, below 0 for another pair.
    pub(super) fn is_clear(&self, touches: bool, (least, most): (f64, f64)) -> bool {
        let (low, high) = match self {
            Lead::Gap(gap) => {
                let varying = variation(gap);
                (least - (gap.0[0] + varying), most - (gap.0[0] - varying))
            }
            Lead::Shared { slope, offset } => {
                let ends = [least * slope.0[0], most * slope.0[0]];
                let varying = variation(slope) * least.abs().max(most.abs()) + variation(offset);
                let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                (low - (offset.0[0] + varying), high - (offset.0[0] - varying))
            }
        };
        if touches { low > 0.0 } else { high < 0.0 }
    }
}

/// Greatest difference of a polynomial from its value at 0.
fn variation<const N: usize>(polynomial: &Polynomial<N>) -> f64 {
    let varying = polynomial.0[1..].iter();
    varying.map(|coefficient| coefficient.abs()).sum()
}

fn fall<const N: usize>(kept: &Polynomial<N>, turned: bool) -> Option<f64> {
    if turned && (kept.0[0] < 0.0 || is_rounding(kept)) {
        first_fall(&kept.over_argument())
    } else {
        first_fall(kept)
    }
}

/// Whether the value at 0 is rounding compared with the variation of the polynomial.
fn is_rounding<const N: usize>(kept: &Polynomial<N>) -> bool {
    const ROUNDING: f64 = 1e-9;
    kept.0[0].abs() <= ROUNDING * variation(kept)
}

fn most<const N: usize>(lead: &Polynomial<N>, least: f64) -> f64 {
    if Bernstein::of(lead).bounds().1 <= least {
        return least;
    }
    let turns = sign_changes(&lead.derivative());
    let places = turns.into_iter().chain([0.0, 1.0]);
    places.map(|part| lead.at(part)).fold(least, f64::max)
}
