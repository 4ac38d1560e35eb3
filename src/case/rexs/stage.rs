//! The gear stages of a model and their kinds.

use std::fmt;

use super::model::{Component, Model};
use super::source::Wanted;
use crate::case::sanitize::cut;
use crate::case::units::Dimension;

/// A gear stage of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stage {
    /// The id of its component.
    pub id: String,
    /// Its name, which may be empty.
    pub name: String,
    /// The kind of the stage.
    pub kind: Kind,
}

/// The kind of a stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Kind {
    /// Two external spur gears: gear 1 and gear 2 by their ids.
    Spur {
        /// The ids of gear 1 and gear 2.
        gears: [String; 2],
        /// The numbers of teeth as text, such as `20/40`.
        teeth: String,
    },
    /// A stage with a helix angle, as written in the model.
    Helical(String),
    /// The mesh of a planetary stage, by the id of that stage.
    InPlanetary(String),
    /// A planetary stage.
    Planetary,
    /// A stage with a ring gear.
    Internal,
    /// A stage with a gear of another type.
    Gear(String),
    /// A stage of another type.
    Other(String),
    /// A stage without two gears.
    Incomplete,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Spur { teeth, .. } => write!(f, "a spur stage ({teeth} teeth)"),
            Kind::Helical(angle) => write!(f, "a helical stage (helix angle {angle})"),
            Kind::InPlanetary(id) => write!(f, "a mesh of the planetary stage {id}"),
            Kind::Planetary => f.write_str("a planetary stage"),
            Kind::Internal => f.write_str("a stage with a ring gear"),
            Kind::Gear(kind) => write!(f, "a stage with a {}", kind.replace('_', " ")),
            Kind::Other(kind) => {
                let name = kind.trim_end_matches("_stage").replace('_', " ");
                write!(f, "a {name} stage")
            }
            Kind::Incomplete => f.write_str("a stage without two gears"),
        }
    }
}

impl Stage {
    /// The id and the name of the stage.
    #[must_use]
    pub fn label(&self) -> String {
        if self.name.is_empty() { self.id.clone() } else { format!("{} {:?}", self.id, self.name) }
    }

    /// A title for the case of the stage.
    #[must_use]
    pub fn title(&self) -> String {
        if self.name.is_empty() { format!("Stage {}", self.id) } else { self.name.clone() }
    }
}

/// All stages on one line.
#[must_use]
pub(super) fn listed(stages: &[Stage]) -> String {
    let line = |stage: &Stage| format!("stage {} is {}", stage.label(), stage.kind);
    stages.iter().map(line).collect::<Vec<_>>().join("; ")
}

/// The stages in the order of the model.
pub(super) fn list(model: &Model) -> Vec<Stage> {
    model
        .stages()
        .map(|component| Stage {
            id: component.id.clone(),
            name: component.name.clone(),
            kind: kind(model, component),
        })
        .collect()
}

fn kind(model: &Model, stage: &Component) -> Kind {
    match stage.kind.as_str() {
        "cylindrical_stage" => cylindrical(model, stage),
        "planetary_stage" => Kind::Planetary,
        other => Kind::Other(other.to_owned()),
    }
}

fn cylindrical(model: &Model, stage: &Component) -> Kind {
    let own = ("part", stage.id.as_str());
    let mut assemblies = model.related("assembly", own, "assembly");
    if let Some(planetary) = assemblies.find(|assembly| assembly.kind == "planetary_stage") {
        return Kind::InPlanetary(planetary.id.clone());
    }
    let gear = |role| model.related("stage", ("stage", &stage.id), role).next();
    let (Some(first), Some(second)) = (gear("gear_1"), gear("gear_2")) else {
        return Kind::Incomplete;
    };
    let gears = [first, second];
    if gears.iter().any(|gear| gear.kind == "ring_gear") {
        return Kind::Internal;
    }
    if let Some(gear) = gears.iter().find(|gear| gear.kind != "cylindrical_gear") {
        return Kind::Gear(gear.kind.clone());
    }
    let angles = gears.iter().filter_map(|gear| helix(gear));
    if let Some(angle) = angles.into_iter().next() {
        return Kind::Helical(angle);
    }
    let teeth = gears.map(|gear| {
        let teeth = TEETH.read(gear).ok().flatten();
        teeth.map_or("unknown".to_owned(), |teeth| teeth.text)
    });
    Kind::Spur { gears: gears.map(|gear| gear.id.clone()), teeth: teeth.join("/") }
}

pub(super) const TEETH: Wanted = Wanted::number("number_of_teeth");

const HELIX: [&str; 3] =
    ["helix_angle_reference_diameter", "helix_angle_base_diameter", "helix_angle_base_circle"];

/// The helix angle if it is not zero or cannot be read. A model can have a rounded zero.
fn helix(gear: &Component) -> Option<String> {
    const NONE: f64 = 1e-8;
    HELIX.iter().find_map(|&id| match Wanted::new(id, Dimension::Angle, "deg").read(gear) {
        Ok(Some(angle)) if angle.value.abs() > NONE => Some(angle.text),
        Ok(_) => None,
        Err(_) => gear.attribute(id).map(|angle| cut(&angle.value)),
    })
}
