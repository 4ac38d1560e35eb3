//! Displacements of pairs by forces on the pairs a few pitches behind and ahead.

use crate::model::Refusal;
use crate::model::pair_forces::PITCHES;
use crate::numeric::chebyshev::Series;

/// Displacement of a pair by a unit force on another, as a function of the place of the rear pair.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Couplings {
    /// One list for each number of pitches between the pairs, in order.
    stretches: [Vec<Stretch>; PITCHES],
}

/// A part of the path in which the load points of both pairs move smoothly.
#[derive(Debug, Clone, PartialEq)]
struct Stretch {
    to: f64,
    series: Series<1>,
}

/// The range in which pairs may touch, in m.
#[derive(Debug, Clone)]
pub(super) struct Way {
    /// First and last place of a pair.
    pub(super) ends: (f64, f64),
    /// Places where the motion of a pair's load points has a bend.
    pub(super) bends: Vec<f64>,
    /// p_b.
    pub(super) base_pitch: f64,
}

impl Couplings {
    /// The couplings by `coupling`, in m/N, of two pairs from the place of the rear pair and the
    /// pitches between them. `own` is the compliance of one pair. `None` if the pairs are
    /// independent springs.
    ///
    /// # Errors
    /// Those of `coupling`.
    pub(super) fn of(
        way: &Way,
        own: f64,
        coupling: &dyn Fn(f64, i32) -> Result<f64, Refusal>,
    ) -> Result<Option<Couplings>, Refusal> {
        let mut stretches = [const { Vec::new() }; PITCHES];
        for (pitches, stretches) in (1..).zip(&mut stretches) {
            let borders = way.borders(pitches);
            if let [from, .., to] = borders[..]
                && pitches == 1
                && is_zero([from, f64::midpoint(from, to), to], |s| {
                    coupling(s, pitches)
                })?
            {
                return Ok(None);
            }
            for ends in borders.windows(2) {
                stretches.push(Stretch {
                    to: ends[1],
                    series: series((ends[0], ends[1]), own, |s| coupling(s, pitches))?,
                });
            }
        }
        let is_empty = stretches.iter().all(Vec::is_empty);
        Ok((!is_empty).then_some(Couplings { stretches }))
    }

    /// The displacement in m/N of two pairs with `between` pairs between them and the rear pair at
    /// `s`. On a border, `inside` selects the side.
    pub(super) fn at(&self, between: usize, s: f64, inside: f64) -> f64 {
        let stretches = &self.stretches[between];
        let index = stretches.partition_point(|stretch| stretch.to < inside);
        let stretch = stretches.get(index).or_else(|| stretches.last());
        stretch.map_or(0.0, |stretch| stretch.series.one(0, s))
    }

    /// The couplings of the back flanks, whose places run backwards from `length`, in m. The rear
    /// and the front pair are then exchanged.
    pub(super) fn reversed(&self, length: f64, base_pitch: f64) -> Couplings {
        let mut pitches = 0.0;
        let stretches = self.stretches.each_ref().map(|stretches| {
            pitches += 1.0;
            let about = length - pitches * base_pitch;
            let reversed = stretches.iter().rev().map(|stretch| Stretch {
                to: about - stretch.series.start(),
                series: stretch.series.reversed(about, [1.0]),
            });
            reversed.collect()
        });
        Couplings { stretches }
    }

    /// Number of evaluations of the coupling.
    pub(super) fn evaluations(&self) -> usize {
        let all = self.stretches.iter().flatten();
        all.map(|stretch| stretch.series.evaluations()).sum()
    }
}

impl Way {
    /// Places where the rear pair begins or ends, or one of both pairs passes a bend. Empty if the
    /// range is too short for both pairs.
    fn borders(&self, pitches: i32) -> Vec<f64> {
        let apart = f64::from(pitches) * self.base_pitch;
        let (from, to) = (self.ends.0, self.ends.1 - apart);
        let bends = self.bends.iter();
        let mut borders: Vec<f64> = bends
            .flat_map(|bend| [*bend, bend - apart])
            .filter(|edge| (from..=to).contains(edge))
            .collect();
        if from < to {
            borders.extend([from, to]);
        }
        borders.sort_by(f64::total_cmp);
        borders.dedup_by(|one, other| *one - *other <= 1e-12 * self.base_pitch);
        borders
    }
}

fn is_zero(
    places: [f64; 3],
    coupling: impl Fn(f64) -> Result<f64, Refusal>,
) -> Result<bool, Refusal> {
    for place in places {
        if coupling(place)? != 0.0 {
            return Ok(false);
        }
    }
    Ok(true)
}

fn series(
    (from, to): (f64, f64),
    own: f64,
    coupling: impl Fn(f64) -> Result<f64, Refusal>,
) -> Result<Series<1>, Refusal> {
    /// Relative to the compliance of one pair.
    const REST: f64 = 1e-13;
    Series::of(from, to, &|_, _| [REST * own], &|s| {
        coupling(s).map(|found| [found])
    })
}
