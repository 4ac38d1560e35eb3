//! A sweep: a case solved over a grid of one or more varied fields.

use super::axis::{Axis, AxisPoint, Sampling};
use super::batch::{Points, Sequence};
use crate::case::{Case, Problem};
use crate::model::Inputs;
use crate::model::inputs::Method;

/// Greatest number of points of a sweep.
pub const MOST_SWEPT: usize = 100_000_000;

/// The grid of a sweep. The first axis varies slowest.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// The varied fields.
    pub axes: Vec<Axis>,
}

impl Grid {
    /// A grid over axes.
    ///
    /// # Errors
    /// Returns an error if two axes vary one field, or fields that exclude each other.
    pub fn of(axes: Vec<Axis>) -> Result<Grid, Problem> {
        for (at, axis) in axes.iter().enumerate() {
            apart(&axes[..at], axis)?;
        }
        Ok(Grid { axes })
    }

    /// Parses texts such as `operation.speed=500..3000 rpm`. `points` has one number for all
    /// ranges, or one for each range in order.
    ///
    /// # Errors
    /// Returns the invalid text and its problem.
    pub fn parse<'t>(
        texts: &'t [String],
        points: &[usize],
        is_log: bool,
    ) -> Result<Grid, (&'t str, Problem)> {
        let mut axes: Vec<Axis> = Vec::new();
        let mut ranges = 0;
        for text in texts {
            let count = points.get(ranges).or(points.last().filter(|_| points.len() == 1));
            let sampling = Sampling { points: count.copied(), is_log };
            ranges += usize::from(Axis::is_range(text));
            let axis = Axis::parse(text, sampling).map_err(|problem| (text.as_str(), problem))?;
            apart(&axes, &axis).map_err(|problem| (text.as_str(), problem))?;
            axes.push(axis);
        }
        let grid = Grid { axes };
        let last = texts.last().map_or("", String::as_str);
        if points.len() > 1 && points.len() != ranges {
            return Err((last, unlike_points(points.len(), ranges)));
        }
        grid.checked_count().map(|_| grid).map_err(|problem| (last, problem))
    }

    fn checked_count(&self) -> Result<usize, Problem> {
        let product = self
            .axes
            .iter()
            .try_fold(1_usize, |product, axis| product.checked_mul(axis.points.len()));
        product.filter(|&count| count <= MOST_SWEPT).ok_or_else(|| {
            let cause = format!("the grid has more than {MOST_SWEPT} points");
            let key = self.axes.last().map_or("", Axis::key);
            Problem::new(key, cause, "write fewer --points")
        })
    }

    /// The axes of a point with the index of its value on each axis.
    pub fn places(&self, index: usize) -> impl Iterator<Item = (&Axis, usize)> {
        let mut step = self.count();
        let mut rest = index;
        self.axes.iter().map(move |axis| {
            step /= axis.points.len();
            let at = rest / step;
            rest %= step;
            (axis, at)
        })
    }

    /// Every method of the points.
    #[must_use]
    pub fn methods(&self, inputs: &Inputs) -> Vec<Method> {
        let mut found = vec![inputs.method];
        for axis in self.axes.iter().filter(|axis| axis.key() == "model.method") {
            let of = |point: &AxisPoint| {
                let mut inputs = inputs.clone();
                point.put(axis.field, &mut inputs);
                inputs.method
            };
            found = axis.points.iter().map(of).collect();
        }
        found
    }

    /// Writes the values of a point into inputs.
    pub fn put(&self, index: usize, inputs: &mut Inputs) {
        for (axis, at) in self.places(index) {
            axis.points[at].put(axis.field, inputs);
        }
    }
}

impl Points for Grid {
    fn count(&self) -> usize {
        self.axes.iter().map(|axis| axis.points.len()).product()
    }

    fn point(&self, index: usize) -> String {
        let setting =
            |(axis, at): (&Axis, usize)| format!("{} = {}", axis.key(), axis.with_unit(at));
        self.places(index).map(setting).collect::<Vec<_>>().join(", ")
    }

    fn sequence(&self) -> Sequence<'_> {
        Box::new(|index, inputs| {
            self.put(index, inputs);
            Ok(())
        })
    }
}

/// Checks that an axis varies another field than the previous axes.
fn apart(others: &[Axis], axis: &Axis) -> Result<(), Problem> {
    let refused = |cause: String| Err(Problem::new(axis.key(), cause, "leave one of them out"));
    for other in others {
        if other.field == axis.field {
            return refused(format!("{} is varied twice", axis.key()));
        }
        if Case::are_exclusive(other.key(), axis.key()) {
            return refused(format!("{} and {} exclude each other", other.key(), axis.key()));
        }
    }
    Ok(())
}

fn unlike_points(points: usize, ranges: usize) -> Problem {
    let cause = format!("--points is given {points} times for {ranges} ranges");
    Problem::new("--points", cause, "give it once for all ranges, or once for each")
}
