//! Evaluates a printed formula such as `ΔV_n √(b M/q_s)` with the values of its symbols.

use std::f64::consts::PI;

use super::evaluate::factor;
use tipstrike::report::explain::{Token, tokens};

/// The value of a formula; `None` if the text is not a formula, or a symbol has no value.
pub(crate) fn formula_value(text: &str, of: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
    let mut reader = Reader { tokens: tokens(text)?, at: 0, of };
    let value = reader.sum()?;
    (reader.at == reader.tokens.len()).then_some(value)
}

/// The value of a function; `None` for another name or number of arguments.
fn call(name: &str, arguments: &[f64]) -> Option<f64> {
    Some(match (name, arguments) {
        ("sin", [x]) => x.sin(),
        ("cos", [x]) => x.cos(),
        ("tan", [x]) => x.tan(),
        ("asin", [x]) => x.asin(),
        ("acos", [x]) => x.acos(),
        ("atan", [x]) => x.atan(),
        ("atan2", [y, x]) => y.atan2(*x),
        ("ln", [x]) => x.ln(),
        ("inv", [x]) => x.tan() - x,
        ("min", all) => all.iter().copied().fold(f64::INFINITY, f64::min),
        ("max", all) => all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        _ => return None,
    })
}

/// Tokens, the number of read ones, and the values of symbols.
struct Reader<'a> {
    tokens: Vec<Token<'a>>,
    at: usize,
    of: &'a dyn Fn(&str) -> Option<f64>,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Option<Token<'a>> {
        self.tokens.get(self.at).copied()
    }

    /// Reads the mark if it is next. Returns whether it was.
    fn took(&mut self, mark: char) -> bool {
        let is_next = self.peek() == Some(Token::Mark(mark));
        self.at += usize::from(is_next);
        is_next
    }

    fn sum(&mut self) -> Option<f64> {
        let mut sum = if self.took('-') { -self.product()? } else { self.product()? };
        loop {
            if self.took('+') {
                sum += self.product()?;
            } else if self.took('-') {
                sum -= self.product()?;
            } else {
                return Some(sum);
            }
        }
    }

    fn product(&mut self) -> Option<f64> {
        let mut product = self.power()?;
        loop {
            let follows = |token| !matches!(token, Token::Mark(mark) if mark != '(');
            if self.took('/') {
                product /= self.power()?;
            } else if self.took('·') || self.peek().is_some_and(follows) {
                product *= self.power()?;
            } else {
                return Some(product);
            }
        }
    }

    fn power(&mut self) -> Option<f64> {
        let base = self.base()?;
        if self.took('^') {
            return Some(base.powf(self.base()?));
        }
        let raised = [('²', 2), ('³', 3), ('⁴', 4)].into_iter().find(|(mark, _)| self.took(*mark));
        Some(raised.map_or(base, |(_, exponent)| base.powi(exponent)))
    }

    fn base(&mut self) -> Option<f64> {
        let token = self.peek()?;
        self.at += 1;
        match token {
            Token::Number("π") => Some(PI),
            Token::Number(text) => text.parse().ok(),
            Token::Symbol(symbol) => (self.of)(symbol),
            Token::Unit(unit) => factor(unit),
            Token::Function("√") => Some(self.base()?.sqrt()),
            Token::Function(name) => {
                let mut arguments = Vec::new();
                if !self.took('(') {
                    return call(name, &[self.base()?]);
                }
                arguments.push(self.sum()?);
                while self.took(',') {
                    arguments.push(self.sum()?);
                }
                if self.took(')') { call(name, &arguments) } else { None }
            }
            Token::Mark('(') => self.closed(')'),
            Token::Mark('|') => Some(self.closed('|')?.abs()),
            Token::Mark(_) => None,
        }
    }

    fn closed(&mut self, end: char) -> Option<f64> {
        let inner = self.sum()?;
        self.took(end).then_some(inner)
    }
}

fn value(text: &str) -> Option<f64> {
    let of = |symbol: &str| {
        Some(match symbol {
            "a" | "ha*1" => 2.0,
            "T_S,32" => 3.0,
            "r_b2'" => 5.0,
            _ => return None,
        })
    };
    formula_value(text, &of)
}

#[test]
fn the_evaluator_follows_the_precedence_of_print() {
    for (text, expected) in [
        ("1 + 2 3", 7.0),
        ("-(a + 1) T_S,32", -9.0),
        ("12/a T_S,32", 18.0),
        ("12/(a T_S,32)", 2.0),
        ("2 a²/r_b2' - ha*1", -0.4),
        ("√(a T_S,32 - 2)/a", 1.0),
        ("(a a)^(1/2)", 2.0),
        ("|1 - a|/|a - 4|", 0.5),
        ("min(r_b2', T_S,32)", 3.0),
        ("4 atan2(1, 1) - π", 0.0),
        ("cos π a + a", 0.0),
        ("3 sin(a - a) + inv(0)", 0.0),
        ("2 [N/(um mm)]/[mm]", 2e12),
    ] {
        let found = value(text).unwrap();
        assert!((found - expected).abs() < 1e-15, "{text}: {found}");
    }
}

#[test]
fn the_evaluator_refuses_a_text_that_is_no_formula() {
    for text in ["", "a +", "(a", "a)", "|a", "atan2(a)", "a ? a", "a ^", "cos"] {
        assert_eq!(value(text), None, "{text}");
    }
    assert_eq!(value("unknown"), None);
}
