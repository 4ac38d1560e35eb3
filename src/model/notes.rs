//! Notes beside the results, each with its value and its limit.

use std::f64::consts::{PI, TAU};

use super::compliance::model_of;
use super::compliance::tooth::preferences;
use super::deviation::{Origin, out_of_range};
use super::explanation::tidy;
use super::geometry::Circles;
use super::inputs::{Gear, InertiaModel, Method};
use super::profile::{Profile, Rack};
use super::{Context, Inputs, Solution};
use crate::numeric::decimal::significant;

/// A note beside the results.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// A short name for scripts.
    pub code: &'static str,
    /// One sentence with the value and the limit.
    pub message: String,
}

/// A note if its condition is true.
fn note(is_true: bool, code: &'static str, message: impl FnOnce() -> String) -> Option<Note> {
    is_true.then(|| Note { code, message: message() })
}

/// A value with four significant digits.
fn four(value: f64) -> String {
    significant(value, 4)
}

/// A length in mm.
fn milli(value: f64) -> String {
    four(value * 1e3)
}

/// A length in um, or a time in us.
fn micro(value: f64) -> String {
    four(value * 1e6)
}

/// Returns a note if its condition is true.
type Look = fn(&Context) -> Option<Note>;

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
    |k| grade("driver", k, &k.inputs.driver),
    |k| grade("driven", k, &k.inputs.driven),
    |k| inertia_of("driver", 0, k),
    |k| inertia_of("driven gear", 1, k),
    chosen_by_range,
    outside_range,
    without_coupling,
    hertz_width,
    contact_ratio_above_two,
    contact_ratio_below_one,
    centre_distance,
    start_past_pitch,
    interference_at_end,
    |k| undercut("driver", k, &k.inputs.driver),
    |k| undercut("driven gear", k, &k.inputs.driven),
    |k| tip("driver", k, &k.inputs.driver, &k.solution.geometry.driver),
    |k| tip("driven gear", k, &k.inputs.driven, &k.solution.geometry.driven),
    form_circle,
];

/// The notes on the results.
#[must_use]
pub fn notes(inputs: &Inputs, solution: &Solution) -> Vec<Note> {
    let context = Context { inputs, given: inputs, solution };
    LOOKS.iter().filter_map(|look| look(&context)).collect()
}

/// More than two pairs carry the load.
fn contact_ratio_above_two(k: &Context) -> Option<Note> {
    let ratio = k.solution.geometry.contact_ratio;
    let is_coupled = k.inputs.method != Method::Paper && model_of(k.inputs).model().has_coupling;
    let done = match (k.inputs.given_deflection(), is_coupled) {
        (Some(_), _) => "the case gives the deflection",
        (None, true) => {
            "the pairs ahead of the incoming pair share the load and displace each other"
        }
        (None, false) => "the pairs ahead of the incoming pair share the load as parallel springs",
    };
    note(ratio > 2.0, "contact-ratio-above-2", || {
        format!(
            "the contact ratio is {}, above 2: more than one pair carries the load at F; {done}",
            four(ratio)
        )
    })
}

/// At some angles no pair is in contact.
fn contact_ratio_below_one(k: &Context) -> Option<Note> {
    let ratio = k.solution.geometry.contact_ratio;
    note(ratio < 1.0, "contact-ratio-below-1", || {
        format!(
            "the contact ratio is {}, below 1: at some angles no pair is in contact",
            four(ratio)
        )
    })
}

/// A given centre distance jams the teeth or opens the mesh.
fn centre_distance(k: &Context) -> Option<Note> {
    const JAM: f64 = -1e-4;
    const OPEN: f64 = 0.1;
    k.inputs.centre_distance?;
    let module = k.inputs.module;
    let backlash = k.solution.geometry.backlash(&k.inputs.shape());
    let value = milli(backlash);
    let jams = note(backlash < JAM * module, "centre-distance-jams", || {
        format!(
            "the centre distance jams the mesh: the normal backlash is {value} mm and must not be \
                below 0"
        )
    });
    let opens = note(backlash > OPEN * module, "centre-distance-opens", || {
        format!(
            "the centre distance opens the mesh: the normal backlash is {value} mm, above a tenth \
                of the module, {} mm",
            milli(OPEN * module)
        )
    });
    jams.or(opens)
}

/// The tips are so short that contact starts after the pitch point.
fn start_past_pitch(k: &Context) -> Option<Note> {
    let length = k.solution.geometry.approach_length;
    note(length < 0.0, "start-past-pitch", || {
        format!(
            "the path of approach is {} mm, below 0: contact starts past the pitch point, at the \
                driven tip without its chamfer",
            milli(length)
        )
    })
}

/// The driver's tip would touch the driven gear below its base circle.
fn interference_at_end(k: &Context) -> Option<Note> {
    let rest = k.solution.geometry.tangent_length - k.solution.geometry.end;
    note(rest <= 0.0, "interference-at-end", || {
        format!("interference at the end of contact: N2B is {} mm and must be above 0", milli(rest))
    })
}

/// The rack cuts into the flank of a gear.
fn undercut(name: &str, k: &Context, gear: &Gear) -> Option<Note> {
    let (shift, limit) = (gear.profile_shift, Rack::of(k.inputs, gear).least_shift());
    note(shift < limit, "undercut", || {
        let limit = four(limit);
        format!(
            "the {name} is undercut: its profile shift is {shift} and should be at least {limit}"
        )
    })
}

/// The tip of a gear is pointed or thin.
fn tip(name: &str, k: &Context, gear: &Gear, circles: &Circles) -> Option<Note> {
    const THIN: f64 = 0.2;
    let thickness = Profile::of(&Rack::of(k.inputs, gear), circles).tip_thickness();
    let (value, least) = (milli(thickness), THIN * k.inputs.module);
    let pointed = note(thickness <= 0.0, "pointed-tip", || {
        format!(
            "the {name}'s tip is pointed: its thickness would be {value} mm and must be above 0"
        )
    });
    let thin = || {
        note(thickness < least, "thin-tip", || {
            let limit = milli(least);
            format!("the {name}'s tip is thin: {value} mm, below a fifth of the module, {limit} mm")
        })
    };
    pointed.or_else(thin)
}

/// D or E is below the form circle of the driver.
fn form_circle(k: &Context) -> Option<Note> {
    let geometry = &k.solution.geometry;
    let form = Profile::of(&Rack::of(k.inputs, &k.inputs.driver), &geometry.driver).form_radius();
    let contact = k.solution.position.map(|position| ("D", position.contact.radius_driver));
    let start = ("E", geometry.driver.base.hypot(geometry.start));
    let (point, radius) = contact.into_iter().chain([start]).find(|(_, radius)| *radius < form)?;
    // Enough digits to distinguish the two lengths.
    let digits = 4.0 - ((radius - form) * 1e3).abs().log10().floor();
    let mm = |length: f64| format!("{:.*}", digits.clamp(4.0, 12.0) as usize - 1, length * 1e3);
    note(true, "below-form-circle", || {
        format!(
            "{point} is below the driver's form circle: O1{point} is {} mm and the involute starts \
                at {} mm",
            mm(radius),
            mm(form)
        )
    })
}

/// An undercut cuts the teeth of a gear through.
fn inertia_of(name: &str, gear: usize, k: &Context) -> Option<Note> {
    let is_fallback = k.solution.kept.masses.inertias[gear].is_fallback
        && k.inputs.inertia_model() == InertiaModel::Outline;
    note(is_fallback, "inertia-base-circle", || {
        format!(
            "the inertia of the {name} is that of a disc to its base circle, Eq. 47: the undercut \
                cuts its teeth through"
        )
    })
}

/// Both gears have their own base pitch deviations.
fn common_base_pitch(k: &Context) -> Option<Note> {
    let common = k.inputs.base_pitch_deviation;
    let is_own = |gear| k.inputs.base_pitch_of(gear).1 != Origin::Common;
    let is_unused = [&k.inputs.driver, &k.inputs.driven].into_iter().all(is_own);
    note(common != 0.0 && is_unused, "base-pitch-not-used", || {
        format!(
            "deviations.base_pitch = {} um is not used: both gears have their own",
            micro(common)
        )
    })
}

fn grade(table: &str, k: &Context, gear: &Gear) -> Option<Note> {
    let grade = gear.grade?;
    if let Some(own) = gear.base_pitch {
        return note(true, "grade-not-used", || {
            format!(
                "{table}.grade = {grade} is not used: {table}.base_pitch = {} um replaces it",
                micro(own)
            )
        });
    }
    let pitch = k.inputs.graded_pitch(gear)?;
    let (base_pitch, _) = k.inputs.base_pitch_of(gear);
    let outside = out_of_range(k.inputs.module, gear.teeth)
        .map(|range| format!("; the standard covers {range}, and this gear is outside"));
    note(true, "grade", || {
        format!(
            "{table}.grade = {grade}: ISO 1328-1 gives f_pT = {} um and f_pb = {} um{}",
            tidy(pitch * 1e6, 4),
            micro(base_pitch),
            outside.unwrap_or_default()
        )
    })
}

/// The pair's range determined the model.
fn chosen_by_range(k: &Context) -> Option<Note> {
    let used = k.solution.compliance?.model.model();
    let [first, ..] = preferences(k.inputs);
    let is_second_choice = k.inputs.tooth_compliance.is_none() && used.name != first.name;
    note(is_second_choice, used.chosen, || {
        format!("the tooth compliance is `{}`: {}", used.name, (first.why_outside)(k.inputs))
    })
}

/// The model is used outside its range.
fn outside_range(k: &Context) -> Option<Note> {
    let used = k.solution.compliance?.model.model();
    let (code, message) = (used.outside)(k.inputs, &k.solution.geometry)?;
    Some(Note { code, message })
}

/// The contact is not small against the tooth.
fn hertz_width(k: &Context) -> Option<Note> {
    const SMALL: f64 = 0.1;
    let half_width = k.solution.impact?.hertz_half_width();
    let limit = SMALL * k.inputs.module;
    note(half_width > limit, "hertz-width-not-small", || {
        format!(
            "the Hertz half-width is {} mm and should be below {} mm, a tenth of the module",
            milli(half_width),
            milli(limit)
        )
    })
}

/// The model has independent springs although the method supports coupling.
fn without_coupling(k: &Context) -> Option<Note> {
    /// Changes of first contact and peak force in `dynamic` without coupling, with finite elements
    /// over `cases/`.
    const UNCOUPLED: (&str, &str) = ("2 to 13 %", "-12 to +14 %");
    let is_coupled = match k.solution.method {
        Method::Static | Method::Dynamic => true,
        Method::Exact => k.inputs.deflection.is_none(),
        Method::Paper | Method::Auto => false,
    };
    let model = model_of(k.inputs).model();
    note(is_coupled && !model.has_coupling, "no-coupling", || {
        format!(
            "`{}` does not couple neighbouring teeth. Without coupling, the first contact is {} \
                earlier and the peak force changes by {} (elastic field with and without \
                coupling, cases/)",
            model.name, UNCOUPLED.0, UNCOUPLED.1
        )
    })
}

/// Some quantities cannot be computed although the tooth strikes.
fn withheld(k: &Context) -> Option<Note> {
    let refusal = k.solution.withheld?;
    note(true, refusal.code(), || {
        format!("{refusal}; force, energy and duration are not computed; {}", refusal.fix())
    })
}

/// The force of some stations cannot be computed.
fn stations_left_out(k: &Context) -> Option<Note> {
    let refusal = k.solution.stations_withheld?;
    note(true, "stations-left-out", || match k.inputs.stations {
        _ if k.solution.method.shares_load() => refusal.to_string(),
        Some(count) => format!(
            "{} of {} stations are omitted: {refusal}",
            count + 1 - k.solution.stations.len(),
            count + 1
        ),
        None => format!("some stations are omitted: {refusal}"),
    })
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
fn barely_clear(k: &Context) -> Option<Note> {
    const CLOSE: f64 = 0.1;
    let clear = k.solution.margin()?;
    let [now, enough] = [0.0, clear].map(|more| k.inputs.common_base_pitch(more));
    let is_of_load = k.solution.method.shares_load() || k.inputs.deflection.is_none();
    let more_load = Some(clear / k.solution.deviation.combined_deflection)
        .filter(|part| is_of_load && *part < CLOSE);
    note(enough < (1.0 + CLOSE) * now || more_load.is_some(), "barely-clear", || {
        let (clear, now, enough) = (micro(clear), micro(now), micro(enough));
        let load = more_load
            .map(|part| format!(" or the load rises by about {} %", significant(100.0 * part, 2)));
        let load = load.unwrap_or_default();
        format!(
            "the tooth clears by only {clear} um: it strikes once f_pb exceeds {enough} um (now \
                {now} um){load}"
        )
    })
}

/// The printed equations put D so close to E that the tip has closed almost nothing of its gap.
fn gap_left_open(k: &Context) -> Option<Note> {
    const CLOSED: f64 = 1e-6;
    let (closed, total) = (k.solution.position?.closed_gap, k.solution.deviation.total);
    let is_open = k.solution.method == Method::Paper && closed < (1.0 - CLOSED) * total;
    note(is_open, "gap-left-open", || {
        let (closed, total) = (micro(closed), micro(total));
        format!(
            "the printed equations leave the gap open: at D the tip has closed {closed} um of \
                {total} um, so angle, velocity and force are too small; method exact closes the gap"
        )
    })
}

/// The impact has no end, and therefore no friction ratio.
fn end_not_found(k: &Context) -> Option<Note> {
    let is_without = k.solution.friction?.ratio.is_none();
    note(k.solution.method == Method::Paper && is_without, "no-end-of-impact", || {
        "the friction ratio is not computed: the triangle of Eq. 34 does not close, so the impact \
            has no end D'"
            .to_owned()
    })
}

/// The impact lasts longer than the time from D to E.
fn outlasting(k: &Context) -> Option<Note> {
    let impact = k.solution.impact.filter(|_| !k.solution.method.shares_load())?;
    let (duration, transit) = (impact.duration(), k.solution.velocity?.transit_time);
    note(duration > transit, "impact-outlasts-approach", || {
        format!(
            "the impact lasts {} us, longer than the {} us from D to E: it continues in the normal \
                mesh, which this method does not compute",
            micro(duration),
            micro(transit)
        )
    })
}

/// Force and duration are inconsistent.
fn impulse(k: &Context) -> Option<Note> {
    const ROUNDING: f64 = 1e-9;
    let ratio = k.solution.impact?.impulse_ratio();
    let cause = match k.solution.method {
        Method::Paper if ratio < 1.0 => "Eq. 32 as printed lacks Hertz's prefactor",
        Method::Paper => {
            "Eq. 32 describes two spheres, but the force follows from the tooth stiffness"
        }
        _ => "force and duration do not belong to one impact",
    };
    let possible = 1.0 - ROUNDING..=2.0 + ROUNDING;
    note(!possible.contains(&ratio), "impulse-ratio", || {
        format!("the impulse ratio is {}, outside 1..2: {cause}", four(ratio))
    })
}

/// The load cannot keep the pair ahead in contact because the error of the incoming tooth is too
/// large.
fn contact_lost(k: &Context) -> Option<Note> {
    let deviation = k.solution.deviation;
    let (deflection, error) = (deviation.combined_deflection, deviation.equivalent_error);
    note(!k.solution.method.shares_load() && deflection < error, "contact-lost", || {
        format!(
            "the mesh force deflects the pair {} um, less than the equivalent error of {} um: the \
                pair ahead loses contact",
            micro(deflection),
            micro(error)
        )
    })
}

/// The sliding velocity of the tip changes its sign between D and E.
fn sliding_reverses(k: &Context) -> Option<Note> {
    let at_contact = k.solution.velocity?.sliding;
    let at_start = (k.inputs.speed + k.inputs.driven_speed()) * k.solution.geometry.approach_length;
    note(at_contact * at_start < 0.0, "sliding-reverses", || {
        let (at_contact, at_start) = (four(at_contact), four(at_start));
        format!(
            "the sliding velocity changes sign between D ({at_contact} m/s) and E ({at_start} m/s)"
        )
    })
}

/// The given friction coefficient compared with the stick limit.
fn friction(k: &Context) -> Option<Note> {
    let friction = k.inputs.friction_coefficient?;
    let limit = k.solution.velocity?.stick_limit;
    let slides = friction < limit;
    let (limit, code) = (four(limit), if slides { "sliding-throughout" } else { "sticking" });
    note(true, code, || {
        let does = if slides {
            format!(
                "below the stick limit {limit}: the tip slides throughout the impact, and the \
                    tangential impulse is {friction} times the normal impulse"
            )
        } else {
            format!("not below the stick limit {limit}: sliding stops during the impact")
        };
        format!("the friction coefficient is {friction}, {does}")
    })
}

/// The method that `auto` chose and the reason.
fn method_taken(k: &Context) -> Option<Note> {
    let choice = k.solution.choice?;
    note(true, "method-taken", || match k.inputs.tooth_compliance {
        None => format!("{choice}; tooth compliance `{}`", model_of(k.inputs).name()),
        Some(_) => choice.to_string(),
    })
}

/// The case gives a deflection that this method computes itself.
fn deflection_ignored(k: &Context) -> Option<Note> {
    let given = k.inputs.deflection.filter(|_| k.solution.method.shares_load())?;
    note(true, "deflection-ignored", || {
        format!(
            "method {} ignores the given deflection of {} um and uses its own, {} um",
            k.solution.method.name(),
            micro(given),
            micro(k.solution.deviation.combined_deflection)
        )
    })
}

/// The case gives the deflection, so that the load does not affect the impact.
fn deflection_given(k: &Context) -> Option<Note> {
    let given = k.inputs.deflection.filter(|_| !k.solution.method.shares_load())?;
    note(true, "deflection-given", || {
        format!(
            "the deflection of {} um is given: power and torque change only F_0, not D or the \
                impact",
            micro(given)
        )
    })
}

/// Method `paper` subtracts a backlash from the equivalent error.
fn backlash_subtracted(k: &Context) -> Option<Note> {
    let is_subtracted = k.solution.method == Method::Paper && k.inputs.backlash > 0.0;
    note(is_subtracted, "backlash-subtracted", || {
        format!(
            "Eq. 1 subtracts the backlash of {} um from Δf; a backlash does not delay a drive flank \
                under load, so the other methods do not",
            micro(k.inputs.backlash)
        )
    })
}

/// Base pitch deviations of unlike sign add, although the case asks for independent ones.
fn deviations_added(k: &Context) -> Option<Note> {
    let is_changed = k.inputs.effective_combination() != k.inputs.combination;
    note(is_changed, "deviations-added", || {
        let [driver, driven] = k.inputs.base_pitches().map(micro);
        format!(
            "base pitch deviations of unlike sign, {driver} and {driven} um, are known with their \
                signs: they add as a sum"
        )
    })
}

/// For a time, no pair is in contact.
fn lost_in_motion(k: &Context) -> Option<Note> {
    note(k.solution.dynamic.as_ref()?.contact_lost, "dynamic-contact-lost", || {
        "all teeth lose contact for a time: the gears rattle".to_owned()
    })
}

/// The contact leaves the tip radius at E, and the stiffness of the pair rises in one step.
fn stiffness_step(k: &Context) -> Option<Note> {
    const LEAST: f64 = 0.02;
    k.solution.dynamic.as_ref()?.first_contact_angle?;
    let rise = k.solution.mesh.as_ref()?.stiffness_step() - 1.0;
    note(rise > LEAST, "stiffness-step", || {
        format!(
            "at E the contact passes from the tip radius to the flank, and the stiffness of the pair \
             rises by {} % in one step: so does its force, at any speed; method static has no such step",
            significant(100.0 * rise, 3)
        )
    })
}

/// The back flanks strike.
fn back_strikes(k: &Context) -> Option<Note> {
    let steady = k.solution.steady.as_ref().and_then(|found| found.as_ref().ok());
    let in_steady = steady.and_then(|steady| steady.rattle);
    let in_motion = k.solution.dynamic.as_ref().and_then(|found| found.rattle);
    let (rattle, when) = match (in_motion, in_steady) {
        (Some(rattle), _) if rattle.strikes > 0 => (rattle, "before the incoming tooth leaves"),
        (_, Some(rattle)) if rattle.strikes > 0 => (rattle, "in the steady motion"),
        _ => return None,
    };
    let times = match rattle.strikes {
        1 => "once".to_owned(),
        strikes => format!("{strikes} times"),
    };
    note(true, "back-flank-strikes", || {
        format!(
            "the back flanks strike {times} across the backlash of {} um {when}, with up to {} N",
            micro(k.inputs.backlash),
            four(rattle.force)
        )
    })
}

/// Period of the mesh and the time in which the load on the incoming tooth grows, in s, and the part
/// of the load that the inertia may then add in method `static`.
pub(super) fn inertia_at_rest(k: &Context) -> Option<[f64; 3]> {
    let angle = k.solution.static_load.as_ref()?.first_contact_angle?;
    let stiffness = k.solution.mesh.as_ref()?.mean_stiffness();
    let time = angle / k.inputs.driven_speed();
    let period = TAU * (k.solution.reduced_mass / stiffness).sqrt();
    Some([period, time, period / (PI * time)])
}

/// The load changes too fast for a static balance.
fn inertia(k: &Context) -> Option<Note> {
    let [period, time, part] = inertia_at_rest(k)?;
    note(k.solution.method == Method::Static && part > k.inputs.within, "inertia", || {
        format!(
            "method static ignores inertia, which may change the force by {:.0} %: the mesh period \
             is {} us, and the load on the tooth grows over {} us",
            100.0 * part.min(1.0),
            micro(period),
            micro(time)
        )
    })
}

/// The search found no relief without contact before E.
fn not_cleared(k: &Context) -> Option<Note> {
    let refusal = k.solution.clearing?.withheld?;
    note(true, refusal.code(), || format!("the required tip relief is unknown: {refusal}"))
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
