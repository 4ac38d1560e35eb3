//! The one table of charts: which columns of the stations are drawn in one, and what it is called.

use super::stations::{self, COLUMNS, Column, Row};
use crate::model::Solution;
use crate::model::inputs::Method;

/// A chart over the roll angle. Where methods differ in how they call a value, all its columns are
/// drawn in one.
#[derive(Debug, Clone, Copy)]
pub struct Graph {
    /// The name in settings and palette.
    pub key: &'static str,
    /// The name in words.
    pub label: &'static str,
    /// Keys of the columns, of which each method has one or none.
    pub columns: &'static [&'static str],
    /// What the value is held against, and its symbol.
    pub bound: Option<Bound>,
}

/// What a value is held against.
#[derive(Debug, Clone, Copy)]
pub struct Bound {
    /// Its symbol in the methods `paper` and `exact`, and in those that share the load.
    pub symbols: [&'static str; 2],
    /// Its value at a station, in SI.
    pub value: fn(&Solution, Row) -> Option<f64>,
}

macro_rules! graph {
    ($key:literal, $label:literal, $columns:expr, $bound:expr) => {
        Graph {
            key: $key,
            label: $label,
            columns: &$columns,
            bound: $bound,
        }
    };
}

/// The tip touches where the gap is Δ; the pair carries where it is closed by more than the gap.
const CLOSED: Bound = Bound {
    symbols: ["Δ", "x+Δf_0"],
    value: |solution, row| match row {
        Row::Impact(_) => Some(solution.deviation.total),
        Row::Load(station) => Some(station.transmission_error + solution.mesh.as_ref()?.error),
    },
};

/// Every chart, the most asked for first.
#[rustfmt::skip]
pub static GRAPHS: [Graph; 9] = [
    graph!("force", "Force", ["impact_force", "force"], None),
    graph!("gap", "Gap", ["gap"], Some(CLOSED)),
    graph!("normal_velocity", "Approach velocity", ["normal_velocity"], None),
    graph!("sliding_velocity", "Sliding velocity", ["sliding_velocity"], None),
    graph!("load_share", "Load share", ["load_share"], None),
    graph!("pair_compliance", "Pair compliance", ["pair_compliance"], None),
    graph!("impact_energy", "Impact energy", ["impact_energy"], None),
    graph!("transmission_error", "Transmission error", ["transmission_error"], None),
    graph!("radius_driver", "Driver contact radius", ["radius_driver"], None),
];

impl Graph {
    /// The column that a method has.
    #[must_use]
    pub fn column(&self, method: Method) -> Option<&'static Column> {
        stations::columns(method).find(|column| self.columns.contains(&column.key))
    }

    /// Its columns.
    pub fn all_columns(&self) -> impl Iterator<Item = &'static Column> {
        let keys = self.columns;
        COLUMNS
            .iter()
            .filter(move |column| keys.contains(&column.key))
    }

    /// The methods that have a curve.
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
        for column in COLUMNS
            .iter()
            .filter(|column| !["rad", "s"].contains(&column.unit))
        {
            assert_eq!(
                GRAPHS
                    .iter()
                    .filter(|graph| graph.columns.contains(&column.key))
                    .count(),
                1,
                "{}",
                column.key
            );
        }
        for graph in &GRAPHS {
            assert_eq!(
                graph.all_columns().count(),
                graph.columns.len(),
                "{}",
                graph.key
            );
        }
    }

    #[test]
    fn a_method_has_one_curve_in_a_chart_and_all_columns_one_unit() {
        for graph in &GRAPHS {
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
