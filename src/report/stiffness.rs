//! The stiffness models compared with finite elements as text, CSV and JSON.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Map, Value};

use super::data::{cell, write_line, write_rows};
use super::layout::{WIDTH, flow, item};
use crate::case::sanitize::sanitize;
use crate::model::Refusal;
use crate::model::inputs::ToothCompliance;
use crate::numeric::decimal::significant;
use crate::study::stiffness::{
    Comparison, FIELD, FieldPoint, GearComparison, PathComparison, PathPoint, Point,
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
    let mut sections = vec![heading(report), legend(report.comparison)];
    for gear in &report.comparison.gears {
        sections.push(gear_section(report.comparison, gear));
    }
    let path = &report.comparison.path;
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

fn legend(comparison: &Comparison) -> Vec<String> {
    let names: Vec<_> = comparison.models.iter().map(|model| model.name()).collect();
    let half_width = significant(comparison.contact_half_width / MILLIMETRE, 4);
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

fn gear_section(comparison: &Comparison, gear: &GearComparison) -> Vec<String> {
    let radius = |metres: f64| significant(metres / MILLIMETRE, 6);
    let mut lines = vec![format!(
        "{}: z {}, form circle {} mm, tip {} mm",
        gear.gear,
        gear.teeth,
        radius(gear.form_radius),
        radius(gear.tip_radius)
    )];
    if !gear.points.is_empty() {
        lines.push(head(&comparison.models));
        lines.extend(gear.points.iter().map(row));
    }
    lines.extend(remarks(gear).iter().flat_map(|remark| item("  - ", remark)));
    lines
}

fn head(models: &[ToothCompliance]) -> String {
    let models: Vec<_> = models.iter().map(|model| format!(" {:>16}", model.name())).collect();
    let models = models.concat();
    format!("{:>8}{models}{:>10}{:>10}{:>11}", "r [mm]", "FE", "surface", "neighbour")
}

/// A table of stiffness over the path of contact.
fn path_section(
    pairs: &str,
    path: &PathComparison,
    of: fn(&PathPoint) -> &Vec<Option<f64>>,
) -> Vec<String> {
    let field = path.models.iter().position(|model| model.name() == FIELD);
    let names: Vec<_> = path.models.iter().map(|model| format!(" {:>16}", model.name())).collect();
    let title = format!("Stiffness of {pairs} over the path of contact, in N/(um mm):");
    let mut lines = vec![title, format!("{:>8}{}", "s [mm]", names.concat())];
    lines.extend(path.points.iter().map(|point| {
        let values = of(point);
        let reference = field.and_then(|field| values[field]);
        let cells: Vec<_> = values
            .iter()
            .enumerate()
            .map(|(model, value)| {
                let other = reference.filter(|_| Some(model) != field);
                format!(" {:>16}", stiffness(*value, other))
            })
            .collect();
        format!("{:>8}{}", significant(point.way / MILLIMETRE, 4), cells.concat())
    }));
    lines
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

fn row(point: &Point) -> String {
    let whole = point.field.map(|field| field.depth);
    let models: Vec<_> = point
        .models
        .iter()
        .map(|model| format!(" {:>16}", with_difference(*model, whole)))
        .collect();
    let models = models.concat();
    let field = |of: fn(&FieldPoint) -> f64| compliance(point.field.as_ref().map(of));
    format!(
        "{:>8}{models}{:>10}{:>10}{:>11}",
        significant(point.radius / MILLIMETRE, 6),
        field(|field| field.depth),
        field(|field| field.surface),
        field(|field| field.ahead)
    )
}

fn compliance(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| significant(value / MICRON_MILLIMETRE, 4))
}

fn with_difference(value: Option<f64>, reference: Option<f64>) -> String {
    compliance(value) + &difference(value, reference)
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
pub fn write_csv(comparison: &Comparison, out: &mut dyn Write) -> io::Result<()> {
    let models = comparison.models.iter().map(|model| column(model.name()));
    let header = ["gear".to_owned(), "radius [m]".to_owned()].into_iter().chain(models).chain([
        column(FIELD),
        "contact_half_width [m]".to_owned(),
        column("finite-element-surface"),
        column("neighbour-ahead"),
        column("neighbour-behind"),
    ]);
    let rows = comparison
        .gears
        .iter()
        .flat_map(|gear| gear.points.iter().map(|point| csv_row(comparison, gear, point)));
    write_rows(std::iter::once(header.collect()).chain(rows), out)
}

fn key(name: &str) -> String {
    name.replace('-', "_")
}

fn column(name: &str) -> String {
    format!("{} [m2/N]", key(name))
}

fn csv_row(comparison: &Comparison, gear: &GearComparison, point: &Point) -> Vec<String> {
    let field = |of: fn(&FieldPoint) -> f64| cell(point.field.as_ref().map(of));
    [gear.gear.to_owned(), cell(Some(point.radius))]
        .into_iter()
        .chain(point.models.iter().copied().map(cell))
        .chain([
            field(|field| field.depth),
            cell(Some(comparison.contact_half_width)),
            field(|field| field.surface),
            field(|field| field.ahead),
            field(|field| field.behind),
        ])
        .collect()
}

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    contact_half_width: f64,
    gears: Vec<GearLine>,
    path: Vec<PathLine>,
}

#[derive(Serialize)]
struct PathLine {
    way: f64,
    pair_stiffness: Map<String, Value>,
    mesh_stiffness: Map<String, Value>,
}

#[derive(Serialize)]
struct GearLine {
    gear: &'static str,
    form_radius: f64,
    tip_radius: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    twist: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refusal: Option<String>,
    #[serde(skip_serializing_if = "Map::is_empty")]
    gaps: Map<String, Value>,
    points: Vec<Map<String, Value>>,
}

/// Writes one line of JSON in SI units without absent values.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(report: &StiffnessReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let comparison = report.comparison;
    let line = Line {
        case: report.name,
        title: report.title,
        version: env!("CARGO_PKG_VERSION"),
        contact_half_width: comparison.contact_half_width,
        gears: comparison.gears.iter().map(|gear| gear_line(comparison, gear)).collect(),
        path: path_lines(&comparison.path),
    };
    write_line(&line, out)
}

fn path_lines(path: &PathComparison) -> Vec<PathLine> {
    let by_model = |values: &[Option<f64>]| -> Map<String, Value> {
        let pairs = path.models.iter().zip(values);
        pairs.filter_map(|(model, value)| Some((key(model.name()), (*value)?.into()))).collect()
    };
    let line = |point: &PathPoint| PathLine {
        way: point.way,
        pair_stiffness: by_model(&point.pair),
        mesh_stiffness: by_model(&point.mesh),
    };
    path.points.iter().map(line).collect()
}

fn gear_line(comparison: &Comparison, gear: &GearComparison) -> GearLine {
    let gaps = gear.gaps.iter().map(|gap| (key(gap.model.name()), gap.reason.as_str().into()));
    let points = gear.points.iter().map(|point| json_point(comparison, point));
    GearLine {
        gear: gear.gear,
        form_radius: gear.form_radius,
        tip_radius: gear.tip_radius,
        twist: gear.twist,
        refusal: reason(gear),
        gaps: gaps.collect(),
        points: points.collect(),
    }
}

fn json_point(comparison: &Comparison, point: &Point) -> Map<String, Value> {
    let models = comparison
        .models
        .iter()
        .zip(&point.models)
        .filter_map(|(model, value)| Some((model.name(), (*value)?)));
    let field = point.field.iter().flat_map(|field| {
        [
            (FIELD, field.depth),
            ("finite-element-surface", field.surface),
            ("neighbour-ahead", field.ahead),
            ("neighbour-behind", field.behind),
        ]
    });
    [("radius", point.radius)]
        .into_iter()
        .chain(models)
        .chain(field)
        .map(|(name, value)| (key(name), value.into()))
        .collect()
}
