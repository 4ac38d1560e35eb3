//! Chunks of points: the units of work of a thread.

use std::ops::Range;

/// Greatest number of points of a chunk.
const LONGEST: usize = 8192;

/// A chunk is this fraction of a thread's share of the remaining points, so that the last chunks
/// are short and no thread waits long for another.
const PARTS_OF_SHARE: usize = 4;

/// The shortest chunk is this fraction of a thread's share of all points: each chunk wakes the
/// thread that collects the rows.
const MOST_PARTS: usize = 1024;

/// The chunks of a range for a number of threads, in order.
pub(super) fn chunks(range: &Range<usize>, jobs: usize) -> Vec<Range<usize>> {
    let shortest = (range.len() / (jobs * MOST_PARTS)).clamp(1, LONGEST);
    let after = |first: usize| {
        let part = (range.end - first) / (jobs * PARTS_OF_SHARE);
        first..(first + part.clamp(shortest, LONGEST)).min(range.end)
    };
    let is_left = |chunk: &Range<usize>| !chunk.is_empty();
    std::iter::successors(Some(after(range.start)), |chunk| Some(after(chunk.end)))
        .take_while(is_left)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_the_range_once_and_end_with_short_ones() {
        for (range, jobs) in [(0..0, 2), (7..8, 4), (3..100_003, 2), (0..1_000, 64)] {
            let found = chunks(&range, jobs);
            let ends = found.iter().map(|chunk| chunk.end);
            let firsts: Vec<usize> = found.iter().map(|chunk| chunk.start).collect();
            let expected: Vec<usize> = std::iter::once(range.start).chain(ends).collect();
            assert_eq!(firsts, expected[..found.len()]);
            assert_eq!(expected.last(), Some(&range.end));
            let short = 1.max(range.len() / (jobs * MOST_PARTS));
            let is_short = |chunk: &Range<usize>| chunk.len() <= short;
            assert!(found.last().is_none_or(is_short), "{found:?}");
            assert!(found.iter().all(|chunk| chunk.len() <= LONGEST));
        }
    }
}
