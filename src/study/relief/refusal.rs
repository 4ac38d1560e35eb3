//! Why a search finds no relief.

use std::fmt;

use crate::model::Refusal;

/// Why there is no relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoRelief {
    /// The model refuses the pair.
    Refused(Refusal),
    /// The relief that clears is more than the tip can lose.
    ThinTip {
        /// The gear whose tip is too thin.
        gear: &'static str,
        /// The most that its tip may lose, in m.
        most: f64,
        /// The overlap that remains with it, in m.
        overlap: f64,
    },
    /// The path of contact has no room for a relief.
    ShortPath {
        /// The longest relief, in m.
        length: f64,
        /// The least length of a relief, in m.
        least: f64,
        /// ε.
        ratio: f64,
    },
    /// No relief up to this amount clears.
    Beyond {
        /// In m.
        most: f64,
        /// The overlap that remains with it, in m.
        overlap: f64,
    },
    /// Contact before E in motion with every relief tried.
    InMotion {
        /// The greatest amount tried, in m.
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
        match self {
            NoRelief::Refused(refusal) => write!(f, "{refusal}; {}", refusal.fix()),
            NoRelief::ThinTip {
                gear,
                most,
                overlap,
            } => write!(
                f,
                "no tip relief prevents corner contact: the {gear} tip is thin, its relief is \
                    limited to {}, and the teeth still overlap by {}; lower the greatest load or \
                    the tolerance",
                um(most),
                um(overlap)
            ),
            NoRelief::ShortPath {
                length,
                least,
                ratio,
            } => write!(
                f,
                "no tip relief prevents corner contact: for this load its length is at least {} (20 times \
                 its amount), and beyond {} {} (contact ratio {ratio:.4}); raise the addendum or the \
                 number of teeth, or lower the greatest load",
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
                "no tip relief up to {} prevents corner contact: the teeth still overlap by {}; lower \
                 the greatest load or the tolerance",
                um(most),
                um(overlap)
            ),
            NoRelief::InMotion { most } => write!(
                f,
                "no tip relief up to {} prevents corner contact in motion; raise model.damping_ratio or \
                 change operation.speed, or use --method static",
                um(most)
            ),
        }
    }
}
