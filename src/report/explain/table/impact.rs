//! Explanations of the impact: force, energy, duration, and what they rest on.

use super::Explanation;
use crate::model::inputs::Method;
use crate::report::explain::context::Formula::{By, Made, Text};
use crate::report::explain::context::Known;
use crate::report::explain::models::models;
use crate::report::explain::valid::{impact, pair, position, stiffness};

const SPRING: &str = "The effective mass meets the pair at D as a mass meets a spring: no damping, no other pair in contact, and the \
    pair's place and stiffness held while it lasts.";
const BAND: &str = "The models in range are the beam, and the fit of Kuang and Yang where it covers the pair, each with three contact \
    formulas and its own deflection where the case gives none. They share the mass and the position, so that the band says \
    less than the 10 % that is honest.";

pub(super) static TABLE: &[Explanation] = &[
    Explanation {
        key: "impact_force",
        says: "The greatest force of the tip's impact on the driver's flank, over the whole width. q_s holds the contact under \
            this very force: the two are solved together.",
        formula: Text("ΔV_n √(b M/q_s)"),
        source: "Zhou & Chen 2014, Eqs. 50-57.",
        mended: &["Eq. 53", "Eq. 54", "Eq. 33, Eq. 50", "Table 1"],
        assumes: SPRING,
        valid: &[
            position::gap_closed,
            stiffness::teeth,
            stiffness::contact,
            impact::within_approach,
        ],
    },
    Explanation {
        key: "impact_force_low",
        says: "The impact force by the most compliant of the stiffness models that cover the pair.",
        formula: Made(|known| over_models(known, "min")),
        source: "Eq. 57 with every stiffness model in range: Eq. 56 or the beam, and Eq. 55, Yang & Sun 1985 or Weber & Banaschek 1953.",
        mended: &["Eq. 56"],
        assumes: BAND,
        valid: &[stiffness::teeth],
    },
    Explanation {
        key: "impact_force_high",
        says: "The impact force by the stiffest of the stiffness models that cover the pair.",
        formula: Made(|known| over_models(known, "max")),
        source: "Eq. 57 with every stiffness model in range: Eq. 56 or the beam, and Eq. 55, Yang & Sun 1985 or Weber & Banaschek 1953.",
        mended: &["Eq. 56"],
        assumes: BAND,
        valid: &[stiffness::teeth],
    },
    Explanation {
        key: "dynamic_factor",
        says: "The impact force in steady mesh forces.",
        formula: Text("F_S/F_0"),
        source: "Zhou & Chen 2014, section 6: the ratio F_S/F_0.",
        mended: &["section 6"],
        assumes: "The impact alone against the steady load alone: not the factor K_v of ISO 6336, which counts the whole mesh.",
        valid: &[position::gap_closed, impact::within_approach],
    },
    Explanation {
        key: "impact_duration",
        says: "How long the impact lasts, as the method has it.",
        formula: By(|k| match k.inputs.method {
            Method::Paper => Text("T_S,32"),
            _ => Text("T_S,q"),
        }),
        source: "Method paper: Zhou & Chen 2014, Eq. 32. Method exact: half a period of the spring and mass that give F_S.",
        mended: &["Eq. 32"],
        assumes: SPRING,
        valid: &[impact::within_approach, impact::possible],
    },
    Explanation {
        key: "impact_duration_printed",
        says: "The duration of Eq. 32 as it stands in print. Friction is worked out with it in both methods, as published.",
        formula: Text("(m_red²/(π² ΔV_n ρ_S E'²))^(1/5)"),
        source: "Zhou & Chen 2014, Eq. 32, after Hertz 1882.",
        mended: &["Eq. 32", "Eq. 33, Eq. 50"],
        assumes: "Two spheres striking: the teeth's bending has no part in it.",
        valid: &[impact::printed_shorter],
    },
    Explanation {
        key: "impact_duration_hertz",
        says: "Hertz's duration of two spheres, with the prefactor that Eq. 32 has lost.",
        formula: Text("C_H T_S,32"),
        source: "Hertz 1882: T = 2.868266 (M²/(ρ E'² ΔV_n))^(1/5), so that Eq. 32 lacks 2.868266 π^(2/5).",
        mended: &["Eq. 32"],
        assumes: "Two spheres striking: the teeth's bending has no part in it.",
        valid: &[],
    },
    Explanation {
        key: "impact_duration_spring",
        says: "Half a period of the effective mass on the pair's spring: the duration that belongs to the impact force.",
        formula: Text("π √(M q_s/b)"),
        source: "Free vibration of the mass and spring of Zhou & Chen 2014, Eqs. 50-57: π√(Mq/b).",
        mended: &["Eq. 32"],
        assumes: SPRING,
        valid: &[impact::within_approach, stiffness::teeth],
    },
    Explanation {
        key: "effective_mass",
        says: "Both gears as one mass along the contact normal at D: the reduced mass, with r_b2' in place of r_b2 for the \
            driven gear's arm.",
        formula: Text("m_1 m_2/(m_1 (r_b2'/r_b2)² + m_2)"),
        source: "Zhou & Chen 2014, Eq. 50: J_1 J_2/(J_1 r_b2'² + J_2 r_b1²).",
        mended: &["Eq. 33, Eq. 50", "Eq. 46", "Eq. 47"],
        assumes: "Each gear is a solid disc of its own width from the bore to the base circle, without web, shaft or coupling.",
        valid: &[pair::discs],
    },
    Explanation {
        key: "pair_compliance",
        says: "How far the pair in contact at D gives way along the contact normal, per force and width: two teeth and the contact.",
        formula: Text("q_1 + q_2 + q_H"),
        source: "Zhou & Chen 2014, Eqs. 54-56: teeth by Kuang & Yang 1992 or by the potential-energy method (Yang & Lin 1987, with \
            Sainsot, Velex & Duverger 2004), contact by Eq. 55 (Xiao & Tang 1995), Yang & Sun 1985 or Weber & Banaschek 1953.",
        mended: &["Eq. 54", "Eq. 55", "Eq. 56"],
        assumes: "Linear elastic teeth of one width; the contact is taken at the impact force.",
        valid: &[stiffness::teeth, stiffness::contact],
    },
    Explanation {
        key: "hertz_half_width",
        says: "Half the width of the band in which tip and flank touch under the impact force.",
        formula: Text("√(4 F_S ρ_S/(π b E'))"),
        source: "Hertz 1882, two cylinders. Zhou & Chen 2014 leave a in Eq. 55 undefined.",
        mended: &["Eq. 55"],
        assumes: "Smooth cylinders of the reduced radius at D, in full width.",
        valid: &[stiffness::contact, position::edge],
    },
    Explanation {
        key: "impact_energy",
        says: "Kinetic energy of the approach at D, over the whole width: what the teeth must take up and give back.",
        formula: Text("M ΔV_n²/2"),
        source: "Zhou & Chen 2014, Eq. 50.",
        mended: &["Eq. 46", "Eq. 33, Eq. 50"],
        assumes: "The gears approach at their steady speeds.",
        valid: &[position::gap_closed],
    },
    Explanation {
        key: "sliding_energy",
        says: "The energy that Eq. 51 gives the sliding at D, over the whole width. Friction can take only a part of it: see \
            stick_limit.",
        formula: Text("M ΔV_τ²/2"),
        source: "Zhou & Chen 2014, Eq. 51.",
        mended: &["Eq. 46", "Eq. 33, Eq. 50"],
        assumes: "The mass along the normal is taken for the sliding too, as printed.",
        valid: &[position::gap_closed, position::keeps_sliding],
    },
];

/// The least or the greatest of the case's own force and those of the models.
fn over_models(known: &Known, choice: &str) -> String {
    let forces = models(known.inputs)
        .map(|(symbol, _)| symbol)
        .filter(|symbol| known.term(symbol).is_some());
    format!(
        "{choice}({})",
        std::iter::once("F_S")
            .chain(forces)
            .collect::<Vec<_>>()
            .join(", ")
    )
}
