//! The search for the least relief without contact.

use crate::model::Refusal;

/// Larger reliefs, relative to the result, that the search tests for contact.
const BEYOND: [f64; 4] = [1.05, 1.25, 1.5, 2.0];
/// Number of evenly spaced larger reliefs tested if contact is lost, because small changes then
/// have large effects.
const BEYOND_RATTLE: u32 = 50;

/// A tested relief and its result.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tried {
    /// Additional relief, in m.
    pub(super) relief: f64,
    /// How early the tooth is, in m; above 0 the tooth touches before E.
    pub(super) lead: f64,
    pub(super) contact_lost: bool,
}

/// Solves the pair with an additional relief in m.
pub(super) type Try<'a> = &'a dyn Fn(f64) -> Result<Tried, Refusal>;

/// The least relief without contact. Unless `is_monotonic`, tests larger reliefs as well.
pub(super) fn least(tried: Try<'_>, is_monotonic: bool, most: f64) -> Result<f64, Refusal> {
    let mut clear = crossing(tried, tried(0.0)?, most)?;
    while !is_monotonic && let Some(touching) = touching_beyond(tried, clear)? {
        clear = crossing(tried, touching, most)?;
    }
    Ok(clear.relief)
}

/// The greatest of the tested larger reliefs with contact.
fn touching_beyond(tried: Try<'_>, clear: Tried) -> Result<Option<Tried>, Refusal> {
    let [.., last] = BEYOND;
    let even = (1..=BEYOND_RATTLE)
        .map(|step| 1.0 + (last - 1.0) * f64::from(step) / f64::from(BEYOND_RATTLE));
    let beyond: Vec<f64> = if clear.contact_lost { even.collect() } else { BEYOND.to_vec() };
    for part in beyond.into_iter().rev() {
        let found = tried(part * clear.relief)?;
        if found.lead > 0.0 {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// A relief without contact, close to a relief with contact below it.
fn crossing(tried: Try<'_>, mut touching: Tried, most: f64) -> Result<Tried, Refusal> {
    /// The lead usually falls by as much as the relief grows. Limit of the stride for a lead that
    /// falls more slowly.
    const STRIDE: f64 = 4.0;
    /// Least growth factor of the relief after three strides.
    const GROWTH: f64 = 1.5;
    let mut stride = 1.0;
    let mut strides = 0;
    while touching.lead > 0.0 {
        if touching.relief > most {
            return Err(Refusal::NoClearing { most });
        }
        let least = if strides < 3 { 0.0 } else { GROWTH * touching.relief };
        let aim = (touching.relief + stride * touching.lead).max(least);
        strides += 1;
        let found = tried(aim + ASIDE * closeness(aim))?;
        if found.lead <= 0.0 {
            return narrow_bracket(tried, touching, found);
        }
        let fall = (touching.lead - found.lead) / (found.relief - touching.relief);
        stride = if fall > 0.0 { (1.0 / fall).clamp(1.0, STRIDE) } else { STRIDE };
        touching = found;
    }
    Ok(touching)
}

/// Width of the final bracket, in m.
fn closeness(relief: f64) -> f64 {
    (5e-5 * relief).max(1e-12)
}

/// Offset of a test from the expected crossing, relative to the final width. The last two tests are
/// then on both sides of the crossing.
const ASIDE: f64 = 0.4;

/// The relief without contact at the end of the search in a bracket. Uses secants that aim slightly
/// beyond the crossing, towards the farther end, and halves the bracket if the secants are slow.
fn narrow_bracket(tried: Try<'_>, mut touching: Tried, mut clear: Tried) -> Result<Tried, Refusal> {
    const PATIENCE: usize = 3;
    let mut widths = [f64::INFINITY; PATIENCE];
    loop {
        let (width, near) = (clear.relief - touching.relief, closeness(clear.relief));
        if width <= near {
            return Ok(clear);
        }
        let before = touching.lead / (touching.lead - clear.lead);
        let aside = ASIDE * near * if before < 0.5 { 1.0 } else { -1.0 };
        let is_slow = width > 0.5 * widths[0];
        let aim = touching.relief + if is_slow { 0.5 * width } else { before * width + aside };
        widths.rotate_left(1);
        widths[PATIENCE - 1] = width;
        let found = tried(aim.clamp(touching.relief + 0.1 * near, clear.relief - 0.1 * near))?;
        if found.lead > 0.0 {
            touching = found;
        } else {
            clear = found;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// The least relief for a given lead, and the number of tests.
    fn found(lead: impl Fn(f64) -> f64, contact_lost: bool) -> (Result<f64, Refusal>, u32) {
        let tries = Cell::new(0);
        let tried = |relief: f64| {
            tries.set(tries.get() + 1);
            Ok(Tried { relief, lead: lead(relief), contact_lost })
        };
        (least(&tried, false, 1e-3), tries.get())
    }

    #[test]
    fn the_crossing_of_a_falling_lead_is_found_with_few_tests() {
        type Lead = Box<dyn Fn(f64) -> f64>;
        let leads: [(&str, f64, Lead); 5] = [
            ("as fast as the relief grows", 20e-6, Box::new(|relief| 20e-6 - relief)),
            ("more slowly", 100e-6, Box::new(|relief| 0.2 * (100e-6 - relief))),
            ("faster", 20e-6, Box::new(|relief| 3.0 * (20e-6 - relief))),
            ("constant at the end", 20e-6, Box::new(|relief| (20e-6 - relief).max(-1e-9))),
            (
                "with oscillations",
                20e-6,
                Box::new(|relief| {
                    20e-6 - relief + 4e-6 * (relief * 1e6 * std::f64::consts::PI / 20.0).sin()
                }),
            ),
        ];
        for (name, end, lead) in leads {
            let (relief, tries) = found(lead, false);
            let relief = relief.unwrap();
            assert!(relief >= end && relief - end <= closeness(end), "{name}: {relief:e}");
            assert!(tries <= 20, "{name}: {tries}");
        }
    }

    #[test]
    fn contact_at_a_larger_tested_relief_is_found() {
        let lead = |back: std::ops::Range<f64>| {
            move |relief: f64| {
                if back.contains(&relief) { 1e-6 } else { 20e-6 - relief }
            }
        };
        let (relief, _) = found(lead(29e-6..31e-6), false);
        assert!((relief.unwrap() - 31e-6).abs() < closeness(31e-6), "{relief:?}");
        let narrow = || lead(33.0e-6..33.8e-6);
        assert!(found(narrow(), false).0.unwrap() < 21e-6);
        assert!((found(narrow(), true).0.unwrap() - 33.8e-6).abs() < closeness(34e-6));
    }

    #[test]
    fn a_lead_that_no_relief_removes_is_refused() {
        let (none, tries) = found(|_| 1e-6, false);
        assert_eq!(none.unwrap_err().code(), "no-clearing-relief");
        assert!(tries < 30, "{tries}");
        assert!(found(|relief| 1e-6 + 0.1 * relief, false).0.is_err());
    }
}
