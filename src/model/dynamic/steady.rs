//! The steady motion of equal pairs, which repeats with every base pitch and causes whine.

use nalgebra::Matrix2;

use super::motion::{ALIKE, Motion, State, Window};
use super::motion::{Course, Step};
use super::side::{FORCE_TERMS, Flank, PairName};
use super::watch::{Rattle, RattleWatch, Watch};
use super::{Run, Settings, across_backlash};
use crate::model::Refusal;
use crate::model::budget::Meter;
use crate::model::mesh::Mesh;
use crate::model::pair_forces::Touching;
use crate::model::static_load::{Fourier, Spectrum};
use crate::numeric::polynomial::{Polynomial, extremes};

/// Greatest number of base pitches in a period. Loss of contact can double the period.
const PERIODS: usize = 4;

/// Number of base pitches after which a motion without repetition counts as chaotic.
const MOST_LAPS: u32 = 4000;

/// Greatest relative error of the steps of a steady motion.
const TOLERANCE: f64 = 1e-6;

/// The steady motion of a pair without deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct Steady {
    /// The transmission error over the mesh period.
    pub spectrum: Spectrum,
    /// Greatest sum of the forces of all pairs, in N.
    pub mesh_force: f64,
    /// Greatest force of a tooth, in N.
    pub tooth_force: f64,
    /// Whether at any time no pair touches.
    pub contact_lost: bool,
    /// Load of the back flanks over the period. `None` if the case gives no backlash.
    pub rattle: Option<Rattle>,
    /// Number of base pitches in a period.
    pub periods: u32,
    /// State at the beginning of a base pitch.
    pub start: Start,
}

/// A state of the motion at the beginning of a base pitch.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    pub(in crate::model) state: State,
    pub(super) touching: Vec<PairName>,
}

impl Start {
    /// The static balance at the first of the borders.
    pub(super) fn at_rest(mesh: &Mesh, borders: &[f64]) -> Result<Start, Refusal> {
        let start = borders[0];
        let inside = f64::midpoint(start, borders.get(1).copied().unwrap_or(mesh.ends().1));
        let pairs = mesh.pair_set(start, inside);
        let (displacement, forces) = pairs.shared(mesh.force);
        if !displacement.is_finite() {
            return Err(Refusal::BeyondReach);
        }
        let carries = pairs.pairs().iter().zip(forces);
        let touching = carries.filter(|(_, force)| *force > 0.0);
        Ok(Start {
            state: State::new(displacement, 0.0),
            touching: touching.map(|(pair, _)| PairName::working(pair.ahead)).collect(),
        })
    }

    /// A state whose touching pairs follow from it.
    pub(in crate::model) fn of_state(state: State) -> Start {
        Start { state, touching: Vec::new() }
    }

    /// A state with the touching pairs in order.
    fn of(state: State, touching: &[PairName]) -> Start {
        let mut touching = touching.to_vec();
        touching.sort_unstable();
        Start { state, touching }
    }

    /// Change since another state, relative to the scale of the motion; infinite if other pairs
    /// touch.
    fn moved_since(&self, then: &Start, scale: State) -> f64 {
        let moved = (self.state - then.state).component_div(&scale).amax();
        if then.touching == self.touching { moved } else { f64::INFINITY }
    }

    /// Whether back flanks touch.
    fn is_at_back(&self) -> bool {
        self.touching.iter().any(|pair| pair.flank == Flank::Back)
    }
}

/// The periodic motion of a mesh without base pitch deviations, from static balance or from the
/// steady motion at another speed.
///
/// # Formula
/// ```text
/// me x'' + c x' + Σ w_k F_k(x, s) = F0,   e_k = 0,   x(t + p T_z) = x(t),   p from 1 to 4
/// ```
/// The motion is computed for one base pitch after the other until displacement, rate and touching
/// pairs equal those of p base pitches before.
///
/// # Source
/// The oscillator of [`dynamic`](super::dynamic); period doubling: Kahraman & Singh 1990.
///
/// # Errors
/// [`Refusal::NoSteadyMotion`] if the motion does not repeat, [`Refusal::MotionTooLong`] if the
/// steps exceed the budget of the meter, [`Refusal::BeyondReach`] if the gears separate beyond the
/// computed range of the mesh, [`Refusal::Stopped`] if `go_on` returns false.
pub fn steady(
    mesh: &Mesh,
    settings: &Settings,
    from: Option<&Start>,
    meter: &Meter,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Steady, Refusal> {
    let mesh = mesh.without_error();
    across_backlash(&mesh, settings, |motion| {
        if motion.back.is_none() && from.is_some_and(Start::is_at_back) {
            return Ok(None);
        }
        let mut round = Round::begin(motion, settings, from, meter)?;
        let found = periodic(round.start(), (motion.scale(), EXACT), go_on, |start| {
            round.run.y = start.state;
            round.lap(|_, _, _| ())?;
            Ok((!round.run.misses_back).then(|| round.start()))
        })?;
        let Some((start, periods)) = found else {
            return Ok(None);
        };
        round.run.y = start.state;
        round.measured(periods).map(Some)
    })
}

/// Greatest change of the state in a repetition of exact steps, relative to the scale of the motion.
const EXACT: f64 = 1e-9;

/// The start of a base pitch from which the motion repeats, with the number of base pitches in a
/// period. `lap` computes the next start, with an error of `precision` scales; `None` if it finds none.
/// A motion whose errors never repeat exactly repeats if it stays within the precision.
pub(in crate::model) fn periodic(
    mut start: Start,
    (scale, precision): (State, f64),
    go_on: &dyn Fn(f64) -> bool,
    mut lap: impl FnMut(&Start) -> Result<Option<Start>, Refusal>,
) -> Result<Option<(Start, u32)>, Refusal> {
    /// Greatest distance of the last two states from which a fixed point is sought, relative to the
    /// scale of the state.
    const NEAR: f64 = 0.03;
    /// Change of the state that is not another motion.
    const NEARLY: f64 = 1e-6;
    /// Base pitches within the precision after which the rest of the change is lost in the errors.
    const ENOUGH: u32 = 30;
    let mut before: Vec<Start> = Vec::with_capacity(PERIODS);
    let (mut near, mut repeated) = (NEAR, 0);
    for laps in 0..MOST_LAPS {
        let done = f64::from(laps) / f64::from(MOST_LAPS);
        if !go_on(done) {
            return Err(Refusal::Stopped);
        }
        let moved: Vec<f64> = before.iter().map(|then| start.moved_since(then, scale)).collect();
        let period =
            |most: f64| moved.iter().position(|&moved| moved <= most).map(|at| at as u32 + 1);
        repeated = if period(precision).is_some() { repeated + 1 } else { 0 };
        // A nearly equal state after fewer base pitches counts as the period.
        let nearly = precision.max(NEARLY);
        if period(EXACT).is_some() || repeated > ENOUGH {
            return Ok(period(nearly).map(|periods| (start, periods)));
        }
        if let Some((state, distance)) = fixed_point(scale, &before, &start, near) {
            start.state = state;
            before.clear();
            // Errors of the steps bring the states no nearer.
            near = 0.5 * distance;
        } else {
            before.insert(0, start.clone());
            before.truncate(PERIODS);
        }
        let next = lap(&start).map_err(|refusal| match refusal {
            Refusal::MotionTooLong { steps, .. } => Refusal::MotionTooLong { steps, done },
            other => other,
        })?;
        let Some(next) = next else {
            return Ok(None);
        };
        start = next;
    }
    Err(Refusal::NoSteadyMotion { pitches: MOST_LAPS })
}

/// The state that repeats with every base pitch, if the last four states approach it: the fixed
/// point of the linear map through their differences, with the distance of the last two, which is at
/// most `near` in scales of the state. `before` begins with the last start.
///
/// # Formula
/// ```text
/// v_n = y_n+1 − y_n,   A = (v_1 v_2)(v_0 v_1)⁻¹,   y* = y_3 + (1 − A)⁻¹ A v_2
/// ```
fn fixed_point(scale: State, before: &[Start], now: &Start, near: f64) -> Option<(State, f64)> {
    /// Greatest distance of the fixed point, in distances of the last two states.
    const FAR: f64 = 10.0;
    /// Least angle between two differences, in rad.
    const LEAST_ANGLE: f64 = 1e-6;
    /// Greatest determinant of the map, which shrinks areas.
    const MOST_GROWTH: f64 = 0.95;
    let states = [before.get(2)?, before.get(1)?, before.first()?, now];
    if states.iter().any(|state| state.touching != now.touching) {
        return None;
    }
    let [y0, y1, y2, y3] = states.map(|start| start.state.component_div(&scale));
    let (v0, v1, v2) = (y1 - y0, y2 - y1, y3 - y2);
    let differences = Matrix2::from_columns(&[v0, v1]);
    let is_flat = differences.determinant().abs() <= LEAST_ANGLE * v0.norm() * v1.norm();
    if is_flat || v2.norm() > near {
        return None;
    }
    let map = Matrix2::from_columns(&[v1, v2]) * differences.try_inverse()?;
    let way = (Matrix2::identity() - map).try_inverse()? * map * v2;
    let is_sound = map.determinant().abs() < MOST_GROWTH && way.norm() <= FAR * v2.norm();
    is_sound.then(|| ((y3 + way).component_mul(&scale), v2.norm()))
}

/// A run that repeats one base pitch.
struct Round<'a> {
    motion: &'a Motion<'a>,
    windows: Vec<Window>,
    run: Run<'a>,
}

impl<'a> Round<'a> {
    fn begin(
        motion: &'a Motion<'a>,
        settings: &Settings,
        from: Option<&Start>,
        meter: &'a Meter,
    ) -> Result<Round<'a>, Refusal> {
        let mesh = motion.mesh;
        motion.check_pace(mesh.base_pitch)?;
        let borders = motion.borders(0.0, mesh.base_pitch);
        let windows: Result<Vec<Window>, Refusal> =
            borders.windows(2).map(|ends| motion.window(ends[0], ends[1])).collect();
        let start = match from {
            Some(start) => start.clone(),
            None => Start::at_rest(mesh, &borders)?,
        };
        let tolerance = settings.tolerance.min(TOLERANCE);
        let run = Run {
            watch: Watch::of_contact_alone(),
            ..Run::from(motion, borders, start, tolerance, meter)
        };
        Ok(Round { motion, windows: windows?, run })
    }

    fn start(&self) -> Start {
        Start::of(self.run.y, &self.run.touching)
    }

    /// Runs one base pitch and shows every step.
    fn lap(&mut self, mut show: impl FnMut(&Window, Touching, &Step)) -> Result<(), Refusal> {
        let run = &mut self.run;
        for window in &self.windows {
            let names = &run.touching;
            let mut touching = window.touching(names).ok_or(Refusal::BeyondReach)?;
            run.turned = Touching::NONE;
            let end = self.motion.time(window.ends.1);
            while run.t < end {
                let (next, step) = run.advance(window, touching, end)?;
                if run.misses_back {
                    return Ok(());
                }
                if step.length > 0.0 {
                    show(window, touching, &step);
                }
                touching = next;
            }
            run.touching = window.names(touching);
        }
        run.t = 0.0;
        run.touching.iter_mut().for_each(|pair| *pair = pair.moved(1));
        Ok(())
    }

    /// Runs the periods once more and measures the results.
    fn measured(mut self, periods: u32) -> Result<Steady, Refusal> {
        let start = self.start();
        let mut seen = Seen::new(self.motion, RattleWatch::from(start.is_at_back()));
        for _ in 0..periods {
            self.lap(|window, touching, step| seen.see(window, touching, step))?;
        }
        seen.check_reach()?;
        Ok(Steady {
            spectrum: seen.fourier.spectrum(periods),
            mesh_force: seen.mesh_force,
            tooth_force: seen.tooth_force,
            contact_lost: seen.contact_lost,
            rattle: self.motion.has_backlash().then(|| seen.rattle.found()),
            periods,
            start,
        })
    }
}

/// The results from the steps of a period.
struct Seen<'a> {
    motion: &'a Motion<'a>,
    period: f64,
    fourier: Fourier,
    /// Greatest distances of the driver ahead and behind, in m.
    ahead: f64,
    behind: f64,
    mesh_force: f64,
    tooth_force: f64,
    contact_lost: bool,
    rattle: RattleWatch,
}

impl<'a> Seen<'a> {
    fn new(motion: &'a Motion<'a>, rattle: RattleWatch) -> Seen<'a> {
        Seen {
            motion,
            period: motion.time(motion.mesh.base_pitch),
            fourier: Fourier::new(),
            ahead: f64::NEG_INFINITY,
            behind: f64::NEG_INFINITY,
            mesh_force: 0.0,
            tooth_force: 0.0,
            contact_lost: false,
            rattle,
        }
    }

    fn see(&mut self, window: &Window, touching: Touching, step: &Step) {
        let ends = (step.t / self.period, step.end() / self.period);
        self.fourier.add(ends, |part| step.ahead.at(part));
        for value in extremes(&step.ahead) {
            self.fourier.include(value);
            self.ahead = self.ahead.max(value);
            self.behind = self.behind.max(-value);
        }
        let working = window.working(touching);
        self.contact_lost |= working.is_none();
        let course = Course::new(self.motion, window, touching);
        self.rattle.see(&course, step, true);
        let mut sum = Polynomial::<FORCE_TERMS>::ZERO;
        for pair in working.pairs() {
            let force = course.force_along(pair, step);
            sum = sum.plus(1.0, &force);
            self.tooth_force = extremes(&force).fold(self.tooth_force, f64::max);
        }
        self.mesh_force = extremes(&sum).fold(self.mesh_force, f64::max);
    }

    /// Refuses a motion in which pairs beyond the ends of the mesh may touch.
    fn check_reach(&self) -> Result<(), Refusal> {
        let most = self.ahead.max(self.behind - self.motion.backlash);
        self.motion.mesh.check_reach(most)
    }
}

/// A relative change of the state below this value is rounding.
const ROUNDING: f64 = 1e-14;

/// The state one base pitch before: before the incoming tooth is near, all base pitches are alike.
pub(super) struct RepeatDetector {
    /// Start of the next base pitch, in base pitches.
    next: f64,
    start: f64,
    /// The last state, with the names that its pairs have now, and its change since the one before.
    last: Option<(Start, f64)>,
    /// Relative change of the state that counts as none.
    allowed: f64,
}

impl RepeatDetector {
    /// A warm-up that begins at `start`, in m.
    pub(super) fn new(start: f64, tolerance: f64) -> RepeatDetector {
        /// Part of the tolerance that limits the error of a converging state.
        const PART: f64 = 1e-3;
        RepeatDetector {
            next: 1.0,
            start,
            last: None,
            allowed: (PART * tolerance).max(10.0 * ROUNDING),
        }
    }

    /// Whether the state at `s`, in m, equals the state one base pitch before. For a converging
    /// state, whose changes fall by half or more with each base pitch, the sum of all further
    /// changes is less than the last change. Different contacts are not a repetition.
    pub(super) fn repeats(
        &mut self,
        motion: &Motion<'_>,
        s: f64,
        y: &State,
        touching: &[PairName],
    ) -> bool {
        let pitch = motion.mesh.base_pitch;
        if (s - self.start - self.next * pitch).abs() > ALIKE * pitch {
            return false;
        }
        self.next += 1.0;
        let mut now = Start::of(*y, touching);
        let before = self.last.take();
        let moved = before
            .as_ref()
            .map_or(f64::INFINITY, |(then, _)| now.moved_since(then, motion.scale()));
        let draws_near = before.is_some_and(|(_, last)| moved <= 0.5 * last);
        now.touching.iter_mut().for_each(|pair| *pair = pair.moved(-1));
        self.last = Some((now, moved));
        moved <= if draws_near { self.allowed } else { ROUNDING }
    }
}
