//! Notes beside the results, each with its value and its limit.

use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;

use super::auto::Inertia;
use super::compliance::model_of;
use super::compliance::tooth::preferences;
use super::deviation::earliness;
use super::deviation::{Origin, out_of_range};
use super::explanation::tidy;
use super::geometry::Circles;
use super::inputs::{Gear, InertiaModel, Method};
use super::profile::{Profile, Rack, normal_tip_thickness};
use super::relief::Relief;
use super::{Context, Inputs, Solution};
use crate::numeric::decimal::significant;

/// A note beside the results.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// A short name for scripts.
    pub code: &'static str,
    /// Whether the note is on almost every case by a closed form: JSON has the note; elsewhere it is a
    /// finding of `explain`.
    pub is_general: bool,
    /// One sentence with the value and the limit.
    pub message: String,
    /// What the user of the program can do.
    pub fix: Option<&'static str>,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)?;
        self.fix.map_or(Ok(()), |fix| write!(f, "; {fix}"))
    }
}

impl Note {
    /// A note on this case.
    pub fn case(code: &'static str, message: String) -> Note {
        Note { code, is_general: false, message, fix: None }
    }

    fn general(code: &'static str, message: String) -> Note {
        Note { is_general: true, ..Note::case(code, message) }
    }
}

/// The notes on the results.
pub fn notes(inputs: &Inputs, solution: &Solution) -> Vec<Note> {
    let context = Context { inputs, given: inputs, solution };
    ROWS.iter().filter_map(|row| row(&context)).collect()
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

/// All notes, in order: first that the pair cannot be assembled.
const ROWS: &[fn(&Context) -> Option<Note>] = &[
    |k| {
        let (backlash, part) = backlash(k)?;
        let value = milli(backlash);
        if part < *USUAL_BACKLASH.start() {
            let message = format!(
                "the centre distance jams the mesh: the normal backlash is {value} mm and must not \
                    be below 0"
            );
            return Some(Note::case("centre-distance-jams", message));
        }
        let message = format!(
            "the centre distance opens the mesh: the normal backlash is {value} mm, above a tenth \
                of the module, {} mm",
            milli(USUAL_BACKLASH.end() * k.inputs.module)
        );
        (part > *USUAL_BACKLASH.end()).then_some(Note::case("centre-distance-opens", message))
    },
    |k| {
        let choice = k.solution.choice?;
        let model = || format!("; tooth compliance {}", model_of(k.inputs).name());
        let model = k.inputs.tooth_compliance.map_or_else(model, |_| String::new());
        Some(Note::case("method-taken", format!("{choice}{model}")))
    },
    |k| {
        let given = k.inputs.deflection.filter(|_| k.solution.method.shares_load())?;
        let message = format!(
            "method {} ignores the given deflection of {} um and uses its own, {} um",
            k.solution.method.name(),
            micro(given),
            micro(k.solution.deviation.combined_deflection)
        );
        Some(Note::case("deflection-ignored", message))
    },
    |k| {
        let is_subtracted = k.solution.method == Method::Paper && k.inputs.backlash > 0.0;
        let message = format!(
            "Eq. 1 subtracts the backlash of {} um from Δf; a backlash does not delay a drive flank \
                under load, so the other methods do not",
            micro(k.inputs.backlash)
        );
        is_subtracted.then_some(Note::case("backlash-subtracted", message))
    },
    |k| {
        let is_changed = k.inputs.effective_combination() != k.inputs.combination;
        let [driver, driven] = k.inputs.base_pitches().map(micro);
        let message = format!(
            "base pitch deviations of unlike sign, {driver} and {driven} um, are known with their \
                signs: they add as a sum"
        );
        is_changed.then_some(Note::case("deviations-added", message))
    },
    |k| {
        let message = "all teeth lose contact for a time: the gears rattle".to_owned();
        let is_lost = k.solution.dynamic.as_ref()?.contact_lost;
        is_lost.then_some(Note::case("dynamic-contact-lost", message))
    },
    stiffness_step,
    back_strikes,
    // The search found no relief without contact before E.
    |k| {
        let refusal = k.solution.clearing?.withheld?;
        Some(Note::case(refusal.code(), format!("the required tip relief is unknown: {refusal}")))
    },
    |k| {
        let [period, time, part] = inertia_at_rest(k)?;
        let message = format!(
            "method static ignores inertia, which may change the force by {:.0} %: the natural \
                period of the mesh is {} us, and the load on the tooth grows over {} us",
            100.0 * part.min(1.0),
            micro(period),
            micro(time)
        );
        let is_fast = k.solution.method == Method::Static && part > k.inputs.within;
        // A trial motion measured the effect.
        let tried = k.solution.choice.and_then(|choice| choice.inertia);
        let is_known = matches!(tried, Some(Inertia::Tried(_)));
        (is_fast && !is_known).then_some(Note::case("inertia", message))
    },
    |k| {
        let refusal = k.solution.withheld?;
        let message = format!("{refusal}; force, energy and duration are not computed");
        Some(Note { fix: Some(refusal.fix()), ..Note::case(refusal.code(), message) })
    },
    |k| {
        let refusal = k.solution.stations_withheld?;
        let message = match k.inputs.stations {
            _ if k.solution.method.shares_load() => refusal.to_string(),
            Some(count) => {
                let omitted = count + 1 - k.solution.stations.len();
                format!("{omitted} of {} stations are omitted: {refusal}", count + 1)
            }
            None => format!("some stations are omitted: {refusal}"),
        };
        Some(Note::case("stations-left-out", message))
    },
    barely_clear,
    earliest_on_face,
    strikes_elsewhere,
    long_reliefs,
    |k| {
        let (closed, total) = (k.solution.position?.closed_gap, k.solution.deviation.total);
        let message = format!(
            "the printed equations leave the gap open: at D the tip has closed {} um of {} um, so \
                angle, velocity and force are too small; method exact closes the gap",
            micro(closed),
            micro(total)
        );
        k.solution.leaves_gap_open().then_some(Note::general("gap-left-open", message))
    },
    |k| {
        let impact = k.solution.impact.filter(|_| !k.solution.method.shares_load())?;
        let (duration, transit) = (impact.duration, k.solution.velocity?.transit_time);
        let message = format!(
            "the impact lasts {} us, longer than the {} us from D to E: it continues in the normal \
                mesh, which this method does not compute",
            micro(duration),
            micro(transit)
        );
        (duration > transit).then_some(Note::general("impact-outlasts-approach", message))
    },
    |k| {
        let impact = k.solution.impact?;
        let ratio = impact.impulse_ratio;
        let cause = match k.solution.method {
            Method::Paper if ratio < 1.0 => "Eq. 32 as printed lacks Hertz's prefactor",
            Method::Paper => {
                "Eq. 32 describes two spheres, but the force follows from the tooth stiffness"
            }
            _ => "force and duration do not belong to one impact",
        };
        let message = format!("the impulse ratio is {}, outside 1..2: {cause}", four(ratio));
        (!impact.is_possible()).then_some(Note::general("impulse-ratio", message))
    },
    |k| {
        let deviation = k.solution.deviation;
        let (deflection, error) = (deviation.combined_deflection, deviation.equivalent_error);
        let message = format!(
            "the mesh force deflects the pair {} um, less than the equivalent error of {} um: the \
                pair ahead loses contact",
            micro(deflection),
            micro(error)
        );
        let is_lost = !k.solution.method.shares_load() && deflection < error;
        is_lost.then_some(Note::case("contact-lost", message))
    },
    |k| {
        let [at_contact, at_start] = sliding(k)?;
        let message = format!(
            "the sliding velocity changes sign between D ({} m/s) and E ({} m/s)",
            four(at_contact),
            four(at_start)
        );
        (at_contact * at_start < 0.0).then_some(Note::case("sliding-reverses", message))
    },
    |k| {
        let message =
            "the friction ratio is not computed: the triangle of Eq. 34 does not close, so \
            the impact has no end D'"
                .to_owned();
        let has_none = k.solution.friction?.ratio.is_none();
        let is_printed = k.solution.method == Method::Paper;
        (is_printed && has_none).then_some(Note::general("no-end-of-impact", message))
    },
    |k| {
        let friction = k.inputs.friction_coefficient?;
        let limit = k.solution.velocity?.stick_limit;
        let (code, does) = if friction < limit {
            let does = format!(
                ": the tip slides throughout the impact, and the tangential impulse is {friction} \
                    times the normal impulse"
            );
            ("sliding-throughout", format!("below the stick limit {}{does}", four(limit)))
        } else {
            let does = "sliding stops during the impact";
            ("sticking", format!("not below the stick limit {}: {does}", four(limit)))
        };
        Some(Note::case(code, format!("the friction coefficient is {friction}, {does}")))
    },
    |k| {
        let given = k.inputs.deflection.filter(|_| !k.solution.method.shares_load())?;
        let message = format!(
            "the deflection of {} um is given: power and torque change only F_0, not D or the impact",
            micro(given)
        );
        Some(Note::case("deflection-given", message))
    },
    |k| {
        let common = k.inputs.base_pitch_deviation;
        let is_own = |gear| k.inputs.base_pitch_of(gear).1 != Origin::Common;
        let is_unused = common != 0.0 && is_own(&k.inputs.driver) && is_own(&k.inputs.driven);
        let message = format!(
            "deviations.base_pitch = {} um is not used: both gears have their own",
            micro(common)
        );
        is_unused.then_some(Note::case("base-pitch-not-used", message))
    },
    |k| grade("driver", k, &k.inputs.driver),
    |k| grade("driven", k, &k.inputs.driven),
    |k| inertia_of("driver", 0, k),
    |k| inertia_of("driven gear", 1, k),
    // The pair's range determined the model.
    |k| {
        let used = k.solution.compliance?.model.model();
        let [first, ..] = preferences(k.inputs);
        let message =
            format!("the tooth compliance is `{}`: {}", used.name, (first.why_outside)(k.inputs));
        let is_chosen = k.inputs.tooth_compliance.is_some() || k.inputs.given_compliance.is_some();
        let is_second_choice = !is_chosen && used.name != first.name;
        is_second_choice.then_some(Note::case(used.chosen, message))
    },
    // The model is used outside its range.
    |k| {
        let used = k.solution.compliance?.model.model();
        let (code, message) = (used.outside)(k.inputs, &k.solution.geometry)?;
        Some(Note::case(code, message))
    },
    without_coupling,
    |k| {
        let (half_width, limit) = (k.solution.impact?.hertz_half_width, 0.1 * k.inputs.module);
        let message = format!(
            "the Hertz half-width is {} mm and should be below {} mm, a tenth of the module",
            milli(half_width),
            milli(limit)
        );
        (half_width > limit).then_some(Note::case("hertz-width-not-small", message))
    },
    |k| {
        let ratio = k.solution.geometry.contact_ratio;
        let is_coupled = k.inputs.method != Method::Paper && k.inputs.elasticity().has_neighbours;
        let done = match (k.inputs.given_deflection(), is_coupled) {
            (Some(_), _) => "the case gives the deflection",
            (None, true) => {
                "the pairs ahead of the incoming pair share the load and displace each other"
            }
            (None, false) => {
                "the pairs ahead of the incoming pair share the load as parallel springs"
            }
        };
        let message = format!(
            "the contact ratio is {}, above 2: more than one pair carries the load at F; {done}",
            four(ratio)
        );
        (ratio > 2.0).then_some(Note::case("contact-ratio-above-2", message))
    },
    |k| {
        let ratio = k.solution.geometry.contact_ratio;
        let message = format!(
            "the contact ratio is {}, below 1: at some angles no pair is in contact",
            four(ratio)
        );
        (ratio < 1.0).then_some(Note::case("contact-ratio-below-1", message))
    },
    |k| {
        let length = k.solution.geometry.approach_length;
        let message = format!(
            "the path of approach is {} mm, below 0: contact starts past the pitch point, at the \
                driven tip without its chamfer",
            milli(length)
        );
        (length < 0.0).then_some(Note::case("start-past-pitch", message))
    },
    |k| {
        let rest = k.solution.geometry.tangent_length - k.solution.geometry.end;
        let message = format!(
            "interference at the end of contact: N2B, from the driven base circle to B, is {} mm and must \
                be above 0",
            milli(rest)
        );
        (rest <= 0.0).then_some(Note::case("interference-at-end", message))
    },
    |k| undercut("driver", k, &k.inputs.driver),
    |k| undercut("driven gear", k, &k.inputs.driven),
    |k| tip("driver", k, &k.inputs.driver, &k.solution.geometry.driver),
    |k| tip("driven gear", k, &k.inputs.driven, &k.solution.geometry.driven),
    form_circle,
    |k| {
        let [driver, driven] = k.solution.figures?.tip_clearance;
        let (name, root, least) = if driver < driven {
            ("driver", "driven gear", driver)
        } else {
            ("driven gear", "driver", driven)
        };
        let message = format!(
            "the tip of the {name} runs into the root of the {root}: the tip clearance is {} mm and \
                must be above 0",
            milli(least)
        );
        (least <= 0.0).then_some(Note::case("no-tip-clearance", message))
    },
];

/// The normal backlash of a given centre distance, in m and over the module.
pub(super) fn backlash(k: &Context) -> Option<(f64, f64)> {
    k.inputs.centre_distance?;
    let backlash = k.solution.geometry.backlash(&k.inputs.shape());
    Some((backlash, backlash / k.inputs.module))
}

/// Usual normal backlash over the module. A smaller backlash jams the teeth, a greater one opens the
/// mesh.
pub(super) const USUAL_BACKLASH: RangeInclusive<f64> = -1e-4..=0.1;

/// Least thickness of a tip over the module.
pub(super) const THIN_TIP: f64 = 0.2;

/// Sliding velocity at D and at E, in m/s.
pub(super) fn sliding(k: &Context) -> Option<[f64; 2]> {
    let speeds = k.inputs.speed + k.inputs.driven_speed();
    Some([k.solution.velocity?.sliding, speeds * k.solution.geometry.approach_length])
}

/// The rack cuts into the flank of a gear.
fn undercut(name: &str, k: &Context, gear: &Gear) -> Option<Note> {
    let (shift, limit) = (gear.profile_shift, Rack::of(k.inputs, gear).least_shift());
    let message = format!(
        "the {name} is undercut: its profile shift is {shift} and should be at least {}",
        four(limit)
    );
    (shift < limit).then_some(Note::case("undercut", message))
}

/// The tip of a gear is pointed or thin.
fn tip(name: &str, k: &Context, gear: &Gear, circles: &Circles) -> Option<Note> {
    let thickness = normal_tip_thickness(k.inputs, gear, circles);
    let (value, least) = (milli(thickness), THIN_TIP * k.inputs.module);
    if thickness <= 0.0 {
        let message = format!(
            "the {name}'s tip is pointed: its thickness would be {value} mm and must be above 0"
        );
        return Some(Note::case("pointed-tip", message));
    }
    let limit = milli(least);
    let message =
        format!("the {name}'s tip is thin: {value} mm, below a fifth of the module, {limit} mm");
    (thickness < least).then_some(Note::case("thin-tip", message))
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
    let message = format!(
        "{point} is below the driver's form circle: O1{point} is {} mm and the involute starts at \
            {} mm",
        mm(radius),
        mm(form)
    );
    Some(Note::case("below-form-circle", message))
}

/// The inertia of a gear whose teeth an undercut cuts through.
fn inertia_of(name: &str, gear: usize, k: &Context) -> Option<Note> {
    let is_fallback = k.solution.kept.masses.inertias[gear].is_fallback
        && k.inputs.inertia_model() == InertiaModel::Outline;
    let message = format!(
        "the inertia of the {name} is that of a disc to its base circle, Eq. 47: the undercut cuts \
            its teeth through"
    );
    is_fallback.then_some(Note::case("inertia-base-circle", message))
}

fn grade(table: &str, k: &Context, gear: &Gear) -> Option<Note> {
    let grade = gear.grade?;
    if let Some(own) = gear.base_pitch {
        let message = format!(
            "{table}.grade = {grade} is not used: {table}.base_pitch = {} um replaces it",
            micro(own)
        );
        return Some(Note::case("grade-not-used", message));
    }
    let outside = out_of_range(k.inputs.module, gear.teeth)
        .map(|range| format!("; the standard covers {range}, and this gear is outside"));
    let message = format!(
        "{table}.grade = {grade}: ISO 1328-1 gives f_pT = {} um and f_pb = {} um{}",
        tidy(k.inputs.graded_pitch(gear)? * 1e6, 4),
        micro(k.inputs.base_pitch_of(gear).0),
        outside.unwrap_or_default()
    );
    Some(Note::case("grade", message))
}

/// The pairs are independent springs although the method supports coupling.
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
    let alone = if model.has_coupling {
        "the tooth coupling is off".to_owned()
    } else {
        format!("`{}` does not couple neighbouring teeth", model.name)
    };
    let message = format!(
        "{alone}. Without coupling, the first contact is {} \
            earlier and the peak force changes by {} (finite elements with and without \
            coupling, over the examples)",
        UNCOUPLED.0, UNCOUPLED.1
    );
    (is_coupled && !k.inputs.elasticity().has_neighbours)
        .then_some(Note::case("no-coupling", message))
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
    let part = clear / k.solution.deviation.combined_deflection;
    let is_of_load = k.solution.method.shares_load() || k.inputs.deflection.is_none();
    let has_more_load = is_of_load && part < CLOSE;
    let load = if has_more_load {
        format!(" or the load rises by about {} %", significant(100.0 * part, 2))
    } else {
        String::new()
    };
    let message = format!(
        "the tooth clears by only {} um: it strikes once f_pb exceeds {} um (now {} um){load}",
        micro(clear),
        micro(enough),
        micro(now)
    );
    (enough < (1.0 + CLOSE) * now || has_more_load).then_some(Note::case("barely-clear", message))
}

/// Misalignment and flank lines let the tip touch at one place of the face first.
fn earliest_on_face(k: &Context) -> Option<Note> {
    let ahead = earliness(k.inputs);
    let (_, _, z) = k.inputs.face()?.gaps();
    let message = format!(
        "by misalignment and flank lines the tip is farthest ahead at z = {} mm, by {} um, if the pair ahead \
         touches over the whole face; method static balances the face",
        milli(z),
        micro(ahead)
    );
    (ahead > 0.0).then_some(Note::case("earliest-on-face", message))
}

/// The place of the first contact is not that of the strike.
fn strikes_elsewhere(k: &Context) -> Option<Note> {
    let solution = k.solution;
    let face = solution.face_motion.as_ref().or(solution.face_load.as_ref())?;
    let message = format!(
        "the first contact, at z = {} mm, is {} mm after E; the tip strikes before E at another place of \
         the face, the hardest at z = {} mm",
        milli(face.first.z),
        milli(face.first.path),
        milli(face.before_start?.place.z)
    );
    (face.first.path > 0.0).then_some(Note::case("strikes-elsewhere", message))
}

/// The unrelieved flanks alone do not keep contact.
fn long_reliefs(k: &Context) -> Option<Note> {
    const ROUNDING: f64 = 1e-9;
    let (solution, geometry) = (k.solution, &k.solution.geometry);
    let own = Relief::of(&k.inputs.reliefs(), geometry).unrelieved_contact_ratio(geometry);
    let ratio = own + solution.helix.overlap_ratio;
    let (code, what) = if own <= 0.0 {
        let path = milli(geometry.end - geometry.start);
        let what = format!("the reliefs cover the whole path of contact of {path} mm");
        ("relief-over-whole-path", what)
    } else {
        let ratio = four(ratio);
        let what = format!("the unrelieved flanks alone have a contact ratio of {ratio}, below 1");
        ("unrelieved-contact-ratio", what)
    };
    let message =
        format!("{what}: under light load the pairs change on the reliefs, which raises TE");
    let is_short = own <= 0.0 || ratio < 1.0 - ROUNDING;
    (is_short && solution.method.shares_load()).then_some(Note::case(code, message))
}

/// The contact leaves the tip radius at E, and the stiffness of the pair rises in one step.
fn stiffness_step(k: &Context) -> Option<Note> {
    const LEAST: f64 = 0.02;
    k.solution.dynamic.as_ref()?.first_contact_angle?;
    let rise = k.solution.mesh.as_ref()?.stiffness_step() - 1.0;
    let message = format!(
        "at E the contact passes from the tip radius to the flank, and the stiffness of the pair \
         rises by {} % in one step: so does its force, at any speed; method static has no such step",
        significant(100.0 * rise, 3)
    );
    (rise > LEAST).then_some(Note::case("stiffness-step", message))
}

/// The back flanks strike.
fn back_strikes(k: &Context) -> Option<Note> {
    let steady = k.solution.steady.as_ref().and_then(|found| found.as_ref().ok());
    let in_motion = k.solution.dynamic.as_ref().and_then(|found| found.rattle);
    let all = [
        (in_motion, "before the incoming tooth leaves"),
        (steady.and_then(|steady| steady.rattle), "in the steady motion"),
    ];
    let mut all = all.into_iter().filter_map(|(rattle, when)| Some((rattle?, when)));
    let (rattle, when) = all.find(|(rattle, _)| rattle.strikes > 0)?;
    let times = match rattle.strikes {
        1 => "once".to_owned(),
        strikes => format!("{strikes} times"),
    };
    let message = format!(
        "the back flanks strike {times} across the backlash of {} um {when}, with up to {} N",
        micro(k.inputs.backlash),
        four(rattle.force)
    );
    Some(Note::case("back-flank-strikes", message))
}

/// Period of the mesh and the time in which the load on the incoming tooth grows, in s, and the part
/// of the load that the inertia may then add in method `static`.
pub(super) fn inertia_at_rest(k: &Context) -> Option<[f64; 3]> {
    let angle = k.solution.static_load.as_ref()?.first_contact_angle?;
    // The contact line of a helical tooth grows until its other end is at E.
    let along = k.solution.helix.overlap_ratio;
    let angle = angle + along * TAU / f64::from(k.inputs.driven.teeth);
    let stiffness = k.solution.mesh.as_ref()?.mean_stiffness();
    let time = angle / k.inputs.driven_speed();
    let period = TAU * (k.solution.reduced_mass / stiffness).sqrt();
    Some([period, time, period / (PI * time)])
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

    #[test]
    fn a_note_names_reliefs_that_leave_less_than_a_base_pitch_of_the_path() {
        let of = |length, helix_angle: f64| {
            let mut inputs = Inputs { method: Method::Static, ..relieved(30e-6, 0.0) };
            inputs.driven.tip_relief_length = Some(length);
            inputs.helix_angle = helix_angle;
            let solution = solve(&inputs, Stages::EVERY).unwrap();
            let found = notes(&inputs, &solution).into_iter();
            let mut codes = found.map(|note| note.code).filter(|code| code.contains("relie"));
            codes.next().unwrap_or_default()
        };
        // The path of contact is 22.98 mm long, and the base pitch 14.76 mm.
        assert_eq!([of(8.2e-3, 0.0), of(9e-3, 0.3)], [""; 2]);
        assert_eq!(of(8.3e-3, 0.0), "unrelieved-contact-ratio");
        assert_eq!([of(50e-3, 0.0), of(50e-3, 0.3)], ["relief-over-whole-path"; 2]);
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
