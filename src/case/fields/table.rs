//! The table of fields itself: every line of the form, in order.

use super::Absent::{self, Default, Either, Refused, Without};
use super::{FLAG, Field, Kind, Range};
use crate::case::units::Dimension;
use crate::model::inputs::{ContactCompliance, Drive, Method, ReliefShape, ToothCompliance};

const fn range(from: f64, to: f64, unit: &'static str) -> Range {
    Range { from, to, unit }
}

const fn text(key: &'static str, label: &'static str, help: &'static str) -> Field {
    Field {
        key,
        symbol: "",
        label,
        help,
        kind: Kind::Text,
        absent: Absent::Default(""),
    }
}

macro_rules! number {
    ($key:expr, $symbol:expr, $label:expr, $dimension:ident, $from:expr, $to:expr, $unit:expr, $absent:expr, $put:expr, $help:expr) => {
        Field {
            key: $key,
            symbol: $symbol,
            label: $label,
            help: $help,
            kind: Kind::Number(Dimension::$dimension, range($from, $to, $unit), $put),
            absent: $absent,
        }
    };
}

macro_rules! gear {
    ($gear:ident, $i:literal) => {
        [
            Field {
                key: concat!(stringify!($gear), ".teeth"),
                symbol: concat!("z", $i),
                label: "number of teeth",
                help: "Whole number of teeth of the gear.",
                kind: Kind::Count(5, 1000, |inputs, value| inputs.$gear.teeth = value),
                absent: Refused,
            },
            number!(concat!(stringify!($gear), ".profile_shift"), concat!("x", $i), "profile shift", Number, -0.7, 1.2, "", Default("0"),
                |inputs, value| inputs.$gear.profile_shift = value, "Profile shift coefficient, times the module."),
            number!(concat!(stringify!($gear), ".addendum"), concat!("ha*", $i), "addendum", Number, 0.1, 2.0, "", Default("1"),
                |inputs, value| inputs.$gear.addendum = value, "Addendum coefficient, times the module: tip radius = m (z/2 + ha* + x)."),
            number!(concat!(stringify!($gear), ".dedendum"), concat!("hf*", $i), "dedendum", Number, 0.5, 2.0, "", Default("1.25"),
                |inputs, value| inputs.$gear.dedendum = value, "Dedendum coefficient of the cutting rack, times the module: root radius = m (z/2 - hf* + x)."),
            number!(concat!(stringify!($gear), ".face_width"), concat!("b", $i), "face width", Length, 0.1, 1000.0, "mm", Refused,
                |inputs, value| inputs.$gear.face_width = value, "Face width; the smaller of the two carries the contact."),
            number!(concat!(stringify!($gear), ".bore_radius"), concat!("rh", $i), "bore radius", Length, 0.0, 25000.0, "mm", Default("0 mm"),
                |inputs, value| inputs.$gear.bore_radius = value, "Radius of the bore: a radius, not a diameter."),
            number!(concat!(stringify!($gear), ".young"), concat!("E", $i), "Young's modulus", Pressure, 0.001, 1000.0, "GPa", Default("206 GPa"),
                |inputs, value| inputs.$gear.young = value, "Young's modulus of the gear's material."),
            number!(concat!(stringify!($gear), ".poisson"), concat!("ν", $i), "Poisson's ratio", Number, 0.0, 0.499, "", Default("0.3"),
                |inputs, value| inputs.$gear.poisson = value, "Poisson's ratio of the gear's material."),
            number!(concat!(stringify!($gear), ".density"), concat!("ρ", $i), "density", Density, 1.0, 50000.0, "kg/m3", Default("7800 kg/m3"),
                |inputs, value| inputs.$gear.density = value, "Density of the gear's material."),
            number!(concat!(stringify!($gear), ".tip_relief"), concat!("Ca", $i), "tip relief", Length, 0.0, 5000.0, "um", Default("0 um"),
                |inputs, value| inputs.$gear.tip_relief = value, "Material removed at the tip, normal to the flank."),
            number!(concat!(stringify!($gear), ".root_relief"), concat!("Cf", $i), "root relief", Length, 0.0, 5000.0, "um", Default("0 um"),
                |inputs, value| inputs.$gear.root_relief = value, "Material removed at the root, normal to the flank."),
            Field {
                key: concat!(stringify!($gear), ".tip_relief_length"),
                symbol: concat!("La", $i),
                label: "tip relief length",
                help: "Length of the tip relief along the path of contact, from the tip; paper and exact know the tip alone, where the whole relief acts.",
                kind: Kind::Number(Dimension::Length, range(0.0001, 1000.0, "mm"), |inputs, value| inputs.$gear.tip_relief_length = Some(value)),
                absent: Without("to single contact"),
            },
            Field {
                key: concat!(stringify!($gear), ".root_relief_length"),
                symbol: concat!("Lf", $i),
                label: "root relief length",
                help: "Length of the root relief along the path of contact, from its end at the root; static and dynamic alone.",
                kind: Kind::Number(Dimension::Length, range(0.0001, 1000.0, "mm"), |inputs, value| inputs.$gear.root_relief_length = Some(value)),
                absent: Without("to single contact"),
            },
            number!(concat!(stringify!($gear), ".tip_chamfer"), concat!("hk", $i), "tip chamfer", Length, 0.0, 50.0, "mm", Default("0 mm"),
                |inputs, value| inputs.$gear.tip_chamfer = value, "Radial height of the chamfer; shortens the active tip."),
            number!(concat!(stringify!($gear), ".tip_radius"), concat!("re", $i), "tip edge radius", Length, 0.0001, 50.0, "mm", Without("flank's own"),
                |inputs, value| inputs.$gear.tip_radius = Some(value), "Radius of the tip's edge; else the flank's own curvature counts."),
        ]
    };
}

const DRIVER: [Field; 15] = gear!(driver, "1");
const DRIVEN: [Field; 15] = gear!(driven, "2");

const HEAD: [Field; 5] = [
    text("title", "title", "A name for the case."),
    text("notes", "notes", "Where the numbers come from."),
    number!(
        "pair.module",
        "m",
        "module",
        Length,
        0.05,
        50.0,
        "mm",
        Refused,
        |inputs, value| inputs.module = value,
        "Module of both gears."
    ),
    number!(
        "pair.pressure_angle",
        "α",
        "pressure angle",
        Angle,
        14.5,
        30.0,
        "deg",
        Default("20 deg"),
        |inputs, value| inputs.pressure_angle = value,
        "Pressure angle of the basic rack."
    ),
    number!(
        "pair.centre_distance",
        "a",
        "centre distance",
        Length,
        0.1,
        100000.0,
        "mm",
        Without("no backlash"),
        |inputs, value| inputs.centre_distance = Some(value),
        "Centre distance; else from the profile shifts, without backlash."
    ),
];

const TAIL: [Field; 18] = [
    number!(
        "deviations.base_pitch",
        "f_pb",
        "base pitch deviation",
        Length,
        -5000.0,
        5000.0,
        "um",
        Default("0 um"),
        |inputs, value| inputs.base_pitch_deviation = value,
        "Base pitch deviation of each gear; counts twice in the equivalent error."
    ),
    number!(
        "deviations.backlash",
        "j_bn",
        "normal backlash",
        Length,
        0.0,
        5000.0,
        "um",
        Default("0 um"),
        |inputs, value| inputs.backlash = value,
        "Normal backlash, taken off the equivalent error (Eq. 1)."
    ),
    number!(
        "operation.power",
        "P",
        "power",
        Power,
        1e-12,
        1e12,
        "W",
        Either("operation.torque"),
        |inputs, value| inputs.drive = Drive::Power(value),
        "Power on the driver; give power or torque."
    ),
    number!(
        "operation.torque",
        "T1",
        "torque",
        Torque,
        1e-12,
        1e12,
        "N m",
        Either("operation.power"),
        |inputs, value| inputs.drive = Drive::Torque(value),
        "Torque on the driver; give power or torque."
    ),
    number!(
        "operation.speed",
        "n1",
        "speed",
        AngularVelocity,
        0.001,
        1e6,
        "rpm",
        Refused,
        |inputs, value| inputs.speed = value,
        "Speed of the driver."
    ),
    number!(
        "operation.friction_coefficient",
        "μ",
        "friction coefficient",
        Number,
        0.0,
        2.0,
        "",
        Without("not given"),
        |inputs, value| inputs.friction_coefficient = Some(value),
        "Coulomb friction coefficient: beside the kinematic ratio; in static and dynamic friction acts at the teeth."
    ),
    Field {
        key: "model.method",
        symbol: "",
        label: "method",
        help: "paper: as printed, typesetting mended. exact: exact position, free impact. static: load shared by all pairs. dynamic: with inertia. auto: the cheapest that will do.",
        kind: Kind::Choice(
            &["paper", "exact", "static", "dynamic", "auto"],
            |inputs, value| inputs.method = Method::ALL[value],
        ),
        absent: Default("exact"),
    },
    number!(
        "model.deflection",
        "δ",
        "combined deflection",
        Length,
        0.0,
        5000.0,
        "um",
        Without("from the load"),
        |inputs, value| inputs.deflection = Some(value),
        "Combined deflection of the loaded pair; else computed from the load."
    ),
    Field {
        key: "model.tooth_compliance",
        symbol: "q1,q2",
        label: "tooth compliance",
        help: ToothCompliance::HELP,
        kind: Kind::Choice(&ToothCompliance::NAMES, |inputs, value| {
            inputs.tooth_compliance = Some(ToothCompliance::ALL[value]);
        }),
        absent: Without("by the method"),
    },
    Field {
        key: "model.contact_compliance",
        symbol: "q_H",
        label: "contact compliance",
        help: ContactCompliance::HELP,
        kind: Kind::Choice(&ContactCompliance::NAMES, |inputs, value| {
            inputs.contact_compliance = ContactCompliance::ALL[value];
        }),
        absent: Default(ContactCompliance::NAMES[0]),
    },
    Field {
        key: "model.relief_shape",
        symbol: "",
        label: "relief shape",
        help: "How tip and root relief grow along the path of contact; static and dynamic alone.",
        kind: Kind::Choice(&["linear", "parabolic"], |inputs, value| {
            inputs.relief_shape = ReliefShape::ALL[value];
        }),
        absent: Default("linear"),
    },
    number!(
        "model.damping_ratio",
        "ζ",
        "damping ratio",
        Number,
        0.0,
        2.0,
        "",
        Default("0.07"),
        |inputs, value| inputs.damping_ratio = value,
        "Damping ratio of the mean mesh stiffness while a pair is in contact; dynamic alone."
    ),
    Field {
        key: "model.warmup_cycles",
        symbol: "",
        label: "warm-up cycles",
        help: "Base pitches that pass before the incoming tooth reaches E, from the static balance on; dynamic alone.",
        kind: Kind::Count(1, 10000, |inputs, value| inputs.warmup_cycles = value),
        absent: Default("20"),
    },
    number!(
        "model.tolerance",
        "",
        "tolerance",
        Number,
        1e-12,
        0.1,
        "",
        Default("1e-6"),
        |inputs, value| inputs.tolerance = value,
        "Relative error that the peak force may have, where the motion is damped; dynamic alone."
    ),
    number!(
        "model.within",
        "",
        "good enough within",
        Number,
        1e-6,
        1.0,
        "",
        Default("0.05"),
        |inputs, value| inputs.within = value,
        "Relative error against the method dynamic that the method auto may leave."
    ),
    Field {
        key: "model.stations",
        symbol: "n",
        label: "stations",
        help: "Intervals between D and E, and in static and dynamic as many again to the last contact; auto: as many as the curve needs.",
        kind: Kind::Count(1, 10000, |inputs, value| {
            inputs.stations = (value > 0).then_some(value as usize);
        }),
        absent: Default("64"),
    },
    number!(
        "model.station_tolerance",
        "",
        "station tolerance",
        Number,
        1e-9,
        0.1,
        "",
        Default("1e-3"),
        |inputs, value| inputs.station_tolerance = value,
        "How far the curve may lie off the lines between stations, over its peak; with stations = \"auto\" alone."
    ),
    Field {
        key: "model.accurate",
        symbol: "",
        label: "accurate",
        help: "Geometry and position in double-double arithmetic: the last digit, for some twenty times the cost.",
        kind: Kind::Choice(FLAG, |inputs, value| inputs.accurate = value == 1),
        absent: Default("false"),
    },
];

/// Every field, in the order of the form and of a new file.
pub static FIELDS: [Field; 53] = table();

const fn table() -> [Field; 53] {
    let mut all = [HEAD[0]; 53];
    let parts: [&[Field]; 4] = [&HEAD, &DRIVER, &DRIVEN, &TAIL];
    let (mut part, mut at) = (0, 0);
    while part < parts.len() {
        let mut index = 0;
        while index < parts[part].len() {
            all[at] = parts[part][index];
            at += 1;
            index += 1;
        }
        part += 1;
    }
    all
}
