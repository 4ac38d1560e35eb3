//! The one table of what each value of a solve reads: fields, and other values.

use std::sync::LazyLock;

use crate::model::Stage::{
    self, Band, Clearing, Compliance, Deviation, Dynamic, Friction, Geometry, Impact, Load, Mesh,
    Position, Static, Stations, Velocity,
};
use crate::model::compliance::contact::{self, ContactModel};
use crate::model::compliance::model_of;
use crate::model::compliance::tooth::{self, ToothModel};
use crate::model::inputs::{Drive, Inputs, Method};

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

const fn always(_: &Inputs) -> bool {
    true
}

/// Whether the method stands on one impact, and not on the load that every pair shares.
fn by_impact(inputs: &Inputs) -> bool {
    !inputs.method.shares_load()
}

/// Whether the load is shared, or may be where the method is yet to be chosen.
fn by_sharing(inputs: &Inputs) -> bool {
    inputs.method.shares_load() || by_choice(inputs)
}

fn by_choice(inputs: &Inputs) -> bool {
    inputs.method == Method::Auto
}

fn not_paper(inputs: &Inputs) -> bool {
    !paper(inputs)
}

fn paper(inputs: &Inputs) -> bool {
    inputs.method == Method::Paper
}

fn as_needed(inputs: &Inputs) -> bool {
    inputs.stations.is_none()
}

fn by_power(inputs: &Inputs) -> bool {
    matches!(inputs.drive, Drive::Power(_))
}

fn distance_given(inputs: &Inputs) -> bool {
    inputs.centre_distance.is_some()
}

fn distance_free(inputs: &Inputs) -> bool {
    inputs.centre_distance.is_none()
}

fn deflection_free(inputs: &Inputs) -> bool {
    inputs.deflection.is_none() || by_sharing(inputs)
}

fn method_free(inputs: &Inputs) -> bool {
    inputs.tooth_compliance.is_none()
}

fn with_inertia(inputs: &Inputs) -> bool {
    inputs.method == Method::Dynamic || by_choice(inputs)
}

/// Whether the pressing of a tip's edge counts off the line of action.
fn tips_press(inputs: &Inputs) -> bool {
    by_sharing(inputs) && by_half_width(inputs)
}

fn by_half_width(inputs: &Inputs) -> bool {
    inputs.contact_compliance.model().reads_half_width
}

/// Every row.
pub(super) static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let mut rows = TABLE.to_vec();
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

/// Every value, in the order the data flows; the compliance models name what else they read.
#[rustfmt::skip]
static TABLE: &[Row] = &[
    part("method", always, &["model.method"]),
    part("method", by_choice, &["model.within", "mesh_force", "total_deviation", "impact_force", "impact_duration_spring", "impulse_ratio", "transit_time", "reduced_mass", "contact_ratio"]),
    part("spacing", always, &["model.stations"]),
    part("spacing", as_needed, &["model.station_tolerance"]),

    row("base_circle_driver", Geometry, always, &["pair.module", "pair.pressure_angle", "driver.teeth", "model.accurate"]),
    row("base_circle_driven", Geometry, always, &["pair.module", "pair.pressure_angle", "driven.teeth", "model.accurate"]),
    row("tip_circle_driver", Geometry, always, &["base_circle_driver", "driver.profile_shift", "driver.addendum", "driver.tip_chamfer"]),
    row("tip_circle_driven", Geometry, always, &["base_circle_driven", "driven.profile_shift", "driven.addendum", "driven.tip_chamfer"]),
    row("root_circles", Geometry, always, &["pair.module", "*.teeth", "*.profile_shift", "*.dedendum"]),
    row("base_pitch", Geometry, always, &["pair.module", "pair.pressure_angle", "model.accurate"]),
    row("centre_distance", Geometry, always, &["pair.centre_distance"]),
    row("centre_distance", Geometry, distance_free, &["base_circle_driver", "base_circle_driven", "working_pressure_angle"]),
    row("working_pressure_angle", Geometry, distance_given, &["pair.centre_distance", "base_circle_driver", "base_circle_driven"]),
    row("working_pressure_angle", Geometry, distance_free, &["pair.centre_distance", "pair.pressure_angle", "*.teeth", "*.profile_shift", "model.accurate"]),
    row("line_of_action", Geometry, always, &["base_circle_driver", "base_circle_driven", "centre_distance", "working_pressure_angle"]),
    row("start_of_contact", Geometry, always, &["line_of_action", "tip_circle_driven"]),
    row("end_of_contact", Geometry, always, &["line_of_action", "tip_circle_driver"]),
    row("contact_ratio", Geometry, always, &["start_of_contact", "end_of_contact", "base_pitch"]),

    row("mesh_force", Load, always, &["operation.power", "operation.torque", "base_circle_driver"]),
    row("mesh_force", Load, by_power, &["operation.speed"]),
    part("masses", always, &["*.density", "*.face_width", "*.bore_radius", "base_circle_driver", "base_circle_driven"]),
    row("reduced_mass", Load, always, &["masses"]),

    part("tooth_method", always, &["model.tooth_compliance"]),
    part("tooth_stiffness", always, &["tooth_method", "pair.module", "*.teeth", "*.profile_shift", "base_circle_driver", "base_circle_driven"]),
    part("profile", always, &["pair.pressure_angle", "root_circles", "base_circle_driver", "base_circle_driven"]),
    part("materials", always, &["*.young", "*.poisson"]),
    part("contact_stiffness", always, &["model.contact_compliance", "materials"]),
    part("contact_stiffness", by_half_width, &["*.face_width"]),
    row("equivalent_error", Deviation, always, &["deviations.base_pitch", "deviations.backlash", "method"]),
    row("equivalent_error", Deviation, by_impact, &["driven.tip_relief", "driver.root_relief"]),
    row("modification", Deviation, always, &["driven.tip_relief", "driver.root_relief"]),
    row("combined_deflection", Deviation, always, &["method"]),
    row("combined_deflection", Deviation, by_impact, &["model.deflection"]),
    row("combined_deflection", Deviation, deflection_free, &["mesh_force", "start_of_contact", "end_of_contact", "base_pitch", "tooth_stiffness", "contact_stiffness", "*.face_width"]),
    row("total_deviation", Deviation, always, &["equivalent_error", "combined_deflection", "driven.tip_relief", "driver.root_relief"]),

    row("approach_angle_driven", Position, always, &["total_deviation", "start_of_contact", "method"]),
    row("approach_angle_driven", Position, paper, &["base_pitch"]),
    row("approach_angle_driver", Position, always, &["approach_angle_driven"]),
    row("contact_radius_driver", Position, always, &["approach_angle_driven"]),
    row("contact_normal_radius_driven", Position, always, &["approach_angle_driven"]),
    row("curvature_radius", Position, always, &["approach_angle_driven", "driven.tip_radius"]),
    row("closed_gap", Position, always, &["total_deviation", "method"]),
    row("closed_gap", Position, paper, &["approach_angle_driven"]),
    row("end_of_flank", Position, always, &["approach_angle_driven", "end_of_contact"]),

    row("transit_time", Velocity, always, &["approach_angle_driven", "operation.speed"]),
    row("normal_velocity", Velocity, always, &["approach_angle_driven", "operation.speed"]),
    row("sliding_velocity", Velocity, always, &["approach_angle_driven", "operation.speed"]),
    row("stick_limit", Velocity, always, &["normal_velocity", "sliding_velocity"]),

    row("teeth_compliance", Compliance, always, &["approach_angle_driven", "tooth_stiffness", "tip_circle_driven"]),

    row("effective_mass", Impact, always, &["masses", "contact_normal_radius_driven"]),
    row("impact_force", Impact, always, &["normal_velocity", "effective_mass", "teeth_compliance", "contact_stiffness", "*.face_width"]),
    row("impact_force", Impact, by_half_width, &["curvature_radius"]),
    row("pair_compliance", Impact, always, &["teeth_compliance", "contact_stiffness"]),
    row("pair_compliance", Impact, by_half_width, &["impact_force"]),
    row("hertz_half_width", Impact, always, &["impact_force", "curvature_radius", "materials", "*.face_width"]),
    row("impact_energy", Impact, always, &["effective_mass", "normal_velocity"]),
    row("sliding_energy", Impact, always, &["effective_mass", "sliding_velocity"]),
    row("dynamic_factor", Impact, always, &["impact_force", "mesh_force"]),
    row("impact_duration_printed", Impact, always, &["reduced_mass", "normal_velocity", "curvature_radius", "materials"]),
    row("impact_duration_hertz", Impact, always, &["impact_duration_printed"]),
    row("impact_duration_spring", Impact, always, &["effective_mass", "pair_compliance", "*.face_width"]),
    row("impact_duration", Impact, always, &["method"]),
    row("impact_duration", Impact, paper, &["impact_duration_printed"]),
    row("impact_duration", Impact, not_paper, &["impact_duration_spring"]),
    row("impulse_ratio", Impact, always, &["impact_force", "impact_duration", "effective_mass", "normal_velocity"]),

    row("friction_ratio", Friction, always, &["approach_angle_driven", "operation.speed", "impact_force", "impact_duration_printed", "reduced_mass", "method"]),

    part("every_model", always, &["materials", "*.face_width"]),
    row("impact_force_low", Band, always, &["impact_force", "every_model", "curvature_radius"]),
    row("impact_force_high", Band, always, &["impact_force", "every_model", "curvature_radius"]),

    row("stations", Stations, always, &["method"]),
    row("stations", Stations, by_impact, &["impact_force", "spacing"]),

    part("reliefs", always, &["*.tip_relief", "*.root_relief", "*.tip_relief_length", "*.root_relief_length", "start_of_contact", "end_of_contact", "contact_ratio"]),
    row("mesh_stiffness", Mesh, always, &["method"]),
    row("mesh_stiffness", Mesh, by_sharing, &["mesh_force", "start_of_contact", "end_of_contact", "base_pitch", "tooth_stiffness", "contact_stiffness", "*.face_width", "reliefs"]),
    part("mesh", by_sharing, &["mesh_stiffness", "reliefs", "model.relief_shape", "equivalent_error", "combined_deflection", "operation.friction_coefficient"]),
    row("pairs_along_the_line", Mesh, by_sharing, &["mesh", "edges", "operation.speed"]),
    part("edges", tips_press, &["*.tip_radius"]),
    row("static_first_contact_angle", Static, by_sharing, &["mesh"]),
    row("static_first_contact_angle", Static, tips_press, &["driver.tip_radius"]),
    row("static_first_contact_angle_driver", Static, by_sharing, &["static_first_contact_angle"]),
    row("static_force_at_start", Static, by_sharing, &["mesh", "edges"]),
    row("static_peak_force", Static, by_sharing, &["mesh", "edges"]),
    row("static_last_contact_angle", Static, by_sharing, &["mesh"]),
    row("static_last_contact_angle", Static, tips_press, &["driven.tip_radius"]),
    row("static_transmission_error", Static, by_sharing, &["mesh", "edges"]),
    row("pitch_contact_jump", Static, by_sharing, &["mesh", "edges"]),
    row("static_stations", Static, always, &["method"]),
    row("static_stations", Static, by_sharing, &["mesh", "edges", "spacing", "operation.speed"]),

    part("motion", with_inertia, &["mesh", "edges", "masses", "operation.speed", "model.damping_ratio", "model.warmup_cycles", "model.tolerance"]),
    row("dynamic_first_contact_angle", Dynamic, always, &["motion"]),
    row("dynamic_first_contact_angle_driver", Dynamic, always, &["dynamic_first_contact_angle"]),
    row("dynamic_peak_approach_force", Dynamic, always, &["motion"]),
    row("dynamic_peak_force", Dynamic, always, &["motion"]),
    row("dynamic_impact_duration", Dynamic, always, &["motion"]),
    row("dynamic_last_contact_angle", Dynamic, always, &["motion"]),
    row("dynamic_contact_lost", Dynamic, always, &["motion"]),
    row("dynamic_friction_work", Dynamic, always, &["motion"]),
    row("dynamic_stations", Dynamic, always, &["method"]),
    row("dynamic_stations", Dynamic, with_inertia, &["motion", "spacing"]),

    row("clearing_relief", Clearing, always, &["total_deviation", "method"]),
    row("clearing_relief", Clearing, paper, &["start_of_contact", "base_pitch"]),
    row("clearing_relief", Clearing, by_sharing, &["mesh"]),
    row("clearing_relief", Clearing, tips_press, &["driver.tip_radius"]),
    row("clearing_relief", Clearing, with_inertia, &["motion"]),
];
