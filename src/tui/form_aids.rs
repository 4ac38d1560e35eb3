//! Help for the form: stepping of values, units and ranges, search of fields, materials.

pub(crate) mod materials;
mod search;
mod words;

use crate::case::fields::{AUTO, Absent, FIELDS, Field, Kind};
use crate::case::units::{self, Dimension, Open, System};
use crate::case::{Case, Limit};
use crate::model::Quantity;
use crate::model::explanation::tidy;
use crate::numeric::decimal::significant;

pub(crate) use search::{COMMAND, Entry, HELP, LABEL, query};

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
            _ => None,
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
                let (number, unit) = units::shown(value, unit, RANGE_DIGITS, system);
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
            _ => None,
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

/// The dimension and unit of a displayed number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measure {
    pub(crate) dimension: Dimension,
    /// The unit of a bare number if no other unit was written; empty for a bare number.
    pub(crate) unit: &'static str,
    /// The least value, in SI.
    pub(crate) least: f64,
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

impl Case {
    /// The text of a field after a step from its text, otherwise from its default. A field that its
    /// alternative replaces has no step.
    #[must_use]
    pub fn stepped(&self, field: usize, by: isize) -> Option<String> {
        let default =
            if let Absent::Default(text) = FIELDS[field].absent { Some(text) } else { None };
        let default = default.filter(|_| !self.is_replaced(field));
        step(self.text(field).or(default)?, field, by)
    }
}

/// The text of a field after `by` steps of its last digit, within the range of the field: "16 um"
/// becomes "17 um", "0.50" becomes "0.51", "1e3 um" becomes "2e3 um". A count steps by whole
/// numbers, a choice to the next name. `None` if the text is empty or invalid, or if the range ends
/// here.
#[must_use]
pub(crate) fn step(text: &str, field: usize, by: isize) -> Option<String> {
    match FIELDS[field].kind {
        Kind::Text | Kind::List(_) => None,
        Kind::Choice(names, _) => named(text, names, by),
        Kind::Number(..) | Kind::Count(..) => moved(text, by, |text| is_taken(field, text)),
    }
}

/// The text of a limit after steps of its last digit, not below zero.
#[must_use]
pub(crate) fn step_limit(text: &str, quantity: &str, by: isize) -> Option<String> {
    moved(text, by, |text| Limit::new(quantity, text).is_ok_and(|limit| limit.value >= 0.0))
}

/// Whether the field accepts the text by itself.
fn is_taken(field: usize, text: &str) -> bool {
    let mut case = Case::empty();
    case.write(field, text);
    !text.is_empty() && case.check_field(field).is_ok()
}

/// The name `by` places further in the list, or the last name in that direction.
fn named(text: &str, names: &[&str], by: isize) -> Option<String> {
    let at = names.iter().position(|name| *name == text.trim())?;
    let to = at.saturating_add_signed(by).min(names.len().saturating_sub(1));
    (to != at).then(|| names[to].to_owned())
}

/// The text after as many of the `by` steps as remain valid: the number keeps its decimals, and the
/// exponent and the unit after it stay.
fn moved(text: &str, by: isize, is_taken: impl Fn(&str) -> bool) -> Option<String> {
    let start = text.len() - text.trim_start().len();
    let is_part = |letter: char| letter.is_ascii_digit() || matches!(letter, '.' | '+' | '-');
    let end = text[start..].find(|letter| !is_part(letter)).map_or(text.len(), |at| start + at);
    let number = &text[start..end];
    let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let unit = 10f64.powi(i32::try_from(decimals).ok()?);
    let value: f64 = number.parse().ok().filter(|_| is_taken(text))?;
    let after = |steps: isize| {
        let digits = (value * unit).round() + (by.signum() * steps) as f64;
        let text = format!("{}{:.decimals$}{}", &text[..start], digits / unit + 0.0, &text[end..]);
        is_taken(&text).then_some(text)
    };
    (1..=by.abs()).rev().find_map(after)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::sample::select;

    use super::*;
    use crate::case::fields::index_of;
    use crate::case::units::parse;

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

    fn place_of(key: &str) -> usize {
        index_of(key).unwrap()
    }

    #[track_caller]
    fn steps(key: &str, text: &str, by: isize, to: Option<&str>) {
        assert_eq!(step(text, place_of(key), by).as_deref(), to, "{key} = {text} by {by}");
    }

    #[test]
    fn the_last_digit_moves_and_all_else_stays() {
        for (key, text, by, to) in [
            ("deviations.base_pitch", "16 um", 1, "17 um"),
            ("deviations.base_pitch", "16um", 10, "26um"),
            ("deviations.base_pitch", "1e3 um", 1, "2e3 um"),
            ("deviations.base_pitch", "1.0e3 um", 1, "1.1e3 um"),
            ("deviations.base_pitch", "-0.1 um", 1, "0.0 um"),
            ("deviations.base_pitch", "0.0 um", -1, "-0.1 um"),
            ("deviations.base_pitch", "1 um", -2, "-1 um"),
            ("deviations.base_pitch", " +9  µm", 1, " 10  µm"),
            ("deviations.base_pitch", ".9 um", 1, "1.0 um"),
            ("operation.speed", "2000 rpm", 1, "2001 rpm"),
            ("operation.speed", "1999.9 rpm", 1, "2000.0 rpm"),
            ("operation.speed", "10 rpm", -1, "9 rpm"),
            ("driver.profile_shift", "0.50", 1, "0.51"),
            ("driver.profile_shift", "0.50", -1, "0.49"),
            ("driver.teeth", "20", 1, "21"),
            ("driver.teeth", "20", -10, "10"),
            ("model.method", "paper", 1, "exact"),
            ("model.accurate", "true", -1, "false"),
        ] {
            steps(key, text, by, Some(to));
        }
    }

    #[test]
    fn a_step_ends_with_the_range_in_the_unit_that_was_typed() {
        steps("pair.module", "49.5 mm", 10, Some("50.0 mm"));
        steps("pair.module", "1.96 in", 1, None);
        steps("pair.module", "1.95 in", 10, Some("1.96 in"));
        steps("driver.tip_relief", "3 um", -10, Some("0 um"));
        steps("driver.tip_relief", "0 um", -1, None);
        steps("driver.teeth", "999", 10, Some("1000"));
        steps("driver.teeth", "5", -1, None);
        steps("model.method", "paper", -1, None);
        steps("driver.poisson", "0.499", 1, None);
    }

    #[test]
    fn a_step_does_not_change_an_invalid_value() {
        for (key, text) in [
            ("pair.module", ""),
            ("pair.module", "5"),
            ("pair.module", "60 mm"),
            ("pair.module", "4,5 mm"),
            ("pair.module", "mm"),
            ("driver.teeth", "20.5"),
            ("model.method", "exat"),
            ("title", "Table 1"),
            ("operation.power", "1e400 W"),
            ("operation.power", "9999999999999999999999999999999999999999999999999 W"),
        ] {
            steps(key, text, 1, None);
        }
    }

    #[test]
    fn an_empty_field_steps_from_its_default() {
        let case = Case::empty();
        assert_eq!(case.stepped(place_of("driver.young"), 1).as_deref(), Some("207 GPa"));
        assert_eq!(case.stepped(place_of("driver.tip_relief"), 10).as_deref(), Some("10 um"));
        assert_eq!(case.stepped(place_of("model.deflection"), 1), None);
        assert_eq!(case.stepped(place_of("pair.module"), 1), None);
    }

    #[test]
    fn a_limit_steps_and_stays_above_zero() {
        assert_eq!(step_limit("2500 N", "impact_force", 10).as_deref(), Some("2510 N"));
        assert_eq!(step_limit("2.5 kN", "impact_force", -1).as_deref(), Some("2.4 kN"));
        assert_eq!(step_limit("0.01", "dynamic_factor", -10).as_deref(), Some("0.00"));
        assert_eq!(step_limit("2500", "impact_force", 1), None);
    }

    /// A number as users type it, with a unit of the field.
    fn typed() -> impl Strategy<Value = (usize, String)> {
        let measures: Vec<usize> = (0..FIELDS.len())
            .filter(|&field| matches!(FIELDS[field].kind, Kind::Number(..) | Kind::Count(..)))
            .collect();
        let exponent = prop_oneof![6 => Just(String::new()), 1 => (-3..4).prop_map(|power| format!("e{power}"))];
        (select(measures), -10_000..10_000i32, 0..5u32, exponent, any::<prop::sample::Index>())
            .prop_map(|(field, digits, decimals, exponent, unit)| {
                let number = format!(
                    "{:.*}",
                    decimals as usize,
                    f64::from(digits) / 10f64.powi(decimals.cast_signed())
                );
                let unit = match FIELDS[field].kind {
                    Kind::Number(dimension, ..) => {
                        let symbols: Vec<&str> = dimension.symbols().collect();
                        symbols
                            .get(unit.index(symbols.len().max(1)))
                            .map(|unit| format!(" {unit}"))
                            .unwrap_or_default()
                    }
                    _ => String::new(),
                };
                (field, format!("{number}{exponent}{unit}"))
            })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

        #[test]
        fn a_step_gives_a_valid_value_and_can_be_reversed((field, text) in typed(), by in prop_oneof![Just(1), Just(10), Just(-1), Just(-10)]) {
            let Some(next) = step(&text, field, by) else { return Ok(()) };
            prop_assert!(is_taken(field, &next), "{}: {text} became {next}", FIELDS[field].key);
            let decimals = |text: &str| text.split_once('.').map(|(_, rest)| rest.bytes().take_while(u8::is_ascii_digit).count());
            prop_assert_eq!(decimals(&text), decimals(&next));
            // Away from the ends of the range the step was complete, and the step back restores the
            // text.
            let further = moved(&next, by, |text| is_taken(field, text));
            if further.is_some() && !text.starts_with("-0") {
                let back = step(&next, field, -by);
                prop_assert_eq!(back.as_deref(), Some(text.as_str()));
            }
        }

        #[test]
        fn no_text_makes_a_step_panic(text in ".*", by in -20..20isize, field in 0..FIELDS.len()) {
            let next = step(&text, field, by);
            prop_assert!(next.is_none_or(|next| is_taken(field, &next)));
        }

        #[test]
        fn a_step_changes_the_value_by_its_last_digit(digits in -9999i32..9999, by in -20isize..20) {
            let text = format!("{:.1} um", f64::from(digits) / 10.0);
            let next = step(&text, index_of("deviations.base_pitch").unwrap(), by);
            let value = |text: &str| parse(text, Dimension::Length, "um").unwrap();
            let moved = next.map_or(0.0, |next| value(&next) - value(&text));
            prop_assert!((moved - by as f64 * 1e-7).abs() < 1e-15);
        }
    }
}
