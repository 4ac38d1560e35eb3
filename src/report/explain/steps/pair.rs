//! Steps of the pair: circles, line of action, speeds, masses, relief.

use super::{step, told};
use crate::model::inputs::Drive;
use crate::report::explain::context::Formula::{By, Given, Text};
use crate::report::explain::context::Step;

#[rustfmt::skip]
pub(super) static STEPS: &[Step] = &[
    step!("i", "ratio of the tooth numbers, ω_1/ω_2", "1", Text("z2/z1"), |k| Some(k.inputs.ratio())),
    step!("r_1", "reference radius of the driver", "mm", Text("m z1/2"), |k| Some(k.solution.geometry.driver.reference)),
    step!("r_2", "reference radius of the driven gear", "mm", Text("m z2/2"), |k| Some(k.solution.geometry.driven.reference)),
    step!("r_b1", "base radius of the driver", "mm", Text("r_1 cos α"), |k| Some(k.solution.geometry.driver.base)),
    step!("r_b2", "base radius of the driven gear", "mm", Text("r_2 cos α"), |k| Some(k.solution.geometry.driven.base)),
    step!("r_a1", "tip radius of the driver, chamfer off", "mm", Text("m (z1/2 + ha*1 + x1) - hk1"), |k| Some(k.solution.geometry.driver.tip)),
    step!("r_a2", "tip radius of the driven gear, chamfer off", "mm", Text("m (z2/2 + ha*2 + x2) - hk2"), |k| Some(k.solution.geometry.driven.tip)),
    step!("N2E", "from the driven gear's tangent point to E", "mm", Text("√(r_a2² - r_b2²)"), |k| Some(k.solution.geometry.driven.tip_curvature)),
    step!("N1E", "from the driver's tangent point to E", "mm", Text("a sin α_w - N2E"), |k| Some(k.solution.geometry.start)),
    step!("N1B", "from the driver's tangent point to B", "mm", Text("√(r_a1² - r_b1²)"), |k| Some(k.solution.geometry.end)),
    told!("N1F", "from the driver's tangent point to F, where the pair ahead stands", "mm", Text("N1E + p_b")),
    step!("γ_2", "angle at O2 from the centre line to the tip at E", "deg", Text("acos(r_b2/r_a2) - α_w"), |k| Some(k.solution.geometry.start_angle_driven)),
    step!("ω_1", "speed of the driver", "rad/s", Text("n1"), |k| Some(k.inputs.speed)),
    step!("ω_2", "speed of the driven gear", "rad/s", Text("ω_1/i"), |k| Some(k.inputs.driven_speed())),
    step!("T1", "torque on the driver", "N m", By(|k| if let Drive::Power(_) = k.inputs.drive { Text("P/ω_1") } else { Given("operation.torque") }),
        |k| Some(k.inputs.torque())),
    step!("b", "common face width", "mm", Text("min(b1, b2)"), |k| Some(k.inputs.common_width())),
    told!("J_1", "moment of inertia of the driver, a disc to its base circle", "kg m2", Text("π ρ1 b1/2 (r_b1⁴ - rh1⁴)")),
    told!("J_2", "moment of inertia of the driven gear, likewise", "kg m2", Text("π ρ2 b2/2 (r_b2⁴ - rh2⁴)")),
    told!("m_1", "mass of the driver at its base circle, Eq. 46 in kg", "kg", Text("J_1/r_b1²")),
    told!("m_2", "mass of the driven gear at its base circle, Eq. 46 in kg", "kg", Text("J_2/r_b2²")),
];
