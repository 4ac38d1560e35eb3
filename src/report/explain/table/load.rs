//! Explanations of the methods in which every pair takes its share of the load.

use super::Explanation;
use crate::report::explain::context::Formula::{self, Found, Solved, Text};
use crate::report::explain::valid::{load, pair, stiffness};

const AT_REST: &str = "Every pair is a spring b/q with a gap, and they share the mesh force at rest. Of the pairs only the incoming one \
    deviates, by e = Δf_0; all have their reliefs. A deflection that the case gives is left aside.";
const IN_MOTION: &str = "One mass m_red on the springs and gaps of every pair, with damping while a pair touches; shafts are rigid, the load \
    is steady. Of the pairs only the incoming one deviates, by e = Δf_0.";
const BALANCE: &str = "Balance ΣF = F0 of parallel springs with gaps, as in Seireg & Houser 1970, with the gap S(u) of the tips off the line \
    of action; compliances of Zhou & Chen 2014, Eqs. 54-56.";
const MOTION: &str = "The oscillator of gear dynamics with backlash, Özgüven & Houser 1988, m x'' + ΣF = F0, with the gap S(u) of the tips off \
    the line of action; steps by Taylor series, from contact event to contact event.";
const SHARED: &[&str] = &["F_0", "k_m", "Δf_0"];
const SWING: &[&str] = &["m_red", "c", "f_n", "f_z"];
const STATIC_VALID: &[load::Look] = &[pair::contact_ratio, stiffness::teeth, load::at_rest];
const DYNAMIC_VALID: &[load::Look] = &[stiffness::teeth, load::forgotten, load::kept];

const MOVED: Formula = Found {
    words: "read off the motion m_red x'' + c x' + Σ w_k F_k = F_0, F_k = b/q max(0, x + e - S), from the static balance \
        model.warmup_cycles base pitches before E",
    with: SWING,
};

pub(super) static TABLE: &[Explanation] = &[
    Explanation {
        key: "mesh_stiffness",
        says: "Mean stiffness of the mesh over a base pitch, all pairs on the line of action together and none deviating: what the gears \
            swing on, and what the damping is a part of.",
        formula: Text("ε k_p"),
        source: "Mean of b/q of a pair over its path of contact, times the pairs in contact; compliances of Zhou & Chen 2014, \
            Eqs. 54-56. The mean of ISO 6336-1 is c_γ.",
        mended: &["Eq. 55", "Eq. 56"],
        assumes: "The contact is taken under F_0, so that a pair's stiffness depends on its place alone.",
        valid: &[stiffness::teeth],
    },
    Explanation {
        key: "static_first_contact_angle",
        says: "How far the driven gear stands before E when the incoming tooth begins to carry at rest: its gap is there what the other \
            pairs give way.",
        formula: Solved {
            equation: "gap of the incoming pair = displacement by the other pairs, S_s + C_s - Δf_0 = x_s",
            left: "S_s + C_s - Δf_0",
            right: "x_s",
            unit: "um",
        },
        source: BALANCE,
        mended: &["Eqs. 7-20"],
        assumes: AT_REST,
        valid: STATIC_VALID,
    },
    Explanation {
        key: "static_first_contact_angle_driver",
        says: "Driver roll angle from the first contact at rest to E. The verdict of method static gives this angle.",
        formula: Text("i u_st"),
        source: BALANCE,
        mended: &["Eqs. 7-20"],
        assumes: AT_REST,
        valid: STATIC_VALID,
    },
    Explanation {
        key: "static_force_at_start",
        says: "What the incoming tooth carries at rest when it comes to E: with a good tip relief nothing, without any a good part of the \
            mesh force.",
        formula: Text("max(k_E (x_E + Δf_0 - C_E), 0)"),
        source: BALANCE,
        mended: &["Eq. 53", "Eq. 54"],
        assumes: AT_REST,
        valid: STATIC_VALID,
    },
    Explanation {
        key: "static_peak_force",
        says: "The most that the incoming tooth carries at rest on its whole way; in single contact all of the mesh force.",
        formula: Found {
            words: "the greatest F_k of the tooth from its first contact to its last, F_k = b/q max(0, x + e - S) with Σ w_k F_k = F_0",
            with: SHARED,
        },
        source: BALANCE,
        mended: &["Eq. 53", "Eq. 54"],
        assumes: AT_REST,
        valid: STATIC_VALID,
    },
    Explanation {
        key: "static_last_contact_angle",
        says: "How far the driver has turned past B when the incoming tooth ceases to carry at rest: corner contact at the run-out, of the \
            driver's tip on the driven flank.",
        formula: Found {
            words: "where the gap past B of the tooth is what the other pairs give way, by Σ w_k F_k = F_0",
            with: SHARED,
        },
        source: BALANCE,
        mended: &[],
        assumes: AT_REST,
        valid: STATIC_VALID,
    },
    Explanation {
        key: "static_transmission_error",
        says: "By how much the driver runs ahead more at one place than at another while the tooth carries: what makes the gears whine.",
        formula: Found {
            words: "max x - min x from the first contact to the last, x by Σ w_k F_k = F_0",
            with: SHARED,
        },
        source: BALANCE_OF_ERROR,
        mended: &[],
        assumes: AT_REST,
        valid: STATIC_VALID,
    },
    Explanation {
        key: "pitch_contact_jump",
        says: "By how much the forces of all pairs change where the incoming tooth passes the pitch point: its friction with μ turns the \
            driver on before and holds it back after.",
        formula: Found {
            words: "Σ F_k just after the pitch point less Σ F_k just before, by Σ w_k F_k = F_0, w = 1 -+ μ ρ_1/r_b1",
            with: SHARED,
        },
        source: "Friction in the driver's own balance, ΣF = F0 with weights; the third kind of contact in the introduction of \
            Zhou & Chen 2014, pitch corner contact.",
        mended: &[],
        assumes: AT_REST,
        valid: &[load::at_rest],
    },
    Explanation {
        key: "dynamic_first_contact_angle",
        says: "How far the driven gear stands before E when the incoming tooth first touches, the gears swinging.",
        formula: MOVED,
        source: MOTION,
        mended: &["Eqs. 7-20"],
        assumes: IN_MOTION,
        valid: DYNAMIC_VALID,
    },
    Explanation {
        key: "dynamic_first_contact_angle_driver",
        says: "Driver roll angle from the first contact in motion to E. The verdict of method dynamic gives this angle.",
        formula: Text("i u_d"),
        source: MOTION,
        mended: &["Eqs. 7-20"],
        assumes: IN_MOTION,
        valid: DYNAMIC_VALID,
    },
    Explanation {
        key: "dynamic_peak_approach_force",
        says: "The most that the incoming tooth carries before E, in the corner contact itself: the impact force as the whole mesh makes \
            it.",
        formula: MOVED,
        source: MOTION,
        mended: &["Eqs. 7-20", "Eq. 54"],
        assumes: IN_MOTION,
        valid: DYNAMIC_VALID,
    },
    Explanation {
        key: "dynamic_peak_force",
        says: "The most that the incoming tooth carries on its whole way: what its root and its flank must bear.",
        formula: MOVED,
        source: MOTION,
        mended: &["Eq. 54"],
        assumes: IN_MOTION,
        valid: DYNAMIC_VALID,
    },
    Explanation {
        key: "dynamic_impact_duration",
        says: "From a first touch before E to the first least force after the first peak, or until the tooth comes off again.",
        formula: MOVED,
        source: MOTION,
        mended: &["Eq. 32"],
        assumes: IN_MOTION,
        valid: DYNAMIC_VALID,
    },
    Explanation {
        key: "dynamic_last_contact_angle",
        says: "How far the driver has turned past B when the incoming tooth comes off for good, the gears swinging.",
        formula: MOVED,
        source: MOTION,
        mended: &[],
        assumes: IN_MOTION,
        valid: DYNAMIC_VALID,
    },
    Explanation {
        key: "dynamic_contact_lost",
        says: "Whether at some moment no pair touches: the gears rattle, and strike anew.",
        formula: MOVED,
        source: "Read off the motion of the oscillator of gear dynamics with backlash, Özgüven & Houser 1988, from one base pitch before E \
            until the tooth leaves.",
        mended: &[],
        assumes: IN_MOTION,
        valid: &[stiffness::teeth, load::forgotten],
    },
    Explanation {
        key: "dynamic_friction_work",
        says: "What the friction of the incoming tooth takes from first contact to last, with the case's μ.",
        formula: MOVED,
        source: "Coulomb friction along the motion, ∫μ F |v| dt with the sliding velocity v of the pair, after Özgüven & Houser 1988.",
        mended: &["Eq. 64"],
        assumes: IN_MOTION,
        valid: DYNAMIC_VALID,
    },
];

const BALANCE_OF_ERROR: &str = "Displacement x of the driver ahead along the line of action, max x − min x, by the balance ΣF = F0 of parallel \
    springs with gaps, as in Seireg & Houser 1970.";
