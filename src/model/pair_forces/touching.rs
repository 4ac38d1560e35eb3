//! Subsets of the pairs of a set.

/// A subset of pairs, one bit per pair, usually the pairs in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Touching(u64);

impl Touching {
    /// No pair.
    pub const NONE: Touching = Touching(0);

    /// Whether the subset includes the pair.
    #[must_use]
    pub fn has(self, pair: usize) -> bool {
        self.0 & 1 << pair != 0
    }

    /// Whether the subset is empty.
    #[must_use]
    pub fn is_none(self) -> bool {
        self.0 == 0
    }

    /// The subset with the membership of the pair inverted.
    #[must_use]
    pub fn toggled(self, pair: usize) -> Touching {
        Touching(self.0 ^ 1 << pair)
    }

    /// The subset with the pair added.
    #[must_use]
    pub fn with(self, pair: usize) -> Touching {
        Touching(self.0 | 1 << pair)
    }

    /// The members before a pair.
    #[must_use]
    pub fn before(self, pair: usize) -> Touching {
        Touching(self.0 & !u64::MAX.checked_shl(pair as u32).unwrap_or(0))
    }

    /// The members from a pair on, renumbered from that pair.
    #[must_use]
    pub fn since(self, pair: usize) -> Touching {
        Touching(self.0.checked_shr(pair as u32).unwrap_or(0))
    }

    /// The members, the rearmost first.
    pub fn pairs(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let pair = (rest != 0).then(|| rest.trailing_zeros() as usize);
            rest &= rest.wrapping_sub(1);
            pair
        })
    }
}
