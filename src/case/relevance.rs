//! Whether a field makes a difference in a case, and why it does not.

use super::dependencies::is_read;
use super::fields::FIELDS;
use super::{Case, Problem, check};
use crate::model::Inputs;
use crate::model::compliance::{contact_of, model_of};
use crate::model::inputs::{Drive, Method};

/// Whether what stands in a field makes a difference to the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acting {
    /// Some quantity or station depends on it.
    Yes,
    /// It is told or noted beside the results, and no quantity depends on it.
    Beside(&'static str),
    /// The case does without it.
    No(&'static str),
}

/// Why some fields are idle.
struct Reason {
    keys: &'static [&'static str],
    when: fn(&Inputs) -> bool,
    why: &'static str,
}

/// The first that fits is told.
const REASONS: &[Reason] = &[
    Reason {
        keys: &["driver.tip_relief", "driven.root_relief"],
        when: by_impact,
        why: "at run-in the driven tip meets the driver's root: this relief acts at run-out, which this method does not follow",
    },
    Reason {
        keys: &[
            "driver.tip_relief_length",
            "driver.root_relief_length",
            "driven.tip_relief_length",
            "driven.root_relief_length",
            "model.relief_shape",
        ],
        when: by_impact,
        why: "this method takes the whole relief at the first contact, whatever its length and shape",
    },
    Reason {
        keys: &["driver.tip_radius"],
        when: by_impact,
        why: "the driver's tip touches at run-out only, which this method does not follow",
    },
    Reason {
        keys: &["driver.tip_radius", "driven.tip_radius"],
        when: by_constant_contact,
        why: "the contact compliance of this case does not depend on curvature",
    },
    Reason {
        keys: &["model.contact_compliance"],
        when: |inputs| contact_of(inputs).is_none(),
        why: "the tooth compliance of this case includes the contact",
    },
    Reason {
        keys: &["model.deflection"],
        when: |inputs| inputs.method.shares_load(),
        why: "this method computes the deflection from the load",
    },
    Reason {
        keys: &["model.tolerance"],
        when: |inputs| inputs.method == Method::Auto,
        why: "the method auto takes the tolerance from what is good enough, the field below",
    },
    Reason {
        keys: &[
            "model.damping_ratio",
            "model.warmup_cycles",
            "model.tolerance",
        ],
        when: always,
        why: "only the method dynamic follows the motion in time",
    },
    Reason {
        keys: &["model.within"],
        when: always,
        why: "only the method auto chooses by how much the answer may be off",
    },
    Reason {
        keys: &["model.station_tolerance"],
        when: always,
        why: "the number of stations is given, and not chosen by the curve",
    },
];

/// Why a field is idle for which there are no words of its own.
const OTHERWISE: &str = "nothing that this case computes depends on it";

/// Fields that stand beside the results, where no quantity depends on them.
const BESIDE: [(&str, &str); 3] = [
    ("title", "a name for people"),
    ("notes", "words for people"),
    (
        "operation.friction_coefficient",
        "a note holds it against the stick limit; no quantity of this method depends on it",
    ),
];

/// What some fields change, where it is less than one looks for.
const PARTS: &[Reason] = &[
    Reason {
        keys: &["operation.power", "operation.torque"],
        when: |inputs| inputs.method != Method::Auto && inputs.deflection_taken().is_some(),
        why: "with the deflection given, the load changes F_0, not the impact",
    },
    Reason {
        keys: &["model.accurate"],
        when: always,
        why: "it changes the last digits alone, beyond those that are shown",
    },
    Reason {
        keys: &["model.stations", "model.station_tolerance"],
        when: always,
        why: "it changes how closely the curve is told, no result",
    },
    Reason {
        keys: &["model.tolerance"],
        when: always,
        why: "it changes results by no more than itself",
    },
    Reason {
        keys: &[
            "driver.density",
            "driven.density",
            "driver.bore_radius",
            "driven.bore_radius",
        ],
        when: |inputs| inputs.method == Method::Static,
        why: "the load at rest knows no masses: the free impact changes, and with the beam the stiffness",
    },
    Reason {
        keys: &["driver.face_width"],
        when: |inputs| {
            inputs.method == Method::Static && inputs.driver.face_width >= inputs.driven.face_width
        },
        why: WIDER,
    },
    Reason {
        keys: &["driven.face_width"],
        when: |inputs| {
            inputs.method == Method::Static && inputs.driven.face_width >= inputs.driver.face_width
        },
        why: WIDER,
    },
    Reason {
        keys: &["driver.dedendum", "driven.dedendum"],
        when: |inputs| {
            let contact = contact_of(inputs);
            !model_of(inputs).model().reads_root
                && contact.is_none_or(|contact| !contact.model().reads_root)
        },
        why: "the tooth compliance does not read the root: only the stiffness spread changes, which tries the other models too",
    },
    Reason {
        keys: &["driver.addendum", "driver.tip_chamfer"],
        when: by_impact,
        why: "the driver's tip leaves contact at B: at run-in it counts only by how many pairs carry the load",
    },
    Reason {
        keys: &["operation.speed"],
        when: |inputs| inputs.method == Method::Static && matches!(inputs.drive, Drive::Torque(_)),
        why: "the load at rest knows no speed where the torque is given, and only the free impact changes",
    },
];

const WIDER: &str = "only the narrower width carries, and the load at rest knows no masses";

fn always(_: &Inputs) -> bool {
    true
}

fn by_impact(inputs: &Inputs) -> bool {
    !inputs.method.shares_load()
}

fn by_constant_contact(inputs: &Inputs) -> bool {
    contact_of(inputs).is_some_and(|contact| !contact.model().reads_half_width)
}

impl Case {
    /// The inputs as far as the case can be read, which is enough for the relevance of its fields,
    /// and everything that is wrong with the case, in the order of the fields.
    #[must_use]
    pub fn read(&self) -> (Inputs, Vec<Problem>) {
        check::read(self, &[])
    }
}

/// Whether the field makes a difference in a case with these inputs.
#[must_use]
pub fn relevance(field: usize, inputs: &Inputs) -> Acting {
    let key = FIELDS[field].key;
    if reaches(field, inputs) {
        return Acting::Yes;
    }
    if let Some((_, why)) = BESIDE.iter().find(|(beside, _)| *beside == key) {
        return Acting::Beside(why);
    }
    let reason = REASONS
        .iter()
        .find(|reason| reason.keys.contains(&key) && (reason.when)(inputs));
    Acting::No(reason.map_or(OTHERWISE, |reason| reason.why))
}

/// Why a field that acts in a case with these inputs moves less than one looks for, where it does.
#[must_use]
pub fn partial_relevance(field: usize, inputs: &Inputs) -> Option<&'static str> {
    let key = FIELDS[field].key;
    let part = PARTS
        .iter()
        .find(|reason| reason.keys.contains(&key) && (reason.when)(inputs))?;
    (relevance(field, inputs) == Acting::Yes).then_some(part.why)
}

/// Whether any stage reads the field; of the method `auto`, any stage of the methods that it
/// chooses from.
fn reaches(field: usize, inputs: &Inputs) -> bool {
    let by = |method| {
        is_read(
            field,
            &Inputs {
                method,
                ..inputs.clone()
            },
        )
    };
    match (FIELDS[field].key, inputs.method) {
        ("model.within", method) => method == Method::Auto,
        ("model.tolerance", Method::Auto) => false,
        ("model.station_tolerance", _) => inputs.stations.is_none(),
        (_, Method::Auto) => [Method::Exact, Method::Static, Method::Dynamic]
            .into_iter()
            .any(by),
        _ => is_read(field, inputs),
    }
}
