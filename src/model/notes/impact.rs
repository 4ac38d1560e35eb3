//! Notes on the impact.

use super::{Note, four};
use crate::model::inputs::Method;
use crate::model::{Inputs, Solution};
use crate::numeric::decimal::significant;

const MICRO: f64 = 1e6;

/// Some quantities cannot be computed although the tooth strikes.
pub(super) fn withheld(_: &Inputs, solution: &Solution) -> Option<Note> {
    let refusal = solution.withheld?;
    Some(Note::new(
        refusal.code(),
        format!("{refusal}; force, energy and duration are not computed; {}", refusal.fix()),
    ))
}

/// The force of some stations cannot be computed.
pub(super) fn stations_left_out(inputs: &Inputs, solution: &Solution) -> Option<Note> {
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
pub(super) fn barely_clear(inputs: &Inputs, solution: &Solution) -> Option<Note> {
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
pub(super) fn gap_left_open(_: &Inputs, solution: &Solution) -> Option<Note> {
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
pub(super) fn end_not_found(_: &Inputs, solution: &Solution) -> Option<Note> {
    let is_without = solution.friction?.ratio.is_none();
    let message =
        "the friction ratio is not computed: the triangle of Eq. 34 does not close, so the impact \
            has no end D'"
            .to_owned();
    (solution.method == Method::Paper && is_without).then(|| Note::new("no-end-of-impact", message))
}

/// The impact lasts longer than the time from D to E.
pub(super) fn outlasting(_: &Inputs, solution: &Solution) -> Option<Note> {
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
pub(super) fn impulse(_: &Inputs, solution: &Solution) -> Option<Note> {
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
pub(super) fn contact_lost(_: &Inputs, solution: &Solution) -> Option<Note> {
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
pub(super) fn sliding_reverses(inputs: &Inputs, solution: &Solution) -> Option<Note> {
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
pub(super) fn friction(inputs: &Inputs, solution: &Solution) -> Option<Note> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Drive;
    use crate::model::sample::standard_pair;
    use crate::model::stage::Stages;
    use crate::model::{Outcome, notes, solve};

    /// The deviations of Table 1 with a tip relief on the driven gear.
    fn relieved(relief: f64, deviation: f64) -> Inputs {
        let mut inputs = standard_pair(20, 20, 5e-3);
        (inputs.base_pitch_deviation, inputs.deflection) = (deviation, Some(24.7e-6));
        inputs.driven.tip_relief = relief;
        inputs
    }

    fn clears_barely(inputs: &Inputs) -> bool {
        let solution = solve(inputs, Stages::EVERY).unwrap();
        notes::notes(inputs, &solution).iter().any(|note| note.code == "barely-clear")
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
            let text = notes::notes(&inputs, &solution)
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
