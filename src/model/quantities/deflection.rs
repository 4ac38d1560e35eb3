//! The formula of the deflection of the pairs ahead, and its steps.

use crate::model::Context;
use crate::model::compliance::{ContactPlace, Teeth};
use crate::model::explanation::Formula::{Made, Text, Words};
use crate::model::explanation::{Step, step};

/// The deflection, in two parts if the pairs ahead displace the incoming pair.
pub(super) fn deflection(k: &Context) -> String {
    if is_coupled(k) { "δ_F - δ_E".to_owned() } else { shared(k) }
}

fn is_coupled(k: &Context) -> bool {
    k.solution.deviation.neighbour_deflection != 0.0
}

/// The deflection of the pairs ahead.
fn ahead_alone(k: &Context) -> String {
    if place(k, 2).is_some() {
        "the displacement at which the forces of the pairs ahead add up to F_0".to_owned()
    } else {
        shared(k)
    }
}

/// The displacement of the incoming pair by the pairs ahead.
fn displaced(k: &Context) -> String {
    if place(k, 2).is_some() {
        "q_EF F/b of the pair at F and the same of the pairs further on".to_owned()
    } else {
        "F_0 q_EF/b".to_owned()
    }
}

/// Displacement of the incoming pair at E by a unit force on the pair at F.
fn coupling_at_start(k: &Context) -> Option<f64> {
    let elasticity = k.inputs.elasticity();
    let teeth = Teeth::of(&elasticity, &k.solution.geometry).ok()?;
    let place = |pitches| Some(teeth.under(&place(k, pitches)?, k.solution.mesh_force));
    teeth.coupling(&place(0)?, &place(1)?, 1).ok()
}

/// Eqs. 3 and 4 with the number of loaded pairs.
fn shared(k: &Context) -> String {
    let pairs: Vec<String> = STEPS
        .iter()
        .filter(|step| step.symbol == "q_F" || step.symbol.starts_with("q_F,"))
        .filter(|step| (step.value)(k).is_some())
        .map(|step| format!("1/{}", step.symbol))
        .collect();
    match pairs.len() {
        0 | 1 => "F_0 q_F/b".to_owned(),
        _ => format!("F_0/(b ({}))", pairs.join(" + ")),
    }
}

/// The point of the line of action `pitches` base pitches after E. `None` without a pair in contact
/// there.
fn place(k: &Context, pitches: u32) -> Option<ContactPlace> {
    let geometry = &k.solution.geometry;
    let along = (0..pitches).fold(geometry.start, |along, _| along + geometry.base_pitch);
    let before_end = along <= geometry.end && along < geometry.tangent_length;
    before_end.then(|| ContactPlace::on_line_of_action(geometry, along))
}

/// Compliance of the pair `pitches` base pitches after E, under the mesh force.
fn ahead(k: &Context, pitches: u32) -> Option<f64> {
    let solution = k.solution;
    let elasticity = k.inputs.elasticity();
    let teeth = Teeth::of(&elasticity, &solution.geometry).ok()?;
    teeth.pair_at_load(&place(k, pitches)?, solution.mesh_force).ok()
}

fn teeth_ahead(k: &Context) -> Option<[f64; 2]> {
    let elasticity = k.inputs.elasticity();
    let teeth = Teeth::of(&elasticity, &k.solution.geometry).ok()?;
    let place = teeth.under(&place(k, 1)?, k.solution.mesh_force);
    let teeth = teeth.at(&place).ok()?;
    Some([teeth.driver, teeth.driven])
}

fn contact_ahead(k: &Context) -> Option<f64> {
    let elasticity = k.inputs.elasticity();
    let teeth = Teeth::of(&elasticity, &k.solution.geometry).ok()?;
    let place = teeth.under(&place(k, 1)?, k.solution.mesh_force);
    let spring = teeth.spring(&place).ok()?;
    spring.compliance(k.solution.mesh_force).ok()
}

pub(super) const STEPS: &[Step] = &[
    step("δ_F", "deflection of the pairs ahead under F_0", "um", Made(ahead_alone), |k| {
        is_coupled(k).then(|| k.solution.deviation.loaded_deflection())
    }),
    step(
        "δ_E",
        "displacement of the incoming pair at E by the force on the pairs ahead",
        "um",
        Made(displaced),
        |k| is_coupled(k).then_some(k.solution.deviation.neighbour_deflection),
    ),
    step(
        "q_EF",
        "displacement of the incoming pair at E by a unit force on the pair at F",
        "um mm/N",
        Words("from the finite elements of both gears, teeth one pitch apart"),
        |k| coupling_at_start(k).filter(|_| is_coupled(k)),
    ),
    step(
        "q_F",
        "compliance of the pair at F, one base pitch after E",
        "um mm/N",
        Text("q_1F + q_2F + q_HF"),
        |k| ahead(k, 1),
    ),
    step(
        "q_1F",
        "driver's tooth of that pair, loaded at O1F",
        "um mm/N",
        Words("the tooth compliance at that radius"),
        |k| Some(teeth_ahead(k)?[0]),
    ),
    step(
        "q_2F",
        "driven tooth of that pair, loaded at O2F",
        "um mm/N",
        Words("the tooth compliance at that radius"),
        |k| Some(teeth_ahead(k)?[1]),
    ),
    step(
        "q_HF",
        "contact of that pair under F_0",
        "um mm/N",
        Words("the contact compliance at that load"),
        contact_ahead,
    ),
    step(
        "q_F,2",
        "compliance of the pair two base pitches after E",
        "um mm/N",
        Words("computed as for the pair at F"),
        |k| ahead(k, 2),
    ),
    step(
        "q_F,3",
        "compliance of the pair three base pitches after E",
        "um mm/N",
        Words("computed as for the pair at F"),
        |k| ahead(k, 3),
    ),
    step(
        "q_F,4",
        "compliance of the pair four base pitches after E",
        "um mm/N",
        Words("computed as for the pair at F"),
        |k| ahead(k, 4),
    ),
];
