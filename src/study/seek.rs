//! The values of a field at which a condition changes: every crossing in a range.

use super::axis::{Axis, AxisRange, Sampling};
use super::batch::{Batch, Control, Points, Stopped, solve_all};
use super::condition::{Condition, State};
use super::sweep::Grid;
use crate::case::Problem;
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

/// Two neighbouring points between which the state changes.
#[derive(Debug, Clone, PartialEq)]
pub struct Crossing {
    /// The lower end of the bracket.
    pub lower: Sample,
    /// The upper end of the bracket.
    pub upper: Sample,
}

/// A part of the range with one state.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Its first point.
    pub from: f64,
    /// Its last point.
    pub to: f64,
    /// The state; an unknown state has the reason at its first point.
    pub state: State,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Every change of the state, in order.
    pub crossings: Vec<Crossing>,
    /// The parts of the range between them.
    pub segments: Vec<Segment>,
    /// Number of solves.
    pub solves: usize,
}

/// Why a search fails.
#[derive(Debug, Clone, PartialEq)]
pub enum SeekError {
    /// A field does not accept a value, or the scan has too few points.
    Bad(Problem),
    /// The user stopped the search.
    Stopped,
}

impl From<Stopped> for SeekError {
    fn from(_: Stopped) -> SeekError {
        SeekError::Stopped
    }
}

impl From<Problem> for SeekError {
    fn from(problem: Problem) -> SeekError {
        SeekError::Bad(problem)
    }
}

/// Finds every value of a field at which a condition changes.
///
/// The search first scans the range with `scan` points. It divides each interval with different
/// states at its ends until its width is 1e-9 of the value. It also divides the interval where the
/// quantity turns back close to its limit, so that it finds two crossings close to each other.
///
/// # Errors
/// Returns an error if the scan is not possible, or if the user stops the search.
pub fn seek(
    inputs: &Inputs,
    range: &AxisRange,
    condition: &Condition,
    points: usize,
    control: &Control,
) -> Result<Found, SeekError> {
    let scan = range.axis(Sampling { points: Some(points), is_log: false })?;
    let search = Search { inputs, range, condition, control };
    let mut samples = search.solve(scan)?;
    for _ in 0..MOST_ROUNDS {
        let wanted = search.refinement(&samples);
        if wanted.is_empty() {
            break;
        }
        let axis = Axis {
            field: range.field,
            unit: range.unit.clone(),
            points: wanted.into_iter().map(|number| range.at(number)).collect::<Result<_, _>>()?,
        };
        samples.extend(search.solve(axis)?);
        samples.sort_by(|one, other| one.at.total_cmp(&other.at));
    }
    Ok(found(&samples))
}

struct Search<'a> {
    inputs: &'a Inputs,
    range: &'a AxisRange,
    condition: &'a Condition,
    control: &'a Control<'a>,
}

impl Search<'_> {
    fn solve(&self, axis: Axis) -> Result<Vec<Sample>, Stopped> {
        let quantities: Vec<_> = self.condition.quantity().into_iter().collect();
        let grid = Grid { axes: vec![axis] };
        let batch = Batch { inputs: self.inputs, points: &grid, quantities: &quantities };
        let mut samples = Vec::with_capacity(grid.count());
        solve_all(&batch, 0..grid.count(), self.control, &mut |rows| {
            samples.extend(rows.range().enumerate().map(|(row, index)| Sample {
                at: grid.axes[0].points[index].number.unwrap_or_default(),
                state: self.condition.state(&rows, row),
                value: rows.values(row).next().flatten(),
            }));
            true
        })?;
        Ok(samples)
    }

    /// New points in the intervals that need refinement.
    fn refinement(&self, samples: &[Sample]) -> Vec<f64> {
        let mut intervals = vec![false; samples.len()];
        for (at, pair) in samples.windows(2).enumerate() {
            let is_changed = !pair[0].state.is_like(&pair[1].state);
            intervals[at] |= is_changed && self.is_wide(&pair[0], &pair[1]);
        }
        for (at, three) in samples.windows(3).enumerate() {
            if self.turns_back(three) {
                intervals[at] = true;
                intervals[at + 1] = true;
            }
        }
        let wanted = samples.windows(2).zip(intervals).filter(|(_, is)| *is);
        wanted.flat_map(|(pair, _)| pieces(pair[0].at, pair[1].at)).collect()
    }

    fn is_wide(&self, lower: &Sample, upper: &Sample) -> bool {
        let span = self.range.to - self.range.from;
        let size = lower.at.abs().max(upper.at.abs());
        upper.at - lower.at > (WIDTH * size).max(WIDTH_AT_ZERO * span)
    }

    /// Whether the quantity is so close to its limit at the middle of three points with one state
    /// that it may cross the limit between them.
    fn turns_back(&self, three: &[Sample]) -> bool {
        let is_one_answer = three[0].state.is_like(&three[1].state)
            && three[1].state.is_like(&three[2].state)
            && !matches!(three[0].state, State::Unknown(_));
        let margins = three.iter().map(|sample| self.condition.margin(sample.value?));
        let Some(margins) = margins.collect::<Option<Vec<f64>>>().filter(|_| is_one_answer) else {
            return false;
        };
        let [left, middle, right] = [margins[0].abs(), margins[1].abs(), margins[2].abs()];
        let is_nearest = middle < left.max(right) && middle <= left.min(right);
        // Assumes that between the points the margin falls by at most as much as it fell towards
        // the middle point.
        is_nearest && 2.0 * middle <= left.max(right) && self.is_wide(&three[0], &three[2])
    }
}

/// The numbers that divide an interval, without its ends.
fn pieces(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let step = (to - from) / PIECES as f64;
    (1..PIECES)
        .map(move |piece| from + step * piece as f64)
        .filter(move |&number| from < number && number < to)
}

fn found(samples: &[Sample]) -> Found {
    let changes = samples.windows(2).filter(|pair| !pair[0].state.is_like(&pair[1].state));
    let crossings =
        changes.map(|pair| Crossing { lower: pair[0].clone(), upper: pair[1].clone() }).collect();
    let mut segments: Vec<Segment> = Vec::new();
    for sample in samples {
        match segments.last_mut() {
            Some(segment) if segment.state.is_like(&sample.state) => segment.to = sample.at,
            _ => segments.push(Segment {
                from: sample.at,
                to: sample.at,
                state: sample.state.clone(),
            }),
        }
    }
    Found { crossings, segments, solves: samples.len() }
}
