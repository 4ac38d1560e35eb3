//! Rows of the model: method, compliance, inertia, numerical settings.

use crate::case::fields::Absent::{Default, Without};
use crate::case::fields::reasons::Reason::{Idle, Partly};
use crate::case::fields::reasons::{CURVE, IN_TIME, MASS, WHOLE_RELIEF, always};
use crate::case::fields::{FLAG, Field, Kind, Range};
use crate::case::units::Dimension;
use crate::model::compliance::contact_of;
use crate::model::inputs::{ContactCompliance, InertiaModel, Method, ReliefShape, ToothCompliance};

pub(super) const MODEL: &[Field] = &[
    Field {
        key: "model.method",
        symbol: "",
        label: "method",
        help: "paper: as printed, misprints fixed. exact: exact position, free impact. static: all pairs share the load. dynamic: with inertia. auto: the fastest within the tolerance.",
        kind: Kind::Choice(
            &["paper", "exact", "static", "dynamic", "auto"],
            |inputs, value| inputs.method = Method::ALL[value],
        ),
        absent: Default("auto"),
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
        Partly(always, "changes results by at most its own value"),
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
