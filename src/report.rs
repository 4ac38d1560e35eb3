//! Reports: the results of a solve as text, tables, data and pictures.

pub mod chart;
pub mod charts;
pub mod compare;
pub mod data;
pub mod digest;
pub mod explain;
pub mod fields;
pub mod page;
pub mod relief;
pub mod solve;
pub mod stations;
pub mod studies;
pub mod svg;
pub mod swept;
pub mod table;
pub mod teeth;
pub mod tolerance;
pub mod trade;
pub mod verdict;

use self::table::{Cell, Column, Named, Table};
use self::verdict::Absence;
use crate::case::Case;
use crate::case::fields::index_of;
use crate::case::units::{self, System};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Note, QUANTITIES, Quantity, Solution, Stage, Stages};
use crate::numeric::decimal::significant;
use serde::{Serialize, Serializer};
#[cfg(all(unix, feature = "tui"))]
pub(crate) use table::{flow_by, with_units};

/// A value as text with its unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// The number, rounded to the quantity's digits.
    pub number: String,
    /// The unit; empty for a bare number.
    pub unit: &'static str,
}

impl Serialize for Shown {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

impl std::fmt::Display for Shown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.unit {
            "" => f.write_str(&self.number),
            unit => write!(f, "{} {unit}", self.number),
        }
    }
}

/// The requested parts of a solve.
#[derive(Debug, Clone, Default)]
pub struct Selection {
    /// The requested quantities; empty for every quantity.
    pub only: Vec<&'static Quantity>,
    /// Whether to include the stations between D and E.
    pub stations: bool,
}

impl Selection {
    /// Whether every quantity is requested.
    pub fn is_whole(&self) -> bool {
        self.only.is_empty()
    }

    /// The requested quantities in their order; all quantities in the order of the table if none is
    /// named.
    pub fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let table = if self.is_whole() { QUANTITIES } else { &[] };
        self.only.iter().copied().chain(table)
    }

    /// The value of a quantity that is requested, or in the list of every quantity of a solution.
    fn value(&self, quantity: &Quantity, solution: &Solution) -> Option<f64> {
        let is_listed = !self.is_whole() || quantity.is_listed(solution);
        value(quantity, solution).filter(|_| is_listed)
    }

    /// The requested quantities that have a value, in SI: finite, and zero without a sign.
    pub fn values(&self, solution: &Solution) -> impl Iterator<Item = (&'static Quantity, f64)> {
        self.quantities().filter_map(|quantity| Some((quantity, self.value(quantity, solution)?)))
    }

    /// The stages that the requested quantities need.
    pub fn stages(&self) -> Stages {
        let stations = if self.stations { Stages::STATIONS } else { Stages::NONE };
        self.quantities().fold(stations, |stages, quantity| stages.and(quantity.stages()))
    }
}

/// A solved case, ready to be printed.
#[derive(Debug, Clone)]
pub struct Report {
    /// The name of the case, as the user gave it.
    pub name: String,
    /// The case as the user wrote it.
    pub case: Case,
    /// The inputs of the model.
    pub inputs: Inputs,
    /// The solution of the model.
    pub solution: Solution,
    /// Notes on the result.
    pub notes: Vec<Note>,
    /// The requested quantities and stations.
    pub selection: Selection,
    /// Solutions of other, fast methods for the verdict of text and pages.
    pub others: Vec<Solution>,
}

impl Report {
    /// A report of an existing solution.
    pub fn of(
        name: String,
        case: Case,
        inputs: Inputs,
        solution: Solution,
        selection: Selection,
    ) -> Report {
        let mut notes = model::notes(&inputs, &solution);
        notes.extend(selection.quantities().filter_map(|quantity| not_finite(quantity, &solution)));
        notes.extend(selection.only.iter().filter_map(|quantity| absent(quantity, &solution)));
        Report { name, case, inputs, solution, notes, selection, others: Vec::new() }
    }

    /// The case by its name and its title; not sanitized for a terminal.
    pub fn named(&self) -> Named<'_> {
        Named { name: &self.name, title: self.case.title() }
    }

    /// The text of a field as the user wrote it, empty without one; not sanitized for a terminal.
    pub fn text(&self, key: &str) -> &str {
        index_of(key).and_then(|field| self.case.text(field)).unwrap_or_default()
    }

    /// The requested quantities that have a value, in SI: finite, and zero without a sign.
    pub fn values(&self) -> impl Iterator<Item = (&'static Quantity, f64)> {
        self.selection.values(&self.solution)
    }
}

/// Whether a case leaves a field at its default.
fn is_default(at: usize, case: &Case) -> bool {
    let usual = Case::empty();
    match (case.value(at), usual.value(at)) {
        (Some(own), Some(usual)) => own.total_cmp(&usual).is_eq(),
        _ => case.is_replaced(at) || case.effective(at) == usual.effective(at),
    }
}

/// The notes that do not say the same for almost every case.
fn case_notes(notes: &[Note]) -> impl Iterator<Item = &Note> {
    notes.iter().filter(|note| !note.is_general)
}

/// Label and symbol of a quantity.
pub fn name_of(quantity: &Quantity) -> String {
    format!("{} {}", quantity.label.trim_start(), quantity.symbol)
}

/// Formats a value in SI with its usual metric unit.
pub fn shown(quantity: &Quantity, value: f64) -> Shown {
    shown_in(quantity, value, System::Metric)
}

/// Formats a value in SI in metric or inch units.
pub fn shown_in(quantity: &Quantity, value: f64, system: System) -> Shown {
    if quantity.is_flag() {
        return Shown { number: if value == 0.0 { "no" } else { "yes" }.to_owned(), unit: "" };
    }
    let (number, unit) = units::shown(value, quantity.shown, quantity.digits, system);
    Shown { number, unit }
}

/// The common unit of several values of a quantity, chosen for the greatest of them.
pub fn common_unit(
    quantity: &Quantity,
    values: impl Iterator<Item = f64>,
    system: System,
) -> &'static str {
    let greatest = values.map(f64::abs).filter(|value| value.is_finite()).fold(0.0, f64::max);
    units::unit_for(greatest, quantity.shown, quantity.digits, system)
}

/// The common unit of a quantity and, for a quantity of one gear, that of the other gear.
fn unit_of_gears<I: IntoIterator<Item = f64>>(
    quantity: &Quantity,
    values: impl Fn(&'static Quantity) -> I,
    system: System,
) -> &'static str {
    let stem = |of: &Quantity| {
        let key = of.key;
        key.strip_suffix("_driver").or_else(|| key.strip_suffix("_driven")).unwrap_or(key)
    };
    let alike = Quantity::all().filter(|other| stem(other) == stem(quantity));
    common_unit(quantity, alike.flat_map(values), system)
}

/// Formats a value in SI in a unit.
pub fn shown_with(quantity: &Quantity, value: f64, unit: &'static str) -> Shown {
    if quantity.is_flag() {
        return shown(quantity, value);
    }
    Shown { number: units::counted(value, unit, quantity.digits), unit: units::named(unit) }
}

/// The value of a quantity in SI, if any: finite, and zero without a sign.
pub fn value(quantity: &Quantity, solution: &Solution) -> Option<f64> {
    quantity.finite_value(solution)
}

/// The value of a quantity in SI as another method defines the quantity, for a comparison of both.
pub fn value_as_in(quantity: &Quantity, solution: &Solution, other: Method) -> Option<f64> {
    match quantity.key {
        "equivalent_error" => {
            Some(solution.deviation.equivalent_error_as_in(solution.method, other) + 0.0)
        }
        _ => value(quantity, solution),
    }
}

/// Formats a value in SI in another unit, with `digits` significant digits.
pub fn number(value: f64, unit: &str, digits: usize) -> String {
    significant(units::per(value, unit), digits)
}

fn not_finite(quantity: &Quantity, solution: &Solution) -> Option<Note> {
    (quantity.value)(solution.having(quantity.stage)).filter(|value| !value.is_finite()).map(|_| {
        let message = format!("{} exceeds the range of numbers and is omitted", quantity.key);
        Note::case("not-finite", message)
    })
}

/// Why a requested quantity has no value.
fn absent(quantity: &Quantity, solution: &Solution) -> Option<Note> {
    (quantity.value)(solution.having(quantity.stage)).is_none().then(|| {
        let absence = Absence::of(quantity, solution);
        Note::case("no-value", format!("{} has no value: {absence}", quantity.key))
    })
}

/// Start of the headings of the free impact if the method resolves the impact itself.
const FREE_IMPACT: &str = "Free impact at D, closed form: ";

/// A group of quantities.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    /// The heading.
    pub title: &'static str,
    /// The stages of its quantities.
    stages: &'static [Stage],
}

/// Every group, in the order of a closed form.
static GROUPS: [Group; 17] = [
    Group { title: "Geometry", stages: &[Stage::Geometry] },
    Group { title: "Load", stages: &[Stage::Load, Stage::Masses] },
    Group { title: "Deviation", stages: &[Stage::Deviation] },
    Group { title: "Tip relief", stages: &[Stage::Clearing] },
    Group { title: "First contact D", stages: &[Stage::Position] },
    Group { title: "Velocity at D", stages: &[Stage::Velocity] },
    Group { title: "Impact", stages: &[Stage::Compliance, Stage::Impact, Stage::Band] },
    Group { title: "Friction", stages: &[Stage::Friction] },
    Group { title: "From D to E", stages: &[Stage::Stations] },
    Group { title: "Figures of ISO 21771 and ISO 6336-1", stages: &[Stage::Figures] },
    Group { title: "Mesh", stages: &[Stage::Mesh] },
    Group { title: "Load sharing", stages: &[Stage::Static] },
    Group { title: "Load sharing with inertia", stages: &[Stage::Dynamic] },
    Group { title: "Resonance", stages: &[Stage::Resonance] },
    Group {
        title: "Transmission error without base pitch deviations",
        stages: &[Stage::StaticSpectrum],
    },
    Group { title: "Steady motion without base pitch deviations", stages: &[Stage::SteadyMotion] },
    Group {
        title: "Greatest dynamic factor over the speed, without base pitch deviations",
        stages: &[Stage::SpeedRun],
    },
];

impl Group {
    /// Its quantities, in the order of the table.
    pub fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let stages = self.stages;
        QUANTITIES.iter().filter(move |quantity| stages.contains(&quantity.stage))
    }

    /// Whether the group belongs to the free impact while the method resolves the impact.
    pub fn is_beside(&self, method: Method) -> bool {
        method.shares_load() && self.quantities().any(Quantity::is_of_free_impact)
    }

    /// The heading in the results of a method.
    pub fn heading(&self, method: Method) -> String {
        if self.is_beside(method) {
            return format!("{FREE_IMPACT}{}{}", self.title[..1].to_lowercase(), &self.title[1..]);
        }
        self.title.to_owned()
    }

    // The last stages first; the closed form of the resolved impact at the end.
    fn rank(&self, method: Method) -> usize {
        match self.stages {
            _ if !method.shares_load() => 0,
            [Stage::Dynamic] => 1,
            [Stage::Static] => 2,
            [
                Stage::Clearing
                | Stage::Mesh
                | Stage::Resonance
                | Stage::StaticSpectrum
                | Stage::SteadyMotion
                | Stage::SpeedRun,
            ] => 3,
            _ if self.is_beside(method) => 5,
            _ => 4,
        }
    }
}

/// The groups in the order of a method.
pub fn groups(method: Method) -> Vec<&'static Group> {
    let mut groups: Vec<&Group> = GROUPS.iter().collect();
    groups.sort_by_key(|group| group.rank(method));
    groups
}

/// The tables of the groups that have rows, in the order of a method.
fn grouped(
    method: Method,
    columns: &[Column],
    row: impl Fn(&'static Quantity) -> Option<Vec<Cell>>,
) -> Vec<Table> {
    let tables = groups(method).into_iter().map(|group| {
        Table::new(group.heading(method), columns.to_vec())
            .with(group.quantities().filter_map(&row))
    });
    tables.filter(|table| !table.rows.is_empty()).collect()
}

/// Every quantity in the same order.
pub fn quantities(method: Method) -> impl Iterator<Item = &'static Quantity> {
    groups(method).into_iter().flat_map(Group::quantities)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(value: f64, unit: &'static str, digits: usize) -> String {
        let quantity = Quantity { shown: unit, digits, ..QUANTITIES[0] };
        shown(&quantity, value).to_string()
    }

    #[test]
    fn a_value_has_its_significant_digits_in_the_unit_a_person_reads() {
        assert_eq!(text(0.047_891_485, "mm", 6), "47.8915 mm");
        assert_eq!(text(2191.016, "N", 5), "2191.0 N");
        assert_eq!(text(-12.345e-6, "um", 3), "-12.3 um");
        assert_eq!(text(1.556_844, "1", 5), "1.5568");
    }

    #[test]
    fn numbers_have_plain_notation_in_a_readable_range_and_an_exponent_outside() {
        assert_eq!(text(0.001_234_56, "N", 3), "0.00123 N");
        assert_eq!(text(0.000_999_4, "N", 3), "9.99e-4 N");
        assert_eq!(text(0.000_999_6, "N", 3), "0.00100 N");
        assert_eq!(text(123_456.7, "N", 5), "123.46 kN");
        assert_eq!(text(999_999.9, "N", 5), "1000.0 kN");
        assert_eq!(text(9.9996, "N", 4), "10.00 N");
    }

    #[test]
    fn no_value_reads_as_nan_or_as_minus_zero() {
        assert_eq!(text(-0.0, "N", 5), "0 N");
        assert_eq!(text(f64::NAN, "1", 5), "n/a");
        assert_eq!(text(f64::INFINITY, "1", 5), "n/a");
    }

    #[test]
    fn every_quantity_is_shown_in_units_that_are_read_back_as_its_value() {
        let measured = QUANTITIES.iter().filter(|quantity| !quantity.is_flag());
        for (quantity, system) in
            measured.flat_map(|quantity| System::ALL.map(|system| (quantity, system)))
        {
            let dimension = units::Dimension::of_unit(quantity.unit).unwrap();
            let text = shown_in(quantity, 0.123_456_7, system).to_string();
            let read = units::parse(&text, dimension, "").unwrap();
            assert!((read / 0.123_456_7 - 1.0).abs() < 6e-4, "{}: {text}", quantity.key);
        }
    }

    #[test]
    fn a_selection_runs_the_stages_of_its_quantities_alone() {
        let only = |keys: &[&str]| Selection {
            only: keys.iter().filter_map(|key| Quantity::find(key)).collect(),
            stations: false,
        };
        assert_eq!(only(&["approach_angle_driven"]).stages(), Stages::of(Stage::Position));
        let both = only(&["contact_ratio", "normal_velocity"]).stages();
        assert!(
            both.has(Stage::Velocity) && !both.has(Stage::Compliance) && !both.has(Stage::Stations)
        );
        let whole = Selection::default().stages();
        assert!(
            QUANTITIES.iter().all(|quantity| whole.has(quantity.stage))
                && !whole.has(Stage::Stations)
        );
        assert!(
            Selection { stations: true, ..only(&["contact_ratio"]) }.stages().has(Stage::Stations)
        );
    }

    #[test]
    fn a_selection_of_the_motion_has_the_verdict_of_the_exit() {
        let mut case = Case::table_1();
        case.set("driven.tip_relief", "80 um").unwrap();
        case.set("model.method", "dynamic").unwrap();
        let only = Quantity::find("dynamic_peak_force").into_iter().collect();
        let selection = Selection { only, stations: false };
        let (_, solution) = selection.solve(case.inputs().unwrap()).unwrap();
        let verdict = digest::sentence(&solution, System::Metric, false);
        assert!(verdict.starts_with("Corner contact at the exit "), "{verdict}");
    }

    #[test]
    fn every_quantity_is_in_one_group() {
        for method in Method::ALL {
            let mut keys: Vec<_> = quantities(method).map(|quantity| quantity.key).collect();
            keys.sort_unstable();
            let mut all: Vec<_> = QUANTITIES.iter().map(|quantity| quantity.key).collect();
            all.sort_unstable();
            assert_eq!(keys, all);
        }
    }

    #[test]
    fn groups_begin_with_the_last_stage_and_end_with_the_closed_form() {
        for (method, first) in [
            (Method::Exact, Stage::Geometry),
            (Method::Static, Stage::Static),
            (Method::Dynamic, Stage::Dynamic),
        ] {
            let own = quantities(method)
                .find(|quantity| quantity.stage == first || !method.shares_load());
            assert_eq!(own.map(|own| own.stage), Some(first));
        }
        let order: Vec<_> = quantities(Method::Dynamic).collect();
        assert_eq!(order[0].stage, Stage::Dynamic);
        assert!(order.is_sorted_by_key(|quantity| quantity.is_of_free_impact()));
    }
}
