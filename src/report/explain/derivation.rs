//! The formula of a quantity and of each step before it, with the numbers of a case.

use std::collections::VecDeque;
use std::sync::LazyLock;

use crate::case::fields::{Kind, index_of};
use crate::case::{Case, FIELDS, units};
use crate::model::compliance::{contact_of, model_of};
use crate::model::explanation::{Context, Equation, Formula, Step, in_section, tidy};
use crate::model::impact::StiffnessModels;
use crate::model::quantities::{spread_force, steps};
use crate::model::{QUANTITIES, Quantity};
use crate::numeric::decimal::significant;
use crate::report::{Shown, shown, value};
use serde::{Serialize, Serializer};

/// Significant digits of a step.
const STEP_DIGITS: usize = 5;

/// Additional digits of a term compared with the result.
const MORE_DIGITS: usize = 1;

/// Digits of the terms of a formula that subtracts close numbers.
const DIFFERENCE_DIGITS: usize = 10;

/// Bounds for the agreement of both sides of an equation.
const BOUNDS: [f64; 3] = [1e-12, 1e-9, 1e-6];

/// A value and how it is computed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Work {
    /// The symbol in formulas.
    pub symbol: &'static str,
    /// The meaning of a step; empty for the quantity itself.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub meaning: &'static str,
    /// The right-hand side, the equation, or a description.
    pub formula: String,
    /// How the formula gives the value.
    pub how: How,
    /// The right-hand side with numbers. No line ends between a number and its unit.
    #[serde(serialize_with = "without_glue")]
    pub numbers: Option<String>,
    /// The value as text.
    pub shown: Option<Shown>,
    /// Its significant digits.
    #[serde(skip)]
    pub digits: usize,
    /// The value in SI.
    #[serde(skip)]
    pub value: Option<f64>,
    /// The agreement of both sides of an equation at its root.
    pub residual: Option<String>,
}

/// How a formula gives a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum How {
    /// The value is the right-hand side.
    Equals,
    /// The value is the root of an equation.
    Solves,
    /// A description replaces the formula.
    Described,
}

/// A symbol of a formula whose value comes from another page or from the form.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Leaf {
    /// The symbol.
    pub symbol: &'static str,
    /// The key of the quantity or of the field.
    pub key: &'static str,
    /// Its value as text.
    pub shown: String,
    /// Its meaning.
    pub meaning: &'static str,
    /// Its value in SI.
    #[serde(skip)]
    pub value: Option<f64>,
}

impl Work {
    /// A step before it has a formula.
    fn step(
        symbol: &'static str,
        meaning: &'static str,
        value: Option<f64>,
        unit: &'static str,
    ) -> Work {
        Work {
            symbol,
            meaning,
            formula: String::new(),
            how: How::Described,
            numbers: None,
            shown: value.map(|value| in_unit(value, unit, STEP_DIGITS)),
            digits: STEP_DIGITS,
            value,
            residual: None,
        }
    }
}

/// The derivation of a quantity, and the symbols that its formulas read from elsewhere.
pub(super) fn derivation_of(quantity: &'static Quantity, known: &Known) -> (Vec<Work>, Vec<Leaf>) {
    let own = known.quantity(quantity);
    let mut work = derived(
        Work {
            digits: quantity.digits,
            shown: own.value.map(|value| shown(quantity, value)),
            ..Work::step(own.symbol, "", own.value, quantity.shown)
        },
        quantity.formula,
        known,
    );
    let mut seen = vec![own.symbol];
    let mut leaves = Vec::new();
    let mut open = VecDeque::from(symbols_of(quantity.formula, known));
    while let Some(symbol) = open.pop_front() {
        let source = known.source(&symbol).filter(|source| !seen.contains(&source.symbol));
        let Some(source) = source else { continue };
        seen.push(source.symbol);
        let Source { symbol, meaning, value, unit, origin } = source;
        let (key, text) = match origin {
            Origin::Step(formula) => {
                work.extend(derived(Work::step(symbol, meaning, value, unit), formula, known));
                open.extend(symbols_of(formula, known));
                continue;
            }
            Origin::Quantity(quantity) => {
                (quantity.key, value.map(|value| shown(quantity, value).to_string()))
            }
            Origin::Field(field) => {
                (FIELDS[field].key, value.map(|value| known.field_text(field, value)))
            }
        };
        let shown = text.unwrap_or_else(|| "no value".to_owned());
        leaves.push(Leaf { symbol, key, shown, meaning, value });
    }
    (work, leaves)
}

/// The work with its formula: with numbers if it is explicit, with both sides if it is an equation.
fn derived(work: Work, formula: Formula, known: &Known) -> Vec<Work> {
    match formula.resolved(known.context.inputs) {
        Formula::Given(key) => {
            let text = index_of(key).and_then(|field| known.case.effective(field));
            let formula = format!("the case gives {key} = {}", text.unwrap_or_default());
            vec![Work { formula, ..work }]
        }
        Formula::Words(words) | Formula::Found(words, _) => {
            vec![Work { formula: words.to_owned(), ..work }]
        }
        Formula::Solved(equation) => solved(work, equation, known),
        other => {
            let formula = other.explicit(&known.context).unwrap_or_default();
            let digits = match other {
                _ if symbols(&formula) == [formula.as_str()] => work.digits,
                Formula::Difference(_) => DIFFERENCE_DIGITS,
                _ => work.digits + MORE_DIGITS,
            };
            let term = |symbol: &str| known.term(symbol, digits);
            let numbers = work.value.and_then(|_| substituted(&formula, &term));
            // In some cases words take the place of a formula that depends on the case.
            let is_words = matches!(other, Formula::Made(_)) && numbers.is_none();
            let how = if is_words { How::Described } else { How::Equals };
            vec![Work { formula, how, numbers, ..work }]
        }
    }
}

/// The root of an equation, its agreement, and both sides.
fn solved(work: Work, equation: &'static Equation, known: &Known) -> Vec<Work> {
    let sides = work.value.and_then(|_| (equation.sides)(&known.context));
    let residual = sides.map(agreement);
    let formula = in_section(equation.text, known.context.inputs);
    let root = Work { residual, formula, how: How::Solves, ..work };
    let side = |name, at: usize, formula| {
        let value = sides.map(|sides| sides[at]);
        derived(Work::step(name, "", value, equation.unit), formula, known)
    };
    let (left, right) =
        (side("left side", 0, equation.left), side("right side", 1, equation.right));
    [root].into_iter().chain(left).chain(right).collect()
}

/// How closely the two sides of an equation agree.
fn agreement([left, right]: [f64; 2]) -> String {
    let apart = (left - right).abs() / right.abs();
    let bound = BOUNDS.into_iter().find(|&bound| apart <= bound);
    let within = bound.map_or_else(|| significant(apart, 2), |bound| format!("{bound:e}"));
    format!("both sides agree within {within} of either")
}

/// The symbols of a formula, in reading order.
fn symbols_of(formula: Formula, known: &Known) -> Vec<String> {
    match formula.resolved(known.context.inputs) {
        Formula::Solved(equation) => [equation.left, equation.right]
            .into_iter()
            .flat_map(|side| symbols_of(side, known))
            .collect(),
        Formula::Found(_, with) => with.iter().map(|&symbol| symbol.to_owned()).collect(),
        other => other.explicit(&known.context).map(|text| symbols(&text)).unwrap_or_default(),
    }
}

/// A no-break space, between a number and its unit.
pub(super) const GLUE: &str = "\u{a0}";

/// Names of functions; √ has no name.
const FUNCTIONS: [&str; 11] =
    ["sin", "cos", "tan", "asin", "acos", "atan", "atan2", "ln", "inv", "min", "max"];

const SUPERSCRIPTS: [char; 3] = ['²', '³', '⁴'];

#[expect(clippy::ref_option, reason = "the form that serde requires")]
fn without_glue<S: Serializer>(numbers: &Option<String>, to: S) -> Result<S::Ok, S::Error> {
    numbers.as_ref().map(|numbers| numbers.replace(GLUE, " ")).serialize(to)
}

/// A value in SI in a unit.
fn in_unit(value: f64, unit: &'static str, digits: usize) -> Shown {
    let number = tidy(value / factor(unit).unwrap_or(1.0), digits);
    Shown { number, unit: if unit == "1" { "" } else { unit } }
}

/// A part of a formula, as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Token<'a> {
    /// A number, or π.
    Number(&'a str),
    /// The symbol of a value.
    Symbol(&'a str),
    /// The name of a function, or √.
    Function(&'a str),
    /// A unit, without its brackets.
    Unit(&'a str),
    /// An operator, a parenthesis, a comma or an exponent.
    Mark(char),
}

/// The tokens of a formula; `None` if a character is not part of any token.
pub fn tokens(text: &str) -> Option<Vec<Token<'_>>> {
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '0'..='9' => length(rest, |c, _| c.is_ascii_digit() || c == '.'),
            _ if is_letter(first) => length(rest, |c, next| {
                is_letter(c) || "_'*".contains(c) || c == ',' && is_letter(next)
            }),
            '[' => rest.find(']')? + 1,
            _ => first.len_utf8(),
        };
        let (token, after) = rest.split_at(length);
        found.push(match first {
            '0'..='9' => Token::Number(token),
            'π' if token == "π" => Token::Number(token),
            '√' => Token::Function(token),
            _ if FUNCTIONS.contains(&token) => Token::Function(token),
            _ if is_letter(first) => Token::Symbol(token),
            '[' => Token::Unit(&token[1..token.len() - 1]),
            '+' | '-' | '·' | '/' | '^' | '(' | ')' | ',' | '|' | '²' | '³' | '⁴' => {
                Token::Mark(first)
            }
            _ => return None,
        });
        rest = after.trim_start();
    }
    Some(found)
}

fn is_letter(c: char) -> bool {
    c.is_alphanumeric() && !SUPERSCRIPTS.contains(&c)
}

/// Length in bytes of the first token of the text.
fn length(text: &str, belongs: impl Fn(char, char) -> bool) -> usize {
    let next = |at: usize, c: char| text[at + c.len_utf8()..].chars().next().unwrap_or(' ');
    text.char_indices().find(|&(at, c)| !belongs(c, next(at, c))).map_or(text.len(), |(at, _)| at)
}

/// Every symbol of a formula, in reading order.
pub(super) fn symbols(text: &str) -> Vec<String> {
    let symbol = |token| match token {
        Token::Symbol(symbol) => Some(symbol.to_owned()),
        _ => None,
    };
    let tokens = tokens(text).unwrap_or_default();
    tokens.into_iter().filter_map(symbol).collect()
}

/// The formula with the value and the unit of each symbol; `None` if a symbol has no value.
fn substituted(text: &str, term: &dyn Fn(&str) -> Option<String>) -> Option<String> {
    let tokens = tokens(text)?;
    let mut written = String::new();
    // Whether the last token ends an operand, and whether a function expects its argument.
    let (mut is_operand, mut is_argument) = (false, false);
    for (at, &token) in tokens.iter().enumerate() {
        let before = at.checked_sub(1).map(|before| tokens[before]);
        let after = tokens.get(at + 1).copied();
        let starts = match token {
            Token::Mark(mark) => mark == '(' || mark == '|' && !is_operand,
            _ => true,
        };
        if starts && is_operand {
            written += " · ";
        }
        let operand = match token {
            Token::Number(number) => Some(number.to_owned()),
            Token::Symbol(symbol) => Some(term(symbol)?),
            Token::Unit(unit) => Some(format!("1 {unit}")),
            Token::Function(name) => {
                written += name;
                is_argument = after != Some(Token::Mark('('));
                written += if is_argument { "(" } else { "" };
                None
            }
            Token::Mark(mark) => {
                let has_numbers =
                    [before, after].iter().all(|token| matches!(token, Some(Token::Number(_))));
                written += &marked(mark, is_operand, has_numbers);
                None
            }
        };
        is_operand = match token {
            Token::Mark(mark) => {
                mark == ')' || mark == '|' && !starts || SUPERSCRIPTS.contains(&mark)
            }
            Token::Function(_) => false,
            _ => true,
        };
        if let Some(text) = operand {
            let wraps = !is_argument && needs_parentheses(&text, before, after);
            let text = text.replace(' ', GLUE);
            let (open, close) = match (wraps, is_argument) {
                (true, _) => ("(", ")"),
                (_, true) => ("", ")"),
                _ => ("", ""),
            };
            written.extend([open, &text, close]);
            is_argument = false;
        }
    }
    Some(written)
}

/// A mark with its spaces; a slash between two numbers has none.
fn marked(mark: char, is_behind_operand: bool, is_between_numbers: bool) -> String {
    match mark {
        '+' | '-' | '·' if is_behind_operand => format!(" {mark} "),
        '/' if !is_between_numbers => " / ".to_owned(),
        ',' => ", ".to_owned(),
        _ => mark.to_string(),
    }
}

/// Whether a value needs parentheses between these tokens.
fn needs_parentheses(text: &str, before: Option<Token>, after: Option<Token>) -> bool {
    let is_raised = match after {
        Some(Token::Mark(mark)) => mark == '^' || SUPERSCRIPTS.contains(&mark),
        _ => false,
    };
    let is_tight = is_raised || before == Some(Token::Mark('/'));
    let is_open = matches!(before, None | Some(Token::Mark('(' | ',' | '|')));
    text.contains(' ') && is_tight || text.starts_with('-') && (is_raised || !is_open)
}

/// Units of steps that no field or quantity has, with their factors to SI.
pub const STEP_UNITS: [(&str, f64); 5] =
    [("mm4", 1e-12), ("N/(um mm)", 1e9), ("N/m", 1.0), ("Hz", 1.0), ("N s/m", 1.0)];

/// Digits of a field value that is derived from other fields.
const DERIVED_DIGITS: usize = 6;

/// A solved case for the explanation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known<'a> {
    /// The case as the user wrote it.
    pub(super) case: &'a Case,
    /// Inputs and results.
    pub(super) context: Context<'a>,
}

/// A symbol of a formula: its value in SI, the unit of its text, and its origin.
struct Source {
    symbol: &'static str,
    meaning: &'static str,
    value: Option<f64>,
    unit: &'static str,
    origin: Origin,
}

enum Origin {
    /// A quantity, which has a page of its own.
    Quantity(&'static Quantity),
    /// A step that formulas share, or the impact force by another stiffness model.
    Step(Formula),
    /// A field of the case, by index.
    Field(usize),
}

/// The impact force by another stiffness model.
struct Force {
    symbol: String,
    meaning: String,
    models: StiffnessModels,
}

static FORCES: LazyLock<Vec<Force>> = LazyLock::new(|| {
    let force = |models: StiffnessModels| Force {
        symbol: models.symbol(),
        meaning: format!("by {}", models.names()),
        models,
    };
    StiffnessModels::all().map(force).collect()
});

impl Known<'_> {
    /// A quantity as a symbol of a formula.
    fn quantity(&self, quantity: &'static Quantity) -> Source {
        let method = self.context.solution.method;
        Source {
            symbol: quantity.symbol_in(method),
            meaning: quantity.label_in(method).trim_start(),
            value: value(quantity, self.context.solution),
            unit: quantity.shown,
            origin: Origin::Quantity(quantity),
        }
    }

    fn source(&self, symbol: &str) -> Option<Source> {
        let Context { inputs, solution, .. } = self.context;
        let is_meant = |quantity: &&Quantity| {
            quantity.symbol_in(solution.method) == symbol && !quantity.is_flag()
        };
        let mut source = if let Some(quantity) = QUANTITIES.iter().find(is_meant) {
            self.quantity(quantity)
        } else if let Some(&Step { symbol, meaning, unit, formula, value }) = self.step(symbol) {
            let (value, origin) = (value(&self.context), Origin::Step(formula));
            Source { symbol, meaning, value, unit, origin }
        } else if let Some(force) = FORCES.iter().find(|force| force.symbol == symbol) {
            let covers = (force.models.tooth.model().covers)(inputs);
            Source {
                symbol: &force.symbol,
                meaning: &force.meaning,
                value: covers.then(|| spread_force(inputs, &force.models)).flatten(),
                unit: "N",
                origin: Origin::Step(Formula::Words("a separate solution with these models")),
            }
        } else {
            let field = FIELDS.iter().position(|field| field.symbol == symbol)?;
            let derived = || self.case.derived(field, self.context.given);
            Source {
                symbol: FIELDS[field].symbol,
                meaning: FIELDS[field].label,
                value: self.case.value(field).or_else(derived),
                unit: "",
                origin: Origin::Field(field),
            }
        };
        source.value = source.value.filter(|value| value.is_finite()).map(|value| value + 0.0);
        Some(source)
    }

    /// A step whose value no field of the case gives; the torque can be either.
    fn step(&self, symbol: &str) -> Option<&'static Step> {
        let inputs = self.context.inputs;
        let contact = contact_of(inputs).map_or(&[][..], |contact| contact.model().steps);
        let models = model_of(inputs).model().steps.iter().chain(contact);
        let is_given = |step: &Step| matches!(step.formula.resolved(inputs), Formula::Given(_));
        steps().chain(models).find(|step| step.symbol == symbol && !is_given(step))
    }

    /// The value of a symbol as text of a formula, with at most `digits` significant digits.
    fn term(&self, symbol: &str, digits: usize) -> Option<String> {
        let Source { value, unit, origin, .. } = self.source(symbol)?;
        let value = value?;
        Some(match origin {
            Origin::Field(field) => self.field_text(field, value),
            _ => in_unit(value, unit, digits).to_string(),
        })
    }

    /// The value of a field as the user wrote it; in the usual unit of the field if that text would
    /// be ambiguous in a formula.
    fn field_text(&self, field: usize, value: f64) -> String {
        let usual = match FIELDS[field].kind {
            Kind::Number(_, range, _) => range.unit,
            _ => "",
        };
        match self.case.effective(field) {
            Some(text) => plainly_written(text).unwrap_or_else(|| units::text(value, usual)),
            None => in_unit(value, usual, DERIVED_DIGITS).to_string(),
        }
    }
}

/// The factor of a unit to SI; `None` for an unknown unit.
pub(super) fn factor(unit: &str) -> Option<f64> {
    let of_step = || STEP_UNITS.iter().find(|(name, _)| *name == unit).map(|&(_, factor)| factor);
    units::factor(unit).or_else(of_step)
}

/// A number with a unit of letters and slashes, separated by one space.
fn plainly_written(text: &str) -> Option<String> {
    let (number, unit) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
    let is_number = number.bytes().all(|byte| byte.is_ascii_digit() || b".-".contains(&byte))
        && number.parse::<f64>().is_ok();
    let is_unit = unit.bytes().all(|byte| byte.is_ascii_alphanumeric() || b" /".contains(&byte))
        && units::factor(unit).is_some();
    (is_number && is_unit).then(|| format!("{number} {unit}").trim_end().to_owned())
}

#[cfg(test)]
mod tests {
    use super::{GLUE, substituted, symbols};

    fn term(symbol: &str) -> Option<String> {
        let text = match symbol {
            "v" => "0.82106 m/s",
            "b" => "8 mm",
            "M" => "0.11373 kg",
            "q" => "0.12777 um mm/N",
            "x" => "-0.3",
            "α" => "20 deg",
            _ => return None,
        };
        Some(text.to_owned())
    }

    #[test]
    fn values_replace_symbols_and_the_formula_keeps_its_meaning() {
        for (formula, expected) in [
            ("v √(b M/q)", "0.82106 m/s · √(8 mm · 0.11373 kg / (0.12777 um mm/N))"),
            ("b/2 (x + 1)", "8 mm / 2 · (-0.3 + 1)"),
            ("1 - x", "1 - (-0.3)"),
            ("|x - 1|/|v|", "|-0.3 - 1| / |0.82106 m/s|"),
            ("b² - b (M v)/q", "(8 mm)² - 8 mm · (0.11373 kg · 0.82106 m/s) / (0.12777 um mm/N)"),
            ("-(b + b) x", "-(8 mm + 8 mm) · (-0.3)"),
            ("(b M)^(1/5)", "(8 mm · 0.11373 kg)^(1/5)"),
            ("atan2(b, -x)", "atan2(8 mm, -(-0.3))"),
            ("2 tan α/(1 + x)", "2 · tan(20 deg) / (1 + (-0.3))"),
            ("π b cos α", "π · 8 mm · cos(20 deg)"),
            ("(1 + x²) [N/(um mm)]", "(1 + (-0.3)²) · 1 N/(um mm)"),
        ] {
            let found = substituted(formula, &term).map(|text| text.replace(GLUE, " "));
            assert_eq!(found.as_deref(), Some(expected), "{formula}");
        }
    }

    #[test]
    fn a_formula_without_a_value_for_a_symbol_has_no_numbers() {
        for formula in ["b unknown", "b ? 2"] {
            assert_eq!(substituted(formula, &term), None, "{formula}");
        }
        assert_eq!(symbols("ha*1 + r_b2' cos T_S,32"), ["ha*1", "r_b2'", "T_S,32"]);
    }
}
