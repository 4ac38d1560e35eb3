//! A solve: runs the wanted stages and reuses valid earlier results.

mod by_method;

use super::auto::Reason;
use super::dynamic::speeds::over_speed;
use super::inputs::{Combination, Drive, Inputs, Method};
use super::request::Earlier;
use super::stage::{Stage, Stages};
use super::{Choice, Refusal, Solution, SpeedCurve, auto};
pub use by_method::Setup;
use by_method::{Solving, solve_by_method};

/// Solves the pair. Runs only the wanted stages and the stages that they need.
///
/// Geometry, load and deviation always run, because they decide the outcome. If small differences
/// decide, geometry and position use double-double arithmetic, requested or not.
///
/// # Errors
/// A [`Refusal`] if the pair cannot mesh, or D does not exist. If only the force cannot be
/// computed, the solution has the other results and the reason in [`Solution::withheld`].
pub fn solve(inputs: &Inputs, wanted: Stages) -> Result<Solution, Refusal> {
    solve_while(inputs, wanted, &|_| true)
}

/// Like [`solve`]. Calls `go_on` from time to time with the computed part, from 0 to 1.
///
/// # Errors
/// Those of [`solve`], and [`Refusal::Stopped`] if `go_on` returns false.
pub fn solve_while(
    inputs: &Inputs,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    solve_after(inputs, wanted, None, go_on)
}

/// Like [`solve_while`] after an earlier solve. Reuses valid earlier results; [`Solution::ran`]
/// lists the stages that ran.
///
/// # Errors
/// Those of [`solve_while`].
pub fn solve_after(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    if inputs.method == Method::Auto {
        return solve_by_choice(inputs, wanted, earlier, go_on);
    }
    solve_by_method(inputs, wanted, earlier, go_on)
}

/// The steady motion over the speed, rising and falling, by the method `dynamic`. `show` receives the
/// growing curve and returns whether to continue.
///
/// # Errors
/// Those of [`solve`], and [`Refusal::Stopped`] if `show` returns false.
pub fn speeds(
    inputs: &Inputs,
    show: &mut dyn FnMut(&SpeedCurve) -> bool,
) -> Result<SpeedCurve, Refusal> {
    let inputs = Inputs { method: Method::Dynamic, ..inputs.clone() };
    let solution = solve(&inputs, Stages::of(Stage::Deviation))?;
    over_speed(&inputs, &solution, show)
}

/// Solves with the method that the closed form suggests, or decides by a trial motion. Reuses the
/// earlier choice for equal inputs. The required relief is that of the chosen method.
fn solve_by_choice(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let wanted = wanted.and(Method::Auto.deciding_stages());
    let before =
        earlier.filter(|earlier| earlier.inputs == inputs && earlier.solution.choice.is_some());
    let chosen = if let Some(earlier) = before {
        Solution { ran: Stages::NONE, ..earlier.solution.clone() }
    } else {
        let chosen = chosen(inputs, wanted.except(Stages::LATE), go_on)?;
        with_beside(inputs, chosen, go_on)?
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

/// Solves again in place if `inputs` differ from those of the solution only in load and deviations
/// and the wanted stages have a closed form. The results have the bits of [`solve`]
/// without the comparisons of the other stages' inputs. `setup` stores the common values of all
/// repeats and is empty at first. Returns `None` if more differs; inputs, solution and setup then
/// stay unchanged.
///
/// # Errors
/// Those of [`solve`]. The solution is then invalid.
pub fn solve_repeated(
    (before, change): (&mut Inputs, Change),
    solution: &mut Solution,
    setup: &mut Option<Setup>,
    inputs: &Inputs,
    wanted: Stages,
) -> Option<Result<(), Refusal>> {
    if let (Change::LoadAlone, Some(setup)) = (change, &setup) {
        LoadAndDeviation::of(inputs).put(before);
        debug_assert_eq!(before, inputs);
        return Some(Solving::from_load(inputs, wanted, setup).repeat(solution));
    }
    let wanted = wanted.within(inputs.method.stages());
    let has_closed_form =
        Method::CLOSED_FORM.contains(&inputs.method) && Stages::ALL.covers(wanted);
    if !has_closed_form || inputs.accurate || solution.geometry.needs_precision(inputs.bores()) {
        return None;
    }
    let earlier = LoadAndDeviation::of(before);
    LoadAndDeviation::of(inputs).put(before);
    if before != inputs {
        earlier.put(before);
        return None;
    }
    let setup = setup.get_or_insert_with(|| Setup::of(inputs));
    Some(Solving::from_load(inputs, wanted, setup).repeat(solution))
}

/// The difference between the inputs of a solve and the previous inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// Only load and deviations differ.
    LoadAlone,
    /// A comparison must find the difference.
    Unknown,
}

/// Whether inputs differ only in load and deviations, as [`solve_repeated`] needs.
#[must_use]
pub fn differ_in_load_alone(one: &Inputs, other: &Inputs) -> bool {
    let mut same_load = one.clone();
    LoadAndDeviation::of(other).put(&mut same_load);
    same_load == *other
}

/// The inputs of the stages load and deviation, which no other closed-form stage reads.
struct LoadAndDeviation {
    drive: Drive,
    deflection: Option<f64>,
    base_pitch_deviation: f64,
    base_pitches: [Option<f64>; 2],
    combination: Combination,
    backlash: f64,
    driven_tip_relief: f64,
    driver_root_relief: f64,
}

impl LoadAndDeviation {
    fn of(inputs: &Inputs) -> LoadAndDeviation {
        LoadAndDeviation {
            drive: inputs.drive,
            deflection: inputs.deflection,
            base_pitch_deviation: inputs.base_pitch_deviation,
            base_pitches: [inputs.driver.base_pitch, inputs.driven.base_pitch],
            combination: inputs.combination,
            backlash: inputs.backlash,
            driven_tip_relief: inputs.driven.tip_relief,
            driver_root_relief: inputs.driver.root_relief,
        }
    }

    fn put(&self, inputs: &mut Inputs) {
        inputs.drive = self.drive;
        inputs.deflection = self.deflection;
        inputs.base_pitch_deviation = self.base_pitch_deviation;
        [inputs.driver.base_pitch, inputs.driven.base_pitch] = self.base_pitches;
        inputs.combination = self.combination;
        inputs.backlash = self.backlash;
        inputs.driven.tip_relief = self.driven_tip_relief;
        inputs.driver.root_relief = self.driver_root_relief;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Stage;
    use crate::model::sample::standard_pair;

    fn edits() -> [fn(&mut Inputs); 9] {
        [
            |inputs| inputs.drive = Drive::Torque(123.0),
            |inputs| inputs.deflection = Some(17e-6),
            |inputs| inputs.base_pitch_deviation = 9e-6,
            |inputs| inputs.driver.base_pitch = Some(7e-6),
            |inputs| inputs.driven.base_pitch = Some(8e-6),
            |inputs| inputs.combination = Combination::Sum,
            |inputs| inputs.backlash = 3e-6,
            |inputs| inputs.driven.tip_relief = 4e-6,
            |inputs| inputs.driver.root_relief = 5e-6,
        ]
    }

    fn pair() -> Inputs {
        Inputs { base_pitch_deviation: 16e-6, ..standard_pair(20, 31, 5e-3) }
    }

    #[test]
    fn only_their_own_stages_read_load_and_deviations() {
        let before = pair();
        for edit in edits() {
            let mut after = before.clone();
            edit(&mut after);
            for stage in Stages::CLOSED_FORM.iter() {
                let is_own = matches!(stage, Stage::Load | Stage::Deviation);
                assert!(
                    is_own || stage.has_equal_inputs(&before, &after),
                    "{} reads {after:?}",
                    stage.name()
                );
            }
        }
    }

    #[test]
    fn a_repeated_solve_has_the_bits_of_a_plain_one() {
        for method in Method::CLOSED_FORM {
            let mut before = Inputs { method, ..pair() };
            let mut solution = solve(&before, Stages::CLOSED_FORM).unwrap();
            let (mut inputs, mut setup) = (before.clone(), None);
            for edit in edits() {
                edit(&mut inputs);
                let cases = [Stages::of(Stage::Impact), Stages::CLOSED_FORM].into_iter().flat_map(
                    |wanted| [Change::Unknown, Change::LoadAlone].map(|change| (wanted, change)),
                );
                for (wanted, change) in cases {
                    let before = (&mut before, change);
                    let repeated =
                        solve_repeated(before, &mut solution, &mut setup, &inputs, wanted);
                    assert_eq!(repeated, Some(Ok(())), "{inputs:?}");
                    let plain = solve(&inputs, wanted).unwrap();
                    let ran = solution.ran;
                    assert_eq!(Solution { ran, ..plain }, solution);
                }
            }
        }
    }

    #[test]
    fn a_solve_with_another_gear_is_not_repeated() {
        let mut before = pair();
        let mut solution = solve(&before, Stages::CLOSED_FORM).unwrap();
        let (inputs, kept) = (before.clone(), solution.clone());
        let mut other = Inputs { backlash: 1e-6, ..inputs.clone() };
        other.driven.density *= 1.1;
        let wanted = Stages::CLOSED_FORM;
        let repeated = solve_repeated(
            (&mut before, Change::Unknown),
            &mut solution,
            &mut None,
            &other,
            wanted,
        );
        assert_eq!(repeated, None);
        assert_eq!((before, solution), (inputs, kept));
    }
}
