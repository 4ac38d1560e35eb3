//! How a field is written and within what: the words that messages, templates and help show.

use super::{Absent, Field, Kind};

impl Field {
    /// A text that the field takes, to show how one is written.
    #[must_use]
    pub fn example(&self) -> &'static str {
        match (self.absent, self.kind) {
            (Absent::Default(text), _) if !text.is_empty() => text,
            (_, Kind::Choice(names, _)) => names.first().copied().unwrap_or_default(),
            _ => EXAMPLES.iter().find(|(name, _)| *name == self.name()).map_or("a few words", |(_, text)| text),
        }
    }

    /// The least and the greatest value as a person reads them; empty for words and choices.
    #[must_use]
    pub fn range_text(&self) -> String {
        match self.kind {
            Kind::Count(from, to, _) => format!("{from} to {to}"),
            Kind::Number(_, range, _) if range.unit.is_empty() => format!("{} to {}", range.from, range.to),
            Kind::Number(_, range, _) => format!("{} to {} {}", range.from, range.to, range.unit),
            Kind::Text => String::new(),
            Kind::Choice(names, _) => names.join(", "),
        }
    }
}

/// Values of fields that have no default, by the name within the table: Table 1 of the paper where it has one.
const EXAMPLES: [(&str, &str); 11] = [
    ("module", "5 mm"),
    ("centre_distance", "100 mm"),
    ("teeth", "20"),
    ("face_width", "8 mm"),
    ("tip_relief_length", "1 mm"),
    ("tip_radius", "0.2 mm"),
    ("power", "15 kW"),
    ("torque", "71.6 N m"),
    ("speed", "2000 rpm"),
    ("friction_coefficient", "0.06"),
    ("deflection", "24.7 um"),
];
