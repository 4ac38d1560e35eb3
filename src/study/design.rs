//! The samples of a tolerance study; each sample is a pure function of the seed and its index.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::batch::{Points, Sequence};
use super::distribution::Distribution;
use crate::case::fields::FIELDS;
use crate::case::{Problem, field_range};
use crate::model::Inputs;
use crate::model::inputs::Combination;
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
        self.numbers().values(index).to_vec()
    }

    /// Whether base pitch deviations are drawn gear by gear. A drawn value is known with its sign,
    /// so that the deviations of a sample add.
    #[must_use]
    pub fn draws_known_deviations(&self) -> bool {
        let of_gear = ["driver.base_pitch", "driven.base_pitch"];
        self.distributions.iter().any(|drawn| of_gear.contains(&drawn.key()))
    }

    fn numbers(&self) -> Numbers<'_> {
        Numbers {
            design: self,
            first: Stream::of(self, 0),
            second: Stream::of(self, 1),
            mixed: vec![0.0; self.distributions.len()],
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
        let rule = self.draws_known_deviations();
        let rule = rule.then(|| "deviations.combination = sum".to_owned());
        settings.into_iter().chain(rule).collect::<Vec<_>>().join(", ")
    }
}

impl Points for Design {
    fn count(&self) -> usize {
        self.samples + self.ranked * (self.distributions.len() + 1)
    }

    fn sequence(&self) -> Sequence<'_> {
        let mut numbers = self.numbers();
        let ranges: Vec<(f64, f64)> =
            self.distributions.iter().map(|distribution| field_range(distribution.field)).collect();
        let adds = self.draws_known_deviations();
        Box::new(move |index, inputs| {
            if adds {
                inputs.combination = Combination::Sum;
            }
            let values = numbers.values(index);
            for ((distribution, &(from, to)), &value) in
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

/// The values of a design: from a stream of the samples, and from a stream of the second samples,
/// which only the ranking reads.
struct Numbers<'a> {
    design: &'a Design,
    first: Stream<'a>,
    second: Stream<'a>,
    /// The values of a swapped point.
    mixed: Vec<f64>,
}

impl Numbers<'_> {
    /// The values of a point in SI, in the order of the distributions.
    fn values(&mut self, index: usize) -> &[f64] {
        match self.design.member(index) {
            Member::Sample(number) => self.first.sample(number),
            Member::Second(number) => self.second.sample(number),
            Member::Swapped(number, field) => {
                self.mixed.copy_from_slice(self.first.sample(number));
                self.mixed[field] = self.second.sample(number)[field];
                &self.mixed
            }
        }
    }
}

/// Samples in which each has its own position in a stream of random numbers, so that its values do
/// not depend on the order of reading. They are computed in blocks, since a processor computes
/// independent values side by side.
struct Stream<'a> {
    distributions: &'a [Distribution],
    generator: ChaCha8Rng,
    /// The first sample of the block.
    first: usize,
    /// The values of the block, sample by sample; empty before the first read.
    values: Vec<f64>,
}

impl Stream<'_> {
    /// Samples of a block.
    const BLOCK: usize = 32;

    fn of(design: &Design, stream: u64) -> Stream<'_> {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&design.seed.to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(stream);
        Stream { distributions: &design.distributions, generator, first: 0, values: Vec::new() }
    }

    /// The values of a sample in SI, in the order of the distributions.
    fn sample(&mut self, number: usize) -> &[f64] {
        let first = number / Self::BLOCK * Self::BLOCK;
        if self.values.is_empty() || self.first != first {
            self.read(first);
        }
        let width = self.distributions.len();
        &self.values[(number - first) * width..][..width]
    }

    fn read(&mut self, first: usize) {
        /// Words of 32 bits that a value reads.
        const WORDS: u128 = 2;
        let width = self.distributions.len();
        self.generator.set_word_pos(WORDS * first as u128 * width as u128);
        self.first = first;
        self.values.clear();
        let numbers = (0..Self::BLOCK * width).map(|_| random_part(&mut self.generator));
        self.values.extend(numbers);
        for (field, distribution) in self.distributions.iter().enumerate() {
            for value in self.values.iter_mut().skip(field).step_by(width) {
                *value = distribution.quantile(*value);
            }
        }
    }
}

/// A number above 0 and below 1, from 53 random bits.
fn random_part(stream: &mut ChaCha8Rng) -> f64 {
    const STEPS: f64 = (1_u64 << 53) as f64;
    ((stream.next_u64() >> 11) as f64 + 0.5) / STEPS
}
