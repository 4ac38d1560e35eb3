//! Tooth compliance by the fit of Kuang and Yang.

use std::ops::RangeInclusive;

use super::{Kind, NEWTON_PER_MICRON_MILLIMETRE, StiffnessLine, ToothModel};
use crate::model::Refusal;
use crate::model::compliance::ElasticGear;
use crate::model::explanation::Formula::Text;
use crate::model::explanation::{Context, Finding, Step, four, step};
use crate::model::geometry::{Circles, Geometry};
use crate::model::inputs::{Gear, Inputs, ToothCompliance};

/// The entry of the list.
pub const MODEL: ToothModel = ToothModel {
    name: "kuang-yang",
    index: "fit",
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
    tooth: |gear, circles| Ok(Kind::Line(tooth(gear, circles)?)),
};

/// The steps q, c and d of a gear by its number, its name, the load and its member of the inputs.
macro_rules! steps {
    ($n:literal, $name:literal, $load:literal, $gear:ident) => {
        [
            step(
                concat!("q_", $n),
                concat!($load, ", Kuang & Yang 1992"),
                "um mm/N",
                Text(concat!(
                    "1/(c_",
                    $n,
                    " + d_",
                    $n,
                    " (O",
                    $n,
                    "D - r_",
                    $n,
                    ")/((1 + x",
                    $n,
                    ") m))"
                )),
                |k| Some(k.solution.compliance?.$gear),
            ),
            step(
                concat!("c_", $n),
                concat!("A_0 + A_1 x of the ", $name),
                "N/(um mm)",
                Text(concat!(
                    "(3.867 + 1.612 z",
                    $n,
                    " - 0.02916 z",
                    $n,
                    "² + 0.0001553 z",
                    $n,
                    "³ + (17.060 + 0.7289 z",
                    $n,
                    " - 0.01728 z",
                    $n,
                    "² + 0.0000999 z",
                    $n,
                    "³) x",
                    $n,
                    ") [N/(um mm)]"
                )),
                |k| Some(fit(&k.inputs.$gear)[0]),
            ),
            step(
                concat!("d_", $n),
                concat!("A_2 + A_3 x of the ", $name),
                "N/(um mm)",
                Text(concat!(
                    "(2.637 - 1.222 z",
                    $n,
                    " + 0.02217 z",
                    $n,
                    "² - 0.0001179 z",
                    $n,
                    "³ + (-6.330 - 1.033 z",
                    $n,
                    " + 0.02068 z",
                    $n,
                    "² - 0.0001130 z",
                    $n,
                    "³) x",
                    $n,
                    ") [N/(um mm)]"
                )),
                |k| Some(fit(&k.inputs.$gear)[1]),
            ),
        ]
    };
}

impl ToothCompliance {
    /// Kuang & Yang 1992, Eq. 56.
    pub const KUANG_YANG: ToothCompliance = ToothCompliance::named(MODEL.name);
}

const DRIVER: [Step; 3] = steps!("1", "driver", "driver's tooth loaded at O1D", driver);
const DRIVEN: [Step; 3] = steps!("2", "driven gear", "driven tooth loaded at its tip", driven);
const STEPS: &[Step] = &[DRIVER[0], DRIVEN[0], DRIVER[1], DRIVER[2], DRIVEN[1], DRIVEN[2]];

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
            && ADDENDUM.contains(&inputs.addendum_of(gear))
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
        four(inputs.addendum_of(driver)),
        four(inputs.addendum_of(driven)),
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
    if !(f64::from(least)..=f64::from(most)).contains(&gear.teeth) {
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
    line(gear.teeth.into(), gear.profile_shift).map(|part| NEWTON_PER_MICRON_MILLIMETRE * part)
}

/// Offset and slope of the fit over the height, in N/(µm mm).
fn line(teeth: f64, shift: f64) -> [f64; 2] {
    let [a0, a1, a2, a3] = coefficients(teeth);
    [a0 + a1 * shift, a2 + a3 * shift]
}

/// The coefficients A_0 to A_3 of the fit, in N/(µm mm).
fn coefficients(teeth: f64) -> [f64; 4] {
    const A: [[f64; 4]; 4] = [
        [3.867, 1.612, -0.02916, 0.0001553],
        [17.060, 0.7289, -0.01728, 0.0000999],
        [2.637, -1.222, 0.02217, -0.0001179],
        [-6.330, -1.033, 0.02068, -0.0001130],
    ];
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
