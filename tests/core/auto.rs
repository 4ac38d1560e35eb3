//! Method `auto` chooses what a trade study would recommend, at about its run time.
//!
//! `TIPSTRIKE_PAIRS=600 cargo test --test core auto:: -- --nocapture` checks 600 pairs instead of
//! 24.
use crate::support::pairs_or;
use crate::{pairs, table};

use tipstrike::model::inputs::Method;
use tipstrike::model::{Inputs, Outcome, Refusal, Solution, Stages, auto, solve};
use tipstrike::study::trade::{Answer, METHODS, Subject, stages};

/// Accepted errors.
const WITHINS: [f64; 4] = [0.01, 0.05, 0.2, 0.5];

fn by_choice(inputs: &Inputs, within: f64) -> Inputs {
    Inputs { method: Method::Auto, within, stations: None, ..inputs.clone() }
}

/// A solve of the stages that a trade study needs, or its refusal.
fn solved(inputs: &Inputs) -> Result<Solution, Refusal> {
    let solution = solve(inputs, stages(inputs.method))?;
    solution.withheld.or(solution.stations_withheld).map_or(Ok(solution), Err)
}

/// Evaluations of the motion, and number of stages that ran.
fn counts(solution: &Solution) -> (f64, f64) {
    let evaluations = solution.dynamic.as_ref().map_or(0, |dynamic| dynamic.evaluations);
    (evaluations as f64, solution.ran.iter().count() as f64)
}

#[test]
fn auto_chooses_the_method_that_a_trade_recommends_at_its_cost() {
    let mut dearer = Vec::new();
    let traded = table::cases().into_iter().zip(table::traded_once());
    for ((path, (name, trade)), within) in
        traded.flat_map(|one| WITHINS.map(|within| (one.clone(), within)))
    {
        let inputs = by_choice(&table::inputs(&path), within);
        let mut trade = trade.clone();
        trade.within = within;
        // The compliance is that of the reference: without the reference solve, no other compliance
        // is known to be close to it.
        let reference = trade.reference().expect("a reference").setting.models;
        let best =
            trade.cheapest_where(|setting| setting.models == reference).expect("one qualifies");
        let recommended = best.setting.method;
        let chosen = solved(&inputs).expect("a solution");
        let name = format!("{name} within {within}");
        let place = |method| METHODS.iter().position(|&one| one == method);
        assert!(place(chosen.method) >= place(recommended), "{name} {:?}", chosen.choice);
        // Without contact the closed form is right and has no force.
        if chosen.outcome == Outcome::NoCornerContact && recommended == Method::Exact {
            assert!(chosen.static_load.is_some() || chosen.dynamic.is_some(), "{name}");
            continue;
        }
        if chosen.method != recommended {
            dearer.push(name);
            continue;
        }
        let named = best.setting.inputs(&inputs);
        let ((evaluations, stages), (named_evaluations, named_stages)) =
            (counts(&chosen), counts(&solved(&named).unwrap()));
        // The choice itself runs closed forms, which take microseconds while the other methods take
        // milliseconds.
        let closed_form = Stages::CLOSED_FORM.iter().count() as f64;
        assert!(stages <= 1.5 * named_stages + closed_form + 1.0, "{name} {stages} {named_stages}");
        let evaluated = if named_evaluations > 0.0 { evaluations / named_evaluations } else { 1.0 };
        assert!(evaluated <= 1.5, "{name}: {evaluations} for {named_evaluations}");
    }
    println!("a dearer method than recommended: {dearer:?}");
    assert!(dearer.len() <= 3, "{dearer:?}");
}

/// Greatest difference from `dynamic` at 1e-8.
fn off(inputs: &Inputs, method: Method, truth: &Answer) -> Option<f64> {
    let inputs = Inputs { method, stations: Some(512), ..inputs.clone() };
    let answer = Answer::of(&solved(&inputs).ok()?);
    let all = Subject::ALL.into_iter().filter_map(|subject| answer.off(truth, subject));
    Some(all.fold(0.0, f64::max))
}

#[test]
fn auto_is_never_wrong_on_other_pairs_and_seldom_too_expensive() {
    let mut agreed = [0; WITHINS.len()];
    let (mut looked_at, mut wrong) = (0, Vec::new());
    for number in 0..pairs_or(24) {
        let inputs = pairs::numbered(number);
        let fine = Inputs {
            method: Method::Dynamic,
            tolerance: 1e-8,
            stations: Some(512),
            ..inputs.clone()
        };
        let Ok(truth) = solved(&fine) else { continue };
        let truth = Answer::of(&truth);
        let errors = auto::METHODS.map(|method| {
            if method == Method::Dynamic { Some(0.0) } else { off(&inputs, method, &truth) }
        });
        looked_at += 1;
        for (within, agreed) in WITHINS.into_iter().zip(&mut agreed) {
            let chosen = solved(&by_choice(&inputs, within)).expect("a solution");
            let is_within = |at: usize| errors[at].is_some_and(|off| off <= within);
            let at = auto::METHODS.iter().position(|&method| method == chosen.method);
            let at = at.expect("one of them");
            if !is_within(at) {
                let (choice, off) = (&chosen.choice, errors[at]);
                wrong.push(format!("{number} within {within}: {choice:?} is off by {off:?}"));
            }
            // Without contact the closed form, the first method, has no force.
            let first = usize::from(chosen.outcome == Outcome::NoCornerContact);
            *agreed += usize::from((first..at).all(|cheaper| !is_within(cheaper)));
        }
    }
    println!("the cheapest method within {WITHINS:?} for {agreed:?} of {looked_at} pairs");
    assert!(wrong.is_empty(), "not good enough: {wrong:#?}");
    assert!(agreed.iter().all(|&agreed| 5 * agreed >= 4 * looked_at), "{agreed:?} of {looked_at}");
}
