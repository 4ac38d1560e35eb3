//! Rows of the figures of ISO 21771 and ISO 6336-1, with their steps.

use super::conditions::{always, any_class, any_coarse, driver_larger, helical};
use super::geometry::WIDTH;
use super::{PLAIN, Quantity, checks};
use crate::model::Solution;
use crate::model::Stage::{self, Figures};
use crate::model::explanation::Formula::{Cases, Difference, Made, Text, Words};
use crate::model::explanation::{Context, Step, step};
use crate::model::figures::{IsoDynamic, RESONANCE_ENDS};

const INVOLUTE: &str = "External gears with involute flanks.";
const RIGID: &str = "Rigid gears on parallel, rigid shafts at steady speed.";
const STEEL: &str = "Solid gears of the basic rack of the case, C_R = 1 and C_M = 0.8; other \
            materials by their Young's modulus. Each pair carries its load alone. Virtual teeth are z_n = \
            z/(cos² β_b cos β) of ISO 21771, as in ISO/TR 6336-30; with z/cos³ β, c' is 0.1 % less at \
            15 deg.";
const PEAK: &str = "The flanks are smooth cylinders without oil, and the load is even over the \
            width. A sharp edge has no finite pressure.";

/// A figure.
const FIGURE: Quantity =
    Quantity { equation: "ISO 21771", stage: Figures, assumptions: INVOLUTE, ..PLAIN };

/// A specific sliding.
const SLIDING: Quantity = Quantity {
    source: "ISO 21771:2007, specific sliding: the sliding velocity over the velocity \
            of the flank, both along the tangent.",
    assumptions: RIGID,
    is_signed: true,
    ..FIGURE
};

/// A sliding velocity.
const VELOCITY: Quantity = Quantity {
    source: "ISO 21771:2007, sliding velocity. The sign is that of ΔV_τ.",
    assumptions: RIGID,
    is_signed: true,
    ..FIGURE
};

/// A stiffness per width.
const STIFFNESS: Quantity = Quantity {
    equation: "ISO 6336-1",
    source: "ISO 6336-1:2019, clause 9, method B.",
    assumptions: STEEL,
    checks: &[checks::iso_stiffness],
    ..FIGURE
};

/// A Hertz pressure.
pub(super) const PRESSURE: Quantity = Quantity {
    equation: "Hertz 1882",
    source: "Hertz 1882, two cylinders: p = √(F E'/(π b ρ)).",
    assumptions: PEAK,
    ..PLAIN
};

/// The rows of a gear: its place, its number, key and name, the other number and name, the distances
/// from its tangent point to the ends of its active flank, tip first, and its specific sliding at E and
/// at B.
macro_rules! gear {
    ($at:literal, $n:literal, $gear:literal, $name:literal, $other:literal, $mate:literal, $tip:literal, $root:literal, $entry:literal, $exit:literal) => {
        [
            FIGURE
                .row(
                    [
                        concat!("tip_thickness_", $gear),
                        concat!("s_a", $n),
                        concat!("tip thickness, ", $name),
                    ],
                    ("m", "mm", 5),
                    |s| Some(s.figures?.tip_thickness[$at]),
                    concat!(
                        "The thickness of a tooth of the ",
                        $name,
                        " between its flanks at the tip circle, less the chamfer, in the transverse \
            section. A thin tip breaks when it is hardened or strikes."
                    ),
                    Difference(concat!(
                        "2 r_a",
                        $n,
                        " (π/(2 z",
                        $n,
                        ") + 2 x",
                        $n,
                        " tan α/z",
                        $n,
                        " + inv α_t - inv α_a",
                        $n,
                        ")"
                    )),
                )
                .source("ISO 21771:2007, tooth thickness at the tip circle.")
                .checks(&[checks::tips]),
            FIGURE
                .row(
                    [
                        concat!("tooth_thickness_", $gear),
                        concat!("s_t", $n),
                        concat!("tooth thickness, ", $name),
                    ],
                    ("m", "mm", 5),
                    |s| Some(s.figures?.tooth_thickness[$at]),
                    concat!(
                        "The thickness of a tooth of the ",
                        $name,
                        " at the reference circle in the transverse section. A backlash does not \
            make it thinner."
                    ),
                    Text(concat!("m_t (π/2 + 2 x", $n, " tan α)")),
                )
                .source("ISO 21771:2007, transverse tooth thickness at the reference cylinder."),
            FIGURE
                .row(
                    [
                        concat!("tip_clearance_", $gear),
                        concat!("c_a", $n),
                        concat!("tip clearance, ", $name),
                    ],
                    ("m", "mm", 5),
                    |s| Some(s.figures?.tip_clearance[$at]),
                    concat!(
                        "The distance from the tip circle of the ",
                        $name,
                        " to the root circle of the ",
                        $mate,
                        " on the centre line."
                    ),
                    Difference(concat!("a - r_a", $n, " - hk", $n, " - r_f", $other)),
                )
                .source("ISO 21771:2007, tip clearance.")
                .checks(&[checks::clearance])
                .signed(),
            FIGURE
                .row(
                    [
                        concat!("active_tip_diameter_", $gear),
                        concat!("d_Na", $n),
                        concat!("active tip dia., ", $name),
                    ],
                    ("m", "mm", 5),
                    |s| Some(active_diameters(s)[$at][0]),
                    concat!(
                        "The diameter at which the active flank of the ",
                        $name,
                        " ends at the tip: below chamfer and tip radius."
                    ),
                    Text(concat!("2 √(r_b", $n, "² + ", $tip, "²)")),
                )
                .source("ISO 21771:2007, active tip diameter d_Na."),
            FIGURE
                .row(
                    [
                        concat!("active_root_diameter_", $gear),
                        concat!("d_Nf", $n),
                        concat!("active root dia., ", $name),
                    ],
                    ("m", "mm", 5),
                    |s| Some(active_diameters(s)[$at][1]),
                    concat!(
                        "The diameter at which the active flank of the ",
                        $name,
                        " begins at the root: the start of active profile. The involute must begin \
            below it."
                    ),
                    Text(concat!("2 √(r_b", $n, "² + ", $root, "²)")),
                )
                .source("ISO 21771:2007, active root diameter d_Nf.")
                .checks(&[checks::form_diameters]),
            SLIDING.row(
                [
                    concat!("specific_sliding_entry_", $gear),
                    concat!("ζ_E", $n),
                    concat!("sliding at E, ", $name),
                ],
                ("1", "1", 4),
                |s| Some(specific_sliding(s, s.geometry.start)[$at]),
                concat!("The specific sliding of the flank of the ", $name, " at the entry E."),
                Difference($entry),
            ),
            SLIDING.row(
                [
                    concat!("specific_sliding_exit_", $gear),
                    concat!("ζ_B", $n),
                    concat!("sliding at B, ", $name),
                ],
                ("1", "1", 4),
                |s| Some(specific_sliding(s, s.geometry.end)[$at]),
                concat!("The specific sliding of the flank of the ", $name, " at the exit B."),
                Difference($exit),
            ),
        ]
    };
}

const DRIVER: [Quantity; 7] = gear!(
    0,
    "1",
    "driver",
    "driver",
    "2",
    "driven gear",
    "N1B",
    "N1E",
    "1 - N2E/(i N1E)",
    "1 - N2B/(i N1B)"
);
const DRIVEN: [Quantity; 7] = gear!(
    1,
    "2",
    "driven",
    "driven gear",
    "1",
    "driver",
    "N2E",
    "N2B",
    "1 - i N1E/N2E",
    "1 - i N1B/N2B"
);

/// The specific sliding at D.
pub(super) const AT_CONTACT: [Quantity; 2] = [
    CONTACT.row(
        ["specific_sliding_contact_driver", "ζ_D1", "sliding at D, driver"],
        ("1", "1", 4),
        |s| Some(1.0 - s.position?.contact.normal_length_driven / rolled(s)?),
        "The specific sliding of the driver's flank at the first contact D.",
        Difference("1 - N2'D/(i ρ_1)"),
    ),
    CONTACT.row(
        ["specific_sliding_contact_driven", "ζ_D2", "sliding at D, driven gear"],
        ("1", "1", 4),
        |s| Some(1.0 - rolled(s)? / s.position?.contact.normal_length_driven),
        "The specific sliding of the tip of the driven gear at the first contact D.",
        Difference("1 - i ρ_1/N2'D"),
    ),
];

const CONTACT: Quantity = Quantity {
    stage: Stage::Velocity,
    equation: "sliding/velocity",
    source: "The definition of ISO 21771:2007 along the contact normal at D: the ratio \
            sliding/velocity of each flank.",
    checks: &[checks::gap_closed],
    ..SLIDING
};

/// i ρ_1 at D, in m.
fn rolled(solution: &Solution) -> Option<f64> {
    Some(solution.geometry.ratio * solution.position?.contact.curvature_driver)
}

pub(super) const TABLE: &[Quantity] = &[
    FIGURE
        .row(
            ["common_face_width", "b_w", "common face width"],
            ("m", "mm", 5),
            |s| Some(s.figures?.width),
            "The width over which the faces of both gears overlap.",
            WIDTH,
        )
        .source("ISO 21771:2007, working face width."),
    DRIVER[1],
    DRIVEN[1],
    DRIVER[0],
    DRIVEN[0],
    DRIVER[2],
    DRIVEN[2],
    DRIVER[3],
    DRIVEN[3],
    DRIVER[4],
    DRIVEN[4],
    FIGURE
        .row(
            ["tangential_force", "F_t", "tangential force"],
            ("N", "N", 5),
            |s| Some(s.figures?.tangential_force),
            "The force at the reference circle that gives the torque: the nominal load \
            of ISO 6336.",
            Text("T1/r_1"),
        )
        .equation("ISO 6336-1")
        .source("ISO 6336-1:2019, nominal tangential load F_t.")
        .assumptions(RIGID),
    FIGURE
        .row(
            ["pitch_line_speed", "v", "pitch-line speed"],
            ("m/s", "m/s", 5),
            |s| Some(s.figures?.pitch_line_speed),
            "The circumferential speed of the reference circles.",
            Text("ω_1 r_1"),
        )
        .equation("ISO 6336-1")
        .source("ISO 6336-1:2019, circumferential speed v at the reference circle.")
        .assumptions(RIGID),
    VELOCITY.row(
        ["sliding_velocity_entry", "ΔV_τ,E", "sliding velocity at E"],
        ("m/s", "m/s", 5),
        |s| Some(s.figures?.sliding[0]),
        "The velocity at which the tip of the driven gear slides along the driver's \
            flank at the entry E.",
        Difference("ω_2 N2E - ω_1 N1E"),
    ),
    VELOCITY.row(
        ["sliding_velocity_exit", "ΔV_τ,B", "sliding velocity at B"],
        ("m/s", "m/s", 5),
        |s| Some(s.figures?.sliding[1]),
        "The velocity at which the driven flank slides along the tip of the driver \
            at the exit B.",
        Difference("ω_2 N2B - ω_1 N1B"),
    ),
    DRIVER[5],
    DRIVEN[5],
    DRIVER[6],
    DRIVEN[6],
    PRESSURE
        .row(
            ["hertz_pressure_pitch", "p_C", "Hertz pressure at P"],
            ("Pa", "MPa", 5),
            |s| Some(s.figures?.pitch_pressure),
            "The Hertz pressure at the pitch point P if one pair carries the mesh force: the contact \
            stress of ISO 6336-2 without its factors. A helix angle lengthens the contact lines \
            as in Z_ε of ISO 6336-2, up to their mean length at an overlap ratio of 1.",
            Cases(&[
                (
                    helical,
                    Text(
                        "√(F_0 E' cos β_b (1 - min(ε_β, 1) + min(ε_β, 1)/ε)/(π b ρ_C))",
                    ),
                ),
                (always, Text("√(F_0 E'/(π b ρ_C))")),
            ]),
        )
        .stage(Figures),
    STIFFNESS.row(
        ["iso_single_stiffness", "c'", "ISO single stiffness"],
        ("N/m2", "N/(mm um)", 5),
        |s| Some(s.figures?.stiffness.single),
        "The greatest stiffness of one pair per width by ISO 6336-1. \
            single_stiffness is that of the model.",
        Cases(&[
            (
                helical,
                Text(
                    "0.8 c'_th C_B cos β 2 E1 E2/((E1 + E2) 206 [GPa]) min(F_t/(100 [N/mm] b), \
            1)^(1/4)",
                ),
            ),
            (
                always,
                Text(
                    "0.8 c'_th C_B 2 E1 E2/((E1 + E2) 206 [GPa]) min(F_t/(100 [N/mm] b), \
            1)^(1/4)",
                ),
            ),
        ]),
    ),
    STIFFNESS.row(
        ["iso_mesh_stiffness", "c_γα", "ISO mesh stiffness"],
        ("N/m2", "N/(mm um)", 5),
        |s| Some(s.figures?.stiffness.mesh),
        "The mean stiffness of the mesh per width by ISO 6336-1. \
            mesh_stiffness_per_width is that of the model.",
        Text("c' (0.75 ε + 0.25)"),
    ),
    FIGURE
        .row(
            ["iso_dynamic_factor", "K_v", "ISO dynamic factor"],
            ("1", "1", 4),
            |s| Some(s.figures?.dynamic.factor),
            "The internal dynamic factor K_v-B of ISO 6336-1: the greatest force in the \
            mesh over the nominal force. It contains base pitch deviations, form \
            deviations and the tip relief at the entry. mesh_force_factor is that of \
            the model without deviations.",
            Made(factor_of_range),
        )
        .equation("ISO 6336-1")
        .source("ISO 6336-1:2019, 6.5, method B.")
        .assumptions(
            "Application factor K_A = 1. The running-in allowances y_p and y_f are left out: they depend \
                on the heat treatment, which a case does not have. Without a flank tolerance class the \
                form deviation is as large as the base pitch deviation. C_a is the sum of the tip \
                relief of the driven gear and the root relief of the driver; a class above 5 leaves \
                it out, B_k = 1.",
        )
        .checks(&[checks::iso_range, checks::contact_ratio]),
];

/// Active tip and root diameter of driver and driven gear, in m.
fn active_diameters(solution: &Solution) -> [[f64; 2]; 2] {
    let geometry = &solution.geometry;
    let rest = |along: f64| geometry.tangent_length - along;
    let ends = [[geometry.end, geometry.start], [rest(geometry.start), rest(geometry.end)]];
    let bases = [geometry.driver.base, geometry.driven.base];
    [0, 1].map(|gear| ends[gear].map(|length| 2.0 * bases[gear].hypot(length)))
}

/// Specific sliding of driver and driven gear at a point of the line of action, in m from N₁.
fn specific_sliding(solution: &Solution, along: f64) -> [f64; 2] {
    let geometry = &solution.geometry;
    let (driver, driven) = (geometry.ratio * along, geometry.tangent_length - along);
    [1.0 - driven / driver, 1.0 - driver / driven]
}

fn dynamic(k: &Context) -> Option<IsoDynamic> {
    Some(k.solution.figures?.dynamic)
}

/// The total contact ratio.
fn contact_ratio(k: &Context) -> f64 {
    k.solution.geometry.contact_ratio + k.solution.helix.overlap_ratio
}

/// C_v2, C_v3, C_v4, C_v6 and C_v7, as text.
fn shares(k: &Context) -> [String; 5] {
    let ratio = contact_ratio(k);
    let rest = match ratio {
        few if few <= 1.5 => "0.75",
        some if some <= 2.5 => "0.125 sin(π (ε - 2)) + 0.875",
        _ => "1",
    };
    let all = if ratio <= 2.0 {
        ["0.34", "0.23", "0.9", "0.47", rest]
    } else {
        let within = "(0.57 - 0.05 ε)/(ε - 1.44)";
        ["0.57/(ε - 0.3)", "0.096/(ε - 1.56)", within, "0.12/(ε - 1.74)", rest]
    };
    all.map(|share| share.replace('ε', if helical(k.inputs) { "ε_γ" } else { "ε" }))
}

fn below(k: &Context) -> String {
    let [form, relief, ..] = shares(k);
    format!("1 + N_c (0.32 B_p + {form} B_f + {relief} B_k)")
}

fn main(k: &Context) -> String {
    let [form, _, relief, ..] = shares(k);
    format!("1 + 0.32 B_p + {form} B_f + {relief} B_k")
}

fn beyond(k: &Context) -> String {
    let [.., form, rest] = shares(k);
    format!("0.47 B_p + {form} B_f + {rest}")
}

fn factor_of_range(k: &Context) -> String {
    let Some(dynamic) = dynamic(k) else { return String::new() };
    match dynamic.resonance_ratio {
        low if low <= dynamic.resonance_begin => below(k),
        middle if middle <= RESONANCE_ENDS[0] => main(k),
        high if high >= RESONANCE_ENDS[1] => beyond(k),
        _ => "K_15 + (K_115 - K_15) (1.5 - N_c)/0.35".to_owned(),
    }
}

/// K_v at a resonance ratio.
fn factor_at(k: &Context, ratio: f64) -> Option<f64> {
    let IsoDynamic { resonance_begin, terms, .. } = dynamic(k)?;
    Some(crate::model::figures::dynamic_factor(contact_ratio(k), ratio, resonance_begin, terms))
}

/// The compliance q' by the gear with fewer teeth, `one`, and the other.
fn compliance(k: &Context) -> String {
    let [one, two] = if driver_larger(k.inputs) { [2, 1] } else { [1, 2] };
    format!(
        "(0.04723 + 0.15551/z_n{one} + 0.25791/z_n{two} - 0.00635 x{one} - 0.11654 x{one}/z_n{one} \
         - 0.00193 x{two} - 0.24188 x{two}/z_n{two} + 0.00529 x{one}² + 0.00182 x{two}²) [um mm/N]"
    )
}

/// The angle at the tip and the root radius of a gear.
macro_rules! circles {
    ($n:literal, $gear:ident, $name:literal) => {
        [
            step(
                concat!("α_a", $n),
                concat!("profile angle at the tip of the ", $name),
                "deg",
                Text(concat!("acos(r_b", $n, "/r_a", $n, ")")),
                |k| {
                    let circles = k.solution.geometry.$gear;
                    Some((circles.base / circles.tip).acos())
                },
            ),
            step(
                concat!("r_f", $n),
                concat!("root radius of the ", $name),
                "mm",
                Text(concat!("r_", $n, " + m (x", $n, " - hf*", $n, ")")),
                |k| Some(k.solution.geometry.$gear.root),
            ),
        ]
    };
}

const DRIVER_CIRCLES: [Step; 2] = circles!("1", driver, "driver");
const DRIVEN_CIRCLES: [Step; 2] = circles!("2", driven, "driven gear");

pub(super) const STEPS: &[Step] = &[
    DRIVER_CIRCLES[0],
    DRIVEN_CIRCLES[0],
    DRIVER_CIRCLES[1],
    DRIVEN_CIRCLES[1],
    step(
        "N2B",
        "from the driven gear's tangent point to B",
        "mm",
        Difference("a sin α_w - N1B"),
        |k| Some(k.solution.geometry.tangent_length - k.solution.geometry.end),
    ),
    step(
        "ρ_C",
        "reduced radius of curvature at the pitch point",
        "mm",
        Text("r_b1 r_b2 tan α_w/(r_b1 + r_b2)"),
        |k| {
            let geometry = &k.solution.geometry;
            let (one, other) = (geometry.driver.base, geometry.driven.base);
            Some(one * other * geometry.tangent_length / (one + other).powi(2))
        },
    ),
    step("c'_th", "theoretical single stiffness", "N/(mm um)", Text("1/q'"), |k| {
        Some(k.solution.figures?.stiffness.theoretical)
    }),
    step("q'", "compliance of a pair of steel discs", "um mm/N", Made(compliance), |k| {
        Some(1.0 / k.solution.figures?.stiffness.theoretical)
    }),
    step(
        "C_B",
        "factor of the basic racks",
        "1",
        Text("(1 + 0.25 (2.4 - hf*1 - hf*2)) (1 - 0.02 (20 - α/[deg]))"),
        |k| Some(k.solution.figures?.stiffness.rack),
    ),
    step("N_c", "resonance ratio with c_γα", "1", Text("ω_1 z1 √(m_red/(c_γα b))"), |k| {
        Some(dynamic(k)?.resonance_ratio)
    }),
    step("B_p", "term of the base pitch deviation", "1", Text("c' f_pe b/F_t"), |k| {
        Some(dynamic(k)?.terms[0])
    }),
    step("B_f", "term of the form deviation", "1", Text("c' f_fe b/F_t"), |k| {
        Some(dynamic(k)?.terms[1])
    }),
    step(
        "B_k",
        "term of the tip relief",
        "1",
        Cases(&[(any_coarse, Text("1")), (always, Difference("|1 - c' (Ca2 + Cf1) b/F_t|"))]),
        |k| Some(dynamic(k)?.terms[2]),
    ),
    step(
        "f_pe",
        "greater base pitch deviation of the two gears",
        "um",
        Text("max(|f_pb1|, |f_pb2|)"),
        |k| Some(dynamic(k)?.pitch),
    ),
    step(
        "f_fe",
        "greater profile form deviation of the two gears",
        "um",
        Cases(&[
            (
                any_class,
                Words(
                    "(0.55 m + 5) 2^((A - 5)/2) um, m in mm, rounded by ISO 1328-1; |f_pb| \
            without a class",
                ),
            ),
            (always, Text("f_pe")),
        ]),
        |k| Some(dynamic(k)?.form),
    ),
    step("K_115", "K_v at N_c = 1.15", "1", Made(main), |k| factor_at(k, RESONANCE_ENDS[0])),
    step("K_15", "K_v at N_c = 1.5", "1", Made(beyond), |k| factor_at(k, RESONANCE_ENDS[1])),
];
