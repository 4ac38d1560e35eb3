//! How much of a slice carries if a contact begins or ends within it.

/// The part of a pair that carries in a slice: the mean of what is above 0 of its lead, over the
/// compliance there and times that of the slice, is `part` times the mean lead plus `rest`, in m.
///
/// # Formula
/// ```text
/// ½ ∫ max(0, δ̄ + a t + c (t² − 1/3)) dt   from −1 to 1
/// ```
/// A contact therefore begins and ends continuously within a slice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Carried {
    pub part: f64,
    pub rest: f64,
    /// Change of the part with the mean lead, in 1/m.
    pub change: f64,
}

impl Carried {
    pub(super) const NONE: Carried = Carried { part: 0.0, rest: 0.0, change: 0.0 };
    pub(super) const ALL: Carried = Carried { part: 1.0, rest: 0.0, change: 0.0 };

    /// Of the lead δ̄ + a t + c (t² − 1/3).
    #[inline]
    pub(super) fn of(mean: f64, rise: f64, bend: f64) -> Carried {
        let (middle, most) = (mean - bend / 3.0, rise.abs() + bend.abs());
        if middle > most {
            Carried::ALL
        } else if middle <= -most {
            Carried::NONE
        } else {
            Carried::within(middle, rise, bend)
        }
    }

    /// Of the lead m + a t + c t², which is above 0 in a part of the slice.
    fn within(middle: f64, rise: f64, bend: f64) -> Carried {
        let root = (rise * rise - 4.0 * bend * middle).max(0.0).sqrt();
        let turn = -0.5 * (rise + root.copysign(rise));
        // A root that is no number is at an end.
        let within = |root: f64| if root > -1.0 { root.min(1.0) } else { -1.0 };
        let [one, other] = [middle / turn, turn / bend].map(within);
        let ends = [-1.0, one.min(other), one.max(other), 1.0];
        let mut sum = Carried::NONE;
        for span in ends.windows(2) {
            let (from, to, at) = (span[0], span[1], f64::midpoint(span[0], span[1]));
            if middle + at * (rise + bend * at) > 0.0 {
                let (square, cube) = (to * to - from * from, to.powi(3) - from.powi(3));
                sum.part += 0.5 * (to - from);
                sum.rest += 0.25 * rise * square + bend * (cube - (to - from)) / 6.0;
            }
        }
        for end in [one, other] {
            sum.change += if end.abs() < 1.0 && root > 0.0 { 0.5 / root } else { 0.0 };
        }
        if sum.part > 0.0 { sum } else { Carried::NONE }
    }

    pub(super) fn touches(self) -> bool {
        self.part > 0.0
    }

    pub(super) fn mean(self, lead: f64) -> f64 {
        self.part * lead + self.rest
    }
}
