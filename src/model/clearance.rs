//! The gap of a tooth without contact before E, by each method.

use super::inputs::Method;
use super::static_load::lead_before_start;
use super::{Outcome, Solution};

impl Solution {
    /// The least gap before E, in m. `None` if a tooth touches before E, or if the method does not
    /// compute the gap.
    ///
    /// # Formula
    /// ```text
    /// exact, paper:  −Δ
    /// static:        −max over s ≤ 0 of x(s) + e − S(s)
    /// dynamic:       −max over t ≤ 0 of x(t) + e − S(t)
    /// ```
    /// x is the displacement by the other pairs, in static balance or in the motion without contact
    /// of the incoming pair. The base pitch deviation moves only the incoming tooth. In every
    /// method an increase of f_pb by the gap/√2 closes the gap.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        if self.outcome == Outcome::CornerContact {
            return None;
        }
        let margin = match self.method {
            Method::Dynamic => self.dynamic.as_ref()?.least_gap?,
            Method::Static => -self.lead_at_rest()?,
            _ => -self.deviation.total,
        };
        (margin >= 0.0).then_some(margin)
    }

    /// How early the static load makes the tooth, in m. A negative value is the gap that is left.
    /// `None` if the mesh is not computed.
    #[must_use]
    pub fn lead_at_rest(&self) -> Option<f64> {
        lead_before_start(self.mesh.as_ref()?).ok()
    }
}
