//! Whether the warm-up has come to repeat itself: before the incoming tooth is near, every base
//! pitch is like the one before.

use super::acting::ALIKE;
use super::motion::{Motion, State};
use super::pair::PairName;

/// A change, over the state's scale, that is none.
const ROUNDING: f64 = 1e-14;

/// The state a base pitch ago.
pub(super) struct Laps {
    /// Where the next base pitch begins, in units of them.
    next: f64,
    start: f64,
    last: Option<Lap>,
    /// The change that counts as none, over the state's scale.
    allowed: f64,
}

struct Lap {
    y: State,
    touching: Vec<PairName>,
    /// How far it is from the one before.
    moved: f64,
}

impl Laps {
    /// The warm-up begins at `start`, in m.
    pub(super) fn new(start: f64, tolerance: f64) -> Laps {
        /// Of the tolerance: it lets a state that draws near go no further than rounding would.
        const PART: f64 = 1e-3;
        Laps {
            next: 1.0,
            start,
            last: None,
            allowed: (PART * tolerance).max(10.0 * ROUNDING),
        }
    }

    /// Whether the state at `s`, in m, is that of a base pitch ago, drawing nearer with each of
    /// them at least by half: what it would still move in all is then less than it moved last.
    /// Contacts that differ are no repetition.
    pub(super) fn repeats(
        &mut self,
        motion: &Motion<'_>,
        s: f64,
        y: &State,
        touching: &[PairName],
    ) -> bool {
        let pitch = motion.mesh.base_pitch;
        if (s - self.start - self.next * pitch).abs() > ALIKE * pitch {
            return false;
        }
        self.next += 1.0;
        let mut touching = touching.to_vec();
        touching.sort_unstable();
        let before = self.last.take();
        let alike = before.as_ref().filter(|lap| {
            let later = lap.touching.iter().map(|pair| pair.moved(-1));
            later.eq(touching.iter().copied())
        });
        let moved = alike.map_or(f64::INFINITY, |lap| {
            (y - lap.y).component_div(&motion.scale()).amax()
        });
        let draws_near = before.is_some_and(|lap| moved <= 0.5 * lap.moved);
        self.last = Some(Lap {
            y: *y,
            touching,
            moved,
        });
        moved <= if draws_near { self.allowed } else { ROUNDING }
    }
}
