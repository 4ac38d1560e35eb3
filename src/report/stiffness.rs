//! The stiffness models compared with finite elements as text, CSV and JSON.

use std::io::{self, Write};

use super::json::{Json, object, sorted, write_line};
use super::layout::{WIDTH, flow, item};
use super::table::{Cell, Column, Table};
use crate::case::sanitize::sanitize;
use crate::model::Refusal;
use crate::model::inputs::ToothCompliance;
use crate::numeric::decimal::significant;
use crate::study::stiffness::{
    Comparison, FIELD, FieldPoint, Flanks, GearComparison, PathComparison, PathPoint, Point,
};

/// The factor from um mm/N to m²/N.
const MICRON_MILLIMETRE: f64 = 1e-9;
const MILLIMETRE: f64 = 1e-3;

/// A comparison and its case.
#[derive(Debug, Clone, Copy)]
pub struct StiffnessReport<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The title of the case, empty without one.
    pub title: &'a str,
    /// The compliances.
    pub comparison: &'a Comparison,
}

/// Writes the comparison as text, 80 columns wide.
///
/// # Errors
/// Errors of the writer.
pub fn write(report: &StiffnessReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let Comparison { flanks, path } = report.comparison;
    let mut sections = vec![heading(report), legend(flanks)];
    sections.extend(flanks.gears.iter().map(|gear| gear_section(flanks, gear)));
    sections.push(path_section("one pair", path, |point| &point.pair));
    sections.push(path_section("all pairs in contact", path, |point| &point.mesh));
    let sections: Vec<_> = sections.iter().map(|lines| lines.join("\n")).collect();
    writeln!(out, "{}", sections.join("\n\n"))
}

fn heading(report: &StiffnessReport<'_>) -> Vec<String> {
    let title = if report.title.is_empty() { "Case without a title" } else { report.title };
    let mut lines = flow(sanitize(title).split_whitespace(), WIDTH);
    let name = sanitize(report.name);
    let words = [name.as_str(), "·", "stiffness models against finite elements"];
    lines.extend(flow(words, WIDTH));
    lines
}

fn legend(flanks: &Flanks) -> Vec<String> {
    let names: Vec<_> = flanks.models.iter().map(|model| model.name()).collect();
    let half_width = significant(flanks.contact_half_width / MILLIMETRE, 4);
    let notes = [
        "Compliances in um mm/N, per unit face width.".to_owned(),
        format!("{}: tooth without contact; in brackets the difference from FE.", names.join(", ")),
        "FE: finite elements (plane strain, whole gear), without contact. FE, surface, \
         neighbour and the beam leave out the twist of the body."
            .to_owned(),
        format!(
            "surface: FE with a contact of half-width {half_width} mm (Hertz, mesh force at the \
             pitch point)."
        ),
        "neighbour: displacement of the next tooth at the same radius; by reciprocity the same \
         ahead and behind."
            .to_owned(),
    ];
    notes.iter().flat_map(|note| item("", note)).collect()
}

fn gear_section(flanks: &Flanks, gear: &GearComparison) -> Vec<String> {
    let radius = |metres: f64| significant(metres / MILLIMETRE, 6);
    let mut lines = vec![format!(
        "{}: z {}, form circle {} mm, tip {} mm",
        gear.gear,
        gear.teeth,
        radius(gear.form_radius),
        radius(gear.tip_radius)
    )];
    if !gear.points.is_empty() {
        let field = [("FE", 10), ("surface", 10), ("neighbour", 11)];
        let field = field.map(|(title, width)| right(title, width));
        let columns = columns("r [mm]", &flanks.models).chain(field).collect();
        let row = |point: &Point| {
            let whole = point.field.map(|field| field.depth);
            let models =
                point.models.iter().map(|&model| compliance(model) + &difference(model, whole));
            let field =
                FIELDS.iter().take(3).map(|(_, of)| compliance(point.field.as_ref().map(of)));
            let cells = std::iter::once(radius(point.radius)).chain(models).chain(field);
            cells.map(Cell::Text).collect()
        };
        lines.extend(Table::new("", columns).with(gear.points.iter().map(row)).lines());
    }
    lines.extend(remarks(gear).iter().flat_map(|remark| item("  - ", remark)));
    lines
}

fn right(title: &str, least: usize) -> Column {
    Column { is_right: true, ..Column::text("", title.to_owned()).wide(0, least) }
}

/// The columns of a place and of the models.
fn columns(place: &str, models: &[ToothCompliance]) -> impl Iterator<Item = Column> {
    let models = models.iter().map(|model| right(model.name(), 16).wide(1, 16));
    std::iter::once(right(place, 8)).chain(models)
}

/// A table of stiffness over the path of contact.
fn path_section(
    pairs: &str,
    path: &PathComparison,
    of: fn(&PathPoint) -> &Vec<Option<f64>>,
) -> Vec<String> {
    let field = path.models.iter().position(|model| model.name() == FIELD);
    let title = format!("Stiffness of {pairs} over the path of contact, in N/(um mm):");
    let row = |point: &PathPoint| {
        let reference = field.and_then(|field| of(point)[field]);
        let cell = |(model, value): (usize, &Option<f64>)| {
            let other = reference.filter(|_| Some(model) != field);
            stiffness(*value, other)
        };
        let cells = of(point).iter().enumerate().map(cell);
        let place = significant(point.way / MILLIMETRE, 4);
        std::iter::once(place).chain(cells).map(Cell::Text).collect()
    };
    let columns = columns("s [mm]", &path.models).collect();
    Table::new(title, columns).with(path.points.iter().map(row)).lines()
}

fn stiffness(value: Option<f64>, reference: Option<f64>) -> String {
    let shown = value.map_or("-".to_owned(), |value| significant(value * MICRON_MILLIMETRE, 4));
    shown + &difference(value, reference)
}

/// The difference from a reference in brackets, as a factor if the percentage is too wide; empty if
/// a value is absent.
fn difference(value: Option<f64>, reference: Option<f64>) -> String {
    const LARGEST: f64 = 999.0;
    let Some((value, reference)) = value.zip(reference) else {
        return String::new();
    };
    let (factor, percent) = (value / reference, 100.0 * (value / reference - 1.0));
    if percent > LARGEST { format!(" ({factor:.0} x)") } else { format!(" ({percent:+.0} %)") }
}

fn compliance(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| significant(value / MICRON_MILLIMETRE, 4))
}

/// The twist of the body, and the reasons for missing values.
fn remarks(gear: &GearComparison) -> Vec<String> {
    let body = match gear.twist {
        _ if gear.refusal.is_some() => None,
        Some(twist) => Some(format!(
            "twist of the body about its bore: {} um mm/N for every tooth, at every radius",
            significant(twist / MICRON_MILLIMETRE, 4)
        )),
        None => Some("no bore: FE leaves out the twist and the shift of the body".to_owned()),
    };
    let gaps =
        gear.gaps.iter().map(|gap| format!("no value by {}: {}", gap.model.name(), gap.reason));
    no_field(gear).into_iter().chain(body).chain(gaps).collect()
}

/// Why a gear has no finite-element values at some radii; `None` if it has them at all radii.
#[must_use]
pub fn no_field(gear: &GearComparison) -> Option<String> {
    Some(format!("no finite-element values: {}", reason(gear)?))
}

fn reason(gear: &GearComparison) -> Option<String> {
    match gear.refusal {
        Some(Refusal::NoField { reason, .. }) => Some(reason.to_string()),
        Some(other) => Some(other.to_string()),
        None => {
            let has_gap = gear.points.iter().any(|point| point.field.is_none());
            has_gap.then(|| "the contact under the mesh force is wider than the tooth".to_owned())
        }
    }
}

/// Writes CSV in SI units, one row per gear and radius; an absent value is an empty cell.
///
/// # Errors
/// Errors of the writer.
pub fn write_csv(flanks: &Flanks, out: &mut dyn Write) -> io::Result<()> {
    let compliance = |name: &str| Column::number(key(name), "", "m2/N", ("1", 0));
    let [radius, half_width] =
        ["radius", "contact_half_width"].map(|key| Column::number(key, "", "m", ("1", 0)));
    let field = FIELDS.map(|(name, _)| compliance(name));
    let [depth, surface, ahead, behind] = field;
    let columns = [Column::text("gear", ""), radius]
        .into_iter()
        .chain(flanks.models.iter().map(|model| compliance(model.name())))
        .chain([depth, half_width, surface, ahead, behind]);
    let row = |gear: &GearComparison, point: &Point| {
        let [depth, surface, ahead, behind] = FIELDS.map(|(_, of)| point.field.as_ref().map(of));
        let half_width = Some(flanks.contact_half_width);
        let numbers = std::iter::once(Some(point.radius))
            .chain(point.models.iter().copied())
            .chain([depth, half_width, surface, ahead, behind])
            .map(|value| Cell::number(value, ""));
        std::iter::once(gear.gear.into()).chain(numbers).collect()
    };
    let rows = flanks.gears.iter();
    let rows = rows.flat_map(|gear| gear.points.iter().map(move |point| row(gear, point)));
    Table::new("", columns.collect()).with(rows).write_csv(out)
}

type Compliance = fn(&FieldPoint) -> f64;

/// The compliances of the finite elements.
const FIELDS: [(&str, Compliance); 4] = [
    (FIELD, |field| field.depth),
    ("finite-element-surface", |field| field.surface),
    ("neighbour-ahead", |field| field.ahead),
    ("neighbour-behind", |field| field.behind),
];

fn key(name: &str) -> String {
    name.replace('-', "_")
}

/// Writes one line of JSON in SI units without absent values.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(report: &StiffnessReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let Comparison { flanks, path } = report.comparison;
    let by_model = |values: &[Option<f64>]| {
        let pairs = path.models.iter().zip(values);
        sorted(pairs.map(|(model, value)| (key(model.name()), (*value).into())))
    };
    let place = |point: &PathPoint| {
        object([
            ("way", point.way.into()),
            ("pair_stiffness", by_model(&point.pair)),
            ("mesh_stiffness", by_model(&point.mesh)),
        ])
    };
    let line = object([
        ("case", report.name.into()),
        ("title", report.title.into()),
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("contact_half_width", flanks.contact_half_width.into()),
        ("gears", flanks.gears.iter().map(|gear| gear_line(flanks, gear)).collect()),
        ("path", path.points.iter().map(place).collect()),
    ]);
    write_line(&line, out)
}

fn gear_line(flanks: &Flanks, gear: &GearComparison) -> Json {
    let gaps = gear.gaps.iter().map(|gap| (key(gap.model.name()), gap.reason.as_str().into()));
    let point = |point: &Point| {
        let models = flanks.models.iter().map(|model| model.name()).zip(&point.models);
        let models = models.map(|(name, value)| (key(name), (*value).into()));
        let field = FIELDS.map(|(name, of)| (key(name), point.field.as_ref().map(of).into()));
        sorted([(key("radius"), point.radius.into())].into_iter().chain(models).chain(field))
    };
    object([
        ("gear", gear.gear.into()),
        ("form_radius", gear.form_radius.into()),
        ("tip_radius", gear.tip_radius.into()),
        ("twist", gear.twist.into()),
        ("refusal", reason(gear).into()),
        ("gaps", (!gear.gaps.is_empty()).then(|| sorted(gaps)).into()),
        ("points", gear.points.iter().map(point).collect()),
    ])
}
