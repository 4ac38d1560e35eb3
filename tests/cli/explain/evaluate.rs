//! Evaluates the printed numbers and units of a page, independently of the formulas of the program.

use tipstrike::case::units;
use tipstrike::report::explain::STEP_UNITS;

/// The space between a number and its unit.
const GLUE: char = '\u{a0}';

/// The value of a printed expression in SI.
pub(crate) fn evaluate(text: &str) -> f64 {
    let mut reader = Reader { rest: text };
    let value = reader.sum();
    assert!(reader.rest.trim().is_empty(), "{text}: what is {:?}?", reader.rest);
    value
}

/// The factor of a unit to SI.
pub(crate) fn factor(unit: &str) -> Option<f64> {
    units::factor(unit)
        .or_else(|| STEP_UNITS.iter().find(|(name, _)| *name == unit).map(|&(_, factor)| factor))
}

struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    fn took(&mut self, mark: &str) -> bool {
        let start = self.rest.trim_start_matches(' ');
        let found = start.strip_prefix(mark);
        self.rest = found.unwrap_or(start);
        found.is_some()
    }

    fn must(&mut self, mark: &str) {
        assert!(self.took(mark), "{mark:?} is missing before {:?}", self.rest);
    }

    fn sum(&mut self) -> f64 {
        let mut sum = self.product();
        loop {
            if self.took("+") {
                sum += self.product();
            } else if self.took("-") {
                sum -= self.product();
            } else {
                return sum;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut product = self.signed();
        loop {
            if self.took("·") {
                product *= self.signed();
            } else if self.took("/") {
                product /= self.signed();
            } else {
                return product;
            }
        }
    }

    fn signed(&mut self) -> f64 {
        if self.took("-") { -self.power() } else { self.power() }
    }

    fn power(&mut self) -> f64 {
        let base = self.base();
        for (mark, exponent) in [("²", 2), ("³", 3), ("⁴", 4)] {
            if self.took(mark) {
                return base.powi(exponent);
            }
        }
        if self.took("^(") {
            let exponent = self.sum();
            self.must(")");
            return base.powf(exponent);
        }
        base
    }

    fn base(&mut self) -> f64 {
        for (name, of) in FUNCTIONS {
            if self.took(name) {
                let mut arguments = vec![self.sum()];
                while self.took(",") {
                    arguments.push(self.sum());
                }
                self.must(if *name == "|" { "|" } else { ")" });
                return of(&arguments);
            }
        }
        if self.took("π") { std::f64::consts::PI } else { self.number() }
    }

    fn number(&mut self) -> f64 {
        let digits = |c: char| c.is_ascii_digit() || c == '.';
        let mut end = self.rest.find(|c| !digits(c)).unwrap_or(self.rest.len());
        let power = self.rest[end..].strip_prefix('e').unwrap_or_default();
        let digits = power.trim_start_matches('-');
        let length = digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len());
        if length > 0 {
            end += 1 + power.len() - digits.len() + length;
        }
        let number: f64 =
            self.rest[..end].parse().unwrap_or_else(|_| panic!("{:?} is no number", self.rest));
        self.rest = &self.rest[end..];
        match self.rest.strip_prefix(GLUE) {
            Some(after) => number * self.unit(after),
            None => number,
        }
    }

    /// The longest unit at the start of the text.
    fn unit(&mut self, text: &str) -> f64 {
        let own = text.split(' ').next().unwrap_or(text);
        let plain = own.replace(GLUE, " ");
        let ends = plain.char_indices().map(|(at, c)| at + c.len_utf8());
        let mut known = ends.filter_map(|end| Some((end, factor(&plain[..end])?)));
        let (end, factor) =
            known.next_back().unwrap_or_else(|| panic!("{text:?} starts with no unit"));
        let length = plain[..end].chars().count();
        let skip = text.char_indices().nth(length).map_or(text.len(), |(at, _)| at);
        let at = self.rest.len() - text.len() + skip;
        self.rest = &self.rest[at..];
        factor
    }
}

type Function = fn(&[f64]) -> f64;

const FUNCTIONS: &[(&str, Function)] = &[
    ("√(", |x| x[0].sqrt()),
    ("|", |x| x[0].abs()),
    ("sin(", |x| x[0].sin()),
    ("cos(", |x| x[0].cos()),
    ("tan(", |x| x[0].tan()),
    ("asin(", |x| x[0].asin()),
    ("acos(", |x| x[0].acos()),
    ("atan(", |x| x[0].atan()),
    ("atan2(", |x| x[0].atan2(x[1])),
    ("ln(", |x| x[0].ln()),
    ("inv(", |x| x[0].tan() - x[0]),
    ("min(", |x| x.iter().copied().fold(f64::NAN, f64::min)),
    ("max(", |x| x.iter().copied().fold(f64::NAN, f64::max)),
    ("(", |x| x[0]),
];
