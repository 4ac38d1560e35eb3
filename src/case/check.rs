//! Problems of a case, and its check: each field alone, then rules between fields.

use super::{Case, Limit, Spread};
use crate::case::fields::{
    AUTO, Absent, FIELDS, Field, Kind, List, Range, Value, index_of, key_of,
};
use crate::case::sanitize::{cut, nearest, quoted, sanitize, spelled, suggestion};
use crate::case::units::{self, Dimension};
use crate::model::deviation::TOLERANCE_CLASSES;
use crate::model::inputs::{Gear, GearSide, Method, ToothCompliance};
use crate::model::{Inputs, QUANTITIES, Quantity, Refusal};
use crate::numeric::decimal::{shortest, significant};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A problem at one place: the cause and the fix.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Problem {
    /// The field's key, or an unknown key as written.
    pub field: String,
    /// The name of a kind of problem whose sentences differ only in their numbers, or empty.
    pub code: Box<str>,
    /// The cause.
    pub cause: String,
    /// How to fix it.
    pub fix: String,
}

/// The code of a required value that is missing; its fix is an assignment.
pub const MISSING: &str = "missing";
/// The code of a file of a newer format.
pub const NEWER_FORMAT: &str = "newer-format";

impl Problem {
    /// A problem of a field without a code.
    pub fn new(field: &str, cause: impl Into<String>, fix: impl Into<String>) -> Problem {
        Problem { field: field.to_owned(), code: "".into(), cause: cause.into(), fix: fix.into() }
    }

    /// The same problem with a code.
    pub(super) fn coded(self, code: &str) -> Problem {
        Problem { code: code.into(), ..self }
    }

    /// The same problem of another field.
    pub fn at(self, field: &str) -> Problem {
        Problem { field: field.to_owned(), ..self }
    }

    /// Whether another problem differs at most in its numbers.
    pub fn is_like(&self, other: &Problem) -> bool {
        let is_same = if self.code.is_empty() { self.fix == other.fix } else { true };
        (&self.field, &self.code) == (&other.field, &other.code) && is_same
    }
}

impl From<&Refusal> for Problem {
    fn from(refusal: &Refusal) -> Problem {
        let field = key_of(refusal.at());
        Problem::new(field, refusal.to_string(), refusal.fix()).coded(refusal.code())
    }
}

/// One line: `field: cause: fix`.
impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Problem { field, cause, fix, .. } = self;
        write!(f, "{}: {}: {}", sanitize(field), sanitize(cause), sanitize(fix))
    }
}

impl std::error::Error for Problem {}

/// The inputs that can be read, and all problems of the case. Skips the fields in `wrong`.
pub(super) fn read(case: &Case, wrong: &[usize]) -> (Inputs, Vec<Problem>) {
    let mut inputs = Inputs::default();
    let mut problems: Vec<Problem> = Vec::new();
    for field in (0..FIELDS.len()).filter(|field| !wrong.contains(field)) {
        problems.extend(put(case, field, &mut inputs).err());
        let partner = FIELDS[field].partner();
        if partner.is_some_and(|other| !wrong.contains(&other)) {
            problems.extend(neither_given(case, field).or_else(|| given_twice(case, field)));
        }
    }
    let rules: Vec<Problem> = rules(&inputs)
        .into_iter()
        .filter(|rule| {
            let wrong = wrong.iter().map(|&field| FIELDS[field].key);
            let mut keys = wrong.chain(problems.iter().map(|problem| &*problem.field));
            !keys.any(|key| is_read(&rule.field, key))
        })
        .map(|rule| rule.at_given(case))
        .collect();
    problems.extend(rules);
    problems.sort_by_key(|problem| index_of(&problem.field));
    // Valid limits and distributions are not read again.
    let unread = case.limits.iter().filter(|limit| limit.value.is_infinite());
    let unread = unread.filter(|limit| !limit.text.is_empty());
    problems.extend(unread.filter_map(|limit| Limit::new(limit.quantity.key, &limit.text).err()));
    let unread = case.spread.iter().filter(|spread| spread.width == 0.0);
    let unread = unread.filter(|spread| !spread.text.is_empty());
    problems.extend(unread.filter_map(|spread| Spread::new(spread.field, &spread.text).err()));
    // Other methods do not use the needs: a limit does not change their results.
    if inputs.method == Method::Auto {
        let limited = case.limits.iter().flat_map(Limit::quantities);
        inputs = inputs.needing(limited.map(|quantity| quantity.stage));
    }
    (inputs, problems)
}

/// Reads one field, or its default, into the inputs.
///
/// # Errors
/// The [`Problem`] of the field.
pub fn put(case: &Case, field: usize, inputs: &mut Inputs) -> Result<(), Problem> {
    let known = &FIELDS[field];
    match (case.text(field), known.absent) {
        (None, _) if case.is_replaced(field) => Ok(()),
        (Some(text), _) | (None, Absent::Default(text)) => {
            known.put(field_value(field, text)?, inputs);
            Ok(())
        }
        (None, Absent::Refused) => {
            let cause = "a required value is missing";
            Err(Problem::new(known.key, cause, addition(known)).coded(MISSING))
        }
        (None, Absent::Without(_) | Absent::Either) => Ok(()),
    }
}

/// An example of the field in TOML.
pub(super) fn example(field: &Field) -> String {
    let example = field.example();
    match field.kind {
        Kind::List(_) => format!("[{example}]"),
        _ if field.is_bare() => example.to_owned(),
        _ => format!("\"{example}\""),
    }
}

/// The field as a line of a file, with an example value.
pub(super) fn assignment(field: &Field) -> String {
    format!("{} = {}", field.name(), example(field))
}

/// How to add a field to a file, with an example value.
fn addition(field: &Field) -> String {
    let table = field.table();
    let under = if table.is_empty() { String::new() } else { format!(" under [{table}]") };
    format!("write {}{under}", assignment(field))
}

/// Neither of two fields is given of which one is required. Reported at the first field.
fn neither_given(case: &Case, field: usize) -> Option<Problem> {
    let other = FIELDS[field].partner().filter(|&other| field < other)?;
    let (known, named) = (&FIELDS[field], &FIELDS[other]);
    let is_missing =
        known.absent == Absent::Either && case.text(field).is_none() && case.text(other).is_none();
    is_missing.then(|| {
        let cause = format!("neither {} nor {} is given", known.key, named.key);
        Problem::new(known.key, cause, addition(known)).coded(MISSING)
    })
}

/// Two fields that exclude each other are both given. Reported at the second field.
pub(super) fn given_twice(case: &Case, field: usize) -> Option<Problem> {
    let other = FIELDS[field].partner().filter(|&other| field > other)?;
    let (known, named) = (&FIELDS[field], &FIELDS[other]);
    case.text(field).and(case.text(other)).map(|_| {
        let cause = format!("{} and {} are both given", named.key, known.key);
        Problem::new(known.key, cause, "remove one of them")
    })
}

/// The value of a field from its text, checked against the range of the field.
///
/// # Errors
/// If the text is not a value of the field, or the value is outside the range.
pub fn field_value(field: usize, text: &str) -> Result<Value, Problem> {
    let known = &FIELDS[field];
    match known.kind {
        Kind::Text => Ok(Value::Text),
        Kind::Number(dimension, range, _) => {
            number(known, field, text, dimension, range).map(Value::Number)
        }
        Kind::Count(from, to, _) => count(known, text, from, to).map(Value::Count),
        Kind::Choice(names, _) => choice(known, text, names).map(Value::Choice),
        Kind::List(_) => list(text).map(Value::List).ok_or_else(|| {
            let most = List::default().len();
            let cause = format!("{} is not a list of numbers", quoted(text));
            let fix =
                format!("write at most {most} numbers with commas, such as {}", known.example());
            Problem::new(known.key, cause, fix)
        }),
    }
}

/// The least and the greatest value of a number field, in SI.
pub fn field_range(field: usize) -> (f64, f64) {
    let Some(range) = FIELDS[field].range() else { return (0.0, 0.0) };
    let factor = units::factor(range.unit).unwrap_or(1.0);
    (range.from * factor, range.to * factor)
}

fn number(
    known: &Field,
    field: usize,
    text: &str,
    dimension: Dimension,
    range: Range,
) -> Result<f64, Problem> {
    let (from, to) = field_range(field);
    let value = units::parse(text, dimension, known.usual_unit()).map_err(|misread| {
        let problem = misread.at(known.key);
        if let Some(class) = text.trim().strip_prefix("grade")
            && known.name() == "base_pitch"
        {
            let class = class.trim().parse().ok().filter(|class| TOLERANCE_CLASSES.contains(class));
            let class = class.unwrap_or(7);
            let fix = match known.table() {
                "deviations" => format!("set driver.grade = {class} and driven.grade = {class}"),
                gear => format!("set {gear}.grade = {class}"),
            };
            return Problem { fix, ..problem };
        }
        let likely = likely_units(text, known, dimension, (from, to));
        if !matches!(units::split(text, ""), Ok((_, ""))) {
            return problem;
        }
        if likely.is_empty() {
            let fix = format!("write a value from {}", known.range_text());
            return Problem { fix, ..problem };
        }
        let meant = likely.iter().map(|unit| format!("\"{} {unit}\"", cut(text.trim())));
        Problem { fix: format!("write {}", meant.collect::<Vec<_>>().join(" or ")), ..problem }
    })?;
    // The same end in another unit can differ by rounding.
    let slack = 4.0 * f64::EPSILON;
    let end = |end| format!("{} {}", shortest(end), range.unit);
    match value {
        _ if value < from - slack * from.abs() => {
            Err(outside(known, text, "below", &end(range.from)))
        }
        _ if value > to + slack * to.abs() => Err(outside(known, text, "above", &end(range.to))),
        _ => Ok(value),
    }
}

/// The units that the user most likely meant for a bare number: the usual unit or another one with a
/// value inside the range, and a second common unit if it fits, too.
fn likely_units(
    text: &str,
    known: &Field,
    dimension: Dimension,
    (from, to): (f64, f64),
) -> Vec<&'static str> {
    const COMMON: usize = 2;
    let usual = known.usual_unit();
    let fits = |unit: &&str| {
        let value = units::parse(&format!("{} {unit}", text.trim()), dimension, unit);
        value.is_ok_and(|value| (from..=to).contains(&value))
    };
    let first = std::iter::once(usual).chain(dimension.symbols()).find(fits);
    let is_other = |unit: &&str| *unit != usual && Some(*unit) != first && fits(unit);
    let second = dimension.symbols().take(COMMON).find(is_other);
    first.into_iter().chain(second).collect()
}

fn outside(known: &Field, text: &str, side: &str, end: &str) -> Problem {
    let cause = format!("{} is {side} the limit of {}", quoted(text), end.trim_end());
    let hand =
        if known.key == "pair.helix_angle" { "; pair.driver_hand gives the hand" } else { "" };
    Problem::new(known.key, cause, format!("write a value from {}{hand}", known.range_text()))
}

fn count(known: &Field, text: &str, from: u32, to: u32) -> Result<u32, Problem> {
    let text = text.trim();
    if known.takes_auto() && text == AUTO {
        return Ok(0);
    }
    let is_whole = text.strip_prefix('+').unwrap_or(text).bytes().all(|byte| byte.is_ascii_digit());
    let refused = |cause: String| {
        let (range, example) = (known.range_text(), known.example());
        let fix = format!("write a whole number from {range}, such as {example}");
        Err(Problem::new(known.key, cause, fix))
    };
    match units::parse(text, Dimension::Number, "") {
        Ok(value) if value < f64::from(from) && (is_whole || value < 0.0) => {
            Err(outside(known, text, "below", &from.to_string()))
        }
        Ok(value) if value > f64::from(to) && is_whole => {
            Err(outside(known, text, "above", &to.to_string()))
        }
        Ok(value) if is_whole => Ok(value as u32),
        Ok(_) => refused(format!("{} is not a whole number", quoted(text))),
        Err(misread) => refused(misread.cause),
    }
}

/// The numbers of a list.
pub(super) fn list(text: &str) -> Option<List> {
    let mut values = List::default();
    let mut rest = values.iter_mut();
    for number in text.split(',') {
        let number = units::parse(number.trim(), Dimension::Number, "").ok()?;
        *rest.next()? = number;
    }
    Some(values)
}

fn choice(known: &Field, text: &str, names: &'static [&'static str]) -> Result<usize, Problem> {
    let name = text.trim();
    if let Some(index) = names.iter().position(|&known| known == name) {
        return Ok(index);
    }
    let fix =
        suggestion(name, names.iter().copied(), || format!("use one of {}", names.join(", ")));
    Err(Problem::new(known.key, format!("unknown choice {}", quoted(name)), fix))
}

/// The first rule between fields that these inputs violate.
pub fn violated_rule(inputs: &Inputs) -> Option<Problem> {
    rules(inputs).into_iter().next()
}

/// The violated rules between fields.
fn rules(inputs: &Inputs) -> Vec<Problem> {
    let mut violated = Vec::new();
    for height in Height::all(inputs) {
        let rule = height.outside_range(inputs).or_else(|| height.bore_through_root(inputs));
        violated.extend(rule);
    }
    violated.extend(ratio_beyond(inputs));
    violated.extend(face_rules(inputs));
    violated.extend(table_rule(inputs));
    violated
}

/// Whether a rule whose problem is at the field `rule` reads another field.
fn is_read(rule: &str, field: &str) -> bool {
    const OF_PAIR: [&str; 3] = ["pair.module", "pair.diametral_pitch", "pair.helix_angle"];
    const OF_GEAR: [&str; 8] = [
        "teeth",
        "profile_shift",
        "addendum",
        "tip_diameter",
        "dedendum",
        "root_diameter",
        "bore_radius",
        "bore_diameter",
    ];
    let (table, name) = rule.split_once('.').unwrap_or_default();
    let (other, part) = field.split_once('.').unwrap_or_default();
    match name {
        "teeth" => part == name,
        "tip_diameter" | "root_diameter" | "bore_radius" => {
            OF_PAIR.contains(&field) || table == other && OF_GEAR.contains(&part)
        }
        _ => rule == field,
    }
}

/// Faces without common width, and flank lines beyond the first order.
fn face_rules(inputs: &Inputs) -> impl Iterator<Item = Problem> {
    /// Greatest angle of axes and helices, and of modifications of a flank line, in rad.
    const MOST: [f64; 2] = [0.01, 0.1];
    let (width, widths) =
        (inputs.common_width(), [inputs.driver.face_width, inputs.driven.face_width]);
    let are_apart = widths.iter().all(|&width| width > 0.0) && width <= 0.0;
    let apart = are_apart.then(|| {
        let (offset, most) = (in_mm(inputs.face_offset), in_mm(0.5 * (widths[0] + widths[1])));
        let cause = format!("the faces have no common width at an offset of {offset} mm");
        let fix = format!("write an offset within {most} mm");
        Problem::new("pair.face_offset", cause, fix).coded("no-common-width")
    });
    let slopes = [
        ((None, "misalignment"), inputs.misalignment, width),
        ((Some(GearSide::Driver), "helix_slope"), inputs.driver.helix_slope, widths[0]),
        ((Some(GearSide::Driven), "helix_slope"), inputs.driven.helix_slope, widths[1]),
    ];
    let gears = [(GearSide::Driver, &inputs.driver), (GearSide::Driven, &inputs.driven)];
    let modified = gears.into_iter().flat_map(|(side, gear)| {
        let Gear { end_reliefs: [minus, plus], face_width, .. } = *gear;
        let length = gear.length_of_end_relief();
        // The slope of a crowning is greatest at the ends of the face.
        [
            ("crowning", gear.crowning, 0.25 * face_width),
            ("end_relief_minus", minus, length),
            ("end_relief_plus", plus, length),
        ]
        .map(|(name, value, width)| ((Some(side), name), value, width, MOST[1]))
    });
    let slopes = slopes.map(|(member, value, width)| (member, value, width, MOST[0]));
    let steep = slopes.into_iter().chain(modified);
    // A conversion to another unit rounds.
    let steep = steep.filter(|(_, value, width, most)| {
        *width > 0.0 && value.abs() > most * width * (1.0 + 1e-12)
    });
    let steep = steep.map(|(member, value, width, most)| {
        let (value, most) = (in_mm(value), in_mm(most * width));
        let cause =
            format!("{value} mm over {} mm of the face is more than a small angle", in_mm(width));
        let fix = format!("write a value within {most} mm");
        Problem::new(key_of(member), cause, fix).coded("misalignment-too-large")
    });
    apart.into_iter().chain(steep)
}

/// A table of compliances that is chosen but not given, lacks a value or is not above 0 everywhere.
fn table_rule(inputs: &Inputs) -> Option<Problem> {
    let is_chosen = inputs.tooth_compliance.is_some_and(ToothCompliance::reads_table);
    let Some(given) = &inputs.given_compliance else {
        return is_chosen.then(|| {
            let fix = "give compliance.driver, compliance.driven and compliance.contact, or choose \
                another model";
            let problem = Problem::new("model.tooth_compliance", "no compliance is given", fix);
            problem.coded("compliance-missing")
        });
    };
    let curves = [
        ("compliance.driver", given.driver),
        ("compliance.driven", given.driven),
        ("compliance.contact", given.contact),
    ];
    curves.into_iter().find_map(|(key, curve)| {
        if curve.middle <= 0.0 {
            let fix = addition(&FIELDS[index_of(key)?]);
            let problem = Problem::new(key, "the given compliance lacks this value", fix);
            return Some(problem.coded(MISSING));
        }
        (-32..=32).any(|part| curve.at(f64::from(part) / 32.0) <= 0.0).then(|| {
            let cause = format!("{key} with its coefficients is not above 0 on the whole path");
            let problem = Problem::new(key, cause, "give smaller coefficients");
            problem.coded("compliance-not-positive")
        })
    })
}

/// A ratio of tooth numbers beyond the limit, or its reciprocal.
fn ratio_beyond(inputs: &Inputs) -> Option<Problem> {
    const MOST: f64 = 50.0;
    let ratio = inputs.ratio();
    if (1.0 / MOST..=MOST).contains(&ratio) {
        return None;
    }
    let (driver, driven) = (inputs.driver.teeth, inputs.driven.teeth);
    let cause = format!("the ratio of tooth numbers {driven}/{driver} is {ratio:.4}");
    Some(Problem::new("driven.teeth", cause, format!("keep it within 1/{MOST} to {MOST}")))
}

/// The tip or the root of a gear, by a coefficient of the rack or by a diameter.
struct Height<'i> {
    gear: &'i Gear,
    table: &'static str,
    is_tip: bool,
}

impl Height<'_> {
    /// The heights of both gears: tip before root.
    fn all(inputs: &Inputs) -> [Height<'_>; 4] {
        let of = |table, gear, is_tip| Height { gear, table, is_tip };
        let Inputs { driver, driven, .. } = inputs;
        [
            of("driver", driver, true),
            of("driver", driver, false),
            of("driven", driven, true),
            of("driven", driven, false),
        ]
    }

    fn field(&self, tip: &str, root: &str) -> usize {
        let name = if self.is_tip { tip } else { root };
        index_of(&format!("{}.{name}", self.table)).unwrap_or_default()
    }

    fn coefficient(&self) -> usize {
        self.field("addendum", "dedendum")
    }

    fn diameter(&self) -> &'static str {
        FIELDS[self.field("tip_diameter", "root_diameter")].key
    }

    fn given_diameter(&self) -> Option<f64> {
        if self.is_tip { self.gear.tip_diameter } else { self.gear.root_diameter }
    }

    /// A diameter whose coefficient is outside the range of the field that it replaces.
    fn outside_range(&self, inputs: &Inputs) -> Option<Problem> {
        /// A diameter at an end of the range has the end as its coefficient except for rounding.
        const SLACK: f64 = 1e-9;
        const DIGITS: usize = 4;
        let (gear, given) = (self.gear, self.given_diameter()?);
        let (value, sign) = if self.is_tip {
            (inputs.addendum_of(gear), 1.0)
        } else {
            (inputs.dedendum_of(gear), -1.0)
        };
        let (from, to) = field_range(self.coefficient());
        let (side, limit) = match value {
            _ if value < from - SLACK => ("below", from),
            _ if value > to + SLACK => ("above", to),
            _ => return None,
        };
        let (label, value) = (FIELDS[self.coefficient()].label, significant(value, DIGITS));
        let given = in_mm(given);
        let cause = format!(
            "{given} mm gives the {label} coefficient {value}, {side} the limit of {limit}"
        );
        let shifted = f64::from(gear.teeth) / inputs.helix_cosine() + 2.0 * gear.profile_shift;
        let at = |coefficient: f64| in_mm(inputs.module * (shifted + 2.0 * sign * coefficient));
        let (least, most) = (at(from).min(at(to)), at(from).max(at(to)));
        let fix = format!("write a diameter from {least} to {most} mm");
        Some(Problem::new(self.diameter(), cause, fix).coded("diameter-outside-range"))
    }

    fn bore_through_root(&self, inputs: &Inputs) -> Option<Problem> {
        let gear = self.gear;
        let height = gear.profile_shift - inputs.dedendum_of(gear);
        let half_teeth = f64::from(gear.teeth) / (2.0 * inputs.helix_cosine());
        let root = inputs.module * (half_teeth + height);
        (!self.is_tip && gear.bore_radius >= root).then(|| {
            let (bore, root) = (in_mm(gear.bore_radius), in_mm(root));
            let cause = format!(
                "the bore radius {bore} mm is not below the root circle's {root} mm = m (z/2 - \
                    hf* + x)"
            );
            let fix = format!(
                "write a radius (not a diameter) below {root} mm, or a diameter below {} mm",
                2.0 * root
            );
            let field = FIELDS[self.field("", "bore_radius")].key;
            Problem::new(field, cause, fix).coded("bore-through-root")
        })
    }
}

impl Problem {
    /// The problem at the diameter if the inputs give the diameter instead of the coefficient.
    pub fn at_given_diameter(self, inputs: &Inputs) -> Problem {
        let is_it = |height: &Height| {
            FIELDS[height.coefficient()].key == self.field && height.given_diameter().is_some()
        };
        match Height::all(inputs).iter().find(|height| is_it(height)) {
            Some(height) => self.at(height.diameter()),
            None => self,
        }
    }

    /// The problem at the alternative of its field if the case gives the alternative.
    pub fn at_given(self, case: &Case) -> Problem {
        let field = index_of(&self.field).filter(|&field| case.is_replaced(field));
        let given = field.and_then(|field| FIELDS[field].partner());
        match given.filter(|&given| case.text(given).is_some()) {
            Some(given) => self.at(FIELDS[given].key),
            None => self,
        }
    }
}

/// A length in mm for a message.
fn in_mm(metres: f64) -> f64 {
    (metres * 1e7).round() / 1e4
}

/// The refusal of an unknown key.
pub fn unknown_key(key: &str) -> Problem {
    let known = FIELDS.iter().map(|field| field.key);
    let name = key.rsplit('.').next().unwrap_or(key);
    let same_name = FIELDS
        .iter()
        .find(|field| field.name() == name)
        .map(|field| format!("did you mean {}?", field.key));
    let fix = same_name.unwrap_or_else(|| {
        suggestion(key, known, || "`tipstrike fields` lists every key".to_owned())
    });
    Problem::new(key, format!("unknown key {}", quoted(key)), fix)
}

/// The quantity of a key or symbol. A symbol may be in ASCII, as in `K_Hbeta`, `K_Hb` or `Fst,max`.
///
/// # Errors
/// The refusal of an unknown name.
pub fn quantity(field: &str, name: &str) -> Result<&'static Quantity, Problem> {
    named(name).map_err(|_| unknown_quantity(field, name))
}

/// The quantity of a key or symbol; otherwise the one of a symbol in other letters.
fn named(name: &str) -> Result<&'static Quantity, Option<&'static Quantity>> {
    let name = name.trim();
    let plain = |text: &str| text.replace('_', "").replace("epsilon", "eps");
    let initial = |letter: char| spelled(&letter.to_string()).chars().next();
    let is_spelled = |known: &&Quantity| {
        let initials = known.symbol.chars().filter_map(initial).collect::<String>();
        [spelled(known.symbol), initials].iter().any(|symbol| plain(symbol) == plain(name))
    };
    let is_symbol = |known: &&Quantity| !name.is_empty() && known.symbol.eq_ignore_ascii_case(name);
    let mut spelled = QUANTITIES.iter().filter(is_spelled);
    Quantity::named(name)
        .or_else(|| spelled.next().filter(|_| spelled.next().is_none()))
        .ok_or_else(|| QUANTITIES.iter().find(is_symbol))
}

/// The refusal of a name that is no key of a quantity, with the quantities that it may mean.
pub(super) fn unknown_quantity(field: &str, written: &str) -> Problem {
    let name = written.trim();
    let is = |what: &str, fix: &str| {
        Problem::new(field, format!("{} is {what}", quoted(written)), fix.to_owned())
    };
    let unknown =
        |fix: String| Problem::new(field, format!("unknown quantity {}", quoted(written)), fix);
    let is_field = |known: &&Field| [known.key, known.name(), known.symbol].contains(&name);
    let near = match named(name) {
        Ok(known) => {
            return is(&format!("the symbol of {}", known.key), &format!("write {}", known.key));
        }
        Err(Some(known)) => {
            return unknown(format!("did you mean {}, {}?", known.symbol, known.key));
        }
        Err(None) => nearest(name, Quantity::all().map(|known| known.key)),
    };
    if name.is_empty() {
        let fix = "write names with commas between them, such as impact_force,contact_ratio";
        return Problem::new(field, "no quantity is named", fix);
    }
    if let Some(known) = FIELDS.iter().find(is_field) {
        let what = format!("the field {}", known.key);
        return is(&what, "name a result; `tipstrike fields --results` lists them");
    }
    if ["outcome", "exit_outcome"].contains(&name) {
        return is(
            "no number",
            &format!("leave it out: every result has it; `seek` takes {name}=no-corner-contact"),
        );
    }
    // Two letters are a misprint; more can be another name in the same words.
    let is_misprint = |near: &&str| strsim::damerau_levenshtein(name, near) <= 2;
    let words =
        if near.is_some_and(|near| is_misprint(&near)) { Vec::new() } else { by_words(name) };
    let meant = if words.is_empty() { near.into_iter().collect() } else { words };
    unknown(match (Quantity::find(&name.replace(' ', "_")), &meant[..]) {
        (Some(known), _) => format!("did you mean {}?", known.key),
        _ if name.contains(' ') => "put commas between names".to_owned(),
        (None, []) => "`tipstrike fields --results` lists every quantity".to_owned(),
        (None, meant) => format!("did you mean {}?", meant.join(" or ")),
    })
}

/// The keys of the quantities with every word of a name in their key, label or meaning, those with more
/// of them in the key first.
fn by_words(name: &str) -> Vec<&'static str> {
    const MOST: usize = 3;
    let words = || name.split(['_', '-']);
    let has = |text: &str, word: &str| {
        let mut own = text.split(|c: char| !c.is_alphanumeric());
        own.any(|own| own.eq_ignore_ascii_case(word))
    };
    let text =
        |known: &Quantity| [known.key, known.label, known.meaning].join(" ").replace('_', " ");
    let has_words = |known: &&Quantity| words().all(|word| has(&text(known), word));
    let mut keys: Vec<&str> = QUANTITIES.iter().filter(has_words).map(|known| known.key).collect();
    keys.sort_by_key(|key| words().filter(|word| !has(&key.replace('_', " "), word)).count());
    keys.truncate(MOST);
    keys
}
