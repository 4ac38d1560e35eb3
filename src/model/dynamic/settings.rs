//! How a motion is computed.

use crate::model::inputs::Inputs;
use crate::model::spacing::Spacing;

/// What a run is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Mass at the line of action m_e, in kg.
    pub mass: f64,
    /// Damping ratio ζ.
    pub damping_ratio: f64,
    /// Base pitches before E at which the run starts.
    pub warmup_cycles: u32,
    /// Normal backlash j_bn, in m; without it the back flanks are far away.
    pub backlash: Option<f64>,
    /// Relative error that the peak force may have.
    pub tolerance: f64,
    /// Stations between the first contact and E, and again from there to the last.
    pub spacing: Spacing,
}

impl Inputs {
    /// How the motion is computed; the mass at the line of action is not known yet.
    #[must_use]
    pub fn motion(&self) -> Settings {
        Settings {
            mass: 0.0,
            damping_ratio: self.damping_ratio,
            warmup_cycles: self.warmup_cycles,
            backlash: Some(self.backlash).filter(|&backlash| backlash > 0.0),
            tolerance: self.tolerance,
            spacing: Spacing::of(self),
        }
    }

    /// How the steady motion is computed; the mass at the line of action is not known yet.
    #[must_use]
    pub fn steady_motion(&self) -> Settings {
        self.motion().without_warmup()
    }
}

impl Settings {
    /// Those of a case, with the mass at the line of action, in kg.
    #[must_use]
    pub fn of(inputs: &Inputs, mass: f64) -> Settings {
        Settings {
            mass,
            ..inputs.motion()
        }
    }

    /// The same without warm-up and stations.
    #[must_use]
    pub fn without_warmup(self) -> Settings {
        Settings {
            warmup_cycles: 0,
            ..self.without_stations()
        }
    }

    /// The same with a single interval of stations.
    #[must_use]
    pub fn without_stations(self) -> Settings {
        Settings {
            spacing: Spacing::Even(1),
            ..self
        }
    }
}
