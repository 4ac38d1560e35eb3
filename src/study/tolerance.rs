//! Tolerance studies: the results of a case with distributed fields.

use super::batch::{Batch, Control, PointOutcome, Points, Refusals, Row, Stopped, solve_all};
use super::condition::{distinct, headline};
use super::sample::{Design, Distribution, Member};
use super::statistics::{Estimate, Figures, Indices, Ranked, figures, indices, probability};
use crate::case::{Case, Limit, Problem};
use crate::model::{Inputs, Outcome, Quantity};

/// Default number of samples.
pub const USUAL_SAMPLES: usize = 10_000;

/// Greatest number of samples of a study.
pub const MOST_SAMPLES: usize = 100_000_000;

/// Default number of samples of the ranking.
pub const USUAL_RANKED: usize = 4096;

/// Bins of a histogram.
const BINS: usize = 12;

/// A tolerance study: the samples and the requested quantities.
#[derive(Debug, Clone)]
pub struct Tolerance {
    /// The points.
    pub design: Design,
    /// The quantities, including those of the limits.
    pub quantities: Vec<&'static Quantity>,
    /// The limits of the case.
    pub limits: Vec<Limit>,
}

/// The size of a tolerance study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Number of samples.
    pub samples: usize,
    /// Seed of the samples.
    pub seed: u64,
    /// Number of samples of the ranking; by default [`USUAL_RANKED`], or all samples if there are
    /// fewer.
    pub ranked: Option<usize>,
}

impl Tolerance {
    /// The study of a case with `[spread]`. If `only` is empty, the quantities are the headline
    /// quantities.
    ///
    /// # Errors
    /// Returns an error if the case has no distributions, or if a distribution has no value or
    /// exceeds the range of its field.
    pub fn of(
        case: &Case,
        inputs: &Inputs,
        only: &[&'static Quantity],
        size: Size,
    ) -> Result<Tolerance, Problem> {
        if case.spread.is_empty() {
            let fix = "write under [spread] a line such as \
                \"deviations.base_pitch\" = { normal = \"4 um\" }";
            return Err(Problem::new("spread", "the case has no distributions", fix));
        }
        let distributions = case.spread.iter().map(|spread| Distribution::of(spread, case, inputs));
        let distributions = distributions.collect::<Result<Vec<_>, _>>()?;
        // A single field causes all of the spread.
        let ranked = match size.ranked {
            _ if distributions.len() == 1 => 0,
            Some(wanted) => wanted.min(size.samples),
            None => USUAL_RANKED.min(size.samples),
        };
        let limits: Vec<Limit> =
            case.limits.iter().filter(|limit| !limit.text.is_empty()).cloned().collect();
        let limited = limits.iter().flat_map(Limit::quantities);
        let own = if only.is_empty() { headline(case, &[inputs.method]) } else { only.to_vec() };
        let quantities = distinct(own.into_iter().chain(limited));
        let design = Design { seed: size.seed, distributions, samples: size.samples, ranked };
        Ok(Tolerance { design, quantities, limits })
    }

    /// Solves every point.
    ///
    /// # Errors
    /// [`Stopped`] if the user stops the study.
    pub fn run(&self, inputs: &Inputs, control: &Control) -> Result<Samples, Stopped> {
        let mut samples = Samples::of(self);
        let batch = Batch { inputs, points: &self.design, quantities: &self.quantities };
        solve_all(&batch, 0..self.design.count(), control, &mut |first, rows| {
            samples.add(first, rows);
            true
        })?;
        Ok(samples)
    }

    /// The figures of the results.
    pub fn summary(&self, samples: &Samples) -> Summary {
        let count = self.design.samples;
        let outcomes = &samples.outcomes[..count];
        let is = |wanted| outcomes.iter().filter(|&&outcome| outcome == wanted).count();
        let strikes = is(PointOutcome::Solved(Outcome::CornerContact));
        let refused = is(PointOutcome::Refused);
        Summary {
            solved: count - refused,
            contact: probability(strikes, count - refused),
            limits: self
                .limits
                .iter()
                .filter_map(|limit| self.exceedance(limit, samples))
                .collect(),
            quantities: (0..self.quantities.len()).map(|at| self.quantity(at, samples)).collect(),
        }
    }

    fn exceedance(&self, limit: &Limit, samples: &Samples) -> Option<Exceedance> {
        let quantity = Quantity::find(limit.quantity)?;
        let value = |of: &Quantity, sample| {
            let at = self.quantities.iter().position(|known| known.key == of.key)?;
            samples.value(at, sample)
        };
        let exceeds = |sample| {
            let PointOutcome::Solved(outcome) = samples.outcomes[sample] else { return None };
            match value(quantity, sample) {
                Some(own) => Some(own > limit.bound(|of| value(of, sample))?),
                // Without contact there is no value above the limit.
                None => (outcome == Outcome::NoCornerContact || quantity.is_of_free_impact())
                    .then_some(false),
            }
        };
        let states: Vec<bool> = (0..self.design.samples).filter_map(exceeds).collect();
        let above = states.iter().filter(|&&is_above| is_above).count();
        Some(Exceedance {
            quantity,
            limit: limit.clone(),
            known: states.len(),
            probability: probability(above, states.len()),
        })
    }

    fn quantity(&self, at: usize, samples: &Samples) -> OfQuantity {
        let column = samples.columns[at][..self.design.samples].iter().copied();
        let values: Vec<f64> = column.filter(|value| !value.is_nan()).collect();
        let ranked = self.ranked(at, samples);
        OfQuantity {
            quantity: self.quantities[at],
            figures: figures(&values, BINS),
            ranked: ranked.len(),
            indices: indices(&ranked),
        }
    }

    /// The samples of the ranking for which every point has a value.
    fn ranked(&self, at: usize, samples: &Samples) -> Vec<Ranked> {
        let value = |member| samples.value(at, self.design.index(member));
        let fields = 0..self.design.distributions.len();
        let of = |number| {
            let swapped = fields.clone().map(|field| value(Member::Swapped(number, field)));
            Some(Ranked {
                first: value(Member::Sample(number))?,
                second: value(Member::Second(number))?,
                swapped: swapped.collect::<Option<_>>()?,
            })
        };
        (0..self.design.ranked).filter_map(of).collect()
    }
}

/// The results of every point of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// How each point ended.
    pub outcomes: Vec<PointOutcome>,
    /// The refused points.
    pub refusals: Refusals,
    /// One column per quantity, in SI; NaN marks an absent value.
    columns: Vec<Vec<f64>>,
}

impl Samples {
    /// No results yet.
    pub fn of(study: &Tolerance) -> Samples {
        let count = study.design.count();
        let column = |_: &&Quantity| Vec::with_capacity(count);
        Samples {
            outcomes: Vec::with_capacity(count),
            refusals: Refusals::default(),
            columns: study.quantities.iter().map(column).collect(),
        }
    }

    /// Adds the next rows.
    pub fn add(&mut self, first: usize, rows: &[Row]) {
        self.refusals.count(first, rows);
        for row in rows {
            self.outcomes.push(row.outcome);
            for (column, value) in self.columns.iter_mut().zip(&row.values) {
                column.push(value.unwrap_or(f64::NAN));
            }
        }
    }

    /// The value of a quantity at a point, in SI.
    pub fn value(&self, quantity: usize, index: usize) -> Option<f64> {
        Some(self.columns[quantity][index]).filter(|value| !value.is_nan())
    }
}

/// The figures of a tolerance study.
#[derive(Debug, Clone)]
pub struct Summary {
    /// Number of samples that the model solved.
    pub solved: usize,
    /// Probability of corner contact among the solved samples.
    pub contact: Option<Estimate>,
    /// The limits, in the order of the case.
    pub limits: Vec<Exceedance>,
    /// The quantities.
    pub quantities: Vec<OfQuantity>,
}

/// How often a limit is exceeded.
#[derive(Debug, Clone)]
pub struct Exceedance {
    /// The limited quantity.
    pub quantity: &'static Quantity,
    /// The limit.
    pub limit: Limit,
    /// Number of samples that can be compared with the limit.
    pub known: usize,
    /// Probability that the limit is exceeded.
    pub probability: Option<Estimate>,
}

/// The figures of one quantity.
#[derive(Debug, Clone)]
pub struct OfQuantity {
    /// The quantity.
    pub quantity: &'static Quantity,
    /// The figures of its values; `None` without values.
    pub figures: Option<Figures>,
    /// Number of samples that rank the fields.
    pub ranked: usize,
    /// The indices of each spread field; `None` if nothing varies or nothing is ranked.
    pub indices: Option<Vec<Indices>>,
}
