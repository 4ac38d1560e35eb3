//! Checks the circles of a gear: the diameters of tip and root must give valid coefficients, and
//! the bore must be smaller than the root.

use super::problem::Problem;
use super::value::field_range;
use crate::case::fields::index_of;
use crate::model::Inputs;
use crate::model::inputs::Gear;
use crate::numeric::decimal::significant;

const COEFFICIENT_DIGITS: usize = 4;

/// The keys of the fields that determine the circles of one gear.
pub(super) struct CircleFields {
    gear: fn(&Inputs) -> &Gear,
    bore_radius: &'static str,
    dedendum: &'static str,
    /// Keys of the fields that determine the reference circle.
    reference: &'static [&'static str],
    heights: [Height; 2],
}

/// A diameter that replaces a coefficient of the rack.
struct Height {
    diameter_key: &'static str,
    coefficient_key: &'static str,
    name: &'static str,
    diameter: fn(&Gear) -> Option<f64>,
    /// The coefficient for a module in m.
    coefficient: fn(&Gear, f64) -> f64,
    /// 1 if the diameter grows with the coefficient, otherwise -1.
    sign: f64,
}

macro_rules! circle_fields {
    ($gear:ident) => {
        CircleFields {
            gear: |inputs| &inputs.$gear,
            bore_radius: concat!(stringify!($gear), ".bore_radius"),
            dedendum: concat!(stringify!($gear), ".dedendum"),
            reference: &[
                "pair.module",
                "pair.diametral_pitch",
                concat!(stringify!($gear), ".teeth"),
                concat!(stringify!($gear), ".profile_shift"),
            ],
            heights: [
                Height {
                    diameter_key: concat!(stringify!($gear), ".tip_diameter"),
                    coefficient_key: concat!(stringify!($gear), ".addendum"),
                    name: "addendum",
                    diameter: |gear| gear.tip_diameter,
                    coefficient: Gear::addendum_coefficient,
                    sign: 1.0,
                },
                Height {
                    diameter_key: concat!(stringify!($gear), ".root_diameter"),
                    coefficient_key: concat!(stringify!($gear), ".dedendum"),
                    name: "dedendum",
                    diameter: |gear| gear.root_diameter,
                    coefficient: Gear::dedendum_coefficient,
                    sign: -1.0,
                },
            ],
        }
    };
}

pub(super) static OF_GEARS: [CircleFields; 2] = [circle_fields!(driver), circle_fields!(driven)];

impl Problem {
    /// The problem at the diameter if the inputs give the diameter instead of the coefficient.
    #[must_use]
    pub fn at_given_diameter(mut self, inputs: &Inputs) -> Problem {
        let heights = OF_GEARS.iter().flat_map(|fields| {
            let gear = (fields.gear)(inputs);
            fields.heights.iter().map(move |height| (gear, height))
        });
        let mut given = heights.filter(|(gear, height)| {
            height.coefficient_key == self.field && (height.diameter)(gear).is_some()
        });
        if let Some((_, height)) = given.next() {
            height.diameter_key.clone_into(&mut self.field);
        }
        self
    }
}

impl CircleFields {
    /// The problems of the circles. Skips rules with invalid fields.
    pub(super) fn misfits(
        &self,
        inputs: &Inputs,
        sound: &impl Fn(&[&str]) -> bool,
    ) -> Vec<Problem> {
        if !sound(self.reference) {
            return Vec::new();
        }
        let gear = (self.gear)(inputs);
        let heights = self.heights.iter();
        let mut found: Vec<Problem> = heights
            .filter(|height| sound(&[height.diameter_key]))
            .filter_map(|height| height.outside_range(gear, inputs.module))
            .collect();
        let [_, root] = &self.heights;
        let is_root_sound = found.iter().all(|problem| problem.field != root.diameter_key);
        if is_root_sound && sound(&[self.bore_radius, self.dedendum, root.diameter_key]) {
            found.extend(bore_through_root(self.bore_radius, gear, inputs.module));
        }
        found
    }
}

impl Height {
    /// A diameter whose coefficient is outside the range of the field that it replaces.
    fn outside_range(&self, gear: &Gear, module: f64) -> Option<Problem> {
        /// A diameter at an end of the range has the end as its coefficient except for rounding.
        const SLACK: f64 = 1e-9;
        let diameter = (self.diameter)(gear)?;
        let coefficient = (self.coefficient)(gear, module);
        let (from, to) = field_range(index_of(self.coefficient_key)?);
        let (side, limit) = if coefficient < from - SLACK {
            ("below", from)
        } else if coefficient > to + SLACK {
            ("above", to)
        } else {
            return None;
        };
        let cause = format!(
            "{} mm gives the {} coefficient {}, {side} the limit of {limit}",
            in_mm(diameter),
            self.name,
            significant(coefficient, COEFFICIENT_DIGITS),
        );
        let shifted = f64::from(gear.teeth) + 2.0 * gear.profile_shift;
        let at = |coefficient: f64| in_mm(module * (shifted + 2.0 * self.sign * coefficient));
        let (least, most) = (at(from).min(at(to)), at(from).max(at(to)));
        let fix = format!("write a diameter from {least} to {most} mm");
        Some(Problem::new(self.diameter_key, cause, fix))
    }
}

fn bore_through_root(field: &str, gear: &Gear, module: f64) -> Option<Problem> {
    let dedendum = gear.dedendum_coefficient(module);
    let root = module * (f64::from(gear.teeth) / 2.0 - dedendum + gear.profile_shift);
    (gear.bore_radius >= root).then(|| {
        let (bore, root) = (in_mm(gear.bore_radius), in_mm(root));
        let cause = format!(
            "the bore radius {bore} mm is not below the root circle's {root} mm = m (z/2 - hf* + x)"
        );
        Problem::new(field, cause, format!("write a radius (not a diameter) below {root} mm"))
    })
}

/// A length in mm for a message.
fn in_mm(metres: f64) -> f64 {
    (metres * 1e7).round() / 1e4
}
