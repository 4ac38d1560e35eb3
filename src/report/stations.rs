//! The table of station values of the incoming tooth, for text, JSON, CSV and charts.

use crate::model::contact_state::DIGITS_BETWEEN;
use crate::model::inputs::Method;
use crate::model::{Inputs, Interpolated, Solution, Station};

/// A value at the stations of some methods.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// The name in JSON and CSV.
    pub key: &'static str,
    /// The symbol.
    pub symbol: &'static str,
    /// The SI unit.
    pub unit: &'static str,
    /// The unit in reports and charts.
    pub shown: &'static str,
    /// Significant digits in reports.
    pub digits: usize,
    /// The methods whose stations have this value.
    pub methods: &'static [Method],
    /// The value in SI.
    pub value: fn(&Solution, &Station) -> Option<f64>,
}

const CLOSED_FORM: &[Method] = &Method::CLOSED_FORM;
const SHARING: &[Method] = &[Method::Static, Method::Dynamic];
const EVERY: &[Method] = &Method::ALL;
const DYNAMIC: &[Method] = &[Method::Dynamic];

const fn column(
    (key, symbol): (&'static str, &'static str),
    unit: &'static str,
    (shown, digits): (&'static str, usize),
    methods: &'static [Method],
    value: fn(&Solution, &Station) -> Option<f64>,
) -> Column {
    Column { key, symbol, unit, shown, digits, methods, value }
}

/// Every column, in the order of a row.
#[rustfmt::skip]
pub const COLUMNS: &[Column] = &[
    column(("roll_angle_driver", "θ_1"), "rad", ("deg", 5), EVERY, |_, s| Some(s.roll_angle_driver)),
    column(("roll_angle_driven", "u"), "rad", ("deg", 5), EVERY, |_, s| Some(s.roll_angle_driven)),
    column(("time", "t"), "s", ("us", 5), DYNAMIC, |_, s| s.time()),
    column(("radius_driver", "O1J"), "m", ("mm", 5), CLOSED_FORM, |_, s| s.radius_driver()),
    column(("normal_velocity", "ΔV_n"), "m/s", ("m/s", 5), EVERY, |_, s| Some(s.normal_velocity)),
    column(("sliding_velocity", "ΔV_τ"), "m/s", ("m/s", 5), EVERY, |_, s| Some(s.sliding_velocity)),
    column(("impact_force", "F_S"), "N", ("N", 5), CLOSED_FORM, |_, s| s.radius_driver().map(|_| s.force)),
    column(("force", "F"), "N", ("N", 5), SHARING, |_, s| s.load_share().map(|_| s.force)),
    column(("hertz_pressure", "p"), "Pa", ("MPa", 5), SHARING, Solution::pressure),
    column(("load_share", "F/ΣF"), "1", ("1", 4), SHARING, |_, s| s.load_share()),
    column(("transmission_error", "x"), "m", ("um", 5), SHARING, |_, s| s.transmission_error()),
    column(("gap", "S"), "m", ("um", 5), EVERY, |_, s| Some(s.gap)),
    column(("pair_compliance", "q_s"), "m2/N", ("um mm/N", 5), EVERY, |_, s| s.pair_compliance),
    column(("impact_energy", "E_k"), "J", ("J", 5), CLOSED_FORM, |_, s| s.impact_energy()),
];

/// The columns of the stations of a method.
pub fn columns(method: Method) -> impl Iterator<Item = &'static Column> + Clone {
    COLUMNS.iter().filter(move |column| column.methods.contains(&method))
}

impl Station {
    /// The driver's roll angle after E, in deg.
    #[must_use]
    pub fn angle_after_e(&self) -> f64 {
        0.0 - self.roll_angle_driver.to_degrees()
    }
}

/// Lengths and speeds below this fraction of the radii and speeds whose difference they are consist
/// of rounding errors.
const RESOLUTION: f64 = 1e-12;

/// The mesh stiffness over the path of contact. No station has this value: each compliance model
/// has its own curve.
pub static MESH_STIFFNESS: Column =
    column(("mesh_stiffness", "k"), "N/m", ("N/um", 4), EVERY, |_, _| None);

impl Column {
    /// The value in SI; 0 below the resolution of the difference that it is computed from.
    #[must_use]
    pub fn resolved(&self, value: f64, inputs: &Inputs, solution: &Solution) -> f64 {
        let radius = solution.geometry.driver.base;
        let whole = match self.unit {
            "m" => radius,
            "m/s" => radius * inputs.speed,
            _ => 0.0,
        };
        if value.abs() < RESOLUTION * whole { 0.0 } else { value }
    }

    /// Significant digits of an interpolated value, at most as many as are reliable.
    #[must_use]
    pub fn digits_of(&self, interpolated: &Interpolated) -> usize {
        let is_of_motion = ["force", "load_share", "transmission_error"].contains(&self.key);
        let is_between = interpolated.is_between && is_of_motion;
        if is_between { self.digits.min(DIGITS_BETWEEN) } else { self.digits }
    }

    /// The value at a station in SI, if it is a number; zero has no sign.
    #[must_use]
    pub fn of(&self, solution: &Solution, station: &Station) -> Option<f64> {
        (self.value)(solution, station).filter(|value| value.is_finite()).map(|value| value + 0.0)
    }
}
