//! The stages of a solve in the order of the data flow, and sets of stages.

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

impl Stage {
    /// Every stage, in order.
    pub const ALL: [Stage; 19] = [
        Stage::Geometry,
        Stage::Load,
        Stage::Masses,
        Stage::Deviation,
        Stage::Position,
        Stage::Velocity,
        Stage::Compliance,
        Stage::Impact,
        Stage::Friction,
        Stage::Band,
        Stage::Stations,
        Stage::Mesh,
        Stage::Resonance,
        Stage::Static,
        Stage::Dynamic,
        Stage::StaticSpectrum,
        Stage::SteadyMotion,
        Stage::SpeedRun,
        Stage::Clearing,
    ];

    /// The name in a report.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Stage::Geometry => "geometry",
            Stage::Load => "load",
            Stage::Masses => "masses",
            Stage::Deviation => "deviation",
            Stage::Position => "position",
            Stage::Velocity => "velocity",
            Stage::Compliance => "compliance",
            Stage::Impact => "impact",
            Stage::Friction => "friction",
            Stage::Band => "stiffness-band",
            Stage::Stations => "stations",
            Stage::Mesh => "mesh",
            Stage::Static => "static",
            Stage::Dynamic => "dynamic",
            Stage::Resonance => "resonance",
            Stage::StaticSpectrum => "static-spectrum",
            Stage::SteadyMotion => "steady-motion",
            Stage::SpeedRun => "speed-run",
            Stage::Clearing => "clearing-relief",
        }
    }

    /// The stages whose results this stage or its quantities read.
    pub(super) const fn reads(self) -> Stages {
        let geometry = Stages::NONE.with(Stage::Geometry);
        let pair = geometry.with(Stage::Masses);
        match self {
            Stage::Geometry => Stages::NONE,
            Stage::Load | Stage::Masses => geometry,
            Stage::Deviation => geometry.with(Stage::Load),
            Stage::Mesh => geometry.with(Stage::Load).with(Stage::Deviation),
            Stage::Static | Stage::StaticSpectrum => Stages::NONE.with(Stage::Mesh),
            // The explanations show the natural frequency.
            Stage::Dynamic | Stage::SpeedRun => {
                Stages::NONE.with(Stage::Mesh).with(Stage::Masses).with(Stage::Resonance)
            }
            Stage::Resonance => Stages::NONE.with(Stage::Mesh).with(Stage::Masses),
            // A quantity divides by the static force.
            Stage::SteadyMotion => Stages::NONE
                .with(Stage::Mesh)
                .with(Stage::Masses)
                .with(Stage::Resonance)
                .with(Stage::StaticSpectrum),
            Stage::Position => geometry.with(Stage::Deviation),
            // Stages that the method does not have are ignored.
            Stage::Clearing => pair
                .with(Stage::Load)
                .with(Stage::Deviation)
                .with(Stage::Static)
                .with(Stage::Dynamic),
            Stage::Velocity | Stage::Compliance => geometry.with(Stage::Position),
            Stage::Impact => {
                pair.with(Stage::Position).with(Stage::Velocity).with(Stage::Compliance)
            }
            Stage::Friction => pair.with(Stage::Position).with(Stage::Velocity).with(Stage::Impact),
            Stage::Band => pair.with(Stage::Deviation).with(Stage::Impact),
            Stage::Stations => pair.with(Stage::Position).with(Stage::Impact),
        }
    }

    /// The stages whose results this stage needs. The search for the required relief computes its
    /// own mesh and motion without stations, so it does not need `static` and `dynamic`.
    pub(super) const fn depends_on(self) -> Stages {
        match self {
            Stage::Clearing => self.reads().without(Stage::Static).without(Stage::Dynamic),
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
    pub const CLOSED_FORM: Stages = Stages::of(Stage::Friction);
    /// Every stage of the methods `paper` and `exact` except the required relief.
    pub const ALL: Stages = Stages::CLOSED_FORM.with(Stage::Band).with(Stage::Stations);
    /// The stages that compute stations, in their methods.
    pub const STATIONS: Stages =
        Stages::of(Stage::Stations).and(Stages::of(Stage::Static)).with(Stage::Dynamic);
    /// Every stage except the motion over the speed, which takes a hundred times as long as the
    /// others.
    pub const EVERY: Stages = Stages::ALL
        .and(Stages::of(Stage::Resonance))
        .and(Stages::of(Stage::SteadyMotion))
        .and(Stages::of(Stage::Clearing));
    /// The stages that neither the outcome nor a note needs.
    pub const LATE: Stages = Stages::NONE
        .with(Stage::StaticSpectrum)
        .with(Stage::SteadyMotion)
        .with(Stage::SpeedRun)
        .with(Stage::Clearing);

    /// The stage and all stages that it needs.
    #[must_use]
    pub const fn of(stage: Stage) -> Stages {
        let mut set = Stages::NONE.with(stage);
        let mut index = Stage::ALL.len();
        while index > 0 {
            index -= 1;
            if set.has(Stage::ALL[index]) {
                set = set.and(Stage::ALL[index].reads());
            }
        }
        set
    }

    /// This set with another stage.
    #[must_use]
    pub const fn with(self, stage: Stage) -> Stages {
        Stages(self.0 | 1 << stage as u8)
    }

    /// This set without one stage.
    #[must_use]
    pub const fn without(self, stage: Stage) -> Stages {
        Stages(self.0 & !(1 << stage as u8))
    }

    /// This set without another.
    #[must_use]
    pub const fn except(self, other: Stages) -> Stages {
        Stages(self.0 & !other.0)
    }

    /// The union of two sets.
    #[must_use]
    pub const fn and(self, other: Stages) -> Stages {
        Stages(self.0 | other.0)
    }

    /// The stages in both sets.
    #[must_use]
    pub const fn within(self, other: Stages) -> Stages {
        Stages(self.0 & other.0)
    }

    /// Whether every stage of the other set is in this one.
    #[must_use]
    pub const fn covers(self, other: Stages) -> bool {
        other.0 & !self.0 == 0
    }

    /// Whether the stage is in the set.
    #[must_use]
    pub const fn has(self, stage: Stage) -> bool {
        self.0 & 1 << stage as u8 != 0
    }

    /// The stages of the set, in order.
    pub fn iter(self) -> impl Iterator<Item = Stage> {
        Stage::ALL.into_iter().filter(move |&stage| self.has(stage))
    }
}
