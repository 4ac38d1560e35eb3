//! An explanation as lines of text, for a terminal of any width.

use super::derivation::{GLUE, How, Leaf, Work};
use super::effects::Effect;
use super::{Correction, Page};
use crate::case::sanitize::sanitize;
use crate::model::explanation::Finding;
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

/// The page as text, 80 columns wide.
#[must_use]
pub fn render(page: &Page, name: &str) -> String {
    let lines = lines(page, name, WIDTH);
    lines.iter().map(|line| line.text.trim_end().to_owned() + "\n").collect()
}

/// The page as lines of at most `width` columns; `name` is the name of the case.
#[must_use]
pub fn lines(page: &Page, name: &str, width: usize) -> Vec<Line> {
    let mut out = Writer { width: width.max(20), lines: Vec::new() };
    out.head(page, name);
    out.section("Formula", |out| page.derivation.iter().for_each(|work| out.worked(work)));
    out.section("Values used", |out| out.leaves(&page.leaves));
    out.section("Source", |out| out.paragraph(page.source, 2));
    out.section("Corrections to the paper", |out| out.corrections(&page.corrections));
    out.section("Validity", |out| out.validity(page));
    out.section("Accuracy", |out| page.accuracy.iter().for_each(|line| out.paragraph(line, 2)));
    out.section("Sensitivity", |out| out.effects(&page.effects));
    out.lines
}

/// The lines of a page so far.
struct Writer {
    width: usize,
    lines: Vec<Line>,
}

impl Writer {
    fn push(&mut self, kind: Kind, text: impl Into<String>) {
        self.lines.push(Line { kind, text: text.into() });
    }

    /// Adds words wrapped into lines: the first starts with `lead`, the others with `more`.
    fn block(&mut self, kind: Kind, text: &str, lead: &str, more: &str) {
        let room = self.width.saturating_sub(count(lead).max(count(more))).max(8);
        let rows = flow(text.split(' ').filter(|word| !word.is_empty()), room);
        for (at, row) in rows.iter().enumerate() {
            let start = if at == 0 { lead } else { more };
            self.push(kind, start.to_owned() + &row.replace(GLUE, " "));
        }
    }

    fn paragraph(&mut self, text: &str, indent: usize) {
        let lead = " ".repeat(indent);
        self.block(Kind::Text, text, &lead, &lead);
    }

    /// Adds a heading before the lines of a section, unless there are none.
    fn section(&mut self, title: &str, write: impl FnOnce(&mut Writer)) {
        let start = self.lines.len();
        write(self);
        if self.lines.len() > start {
            let head = [(Kind::Text, ""), (Kind::Heading, title)];
            let head = head.map(|(kind, text)| Line { kind, text: text.to_owned() });
            self.lines.splice(start..start, head);
        }
    }

    fn head(&mut self, page: &Page, name: &str) {
        let quantity = page.quantity;
        let (comma, equals) = if page.symbol.is_empty() { ("", "") } else { (", ", " = ") };
        let title = format!("{}{comma}{} ({})", page.label, page.symbol, quantity.equation);
        let value = match (&page.shown, &page.missing) {
            (Some(shown), _) => format!("{}{equals}{shown}", page.symbol),
            (None, reason) => reason.clone().unwrap_or_default(),
        };
        let by = if page.is_by_auto { ", chosen by auto" } else { "" };
        let of = format!("{} · {} · method {}{by}", quantity.key, sanitize(name), page.method);
        self.block(Kind::Title, &title, "", "");
        self.block(Kind::Title, &value, "", "  ");
        self.block(Kind::Text, &of, "", "");
        self.push(Kind::Text, "");
        self.paragraph(&page.meaning, 0);
        if let Some(beside) = &page.beside {
            self.paragraph(beside, 0);
        }
    }

    /// Adds a value, its formula and its numbers.
    fn worked(&mut self, work: &Work) {
        let Work { symbol, meaning, formula, how, .. } = work;
        let sign = match how {
            How::Equals => " = ",
            How::Solves => " from ",
            How::Described => ": ",
        };
        let (lead, deep) = (format!("  {symbol}{sign}"), " ".repeat(count(symbol) + 3));
        let more = format!("{deep}  ");
        if *how == How::Described && !meaning.is_empty() {
            self.block(Kind::Formula, &format!("{meaning}; {formula}"), &lead, &more);
        } else {
            self.block(Kind::Formula, formula, &lead, &more);
            self.meaning(meaning, &more);
        }
        let shown = work.shown.as_ref().map(|shown| shown.to_string().replace(' ', GLUE));
        let numbers = work.numbers.clone().filter(|numbers| Some(numbers) != shown.as_ref());
        let parts: Vec<String> = numbers.into_iter().chain(shown).collect();
        let parts = parts.join(&format!(" ={GLUE}"));
        self.block(Kind::Numbers, &parts, &format!("{deep}= "), &more);
        self.block(Kind::Text, work.residual.as_deref().unwrap_or_default(), &more, &more);
    }

    /// Adds the meaning of a step to the right of its formula, or below it if it does not fit.
    fn meaning(&mut self, meaning: &str, more: &str) {
        const COLUMN: usize = 38;
        let room = self.lines.last().map_or(0, |line| count(&line.text) + 2).max(COLUMN);
        match self.lines.last_mut() {
            _ if meaning.is_empty() => {}
            Some(line) if line.kind == Kind::Formula && room + count(meaning) <= self.width => {
                line.text = format!("{:room$}{meaning}", line.text);
            }
            _ => self.block(Kind::Text, meaning, more, more),
        }
    }

    fn leaves(&mut self, leaves: &[Leaf]) {
        let columns = ["symbol", "value", "meaning"].map(|key| Column::text(key, "").wide(2, 0));
        let rows = leaves.iter().map(|leaf| {
            let meaning = format!("{} ({})", leaf.meaning, leaf.key);
            vec![leaf.symbol.into(), leaf.shown.as_str().into(), meaning.into()]
        });
        let table = Table::new("", columns.to_vec()).with(rows);
        table.wrapped(self.width).into_iter().for_each(|line| self.push(Kind::Text, line));
    }

    fn corrections(&mut self, corrections: &[&Correction]) {
        if corrections.is_empty() {
            self.paragraph("None.", 2);
        }
        for Correction { equation, error, used } in corrections {
            let text = format!("{equation}: {error}. Used: {used}.");
            self.block(Kind::Text, &text, "  ", "    ");
        }
    }

    fn validity(&mut self, page: &Page) {
        self.paragraph(page.assumptions, 2);
        for Finding { range, here, inside } in &page.validity {
            let (kind, mark) =
                if *inside { (Kind::Text, "  ok   ") } else { (Kind::Outside, "  NOT  ") };
            self.block(kind, &format!("{range}. Here: {here}."), mark, "       ");
        }
    }

    fn effects(&mut self, effects: &[Effect]) {
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
        let fits = |lines: &Vec<String>| lines.iter().all(|line| count(line) <= self.width);
        let rows = [table.lines(), table.of(&[1, 2, 3, 4]).lines()].into_iter().find(fits);
        match rows {
            Some(rows) => rows.into_iter().for_each(|row| self.push(Kind::Text, row)),
            None => {
                for Effect { key, text, step, change, .. } in &acting {
                    self.paragraph(&format!("{key} = {text}: {step} gives {change}"), 2);
                }
            }
        }
        if !idle.is_empty() {
            let lead = if acting.is_empty() {
                "Fields read:"
            } else {
                "Other inputs (choices, defaults, or fields without effect in this case):"
            };
            let field =
                |effect: &&Effect| format!("{} = {}", effect.key, effect.text).replace(' ', GLUE);
            self.paragraph(lead, 2);
            self.paragraph(&idle.iter().map(field).collect::<Vec<_>>().join(", "), 4);
        }
    }
}
