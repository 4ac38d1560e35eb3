//! A formula written with numbers in the place of its symbols.

use super::formula::Tree;
use crate::numeric::decimal::significant;

/// A space at which no line ends, between a number and its unit.
pub(super) const GLUE: &str = "\u{a0}";

/// How many digits a term is given at most: all that its number has.
const MOST_DIGITS: usize = 17;

/// What stands in the place of a symbol.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Term {
    /// As the case writes it, and its value in SI.
    Written(String, f64),
    /// A value in SI, shown in a unit that is worth so much.
    Rounded {
        value: f64,
        unit: &'static str,
        factor: f64,
    },
}

impl Term {
    /// Its value in SI.
    pub(super) fn value(&self) -> f64 {
        match self {
            Term::Written(_, value) | Term::Rounded { value, .. } => *value,
        }
    }

    /// What is shown with that many digits.
    pub(super) fn text(&self, digits: usize) -> String {
        match self {
            Term::Written(text, _) => text.clone(),
            Term::Rounded {
                value,
                unit,
                factor,
            } => with_unit(&tidy(value / factor, digits), unit),
        }
    }

    /// What is shown with that many digits, in SI.
    fn shown_value(&self, digits: usize) -> Option<f64> {
        match self {
            Term::Written(_, value) => Some(*value),
            Term::Rounded { value, factor, .. } => {
                Some(significant(value / factor, digits).parse::<f64>().ok()? * factor)
            }
        }
    }
}

/// A number and its unit, which a number alone has not.
pub(super) fn with_unit(number: &str, unit: &str) -> String {
    if matches!(unit, "" | "1") {
        number.to_owned()
    } else {
        format!("{number} {unit}")
    }
}

/// A number with that many digits, without the zeros at the end of one that has no more.
pub(super) fn tidy(value: f64, digits: usize) -> String {
    const EXACT: f64 = 4.0 * f64::EPSILON;
    let full = significant(value, digits);
    if !full.contains('.') || full.contains('e') {
        return full;
    }
    let short = full.trim_end_matches('0').trim_end_matches('.');
    let exact = short
        .parse::<f64>()
        .is_ok_and(|found| (found - value).abs() <= EXACT * value.abs());
    if exact { short.to_owned() } else { full }
}

/// The formula with the terms in it, each with the fewest digits (but no fewer than `digits`) from
/// which the formula gives what `tells` accepts; `None` where even all digits do not.
pub(super) fn written(
    tree: &Tree,
    digits: usize,
    term: &dyn Fn(&str) -> Option<Term>,
    tells: &dyn Fn(f64) -> bool,
) -> Option<String> {
    let enough = (digits..=MOST_DIGITS).find(|&digits| {
        let found = tree.value(&|symbol| term(symbol)?.shown_value(digits));
        found.is_some_and(tells)
    })?;
    Some(
        Writer {
            term,
            digits: enough,
        }
        .write(tree, Place::Open),
    )
}

/// Where a part stands, which decides what must be put in parentheses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    /// Alone, or between parentheses.
    Open,
    /// Behind a plus or a minus.
    InSum,
    /// Among factors.
    InProduct,
    /// Behind a stroke, under an exponent.
    Tight,
}

struct Writer<'a> {
    term: &'a dyn Fn(&str) -> Option<Term>,
    digits: usize,
}

impl Writer<'_> {
    fn write(&self, tree: &Tree, place: Place) -> String {
        match tree {
            Tree::Number(text) => text.clone(),
            Tree::Pi => "π".to_owned(),
            Tree::Symbol(symbol) => self.symbol(symbol, place),
            Tree::Unit(unit) => closed(
                format!("1 {unit}").replace(' ', GLUE),
                place == Place::Tight,
            ),
            Tree::Sum(terms) => closed(self.sum(terms), place > Place::Open),
            Tree::Product(factors) => closed(self.product(factors), place > Place::InSum),
            Tree::Power(base, exponent) => format!(
                "{}{}",
                self.write(base, Place::Tight),
                self.exponent(exponent)
            ),
            Tree::Root(inner) => format!("√({})", self.write(inner, Place::Open)),
            Tree::Absolute(inner) => format!("|{}|", self.write(inner, Place::Open)),
            Tree::Call(function, arguments) => {
                let arguments: Vec<String> = arguments
                    .iter()
                    .map(|argument| self.write(argument, Place::Open))
                    .collect();
                format!("{}({})", function.name, arguments.join(", "))
            }
        }
    }

    fn symbol(&self, symbol: &str, place: Place) -> String {
        let text =
            (self.term)(symbol).map_or_else(|| symbol.to_owned(), |term| term.text(self.digits));
        let wraps = text.starts_with('-') && place > Place::Open
            || text.contains(' ') && place == Place::Tight;
        closed(text.replace(' ', GLUE), wraps)
    }

    fn sum(&self, terms: &[(bool, Tree)]) -> String {
        let mut text = String::new();
        for (index, (taken, term)) in terms.iter().enumerate() {
            text += match (index, taken) {
                (0, true) => "-",
                (0, false) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            };
            text += &match term {
                Tree::Product(factors) => self.product(factors),
                other => self.write(
                    other,
                    if text.is_empty() {
                        Place::Open
                    } else {
                        Place::InSum
                    },
                ),
            };
        }
        text
    }

    fn product(&self, factors: &[(bool, Tree)]) -> String {
        let mut text = String::new();
        for (index, (divides, factor)) in factors.iter().enumerate() {
            let written = self.write(
                factor,
                if *divides {
                    Place::Tight
                } else {
                    Place::InProduct
                },
            );
            text += match index {
                0 => "",
                _ if *divides && [&text, &written].iter().any(|part| part.contains(GLUE)) => " / ",
                _ if *divides => "/",
                _ => " · ",
            };
            text += &written;
        }
        text
    }

    fn exponent(&self, exponent: &Tree) -> String {
        match exponent {
            Tree::Number(text) if text == "2" => "²".to_owned(),
            Tree::Number(text) if text == "3" => "³".to_owned(),
            Tree::Number(text) if text == "4" => "⁴".to_owned(),
            other => format!("^({})", self.write(other, Place::Open)),
        }
    }
}

fn closed(text: String, wraps: bool) -> String {
    if wraps { format!("({text})") } else { text }
}

#[cfg(test)]
mod tests {
    use super::{Term, written};
    use crate::report::explain::formula::Tree;

    fn term(symbol: &str) -> Option<Term> {
        Some(match symbol {
            "v" => Term::Rounded {
                value: 0.821_063_9,
                unit: "m/s",
                factor: 1.0,
            },
            "b" => Term::Written("8 mm".to_owned(), 8e-3),
            "M" => Term::Rounded {
                value: 0.113_731_2,
                unit: "kg",
                factor: 1.0,
            },
            "q" => Term::Rounded {
                value: 0.127_770_4e-9,
                unit: "um mm/N",
                factor: 1e-9,
            },
            "x" => Term::Rounded {
                value: -0.3,
                unit: "1",
                factor: 1.0,
            },
            _ => return None,
        })
    }

    fn text(formula: &str) -> Option<String> {
        written(&Tree::read(formula)?, 5, &term, &|_| true)
            .map(|text| text.replace(super::GLUE, " "))
    }

    #[test]
    fn every_operation_stays_what_it_was() {
        for (formula, expected) in [
            (
                "v √(b M/q)",
                "0.82106 m/s · √(8 mm · 0.11373 kg / (0.12777 um mm/N))",
            ),
            ("b/2 (x + 1)", "8 mm / 2 · (-0.3 + 1)"),
            ("1 - x", "1 - (-0.3)"),
            (
                "b² - b (M v)/q",
                "(8 mm)² - 8 mm · (0.11373 kg · 0.82106 m/s) / (0.12777 um mm/N)",
            ),
            ("-(b + b) x", "-(8 mm + 8 mm) · (-0.3)"),
            ("(b M)^(1/5)", "(8 mm · 0.11373 kg)^(1/5)"),
            ("atan2(b, -x)", "atan2(8 mm, -(-0.3))"),
        ] {
            assert_eq!(text(formula).as_deref(), Some(expected), "{formula}");
        }
    }

    #[test]
    fn a_term_has_as_many_digits_as_the_value_needs() {
        let tree = Tree::read("v").unwrap();
        let close = |found: f64| (found - 0.821_063_9).abs() < 1e-8;
        assert_eq!(
            written(&tree, 3, &term, &close).as_deref(),
            Some("0.8210639\u{a0}m/s")
        );
        assert_eq!(written(&tree, 3, &term, &|_| false), None);
    }
}
