//! A part of a study in a file of its own, and the parts put together again.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs::File;
use std::hash::Hasher;
use std::io::{self, BufRead, BufReader, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher24;

use super::batch::{PointOutcome, Rows};
use super::request::Request;
use crate::case::Problem;
use crate::case::sanitize::quoted;

/// Rows that are read at once.
const PAGE: usize = 1024;

/// The most shards of a study.
const MOST: usize = 100_000;

/// The word in the first line of a shard.
const KIND: &str = "tipstrike-shard";

/// One of the equal parts of a study, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// The number of the part.
    pub number: usize,
    /// How many parts there are.
    pub of: usize,
}

impl Shard {
    /// The shard of a text such as `3/8`.
    ///
    /// # Errors
    /// Where the text is no such part.
    pub fn parse(text: &str) -> Result<Shard, String> {
        let parts = text.trim().split_once('/');
        let numbers = parts
            .and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
        match numbers {
            Some((number, of)) if of <= MOST && (1..=of).contains(&number) => {
                Ok(Shard { number, of })
            }
            Some((_, of)) if of > MOST => Err(format!("write at most {MOST} shards")),
            Some((_, of)) if of > 0 => {
                Err(format!("there is no such shard: write 1/{of} to {of}/{of}"))
            }
            _ => Err(format!(
                "{} is not a shard: write I/N, such as 3/8",
                quoted(text)
            )),
        }
    }

    /// The points of the shard.
    #[must_use]
    pub fn range(self, count: usize) -> Range<usize> {
        let end = |number: usize| {
            let end = count as u128 * number as u128 / self.of as u128;
            usize::try_from(end).unwrap_or(count)
        };
        end(self.number - 1)..end(self.number)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// The first line of a shard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Header {
    kind: String,
    /// The version of the program that wrote it.
    pub version: String,
    /// The part.
    pub shard: Shard,
    /// The hash of study and version.
    pub hash: String,
    /// The study.
    pub request: Request,
}

/// The last line of a shard.
#[derive(Serialize, Deserialize)]
struct Footer {
    rows: usize,
    hash: String,
}

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
    /// Those of the writer.
    pub fn begin(
        shard: Shard,
        request: &Request,
        out: &'a mut dyn Write,
    ) -> io::Result<ShardWriter<'a>> {
        let header = Header {
            kind: KIND.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            shard,
            hash: request.hash(),
            request: request.clone(),
        };
        writeln!(out, "{}", serde_json::to_string(&header)?)?;
        Ok(ShardWriter {
            out,
            hasher: SipHasher24::new(),
            rows: 0,
        })
    }

    /// Writes rows.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, rows: &Rows) -> io::Result<()> {
        for row in 0..rows.outcomes.len() {
            let line = line(rows, row)?;
            self.hasher.write(line.as_bytes());
            self.out.write_all(line.as_bytes())?;
            self.rows += 1;
        }
        Ok(())
    }

    /// Writes the last line, without which the shard is incomplete.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(self) -> io::Result<()> {
        let footer = Footer {
            rows: self.rows,
            hash: format!("{:016x}", self.hasher.finish()),
        };
        writeln!(self.out, "{}", serde_json::to_string(&footer)?)
    }
}

/// The reason of a refused row.
#[derive(Serialize, Deserialize)]
struct Reason(String, String, String);

/// A row as a line: the place of its outcome in [`PointOutcome::ALL`], then its values or the
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

/// A shard that is complete and of the wanted study.
#[derive(Debug)]
pub struct Complete {
    path: PathBuf,
    /// Its first line.
    pub header: Header,
    rows: usize,
}

/// Why files are not the shards of one study.
#[derive(Debug)]
pub enum Unfit {
    /// A file cannot be read.
    Unreadable(String),
    /// The files do not fit together, or one is no shard.
    Wrong(String),
}

impl Complete {
    /// Reads a shard and checks that it is whole.
    ///
    /// # Errors
    /// Where the file is no shard, or an incomplete or changed one.
    pub fn read(path: &Path) -> Result<Complete, Unfit> {
        let name = path.display();
        let unreadable = |error| Unfit::Unreadable(format!("{name}: cannot be read: {error}"));
        let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
        let mut first = String::new();
        let read = file.read_line(&mut first);
        let header = match read {
            Err(error) if error.kind() != io::ErrorKind::InvalidData => {
                return Err(unreadable(error));
            }
            _ => serde_json::from_str::<Header>(&first).ok(),
        };
        let header = header
            .filter(|header| header.kind == KIND && header.shard.of <= MOST)
            .ok_or_else(|| {
                Unfit::Wrong(format!(
                    "{name}: this is not a shard: name files that --shard wrote"
                ))
            })?;
        let version = env!("CARGO_PKG_VERSION");
        if header.version != version {
            return Err(Unfit::Wrong(format!(
                "{name}: written by version {}, and this is {version}: run the shard again",
                header.version
            )));
        }
        let is_whole = header.hash == header.request.hash();
        match body(file).map_err(unreadable)? {
            Some(rows) if is_whole => Ok(Complete {
                path: path.to_owned(),
                header,
                rows,
            }),
            _ => Err(Unfit::Wrong(format!(
                "{name}: shard {} is incomplete or changed: run it again",
                header.shard
            ))),
        }
    }

    /// Hands over the rows, the first of which has that index.
    ///
    /// # Errors
    /// Those of the file, and of `take`.
    pub fn rows(
        &self,
        first: usize,
        take: &mut dyn FnMut(Rows) -> io::Result<()>,
    ) -> io::Result<()> {
        let file = BufReader::new(File::open(&self.path)?);
        let mut page = Rows::starting_at(first);
        for line in file.lines().skip(1).take(self.rows) {
            add(&line?, self.header.request.quantities.len(), &mut page)?;
            if page.outcomes.len() == PAGE {
                let next = page.range().end;
                take(std::mem::replace(&mut page, Rows::starting_at(next)))?;
            }
        }
        take(page)
    }
}

/// The number of rows, where they are those that the last line promises.
fn body(mut file: impl BufRead) -> io::Result<Option<usize>> {
    let (mut hasher, mut rows) = (SipHasher24::new(), 0);
    let (mut line, mut next) = (Vec::new(), Vec::new());
    file.read_until(b'\n', &mut line)?;
    loop {
        next.clear();
        if file.read_until(b'\n', &mut next)? == 0 {
            break;
        }
        hasher.write(&line);
        rows += 1;
        std::mem::swap(&mut line, &mut next);
    }
    let footer = serde_json::from_slice::<Footer>(&line).ok();
    let is_whole =
        |footer: &Footer| footer.rows == rows && footer.hash == format!("{:016x}", hasher.finish());
    Ok(footer.filter(is_whole).map(|_| rows))
}

/// Adds the row of a line with so many values.
fn add(line: &str, width: usize, rows: &mut Rows) -> io::Result<()> {
    let bad = || io::Error::other("a row of the shard cannot be read");
    let (code, rest) = line.split_once(' ').unwrap_or((line, ""));
    let code: usize = code.parse().map_err(|_| bad())?;
    let outcome = *PointOutcome::ALL.get(code).ok_or_else(bad)?;
    if rest.starts_with('[') {
        let Reason(field, cause, fix) = serde_json::from_str(rest)?;
        let index = rows.range().end;
        rows.refusals.push((index, Problem { field, cause, fix }));
        rows.push(outcome, std::iter::repeat_n(None, width));
        return Ok(());
    }
    let value = |text: &str| match text {
        "-" => Ok(None),
        number => number.parse().map(Some).map_err(|_| bad()),
    };
    let values = rest.split_whitespace().map(value);
    let values = values.collect::<io::Result<Vec<Option<f64>>>>()?;
    if values.len() != width {
        return Err(bad());
    }
    rows.push(outcome, values);
    Ok(())
}

/// The shards of one study, in order.
///
/// # Errors
/// Where they belong to several studies, or one is missing or given twice.
pub fn in_order(mut shards: Vec<Complete>) -> Result<Vec<Complete>, Unfit> {
    let wrong = |text| Err(Unfit::Wrong(text));
    let Some(one) = shards.first() else {
        return wrong("no shard is given: name every file that --shard wrote".to_owned());
    };
    let (hash, of) = (one.header.hash.clone(), one.header.shard.of);
    let name = |shard: &Complete| shard.path.display().to_string();
    let first = name(one);
    if let Some(foreign) = shards.iter().find(|shard| shard.header.hash != hash) {
        let foreign = name(foreign);
        return wrong(format!(
            "{foreign}: of another study than {first}: gather one study at a time"
        ));
    }
    if let Some(other) = shards.iter().find(|shard| shard.header.shard.of != of) {
        let (file, shard) = (name(other), other.header.shard);
        return wrong(format!(
            "{file}: shard {shard}, and {first} is one of {of}: use one number of shards"
        ));
    }
    shards.sort_by_key(|shard| shard.header.shard.number);
    let same = |pair: &&[Complete]| pair[0].header.shard == pair[1].header.shard;
    if let Some(twice) = shards.windows(2).find(same) {
        let (file, other) = (name(&twice[1]), name(&twice[0]));
        let shard = twice[0].header.shard;
        return wrong(format!(
            "{file}: shard {shard} is in {other}, too: leave one of them out"
        ));
    }
    let known: BTreeSet<usize> = shards
        .iter()
        .map(|shard| shard.header.shard.number)
        .collect();
    let missing: Vec<String> = (1..=of)
        .filter(|number| !known.contains(number))
        .map(|number| format!("{number}/{of}"))
        .collect();
    if missing.is_empty() {
        return Ok(shards);
    }
    let count = missing.len();
    let shown = missing[..count.min(10)].join(", ");
    let more = if count > 10 { ", ..." } else { "" };
    wrong(format!(
        "{count} of {of} shards are missing: run --shard {shown}{more}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shards_of_a_study_are_its_points_in_order() {
        for (count, of) in [(0, 3), (1, 3), (7, 3), (101, 8), (8, 8), (1_000_000, 7)] {
            let mut next = 0;
            for number in 1..=of {
                let range = Shard { number, of }.range(count);
                assert_eq!(range.start, next);
                assert!(range.len() <= count / of + 1);
                next = range.end;
            }
            assert_eq!(next, count);
        }
    }

    #[test]
    fn a_bad_shard_gets_its_cause_and_fix() {
        assert_eq!(Shard::parse(" 3/8 "), Ok(Shard { number: 3, of: 8 }));
        for (text, part) in [
            ("4/3", "there is no such shard: write 1/3 to 3/3"),
            ("0/3", "there is no such shard"),
            ("3", "write I/N, such as 3/8"),
            ("1/0", "write I/N"),
            ("-1/3", "write I/N"),
            ("1/200000", "at most 100000"),
        ] {
            let message = Shard::parse(text).unwrap_err();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
