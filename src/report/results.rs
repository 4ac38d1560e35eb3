//! The results of a study of a case, which every format writes in the same way.

use std::io::{self, Write};

use super::json::{Json, json, write_line};
use super::layout::{WIDTH, flow};
use super::table::Table;
use crate::case::sanitize::sanitize;
use crate::study::shard::Format;

/// A case by its name, as the user gave it, and its title, empty without one.
#[derive(Debug, Clone, Copy)]
pub struct Named<'a> {
    /// The name.
    pub name: &'a str,
    /// The title.
    pub title: &'a str,
}

/// Results of a study.
pub trait Results {
    /// The results as text.
    fn lines(&self, case: Named) -> Vec<String>;

    /// The members of the JSON object after those of the case.
    fn json(&self) -> Json;

    /// The rows of CSV, if the results have this format.
    fn table(&self) -> Table {
        Table::default()
    }
}

impl Named<'_> {
    /// The title, or the name of a case without one.
    pub fn heading(&self) -> String {
        sanitize(if self.title.is_empty() { self.name } else { self.title })
    }

    /// The title and the name with the subject of the results, wrapped.
    pub fn headings(&self, subject: &str) -> Vec<String> {
        let title = if self.title.is_empty() { "Case without a title" } else { self.title };
        let name = format!("{} · {subject}", sanitize(self.name));
        let lines = [sanitize(title), name];
        lines.iter().flat_map(|line| flow(line.split_whitespace(), WIDTH)).collect()
    }

    /// Writes results in a format.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(
        self,
        results: &dyn Results,
        format: Format,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        match format {
            Format::Json => write_line(&self.json(results), out),
            Format::Csv => results.table().write_csv(out),
            _ => writeln!(out, "{}", results.lines(self).join("\n")),
        }
    }

    /// Results as one JSON object.
    pub fn json(self, results: &dyn Results) -> Json {
        let Named { name, title } = self;
        let version = env!("CARGO_PKG_VERSION");
        let mut line = json!({"case": name, "title": title, "version": version});
        if let (Json::Object(line), Json::Object(more)) = (&mut line, results.json()) {
            line.extend(more);
        }
        line
    }
}
