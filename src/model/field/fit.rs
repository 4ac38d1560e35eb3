//! Chebyshev series over the flank.

use std::f64::consts::PI;

use crate::numeric::real::Lanes;

/// Terms of a series in one radius.
pub(super) const TERMS: usize = 14;
/// Terms in each radius of a series in two radii.
const CROSS_TERMS: usize = 9;

/// The loaded part of a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Flank {
    /// Base radius, in m.
    pub(super) base: f64,
    /// Roll angle at the tip circle, in rad.
    pub(super) tip_roll: f64,
    /// Roll angles of the outermost loads, from the junction, in rad.
    pub(super) rolls: [f64; 2],
    /// Radii of the outermost loads, from the junction, in m.
    pub(super) radii: [f64; 2],
}

impl Flank {
    /// The part of a flank between the roll angles of the outermost loads, from the junction.
    pub(super) fn of(base: f64, tip_roll: f64, rolls: [f64; 2]) -> Flank {
        Flank { base, tip_roll, rolls, radii: rolls.map(|roll| base.hypot(base * roll)) }
    }

    /// Roll angle at a radius, in rad, limited to the range of the loads.
    pub(super) fn roll(&self, radius: f64) -> f64 {
        let over_base = (radius - self.base).max(0.0);
        let roll = (over_base * (radius + self.base)).sqrt() / self.base;
        roll.max(self.rolls[0]).min(self.rolls[1])
    }
}

/// Place on the flank, from −1 at the tip's load to 1 at the junction.
///
/// # Formula
/// ```text
/// ln((φ_a + δ − φ)/(φ − φ_J + ε))
/// ```
/// The compliance is a smooth function of this place. It rises steeply towards the tip, and the
/// loads are densest near the tip and the junction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Abscissa {
    /// φ_a + δ and φ_J − ε, in rad.
    ends: [f64; 2],
    middle: f64,
    scale: f64,
}

impl Abscissa {
    /// The abscissa for the arc lengths δ and ε, in m.
    pub(super) fn of(flank: &Flank, beyond: [f64; 2]) -> Abscissa {
        let slope = flank.base * f64::midpoint(flank.tip_roll, flank.rolls[0]);
        let ends = [
            flank.tip_roll + beyond[0] / (flank.base * flank.tip_roll),
            flank.rolls[0] - beyond[1] / slope,
        ];
        let [far, near] = flank.rolls.map(|roll| ratio(ends, roll).ln());
        Abscissa { ends, middle: f64::midpoint(far, near), scale: 2.0 / (far - near) }
    }

    /// The abscissa at a roll angle.
    pub(super) fn at(&self, roll: f64) -> f64 {
        (ratio(self.ends, roll).ln() - self.middle) * self.scale
    }
}

fn ratio([above, below]: [f64; 2], roll: f64) -> f64 {
    (above - roll) / (roll - below)
}

/// Rational interpolation between points without poles.
///
/// # Source
/// Floater & Hormann 2007, "Barycentric rational interpolation with no poles and high rates of
/// approximation".
#[derive(Debug, Clone)]
pub(super) struct Interpolation {
    places: Vec<f64>,
    weights: Vec<f64>,
}

impl Interpolation {
    /// Interpolation between ordered places.
    pub(super) fn new(places: Vec<f64>) -> Interpolation {
        const DEGREE: usize = 6;
        let last = places.len() - 1;
        let degree = DEGREE.min(last);
        let weight = |index: usize| {
            let blends = index.saturating_sub(degree)..=index.min(last - degree);
            let sum: f64 = blends
                .map(|start| {
                    (start..=start + degree)
                        .filter(|&other| other != index)
                        .map(|other| (places[index] - places[other]).abs().recip())
                        .product::<f64>()
                })
                .sum();
            if index.is_multiple_of(2) { sum } else { -sum }
        };
        Interpolation { weights: (0..=last).map(weight).collect(), places }
    }

    /// The weight of each place in the value at `x`.
    fn shares(&self, x: f64) -> Vec<f64> {
        const SAME: f64 = 1e-14;
        let is_here = |place: &f64| (place - x).abs() < SAME;
        if let Some(hit) = self.places.iter().position(is_here) {
            return (0..self.places.len()).map(|index| f64::from(u8::from(index == hit))).collect();
        }
        let pulls = self.weights.iter().zip(&self.places);
        let pulls: Vec<_> = pulls.map(|(weight, place)| weight / (x - place)).collect();
        let sum: f64 = pulls.iter().sum();
        pulls.into_iter().map(|pull| pull / sum).collect()
    }

    /// Matrix that converts values at the places to `N` Chebyshev coefficients.
    fn to_series<const N: usize>(&self) -> [Vec<f64>; N] {
        let angle = |point: usize| PI * (point as f64 + 0.5) / N as f64;
        let shares: [_; N] = std::array::from_fn(|point| self.shares(angle(point).cos()));
        std::array::from_fn(|order| {
            let scale = if order == 0 { 1.0 } else { 2.0 } / N as f64;
            let mut row = vec![0.0; self.places.len()];
            for (point, shares) in shares.iter().enumerate() {
                let factor = scale * (order as f64 * angle(point)).cos();
                for (sum, share) in row.iter_mut().zip(shares) {
                    *sum += factor * share;
                }
            }
            row
        })
    }

    /// The series of values at the places.
    pub(super) fn series(&self, values: &[f64]) -> Series {
        Series(self.to_series().map(|row| inner(&row, values)))
    }

    /// The series of values at pairs of places, row by row.
    pub(super) fn cross_series(&self, values: &[f64]) -> CrossSeries {
        let matrix = self.to_series::<CROSS_TERMS>();
        let halfway: Vec<[f64; CROSS_TERMS]> = values
            .chunks_exact(self.places.len())
            .map(|row| matrix.each_ref().map(|terms| inner(terms, row)))
            .collect();
        let column = |terms: &Vec<f64>| {
            std::array::from_fn(|order| {
                terms.iter().zip(&halfway).map(|(term, row)| term * row[order]).sum()
            })
        };
        CrossSeries(matrix.each_ref().map(column))
    }
}

fn inner(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(left, right)| left * right).sum()
}

/// A Chebyshev series of one variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Series([f64; TERMS]);

impl Series {
    /// The value at `x`, by Clenshaw's recurrence.
    pub(super) fn at(&self, x: f64) -> f64 {
        clenshaw(&self.0, x)
    }
}

/// A Chebyshev series of two variables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CrossSeries([[f64; CROSS_TERMS]; CROSS_TERMS]);

impl CrossSeries {
    /// The values for loads at `loaded`, measured at `measured`.
    pub(super) fn at<const L: usize>(&self, loaded: Lanes<L>, measured: Lanes<L>) -> Lanes<L> {
        let mut orders = [Lanes::all(0.0); CROSS_TERMS];
        let (mut last, mut term) = (loaded, Lanes::all(1.0));
        for row in &self.0 {
            for (order, coefficient) in orders.iter_mut().zip(row) {
                *order = *order + term * *coefficient;
            }
            (last, term) = (term, loaded * 2.0 * term - last);
        }
        let (mut next, mut after) = (Lanes::all(0.0), Lanes::all(0.0));
        for order in orders[1..].iter().rev() {
            (next, after) = (*order + measured * 2.0 * next - after, next);
        }
        orders[0] + measured * next - after
    }
}

/// Sum of a Chebyshev series.
///
/// # Source
/// Clenshaw 1955, "A note on the summation of Chebyshev series".
fn clenshaw(coefficients: &[f64], x: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for coefficient in coefficients[1..].iter().rev() {
        (next, after) = (coefficient + 2.0 * x * next - after, next);
    }
    coefficients[0] + x * next - after
}
