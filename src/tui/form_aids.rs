//! Help for the form: stepping of values, units and ranges, the words of problems, materials, and the
//! search of fields.

pub(crate) mod materials;
mod search;

use std::sync::LazyLock;

use crate::case::fields::{Absent, FIELDS, Field, Kind, index_of};
use crate::case::units::{self, Dimension, Open, System};
use crate::case::{Case, Limit, MISSING, Problem, Spread, changes};
use crate::model::Quantity;
use crate::numeric::decimal::significant;

pub(crate) use search::{COMMAND, Entry, HELP, LABEL, query};

/// Significant digits of the ends of a range that is not printed as in the table of fields.
const RANGE_DIGITS: usize = 3;

/// Quotes: a file needs them around a value, and a message has them around typed text.
const MARKS: [char; 2] = ['"', TYPED];
const TYPED: char = '`';

impl Field {
    /// The typed value in the usual unit of the field, see [`units::converted`].
    pub(crate) fn converted(&self, typed: &str, system: System) -> Option<String> {
        let Kind::Number(dimension, ..) = self.kind else { return None };
        units::converted(typed, dimension, self.usual_unit(), system)
    }

    /// An example in a unit; in another than the usual unit it has one digit.
    pub(crate) fn example_in(&self, unit: &str) -> String {
        let example = self.example();
        let Kind::Number(dimension, ..) = self.kind else { return example.to_owned() };
        match units::parse(example, dimension, "") {
            Ok(value) if unit != self.usual_unit() => {
                let round = format!("{:.0e}", units::per(value, unit)).parse::<f64>();
                format!("{} {unit}", round.unwrap_or(value))
            }
            _ => example.to_owned(),
        }
    }

    /// The least and the greatest value as in [`Field::range_text`]; in another unit they are
    /// rounded.
    pub(crate) fn range_in(&self, unit: &str) -> String {
        match self.kind {
            Kind::Number(_, range, _) if unit != range.unit => {
                let [from, to] = [range.unit, unit].map(|unit| units::factor(unit).unwrap_or(1.0));
                let end = |value: f64| significant(value * from / to, RANGE_DIGITS);
                format!("about {} to {} {unit}", end(range.from), end(range.to))
            }
            _ => self.range_text(),
        }
    }
}

/// The dimension and unit of a displayed number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measure {
    pub(crate) dimension: Dimension,
    /// The unit of a bare number if no other unit was written; empty for a bare number.
    pub(crate) unit: &'static str,
    /// The least value, in SI.
    least: f64,
}

impl Measure {
    /// The measure of the numbers of a field; `None` for texts and names.
    pub(crate) fn of_field(field: &Field, system: System) -> Option<Measure> {
        Some(match field.kind {
            Kind::Number(dimension, range, _) => Measure {
                dimension,
                unit: system.unit(field.usual_unit()),
                least: range.from * units::factor(range.unit).unwrap_or(1.0),
            },
            Kind::Count(from, ..) => {
                Measure { dimension: Dimension::Number, unit: "", least: f64::from(from) }
            }
            _ => return None,
        })
    }

    /// The measure of the limit of a quantity.
    pub(crate) fn of_quantity(quantity: &Quantity, system: System) -> Option<Measure> {
        let dimension = Dimension::of_unit(quantity.unit)?;
        let unit = if quantity.shown == "1" { "" } else { system.unit(quantity.shown) };
        Some(Measure { dimension, unit, least: f64::NEG_INFINITY })
    }

    /// Whether further typing may complete an invalid text: with a unit, or with digits if the
    /// number is too small.
    pub(crate) fn is_unfinished(&self, typed: &str) -> bool {
        let value = units::parse(typed, self.dimension, "");
        let is_too_small = value.map_or(true, |value| value < self.least);
        // No further typing makes a negative number positive.
        let digits = typed.trim().strip_prefix('-').unwrap_or_default();
        let is_negative = digits.contains(|c: char| matches!(c, '1'..='9'));
        match units::open(typed, self.dimension) {
            Some(_) if self.least >= 0.0 && is_negative => false,
            Some(Open::Unit) => true,
            Some(Open::Number) => self.dimension != Dimension::Number || is_too_small,
            None => false,
        }
    }
}

impl Case {
    /// The text of a field after a step from its text, otherwise from its default. A field that its
    /// alternative replaces has no step.
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
pub(crate) fn step(text: &str, field: usize, by: isize) -> Option<String> {
    match FIELDS[field].kind {
        Kind::Text | Kind::List(_) => None,
        Kind::Choice(names, _) => named(text, names, by),
        Kind::Number(..) | Kind::Count(..) => moved(text, by, |text| is_taken(field, text)),
    }
}

/// The text of a limit after steps of its last digit, not below zero.
pub(crate) fn step_limit(text: &str, quantity: &str, by: isize) -> Option<String> {
    moved(text, by, |text| Limit::new(quantity, text).is_ok_and(|limit| limit.value >= 0.0))
}

/// The text of a distribution after steps of the last digit of its width.
pub(crate) fn step_spread(spread: &Spread, by: isize) -> Option<String> {
    let text = |width: &str| format!("{} {width}", spread.shape.name());
    moved(spread.written_width(), by, |width| Spread::new(spread.field, &text(width)).is_ok())
        .map(|width| text(&width))
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

/// Every key inside a table, the longest first, so that no key matches the start of another.
static KEYS: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let keys = FIELDS.iter().map(|field| field.key);
    let mut keys: Vec<&'static str> = keys.filter(|key| key.contains('.')).collect();
    keys.sort_by_key(|key| std::cmp::Reverse(key.len()));
    keys
});

impl Problem {
    /// The problem as the form shows it, where field and text are visible: `write 5 mm` for `write
    /// "5 mm"`, a label for a key, no advice to add a line to a file. Files keep the original.
    pub(crate) fn for_form(&self) -> Problem {
        let example = self.fix.split_once(" = ").filter(|_| &*self.code == MISSING);
        let example = example.and_then(|(_, example)| example.split(" under [").next());
        let fix = match example {
            Some(example) => format!("write {example}, for example").replace(MARKS, ""),
            None => for_form(&self.fix),
        };
        Problem {
            code: self.code.clone(),
            ..Problem::new(&called(&self.field), for_form(&self.cause), fix)
        }
    }
}

/// A sentence for a file or a command line, reworded for the form.
fn for_form(sentence: &str) -> String {
    // A key inside typed text, between two quotes, does not change.
    let parts = sentence.split(TYPED).enumerate().map(|(at, part)| {
        let may_have_key = at % 2 == 0 && part.contains('.');
        let keys = KEYS.iter().filter(|key| may_have_key && part.contains(**key));
        keys.fold(part.to_owned(), |text, key| text.replace(key, &called(key)))
    });
    parts.collect::<String>().replace(MARKS, "")
}

/// The name of the field of a key: `module`, `the driver's tip relief`, `limit of impact force`,
/// `spread of module`; the key itself if it belongs to no field.
fn called(key: &str) -> String {
    if let Some(field) = index_of(key) {
        let Field { label, .. } = FIELDS[field];
        return match FIELDS[field].table() {
            "driver" => format!("the driver's {label}"),
            "driven" => format!("the driven gear's {label}"),
            _ => label.to_owned(),
        };
    }
    changes::label(key)
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
    fn a_hint_shows_the_value_in_the_usual_unit_and_the_range_in_any() {
        assert_eq!(
            field("operation.power").converted("20 hp", System::Metric).as_deref(),
            Some("= 14.914 kW")
        );
        assert_eq!(field("driver.teeth").converted("20", System::Metric), None);
        assert_eq!(field("pair.module").range_in("mm"), "0.05 to 50 mm");
        assert_eq!(field("pair.module").range_in("in"), "about 0.00197 to 1.97 in");
        assert_eq!(field("driven.tip_relief").text_in("0 um", "thou"), "0 thou");
        assert_eq!(field("driver.face_width").example_in("in"), "0.3 in");
        assert_eq!(field("operation.torque").example_in("lbf ft"), "50 lbf ft");
        assert_eq!(field("driver.teeth").range_in(""), "5 to 1000");
        assert_eq!(field("operation.speed").range_in("rpm"), "0.001 to 1000000 rpm");
    }

    fn is_unfinished(key: &str, typed: &str) -> bool {
        crate::tui::rows::is_unfinished(&Case::empty(), index_of(key).unwrap(), typed)
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

    fn said(key: &str, text: &str) -> String {
        let mut case = Case::table_1();
        let field = index_of(key).unwrap();
        case.write(field, text);
        let problem = case
            .inputs()
            .unwrap_err()
            .into_iter()
            .find(|problem| problem.field == key)
            .unwrap()
            .for_form();
        format!("{}: {}", problem.cause, problem.fix)
    }

    #[test]
    fn a_form_names_visible_labels_instead_of_keys() {
        for (key, text, sentence) in [
            (
                "pair.module",
                "",
                "neither module nor diametral pitch is given: write 5 mm, for example",
            ),
            ("driver.teeth", "", "a required value is missing: write 20, for example"),
            ("pair.module", "5", "5 has no unit, and a length needs one: write 5 mm"),
            (
                "pair.module",
                "60 mm",
                "60 mm is above the limit of 50 mm: write a value from 0.05 to 50 mm",
            ),
            ("operation.power", "", "neither power nor torque is given: write 15 kW, for example"),
            ("operation.torque", "70 N m", "power and torque are both given: remove one of them"),
            ("model.method", "exat", "unknown choice exat: did you mean exact?"),
            (
                "pair.module",
                "driver.teeth",
                "driver.teeth does not begin with a number: write a number and its unit, such as 20 mm",
            ),
        ] {
            assert_eq!(said(key, text), sentence);
        }
    }

    #[test]
    fn a_field_is_named_by_its_label_and_its_gear() {
        assert_eq!(called("pair.module"), "module");
        assert_eq!(called("driven.tip_relief_length"), "the driven gear's tip relief length");
        assert_eq!(called("limits.impact_force"), "limit of impact force");
        assert_eq!(called("spread.\"driver.tip_relief\""), "spread of driver tip relief");
        assert_eq!(called("pair.modul"), "pair.modul");
        assert_eq!(
            for_form("set model.tooth_compliance to beam, or leave it out"),
            "set tooth compliance to beam, or leave it out"
        );
    }

    #[test]
    fn no_message_of_a_form_refers_to_a_file() {
        let wrong = [
            "",
            "5",
            "x",
            "1e999 mm",
            "5 kg",
            "4,5 mm",
            "-1",
            "5 mm 5",
            "99999999 GPa",
            "nan",
            "−5 mm",
            "5 mmm",
        ];
        for (index, field) in
            FIELDS.iter().enumerate().filter(|(_, field)| !matches!(field.kind, Kind::Text))
        {
            for text in wrong {
                let mut case = Case::table_1();
                case.write(index, text);
                for problem in
                    case.inputs().err().into_iter().flatten().map(|problem| problem.for_form())
                {
                    let said = problem.to_string();
                    let key = FIELDS
                        .iter()
                        .find(|field| field.key.contains('.') && said.contains(field.key));
                    assert!(
                        key.is_none() && !said.contains(['"', '`', '[']) && !said.contains("add "),
                        "{} = {text}: {said}",
                        field.key
                    );
                }
            }
        }
    }

    #[test]
    fn a_file_is_described_as_before() {
        let mut case = Case::table_1();
        case.write(index_of("pair.module").unwrap(), "5");
        let problem = case.inputs().unwrap_err().remove(0);
        assert_eq!((problem.field.as_str(), &*problem.fix), ("pair.module", "write \"5 mm\""));
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
