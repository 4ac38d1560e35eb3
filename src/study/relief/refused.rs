//! Why there is no relief.

use std::fmt;

use crate::model::Refusal;

/// Why there is no relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoRelief {
    /// The model refuses the pair.
    Refused(Refusal),
    /// The relief without corner contact exceeds the thickness that the tip can lose.
    ThinTip {
        /// The gear whose tip is too thin.
        gear: &'static str,
        /// Greatest amount that its tip may lose, in m.
        most: f64,
        /// Overlap that remains with this amount, in m.
        overlap: f64,
    },
    /// The path of contact has no room for a relief.
    ShortPath {
        /// The longest relief, in m.
        length: f64,
        /// The least useful length, in m.
        least: f64,
        /// Contact ratio ε.
        ratio: f64,
    },
    /// No relief up to this amount prevents corner contact.
    Beyond {
        /// The greatest amount, in m.
        most: f64,
        /// Overlap that remains with this amount, in m.
        overlap: f64,
    },
    /// In motion the teeth touch before E with every evaluated relief.
    InMotion {
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
        let um = |length: &f64| format!("{:.1} um", length * 1e6);
        let mm = |length: &f64| format!("{:.2} mm", length * 1e3);
        let none = "no tip relief prevents corner contact";
        let fix = "lower the greatest load or a tolerance, or find the relief with the least force \
            before E (--minimise entry)";
        match self {
            NoRelief::Refused(refusal) => write!(f, "{refusal}; {}", refusal.fix()),
            NoRelief::ThinTip { gear, most, overlap } => write!(
                f,
                "{none}: the {gear} tip is thin, its relief is limited to {}, and the teeth still \
                 overlap by {}; {fix}",
                um(most),
                um(overlap)
            ),
            NoRelief::ShortPath { length, least, ratio } => write!(
                f,
                "{none}: for this load and these tolerances its length is at least {} (20 times \
                 its amount), and beyond {} {} (contact ratio {ratio:.4}); raise the addendum or \
                 the number of teeth, or lower the greatest load",
                mm(least),
                mm(length),
                if *ratio < 2.0 {
                    "it reaches the contact of a single pair"
                } else {
                    "the unrelieved flanks lose contact under light load"
                }
            ),
            NoRelief::Beyond { most, overlap } => write!(
                f,
                "{none} up to {}: the teeth still overlap by {}; {fix}",
                um(most),
                um(overlap)
            ),
            NoRelief::InMotion { most } => write!(
                f,
                "{none} in motion up to {}; raise model.damping_ratio or change operation.speed, \
                 or use --method static",
                um(most)
            ),
        }
    }
}
