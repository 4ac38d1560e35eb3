//! Run time against accuracy: every method with several settings and every compliance, each timed
//! and compared with one reference.

mod answer;
mod clock;
mod results;
mod second;

use std::sync::Arc;

pub use answer::{Answer, Subject, stages};
pub use clock::{Build, Patience, Time};
pub use results::{
    Differences, Figures, METHODS, MeasuredSetting, Model, Reference, STATIONS, Setting, Trade,
    greatest,
};

use crate::model::inputs::Method;
use crate::model::{Inputs, Refusal};
use clock::Rounds;

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

/// The reference with its full answer.
fn reference(inputs: &Inputs, go_on: &dyn Fn() -> bool) -> Result<(Reference, Answer), Refusal> {
    let setting = Setting::usual(Method::Dynamic, inputs).best();
    let inputs = setting.inputs(inputs);
    let solution = answer::solve(&inputs, go_on)?;
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
    answer::solve(&setting.inputs(inputs), go_on).map(|solution| Answer::of(&solution))
}

/// Passes on a stop as an error, and any other refusal as a result.
fn stopped<T>(found: Result<T, Refusal>) -> Result<Result<T, Refusal>, Refusal> {
    match found {
        Err(Refusal::Stopped) => Err(Refusal::Stopped),
        other => Ok(other),
    }
}
