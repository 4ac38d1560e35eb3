//! The settings that a trade compares: a rung, and how finely it is computed.

use std::fmt;

use crate::case::Case;
use crate::case::fields::index_of;
use crate::model::Inputs;
use crate::model::inputs::Rung;

/// Intervals of the stations that are compared.
pub const STATIONS: [usize; 8] = [8, 16, 32, 64, 128, 256, 512, 1024];
/// Intervals where the tolerance is varied, as in a case that leaves them out.
pub const USUAL_STATIONS: usize = 64;
/// Tolerance where the stations are varied, as in a case that leaves it out.
pub const USUAL_TOLERANCE: f64 = 1e-6;
/// Tolerances that are compared: 1e-3, 1e-4 and so on.
const TOLERANCE_EXPONENTS: std::ops::RangeInclusive<i32> = 3..=10;
/// Intervals of the best setting of a rung.
const BEST_STATIONS: usize = 4096;
/// Tolerance of the best setting.
const BEST_TOLERANCE: f64 = 1e-12;

/// A rung and how finely it is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// How much of the physics is taken in.
    pub rung: Rung,
    /// Intervals between the first contact and E.
    pub stations: usize,
    /// Relative error that the peak force may have; in the rung `dynamic` alone.
    pub tolerance: Option<f64>,
    /// Geometry and position in double-double arithmetic.
    pub accurate: bool,
}

impl Setting {
    /// Every setting that is compared, the cheaper rungs first.
    #[must_use]
    pub fn all() -> Vec<Setting> {
        let closed_form = Rung::CLOSED_FORM.into_iter().flat_map(|rung| {
            [false, true].into_iter().flat_map(move |accurate| {
                STATIONS.into_iter().map(move |stations| Setting { rung, stations, tolerance: None, accurate })
            })
        });
        let dynamic = |stations, tolerance| Setting { rung: Rung::Dynamic, stations, tolerance: Some(tolerance), accurate: false };
        let shared = STATIONS.map(|stations| Setting { rung: Rung::Static, stations, tolerance: None, accurate: false });
        let tolerances = TOLERANCE_EXPONENTS.map(|exponent| dynamic(USUAL_STATIONS, power_of_ten(-exponent)));
        let others = STATIONS.into_iter().filter(|&stations| stations != USUAL_STATIONS);
        let intervals = others.map(|stations| dynamic(stations, USUAL_TOLERANCE));
        closed_form.chain(shared).chain(tolerances).chain(intervals).collect()
    }

    /// The finest setting of a rung, against which its numerical error is measured.
    #[must_use]
    pub fn best(rung: Rung) -> Setting {
        Setting {
            rung,
            stations: BEST_STATIONS,
            tolerance: (rung == Rung::Dynamic).then_some(BEST_TOLERANCE),
            accurate: !rung.shares_load(),
        }
    }

    /// The setting that the inputs ask for.
    #[must_use]
    pub fn of(inputs: &Inputs) -> Setting {
        Setting {
            rung: inputs.rung,
            stations: inputs.stations,
            tolerance: (inputs.rung == Rung::Dynamic).then_some(inputs.tolerance),
            accurate: inputs.accurate,
        }
    }

    /// The same pair, solved by this setting.
    #[must_use]
    pub fn inputs(&self, inputs: &Inputs) -> Inputs {
        Inputs {
            rung: self.rung,
            stations: self.stations,
            tolerance: self.tolerance.unwrap_or(inputs.tolerance),
            accurate: self.accurate,
            ..inputs.clone()
        }
    }

    /// Make it the case's own.
    pub fn apply(&self, case: &mut Case) {
        let mut write = |key: &str, text: &str| {
            if let Some(field) = index_of(key) {
                case.write(field, text);
            }
        };
        write("model.rung", self.rung.name());
        write("model.stations", &self.stations.to_string());
        write("model.accurate", if self.accurate { "true" } else { "false" });
        if let Some(tolerance) = self.tolerance {
            write("model.tolerance", &format!("{tolerance:e}"));
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with {} stations", self.rung.name(), self.stations)?;
        if let Some(tolerance) = self.tolerance {
            write!(f, " and tolerance {tolerance:e}")?;
        }
        if self.accurate { f.write_str(", accurate") } else { Ok(()) }
    }
}

/// 10^exponent as it is read from a file: the nearest double.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_stands_once_and_becomes_the_case() {
        let settings = Setting::all();
        assert_eq!(settings.len(), 2 * 16 + 8 + 8 + 7);
        for (at, setting) in settings.iter().enumerate() {
            assert!(!settings[..at].contains(setting), "{setting} twice");
            let mut case = Case::table_1();
            setting.apply(&mut case);
            assert_eq!(Setting::of(&case.inputs().unwrap()), *setting);
        }
    }

    #[test]
    fn a_setting_tells_what_it_is() {
        assert_eq!(Setting::best(Rung::Dynamic).to_string(), "dynamic with 4096 stations and tolerance 1e-12");
        assert_eq!(Setting::best(Rung::Exact).to_string(), "exact with 4096 stations, accurate");
    }
}
