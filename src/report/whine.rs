//! Mesh frequency and resonance as a sentence.

pub mod charts;

use super::value;
use crate::model::{Quantity, Solution};
use crate::numeric::decimal::significant;

/// Significant digits of a frequency or a speed.
const DIGITS: usize = 3;

/// Range of the resonance ratio for main resonance, ISO 6336-1.
const RESONANCE: std::ops::RangeInclusive<f64> = 0.85..=1.15;

/// The mesh frequency and the speed of resonance, from the full text to the shortest; `None` if the
/// method has no mesh.
#[must_use]
pub fn whine(solution: &Solution) -> Option<[String; 4]> {
    let of = |key| value(Quantity::find(key)?, solution);
    let (frequency, ratio) = (of("mesh_frequency")?, of("resonance_ratio")?);
    let speed = of("resonance_speed")? * 30.0 / std::f64::consts::PI;
    let (frequency, speed) = (rounded(frequency), rounded(speed));
    let number = format!("now N = {}", significant(ratio, 2));
    let near = if RESONANCE.contains(&ratio) {
        ", near resonance"
    } else {
        ""
    };
    Some([
        format!("Mesh frequency {frequency} Hz; resonance at {speed} rpm ({number}{near})"),
        format!("Mesh {frequency} Hz; resonance at {speed} rpm ({number})"),
        format!("Resonance {speed} rpm; {number}"),
        format!("Resonance {speed} rpm"),
    ])
}

/// A number with three significant digits, followed by zeros.
fn rounded(number: f64) -> String {
    let rounded = format!("{number:.*e}", DIGITS - 1);
    match rounded.parse::<f64>() {
        Ok(rounded) if rounded >= 1e3 => format!("{rounded:.0}"),
        _ => significant(number, DIGITS),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Stages;
    use crate::model::inputs::Method;
    use crate::model::sample::standard_pair;
    use crate::model::solve;

    #[test]
    fn numbers_have_three_digits() {
        for (number, text) in [
            (666.67, "667"),
            (5478.2, "5480"),
            (16_569.0, "16600"),
            (1_234_567.0, "1230000"),
            (999.9, "1000"),
            (0.123_45, "0.123"),
        ] {
            assert_eq!(rounded(number), text);
        }
    }

    #[test]
    fn a_pair_at_its_resonance_speed_is_near_resonance() {
        let mut inputs = standard_pair(20, 30, 5e-3);
        inputs.method = Method::Static;
        let mut sentence = |speed: f64| {
            inputs.speed = speed;
            let solution = solve(&inputs, Stages::EVERY).unwrap();
            let natural = solution.resonance.unwrap().natural_frequency;
            (natural, whine(&solution).unwrap()[0].clone())
        };
        let (natural, slow) = sentence(100.0);
        assert!(slow.starts_with("Mesh frequency 318 Hz; resonance at "));
        assert!(!slow.contains("near resonance"), "{slow}");
        let (_, fast) = sentence(std::f64::consts::TAU * natural / 20.0);
        assert!(fast.ends_with("(now N = 1.0, near resonance)"), "{fast}");
    }
}
