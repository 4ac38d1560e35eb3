//! A closed-form solve allocates no memory on the heap.
use std::hint::black_box;

use tipstrike::case::Case;
use tipstrike::model::inputs::Method;
use tipstrike::model::{Inputs, Stages, solve};

#[test]
fn a_closed_form_solve_does_not_allocate() {
    let table_1 = Case::table_1().inputs().expect("the built-in case is valid");
    for method in Method::CLOSED_FORM {
        for accurate in [false, true] {
            for deflection in [table_1.deflection, None] {
                let inputs = Inputs { method, accurate, deflection, ..table_1.clone() };
                let count = allocation_counter::measure(|| {
                    black_box(solve(black_box(&inputs), Stages::CLOSED_FORM).is_ok());
                });
                assert_eq!(count.count_total, 0, "{method:?} {accurate} {deflection:?}");
            }
        }
    }
}

#[test]
fn only_the_stations_allocate_and_once() {
    let inputs = Case::table_1().inputs().expect("the built-in case is valid");
    assert!(solve(&inputs, Stages::ALL).is_ok(), "the fields are kept");
    let count = allocation_counter::measure(|| {
        black_box(solve(black_box(&inputs), Stages::ALL).is_ok());
    });
    assert_eq!(count.count_total, 1);
}
