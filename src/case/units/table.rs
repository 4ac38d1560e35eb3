//! The table of units: symbol, other spellings, and SI value.

use std::f64::consts::TAU;

use super::Dimension;

/// The SI value of one unit.
#[derive(Debug, Clone, Copy)]
pub(super) enum Scale {
    /// A power of ten, applied to the decimal digits and therefore exact.
    Ten(i32),
    /// Another factor: the nearest f64 and the remainder.
    Times(f64, f64),
}

/// One unit of a dimension.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    /// The spelling that messages use.
    pub(super) symbol: &'static str,
    pub(super) aliases: &'static [&'static str],
    pub(super) scale: Scale,
}

/// All units of a dimension, in the order of messages.
pub(super) struct Family {
    pub(super) dimension: Dimension,
    /// The name of a value with its article.
    pub(super) name: &'static str,
    pub(super) units: &'static [Unit],
}

const fn ten(symbol: &'static str, aliases: &'static [&'static str], exponent: i32) -> Unit {
    Unit { symbol, aliases, scale: Scale::Ten(exponent) }
}

const fn times(
    symbol: &'static str,
    aliases: &'static [&'static str],
    factor: f64,
    rest: f64,
) -> Unit {
    Unit { symbol, aliases, scale: Scale::Times(factor, rest) }
}

const fn family(dimension: Dimension, name: &'static str, units: &'static [Unit]) -> Family {
    Family { dimension, name, units }
}

/// The units and the name of a dimension.
pub(super) fn family_of(dimension: Dimension) -> &'static Family {
    &FAMILIES[dimension as usize]
}

/// The units of a dimension. Empty for a bare number.
pub(super) fn units_of(dimension: Dimension) -> &'static [Unit] {
    family_of(dimension).units
}

// Exact by definition: in = 25.4 mm, lb = 0.45359237 kg, standard gravity 9.80665 m/s2, hp = 550 ft
// lbf/s, PS = 75 kgf m/s. Both parts of each factor come from rational arithmetic, with pi to 80
// digits.
/// Every dimension, in the order of [`Dimension`].
#[rustfmt::skip]
pub(super) static FAMILIES: [Family; 18] = [
    family(Dimension::Number, "a number", &[]),
    family(Dimension::Length, "a length", &[
        ten("mm", &[], -3),
        ten("um", &["micron", "microns"], -6),
        ten("m", &[], 0),
        ten("cm", &[], -2),
        ten("nm", &[], -9),
        times("in", &["inch", "inches"], 0.0254, 1.0325074129013955e-18),
        times("thou", &["mil", "mils"], 2.54e-5, -7.564261716996867e-22),
        times("ft", &["foot", "feet"], 0.3048, -1.5365486660812166e-17),
    ]),
    family(Dimension::Angle, "an angle", &[
        times("deg", &["°", "degree", "degrees"], 0.017453292519943295, 2.9486522708701687e-19),
        ten("rad", &[], 0),
        ten("mrad", &[], -3),
        times("arcmin", &[], 0.0002908882086657216, 1.5756442176305324e-20),
        times("arcsec", &[], 4.84813681109536e-6, 9.320078015422868e-23),
    ]),
    family(Dimension::Pressure, "a pressure", &[
        ten("GPa", &["kN/mm2", "N/(mm um)"], 9),
        ten("MPa", &["N/mm2"], 6),
        ten("kPa", &[], 3),
        ten("Pa", &["N/m2"], 0),
        times("psi", &["lbf/in2"], 6894.757293168362, -3.476429902321071e-13),
        times("ksi", &[], 6894757.293168361, 3.798276331961447e-11),
        times("Mpsi", &[], 6894757293.168362, -3.270956859296531e-7),
    ]),
    family(Dimension::Density, "a density", &[
        ten("kg/m3", &[], 0),
        ten("g/cm3", &["kg/dm3", "g/cc", "kg/l", "kg/L"], 3),
        times("lb/in3", &["lbm/in3"], 27679.90471020312, -6.009765667261031e-13),
    ]),
    family(Dimension::Power, "a power", &[
        ten("kW", &[], 3),
        ten("W", &[], 0),
        ten("MW", &[], 6),
        ten("mW", &[], -3),
        times("hp", &["HP", "bhp"], 745.6998715822702, -2.7927226591855287e-14),
        times("PS", &[], 735.49875, 2.7284841053187846e-14),
    ]),
    family(Dimension::Torque, "a torque", &[
        ten("N m", &["Nm"], 0),
        ten("kN m", &["kNm"], 3),
        ten("N mm", &["Nmm", "mN m", "mNm"], -3),
        ten("N cm", &["Ncm"], -2),
        ten("MN m", &["MNm"], 6),
        times("lbf in", &["lb in", "in lbf", "in lb", "lbfin"], 0.1129848290276167, 4.448527496788302e-18),
        times("lbf ft", &["lb ft", "ft lbf", "ft lb", "lbfft"], 1.3558179483314003, 5.338232996145962e-17),
    ]),
    family(Dimension::AngularVelocity, "an angular velocity", &[
        times("rpm", &["1/min", "min-1", "min^-1", "min⁻¹", "rev/min", "r/min", "RPM", "U/min"], 0.10471975511965978, -5.1697025413851275e-18),
        ten("rad/s", &[], 0),
        times("deg/s", &["°/s"], 0.017453292519943295, 2.9486522708701687e-19),
        times("rev/s", &["rps", "r/s"], TAU, 2.4492935982947064e-16),
    ]),
    family(Dimension::Force, "a force", &[
        ten("N", &[], 0),
        ten("kN", &[], 3),
        ten("MN", &[], 6),
        ten("mN", &[], -3),
        times("lbf", &[], 4.4482216152605, 3.604674457164947e-16),
    ]),
    family(Dimension::Time, "a time", &[
        ten("us", &[], -6),
        ten("ms", &[], -3),
        ten("s", &[], 0),
        ten("ns", &[], -9),
    ]),
    family(Dimension::Velocity, "a velocity", &[
        ten("m/s", &[], 0),
        ten("mm/s", &[], -3),
        times("ft/s", &[], 0.3048, -1.5365486660812166e-17),
        times("in/s", &[], 0.0254, 1.0325074129013955e-18),
        times("m/min", &[], 0.016666666666666666, 2.312964634635743e-19),
        times("ft/min", &["fpm"], 0.00508, -3.1391556021276303e-19),
        times("km/h", &[], 0.2777777777777778, -1.2335811384723961e-17),
    ]),
    family(Dimension::Mass, "a mass", &[
        ten("kg", &[], 0),
        ten("g", &[], -3),
        ten("mg", &[], -6),
        ten("t", &[], 3),
        times("lb", &["lbm"], 0.45359237, -2.2489672346637234e-17),
    ]),
    family(Dimension::Energy, "an energy", &[
        ten("J", &[], 0),
        ten("mJ", &[], -3),
        ten("uJ", &[], -6),
        ten("kJ", &[], 3),
        times("ft lbf", &["ft lb"], 1.3558179483314003, 5.338232996145962e-17),
        times("in lbf", &["in lb"], 0.1129848290276167, 4.448527496788302e-18),
    ]),
    family(Dimension::Inertia, "a moment of inertia", &[
        ten("kg m2", &["kgm2"], 0),
        ten("kg cm2", &["kgcm2"], -4),
        ten("kg mm2", &["kgmm2", "g m2"], -6),
        ten("g cm2", &["gcm2"], -7),
        times("lb in2", &["lbm in2"], 0.0002926396534292, 8.897395017015697e-21),
        times("lb ft2", &["lbm ft2"], 0.0421401100938048, 1.2812248824502604e-18),
    ]),
    family(Dimension::Compliance, "a compliance per width", &[
        ten("um mm/N", &["mm um/N"], -9),
        ten("m2/N", &[], 0),
        ten("mm2/N", &[], -6),
        times("in2/lbf", &[], 0.0001450377377302092, 4.005255956746474e-21),
    ]),
    family(Dimension::Stiffness, "a stiffness", &[
        ten("N/um", &["N/µm", "kN/mm"], 6),
        ten("N/m", &[], 0),
        ten("N/mm", &[], 3),
        times("lbf/in", &["lb/in"], 175.1268352464764, -1.1376717116859719e-14),
    ]),
    family(Dimension::Frequency, "a frequency", &[
        ten("Hz", &[], 0),
        ten("kHz", &[], 3),
    ]),
    family(Dimension::DiametralPitch, "a diametral pitch", &[
        times("1/in", &["/in", "1/inch", "in-1", "in^-1", "in⁻¹", "DP"], 39.37007874015748, -1.1189649382048822e-15),
        ten("1/mm", &["/mm", "mm-1", "mm^-1", "mm⁻¹"], 3),
        ten("1/m", &["/m", "m-1", "m^-1", "m⁻¹"], 0),
    ]),
];
