//! The measured settings of a case, and the recommended setting.

use std::fmt;

use super::Subject;
use super::clock::{Build, Time};
use crate::case::Case;
use crate::case::fields::{AUTO, index_of};
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::model::{Inputs, Outcome, Refusal, auto};

/// The methods and their settings, measured on one case.
#[derive(Debug, Clone)]
pub struct Trade {
    /// The accepted error of a setting.
    pub within: f64,
    /// Number of settings to measure.
    pub planned: usize,
    /// The settings measured so far.
    pub settings: Vec<MeasuredSetting>,
    /// Progress of the measurement, from 0 to 1.
    pub part: f64,
    /// The reference, or the refusal.
    pub reference: Result<Reference, Refusal>,
    /// Model error of each method and compliance with variable fineness: its finest setting against
    /// the reference.
    pub models: Vec<Model>,
    /// Time to build the fields of the reference, or the reason why it has none.
    pub build: Result<Build, Refusal>,
    /// Index of the fastest setting that qualifies.
    pub cheapest: Option<usize>,
}

/// The answer of method `dynamic` with the finest setting, by the default compliance: the elastic
/// field if both gears have one.
#[derive(Debug, Clone)]
pub struct Reference {
    /// The setting of the reference.
    pub setting: Setting,
    /// The values in SI, in the order of [`Subject::ALL`].
    pub values: [Option<f64>; Subject::ALL.len()],
    /// Difference of an independent computation, which shares only the mesh, in the order of
    /// [`Subject::ALL`]; or the refusal.
    pub disagreement: Result<Differences, Refusal>,
}

/// Relative differences in the order of [`Subject::ALL`]; `None` if a method has no such quantity.
pub type Differences = [Option<f64>; Subject::ALL.len()];

/// The model error of a method.
#[derive(Debug, Clone)]
pub struct Model {
    /// Its finest setting.
    pub setting: Setting,
    /// Difference of this setting from the reference.
    pub off: Differences,
    /// The outcome of this setting, if it solves the case.
    pub outcome: Option<Outcome>,
}

/// A setting with its time and errors.
#[derive(Debug, Clone)]
pub struct MeasuredSetting {
    /// The setting.
    pub setting: Setting,
    /// Whether it is the setting of the case.
    pub is_current: bool,
    /// The measured figures, or the refusal of the case.
    pub found: Result<Figures, Refusal>,
    /// Whether no other setting is both faster and more accurate.
    pub is_on_front: bool,
    /// Whether the error is within the accepted error.
    pub qualifies: bool,
}

/// Time and errors.
#[derive(Debug, Clone)]
pub struct Figures {
    /// The setting that the solve used: another one if method `auto` chose it.
    pub taken: Setting,
    /// Time of a solve of the stages that the answer needs.
    pub time: Time,
    /// Evaluations of the motion in method `dynamic`, see
    /// [`Effort`](crate::model::dynamic::Effort).
    pub evaluations: Option<u64>,
    /// Difference from the finest setting of the same method.
    pub numerical: Differences,
    /// Difference from the reference.
    pub total: Differences,
}

/// The greatest difference, if any.
#[must_use]
pub fn greatest(differences: &Differences) -> Option<f64> {
    differences.iter().flatten().copied().reduce(f64::max)
}

impl Trade {
    /// The model error of the method and compliance of a setting.
    #[must_use]
    pub fn model(&self, setting: &Setting) -> Option<&Model> {
        self.models.iter().find(|model| model.setting.is_finer_or_coarser(setting))
    }

    /// The compared compliances, first that of the reference.
    #[must_use]
    pub fn compliances(&self) -> Vec<StiffnessModels> {
        let mut found: Vec<StiffnessModels> = Vec::new();
        let reference = self.reference.as_ref().ok();
        let of_settings = self.settings.iter().map(|measured| measured.setting.models);
        for models in reference
            .map(|reference| reference.setting.models)
            .into_iter()
            .chain(of_settings)
            .flatten()
        {
            if !found.contains(&models) {
                found.push(models);
            }
        }
        found
    }

    /// The default setting of a method and compliance.
    #[must_use]
    pub fn usual(&self, method: Method, models: StiffnessModels) -> Option<&MeasuredSetting> {
        self.settings.iter().find(|measured| {
            let setting = &measured.setting;
            *setting == setting.usual_fineness()
                && setting.method == method
                && setting.models == Some(models)
        })
    }

    /// The fastest setting that qualifies; `None` if no method finds corner contact: without a
    /// force, no setting can reduce its error.
    #[must_use]
    pub fn recommended(&self) -> Option<&MeasuredSetting> {
        let cheapest = self.cheapest.filter(|_| !self.is_without_contact());
        cheapest.and_then(|at| self.settings.get(at))
    }

    /// Whether every method that solves the case finds no corner contact.
    #[must_use]
    pub fn is_without_contact(&self) -> bool {
        let mut outcomes = self.models.iter().filter_map(|model| model.outcome).peekable();
        outcomes.peek().is_some() && outcomes.all(|outcome| outcome == Outcome::NoCornerContact)
    }

    /// Marks the settings that qualify, the settings on the front and the fastest setting, from the
    /// present times and errors.
    pub fn judge(&mut self) {
        let points: Vec<Option<(f64, f64)>> =
            self.settings.iter().map(MeasuredSetting::point).collect();
        for (measured, point) in self.settings.iter_mut().zip(&points) {
            measured.qualifies = measured.is_within(self.within);
            measured.is_on_front = point.is_some_and(|point| {
                !points.iter().flatten().any(|other| dominates(other, &point))
            });
        }
        self.cheapest = self.find_cheapest();
    }

    /// The fastest setting that qualifies, among the methods from which `auto` chooses. `auto`
    /// itself uses one of these, and `paper` repeats `exact`. Among settings with tied times, the
    /// most accurate.
    fn find_cheapest(&self) -> Option<usize> {
        let best = self.cheapest_where(|_| true)?;
        self.settings.iter().position(|measured| std::ptr::eq(measured, best))
    }

    /// The fastest of the admitted settings that qualifies, see [`Trade::cheapest`].
    #[must_use]
    pub fn cheapest_where(&self, admitted: impl Fn(&Setting) -> bool) -> Option<&MeasuredSetting> {
        let is_candidate = |measured: &&MeasuredSetting| {
            measured.qualifies
                && auto::METHODS.contains(&measured.setting.method)
                && admitted(&measured.setting)
        };
        let candidates = || self.settings.iter().filter(is_candidate);
        let quickest =
            candidates().min_by(|one, other| one.seconds().total_cmp(&other.seconds()))?;
        let tied = candidates().filter(|measured| measured.ties(quickest));
        let error = |measured: &MeasuredSetting| measured.total().unwrap_or(f64::INFINITY);
        tied.min_by(|one, other| error(one).total_cmp(&error(other)))
    }
}

impl MeasuredSetting {
    /// Time of a solve in s; infinite without a solve.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.found.as_ref().map_or(f64::INFINITY, |figures| figures.time.seconds)
    }

    /// The greatest total error, if the setting answers all needed subjects.
    #[must_use]
    pub fn total(&self) -> Option<f64> {
        let figures = self.found.as_ref().ok()?;
        let answers =
            Subject::NEEDED.iter().all(|&subject| figures.total[subject as usize].is_some());
        greatest(&figures.total).filter(|_| answers)
    }

    /// Whether the measurements do not show which setting is faster.
    fn ties(&self, other: &MeasuredSetting) -> bool {
        let time =
            |measured: &MeasuredSetting| measured.found.as_ref().ok().map(|figures| figures.time);
        time(self).zip(time(other)).is_some_and(|(one, other)| one.ties(&other))
    }

    /// Error and time as coordinates.
    fn point(&self) -> Option<(f64, f64)> {
        self.total().map(|total| (total, self.seconds()))
    }

    fn is_within(&self, within: f64) -> bool {
        self.total().is_some_and(|total| total <= within)
    }
}

/// Whether `one` is nowhere worse than the other and somewhere better.
fn dominates(one: &(f64, f64), other: &(f64, f64)) -> bool {
    one.0 <= other.0 && one.1 <= other.1 && one != other
}

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
