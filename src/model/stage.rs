//! The stages of a solve in the order of the data flow, and sets of stages.

use Stage::{
    Band, Clearing, Compliance, Deviation, Dynamic, Figures, Friction, Geometry, Impact, Load,
    Masses, Mesh, Position, Resonance, SpeedRun, Static, StaticSpectrum, SteadyMotion, Velocity,
};

/// A stage of a solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Stage {
    /// Involute geometry of the pair.
    Geometry,
    /// Force along the line of action.
    Load,
    /// Masses of the gears at their base circles.
    Masses,
    /// Figures of ISO 21771 and ISO 6336-1.
    Figures,
    /// Deviation and deflection that make the tooth early.
    Deviation,
    /// First contact D of the tip on the flank.
    Position,
    /// Approach and sliding velocity at D.
    Velocity,
    /// Compliance of the teeth in contact at D.
    Compliance,
    /// Force, energy and duration of the impact.
    Impact,
    /// Change of the velocities over the impact.
    Friction,
    /// Impact force by every stiffness model.
    Band,
    /// Force between D and E.
    Stations,
    /// Gap and stiffness of every pair along the line of action.
    Mesh,
    /// Mesh frequency and natural frequency.
    Resonance,
    /// Load sharing in static balance.
    Static,
    /// Load sharing with inertia and damping.
    Dynamic,
    /// Harmonics of the static transmission error.
    StaticSpectrum,
    /// Steady motion, which repeats with every base pitch.
    SteadyMotion,
    /// Steady motion over the speed, rising and falling.
    SpeedRun,
    /// Required additional tip relief.
    Clearing,
}

/// Each stage with its name in a report and the stages whose results it or its quantities read, in
/// order. Stages that the method does not have are ignored.
const ROWS: [(Stage, &str, &[Stage]); 20] = [
    (Geometry, "geometry", &[]),
    (Load, "load", &[Geometry]),
    (Masses, "masses", &[Geometry]),
    (Figures, "figures", &[Geometry, Load, Masses]),
    (Deviation, "deviation", &[Geometry, Load]),
    (Position, "position", &[Geometry, Deviation]),
    (Velocity, "velocity", &[Geometry, Position]),
    (Compliance, "compliance", &[Geometry, Position]),
    (Impact, "impact", &[Geometry, Masses, Position, Velocity, Compliance]),
    (Friction, "friction", &[Geometry, Masses, Position, Velocity, Impact]),
    (Band, "stiffness-band", &[Geometry, Masses, Deviation, Impact]),
    (Stage::Stations, "stations", &[Geometry, Masses, Position, Impact]),
    (Mesh, "mesh", &[Geometry, Load, Deviation]),
    (Resonance, "resonance", &[Mesh, Masses]),
    (Static, "static", &[Mesh]),
    // The explanations show the natural frequency.
    (Dynamic, "dynamic", &[Mesh, Masses, Resonance]),
    (StaticSpectrum, "static-spectrum", &[Mesh]),
    // A quantity divides by the static force.
    (SteadyMotion, "steady-motion", &[Mesh, Masses, Resonance, StaticSpectrum]),
    (SpeedRun, "speed-run", &[Mesh, Masses, Resonance]),
    (Clearing, "clearing-relief", &[Geometry, Masses, Load, Deviation, Static, Dynamic]),
];

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Stage; ROWS.len()] = {
        let mut all = [Geometry; ROWS.len()];
        let mut at = 0;
        while at < ROWS.len() {
            all[at] = ROWS[at].0;
            at += 1;
        }
        all
    };

    /// The name in a report.
    pub const fn name(self) -> &'static str {
        ROWS[self as usize].1
    }

    /// The stages whose results this stage or its quantities read.
    const fn reads(self) -> Stages {
        Stages::all_of(ROWS[self as usize].2)
    }

    /// The stages whose results this stage needs. The search for the required relief computes its
    /// own mesh and motion without stations, so it does not need `static` and `dynamic`.
    pub(super) const fn depends_on(self) -> Stages {
        match self {
            Clearing => self.reads().without(Static).without(Dynamic),
            _ => self.reads(),
        }
    }
}

/// A set of stages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stages(u32);

impl Stages {
    /// No stage.
    pub const NONE: Stages = Stages(0);
    /// From geometry to friction: all results of one impact model at D.
    pub const CLOSED_FORM: Stages = Stages::of(Friction);
    /// Every stage of the methods `paper` and `exact` except the required relief.
    pub const ALL: Stages = Stages::CLOSED_FORM.with(Band).with(Stage::Stations).with(Figures);
    /// The stages that compute stations, in their methods.
    pub const STATIONS: Stages = Stages::of(Stage::Stations).and(Stages::of(Static)).with(Dynamic);
    /// Every stage except the motion over the speed, which takes a hundred times as long as the
    /// others.
    pub const EVERY: Stages = Stages::ALL
        .and(Stages::of(Resonance))
        .and(Stages::of(SteadyMotion))
        .and(Stages::of(Clearing));
    /// The stages that neither the outcome nor a note needs.
    pub const LATE: Stages = Stages::all_of(&[StaticSpectrum, SteadyMotion, SpeedRun, Clearing]);

    const fn all_of(stages: &[Stage]) -> Stages {
        let (mut set, mut at) = (Stages::NONE, 0);
        while at < stages.len() {
            set = set.with(stages[at]);
            at += 1;
        }
        set
    }

    /// The stage and all stages that it needs.
    pub const fn of(stage: Stage) -> Stages {
        let mut set = Stages::NONE.with(stage);
        let mut index = ROWS.len();
        while index > 0 {
            index -= 1;
            if set.has(ROWS[index].0) {
                set = set.and(ROWS[index].0.reads());
            }
        }
        set
    }

    /// This set with another stage.
    pub const fn with(self, stage: Stage) -> Stages {
        Stages(self.0 | 1 << stage as u8)
    }

    /// This set without one stage.
    pub const fn without(self, stage: Stage) -> Stages {
        Stages(self.0 & !(1 << stage as u8))
    }

    /// This set without another.
    pub const fn except(self, other: Stages) -> Stages {
        Stages(self.0 & !other.0)
    }

    /// The union of two sets.
    pub const fn and(self, other: Stages) -> Stages {
        Stages(self.0 | other.0)
    }

    /// The stages in both sets.
    pub const fn within(self, other: Stages) -> Stages {
        Stages(self.0 & other.0)
    }

    /// Whether every stage of the other set is in this one.
    pub const fn covers(self, other: Stages) -> bool {
        other.0 & !self.0 == 0
    }

    /// Whether the stage is in the set.
    pub const fn has(self, stage: Stage) -> bool {
        self.0 & 1 << stage as u8 != 0
    }

    /// The stages of the set, in order.
    pub fn iter(self) -> impl Iterator<Item = Stage> {
        Stage::ALL.into_iter().filter(move |&stage| self.has(stage))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_are_in_the_order_of_the_stages() {
        for (at, stage) in Stage::ALL.into_iter().enumerate() {
            assert_eq!(stage as usize, at);
            assert!(stage.reads().iter().all(|read| read < stage), "{}", stage.name());
        }
    }
}
