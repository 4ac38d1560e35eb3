//! The method `dynamic`: the shared load with inertia and damping, integrated from contact event to
//! contact event.

mod motion;
mod side;
pub mod steady;
#[cfg(test)]
mod tests;
mod watch;

use super::Refusal;
use super::budget::{EVENT_WORK, MOTION_BYTES, MOTION_WORK, Meter};
use super::inputs::Inputs;
use super::mesh::Mesh;
use super::pair_forces::Touching;
use super::stations::Spacing;
use super::stations::Station;
pub(super) use motion::State;
use motion::{ALIKE, Motion, Window};
use motion::{Course, Event, Step};
use side::{PairName, TERMS};
use steady::{RepeatDetector, Start};
pub use watch::Rattle;
use watch::Watch;
pub(super) use watch::first_valley;

/// Part of the tolerance for one step. Measured over the reference pairs, the peak force then meets
/// the tolerance with a margin.
const SHARE_OF_A_STEP: f64 = 0.3;

/// Load of the incoming tooth with inertia.
#[derive(Debug, Clone, PartialEq)]
pub struct Dynamic {
    /// Driven gear's angle before E at the first contact, in rad. `None` without contact before E.
    pub first_contact_angle: Option<f64>,
    /// Driver's angle after B at the last contact, in rad. `None` without contact after B.
    pub last_contact_angle: Option<f64>,
    /// Greatest force of the incoming tooth before E, in N.
    pub peak_approach_force: f64,
    /// Greatest force of the incoming tooth, in N.
    pub peak_force: f64,
    /// Time from a first contact before E to the first valley of the force, or to the loss of contact, in
    /// s. A fall of less than a hundredth of the greatest force is no valley.
    pub impact_duration: Option<f64>,
    /// Least gap between the incoming tooth and the flank before E, in m. `None` if the tooth
    /// touches before E.
    pub least_gap: Option<f64>,
    /// Whether at any time no pair is in contact, from one base pitch before E until the incoming
    /// tooth leaves.
    pub contact_lost: bool,
    /// Load of the back flanks. `None` if the case gives no backlash.
    pub rattle: Option<Rattle>,
    /// Work of friction on the incoming tooth, in J. `None` if the case gives no friction
    /// coefficient.
    pub friction_work: Option<f64>,
    /// The incoming pair's place on the line of action, in m, and its force, in N, at even times
    /// and at the turning points of the force, from the first contact to E. Empty without contact
    /// before E or without [`Settings::approach_samples`].
    pub approach: Vec<(f64, f64)>,
    /// Stations from the first contact through E to the last contact, including peaks and valleys.
    pub stations: Vec<Station>,
    /// The reason why the stations are less dense than the curve needs.
    pub rough: Option<Refusal>,
    /// Coefficients of the power series of the motion, and evaluations of series.
    pub evaluations: u64,
    /// Total work in units of the [budget](super::budget).
    pub work: u64,
}

/// The force on the incoming tooth with inertia.
///
/// # Formula
/// ```text
/// me x'' + c x' + Σ w_k F_k(x, s) − Σ w_m B_m(x, s) = F0,   s' = ω1 rb1,   1/me = rb1²/J1 + rb2²/J2
/// x + e_k − S_k = Σ_j Q_kj F_j/b,   −x − j_bn − S_m = Σ_j Q_mj B_j/b
/// c = 2 ζ √(k me) while a pair is in contact, otherwise 0;   k the mean stiffness of the mesh
/// ```
/// F are the forces of the working flanks and B, if the case gives a backlash j_bn, the forces of
/// the back flanks ([`Mesh::back`]). The motion starts in static balance `warmup_cycles` base
/// pitches before E, without deviation of any pair, and ends after the incoming tooth has left.
/// Within a step the same pairs are in contact. The equation is then linear with polynomial
/// coefficients, and the step is a power series, see [`taylor`](crate::numeric::taylor). A step
/// ends when a pair gains or loses contact, or passes into the next zone of the mesh.
///
/// # Source
/// The oscillator of gear dynamics with backlash, Özgüven & Houser 1988, with corner contact by the
/// gap S(u).
///
/// # Errors
/// [`Refusal::BeyondReach`] if the gears separate beyond the computed range of the mesh,
/// [`Refusal::TooSlow`] if the mesh oscillates too often during the motion,
/// [`Refusal::MotionTooLong`] or [`Refusal::MotionTooLarge`] if the steps exceed the
/// [budget](super::budget) of work or of memory, [`Refusal::Stopped`] if `go_on` returns false.
pub fn dynamic(
    mesh: &Mesh,
    settings: &Settings,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Dynamic, Refusal> {
    let meter = Meter::new(MOTION_WORK);
    across_backlash(mesh, settings, |motion| {
        let mut run = Run::begin(motion, settings.tolerance, &meter)?;
        while !run.is_over() {
            if !run.goes_on(go_on)? {
                return Ok(None);
            }
        }
        run.check_reach()?;
        let found = run.watch.finish(motion, settings)?;
        let evaluations = found.evaluations + run.steps * TERMS as u64;
        Ok(Some(Dynamic { evaluations, work: meter.spent(), ..found }))
    })
}

/// The result of `find` for the motion on the working flanks. If the driver reaches the back flanks
/// and `find` returns `None`, the result for the motion on both flanks. Back flanks that do not
/// touch cost no time.
fn across_backlash<T>(
    mesh: &Mesh,
    settings: &Settings,
    find: impl Fn(&Motion<'_>) -> Result<Option<T>, Refusal>,
) -> Result<T, Refusal> {
    let motion = Motion::new(mesh, settings);
    match find(&motion)? {
        Some(found) => Ok(found),
        None => find(&motion.with_back())?.ok_or(Refusal::BeyondReach),
    }
}

/// The approach of the incoming tooth to contact before E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// Greatest difference of the driver's lead and the tooth's gap, in m. Above 0 the tooth
    /// touches. A negative value is the gap that is left.
    pub lead: f64,
    /// Whether at any time no pair is in contact, from one base pitch before E to E.
    pub contact_lost: bool,
}

/// The approach of the incoming tooth to E: the run of [`dynamic`] without contact of the incoming
/// tooth, with equal steps until the tooth would touch. The lead is therefore a smooth function of
/// the relief, also through 0. `meter` counts the work.
///
/// # Errors
/// Those of [`dynamic`].
pub fn approach(
    mesh: &Mesh,
    settings: &Settings,
    meter: &Meter,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Approach, Refusal> {
    across_backlash(mesh, settings, |motion| {
        let mut run = Run {
            lead: Some(f64::NEG_INFINITY),
            watch: Watch::of_contact_alone(),
            ..Run::begin(motion, settings.tolerance, meter)?
        };
        run.touching.retain(|&pair| pair != PairName::working(0));
        let is_before = |border: &f64| *border <= 0.0;
        while run.borders.get(run.next).is_some_and(is_before) {
            if !run.goes_on(go_on)? {
                return Ok(None);
            }
        }
        run.check_reach()?;
        let lead = run.lead.filter(|lead| lead.is_finite()).ok_or(Refusal::BeyondReach)?;
        Ok(Some(Approach { lead, contact_lost: run.watch.contact_lost() }))
    })
}

/// The state of a run.
struct Run<'a> {
    motion: &'a Motion<'a>,
    borders: Vec<f64>,
    next: usize,
    t: f64,
    y: State,
    touching: Vec<PairName>,
    /// The pairs of the window that have just gained or lost contact.
    turned: Touching,
    /// Whether the next step begins at a place where a step begins in every base pitch.
    is_even: bool,
    /// Permitted size of the last terms of a step's series, in m.
    allowed: f64,
    repeats: RepeatDetector,
    watch: Watch,
    steps: u64,
    meter: &'a Meter,
    /// Greatest difference of the driver's lead and the gap of the incoming tooth, in m, for a run
    /// without its contact.
    lead: Option<f64>,
    /// Whether the driver has reached back flanks that the motion does not include.
    misses_back: bool,
}

impl<'a> Run<'a> {
    fn begin(motion: &'a Motion<'a>, tolerance: f64, meter: &'a Meter) -> Result<Run<'a>, Refusal> {
        /// Number of borders sorted in the time of one series.
        const BORDERS: usize = 8;
        let mesh = motion.mesh;
        let (start, (_, end)) = (motion.start(), mesh.ends());
        motion.check_pace(end - start)?;
        let borders = motion.borders(start, end);
        meter.spend((borders.len() / BORDERS) as u64);
        let at_rest = Start::at_rest(mesh, &borders)?;
        Ok(Run::from(motion, borders, at_rest, tolerance, meter))
    }

    /// A run from the first border on.
    fn from(
        motion: &'a Motion<'a>,
        borders: Vec<f64>,
        start: Start,
        tolerance: f64,
        meter: &'a Meter,
    ) -> Run<'a> {
        Run {
            motion,
            next: 1,
            t: motion.time(borders[0]),
            y: start.state,
            touching: start.touching,
            turned: Touching::NONE,
            is_even: true,
            allowed: SHARE_OF_A_STEP * tolerance * motion.scale()[0],
            repeats: RepeatDetector::new(borders[0], tolerance),
            borders,
            watch: Watch::default(),
            steps: 0,
            meter,
            lead: None,
            misses_back: false,
        }
    }

    /// Advances to the next border, or to the end of the warm-up if it repeats. Returns false if
    /// the driver reaches back flanks that the motion does not include.
    fn goes_on(&mut self, go_on: &dyn Fn(f64) -> bool) -> Result<bool, Refusal> {
        if !go_on(self.part_done()) {
            return Err(Refusal::Stopped);
        }
        self.cross_window()?;
        self.skip_what_repeats();
        Ok(!self.misses_back)
    }

    fn is_over(&self) -> bool {
        self.next >= self.borders.len() || self.watch.is_over(self.motion)
    }

    /// The computed part of the motion, from 0 to 1.
    fn part_done(&self) -> f64 {
        let (from, to) = (self.borders[0], self.motion.mesh.length);
        ((self.motion.place(self.t) - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// Refuses a motion in which pairs beyond the ends of the mesh may touch.
    fn check_reach(&self) -> Result<(), Refusal> {
        let mesh = self.motion.mesh;
        mesh.check_reach(self.watch.most_ahead + mesh.error.max(0.0))
    }

    /// Advances to the next border.
    fn cross_window(&mut self) -> Result<(), Refusal> {
        let (from, to) = (self.borders[self.next - 1], self.borders[self.next]);
        self.next += 1;
        let window = self.motion.window(from, to)?;
        let names = &self.touching;
        let mut touching = window.touching(names).ok_or(Refusal::BeyondReach)?;
        self.watch.enter(&window);
        self.turned = Touching::NONE;
        let end = self.motion.time(to);
        while self.t < end && !self.misses_back {
            (touching, _) = self.advance(&window, touching, end)?;
        }
        self.touching = window.names(touching);
        Ok(())
    }

    /// Skips the rest of the warm-up after a base pitch that equals the base pitch before.
    fn skip_what_repeats(&mut self) {
        let (mesh, s) = (self.motion.mesh, self.borders[self.next - 1]);
        if self.misses_back || !self.repeats.repeats(self.motion, s, &self.y, &self.touching) {
            return;
        }
        let pitches = ((mesh.ends().0 - s) / mesh.base_pitch).floor();
        let to = s + pitches * mesh.base_pitch;
        let border =
            self.borders.iter().position(|border| (border - to).abs() <= ALIKE * mesh.base_pitch);
        let Some(border) = border.filter(|_| pitches >= 1.0) else {
            return;
        };
        self.next = border + 1;
        self.t = self.motion.time(self.borders[border]);
        self.touching.iter_mut().for_each(|pair| *pair = pair.moved(-(pitches as i32)));
    }

    /// Advances by one step, at most to `end`. Returns the pairs that touch afterwards, and the
    /// step.
    fn advance(
        &mut self,
        window: &Window,
        touching: Touching,
        end: f64,
    ) -> Result<(Touching, Step), Refusal> {
        let course = Course::new(self.motion, window, touching);
        let taken = course.step(self.t, &self.y, end, (self.allowed, self.is_even))?;
        let mut step = taken.step;
        self.steps += 1;
        self.count(1 + window.pairs.len() as u64 + self.motion.take_looks())?;
        let range = step.range();
        self.misses_back |= self.motion.misses_back(range.0);
        let standing_off = self.lead.and(window.incoming());
        let event = motion::first_event(&course, (&step, range), (self.turned, standing_off));
        self.is_even = taken.ends_even && event.is_none();
        if let Some(event) = event {
            step = step.cut(event.part);
        }
        // A step to a border ends exactly on the border, independent of rounding.
        self.t = if event.is_none() && step.length >= end - self.t { end } else { step.end() };
        if step.length > 0.0 {
            self.y = step.state(1.0);
            self.turned = Touching::NONE;
            if let (Some(lead), Some(incoming)) = (self.lead, standing_off) {
                let overlap = course.lead_along(incoming, &step);
                self.lead = Some(overlap.most(&step.ahead, lead));
            }
            self.watch.keep(&course, touching, step, range.1);
        }
        let Some(event) = event else {
            return Ok((touching, step));
        };
        self.count(EVENT_WORK)?;
        Ok((self.turn(window, touching, event), step))
    }

    /// Counts work of the motion.
    fn count(&self, work: u64) -> Result<(), Refusal> {
        if self.watch.bytes() + self.motion.bytes() > MOTION_BYTES {
            return Err(Refusal::MotionTooLarge { bytes: MOTION_BYTES, done: self.part_done() });
        }
        if self.meter.spend(work) {
            return Ok(());
        }
        Err(Refusal::MotionTooLong { steps: self.steps, done: self.part_done() })
    }

    /// A pair gains or loses contact.
    fn turn(&mut self, window: &Window, touching: Touching, event: Event) -> Touching {
        self.turned = self.turned.with(event.pair);
        if window.incoming() == Some(event.pair) {
            self.watch.turn(self.t, !touching.has(event.pair));
        }
        touching.toggled(event.pair)
    }
}

/// Settings of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Mass at the line of action m_e, in kg.
    pub mass: f64,
    /// Damping ratio ζ.
    pub damping_ratio: f64,
    /// Number of base pitches before E at which the run starts.
    pub warmup_cycles: u32,
    /// Normal backlash j_bn, in m. With `None` the back flanks never touch.
    pub backlash: Option<f64>,
    /// Permitted relative error of the peak force.
    pub tolerance: f64,
    /// Stations between the first contact and E, and between E and the last contact.
    pub spacing: Spacing,
    /// Number of even samples of the force from the first contact to E; 0 for none.
    pub approach_samples: usize,
}

impl Settings {
    /// The settings of a case, with the mass at the line of action, in kg.
    pub fn of(inputs: &Inputs, mass: f64) -> Settings {
        Settings {
            mass,
            damping_ratio: inputs.damping_ratio,
            warmup_cycles: inputs.warmup_cycles,
            backlash: Some(inputs.backlash).filter(|&backlash| backlash > 0.0),
            tolerance: inputs.tolerance,
            spacing: Spacing::of(inputs),
            approach_samples: inputs.approach_samples,
        }
    }

    /// The settings of the approach, which has no stations.
    pub fn approach(inputs: &Inputs, mass: f64) -> Settings {
        let spacing = Spacing::Even(1);
        Settings { spacing, approach_samples: 0, ..Settings::of(inputs, mass) }
    }

    /// The settings of the steady motion, which has neither warm-up nor stations.
    pub fn steady(inputs: &Inputs, mass: f64) -> Settings {
        Settings { warmup_cycles: 0, ..Settings::approach(inputs, mass) }
    }
}
