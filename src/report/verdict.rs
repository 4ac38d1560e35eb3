//! The limits of a case compared with its results, and why a quantity has no value.

use super::{name_of, shown_in, value};
use crate::case::units::{self, System};
use crate::case::{Case, Limit};
use crate::model::inputs::Method;
use crate::model::quantities::Need;
use crate::model::{Outcome, Quantity, Refusal, Solution, Stage, Stages};
use crate::numeric::decimal::significant;
use crate::report::table::{json, write_line};
use std::fmt;
use std::io::{self, Write};

/// The comparison of a quantity with its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// At most the limit.
    Within,
    /// Above the limit.
    Exceeded,
    /// No corner contact, so that nothing can exceed the limit.
    NotApplicable,
    /// The quantity is absent, although corner contact is possible: the limit is not met.
    Unknown,
}

impl Standing {
    /// Whether the limit is met.
    pub fn holds(self) -> bool {
        matches!(self, Standing::Within | Standing::NotApplicable)
    }

    /// The name for scripts.
    pub fn name(self) -> &'static str {
        ["within", "exceeded", "not-applicable", "unknown"][self as usize]
    }

    /// The word in front of a verdict.
    pub fn word(self) -> &'static str {
        ["ok", "EXCEEDED", "ok", "unknown"][self as usize]
    }
}

/// A limit of a case with its result.
#[derive(Debug, Clone)]
pub struct Verdict<'a> {
    /// The limit.
    pub limit: &'a Limit,
    /// The value of the quantity in SI.
    pub value: Option<f64>,
    /// The greatest allowed value in SI.
    pub bound: Option<f64>,
    /// The comparison.
    pub standing: Standing,
    /// Why the value is absent.
    pub absence: Option<Absence>,
    /// The counterpart in the method, if the limited quantity belongs to the free impact.
    pub beside: Option<Beside>,
}

/// The counterpart of a quantity of the free impact in a method that resolves the impact.
#[derive(Debug, Clone, Copy)]
pub struct Beside {
    /// The method.
    pub method: Method,
    /// The quantity of the method and its value in SI, if it has them.
    pub own: Option<(&'static Quantity, Option<f64>)>,
    /// Whether the case also limits that quantity.
    pub is_limited: bool,
}

impl Beside {
    /// The counterpart of that quantity in a solution.
    pub fn of(quantity: &'static Quantity, solution: &Solution) -> Option<Beside> {
        let method = solution.method;
        if !method.shares_load() || !quantity.is_of_free_impact() {
            return None;
        }
        let own = quantity.by(method).map(|own| (own, value(own, solution)));
        Some(Beside { method, own, is_limited: false })
    }

    /// The counterpart as a sentence, with the value in metric or inch units.
    pub fn sentence(&self, system: System) -> String {
        let method = self.method.name();
        let Some((own, value)) = self.own else {
            return format!("Method {method} has no such quantity");
        };
        // The label can begin with the method.
        let label = own.label.trim_start().trim_start_matches(&format!("{method}: "));
        match value {
            Some(value) => {
                let value = shown_in(own, value, system);
                format!("Method {method} computes {} ({label}) = {value}", own.symbol)
            }
            None => format!("Method {method} has no value of {} ({label})", own.symbol),
        }
    }
}

/// The verdict on every limit, in the order of the case.
pub fn verdicts<'a>(case: &'a Case, solution: &Solution) -> Vec<Verdict<'a>> {
    let limits = case.limits.iter();
    let mut verdicts: Vec<_> = limits.map(|limit| verdict(limit, solution)).collect();
    for beside in verdicts.iter_mut().filter_map(|verdict| verdict.beside.as_mut()) {
        beside.is_limited = beside
            .own
            .is_some_and(|(own, _)| case.limits.iter().any(|limit| limit.quantity == own));
    }
    verdicts
}

/// The verdict on one limit.
pub fn verdict<'a>(limit: &'a Limit, solution: &Solution) -> Verdict<'a> {
    let quantity = limit.quantity;
    let found = value(quantity, solution);
    let bound = limit.bound(|of| value(of, solution));
    // The result to which the limit is relative may be absent.
    let lacking = match (found, bound) {
        (None, _) => Some(quantity),
        (_, None) => limit.of,
        _ => None,
    };
    let absence = lacking.map(|lacking| Absence::of(lacking, solution));
    let standing = match (found, bound, absence) {
        (Some(value), Some(bound), _) if value <= bound => Standing::Within,
        (Some(_), Some(_), _) => Standing::Exceeded,
        (None, _, Some(Absence::NoContact(..) | Absence::NoExit)) => Standing::NotApplicable,
        _ => Standing::Unknown,
    };
    let value = found.filter(|_| bound.is_some());
    // Without corner contact there is no counterpart to compare.
    let beside = value.and_then(|_| Beside::of(quantity, solution));
    Verdict { limit, value, bound, standing, absence, beside }
}

/// The stages for every limit of a case.
pub fn stages(case: &Case) -> Stages {
    let quantities = case.limits.iter().flat_map(Limit::quantities);
    let stages = Stages::of(Stage::Geometry);
    quantities.fold(stages, |stages, own| stages.and(own.stages()))
}

/// Every limit of a case that the model refuses: no quantity has a value.
pub fn refused<'a>(case: &'a Case, refusal: &Refusal) -> Vec<Verdict<'a>> {
    let absence = Some(Absence::Withheld(*refusal));
    let verdict = |limit: &'a Limit| {
        let (value, bound, standing) = (None, limit.bound(|_| None), Standing::Unknown);
        Verdict { limit, value, bound, standing, absence, beside: None }
    };
    case.limits.iter().map(verdict).collect()
}

impl Verdict<'_> {
    /// The value as a fraction of the limit, if both are in range.
    pub fn part(&self) -> Option<f64> {
        let (value, limit) = (self.value?, self.bound?);
        (limit > 0.0 && limit.is_finite() && value >= 0.0).then(|| value / limit)
    }

    /// The verdict as a sentence, with the value in metric or inch units, and the limit as the user
    /// wrote it.
    pub fn sentence(&self, system: System) -> String {
        let statement = self.statement(system);
        let Some(beside) = self.beside else { return statement };
        let limit = self.limit.shown();
        let above = if self.is_exceeded_beside() { format!(" > {limit}") } else { String::new() };
        let own = beside.own.filter(|_| !beside.is_limited);
        let also = own.map(|(own, _)| format!(". {} has no limit", own.symbol));
        let also = also.unwrap_or_default();
        format!("{statement} for the free impact. {}{above}{also}", beside.sentence(system))
    }

    /// Whether the counterpart in the method exceeds the limit on the free impact.
    pub fn is_exceeded_beside(&self) -> bool {
        let own = self.beside.and_then(|beside| beside.own?.1);
        own.zip(self.bound).is_some_and(|(own, bound)| own > bound)
    }

    fn statement(&self, system: System) -> String {
        let (name, mut limit) = (name_of(self.limit.quantity), self.limit.shown());
        if let Some(bound) = self.bound.filter(|_| self.limit.of.is_some()) {
            limit = format!("{limit} = {}", shown_in(self.limit.quantity, bound, system));
        }
        match (self.value, self.absence) {
            (Some(value), _) => {
                let value = shown_in(self.limit.quantity, value, system);
                let sign = if self.standing == Standing::Exceeded { ">" } else { "<=" };
                let part = self.part().map(|part| format!(" ({:.0} %)", 100.0 * part));
                format!("{name} {value} {sign} {limit}{}", part.unwrap_or_default())
            }
            (None, Some(Absence::Withheld(refusal))) => {
                format!("{name} cannot be computed: {refusal} (limit {limit})")
            }
            (None, Some(absence)) if self.bound.is_none() => {
                format!("{name} cannot be compared with {limit}: {absence}")
            }
            (None, Some(absence)) if self.standing == Standing::Unknown => {
                format!("{name} has no value (limit {limit}): {absence}")
            }
            (_, Some(Absence::NoExit)) => {
                format!("{name} does not occur: {} (limit {limit})", Absence::NoExit)
            }
            _ => format!("{name} does not occur: no corner contact (limit {limit})"),
        }
    }
}

impl fmt::Display for Verdict<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence(System::Metric))
    }
}

/// Writes the verdicts on a case, one line each; one line for a case without limits. `outcome` is
/// the verdict on the contact.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(
    verdicts: &[Verdict],
    case: &str,
    (method, outcome): (Method, Option<&str>),
    out: &mut dyn Write,
) -> io::Result<()> {
    let method = method.name();
    if verdicts.is_empty() {
        let standing = Standing::Within.name();
        let line = json!({
            "case": case, "method": method, "verdict": outcome, "standing": standing,
            "message": "no limits",
        });
        return write_line(&line, out);
    }
    verdicts.iter().try_for_each(|verdict| {
        let Verdict { limit, value, bound, standing, beside, .. } = verdict;
        let quantity = limit.quantity;
        // The counterpart in the method, if the method resolves the impact itself.
        let own = beside.and_then(|beside| beside.own);
        let own =
            own.map(|(own, value)| json!({"quantity": own.key, "value": value, "unit": own.unit}));
        let line = json!({
            "case": case,
            "method": method,
            "verdict": outcome,
            "standing": standing.name(),
            "quantity": quantity.key,
            "value": value,
            "limit": bound,
            "limit_of": limit.of.map(|of| of.key),
            "unit": quantity.unit,
            "of": beside.map(|_| "free-impact"),
            "own": own,
            "message": verdict.to_string(),
        });
        write_line(&line, out)
    })
}

/// Why a quantity has no value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Absence {
    /// The method does not compute the quantity, which belongs to a stage of another method.
    OtherMethod(Method, Stage),
    /// No corner contact: the reason, and the total deviation in m.
    NoContact(&'static str, f64),
    /// The closed form over the face width, which only the method `exact` computes.
    OverFace(Method),
    /// No contact after the end of the path of contact.
    NoExit,
    /// The model withholds the quantity.
    Withheld(Refusal),
    /// Another reason.
    Because(&'static str),
}

const NO_EVENT: &str = "the event does not occur";

impl Absence {
    /// Why the quantity has no value in a solution.
    pub fn of(quantity: &Quantity, solution: &Solution) -> Absence {
        let stage = quantity.stage;
        if let Some(Err(refusal)) = solution.beside
            && !solution.method.stages().has(stage)
        {
            return Absence::Withheld(refusal);
        }
        let solution = solution.having(stage);
        if let Some(absence) = Absence::by_method(quantity, solution.method) {
            return absence;
        }
        // Load sharing in slices has no closed form beside it.
        let is_without_form = !solution.stages.has(Stage::Position) && solution.withheld.is_none();
        if solution.method.shares_load() && quantity.is_of_free_impact() && is_without_form {
            return match stage {
                Stage::Position | Stage::Velocity => Absence::OverFace(solution.method),
                _ => Absence::Because(
                    "over the face width the impact begins at a point and has no closed form; \
                     `static` and `dynamic` have the forces before E",
                ),
            };
        }
        let is_shared = matches!(stage, Stage::Static | Stage::Dynamic);
        let is_without = solution.outcome == Outcome::NoCornerContact;
        let no_contact = Absence::NoContact(without_contact(solution), solution.deviation.total);
        let refused = match stage {
            Stage::SteadyMotion => solution.steady.as_ref().and_then(|it| it.as_ref().err()),
            Stage::SpeedRun => solution.over_speed.as_ref().and_then(|it| it.as_ref().err()),
            Stage::StaticSpectrum => {
                solution.static_spectrum.as_ref().and_then(|it| it.as_ref().err())
            }
            _ => None,
        };
        let has_motion = match stage {
            Stage::Dynamic => solution.dynamic.is_some(),
            Stage::SteadyMotion => matches!(solution.steady, Some(Ok(_))),
            _ => false,
        };
        let has_friction = || solution.mesh.as_ref().is_some_and(|mesh| mesh.friction() > 0.0);
        match (stage, quantity.needs, refused, solution.withheld) {
            (_, Need::Slices, ..) if !solution.is_over_face => {
                Absence::Because("only a helical, misaligned or crowned pair has this quantity")
            }
            (Stage::Geometry, Need::Slices, ..) => Absence::Because("a spur pair has none"),
            _ if quantity.is_at_exit => Absence::NoExit,
            _ if is_without && !solution.method.shares_load() => no_contact,
            (_, Need::Friction, ..) if is_shared && !has_friction() => {
                Absence::Because("the case has no operation.friction_coefficient")
            }
            (_, Need::TipRadius, ..)
                if (is_shared || stage == Stage::Impact) && solution.has_sharp_tips() =>
            {
                Absence::Because(
                    "the tip is sharp, and no pressure at an edge is finite; give driven.tip_radius",
                )
            }
            (_, Need::Backlash, ..) if has_motion && solution.is_over_face => {
                Absence::Because("back flanks have no model over the face width")
            }
            (_, Need::Backlash, ..) if has_motion => Absence::Because(
                "the case has no deviations.backlash; without it the back flanks are far away",
            ),
            _ if is_shared && is_without => no_contact,
            (_, _, Some(refusal), _) => Absence::Withheld(*refusal),
            (Stage::SpeedRun, ..) if quantity.key.starts_with("resonance_factor_") => {
                Absence::Because("the dynamic factor has no peak near this speed")
            }
            (Stage::SteadyMotion | Stage::SpeedRun, ..) => Absence::Because(NO_EVENT),
            _ if is_shared => Absence::Because(NO_EVENT),
            (Stage::Clearing, ..) if !is_without => {
                let withheld = solution.clearing.and_then(|clearing| clearing.withheld);
                withheld.map_or(Absence::Because(NO_EVENT), Absence::Withheld)
            }
            (.., Some(refusal)) => Absence::Withheld(refusal),
            _ if is_without => no_contact,
            _ if solution.position.is_none() => {
                Absence::Because("the closed form finds no first contact at D")
            }
            _ => {
                Absence::Because("the impact has no end D': the triangle of Eq. 34 does not close")
            }
        }
    }

    /// Why a method does not compute the quantity, if only other methods compute it.
    pub fn by_method(quantity: &Quantity, method: Method) -> Option<Absence> {
        let stage = quantity.stage;
        (!method.stages().has(stage)).then_some(Absence::OtherMethod(method, stage))
    }
}

/// Why the tooth does not strike, as a short phrase.
pub fn without_contact(solution: &Solution) -> &'static str {
    match solution.method {
        _ if solution.deviation.total <= 0.0 => "the tip clears the flank before E",
        Method::Paper => "the printed equations find no contact before E",
        Method::Static => "the pairs in contact do not deflect so far at rest",
        _ => "no contact before E in motion",
    }
}

/// The same reason in full, with the total deviation, the remaining gap, or the gap that the load
/// at rest would close.
pub fn without_contact_in_full(solution: &Solution, system: System) -> String {
    let (why, total) = (without_contact(solution), solution.deviation.total);
    let printed = |value: f64| {
        let (number, unit) = units::shown(value, "um", 3, system);
        format!("{number} {unit}")
    };
    match (solution.method, solution.margin(), solution.lead_at_rest()) {
        (Method::Exact | Method::Dynamic | Method::Auto, _, Some(lead)) if lead > 0.0 => {
            format!("{why}; at rest the tooth touches, {} early", printed(lead))
        }
        (Method::Static, Some(gap), _) => {
            format!("a gap of {} remains before E at rest", printed(gap))
        }
        (Method::Dynamic, Some(gap), _) => {
            format!("a gap of {} remains before E in motion", printed(gap))
        }
        _ if total <= 0.0 => match Quantity::find("total_deviation") {
            Some(quantity) => format!("{why}, Δ = {}", shown_in(quantity, total + 0.0, system)),
            None => why.to_owned(),
        },
        (Method::Paper, ..) => format!("{why} although Δ is {}", printed(total)),
        _ => why.to_owned(),
    }
}

/// Joins names with commas and "and".
pub fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [others @ .., last] => format!("{} and {last}", others.join(", ")),
    }
}

impl fmt::Display for Absence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Absence::OtherMethod(method, stage) => {
                let methods = Method::ALL
                    .into_iter()
                    .filter(|method| method.stages().has(*stage))
                    .map(Method::name);
                let methods = listed(&methods.collect::<Vec<_>>());
                let own = method.name();
                write!(f, "method {own} does not compute this quantity; {methods} do")
            }
            // A deviation above 0 belongs to the load at rest and is not the reason.
            Absence::NoContact(why, total) if *total > 0.0 => write!(f, "no corner contact: {why}"),
            Absence::NoContact(why, total) => {
                write!(f, "no corner contact: {why}, Δ = {} um", significant(total * 1e6, 5))
            }
            Absence::OverFace(method) => write!(
                f,
                "method {} computes the load over the face width and no closed form; method exact has \
                 its value (--method exact)",
                method.name()
            ),
            Absence::NoExit => f.write_str("no contact after B, the end of the path of contact"),
            Absence::Withheld(refusal) => write!(f, "{refusal}; {}", refusal.fix()),
            Absence::Because(reason) => f.write_str(reason),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Inputs;

    fn sentences(limits: &[(&str, &str)], system: System) -> Vec<String> {
        let mut case = Case::table_1();
        for (quantity, text) in limits {
            case.set_limit(quantity, text).unwrap();
        }
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::ALL).unwrap();
        verdicts(&case, &solution)
            .iter()
            .map(|verdict| format!("{} {}", verdict.standing.word(), verdict.sentence(system)))
            .collect()
    }

    #[test]
    fn a_limit_on_the_free_impact_is_followed_by_the_counterpart_in_the_method() {
        let verdicts = |method, limit| {
            let mut case = Case::table_1();
            case.set("model.method", method).unwrap();
            case.set_limit("impact_force", limit).unwrap();
            let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
            verdicts(&case, &solution)
                .iter()
                .map(|verdict| (verdict.standing, verdict.to_string()))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            verdicts("exact", "2500 N"),
            [(Standing::Within, "impact force F_S 2191.0 N <= 2500 N (88 %)".to_owned())]
        );
        let [(standing, sentence)] = &verdicts("dynamic", "2100 N")[..] else {
            panic!("one limit")
        };
        assert_eq!(*standing, Standing::Within);
        assert!(
            sentence.ends_with(
                " for the free impact. Method dynamic computes F_d,DE (peak before E) = 1410.8 N. \
                    F_d,DE has no limit"
            ),
            "{sentence}"
        );
        let [(standing, sentence)] = &verdicts("static", "1 kN")[..] else { panic!("one limit") };
        assert_eq!(*standing, Standing::Exceeded);
        assert!(
            sentence.ends_with(
                " for the free impact. Method static computes F_st,E (force before E) = 1466.2 N > \
                    1 kN. F_st,E has no limit"
            ),
            "{sentence}"
        );
    }

    #[test]
    fn a_limit_without_a_value_gives_the_reason_and_passes_only_without_contact() {
        let stands = |method, relief, key, limit| {
            let mut case = Case::table_1();
            case.set("model.method", method).unwrap();
            case.set("driven.tip_relief", relief).unwrap();
            case.set("limits.impact_force", "").unwrap();
            case.set_limit(key, limit).unwrap();
            let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
            let verdict = verdicts(&case, &solution).remove(0);
            (verdict.standing, verdict.to_string())
        };
        let (standing, sentence) = stands("exact", "0 um", "dynamic_peak_force", "2 kN");
        assert_eq!(standing, Standing::Unknown);
        assert_eq!(
            sentence,
            "dynamic: peak force F_d,max has no value (limit 2 kN): method exact does not compute this \
                quantity; dynamic and auto do"
        );
        // The closed form has no result for the motion.
        assert_eq!(stands("exact", "80 um", "dynamic_peak_force", "2 kN").0, Standing::Unknown);
        assert_eq!(stands("exact", "80 um", "impact_force", "2 kN").0, Standing::NotApplicable);
        let (standing, sentence) = stands("static", "80 um", "pitch_contact_jump", "2 kN");
        assert_eq!(standing, Standing::Unknown);
        assert!(sentence.ends_with("the case has no operation.friction_coefficient"), "{sentence}");
        for key in ["steady_back_force", "dynamic_back_strikes"] {
            let limit = if key.ends_with("force") { "1 N" } else { "1" };
            let (_, sentence) = stands("dynamic", "0 um", key, limit);
            assert!(sentence.contains("the case has no deviations.backlash"), "{sentence}");
        }
        assert_eq!(
            stands("static", "80 um", "static_first_contact_angle", "1 deg").0,
            Standing::NotApplicable
        );
    }

    #[test]
    fn a_counterpart_with_a_limit_of_its_own_needs_no_hint() {
        let mut case = Case::table_1();
        case.set("model.method", "static").unwrap();
        case.set_limit("static_force_at_start", "1 kN").unwrap();
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
        let sentence = verdicts(&case, &solution)[0].to_string();
        assert!(sentence.ends_with("F_st,E (force before E) = 1466.2 N"), "{sentence}");
    }

    #[test]
    fn a_verdict_prints_the_limit_as_written_in_both_systems() {
        let limits = [("impact_force", "500 lbf"), ("contact_ratio", "1.5")];
        assert_eq!(
            sentences(&limits, System::Metric),
            [
                "ok impact force F_S 2191.0 N <= 500 lbf (99 %)",
                "EXCEEDED contact ratio ε 1.5568 > 1.5 (104 %)"
            ]
        );
        assert_eq!(
            sentences(&limits, System::Inch)[0],
            "ok impact force F_S 492.56 lbf <= 500 lbf (99 %)"
        );
    }

    #[test]
    fn a_limit_relative_to_another_result_follows_it() {
        let limits =
            [("static_peak_force", "1.3 x mesh_force"), ("static_force_at_start", "0.5 x nominal")];
        let mut case = Case::table_1();
        case.set("model.method", "static").unwrap();
        case.set("limits.impact_force", "").unwrap();
        for (quantity, text) in limits {
            case.set_limit(quantity, text).unwrap();
        }
        let solution = crate::model::solve(&case.inputs().unwrap(), stages(&case)).unwrap();
        let found = verdicts(&case, &solution);
        let standings = found.iter().map(|verdict| verdict.standing);
        assert_eq!(standings.collect::<Vec<_>>(), [Standing::Within, Standing::Exceeded]);
        // A value equal to its limit meets it.
        let force = value(Quantity::find("mesh_force").unwrap(), &solution).unwrap();
        let mut equal = case.clone();
        equal.set_limit("mesh_force", &format!("{force:?} N")).unwrap();
        assert_eq!(verdicts(&equal, &solution)[2].standing, Standing::Within);
        assert!(
            found[0].to_string().contains("<= 1.3 x mesh_force = 1981.6 N (77 %)"),
            "{}",
            found[0]
        );
        let other = Inputs { method: Method::Exact, ..case.inputs().unwrap() };
        let solution = crate::model::solve(&other, stages(&case)).unwrap();
        assert_eq!(verdicts(&case, &solution)[0].standing, Standing::Unknown);
        let wrong = |text: &str| case.clone().set_limit("static_peak_force", text).unwrap_err();
        assert!(wrong("1.3 x mesh_forc").to_string().contains("mesh_force"));
        assert!(wrong("1.3 x contact_ratio").to_string().contains("another unit"));
    }

    #[test]
    fn a_refused_case_gives_the_reason_for_every_limit() {
        let case = Case::table_1();
        let verdicts = refused(
            &case,
            &Refusal::ContactRatioBelowOne { ratio: 0.9, is_deflection_taken: true, cut: None },
        );
        assert!(!verdicts[0].standing.holds());
        assert!(
            verdicts[0]
                .to_string()
                .starts_with("impact force F_S cannot be computed: the contact ratio is 0.9000")
        );
    }
}
