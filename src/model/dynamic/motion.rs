//! The equation of motion between two borders of the mesh.

use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;
use std::rc::Rc;
use std::sync::Arc;

use nalgebra::Vector2;

use super::Settings;
use super::acting::{Crossing, Crossings};
use super::pair::{Flank, PairName, Standing};
use super::side::Side;
use crate::model::Refusal;
use crate::model::budget::{MOTION_SWINGS, PAIRS};
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
    /// By how much the driver falls behind until the back flanks meet, in m; infinite if the case
    /// gives no backlash.
    pub(super) backlash: f64,
    /// The mesh of the back flanks where they are followed.
    pub(super) back: Option<Mesh>,
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
    flank: Flank,
    zones: Vec<usize>,
    known: RefCell<Vec<(Touching, Arc<Shares>)>>,
}

/// What stays the same between two borders: the pairs that may touch, and the zones in which they
/// stand.
#[derive(Debug, Clone)]
pub(super) struct Window {
    /// From where to where the incoming pair goes, in m.
    pub(super) ends: (f64, f64),
    /// Those of the working flanks, then those of the back flanks.
    pub(super) pairs: Vec<Standing>,
    /// How many of them are of the working flanks.
    working: usize,
    /// Of both sides. None if the pairs are independent springs.
    sharing: [Option<Rc<Sharing>>; 2],
    /// What acts between its ends.
    pub(super) crossing: Rc<Crossing>,
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
            backlash: settings.backlash.unwrap_or(f64::INFINITY),
            back: None,
            sharing: RefCell::default(),
            crossings: Crossings::default(),
            looks: Cell::default(),
            bytes: Cell::default(),
        }
    }

    /// The same with the back flanks.
    pub(super) fn with_back(self) -> Motion<'a> {
        Motion {
            back: Some(self.mesh.back()),
            ..self
        }
    }

    /// Whether the case gives a backlash.
    pub(super) fn has_backlash(&self) -> bool {
        self.backlash.is_finite()
    }

    /// Whether a displacement of the driver ahead reaches back flanks that are not followed.
    pub(super) fn misses_back(&self, ahead: f64) -> bool {
        self.back.is_none() && ahead < -self.backlash
    }

    /// The places of the incoming pair from `from` to `to` between which all that is known of the
    /// pairs is smooth.
    pub(super) fn borders(&self, from: f64, to: f64) -> Vec<f64> {
        let mut borders = self.mesh.borders(from, to);
        if let Some(back) = &self.back {
            let (offset, same) = (self.mesh.back_place(), 1e-12 * self.mesh.base_pitch);
            let places = back.borders(from + offset, to + offset);
            let places = places.into_iter().map(|place| place - offset);
            borders.extend(places.filter(|place| *place > from + same && *place < to - same));
            borders.sort_by(f64::total_cmp);
            borders.dedup_by(|one, other| *one - *other <= same);
        }
        borders
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
    ///
    /// # Errors
    /// [`Refusal::TooManyPairs`] where both sides have more pairs than a set of pairs can name.
    pub(super) fn window(&self, from: f64, to: f64) -> Result<Window, Refusal> {
        let inside = f64::midpoint(from, to);
        let mut pairs = standing(self.mesh, Flank::Working, inside);
        let working = pairs.len();
        let mut sharing = [self.sharing(self.mesh, &pairs), None];
        if let Some(back) = &self.back {
            let behind = standing(back, Flank::Back, inside + self.mesh.back_place());
            sharing[1] = self.sharing(back, &behind);
            pairs.extend(behind);
        }
        if pairs.len() > PAIRS {
            return Err(Refusal::TooManyPairs {
                pairs: pairs.len(),
                limit: PAIRS,
            });
        }
        // The number of working pairs, then the zones of the working pairs and of the back pairs.
        let zones = pairs.iter().map(|pair| pair.zone);
        let zones = std::iter::once(working).chain(zones);
        let is_incoming = |pair: &Standing| pair.name() == PairName::working(0);
        let incoming = pairs.iter().position(is_incoming);
        Ok(Window {
            ends: (from, to),
            crossing: self.crossings.of(zones, incoming),
            pairs,
            working,
            sharing,
        })
    }

    /// The pairs of the working flanks while some of the window's pairs touch.
    pub(super) fn working_side<'w>(&'w self, window: &'w Window, touching: Touching) -> Side<'w> {
        let touching = touching.before(window.working);
        Side {
            mesh: self.mesh,
            pairs: &window.pairs[..window.working],
            touching,
            shares: self.shares(self.mesh, window.sharing[0].as_ref(), touching),
            offset: 0.0,
            backlash: 0.0,
            sign: 1.0,
        }
    }

    /// The same of the back flanks where they are followed.
    pub(super) fn back_side<'w>(
        &'w self,
        window: &'w Window,
        touching: Touching,
    ) -> Option<Side<'w>> {
        let mesh = self.back.as_ref()?;
        let touching = touching.since(window.working);
        Some(Side {
            mesh,
            pairs: &window.pairs[window.working..],
            touching,
            shares: self.shares(mesh, window.sharing[1].as_ref(), touching),
            offset: self.mesh.back_place(),
            backlash: self.backlash,
            sign: -1.0,
        })
    }

    /// The sharing of pairs in these zones: a base pitch later it is the same. None if the pairs
    /// are independent springs.
    fn sharing(&self, mesh: &Mesh, pairs: &[Standing]) -> Option<Rc<Sharing>> {
        let flank = pairs.first().filter(|_| mesh.is_coupled())?.flank;
        let mut all = self.sharing.borrow_mut();
        let zones = || pairs.iter().map(|pair| pair.zone);
        let known = all
            .iter()
            .find(|known| known.flank == flank && known.zones.iter().copied().eq(zones()));
        if let Some(sharing) = known {
            return Some(Rc::clone(sharing));
        }
        let sharing = Rc::new(Sharing {
            flank,
            zones: zones().collect(),
            known: RefCell::default(),
        });
        all.push(Rc::clone(&sharing));
        Some(sharing)
    }

    /// How coupled pairs share a displacement; none if none touches or all are independent springs.
    fn shares(
        &self,
        mesh: &Mesh,
        sharing: Option<&Rc<Sharing>>,
        touching: Touching,
    ) -> Option<Arc<Shares>> {
        let sharing = sharing.filter(|_| !touching.is_none())?;
        let mut known = sharing.known.borrow_mut();
        if let Some((_, shares)) = known.iter().find(|(set, _)| *set == touching) {
            return Some(Arc::clone(shares));
        }
        let shares = mesh.shares(&sharing.zones, touching);
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

/// The pairs that may touch while the incoming one stands at a place, in m.
fn standing(mesh: &Mesh, flank: Flank, inside: f64) -> Vec<Standing> {
    let standing = mesh.standing(inside).map(|(ahead, zone)| {
        let (_, sliding) = mesh.slide(ahead, zone, inside);
        Standing {
            flank,
            ahead,
            zone,
            direction: sliding.signum(),
        }
    });
    standing.collect()
}

impl Window {
    /// The named pairs, as a set; none where one of them is not there any more.
    pub(super) fn touching(&self, names: &[PairName]) -> Option<Touching> {
        names.iter().try_fold(Touching::NONE, |set, &name| {
            Some(set.with(self.index_of(name)?))
        })
    }

    /// The names of the touching pairs.
    pub(super) fn names(&self, touching: Touching) -> Vec<PairName> {
        let pairs = touching.pairs().filter_map(|pair| self.pairs.get(pair));
        pairs.map(Standing::name).collect()
    }

    /// The place of the incoming pair in the window, where it is there.
    pub(super) fn incoming(&self) -> Option<usize> {
        self.index_of(PairName::working(0))
    }

    /// Those of the touching pairs that are of the working flanks.
    pub(super) fn working(&self, touching: Touching) -> Touching {
        touching.before(self.working)
    }

    /// The touching pairs of the back flanks.
    pub(super) fn back(&self, touching: Touching) -> impl Iterator<Item = usize> {
        touching.pairs().filter(|&pair| pair >= self.working)
    }

    fn index_of(&self, name: PairName) -> Option<usize> {
        self.pairs.iter().position(|pair| pair.name() == name)
    }
}
