//! Rows of deviations and operation.

use crate::case::fields::Absent::{Default, Either, Refused, Without};
use crate::case::fields::reasons::Reason::{Beside, Idle, Partly};
use crate::case::fields::reasons::{LOAD, always};
use crate::case::fields::{Field, Kind, Range};
use crate::case::units::Dimension;
use crate::model::inputs::{Combination, Drive, Method};

pub(super) const OPERATION: &[Field] = &[
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
        "Base pitch deviation of each gear without its own."
    ).reasons(&[Idle(
        always,
        "both gears have their own base pitch deviation",
    )]),
    Field {
        key: "deviations.combination",
        symbol: "",
        label: "combination",
        help: "independent: only the sizes are known, sqrt(f_pb1^2 + f_pb2^2). sum: known deviations, f_pb1 + f_pb2, positive if the incoming tooth is early.",
        kind: Kind::Choice(&["independent", "sum"], |inputs, value| {
            inputs.combination = Combination::ALL[value];
        }),
        absent: Default("independent"),
        ..Field::PLAIN
    }
    .reasons(&[Idle(
        always,
        "base pitch deviations of unlike sign are known and always add as a sum",
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
        "Normal backlash: the distance of the back flanks, which dynamic lets strike; only paper subtracts it (Eq. 1)."
    ).reasons(&[Idle(
        always,
        "a backlash does not delay a drive flank under load",
    )]),
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
];
