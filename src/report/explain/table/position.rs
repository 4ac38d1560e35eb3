//! Explanations of the first contact D and the velocities there.

use super::Explanation;
use crate::model::inputs::Method;
use crate::report::explain::context::Formula::{By, Solved, Text};
use crate::report::explain::valid::{impact, pair, position};

const TIP: &str = "The driven gear's tip edge meets the driver's involute; both turn at their steady speeds up to D.";

pub(super) static TABLE: &[Explanation] = &[
    Explanation {
        key: "approach_angle_driver",
        says: "How far the driver has still to turn from the first touch D to E, where contact should begin.",
        formula: By(|k| match k.inputs.method {
            Method::Paper => Text("ε_e + ε_d"),
            _ => Text("i u"),
        }),
        source: "Zhou & Chen 2014, Eqs. 11-20. Method exact: the contact condition S(u) = Δ of the two involutes (see \
            approach_angle_driven), and Eq. 11.",
        mended: &["Eqs. 7-20", "Eq. 14", "Eqs. 16, 20"],
        assumes: TIP,
        valid: &[position::gap_closed, position::on_flank],
    },
    Explanation {
        key: "approach_angle_driven",
        says: "How far the driven gear has still to turn from the first touch D to E. S(u) is the gap between its tip and the \
            driver's flank, along the contact normal, that Δ has to close.",
        formula: By(|k| match k.inputs.method {
            Method::Paper => Text("θ_1/i"),
            _ => Solved {
                equation: "S(u) = Δ,  S(u) = Δρ_1 + r_b2 u - r_b1 Δχ",
                left: "Δρ_1 + r_b2 u - r_b1 Δχ",
                right: "Δ",
                unit: "um",
            },
        }),
        source: "Zhou & Chen 2014, Eq. 11. Method exact: the contact condition of the tip's path and the driver's involute, solved \
            by Newton's method; dS/du = r_b2 - r_b2', so that u grows as √Δ.",
        mended: &["Eqs. 7-20", "Eq. 14", "Eqs. 16, 20"],
        assumes: TIP,
        valid: &[pair::start, position::gap_closed, position::on_flank],
    },
    Explanation {
        key: "contact_radius_driver",
        says: "Where on the driver's flank the tip strikes: near its root, where the flank is curved most.",
        formula: Text("√(r_a2² + a² - 2 a r_a2 cos η)"),
        source: "Zhou & Chen 2014, Eqs. 7-10, with a for r_1 + r_2.",
        mended: &["Eqs. 7-20"],
        assumes: TIP,
        valid: &[position::on_flank, position::gap_closed],
    },
    Explanation {
        key: "contact_normal_radius_driven",
        says: "Distance from O2 to the contact normal at D: the driven gear's arm there, r_b2 at E. What it falls short of r_b2 \
            makes the approach velocity.",
        formula: Text("a cos χ - r_b1"),
        source: "Zhou & Chen 2014, Eqs. 24-28, 48 and 49, in closed form.",
        mended: &["Eqs. 27, 42, 60"],
        assumes: TIP,
        valid: &[position::gap_closed],
    },
    Explanation {
        key: "curvature_radius",
        says: "Reduced radius of curvature of flank and tip at D: what the width of their contact and its stress grow with.",
        formula: Text("ρ_1 ρ_2/(ρ_1 + ρ_2)"),
        source: "Zhou & Chen 2014, below Eq. 32.",
        mended: &[],
        assumes: "The tip is taken with its own flank's curvature, or with the radius of its edge where the case gives one. A sharp \
            edge presses far harder than either tells.",
        valid: &[position::edge],
    },
    Explanation {
        key: "closed_gap",
        says: "The gap between tip and flank that has closed at D: Δ where the position is exact, and the measure of what the \
            printed position misses.",
        formula: Text("Δρ_1 + r_b2 u - r_b1 Δχ"),
        source: "Contact condition S(u) = Δ: the involutes' normal distance, as the integral of dS/du = r_b2 - r_b2' (Zhou & Chen 2014 \
            have no such equation).",
        mended: &["Eqs. 7-20"],
        assumes: TIP,
        valid: &[position::gap_closed],
    },
    Explanation {
        key: "transit_time",
        says: "Time from the first touch D to E. An impact that lasts longer runs on into the normal mesh.",
        formula: Text("u/ω_2"),
        source: "Kinematics, u/ω2.",
        mended: &["Eqs. 7-20"],
        assumes: "Constant speed.",
        valid: &[impact::within_approach],
    },
    Explanation {
        key: "normal_velocity",
        says: "How fast the tip comes up to the flank at D, along the contact normal: the velocity that strikes. It is 0 at E.",
        formula: Text("ω_2 (r_b2 - r_b2')"),
        source: "Zhou & Chen 2014, Eqs. 21, 23-28; the same as ω_1 r_b1 - ω_2 r_b2'.",
        mended: &["Eqs. 27, 42, 60", "Eqs. 7-20"],
        assumes: TIP,
        valid: &[position::gap_closed],
    },
    Explanation {
        key: "sliding_velocity",
        says: "How fast the tip slides along the flank at D; above 0 it slides towards the driver's root.",
        formula: Text("ω_2 N2'D - ω_1 ρ_1"),
        source: "Zhou & Chen 2014, Eqs. 22-28.",
        mended: &["Eq. 22", "Eqs. 27, 42, 60"],
        assumes: TIP,
        valid: &[position::gap_closed, position::keeps_sliding],
    },
];
