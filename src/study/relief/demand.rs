//! The demand on a relief: loads, tolerances and the figure to minimise, and their texts.

use std::array::from_fn;
use std::fmt;

use super::{Off, decimal};
use crate::case::units::{self, Dimension, System};
use crate::numeric::decimal::shortest;

/// Number of loads of a range.
const LOADS: u32 = 6;

/// Significant digits of a tolerance.
const DIGITS: usize = 4;
/// Significant digits of a tolerance in the other units.
const FEW_DIGITS: usize = 2;

/// The word before the deviation of the misalignment.
const MISALIGNMENT: &str = "misalignment";

/// The figure that the relief minimises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Criterion {
    /// Peak-to-peak transmission error at rest
    #[default]
    Te,
    /// Greatest force of a tooth; over the face width its greatest line load
    Peak,
    /// Greatest force of the incoming tooth before E; without such a force the least amounts
    Entry,
}

impl Criterion {
    /// Every criterion.
    pub const ALL: [Criterion; 3] = [Criterion::Te, Criterion::Peak, Criterion::Entry];

    /// The name in the option and in JSON.
    pub fn name(self) -> &'static str {
        ["te", "peak", "entry"][self as usize]
    }

    /// A smaller relief is chosen if its figure exceeds the best one by at most this fraction: 10 %
    /// of a transmission error are 0.8 dB.
    pub fn worth(self) -> f64 {
        [0.1, 0.05, 0.0][self as usize]
    }
}

/// The figure in a sentence.
impl fmt::Display for Criterion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["transmission error", "peak force", "force before E"][*self as usize])
    }
}

/// Loads with their shares of the time.
pub type Spectrum = Vec<(f64, f64)>;

/// What a relief must satisfy.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Demand {
    /// Loads that the relief must serve, in percent of the load of the case
    #[cfg_attr(feature = "cli", arg(long = "load", value_name = "A..B", default_value = "25..110%", value_parser = loads, allow_hyphen_values = true))]
    pub loads: (f64, f64),
    /// Loads with their shares of the time, in place of the range, such as
    /// '50%:0.2, 100%:0.7, 130%:0.1'
    #[cfg_attr(feature = "cli", arg(long, value_name = "LOAD:SHARE,...", default_value = "", hide_default_value = true, value_parser = spectrum, conflicts_with = "loads", allow_hyphen_values = true))]
    pub spectrum: Spectrum,
    /// Manufacturing tolerance of each amount, plus and minus, such as '5 um'; '0.2 thou' by default
    /// with --units inch
    #[cfg_attr(feature = "cli", arg(long, value_name = "LENGTH", default_value = "5 um", default_value_if("units", "inch", "0.2 thou"), value_parser = tolerance, allow_hyphen_values = true))]
    pub tolerance: f64,
    /// Manufacturing tolerance of each length along the path of contact, plus and minus, such as
    /// '0.2 mm' (default: one step of a length)
    #[cfg_attr(feature = "cli", arg(long, value_name = "LENGTH", value_parser = tolerance, allow_hyphen_values = true))]
    pub tolerance_length: Option<f64>,
    /// Deviation of the misalignment over the face width, plus and minus, such as '10 um'
    #[cfg_attr(feature = "cli", arg(long, value_name = "LENGTH", default_value = "0 um", value_parser = tolerance, allow_hyphen_values = true))]
    pub misalignment: f64,
    /// The figure to minimise
    #[cfg_attr(feature = "cli", arg(long, value_name = "FIGURE", default_value = "te"))]
    pub minimise: Criterion,
    /// Units of the text, and of the steps of amounts and lengths: 1 um and 0.1 mm, or 0.1 thou and
    /// 0.005 in
    #[cfg_attr(feature = "cli", arg(long, value_name = "SYSTEM", default_value = "metric"))]
    pub units: System,
}

impl Default for Demand {
    /// Loads from 25 % to 110 % of the load of the case, tolerance 5 um.
    fn default() -> Demand {
        Demand {
            loads: (0.25, 1.1),
            spectrum: Vec::new(),
            tolerance: 5e-6,
            tolerance_length: None,
            misalignment: 0.0,
            minimise: Criterion::Te,
            units: System::Metric,
        }
    }
}

impl Demand {
    /// The loads with their shares; equal shares over the range.
    pub fn loads(&self) -> Vec<(f64, f64)> {
        if !self.spectrum.is_empty() {
            let all: f64 = self.spectrum.iter().map(|(_, share)| share).sum();
            return self.spectrum.iter().map(|&(load, share)| (load, share / all)).collect();
        }
        let (from, to) = self.loads;
        let steps = if to > from { LOADS } else { 1 };
        let part = |at: u32| f64::from(at) / f64::from((steps - 1).max(1));
        (0..steps).map(|at| (decimal(from + (to - from) * part(at)), 1.0)).collect()
    }

    /// The greatest load.
    pub fn greatest_load(&self) -> f64 {
        let loads = self.spectrum.iter().map(|&(load, _)| load);
        loads.reduce(f64::max).unwrap_or(self.loads.1)
    }

    /// The figure of the transmission errors at the loads: the mean over a spectrum, otherwise the
    /// greatest.
    pub fn figure(&self, errors: impl Iterator<Item = f64>) -> f64 {
        if self.spectrum.is_empty() {
            return errors.fold(0.0, f64::max);
        }
        self.loads().iter().zip(errors).map(|((_, share), error)| share * error).sum()
    }

    /// Every combination of deviations at the limits of the tolerances, the smallest reliefs first.
    pub(super) fn corners(&self) -> Vec<Off> {
        let (amount, length) = (self.tolerance, self.tolerance_length.unwrap_or(0.0));
        let limits = [amount, amount, length, length];
        let sign = |index: usize, axis: usize| if index >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let mut corners: Vec<Off> = Vec::new();
        for index in 0..16 {
            let corner = from_fn(|axis| sign(index, axis) * limits[axis] + 0.0);
            if !corners.contains(&corner) {
                corners.push(corner);
            }
        }
        corners
    }

    /// Parses a text such as `25..110 %, 5 um, 0.1 mm, misalignment 8 um, te`: a range of loads or a
    /// spectrum, the tolerances of amounts, lengths and misalignment, the criterion. All but the
    /// loads are optional, with defaults that are round in these units.
    ///
    /// # Errors
    /// Returns the correct syntax.
    pub fn parse(text: &str, units: System) -> Result<Demand, String> {
        let (mut demand, mut tolerances) = (Demand::usual(units), 0);
        for (at, item) in text.split(',').map(str::trim).enumerate() {
            let criterion = Criterion::ALL.into_iter().find(|known| known.name() == item);
            if let Some(criterion) = criterion {
                demand.minimise = criterion;
            } else if let Some(length) = item.strip_prefix(MISALIGNMENT) {
                demand.misalignment = tolerance(length)?;
            } else if item.contains(':') {
                demand.spectrum.extend(spectrum(item)?);
            } else if item.starts_with(char::is_alphabetic) {
                let names = Criterion::ALL.map(Criterion::name).join(", ");
                return Err(format!("{item}: choose one of {names}"));
            } else if at == 0 {
                demand.loads = loads(item).map_err(|fix| format!("{item}: {fix}"))?;
            } else {
                let length = tolerance(item)?;
                match tolerances {
                    0 => demand.tolerance = length,
                    1 => demand.tolerance_length = Some(length),
                    _ => return Err("write two tolerances: of the amounts and the lengths".into()),
                }
                tolerances += 1;
            }
        }
        Ok(demand)
    }

    /// The demand of the dialog before a demand is typed: the tolerance is round in these units.
    pub fn usual(units: System) -> Demand {
        let tolerance = if units == System::Inch { "0.2 thou" } else { "5 um" };
        let tolerance = self::tolerance(tolerance).unwrap_or_default();
        Demand { tolerance, units, ..Demand::default() }
    }

    /// The text that [`Demand::parse`] reads.
    pub fn text(&self, units: System) -> String {
        let digits = if units == self.units { DIGITS } else { FEW_DIGITS };
        let text = |length, unit| units.text(length, unit, digits);
        let tolerances = [(Some(self.tolerance), "um"), (self.tolerance_length, "mm")];
        let tolerances = tolerances.into_iter();
        let tolerances = tolerances.filter_map(|(length, unit)| Some(text(length?, unit)));
        let tilt = Some(self.misalignment).filter(|tilt| *tilt > 0.0);
        let tilt = tilt.map(|tilt| format!("{MISALIGNMENT} {}", text(tilt, "um")));
        let all = std::iter::once(self.loads_text()).chain(tolerances).chain(tilt);
        all.chain([self.minimise.name().to_owned()]).collect::<Vec<_>>().join(", ")
    }

    /// The loads as a text.
    pub fn loads_text(&self) -> String {
        let percent = |part: f64| shortest((part * 1e4).round() / 100.0);
        let (from, to) = self.loads;
        let load = |&(load, share): &(f64, f64)| format!("{}%:{}", percent(load), shortest(share));
        match &self.spectrum[..] {
            [] if from < to => format!("{}..{} %", percent(from), percent(to)),
            [] => percent(to) + " %",
            spectrum => spectrum.iter().map(load).collect::<Vec<_>>().join(", "),
        }
    }
}

/// Parses a load in percent.
fn load(text: &str) -> Option<f64> {
    let number = text.trim().trim_end_matches('%').trim_end();
    let percent = number.parse::<f64>().ok().filter(|percent| *percent > 0.0);
    percent.filter(|percent| *percent <= 1000.0).map(|percent| percent / 100.0)
}

/// Parses a range of loads in percent, such as `25..110%`, or one load.
///
/// # Errors
/// Returns the syntax of a load range.
pub fn loads(text: &str) -> Result<(f64, f64), String> {
    const FIX: &str = "write a range above 0 % and up to 1000 %, such as 25..110%";
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    match load(from).zip(load(to)) {
        Some((from, to)) if from > to => Err(format!("the range is reversed: {FIX}")),
        found => found.ok_or(FIX.to_owned()),
    }
}

/// Parses loads with their shares of the time, such as `50%:0.2, 100%:0.8`; none in an empty text.
///
/// # Errors
/// Returns the syntax of a load spectrum.
pub fn spectrum(text: &str) -> Result<Spectrum, String> {
    if text.is_empty() {
        return Ok(Spectrum::new());
    }
    let share = |text: &str| text.trim().parse::<f64>().ok().filter(|share| *share > 0.0);
    let item = |item: &str| {
        let (percent, part) = item.split_once(':')?;
        load(percent).zip(share(part).filter(|share| share.is_finite()))
    };
    let items: Option<Vec<_>> = text.split(',').map(item).collect();
    items.ok_or_else(|| {
        "write loads up to 1000 % with their shares, such as '50%:0.2, 100%:0.7, 130%:0.1'".into()
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_demand_is_parsed_from_its_text() {
        assert_eq!(Demand::usual(System::Metric).text(System::Metric), "25..110 %, 5 um, te");
        let own = Demand::parse("50..100%", System::Metric).expect("a range");
        assert_eq!((own.loads, own.tolerance), ((0.5, 1.0), 5e-6));
        let own =
            Demand::parse("50%:1, 130%:3, 4 um, 0.2 mm, misalignment 8 um, peak", System::Metric);
        let own = own.expect("a spectrum");
        assert!((own.misalignment - 8e-6).abs() < 1e-18);
        assert_eq!(own.loads(), [(0.5, 0.25), (1.3, 0.75)]);
        assert_eq!((own.minimise, own.tolerance_length), (Criterion::Peak, Some(2e-4)));
        assert_eq!(Demand::parse(&own.text(System::Metric), System::Metric), Ok(own));
        for (wrong, part) in [
            ("", ": write a range"),
            ("110..25 %", "110..25 %: the range is reversed"),
            ("25..110 %, 5", "5 has no unit"),
            ("25..110 lb", "25..110 lb: write a range"),
            ("25..110 %, 2 mm", "write a length"),
            ("50%:0", "with their shares"),
            ("fast", "fast: choose one of te, peak, entry"),
        ] {
            assert!(Demand::parse(wrong, System::Metric).unwrap_err().contains(part), "{wrong}");
        }
    }

    #[test]
    fn the_limits_of_the_tolerances_are_every_combination_once() {
        let count = |tolerance, length| {
            let tolerance_length = Some(length);
            Demand { tolerance, tolerance_length, ..Demand::default() }.corners().len()
        };
        assert_eq!([count(1e-6, 1e-4), count(1e-6, 0.0), count(0.0, 0.0)], [16, 4, 1]);
    }
}
