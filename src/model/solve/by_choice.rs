//! The method `auto`: chooses a method and solves by it.

use super::by_method::solve_by_method;
use crate::model::auto::{self, Reason};
use crate::model::inputs::{Inputs, Method};
use crate::model::request::Earlier;
use crate::model::stage::{Stage, Stages};
use crate::model::{Choice, Refusal, Solution};

/// Solves with the method that the closed form suggests, or decides by a trial motion. Reuses the
/// earlier choice for equal inputs. The required relief is that of the chosen method.
pub(super) fn solve_by_choice(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let wanted = wanted.and(Method::Auto.deciding_stages());
    let before =
        earlier.filter(|earlier| earlier.inputs == inputs && earlier.solution.choice.is_some());
    let chosen = match before {
        Some(earlier) => Solution { ran: Stages::NONE, ..earlier.solution.clone() },
        None => {
            let chosen = chosen(inputs, wanted.except(Stages::LATE), go_on)?;
            with_beside(inputs, chosen, go_on)?
        }
    };
    if before.is_none() && wanted.within(Stages::LATE) == Stages::NONE {
        return Ok(chosen);
    }
    let taken = auto::taken(inputs, chosen.method);
    let wanted = if chosen.method == Method::Static { at_rest(wanted) } else { wanted };
    let earlier = Earlier { inputs: &taken, solution: &chosen };
    let whole = solve_by_method(&taken, wanted, Some(earlier), go_on)?;
    Ok(Solution {
        ran: whole.ran.and(chosen.ran),
        choice: chosen.choice,
        beside: chosen.beside,
        ..whole
    })
}

/// Adds the results that limits or selected quantities need from a slower method.
fn with_beside(
    inputs: &Inputs,
    solution: Solution,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let Some(method) = auto::beside(inputs, solution.method) else {
        return Ok(Solution { beside: None, ..solution });
    };
    let missing = inputs.needs.except(solution.method.stages());
    let wanted = missing.iter().fold(Stages::NONE, |wanted, stage| wanted.and(Stages::of(stage)));
    let taken = auto::taken(inputs, method);
    // A trial motion, or the motion of an earlier solve.
    let known = solution.beside.as_ref().and_then(|known| known.as_ref().ok());
    let earlier = known.map(|solution| Earlier { inputs: &taken, solution });
    let beside = match solve_by_method(&taken, wanted, earlier, go_on) {
        Err(Refusal::Stopped) => return Err(Refusal::Stopped),
        found => found.map(Box::new),
    };
    let ran = beside.as_ref().map_or(Stages::NONE, |beside| beside.ran);
    Ok(Solution { ran: solution.ran.and(ran), beside: Some(beside), ..solution })
}

/// Solves by the chosen method. If `static` is chosen, its results replace the wanted results of
/// `dynamic`. Uses static balance if the speed is too low for a motion.
fn chosen(
    inputs: &Inputs,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let read = wanted.within(Stages::CLOSED_FORM).and(auto::READS);
    let closed_form = solve_by_method(&auto::taken(inputs, Method::Exact), read, None, &|_| true);
    let choice = auto::choose(inputs, &closed_form);
    let still =
        || solve_by_method(&auto::taken(inputs, Method::Static), at_rest(wanted), None, go_on);
    let (solved, choice) = match (choice.method, &closed_form) {
        (Method::Exact, Ok(known)) => {
            let taken = auto::taken(inputs, Method::Exact);
            let earlier = Earlier { inputs: &taken, solution: known };
            let found = solve_by_method(&taken, wanted, Some(earlier), go_on)?;
            (Ok(Solution { ran: found.ran.and(known.ran), ..found }), choice)
        }
        (Method::Static, _) => (still(), choice),
        _ => match solve_by_method(&auto::taken(inputs, Method::Dynamic), wanted, None, go_on) {
            Err(Refusal::TooSlow { .. }) => (still(), choice),
            // The slower the pair turns, the longer its motion.
            Err(Refusal::MotionTooLong { .. } | Refusal::MotionTooLarge { .. })
                if choice.reason == Reason::NoContact =>
            {
                (still(), choice)
            }
            Ok(moved) if choice.is_open() => decided(inputs, choice, moved, wanted, go_on),
            found => (found, choice),
        },
    };
    let solution = solved?;
    Ok(Solution { choice: Some(Choice { method: solution.method, ..choice }), ..solution })
}

/// The motion, or the static balance on the same mesh if the effect of inertia is small.
fn decided(
    inputs: &Inputs,
    choice: Choice,
    moved: Solution,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> (Result<Solution, Refusal>, Choice) {
    let choice = auto::added_by_inertia(&moved).map_or(choice, |adds| choice.tried(inputs, adds));
    if choice.method == Method::Dynamic {
        return (Ok(moved), choice);
    }
    let known = Solution { method: Method::Static, ..moved.clone() };
    let taken = auto::taken(inputs, Method::Static);
    let earlier = Earlier { inputs: &taken, solution: &known };
    let found = solve_by_method(&taken, at_rest(wanted), Some(earlier), go_on);
    (
        found.map(|found| Solution {
            ran: found.ran.and(known.ran),
            beside: Some(Ok(Box::new(moved))),
            ..found
        }),
        choice,
    )
}

/// The wanted stages with `static` instead of `dynamic`.
fn at_rest(wanted: Stages) -> Stages {
    if wanted.has(Stage::Dynamic) { wanted.and(Stages::of(Stage::Static)) } else { wanted }
}
