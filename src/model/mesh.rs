//! Gap and stiffness of every tooth pair along the line of action: what the methods `static` and
//! `dynamic` share.

mod couplings;
mod inputs;
mod zones;

use std::sync::Arc;

use super::Refusal;
use super::budget::{PAIRS, TOOTH_WORK};
use super::compliance::flanks::Flanks;
use super::compliance::{ContactPlace, Teeth};
use super::geometry::Geometry;
use super::pair_forces::{Compliances, PITCHES, Pair, PairSet, Place};
use super::relief::Relief;
use crate::numeric::chebyshev::TERMS;
use crate::numeric::polynomial::Polynomial;
use crate::numeric::quadrature;
use couplings::{Couplings, Way};
pub use inputs::MeshInputs;
use zones::{End, GAP, LEVER, SLIDING, STIFFNESS, Zone, line_zones};

/// The mesh as a function of s, the way of the incoming pair along the line of action since E, in
/// m.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    /// p_b, in m.
    pub base_pitch: f64,
    /// EB = ε p_b, in m.
    pub length: f64,
    /// F₀ = T₁/r_b1, in N.
    pub force: f64,
    /// Speed along the line of action ω₁ r_b1, in m/s.
    pub speed: f64,
    /// Speed of the driver ω₁, in rad/s.
    driver_speed: f64,
    /// Equivalent error of the incoming pair without its reliefs, in m.
    pub error: f64,
    /// Mean stiffness of the mesh over a base pitch, pairs on the line of action alone, in N/m.
    pub mean_stiffness: f64,
    /// Base radii, in m.
    pub base_radii: (f64, f64),
    /// Common face width b, in m.
    pub width: f64,
    friction: f64,
    pitch_point: f64,
    flanks: Arc<Flanks>,
    /// Those of any speed: they have the sliding velocity per unit of it.
    zones: Arc<Vec<Zone>>,
    /// None if the pairs are independent springs.
    couplings: Option<Arc<Couplings>>,
    /// Up to what gaps it is known, in m.
    reach: f64,
    is_whole: bool,
    work: u64,
}

/// Displacement of a pair by the force on another, in m²/N: of the places of the rear pair and of
/// the front one, and the pitches between them.
type Neighbour<'a> = &'a dyn Fn(&ContactPlace, &ContactPlace, i32) -> Result<f64, Refusal>;

impl Mesh {
    /// The mesh as far on both sides of the path of contact as gaps of up to `reach` stand there,
    /// in m.
    ///
    /// # Formula
    /// ```text
    /// x + e_k − S(s_k) = Σ_j Q_kj F_j/b  where F_k > 0,   s_k = s + k pb,   Q_kk = q1(r1) + q2(r2) + qH(F0)
    /// ```
    /// where S is the normal gap with the reliefs of both flanks, x the displacement of the driver
    /// ahead along the line of action, and e_k the equivalent error, Δf without reliefs for the
    /// incoming pair and 0 for every other. Q_kj is the displacement of the pair k by the force on
    /// the pair j, up to two pitches away; where the model of the teeth has none, the pairs are
    /// independent springs. On the line of action both flanks are met where the
    /// line crosses them; before E the driven tip is the load point, after B the driver's. A tip
    /// keeps its flank's own radius of curvature, or that of its edge where the case gives one.
    ///
    /// # Errors
    /// A [`Refusal`] where no compliance can be computed, the run-out interferes, or more pairs may
    /// touch at a time than the [budget](super::budget) allows.
    pub fn new(
        inputs: &MeshInputs,
        geometry: &Geometry,
        force: f64,
        error: f64,
        reach: f64,
    ) -> Result<Mesh, Refusal> {
        let flanks = Arc::new(Flanks::new(&inputs.elasticity, geometry)?);
        let mesh = Mesh::of_flanks(inputs, geometry, &flanks, (force, error), reach)?;
        Ok(Mesh {
            work: mesh.work + TOOTH_WORK * flanks.evaluations() as u64,
            ..mesh
        })
    }

    /// The same with the compliance of the teeth computed before: reliefs, load and reach leave it
    /// alone.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub(super) fn of_flanks(
        inputs: &MeshInputs,
        geometry: &Geometry,
        flanks: &Arc<Flanks>,
        load: (f64, f64),
        reach: f64,
    ) -> Result<Mesh, Refusal> {
        let teeth = Teeth::of(&inputs.elasticity, geometry)?;
        let neighbour = |rear: &ContactPlace, front: &ContactPlace, pitches: i32| {
            teeth.coupling(rear, front, pitches)
        };
        Mesh::with_neighbours(inputs, geometry, flanks, load, reach, &neighbour)
    }

    /// The same with the couplings by `neighbour`.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub(super) fn with_neighbours(
        inputs: &MeshInputs,
        geometry: &Geometry,
        flanks: &Arc<Flanks>,
        (force, error): (f64, f64),
        reach: f64,
        neighbour: Neighbour<'_>,
    ) -> Result<Mesh, Refusal> {
        let relief = Relief::of(&inputs.reliefs, geometry);
        let pace = inputs.speed;
        let inputs = &inputs.at_speed(1.0);
        let run_in = End {
            inputs: *inputs,
            geometry: *geometry,
            flanks: Flanks::clone(flanks),
            side: -1.0,
        };
        let run_out = run_in.swapped()?;
        let length = geometry.end - geometry.start;
        let (before, is_whole_before) = run_in.angle_of_reach(reach);
        let (after, is_whole_after) = run_out.angle_of_reach(reach);
        let mut zones = Vec::new();
        run_in.zones(&relief, force, before, 0.0, &mut zones)?;
        line_zones(inputs, geometry, (flanks, &relief), force, &mut zones)?;
        run_out.zones(&relief, force, after, length, &mut zones)?;
        zones.sort_by(|one, other| one.from.total_cmp(&other.from));
        check_pairs(length_of(&zones) / geometry.base_pitch)?;
        let levers = zones
            .iter()
            .flat_map(|zone| [zone.from, zone.to].map(|s| zone.series.one(LEVER, s)));
        let friction = inputs.friction;
        let limit = 1.0 / levers.fold(0.0, f64::max);
        if friction >= limit {
            return Err(Refusal::FrictionLocks { friction, limit });
        }
        let [driver_bend, driven_bend] = flanks.bends();
        let way = Way {
            ends: (
                zones.first().map_or(0.0, |zone| zone.from),
                zones.last().map_or(0.0, |zone| zone.to),
            ),
            bends: vec![
                0.0,
                length,
                driver_bend - geometry.start,
                geometry.tangent_length - geometry.start - driven_bend,
                run_in.bend(0.0),
                run_out.bend(length),
            ],
            base_pitch: geometry.base_pitch,
        };
        let place = |s: f64| match s {
            s if s < 0.0 => run_in.place(-s / geometry.driven.base),
            s if s > length => run_out.place((s - length) / geometry.driver.base).swapped(),
            s => ContactPlace::on_line_of_action(geometry, geometry.start + s),
        };
        let width = inputs.elasticity.width;
        let coupling = |s: f64, pitches: i32| {
            let front = place(s + f64::from(pitches) * geometry.base_pitch);
            neighbour(&place(s), &front, pitches).map(|found| found / width)
        };
        let own = zones
            .first()
            .map_or(0.0, |zone| zone.series.one(STIFFNESS, zone.to))
            .recip();
        let couplings = Couplings::of(&way, own, &coupling)?;
        let coupling_work = couplings.as_ref().map_or(0, Couplings::evaluations) as u64;
        let mesh = Mesh {
            base_pitch: geometry.base_pitch,
            length,
            force,
            speed: pace * geometry.driver.base,
            driver_speed: pace,
            error,
            mean_stiffness: 0.0,
            base_radii: (geometry.driver.base, geometry.driven.base),
            width,
            friction,
            pitch_point: geometry.approach_length,
            work: coupling_work
                + zones
                    .iter()
                    .map(|zone| zone.series.evaluations() as u64)
                    .sum::<u64>(),
            flanks: Arc::clone(flanks),
            zones: Arc::new(zones),
            couplings: couplings.map(Arc::new),
            reach,
            is_whole: is_whole_before && is_whole_after,
        };
        mesh.check_couplings()?;
        Ok(mesh.with_mean_stiffness())
    }

    /// The same mesh while the driver turns at a speed, in rad/s.
    #[must_use]
    pub fn turning_at(self: &Arc<Mesh>, driver_speed: f64) -> Arc<Mesh> {
        if driver_speed.to_bits() == self.driver_speed.to_bits() {
            return Arc::clone(self);
        }
        Arc::new(Mesh {
            speed: driver_speed * self.base_radii.0,
            driver_speed,
            ..Mesh::clone(self)
        })
    }

    /// The same mesh if the force on a pair displaced no other.
    #[must_use]
    pub fn uncoupled(&self) -> Mesh {
        let alone = Mesh {
            couplings: None,
            ..self.clone()
        };
        alone.with_mean_stiffness()
    }

    /// The same in which no pair deviates.
    #[must_use]
    pub fn without_error(&self) -> Mesh {
        Mesh {
            error: 0.0,
            ..self.clone()
        }
    }

    fn with_mean_stiffness(self) -> Mesh {
        Mesh {
            mean_stiffness: self.stiffness_on_line() / self.base_pitch,
            ..self
        }
    }

    /// Refuse compliances that are not positive definite.
    fn check_couplings(&self) -> Result<(), Refusal> {
        if self.couplings.is_none() {
            return Ok(());
        }
        for ends in self.borders(0.0, self.base_pitch).windows(2) {
            let middle = f64::midpoint(ends[0], ends[1]);
            for s in [ends[0], middle, ends[1]] {
                if !self.pair_set(s, middle).is_definite() {
                    return Err(Refusal::IndefiniteCompliance);
                }
            }
        }
        Ok(())
    }

    /// ∫ of the stiffness of all pairs on the line of action together over a base pitch, in N.
    fn stiffness_on_line(&self) -> f64 {
        if self.couplings.is_none() {
            let on_line = |zone: &&Zone| zone.from >= 0.0 && zone.to <= self.length;
            let zones = self.zones.iter().filter(on_line);
            return zones.map(|zone| zone.series.integral(STIFFNESS)).sum();
        }
        let stiffness = |s: f64, inside: f64| {
            let pairs = self.pair_set(s, inside).of_no_gap(|ahead| {
                let place = inside + f64::from(ahead) * self.base_pitch;
                (0.0..=self.length).contains(&place)
            });
            pairs.forces(1.0).iter().sum::<f64>()
        };
        let borders = self.borders(0.0, self.base_pitch);
        let over = |ends: &[f64]| {
            let (from, to) = (ends[0], ends[1]);
            let at = |part: f64| stiffness(from + part * (to - from), f64::midpoint(from, to));
            (to - from) * quadrature::unit_interval(at)
        };
        borders.windows(2).map(over).sum()
    }

    /// The compliance of its teeth.
    pub(super) fn flanks(&self) -> &Arc<Flanks> {
        &self.flanks
    }

    /// What it took to compute, in units of the [budget](super::budget).
    #[must_use]
    pub fn work(&self) -> u64 {
        self.work
    }

    /// From where to where the incoming pair's gap is known, in m.
    #[must_use]
    pub fn ends(&self) -> (f64, f64) {
        let from = self.zones.first().map_or(0.0, |zone| zone.from);
        (from, self.zones.last().map_or(0.0, |zone| zone.to))
    }

    /// Up to what gaps it is known, in m.
    pub(super) fn reach(&self) -> f64 {
        self.reach
    }

    /// Whether it reaches to the circles on which the tips end.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// The friction coefficient, 0 where the case gives none.
    #[must_use]
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Where the incoming pair passes the pitch point, in m, where it does.
    #[must_use]
    pub fn pitch_point(&self) -> Option<f64> {
        Some(self.pitch_point).filter(|&point| point > 0.0 && point < self.length)
    }

    /// The pairs that may touch while the incoming one stands at `s`; on a border, those of the
    /// side where `inside` lies.
    #[must_use]
    pub fn pair_set(&self, s: f64, inside: f64) -> PairSet {
        let pairs: Vec<Pair> = self
            .standing(inside)
            .map(|(ahead, zone)| self.pair(ahead, zone, s, inside))
            .collect();
        let first = pairs.first().map_or(0, |pair| pair.ahead);
        let couplings = self.couplings_of(first, pairs.len(), s, inside);
        PairSet::new(pairs, couplings)
    }

    /// Whether the force on a pair displaces others.
    #[must_use]
    pub fn is_coupled(&self) -> bool {
        self.couplings.is_some()
    }

    /// Displacement of each of so many pairs from the one `first` pitches ahead on by the force on
    /// the pair one and two pitches behind it, in m/N; empty if there are none.
    fn couplings_of(&self, first: i32, count: usize, s: f64, inside: f64) -> Vec<[f64; PITCHES]> {
        let Some(couplings) = &self.couplings else {
            return Vec::new();
        };
        let behind = |index: usize| {
            std::array::from_fn(|at| {
                index.checked_sub(at + 1).map_or(0.0, |rear| {
                    let way = (f64::from(first) + rear as f64) * self.base_pitch;
                    couplings.at(at, s + way, inside + way)
                })
            })
        };
        (0..count).map(behind).collect()
    }

    /// What `find` reads of the compliances of those pairs, each with its zone.
    pub(super) fn with_compliances<T>(
        &self,
        standing: &[(i32, usize)],
        (s, inside): (f64, f64),
        find: impl FnOnce(&Compliances<'_>) -> T,
    ) -> T {
        let own = standing.iter().map(|&(ahead, zone)| {
            let at = s + f64::from(ahead) * self.base_pitch;
            self.zones[zone].series.one(STIFFNESS, at).recip()
        });
        let own: Vec<f64> = own.collect();
        let first = standing.first().map_or(0, |&(ahead, _)| ahead);
        let couplings = self.couplings_of(first, own.len(), s, inside);
        find(&Compliances {
            own: &own,
            couplings: &couplings,
        })
    }

    /// Which pairs stand in which zone.
    pub(super) fn standing(&self, s: f64) -> impl Iterator<Item = (i32, usize)> {
        let (from, to) = self.ends();
        let first = ((from - s) / self.base_pitch).ceil() as i32;
        let last = ((to - s) / self.base_pitch).floor() as i32;
        (first..=last).map(move |ahead| (ahead, self.zone(s + f64::from(ahead) * self.base_pitch)))
    }

    /// The pair `ahead` while the incoming one stands at `s`, sliding the way it does at `inside`.
    fn pair(&self, ahead: i32, zone: usize, s: f64, inside: f64) -> Pair {
        let way = f64::from(ahead) * self.base_pitch;
        let series = &self.zones[zone].series;
        let [stiffness, gap, lever, sliding] = series.at(s + way);
        let place = Place {
            stiffness,
            gap: gap - self.error_of(ahead),
            lever,
            sliding: self.driver_speed * sliding,
        };
        let direction = if self.friction > 0.0 {
            series.one(SLIDING, inside + way).signum()
        } else {
            0.0
        };
        Pair {
            ahead,
            place,
            weight: 1.0 - self.friction * direction * lever,
        }
    }

    /// Stiffness and gap of a pair, its error counted.
    pub(super) fn spring(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let at = s + f64::from(ahead) * self.base_pitch;
        let [stiffness, gap] = self.zones[zone].series.at(at);
        (stiffness, gap - self.error_of(ahead))
    }

    /// Stiffness and gap of a pair over the way from `s` up by `length`, its error counted, as
    /// polynomials of the part of it.
    pub(super) fn spring_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [stiffness, mut gap] =
            self.zones[zone]
                .series
                .local(STIFFNESS, self.above(ahead, s), length);
        gap.0[0] -= self.error_of(ahead);
        [stiffness, gap]
    }

    /// Its gap alone, over the same way.
    pub(super) fn gap_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> Polynomial<TERMS> {
        let [mut gap] = self.zones[zone]
            .series
            .local(GAP, self.above(ahead, s), length);
        gap.0[0] -= self.error_of(ahead);
        gap
    }

    /// Arm of the friction force over the driver's base radius, and sliding velocity, over the same
    /// way.
    pub(super) fn slide_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [lever, sliding] = self.zones[zone]
            .series
            .local(LEVER, self.above(ahead, s), length);
        [lever, sliding.scaled(self.driver_speed)]
    }

    /// How far up from `s` those polynomials serve, within the zone.
    pub(super) fn serves_until(&self, ahead: i32, zone: usize, s: f64) -> f64 {
        let (at, least) = self.above(ahead, s);
        s + (self.zones[zone].series.serves_until(at, least) - at)
    }

    /// The place of a pair, and the distance below which two places are the same.
    pub(super) fn above(&self, ahead: i32, s: f64) -> (f64, f64) {
        (
            s + f64::from(ahead) * self.base_pitch,
            16.0 * f64::EPSILON * s.abs(),
        )
    }

    /// The incoming pair at `s`, without its error, and how its gap grows with s.
    #[must_use]
    pub fn incoming(&self, s: f64) -> (Place, f64) {
        let series = &self.zones[self.zone(s)].series;
        let [stiffness, gap, lever, sliding] = series.at(s);
        (
            Place {
                stiffness,
                gap,
                lever,
                sliding: self.driver_speed * sliding,
            },
            series.slope(GAP, s),
        )
    }

    /// Arm of the friction force over the driver's base radius, and sliding velocity in m/s.
    pub(super) fn slide(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let at = s + f64::from(ahead) * self.base_pitch;
        let [_, _, lever, sliding] = self.zones[zone].series.at(at);
        (lever, self.driver_speed * sliding)
    }

    fn error_of(&self, ahead: i32) -> f64 {
        if ahead == 0 { self.error } else { 0.0 }
    }

    fn zone(&self, at: f64) -> usize {
        self.zones
            .partition_point(|zone| zone.to < at)
            .min(self.zones.len() - 1)
    }

    /// The places of the incoming pair from `from` to `to` at which some pair passes from one zone
    /// into the next: between two of them all that is known of the mesh is smooth.
    #[must_use]
    pub fn borders(&self, from: f64, to: f64) -> Vec<f64> {
        let edges = self
            .zones
            .iter()
            .map(|zone| zone.from)
            .chain(self.zones.last().map(|zone| zone.to));
        let mut found: Vec<f64> = edges
            .flat_map(|edge| {
                let first = ((from - edge) / self.base_pitch).ceil() as i64;
                let last = ((to - edge) / self.base_pitch).floor() as i64;
                (first..=last).map(move |pitch| edge + pitch as f64 * self.base_pitch)
            })
            .collect();
        found.extend([from, to]);
        found.sort_by(f64::total_cmp);
        found.dedup_by(|one, other| *one - *other <= 1e-12 * self.base_pitch);
        found
    }
}

/// Length of the line of action over which a pair may touch, in m.
fn length_of(zones: &[Zone]) -> f64 {
    zones.last().map_or(0.0, |zone| zone.to) - zones.first().map_or(0.0, |zone| zone.from)
}

/// Refuses more pairs at a time than the methods follow. The pairs may touch over so many base
/// pitches.
fn check_pairs(pitches: f64) -> Result<(), Refusal> {
    let pairs = 1 + pitches as usize;
    if pairs > PAIRS {
        return Err(Refusal::TooManyPairs {
            pairs,
            limit: PAIRS,
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_pairs_than_a_set_of_pairs_can_name_are_refused() {
        assert_eq!(check_pairs(63.9), Ok(()));
        let refusal = check_pairs(64.0).unwrap_err();
        assert_eq!(refusal.code(), "too-many-pairs");
        assert_eq!(
            refusal.to_string(),
            "65 tooth pairs may touch at a time, and the limit is 64"
        );
    }
}
