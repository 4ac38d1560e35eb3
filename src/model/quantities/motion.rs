//! Rows of the motion: load sharing with inertia.

use super::{PLAIN, Quantity, Variant, checks, conditions, of_driver};
use crate::model::Context;
use crate::model::Stage::Dynamic;
use crate::model::explanation::Formula::{self, Found, Text};
use crate::model::explanation::{Check, Step, step};

const IN_MOTION: &str = "One mass m_red moves on the springs and gaps of all pairs, with damping \
    while a pair is in contact. Shafts are rigid, and the load is steady. Only the incoming pair \
    has a deviation, e = Δf_0. With finite-element compliance the force on a pair displaces the \
    pairs up to three pitches away.";
const MOTION: &str = "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988, m x'' + \
    c x' + ΣF = F0, with the gap S(u) of the tips off the line of action. Integration by Taylor series \
    from contact event to contact event.";
const RATTLE: &str = "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988: the back flanks \
    touch where −x − j_bn − S_m > 0, x negative where the driver falls behind. j_bn is the normal \
    backlash of ISO 21771 along the line of action; circumferential backlash on the working pitch \
    circle is j_wt = j_bn/cos α_w.";
pub(super) const AT_BACK: &str = "Symmetric teeth, with the same reliefs on both flanks: the back flanks have \
    gap, stiffness and coupling of the working flanks, mirrored and with their own phase. No back \
    flank deviates. A tooth loaded on both flanks has no coupling between them.";
const CHECKS: &[Check] = &[checks::teeth, checks::forgotten, checks::contact_kept];
const BY_MOTION: Formula = Found(
    "taken from the motion m_red x'' + c x' + Σ w_k F_k − Σ w_m B_m = F_0, F_k >= 0 with x + e_k - S_k = Σ_j \
        Q_kj F_j/b where F_k > 0, which starts at the static balance model.warmup_cycles base pitches \
        before E",
    &["m_red", "c", "f_n", "f_z"],
);

pub(super) const TABLE: &[Quantity] = &[
    Quantity {
        key: "dynamic_first_contact_angle_driver",
        symbol: "θ_d",
        label: "dynamic: driver angle",
        unit: "rad",
        shown: "deg",
        digits: 4,
        equation: "m x'' + ΣF = F0",
        stage: Dynamic,
        value: |s| Some(of_driver(s, s.dynamic.as_ref()?.first_contact_angle?)),
        meaning: "The angle of the driver before E at which the incoming tooth first touches in \
            motion. The verdict of method dynamic gives this angle.",
        formula: Text("i u_d"),
        source: MOTION,
        corrections: &["Eqs. 7-20"],
        assumptions: IN_MOTION,
        checks: CHECKS,
        ..PLAIN
    },
    Quantity {
        key: "dynamic_first_contact_angle",
        symbol: "u_d",
        label: "dynamic: driven angle",
        unit: "rad",
        shown: "deg",
        digits: 4,
        equation: "m x'' + ΣF = F0",
        stage: Dynamic,
        value: |s| s.dynamic.as_ref()?.first_contact_angle,
        meaning: "The angle of the driven gear before E at which the incoming tooth first touches \
            in motion.",
        formula: BY_MOTION,
        source: MOTION,
        corrections: &["Eqs. 7-20"],
        assumptions: IN_MOTION,
        checks: CHECKS,
        ..PLAIN
    },
    Quantity {
        key: "dynamic_peak_approach_force",
        symbol: "F_d,DE",
        label: "dynamic: peak before E",
        unit: "N",
        shown: "N",
        digits: 5,
        equation: "m x'' + ΣF = F0",
        stage: Dynamic,
        value: |s| Some(s.dynamic.as_ref()?.peak_approach_force),
        meaning: "The peak force on the incoming tooth before E, in the corner contact: the \
            impact force by the motion of the whole mesh.",
        formula: BY_MOTION,
        source: MOTION,
        corrections: &["Eqs. 7-20", "Eq. 54"],
        assumptions: IN_MOTION,
        checks: CHECKS,
        ..PLAIN
    },
    Quantity {
        key: "dynamic_peak_force",
        symbol: "F_d,max",
        label: "dynamic: peak force",
        unit: "N",
        shown: "N",
        digits: 5,
        equation: "m x'' + ΣF = F0",
        stage: Dynamic,
        value: |s| Some(s.dynamic.as_ref()?.peak_force),
        meaning: "The peak force on the incoming tooth from its first contact to its last: the \
            load on its root and its flank.",
        formula: BY_MOTION,
        source: MOTION,
        corrections: &["Eq. 54"],
        assumptions: IN_MOTION,
        checks: CHECKS,
        variants: &[Variant::meaning(
            conditions::driven_rounded,
            "The peak force on the incoming tooth from its first contact to its last: the load on \
                its root and its flank. At E the contact passes from the tip radius to the flank, and \
                the stiffness of the pair rises in one step, but the displacement does not: the force \
                rises by the same ratio at any speed, and the peak can stay above F_st,max as the \
                speed falls. In a real pair the stiffness rises while the contact moves by its own \
                width, so that the model overstates the peak at low speed.",
        )],
        ..PLAIN
    },
    Quantity {
        key: "dynamic_impact_duration",
        symbol: "T_d",
        label: "dynamic: impact duration",
        unit: "s",
        shown: "us",
        digits: 4,
        equation: "m x'' + ΣF = F0",
        stage: Dynamic,
        value: |s| s.dynamic.as_ref()?.impact_duration,
        meaning: "The time from a first contact before E to the first minimum of the force after \
            its first peak, or to the loss of contact if that is earlier.",
        formula: BY_MOTION,
        source: MOTION,
        corrections: &["Eq. 32"],
        assumptions: IN_MOTION,
        checks: CHECKS,
        ..PLAIN
    },
    Quantity {
        key: "dynamic_last_contact_angle",
        symbol: "θ_d,B",
        label: "dynamic: run-out angle",
        unit: "rad",
        shown: "deg",
        digits: 4,
        equation: "m x'' + ΣF = F0",
        stage: Dynamic,
        value: |s| s.dynamic.as_ref()?.last_contact_angle,
        meaning: "The angle of the driver after B at the last contact of the incoming tooth in \
            motion.",
        formula: BY_MOTION,
        source: MOTION,
        assumptions: IN_MOTION,
        checks: CHECKS,
        ..PLAIN
    },
    Quantity {
        key: "dynamic_contact_lost",
        symbol: "lost",
        label: "dynamic: contact lost",
        unit: "1",
        shown: "yes/no",
        digits: 1,
        equation: "no pair touches",
        stage: Dynamic,
        value: |s| Some(f64::from(u8::from(s.dynamic.as_ref()?.contact_lost))),
        meaning: "Whether no pair touches at some moment. The gears then rattle and strike again.",
        formula: BY_MOTION,
        source: "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988: no pair \
            touches at some moment from one base pitch before E to the last contact of the tooth.",
        assumptions: IN_MOTION,
        checks: &[checks::teeth, checks::forgotten],
        ..PLAIN
    },
    Quantity {
        key: "dynamic_back_strikes",
        symbol: "n_d,b",
        label: "dynamic: back strikes",
        unit: "1",
        shown: "1",
        digits: 4,
        equation: "back flanks touch",
        stage: Dynamic,
        value: |s| Some(f64::from(s.dynamic.as_ref()?.rattle?.strikes)),
        meaning: "How often the back flanks strike across the backlash, from one base pitch \
            before E until the incoming tooth leaves. Without a backlash in the case the back flanks are far \
            away, and this result does not exist.",
        formula: BY_MOTION,
        source: RATTLE,
        assumptions: AT_BACK,
        checks: &[checks::teeth, checks::forgotten],
        needs_backlash: true,
        ..PLAIN
    },
    Quantity {
        key: "dynamic_peak_back_force",
        symbol: "B_d,max",
        label: "dynamic: back flank peak",
        unit: "N",
        shown: "N",
        digits: 5,
        equation: "max B",
        stage: Dynamic,
        value: |s| Some(s.dynamic.as_ref()?.rattle?.force),
        meaning: "The greatest force max B on a pair of back flanks, from one base pitch before E \
            until the incoming tooth leaves.",
        formula: BY_MOTION,
        source: RATTLE,
        assumptions: AT_BACK,
        checks: &[checks::teeth, checks::forgotten],
        needs_backlash: true,
        ..PLAIN
    },
    Quantity {
        key: "dynamic_friction_work",
        symbol: "W_μ",
        label: "dynamic: friction work",
        unit: "J",
        shown: "J",
        digits: 5,
        equation: "∫μ F |v| dt",
        stage: Dynamic,
        value: |s| s.dynamic.as_ref()?.friction_work,
        meaning: "The work of the friction on the incoming tooth from its first contact to its \
            last, with the μ of the case.",
        formula: BY_MOTION,
        source: "Coulomb friction along the motion, ∫μ F |v| dt with the sliding velocity v of \
            the pair, after Özgüven & Houser 1988.",
        corrections: &["Eq. 64"],
        assumptions: IN_MOTION,
        checks: CHECKS,
        needs_friction: true,
        ..PLAIN
    },
];

fn stiffness(k: &Context) -> Option<f64> {
    Some(k.solution.mesh.as_ref()?.mean_stiffness())
}

pub(super) const STEPS: &[Step] = &[step(
    "c",
    "damping of the mesh while a pair is in contact",
    "N s/m",
    Text("2 ζ √(k_m m_red)"),
    |k| Some(2.0 * k.inputs.damping_ratio * (stiffness(k)? * k.solution.reduced_mass).sqrt()),
)];
