//! Evaluates a printed formula such as `ΔV_n √(b M/q_s)` with the values of its symbols.

use std::f64::consts::PI;

use super::evaluate::factor;
use tipstrike::report::explain::{Token, tokens};

/// A right-hand side.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Tree {
    /// A literal, as written.
    Number(String),
    /// π.
    Pi,
    /// A symbol.
    Symbol(String),
    /// The factor of a unit, in brackets.
    Unit(String),
    /// Terms, each with whether it is subtracted.
    Sum(Vec<(bool, Tree)>),
    /// Factors, each with whether it is a divisor.
    Product(Vec<(bool, Tree)>),
    /// Base and exponent.
    Power(Box<Tree>, Box<Tree>),
    /// √.
    Root(Box<Tree>),
    /// Absolute value.
    Absolute(Box<Tree>),
    /// A function with one or more arguments.
    Call(Function, Vec<Tree>),
}

/// A function by its printed name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Function {
    pub(crate) name: &'static str,
    arguments: usize,
    of: fn(&[f64]) -> f64,
}

impl PartialEq for Function {
    fn eq(&self, other: &Function) -> bool {
        self.name == other.name
    }
}

/// Every function; the number of arguments is 0 if it is not fixed.
const FUNCTIONS: [Function; 9] = [
    Function { name: "sin", arguments: 1, of: |x| x[0].sin() },
    Function { name: "cos", arguments: 1, of: |x| x[0].cos() },
    Function { name: "tan", arguments: 1, of: |x| x[0].tan() },
    Function { name: "acos", arguments: 1, of: |x| x[0].acos() },
    Function { name: "atan2", arguments: 2, of: |x| x[0].atan2(x[1]) },
    Function { name: "ln", arguments: 1, of: |x| x[0].ln() },
    Function { name: "inv", arguments: 1, of: |x| x[0].tan() - x[0] },
    Function { name: "min", arguments: 0, of: |x| x.iter().copied().fold(f64::INFINITY, f64::min) },
    Function {
        name: "max",
        arguments: 0,
        of: |x| x.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    },
];

impl Tree {
    /// The tree of a text; `None` if the text is not a formula.
    pub(crate) fn read(text: &str) -> Option<Tree> {
        let mut reader = Reader { tokens: tokens(text)?, at: 0 };
        let tree = reader.sum()?;
        (reader.at == reader.tokens.len()).then_some(tree)
    }

    /// Its value, if every symbol has one.
    pub(crate) fn value(&self, of: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
        let list =
            |parts: &[Tree]| parts.iter().map(|part| part.value(of)).collect::<Option<Vec<f64>>>();
        match self {
            Tree::Number(text) => text.parse().ok(),
            Tree::Pi => Some(PI),
            Tree::Symbol(symbol) => of(symbol),
            Tree::Unit(unit) => factor(unit),
            Tree::Sum(terms) => terms.iter().try_fold(0.0, |sum, (taken, term)| {
                let term = term.value(of)?;
                Some(if *taken { sum - term } else { sum + term })
            }),
            Tree::Product(factors) => factors.iter().try_fold(1.0, |product, (divides, factor)| {
                let factor = factor.value(of)?;
                Some(if *divides { product / factor } else { product * factor })
            }),
            Tree::Power(base, exponent) => Some(base.value(of)?.powf(exponent.value(of)?)),
            Tree::Root(inner) => Some(inner.value(of)?.sqrt()),
            Tree::Absolute(inner) => Some(inner.value(of)?.abs()),
            Tree::Call(function, arguments) => {
                list(arguments).map(|arguments| (function.of)(&arguments))
            }
        }
    }
}

const SUPERSCRIPTS: [(char, &str); 3] = [('²', "2"), ('³', "3"), ('⁴', "4")];

/// Tokens and the number of read ones.
struct Reader<'a> {
    tokens: Vec<Token<'a>>,
    at: usize,
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

    fn sum(&mut self) -> Option<Tree> {
        let mut terms = vec![(self.took('-'), self.product()?)];
        while let Some(Token::Mark(mark @ ('+' | '-'))) = self.peek() {
            self.at += 1;
            terms.push((mark == '-', self.product()?));
        }
        Some(if matches!(terms[..], [(false, _)]) { terms.remove(0).1 } else { Tree::Sum(terms) })
    }

    fn product(&mut self) -> Option<Tree> {
        let mut factors = vec![(false, self.factor()?)];
        loop {
            let divides = self.took('/');
            let is_factor = divides || self.took('·');
            let follows = matches!(
                self.peek(),
                Some(
                    Token::Number(_)
                        | Token::Symbol(_)
                        | Token::Function(_)
                        | Token::Unit(_)
                        | Token::Mark('(')
                )
            );
            if !is_factor && !follows {
                break;
            }
            factors.push((divides, self.factor()?));
        }
        Some(if factors.len() == 1 { factors.remove(0).1 } else { Tree::Product(factors) })
    }

    fn factor(&mut self) -> Option<Tree> {
        let base = self.base()?;
        if self.took('^') {
            return Some(Tree::Power(Box::new(base), Box::new(self.base()?)));
        }
        let raised = SUPERSCRIPTS.iter().find(|(mark, _)| self.took(*mark));
        Some(match raised {
            Some((_, exponent)) => {
                Tree::Power(Box::new(base), Box::new(Tree::Number((*exponent).to_owned())))
            }
            None => base,
        })
    }

    fn base(&mut self) -> Option<Tree> {
        let token = self.peek()?;
        self.at += 1;
        match token {
            Token::Number("π") => Some(Tree::Pi),
            Token::Number(text) => Some(Tree::Number(text.to_owned())),
            Token::Symbol(symbol) => Some(Tree::Symbol(symbol.to_owned())),
            Token::Function("√") => Some(Tree::Root(Box::new(self.base()?))),
            Token::Function(name) => {
                let mut functions = FUNCTIONS.into_iter();
                self.call(functions.find(|function| function.name == name)?)
            }
            Token::Unit(unit) => Some(Tree::Unit(unit.to_owned())),
            Token::Mark('(') => self.closed(')'),
            Token::Mark('|') => Some(Tree::Absolute(Box::new(self.closed('|')?))),
            Token::Mark(_) => None,
        }
    }

    fn closed(&mut self, end: char) -> Option<Tree> {
        let inner = self.sum()?;
        self.took(end).then_some(inner)
    }

    fn call(&mut self, function: Function) -> Option<Tree> {
        let mut arguments = Vec::new();
        if self.took('(') {
            arguments.push(self.sum()?);
            while self.took(',') {
                arguments.push(self.sum()?);
            }
            if !self.took(')') {
                return None;
            }
        } else {
            arguments.push(self.base()?);
        }
        let fits = function.arguments == 0 || function.arguments == arguments.len();
        fits.then_some(Tree::Call(function, arguments))
    }
}

fn value(text: &str) -> f64 {
    let of = |symbol: &str| {
        Some(match symbol {
            "a" | "ha*1" => 2.0,
            "T_S,32" => 3.0,
            "r_b2'" => 5.0,
            _ => return None,
        })
    };
    Tree::read(text).and_then(|tree| tree.value(&of)).unwrap_or(f64::NAN)
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
        assert!((value(text) - expected).abs() < 1e-15, "{text}: {}", value(text));
    }
}

#[test]
fn the_evaluator_refuses_a_text_that_is_no_formula() {
    for text in ["", "a +", "(a", "a)", "|a", "atan2(a)", "a ? a", "a ^", "cos"] {
        assert_eq!(Tree::read(text), None, "{text}");
    }
    assert!(value("unknown").is_nan());
}
