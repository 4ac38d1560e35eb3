//! Shard numbers, and the first and last lines of shard files.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::case::sanitize::quoted;
use crate::study::request::Request;

/// Greatest number of shards of a study.
const MOST: usize = 100_000;

/// The word in the first line of a shard.
pub(super) const KIND: &str = "tipstrike-shard";

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
    pub(super) fn is_part(self) -> bool {
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
    pub(super) kind: String,
    /// The version of the program that wrote the shard.
    pub version: String,
    /// The part.
    pub shard: Shard,
    /// The study.
    pub request: Request,
}

/// The last line of a shard: the number of rows, and the hash of the first line and the rows.
#[derive(Serialize, Deserialize)]
pub(super) struct Footer {
    pub(super) rows: usize,
    pub(super) hash: String,
}

/// The reason of a refused row: field, cause and fix.
#[derive(Serialize, Deserialize)]
pub(super) struct Reason(pub(super) String, pub(super) String, pub(super) String);

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
