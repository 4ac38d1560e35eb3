//! Frozen rows: pairs, their quantities with 22 digits, and the condition of each quantity.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::thread;

use serde_json::Value;
use tipstrike::model::inputs::{ContactCompliance, Drive, InertiaModel, Method, ToothCompliance};
use tipstrike::model::{Inputs, QUANTITIES, Quantity, Refusal, Stage, Stages, solve};

use crate::envelope::{self, Corner, Random};
use crate::oracle::{self, number};

/// Number of frozen rows of each corner of the envelope.
const COUNTS: [(Corner, usize); 8] = [
    (Corner::Anywhere, 180),
    (Corner::Fit, 240),
    (Corner::StartNearTangent, 70),
    (Corner::StartNearPitch, 70),
    (Corner::FlatAngle, 70),
    (Corner::ShortPath, 70),
    (Corner::SlidingNearZero, 70),
    (Corner::Cancelling, 70),
];

/// A pair with the answers of the oracle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    pub(crate) corner: Corner,
    pub(crate) inputs: Inputs,
    /// Answers with 22 digits, by quantity.
    pub(crate) answers: BTreeMap<String, String>,
    /// Condition numbers by quantity: relative change over the relative change of an input, summed
    /// over all inputs.
    pub(crate) conditions: BTreeMap<String, f64>,
}

impl Row {
    /// The row of a pair; `None` if the oracle finds no corner contact.
    pub(crate) fn of(corner: Corner, inputs: Inputs) -> Option<Row> {
        let (answers, conditions) = oracle::answers_with_conditions(&inputs)?;
        let short = |condition: f64| format!("{condition:.2e}").parse().expect("a number");
        Some(Row {
            corner,
            inputs,
            answers: answers.iter().map(|(&key, one)| (key.into(), number::printed(one))).collect(),
            conditions: conditions.into_iter().map(|(key, one)| (key.into(), short(one))).collect(),
        })
    }

    /// The stages of the quantities that have an answer.
    pub(crate) fn stages(&self) -> Stages {
        let stage = |key: &String| Quantity::find(key).expect("a quantity").stage;
        self.answers.keys().map(stage).map(Stages::of).fold(Stages::NONE, Stages::and)
    }

    /// A quantity as a double.
    pub(crate) fn answer(&self, key: &str) -> Option<f64> {
        Some(self.answers.get(key)?.parse().expect("a number"))
    }

    /// The relative error of a found value; the absolute error from an answer of 0.
    pub(crate) fn off(&self, key: &str, found: f64) -> f64 {
        off(found, &number::decimal(&self.answers[key]))
    }
}

/// The relative error of a found value; the absolute error from an answer of 0. A value that is not
/// finite has an error of at least 1.
pub(crate) fn off(found: f64, answer: &number::Big) -> f64 {
    if !found.is_finite() {
        return f64::INFINITY;
    }
    if number::rounded(answer) == 0.0 {
        return found.abs();
    }
    number::rounded(&((number::big(found) - answer) / answer)).abs()
}

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/core/accuracy/rows.json")
}

pub(crate) fn frozen() -> Vec<Row> {
    let text = std::fs::read_to_string(path()).expect("the frozen rows");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let keys: Vec<&str> =
        file["quantities"].as_array().expect("keys").iter().filter_map(Value::as_str).collect();
    let rows = file["rows"].as_array().expect("rows").iter().map(|row| read(row, &keys));
    rows.filter(|row| has_teeth(&row.inputs)).collect()
}

/// Whether the reliefs leave something of the teeth. A relief that cancels a deviation of a
/// centimetre does not.
fn has_teeth(inputs: &Inputs) -> bool {
    let found = solve(inputs, Stages::of(Stage::Deviation));
    !matches!(found, Err(Refusal::ReliefTooLarge { .. }))
}

/// Computes the rows again on two threads and freezes them.
pub(crate) fn regenerate() {
    let rows: Vec<Row> = thread::scope(|scope| {
        let (first, second) = COUNTS.split_at(2);
        let other = scope.spawn(|| {
            second.iter().flat_map(|&(corner, count)| rows_of(corner, count)).collect::<Vec<_>>()
        });
        let mut rows: Vec<Row> =
            first.iter().flat_map(|&(corner, count)| rows_of(corner, count)).collect();
        rows.extend(other.join().expect("the other half"));
        rows
    });
    std::fs::write(path(), written(&rows)).expect("the rows are written");
}

/// The first rows of a corner, the same in every run.
pub(crate) fn rows_of(corner: Corner, count: usize) -> Vec<Row> {
    let mut random = Random::new(corner as u64 + 1);
    let pairs = std::iter::repeat_with(|| envelope::pair(&mut random, corner));
    pairs.filter(has_teeth).filter_map(|inputs| Row::of(corner, inputs)).take(count).collect()
}

fn written(rows: &[Row]) -> String {
    let keys: Vec<&str> = QUANTITIES.iter().map(|quantity| quantity.key).collect();
    let names: Vec<&str> = FIELDS.iter().map(|field| field.0).collect();
    let lines: Vec<String> = rows.iter().map(|row| written_row(row, &keys)).collect();
    format!(
        "{{\"fields\": {},\n\"quantities\": {},\n\"rows\": [\n{}\n]}}\n",
        serde_json::to_string(&names).expect("JSON"),
        serde_json::to_string(&keys).expect("JSON"),
        lines.join(",\n")
    )
}

fn written_row(row: &Row, keys: &[&str]) -> String {
    let mut inputs = row.inputs.clone();
    let fields: Vec<Option<String>> =
        FIELDS.iter().map(|(_, slot)| slot(&mut inputs).written()).collect();
    let answers: Vec<Option<&String>> = keys.iter().map(|&key| row.answers.get(key)).collect();
    let conditions: Vec<Option<f64>> =
        keys.iter().map(|&key| row.conditions.get(key).copied()).collect();
    let corner = format!("{:?}", row.corner);
    serde_json::json!([corner, choices(&row.inputs), fields, answers, conditions]).to_string()
}

fn read(row: &Value, keys: &[&str]) -> Row {
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let is_own = |corner: &Corner| Some(format!("{corner:?}")) == text(&row[0]);
    let corner = Corner::ALL.into_iter().find(is_own).expect("a corner");
    let mut inputs = chosen(row[1].as_str().expect("choices"));
    for ((_, slot), value) in FIELDS.iter().zip(row[2].as_array().expect("fields")) {
        slot(&mut inputs).read(value.as_str());
    }
    let listed = |values: &Value| {
        keys.iter().map(|&key| key.to_owned()).zip(values.as_array().expect("values").clone())
    };
    Row {
        corner,
        inputs,
        answers: listed(&row[3]).filter_map(|(key, value)| Some((key, text(&value)?))).collect(),
        conditions: listed(&row[4])
            .filter_map(|(key, value)| Some((key, value.as_f64()?)))
            .collect(),
    }
}

/// A reference to a value of the inputs.
enum Slot<'a> {
    Count(&'a mut u32),
    Number(&'a mut f64),
    Perhaps(&'a mut Option<f64>),
}

impl Slot<'_> {
    fn written(self) -> Option<String> {
        match self {
            Slot::Count(count) => Some(count.to_string()),
            Slot::Number(number) => Some(format!("{number:e}")),
            Slot::Perhaps(perhaps) => perhaps.map(|number| format!("{number:e}")),
        }
    }

    fn read(self, text: Option<&str>) {
        let number = text.map(|text| text.parse::<f64>().expect("a number"));
        match self {
            Slot::Count(count) => *count = number.expect("a count") as u32,
            Slot::Number(place) => *place = number.expect("a number"),
            Slot::Perhaps(place) => *place = number,
        }
    }
}

/// A number of the inputs: its name and its reference.
type Field = (&'static str, fn(&mut Inputs) -> Slot<'_>);

/// Every number of the inputs that differs between rows.
const FIELDS: [Field; 30] = [
    ("module", |i| Slot::Number(&mut i.module)),
    ("pressure_angle", |i| Slot::Number(&mut i.pressure_angle)),
    ("centre_distance", |i| Slot::Perhaps(&mut i.centre_distance)),
    ("drive", |i| match &mut i.drive {
        Drive::Power(drive) | Drive::Torque(drive) => Slot::Number(drive),
    }),
    ("speed", |i| Slot::Number(&mut i.speed)),
    ("base_pitch_deviation", |i| Slot::Number(&mut i.base_pitch_deviation)),
    ("deflection", |i| Slot::Perhaps(&mut i.deflection)),
    ("driver.teeth", |i| Slot::Count(&mut i.driver.teeth)),
    ("driver.profile_shift", |i| Slot::Number(&mut i.driver.profile_shift)),
    ("driver.addendum", |i| Slot::Number(&mut i.driver.addendum)),
    ("driver.face_width", |i| Slot::Number(&mut i.driver.face_width)),
    ("driver.bore_radius", |i| Slot::Number(&mut i.driver.bore_radius)),
    ("driver.young", |i| Slot::Number(&mut i.driver.young)),
    ("driver.poisson", |i| Slot::Number(&mut i.driver.poisson)),
    ("driver.density", |i| Slot::Number(&mut i.driver.density)),
    ("driver.root_relief", |i| Slot::Number(&mut i.driver.root_relief)),
    ("driver.tip_chamfer", |i| Slot::Number(&mut i.driver.tip_chamfer)),
    ("driver.tip_radius", |i| Slot::Perhaps(&mut i.driver.tip_radius)),
    ("driven.teeth", |i| Slot::Count(&mut i.driven.teeth)),
    ("driven.profile_shift", |i| Slot::Number(&mut i.driven.profile_shift)),
    ("driven.addendum", |i| Slot::Number(&mut i.driven.addendum)),
    ("driven.face_width", |i| Slot::Number(&mut i.driven.face_width)),
    ("driven.bore_radius", |i| Slot::Number(&mut i.driven.bore_radius)),
    ("driven.young", |i| Slot::Number(&mut i.driven.young)),
    ("driven.poisson", |i| Slot::Number(&mut i.driven.poisson)),
    ("driven.density", |i| Slot::Number(&mut i.driven.density)),
    ("driven.tip_relief", |i| Slot::Number(&mut i.driven.tip_relief)),
    ("driven.tip_chamfer", |i| Slot::Number(&mut i.driven.tip_chamfer)),
    ("driven.tip_radius", |i| Slot::Perhaps(&mut i.driven.tip_radius)),
    ("backlash", |i| Slot::Number(&mut i.backlash)),
];

fn choices(inputs: &Inputs) -> String {
    let drive = if matches!(inputs.drive, Drive::Power(_)) { "power" } else { "torque" };
    let tooth = inputs.tooth_compliance.map_or("by-range", ToothCompliance::name);
    format!("{} {drive} {tooth} {}", inputs.method.name(), inputs.contact_compliance.name())
}

/// Inputs with these choices and default numbers.
fn chosen(choices: &str) -> Inputs {
    let words: Vec<&str> = choices.split(' ').collect();
    let named = |contact: &ContactCompliance| contact.name() == words[3];
    Inputs {
        inertia: InertiaModel::BaseCircle,
        drive: if words[1] == "power" { Drive::Power(0.0) } else { Drive::Torque(0.0) },
        method: Method::ALL.into_iter().find(|method| method.name() == words[0]).expect("a method"),
        tooth_compliance: ToothCompliance::ALL.into_iter().find(|tooth| tooth.name() == words[2]),
        contact_compliance: ContactCompliance::ALL.into_iter().find(named).expect("a compliance"),
        stations: Some(8),
        ..Inputs::default()
    }
}
