//! Tooth compliance by the fit of Kuang and Yang.

use std::ops::RangeInclusive;

use super::{Compliance, NEWTON_PER_MICRON_MILLIMETRE, StiffnessLine, ToothModel};
use crate::model::Refusal;
use crate::model::compliance::ElasticGear;
use crate::model::explanation::Formula::Text;
use crate::model::explanation::{Context, Finding, Step, four};
use crate::model::geometry::{Circles, Geometry};
use crate::model::inputs::{Gear, Inputs, ToothCompliance};

/// The entry of the list.
pub const MODEL: ToothModel = ToothModel {
    name: "kuang-yang",
    index: "fit",
    help: "Eq. 56, for z 12..100, |x| <= 0.6, 20 deg full-depth steel",
    range: RANGE,
    covers,
    why_outside: |_| format!("the pair is outside the range of `kuang-yang`, {RANGE}"),
    check,
    outside,
    chosen: "tooth-compliance-kuang-yang",
    reads_root: false,
    has_contact: false,
    has_coupling: false,
    steps: STEPS,
    compliance: Compliance::Line(tooth),
};

impl ToothCompliance {
    /// Kuang & Yang 1992, Eq. 56.
    pub const KUANG_YANG: ToothCompliance = ToothCompliance::named(MODEL.name);
}

#[rustfmt::skip]
const STEPS: &[Step] = &[
    Step {
        symbol: "q_1",
        meaning: "driver's tooth loaded at O1D, Kuang & Yang 1992",
        unit: "um mm/N",
        formula: Text("1/(c_1 + d_1 (O1D - r_1)/((1 + x1) m))"),
        value: |k| Some(k.solution.compliance?.driver),
    },
    Step {
        symbol: "q_2",
        meaning: "driven tooth loaded at its tip, Kuang & Yang 1992",
        unit: "um mm/N",
        formula: Text("1/(c_2 + d_2 (O2D - r_2)/((1 + x2) m))"),
        value: |k| Some(k.solution.compliance?.driven),
    },
    Step {
        symbol: "c_1",
        meaning: "A_0 + A_1 x of the driver",
        unit: "N/(um mm)",
        formula: Text("(3.867 + 1.612 z1 - 0.02916 z1² + 0.0001553 z1³ + (17.060 + 0.7289 z1 - \
            0.01728 z1² + 0.0000999 z1³) x1) [N/(um mm)]"),
        value: |k| Some(fit(&k.inputs.driver)[0]),
    },
    Step {
        symbol: "d_1",
        meaning: "A_2 + A_3 x of the driver",
        unit: "N/(um mm)",
        formula: Text("(2.637 - 1.222 z1 + 0.02217 z1² - 0.0001179 z1³ + (-6.330 - 1.033 z1 + \
            0.02068 z1² - 0.0001130 z1³) x1) [N/(um mm)]"),
        value: |k| Some(fit(&k.inputs.driver)[1]),
    },
    Step {
        symbol: "c_2",
        meaning: "A_0 + A_1 x of the driven gear",
        unit: "N/(um mm)",
        formula: Text("(3.867 + 1.612 z2 - 0.02916 z2² + 0.0001553 z2³ + (17.060 + 0.7289 z2 - \
            0.01728 z2² + 0.0000999 z2³) x2) [N/(um mm)]"),
        value: |k| Some(fit(&k.inputs.driven)[0]),
    },
    Step {
        symbol: "d_2",
        meaning: "A_2 + A_3 x of the driven gear",
        unit: "N/(um mm)",
        formula: Text("(2.637 - 1.222 z2 + 0.02217 z2² - 0.0001179 z2³ + (-6.330 - 1.033 z2 + \
            0.02068 z2² - 0.0001130 z2³) x2) [N/(um mm)]"),
        value: |k| Some(fit(&k.inputs.driven)[1]),
    },
];

/// Tooth numbers that the fit of Eq. 56 covers.
const TEETH: (u32, u32) = (12, 100);
/// Greatest absolute profile shift that the fit of Eq. 56 covers.
const SHIFT: f64 = 0.6;

/// The range of the fit as text.
const RANGE: &str = "z 12..100, |x| <= 0.6, 20 deg full-depth steel teeth";

/// Whether both gears are in the range of the fit: tooth number, profile shift, 20° full depth,
/// steel.
fn covers(inputs: &Inputs) -> bool {
    const PRESSURE_ANGLE_DEGREES: f64 = 20.0;
    const ADDENDUM: RangeInclusive<f64> = 0.9..=1.1;
    const YOUNG: RangeInclusive<f64> = 190e9..=220e9;
    let covered = |gear: &Gear| {
        (TEETH.0..=TEETH.1).contains(&gear.teeth)
            && gear.profile_shift.abs() <= SHIFT
            && ADDENDUM.contains(&gear.addendum_coefficient(inputs.module))
            && YOUNG.contains(&gear.young)
    };
    let standard_angle = (inputs.pressure_angle.to_degrees() - PRESSURE_ANGLE_DEGREES).abs() < 1e-6;
    standard_angle && covered(&inputs.driver) && covered(&inputs.driven)
}

fn check(context: &Context) -> Option<Finding> {
    let (inputs, degrees) = (context.inputs, context.inputs.pressure_angle.to_degrees());
    let (driver, driven) = (&inputs.driver, &inputs.driven);
    let here = format!(
        "z {} and {}, x {} and {}, {} deg, ha* {} and {}, E {} and {} GPa",
        driver.teeth,
        driven.teeth,
        driver.profile_shift,
        driven.profile_shift,
        four(degrees),
        four(driver.addendum_coefficient(inputs.module)),
        four(driven.addendum_coefficient(inputs.module)),
        four(driver.young * 1e-9),
        four(driven.young * 1e-9)
    );
    Finding::new(format!("fit of Eq. 56: {RANGE}"), here, covers(inputs))
}

fn outside(inputs: &Inputs, _: &Geometry) -> Option<(&'static str, String)> {
    (!covers(inputs)).then(|| {
        let name = MODEL.name;
        ("outside-fit", format!("the tooth compliance `{name}` is used outside its fit, {RANGE}"))
    })
}

/// Stiffness of one tooth over the radius of the load.
///
/// # Formula
/// ```text
/// 1/q = (A0 + A1 x) + (A2 + A3 x)(radius − r)/((1 + x) m),   A_k cubic in z, in N/(µm mm)
/// ```
///
/// # Source
/// Kuang & Yang 1992; Zhou & Chen 2014, Eq. 56. Contact excluded.
///
/// # Valid for
/// z = 12..100, |x| ≤ 0.6, 20° full-depth steel teeth. The cubic polynomials in z grow fast outside
/// this range.
///
/// # Errors
/// [`Refusal::TeethOutsideFit`], [`Refusal::ShiftOutsideFit`]. The result refuses heights with a
/// stiffness that is not above 0.
pub fn tooth(gear: &ElasticGear, circles: &Circles) -> Result<StiffnessLine, Refusal> {
    let (gear, (least, most)) = (&gear.rack, TEETH);
    if !(least..=most).contains(&gear.teeth) {
        return Err(Refusal::TeethOutsideFit { teeth: gear.teeth, range: TEETH });
    }
    let shift = gear.profile_shift;
    if shift.abs() > SHIFT {
        return Err(Refusal::ShiftOutsideFit { shift, limit: SHIFT });
    }
    let [at_reference, per_height] = line(gear.teeth, shift);
    Ok(StiffnessLine {
        at_reference,
        per_height,
        reference: circles.reference,
        height: (1.0 + shift) * gear.module,
    })
}

/// Offset and slope of the fit over the height, in Pa.
fn fit(gear: &Gear) -> [f64; 2] {
    line(gear.teeth, gear.profile_shift).map(|part| NEWTON_PER_MICRON_MILLIMETRE * part)
}

/// Offset and slope of the fit over the height, in N/(µm mm).
fn line(teeth: u32, shift: f64) -> [f64; 2] {
    let [a0, a1, a2, a3] = coefficients(teeth);
    [a0 + a1 * shift, a2 + a3 * shift]
}

/// The coefficients A_0 to A_3 of the fit, in N/(µm mm).
fn coefficients(teeth: u32) -> [f64; 4] {
    const A: [[f64; 4]; 4] = [
        [3.867, 1.612, -0.02916, 0.0001553],
        [17.060, 0.7289, -0.01728, 0.0000999],
        [2.637, -1.222, 0.02217, -0.0001179],
        [-6.330, -1.033, 0.02068, -0.0001130],
    ];
    let teeth = f64::from(teeth);
    A.map(|[c0, c1, c2, c3]| c0 + teeth * (c1 + teeth * (c2 + teeth * c3)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    #[test]
    fn a_height_without_stiffness_is_refused() {
        let inputs = standard_pair(59, 15, 5e-3);
        let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
        let gear = inputs.elasticity().driver;
        let line = tooth(&gear, &circles).unwrap();
        assert!(line.compliance(circles.tip).is_ok());
        let high = line.compliance(circles.reference + 5.0 * inputs.module);
        assert!(matches!(high, Err(Refusal::HeightOutsideFit { .. })), "{high:?}");
    }
}
