//! Load range and tolerance of a relief search, as text.

use super::Demand;
use crate::case::units::{self, Dimension};
use crate::numeric::decimal::shortest;

/// Parses a range of loads in percent, such as `25..110%`, or one load.
///
/// # Errors
/// Returns the syntax of a load range.
pub fn loads(text: &str) -> Result<(f64, f64), String> {
    const FIX: &str = "write a range above 0 % and up to 1000 %, such as 25..110%";
    let number = |text: &str| {
        let number = text.trim().trim_end_matches('%').trim_end();
        let percent: f64 = number.parse().map_err(|_| FIX.to_owned())?;
        let is_possible = percent > 0.0 && percent <= 1000.0;
        is_possible.then_some(percent / 100.0).ok_or(FIX.to_owned())
    };
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    let (from, to) = (number(from)?, number(to)?);
    if from > to {
        return Err(format!("the range is reversed: {FIX}"));
    }
    Ok((from, to))
}

/// Parses a length from 0 to 1 mm.
///
/// # Errors
/// Returns the syntax of a tolerance.
pub fn tolerance(text: &str) -> Result<f64, String> {
    const MOST: f64 = 1e-3;
    let length = units::parse(text, Dimension::Length, "um")
        .map_err(|error| format!("{}: {}", error.cause, error.fix))?;
    if (0.0..=MOST).contains(&length) {
        Ok(length)
    } else {
        Err("write a length from 0 um to 1 mm, such as '5 um'".to_owned())
    }
}

impl Demand {
    /// Parses a text such as `25..110 %, 5 um`; the tolerance is optional.
    ///
    /// # Errors
    /// Returns the correct syntax.
    pub fn parse(text: &str) -> Result<Demand, String> {
        let (range, width) = text.split_once(',').unwrap_or((text, ""));
        let tolerance = match width.trim() {
            "" => Demand::USUAL.tolerance,
            width => tolerance(width)?,
        };
        let loads = loads(range)?;
        Ok(Demand { loads, tolerance })
    }

    /// The text that [`Demand::parse`] reads.
    #[must_use]
    pub fn text(&self) -> String {
        let percent = |part: f64| shortest((part * 1e4).round() / 100.0);
        let (from, to) = self.loads;
        let tolerance = units::text(self.tolerance, "um");
        format!("{}..{} %, {tolerance}", percent(from), percent(to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_demand_is_parsed_from_its_text() {
        assert_eq!(Demand::USUAL.text(), "25..110 %, 5 um");
        assert_eq!(Demand::parse(&Demand::USUAL.text()), Ok(Demand::USUAL));
        let own = Demand::parse("50..100%").expect("a range");
        assert_eq!((own.loads, own.tolerance), ((0.5, 1.0), 5e-6));
        for wrong in ["", "110..25 %", "25..110 %, 5", "0..110 %, 5 um", "25..110 %, 2 mm"] {
            assert!(Demand::parse(wrong).is_err(), "{wrong}");
        }
    }
}
