//! Why a quantity of a solved case has no value.

use std::fmt;

use crate::case::units::{self, System};
use crate::model::inputs::Method;
use crate::model::quantities::Need;
use crate::model::{Outcome, Quantity, Refusal, Solution, Stage};
use crate::numeric::decimal::significant;

use super::shown_in;

/// Why a quantity has no value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Absence {
    /// The method does not compute the quantity, which belongs to a stage of another method.
    OtherMethod(Method, Stage),
    /// No corner contact: the reason, and the total deviation in m.
    NoContact(&'static str, f64),
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
    #[must_use]
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
        match (stage, quantity.needs) {
            (_, Need::Slices) if solution.helix.is_none() && !solution.has_slices() => {
                Absence::Because("only a helical, misaligned or crowned pair has this quantity")
            }
            _ if is_shared && quantity.key.contains("last_contact") => Absence::NoExit,
            _ if is_without && !solution.method.shares_load() => no_contact,
            (_, Need::Friction) if is_shared && !has_friction() => {
                Absence::Because("the case has no operation.friction_coefficient")
            }
            (_, Need::TipRadius)
                if (is_shared || stage == Stage::Impact) && solution.has_sharp_tips() =>
            {
                Absence::Because(
                    "the tip is sharp, and no pressure at an edge is finite; give driven.tip_radius",
                )
            }
            (_, Need::Backlash) if has_motion => Absence::Because(
                "the case has no deviations.backlash; without it the back flanks are far away",
            ),
            _ if is_shared && is_without => no_contact,
            _ if let Some(refusal) = refused => Absence::Withheld(*refusal),
            (Stage::SteadyMotion | Stage::SpeedRun, _) => Absence::Because(NO_EVENT),
            _ if is_shared => Absence::Because(NO_EVENT),
            (Stage::Clearing, _) if !is_without => {
                let withheld = solution.clearing.and_then(|clearing| clearing.withheld);
                withheld.map_or(Absence::Because(NO_EVENT), Absence::Withheld)
            }
            _ if let Some(refusal) = solution.withheld => Absence::Withheld(refusal),
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
    #[must_use]
    pub fn by_method(quantity: &Quantity, method: Method) -> Option<Absence> {
        let stage = quantity.stage;
        (!method.stages().has(stage)).then_some(Absence::OtherMethod(method, stage))
    }
}

/// Why the tooth does not strike, as a short phrase.
#[must_use]
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
#[must_use]
pub fn without_contact_in_full(solution: &Solution, system: System) -> String {
    let (why, total) = (without_contact(solution), solution.deviation.total);
    let printed = |value: f64| {
        let (number, unit) = units::shown(value, "um", 3, system);
        format!("{number} {unit}")
    };
    match (solution.method, solution.margin(), solution.lead_at_rest()) {
        _ if total <= 0.0 => match Quantity::find("total_deviation") {
            Some(quantity) => format!("{why}, Δ = {}", shown_in(quantity, total + 0.0, system)),
            None => why.to_owned(),
        },
        (Method::Paper, ..) => format!("{why} although Δ is {}", printed(total)),
        (Method::Static, Some(gap), _) => {
            format!("a gap of {} remains before E at rest", printed(gap))
        }
        (Method::Exact | Method::Dynamic | Method::Auto, _, Some(lead)) if lead > 0.0 => {
            format!("{why}; at rest the tooth touches, {} early", printed(lead))
        }
        _ => why.to_owned(),
    }
}

/// Joins names with commas and "and".
#[must_use]
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
            Absence::NoExit => f.write_str("no contact after B, the end of the path of contact"),
            Absence::Withheld(refusal) => write!(f, "{refusal}; {}", refusal.fix()),
            Absence::Because(reason) => f.write_str(reason),
        }
    }
}
