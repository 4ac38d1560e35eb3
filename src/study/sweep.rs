//! A sweep: a case solved over a grid of one or more varied fields.

use super::axis::{Axis, AxisPoint, Sampling};
use super::batch::Points;
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
        let (mut ranges, mut count) = (0, 1_usize);
        for text in texts {
            let points = if points.len() == 1 { points.first() } else { points.get(ranges) };
            let sampling = Sampling { points: points.copied(), is_log };
            ranges += usize::from(Axis::is_range(text));
            let axis = Axis::parse(text, sampling)
                .and_then(|axis| apart(&axes, &axis).map(|()| axis))
                .map_err(|problem| (text.as_str(), problem))?;
            count = count.saturating_mul(axis.points.len());
            axes.push(axis);
        }
        let problem = if points.len() > 1 && points.len() != ranges {
            let cause = format!("--points is given {} times for {ranges} ranges", points.len());
            Problem::new("--points", cause, "give it once for all ranges, or once for each")
        } else if count > MOST_SWEPT {
            let cause = format!("the grid has more than {MOST_SWEPT} points");
            Problem::new(axes.last().map_or("", Axis::key), cause, "write fewer --points")
        } else {
            return Ok(Grid { axes });
        };
        Err((texts.last().map_or("", String::as_str), problem))
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
    pub fn methods(&self, inputs: &Inputs) -> Vec<Method> {
        let Some(axis) = self.axes.iter().find(|axis| axis.key() == "model.method") else {
            return vec![inputs.method];
        };
        let of = |point: &AxisPoint| {
            let mut inputs = inputs.clone();
            point.put(axis.field, &mut inputs);
            inputs.method
        };
        axis.points.iter().map(of).collect()
    }
}

impl Points for Grid {
    fn count(&self) -> usize {
        self.axes.iter().map(|axis| axis.points.len()).product()
    }

    /// The varied fields in their units.
    fn columns(&self) -> Vec<(String, &str)> {
        self.axes.iter().map(|axis| (axis.key().to_owned(), axis.unit.as_str())).collect()
    }

    fn cells(&self, index: usize) -> Vec<String> {
        self.places(index).map(|(axis, at)| axis.points[at].text.clone()).collect()
    }

    fn put(&self, index: usize, inputs: &mut Inputs) -> Result<(), Problem> {
        for (axis, at) in self.places(index) {
            axis.points[at].put(axis.field, inputs);
        }
        Ok(())
    }
}

/// Checks that an axis varies another field than the previous axes.
fn apart(others: &[Axis], axis: &Axis) -> Result<(), Problem> {
    let key = axis.key();
    let cause = others.iter().find_map(|other| match other.key() {
        own if own == key => Some(format!("{key} is varied twice")),
        other if Case::are_exclusive(other, key) => {
            Some(format!("{other} and {key} exclude each other"))
        }
        _ => None,
    });
    match cause {
        Some(cause) => Err(Problem::new(key, cause, "leave one of them out")),
        None => Ok(()),
    }
}
