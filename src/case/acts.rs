//! Which fields the chosen rung uses, and why it does without the others.

use super::Case;
use super::fields::{FIELDS, index_of};

/// Whether what stands in a field makes a difference to the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acting {
    /// Some quantity or station depends on it.
    Yes,
    /// It is told or noted beside the results, and no quantity depends on it.
    Beside(&'static str),
    /// The chosen rung does without it.
    No(&'static str),
}

/// Fields that some rungs do without.
struct Rule {
    keys: &'static [&'static str],
    /// The rungs in which they are idle; a rung that is not named uses them.
    idle: &'static [&'static str],
    /// Why, as a person reads it.
    why: &'static str,
}

/// The rungs that know of a relief only how much stands at the run-in contact.
const CLOSED_FORM: &[&str] = &["paper", "exact"];

const RULES: &[Rule] = &[
    Rule {
        keys: &["driver.tip_relief", "driven.root_relief"],
        idle: CLOSED_FORM,
        why: "at run-in the driven tip meets the driver's root: this relief acts at run-out, which this rung does not follow",
    },
    Rule {
        keys: &[
            "driver.tip_relief_length",
            "driver.root_relief_length",
            "driven.tip_relief_length",
            "driven.root_relief_length",
            "model.relief_shape",
        ],
        idle: CLOSED_FORM,
        why: "this rung takes the whole relief at the first contact, whatever its length and shape",
    },
    Rule {
        keys: &["driver.tip_radius"],
        idle: CLOSED_FORM,
        why: "the driver's tip touches at run-out only, which this rung does not follow",
    },
    Rule { keys: &["model.deflection"], idle: &["static", "dynamic"], why: "this rung computes the deflection from the load" },
    Rule {
        keys: &["model.damping_ratio", "model.warmup_cycles"],
        idle: &["paper", "exact", "static"],
        why: "only the rung dynamic follows the motion in time",
    },
    Rule { keys: &["model.tolerance"], idle: CLOSED_FORM, why: "this rung is a closed form, exact to the last digits" },
    Rule {
        keys: &["model.within"],
        idle: &["paper", "exact", "static", "dynamic"],
        why: "only the rung auto chooses by how much the answer may be off",
    },
];

/// Fields that stand beside the results whatever the rung.
const BESIDE: [(&str, &str); 3] = [
    ("title", "a name for people"),
    ("notes", "words for people"),
    ("operation.friction_coefficient", "a note holds it against the stick limit; no quantity depends on it"),
];

/// Whether the field makes a difference to the results of the case's rung. A field or a rung that the table does not name
/// makes one.
#[must_use]
pub fn acts(field: usize, case: &Case) -> Acting {
    let key = FIELDS[field].key;
    if let Some((_, why)) = BESIDE.iter().find(|(beside, _)| *beside == key) {
        return Acting::Beside(why);
    }
    let rung = index_of("model.rung").and_then(|rung| case.effective(rung)).unwrap_or_default();
    let idle = |rule: &&Rule| rule.keys.contains(&key) && rule.idle.contains(&rung);
    RULES.iter().find(idle).map_or(Acting::Yes, |rule| Acting::No(rule.why))
}
