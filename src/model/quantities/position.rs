//! Rows of the first contact D and its velocities.

use super::conditions::{always, driven_rounded, edge_given, paper};
use super::{PLAIN, Quantity, Variant, checks, figures};
use crate::model::Context;
use crate::model::Stage::{Position, Velocity};
use crate::model::explanation::Formula::{Cases, Difference, Solved, Text};
use crate::model::explanation::{Equation, Step, step};
use crate::model::position::{gap, printed_turns};

const TIP: &str = "The tip of the driven gear meets the involute of the driver: a sharp edge, \
            or the arc of its tip radius. Both gears turn at their steady speeds up to \
            D.";

const PRINTED: &str = " by the printed equations, which are linear in Δ. They place D so close to \
            E that the tip has closed only a small part of its gap: see closed_gap.";

/// A length at D.
const LENGTH: Quantity =
    Quantity { stage: Position, assumptions: TIP, checks: &[checks::gap_closed], ..PLAIN };

/// An angle from D to E.
const ANGLE: Quantity = Quantity {
    stage: Position,
    corrections: &["Eqs. 7-20", "Eq. 14", "Eqs. 16, 20"],
    assumptions: TIP,
    ..PLAIN
};

/// A velocity at D.
const VELOCITY: Quantity = Quantity { stage: Velocity, assumptions: TIP, ..PLAIN };

pub(super) const TABLE: &[Quantity] = &[
    ANGLE
        .row(
            ["approach_angle_driver", "θ_1", "driver angle before E"],
            ("rad", "deg", 4),
            |s| Some(s.position?.approach_angle_driver),
            "The angle through which the driver turns from the first contact D to E",
            Cases(&[(paper, Text("ε_e + ε_d")), (always, Text("i u"))]),
        )
        .equation("Eq. 12")
        .source(
            "Zhou & Chen 2014, Eqs. 11-20. Method exact: the contact condition S(u) = Δ \
            of the two involutes (see approach_angle_driven), and Eq. 11.",
        )
        .checks(&[checks::gap_closed, checks::on_flank])
        .variants(&[
            Variant::meaning(paper, PRINTED),
            Variant::meaning(always, ", where contact should begin."),
        ])
        .counterparts("static_first_contact_angle_driver", "dynamic_first_contact_angle_driver"),
    ANGLE
        .row(
            ["approach_angle_driven", "u", "driven angle before E"],
            ("rad", "deg", 4),
            |s| Some(s.position?.approach_angle_driven),
            "The angle through which the driven gear turns from the first contact D to \
            E",
            Cases(&[(paper, Text("θ_1/i")), (always, Solved(&CONTACT))]),
        )
        .equation("Eq. 11")
        .source(
            "Zhou & Chen 2014, Eq. 11. Method exact: the contact condition of the path \
            of the tip and the involute of the driver, solved by Newton's method; \
            dS/du = r_b2 - r_b2', so u grows with √Δ.",
        )
        .checks(&[checks::start, checks::gap_closed, checks::on_flank])
        .variants(&[
            Variant::meaning(paper, PRINTED),
            Variant::meaning(
                always,
                ". S(u) is the gap between its tip and the driver's flank along the contact \
            normal. At D the total deviation Δ has closed this gap.",
            ),
        ])
        .counterparts("static_first_contact_angle", "dynamic_first_contact_angle"),
    LENGTH
        .row(
            ["contact_radius_driver", "O1D", "driver radius at D"],
            ("m", "mm", 5),
            |s| Some(s.position?.contact.radius_driver),
            "The radius of D on the driver. D is near the root, where the flank has its \
            strongest curvature.",
            Cases(&[
                (driven_rounded, Text("√(r_b1² + ρ_1²)")),
                (always, Text("√(r_a2² + a² - 2 a r_a2 cos η)")),
            ]),
        )
        .equation("Eq. 7")
        .source("Zhou & Chen 2014, Eqs. 7-10, with a instead of r_1 + r_2.")
        .corrections(&["Eqs. 7-20"])
        .checks(&[checks::on_flank, checks::gap_closed]),
    LENGTH
        .row(
            ["contact_radius_driven", "O2D", "driven radius at D"],
            ("m", "mm", 5),
            |s| Some(s.position?.contact.radius_driven),
            "The radius of D on the driven gear, where the tooth takes the load: its \
            tip radius, or a point on the rounding of its tip.",
            Cases(&[(driven_rounded, Text("√(r_b2'² + N2'D²)")), (always, Text("r_a2"))]),
        )
        .equation("rounding")
        .source(
            "The geometry of the rounding, an arc tangent to the tip circle and to the \
            flank.",
        ),
    LENGTH
        .row(
            ["contact_normal_radius_driven", "r_b2'", "normal's radius, driven"],
            ("m", "mm", 5),
            |s| Some(s.position?.contact.normal_radius_driven),
            "The distance from O2 to the contact normal at D, the lever arm of the \
            driven gear. At E it equals r_b2. Its difference from r_b2 causes the \
            approach velocity.",
            Text("a cos χ - r_b1"),
        )
        .equation("Eq. 49")
        .source("Zhou & Chen 2014, Eqs. 24-28, 48 and 49, in closed form.")
        .corrections(&["Eqs. 27, 42, 60"]),
    LENGTH
        .row(
            ["curvature_radius", "ρ_S", "radius of curvature"],
            ("m", "mm", 5),
            |s| Some(s.position?.curvature_radius),
            "The reduced radius of curvature of flank and tip at D. The width of the \
            contact and its stress depend on it.",
            Text("ρ_1 ρ_2/(ρ_1 + ρ_2)"),
        )
        .equation("Eq. 32")
        .source("Zhou & Chen 2014, below Eq. 32.")
        .assumptions(
            "A sharp tip has the curvature of its own flank, a rounded tip the radius \
            of its edge. A sharp edge causes far higher pressure than either.",
        )
        .checks(&[checks::edge]),
    LENGTH
        .row(
            ["closed_gap", "S(u)", "gap closed by the tip"],
            ("m", "um", 5),
            |s| Some(s.position?.closed_gap),
            "The gap between tip and flank that is closed at D: Δ at the exact \
                position. At the printed position the difference from Δ is its error.",
            Difference("Δρ_1 + r_b2 u - r_b1 Δχ"),
        )
        .equation("S(u) = Δ")
        .source(
            "Contact condition S(u) = Δ: the normal distance of the involutes, the \
            integral of dS/du = r_b2 - r_b2'. Zhou & Chen 2014 have no such equation.",
        )
        .corrections(&["Eqs. 7-20"]),
    PLAIN
        .row(
            ["transit_time", "t_DE", "time from D to E"],
            ("s", "us", 5),
            |s| Some(s.velocity?.transit_time),
            "The time from the first contact D to E. A longer impact continues into the \
            normal mesh.",
            Text("u/ω_2"),
        )
        .equation("u/ω2")
        .stage(Velocity)
        .source("Kinematics, u/ω2.")
        .corrections(&["Eqs. 7-20"])
        .assumptions("Constant speed.")
        .checks(&[checks::within_approach]),
    VELOCITY
        .row(
            ["normal_velocity", "ΔV_n", "approach velocity at D"],
            ("m/s", "m/s", 5),
            |s| Some(s.velocity?.normal),
            "The velocity at which the tip approaches the flank at D along the contact \
            normal. It causes the impact, and it is 0 at E.",
            Difference("ω_2 (r_b2 - r_b2')"),
        )
        .equation("Eq. 21")
        .source("Zhou & Chen 2014, Eqs. 21, 23-28; equal to ω_1 r_b1 - ω_2 r_b2'.")
        .corrections(&["Eqs. 27, 42, 60", "Eqs. 7-20"])
        .checks(&[checks::gap_closed]),
    VELOCITY
        .row(
            ["sliding_velocity", "ΔV_τ", "sliding velocity at D"],
            ("m/s", "m/s", 5),
            |s| Some(s.velocity?.sliding),
            "The velocity at which the tip slides along the flank at D. A positive \
            value points to the root of the driver.",
            Difference("ω_2 N2'D - ω_1 ρ_1"),
        )
        .equation("Eq. 22")
        .source("Zhou & Chen 2014, Eqs. 22-28.")
        .corrections(&["Eq. 22", "Eqs. 27, 42, 60"])
        .checks(&[checks::gap_closed, checks::keeps_sliding]),
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
        "angle at O2 from the centre line to the tip at D, or to the centre of its \
            rounding, Eq. 10",
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
