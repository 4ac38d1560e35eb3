//! Limits of the model: refusals with their values, messages, codes and fixes.

use std::fmt;

use thiserror::Error;

use super::explanation::tidy;
use super::inputs::{GearSide, Method};
use crate::numeric::decimal::significant;

const MICROMETRE: f64 = 1e-6;

/// A member of the inputs, of one gear or of the pair: the field where a fix begins.
pub type Member = (Option<GearSide>, &'static str);

/// The reason why a pair, or some of its quantities, cannot be computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// The driven tip would touch the driver below its base circle.
    Interference {
        /// N₁E, in m.
        start: f64,
    },
    /// The path of contact ends before it starts.
    NoPath {
        /// N₁E, in m.
        start: f64,
        /// N₁B, in m.
        end: f64,
        /// Whether the case gives the centre distance.
        is_distance_given: bool,
        /// The tip chamfer or tip radius that removes the greatest part of the path, if whole tips
        /// reach each other.
        cut: Option<Member>,
    },
    /// The tip has no involute.
    TipInsideBase {
        /// The gear.
        gear: GearSide,
        /// Whether the chamfer cuts the involute off.
        is_cut: bool,
        /// r_a, in m.
        tip: f64,
        /// r_b, in m.
        base: f64,
    },
    /// A relief removes a whole tooth.
    ReliefTooLarge {
        /// The gear.
        gear: GearSide,
        /// Whether the tip relief is too large, not the root relief.
        is_at_tip: bool,
        /// The relief, in m.
        relief: f64,
        /// Half the thickness of the tooth at the base circle, in m.
        half: f64,
    },
    /// The cutting rack's flanks meet above its tip.
    PointedRack {
        /// The gear.
        gear: GearSide,
        /// h_fP*.
        dedendum: f64,
        /// π/(4 tan α).
        limit: f64,
    },
    /// The base circles overlap.
    CentreDistanceJams {
        /// a, in m.
        distance: f64,
        /// r_b1 + r_b2, in m.
        least: f64,
    },
    /// No centre distance without backlash exists.
    ShiftsLeaveNoMesh {
        /// x₁ + x₂.
        sum: f64,
    },
    /// No pair is in contact when the next pair starts contact.
    ContactRatioBelowOne {
        /// ε.
        ratio: f64,
        /// Whether the method accepts a given deflection.
        is_deflection_taken: bool,
        /// The tip chamfer or tip radius that removes the greatest part of the path, if whole tips
        /// have a greater contact ratio than 1.
        cut: Option<Member>,
    },
    /// At times no pair of a helical gear pair is in contact.
    TotalContactRatioBelowOne {
        /// ε_γ.
        ratio: f64,
    },
    /// The end reliefs of a gear are longer than its face.
    EndReliefsOverlap {
        /// The gear.
        gear: GearSide,
        /// Length of its end reliefs together, in m.
        length: f64,
        /// Face width, in m.
        width: f64,
    },
    /// The slices are too wide for the overlap ratio.
    TooFewSlices {
        /// Number of slices.
        slices: usize,
        /// Least number.
        least: usize,
    },
    /// The method has no answer for a pair whose load varies over the face width.
    NotOverFace {
        /// The method.
        method: Method,
    },
    /// In motion the driver reaches the back flanks of a pair whose load varies over the face width.
    BackFlanksOverFace,
    /// The bore leaves no gear body.
    BoreTooLarge {
        /// The gear.
        gear: GearSide,
        /// r_h, in m.
        bore: f64,
        /// The circle that limits the bore.
        circle: &'static str,
        /// The radius of that circle, in m.
        limit: f64,
    },
    /// S(u) = Δ has no solution on the driver's flank.
    NoFirstContact {
        /// Δ, in m.
        deviation: f64,
    },
    /// The centre of the tip's rounding is inside the base circle.
    RoundingInsideBase {
        /// The gear.
        gear: GearSide,
        /// r_e, in m.
        radius: f64,
        /// r_a − r_b, in m.
        limit: f64,
    },
    /// The tooth is too thin for the rounding of its tip.
    RoundingTooWide {
        /// The gear.
        gear: GearSide,
        /// r_e, in m.
        radius: f64,
        /// Missing half thickness of the tooth, on the base circle, in m.
        lack: f64,
    },
    /// Rounded tips leave a path of contact shorter than a base pitch.
    RoundingBreaksContact {
        /// The tip chamfer or tip radius that removes the greatest part of the path.
        cut: Member,
        /// ε.
        ratio: f64,
    },
    /// The contact is beyond the arc of the rounded tip.
    BeyondRounding {
        /// r_b2', in m.
        arm: f64,
    },
    /// The driver's flank ends before D.
    BeyondDriverTip {
        /// O₁D, in m.
        radius: f64,
        /// Radius at which the driver's involute ends, in m.
        tip: f64,
    },
    /// Eq. 56 does not cover the tooth number.
    TeethOutsideFit {
        /// z.
        teeth: f64,
        /// Least and greatest z of the fit.
        range: (u32, u32),
    },
    /// Eq. 56 does not cover the profile shift.
    ShiftOutsideFit {
        /// x.
        shift: f64,
        /// Greatest |x| of the fit.
        limit: f64,
    },
    /// Eq. 56 gives no positive stiffness at this height of the tooth.
    HeightOutsideFit {
        /// (r_x − r)/((1 + x) m).
        height: f64,
    },
    /// The tooth has no thickness at the load point.
    PointedTip {
        /// The gear.
        gear: GearSide,
        /// Thickness, in m.
        thickness: f64,
    },
    /// The undercut leaves no neck below the tooth.
    CutThrough {
        /// The gear.
        gear: GearSide,
        /// x.
        shift: f64,
    },
    /// The load point is on the fillet, outside the involute.
    BelowFormCircle {
        /// The gear.
        gear: GearSide,
        /// Radius of the load point, in m.
        radius: f64,
        /// Radius of the form circle, in m.
        form: f64,
    },
    /// The gear has no finite elements.
    NoField {
        /// z.
        teeth: f64,
        /// The reason.
        reason: FieldRefusal,
    },
    /// The driver's tip would touch the driven gear below its base circle.
    InterferenceAtEnd {
        /// N₂B, in m.
        start: f64,
    },
    /// The deflection of the pairs is so large that a tip would leave the other flank.
    BeyondReach,
    /// The compliances of neighbouring pairs are inconsistent.
    IndefiniteCompliance,
    /// Friction locks the gears.
    FrictionLocks {
        /// μ.
        friction: f64,
        /// The least coefficient that locks the gears.
        limit: f64,
    },
    /// The mesh oscillates too often while a tooth passes.
    TooSlow {
        /// Oscillations of the mesh.
        swings: f64,
        /// Greatest number of oscillations.
        limit: f64,
    },
    /// The series of the motion is not finite.
    NotConverged,
    /// The motion exceeds its budget of work.
    MotionTooLong {
        /// Steps.
        steps: u64,
        /// The computed part of the motion, from 0 to 1.
        done: f64,
    },
    /// The motion does not become periodic.
    NoSteadyMotion {
        /// Number of computed base pitches.
        pitches: u32,
    },
    /// The steps of the motion exceed the memory of a solve.
    MotionTooLarge {
        /// The memory of the steps.
        bytes: usize,
        /// The computed part of the motion, from 0 to 1.
        done: f64,
    },
    /// The number of pairs that may touch exceeds the limit of a set.
    TooManyPairs {
        /// Pairs.
        pairs: usize,
        /// Greatest number of pairs.
        limit: usize,
    },
    /// The search for the required tip relief exceeds its budget of work.
    SearchTooLong {
        /// Number of tested motions or balances.
        tries: u32,
        /// Whether motions were tested.
        in_motion: bool,
        /// The greatest tested additional tip relief with contact, in m.
        touching: Option<f64>,
        /// The least greater relief without contact, in m.
        clear: Option<f64>,
    },
    /// The force curve needs more stations than are computed.
    CurveTooRough {
        /// Number of places.
        limit: usize,
    },
    /// No relief keeps the incoming tooth from touching before E.
    NoClearing {
        /// The greatest tested relief, in m.
        most: f64,
    },
    /// The user stopped the solve.
    Stopped,
    /// Eq. 55 leaves its range.
    HertzWidthTooLarge {
        /// Half-width, in m.
        half_width: f64,
        /// Half-width at which q_H is 0, in m.
        limit: f64,
    },
}

impl std::error::Error for Refusal {}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.row().sentence)
    }
}

/// The words of a refusal.
struct Row {
    code: &'static str,
    at: Member,
    sentence: String,
    fix: &'static str,
}

impl Refusal {
    /// The refusal for the driven gear. A refusal of one gear names the driver.
    pub(super) fn at_driven(mut self) -> Refusal {
        if let Refusal::TipInsideBase { gear, .. }
        | Refusal::PointedRack { gear, .. }
        | Refusal::RoundingInsideBase { gear, .. }
        | Refusal::RoundingTooWide { gear, .. }
        | Refusal::PointedTip { gear, .. }
        | Refusal::CutThrough { gear, .. }
        | Refusal::BelowFormCircle { gear, .. } = &mut self
        {
            *gear = GearSide::Driven;
        }
        self
    }

    /// A stop as an error, any other refusal as a result.
    ///
    /// # Errors
    /// [`Refusal::Stopped`].
    pub fn unless_stopped<T>(found: Result<T, Refusal>) -> Result<Result<T, Refusal>, Refusal> {
        match found {
            Err(Refusal::Stopped) => Err(Refusal::Stopped),
            found => Ok(found),
        }
    }

    /// A short name for scripts.
    pub fn code(&self) -> &'static str {
        self.row().code
    }

    /// The member of the inputs where the fix begins.
    pub fn at(&self) -> Member {
        self.row().at
    }

    /// How to fix the input.
    pub fn fix(&self) -> &'static str {
        self.row().fix
    }

    #[expect(clippy::too_many_lines, reason = "one row per refusal")]
    fn row(&self) -> Row {
        const BEAM: &str = "set model.tooth_compliance to beam, or leave it out";
        let mm = |length: f64| format!("{:.4} mm", length / 1e-3);
        let of = |gear: GearSide, name| (Some(gear), name);
        let driver = |name| (Some(GearSide::Driver), name);
        let driven = |name| (Some(GearSide::Driven), name);
        let pair = |name| (None, name);
        let (code, at, sentence, fix) = match *self {
            Refusal::Interference { start } => (
                "interference",
                driven("addendum"),
                format!(
                    "interference at the start of contact: N1E, from the driver's base circle to \
                        E, is {} and must be above 0",
                    mm(start)
                ),
                "shorten the driven addendum, give the driver more teeth or profile shift, or \
                    increase a given centre distance",
            ),
            Refusal::NoPath { start, end, is_distance_given, cut } => {
                let (at, fix) = match cut {
                    Some(cut) => {
                        (cut, "give smaller tip chamfers or tip radii, or bring the gears closer")
                    }
                    None if is_distance_given => (
                        pair("centre_distance"),
                        "give a smaller centre distance, or leave it out",
                    ),
                    None => {
                        (driven("addendum"), "lengthen the addenda, or bring the gears closer")
                    }
                };
                let (start, end) = (mm(start), mm(end));
                let sentence = format!(
                    "the tips do not reach each other: on the line of action, B is {end} from the \
                        driver's base circle and must be beyond E, {start}"
                );
                ("no-path", at, sentence, fix)
            }
            Refusal::TipInsideBase { gear, is_cut, tip, base } => (
                "tip-inside-base",
                of(gear, if is_cut { "tip_chamfer" } else { "addendum" }),
                format!(
                    "the tip is inside the base circle: its radius is {} and must be above {}",
                    mm(tip),
                    mm(base)
                ),
                "give a higher addendum or a smaller tip chamfer",
            ),
            Refusal::ReliefTooLarge { gear, is_at_tip, relief, half } => (
                "relief-too-large",
                of(gear, if is_at_tip { "tip_relief" } else { "root_relief" }),
                format!(
                    "the relief of {} leaves nothing of the tooth: half its thickness at the base \
                        circle is {}",
                    mm(relief),
                    mm(half)
                ),
                "give a smaller relief, usually below 0.02 modules",
            ),
            Refusal::PointedRack { gear, dedendum, limit } => (
                "pointed-rack",
                of(gear, "dedendum"),
                format!(
                    "the cutting rack is pointed: the dedendum is {dedendum} and must be below \
                        {limit:.4} for this pressure angle"
                ),
                "give a smaller dedendum or pressure angle",
            ),
            Refusal::CentreDistanceJams { distance, least } => (
                "centre-distance-jams",
                pair("centre_distance"),
                format!(
                    "the centre distance jams the mesh: it is {} and must be above rb1 + rb2 = {}",
                    mm(distance),
                    mm(least)
                ),
                "give a greater centre distance, or leave it out",
            ),
            Refusal::ShiftsLeaveNoMesh { sum } => (
                "no-mesh",
                driver("profile_shift"),
                format!(
                    "no mesh without backlash exists: x1 + x2 is {sum:.4}, too far below 0 for \
                        these tooth numbers"
                ),
                "give a greater sum of profile shifts",
            ),
            Refusal::ContactRatioBelowOne { ratio, is_deflection_taken, cut } => (
                "contact-ratio-below-1",
                cut.unwrap_or(driven("addendum")),
                format!(
                    "the contact ratio is {ratio:.4} and must be above 1 to compute the deflection \
                        at F"
                ),
                match (cut, is_deflection_taken) {
                    (Some(_), true) => {
                        "give smaller tip chamfers or tip radii, or give model.deflection"
                    }
                    (Some(_), false) => {
                        "give smaller tip chamfers or tip radii; only paper and exact use a given \
                            deflection"
                    }
                    (None, true) => {
                        "lengthen the addenda or bring the gears closer, or give model.deflection"
                    }
                    (None, false) => {
                        "lengthen the addenda or bring the gears closer; only paper and exact use \
                            a given deflection"
                    }
                },
            ),
            Refusal::TotalContactRatioBelowOne { ratio } => (
                "total-contact-ratio-below-1",
                pair("helix_angle"),
                format!("the total contact ratio is {ratio:.4} and must be at least 1"),
                "widen the faces, or give a greater helix angle or longer addenda",
            ),
            Refusal::EndReliefsOverlap { gear, length, width } => (
                "end-reliefs-overlap",
                of(gear, "end_relief_length"),
                format!(
                    "the end reliefs are {} long together, more than the face width {}",
                    mm(length),
                    mm(width)
                ),
                "give a shorter length of the end reliefs",
            ),
            Refusal::TooFewSlices { slices, least } => (
                "too-few-slices",
                pair("slices"),
                format!("{slices} slices are too few for this overlap ratio, which needs {least}"),
                "give more slices, or leave them out",
            ),
            Refusal::NotOverFace { method } => (
                "not-over-face",
                pair("method"),
                format!(
                    "the method {} has no force for a pair whose contact begins at a point of the \
                        face: a helical, misaligned or crowned pair",
                    method.name()
                ),
                "set model.method to static or dynamic",
            ),
            Refusal::BackFlanksOverFace => (
                "back-flanks-over-face",
                pair("backlash"),
                "the driver reaches the back flanks, whose load over the face width has no model"
                    .to_owned(),
                "leave out the backlash for a motion on the working flanks, or use model.method = \"static\"",
            ),
            Refusal::BoreTooLarge { gear, bore, circle, limit } => (
                "bore-too-large",
                of(gear, "bore_radius"),
                format!(
                    "the bore radius is {} and must be below the {circle} circle's {}",
                    mm(bore),
                    mm(limit)
                ),
                "give a smaller bore radius",
            ),
            Refusal::NoFirstContact { deviation } => (
                "no-first-contact",
                pair("base_pitch"),
                format!(
                    "no first contact: the tip cannot close a gap of {:.4} um",
                    deviation / MICROMETRE
                ),
                "give a smaller deviation or deflection, or lower the load",
            ),
            Refusal::RoundingInsideBase { gear, radius, limit } => (
                "tip-radius-inside-base",
                of(gear, "tip_radius"),
                format!(
                    "the tip radius is {} and must be below {}: the centre of the rounding must be \
                        outside the base circle",
                    mm(radius),
                    mm(limit)
                ),
                "give a smaller tip radius, a smaller tip chamfer or a higher addendum",
            ),
            Refusal::RoundingTooWide { gear, radius, lack } => (
                "tip-radius-too-large",
                of(gear, "tip_radius"),
                format!(
                    "the tip radius is {} and the tip is {} too thin for it",
                    mm(radius),
                    mm(2.0 * lack)
                ),
                "give a smaller tip radius",
            ),
            Refusal::RoundingBreaksContact { cut, ratio } => (
                "tip-radius-breaks-contact",
                cut,
                format!(
                    "the shortened tips leave a contact ratio of {ratio:.4}, and it must not be \
                        below 1 with rounded tips"
                ),
                "give smaller tip radii or tip chamfers, or lengthen the addenda",
            ),
            Refusal::BeyondRounding { arm } => (
                "beyond-tip-rounding",
                pair("base_pitch"),
                format!(
                    "D is beyond the rounding of the driven tip: rb2' is {} and must not be below 0",
                    mm(arm)
                ),
                "give a smaller deviation or deflection, or a smaller tip radius",
            ),
            Refusal::BeyondDriverTip { radius, tip } => (
                "beyond-driver-tip",
                pair("base_pitch"),
                format!(
                    "D is beyond the end of the driver's involute: O1D is {} and the involute ends \
                        at {}",
                    mm(radius),
                    mm(tip)
                ),
                "give a smaller deviation or deflection, or lower the load",
            ),
            Refusal::TeethOutsideFit { teeth, range: (least, most) } => (
                "teeth-outside-fit",
                pair("tooth_compliance"),
                format!(
                    "tooth number outside the Kuang-Yang fit: z is {} and must be \
                        {least}..{most}",
                    tidy(teeth, 4)
                ),
                BEAM,
            ),
            Refusal::ShiftOutsideFit { shift, limit } => (
                "shift-outside-fit",
                pair("tooth_compliance"),
                format!(
                    "profile shift outside the Kuang-Yang fit: x is {shift} and must be \
                        -{limit}..{limit}"
                ),
                BEAM,
            ),
            Refusal::HeightOutsideFit { height } => (
                "height-outside-fit",
                pair("tooth_compliance"),
                format!(
                    "load point outside the Kuang-Yang fit: (r_x - r)/((1+x) m) is {height:.4}, \
                        where the fit's stiffness is not above 0"
                ),
                "choose another tooth compliance, or a shorter addendum",
            ),
            Refusal::PointedTip { gear, thickness } => (
                "pointed-tip",
                of(gear, "addendum"),
                format!(
                    "pointed tip: the tooth's thickness at the load point is {} and must be above 0",
                    mm(thickness)
                ),
                "give a shorter addendum, less profile shift or more teeth",
            ),
            Refusal::CutThrough { gear, shift } => (
                "cut-through",
                of(gear, "profile_shift"),
                format!(
                    "the undercut cuts the tooth through: its profile shift is {shift} and must be \
                        greater for so few teeth"
                ),
                "give more profile shift or more teeth",
            ),
            Refusal::BelowFormCircle { gear, radius, form } => (
                "below-form-circle",
                of(gear.other(), "addendum"),
                format!(
                    "the involute of the {} ends above the contact: the contact is at the \
                        radius {} and the form circle at {}",
                    if gear == GearSide::Driver { "driver" } else { "driven gear" },
                    mm(radius),
                    mm(form)
                ),
                "shorten this addendum, or change the profile shifts or a given centre distance",
            ),
            Refusal::NoField { teeth, reason } => (
                "no-field",
                pair("tooth_compliance"),
                format!("no finite elements for the gear with {} teeth: {reason}",
                    tidy(teeth, 4)),
                BEAM,
            ),
            Refusal::InterferenceAtEnd { start } => (
                "interference-at-end",
                driver("addendum"),
                format!(
                    "interference at the end of contact: N2B, from the driven base circle to B, is {} \
                        and must be above 0",
                    mm(start)
                ),
                "shorten the driver's addendum, or give the driven gear more teeth or more profile \
                    shift",
            ),
            Refusal::BeyondReach => (
                "beyond-reach",
                pair("power"),
                "the teeth cannot carry the load: the pairs deflect further than their flanks reach"
                    .to_owned(),
                "lower the load, widen the gears or give a smaller deviation",
            ),
            Refusal::IndefiniteCompliance => (
                "indefinite-compliance",
                pair("tooth_compliance"),
                "no load sharing: the compliance matrix is not positive definite (a force \
                    displaces a neighbouring tooth more than the loaded tooth)"
                    .to_owned(),
                "choose the tooth compliance `beam`, in which each tooth deflects alone",
            ),
            Refusal::FrictionLocks { friction, limit } => (
                "friction-locks",
                pair("friction_coefficient"),
                format!(
                    "the friction locks the gears: the coefficient is {friction} and must be below \
                        {limit:.4}, r_b1 over the greatest arm"
                ),
                "give a smaller friction coefficient, or leave it out",
            ),
            Refusal::TooSlow { swings, limit } => (
                "too-slow",
                pair("method"),
                format!(
                    "too slow for method dynamic: the mesh oscillates {swings:.2e} times while a \
                        tooth passes, and the limit is {limit:.0e}"
                ),
                "set model.method to static: at this speed the pairs share the load as at rest",
            ),
            Refusal::NotConverged => (
                "unsettled",
                pair("damping_ratio"),
                "the motion does not settle: the teeth touch and separate without end".to_owned(),
                "give a greater damping ratio, or set model.method to static",
            ),
            Refusal::MotionTooLong { steps, done } => (
                "motion-too-long",
                pair("warmup_cycles"),
                format!(
                    "the motion needs too many steps: the limit of {steps} steps covers {} of the \
                        motion",
                    percent(done)
                ),
                "give fewer warm-up cycles or a greater damping ratio, or set model.method to \
                    static",
            ),
            Refusal::NoSteadyMotion { pitches } => (
                "no-steady-motion",
                pair("damping_ratio"),
                format!(
                    "no steady motion: after {pitches} base pitches the motion does not repeat"
                ),
                "give a greater damping ratio or another speed",
            ),
            Refusal::MotionTooLarge { bytes, done } => (
                "motion-too-large",
                pair("speed"),
                format!(
                    "the speed is too low to compute the motion: the steps of a mesh exceed the \
                        memory of a solve, {} MB, after {} of the motion",
                    bytes / 1_000_000,
                    percent(done)
                ),
                "give a higher speed, or set model.method to static: at this speed the pairs share \
                    the load nearly as at rest",
            ),
            Refusal::TooManyPairs { pairs, limit } => (
                "too-many-pairs",
                pair("module"),
                format!("{pairs} tooth pairs may touch at a time, and the limit is {limit}"),
                "give smaller deviations, a greater module or fewer teeth",
            ),
            Refusal::SearchTooLong { tries, in_motion, touching, clear } => (
                "clearing-relief-not-found",
                pair("warmup_cycles"),
                format!(
                    "the search stopped after {tries} {}: {}",
                    if in_motion { "motions" } else { "balances" },
                    bracket(touching, clear)
                ),
                "give fewer warm-up cycles, a greater damping ratio or a looser tolerance",
            ),
            Refusal::CurveTooRough { limit } => (
                "curve-too-rough",
                pair("station_tolerance"),
                format!(
                    "the force curve bends too often: it is computed in {limit} places, the limit, \
                        and needs more"
                ),
                "give a greater station tolerance",
            ),
            Refusal::NoClearing { most } => (
                "no-clearing-relief",
                pair("damping_ratio"),
                format!(
                    "the tooth touches before E even with {:.4} um more tip relief of the driven \
                        gear",
                    most / MICROMETRE
                ),
                "give a greater damping ratio, a smaller deviation or another speed",
            ),
            Refusal::Stopped => (
                "stopped",
                pair("method"),
                "stopped before the end".to_owned(),
                "start it again",
            ),
            Refusal::HertzWidthTooLarge { half_width, limit } => (
                "hertz-width",
                driver("face_width"),
                format!(
                    "the Hertz half-width is not small against the tooth: it is {}, and the \
                        contact formula ends at {}",
                    mm(half_width),
                    mm(limit)
                ),
                "lower the load or the speed, or widen the gears",
            ),
        };
        Row { code, at, sentence, fix }
    }
}

/// Words of the bracket of the additional tip relief, in m: the greatest value with contact and the
/// least value without.
fn bracket(touching: Option<f64>, clear: Option<f64>) -> String {
    let micrometres = |relief: f64| significant(relief / MICROMETRE, 8);
    let with = match touching {
        None => return "no additional tip relief was tried to its end".to_owned(),
        Some(0.0) => "the given tip relief of the driven gear".to_owned(),
        Some(more) => format!("{} um more tip relief of the driven gear", micrometres(more)),
    };
    let without = clear.map(|more| format!(", and not with {} um more", micrometres(more)));
    format!("the tooth touches before E with {with}{}", without.unwrap_or_default())
}

/// A part of an unfinished motion in percent, always below 100 %.
fn percent(done: f64) -> String {
    format!("{:.2} %", (1e4 * done).floor().min(9999.0) / 100.0)
}

/// Range of Poisson's ratio.
pub(super) const POISSON: (f64, f64) = (0.0, 0.49);

/// The reason why a gear has no field.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum FieldRefusal {
    /// The flanks meet at or below the tip circle.
    #[error("pointed tip: the tooth's thickness there is {} mm and must be at least {} mm", millimetres(*.thickness), millimetres(*.least))]
    PointedTip {
        /// Thickness at the tip circle, in m.
        thickness: f64,
        /// Least thickness, in m.
        least: f64,
    },
    /// The undercut leaves nearly no neck below the tooth.
    #[error("undercut tooth: its neck is {} mm thick and must be at least {} mm", millimetres(*.thickness), millimetres(*.least))]
    CutThrough {
        /// Least thickness of the fillet, in m.
        thickness: f64,
        /// Least thickness, in m.
        least: f64,
    },
    /// The cutting rack's flanks meet above its tip.
    #[error("no space between the teeth: its width at the root circle is {} mm", millimetres(*.width))]
    NoSpace {
        /// Width of the space at the root circle, in m, below 0.
        width: f64,
    },
    /// Nearly no involute is left between fillet and tip.
    #[error("short flank: its involute is {} mm long and must be at least {} mm", millimetres(*.length), millimetres(*.least))]
    ShortFlank {
        /// Arc length of the involute, in m.
        length: f64,
        /// Least length, in m.
        least: f64,
    },
    /// The rim is too thin for the elements.
    #[error("thin rim: it is {} mm thick and must be at least {} mm", millimetres(*.thickness), millimetres(*.least))]
    ThinRim {
        /// r_f − r_h, in m.
        thickness: f64,
        /// Least thickness, in m.
        least: f64,
    },
    /// Plane strain is impossible with this Poisson's ratio.
    #[error("Poisson's ratio is {poisson} and must be between 0 and {}", POISSON.1)]
    Poisson {
        /// ν.
        poisson: f64,
    },
    /// The outline of the tooth folds the mesh.
    #[error("the mesh folds on this outline: element {element} of {count}")]
    FoldedMesh {
        /// Number of the element.
        element: usize,
        /// Number of elements.
        count: usize,
    },
    /// Rounding errors make the stiffness matrix indefinite.
    #[error("the stiffness matrix is not positive definite with {unknowns} unknowns")]
    NotPositive {
        /// Unknowns.
        unknowns: usize,
    },
}

fn millimetres(length: f64) -> String {
    significant(length / 1e-3, 4)
}
