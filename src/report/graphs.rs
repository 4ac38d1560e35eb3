//! The table of charts: the name of each chart and its columns of the stations.

use super::stations::{self, COLUMNS, Column, MESH_STIFFNESS};
use crate::model::inputs::Method;
use crate::model::{Solution, Station};

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
    #[must_use]
    pub fn column(&self, method: Method) -> Option<&'static Column> {
        let own = stations::columns(method).find(|column| self.columns.contains(&column.key));
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
                let own =
                    stations::columns(method).filter(|column| graph.columns.contains(&column.key));
                assert!(own.count() <= 1, "{} {method:?}", graph.key);
            }
            let units: Vec<_> = graph.all_columns().map(|column| column.shown).collect();
            assert!(units.windows(2).all(|pair| pair[0] == pair[1]), "{units:?}");
        }
    }
}
