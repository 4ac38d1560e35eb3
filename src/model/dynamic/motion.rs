//! The equation of motion between two borders of the mesh.

use std::cell::Cell;
use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::Settings;
use crate::model::Refusal;
use crate::model::mesh::Mesh;
use crate::numeric::ode::{Equation, Point, step};

/// Displacement of the driver ahead in m, its rate in m/s, and work of friction on the incoming tooth in J.
pub(super) type State = Vector3<f64>;

/// The oscillator.
pub(super) struct Motion<'a> {
    pub(super) mesh: &'a Mesh,
    mass: f64,
    damping: f64,
    /// Of the mean stiffness, in rad/s.
    frequency: f64,
    decay: f64,
    warmup_cycles: u32,
}

/// What stays the same between two borders: the pairs that may touch, and the zones in which they stand.
#[derive(Debug, Clone)]
pub(super) struct Window {
    pairs: Vec<Standing>,
}

#[derive(Debug, Clone, Copy)]
struct Standing {
    ahead: i32,
    zone: usize,
    /// Which way the driven flank slides on the driver's.
    direction: f64,
}

/// The pairs of a window that are in contact, a bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Touching(u64);

/// The equation while the same pairs stay in contact.
#[derive(Clone, Copy)]
pub(super) struct Forces<'a> {
    motion: &'a Motion<'a>,
    window: &'a Window,
    touching: Touching,
    evaluations: &'a Cell<u64>,
}

impl<'a> Motion<'a> {
    pub(super) fn new(mesh: &'a Mesh, settings: &Settings) -> Motion<'a> {
        let frequency = (mesh.mean_stiffness / settings.mass).sqrt();
        Motion {
            mesh,
            mass: settings.mass,
            damping: 2.0 * settings.damping_ratio * settings.mass * frequency,
            frequency,
            decay: settings.damping_ratio * frequency,
            warmup_cycles: settings.warmup_cycles,
        }
    }

    /// Where the incoming pair stands at the start. Where not a bit of a start one base pitch earlier would be left, no
    /// more than that one is run.
    pub(super) fn start(&self) -> f64 {
        const FORGOTTEN: f64 = 42.0;
        let pitch = self.mesh.base_pitch;
        let forgets_a_pitch = self.decay * pitch / self.mesh.speed > FORGOTTEN;
        let pitches = if forgets_a_pitch { self.warmup_cycles.min(2) } else { self.warmup_cycles };
        -f64::from(pitches) * pitch
    }

    /// Time at which the incoming pair stands at `s`; 0 at E.
    pub(super) fn time(&self, s: f64) -> f64 {
        s / self.mesh.speed
    }

    /// Where the incoming pair stands.
    pub(super) fn place(&self, t: f64) -> f64 {
        t * self.mesh.speed
    }

    /// A third of the period of the mean stiffness: a longer step could hide a touch.
    pub(super) fn longest_step(&self) -> f64 {
        TAU / (3.0 * self.frequency)
    }

    /// The size of a state: what the force yields at rest, and the rate of a swing of that size. Work has no size.
    pub(super) fn scale(&self) -> State {
        let deflection = self.mesh.force / self.mesh.mean_stiffness;
        State::new(deflection, deflection * self.frequency, f64::INFINITY)
    }

    /// Refuse a way on which the mesh swings too often.
    pub(super) fn check_pace(&self, way: f64) -> Result<(), Refusal> {
        const MOST: f64 = 1e6;
        let swings = self.time(way) * self.frequency / TAU;
        if swings > MOST { Err(Refusal::TooSlow { swings, limit: MOST }) } else { Ok(()) }
    }

    /// What stays the same while the incoming pair goes from one place to the other.
    pub(super) fn window(&self, from: f64, to: f64) -> Window {
        let inside = f64::midpoint(from, to);
        let standing = self.mesh.standing(inside).map(|(ahead, zone)| {
            let (_, sliding) = self.mesh.slide(ahead, zone, inside);
            Standing { ahead, zone, direction: sliding.signum() }
        });
        Window { pairs: standing.collect() }
    }
}

impl Window {
    /// The pairs of that many base pitches ahead, as a set; none where one of them is not there any more.
    pub(super) fn touching(&self, ahead: &[i32]) -> Option<Touching> {
        ahead.iter().try_fold(Touching(0), |set, &ahead| Some(set.with(self.index_of(ahead)?)))
    }

    /// How many base pitches ahead the touching pairs are.
    pub(super) fn ahead(&self, touching: Touching) -> Vec<i32> {
        self.pairs.iter().enumerate().filter(|(pair, _)| touching.has(*pair)).map(|(_, pair)| pair.ahead).collect()
    }

    /// The place of the incoming pair in the window, where it is there.
    pub(super) fn incoming(&self) -> Option<usize> {
        self.index_of(0)
    }

    pub(super) fn len(&self) -> usize {
        self.pairs.len()
    }

    fn index_of(&self, ahead: i32) -> Option<usize> {
        self.pairs.iter().position(|pair| pair.ahead == ahead)
    }
}

impl Touching {
    pub(super) fn has(self, pair: usize) -> bool {
        self.0 & 1 << pair != 0
    }

    pub(super) fn is_none(self) -> bool {
        self.0 == 0
    }

    /// The set with the pair touching where it did not, and the other way round.
    pub(super) fn toggled(self, pair: usize) -> Touching {
        Touching(self.0 ^ 1 << pair)
    }

    fn with(self, pair: usize) -> Touching {
        Touching(self.0 | 1 << pair)
    }
}

impl<'a> Forces<'a> {
    pub(super) fn new(motion: &'a Motion<'a>, window: &'a Window, touching: Touching, evaluations: &'a Cell<u64>) -> Forces<'a> {
        Forces { motion, window, touching, evaluations }
    }

    #[cfg(test)]
    pub(super) fn mass(&self) -> f64 {
        self.motion.mass
    }

    /// How many pairs may touch.
    pub(super) fn pairs(&self) -> usize {
        self.window.len()
    }

    pub(super) fn touches(&self, pair: usize) -> bool {
        self.touching.has(pair)
    }

    /// The state a part of a step later, by a step of its own.
    pub(super) fn after(&self, from: &Point<3>, length: f64) -> State {
        if length == 0.0 { from.y } else { step(self, from, length).y }
    }

    /// How far the flanks of a pair are pressed together, below 0 apart, in m, and how fast that grows, in m/s.
    pub(super) fn pressed(&self, pair: usize, t: f64, y: &State) -> (f64, f64) {
        let Standing { ahead, zone, .. } = self.window.pairs[pair];
        let (mesh, s) = (self.motion.mesh, self.motion.place(t));
        let (gap, slope) = mesh.gap(ahead, zone, s);
        (y[0] - gap, y[1] - slope * mesh.speed)
    }

    /// Force of a pair that touches, in N, and how fast it grows, in N/s.
    pub(super) fn force(&self, pair: usize, t: f64, y: &State) -> (f64, f64) {
        let Standing { ahead, zone, .. } = self.window.pairs[pair];
        let (mesh, s) = (self.motion.mesh, self.motion.place(t));
        let [(stiffness, stiffening), (gap, opening)] = mesh.spring_with_slopes(ahead, zone, s);
        let (pressed, rate) = (y[0] - gap, y[1] - opening * mesh.speed);
        (stiffness * pressed, stiffness * rate + stiffening * mesh.speed * pressed)
    }

    /// Forces of all pairs together, in N.
    pub(super) fn total(&self, t: f64, y: &State) -> f64 {
        (0..self.pairs()).filter(|&pair| self.touches(pair)).map(|pair| self.force(pair, t, y).0).sum()
    }
}

impl Equation<3> for Forces<'_> {
    fn slope(&self, t: f64, y: &State) -> State {
        self.evaluations.set(self.evaluations.get() + 1);
        let (motion, mesh) = (self.motion, self.motion.mesh);
        let (s, friction) = (motion.place(t), mesh.friction());
        let (mut carried, mut power) = (0.0, 0.0);
        for (index, pair) in self.window.pairs.iter().enumerate().filter(|(index, _)| self.touches(*index)) {
            let (stiffness, gap) = mesh.spring(pair.ahead, pair.zone, s);
            let force = stiffness * (y[0] - gap);
            carried += force;
            if friction > 0.0 {
                let (lever, sliding) = mesh.slide(pair.ahead, pair.zone, s);
                carried -= friction * pair.direction * lever * force;
                power += if pair.ahead == 0 { friction * force * sliding.abs() } else { 0.0 };
            }
            debug_assert!(index < 64, "a contact ratio of sixty");
        }
        let damping = if self.touching.is_none() { 0.0 } else { motion.damping * y[1] };
        State::new(y[1], (mesh.force - carried - damping) / motion.mass, power)
    }
}
