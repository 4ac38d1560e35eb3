//! By how much a tooth that comes in on time stays clear of the flank before E, by each method
//! itself.

use super::inputs::Method;
use super::static_load::lead_before_start;
use super::{Outcome, Solution};

impl Solution {
    /// The gap that is left before E where no tooth touches, in m; none where one does, or where
    /// the method does not tell.
    ///
    /// # Formula
    /// ```text
    /// exact, paper:  −Δ
    /// static:        −max over s ≤ 0 of x(s) + e − S(s),  x the displacement by the other pairs at rest
    /// dynamic:       the same of the motion
    /// ```
    /// The base pitch deviation moves the incoming tooth alone, so that √2 f_pb more of it closes
    /// the gap in every method.
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

    /// By how much the load at rest brings the tooth in early, in m, where the mesh is known; below
    /// 0 is the gap that is left.
    #[must_use]
    pub fn lead_at_rest(&self) -> Option<f64> {
        lead_before_start(self.mesh.as_ref()?).ok()
    }
}
