//! Notes beside the results, each with its value and its limit.

use super::compliance::model_of;
use super::compliance::tooth::preferences;
use super::deviation::{Origin, out_of_range};
use super::explanation::tidy;
use super::geometry::Circles;
use super::inputs::{Gear, InertiaModel, Method};
use super::profile::{Profile, Rack};
use super::{Inputs, Solution};
use crate::numeric::decimal::significant;

const MILLI: f64 = 1e3;
const MICRO: f64 = 1e6;

/// A note beside the results.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// A short name for scripts.
    pub code: &'static str,
    /// One sentence with the value and the limit.
    pub message: String,
}

impl Note {
    fn new(code: &'static str, message: String) -> Note {
        Note { code, message }
    }
}

/// A value with four significant digits.
fn four(value: f64) -> String {
    significant(value, 4)
}

/// Returns a note if its condition is true.
type Look = fn(&Inputs, &Solution) -> Option<Note>;

/// All conditions, in the order of the notes.
const LOOKS: &[Look] = &[
    method_taken,
    deflection_ignored,
    backlash_subtracted,
    deviations_added,
    lost_in_motion,
    stiffness_step,
    back_strikes,
    not_cleared,
    inertia,
    withheld,
    stations_left_out,
    barely_clear,
    gap_left_open,
    outlasting,
    impulse,
    contact_lost,
    sliding_reverses,
    end_not_found,
    friction,
    deflection_given,
    common_base_pitch,
    grade_driver,
    grade_driven,
    inertia_driver,
    inertia_driven,
    chosen_by_range,
    outside_range,
    without_coupling,
    hertz_width,
    contact_ratio_above_two,
    contact_ratio_below_one,
    centre_distance,
    start_past_pitch,
    interference_at_end,
    undercut_driver,
    undercut_driven,
    tip_driver,
    tip_driven,
    form_circle,
];

/// The notes on the results.
#[must_use]
pub fn notes(inputs: &Inputs, solution: &Solution) -> Vec<Note> {
    LOOKS.iter().filter_map(|look| look(inputs, solution)).collect()
}

/// More than two pairs carry the load.
fn contact_ratio_above_two(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let ratio = solution.geometry.contact_ratio;
    let is_coupled = inputs.method != Method::Paper && model_of(inputs).model().has_coupling;
    let done = match (inputs.given_deflection(), is_coupled) {
        (Some(_), _) => "the case gives the deflection",
        (None, true) => {
            "the pairs ahead of the incoming pair share the load and displace each other"
        }
        (None, false) => "the pairs ahead of the incoming pair share the load as parallel springs",
    };
    let message = || {
        format!(
            "the contact ratio is {}, above 2: more than one pair carries the load at F; {done}",
            four(ratio)
        )
    };
    (ratio > 2.0).then(|| Note::new("contact-ratio-above-2", message()))
}

/// At some angles no pair is in contact.
fn contact_ratio_below_one(_: &Inputs, solution: &Solution) -> Option<Note> {
    let ratio = solution.geometry.contact_ratio;
    let message = || {
        format!(
            "the contact ratio is {}, below 1: at some angles no pair is in contact",
            four(ratio)
        )
    };
    (ratio < 1.0).then(|| Note::new("contact-ratio-below-1", message()))
}

/// A given centre distance jams the teeth or opens the mesh.
fn centre_distance(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    const JAM: f64 = -1e-4;
    const OPEN: f64 = 0.1;
    inputs.centre_distance?;
    let backlash = solution.geometry.backlash(&inputs.shape());
    let value = four(backlash * MILLI);
    if backlash < JAM * inputs.module {
        Some(Note::new(
            "centre-distance-jams",
            format!(
                "the centre distance jams the mesh: the normal backlash is {value} mm and must not \
                    be below 0"
            ),
        ))
    } else if backlash > OPEN * inputs.module {
        let limit = four(OPEN * inputs.module * MILLI);
        let message = format!(
            "the centre distance opens the mesh: the normal backlash is {value} mm, above a tenth \
                of the module, {limit} mm"
        );
        Some(Note::new("centre-distance-opens", message))
    } else {
        None
    }
}

/// The tips are so short that contact starts after the pitch point.
fn start_past_pitch(_: &Inputs, solution: &Solution) -> Option<Note> {
    let length = solution.geometry.approach_length;
    let message = || {
        format!(
            "the path of approach is {} mm, below 0: contact starts past the pitch point, at the \
                driven tip without its chamfer",
            four(length * MILLI)
        )
    };
    (length < 0.0).then(|| Note::new("start-past-pitch", message()))
}

/// The driver's tip would touch the driven gear below its base circle.
fn interference_at_end(_: &Inputs, solution: &Solution) -> Option<Note> {
    let rest = solution.geometry.tangent_length - solution.geometry.end;
    let message = || {
        format!(
            "interference at the end of contact: N2B is {} mm and must be above 0",
            four(rest * MILLI)
        )
    };
    (rest <= 0.0).then(|| Note::new("interference-at-end", message()))
}

/// The rack cuts into the driver's flank.
fn undercut_driver(inputs: &Inputs, _: &Solution) -> Option<Note> {
    undercut("driver", inputs, &inputs.driver)
}

/// The rack cuts into the driven gear's flank.
fn undercut_driven(inputs: &Inputs, _: &Solution) -> Option<Note> {
    undercut("driven gear", inputs, &inputs.driven)
}

fn undercut(name: &str, inputs: &Inputs, gear: &Gear) -> Option<Note> {
    let limit = Rack::of(inputs, gear).least_shift();
    let shift = gear.profile_shift;
    let below = shift < limit;
    let limit = four(limit);
    below.then(|| {
        Note::new("undercut", format!(
            "the {name} is undercut: its profile shift is {shift} and should be at least {limit}"))
    })
}

/// The driver's tip is pointed or thin.
fn tip_driver(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    tip("driver", inputs, &inputs.driver, &solution.geometry.driver)
}

/// The driven gear's tip is pointed or thin.
fn tip_driven(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    tip("driven gear", inputs, &inputs.driven, &solution.geometry.driven)
}

fn tip(name: &str, inputs: &Inputs, gear: &Gear, circles: &Circles) -> Option<Note> {
    const THIN: f64 = 0.2;
    let thickness = Profile::of(&Rack::of(inputs, gear), circles).tip_thickness();
    let (value, limit) = (four(thickness * MILLI), four(THIN * inputs.module * MILLI));
    if thickness <= 0.0 {
        Some(Note::new(
            "pointed-tip",
            format!(
                "the {name}'s tip is pointed: its thickness would be {value} mm and must be above 0"
            ),
        ))
    } else if thickness < THIN * inputs.module {
        Some(Note::new(
            "thin-tip",
            format!(
                "the {name}'s tip is thin: {value} mm, below a fifth of the module, {limit} mm"
            ),
        ))
    } else {
        None
    }
}

/// D or E is below the form circle of the driver.
fn form_circle(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let geometry = &solution.geometry;
    let form = Profile::of(&Rack::of(inputs, &inputs.driver), &geometry.driver).form_radius();
    let contact = solution.position.map(|position| ("D", position.contact.radius_driver));
    let start = ("E", geometry.driver.base.hypot(geometry.start));
    let (point, radius) = contact.into_iter().chain([start]).find(|(_, radius)| *radius < form)?;
    let (radius, form) = (distinct_digits(radius, form), distinct_digits(form, radius));
    let message = format!(
        "{point} is below the driver's form circle: O1{point} is {radius} mm and the involute \
            starts at {form} mm"
    );
    Some(Note::new("below-form-circle", message))
}

/// A length in mm with enough digits to distinguish it from another length.
fn distinct_digits(length: f64, other: f64) -> String {
    let digits = 4.0 - ((length - other) * MILLI).abs().log10().floor();
    format!("{:.*}", digits.clamp(4.0, 12.0) as usize - 1, length * MILLI)
}

/// An undercut cuts the driver's teeth through.
fn inertia_driver(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    inertia_of("driver", 0, inputs, solution)
}

/// An undercut cuts the driven gear's teeth through.
fn inertia_driven(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    inertia_of("driven gear", 1, inputs, solution)
}

fn inertia_of(name: &str, gear: usize, inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let is_fallback = solution.kept.masses.inertias[gear].is_fallback
        && inputs.inertia_model() == InertiaModel::Outline;
    is_fallback.then(|| {
        Note::new(
            "inertia-base-circle",
            format!(
                "the inertia of the {name} is that of a disc to its base circle, Eq. 47: the \
                 undercut cuts its teeth through"
            ),
        )
    })
}

/// Both gears have their own base pitch deviations.
fn common_base_pitch(inputs: &Inputs, _: &Solution) -> Option<Note> {
    let common = inputs.base_pitch_deviation;
    let is_used = [&inputs.driver, &inputs.driven]
        .into_iter()
        .any(|gear| inputs.base_pitch_of(gear).1 == Origin::Common);
    (common != 0.0 && !is_used).then(|| {
        Note::new(
            "base-pitch-not-used",
            format!(
                "deviations.base_pitch = {} um is not used: both gears have their own",
                four(common * MICRO)
            ),
        )
    })
}

fn grade_driver(inputs: &Inputs, _: &Solution) -> Option<Note> {
    grade("driver", inputs, &inputs.driver)
}

fn grade_driven(inputs: &Inputs, _: &Solution) -> Option<Note> {
    grade("driven", inputs, &inputs.driven)
}

fn grade(table: &str, inputs: &Inputs, gear: &Gear) -> Option<Note> {
    let grade = gear.grade?;
    if let Some(own) = gear.base_pitch {
        let message = format!(
            "{table}.grade = {grade} is not used: {table}.base_pitch = {} um replaces it",
            four(own * MICRO)
        );
        return Some(Note::new("grade-not-used", message));
    }
    let pitch = inputs.graded_pitch(gear)?;
    let (base_pitch, _) = inputs.base_pitch_of(gear);
    let outside = out_of_range(inputs.module, gear.teeth)
        .map(|range| format!("; the standard covers {range}, and this gear is outside"));
    Some(Note::new(
        "grade",
        format!(
            "{table}.grade = {grade}: ISO 1328-1 gives f_pT = {} um and f_pb = {} um{}",
            tidy(pitch * MICRO, 4),
            four(base_pitch * MICRO),
            outside.unwrap_or_default()
        ),
    ))
}

/// The pair's range determined the model.
fn chosen_by_range(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let used = solution.compliance?.model.model();
    let [first, ..] = preferences(inputs);
    let message = || {
        let why = (first.why_outside)(inputs);
        format!("the tooth compliance is `{}`: {why}", used.name)
    };
    let is_second_choice = inputs.tooth_compliance.is_none() && used.name != first.name;
    is_second_choice.then(|| Note::new(used.chosen, message()))
}

/// The model is used outside its range.
fn outside_range(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let used = solution.compliance?.model.model();
    let (code, message) = (used.outside)(inputs, &solution.geometry)?;
    Some(Note::new(code, message))
}

/// The contact is not small against the tooth.
fn hertz_width(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    const SMALL: f64 = 0.1;
    let half_width = solution.impact?.hertz_half_width();
    let limit = SMALL * inputs.module;
    let message = || {
        format!(
            "the Hertz half-width is {} mm and should be below {} mm, a tenth of the module",
            four(half_width * 1e3),
            four(limit * 1e3)
        )
    };
    (half_width > limit).then(|| Note::new("hertz-width-not-small", message()))
}

/// The model has independent springs although the method supports coupling.
fn without_coupling(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let is_coupled = match solution.method {
        Method::Static | Method::Dynamic => true,
        Method::Exact => inputs.deflection.is_none(),
        Method::Paper | Method::Auto => false,
    };
    let model = model_of(inputs).model();
    let message = || {
        format!(
            "`{}` does not couple neighbouring teeth. Without coupling, the first contact is {} \
                earlier and the peak force changes by {} (elastic field with and without \
                coupling, cases/)",
            model.name, UNCOUPLED.0, UNCOUPLED.1
        )
    };
    (is_coupled && !model.has_coupling).then(|| Note::new("no-coupling", message()))
}

/// Changes of first contact and peak force in `dynamic` without coupling, with finite elements over
/// `cases/`.
const UNCOUPLED: (&str, &str) = ("2 to 13 %", "-12 to +14 %");

/// Some quantities cannot be computed although the tooth strikes.
fn withheld(_: &Inputs, solution: &Solution) -> Option<Note> {
    let refusal = solution.withheld?;
    Some(Note::new(
        refusal.code(),
        format!("{refusal}; force, energy and duration are not computed; {}", refusal.fix()),
    ))
}

/// The force of some stations cannot be computed.
fn stations_left_out(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let refusal = solution.stations_withheld?;
    let message = match inputs.stations {
        _ if solution.method.shares_load() => refusal.to_string(),
        Some(count) => format!(
            "{} of {} stations are omitted: {refusal}",
            count + 1 - solution.stations.len(),
            count + 1
        ),
        None => format!("some stations are omitted: {refusal}"),
    };
    Some(Note::new("stations-left-out", message))
}

/// No contact before E, but slightly more base pitch deviation or load causes corner contact.
///
/// # Formula
/// ```text
/// f_pb,0 = f_pb + g/√2,  reported if f_pb,0 < 1.1 f_pb, or if g < 0.1 δ and the load causes δ
/// ```
/// g is the remaining gap. An increase of √2 f_pb by g closes it, Eqs. 1 and 5; of 2 f_pb if the
/// deviations add as a sum. δ is approximately proportional to the load. If the gears have their
/// own deviations, f_pb is the common deviation with the same effect.
fn barely_clear(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    const CLOSE: f64 = 0.1;
    let clear = solution.margin()?;
    let [now, enough] = [0.0, clear].map(|more| inputs.common_base_pitch(more));
    let is_of_load = solution.method.shares_load() || inputs.deflection.is_none();
    let more_load = Some(clear / solution.deviation.combined_deflection)
        .filter(|part| is_of_load && *part < CLOSE);
    let message = || {
        let (clear, now, enough) = (four(clear * MICRO), four(now * MICRO), four(enough * MICRO));
        let load = more_load
            .map(|part| format!(" or the load rises by about {} %", significant(100.0 * part, 2)));
        let load = load.unwrap_or_default();
        format!(
            "the tooth clears by only {clear} um: it strikes once f_pb exceeds {enough} um (now \
                {now} um){load}"
        )
    };
    (enough < (1.0 + CLOSE) * now || more_load.is_some())
        .then(|| Note::new("barely-clear", message()))
}

/// The printed equations put D so close to E that the tip has closed almost nothing of its gap.
fn gap_left_open(_: &Inputs, solution: &Solution) -> Option<Note> {
    const CLOSED: f64 = 1e-6;
    let (closed, total) = (solution.position?.closed_gap, solution.deviation.total);
    let message = || {
        let (closed, total) = (four(closed * MICRO), four(total * MICRO));
        format!(
            "the printed equations leave the gap open: at D the tip has closed {closed} um of \
                {total} um, so angle, velocity and force are too small; method exact closes the gap"
        )
    };
    (solution.method == Method::Paper && closed < (1.0 - CLOSED) * total)
        .then(|| Note::new("gap-left-open", message()))
}

/// The impact has no end, and therefore no friction ratio.
fn end_not_found(_: &Inputs, solution: &Solution) -> Option<Note> {
    let is_without = solution.friction?.ratio.is_none();
    let message =
        "the friction ratio is not computed: the triangle of Eq. 34 does not close, so the impact \
            has no end D'"
            .to_owned();
    (solution.method == Method::Paper && is_without).then(|| Note::new("no-end-of-impact", message))
}

/// The impact lasts longer than the time from D to E.
fn outlasting(_: &Inputs, solution: &Solution) -> Option<Note> {
    let duration = solution.impact.filter(|_| !solution.method.shares_load())?.duration() * MICRO;
    let transit = solution.velocity?.transit_time * MICRO;
    let message = || {
        let (lasts, way) = (four(duration), four(transit));
        format!(
            "the impact lasts {lasts} us, longer than the {way} us from D to E: it continues in \
                the normal mesh, which this method does not compute"
        )
    };
    (duration > transit).then(|| Note::new("impact-outlasts-approach", message()))
}

/// Force and duration are inconsistent.
fn impulse(_: &Inputs, solution: &Solution) -> Option<Note> {
    const ROUNDING: f64 = 1e-9;
    let ratio = solution.impact?.impulse_ratio();
    let cause = match solution.method {
        Method::Paper if ratio < 1.0 => "Eq. 32 as printed lacks Hertz's prefactor",
        Method::Paper => {
            "Eq. 32 describes two spheres, but the force follows from the tooth stiffness"
        }
        _ => "force and duration do not belong to one impact",
    };
    let possible = 1.0 - ROUNDING..=2.0 + ROUNDING;
    (!possible.contains(&ratio)).then(|| {
        Note::new(
            "impulse-ratio",
            format!("the impulse ratio is {}, outside 1..2: {cause}", four(ratio)),
        )
    })
}

/// The load cannot keep the pair ahead in contact because the error of the incoming tooth is too
/// large.
fn contact_lost(_: &Inputs, solution: &Solution) -> Option<Note> {
    if solution.method.shares_load() {
        return None;
    }
    let deviation = solution.deviation;
    let (deflection, error) =
        (deviation.combined_deflection * MICRO, deviation.equivalent_error * MICRO);
    let message = || {
        let (deflects, error) = (four(deflection), four(error));
        format!(
            "the mesh force deflects the pair {deflects} um, less than the equivalent error of \
                {error} um: the pair ahead loses contact"
        )
    };
    (deflection < error).then(|| Note::new("contact-lost", message()))
}

/// The sliding velocity of the tip changes its sign between D and E.
fn sliding_reverses(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let at_contact = solution.velocity?.sliding;
    let at_start = (inputs.speed + inputs.driven_speed()) * solution.geometry.approach_length;
    let message = || {
        let (at_contact, at_start) = (four(at_contact), four(at_start));
        format!(
            "the sliding velocity changes sign between D ({at_contact} m/s) and E ({at_start} m/s)"
        )
    };
    (at_contact * at_start < 0.0).then(|| Note::new("sliding-reverses", message()))
}

/// The given friction coefficient compared with the stick limit.
fn friction(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let friction = inputs.friction_coefficient?;
    let limit = solution.velocity?.stick_limit;
    let below = friction < limit;
    let limit = four(limit);
    let (code, does) = if below {
        (
            "sliding-throughout",
            format!(
                "below the stick limit {limit}: the tip slides throughout the impact, and the \
                    tangential impulse is {friction} times the normal impulse"
            ),
        )
    } else {
        ("sticking", format!("not below the stick limit {limit}: sliding stops during the impact"))
    };
    Some(Note::new(code, format!("the friction coefficient is {friction}, {does}")))
}

/// The method that `auto` chose and the reason.
fn method_taken(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let choice = solution.choice?;
    let message = if inputs.tooth_compliance.is_none() {
        format!("{choice}; tooth compliance `{}`", model_of(inputs).name())
    } else {
        choice.to_string()
    };
    Some(Note::new("method-taken", message))
}

/// The case gives a deflection that this method computes itself.
fn deflection_ignored(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let given = inputs.deflection.filter(|_| solution.method.shares_load())?;
    let (given, found) = (four(given * 1e6), four(solution.deviation.combined_deflection * 1e6));
    let method = solution.method.name();
    let message = format!(
        "method {method} ignores the given deflection of {given} um and uses its own, {found} um"
    );
    Some(Note::new("deflection-ignored", message))
}

/// The case gives the deflection, so that the load does not affect the impact.
fn deflection_given(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let given = four(inputs.deflection.filter(|_| !solution.method.shares_load())? * 1e6);
    let message = format!(
        "the deflection of {given} um is given: power and torque change only F_0, not D or the \
            impact"
    );
    Some(Note::new("deflection-given", message))
}

/// Method `paper` subtracts a backlash from the equivalent error.
fn backlash_subtracted(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let is_subtracted = solution.method == Method::Paper && inputs.backlash > 0.0;
    let message = || {
        format!(
            "Eq. 1 subtracts the backlash of {} um from Δf; a backlash does not delay a drive flank \
                under load, so the other methods do not",
            four(inputs.backlash * 1e6)
        )
    };
    is_subtracted.then(|| Note::new("backlash-subtracted", message()))
}

/// Base pitch deviations of unlike sign add, although the case asks for independent ones.
fn deviations_added(inputs: &Inputs, _: &Solution) -> Option<Note> {
    let message = || {
        let [driver, driven] = inputs.base_pitches().map(|deviation| four(deviation * 1e6));
        format!(
            "base pitch deviations of unlike sign, {driver} and {driven} um, are known with their \
                signs: they add as a sum"
        )
    };
    (inputs.effective_combination() != inputs.combination)
        .then(|| Note::new("deviations-added", message()))
}

/// For a time, no pair is in contact.
fn lost_in_motion(_: &Inputs, solution: &Solution) -> Option<Note> {
    let lost = solution.dynamic.as_ref()?.contact_lost;
    lost.then(|| {
        Note::new(
            "dynamic-contact-lost",
            "all teeth lose contact for a time: the gears rattle".to_owned(),
        )
    })
}

/// The contact leaves the tip radius at E, and the stiffness of the pair rises in one step.
fn stiffness_step(_: &Inputs, solution: &Solution) -> Option<Note> {
    const LEAST: f64 = 0.02;
    solution.dynamic.as_ref()?.first_contact_angle?;
    let rise = solution.mesh.as_ref()?.stiffness_step() - 1.0;
    let message = || {
        format!(
            "at E the contact passes from the tip radius to the flank, and the stiffness of the pair \
             rises by {} % in one step: so does its force, at any speed; method static has no such step",
            significant(100.0 * rise, 3)
        )
    };
    (rise > LEAST).then(|| Note::new("stiffness-step", message()))
}

/// The back flanks strike.
fn back_strikes(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let steady = solution.steady.as_ref().and_then(|found| found.as_ref().ok());
    let in_steady = steady.and_then(|steady| steady.rattle);
    let in_motion = solution.dynamic.as_ref().and_then(|found| found.rattle);
    let (rattle, when) = match (in_motion, in_steady) {
        (Some(rattle), _) if rattle.strikes > 0 => (rattle, "before the incoming tooth leaves"),
        (_, Some(rattle)) if rattle.strikes > 0 => (rattle, "in the steady motion"),
        _ => return None,
    };
    let (backlash, force) = (four(inputs.backlash * 1e6), four(rattle.force));
    let times = match rattle.strikes {
        1 => "once".to_owned(),
        strikes => format!("{strikes} times"),
    };
    let message = format!(
        "the back flanks strike {times} across the backlash of {backlash} um {when}, with up to \
            {force} N"
    );
    Some(Note::new("back-flank-strikes", message))
}

/// The load changes too fast for a static balance.
fn inertia(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let (Method::Static, Some(mesh), Some(load)) =
        (solution.method, &solution.mesh, &solution.static_load)
    else {
        return None;
    };
    let time = load.first_contact_angle? / inputs.driven_speed();
    let period = std::f64::consts::TAU * (solution.reduced_mass / mesh.mean_stiffness()).sqrt();
    let part = period / (std::f64::consts::PI * time);
    let message = || {
        let (period, time) = (four(period * 1e6), four(time * 1e6));
        format!(
            "method static ignores inertia, which may change the force by {:.0} %: the mesh period \
             is {period} us, and the load on the tooth grows over {time} us",
            100.0 * part.min(1.0)
        )
    };
    (part > inputs.within).then(|| Note::new("inertia", message()))
}

/// The search found no relief without contact before E.
fn not_cleared(_: &Inputs, solution: &Solution) -> Option<Note> {
    let refusal = solution.clearing?.withheld?;
    Some(Note::new(refusal.code(), format!("the required tip relief is unknown: {refusal}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Drive;
    use crate::model::sample::standard_pair;
    use crate::model::stage::Stages;
    use crate::model::{Outcome, solve};

    /// The deviations of Table 1 with a tip relief on the driven gear.
    fn relieved(relief: f64, deviation: f64) -> Inputs {
        let mut inputs = standard_pair(20, 20, 5e-3);
        (inputs.base_pitch_deviation, inputs.deflection) = (deviation, Some(24.7e-6));
        inputs.driven.tip_relief = relief;
        inputs
    }

    fn clears_barely(inputs: &Inputs) -> bool {
        let solution = solve(inputs, Stages::EVERY).unwrap();
        notes(inputs, &solution).iter().any(|note| note.code == "barely-clear")
    }

    /// The pair m 2, z 23/71 with a power in W and a tip relief in m.
    fn of_two_modules(method: Method, power: f64) -> Inputs {
        let mut inputs = standard_pair(23, 71, 2e-3);
        inputs.method = method;
        (inputs.drive, inputs.speed) = (Drive::Power(power), 3000.0 * std::f64::consts::PI / 30.0);
        (inputs.base_pitch_deviation, inputs.deflection) = (9e-6, None);
        inputs
    }

    #[test]
    fn every_method_reports_a_small_clearance_and_the_changes_that_close_it() {
        for method in [Method::Exact, Method::Static, Method::Dynamic] {
            let mut inputs = of_two_modules(method, 4e3);
            let least = solve(&inputs, Stages::EVERY).unwrap().clearing.unwrap().relief.unwrap();
            inputs.driven.tip_relief = 1.002 * least;
            let solution = solve(&inputs, Stages::EVERY).unwrap();
            let clear = solution.margin().unwrap();
            assert!(clear > 0.0 && clear < 0.01 * least, "{method:?}: {clear:e}");
            let text = notes(&inputs, &solution)
                .into_iter()
                .find(|note| note.code == "barely-clear")
                .unwrap()
                .message;
            assert!(
                text.contains("clears by only ") && text.contains("or the load rises by about "),
                "{method:?}: {text}"
            );
            let outcome = |part: f64| {
                let base_pitch_deviation = 9e-6 + part * clear / std::f64::consts::SQRT_2;
                solve(&Inputs { base_pitch_deviation, ..inputs.clone() }, Stages::EVERY)
                    .unwrap()
                    .outcome
            };
            assert_eq!(outcome(1.01), Outcome::CornerContact, "{method:?}");
            assert_eq!(outcome(0.99), Outcome::NoCornerContact, "{method:?}");
            inputs.driven.tip_relief = 1.5 * least;
            assert!(!clears_barely(&inputs), "{method:?}: the clearance is large");
        }
    }

    #[test]
    fn a_small_clearance_is_reported_with_the_deviation_that_causes_contact() {
        assert!(clears_barely(&relieved(48e-6, 16e-6)));
        assert!(!clears_barely(&relieved(47e-6, 16e-6)), "it strikes");
        assert!(!clears_barely(&relieved(60e-6, 16e-6)), "the clearance is large");
        let clear = -solve(&relieved(48e-6, 16e-6), Stages::EVERY).unwrap().deviation.total;
        let enough = 16e-6 + clear / std::f64::consts::SQRT_2;
        assert_eq!(
            solve(&relieved(48e-6, enough * 1.0001), Stages::EVERY).unwrap().outcome,
            Outcome::CornerContact
        );
        assert_eq!(
            solve(&relieved(48e-6, enough * 0.9999), Stages::EVERY).unwrap().outcome,
            Outcome::NoCornerContact
        );
    }
}
