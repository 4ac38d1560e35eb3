//! Steps of the friction ratio: the end of the impact D' and the velocities there.

use super::told;
use crate::model::inputs::Method;
use crate::report::explain::context::Formula::{self, By, Text};
use crate::report::explain::context::{Known, Step};

#[rustfmt::skip]
pub(super) static STEPS: &[Step] = &[
    told!("Δθ", "driver's turn over the impact, Eq. 35", "deg", Text("ω_1 T_S,32")),
    told!("DD'", "chord of the driven tip's way over the impact, Eqs. 36 and 37", "mm", Text("2 r_a2 sin(Δθ/(2 i))")),
    told!("u'", "driven angle before E at D'", "deg", By(|k| by_method(k, "η' - γ_2", "max(u - ω_2 T_S,32, 0)"))),
    told!("η'", "angle at O2 from the centre line to the tip at D'", "deg",
        By(|k| by_method(k, "acos((r_a2² + a² - O1D'²)/(2 a r_a2))", "γ_2 + u'"))),
    told!("O1D'", "driver radius at D'", "mm",
        By(|k| by_method(k, "O1D cos Δθ - √((O1D cos Δθ)² - O1D² + DD'²)", "√(r_a2² + a² - 2 a r_a2 cos η')"))),
    told!("ρ_1'", "driver's radius of curvature at D'", "mm", Text("√(O1D'² - r_b1²)")),
    told!("χ'", "angle of the contact normal at D'", "deg", Text("atan2(r_a2 sin η', a - r_a2 cos η') + atan2(ρ_1', r_b1)")),
    told!("r_b2''", "distance from O2 to the contact normal at D'", "mm", Text("a cos χ' - r_b1")),
    told!("N2'D'", "from the driven gear's foot on that normal to D'", "mm", Text("a sin χ' - ρ_1'")),
    told!("ω_2'", "speed of the driven gear after the impact, Eq. 31", "rad/s", Text("ω_2 + F_S T_S,32/(m_red r_a2)")),
    told!("ΔV_n'", "approach velocity at D', Eq. 29", "m/s", Text("ω_1 r_b1 - ω_2' r_b2''")),
    told!("ΔV_τ'", "sliding velocity at D', Eq. 30", "m/s", Text("ω_2' N2'D' - ω_1 ρ_1'")),
];

fn by_method(known: &Known, paper: &'static str, other: &'static str) -> Formula {
    Text(if known.inputs.method == Method::Paper {
        paper
    } else {
        other
    })
}
