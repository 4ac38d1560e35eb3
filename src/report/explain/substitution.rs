//! Substitution of the values of a case for the symbols of a formula, token by token.

use crate::model::explanation::tidy;

/// A no-break space, between a number and its unit.
pub(super) const GLUE: &str = "\u{a0}";

/// Names of functions; √ has no name.
const FUNCTIONS: [&str; 9] = ["sin", "cos", "tan", "acos", "atan2", "ln", "inv", "min", "max"];

const SUPERSCRIPTS: [char; 3] = ['²', '³', '⁴'];

/// The value of a symbol.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Term {
    /// A text of the case.
    Written(String),
    /// A value in a unit.
    Value(f64, &'static str),
}

impl Term {
    /// The value with its unit, with at most `digits` significant digits.
    pub(super) fn text(&self, digits: usize) -> String {
        match self {
            Term::Written(text) => text.clone(),
            Term::Value(value, unit) => with_unit(&tidy(*value, digits), unit),
        }
    }
}

/// A number and its unit, if it has one.
pub(super) fn with_unit(number: &str, unit: &str) -> String {
    if matches!(unit, "" | "1") { number.to_owned() } else { format!("{number} {unit}") }
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
#[must_use]
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

/// The formula with the value and the unit of each symbol, with at most `digits` digits; `None` if
/// a symbol has no value.
pub(super) fn substituted(
    text: &str,
    digits: usize,
    term: &dyn Fn(&str) -> Option<Term>,
) -> Option<String> {
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
            Token::Symbol(symbol) => Some(term(symbol)?.text(digits)),
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

#[cfg(test)]
mod tests {
    use super::{GLUE, Term, substituted, symbols};

    fn term(symbol: &str) -> Option<Term> {
        Some(match symbol {
            "v" => Term::Value(0.821_063_9, "m/s"),
            "b" => Term::Written("8 mm".to_owned()),
            "M" => Term::Value(0.113_731_2, "kg"),
            "q" => Term::Value(0.127_770_4, "um mm/N"),
            "x" => Term::Value(-0.3, "1"),
            "α" => Term::Written("20 deg".to_owned()),
            _ => return None,
        })
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
            let found = substituted(formula, 5, &term).map(|text| text.replace(GLUE, " "));
            assert_eq!(found.as_deref(), Some(expected), "{formula}");
        }
    }

    #[test]
    fn a_formula_without_a_value_for_a_symbol_has_no_numbers() {
        for formula in ["b unknown", "b ? 2"] {
            assert_eq!(substituted(formula, 5, &term), None, "{formula}");
        }
        assert_eq!(symbols("ha*1 + r_b2' cos T_S,32"), ["ha*1", "r_b2'", "T_S,32"]);
    }
}
