//! Rows of the geometry and the load, with their steps.

use super::checks;
use super::conditions::{
    always, deflection_used, distance_given, driven_rounded, driver_rounded, offset, power_given,
};
use super::{PLAIN, Quantity, Variant};
use crate::model::Stage::{Geometry, Load};
use crate::model::explanation::Formula::{Cases, Difference, Given, Solved, Text};
use crate::model::explanation::{Context, Equation, Formula, Step, step};

const PARALLEL: &str = "External gears on parallel, rigid shafts, with involute flanks down to \
            the contact.";

/// A row of the geometry.
const GEOMETRY: Quantity =
    Quantity { equation: "ISO 21771", stage: Geometry, assumptions: PARALLEL, ..PLAIN };

pub(super) const TABLE: &[Quantity] = &[
    GEOMETRY
        .row(
            ["contact_ratio", "ε", "contact ratio"],
            ("1", "1", 5),
            |s| Some(s.geometry.contact_ratio),
            "The mean number of tooth pairs in contact: the length of the path of \
            contact EB over the base pitch. Tip chamfers and tip radii shorten the \
            path.",
            Text("(N1B - N1E)/p_b"),
        )
        .source(
            "ISO 21771:2007, transverse contact ratio. Table 1 of Zhou & Chen 2014 has \
            1.5568.",
        )
        .corrections(&["Eqs. 16, 20"])
        .checks(&[checks::start, checks::end, checks::contact_ratio]),
    GEOMETRY
        .row(
            ["base_pitch", "p_b", "base pitch"],
            ("m", "mm", 5),
            |s| Some(s.geometry.base_pitch),
            "The distance between neighbouring flanks along the line of action. Both \
            gears need the same base pitch to mesh evenly.",
            Text("π m_t cos α_t"),
        )
        .source("ISO 21771:2007, base pitch."),
    GEOMETRY
        .row(
            ["centre_distance", "a", "centre distance"],
            ("m", "mm", 5),
            |s| Some(s.geometry.centre_distance),
            "The distance between the gear axes. Without a given value, the distance at \
            which the profile shifts leave no backlash.",
            Cases(&[
                (distance_given, Given("pair.centre_distance")),
                (always, Text("(r_b1 + r_b2)/cos α_w")),
            ]),
        )
        .source(
            "ISO 21771:2007, working centre distance. Zhou & Chen 2014 use r_1 + r_2, \
            which is exact without profile shift.",
        )
        .checks(&[checks::distance]),
    GEOMETRY
        .row(
            ["working_pressure_angle", "α_w", "working pressure angle"],
            ("rad", "deg", 5),
            |s| Some(s.geometry.working_pressure_angle),
            "The angle between the line of action and the common tangent of the pitch \
            circles at this centre distance.",
            Cases(&[
                (distance_given, Difference("acos((r_b1 + r_b2)/a)")),
                (always, Solved(&INVOLUTE)),
            ]),
        )
        .source(
            "ISO 21771:2007, working pressure angle. Zhou & Chen 2014 use α, which is \
            exact without profile shift.",
        )
        .checks(&[checks::distance]),
    PLAIN
        .row(
            ["mesh_force", "F_0", "mesh force"],
            ("N", "N", 5),
            |s| Some(s.mesh_force),
            "The steady force along the line of action. ",
            Text("T1/r_b1"),
        )
        .equation("T1/rb1")
        .stage(Load)
        .source("Static balance of the driver, torque over base radius, T1/rb1.")
        .corrections(&["section 6"])
        .assumptions("Constant torque and speed, no losses in the mesh.")
        .variants(&[
            Variant::meaning(
                deflection_used,
                "The dynamic factor compares the impact force with it. The case gives the \
            deflection, so the load changes neither the place nor the force of the \
            impact.",
            ),
            Variant::meaning(
                always,
                "It deflects the teeth, and the dynamic factor compares the impact force \
            with it.",
            ),
        ]),
];

/// The common face width.
pub(super) const WIDTH: Formula = Cases(&[
    (offset, Text("min(b1/2, b2/2 + o) + min(b1/2, b2/2 - o)")),
    (always, Text("min(b1, b2)")),
]);

const INVOLUTE: Equation = Equation {
    text: "inv α_w = inv α_t + 2 (x1 + x2) tan α/(z1 + z2), inv t = tan t - t",
    left: Difference("inv α_w"),
    right: Difference("inv α_t + 2 (x1 + x2) tan α/(z1 + z2)"),
    unit: "1",
    sides: involutes,
};

#[expect(clippy::unnecessary_wraps, reason = "the sides of an equation may be unknown")]
fn involutes(k: &Context) -> Option<[f64; 2]> {
    let (inputs, working) = (k.inputs, k.solution.geometry.working_pressure_angle);
    let inv = |angle: f64| angle.tan() - angle;
    let shifts = inputs.driver.profile_shift + inputs.driven.profile_shift;
    let teeth = f64::from(inputs.driver.teeth + inputs.driven.teeth);
    let alpha = inputs.pressure_angle;
    let shifted = inv(inputs.transverse_pressure_angle()) + 2.0 * shifts * alpha.tan() / teeth;
    Some([inv(working), shifted])
}

/// The radii and the mass of a gear: its number, its member of the geometry, its name, and that of
/// its tip.
macro_rules! gear {
    ($n:literal, $gear:ident, $name:literal, $tip:literal) => {
        [
            step(
                concat!("r_", $n),
                concat!("reference radius of the ", $name),
                "mm",
                Text(concat!("m_t z", $n, "/2")),
                |k| Some(k.solution.geometry.$gear.reference),
            ),
            step(
                concat!("r_b", $n),
                concat!("base radius of the ", $name),
                "mm",
                Text(concat!("r_", $n, " cos α_t")),
                |k| Some(k.solution.geometry.$gear.base),
            ),
            step(
                concat!("r_a", $n),
                concat!("tip radius of the ", $name, " without the chamfer"),
                "mm",
                Text(concat!("r_", $n, " + m (ha*", $n, " + x", $n, ") - hk", $n)),
                |k| Some(k.solution.geometry.$gear.tip),
            ),
            step(
                concat!("r_C", $n),
                concat!("radius of the centre of the rounding of the ", $tip),
                "mm",
                Text(concat!("r_a", $n, " - re", $n)),
                |k| Some(k.solution.geometry.$gear.tip - k.solution.geometry.$gear.edge),
            ),
            step(
                concat!("m_", $n),
                concat!("mass of the ", $name, " at its base circle, Eq. 46 in kg"),
                "kg",
                Text(concat!("J_", $n, "/r_b", $n, "²")),
                |k| Some(k.solution.kept.masses.$gear),
            ),
        ]
    };
}

const DRIVER: [Step; 5] = gear!("1", driver, "driver", "driver's tip");
const DRIVEN: [Step; 5] = gear!("2", driven, "driven gear", "driven tip");

pub(super) const STEPS: &[Step] = &[
    step("i", "ratio of the tooth numbers, ω_1/ω_2", "1", Text("z2/z1"), |k| {
        Some(k.inputs.ratio())
    }),
    DRIVER[0],
    DRIVEN[0],
    DRIVER[1],
    DRIVEN[1],
    DRIVER[2],
    DRIVEN[2],
    DRIVER[3],
    DRIVEN[3],
    step(
        "N2E",
        "from the driven gear's tangent point to E",
        "mm",
        Cases(&[
            (driven_rounded, Text("√(r_C2² - r_b2²) + re2")),
            (always, Text("√(r_a2² - r_b2²)")),
        ]),
        |k| Some(k.solution.geometry.driven.tip_curvature),
    ),
    step(
        "N1E",
        "from the driver's base circle along the line of action to E",
        "mm",
        Difference("a sin α_w - N2E"),
        |k| Some(k.solution.geometry.start),
    ),
    step(
        "N1B",
        "from the driver's base circle along the line of action to B",
        "mm",
        Cases(&[
            (driver_rounded, Text("√(r_C1² - r_b1²) + re1")),
            (always, Text("√(r_a1² - r_b1²)")),
        ]),
        |k| Some(k.solution.geometry.end),
    ),
    step(
        "N1F",
        "from the driver's tangent point to F, the contact of the pair ahead",
        "mm",
        Text("N1E + p_b"),
        |k| Some(k.solution.geometry.start + k.solution.geometry.base_pitch),
    ),
    step(
        "γ_2",
        "angle at O2 from the centre line to the tip at E, or to the centre of its \
            rounding",
        "deg",
        Cases(&[
            (driven_rounded, Text("acos(r_b2/r_C2) - α_w")),
            (always, Text("acos(r_b2/r_a2) - α_w")),
        ]),
        |k| Some(k.solution.geometry.start_angle_driven),
    ),
    step("ω_1", "speed of the driver", "rad/s", Text("n1"), |k| Some(k.inputs.speed)),
    step("ω_2", "speed of the driven gear", "rad/s", Text("ω_1/i"), |k| {
        Some(k.inputs.driven_speed())
    }),
    step(
        "T1",
        "torque on the driver",
        "N m",
        Cases(&[(power_given, Text("P/ω_1")), (always, Given("operation.torque"))]),
        |k| Some(k.inputs.torque()),
    ),
    step("b", "common face width", "mm", WIDTH, |k| Some(k.inputs.common_width())),
    DRIVER[4],
    DRIVEN[4],
];
