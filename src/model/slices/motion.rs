//! The motion of a pair over its face width: displacement of the driver with inertia and damping,
//! against the balance of the slices.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::rc::Rc;
use std::sync::Arc;

use super::Face;
use super::balance::{Incoming, PRECISE, Position, Until};
use super::course::{Course, Moment};
use super::load::{FaceLoad, PRECISION, Passage, Passed};
use super::loads::Loads;
use crate::model::Refusal;
use crate::model::dynamic::steady::{Start, Steady, periodic};
use crate::model::dynamic::{Approach, Dynamic, Settings, State};
use crate::model::static_load::Fourier;
use crate::numeric::root::greatest_within;

/// Steps of a motion times slices: some ten seconds of computation.
const MOST_WORK: f64 = 8e6;

/// Smaller errors of the balances and of the peaks are lost among those of the usual number of slices.
const OF_SLICES: f64 = 1e-4;

/// The harmonics of a motion at resonance are more sensitive than its peaks.
const OF_HARMONICS: f64 = 4e-5;

/// The force of the mesh at even places of a base pitch, for any displacement. What is known of a place
/// serves again, since a motion returns to it in every base pitch.
pub(in crate::model) struct Springs<'a> {
    face: &'a Face,
    /// The parts of a base pitch between borders of the mesh, with their number of steps.
    parts: Vec<(f64, f64, u32)>,
    /// The known points of the force over the displacement.
    points: RefCell<HashMap<Place, Vec<Point>>>,
    /// The pairs without deviations at the places.
    positions: RefCell<HashMap<u64, Rc<Position<'a>>>>,
    /// The loads computed last, whose slices are likely to touch again.
    near: RefCell<Option<Rc<Loads>>>,
    /// Precision of the balances.
    precision: f64,
    /// How far a smooth force is known about a point, in m.
    reach: f64,
    /// Change of the stiffness that smaller steps resolve.
    sudden: f64,
    solves: Cell<u64>,
}

/// The bits of a place, and the pair that deviates.
type Place = (u64, Option<i32>);

/// The force at a displacement, and how far it is known about it.
#[derive(Debug, Clone, Copy)]
struct Point {
    displacement: f64,
    force: f64,
    stiffness: f64,
    bend: f64,
    reach: f64,
}

impl<'a> Springs<'a> {
    /// The places for steady motions at this speed along the line of action and above.
    pub(in crate::model) fn new(face: &'a Face, settings: &Settings, speed: f64) -> Springs<'a> {
        Springs::within(OF_HARMONICS, face, settings, speed)
    }

    /// The places for motions whose steps need no smaller errors than `least`, with the usual slices.
    fn within(least: f64, face: &'a Face, settings: &Settings, speed: f64) -> Springs<'a> {
        /// Greatest stiffness over the mean.
        const STIFFER: f64 = 1.5;
        /// Steps in a base pitch and ωh of a step with the tolerance of slices: measured, the peak force
        /// then meets the tolerance with a margin, and the harmonics within a tenth of it. The greatest ωh.
        const STEPS: f64 = 64.0;
        const TURN: f64 = 0.376;
        const MOST_TURN: f64 = 0.5;
        /// Deflection over the greatest relief below which the steps are not finer still.
        const LEAST_LOAD: f64 = 1.0 / 256.0;
        /// Errors of steps of slices that are almost alike, over the tolerance: the sum averages none of them.
        const ALIKE: f64 = 0.1;
        /// A change of the stiffness between steps over the root of the tolerance, and the greatest.
        const SUDDEN: f64 = 25.0;
        const MOST_SUDDEN: f64 = 0.1;
        let mesh = &face.mesh;
        let frequency = (STIFFER * mesh.mean_stiffness() / settings.mass).sqrt();
        // Slices that differ little make little errors.
        let widest_gap = face.slices.iter().map(|slice| slice.gap).fold(0.0, f64::max);
        let differences = 2.0 * face.reach / mesh.base_pitch
            + (widest_gap - face.least_gap) * mesh.mean_stiffness() / mesh.force;
        let of_slices = if face.inputs.slices.is_none() { differences } else { 0.0 };
        let of_tolerance = settings.tolerance * if of_slices > 0.0 { ALIKE } else { 1.0 };
        let tolerance = settings.tolerance.max(of_slices.min(OF_SLICES));
        let of_steps = of_tolerance.max(of_slices.min(least));
        // The error of a step is of fourth order, and grows with the relief that moves the pair.
        let relief =
            [0.0, mesh.length].map(|s| mesh.incoming(s).0.gap).into_iter().fold(0.0, f64::max);
        let deflection = mesh.force / mesh.mean_stiffness();
        let load = (deflection / relief.max(deflection)).max(LEAST_LOAD);
        let length = (of_steps / OF_SLICES * load).powf(0.25);
        let turn = (TURN * length).min(MOST_TURN);
        let step = (turn / frequency * speed).min(mesh.base_pitch / STEPS * length.min(1.0));
        let borders = mesh.borders(0.0, mesh.base_pitch);
        let part = |ends: &[f64]| {
            let steps = ((ends[1] - ends[0]) / step - 1e-9).ceil().max(1.0);
            (ends[0], ends[1], steps as u32)
        };
        Springs {
            face,
            parts: borders.windows(2).map(part).collect(),
            points: RefCell::default(),
            positions: RefCell::default(),
            near: RefCell::default(),
            precision: (0.01 * tolerance).max(PRECISE),
            // The stiffness changes by less than itself over the deflection.
            reach: (2.0 * tolerance).sqrt() * mesh.force / mesh.mean_stiffness(),
            sudden: (SUDDEN * of_steps.sqrt()).min(MOST_SUDDEN),
            solves: Cell::default(),
        }
    }

    /// The pairs without deviations at a place.
    fn position(&self, place: f64) -> Rc<Position<'a>> {
        /// Bounds the memory to some ten MB: pairs at slices in all positions.
        const MOST: usize = 400_000;
        let mut positions = self.positions.borrow_mut();
        if positions.values().next().is_some_and(|one| positions.len() * one.size() > MOST) {
            positions.clear();
        }
        let position = || Rc::new(self.face.position(place));
        Rc::clone(positions.entry(place.to_bits()).or_insert_with(position))
    }

    /// Force and stiffness of the mesh with the incoming pair `pitches` base pitches after the place.
    fn force(
        &self,
        place: f64,
        (pitches, incoming): (i32, Incoming),
        displacement: f64,
    ) -> Result<[f64; 2], Refusal> {
        /// Bounds the memory of slow motions of few slices to some ten MB.
        const MOST: usize = 100_000;
        let (mesh, mut points) = (&self.face.mesh, self.points.borrow_mut());
        if points.len() >= MOST {
            points.clear();
        }
        let path = place + f64::from(pitches) * mesh.base_pitch;
        let (from, to) = (mesh.ends().0 - self.face.reach, mesh.ends().1 + self.face.reach);
        let deviates = incoming != Incoming::Alike && path >= from && path <= to;
        let deviating = deviates.then_some(pitches);
        let known = points.entry((place.to_bits(), deviating)).or_default();
        let is_known = |point: &&Point| (displacement - point.displacement).abs() <= point.reach;
        if let Some(point) = known.iter().rev().find(is_known) {
            let way = displacement - point.displacement;
            let force = point.force + (point.stiffness + 0.5 * point.bend * way) * way;
            return Ok([force, point.stiffness + point.bend * way]);
        }
        self.solves.set(self.solves.get() + 1);
        let mut position = self.position(place);
        if deviates {
            incoming.change(Rc::make_mut(&mut position), pitches);
        }
        let mut near = self.near.borrow_mut();
        let loads =
            position.loads(Until::Displacement(displacement), near.as_slice(), self.precision)?;
        let Loads { force, stiffness, bend, smooth, .. } = loads;
        *near = Some(Rc::new(loads));
        known.push(Point { displacement, force, stiffness, bend, reach: smooth.min(self.reach) });
        Ok([force, stiffness])
    }
}

/// The equation of motion.
struct Motion<'a, 'b> {
    springs: &'a Springs<'b>,
    /// Speed along the line of action, in m/s.
    speed: f64,
    mass: f64,
    damping: f64,
    frequency: f64,
    backlash: f64,
    incoming: Incoming,
}

impl<'a, 'b> Motion<'a, 'b> {
    fn new(springs: &'a Springs<'b>, settings: &Settings, speed: f64, incoming: Incoming) -> Self {
        let frequency = (springs.face.mesh.mean_stiffness() / settings.mass).sqrt();
        Motion {
            springs,
            speed,
            mass: settings.mass,
            damping: 2.0 * settings.damping_ratio * settings.mass * frequency,
            frequency,
            backlash: settings.backlash.unwrap_or(f64::INFINITY),
            incoming,
        }
    }

    /// Usual size of displacement and rate.
    fn scale(&self) -> State {
        let mesh = &self.springs.face.mesh;
        let deflection = mesh.force / mesh.mean_stiffness();
        State::new(deflection, deflection * self.frequency)
    }

    /// Refuses a motion with too many oscillations for the number of slices.
    fn check_pace(&self, path: f64) -> Result<(), Refusal> {
        let face = self.springs.face;
        let swings = path / self.speed * self.frequency / TAU;
        let steps = self.springs.parts.iter().map(|(_, _, steps)| f64::from(*steps)).sum::<f64>();
        let work = steps * path / face.mesh.base_pitch * face.slices.len() as f64;
        if work > MOST_WORK {
            return Err(Refusal::TooSlow { swings, limit: swings * MOST_WORK / work });
        }
        Ok(())
    }

    /// The rates of displacement and rate, and the stiffness.
    fn rates(&self, place: f64, pitches: i32, state: State) -> Result<(State, [f64; 2]), Refusal> {
        let of = self.springs.force(place, (pitches, self.incoming), state[0])?;
        let damping = if of[1] > 0.0 { self.damping } else { 0.0 };
        let rest = self.springs.face.mesh.force - of[0] - damping * state[1];
        Ok((State::new(state[1], rest / self.mass), of))
    }

    /// The state at the end of a base pitch that begins with this state. `show` receives every moment.
    fn pitch(
        &self,
        pitches: i32,
        mut state: State,
        show: &mut dyn FnMut(Moment),
    ) -> Result<State, Refusal> {
        for &(from, to, steps) in &self.springs.parts {
            let place = |step: u32| from + (to - from) * f64::from(step) / f64::from(steps);
            for step in 0..steps {
                let ends = (place(step), place(step + 1));
                state = self.step(pitches, (from, to), ends, (state, 0), show)?;
            }
        }
        if state[0] < -self.backlash {
            return Err(Refusal::BackFlanksOverFace);
        }
        Ok(state)
    }

    /// A step of fourth order; smaller steps where pairs gain or lose contact.
    ///
    /// # Source
    /// The classical method of Runge and Kutta: Hairer, Nørsett & Wanner 1993, "Solving Ordinary
    /// Differential Equations I", table II.1.2.
    fn step(
        &self,
        pitches: i32,
        part: (f64, f64),
        (from, to): (f64, f64),
        (state, halvings): (State, u32),
        show: &mut dyn FnMut(Moment),
    ) -> Result<State, Refusal> {
        /// Of the smallest step.
        const HALVINGS: u32 = 16;
        /// The mesh jumps at a border. Of the length of the part.
        const INSIDE: f64 = 1e-9;
        let aside = INSIDE * (part.1 - part.0);
        let inside = |place: f64| place.clamp(part.0 + aside, part.1 - aside);
        let middle = f64::midpoint(from, to);
        let time = (to - from) / self.speed;
        let (first, before) = self.rates(inside(from), pitches, state)?;
        let (second, _) = self.rates(middle, pitches, state + first * (0.5 * time))?;
        let (third, _) = self.rates(middle, pitches, state + second * (0.5 * time))?;
        let (fourth, _) = self.rates(inside(to), pitches, state + third * time)?;
        let next = state + (first + (second + third) * 2.0 + fourth) * (time / 6.0);
        let (_, after) = self.rates(inside(to), pitches, next)?;
        let change = (after[1] - before[1]).abs();
        if change > self.springs.sudden * before[1].max(after[1]) && halvings < HALVINGS {
            let half = (state, halvings + 1);
            let state = self.step(pitches, part, (from, middle), half, show)?;
            return self.step(pitches, part, (middle, to), (state, halvings + 1), show);
        }
        let s = f64::from(pitches) * self.springs.face.mesh.base_pitch + to;
        show(Moment { s, state: next, touches: after[1] > 0.0 });
        Ok(next)
    }

    /// The static balance at the beginning of a base pitch.
    fn at_rest(&self, pitches: i32) -> Result<State, Refusal> {
        let face = self.springs.face;
        let mut position = face.position(0.0);
        self.incoming.change(&mut position, pitches);
        let loads = position.loads(Until::Force(face.mesh.force), &[], PRECISE)?;
        if loads.displacement.is_finite() {
            return Ok(State::new(loads.displacement, 0.0));
        }
        Err(Refusal::BeyondReach)
    }

    /// The motion of the passage of the incoming tooth, from static balance `warmup` base pitches before
    /// the first slice comes to E. The rest of a warm-up that repeats is skipped.
    fn passage(
        &self,
        settings: &Settings,
        until: f64,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<Course, Refusal> {
        /// A change of the state that counts as none: rounding, and while it falls by half in every
        /// base pitch, a part of the tolerance.
        const ROUNDING: f64 = 1e-14;
        const PART: f64 = 1e-3;
        let (face, pitch) = (self.springs.face, self.springs.face.mesh.base_pitch);
        let first = -settings.warmup_cycles.cast_signed() - (face.reach / pitch).round() as i32;
        // The last base pitch without the incoming pair, and one more for a loss of contact.
        let near = (face.mesh.ends().0.min(-pitch) - face.reach) / pitch;
        let near = near.floor() as i32;
        let last = (until / pitch).ceil() as i32;
        self.check_pace(f64::from(last - first.max(near - 2)) * pitch)?;
        let mut state = self.at_rest(first)?;
        let start = Moment { s: f64::from(first) * pitch, state, touches: true };
        let mut moments = vec![start];
        let (mut pitches, mut moved) = (first, f64::INFINITY);
        while pitches < last {
            if !go_on(f64::from(pitches - first) / f64::from(last - first)) {
                return Err(Refusal::Stopped);
            }
            let before = state;
            state = self.pitch(pitches, state, &mut |moment| moments.push(moment))?;
            pitches += 1;
            let change = (state - before).component_div(&self.scale()).amax();
            let allowed = if change <= 0.5 * moved { PART * settings.tolerance } else { ROUNDING };
            moved = change;
            if pitches < near && change <= allowed.max(ROUNDING) {
                pitches = near;
                moments = vec![Moment {
                    s: f64::from(near) * pitch,
                    state,
                    ..moments[moments.len() - 1]
                }];
            }
        }
        Ok(Course { moments, speed: self.speed })
    }
}

/// The load of the incoming tooth over the face width with inertia, and where it acts.
///
/// # Formula
/// ```text
/// me x'' + c x' + ∫ Σ w_k p_k(x, s) dz = F0,   s' = ω1 rb1,   1/me = rb1²/J1 + rb2²/J2
/// c = 2 ζ √(k me) while a pair is in contact, otherwise 0;   k the mean stiffness of the mesh
/// ```
/// p_k(x, s) are the line loads of [`Face::loads`] at a given displacement: the slices have no mass
/// of their own.
///
/// # Source
/// The oscillator of [`dynamic`](crate::model::dynamic::dynamic).
///
/// # Errors
/// [`Refusal::TooSlow`] if the mesh oscillates too often during the motion,
/// [`Refusal::BackFlanksOverFace`] if the back flanks would touch, [`Refusal::BeyondReach`] if pairs
/// beyond the computed gaps may touch, [`Refusal::Stopped`] if `go_on` returns false.
pub(in crate::model) fn dynamic(
    face: &Face,
    settings: &Settings,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<(Dynamic, Option<Arc<FaceLoad>>), Refusal> {
    let mesh = &face.mesh;
    let springs = Springs::within(OF_SLICES, face, settings, mesh.speed);
    let motion = Motion::new(&springs, settings, mesh.speed, Incoming::Deviates(mesh.error));
    let course = motion.passage(settings, mesh.ends().1 + face.reach, go_on)?;
    let passage = Passage::new(face, Some(&course), Incoming::Deviates(mesh.error));
    let passed = passage.run(settings.spacing)?.ok_or(Refusal::BeyondReach)?;
    let Passed { load, face: over_face, samples } = passed;
    let strikes = load.first_contact_angle.is_some();
    let least_gap = if strikes { None } else { Some(-face.greatest_lead(Some(&course), false)?) };
    let last = samples.last().map_or(mesh.length, |loads| loads.s);
    let time = |pair: &[Rc<Loads>]| (pair[1].s - pair[0].s) / mesh.speed;
    let power = |pair: &[Rc<Loads>]| {
        let [one, other] = [&pair[0], &pair[1]].map(|loads| face.friction_power(loads));
        f64::midpoint(one, other) * time(pair)
    };
    let work = || samples.windows(2).map(power).sum();
    let found = Dynamic {
        first_contact_angle: load.first_contact_angle,
        last_contact_angle: load.last_contact_angle,
        peak_approach_force: load.approach_force,
        peak_force: load.peak_force,
        impact_duration: strikes
            .then(|| passage.first_minimum(&samples, load.peak_force))
            .flatten(),
        least_gap,
        contact_lost: course.loses_contact(-mesh.base_pitch - face.reach, last),
        rattle: None,
        friction_work: (mesh.friction() > 0.0).then(work),
        approach: Vec::new(),
        stations: load.stations,
        rough: load.rough,
        evaluations: springs.solves.get(),
        work: springs.solves.get(),
    };
    Ok((found, Some(Arc::new(over_face))))
}

/// The approach of the incoming tooth to E in the motion without its contact.
///
/// # Errors
/// Those of [`dynamic`].
pub(in crate::model) fn approach(
    face: &Face,
    settings: &Settings,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Approach, Refusal> {
    let mesh = &face.mesh;
    let springs = Springs::within(OF_SLICES, face, settings, mesh.speed);
    let motion = Motion::new(&springs, settings, mesh.speed, Incoming::AfterStart(mesh.error));
    let course = motion.passage(settings, face.reach, go_on)?;
    let lead = face.greatest_lead(Some(&course), false)?;
    let contact_lost = course.loses_contact(-mesh.base_pitch - face.reach, face.reach);
    Ok(Approach { lead, contact_lost })
}

/// The steady motion of a pair without deviations at a speed along the line of action, in m/s, from
/// rest or from the steady motion at another speed.
///
/// # Errors
/// Those of [`dynamic`], and [`Refusal::NoSteadyMotion`] if the motion does not repeat.
pub(in crate::model) fn steady(
    springs: &Springs<'_>,
    settings: &Settings,
    speed: f64,
    from: Option<&Start>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Steady, Refusal> {
    /// Error of a state after a base pitch in scales of the motion: that of the smallest steps.
    const PRECISION_OF_PITCH: f64 = 1e-5;
    /// Steps in an interval of the Fourier integral.
    const STEPS: usize = 8;
    let motion = Motion::new(springs, settings, speed, Incoming::Alike);
    let (face, pitch) = (springs.face, springs.face.mesh.base_pitch);
    motion.check_pace(pitch)?;
    let start = match from {
        Some(start) => start.clone(),
        None => Start::of_state(motion.at_rest(0)?),
    };
    let lap = |start: &Start| {
        motion.pitch(0, start.state, &mut |_| ()).map(|state| Some(Start::of_state(state)))
    };
    let found = periodic(start, (motion.scale(), PRECISION_OF_PITCH), go_on, lap)?;
    let (start, periods) = found.ok_or(Refusal::BeyondReach)?;
    let mut moments = vec![Moment { s: 0.0, state: start.state, touches: true }];
    for lap in 0..periods {
        let state = moments[moments.len() - 1].state;
        let before = f64::from(lap) * pitch;
        motion.pitch(0, state, &mut |moment| {
            moments.push(Moment { s: before + moment.s, ..moment });
        })?;
    }
    let course = Course { moments, speed };
    let mut fourier = Fourier::new();
    let last = course.moments.len() - 1;
    for first in (0..last).step_by(STEPS) {
        let [from, to] = [first, (first + STEPS).min(last)].map(|at| course.moments[at].s);
        fourier.add((from / pitch, to / pitch), |part| course.at(from + part * (to - from))[0]);
    }
    let extreme = |of: &dyn Fn(f64) -> f64| {
        let known: Vec<_> = course.moments.iter().map(|one| (one.s, of(one.s))).collect();
        greatest_within(&known, PRECISION, of).1
    };
    fourier.include(extreme(&|s| course.at(s)[0]));
    fourier.include(-extreme(&|s| -course.at(s)[0]));
    let tooth_force = extreme(&|s| {
        let loads = face.loads(s % pitch, 0.0, Until::Displacement(course.at(s)[0]));
        loads.map_or(0.0, |loads| face.tooth_force(&loads))
    });
    let mesh_force = extreme(&|s| {
        let force = springs.force(s % pitch, (0, Incoming::Alike), course.at(s)[0]);
        force.map_or(0.0, |[force, _]| force)
    });
    Ok(Steady {
        spectrum: fourier.spectrum(periods),
        mesh_force,
        tooth_force,
        contact_lost: course.moments.iter().any(|moment| !moment.touches),
        rattle: None,
        periods,
        start,
    })
}
