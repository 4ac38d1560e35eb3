//! A solve by the method `auto`: the closed form or a trial motion decides the method.

use super::by_method::{Earlier, solve_by_method};
use crate::model::auto::{self, Choice, Reason};
use crate::model::inputs::{Inputs, Method};
use crate::model::stage::{Stage, Stages};
use crate::model::{Refusal, Solution};

/// Solves with the method that the closed form suggests, or decides by a trial motion. Reuses the
/// earlier choice for equal inputs. The required relief is that of the chosen method.
pub(super) fn solve_by_choice(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let auto = Auto { inputs, go_on };
    let wanted = wanted.and(Method::Auto.deciding_stages());
    let before =
        earlier.filter(|earlier| earlier.inputs == inputs && earlier.solution.choice.is_some());
    let chosen = match before {
        Some(earlier) => Solution { ran: Stages::NONE, ..earlier.solution.clone() },
        None => auto.with_beside(auto.chosen(wanted.except(Stages::LATE))?)?,
    };
    if before.is_none() && wanted.within(Stages::LATE) == Stages::NONE {
        return Ok(chosen);
    }
    let whole = auto.solve(chosen.method, wanted, Some(&chosen))?;
    Ok(Solution { choice: chosen.choice, beside: chosen.beside, ..whole })
}

/// A case that leaves the method open.
struct Auto<'a> {
    inputs: &'a Inputs,
    go_on: &'a dyn Fn(f64) -> bool,
}

impl Auto<'_> {
    /// Solves by one method after a known solution by it. For `static` its results replace the
    /// wanted results of `dynamic`.
    fn solve(
        &self,
        method: Method,
        wanted: Stages,
        known: Option<&Solution>,
    ) -> Result<Solution, Refusal> {
        let inputs = auto::taken(self.inputs, method);
        let wanted = if method == Method::Static && wanted.has(Stage::Dynamic) {
            wanted.and(Stages::of(Stage::Static))
        } else {
            wanted
        };
        let earlier = known.map(|solution| Earlier { inputs: &inputs, solution });
        let found = solve_by_method(&inputs, wanted, earlier, self.go_on)?;
        let ran = known.map_or(Stages::NONE, |known| known.ran);
        Ok(Solution { ran: found.ran.and(ran), ..found })
    }

    /// Adds the results that limits or selected quantities need from a slower method.
    fn with_beside(&self, solution: Solution) -> Result<Solution, Refusal> {
        let Some(method) = auto::beside(self.inputs, solution.method) else {
            return Ok(Solution { beside: None, ..solution });
        };
        let missing = self.inputs.needs.except(solution.method.stages());
        let wanted = missing.iter().map(Stages::of).fold(Stages::NONE, Stages::and);
        // A trial motion, or the motion of an earlier solve.
        let known = solution.beside.as_ref().and_then(|known| known.as_deref().ok());
        let beside = match self.solve(method, wanted, known) {
            Err(Refusal::Stopped) => return Err(Refusal::Stopped),
            found => found.map(Box::new),
        };
        let ran = beside.as_ref().map_or(Stages::NONE, |beside| beside.ran);
        Ok(Solution { ran: solution.ran.and(ran), beside: Some(beside), ..solution })
    }

    /// Solves by the chosen method. Uses static balance if the speed is too low for a motion.
    fn chosen(&self, wanted: Stages) -> Result<Solution, Refusal> {
        let exact = auto::taken(self.inputs, Method::Exact);
        let read = wanted.within(Stages::CLOSED_FORM).and(auto::READS);
        let closed_form = solve_by_method(&exact, read, None, &|_| true);
        let choice = auto::choose(self.inputs, &closed_form);
        let still = || self.solve(Method::Static, wanted, None);
        let (solution, choice) = match (choice.method, &closed_form) {
            (Method::Exact, Ok(known)) => (self.solve(Method::Exact, wanted, Some(known))?, choice),
            (Method::Static, _) => (still()?, choice),
            _ => match self.solve(Method::Dynamic, wanted, None) {
                Err(Refusal::TooSlow { .. }) => (still()?, choice),
                // The slower the pair turns, the longer its motion.
                Err(Refusal::MotionTooLong { .. } | Refusal::MotionTooLarge { .. })
                    if choice.reason == Reason::NoContact =>
                {
                    (still()?, choice)
                }
                Ok(moved) if choice.is_open() => self.decided(choice, moved, wanted)?,
                found => (found?, choice),
            },
        };
        Ok(Solution { choice: Some(Choice { method: solution.method, ..choice }), ..solution })
    }

    /// The motion, or the static balance on the same mesh if the effect of inertia is small.
    fn decided(
        &self,
        choice: Choice,
        moved: Solution,
        wanted: Stages,
    ) -> Result<(Solution, Choice), Refusal> {
        let adds = auto::added_by_inertia(&moved);
        let choice = adds.map_or(choice, |adds| choice.tried(self.inputs, adds));
        if choice.method == Method::Dynamic {
            return Ok((moved, choice));
        }
        let known = Solution { method: Method::Static, ..moved.clone() };
        let found = self.solve(Method::Static, wanted, Some(&known))?;
        Ok((Solution { beside: Some(Ok(Box::new(moved))), ..found }, choice))
    }
}
