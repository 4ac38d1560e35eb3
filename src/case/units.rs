//! Conversion between text with a unit and SI.

mod converted;
mod number;
pub mod system;
mod table;
mod typing;

use super::sanitize::{cut, quoted};
use super::suggest;
pub use converted::converted;
pub use system::System;
use table::{FAMILIES, Scale, Unit, name_of, units_of};
pub use typing::{Open, ending, open, written_unit};

/// The physical dimension of a field or a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// A bare number.
    Number,
    /// m.
    Length,
    /// rad.
    Angle,
    /// Pa.
    Pressure,
    /// kg/m³.
    Density,
    /// W.
    Power,
    /// N m.
    Torque,
    /// rad/s.
    AngularVelocity,
    /// N.
    Force,
    /// s.
    Time,
    /// m/s.
    Velocity,
    /// kg.
    Mass,
    /// J.
    Energy,
    /// kg m².
    Inertia,
    /// m²/N.
    Compliance,
    /// N/m.
    Stiffness,
    /// Hz.
    Frequency,
    /// 1/m.
    DiametralPitch,
}

impl Dimension {
    /// The dimension of a unit. "1" and "" are the bare number.
    #[must_use]
    pub fn of_unit(unit: &str) -> Option<Dimension> {
        if matches!(unit, "" | "1") {
            return Some(Dimension::Number);
        }
        FAMILIES
            .iter()
            .find(|family| find(unit, family.units).is_some())
            .map(|family| family.dimension)
    }

    /// The name of a value with its article, such as "a length".
    #[must_use]
    pub fn name(self) -> &'static str {
        name_of(self)
    }

    /// The SI unit; empty for the bare number.
    #[must_use]
    pub fn si_unit(self) -> &'static str {
        let mut units = units_of(self).iter();
        units.find(|unit| matches!(unit.scale, Scale::Ten(0))).map_or("", |unit| unit.symbol)
    }

    /// The symbols of its units, common units first.
    pub fn symbols(self) -> impl Iterator<Item = &'static str> {
        units_of(self).iter().map(|unit| unit.symbol)
    }
}

/// The reason why a text is not a value of the wanted dimension: the cause and the fix.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParseError {
    /// The cause.
    pub cause: String,
    /// How to fix it.
    pub fix: String,
}

impl ParseError {
    pub(super) fn new(cause: impl Into<String>, fix: impl Into<String>) -> ParseError {
        ParseError { cause: cause.into(), fix: fix.into() }
    }
}

/// The SI value of one unit. `None` for an unknown unit. "1" and "" have the factor 1.
#[must_use]
pub fn factor(unit: &str) -> Option<f64> {
    if matches!(unit, "" | "1") {
        return Some(1.0);
    }
    let unit = FAMILIES.iter().find_map(|family| find(unit, family.units))?;
    Some(match unit.scale {
        Scale::Ten(exponent) if exponent < 0 => 1.0 / 10f64.powi(-exponent),
        Scale::Ten(exponent) => 10f64.powi(exponent),
        Scale::Times(factor, _) => factor,
    })
}

/// The value in SI of a text such as "16 um": the nearest f64 if the unit is a power of ten of SI,
/// otherwise within one unit in the last place.
///
/// `usual` is the unit of the examples in errors.
///
/// # Errors
/// If the text is not one finite number with a unit of the dimension.
pub fn parse(text: &str, dimension: Dimension, usual: &str) -> Result<f64, ParseError> {
    let (number, unit) = number::split(text.trim(), usual)?;
    let scale = match (dimension, unit) {
        (Dimension::Number, "") => Scale::Ten(0),
        (Dimension::Number, _) => return Err(unit_unwanted(number, unit)),
        (_, "") => return Err(unit_missing(number, dimension, usual)),
        _ => find(unit, units_of(dimension)).ok_or_else(|| unit_wrong(unit, dimension))?.scale,
    };
    let value = match scale {
        Scale::Ten(exponent) => number::shifted(number, exponent),
        Scale::Times(factor, rest) => times(number::shifted(number, 0), factor, rest),
    };
    number::held(number, value)
}

/// The number and the unit of a text such as "16 um", as written. The unit is empty for a bare
/// number.
///
/// # Errors
/// If the text is not one number with at most one unit.
pub fn split<'t>(text: &'t str, usual: &str) -> Result<(&'t str, &'t str), ParseError> {
    number::split(text.trim(), usual)
}

/// The shortest text in the unit that [`parse`] converts to the same value, or to the nearest value
/// possible in this unit.
#[must_use]
pub fn text(value: f64, unit: &str) -> String {
    let number =
        match FAMILIES.iter().find_map(|family| find(unit, family.units)).map(|unit| unit.scale) {
            None => number::plain(value, 0),
            Some(Scale::Ten(exponent)) => number::plain(value, -exponent),
            Some(Scale::Times(factor, rest)) => {
                let near = number::plain(value / factor, 0);
                (12..17)
                    .map(|digits| format!("{:.digits$e}", value / factor))
                    .find(|short| {
                        times(number::shifted(short, 0), factor, rest).to_bits() == value.to_bits()
                    })
                    .map_or(near, |short| number::plain(number::shifted(&short, 0), 0))
            }
        };
    if matches!(unit, "" | "1") { number } else { format!("{number} {unit}") }
}

/// The product with a factor in two parts, rounded once.
fn times(number: f64, factor: f64, rest: f64) -> f64 {
    let high = number * factor;
    let low = number.mul_add(factor, -high) + number * rest;
    if high.is_finite() { high + low } else { high }
}

/// Length limit of a unit.
const LONGEST: usize = 64;

fn find(unit: &str, units: &'static [Unit]) -> Option<&'static Unit> {
    if unit.len() > LONGEST {
        return None;
    }
    let spelled =
        |text: &str| units.iter().find(|unit| unit.symbol == text || unit.aliases.contains(&text));
    spelled(unit).or_else(|| spelled(&plain_spelling(unit)))
}

/// Normalizes spellings such as `N·m`, `N*m`, `N-m`; `kg/m³`, `kg / m^3`; `µm`, `μm`.
fn plain_spelling(unit: &str) -> String {
    let mut plain = String::with_capacity(unit.len());
    for c in unit.chars() {
        match c {
            'µ' | 'μ' => plain.push('u'),
            '²' => plain.push('2'),
            '³' => plain.push('3'),
            '^' => {}
            '/' => {
                plain.truncate(plain.trim_end().len());
                plain.push('/');
            }
            ' ' | '\u{a0}' | '\u{202f}' | '·' | '⋅' | '*' | '-' => {
                if !plain.ends_with([' ', '/']) {
                    plain.push(' ');
                }
            }
            other => plain.push(other),
        }
    }
    plain
}

fn unit_unwanted(number: &str, unit: &str) -> ParseError {
    ParseError::new(
        format!("unit {} is not allowed here", quoted(unit)),
        format!("write {}", cut(number)),
    )
}

fn unit_missing(number: &str, dimension: Dimension, usual: &str) -> ParseError {
    let number = cut(number);
    ParseError::new(
        format!("{number} has no unit, and {} needs one", dimension.name()),
        format!("write \"{number} {usual}\""),
    )
}

fn unit_wrong(unit: &str, dimension: Dimension) -> ParseError {
    let fitting = dimension.symbols().collect::<Vec<_>>().join(", ");
    if let Some(other) = Dimension::of_unit(unit) {
        let cause =
            format!("{} is a unit of {}, not of {}", quoted(unit), bare(other), bare(dimension));
        return ParseError::new(cause, format!("use one of {fitting}"));
    }
    let (known, after) =
        unit.split_at(unit.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.').len());
    if !after.is_empty() && find(known.trim_end(), units_of(dimension)).is_some() {
        return ParseError::new(
            format!("{after} after the unit"),
            format!("write all digits before {}", known.trim_end()),
        );
    }
    let spellings = units_of(dimension)
        .iter()
        .flat_map(|unit| std::iter::once(&unit.symbol).chain(unit.aliases))
        .copied();
    let near = suggest::nearest(&plain_spelling(unit), spellings)
        .and_then(|near| find(near, units_of(dimension)));
    let fix = near.map(|near| near.symbol).map_or_else(
        || format!("use one of {fitting}"),
        |near| format!("did you mean {near}? Units here: {fitting}"),
    );
    ParseError::new(format!("unknown unit {}", quoted(unit)), fix)
}

fn bare(dimension: Dimension) -> &'static str {
    let name = dimension.name();
    name.split_once(' ').map_or(name, |(_, bare)| bare)
}

#[cfg(test)]
mod tests;
