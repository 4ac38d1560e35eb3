//! Rows of whine: harmonics of the transmission error and dynamic factors of a pair without base
//! pitch deviations.

use super::motion::AT_BACK;
use super::{Need, PLAIN, Quantity, checks};
use crate::model::Solution;
use crate::model::Stage::{StaticSpectrum, SteadyMotion};
use crate::model::dynamic::steady::Steady;
use crate::model::explanation::Formula::{self, Found};
use crate::model::explanation::{Check, Context, Finding};
use crate::model::static_load;

const AT_REST: &str = "All pairs share the mesh force at rest. No pair has a deviation, so the \
            transmission error repeats with every base pitch; the reliefs of all pairs \
            count.";
const IN_MOTION: &str = "One mass m_red moves on the springs and gaps of all pairs, with damping \
            while a pair is in contact. No pair has a deviation, and the motion has \
            become periodic: it repeats after one to four base pitches.";
const SPECTRUM: &str = "Fourier series 2 |c_n| and max x − min x of the transmission error over a \
            base pitch; transmission error as the cause of whine: Gregory, Harris & \
            Munro 1963. Each smooth piece is integrated by the 12-point Gauss-Legendre \
            rule.";
const MOTION: &str = "Oscillator of gear dynamics with backlash, Özgüven & Houser 1988; steady \
            motion with more than one base pitch per period: Kahraman & Singh 1990. \
            Over the period: Fourier series 2 |c_n|, max x − min x, max ΣF.";
const STEADY: &[&str] = &["m_red", "f_n", "f_z", "F_0"];
const CHECKS: &[Check] = &[checks::teeth, contact_kept];
const PERIODIC_AT_REST: Formula =
    Found("max x - min x over a base pitch, x by Σ w_k F_k = F_0", &["F_0", "k_m"]);
const PERIODIC: Formula =
    Found("max x - min x over the base pitches after which the motion repeats", STEADY);

/// A result of the steady motion.
const STEADY_MOTION: Quantity = Quantity {
    stage: SteadyMotion,
    source: MOTION,
    assumptions: IN_MOTION,
    checks: CHECKS,
    ..PLAIN
};

/// A result of the transmission error at rest.
const STATIC: Quantity = Quantity {
    stage: StaticSpectrum,
    source: SPECTRUM,
    assumptions: AT_REST,
    checks: &[checks::teeth],
    ..PLAIN
};

/// The rows of a harmonic at rest and in the steady motion: its order, the order in words, and its
/// frequency.
macro_rules! harmonic {
    ($order:literal, $word:literal, $frequency:literal) => {
        [
            harmonic!(
                $order,
                $word,
                $frequency,
                STATIC,
                at_rest,
                "static",
                "TE_st,",
                "at rest",
                Found(
                    concat!(
                        "2 |∫ x exp(-2 π i ",
                        $order,
                        " s/p_b) ds|/p_b over a base pitch, x by Σ w_k F_k = F_0"
                    ),
                    &["F_0", "k_m"],
                )
            ),
            harmonic!(
                $order,
                $word,
                $frequency,
                STEADY_MOTION,
                steady,
                "dynamic",
                "TE_d,",
                "in the steady motion",
                Found(
                    concat!(
                        "2 |∫ x exp(-2 π i ",
                        $order,
                        " f_z t) dt|/T over the period T of the steady motion"
                    ),
                    STEADY,
                )
            ),
        ]
    };
    ($order:literal, $word:literal, $frequency:literal, $row:ident, $of:ident, $method:literal, $symbol:literal, $when:literal, $formula:expr) => {
        $row.row(
            [
                concat!($method, "_te_harmonic_", $order),
                concat!($symbol, $order),
                concat!($method, ": TE harmonic ", $order),
            ],
            ("m", "um", 4),
            |s| Some($of(s)?.spectrum.amplitudes[$order - 1]),
            concat!(
                "The amplitude of the ",
                $word,
                " mesh harmonic of the transmission error ",
                $when,
                ", at ",
                $frequency,
                "."
            ),
            $formula,
        )
        .equation(concat!("2 |c_", $order, "|"))
    };
}

const HARMONICS: [[Quantity; 2]; 5] = [
    harmonic!(1, "first", "the mesh frequency"),
    harmonic!(2, "second", "2 times the mesh frequency"),
    harmonic!(3, "third", "3 times the mesh frequency"),
    harmonic!(4, "fourth", "4 times the mesh frequency"),
    harmonic!(5, "fifth", "5 times the mesh frequency"),
];

pub(super) const TABLE: &[Quantity] = &[
    STATIC
        .row(
            ["static_te_peak_to_peak", "TE_st,pp", "static: TE peak to peak"],
            ("m", "um", 5),
            |s| Some(at_rest(s)?.spectrum.peak_to_peak),
            "The difference between the largest and the smallest transmission error \
            over one base pitch at rest, of a pair in which no tooth deviates: the \
            static excitation of whine.",
            PERIODIC_AT_REST,
        )
        .equation("max − min, ideal"),
    HARMONICS[0][0],
    HARMONICS[1][0],
    HARMONICS[2][0],
    HARMONICS[3][0],
    HARMONICS[4][0],
    STEADY_MOTION
        .row(
            ["dynamic_te_peak_to_peak", "TE_d,pp", "dynamic: TE peak to peak"],
            ("m", "um", 5),
            |s| Some(steady(s)?.spectrum.peak_to_peak),
            "The difference between the largest and the smallest transmission error in \
            the steady motion of a pair in which no tooth deviates.",
            PERIODIC,
        )
        .equation("max − min, ideal"),
    HARMONICS[0][1],
    HARMONICS[1][1],
    HARMONICS[2][1],
    HARMONICS[3][1],
    HARMONICS[4][1],
    STEADY_MOTION
        .row(
            ["mesh_force_factor", "K_mesh", "mesh dynamic factor"],
            ("1", "1", 5),
            |s| Some(steady(s)?.mesh_force / s.mesh_force),
            "The greatest sum of the forces of all tooth pairs in the steady motion \
            over the mesh force, without deviations.",
            Found("max ΣF/F_0, ΣF over the base pitches after which the motion repeats", STEADY),
        )
        .equation("max ΣF/F0, ideal"),
    STEADY_MOTION
        .row(
            ["tooth_force_factor", "K_tooth", "tooth dynamic factor"],
            ("1", "1", 5),
            |s| Some(steady(s)?.tooth_force / at_rest(s)?.tooth_force),
            "The greatest force on a tooth in the steady motion over its greatest force \
                at rest, without deviations. K_v of ISO 6336-1 is of the whole mesh with \
                deviations; compare mesh_force_factor.",
            Found("max F_k in the steady motion over max F_k at rest", STEADY),
        )
        .equation("max F/F_st, ideal"),
    STEADY_MOTION
        .row(
            ["steady_contact_lost", "lost_z", "steady: contact lost"],
            ("1", "yes/no", 1),
            |s| Some(f64::from(u8::from(steady(s)?.contact_lost))),
            "Whether no pair touches at some moment of the steady motion of a pair \
            without deviations.",
            Found("from the steady motion", STEADY),
        )
        .equation("moment without contact")
        .checks(&[checks::teeth]),
    STEADY_MOTION
        .row(
            ["steady_back_strikes", "n_z,b", "steady: back strikes"],
            ("1", "1", 4),
            |s| {
                let steady = steady(s)?;
                Some(f64::from(steady.rattle?.strikes) / f64::from(steady.periods))
            },
            "The strikes of back flanks across the backlash per base pitch, in the \
                steady motion of a pair without deviations: rattle.",
            Found("counted over the base pitches after which the motion repeats", STEADY),
        )
        .equation("strikes per base pitch")
        .assumptions(AT_BACK)
        .needs(Need::Backlash),
    STEADY_MOTION
        .row(
            ["steady_back_force", "B_z,max", "steady: back flank peak"],
            ("N", "N", 5),
            |s| Some(steady(s)?.rattle?.force),
            "The greatest force max B on a pair of back flanks in the steady motion of \
            a pair without deviations.",
            Found("max B over the base pitches after which the motion repeats", STEADY),
        )
        .equation("max B")
        .assumptions(AT_BACK)
        .needs(Need::Backlash),
];

fn at_rest(solution: &Solution) -> Option<&static_load::StaticSpectrum> {
    solution.static_spectrum.as_ref()?.as_ref().ok()
}

fn steady(solution: &Solution) -> Option<&Steady> {
    solution.steady.as_ref()?.as_ref().ok()
}

fn contact_kept(k: &Context) -> Option<Finding> {
    let steady = steady(k.solution)?;
    let here = match (steady.contact_lost, steady.periods) {
        (false, 1) => "the teeth stay in contact".to_owned(),
        (true, 1) => "contact is lost at times".to_owned(),
        (true, periods) => {
            format!("contact is lost; the motion repeats after {periods} base pitches")
        }
        (false, periods) => format!("the motion repeats after {periods} base pitches"),
    };
    Finding::new(
        "the teeth stay in contact; where contact is lost, a run from another speed \
            may find another steady motion",
        here,
        !steady.contact_lost,
    )
}
