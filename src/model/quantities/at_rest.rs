//! Rows of the static load sharing.

use super::conditions::{always, friction_given, in_slices};
use super::{Need, PLAIN, Quantity, Variant, checks, of_driver};
use crate::model::Solution;
use crate::model::Stage::{Dynamic, Mesh, Static};
use crate::model::compliance::{ContactPlace, Teeth};
use crate::model::dynamic::Dynamic as Motion;
use crate::model::explanation::Formula::{
    self, Cases, Difference, Found, Made, Solved, Text, Words,
};
use crate::model::explanation::{Check, Context, Equation, Step, step};
use crate::model::inputs::Method;
use crate::model::position::TipContact;
use crate::model::position::{gap, tip_at};
use crate::model::relief::Relief;
use crate::model::static_load::StaticLoad;
use crate::numeric::quadrature;

const SPRINGS: &str = "Every pair is a spring b/q with a gap, and all pairs share the mesh force \
            at rest. With finite-element compliance the force on a pair displaces the \
            pairs up to three pitches away; in the other models each pair deflects \
            alone. Only the incoming pair has a deviation, e = Δf_0; all pairs have \
            their reliefs. The method ignores a deflection that the case gives.";
const BALANCE: &str = "Balance ΣF = F0 of springs with gaps, as in Seireg & Houser 1970, coupled \
            as in Conry & Seireg 1973, with the gap S(u) of the tips off the line of \
            action. Compliances of Zhou & Chen 2014, Eqs. 54-56, or by finite \
            elements.";
const SHARED: &[&str] = &["F_0", "k_m", "Δf_0"];
const CHECKS: &[Check] = &[checks::contact_ratio, checks::teeth, checks::at_rest];

/// A result of the static balance.
const AT_REST: Quantity = Quantity {
    equation: "ΣF = F0",
    stage: Static,
    source: BALANCE,
    assumptions: SPRINGS,
    checks: CHECKS,
    ..PLAIN
};

/// The first contact of a pair whose load varies over the face width.
pub(super) const FIRST_OF_SLICES: Variant = Variant::meaning(
    in_slices,
    " Over the face width it is the angle in the plane across the axis in which it touches first; below 0 \
        this is after E, and the tip can still strike in another plane.",
);

/// The driven gear's angle before E at the first contact, at rest or in motion.
pub(super) fn first_contact_of<const MOVES: bool>(solution: &Solution) -> Option<f64> {
    let (face, angle) = if MOVES {
        (&solution.face_motion, solution.dynamic.as_ref()?.first_contact_angle)
    } else {
        (&solution.face_load, solution.static_load.as_ref()?.first_contact_angle)
    };
    let of_face = face.as_ref().map(|face| -face.first.path / solution.geometry.driven.base);
    of_face.or(angle)
}

pub(super) const TABLE: &[Quantity] = &[
    PLAIN
        .row(
            ["mesh_stiffness", "k_m", "mean mesh stiffness"],
            ("N/m", "N/um", 5),
            |s| Some(s.mesh.as_ref()?.mean_stiffness()),
            "The mean stiffness of the mesh over a base pitch, of all pairs on the line \
            of action together and without deviations. It determines the natural \
            frequency, and the damping is a fraction of it.",
            Made(mean_of_pairs),
        )
        .equation("mean of b/q")
        .stage(Mesh)
        .source(
            "Mean of b/q of a pair over its path of contact, times the contact ratio; \
            with coupled pairs the mean of their force per displacement. Compliances \
            of Zhou & Chen 2014, Eqs. 54-56, or by finite elements. The mean mesh \
            stiffness of ISO 6336-1 is c_γα.",
        )
        .corrections(&["Eq. 55", "Eq. 56"])
        .assumptions(
            "The contact compliance is that under F_0, so the stiffness of a pair \
            depends on its place only.",
        )
        .checks(&[checks::teeth]),
    PLAIN
        .row(
            ["single_stiffness", "c'_q", "single stiffness"],
            ("N/m2", "N/(mm um)", 5),
            |s| Some(s.mesh.as_ref()?.single_stiffness() / s.mesh.as_ref()?.width),
            "The greatest stiffness of one pair per width between E and B, max 1/q, by \
            the compliance of the case. iso_single_stiffness is that of ISO 6336-1.",
            Words("the greatest 1/q of a pair from E to B, contact under F_0"),
        )
        .equation("max 1/q")
        .stage(Mesh)
        .source("Compliances of Zhou & Chen 2014, Eqs. 54-56, or by finite elements.")
        .assumptions("The pair is alone, and the contact compliance is that under F_0.")
        .checks(&[checks::teeth]),
    PLAIN
        .row(
            ["mesh_stiffness_per_width", "c_m", "mesh stiffness per width"],
            ("N/m2", "N/(mm um)", 5),
            |s| Some(s.mesh.as_ref()?.mean_stiffness() / s.mesh.as_ref()?.width),
            "The mean stiffness of the mesh per width, k_m/b, by the compliance of the \
            case. iso_mesh_stiffness is that of ISO 6336-1.",
            Text("k_m/b"),
        )
        .equation("k_m/b")
        .stage(Mesh)
        .source("Mean of b/q of a pair over its path of contact, see mesh_stiffness.")
        .assumptions("As for mesh_stiffness.")
        .checks(&[checks::teeth]),
    AT_REST
        .row(
            ["static_first_contact_angle_driver", "θ_st", "static: driver angle before E"],
            ("rad", "deg", 4),
            |s| Some(of_driver(s, first_contact_of::<false>(s)?)),
            "The angle of the driver before E at which the incoming tooth begins to \
                carry load at rest.",
            Text("i u_st"),
        )
        .signed()
        .variants(&[FIRST_OF_SLICES])
        .corrections(&["Eqs. 7-20"]),
    AT_REST
        .row(
            ["static_first_contact_angle", "u_st", "static: driven angle before E"],
            ("rad", "deg", 4),
            first_contact_of::<false>,
            "The angle of the driven gear before E at which the incoming tooth begins \
            to carry load at rest: its gap there equals the displacement by the other \
            pairs.",
            Cases(&[
                (in_slices, Found("-s_st/r_b2 where a slice first carries load", SHARED)),
                (always, Solved(&FIRST_CONTACT)),
            ]),
        )
        .signed()
        .variants(&[FIRST_OF_SLICES])
        .corrections(&["Eqs. 7-20"]),
    AT_REST
        .row(
            ["static_force_at_start", "F_st,E", "static: force before E"],
            ("N", "N", 5),
            |s| Some(s.static_load.as_ref()?.force_at_start),
            "The force at rest of the incoming tooth at the entry E, on its tip edge. A sufficient tip \
            relief reduces this force to 0. With a root relief of the driver the force can be greater \
            before E: entry_force_ratio and the verdict have the greatest one.",
            Cases(&[
                (in_slices, Found("the largest Σ w_k F_k of the slices before their E while slices pass E", SHARED)),
                (always, Difference("max(k_E (x_E + Δf_0 - C_E), 0)")),
            ]),
        )
        .variants(&[Variant::meaning(
            in_slices,
            " Each slice of the face reaches its E at another time: here this is the part of the force \
                on the tooth in slices before their E, at its largest from the first slice at E to the last. \
                The chart of the force shows the whole force on the tooth.",
        )])
        .corrections(&["Eq. 53", "Eq. 54"]),
    AT_REST
        .row(
            ["static_force_at_end", "F_st,B", "static: force after B"],
            ("N", "N", 5),
            |s| Some(s.static_load.as_ref()?.force_at_end),
            "The force at rest of the incoming tooth at the exit B, on the driver's tip edge; over the \
            face width the greatest force in slices after their B while slices pass B. A sufficient tip relief of the \
            driver reduces this force to 0.",
            Found("F_k of the tooth at B, with Σ w_k F_k = F_0", SHARED),
        )
        .corrections(&["Eq. 53", "Eq. 54"]),
    AT_REST
        .row(
            ["static_peak_force", "F_st,max", "static: peak force"],
            ("N", "N", 5),
            |s| Some(s.static_load.as_ref()?.peak_force),
            "The peak force on the incoming tooth at rest from its first contact to its \
            last. In single-tooth contact it carries the whole mesh force",
            Found(
                "the largest F_k of the tooth from its first contact to its last, F_k >= 0 \
            with x + e_k - S_k = Σ_j Q_kj F_j/b where F_k > 0, and Σ w_k F_k = F_0",
                SHARED,
            ),
        )
        .corrections(&["Eq. 53", "Eq. 54"])
        .variants(&[
            Variant::meaning(friction_given, " and the addition by friction."),
            Variant::meaning(always, "."),
        ]),
    AT_REST
        .row(
            ["static_last_contact_angle", "θ_st,B", "static: exit angle"],
            ("rad", "deg", 4),
            |s| s.static_load.as_ref()?.last_contact_angle,
            "The angle of the driver after B at which the incoming tooth no longer \
                carries load at rest: the corner contact at the exit, of the driver's tip \
                on the driven flank.",
            Found(
                "the angle after B at which the gap of the tooth equals the displacement by \
                the other pairs, with Σ w_k F_k = F_0",
                SHARED,
            ),
        )
        .at_exit(),
    AT_REST
        .row(
            ["static_transmission_error", "TE_st", "TE with deviations"],
            ("m", "um", 5),
            |s| Some(s.static_load.as_ref()?.transmission_error),
            "The difference between the largest and the smallest lead of the driver \
                while the tooth carries load, with the base pitch deviations of the case.",
            Found("max x - min x from the first contact to the last, x by Σ w_k F_k = F_0", SHARED),
        )
        .equation("max x − min x")
        .source(
            "Displacement x of the driver along the line of action, max x − min x, by \
            the balance ΣF = F0 of springs with gaps, as in Seireg & Houser 1970, \
            coupled as in Conry & Seireg 1973.",
        ),
    PLAIN
        .row(
            ["pitch_contact_jump", "ΔF_P", "jump at the pitch point"],
            ("N", "N", 4),
            |s| s.static_load.as_ref()?.pitch_jump,
            "The change of the sum of all pair forces where the incoming tooth passes \
                the pitch point. Friction drives the driver before the pitch point and \
                brakes it after.",
            PITCH_JUMP,
        )
        .equation("friction reverses")
        .stage(Static)
        .source(
            "Friction in the balance of the driver, ΣF = F0 with weights. Zhou & Chen \
                2014 name pitch corner contact in their introduction; friction reverses \
                there.",
        )
        .assumptions(SPRINGS)
        .checks(&[checks::at_rest])
        .signed()
        .needs(Need::Friction),
];

/// The force before E, by the method.
pub(super) const ENTRY_RATIO: Quantity = PLAIN
    .row(
        ["entry_force_ratio", "F_E/F_0", "entry force ratio"],
        ("1", "1", 4),
        |s| {
            Some(
                governing(s, |load| load.approach_force, |motion| motion.peak_approach_force)?
                    / s.mesh_force,
            )
        },
        "The greatest force before E, in the corner contact, over the mesh force. Method dynamic \
            uses the force in motion, method static that at rest.",
        Made(|k| by_method(k, ["F_st,DE/F_0", "F_d,DE/F_0"])),
    )
    .equation("by the method")
    .stage(Static)
    .also(Dynamic)
    .source("As for static_force_at_start or dynamic_peak_approach_force.")
    .assumptions("As for these forces.")
    .checks(&[checks::teeth]);

/// A name for the peak force in limits and conditions: that of the method. It is no row of the table.
pub(super) static PEAK_FORCE: Quantity = AT_REST
    .row(
        ["peak_force", "F_max", "peak force"],
        ("N", "N", 5),
        |s| governing(s, |load| load.peak_force, |motion| motion.peak_force),
        "The peak force on the incoming tooth. Method dynamic computes it in motion, method static at \
        rest.",
        Made(|k| by_method(k, ["F_st,max", "F_d,max"])),
    )
    .equation("by the method")
    .also(Dynamic)
    .counterparts("static_peak_force", "dynamic_peak_force");

/// A force in motion by the method `dynamic`, otherwise that at rest.
fn governing(
    solution: &Solution,
    at_rest: fn(&StaticLoad) -> f64,
    in_motion: fn(&Motion) -> f64,
) -> Option<f64> {
    match solution.method {
        Method::Dynamic => solution.dynamic.as_ref().map(in_motion),
        _ => solution.static_load.as_ref().map(at_rest),
    }
}

fn by_method(k: &Context, [at_rest, in_motion]: [&str; 2]) -> String {
    if k.solution.method == Method::Dynamic { in_motion } else { at_rest }.to_owned()
}

const PITCH_JUMP: Formula = Found(
    "Σ F_k just after the pitch point minus Σ F_k just before it, with Σ w_k \
            F_k = F_0 and w = 1 -+ μ ρ_1/r_b1",
    SHARED,
);

const FIRST_CONTACT: Equation = Equation {
    text: "gap of the incoming pair = displacement by the other pairs, S_st + C_st - \
            Δf_0 = x_st",
    left: Difference("S_st + C_st - Δf_0"),
    right: Text("x_st"),
    unit: "um",
    sides: |k| {
        let error = k.solution.deviation.equivalent_error;
        let open = gap_at_first(k)? + relief(k, &first_contact(k)?);
        Some([open - error, lead_at_first(k)?])
    },
};

fn first_contact(k: &Context) -> Option<TipContact> {
    let angle = k.solution.static_load.as_ref()?.first_contact_angle?;
    Some(tip_at(&k.solution.geometry, angle))
}

fn gap_at_first(k: &Context) -> Option<f64> {
    Some(gap(&k.solution.geometry, &first_contact(k)?))
}

fn lead_at_first(k: &Context) -> Option<f64> {
    lead(k, -first_contact(k)?.angle * k.solution.geometry.driven.base)
}

/// Displacement of the driver ahead with the incoming pair at `s`, minus the displacement of the
/// incoming pair by the forces on the other pairs.
fn lead(k: &Context, s: f64) -> Option<f64> {
    let mesh = k.solution.mesh.as_deref()?;
    let pairs = mesh.pair_set(s, s);
    let (displacement, forces) = pairs.shared(mesh.force);
    let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0)?;
    Some(displacement - pairs.pushed(incoming, &forces))
}

/// Relief of both flanks at the position of the driven tip.
fn relief(k: &Context, tip: &TipContact) -> f64 {
    let geometry = &k.solution.geometry;
    Relief::of(&k.inputs.reliefs(), geometry)
        .at(tip.curvature_driver, geometry.driven.tip_curvature)
}

fn compliance_at_start(k: &Context) -> Option<f64> {
    let geometry = &k.solution.geometry;
    let place = ContactPlace::on_line_of_action(geometry, geometry.start);
    let elasticity = k.inputs.elasticity();
    let teeth = Teeth::of(&elasticity, geometry).ok()?;
    teeth.pair_at_load(&place, k.solution.mesh_force).ok()
}

fn mean_of_pairs(k: &Context) -> String {
    let is_coupled = k.solution.mesh.as_ref().is_some_and(|mesh| mesh.is_coupled());
    let formula = if is_coupled {
        "the forces of all pairs from E to B per displacement, averaged over a base \
            pitch"
    } else {
        "ε k_p"
    };
    formula.to_owned()
}

fn mean_stiffness(k: &Context) -> Option<f64> {
    const TOLERANCE: f64 = 1e-12;
    k.solution.mesh.as_ref()?;
    let geometry = &k.solution.geometry;
    let elasticity = k.inputs.elasticity();
    let teeth = Teeth::of(&elasticity, geometry).ok()?;
    let stiffness = |part: f64| {
        let along = geometry.start + part * (geometry.end - geometry.start);
        let place = ContactPlace::on_line_of_action(geometry, along);
        let compliance = teeth.pair_at_load(&place, k.solution.mesh_force);
        k.inputs.common_width() / compliance.unwrap_or(f64::NAN)
    };
    Some(quadrature::adaptive(0.0, 1.0, TOLERANCE, stiffness))
}

pub(super) const STEPS: &[Step] = &[
    step(
        "k_p",
        "mean stiffness b/q of one pair from E to B, contact under F_0",
        "N/m",
        Words("by quadrature"),
        mean_stiffness,
    ),
    step("k_E", "stiffness of the incoming pair at E", "N/m", Text("b/q_E"), |k| {
        Some(k.inputs.common_width() / compliance_at_start(k)?)
    }),
    step(
        "q_E",
        "compliance of the incoming pair at E, contact under F_0",
        "um mm/N",
        Words("the tip on the flank, Eqs. 54-56"),
        compliance_at_start,
    ),
    step(
        "F_st,DE",
        "greatest force of the incoming tooth at rest from its first contact to E",
        "N",
        Words("as F_st,max, up to E"),
        |k| Some(k.solution.static_load.as_ref()?.approach_force),
    ),
    step(
        "x_E",
        "lead of the driver with the tooth at E, less the displacement of the tooth \
            by the forces on the others",
        "um",
        Words("from ΣF = F_0 of all pairs"),
        |k| lead(k, 0.0),
    ),
    step(
        "C_E",
        "relief of both flanks at E",
        "um",
        Words("from length and shape of the reliefs"),
        |k| Some(relief(k, &tip_at(&k.solution.geometry, 0.0))),
    ),
    step(
        "S_st",
        "gap S(u) between tip and flank at the first contact",
        "um",
        Words("as S(u) on the page of closed_gap, at u_st"),
        gap_at_first,
    ),
    step(
        "C_st",
        "relief of both flanks at the first contact",
        "um",
        Words("from length and shape of the reliefs"),
        |k| Some(relief(k, &first_contact(k)?)),
    ),
    step(
        "x_st",
        "lead of the driver by the other pairs at the first contact, less the \
            displacement of the tooth by their forces",
        "um",
        Words("from ΣF = F_0 of the other pairs"),
        lead_at_first,
    ),
];
