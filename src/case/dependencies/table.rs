//! The one table of what each value of a solve reads: fields, and other values.

use std::sync::LazyLock;

use crate::model::compliance::contact::{self, ContactModel};
use crate::model::compliance::tooth::{self, ToothModel};
use crate::model::compliance::{contact_of, model_of};
use crate::model::inputs::Inputs;
use crate::model::quantities::conditions::{
    always, auto, contact_read, edges_read, free_impact, half_width_read, may_move, may_share_load,
};
use crate::model::{QUANTITIES, Quantity};

/// What a value reads directly, in the cases that the condition names.
#[derive(Clone)]
pub(super) struct Row {
    /// A quantity's key, or the name of a value that has no page of its own.
    pub(super) value: &'static str,
    /// The cases in which it reads these.
    pub(super) when: When,
    /// Fields by their keys, `*` standing for both gears, and other values by their names.
    pub(super) reads: &'static [&'static str],
}

/// The cases in which a row counts.
#[derive(Clone, Copy)]
pub(super) enum When {
    Is(fn(&Inputs) -> bool),
    Tooth(&'static ToothModel),
    Contact(&'static ContactModel),
}

impl When {
    pub(super) fn is_true(self, inputs: &Inputs) -> bool {
        match self {
            When::Is(condition) => condition(inputs),
            When::Tooth(model) => model_of(inputs).name() == model.name,
            When::Contact(model) => {
                contact_of(inputs).is_some_and(|contact| contact.name() == model.name)
            }
        }
    }
}

impl Row {
    /// Whether it reads the field itself.
    pub(super) fn reads_field(&self, key: &str) -> bool {
        self.reads
            .iter()
            .any(|&read| match read.strip_prefix("*.") {
                Some(name) => key.split_once('.').is_some_and(|(table, rest)| {
                    rest == name && matches!(table, "driver" | "driven")
                }),
                None => read == key,
            })
    }
}

const fn part(
    value: &'static str,
    when: fn(&Inputs) -> bool,
    reads: &'static [&'static str],
) -> Row {
    Row {
        value,
        when: When::Is(when),
        reads,
    }
}

fn as_needed(inputs: &Inputs) -> bool {
    inputs.stations.is_none()
}

fn method_free(inputs: &Inputs) -> bool {
    inputs.tooth_compliance.is_none()
}

/// Every row: the table below, the quantities and the compliance models.
pub(super) static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let of = |quantity: &'static Quantity| {
        quantity.reads.iter().map(|&(when, reads)| Row {
            value: quantity.key,
            when: When::Is(when),
            reads,
        })
    };
    let mut rows = TABLE.to_vec();
    rows.extend(QUANTITIES.iter().flat_map(of));
    let part = |value, when, reads| Row { value, when, reads };
    for model in tooth::MODELS {
        rows.push(part(
            "tooth_method",
            When::Is(method_free),
            model.range_reads,
        ));
        rows.push(part("tooth_stiffness", When::Tooth(model), model.reads));
        rows.push(part("every_model", When::Is(always), model.range_reads));
        rows.push(part("every_model", When::Is(always), model.reads));
    }
    for model in contact::MODELS {
        rows.push(part("contact_stiffness", When::Contact(model), model.reads));
        rows.push(part("every_model", When::Is(always), model.reads));
    }
    rows
});

/// The values that are no quantity, in the order the data flows. A quantity names in its row what
/// it reads, and so does a compliance model.
#[rustfmt::skip]
static TABLE: &[Row] = &[
    part("method", always, &["model.method"]),
    part("method", auto, &["model.within", "mesh_force", "total_deviation", "impact_force", "impact_duration_spring", "impulse_ratio", "transit_time", "reduced_mass", "contact_ratio"]),
    part("spacing", always, &["model.stations"]),
    part("spacing", as_needed, &["model.station_tolerance"]),

    part("base_circle_driver", always, &["pair.module", "pair.pressure_angle", "driver.teeth", "model.accurate"]),
    part("base_circle_driven", always, &["pair.module", "pair.pressure_angle", "driven.teeth", "model.accurate"]),
    part("tip_circle_driver", always, &["base_circle_driver", "driver.profile_shift", "driver.addendum", "driver.tip_chamfer"]),
    part("tip_circle_driven", always, &["base_circle_driven", "driven.profile_shift", "driven.addendum", "driven.tip_chamfer"]),
    part("root_circles", always, &["pair.module", "*.teeth", "*.profile_shift", "*.dedendum"]),
    part("line_of_action", always, &["base_circle_driver", "base_circle_driven", "centre_distance", "working_pressure_angle"]),
    part("start_of_contact", always, &["line_of_action", "tip_circle_driven"]),
    part("end_of_contact", always, &["line_of_action", "tip_circle_driver"]),

    part("masses", always, &["*.density", "*.face_width", "*.bore_radius", "base_circle_driver", "base_circle_driven"]),

    part("tooth_method", always, &["model.tooth_compliance"]),
    part("tooth_method", method_free, &["model.method"]),
    part("tooth_stiffness", always, &["tooth_method", "pair.module", "*.teeth", "*.profile_shift", "base_circle_driver", "base_circle_driven"]),
    part("profile", always, &["pair.pressure_angle", "root_circles", "base_circle_driver", "base_circle_driven"]),
    part("materials", always, &["*.young", "*.poisson"]),
    part("contact_stiffness", always, &["tooth_method", "materials"]),
    part("contact_stiffness", contact_read, &["model.contact_compliance"]),
    part("contact_stiffness", half_width_read, &["*.face_width"]),

    part("end_of_flank", always, &["approach_angle_driven", "end_of_contact"]),

    part("teeth_compliance", always, &["approach_angle_driven", "tooth_stiffness", "tip_circle_driven"]),

    part("every_model", always, &["materials", "*.face_width"]),

    part("stations", always, &["method"]),
    part("stations", free_impact, &["impact_force", "spacing"]),

    part("reliefs", always, &["*.tip_relief", "*.root_relief", "*.tip_relief_length", "*.root_relief_length", "start_of_contact", "end_of_contact", "contact_ratio"]),
    part("mesh", may_share_load, &["mesh_stiffness", "reliefs", "model.relief_shape", "equivalent_error", "combined_deflection", "operation.friction_coefficient"]),
    part("pairs_along_the_line", may_share_load, &["mesh", "edges", "operation.speed"]),
    part("edges", edges_read, &["*.tip_radius"]),
    part("static_stations", always, &["method"]),
    part("static_stations", may_share_load, &["mesh", "edges", "spacing", "operation.speed"]),

    part("motion", may_move, &["mesh", "edges", "masses", "operation.speed", "model.damping_ratio", "model.warmup_cycles", "model.tolerance"]),
    part("dynamic_stations", always, &["method"]),
    part("dynamic_stations", may_move, &["motion", "spacing"]),
];
