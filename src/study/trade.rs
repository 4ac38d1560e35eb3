//! Run time against accuracy: every method with several settings and every compliance, each timed
//! and compared with one reference.

mod clock;
mod results;
mod second;

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::model::inputs::Method;
use crate::model::{self, Inputs, Outcome, Quantity, Refusal, Solution, Stage, Stages};
use clock::Batches;
pub use clock::{Build, Patience, Time};
pub use results::{
    Differences, Figures, METHODS, MeasuredSetting, Model, Reference, STATIONS, Setting, Trade,
    greatest,
};

/// The parameters of a trade study.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TradeParameters {
    /// Accepted error of a setting, relative to the reference; also the tolerance of method `auto`.
    pub within: f64,
    /// How long each setting is timed.
    pub patience: Patience,
}

const NO_DIFFERENCES: Differences = [None; Subject::ALL.len()];

/// Answers for the comparison, with their curves; only the running measurement needs them.
struct References {
    truth: Option<Arc<Answer>>,
    /// Best settings with their answers.
    best: Vec<(Setting, Arc<Answer>)>,
}

/// Measures every setting on the case: first the errors, then all times in rounds until the median
/// of each is steady. `show` receives the results after each setting and each round.
///
/// # Errors
/// [`Refusal::Stopped`] if `go_on` returns false; the refusal of the model if no method solves the
/// case.
pub fn trade(
    inputs: &Inputs,
    parameters: &TradeParameters,
    go_on: &dyn Fn() -> bool,
    show: &mut dyn FnMut(&Trade),
) -> Result<Trade, Refusal> {
    let inputs = &Inputs { within: parameters.within, ..inputs.clone() };
    let settings = settings(inputs);
    let (mut trade, references) = References::find(inputs, parameters, settings.len(), go_on)?;
    show(&trade);
    let mut rounds = Rounds::begin(inputs, parameters.patience, go_on);
    for setting in settings {
        let measured = references.measure(inputs, setting, &mut rounds)?;
        trade.settings.push(measured);
        trade.judge();
        trade.part = rounds.part(trade.planned);
        show(&trade);
    }
    while rounds.go_on() {
        for (measured, time) in trade.settings.iter_mut().zip(rounds.round()?) {
            if let (Ok(figures), Some(time)) = (&mut measured.found, time) {
                figures.time = time;
            }
        }
        trade.judge();
        trade.part = rounds.part(trade.planned);
        show(&trade);
    }
    let refusals = trade.settings.iter().map(|measured| measured.found.as_ref().err());
    match refusals.collect::<Option<Vec<_>>>() {
        Some(refusals) if !refusals.is_empty() => Err(*refusals[0]),
        _ => Ok(trade),
    }
}

/// Every setting, including that of the case.
fn settings(inputs: &Inputs) -> Vec<Setting> {
    let (mut settings, current) = (Setting::all(inputs), Setting::of(inputs));
    if !settings.contains(&current) {
        settings.push(current);
    }
    settings
}

/// The finest setting of each method, and of the method and compliance of the case.
fn finest(inputs: &Inputs) -> Vec<Setting> {
    let mut settings: Vec<Setting> =
        METHODS.iter().map(|&method| Setting::usual(method, inputs).best()).collect();
    let own = Setting::of(inputs).best();
    if own.models.is_some() && own.method != Method::Auto && !settings.contains(&own) {
        settings.push(own);
    }
    settings
}

impl References {
    /// The reference, its check, and the finest setting of each method.
    fn find(
        inputs: &Inputs,
        parameters: &TradeParameters,
        planned: usize,
        go_on: &dyn Fn() -> bool,
    ) -> Result<(Trade, References), Refusal> {
        let (reference, truth) = stopped(reference(inputs, go_on))?.map_or_else(
            |refusal| (Err(refusal), None),
            |(reference, truth)| (Ok(reference), Some(Arc::new(truth))),
        );
        let (mut models, mut best) = (Vec::new(), Vec::new());
        for setting in finest(inputs) {
            let found = match (&reference, &truth) {
                (Ok(reference), Some(truth)) if setting == reference.setting => {
                    Some(Arc::clone(truth))
                }
                _ => stopped(answer_of(inputs, setting, go_on))?.ok().map(Arc::new),
            };
            let off = found
                .as_ref()
                .zip(truth.as_ref())
                .map_or(NO_DIFFERENCES, |(found, truth)| differences(found, truth));
            models.push(Model { setting, off, outcome: found.as_ref().map(|found| found.outcome) });
            best.extend(found.map(|found| (setting, found)));
        }
        // The capacity is exact, because a measurement stays in memory with its case.
        let settings = Vec::with_capacity(planned);
        let trade = Trade {
            within: parameters.within,
            planned,
            settings,
            part: 0.0,
            reference,
            models,
            build: Build::measure(inputs, parameters.patience),
            cheapest: None,
        };
        Ok((trade, References { truth, best }))
    }

    /// Errors of a setting, with a first time.
    fn measure(
        &self,
        inputs: &Inputs,
        setting: Setting,
        rounds: &mut Rounds<'_>,
    ) -> Result<MeasuredSetting, Refusal> {
        let found = rounds.first(setting)?.map(|(answer, time)| {
            let taken = setting.taken(inputs, answer.method);
            self.figures(&answer, taken, time)
        });
        let is_current = setting == Setting::of(inputs);
        Ok(MeasuredSetting { setting, is_current, found, is_on_front: false, qualifies: false })
    }

    fn figures(&self, answer: &Answer, taken: Setting, time: Time) -> Figures {
        let best = self.best.iter().find(|(setting, _)| setting.is_finer_or_coarser(&taken));
        let numerical = best.map_or(NO_DIFFERENCES, |(_, best)| differences(answer, best));
        let total = self.truth.as_ref().map_or(NO_DIFFERENCES, |truth| differences(answer, truth));
        Figures { taken, time, evaluations: answer.evaluations, numerical, total }
    }
}

/// Fraction of the progress for the first run of every setting.
const FIRST_LOOK: f64 = 0.2;

struct Rounds<'a> {
    inputs: &'a Inputs,
    patience: Patience,
    is_wanted: &'a dyn Fn() -> bool,
    timed: Vec<Timed>,
    begun: Instant,
    /// Total time of the first runs.
    first_look: Duration,
    done: u32,
}

/// A setting and its times, if it solves the case.
struct Timed {
    inputs: Inputs,
    batches: Option<Batches>,
}

impl<'a> Rounds<'a> {
    fn begin(
        inputs: &'a Inputs,
        patience: Patience,
        is_wanted: &'a dyn Fn() -> bool,
    ) -> Rounds<'a> {
        let begun = Instant::now();
        Rounds {
            inputs,
            patience,
            is_wanted,
            timed: Vec::new(),
            begun,
            first_look: Duration::ZERO,
            done: 0,
        }
    }

    /// Adds a setting: returns its answer and the time of one solve, or its refusal.
    fn first(&mut self, setting: Setting) -> Result<Result<(Answer, Time), Refusal>, Refusal> {
        if !(self.is_wanted)() {
            return Err(Refusal::Stopped);
        }
        let inputs = setting.inputs(self.inputs);
        let (mut batches, mut found) = (Batches::default(), None);
        batches.add(Duration::ZERO, || found.insert(solve(&inputs, self.is_wanted)).is_ok());
        let found = stopped(found.unwrap_or(Err(Refusal::Stopped)))?;
        let time = batches.time();
        self.timed.push(Timed { inputs, batches: time.is_some().then_some(batches) });
        self.first_look = self.begun.elapsed();
        Ok(found.and_then(|solution| Ok((Answer::of(&solution), time.ok_or(Refusal::Stopped)?))))
    }

    /// Whether to measure another round: a time is not steady yet, and the round ends within the
    /// time limit.
    fn go_on(&self) -> bool {
        let gone = self.begun.elapsed().saturating_sub(self.first_look);
        let round = if self.done == 0 { self.first_look } else { gone / self.done };
        let is_unsteady =
            |timed: &Timed| timed.batches.as_ref().is_some_and(|batches| !batches.are_steady());
        gone + round <= self.patience.most && self.timed.iter().any(is_unsteady)
    }

    /// Measures every setting once more; returns the times so far.
    fn round(&mut self) -> Result<Vec<Option<Time>>, Refusal> {
        self.done += 1;
        for Timed { inputs, batches } in &mut self.timed {
            let once = || {
                (self.is_wanted)() && black_box(solve(black_box(inputs), self.is_wanted)).is_ok()
            };
            if batches.as_mut().is_some_and(|batches| !batches.add(self.patience.batch, once)) {
                return Err(Refusal::Stopped);
            }
        }
        Ok(self.timed.iter().map(|timed| timed.batches.as_ref()?.time()).collect())
    }

    /// The progress, from 0 to 1, for a number of settings.
    fn part(&self, planned: usize) -> f64 {
        if self.timed.len() < planned {
            return FIRST_LOOK * self.timed.len() as f64 / planned as f64;
        }
        if !self.go_on() {
            return 1.0;
        }
        let gone = self.begun.elapsed().saturating_sub(self.first_look);
        let part = gone.as_secs_f64() / self.patience.most.as_secs_f64().max(1e-9);
        FIRST_LOOK + (1.0 - FIRST_LOOK) * part.min(1.0)
    }
}

/// The reference with its full answer.
fn reference(inputs: &Inputs, go_on: &dyn Fn() -> bool) -> Result<(Reference, Answer), Refusal> {
    let setting = Setting::usual(Method::Dynamic, inputs).best();
    let inputs = setting.inputs(inputs);
    let solution = solve(&inputs, go_on)?;
    let answer = Answer::of(&solution);
    let second = stopped(second::independent_solution(&inputs, &solution, go_on))?;
    let off = |second: second::Second| {
        Subject::ALL
            .map(|subject| relative_difference(second.value(subject), answer.value(subject)))
    };
    let disagreement = second.map(off);
    Ok((
        Reference {
            setting,
            values: Subject::ALL.map(|subject| answer.value(subject)),
            disagreement,
        },
        answer,
    ))
}

/// Relative difference of two results; `None` if one is absent.
fn relative_difference(second: Option<f64>, first: Option<f64>) -> Option<f64> {
    match (second?, first?) {
        // Also if both are 0.
        (second, first) if first.to_bits() == second.to_bits() => Some(0.0),
        (second, first) => Some(((second - first) / first).abs()),
    }
}

fn differences(answer: &Answer, truth: &Answer) -> Differences {
    Subject::ALL.map(|subject| answer.off(truth, subject))
}

fn answer_of(
    inputs: &Inputs,
    setting: Setting,
    go_on: &dyn Fn() -> bool,
) -> Result<Answer, Refusal> {
    solve(&setting.inputs(inputs), go_on).map(|solution| Answer::of(&solution))
}

/// Passes on a stop as an error, and any other refusal as a result.
fn stopped<T>(found: Result<T, Refusal>) -> Result<Result<T, Refusal>, Refusal> {
    match found {
        Err(Refusal::Stopped) => Err(Refusal::Stopped),
        other => Ok(other),
    }
}

/// A result that several methods compute, each as a quantity of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Driven gear's angle before E at the first contact.
    FirstContact,
    /// Greatest force of the incoming tooth.
    PeakForce,
    /// Greatest force of the incoming tooth before E.
    PeakApproachForce,
    /// Duration of the first impact.
    Duration,
    /// The kinematic friction ratio.
    FrictionRatio,
    /// The force over the driver's roll angle from D to E.
    Curve,
}

impl Subject {
    /// Every subject, in order.
    pub const ALL: [Subject; 6] = [
        Subject::FirstContact,
        Subject::PeakForce,
        Subject::PeakApproachForce,
        Subject::Duration,
        Subject::FrictionRatio,
        Subject::Curve,
    ];
    /// The subjects that a setting must answer to qualify.
    pub const NEEDED: [Subject; 3] = [Subject::FirstContact, Subject::PeakForce, Subject::Curve];

    /// The name in JSON.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Subject::FirstContact => "first_contact_angle",
            Subject::PeakForce => "peak_force",
            Subject::PeakApproachForce => "peak_approach_force",
            Subject::Duration => "impact_duration",
            Subject::FrictionRatio => "friction_ratio",
            Subject::Curve => "curve",
        }
    }

    /// The label of the subject.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Subject::FirstContact => "first contact angle",
            Subject::PeakForce => "peak force",
            Subject::PeakApproachForce => "peak force before E",
            Subject::Duration => "duration of the impact",
            Subject::FrictionRatio => "friction ratio",
            Subject::Curve => "force from D to E",
        }
    }

    /// The quantity of a method for this subject; `None` for the curve, and if the method has no
    /// such quantity.
    #[must_use]
    pub fn quantity(self, method: Method) -> Option<&'static Quantity> {
        let free = match self {
            Subject::FirstContact => "approach_angle_driven",
            Subject::PeakForce | Subject::PeakApproachForce => "impact_force",
            Subject::Duration => "impact_duration",
            Subject::FrictionRatio => "friction_ratio",
            Subject::Curve => return None,
        };
        match (self, method) {
            (Subject::PeakForce, Method::Static) => Quantity::find("static_peak_force"),
            (Subject::PeakForce, Method::Dynamic) => Quantity::find("dynamic_peak_force"),
            _ => Quantity::find(free)?.by(method),
        }
    }

    /// Whether the method computes the subject.
    #[must_use]
    pub fn is_of(self, method: Method) -> bool {
        self == Subject::Curve || self.quantity(method).is_some()
    }
}

/// The answer of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The method of the solve; for `auto`, the chosen method.
    pub method: Method,
    /// Whether the tooth strikes.
    pub outcome: Outcome,
    /// Values of [`Subject::quantity`], in SI, in the order of [`Subject::ALL`].
    values: [Option<f64>; Subject::ALL.len()],
    /// Driver's angle before E in rad and force in N, from the first contact to E.
    curve: Vec<(f64, f64)>,
    /// Evaluations of the motion in method `dynamic`, see
    /// [`Effort`](crate::model::dynamic::Effort).
    pub evaluations: Option<u64>,
}

/// The stages that the answer of a method needs.
#[must_use]
pub fn stages(method: Method) -> Stages {
    match method {
        Method::Paper | Method::Exact => Stages::CLOSED_FORM.with(Stage::Stations),
        Method::Static => Stages::of(Stage::Static),
        Method::Dynamic => Stages::of(Stage::Dynamic),
        // `static` replaces `dynamic` if `auto` chooses it.
        Method::Auto => Stages::CLOSED_FORM.with(Stage::Stations).and(Stages::of(Stage::Dynamic)),
    }
}

/// Solves the stages of the answer only.
///
/// # Errors
/// The refusal, also if a part of the answer is withheld; [`Refusal::Stopped`] if `go_on` returns
/// false.
fn solve(inputs: &Inputs, go_on: &dyn Fn() -> bool) -> Result<Solution, Refusal> {
    let solution = model::solve_while(inputs, stages(inputs.method), &|_| go_on())?;
    match solution.withheld.or(solution.stations_withheld) {
        Some(refusal) => Err(refusal),
        None => Ok(solution),
    }
}

impl Answer {
    /// The answer of a solve.
    #[must_use]
    pub fn of(solution: &Solution) -> Answer {
        let value = |subject: Subject| {
            subject.quantity(solution.method).and_then(|quantity| (quantity.value)(solution))
        };
        Answer {
            method: solution.method,
            outcome: solution.outcome,
            values: Subject::ALL.map(value),
            curve: curve(solution),
            evaluations: solution.dynamic.as_ref().map(|dynamic| dynamic.effort.evaluations),
        }
    }

    /// The value in SI, if any.
    #[must_use]
    pub fn value(&self, subject: Subject) -> Option<f64> {
        self.values[subject as usize]
    }

    /// The error of this answer, relative to `truth`; `None` if one of the methods has no such
    /// quantity. If neither finds a strike the error is 0; if only one does, it is 1.
    #[must_use]
    pub fn off(&self, truth: &Answer, subject: Subject) -> Option<f64> {
        if !(subject.is_of(self.method) && subject.is_of(truth.method)) {
            return None;
        }
        if subject == Subject::Curve {
            return Some(self.curve_error(truth));
        }
        match (self.value(subject), truth.value(subject)) {
            (Some(found), Some(expected)) => Some(relative(found - expected, expected)),
            (None, None) => Some(0.0),
            _ if self.outcome == truth.outcome && self.outcome == Outcome::NoCornerContact => {
                Some(0.0)
            }
            _ => Some(1.0),
        }
    }

    /// The greatest difference of the forces over the driver's roll angle from the earlier first
    /// contact to E, over the true peak. With linear interpolation the greatest difference is at a
    /// station of one of the curves.
    fn curve_error(&self, truth: &Answer) -> f64 {
        let angles = self.curve.iter().chain(&truth.curve).map(|&(angle, _)| angle);
        let apart = angles
            .map(|angle| (self.force_at(angle) - truth.force_at(angle)).abs())
            .fold(0.0, f64::max);
        match (self.outcome, truth.outcome) {
            (Outcome::NoCornerContact, Outcome::NoCornerContact) => 0.0,
            (Outcome::CornerContact, Outcome::CornerContact) => {
                relative(apart, truth.value(Subject::PeakForce).unwrap_or_default())
            }
            _ => 1.0,
        }
    }

    /// The force at the driver's angle before E, by linear interpolation between stations; 0 before
    /// the first contact.
    #[must_use]
    pub fn force_at(&self, angle: f64) -> f64 {
        /// First contacts that differ by no more than rounding are equal.
        const ROUNDING: f64 = 1e-9;
        let next = self.curve.partition_point(|station| station.0 > angle);
        match (next.checked_sub(1).map(|before| self.curve[before]), self.curve.get(next)) {
            (Some(before), Some(&after)) => {
                before.1 + (after.1 - before.1) * (before.0 - angle) / (before.0 - after.0)
            }
            (None, Some(&first)) if angle <= first.0 * (1.0 + ROUNDING) => first.1,
            (None, _) => 0.0,
            (Some(last), None) => last.1,
        }
    }
}

/// The force from the first contact to E.
fn curve(solution: &Solution) -> Vec<(f64, f64)> {
    let shared = match solution.method {
        Method::Paper | Method::Exact | Method::Auto => {
            return solution
                .stations
                .iter()
                .map(|station| (station.roll_angle_driver, station.impact_force))
                .collect();
        }
        Method::Static => solution.static_load.as_ref().map(|load| &load.stations),
        Method::Dynamic => solution.dynamic.as_ref().map(|dynamic| &dynamic.stations),
    };
    let before_end =
        shared.into_iter().flatten().filter(|station| station.roll_angle_driver >= 0.0);
    before_end.map(|station| (station.roll_angle_driver, station.force)).collect()
}

/// A difference over a size; 1 if the size is 0.
fn relative(difference: f64, size: f64) -> f64 {
    if difference == 0.0 {
        return 0.0;
    }
    let relative = (difference / size).abs();
    if relative.is_finite() { relative } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    fn answer(method: Method, stations: usize) -> Answer {
        let inputs =
            Inputs { method, stations: Some(stations), ..Case::table_1().inputs().unwrap() };
        Answer::of(&solve(&inputs, &|| true).unwrap())
    }

    #[test]
    fn a_curve_is_interpolated_linearly_and_is_zero_before_the_first_contact() {
        let shared = answer(Method::Static, 4);
        let (first, second) = (shared.curve[0], shared.curve[1]);
        assert_eq!((shared.curve.len(), shared.curve[4].0), (5, 0.0));
        assert!(
            (shared.force_at(f64::midpoint(first.0, second.0)) - f64::midpoint(first.1, second.1))
                .abs()
                < 1e-9
        );
        assert!(
            (shared.force_at(0.0) - shared.value(Subject::PeakApproachForce).unwrap()).abs() < 1e-9
        );
        assert!(shared.force_at(1.01 * first.0).abs() < f64::MIN_POSITIVE);
        let impact = answer(Method::Exact, 4);
        assert_eq!(
            Some(impact.force_at(impact.curve[0].0 * (1.0 + 1e-15))),
            impact.value(Subject::PeakForce)
        );
    }

    #[test]
    fn an_answer_differs_from_others_and_not_from_itself() {
        let (shared, impact) = (answer(Method::Static, 16), answer(Method::Exact, 16));
        for subject in Subject::ALL {
            assert_eq!(shared.off(&shared, subject), subject.is_of(Method::Static).then_some(0.0));
        }
        assert_eq!(impact.off(&shared, Subject::Duration), None);
        assert!(impact.off(&shared, Subject::Curve).unwrap() > 0.5);
        let on_time = Answer {
            outcome: Outcome::NoCornerContact,
            values: [None; 6],
            curve: Vec::new(),
            ..impact.clone()
        };
        assert_eq!(on_time.off(&shared, Subject::FirstContact), Some(1.0));
        assert_eq!(on_time.off(&shared, Subject::Curve), Some(1.0));
        let also = Answer { outcome: Outcome::NoCornerContact, ..shared };
        assert!(Subject::NEEDED.iter().all(|&subject| on_time.off(&also, subject) == Some(0.0)));
    }
}
