//! Rows of the terms of the impact force: masses, compliance and energies.

use super::conditions::{
    always, driven_inertia_given, driven_outline, driver_inertia_given, driver_outline,
};
use super::{PLAIN, Quantity, checks};
use crate::model::Context;
use crate::model::Stage::{Impact, Masses};
use crate::model::compliance::contact::plane_strain_compliance;
use crate::model::explanation::Formula::{Cases, Given, Made, Text, Words};
use crate::model::explanation::{Step, step};

const BODY: &str = "Each gear is a solid body of its own width from the bore to its outline, or to \
    the base circle with model.inertia = \"base-circle\", without web, shaft or coupling. The field \
    inertia of a gear gives the moment of inertia of all that turns with it.";

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "inertia_driver",
        symbol: "J_1",
        label: "inertia of driver",
        unit: "kg m2",
        shown: "kg mm2",
        digits: 5,
        equation: "∫r² dm",
        stage: Masses,
        value: |s| Some(s.kept.masses.inertias[0].moment),
        meaning: "The moment of inertia of the driver about its axis.",
        formula: Cases(&[
            (driver_inertia_given, Given("driver.inertia")),
            (always, Made(|k| inertia(k, 0))),
        ]),
        source: "Method paper: Zhou & Chen 2014, Eq. 47. Outline: ∫r² dm over the section that the \
            rack cuts, involute and fillet.",
        corrections: &["Eq. 47"],
        assumptions: BODY,
        checks: &[checks::bodies],
        ..PLAIN
    },
    Quantity {
        key: "inertia_driven",
        symbol: "J_2",
        label: "inertia of driven gear",
        unit: "kg m2",
        shown: "kg mm2",
        digits: 5,
        equation: "∫r² dm",
        stage: Masses,
        value: |s| Some(s.kept.masses.inertias[1].moment),
        meaning: "The moment of inertia of the driven gear about its axis.",
        formula: Cases(&[
            (driven_inertia_given, Given("driven.inertia")),
            (always, Made(|k| inertia(k, 1))),
        ]),
        source: "Method paper: Zhou & Chen 2014, Eq. 47. Outline: ∫r² dm over the section that the \
            rack cuts, involute and fillet.",
        corrections: &["Eq. 47"],
        assumptions: BODY,
        checks: &[checks::bodies],
        ..PLAIN
    },
    Quantity {
        key: "reduced_mass",
        symbol: "m_red",
        label: "reduced mass",
        unit: "kg",
        shown: "kg",
        digits: 5,
        equation: "Eq. 33",
        stage: Masses,
        value: |s| Some(s.reduced_mass),
        meaning: "The masses of both gears on the line of action, combined in series. Eqs. 31 and \
            32 use it. The impact force uses the effective mass at D.",
        formula: Text("m_1 m_2/(m_1 + m_2)"),
        source: "Zhou & Chen 2014, Eqs. 33 and 46.",
        corrections: &["Eq. 33, Eq. 50", "Eq. 46"],
        assumptions: BODY,
        checks: &[checks::bodies],
        ..PLAIN
    },
    Quantity {
        key: "effective_mass",
        symbol: "M",
        label: "effective mass at D",
        unit: "kg",
        shown: "kg",
        digits: 5,
        equation: "Eq. 50",
        stage: Impact,
        value: |s| Some(s.impact?.effective_mass),
        meaning: "The masses of both gears combined along the contact normal at D: the reduced \
            mass, with r_b2' instead of r_b2 as the lever arm of the driven gear.",
        formula: Text("m_1 m_2/(m_1 (r_b2'/r_b2)² + m_2)"),
        source: "Zhou & Chen 2014, Eq. 50: J_1 J_2/(J_1 r_b2'² + J_2 r_b1²).",
        corrections: &["Eq. 33, Eq. 50", "Eq. 46"],
        assumptions: BODY,
        checks: &[checks::bodies],
        ..PLAIN
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
        value: |s| Some(s.impact?.hertz_half_width()),
        meaning: "Half the width of the contact area of tip and flank under the impact force.",
        formula: Text("√(4 F_S ρ_S/(π b E'))"),
        source: "Hertz 1882, two cylinders. Zhou & Chen 2014 do not define a in Eq. 55.",
        corrections: &["Eq. 55"],
        assumptions: "Smooth cylinders of the reduced radius at D over the full width.",
        checks: &[checks::contact_small, checks::edge],
        ..PLAIN
    },
    Quantity {
        key: "impact_energy",
        symbol: "E_k",
        label: "impact energy",
        unit: "J",
        shown: "J",
        digits: 5,
        equation: "Eq. 50",
        stage: Impact,
        value: |s| Some(s.impact?.energy),
        meaning: "The kinetic energy of the approach at D, over the whole width. The teeth absorb \
            it and return it.",
        formula: Text("M ΔV_n²/2"),
        source: "Zhou & Chen 2014, Eq. 50.",
        corrections: &["Eq. 46", "Eq. 33, Eq. 50"],
        assumptions: "The gears approach at their steady speeds.",
        checks: &[checks::gap_closed],
        ..PLAIN
    },
    Quantity {
        key: "sliding_energy",
        symbol: "W_f",
        label: "sliding energy",
        unit: "J",
        shown: "J",
        digits: 5,
        equation: "Eq. 51",
        stage: Impact,
        value: |s| Some(s.impact?.sliding_energy),
        meaning: "The energy of the sliding at D by Eq. 51, over the whole width. Friction can \
            absorb only a part of it: see stick_limit.",
        formula: Text("M ΔV_τ²/2"),
        source: "Zhou & Chen 2014, Eq. 51.",
        corrections: &["Eq. 46", "Eq. 33, Eq. 50"],
        assumptions: "The effective mass along the normal also applies to the sliding, as printed.",
        checks: &[checks::gap_closed, checks::keeps_sliding],
        ..PLAIN
    },
];

/// Formula of the moment of inertia of a gear without a given inertia.
fn inertia(k: &Context, gear: usize) -> String {
    let n = gear + 1;
    let is_outline = [driver_outline, driven_outline][gear](k.inputs);
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
        |k| Some(1.0 / plane_strain_compliance(&k.inputs.elasticity())),
    ),
];
