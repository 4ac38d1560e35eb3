//! Detects a warm-up that repeats: before the incoming tooth is near, all base pitches are alike.

use super::acting::ALIKE;
use super::motion::{Motion, State};
use super::pair::PairName;

/// A relative change of the state below this value is rounding.
const ROUNDING: f64 = 1e-14;

/// The state one base pitch before.
pub(super) struct RepeatDetector {
    /// Start of the next base pitch, in base pitches.
    next: f64,
    start: f64,
    last: Option<Lap>,
    /// Relative change of the state that counts as none.
    allowed: f64,
}

struct Lap {
    y: State,
    touching: Vec<PairName>,
    /// Relative change since the lap before.
    moved: f64,
}

impl RepeatDetector {
    /// A warm-up that begins at `start`, in m.
    pub(super) fn new(start: f64, tolerance: f64) -> RepeatDetector {
        /// Part of the tolerance that limits the error of a converging state.
        const PART: f64 = 1e-3;
        RepeatDetector {
            next: 1.0,
            start,
            last: None,
            allowed: (PART * tolerance).max(10.0 * ROUNDING),
        }
    }

    /// Whether the state at `s`, in m, equals the state one base pitch before. For a converging
    /// state, whose changes fall by half or more with each base pitch, the sum of all further
    /// changes is less than the last change. Different contacts are not a repetition.
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
        let moved =
            alike.map_or(f64::INFINITY, |lap| (y - lap.y).component_div(&motion.scale()).amax());
        let draws_near = before.is_some_and(|lap| moved <= 0.5 * lap.moved);
        self.last = Some(Lap { y: *y, touching, moved });
        moved <= if draws_near { self.allowed } else { ROUNDING }
    }
}
