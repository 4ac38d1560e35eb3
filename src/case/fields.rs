//! The table of fields. The form, the TOML keys, `--set` and the help use it.

mod table;

use super::units::{self, Dimension, System};
use crate::model::Inputs;
use crate::model::compliance::{contact_of, model_of};
use crate::model::given::COEFFICIENTS;
use crate::model::inputs::{Gear, GearSide, Method};
use crate::model::limits::Member;
use crate::numeric::decimal::shortest;
use Reason::{Idle, Partly};
pub use table::{FIELDS, List};

/// Significant digits of a hint.
const DIGITS: usize = 5;

/// A line of the form and a key of the case file.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// The dotted key in the case file, such as `pair.module`.
    pub key: &'static str,
    /// The symbol in formulas.
    pub symbol: &'static str,
    /// A short description.
    pub label: &'static str,
    /// One sentence of help.
    pub help: &'static str,
    /// The kind of value.
    pub kind: Kind,
    /// Whether a case can omit the field, and the default.
    pub absent: Absent,
    /// An example value. Empty if the default or a choice shows how to write a value.
    pub example: &'static str,
    /// The key of the field that gives the same value in another way. A case gives only one of
    /// them.
    pub alternative: Option<&'static str>,
    /// The value, in SI, computed from other fields if the case does not give it.
    pub derived: Option<Derive>,
    /// Reasons why the field has less effect than expected. The first reason whose condition is
    /// true is used.
    pub reasons: &'static [Reason],
    /// Whether a case reads the field, if the inputs of the stages do not decide this.
    pub read_when: Option<When>,
}

/// A value in SI computed from the inputs. `None` if inputs are missing.
pub type Derive = fn(&Inputs) -> Option<f64>;

/// The kind of value of a field.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// Free text.
    Text,
    /// A value of a dimension, or a bare number for [`Dimension::Number`].
    Number(Dimension, Range, fn(&mut Inputs, f64)),
    /// A whole number. 0 means "auto" if the field accepts it.
    Count(u32, u32, fn(&mut Inputs, u32)),
    /// One of several names.
    Choice(&'static [&'static str], fn(&mut Inputs, usize)),
    /// Bare numbers.
    List(fn(&mut Inputs, List)),
}

/// A value of a field, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// Free text, which no model reads.
    Text,
    /// A number.
    Number(f64),
    /// A whole number.
    Count(u32),
    /// The index of a choice.
    Choice(usize),
    /// Bare numbers, unused ones 0.
    List(List),
}

/// Replaces a number that the program computes.
pub const AUTO: &str = "auto";

/// The names of a choice that TOML writes as a boolean.
pub const FLAG: &[&str] = &["false", "true"];

/// The range of a field, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least value, in the unit `unit`.
    pub from: f64,
    /// Greatest value, in the unit `unit`.
    pub to: f64,
    /// The unit of the shown range, and of a new value.
    pub unit: &'static str,
}

impl Range {
    /// From `from` to `to`, both in `unit`.
    const fn new(from: f64, to: f64, unit: &'static str) -> Range {
        Range { from, to, unit }
    }
}

/// The meaning of a field that a case does not give.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Absent {
    /// The field is required.
    Refused,
    /// The default text.
    Default(&'static str),
    /// The model does not need a value. The form shows these words instead.
    Without(&'static str),
    /// Exactly one of this field and its alternative is given.
    Either,
}

impl Field {
    /// The usual unit of the field. Empty for a bare number, a count, a choice and text.
    pub fn usual_unit(&self) -> &'static str {
        let is_number = matches!(self.kind, Kind::Number(..));
        self.example().split_once(' ').filter(|_| is_number).map_or("", |(_, unit)| unit)
    }

    /// A default or an example of the field in a unit.
    pub(crate) fn text_in(&self, text: &str, unit: &str) -> String {
        let value = match self.kind {
            Kind::Number(dimension, ..) if unit != self.usual_unit() => {
                units::parse(text, dimension, "").ok()
            }
            _ => None,
        };
        value.map_or_else(|| text.to_owned(), |value| in_unit(value, unit))
    }

    /// The index of its alternative in [`FIELDS`].
    pub fn partner(&self) -> Option<usize> {
        self.alternative.and_then(index_of)
    }

    /// The table of the case file with this field. Empty for the top level.
    pub fn table(&self) -> &'static str {
        self.key.split_once('.').map_or("", |(table, _)| table)
    }

    /// Whether the field describes one of the gears.
    pub fn is_of_gear(&self) -> bool {
        matches!(self.table(), "driver" | "driven")
    }

    /// The label, with the gear if both gears have the field: `driven tip relief`.
    pub fn full_label(&self) -> String {
        if self.is_of_gear() {
            format!("{} {}", self.table(), self.label)
        } else {
            self.label.to_owned()
        }
    }

    /// The key within its table.
    pub fn name(&self) -> &'static str {
        self.key.split_once('.').map_or(self.key, |(_, name)| name)
    }
}

impl Field {
    /// Default values of a row.
    const PLAIN: Field = Field {
        key: "",
        symbol: "",
        label: "",
        help: "",
        kind: Kind::Text,
        absent: Absent::Default(""),
        example: "",
        alternative: None,
        derived: None,
        reasons: &[],
        read_when: None,
    };

    const fn with_example(self, example: &'static str) -> Field {
        Field { example, ..self }
    }

    const fn instead_of(self, alternative: &'static str, derived: Derive) -> Field {
        Field { alternative: Some(alternative), ..self.derived(derived) }
    }

    const fn derived(self, derived: Derive) -> Field {
        let derived = Some(derived);
        Field { derived, ..self }
    }

    const fn reasons(self, reasons: &'static [Reason]) -> Field {
        Field { reasons, ..self }
    }

    const fn read_when(self, when: When) -> Field {
        let read_when = Some(when);
        Field { read_when, ..self }
    }

    /// Writes a value of this field into the inputs of a model.
    pub fn put(&self, value: Value, inputs: &mut Inputs) {
        match (self.kind, value) {
            (Kind::Number(_, _, put), Value::Number(value)) => put(inputs, value),
            (Kind::Count(_, _, put), Value::Count(value)) => put(inputs, value),
            (Kind::Choice(_, put), Value::Choice(value)) => put(inputs, value),
            (Kind::List(put), Value::List(values)) => put(inputs, values),
            _ => {}
        }
    }

    /// A number as a value of this field; every value of a list.
    pub fn value_of(&self, number: f64) -> Value {
        match self.kind {
            Kind::Text => Value::Text,
            Kind::Number(..) => Value::Number(number),
            Kind::Count(..) => Value::Count(number as u32),
            Kind::Choice(..) => Value::Choice(number as usize),
            Kind::List(_) => Value::List([number; COEFFICIENTS]),
        }
    }

    /// The names of a choice, otherwise none.
    pub fn choices(&self) -> &'static [&'static str] {
        if let Kind::Choice(names, _) = self.kind { names } else { &[] }
    }

    /// Whether the value is true or false.
    pub fn is_flag(&self) -> bool {
        self.choices() == FLAG
    }

    /// Whether the value is one of several names.
    pub fn is_choice(&self) -> bool {
        matches!(self.kind, Kind::Choice(..))
    }

    /// Whether the word "auto" can replace the number.
    pub fn takes_auto(&self) -> bool {
        matches!(self.key, "model.stations" | "model.slices")
    }

    /// Whether a file contains the value without quotes.
    pub fn is_bare(&self) -> bool {
        self.is_flag() || matches!(self.kind, Kind::Count(..) | Kind::Number(Dimension::Number, ..))
    }

    /// A valid text of the field, as an example.
    pub fn example(&self) -> &'static str {
        match (self.absent, self.kind) {
            (Absent::Default(text), _) if !text.is_empty() => text,
            (_, Kind::Choice(names, _)) => names[0],
            (_, Kind::Text) => "a few words",
            _ => self.example,
        }
    }

    /// The range of a number or a count.
    pub fn range(&self) -> Option<Range> {
        match self.kind {
            Kind::Number(_, range, _) => Some(range),
            Kind::Count(from, to, _) => Some(Range::new(from.into(), to.into(), "")),
            Kind::Text | Kind::Choice(..) | Kind::List(_) => None,
        }
    }

    /// The range as text, or the names of a choice. Empty for free text.
    pub fn range_text(&self) -> String {
        let Some(Range { from, to, unit }) = self.range() else {
            return match self.kind {
                Kind::List(_) => format!("up to {COEFFICIENTS} numbers"),
                _ => self.choices().join(", "),
            };
        };
        let text = format!("{} to {} {unit}", shortest(from), shortest(to));
        let auto = if self.takes_auto() { format!(", or {AUTO}") } else { String::new() };
        format!("{}{auto}", text.trim_end())
    }
}

/// A value in SI in a unit, with the digits of a hint.
pub(crate) fn in_unit(value: f64, unit: &str) -> String {
    System::Metric.text(value, unit, DIGITS)
}

/// The index of a key in [`FIELDS`].
pub fn index_of(key: &str) -> Option<usize> {
    FIELDS.iter().position(|field| field.key == key)
}

/// Whether a field gives a load or deviation, which changes neither the geometry and the masses of the
/// gears nor the compliance of their teeth.
pub fn keeps_gears(field: usize) -> bool {
    const KEYS: [&str; 9] = [
        "driver.root_relief",
        "driver.base_pitch",
        "driven.tip_relief",
        "driven.base_pitch",
        "deviations.base_pitch",
        "deviations.backlash",
        "operation.power",
        "operation.torque",
        "model.deflection",
    ];
    KEYS.contains(&FIELDS[field].key)
}

/// The key of a member of the inputs, of one gear or of the pair.
pub fn key_of((gear, name): Member) -> &'static str {
    let table = gear.map(|gear| if gear == GearSide::Driver { "driver" } else { "driven" });
    let has_table =
        |field: &Field| table.map_or(!field.is_of_gear(), |table| field.table() == table);
    let field = FIELDS.iter().find(|field| field.name() == name && has_table(field));
    field.map_or(name, |field| field.key)
}

/// The groups of the form: the name of the table in the file and the title.
pub const GROUPS: [(&str, &str); 8] = [
    ("", "Case"),
    ("pair", "Pair"),
    ("driver", "Driver (gear 1)"),
    ("driven", "Driven (gear 2)"),
    ("deviations", "Deviations"),
    ("operation", "Operation"),
    ("model", "Model"),
    ("compliance", "Given compliance"),
];

/// A condition on the inputs.
pub type When = fn(&Inputs) -> bool;

/// The reason why a field has no effect in a case, or less effect than expected.
#[derive(Debug, Clone, Copy)]
pub enum Reason {
    /// No stage reads the field.
    Idle(When, &'static str),
    /// No stage reads the field. Reports show it beside the results.
    Beside(&'static str),
    /// A stage reads the field, but the results depend less on it than expected.
    Partly(When, &'static str),
}

const AT_EXIT: &str = "this relief acts at the exit; this method computes only \
    the entry, where the driven tip meets the driver's root";
const TIP_OF_DRIVER: &str = "the driver's tip ends contact at B; at the entry this field \
    affects only the number of loaded pairs";
const IN_TIME: &str = "only the method dynamic follows the motion in time";
const NO_HAND: &str = "a spur pair has no hand";
const CURVE: &str = "changes only how closely the curve is sampled";

const ROOT: [Reason; 1] = [Partly(
    |inputs| !root_is_read(inputs),
    "the tooth compliance ignores the root; only the stiffness spread changes, because the spread \
        includes the other models",
)];

/// Reasons for the fields of the face width.
const FACE: [Reason; 2] = [
    Idle(by_impact, "this method computes one plane across the axis"),
    Idle(|inputs| inputs.face().is_none(), "all planes across the axis of this pair are equal"),
];

/// Reasons for the fields of the given compliance.
const NO_TABLE: [Reason; 1] =
    [Idle(|inputs| inputs.elasticity().given.is_none(), "model.tooth_compliance is not given")];

/// Reasons for relief lengths and shapes.
const WHOLE_RELIEF: [Reason; 1] = [Idle(
    by_impact,
    "this method applies the full relief at the first contact and ignores length and shape",
)];

const LOAD: [Reason; 1] = [Partly(
    |inputs| inputs.method != Method::Auto && inputs.given_deflection().is_some(),
    "with the deflection given, the load changes F_0, not the impact",
)];

const MASS: [Reason; 1] = [Partly(|inputs| inputs.method == Method::Static, NO_MASS)];

/// The tooth compliances that depend on the root include the body of the gear.
const BORE: [Reason; 1] = [Partly(
    |inputs| inputs.method == Method::Static && !model_of(inputs).model().reads_root,
    NO_MASS,
)];

const NO_MASS: &str = "the static load does not depend on mass; only the free impact changes";

fn always(_: &Inputs) -> bool {
    true
}

fn by_impact(inputs: &Inputs) -> bool {
    matches!(inputs.method, Method::Paper | Method::Exact)
}

/// Whether the index of a gear is that of the driver.
fn is_driver(index: &str) -> bool {
    index == "1"
}

/// Whether this face width is at least that of both gears, in method `static`.
fn is_wider(inputs: &Inputs, width: f64) -> bool {
    let widest = inputs.driver.face_width.max(inputs.driven.face_width);
    inputs.method == Method::Static && width >= widest
}

/// Whether a compliance of the case depends on the root of the teeth.
fn root_is_read(inputs: &Inputs) -> bool {
    model_of(inputs).model().reads_root
        || contact_of(inputs).is_some_and(|contact| contact.model().reads_root)
}

/// Whether module and number of teeth, which determine every circle, are known.
fn has_size(inputs: &Inputs, gear: &Gear) -> bool {
    inputs.module > 0.0 && gear.teeth > 0
}

/// Tip diameter without a chamfer, d_a = m_t z + 2 m_n (h_a* + x), in m.
fn tip_diameter(inputs: &Inputs, gear: &Gear) -> Option<f64> {
    let addendum = inputs.addendum_of(gear);
    has_size(inputs, gear).then(|| diameter(inputs, gear, addendum + gear.profile_shift))
}

/// Root diameter d_f = m_t z + 2 m_n (x − h_fP*), in m.
fn root_diameter(inputs: &Inputs, gear: &Gear) -> Option<f64> {
    let dedendum = inputs.dedendum_of(gear);
    has_size(inputs, gear).then(|| diameter(inputs, gear, gear.profile_shift - dedendum))
}

/// The diameter of a circle at a height above the reference circle, times the normal module.
fn diameter(inputs: &Inputs, gear: &Gear, height: f64) -> f64 {
    let teeth = f64::from(gear.teeth) / inputs.helix_cosine();
    inputs.module * (teeth + 2.0 * height)
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::model::inputs::{ContactCompliance, Inputs, ToothCompliance};
    use crate::model::{self, Stage, Stages};

    /// The notes beside dedendum and bore name the models that read them.
    #[test]
    fn a_stiffness_model_says_whether_it_reads_the_root() {
        let results = |tooth, contact, edit: fn(&mut Inputs)| {
            let mut inputs = Case::table_1().inputs().unwrap();
            (inputs.tooth_compliance, inputs.contact_compliance) = (Some(tooth), contact);
            edit(&mut inputs);
            let solution = model::solve(&inputs, Stages::of(Stage::Impact)).unwrap();
            let results = [solution.compliance.unwrap().driver, solution.impact.unwrap().force];
            results.map(f64::to_bits)
        };
        for tooth in ToothCompliance::ALL {
            for contact in ContactCompliance::ALL {
                let before = results(tooth, contact, |_| ());
                let reads = tooth.model().reads_root;
                let [bored, _] = results(tooth, contact, |inputs| inputs.driver.bore_radius = 9e-3);
                assert_eq!(bored != before[0], reads, "{}", tooth.name());
                let [_, deeper] = results(tooth, contact, |inputs| inputs.driver.dedendum = 1.3);
                let reads = reads || contact.model().reads_root;
                assert!(reads || deeper == before[1], "{} with {}", tooth.name(), contact.name());
            }
        }
    }
}
