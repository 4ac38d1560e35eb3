//! A comparison as text for a person, and as Markdown.

use std::io::{self, Write};

use super::{Column, Comparison, Group, NONE, REFUSED, Row};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::report::digest;
use crate::report::layout::{WIDTH, count, item, plain_markdown, widest};

impl Comparison {
    /// Writes the comparison as text, at most 80 columns wide.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, column) in self.columns.iter().enumerate() {
            for line in heading(at, column) {
                writeln!(out, "{line}")?;
            }
        }
        let groups: Vec<Group> = std::iter::once(self.inputs())
            .chain(self.groups())
            .filter(|group| !group.rows.is_empty())
            .collect();
        let layout = Layout::of(&groups, self.columns.len());
        let others: Vec<usize> = (1..self.columns.len()).collect();
        for others in others.chunks(layout.others.max(1)) {
            let is_refused = |at: &&usize| self.columns[**at].found.is_err();
            let inputs_alone = others.iter().filter(is_refused).count() == others.len();
            let shown = groups.iter().take(if inputs_alone { 1 } else { groups.len() });
            for group in shown {
                writeln!(out, "\n{}", layout.title(group, others))?;
                for row in &group.rows {
                    writeln!(out, "{}", layout.line(row, others).trim_end())?;
                }
            }
        }
        Ok(())
    }

    /// Writes the comparison as Markdown.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_markdown(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, column) in self.columns.iter().enumerate() {
            let (name, sentence) = (plain(&named(column)), plain(&described(column)));
            writeln!(out, "- **{}** {name} {sentence}", letter(at))?;
        }
        let all = std::iter::once(self.inputs()).chain(self.groups());
        for group in all.filter(|group| !group.rows.is_empty()) {
            writeln!(out, "\n{}", self.table(&group).join("\n"))?;
        }
        Ok(())
    }

    fn table(&self, group: &Group) -> Vec<String> {
        let others = (1..self.columns.len()).map(letter);
        let others: Vec<String> =
            others.map(|letter| format!(" {letter} | {letter} - A |")).collect();
        let head = format!("| {} | | A |{}", group.title, others.concat());
        let rule = format!("|---|---|--:|{}", "--:|--:|".repeat(others.len()));
        let cells = |row: &Row| {
            let values = row.values.iter().zip(&row.differences).enumerate();
            let cell = |(at, (value, difference)): (usize, (&String, &String))| {
                let value = plain(&with_unit(value, row.unit));
                if at == 0 {
                    format!(" {value} |")
                } else {
                    format!(" {value} | {} |", plain(difference))
                }
            };
            values.map(cell).collect::<String>()
        };
        let line = |row: &Row| {
            let (label, symbol) = (plain(&row.label), plain(&row.symbol));
            format!("| {label} | {symbol} |{}", cells(row))
        };
        let rows = group.rows.iter().map(line);
        [head, rule].into_iter().chain(rows).collect()
    }
}

/// The column's letter, name, method and outcome.
fn heading(at: usize, column: &Column) -> Vec<String> {
    let mut lines = item(&format!("{}  ", letter(at)), &sanitize(&named(column)));
    lines.extend(item("   ", &sanitize(&described(column))));
    lines
}

/// The name of a column with its method.
fn named(column: &Column) -> String {
    let method = column.solution().map(|solution| solution.method.name());
    let method = method.map_or_else(String::new, |method| format!(" ({method})"));
    format!("{}{method}", column.name)
}

/// The outcome, or the reason for its absence.
fn described(column: &Column) -> String {
    match &column.found {
        Ok(report) => digest::sentence(&report.solution, System::Metric),
        Err(refused) => {
            let problems = refused.iter().map(|refused| refused.problem.to_string());
            format!("Refused: {}.", problems.collect::<Vec<_>>().join("; "))
        }
    }
}

fn with_unit(value: &str, unit: &str) -> String {
    if unit.is_empty() || [NONE, REFUSED].contains(&value) {
        value.to_owned()
    } else {
        format!("{value} {unit}")
    }
}

fn plain(text: &str) -> String {
    plain_markdown(&sanitize(text))
}

/// A to Z, then AA and so on.
fn letter(at: usize) -> String {
    let last = char::from(b'A' + (at % 26) as u8);
    match at / 26 {
        0 => last.to_string(),
        more => letter(more - 1) + &last.to_string(),
    }
}

/// Widths of the columns, and the number of columns beside the reference.
struct Layout {
    symbol: usize,
    /// 0 if labels do not fit.
    label: usize,
    value: usize,
    difference: usize,
    unit: usize,
    others: usize,
}

impl Layout {
    fn of(groups: &[Group], columns: usize) -> Layout {
        let rows = || groups.iter().flat_map(|group| &group.rows);
        let most = |of: &dyn Fn(&Row) -> usize| rows().map(of).max().unwrap_or(0);
        let wide = Layout {
            symbol: 1 + most(&|row| count(&row.symbol)),
            label: 1 + most(&|row| count(&row.label)),
            value: 2 + most(&|row| widest(row.values.iter().map(String::as_str))).max(6),
            difference: 2 + most(&|row| widest(row.differences.iter().map(String::as_str))).max(5),
            unit: 1 + most(&|row| count(row.unit)),
            others: columns.saturating_sub(1),
        };
        let fitting = |label: usize| {
            let before = 2 + wide.symbol + label + wide.value + wide.unit;
            WIDTH.saturating_sub(before) / (wide.value + wide.difference)
        };
        if fitting(wide.label) >= wide.others {
            return wide;
        }
        let (with_labels, without) = (fitting(wide.label), fitting(0).max(1));
        // Labels are shown if there is room, or if they reduce the number of tables.
        let tables = |others: usize| wide.others.div_ceil(others.max(1));
        if with_labels == 0 || tables(without) < tables(with_labels) {
            return Layout {
                symbol: 1 + most(&|row| count(short_name(row))),
                label: 0,
                others: without,
                ..wide
            };
        }
        Layout { others: with_labels, ..wide }
    }

    fn title(&self, group: &Group, others: &[usize]) -> String {
        let names = 2 + self.symbol + self.label + self.unit;
        let of = |&at: &usize| {
            let letter = letter(at);
            let against = format!("{letter} - A");
            format!("{letter:>0$}{against:>1$}", self.value, self.difference)
        };
        let others: String = others.iter().map(of).collect();
        let cells = format!("{:>1$}{others}", "A", self.value);
        // A long title is not cut; the letters move to the right.
        let title = &group.title;
        if count(title) < names + self.value - 1 {
            let room = names.saturating_sub(count(title));
            let blank = " ".repeat(room);
            let cut = count(title).saturating_sub(names);
            format!("{title}{blank}{}", &cells[cut..])
        } else {
            let blank = " ".repeat(names);
            format!("{title}\n{blank}{cells}")
        }
    }

    fn line(&self, row: &Row, others: &[usize]) -> String {
        let (symbol, label) = if self.label > 0 {
            (row.symbol.as_str(), row.label.as_str())
        } else {
            (short_name(row), "")
        };
        let (unit, base) = (row.unit, sanitize(&row.values[0]));
        let (first, second, third, fourth) = (self.symbol, self.label, self.unit, self.value);
        let head = format!("  {symbol:first$}{label:second$}{unit:third$}{base:>fourth$}");
        let cells = others.iter().map(|&at| {
            let (value, difference) = (sanitize(&row.values[at]), &row.differences[at]);
            format!("{value:>0$}{difference:>1$}", self.value, self.difference)
        });
        head + &cells.collect::<String>()
    }
}

/// The symbol of a row, or its label if it has none.
fn short_name(row: &Row) -> &str {
    if row.symbol.is_empty() { &row.label } else { &row.symbol }
}

#[cfg(test)]
mod tests {
    use super::letter;

    #[test]
    fn letters_go_on_behind_z() {
        let letters = [0, 25, 26, 27, 52].map(letter);
        assert_eq!(letters, ["A", "Z", "AA", "AB", "BA"]);
    }
}
