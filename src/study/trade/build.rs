//! Time to build the elastic fields of a pair, apart from the solves that read them.

use std::hint::black_box;
use std::time::{Duration, Instant};

use super::clock::Patience;
use crate::model::compliance::ElasticGear;
use crate::model::compliance::tooth::field_gear;
use crate::model::inputs::Gear;
use crate::model::{Inputs, Refusal};

/// Seconds to build the field of each gear; later solves read the cached fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Build {
    /// Driver.
    pub driver: f64,
    /// Driven gear.
    pub driven: f64,
}

impl Build {
    /// Builds both fields without the cache, several times if `patience` allows; returns the least
    /// time.
    ///
    /// # Errors
    /// The refusal of a gear without a field.
    pub(super) fn measure(inputs: &Inputs, patience: Patience) -> Result<Build, Refusal> {
        let of = |gear: &Gear| seconds(&ElasticGear::of(inputs, gear), patience);
        Ok(Build { driver: of(&inputs.driver)?, driven: of(&inputs.driven)? })
    }
}

fn seconds(gear: &ElasticGear, patience: Patience) -> Result<f64, Refusal> {
    const REPEATS: usize = 3;
    let repeats = if patience.most == Duration::ZERO { 1 } else { REPEATS };
    let mut least = f64::INFINITY;
    for _ in 0..repeats {
        let begun = Instant::now();
        black_box(field_gear(black_box(gear)).build()?);
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Ok(least)
}
