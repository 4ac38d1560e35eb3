//! Steps of the load that every pair shares: stiffness, gap and displacement at E and at the first
//! contact, and the swing.

use super::{step, told};
use crate::model::compliance::{ContactPlace, pair_at_load};
use crate::model::position::{gap, tip_at};
use crate::model::relief::Relief;
use crate::model::static_load::balance;
use crate::model::tip_gap::TipContact;
use crate::numeric::quadrature;
use crate::report::explain::context::Formula::{Text, Words};
use crate::report::explain::context::{Known, Step};

#[rustfmt::skip]
pub(super) static STEPS: &[Step] = &[
    step!("k_p", "mean stiffness b/q of one pair from E to B, contact under F_0", "N/m", Words("by quadrature"), mean_stiffness),
    told!("k_E", "stiffness of the incoming pair at E", "N/m", Text("b/q_E")),
    step!("q_E", "compliance of the incoming pair at E, contact under F_0", "um mm/N", Words("the tip on the flank, Eqs. 54-56"), |k| {
        let geometry = &k.solution.geometry;
        let place = ContactPlace::at_tip(k.inputs.driven.tip_radius, geometry, &tip_at(geometry, 0.0));
        pair_at_load(&k.inputs.elasticity(), geometry, &place, k.solution.mesh_force).ok()
    }),
    step!("x_E", "how far the driver runs ahead while the tooth stands at E", "um", Words("from ΣF = F_0 of all pairs"),
        |k| Some(balance(k.solution.mesh.as_deref()?, 0.0, 0.0).displacement)),
    step!("C_E", "relief of both flanks there", "um", Words("by length and shape of the reliefs"), |k| Some(relief(k, &tip_at(&k.solution.geometry, 0.0)))),
    step!("S_s", "gap S(u) between tip and flank at the first contact", "um", Words("as S(u) on closed_gap's page, at u_st"), |k| {
        let tip = first_contact(k)?;
        Some(gap(&k.solution.geometry, &tip))
    }),
    step!("C_s", "relief of both flanks there", "um", Words("by length and shape of the reliefs"), |k| Some(relief(k, &first_contact(k)?))),
    step!("x_s", "how far the other pairs let the driver run ahead there", "um", Words("from ΣF = F_0 of the other pairs"),
        |k| {
            let s = -first_contact(k)?.angle * k.solution.geometry.driven.base;
            Some(balance(k.solution.mesh.as_deref()?, s, s).displacement)
        }),
    told!("f_n", "natural frequency of the mesh at its mean stiffness", "Hz", Text("√(k_m/m_red)/(2 π)")),
    told!("f_z", "tooth frequency", "Hz", Text("z1 ω_1/(2 π)")),
    told!("c", "damping of the mesh, while a pair is in contact", "N s/m", Text("2 ζ √(k_m m_red)")),
];

fn first_contact(known: &Known) -> Option<TipContact> {
    let angle = known.solution.static_load.as_ref()?.first_contact_angle?;
    Some(tip_at(&known.solution.geometry, angle))
}

/// What both flanks lack where the driven tip stands.
fn relief(known: &Known, tip: &TipContact) -> f64 {
    let geometry = &known.solution.geometry;
    Relief::of(&known.inputs.reliefs(), geometry)
        .at(tip.curvature_driver, geometry.driven.tip_curvature)
}

fn mean_stiffness(known: &Known) -> Option<f64> {
    const TOLERANCE: f64 = 1e-12;
    let (inputs, geometry) = (known.inputs, &known.solution.geometry);
    known.solution.mesh.as_ref()?;
    let stiffness = |part: f64| {
        let along = geometry.start + part * (geometry.end - geometry.start);
        let place = ContactPlace::on_line_of_action(geometry, along);
        let compliance = pair_at_load(
            &inputs.elasticity(),
            geometry,
            &place,
            known.solution.mesh_force,
        );
        inputs.common_width() / compliance.unwrap_or(f64::NAN)
    };
    Some(quadrature::adaptive(0.0, 1.0, TOLERANCE, stiffness))
}
