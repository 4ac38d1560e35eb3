//! Shards: parts of a study in separate files, which `gather` combines.

mod complete;
mod lines;

use std::fmt::Write as _;
use std::hash::Hasher;
use std::io::{self, Write};

use siphasher::sip::SipHasher24;

use super::batch::{PointOutcome, Rows};
use super::request::Request;
use crate::case::Problem;
pub use complete::{Complete, ShardError, in_order};
use lines::{Footer, KIND, Reason};
pub use lines::{Header, Shard};

/// Writes a shard row by row.
pub struct ShardWriter<'a> {
    out: &'a mut dyn Write,
    hasher: SipHasher24,
    rows: usize,
}

impl<'a> ShardWriter<'a> {
    /// Writes the first line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn begin(
        shard: Shard,
        request: &Request,
        out: &'a mut dyn Write,
    ) -> io::Result<ShardWriter<'a>> {
        let header = Header {
            kind: KIND.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            shard,
            request: request.clone(),
        };
        let mut writer = ShardWriter { out, hasher: SipHasher24::new(), rows: 0 };
        writer.line(&(serde_json::to_string(&header)? + "\n"))?;
        Ok(writer)
    }

    /// Writes rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&mut self, rows: &Rows) -> io::Result<()> {
        for row in 0..rows.outcomes.len() {
            self.line(&line(rows, row)?)?;
            self.rows += 1;
        }
        Ok(())
    }

    fn line(&mut self, line: &str) -> io::Result<()> {
        self.hasher.write(line.as_bytes());
        self.out.write_all(line.as_bytes())
    }

    /// Writes the last line, without which the shard is incomplete.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn finish(self) -> io::Result<()> {
        let footer = Footer { rows: self.rows, hash: format!("{:016x}", self.hasher.finish()) };
        writeln!(self.out, "{}", serde_json::to_string(&footer)?)
    }
}

/// A row as a line: the index of its outcome in [`PointOutcome::ALL`], then its values or the
/// reason of its refusal.
fn line(rows: &Rows, row: usize) -> io::Result<String> {
    let outcome = rows.outcomes[row];
    let code = PointOutcome::ALL.iter().position(|known| *known == outcome);
    let mut line = code.unwrap_or_default().to_string();
    if let Some(Problem { field, cause, fix }) = rows.refusal(row) {
        let reason = Reason(field.clone(), cause.clone(), fix.clone());
        line.push(' ');
        line.push_str(&serde_json::to_string(&reason)?);
    } else {
        for value in rows.values(row) {
            line.push(' ');
            match value {
                Some(value) => drop(write!(line, "{value:?}")),
                None => line.push('-'),
            }
        }
    }
    line.push('\n');
    Ok(line)
}
