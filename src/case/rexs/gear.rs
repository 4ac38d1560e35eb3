//! A gear of a stage with its flanks and its material, and the keys of its fields in a case.

use super::model::{Component, Model};
use super::source::{Problem, Reading, Wanted, agreed};

/// A gear of the stage with its components.
pub(super) struct Gear<'a> {
    pub(super) component: &'a Component,
    /// The components of the left and of the right flank.
    pub(super) flanks: [Vec<&'a Component>; 2],
    pub(super) materials: Vec<&'a Component>,
    /// Racks that cut the gear.
    pub(super) racks: Vec<&'a Component>,
}

impl<'a> Gear<'a> {
    pub(super) fn new(model: &'a Model, component: &'a Component) -> Gear<'a> {
        let flank = |side| {
            let own = ("gear", component.id.as_str());
            model.related("flank", own, side).collect()
        };
        Gear {
            component,
            flanks: [flank("left"), flank("right")],
            materials: model.linked(&component.id, "material").collect(),
            racks: model.linked(&component.id, "rack_shaped_tool").collect(),
        }
    }

    /// A value that both flanks must share, or the value of the gear itself.
    pub(super) fn of_flanks(&self, wanted: Wanted) -> Result<Option<Reading>, Problem> {
        let [left, right] = &self.flanks;
        let reading =
            agreed(wanted.first(left.iter().copied())?, wanted.first(right.iter().copied())?)?;
        reading.map_or_else(|| wanted.read(self.component), |reading| Ok(Some(reading)))
    }
}

macro_rules! keys {
    ($gear:literal) => {
        Keys {
            teeth: concat!($gear, ".teeth"),
            profile_shift: concat!($gear, ".profile_shift"),
            addendum: concat!($gear, ".addendum"),
            tip_diameter: concat!($gear, ".tip_diameter"),
            dedendum: concat!($gear, ".dedendum"),
            root_diameter: concat!($gear, ".root_diameter"),
            face_width: concat!($gear, ".face_width"),
            bore_radius: concat!($gear, ".bore_radius"),
            young: concat!($gear, ".young"),
            poisson: concat!($gear, ".poisson"),
            density: concat!($gear, ".density"),
            tip_chamfer: concat!($gear, ".tip_chamfer"),
            tip_relief: concat!($gear, ".tip_relief"),
            tip_relief_length: concat!($gear, ".tip_relief_length"),
            root_relief: concat!($gear, ".root_relief"),
            root_relief_length: concat!($gear, ".root_relief_length"),
        }
    };
}

/// The keys of the fields of one gear.
pub(super) struct Keys {
    pub(super) teeth: &'static str,
    pub(super) profile_shift: &'static str,
    pub(super) addendum: &'static str,
    pub(super) tip_diameter: &'static str,
    pub(super) dedendum: &'static str,
    pub(super) root_diameter: &'static str,
    pub(super) face_width: &'static str,
    pub(super) bore_radius: &'static str,
    pub(super) young: &'static str,
    pub(super) poisson: &'static str,
    pub(super) density: &'static str,
    pub(super) tip_chamfer: &'static str,
    pub(super) tip_relief: &'static str,
    pub(super) tip_relief_length: &'static str,
    pub(super) root_relief: &'static str,
    pub(super) root_relief_length: &'static str,
}

pub(super) const DRIVER: Keys = keys!("driver");
pub(super) const DRIVEN: Keys = keys!("driven");
