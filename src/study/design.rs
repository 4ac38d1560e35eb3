//! The samples of a tolerance study; each sample is a pure function of the seed and its index.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::batch::{Points, Sequence};
use super::distribution::Distribution;
use crate::case::fields::FIELDS;
use crate::case::{Problem, field_range};
use crate::model::Inputs;
use crate::model::solve::differ_in_load_alone;

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
    #[must_use]
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
    #[must_use]
    pub fn index(&self, member: Member) -> usize {
        let first = |number| self.samples + number * (self.distributions.len() + 1);
        match member {
            Member::Sample(number) => number,
            Member::Second(number) => first(number),
            Member::Swapped(number, field) => first(number) + 1 + field,
        }
    }

    /// The values of a point in SI, in the order of the distributions.
    #[must_use]
    pub fn values(&self, index: usize) -> Vec<f64> {
        self.numbers().values(index).collect()
    }

    fn numbers(&self) -> Numbers<'_> {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&self.seed.to_le_bytes());
        Numbers {
            design: self,
            stream: ChaCha8Rng::from_seed(key),
            next: 0,
            last: None,
            parts: vec![[0.0; 2]; self.distributions.len()],
        }
    }

    /// A point as settings, such as `deviations.base_pitch = 1.6e-5 m`.
    #[must_use]
    pub fn point(&self, index: usize) -> String {
        let values = self.distributions.iter().zip(self.values(index));
        let settings: Vec<String> = values
            .map(|(distribution, value)| {
                let unit = distribution.unit();
                format!(
                    "{} = {}",
                    distribution.key(),
                    super::axis::with_unit(&format!("{value:?}"), unit)
                )
            })
            .collect();
        settings.join(", ")
    }
}

impl Points for Design {
    fn count(&self) -> usize {
        self.samples + self.ranked * (self.distributions.len() + 1)
    }

    fn sequence(&self) -> Sequence<'_> {
        let mut numbers = self.numbers();
        let ranges: Vec<(f64, f64)> = self
            .distributions
            .iter()
            .map(|distribution| field_range(distribution.field))
            .collect();
        Box::new(move |index, inputs| {
            let values = numbers.values(index);
            for ((distribution, &(from, to)), value) in
                self.distributions.iter().zip(&ranges).zip(values)
            {
                if value < from || value > to {
                    return Err(outside(distribution.field));
                }
                distribution.put(value, inputs);
            }
            Ok(())
        })
    }

    fn differ_in_load_alone(&self, inputs: &Inputs) -> bool {
        let is_of_load = |distribution: &Distribution| {
            let mut changed = inputs.clone();
            distribution.put(f64::MIN_POSITIVE, &mut changed);
            differ_in_load_alone(inputs, &changed)
        };
        self.distributions.iter().all(is_of_load)
    }
}

fn outside(field: usize) -> Problem {
    let known = &FIELDS[field];
    Problem {
        field: known.key.to_owned(),
        cause: format!("the sample is outside the range {}", known.range_text()),
        fix: "use a narrower distribution".to_owned(),
    }
}

/// The random numbers of a design. Each sample has its own position in one stream, so that its
/// numbers do not depend on the order of reading. Samples in order are read without a seek.
struct Numbers<'a> {
    design: &'a Design,
    stream: ChaCha8Rng,
    /// The sample at the position of the stream.
    next: usize,
    /// The sample of `parts`.
    last: Option<usize>,
    /// For each field the random numbers of the sample and of the second sample.
    parts: Vec<[f64; 2]>,
}

impl Numbers<'_> {
    /// The values of a point in SI, in the order of the distributions.
    fn values(&mut self, index: usize) -> impl Iterator<Item = f64> {
        let member = self.design.member(index);
        let (number, swapped) = match member {
            Member::Sample(number) | Member::Second(number) => (number, None),
            Member::Swapped(number, field) => (number, Some(field)),
        };
        self.read(number);
        let is_second = matches!(member, Member::Second(_));
        let fields = self.design.distributions.iter().zip(&self.parts);
        fields
            .enumerate()
            .map(move |(field, (distribution, parts))| {
                let second = is_second || swapped == Some(field);
                distribution.quantile(parts[usize::from(second)])
            })
    }

    fn read(&mut self, number: usize) {
        /// Words of 32 bits that a field reads from the stream.
        const WORDS: u128 = 4;
        if self.last == Some(number) {
            return;
        }
        if self.next != number {
            let words = WORDS * self.parts.len() as u128;
            self.stream.set_word_pos(number as u128 * words);
        }
        for parts in &mut self.parts {
            *parts = [part(&mut self.stream), part(&mut self.stream)];
        }
        (self.last, self.next) = (Some(number), number + 1);
    }
}

/// A number above 0 and below 1, from 53 random bits.
fn part(stream: &mut ChaCha8Rng) -> f64 {
    const STEPS: f64 = (1_u64 << 53) as f64;
    ((stream.next_u64() >> 11) as f64 + 0.5) / STEPS
}
