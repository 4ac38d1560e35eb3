//! Steps of a differential equation by an embedded Runge-Kutta pair of order 8.

use nalgebra::SVector;

/// Stages of the pair.
const STAGES: usize = 12;

/// An equation y' = f(t, y).
pub trait Equation<const N: usize> {
    /// f(t, y).
    fn slope(&self, t: f64, y: &SVector<f64, N>) -> SVector<f64, N>;
}

/// Where a solution stands: time, state and slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point<const N: usize> {
    /// Time t.
    pub t: f64,
    /// State y.
    pub y: SVector<f64, N>,
    /// f(t, y).
    pub slope: SVector<f64, N>,
}

/// A step that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial<const N: usize> {
    /// The state that it leads to.
    pub y: SVector<f64, N>,
    fifth: SVector<f64, N>,
    third: SVector<f64, N>,
}

impl<const N: usize> Point<N> {
    /// The point at which the solution stands.
    #[must_use]
    pub fn new(equation: &impl Equation<N>, t: f64, y: SVector<f64, N>) -> Point<N> {
        Point { t, y, slope: equation.slope(t, &y) }
    }
}

/// One step from `from` over `length`.
///
/// # Source
/// The pair of order 8 with estimates of order 5 and 3 of Dormand & Prince, in Hairer, Norsett & Wanner 1993, "Solving
/// Ordinary Differential Equations I", section II.5 and the code DOP853 of its appendix.
#[must_use]
pub fn step<const N: usize>(equation: &impl Equation<N>, from: &Point<N>, length: f64) -> Trial<N> {
    let mut slopes = [from.slope; STAGES];
    for (stage, (row, node)) in ROWS.iter().zip(NODES).enumerate() {
        let y = from.y + combined(row, &slopes) * length;
        slopes[stage + 1] = equation.slope(from.t + node * length, &y);
    }
    Trial {
        y: from.y + combined(&WEIGHTS, &slopes) * length,
        fifth: combined(&FIFTH, &slopes) * length,
        third: combined(&THIRD, &slopes) * length,
    }
}

fn combined<const N: usize>(row: &[(usize, f64)], slopes: &[SVector<f64, N>; STAGES]) -> SVector<f64, N> {
    row.iter().fold(SVector::zeros(), |sum, &(stage, weight)| sum + slopes[stage] * weight)
}

impl<const N: usize> Trial<N> {
    /// The estimated error in units of `scale`, the greatest over the components; a component whose scale is infinite does
    /// not count.
    #[must_use]
    pub fn error(&self, scale: &SVector<f64, N>) -> f64 {
        const THIRD_COUNTS: f64 = 0.1;
        let of = |component: usize| {
            let (fifth, third) = (self.fifth[component] / scale[component], self.third[component] / scale[component]);
            let both = fifth.hypot(THIRD_COUNTS * third);
            if both > 0.0 { fifth * fifth / both } else { both }
        };
        (0..N).map(of).fold(0.0, |worst, error| if error <= worst { worst } else { error })
    }
}

/// By what factor the next step may be longer than one whose error was `error` times the allowed one.
///
/// # Source
/// Hairer, Norsett & Wanner 1993, section II.4.
#[must_use]
pub fn stretch(error: f64) -> f64 {
    const CARE: f64 = 0.9;
    const LEAST: f64 = 0.2;
    const MOST: f64 = 5.0;
    // No number is no reason to go on: the shortest step is next.
    if error.is_nan() { LEAST } else { (CARE * error.powf(-1.0 / 8.0)).clamp(LEAST, MOST) }
}

const ROWS: [&[(usize, f64)]; STAGES - 1] = [
    &[(0, 0.05260015195876773)],
    &[(0, 0.0197250569845379), (1, 0.0591751709536137)],
    &[(0, 0.02958758547680685), (2, 0.08876275643042054)],
    &[(0, 0.2413651341592667), (2, -0.8845494793282861), (3, 0.924834003261792)],
    &[(0, 0.037037037037037035), (3, 0.17082860872947386), (4, 0.12546768756682242)],
    &[(0, 0.037109375), (3, 0.17025221101954405), (4, 0.06021653898045596), (5, -0.017578125)],
    &[
        (0, 0.03709200011850479),
        (3, 0.17038392571223998),
        (4, 0.10726203044637328),
        (5, -0.015319437748624402),
        (6, 0.008273789163814023),
    ],
    &[
        (0, 0.6241109587160757),
        (3, -3.3608926294469414),
        (4, -0.868219346841726),
        (5, 27.59209969944671),
        (6, 20.154067550477894),
        (7, -43.48988418106996),
    ],
    &[
        (0, 0.47766253643826434),
        (3, -2.4881146199716677),
        (4, -0.590290826836843),
        (5, 21.230051448181193),
        (6, 15.279233632882423),
        (7, -33.28821096898486),
        (8, -0.020331201708508627),
    ],
    &[
        (0, -0.9371424300859873),
        (3, 5.186372428844064),
        (4, 1.0914373489967295),
        (5, -8.149787010746927),
        (6, -18.52006565999696),
        (7, 22.739487099350505),
        (8, 2.4936055526796523),
        (9, -3.0467644718982196),
    ],
    &[
        (0, 2.273310147516538),
        (3, -10.53449546673725),
        (4, -2.0008720582248625),
        (5, -17.9589318631188),
        (6, 27.94888452941996),
        (7, -2.8589982771350235),
        (8, -8.87285693353063),
        (9, 12.360567175794303),
        (10, 0.6433927460157636),
    ],
];
const NODES: [f64; STAGES - 1] = [
    0.05260015195876773,
    0.0789002279381516,
    0.1183503419072274,
    0.2816496580927726,
    0.3333333333333333,
    0.25,
    0.3076923076923077,
    0.6512820512820513,
    0.6,
    0.8571428571428571,
    1.0,
];
const WEIGHTS: [(usize, f64); 8] = [
    (0, 0.054293734116568765),
    (5, 4.450312892752409),
    (6, 1.8915178993145003),
    (7, -5.801203960010585),
    (8, 0.3111643669578199),
    (9, -0.1521609496625161),
    (10, 0.20136540080403034),
    (11, 0.04471061572777259),
];
const THIRD: [(usize, f64); 8] = [
    (0, -0.18980075407240762),
    (5, 4.450312892752409),
    (6, 1.8915178993145003),
    (7, -5.801203960010585),
    (8, -0.4226823213237919),
    (9, -0.1521609496625161),
    (10, 0.20136540080403034),
    (11, 0.02265179219836082),
];
const FIFTH: [(usize, f64); 8] = [
    (0, 0.01312004499419488),
    (5, -1.2251564463762044),
    (6, -0.4957589496572502),
    (7, 1.6643771824549864),
    (8, -0.35032884874997366),
    (9, 0.3341791187130175),
    (10, 0.08192320648511571),
    (11, -0.022355307863886294),
];

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use nalgebra::Vector2;

    /// y'' = 0.1 t - y; from (1, 0.1) on y = cos t + 0.1 t.
    pub(in crate::numeric) struct Oscillator;

    impl Equation<2> for Oscillator {
        fn slope(&self, t: f64, y: &Vector2<f64>) -> Vector2<f64> {
            Vector2::new(y[1], -y[0] + 0.1 * t)
        }
    }

    fn error_after(steps: u32) -> f64 {
        let length = 2.0 / f64::from(steps);
        let mut point = Point::new(&Oscillator, 0.0, Vector2::new(1.0, 0.1));
        for step_number in 1..=steps {
            let y = step(&Oscillator, &point, length).y;
            point = Point::new(&Oscillator, f64::from(step_number) * length, y);
        }
        (point.y[0] - 2f64.cos() - 0.2).abs()
    }

    #[test]
    fn halving_the_step_divides_the_error_by_two_to_the_eighth() {
        let order = (error_after(1) / error_after(2)).log2();
        assert!((7.5..9.0).contains(&order), "order {order}");
        assert!(error_after(16) < 1e-14);
    }

    #[test]
    fn the_estimate_is_no_smaller_than_the_error_of_the_step() {
        for length in [0.1, 0.3, 0.6, 1.0f64] {
            let start = Point::new(&Oscillator, 0.0, Vector2::new(1.0, 0.1));
            let trial = step(&Oscillator, &start, length);
            let error = (trial.y[0] - length.cos() - 0.1 * length).abs();
            assert!(trial.error(&Vector2::new(1.0, 1.0)) >= error, "{length}");
        }
    }

    #[test]
    fn a_step_without_a_number_is_shortened() {
        assert!(stretch(f64::NAN) < 1.0 && stretch(2.0) < 1.0 && stretch(1e-9) > 1.0 && stretch(0.0) > 4.0);
    }
}
