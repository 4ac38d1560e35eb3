//! The settings that a trade study compares: a method, the compliance of the teeth, and the
//! fineness of the computation.

use std::fmt;

use crate::case::Case;
use crate::case::fields::{AUTO, index_of};
use crate::model::Inputs;
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;

/// The compared methods, fastest first.
pub const METHODS: [Method; 4] = [Method::Paper, Method::Exact, Method::Static, Method::Dynamic];
/// The compared numbers of intervals between stations.
pub const STATIONS: [usize; 8] = [8, 16, 32, 64, 128, 256, 512, 1024];
/// Exponents of the compared tolerances: 1e-3, 1e-4 and so on.
const TOLERANCE_EXPONENTS: std::ops::RangeInclusive<i32> = 3..=10;
/// Number of intervals of the finest setting of a method.
const BEST_STATIONS: usize = 4096;
/// Tolerance of the finest setting.
const BEST_TOLERANCE: f64 = 1e-12;

/// A method with a compliance and a fineness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The method.
    pub method: Method,
    /// Compliance of teeth and contact; `None` if method `auto` chooses it.
    pub models: Option<StiffnessModels>,
    /// Number of intervals between the first contact and E; `None` for as many as the curve needs.
    pub stations: Option<usize>,
    /// Relative tolerance of the peak force; in method `dynamic` only.
    pub tolerance: Option<f64>,
    /// Geometry and position in double-double arithmetic.
    pub accurate: bool,
}

impl Setting {
    /// Every compared setting: each method coarse and fine with the default compliance, then the
    /// default setting of each method with every other compliance that covers the pair.
    #[must_use]
    pub fn all(inputs: &Inputs) -> Vec<Setting> {
        let mut settings = Setting::fineness(inputs);
        for models in StiffnessModels::covering(inputs) {
            let others = METHODS
                .map(|method| Setting { models: Some(models), ..Setting::usual(method, inputs) });
            for other in others {
                if !settings.contains(&other) {
                    settings.push(other);
                }
            }
        }
        settings
    }

    /// Each method coarse and fine, the faster methods first, `auto` last.
    fn fineness(inputs: &Inputs) -> Vec<Setting> {
        let closed_form = Method::CLOSED_FORM.into_iter().flat_map(|method| {
            let plain = Setting::usual(method, inputs);
            [plain, Setting { accurate: true, ..plain }]
                .into_iter()
                .flat_map(Setting::with_stations)
        });
        let shared = Setting::usual(Method::Static, inputs).with_stations();
        let inertia = Setting::usual(Method::Dynamic, inputs);
        let tolerances = TOLERANCE_EXPONENTS
            .map(move |exponent| Setting { tolerance: Some(power_of_ten(-exponent)), ..inertia })
            .filter(move |setting| *setting != inertia);
        let choice =
            Setting { stations: None, models: None, ..Setting::usual(Method::Auto, inputs) };
        let coarse =
            Setting { tolerance: Some(power_of_ten(-TOLERANCE_EXPONENTS.start())), ..inertia };
        let corner = coarse.with_stations().filter(move |setting| *setting != coarse);
        closed_form
            .chain(shared)
            .chain(tolerances)
            .chain(inertia.with_stations())
            .chain(corner)
            .chain([choice])
            .collect()
    }

    /// The setting of a case that sets only the method.
    #[must_use]
    pub fn usual(method: Method, inputs: &Inputs) -> Setting {
        let inputs = Inputs { method, ..inputs.clone() };
        Setting {
            method,
            models: Some(StiffnessModels::by_default(&inputs)),
            stations: None,
            tolerance: None,
            accurate: false,
        }
        .usual_fineness()
    }

    /// The same method and compliance with the default fineness.
    #[must_use]
    pub fn usual_fineness(self) -> Setting {
        let usual = Inputs::default();
        Setting {
            stations: usual.stations,
            tolerance: (self.method == Method::Dynamic).then_some(usual.tolerance),
            accurate: false,
            ..self
        }
    }

    /// This setting with every number of stations, and with as many as the curve needs.
    fn with_stations(self) -> impl Iterator<Item = Setting> {
        STATIONS
            .into_iter()
            .map(Some)
            .chain([None])
            .map(move |stations| Setting { stations, ..self })
    }

    /// The finest setting of the same method and compliance, the reference of the numerical error.
    #[must_use]
    pub fn best(self) -> Setting {
        Setting {
            stations: Some(BEST_STATIONS),
            tolerance: (self.method == Method::Dynamic).then_some(BEST_TOLERANCE),
            accurate: !self.method.shares_load(),
            ..self
        }
    }

    /// Whether both settings differ only in their fineness.
    #[must_use]
    pub fn is_finer_or_coarser(&self, other: &Setting) -> bool {
        self.method == other.method && self.models == other.models
    }

    /// The setting of some inputs.
    #[must_use]
    pub fn of(inputs: &Inputs) -> Setting {
        Setting {
            method: inputs.method,
            models: (!is_left_to_auto(inputs)).then(|| StiffnessModels::of(inputs)),
            stations: inputs.stations,
            tolerance: (inputs.method == Method::Dynamic).then_some(inputs.tolerance),
            accurate: inputs.accurate,
        }
    }

    /// The inputs of the same pair with this setting.
    #[must_use]
    pub fn inputs(&self, inputs: &Inputs) -> Inputs {
        let inputs = self.models.map_or_else(
            || Inputs { tooth_compliance: None, ..inputs.clone() },
            |models| models.in_place_of(inputs),
        );
        Inputs {
            method: self.method,
            stations: self.stations,
            tolerance: self.tolerance.unwrap_or(inputs.tolerance),
            accurate: self.accurate,
            ..inputs
        }
    }

    /// The setting that the solve used: another one if method `auto` chose it.
    #[must_use]
    pub fn taken(&self, inputs: &Inputs, method: Method) -> Setting {
        let inputs = Inputs { method, ..self.inputs(inputs) };
        Setting { method, models: Some(StiffnessModels::of(&inputs)), ..*self }
    }

    /// The number of stations in the syntax of a case file.
    #[must_use]
    pub fn stations_text(&self) -> String {
        self.stations.map_or_else(|| AUTO.to_owned(), |stations| stations.to_string())
    }

    /// Writes the setting into a case. If the case names no compliance and the setting has the
    /// default compliance, the case still names none.
    pub fn apply(&self, case: &mut Case) {
        write(case, "model.method", self.method.name());
        write(case, "model.stations", &self.stations_text());
        write(case, "model.accurate", if self.accurate { "true" } else { "false" });
        if let Some(tolerance) = self.tolerance {
            write(case, "model.tolerance", &format!("{tolerance:e}"));
        }
        let own = case.inputs().ok().and_then(|inputs| Setting::of(&inputs).models);
        if own == self.models {
            return;
        }
        write(case, "model.tooth_compliance", self.models.map_or("", |models| models.tooth.name));
        if let Some(contact) = self.models.and_then(|models| models.contact) {
            write(case, "model.contact_compliance", contact.name);
        }
    }
}

fn write(case: &mut Case, key: &str, text: &str) {
    if let Some(field) = index_of(key) {
        case.write(field, text);
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with ", self.method.name())?;
        if let Some(models) = self.models {
            write!(f, "{}, ", models.names())?;
        }
        write!(f, "{} stations", self.stations_text())?;
        if let Some(tolerance) = self.tolerance {
            write!(f, " and tolerance {tolerance:e}")?;
        }
        if self.accurate { f.write_str(", accurate") } else { Ok(()) }
    }
}

/// Whether method `auto` also chooses the compliance.
fn is_left_to_auto(inputs: &Inputs) -> bool {
    inputs.method == Method::Auto && inputs.tooth_compliance.is_none()
}

/// The double nearest to 10^exponent, as a file reader parses it.
fn power_of_ten(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table_1() -> Inputs {
        Case::table_1().inputs().unwrap()
    }

    #[test]
    fn every_setting_is_listed_once_and_applies_to_the_case() {
        let settings = Setting::all(&table_1());
        for models in StiffnessModels::covering(&table_1()) {
            for method in METHODS {
                let is_it = |one: &&Setting| one.method == method && one.models == Some(models);
                assert!(settings.iter().any(|one| is_it(&one)), "{method:?} {models:?}");
            }
        }
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
        let usual = Setting::usual(Method::Dynamic, &table_1());
        case.set("model.tooth_compliance", "").unwrap();
        usual.apply(&mut case);
        let compliance = index_of("model.tooth_compliance").unwrap();
        assert_eq!(case.text(compliance), None, "the default needs no name");
        for key in ["model.stations", "model.tolerance", "model.accurate"] {
            case.set(key, "").unwrap();
        }
        assert_eq!(Setting::of(&case.inputs().unwrap()), usual);
    }

    #[test]
    fn a_setting_prints_method_models_and_fineness() {
        let inputs = table_1();
        assert_eq!(
            Setting::usual(Method::Dynamic, &inputs).best().to_string(),
            "dynamic with finite-element, 4096 stations and tolerance 1e-12"
        );
        assert_eq!(
            Setting::fineness(&inputs).last().unwrap().to_string(),
            "auto with auto stations"
        );
        assert_eq!(
            Setting::usual(Method::Paper, &inputs).best().to_string(),
            "paper with kuang-yang and logarithmic, 4096 stations, accurate"
        );
    }
}
