//! Notes beside the results, each with its value and its limit.

mod compliance;
mod gear;
mod impact;
mod load;
mod pair;

use super::{Inputs, Solution};
use crate::numeric::decimal::significant;

/// A note beside the results.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// A short name for scripts.
    pub code: &'static str,
    /// One sentence with the value and the limit.
    pub message: String,
}

impl Note {
    fn new(code: &'static str, message: String) -> Note {
        Note { code, message }
    }
}

/// A value with four significant digits.
fn four(value: f64) -> String {
    significant(value, 4)
}

/// Returns a note if its condition is true.
type Look = fn(&Inputs, &Solution) -> Option<Note>;

/// All conditions, in the order of the notes.
const LOOKS: &[Look] = &[
    load::method_taken,
    load::deflection_ignored,
    load::backlash_subtracted,
    load::deviations_added,
    load::lost_in_motion,
    load::stiffness_step,
    load::back_strikes,
    load::not_cleared,
    load::inertia,
    impact::withheld,
    impact::stations_left_out,
    impact::barely_clear,
    impact::gap_left_open,
    impact::outlasting,
    impact::impulse,
    impact::contact_lost,
    impact::sliding_reverses,
    impact::end_not_found,
    impact::friction,
    load::deflection_given,
    gear::common_base_pitch,
    gear::grade_driver,
    gear::grade_driven,
    gear::inertia_driver,
    gear::inertia_driven,
    compliance::chosen_by_range,
    compliance::outside_range,
    compliance::without_coupling,
    compliance::hertz_width,
    pair::contact_ratio_above_two,
    pair::contact_ratio_below_one,
    pair::centre_distance,
    pair::start_past_pitch,
    pair::interference_at_end,
    pair::undercut_driver,
    pair::undercut_driven,
    pair::tip_driver,
    pair::tip_driven,
    pair::form_circle,
];

/// The notes on the results.
#[must_use]
pub fn notes(inputs: &Inputs, solution: &Solution) -> Vec<Note> {
    LOOKS.iter().filter_map(|look| look(inputs, solution)).collect()
}
