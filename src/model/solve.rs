//! A solve: runs the wanted stages and reuses valid earlier results.

mod by_choice;
mod by_method;
mod repeat;
mod setup;

use super::dynamic::speeds::over_speed;
use super::inputs::{Inputs, Method};
use super::request::Earlier;
use super::{Refusal, Solution, SpeedCurve, Stage, Stages};
use by_choice::solve_by_choice;
use by_method::solve_by_method;
pub use repeat::{Change, differ_in_load_alone, solve_repeated};
pub use setup::Setup;

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
