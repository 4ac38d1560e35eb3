//! Shards: parts of a study in separate files, which `gather` combines.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::hash::Hasher;
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::batch::{Batch, PointOutcome, Points, Rows};
use super::sweep::Grid;
use super::tolerance::{Size, Tolerance};
use crate::case::sanitize::quoted;
use crate::case::{Case, Document, Problem, unknown_quantity};
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
    /// The name of the case, as the user gave it.
    pub name: String,
    /// The case.
    pub case: Case,
    /// The inputs of the model.
    pub inputs: Inputs,
    /// The quantities.
    pub quantities: Vec<&'static Quantity>,
    /// The format of the output.
    pub format: Format,
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
    #[must_use]
    pub fn points(&self) -> &dyn Points {
        match &self.kind {
            Kind::Sweep(grid) => grid,
            Kind::Tolerance(study) => &study.design,
        }
    }

    /// The study for the solver.
    #[must_use]
    pub fn batch(&self) -> Batch<'_> {
        Batch { inputs: &self.inputs, points: self.points(), quantities: &self.quantities }
    }

    /// The request that restores the study.
    #[must_use]
    pub fn request(&self, case: String, points: PointsRequest) -> Request {
        let quantities = self.quantities.iter().map(|known| known.key.to_owned()).collect();
        Request { name: self.name.clone(), case, quantities, format: self.format, points }
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
        let known =
            |key: &String| Quantity::find(key).ok_or_else(|| unknown_quantity("quantities", key));
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
        let (name, format) = (request.name.clone(), request.format);
        Ok(Study { name, case, inputs, quantities, format, kind })
    }
}

/// Greatest number of shards of a study.
const MOST: usize = 100_000;

/// The word in the first line of a shard.
const KIND: &str = "tipstrike-shard";

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
        let parts = text.trim().split_once('/');
        let numbers = parts
            .and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
        match numbers {
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
    /// The version of the program that wrote the shard.
    pub version: String,
    /// The part.
    pub shard: Shard,
    /// The study.
    pub request: Request,
}

/// The last line of a shard: the number of rows, and the hash of the first line and the rows.
#[derive(Serialize, Deserialize)]
struct Footer {
    rows: usize,
    hash: String,
}

/// The reason of a refused row: field, cause and fix.
#[derive(Serialize, Deserialize)]
struct Reason(String, String, String, String);

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
    if let Some(Problem { field, code, cause, fix }) = rows.refusal(row) {
        let reason = Reason(field.clone(), code.to_string(), cause.clone(), fix.to_string());
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

/// Number of rows per read.
const PAGE: usize = 1024;

/// Greatest length of a line, in bytes: the first line has the case.
const LONGEST: u64 = 16 << 20;

/// A complete shard of the requested study.
#[derive(Debug)]
pub struct Complete {
    path: PathBuf,
    /// Its first line.
    pub header: Header,
    rows: usize,
}

/// Why files are not the shards of one study.
#[derive(Debug)]
pub enum ShardError {
    /// A file cannot be read.
    Unreadable(String),
    /// The files do not belong together, or a file is not a shard.
    Wrong(String),
}

impl Complete {
    /// Reads a shard and checks that it is complete.
    ///
    /// # Errors
    /// Returns an error if the file is not a shard, or if the shard is incomplete or changed.
    pub fn read(path: &Path) -> Result<Complete, ShardError> {
        let name = path.display();
        let no_shard = || {
            ShardError::Wrong(format!("{name}: this is not a shard: name files that --shard wrote"))
        };
        let unreadable = |error: io::Error| match error.kind() {
            ErrorKind::InvalidData => no_shard(),
            _ => ShardError::Unreadable(format!("{name}: cannot be read: {error}")),
        };
        // Opening a pipe waits for a writer.
        if !fs::metadata(path).map_err(unreadable)?.is_file() {
            return Err(no_shard());
        }
        let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
        let mut first = Vec::new();
        read_line(&mut file, &mut first).map_err(unreadable)?;
        let header = serde_json::from_slice::<Header>(&first)
            .ok()
            .filter(|header| header.kind == KIND && header.shard.is_part())
            .ok_or_else(no_shard)?;
        let version = env!("CARGO_PKG_VERSION");
        if header.version != version {
            return Err(ShardError::Wrong(format!(
                "{name}: version {} wrote this shard, and this is version {version}: run the shard again",
                header.version
            )));
        }
        let rows = body(file, first).map_err(unreadable)?.ok_or_else(|| {
            ShardError::Wrong(format!(
                "{name}: shard {} is incomplete or changed: run it again",
                header.shard
            ))
        })?;
        Ok(Complete { path: path.to_owned(), header, rows })
    }

    /// Passes the rows to `take`; the first row has index `first`.
    ///
    /// # Errors
    /// Errors of the file and of `take`.
    pub fn rows(
        &self,
        first: usize,
        take: &mut dyn FnMut(Rows) -> io::Result<()>,
    ) -> io::Result<()> {
        let mut file = BufReader::new(File::open(&self.path)?);
        let (mut line, mut page) = (Vec::new(), Rows::starting_at(first));
        read_line(&mut file, &mut line)?;
        for _ in 0..self.rows {
            read_line(&mut file, &mut line)?;
            let line = String::from_utf8_lossy(&line);
            add(&line, self.header.request.quantities.len(), &mut page)?;
            if page.outcomes.len() == PAGE {
                let next = page.range().end;
                take(std::mem::replace(&mut page, Rows::starting_at(next)))?;
            }
        }
        take(page)
    }
}

/// Reads a line with its end into `line`. Returns whether there is one.
fn read_line(file: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
    line.clear();
    let length = file.take(LONGEST).read_until(b'\n', line)?;
    if length as u64 == LONGEST {
        return Err(ErrorKind::InvalidData.into());
    }
    Ok(length > 0)
}

/// The number of rows after the first line, if the last line has this number and the hash.
fn body(mut file: impl BufRead, first: Vec<u8>) -> io::Result<Option<usize>> {
    let (mut hasher, mut lines) = (SipHasher24::new(), 0_usize);
    let (mut line, mut next) = (first, Vec::new());
    while read_line(&mut file, &mut next)? {
        hasher.write(&line);
        lines += 1;
        std::mem::swap(&mut line, &mut next);
    }
    let footer = serde_json::from_slice::<Footer>(&line).ok();
    let is_whole = |footer: &Footer| {
        Some(footer.rows) == lines.checked_sub(1)
            && footer.hash == format!("{:016x}", hasher.finish())
    };
    Ok(footer.filter(is_whole).map(|footer| footer.rows))
}

/// Adds the row of a line with `width` values.
fn add(line: &str, width: usize, rows: &mut Rows) -> io::Result<()> {
    let line = line.trim_end();
    let bad = || io::Error::other("a row of the shard cannot be read");
    let (code, rest) = line.split_once(' ').unwrap_or((line, ""));
    let code: usize = code.parse().map_err(|_| bad())?;
    let outcome = *PointOutcome::ALL.get(code).ok_or_else(bad)?;
    if rest.starts_with('[') {
        let Reason(field, code, cause, fix) = serde_json::from_str(rest)?;
        let index = rows.range().end;
        rows.refusals
            .push((index, Problem { code: code.into(), ..Problem::new(&field, cause, fix) }));
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
/// Returns an error if the shards belong to several studies, or if one is missing or given twice.
pub fn in_order(mut shards: Vec<Complete>) -> Result<Vec<Complete>, ShardError> {
    let wrong = |text| Err(ShardError::Wrong(text));
    let Some(one) = shards.first() else {
        return wrong("no shard is given: name every file that --shard wrote".to_owned());
    };
    let (request, of) = (one.header.request.clone(), one.header.shard.of);
    let name = |shard: &Complete| shard.path.display().to_string();
    let first = name(one);
    for shard in &shards {
        let (file, own) = (name(shard), shard.header.shard);
        if shard.header.request != request {
            return wrong(format!(
                "{file}: this shard belongs to another study than {first}: gather one study at a time"
            ));
        }
        if own.of != of {
            return wrong(format!(
                "{file}: shard {own}, and {first} is one of {of}: use one number of shards"
            ));
        }
    }
    shards.sort_by_key(|shard| shard.header.shard.number);
    let same = |pair: &&[Complete]| pair[0].header.shard == pair[1].header.shard;
    if let Some(twice) = shards.windows(2).find(same) {
        let (file, other) = (name(&twice[1]), name(&twice[0]));
        let shard = twice[0].header.shard;
        return wrong(format!("{file}: shard {shard} is in {other}, too: leave one of them out"));
    }
    let is_missing = |number: &usize| {
        shards.binary_search_by_key(number, |shard| shard.header.shard.number).is_err()
    };
    let missing = (1..=of).filter(is_missing).map(|number| format!("{number}/{of}"));
    let missing: Vec<String> = missing.collect();
    if missing.is_empty() {
        return Ok(shards);
    }
    let count = missing.len();
    let shown = missing[..count.min(10)].join(", ");
    let more = if count > 10 { ", ..." } else { "" };
    wrong(format!("{count} of {of} shards are missing: run --shard {shown}{more}"))
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
