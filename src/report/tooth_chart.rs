//! The chart of the tooth compliance over the flank of a gear: every model, and finite elements
//! without and with the contact.

use super::charts::pieces;
use super::stiffness::no_field;
use super::svg::{Chart, Kind, Labelled, Series, chart};
use crate::model::Inputs;
use crate::model::compliance::model_of;
use crate::model::inputs::ToothCompliance;
use crate::numeric::decimal::significant;
use crate::study::stiffness::{FIELD, FLANK_POINTS, Flanks, GearComparison, Point, compare_flanks};

/// The keys of the charts of the driver and of the driven gear.
pub const KEYS: [&str; 2] = ["tooth_compliance_driver", "tooth_compliance_driven"];

const MILLIMETRE: f64 = 1e-3;
/// The factor from um mm/N to m²/N.
const MICRON_MILLIMETRE: f64 = 1e-9;

/// Draws a gear of a pair, the driver if `gear` is 0.
///
/// # Errors
/// The reason why the gear has no chart.
pub fn picture(gear: usize, inputs: &Inputs) -> Result<String, String> {
    let found = compare_flanks(inputs, FLANK_POINTS);
    let flanks = found.map_err(|refusal| refusal.to_string())?;
    let drawn = tooth_chart(gear, &flanks, model_of(inputs));
    drawn.map_or_else(|| Err(absence(gear, &flanks)), |drawn| Ok(chart(&drawn)))
}

/// Why a gear has no chart.
#[must_use]
pub fn absence(gear: usize, flanks: &Flanks) -> String {
    match flanks.gears.get(gear) {
        Some(found) if found.points.is_empty() => {
            format!("the {} has no involute between form circle and tip", gear_name(gear))
        }
        _ => format!("no compliance model covers the {}", gear_name(gear)),
    }
}

/// The chart of a gear of a pair: first the finite elements, which the models are compared with. A
/// model without values has an empty curve. `None` if no model has a value.
#[must_use]
pub fn tooth_chart(gear: usize, flanks: &Flanks, own: ToothCompliance) -> Option<Chart> {
    let found = flanks.gears.get(gear)?;
    let half_width = significant(flanks.contact_half_width / MILLIMETRE, 3);
    let depth = |point: &Point| point.field.map(|field| field.depth);
    let surface = |point: &Point| point.field.map(|field| field.surface);
    let remark = no_field(found).unwrap_or_else(|| "without contact".to_owned());
    let field = named(FIELD, own.name() == FIELD, Some(remark));
    let contact = format!("surface, {FIELD} with contact of half-width {half_width} mm");
    let field = [series(found, field, depth), series(found, contact, surface)];
    let models = flanks.models.iter().enumerate().map(|(at, &model)| {
        let gap = found.gaps.iter().find(|gap| gap.model == model);
        let is_empty = found.points.iter().all(|point| point.models[at].is_none());
        let missing = if is_empty { "no value" } else { "gaps" };
        let remark = gap.map(|gap| format!("{missing}: {}", gap.reason));
        let name = named(model.name(), model == own, remark);
        series(found, name, move |point| point.models[at])
    });
    let series: Vec<Series> = field.into_iter().chain(models).collect();
    let has_points = series.iter().any(|series| !series.pieces.is_empty());
    has_points.then(|| Chart {
        title: format!("Tooth compliance of the {}", gear_name(gear)),
        across: Labelled::linear("radius, mm"),
        up: Labelled::linear("tooth compliance q, µm mm/N"),
        series,
        marks: vec![(found.pitch_radius / MILLIMETRE, "C")],
    })
}

/// The name of a gear in a sentence.
fn gear_name(gear: usize) -> &'static str {
    ["driver", "driven gear"][gear.min(1)]
}

/// The name of a curve: the model, whether the case uses it, and a remark.
fn named(model: &str, is_own: bool, remark: Option<String>) -> String {
    let case = if is_own { " (case)" } else { "" };
    let remark = remark.map_or_else(String::new, |remark| format!(", {remark}"));
    format!("{model}{case}{remark}")
}

fn series(gear: &GearComparison, name: String, value: impl Fn(&Point) -> Option<f64>) -> Series {
    let points = gear.points.iter().map(|point| {
        let value = value(point).map(|value| value / MICRON_MILLIMETRE);
        (point.radius / MILLIMETRE, value)
    });
    Series { name, pieces: pieces(points, f64::INFINITY), kind: Kind::Curve }
}
