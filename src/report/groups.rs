//! The quantities in groups with headings, in the order of a method: first the results of its last
//! stages.

use crate::model::inputs::Method;
use crate::model::{QUANTITIES, Quantity, Stage};

/// Heading of the quantities of the free impact if the method resolves the impact itself.
pub const FREE_IMPACT: &str = "Free impact at D, closed form";

/// A group of quantities.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    /// The heading.
    pub title: &'static str,
    /// The stages of its quantities.
    stages: &'static [Stage],
}

/// Every group, in the order of a closed form.
static GROUPS: [Group; 16] = [
    Group { title: "Geometry", stages: &[Stage::Geometry] },
    Group { title: "Load", stages: &[Stage::Load, Stage::Masses] },
    Group { title: "Deviation", stages: &[Stage::Deviation] },
    Group { title: "Tip relief", stages: &[Stage::Clearing] },
    Group { title: "First contact D", stages: &[Stage::Position] },
    Group { title: "Velocity at D", stages: &[Stage::Velocity] },
    Group { title: "Impact", stages: &[Stage::Compliance, Stage::Impact, Stage::Band] },
    Group { title: "Friction", stages: &[Stage::Friction] },
    Group { title: "From D to E", stages: &[Stage::Stations] },
    Group { title: "Mesh", stages: &[Stage::Mesh] },
    Group { title: "Load sharing", stages: &[Stage::Static] },
    Group { title: "Load sharing with inertia", stages: &[Stage::Dynamic] },
    Group { title: "Resonance", stages: &[Stage::Resonance] },
    Group { title: "Transmission error without deviations", stages: &[Stage::StaticSpectrum] },
    Group { title: "Steady motion without deviations", stages: &[Stage::SteadyMotion] },
    Group { title: "Greatest dynamic factor over the speed", stages: &[Stage::SpeedRun] },
];

impl Group {
    /// Its quantities, in the order of the table.
    pub fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let stages = self.stages;
        QUANTITIES.iter().filter(move |quantity| stages.contains(&quantity.stage))
    }

    /// Whether the group belongs to the free impact while the method resolves the impact.
    #[must_use]
    pub fn is_beside(&self, method: Method) -> bool {
        method.shares_load() && self.quantities().any(Quantity::is_of_free_impact)
    }

    // The last stages first; the closed form of the resolved impact at the end.
    fn rank(&self, method: Method) -> usize {
        match self.stages {
            _ if !method.shares_load() => 0,
            [Stage::Dynamic] => 1,
            [Stage::Static] => 2,
            [
                Stage::Clearing
                | Stage::Mesh
                | Stage::Resonance
                | Stage::StaticSpectrum
                | Stage::SteadyMotion
                | Stage::SpeedRun,
            ] => 3,
            _ if self.is_beside(method) => 5,
            _ => 4,
        }
    }
}

/// The groups in the order of a method.
#[must_use]
pub fn groups(method: Method) -> Vec<&'static Group> {
    let mut groups: Vec<&Group> = GROUPS.iter().collect();
    groups.sort_by_key(|group| group.rank(method));
    groups
}

/// Every quantity in the same order.
pub fn quantities(method: Method) -> impl Iterator<Item = &'static Quantity> {
    groups(method).into_iter().flat_map(Group::quantities)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_is_in_one_group() {
        for method in Method::ALL {
            let mut keys: Vec<_> = quantities(method).map(|quantity| quantity.key).collect();
            keys.sort_unstable();
            let mut all: Vec<_> = QUANTITIES.iter().map(|quantity| quantity.key).collect();
            all.sort_unstable();
            assert_eq!(keys, all);
        }
    }

    #[test]
    fn groups_begin_with_the_last_stage_and_end_with_the_closed_form() {
        for (method, first) in [
            (Method::Exact, Stage::Geometry),
            (Method::Static, Stage::Static),
            (Method::Dynamic, Stage::Dynamic),
        ] {
            let own = quantities(method)
                .find(|quantity| quantity.stage == first || !method.shares_load());
            assert_eq!(own.map(|own| own.stage), Some(first));
        }
        let order: Vec<_> = quantities(Method::Dynamic).collect();
        assert_eq!(order[0].stage, Stage::Dynamic);
        assert!(order.is_sorted_by_key(|quantity| quantity.is_of_free_impact()));
    }
}
