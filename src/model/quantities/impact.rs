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

const SPRING: &str = "The effective mass strikes the pair at D as a mass strikes a spring, without \
    damping and without another pair in contact. The place and the stiffness of the pair stay \
    constant during the impact.";
const BAND: &str = "Every tooth compliance that covers the pair is combined with every contact \
    compliance. Each combination uses the given deflection, or else its own deflection. The mass \
    is the same for all models. No measurement shows which model is correct.";
const SPHERES: &str = "Two spheres collide. The bending of the teeth is neglected.";
const BODY: &str = "Each gear is a solid body of its own width from the bore to its outline, or to \
    the base circle with model.inertia = \"base-circle\", without web, shaft or coupling. The field \
    inertia of a gear gives the moment of inertia of all that turns with it.";

/// A force of the free impact, by default over all stiffness models.
const FORCE: Quantity = Quantity {
    unit: "N",
    shown: "N",
    digits: 4,
    equation: "models in range",
    stage: Band,
    source: "Zhou & Chen 2014, Eq. 57, with all stiffness models in range: the models in \
        range combine a tooth compliance and a contact compliance.",
    corrections: &["Eq. 56"],
    assumptions: BAND,
    checks: &[checks::teeth],
    by_static: Some("static_force_at_start"),
    by_dynamic: Some("dynamic_peak_approach_force"),
    ..PLAIN
};

/// A duration of the impact.
const DURATION: Quantity = Quantity {
    unit: "s",
    shown: "us",
    digits: 4,
    stage: Impact,
    corrections: &["Eq. 32"],
    assumptions: SPRING,
    by_dynamic: Some("dynamic_impact_duration"),
    ..PLAIN
};

/// A moment of inertia.
const INERTIA: Quantity = Quantity {
    unit: "kg m2",
    shown: "kg mm2",
    digits: 5,
    equation: "∫r² dm",
    stage: Masses,
    source: "Method paper: Zhou & Chen 2014, Eq. 47. Outline: ∫r² dm over the section that the \
        rack cuts, involute and fillet.",
    corrections: &["Eq. 47"],
    assumptions: BODY,
    checks: &[checks::bodies],
    ..PLAIN
};

/// A mass on the line of action.
const MASS: Quantity = Quantity {
    unit: "kg",
    shown: "kg",
    digits: 5,
    corrections: &["Eq. 33, Eq. 50", "Eq. 46"],
    assumptions: BODY,
    checks: &[checks::bodies],
    ..PLAIN
};

/// An energy of the whole width.
const ENERGY: Quantity = Quantity {
    unit: "J",
    shown: "J",
    digits: 5,
    stage: Impact,
    corrections: &["Eq. 46", "Eq. 33, Eq. 50"],
    ..PLAIN
};

/// The row of an end of the spread over the stiffness models.
macro_rules! spread {
    ($key:literal, $symbol:literal, $label:literal, $end:ident, $word:literal, $choice:literal) => {
        Quantity {
            key: $key,
            symbol: $symbol,
            label: $label,
            value: |s| Some(s.band?.$end),
            meaning: concat!(
                "The impact force by the ",
                $word,
                " of the stiffness models that cover the pair."
            ),
            formula: Made(|k| over_models(k, $choice)),
            ..FORCE
        }
    };
}

/// The row of a moment of inertia: key, symbol, place and name of the gear, and its field.
macro_rules! inertia {
    ($key:literal, $symbol:literal, $gear:literal, $name:literal, $field:literal) => {
        Quantity {
            key: $key,
            symbol: $symbol,
            label: concat!("inertia of ", $name),
            value: |s| Some(s.kept.masses.inertias[$gear].moment),
            meaning: concat!("The moment of inertia of the ", $name, " about its axis."),
            formula: Cases(&[
                (inertia_given::<$gear>, Given($field)),
                (always, Made(|k| inertia(k, $gear))),
            ]),
            ..INERTIA
        }
    };
}

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "impact_force",
        symbol: "F_S",
        label: "impact force",
        digits: 5,
        equation: "Eq. 57",
        stage: Impact,
        value: |s| Some(s.impact?.force),
        meaning: "The peak force of the impact of the tip on the driver's flank, over the whole \
            width. q_s includes the contact compliance under this force, so the solver computes \
            both together.",
        formula: Text("ΔV_n √(b M/q_s)"),
        source: "Zhou & Chen 2014, Eqs. 50-57.",
        corrections: &["Eq. 53", "Eq. 54", "Eq. 33, Eq. 50", "Table 1"],
        assumptions: SPRING,
        checks: &[
            checks::gap_closed,
            checks::teeth,
            checks::contact_small,
            checks::within_approach,
        ],
        ..FORCE
    },
    spread!("impact_force_low", "F_S,low", "  lowest, all models", low, "most compliant", "min"),
    spread!("impact_force_high", "F_S,high", "  highest, all models", high, "stiffest", "max"),
    Quantity {
        key: "dynamic_factor",
        symbol: "F_S/F_0",
        label: "dynamic factor",
        unit: "1",
        shown: "1",
        digits: 4,
        equation: "F_S/F_0",
        stage: Impact,
        value: |s| Some(s.impact?.force / s.mesh_force),
        meaning: "The ratio of the impact force to the steady mesh force.",
        formula: Text("F_S/F_0"),
        source: "Zhou & Chen 2014, section 6: the ratio F_S/F_0.",
        corrections: &["section 6"],
        assumptions: "The ratio compares the impact alone with the steady load alone. It is not \
            the factor K_v of ISO 6336, which includes the whole mesh.",
        checks: &[checks::gap_closed, checks::within_approach],
        ..PLAIN
    },
    Quantity {
        key: "impact_duration",
        symbol: "T_S",
        label: "impact duration",
        equation: "by the method",
        value: |s| Some(s.impact?.duration),
        meaning: "The duration of the impact by ",
        formula: Cases(&[(paper, Text("T_S,32")), (always, Text("T_S,q"))]),
        source: "Method paper: Zhou & Chen 2014, Eq. 32. Method exact: half a period of the \
            spring and mass that give F_S.",
        checks: &[checks::within_approach, checks::possible],
        variants: &[
            Variant::words(
                paper,
                "Eq. 32 as printed.",
                "Two spheres collide. The bending of the teeth, which determines the force, is \
                    neglected.",
            ),
            Variant::meaning(always, "the method of the case."),
        ],
        ..DURATION
    },
    Quantity {
        key: "impact_duration_printed",
        symbol: "T_S,32",
        label: "  by Eq. 32 as printed",
        equation: "Eq. 32",
        value: |s| Some(s.impact?.duration_printed),
        meaning: "The duration of Eq. 32 as printed. Methods paper and exact compute the friction \
            ratio with it, as published.",
        formula: Text("(m_red²/(π² ΔV_n ρ_S E'²))^(1/5)"),
        source: "Zhou & Chen 2014, Eq. 32, after Hertz 1882.",
        corrections: &["Eq. 32", "Eq. 33, Eq. 50"],
        assumptions: SPHERES,
        checks: &[checks::printed_shorter],
        ..DURATION
    },
    Quantity {
        key: "impact_duration_hertz",
        symbol: "T_S,H",
        label: "  with Hertz's prefactor",
        equation: "Hertz 1882",
        value: |s| Some(s.impact?.duration_hertz()),
        meaning: "The duration of the collision of two spheres after Hertz, with the prefactor \
            that Eq. 32 omits.",
        formula: Text("C_H T_S,32"),
        source: "Hertz 1882: T = 2.868266 (M²/(ρ E'² ΔV_n))^(1/5). Eq. 32 omits the factor \
            2.868266 π^(2/5).",
        assumptions: SPHERES,
        ..DURATION
    },
    Quantity {
        key: "impact_duration_spring",
        symbol: "T_S,q",
        label: "  by pair compliance",
        equation: "π√(Mq/b)",
        value: |s| Some(s.impact?.duration_spring),
        meaning: "Half a period of the effective mass on the pair compliance. The impact force \
            uses the same mass and compliance.",
        formula: Text("π √(M q_s/b)"),
        source: "Free vibration of the mass and spring of Zhou & Chen 2014, Eqs. 50-57: π√(Mq/b).",
        checks: &[checks::within_approach, checks::teeth],
        ..DURATION
    },
    inertia!("inertia_driver", "J_1", 0, "driver", "driver.inertia"),
    inertia!("inertia_driven", "J_2", 1, "driven gear", "driven.inertia"),
    Quantity {
        key: "reduced_mass",
        symbol: "m_red",
        label: "reduced mass",
        equation: "Eq. 33",
        stage: Masses,
        value: |s| Some(s.reduced_mass),
        meaning: "The masses of both gears on the line of action, combined in series. Eqs. 31 and \
            32 use it. The impact force uses the effective mass at D.",
        formula: Text("m_1 m_2/(m_1 + m_2)"),
        source: "Zhou & Chen 2014, Eqs. 33 and 46.",
        ..MASS
    },
    Quantity {
        key: "effective_mass",
        symbol: "M",
        label: "effective mass at D",
        equation: "Eq. 50",
        stage: Impact,
        value: |s| Some(s.impact?.effective_mass),
        meaning: "The masses of both gears combined along the contact normal at D: the reduced \
            mass, with r_b2' instead of r_b2 as the lever arm of the driven gear.",
        formula: Text("m_1 m_2/(m_1 (r_b2'/r_b2)² + m_2)"),
        source: "Zhou & Chen 2014, Eq. 50: J_1 J_2/(J_1 r_b2'² + J_2 r_b1²).",
        ..MASS
    },
    Quantity {
        key: "pair_compliance",
        symbol: "q_s",
        label: "pair compliance",
        unit: "m2/N",
        shown: "um mm/N",
        digits: 5,
        equation: "Eq. 54",
        stage: Impact,
        value: |s| Some(s.impact?.pair_compliance),
        meaning: "The deflection of the pair in contact at D along the contact normal, per force \
            and width: two teeth and the contact.",
        formula: Text("q_1 + q_2 + q_H"),
        source: "Zhou & Chen 2014, Eqs. 54-56, with the tooth compliance and the contact \
            compliance of the case.",
        corrections: &["Eq. 54", "Eq. 55", "Eq. 56"],
        assumptions: "The teeth are linear elastic and of one width. The contact compliance is \
            that under the impact force.",
        checks: &[checks::teeth, checks::contact_small],
        ..PLAIN
    },
    Quantity {
        key: "hertz_half_width",
        symbol: "a_H",
        label: "Hertz half-width",
        unit: "m",
        shown: "um",
        digits: 5,
        equation: "Eq. 55",
        stage: Impact,
        value: |s| Some(s.impact?.hertz_half_width),
        meaning: "Half the width of the contact area of tip and flank under the impact force.",
        formula: Text("√(4 F_S ρ_S/(π b E'))"),
        source: "Hertz 1882, two cylinders. Zhou & Chen 2014 do not define a in Eq. 55.",
        corrections: &["Eq. 55"],
        assumptions: "Smooth cylinders of the reduced radius at D over the full width.",
        checks: &[checks::contact_small, checks::edge],
        ..PLAIN
    },
    Quantity {
        key: "corner_pressure",
        symbol: "p_S",
        label: "corner pressure",
        stage: Impact,
        value: |s| s.impact?.corner_pressure,
        meaning: "The Hertz pressure of the rounded tip edge on the driver's flank under the impact force. \
            A sharp edge has no finite pressure: this result needs the tip radius of the driven gear.",
        formula: Text("2 F_S/(π a_H b)"),
        checks: &[checks::contact_small, checks::edge],
        needs: Need::TipRadius,
        ..PRESSURE
    },
    Quantity {
        key: "impact_energy",
        symbol: "E_k",
        label: "impact energy",
        equation: "Eq. 50",
        value: |s| Some(s.impact?.energy),
        meaning: "The kinetic energy of the approach at D, over the whole width. The teeth absorb \
            it and return it.",
        formula: Text("M ΔV_n²/2"),
        source: "Zhou & Chen 2014, Eq. 50.",
        assumptions: "The gears approach at their steady speeds.",
        checks: &[checks::gap_closed],
        ..ENERGY
    },
    Quantity {
        key: "sliding_energy",
        symbol: "W_f",
        label: "sliding energy",
        equation: "Eq. 51",
        value: |s| Some(s.impact?.sliding_energy),
        meaning: "The energy of the sliding at D by Eq. 51, over the whole width. Friction can \
            absorb only a part of it: see stick_limit.",
        formula: Text("M ΔV_τ²/2"),
        source: "Zhou & Chen 2014, Eq. 51.",
        assumptions: "The effective mass along the normal also applies to the sliding, as printed.",
        checks: &[checks::gap_closed, checks::keeps_sliding],
        ..ENERGY
    },
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
