//! Median time of a call on this machine.

use std::hint::black_box;
use std::time::{Duration, Instant};

const WARM_UP: Duration = Duration::from_millis(300);
const MEASURED: Duration = Duration::from_secs(2);

/// Prints the median time of a call and the middle half of its times. `cargo bench -- TEXT` measures
/// only the calls whose name has the text.
pub(crate) fn time<T>(name: &str, mut call: impl FnMut() -> T) {
    let mut arguments = std::env::args().skip(1);
    if arguments.any(|argument| !argument.starts_with('-') && !name.contains(&argument)) {
        return;
    }
    let (start, mut calls) = (Instant::now(), 0_u32);
    while start.elapsed() < WARM_UP {
        black_box(call());
        calls += 1;
    }
    let batch = (calls / 50).max(1);
    let (start, mut times) = (Instant::now(), Vec::new());
    while start.elapsed() < MEASURED {
        let begin = Instant::now();
        for _ in 0..batch {
            black_box(call());
        }
        times.push(1e6 * begin.elapsed().as_secs_f64() / f64::from(batch));
    }
    times.sort_by(f64::total_cmp);
    let [from, median, to] = [1, 2, 3].map(|quarter| times[quarter * (times.len() - 1) / 4]);
    println!("{name}: {median:.3} us ({from:.3} to {to:.3})");
}
