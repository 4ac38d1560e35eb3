//! Faults of the program on demand, for the tests of what becomes of them; a release has none.

/// Panic where the tests ask for it at this place.
#[cfg(debug_assertions)]
#[expect(clippy::panic, clippy::manual_assert, reason = "a fault is what is asked for")]
pub(super) fn on_demand(place: &str) {
    if std::env::var_os("TIPSTRIKE_FAULT").is_some_and(|asked| asked == place) {
        panic!("a fault on demand");
    }
}

/// Nothing.
#[cfg(not(debug_assertions))]
pub(super) fn on_demand(_place: &str) {}
