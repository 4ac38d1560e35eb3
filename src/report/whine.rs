//! Mesh frequency and resonance as a sentence.

pub mod charts;

use super::value;
use crate::model::{Quantity, Solution};
use crate::numeric::decimal::significant;

/// Significant digits of a frequency or a speed.
const DIGITS: usize = 3;

/// The mesh frequency, the greatest dynamic factor over the speed, and the speed of N = 1, from the
/// full text to the shortest; `None` if the method has no mesh.
#[must_use]
pub fn whine(solution: &Solution) -> Option<[String; 4]> {
    let of = |key| value(Quantity::find(key)?, solution);
    let (frequency, ratio) = (of("mesh_frequency")?, of("resonance_ratio")?);
    let rpm = |speed: f64| rounded(speed * 30.0 / std::f64::consts::PI);
    let (frequency, speed) = (rounded(frequency), rpm(of("resonance_speed")?));
    let now = format!("now N = {}", significant(ratio, 2));
    let peak = |speed, factor| Some((of(speed)?, of(factor)?));
    let rising = peak("resonance_peak_speed", "resonance_peak_factor");
    let falling = peak("resonance_peak_speed_falling", "resonance_peak_factor_falling");
    let at = |(speed, factor)| format!("{} at {} rpm", significant(factor, 3), rpm(speed));
    Some(match (rising, falling) {
        (Some(rising), Some(falling)) => {
            let greatest = at(if falling.1 > rising.1 { falling } else { rising });
            let both = if at(rising) == at(falling) {
                greatest.clone()
            } else {
                format!("{} rising, {} falling", at(rising), at(falling))
            };
            [
                format!(
                    "Greatest dynamic factor {both}; mesh frequency {frequency} Hz, N = 1 of the \
                        mean stiffness at {speed} rpm ({now})"
                ),
                format!("Greatest dynamic factor {both}; {now}"),
                format!("Peak factor {both}"),
                format!("Peak factor {greatest}"),
            ]
        }
        _ => [
            format!(
                "Mesh frequency {frequency} Hz; N = 1 of the mean stiffness at {speed} rpm ({now})"
            ),
            format!("Mesh {frequency} Hz; N = 1 at {speed} rpm ({now})"),
            format!("N = 1 at {speed} rpm; {now}"),
            format!("N = 1 at {speed} rpm"),
        ],
    })
}

/// A number with three significant digits, followed by zeros.
pub(super) fn rounded(number: f64) -> String {
    let rounded = format!("{number:.*e}", DIGITS - 1);
    match rounded.parse::<f64>() {
        Ok(rounded) if rounded >= 1e3 => format!("{rounded:.0}"),
        _ => significant(number, DIGITS),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Method;
    use crate::model::sample::standard_pair;
    use crate::model::solve;
    use crate::model::{Stage, Stages};

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
    fn the_greatest_peak_of_the_motion_is_named_beside_the_speed_of_n_1() {
        let wanted = Stages::of(Stage::SpeedRun);
        let mut inputs = standard_pair(20, 30, 5e-3);
        let mut sentence = |method| {
            inputs.method = method;
            whine(&solve(&inputs, wanted).unwrap()).unwrap()[0].clone()
        };
        let at_rest = sentence(Method::Static);
        assert!(at_rest.starts_with("Mesh frequency ") && at_rest.contains("N = 1 of the mean"));
        let in_motion = sentence(Method::Dynamic);
        assert!(in_motion.starts_with("Greatest dynamic factor "), "{in_motion}");
    }
}
