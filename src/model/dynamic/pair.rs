//! A pair of teeth in the motion: its flanks, its name and where it stands.

/// A side of the teeth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Flank {
    /// The flanks that transmit the torque.
    Working,
    /// The flanks that meet where the driver falls behind by the backlash.
    Back,
}

/// A pair of flanks and where it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PairName {
    pub(super) flank: Flank,
    /// How many base pitches it is ahead of the incoming pair, or of the back pair that is next
    /// to B' in the mirror.
    pub(super) ahead: i32,
}

impl PairName {
    /// The pair of working flanks that many base pitches ahead of the incoming one.
    pub(super) fn working(ahead: i32) -> PairName {
        PairName {
            flank: Flank::Working,
            ahead,
        }
    }

    /// The pair that many base pitches further ahead.
    pub(super) fn moved(self, pitches: i32) -> PairName {
        PairName {
            ahead: self.ahead + pitches,
            ..self
        }
    }
}

/// A pair that may touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Standing {
    pub(super) flank: Flank,
    /// How many base pitches it is ahead of the incoming one.
    pub(super) ahead: i32,
    /// The zone of the mesh in which it stands.
    pub(super) zone: usize,
    /// Which way the driven flank slides on the driver's.
    pub(super) direction: f64,
}

impl Standing {
    pub(super) fn name(&self) -> PairName {
        PairName {
            flank: self.flank,
            ahead: self.ahead,
        }
    }
}
