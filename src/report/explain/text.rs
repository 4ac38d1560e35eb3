//! An explanation as lines of text, for a terminal of any width.

use super::derivation::{GLUE, How, Leaf, Work};
use super::effects::Effect;
use super::{Correction, Page};
use crate::case::sanitize::sanitize;
use crate::report::layout::{WIDTH, count, flow};
use crate::report::table::{Cell, Column, Table};

/// The kind of a line, which decides its style.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The quantity and its value.
    Title,
    /// The name of a section.
    Heading,
    /// A formula in symbols.
    Formula,
    /// A formula with numbers, or its result.
    Numbers,
    /// Sentences and tables.
    Text,
    /// A validity range that does not contain the case.
    Outside,
}

/// A line of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// The kind of the line.
    pub kind: Kind,
    /// The text of the line.
    pub text: String,
}

impl Line {
    fn new(kind: Kind, text: impl Into<String>) -> Line {
        Line { kind, text: text.into() }
    }
}

/// The page as text, 80 columns wide.
#[must_use]
pub fn render(page: &Page, name: &str) -> String {
    lines(page, name, WIDTH)
        .into_iter()
        .map(|line| line.text.trim_end().to_owned() + "\n")
        .collect()
}

/// The page as lines of at most `width` columns; `name` is the name of the case.
#[must_use]
pub fn lines(page: &Page, name: &str, width: usize) -> Vec<Line> {
    let width = width.max(20);
    let sections = [
        head(page, name, width),
        titled("Formula", page.derivation.iter().flat_map(|work| worked(work, width)).collect()),
        titled("Values used", leaves(&page.leaves, width)),
        titled("Source", paragraph(page.source, 2, width)),
        titled("Corrections to the paper", corrections(page, width)),
        titled("Validity", validity(page, width)),
        titled(
            "Accuracy",
            page.accuracy.iter().flat_map(|line| paragraph(line, 2, width)).collect(),
        ),
        titled("Sensitivity", effects(&page.effects, width)),
    ];
    let mut lines: Vec<Line> = Vec::new();
    for section in sections.into_iter().filter(|section| !section.is_empty()) {
        if !lines.is_empty() {
            lines.push(Line::new(Kind::Text, ""));
        }
        lines.extend(section);
    }
    lines
}

fn titled(title: &str, lines: Vec<Line>) -> Vec<Line> {
    let heading = (!lines.is_empty()).then(|| Line::new(Kind::Heading, title));
    heading.into_iter().chain(lines).collect()
}

fn head(page: &Page, name: &str, width: usize) -> Vec<Line> {
    let quantity = page.quantity;
    let value = match (&page.shown, &page.missing) {
        (Some(shown), _) if page.symbol.is_empty() => shown.to_string(),
        (Some(shown), _) => format!("{} = {shown}", page.symbol),
        (None, reason) => reason.clone().unwrap_or_default(),
    };
    let symbol = if page.symbol.is_empty() { String::new() } else { format!(", {}", page.symbol) };
    let title = format!("{}{symbol} ({})", page.label, quantity.equation);
    let by = if page.is_by_auto { ", chosen by auto" } else { "" };
    let of = format!("{} · {} · method {}{by}", quantity.key, sanitize(name), page.method);
    let mut lines = block(Kind::Title, &title, "", "", width);
    lines.extend(block(Kind::Title, &value, "", "  ", width));
    lines.extend(block(Kind::Text, &of, "", "", width));
    lines.push(Line::new(Kind::Text, ""));
    lines.extend(paragraph(&page.meaning, 0, width));
    lines.extend(page.beside.iter().flat_map(|beside| paragraph(beside, 0, width)));
    lines
}

/// A value, its formula and its numbers.
fn worked(work: &Work, width: usize) -> Vec<Line> {
    let (symbol, sign) = (work.symbol, sign(work.how));
    let lead = format!("  {symbol}{sign}");
    let deep = " ".repeat(count(symbol) + 3);
    let more = format!("{deep}  ");
    let mut lines = match work.how {
        How::Described if !work.meaning.is_empty() => block(
            Kind::Formula,
            &format!("{}; {}", work.meaning, work.formula),
            &lead,
            &more,
            width,
        ),
        _ => with_meaning(
            block(Kind::Formula, &work.formula, &lead, &more, width),
            work.meaning,
            &more,
            width,
        ),
    };
    let shown = work.shown.as_ref().map(|shown| shown.to_string().replace(' ', GLUE));
    let numbers = work.numbers.clone().filter(|numbers| Some(numbers) != shown.as_ref());
    let parts: Vec<String> = numbers.into_iter().chain(shown).collect();
    if !parts.is_empty() {
        lines.extend(block(
            Kind::Numbers,
            &parts.join(&format!(" ={GLUE}")),
            &format!("{deep}= "),
            &more,
            width,
        ));
    }
    lines.extend(
        work.residual.iter().flat_map(|residual| block(Kind::Text, residual, &more, &more, width)),
    );
    lines
}

fn sign(how: How) -> &'static str {
    match how {
        How::Equals => " = ",
        How::Solves => " from ",
        How::Described => ": ",
    }
}

/// Adds the meaning of a step to the right of its formula, or below it if it does not fit.
fn with_meaning(mut lines: Vec<Line>, meaning: &str, more: &str, width: usize) -> Vec<Line> {
    const COLUMN: usize = 38;
    let room = lines.last().map_or(0, |line| count(&line.text) + 2).max(COLUMN);
    match lines.last_mut() {
        _ if meaning.is_empty() => {}
        Some(line) if room + count(meaning) <= width => {
            line.text = format!("{:room$}{meaning}", line.text);
        }
        _ => lines.extend(block(Kind::Text, meaning, more, more, width)),
    }
    lines
}

fn leaves(leaves: &[Leaf], width: usize) -> Vec<Line> {
    let columns = [("symbol", 2), ("value", 2), ("meaning", 2)];
    let columns = columns.map(|(key, gap)| Column::text(key, "").wide(gap, 0)).to_vec();
    let rows = leaves.iter().map(|leaf| {
        let meaning = format!("{} ({})", leaf.meaning, leaf.key);
        vec![leaf.symbol.into(), leaf.shown.as_str().into(), meaning.into()]
    });
    let lines = Table::new("", columns).with(rows).wrapped(width);
    lines.into_iter().map(|line| Line::new(Kind::Text, line)).collect()
}

fn corrections(page: &Page, width: usize) -> Vec<Line> {
    let lines = |correction: &&Correction| {
        let Correction { equation, error, used } = correction;
        let text = format!("{equation}: {error}. Used: {used}.");
        block(Kind::Text, &text, "  ", "    ", width)
    };
    if page.corrections.is_empty() {
        return paragraph("None.", 2, width);
    }
    page.corrections.iter().flat_map(lines).collect()
}

fn validity(page: &Page, width: usize) -> Vec<Line> {
    let mut lines = paragraph(page.assumptions, 2, width);
    for finding in &page.validity {
        let (kind, mark) =
            if finding.inside { (Kind::Text, "  ok   ") } else { (Kind::Outside, "  NOT  ") };
        lines.extend(block(
            kind,
            &format!("{}. Here: {}.", finding.range, finding.here),
            mark,
            "       ",
            width,
        ));
    }
    lines
}

fn effects(effects: &[Effect], width: usize) -> Vec<Line> {
    let (acting, idle): (Vec<&Effect>, Vec<&Effect>) =
        effects.iter().partition(|effect| !effect.change.is_empty());
    let column = Column::text("", "").wide(2, 0);
    let number = column.clone().to_the_right();
    let columns = vec![column.clone(), column.clone(), column, number.clone(), number];
    let row = |effect: &&Effect| {
        let Effect { key, symbol, text, step, change } = effect;
        [symbol, key, text.as_str(), step, change].map(Cell::from).to_vec()
    };
    let table = Table::new("", columns).with(acting.iter().map(row));
    let fits = |lines: &Vec<String>| lines.iter().all(|line| count(line) <= width);
    let rows = Some(table.lines()).filter(fits);
    let rows = rows.or_else(|| Some(table.of(&[1, 2, 3, 4]).lines()).filter(fits));
    let mut lines: Vec<Line> = match rows {
        Some(rows) => rows.into_iter().map(|row| Line::new(Kind::Text, row)).collect(),
        None => acting
            .iter()
            .flat_map(|Effect { key, text, step, change, .. }| {
                paragraph(&format!("{key} = {text}: {step} gives {change}"), 2, width)
            })
            .collect(),
    };
    let field = |effect: &&Effect| format!("{} = {}", effect.key, effect.text).replace(' ', GLUE);
    if !idle.is_empty() {
        let lead = if lines.is_empty() {
            "Fields read:"
        } else {
            "Other inputs (choices, defaults, or fields without effect in this case):"
        };
        lines.extend(paragraph(lead, 2, width));
        lines.extend(paragraph(&idle.iter().map(field).collect::<Vec<_>>().join(", "), 4, width));
    }
    lines
}

fn paragraph(text: &str, indent: usize, width: usize) -> Vec<Line> {
    let lead = " ".repeat(indent);
    block(Kind::Text, text, &lead, &lead, width)
}

/// Wraps words into lines: the first starts with `lead`, the others with `more`.
fn block(kind: Kind, text: &str, lead: &str, more: &str, width: usize) -> Vec<Line> {
    let indent = count(lead).max(count(more));
    let rows =
        flow(text.split(' ').filter(|word| !word.is_empty()), width.saturating_sub(indent).max(8));
    let start = |index| if index == 0 { lead } else { more };
    rows.iter()
        .enumerate()
        .map(|(index, row)| Line::new(kind, format!("{}{}", start(index), row.replace(GLUE, " "))))
        .collect()
}
