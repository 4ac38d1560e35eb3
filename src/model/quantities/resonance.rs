//! Rows of the resonance: mesh frequency, natural frequency and their ratio.

use super::{PLAIN, Quantity, checks};
use crate::model::Stage::Resonance;
use crate::model::explanation::Formula::Text;
use crate::model::explanation::{Context, Finding, four};

const ISO: &str = "ISO 6336-1:2019, 6.5: resonance ratio N = n1/n_E1 with n_E1 = 30 000 √(c_γ/m_red)/(π \
    z1), here with the mean stiffness k_m of the model in place of c_γ.";

const RIGID: &str = "One mass m_red on the mean stiffness of the mesh; shafts, bearings and masses \
    beside the gears are left out.";

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
        meaning: "The mesh frequency over the natural frequency. The pair is in resonance at N = \
            1, and its second and third mesh harmonics are at N = 1/2 and 1/3. ISO 6336-1 calls N \
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
        label: "resonance speed",
        unit: "rad/s",
        shown: "rpm",
        digits: 5,
        equation: "ISO 6336-1",
        stage: Resonance,
        value: |s| {
            Some(s.resonance?.natural_frequency * s.geometry.base_pitch / s.geometry.driver.base)
        },
        meaning: "The speed of the driver at which the mesh frequency equals the natural \
            frequency, N = 1.",
        formula: Text("2 π f_n/z1"),
        source: ISO,
        assumptions: RIGID,
        checks: &[checks::teeth],
        ..PLAIN
    },
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
