//! The stages that read a field, and the fields that a quantity depends on, found by changes of the
//! fields.

use std::borrow::Cow;

use super::fields::{Kind, Range, Reason};
use super::units::{self, Dimension};
use super::{Case, FIELDS, Problem, check};
use crate::model::compliance::{model_of, without_field};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Stage, Stages};

/// A field that a quantity depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Dependence {
    /// The index of the field in [`FIELDS`].
    pub field: usize,
    /// A small step of a number field.
    pub step: Option<Step>,
}

/// A small step of a field.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The step, such as `+1 um`.
    pub text: &'static str,
    /// The quantity after the step, in SI, if it has a value.
    pub value: Option<f64>,
}

/// The fields that a quantity depends on, in the order of the form: fields that a stage of the
/// quantity reads and whose change alters `own`, the value of the quantity with these inputs. A
/// flag, and a quantity without a value, depend on every field that these stages read.
#[must_use]
pub fn fields_of(
    quantity: &Quantity,
    case: &Case,
    inputs: &Inputs,
    own: Option<f64>,
) -> Vec<Dependence> {
    let behind = Stages::of(quantity.stage);
    let is_behind = |&field: &usize| stages_of(field, inputs).within(behind) != Stages::NONE;
    let quick = quickest_of(quantity, inputs, own);
    let dependence = |field| {
        let small = small_step(field, case, &quick);
        let after = small.as_ref().map(|(_, inputs)| Outcome::of(quantity, inputs));
        let moves = own.is_none()
            || quantity.is_flag()
            || after.is_some_and(|after| after.differs(own) == Some(true))
            || is_moved(quantity, own, field, case, &quick)
                .or_else(|| is_moved_freely(quantity, field, case, &quick))
                .unwrap_or_default();
        let step = small.zip(after).map(|((text, _), after)| Step { text, value: after.value() });
        moves.then_some(Dependence { field, step })
    };
    (0..FIELDS.len())
        .filter(|&field| !case.is_replaced(field))
        .filter(is_behind)
        .filter_map(dependence)
        .collect()
}

/// The inputs with a quick tooth compliance if the quantity does not depend on the tooth
/// compliance, otherwise the same inputs. An elastic field for every changed gear takes longer than
/// all other stages.
fn quickest_of(quantity: &Quantity, inputs: &Inputs, own: Option<f64>) -> Inputs {
    // A flag or a value of 0 can agree by chance.
    let is_telling = !quantity.is_flag() && own.is_some_and(|own| own != 0.0);
    let quick = without_field(inputs)
        .filter(|_| is_telling)
        .map(|tooth| Inputs { tooth_compliance: Some(tooth), ..inputs.clone() });
    let is_same = |quick: &Inputs| Outcome::of(quantity, quick).differs(own) == Some(false);
    quick.filter(is_same).unwrap_or_else(|| inputs.clone())
}

/// The value of a quantity with these inputs, in SI.
#[must_use]
pub fn value_of(quantity: &Quantity, inputs: &Inputs) -> Option<f64> {
    Outcome::of(quantity, inputs).value()
}

/// The result for a quantity with changed inputs.
#[derive(Clone, Copy)]
enum Outcome {
    /// The pair cannot be solved.
    Refused,
    /// The value, if the quantity has one.
    Solved(Option<f64>),
}

impl Outcome {
    fn of(quantity: &Quantity, inputs: &Inputs) -> Outcome {
        let solution = model::solve(inputs, Stages::of(quantity.stage));
        solution.map_or(Outcome::Refused, |solution| {
            Outcome::Solved((quantity.value)(&solution).filter(|value| value.is_finite()))
        })
    }

    fn value(self) -> Option<f64> {
        match self {
            Outcome::Refused => None,
            Outcome::Solved(value) => value,
        }
    }

    /// Whether the value differs in any bit, ignoring the sign of zero. `None` if the pair cannot
    /// be solved.
    fn differs(self, own: Option<f64>) -> Option<bool> {
        let bits = |value: Option<f64>| value.map(|value| (value + 0.0).to_bits());
        match self {
            Outcome::Refused => None,
            Outcome::Solved(value) => Some(bits(value) != bits(own)),
        }
    }
}

/// A step that is small for the field, and the inputs after it.
fn small_step(field: usize, case: &Case, inputs: &Inputs) -> Option<(&'static str, Inputs)> {
    let now = case.value(field)?;
    let mut inputs = inputs.clone();
    let text = match FIELDS[field].kind {
        Kind::Count(_, _, put) => {
            put(&mut inputs, now as u32 + 1);
            "+1"
        }
        Kind::Number(dimension, range, put) => {
            let (text, to) = match (dimension, range.unit) {
                (_, "um") => ("+1 um", now + 1e-6),
                (Dimension::Number, _) => ("+0.01", now + 0.01),
                (Dimension::Length, _) if now == 0.0 => ("+0.1 mm", 0.1e-3),
                _ => ("+1 %", 1.01 * now),
            };
            put(&mut inputs, to);
            text
        }
        Kind::Text | Kind::Choice(..) => return None,
    };
    Some((text, inputs))
}

/// Whether a larger change of a field alters a quantity. `None` if no changed pair can be solved.
fn is_moved(
    quantity: &Quantity,
    own: Option<f64>,
    field: usize,
    case: &Case,
    inputs: &Inputs,
) -> Option<bool> {
    let moved = |put: &dyn Fn(&mut Inputs)| {
        let mut other = inputs.clone();
        put(&mut other);
        Outcome::of(quantity, &other).differs(own)
    };
    match FIELDS[field].kind {
        Kind::Text => Some(false),
        Kind::Choice(names, put) => any((0..names.len()).map(|at| moved(&|other| put(other, at)))),
        Kind::Count(from, _, put) => {
            let now = case.value(field).unwrap_or_default() as u32;
            let counts = [from, now + 1, now + now / 2, 2 * now].into_iter();
            any(counts.map(|count| moved(&|other| put(other, count))))
        }
        Kind::Number(dimension, range, put) => {
            let numbers = other_numbers(field, (dimension, range), case, inputs).into_iter();
            any(numbers.map(|number| moved(&|other| put(other, number))))
        }
    }
}

/// Whether any answer is true. `None` without answers.
fn any(answers: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut known = None;
    for answer in answers.flatten() {
        known = Some(answer);
        if answer {
            break;
        }
    }
    known
}

/// [`is_moved`] without the given centre distance, which fits only the present gears.
fn is_moved_freely(
    quantity: &Quantity,
    field: usize,
    case: &Case,
    inputs: &Inputs,
) -> Option<bool> {
    let free = Inputs { centre_distance: None, ..inputs.clone() };
    inputs.centre_distance.filter(|_| quantity.key != "centre_distance")?;
    is_moved(quantity, value_of(quantity, &free), field, case, &free)
}

/// Numbers, in SI, to try in a field: near its value, otherwise near the quantity of the same name,
/// and an example.
fn other_numbers(
    field: usize,
    (dimension, range): (Dimension, Range),
    case: &Case,
    inputs: &Inputs,
) -> Vec<f64> {
    /// Factors for a centre distance and for other numbers that usually leave a valid pair.
    const FACTORS: [f64; 4] = [1.0002, 1.02, 0.8, 1.25];
    const EXAMPLES: [f64; 4] = [1.0, 0.2, 1.5, 30.0];
    /// Part of the range for a field with the value 0.
    const SHARE: f64 = 1e-3;
    let known = &FIELDS[field];
    let now = case.value(field).or_else(|| {
        let quantity = Quantity::find(known.name())?;
        value_of(quantity, inputs)
    });
    let Some(now) = now else {
        let example = units::parse(known.example(), dimension, range.unit);
        let times = |example| EXAMPLES.map(|times| times * example);
        return example.map_or_else(|_| Vec::new(), |example| times(example).into());
    };
    let mut numbers: Vec<f64> = FACTORS.map(|times| times * now).into();
    numbers.push(within(range, SHARE));
    numbers
}

/// The number, in SI, at a part of a range.
fn within(range: Range, share: f64) -> f64 {
    let factor = units::factor(range.unit).unwrap_or(1.0);
    factor * (range.from + share * (range.to - range.from))
}

/// The stages that read a field in a case with these inputs: the stages whose inputs change, or
/// that no longer run, if the field has another value.
#[must_use]
pub fn stages_of(field: usize, inputs: &Inputs) -> Stages {
    let others = with_other_values(field, inputs);
    let reads = |stage: &Stage| {
        others.iter().any(|other| {
            !stage.has_equal_inputs(inputs, other) || !other.method.stages().has(*stage)
        })
    };
    let stages = inputs.method.stages().iter().filter(reads);
    stages.fold(Stages::NONE, Stages::with)
}

/// Whether any stage reads a field in a case with these inputs.
#[must_use]
pub fn is_read(field: usize, inputs: &Inputs) -> bool {
    stages_of(field, inputs) != Stages::NONE
}

/// The inputs with other values in a field. At least one value differs from the present value.
fn with_other_values(field: usize, inputs: &Inputs) -> Vec<Inputs> {
    /// Parts of the range: the least value, because the smaller of two values can decide, and two
    /// unusual values.
    const SHARES: [f64; 3] = [0.0, 0.381_966, 0.618_034];
    // Every stage that reads the tooth model also reads the fields that decide its range.
    let held = Inputs { tooth_compliance: Some(model_of(inputs)), ..inputs.clone() };
    let with = move |put: &dyn Fn(&mut Inputs)| {
        let mut other = held.clone();
        put(&mut other);
        other
    };
    match FIELDS[field].kind {
        Kind::Text => Vec::new(),
        Kind::Number(_, range, put) => {
            SHARES.map(|share| with(&|other| put(other, within(range, share)))).into()
        }
        Kind::Count(from, to, put) => {
            [from, to].map(|count| with(&|other| put(other, count))).into()
        }
        Kind::Choice(names, put) => {
            (0..names.len()).map(|at| with(&|other| put(other, at))).collect()
        }
    }
}

/// Whether a field has an effect on the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acting {
    /// A quantity or a station depends on the field.
    Yes,
    /// The field is printed beside the results or in a note, and no quantity depends on it.
    Beside(&'static str),
    /// The case does not use the field.
    No(&'static str),
}

/// The reason for an unused field without its own reason.
const NO_REASON: &str = "no result of this case depends on it";

impl Case {
    /// The inputs that can be read, enough for the relevance of fields, and all problems of the
    /// case, in the order of the fields.
    #[must_use]
    pub fn read(&self) -> (Inputs, Vec<Problem>) {
        check::read(self, &[])
    }
}

/// Whether the field has an effect in a case with these inputs.
#[must_use]
pub fn relevance(field: usize, inputs: &Inputs) -> Acting {
    if acts(field, inputs) {
        return Acting::Yes;
    }
    let reason = |reason: &Reason| match *reason {
        Reason::Beside(why) => Some(Acting::Beside(why)),
        Reason::Idle(when, why) if when(inputs) => Some(Acting::No(why)),
        _ => None,
    };
    let mut reasons = FIELDS[field].reasons.iter();
    reasons.find_map(reason).unwrap_or(Acting::No(NO_REASON))
}

/// The reason why results depend less on a field than expected, in a case with these inputs.
#[must_use]
pub fn partial_relevance(field: usize, inputs: &Inputs) -> Option<&'static str> {
    let reason = |reason: &Reason| match *reason {
        Reason::Partly(when, why) if when(inputs) => Some(why),
        _ => None,
    };
    let why = FIELDS[field].reasons.iter().find_map(reason)?;
    acts(field, inputs).then_some(why)
}

/// The inputs with a speed. Without a speed every power gives the same infinite torque.
fn with_speed(inputs: &Inputs) -> Cow<'_, Inputs> {
    if inputs.speed > 0.0 {
        return Cow::Borrowed(inputs);
    }
    Cow::Owned(Inputs { speed: 1.0, ..inputs.clone() })
}

/// Whether any stage reads the field. For the method `auto`, any stage of the methods to choose
/// from.
fn acts(field: usize, inputs: &Inputs) -> bool {
    let inputs = &*with_speed(inputs);
    let by = |method| {
        let inputs = Inputs { method, ..inputs.clone() };
        is_read(field, &inputs)
    };
    let by_stages = || match inputs.method {
        Method::Auto => [Method::Exact, Method::Static, Method::Dynamic].into_iter().any(by),
        _ => is_read(field, inputs),
    };
    match FIELDS[field].read_when {
        Some(when) => when(inputs),
        None => by_stages(),
    }
}

#[cfg(test)]
mod tests;
