//! Limits of the model: refusals with their values, messages, codes and fixes.

use std::fmt;

use thiserror::Error;

use crate::numeric::decimal::significant;

const MILLIMETRE: f64 = 1e-3;
const MICROMETRE: f64 = 1e-6;

/// The reason why a pair, or some of its quantities, cannot be computed.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum Refusal {
    /// The driven tip would touch the driver below its base circle.
    #[error("interference at the start of contact: N1E is {:.4} mm and must be above 0", .start / MILLIMETRE)]
    Interference {
        /// N₁E, in m.
        start: f64,
    },
    /// The path of contact ends before it starts.
    #[error("the tips do not reach each other: N1B is {:.4} mm and must be above N1E, {:.4} mm", .end / MILLIMETRE, .start / MILLIMETRE)]
    NoPath {
        /// N₁E, in m.
        start: f64,
        /// N₁B, in m.
        end: f64,
        /// Whether the case gives the centre distance.
        is_distance_given: bool,
        /// The key of the tip chamfer or tip radius that removes the greatest part of the path, if
        /// whole tips reach each other.
        cut: Option<&'static str>,
    },
    /// The tip has no involute.
    #[error("the tip is inside the base circle: its radius is {:.4} mm and must be above {:.4} mm", .tip / MILLIMETRE, .base / MILLIMETRE)]
    TipInsideBase {
        /// The key of the field where the fix begins.
        field: &'static str,
        /// r_a, in m.
        tip: f64,
        /// r_b, in m.
        base: f64,
    },
    /// A relief removes a whole tooth.
    #[error("the relief of {:.4} mm leaves nothing of the tooth: half its thickness at the base circle is {:.4} mm", .relief / MILLIMETRE, .half / MILLIMETRE)]
    ReliefTooLarge {
        /// The key of the relief.
        field: &'static str,
        /// The relief, in m.
        relief: f64,
        /// Half the thickness of the tooth at the base circle, in m.
        half: f64,
    },
    /// The cutting rack's flanks meet above its tip.
    #[error(
        "the cutting rack is pointed: the dedendum is {dedendum} and must be below {limit:.4} for \
            this pressure angle"
    )]
    PointedRack {
        /// The key of the field where the fix begins.
        field: &'static str,
        /// h_fP*.
        dedendum: f64,
        /// π/(4 tan α).
        limit: f64,
    },
    /// The base circles overlap.
    #[error(
        "the centre distance jams the mesh: it is {:.4} mm and must be above rb1 + rb2 = {:.4} \
            mm", .distance / MILLIMETRE, .least / MILLIMETRE)]
    CentreDistanceJams {
        /// a, in m.
        distance: f64,
        /// r_b1 + r_b2, in m.
        least: f64,
    },
    /// No centre distance without backlash exists.
    #[error(
        "no mesh without backlash exists: x1 + x2 is {sum:.4}, too far below 0 for these tooth \
            numbers"
    )]
    ShiftsLeaveNoMesh {
        /// x₁ + x₂.
        sum: f64,
    },
    /// No pair is in contact when the next pair starts contact.
    #[error("the contact ratio is {ratio:.4} and must be above 1 to compute the deflection at F")]
    ContactRatioBelowOne {
        /// ε.
        ratio: f64,
        /// Whether the method accepts a given deflection.
        is_deflection_taken: bool,
        /// The key of the tip chamfer or tip radius that removes the greatest part of the path, if
        /// whole tips have a greater contact ratio than 1.
        cut: Option<&'static str>,
    },
    /// The bore leaves no gear body.
    #[error("the bore radius is {:.4} mm and must be below the {circle} circle's {:.4} mm", .bore / MILLIMETRE, .limit / MILLIMETRE)]
    BoreTooLarge {
        /// The key of the gear's bore radius.
        field: &'static str,
        /// r_h, in m.
        bore: f64,
        /// The circle that limits the bore.
        circle: &'static str,
        /// The radius of that circle, in m.
        limit: f64,
    },
    /// S(u) = Δ has no solution on the driver's flank.
    #[error("no first contact: the tip cannot close a gap of {:.4} um", .deviation / MICROMETRE)]
    NoFirstContact {
        /// Δ, in m.
        deviation: f64,
    },
    /// The centre of the tip's rounding is inside the base circle.
    #[error(
        "the tip radius is {:.4} mm and must be below {:.4} mm: the centre of the rounding must be \
            outside the base circle", .radius / MILLIMETRE, .limit / MILLIMETRE)]
    RoundingInsideBase {
        /// The key of the gear's tip radius.
        field: &'static str,
        /// r_e, in m.
        radius: f64,
        /// r_a − r_b, in m.
        limit: f64,
    },
    /// The tooth is too thin for the rounding of its tip.
    #[error("the tip radius is {:.4} mm and the tip is {:.4} mm too thin for it", .radius / MILLIMETRE, 2.0 * .lack / MILLIMETRE)]
    RoundingTooWide {
        /// The key of the gear's tip radius.
        field: &'static str,
        /// r_e, in m.
        radius: f64,
        /// Missing half thickness of the tooth, on the base circle, in m.
        lack: f64,
    },
    /// Rounded tips leave a path of contact shorter than a base pitch.
    #[error(
        "the shortened tips leave a contact ratio of {ratio:.4}, and it must not be below 1 with \
            rounded tips"
    )]
    RoundingBreaksContact {
        /// The key of the tip chamfer or tip radius that removes the greatest part of the path.
        field: &'static str,
        /// ε.
        ratio: f64,
    },
    /// The contact is beyond the arc of the rounded tip.
    #[error("D is beyond the rounding of the driven tip: rb2' is {:.4} mm and must not be below 0", .arm / MILLIMETRE)]
    BeyondRounding {
        /// r_b2', in m.
        arm: f64,
    },
    /// The driver's flank ends before D.
    #[error(
        "D is beyond the end of the driver's involute: O1D is {:.4} mm and the involute ends at \
            {:.4} mm", .radius / MILLIMETRE, .tip / MILLIMETRE)]
    BeyondDriverTip {
        /// O₁D, in m.
        radius: f64,
        /// Radius at which the driver's involute ends, in m.
        tip: f64,
    },
    /// Eq. 56 does not cover the tooth number.
    #[error("tooth number outside the Kuang-Yang fit: z is {teeth} and must be {}..{}", range.0, range.1)]
    TeethOutsideFit {
        /// z.
        teeth: u32,
        /// Least and greatest z of the fit.
        range: (u32, u32),
    },
    /// Eq. 56 does not cover the profile shift.
    #[error("profile shift outside the Kuang-Yang fit: x is {shift} and must be -{limit}..{limit}")]
    ShiftOutsideFit {
        /// x.
        shift: f64,
        /// Greatest |x| of the fit.
        limit: f64,
    },
    /// Eq. 56 gives no positive stiffness at this height of the tooth.
    #[error(
        "load point outside the Kuang-Yang fit: (r_x - r)/((1+x) m) is {height:.4}, where the \
            fit's stiffness is not above 0"
    )]
    HeightOutsideFit {
        /// (r_x − r)/((1 + x) m).
        height: f64,
    },
    /// The tooth has no thickness at the load point.
    #[error("pointed tip: the tooth's thickness at the load point is {:.4} mm and must be above 0", .thickness / MILLIMETRE)]
    PointedTip {
        /// The key of the field where the fix begins.
        field: &'static str,
        /// Thickness, in m.
        thickness: f64,
    },
    /// The undercut leaves no neck below the tooth.
    #[error(
        "the undercut cuts the tooth through: its profile shift is {shift} and must be greater for \
            so few teeth"
    )]
    CutThrough {
        /// The key of the field where the fix begins.
        field: &'static str,
        /// x.
        shift: f64,
    },
    /// The load point is on the fillet, outside the involute.
    #[error("the flank ends above the contact: the contact is at the radius {:.4} mm and the form circle at {:.4} mm", .radius / MILLIMETRE, .form / MILLIMETRE)]
    BelowFormCircle {
        /// The key of the field where the fix begins.
        field: &'static str,
        /// Radius of the load point, in m.
        radius: f64,
        /// Radius of the form circle, in m.
        form: f64,
    },
    /// The gear has no elastic field.
    #[error("no finite elements for the gear with {teeth} teeth: {reason}")]
    NoField {
        /// z.
        teeth: u32,
        /// The reason.
        reason: FieldRefusal,
    },
    /// The driver's tip would touch the driven gear below its base circle.
    #[error("interference at the end of contact: N2B is {:.4} mm and must be above 0", .start / MILLIMETRE)]
    InterferenceAtEnd {
        /// N₂B, in m.
        start: f64,
    },
    /// The deflection of the pairs is so large that a tip would leave the other flank.
    #[error("the teeth cannot carry the load: the pairs deflect further than their flanks reach")]
    BeyondReach,
    /// The compliances of neighbouring pairs are inconsistent.
    #[error(
        "no load sharing: the compliance matrix is not positive definite (a force displaces a \
            neighbouring tooth more than the loaded tooth)"
    )]
    IndefiniteCompliance,
    /// Friction locks the gears.
    #[error(
        "the friction locks the gears: the coefficient is {friction} and must be below {limit:.4}, \
            r_b1 over the greatest arm"
    )]
    FrictionLocks {
        /// μ.
        friction: f64,
        /// The least coefficient that locks the gears.
        limit: f64,
    },
    /// The mesh oscillates too often while a tooth passes.
    #[error(
        "too slow for method dynamic: the mesh oscillates {swings:.2e} times while a tooth passes, \
            and the limit is {limit:.0e}"
    )]
    TooSlow {
        /// Oscillations of the mesh.
        swings: f64,
        /// Greatest number of oscillations.
        limit: f64,
    },
    /// The series of the motion is not finite.
    #[error("the motion does not settle: the teeth touch and separate without end")]
    NotConverged,
    /// The motion exceeds its budget of work.
    #[error(
        "the motion needs too many steps: the limit of {steps} steps covers {} of the motion", percent(*.done)
    )]
    MotionTooLong {
        /// Steps.
        steps: u64,
        /// The computed part of the motion, from 0 to 1.
        done: f64,
    },
    /// The motion does not become periodic.
    #[error("no steady motion: after {pitches} base pitches the motion does not repeat")]
    NoSteadyMotion {
        /// Number of computed base pitches.
        pitches: u32,
    },
    /// The steps of the motion exceed the memory of a solve.
    #[error(
        "the speed is too low to compute the motion: the steps of a mesh exceed the memory of a \
            solve, {} MB, after {} of the motion", .bytes / 1_000_000, percent(*.done)
    )]
    MotionTooLarge {
        /// The memory of the steps.
        bytes: usize,
        /// The computed part of the motion, from 0 to 1.
        done: f64,
    },
    /// The number of pairs that may touch exceeds the limit of a set.
    #[error("{pairs} tooth pairs may touch at a time, and the limit is {limit}")]
    TooManyPairs {
        /// Pairs.
        pairs: usize,
        /// Greatest number of pairs.
        limit: usize,
    },
    /// The search for the required tip relief exceeds its budget of work.
    #[error("the search stopped after {tries} {}: {}", if *.in_motion { "motions" } else { "balances" }, Bracket(*.touching, *.clear))]
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
    #[error(
        "the force curve bends too often: it is computed in {limit} places, the limit, and needs \
            more"
    )]
    CurveTooRough {
        /// Number of places.
        limit: usize,
    },
    /// No relief keeps the incoming tooth from touching before E.
    #[error("the tooth touches before E even with {:.4} um more tip relief of the driven gear", .most / MICROMETRE)]
    NoClearing {
        /// The greatest tested relief, in m.
        most: f64,
    },
    /// The user stopped the solve.
    #[error("stopped before the end")]
    Stopped,
    /// Eq. 55 leaves its range.
    #[error(
        "the Hertz half-width is not small against the tooth: it is {:.4} mm, and the contact \
            formula ends at {:.4} mm", .half_width / MILLIMETRE, .limit / MILLIMETRE)]
    HertzWidthTooLarge {
        /// Half-width, in m.
        half_width: f64,
        /// Half-width at which q_H is 0, in m.
        limit: f64,
    },
}

impl Refusal {
    /// The refusal for the driven gear. A refusal of one gear names the field of the driver.
    pub(super) fn at_driven(mut self) -> Refusal {
        match &mut self {
            Refusal::RoundingInsideBase { field, .. } | Refusal::RoundingTooWide { field, .. } => {
                *field = "driven.tip_radius";
            }
            Refusal::TipInsideBase { field, .. } if field.ends_with("tip_chamfer") => {
                *field = "driven.tip_chamfer";
            }
            Refusal::TipInsideBase { field, .. } | Refusal::PointedTip { field, .. } => {
                *field = "driven.addendum";
            }
            Refusal::PointedRack { field, .. } => *field = "driven.dedendum",
            Refusal::CutThrough { field, .. } => *field = "driven.profile_shift",
            Refusal::BelowFormCircle { field, .. } => *field = "driver.addendum",
            _ => (),
        }
        self
    }
}

/// Digits that distinguish any two numbers.
const MOST_DIGITS: usize = 17;

/// Bracket of the additional tip relief, in m: the greatest value with contact and the least value
/// without.
struct Bracket(Option<f64>, Option<f64>);

impl fmt::Display for Bracket {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(touching) = self.0 else {
            return f.write_str("no additional tip relief was tried to its end");
        };
        f.write_str("the tooth touches before E with ")?;
        let shown = |digits| {
            let shown = |relief: f64| significant(relief / MICROMETRE, digits);
            (shown(touching), self.1.map(shown))
        };
        // Uses enough digits to distinguish the ends of a narrow bracket.
        let (touching_shown, clear) = (4..MOST_DIGITS)
            .map(shown)
            .find(|(touching, clear)| clear.as_ref() != Some(touching))
            .unwrap_or_else(|| shown(MOST_DIGITS));
        if touching > 0.0 {
            let touching = touching_shown;
            write!(f, "{touching} um more tip relief of the driven gear")?;
        } else {
            f.write_str("the given tip relief of the driven gear")?;
        }
        clear.map_or(Ok(()), |clear| write!(f, ", and not with {clear} um more"))
    }
}

/// A part of an unfinished motion in percent, always below 100 %.
fn percent(done: f64) -> String {
    format!("{:.2} %", (1e4 * done).floor().min(9999.0) / 100.0)
}

/// The code of a refusal, the field where its fix begins, and the fix.
struct Remedy {
    code: &'static str,
    field: &'static str,
    fix: &'static str,
}

impl Refusal {
    /// A short name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.remedy().code
    }

    /// The key of the field where the fix begins.
    #[must_use]
    pub fn field(&self) -> &'static str {
        self.remedy().field
    }

    /// How to fix the input.
    #[must_use]
    pub fn fix(&self) -> &'static str {
        self.remedy().fix
    }

    #[expect(clippy::too_many_lines, reason = "one row per refusal")]
    fn remedy(&self) -> Remedy {
        let (code, field, fix) = match self {
            Refusal::Interference { .. } => (
                "interference",
                "driven.addendum",
                "shorten the driven addendum, or give the driver more teeth or more profile shift",
            ),
            Refusal::NoPath { cut: Some(field), .. } => (
                "no-path",
                *field,
                "give smaller tip chamfers or tip radii, or bring the gears closer",
            ),
            Refusal::NoPath { is_distance_given: true, .. } => (
                "no-path",
                "pair.centre_distance",
                "give a smaller centre distance, or leave it out",
            ),
            Refusal::NoPath { .. } => {
                ("no-path", "driven.addendum", "lengthen the addenda, or bring the gears closer")
            }
            Refusal::TipInsideBase { field, .. } => {
                ("tip-inside-base", *field, "give a higher addendum or a smaller tip chamfer")
            }
            Refusal::ReliefTooLarge { field, .. } => {
                ("relief-too-large", *field, "give a smaller relief, usually below 0.02 modules")
            }
            Refusal::PointedRack { field, .. } => {
                ("pointed-rack", *field, "give a smaller dedendum or pressure angle")
            }
            Refusal::CentreDistanceJams { .. } => (
                "centre-distance-jams",
                "pair.centre_distance",
                "give a greater centre distance, or leave it out",
            ),
            Refusal::ShiftsLeaveNoMesh { .. } => {
                ("no-mesh", "driver.profile_shift", "give a greater sum of profile shifts")
            }
            Refusal::ContactRatioBelowOne { is_deflection_taken, cut: Some(field), .. } => (
                "contact-ratio-below-1",
                *field,
                if *is_deflection_taken {
                    "give smaller tip chamfers or tip radii, or give model.deflection"
                } else {
                    "give smaller tip chamfers or tip radii; only paper and exact use a given \
                        deflection"
                },
            ),
            Refusal::ContactRatioBelowOne { is_deflection_taken, .. } => (
                "contact-ratio-below-1",
                "driven.addendum",
                if *is_deflection_taken {
                    "lengthen the addenda or bring the gears closer, or give model.deflection"
                } else {
                    "lengthen the addenda or bring the gears closer; only paper and exact use a \
                        given deflection"
                },
            ),
            Refusal::BoreTooLarge { field, .. } => {
                ("bore-too-large", *field, "give a smaller bore radius")
            }
            Refusal::NoFirstContact { .. } => (
                "no-first-contact",
                "deviations.base_pitch",
                "give a smaller deviation or deflection, or lower the load",
            ),
            Refusal::RoundingInsideBase { field, .. } => (
                "tip-radius-inside-base",
                *field,
                "give a smaller tip radius, a smaller tip chamfer or a higher addendum",
            ),
            Refusal::RoundingTooWide { field, .. } => {
                ("tip-radius-too-large", *field, "give a smaller tip radius")
            }
            Refusal::RoundingBreaksContact { field, .. } => (
                "tip-radius-breaks-contact",
                *field,
                "give smaller tip radii or tip chamfers, or lengthen the addenda",
            ),
            Refusal::BeyondRounding { .. } => (
                "beyond-tip-rounding",
                "deviations.base_pitch",
                "give a smaller deviation or deflection, or a smaller tip radius",
            ),
            Refusal::BeyondDriverTip { .. } => (
                "beyond-driver-tip",
                "deviations.base_pitch",
                "give a smaller deviation or deflection, or lower the load",
            ),
            Refusal::TeethOutsideFit { .. } => (
                "teeth-outside-fit",
                "model.tooth_compliance",
                "set model.tooth_compliance to beam, or leave it out",
            ),
            Refusal::ShiftOutsideFit { .. } => (
                "shift-outside-fit",
                "model.tooth_compliance",
                "set model.tooth_compliance to beam, or leave it out",
            ),
            Refusal::HeightOutsideFit { .. } => (
                "height-outside-fit",
                "model.tooth_compliance",
                "choose another tooth compliance, or a shorter addendum",
            ),
            Refusal::PointedTip { field, .. } => {
                ("pointed-tip", *field, "give a shorter addendum, less profile shift or more teeth")
            }
            Refusal::CutThrough { field, .. } => {
                ("cut-through", *field, "give more profile shift or more teeth")
            }
            Refusal::BelowFormCircle { field, .. } => (
                "below-form-circle",
                *field,
                "shorten this addendum, or give the other gear more profile shift",
            ),
            Refusal::NoField { .. } => (
                "no-field",
                "model.tooth_compliance",
                "set model.tooth_compliance to beam, or leave it out",
            ),
            Refusal::InterferenceAtEnd { .. } => (
                "interference-at-end",
                "driver.addendum",
                "shorten the driver's addendum, or give the driven gear more teeth or more profile \
                    shift",
            ),
            Refusal::BeyondReach => (
                "beyond-reach",
                "operation.power",
                "lower the load, widen the gears or give a smaller deviation",
            ),
            Refusal::IndefiniteCompliance => (
                "indefinite-compliance",
                "model.tooth_compliance",
                "choose the tooth compliance `beam`, in which each tooth deflects alone",
            ),
            Refusal::FrictionLocks { .. } => (
                "friction-locks",
                "operation.friction_coefficient",
                "give a smaller friction coefficient, or leave it out",
            ),
            Refusal::TooSlow { .. } => (
                "too-slow",
                "model.method",
                "set model.method to static: at this speed the pairs share the load as at rest",
            ),
            Refusal::NotConverged => (
                "unsettled",
                "model.damping_ratio",
                "give a greater damping ratio, or set model.method to static",
            ),
            Refusal::MotionTooLong { .. } => (
                "motion-too-long",
                "model.warmup_cycles",
                "give fewer warm-up cycles or a greater damping ratio, or set model.method to \
                    static",
            ),
            Refusal::NoSteadyMotion { .. } => (
                "no-steady-motion",
                "model.damping_ratio",
                "give a greater damping ratio or another speed",
            ),
            Refusal::MotionTooLarge { .. } => (
                "motion-too-large",
                "operation.speed",
                "give a higher speed, or set model.method to static: at this speed the pairs share \
                    the load nearly as at rest",
            ),
            Refusal::TooManyPairs { .. } => (
                "too-many-pairs",
                "pair.module",
                "give smaller deviations, a greater module or fewer teeth",
            ),
            Refusal::SearchTooLong { .. } => (
                "clearing-relief-not-found",
                "model.warmup_cycles",
                "give fewer warm-up cycles, a greater damping ratio or a looser tolerance",
            ),
            Refusal::CurveTooRough { .. } => {
                ("curve-too-rough", "model.station_tolerance", "give a greater station tolerance")
            }
            Refusal::NoClearing { .. } => (
                "no-clearing-relief",
                "model.damping_ratio",
                "give a greater damping ratio, a smaller deviation or another speed",
            ),
            Refusal::Stopped => ("stopped", "model.method", "start it again"),
            Refusal::HertzWidthTooLarge { .. } => (
                "hertz-width",
                "driver.face_width",
                "lower the load or the speed, or widen the gears",
            ),
        };
        Remedy { code, field, fix }
    }
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
