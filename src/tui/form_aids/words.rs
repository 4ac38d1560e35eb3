//! Problems as the form shows them: labels instead of keys, values without quotes, no advice to add
//! a line to a file.

use std::sync::LazyLock;

use crate::case::fields::{FIELDS, Field, index_of};
use crate::case::{Fix, Problem};
use crate::model::QUANTITIES;

/// Prefix of the key of a limit, such as `limits.impact_force`.
const LIMITS: &str = "limits.";

/// Quotes: a file needs them around a value, and a message has them around typed text.
const MARKS: [char; 2] = ['"', TYPED];

/// The quote around typed text.
const TYPED: char = '`';

/// Every key inside a table, the longest first, so that no key matches the start of another.
static KEYS: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let mut keys: Vec<&'static str> =
        FIELDS.iter().map(|field| field.key).filter(|key| key.contains('.')).collect();
    keys.sort_by_key(|key| std::cmp::Reverse(key.len()));
    keys
});

impl Problem {
    /// The problem as the form shows it, where field and text are visible: `write 5 mm` for `write
    /// "5 mm"`, a label for a key. Files keep the original.
    #[must_use]
    pub(crate) fn for_form(&self) -> Problem {
        let fix = match &self.fix {
            Fix::Assign { example, .. } => {
                format!("write {example}, for example").replace(MARKS, "")
            }
            Fix::Text(fix) => for_form(fix),
        };
        Problem {
            code: self.code.clone(),
            ..Problem::new(&called(&self.field), for_form(&self.cause), fix)
        }
    }
}

/// A sentence for a file or a command line, reworded for the form.
#[must_use]
fn for_form(sentence: &str) -> String {
    if !sentence.contains('.') {
        return sentence.replace(MARKS, "");
    }
    // A key inside typed text, between two quotes, does not change.
    let parts = sentence.split(TYPED).enumerate().map(|(at, part)| {
        let part = part.to_owned();
        if at % 2 == 1 { part } else { with_labels(part) }
    });
    parts.collect::<String>().replace(MARKS, "")
}

/// The name of the field of a key: `module`, `the driver's tip relief`, `limit of impact force`;
/// the key itself if it belongs to no field.
#[must_use]
fn called(key: &str) -> String {
    if let Some(field) = index_of(key) {
        return name(&FIELDS[field]);
    }
    let quantity = key
        .strip_prefix(LIMITS)
        .and_then(|key| QUANTITIES.iter().find(|quantity| quantity.key == key));
    quantity.map_or_else(
        || key.to_owned(),
        |quantity| format!("limit of {}", quantity.label.trim_start()),
    )
}

fn name(field: &Field) -> String {
    match field.table() {
        "driver" => format!("the driver's {}", field.label),
        "driven" => format!("the driven gear's {}", field.label),
        _ => field.label.to_owned(),
    }
}

fn with_labels(sentence: String) -> String {
    KEYS.iter().fold(sentence, |text, key| {
        if text.contains(key) { text.replace(key, &called(key)) } else { text }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::case::fields::Kind;

    fn said(key: &str, text: &str) -> String {
        let mut case = Case::table_1();
        let field = index_of(key).unwrap();
        case.write(field, text);
        let problem = case
            .inputs()
            .unwrap_err()
            .into_iter()
            .find(|problem| problem.field == key)
            .unwrap()
            .for_form();
        format!("{}: {}", problem.cause, problem.fix)
    }

    #[test]
    fn a_form_names_visible_labels_instead_of_keys() {
        for (key, text, sentence) in [
            (
                "pair.module",
                "",
                "neither module nor diametral pitch is given: write 5 mm, for example",
            ),
            ("driver.teeth", "", "a required value is missing: write 20, for example"),
            ("pair.module", "5", "5 has no unit, and a length needs one: write 5 mm"),
            (
                "pair.module",
                "60 mm",
                "60 mm is above the limit of 50 mm: write a value from 0.05 to 50 mm",
            ),
            ("operation.power", "", "neither power nor torque is given: write 15 kW, for example"),
            ("operation.torque", "70 N m", "power and torque are both given: remove one of them"),
            ("model.method", "exat", "unknown choice exat: did you mean exact?"),
            (
                "pair.module",
                "driver.teeth",
                "driver.teeth does not begin with a number: write a number and its unit, such as 20 mm",
            ),
        ] {
            assert_eq!(said(key, text), sentence);
        }
    }

    #[test]
    fn a_field_is_named_by_its_label_and_its_gear() {
        assert_eq!(called("pair.module"), "module");
        assert_eq!(called("driven.tip_relief_length"), "the driven gear's tip relief length");
        assert_eq!(called("limits.impact_force"), "limit of impact force");
        assert_eq!(called("pair.modul"), "pair.modul");
        assert_eq!(
            for_form("set model.tooth_compliance to beam, or leave it out"),
            "set tooth compliance to beam, or leave it out"
        );
    }

    #[test]
    fn no_message_of_a_form_refers_to_a_file() {
        let wrong = [
            "",
            "5",
            "x",
            "1e999 mm",
            "5 kg",
            "4,5 mm",
            "-1",
            "5 mm 5",
            "99999999 GPa",
            "nan",
            "−5 mm",
            "5 mmm",
        ];
        for (index, field) in
            FIELDS.iter().enumerate().filter(|(_, field)| !matches!(field.kind, Kind::Text))
        {
            for text in wrong {
                let mut case = Case::table_1();
                case.write(index, text);
                for problem in
                    case.inputs().err().into_iter().flatten().map(|problem| problem.for_form())
                {
                    let said = problem.to_string();
                    let key = FIELDS
                        .iter()
                        .find(|field| field.key.contains('.') && said.contains(field.key));
                    assert!(
                        key.is_none() && !said.contains(['"', '`', '[']) && !said.contains("add "),
                        "{} = {text}: {said}",
                        field.key
                    );
                }
            }
        }
    }

    #[test]
    fn a_file_is_described_as_before() {
        let mut case = Case::table_1();
        case.write(index_of("pair.module").unwrap(), "5");
        let problem = case.inputs().unwrap_err().remove(0);
        assert_eq!(
            (problem.field.as_str(), &*problem.fix.to_string()),
            ("pair.module", "write \"5 mm\"")
        );
    }
}
