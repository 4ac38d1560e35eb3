//! The method `dynamic`: the shared load with inertia and damping, integrated from contact event to
//! contact event.

mod acting;
mod events;
mod laps;
mod lead;
mod motion;
mod pair;
mod passage;
mod rattle;
mod settings;
mod side;
pub mod steady;
mod step;
mod swing;
#[cfg(test)]
mod tests;
mod watch;

use super::Refusal;
use super::budget::{EVENT_WORK, MOTION_BYTES, MOTION_WORK, Meter};
use super::mesh::Mesh;
use super::pair_forces::Touching;
use super::spacing::Resolution;
use super::stations::MeshStation;
use acting::ALIKE;
use events::Event;
use laps::Laps;
use lead::TERMS;
use motion::{Motion, State, Window};
use pair::PairName;
pub use rattle::Rattle;
pub use settings::{MotionInputs, Settings};
use step::{Course, Step};
use watch::Watch;

/// Measured over the reference pairs, the peak force then keeps the tolerance with room to spare.
const SHARE_OF_A_STEP: f64 = 0.3;

/// What the incoming tooth carries, with inertia.
#[derive(Debug, Clone, PartialEq)]
pub struct Dynamic {
    /// Driven gear's angle before E at the first contact, in rad, where that is before E.
    pub first_contact_angle: Option<f64>,
    /// Driver's angle after B at the last contact, in rad, where that is after B.
    pub last_contact_angle: Option<f64>,
    /// Greatest force of the incoming tooth before E, in N.
    pub peak_approach_force: f64,
    /// Its greatest force anywhere, in N.
    pub peak_force: f64,
    /// From a first contact before E to the first least force after the first peak, or to the loss
    /// of contact, in s.
    pub impact_duration: Option<f64>,
    /// The gap that is left between the incoming tooth and the flank before E, at the least, in m,
    /// where it does not touch.
    pub least_gap: Option<f64>,
    /// Whether no pair at all is in contact at some moment from one base pitch before E until the
    /// incoming tooth leaves.
    pub contact_lost: bool,
    /// What the back flanks carry meanwhile; where the case gives a backlash.
    pub rattle: Option<Rattle>,
    /// Work of friction on the incoming tooth, in J; where the case gives a friction coefficient.
    pub friction_work: Option<f64>,
    /// From the first contact through E to the last, its peaks and valleys among them.
    pub stations: Vec<MeshStation>,
    /// Whether the stations are as close to each other as the curve needs.
    pub resolution: Resolution,
    /// What it cost.
    pub effort: Effort,
}

/// Counts of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Effort {
    /// Steps.
    pub steps: u64,
    /// Coefficients of the power series of the motion, and places at which a series was looked at.
    pub evaluations: u64,
    /// Contacts made and lost.
    pub events: u64,
    /// All of it in units of the [budget](super::budget).
    pub work: u64,
}

/// The force on the incoming tooth with inertia.
///
/// # Formula
/// ```text
/// me x'' + c x' + Σ w_k F_k(x, s) − Σ w_m B_m(x, s) = F0,   s' = ω1 rb1,   1/me = rb1²/J1 + rb2²/J2
/// x + e_k − S_k = Σ_j Q_kj F_j/b,   −x − j_bn − S_m = Σ_j Q_mj B_j/b
/// c = 2 ζ √(k me) while a pair is in contact, else 0;   k the mean stiffness of the mesh
/// ```
/// with the forces F of the working flanks and, where the case gives a backlash j_bn, B of the back
/// flanks ([`Mesh::back`]). The motion goes from the static balance `warmup_cycles` base pitches
/// before E, where no pair deviates, until the incoming tooth has left. Within a step the pairs in
/// contact stay the same ones, so that the equation is linear, its coefficients are polynomials and
/// every step is a power series, see [`taylor`](crate::numeric::taylor); it ends where a pair
/// touches or leaves, or passes from one zone of the mesh into the next.
///
/// # Source
/// The oscillator of gear dynamics with backlash, Özgüven & Houser 1988, with corner contact by the
/// gap S(u).
///
/// # Errors
/// [`Refusal::BeyondReach`] where the gears move apart further than the mesh is known,
/// [`Refusal::TooSlow`] where the mesh swings too often on the way, [`Refusal::MotionTooLong`] or
/// [`Refusal::MotionTooLarge`] where the steps exceed the [budget](super::budget) of work or of
/// memory, [`Refusal::Stopped`] where `go_on` says no.
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
        let effort = Effort {
            work: meter.spent(),
            ..run.effort
        };
        run.watch.finish(motion, settings.spacing, effort).map(Some)
    })
}

/// What `find` finds of the motion on the working flanks; where the driver falls behind to the
/// back flanks and `find` therefore has nothing, of the motion on both. So the back flanks cost
/// nothing while they stay apart.
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

/// How near the incoming tooth comes to a touch before E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// The most by which the driver is further ahead than the tooth's gap is wide, in m: above 0
    /// the tooth touches, below it is the gap that is left.
    pub lead: f64,
    /// Whether no pair at all is in contact at some moment from one base pitch before E to E.
    pub contact_lost: bool,
}

/// The approach of the incoming tooth to E: the run of [`dynamic`] so far, step by step the same
/// until the tooth touches, but that the tooth stands off. So the lead grows and falls smoothly
/// with what the flanks lack, through 0 as well. Its work is counted in `meter`.
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
        let lead = run
            .lead
            .filter(|lead| lead.is_finite())
            .ok_or(Refusal::BeyondReach)?;
        Ok(Some(Approach {
            lead,
            contact_lost: run.watch.contact_lost(),
        }))
    })
}

/// A run on its way.
struct Run<'a> {
    motion: &'a Motion<'a>,
    borders: Vec<f64>,
    /// The border that comes next.
    next: usize,
    t: f64,
    y: State,
    /// The pairs that touch.
    touching: Vec<PairName>,
    /// The pairs of the window that have touched or left where it stands.
    turned: Touching,
    /// Whether the next step begins where one begins in every base pitch.
    is_even: bool,
    /// What the last terms of a step's series may be, in m.
    allowed: f64,
    laps: Laps,
    watch: Watch,
    effort: Effort,
    meter: &'a Meter,
    /// Where the incoming tooth stands off, the most by which the driver was further ahead than its
    /// gap is wide, in m.
    lead: Option<f64>,
    /// Whether the driver has fallen behind to back flanks that are not followed.
    misses_back: bool,
}

impl<'a> Run<'a> {
    fn begin(motion: &'a Motion<'a>, tolerance: f64, meter: &'a Meter) -> Result<Run<'a>, Refusal> {
        /// Borders that are found and sorted in the time of one series.
        const BORDERS: usize = 8;
        let mesh = motion.mesh;
        let (start, (_, end)) = (motion.start(), mesh.ends());
        motion.check_pace(end - start)?;
        let borders = motion.borders(start, end);
        meter.spend((borders.len() / BORDERS) as u64);
        let inside = f64::midpoint(start, borders.get(1).copied().unwrap_or(end));
        let pairs = mesh.pair_set(start, inside);
        let (displacement, forces) = pairs.shared(mesh.force);
        if !displacement.is_finite() {
            return Err(Refusal::BeyondReach);
        }
        let carries = pairs.pairs().iter().zip(forces);
        let touching = carries.filter(|(_, force)| *force > 0.0);
        Ok(Run {
            motion,
            next: 1,
            t: motion.time(start),
            y: State::new(displacement, 0.0),
            touching: touching
                .map(|(pair, _)| PairName::working(pair.ahead))
                .collect(),
            borders,
            turned: Touching::NONE,
            is_even: true,
            allowed: SHARE_OF_A_STEP * tolerance * motion.scale()[0],
            laps: Laps::new(start, tolerance),
            watch: Watch::default(),
            effort: Effort::default(),
            meter,
            lead: None,
            misses_back: false,
        })
    }

    /// Goes on to the next border, or to where the warm-up ends if it repeats itself; not where
    /// the driver falls behind to back flanks that are not followed.
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

    /// How much of the way is done, from 0 to 1.
    fn part_done(&self) -> f64 {
        let (from, to) = (self.borders[0], self.motion.mesh.length);
        ((self.motion.place(self.t) - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// Go on to the next border.
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

    /// Once a base pitch of the warm-up is as the one before, the others are too: go on where the
    /// last of them ends.
    fn skip_what_repeats(&mut self) {
        let (mesh, s) = (self.motion.mesh, self.borders[self.next - 1]);
        if self.misses_back || !self.laps.repeats(self.motion, s, &self.y, &self.touching) {
            return;
        }
        let pitches = ((mesh.ends().0 - s) / mesh.base_pitch).floor();
        let to = s + pitches * mesh.base_pitch;
        let border = self
            .borders
            .iter()
            .position(|border| (border - to).abs() <= ALIKE * mesh.base_pitch);
        let Some(border) = border.filter(|_| pitches >= 1.0) else {
            return;
        };
        self.next = border + 1;
        self.t = self.motion.time(self.borders[border]);
        self.touching
            .iter_mut()
            .for_each(|pair| *pair = pair.moved(-(pitches as i32)));
    }

    /// One step, to `end` at most; the pairs that touch after it, and the step.
    fn advance(
        &mut self,
        window: &Window,
        touching: Touching,
        end: f64,
    ) -> Result<(Touching, Step), Refusal> {
        let course = Course::new(self.motion, window, touching);
        let taken = course.step(self.t, &self.y, end, (self.allowed, self.is_even))?;
        let (mut step, leads) = (taken.step, &taken.acting.leads);
        self.effort.steps += 1;
        self.effort.evaluations += TERMS as u64;
        self.count(1 + window.pairs.len() as u64 + self.motion.take_looks())?;
        let range = step.range();
        self.misses_back |= self.motion.misses_back(range.0);
        let standing_off = self.lead.and(window.incoming());
        let event = events::first(&course, (&step, range), leads, (self.turned, standing_off));
        self.is_even = taken.ends_even && event.is_none();
        let part = event.map_or(1.0, |event| event.part);
        if event.is_some() {
            step = step.cut(part);
        }
        // A step to a border ends on it, whatever the rounding of the sum.
        self.t = if event.is_none() && step.length >= end - self.t {
            end
        } else {
            step.end()
        };
        if step.length > 0.0 {
            self.y = step.state(1.0);
            self.turned = Touching::NONE;
            if let (Some(lead), Some(incoming)) = (self.lead, standing_off) {
                self.lead = Some(leads[incoming].stretched(part).most(&step.ahead, lead));
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
            return Err(Refusal::MotionTooLarge {
                bytes: MOTION_BYTES,
                done: self.part_done(),
            });
        }
        if self.meter.spend(work) {
            return Ok(());
        }
        Err(Refusal::MotionTooLong {
            steps: self.effort.steps,
            done: self.part_done(),
        })
    }

    /// A pair touches or leaves.
    fn turn(&mut self, window: &Window, touching: Touching, event: Event) -> Touching {
        self.effort.events += 1;
        self.turned = self.turned.with(event.pair);
        if window.incoming() == Some(event.pair) {
            self.watch.turn(self.t, !touching.has(event.pair));
        }
        touching.toggled(event.pair)
    }
}
