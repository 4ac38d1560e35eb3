//! The measured settings of a case, and the recommended setting.

use super::answer::Subject;
use super::build::Build;
use super::clock::Time;
use super::setting::Setting;
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::model::{Outcome, Refusal, auto};

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
