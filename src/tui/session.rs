//! Protection of typed values: saving, locks, journals of unsaved edits, and their recovery.

pub(crate) mod autosave;
pub(crate) mod journal;
pub(crate) mod lock;
pub(crate) mod save;

use std::time::{SystemTime, UNIX_EPOCH};

/// Seconds since 1970.
#[must_use]
fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// A duration in seconds as text.
#[must_use]
fn age(seconds: u64) -> String {
    let (minutes, hours, days) = (seconds / 60, seconds / 3600, seconds / 86400);
    match (days, hours, minutes) {
        (2.., ..) => format!("{days} days"),
        (_, 1.., _) => format!("{hours} h {} min", minutes % 60),
        (_, _, 1..) => format!("{minutes} min"),
        _ => format!("{seconds} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::age;

    #[test]
    fn durations_are_rounded_to_a_readable_unit() {
        let ages = [0, 59, 60, 3599, 3600, 7260, 100_000, 172_800].map(age);
        assert_eq!(
            ages,
            ["0 s", "59 s", "1 min", "59 min", "1 h 0 min", "2 h 1 min", "27 h 46 min", "2 days"]
        );
    }
}
