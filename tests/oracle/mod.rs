//! Every closed-form quantity computed independently with 90 digits, by its definition and not by
//! the form that is stable with 16 digits.
//!
//! Symbols and equations are those of Zhou & Chen 2014 and of the model's documentation. Squares
//! are subtracted, angles come from arc cosines, and the gap S(u) is the difference of its three
//! terms: with 90 digits the cancellation is harmless.

mod force;
mod given;
pub(crate) mod number;

use std::collections::BTreeMap;

use tipstrike::model::Inputs;
use tipstrike::model::inputs::Method;

use given::Gear;
pub(crate) use given::Given;
use number::{Big, pi, root, rounded, whole};

/// The existing quantities by key.
pub(crate) type Answers = BTreeMap<&'static str, Big>;

/// Half of the digits: an iteration ends below this change.
const SETTLED: f64 = 1e-45;

/// Greatest angle of the search for a contact, in rad.
const LARGEST_ANGLE: f64 = 1.5;

struct Circles {
    reference: Big,
    base: Big,
    tip: Big,
    /// Radius of the tip rounding; 0 for a sharp tip.
    edge: Big,
}

struct Pair {
    driver: Circles,
    driven: Circles,
    distance: Big,
    working: Big,
    base_pitch: Big,
    /// N₁E.
    start: Big,
    /// N₁B.
    end: Big,
    /// γ₂.
    start_angle: Big,
}

/// The driven tip at an angle before E.
struct Tip {
    /// O₁D.
    radius: Big,
    /// O₂D.
    radius_driven: Big,
    /// ρ₁.
    curvature: Big,
    /// χ.
    normal: Big,
    /// r_b2'.
    normal_radius: Big,
    /// N₂'D.
    normal_length: Big,
}

/// The quantities with their condition numbers: relative change over the relative change of an
/// input, summed over all inputs.
pub(crate) fn answers_with_conditions(
    inputs: &Inputs,
) -> Option<(Answers, BTreeMap<&'static str, f64>)> {
    let step = 1 / (whole(10).powi(24.into()));
    let plain = of_given(&Given::of(inputs))?;
    let mut conditions: BTreeMap<_, _> = plain.keys().map(|&key| (key, 0.0)).collect();
    for index in 0..Given::of(inputs).continuous().len() {
        let mut moved = Given::of(inputs);
        let field = &mut *moved.continuous().swap_remove(index);
        if rounded(field) == 0.0 {
            continue;
        }
        *field = &*field * (1 + &step);
        let Some(moved) = of_given(&moved) else { continue };
        for (key, condition) in &mut conditions {
            let Some(value) = moved.get(key) else { continue };
            if rounded(&plain[key]) != 0.0 {
                *condition += rounded(&((value / &plain[key] - 1) / &step)).abs();
            }
        }
    }
    Some((plain, conditions))
}

/// All quantities that are defined for the pair. `None` without a mesh or without corner contact on
/// the flank of the driver.
fn of_given(given: &Given) -> Option<Answers> {
    let pair = pair(given)?;
    let load = force::Load::of(given, &pair);
    let error = equivalent_error(given);
    let deflection = match &given.deflection {
        Some(deflection) => deflection.clone(),
        None => load.deflection(given, &pair)?,
    };
    let total = &error + &deflection;
    if rounded(&total) <= 0.0 {
        return None;
    }
    let angle = match given.method {
        Method::Paper => printed_angle(given, &pair, &error, &deflection),
        _ => first_contact(&pair, &total)?,
    };
    let tip = tip_at(&pair, &angle)?;
    if rounded(&pair.driven.edge) > 0.0 && rounded(&tip.normal_radius) < 0.0 {
        return None;
    }
    if rounded(&angle) <= 0.0
        || tip.radius > root(&pair.driver.base * &pair.driver.base + &pair.end * &pair.end)
    {
        return None;
    }
    let mut found = Answers::from([
        ("closed_gap", gap(&pair, &angle, &tip)),
        ("contact_ratio", (&pair.end - &pair.start) / &pair.base_pitch),
        ("base_pitch", pair.base_pitch.clone()),
        ("centre_distance", pair.distance.clone()),
        ("working_pressure_angle", pair.working.clone()),
        ("equivalent_error", error),
        ("combined_deflection", deflection),
        ("total_deviation", total),
        ("approach_angle_driver", &angle * &given.ratio()),
        ("approach_angle_driven", angle.clone()),
        ("contact_radius_driver", tip.radius.clone()),
        ("contact_radius_driven", tip.radius_driven.clone()),
        ("contact_normal_radius_driven", tip.normal_radius.clone()),
    ]);
    load.strike(given, &pair, &tip, &angle, &mut found);
    Some(found)
}

/// Δf by Eqs. 1 and 2; except in method `paper` the modification counts in full.
fn equivalent_error(given: &Given) -> Big {
    let modification = -(&given.driven.tip_relief + &given.driver.root_relief);
    let random = 2 * &given.base_pitch_deviation;
    match given.method {
        Method::Paper => (random - &given.backlash + modification) / whole(2).sqrt(),
        _ => random / whole(2).sqrt() + modification,
    }
}

fn circles(given: &Given, gear: &Gear) -> Circles {
    let reference = &given.module * gear.teeth / 2;
    let base = &reference * given.pressure_angle.cos();
    let tip =
        &reference + &given.module * (&gear.addendum + &gear.profile_shift) - &gear.tip_chamfer;
    // The paper covers only sharp tips.
    let edge = match (&gear.tip_radius, given.method) {
        (Some(edge), method) if method != Method::Paper => edge.clone(),
        _ => whole(0),
    };
    Circles { reference, base, tip, edge }
}

fn pair(given: &Given) -> Option<Pair> {
    let (driver, driven) = (circles(given, &given.driver), circles(given, &given.driven));
    if !has_room(given, &given.driver, &driver) || !has_room(given, &given.driven, &driven) {
        return None;
    }
    let base_sum = &driver.base + &driven.base;
    let (distance, working) = match &given.centre_distance {
        Some(distance) if *distance > base_sum => (distance.clone(), (&base_sum / distance).acos()),
        Some(_) => return None,
        None => {
            let working = working_angle(given)?;
            (&base_sum / working.cos(), working)
        }
    };
    let start = &distance * working.sin() - involute_end(&driven)?;
    let end = involute_end(&driver)?;
    if rounded(&start) <= 0.0 || end <= start {
        return None;
    }
    let start_angle = (&driven.base / (&driven.tip - &driven.edge)).acos() - &working;
    let base_pitch = pi() * &given.module * given.pressure_angle.cos();
    let is_rounded = rounded(&driver.edge) > 0.0 || rounded(&driven.edge) > 0.0;
    if is_rounded && &end - &start < base_pitch {
        return None;
    }
    Some(Pair { driver, driven, distance, working, base_pitch, start, end, start_angle })
}

/// Radius of curvature at the end of the involute: an arc of radius r_e begins where its centre is
/// on the involute parallel to the flank.
fn involute_end(circles: &Circles) -> Option<Big> {
    Some(leg(&(&circles.tip - &circles.edge), &circles.base)? + &circles.edge)
}

/// Whether the centre of the tip rounding is outside the base circle and not beyond the centre line
/// of the tooth.
fn has_room(given: &Given, gear: &Gear, circles: &Circles) -> bool {
    let Some(string) = leg(&(&circles.tip - &circles.edge), &circles.base) else {
        return false;
    };
    let involute = |angle: &Big| angle.tan() - angle;
    let alpha = &given.pressure_angle;
    let half = (pi() / 2 + 2 * &gear.profile_shift * alpha.tan()) / gear.teeth + involute(alpha);
    let room = half - involute(&string.atan2(&circles.base)) - &circles.edge / &circles.base;
    rounded(&circles.edge) <= 0.0 || rounded(&room) >= 0.0
}

/// √(hypotenuse² − leg²).
fn leg(hypotenuse: &Big, leg: &Big) -> Option<Big> {
    let square = hypotenuse * hypotenuse - leg * leg;
    (rounded(&square) > 0.0).then(|| square.sqrt())
}

/// α_w from inv α_w = inv α + 2 (x1 + x2) tan α/(z1 + z2), by Newton's method from the right of the
/// root.
fn working_angle(given: &Given) -> Option<Big> {
    const STEPS: usize = 200;
    let alpha = &given.pressure_angle;
    let shifts = &given.driver.profile_shift + &given.driven.profile_shift;
    let involute =
        alpha.tan() - alpha + 2 * shifts * alpha.tan() / (given.driver.teeth + given.driven.teeth);
    let near = rounded(&involute);
    if near <= 0.0 {
        return None;
    }
    let mut angle = number::big((3.0 * near).cbrt().min(1.5));
    for _ in 0..STEPS {
        let tangent = angle.tan();
        let step = (&tangent - &angle - &involute) / (&tangent * &tangent);
        angle = angle - &step;
        if rounded(&step).abs() <= SETTLED {
            return Some(angle);
        }
    }
    None
}

/// The driven tip at an angle before E. `None` inside the base circle of the driver.
fn tip_at(pair: &Pair, angle: &Big) -> Option<Tip> {
    let (distance, base) = (&pair.distance, &pair.driver.base);
    let tip = &(&pair.driven.tip - &pair.driven.edge);
    let (sine, cosine) = (&pair.start_angle + angle).sin_cos();
    let centre = root(tip * tip + distance * distance - 2 * distance * tip * &cosine);
    let string = leg(&centre, base)?;
    let polar = (tip * sine).atan2(&(distance - tip * cosine));
    let normal = polar + string.atan2(base);
    let curvature = string - &pair.driven.edge;
    let normal_radius = distance * normal.cos() - base;
    let normal_length = distance * normal.sin() - &curvature;
    Some(Tip {
        radius: root(base * base + &curvature * &curvature),
        radius_driven: root(&normal_radius * &normal_radius + &normal_length * &normal_length),
        normal_radius,
        normal_length,
        curvature,
        normal,
    })
}

/// S(u) = (ρ1 − N1E) + rb2 u − rb1 (χ − αw).
fn gap(pair: &Pair, angle: &Big, tip: &Tip) -> Big {
    (&tip.curvature - &pair.start) + &pair.driven.base * angle
        - &pair.driver.base * (&tip.normal - &pair.working)
}

/// S(u) at an angle given in double precision.
pub(crate) fn gap_at(inputs: &Inputs, angle: f64) -> Option<Big> {
    let (pair, angle) = (pair(&Given::of(inputs))?, number::big(angle));
    Some(gap(&pair, &angle, &tip_at(&pair, &angle)?))
}

/// S(u) = Δ, by Newton's method on √S from the parabola at E, or from the tip of the driver if that
/// is closer; dS/du = rb2 − rb2'.
fn first_contact(pair: &Pair, deviation: &Big) -> Option<Big> {
    const STEPS: usize = 200;
    let edge = &pair.driven.edge;
    let driven = leg(&(&pair.driven.tip - edge), &pair.driven.base)?;
    let driver = &pair.start + edge;
    let curvature = (&driver + &driven) * &driven / &driver;
    let wanted = deviation.sqrt();
    let at_driver_tip =
        force::polar_angle(pair, &pair.driver.tip).map(|polar| polar - &pair.start_angle);
    let parabola = root(2 * deviation / curvature);
    let mut angle =
        at_driver_tip.into_iter().fold(parabola, Big::min).min(number::big(LARGEST_ANGLE));
    for _ in 0..STEPS {
        let tip = tip_at(pair, &angle)?;
        let closed = gap(pair, &angle, &tip);
        if rounded(&closed) <= 0.0 {
            return None;
        }
        let root = closed.sqrt();
        let step = 2 * &root * (&wanted - &root) / (&pair.driven.base - &tip.normal_radius);
        angle = angle + &step;
        if rounded(&(step / &angle)).abs() <= SETTLED {
            return Some(angle);
        }
    }
    None
}

/// The angle of the driven gear before E by the printed Eqs. 11-20, as differences of arc tangents.
fn printed_angle(given: &Given, pair: &Pair, error: &Big, deflection: &Big) -> Big {
    let base = &pair.driver.base;
    let angle = |along: &Big| base.atan2(along);
    let ahead = &pair.start + &pair.base_pitch;
    let by_error = angle(&(&pair.start - error)) - angle(&pair.start);
    let by_deflection = angle(&(&ahead - error - deflection)) - angle(&(&ahead - error));
    (by_error + by_deflection) / given.ratio()
}
