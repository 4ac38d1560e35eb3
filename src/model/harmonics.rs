//! Harmonics of a periodic function, by integrals over its smooth pieces.

use std::f64::consts::TAU;

use crate::numeric::quadrature;

/// Number of harmonics in a spectrum.
pub const HARMONICS: usize = 10;

/// A transmission error over p mesh periods; p = 1 unless the motion repeats after several periods.
/// Amplitudes of the multiples of the mesh frequency, averaged over the periods, without
/// subharmonics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spectrum {
    /// Amplitudes of the harmonics of the mesh frequency from the first, in m.
    pub amplitudes: [f64; HARMONICS],
    /// Difference of the greatest and the least value, in m.
    pub peak_to_peak: f64,
}

/// Partial sums of a Fourier analysis.
///
/// # Formula
/// ```text
/// A_n = 2 |∫ x(τ) exp(−2 π i n τ) dτ|,   τ from 0 to 1 over the period
/// ```
///
/// # Source
/// Fourier series; the integral over each smooth piece by the 12-point Gauss-Legendre rule.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fourier {
    sums: [[f64; 2]; HARMONICS],
    least: f64,
    most: f64,
}

impl Fourier {
    pub(super) fn new() -> Fourier {
        Fourier { sums: [[0.0; 2]; HARMONICS], least: f64::INFINITY, most: f64::NEG_INFINITY }
    }

    /// Adds a smooth piece between two parts of the period. `value` is a function of the part of
    /// the piece, from 0 to 1.
    pub(super) fn add(&mut self, (from, to): (f64, f64), value: impl Fn(f64) -> f64) {
        /// Number of quadrature intervals per period, which resolves the highest harmonic in each
        /// interval.
        const PIECES_OF_PERIOD: f64 = 2.0 * HARMONICS as f64;
        const LEAST: f64 = 3.0;
        let count = ((to - from) * PIECES_OF_PERIOD).ceil().max(LEAST);
        for piece in 0..count as u32 {
            for (node, weight) in quadrature::nodes() {
                let part = (f64::from(piece) + node) / count;
                let height = weight * (to - from) / count * value(part);
                let phase = TAU * (from + part * (to - from));
                for (order, sum) in (1..).zip(&mut self.sums) {
                    let (sine, cosine) = (f64::from(order) * phase).sin_cos();
                    *sum = [sum[0] + height * cosine, sum[1] + height * sine];
                }
            }
        }
    }

    /// Includes a value in the peak-to-peak range.
    pub(super) fn include(&mut self, value: f64) {
        (self.least, self.most) = (self.least.min(value), self.most.max(value));
    }

    /// The spectrum after `periods` periods.
    pub(super) fn spectrum(&self, periods: u32) -> Spectrum {
        let amplitude =
            |[cosine, sine]: [f64; 2]| 2.0 * cosine.hypot(sine) / f64::from(periods.max(1));
        Spectrum { amplitudes: self.sums.map(amplitude), peak_to_peak: self.most - self.least }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sawtooth_has_the_harmonics_of_its_series() {
        let mut fourier = Fourier::new();
        for ends in [(0.0, 0.3), (0.3, 1.0)] {
            fourier.add(ends, |part| ends.0 + part * (ends.1 - ends.0));
        }
        for (order, amplitude) in (1..).zip(fourier.spectrum(1).amplitudes) {
            let expected = 1.0 / (std::f64::consts::PI * f64::from(order));
            assert!((amplitude / expected - 1.0).abs() < 1e-12, "{order}: {amplitude}");
        }
    }

    #[test]
    fn two_periods_have_the_same_harmonics_as_one() {
        let mut fourier = Fourier::new();
        for _ in 0..2 {
            fourier.add((0.0, 1.0), |part| {
                5.0 + 0.3 * (TAU * part).sin() + 0.02 * (9.0 * TAU * part).cos()
            });
        }
        let found = fourier.spectrum(2).amplitudes;
        for (order, amplitude) in (1..).zip(found) {
            let expected = match order {
                1 => 0.3,
                9 => 0.02,
                _ => 0.0,
            };
            assert!((amplitude - expected).abs() < 1e-14, "{order}: {amplitude:e}");
        }
    }
}
