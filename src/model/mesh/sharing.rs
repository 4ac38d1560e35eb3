//! Displacements of pairs by forces on other pairs, and load sharing of coupled pairs as polynomials.

use super::Mesh;
use super::zones::{GAP, LEVER, SLIDING, STIFFNESS};
use crate::model::Refusal;
use crate::model::compliance::ContactPlace;
use crate::model::pair_forces::{PITCHES, Touching};
use crate::numeric::banded::Banded;
use crate::numeric::chebyshev::{Places, Series, TERMS, Terms};
use crate::numeric::distinct;
use crate::numeric::polynomial::Polynomial;
use crate::numeric::real::Lanes;
use std::sync::{Arc, Mutex, PoisonError};

/// Number of functions evaluated together.
const SIDE_BY_SIDE: usize = 2;

/// Pairs in zones, and those of them that touch.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Meeting {
    /// The zone of each pair, the rearmost first.
    pub zones: Vec<usize>,
    /// The touching pairs.
    pub touching: Touching,
    /// The touching pair with a deviation.
    pub deviating: Option<usize>,
}

/// Cached shares of a mesh. All motions on the mesh use them, because they depend on neither the
/// speed nor the size of the deviation.
#[derive(Debug, Default)]
pub(super) struct Sharing {
    known: Mutex<Vec<(Meeting, Arc<Shares>)>>,
}

impl Sharing {
    /// The shares of a meeting. Calls `new` if they are not cached.
    pub(super) fn of(&self, meeting: &Meeting, new: impl FnOnce() -> Shares) -> Arc<Shares> {
        let mut all = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, shares)) = all.iter().find(|(known, _)| known == meeting) {
            return Arc::clone(shares);
        }
        let shares = Arc::new(new());
        all.push((meeting.clone(), Arc::clone(&shares)));
        shares
    }
}

/// Force or overlap over the displacement x, for a set of touching pairs.
///
/// # Formula
/// ```text
/// slope x − offset + deviated e
/// ```
/// where e is the error of the pair that deviates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line<T> {
    /// Change with the displacement.
    pub slope: T,
    /// The part of the gaps.
    pub offset: T,
    /// Change with the error of the deviating pair; `None` if no touching pair deviates.
    pub deviated: Option<T>,
}

/// The shares of pairs in a displacement for a set of touching pairs.
///
/// # Formula
/// ```text
/// F_k = Σ_j M_kj (x − g_j)  of a touching pair,   x − g_k − Σ_j Q_kj F_j/b  of a pair apart
/// ```
/// where j are the touching pairs, g their gaps, and M = Q⁻¹ b; the sum of forces counts each with
/// the part that turns the driver.
#[derive(Debug)]
pub struct Shares {
    pairs: usize,
    deviates: bool,
    /// Slope and offset of the sum, then of each pair; after them the change with the error of the
    /// deviating pair, in the same order, two at a time.
    functions: Vec<Series<SIDE_BY_SIDE>>,
}

/// The index of a line among the lines: that of the sum, or of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// The sum of forces that turn the driver, in N.
    Sum,
    /// The force of a touching pair, in N, or the overlap of a pair apart, in m.
    Pair(usize),
}

impl Of {
    fn index(self) -> usize {
        match self {
            Of::Sum => 0,
            Of::Pair(pair) => 1 + pair,
        }
    }
}

impl Shares {
    /// End of the piece that begins at or includes a place of the rearmost pair.
    pub fn serves_until(&self, (at, least): (f64, f64)) -> f64 {
        self.functions[0].serves_until(at, least)
    }

    /// Number of evaluations of the compliances.
    pub fn evaluations(&self) -> usize {
        self.functions[0].evaluations()
    }

    /// Memory of the functions, in bytes.
    pub fn bytes(&self) -> usize {
        self.functions.iter().map(Series::bytes).sum()
    }

    /// The line of the sum or of a pair from a place of the rearmost pair, over `length`.
    pub fn along(&self, of: Of, place: (f64, f64), length: f64) -> Line<Polynomial<TERMS>> {
        let [slope, offset] = self.functions[of.index()].local(0, place, length);
        Line {
            slope,
            offset,
            deviated: self.column(of).map(|(functions, function)| {
                let [deviated] = functions.local(function, place, length);
                deviated
            }),
        }
    }

    /// The line of the sum or of a pair at a place of the rearmost pair.
    pub fn at(&self, of: Of, at: f64) -> Line<f64> {
        let [slope, offset] = self.functions[of.index()].at(at);
        Line {
            slope,
            offset,
            deviated: self.column(of).map(|(functions, function)| functions.one(function, at)),
        }
    }

    /// Bounds of the line of the sum or of a pair in the piece at a place of the rearmost pair.
    pub fn bounds(&self, of: Of, place: (f64, f64)) -> Line<(f64, f64)> {
        let functions = &self.functions[of.index()];
        Line {
            slope: functions.bounds(0, place),
            offset: functions.bounds(1, place),
            deviated: self
                .column(of)
                .map(|(functions, function)| functions.bounds(function, place)),
        }
    }

    fn column(&self, of: Of) -> Option<(&Series<SIDE_BY_SIDE>, usize)> {
        let index = of.index();
        self.deviates.then(|| (&self.functions[1 + self.pairs + index / 2], index % 2))
    }
}

impl Mesh {
    /// The lines of the pairs of a meeting.
    pub(crate) fn shares(&self, meeting: &Meeting) -> Arc<Shares> {
        self.sharing.0.of(meeting, || Meet::of(self, meeting).shares())
    }

    /// First and last place of the rearmost pair with exactly these pairs in these zones, in m.
    fn way_of(&self, zones: &[usize]) -> (f64, f64) {
        let (from, to) = self.ends();
        let none = (to - zones.len() as f64 * self.base_pitch, from + self.base_pitch);
        let pairs = (0..).zip(zones);
        pairs.fold(none, |(from, to), (pair, &zone)| {
            let (zone, ahead) = (&self.zones[zone], f64::from(pair) * self.base_pitch);
            (from.max(zone.from - ahead), to.min(zone.to - ahead))
        })
    }
}

/// Pairs that meet, on their way.
struct Meet<'a> {
    mesh: &'a Mesh,
    meeting: &'a Meeting,
    touching: Vec<usize>,
    /// From where to where the rearmost pair goes, in m.
    ends: (f64, f64),
}

/// The lines of several pairs at several places, as (slope, offset, change with the error).
type Lines = Vec<[Lanes<TERMS>; 3]>;

const SLOPE: usize = 0;
const OFFSET: usize = 1;
const DEVIATED: usize = 2;

impl<'a> Meet<'a> {
    fn of(mesh: &'a Mesh, meeting: &'a Meeting) -> Meet<'a> {
        Meet {
            mesh,
            meeting,
            touching: meeting.touching.pairs().collect(),
            ends: mesh.way_of(&meeting.zones),
        }
    }

    fn inside(&self) -> f64 {
        f64::midpoint(self.ends.0, self.ends.1)
    }

    fn way(&self, pair: usize) -> f64 {
        pair as f64 * self.mesh.base_pitch
    }

    fn shares(&self) -> Shares {
        let (pairs, deviates) = (self.meeting.zones.len(), self.meeting.deviating.is_some());
        let rest = self.rest();
        let fill = |places: &Places, values: &mut [Terms<SIDE_BY_SIDE>]| {
            let lines = self.lines(places);
            let lines = lines.unwrap_or_else(|| vec![[Lanes::all(f64::NAN); 3]; 1 + pairs]);
            for (index, line) in lines.iter().enumerate() {
                put(values, (index, 0), &line[SLOPE]);
                put(values, (index, 1), &line[OFFSET]);
                if deviates {
                    put(values, (1 + pairs + index / 2, index % 2), &line[DEVIATED]);
                }
            }
        };
        Shares {
            pairs,
            deviates,
            functions: Series::groups(self.ends.0, self.ends.1, &rest, &fill),
        }
    }

    /// Limits of the last terms of each function.
    fn rest(&self) -> Vec<[f64; SIDE_BY_SIDE]> {
        /// Of the size of a function.
        const REST: f64 = 1e-13;
        let Meeting { zones, deviating, .. } = self.meeting;
        let (mesh, inside) = (self.mesh, self.inside());
        let deflection = mesh.force / mesh.mean_stiffness();
        let zone = |pair: usize| &mesh.zones[zones[pair]];
        let at =
            |pair: usize, function: usize| zone(pair).series.one(function, inside + self.way(pair));
        let gap_rest = |pair: usize| {
            let size = deflection.max(at(pair, GAP).abs());
            (REST * size).max(zone(pair).gap_rest)
        };
        let touching = || self.touching.iter().copied();
        let stiffness = touching().map(|pair| at(pair, STIFFNESS)).fold(0.0, f64::max);
        let gap = touching().map(gap_rest).fold(0.0, f64::max);
        let force = [REST * stiffness, stiffness * gap];
        let pairs = (0..zones.len()).map(|pair| {
            if self.meeting.touching.has(pair) { force } else { [REST, gap.max(gap_rest(pair))] }
        });
        let mut rest: Vec<_> = std::iter::once(force).chain(pairs).collect();
        if deviating.is_some() {
            let slopes: Vec<f64> = rest.iter().map(|[slope, _]| *slope).collect();
            let columns = slopes.chunks(SIDE_BY_SIDE);
            rest.extend(columns.map(|two| [two[0], two.get(1).copied().unwrap_or(REST)]));
        }
        rest
    }

    /// The lines of the sum and of each pair at several places of the rearmost pair; `None` if the
    /// compliances are not positive definite.
    fn lines(&self, places: &Places) -> Option<Lines> {
        let zero = Lanes::all(0.0);
        let mut forces: Lines = Vec::with_capacity(self.touching.len());
        let mut rows: Vec<[Lanes<TERMS>; 1 + PITCHES]> = Vec::with_capacity(self.touching.len());
        for (at, &pair) in self.touching.iter().enumerate() {
            let [stiffness, gap] = self.values(pair, STIFFNESS, places);
            let mut row = [zero; 1 + PITCHES];
            row[0] = Lanes::all(1.0) / stiffness;
            for (&other, entry) in self.touching[..at].iter().rev().zip(&mut row[1..]) {
                *entry = self.coupling(other, pair, places);
            }
            rows.push(row);
            let deviates = self.meeting.deviating == Some(pair);
            forces.push([Lanes::all(1.0), gap, Lanes::all(f64::from(u8::from(deviates)))]);
        }
        let factored = Banded::factored(rows)?;
        factored.solve(&mut forces);
        let mut lines = Vec::with_capacity(1 + self.meeting.zones.len());
        lines.push(self.sum(&forces, places));
        let mut touching = self.touching.iter().zip(&forces).peekable();
        for pair in 0..self.meeting.zones.len() {
            let line = touching.next_if(|(other, _)| **other == pair);
            lines.push(line.map_or_else(|| self.apart(pair, &forces, places), |(_, line)| *line));
        }
        Some(lines)
    }

    /// The sum of the forces that turn the driver.
    fn sum(&self, forces: &Lines, places: &Places) -> [Lanes<TERMS>; 3] {
        let mut sum = [Lanes::all(0.0); 3];
        for (&pair, line) in self.touching.iter().zip(forces) {
            let weight = self.weight(pair, places);
            for (sum, part) in sum.iter_mut().zip(line) {
                *sum = *sum + weight.map_or(*part, |weight| weight * *part);
            }
        }
        sum
    }

    /// The part of a pair's force that turns the driver; all of it without friction.
    fn weight(&self, pair: usize, places: &Places) -> Option<Lanes<TERMS>> {
        let friction = self.mesh.friction;
        if friction == 0.0 {
            return None;
        }
        let series = &self.mesh.zones[self.meeting.zones[pair]].series;
        let direction = series.one(SLIDING, self.inside() + self.way(pair)).signum();
        let [lever] = self.values(pair, LEVER, places);
        Some(Lanes::all(1.0) - Lanes::all(friction * direction) * lever)
    }

    /// The overlap of a pair without contact.
    fn apart(&self, pair: usize, forces: &Lines, places: &Places) -> [Lanes<TERMS>; 3] {
        let [gap] = self.values(pair, GAP, places);
        let mut line = [Lanes::all(1.0), gap, Lanes::all(0.0)];
        for (&other, force) in self.touching.iter().zip(forces) {
            if other.abs_diff(pair) <= PITCHES {
                let coupling = self.coupling(other.min(pair), other.max(pair), places);
                for (line, force) in line.iter_mut().zip(force) {
                    *line = *line - coupling * *force;
                }
            }
        }
        line
    }

    /// Values of a pair, from one function on.
    fn values<const M: usize>(
        &self,
        pair: usize,
        first: usize,
        places: &Places,
    ) -> [Lanes<TERMS>; M] {
        let zone = &self.mesh.zones[self.meeting.zones[pair]];
        let way = self.way(pair);
        zone.series.many(first, &places.map(|place| place + way))
    }

    /// Displacement of one pair by the force on the other, in m/N.
    fn coupling(&self, rear: usize, front: usize, places: &Places) -> Lanes<TERMS> {
        let couplings = self.mesh.couplings.as_ref();
        let couplings = couplings.filter(|_| front - rear <= PITCHES);
        couplings.map_or(Lanes::all(0.0), |couplings| {
            let way = self.way(rear);
            let places = places.map(|place| place + way);
            couplings.many(front - rear - 1, &places, self.inside() + way)
        })
    }
}

fn put(
    values: &mut [Terms<SIDE_BY_SIDE>],
    (group, function): (usize, usize),
    lanes: &Lanes<TERMS>,
) {
    for (values, lane) in values[group].iter_mut().zip(lanes.0) {
        values[function] = lane;
    }
}

/// Displacement of a pair by a unit force on another, as a function of the place of the rear pair,
/// for each number of pitches between the pairs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Couplings([Stretches<1>; PITCHES]);

/// Functions on the parts of the path in which the load points of pairs move smoothly, with the end
/// of each part.
#[derive(Debug, Clone, PartialEq)]
struct Stretches<const N: usize>(Vec<(f64, Series<N>)>);

impl<const N: usize> Stretches<N> {
    /// The functions of the part that includes `inside`.
    fn at(&self, inside: f64) -> Option<&Series<N>> {
        let index = self.0.partition_point(|(to, _)| *to < inside);
        self.0.get(index).or_else(|| self.0.last()).map(|(_, series)| series)
    }
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
pub(crate) struct Neighbours<'a> {
    /// Where a pair touches the driver and the driven gear, in a measure of the model's own.
    pub(crate) abscissas: &'a dyn Fn(&ContactPlace) -> Result<[f64; 2], Refusal>,
    /// Displacement of the rear pair by the force on the front one so many pitches ahead, or of
    /// that one by the force on this one, in m²/N, at several places of both.
    pub(crate) displacements: &'a dyn Fn([Lanes<TERMS>; 2], [Lanes<TERMS>; 2], i32) -> Lanes<TERMS>,
}

impl Stretches<2> {
    /// Where a pair touches both gears, over its place.
    fn of(
        way: &Way,
        at: impl Fn(f64) -> Result<[f64; 2], Refusal>,
    ) -> Result<Stretches<2>, Refusal> {
        /// Of the size of an abscissa, which changes a coupling by a twentieth of the compliance of
        /// a pair; rounding of a large gear's radii is half of it.
        const REST: f64 = 2e-12;
        let borders = way.borders(0);
        let stretches = borders.windows(2).map(|ends| {
            let rest = at(f64::midpoint(ends[0], ends[1]))?.map(|size| REST * size.abs().max(1e-3));
            Ok((ends[1], Series::of(ends[0], ends[1], &|_, _| rest, &at)?))
        });
        Ok(Stretches(stretches.collect::<Result<_, Refusal>>()?))
    }

    /// At several places, smoothly on from `inside`.
    fn many(&self, places: &Places, inside: f64) -> [Lanes<TERMS>; 2] {
        self.at(inside).map_or([Lanes::all(f64::NAN); 2], |series| series.many(0, places))
    }
}

impl Couplings {
    /// The couplings, in m/N, of two pairs from the place of the rear pair and the pitches between
    /// them. `own` is the compliance of one pair. `None` if no two pairs can touch.
    ///
    /// # Errors
    /// Those of `neighbours`.
    pub(super) fn of(
        way: &Way,
        (own, width): (f64, f64),
        neighbours: &Neighbours<'_>,
        place: &dyn Fn(f64) -> ContactPlace,
    ) -> Result<Option<Arc<Couplings>>, Refusal> {
        /// Of the compliance of one pair.
        const REST: f64 = 1e-13;
        let abscissas = Stretches::of(way, |s| (neighbours.abscissas)(&place(s)))?;
        let mut all = [const { Stretches(Vec::new()) }; PITCHES];
        for (pitches, stretches) in (1..).zip(&mut all) {
            let apart = f64::from(pitches) * way.base_pitch;
            for ends in way.borders(pitches).windows(2) {
                let inside = f64::midpoint(ends[0], ends[1]);
                let fill = |places: &Places, values: &mut [Terms<1>]| {
                    let front = places.map(|place| place + apart);
                    let rear = abscissas.many(places, inside);
                    let front = abscissas.many(&front, inside + apart);
                    let found = (neighbours.displacements)(rear, front, pitches);
                    values[0] = found.0.map(|found| [found / width]);
                };
                let series = Series::groups(ends[0], ends[1], &[[REST * own]], &fill);
                stretches.0.extend(series.into_iter().map(|series| (ends[1], series)));
            }
        }
        let is_empty = all.iter().all(|stretches| stretches.0.is_empty());
        Ok((!is_empty).then(|| Arc::new(Couplings(all))))
    }

    /// The displacement in m/N of two pairs with `between` pairs between them and the rear pair at
    /// `s`. On a border, `inside` selects the side.
    pub(super) fn at(&self, between: usize, s: f64, inside: f64) -> f64 {
        self.0[between].at(inside).map_or(0.0, |series| series.one(0, s))
    }

    /// The same at several places of the rear pair.
    pub(super) fn many(&self, between: usize, places: &Places, inside: f64) -> Lanes<TERMS> {
        let series = self.0[between].at(inside);
        let [found] = series.map_or([Lanes::all(0.0)], |series| series.many(0, places));
        found
    }

    /// The couplings of the back flanks, whose places run backwards from `length`, in m. The rear
    /// and the front pair are then exchanged.
    pub(super) fn reversed(&self, length: f64, base_pitch: f64) -> Couplings {
        let mut pitches = 0.0;
        Couplings(self.0.each_ref().map(|Stretches(stretches)| {
            pitches += 1.0;
            let about = length - pitches * base_pitch;
            let reversed = stretches
                .iter()
                .rev()
                .map(|(_, series)| (about - series.start(), series.reversed(about, [1.0])));
            Stretches(reversed.collect())
        }))
    }

    /// Number of evaluations of the coupling.
    pub(super) fn evaluations(&self) -> usize {
        let all = self.0.iter().flat_map(|stretches| &stretches.0);
        all.map(|(_, series)| series.evaluations()).sum()
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
        distinct(borders, 1e-12 * self.base_pitch)
    }
}

/// For tests: neighbours with a displacement by the radii of the rear pair and of the front one and
/// the pitches between them.
#[cfg(test)]
pub(crate) fn with_neighbours<T>(
    by_radii: impl Fn([f64; 2], [f64; 2], i32) -> f64,
    find: impl FnOnce(&Neighbours<'_>) -> T,
) -> T {
    let at = |pair: [Lanes<TERMS>; 2], lane: usize| pair.map(|radii| radii.0[lane]);
    find(&Neighbours {
        abscissas: &|place| Ok([place.radius_driver, place.radius_driven]),
        displacements: &|rear, front, pitches| {
            Lanes(std::array::from_fn(|lane| by_radii(at(rear, lane), at(front, lane), pitches)))
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::{Inputs, Method};
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};

    /// Whatever touches, a line is what the same pairs do by their compliance matrix at each place.
    #[test]
    fn lines_are_the_forces_and_overlaps_by_the_compliance_matrix() {
        for (teeth, friction, deviation) in [(20, 0.0, 0.0), (60, 0.0, 12e-6), (150, 0.1, 12e-6)] {
            let inputs = Inputs {
                method: Method::Static,
                friction_coefficient: Some(friction),
                base_pitch_deviation: deviation,
                ..standard_pair(teeth, teeth, 3e-3)
            };
            let mesh = solve(&inputs, Stages::of(Stage::Static)).unwrap().mesh.unwrap();
            let borders = mesh.borders(0.0, mesh.base_pitch);
            for ends in borders.windows(2) {
                let (s, inside) = (0.7 * ends[0] + 0.3 * ends[1], f64::midpoint(ends[0], ends[1]));
                let pairs = mesh.pair_set(s, inside);
                let (x, balance) = pairs.shared(mesh.force);
                let touches = |pair: &usize| balance[*pair] > 0.0;
                let touching = (0..balance.len()).filter(touches);
                let touching = touching.fold(Touching::NONE, Touching::with);
                let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0);
                let meeting = Meeting {
                    zones: mesh.standing(inside).map(|(_, zone)| zone).collect(),
                    touching,
                    deviating: incoming.filter(|&pair| touching.has(pair)),
                };
                let shares = mesh.shares(&meeting);
                let first = f64::from(pairs.pairs()[0].ahead) * mesh.base_pitch;
                let at = |of: Of, x: f64| {
                    let line = shares.at(of, s + first);
                    let apart = of.index() > 0 && incoming == Some(of.index() - 1);
                    let error = if apart && meeting.deviating.is_none() { mesh.error } else { 0.0 };
                    line.slope * x - line.offset + line.deviated.unwrap_or(0.0) * mesh.error + error
                };
                for x in [0.6 * x, 1.7 * x] {
                    let (leads, mut sum) = (pairs.leads(touching, x), 0.0);
                    for (index, pair) in pairs.pairs().iter().enumerate() {
                        let found = at(Of::Pair(index), x);
                        let (expected, size) = if touching.has(index) {
                            let force = leads[index] * pair.stiffness;
                            sum += pair.weight * force;
                            (force, mesh.force)
                        } else {
                            (leads[index], x.abs().max(pair.gap.abs()))
                        };
                        let off = ((found - expected) / size).abs();
                        assert!(off < 1e-12, "z {teeth}, pair {index} at {s}: {off:e}");
                    }
                    let off = (at(Of::Sum, x) / sum - 1.0).abs();
                    assert!(off < 1e-12, "z {teeth}, sum at {s}: {off:e}");
                }
            }
        }
    }
}
