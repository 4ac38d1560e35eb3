//! Rows of the impact: force, energy and duration, with their steps.

use super::conditions::{always, paper, shared_load};
use super::{PLAIN, Quantity, Variant, checks};
use crate::model::Stage::{Band, Impact};
use crate::model::explanation::Formula::{Cases, Made, Text};
use crate::model::explanation::{Context, Step, step};
use crate::model::impact::{HERTZ_PREFACTOR, StiffnessModels};
use crate::model::{self, Inputs, Stages};

const SPRING: &str = "The effective mass strikes the pair at D as a mass strikes a spring, without \
    damping and without another pair in contact. The place and the stiffness of the pair stay \
    constant during the impact.";
const BAND: &str = "Every tooth compliance that covers the pair is combined with every contact \
    compliance. Each combination uses the given deflection, or else its own deflection. The mass \
    is the same for all models. No measurement shows which model is correct.";
const BAND_SHARED: &str = "Every tooth compliance that covers the pair is combined with every \
    contact compliance, each with its own deflection. The models share the mass, and \
    no measurement shows which model is right.";
const SPHERES: &str = "Two spheres collide. The bending of the teeth is neglected.";

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "impact_force",
        symbol: "F_S",
        label: "impact force",
        unit: "N",
        shown: "N",
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
        by_static: Some("static_force_at_start"),
        by_dynamic: Some("dynamic_peak_approach_force"),
        ..PLAIN
    },
    Quantity {
        key: "impact_force_low",
        symbol: "F_S,low",
        label: "  lowest, all models",
        unit: "N",
        shown: "N",
        digits: 4,
        equation: "models in range",
        stage: Band,
        value: |s| Some(s.band?.low),
        meaning: "The impact force by the most compliant of the stiffness models that cover the \
            pair.",
        formula: Made(|k| over_models(k, "min")),
        source: "Zhou & Chen 2014, Eq. 57, with all stiffness models in range: the models in \
            range combine a tooth compliance and a contact compliance.",
        corrections: &["Eq. 56"],
        assumptions: BAND,
        checks: &[checks::teeth],
        variants: &[Variant::words(
            shared_load,
            "The force of the free impact by the most compliant of the stiffness models that \
                cover the pair.",
            BAND_SHARED,
        )],
        by_static: Some("static_force_at_start"),
        by_dynamic: Some("dynamic_peak_approach_force"),
        ..PLAIN
    },
    Quantity {
        key: "impact_force_high",
        symbol: "F_S,high",
        label: "  highest, all models",
        unit: "N",
        shown: "N",
        digits: 4,
        equation: "models in range",
        stage: Band,
        value: |s| Some(s.band?.high),
        meaning: "The impact force by the stiffest of the stiffness models that cover the pair.",
        formula: Made(|k| over_models(k, "max")),
        source: "Zhou & Chen 2014, Eq. 57, with all stiffness models in range: the models in \
            range combine a tooth compliance and a contact compliance.",
        corrections: &["Eq. 56"],
        assumptions: BAND,
        checks: &[checks::teeth],
        variants: &[Variant::words(
            shared_load,
            "The force of the free impact by the stiffest of the stiffness models that cover the \
                pair.",
            BAND_SHARED,
        )],
        by_static: Some("static_force_at_start"),
        by_dynamic: Some("dynamic_peak_approach_force"),
        ..PLAIN
    },
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
        unit: "s",
        shown: "us",
        digits: 4,
        equation: "by the method",
        stage: Impact,
        value: |s| Some(s.impact?.duration()),
        meaning: "The duration of the impact by the method of the case.",
        formula: Cases(&[(paper, Text("T_S,32")), (always, Text("T_S,q"))]),
        source: "Method paper: Zhou & Chen 2014, Eq. 32. Method exact: half a period of the \
            spring and mass that give F_S.",
        corrections: &["Eq. 32"],
        assumptions: SPRING,
        checks: &[checks::within_approach, checks::possible],
        variants: &[Variant::words(
            paper,
            "The duration of the impact by Eq. 32 as printed.",
            "Two spheres collide. The bending of the teeth, which determines the force, is \
                neglected.",
        )],
        by_dynamic: Some("dynamic_impact_duration"),
        ..PLAIN
    },
    Quantity {
        key: "impact_duration_printed",
        symbol: "T_S,32",
        label: "  by Eq. 32 as printed",
        unit: "s",
        shown: "us",
        digits: 4,
        equation: "Eq. 32",
        stage: Impact,
        value: |s| Some(s.impact?.duration_printed()),
        meaning: "The duration of Eq. 32 as printed. Methods paper and exact compute the friction \
            ratio with it, as published.",
        formula: Text("(m_red²/(π² ΔV_n ρ_S E'²))^(1/5)"),
        source: "Zhou & Chen 2014, Eq. 32, after Hertz 1882.",
        corrections: &["Eq. 32", "Eq. 33, Eq. 50"],
        assumptions: SPHERES,
        checks: &[checks::printed_shorter],
        by_dynamic: Some("dynamic_impact_duration"),
        ..PLAIN
    },
    Quantity {
        key: "impact_duration_hertz",
        symbol: "T_S,H",
        label: "  with Hertz's prefactor",
        unit: "s",
        shown: "us",
        digits: 4,
        equation: "Hertz 1882",
        stage: Impact,
        value: |s| Some(s.impact?.duration_hertz()),
        meaning: "The duration of the collision of two spheres after Hertz, with the prefactor \
            that Eq. 32 omits.",
        formula: Text("C_H T_S,32"),
        source: "Hertz 1882: T = 2.868266 (M²/(ρ E'² ΔV_n))^(1/5). Eq. 32 omits the factor \
            2.868266 π^(2/5).",
        corrections: &["Eq. 32"],
        assumptions: SPHERES,
        by_dynamic: Some("dynamic_impact_duration"),
        ..PLAIN
    },
    Quantity {
        key: "impact_duration_spring",
        symbol: "T_S,q",
        label: "  by pair compliance",
        unit: "s",
        shown: "us",
        digits: 4,
        equation: "π√(Mq/b)",
        stage: Impact,
        value: |s| Some(s.impact?.duration_spring()),
        meaning: "Half a period of the effective mass on the pair compliance. The impact force \
            uses the same mass and compliance.",
        formula: Text("π √(M q_s/b)"),
        source: "Free vibration of the mass and spring of Zhou & Chen 2014, Eqs. 50-57: π√(Mq/b).",
        corrections: &["Eq. 32"],
        assumptions: SPRING,
        checks: &[checks::within_approach, checks::teeth],
        by_dynamic: Some("dynamic_impact_duration"),
        ..PLAIN
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
#[must_use]
pub fn spread_force(inputs: &Inputs, models: &StiffnessModels) -> Option<f64> {
    let solution = model::solve(&models.in_place_of(inputs), Stages::of(Impact)).ok()?;
    Some(solution.impact?.force)
}

pub(super) const STEPS: &[Step] = &[step(
    "C_H",
    "ratio of Hertz's duration to Eq. 32",
    "1",
    Text("2.868265699 π^(2/5)"),
    |_| Some(HERTZ_PREFACTOR),
)];
