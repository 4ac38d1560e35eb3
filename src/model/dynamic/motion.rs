//! The equation of motion between two borders of the mesh.

use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;
use std::rc::Rc;
use std::sync::Arc;

use nalgebra::Vector2;

use super::Settings;
use super::acting::{Crossing, Crossings};
use crate::model::Refusal;
use crate::model::budget::MOTION_SWINGS;
use crate::model::mesh::{Mesh, Shares};
use crate::model::pair_forces::Touching;

/// Displacement of the driver ahead in m, and its rate in m/s.
pub(super) type State = Vector2<f64>;

/// The oscillator.
pub(super) struct Motion<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) mass: f64,
    /// c while a pair touches, in kg/s.
    pub(super) damping: f64,
    /// Of the mean stiffness, in rad/s.
    frequency: f64,
    decay: f64,
    warmup_cycles: u32,
    /// The sharing of coupled pairs that this motion needed.
    sharing: RefCell<Vec<Rc<Sharing>>>,
    crossings: Crossings,
    /// Places at which shares were computed, by this motion or by another on the same mesh.
    looks: Cell<u64>,
    /// What shares and crossings take, in bytes.
    bytes: Cell<usize>,
}

/// How coupled pairs share a displacement that stand in some zones.
#[derive(Debug)]
struct Sharing {
    zones: Vec<usize>,
    known: RefCell<Vec<(Touching, Arc<Shares>)>>,
}

/// What stays the same between two borders: the pairs that may touch, and the zones in which they
/// stand.
#[derive(Debug, Clone)]
pub(super) struct Window {
    /// From where to where the incoming pair goes, in m.
    pub(super) ends: (f64, f64),
    pub(super) pairs: Vec<Standing>,
    /// None if the pairs are independent springs.
    sharing: Option<Rc<Sharing>>,
    /// What acts between its ends.
    pub(super) crossing: Rc<Crossing>,
}

/// A pair that may touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Standing {
    /// How many base pitches it is ahead of the incoming one.
    pub(super) ahead: i32,
    /// The zone of the mesh in which it stands.
    pub(super) zone: usize,
    /// Which way the driven flank slides on the driver's.
    pub(super) direction: f64,
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
            sharing: RefCell::default(),
            crossings: Crossings::default(),
            looks: Cell::default(),
            bytes: Cell::default(),
        }
    }

    /// Where the incoming pair stands at the start. Where not a bit of a start one base pitch
    /// earlier would be left, no more than that one is run.
    pub(super) fn start(&self) -> f64 {
        const FORGOTTEN: f64 = 42.0;
        let pitch = self.mesh.base_pitch;
        let forgets_a_pitch = self.decay * pitch / self.mesh.speed > FORGOTTEN;
        let pitches = if forgets_a_pitch {
            self.warmup_cycles.min(2)
        } else {
            self.warmup_cycles
        };
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

    /// Half the period of the mean stiffness, in s.
    pub(super) fn half_swing(&self) -> f64 {
        0.5 * TAU / self.frequency
    }

    /// A step over which no series converges, in s.
    pub(super) fn longest_step(&self) -> f64 {
        8.0 / self.frequency
    }

    /// The size of a state: what the force yields at rest, and the rate of a swing of that size.
    pub(super) fn scale(&self) -> State {
        let deflection = self.mesh.force / self.mesh.mean_stiffness;
        State::new(deflection, deflection * self.frequency)
    }

    /// Refuse a way on which the mesh swings too often.
    pub(super) fn check_pace(&self, way: f64) -> Result<(), Refusal> {
        let swings = self.time(way) * self.frequency / TAU;
        if swings > MOTION_SWINGS {
            Err(Refusal::TooSlow {
                swings,
                limit: MOTION_SWINGS,
            })
        } else {
            Ok(())
        }
    }

    /// What stays the same while the incoming pair goes from one place to the other.
    pub(super) fn window(&self, from: f64, to: f64) -> Window {
        let inside = f64::midpoint(from, to);
        let standing = self.mesh.standing(inside).map(|(ahead, zone)| {
            let (_, sliding) = self.mesh.slide(ahead, zone, inside);
            Standing {
                ahead,
                zone,
                direction: sliding.signum(),
            }
        });
        let pairs: Vec<Standing> = standing.collect();
        let is_shared = self.mesh.is_coupled() && !pairs.is_empty();
        let zones = pairs.iter().map(|pair| pair.zone);
        let incoming = pairs.iter().position(|pair| pair.ahead == 0);
        Window {
            ends: (from, to),
            crossing: self.crossings.of(zones, incoming),
            sharing: is_shared.then(|| self.sharing(&pairs)),
            pairs,
        }
    }

    /// The sharing of pairs in these zones: a base pitch later it is the same.
    fn sharing(&self, pairs: &[Standing]) -> Rc<Sharing> {
        let mut all = self.sharing.borrow_mut();
        let zones = || pairs.iter().map(|pair| pair.zone);
        let known = all
            .iter()
            .find(|known| known.zones.iter().copied().eq(zones()));
        if let Some(sharing) = known {
            return Rc::clone(sharing);
        }
        let sharing = Rc::new(Sharing {
            zones: zones().collect(),
            known: RefCell::default(),
        });
        all.push(Rc::clone(&sharing));
        sharing
    }

    /// How coupled pairs share a displacement; none if none touches or all are independent springs.
    pub(super) fn shares(&self, window: &Window, touching: Touching) -> Option<Arc<Shares>> {
        let sharing = window.sharing.as_ref().filter(|_| !touching.is_none())?;
        let mut known = sharing.known.borrow_mut();
        if let Some((_, shares)) = known.iter().find(|(set, _)| *set == touching) {
            return Some(Arc::clone(shares));
        }
        let shares = self.mesh.shares(&sharing.zones, touching);
        self.looks
            .set(self.looks.get() + shares.evaluations() as u64);
        self.keep(shares.bytes());
        known.push((touching, Arc::clone(&shares)));
        Some(shares)
    }

    /// Counts what is kept beside the steps, in bytes.
    pub(super) fn keep(&self, bytes: usize) {
        self.bytes.set(self.bytes.get() + bytes);
    }

    /// Places at which shares were computed since the last call.
    pub(super) fn take_looks(&self) -> u64 {
        self.looks.take()
    }

    /// What shares and crossings take, in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.bytes.get()
    }
}

impl Window {
    /// The pairs of that many base pitches ahead, as a set; none where one of them is not there any
    /// more.
    pub(super) fn touching(&self, ahead: &[i32]) -> Option<Touching> {
        ahead.iter().try_fold(Touching::NONE, |set, &ahead| {
            Some(set.with(self.index_of(ahead)?))
        })
    }

    /// How many base pitches ahead the touching pairs are.
    pub(super) fn ahead(&self, touching: Touching) -> Vec<i32> {
        self.pairs
            .iter()
            .enumerate()
            .filter(|(pair, _)| touching.has(*pair))
            .map(|(_, pair)| pair.ahead)
            .collect()
    }

    /// The place of the incoming pair in the window, where it is there.
    pub(super) fn incoming(&self) -> Option<usize> {
        self.index_of(0)
    }

    fn index_of(&self, ahead: i32) -> Option<usize> {
        self.pairs.iter().position(|pair| pair.ahead == ahead)
    }
}
