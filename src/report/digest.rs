//! Sentences about a solved case: summary, other methods, relief, mesh frequency and resonance.

use super::absence::{listed, without_contact_in_full};
use super::verdict::{self, Standing};
use super::{shown_in, value};
use crate::case::Case;
use crate::case::fields::index_of;
use crate::case::sanitize::sanitize;
use crate::case::units::{self, System};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Outcome, Quantity, Refusal, Solution};
use crate::numeric::decimal::significant;

/// A summary of a case, sanitized for a terminal.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Digest {
    /// Its title; empty without one.
    pub title: String,
    /// Numbers of teeth, module, pressure angle, face width.
    pub pair: String,
    /// Power or torque, and speed.
    pub load: String,
    /// The method, with the method that `auto` chose.
    pub method: String,
    /// The outcome as a sentence, or the refusal of the model.
    pub outcome: String,
    /// The outcome as a short phrase.
    pub short: String,
    /// The standing of each limit with its sentence.
    pub limits: Vec<(Standing, String)>,
    /// Notes on the result.
    pub notes: Vec<String>,
}

impl Digest {
    /// The digest of a case from its solution or refusal.
    #[must_use]
    pub fn of(
        case: &Case,
        inputs: &Inputs,
        found: Result<&Solution, &Refusal>,
        system: System,
    ) -> Digest {
        let (verdicts, method, outcome, short) = match found {
            Ok(solution) => (
                verdict::verdicts(case, solution),
                method(inputs.method, solution),
                sentence(solution, system),
                short(solution, system),
            ),
            Err(refusal) => (
                verdict::refused(case, refusal),
                inputs.method.name().to_owned(),
                format!("Not solved: {refusal}; {}.", refusal.fix()),
                "not solved".to_owned(),
            ),
        };
        let limits = verdicts.iter().map(|limit| (limit.standing, limit.sentence(system)));
        let notes = found.map(|solution| model::notes(inputs, solution)).unwrap_or_default();
        Digest {
            title: text(case, "title"),
            pair: pair(case),
            load: load(case),
            method,
            outcome,
            short,
            limits: limits.collect(),
            notes: notes.into_iter().map(|note| note.message).collect(),
        }
    }

    /// Outcome and limits in one line.
    #[must_use]
    pub fn verdict(&self) -> String {
        match self.limits.len() {
            0 => self.short.clone(),
            _ => format!("{}; {}", self.short, self.of_limits()),
        }
    }

    /// The number of limits that are met, as text.
    #[must_use]
    pub fn of_limits(&self) -> String {
        let count = self.limits.len();
        let limits = if count == 1 { "1 limit".to_owned() } else { format!("{count} limits") };
        let missed = |standing| self.limits.iter().filter(|(own, _)| *own == standing).count();
        match (missed(Standing::Exceeded), missed(Standing::Unknown)) {
            _ if count == 0 => "no limits".to_owned(),
            (0, 0) if count == 1 => "limit met".to_owned(),
            (0, 0) => format!("{limits} met"),
            (0, unknown) => format!("{unknown} of {limits} unknown"),
            (exceeded, _) => format!("{exceeded} of {limits} EXCEEDED"),
        }
    }
}

/// The outcome of a solve as a sentence; angle and forces if their stages ran.
#[must_use]
pub fn sentence(solution: &Solution, system: System) -> String {
    let overall = peak(solution, system);
    if solution.outcome == Outcome::NoCornerContact {
        let why = without_contact_in_full(solution, system);
        let peak = overall.map_or_else(String::new, |peak| format!("; peak force {peak}"));
        return format!("No corner contact: {why}{peak}.");
    }
    let angle = own("approach_angle_driver", solution, system)
        .map(|(quantity, angle)| format!("{} = {angle} before E", quantity.symbol));
    let force = own("impact_force", solution, system).and_then(|(_, force)| {
        Some(match solution.method {
            Method::Static => format!("force {force} at E, {} overall", overall?),
            Method::Dynamic => format!("peak force {force} before E, {} overall", overall?),
            _ => format!("impact force {force}"),
        })
    });
    let found: Vec<String> = angle.into_iter().chain(force).collect();
    format!("{}.", with_parts("Corner contact", &found.join("; ")))
}

/// The outcome as a short phrase with the forces of [`sentence`].
#[must_use]
pub fn short(solution: &Solution, system: System) -> String {
    let overall = peak(solution, system).map(|overall| format!("{overall} overall"));
    if solution.outcome == Outcome::NoCornerContact {
        return with_parts("no corner contact", &overall.unwrap_or_default());
    }
    // Without its own force the overall force is not shown.
    let forces = own("impact_force", solution, system)
        .map(|(_, force)| [force].into_iter().chain(overall).collect::<Vec<_>>().join(", "));
    with_parts("corner contact", &forces.unwrap_or_default())
}

fn with_parts(outcome: &str, parts: &str) -> String {
    let colon = if parts.is_empty() { "" } else { ": " };
    format!("{outcome}{colon}{parts}")
}

/// The greatest force of a tooth, with or without contact before E; the closed forms have none.
fn peak(solution: &Solution, system: System) -> Option<String> {
    let key = match solution.method {
        Method::Static => "static_peak_force",
        Method::Dynamic => "dynamic_peak_force",
        Method::Paper | Method::Exact | Method::Auto => return None,
    };
    printed(Quantity::find(key)?, solution, system)
}

/// A quantity of the free impact, or its counterpart in the method, with its value.
fn own(key: &str, solution: &Solution, system: System) -> Option<(&'static Quantity, String)> {
    let quantity = Quantity::find(key)?.by(solution.method)?;
    Some((quantity, printed(quantity, solution, system)?))
}

fn printed(quantity: &Quantity, solution: &Solution, system: System) -> Option<String> {
    Some(shown_in(quantity, value(quantity, solution)?, system).to_string())
}

fn method(asked: Method, solution: &Solution) -> String {
    if asked == solution.method {
        asked.name().to_owned()
    } else {
        format!("{}, chosen by {}", solution.method.name(), asked.name())
    }
}

fn pair(case: &Case) -> String {
    let teeth = format!("z {}/{}", text(case, "driver.teeth"), text(case, "driven.teeth"));
    let width = match (text(case, "driver.face_width"), text(case, "driven.face_width")) {
        (one, other) if one == other => one,
        (one, other) => format!("{one}/{other}"),
    };
    format!("{teeth}, {}, α {}, b {width}", size(case), text(case, "pair.pressure_angle"))
}

/// Module or diametral pitch, whichever the case gives.
fn size(case: &Case) -> String {
    let pitch = text(case, "pair.diametral_pitch");
    if pitch.is_empty() {
        format!("m {}", text(case, "pair.module"))
    } else {
        format!("Pd {pitch}")
    }
}

fn load(case: &Case) -> String {
    let load = ["operation.power", "operation.torque"].map(|key| text(case, key));
    let load = load.into_iter().find(|text| !text.is_empty()).unwrap_or_default();
    format!("{load} at {}", text(case, "operation.speed"))
}

fn text(case: &Case, key: &str) -> String {
    index_of(key).and_then(|field| case.effective(field)).map(sanitize).unwrap_or_default()
}

/// A note if other methods find another outcome: which methods, and why the governing method
/// counts.
#[must_use]
pub fn differing(governing: &Solution, others: &[&Solution]) -> Option<String> {
    let differs = |other: &&&Solution| other.outcome != governing.outcome;
    let names: Vec<&str> = others.iter().filter(differs).map(|other| other.method.name()).collect();
    let find = if names.len() == 1 { "finds" } else { "find" };
    let found = match governing.outcome {
        Outcome::CornerContact => "no corner contact",
        Outcome::NoCornerContact => "corner contact",
    };
    let (own, names) = (governing.method.name(), (!names.is_empty()).then(|| listed(&names))?);
    let chosen = if governing.choice.is_some() { "auto chose it" } else { "the case selects it" };
    let why = match governing.method {
        Method::Dynamic => ", and it includes inertia",
        Method::Static => ", and it shares the load among all pairs",
        Method::Paper | Method::Exact | Method::Auto => "",
    };
    Some(format!("{names} {find} {found}; {own} governs: {chosen}{why}"))
}

/// The results of the closed forms beside a method that resolves the impact, or of the other closed
/// form, in one line.
#[must_use]
pub fn closed_forms(
    governing: &Solution,
    others: &[&Solution],
    is_deflection_given: bool,
    system: System,
) -> Option<String> {
    let found = others.iter().filter(|other| !other.method.shares_load());
    let found: Vec<String> = found.filter_map(|other| closed_form(other, system)).collect();
    let what = match (governing.method.shares_load(), found.len()) {
        (_, 0) => return None,
        (true, _) if is_deflection_given => "Free impact with the given deflection",
        (true, _) => "Free impact",
        (false, 1) => "Other method",
        (false, _) => "Other methods",
    };
    Some(format!("{what}: {}", found.join("; ")))
}

fn closed_form(solution: &Solution, system: System) -> Option<String> {
    let shown = |key| printed(Quantity::find(key)?, solution, system);
    let method = solution.method.name();
    Some(match solution.outcome {
        Outcome::NoCornerContact => {
            format!("{method} no corner contact, Δ = {}", shown("total_deviation")?)
        }
        Outcome::CornerContact => {
            let (quantity, angle) = own("approach_angle_driver", solution, system)?;
            format!("{method} {} at {} = {angle}", shown("impact_force")?, quantity.symbol)
        }
    })
}

/// Significant digits of the additional relief.
const RELIEF_DIGITS: i32 = 3;
/// Its unit.
const RELIEF_UNIT: &str = "um";

/// The required tip relief of the driven gear by the governing method and by the others; `None`
/// without corner contact, or if the relief is unknown.
#[must_use]
pub fn relief(governing: &Solution, others: &[&Solution], system: System) -> Option<String> {
    let (given, [more, all]) = figures(governing, system)?;
    let others = others.iter().filter_map(|other| {
        let (_, [more, _]) = figures(other, system)?;
        Some(format!(", {} {more}", other.method.name()))
    });
    let more = more + &others.collect::<String>();
    Some(required(governing.method, given, [&more, &all], system))
}

/// The same text while the relief of the method is not known yet; `given` is the present relief of
/// the gear, in m.
#[must_use]
pub fn pending(method: Method, given: f64, system: System) -> String {
    required(method, given, ["...", "..."], system)
}

fn required(method: Method, given: f64, [more, all]: [&str; 2], system: System) -> String {
    let (method, unit) = (method.name(), system.unit(RELIEF_UNIT));
    if given > 0.0 {
        format!(
            "Required additional tip relief, driven gear: {method} {more} {unit}; total {all} {unit}"
        )
    } else {
        format!("Required tip relief of the driven gear: {method} {more} {unit}")
    }
}

/// The present relief of the gear, in m, with the additional and the total relief as text.
fn figures(solution: &Solution, system: System) -> Option<(f64, [String; 2])> {
    let least = value(Quantity::find("clearing_relief")?, solution)?;
    let given = solution.clearing?.given;
    Some((given, rounded_up(least, given, system)))
}

/// The additional and the total relief, rounded up to the same digit, so that the given and the
/// additional relief add up to at least the total.
fn rounded_up(least: f64, given: f64, system: System) -> [String; 2] {
    /// Rounding error of the factor of the unit and of the sum.
    const ROUNDING: f64 = 1.0 + 4.0 * f64::EPSILON;
    /// The fraction of a digit that is rounding error.
    const NONE: f64 = 1e-9;
    let factor = units::factor(system.unit(RELIEF_UNIT)).unwrap_or(1.0);
    // Decimal places of um and of thou.
    let last = if system == System::Inch { 4 } else { 3 };
    let before_point = (least / factor).log10().floor() as i32 + 1;
    let digits = (RELIEF_DIGITS - before_point).clamp(0, last);
    let scale = 10f64.powi(digits);
    let all = ((least + given) * ROUNDING / factor * scale).ceil();
    let more = (all - given / factor * scale - NONE).ceil();
    let digits = usize::try_from(digits).unwrap_or(0);
    [more, all].map(|number| format!("{:.digits$}", number / scale))
}

/// Significant digits of a frequency or a speed.
const FREQUENCY_DIGITS: usize = 3;

/// The mesh frequency, the greatest dynamic factor over the speed, and the speed of N = 1; `None` if
/// the method has no mesh.
#[must_use]
pub fn whine(solution: &Solution) -> Option<String> {
    let of = |key| value(Quantity::find(key)?, solution);
    let rpm = |speed: f64| rounded(speed * 30.0 / std::f64::consts::PI);
    let (frequency, ratio) =
        (rounded(of("mesh_frequency")?), significant(of("resonance_ratio")?, 2));
    let speed = rpm(of("resonance_speed")?);
    let resonance = format!("N = 1 of the mean stiffness at {speed} rpm (now N = {ratio})");
    let at =
        |speed, factor| Some(format!("{} at {} rpm", significant(of(factor)?, 3), rpm(of(speed)?)));
    let rising = at("resonance_peak_speed", "resonance_peak_factor");
    let falling = at("resonance_peak_speed_falling", "resonance_peak_factor_falling");
    let Some((rising, falling)) = rising.zip(falling) else {
        return Some(format!("Mesh frequency {frequency} Hz; {resonance}"));
    };
    let falling =
        if rising == falling { String::new() } else { format!(" rising, {falling} falling") };
    Some(format!(
        "Greatest dynamic factor {rising}{falling}; mesh frequency {frequency} Hz, {resonance}"
    ))
}

/// A number with three significant digits, followed by zeros.
pub(super) fn rounded(number: f64) -> String {
    let rounded = format!("{number:.*e}", FREQUENCY_DIGITS - 1);
    match rounded.parse::<f64>() {
        Ok(rounded) if rounded >= 1e3 => format!("{rounded:.0}"),
        _ => significant(number, FREQUENCY_DIGITS),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::EXAMPLES;
    use crate::model::Stage;
    use crate::model::Stages;
    use crate::model::sample::standard_pair;
    use crate::report::solve;

    fn digest(text: &[(&str, &str)]) -> Digest {
        let mut case = Case::table_1();
        for (key, value) in text {
            case.set(key, value).unwrap();
        }
        solve::digest(&case, &case.inputs().unwrap(), System::Metric, &|_| true).unwrap()
    }

    #[test]
    fn a_digest_summarizes_a_case_in_a_few_lines() {
        let digest = digest(&[]);
        assert_eq!(
            (digest.pair.as_str(), digest.load.as_str()),
            ("z 20/20, m 5 mm, α 20 deg, b 8 mm", "15 kW at 2000 rpm")
        );
        assert_eq!(
            digest.outcome,
            "Corner contact: θ_1 = 1.366 deg before E; impact force 2191.0 N."
        );
        assert_eq!(digest.verdict(), "corner contact: 2191.0 N; limit met");
        assert_eq!(digest.method, "exact");
        assert!(!digest.notes.is_empty());
    }

    #[test]
    fn a_digest_reports_exceeded_limits_and_missing_contact() {
        assert_eq!(
            digest(&[("limits.impact_force", "2 kN")]).verdict(),
            "corner contact: 2191.0 N; 1 of 1 limit EXCEEDED"
        );
        let relieved = digest(&[("driven.tip_relief", "80 um"), ("limits.impact_force", "")]);
        assert_eq!(relieved.verdict(), "no corner contact");
        assert!(
            relieved
                .outcome
                .starts_with("No corner contact: the tip clears the flank before E, Δ = ")
        );
    }

    #[test]
    fn a_digest_is_consistent_if_only_the_load_at_rest_causes_early_contact() {
        let in_motion = digest(&[("model.method", "dynamic"), ("driven.tip_relief", "39 um")]);
        assert!(
            in_motion.outcome.starts_with(
                "No corner contact: no contact before E in motion; at rest the tooth touches, 1."
            ),
            "{}",
            in_motion.outcome
        );
        let at_rest = digest(&[("model.method", "static"), ("driven.tip_relief", "39 um")]);
        assert!(at_rest.outcome.starts_with("Corner contact"), "{}", at_rest.outcome);
    }

    #[test]
    fn a_digest_shows_the_force_of_the_method() {
        let forces =
            ["static", "dynamic", "auto"].map(|method| digest(&[("model.method", method)]));
        assert_eq!(
            forces[0].outcome,
            "Corner contact: θ_st = 1.252 deg before E; force 1466.2 N at E, 1524.3 N overall."
        );
        let moving = "Corner contact: θ_d = 1.279 deg before E; peak force 1410.8 N before E, 2003.0 N \
                overall.";
        assert_eq!(forces[1].outcome, moving);
        let short = [
            "corner contact: 1466.2 N, 1524.3 N overall",
            "corner contact: 1410.8 N, 2003.0 N overall",
            "corner contact: 1410.8 N, 2003.0 N overall",
        ];
        assert_eq!(forces.each_ref().map(|digest| digest.short.as_str()), short);
        assert_eq!(forces[2].method, "dynamic, chosen by auto");
    }

    #[test]
    fn a_refusal_is_the_outcome_of_a_digest() {
        let digest = digest(&[("driven.addendum", "1.9")]);
        assert!(
            digest.outcome.starts_with("Not solved: ")
                && digest.verdict() == "not solved; 1 of 1 limit unknown",
            "{digest:?}"
        );
    }

    #[test]
    fn no_byte_of_a_case_controls_a_terminal() {
        let digest = digest(&[("title", "a\u{1b}[2J\u{202e}b")]);
        assert_eq!(digest.title, r"a\u{1b}[2J\u{202e}b");
    }

    #[test]
    fn every_example_has_a_verdict_and_a_stop_has_none() {
        for example in EXAMPLES {
            let case = example.document().case;
            let inputs = case.inputs().unwrap();
            let digest = solve::digest(&case, &inputs, System::Metric, &|_| true).unwrap();
            assert!(
                ["corner contact:", "no corner contact"]
                    .iter()
                    .any(|start| digest.short.starts_with(start)),
                "{}: {digest:?}",
                example.name
            );
            let slow = Inputs { method: Method::Dynamic, ..inputs };
            assert_eq!(
                solve::digest(&case, &slow, System::Metric, &|_| false),
                None,
                "{}",
                example.name
            );
        }
    }

    #[test]
    fn a_relief_is_rounded_up_and_adds_up() {
        let sums = |least: f64, given: f64| {
            rounded_up(least * 1e-6, given * 1e-6, System::Metric).join(" ")
        };
        assert_eq!(sums(23.01, 25.0), "23.1 48.1");
        assert_eq!(sums(23.01, 25.03), "23.1 48.1");
        assert_eq!(sums(47.327, 0.0), "47.4 47.4");
        assert_eq!(sums(0.672_57, 48.0), "0.673 48.673");
        assert_eq!(sums(1e-9, 25.0), "0.001 25.001");
        assert_eq!(sums(1234.1, 0.0), "1235 1235");
        assert_eq!(rounded_up(22.328e-6, 25e-6, System::Inch).join(" "), "0.880 1.864");
    }

    #[test]
    fn numbers_have_three_digits() {
        for (number, text) in [
            (666.67, "667"),
            (5478.2, "5480"),
            (16_569.0, "16600"),
            (1_234_567.0, "1230000"),
            (999.9, "1000"),
            (0.123_45, "0.123"),
        ] {
            assert_eq!(rounded(number), text);
        }
    }

    #[test]
    fn the_greatest_peak_of_the_motion_is_named_beside_the_speed_of_n_1() {
        let wanted = Stages::of(Stage::SpeedRun);
        let mut inputs = standard_pair(20, 30, 5e-3);
        let mut sentence = |method| {
            inputs.method = method;
            whine(&model::solve(&inputs, wanted).unwrap()).unwrap()
        };
        let at_rest = sentence(Method::Static);
        assert!(at_rest.starts_with("Mesh frequency ") && at_rest.contains("N = 1 of the mean"));
        let in_motion = sentence(Method::Dynamic);
        assert!(in_motion.starts_with("Greatest dynamic factor "), "{in_motion}");
    }
}
