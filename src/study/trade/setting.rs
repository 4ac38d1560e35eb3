//! The settings that a trade compares: a method, and how finely it is computed.

use std::fmt;

use crate::case::Case;
use crate::case::fields::{AUTO, index_of};
use crate::model::Inputs;
use crate::model::inputs::Method;

/// The methods that are compared, cheapest first.
pub const METHODS: [Method; 4] = [
    Method::Paper,
    Method::Exact,
    Method::Static,
    Method::Dynamic,
];
/// Intervals of the stations that are compared.
pub const STATIONS: [usize; 8] = [8, 16, 32, 64, 128, 256, 512, 1024];
/// Intervals of a case that leaves them out.
const USUAL_STATIONS: usize = 64;
/// Tolerance of a case that leaves it out.
const USUAL_TOLERANCE: f64 = 1e-6;
/// Tolerances that are compared: 1e-3, 1e-4 and so on.
const TOLERANCE_EXPONENTS: std::ops::RangeInclusive<i32> = 3..=10;
/// Intervals of the best setting of a method.
const BEST_STATIONS: usize = 4096;
/// Tolerance of the best setting.
const BEST_TOLERANCE: f64 = 1e-12;

/// A method and how finely it is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// How much of the physics is taken in.
    pub method: Method,
    /// Intervals between the first contact and E; without a number as many as the curve needs.
    pub stations: Option<usize>,
    /// Relative error that the peak force may have; in the method `dynamic` alone.
    pub tolerance: Option<f64>,
    /// Geometry and position in double-double arithmetic.
    pub accurate: bool,
}

impl Setting {
    /// Every setting that is compared, the cheaper methods first, the program's own choice last.
    #[must_use]
    pub fn all() -> Vec<Setting> {
        let closed_form = Method::CLOSED_FORM.into_iter().flat_map(|method| {
            let plain = Setting::usual(method);
            [
                plain,
                Setting {
                    accurate: true,
                    ..plain
                },
            ]
            .into_iter()
            .flat_map(Setting::with_stations)
        });
        let shared = Setting::usual(Method::Static).with_stations();
        let inertia = Setting::usual(Method::Dynamic);
        let tolerances = TOLERANCE_EXPONENTS
            .map(move |exponent| Setting {
                tolerance: Some(power_of_ten(-exponent)),
                ..inertia
            })
            .filter(move |setting| *setting != inertia);
        let choice = Setting {
            stations: None,
            ..Setting::usual(Method::Auto)
        };
        let coarse = Setting {
            tolerance: Some(power_of_ten(-TOLERANCE_EXPONENTS.start())),
            ..inertia
        };
        let corner = coarse
            .with_stations()
            .filter(move |setting| *setting != coarse);
        closed_form
            .chain(shared)
            .chain(tolerances)
            .chain(inertia.with_stations())
            .chain(corner)
            .chain([choice])
            .collect()
    }

    /// The setting of a case that names the method alone.
    #[must_use]
    pub fn usual(method: Method) -> Setting {
        let tolerance = (method == Method::Dynamic).then_some(USUAL_TOLERANCE);
        Setting {
            method,
            stations: Some(USUAL_STATIONS),
            tolerance,
            accurate: false,
        }
    }

    /// This setting by every number of stations, and by as many as the curve needs.
    fn with_stations(self) -> impl Iterator<Item = Setting> {
        STATIONS
            .into_iter()
            .map(Some)
            .chain([None])
            .map(move |stations| Setting { stations, ..self })
    }

    /// The finest setting of a method, against which its numerical error is measured.
    #[must_use]
    pub fn best(method: Method) -> Setting {
        Setting {
            method,
            stations: Some(BEST_STATIONS),
            tolerance: (method == Method::Dynamic).then_some(BEST_TOLERANCE),
            accurate: !method.shares_load(),
        }
    }

    /// The setting that the inputs ask for.
    #[must_use]
    pub fn of(inputs: &Inputs) -> Setting {
        Setting {
            method: inputs.method,
            stations: inputs.stations,
            tolerance: (inputs.method == Method::Dynamic).then_some(inputs.tolerance),
            accurate: inputs.accurate,
        }
    }

    /// The same pair, solved by this setting.
    #[must_use]
    pub fn inputs(&self, inputs: &Inputs) -> Inputs {
        Inputs {
            method: self.method,
            stations: self.stations,
            tolerance: self.tolerance.unwrap_or(inputs.tolerance),
            accurate: self.accurate,
            ..inputs.clone()
        }
    }

    /// The number of stations as a case says it.
    #[must_use]
    pub fn stations_text(&self) -> String {
        self.stations
            .map_or_else(|| AUTO.to_owned(), |stations| stations.to_string())
    }

    /// Make it the case's own.
    pub fn apply(&self, case: &mut Case) {
        let mut write = |key: &str, text: &str| {
            if let Some(field) = index_of(key) {
                case.write(field, text);
            }
        };
        write("model.method", self.method.name());
        write("model.stations", &self.stations_text());
        write(
            "model.accurate",
            if self.accurate { "true" } else { "false" },
        );
        if let Some(tolerance) = self.tolerance {
            write("model.tolerance", &format!("{tolerance:e}"));
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} with {} stations",
            self.method.name(),
            self.stations_text()
        )?;
        if let Some(tolerance) = self.tolerance {
            write!(f, " and tolerance {tolerance:e}")?;
        }
        if self.accurate {
            f.write_str(", accurate")
        } else {
            Ok(())
        }
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
        assert_eq!(settings.len(), 2 * 2 * 9 + 9 + 7 + 9 + 8 + 1);
        for (at, setting) in settings.iter().enumerate() {
            assert!(!settings[..at].contains(setting), "{setting} twice");
            let mut case = Case::table_1();
            setting.apply(&mut case);
            assert_eq!(Setting::of(&case.inputs().unwrap()), *setting);
        }
    }

    #[test]
    fn the_usual_setting_is_that_of_a_case_that_names_the_method_alone() {
        let mut case = Case::table_1();
        let usual = Setting::usual(Method::Dynamic);
        usual.apply(&mut case);
        for key in ["model.stations", "model.tolerance", "model.accurate"] {
            case.set(key, "").unwrap();
        }
        assert_eq!(Setting::of(&case.inputs().unwrap()), usual);
    }

    #[test]
    fn a_setting_tells_what_it_is() {
        assert_eq!(
            Setting::best(Method::Dynamic).to_string(),
            "dynamic with 4096 stations and tolerance 1e-12"
        );
        assert_eq!(
            Setting::all().last().unwrap().to_string(),
            "auto with auto stations"
        );
        assert_eq!(
            Setting::best(Method::Exact).to_string(),
            "exact with 4096 stations, accurate"
        );
    }
}
