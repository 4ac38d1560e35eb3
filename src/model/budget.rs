//! How much work a solve may take: counted and not timed, so that a case ends in the same way on
//! every machine.
//!
//! A unit of work is a power series of the motion, or a place at which the mesh is computed: about
//! half a microsecond. The parts of a solve have budgets of their own, so that what one part took
//! changes nothing in the next, whether it was computed or kept from an earlier solve.

use std::cell::Cell;

/// Work of one motion, about a second. Of the cases and reference pairs the longest takes a
/// hundredth of it.
pub const MOTION_WORK: u64 = 2_000_000;

/// Work of a contact made or lost: the search for its time evaluates the series some thirty times.
pub const EVENT_WORK: u64 = 8;

/// Work of the compliance of a tooth: the integrals over its profile.
pub const TOOTH_WORK: u64 = 8;

/// Swings of the mesh while a motion lasts. Of slower motions the steps never fit into
/// [`MOTION_BYTES`]: those of Table 1 with 71.6 N m fill them at 0.25 rpm, with 3e5 swings. The
/// limit refuses such a motion at once.
pub const MOTION_SWINGS: f64 = 4e5;

/// Bytes in which a motion keeps its steps while the incoming tooth is near, of the 64 MiB that a
/// solve may take. The list of steps grows by a quarter, and while it grows its old and its new
/// room take 54 MiB. Later the rest is for the places of the curve (20 MB), the mesh and the
/// stations.
pub const MOTION_BYTES: usize = 24 << 20;

/// Pairs that may touch at a time: as many as a set of them has bits. Two gears of 1000 teeth have
/// forty where their tip circles overlap most.
pub const PAIRS: usize = 64;

/// Motions or balances that the search for the required tip relief tries. An ordinary search takes
/// 15, and one in which the gears rattle 60 a round; few need a second round.
pub const SEARCH_TRIES: u32 = 400;

/// Work of all of them, as much as of the longest motion.
pub const SEARCH_WORK: u64 = MOTION_WORK;

/// Work of the places at which a curve is computed in search of the stations that it needs, a fifth
/// of a second. A motion of [`MOTION_SWINGS`] is computed in four places a half swing.
pub const CURVE_WORK: usize = 400_000;

/// Work of such a place between D and E: the compliance of two teeth and an impact.
pub const IMPACT_WORK: usize = 20;

/// Stations before E, and as many after it: 5 MB each, beside the steps of the motion and the
/// places of the curve.
pub const STATIONS: usize = 50_000;

/// Stations where the force turns, beside the number that the case gives: four times the greatest
/// number that it may give.
pub const TURNS: usize = 40_000;

/// Counts work against its limit.
#[derive(Debug)]
pub struct Meter {
    limit: u64,
    spent: Cell<u64>,
}

impl Meter {
    /// Nothing is spent yet.
    #[must_use]
    pub fn new(limit: u64) -> Meter {
        Meter {
            limit,
            spent: Cell::new(0),
        }
    }

    /// Counts this much; whether it is within the limit.
    pub fn spend(&self, work: u64) -> bool {
        self.spent.set(self.spent.get().saturating_add(work));
        self.spent.get() <= self.limit
    }

    /// The work so far.
    #[must_use]
    pub fn spent(&self) -> u64 {
        self.spent.get()
    }

    /// The limit.
    #[must_use]
    pub fn limit(&self) -> u64 {
        self.limit
    }
}
