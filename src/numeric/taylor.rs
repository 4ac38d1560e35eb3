//! Steps of a linear oscillator with variable stiffness and load, by the power series of its
//! motion.

use super::polynomial::Polynomial;

/// x'' = load − damping x' − stiffness x over a step from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator<const N: usize> {
    /// Stiffness over mass.
    pub stiffness: Polynomial<N>,
    /// Load over mass.
    pub load: Polynomial<N>,
    /// Damping over mass.
    pub damping: f64,
}

impl<const N: usize> Oscillator<N> {
    /// The power series of the motion that begins with `x` and its rate `v`.
    ///
    /// # Formula
    /// ```text
    /// (n+1)(n+2) x_(n+2) = load_n − damping (n+1) x_(n+1) − Σ stiffness_i x_(n−i),   i = 0 .. n
    /// ```
    ///
    /// # Source
    /// Taylor's method with recurrences for the coefficients: Corliss & Chang 1982, "Solving
    /// ordinary differential equations using Taylor series", ACM TOMS 8; Barrio 2005, "Performance
    /// of the Taylor series method for ODEs/DAEs", Applied Mathematics and Computation 163.
    pub fn series(&self, x: f64, v: f64) -> Polynomial<N> {
        let (mut series, mut pulls) = ([0.0; N], [0.0; N]);
        let stiffness = self.stiffness.terms();
        (series[0], series[1]) = (x, v);
        add_pull(&mut pulls, stiffness, x);
        add_pull(&mut pulls[1..], stiffness, v);
        for order in 2..N {
            let rate = (order - 1) as f64;
            let last = self.damping * rate * series[order - 1];
            let push = self.load.0[order - 2] - last - pulls[order - 2];
            series[order] = push / (rate * order as f64);
            add_pull(&mut pulls[order..], stiffness, series[order]);
        }
        Polynomial(series)
    }
}

/// Adds one term of the series to the sums of its order and of all later orders. These sums are
/// independent of each other.
fn add_pull(pulls: &mut [f64], stiffness: &[f64], term: f64) {
    for (pull, stiffness) in pulls.iter_mut().zip(stiffness) {
        *pull += stiffness * term;
    }
}

/// The part of a step in which the last terms of a series are at most `allowed`, up to 1.
///
/// # Source
/// Jorba & Zou 2005, "A software package for the numerical integration of ODEs by means of
/// high-order Taylor methods", Experimental Mathematics 14, section 3. The step length is known
/// before the step, so that no step is rejected.
pub fn convergent_part<const N: usize>(series: &Polynomial<N>, allowed: f64) -> f64 {
    const LAST: usize = 3;
    let part = |order: usize| {
        let size = series.0[order].abs() / allowed;
        if size <= 1.0 { 1.0 } else { size.powf(-1.0 / order as f64) }
    };
    // Keeps a NaN of the last term, which `f64::min` would drop.
    (N - LAST..N).map(part).fold(1.0, |least, part| if part >= least { least } else { part })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TERMS: usize = 28;

    fn oscillator<const N: usize>(stiffness: &[f64], load: &[f64], damping: f64) -> Oscillator<N> {
        let padded = |given: &[f64]| {
            let mut all = Polynomial::ZERO;
            all.0.iter_mut().zip(given).for_each(|(coefficient, given)| *coefficient = *given);
            all
        };
        Oscillator { stiffness: padded(stiffness), load: padded(load), damping }
    }

    #[test]
    fn a_linear_oscillator_follows_its_closed_form() {
        // x'' + 0.6 x' + 4 x = 8 oscillates about 2 with the frequency √(4 − 0.09).
        let series = oscillator::<TERMS>(&[4.0], &[8.0], 0.6).series(3.0, 0.0);
        let frequency = 3.91f64.sqrt();
        for step in 0..=10 {
            let t = 0.1 * f64::from(step);
            let swing = (-0.3 * t).exp()
                * ((frequency * t).cos() + 0.3 / frequency * (frequency * t).sin());
            assert!((series.at(t) - 2.0 - swing).abs() < 1e-13, "{t}");
        }
    }

    #[test]
    fn airys_equation_has_the_coefficients_of_its_functions() {
        // x'' = t x: a_(n+3) = a_n/((n+2)(n+3)).
        let (value, slope) = (0.355_028_053_887_817_2, -0.258_819_403_792_806_8);
        let series = oscillator::<TERMS>(&[0.0, -1.0], &[], 0.0).series(value, slope);
        for order in 0..TERMS - 3 {
            let expected = series.0[order] / ((order + 2) * (order + 3)) as f64;
            assert!((series.0[order + 3] - expected).abs() <= 1e-15 * expected.abs(), "{order}");
        }
        assert!((series.at(1.0) - 0.135_292_416_312_881_4).abs() < 1e-15);
    }

    #[test]
    fn a_stiffness_made_for_a_motion_reproduces_the_motion() {
        // x = e^t: x'' + 0.5 x' + (1 + t) x = (2.5 + t) e^t.
        let load: Vec<f64> = (0..TERMS)
            .map(|order| {
                let factorial: f64 = (1..=order).map(|factor| factor as f64).product();
                2.5 / factorial + if order > 0 { order as f64 / factorial } else { 0.0 }
            })
            .collect();
        let series = oscillator::<TERMS>(&[1.0, 1.0], &load, 0.5).series(1.0, 1.0);
        assert!((series.at(1.0) - 1f64.exp()).abs() < 1e-14);
    }

    fn off_with<const N: usize>(length: f64) -> f64 {
        let series = oscillator::<N>(&[length * length], &[], 0.0).series(1.0, 0.3 * length);
        (series.at(1.0) - length.cos() - 0.3 * length.sin()).abs()
    }

    #[test]
    fn each_term_raises_the_order_by_one() {
        for (terms, off) in
            [(8.0, off_with::<8> as fn(f64) -> f64), (10.0, off_with::<10>), (12.0, off_with::<12>)]
        {
            let order = (off(2.0) / off(1.0)).log2();
            assert!((order - terms).abs() < 0.5, "{terms} terms: {order}");
        }
    }

    #[test]
    fn the_error_of_the_convergent_part_is_at_most_the_allowed_error() {
        for (length, allowed) in [(1.0, 1e-9), (9.0, 1e-4), (9.0, 1e-12), (40.0, 1e-6)] {
            let series = oscillator::<TERMS>(&[length * length], &[], 0.0).series(1.0, 0.0);
            let part = convergent_part(&series, allowed);
            let off = (series.at(part) - (part * length).cos()).abs();
            assert!(off <= allowed && part > 0.05, "{length}: {part}, {off:e}");
            assert_eq!(part < 1.0, length > 3.0);
        }
        assert!(convergent_part(&Polynomial([1.0, f64::NAN, f64::NAN, f64::NAN]), 1.0).is_nan());
    }
}
