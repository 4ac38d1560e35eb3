//! Sentences about a solved case: the verdict, other methods, resonance, and a summary.

use super::verdict::{self, Standing};
use super::verdict::{listed, without_contact_in_full};
use super::{case_notes, shown_in, value};
use crate::case::Case;
use crate::case::fields::index_of;
use crate::case::sanitize::sanitize;
use crate::case::units::{self, System};
use crate::model::contact_state::first_contact_of_driver;
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Outcome, Quantity, Refusal, Solution, Stage, Stages};
use crate::numeric::decimal::significant;
use std::cmp::Ordering;

/// The stages of the verdict, apart from the relief; a method ignores those that it lacks.
pub const STAGES: Stages =
    Stages::CLOSED_FORM.and(Stages::of(Stage::Static)).and(Stages::of(Stage::Dynamic));

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
    /// The verdict, or the refusal of the model.
    pub outcome: String,
    /// The standing of each limit with its sentence.
    pub limits: Vec<(Standing, String)>,
    /// Notes on the result.
    pub notes: Vec<String>,
}

impl Digest {
    /// The digest of a case from its solution or refusal.
    pub fn of(
        case: &Case,
        inputs: &Inputs,
        found: Result<&Solution, &Refusal>,
        system: System,
    ) -> Digest {
        let text = |key: &str| text(case, key);
        let asked = inputs.method.name();
        let (verdicts, method, outcome) = match found {
            Ok(solution) => {
                let own = solution.method.name();
                let by = if own == asked { "" } else { ", chosen by auto" };
                let mut outcome = sentence(solution, system, false);
                if lacks_relief(solution) {
                    outcome.push_str(" Open the case for the required tip relief.");
                }
                (verdict::verdicts(case, solution), format!("{own}{by}"), outcome)
            }
            Err(refusal) => {
                let outcome = format!("Not solved: {refusal}; {}.", refusal.fix());
                (verdict::refused(case, refusal), asked.to_owned(), outcome)
            }
        };
        let [driver, driven] = ["driver.face_width", "driven.face_width"].map(text);
        let width = if driver == driven { driver } else { format!("{driver}/{driven}") };
        let first = |keys: [(&str, &str); 2]| {
            let texts = keys.map(|(name, key)| (name, text(key)));
            let given = texts.into_iter().find(|(_, text)| !text.is_empty());
            given.map(|(name, text)| format!("{name}{text}")).unwrap_or_default()
        };
        let size = first([("Pd ", "pair.diametral_pitch"), ("m ", "pair.module")]);
        let [z1, z2, angle] = ["driver.teeth", "driven.teeth", "pair.pressure_angle"].map(text);
        let load = first([("", "operation.power"), ("", "operation.torque")]);
        let helix = Some(text("pair.helix_angle")).filter(|_| inputs.helix_angle > 0.0);
        let helix = helix.map_or_else(String::new, |helix| format!("β {helix}, "));
        let limits = verdicts.iter().map(|limit| (limit.standing, limit.sentence(system)));
        let notes = found.map(|solution| model::notes(inputs, solution)).unwrap_or_default();
        Digest {
            title: text("title"),
            pair: format!("z {z1}/{z2}, {size}, α {angle}, {helix}b {width}"),
            load: format!("{load} at {}", text("operation.speed")),
            method,
            outcome,
            limits: limits.collect(),
            notes: case_notes(&notes).map(ToString::to_string).collect(),
        }
    }
}

fn text(case: &Case, key: &str) -> String {
    index_of(key).and_then(|field| case.effective(field)).map(sanitize).unwrap_or_default()
}

/// The remarks in brackets of a verdict: all of them, then fewer in a narrower screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Remarks {
    All,
    Ratios,
    OfMesh,
    None,
}

impl Remarks {
    /// Fewer than all, most remarks first.
    pub(crate) const FEWER: [Remarks; 3] = [Remarks::Ratios, Remarks::OfMesh, Remarks::None];
}

/// The verdict in one sentence: whether the tip strikes, its force before E, the greatest force of
/// a tooth, and the relief that prevents the contact, each if its stage ran; `is_pending` while the
/// relief is being computed.
pub fn sentence(solution: &Solution, system: System, is_pending: bool) -> String {
    remarked(solution, system, is_pending, Remarks::All)
}

/// The verdict of [`sentence`] with some of its remarks.
pub(crate) fn remarked(
    solution: &Solution,
    system: System,
    is_pending: bool,
    remarks: Remarks,
) -> String {
    let most = match solution.method {
        Method::Static => printed("static_peak_force", solution, system),
        Method::Dynamic => printed("dynamic_peak_force", solution, system),
        Method::Paper | Method::Exact | Method::Auto => None,
    };
    let has_ratio = remarks <= Remarks::Ratios && solution.method == Method::Dynamic;
    let ratio = of("peak_force_ratio", solution).filter(|_| has_ratio);
    let ratio = ratio.map(|ratio| format!(" ({ratio:.2} times that at rest)"));
    let ratio = ratio.unwrap_or_default();
    let at_rest = if solution.method == Method::Static { " at rest" } else { "" };
    let most = most.map(|most| format!("{most} on a tooth{at_rest}{ratio}"));
    if solution.outcome == Outcome::NoCornerContact {
        let why = without_contact_in_full(solution, system);
        let up_to = |before| most.as_ref().map(|most| format!("{before} up to {most}"));
        return at_exit(solution, &up_to(",").unwrap_or_default(), system, remarks).map_or_else(
            || format!("No corner contact: {why}{}.", up_to(";").unwrap_or_default()),
            |exit| format!("{exit}; none at the entry: {why}."),
        );
    }
    let angle = own("approach_angle_driver", solution).zip(first_contact_of_driver(solution));
    let angle = angle.map(|(own, angle)| shown_in(own, angle, system));
    let angle = angle.map(|angle| format!(" {angle} before E")).unwrap_or_default();
    let tip = own("impact_force", solution).and_then(|force| {
        let at_rest = solution.static_load.as_ref().filter(|_| solution.method == Method::Static);
        let greatest =
            at_rest.map_or_else(|| value(force, solution), |load| Some(load.approach_force));
        let ratio = value(own("dynamic_factor", solution)?, solution)?;
        Some((shown_in(force, greatest?, system).to_string(), of_mesh(ratio, remarks)))
    });
    let forces = match (tip, most) {
        (Some((tip, ratio)), Some(most)) => {
            // The greatest force of the tooth can be that on the tip.
            let most = match most.strip_prefix(&tip) {
                Some(rest) => format!("the most{rest}"),
                None => most,
            };
            format!(": up to {tip} on the tip{ratio}, {most}")
        }
        (Some((tip, ratio)), None) if solution.leaves_gap_open() => {
            format!(": free impact {tip}{ratio}, too small by the printed equations")
        }
        (Some((tip, ratio)), None) => format!(": free impact {tip}{ratio}"),
        _ => String::new(),
    };
    let exit = at_exit(solution, "", system, remarks).unwrap_or_default();
    let relief = relief(solution, system, is_pending).map(|relief| format!("; {relief}"));
    format!("Corner contact{angle}{forces}{}{exit}.", relief.unwrap_or_default())
}

/// The corner contact at the exit with its remedy; the whole verdict, with the greatest force of a
/// tooth, if there is none at the entry.
fn at_exit(
    solution: &Solution,
    greatest: &str,
    system: System,
    remarks: Remarks,
) -> Option<String> {
    let shown = |key| printed(key, solution, system);
    let load = solution.having(Stage::Static).static_load.as_ref()?;
    let most = Some(load.recess_force).filter(|most| *most > 0.0)?;
    let force = shown_in(Quantity::find("static_force_at_end")?, most, system);
    let angle = shown("static_last_contact_angle")?;
    let clearing = solution.clearing;
    let relief = clearing.and_then(|clearing| clearing.at_exit);
    let required = |on| relief.map(|(given, more)| required(more, given, on, system));
    let at_rest = if solution.method == Method::Dynamic { " (at rest)" } else { "" };
    if solution.outcome == Outcome::CornerContact {
        let required = required("on the driver").map(|required| {
            let of_entry = clearing.and_then(|clearing| clearing.relief);
            let of_entry = of_entry.filter(|_| remarks == Remarks::All);
            let each = of_entry.map_or("", |_| " (each with the other gear unchanged)");
            format!(", {required}{each}")
        });
        return Some(format!("; {force} at the exit{at_rest}{}", required.unwrap_or_default()));
    }
    let required =
        required("tip relief on the driver").map(|required| format!("at least {required}"));
    let required = required.unwrap_or("a larger tip relief of the driver".to_owned());
    let closes_gap = clearing.is_some_and(|clearing| clearing.closes_gap);
    let but = if closes_gap { ", but would cause contact at the entry" } else { "" };
    Some(format!(
        "Corner contact at the exit{at_rest}, until {angle} after B: {force} on the driver's \
            tip{}{greatest}; {required} prevents it{but}",
        of_mesh(most / solution.mesh_force, remarks)
    ))
}

fn of_mesh(ratio: f64, remarks: Remarks) -> String {
    let ratio = Some(ratio).filter(|_| remarks <= Remarks::OfMesh);
    ratio.map_or(String::new(), |ratio| format!(" ({ratio:.2} times the mesh force)"))
}

/// A quantity of the free impact, or its counterpart in the method.
fn own(key: &str, solution: &Solution) -> Option<&'static Quantity> {
    Quantity::find(key)?.by(solution.method)
}

fn of(key: &str, solution: &Solution) -> Option<f64> {
    value(Quantity::find(key)?, solution)
}

fn printed(key: &str, solution: &Solution, system: System) -> Option<String> {
    let quantity = Quantity::find(key)?;
    Some(shown_in(quantity, value(quantity, solution)?, system).to_string())
}

/// Other methods with another outcome, and why the governing method counts.
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

/// The result of method `exact` beside `paper`. A method that shares the load supersedes the free
/// impact.
pub fn by_exact(governing: &Solution, exact: &Solution, system: System) -> Option<String> {
    let found = match exact.outcome {
        _ if governing.method.shares_load() => return None,
        Outcome::NoCornerContact => {
            format!("no corner contact, Δ = {}", printed("total_deviation", exact, system)?)
        }
        Outcome::CornerContact => format!(
            "{}, {} before E",
            printed("impact_force", exact, system)?,
            printed("approach_angle_driver", exact, system)?
        ),
    };
    Some(format!("Method exact: {found}"))
}

/// Significant digits of the additional relief.
const RELIEF_DIGITS: i32 = 3;
/// Its unit.
const RELIEF_UNIT: &str = "um";

/// The tip relief of the driven gear that prevents the contact, or that it is being computed; `None`
/// without corner contact, or if it is unknown.
pub fn relief(solution: &Solution, system: System, is_pending: bool) -> Option<String> {
    match of("clearing_relief", solution).zip(solution.clearing) {
        Some((more, clearing)) => {
            let required = required(more, clearing.given, "tip relief on the driven gear", system);
            Some(format!("at least {required} prevents it"))
        }
        None => is_pending.then(|| "tip relief that prevents it: being computed".to_owned()),
    }
}

/// Whether a sentence lacks the tip relief because its stage did not run.
fn lacks_relief(solution: &Solution) -> bool {
    solution.outcome == Outcome::CornerContact && !solution.stages.has(Stage::Clearing)
}

/// The additional tip relief `on` a gear that prevents a contact.
fn required(more: f64, given: f64, on: &str, system: System) -> String {
    let unit = system.unit(RELIEF_UNIT);
    let [more, all] = rounded_up(more, given, system);
    if given > 0.0 {
        format!("{more} {unit} more {on} ({all} {unit} in all)")
    } else {
        format!("{more} {unit} {on}")
    }
}

/// The additional relief rounded up, and its sum with the given relief rounded up to the same digit.
fn rounded_up(least: f64, given: f64, system: System) -> [String; 2] {
    /// Rounding error of the factor of the unit and of the sum, relative to a digit.
    const ROUNDING: f64 = 1e-9;
    let [least, given] = [least, given].map(|relief| units::per(relief, system.unit(RELIEF_UNIT)));
    // Decimal places of um and of thou.
    let last = if system == System::Inch { 4 } else { 3 };
    let before_point = least.log10().floor() as i32 + 1;
    let places = (RELIEF_DIGITS - before_point).clamp(0, last);
    let (digits, scale) = (places as usize, 10f64.powi(places));
    let more = (least * scale * (1.0 + ROUNDING)).ceil();
    let all = (more + given * scale - ROUNDING).ceil();
    [more, all].map(|number| format!("{:.digits$}", number / scale))
}

/// The mesh frequency, the greatest dynamic factor over the speed, and the speed of N = 1; `None`
/// if the method has no mesh.
pub fn whine(solution: &Solution) -> Option<String> {
    let shown = |key| printed(key, solution, System::Metric);
    let (frequency, speed) = (shown("mesh_frequency")?, shown("resonance_speed")?);
    let ratio = significant(of("resonance_ratio", solution)?, 2);
    let resonance = format!("N = 1 of the mean stiffness at {speed} (now N = {ratio})");
    let at = |speed, factor| {
        Some((of(factor, solution)?, format!("{} at {}", shown(factor)?, shown(speed)?)))
    };
    let rising = at("resonance_peak_speed", "resonance_peak_factor");
    let falling = at("resonance_peak_speed_falling", "resonance_peak_factor_falling");
    let Some((rising, falling)) = rising.zip(falling) else {
        return Some(format!("Mesh frequency {frequency}; {resonance}"));
    };
    // The greater factor comes first.
    let [rise, fall] = [&rising.1, &falling.1];
    let greatest = match rising.0.total_cmp(&falling.0) {
        _ if rise == fall => rise.clone(),
        Ordering::Less => format!("{fall} with falling speed ({rise} with rising speed)"),
        _ => format!("{rise} with rising speed ({fall} with falling speed)"),
    };
    Some(format!(
        "Greatest dynamic factor without deviations: {greatest}; mesh frequency {frequency}, {resonance}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::EXAMPLES;
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
        let found = digest(&[]);
        assert_eq!(
            (found.pair.as_str(), found.load.as_str()),
            ("z 20/20, m 5 mm, α 20 deg, b 8 mm", "15 kW at 2000 rpm")
        );
        assert_eq!(
            (found.method.as_str(), found.limits.as_slice()),
            ("exact", &[(Standing::Within, found.limits[0].1.clone())][..])
        );
        let titled = digest(&[("title", "a\u{1b}[2J\u{202e}b"), ("model.method", "auto")]);
        assert_eq!(titled.title, r"a\u{1b}[2J\u{202e}b", "no byte controls a terminal");
        assert_eq!(titled.method, "dynamic, chosen by auto");
        let refused = digest(&[("driven.addendum", "1.9")]);
        assert!(refused.outcome.starts_with("Not solved: "), "{refused:?}");
        assert_eq!(refused.limits[0].0, Standing::Unknown);
    }

    #[test]
    fn the_verdict_has_contact_forces_with_their_ratios_and_relief() {
        let verdict = |text: &[(&str, &str)]| digest(text).outcome;
        assert_eq!(
            verdict(&[]),
            "Corner contact 1.366 deg before E: free impact 2191.0 N (1.44 times the mesh force); \
                at least 47.4 um tip relief on the driven gear prevents it."
        );
        assert!(verdict(&[("model.method", "static")]).starts_with(
            "Corner contact 1.252 deg before E: up to 1466.2 N on the tip (0.96 times the mesh \
                force), 1524.3 N on a tooth at rest; "
        ));
        assert!(verdict(&[("model.method", "dynamic")]).starts_with(
            "Corner contact 1.279 deg before E: up to 1410.8 N on the tip (0.93 times the mesh \
                force), 2003.0 N on a tooth"
        ));
        // A limit on the motion computes it beside the load at rest, which governs.
        let mut limited = Case::table_1();
        limited.set("model.method", "static").unwrap();
        limited.set_limit("dynamic_peak_force", "3000 N").unwrap();
        let inputs = limited.inputs().unwrap();
        let found = solve::digest(&limited, &inputs, System::Metric, &|_| true).unwrap();
        assert!(found.outcome.contains(", 1524.3 N on a tooth at rest; "), "{}", found.outcome);
        let relieved = [("driven.tip_relief", "80 um"), ("model.method", "exact")];
        assert!(
            verdict(&relieved).starts_with("No corner contact: the tip clears the flank before E")
        );
    }

    #[test]
    fn the_load_at_rest_alone_can_cause_early_contact() {
        let of = |method| digest(&[("model.method", method), ("driven.tip_relief", "39 um")]);
        let in_motion = of("dynamic").outcome;
        assert!(
            in_motion.contains(
                "none at the entry: no contact before E in motion; at rest the tooth touches, 1."
            ),
            "{in_motion}"
        );
        let at_rest = of("static").outcome;
        assert!(at_rest.starts_with("Corner contact "), "{at_rest}");
        assert!(at_rest.contains(" um more tip relief on the driven gear ("), "{at_rest}");
    }

    #[test]
    fn a_contact_at_the_exit_alone_is_named_in_the_verdict() {
        let of = |relief| {
            let reliefs = [("driven.tip_relief", "80 um"), ("driver.tip_relief", relief)];
            digest(&[reliefs[0], reliefs[1], ("model.method", "static")]).outcome
        };
        let at_exit = of("0 um");
        assert!(at_exit.starts_with("Corner contact at the exit, until "), "{at_exit}");
        assert!(
            at_exit.contains(" um tip relief on the driver prevents it; none at the entry: a gap"),
            "{at_exit}"
        );
        let closes_gap = |relief| {
            let mut case = Case::table_1();
            case.set("driven.tip_relief", relief).unwrap();
            let inputs = Inputs { method: Method::Dynamic, ..case.inputs().unwrap() };
            let solution = model::solve(&inputs, STAGES.and(Stages::of(Stage::Clearing))).unwrap();
            let verdict = sentence(&solution, System::Metric, false);
            verdict.contains(" prevents it, but would cause contact at the entry; none ")
        };
        assert!(closes_gap("39 um") && !closes_gap("43 um"));
        let relieved = of("80 um");
        assert!(relieved.starts_with("No corner contact: "), "{relieved}");
        assert!(!relieved.contains("exit"), "{relieved}");
    }

    #[test]
    fn every_example_has_a_verdict_and_a_stop_has_none() {
        for example in EXAMPLES {
            let case = example.document().case;
            let inputs = case.inputs().unwrap();
            let solved = |inputs| solve::digest(&case, inputs, System::Metric, &|_| true).unwrap();
            assert!(solved(&inputs).outcome.contains("orner contact"), "{}", example.name);
            let slow = Inputs { method: Method::Dynamic, ..inputs };
            assert_eq!(solve::digest(&case, &slow, System::Metric, &|_| false), None);
        }
    }

    #[test]
    fn a_relief_is_rounded_up_and_adds_up() {
        let sums = |least: f64, given: f64| {
            rounded_up(least * 1e-6, given * 1e-6, System::Metric).join(" ")
        };
        assert_eq!(sums(23.01, 25.0), "23.1 48.1");
        assert_eq!(sums(23.01, 25.03), "23.1 48.2");
        assert_eq!(sums(47.327, 0.0), "47.4 47.4");
        assert_eq!(sums(0.672_57, 48.0), "0.673 48.673");
        assert_eq!(sums(1e-9, 25.0), "0.001 25.001");
        assert_eq!(sums(1234.1, 0.0), "1235 1235");
        assert_eq!(rounded_up(22.328e-6, 25e-6, System::Inch).join(" "), "0.880 1.865");
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
