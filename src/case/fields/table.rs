//! The table of fields itself: every line of the form, in order.

macro_rules! number {
    ($key:expr, $symbol:expr, $label:expr, $dimension:ident, $from:expr, $to:expr, $unit:expr, $absent:expr, $put:expr, $help:expr) => {
        Field {
            key: $key,
            symbol: $symbol,
            label: $label,
            help: $help,
            kind: Kind::Number(Dimension::$dimension, Range::new($from, $to, $unit), $put),
            absent: $absent,
            ..Field::PLAIN
        }
    };
}

mod gear;

use super::Absent::{Default, Either, Refused, Without};
use super::reasons::Reason::{Beside, Idle, Partly};
use super::reasons::{CURVE, IN_TIME, LOAD, MASS, WHOLE_RELIEF, always};
use super::{FLAG, Field, Kind, Range};
use crate::case::units::Dimension;
use crate::model::compliance::contact_of;
use crate::model::inputs::{
    ContactCompliance, Drive, InertiaModel, Method, ReliefShape, ToothCompliance,
};
use gear::{DRIVEN, DRIVER};

const fn text(key: &'static str, label: &'static str, help: &'static str) -> Field {
    Field {
        key,
        label,
        help,
        ..Field::PLAIN
    }
}

const HEAD: &[Field] = &[
    text("title", "title", "A name for the case.").reasons(&[Beside("a name for people")]),
    text("notes", "notes", "Sources of the data.").reasons(&[Beside("words for people")]),
    number!(
        "pair.module",
        "m",
        "module",
        Length,
        0.05,
        50.0,
        "mm",
        Either,
        |inputs, value| inputs.module = value,
        "Module of both gears; give either the module or the diametral pitch."
    )
    .with_example("5 mm")
    .instead_of("pair.diametral_pitch", |inputs| {
        (inputs.module > 0.0).then_some(inputs.module)
    }),
    number!(
        "pair.diametral_pitch",
        "Pd",
        "diametral pitch",
        DiametralPitch,
        0.508,
        508.0,
        "1/in",
        Either,
        |inputs, value| inputs.module = 1.0 / value,
        "Diametral pitch of both gears, the reciprocal of the module; replaces the module."
    )
    .with_example("8 1/in")
    .instead_of("pair.module", |inputs| {
        (inputs.module > 0.0).then(|| 1.0 / inputs.module)
    }),
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
    )
    .with_example("100 mm"),
];

const TAIL: &[Field] = &[
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
        "Base pitch deviation of each gear without its own; independent deviations add as sqrt(f_pb1^2 + f_pb2^2)."
    ).reasons(&[Idle(
        always,
        "both gears have their own base pitch deviation",
    )]),
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
        "Normal backlash; reduces the equivalent error (Eq. 1); in dynamic also the way to the back flanks."
    ),
    number!(
        "operation.power",
        "P",
        "power",
        Power,
        1e-12,
        1e12,
        "W",
        Either,
        |inputs, value| inputs.drive = Drive::Power(value),
        "Power on the driver; give power or torque."
    ).with_example("15 kW").instead_of("operation.torque", |inputs| {
        let power = inputs.torque() * inputs.speed;
        (inputs.speed > 0.0 && power > 0.0).then_some(power)
    }).reasons(&LOAD),
    number!(
        "operation.torque",
        "T1",
        "torque",
        Torque,
        1e-12,
        1e12,
        "N m",
        Either,
        |inputs, value| inputs.drive = Drive::Torque(value),
        "Torque on the driver; give power or torque."
    ).with_example("71.6 N m").instead_of("operation.power", |inputs| {
        let torque = inputs.torque();
        (inputs.speed > 0.0 && torque > 0.0).then_some(torque)
    }).reasons(&LOAD),
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
    ).with_example("2000 rpm").reasons(&[Partly(
        |inputs| inputs.method == Method::Static && matches!(inputs.drive, Drive::Torque(_)),
        "with a given torque, the static load does not depend on speed; only the free impact \
            changes",
    )]),
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
        "Coulomb friction coefficient; static and dynamic apply friction at the teeth."
    ).with_example("0.06").reasons(&[Beside(
        "a note compares it with the stick limit; no quantity of this method depends on it",
    )]),
    Field {
        key: "model.method",
        symbol: "",
        label: "method",
        help: "paper: as printed, misprints fixed. exact: exact position, free impact. static: all pairs share the load. dynamic: with inertia. auto: the fastest within the tolerance.",
        kind: Kind::Choice(
            &["paper", "exact", "static", "dynamic", "auto"],
            |inputs, value| inputs.method = Method::ALL[value],
        ),
        absent: Default("exact"),
        ..Field::PLAIN
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
    ).with_example("24.7 um").reasons(&[Idle(
        |inputs| inputs.method.shares_load(),
        "this method computes the deflection from the load",
    )]),
    Field {
        key: "model.tooth_compliance",
        symbol: "q1,q2",
        label: "tooth compliance",
        help: ToothCompliance::HELP,
        kind: Kind::Choice(&ToothCompliance::NAMES, |inputs, value| {
            inputs.tooth_compliance = Some(ToothCompliance::ALL[value]);
        }),
        absent: Without("by the method"),
        ..Field::PLAIN
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
        ..Field::PLAIN
    }.reasons(&[Idle(
        |inputs| contact_of(inputs).is_none(),
        "the tooth compliance of this case includes the contact",
    )]),
    Field {
        key: "model.inertia",
        symbol: "",
        label: "inertia model",
        help: "outline: inertia of the true gear outline. base-circle: inertia of a disc up to \
            the base circle, Eq. 47; method paper always uses the disc.",
        kind: Kind::Choice(&["outline", "base-circle"], |inputs, value| {
            inputs.inertia = InertiaModel::ALL[value];
        }),
        absent: Default("outline"),
        ..Field::PLAIN
    }.reasons(&[
        Idle(
            |inputs| inputs.method == Method::Paper,
            "method paper uses the disc to the base circle, Eq. 47",
        ),
        Idle(always, "the inertia of both gears is given"),
        MASS[0],
    ]),
    Field {
        key: "model.relief_shape",
        symbol: "",
        label: "relief shape",
        help: "How tip and root relief grow along the path of contact; static and dynamic alone.",
        kind: Kind::Choice(&["linear", "parabolic"], |inputs, value| {
            inputs.relief_shape = ReliefShape::ALL[value];
        }),
        absent: Default("linear"),
        ..Field::PLAIN
    }.reasons(&WHOLE_RELIEF),
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
    ).reasons(&[Idle(always, IN_TIME)]),
    Field {
        key: "model.warmup_cycles",
        symbol: "",
        label: "warm-up cycles",
        help: "Number of base pitches between the start of the motion, at static balance, and E; \
            method dynamic only.",
        kind: Kind::Count(1, 10000, |inputs, value| inputs.warmup_cycles = value),
        absent: Default("20"),
        ..Field::PLAIN
    }.reasons(&[Idle(always, IN_TIME)]),
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
        "Permitted relative error of the peak force of a damped motion; dynamic alone."
    ).read_when(|inputs| inputs.method == Method::Dynamic)
    .reasons(&[
        Idle(
            |inputs| inputs.method == Method::Auto,
            "method auto derives the tolerance from model.within",
        ),
        Idle(always, IN_TIME),
        Partly(always, "changes results by no more than itself"),
    ]),
    number!(
        "model.within",
        "",
        "permitted error",
        Number,
        1e-6,
        1.0,
        "",
        Default("0.05"),
        |inputs, value| inputs.within = value,
        "Permitted relative error of the method auto against the method dynamic."
    ).read_when(|inputs| inputs.method == Method::Auto).reasons(&[Idle(
        always,
        "only the method auto chooses by a permitted error",
    )]),
    Field {
        key: "model.stations",
        symbol: "n",
        label: "stations",
        help: "Intervals between D and E, and in static and dynamic as many again to the last contact; auto: as many as the curve needs.",
        kind: Kind::Count(1, 10000, |inputs, value| {
            inputs.stations = (value > 0).then_some(value as usize);
        }),
        absent: Default("64"),
        ..Field::PLAIN
    }.reasons(&[Partly(always, CURVE)]),
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
        "Permitted distance of the curve from the lines between stations, over its peak; used with stations = \"auto\"."
    ).read_when(|inputs| inputs.stations.is_none()).reasons(&[
        Idle(
            |inputs| inputs.stations.is_some(),
            "the case gives the number of stations",
        ),
        Partly(always, CURVE),
    ]),
    Field {
        key: "model.accurate",
        symbol: "",
        label: "accurate",
        help: "Computes geometry and position in double-double arithmetic: relative error below \
            1e-13 instead of 1e-12, with a longer run time.",
        kind: Kind::Choice(FLAG, |inputs, value| inputs.accurate = value == 1),
        absent: Default("false"),
        ..Field::PLAIN
    }.reasons(&[Partly(
        always,
        "changes only digits beyond those shown",
    )]),
];

/// The rows by groups, in the order of the form and of a new file.
const PARTS: [&[Field]; 4] = [HEAD, DRIVER, DRIVEN, TAIL];

const COUNT: usize = HEAD.len() + DRIVER.len() + DRIVEN.len() + TAIL.len();

/// Every field, in the order of the form and of a new file.
pub static FIELDS: [Field; COUNT] = {
    let mut all = [Field::PLAIN; COUNT];
    let (mut part, mut at) = (0, 0);
    while part < PARTS.len() {
        let mut row = 0;
        while row < PARTS[part].len() {
            all[at] = PARTS[part][row];
            (at, row) = (at + 1, row + 1);
        }
        part += 1;
    }
    all
};
