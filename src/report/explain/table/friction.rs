//! Explanations of the friction ratio and of what holds it in bounds.

use super::Explanation;
use crate::report::explain::context::Formula::Text;
use crate::report::explain::valid::{friction, impact};

pub(super) static TABLE: &[Explanation] = &[
    Explanation {
        key: "friction_ratio",
        says: "The paper's averaged impact friction coefficient: change of the sliding velocity over change of the approach \
            velocity from D to D', where the impact ends. D' is the same tip at u', after the turn of T_S,32.",
        formula: Text("|ΔV_τ' - ΔV_τ|/|ΔV_n' - ΔV_n|"),
        source: "Zhou & Chen 2014, Eqs. 29-45 and 61-64.",
        mended: &[
            "Eq. 31",
            "Eq. 34",
            "Eq. 36",
            "Eqs. 44, 45",
            "Eqs. 27, 42, 60",
            "Eq. 64",
            "section 6",
        ],
        assumes: "A ratio of velocities, most of which the gears' geometry changes and not friction. It is no material property \
            and not bounded by Coulomb's coefficient.",
        valid: &[friction::coulomb, friction::before_start],
    },
    Explanation {
        key: "stick_limit",
        says: "The friction coefficient below which sliding goes on throughout the impact: the tangential impulse is then μ times \
            the normal one, whatever the velocities do.",
        formula: Text("ΔV_τ/(2 ΔV_n)"),
        source: "Oblique elastic impact with Coulomb friction, ΔVτ/(2ΔVn): the tip rebounds at ΔV_n, so that the normal impulse is \
            2 M ΔV_n.",
        mended: &["Eq. 64"],
        assumes: "An elastic impact, the same mass along the normal and along the flank.",
        valid: &[friction::coulomb],
    },
    Explanation {
        key: "impulse_ratio",
        says: "Impulse of a half sine of force F_S and duration T_S, over the approaching momentum. An elastic impact gives it back \
            whole: 2. One that only stops: 1. Outside of 1 to 2 force and duration contradict each other.",
        formula: Text("(2/π) F_S T_S/(M ΔV_n)"),
        source: "Balance of momentum over the impact, (2/π)F_S·T_S/(M·ΔV_n); a gauge, not in Zhou & Chen 2014.",
        mended: &["Eq. 32"],
        assumes: "The force runs as half a sine.",
        valid: &[impact::possible],
    },
];
