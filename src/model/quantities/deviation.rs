//! Rows of the deviations that make a tooth early, and the steps of the deflection.

use super::conditions::{
    always, any_base_pitch, at_rest, deflection_used, graded, in_motion, in_slices, paper,
    pitch_given, shared_load,
};
use super::{PLAIN, Quantity, Variant, checks};
use crate::model::Stage::{Clearing, Deviation};
use crate::model::compliance::{ContactPlace, Teeth, TeethCompliance};
use crate::model::deviation::earliness;
use crate::model::explanation::Formula::{Cases, Difference, Found, Given, Made, Text, Words};
use crate::model::explanation::{Step, step};
use crate::model::inputs::{Combination, Method};
use crate::model::{Context, Inputs};

/// A distance along the line of action.
const DEVIATION: Quantity = Quantity {
    stage: Deviation,
    source: "Zhou & Chen 2014, Eqs. 1 and 2.",
    corrections: &["Eq. 1"],
    equation: "Eq. 1",
    ..PLAIN
};

const MICRONS: (&str, &str, usize) = ("m", "um", 5);

/// The addition of deviations, with the end of the sentence about the reliefs.
macro_rules! added {
    ($reliefs:literal) => {
        concat!(
            "Deviations of which only the size is known are independent and add as squares, hence \
                the factor 1/√2; with combination sum they add with their signs. ",
            $reliefs,
            " A backlash does not delay a drive flank under load."
        )
    };
}

pub(super) const TABLE: &[Quantity] = &[
    DEVIATION
        .row(
            ["equivalent_error", "Δf", "equivalent error"],
            MICRONS,
            |s| Some(s.deviation.equivalent_error),
            "The distance along the line of action by which the deviations of both gears bring \
                the incoming tooth into contact early",
            Cases(&[
                (any_base_pitch, Made(own_error)),
                (paper, Difference("(2 f_pb + e_m - j_bn)/√2")),
                (shared_load, Text("2 f_pb/√2")),
                (always, Difference("2 f_pb/√2 + e_m")),
            ]),
        )
        .assumptions(added!(
            "The relief acts with its full amount at the tip, where first contact occurs."
        ))
        .variants(&[
            Variant::words(
                shared_load,
                ", without the reliefs, which act on the flanks over their length. Method exact \
                    calls the sum of this distance and e_m Δf.",
                added!("The reliefs are not included."),
            ),
            Variant::words(
                paper,
                ". Relief reduces it by 1/√2 of its amount, as printed.",
                "The f_pb of both gears, j_bn and e_m are independent random deviations, which \
                    add as squares: hence the factor 1/√2. A ground relief is not random: method \
                    exact counts its full amount.",
            ),
            Variant::meaning(always, ". Relief reduces it by its full amount."),
        ])
        .signed(),
    DEVIATION
        .row(
            ["modification", "e_m", "modification at entry"],
            MICRONS,
            |s| Some(s.deviation.modification),
            "The material that the reliefs remove where tip and root meet: the tip relief of the \
                driven gear and the root relief of the driver, as a negative number.",
            Text("-(Ca2 + Cf1)"),
        )
        .assumptions("Both reliefs have their full amount at the first contact.")
        .variants(&[
            Variant::meaning(
                shared_load,
                " Only Δ includes it. The forces of this method follow the reliefs on the flanks, \
                    with their length and shape.",
            ),
            Variant::meaning(paper, " Δf includes 1/√2 of it, as printed."),
            Variant::meaning(always, " Δf and Δ include its full amount."),
        ])
        .signed(),
    DEVIATION
        .row(
            ["combined_deflection", "δ", "combined deflection"],
            MICRONS,
            |s| Some(s.deviation.combined_deflection),
            "The deflection along the line of action of the pairs that carry the load when the \
                incoming pair is at E",
            Cases(&[
                (deflection_used, Given("model.deflection")),
                (over_face, Found(OVER_FACE, &["F_0"])),
                (always, Made(deflection)),
            ]),
        )
        .equation("Eq. 3")
        .source(
            "Zhou & Chen 2014, Eqs. 3 and 4, with the compliances of Eqs. 54-56 instead of the \
                curve in Fig. 3. Table 1 uses 24.7 um from reference 20 of the paper.",
        )
        .corrections(&["Eq. 55", "Eq. 56"])
        .assumptions(
            "Teeth and contacts share the mesh force at rest. With finite-element compliance, the \
                force on a tooth also displaces the incoming pair, which reduces its lead; in the \
                other models and in method paper, each pair deflects alone. Shafts, bearings and \
                housing are rigid.",
        )
        .checks(&[checks::contact_ratio, checks::teeth_of_deflection])
        .variants(&[
            Variant::meaning(
                in_motion,
                ", at rest. In motion the mesh oscillates about this deflection. The method \
                    ignores a deflection that the case gives.",
            ),
            Variant::meaning(
                shared_load,
                ", on flanks without relief. The method ignores a deflection that the case gives.",
            ),
            Variant::words(
                deflection_used,
                ". The case gives it, and the load does not change it.",
                "The given deflection belongs to the load of the case. The program does not \
                    compare the two.",
            ),
            Variant::meaning(always, "."),
        ]),
    DEVIATION
        .row(
            ["total_deviation", "Δ", "total deviation"],
            MICRONS,
            |s| Some(s.deviation.total),
            "The total distance by which the incoming tooth is early",
            Cases(&[
                (shared_load, Difference("Δf_0 + e_m + δ")),
                (in_slices, Difference("Δf + δ + e_z")),
                (always, Difference("Δf + δ")),
            ]),
        )
        .equation("Eq. 5")
        .source("Zhou & Chen 2014, Eq. 5.")
        .assumptions("Deviations and deflection add up along the line of action.")
        .checks(&[checks::pair_ahead])
        .variants(&[
            Variant::words(
                in_motion,
                " at rest. In motion the mesh oscillates, so the tooth may touch before E whether \
                    Δ is positive or negative; see dynamic_first_contact_angle.",
                ON_BARE_FLANKS,
            ),
            Variant::words(
                shared_load,
                " if the pairs ahead are on flanks without relief. Above 0 it touches before E, at \
                    0 or below it does not. The balance of all pairs decides: \
                    static_first_contact_angle has the answer.",
                ON_BARE_FLANKS,
            ),
            Variant::meaning(
                paper,
                ". At 0 or below there is no contact before E. Above 0 the tip strikes if the \
                    printed equations give an angle before E.",
            ),
            Variant::meaning(
                always,
                ". Above 0 the tip strikes before E. At 0 or below there is no contact before E.",
            ),
        ])
        .signed(),
    DEVIATION
        .row(
            ["clearing_relief", "ΔC_a2", "additional tip relief"],
            MICRONS,
            |s| s.clearing?.relief,
            "The required additional tip relief of the driven gear: the smallest increase with \
                which the chosen method finds no contact before E.",
            Cases(&[
                (
                    paper,
                    Words(
                        "the root C of u(Δf - C/√2) = 0, u by Eqs. 11-20 as printed; at most √2 Δ",
                    ),
                ),
                (
                    at_rest,
                    Found(
                        "the root C of max(x - gap) = 0 up to E: x is the lead of the driver by \
                            the balance Σ w_k F_k = F_0 of the other pairs; every pair has the \
                            additional tip relief C",
                        &["F_0", "k_m", "Δf_0", "Δ"],
                    ),
                ),
                (
                    in_motion,
                    Found(
                        "the root C of max(x - gap) = 0 up to E: x is the lead of the driver in \
                            the motion m_red x'' + c x' + Σ w_k F_k = F_0 without a force on the \
                            incoming tooth; every pair has the additional tip relief C",
                        &["m_red", "c", "f_n", "f_z", "Δf_0", "Δ"],
                    ),
                ),
                (always, Text("Δ")),
            ]),
        )
        .equation("no contact")
        .stage(Clearing)
        .source(
            "Zhou & Chen 2014, Eq. 5: the condition Δ <= 0. Methods static and dynamic apply the \
                same condition, no contact before E, to the displacement of every pair.",
        )
        .corrections(&["Eq. 1", "Eqs. 7-20"])
        .assumptions(
            "Every tooth of the driven gear has the additional relief, with the length and shape \
                of its tip relief. With method dynamic, the search also tests 4 larger reliefs, up \
                to twice this relief (50 if contact is lost), and finds no contact before E.",
        )
        .checks(&[checks::contact_kept]),
];

const ON_BARE_FLANKS: &str = "Deviations and deflection add up along the line of action. The gears are \
    at rest, and the pairs ahead are on flanks without relief.";

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

const OVER_FACE: &str = "F_0/b over the mean of Σ 1/q of the pairs in contact over the face width, less \
    the displacement of the incoming pair by them";

fn over_face(inputs: &Inputs) -> bool {
    inputs.face().is_some()
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
    let (teeth, start) = loaded(k, 0)?;
    teeth.coupling(&start, &loaded(k, 1)?.1, 1).ok()
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

/// The teeth, and the place of the load `pitches` base pitches after E under the mesh force.
fn loaded(k: &Context, pitches: u32) -> Option<(Teeth, ContactPlace)> {
    let teeth = Teeth::of(&k.inputs.elasticity(), &k.solution.geometry).ok()?;
    let place = teeth.under(&place(k, pitches)?, k.solution.mesh_force);
    Some((teeth, place))
}

/// Compliance of the pair `pitches` base pitches after E, under the mesh force.
fn ahead(k: &Context, pitches: u32) -> Option<f64> {
    let (teeth, place) = loaded(k, pitches)?;
    teeth.pair_at_load(&place, k.solution.mesh_force).ok()
}

fn teeth_ahead(k: &Context) -> Option<TeethCompliance> {
    let (teeth, place) = loaded(k, 1)?;
    teeth.at(&place).ok()
}

fn contact_ahead(k: &Context) -> Option<f64> {
    let (teeth, place) = loaded(k, 1)?;
    teeth.spring(&place).ok()?.compliance(k.solution.mesh_force).ok()
}

/// The tolerance and the deviation of a gear: its place and number, its member of the inputs, its
/// name, and the key of its own deviation.
macro_rules! pitches {
    ($at:literal, $n:literal, $gear:ident, $of:literal, $name:literal, $key:literal) => {
        [
            step(
                concat!("f_pT", $n),
                concat!(
                    "single pitch deviation of the ",
                    $of,
                    " flank tolerance class, rounded by ISO 1328-1"
                ),
                "um",
                Words(concat!("(0.001 d + 0.4 m + 5) 2^((A", $n, " - 5)/2) um, d and m in mm")),
                |k| k.inputs.graded_pitch(&k.inputs.$gear),
            ),
            step(
                concat!("f_pb", $n),
                concat!("base pitch deviation of the ", $name),
                "um",
                Cases(&[
                    (pitch_given::<$at>, Given($key)),
                    (graded::<$at>, Text(concat!("f_pT", $n, " cos α_t"))),
                    (always, Text("f_pb")),
                ]),
                |k| Some(k.inputs.base_pitch_of(&k.inputs.$gear).0),
            ),
        ]
    };
}

const DRIVER: [Step; 2] = pitches!(0, "1", driver, "driver's", "driver", "driver.base_pitch");
const DRIVEN: [Step; 2] =
    pitches!(1, "2", driven, "driven gear's", "driven gear", "driven.base_pitch");

/// The compliance of a pair farther ahead.
macro_rules! ahead {
    ($symbol:literal, $word:literal, $pitches:literal) => {
        step(
            $symbol,
            concat!("compliance of the pair ", $word, " base pitches after E"),
            "um mm/N",
            Words("computed as for the pair at F"),
            |k| ahead(k, $pitches),
        )
    };
}

pub(super) const STEPS: &[Step] = &[
    step(
        "e_z",
        "mean gap over the face by misalignment and flank lines, less the least gap",
        "um",
        Words("from the flank lines, with the pair ahead in contact over the whole face"),
        |k| in_slices(k.inputs).then(|| earliness(k.inputs)),
    ),
    DRIVER[0],
    DRIVEN[0],
    DRIVER[1],
    DRIVEN[1],
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
        |k| Some(teeth_ahead(k)?.driver),
    ),
    step(
        "q_2F",
        "driven tooth of that pair, loaded at O2F",
        "um mm/N",
        Words("the tooth compliance at that radius"),
        |k| Some(teeth_ahead(k)?.driven),
    ),
    step(
        "q_HF",
        "contact of that pair under F_0",
        "um mm/N",
        Words("the contact compliance at that load"),
        contact_ahead,
    ),
    ahead!("q_F,2", "two", 2),
    ahead!("q_F,3", "three", 3),
    ahead!("q_F,4", "four", 4),
];
