//! The stiffness models compared with finite elements as text, CSV and JSON.

use super::json::{Json, json, sorted};
use super::layout::item;
use super::results::{Named, Results};
use super::table::{Cell, Column, Table};
use crate::model::Refusal;
use crate::model::inputs::ToothCompliance;
use crate::numeric::decimal::significant;
use crate::study::stiffness::{
    FIELD, FieldPoint, Flanks, GearComparison, PathComparison, PathPoint, Point,
};

/// The compliance um mm/N in m²/N.
const MICRON_MILLIMETRE: f64 = 1e-9;
const MILLIMETRE: f64 = 1e-3;

/// A comparison and its case.
#[derive(Debug, Clone, Copy)]
pub struct StiffnessReport<'a> {
    /// The compliances over the flanks.
    pub flanks: &'a Flanks,
    /// The stiffness over the path of contact.
    pub path: &'a PathComparison,
}

impl Results for StiffnessReport<'_> {
    fn lines(&self, case: Named) -> Vec<String> {
        let StiffnessReport { flanks, path } = *self;
        let mut lines = case.headings("stiffness models against finite elements");
        let gears = flanks.gears.iter().map(|gear| gear_section(flanks, gear));
        let paths = [("one pair", PAIR), ("all pairs in contact", MESH)].map(|(pairs, of)| {
            let title = format!("Stiffness of {pairs} over the path of contact, in N/(um mm):");
            Table { title, ..path_table(path, of) }.lines()
        });
        for section in [legend(flanks)].into_iter().chain(gears).chain(paths) {
            lines.push(String::new());
            lines.extend(section);
        }
        lines
    }

    fn json(&self) -> Json {
        let StiffnessReport { flanks, path } = *self;
        let gear = |gear: &GearComparison| {
            let gaps = gear.gaps.iter().map(|gap| (key(gap.model.name()), json!(gap.reason)));
            let points = flank_table(flanks, std::slice::from_ref(gear));
            json!({
                "gear": gear.gear,
                "form_radius": gear.form_radius,
                "tip_radius": gear.tip_radius,
                "twist": gear.twist,
                "refusal": reason(gear),
                "gaps": (!gear.gaps.is_empty()).then(|| sorted(gaps)),
                "points": objects(&points, &["gear", "contact_half_width"]),
            })
        };
        let [pairs, meshes] = [PAIR, MESH].map(|of| objects(&path_table(path, of), &["way"]));
        let place = |(point, (pair, mesh)): (&PathPoint, (Json, Json))| json!({"way": point.way, "pair_stiffness": pair, "mesh_stiffness": mesh});
        let places = path.points.iter().zip(pairs.into_iter().zip(meshes)).map(place);
        json!({
            "contact_half_width": flanks.contact_half_width,
            "gears": flanks.gears.iter().map(gear).collect::<Json>(),
            "path": places.collect::<Json>(),
        })
    }

    /// One row per gear and radius; an absent value is an empty cell.
    fn table(&self) -> Table {
        flank_table(self.flanks, &self.flanks.gears)
    }
}

fn legend(flanks: &Flanks) -> Vec<String> {
    let names: Vec<_> = flanks.models.iter().map(|model| model.name()).collect();
    let names = names.join(", ");
    let half_width = significant(flanks.contact_half_width / MILLIMETRE, 4);
    let notes = [
        "Compliances in um mm/N, per unit face width.",
        &format!("{names}: tooth without contact; in brackets the difference from FE."),
        "FE: finite elements (plane strain, whole gear), without contact. FE, surface, \
         neighbour and the beam leave out the twist of the body.",
        &format!(
            "surface: FE with a contact of half-width {half_width} mm (Hertz, mesh force at the \
             pitch point)."
        ),
        "neighbour: displacement of the next tooth at the same radius; by reciprocity the same \
         ahead and behind.",
    ];
    notes.iter().flat_map(|note| item("", note)).collect()
}

fn gear_section(flanks: &Flanks, gear: &GearComparison) -> Vec<String> {
    let [form, tip] =
        [gear.form_radius, gear.tip_radius].map(|metres| significant(metres / MILLIMETRE, 6));
    let mut lines =
        vec![format!("{}: z {}, form circle {form} mm, tip {tip} mm", gear.gear, gear.teeth)];
    if !gear.points.is_empty() {
        let table = flank_table(flanks, std::slice::from_ref(gear));
        let has_title = |at: &usize| !table.columns[*at].title.is_empty();
        let columns: Vec<usize> = (0..table.columns.len()).filter(has_title).collect();
        lines.extend(table.of(&columns).lines());
    }
    lines.extend(remarks(gear).iter().flat_map(|remark| item("  - ", remark)));
    lines
}

type Compliance = fn(&FieldPoint) -> f64;

/// The compliances of the finite elements: name, title and width in text, value.
const FIELDS: [(&str, &str, usize, Compliance); 4] = [
    (FIELD, "FE", 10, |field| field.depth),
    ("finite-element-surface", "surface", 10, |field| field.surface),
    ("neighbour-ahead", "neighbour", 11, |field| field.ahead),
    ("neighbour-behind", "", 0, |field| field.behind),
];

fn key(name: &str) -> String {
    name.replace('-', "_")
}

/// One row per gear and radius. Text shows the columns with a title.
fn flank_table(flanks: &Flanks, gears: &[GearComparison]) -> Table {
    let compliance = |name: &str, title: &'static str| Column {
        title: title.into(),
        ..Column::si(key(name), "m2/N")
    };
    let radius = Column::number("radius", "r [mm]", "m", ("mm", 6)).wide(0, 8);
    let mut columns = vec![Column::text("gear", ""), radius];
    let models = flanks.models.iter();
    columns.extend(models.map(|model| compliance(model.name(), model.name()).wide(1, 16)));
    let after_depth = columns.len() + 1;
    columns.extend(FIELDS.map(|(name, title, least, _)| compliance(name, title).wide(0, least)));
    columns.insert(after_depth, Column::si("contact_half_width", "m"));
    let row = |gear: &GearComparison, point: &Point| {
        let shown = |value: Option<f64>, reference| {
            cell(value, |value| value / MICRON_MILLIMETRE, reference)
        };
        let depth = point.field.map(|field| field.depth);
        let mut cells = vec![gear.gear.into(), Cell::Number(point.radius)];
        cells.extend(point.models.iter().map(|&value| shown(value, depth)));
        cells.extend(FIELDS.map(|(.., of)| shown(point.field.as_ref().map(of), None)));
        cells.insert(after_depth, Cell::Number(flanks.contact_half_width));
        cells
    };
    let rows = gears.iter();
    let rows = rows.flat_map(|gear| gear.points.iter().map(move |point| row(gear, point)));
    Table::new("", columns).with(rows)
}

type Stiffnesses = fn(&PathPoint) -> &[Option<f64>];
const PAIR: Stiffnesses = |point| &point.pair;
const MESH: Stiffnesses = |point| &point.mesh;

/// Stiffness over the path of contact.
fn path_table(path: &PathComparison, of: Stiffnesses) -> Table {
    let field = path.models.iter().position(|model| model.name() == FIELD);
    let model = |model: &ToothCompliance| {
        let title = model.name().into();
        Column { title, ..Column::si(key(model.name()), "N/m2") }.wide(1, 16)
    };
    let place = Column::number("way", "s [mm]", "m", ("mm", 4)).wide(0, 8);
    let row = |point: &PathPoint| {
        let reference = field.and_then(|field| of(point)[field]);
        let cells = of(point).iter().enumerate().map(|(model, &value)| {
            let other = reference.filter(|_| Some(model) != field);
            cell(value, |value| value * MICRON_MILLIMETRE, other)
        });
        std::iter::once(Cell::Number(point.way)).chain(cells).collect()
    };
    let columns = std::iter::once(place).chain(path.models.iter().map(model));
    Table::new("", columns.collect()).with(path.points.iter().map(row))
}

/// A value with its difference from a reference in brackets, as a factor if the percentage is too
/// wide.
fn cell(value: Option<f64>, in_unit: fn(f64) -> f64, reference: Option<f64>) -> Cell {
    const LARGEST: f64 = 999.0;
    let Some(value) = value else { return Cell::None("-".into()) };
    let difference = reference.map_or_else(String::new, |reference| {
        let (factor, percent) = (value / reference, 100.0 * (value / reference - 1.0));
        if percent > LARGEST { format!(" ({factor:.0} x)") } else { format!(" ({percent:+.0} %)") }
    });
    Cell::Shown(value, significant(in_unit(value), 4) + &difference)
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

/// The rows as objects with their members in the order of their names, without some columns.
fn objects(table: &Table, without: &[&str]) -> Vec<Json> {
    let key = |at: usize| table.columns[at].key.as_ref();
    let mut columns: Vec<usize> =
        (0..table.columns.len()).filter(|&at| !without.contains(&key(at))).collect();
    columns.sort_by_key(|&at| key(at));
    table.of(&columns).objects()
}
