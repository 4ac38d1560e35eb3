//! Rows of the motion: load sharing with inertia, mesh frequency and natural frequency.

use super::at_rest::{FIRST_OF_SLICES, first_contact_of};
use super::{Need, PLAIN, Quantity, Variant, checks, conditions, of_driver};
use crate::model::Solution;
use crate::model::Stage::{Dynamic, Resonance, SpeedRun, Static};
use crate::model::explanation::Formula::{Found, Text};
use crate::model::explanation::{Check, Context, Finding, Formula, Step, four, step};
use crate::model::speeds::SpeedCurve;

const OSCILLATOR_ALONE: &str = "One mass m_red moves on the springs and gaps of all pairs, with damping \
            while a pair is in contact. Shafts are rigid, and the load is steady. Only \
            the incoming pair has a deviation, e = Δf_0. With finite-element \
            compliance the force on a pair displaces the pairs up to three pitches \
            away.";
const MOTION: &str = "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988, m x'' + \
            c x' + ΣF = F0, with the gap S(u) of the tips off the line of action. \
            Integration by Taylor series from contact event to contact event.";
const RATTLE: &str = "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988: the back \
            flanks touch where −x − j_bn − S_m > 0, x negative where the driver falls \
            behind. j_bn is the normal backlash of ISO 21771 along the line of action; \
            circumferential backlash on the working pitch circle is j_wt = j_bn/cos \
            α_w.";
pub(super) const AT_BACK: &str = "Symmetric teeth, with the same reliefs on both flanks: the back flanks \
            have gap, stiffness and coupling of the working flanks, mirrored and with \
            their own phase. No back flank deviates. A tooth loaded on both flanks has \
            no coupling between them.";
const CHECKS: &[Check] = &[checks::teeth, checks::forgotten, checks::contact_kept];
const BY_MOTION: Formula = Found(
    "taken from the motion m_red x'' + c x' + Σ w_k F_k − Σ w_m B_m = F_0, F_k \
            >= 0 with x + e_k - S_k = Σ_j Q_kj F_j/b where F_k > 0, which starts at \
            the static balance model.warmup_cycles base pitches before E",
    &["m_red", "c", "f_n", "f_z"],
);

/// A result of the motion.
const IN_MOTION: Quantity = Quantity {
    equation: "m x'' + ΣF = F0",
    stage: Dynamic,
    source: MOTION,
    assumptions: OSCILLATOR_ALONE,
    checks: CHECKS,
    ..PLAIN
};

/// A result of the back flanks.
const BACK: Quantity = Quantity {
    stage: Dynamic,
    source: RATTLE,
    assumptions: AT_BACK,
    checks: &[checks::teeth, checks::forgotten],
    needs: Need::Backlash,
    ..PLAIN
};

/// A result of the mean stiffness.
const RESONANCE: Quantity = Quantity {
    equation: "ISO by k_m",
    stage: Resonance,
    source: ISO,
    assumptions: RIGID,
    checks: &[checks::teeth],
    ..PLAIN
};

pub(super) const TABLE: &[Quantity] = &[
    IN_MOTION
        .row(
            ["dynamic_first_contact_angle_driver", "θ_d", "dynamic: driver angle before E"],
            ("rad", "deg", 4),
            |s| Some(of_driver(s, first_contact_of::<true>(s)?)),
            "The angle of the driver before E at which the incoming tooth first touches \
                in motion.",
            Text("i u_d"),
        )
        .signed()
        .variants(&[FIRST_OF_SLICES])
        .corrections(&["Eqs. 7-20"]),
    IN_MOTION
        .row(
            ["dynamic_first_contact_angle", "u_d", "dynamic: driven angle before E"],
            ("rad", "deg", 4),
            first_contact_of::<true>,
            "The angle of the driven gear before E at which the incoming tooth first \
            touches in motion.",
            BY_MOTION,
        )
        .signed()
        .variants(&[FIRST_OF_SLICES])
        .corrections(&["Eqs. 7-20"]),
    IN_MOTION
        .row(
            ["dynamic_peak_approach_force", "F_d,DE", "dynamic: peak before E"],
            ("N", "N", 5),
            |s| Some(s.dynamic.as_ref()?.peak_approach_force),
            "The peak force on the incoming tooth before E, in the corner contact: the \
            impact force by the motion of the whole mesh.",
            BY_MOTION,
        )
        .corrections(&["Eqs. 7-20", "Eq. 54"]),
    IN_MOTION
        .row(
            ["dynamic_peak_force", "F_d,max", "dynamic: peak force"],
            ("N", "N", 5),
            |s| Some(s.dynamic.as_ref()?.peak_force),
            "The peak force on the incoming tooth from its first contact to its last: \
            the load on its root and its flank. Well below the resonances it is the greater of two \
            peaks: the one at the entry rises with the base pitch deviation; the one after the \
            pair ahead has left falls, because a tooth that comes earlier has already taken over \
            more of the load. A better class can therefore have a greater peak.",
            BY_MOTION,
        )
        .corrections(&["Eq. 54"])
        .variants(&[Variant::meaning(
            conditions::driven_rounded,
            " At E the contact passes from the tip radius to the flank: the stiffness \
                of the pair rises in one step, and with it the force at any speed. In a \
                real pair it rises while the contact moves by its own width, so that the \
                model overstates the peak at low speed.",
        )]),
    IN_MOTION
        .row(
            ["dynamic_impact_duration", "T_d", "dynamic: impact duration"],
            ("s", "us", 4),
            |s| s.dynamic.as_ref()?.impact_duration,
            "The time from a first contact before E to the first valley of the force after \
            its first peak, or to the loss of contact if that is earlier. A fall of less than a \
            hundredth of the peak force is no valley.",
            BY_MOTION,
        )
        .corrections(&["Eq. 32"]),
    IN_MOTION
        .row(
            ["dynamic_last_contact_angle", "θ_d,B", "dynamic: exit angle"],
            ("rad", "deg", 4),
            |s| s.dynamic.as_ref()?.last_contact_angle,
            "The angle of the driver after B at the last contact of the incoming tooth \
            in motion.",
            BY_MOTION,
        )
        .at_exit(),
    IN_MOTION
        .row(
            ["dynamic_contact_lost", "lost", "dynamic: contact lost"],
            ("1", "yes/no", 1),
            |s| Some(f64::from(u8::from(s.dynamic.as_ref()?.contact_lost))),
            "Whether no pair touches at some moment. The gears then rattle and strike \
            again.",
            BY_MOTION,
        )
        .source(
            "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988: no pair \
            touches at some moment from one base pitch before E to the last contact of \
            the tooth.",
        )
        .checks(&[checks::teeth, checks::forgotten]),
    BACK.row(
        ["dynamic_back_strikes", "n_d,b", "dynamic: back strikes"],
        ("1", "1", 4),
        |s| Some(f64::from(s.dynamic.as_ref()?.rattle?.strikes)),
        "How often the back flanks strike across the backlash, from one base pitch \
                before E until the incoming tooth leaves.",
        BY_MOTION,
    )
    .equation("back flanks touch"),
    BACK.row(
        ["dynamic_peak_back_force", "B_d,max", "dynamic: back flank peak"],
        ("N", "N", 5),
        |s| Some(s.dynamic.as_ref()?.rattle?.force),
        "The greatest force max B on a pair of back flanks, from one base pitch \
            before E until the incoming tooth leaves.",
        BY_MOTION,
    )
    .equation("max B"),
    IN_MOTION
        .row(
            ["dynamic_friction_work", "W_μ", "dynamic: friction work"],
            ("J", "J", 5),
            |s| s.dynamic.as_ref()?.friction_work,
            "The work of the friction on the incoming tooth from its first contact to \
            its last, with the μ of the case.",
            BY_MOTION,
        )
        .equation("∫μ F |v| dt")
        .source(
            "Coulomb friction along the motion, ∫μ F |v| dt with the sliding velocity v \
            of the pair, after Özgüven & Houser 1988.",
        )
        .corrections(&["Eq. 64"])
        .needs(Need::Friction),
    PLAIN
        .row(
            ["mesh_frequency", "f_z", "mesh frequency"],
            ("Hz", "Hz", 5),
            |s| Some(s.resonance?.mesh_frequency),
            "The number of tooth pairs that enter the mesh per second. A pair whines at \
            this frequency and at its multiples.",
            Text("z1 ω_1/(2 π)"),
        )
        .equation("z1 n1")
        .stage(Resonance)
        .source("Kinematics of the pair: z1 n1 tooth pairs per second.")
        .assumptions("Constant speed."),
    RESONANCE.row(
        ["natural_frequency", "f_n", "natural frequency"],
        ("Hz", "Hz", 5),
        |s| Some(s.resonance?.natural_frequency),
        "The natural frequency of the two gears on the mean stiffness of the mesh.",
        Text("√(k_m/m_red)/(2 π)"),
    ),
    RESONANCE
        .row(
            ["resonance_ratio", "N", "resonance ratio"],
            ("1", "1", 4),
            |s| Some(s.resonance?.ratio()),
            "The mesh frequency over the natural frequency. By the mean stiffness the \
            pair is in resonance at N = 1, and its second and third mesh harmonics at \
            N = 1/2 and 1/3. ISO 6336-1 calls N up to 0.85 subcritical (from 100 N per \
            mm of width on), up to 1.15 the main resonance, up to 1.5 intermediate, \
            and above it supercritical.",
            Text("f_z/f_n"),
        )
        .checks(&[checks::teeth, subcritical]),
    RESONANCE.row(
        ["resonance_speed", "n_E", "speed of N = 1"],
        ("rad/s", "rpm", 5),
        |s| Some(s.resonance?.natural_frequency * s.geometry.base_pitch / s.geometry.driver.base),
        "The critical speed of the driver, at which the mesh frequency equals the natural \
            frequency of the mean stiffness, N = 1. The motion peaks at another speed: \
            see resonance_peak_speed.",
        Text("2 π f_n/z1"),
    ),
    RISING[0],
    RISING[1],
    FALLING[0],
    FALLING[1],
    NEAR_HALF,
    NEAR_THIRD,
];

/// The peak force over that at rest.
pub(super) const PEAK_RATIO: Quantity = IN_MOTION
    .row(
        ["peak_force_ratio", "F_d/F_st", "peak force ratio"],
        ("1", "1", 4),
        |s| {
            let ratio = s.dynamic.as_ref()?.peak_force / s.static_load.as_ref()?.peak_force;
            // A tooth that never touches has no ratio.
            (!ratio.is_nan()).then_some(ratio)
        },
        "The peak force on the incoming tooth in motion over that at rest.",
        Text("F_d,max/F_st,max"),
    )
    .equation("F_d/F_st")
    .source("The ratio F_d/F_st of the peak forces in motion and at rest, both by this program.")
    .also(Static);

fn stiffness(k: &Context) -> Option<f64> {
    Some(k.solution.mesh.as_ref()?.mean_stiffness())
}

pub(super) const STEPS: &[Step] = &[step(
    "c",
    "damping of the mesh while a pair is in contact",
    "N s/m",
    Text("2 ζ √(k_m m_red)"),
    |k| Some(2.0 * k.inputs.damping_ratio * (stiffness(k)? * k.solution.reduced_mass).sqrt()),
)];

const ISO: &str = "ISO 6336-1:2019, 6.5: resonance ratio N = n1/n_E1 with n_E1 = 30 000 \
            √(c_γ/m_red)/(π z1), here with the mean stiffness k_m of the model in \
            place of c_γ.";

const RIGID: &str = "One mass m_red on the mean stiffness of the mesh; shafts, bearings and \
            masses beside the gears are left out.";

const OVER_SPEED: &str = "Steady motion at each of 121 speeds from N = 0.1 to 1.6 or more, as in \
            tooth_force_factor, at the torque of the case; each motion starts from \
            that at the speed before. Speed and factor are those of the computed speed \
            with the greatest factor, which is sought in eighths of the steps.";

/// The rows of the greatest peak over the speed: key, symbol and label of its speed and of its factor,
/// the direction in words, and the point of the curve.
macro_rules! peak {
    (
        $speed:literal, $speed_symbol:literal, $factor:literal, $factor_symbol:literal,
        $way:literal, $point:ident
    ) => {
        [
            PEAK.row(
                [$speed, $speed_symbol, concat!("peak speed, ", $way)],
                ("rad/s", "rpm", 5),
                |s| Some(over_speed(s)?.$point()?.speed),
                concat!(
                    "The speed of the driver with the greatest dynamic factor of a tooth, with ",
                    $way,
                    " speed. It differs from the speed of N = 1, because the stiffness changes over \
                        a base pitch and contact can be lost."
                ),
                Found("the speed of the greatest max F/max F_st over the speeds", STEADY),
            ),
            PEAK.row(
                [$factor, $factor_symbol, concat!("peak factor, ", $way)],
                ("1", "1", 4),
                |s| Some(over_speed(s)?.$point()?.tooth_factor),
                concat!(
                    "The greatest dynamic factor of a tooth over the speed, with ",
                    $way,
                    " speed: the greatest force of a tooth in the steady motion over that at rest, \
                        without base pitch deviations."
                ),
                Found("the greatest max F/max F_st over the speeds", STEADY),
            ),
        ]
    };
}

/// A result of the steady motion over the speed.
const PEAK: Quantity = Quantity {
    equation: "max over speed",
    stage: SpeedRun,
    source: OSCILLATOR,
    assumptions: OVER_SPEED,
    checks: &[checks::teeth],
    ..PLAIN
};

const RISING: [Quantity; 2] =
    peak!("resonance_peak_speed", "n_pk", "resonance_peak_factor", "K_pk", "rising", peak_rising);
const FALLING: [Quantity; 2] = peak!(
    "resonance_peak_speed_falling",
    "n_pk,f",
    "resonance_peak_factor_falling",
    "K_pk,f",
    "falling",
    peak_falling
);

/// The row of the peak at a fraction of the resonance: key and symbol, N in words and as a number,
/// and the harmonic that is there in resonance.
macro_rules! peak_near {
    ($key:literal, $symbol:literal, $ratio:literal, $of:expr, $harmonic:literal) => {
        PEAK.row(
            [$key, $symbol, concat!("peak factor near N = ", $ratio)],
            ("1", "1", 4),
            |s| Some(over_speed(s)?.peak_near($of)?.tooth_factor),
            concat!(
                "The peak of the dynamic factor of a tooth near N = ",
                $ratio,
                ", with rising speed: the ",
                $harmonic,
                " harmonic of the mesh frequency is near the natural frequency."
            ),
            Found("the greatest peak of max F/max F_st with N less than 0.18 of it away", STEADY),
        )
    };
}

const NEAR_HALF: Quantity =
    peak_near!("resonance_factor_half", "K_pk,1/2", "1/2", 1.0 / 2.0, "second");
const NEAR_THIRD: Quantity =
    peak_near!("resonance_factor_third", "K_pk,1/3", "1/3", 1.0 / 3.0, "third");

const STEADY: &[&str] = &["m_red", "f_n", "F_0"];

const OSCILLATOR: &str = "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988; steady \
            motion with more than one base pitch per period and jumps between rising \
            and falling speed: Kahraman & Singh 1990. The greatest factor is the max \
            over speed.";

fn over_speed(solution: &Solution) -> Option<&SpeedCurve> {
    solution.over_speed.as_ref()?.as_deref().ok()
}

/// The speed is below the main resonance.
fn subcritical(k: &Context) -> Option<Finding> {
    const RESONANCE: f64 = 0.85;
    let ratio = k.solution.resonance?.ratio();
    Finding::new(
        "N <= 0.85: below the main resonance of ISO 6336-1, at 100 N/mm and more",
        format!("N = {}", four(ratio)),
        ratio <= RESONANCE,
    )
}
