//! Rows of the first contact D and its velocities.

use super::conditions::{always, driven_rounded, edge_given, paper};
use super::{PLAIN, Quantity, Variant, checks, figures};
use crate::model::Context;
use crate::model::Stage::{Position, Velocity};
use crate::model::explanation::Formula::{Cases, Difference, Solved, Text};
use crate::model::explanation::{Equation, Step, step};
use crate::model::position::{gap, printed_turns};

const TIP: &str = "The tip of the driven gear meets the involute of the driver: a sharp edge, or the \
    arc of its tip radius. Both gears turn at their steady speeds up to D.";

const PRINTED: &str = " by the printed equations, which are linear in Δ. They place D so close to E \
    that the tip has closed only a small part of its gap: see closed_gap.";

/// A length at D.
const LENGTH: Quantity = Quantity {
    unit: "m",
    shown: "mm",
    digits: 5,
    stage: Position,
    assumptions: TIP,
    checks: &[checks::gap_closed],
    ..PLAIN
};

/// An angle from D to E.
const ANGLE: Quantity = Quantity {
    unit: "rad",
    shown: "deg",
    digits: 4,
    stage: Position,
    corrections: &["Eqs. 7-20", "Eq. 14", "Eqs. 16, 20"],
    assumptions: TIP,
    ..PLAIN
};

/// A velocity at D.
const VELOCITY: Quantity =
    Quantity { unit: "m/s", shown: "m/s", digits: 5, stage: Velocity, assumptions: TIP, ..PLAIN };

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "approach_angle_driver",
        symbol: "θ_1",
        label: "driver angle before E",
        equation: "Eq. 12",
        value: |s| Some(s.position?.approach_angle_driver),
        meaning: "The angle through which the driver turns from the first contact D to E",
        formula: Cases(&[(paper, Text("ε_e + ε_d")), (always, Text("i u"))]),
        source: "Zhou & Chen 2014, Eqs. 11-20. Method exact: the contact condition S(u) = Δ of \
            the two involutes (see approach_angle_driven), and Eq. 11.",
        checks: &[checks::gap_closed, checks::on_flank],
        variants: &[
            Variant::meaning(paper, PRINTED),
            Variant::meaning(always, ", where contact should begin."),
        ],
        by_static: Some("static_first_contact_angle_driver"),
        by_dynamic: Some("dynamic_first_contact_angle_driver"),
        ..ANGLE
    },
    Quantity {
        key: "approach_angle_driven",
        symbol: "u",
        label: "driven angle before E",
        equation: "Eq. 11",
        value: |s| Some(s.position?.approach_angle_driven),
        meaning: "The angle through which the driven gear turns from the first contact D to E",
        formula: Cases(&[(paper, Text("θ_1/i")), (always, Solved(&CONTACT))]),
        source: "Zhou & Chen 2014, Eq. 11. Method exact: the contact condition of the path of the \
            tip and the involute of the driver, solved by Newton's method; dS/du = r_b2 - r_b2', \
            so u grows with √Δ.",
        checks: &[checks::start, checks::gap_closed, checks::on_flank],
        variants: &[
            Variant::meaning(paper, PRINTED),
            Variant::meaning(
                always,
                ". S(u) is the gap between its tip and the driver's flank along the contact normal. \
                    At D the total deviation Δ has closed this gap.",
            ),
        ],
        by_static: Some("static_first_contact_angle"),
        by_dynamic: Some("dynamic_first_contact_angle"),
        ..ANGLE
    },
    Quantity {
        key: "contact_radius_driver",
        symbol: "O1D",
        label: "driver radius at D",
        equation: "Eq. 7",
        value: |s| Some(s.position?.contact.radius_driver),
        meaning: "The radius of D on the driver. D is near the root, where the flank has its \
            strongest curvature.",
        formula: Cases(&[
            (driven_rounded, Text("√(r_b1² + ρ_1²)")),
            (always, Text("√(r_a2² + a² - 2 a r_a2 cos η)")),
        ]),
        source: "Zhou & Chen 2014, Eqs. 7-10, with a instead of r_1 + r_2.",
        corrections: &["Eqs. 7-20"],
        checks: &[checks::on_flank, checks::gap_closed],
        ..LENGTH
    },
    Quantity {
        key: "contact_radius_driven",
        symbol: "O2D",
        label: "driven radius at D",
        equation: "rounding",
        value: |s| Some(s.position?.contact.radius_driven),
        meaning: "The radius of D on the driven gear, where the tooth takes the load: its tip \
            radius, or a point on the rounding of its tip.",
        formula: Cases(&[(driven_rounded, Text("√(r_b2'² + N2'D²)")), (always, Text("r_a2"))]),
        source: "The geometry of the rounding, an arc tangent to the tip circle and to the flank.",
        ..LENGTH
    },
    Quantity {
        key: "contact_normal_radius_driven",
        symbol: "r_b2'",
        label: "normal's radius, driven",
        equation: "Eq. 49",
        value: |s| Some(s.position?.contact.normal_radius_driven),
        meaning: "The distance from O2 to the contact normal at D, the lever arm of the driven \
            gear. At E it equals r_b2. Its difference from r_b2 causes the approach velocity.",
        formula: Text("a cos χ - r_b1"),
        source: "Zhou & Chen 2014, Eqs. 24-28, 48 and 49, in closed form.",
        corrections: &["Eqs. 27, 42, 60"],
        ..LENGTH
    },
    Quantity {
        key: "curvature_radius",
        symbol: "ρ_S",
        label: "radius of curvature",
        equation: "Eq. 32",
        value: |s| Some(s.position?.curvature_radius),
        meaning: "The reduced radius of curvature of flank and tip at D. The width of the contact \
            and its stress depend on it.",
        formula: Text("ρ_1 ρ_2/(ρ_1 + ρ_2)"),
        source: "Zhou & Chen 2014, below Eq. 32.",
        assumptions: "A sharp tip has the curvature of its own flank, a rounded tip the radius of \
            its edge. A sharp edge causes far higher pressure than either.",
        checks: &[checks::edge],
        ..LENGTH
    },
    Quantity {
        key: "closed_gap",
        symbol: "S(u)",
        label: "gap closed by the tip",
        shown: "um",
        equation: "S(u) = Δ",
        value: |s| Some(s.position?.closed_gap),
        meaning: "The gap between tip and flank that is closed at D. It equals Δ at the exact \
            position. At the printed position the difference from Δ is the error of that \
            position.",
        formula: Difference("Δρ_1 + r_b2 u - r_b1 Δχ"),
        source: "Contact condition S(u) = Δ: the normal distance of the involutes, the integral \
            of dS/du = r_b2 - r_b2'. Zhou & Chen 2014 have no such equation.",
        corrections: &["Eqs. 7-20"],
        ..LENGTH
    },
    Quantity {
        key: "transit_time",
        symbol: "t_DE",
        label: "time from D to E",
        unit: "s",
        shown: "us",
        digits: 5,
        equation: "u/ω2",
        stage: Velocity,
        value: |s| Some(s.velocity?.transit_time),
        meaning: "The time from the first contact D to E. A longer impact continues into the \
            normal mesh.",
        formula: Text("u/ω_2"),
        source: "Kinematics, u/ω2.",
        corrections: &["Eqs. 7-20"],
        assumptions: "Constant speed.",
        checks: &[checks::within_approach],
        ..PLAIN
    },
    Quantity {
        key: "normal_velocity",
        symbol: "ΔV_n",
        label: "approach velocity at D",
        equation: "Eq. 21",
        value: |s| Some(s.velocity?.normal),
        meaning: "The velocity at which the tip approaches the flank at D along the contact \
            normal. It causes the impact, and it is 0 at E.",
        formula: Difference("ω_2 (r_b2 - r_b2')"),
        source: "Zhou & Chen 2014, Eqs. 21, 23-28; equal to ω_1 r_b1 - ω_2 r_b2'.",
        corrections: &["Eqs. 27, 42, 60", "Eqs. 7-20"],
        checks: &[checks::gap_closed],
        ..VELOCITY
    },
    Quantity {
        key: "sliding_velocity",
        symbol: "ΔV_τ",
        label: "sliding velocity at D",
        equation: "Eq. 22",
        value: |s| Some(s.velocity?.sliding),
        meaning: "The velocity at which the tip slides along the flank at D. A positive value \
            points to the root of the driver.",
        formula: Difference("ω_2 N2'D - ω_1 ρ_1"),
        source: "Zhou & Chen 2014, Eqs. 22-28.",
        corrections: &["Eq. 22", "Eqs. 27, 42, 60"],
        checks: &[checks::gap_closed, checks::keeps_sliding],
        ..VELOCITY
    },
    figures::AT_CONTACT[0],
    figures::AT_CONTACT[1],
];

const CONTACT: Equation = Equation {
    text: "S(u) = Δ,  S(u) = Δρ_1 + r_b2 u - r_b1 Δχ",
    left: Difference("Δρ_1 + r_b2 u - r_b1 Δχ"),
    right: Text("Δ"),
    unit: "um",
    sides: |k| {
        let contact = k.solution.position?.contact;
        Some([gap(&k.solution.geometry, &contact), k.solution.deviation.total])
    },
};

fn angle_at_tip(k: &Context) -> Option<f64> {
    let (geometry, contact) = (&k.solution.geometry, k.solution.position?.contact);
    let (sine, cosine) = contact.polar_angle.sin_cos();
    let tip = geometry.driven.tip - geometry.driven.edge;
    Some((tip * sine).atan2(geometry.centre_distance - tip * cosine))
}

/// N₁'D, or N₁'C for a rounded tip, in m.
fn centre_curvature(k: &Context) -> Option<f64> {
    Some(k.solution.position?.contact.curvature_driver + k.solution.geometry.driven.edge)
}

pub(super) const STEPS: &[Step] = &[
    step(
        "ε_e",
        "turn of the driver by the equivalent error, Eqs. 13-15",
        "deg",
        Text("atan2(r_b1 Δf, r_b1² + N1E (N1E - Δf))"),
        |k| Some(printed_turns(&k.solution.geometry, &k.solution.deviation)[0]),
    ),
    step(
        "ε_d",
        "turn of the driver by the deflection, Eqs. 17-19",
        "deg",
        Text("atan2(r_b1 δ, r_b1² + (N1F - Δ) (N1F - Δf))"),
        |k| Some(printed_turns(&k.solution.geometry, &k.solution.deviation)[1]),
    ),
    step(
        "η",
        "angle at O2 from the centre line to the tip at D, or to the centre of its rounding, Eq. 10",
        "deg",
        Text("γ_2 + u"),
        |k| Some(k.solution.position?.contact.polar_angle),
    ),
    step(
        "ρ_1",
        "radius of curvature of the driver at D, N1'D",
        "mm",
        Cases(&[
            (driven_rounded, Difference("ρ_1C - re2")),
            (always, Difference("√(O1D² - r_b1²)")),
        ]),
        |k| Some(k.solution.position?.contact.curvature_driver),
    ),
    step(
        "ρ_1C",
        "distance of the centre of the rounding from N1' at D",
        "mm",
        Difference("√(r_C2² + a² - 2 a r_C2 cos η - r_b1²)"),
        centre_curvature,
    ),
    step("Δρ_1", "growth of ρ_1 since E", "mm", Difference("ρ_1 - N1E"), |k| {
        Some(k.solution.position?.contact.curvature_growth)
    }),
    step(
        "ψ",
        "angle D O1 P",
        "deg",
        Cases(&[
            (driven_rounded, Text("atan2(r_C2 sin η, a - r_C2 cos η)")),
            (always, Text("atan2(r_a2 sin η, a - r_a2 cos η)")),
        ]),
        angle_at_tip,
    ),
    step(
        "β_1",
        "angle D O1 N1'",
        "deg",
        Cases(&[(driven_rounded, Text("atan2(ρ_1C, r_b1)")), (always, Text("atan2(ρ_1, r_b1)"))]),
        |k| Some(centre_curvature(k)?.atan2(k.solution.geometry.driver.base)),
    ),
    step("χ", "angle of the contact normal at D, α_w at E", "deg", Text("ψ + β_1"), |k| {
        Some(k.solution.geometry.working_pressure_angle + k.solution.position?.contact.normal_turn)
    }),
    step("Δχ", "turn of the contact normal since E", "deg", Difference("χ - α_w"), |k| {
        Some(k.solution.position?.contact.normal_turn)
    }),
    step(
        "N2'D",
        "from the driven gear's foot on the contact normal to D",
        "mm",
        Text("a sin χ - ρ_1"),
        |k| Some(k.solution.position?.contact.normal_length_driven),
    ),
    step(
        "ρ_2",
        "radius of curvature of the driven flank at its tip",
        "mm",
        Cases(&[(edge_given, Text("re2")), (always, Text("N2E"))]),
        |k| Some(k.inputs.driven.tip_radius.unwrap_or(k.solution.geometry.driven.tip_curvature)),
    ),
];
