//! A curve looked at more closely where it is bent, and the fewest of those places that tell it.

use super::Resolution;

/// Of what is allowed: what may lie between two places that were looked at, and what may be left
/// out of those.
const BETWEEN: f64 = 0.2;
const LEFT_OUT: f64 = 1.0 - BETWEEN;
/// No piece is halved more often.
const MOST_HALVINGS: u32 = 16;
/// Places of a piece before it is halved.
const PLACES: usize = 4;

/// A curve looked at in some places, in their order.
pub(super) struct Look<T> {
    samples: Vec<Sample<T>>,
    allowed: f64,
    resolution: Resolution,
}

struct Sample<T> {
    place: f64,
    height: f64,
    value: T,
}

/// A part of the curve by its ends, and five heights at equal distances.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    heights: [f64; 5],
}

impl<T> Look<T> {
    /// Look at the curve between each two of the ends, until what lies between two looks is known
    /// well enough, in no more places than `most`.
    pub(super) fn along(
        ends: &[f64],
        allowed: f64,
        most: usize,
        at: impl FnMut(f64) -> (f64, T),
    ) -> Look<T> {
        // Two halves: a single part that is alike on both sides could hide its bends.
        let halves = [
            ends[0],
            f64::midpoint(ends[0], ends[ends.len() - 1]),
            ends[ends.len() - 1],
        ];
        let ends = if ends.len() == 2 { &halves } else { ends };
        let limited = Resolution::Limited(most);
        let fewer = fewer(ends, most / PLACES - 1);
        let ends = fewer.as_deref().unwrap_or(ends);
        let mut looking = Looking {
            at,
            samples: Vec::new(),
            allowed,
            rest: most.saturating_sub(1 + PLACES * (ends.len() - 1)),
            resolution: if fewer.is_some() {
                limited
            } else {
                Resolution::Full
            },
            limited,
        };
        let mut height = looking.sample(ends[0]);
        for pair in ends.windows(2) {
            height = looking.piece((pair[0], height), pair[1]);
        }
        let resolution = looking.resolution;
        let mut samples = looking.samples;
        let is_forward = ends[0] <= ends[ends.len() - 1];
        samples.sort_unstable_by(|one, other| {
            let (one, other) = if is_forward {
                (one, other)
            } else {
                (other, one)
            };
            one.place.total_cmp(&other.place)
        });
        Look {
            samples,
            allowed: LEFT_OUT * allowed,
            resolution,
        }
    }

    /// Whether what lies between two looks is known well enough everywhere.
    pub(super) fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Both ends, the highest place, and between them no more than are needed. Heights that are no
    /// numbers tell nothing: with one of them all are kept.
    pub(super) fn needed(self) -> impl Iterator<Item = T> {
        let keeps = if self.samples.iter().all(|sample| sample.height.is_finite()) {
            self.kept()
        } else {
            Vec::new()
        };
        let all = keeps.is_empty();
        let values = self.samples.into_iter().enumerate();
        values
            .filter(move |(at, _)| all || keeps.binary_search(at).is_ok())
            .map(|(_, sample)| sample.value)
    }

    /// The places of the samples that are needed, in their order.
    fn kept(&self) -> Vec<usize> {
        let last = self.samples.len() - 1;
        let height = |at: &usize| self.samples[*at].height;
        let highest = (0..=last)
            .max_by(|one, other| height(one).total_cmp(&height(other)))
            .unwrap_or(last);
        let (mut kept, mut at) = (vec![0], 0);
        while at < last {
            at = self.furthest(at, if at < highest { highest } else { last });
            kept.push(at);
        }
        kept
    }

    /// The furthest sample, up to `most`, to which a straight line passes all between them.
    fn furthest(&self, from: usize, most: usize) -> usize {
        let start = &self.samples[from];
        let (mut steepest, mut flattest, mut furthest) =
            (f64::INFINITY, f64::NEG_INFINITY, from + 1);
        for at in from + 1..=most {
            let sample = &self.samples[at];
            let way = (sample.place - start.place).abs();
            let slope = |aside: f64| (sample.height - start.height + aside) / way;
            if (flattest..=steepest).contains(&slope(0.0)) {
                furthest = at;
            }
            steepest = steepest.min(slope(self.allowed));
            flattest = flattest.max(slope(-self.allowed));
            if flattest > steepest {
                break;
            }
        }
        furthest
    }
}

/// Every so many of the ends and the last, where they leave more than `most` pieces.
fn fewer(ends: &[f64], most: usize) -> Option<Vec<f64>> {
    let pieces = ends.len() - 1;
    (pieces > most).then(|| {
        let inner = ends[..pieces].iter().step_by(pieces.div_ceil(most));
        inner.chain(ends.last()).copied().collect()
    })
}

/// A look on its way.
struct Looking<T, F> {
    at: F,
    samples: Vec<Sample<T>>,
    allowed: f64,
    /// Places beyond those of the pieces.
    rest: usize,
    resolution: Resolution,
    limited: Resolution,
}

impl<T, F: FnMut(f64) -> (f64, T)> Looking<T, F> {
    /// The height at a place.
    fn sample(&mut self, place: f64) -> f64 {
        let (height, value) = (self.at)(place);
        self.samples.push(Sample {
            place,
            height,
            value,
        });
        height
    }

    /// From a place whose height is known to another; its height.
    fn piece(&mut self, (from, height): (f64, f64), to: f64) -> f64 {
        let inner = [0.25, 0.5, 0.75].map(|part| self.sample(from + (to - from) * part));
        let last = self.sample(to);
        self.closer(
            Part {
                from,
                to,
                heights: [height, inner[0], inner[1], inner[2], last],
            },
            MOST_HALVINGS,
        );
        last
    }

    /// Look at both halves of a part of which too little is known.
    fn closer(&mut self, part: Part, halvings: u32) {
        // What is no number is not looked at more closely.
        let is_bent = part.unknown() > BETWEEN * self.allowed;
        if halvings == 0 || !is_bent {
            return;
        }
        if self.rest < PLACES {
            self.resolution = self.limited;
            return;
        }
        self.rest -= PLACES;
        let Part {
            from,
            to,
            heights: [first, before, middle, after, last],
        } = part;
        let place = |eighths: f64| from + (to - from) * eighths / 8.0;
        let [one, three, five, seven] =
            [1.0, 3.0, 5.0, 7.0].map(|eighths| self.sample(place(eighths)));
        self.closer(
            Part {
                from,
                to: place(4.0),
                heights: [first, one, before, three, middle],
            },
            halvings - 1,
        );
        self.closer(
            Part {
                from: place(4.0),
                to,
                heights: [middle, five, after, seven, last],
            },
            halvings - 1,
        );
    }
}

impl Part {
    /// How far the curve may lie off the lines between its five heights: an eighth of the second
    /// difference where that is the same all along, up to half of it where it is not and the curve
    /// has a bend.
    fn unknown(&self) -> f64 {
        let bends = [1, 2, 3]
            .map(|at| self.heights[at - 1] - 2.0 * self.heights[at] + self.heights[at + 1]);
        let most = bends.iter().map(|bend| bend.abs()).fold(0.0, f64::max);
        let spread = bends
            .iter()
            .fold(f64::NEG_INFINITY, |most, &bend| most.max(bend))
            - bends
                .iter()
                .fold(f64::INFINITY, |least, &bend| least.min(bend));
        0.125 * most + 0.375 * spread.min(most)
    }
}
