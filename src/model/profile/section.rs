//! A section of a tooth across its centre line.

use nalgebra::Point2;

/// A section of the tooth across its centre line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// Distance from the gear's centre along the centre line, in m.
    pub along: f64,
    /// Half of the thickness, in m.
    pub half_thickness: f64,
    /// Change of `along` with the parameter.
    pub slope: f64,
}

impl Section {
    /// The end of the section on the flank, y above 0.
    #[must_use]
    pub fn point(&self) -> Point2<f64> {
        Point2::new(self.along, self.half_thickness)
    }
}
