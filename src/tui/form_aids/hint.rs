//! The hint of a field: its usual unit, its range, its value in other units.

use crate::case::fields::{Absent, Field, Kind};
use crate::case::units::{self, System};
use crate::model::explanation::tidy;
use crate::numeric::decimal::significant;

/// Significant digits of the ends of a range that is not printed as in the table of fields.
const RANGE_DIGITS: usize = 3;

/// Significant digits of a derived value.
const DIGITS: usize = 5;

impl Field {
    /// The typed value in the usual unit of the field, see [`units::converted`].
    #[must_use]
    pub(crate) fn converted(&self, typed: &str, system: System) -> Option<String> {
        match self.kind {
            Kind::Number(dimension, ..) => {
                units::converted(typed, dimension, self.usual_unit(), system)
            }
            Kind::Text | Kind::Count(..) | Kind::Choice(..) => None,
        }
    }

    /// The default of a field, empty without one; a measure is in the units of the system.
    #[must_use]
    pub(crate) fn default_in(&self, system: System) -> String {
        let Absent::Default(text) = self.absent else {
            return String::new();
        };
        let unit = self.usual_unit();
        let measured = match self.kind {
            Kind::Number(dimension, ..) if system.unit(unit) != unit => {
                units::parse(text, dimension, "").ok()
            }
            _ => None,
        };
        measured.map_or_else(
            || text.to_owned(),
            |value| {
                let (number, unit) = units::system::shown(value, unit, RANGE_DIGITS, system);
                format!("{number} {unit}")
            },
        )
    }

    /// A value in SI in the usual unit of the field, with the digits of a hint.
    #[must_use]
    pub(crate) fn in_usual_unit(&self, value: f64) -> String {
        let unit = self.usual_unit();
        let number = tidy(value / units::factor(unit).unwrap_or(1.0), DIGITS);
        format!("{number} {unit}").trim_end().to_owned()
    }

    /// The least and the greatest value as in [`Field::range_text`]; in inch units they are
    /// rounded.
    #[must_use]
    pub(crate) fn range_in(&self, system: System) -> String {
        let Kind::Number(_, range, _) = self.kind else {
            return self.range_text();
        };
        let unit = system.unit(range.unit);
        if unit == range.unit {
            return self.range_text();
        }
        let factor = units::factor(range.unit).unwrap_or(1.0);
        let end = |value: f64| {
            significant(value * factor / units::factor(unit).unwrap_or(1.0), RANGE_DIGITS)
        };
        format!("about {} to {} {unit}", end(range.from), end(range.to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::fields::{FIELDS, index_of};

    fn field(key: &str) -> &'static Field {
        &FIELDS[index_of(key).unwrap()]
    }

    #[test]
    fn every_measure_has_a_usual_unit_of_its_dimension() {
        for field in &FIELDS {
            let Kind::Number(dimension, range, _) = field.kind else {
                continue;
            };
            let unit = field.usual_unit();
            assert_eq!(unit.is_empty(), range.unit.is_empty(), "{}", field.key);
            assert_eq!(units::Dimension::of_unit(unit), Some(dimension), "{}", field.key);
        }
    }

    #[test]
    fn a_hint_shows_the_value_in_the_usual_unit_and_the_range_in_both_systems() {
        assert_eq!(
            field("operation.power").converted("20 hp", System::Metric).as_deref(),
            Some("= 14.914 kW")
        );
        assert_eq!(field("driver.teeth").converted("20", System::Metric), None);
        assert_eq!(field("pair.module").range_in(System::Metric), "0.05 to 50 mm");
        assert_eq!(field("pair.module").range_in(System::Inch), "about 0.00197 to 1.97 in");
        assert_eq!(field("driven.tip_relief").default_in(System::Metric), "0 um");
        assert_eq!(field("driven.tip_relief").default_in(System::Inch), "0 thou");
        assert_eq!(field("driver.teeth").range_in(System::Inch), "5 to 1000");
        assert_eq!(field("operation.speed").range_in(System::Inch), "0.001 to 1000000 rpm");
    }
}
