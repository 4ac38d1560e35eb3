//! Displacements of pairs by forces on the pairs a few pitches behind and ahead.

use std::sync::Arc;

use crate::model::Refusal;
use crate::model::compliance::{ContactPlace, Teeth};
use crate::model::pair_forces::PITCHES;
use crate::numeric::chebyshev::{Places, Series, TERMS};
use crate::numeric::real::Lanes;

/// Displacement of a pair by a unit force on another, as a function of the place of the rear pair.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::model) struct Couplings {
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

/// How the force on one pair displaces another, by the places where they touch.
pub(in crate::model) trait Neighbours {
    /// Whether it does at all.
    fn is_coupled(&self) -> bool;

    /// Where a pair touches the driver and the driven gear under a force in N, in a measure of the
    /// model's own.
    fn abscissas(&self, place: &ContactPlace, force: f64) -> Result<[f64; 2], Refusal>;

    /// Displacement of the rear pair by the force on the front one so many pitches ahead, or of
    /// that one by the force on this one, in m²/N, at several places of both.
    fn displacements(
        &self,
        rear: [Lanes<TERMS>; 2],
        front: [Lanes<TERMS>; 2],
        pitches: i32,
    ) -> Lanes<TERMS>;
}

impl Neighbours for Teeth {
    fn is_coupled(&self) -> bool {
        Teeth::is_coupled(self)
    }

    fn abscissas(&self, place: &ContactPlace, force: f64) -> Result<[f64; 2], Refusal> {
        Teeth::abscissas(self, &self.under(place, force))
    }

    fn displacements(
        &self,
        rear: [Lanes<TERMS>; 2],
        front: [Lanes<TERMS>; 2],
        pitches: i32,
    ) -> Lanes<TERMS> {
        self.couplings(rear, front, pitches)
    }
}

/// Where a pair touches both gears, over its place.
struct Abscissas {
    stretches: Vec<(f64, Series<2>)>,
}

impl Abscissas {
    fn of(way: &Way, at: impl Fn(f64) -> Result<[f64; 2], Refusal>) -> Result<Abscissas, Refusal> {
        /// Of the size of an abscissa, which changes a coupling by a twentieth of the compliance of
        /// a pair; rounding of a large gear's radii is half of it.
        const REST: f64 = 2e-12;
        let borders = way.borders(0);
        let stretches = borders.windows(2).map(|ends| {
            let rest = at(f64::midpoint(ends[0], ends[1]))?.map(|size| REST * size.abs().max(1e-3));
            let series = Series::of(ends[0], ends[1], &|_, _| rest, &at)?;
            Ok((ends[1], series))
        });
        Ok(Abscissas { stretches: stretches.collect::<Result<_, Refusal>>()? })
    }

    /// At several places, smoothly on from `inside`.
    fn many(&self, places: &Places, inside: f64) -> [Lanes<TERMS>; 2] {
        let index = self.stretches.partition_point(|(to, _)| *to < inside);
        let stretch = self.stretches.get(index).or_else(|| self.stretches.last());
        stretch.map_or([Lanes::all(f64::NAN); 2], |(_, series)| series.many(0, places))
    }
}

impl Couplings {
    /// The couplings by `coupling`, in m/N, of two pairs from the place of the rear pair and the
    /// pitches between them. `own` is the compliance of one pair. `None` if the pairs are
    /// independent springs.
    ///
    /// # Errors
    /// Those of `neighbours`.
    pub(super) fn of(
        way: &Way,
        (own, width): (f64, f64),
        force: f64,
        neighbours: &dyn Neighbours,
        place: &dyn Fn(f64) -> ContactPlace,
    ) -> Result<Option<Arc<Couplings>>, Refusal> {
        /// Of the compliance of one pair.
        const REST: f64 = 1e-13;
        if !neighbours.is_coupled() {
            return Ok(None);
        }
        let abscissas = Abscissas::of(way, |s| neighbours.abscissas(&place(s), force))?;
        let mut stretches = [const { Vec::new() }; PITCHES];
        for (pitches, stretches) in (1..).zip(&mut stretches) {
            let apart = f64::from(pitches) * way.base_pitch;
            for ends in way.borders(pitches).windows(2) {
                let inside = f64::midpoint(ends[0], ends[1]);
                let fill = |places: &Places, values: &mut [[[f64; 1]; TERMS]]| {
                    let front = places.map(|place| place + apart);
                    let rear = abscissas.many(places, inside);
                    let front = abscissas.many(&front, inside + apart);
                    let found = neighbours.displacements(rear, front, pitches);
                    values[0] = found.0.map(|found| [found / width]);
                };
                let series = Series::groups(ends[0], ends[1], &[[REST * own]], &fill);
                stretches.extend(series.into_iter().map(|series| Stretch { to: ends[1], series }));
            }
        }
        let is_empty = stretches.iter().all(Vec::is_empty);
        Ok((!is_empty).then(|| Arc::new(Couplings { stretches })))
    }

    /// The displacement in m/N of two pairs with `between` pairs between them and the rear pair at
    /// `s`. On a border, `inside` selects the side.
    pub(super) fn at(&self, between: usize, s: f64, inside: f64) -> f64 {
        self.stretch(between, inside).map_or(0.0, |stretch| stretch.series.one(0, s))
    }

    /// The same at several places of the rear pair.
    pub(super) fn many(&self, between: usize, places: &Places, inside: f64) -> Lanes<TERMS> {
        self.stretch(between, inside).map_or(Lanes::all(0.0), |stretch| {
            let [found] = stretch.series.many(0, places);
            found
        })
    }

    fn stretch(&self, between: usize, inside: f64) -> Option<&Stretch> {
        let stretches = &self.stretches[between];
        let index = stretches.partition_point(|stretch| stretch.to < inside);
        stretches.get(index).or_else(|| stretches.last())
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

/// For tests: displacement of a pair by the force on another, by the radii of the rear pair and of
/// the front one and the pitches between them.
#[cfg(test)]
pub(in crate::model) struct ByRadii<F>(pub(in crate::model) F);

#[cfg(test)]
impl<F: Fn([f64; 2], [f64; 2], i32) -> f64> Neighbours for ByRadii<F> {
    fn is_coupled(&self) -> bool {
        true
    }

    fn abscissas(&self, place: &ContactPlace, _: f64) -> Result<[f64; 2], Refusal> {
        Ok([place.radius_driver, place.radius_driven])
    }

    fn displacements(
        &self,
        rear: [Lanes<TERMS>; 2],
        front: [Lanes<TERMS>; 2],
        pitches: i32,
    ) -> Lanes<TERMS> {
        let at = |pair: [Lanes<TERMS>; 2], lane: usize| pair.map(|radii| radii.0[lane]);
        Lanes(std::array::from_fn(|lane| (self.0)(at(rear, lane), at(front, lane), pitches)))
    }
}
