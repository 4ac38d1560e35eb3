//! The one table of what each value of a solve reads: fields, and other values.

use std::sync::LazyLock;

use crate::model::Stage::{self, Compliance, Dynamic, Geometry, Mesh, Position, Static, Stations};
use crate::model::compliance::contact::{self, ContactModel};
use crate::model::compliance::model_of;
use crate::model::compliance::tooth::{self, ToothModel};
use crate::model::inputs::Inputs;
use crate::model::quantities::conditions::{
    always, auto, edges_read, free_impact, half_width_read, may_move, may_share_load,
};
use crate::model::{QUANTITIES, Quantity};

/// What a value reads directly, in the cases that the condition names.
#[derive(Clone)]
pub(super) struct Row {
    /// A quantity's key, or the name of a value that has no page of its own.
    pub(super) value: &'static str,
    /// The stage whose result it is; none for a part of other values, which each stage works out
    /// for itself.
    pub(super) stage: Option<Stage>,
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
            When::Contact(model) => inputs.contact_compliance.name() == model.name,
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

const fn row(
    value: &'static str,
    stage: Stage,
    when: fn(&Inputs) -> bool,
    reads: &'static [&'static str],
) -> Row {
    Row {
        value,
        stage: Some(stage),
        when: When::Is(when),
        reads,
    }
}

const fn part(
    value: &'static str,
    when: fn(&Inputs) -> bool,
    reads: &'static [&'static str],
) -> Row {
    Row {
        value,
        stage: None,
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
            stage: Some(quantity.stage),
            when: When::Is(when),
            reads,
        })
    };
    let mut rows = TABLE.to_vec();
    rows.extend(QUANTITIES.iter().flat_map(of));
    let part = |value, when, reads| Row {
        value,
        stage: None,
        when,
        reads,
    };
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

    row("base_circle_driver", Geometry, always, &["pair.module", "pair.pressure_angle", "driver.teeth", "model.accurate"]),
    row("base_circle_driven", Geometry, always, &["pair.module", "pair.pressure_angle", "driven.teeth", "model.accurate"]),
    row("tip_circle_driver", Geometry, always, &["base_circle_driver", "driver.profile_shift", "driver.addendum", "driver.tip_chamfer"]),
    row("tip_circle_driven", Geometry, always, &["base_circle_driven", "driven.profile_shift", "driven.addendum", "driven.tip_chamfer"]),
    row("root_circles", Geometry, always, &["pair.module", "*.teeth", "*.profile_shift", "*.dedendum"]),
    row("line_of_action", Geometry, always, &["base_circle_driver", "base_circle_driven", "centre_distance", "working_pressure_angle"]),
    row("start_of_contact", Geometry, always, &["line_of_action", "tip_circle_driven"]),
    row("end_of_contact", Geometry, always, &["line_of_action", "tip_circle_driver"]),

    part("masses", always, &["*.density", "*.face_width", "*.bore_radius", "base_circle_driver", "base_circle_driven"]),

    part("tooth_method", always, &["model.tooth_compliance"]),
    part("tooth_stiffness", always, &["tooth_method", "pair.module", "*.teeth", "*.profile_shift", "base_circle_driver", "base_circle_driven"]),
    part("profile", always, &["pair.pressure_angle", "root_circles", "base_circle_driver", "base_circle_driven"]),
    part("materials", always, &["*.young", "*.poisson"]),
    part("contact_stiffness", always, &["model.contact_compliance", "materials"]),
    part("contact_stiffness", half_width_read, &["*.face_width"]),

    row("end_of_flank", Position, always, &["approach_angle_driven", "end_of_contact"]),

    row("teeth_compliance", Compliance, always, &["approach_angle_driven", "tooth_stiffness", "tip_circle_driven"]),

    part("every_model", always, &["materials", "*.face_width"]),

    row("stations", Stations, always, &["method"]),
    row("stations", Stations, free_impact, &["impact_force", "spacing"]),

    part("reliefs", always, &["*.tip_relief", "*.root_relief", "*.tip_relief_length", "*.root_relief_length", "start_of_contact", "end_of_contact", "contact_ratio"]),
    part("mesh", may_share_load, &["mesh_stiffness", "reliefs", "model.relief_shape", "equivalent_error", "combined_deflection", "operation.friction_coefficient"]),
    row("pairs_along_the_line", Mesh, may_share_load, &["mesh", "edges", "operation.speed"]),
    part("edges", edges_read, &["*.tip_radius"]),
    row("static_stations", Static, always, &["method"]),
    row("static_stations", Static, may_share_load, &["mesh", "edges", "spacing", "operation.speed"]),

    part("motion", may_move, &["mesh", "edges", "masses", "operation.speed", "model.damping_ratio", "model.warmup_cycles", "model.tolerance"]),
    row("dynamic_stations", Dynamic, always, &["method"]),
    row("dynamic_stations", Dynamic, may_move, &["motion", "spacing"]),
];
