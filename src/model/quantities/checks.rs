//! Ranges of validity with the values of a case.

use crate::model::compliance::model_of;
use crate::model::explanation::{Context, Finding, four, micro, mm};
use crate::model::notes::{THIN_TIP, USUAL_BACKLASH, backlash, inertia_at_rest, sliding};
use crate::model::profile::{Profile, Rack, normal_tip_thickness};

/// No interference at the start of contact.
pub(super) fn start(k: &Context) -> Option<Finding> {
    let start = k.solution.geometry.start;
    Finding::new(
        "N1E > 0: the driven tip meets the driver above its base circle",
        format!("N1E = {}", mm(start)),
        start > 0.0,
    )
}

/// No interference at the end of contact.
pub(super) fn end(k: &Context) -> Option<Finding> {
    let rest = k.solution.geometry.tangent_length - k.solution.geometry.end;
    Finding::new(
        "N2B > 0: the driver's tip meets the driven gear above its base circle",
        format!("N2B = {}", mm(rest)),
        rest > 0.0,
    )
}

/// A pair carries the load when the next pair starts contact.
pub(super) fn contact_ratio(k: &Context) -> Option<Finding> {
    let ratio = k.solution.geometry.contact_ratio;
    Finding::new(
        "ε > 1: a pair carries the load while the next pair comes into contact; \
            above 2 several pairs share the load",
        format!("ε = {}", four(ratio)),
        ratio > 1.0,
    )
}

/// A given centre distance leaves a usual backlash.
pub(super) fn distance(k: &Context) -> Option<Finding> {
    let (backlash, part) = backlash(k)?;
    Finding::new(
        "a given centre distance leaves a normal backlash of 0 to a tenth of the \
            module",
        format!("{}, {} of the module", mm(backlash), four(part)),
        USUAL_BACKLASH.contains(&part),
    )
}

/// The bores are smaller than the bodies.
pub(super) fn bodies(k: &Context) -> Option<Finding> {
    let geometry = &k.solution.geometry;
    let [driver, driven] = k.inputs.bores();
    let parts = [driver / geometry.driver.root, driven / geometry.driven.root];
    Finding::new(
        "the bores leave a body, r_h < r_f",
        format!("rh1/r_f1 = {}, rh2/r_f2 = {}", four(parts[0]), four(parts[1])),
        parts.iter().all(|&part| part < 1.0),
    )
}

/// At D the tip has closed the gap Δ.
pub(super) fn gap_closed(k: &Context) -> Option<Finding> {
    const CLOSED: f64 = 1e-9;
    let closed = k.solution.position?.closed_gap;
    let total = k.solution.deviation.total;
    let part = closed / total;
    let (closed, total) = (micro(closed, "um"), micro(total, "um"));
    Finding::new(
        "the tip has closed Δ at D, S(u) = Δ",
        format!("S(u) = {closed} of {total}, {} %", four(100.0 * part)),
        (part - 1.0).abs() < CLOSED,
    )
}

/// D is on the driver's involute.
pub(super) fn on_flank(k: &Context) -> Option<Finding> {
    let circles = &k.solution.geometry.driver;
    let radius = k.solution.position?.contact.radius_driver;
    let form = Profile::of(&Rack::of(k.inputs, &k.inputs.driver), circles).form_radius();
    let end = circles.involute_end();
    Finding::new(
        "D on the driver's involute: form circle <= O1D <= its end at the tip",
        format!("{} <= {} <= {}", mm(form), mm(radius), mm(end)),
        (form..=end).contains(&radius),
    )
}

/// The case gives the edge of the tip.
pub(super) fn edge(k: &Context) -> Option<Finding> {
    let given = k.inputs.driven.tip_radius;
    let here = match given {
        Some(radius) => format!("re2 = {}", mm(radius)),
        None => "not given, the flank's curvature is used".to_owned(),
    };
    Finding::new("the case gives the edge radius of the driven tip", here, given.is_some())
}

/// Sliding does not reverse between D and E.
pub(super) fn keeps_sliding(k: &Context) -> Option<Finding> {
    let [at_contact, at_start] = sliding(k)?;
    Finding::new(
        "sliding keeps its direction from D to E",
        format!("{} m/s at D, {} m/s at E", four(at_contact), four(at_start)),
        at_contact * at_start > 0.0,
    )
}

/// The pair ahead stays in contact. Methods with load sharing do not need this condition.
pub(super) fn pair_ahead(k: &Context) -> Option<Finding> {
    if k.solution.method.shares_load() {
        return None;
    }
    let deviation = k.solution.deviation;
    let (deflection, error) = (deviation.combined_deflection, deviation.equivalent_error);
    Finding::new(
        "δ >= Δf: the load keeps the pair ahead in contact",
        format!("δ = {}, Δf = {}", micro(deflection, "um"), micro(error, "um")),
        deflection >= error,
    )
}

/// The impact ends before E.
pub(super) fn within_approach(k: &Context) -> Option<Finding> {
    let range = "T_S <= t_DE: the impact ends before the normal mesh begins";
    ends_before_start(k, range, ("T_S", k.solution.impact?.duration))
}

/// A duration with its symbol is at most the time from D to E.
fn ends_before_start(k: &Context, range: &str, (symbol, duration): (&str, f64)) -> Option<Finding> {
    let transit = k.solution.velocity?.transit_time;
    let here = format!("{symbol} = {}, t_DE = {}", micro(duration, "us"), micro(transit, "us"));
    Finding::new(range, here, duration <= transit)
}

/// Force and duration are consistent.
pub(super) fn possible(k: &Context) -> Option<Finding> {
    let impact = k.solution.impact?;
    let ratio = impact.impulse_ratio;
    Finding::new(
        "1 <= κ <= 2: force and duration belong to one impact",
        format!("κ = {}", four(ratio)),
        impact.is_possible(),
    )
}

/// The printed duration equals Hertz's.
pub(super) fn printed_shorter(k: &Context) -> Option<Finding> {
    let impact = k.solution.impact?;
    let (printed, hertz) = (impact.duration_printed, impact.duration_hertz());
    Finding::new(
        "T_S,32 equals the duration after Hertz",
        format!("T_S,32 = {}, T_S,H = {}", micro(printed, "us"), micro(hertz, "us")),
        false,
    )
}

/// The friction coefficient of the case is below the stick limit.
pub(super) fn coulomb(k: &Context) -> Option<Finding> {
    let limit = k.solution.velocity?.stick_limit;
    let range = "μ of the case below stick_limit: sliding throughout";
    match k.inputs.friction_coefficient {
        None => Finding::new(range, "the case gives no μ", true),
        Some(friction) => Finding::new(
            range,
            format!("μ = {friction}, stick_limit = {}", four(limit)),
            friction < limit,
        ),
    }
}

/// D' is before E.
pub(super) fn before_start(k: &Context) -> Option<Finding> {
    let printed = k.solution.impact?.duration_printed;
    ends_before_start(k, "T_S,32 <= t_DE: D' is before E", ("T_S,32", printed))
}

/// The range of the tooth compliance of the case.
pub(super) fn teeth(k: &Context) -> Option<Finding> {
    (model_of(k.inputs).model().check)(k)
}

/// The range of the tooth compliance if the deflection comes from the load.
pub(super) fn teeth_of_deflection(k: &Context) -> Option<Finding> {
    let is_computed = k.inputs.deflection.is_none();
    is_computed.then(|| teeth(k)).flatten()
}

/// The contact is small compared with the tooth.
pub(super) fn contact_small(k: &Context) -> Option<Finding> {
    const SMALL: f64 = 0.1;
    let half_width = k.solution.impact?.hertz_half_width;
    let limit = SMALL * k.inputs.module;
    Finding::new(
        "the contact is small compared with the tooth: a_H <= m/10",
        format!("a_H = {}, m/10 = {}", mm(half_width), mm(limit)),
        half_width <= limit,
    )
}

/// The load changes slowly enough for a static balance.
pub(super) fn at_rest(k: &Context) -> Option<Finding> {
    let [period, time, part] = inertia_at_rest(k)?;
    let share = four(100.0 * part.min(1.0));
    let (period, time) = (micro(period, "us"), micro(time, "us"));
    Finding::new(
        "the load on the tooth grows so slowly that the mesh does not oscillate: \
            1/(π f_n t) <= model.within",
        format!("1/f_n = {period}, t = {time}, {share} %"),
        part <= k.inputs.within,
    )
}

/// The start of the motion has no effect at E.
pub(super) fn forgotten(k: &Context) -> Option<Finding> {
    const LEFT: f64 = 1e-3;
    let (inputs, geometry) = (k.inputs, &k.solution.geometry);
    let frequency = (k.solution.mesh.as_ref()?.mean_stiffness() / k.solution.reduced_mass).sqrt();
    let cycles = f64::from(inputs.warmup_cycles);
    let time = cycles * geometry.base_pitch / (inputs.speed * geometry.driver.base);
    let left = (-inputs.damping_ratio * frequency * time).exp();
    Finding::new(
        "the start of the motion has decayed at E: e^(-ζ 2 π f_n t) <= 0.001",
        format!("{} of it after {cycles} base pitches", four(left)),
        left <= LEFT,
    )
}

pub(super) fn contact_kept(k: &Context) -> Option<Finding> {
    let lost = k.solution.dynamic.as_ref()?.contact_lost;
    let here = if lost { "contact is lost at times" } else { "the teeth stay in contact" };
    Finding::new(
        "the teeth keep contact; if they lose contact, a small change of the case \
            can change the value strongly",
        here,
        !lost,
    )
}

/// The tips are not thin.
pub(super) fn tips(k: &Context) -> Option<Finding> {
    let (inputs, geometry) = (k.inputs, &k.solution.geometry);
    let least = THIN_TIP * inputs.module;
    let driver = normal_tip_thickness(inputs, &inputs.driver, &geometry.driver);
    let driven = normal_tip_thickness(inputs, &inputs.driven, &geometry.driven);
    Finding::new(
        "in the normal section s_a >= 0.2 m: a thinner tip is brittle when hardened",
        format!("s_a1 = {}, s_a2 = {}, 0.2 m = {}", mm(driver), mm(driven), mm(least)),
        driver.min(driven) >= least,
    )
}

/// The tips do not touch the roots.
pub(super) fn clearance(k: &Context) -> Option<Finding> {
    let [driver, driven] = k.solution.figures?.tip_clearance;
    Finding::new(
        "c_a > 0: the tips clear the roots",
        format!("c_a1 = {}, c_a2 = {}", mm(driver), mm(driven)),
        driver.min(driven) > 0.0,
    )
}

/// The involutes begin below the active flanks.
pub(super) fn form_diameters(k: &Context) -> Option<Finding> {
    let geometry = &k.solution.geometry;
    let active = [
        geometry.driver.base.hypot(geometry.start),
        geometry.driven.base.hypot(geometry.tangent_length - geometry.end),
    ];
    let gears = [(&k.inputs.driver, &geometry.driver), (&k.inputs.driven, &geometry.driven)];
    let form =
        gears.map(|(gear, circles)| Profile::of(&Rack::of(k.inputs, gear), circles).form_radius());
    let [driver, driven] = form.map(|radius| mm(2.0 * radius));
    Finding::new(
        "d_Nf >= d_Ff: the involute begins at the root form diameter d_Ff, below \
            the active flank",
        format!("d_Ff1 = {driver}, d_Ff2 = {driven}"),
        active.iter().zip(form).all(|(active, form)| *active >= form),
    )
}

/// The range of the stiffness of ISO 6336-1.
pub(super) fn iso_stiffness(k: &Context) -> Option<Finding> {
    let shifts = k.inputs.driver.profile_shift + k.inputs.driven.profile_shift;
    let load = k.solution.figures?.tangential_force / k.inputs.common_width() / 1e3;
    Finding::new(
        "-0.5 <= x1 + x2 <= 2 and F_t/b from 100 to 1600 N/mm",
        format!("x1 + x2 = {}, F_t/b = {} N/mm", four(shifts), four(load)),
        (-0.5..=2.0).contains(&shifts) && (100.0..=1600.0).contains(&load),
    )
}

/// The range of method B for the dynamic factor.
pub(super) fn iso_range(k: &Context) -> Option<Finding> {
    const LEAST: f64 = 3.0;
    let figures = k.solution.figures?;
    let ratio = k.inputs.ratio();
    let speed = figures.pitch_line_speed * f64::from(k.inputs.driver.teeth) / 100.0
        * (ratio * ratio / (1.0 + ratio * ratio)).sqrt();
    Finding::new(
        "v z1/100 √(i²/(1 + i²)) >= 3 m/s: a slower pair has K_v near 1",
        format!("{} m/s", four(speed)),
        speed >= LEAST,
    )
}
