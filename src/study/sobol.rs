//! First-order and total Sobol indices: the part of the variance of a result that each field
//! causes.

use super::statistics::{Estimate, NORMAL_95};

/// The indices of one field, with 95 % intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indices {
    /// The part of the variance that the field causes on its own.
    pub first_order: Estimate,
    /// The part of the variance that the field causes alone or together with others.
    pub total: Estimate,
}

/// The results of one sample of the ranking.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// Result of the first sample.
    pub first: f64,
    /// Result of the second sample.
    pub second: f64,
    /// Results of the first sample with the value of the second sample in each field.
    pub swapped: Vec<f64>,
}

/// The indices of every field; `None` if the results do not vary.
///
/// # Formula
/// ```text
/// f0 = mean(A, B),   c = mean(A, B, AB_1, AB_2, ..),   V = mean((A - f0)², (B - f0)²)
/// S_i  = mean((B - c)(AB_i - A))/V
/// ST_i = mean((A - AB_i)²)/(2 V)
/// ```
/// where AB_i is the result of A with field i of B. The intervals are ±1.96 standard errors of the
/// quotients (delta method).
///
/// # Source
/// Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270, Table 2 (b) for S_i and (f) for ST_i
/// (Jansen 1999).
#[must_use]
pub fn indices(samples: &[Ranked]) -> Option<Vec<Indices>> {
    let count = samples.len() as f64;
    let mean = samples.iter().map(|s| s.first + s.second).sum::<f64>() / (2.0 * count);
    let variance_of = |s: &Ranked| {
        let (first, second) = (s.first - mean, s.second - mean);
        0.5 * (first * first + second * second)
    };
    let variance = samples.iter().map(variance_of).sum::<f64>() / count;
    let is_varied = variance > (f64::EPSILON * mean).powi(2);
    let fields = samples.first()?.swapped.len();
    let sum = |s: &Ranked| s.first + s.second + s.swapped.iter().sum::<f64>();
    let centre = samples.iter().map(sum).sum::<f64>() / ((fields + 2) as f64 * count);
    let of_field = |field: usize| {
        let first_order = |s: &Ranked| (s.second - centre) * (s.swapped[field] - s.first);
        let total = |s: &Ranked| 0.5 * (s.first - s.swapped[field]).powi(2);
        Indices {
            first_order: quotient(samples, first_order, variance_of),
            total: quotient(samples, total, variance_of),
        }
    };
    is_varied.then(|| (0..fields).map(of_field).collect())
}

/// The quotient of two means and its interval.
fn quotient(
    samples: &[Ranked],
    part: impl Fn(&Ranked) -> f64,
    whole: impl Fn(&Ranked) -> f64,
) -> Estimate {
    let count = samples.len() as f64;
    let (mut parts, mut wholes) = (0.0, 0.0);
    for sample in samples {
        parts += part(sample);
        wholes += whole(sample);
    }
    let value = parts / wholes;
    let squares =
        samples.iter().map(|sample| (part(sample) - value * whole(sample)).powi(2)).sum::<f64>();
    let error = (squares / (count - 1.0).max(1.0) / count).sqrt() * count / wholes;
    Estimate { value, from: value - NORMAL_95 * error, to: value + NORMAL_95 * error }
}
