//! A quantity has one value: the same bits whatever else is selected, limited or solved before, in a
//! solve, a study and the workbench.
use crate::budget::drawn;
use crate::envelope::Random;
use crate::support::on_all_cores;

use std::collections::BTreeMap;

use tipstrike::case::{Case, Evaluator, Limit};
use tipstrike::model::inputs::Method;
use tipstrike::model::{Inputs, Outcome, QUANTITIES, Quantity, Stage, Stages};
use tipstrike::report::{Report, Selection};
use tipstrike::study::batch::{Batch, Control, PointOutcome, Points, Writer, solve_all};

/// A study of one point that is the case itself.
struct Itself;

impl Points for Itself {
    fn count(&self) -> usize {
        1
    }

    fn writer(&self) -> Writer<'_> {
        Box::new(|_, _| Ok(()))
    }
}

type Values = BTreeMap<&'static str, u64>;

fn values(pairs: impl IntoIterator<Item = (&'static Quantity, f64)>) -> Values {
    pairs.into_iter().map(|(quantity, value)| (quantity.key, value.to_bits())).collect()
}

fn solved(case: &Case, only: &[&'static Quantity]) -> Option<(Method, Outcome, Values)> {
    let selection = Selection { only: only.to_vec(), stations: false };
    let inputs = case.inputs().ok()?;
    let report = Report::solve(String::new(), case.clone(), inputs, selection).ok()?;
    let solution = &report.solution;
    Some((solution.method, solution.outcome, values(report.values())))
}

fn of_study(inputs: &Inputs, only: &[&'static Quantity]) -> Option<(Outcome, Values)> {
    let inputs = &inputs.clone().needing(only.iter().map(|quantity| quantity.stage));
    let batch = Batch { inputs, points: &Itself, quantities: only };
    let mut found = None;
    solve_all(&batch, 0..1, &Control::PLAIN, &mut |_, rows| {
        let pairs = only.iter().zip(&rows[0].values);
        let pairs = pairs.filter_map(|(quantity, value)| Some((*quantity, (*value)?)));
        if let PointOutcome::Solved(outcome) = rows[0].outcome {
            found = Some((outcome, values(pairs)));
        }
        true
    })
    .ok()?;
    found
}

/// The values that both have must be equal.
fn agree(one: &Values, other: &Values, place: &str) -> usize {
    let both = one.iter().filter(|(key, _)| other.contains_key(*key));
    both.map(|(key, value)| assert_eq!(value, &other[key], "{key}: {place}")).count()
}

/// The values of a case in a solve of the whole table, and how many values of solves of a few
/// quantities, of studies and of solves with limits agree with them.
fn of_commands(number: u64, table: &[&'static Quantity]) -> Option<(Values, usize)> {
    const SELECTIONS: usize = 2;
    let case = drawn(number);
    let inputs = case.inputs().expect("a valid case");
    // A pair in slices takes a hundred times as long.
    if inputs.face().is_some() && !number.is_multiple_of(4) {
        return None;
    }
    let (method, outcome, whole) = solved(&case, table)?;
    let (mut random, mut compared) = (Random::new(77 + number), 0);
    for _ in 0..SELECTIONS {
        let only: Vec<&Quantity> = (0..3).map(|_| random.one_of(table)).collect();
        let keys: Vec<&str> = only.iter().map(|quantity| quantity.key).collect();
        let place = format!("case {number}, {keys:?}");
        let (own_method, own_outcome, some) = solved(&case, &only).expect("as the whole");
        assert_eq!((own_method, own_outcome), (method, outcome), "{place}");
        compared += agree(&some, &whole, &place);
        if let Some((studied, found)) = of_study(&inputs, &only) {
            assert_eq!(studied, outcome, "{place}");
            compared += agree(&found, &whole, &place);
        }
        let mut limited = case.clone();
        let limit = |quantity: &&Quantity| Limit::new(quantity.key, "1").ok();
        limited.limits = only.iter().filter_map(limit).collect();
        let (own_method, own_outcome, plain) = solved(&limited, &[]).expect("as the whole");
        assert_eq!((own_method, own_outcome), (method, outcome), "{place}");
        compared += agree(&plain, &whole, &place);
    }
    Some((whole, compared))
}

#[test]
fn a_quantity_has_one_value_in_every_command() {
    const CASES: u64 = 32;
    let is_quick = |quantity: &&Quantity| quantity.stage != Stage::SpeedRun;
    let table: Vec<&Quantity> = QUANTITIES.iter().filter(is_quick).collect();
    let stages = table.iter().map(|quantity| Stages::of(quantity.stage));
    let wanted = stages.fold(Stages::NONE, Stages::and);
    let found = on_all_cores(CASES, |number| (number, of_commands(number, &table)));
    let (mut compared, mut evaluator) = (0, Evaluator::default());
    for (number, found) in found {
        let Some((whole, agreed)) = found else { continue };
        compared += agreed;
        // As the workbench after edits of the form.
        let inputs = drawn(number).inputs().expect("a valid case");
        if let Ok(solution) = evaluator.solve(&inputs, inputs.method, wanted, &|_| true) {
            let value =
                |&quantity: &&'static Quantity| Some((quantity, quantity.finite_value(&solution)?));
            let own = values(table.iter().filter_map(value));
            compared += agree(&own, &whole, &format!("case {number} after others"));
        }
    }
    assert!(compared > 3_000, "{compared}");
}
