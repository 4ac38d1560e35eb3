//! Code, field and fix of each refusal.

use super::refusal::Refusal;

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
