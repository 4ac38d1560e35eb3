//! The table of station values of the incoming tooth, for text, JSON, CSV and charts.

use crate::model::contact_state::DIGITS_BETWEEN;
use crate::model::inputs::Method;
use crate::model::{Inputs, Interpolated, MeshStation, Solution, Station};

/// A station of the incoming tooth.
#[derive(Debug, Clone, Copy)]
pub enum Row<'a> {
    /// Between D and E: the free impact if it happened at this station.
    Impact(&'a Station),
    /// From the first contact to the last, with load sharing.
    Load(&'a MeshStation),
}

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
    pub value: fn(Row) -> Option<f64>,
}

const CLOSED_FORM: &[Method] = &Method::CLOSED_FORM;
const SHARING: &[Method] = &[Method::Static, Method::Dynamic];
const EVERY: &[Method] = &Method::ALL;
const DYNAMIC: &[Method] = &[Method::Dynamic];

macro_rules! column {
    ($key:literal, $symbol:literal, $unit:literal, $shown:literal, $digits:literal, $methods:expr, $value:expr) => {
        Column {
            key: $key,
            symbol: $symbol,
            unit: $unit,
            shown: $shown,
            digits: $digits,
            methods: $methods,
            value: $value,
        }
    };
}

/// Every column, in the order of a row.
#[rustfmt::skip]
pub const COLUMNS: &[Column] = &[
    column!("roll_angle_driver", "θ_1", "rad", "deg", 5, EVERY, |row| Some(row.both(|s| s.roll_angle_driver, |s| s.roll_angle_driver))),
    column!("roll_angle_driven", "u", "rad", "deg", 5, EVERY, |row| Some(row.both(|s| s.roll_angle_driven, |s| s.roll_angle_driven))),
    column!("time", "t", "s", "us", 5, DYNAMIC, |row| row.load()?.time),
    column!("radius_driver", "O1J", "m", "mm", 5, CLOSED_FORM, |row| Some(row.impact()?.radius_driver)),
    column!("normal_velocity", "ΔV_n", "m/s", "m/s", 5, EVERY, |row| Some(row.both(|s| s.normal_velocity, |s| s.normal_velocity))),
    column!("sliding_velocity", "ΔV_τ", "m/s", "m/s", 5, EVERY, |row| Some(row.both(|s| s.sliding_velocity, |s| s.sliding_velocity))),
    column!("impact_force", "F_S", "N", "N", 5, CLOSED_FORM, |row| Some(row.impact()?.impact_force)),
    column!("force", "F", "N", "N", 5, SHARING, |row| Some(row.load()?.force)),
    column!("load_share", "F/ΣF", "1", "1", 4, SHARING, |row| Some(row.load()?.load_share)),
    column!("transmission_error", "x", "m", "um", 5, SHARING, |row| Some(row.load()?.transmission_error)),
    column!("gap", "S", "m", "um", 5, EVERY, |row| Some(row.both(|s| s.gap, |s| s.gap))),
    column!("pair_compliance", "q_s", "m2/N", "um mm/N", 5, EVERY, |row| row.both(|s| s.pair_compliance, |s| Some(s.pair_compliance))),
    column!("impact_energy", "E_k", "J", "J", 5, CLOSED_FORM, |row| Some(row.impact()?.impact_energy)),
];

/// The columns of the stations of a method.
pub fn columns(method: Method) -> impl Iterator<Item = &'static Column> + Clone {
    COLUMNS.iter().filter(move |column| column.methods.contains(&method))
}

/// The stations of the solution's method.
#[must_use]
pub fn rows(solution: &Solution) -> Vec<Row<'_>> {
    let loads = match solution.method {
        Method::Paper | Method::Exact | Method::Auto => {
            return solution.stations.iter().map(Row::Impact).collect();
        }
        Method::Static => solution.static_load.as_ref().map(|load| &load.stations),
        Method::Dynamic => solution.dynamic.as_ref().map(|dynamic| &dynamic.stations),
    };
    loads.into_iter().flatten().map(Row::Load).collect()
}

impl<'a> From<&'a Interpolated> for Row<'a> {
    fn from(interpolated: &'a Interpolated) -> Row<'a> {
        match interpolated {
            Interpolated::Impact(station) => Row::Impact(station),
            Interpolated::Load(station) | Interpolated::Between(station) => Row::Load(station),
        }
    }
}

impl<'a> Row<'a> {
    /// The driver's roll angle after E, in deg.
    #[must_use]
    pub fn angle_after_e(self) -> f64 {
        let before = self.both(|s| s.roll_angle_driver, |s| s.roll_angle_driver);
        0.0 - before.to_degrees()
    }

    fn both<T>(self, impact: fn(&Station) -> T, load: fn(&MeshStation) -> T) -> T {
        match self {
            Row::Impact(station) => impact(station),
            Row::Load(station) => load(station),
        }
    }

    fn impact(self) -> Option<&'a Station> {
        if let Row::Impact(station) = self { Some(station) } else { None }
    }

    fn load(self) -> Option<&'a MeshStation> {
        if let Row::Load(station) = self { Some(station) } else { None }
    }
}

/// Lengths and speeds below this fraction of the radii and speeds whose difference they are consist
/// of rounding errors.
const RESOLUTION: f64 = 1e-12;

/// The mesh stiffness over the path of contact. No station has this value: each compliance model
/// has its own curve.
pub static MESH_STIFFNESS: Column = Column {
    key: "mesh_stiffness",
    symbol: "k",
    unit: "N/m",
    shown: "N/um",
    digits: 4,
    methods: EVERY,
    value: |_| None,
};

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
        let is_between = matches!(interpolated, Interpolated::Between(_)) && is_of_motion;
        if is_between { self.digits.min(DIGITS_BETWEEN) } else { self.digits }
    }

    /// The value at a station in SI, if it is a number; zero has no sign.
    #[must_use]
    pub fn of(&self, row: Row<'_>) -> Option<f64> {
        (self.value)(row).filter(|value| value.is_finite()).map(|value| value + 0.0)
    }

    /// The value at a station as text without the unit; a dash if it is absent.
    #[must_use]
    pub fn printed(&self, row: Row<'_>) -> String {
        (self.value)(row)
            .map_or_else(|| "-".to_owned(), |value| super::number(value, self.shown, self.digits))
    }
}
