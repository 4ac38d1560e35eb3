//! A page in Markdown, without charts.

use super::{Column, Page};
use crate::report::layout::plain_markdown as plain;

pub(super) fn render(page: &Page<'_>) -> String {
    let sections = [
        heading(page),
        verdicts(page),
        limits(page),
        inputs(page),
        results(page),
        studies(page),
        notes(page),
        files(page),
    ];
    let sections: Vec<String> = sections
        .into_iter()
        .filter(|lines| !lines.is_empty())
        .map(|lines| lines.join("\n"))
        .collect();
    sections.join("\n\n") + "\n"
}

fn heading(page: &Page<'_>) -> Vec<String> {
    vec![
        format!("# {}", plain(&page.title)),
        String::new(),
        format!("Corner contact of spur gear pairs, computed by tipstrike {}.", page.version),
    ]
}

fn verdicts(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Verdict".to_owned()];
    for column in &page.columns {
        if !page.is_single() {
            lines.extend([String::new(), format!("### {}", plain(&column.title))]);
        }
        for sentence in &column.verdict {
            lines.extend([String::new(), plain(sentence)]);
        }
        let notes = match column.notes_of_case.as_str() {
            "" => String::new(),
            notes => format!(". {}", plain(notes)),
        };
        let (name, method) = (plain(&column.name), column.method);
        lines.extend([String::new(), format!("{name}, method {method}{notes}")]);
    }
    lines
}

fn limits(page: &Page<'_>) -> Vec<String> {
    list(page, "## Limits", |column| {
        let lines = column.limits.iter();
        lines.map(|limit| format!("{}: {}", limit.word, limit.words)).collect()
    })
}

fn notes(page: &Page<'_>) -> Vec<String> {
    list(page, "## Notes", |column| column.notes.clone())
}

/// The lines of every case under a heading; empty without lines.
fn list(page: &Page<'_>, title: &str, of: impl Fn(&Column) -> Vec<String>) -> Vec<String> {
    let mut lines = Vec::new();
    for column in &page.columns {
        for line in of(column) {
            let whose = if page.is_single() {
                String::new()
            } else {
                format!("{}: ", plain(&column.title))
            };
            lines.push(format!("- {whose}{}", plain(&line)));
        }
    }
    if !lines.is_empty() {
        lines.splice(0..0, [title.to_owned(), String::new()]);
    }
    lines
}

fn inputs(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Inputs that differ from their defaults".to_owned(), String::new()];
    lines.extend(header(page, &["input", ""], &[]));
    for row in &page.inputs {
        let values = row.values.iter().map(|(text, _)| text.as_str());
        let cells = [row.label.as_str(), row.symbol].into_iter().chain(values);
        lines.push(table_row(cells));
    }
    lines
}

fn results(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Results".to_owned(), String::new()];
    lines.extend(header(page, &["quantity", ""], &["unit", "source"]));
    for row in page.tables.iter().flat_map(|table| &table.rows) {
        let values = row.values.iter().map(String::as_str);
        let cells = [row.label.trim(), row.symbol].into_iter().chain(values);
        lines.push(table_row(cells.chain([row.unit, row.source])));
    }
    lines
}

fn studies(page: &Page<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    for column in &page.columns {
        for study in &column.studies {
            let whose = if page.is_single() {
                String::new()
            } else {
                format!(" of {}", plain(&column.title))
            };
            let numbers = study.names.len().saturating_sub(3);
            lines.extend([String::new(), format!("### {}{whose}", plain(&study.title))]);
            lines.push(String::new());
            lines.push(table_row(study.names.iter().map(String::as_str)));
            lines.push(format!("|---|---|{}---|", "---:|".repeat(numbers)));
            let rows = study.rows.iter();
            lines.extend(rows.map(|row| table_row(row.iter().map(String::as_str))));
            let sentences = study.sentences.iter();
            lines.extend(sentences.flat_map(|one| [String::new(), plain(one)]));
        }
    }
    if !lines.is_empty() {
        lines.insert(0, "## Studies".to_owned());
    }
    lines
}

/// The header row with one column per case, and the separator row.
fn header(page: &Page<'_>, before: &[&str], after: &[&str]) -> [String; 2] {
    let titles = page.columns.iter().map(|column| column.title.as_str());
    let names = before.iter().copied().chain(titles);
    let left = |count: usize| "---|".repeat(count);
    [
        table_row(names.chain(after.iter().copied())),
        format!(
            "|{}{}{}",
            left(before.len()),
            "---:|".repeat(page.columns.len()),
            left(after.len())
        ),
    ]
}

fn table_row<'a>(cells: impl Iterator<Item = &'a str>) -> String {
    let cells: Vec<String> = cells.map(plain).collect();
    format!("| {} |", cells.join(" | "))
}

fn files(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Case files".to_owned()];
    for column in &page.columns {
        let fence = fence(&column.lines);
        lines.extend([
            String::new(),
            format!("{}, without comments:", plain(&column.name)),
            String::new(),
            format!("{fence}toml"),
            column.lines.clone(),
            fence,
        ]);
    }
    lines
}

/// A text in backticks, with more backticks than the text contains.
fn fence(text: &str) -> String {
    let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    "`".repeat(longest.max(2) + 1)
}
