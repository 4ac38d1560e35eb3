//! Some pairs of a set.

/// Some pairs of a set, a bit each: mostly those in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Touching(u64);

impl Touching {
    /// No pair.
    pub const NONE: Touching = Touching(0);

    /// Whether the pair is one of them.
    #[must_use]
    pub fn has(self, pair: usize) -> bool {
        self.0 & 1 << pair != 0
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_none(self) -> bool {
        self.0 == 0
    }

    /// The set with the pair touching where it did not, and the other way round.
    #[must_use]
    pub fn toggled(self, pair: usize) -> Touching {
        Touching(self.0 ^ 1 << pair)
    }

    /// The set with the pair.
    #[must_use]
    pub fn with(self, pair: usize) -> Touching {
        Touching(self.0 | 1 << pair)
    }

    /// Those before a pair.
    #[must_use]
    pub fn before(self, pair: usize) -> Touching {
        Touching(self.0 & !u64::MAX.checked_shl(pair as u32).unwrap_or(0))
    }

    /// Those from a pair on, counted from it.
    #[must_use]
    pub fn since(self, pair: usize) -> Touching {
        Touching(self.0.checked_shr(pair as u32).unwrap_or(0))
    }

    /// The pairs, the rearmost first.
    pub fn pairs(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let pair = (rest != 0).then(|| rest.trailing_zeros() as usize);
            rest &= rest.wrapping_sub(1);
            pair
        })
    }
}
