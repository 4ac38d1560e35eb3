//! By how much a pair is pressed or apart over a step, as a function of the displacement.

use crate::numeric::bernstein::{Bernstein, first_fall, sign_changes};
use crate::numeric::chebyshev;
use crate::numeric::polynomial::Polynomial;

/// Terms of a step's series: as many as take the least time, at tolerances from 1e-3 to 1e-11.
pub(super) const TERMS: usize = 28;

/// Terms of the incoming tooth's force, all that its stiffness times its deflection has.
pub(super) const FORCE_TERMS: usize = TERMS + chebyshev::TERMS;

/// What is known of the mesh over a step.
pub(super) type Along = Polynomial<{ chebyshev::TERMS }>;

/// The product of two polynomials of the mesh.
pub(super) type Product = Polynomial<{ 2 * chebyshev::TERMS }>;

/// By how much a pair presses (if it touches) or would overlap (if it does not): the sign changes
/// where the pair touches or leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "the few leads of a step are read at once"
)]
pub(super) enum Lead {
    /// x less this gap, in m, of a pair that is a spring of its own.
    Gap(Along),
    /// `slope · x − offset` of a coupled pair: its force in N if it touches, else by how much it
    /// would overlap, in m.
    Shared { slope: Along, offset: Product },
}

impl Lead {
    /// When it first falls below 0, times `sign`, as a part of the step. If it `turned` at the
    /// beginning, it is 0 there within rounding.
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

    /// The most by which it is above 0 over a step, where that is more than `least`.
    pub(super) fn most(&self, ahead: &Polynomial<TERMS>, least: f64) -> f64 {
        match self {
            Lead::Gap(gap) => most(&ahead.plus(-1.0, gap), least),
            Lead::Shared { .. } => most(&self.over(ahead), least),
        }
    }

    /// The lead with a displacement.
    pub(super) fn over(&self, ahead: &Polynomial<TERMS>) -> Polynomial<FORCE_TERMS> {
        match self {
            Lead::Gap(gap) => Polynomial::ZERO.plus(1.0, ahead).plus(-1.0, gap),
            Lead::Shared { slope, offset } => ahead
                .times::<{ chebyshev::TERMS }, FORCE_TERMS>(slope)
                .plus(-1.0, offset),
        }
    }

    /// The same over a part of the step.
    pub(super) fn stretched(&self, part: f64) -> Lead {
        match self {
            Lead::Gap(gap) => Lead::Gap(gap.stretched(part)),
            Lead::Shared { slope, offset } => Lead::Shared {
                slope: slope.stretched(part),
                offset: offset.stretched(part),
            },
        }
    }

    /// Whether it keeps its sign wherever in its range the displacement is: above 0 of a pair that
    /// touches, below 0 of one apart.
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
                (
                    low - (offset.0[0] + varying),
                    high - (offset.0[0] - varying),
                )
            }
        };
        if touches { low > 0.0 } else { high < 0.0 }
    }
}

/// How far a polynomial may be from its value at 0.
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

/// Whether the value at 0 is none against how the polynomial varies.
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
