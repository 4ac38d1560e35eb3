//! Distributions of fields around their values, for tolerances.

use super::Problem;
use super::fields::{FIELDS, Field, Kind, index_of};
use super::sanitize::{quoted, suggestion};
use super::units::Dimension;
use super::{check, units};
use crate::model::deviation::TOLERANCE_CLASSES;

/// The shape of a distribution around the value of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Gaussian. The width is the standard deviation.
    Normal,
    /// Uniform. The width is half the span.
    Uniform,
    /// Triangular around the value. The width is half the span.
    Triangular,
    /// Gaussian, truncated at three standard deviations. The width is half the span.
    Truncated,
    /// The base pitch deviation of a flank tolerance class of ISO 1328-1, with the truncated
    /// distribution. The width is the class.
    Grade,
}

impl Shape {
    /// Every shape.
    pub const ALL: [Shape; 5] =
        [Shape::Normal, Shape::Uniform, Shape::Triangular, Shape::Truncated, Shape::Grade];

    /// The name in a case file.
    pub fn name(self) -> &'static str {
        ["normal", "uniform", "triangular", "truncated", "grade"][self as usize]
    }
}

/// A distribution of a field around its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// The field's key.
    pub field: &'static str,
    /// Shape and width as the user wrote them, such as "normal 4 um".
    pub text: String,
    /// Its shape.
    pub shape: Shape,
    /// Its width in SI, or the flank tolerance class; 0 while the text in a form is invalid.
    pub width: f64,
}

impl Spread {
    /// A distribution from the field's key and the shape's name with the width.
    ///
    /// # Errors
    /// If the field cannot have a distribution, the shape is unknown, or the width is not a value
    /// of the field's dimension.
    pub fn new(key: &str, text: &str) -> Result<Spread, Problem> {
        let (shape, width) = parts(text);
        Spread::read(key, Some(shape), Some(width)).map_err(|mut problems| problems.swap_remove(0))
    }

    /// The same with every problem, of which there is one at least. An entry of a file may lack one
    /// shape or one width.
    pub(super) fn read(
        key: &str,
        shape: Option<&str>,
        written: Option<&str>,
    ) -> Result<Spread, Vec<Problem>> {
        let at = |problem: Problem| problem.at(&place(key));
        let (field, dimension) = spreadable(key).map_err(|problem| vec![at(problem)])?;
        let name = shape.unwrap_or(Shape::Normal.name());
        let known = named(name);
        let width = match (&known, written) {
            (Ok(known), None) => Err(malformed(shape.and(Some(*known)), field)),
            (Ok(Shape::Grade), Some(text)) => grade(field, text),
            // The shape may be meant as a grade.
            (Err(_), text) if text.is_none_or(|text| text.trim().parse::<f64>().is_ok()) => Ok(0.0),
            (_, text) => width(dimension, field, text.unwrap_or_default()),
        };
        match (known, width) {
            (Ok(shape), Ok(width)) => {
                let text = format!("{name} {}", written.unwrap_or_default());
                Ok(Spread { field: field.key, text, shape, width })
            }
            (known, width) => Err(known.err().into_iter().chain(width.err()).map(at).collect()),
        }
    }

    /// The width as the user wrote it.
    pub fn written_width(&self) -> &str {
        parts(&self.text).1
    }
}

/// The problem of an entry without exactly one shape, or without one width.
fn malformed(shape: Option<Shape>, field: &Field) -> Problem {
    let others = if shape.is_some() {
        ""
    } else {
        ", or uniform, triangular or truncated in place of normal"
    };
    let fix = format!("write {}{others}", by_example(shape.unwrap_or(Shape::Normal), field));
    Problem::new("", "this is not a distribution", fix)
}

/// The name of the shape and the width in the text of a distribution.
pub(crate) fn parts(text: &str) -> (&str, &str) {
    text.split_once(' ').unwrap_or((text, ""))
}

/// A field that can have a distribution, and its dimension.
fn spreadable(key: &str) -> Result<(&'static Field, Dimension), Problem> {
    let field = index_of(key).ok_or_else(|| check::unknown_key(key))?;
    let field = &FIELDS[field];
    let (cause, fix) = match field.kind {
        Kind::Number(dimension, ..) => return Ok((field, dimension)),
        Kind::Count(..) => (
            format!("{key} is a whole number and has no distribution"),
            format!("remove the line; `tipstrike sweep --vary '{key}=FROM..TO'` varies {key}"),
        ),
        Kind::Text | Kind::Choice(..) | Kind::List(_) => {
            (format!("{key} is not a number and has no distribution"), "remove the line".to_owned())
        }
    };
    Err(Problem::new("", cause, fix))
}

/// An example of a distribution of a field.
fn by_example(shape: Shape, field: &Field) -> String {
    let width = match (shape, field.usual_unit()) {
        (Shape::Grade, _) => "7".to_owned(),
        (_, "") => "0.01".to_owned(),
        (_, unit) => format!("\"1 {unit}\""),
    };
    format!("{{ {} = {width} }}", shape.name())
}

fn width(dimension: Dimension, field: &Field, text: &str) -> Result<f64, Problem> {
    let width = units::parse(text, dimension, field.usual_unit())?;
    if width > 0.0 {
        return Ok(width);
    }
    let cause = format!("the width {} is not above 0", quoted(text));
    Err(Problem::new("", cause, "write a width above 0, or remove the distribution"))
}

/// The flank tolerance class, for a base pitch deviation only.
fn grade(field: &Field, text: &str) -> Result<f64, Problem> {
    if field.name() != "base_pitch" {
        return Err(Problem::new(
            "",
            format!("a grade gives a base pitch deviation, and {} is not one", field.key),
            "use normal, uniform, triangular or truncated",
        ));
    }
    let class = text.trim().parse().ok();
    class.filter(|class| TOLERANCE_CLASSES.contains(class)).map(f64::from).ok_or_else(|| {
        let (from, to) = (TOLERANCE_CLASSES.start(), TOLERANCE_CLASSES.end());
        Problem::new(
            "",
            format!("{} is no flank tolerance class", quoted(text)),
            format!("write a whole number from {from} to {to}"),
        )
    })
}

/// How the keys of distributions begin.
pub(super) const PREFIX: &str = "spread.";

/// The key of a distribution in messages.
pub(super) fn place(key: &str) -> String {
    format!("{PREFIX}\"{key}\"")
}

pub(super) fn named(name: &str) -> Result<Shape, Problem> {
    Shape::ALL.into_iter().find(|shape| shape.name() == name).ok_or_else(|| {
        let known = Shape::ALL.into_iter().map(Shape::name);
        let all: Vec<&str> = known.clone().collect();
        let fix = suggestion(name, known, || format!("use one of {}", all.join(", ")));
        Problem::new("", format!("unknown distribution {}", quoted(name)), fix)
    })
}
