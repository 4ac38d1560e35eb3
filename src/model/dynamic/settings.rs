//! Settings of a motion.

use crate::model::inputs::Inputs;
use crate::model::spacing::Spacing;

/// Settings of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Mass at the line of action m_e, in kg.
    pub mass: f64,
    /// Damping ratio ζ.
    pub damping_ratio: f64,
    /// Number of base pitches before E at which the run starts.
    pub warmup_cycles: u32,
    /// Normal backlash j_bn, in m. With `None` the back flanks never touch.
    pub backlash: Option<f64>,
    /// Permitted relative error of the peak force.
    pub tolerance: f64,
    /// Stations between the first contact and E, and between E and the last contact.
    pub spacing: Spacing,
    /// Number of even samples of the force from the first contact to E; 0 for none.
    pub approach_samples: usize,
}

/// Inputs of a motion, besides mesh and masses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionInputs {
    /// Speed of the driver ω₁, at which the mesh turns, in rad/s.
    pub speed: f64,
    /// The settings without the mass.
    settings: Settings,
}

impl MotionInputs {
    /// Selects the inputs of the method `dynamic` from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> MotionInputs {
        MotionInputs { speed: inputs.speed, settings: Settings::of(inputs, 0.0) }
    }

    /// Selects the inputs of the steady motion, which has neither warm-up nor stations.
    #[must_use]
    pub fn steady(inputs: &Inputs) -> MotionInputs {
        MotionInputs { speed: inputs.speed, settings: Settings::of(inputs, 0.0).without_warmup() }
    }

    /// Selects the inputs of the approach, which has no stations.
    #[must_use]
    pub fn approach(inputs: &Inputs) -> MotionInputs {
        MotionInputs { speed: inputs.speed, settings: Settings::of(inputs, 0.0).without_stations() }
    }

    /// The settings with the mass at the line of action, in kg.
    #[must_use]
    pub fn settings(&self, mass: f64) -> Settings {
        Settings { mass, ..self.settings }
    }
}

impl Settings {
    /// The settings of a case, with the mass at the line of action, in kg.
    #[must_use]
    pub fn of(inputs: &Inputs, mass: f64) -> Settings {
        Settings {
            mass,
            damping_ratio: inputs.damping_ratio,
            warmup_cycles: inputs.warmup_cycles,
            backlash: Some(inputs.backlash).filter(|&backlash| backlash > 0.0),
            tolerance: inputs.tolerance,
            spacing: Spacing::of(inputs),
            approach_samples: inputs.approach_samples,
        }
    }

    /// The settings without warm-up and stations.
    fn without_warmup(self) -> Settings {
        Settings { warmup_cycles: 0, ..self.without_stations() }
    }

    /// The settings with a single interval of stations.
    fn without_stations(self) -> Settings {
        Settings { spacing: Spacing::Even(1), approach_samples: 0, ..self }
    }
}
