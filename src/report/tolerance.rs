//! A tolerance study as text, JSON or CSV.

mod json;
mod text;

use std::io::{self, Write};

use super::absence::Absence;
use super::csv::{cell, write_rows};
use crate::case::Case;
use crate::case::fields::index_of;
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::study::batch::{Points, Refused};
use crate::study::sample::Member;
use crate::study::tolerance::{Samples, Tolerance};

/// A tolerance study and its results.
#[derive(Clone, Copy)]
pub struct ToleranceReport<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// The name of the method.
    pub method: &'a str,
    /// The study.
    pub study: &'a Tolerance,
    /// Its results.
    pub samples: &'a Samples,
}

impl ToleranceReport<'_> {
    /// Writes the results as text.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        text::write(self, out)
    }

    /// Writes the results for a screen that already shows the case: the figures, then the spread.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_for_screen(&self, out: &mut dyn Write) -> io::Result<()> {
        text::write_for_screen(self, out)
    }

    /// Writes the results as one JSON object on one line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        json::write(self, out)
    }

    /// Writes one row per solve: the samples, then the points of the ranking.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let study = self.study;
        let spread = study.design.distributions.iter().map(|distribution| {
            let unit = distribution.unit();
            let unit = if unit.is_empty() { "1" } else { unit };
            format!("{} [{unit}]", distribution.key())
        });
        let computed =
            study.quantities.iter().map(|quantity| format!("{} [{}]", quantity.key, quantity.unit));
        let names = ["sample", "set"].map(str::to_owned).into_iter();
        let header = names.chain(spread).chain(computed);
        let header = header.chain(["outcome".to_owned()]).collect();
        let rows = (0..study.design.count()).map(|index| self.row(index));
        write_rows(std::iter::once(header).chain(rows), out)
    }

    fn row(&self, index: usize) -> Vec<String> {
        let design = &self.study.design;
        let (number, set) = match design.member(index) {
            Member::Sample(number) => (number, "a".to_owned()),
            Member::Second(number) => (number, "b".to_owned()),
            Member::Swapped(number, field) => {
                (number, format!("b:{}", design.distributions[field].key()))
            }
        };
        let spread = design.values(index).into_iter().map(|value| cell(Some(value)));
        let quantities = 0..self.study.quantities.len();
        let computed = quantities.map(|at| cell(self.samples.value(at, index)));
        let outcome = self.samples.outcomes[index].name().to_owned();
        [number.to_string(), set]
            .into_iter()
            .chain(spread)
            .chain(computed)
            .chain([outcome])
            .collect()
    }

    /// How the base pitch deviations of a sample add, by its name in a case file.
    fn combination(&self) -> &'static str {
        let key = index_of("deviations.combination");
        let text = key.and_then(|key| self.case.effective(key));
        if self.study.design.draws_known_deviations() || text == Some("sum") {
            "sum"
        } else {
            "independent"
        }
    }

    /// Why no sample has a value of a quantity, if another method computes it.
    fn why_absent(&self, quantity: &Quantity) -> Option<String> {
        let mut methods = Method::ALL.into_iter();
        let method = methods.find(|method| method.name() == self.method)?;
        Absence::by_method(quantity, method).map(|absence| absence.to_string())
    }

    /// Refused points in one sentence.
    #[must_use]
    pub fn refused(&self, refused: &Refused) -> String {
        let design = &self.study.design;
        let (count, of) = (refused.count, design.count());
        let which = if count == 1 { "" } else { "the first " };
        let point = design.point(refused.first);
        format!("{count} of {of} points refused, {which}at {point}: {}", refused.problem)
    }
}

/// Whether every sample is refused.
#[must_use]
pub fn is_all_refused(samples: &Samples) -> bool {
    samples.refusals.total() == samples.outcomes.len()
}
