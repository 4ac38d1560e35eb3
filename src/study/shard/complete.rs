//! Complete shards, read and ordered for `gather`.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::hash::Hasher;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};

use siphasher::sip::SipHasher24;

use super::lines::{Footer, Header, KIND, Reason};
use crate::case::Problem;
use crate::study::batch::{PointOutcome, Rows};

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
/// Returns an error if the shards belong to several studies, or if one is missing or given twice.
pub fn in_order(mut shards: Vec<Complete>) -> Result<Vec<Complete>, ShardError> {
    let wrong = |text| Err(ShardError::Wrong(text));
    let Some(one) = shards.first() else {
        return wrong("no shard is given: name every file that --shard wrote".to_owned());
    };
    let (request, of) = (one.header.request.clone(), one.header.shard.of);
    let name = |shard: &Complete| shard.path.display().to_string();
    let first = name(one);
    let is_foreign = |shard: &&Complete| shard.header.request != request;
    if let Some(foreign) = shards.iter().find(is_foreign) {
        let foreign = name(foreign);
        return wrong(format!(
            "{foreign}: this shard belongs to another study than {first}: gather one study at a time"
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
        return wrong(format!("{file}: shard {shard} is in {other}, too: leave one of them out"));
    }
    let known: BTreeSet<usize> = shards.iter().map(|shard| shard.header.shard.number).collect();
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
    wrong(format!("{count} of {of} shards are missing: run --shard {shown}{more}"))
}
