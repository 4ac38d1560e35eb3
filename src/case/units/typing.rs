//! Completion of a value during typing: the missing unit, and whether further typing can make the
//! text valid.

use super::{Dimension, Unit, number, parse, plain_spelling, units_of};

/// The rest of a text that makes it a value: the unit after a bare number, or the rest of an
/// incomplete unit. `usual` is the unit of a bare number, and has priority for an incomplete unit;
/// otherwise only one unit may fit. `None` if the text is a value already, or cannot become one in
/// this way.
#[must_use]
pub fn ending(typed: &str, dimension: Dimension, usual: &str) -> Option<String> {
    let begun = begun_unit(typed, dimension)?;
    if begun.trim_end().is_empty() {
        let gap = if typed.ends_with(char::is_whitespace) { "" } else { " " };
        return Some(format!("{gap}{usual}")).filter(|_| !usual.is_empty());
    }
    if parse(typed, dimension, usual).is_ok() {
        return None;
    }
    let mut units = units_of(dimension).iter().filter_map(|unit| rest(unit, begun));
    let plain = plain_spelling(usual);
    let own = rest_of(usual, begun).or_else(|| rest_of(&plain, &plain_spelling(begun)));
    own.or_else(|| units.next().filter(|_| units.next().is_none())).map(str::to_owned)
}

/// How further typing can change a text into another value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Open {
    /// By more digits or a unit: the text is a number or the beginning of one.
    Number,
    /// By more letters of its unit.
    Unit,
}

/// How further typing can change a text into a value or another value. `None` if it cannot.
#[must_use]
pub fn open(typed: &str, dimension: Dimension) -> Option<Open> {
    let is_begun = |begun: &&str| {
        !begun.is_empty() && units_of(dimension).iter().any(|unit| rest(unit, begun).is_some())
    };
    if is_number_begun(typed.trim()) {
        return Some(Open::Number);
    }
    begun_unit(typed, dimension).filter(is_begun).map(|_| Open::Unit)
}

/// The unit of a value as written. `None` if the text is not a value.
#[must_use]
pub fn written_unit(text: &str, dimension: Dimension) -> Option<&str> {
    parse(text, dimension, "").ok()?;
    number::split(text.trim(), "").ok().map(|(_, unit)| unit).filter(|unit| !unit.is_empty())
}

/// The text after the number, with blanks at its end. `None` if there is no number or no unit is
/// needed.
fn begun_unit(typed: &str, dimension: Dimension) -> Option<&str> {
    let (_, unit) =
        number::split(typed.trim_start(), "").ok().filter(|_| dimension != Dimension::Number)?;
    Some(unit)
}

/// The missing rest of the unit: of its symbol, or of the first matching spelling.
fn rest(unit: &Unit, begun: &str) -> Option<&'static str> {
    let mut spellings = std::iter::once(unit.symbol).chain(unit.aliases.iter().copied());
    spellings.find_map(|spelling| {
        rest_of(spelling, begun).or_else(|| rest_of(spelling, &plain_spelling(begun)))
    })
}

fn rest_of<'u>(spelling: &'u str, begun: &str) -> Option<&'u str> {
    spelling.strip_prefix(begun).filter(|rest| !rest.is_empty())
}

/// Whether the text is only a number or the beginning of one, such as `-`, `0.` or `1e`.
fn is_number_begun(text: &str) -> bool {
    let digits = |text: &'_ str| text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let mantissa = &unsigned[unsigned.len() - digits(unsigned)..];
    let after = mantissa
        .strip_prefix('.')
        .map_or(mantissa, |fraction| &fraction[fraction.len() - digits(fraction)..]);
    let exponent = after.strip_prefix(['e', 'E']).filter(|_| after.len() < unsigned.len());
    let power = exponent.map_or(after, |power| power.strip_prefix(['+', '-']).unwrap_or(power));
    power.is_empty() || exponent.is_some() && digits(power) == 0
}

#[cfg(test)]
mod tests {
    use super::super::FAMILIES;
    use super::*;

    fn ended(typed: &str, dimension: Dimension, usual: &str) -> String {
        format!("{typed}{}", ending(typed, dimension, usual).unwrap_or_default())
    }

    #[test]
    fn a_bare_number_takes_the_usual_unit() {
        for (typed, whole) in [
            ("4", "4 um"),
            ("48", "48 um"),
            ("48 ", "48 um"),
            ("-48.5", "-48.5 um"),
            ("1e3", "1e3 um"),
            ("48 u", "48 um"),
            ("48u", "48um"),
            ("48 µ", "48 µm"),
            ("48 um", "48 um"),
            ("48 m", "48 m"),
            ("48 i", "48 in"),
            ("48 inc", "48 inch"),
            ("48 t", "48 thou"),
            ("48 mic", "48 micron"),
        ] {
            assert_eq!(ended(typed, Dimension::Length, "um"), whole);
        }
        assert_eq!(ended("71.6 N", Dimension::Torque, "N m"), "71.6 N m");
        assert_eq!(ended("71.6 N ", Dimension::Torque, "N m"), "71.6 N m");
        assert_eq!(ended("300 r", Dimension::AngularVelocity, "rpm"), "300 rpm");
        assert_eq!(ended("300 ra", Dimension::AngularVelocity, "rpm"), "300 rad/s");
        assert_eq!(ended("20 h", Dimension::Power, "kW"), "20 hp");
    }

    #[test]
    fn an_ambiguous_unit_or_an_invalid_number_is_not_completed() {
        for (typed, dimension, usual) in [
            ("48 M", Dimension::Pressure, "GPa"),
            ("48 x", Dimension::Length, "um"),
            ("48 m ", Dimension::Length, "mm"),
            ("-", Dimension::Length, "um"),
            ("", Dimension::Length, "um"),
            ("4,8", Dimension::Length, "um"),
            ("0.3", Dimension::Number, ""),
        ] {
            assert_eq!(ending(typed, dimension, usual), None, "{typed}");
        }
    }

    #[test]
    fn every_beginning_of_a_value_is_incomplete_not_invalid() {
        for family in &FAMILIES {
            let spellings = family
                .units
                .iter()
                .flat_map(|unit| std::iter::once(&unit.symbol).chain(unit.aliases));
            for unit in spellings.filter(|spelling| !spelling.starts_with('1')) {
                let whole = format!("-1.5e-3 {unit}");
                for (end, _) in whole.char_indices() {
                    let typed = &whole[..end];
                    let is_value = parse(typed, family.dimension, "").is_ok();
                    assert!(is_value || open(typed, family.dimension).is_some(), "{typed}");
                }
            }
        }
        for typed in ["fast", "4,8", "48 x", "48 um", "48 umm", "1.2.3", "e5", "4 8"] {
            assert_eq!(open(typed, Dimension::Length), None, "{typed}");
        }
    }

    #[test]
    fn the_completed_text_is_a_value() {
        for family in &FAMILIES {
            for unit in family.units {
                for end in 1..=unit.symbol.len() {
                    let typed = format!("2 {}", &unit.symbol[..end]);
                    let whole = ended(&typed, family.dimension, family.units[0].symbol);
                    let is_open = whole == typed;
                    assert!(
                        is_open || parse(&whole, family.dimension, "").is_ok(),
                        "{typed} becomes {whole}"
                    );
                }
            }
        }
    }
}
