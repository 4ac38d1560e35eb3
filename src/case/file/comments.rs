//! Removes comments from a case file for a report.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::case::sanitize::sanitize;

/// The file without comment lines, empty lines, and headers of empty tables. Keeps all lines of a
/// multi-line string.
#[must_use]
pub fn without_comments(text: &str) -> String {
    let strings = strings(text);
    let mut kept: Vec<(String, bool)> = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let is_inside = strings.iter().any(|span| span.start < start && start < span.end);
        let trimmed = line.trim();
        if is_inside || !(trimmed.is_empty() || trimmed.starts_with('#')) {
            let is_header = !is_inside && line.starts_with('[');
            kept.push((sanitize(line.trim_end_matches(['\n', '\r'])), is_header));
        }
        start += line.len();
    }
    let has_lines = |at: usize| kept.get(at + 1).is_some_and(|(_, is_header)| !is_header);
    let said = (0..kept.len()).filter(|&at| !kept[at].1 || has_lines(at));
    let lines: Vec<&str> = said.map(|at| kept[at].0.as_str()).collect();
    lines.join("\n")
}

/// The places of the multi-line strings.
fn strings(text: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let (table, _) = DeTable::parse_recoverable(text);
    for value in table.get_ref().values() {
        add(value.get_ref(), value.span(), text, &mut found);
    }
    found
}

fn add(value: &DeValue, span: Range<usize>, text: &str, found: &mut Vec<Range<usize>>) {
    match value {
        DeValue::Table(table) => {
            for value in table.values() {
                add(value.get_ref(), value.span(), text, found);
            }
        }
        DeValue::Array(values) => {
            for value in values {
                add(value.get_ref(), value.span(), text, found);
            }
        }
        DeValue::String(_) if text.get(span.clone()).is_some_and(|own| own.contains('\n')) => {
            found.push(span);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_removed_and_multi_line_strings_are_kept() {
        let text = "# a\nformat = 1\nnotes = \"\"\"one\n# two\n\n[three]\n\"\"\"\n\n[pair]\n# m\n\
                    [driver]\r\nteeth = 20 # z1\n[driven]\n";
        assert_eq!(
            without_comments(text),
            "format = 1\nnotes = \"\"\"one\n# two\n\n[three]\n\"\"\"\n[driver]\nteeth = 20 # z1"
        );
    }
}
