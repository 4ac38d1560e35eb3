//! Why a quantity of a solved case has no value.

use std::fmt;

use crate::case::units::{self, System};
use crate::model::inputs::Method;
use crate::model::{Outcome, Quantity, Refusal, Solution, Stage};
use crate::numeric::decimal::significant;

/// Why a quantity has no value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Absence {
    /// This method has no such quantity; it is of one of the stages of another.
    OtherMethod(Method, Stage),
    /// Nothing strikes: why, and the total deviation in m.
    NoContact(&'static str, f64),
    /// The closed form finds no first contact, though the method itself does.
    NoFreeImpact,
    /// It is of friction, and the case gives none.
    NoFriction,
    /// The tooth does not come to it.
    NotReached,
    /// The model refuses it.
    Withheld(Refusal),
    /// The end of the impact does not exist.
    Unclosed,
}

impl Absence {
    /// Why the quantity has no value in a solution that does without.
    #[must_use]
    pub fn of(quantity: &Quantity, solution: &Solution) -> Absence {
        let is_without = solution.outcome == Outcome::NoCornerContact;
        let no_contact = Absence::NoContact(without_contact(solution), solution.deviation.total);
        match (quantity.stage, solution.withheld) {
            (stage, _) if !solution.method.stages().has(stage) => {
                Absence::OtherMethod(solution.method, stage)
            }
            _ if is_without && !solution.method.shares_load() => no_contact,
            (Stage::Static | Stage::Dynamic, _)
                if quantity.needs_friction() && !has_friction(solution) =>
            {
                Absence::NoFriction
            }
            (Stage::Static | Stage::Dynamic, _) if is_without => no_contact,
            (Stage::Static | Stage::Dynamic, _) => Absence::NotReached,
            (Stage::Clearing, _) if !is_without => cleared(solution),
            (_, Some(refusal)) => Absence::Withheld(refusal),
            _ if is_without => no_contact,
            _ if solution.position.is_none() => Absence::NoFreeImpact,
            _ => Absence::Unclosed,
        }
    }

    /// Whether it has none because nothing strikes, so that no limit can be exceeded.
    #[must_use]
    pub fn is_for_want_of_contact(&self) -> bool {
        matches!(self, Absence::NoContact(..))
    }
}

/// Why the tooth does not strike: one that the load at rest, or the exact position, would bring in
/// early may yet not.
#[must_use]
pub fn without_contact(solution: &Solution) -> &'static str {
    match solution.method {
        _ if solution.deviation.total <= 0.0 => "the tooth comes in on time",
        Method::Paper => "the printed equations bring it in on time",
        Method::Static => "at rest the pairs in contact do not give way so far",
        _ => "in motion the tooth does not touch before E",
    }
}

/// The same in full, with the deviation where that is the reason; where the load at rest would
/// bring the tooth in early, by how much, and where it would not, how much is left.
#[must_use]
pub fn without_contact_in_full(solution: &Solution, system: System) -> String {
    let (why, total) = (without_contact(solution), solution.deviation.total);
    let told = |value: f64| {
        let (number, unit) = units::system::shown(value, "um", 3, system);
        format!("{number} {unit}")
    };
    match solution.method {
        _ if total <= 0.0 => why.to_owned(),
        Method::Paper => format!("{why}, though Δ is {}", told(total)),
        Method::Static => solution.margin().map_or_else(
            || why.to_owned(),
            |gap| format!("at rest a gap of {} is left before E", told(gap)),
        ),
        _ => match solution.lead_at_rest().filter(|&lead| lead > 0.0) {
            Some(lead) => format!("{why}; at rest it would, by {}", told(lead)),
            None => why.to_owned(),
        },
    }
}

/// Why no relief is known that stops it.
fn cleared(solution: &Solution) -> Absence {
    solution
        .clearing
        .and_then(|clearing| clearing.withheld)
        .map_or(Absence::NotReached, Absence::Withheld)
}

fn has_friction(solution: &Solution) -> bool {
    solution
        .mesh
        .as_ref()
        .is_some_and(|mesh| mesh.friction() > 0.0)
}

impl fmt::Display for Absence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Absence::OtherMethod(method, stage) => {
                let methods = Method::ALL.into_iter().filter(|method| method.stages().has(*stage)).map(Method::name);
                let methods = methods.collect::<Vec<_>>().join(", ");
                write!(f, "the method is {}, and this is of {methods}", method.name())
            }
            // A deviation above 0 is of the load at rest, and no reason.
            Absence::NoContact(why, total) if *total > 0.0 => write!(f, "no corner contact: {why}"),
            Absence::NoContact(why, total) => {
                write!(f, "no corner contact: {why}, the total deviation is {} um", significant(total * 1e6, 5))
            }
            Absence::NoFreeImpact => f.write_str("the closed form finds no first contact at D"),
            Absence::NoFriction => f.write_str("the case gives no friction coefficient, operation.friction_coefficient"),
            Absence::NotReached => f.write_str("the tooth does not come to it"),
            Absence::Withheld(refusal) => write!(f, "{refusal}; {}", refusal.mend()),
            Absence::Unclosed => {
                f.write_str("the end of the impact D' does not exist, since the triangle of Eq. 34 does not close")
            }
        }
    }
}
