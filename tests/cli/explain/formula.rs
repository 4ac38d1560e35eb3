//! Evaluates the printed numbers and formulas of a page, independently of the program.

use std::f64::consts::PI;

use tipstrike::case::units;
use tipstrike::report::explain::{STEP_UNITS, Token, tokens};

/// The space between a number and its unit.
const GLUE: char = '\u{a0}';

/// A part of an expression.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Item<'a> {
    Value(f64),
    Function(&'a str),
    Mark(char),
}

/// The value of printed numbers with units, such as `2 um · √(3 N/5 N)`, in SI.
pub(crate) fn evaluate(text: &str) -> f64 {
    value(&items(text)).unwrap_or_else(|| panic!("{text} is no expression"))
}

/// The value of a formula such as `ΔV_n √(b M/q_s)` with those of its symbols; `None` if the text is
/// not a formula, or a symbol has no value.
pub(crate) fn formula_value(text: &str, of: &dyn Fn(&str) -> Option<f64>) -> Option<f64> {
    let items: Option<Vec<Item>> = tokens(text)?
        .into_iter()
        .map(|token| {
            Some(match token {
                Token::Number("π") => Item::Value(PI),
                Token::Number(number) => Item::Value(number.parse().ok()?),
                Token::Symbol(symbol) => Item::Value(of(symbol)?),
                Token::Unit(unit) => Item::Value(factor(unit)?),
                Token::Function(name) => Item::Function(name),
                Token::Mark(mark) => Item::Mark(mark),
            })
        })
        .collect();
    value(&items?)
}

/// The factor of a unit to SI.
pub(crate) fn factor(unit: &str) -> Option<f64> {
    let step = || STEP_UNITS.iter().find(|(name, _)| *name == unit).map(|&(_, factor)| factor);
    units::factor(unit).or_else(step)
}

/// The parts of printed numbers.
fn items(text: &str) -> Vec<Item<'_>> {
    let (mut items, mut rest) = (Vec::new(), text);
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '0'..='9' | '.' => {
                let (number, length) = number(rest);
                items.push(Item::Value(number));
                length
            }
            'a'..='z' => {
                let is_name = |c: char| c.is_ascii_alphanumeric();
                let end = rest.find(|c| !is_name(c)).unwrap_or(rest.len());
                items.push(Item::Function(&rest[..end]));
                end
            }
            _ => {
                match first {
                    ' ' => (),
                    'π' => items.push(Item::Value(PI)),
                    '√' => items.push(Item::Function("√")),
                    mark => items.push(Item::Mark(mark)),
                }
                first.len_utf8()
            }
        };
        rest = &rest[length..];
    }
    items
}

/// The number at the start of a text times its unit, if it has one, and the length of both.
fn number(text: &str) -> (f64, usize) {
    let digits = |c: char| c.is_ascii_digit() || c == '.';
    let mut end = text.find(|c| !digits(c)).unwrap_or(text.len());
    let power = text[end..].strip_prefix('e').unwrap_or_default();
    let digits = power.trim_start_matches('-');
    let length = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
    if length > 0 {
        end += 1 + power.len() - digits.len() + length;
    }
    let number: f64 = text[..end].parse().unwrap_or_else(|_| panic!("{text:?} is no number"));
    let Some(after) = text[end..].strip_prefix(GLUE) else { return (number, end) };
    // The longest unit; its own blanks do not break a line either.
    let own = after.split(' ').next().unwrap_or(after);
    let ends = own.char_indices().map(|(at, c)| at + c.len_utf8());
    let unit = |end: usize| Some((end, factor(&own[..end].replace(GLUE, " "))?));
    let unit = ends.filter_map(unit).next_back();
    let (length, factor) = unit.unwrap_or_else(|| panic!("{after:?} starts with no unit"));
    (number * factor, end + GLUE.len_utf8() + length)
}

/// The value of a function; `None` for another name or number of arguments.
fn call(name: &str, arguments: &[f64]) -> Option<f64> {
    Some(match (name, arguments) {
        ("√", [x]) => x.sqrt(),
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

fn value(items: &[Item]) -> Option<f64> {
    let mut reader = Reader { items, at: 0 };
    let value = reader.sum()?;
    (reader.at == items.len()).then_some(value)
}

/// Items, and the number of read ones.
struct Reader<'a> {
    items: &'a [Item<'a>],
    at: usize,
}

impl Reader<'_> {
    /// Reads the mark if it is next. Returns whether it was.
    fn took(&mut self, mark: char) -> bool {
        let is_next = self.items.get(self.at) == Some(&Item::Mark(mark));
        self.at += usize::from(is_next);
        is_next
    }

    fn sum(&mut self) -> Option<f64> {
        let mut sum = self.product()?;
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
        let mut product = self.signed()?;
        loop {
            let next = self.items.get(self.at);
            let follows = |item: &Item| !matches!(item, Item::Mark(mark) if *mark != '(');
            if self.took('/') {
                product /= self.signed()?;
            } else if self.took('·') || next.is_some_and(follows) {
                product *= self.signed()?;
            } else {
                return Some(product);
            }
        }
    }

    fn signed(&mut self) -> Option<f64> {
        if self.took('-') { Some(-self.power()?) } else { self.power() }
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
        let item = *self.items.get(self.at)?;
        self.at += 1;
        match item {
            Item::Value(value) => Some(value),
            Item::Function(name) => {
                if !self.took('(') {
                    return call(name, &[self.base()?]);
                }
                let mut arguments = vec![self.sum()?];
                while self.took(',') {
                    arguments.push(self.sum()?);
                }
                if self.took(')') { call(name, &arguments) } else { None }
            }
            Item::Mark('(') => self.closed(')'),
            Item::Mark('|') => Some(self.closed('|')?.abs()),
            Item::Mark(_) => None,
        }
    }

    fn closed(&mut self, end: char) -> Option<f64> {
        let inner = self.sum()?;
        self.took(end).then_some(inner)
    }
}

fn example(text: &str) -> Option<f64> {
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
        let found = example(text).unwrap();
        assert!((found - expected).abs() < 1e-15, "{text}: {found}");
    }
    assert!((evaluate("-2\u{a0}m · -3e-1/√(4)") - 0.3).abs() < 1e-15);
}

#[test]
fn the_evaluator_refuses_a_text_that_is_no_formula() {
    for text in ["", "a +", "(a", "a)", "|a", "atan2(a)", "a ? a", "a ^", "cos", "unknown"] {
        assert_eq!(example(text), None, "{text}");
    }
}
