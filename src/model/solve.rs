//! A solve: runs the wanted stages and reuses valid earlier results.

mod by_choice;
mod by_method;

use super::dynamic::speeds::over_speed;
use super::inputs::{Inputs, Method};
use super::stage::{Stage, Stages};
use super::{Refusal, Solution, SpeedCurve};
use by_choice::solve_by_choice;
pub(super) use by_method::Setup;
use by_method::solve_by_method;
pub use by_method::{Earlier, differ_in_load_alone};

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
    match inputs.method {
        Method::Auto => solve_by_choice(inputs, wanted, earlier, go_on),
        _ => solve_by_method(inputs, wanted, earlier, go_on),
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::{Combination, Drive};
    use crate::model::sample::standard_pair;

    #[test]
    fn only_their_own_stages_read_load_and_deviations_and_reuse_has_the_bits_of_a_plain_solve() {
        let edits: [fn(&mut Inputs); 9] = [
            |inputs| inputs.drive = Drive::Torque(123.0),
            |inputs| inputs.deflection = Some(17e-6),
            |inputs| inputs.base_pitch_deviation = 9e-6,
            |inputs| inputs.driver.base_pitch = Some(7e-6),
            |inputs| inputs.driven.base_pitch = Some(8e-6),
            |inputs| inputs.combination = Combination::Sum,
            |inputs| inputs.backlash = 3e-6,
            |inputs| inputs.driven.tip_relief = 4e-6,
            |inputs| inputs.driver.root_relief = 5e-6,
        ];
        let pair = Inputs { base_pitch_deviation: 16e-6, ..standard_pair(20, 31, 5e-3) };
        for method in Method::CLOSED_FORM {
            let mut inputs = Inputs { method, ..pair.clone() };
            let mut before = (inputs.clone(), solve(&inputs, Stages::CLOSED_FORM).unwrap());
            for edit in edits {
                edit(&mut inputs);
                assert!(differ_in_load_alone(&before.0, &inputs));
                for stage in Stages::CLOSED_FORM.iter() {
                    let is_own = matches!(stage, Stage::Load | Stage::Deviation);
                    let is_equal = stage.has_equal_inputs(&before.0, &inputs);
                    assert!(is_own || is_equal, "{} reads {inputs:?}", stage.name());
                }
                for wanted in [Stages::of(Stage::Impact), Stages::CLOSED_FORM] {
                    let earlier = Earlier { inputs: &before.0, solution: &before.1 };
                    let after = solve_after(&inputs, wanted, Some(earlier), &|_| true).unwrap();
                    let plain = solve(&inputs, wanted).unwrap();
                    assert_eq!(Solution { ran: after.ran, ..plain }, after, "{inputs:?}");
                    before = (inputs.clone(), after);
                }
            }
        }
        let mut other = pair.clone();
        other.driven.density *= 1.1;
        assert!(!differ_in_load_alone(&pair, &other));
    }
}
