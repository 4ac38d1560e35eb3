//! Faults of the program on demand, for the tests of what becomes of them; a release has none.

/// Panic where the tests ask for it at this place, or stay there for ever.
#[cfg(debug_assertions)]
#[expect(clippy::panic, reason = "a fault is what is asked for")]
pub(super) fn on_demand(place: &str) {
    match std::env::var("TIPSTRIKE_FAULT").unwrap_or_default() {
        asked if asked == place => panic!("a fault on demand"),
        asked if asked.strip_prefix("stuck ") == Some(place) => loop {
            std::thread::park();
        },
        _ => {}
    }
}

/// Nothing.
#[cfg(not(debug_assertions))]
pub(super) fn on_demand(_place: &str) {}
