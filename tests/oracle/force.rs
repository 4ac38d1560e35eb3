//! Load, stiffness, force, duration and friction, by their definitions.

use tipstrike::model::inputs::{ContactCompliance, Method, ToothCompliance};

use super::given::{Gear, Given};
use super::number::{Big, decimal, logarithm, pi, root, rounded, sine, whole};
use super::{Answers, Circles, Pair, Tip, leg, tip_at};

/// Ratio of Hertz's duration to Eq. 32: 2 (15/16)^(2/5) (2/5) B(2/5, 1/2) π^(2/5).
const HERTZ_PREFACTOR: &str = "4.53397716400848829738503123122036048657195919674238717815628";

/// Speeds, load, masses and material.
pub(crate) struct Load {
    /// ω₁.
    driver_speed: Big,
    /// ω₂.
    driven_speed: Big,
    /// F₀.
    mesh_force: Big,
    /// J of both gears.
    inertia: [Big; 2],
    /// m_red.
    reduced_mass: Big,
    /// (1 − ν²)/E of both gears.
    give: [Big; 2],
    /// b.
    width: Big,
}

/// The impact at a place.
struct Struck {
    force: Big,
    compliance: Big,
    half_width: Big,
}

impl Load {
    pub(crate) fn of(given: &Given, pair: &Pair) -> Load {
        let inertia = |gear: &Gear, circles: &Circles| {
            let power = |radius: &Big| radius * radius * radius * radius;
            pi() * &gear.density * &gear.face_width / 2
                * (power(&circles.base) - power(&gear.bore_radius))
        };
        let give = |gear: &Gear| (1 - &gear.poisson * &gear.poisson) / &gear.young;
        let inertia = [inertia(&given.driver, &pair.driver), inertia(&given.driven, &pair.driven)];
        let first = &inertia[0] / (&pair.driver.base * &pair.driver.base);
        let second = &inertia[1] / (&pair.driven.base * &pair.driven.base);
        Load {
            driver_speed: given.speed.clone(),
            driven_speed: &given.speed / given.ratio(),
            mesh_force: given.torque() / &pair.driver.base,
            reduced_mass: &first * &second / (&first + &second),
            inertia,
            give: [give(&given.driver), give(&given.driven)],
            width: given.common_width(),
        }
    }

    /// δ of the pairs that carry the load while the incoming pair is at E.
    pub(crate) fn deflection(&self, given: &Given, pair: &Pair) -> Option<Big> {
        let tangent = &pair.distance * pair.working.sin();
        let mut along = &pair.start + &pair.base_pitch;
        let mut stiffness = whole(0);
        while along <= pair.end && along < tangent {
            let rest = &tangent - &along;
            let radius = |base: &Big, length: &Big| root(base * base + length * length);
            let radii = [radius(&pair.driver.base, &along), radius(&pair.driven.base, &rest)];
            let curvature = &along * &rest / (&along + &rest);
            let half_width = self.half_width(&self.mesh_force, &curvature);
            let depths = depths(given, pair, &radii)?;
            let contact = self.contact(given, &depths, &half_width);
            if rounded(&contact) <= 0.0 {
                return None;
            }
            stiffness += 1 / (teeth(given, pair, &radii)? + contact);
            along = along + &pair.base_pitch;
        }
        (rounded(&stiffness) > 0.0).then(|| &self.mesh_force / (&self.width * stiffness))
    }

    /// Every quantity from the velocity on, if it exists.
    pub(crate) fn strike(
        &self,
        given: &Given,
        pair: &Pair,
        tip: &Tip,
        angle: &Big,
        found: &mut Answers,
    ) {
        let normal =
            &self.driver_speed * &pair.driver.base - &self.driven_speed * &tip.normal_radius;
        let sliding = &self.driven_speed * &tip.normal_length - &self.driver_speed * &tip.curvature;
        let curvature = reduced_curvature(given, pair, tip);
        let (base, arm) = (&pair.driver.base, &tip.normal_radius);
        let [first, second] = &self.inertia;
        let mass = first * second / (first * arm * arm + second * base * base);
        found.extend([
            ("mesh_force", self.mesh_force.clone()),
            ("reduced_mass", self.reduced_mass.clone()),
            ("transit_time", angle / &self.driven_speed),
            ("stick_limit", &sliding / (2 * &normal)),
            ("curvature_radius", curvature.clone()),
        ]);
        if let Some(struck) = self.impact(given, pair, tip, &(&normal * root(&self.width * &mass)))
        {
            let printed = self.printed_duration(&normal, &curvature);
            let spring = pi() * root(&mass * &struck.compliance / &self.width);
            let duration = if given.method == Method::Paper { &printed } else { &spring }.clone();
            let ratio =
                self.friction(given, pair, tip, angle, &(&struck.force * &printed), &printed);
            found.extend(ratio.map(|ratio| ("friction_ratio", ratio)));
            found.extend([
                ("dynamic_factor", &struck.force / &self.mesh_force),
                ("impulse_ratio", 2 / pi() * &struck.force * &duration / (&mass * &normal)),
                ("impact_energy", &mass * &normal * &normal / 2),
                ("sliding_energy", &mass * &sliding * &sliding / 2),
                ("impact_duration_hertz", decimal(HERTZ_PREFACTOR) * &printed),
                ("impact_duration_printed", printed),
                ("impact_duration_spring", spring),
                ("impact_duration", duration),
                ("effective_mass", mass),
                ("impact_force", struck.force),
                ("pair_compliance", struck.compliance),
                ("hertz_half_width", struck.half_width),
            ]);
        }
        found.extend([("normal_velocity", normal), ("sliding_velocity", sliding)]);
    }

    /// Eq. 32 as printed, the masses in kg.
    fn printed_duration(&self, normal: &Big, curvature: &Big) -> Big {
        let modulus = 1 / (&self.give[0] + &self.give[1]);
        let mass = &self.reduced_mass;
        let fifth: Big =
            logarithm(mass * mass / (pi() * pi() * normal * curvature * &modulus * &modulus)) / 5;
        fifth.exp()
    }

    /// Eq. 57 with the half-width of its own force, by fixed-point iteration. `None` if no fit
    /// gives a compliance.
    fn impact(&self, given: &Given, pair: &Pair, tip: &Tip, momentum: &Big) -> Option<Struck> {
        const STEPS: usize = 400;
        const FORCE_SETTLED: f64 = 1e-32;
        let radii = [tip.radius.clone(), tip.radius_driven.clone()];
        let (teeth, depths) = (teeth(given, pair, &radii)?, depths(given, pair, &radii)?);
        let curvature = reduced_curvature(given, pair, tip);
        let mut force = momentum / teeth.sqrt();
        for _ in 0..STEPS {
            let half_width = self.half_width(&force, &curvature);
            let compliance = &teeth + self.contact(given, &depths, &half_width);
            if rounded(&compliance) <= 0.0 {
                return None;
            }
            let next = momentum / compliance.sqrt();
            let change = rounded(&(&next / &force - 1)).abs();
            force = next;
            if change <= FORCE_SETTLED {
                return (compliance > teeth).then_some(Struck { force, compliance, half_width });
            }
        }
        None
    }

    /// a = √(4 (F/b) ρS/(π E')).
    fn half_width(&self, force: &Big, curvature: &Big) -> Big {
        root(4 * force / &self.width * curvature * (&self.give[0] + &self.give[1]) / pi())
    }

    /// Contact compliance by the formula of the case.
    fn contact(&self, given: &Given, depths: &[Big; 2], half_width: &Big) -> Big {
        let [first, second] = &self.give;
        match given.contact_compliance {
            ContactCompliance::CONSTANT => 2 * (first + second) / pi(),
            ContactCompliance::LOGARITHMIC => {
                let logarithm = (&given.module / half_width).ln();
                (first + second) / pi() * (decimal("1.27") + decimal("0.781") * logarithm)
            }
            ContactCompliance::WEBER => {
                let of = |gear: &Gear, give: &Big, depth: &Big| {
                    give / pi()
                        * (2 * logarithm(2 * depth / half_width)
                            - &gear.poisson / (1 - &gear.poisson))
                };
                of(&given.driver, first, &depths[0]) + of(&given.driven, second, &depths[1])
            }
            other => panic!("no oracle for the contact compliance {}", other.name()),
        }
    }

    /// Eqs. 29-45 and 64. `None` if D' does not exist.
    fn friction(
        &self,
        given: &Given,
        pair: &Pair,
        tip: &Tip,
        angle: &Big,
        impulse: &Big,
        duration: &Big,
    ) -> Option<Big> {
        let driver_turn = &self.driver_speed * duration;
        let driven_turn = &self.driven_speed * duration;
        let end = match given.method {
            Method::Paper => {
                let chord = 2 * &pair.driven.tip * sine(driven_turn / 2);
                let (sine, cosine) = driver_turn.sin_cos();
                let square = &chord * &chord - &tip.radius * &tip.radius * &sine * &sine;
                if rounded(&square) < 0.0 {
                    return None;
                }
                let radius = &tip.radius * cosine - square.sqrt();
                tip_at(pair, &(polar_angle(pair, &radius)? - &pair.start_angle))?
            }
            _ => tip_at(pair, &(angle - driven_turn).max(whole(0)))?,
        };
        let speed = &self.driven_speed + impulse / (&self.reduced_mass * &tip.radius_driven);
        let driver = &self.driver_speed;
        let normal = driver * &pair.driver.base
            - &speed * &end.normal_radius
            - (driver * &pair.driver.base - &self.driven_speed * &tip.normal_radius);
        let sliding = &speed * &end.normal_length
            - driver * &end.curvature
            - (&self.driven_speed * &tip.normal_length - driver * &tip.curvature);
        let ratio = sliding / normal;
        Some(if rounded(&ratio) < 0.0 { -ratio } else { ratio })
    }
}

/// Angle at O₂ between the centre line and the tip at a distance `radius` from O₁.
pub(crate) fn polar_angle(pair: &Pair, radius: &Big) -> Option<Big> {
    let (tip, distance) = (&(&pair.driven.tip - &pair.driven.edge), &pair.distance);
    let cosine = (tip * tip + distance * distance - radius * radius) / (2 * tip * distance);
    (rounded(radius) > 0.0 && rounded(&cosine).abs() < 1.0).then(|| cosine.acos())
}

/// ρ_S, with the rounding of the tip if given.
fn reduced_curvature(given: &Given, pair: &Pair, tip: &Tip) -> Big {
    let flank = leg(&pair.driven.tip, &pair.driven.base).expect("a tip outside its base circle");
    let driven = given.driven.tip_radius.as_ref().unwrap_or(&flank);
    &tip.curvature * driven / (&tip.curvature + driven)
}

/// q₁ + q₂ by Eq. 56; `None` for a tooth compliance without a closed form.
fn teeth(given: &Given, pair: &Pair, radii: &[Big; 2]) -> Option<Big> {
    let fit = [&given.driver, &given.driven].iter().all(|gear| (12..=100).contains(&gear.teeth));
    if given.tooth_compliance != Some(ToothCompliance::KUANG_YANG) || !fit {
        return None;
    }
    let driver = tooth(given, &given.driver, &pair.driver, &radii[0]);
    let driven = tooth(given, &given.driven, &pair.driven, &radii[1]);
    (rounded(&driver) > 0.0 && rounded(&driven) > 0.0).then(|| driver + driven)
}

fn tooth(given: &Given, gear: &Gear, circles: &Circles, radius: &Big) -> Big {
    let cubic = |coefficients: [&str; 4]| {
        coefficients
            .iter()
            .rev()
            .fold(whole(0), |sum, coefficient| sum * gear.teeth + decimal(coefficient))
    };
    let a0 = cubic(["3.867", "1.612", "-0.02916", "0.0001553"]);
    let a1 = cubic(["17.060", "0.7289", "-0.01728", "0.0000999"]);
    let a2 = cubic(["2.637", "-1.222", "0.02217", "-0.0001179"]);
    let a3 = cubic(["-6.330", "-1.033", "0.02068", "-0.0001130"]);
    let shift = &gear.profile_shift;
    let height = (radius - &circles.reference) / ((1 + shift) * &given.module);
    1 / (decimal("1e9") * (a0 + a1 * shift + (a2 + a3 * shift) * height))
}

/// Depths from the flanks to the centre lines of the teeth along the line of force, which only
/// Weber's formula reads. `None` if no tooth is left.
fn depths(given: &Given, pair: &Pair, radii: &[Big; 2]) -> Option<[Big; 2]> {
    if given.contact_compliance != ContactCompliance::WEBER {
        return Some([whole(0), whole(0)]);
    }
    Some([
        depth(given, &given.driver, &pair.driver, &radii[0])?,
        depth(given, &given.driven, &pair.driven, &radii[1])?,
    ])
}

/// Depth from the flank to the centre line of the tooth along the line of force. `None` if no tooth
/// is left.
fn depth(given: &Given, gear: &Gear, circles: &Circles, radius: &Big) -> Option<Big> {
    let involute = |angle: &Big| angle.tan() - angle;
    let alpha = &given.pressure_angle;
    let at_base = pi() / (2 * whole(gear.teeth))
        + 2 * &gear.profile_shift * alpha.tan() / gear.teeth
        + involute(alpha);
    let pressure = (&circles.base / radius).acos();
    let half_thickness = radius * sine(&at_base - involute(&pressure));
    let force_angle: Big = pressure.tan() - at_base;
    let depth = half_thickness / force_angle.cos();
    (rounded(&depth) > 0.0).then_some(depth)
}
