//! What a solve needs to know of a gear pair, in SI units.

use super::stage::{Stage, Stages};

/// One gear of the pair.
#[derive(Debug, Clone, PartialEq)]
pub struct Gear {
    /// Number of teeth z.
    pub teeth: u32,
    /// Profile shift coefficient x.
    pub profile_shift: f64,
    /// Addendum coefficient h_a*, times the module.
    pub addendum: f64,
    /// Tip diameter d_a before a chamfer, in m; it replaces the addendum coefficient.
    pub tip_diameter: Option<f64>,
    /// Dedendum coefficient h_fP* of the cutting rack, times the module.
    pub dedendum: f64,
    /// Root diameter d_f, in m; it replaces the dedendum coefficient.
    pub root_diameter: Option<f64>,
    /// Face width b, in m.
    pub face_width: f64,
    /// Bore radius r_h, in m.
    pub bore_radius: f64,
    /// Young's modulus E, in Pa.
    pub young: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
    /// Density ρ, in kg/m³.
    pub density: f64,
    /// Moment of inertia of all that turns with the gear, in kg m²; without it computed.
    pub inertia: Option<f64>,
    /// Material removed at the tip, in m.
    pub tip_relief: f64,
    /// Material removed at the root, in m.
    pub root_relief: f64,
    /// Length of the tip relief along the path of contact, from the tip, in m.
    pub tip_relief_length: Option<f64>,
    /// Length of the root relief along the path of contact, from its end at the root, in m.
    pub root_relief_length: Option<f64>,
    /// Radial tip chamfer, which shortens the active tip, in m.
    pub tip_chamfer: f64,
    /// Radius of the tip's edge, in m.
    pub tip_radius: Option<f64>,
    /// Base pitch deviation f_pb of this gear, in m; without it by its grade, or the common one.
    pub base_pitch: Option<f64>,
    /// Flank tolerance class of ISO 1328-1:2013.
    pub grade: Option<u32>,
}

/// A full-depth gear without shift, relief and bore, of which nothing else is given yet: teeth,
/// width and material are zero, which no check lets through.
impl Default for Gear {
    fn default() -> Gear {
        Gear {
            teeth: 0,
            profile_shift: 0.0,
            addendum: 1.0,
            tip_diameter: None,
            dedendum: 1.25,
            root_diameter: None,
            face_width: 0.0,
            bore_radius: 0.0,
            young: 0.0,
            poisson: 0.0,
            density: 0.0,
            inertia: None,
            tip_relief: 0.0,
            root_relief: 0.0,
            tip_relief_length: None,
            root_relief_length: None,
            tip_chamfer: 0.0,
            tip_radius: None,
            base_pitch: None,
            grade: None,
        }
    }
}

/// What drives the pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// Power on the driver, in W.
    Power(f64),
    /// Torque on the driver, in N m.
    Torque(f64),
}

/// How much of the physics is taken in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Zhou & Chen 2014 as printed, without its misprints.
    Paper,
    /// The exact contact position and the spring's own duration.
    Exact,
    /// The load shared by every pair in contact, corner contact included.
    Static,
    /// The same with inertia.
    Dynamic,
    /// The cheapest of `exact`, `static` and `dynamic` that is good enough.
    Auto,
}

impl Method {
    /// Every method, cheapest first, and the choice among them.
    pub const ALL: [Method; 5] = [
        Method::Paper,
        Method::Exact,
        Method::Static,
        Method::Dynamic,
        Method::Auto,
    ];
    /// The methods that answer in a microsecond.
    pub const CLOSED_FORM: [Method; 2] = [Method::Paper, Method::Exact];

    /// Whether every pair in contact takes its share of the load, so that reliefs act along the
    /// flanks and a deflection that the case gives is not needed.
    #[must_use]
    pub fn shares_load(self) -> bool {
        matches!(self, Method::Static | Method::Dynamic)
    }

    /// The stages that the method has.
    #[must_use]
    pub fn stages(self) -> Stages {
        const IMPACT: Stages = Stages::CLOSED_FORM.with(Stage::Band).with(Stage::Clearing);
        const AT_REST: Stages = Stages::of(Stage::StaticSpectrum).with(Stage::Resonance);
        const STATIC: Stages = IMPACT.and(Stages::of(Stage::Static)).and(AT_REST);
        const DYNAMIC: Stages = STATIC.with(Stage::Dynamic).with(Stage::SteadyMotion);
        match self {
            Method::Paper | Method::Exact => Stages::ALL.with(Stage::Clearing),
            Method::Static => STATIC,
            Method::Dynamic => DYNAMIC,
            Method::Auto => Stages::EVERY,
        }
    }

    /// The stages that decide whether the tooth strikes, beyond those that every solve has.
    #[must_use]
    pub fn deciding_stages(self) -> Stages {
        match self {
            Method::Exact => Stages::NONE,
            // The printed equations bring a tooth in on time whose deviation is above 0 yet.
            Method::Paper => Stages::of(Stage::Position),
            Method::Static => Stages::of(Stage::Static),
            Method::Dynamic | Method::Auto => Stages::of(Stage::Dynamic),
        }
    }

    /// The name in a case file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Method::Paper => "paper",
            Method::Exact => "exact",
            Method::Static => "static",
            Method::Dynamic => "dynamic",
            Method::Auto => "auto",
        }
    }
}

/// A tooth compliance by its name; `compliance::tooth` has the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ToothCompliance(&'static str);

impl ToothCompliance {
    pub(super) const fn named(name: &'static str) -> ToothCompliance {
        ToothCompliance(name)
    }

    /// The name in a case file.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.0
    }
}

/// A contact compliance by its name; `compliance::contact` has the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactCompliance(&'static str);

impl ContactCompliance {
    pub(super) const fn named(name: &'static str) -> ContactCompliance {
        ContactCompliance(name)
    }

    /// The name in a case file.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.0
    }
}

/// The body whose moment of inertia a gear has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InertiaModel {
    /// The gear's true outline.
    Outline,
    /// A disc up to the base circle, Eq. 47.
    BaseCircle,
}

impl InertiaModel {
    /// Every model.
    pub const ALL: [InertiaModel; 2] = [InertiaModel::Outline, InertiaModel::BaseCircle];
}

/// How a relief grows from its start to its full amount.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReliefShape {
    /// In proportion to the way.
    Linear,
    /// With its square.
    Parabolic,
}

impl ReliefShape {
    /// Every shape.
    pub const ALL: [ReliefShape; 2] = [ReliefShape::Linear, ReliefShape::Parabolic];
}

/// A gear pair in operation: all that a solve reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs {
    /// Module m, in m.
    pub module: f64,
    /// Pressure angle α, in rad.
    pub pressure_angle: f64,
    /// Centre distance a, in m; without it the mesh has no backlash.
    pub centre_distance: Option<f64>,
    /// Gear 1.
    pub driver: Gear,
    /// Gear 2.
    pub driven: Gear,
    /// Base pitch deviation f_pb of a gear without its own, in m.
    pub base_pitch_deviation: f64,
    /// Normal backlash j_bn, in m.
    pub backlash: f64,
    /// Power or torque on the driver.
    pub drive: Drive,
    /// Speed of the driver ω₁, in rad/s.
    pub speed: f64,
    /// Coulomb friction coefficient μ, to stand beside the kinematic ratio.
    pub friction_coefficient: Option<f64>,
    /// How much of the physics is taken in.
    pub method: Method,
    /// Combined deflection δ, in m; without it computed from the load.
    pub deflection: Option<f64>,
    /// Compliance of the teeth; without it chosen by its range.
    pub tooth_compliance: Option<ToothCompliance>,
    /// Compliance of the contact.
    pub contact_compliance: ContactCompliance,
    /// Body of a gear without a given inertia.
    pub inertia: InertiaModel,
    /// How tip and root reliefs grow along the path of contact.
    pub relief_shape: ReliefShape,
    /// Damping ratio ζ of the mesh, of its mean stiffness.
    pub damping_ratio: f64,
    /// Base pitches that pass before the incoming tooth reaches E.
    pub warmup_cycles: u32,
    /// Relative error that the peak force of the method `dynamic` may have. A promise where the
    /// motion is damped: without damping and with contact lost it is chaotic, and a small error
    /// grows with every base pitch.
    pub tolerance: f64,
    /// Relative error against the method `dynamic` that the method `auto` may leave.
    pub within: f64,
    /// Intervals between D and E; without a number as many as the curve needs.
    pub stations: Option<usize>,
    /// What the curve may lie off the straight lines between its stations, over its peak, where
    /// their number is not given.
    pub station_tolerance: f64,
    /// Geometry and position in double-double arithmetic.
    pub accurate: bool,
    /// Stages of the limited and the selected quantities, which the method `auto` must compute.
    pub needs: Stages,
}

/// What a case stands for that says nothing: no size, no gears, no load, which no check lets
/// through, and the model's usual settings.
impl Default for Inputs {
    fn default() -> Inputs {
        Inputs {
            module: 0.0,
            pressure_angle: 0.0,
            centre_distance: None,
            driver: Gear::default(),
            driven: Gear::default(),
            base_pitch_deviation: 0.0,
            backlash: 0.0,
            drive: Drive::Power(0.0),
            speed: 0.0,
            friction_coefficient: None,
            method: Method::Exact,
            deflection: None,
            tooth_compliance: None,
            contact_compliance: ContactCompliance::ALL[0],
            inertia: InertiaModel::Outline,
            relief_shape: ReliefShape::Linear,
            damping_ratio: 0.07,
            warmup_cycles: 20,
            tolerance: 1e-6,
            within: 0.05,
            stations: Some(64),
            station_tolerance: 1e-3,
            accurate: false,
            needs: Stages::NONE,
        }
    }
}

impl Inputs {
    /// The same, with these stages of quantities among those that the method `auto` must compute.
    #[must_use]
    pub fn needing(self, stages: impl IntoIterator<Item = Stage>) -> Inputs {
        let needs = stages.into_iter().fold(self.needs, Stages::with);
        Inputs { needs, ..self }
    }

    /// Transmission ratio i = z₂/z₁ = ω₁/ω₂.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        f64::from(self.driven.teeth) / f64::from(self.driver.teeth)
    }

    /// Speed of the driven gear ω₂ = ω₁/i, in rad/s.
    #[must_use]
    pub fn driven_speed(&self) -> f64 {
        self.speed / self.ratio()
    }

    /// Torque on the driver T₁, in N m.
    #[must_use]
    pub fn torque(&self) -> f64 {
        match self.drive {
            Drive::Power(power) => power / self.speed,
            Drive::Torque(torque) => torque,
        }
    }

    /// The deflection that the case gives, where the method takes it, in m.
    #[must_use]
    pub fn deflection_taken(&self) -> Option<f64> {
        self.deflection.filter(|_| !self.method.shares_load())
    }

    /// Common face width b, the smaller of the two, in m.
    #[must_use]
    pub fn common_width(&self) -> f64 {
        self.driver.face_width.min(self.driven.face_width)
    }
}
