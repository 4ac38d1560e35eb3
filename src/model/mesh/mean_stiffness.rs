//! Mean stiffness of a mesh.

use std::sync::Arc;

use super::Mesh;
use super::zones::{STIFFNESS, Zone};
use crate::numeric::quadrature;

impl Mesh {
    /// Mean stiffness of the mesh over a base pitch, with the pairs on the line of action, in N/m.
    #[must_use]
    pub fn mean_stiffness(&self) -> f64 {
        let mean = || self.stiffness_on_line() / self.base_pitch;
        *self.mean_stiffness.0.get_or_init(mean)
    }

    /// ∫ of the stiffness of all pairs on the line of action over a base pitch, in N.
    fn stiffness_on_line(&self) -> f64 {
        /// Of the integral between two borders.
        const TOLERANCE: f64 = 1e-12;
        let on_line = |zone: &&Zone| zone.from >= 0.0 && zone.to <= self.length;
        let zones = self.zones.iter().filter(on_line);
        if self.couplings.is_none() {
            return zones.map(|zone| zone.series.integral(STIFFNESS)).sum();
        }
        let line = Mesh { zones: Arc::new(zones.cloned().collect()), ..self.clone() };
        let stiffness = |s: f64, inside: f64| {
            let pairs = line.pair_set(s, inside).of_no_gap();
            pairs.forces(1.0).iter().sum::<f64>()
        };
        // The borders of the line alone: the places beyond it depend on the computed range.
        let borders = line.borders(0.0, self.base_pitch);
        let over = |ends: &[f64]| {
            let (from, to) = (ends[0], ends[1]);
            let inside = f64::midpoint(from, to);
            quadrature::adaptive(from, to, TOLERANCE, |s| stiffness(s, inside))
        };
        borders.windows(2).map(over).sum()
    }
}
