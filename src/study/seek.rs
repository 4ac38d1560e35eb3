//! The values of a field at which a condition changes: every crossing in a range.

use super::axis::{Axis, AxisRange};
use super::batch::{Batch, Control, Points, Stopped, solve_all};
use super::condition::{Condition, State};
use super::sweep::Grid;
use crate::model::Inputs;

/// Default number of points of the first scan.
pub const USUAL_SCAN: usize = 201;

/// Width of the bracket of a crossing, relative to the value of the field.
const WIDTH: f64 = 1e-9;

/// Width of the bracket of a crossing at 0, relative to the range.
const WIDTH_AT_ZERO: f64 = 1e-15;

/// Pieces into which a round divides an interval.
const PIECES: usize = 16;

/// Greatest number of rounds. One round makes a bracket sixteen times narrower.
const MOST_ROUNDS: usize = 24;

/// A point of the range.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The value of the field, in the unit of the range.
    pub at: f64,
    /// Whether this point meets the condition.
    pub state: State,
    /// The value of the quantity in SI.
    pub value: Option<f64>,
}

/// The result of a search: every solved point, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Found(pub Vec<Sample>);

impl Found {
    /// Every change of the state: the neighbouring points between which it changes.
    pub fn crossings(&self) -> Vec<[&Sample; 2]> {
        let changes = self.0.windows(2).filter(|pair| !pair[0].state.is_like(&pair[1].state));
        changes.map(|pair| [&pair[0], &pair[1]]).collect()
    }

    /// The first and the last point of each part of the range with one state. An unknown state has
    /// the reason at the first point.
    pub fn segments(&self) -> Vec<[&Sample; 2]> {
        let parts = self.0.chunk_by(|one, other| one.state.is_like(&other.state));
        parts.filter_map(|part| Some([part.first()?, part.last()?])).collect()
    }
}

/// Finds every value of a field at which a condition changes.
///
/// `scan` has the points of the range that are solved first. The search divides each interval with different
/// states at its ends until its width is 1e-9 of the value. It also divides the interval where the
/// quantity turns back close to its limit, so that it finds two crossings close to each other.
///
/// # Errors
/// [`Stopped`] if the user stops the search.
pub fn seek(
    inputs: &Inputs,
    range: &AxisRange,
    condition: &Condition,
    scan: Axis,
    control: &Control,
) -> Result<Found, Stopped> {
    let quantities: Vec<_> = condition.quantity().into_iter().collect();
    let solve = |axis: Axis| {
        let grid = Grid { axes: vec![axis] };
        let batch = Batch { inputs, points: &grid, quantities: &quantities };
        let mut samples = Vec::with_capacity(grid.count());
        solve_all(&batch, 0..grid.count(), control, &mut |first, rows| {
            let points = &grid.axes[0].points[first..];
            samples.extend(points.iter().zip(rows).map(|(point, row)| Sample {
                at: point.number.unwrap_or_default(),
                state: condition.state(row),
                value: row.values.first().copied().flatten(),
            }));
            true
        })?;
        Ok(samples)
    };
    let mut samples = solve(scan)?;
    for _ in 0..MOST_ROUNDS {
        let wanted = refinement(range, condition, &samples);
        if wanted.is_empty() {
            break;
        }
        // The field accepts every number between the ends of the range.
        let points = wanted.into_iter().filter_map(|number| range.at(number).ok()).collect();
        samples.extend(solve(Axis { field: range.field, unit: range.unit.clone(), points })?);
        samples.sort_by(|one, other| one.at.total_cmp(&other.at));
    }
    Ok(Found(samples))
}

/// New points in the intervals that need refinement.
fn refinement(range: &AxisRange, condition: &Condition, samples: &[Sample]) -> Vec<f64> {
    let is_wide = |lower: &Sample, upper: &Sample| {
        let size = lower.at.abs().max(upper.at.abs());
        upper.at - lower.at > (WIDTH * size).max(WIDTH_AT_ZERO * (range.to - range.from))
    };
    let mut intervals: Vec<bool> = samples
        .windows(2)
        .map(|pair| !pair[0].state.is_like(&pair[1].state) && is_wide(&pair[0], &pair[1]))
        .collect();
    for (at, three) in samples.windows(3).enumerate() {
        if turns_back(condition, three) && is_wide(&three[0], &three[2]) {
            (intervals[at], intervals[at + 1]) = (true, true);
        }
    }
    let wanted = samples.windows(2).zip(intervals).filter(|(_, is_wanted)| *is_wanted);
    wanted.flat_map(|(pair, _)| pieces(pair[0].at, pair[1].at)).collect()
}

/// Whether the quantity is so close to its limit at the middle of three points with one state that
/// it may cross the limit between them.
fn turns_back(condition: &Condition, three: &[Sample]) -> bool {
    let margin = |sample: &Sample| Some(condition.margin(sample.value?)?.abs());
    let state = &three[0].state;
    let is_one_answer =
        three.iter().all(|one| one.state.is_like(state)) && !matches!(state, State::Unknown(_));
    let [Some(left), Some(middle), Some(right)] = [0, 1, 2].map(|at| margin(&three[at])) else {
        return false;
    };
    let is_nearest = middle < left.max(right) && middle <= left.min(right);
    // Assumes that between the points the margin falls by at most as much as it fell towards the
    // middle point.
    is_one_answer && is_nearest && 2.0 * middle <= left.max(right)
}

/// The numbers that divide an interval, without its ends.
fn pieces(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let step = (to - from) / PIECES as f64;
    (1..PIECES)
        .map(move |piece| from + step * piece as f64)
        .filter(move |&number| from < number && number < to)
}
