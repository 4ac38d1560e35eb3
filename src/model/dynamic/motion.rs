//! The equation of motion between two borders of the mesh, and its steps by power series.

use super::Settings;
use super::side::{FORCE_TERMS, Flank, Lead, PairName, Side, Standing, TERMS};
use crate::model::Refusal;
use crate::model::budget::{MOTION_OSCILLATIONS, PAIRS};
use crate::model::mesh::{Meeting, Mesh, Shares};
use crate::model::pair_forces::Touching;
use crate::numeric::distinct;
use crate::numeric::polynomial::{Bernstein, Polynomial};
use crate::numeric::taylor::{Oscillator, convergent_part};
use nalgebra::Vector2;
use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;
use std::rc::Rc;
use std::sync::Arc;

/// Displacement of the driver ahead in m, and its rate in m/s.
pub(in crate::model) type State = Vector2<f64>;

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
    /// Cached values of each window.
    crossings: RefCell<Vec<Rc<Crossing>>>,
    /// The shares that this motion has used.
    used: RefCell<Vec<Arc<Shares>>>,
    /// Number of places where shares were computed, by this motion or another motion on the same
    /// mesh.
    looks: Cell<u64>,
    /// Memory of shares and crossings, in bytes.
    bytes: Cell<usize>,
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
    /// Cached values of this window.
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
            crossings: RefCell::default(),
            used: RefCell::default(),
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
        let Some(back) = &self.back else { return borders };
        let (offset, same) = (self.mesh.back_place(), 1e-12 * self.mesh.base_pitch);
        let places = back.borders(from + offset, to + offset);
        let places = places.into_iter().map(|place| place - offset);
        borders.extend(places.filter(|place| *place > from + same && *place < to - same));
        distinct(borders, same)
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
        if let Some(back) = &self.back {
            pairs.extend(standing(back, Flank::Back, inside + self.mesh.back_place()));
        }
        if pairs.len() > PAIRS {
            return Err(Refusal::TooManyPairs { pairs: pairs.len(), limit: PAIRS });
        }
        // The number of working pairs, then the zones of the working pairs and of the back pairs.
        let zones = pairs.iter().map(|pair| pair.zone);
        let zones = std::iter::once(working).chain(zones);
        let is_incoming = |pair: &Standing| pair.name() == PairName::working(0);
        let incoming = pairs.iter().position(is_incoming);
        let crossing = self.crossing(zones, incoming);
        Ok(Window { ends: (from, to), crossing, pairs, working })
    }

    /// The cached values of pairs in these zones, which repeat after a base pitch; `incoming` is the
    /// incoming pair among them.
    fn crossing(
        &self,
        zones: impl Iterator<Item = usize> + Clone,
        incoming: Option<usize>,
    ) -> Rc<Crossing> {
        let mut all = self.crossings.borrow_mut();
        let is_alike = |known: &&Rc<Crossing>| {
            known.incoming == incoming && known.zones.iter().copied().eq(zones.clone())
        };
        if let Some(crossing) = all.iter().find(is_alike) {
            return Rc::clone(crossing);
        }
        let (actings, shares) = Default::default();
        let crossing = Rc::new(Crossing { zones: zones.collect(), incoming, actings, shares });
        all.push(Rc::clone(&crossing));
        crossing
    }

    /// The pairs of the working flanks for a set of touching pairs.
    pub(super) fn working_side<'w>(&'w self, window: &'w Window, touching: Touching) -> Side<'w> {
        let touching = touching.before(window.working);
        Side {
            mesh: self.mesh,
            pairs: &window.pairs[..window.working],
            touching,
            shares: self.shares(self.mesh, window, Flank::Working, touching),
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
            shares: self.shares(mesh, window, Flank::Back, touching),
            offset: self.mesh.back_place(),
            backlash: self.backlash,
            sign: -1.0,
        })
    }

    /// The load sharing of the coupled pairs of a side. `None` if no pair touches or all are
    /// independent springs.
    fn shares(
        &self,
        mesh: &Mesh,
        window: &Window,
        flank: Flank,
        touching: Touching,
    ) -> Option<Arc<Shares>> {
        if touching.is_none() || !mesh.is_coupled() {
            return None;
        }
        let incoming = window.incoming().filter(|_| flank == Flank::Working && mesh.error != 0.0);
        let key = (flank, touching, incoming.filter(|&pair| touching.has(pair)));
        let mut known = window.crossing.shares.borrow_mut();
        if let Some((_, shares)) = known.iter().find(|(known, _)| *known == key) {
            return Some(Arc::clone(shares));
        }
        let pairs = window.pairs.iter().filter(|pair| pair.flank == flank);
        let zones = pairs.map(|pair| pair.zone).collect();
        let shares = mesh.shares(&Meeting { zones, touching, deviating: key.2 });
        let mut used = self.used.borrow_mut();
        if !used.iter().any(|used| Arc::ptr_eq(used, &shares)) {
            self.looks.set(self.looks.get() + shares.evaluations() as u64);
            self.keep(shares.bytes());
            used.push(Arc::clone(&shares));
        }
        known.push((key, Arc::clone(&shares)));
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
        let direction = mesh.direction(ahead, zone, inside);
        Standing { flank, ahead, zone, direction }
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

/// Values between two borders of the mesh, cached because they repeat after a base pitch.
#[derive(Debug)]
pub(super) struct Crossing {
    /// The number of working pairs, then the zones of all pairs.
    zones: Vec<usize>,
    /// Index of the incoming pair, the only pair with a deviation.
    incoming: Option<usize>,
    /// Stiffness and load of each stretch.
    actings: RefCell<Vec<(Stretch, Rc<Acting>)>>,
    /// Load sharing of a side by its touching pairs and the one of them that deviates.
    shares: RefCell<Vec<(SharesKey, Arc<Shares>)>>,
}

/// The side, its touching pairs and the one of them that deviates.
type SharesKey = (Flank, Touching, Option<usize>);

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
        let is_alike = |(known, _): &&(Stretch, Rc<Acting>)| {
            known.touching == stretch.touching
                && is_near(known.from, stretch.from)
                && is_near(known.way, stretch.way)
        };
        let mut all = self.actings.borrow_mut();
        if let Some((_, acting)) = all.iter().find(is_alike) {
            return Rc::clone(acting);
        }
        let acting = Rc::new(new());
        all.push((stretch, Rc::clone(&acting)));
        acting
    }
}

/// Stiffness and load for a set of touching pairs.
#[derive(Clone)]
pub(super) struct Course<'a> {
    pub(super) motion: &'a Motion<'a>,
    pub(super) window: &'a Window,
    touching: Touching,
    working: Side<'a>,
    /// `None` if no back flank is within reach.
    back: Option<Side<'a>>,
}

/// A computed step.
pub(super) struct StepResult {
    pub(super) step: Step,
    /// Whether the step ends where a pair passes to another polynomial. A step of the next base
    /// pitch ends at the same place.
    pub(super) ends_even: bool,
}

/// A step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    /// Start time, in s.
    pub(super) t: f64,
    /// Duration, in s.
    pub(super) length: f64,
    /// Displacement of the driver as a function of the part of the step, in m.
    pub(super) ahead: Polynomial<TERMS>,
}

impl Step {
    /// Displacement and rate after a part of the step.
    pub(super) fn state(&self, part: f64) -> State {
        State::new(self.ahead.at(part), self.ahead.slope(part) / self.length)
    }

    /// Bounds of the displacement, in m.
    pub(super) fn range(&self) -> (f64, f64) {
        Bernstein::of(&self.ahead).bounds()
    }

    /// End time, in s.
    pub(super) fn end(&self) -> f64 {
        self.t + self.length
    }

    /// The first part of the step, as a step.
    pub(super) fn cut(&self, part: f64) -> Step {
        Step { length: part * self.length, ahead: self.ahead.stretched(part), ..*self }
    }
}

impl<'a> Course<'a> {
    pub(super) fn new(
        motion: &'a Motion<'a>,
        window: &'a Window,
        touching: Touching,
    ) -> Course<'a> {
        Course {
            motion,
            window,
            touching,
            working: motion.working_side(window, touching),
            back: motion.back_side(window, touching),
        }
    }

    /// Number of pairs that may touch.
    pub(super) fn pairs(&self) -> usize {
        self.window.pairs.len()
    }

    pub(super) fn touches(&self, pair: usize) -> bool {
        self.touching.has(pair)
    }

    /// The step from a state on: as long as its series converges, at most to `end`, and on one
    /// polynomial of every pair. The last terms of the series are at most `allowed`, in m. A step
    /// that `begins_even` can use the cache of the last base pitch.
    ///
    /// # Errors
    /// [`Refusal::NotConverged`] if the series is not finite.
    pub(super) fn step(
        &self,
        t: f64,
        y: &State,
        end: f64,
        (allowed, begins_even): (f64, bool),
    ) -> Result<StepResult, Refusal> {
        let whole = self.serves_until(t).min(end) - t;
        let length = whole.min(self.motion.longest_step());
        let acting = if begins_even {
            self.known_acting(t, length)
        } else {
            Rc::new(self.acting(t, length))
        };
        let oscillator = self.oscillator(&acting, length);
        let ahead = oscillator.series(y[0], y[1] * length);
        let step = Step { t, length, ahead };
        let part = convergent_part(&ahead, allowed);
        if part >= 1.0 {
            return Ok(StepResult { step, ends_even: length >= whole });
        }
        // Divides the rest into steps of equal length, so that the last step is not very short.
        let part = if length < whole { part } else { 1.0 / (1.0 / part).ceil() };
        if part * length <= 0.0 || !part.is_finite() {
            return Err(Refusal::NotConverged);
        }
        Ok(StepResult { step: step.cut(part), ends_even: false })
    }

    /// The time up to which every function of the pairs is one polynomial.
    fn serves_until(&self, t: f64) -> f64 {
        let s = self.motion.place(t);
        let ends = self.sides().map(|side| side.serves_until(s));
        self.motion.time(ends.fold(f64::INFINITY, f64::min))
    }

    /// Stiffness and load over a time interval, from the cache of the last base pitch if possible.
    fn known_acting(&self, t: f64, length: f64) -> Rc<Acting> {
        let mesh = self.motion.mesh;
        let stretch = Stretch {
            touching: self.touching,
            from: mesh.above(self.working.rearmost(), self.motion.place(t)).0,
            way: mesh.speed * length,
        };
        self.window.crossing.acting(stretch, mesh, || {
            self.motion.keep(size_of::<Acting>());
            self.acting(t, length)
        })
    }

    /// Stiffness and load over a time interval.
    fn acting(&self, t: f64, length: f64) -> Acting {
        let mut acting = Acting { stiffness: Polynomial::ZERO, load: Polynomial::ZERO };
        acting.load.0[0] = self.motion.mesh.force;
        let way = (self.motion.place(t), self.motion.mesh.speed * length);
        for side in self.sides() {
            side.add(way, (&mut acting.stiffness, &mut acting.load));
        }
        acting
    }

    /// The equation of motion over a time interval, scaled to the length 1.
    fn oscillator(&self, acting: &Acting, length: f64) -> Oscillator<TERMS> {
        let Motion { mass, damping, .. } = *self.motion;
        let damping = if self.touching.is_none() { 0.0 } else { damping * length / mass };
        let scale = length * length / mass;
        Oscillator {
            stiffness: acting.stiffness.scaled(scale),
            load: acting.load.scaled(scale),
            damping,
        }
    }

    /// The touching pairs of the back flanks.
    pub(super) fn back_pairs(&self) -> impl Iterator<Item = usize> {
        self.window.back(self.touching)
    }

    fn sides(&self) -> impl Iterator<Item = &Side<'a>> {
        std::iter::once(&self.working).chain(&self.back)
    }

    /// The side of a pair, and the index of the pair on this side.
    pub(super) fn side_of(&self, pair: usize) -> (&Side<'a>, usize) {
        let working = self.working.pairs.len();
        match &self.back {
            Some(back) if pair >= working => (back, pair - working),
            _ => (&self.working, pair),
        }
    }

    /// Place of the incoming pair at the beginning of a step, and its path in the step, in m.
    pub(super) fn way_of(&self, step: &Step) -> (f64, f64) {
        let speed = self.motion.mesh.speed;
        (self.motion.place(step.t), speed * step.length)
    }

    /// Whether a pair does not turn in a step wherever in its range the displacement is.
    pub(super) fn is_clear(&self, pair: usize, step: &Step, range: (f64, f64)) -> bool {
        let (side, index) = self.side_of(pair);
        side.is_clear(index, self.motion.place(step.t), range)
    }

    /// The lead of a pair over a step.
    pub(super) fn lead_along(&self, pair: usize, step: &Step) -> Lead {
        let (side, index) = self.side_of(pair);
        let (s, way) = self.way_of(step);
        side.lead_along(index, s, way)
    }

    /// Force of a touching pair over a step, in N.
    pub(super) fn force_along(&self, pair: usize, step: &Step) -> Polynomial<FORCE_TERMS> {
        let (side, index) = self.side_of(pair);
        side.force_along(index, &step.ahead, self.way_of(step))
    }

    /// Friction power of a touching pair over a step, divided by the friction coefficient, in W.
    pub(super) fn rubbing_along(&self, pair: usize, step: &Step) -> f64 {
        let (side, index) = self.side_of(pair);
        side.rubbing_along(index, &step.ahead, self.way_of(step))
    }

    /// Displacement of the driver at which a pair touches, in m.
    pub(super) fn gap(&self, pair: usize, t: f64) -> f64 {
        let (side, index) = self.side_of(pair);
        side.gap(index, self.motion.place(t))
    }

    /// Force of a touching pair for a displacement of the driver, in N.
    pub(super) fn force(&self, pair: usize, t: f64, ahead: f64) -> f64 {
        let (side, index) = self.side_of(pair);
        side.force(index, self.motion.place(t), ahead)
    }

    /// Sum of the forces of all working flanks, in N.
    pub(super) fn total(&self, t: f64, ahead: f64) -> f64 {
        self.working.total(self.motion.place(t), ahead)
    }
}

/// A gain or loss of contact of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Event {
    /// The pair's index in the window.
    pub(super) pair: usize,
    /// The part of the step before the event.
    pub(super) part: f64,
}

/// The first event of a step. The lead of a pair is a polynomial over the step, so that no event is
/// missed. Pairs in `turned` begin the step with a lead of 0 within rounding; several of them can
/// change together. The pair `standing_off` has no events.
pub(super) fn first_event(
    course: &Course<'_>,
    (step, range): (&Step, (f64, f64)),
    (turned, standing_off): (Touching, Option<usize>),
) -> Option<Event> {
    let may_turn = (0..course.pairs()).filter(|&pair| Some(pair) != standing_off);
    let events = may_turn.filter_map(|pair| {
        if course.is_clear(pair, step, range) {
            return None;
        }
        let (lead, touches) = (course.lead_along(pair, step), course.touches(pair));
        if lead.is_clear(touches, range) {
            return None;
        }
        let sign = if touches { 1.0 } else { -1.0 };
        let part = lead.first_fall(&step.ahead, sign, turned.has(pair))?;
        Some(Event { pair, part })
    });
    events.min_by(|one, other| one.part.total_cmp(&other.part))
}
