//! Steps of a value: the last digit changes, and the rest of the text stays.

use crate::case::fields::{Absent, FIELDS, Kind};
use crate::case::{Case, Limit};

/// The text of a field after `by` steps of its last digit, within the range of the field: "16 um"
/// becomes "17 um", "0.50" becomes "0.51", "1e3 um" becomes "2e3 um". A count steps by whole
/// numbers, a choice to the next name. `None` if the text is empty or invalid, or if the range ends
/// here.
#[must_use]
pub(crate) fn step(text: &str, field: usize, by: i32) -> Option<String> {
    match FIELDS[field].kind {
        Kind::Text => None,
        Kind::Choice(names, _) => named(text, names, by),
        Kind::Number(..) | Kind::Count(..) => moved(text, by, |text| is_taken(field, text)),
    }
}

/// The text of a limit after steps of its last digit, not below zero.
#[must_use]
pub(crate) fn step_limit(text: &str, quantity: &str, by: i32) -> Option<String> {
    moved(text, by, |text| Limit::new(quantity, text).is_ok_and(|limit| limit.value >= 0.0))
}

impl Case {
    /// The text of a field after a step from its text, otherwise from its default. A field that its
    /// alternative replaces has no step.
    #[must_use]
    pub fn stepped(&self, field: usize, by: i32) -> Option<String> {
        let default =
            if let Absent::Default(text) = FIELDS[field].absent { Some(text) } else { None };
        let default = default.filter(|_| !self.is_replaced(field));
        step(self.text(field).or(default)?, field, by)
    }
}

/// Whether the field accepts the text by itself.
fn is_taken(field: usize, text: &str) -> bool {
    let mut case = Case::empty();
    case.write(field, text);
    !text.is_empty() && case.check_field(field).is_ok()
}

/// The name `by` places further in the list, or the last name in that direction.
fn named(text: &str, names: &[&str], by: i32) -> Option<String> {
    let at = names.iter().position(|name| *name == text.trim())?;
    let to = at.saturating_add_signed(isize::try_from(by).ok()?).min(names.len().saturating_sub(1));
    (to != at).then(|| names[to].to_owned())
}

/// The text after as many of the `by` steps as remain valid.
fn moved(text: &str, by: i32, is_taken: impl Fn(&str) -> bool) -> Option<String> {
    let number = Decimal::of(text)?;
    if !is_taken(text) {
        return None;
    }
    // The valid values are one interval: bisection finds the greatest valid number of steps.
    let (mut within, mut beyond) = (0, by.unsigned_abs() + 1);
    while beyond - within > 1 {
        let middle = within + (beyond - within) / 2;
        let is_within = number.moved(middle, by < 0).is_some_and(|text| is_taken(&text));
        *(if is_within { &mut within } else { &mut beyond }) = middle;
    }
    (within > 0).then(|| number.moved(within, by < 0)).flatten()
}

/// A text split into the digits of its number, the point and the rest.
#[derive(Debug, PartialEq, Eq)]
struct Decimal<'t> {
    /// Leading blanks.
    lead: &'t str,
    /// Whether the text has a plus sign.
    is_marked: bool,
    /// The digits without the point, with the sign.
    digits: i128,
    /// Number of digits before the point.
    whole: usize,
    /// Number of digits after the point.
    fraction: usize,
    has_point: bool,
    /// Exponent, blanks and unit.
    rest: &'t str,
}

impl<'t> Decimal<'t> {
    /// `None` if the text does not begin with a number, or if its digits overflow.
    fn of(text: &'t str) -> Option<Decimal<'t>> {
        let number = text.trim_start();
        let unsigned = number.strip_prefix(['+', '-']).unwrap_or(number);
        let (whole, after) = leading_digits(unsigned);
        let (fraction, rest) = after.strip_prefix('.').map_or(("", after), leading_digits);
        let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
        Some(Decimal {
            lead: &text[..text.len() - number.len()],
            is_marked: number.starts_with('+'),
            digits: if number.starts_with('-') { -digits } else { digits },
            whole: whole.len(),
            fraction: fraction.len(),
            has_point: after.starts_with('.'),
            rest,
        })
    }

    /// The text with the digits moved, with the same number of decimals and leading zeros.
    fn moved(&self, by: u32, down: bool) -> Option<String> {
        let by = i128::from(by);
        let digits = self.digits.checked_add(if down { -by } else { by })?;
        let sign = if digits < 0 { "-" } else { ["", "+"][usize::from(self.is_marked)] };
        let width = self.fraction + self.least_whole();
        let plain = format!("{:0width$}", digits.unsigned_abs());
        let (whole, fraction) = plain.split_at(plain.len() - self.fraction);
        let point = if self.has_point { "." } else { "" };
        Some(format!("{}{sign}{whole}{point}{fraction}{}", self.lead, self.rest))
    }

    /// Least number of digits before the point: those of "007", none of ".5".
    fn least_whole(&self) -> usize {
        let digits = self.digits.unsigned_abs().to_string().len().saturating_sub(self.fraction);
        if self.whole > digits { self.whole } else { self.whole.min(1) }
    }
}

/// The digits at the start, and the rest.
fn leading_digits(text: &str) -> (&str, &str) {
    text.split_at(text.bytes().take_while(u8::is_ascii_digit).count())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::fields::index_of;
    use crate::case::units::{Dimension, parse};
    use proptest::prelude::*;
    use proptest::sample::select;

    fn field(key: &str) -> usize {
        index_of(key).unwrap()
    }

    #[track_caller]
    fn steps(key: &str, text: &str, by: i32, to: Option<&str>) {
        assert_eq!(step(text, field(key), by).as_deref(), to, "{key} = {text} by {by}");
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
            ("deviations.base_pitch", " +9  µm", 1, " +10  µm"),
            ("deviations.base_pitch", ".9 um", 1, "1.0 um"),
            ("deviations.base_pitch", "5. um", 1, "6. um"),
            ("deviations.base_pitch", "007 um", 1, "008 um"),
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
        assert_eq!(case.stepped(field("driver.young"), 1).as_deref(), Some("207 GPa"));
        assert_eq!(case.stepped(field("driver.tip_relief"), 10).as_deref(), Some("10 um"));
        assert_eq!(case.stepped(field("model.deflection"), 1), None);
        assert_eq!(case.stepped(field("pair.module"), 1), None);
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
            let decimals = |text: &str| text.split_once('.').map(|(_, rest)| leading_digits(rest).0.len());
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
        fn no_text_makes_a_step_panic(text in ".*", by in any::<i32>(), field in 0..FIELDS.len()) {
            let next = step(&text, field, by);
            prop_assert!(next.is_none_or(|next| is_taken(field, &next)));
        }

        #[test]
        fn a_step_changes_the_value_by_its_last_digit(digits in -9999i32..9999, by in -20i32..20) {
            let text = format!("{:.1} um", f64::from(digits) / 10.0);
            let next = step(&text, index_of("deviations.base_pitch").unwrap(), by);
            let value = |text: &str| parse(text, Dimension::Length, "um").unwrap();
            let moved = next.map_or(0.0, |next| value(&next) - value(&text));
            prop_assert!((moved - f64::from(by) * 1e-7).abs() < 1e-15);
        }
    }
}
