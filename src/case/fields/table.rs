//! The table of fields: every line of the form, in order.

use super::Absent::{Default, Either, Without};
use super::Reason::Beside;
use super::{Absent, Field, Kind, Range};
use crate::case::fields::Absent::Refused;
use crate::case::fields::Reason::{Idle, Partly};
use crate::case::fields::{
    AT_EXIT, BORE, CURVE, FACE, FLAG, IN_TIME, LOAD, MASS, NO_HAND, ROOT, TIP_OF_DRIVER,
    WHOLE_RELIEF, always, by_impact, has_size, is_driver, is_wider, root_diameter, tip_diameter,
};
use crate::case::units::Dimension;
use crate::case::units::Dimension::{
    Angle, AngularVelocity, Density, DiametralPitch, Inertia, Length, Number, Power, Pressure,
    Torque,
};
use crate::model::Inputs;
use crate::model::compliance::{contact_of, model_of};
use crate::model::face::MOST_SLICES;
use crate::model::inputs::{
    Combination, ContactCompliance, Drive, Hand, InertiaModel, Method, ReliefShape, ToothCompliance,
};

const fn number(
    [key, symbol, label]: [&'static str; 3],
    (dimension, from, to, unit): (Dimension, f64, f64, &'static str),
    absent: Absent,
    put: fn(&mut Inputs, f64),
    help: &'static str,
) -> Field {
    let kind = Kind::Number(dimension, Range::new(from, to, unit), put);
    Field { key, symbol, label, help, kind, absent, ..Field::PLAIN }
}

const fn count(
    key: &'static str,
    symbol: &'static str,
    label: &'static str,
    (from, to): (u32, u32),
    absent: Absent,
    put: fn(&mut Inputs, u32),
    help: &'static str,
) -> Field {
    let kind = Kind::Count(from, to, put);
    Field { key, symbol, label, help, kind, absent, ..Field::PLAIN }
}

const fn choice(
    key: &'static str,
    symbol: &'static str,
    label: &'static str,
    names: &'static [&'static str],
    absent: Absent,
    put: fn(&mut Inputs, usize),
    help: &'static str,
) -> Field {
    Field { key, symbol, label, help, kind: Kind::Choice(names, put), absent, ..Field::PLAIN }
}

const fn text(key: &'static str, label: &'static str, help: &'static str) -> Field {
    Field { key, label, help, ..Field::PLAIN }
}

mod given;

pub use given::List;

const PAIR: &[Field] = &[
    text("title", "title", "A name for the case.").reasons(&[Beside("a title for reports")]),
    text("notes", "notes", "Sources of the data.").reasons(&[Beside("notes for the reader")]),
    number(
        ["pair.module", "m", "module"],
        (Length, 0.05, 50.0, "mm"),
        Either,
        |inputs, value| inputs.module = value,
        "Normal module of both gears; give either the module or the diametral pitch.",
    )
    .with_example("5 mm")
    .instead_of("pair.diametral_pitch", |inputs| (inputs.module > 0.0).then_some(inputs.module)),
    number(
        ["pair.diametral_pitch", "Pd", "diametral pitch"],
        (DiametralPitch, 0.508, 508.0, "1/in"),
        Either,
        |inputs, value| inputs.module = 1.0 / value,
        "Diametral pitch of both gears, the reciprocal of the module; replaces the module.",
    )
    .with_example("8 1/in")
    .instead_of("pair.module", |inputs| (inputs.module > 0.0).then(|| 1.0 / inputs.module)),
    number(
        ["pair.pressure_angle", "α", "pressure angle"],
        (Angle, 14.5, 30.0, "deg"),
        Default("20 deg"),
        |inputs, value| inputs.pressure_angle = value,
        "Normal pressure angle of the basic rack.",
    ),
    number(
        ["pair.helix_angle", "β", "helix angle"],
        (Angle, 0.0, 45.0, "deg"),
        Default("0 deg"),
        |inputs, value| inputs.helix_angle = value,
        "Helix angle at the reference cylinder; with it module and pressure angle are the normal ones. 0 for a spur pair.",
    ),
    number(
        ["pair.centre_distance", "a", "centre distance"],
        (Length, 0.1, 100000.0, "mm"),
        Without("no backlash"),
        |inputs, value| inputs.centre_distance = Some(value),
        "Centre distance; else from the profile shifts, without backlash.",
    )
    .with_example("100 mm"),
    choice("pair.driver_hand", "", "hand of the driver", &["right", "left"], Default("right"), |inputs, value| {
            inputs.driver_hand = Hand::ALL[value];
        }, "Hand of the driver's helix; the other gear has the other hand. The driver turns positively about +z.")
    .reasons(&[Idle(|inputs| inputs.helix_angle == 0.0, NO_HAND)]),
    number(
        ["pair.face_offset", "o", "face offset"],
        (Length, -1000.0, 1000.0, "mm"),
        Default("0 mm"),
        |inputs, value| inputs.face_offset = value,
        "Middle of the face of gear 2 minus that of gear 1, along +z.",
    ),
];

/// The rows by groups, in the order of the form and of a new file.
const PARTS: [&[Field]; 6] = [PAIR, DRIVER, DRIVEN, OPERATION, MODEL, given::COMPLIANCE];

const COUNT: usize = {
    let (mut count, mut part) = (0, 0);
    while part < PARTS.len() {
        count += PARTS[part].len();
        part += 1;
    }
    count
};

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

macro_rules! gear {
    ($gear:ident, $table:literal, $i:literal) => {
        [
            count(
                concat!($table, ".teeth"),
                concat!("z", $i),
                "number of teeth",
                (5, 1000),
                Refused,
                |inputs, value| inputs.$gear.teeth = value,
                "Whole number of teeth of the gear.",
            )
            .with_example("20"),
            number(
                [concat!($table, ".profile_shift"), concat!("x", $i), "profile shift"],
                (Number, -0.7, 1.2, ""),
                Default("0"),
                |inputs, value| inputs.$gear.profile_shift = value,
                "Profile shift coefficient, times the module.",
            ),
            number(
                [concat!($table, ".addendum"), concat!("ha*", $i), "addendum"],
                (Number, 0.1, 2.0, ""),
                Default("1"),
                |inputs, value| (inputs.$gear.addendum, inputs.$gear.tip_diameter) = (value, None),
                "Addendum coefficient, times the module: tip radius = m (z/(2 cos β) + ha* + x).",
            )
            .instead_of(concat!($table, ".tip_diameter"), |inputs| {
                has_size(inputs, &inputs.$gear).then(|| inputs.addendum_of(&inputs.$gear))
            })
            .reasons(&[Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER)]),
            number(
                [concat!($table, ".tip_diameter"), concat!("da", $i), "tip diameter"],
                (Length, 0.1, 100000.0, "mm"),
                Without("from the addendum"),
                |inputs, value| inputs.$gear.tip_diameter = Some(value),
                "Tip diameter from the drawing, without chamfer; replaces the addendum \
                        coefficient.",
            )
            .with_example("110 mm")
            .instead_of(concat!($table, ".addendum"), |inputs| tip_diameter(inputs, &inputs.$gear))
            .reasons(&[Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER)]),
            number(
                [concat!($table, ".dedendum"), concat!("hf*", $i), "dedendum"],
                (Number, 0.5, 2.0, ""),
                Default("1.25"),
                |inputs, value| (inputs.$gear.dedendum, inputs.$gear.root_diameter) = (value, None),
                "Dedendum coefficient of the cutting rack, times the module: root radius = m (z/(2 \
                    cos β) - hf* + x).",
            )
            .instead_of(concat!($table, ".root_diameter"), |inputs| {
                has_size(inputs, &inputs.$gear).then(|| inputs.dedendum_of(&inputs.$gear))
            })
            .reasons(&ROOT),
            number(
                [concat!($table, ".root_diameter"), concat!("df", $i), "root diameter"],
                (Length, 0.1, 100000.0, "mm"),
                Without("from the dedendum"),
                |inputs, value| inputs.$gear.root_diameter = Some(value),
                "Root diameter from the drawing, as cut by the rack; replaces the dedendum \
                        coefficient.",
            )
            .with_example("87.5 mm")
            .instead_of(concat!($table, ".dedendum"), |inputs| root_diameter(inputs, &inputs.$gear))
            .reasons(&ROOT),
            number(
                [concat!($table, ".face_width"), concat!("b", $i), "face width"],
                (Length, 0.1, 1000.0, "mm"),
                Refused,
                |inputs, value| inputs.$gear.face_width = value,
                "Face width; the smaller of the two carries the \
                        contact.",
            )
            .with_example("8 mm")
            .reasons(&[Partly(
                |inputs| is_wider(inputs, inputs.$gear.face_width),
                "only the narrower face width carries load, and the static load does not depend on \
                    mass",
            )]),
            number(
                [concat!($table, ".bore_radius"), concat!("rh", $i), "bore radius"],
                (Length, 0.0, 25000.0, "mm"),
                Default("0 mm"),
                |inputs, value| inputs.$gear.bore_radius = value,
                "Radius of the bore: a radius, not a diameter. 0 for a gear in one piece with its shaft.",
            )
            .instead_of(concat!($table, ".bore_diameter"), |inputs| Some(inputs.$gear.bore_radius))
            .reasons(&BORE),
            number(
                [concat!($table, ".bore_diameter"), concat!("dh", $i), "bore diameter"],
                (Length, 0.0, 50000.0, "mm"),
                Without("from the radius"),
                |inputs, value| inputs.$gear.bore_radius = value / 2.0,
                "Bore diameter from the drawing; replaces the bore radius.",
            )
            .with_example("40 mm")
            .instead_of(concat!($table, ".bore_radius"), |inputs| {
                Some(2.0 * inputs.$gear.bore_radius)
            })
            .reasons(&BORE),
            number(
                [concat!($table, ".young"), concat!("E", $i), "Young's modulus"],
                (Pressure, 0.001, 1000.0, "GPa"),
                Default("206 GPa"),
                |inputs, value| inputs.$gear.young = value,
                "Young's modulus of the gear's material.",
            ),
            number(
                [concat!($table, ".poisson"), concat!("ν", $i), "Poisson's ratio"],
                (Number, 0.0, 0.499, ""),
                Default("0.3"),
                |inputs, value| inputs.$gear.poisson = value,
                "Poisson's ratio of the gear's material.",
            ),
            number(
                [concat!($table, ".density"), concat!("ρ", $i), "density"],
                (Density, 1.0, 50000.0, "kg/m3"),
                Default("7800 kg/m3"),
                |inputs, value| inputs.$gear.density = value,
                "Density of the gear's material.",
            )
            .reasons(&MASS),
            number(
                [concat!($table, ".inertia"), concat!("J", $i), "moment of inertia"],
                (Inertia, 1e-15, 1e12, "kg m2"),
                Without("computed"),
                |inputs, value| inputs.$gear.inertia = Some(value),
                "Moment of inertia of the gear and all parts that rotate with the gear \
                        (default: gear body alone, see \
                        model.inertia).",
            )
            .with_example("0.0006 kg m2")
            .reasons(&MASS),
            number(
                [concat!($table, ".tip_relief"), concat!("Ca", $i), "tip relief"],
                (Length, 0.0, 5000.0, "um"),
                Default("0 um"),
                |inputs, value| inputs.$gear.tip_relief = value,
                "Material removed at the tip, along the base tangent: normal to the profile in the \
                    transverse plane.",
            )
            .reasons(&[Idle(|inputs| is_driver($i) && by_impact(inputs), AT_EXIT)]),
            number(
                [concat!($table, ".root_relief"), concat!("Cf", $i), "root relief"],
                (Length, 0.0, 5000.0, "um"),
                Default("0 um"),
                |inputs, value| inputs.$gear.root_relief = value,
                "Material removed at the root, along the base tangent: normal to the profile in the \
                    transverse plane.",
            )
            .reasons(&[Idle(|inputs| !is_driver($i) && by_impact(inputs), AT_EXIT)]),
            number(
                [concat!($table, ".tip_relief_length"), concat!("La", $i), "tip relief length"],
                (Length, 0.0001, 1000.0, "mm"),
                Without("to single contact"),
                |inputs, value| inputs.$gear.tip_relief_length = Some(value),
                "Length of the tip relief along the path of contact, from the tip; paper and \
                    exact apply the whole relief at the tip.",
            )
            .with_example("1 mm")
            .reasons(&WHOLE_RELIEF),
            number(
                [concat!($table, ".root_relief_length"), concat!("Lf", $i), "root relief length"],
                (Length, 0.0001, 1000.0, "mm"),
                Without("to single contact"),
                |inputs, value| inputs.$gear.root_relief_length = Some(value),
                "Length of the root relief along the path of contact, from its end at the \
                    root; static and dynamic alone.",
            )
            .with_example("1 mm")
            .reasons(&WHOLE_RELIEF),
            number(
                [concat!($table, ".tip_chamfer"), concat!("hk", $i), "tip chamfer"],
                (Length, 0.0, 50.0, "mm"),
                Default("0 mm"),
                |inputs, value| inputs.$gear.tip_chamfer = value,
                "Radial height of the chamfer; its corner is a sharp tip, lower by this \
                        height.",
            )
            .reasons(&[Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER)]),
            number(
                [concat!($table, ".tip_radius"), concat!("re", $i), "tip edge radius"],
                (Length, 0.0001, 50.0, "mm"),
                Without("sharp"),
                |inputs, value| inputs.$gear.tip_radius = Some(value),
                "Radius of the arc that rounds the tip's edge, tangent to tip circle and \
                        flank; the tip is sharp without it.",
            )
            .with_example("0.2 mm")
            .reasons(&[
                Idle(always, "method paper has sharp tips"),
                Partly(|inputs| is_driver($i) && by_impact(inputs), TIP_OF_DRIVER),
            ]),
            number(
                [concat!($table, ".base_pitch"), concat!("f_pb", $i), "own base pitch dev."],
                (Length, -5000.0, 5000.0, "um"),
                Without("common f_pb"),
                |inputs, value| inputs.$gear.base_pitch = Some(value),
                "Base pitch deviation of this gear: f_pt cos(alpha_t) for a single pitch deviation f_pt. \
                        Else by its grade, or deviations.base_pitch.",
            )
            .with_example("12 um")
            .derived(|inputs| {
                (inputs.$gear.grade.is_none() || has_size(inputs, &inputs.$gear))
                    .then(|| inputs.base_pitch_of(&inputs.$gear).0)
            }),
            count(
                concat!($table, ".grade"),
                concat!("A", $i),
                "ISO 1328-1 class",
                (1, 11),
                Without("none"),
                |inputs, value| inputs.$gear.grade = Some(value),
                "Flank tolerance class of ISO 1328-1:2013; it gives the base pitch deviation of this gear.",
            )
            .with_example("7")
            .reasons(&[Idle(always, "the base pitch deviation of this gear is given")]),
            number(
                [concat!($table, ".helix_slope"), concat!("f_Hβ", $i), "helix slope"],
                (Length, -5000.0, 5000.0, "um"),
                Default("0 um"),
                |inputs, value| inputs.$gear.helix_slope = value,
                "Helix slope deviation over the face width, along the base tangent in the \
                        transverse plane; above 0 the helix angle is greater than designed.",
            )
            .reasons(&FACE),
            number(
                [concat!($table, ".crowning"), concat!("Cβ", $i), "crowning"],
                (Length, 0.0, 5000.0, "um"),
                Default("0 um"),
                |inputs, value| inputs.$gear.crowning = value,
                "Parabola of material removed towards both ends of the face, along the base tangent \
                        in the transverse plane.",
            )
            .reasons(&FACE),
            number(
                [concat!($table, ".end_relief_minus"), concat!("CI", $i), "end relief, minus side"],
                (Length, 0.0, 5000.0, "um"),
                Default("0 um"),
                |inputs, value| inputs.$gear.end_reliefs[0] = value,
                "Material removed at the face end towards -z, along the base tangent in the \
                        transverse plane.",
            )
            .reasons(&FACE),
            number(
                [concat!($table, ".end_relief_plus"), concat!("CII", $i), "end relief, plus side"],
                (Length, 0.0, 5000.0, "um"),
                Default("0 um"),
                |inputs, value| inputs.$gear.end_reliefs[1] = value,
                "Material removed at the face end towards +z, along the base tangent in the \
                        transverse plane.",
            )
            .reasons(&FACE),
            number(
                [concat!($table, ".end_relief_length"), concat!("LI", $i), "end relief length"],
                (Length, 0.001, 1000.0, "mm"),
                Without("0.1 b"),
                |inputs, value| inputs.$gear.end_relief_length = Some(value),
                "Length of the end reliefs along the face.",
            )
            .with_example("4 mm")
            .reasons(&[
                Idle(|inputs| !inputs.$gear.has_end_relief(), "the gear has no end relief"),
                FACE[0],
            ]),
        ]
    };
}

const DRIVER: &[Field] = &gear!(driver, "driver", "1");
const DRIVEN: &[Field] = &gear!(driven, "driven", "2");

const OPERATION: &[Field] = &[
    number(
        ["deviations.base_pitch", "f_pb", "base pitch deviation"],
        (Length, -5000.0, 5000.0, "um"),
        Default("0 um"),
        |inputs, value| inputs.base_pitch_deviation = value,
        "Base pitch deviation of each gear without its own: f_pt cos(alpha_t) for a single pitch deviation f_pt.",
    ).reasons(&[Idle(
        always,
        "both gears have their own base pitch deviation",
    )]),
    choice("deviations.combination", "", "combination", &["independent", "sum"], Default("independent"), |inputs, value| {
            inputs.combination = Combination::ALL[value];
        }, "independent: only the sizes are known, sqrt(f_pb1^2 + f_pb2^2). sum: known deviations, f_pb1 + f_pb2, positive if the incoming tooth is early.")
    .reasons(&[Idle(
        always,
        "base pitch deviations of unlike sign are known and always add as a sum",
    )]),
    number(
        ["deviations.misalignment", "F_βx", "misalignment"],
        (Length, -5000.0, 5000.0, "um"),
        Default("0 um"),
        |inputs, value| inputs.misalignment = value,
        "Misalignment of the flanks over the common face width, along the base tangent; above 0 they open towards +z.",
    ).reasons(&FACE),
    number(
        ["deviations.backlash", "j_bn", "normal backlash"],
        (Length, 0.0, 5000.0, "um"),
        Default("0 um"),
        |inputs, value| inputs.backlash = value,
        "Normal backlash: the distance of the back flanks, which dynamic lets strike; only paper subtracts it (Eq. 1).",
    ).reasons(&[Idle(
        always,
        "a backlash does not delay a drive flank under load",
    )]),
    number(
        ["operation.power", "P", "power"],
        (Power, 1e-12, 1e12, "W"),
        Either,
        |inputs, value| inputs.drive = Drive::Power(value),
        "Power on the driver; give power or torque.",
    ).with_example("15 kW").instead_of("operation.torque", |inputs| {
        let power = inputs.torque() * inputs.speed;
        (inputs.speed > 0.0 && power > 0.0).then_some(power)
    }).reasons(&LOAD),
    number(
        ["operation.speed", "n1", "speed"],
        (AngularVelocity, 0.001, 1e6, "rpm"),
        Refused,
        |inputs, value| inputs.speed = value,
        "Speed of the driver.",
    ).with_example("2000 rpm").reasons(&[Partly(
        |inputs| inputs.method == Method::Static && matches!(inputs.drive, Drive::Torque(_)),
        "with a given torque, the static load does not depend on speed; only the free impact \
            changes",
    )]),
    number(
        ["operation.torque", "T1", "torque"],
        (Torque, 1e-12, 1e12, "N m"),
        Either,
        |inputs, value| inputs.drive = Drive::Torque(value),
        "Torque on the driver; give power or torque.",
    ).with_example("71.6 N m").instead_of("operation.power", |inputs| {
        let torque = inputs.torque();
        (inputs.speed > 0.0 && torque > 0.0).then_some(torque)
    }).reasons(&LOAD),
    number(
        ["operation.friction_coefficient", "μ", "friction coefficient"],
        (Number, 0.0, 2.0, ""),
        Without("not given"),
        |inputs, value| inputs.friction_coefficient = Some(value),
        "Coulomb friction coefficient; static and dynamic apply friction at the teeth.",
    ).with_example("0.06").reasons(&[Beside(
        "a note compares it with the stick limit; no quantity of this method depends on it",
    )]),
];

const MODEL: &[Field] = &[
    choice("model.method", "", "method", &["paper", "exact", "static", "dynamic", "auto"], Default("auto"), |inputs, value| inputs.method = Method::ALL[value], "paper: as printed, misprints fixed. exact: exact position, free impact. static: all pairs share the load. dynamic: with inertia. auto: the fastest within the tolerance."),
    number(
        ["model.deflection", "δ", "combined deflection"],
        (Length, 0.0, 5000.0, "um"),
        Without("from the load"),
        |inputs, value| inputs.deflection = Some(value),
        "Combined deflection of the loaded pair; else computed from the load.",
    ).with_example("24.7 um").reasons(&[Idle(
        |inputs| inputs.method.shares_load(),
        "this method computes the deflection from the load",
    )]),
    choice("model.tooth_compliance", "q1,q2", "tooth compliance", &ToothCompliance::NAMES, Without("by the method"), |inputs, value| {
            inputs.tooth_compliance = Some(ToothCompliance::CHOICES[value]);
        }, ToothCompliance::HELP),
    choice("model.contact_compliance", "q_H", "contact compliance", &ContactCompliance::NAMES, Default(ContactCompliance::NAMES[0]), |inputs, value| {
            inputs.contact_compliance = ContactCompliance::ALL[value];
        }, ContactCompliance::HELP).reasons(&[Idle(
        |inputs| contact_of(inputs).is_none(),
        "the tooth compliance of this case includes the contact",
    )]),
    count("model.slices", "", "slices", (3, MOST_SLICES as u32), Default("auto"), |inputs, value| {
            inputs.slices = (value > 0).then_some(value as usize);
        }, "Slices of the face width; auto: enough for forces within about 0.1 %; a contact of a few slices \
            can be some percent off.").reasons(&FACE),
    choice("model.slice_coupling", "", "slice coupling", FLAG, Default("true"), |inputs, value| inputs.slice_coupling = value == 1, "Whether a force on a slice displaces the slices beside it; without it each slice \
            deflects alone.").reasons(&FACE),
    choice("model.tooth_coupling", "", "tooth coupling", FLAG, Default("true"), |inputs, value| inputs.tooth_coupling = value == 1, "Whether a force on a tooth displaces its neighbours; without it each pair of teeth is \
            a spring of its own.").reasons(&[Idle(
        |inputs| !model_of(inputs).model().has_coupling,
        "the tooth compliance of this case does not couple neighbouring teeth",
    )]),
    choice("model.inertia", "", "inertia model", &["outline", "base-circle"], Default("outline"), |inputs, value| {
            inputs.inertia = InertiaModel::ALL[value];
        }, "outline: inertia of the true gear outline. base-circle: inertia of a disc up to \
            the base circle, Eq. 47; method paper always uses the disc.").reasons(&[
        Idle(
            |inputs| inputs.method == Method::Paper,
            "method paper uses the disc to the base circle, Eq. 47",
        ),
        Idle(always, "the inertia of both gears is given"),
        MASS[0],
    ]),
    choice("model.relief_shape", "", "relief shape", &["linear", "parabolic"], Default("linear"), |inputs, value| {
            inputs.relief_shape = ReliefShape::ALL[value];
        }, "How tip and root relief grow along the path of contact; static and dynamic alone.").reasons(&WHOLE_RELIEF),
    number(
        ["model.damping_ratio", "ζ", "damping ratio"],
        (Number, 0.0, 2.0, ""),
        Default("0.07"),
        |inputs, value| inputs.damping_ratio = value,
        "Damping ratio of the mean mesh stiffness while a pair is in contact; dynamic alone.",
    ).reasons(&[Idle(always, IN_TIME)]),
    count("model.warmup_cycles", "", "warm-up cycles", (1, 10000), Default("20"), |inputs, value| inputs.warmup_cycles = value, "Number of base pitches between the start of the motion, at static balance, and E; \
            method dynamic only.").reasons(&[Idle(always, IN_TIME)]),
    number(
        ["model.tolerance", "", "tolerance"],
        (Number, 1e-12, 0.1, ""),
        Default("1e-6"),
        |inputs, value| inputs.tolerance = value,
        "Permitted relative error of the peak force of a damped motion; dynamic alone.",
    ).read_when(|inputs| inputs.method == Method::Dynamic)
    .reasons(&[
        Idle(
            |inputs| inputs.method == Method::Auto,
            "method auto derives the tolerance from model.within",
        ),
        Idle(always, IN_TIME),
        Partly(always, "changes results by at most its own value"),
    ]),
    number(
        ["model.within", "", "permitted error"],
        (Number, 1e-6, 1.0, ""),
        Default("0.05"),
        |inputs, value| inputs.within = value,
        "Permitted relative error of the method auto against the method dynamic.",
    ).read_when(|inputs| inputs.method == Method::Auto).reasons(&[Idle(
        always,
        "only the method auto chooses by a permitted error",
    )]),
    count("model.stations", "n", "stations", (1, 10000), Default("64"), |inputs, value| {
            inputs.stations = (value > 0).then_some(value as usize);
        }, "Intervals between D and E; static and dynamic have as many again after E. auto: enough for the station tolerance.").reasons(&[Partly(always, CURVE)]),
    number(
        ["model.station_tolerance", "", "station tolerance"],
        (Number, 1e-9, 0.1, ""),
        Default("1e-3"),
        |inputs, value| inputs.station_tolerance = value,
        "Permitted distance of the curve from the lines between stations, over its peak; used with stations = \"auto\", and for pictures.",
    ).read_when(|inputs| inputs.stations.is_none()).reasons(&[
        Idle(
            |inputs| inputs.stations.is_some(),
            "the number of stations is fixed",
        ),
        Partly(always, CURVE),
    ]),
    choice("model.accurate", "", "accurate", FLAG, Default("false"), |inputs, value| inputs.accurate = value == 1, "Computes geometry and position in double-double arithmetic: relative error below \
            1e-13 instead of 1e-12, with a longer run time.").reasons(&[Partly(
        always,
        "changes only digits beyond those shown",
    )]),
];
