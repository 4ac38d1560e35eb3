//! The measured settings of a case, and which of them to recommend.

use super::answer::Subject;
use super::build::Build;
use super::clock::Time;
use super::setting::Setting;
use crate::model::inputs::Method;
use crate::model::stiffness_spread::StiffnessModels;
use crate::model::{Outcome, Refusal, auto};

/// The methods and their settings, measured on one case.
#[derive(Debug, Clone)]
pub struct Trade {
    /// The error that a setting may have.
    pub within: f64,
    /// How many settings there will be.
    pub planned: usize,
    /// Those that are measured so far.
    pub settings: Vec<Measured>,
    /// How much of the measurement is done, from 0 to 1.
    pub part: f64,
    /// The reference, or why there is none.
    pub reference: Result<Reference, Refusal>,
    /// The best setting of each method and compliance whose fineness varies, against the
    /// reference: what its physics leaves out.
    pub models: Vec<Model>,
    /// Time of the fields that the reference reads, or why it reads none.
    pub build: Result<Build, Refusal>,
    /// The place of the cheapest setting that qualifies.
    pub cheapest: Option<usize>,
}

/// The answer of the method `dynamic` with the finest setting, by the compliance of a case that
/// names none: the elastic field, where both gears have one.
#[derive(Debug, Clone)]
pub struct Reference {
    /// How it was found.
    pub setting: Setting,
    /// What it finds, in SI, in the order of [`Subject::ALL`].
    pub values: [Option<f64>; Subject::ALL.len()],
    /// How far a second way, that shares the mesh alone, is from it, in the order of
    /// [`Subject::ALL`]; or why it is not known.
    pub disagreement: Result<Differences, Refusal>,
}

/// Relative differences in the order of [`Subject::ALL`], where there are any.
pub type Differences = [Option<f64>; Subject::ALL.len()];

/// What a method's physics leaves out.
#[derive(Debug, Clone)]
pub struct Model {
    /// Its best setting.
    pub setting: Setting,
    /// How far its best setting is from the reference.
    pub off: Differences,
    /// Whether the tooth strikes by its best setting, where that solves the case.
    pub outcome: Option<Outcome>,
}

/// A setting with its time and errors.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The setting.
    pub setting: Setting,
    /// Whether it is the case's own.
    pub is_current: bool,
    /// What was measured, or why it does not solve the case.
    pub found: Result<Figures, Refusal>,
    /// Whether no other setting is both as quick and as near to the reference.
    pub is_on_front: bool,
    /// Whether it is within what was asked.
    pub qualifies: bool,
}

/// Time and errors.
#[derive(Debug, Clone)]
pub struct Figures {
    /// The setting of the answer: another one where the method `auto` chose.
    pub taken: Setting,
    /// Of a whole solve, as far as the answer needs it.
    pub time: Time,
    /// What the motion took in the method `dynamic`, see [`Effort`](crate::model::dynamic::Effort).
    pub evaluations: Option<u64>,
    /// Against the same method by its best setting.
    pub numerical: Differences,
    /// Against the reference.
    pub total: Differences,
}

/// The greatest of the differences there are.
#[must_use]
pub fn greatest(differences: &Differences) -> Option<f64> {
    differences.iter().flatten().copied().reduce(f64::max)
}

impl Trade {
    /// How far the best setting of the same method and compliance is from the reference.
    #[must_use]
    pub fn model(&self, setting: &Setting) -> Option<&Model> {
        self.models
            .iter()
            .find(|model| model.setting.is_finer_or_coarser(setting))
    }

    /// The compliances that are compared, that of the reference first.
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

    /// The setting of a method and compliance that a case has which names both alone.
    #[must_use]
    pub fn usual(&self, method: Method, models: StiffnessModels) -> Option<&Measured> {
        self.settings.iter().find(|measured| {
            let setting = &measured.setting;
            *setting == setting.usual_fineness()
                && setting.method == method
                && setting.models == Some(models)
        })
    }

    /// The cheapest setting that qualifies, or none where no method finds corner contact: there is
    /// no force whose error a setting could reduce.
    #[must_use]
    pub fn recommended(&self) -> Option<&Measured> {
        let cheapest = self.cheapest.filter(|_| !self.is_without_contact());
        cheapest.and_then(|at| self.settings.get(at))
    }

    /// Whether every method that solves the case finds no corner contact.
    #[must_use]
    pub fn is_without_contact(&self) -> bool {
        let mut outcomes = self
            .models
            .iter()
            .filter_map(|model| model.outcome)
            .peekable();
        outcomes.peek().is_some() && outcomes.all(|outcome| outcome == Outcome::NoCornerContact)
    }

    /// Mark who qualifies, who stands on the front, and who is the cheapest, by the times and
    /// errors that stand there.
    pub fn judge(&mut self) {
        let points: Vec<Option<(f64, f64)>> = self.settings.iter().map(Measured::point).collect();
        for (measured, point) in self.settings.iter_mut().zip(&points) {
            measured.qualifies = measured.is_within(self.within);
            measured.is_on_front = point.is_some_and(|point| {
                !points
                    .iter()
                    .flatten()
                    .any(|other| dominates(other, &point))
            });
        }
        self.cheapest = self.find_cheapest();
    }

    /// The cheapest setting that qualifies among the methods from which `auto` chooses. `auto`
    /// itself takes one of these, and `paper` repeats `exact`. Of settings whose times tie, the
    /// most accurate.
    fn find_cheapest(&self) -> Option<usize> {
        let best = self.cheapest_where(|_| true)?;
        self.settings
            .iter()
            .position(|measured| std::ptr::eq(measured, best))
    }

    /// The cheapest of some settings that qualifies, see [`Trade::cheapest`].
    #[must_use]
    pub fn cheapest_where(&self, admitted: impl Fn(&Setting) -> bool) -> Option<&Measured> {
        let is_candidate = |measured: &&Measured| {
            measured.qualifies
                && auto::METHODS.contains(&measured.setting.method)
                && admitted(&measured.setting)
        };
        let candidates = || self.settings.iter().filter(is_candidate);
        let quickest =
            candidates().min_by(|one, other| one.seconds().total_cmp(&other.seconds()))?;
        let tied = candidates().filter(|measured| measured.ties(quickest));
        let error = |measured: &Measured| measured.total().unwrap_or(f64::INFINITY);
        tied.min_by(|one, other| error(one).total_cmp(&error(other)))
    }
}

impl Measured {
    /// Time of a solve in s; infinite where there is none.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.found
            .as_ref()
            .map_or(f64::INFINITY, |figures| figures.time.seconds)
    }

    /// The greatest total error, where the setting answers all that is needed.
    #[must_use]
    pub fn total(&self) -> Option<f64> {
        let figures = self.found.as_ref().ok()?;
        let answers = Subject::NEEDED
            .iter()
            .all(|&subject| figures.total[subject as usize].is_some());
        greatest(&figures.total).filter(|_| answers)
    }

    /// Whether the measurements do not show which of the two is faster.
    fn ties(&self, other: &Measured) -> bool {
        let time = |measured: &Measured| measured.found.as_ref().ok().map(|figures| figures.time);
        time(self)
            .zip(time(other))
            .is_some_and(|(one, other)| one.ties(&other))
    }

    /// Error and time.
    fn point(&self) -> Option<(f64, f64)> {
        self.total().map(|total| (total, self.seconds()))
    }

    fn is_within(&self, within: f64) -> bool {
        self.total().is_some_and(|total| total <= within)
    }
}

/// One is nowhere worse than the other and somewhere better.
fn dominates(one: &(f64, f64), other: &(f64, f64)) -> bool {
    one.0 <= other.0 && one.1 <= other.1 && one != other
}
