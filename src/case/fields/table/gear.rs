//! The rows of one gear, used for both gears.

use crate::case::fields::Absent::{Default, Refused, Without};
use crate::case::fields::derived::{has_size, root_diameter, tip_diameter};
use crate::case::fields::reasons::Reason::{Idle, Partly};
use crate::case::fields::reasons::{
    AT_RUN_OUT, BORE, MASS, ROOT, TIP_OF_DRIVER, WHOLE_RELIEF, always, by_impact, is_driver,
    is_wider,
};
use crate::case::fields::{Field, Kind, Range};
use crate::case::units::Dimension;

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
                ..Field::PLAIN
            }
            .with_example("20"),
            number!(
                concat!(stringify!($gear), ".profile_shift"),
                concat!("x", $i),
                "profile shift",
                Number,
                -0.7,
                1.2,
                "",
                Default("0"),
                |inputs, value| inputs.$gear.profile_shift = value,
                "Profile shift coefficient, times the module."
            ),
            number!(
                concat!(stringify!($gear), ".addendum"),
                concat!("ha*", $i),
                "addendum",
                Number,
                0.1,
                2.0,
                "",
                Default("1"),
                |inputs, value| (inputs.$gear.addendum, inputs.$gear.tip_diameter) = (value, None),
                "Addendum coefficient, times the module: tip radius = m (z/2 + ha* + x)."
            )
            .instead_of(concat!(stringify!($gear), ".tip_diameter"), |inputs| {
                has_size(inputs, &inputs.$gear)
                    .then(|| inputs.$gear.addendum_coefficient(inputs.module))
            })
            .reasons(&[Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER)]),
            number!(
                concat!(stringify!($gear), ".tip_diameter"),
                concat!("da", $i),
                "tip diameter",
                Length,
                0.1,
                100000.0,
                "mm",
                Without("from the addendum"),
                |inputs, value| inputs.$gear.tip_diameter = Some(value),
                "Tip diameter from the drawing, without chamfer; replaces the addendum \
                        coefficient."
            )
            .with_example("110 mm")
            .instead_of(concat!(stringify!($gear), ".addendum"), |inputs| {
                tip_diameter(inputs, &inputs.$gear)
            })
            .reasons(&[Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER)]),
            number!(
                concat!(stringify!($gear), ".dedendum"),
                concat!("hf*", $i),
                "dedendum",
                Number,
                0.5,
                2.0,
                "",
                Default("1.25"),
                |inputs, value| (inputs.$gear.dedendum, inputs.$gear.root_diameter) = (value, None),
                "Dedendum coefficient of the cutting rack, times the module: root radius = m (z/2 \
                    - hf* + x)."
            )
            .instead_of(concat!(stringify!($gear), ".root_diameter"), |inputs| {
                has_size(inputs, &inputs.$gear)
                    .then(|| inputs.$gear.dedendum_coefficient(inputs.module))
            })
            .reasons(&ROOT),
            number!(
                concat!(stringify!($gear), ".root_diameter"),
                concat!("df", $i),
                "root diameter",
                Length,
                0.1,
                100000.0,
                "mm",
                Without("from the dedendum"),
                |inputs, value| inputs.$gear.root_diameter = Some(value),
                "Root diameter from the drawing, as cut by the rack; replaces the dedendum \
                        coefficient."
            )
            .with_example("87.5 mm")
            .instead_of(concat!(stringify!($gear), ".dedendum"), |inputs| {
                root_diameter(inputs, &inputs.$gear)
            })
            .reasons(&ROOT),
            number!(
                concat!(stringify!($gear), ".face_width"),
                concat!("b", $i),
                "face width",
                Length,
                0.1,
                1000.0,
                "mm",
                Refused,
                |inputs, value| inputs.$gear.face_width = value,
                "Face width; the smaller of the two carries the \
                        contact."
            )
            .with_example("8 mm")
            .reasons(&[Partly(
                |inputs| is_wider(inputs, inputs.$gear.face_width),
                "only the narrower face width carries load, and the static load does not depend on \
                    mass",
            )]),
            number!(
                concat!(stringify!($gear), ".bore_radius"),
                concat!("rh", $i),
                "bore radius",
                Length,
                0.0,
                25000.0,
                "mm",
                Default("0 mm"),
                |inputs, value| inputs.$gear.bore_radius = value,
                "Radius of the bore: a radius, not a diameter."
            )
            .reasons(&BORE),
            number!(
                concat!(stringify!($gear), ".young"),
                concat!("E", $i),
                "Young's modulus",
                Pressure,
                0.001,
                1000.0,
                "GPa",
                Default("206 GPa"),
                |inputs, value| inputs.$gear.young = value,
                "Young's modulus of the gear's material."
            ),
            number!(
                concat!(stringify!($gear), ".poisson"),
                concat!("ν", $i),
                "Poisson's ratio",
                Number,
                0.0,
                0.499,
                "",
                Default("0.3"),
                |inputs, value| inputs.$gear.poisson = value,
                "Poisson's ratio of the gear's material."
            ),
            number!(
                concat!(stringify!($gear), ".density"),
                concat!("ρ", $i),
                "density",
                Density,
                1.0,
                50000.0,
                "kg/m3",
                Default("7800 kg/m3"),
                |inputs, value| inputs.$gear.density = value,
                "Density of the gear's material."
            )
            .reasons(&MASS),
            number!(
                concat!(stringify!($gear), ".inertia"),
                concat!("J", $i),
                "moment of inertia",
                Inertia,
                1e-15,
                1e12,
                "kg m2",
                Without("computed"),
                |inputs, value| inputs.$gear.inertia = Some(value),
                "Moment of inertia of the gear and all parts that rotate with the gear \
                        (default: gear body alone, see \
                        model.inertia)."
            )
            .with_example("0.0006 kg m2")
            .reasons(&MASS),
            number!(
                concat!(stringify!($gear), ".tip_relief"),
                concat!("Ca", $i),
                "tip relief",
                Length,
                0.0,
                5000.0,
                "um",
                Default("0 um"),
                |inputs, value| inputs.$gear.tip_relief = value,
                "Material removed at the tip, normal to the \
                        flank."
            )
            .reasons(&[Idle(|inputs| is_driver($i) && by_impact(inputs), AT_RUN_OUT)]),
            number!(
                concat!(stringify!($gear), ".root_relief"),
                concat!("Cf", $i),
                "root relief",
                Length,
                0.0,
                5000.0,
                "um",
                Default("0 um"),
                |inputs, value| inputs.$gear.root_relief = value,
                "Material removed at the root, normal to the \
                        flank."
            )
            .reasons(&[Idle(|inputs| !is_driver($i) && by_impact(inputs), AT_RUN_OUT)]),
            Field {
                key: concat!(stringify!($gear), ".tip_relief_length"),
                symbol: concat!("La", $i),
                label: "tip relief length",
                help: "Length of the tip relief along the path of contact, from the tip; paper and \
                    exact apply the whole relief at the tip.",
                kind: Kind::Number(
                    Dimension::Length,
                    Range::new(0.0001, 1000.0, "mm"),
                    |inputs, value| inputs.$gear.tip_relief_length = Some(value),
                ),
                absent: Without("to single contact"),
                ..Field::PLAIN
            }
            .with_example("1 mm")
            .reasons(&WHOLE_RELIEF),
            Field {
                key: concat!(stringify!($gear), ".root_relief_length"),
                symbol: concat!("Lf", $i),
                label: "root relief length",
                help: "Length of the root relief along the path of contact, from its end at the \
                    root; static and dynamic alone.",
                kind: Kind::Number(
                    Dimension::Length,
                    Range::new(0.0001, 1000.0, "mm"),
                    |inputs, value| inputs.$gear.root_relief_length = Some(value),
                ),
                absent: Without("to single contact"),
                ..Field::PLAIN
            }
            .with_example("1 mm")
            .reasons(&WHOLE_RELIEF),
            number!(
                concat!(stringify!($gear), ".tip_chamfer"),
                concat!("hk", $i),
                "tip chamfer",
                Length,
                0.0,
                50.0,
                "mm",
                Default("0 mm"),
                |inputs, value| inputs.$gear.tip_chamfer = value,
                "Radial height of the chamfer; its corner is a sharp tip, lower by this \
                        height."
            )
            .reasons(&[Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER)]),
            number!(
                concat!(stringify!($gear), ".tip_radius"),
                concat!("re", $i),
                "tip edge radius",
                Length,
                0.0001,
                50.0,
                "mm",
                Without("sharp"),
                |inputs, value| inputs.$gear.tip_radius = Some(value),
                "Radius of the arc that rounds the tip's edge, tangent to tip circle and \
                        flank; the tip is sharp without it."
            )
            .with_example("0.2 mm")
            .reasons(&[
                Idle(always, "method paper has sharp tips"),
                Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER),
            ]),
            number!(
                concat!(stringify!($gear), ".base_pitch"),
                concat!("f_pb", $i),
                "own pitch deviation",
                Length,
                -5000.0,
                5000.0,
                "um",
                Without("common f_pb"),
                |inputs, value| inputs.$gear.base_pitch = Some(value),
                "Base pitch deviation of this gear; else by its grade, or \
                        deviations.base_pitch."
            )
            .with_example("12 um")
            .derived(|inputs| {
                (inputs.$gear.grade.is_none() || has_size(inputs, &inputs.$gear))
                    .then(|| inputs.base_pitch_of(&inputs.$gear).0)
            }),
            Field {
                key: concat!(stringify!($gear), ".grade"),
                symbol: concat!("A", $i),
                label: "ISO 1328-1 class",
                help: "Flank tolerance class of ISO 1328-1:2013; it gives the base pitch deviation \
                    f_pb = f_pT cos(alpha) of this gear.",
                kind: Kind::Count(1, 11, |inputs, value| inputs.$gear.grade = Some(value)),
                absent: Without("none"),
                ..Field::PLAIN
            }
            .with_example("7")
            .reasons(&[Idle(always, "the base pitch deviation of this gear is given")]),
        ]
    };
}

pub(super) const DRIVER: &[Field] = &gear!(driver, "1");
pub(super) const DRIVEN: &[Field] = &gear!(driven, "2");
