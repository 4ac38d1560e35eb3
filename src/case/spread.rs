//! How a field is spread around its value, for tolerances.

use super::Problem;
use super::fields::{FIELDS, Kind, index_of};
use super::sanitize::quoted;
use super::{check, suggest, units};

/// The note for a case with distributions, since no computation reads them.
pub const UNUSED: &str =
    "[spread] has no effect: this version computes no tolerances; saving keeps it in the file";

/// The shape of a distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Gaussian; the width is the standard deviation.
    Normal,
    /// Equally likely everywhere; the width is half the span.
    Uniform,
}

impl Shape {
    /// Every shape.
    pub const ALL: [Shape; 2] = [Shape::Normal, Shape::Uniform];

    /// The name in a case file.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Shape::Normal => "normal",
            Shape::Uniform => "uniform",
        }
    }
}

/// A distribution of a field around its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// The field's key.
    pub field: &'static str,
    /// Its shape.
    pub shape: Shape,
    /// Its width as the user wrote it.
    pub text: String,
    /// Its width in SI.
    pub width: f64,
}

impl Spread {
    /// A distribution from the field's key, the shape's name and the width as written.
    ///
    /// # Errors
    /// Where the field cannot be spread, the shape is unknown or the width is no value of the
    /// field's dimension.
    pub fn new(key: &str, shape: &str, text: &str) -> Result<Spread, Problem> {
        let place = place(key);
        let Some(field) = index_of(key).map(|index| &FIELDS[index]) else {
            return Err(Problem {
                field: place,
                ..check::unknown_key(key)
            });
        };
        let Kind::Number(dimension, ..) = field.kind else {
            return Err(Problem::new(
                &place,
                format!("{key} cannot be spread"),
                "spread a field that is a measure",
            ));
        };
        let shape = named(&place, shape)?;
        let width = units::parse(text, dimension, field.usual_unit())
            .map_err(|misread| Problem::of(&place, misread))?;
        if width < 0.0 {
            return Err(Problem::new(
                &place,
                format!("the width {} is below 0", quoted(text)),
                "write a width of 0 or more",
            ));
        }
        Ok(Spread {
            field: field.key,
            shape,
            text: text.to_owned(),
            width,
        })
    }
}

/// The name under which problems of a field's spread stand.
pub(super) fn place(key: &str) -> String {
    format!("spread.\"{key}\"")
}

fn named(place: &str, name: &str) -> Result<Shape, Problem> {
    Shape::ALL
        .into_iter()
        .find(|shape| shape.name() == name)
        .ok_or_else(|| {
            let known = Shape::ALL.into_iter().map(Shape::name);
            let mend = suggest::mend(name, known, || "use normal or uniform".to_owned());
            Problem::new(
                place,
                format!("unknown distribution {}", quoted(name)),
                mend,
            )
        })
}
