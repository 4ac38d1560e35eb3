//! The questions about one case that commands and the Python module share: their options, and their
//! answers as results.

use std::cell::Cell;

use super::options::{Threads, count};
use crate::case::Problem;
use crate::model::{Inputs, Refusal};
use crate::numeric::decimal::shortest;
use crate::report::studies::{SeekReport, StiffnessReport};
use crate::report::table::Results;
use crate::study::axis::{AxisRange, Sampling};
use crate::study::batch::with_unit;
use crate::study::excitation::{self, POINTS};
use crate::study::relief::{Demand, NoRelief, specify};
use crate::study::seek::{Condition, USUAL_SCAN, seek};
use crate::study::shard::Format;
use crate::study::stiffness::{LEAST_POINTS, MOST_POINTS, compare_flanks, compare_path};
use crate::study::trade::{STEADY, Trade, trade};
use clap::Args;

/// A question about one case, with its options.
pub trait Question: Sync {
    /// The name of the parts of its progress.
    const PARTS: &'static str;
    /// The formats of its answer.
    const FORMATS: &'static [Format] = &[Format::Text, Format::Json, Format::Csv];
    /// Whether its answer has a picture.
    const IS_DRAWN: bool = false;

    /// The fields that it varies, each with a value for a case that lacks it.
    ///
    /// # Errors
    /// An option without a valid value.
    fn varied(&self) -> Result<Vec<(usize, String)>, Misuse> {
        Ok(Vec::new())
    }

    /// The answer; `go_on` receives the number of completed parts and their total, and returns
    /// whether to continue.
    ///
    /// # Errors
    /// The reason why there is none.
    fn answer(&self, inputs: &Inputs, go_on: &dyn Fn(usize, usize) -> bool) -> Answer;
}

/// The results of a question.
pub type Answer = Result<Box<dyn Results + Send>, NoAnswer>;

/// An option, its value and the problem of the value.
pub type Misuse = (&'static str, String, Box<Problem>);

/// Why a question has no answer.
#[derive(Debug)]
pub enum NoAnswer {
    /// An option has no valid value.
    Misused(Misuse),
    /// The model refuses the case, or the user stops the work.
    Refused(Refusal),
    /// The case has no such result.
    Failed(String),
}

impl From<Misuse> for NoAnswer {
    fn from(misuse: Misuse) -> NoAnswer {
        NoAnswer::Misused(misuse)
    }
}

impl From<Refusal> for NoAnswer {
    fn from(refusal: Refusal) -> NoAnswer {
        NoAnswer::Refused(refusal)
    }
}

impl From<NoRelief> for NoAnswer {
    fn from(none: NoRelief) -> NoAnswer {
        match none {
            NoRelief::Refused(refusal) => NoAnswer::Refused(refusal),
            none => NoAnswer::Failed(none.to_string()),
        }
    }
}

/// Checks a number of points or samples.
///
/// # Errors
/// If the number is outside its range.
pub fn within(option: &'static str, count: usize, least: usize, most: usize) -> Result<(), Misuse> {
    if (least..=most).contains(&count) {
        return Ok(());
    }
    let (cause, fix) = ("out of range", format!("write a number from {least} to {most}"));
    Err((option, count.to_string(), Box::new(Problem::new(option, cause, fix))))
}

/// Parses a number of points between two limits.
pub(super) fn count_within<const LEAST: usize, const MOST: usize>(
    text: &str,
) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (LEAST..=MOST).contains(count));
    count.ok_or_else(|| format!("write a number from {LEAST} to {MOST}"))
}

/// Where a condition changes.
#[derive(Debug, Clone, Args)]
pub struct Seek {
    /// The field and its range, such as 'deviations.base_pitch=0..40 um'
    #[arg(long, value_name = "KEY=FROM..TO")]
    pub vary: String,
    /// The condition, such as 'impact_force<=2500 N', 'dynamic_contact_lost=true',
    /// 'outcome=no-corner-contact' or, at the end of contact, 'exit_outcome=no-corner-contact'
    #[arg(long, value_name = "CONDITION")]
    pub until: String,
    /// Number of points of the first scan; a finer scan finds narrower regions
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = USUAL_SCAN, value_parser = count)]
    pub points: usize,
    /// The threads
    #[command(flatten)]
    pub threads: Threads,
}

impl Seek {
    fn wrong_range(&self, problem: Problem) -> Misuse {
        ("vary", self.vary.clone(), Box::new(problem))
    }

    fn wrong_condition(&self, problem: Problem) -> Misuse {
        ("until", self.until.clone(), Box::new(problem))
    }

    fn parsed(&self) -> Result<(AxisRange, Condition), Misuse> {
        let range = AxisRange::parse(&self.vary).map_err(|problem| self.wrong_range(problem))?;
        let condition = Condition::parse(&self.until);
        Ok((range, condition.map_err(|problem| self.wrong_condition(problem))?))
    }
}

impl Question for Seek {
    const PARTS: &'static str = "points";
    const FORMATS: &'static [Format] = &[Format::Text, Format::Json];

    fn varied(&self) -> Result<Vec<(usize, String)>, Misuse> {
        let (AxisRange { field, unit, from, .. }, _) = self.parsed()?;
        Ok(vec![(field, with_unit(&shortest(from), &unit))])
    }

    fn answer(&self, inputs: &Inputs, go_on: &dyn Fn(usize, usize) -> bool) -> Answer {
        let (range, condition) = self.parsed()?;
        let inputs = inputs.clone().needing(condition.stages());
        condition.check(inputs.method).map_err(|problem| self.wrong_condition(problem))?;
        let scan = range.axis(Sampling { points: Some(self.points), is_log: false });
        let scan = scan.map_err(|problem| self.wrong_range(problem))?;
        let found = seek(&inputs, &range, &condition, &scan, &self.threads.control(go_on))?;
        Ok(Box::new(SeekReport { method: inputs.method.name(), range, condition, found }))
    }
}

impl Question for Demand {
    const PARTS: &'static str = "% of the budget";
    const IS_DRAWN: bool = true;

    fn answer(&self, inputs: &Inputs, go_on: &dyn Fn(usize, usize) -> bool) -> Answer {
        Ok(Box::new(specify(inputs, self, &|part| go_on((100.0 * part) as usize, 100))?))
    }
}

/// The stiffness models over flanks and path of contact.
#[derive(Debug, Clone, Copy, Args)]
pub struct Stiffness {
    /// Number of radii on each flank, from the form circle to the tip
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 9, value_parser = count_within::<LEAST_POINTS, MOST_POINTS>)]
    pub points: usize,
}

impl Question for Stiffness {
    const PARTS: &'static str = "parts";

    fn answer(&self, inputs: &Inputs, _: &dyn Fn(usize, usize) -> bool) -> Answer {
        within("points", self.points, LEAST_POINTS, MOST_POINTS)?;
        let flanks = compare_flanks(inputs, self.points)?;
        Ok(Box::new(StiffnessReport { flanks, path: compare_path(inputs, self.points)? }))
    }
}

/// The mesh as the excitation of another solver.
#[derive(Debug, Clone, Copy, Args)]
pub struct Excitation {
    /// Number of places in a base pitch
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = POINTS[1], value_parser = count_within::<{ POINTS[0] }, { POINTS[2] }>)]
    pub points: usize,
}

impl Question for Excitation {
    const PARTS: &'static str = "places";

    fn answer(&self, inputs: &Inputs, go_on: &dyn Fn(usize, usize) -> bool) -> Answer {
        within("points", self.points, POINTS[0], POINTS[2])?;
        Ok(Box::new(excitation::Excitation::of(inputs, self.points, go_on)?))
    }
}

/// Accuracy against run time.
#[derive(Debug, Clone, Copy, Args)]
pub struct Accuracy {
    /// Greatest error of the recommended setting, such as 5% or 0.05 (default: model.within of
    /// the case)
    #[arg(long, value_name = "ERROR", allow_hyphen_values = true, value_parser = part)]
    pub within: Option<f64>,
}

impl Question for Accuracy {
    const PARTS: &'static str = "settings";
    const FORMATS: &'static [Format] = &[Format::Text, Format::Json];

    fn answer(&self, inputs: &Inputs, go_on: &dyn Fn(usize, usize) -> bool) -> Answer {
        let within = self.within.unwrap_or(inputs.within);
        let (inputs, done) = (Inputs { within, ..inputs.clone() }, Cell::new((0, 1)));
        let mut show = |sofar: &Trade| done.set((sofar.settings.len(), sofar.planned));
        let is_wanted = || go_on(done.get().0, done.get().1);
        Ok(Box::new(trade(&inputs, STEADY, &is_wanted, &mut show)?))
    }
}

/// Parses a fraction: "5%" or 0.05.
fn part(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let (number, whole) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 100.0));
    let value = number.trim().parse::<f64>().ok().map(|number| number / whole);
    let value = value.filter(|part| part.is_finite() && *part > 0.0);
    value.ok_or_else(|| "write a number above 0, such as 5% or 0.05".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_written_with_or_without_its_sign() {
        assert_eq!((part("5%"), part("0.05"), part(" 0.5 % ")), (Ok(0.05), Ok(0.05), Ok(0.005)));
        let wrong = ["", "%", "five", "-1%", "0", "nan", "inf%"];
        assert!(wrong.iter().all(|text| part(text).is_err()));
    }
}
