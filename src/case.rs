//! A case as the user wrote it, checked against the table of fields.

pub mod changes;
mod check;
pub mod dependencies;
pub mod evaluate;
pub mod examples;
pub mod fields;
pub mod file;
pub mod rexs;
pub mod sanitize;
pub mod spread;
pub mod units;

use std::sync::Arc;

use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity};
pub use changes::Change;
pub use changes::{Override, Variant};
pub use check::{MISSING, NEWER_FORMAT, Problem};
pub use check::{field_range, field_value, put as put_field, quantity, unknown_key, violated_rule};
pub use dependencies::{Acting, partial_relevance, relevance};
pub use evaluate::Evaluator;
pub use examples::{EXAMPLES, Example};
pub use fields::{FIELDS, Field};
pub use file::Document;
pub use spread::Spread;

/// Start of the keys of the table `[about]`.
const ABOUT: &str = "about.";

/// A case: the text of each field, in the order of [`FIELDS`], with limits, distributions and
/// variants.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Copied on the first write, because many states of a case exist at a time; they share texts.
    texts: Arc<Vec<Option<Arc<str>>>>,
    /// Limits by quantity, greatest value in SI.
    pub limits: Vec<Limit>,
    /// Distributions of fields around their values.
    pub spread: Vec<Spread>,
    /// Named overrides, in the order of the file.
    pub variants: Vec<Variant>,
    /// The table `[about]`: texts for the page of a report, such as project and drawing.
    pub about: Vec<(String, String)>,
}

/// The greatest allowed value of a quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// The limited quantity.
    pub quantity: &'static Quantity,
    /// The text as the user wrote it.
    pub text: String,
    /// The value in SI, or the factor of another result; infinite while the text in a form is
    /// invalid.
    pub value: f64,
    /// The result to which the limit is relative.
    pub of: Option<&'static Quantity>,
}

impl Limit {
    /// A limit from the quantity's key and a text such as "2500 N" or "1.3 x mesh_force". The
    /// nominal force is the mesh force.
    ///
    /// # Errors
    /// If the quantity does not exist, or the text is neither a value of the quantity nor a multiple
    /// of a result in the same unit.
    pub fn new(key: &str, text: &str) -> Result<Limit, Problem> {
        let field = format!("limits.{key}");
        let known = Quantity::find(key).ok_or_else(|| check::unknown_quantity(&field, key))?;
        let (key, owned) = (known.key, text.to_owned());
        if let Some((factor, other)) = relative(text) {
            let of = quantity(&field, if other == NOMINAL { MESH_FORCE } else { other })?;
            if of.unit != known.unit || of.is_flag() {
                let name = if other == NOMINAL { "nominal, the mesh_force," } else { of.key };
                let cause = format!("{name} has another unit than {key}");
                return Err(Problem::new(&field, cause, "name a result in the same unit"));
            }
            return Ok(Limit { quantity: known, text: owned, value: factor, of: Some(of) });
        }
        let dimension = match units::split(text, "") {
            // Zero is the same in every unit.
            Ok((number, "")) if number.parse() == Ok(0.0) => units::Dimension::Number,
            _ => units::Dimension::of_unit(known.unit).unwrap_or(units::Dimension::Number),
        };
        let usual = if matches!(known.shown, "1" | "yes/no") { "" } else { known.shown };
        let value = units::parse(text, dimension, usual).map_err(|misread| {
            let problem = misread.at(&field);
            if known.is_flag() {
                let fix = "write 0 to forbid it or 1 to permit it".into();
                return Problem { fix, ..problem };
            }
            problem
        })?;
        Ok(Limit { quantity: known, text: owned, value, of: None })
    }

    /// The text for a sentence, on one line, with the result that `nominal` names.
    pub fn shown(&self) -> String {
        let text = sanitize::sanitize(&self.text);
        let is_nominal = relative(&self.text).is_some_and(|(_, other)| other == NOMINAL);
        if is_nominal { format!("{text} ({MESH_FORCE})") } else { text }
    }

    /// The greatest allowed value in SI, if the result to which it is relative has a value.
    pub fn bound(&self, value: impl Fn(&'static Quantity) -> Option<f64>) -> Option<f64> {
        let base = self.of.map_or(Some(1.0), value);
        Some(self.value * base?)
    }

    /// The limited quantity, and that to which the limit is relative.
    pub fn quantities(&self) -> impl Iterator<Item = &'static Quantity> + use<> {
        [Some(self.quantity), self.of].into_iter().flatten()
    }
}

/// The short name of the nominal force in a relative limit, and the key of this force.
const NOMINAL: &str = "nominal";
const MESH_FORCE: &str = "mesh_force";

/// The factor and the result of a text such as "1.3 x mesh_force".
fn relative(text: &str) -> Option<(f64, &str)> {
    let (factor, other) = text.split_once(" x ")?;
    let factor = factor.trim().parse::<f64>().ok().filter(|factor| factor.is_finite())?;
    Some((factor, other.trim()))
}

impl Case {
    /// A case without any text.
    pub fn empty() -> Case {
        Case {
            texts: Arc::new(vec![None; FIELDS.len()]),
            limits: Vec::new(),
            spread: Vec::new(),
            variants: Vec::new(),
            about: Vec::new(),
        }
    }

    /// Table 1 of Zhou & Chen 2014, from `cases/zhou-chen-2014.toml`.
    pub fn table_1() -> Case {
        Document::table_1().case
    }

    /// A new case: only the method is set, and the required values are missing.
    pub fn fresh() -> Case {
        let mut case = Case::empty();
        if let Some(method) = fields::index_of("model.method") {
            case.write(method, Method::Auto.name());
        }
        case
    }

    /// Whether the field is required and has no value. If two fields exclude each other, both are
    /// required while neither has a value.
    pub fn lacks(&self, field: usize) -> bool {
        let is_empty = |field: usize| self.text(field).is_none();
        match FIELDS[field].absent {
            fields::Absent::Refused => is_empty(field),
            fields::Absent::Either => {
                is_empty(field) && FIELDS[field].partner().is_none_or(is_empty)
            }
            fields::Absent::Default(_) | fields::Absent::Without(_) => false,
        }
    }

    /// Whether the alternative of the field replaces it, by its given or its default value.
    pub fn is_replaced(&self, field: usize) -> bool {
        let has_default = |other: usize| matches!(FIELDS[other].absent, fields::Absent::Default(_));
        let stands = |other: usize| self.text(other).is_some() || has_default(other);
        self.text(field).is_none() && FIELDS[field].partner().is_some_and(stands)
    }

    /// The value, in SI, that follows from other fields if the case does not give it.
    pub fn derived(&self, field: usize, inputs: &Inputs) -> Option<f64> {
        let derived = FIELDS[field].derived.filter(|_| self.text(field).is_none())?;
        derived(inputs).filter(|value| value.is_finite())
    }

    /// The text of the field. `None` if the case does not give it.
    pub fn text(&self, field: usize) -> Option<&str> {
        self.texts[field].as_deref()
    }

    /// The title, or an empty text.
    pub fn title(&self) -> &str {
        let title = fields::index_of("title").and_then(|field| self.text(field));
        title.unwrap_or_default()
    }

    /// Writes a field, with a valid or an invalid text. An empty text removes the field.
    pub fn write(&mut self, field: usize, text: &str) {
        Arc::make_mut(&mut self.texts)[field] = (!text.is_empty()).then(|| text.into());
    }

    /// The text of the field, or its default, or the words for a missing value. `None` if a
    /// required value is missing, or if the alternative replaces the field.
    pub fn effective(&self, field: usize) -> Option<&str> {
        match FIELDS[field].absent {
            _ if self.texts[field].is_some() => self.text(field),
            _ if self.is_replaced(field) => None,
            fields::Absent::Default(text) => Some(text).filter(|text| !text.is_empty()),
            fields::Absent::Without(words) => Some(words),
            fields::Absent::Refused | fields::Absent::Either => None,
        }
    }

    /// The symbol of a field. The module and pressure angle of a helical pair are those of the normal
    /// section.
    pub fn symbol(&self, field: usize) -> &'static str {
        let is_helical = || {
            let angle = fields::index_of("pair.helix_angle").and_then(|at| self.value(at));
            angle.is_some_and(|angle| angle > 0.0)
        };
        match FIELDS[field].key {
            "pair.module" if is_helical() => "m_n",
            "pair.pressure_angle" if is_helical() => "α_n",
            _ => FIELDS[field].symbol,
        }
    }

    /// The value in SI of a number field, given or by default. `None` if the model needs no value,
    /// or if the text is invalid.
    pub fn value(&self, field: usize) -> Option<f64> {
        let text = self.effective(field)?;
        match FIELDS[field].kind {
            fields::Kind::Number(dimension, range, _) => {
                units::parse(text, dimension, range.unit).ok()
            }
            fields::Kind::Count(..) => text.trim().parse::<u32>().ok().map(f64::from),
            _ => None,
        }
    }

    /// Writes the limit of a quantity, with a valid or an invalid text. An empty text leaves an
    /// empty limit until [`Case::drop_empty`].
    pub fn write_limit(&mut self, quantity: &'static Quantity, text: &str) {
        let unread = Limit { quantity, text: text.to_owned(), value: f64::INFINITY, of: None };
        let limit = Limit::new(quantity.key, text).unwrap_or(unread);
        keep(&mut self.limits, Some(limit), |held| held.quantity == quantity);
    }

    /// Writes the distribution of a field, as [`Case::write_limit`] writes a limit.
    pub fn write_spread(&mut self, field: &'static str, text: &str) {
        let unread =
            Spread { field, text: text.to_owned(), shape: spread::Shape::Normal, width: 0.0 };
        let spread = Spread::new(field, text).unwrap_or(unread);
        keep(&mut self.spread, Some(spread), |held| held.field == field);
    }

    /// Removes the empty limits and distributions except that of the named quantity or field.
    pub fn drop_empty(&mut self, but: Option<&str>) {
        self.limits.retain(|limit| !limit.text.is_empty() || Some(limit.quantity.key) == but);
        self.spread.retain(|spread| !spread.text.is_empty() || Some(spread.field) == but);
    }

    /// Checks the text of one field alone.
    ///
    /// # Errors
    /// The cause and the fix, in the words used for a file.
    pub fn check_field(&self, field: usize) -> Result<(), Problem> {
        check::put(self, field, &mut Inputs::default())
    }

    /// The model's inputs.
    ///
    /// # Errors
    /// All problems of the case, in the order of the fields.
    pub fn inputs(&self) -> Result<Inputs, Vec<Problem>> {
        let (inputs, problems) = self.read();
        if problems.is_empty() { Ok(inputs) } else { Err(problems) }
    }

    /// The inputs that can be read, enough for the relevance of fields, and all problems of the
    /// case, in the order of the fields.
    pub fn read(&self) -> (Inputs, Vec<Problem>) {
        check::read(self, &[])
    }

    /// Writes a field or a limit by its key, as `--set KEY=VALUE` does. Quotes around the value are
    /// optional. An empty value removes the field. If two fields exclude each other, writing one
    /// removes the other.
    ///
    /// # Errors
    /// If the key does not exist or the value does not fit. The case is then unchanged.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), Problem> {
        let mut changed = self.clone();
        changed.apply(key, Some(unquoted(value.trim())))?;
        if let Some(field) = fields::index_of(key) {
            if let Some(other) = FIELDS[field].partner() {
                changed.write(other, "");
            }
            changed.check_field(field)?;
        }
        *self = changed;
        Ok(())
    }

    /// Writes a text of the table `[about]`. An empty text removes the key.
    fn write_about(&mut self, name: &str, text: &str) {
        let new = (!text.is_empty()).then(|| (name.to_owned(), text.to_owned()));
        keep(&mut self.about, new, |held| held.0 == name);
    }

    /// Whether two keys exclude each other.
    pub fn are_exclusive(key: &str, other: &str) -> bool {
        fields::index_of(key).is_some_and(|field| {
            let partner = FIELDS[field].partner();
            partner.is_some() && partner == fields::index_of(other)
        })
    }

    /// Sets the limit of a quantity. An empty text removes the limit.
    ///
    /// # Errors
    /// If the quantity does not exist, or the text is not a value of the quantity.
    pub fn set_limit(&mut self, quantity: &str, text: &str) -> Result<(), Problem> {
        let is_removed = text.is_empty() && Quantity::find(quantity).is_some();
        let new = (!is_removed).then(|| Limit::new(quantity, text)).transpose()?;
        keep(&mut self.limits, new, |held| held.quantity.key == quantity);
        Ok(())
    }
}

/// Replaces the entry that is the same, or adds the new entry; without one, removes the entry.
fn keep<T>(entries: &mut Vec<T>, new: Option<T>, is_same: impl Fn(&T) -> bool) {
    match (entries.iter().position(is_same), new) {
        (Some(at), Some(new)) => entries[at] = new,
        (Some(at), None) => drop(entries.remove(at)),
        (None, new) => entries.extend(new),
    }
}

fn unquoted(text: &str) -> &str {
    ['"', '\'']
        .iter()
        .find_map(|&quote| text.strip_prefix(quote)?.strip_suffix(quote))
        .unwrap_or(text)
}

#[cfg(test)]
mod tests;
