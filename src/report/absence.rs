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
    /// The closed form finds no first contact, but the method does.
    NoFreeImpact,
    /// The quantity needs a friction coefficient, and the case has none.
    NoFriction,
    /// The quantity needs a backlash, and the case has none.
    NoBacklash,
    /// The quantity needs a tip radius, and the tips are sharp.
    NoTipRadius,
    /// The event does not occur.
    NotReached,
    /// No contact after the end of the path of contact.
    NoExit,
    /// The load of the pair is even over the face width.
    NoSlices,
    /// The model withholds the quantity.
    Withheld(Refusal),
    /// The impact has no end, because the triangle of Eq. 34 does not close.
    Unclosed,
}

impl Absence {
    /// Why the quantity has no value in a solution.
    #[must_use]
    pub fn of(quantity: &Quantity, solution: &Solution) -> Absence {
        if let Some(Err(refusal)) = solution.beside
            && !solution.method.stages().has(quantity.stage)
        {
            return Absence::Withheld(refusal);
        }
        let solution = solution.having(quantity.stage);
        let is_without = solution.outcome == Outcome::NoCornerContact;
        let no_contact = Absence::NoContact(without_contact(solution), solution.deviation.total);
        if let Some(absence) = Absence::by_method(quantity, solution.method) {
            return absence;
        }
        match (quantity.stage, solution.withheld) {
            _ if quantity.needs == Need::Slices
                && solution.helix.is_none()
                && solution.face_load.is_none() =>
            {
                Absence::NoSlices
            }
            (Stage::Static | Stage::Dynamic, _) if quantity.key.contains("last_contact") => {
                Absence::NoExit
            }
            _ if is_without && !solution.method.shares_load() => no_contact,
            (Stage::Static | Stage::Dynamic, _)
                if quantity.needs == Need::Friction && !has_friction(solution) =>
            {
                Absence::NoFriction
            }
            (Stage::Impact | Stage::Static | Stage::Dynamic, _)
                if quantity.needs == Need::TipRadius && solution.has_sharp_tips() =>
            {
                Absence::NoTipRadius
            }
            (Stage::Dynamic, _)
                if quantity.needs == Need::Backlash && solution.dynamic.is_some() =>
            {
                Absence::NoBacklash
            }
            (Stage::SteadyMotion, _)
                if quantity.needs == Need::Backlash && matches!(solution.steady, Some(Ok(_))) =>
            {
                Absence::NoBacklash
            }
            (Stage::Static | Stage::Dynamic, _) if is_without => no_contact,
            (Stage::SteadyMotion, _) if let Some(Err(refusal)) = solution.steady => {
                Absence::Withheld(refusal)
            }
            (Stage::SpeedRun, _) if let Some(Err(refusal)) = solution.over_speed => {
                Absence::Withheld(refusal)
            }
            (Stage::Static | Stage::Dynamic | Stage::SteadyMotion | Stage::SpeedRun, _) => {
                Absence::NotReached
            }
            (Stage::StaticSpectrum, _) if let Some(Err(refusal)) = solution.static_spectrum => {
                Absence::Withheld(refusal)
            }
            (Stage::Clearing, _) if !is_without => {
                let withheld = solution.clearing.and_then(|clearing| clearing.withheld);
                withheld.map_or(Absence::NotReached, Absence::Withheld)
            }
            (_, Some(refusal)) => Absence::Withheld(refusal),
            _ if is_without => no_contact,
            _ if solution.position.is_none() => Absence::NoFreeImpact,
            _ => Absence::Unclosed,
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
        let (number, unit) = units::system::shown(value, "um", 3, system);
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

fn has_friction(solution: &Solution) -> bool {
    solution.mesh.as_ref().is_some_and(|mesh| mesh.friction() > 0.0)
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
            Absence::NoSlices => {
                f.write_str("only a helical, misaligned or crowned pair has this quantity")
            }
            // A deviation above 0 belongs to the load at rest and is not the reason.
            Absence::NoContact(why, total) if *total > 0.0 => write!(f, "no corner contact: {why}"),
            Absence::NoContact(why, total) => {
                write!(f, "no corner contact: {why}, Δ = {} um", significant(total * 1e6, 5))
            }
            Absence::NoFreeImpact => f.write_str("the closed form finds no first contact at D"),
            Absence::NoFriction => f.write_str("the case has no operation.friction_coefficient"),
            Absence::NoBacklash => f.write_str(
                "the case has no deviations.backlash; without it the back flanks are far away",
            ),
            Absence::NoTipRadius => f.write_str(
                "the tip is sharp, and no pressure at an edge is finite; give driven.tip_radius",
            ),
            Absence::NotReached => f.write_str("the event does not occur"),
            Absence::NoExit => f.write_str("no contact after B, the end of the path of contact"),
            Absence::Withheld(refusal) => write!(f, "{refusal}; {}", refusal.fix()),
            Absence::Unclosed => {
                f.write_str("the impact has no end D': the triangle of Eq. 34 does not close")
            }
        }
    }
}
