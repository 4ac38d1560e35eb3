//! Invalid texts, edits, keys and bytes: nothing panics, no edit is lost, and no control character
//! reaches the terminal.
//!
//! Every run is the same. `TIPSTRIKE_FUZZ=N cargo test --test fuzz` runs N times as many cases,
//! other ones each time. Failures of the past are stored under `kept` and are tried first.

#![cfg(all(feature = "cli", feature = "tui"))]
#![allow(clippy::expect_used, clippy::panic, reason = "a failing test may panic")]

mod documents;
mod form;
mod layouts;
mod properties;
mod terminal;
mod texts;
#[path = "../tty/mod.rs"]
mod tty;
mod values;

use std::env;

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, RngSeed, TestRunner};

/// Time limit for the minimization of a failing case, in ms.
const SHRINKING: u32 = 30_000;

/// The requested multiple of cases, if any.
fn times() -> Option<u32> {
    env::var("TIPSTRIKE_FUZZ").ok().map(|times| times.parse().expect("TIPSTRIKE_FUZZ is a number"))
}

/// Checks a property, which asserts, with a number of cases.
#[track_caller]
fn hold<S: Strategy>(cases: u32, strategy: &S, property: impl Fn(S::Value)) {
    hold_from(1, cases, strategy, property);
}

/// The same with the cases of a seed.
#[track_caller]
fn hold_from<S: Strategy>(seed: u64, cases: u32, strategy: &S, property: impl Fn(S::Value)) {
    let asked = times();
    let config = Config {
        cases: cases * asked.unwrap_or(1),
        failure_persistence: None,
        max_shrink_time: SHRINKING,
        rng_seed: if asked.is_some() { RngSeed::Random } else { RngSeed::Fixed(seed) },
        ..Config::default()
    };
    let result = TestRunner::new(config).run(strategy, |value| {
        property(value);
        Ok(())
    });
    result.unwrap_or_else(|failure| panic!("{failure}"));
}

/// Whether a character controls a terminal or is invisible: controls, directions, and
/// default-ignorable characters of Unicode.
fn is_hostile(character: char) -> bool {
    const IGNORABLE: [(char, char); 19] = [
        ('\u{ad}', '\u{ad}'),
        ('\u{34f}', '\u{34f}'),
        ('\u{61c}', '\u{61c}'),
        ('\u{115f}', '\u{1160}'),
        ('\u{17b4}', '\u{17b5}'),
        ('\u{180b}', '\u{180f}'),
        ('\u{200b}', '\u{200f}'),
        ('\u{2028}', '\u{2029}'),
        ('\u{202a}', '\u{202e}'),
        ('\u{2060}', '\u{206f}'),
        ('\u{3164}', '\u{3164}'),
        ('\u{fe00}', '\u{fe0f}'),
        ('\u{feff}', '\u{feff}'),
        ('\u{ffa0}', '\u{ffa0}'),
        ('\u{fff0}', '\u{fff8}'),
        ('\u{fff9}', '\u{fffb}'),
        ('\u{1bca0}', '\u{1bca3}'),
        ('\u{1d173}', '\u{1d17a}'),
        ('\u{e0000}', '\u{e0fff}'),
    ];
    character.is_control() || IGNORABLE.iter().any(|&(from, to)| (from..=to).contains(&character))
}

/// Checks that the lines are safe to print on a terminal.
#[track_caller]
fn assert_safe(text: &str) {
    let hostile = text.chars().find(|&character| character != '\n' && is_hostile(character));
    assert_eq!(hostile, None, "in {text:?}");
}
