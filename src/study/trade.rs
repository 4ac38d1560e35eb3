//! Speed against accuracy: every method by several settings and with every compliance, each timed
//! and compared with one reference.

mod answer;
mod build;
mod clock;
mod results;
mod rounds;
mod second;
mod setting;

use std::sync::Arc;

pub use answer::{Answer, Subject, stages};
pub use build::Build;
pub use clock::{Patience, Time};
pub use results::{Differences, Figures, Measured, Model, Reference, Trade, greatest};
pub use setting::{METHODS, STATIONS, Setting};

use crate::model::inputs::Method;
use crate::model::{Inputs, Refusal};
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

const NO_DIFFERENCES: Differences = [None; Subject::ALL.len()];

/// The answers with which the others are compared, with their curves: they are needed while it is
/// measured, and no longer.
struct Standards {
    truth: Option<Arc<Answer>>,
    /// Best settings with their answers.
    best: Vec<(Setting, Arc<Answer>)>,
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

/// The reference and its whole answer.
fn reference(inputs: &Inputs, go_on: &dyn Fn() -> bool) -> Result<(Reference, Answer), Refusal> {
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

/// Two findings of one quantity: how far they lie apart, nothing where there is none.
fn apart(second: Option<f64>, first: Option<f64>) -> Option<f64> {
    match (second?, first?) {
        // Both 0 as well.
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
    answer::solve(&setting.inputs(inputs), go_on).map(|solution| Answer::of(&solution))
}

/// A refusal is a finding; to be stopped is not.
fn stopped<T>(found: Result<T, Refusal>) -> Result<Result<T, Refusal>, Refusal> {
    match found {
        Err(Refusal::Stopped) => Err(Refusal::Stopped),
        other => Ok(other),
    }
}
