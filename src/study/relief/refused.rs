//! Why there is no relief.

use std::fmt;

use super::Demand;
use crate::case::Problem;
use crate::case::units::System;
use crate::model::Refusal;
use crate::numeric::decimal::shortest;

const FIX: &str = "lower the greatest load or a tolerance, or find the relief with the least force \
    before E (--minimise entry)";

/// The conditions of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    units: System,
    /// The greatest load, relative to the load of the case.
    load: f64,
    /// The tolerances of amounts and lengths, in m.
    tolerances: [f64; 2],
    /// The greatest length, in m.
    length: f64,
}

impl Conditions {
    pub(super) fn of(demand: &Demand, length: f64) -> Conditions {
        let tolerances = [demand.tolerance, demand.tolerance_length.unwrap_or(0.0)];
        Conditions { units: demand.units, load: demand.greatest_load(), tolerances, length }
    }

    fn um(&self, amount: f64) -> String {
        self.units.text(amount, "um", 3)
    }

    fn mm(&self, length: f64) -> String {
        self.units.text(length, "mm", 3)
    }
}

/// Why there is no relief.
#[derive(Debug, Clone, PartialEq)]
pub enum NoRelief {
    /// The model refuses the pair.
    Refused(Refusal),
    /// With its deviation the misalignment is beyond its limit.
    Misaligned(Box<Problem>),
    /// The relief without corner contact exceeds the thickness that the tip can lose.
    ThinTip {
        /// The conditions of the search.
        of: Conditions,
        /// The gear whose tip is too thin.
        gear: &'static str,
        /// Greatest amount that its tip may lose, in m.
        most: f64,
        /// Overlap that remains with this amount, in m.
        overlap: f64,
    },
    /// The path of contact has no room for a relief.
    ShortPath {
        /// The conditions of the search.
        of: Conditions,
        /// The least useful length, in m.
        least: f64,
        /// Contact ratio ε.
        ratio: f64,
    },
    /// No relief up to this amount prevents corner contact.
    Beyond {
        /// The conditions of the search.
        of: Conditions,
        /// The greatest amount, in m.
        most: f64,
        /// Overlap that remains with this amount, in m.
        overlap: f64,
    },
    /// In motion the teeth touch before E with every evaluated relief.
    InMotion {
        /// The conditions of the search.
        of: Conditions,
        /// The greatest evaluated amount, in m.
        most: f64,
    },
}

impl From<Refusal> for NoRelief {
    fn from(refusal: Refusal) -> NoRelief {
        NoRelief::Refused(refusal)
    }
}

impl fmt::Display for NoRelief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (of, reason) = match self {
            NoRelief::Refused(refusal) => return write!(f, "{refusal}; {}", refusal.fix()),
            NoRelief::Misaligned(problem) => {
                return write!(
                    f,
                    "the misalignment with its deviation: {}; {}",
                    problem.cause, problem.fix
                );
            }
            NoRelief::ThinTip { of, gear, most, overlap } => {
                let [most, overlap] = [most, overlap].map(|amount| of.um(*amount));
                let reason = format!(
                    "the {gear} tip is thin, its relief is limited to {most}, and the teeth still \
                     overlap by {overlap}; {FIX}"
                );
                (of, reason)
            }
            NoRelief::ShortPath { of, least, ratio } => {
                let [length, least] = [of.length, *least].map(|length| of.mm(length));
                let reason = if *ratio < 2.0 {
                    "it reaches the contact of a single pair"
                } else {
                    "the unrelieved flanks lose contact under light load"
                };
                let reason = format!(
                    "its length is at least {least} (20 times its amount), and beyond {length} \
                     {reason} (contact ratio {ratio:.4}); raise the addendum or the number of \
                     teeth, or lower the greatest load"
                );
                (of, reason)
            }
            NoRelief::Beyond { of, most, overlap } => {
                let [most, overlap] = [most, overlap].map(|amount| of.um(*amount));
                (of, format!("up to {most} the teeth still overlap by {overlap}; {FIX}"))
            }
            NoRelief::InMotion { of, most } => {
                let reason = format!(
                    "up to {} the teeth touch in motion; raise model.damping_ratio or change \
                     operation.speed, or use --method static",
                    of.um(*most)
                );
                (of, reason)
            }
        };
        let longest = match self {
            NoRelief::ShortPath { .. } => String::new(),
            _ => format!(" and a length of at most {}", of.mm(of.length)),
        };
        write!(
            f,
            "no tip relief prevents corner contact at {} % of the load with tolerances {} on \
             amounts and {} on lengths{longest}: {reason}",
            shortest((of.load * 1e4).round() / 100.0),
            of.um(of.tolerances[0]),
            of.mm(of.tolerances[1])
        )
    }
}
