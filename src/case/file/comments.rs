//! Removes comments from a case file for a report.

use super::layout::{Layout, Value};
use crate::case::sanitize::sanitize;

/// The file without comment lines, empty lines, and headers of empty tables. Keeps all lines of a
/// multi-line string.
#[must_use]
pub fn without_comments(text: &str) -> String {
    let layout = Layout::of(text).unwrap_or_default();
    let strings: Vec<_> = layout
        .values()
        .filter(|entry| matches!(entry.value, Value::String(_)))
        .map(|entry| entry.span.clone())
        .collect();
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
