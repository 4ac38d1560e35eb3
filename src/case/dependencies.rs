//! The stages that read a field, and the fields that a quantity depends on, found by changes of the
//! fields.

use super::fields::{Kind, Range, Reason};
use super::units::{self, Dimension};
use super::{Case, FIELDS};
use crate::model::compliance::{model_of, without_field};
use crate::model::inputs::Method;
use crate::model::solve::solve_after;
use crate::model::{self, Earlier, Inputs, Quantity, Refusal, Solution, Stage, Stages};

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
/// flag, a quantity without a value, and a quantity over the face width depend on every field that
/// these stages read: a trial of the slices takes too long to try several values of every field.
/// `go_on` receives the number of tried fields and of all, and ends the trials by returning false.
pub fn fields_of(
    quantity: &Quantity,
    case: &Case,
    (inputs, own): (&Inputs, Option<f64>),
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Vec<Dependence> {
    let behind = quantity.stages();
    let is_behind = |&field: &usize| stages_of(field, inputs).within(behind) != Stages::NONE;
    let base = Base::of(quantity, inputs, own);
    let is_over_face = inputs.face().is_some() && behind.has(Stage::Mesh);
    let is_listed = own.is_none() || quantity.is_flag() || is_over_face;
    // A given centre distance fits only the present gears.
    let is_free = base.inputs.centre_distance.is_none() || quantity.key == "centre_distance";
    let free = (!is_free && !is_listed)
        .then(|| Base::at(quantity, Inputs { centre_distance: None, ..base.inputs.clone() }));
    let dependence = |field| {
        let small = small_step(field, case, &base.inputs);
        // A quantity without a value has no change to show.
        let solved = |inputs: &Inputs| own.map_or(Ok(None), |_| base.solved(inputs));
        let after = small.as_ref().map(|(_, inputs)| solved(inputs));
        let moves = is_listed
            || after.is_some_and(|after| differ(after, own) == Some(true))
            || is_moved(own, field, case, &base)
                .or_else(|| {
                    let free = free.as_ref()?;
                    is_moved(free.value(), field, case, free)
                })
                .unwrap_or_default();
        let step = small.zip(after);
        let step = step.map(|((text, _), after)| Step { text, value: after.ok().flatten() });
        moves.then_some(Dependence { field, step })
    };
    let fields = (0..FIELDS.len()).filter(|&field| !case.is_replaced(field));
    let fields: Vec<usize> = fields.filter(is_behind).collect();
    let tried = fields.iter().enumerate().take_while(|(at, _)| go_on(*at, fields.len()));
    tried.filter_map(|(_, &field)| dependence(field)).collect()
}

/// The pair that the trials change, and its solution, whose stages they use again.
struct Base<'a> {
    quantity: &'a Quantity,
    inputs: Inputs,
    solution: Result<Solution, Refusal>,
}

impl<'a> Base<'a> {
    /// The inputs with a quick tooth compliance if the quantity does not depend on the tooth
    /// compliance, otherwise the same inputs. Finite elements for every changed gear take longer
    /// than all other stages.
    fn of(quantity: &'a Quantity, inputs: &Inputs, own: Option<f64>) -> Base<'a> {
        // A flag or a value of 0 can agree by chance.
        let is_telling = !quantity.is_flag() && own.is_some_and(|own| own != 0.0);
        let quick = without_field(inputs)
            .filter(|_| is_telling)
            .map(|tooth| Inputs { tooth_compliance: Some(tooth), ..inputs.clone() });
        let quick = quick.map(|quick| Base::at(quantity, quick));
        let is_same = |quick: &Base<'_>| differ(quick.solved(&quick.inputs), own) == Some(false);
        quick.filter(is_same).unwrap_or_else(|| Base::at(quantity, inputs.clone()))
    }

    fn at(quantity: &'a Quantity, inputs: Inputs) -> Base<'a> {
        let solution = model::solve(&inputs, quantity.stages());
        Base { quantity, inputs, solution }
    }

    /// The value of the quantity.
    fn value(&self) -> Option<f64> {
        finite(self.quantity, self.solution.as_ref().ok()?)
    }

    /// The value of the quantity with other inputs, if it has one.
    fn solved(&self, inputs: &Inputs) -> Result<Option<f64>, Refusal> {
        let solution = self.solution.as_ref().ok();
        let earlier =
            solution.map(|solution| Earlier { inputs: &self.inputs, solution, gears: None });
        let wanted = self.quantity.stages();
        let solution = solve_after(inputs, wanted, earlier, &|_| true)?;
        Ok(finite(self.quantity, &solution))
    }
}

/// The value of a quantity with these inputs, in SI.
pub fn value_of(quantity: &Quantity, inputs: &Inputs) -> Option<f64> {
    finite(quantity, &model::solve(inputs, quantity.stages()).ok()?)
}

fn finite(quantity: &Quantity, solution: &Solution) -> Option<f64> {
    (quantity.value)(solution).filter(|value| value.is_finite())
}

/// Whether the value differs in any bit, ignoring the sign of zero. `None` if the pair cannot be
/// solved.
fn differ(solved: Result<Option<f64>, Refusal>, own: Option<f64>) -> Option<bool> {
    let bits = |value: Option<f64>| value.map(|value| (value + 0.0).to_bits());
    solved.ok().map(|value| bits(value) != bits(own))
}

/// The inputs with each of these values in a field; with every choice in a choice.
fn with_values(
    field: usize,
    values: &[f64],
    inputs: Inputs,
) -> impl Iterator<Item = Inputs> + use<> {
    let known = &FIELDS[field];
    let choices: Vec<f64> = (0..known.choices().len()).map(|at| at as f64).collect();
    let values = if known.is_choice() { choices } else { values.to_vec() };
    values.into_iter().map(move |value| {
        let mut other = inputs.clone();
        known.put(known.value_of(value), &mut other);
        other
    })
}

/// A step that is small for the field, and the inputs after it.
fn small_step(field: usize, case: &Case, inputs: &Inputs) -> Option<(&'static str, Inputs)> {
    let now = case.value(field)?;
    let (text, to) = match FIELDS[field].kind {
        Kind::Number(_, Range { unit: "um", .. }, _) => ("+1 um", now + 1e-6),
        Kind::Number(Dimension::Number, ..) => ("+0.01", now + 0.01),
        Kind::Number(Dimension::Length, ..) if now == 0.0 => ("+0.1 mm", 0.1e-3),
        Kind::Number(..) => ("+1 %", 1.01 * now),
        _ => ("+1", now + 1.0),
    };
    Some((text, with_values(field, &[to], inputs.clone()).next()?))
}

/// Whether a larger change of a field alters a quantity. `None` if no changed pair can be solved.
fn is_moved(own: Option<f64>, field: usize, case: &Case, base: &Base<'_>) -> Option<bool> {
    let mut known = None;
    let values = other_values(field, case, &base.inputs);
    for other in with_values(field, &values, base.inputs.clone()) {
        known = differ(base.solved(&other), own).or(known);
        if known == Some(true) {
            break;
        }
    }
    known
}

/// Values, in SI, to try in a field: near its value, otherwise near the quantity of the same name,
/// and an example.
fn other_values(field: usize, case: &Case, inputs: &Inputs) -> Vec<f64> {
    /// Factors for a centre distance and for other numbers that usually leave a valid pair.
    const FACTORS: [f64; 4] = [1.0002, 1.02, 0.8, 1.25];
    const EXAMPLES: [f64; 4] = [1.0, 0.2, 1.5, 30.0];
    /// Part of the range for a field with the value 0.
    const SHARE: f64 = 1e-3;
    let known = &FIELDS[field];
    let now = case.value(field);
    match known.kind {
        Kind::Text | Kind::Choice(..) | Kind::List(_) => Vec::new(),
        Kind::Count(from, to, _) => match now {
            Some(now) => vec![f64::from(from), now + 1.0, now + (now / 2.0).floor(), 2.0 * now],
            None => vec![f64::from(from), f64::from(to)],
        },
        Kind::Number(dimension, range, _) => {
            let alike = || value_of(Quantity::find(known.name())?, inputs);
            if now == Some(0.0) {
                vec![within(range, SHARE)]
            } else if let Some(now) = now.or_else(alike) {
                FACTORS.map(|times| times * now).into_iter().chain([within(range, SHARE)]).collect()
            } else {
                let example = units::parse(known.example(), dimension, range.unit);
                example.iter().flat_map(|example| EXAMPLES.map(|times| times * example)).collect()
            }
        }
    }
}

/// The number, in SI, at a part of a range.
fn within(range: Range, share: f64) -> f64 {
    let factor = units::factor(range.unit).unwrap_or(1.0);
    factor * (range.from + share * (range.to - range.from))
}

/// The stages that read a field in a case with these inputs: the stages whose inputs change, or
/// that no longer run, if the field has another value.
pub fn stages_of(field: usize, inputs: &Inputs) -> Stages {
    readers(field, inputs).fold(Stages::NONE, Stages::with)
}

/// Whether any stage reads a field in a case with these inputs.
pub fn is_read(field: usize, inputs: &Inputs) -> bool {
    readers(field, inputs).next().is_some()
}

fn readers(field: usize, inputs: &Inputs) -> impl Iterator<Item = Stage> {
    with_other_values(field, inputs).flat_map(move |other| {
        inputs.method.stages().iter().filter(move |stage| {
            !stage.has_equal_inputs(inputs, &other) || !other.method.stages().has(*stage)
        })
    })
}

/// The inputs with other values in a field. At least one value differs from the present value.
fn with_other_values(field: usize, inputs: &Inputs) -> impl Iterator<Item = Inputs> + use<> {
    /// Parts of the range: the least value, because the smaller of two values can decide, and two
    /// unusual values.
    const SHARES: [f64; 3] = [0.0, 0.381_966, 0.618_034];
    // Every stage that reads the tooth model also reads the fields that decide its range.
    let held = Inputs { tooth_compliance: Some(model_of(inputs)), ..inputs.clone() };
    let values = FIELDS[field].range().map(|range| SHARES.map(|share| within(range, share)));
    with_values(field, &values.unwrap_or([0.1, -0.2, 0.3]), held)
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

/// Whether the field has an effect in a case with these inputs.
pub fn relevance(field: usize, inputs: &Inputs) -> Acting {
    if acts(field, inputs) {
        return Acting::Yes;
    }
    let reason = |reason: &Reason| match *reason {
        Reason::Beside(why) => Some(Acting::Beside(why)),
        Reason::Idle(when, why) if when(inputs) => Some(Acting::No(why)),
        _ => None,
    };
    FIELDS[field].reasons.iter().find_map(reason).unwrap_or(Acting::No(NO_REASON))
}

/// The reason why results depend less on a field than expected, in a case with these inputs.
pub fn partial_relevance(field: usize, inputs: &Inputs) -> Option<&'static str> {
    let reason = |reason: &Reason| match *reason {
        Reason::Partly(when, why) if when(inputs) => Some(why),
        _ => None,
    };
    let why = FIELDS[field].reasons.iter().find_map(reason)?;
    acts(field, inputs).then_some(why)
}

/// Whether any stage reads the field. For the method `auto`, any stage of the methods to choose
/// from.
fn acts(field: usize, inputs: &Inputs) -> bool {
    let methods = match inputs.method {
        Method::Auto => &[Method::Exact, Method::Static, Method::Dynamic][..],
        _ => &[inputs.method],
    };
    // Without a speed every power gives the same infinite torque.
    let speed = if inputs.speed > 0.0 { inputs.speed } else { 1.0 };
    let by = |&method: &Method| is_read(field, &Inputs { speed, method, ..inputs.clone() });
    match FIELDS[field].read_when {
        Some(when) => when(inputs),
        None => methods.iter().any(by),
    }
}

#[cfg(test)]
mod tests;
