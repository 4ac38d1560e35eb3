//! Studies that can be divided: the request of a study, and its shards, parts in separate files that
//! `gather` combines.

use std::fs::{self, File};
use std::hash::Hasher;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::axis::Grid;
use super::batch::{Batch, Points, Row};
use super::tolerance::{Size, Tolerance};
use crate::case::file::unread;
use crate::case::sanitize::quoted;
use crate::case::{Case, Document, Problem, quantity};
use crate::model::{Inputs, Quantity};
use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher24;

/// The format of an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Format {
    /// Text in usual units
    Text,
    /// JSON in SI units, one object per line
    Json,
    /// Comma-separated values in SI units
    Csv,
    /// Tables in Markdown
    Md,
    /// A page with charts
    Html,
}

impl Format {
    /// The usual extension of a file.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Text => ".txt",
            Format::Json => ".json",
            Format::Csv => ".csv",
            Format::Md => ".md",
            Format::Html => ".html",
        }
    }
}

/// A case and the study of that case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// The name of the case, as the user gave it.
    pub name: String,
    /// The text of the case with the changes of the command line.
    pub case: String,
    /// The keys of the quantities.
    pub quantities: Vec<String>,
    /// The format of the output.
    pub format: Format,
    /// The points.
    pub points: PointsRequest,
}

/// The points of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "study", rename_all = "lowercase")]
pub enum PointsRequest {
    /// The points of `sweep`.
    Sweep {
        /// The arguments of each `--vary`.
        vary: Vec<String>,
        /// The arguments of each `--points`.
        points: Vec<usize>,
        /// Whether `--log` is given.
        log: bool,
    },
    /// The points of `tolerance`.
    Tolerance {
        /// Number of samples.
        samples: usize,
        /// Seed of the samples.
        seed: u64,
        /// Number of samples of the ranking.
        ranked: usize,
    },
}

/// A study that is ready to be solved, or to be gathered from its shards.
pub struct Study {
    /// The request that restores the study.
    pub request: Request,
    /// The case.
    pub case: Case,
    /// The inputs of the model.
    pub inputs: Inputs,
    /// The quantities.
    pub quantities: Vec<&'static Quantity>,
    /// The points.
    pub kind: Kind,
}

/// The points of a study.
pub enum Kind {
    /// The points of `sweep`.
    Sweep(Grid),
    /// The points of `tolerance`.
    Tolerance(Tolerance),
}

impl Study {
    /// The points.
    pub fn points(&self) -> &dyn Points {
        match &self.kind {
            Kind::Sweep(grid) => grid,
            Kind::Tolerance(study) => &study.design,
        }
    }

    /// The study for the solver.
    pub fn batch(&self) -> Batch<'_> {
        Batch { inputs: &self.inputs, points: self.points(), quantities: &self.quantities }
    }

    /// Restores a study.
    ///
    /// # Errors
    /// Returns an error if this version did not write the request.
    pub fn restore(request: &Request) -> Result<Study, Problem> {
        let document = Document::parse(&request.name, &request.case).map_err(|faults| {
            let cause = faults.first().map(ToString::to_string).unwrap_or_default();
            Problem::new("case", cause, "run the shard again")
        })?;
        let case = document.case;
        let inputs = case.inputs().map_err(|mut problems| problems.swap_remove(0))?;
        let known = |key: &String| quantity("quantities", key);
        let quantities = request.quantities.iter().map(known).collect::<Result<Vec<_>, _>>()?;
        let kind = match &request.points {
            PointsRequest::Sweep { vary, points, log } => {
                Kind::Sweep(Grid::parse(vary, points, *log).map_err(|(_, problem)| problem)?)
            }
            PointsRequest::Tolerance { samples, seed, ranked } => {
                let size = Size { samples: *samples, seed: *seed, ranked: Some(*ranked) };
                Kind::Tolerance(Tolerance::of(&case, &inputs, &quantities, size)?)
            }
        };
        Ok(Study { request: request.clone(), case, inputs, quantities, kind })
    }
}

/// Greatest number of shards of a study.
const MOST: usize = 100_000;
/// The word in the first line of a shard.
const KIND: &str = "tipstrike-shard";
/// The version that writes and reads shards.
const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Greatest length of a line, in bytes: the first line has the case.
const LONGEST: u64 = 16 << 20;

/// One of the equal parts of a study, numbered from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// The number of the part.
    pub number: usize,
    /// The number of parts.
    pub of: usize,
}

impl Shard {
    /// Parses a text such as `3/8`.
    ///
    /// # Errors
    /// Returns an error if the text is not a valid part.
    pub fn parse(text: &str) -> Result<Shard, String> {
        let number = |text: &str| text.trim().parse::<usize>().ok();
        let parts = text.split_once('/').and_then(|(at, of)| Some((number(at)?, number(of)?)));
        match parts {
            Some((number, of)) if (Shard { number, of }).is_part() => Ok(Shard { number, of }),
            Some((_, of)) if of > MOST => Err(format!("write at most {MOST} shards")),
            Some((_, of)) if of > 0 => {
                Err(format!("there is no such shard: write 1/{of} to {of}/{of}"))
            }
            _ => Err(format!("{} is not a shard: write I/N, such as 3/8", quoted(text))),
        }
    }

    /// Whether there is such a part.
    fn is_part(self) -> bool {
        self.of <= MOST && (1..=self.of).contains(&self.number)
    }

    /// The points of the shard.
    pub fn range(self, count: usize) -> Range<usize> {
        let end = |number: usize| (count as u128 * number as u128 / self.of as u128) as usize;
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
    version: String,
    /// The part.
    pub shard: Shard,
    /// The study.
    pub request: Request,
}

/// Writes a shard: a line with the study, one line per row, and the hash of these lines.
pub struct ShardWriter<'a> {
    out: &'a mut dyn Write,
    hasher: SipHasher24,
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
        let (kind, version) = (KIND.to_owned(), VERSION.to_owned());
        let mut writer = ShardWriter { out, hasher: SipHasher24::new() };
        writer.line(&Header { kind, version, shard, request: request.clone() })?;
        Ok(writer)
    }

    /// Writes rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&mut self, rows: &[Row]) -> io::Result<()> {
        rows.iter().try_for_each(|row| self.line(row))
    }

    fn line(&mut self, value: &impl Serialize) -> io::Result<()> {
        let line = serde_json::to_string(value)? + "\n";
        self.hasher.write(line.as_bytes());
        self.out.write_all(line.as_bytes())
    }

    /// Writes the last line, without which the shard is incomplete.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn finish(self) -> io::Result<()> {
        self.out.write_all(last_line(&self.hasher).as_bytes())
    }
}

fn last_line(hasher: &SipHasher24) -> String {
    format!("{:016x}\n", hasher.finish())
}

/// The lines of a file with their ends.
fn lines(path: &Path) -> io::Result<impl Iterator<Item = io::Result<String>>> {
    let mut file = BufReader::new(File::open(path)?);
    let mut next = move || {
        let mut line = String::new();
        let length = (&mut file).take(LONGEST).read_line(&mut line)?;
        let is_whole = (length as u64) < LONGEST;
        if is_whole { Ok(line) } else { Err(ErrorKind::InvalidData.into()) }
    };
    Ok(std::iter::from_fn(move || {
        Some(next()).filter(|line| !line.as_ref().is_ok_and(String::is_empty))
    }))
}

/// The error of files that are not the shards of one study.
fn wrong(line: String) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, line)
}

/// A complete shard of the requested study.
#[derive(Debug)]
pub struct Complete {
    path: PathBuf,
    /// Its first line.
    pub header: Header,
    rows: usize,
}

impl Complete {
    /// Reads a shard and checks that it is complete.
    ///
    /// # Errors
    /// Errors of the file; [`ErrorKind::InvalidData`] if the file is not a shard, or if the shard is
    /// incomplete or changed.
    pub fn read(path: &Path) -> io::Result<Complete> {
        let name = path.display();
        let no_shard =
            || wrong(format!("{name}: this is not a shard: name files that --shard wrote"));
        let unreadable = |error: io::Error| match error.kind() {
            ErrorKind::InvalidData => no_shard(),
            kind => io::Error::new(kind, format!("{name}: {}", unread(&error))),
        };
        // Opening a pipe waits for a writer.
        if !fs::metadata(path).map_err(unreadable)?.is_file() {
            return Err(no_shard());
        }
        let mut lines = lines(path).map_err(unreadable)?;
        let mut line = lines.next().transpose().map_err(unreadable)?.unwrap_or_default();
        let header = serde_json::from_str::<Header>(&line).ok();
        let is_shard = |header: &Header| header.kind == KIND && header.shard.is_part();
        let header = header.filter(is_shard).ok_or_else(no_shard)?;
        let Header { version, shard, .. } = &header;
        if version != VERSION {
            return Err(wrong(format!(
                "{name}: version {version} wrote this shard, and this is version {VERSION}: run the shard again"
            )));
        }
        let (mut hasher, mut count) = (SipHasher24::new(), 0);
        for next in lines {
            hasher.write(line.as_bytes());
            line = next.map_err(unreadable)?;
            count += 1;
        }
        if count == 0 || line != last_line(&hasher) {
            let line = format!("{name}: shard {shard} is incomplete or changed: run it again");
            return Err(wrong(line));
        }
        Ok(Complete { path: path.to_owned(), header, rows: count - 1 })
    }

    /// Passes the rows to `take`, with the index of the first of them; that of the shard is `first`.
    ///
    /// # Errors
    /// Errors of the file and of `take`.
    pub fn rows(
        &self,
        first: usize,
        take: &mut dyn FnMut(usize, &[Row]) -> io::Result<()>,
    ) -> io::Result<()> {
        /// Number of rows per read.
        const PAGE: usize = 1024;
        let mut lines = lines(&self.path)?.skip(1).take(self.rows);
        (first..first + self.rows).step_by(PAGE).try_for_each(|next| {
            let rows = lines.by_ref().take(PAGE).map(|line| Ok(serde_json::from_str(&line?)?));
            take(next, &rows.collect::<io::Result<Vec<Row>>>()?)
        })
    }
}

/// The shards of one study, in order.
///
/// # Errors
/// [`ErrorKind::InvalidData`] if the shards belong to several studies, or if one is missing or given
/// twice.
pub fn in_order(mut shards: Vec<Complete>) -> io::Result<Vec<Complete>> {
    let name = |shard: &Complete| shard.path.display().to_string();
    let Some(one) = shards.first() else { return Ok(shards) };
    let (first, request, of) = (name(one), &one.header.request, one.header.shard.of);
    let is_foreign =
        |other: &&Complete| other.header.request != *request || other.header.shard.of != of;
    if let Some(other) = shards.iter().find(is_foreign) {
        return Err(wrong(format!(
            "{}: this shard belongs to another study than {first}, or to another number of \
             shards: gather one study at a time",
            name(other)
        )));
    }
    let number = |shard: &Complete| shard.header.shard.number;
    shards.sort_by_key(number);
    let twice = shards.windows(2).find(|pair| number(&pair[0]) == number(&pair[1]));
    if let Some([one, other]) = twice {
        let (shard, file, one) = (one.header.shard, name(other), name(one));
        return Err(wrong(format!(
            "{file}: shard {shard} is in {one}, too: leave one of them out"
        )));
    }
    let is_missing = |at: &usize| shards.binary_search_by_key(at, number).is_err();
    let missing: Vec<_> =
        (1..=of).filter(is_missing).map(|number| format!("{number}/{of}")).collect();
    if missing.is_empty() {
        return Ok(shards);
    }
    let count = missing.len();
    let shown = missing[..count.min(10)].join(", ");
    let more = if count > 10 { ", ..." } else { "" };
    Err(wrong(format!("{count} of {of} shards are missing: run --shard {shown}{more}")))
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
