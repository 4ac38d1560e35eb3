//! Time of one solve: `cargo bench --bench solve`.
#![allow(clippy::print_stdout, reason = "a benchmark prints its results")]

mod timing;

use std::hint::black_box;

use timing::time;
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

fn closed_form() {
    let accurate = Inputs { accurate: true, ..table_1(Method::Exact) };
    for (name, inputs) in [
        ("paper", table_1(Method::Paper)),
        ("exact", table_1(Method::Exact)),
        ("exact, accurate", accurate),
    ] {
        time(&format!("closed form/{name}"), || solve(black_box(&inputs), Stages::CLOSED_FORM));
    }
}

fn stations() {
    let inputs = Inputs { stations: Some(256), ..table_1(Method::Exact) };
    time("exact with 256 stations", || solve(black_box(&inputs), Stages::ALL));
}

/// Table 1 with the computed deflection of the methods that share the load.
fn shared_load() {
    for teeth in ToothCompliance::ALL {
        let usual =
            Inputs { tooth_compliance: Some(teeth), deflection: None, ..table_1(Method::Static) };
        let shared = Inputs { stations: Some(256), ..usual.clone() };
        let (method, inertia) = (Stages::of(Stage::Static), Stages::of(Stage::Dynamic));
        time(&format!("shared load/static with 256 stations, {}", teeth.name()), || {
            solve(black_box(&shared), method)
        });
        for cycles in [20, 40, 80] {
            let inputs = Inputs {
                method: Method::Dynamic,
                warmup_cycles: cycles,
                tolerance: 1e-6,
                ..usual.clone()
            };
            time(
                &format!("shared load/dynamic with {cycles} cycles at 1e-6, {}", teeth.name()),
                || solve(black_box(&inputs), inertia),
            );
        }
    }
}

/// A helical pair with the usual number of slices, and the growth of the time with their number.
fn face_width() {
    let text = include_str!("../cases/helical-20-35.toml");
    let case =
        Document::parse("helical-20-35.toml", text).ok().and_then(|it| it.case.inputs().ok());
    let pair = case.unwrap_or_else(|| unreachable!("a case of the collection is valid"));
    for (method, stage) in [(Method::Static, Stage::Static), (Method::Dynamic, Stage::Dynamic)] {
        for slices in [None, Some(9), Some(33), Some(129), Some(513), Some(1025)] {
            let inputs = Inputs { method, slices, ..pair.clone() };
            let number = slices.map_or("usual".to_owned(), |slices| slices.to_string());
            time(&format!("face width/{}, {number} slices", method.name()), || {
                solve(black_box(&inputs), Stages::of(stage))
            });
        }
    }
}

fn compliance() {
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
            time(&format!("pair compliance/{}, {}", model.name(), contact.name()), || {
                let elasticity = black_box(&inputs).elasticity();
                Teeth::of(&elasticity, &geometry)?.pair_at_load(&place, 1500.0)
            });
        }
    }
}

fn main() {
    closed_form();
    stations();
    shared_load();
    face_width();
    compliance();
}
