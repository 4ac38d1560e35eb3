//! The results of a solve that all methods share, and the difference of two answers.

use crate::model::inputs::Method;
use crate::model::{self, Inputs, Outcome, Quantity, Refusal, Solution, Stage, Stages};

/// A result that several methods compute, each as a quantity of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// Driven gear's angle before E at the first contact.
    FirstContact,
    /// Greatest force of the incoming tooth.
    PeakForce,
    /// Greatest force of the incoming tooth before E.
    PeakApproachForce,
    /// Duration of the first impact.
    Duration,
    /// The kinematic friction ratio.
    FrictionRatio,
    /// The force over the driver's roll angle from D to E.
    Curve,
}

impl Subject {
    /// Every subject, in order.
    pub const ALL: [Subject; 6] = [
        Subject::FirstContact,
        Subject::PeakForce,
        Subject::PeakApproachForce,
        Subject::Duration,
        Subject::FrictionRatio,
        Subject::Curve,
    ];
    /// The subjects that a setting must answer to qualify.
    pub const NEEDED: [Subject; 3] = [Subject::FirstContact, Subject::PeakForce, Subject::Curve];

    /// The name in JSON.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Subject::FirstContact => "first_contact_angle",
            Subject::PeakForce => "peak_force",
            Subject::PeakApproachForce => "peak_approach_force",
            Subject::Duration => "impact_duration",
            Subject::FrictionRatio => "friction_ratio",
            Subject::Curve => "curve",
        }
    }

    /// The label of the subject.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Subject::FirstContact => "first contact angle",
            Subject::PeakForce => "peak force",
            Subject::PeakApproachForce => "peak force before E",
            Subject::Duration => "duration of the impact",
            Subject::FrictionRatio => "friction ratio",
            Subject::Curve => "force from D to E",
        }
    }

    /// The quantity of a method for this subject; `None` for the curve, and if the method has no
    /// such quantity.
    #[must_use]
    pub fn quantity(self, method: Method) -> Option<&'static Quantity> {
        let free = match self {
            Subject::FirstContact => "approach_angle_driven",
            Subject::PeakForce | Subject::PeakApproachForce => "impact_force",
            Subject::Duration => "impact_duration",
            Subject::FrictionRatio => "friction_ratio",
            Subject::Curve => return None,
        };
        match (self, method) {
            (Subject::PeakForce, Method::Static) => Quantity::find("static_peak_force"),
            (Subject::PeakForce, Method::Dynamic) => Quantity::find("dynamic_peak_force"),
            _ => Quantity::find(free)?.by(method),
        }
    }

    /// Whether the method computes the subject.
    #[must_use]
    pub fn is_of(self, method: Method) -> bool {
        self == Subject::Curve || self.quantity(method).is_some()
    }
}

/// The answer of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The method of the solve; for `auto`, the chosen method.
    pub method: Method,
    /// Whether the tooth strikes.
    pub outcome: Outcome,
    /// Values of [`Subject::quantity`], in SI, in the order of [`Subject::ALL`].
    values: [Option<f64>; Subject::ALL.len()],
    /// Driver's angle before E in rad and force in N, from the first contact to E.
    curve: Vec<(f64, f64)>,
    /// Evaluations of the motion in method `dynamic`, see
    /// [`Effort`](crate::model::dynamic::Effort).
    pub evaluations: Option<u64>,
}

/// The stages that the answer of a method needs.
#[must_use]
pub fn stages(method: Method) -> Stages {
    match method {
        Method::Paper | Method::Exact => Stages::CLOSED_FORM.with(Stage::Stations),
        Method::Static => Stages::of(Stage::Static),
        Method::Dynamic => Stages::of(Stage::Dynamic),
        // `static` replaces `dynamic` if `auto` chooses it.
        Method::Auto => Stages::CLOSED_FORM.with(Stage::Stations).and(Stages::of(Stage::Dynamic)),
    }
}

/// Solves the stages of the answer only.
///
/// # Errors
/// The refusal, also if a part of the answer is withheld; [`Refusal::Stopped`] if `go_on` returns
/// false.
pub(super) fn solve(inputs: &Inputs, go_on: &dyn Fn() -> bool) -> Result<Solution, Refusal> {
    let solution = model::solve_while(inputs, stages(inputs.method), &|_| go_on())?;
    match solution.withheld.or(solution.stations_withheld) {
        Some(refusal) => Err(refusal),
        None => Ok(solution),
    }
}

impl Answer {
    /// The answer of a solve.
    #[must_use]
    pub fn of(solution: &Solution) -> Answer {
        let value = |subject: Subject| {
            subject.quantity(solution.method).and_then(|quantity| (quantity.value)(solution))
        };
        Answer {
            method: solution.method,
            outcome: solution.outcome,
            values: Subject::ALL.map(value),
            curve: curve(solution),
            evaluations: solution.dynamic.as_ref().map(|dynamic| dynamic.effort.evaluations),
        }
    }

    /// The value in SI, if any.
    #[must_use]
    pub fn value(&self, subject: Subject) -> Option<f64> {
        self.values[subject as usize]
    }

    /// The error of this answer, relative to `truth`; `None` if one of the methods has no such
    /// quantity. If neither finds a strike the error is 0; if only one does, it is 1.
    #[must_use]
    pub fn off(&self, truth: &Answer, subject: Subject) -> Option<f64> {
        if !(subject.is_of(self.method) && subject.is_of(truth.method)) {
            return None;
        }
        if subject == Subject::Curve {
            return Some(self.curve_error(truth));
        }
        match (self.value(subject), truth.value(subject)) {
            (Some(found), Some(expected)) => Some(relative(found - expected, expected)),
            (None, None) => Some(0.0),
            _ if self.outcome == truth.outcome && self.outcome == Outcome::NoCornerContact => {
                Some(0.0)
            }
            _ => Some(1.0),
        }
    }

    /// The greatest difference of the forces over the driver's roll angle from the earlier first
    /// contact to E, over the true peak. With linear interpolation the greatest difference is at a
    /// station of one of the curves.
    fn curve_error(&self, truth: &Answer) -> f64 {
        let angles = self.curve.iter().chain(&truth.curve).map(|&(angle, _)| angle);
        let apart = angles
            .map(|angle| (self.force_at(angle) - truth.force_at(angle)).abs())
            .fold(0.0, f64::max);
        match (self.outcome, truth.outcome) {
            (Outcome::NoCornerContact, Outcome::NoCornerContact) => 0.0,
            (Outcome::CornerContact, Outcome::CornerContact) => {
                relative(apart, truth.value(Subject::PeakForce).unwrap_or_default())
            }
            _ => 1.0,
        }
    }

    /// The force at the driver's angle before E, by linear interpolation between stations; 0 before
    /// the first contact.
    #[must_use]
    pub fn force_at(&self, angle: f64) -> f64 {
        /// First contacts that differ by no more than rounding are equal.
        const ROUNDING: f64 = 1e-9;
        let next = self.curve.partition_point(|station| station.0 > angle);
        match (next.checked_sub(1).map(|before| self.curve[before]), self.curve.get(next)) {
            (Some(before), Some(&after)) => {
                before.1 + (after.1 - before.1) * (before.0 - angle) / (before.0 - after.0)
            }
            (None, Some(&first)) if angle <= first.0 * (1.0 + ROUNDING) => first.1,
            (None, _) => 0.0,
            (Some(last), None) => last.1,
        }
    }
}

/// The force from the first contact to E.
fn curve(solution: &Solution) -> Vec<(f64, f64)> {
    let shared = match solution.method {
        Method::Paper | Method::Exact | Method::Auto => {
            return solution
                .stations
                .iter()
                .map(|station| (station.roll_angle_driver, station.impact_force))
                .collect();
        }
        Method::Static => solution.static_load.as_ref().map(|load| &load.stations),
        Method::Dynamic => solution.dynamic.as_ref().map(|dynamic| &dynamic.stations),
    };
    let before_end =
        shared.into_iter().flatten().filter(|station| station.roll_angle_driver >= 0.0);
    before_end.map(|station| (station.roll_angle_driver, station.force)).collect()
}

/// A difference over a size; 1 if the size is 0.
fn relative(difference: f64, size: f64) -> f64 {
    if difference == 0.0 {
        return 0.0;
    }
    let relative = (difference / size).abs();
    if relative.is_finite() { relative } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    fn answer(method: Method, stations: usize) -> Answer {
        let inputs =
            Inputs { method, stations: Some(stations), ..Case::table_1().inputs().unwrap() };
        Answer::of(&solve(&inputs, &|| true).unwrap())
    }

    #[test]
    fn a_curve_is_interpolated_linearly_and_is_zero_before_the_first_contact() {
        let shared = answer(Method::Static, 4);
        let (first, second) = (shared.curve[0], shared.curve[1]);
        assert_eq!((shared.curve.len(), shared.curve[4].0), (5, 0.0));
        assert!(
            (shared.force_at(f64::midpoint(first.0, second.0)) - f64::midpoint(first.1, second.1))
                .abs()
                < 1e-9
        );
        assert!(
            (shared.force_at(0.0) - shared.value(Subject::PeakApproachForce).unwrap()).abs() < 1e-9
        );
        assert!(shared.force_at(1.01 * first.0).abs() < f64::MIN_POSITIVE);
        let impact = answer(Method::Exact, 4);
        assert_eq!(
            Some(impact.force_at(impact.curve[0].0 * (1.0 + 1e-15))),
            impact.value(Subject::PeakForce)
        );
    }

    #[test]
    fn an_answer_differs_from_others_and_not_from_itself() {
        let (shared, impact) = (answer(Method::Static, 16), answer(Method::Exact, 16));
        for subject in Subject::ALL {
            assert_eq!(shared.off(&shared, subject), subject.is_of(Method::Static).then_some(0.0));
        }
        assert_eq!(impact.off(&shared, Subject::Duration), None);
        assert!(impact.off(&shared, Subject::Curve).unwrap() > 0.5);
        let on_time = Answer {
            outcome: Outcome::NoCornerContact,
            values: [None; 6],
            curve: Vec::new(),
            ..impact.clone()
        };
        assert_eq!(on_time.off(&shared, Subject::FirstContact), Some(1.0));
        assert_eq!(on_time.off(&shared, Subject::Curve), Some(1.0));
        let also = Answer { outcome: Outcome::NoCornerContact, ..shared };
        assert!(Subject::NEEDED.iter().all(|&subject| on_time.off(&also, subject) == Some(0.0)));
    }
}
