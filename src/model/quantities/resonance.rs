//! Rows of the resonance: mesh frequency, natural frequency and their ratio.

use super::{PLAIN, Quantity, checks};
use crate::model::Solution;
use crate::model::Stage::{Resonance, SpeedRun};
use crate::model::dynamic::speeds::SpeedCurve;
use crate::model::explanation::Formula::{Found, Text};
use crate::model::explanation::{Context, Finding, four};

const ISO: &str = "ISO 6336-1:2019, 6.5: resonance ratio N = n1/n_E1 with n_E1 = 30 000 √(c_γ/m_red)/(π \
    z1), here with the mean stiffness k_m of the model in place of c_γ.";

const RIGID: &str = "One mass m_red on the mean stiffness of the mesh; shafts, bearings and masses \
    beside the gears are left out.";

const OVER_SPEED: &str = "Steady motion at each of 121 speeds from N = 0.1 to 1.6 or more, as in \
    tooth_force_factor, at the torque of the case; each motion starts from that at the speed before. \
    Speed and factor are those of the speed with the greatest factor.";

/// The rows of the greatest peak over the speed: key, symbol and label of its speed and of its factor,
/// the direction in words, and the point of the curve.
macro_rules! peak {
    ($speed:literal, $speed_symbol:literal, $factor:literal, $factor_symbol:literal, $way:literal, $point:ident) => {
        [
            Quantity {
                key: $speed,
                symbol: $speed_symbol,
                label: concat!("peak speed, ", $way),
                unit: "rad/s",
                shown: "rpm",
                digits: 5,
                equation: "max over speed",
                stage: SpeedRun,
                value: |s| Some(over_speed(s)?.$point()?.speed),
                meaning: concat!(
                    "The speed of the driver with the greatest dynamic factor of a tooth, with ",
                    $way,
                    " speed. It differs from the speed of N = 1, because the stiffness changes over a \
                        base pitch and contact can be lost."
                ),
                formula: Found("the speed of the greatest max F/max F_st over the speeds", STEADY),
                source: OSCILLATOR,
                assumptions: OVER_SPEED,
                checks: &[checks::teeth],
                ..PLAIN
            },
            Quantity {
                key: $factor,
                symbol: $factor_symbol,
                label: concat!("peak factor, ", $way),
                unit: "1",
                shown: "1",
                digits: 4,
                equation: "max over speed",
                stage: SpeedRun,
                value: |s| Some(over_speed(s)?.$point()?.tooth_factor),
                meaning: concat!(
                    "The greatest dynamic factor of a tooth over the speed, with ",
                    $way,
                    " speed: the greatest force of a tooth in the steady motion over that at rest, \
                        without base pitch deviations."
                ),
                formula: Found("the greatest max F/max F_st over the speeds", STEADY),
                source: OSCILLATOR,
                assumptions: OVER_SPEED,
                checks: &[checks::teeth],
                ..PLAIN
            },
        ]
    };
}

const RISING: [Quantity; 2] =
    peak!("resonance_peak_speed", "n_pk", "resonance_peak_factor", "K_pk", "rising", peak_rising);
const FALLING: [Quantity; 2] = peak!(
    "resonance_peak_speed_falling",
    "n_pk,f",
    "resonance_peak_factor_falling",
    "K_pk,f",
    "falling",
    peak_falling
);

const STEADY: &[&str] = &["m_red", "f_n", "F_0"];

const OSCILLATOR: &str = "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988; steady motion \
    with more than one base pitch per period and jumps between rising and falling speed: Kahraman & \
    Singh 1990. The greatest factor is the max over speed.";

fn over_speed(solution: &Solution) -> Option<&SpeedCurve> {
    solution.over_speed.as_ref()?.as_deref().ok()
}

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "mesh_frequency",
        symbol: "f_z",
        label: "mesh frequency",
        unit: "Hz",
        shown: "Hz",
        digits: 5,
        equation: "z1 n1",
        stage: Resonance,
        value: |s| Some(s.resonance?.mesh_frequency),
        meaning: "The number of tooth pairs that enter the mesh per second. A pair whines at this \
            frequency and at its multiples.",
        formula: Text("z1 ω_1/(2 π)"),
        source: "Kinematics of the pair: z1 n1 tooth pairs per second.",
        assumptions: "Constant speed.",
        ..PLAIN
    },
    Quantity {
        key: "natural_frequency",
        symbol: "f_n",
        label: "natural frequency",
        unit: "Hz",
        shown: "Hz",
        digits: 5,
        equation: "ISO 6336-1",
        stage: Resonance,
        value: |s| Some(s.resonance?.natural_frequency),
        meaning: "The natural frequency of the two gears on the mean stiffness of the mesh.",
        formula: Text("√(k_m/m_red)/(2 π)"),
        source: ISO,
        assumptions: RIGID,
        checks: &[checks::teeth],
        ..PLAIN
    },
    Quantity {
        key: "resonance_ratio",
        symbol: "N",
        label: "resonance ratio",
        unit: "1",
        shown: "1",
        digits: 4,
        equation: "ISO 6336-1",
        stage: Resonance,
        value: |s| Some(s.resonance?.ratio()),
        meaning: "The mesh frequency over the natural frequency. By the mean stiffness the \
            pair is in resonance at N = 1, and its second and third mesh harmonics at N = 1/2 and \
            1/3. ISO 6336-1 calls N \
            up to 0.85 subcritical (from 100 N per mm of width on), up to 1.15 the main resonance, \
            up to 1.5 intermediate, and above it supercritical.",
        formula: Text("f_z/f_n"),
        source: ISO,
        assumptions: RIGID,
        checks: &[checks::teeth, subcritical],
        ..PLAIN
    },
    Quantity {
        key: "resonance_speed",
        symbol: "n_E",
        label: "speed of N = 1",
        unit: "rad/s",
        shown: "rpm",
        digits: 5,
        equation: "ISO 6336-1",
        stage: Resonance,
        value: |s| {
            Some(s.resonance?.natural_frequency * s.geometry.base_pitch / s.geometry.driver.base)
        },
        meaning: "The speed of the driver at which the mesh frequency equals the natural \
            frequency of the mean stiffness, N = 1. The motion peaks at another speed: see \
            resonance_peak_speed.",
        formula: Text("2 π f_n/z1"),
        source: ISO,
        assumptions: RIGID,
        checks: &[checks::teeth],
        ..PLAIN
    },
    RISING[0],
    RISING[1],
    FALLING[0],
    FALLING[1],
];

/// The speed is below the main resonance.
fn subcritical(k: &Context) -> Option<Finding> {
    const RESONANCE: f64 = 0.85;
    let ratio = k.solution.resonance?.ratio();
    Finding::new(
        "N <= 0.85: below the main resonance of ISO 6336-1, at 100 N/mm and more",
        format!("N = {}", four(ratio)),
        ratio <= RESONANCE,
    )
}
