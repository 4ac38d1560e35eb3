//! Tolerance studies: samples of distributed fields by seed and index, and the results of a case over them.

use crate::case::fields::{FIELDS, Kind, Value, index_of, keeps_gears};
use crate::case::spread::Shape;
use crate::case::{Case, Limit, Problem, Spread, field_range, units};
use crate::model::deviation::Origin;
use crate::model::inputs::{Combination, Gear, Method};
use crate::model::{Inputs, Outcome, Quantity, Refusal};
use crate::numeric::decimal::{shortest, significant};
use crate::study::batch::{
    Batch, Control, PointOutcome, Points, Refusals, Row, Writer, solve_all, with_unit,
};
use crate::study::seek::{distinct, headline};
use crate::study::statistics::{Estimate, Figures, Indices, Ranked, figures, indices, probability};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use smallvec::SmallVec;
use statrs::distribution::{ContinuousCDF, Normal};

/// Default number of samples.
pub const USUAL_SAMPLES: usize = 10_000;
/// The default in a pane or on a page if a method shares the load: a solve takes a hundred times as
/// long as that of a closed form.
const FEW_SAMPLES: usize = 1000;
/// The same with a load over the face width: a solve can take a second.
const FEWEST_SAMPLES: usize = 100;

/// Greatest number of samples of a study.
pub const MOST_SAMPLES: usize = 100_000_000;

/// Default number of samples of the ranking.
pub const USUAL_RANKED: usize = 4096;

/// Bins of a histogram.
const BINS: usize = 12;

/// A tolerance study: the samples and the requested quantities.
#[derive(Debug, Clone)]
pub struct Tolerance {
    /// The points.
    pub design: Design,
    /// The quantities, including those of the limits.
    pub quantities: Vec<&'static Quantity>,
    /// The limits of the case.
    pub limits: Vec<Limit>,
}

/// The size of a tolerance study.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Number of samples.
    pub samples: usize,
    /// Seed of the samples.
    pub seed: u64,
    /// Number of samples of the ranking; by default [`USUAL_RANKED`], or all samples if there are
    /// fewer.
    pub ranked: Option<usize>,
}

/// The default number of samples in a pane or on a page for a case with these inputs.
pub fn usual_samples(inputs: &Inputs) -> usize {
    let is_slow = inputs.method.shares_load() || inputs.method == Method::Auto;
    match inputs.face() {
        Some(_) if is_slow => FEWEST_SAMPLES,
        _ if is_slow => FEW_SAMPLES,
        _ => USUAL_SAMPLES,
    }
}

impl Tolerance {
    /// The study of a case with `[spread]`. If `only` is empty, the quantities are the headline
    /// quantities.
    ///
    /// # Errors
    /// Returns an error if the case has no distributions, or if a distribution has no value or
    /// exceeds the range of its field.
    pub fn of(
        case: &Case,
        inputs: &Inputs,
        only: &[&'static Quantity],
        size: Size,
    ) -> Result<Tolerance, Problem> {
        if case.spread.is_empty() {
            let fix = "write under [spread] a line such as \
                \"deviations.base_pitch\" = { normal = \"4 um\" }";
            return Err(Problem::new("spread", "the case has no distributions", fix));
        }
        let distributions = case.spread.iter().map(|spread| Distribution::of(spread, case, inputs));
        let distributions = distributions.collect::<Result<Vec<_>, _>>()?;
        // A single field causes all of the spread.
        let ranked = match size.ranked {
            _ if distributions.len() == 1 => 0,
            Some(wanted) => wanted.min(size.samples),
            None => USUAL_RANKED.min(size.samples),
        };
        let limits: Vec<Limit> =
            case.limits.iter().filter(|limit| !limit.text.is_empty()).cloned().collect();
        let limited = limits.iter().flat_map(Limit::quantities);
        let own = if only.is_empty() { headline(case, &[inputs.method]) } else { only.to_vec() };
        let quantities = distinct(own.into_iter().chain(limited));
        let design = Design { seed: size.seed, distributions, samples: size.samples, ranked };
        Ok(Tolerance { design, quantities, limits })
    }

    /// Solves every point.
    ///
    /// # Errors
    /// [`Refusal::Stopped`] if the user stops the study.
    pub fn run(&self, inputs: &Inputs, control: &Control) -> Result<Samples, Refusal> {
        let mut samples = Samples::of(self);
        let batch = Batch { inputs, points: &self.design, quantities: &self.quantities };
        solve_all(&batch, 0..self.design.count(), control, &mut |first, rows| {
            samples.add(first, rows);
            true
        })?;
        Ok(samples)
    }

    /// The figures of the results.
    pub fn summary(&self, samples: &Samples) -> Summary {
        let count = self.design.samples;
        let outcomes = &samples.outcomes[..count];
        let exits: Vec<_> = samples.exits[..count].iter().copied().flatten().collect();
        let strikes = PointOutcome::Solved(Outcome::CornerContact);
        let of = |outcomes: &[PointOutcome], wanted| {
            outcomes.iter().filter(|&&outcome| outcome == wanted).count()
        };
        let refused = of(outcomes, PointOutcome::Refused);
        Summary {
            solved: count - refused,
            contact: probability(of(outcomes, strikes), count - refused),
            exit: probability(of(&exits, strikes), exits.len()),
            limits: self.limits.iter().map(|limit| self.exceedance(limit, samples)).collect(),
            quantities: (0..self.quantities.len()).map(|at| self.quantity(at, samples)).collect(),
        }
    }

    fn exceedance(&self, limit: &Limit, samples: &Samples) -> Exceedance {
        let quantity = limit.quantity;
        let value = |of: &Quantity, sample| {
            let at = self.quantities.iter().position(|known| *known == of)?;
            samples.value(at, sample)
        };
        let exceeds = |sample| {
            let PointOutcome::Solved(outcome) = samples.outcomes[sample] else { return None };
            match value(quantity, sample) {
                Some(own) => Some(own > limit.bound(|of| value(of, sample))?),
                // Without contact there is no value above the limit.
                None => (outcome == Outcome::NoCornerContact || quantity.is_of_free_impact())
                    .then_some(false),
            }
        };
        let states: Vec<bool> = (0..self.design.samples).filter_map(exceeds).collect();
        let above = states.iter().filter(|&&is_above| is_above).count();
        Exceedance {
            limit: limit.clone(),
            known: states.len(),
            probability: probability(above, states.len()),
        }
    }

    fn quantity(&self, at: usize, samples: &Samples) -> OfQuantity {
        let column = samples.columns[at][..self.design.samples].iter().copied();
        let values: Vec<f64> = column.filter(|value| !value.is_nan()).collect();
        let ranked = self.ranked(at, samples);
        OfQuantity {
            quantity: self.quantities[at],
            figures: figures(&values, BINS),
            ranked: ranked.len(),
            indices: indices(&ranked),
        }
    }

    /// The samples of the ranking for which every point has a value.
    fn ranked(&self, at: usize, samples: &Samples) -> Vec<Ranked> {
        let value = |member| samples.value(at, self.design.index(member));
        let fields = 0..self.design.distributions.len();
        let of = |number| {
            let swapped = fields.clone().map(|field| value(Member::Swapped(number, field)));
            Some(Ranked {
                first: value(Member::Sample(number))?,
                second: value(Member::Second(number))?,
                swapped: swapped.collect::<Option<_>>()?,
            })
        };
        (0..self.design.ranked).filter_map(of).collect()
    }
}

/// The results of every point of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// The outcome of each point at the entry.
    pub outcomes: Vec<PointOutcome>,
    /// The outcome of each point at the exit, if the method computes it.
    exits: Vec<Option<PointOutcome>>,
    /// The refused points.
    pub refusals: Refusals,
    /// One column per quantity, in SI; NaN marks an absent value.
    columns: Vec<Vec<f64>>,
}

impl Samples {
    /// No results yet.
    pub fn of(study: &Tolerance) -> Samples {
        let count = study.design.count();
        let column = |_: &&Quantity| Vec::with_capacity(count);
        Samples {
            outcomes: Vec::with_capacity(count),
            exits: Vec::with_capacity(count),
            refusals: Refusals::default(),
            columns: study.quantities.iter().map(column).collect(),
        }
    }

    /// Adds the next rows.
    pub fn add(&mut self, first: usize, rows: &[Row]) {
        self.refusals.count(first, rows);
        for row in rows {
            self.outcomes.push(row.outcome);
            self.exits.push(row.exit_outcome);
            for (column, value) in self.columns.iter_mut().zip(&row.values) {
                column.push(value.unwrap_or(f64::NAN));
            }
        }
    }

    /// The value of a quantity at a point, in SI.
    pub fn value(&self, quantity: usize, index: usize) -> Option<f64> {
        Some(self.columns[quantity][index]).filter(|value| !value.is_nan())
    }
}

/// The figures of a tolerance study.
#[derive(Debug, Clone)]
pub struct Summary {
    /// Number of samples that the model solved.
    pub solved: usize,
    /// Probability of corner contact among the solved samples.
    pub contact: Option<Estimate>,
    /// Probability of corner contact at the exit, if the method computes it.
    pub exit: Option<Estimate>,
    /// The limits, in the order of the case.
    pub limits: Vec<Exceedance>,
    /// The quantities.
    pub quantities: Vec<OfQuantity>,
}

/// How often a limit is exceeded.
#[derive(Debug, Clone)]
pub struct Exceedance {
    /// The limit.
    pub limit: Limit,
    /// Number of samples that can be compared with the limit.
    pub known: usize,
    /// Probability that the limit is exceeded.
    pub probability: Option<Estimate>,
}

/// The figures of one quantity.
#[derive(Debug, Clone)]
pub struct OfQuantity {
    /// The quantity.
    pub quantity: &'static Quantity,
    /// The figures of its values; `None` without values.
    pub figures: Option<Figures>,
    /// Number of samples that rank the fields.
    pub ranked: usize,
    /// The indices of each spread field; `None` if nothing varies or nothing is ranked.
    pub indices: Option<Vec<Indices>>,
}

/// The samples, followed by the points of the ranking.
///
/// The ranking reuses the first samples. For each of them it adds a second, independent sample b,
/// and for each field one point that has the value of b in this field only.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// Seed of the samples.
    pub seed: u64,
    /// The spread fields.
    pub distributions: Vec<Distribution>,
    /// Number of samples.
    pub samples: usize,
    /// Number of samples that have points of the ranking.
    pub ranked: usize,
}

/// The values of a point.
pub type Values = SmallVec<[f64; 8]>;

/// The role of a point of a design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// The sample with this index.
    Sample(usize),
    /// The second sample with this index.
    Second(usize),
    /// The sample with the first index, with the value of its second sample in the field with the
    /// second index.
    Swapped(usize, usize),
}

impl Design {
    /// The role of the point with an index.
    pub fn member(&self, index: usize) -> Member {
        let Some(rest) = index.checked_sub(self.samples) else {
            return Member::Sample(index);
        };
        let each = self.distributions.len() + 1;
        match (rest / each, rest % each) {
            (number, 0) => Member::Second(number),
            (number, field) => Member::Swapped(number, field - 1),
        }
    }

    /// The index of a point.
    pub fn index(&self, member: Member) -> usize {
        let first = |number| self.samples + number * (self.distributions.len() + 1);
        match member {
            Member::Sample(number) => number,
            Member::Second(number) => first(number),
            Member::Swapped(number, field) => first(number) + 1 + field,
        }
    }

    /// The values of a point in SI, in the order of the distributions.
    pub fn values(&self, index: usize) -> Values {
        self.draw(index, &mut self.streams())
    }

    fn draw(&self, index: usize, [first, second]: &mut [ChaCha8Rng; 2]) -> Values {
        match self.member(index) {
            Member::Sample(number) => self.sample(first, number),
            Member::Second(number) => self.sample(second, number),
            Member::Swapped(number, field) => {
                let mut values = self.sample(first, number);
                values[field] = self.sample(second, number)[field];
                values
            }
        }
    }

    /// The streams of random numbers of the samples and of the second samples.
    fn streams(&self) -> [ChaCha8Rng; 2] {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        [0, 1].map(|stream| {
            let mut random = ChaCha8Rng::from_seed(key);
            random.set_stream(stream);
            random
        })
    }

    /// The values of a sample from its own position in a stream, so that they do not depend on the
    /// order of reading.
    fn sample(&self, random: &mut ChaCha8Rng, number: usize) -> Values {
        /// Words of 32 bits that a value reads.
        const WORDS: usize = 2;
        const STEPS: f64 = (1_u64 << 53) as f64;
        let position = (WORDS * number * self.distributions.len()) as u128;
        if random.get_word_pos() != position {
            random.set_word_pos(position);
        }
        // Above 0 and below 1, from 53 random bits.
        let mut part = || ((random.next_u64() >> 11) as f64 + 0.5) / STEPS;
        self.distributions.iter().map(|one| one.quantile(part())).collect()
    }

    /// Whether base pitch deviations are drawn gear by gear. A drawn value is known with its sign,
    /// so that the deviations of a sample add.
    pub fn draws_known_deviations(&self) -> bool {
        let of_gear = ["driver.base_pitch", "driven.base_pitch"];
        self.distributions.iter().any(|drawn| of_gear.contains(&drawn.key()))
    }
}

impl Points for Design {
    fn count(&self) -> usize {
        self.samples + self.ranked * (self.distributions.len() + 1)
    }

    /// The settings, such as `deviations.base_pitch = 1.6e-5 m`.
    fn point(&self, index: usize) -> String {
        let values = self.distributions.iter().zip(self.values(index));
        let setting = |(distribution, value): (&Distribution, f64)| {
            let value = with_unit(&format!("{value:?}"), distribution.unit());
            format!("{} = {value}", distribution.key())
        };
        let mut settings: Vec<String> = values.map(setting).collect();
        if self.draws_known_deviations() {
            settings.push("deviations.combination = sum".to_owned());
        }
        settings.join(", ")
    }

    /// The number and the set of the sample, and the spread fields in SI units.
    fn columns(&self) -> Vec<(String, &str)> {
        let names = ["sample", "set"].map(|name| (name.to_owned(), ""));
        let spread = self.distributions.iter();
        let spread = spread.map(|one| (one.key().to_owned(), one.unit_or_one()));
        names.into_iter().chain(spread).collect()
    }

    fn cells(&self, index: usize) -> Vec<String> {
        let (number, set) = match self.member(index) {
            Member::Sample(number) => (number, "a".to_owned()),
            Member::Second(number) => (number, "b".to_owned()),
            Member::Swapped(number, field) => {
                (number, format!("b:{}", self.distributions[field].key()))
            }
        };
        let values = self.values(index).into_iter().map(|value| format!("{value:?}"));
        [number.to_string(), set].into_iter().chain(values).collect()
    }

    fn have_same_gears(&self) -> bool {
        self.distributions.iter().all(|drawn| keeps_gears(drawn.field))
    }

    fn writer(&self) -> Writer<'_> {
        let (mut streams, is_known) = (self.streams(), self.draws_known_deviations());
        Box::new(move |index, inputs| {
            if is_known {
                inputs.combination = Combination::Sum;
            }
            for (drawn, value) in self.distributions.iter().zip(self.draw(index, &mut streams)) {
                let (from, to) = drawn.range;
                if value < from || value > to {
                    let range = FIELDS[drawn.field].range_text();
                    let cause = format!("the sample is outside the range {range}");
                    let fix = "use a narrower distribution";
                    return Err(Problem::new(drawn.key(), cause, fix));
                }
                drawn.put(value, inputs);
            }
            Ok(())
        })
    }
}

/// Standard deviations at which a truncated normal distribution ends.
const CUT: f64 = 3.0;

/// Standard deviations of a normal distribution that the range of a field must contain. Fewer than
/// one sample in a million is outside.
const ALLOWED: f64 = 5.0;

/// A distribution of a field around its value, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// Index in [`FIELDS`].
    pub field: usize,
    /// The least and the greatest value of the field.
    pub range: (f64, f64),
    /// The value of the field.
    pub centre: f64,
    /// Standard deviation of a normal distribution, otherwise half the span.
    pub width: f64,
    /// The shape; of a grade, [`Shape::Truncated`].
    pub shape: Shape,
}

impl Distribution {
    /// The distribution of a `[spread]` entry of a case.
    ///
    /// # Errors
    /// Returns an error if the field has no value, or if the distribution exceeds the range of the
    /// field.
    pub fn of(spread: &Spread, case: &Case, inputs: &Inputs) -> Result<Distribution, Problem> {
        let key = spread.field;
        let refused = |cause, fix| Err(Problem::new(&format!("spread.\"{key}\""), cause, fix));
        let known = index_of(key).and_then(|field| Some((field, centre(field, case, inputs)?)));
        let Some((field, centre)) = known else {
            let cause = format!("{key} has no value to spread around");
            let partner = index_of(key).filter(|&field| case.is_replaced(field));
            return match partner.and_then(|field| FIELDS[field].partner()) {
                Some(given) => {
                    let given = FIELDS[given].key;
                    refused(format!("{cause}: the case gives {given}"), format!("spread {given}"))
                }
                None => refused(cause, format!("give {key} a value")),
            };
        };
        let (shape, width) = match spread.shape {
            Shape::Grade => (Shape::Truncated, allowed_deviation(spread, inputs)),
            shape => (shape, spread.width),
        };
        let range = field_range(field);
        let distribution = Distribution { field, range, centre, width, shape };
        let Some(end) = distribution.beyond() else { return Ok(distribution) };
        let (words, range) = (&spread.text, FIELDS[field].range_text());
        refused(
            format!("{words} reaches {end}, outside the field's range"),
            format!(
                "write a smaller width, or change {key} so that the distribution is within {range}"
            ),
        )
    }

    /// Whether samples below 0 count as 0: a relief cannot add material.
    pub fn is_cut(&self) -> bool {
        self.key().ends_with("_relief") && self.centre - self.reach() < -self.slack()
    }

    /// The greatest distance of a value from the centre, for a normal distribution as far as the range
    /// of a field must contain it.
    fn reach(&self) -> f64 {
        if self.shape == Shape::Normal { ALLOWED * self.width } else { self.width }
    }

    /// The rounding error of an end of the distribution.
    fn slack(&self) -> f64 {
        1e-12 * self.range.0.abs().max(self.range.1.abs())
    }

    /// The end of the distribution that is outside the range of the field.
    fn beyond(&self) -> Option<String> {
        let is_normal = self.shape == Shape::Normal;
        let by =
            if is_normal { format!(" at {ALLOWED} standard deviations") } else { String::new() };
        let (reach, slack, (from, to)) = (self.reach(), self.slack(), self.range);
        let is_outside = |end: &f64| *end < from - slack && !self.is_cut() || *end > to + slack;
        let end = [self.centre - reach, self.centre + reach].into_iter().find(is_outside)?;
        let unit = FIELDS[self.field].usual_unit();
        let rounded = significant(units::per(end, unit), 6);
        let rounded = rounded.parse().map_or(rounded, shortest);
        Some(with_unit(&rounded, unit) + &by)
    }

    /// The value below which a fraction `part` of all samples are; `part` is above 0 and below 1.
    pub fn quantile(&self, part: f64) -> f64 {
        let Distribution { centre, width, .. } = *self;
        let normal = Normal::standard();
        let value = match self.shape {
            Shape::Normal => centre + width * normal.inverse_cdf(part),
            Shape::Uniform => centre + width * (2.0 * part - 1.0),
            Shape::Triangular if part < 0.5 => centre - width * (1.0 - (2.0 * part).sqrt()),
            Shape::Triangular => centre + width * (1.0 - (2.0 * (1.0 - part)).sqrt()),
            Shape::Truncated | Shape::Grade => {
                let tail = normal.cdf(-CUT);
                let inside = tail + part * (1.0 - 2.0 * tail);
                let offset = width / CUT * normal.inverse_cdf(inside);
                centre + offset.clamp(-width, width)
            }
        };
        if self.is_cut() { value.max(0.0) } else { value }
    }

    /// Writes a value into the inputs of a model.
    pub fn put(&self, value: f64, inputs: &mut Inputs) {
        let gear = match self.key() {
            "driver.base_pitch" => Some(&mut inputs.driver),
            "driven.base_pitch" => Some(&mut inputs.driven),
            _ => None,
        };
        match gear.filter(|gear| gear.base_pitch.is_none() && gear.grade.is_some()) {
            Some(graded) => graded.sampled_pitch = Some(value),
            None => FIELDS[self.field].put(Value::Number(value), inputs),
        }
    }

    /// The SI unit of the field; empty for a bare number.
    pub fn unit(&self) -> &'static str {
        match FIELDS[self.field].kind {
            Kind::Number(dimension, ..) => dimension.si_unit(),
            _ => "",
        }
    }

    /// The SI unit of the field; 1 for a bare number.
    pub fn unit_or_one(&self) -> &'static str {
        if self.unit().is_empty() { "1" } else { self.unit() }
    }

    /// The key of the field.
    pub fn key(&self) -> &'static str {
        FIELDS[self.field].key
    }
}

/// The value in SI around which the values of a field are drawn: that of the case or of the form.
/// The base pitch deviation of a gear with a flank tolerance class is drawn around 0, because the
/// class permits as much below 0 as above; the case itself has the greatest permitted deviation.
pub fn centre(field: usize, case: &Case, inputs: &Inputs) -> Option<f64> {
    let own = case.value(field).filter(|_| case.effective(field).is_some());
    let gear = match FIELDS[field].key {
        "driver.base_pitch" => Some(&inputs.driver),
        "driven.base_pitch" => Some(&inputs.driven),
        _ => None,
    };
    match gear.map(|gear| inputs.base_pitch_of(gear).1) {
        _ if own.is_some() => own,
        _ if case.is_replaced(field) => None,
        Some(Origin::Grade) => Some(0.0),
        _ => case.derived(field, inputs),
    }
}

/// Base pitch deviation of a flank tolerance class, in m: for the common deviation of both gears that
/// of the larger gear.
fn allowed_deviation(spread: &Spread, inputs: &Inputs) -> f64 {
    let allowed = |gear: &Gear| {
        let grade = Some(spread.width as u32);
        let bare = Gear { base_pitch: None, sampled_pitch: None, grade, ..*gear };
        inputs.base_pitch_of(&bare).0
    };
    match spread.field {
        "driver.base_pitch" => allowed(&inputs.driver),
        "driven.base_pitch" => allowed(&inputs.driven),
        _ => allowed(&inputs.driver).max(allowed(&inputs.driven)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Stages, solve};

    fn distribution(shape: Shape) -> Distribution {
        Distribution {
            field: index_of("deviations.base_pitch").unwrap(),
            range: (0.0, 1e-3),
            centre: 16e-6,
            width: 4e-6,
            shape,
        }
    }

    #[test]
    fn quantiles_are_those_of_the_shapes() {
        for (shape, quantiles) in [
            (Shape::Normal, [9.42058549, 16.0, 22.57941451]),
            (Shape::Uniform, [12.4, 16.0, 19.6]),
            (Shape::Triangular, [13.26491106, 16.0, 18.73508894]),
            // From Python's statistics.NormalDist with a standard deviation of 4/3 um.
            (Shape::Truncated, [13.82241824, 16.0, 18.17758176]),
        ] {
            for (part, wanted) in [0.05, 0.5, 0.95].into_iter().zip(quantiles) {
                let found = 1e6 * distribution(shape).quantile(part);
                assert!((found - wanted).abs() < 1e-8, "{}: {found}", shape.name());
            }
        }
    }

    #[test]
    fn bounded_shapes_stay_within_their_span() {
        for shape in [Shape::Uniform, Shape::Triangular, Shape::Truncated] {
            for part in [f64::MIN_POSITIVE, 1e-17, 0.3, 1.0 - f64::EPSILON / 2.0] {
                let value = distribution(shape).quantile(part);
                assert!((12e-6..=20e-6).contains(&value), "{}: {value}", shape.name());
            }
        }
    }

    #[test]
    fn a_grade_is_the_deviation_of_iso_1328_of_the_larger_gear() {
        let case = Case::table_1();
        let spread = Spread::new("deviations.base_pitch", "grade 7").unwrap();
        for (driver, driven, pitch) in [(20, 20, 14e-6), (20, 400, 18e-6), (400, 20, 18e-6)] {
            let mut inputs = case.inputs().unwrap();
            (inputs.driver.teeth, inputs.driven.teeth) = (driver, driven);
            let found = Distribution::of(&spread, &case, &inputs).unwrap();
            let allowed = pitch * 20_f64.to_radians().cos();
            assert!((found.width - allowed).abs() < 1e-18 && found.shape == Shape::Truncated);
        }
    }

    #[test]
    fn a_spread_that_leaves_the_range_or_has_no_value_is_refused() {
        let mut case = Case::table_1();
        case.set("driven.tip_relief", "10 um").unwrap();
        case.set("deviations.backlash", "10 um").unwrap();
        let refusal = |key, text| {
            let spread = Spread::new(key, text).unwrap();
            let found = Distribution::of(&spread, &case, &case.inputs().unwrap());
            found.map_err(|problem| problem.to_string())
        };
        let message = refusal("deviations.backlash", "uniform 12 um").unwrap_err();
        assert!(
            message.starts_with("spread.\"deviations.backlash\": uniform 12 um reaches -2 um"),
            "{message}"
        );
        let message = refusal("deviations.backlash", "normal 3 um").unwrap_err();
        assert!(message.contains("-5 um at 5 standard deviations"), "{message}");
        assert!(refusal("deviations.backlash", "truncated 10 um").is_ok());
        // A relief cannot add material.
        let relief = refusal("driven.tip_relief", "uniform 12 um").unwrap();
        assert!([0.0, 0.05].map(|part| relief.quantile(part)) == [0.0, 0.0] && relief.is_cut());
        assert!((relief.quantile(0.5) - 10e-6).abs() < 1e-18);
        let message = refusal("operation.torque", "normal 1 N m").unwrap_err();
        assert!(message.contains("operation.torque has no value to spread around"), "{message}");
        assert!(message.ends_with("the case gives operation.power: spread operation.power"));
    }

    #[test]
    fn the_deviation_of_a_graded_gear_is_drawn_around_0_and_replaces_that_of_the_grade() {
        let mut case = Case::table_1();
        case.set("deviations.combination", "sum").unwrap();
        let gears = ["driver", "driven"];
        for gear in gears {
            case.set(&format!("{gear}.grade"), "7").unwrap();
        }
        let inputs = case.inputs().unwrap();
        let mut sample = inputs.clone();
        for (gear, nominal) in gears.iter().zip(inputs.base_pitches()) {
            for text in ["grade 7", "normal 4 um"] {
                let spread = Spread::new(&format!("{gear}.base_pitch"), text).unwrap();
                let found = Distribution::of(&spread, &case, &inputs).unwrap();
                assert_eq!(found.centre.to_bits(), 0);
                let is_graded = found.width.to_bits() == nominal.to_bits();
                assert!(is_graded || found.shape == Shape::Normal, "{found:?}");
                found.put(nominal, &mut sample);
            }
        }
        assert!(sample.driver.sampled_pitch.is_some() && sample.driven.sampled_pitch.is_some());
        let [found, nominal] = [&sample, &inputs].map(|inputs| solve(inputs, Stages::EVERY));
        assert_eq!(found.unwrap(), nominal.unwrap());
    }
}
