//! Limits of the work of a solve. Work is counted, not timed, so that the result does not depend on
//! the machine.
//!
//! A unit of work is a power series of the motion, or a place where the mesh is computed: about
//! half a microsecond. Each part of a solve has its own budget, so that cached parts do not change
//! the result.

use std::cell::Cell;

/// Work of one motion, about a second. The longest motion of the cases and reference pairs needs a
/// hundredth of this limit.
pub const MOTION_WORK: u64 = 2_000_000;

/// Work of the search for the time of a contact event: about thirty evaluations of the series.
pub const EVENT_WORK: u64 = 8;

/// Oscillations of the mesh during a motion. The steps of slower motions exceed [`MOTION_BYTES`]:
/// Table 1 with 71.6 N m fills them at 0.25 rpm, with 3e5 oscillations. The limit refuses such a
/// motion before it begins.
pub const MOTION_OSCILLATIONS: f64 = 4e5;

/// Memory for the steps of a motion near the incoming tooth, in bytes. A solve has 64 MiB. The list
/// of steps grows by a quarter; during growth, the old and the new list use 54 MiB. Afterwards the
/// rest is for the places of the curve (20 MB), the mesh and the stations.
pub const MOTION_BYTES: usize = 24 << 20;

/// Greatest number of pairs in contact, one bit each in a set. Two gears of 1000 teeth have forty
/// at the largest overlap of their tip circles.
pub const PAIRS: usize = 64;

/// Motions or balances in the search for the required tip relief. An ordinary search needs 15. If
/// the gears rattle, a round needs 60; few searches need a second round.
pub const SEARCH_TRIES: u32 = 400;

/// Work of all motions of this search, equal to the work of the longest motion.
pub const SEARCH_WORK: u64 = MOTION_WORK;

/// Work of the places where a curve is computed to select its stations: a fifth of a second. A
/// motion of [`MOTION_OSCILLATIONS`] has four places for each half oscillation.
pub const CURVE_WORK: usize = 400_000;

/// Work of a place between D and E: the compliance of two teeth and an impact.
pub const IMPACT_WORK: usize = 20;

/// Stations before E, and the same number after E. Each list uses 5 MB besides the steps of the
/// motion and the places of the curve.
pub const STATIONS: usize = 50_000;

/// Stations at the turning points of the force, besides the number that the case gives: four times
/// the greatest number that a case can give.
pub const TURNS: usize = 40_000;

/// Counts work against its limit.
#[derive(Debug)]
pub struct Meter {
    limit: u64,
    spent: Cell<u64>,
}

impl Meter {
    /// A meter with no work counted.
    pub fn new(limit: u64) -> Meter {
        Meter { limit, spent: Cell::new(0) }
    }

    /// Adds `work`. Returns whether the total is within the limit.
    pub fn spend(&self, work: u64) -> bool {
        self.spent.set(self.spent.get().saturating_add(work));
        self.spent.get() <= self.limit
    }

    /// The total work.
    pub fn spent(&self) -> u64 {
        self.spent.get()
    }
}
