//! Typed text of a form: the unit that completes it, and whether it is invalid or unfinished.

use crate::case::Limit;
use crate::case::fields::{AUTO, Field, Kind};
use crate::case::units::{self, Dimension, Open, System};
use crate::model::Quantity;

/// The dimension and unit of a displayed number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measure {
    pub(crate) dimension: Dimension,
    /// The unit of a bare number if no other unit was written; empty for a bare number.
    pub(crate) unit: &'static str,
    /// The least value, in SI.
    pub(crate) least: f64,
}

impl Field {
    /// The dimension and unit of its numbers; `None` for texts and names.
    #[must_use]
    pub(crate) fn measure(&self, system: System) -> Option<Measure> {
        let least = |from: f64, unit: &str| from * units::factor(unit).unwrap_or(1.0);
        match self.kind {
            Kind::Number(dimension, range, _) => Some(Measure {
                dimension,
                unit: system.unit(self.usual_unit()),
                least: least(range.from, range.unit),
            }),
            Kind::Count(from, ..) => {
                Some(Measure { dimension: Dimension::Number, unit: "", least: f64::from(from) })
            }
            Kind::Text | Kind::Choice(..) => None,
        }
    }

    /// Whether an invalid text is merely unfinished: further typing may complete it.
    #[must_use]
    pub(crate) fn is_unfinished(&self, typed: &str) -> bool {
        let is_auto_begun = self.takes_auto() && AUTO.starts_with(typed.trim());
        is_auto_begun
            || self.measure(System::Metric).is_some_and(|measure| measure.is_unfinished(typed))
    }
}

impl Limit {
    /// The dimension and unit of the limit.
    #[must_use]
    pub(crate) fn measure(&self, system: System) -> Option<Measure> {
        let quantity = Quantity::find(self.quantity)?;
        let unit = if quantity.shown == "1" { "" } else { system.unit(quantity.shown) };
        Some(Measure {
            dimension: Dimension::of_unit(quantity.unit)?,
            unit,
            least: f64::NEG_INFINITY,
        })
    }
}

impl Measure {
    /// Whether further typing may complete an invalid text: with a unit, or with digits if the
    /// number is too small.
    #[must_use]
    pub(crate) fn is_unfinished(&self, typed: &str) -> bool {
        let is_too_small =
            || units::parse(typed, self.dimension, "").map_or(true, |value| value < self.least);
        // No further typing makes a negative number positive.
        let is_negative = || {
            typed
                .trim()
                .strip_prefix('-')
                .is_some_and(|digits| digits.contains(|c: char| matches!(c, '1'..='9')))
        };
        match units::open(typed, self.dimension) {
            Some(_) if self.least >= 0.0 && is_negative() => false,
            Some(Open::Unit) => true,
            Some(Open::Number) => self.dimension != Dimension::Number || is_too_small(),
            None => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::case::fields::{FIELDS, index_of};

    fn is_unfinished(key: &str, typed: &str) -> bool {
        FIELDS[index_of(key).unwrap()].is_unfinished(typed)
    }

    #[test]
    fn the_start_of_a_value_is_unfinished() {
        for (key, typed) in [
            ("pair.pressure_angle", "2"),
            ("driver.face_width", "8000"),
            ("driver.tip_relief", "48 m"),
            ("driver.tip_relief", "-"),
            ("driver.tip_relief", "-0"),
            ("driver.teeth", "3"),
            ("driver.profile_shift", "-."),
            ("model.stations", "au"),
        ] {
            assert!(is_unfinished(key, typed), "{key} {typed}");
        }
    }

    #[test]
    fn text_that_no_typing_completes_is_invalid() {
        for (key, typed) in [
            ("pair.pressure_angle", "31 rad"),
            ("pair.pressure_angle", "2 x"),
            ("driver.tip_relief", "48 umm"),
            ("driver.tip_relief", "-48"),
            ("driver.tip_relief", "-48 u"),
            ("driver.tip_relief", "-0.5"),
            ("driver.tip_relief", "48 mm"),
            ("driver.teeth", "2000"),
            ("driver.poisson", "0.9"),
            ("driver.poisson", "0.3 x"),
            ("model.stations", "many"),
            ("title", "a"),
        ] {
            assert!(!is_unfinished(key, typed), "{key} {typed}");
        }
    }
}
