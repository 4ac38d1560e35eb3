//! Unit names of REXS.

use super::model::Attribute;
use crate::case::sanitize::quoted;
use crate::case::units::{self, Dimension};

/// The name in a case file. `None` for an unknown unit.
fn spelled(unit: &str) -> Option<&'static str> {
    Some(match unit {
        "mm" => "mm",
        "mum" | "µm" | "μm" | "um" => "um",
        "m" => "m",
        "°" | "deg" => "deg",
        "rad" => "rad",
        "N / mm^2" | "MPa" => "MPa",
        "Pa" => "Pa",
        "kg / dm^3" => "kg/dm3",
        "N m" => "N m",
        "kW" => "kW",
        "W" => "W",
        "1 / min" => "rpm",
        "rad / s" => "rad/s",
        "none" | "" => "",
        _ => return None,
    })
}

/// Greatest length of a number, in bytes.
const MOST_DIGITS: usize = 100;

/// The value with its unit as written in a case file, and in SI. The default unit is that of the
/// schema.
pub(super) fn read(
    attribute: &Attribute,
    dimension: Dimension,
    usual: &str,
) -> Result<(String, f64), String> {
    let unknown = || format!("the unit {:?} is unknown here", attribute.unit);
    let unit = spelled(&attribute.unit).ok_or_else(unknown)?;
    let unit = if unit.is_empty() { usual } else { unit };
    let number = attribute.value.as_str();
    let number = number.strip_suffix(".0").unwrap_or(number);
    if number.len() > MOST_DIGITS {
        return Err(format!("{} is too long for a number", quoted(number)));
    }
    let text = format!("{number} {unit}").trim_end().to_owned();
    let value = units::parse(&text, dimension, usual).map_err(|error| error.cause)?;
    Ok((text, value))
}
