//! Inputs of the mesh.

use crate::model::compliance::Elasticity;
use crate::model::geometry::PairShape;
use crate::model::inputs::Inputs;
use crate::model::relief::Reliefs;

/// Inputs of the mesh besides geometry, mesh force and error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshInputs {
    /// Shape of the pair. For the run-out, the gears are swapped.
    pub shape: PairShape,
    /// Elasticity of the pair.
    pub elasticity: Elasticity,
    /// Reliefs of the pair.
    pub reliefs: Reliefs,
    /// Radii of the tip edges of driver and driven gear, in m.
    pub tip_radii: [Option<f64>; 2],
    /// Speed of the driver ω₁, in rad/s.
    pub speed: f64,
    /// Friction coefficient; 0 if the case gives none.
    pub friction: f64,
}

impl Inputs {
    /// Inputs of the mesh.
    #[must_use]
    pub fn mesh(&self) -> MeshInputs {
        MeshInputs {
            shape: self.shape(),
            elasticity: self.elasticity(),
            reliefs: self.reliefs(),
            tip_radii: [self.driver.tip_radius, self.driven.tip_radius],
            speed: self.speed,
            friction: self.friction_coefficient.unwrap_or(0.0),
        }
    }
}

impl MeshInputs {
    /// Inputs of the mesh of a case at any speed.
    #[must_use]
    pub fn at_any_speed(inputs: &Inputs) -> MeshInputs {
        inputs.mesh().at_speed(1.0)
    }

    pub(super) fn driven_speed(&self) -> f64 {
        self.speed / (f64::from(self.shape.driven.teeth) / f64::from(self.shape.driver.teeth))
    }

    /// The inputs at another speed of the driver, in rad/s.
    #[must_use]
    pub fn at_speed(self, speed: f64) -> MeshInputs {
        MeshInputs { speed, ..self }
    }

    /// The inputs with the gears swapped.
    pub(super) fn swapped(&self) -> MeshInputs {
        let MeshInputs { shape, elasticity, reliefs, tip_radii: [driver_tip, driven_tip], .. } =
            *self;
        MeshInputs {
            shape: PairShape { driver: shape.driven, driven: shape.driver, ..shape },
            elasticity: Elasticity {
                driver: elasticity.driven,
                driven: elasticity.driver,
                ..elasticity
            },
            reliefs: Reliefs { driver: reliefs.driven, driven: reliefs.driver, ..reliefs },
            tip_radii: [driven_tip, driver_tip],
            speed: self.driven_speed(),
            friction: self.friction,
        }
    }
}
