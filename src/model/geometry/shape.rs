//! The shape of a pair: what its geometry reads of a case.

use crate::model::inputs::{Gear, Inputs, Method};

/// Shape of the pair: all that its geometry depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairShape {
    /// Module m, in m.
    pub module: f64,
    /// Pressure angle α, in rad.
    pub pressure_angle: f64,
    /// Centre distance a, in m; without it the mesh has no backlash.
    pub centre_distance: Option<f64>,
    /// Shape of the driver.
    pub driver: GearShape,
    /// Shape of the driven gear.
    pub driven: GearShape,
}

/// Shape of one gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearShape {
    /// Number of teeth z.
    pub teeth: u32,
    /// Profile shift coefficient x.
    pub profile_shift: f64,
    /// Addendum coefficient h_a*.
    pub addendum: f64,
    /// Dedendum coefficient h_fP*.
    pub dedendum: f64,
    /// Radial tip chamfer, in m.
    pub tip_chamfer: f64,
    /// Radius of the rounding of the tip's edge, in m; a sharp tip has none.
    pub tip_radius: Option<f64>,
}

impl Gear {
    /// Shape of the gear.
    #[must_use]
    pub fn shape(&self) -> GearShape {
        GearShape {
            teeth: self.teeth,
            profile_shift: self.profile_shift,
            addendum: self.addendum,
            dedendum: self.dedendum,
            tip_chamfer: self.tip_chamfer,
            tip_radius: self.tip_radius,
        }
    }
}

impl Inputs {
    /// Shape of the pair. The method `paper` knows sharp tips alone.
    #[must_use]
    pub fn shape(&self) -> PairShape {
        let shape = |gear: &Gear| {
            let shape = gear.shape();
            let tip_radius = shape.tip_radius.filter(|_| self.method != Method::Paper);
            GearShape {
                tip_radius,
                ..shape
            }
        };
        PairShape {
            module: self.module,
            pressure_angle: self.pressure_angle,
            centre_distance: self.centre_distance,
            driver: shape(&self.driver),
            driven: shape(&self.driven),
        }
    }

    /// Bore radii of driver and driven gear, in m.
    #[must_use]
    pub fn bores(&self) -> [f64; 2] {
        [self.driver.bore_radius, self.driven.bore_radius]
    }
}
