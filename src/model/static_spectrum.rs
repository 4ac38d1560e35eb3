//! The mesh frequency, the natural frequency, and the harmonics of the static transmission error
//! without base pitch deviations.

use std::f64::consts::TAU;

use super::Refusal;
use super::mesh::Mesh;
use super::static_load::{balance, reaches_ends};
use crate::numeric::root::greatest;
use crate::numeric::{quadrature, root};

/// Samples between two borders of the mesh to find changes of the pairs in contact.
const LOOKS: usize = 16;

/// Static transmission error and tooth force of equal pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticSpectrum {
    /// The transmission error over a base pitch.
    pub spectrum: Spectrum,
    /// Greatest force of a tooth, in N.
    pub tooth_force: f64,
}

/// The static displacement of the driver over one base pitch, for a mesh without base pitch
/// deviations.
///
/// # Formula
/// ```text
/// x(s) by Σ w_k F_k = F0 with e_k = 0,   s from 0 to pb
/// ```
/// Every border of the mesh and every gain or loss of contact divides the pitch, so that each piece
/// of x is smooth.
///
/// # Source
/// The balance of [`static_load`](super::static_load::static_load). Gregory, Harris & Munro 1963
/// name the transmission error as the cause of whine.
///
/// # Errors
/// [`Refusal::BeyondReach`] if the deflection of the pairs exceeds the computed range of the mesh.
pub fn static_spectrum(mesh: &Mesh) -> Result<StaticSpectrum, Refusal> {
    let mesh = &mesh.without_error();
    if reaches_ends(mesh) {
        return Err(Refusal::BeyondReach);
    }
    let mut fourier = Fourier::new();
    let mut tooth_force = 0.0f64;
    for ends in mesh.borders(0.0, mesh.base_pitch).windows(2) {
        let inside = f64::midpoint(ends[0], ends[1]);
        for piece in pieces(mesh, (ends[0], ends[1]), inside).windows(2) {
            let (from, to) = (piece[0], piece[1]);
            let place = |part: f64| from + part * (to - from);
            let ahead = |s: f64| balance(mesh, s, inside).displacement;
            let pitch = mesh.base_pitch;
            fourier.add((from / pitch, to / pitch), |part| ahead(place(part)));
            for sign in [-1.0, 1.0] {
                let (_, most) = peak((from, to), |s| sign * ahead(s));
                fourier.include(sign * most);
            }
            let force = |s: f64| {
                let forces = mesh.pair_set(s, inside).shared(mesh.force).1;
                forces.into_iter().fold(0.0, f64::max)
            };
            tooth_force = tooth_force.max(peak((from, to), force).1);
        }
    }
    Ok(StaticSpectrum { spectrum: fourier.spectrum(1), tooth_force })
}

/// The greatest value of a smooth function and its place.
fn peak((from, to): (f64, f64), value: impl Fn(f64) -> f64) -> (f64, f64) {
    const PLACES: usize = 8;
    let known: Vec<(f64, f64)> = (0..=PLACES)
        .map(|step| from + (to - from) * step as f64 / PLACES as f64)
        .map(|s| (s, value(s)))
        .collect();
    greatest(&known, value)
}

/// The borders of the pieces with the same touching pairs, between two borders of the mesh.
fn pieces(mesh: &Mesh, (from, to): (f64, f64), inside: f64) -> Vec<f64> {
    let touching = |s: f64| {
        let pairs = mesh.pair_set(s, inside);
        let (_, forces) = pairs.shared(mesh.force);
        let carries = pairs.pairs().iter().zip(forces);
        let carries = carries.filter(|(_, force)| *force > 0.0);
        carries.map(|(pair, _)| pair.ahead).collect::<Vec<i32>>()
    };
    let places: Vec<f64> =
        (0..=LOOKS).map(|step| from + (to - from) * step as f64 / LOOKS as f64).collect();
    let sets: Vec<Vec<i32>> = places.iter().map(|&s| touching(s)).collect();
    let mut cuts = vec![from, to];
    for (ends, sets) in places.windows(2).zip(sets.windows(2)) {
        let turned = sets[0].iter().chain(&sets[1]);
        let turned = turned.filter(|pair| sets[0].contains(pair) != sets[1].contains(pair));
        cuts.extend(turned.map(|&pair| {
            root::between(ends[0], ends[1], |s| {
                let lead = mesh.pair_set(s, inside).lead(pair, mesh.force);
                lead.clamp(-mesh.length, mesh.length)
            })
        }));
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|one, other| *one - *other <= 1e-12 * mesh.base_pitch);
    cuts
}

/// Frequencies of a pair, in Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resonance {
    /// Tooth engagements per second, f_z = z₁ n₁.
    pub mesh_frequency: f64,
    /// Natural frequency f_n of the pair with the mean mesh stiffness.
    pub natural_frequency: f64,
}

impl Resonance {
    /// The frequencies of a mesh at a speed of the driver in rad/s, with the reduced mass in kg.
    ///
    /// # Formula
    /// ```text
    /// f_z = ω1 rb1/pb = z1 ω1/(2 π),   f_n = √(k_m/m_red)/(2 π),   N = f_z/f_n
    /// ```
    ///
    /// # Source
    /// ISO 6336-1:2019, 6.5: N = n1/n_E1, n_E1 = 30 000 √(c_γ/m_red)/(π z1).
    ///
    /// # Valid for
    /// Rigid shafts: one mass on the mesh stiffness.
    #[must_use]
    pub fn of(speed: f64, mesh: &Mesh, mass: f64) -> Resonance {
        Resonance {
            mesh_frequency: speed * mesh.base_radii.0 / mesh.base_pitch,
            natural_frequency: (mesh.mean_stiffness() / mass).sqrt() / TAU,
        }
    }

    /// N = f_z/f_n.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.mesh_frequency / self.natural_frequency
    }
}

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
