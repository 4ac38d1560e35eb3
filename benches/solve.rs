//! What one solve costs: `cargo bench`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use tipstrike::case::Case;
use tipstrike::model::inputs::Rung;
use tipstrike::model::{Inputs, Stages, solve};

fn table_1(rung: Rung) -> Inputs {
    let mut inputs = Case::table_1().inputs().unwrap_or_else(|_| unreachable!("the built-in case is valid"));
    inputs.rung = rung;
    inputs
}

fn closed_form(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("closed form");
    let accurate = Inputs { accurate: true, ..table_1(Rung::Exact) };
    for (name, inputs) in [("paper", table_1(Rung::Paper)), ("exact", table_1(Rung::Exact)), ("exact, accurate", accurate)] {
        group.bench_function(name, |bencher| bencher.iter(|| solve(black_box(&inputs), Stages::CLOSED_FORM)));
    }
    group.finish();
}

fn stations(criterion: &mut Criterion) {
    let inputs = Inputs { stations: 256, ..table_1(Rung::Exact) };
    criterion.bench_function("exact with 256 stations", |bencher| bencher.iter(|| solve(black_box(&inputs), Stages::ALL)));
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(std::time::Duration::from_millis(300)).measurement_time(std::time::Duration::from_secs(2));
    targets = closed_form, stations
}
criterion_main!(benches);
