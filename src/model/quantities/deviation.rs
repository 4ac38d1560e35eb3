//! Rows of the deviations that make a tooth early.

use super::conditions::{
    always, any_base_pitch, at_rest, deflection_used, driven_graded, driven_pitch_given,
    driver_graded, driver_pitch_given, in_motion, paper, shared_load,
};
use super::deflection::deflection;
use super::{PLAIN, Quantity, Variant, checks};
use crate::model::Context;
use crate::model::Stage::{Clearing, Deviation};
use crate::model::explanation::Formula::{Cases, Difference, Found, Given, Made, Text, Words};
use crate::model::explanation::{Step, step};
use crate::model::inputs::{Combination, Method};

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "equivalent_error",
        symbol: "Δf",
        label: "equivalent error",
        unit: "m",
        shown: "um",
        digits: 5,
        equation: "Eq. 1",
        stage: Deviation,
        value: |s| Some(s.deviation.equivalent_error),
        meaning: "The distance along the line of action by which the deviations of both gears \
            bring the incoming tooth into contact early. Relief reduces it by its full amount.",
        formula: Cases(&[
            (any_base_pitch, Made(own_error)),
            (paper, Difference("(2 f_pb + e_m - j_bn)/√2")),
            (shared_load, Text("2 f_pb/√2")),
            (always, Difference("2 f_pb/√2 + e_m")),
        ]),
        source: "Zhou & Chen 2014, Eqs. 1 and 2.",
        corrections: &["Eq. 1"],
        assumptions: "Deviations of which only the size is known are independent and add as \
            squares, hence the factor 1/√2; with combination sum they add with their signs. The \
            relief acts with its full amount at the tip, where first contact occurs. A backlash \
            does not delay a drive flank under load.",
        variants: &[
            Variant::words(
                shared_load,
                "The distance along the line of action by which the deviations of both gears \
                    bring the incoming tooth into contact early, without the reliefs. In this \
                    method the reliefs act on the flanks over their length. Method exact calls \
                    the sum of this distance and e_m Δf.",
                "Deviations of which only the size is known are independent and add as squares, \
                    hence the factor 1/√2; with combination sum they add with their signs. The \
                    reliefs are not included. A backlash does not delay a drive flank under load.",
            ),
            Variant::words(
                paper,
                "The distance along the line of action by which the deviations of both gears \
                    bring the incoming tooth into contact early. Relief reduces it by 1/√2 of its \
                    amount, as printed.",
                "The f_pb of both gears, j_bn and e_m are independent random deviations, which \
                    add as squares: hence the factor 1/√2. A ground relief is not random: method \
                    exact counts its full amount.",
            ),
        ],
        is_signed: true,
        ..PLAIN
    },
    Quantity {
        key: "modification",
        symbol: "e_m",
        label: "modification at run-in",
        unit: "m",
        shown: "um",
        digits: 5,
        equation: "Eq. 1",
        stage: Deviation,
        value: |s| Some(s.deviation.modification),
        meaning: "The material that the reliefs remove where the incoming tooth first touches: \
            the tip relief of the driven gear and the root relief of the driver, as a negative \
            number. Δf and Δ include its full amount.",
        formula: Text("-(Ca2 + Cf1)"),
        source: "Zhou & Chen 2014, Eqs. 1 and 2.",
        corrections: &["Eq. 1"],
        assumptions: "Both reliefs have their full amount at the first contact, whatever their \
            length.",
        variants: &[
            Variant::words(
                shared_load,
                "The material that the reliefs remove where tip and root meet: the tip relief of \
                    the driven gear and the root relief of the driver, as a negative number. Only \
                    Δ includes it. The forces of this method follow the reliefs on the flanks, \
                    with their length and shape.",
                "Both reliefs have their full amount where the driven tip meets the driver's \
                    flank.",
            ),
            Variant::meaning(
                paper,
                "The material that the reliefs remove where tip and root meet: the tip relief of \
                    the driven gear and the root relief of the driver, as a negative number. Δf \
                    includes 1/√2 of it, as printed.",
            ),
        ],
        is_signed: true,
        ..PLAIN
    },
    Quantity {
        key: "combined_deflection",
        symbol: "δ",
        label: "combined deflection",
        unit: "m",
        shown: "um",
        digits: 5,
        equation: "Eq. 3",
        stage: Deviation,
        value: |s| Some(s.deviation.combined_deflection),
        meaning: "The deflection along the line of action of the pairs that carry the load when \
            the incoming pair is at E.",
        formula: Cases(&[(deflection_used, Given("model.deflection")), (always, Made(deflection))]),
        source: "Zhou & Chen 2014, Eqs. 3 and 4, with the compliances of Eqs. 54-56 instead of \
            the curve in Fig. 3. Table 1 uses 24.7 um from reference 20 of the paper.",
        corrections: &["Eq. 55", "Eq. 56"],
        assumptions: "Teeth and contacts deflect under the mesh force at rest and share the \
            force. With finite-element compliance, the force on a tooth also displaces the \
            incoming pair, which reduces its lead. In the other models and in method paper, each \
            pair deflects alone. Shafts, bearings and housing are rigid.",
        checks: &[checks::contact_ratio, checks::teeth_of_deflection],
        variants: &[
            Variant::meaning(
                in_motion,
                "The deflection at rest along the line of action of the pairs that carry the load \
                    when the incoming pair is at E. In motion the mesh oscillates about this \
                    deflection. The method ignores a deflection that the case gives.",
            ),
            Variant::meaning(
                shared_load,
                "The deflection along the line of action of the pairs that carry the load when \
                    the incoming pair is at E, on flanks without relief. The method ignores a \
                    deflection that the case gives.",
            ),
            Variant::words(
                deflection_used,
                "The deflection along the line of action of the pairs that carry the load when \
                    the incoming pair is at E. The case gives it, and the load does not change \
                    it.",
                "The given deflection belongs to the load of the case. The program does not \
                    compare the two.",
            ),
        ],
        ..PLAIN
    },
    Quantity {
        key: "total_deviation",
        symbol: "Δ",
        label: "total deviation",
        unit: "m",
        shown: "um",
        digits: 5,
        equation: "Eq. 5",
        stage: Deviation,
        value: |s| Some(s.deviation.total),
        meaning: "The total distance by which the incoming tooth is early. Above 0 the tip \
            strikes before E. At 0 or below there is no contact before E.",
        formula: Cases(&[
            (shared_load, Difference("Δf_0 + e_m + δ")),
            (always, Difference("Δf + δ")),
        ]),
        source: "Zhou & Chen 2014, Eq. 5.",
        corrections: &["Eq. 1"],
        assumptions: "Deviations and deflection add up along the line of action.",
        checks: &[checks::pair_ahead],
        variants: &[
            Variant::words(
                in_motion,
                "The total distance by which the incoming tooth is early at rest. In motion the \
                    mesh oscillates, so the tooth may touch before E whether Δ is positive or \
                    negative; see dynamic_first_contact_angle.",
                "Deviations and deflection add up along the line of action. The gears are at \
                    rest, and the pairs ahead are on flanks without relief.",
            ),
            Variant::words(
                shared_load,
                "The total distance by which the incoming tooth is early if the pairs ahead are \
                    on flanks without relief. Above 0 it touches before E, at 0 or below it does \
                    not. The balance of all pairs decides: static_first_contact_angle has the \
                    answer.",
                "Deviations and deflection add up along the line of action. The pairs ahead are \
                    on flanks without relief.",
            ),
            Variant::meaning(
                paper,
                "The total distance by which the incoming tooth is early. At 0 or below there is \
                    no contact before E. Above 0 the tip strikes if the printed equations give an \
                    angle before E.",
            ),
        ],
        is_signed: true,
        ..PLAIN
    },
    Quantity {
        key: "clearing_relief",
        symbol: "ΔC_a2",
        label: "additional tip relief",
        unit: "m",
        shown: "um",
        digits: 5,
        equation: "no contact before E",
        stage: Clearing,
        value: |s| s.clearing?.relief,
        meaning: "The required additional tip relief of the driven gear: the smallest increase \
            with which the chosen method finds no contact before E.",
        formula: Cases(&[
            (
                paper,
                Words("the root C of u(Δf - C/√2) = 0, u by Eqs. 11-20 as printed; at most √2 Δ"),
            ),
            (
                at_rest,
                Found(
                    "the root C of max(x - gap) = 0 up to E: x is the lead of the driver by the \
                        balance Σ w_k F_k = F_0 of the other pairs; every pair has the additional \
                        tip relief C",
                    &["F_0", "k_m", "Δf_0", "Δ"],
                ),
            ),
            (
                in_motion,
                Found(
                    "the root C of max(x - gap) = 0 up to E: x is the lead of the driver in the \
                        motion m_red x'' + c x' + Σ w_k F_k = F_0 without a force on the incoming \
                        tooth; every pair has the additional tip relief C",
                    &["m_red", "c", "f_n", "f_z", "Δf_0", "Δ"],
                ),
            ),
            (always, Text("Δ")),
        ]),
        source: "Zhou & Chen 2014, Eq. 5: the condition Δ <= 0. Methods static and dynamic apply \
            the same condition, no contact before E, to the displacement of every pair.",
        corrections: &["Eq. 1", "Eqs. 7-20"],
        assumptions: "Every tooth of the driven gear has the additional relief, with the length \
            and shape of its tip relief. With method dynamic, the search also tests 4 larger \
            reliefs, up to twice this relief (50 if contact is lost), and finds no contact before \
            E.",
        checks: &[checks::contact_kept],
        ..PLAIN
    },
];

/// Δf of gears with their own base pitch deviations, or of known deviations.
fn own_error(k: &Context) -> String {
    let [driver, driven] = k.inputs.base_pitches();
    let error = match k.inputs.effective_combination() {
        Combination::Sum => "f_pb1 + f_pb2",
        Combination::Independent if driver + driven < 0.0 => "-√(f_pb1² + f_pb2²)",
        Combination::Independent => "√(f_pb1² + f_pb2²)",
    };
    match k.solution.method {
        Method::Paper => format!("{error} + (e_m - j_bn)/√2"),
        method if method.shares_load() => error.to_owned(),
        _ => format!("{error} + e_m"),
    }
}

pub(super) const STEPS: &[Step] = &[
    step(
        "f_pT1",
        "single pitch deviation of the driver's flank tolerance class, rounded by ISO 1328-1",
        "um",
        Words("(0.001 d + 0.4 m + 5) 2^((A1 - 5)/2) um, d and m in mm"),
        |k| k.inputs.graded_pitch(&k.inputs.driver),
    ),
    step(
        "f_pT2",
        "single pitch deviation of the driven gear's flank tolerance class, rounded by ISO 1328-1",
        "um",
        Words("(0.001 d + 0.4 m + 5) 2^((A2 - 5)/2) um, d and m in mm"),
        |k| k.inputs.graded_pitch(&k.inputs.driven),
    ),
    step(
        "f_pb1",
        "base pitch deviation of the driver",
        "um",
        Cases(&[
            (driver_pitch_given, Given("driver.base_pitch")),
            (driver_graded, Text("f_pT1 cos α")),
            (always, Text("f_pb")),
        ]),
        |k| Some(k.inputs.base_pitches()[0]),
    ),
    step(
        "f_pb2",
        "base pitch deviation of the driven gear",
        "um",
        Cases(&[
            (driven_pitch_given, Given("driven.base_pitch")),
            (driven_graded, Text("f_pT2 cos α")),
            (always, Text("f_pb")),
        ]),
        |k| Some(k.inputs.base_pitches()[1]),
    ),
];
