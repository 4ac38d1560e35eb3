//! A solve: runs the wanted stages, and keeps the earlier results that are still valid.

mod by_choice;
mod by_method;
mod repeat;
mod setup;

use super::inputs::{Inputs, Method};
use super::request::Earlier;
use super::{Refusal, Solution, Stages};
use by_choice::solve_by_choice;
use by_method::solve_by_method;
pub use repeat::{Change, differ_in_load_alone, solve_repeated};
pub use setup::Setup;

/// Solve the pair, running only the wanted stages and what they need.
///
/// Geometry, load and deviation always run, since they tell the outcome. Where a small difference
/// decides, geometry and position are computed in double-double arithmetic, asked for or not.
///
/// # Errors
/// A [`Refusal`] where the pair cannot mesh, or D does not exist. Where only the force cannot be
/// computed, the rest is given and [`Solution::withheld`] says why.
pub fn solve(inputs: &Inputs, wanted: Stages) -> Result<Solution, Refusal> {
    solve_while(inputs, wanted, &|_| true)
}

/// The same, asked now and then whether to go on, with the part that is done, from 0 to 1.
///
/// # Errors
/// Those of [`solve`], and [`Refusal::Stopped`] where `go_on` says no.
pub fn solve_while(
    inputs: &Inputs,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    solve_after(inputs, wanted, None, go_on)
}

/// The same after an earlier solve: what still holds of it is kept, and [`Solution::ran`] tells
/// what was not.
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
