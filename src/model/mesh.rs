//! Gap and stiffness of every tooth pair along the line of action: what the methods `static` and
//! `dynamic` share.

mod back;
mod build;
mod couplings;
mod inputs;
mod one_pair;
mod sharing;
mod zones;

use std::sync::Arc;

use super::compliance::flanks::Flanks;
use super::pair_forces::{Compliances, PITCHES, Pair, PairSet, Place, Touching};
use back::Back;
use couplings::Couplings;
pub use inputs::MeshInputs;
pub use sharing::Shares;
use sharing::Sharing;
use zones::{GAP, SLIDING, STIFFNESS, Zone};

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
    /// How coupled pairs share a displacement.
    sharing: Arc<Sharing>,
    back_place: f64,
    back: Arc<Back>,
    /// Up to what gaps it is known, in m.
    reach: f64,
    is_whole: bool,
    work: u64,
}

impl Mesh {
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

    /// The same in which no pair deviates.
    #[must_use]
    pub fn without_error(&self) -> Mesh {
        Mesh {
            error: 0.0,
            ..self.clone()
        }
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
    /// side where `inside` lies. Where `inside` itself is a place at which a pair is at E', this pair
    /// is on the flank of its tooth and not on the arc of the tip.
    #[must_use]
    pub fn pair_set(&self, s: f64, inside: f64) -> PairSet {
        let inside = self.on_flank(inside);
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
    /// the pairs 1, 2, .. pitches behind it, in m/N; empty if there are none.
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

    /// How pairs share a displacement that stand in these zones, the rearmost first, while some of
    /// them touch.
    pub(super) fn shares(&self, zones: &[usize], touching: Touching) -> Arc<Shares> {
        self.sharing.of(zones, touching, || {
            let ends = self.way_of(zones);
            let inside = f64::midpoint(ends.0, ends.1);
            Shares::of(zones.len(), ends, touching, &|at, find| {
                let pairs = (0..).zip(zones);
                let own = pairs.map(|(pair, &zone)| {
                    let at = at + f64::from(pair) * self.base_pitch;
                    self.zones[zone].series.one(STIFFNESS, at).recip()
                });
                find(&Compliances {
                    own: &own.collect::<Vec<f64>>(),
                    couplings: &self.couplings_of(0, zones.len(), at, inside),
                });
            })
        })
    }

    /// From where to where the rearmost of pairs goes while they, and no others, stand in these
    /// zones, in m.
    fn way_of(&self, zones: &[usize]) -> (f64, f64) {
        let (from, to) = self.ends();
        let none = (
            to - zones.len() as f64 * self.base_pitch,
            from + self.base_pitch,
        );
        let pairs = (0..).zip(zones);
        pairs.fold(none, |(from, to), (pair, &zone)| {
            let (zone, ahead) = (&self.zones[zone], f64::from(pair) * self.base_pitch);
            (from.max(zone.from - ahead), to.min(zone.to - ahead))
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

    /// The incoming pair at `s`, without its error, and how its gap grows with s; at E' on the flank
    /// of its tooth.
    #[must_use]
    pub fn incoming(&self, s: f64) -> (Place, f64) {
        let series = &self.zones[self.zone(self.on_flank(s))].series;
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

    fn error_of(&self, ahead: i32) -> f64 {
        if ahead == 0 { self.error } else { 0.0 }
    }

    /// A place a little after `s`, if a pair is at E' there, else `s`.
    fn on_flank(&self, s: f64) -> f64 {
        const AFTER: f64 = 1e-9;
        let pitches = (s / self.base_pitch).round();
        if s - pitches * self.base_pitch == 0.0 {
            s + AFTER * self.base_pitch
        } else {
            s
        }
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
