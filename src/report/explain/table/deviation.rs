//! Explanations of what brings the tooth in early.

use super::Explanation;
use crate::model::inputs::Method;
use crate::report::explain::context::Formula::{By, Found, Given, Made, Text, Words};
use crate::report::explain::context::Known;
use crate::report::explain::steps::contact::PAIRS_AHEAD;
use crate::report::explain::valid::{impact, load, pair, stiffness};

pub(super) static TABLE: &[Explanation] = &[
    Explanation {
        key: "equivalent_error",
        says: "What the gears' own deviations bring the incoming tooth in early, along the line of action. Relief counts \
            against it, in full.",
        formula: By(|k| match k.solution.method {
            Method::Paper => Text("(2 f_pb + e_m - j_bn)/√2"),
            method if method.shares_load() => Text("(2 f_pb - j_bn)/√2"),
            _ => Text("(2 f_pb - j_bn)/√2 + e_m"),
        }),
        source: "Zhou & Chen 2014, Eqs. 1 and 2.",
        mended: &["Eq. 1"],
        assumes: "f_pb of both gears and j_bn are independent random deviations, which add as squares: 1/√2 stands for that. \
            The relief acts at the tip, where first contact is, in full.",
        valid: &[],
    },
    Explanation {
        key: "modification",
        says: "What the reliefs take off where the incoming tooth first touches: the driven gear's tip relief and the driver's root \
            relief, below 0. Δf and Δ count it in full.",
        formula: Text("-(Ca2 + Cf1)"),
        source: "Zhou & Chen 2014, Eqs. 1 and 2.",
        mended: &["Eq. 1"],
        assumes: "Both reliefs are there in full at the first contact, whatever their length.",
        valid: &[],
    },
    Explanation {
        key: "combined_deflection",
        says: "How far the pairs that carry the load give way along the line of action while the incoming pair stands at E.",
        formula: By(|k| {
            if k.inputs.deflection_taken().is_some() {
                Given("model.deflection")
            } else {
                Made(shared)
            }
        }),
        source: "Zhou & Chen 2014, Eqs. 3 and 4, with the compliances of Eqs. 54-56 in place of the curve in its Fig. 3; \
            Table 1 takes 24.7 um from its reference 20.",
        mended: &["Eq. 55", "Eq. 56"],
        assumes: "Teeth bend and flatten under the mesh force at rest, and share it as parallel springs; shafts, bearings and \
            housing are rigid.",
        valid: &[pair::contact_ratio, stiffness::teeth_of_deflection],
    },
    Explanation {
        key: "total_deviation",
        says: "What brings the tooth in early, in all. Above 0 the tip strikes before E; at 0 or below it comes in on time, and \
            there is no corner contact.",
        formula: By(|k| {
            Text(if k.inputs.method.shares_load() {
                "Δf_0 + e_m + δ"
            } else {
                "Δf + δ"
            })
        }),
        source: "Zhou & Chen 2014, Eq. 5.",
        mended: &["Eq. 1"],
        assumes: "Deviations and deflection add up along the line of action.",
        valid: &[impact::pair_ahead],
    },
    Explanation {
        key: "clearing_relief",
        says: "How much more tip relief of the driven gear it takes, beyond what it has, so that the incoming tooth does not touch \
            before E: by the method itself, at rest or in motion.",
        formula: By(|k| match k.solution.method {
            Method::Exact | Method::Auto => Text("Δ"),
            Method::Paper => Words(
                "the root C of u(Δf - C/√2) = 0, u by Eqs. 11-20 as printed: no more than √2 Δ",
            ),
            Method::Static => Found {
                words: "the root C of: the most by which the other pairs let the driver run ahead of the incoming tooth's gap up to E = 0, \
                    the gap with C more tip relief, x by Σ w_k F_k = F_0 with the same relief on every pair",
                with: &["F_0", "k_m", "Δf", "Δ"],
            },
            Method::Dynamic => Found {
                words: "the root C of: the most by which the driver runs ahead of the incoming tooth's gap up to E = 0 in the motion \
                    m_red x'' + c x' + Σ w_k F_k = F_0 with C more tip relief, in which the incoming tooth stands off",
                with: &["m_red", "c", "f_n", "f_z", "Δf", "Δ"],
            },
        }),
        source: "The condition of Zhou & Chen 2014, Δ <= 0 in Eq. 5; at rest and in motion the same condition on the displacement of \
            every pair.",
        mended: &["Eq. 1", "Eqs. 7-20"],
        assumes: "The relief is added to the tip relief of every tooth of the driven gear, its length and shape as they are. In motion the \
            tooth touches with a little less, and with none of the greater reliefs up to twice as much that were tried: 4 of them, \
            50 where contact is lost.",
        valid: &[load::kept],
    },
];

/// Eqs. 3 and 4 with as many pairs as carry the load.
fn shared(known: &Known) -> String {
    let pairs: Vec<&str> = PAIRS_AHEAD
        .into_iter()
        .filter(|symbol| known.term(symbol).is_some())
        .collect();
    match pairs[..] {
        [] | [_] => "F_0 q_F/b".to_owned(),
        _ => format!(
            "F_0/(b ({}))",
            pairs
                .iter()
                .map(|symbol| format!("1/{symbol}"))
                .collect::<Vec<_>>()
                .join(" + ")
        ),
    }
}
