//! Time of one solve: `cargo bench`.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use tipstrike::case::Case;
use tipstrike::case::file::Document;
use tipstrike::model::compliance::{ContactPlace, Teeth};
use tipstrike::model::geometry::geometry;
use tipstrike::model::inputs::{ContactCompliance, Method, ToothCompliance};
use tipstrike::model::{Inputs, Stage, Stages, solve};

fn table_1(method: Method) -> Inputs {
    let mut inputs =
        Case::table_1().inputs().unwrap_or_else(|_| unreachable!("the built-in case is valid"));
    inputs.method = method;
    inputs
}

fn closed_form(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("closed form");
    let accurate = Inputs { accurate: true, ..table_1(Method::Exact) };
    for (name, inputs) in [
        ("paper", table_1(Method::Paper)),
        ("exact", table_1(Method::Exact)),
        ("exact, accurate", accurate),
    ] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| solve(black_box(&inputs), Stages::CLOSED_FORM));
        });
    }
    group.finish();
}

fn stations(criterion: &mut Criterion) {
    let inputs = Inputs { stations: Some(256), ..table_1(Method::Exact) };
    criterion.bench_function("exact with 256 stations", |bencher| {
        bencher.iter(|| solve(black_box(&inputs), Stages::ALL));
    });
}

/// Table 1 with the computed deflection of the methods that share the load.
fn shared_load(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("shared load");
    for teeth in ToothCompliance::ALL {
        let usual =
            Inputs { tooth_compliance: Some(teeth), deflection: None, ..table_1(Method::Static) };
        let shared = Inputs { stations: Some(256), ..usual.clone() };
        let (method, inertia) = (Stages::of(Stage::Static), Stages::of(Stage::Dynamic));
        group.bench_function(format!("static with 256 stations, {}", teeth.name()), |bencher| {
            bencher.iter(|| solve(black_box(&shared), method));
        });
        for cycles in [20, 40, 80] {
            let inputs = Inputs {
                method: Method::Dynamic,
                warmup_cycles: cycles,
                tolerance: 1e-6,
                ..usual.clone()
            };
            group.bench_function(
                format!("dynamic with {cycles} cycles at 1e-6, {}", teeth.name()),
                |bencher| {
                    bencher.iter(|| solve(black_box(&inputs), inertia));
                },
            );
        }
    }
    group.finish();
}

/// A helical pair with the usual number of slices, and the growth of the time with their number.
fn face_width(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("face width");
    let text = include_str!("../cases/helical-20-35.toml");
    let case =
        Document::parse("helical-20-35.toml", text).ok().and_then(|it| it.case.inputs().ok());
    let pair = case.unwrap_or_else(|| unreachable!("a case of the collection is valid"));
    for (method, stage) in [(Method::Static, Stage::Static), (Method::Dynamic, Stage::Dynamic)] {
        for slices in [None, Some(9), Some(33), Some(129), Some(513), Some(1025)] {
            let inputs = Inputs { method, slices, ..pair.clone() };
            let number = slices.map_or("usual".to_owned(), |slices| slices.to_string());
            group.bench_function(format!("{}, {number} slices", method.name()), |bencher| {
                bencher.iter(|| solve(black_box(&inputs), Stages::of(stage)));
            });
        }
    }
    group.finish();
}

fn compliance(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("pair compliance");
    for model in ToothCompliance::ALL {
        for contact in ContactCompliance::ALL {
            let inputs = Inputs {
                tooth_compliance: Some(model),
                contact_compliance: contact,
                ..table_1(Method::Exact)
            };
            let Ok(geometry) = geometry::<f64>(&inputs.shape()) else {
                continue;
            };
            let place = ContactPlace::on_line_of_action(&geometry, geometry.start);
            group.bench_function(format!("{}, {}", model.name(), contact.name()), |bencher| {
                bencher.iter(|| {
                    let elasticity = black_box(&inputs).elasticity();
                    Teeth::of(&elasticity, &geometry)?.pair_at_load(&place, 1500.0)
                });
            });
        }
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(std::time::Duration::from_millis(300)).measurement_time(std::time::Duration::from_secs(2));
    targets = closed_form, stations, shared_load, face_width, compliance
}
criterion_main!(benches);
