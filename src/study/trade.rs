//! Speed against accuracy: every method by several settings and with every compliance, each timed
//! and compared with one reference.

mod answer;
mod build;
mod clock;
mod rounds;
mod second;
mod setting;

use std::sync::Arc;

pub use answer::{Answer, Subject, stages};
pub use build::Build;
pub use clock::{Patience, Time};
pub use setting::{METHODS, STATIONS, Setting};

use crate::model::inputs::Method;
use crate::model::stiffness_spread::StiffnessModels;
use crate::model::{Inputs, Outcome, Refusal, auto};
use rounds::Rounds;

/// What a trade is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// The error that a setting may have, relative to the reference; what the method `auto` may
    /// leave as well.
    pub within: f64,
    /// How long each setting is timed.
    pub patience: Patience,
}

/// The methods and their settings, measured on one case.
#[derive(Debug, Clone)]
pub struct Trade {
    /// The error that a setting may have.
    pub within: f64,
    /// How many settings there will be.
    pub planned: usize,
    /// Those that are measured so far.
    pub settings: Vec<Measured>,
    /// How much of the measurement is done, from 0 to 1.
    pub part: f64,
    /// What they are held against, or why there is nothing.
    pub reference: Result<Reference, Refusal>,
    /// The best setting of each method and compliance whose fineness varies, against the
    /// reference: what its physics leaves out.
    pub models: Vec<Model>,
    /// Time of the fields that the reference reads, or why it reads none.
    pub build: Result<Build, Refusal>,
    /// The place of the cheapest setting that qualifies.
    pub cheapest: Option<usize>,
}

/// The answer of the method `dynamic` with the finest setting, by the compliance of a case that
/// names none: the elastic field, where both gears have one.
#[derive(Debug, Clone)]
pub struct Reference {
    /// How it was found.
    pub setting: Setting,
    /// What it finds, in SI, in the order of [`Subject::ALL`].
    pub values: [Option<f64>; Subject::ALL.len()],
    /// How far a second way, that shares the mesh alone, is from it, in the order of
    /// [`Subject::ALL`]; or why it is not known.
    pub disagreement: Result<Differences, Refusal>,
}

/// Relative differences in the order of [`Subject::ALL`], where there are any.
pub type Differences = [Option<f64>; Subject::ALL.len()];

const NO_DIFFERENCES: Differences = [None; Subject::ALL.len()];

/// The answers that the others are held against, with their curves: they are needed while it is
/// measured, and no longer.
struct Standards {
    truth: Option<Arc<Answer>>,
    /// Best settings with their answers.
    best: Vec<(Setting, Arc<Answer>)>,
}

/// What a method's physics leaves out.
#[derive(Debug, Clone)]
pub struct Model {
    /// Its best setting.
    pub setting: Setting,
    /// How far its best setting is from the reference.
    pub off: Differences,
    /// Whether the tooth strikes by its best setting, where that solves the case.
    pub outcome: Option<Outcome>,
}

/// A setting with its time and errors.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The setting.
    pub setting: Setting,
    /// Whether it is the case's own.
    pub is_current: bool,
    /// What was measured, or why it does not solve the case.
    pub found: Result<Figures, Refusal>,
    /// Whether no other setting is both as quick and as near to the reference.
    pub is_on_front: bool,
    /// Whether it is within what was asked.
    pub qualifies: bool,
}

/// Time and errors.
#[derive(Debug, Clone)]
pub struct Figures {
    /// The setting of the answer: another one where the method `auto` chose.
    pub taken: Setting,
    /// Of a whole solve, as far as the answer needs it.
    pub time: Time,
    /// What the motion took in the method `dynamic`, see [`Effort`](crate::model::dynamic::Effort).
    pub evaluations: Option<u64>,
    /// Against the same method by its best setting.
    pub numerical: Differences,
    /// Against the reference.
    pub total: Differences,
}

/// The greatest of the differences there are.
#[must_use]
pub fn greatest(differences: &Differences) -> Option<f64> {
    differences.iter().flatten().copied().reduce(f64::max)
}

/// Measure every setting on the case: first its errors, then all their times in rounds, until the
/// median of each is steady. `show` receives the results after each setting and each round.
///
/// # Errors
/// [`Refusal::Stopped`] where `go_on` says no; the model's refusal where no method at all can be
/// computed.
pub fn trade(
    inputs: &Inputs,
    question: &Question,
    go_on: &dyn Fn() -> bool,
    show: &mut dyn FnMut(&Trade),
) -> Result<Trade, Refusal> {
    let inputs = &Inputs {
        within: question.within,
        ..inputs.clone()
    };
    let settings = settings(inputs);
    let (mut trade, standards) = Standards::find(inputs, question, settings.len(), go_on)?;
    show(&trade);
    let mut rounds = Rounds::begin(inputs, question.patience, go_on);
    for setting in settings {
        let measured = standards.measure(inputs, setting, &mut rounds)?;
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
    let refusals = trade
        .settings
        .iter()
        .map(|measured| measured.found.as_ref().err());
    match refusals.collect::<Option<Vec<_>>>() {
        Some(refusals) if !refusals.is_empty() => Err(*refusals[0]),
        _ => Ok(trade),
    }
}

/// Every setting, the case's own among them.
fn settings(inputs: &Inputs) -> Vec<Setting> {
    let (mut settings, current) = (Setting::all(inputs), Setting::of(inputs));
    if !settings.contains(&current) {
        settings.push(current);
    }
    settings
}

/// The best setting of each method, and of the case's own method and compliance.
fn finest(inputs: &Inputs) -> Vec<Setting> {
    let mut settings: Vec<Setting> = METHODS
        .iter()
        .map(|&method| Setting::usual(method, inputs).best())
        .collect();
    let own = Setting::of(inputs).best();
    if own.models.is_some() && own.method != Method::Auto && !settings.contains(&own) {
        settings.push(own);
    }
    settings
}

impl Standards {
    /// The reference, its check, and the best of each method.
    fn find(
        inputs: &Inputs,
        question: &Question,
        planned: usize,
        go_on: &dyn Fn() -> bool,
    ) -> Result<(Trade, Standards), Refusal> {
        let (reference, truth) = stopped(Reference::of(inputs, go_on))?.map_or_else(
            |refusal| (Err(refusal), None),
            |(reference, truth)| (Ok(reference), Some(Arc::new(truth))),
        );
        let (mut models, mut best) = (Vec::new(), Vec::new());
        for setting in finest(inputs) {
            let found = match (&reference, &truth) {
                (Ok(reference), Some(truth)) if setting == reference.setting => {
                    Some(Arc::clone(truth))
                }
                _ => stopped(answer_of(inputs, setting, go_on))?
                    .ok()
                    .map(Arc::new),
            };
            let off = found
                .as_ref()
                .zip(truth.as_ref())
                .map_or(NO_DIFFERENCES, |(found, truth)| differences(found, truth));
            models.push(Model {
                setting,
                off,
                outcome: found.as_ref().map(|found| found.outcome),
            });
            best.extend(found.map(|found| (setting, found)));
        }
        // A measurement is kept with its case: it has room for what it will hold, and no more.
        let settings = Vec::with_capacity(planned);
        let trade = Trade {
            within: question.within,
            planned,
            settings,
            part: 0.0,
            reference,
            models,
            build: Build::measure(inputs, question.patience),
            cheapest: None,
        };
        Ok((trade, Standards { truth, best }))
    }

    /// Errors of a setting, and a first look at its time.
    fn measure(
        &self,
        inputs: &Inputs,
        setting: Setting,
        rounds: &mut Rounds<'_>,
    ) -> Result<Measured, Refusal> {
        let found = rounds.first(setting)?.map(|(answer, time)| {
            let taken = setting.taken(inputs, answer.method);
            self.figures(&answer, taken, time)
        });
        let is_current = setting == Setting::of(inputs);
        Ok(Measured {
            setting,
            is_current,
            found,
            is_on_front: false,
            qualifies: false,
        })
    }

    fn figures(&self, answer: &Answer, taken: Setting, time: Time) -> Figures {
        let best = self
            .best
            .iter()
            .find(|(setting, _)| setting.is_finer_or_coarser(&taken));
        let numerical = best.map_or(NO_DIFFERENCES, |(_, best)| differences(answer, best));
        let total = self
            .truth
            .as_ref()
            .map_or(NO_DIFFERENCES, |truth| differences(answer, truth));
        Figures {
            taken,
            time,
            evaluations: answer.evaluations,
            numerical,
            total,
        }
    }
}

impl Trade {
    /// How far the best setting of the same method and compliance is from the reference.
    #[must_use]
    pub fn model(&self, setting: &Setting) -> Option<&Model> {
        self.models
            .iter()
            .find(|model| model.setting.is_finer_or_coarser(setting))
    }

    /// The compliances that are compared, that of the reference first.
    #[must_use]
    pub fn compliances(&self) -> Vec<StiffnessModels> {
        let mut found: Vec<StiffnessModels> = Vec::new();
        let reference = self.reference.as_ref().ok();
        let of_settings = self.settings.iter().map(|measured| measured.setting.models);
        for models in reference
            .map(|reference| reference.setting.models)
            .into_iter()
            .chain(of_settings)
            .flatten()
        {
            if !found.contains(&models) {
                found.push(models);
            }
        }
        found
    }

    /// The setting of a method and compliance that a case has which names both alone.
    #[must_use]
    pub fn usual(&self, method: Method, models: StiffnessModels) -> Option<&Measured> {
        self.settings.iter().find(|measured| {
            let setting = &measured.setting;
            *setting == setting.usual_fineness()
                && setting.method == method
                && setting.models == Some(models)
        })
    }

    /// The cheapest setting that qualifies, or none where no method finds corner contact: there is
    /// no force whose error a setting could reduce.
    #[must_use]
    pub fn recommended(&self) -> Option<&Measured> {
        let cheapest = self.cheapest.filter(|_| !self.is_without_contact());
        cheapest.and_then(|at| self.settings.get(at))
    }

    /// Whether every method that solves the case finds no corner contact.
    #[must_use]
    pub fn is_without_contact(&self) -> bool {
        let mut outcomes = self
            .models
            .iter()
            .filter_map(|model| model.outcome)
            .peekable();
        outcomes.peek().is_some() && outcomes.all(|outcome| outcome == Outcome::NoCornerContact)
    }

    /// Mark who qualifies, who stands on the front, and who is the cheapest, by the times and
    /// errors that stand there.
    pub fn judge(&mut self) {
        let points: Vec<Option<(f64, f64)>> = self.settings.iter().map(Measured::point).collect();
        for (measured, point) in self.settings.iter_mut().zip(&points) {
            measured.qualifies = measured.is_within(self.within);
            measured.is_on_front = point.is_some_and(|point| {
                !points
                    .iter()
                    .flatten()
                    .any(|other| dominates(other, &point))
            });
        }
        self.cheapest = self.find_cheapest();
    }

    /// The cheapest setting that qualifies of the methods among which `auto` chooses: what that
    /// takes is one of the others, and `paper` is the print, which says no more than `exact` even
    /// where nothing strikes. Of those whose times do not differ measurably, the most accurate.
    fn find_cheapest(&self) -> Option<usize> {
        let best = self.cheapest_where(|_| true)?;
        self.settings
            .iter()
            .position(|measured| std::ptr::eq(measured, best))
    }

    /// The cheapest of some settings that qualifies, see [`Trade::cheapest`].
    #[must_use]
    pub fn cheapest_where(&self, admitted: impl Fn(&Setting) -> bool) -> Option<&Measured> {
        let is_candidate = |measured: &&Measured| {
            measured.qualifies
                && auto::METHODS.contains(&measured.setting.method)
                && admitted(&measured.setting)
        };
        let candidates = || self.settings.iter().filter(is_candidate);
        let quickest =
            candidates().min_by(|one, other| one.seconds().total_cmp(&other.seconds()))?;
        let tied = candidates().filter(|measured| measured.ties(quickest));
        let error = |measured: &Measured| measured.total().unwrap_or(f64::INFINITY);
        tied.min_by(|one, other| error(one).total_cmp(&error(other)))
    }
}

impl Measured {
    /// Time of a solve in s; infinite where there is none.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.found
            .as_ref()
            .map_or(f64::INFINITY, |figures| figures.time.seconds)
    }

    /// The greatest total error, where the setting answers all that is needed.
    #[must_use]
    pub fn total(&self) -> Option<f64> {
        let figures = self.found.as_ref().ok()?;
        let answers = Subject::NEEDED
            .iter()
            .all(|&subject| figures.total[subject as usize].is_some());
        greatest(&figures.total).filter(|_| answers)
    }

    /// Whether the measurements do not show which of the two is faster.
    fn ties(&self, other: &Measured) -> bool {
        let time = |measured: &Measured| measured.found.as_ref().ok().map(|figures| figures.time);
        time(self)
            .zip(time(other))
            .is_some_and(|(one, other)| one.ties(&other))
    }

    /// Error and time.
    fn point(&self) -> Option<(f64, f64)> {
        self.total().map(|total| (total, self.seconds()))
    }

    fn is_within(&self, within: f64) -> bool {
        self.total().is_some_and(|total| total <= within)
    }
}

impl Reference {
    /// The reference and its whole answer.
    fn of(inputs: &Inputs, go_on: &dyn Fn() -> bool) -> Result<(Reference, Answer), Refusal> {
        let setting = Setting::usual(Method::Dynamic, inputs).best();
        let inputs = setting.inputs(inputs);
        let solution = answer::solve(&inputs, go_on)?;
        let answer = Answer::of(&solution);
        let second = stopped(second::second_way(&inputs, &solution, go_on))?;
        let off = |second: second::Second| {
            Subject::ALL.map(|subject| apart(second.value(subject), answer.value(subject)))
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
}

/// Two findings of one quantity: how far they lie apart, nothing where there is none.
fn apart(second: Option<f64>, first: Option<f64>) -> Option<f64> {
    match (second?, first?) {
        // Both 0 as well.
        (second, first) if first.to_bits() == second.to_bits() => Some(0.0),
        (second, first) => Some(((second - first) / first).abs()),
    }
}

/// One is nowhere worse than the other and somewhere better.
fn dominates(one: &(f64, f64), other: &(f64, f64)) -> bool {
    one.0 <= other.0 && one.1 <= other.1 && one != other
}

fn differences(answer: &Answer, truth: &Answer) -> Differences {
    Subject::ALL.map(|subject| answer.off(truth, subject))
}

fn answer_of(
    inputs: &Inputs,
    setting: Setting,
    go_on: &dyn Fn() -> bool,
) -> Result<Answer, Refusal> {
    answer::solve(&setting.inputs(inputs), go_on).map(|solution| Answer::of(&solution))
}

/// A refusal is a finding; to be stopped is not.
fn stopped<T>(found: Result<T, Refusal>) -> Result<Result<T, Refusal>, Refusal> {
    match found {
        Err(Refusal::Stopped) => Err(Refusal::Stopped),
        other => Ok(other),
    }
}
