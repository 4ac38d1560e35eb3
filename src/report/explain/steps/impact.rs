//! Steps of the impact: the compliance of the pair in contact at D, and the forces of the other
//! stiffness models.

use super::{step, told};
use crate::model::compliance::profile::{Profile, Rack};
use crate::model::compliance::{ContactPlace, contact};
use crate::model::explanation::{self, Context};
use crate::model::impact::HERTZ_PREFACTOR;
use crate::model::{self, Stage, Stages};
use crate::report::explain::context::Formula::{self, By, Text, Words};
use crate::report::explain::context::{Known, Step};
use crate::report::explain::models::models;

const BEAM: Formula = Words(
    "by quadrature of bending, shear and compression over the tooth's profile, and its foundation",
);

#[rustfmt::skip]
pub(super) static STEPS: &[Step] = &[
    told!("E'", "modulus of the two materials in plane strain", "GPa", Text("1/((1 - ν1²)/E1 + (1 - ν2²)/E2)")),
    step!("C_H", "what Eq. 32 lacks of Hertz's duration", "1", Text("2.868265699 π^(2/5)"), |_| Some(HERTZ_PREFACTOR)),
    step!("c_1", "A_0 + A_1 x of the driver", "N/(um mm)",
        Text("(3.867 + 1.612 z1 - 0.02916 z1² + 0.0001553 z1³ + (17.060 + 0.7289 z1 - 0.01728 z1² + 0.0000999 z1³) x1) [N/(um mm)]"),
        |k| fit(k, "c_1")),
    step!("d_1", "A_2 + A_3 x of the driver", "N/(um mm)",
        Text("(2.637 - 1.222 z1 + 0.02217 z1² - 0.0001179 z1³ + (-6.330 - 1.033 z1 + 0.02068 z1² - 0.0001130 z1³) x1) [N/(um mm)]"),
        |k| fit(k, "d_1")),
    step!("c_2", "A_0 + A_1 x of the driven gear", "N/(um mm)",
        Text("(3.867 + 1.612 z2 - 0.02916 z2² + 0.0001553 z2³ + (17.060 + 0.7289 z2 - 0.01728 z2² + 0.0000999 z2³) x2) [N/(um mm)]"),
        |k| fit(k, "c_2")),
    step!("d_2", "A_2 + A_3 x of the driven gear", "N/(um mm)",
        Text("(2.637 - 1.222 z2 + 0.02217 z2² - 0.0001179 z2³ + (-6.330 - 1.033 z2 + 0.02068 z2² - 0.0001130 z2³) x2) [N/(um mm)]"),
        |k| fit(k, "d_2")),
    step!("q_1", "driver's tooth, loaded at O1D", "um mm/N", By(|k| by_tooth_model(k, "1/(c_1 + d_1 (O1D - r_1)/((1 + x1) m))")),
        |k| Some(k.solution.compliance?.driver)),
    step!("q_2", "driven tooth, loaded at its tip", "um mm/N", By(|k| by_tooth_model(k, "1/(c_2 + d_2 (r_a2 - r_2)/((1 + x2) m))")),
        |k| Some(k.solution.compliance?.driven)),
    step!("q_H", "contact at the impact force", "um mm/N", By(|k| Text(match k.inputs.contact_compliance.name() {
        "logarithmic" => "(1.27 + 0.781 ln(m/a_H))/(π E')",
        "constant" => "2/(π E')",
        _ =>
            "(1 - ν1²)/(π E1) (2 ln(2 h_1/a_H) - ν1/(1 - ν1)) + (1 - ν2²)/(π E2) (2 ln(2 h_2/a_H) - ν2/(1 - ν2))",
    })), contact_compliance),
    step!("h_1", "from the driver's flank at O1D to its tooth's centre line, along the force", "mm", Words("from the tooth's profile"),
        |k| Some(Profile::of(&Rack::of(k.inputs, &k.inputs.driver), &k.solution.geometry.driver).depth_along_force(place(k)?.radius_driver))),
    step!("h_2", "from the driven tip to its tooth's centre line, along the force", "mm", Words("from the tooth's profile"),
        |k| Some(Profile::of(&Rack::of(k.inputs, &k.inputs.driven), &k.solution.geometry.driven).depth_along_force(place(k)?.radius_driven))),
    step!("F_fit,log", "by kuang-yang and logarithmic", "N", Words("a solve of its own"), |k| force_by(k, "F_fit,log")),
    step!("F_fit,const", "by kuang-yang and constant", "N", Words("a solve of its own"), |k| force_by(k, "F_fit,const")),
    step!("F_fit,weber", "by kuang-yang and weber", "N", Words("a solve of its own"), |k| force_by(k, "F_fit,weber")),
    step!("F_beam,log", "by beam and logarithmic", "N", Words("a solve of its own"), |k| force_by(k, "F_beam,log")),
    step!("F_beam,const", "by beam and constant", "N", Words("a solve of its own"), |k| force_by(k, "F_beam,const")),
    step!("F_beam,weber", "by beam and weber", "N", Words("a solve of its own"), |k| force_by(k, "F_beam,weber")),
];

fn fit(known: &Known, symbol: &str) -> Option<f64> {
    let context = Context {
        inputs: known.inputs,
        given: known.given,
        solution: known.solution,
    };
    let model = model::compliance::tooth::kuang_yang::MODEL;
    let steps: &[explanation::Step] = model.steps;
    let step = steps.iter().find(|step| step.symbol == symbol)?;
    (step.value)(&context)
}

fn by_tooth_model(known: &Known, fit: &'static str) -> Formula {
    match model::compliance::model_of(known.inputs).name() {
        "kuang-yang" => Text(fit),
        _ => BEAM,
    }
}

fn place(known: &Known) -> Option<ContactPlace> {
    Some(ContactPlace::at_tip(
        known.inputs.driven.tip_radius,
        &known.solution.geometry,
        &known.solution.position?.contact,
    ))
}

fn contact_compliance(known: &Known) -> Option<f64> {
    let spring = contact::spring(
        &known.inputs.elasticity(),
        &known.solution.geometry,
        &place(known)?,
    )
    .ok()?;
    spring.compliance(known.solution.impact?.force).ok()
}

/// The force by the models of a step, where they cover the pair.
fn force_by(known: &Known, symbol: &str) -> Option<f64> {
    let (_, inputs) = models(known.inputs).find(|(name, _)| *name == symbol)?;
    Some(
        model::solve(&inputs, Stages::of(Stage::Impact))
            .ok()?
            .impact?
            .force,
    )
}
