//! A pair of flanks in the motion: its side, its name and its place.

/// A side of the teeth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Flank {
    /// The flanks that transmit the torque.
    Working,
    /// The flanks that touch if the driver falls behind by the backlash.
    Back,
}

/// Side and number of a pair of flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PairName {
    pub(super) flank: Flank,
    /// Number of base pitches ahead of the incoming pair, or of the back pair next to B' in the
    /// mirror.
    pub(super) ahead: i32,
}

impl PairName {
    /// The pair of working flanks `ahead` base pitches ahead of the incoming pair.
    pub(super) fn working(ahead: i32) -> PairName {
        PairName { flank: Flank::Working, ahead }
    }

    /// The pair `pitches` base pitches farther ahead.
    pub(super) fn moved(self, pitches: i32) -> PairName {
        PairName { ahead: self.ahead + pitches, ..self }
    }
}

/// A pair that may touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Standing {
    pub(super) flank: Flank,
    /// Number of base pitches ahead of the incoming pair.
    pub(super) ahead: i32,
    /// The zone of the mesh.
    pub(super) zone: usize,
    /// Sign of the sliding velocity of the driven flank on the driver's.
    pub(super) direction: f64,
}

impl Standing {
    pub(super) fn name(&self) -> PairName {
        PairName { flank: self.flank, ahead: self.ahead }
    }
}
