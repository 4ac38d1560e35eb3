//! Rows of the friction ratio and its limits.

use super::conditions::{always, driven_rounded, paper};
use super::{PLAIN, Quantity, Variant, checks};
use crate::model::Context;
use crate::model::Stage::{Friction, Impact, Velocity};
use crate::model::explanation::Formula::{Cases, Difference, Text};
use crate::model::explanation::{Step, step};

pub(super) const TABLE: &[Quantity] = &[
    PLAIN
        .row(
            ["friction_ratio", "f", "friction ratio"],
            ("1", "1", 4),
            |s| s.friction?.ratio,
            "The averaged impact friction coefficient of the paper: the change of the \
            sliding velocity over the change of the approach velocity from D to D', \
            the end of the impact. D' is ",
            Difference("|ΔV_τ' - ΔV_τ|/|ΔV_n' - ΔV_n|"),
        )
        .equation("Eq. 64")
        .stage(Friction)
        .source("Zhou & Chen 2014, Eqs. 29-45 and 61-64.")
        .corrections(&[
            "Eq. 31",
            "Eq. 34",
            "Eq. 36",
            "Eqs. 44, 45",
            "Eqs. 27, 42, 60",
            "Eq. 64",
            "section 6",
        ])
        .assumptions(
            "The velocities change mostly by the geometry. The ratio is not a material \
                property, and the Coulomb coefficient does not limit it.",
        )
        .checks(&[checks::coulomb, checks::before_start])
        .variants(&[
            Variant::meaning(
                paper,
                "the point at which the triangle of Eq. 34 closes, after the time T_S,32.",
            ),
            Variant::meaning(always, "the position of the same tip at u', after the time T_S,32."),
        ]),
    PLAIN
        .row(
            ["stick_limit", "μ_stick", "stick limit"],
            ("1", "1", 4),
            |s| Some(s.velocity?.stick_limit),
            "The friction coefficient below which sliding continues throughout the \
            impact. The tangential impulse is then μ times the normal impulse.",
            Text("ΔV_τ/(2 ΔV_n)"),
        )
        .equation("ΔVτ/(2ΔVn)")
        .stage(Velocity)
        .source(
            "Oblique elastic impact with Coulomb friction, ΔVτ/(2ΔVn): the tip rebounds \
            at ΔV_n, so the normal impulse is 2 M ΔV_n.",
        )
        .corrections(&["Eq. 64"])
        .assumptions(
            "The impact is elastic. The same mass applies along the normal and along \
            the flank.",
        )
        .checks(&[checks::coulomb]),
    PLAIN
        .row(
            ["impulse_ratio", "κ", "impulse ratio"],
            ("1", "1", 4),
            |s| Some(s.impact?.impulse_ratio),
            "The ratio of the impulse of a half-sine force, with peak F_S and duration \
                T_S, to the approach momentum M ΔV_n. An elastic impact gives 2, an impact \
                without rebound gives 1.",
            Text("(2/π) F_S T_S/(M ΔV_n)"),
        )
        .equation("half-sine")
        .stage(Impact)
        .source("Balance of momentum over the impact, not part of Zhou & Chen 2014.")
        .corrections(&["Eq. 32"])
        .assumptions("The force follows half a sine over time.")
        .checks(&[checks::possible]),
];

/// The end D' of the impact by the formulas of the page. The solver avoids their differences.
struct End {
    turn: f64,
    chord: f64,
    approach_angle: f64,
    polar_angle: f64,
    radius: f64,
    curvature: f64,
    normal_angle: f64,
    normal_radius: f64,
    normal_length: f64,
    driven_speed: f64,
}

impl End {
    fn of(k: &Context) -> Option<End> {
        let (geometry, impact) = (&k.solution.geometry, k.solution.impact?);
        let (position, time) = (k.solution.position?, impact.duration_printed);
        let edge = geometry.driven.edge;
        let (tip, distance) = (geometry.driven.tip - edge, geometry.centre_distance);
        let turn = k.inputs.speed * time;
        let chord = 2.0 * tip * (turn / (2.0 * k.inputs.ratio())).sin();
        let at = |polar_angle: f64| {
            (tip * tip + distance * distance - 2.0 * distance * tip * polar_angle.cos()).sqrt()
        };
        let rest = position.approach_angle_driven - k.inputs.driven_speed() * time;
        let (polar_angle, radius) = if paper(k.inputs) {
            let along = position.contact.radius_driver * turn.cos();
            let left = along * along - position.contact.radius_driver.powi(2) + chord * chord;
            let radius = along - left.sqrt();
            let cosine =
                (tip * tip + distance * distance - radius * radius) / (2.0 * distance * tip);
            (cosine.acos(), radius)
        } else {
            let polar_angle = geometry.start_angle_driven + rest.max(0.0);
            (polar_angle, at(polar_angle))
        };
        let centre_curvature = (radius * radius - geometry.driver.base.powi(2)).sqrt();
        let curvature = centre_curvature - edge;
        let (sine, cosine) = polar_angle.sin_cos();
        let normal_angle = (tip * sine).atan2(distance - tip * cosine)
            + centre_curvature.atan2(geometry.driver.base);
        let arm = position.contact.radius_driven;
        let gained = impact.force * time / (k.solution.reduced_mass * arm);
        Some(End {
            turn,
            chord,
            approach_angle: polar_angle - geometry.start_angle_driven,
            polar_angle,
            radius,
            curvature,
            normal_angle,
            normal_radius: distance * normal_angle.cos() - geometry.driver.base,
            normal_length: distance * normal_angle.sin() - curvature,
            driven_speed: k.inputs.driven_speed() + gained,
        })
    }
}

pub(super) const STEPS: &[Step] = &[
    step("Δθ", "turn of the driver during the impact, Eq. 35", "deg", Text("ω_1 T_S,32"), |k| {
        Some(End::of(k)?.turn)
    }),
    step(
        "DD'",
        "chord of the path of the driven tip during the impact, Eqs. 36 and 37",
        "mm",
        Text("2 r_a2 sin(Δθ/(2 i))"),
        |k| Some(End::of(k)?.chord),
    ),
    step(
        "u'",
        "driven angle before E at D'",
        "deg",
        Cases(&[(paper, Difference("η' - γ_2")), (always, Difference("max(u - ω_2 T_S,32, 0)"))]),
        |k| Some(End::of(k)?.approach_angle),
    ),
    step(
        "η'",
        "angle at O2 from the centre line to the tip at D'",
        "deg",
        Cases(&[
            (paper, Difference("acos((r_a2² + a² - O1D'²)/(2 a r_a2))")),
            (always, Text("γ_2 + u'")),
        ]),
        |k| Some(End::of(k)?.polar_angle),
    ),
    step(
        "O1D'",
        "driver radius at D', or of the centre of the rounding there",
        "mm",
        Cases(&[
            (paper, Difference("O1D cos Δθ - √((O1D cos Δθ)² - O1D² + DD'²)")),
            (driven_rounded, Text("√(r_C2² + a² - 2 a r_C2 cos η')")),
            (always, Text("√(r_a2² + a² - 2 a r_a2 cos η')")),
        ]),
        |k| Some(End::of(k)?.radius),
    ),
    step(
        "ρ_1'",
        "radius of curvature of the driver at D'",
        "mm",
        Cases(&[
            (driven_rounded, Difference("√(O1D'² - r_b1²) - re2")),
            (always, Difference("√(O1D'² - r_b1²)")),
        ]),
        |k| Some(End::of(k)?.curvature),
    ),
    step(
        "χ'",
        "angle of the contact normal at D'",
        "deg",
        Cases(&[
            (driven_rounded, Text("atan2(r_C2 sin η', a - r_C2 cos η') + atan2(ρ_1' + re2, r_b1)")),
            (always, Text("atan2(r_a2 sin η', a - r_a2 cos η') + atan2(ρ_1', r_b1)")),
        ]),
        |k| Some(End::of(k)?.normal_angle),
    ),
    step(
        "r_b2''",
        "distance from O2 to the contact normal at D'",
        "mm",
        Difference("a cos χ' - r_b1"),
        |k| Some(End::of(k)?.normal_radius),
    ),
    step(
        "N2'D'",
        "from the driven gear's foot on that normal to D'",
        "mm",
        Text("a sin χ' - ρ_1'"),
        |k| Some(End::of(k)?.normal_length),
    ),
    step(
        "ω_2'",
        "speed of the driven gear after the impact, Eq. 31",
        "rad/s",
        Text("ω_2 + F_S T_S,32/(m_red O2D)"),
        |k| Some(End::of(k)?.driven_speed),
    ),
    step(
        "ΔV_n'",
        "approach velocity at D', Eq. 29",
        "m/s",
        Difference("ω_1 r_b1 - ω_2' r_b2''"),
        |k| {
            let end = End::of(k)?;
            Some(
                k.inputs.speed * k.solution.geometry.driver.base
                    - end.driven_speed * end.normal_radius,
            )
        },
    ),
    step(
        "ΔV_τ'",
        "sliding velocity at D', Eq. 30",
        "m/s",
        Difference("ω_2' N2'D' - ω_1 ρ_1'"),
        |k| {
            let end = End::of(k)?;
            Some(end.driven_speed * end.normal_length - k.inputs.speed * end.curvature)
        },
    ),
];
