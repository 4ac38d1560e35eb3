//! The values of the stations of the incoming tooth, and the charts of them.

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
    pub fn digits_of(&self, interpolated: &Interpolated) -> usize {
        let is_of_motion = ["force", "load_share", "transmission_error"].contains(&self.key);
        let is_between = interpolated.is_between && is_of_motion;
        if is_between { self.digits.min(DIGITS_BETWEEN) } else { self.digits }
    }

    /// The value at a station in SI, if it is a number; zero has no sign.
    pub fn of(&self, solution: &Solution, station: &Station) -> Option<f64> {
        (self.value)(solution, station).filter(|value| value.is_finite()).map(|value| value + 0.0)
    }
}

/// A chart over the roll angle, with a curve for each method or for each compliance model. Columns
/// of different methods that mean the same value share a chart.
#[derive(Debug, Clone, Copy)]
pub struct Graph {
    /// The key in the settings.
    pub key: &'static str,
    /// The name.
    pub label: &'static str,
    /// Keys of the columns; each method has at most one of them.
    pub columns: &'static [&'static str],
    /// The comparison value of the curve.
    pub bound: Option<Bound>,
    /// The value with one curve per compliance model; `None` for a chart of the stations.
    pub by_model: Option<&'static Column>,
    /// Whether the page of a report, which prints one case on two sheets, shows the chart.
    pub is_on_page: bool,
}

/// A comparison value of a curve.
#[derive(Debug, Clone, Copy)]
pub struct Bound {
    /// The symbol in `paper` and `exact`, and in `static` and `dynamic`.
    pub symbols: [&'static str; 2],
    /// The value at a station, in SI.
    pub value: fn(&Solution, &Station) -> Option<f64>,
}

macro_rules! graph {
    ($key:literal, $label:literal, $columns:expr, $bound:expr, $is_on_page:expr) => {
        Graph {
            key: $key,
            label: $label,
            columns: &$columns,
            bound: $bound,
            by_model: None,
            is_on_page: $is_on_page,
        }
    };
}

/// The tip touches where the gap is Δ. A pair carries load if x + Δf_0, its approach, exceeds the
/// gap.
const CLOSED: Bound = Bound {
    symbols: ["Δ", "x+Δf_0"],
    value: |solution, station| match station.transmission_error() {
        None => Some(solution.deviation.total),
        Some(displacement) => Some(displacement + solution.mesh.as_ref()?.error),
    },
};

/// Every chart, the most important first.
#[rustfmt::skip]
pub const GRAPHS: &[Graph] = &[
    graph!("force", "Force", ["impact_force", "force"], None, true),
    graph!("gap", "Gap", ["gap"], Some(CLOSED), true),
    graph!("normal_velocity", "Approach velocity", ["normal_velocity"], None, true),
    graph!("hertz_pressure", "Hertz pressure", ["hertz_pressure"], None, false),
    graph!("sliding_velocity", "Sliding velocity", ["sliding_velocity"], None, false),
    graph!("load_share", "Load share", ["load_share"], None, true),
    graph!("pair_compliance", "Pair compliance", ["pair_compliance"], None, false),
    Graph { by_model: Some(&MESH_STIFFNESS), ..graph!("mesh_stiffness", "Mesh stiffness", [], None, true) },
    graph!("impact_energy", "Impact energy", ["impact_energy"], None, false),
    graph!("transmission_error", "Transmission error", ["transmission_error"], None, true),
    graph!("radius_driver", "Driver contact radius", ["radius_driver"], None, false),
];

impl Graph {
    /// The column of a method.
    pub fn column(&self, method: Method) -> Option<&'static Column> {
        let own = columns(method).find(|column| self.columns.contains(&column.key));
        own.or(self.by_model)
    }

    /// The columns of every method.
    pub fn all_columns(&self) -> impl Iterator<Item = &'static Column> {
        let keys = self.columns;
        COLUMNS.iter().filter(move |column| keys.contains(&column.key)).chain(self.by_model)
    }

    /// The methods with a curve.
    pub fn methods(&self) -> impl Iterator<Item = Method> {
        Method::ALL
            .into_iter()
            .filter(|&method| method != Method::Auto && self.column(method).is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_of_a_station_is_in_one_chart() {
        for column in COLUMNS.iter().filter(|column| !["rad", "s"].contains(&column.unit)) {
            assert_eq!(
                GRAPHS.iter().filter(|graph| graph.columns.contains(&column.key)).count(),
                1,
                "{}",
                column.key
            );
        }
        for graph in GRAPHS {
            assert_eq!(graph.all_columns().count(), graph.columns.len().max(1), "{}", graph.key);
        }
    }

    #[test]
    fn a_method_has_one_curve_in_a_chart_and_all_columns_one_unit() {
        for graph in GRAPHS {
            for method in Method::ALL {
                let own = columns(method).filter(|column| graph.columns.contains(&column.key));
                assert!(own.count() <= 1, "{} {method:?}", graph.key);
            }
            let units: Vec<_> = graph.all_columns().map(|column| column.shown).collect();
            assert!(units.windows(2).all(|pair| pair[0] == pair[1]), "{units:?}");
        }
    }
}
