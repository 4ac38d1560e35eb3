//! Rows of the impact: force, energy and duration, and the terms of the force, with their steps.

use super::conditions::{always, inertia_given, paper};
use super::figures::PRESSURE;
use super::{Need, PLAIN, Quantity, Variant, checks};
use crate::model;
use crate::model::Stage::{Band, Impact, Masses};
use crate::model::explanation::Formula::{Cases, Given, Made, Text, Words};
use crate::model::explanation::{Context, Step, step};
use crate::model::impact::{HERTZ_PREFACTOR, StiffnessModels};
use crate::model::inputs::InertiaModel;
use crate::model::{Inputs, Stages};

const SPRING: &str = "The effective mass strikes the pair at D as a mass strikes a spring, \
                without damping and without another pair in contact. Place and stiffness \
                stay constant.";
const BAND: &str = "Every tooth compliance that covers the pair is combined with every contact \
                compliance, with the given deflection or its own, and with the same mass. \
                No measurement shows which model is correct.";
const SPHERES: &str = "Two spheres collide. The bending of the teeth is neglected.";
const BODY: &str = "Each gear is a solid body of its own width from the bore to its outline, \
            or to the base circle with model.inertia = \"base-circle\", without web, \
            shaft or coupling. The field inertia of a gear gives the moment of inertia \
            of all that turns with it.";

/// A force of the free impact, by default over all stiffness models.
const FORCE: Quantity = Quantity {
    equation: "models in range",
    stage: Band,
    source: "Zhou & Chen 2014, Eq. 57, with all stiffness models in range.",
    corrections: &["Eq. 56"],
    assumptions: BAND,
    checks: &[checks::teeth],
    by_static: Some("static_force_at_start"),
    by_dynamic: Some("dynamic_peak_approach_force"),
    ..PLAIN
};

/// A duration of the impact.
const DURATION: Quantity = Quantity {
    stage: Impact,
    corrections: &["Eq. 32"],
    assumptions: SPRING,
    by_dynamic: Some("dynamic_impact_duration"),
    ..PLAIN
};

/// A moment of inertia.
const INERTIA: Quantity = Quantity {
    equation: "∫r² dm",
    stage: Masses,
    source: "Method paper: Zhou & Chen 2014, Eq. 47. Outline: ∫r² dm over the section \
            that the rack cuts, involute and fillet.",
    corrections: &["Eq. 47"],
    assumptions: BODY,
    checks: &[checks::bodies],
    ..PLAIN
};

/// A mass on the line of action.
const MASS: Quantity = Quantity {
    corrections: &["Eq. 33, Eq. 50", "Eq. 46"],
    assumptions: BODY,
    checks: &[checks::bodies],
    ..PLAIN
};

/// An energy of the whole width.
const ENERGY: Quantity =
    Quantity { stage: Impact, corrections: &["Eq. 46", "Eq. 33, Eq. 50"], ..PLAIN };

/// The row of an end of the spread over the stiffness models.
macro_rules! spread {
    ($key:literal, $symbol:literal, $label:literal, $end:ident, $word:literal, $choice:literal) => {
        FORCE.row(
            [$key, $symbol, $label],
            ("N", "N", 5),
            |s| Some(s.band?.$end),
            concat!(
                "The impact force by the ",
                $word,
                " of the stiffness models that cover the pair."
            ),
            Made(|k| over_models(k, $choice)),
        )
    };
}

/// The row of a moment of inertia: key, symbol, place and name of the gear, and its field.
macro_rules! inertia {
    ($key:literal, $symbol:literal, $gear:literal, $name:literal, $field:literal) => {
        INERTIA.row(
            [$key, $symbol, concat!("inertia of ", $name)],
            ("kg m2", "kg mm2", 5),
            |s| Some(s.kept.masses.inertias[$gear].moment),
            concat!("The moment of inertia of the ", $name, " about its axis."),
            Cases(&[
                (inertia_given::<$gear>, Given($field)),
                (always, Made(|k| inertia(k, $gear))),
            ]),
        )
    };
}

pub(super) const TABLE: &[Quantity] = &[
    FORCE
        .row(
            ["impact_force", "F_S", "impact force"],
            ("N", "N", 5),
            |s| Some(s.impact?.force),
            "The peak force of the impact of the tip on the driver's flank, over the \
            whole width. q_s includes the contact compliance under this force, so the \
            solver computes both together.",
            Text("ΔV_n √(b M/q_s)"),
        )
        .equation("Eq. 57")
        .stage(Impact)
        .source("Zhou & Chen 2014, Eqs. 50-57.")
        .corrections(&["Eq. 53", "Eq. 54", "Eq. 33, Eq. 50", "Table 1"])
        .assumptions(SPRING)
        .checks(&[
            checks::gap_closed,
            checks::teeth,
            checks::contact_small,
            checks::within_approach,
        ]),
    spread!("impact_force_low", "F_S,low", "  lowest, all models", low, "most compliant", "min"),
    spread!("impact_force_high", "F_S,high", "  highest, all models", high, "stiffest", "max"),
    PLAIN
        .row(
            ["dynamic_factor", "F_S/F_0", "dynamic factor"],
            ("1", "1", 4),
            |s| Some(s.impact?.force / s.mesh_force),
            "The ratio of the impact force to the steady mesh force.",
            Text("F_S/F_0"),
        )
        .equation("F_S/F_0")
        .stage(Impact)
        .source("Zhou & Chen 2014, section 6: the ratio F_S/F_0.")
        .corrections(&["section 6"])
        .assumptions(
            "The impact alone is compared with the steady load alone. K_v of ISO 6336 \
                includes the whole mesh.",
        )
        .checks(&[checks::gap_closed, checks::within_approach])
        .counterparts("entry_force_ratio", "entry_force_ratio"),
    DURATION
        .row(
            ["impact_duration", "T_S", "impact duration"],
            ("s", "us", 4),
            |s| Some(s.impact?.duration),
            "The duration of the impact by ",
            Cases(&[(paper, Text("T_S,32")), (always, Text("T_S,q"))]),
        )
        .equation("by the method")
        .source(
            "Method paper: Zhou & Chen 2014, Eq. 32. Method exact: half a period of the \
            spring and mass that give F_S.",
        )
        .checks(&[checks::within_approach, checks::possible])
        .variants(&[
            Variant::words(
                paper,
                "Eq. 32 as printed.",
                "Two spheres collide. The bending of the teeth is neglected.",
            ),
            Variant::meaning(always, "the method of the case."),
        ]),
    DURATION
        .row(
            ["impact_duration_printed", "T_S,32", "  by Eq. 32 as printed"],
            ("s", "us", 4),
            |s| Some(s.impact?.duration_printed),
            "The duration of Eq. 32 as printed, with which the friction ratio is \
                computed, as published.",
            Text("(m_red²/(π² ΔV_n ρ_S E'²))^(1/5)"),
        )
        .equation("Eq. 32")
        .source("Zhou & Chen 2014, Eq. 32, after Hertz 1882.")
        .corrections(&["Eq. 32", "Eq. 33, Eq. 50"])
        .assumptions(SPHERES)
        .checks(&[checks::printed_shorter]),
    DURATION
        .row(
            ["impact_duration_hertz", "T_S,H", "  with Hertz's prefactor"],
            ("s", "us", 4),
            |s| Some(s.impact?.duration_hertz()),
            "The duration of the collision of two spheres after Hertz, with the \
            prefactor that Eq. 32 omits.",
            Text("C_H T_S,32"),
        )
        .equation("Hertz 1882")
        .source(
            "Hertz 1882: T = 2.868266 (M²/(ρ E'² ΔV_n))^(1/5). Eq. 32 omits the factor \
            2.868266 π^(2/5).",
        )
        .assumptions(SPHERES),
    DURATION
        .row(
            ["impact_duration_spring", "T_S,q", "  by pair compliance"],
            ("s", "us", 4),
            |s| Some(s.impact?.duration_spring),
            "Half a period of the effective mass on the pair compliance. The impact \
            force uses the same mass and compliance.",
            Text("π √(M q_s/b)"),
        )
        .equation("π√(Mq/b)")
        .source(
            "Free vibration of the mass and spring of Zhou & Chen 2014, Eqs. 50-57: \
            π√(Mq/b).",
        )
        .checks(&[checks::within_approach, checks::teeth]),
    inertia!("inertia_driver", "J_1", 0, "driver", "driver.inertia"),
    inertia!("inertia_driven", "J_2", 1, "driven gear", "driven.inertia"),
    MASS.row(
        ["reduced_mass", "m_red", "reduced mass"],
        ("kg", "kg", 5),
        |s| Some(s.reduced_mass),
        "The masses of both gears on the line of action, combined in series. The \
                impact force uses the effective mass at D.",
        Text("m_1 m_2/(m_1 + m_2)"),
    )
    .equation("Eq. 33")
    .stage(Masses)
    .source("Zhou & Chen 2014, Eqs. 33 and 46."),
    MASS.row(
        ["effective_mass", "M", "effective mass at D"],
        ("kg", "kg", 5),
        |s| Some(s.impact?.effective_mass),
        "The masses of both gears combined along the contact normal at D: the \
            reduced mass, with r_b2' instead of r_b2 as the lever arm of the driven \
            gear.",
        Text("m_1 m_2/(m_1 (r_b2'/r_b2)² + m_2)"),
    )
    .equation("Eq. 50")
    .stage(Impact)
    .source("Zhou & Chen 2014, Eq. 50: J_1 J_2/(J_1 r_b2'² + J_2 r_b1²)."),
    PLAIN
        .row(
            ["pair_compliance", "q_s", "pair compliance"],
            ("m2/N", "um mm/N", 5),
            |s| Some(s.impact?.pair_compliance),
            "The deflection of the pair in contact at D along the contact normal, per \
            force and width: two teeth and the contact.",
            Text("q_1 + q_2 + q_H"),
        )
        .equation("Eq. 54")
        .stage(Impact)
        .source(
            "Zhou & Chen 2014, Eqs. 54-56, with the tooth compliance and the contact \
            compliance of the case.",
        )
        .corrections(&["Eq. 54", "Eq. 55", "Eq. 56"])
        .assumptions(
            "The teeth are linear elastic and of one width. The contact compliance is \
            that under the impact force.",
        )
        .checks(&[checks::teeth, checks::contact_small]),
    PLAIN
        .row(
            ["hertz_half_width", "a_H", "Hertz half-width"],
            ("m", "um", 5),
            |s| Some(s.impact?.hertz_half_width),
            "Half the width of the contact area of tip and flank under the impact \
            force.",
            Text("√(4 F_S ρ_S/(π b E'))"),
        )
        .equation("Eq. 55")
        .stage(Impact)
        .source("Hertz 1882, two cylinders. Zhou & Chen 2014 do not define a in Eq. 55.")
        .corrections(&["Eq. 55"])
        .assumptions("Smooth cylinders of the reduced radius at D over the full width.")
        .checks(&[checks::contact_small, checks::edge]),
    PRESSURE
        .row(
            ["corner_pressure", "p_S", "corner pressure"],
            ("Pa", "MPa", 5),
            |s| s.impact?.corner_pressure,
            "The Hertz pressure of the rounded tip edge on the driver's flank under the \
                impact force.",
            Text("2 F_S/(π a_H b)"),
        )
        .stage(Impact)
        .checks(&[checks::contact_small, checks::edge])
        .needs(Need::TipRadius),
    ENERGY
        .row(
            ["impact_energy", "E_k", "impact energy"],
            ("J", "J", 5),
            |s| Some(s.impact?.energy),
            "The kinetic energy of the approach at D, over the whole width. The teeth \
            absorb it and return it.",
            Text("M ΔV_n²/2"),
        )
        .equation("Eq. 50")
        .source("Zhou & Chen 2014, Eq. 50.")
        .assumptions("The gears approach at their steady speeds.")
        .checks(&[checks::gap_closed]),
    ENERGY
        .row(
            ["sliding_energy", "W_f", "sliding energy"],
            ("J", "J", 5),
            |s| Some(s.impact?.sliding_energy),
            "The energy of the sliding at D, over the whole width. Friction can absorb \
                only a part of it: see stick_limit.",
            Text("M ΔV_τ²/2"),
        )
        .equation("Eq. 51")
        .source("Zhou & Chen 2014, Eq. 51.")
        .assumptions(
            "The effective mass along the normal also applies to the sliding, as \
            printed.",
        )
        .checks(&[checks::gap_closed, checks::keeps_sliding]),
];

/// The least or the greatest force of the case's model and all models in range, as a formula.
fn over_models(k: &Context, choice: &str) -> String {
    let forces = StiffnessModels::others(k.inputs)
        .filter(|models| spread_force(k.inputs, models).is_some())
        .map(|models| models.symbol());
    let all: Vec<String> = std::iter::once("F_S".to_owned()).chain(forces).collect();
    format!("{choice}({})", all.join(", "))
}

/// The impact force by other stiffness models, in N.
pub fn spread_force(inputs: &Inputs, models: &StiffnessModels) -> Option<f64> {
    let solution = model::solve(&models.in_place_of(inputs), Stages::of(Impact)).ok()?;
    Some(solution.impact?.force)
}

/// Formula of the moment of inertia of a gear without a given inertia.
fn inertia(k: &Context, gear: usize) -> String {
    let n = gear + 1;
    let is_outline = k.inputs.inertia_model() == InertiaModel::Outline;
    if is_outline && !k.solution.kept.masses.inertias[gear].is_fallback {
        format!("ρ{n} b{n} I_p{n}")
    } else {
        format!("π ρ{n} b{n}/2 (r_b{n}⁴ - rh{n}⁴)")
    }
}

/// Polar moment of a gear's section, in m⁴.
fn section(k: &Context, gear: usize) -> f64 {
    let body = [&k.inputs.driver, &k.inputs.driven][gear];
    let moment = k.solution.kept.masses.inertias[gear].moment;
    moment / (body.density * body.face_width)
}

pub(super) const STEPS: &[Step] = &[
    step(
        "I_p1",
        "polar moment of the driver's section, bore to outline",
        "mm4",
        Words("the integral of r² over the section"),
        |k| Some(section(k, 0)),
    ),
    step(
        "I_p2",
        "polar moment of the driven gear's section, bore to outline",
        "mm4",
        Words("the integral of r² over the section"),
        |k| Some(section(k, 1)),
    ),
    step(
        "E'",
        "modulus of both materials in plane strain",
        "GPa",
        Text("1/((1 - ν1²)/E1 + (1 - ν2²)/E2)"),
        |k| Some(1.0 / k.inputs.elasticity().give()),
    ),
    step("C_H", "ratio of Hertz's duration to Eq. 32", "1", Text("2.868265699 π^(2/5)"), |_| {
        Some(HERTZ_PREFACTOR)
    }),
];
