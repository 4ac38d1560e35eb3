//! Inputs of a solve, in SI units.

use super::given::GivenCompliance;
use super::stage::{Stage, Stages};

/// A gear of the pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GearSide {
    /// Gear 1.
    Driver,
    /// Gear 2.
    Driven,
}

impl GearSide {
    /// The other gear.
    pub fn other(self) -> GearSide {
        if self == GearSide::Driver { GearSide::Driven } else { GearSide::Driver }
    }
}

/// Hand of the helix of a gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hand {
    /// The teeth turn to the right along the axis.
    Right,
    /// The teeth turn to the left along the axis.
    Left,
}

impl Hand {
    /// Both hands.
    pub const ALL: [Hand; 2] = [Hand::Right, Hand::Left];

    /// 1 for a right hand, −1 for a left one.
    pub fn sign(self) -> f64 {
        if self == Hand::Right { 1.0 } else { -1.0 }
    }
}

/// Inputs of one gear.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// Moment of inertia of all parts that turn with the gear, in kg m². `None` to compute the
    /// moment.
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
    /// Base pitch deviation f_pb of this gear, in m. `None` to use its flank tolerance class or the
    /// common value.
    pub base_pitch: Option<f64>,
    /// Sample of the base pitch deviation of a gear with a flank tolerance class, in m, in place of the
    /// value of the class, which keeps its other tolerances.
    pub sampled_pitch: Option<f64>,
    /// Flank tolerance class of ISO 1328-1:2013.
    pub grade: Option<u32>,
    /// Helix slope deviation f_Hβ over the face width, in m; above 0 the helix angle is larger than
    /// that of the design.
    pub helix_slope: f64,
    /// Crowning C_β: material removed at both ends of the face, in m.
    pub crowning: f64,
    /// End relief at the end of the face towards −z and +z, in m.
    pub end_reliefs: [f64; 2],
    /// Length of the end reliefs along the face, in m. `None` for a tenth of the face width.
    pub end_relief_length: Option<f64>,
}

impl Gear {
    /// Length of the end reliefs, in m: a tenth of the face width unless given.
    pub fn length_of_end_relief(&self) -> f64 {
        self.end_relief_length.unwrap_or(0.1 * self.face_width)
    }

    /// Whether an end of the face has a relief.
    pub fn has_end_relief(&self) -> bool {
        self.end_reliefs.iter().any(|relief| *relief > 0.0)
    }
}

/// A full-depth gear without shift, relief and bore. Teeth, width and material are zero, which
/// every check refuses.
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
            sampled_pitch: None,
            grade: None,
            helix_slope: 0.0,
            crowning: 0.0,
            end_reliefs: [0.0; 2],
            end_relief_length: None,
        }
    }
}

/// The given drive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Drive {
    /// Power on the driver, in W.
    Power(f64),
    /// Torque on the driver, in N m.
    Torque(f64),
}

/// The method of the computation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Zhou & Chen 2014 as printed, with misprints corrected.
    Paper,
    /// The exact contact position and the duration of the spring.
    Exact,
    /// The load shared by all pairs in contact, corner contact included.
    Static,
    /// The shared load with inertia.
    Dynamic,
    /// The fastest of `exact`, `static` and `dynamic` within the tolerance.
    Auto,
}

impl Method {
    /// Every method, fastest first, then `auto`.
    pub const ALL: [Method; 5] =
        [Method::Paper, Method::Exact, Method::Static, Method::Dynamic, Method::Auto];
    /// The methods with a solution in microseconds.
    pub const CLOSED_FORM: [Method; 2] = [Method::Paper, Method::Exact];

    /// Whether all pairs in contact share the load. Reliefs then act along the flanks, and the
    /// method ignores a given deflection.
    pub fn shares_load(self) -> bool {
        matches!(self, Method::Static | Method::Dynamic)
    }

    /// The stages of the method.
    pub fn stages(self) -> Stages {
        const IMPACT: Stages =
            Stages::CLOSED_FORM.with(Stage::Figures).with(Stage::Band).with(Stage::Clearing);
        const AT_REST: Stages = Stages::of(Stage::StaticSpectrum).with(Stage::Resonance);
        const STATIC: Stages = IMPACT.and(Stages::of(Stage::Static)).and(AT_REST);
        const DYNAMIC: Stages =
            STATIC.with(Stage::Dynamic).with(Stage::SteadyMotion).with(Stage::SpeedRun);
        match self {
            Method::Paper | Method::Exact => Stages::ALL.with(Stage::Clearing),
            Method::Static => STATIC,
            Method::Dynamic => DYNAMIC,
            Method::Auto => Stages::EVERY.with(Stage::SpeedRun),
        }
    }

    /// The stages that decide whether the tooth strikes, besides those of every solve.
    pub fn deciding_stages(self) -> Stages {
        match self {
            Method::Exact => Stages::NONE,
            // The printed equations can give no contact although the total deviation is above 0.
            Method::Paper => Stages::of(Stage::Position),
            Method::Static => Stages::of(Stage::Static),
            Method::Dynamic | Method::Auto => Stages::of(Stage::Dynamic),
        }
    }

    /// The name in a case file.
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

/// A tooth compliance by its name, see the list in `compliance::tooth`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ToothCompliance(&'static str);

impl ToothCompliance {
    pub(super) const fn named(name: &'static str) -> ToothCompliance {
        ToothCompliance(name)
    }

    /// The name in a case file.
    pub fn name(self) -> &'static str {
        self.0
    }
}

/// A contact compliance by its name, see the list in `compliance::contact`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactCompliance(&'static str);

impl ContactCompliance {
    pub(super) const fn named(name: &'static str) -> ContactCompliance {
        ContactCompliance(name)
    }

    /// The name in a case file.
    pub fn name(self) -> &'static str {
        self.0
    }
}

/// The body for the moment of inertia of a gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InertiaModel {
    /// The outline of the gear.
    Outline,
    /// A disc up to the base circle, Eq. 47.
    BaseCircle,
}

impl InertiaModel {
    /// Every model.
    pub const ALL: [InertiaModel; 2] = [InertiaModel::Outline, InertiaModel::BaseCircle];
}

/// How the base pitch deviations of both gears add.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Combination {
    /// As squares: deviations of which only the size is known.
    Independent,
    /// With their signs: deviations that are known.
    Sum,
}

impl Combination {
    /// Every rule.
    pub const ALL: [Combination; 2] = [Combination::Independent, Combination::Sum];
}

/// Shape of a relief from its start to its full amount.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReliefShape {
    /// Proportional to the distance.
    Linear,
    /// Proportional to the square of the distance.
    Parabolic,
}

impl ReliefShape {
    /// Every shape.
    pub const ALL: [ReliefShape; 2] = [ReliefShape::Linear, ReliefShape::Parabolic];
}

/// A gear pair in operation: all inputs of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs {
    /// Normal module m_n, in m.
    pub module: f64,
    /// Normal pressure angle α_n, in rad.
    pub pressure_angle: f64,
    /// Helix angle β at the reference cylinder, in rad; 0 for a spur pair.
    pub helix_angle: f64,
    /// Hand of the driver; the driven gear has the other.
    pub driver_hand: Hand,
    /// Middle of the driven face minus middle of the driver's along +z, in m.
    pub face_offset: f64,
    /// Centre distance a, in m; `None` for a mesh without backlash.
    pub centre_distance: Option<f64>,
    /// Gear 1.
    pub driver: Gear,
    /// Gear 2.
    pub driven: Gear,
    /// Base pitch deviation f_pb of a gear without its own value, in m.
    pub base_pitch_deviation: f64,
    /// How the base pitch deviations of both gears add; see [`Inputs::effective_combination`].
    pub combination: Combination,
    /// Misalignment F_βx of the flanks over the common face width, in m; above 0 the flanks open
    /// towards +z.
    pub misalignment: f64,
    /// Normal backlash j_bn, in m.
    pub backlash: f64,
    /// Power or torque on the driver.
    pub drive: Drive,
    /// Speed of the driver ω₁, in rad/s.
    pub speed: f64,
    /// Coulomb friction coefficient μ.
    pub friction_coefficient: Option<f64>,
    /// The method.
    pub method: Method,
    /// Combined deflection δ, in m; `None` to compute it from the load.
    pub deflection: Option<f64>,
    /// Compliance of the teeth; `None` to select it by its range.
    pub tooth_compliance: Option<ToothCompliance>,
    /// Compliance of the contact.
    pub contact_compliance: ContactCompliance,
    /// The table of the compliance model `given`.
    pub given_compliance: Option<GivenCompliance>,
    /// Number of slices of the face width; `None` for as many as the pair needs.
    pub slices: Option<usize>,
    /// Whether a force on a slice displaces the slices beside it.
    pub slice_coupling: bool,
    /// Whether a force on a tooth displaces its neighbours, if the tooth compliance has it.
    pub tooth_coupling: bool,
    /// Body of a gear without a given inertia.
    pub inertia: InertiaModel,
    /// Shape of tip and root reliefs along the path of contact.
    pub relief_shape: ReliefShape,
    /// Damping ratio ζ of the mesh with its mean stiffness.
    pub damping_ratio: f64,
    /// Number of base pitches before the incoming tooth reaches E.
    pub warmup_cycles: u32,
    /// Permitted relative error of the peak force in the method `dynamic`. The bound applies to
    /// damped motion: without damping and with loss of contact the motion is chaotic, and small
    /// errors grow with every base pitch.
    pub tolerance: f64,
    /// Permitted relative error of the method `auto` against the method `dynamic`.
    pub within: f64,
    /// Intervals between D and E; `None` for as many as the curve needs.
    pub stations: Option<usize>,
    /// Permitted distance of the curve from the straight lines between its stations, relative to
    /// its peak, if their number is not given.
    pub station_tolerance: f64,
    /// Number of even samples of the force from the first contact to E in the method `dynamic`, for
    /// the comparison with the method `static`.
    pub approach_samples: usize,
    /// Whether geometry and position use double-double arithmetic.
    pub accurate: bool,
    /// Stages of the limited and selected quantities, which the method `auto` computes besides the
    /// results of its choice.
    pub needs: Stages,
}

/// Inputs without size, gears and load, which every check refuses, and with the default settings of
/// the model.
impl Default for Inputs {
    fn default() -> Inputs {
        Inputs {
            module: 0.0,
            pressure_angle: 0.0,
            helix_angle: 0.0,
            driver_hand: Hand::Right,
            face_offset: 0.0,
            centre_distance: None,
            driver: Gear::default(),
            driven: Gear::default(),
            base_pitch_deviation: 0.0,
            combination: Combination::Independent,
            misalignment: 0.0,
            backlash: 0.0,
            drive: Drive::Power(0.0),
            speed: 0.0,
            friction_coefficient: None,
            method: Method::Exact,
            deflection: None,
            tooth_compliance: None,
            contact_compliance: ContactCompliance::ALL[0],
            given_compliance: None,
            slices: None,
            slice_coupling: true,
            tooth_coupling: true,
            inertia: InertiaModel::Outline,
            relief_shape: ReliefShape::Linear,
            damping_ratio: 0.07,
            warmup_cycles: 20,
            tolerance: 1e-6,
            within: 0.05,
            stations: Some(64),
            station_tolerance: 1e-3,
            approach_samples: 0,
            accurate: false,
            needs: Stages::NONE,
        }
    }
}

impl Inputs {
    /// The inputs with more stages that the method `auto` computes besides its choice.
    pub fn needing(self, stages: impl IntoIterator<Item = Stage>) -> Inputs {
        let needs = stages.into_iter().fold(self.needs, Stages::with);
        Inputs { needs, ..self }
    }

    /// A gear of the pair.
    pub fn gear(&self, side: GearSide) -> &Gear {
        if side == GearSide::Driver { &self.driver } else { &self.driven }
    }

    /// Transmission ratio i = z₂/z₁ = ω₁/ω₂.
    pub fn ratio(&self) -> f64 {
        f64::from(self.driven.teeth) / f64::from(self.driver.teeth)
    }

    /// Speed of the driven gear ω₂ = ω₁/i, in rad/s.
    pub fn driven_speed(&self) -> f64 {
        self.speed / self.ratio()
    }

    /// Torque on the driver T₁, in N m.
    pub fn torque(&self) -> f64 {
        match self.drive {
            Drive::Power(power) => power / self.speed,
            Drive::Torque(torque) => torque,
        }
    }

    /// The given deflection if the method uses it, in m.
    pub fn given_deflection(&self) -> Option<f64> {
        self.deflection.filter(|_| !self.method.shares_load())
    }

    /// First and last place of the common face, from the middle of the driver's face along +z, in m.
    pub fn common_face(&self) -> (f64, f64) {
        let [driver, driven] = [&self.driver, &self.driven].map(|gear| 0.5 * gear.face_width);
        let (first, last) = (self.face_offset - driven, self.face_offset + driven);
        (first.max(-driver), last.min(driver))
    }

    /// Common face width b, in m.
    pub fn common_width(&self) -> f64 {
        let (first, last) = self.common_face();
        last - first
    }

    /// cos β.
    pub fn helix_cosine(&self) -> f64 {
        if self.helix_angle == 0.0 { 1.0 } else { self.helix_angle.cos() }
    }

    /// Transverse module m_t = m_n/cos β, in m.
    pub fn transverse_module(&self) -> f64 {
        self.module / self.helix_cosine()
    }

    /// Transverse pressure angle, tan α_t = tan α_n/cos β, in rad.
    pub fn transverse_pressure_angle(&self) -> f64 {
        if self.helix_angle > 0.0 {
            (self.pressure_angle.tan() / self.helix_cosine()).atan()
        } else {
            self.pressure_angle
        }
    }

    /// Base helix angle, sin β_b = sin β cos α_n, in rad.
    pub fn base_helix_angle(&self) -> f64 {
        if self.helix_angle == 0.0 {
            return 0.0;
        }
        (self.helix_angle.sin() * self.pressure_angle.cos()).asin()
    }
}
