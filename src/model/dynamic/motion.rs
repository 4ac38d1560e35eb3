//! The equation of motion between two borders of the mesh.

use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;
use std::rc::Rc;
use std::sync::Arc;

use nalgebra::Vector2;

use super::Settings;
use super::side::{Flank, PairName, Side, Standing, TERMS};
use crate::model::Refusal;
use crate::model::budget::{MOTION_OSCILLATIONS, PAIRS};
use crate::model::mesh::{Meeting, Mesh, Shares};
use crate::model::pair_forces::Touching;
use crate::numeric::polynomial::Polynomial;

/// Displacement of the driver ahead in m, and its rate in m/s.
pub(super) type State = Vector2<f64>;

/// The oscillator.
pub(super) struct Motion<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) mass: f64,
    /// Damping c while a pair touches, in kg/s.
    pub(super) damping: f64,
    /// Natural frequency with the mean stiffness, in rad/s.
    frequency: f64,
    decay: f64,
    warmup_cycles: u32,
    /// Distance that the driver falls behind until the back flanks touch, in m; infinite if the
    /// case gives no backlash.
    pub(super) backlash: f64,
    /// The mesh of the back flanks if the motion includes them.
    pub(super) back: Option<Mesh>,
    /// Cached load sharing of coupled pairs.
    sharing: RefCell<Vec<Rc<Sharing>>>,
    crossings: Crossings,
    /// Number of places where shares were computed, by this motion or another motion on the same
    /// mesh.
    looks: Cell<u64>,
    /// Memory of shares and crossings, in bytes.
    bytes: Cell<usize>,
}

/// Load sharing of coupled pairs in given zones.
#[derive(Debug)]
struct Sharing {
    flank: Flank,
    zones: Vec<usize>,
    known: RefCell<Vec<(Meeting, Arc<Shares>)>>,
}

/// The values that are constant between two borders: the pairs that may touch, and their zones.
#[derive(Debug, Clone)]
pub(super) struct Window {
    /// First and last place of the incoming pair, in m.
    pub(super) ends: (f64, f64),
    /// The pairs of the working flanks, then those of the back flanks.
    pub(super) pairs: Vec<Standing>,
    /// Number of working pairs.
    working: usize,
    /// Load sharing of both sides. `None` if the pairs are independent springs.
    sharing: [Option<Rc<Sharing>>; 2],
    /// Cached stiffness and load of this window.
    pub(super) crossing: Rc<Crossing>,
}

impl<'a> Motion<'a> {
    pub(super) fn new(mesh: &'a Mesh, settings: &Settings) -> Motion<'a> {
        let frequency = (mesh.mean_stiffness() / settings.mass).sqrt();
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

    /// The motion with the back flanks.
    pub(super) fn with_back(self) -> Motion<'a> {
        Motion { back: Some(self.mesh.back()), ..self }
    }

    /// Whether the case gives a backlash.
    pub(super) fn has_backlash(&self) -> bool {
        self.backlash.is_finite()
    }

    /// Whether a displacement of the driver reaches back flanks that the motion does not include.
    pub(super) fn misses_back(&self, ahead: f64) -> bool {
        self.back.is_none() && ahead < -self.backlash
    }

    /// Places of the incoming pair from `from` to `to`. Between two of them all values of the pairs
    /// are smooth.
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

    /// Place of the incoming pair at the start. If damping removes the effect of the start within
    /// one base pitch, limits the warm-up to two base pitches.
    pub(super) fn start(&self) -> f64 {
        const FORGOTTEN: f64 = 42.0;
        let pitch = self.mesh.base_pitch;
        let forgets_a_pitch = self.decay * pitch / self.mesh.speed > FORGOTTEN;
        let pitches = if forgets_a_pitch { self.warmup_cycles.min(2) } else { self.warmup_cycles };
        -f64::from(pitches) * pitch
    }

    /// Time with the incoming pair at `s`; 0 at E.
    pub(super) fn time(&self, s: f64) -> f64 {
        s / self.mesh.speed
    }

    /// Place of the incoming pair at a time.
    pub(super) fn place(&self, t: f64) -> f64 {
        t * self.mesh.speed
    }

    /// Half a period with the mean stiffness, in s.
    pub(super) fn half_swing(&self) -> f64 {
        0.5 * TAU / self.frequency
    }

    /// A step length at which no series converges, in s.
    pub(super) fn longest_step(&self) -> f64 {
        8.0 / self.frequency
    }

    /// Scale of a state: the static deflection, and the rate of an oscillation with this amplitude.
    pub(super) fn scale(&self) -> State {
        let deflection = self.mesh.force / self.mesh.mean_stiffness();
        State::new(deflection, deflection * self.frequency)
    }

    /// Refuses a motion with too many oscillations.
    pub(super) fn check_pace(&self, way: f64) -> Result<(), Refusal> {
        let swings = self.time(way) * self.frequency / TAU;
        if swings > MOTION_OSCILLATIONS {
            Err(Refusal::TooSlow { swings, limit: MOTION_OSCILLATIONS })
        } else {
            Ok(())
        }
    }

    /// The constant values while the incoming pair moves between two places.
    ///
    /// # Errors
    /// [`Refusal::TooManyPairs`] if both sides have more pairs than a set can contain.
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
            return Err(Refusal::TooManyPairs { pairs: pairs.len(), limit: PAIRS });
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

    /// The pairs of the working flanks for a set of touching pairs.
    pub(super) fn working_side<'w>(&'w self, window: &'w Window, touching: Touching) -> Side<'w> {
        let touching = touching.before(window.working);
        Side {
            mesh: self.mesh,
            pairs: &window.pairs[..window.working],
            touching,
            shares: self.shares(
                self.mesh,
                window.sharing[0].as_ref(),
                (touching, window.incoming()),
            ),
            offset: 0.0,
            backlash: 0.0,
            sign: 1.0,
        }
    }

    /// The pairs of the back flanks, if the motion includes them.
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
            shares: self.shares(mesh, window.sharing[1].as_ref(), (touching, None)),
            offset: self.mesh.back_place(),
            backlash: self.backlash,
            sign: -1.0,
        })
    }

    /// The load sharing of pairs in these zones, which repeats after a base pitch. `None` if the
    /// pairs are independent springs.
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
        let sharing =
            Rc::new(Sharing { flank, zones: zones().collect(), known: RefCell::default() });
        all.push(Rc::clone(&sharing));
        Some(sharing)
    }

    /// The load sharing of coupled pairs. `None` if no pair touches or all are independent springs.
    fn shares(
        &self,
        mesh: &Mesh,
        sharing: Option<&Rc<Sharing>>,
        (touching, incoming): (Touching, Option<usize>),
    ) -> Option<Arc<Shares>> {
        let sharing = sharing.filter(|_| !touching.is_none())?;
        let deviating = incoming.filter(|&pair| touching.has(pair) && mesh.error != 0.0);
        let mut known = sharing.known.borrow_mut();
        let is_same = |known: &Meeting| (known.touching, known.deviating) == (touching, deviating);
        if let Some((_, shares)) = known.iter().find(|(known, _)| is_same(known)) {
            return Some(Arc::clone(shares));
        }
        let meeting = Meeting { zones: sharing.zones.clone(), touching, deviating };
        let shares = mesh.shares(&meeting);
        self.looks.set(self.looks.get() + shares.evaluations() as u64);
        self.keep(shares.bytes());
        known.push((meeting, Arc::clone(&shares)));
        Some(shares)
    }

    /// Counts memory besides the steps, in bytes.
    pub(super) fn keep(&self, bytes: usize) {
        self.bytes.set(self.bytes.get() + bytes);
    }

    /// Number of places where shares were computed since the last call.
    pub(super) fn take_looks(&self) -> u64 {
        self.looks.take()
    }

    /// Memory of shares and crossings, in bytes.
    pub(super) fn bytes(&self) -> usize {
        self.bytes.get()
    }
}

/// The pairs that may touch with the incoming pair at a place, in m.
fn standing(mesh: &Mesh, flank: Flank, inside: f64) -> Vec<Standing> {
    let standing = mesh.standing(inside).map(|(ahead, zone)| {
        let (_, sliding) = mesh.slide(ahead, zone, inside);
        Standing { flank, ahead, zone, direction: sliding.signum() }
    });
    standing.collect()
}

impl Window {
    /// The named pairs as a set. `None` if a pair is no longer in the window.
    pub(super) fn touching(&self, names: &[PairName]) -> Option<Touching> {
        names.iter().try_fold(Touching::NONE, |set, &name| Some(set.with(self.index_of(name)?)))
    }

    /// The names of the touching pairs.
    pub(super) fn names(&self, touching: Touching) -> Vec<PairName> {
        let pairs = touching.pairs().filter_map(|pair| self.pairs.get(pair));
        pairs.map(Standing::name).collect()
    }

    /// The index of the incoming pair in the window.
    pub(super) fn incoming(&self) -> Option<usize> {
        self.index_of(PairName::working(0))
    }

    /// The touching pairs of the working flanks.
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

/// Places within this distance, relative to the base pitch, are equal.
pub(super) const ALIKE: f64 = 1e-9;

/// Stiffness and load over a stretch, as polynomials of the part of the stretch.
#[derive(Debug)]
pub(super) struct Acting {
    /// Stiffness of the touching pairs, in N/m.
    pub(super) stiffness: Polynomial<TERMS>,
    /// The load and the forces from the gaps, in N.
    pub(super) load: Polynomial<TERMS>,
}

/// Stiffness and load between two borders of the mesh, cached because they repeat after a base
/// pitch.
#[derive(Debug)]
pub(super) struct Crossing {
    /// The number of working pairs, then the zones of all pairs.
    zones: Vec<usize>,
    /// Index of the incoming pair, the only pair with a deviation.
    incoming: Option<usize>,
    known: RefCell<Vec<Known>>,
}

#[derive(Debug)]
struct Known {
    stretch: Stretch,
    acting: Rc<Acting>,
}

/// A part of the motion with the same touching pairs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) touching: Touching,
    /// Place of the rearmost pair at the beginning, in m.
    pub(super) from: f64,
    /// Its length, in m.
    pub(super) way: f64,
}

impl Crossing {
    /// Stiffness and load of a stretch. Calls `new` if they are not cached.
    pub(super) fn acting(
        &self,
        stretch: Stretch,
        mesh: &Mesh,
        new: impl FnOnce() -> Acting,
    ) -> Rc<Acting> {
        let is_near = |one: f64, other: f64| (one - other).abs() <= ALIKE * mesh.base_pitch;
        let is_alike = |known: &&Known| {
            let other = known.stretch;
            other.touching == stretch.touching
                && is_near(other.from, stretch.from)
                && is_near(other.way, stretch.way)
        };
        let mut all = self.known.borrow_mut();
        if let Some(known) = all.iter().find(is_alike) {
            return Rc::clone(&known.acting);
        }
        let acting = Rc::new(new());
        all.push(Known { stretch, acting: Rc::clone(&acting) });
        acting
    }
}

/// The cached crossings of a motion.
#[derive(Debug, Default)]
pub(super) struct Crossings(RefCell<Vec<Rc<Crossing>>>);

impl Crossings {
    /// The crossing of pairs in these zones; `incoming` is the incoming pair among them.
    pub(super) fn of(
        &self,
        zones: impl Iterator<Item = usize> + Clone,
        incoming: Option<usize>,
    ) -> Rc<Crossing> {
        let mut all = self.0.borrow_mut();
        let is_alike = |known: &&Rc<Crossing>| {
            known.incoming == incoming && known.zones.iter().copied().eq(zones.clone())
        };
        if let Some(crossing) = all.iter().find(is_alike) {
            return Rc::clone(crossing);
        }
        let crossing =
            Rc::new(Crossing { zones: zones.collect(), incoming, known: RefCell::default() });
        all.push(Rc::clone(&crossing));
        crossing
    }
}
