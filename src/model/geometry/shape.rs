//! The shape of a pair: the inputs of its geometry.

use crate::model::inputs::{Gear, Inputs, Method};

/// Inputs of the geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeometryInputs {
    /// Shape of the pair.
    pub shape: PairShape,
    /// Bore radii of driver and driven gear, in m. A thin wall needs double-double arithmetic.
    pub bores: [f64; 2],
    /// Whether the case requests double-double arithmetic.
    pub is_accurate: bool,
}

impl GeometryInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> GeometryInputs {
        GeometryInputs {
            shape: inputs.shape(),
            bores: inputs.bores(),
            is_accurate: inputs.accurate,
        }
    }
}

/// Shape of the pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairShape {
    /// Module m, in m.
    pub module: f64,
    /// Pressure angle α, in rad.
    pub pressure_angle: f64,
    /// Centre distance a, in m; `None` for a mesh without backlash.
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
    /// Tip diameter before the chamfer, in m, which replaces the coefficient.
    pub tip_diameter: Option<f64>,
    /// Dedendum coefficient h_fP*.
    pub dedendum: f64,
    /// Root diameter, in m, which replaces the coefficient.
    pub root_diameter: Option<f64>,
    /// Radial tip chamfer, in m.
    pub tip_chamfer: f64,
    /// Radius of the rounding of the tip's edge, in m; `None` for a sharp tip.
    pub tip_radius: Option<f64>,
}

impl Gear {
    /// Addendum coefficient: h_a* = d_a/(2 m) − z/2 − x if the tip diameter is given, otherwise the
    /// given coefficient. The module is in m.
    #[must_use]
    pub fn addendum_coefficient(&self, module: f64) -> f64 {
        self.tip_diameter
            .map_or(self.addendum, |diameter| self.height_of(diameter, module) - self.profile_shift)
    }

    /// Dedendum coefficient: h_fP* = z/2 + x − d_f/(2 m) if the root diameter is given, otherwise
    /// the given coefficient. The module is in m.
    #[must_use]
    pub fn dedendum_coefficient(&self, module: f64) -> f64 {
        self.root_diameter
            .map_or(self.dedendum, |diameter| self.profile_shift - self.height_of(diameter, module))
    }

    /// Height of a circle above the reference circle, times the module.
    fn height_of(&self, diameter: f64, module: f64) -> f64 {
        (diameter - module * f64::from(self.teeth)) / (2.0 * module)
    }

    /// Shape of the gear with a module in m.
    #[must_use]
    pub fn shape(&self, module: f64) -> GearShape {
        GearShape {
            teeth: self.teeth,
            profile_shift: self.profile_shift,
            addendum: self.addendum_coefficient(module),
            tip_diameter: self.tip_diameter,
            dedendum: self.dedendum_coefficient(module),
            root_diameter: self.root_diameter,
            tip_chamfer: self.tip_chamfer,
            tip_radius: self.tip_radius,
        }
    }
}

impl Inputs {
    /// Shape of the pair. The method `paper` has only sharp tips.
    #[must_use]
    pub fn shape(&self) -> PairShape {
        let shape = |gear: &Gear| {
            let shape = gear.shape(self.module);
            let tip_radius = shape.tip_radius.filter(|_| self.method != Method::Paper);
            GearShape { tip_radius, ..shape }
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
