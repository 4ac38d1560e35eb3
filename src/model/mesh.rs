//! Gap and stiffness of every tooth pair along the line of action, used by the methods `static` and
//! `dynamic`.

pub(super) mod build;
pub(super) mod sharing;
mod zones;

use std::sync::{Arc, OnceLock};

use super::Refusal;
use super::compliance::Elasticity;
use super::compliance::flanks::Flanks;
use super::geometry::PairShape;
use super::given::GivenCompliance;
use super::inputs::Inputs;
use super::pair_forces::{OfPairs, PITCHES, Pair, PairSet, Place};
use super::relief::Reliefs;
use crate::numeric::chebyshev::{Series, TERMS};
use crate::numeric::polynomial::Polynomial;
use crate::numeric::{distinct, quadrature, root, steps};
use sharing::Couplings;
use sharing::Sharing;
pub use sharing::{Meeting, Of, Shares};
use zones::{GAP, LEVER, SLIDING, STIFFNESS, Zone};

/// The mesh as a function of s, the path of the incoming pair along the line of action since E, in
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
    /// Base radii, in m.
    pub base_radii: (f64, f64),
    /// Common face width b, in m.
    pub width: f64,
    friction: f64,
    pitch_point: f64,
    /// Inputs of the mesh, at a speed of 1.
    inputs: MeshInputs,
    flanks: Arc<Flanks>,
    /// The zones for any speed: they contain the sliding velocity per unit of speed.
    zones: Arc<Vec<Zone>>,
    /// `None` if the pairs are independent springs.
    couplings: Option<Arc<Couplings>>,
    /// Cached load sharing of coupled pairs.
    sharing: Arc<Cache<Sharing>>,
    mean_stiffness: Arc<Cache<OnceLock<f64>>>,
    sections: Arc<Cache<OnceLock<Arc<Series<6>>>>>,
    back_place: f64,
    /// The mesh of the back flanks, for all meshes that differ only in speed and deviation.
    back: Arc<Cache<OnceLock<Mesh>>>,
    /// Greatest gap in the computed range, in m.
    reach: f64,
    is_whole: bool,
    work: u64,
}

impl Mesh {
    /// The mesh at another speed of the driver, in rad/s.
    pub fn turning_at(self: &Arc<Mesh>, driver_speed: f64) -> Arc<Mesh> {
        if driver_speed.to_bits() == self.driver_speed.to_bits() {
            return Arc::clone(self);
        }
        Arc::new(self.at_speed(driver_speed))
    }

    fn at_speed(&self, driver_speed: f64) -> Mesh {
        Mesh { speed: driver_speed * self.base_radii.0, driver_speed, ..self.clone() }
    }

    /// The mesh without deviation of the incoming pair.
    pub fn without_error(&self) -> Mesh {
        Mesh { error: 0.0, ..self.clone() }
    }

    /// Work of the computation, in units of the [budget](super::budget).
    pub fn work(&self) -> u64 {
        self.work
    }

    /// First and last place of the incoming pair with a computed gap, in m.
    pub fn ends(&self) -> (f64, f64) {
        let from = self.zones.first().map_or(0.0, |zone| zone.from);
        (from, self.zones.last().map_or(0.0, |zone| zone.to))
    }

    /// Whether the computed range extends to the ends of the tip circles.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// The friction coefficient; 0 if the case gives none.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Place of the incoming pair at the pitch point, in m. `None` if the path of contact does not
    /// include the pitch point.
    pub fn pitch_point(&self) -> Option<f64> {
        Some(self.pitch_point).filter(|&point| point > 0.0 && point < self.length)
    }

    /// The pairs that may touch with the incoming pair at `s`. On a border, `inside` selects the
    /// side. If a pair is at E' for `inside` itself, the pair is on the flank of its tooth, not on
    /// the arc of the tip.
    pub fn pair_set(&self, s: f64, inside: f64) -> PairSet {
        let inside = self.on_flank(inside);
        let pairs: OfPairs<Pair> =
            self.standing(inside).map(|(ahead, zone)| self.pair(ahead, zone, s, inside)).collect();
        let first = pairs.first().map_or(0, |pair| pair.ahead);
        let couplings = self.couplings_of(first, pairs.len(), s, inside);
        PairSet::new(pairs, couplings)
    }

    /// Whether the force on a pair displaces other pairs.
    pub fn is_coupled(&self) -> bool {
        self.couplings.is_some()
    }

    /// Displacement of each of `count` pairs, beginning `first` pitches ahead, by a unit force on
    /// the pairs 1, 2, .. pitches behind, in m/N. Empty without coupling.
    fn couplings_of(
        &self,
        first: i32,
        count: usize,
        s: f64,
        inside: f64,
    ) -> OfPairs<[f64; PITCHES]> {
        let Some(couplings) = &self.couplings else {
            return OfPairs::new();
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

    /// The pairs and their zones.
    pub(super) fn standing(&self, s: f64) -> impl Iterator<Item = (i32, usize)> {
        let (from, to) = self.ends();
        let first = ((from - s) / self.base_pitch).ceil() as i32;
        let last = ((to - s) / self.base_pitch).floor() as i32;
        (first..=last).map(move |ahead| (ahead, self.zone(self.place(ahead, s))))
    }

    /// The pair `ahead` with the incoming pair at `s`. The sliding direction is that at `inside`.
    fn pair(&self, ahead: i32, zone: usize, s: f64, inside: f64) -> Pair {
        let (stiffness, gap) = self.spring(ahead, zone, s);
        let weight = if self.friction > 0.0 {
            let lever = self.zones[zone].series.one(LEVER, self.place(ahead, s));
            1.0 - self.friction * self.direction(ahead, zone, inside) * lever
        } else {
            1.0
        };
        Pair { ahead, stiffness, gap, weight }
    }

    /// Place of the pair `ahead` with the incoming pair at `s`.
    fn place(&self, ahead: i32, s: f64) -> f64 {
        s + f64::from(ahead) * self.base_pitch
    }

    /// Sign of the sliding velocity of a pair.
    pub(super) fn direction(&self, ahead: i32, zone: usize, s: f64) -> f64 {
        self.zones[zone].series.one(SLIDING, self.place(ahead, s)).signum()
    }

    /// Refuses a lead of the driver, in m, with which pairs beyond the ends of the mesh may touch.
    pub(super) fn check_reach(&self, lead: f64) -> Result<(), Refusal> {
        let (from, to) = self.ends();
        let gap = |s: f64| self.incoming(s).0.gap;
        if !self.is_whole && lead >= gap(from).min(gap(to)) {
            return Err(Refusal::BeyondReach);
        }
        Ok(())
    }

    /// The incoming pair at `s` without its error, and the slope of its gap over s. At E' the pair
    /// is on the flank of its tooth.
    pub fn incoming(&self, s: f64) -> (Place, f64) {
        let series = &self.zones[self.zone(self.on_flank(s))].series;
        let [stiffness, gap, _, sliding] = series.at(s);
        (Place { stiffness, gap, sliding: self.driver_speed * sliding }, series.slope(GAP, s))
    }

    /// Error of a pair, in m: the incoming one alone deviates.
    pub(super) fn error_of(&self, ahead: i32) -> f64 {
        if ahead == 0 { self.error } else { 0.0 }
    }

    /// A place slightly after `s` if a pair is at E' for `s`, otherwise `s`.
    fn on_flank(&self, s: f64) -> f64 {
        const AFTER: f64 = 1e-9;
        let pitches = (s / self.base_pitch).round();
        if s - pitches * self.base_pitch == 0.0 { s + AFTER * self.base_pitch } else { s }
    }

    /// Displacement of a pair at a place by a unit force on the pair `apart` pitches ahead, in m/N.
    pub(super) fn coupling(&self, apart: usize, place: f64) -> f64 {
        self.couplings.as_ref().map_or(0.0, |couplings| couplings.at(apart - 1, place, place))
    }

    fn zone(&self, at: f64) -> usize {
        self.zones.partition_point(|zone| zone.to < at).min(self.zones.len() - 1)
    }

    /// The places of a pair at which it passes into another zone.
    pub(super) fn edges(&self) -> impl Iterator<Item = f64> + Clone {
        self.zones.iter().map(|zone| zone.from).chain(self.zones.last().map(|zone| zone.to))
    }

    /// The places of the incoming pair from `from` to `to` at which a pair passes into another
    /// zone. Between two of them all functions of the mesh are smooth.
    pub fn borders(&self, from: f64, to: f64) -> Vec<f64> {
        let mut found: Vec<f64> = self
            .edges()
            .flat_map(|edge| {
                let first = ((from - edge) / self.base_pitch).ceil() as i64;
                let last = ((to - edge) / self.base_pitch).floor() as i64;
                (first..=last).map(move |pitch| edge + pitch as f64 * self.base_pitch)
            })
            .collect();
        found.extend([from, to]);
        let same = 1e-12 * self.base_pitch;
        // A contact at E does not begin before E by rounding.
        for place in found.iter_mut().filter(|place| place.abs() <= same) {
            *place = 0.0;
        }
        distinct(found, same)
    }
}

/// Inputs of the mesh besides geometry, mesh force and error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshInputs {
    /// Shape of the pair. For the run-out, the gears are swapped.
    pub shape: PairShape,
    /// Elasticity of the pair.
    pub elasticity: Elasticity,
    /// Reliefs of the pair.
    pub reliefs: Reliefs,
    /// Radii of the tip edges of driver and driven gear, in m.
    pub tip_radii: [Option<f64>; 2],
    /// Speed of the driver ω₁, in rad/s.
    pub speed: f64,
    /// Friction coefficient; 0 if the case gives none.
    pub friction: f64,
}

impl Inputs {
    /// Inputs of the mesh.
    pub fn mesh(&self) -> MeshInputs {
        MeshInputs {
            shape: self.shape(),
            elasticity: self.elasticity(),
            reliefs: self.reliefs(),
            tip_radii: [self.driver.tip_radius, self.driven.tip_radius],
            speed: self.speed,
            friction: self.friction_coefficient.unwrap_or(0.0),
        }
    }
}

impl MeshInputs {
    fn driven_speed(&self) -> f64 {
        self.speed / (self.shape.driven.teeth / self.shape.driver.teeth)
    }

    /// The inputs at another speed of the driver, in rad/s.
    pub fn at_speed(self, speed: f64) -> MeshInputs {
        MeshInputs { speed, ..self }
    }

    /// The inputs with the gears swapped.
    fn swapped(&self) -> MeshInputs {
        let MeshInputs { shape, elasticity, reliefs, tip_radii: [driver_tip, driven_tip], .. } =
            *self;
        MeshInputs {
            shape: PairShape { driver: shape.driven, driven: shape.driver, ..shape },
            elasticity: Elasticity {
                driver: elasticity.driven,
                driven: elasticity.driver,
                given: elasticity.given.map(GivenCompliance::swapped),
                ..elasticity
            },
            reliefs: Reliefs { driver: reliefs.driven, driven: reliefs.driver, ..reliefs },
            tip_radii: [driven_tip, driver_tip],
            speed: self.driven_speed(),
            friction: self.friction,
        }
    }
}

impl Mesh {
    /// Stiffness and gap of a pair, including its error.
    pub(super) fn spring(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let [stiffness, gap] = self.zones[zone].series.at(self.place(ahead, s));
        (stiffness, gap - self.error_of(ahead))
    }

    /// Greatest stiffness of one pair from E to B, in N/m.
    pub fn single_stiffness(&self) -> f64 {
        let stiffness = |s: f64| self.incoming(s).0.stiffness;
        let known: Vec<_> = steps(0.0, self.length, 32).map(|s| (s, stiffness(s))).collect();
        root::greatest(&known, stiffness).1
    }

    /// Stiffness of the incoming pair just after E over its stiffness just before E.
    pub fn stiffness_step(&self) -> f64 {
        let beside = 1e-9 * self.base_pitch;
        let [before, after] = [-beside, beside].map(|s| self.spring(0, self.zone(s), 0.0).0);
        after / before
    }

    /// Stiffness and gap of a pair from `s` to `s + length`, including its error, as polynomials
    /// from 0 to 1.
    pub(super) fn spring_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [stiffness, mut gap] =
            self.zones[zone].series.local(STIFFNESS, self.above(ahead, s), length);
        gap.0[0] -= self.error_of(ahead);
        [stiffness, gap]
    }

    /// Between what values its gap is on the piece that serves from `s` up.
    pub(super) fn gap_bounds(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let (low, high) = self.zones[zone].series.bounds(GAP, self.above(ahead, s));
        let error = self.error_of(ahead);
        (low - error, high - error)
    }

    /// Arm of the friction force over the driver's base radius, and sliding velocity, as
    /// polynomials, see [`Mesh::spring_along`].
    pub(super) fn slide_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [lever, sliding] = self.zones[zone].series.local(LEVER, self.above(ahead, s), length);
        [lever, sliding.scaled(self.driver_speed)]
    }

    /// Length from `s` on in which these polynomials are valid, within the zone.
    pub(super) fn serves_until(&self, ahead: i32, zone: usize, s: f64) -> f64 {
        let (at, least) = self.above(ahead, s);
        s + (self.zones[zone].series.serves_until(at, least) - at)
    }

    /// The place of a pair, and the distance below which two places are equal.
    pub(super) fn above(&self, ahead: i32, s: f64) -> (f64, f64) {
        (self.place(ahead, s), 16.0 * f64::EPSILON * s.abs())
    }
}

impl Mesh {
    /// The mesh without the places before E and after B where the gap exceeds `gap`, in m. Pairs
    /// at these places are no longer part of it.
    pub(super) fn within(&self, gap: f64) -> Mesh {
        let (mut from, mut to) = self.ends();
        for zone in self.zones.iter().filter(|zone| zone.to <= 0.0) {
            from = zone.border(gap, (zone.from, zone.to)).unwrap_or(from);
        }
        let after = self.zones.iter().filter(|zone| zone.from >= self.length);
        for zone in after.rev() {
            to = zone.border(gap, (zone.to, zone.from)).unwrap_or(to);
        }
        let kept = self.zones.iter().filter(|zone| zone.to > from && zone.from < to);
        let zones = kept.map(|zone| Zone {
            from: zone.from.max(from),
            to: zone.to.min(to),
            ..zone.clone()
        });
        Mesh {
            zones: Arc::new(zones.collect()),
            sharing: Arc::default(),
            back: Arc::default(),
            is_whole: false,
            ..self.clone()
        }
    }
}

impl Zone {
    /// The place between the end far from the line of action and the near end where the gap is
    /// `gap`. `None` if the gap does not pass this value.
    fn border(&self, gap: f64, (far, near): (f64, f64)) -> Option<f64> {
        let beyond = |s: f64| self.series.one(GAP, s) - gap;
        (beyond(far) > 0.0 && beyond(near) <= 0.0).then(|| root::between(far, near, beyond))
    }
}

impl Mesh {
    /// Mean stiffness of the mesh over a base pitch, with the pairs on the line of action, in N/m.
    pub fn mean_stiffness(&self) -> f64 {
        let mean = || self.stiffness_on_line() / self.base_pitch;
        *self.mean_stiffness.0.get_or_init(mean)
    }

    /// ∫ of the stiffness of all pairs on the line of action over a base pitch, in N.
    fn stiffness_on_line(&self) -> f64 {
        /// Of the integral between two borders.
        const TOLERANCE: f64 = 1e-12;
        let on_line = |zone: &&Zone| zone.from >= 0.0 && zone.to <= self.length;
        let zones = self.zones.iter().filter(on_line);
        if self.couplings.is_none() {
            return zones.map(|zone| zone.series.integral(STIFFNESS)).sum();
        }
        let line = Mesh { zones: Arc::new(zones.cloned().collect()), ..self.clone() };
        let stiffness = |s: f64, inside: f64| {
            let pairs = line.pair_set(s, inside).of_no_gap();
            pairs.forces(1.0).iter().sum::<f64>()
        };
        // The borders of the line alone: the places beyond it depend on the computed range.
        let borders = line.borders(0.0, self.base_pitch);
        let over = |ends: &[f64]| {
            let (from, to) = (ends[0], ends[1]);
            let inside = f64::midpoint(from, to);
            quadrature::adaptive(from, to, TOLERANCE, |s| stiffness(s, inside))
        };
        borders.windows(2).map(over).sum()
    }
}

/// A cached value, which does not affect the equality of meshes.
#[derive(Debug, Default)]
struct Cache<T>(T);

impl<T> PartialEq for Cache<T> {
    fn eq(&self, _: &Cache<T>) -> bool {
        true
    }
}
