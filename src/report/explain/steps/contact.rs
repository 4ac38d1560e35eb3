//! Steps of the first contact: the pair ahead under load, the angles and radii of the triangle O1 D
//! O2.

use super::{step, told};
use crate::model::compliance::{ContactPlace, Teeth, contact, pair_at_load};
use crate::report::explain::context::Formula::{By, Text, Words};
use crate::report::explain::context::{Known, Step};

/// How many pairs ahead of the incoming one are named.
pub(in crate::report::explain) const PAIRS_AHEAD: [&str; 4] = ["q_F", "q_F,2", "q_F,3", "q_F,4"];

#[rustfmt::skip]
pub(super) static STEPS: &[Step] = &[
    step!("q_F", "compliance of the pair at F, one base pitch after E", "um mm/N", Text("q_1F + q_2F + q_HF"), |k| ahead(k, 1)),
    step!("q_1F", "driver's tooth of that pair, loaded at O1F", "um mm/N", Words("the tooth compliance at that radius"), |k| Some(teeth_ahead(k)?.0)),
    step!("q_2F", "driven tooth of that pair, loaded at O2F", "um mm/N", Words("the tooth compliance at that radius"), |k| Some(teeth_ahead(k)?.1)),
    step!("q_HF", "contact of that pair under F_0", "um mm/N", Words("the contact compliance at that load"), contact_ahead),
    step!("q_F,2", "compliance of the pair two base pitches after E", "um mm/N", Words("as of the pair at F"), |k| ahead(k, 2)),
    step!("q_F,3", "compliance of the pair three base pitches after E", "um mm/N", Words("as of the pair at F"), |k| ahead(k, 3)),
    step!("q_F,4", "compliance of the pair four base pitches after E", "um mm/N", Words("as of the pair at F"), |k| ahead(k, 4)),
    told!("ε_e", "driver's turn by the equivalent error, Eqs. 13-15", "deg", Text("atan2(r_b1 Δf, r_b1² + N1E (N1E - Δf))")),
    told!("ε_d", "driver's turn by the deflection, Eqs. 17-19", "deg", Text("atan2(r_b1 δ, r_b1² + (N1F - Δ) (N1F - Δf))")),
    step!("η", "angle at O2 from the centre line to the tip at D, Eq. 10", "deg", Text("γ_2 + u"), |k| Some(k.solution.position?.contact.polar_angle)),
    step!("ρ_1", "driver's radius of curvature at D, N1'D", "mm", Text("√(O1D² - r_b1²)"), |k| Some(k.solution.position?.contact.curvature_driver)),
    step!("Δρ_1", "growth of ρ_1 since E", "mm", Text("ρ_1 - N1E"), |k| Some(k.solution.position?.contact.curvature_growth)),
    told!("ψ", "angle D O1 P", "deg", Text("atan2(r_a2 sin η, a - r_a2 cos η)")),
    told!("β_1", "angle D O1 N1'", "deg", Text("atan2(ρ_1, r_b1)")),
    step!("χ", "angle of the contact normal at D, α_w at E", "deg", Text("ψ + β_1"), |k| Some(k.solution.geometry.working_pressure_angle + k.solution.position?.contact.normal_turn)),
    step!("Δχ", "turn of the contact normal since E", "deg", Text("χ - α_w"), |k| Some(k.solution.position?.contact.normal_turn)),
    step!("N2'D", "from the driven gear's foot on the contact normal to D", "mm", Text("a sin χ - ρ_1"), |k| Some(k.solution.position?.contact.normal_length_driven)),
    step!("ρ_2", "driven flank's radius of curvature at its tip", "mm", By(|k| Text(if k.inputs.driven.tip_radius.is_some() { "re2" } else { "N2E" })),
        |k| Some(k.inputs.driven.tip_radius.unwrap_or(k.solution.geometry.driven.tip_curvature))),
];

/// The point of the line of action so many base pitches after E, where a pair stands there.
fn place(known: &Known, pitches: u32) -> Option<ContactPlace> {
    let geometry = &known.solution.geometry;
    let along = (0..pitches).fold(geometry.start, |along, _| along + geometry.base_pitch);
    let before_end = along <= geometry.end && along < geometry.tangent_length;
    before_end.then(|| ContactPlace::on_line_of_action(geometry, along))
}

/// Compliance of the pair so many base pitches after E, under the mesh force.
fn ahead(known: &Known, pitches: u32) -> Option<f64> {
    let solution = known.solution;
    pair_at_load(
        &known.inputs.elasticity(),
        &solution.geometry,
        &place(known, pitches)?,
        solution.mesh_force,
    )
    .ok()
}

fn teeth_ahead(known: &Known) -> Option<(f64, f64)> {
    let elasticity = known.inputs.elasticity();
    let teeth = Teeth::of(&elasticity, &known.solution.geometry).ok()?;
    let teeth = teeth.at(&place(known, 1)?).ok()?;
    Some((teeth.driver, teeth.driven))
}

fn contact_ahead(known: &Known) -> Option<f64> {
    let solution = known.solution;
    contact::spring(
        &known.inputs.elasticity(),
        &solution.geometry,
        &place(known, 1)?,
    )
    .ok()?
    .compliance(solution.mesh_force)
    .ok()
}
