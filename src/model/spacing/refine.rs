//! Adaptive sampling of a curve, and selection of the fewest samples that represent it.

use super::Resolution;

/// Division of the tolerance: for errors between the samples, and for the omission of samples.
const BETWEEN: f64 = 0.2;
const LEFT_OUT: f64 = 1.0 - BETWEEN;
/// Limit of the halvings of a piece.
const MOST_HALVINGS: u32 = 16;
/// Number of intervals of a piece before halving.
const PLACES: usize = 4;

/// The samples of a curve, in order.
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

/// A part of the curve: both ends and five equally spaced heights.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    heights: [f64; 5],
}

impl<T> Look<T> {
    /// Samples the curve between the ends until the estimated error between samples is within the
    /// tolerance, at most `most` places.
    pub(super) fn along(
        ends: &[f64],
        allowed: f64,
        most: usize,
        at: impl FnMut(f64) -> (f64, T),
    ) -> Look<T> {
        // Begins with two halves, because a symmetric part could hide its bends.
        let halves = [ends[0], f64::midpoint(ends[0], ends[ends.len() - 1]), ends[ends.len() - 1]];
        let ends = if ends.len() == 2 { &halves } else { ends };
        let limited = Resolution::Limited(most);
        let fewer = fewer(ends, most / PLACES - 1);
        let ends = fewer.as_deref().unwrap_or(ends);
        let mut looking = Sampler {
            at,
            samples: Vec::new(),
            allowed,
            rest: most.saturating_sub(1 + PLACES * (ends.len() - 1)),
            resolution: if fewer.is_some() { limited } else { Resolution::Full },
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
            let (one, other) = if is_forward { (one, other) } else { (other, one) };
            one.place.total_cmp(&other.place)
        });
        Look { samples, allowed: LEFT_OUT * allowed, resolution }
    }

    /// Whether the samples are dense enough everywhere.
    pub(super) fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Both ends, the highest sample, and the fewest samples between them. Keeps all samples if a
    /// height is not finite.
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

    /// The indices of the needed samples, in order.
    fn kept(&self) -> Vec<usize> {
        let last = self.samples.len() - 1;
        let height = |at: &usize| self.samples[*at].height;
        let highest =
            (0..=last).max_by(|one, other| height(one).total_cmp(&height(other))).unwrap_or(last);
        let (mut kept, mut at) = (vec![0], 0);
        while at < last {
            at = self.furthest(at, if at < highest { highest } else { last });
            kept.push(at);
        }
        kept
    }

    /// The farthest sample, up to `most`, for which a straight line represents all samples between.
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

/// Every n-th of the ends and the last one, if the ends have more than `most` pieces.
fn fewer(ends: &[f64], most: usize) -> Option<Vec<f64>> {
    let pieces = ends.len() - 1;
    (pieces > most).then(|| {
        let inner = ends[..pieces].iter().step_by(pieces.div_ceil(most));
        inner.chain(ends.last()).copied().collect()
    })
}

/// The state of the sampling.
struct Sampler<T, F> {
    at: F,
    samples: Vec<Sample<T>>,
    allowed: f64,
    /// Places left after the initial pieces.
    rest: usize,
    resolution: Resolution,
    limited: Resolution,
}

impl<T, F: FnMut(f64) -> (f64, T)> Sampler<T, F> {
    /// Samples a place and returns its height.
    fn sample(&mut self, place: f64) -> f64 {
        let (height, value) = (self.at)(place);
        self.samples.push(Sample { place, height, value });
        height
    }

    /// Samples a piece from a place with a known height. Returns the height at `to`.
    fn piece(&mut self, (from, height): (f64, f64), to: f64) -> f64 {
        let inner = [0.25, 0.5, 0.75].map(|part| self.sample(from + (to - from) * part));
        let last = self.sample(to);
        self.closer(
            Part { from, to, heights: [height, inner[0], inner[1], inner[2], last] },
            MOST_HALVINGS,
        );
        last
    }

    /// Samples both halves of a part whose error is too large.
    fn closer(&mut self, part: Part, halvings: u32) {
        // Does not refine parts that are not finite.
        let is_bent = part.unknown() > BETWEEN * self.allowed;
        if halvings == 0 || !is_bent {
            return;
        }
        if self.rest < PLACES {
            self.resolution = self.limited;
            return;
        }
        self.rest -= PLACES;
        let Part { from, to, heights: [first, before, middle, after, last] } = part;
        let place = |eighths: f64| from + (to - from) * eighths / 8.0;
        let [one, three, five, seven] =
            [1.0, 3.0, 5.0, 7.0].map(|eighths| self.sample(place(eighths)));
        self.closer(
            Part { from, to: place(4.0), heights: [first, one, before, three, middle] },
            halvings - 1,
        );
        self.closer(
            Part { from: place(4.0), to, heights: [middle, five, after, seven, last] },
            halvings - 1,
        );
    }
}

impl Part {
    /// Estimated greatest distance of the curve from the lines between its five heights: an eighth
    /// of the second difference if it is constant, up to half of it if it varies because of a bend.
    fn unknown(&self) -> f64 {
        let bends = [1, 2, 3]
            .map(|at| self.heights[at - 1] - 2.0 * self.heights[at] + self.heights[at + 1]);
        let most = bends.iter().map(|bend| bend.abs()).fold(0.0, f64::max);
        let spread = bends.iter().fold(f64::NEG_INFINITY, |most, &bend| most.max(bend))
            - bends.iter().fold(f64::INFINITY, |least, &bend| least.min(bend));
        0.125 * most + 0.375 * spread.min(most)
    }
}
