//! From texts to the model's inputs: every field on its own, then the fields together.

use std::sync::LazyLock;

use super::fields::{AUTO, Absent, FIELDS, Field, Kind, Range, Value, index_of};
use super::sanitize::{quoted, sanitize};
use super::units::{self, Dimension, ParseError};
use super::{Case, Limit, suggest};
use crate::model::inputs::Gear;
use crate::model::{Inputs, QUANTITIES, Quantity, Refusal};
use crate::numeric::decimal::shortest;

/// What is wrong at one place: the cause and the fix.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The field's key, or the key as written where it is unknown.
    pub field: String,
    /// What is wrong.
    pub cause: String,
    /// How to fix it.
    pub fix: String,
}

impl Problem {
    /// A problem of a field.
    pub(super) fn new(field: &str, cause: impl Into<String>, fix: impl Into<String>) -> Problem {
        Problem {
            field: field.to_owned(),
            cause: cause.into(),
            fix: fix.into(),
        }
    }

    /// A misread value, as a problem of its field.
    pub(super) fn of(field: &str, misread: ParseError) -> Problem {
        Problem::new(field, misread.cause, misread.fix)
    }
}

/// One line: `field: cause: fix`.
impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{}: {}: {}",
            sanitize(&self.field),
            sanitize(&self.cause),
            sanitize(&self.fix)
        )
    }
}

impl std::error::Error for Problem {}

impl From<&Refusal> for Problem {
    fn from(refusal: &Refusal) -> Problem {
        Problem::new(refusal.field(), refusal.to_string(), refusal.fix())
    }
}

/// The greatest ratio of tooth numbers, either way.
const MOST_RATIO: f64 = 50.0;

/// What every field puts into the model's inputs, or everything that is wrong with the case.
pub(super) fn inputs(case: &Case) -> Result<Inputs, Vec<Problem>> {
    let (inputs, problems) = read(case, &[]);
    if problems.is_empty() {
        Ok(inputs)
    } else {
        Err(problems)
    }
}

/// The inputs as far as they can be read, and everything that is wrong with the case, passing over
/// the fields that are known to be wrong.
pub(super) fn read(case: &Case, wrong: &[usize]) -> (Inputs, Vec<Problem>) {
    let mut inputs = Inputs::default();
    let mut problems: Vec<Problem> = Vec::new();
    for field in (0..FIELDS.len()).filter(|field| !wrong.contains(field)) {
        problems.extend(put(case, field, &mut inputs).err());
        if partner(field).is_some_and(|other| !wrong.contains(&other)) {
            problems.extend(misfit(case, field));
        }
    }
    let sound = |keys: &[&str]| {
        let named = |key: &&str| {
            wrong.iter().any(|&field| FIELDS[field].key == *key)
                || problems.iter().any(|p| p.field == *key)
        };
        !keys.iter().any(named)
    };
    let together = together(&inputs, sound);
    problems.extend(together);
    problems.sort_by_key(|problem| index_of(&problem.field));
    problems.extend(limits(case));
    (inputs, problems)
}

/// What is wrong with the limits that hold something; those that could be read are not read again.
fn limits(case: &Case) -> impl Iterator<Item = Problem> {
    let unread = case
        .limits
        .iter()
        .filter(|limit| !limit.text.is_empty() && limit.value.is_infinite());
    unread.filter_map(|limit| Limit::new(limit.quantity, &limit.text).err())
}

/// Reads one field, or its default, into the inputs.
///
/// # Errors
/// The [`Problem`] of the field.
pub fn put(case: &Case, field: usize, inputs: &mut Inputs) -> Result<(), Problem> {
    let known = &FIELDS[field];
    match (case.text(field), known.absent) {
        (Some(text), _) | (None, Absent::Default(text)) => put_text(known, field, text, inputs),
        (None, Absent::Refused) => Err(Problem::new(
            known.key,
            "a required value is missing",
            format!("write {}", addition(known)),
        )),
        (None, Absent::Without(_) | Absent::Either(_)) => Ok(()),
    }
}

/// How the field stands in a file, by example.
pub(super) fn assignment(field: &Field) -> String {
    let example = field.example();
    let value = if field.is_bare() {
        example.to_owned()
    } else {
        format!("\"{example}\"")
    };
    format!("{} = {value}", field.name())
}

/// The assignment and the table to which it belongs.
fn addition(field: &Field) -> String {
    match field.table() {
        "" => assignment(field),
        table => format!("{} under [{table}]", assignment(field)),
    }
}

/// The field that excludes this one.
pub(super) fn partner(field: usize) -> Option<usize> {
    match FIELDS[field].absent {
        Absent::Either(other) => index_of(other),
        _ => None,
    }
}

/// Exactly one of two fields is given: said once, at the first when neither is and at the second
/// when both are.
fn misfit(case: &Case, field: usize) -> Option<Problem> {
    let other = partner(field)?;
    let (known, named) = (&FIELDS[field], &FIELDS[other]);
    match (case.text(field), case.text(other)) {
        (None, None) if field < other => {
            let cause = format!("neither {} nor {} is given", known.key, named.key);
            Some(Problem::new(
                known.key,
                cause,
                format!("write {}", addition(known)),
            ))
        }
        (Some(_), Some(_)) => given_twice(case, field),
        _ => None,
    }
}

/// Both of two fields that exclude each other are given: reported at the second one.
pub(super) fn given_twice(case: &Case, field: usize) -> Option<Problem> {
    let other = partner(field).filter(|&other| field > other)?;
    let (known, named) = (&FIELDS[field], &FIELDS[other]);
    case.text(field).and(case.text(other)).map(|_| {
        let cause = format!("{} and {} are both given", named.key, known.key);
        Problem::new(known.key, cause, "remove one of them")
    })
}

fn put_text(known: &Field, field: usize, text: &str, inputs: &mut Inputs) -> Result<(), Problem> {
    known.put(read_value(known, field, text)?, inputs);
    Ok(())
}

/// The value of a field from its text, checked against the field's own range.
///
/// # Errors
/// Where the text is no value of the field, or is outside its range.
pub fn field_value(field: usize, text: &str) -> Result<Value, Problem> {
    read_value(&FIELDS[field], field, text)
}

fn read_value(known: &Field, field: usize, text: &str) -> Result<Value, Problem> {
    match known.kind {
        Kind::Text => Ok(Value::Text),
        Kind::Number(dimension, range, _) => {
            number(known, field, text, dimension, range).map(Value::Number)
        }
        Kind::Count(from, to, _) => count(known, text, from, to).map(Value::Count),
        Kind::Choice(names, _) => choice(known, text, names).map(Value::Choice),
    }
}

/// The first rule between fields that these inputs break. [`Case::inputs`] reports the same for a
/// case that says so.
#[must_use]
pub fn misfit_between(inputs: &Inputs) -> Option<Problem> {
    together(inputs, |_| true).into_iter().next()
}

/// The least and the greatest value of a number field, in SI.
#[must_use]
pub fn field_range(field: usize) -> (f64, f64) {
    ENDS[field]
}

/// The ends of every range in SI, read like a value so that the ends themselves are inside.
static ENDS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let end = |value: f64, dimension, unit| {
        units::parse(&format!("{value} {unit}"), dimension, unit).unwrap_or(f64::NAN)
    };
    FIELDS
        .iter()
        .map(|field| match field.kind {
            Kind::Number(dimension, range, _) => (
                end(range.from, dimension, range.unit),
                end(range.to, dimension, range.unit),
            ),
            _ => (0.0, 0.0),
        })
        .collect()
});

fn number(
    known: &Field,
    field: usize,
    text: &str,
    dimension: Dimension,
    range: Range,
) -> Result<f64, Problem> {
    let (from, to) = ENDS[field];
    let likely = || likely_unit(text, known, dimension, (from, to));
    let value = units::parse(text, dimension, known.usual_unit())
        .or_else(|_| units::parse(text, dimension, likely()))
        .map_err(|misread| Problem::of(known.key, misread))?;
    // The same end may be written in another unit, and be off by its rounding there.
    let slack = 4.0 * f64::EPSILON;
    if value < from - slack * from.abs() {
        return Err(outside(
            known,
            text,
            "below",
            shortest(range.from),
            range.unit,
        ));
    }
    if value > to + slack * to.abs() {
        return Err(outside(
            known,
            text,
            "above",
            shortest(range.to),
            range.unit,
        ));
    }
    Ok(value)
}

/// The unit that is most likely meant behind a bare number: the usual one, or where that is out of
/// range another that is not.
fn likely_unit(
    text: &str,
    known: &Field,
    dimension: Dimension,
    (from, to): (f64, f64),
) -> &'static str {
    let fits = |unit: &&str| {
        let value = units::parse(&format!("{} {unit}", text.trim()), dimension, unit);
        value.is_ok_and(|value| (from..=to).contains(&value))
    };
    std::iter::once(known.usual_unit())
        .chain(dimension.symbols())
        .find(fits)
        .unwrap_or(known.usual_unit())
}

fn outside(
    known: &Field,
    text: &str,
    side: &str,
    end: impl std::fmt::Display,
    unit: &str,
) -> Problem {
    let end = format!("{end} {unit}");
    let cause = format!("{} is {side} the limit of {}", quoted(text), end.trim_end());
    Problem::new(
        known.key,
        cause,
        format!("write a value from {}", known.range_text()),
    )
}

fn count(known: &Field, text: &str, from: u32, to: u32) -> Result<u32, Problem> {
    let text = text.trim();
    if known.takes_auto() && text == AUTO {
        return Ok(0);
    }
    let digits = text.strip_prefix('+').unwrap_or(text);
    match digits.parse::<u32>() {
        Ok(value) if value < from => Err(outside(known, text, "below", from, "")),
        Ok(value) if value <= to => Ok(value),
        _ if !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()) => {
            Err(outside(known, text, "above", to, ""))
        }
        _ => Err(not_whole(known, text)),
    }
}

fn not_whole(known: &Field, text: &str) -> Problem {
    let example = format!(
        "write a whole number from {}, such as {}",
        known.range_text(),
        known.example()
    );
    match units::parse(text, Dimension::Number, "") {
        Ok(value) if value < 0.0 => outside(
            known,
            text,
            "below",
            known.range_text().split(' ').next().unwrap_or("0"),
            "",
        ),
        Ok(_) => Problem::new(
            known.key,
            format!("{} is not a whole number", quoted(text)),
            example,
        ),
        Err(misread) if misread.cause.starts_with("unit") => Problem::of(known.key, misread),
        Err(misread) => Problem::new(known.key, misread.cause, example),
    }
}

fn choice(known: &Field, text: &str, names: &'static [&'static str]) -> Result<usize, Problem> {
    let name = text.trim();
    if let Some(index) = names.iter().position(|&known| known == name) {
        return Ok(index);
    }
    let fix = suggest::fix(name, names.iter().copied(), || {
        format!("use one of {}", names.join(", "))
    });
    Err(Problem::new(
        known.key,
        format!("unknown choice {}", quoted(name)),
        fix,
    ))
}

/// What one field alone cannot show. A rule is left out while a field that it reads is itself not
/// sound.
fn together(inputs: &Inputs, sound: impl Fn(&[&str]) -> bool) -> Vec<Problem> {
    let mut found = Vec::new();
    if sound(&[
        "pair.module",
        "driver.teeth",
        "driver.profile_shift",
        "driver.bore_radius",
    ]) {
        found.extend(bore_through_root(
            "driver.bore_radius",
            &inputs.driver,
            inputs.module,
        ));
    }
    if sound(&[
        "pair.module",
        "driven.teeth",
        "driven.profile_shift",
        "driven.bore_radius",
    ]) {
        found.extend(bore_through_root(
            "driven.bore_radius",
            &inputs.driven,
            inputs.module,
        ));
    }
    if sound(&["driver.teeth", "driven.teeth"]) {
        found.extend(ratio_beyond(inputs));
    }
    found
}

fn bore_through_root(field: &str, gear: &Gear, module: f64) -> Option<Problem> {
    let root = module * (f64::from(gear.teeth) / 2.0 - gear.dedendum + gear.profile_shift);
    (gear.bore_radius >= root).then(|| {
        let (bore, root) = (rounded(gear.bore_radius), rounded(root));
        let cause = format!(
            "the bore radius {bore} mm is not below the root circle's {root} mm = m (z/2 - hf* + x)"
        );
        Problem::new(
            field,
            cause,
            format!("write a radius (not a diameter) below {root} mm"),
        )
    })
}

/// A length in mm as a message shows it.
fn rounded(metres: f64) -> f64 {
    (metres * 1e7).round() / 1e4
}

fn ratio_beyond(inputs: &Inputs) -> Option<Problem> {
    let ratio = inputs.ratio();
    let inside = (1.0 / MOST_RATIO..=MOST_RATIO).contains(&ratio);
    (!inside).then(|| {
        let cause = format!(
            "the ratio of tooth numbers {}/{} is {ratio:.4}",
            inputs.driven.teeth, inputs.driver.teeth
        );
        Problem::new(
            "driven.teeth",
            cause,
            format!("keep it within 1/{MOST_RATIO} to {MOST_RATIO}"),
        )
    })
}

/// The refusal of a key that no field has.
#[must_use]
pub fn unknown_key(key: &str) -> Problem {
    let known = FIELDS.iter().map(|field| field.key);
    let name = key.rsplit('.').next().unwrap_or(key);
    let same_name = FIELDS
        .iter()
        .find(|field| field.name() == name)
        .map(|field| format!("did you mean {}?", field.key));
    let fix = same_name.unwrap_or_else(|| {
        suggest::fix(key, known, || {
            "`tipstrike fields` lists every key".to_owned()
        })
    });
    Problem::new(key, format!("unknown key {}", quoted(key)), fix)
}

/// The refusal of a limit on a quantity that does not exist.
#[must_use]
pub fn unknown_quantity(field: &str, quantity: &str) -> Problem {
    let is_symbol = |known: &&Quantity| {
        !known.symbol.is_empty() && known.symbol.eq_ignore_ascii_case(quantity.trim())
    };
    if let Some(known) = QUANTITIES.iter().find(is_symbol) {
        if known.symbol == quantity.trim() {
            let cause = format!("{} is the symbol of {}", quoted(quantity), known.key);
            return Problem::new(field, cause, format!("write {}", known.key));
        }
        let cause = format!("unknown quantity {}", quoted(quantity));
        let fix = format!("did you mean {}, {}?", known.symbol, known.key);
        return Problem::new(field, cause, fix);
    }
    if quantity.trim().is_empty() {
        return Problem::new(
            field,
            "no quantity is named",
            "name one, such as impact_force; commas stand between names alone",
        );
    }
    if quantity.trim().contains(' ') {
        let cause = format!("unknown quantity {}", quoted(quantity));
        return Problem::new(field, cause, "put commas between names");
    }
    let known = QUANTITIES.iter().map(|quantity| quantity.key);
    let fix = suggest::fix(quantity, known, || {
        "`tipstrike fields --results` lists every quantity".to_owned()
    });
    Problem::new(field, format!("unknown quantity {}", quoted(quantity)), fix)
}
