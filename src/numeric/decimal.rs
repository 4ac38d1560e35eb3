//! Numbers as text.

/// The shortest text that parses to the same number: plain from 1e-4 to 1e7, otherwise with an
/// exponent.
pub fn shortest(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    if is_plain { format!("{value}") } else { format!("{value:e}") }
}

/// The number with 15 digits, so that a computed 0.5131 prints without rounding errors.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

/// A number with `digits` significant digits: plain from 1e-3 to 1e6, otherwise with an exponent.
/// Never NaN or minus zero.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "n/a".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    match rounded.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()) {
        Some(exponent @ -3..6) => {
            format!("{value:.*}", (digits + 2).saturating_sub(exponent.abs_diff(-3) as usize))
        }
        _ => rounded,
    }
}
