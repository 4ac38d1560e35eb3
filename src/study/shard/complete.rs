//! Complete shards, read and ordered for `gather`.

use std::collections::BTreeSet;
use std::fs::File;
use std::hash::Hasher;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use siphasher::sip::SipHasher24;

use super::lines::{Footer, Header, KIND, MOST, Reason};
use crate::case::Problem;
use crate::study::batch::{PointOutcome, Rows};

/// Number of rows per read.
const PAGE: usize = 1024;

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
        let unreadable = |error| ShardError::Unreadable(format!("{name}: cannot be read: {error}"));
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
                ShardError::Wrong(format!(
                    "{name}: this is not a shard: name files that --shard wrote"
                ))
            })?;
        let version = env!("CARGO_PKG_VERSION");
        if header.version != version {
            return Err(ShardError::Wrong(format!(
                "{name}: version {} wrote this shard, and this is version {version}: run the shard again",
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
            _ => Err(ShardError::Wrong(format!(
                "{name}: shard {} is incomplete or changed: run it again",
                header.shard
            ))),
        }
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

/// The number of rows, if it is equal to the number in the last line.
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

/// Adds the row of a line with `width` values.
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
/// Returns an error if the shards belong to several studies, or if one is missing or given twice.
pub fn in_order(mut shards: Vec<Complete>) -> Result<Vec<Complete>, ShardError> {
    let wrong = |text| Err(ShardError::Wrong(text));
    let Some(one) = shards.first() else {
        return wrong("no shard is given: name every file that --shard wrote".to_owned());
    };
    let (hash, of) = (one.header.hash.clone(), one.header.shard.of);
    let name = |shard: &Complete| shard.path.display().to_string();
    let first = name(one);
    if let Some(foreign) = shards.iter().find(|shard| shard.header.hash != hash) {
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
