//! Tests of places and greatest loads over the number of slices.

use crate::model::inputs::{Drive, Inputs, Method};
use crate::model::sample::standard_pair;
use crate::model::{Solution, Stage, Stages, solve};

#[test]
fn the_first_contact_is_between_slices_if_the_gap_is_least_there() {
    let mut inputs = standard_pair(20, 35, 3e-3);
    (inputs.method, inputs.drive) = (Method::Static, Drive::Torque(180.0));
    (inputs.driver.face_width, inputs.driven.face_width) = (25e-3, 25e-3);
    inputs.helix_angle = 20f64.to_radians();
    (inputs.driver.crowning, inputs.misalignment) = (15e-6, 32e-6);
    let [usual, many] = [None, Some(257)].map(|slices| {
        inputs.slices = slices;
        let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
        solution.face_load.unwrap().first
    });
    assert!(many.z.abs() < 12e-3, "inside the face: {many:?}");
    assert!((usual.z / many.z - 1.0).abs() < 5e-3, "{usual:?}, {many:?}");
    assert!((usual.path - many.path).abs() < 1e-6, "{usual:?}, {many:?}");
}

#[test]
fn greatest_loads_do_not_depend_on_the_number_of_slices() {
    let spur = || {
        let mut inputs = standard_pair(20, 35, 3e-3);
        (inputs.method, inputs.drive) = (Method::Static, Drive::Torque(180.0));
        (inputs.driver.face_width, inputs.driven.face_width) = (25e-3, 25e-3);
        inputs
    };
    let helical = |angle: f64| Inputs { helix_angle: angle.to_radians(), ..spur() };
    let [mut ends, mut tips, mut light] = [spur(), helical(20.0), helical(12.0)];
    (ends.driver.end_reliefs, ends.misalignment) = ([12e-6, 5e-6], 10e-6);
    (tips.driver.tip_relief, tips.driven.tip_relief) = (40e-6, 30e-6);
    (light.drive, light.misalignment) = (Drive::Torque(5.0), 25e-6);
    (light.driven.end_reliefs, light.driver.crowning) = ([20e-6, 0.0], 4e-6);
    for (name, pair) in [("end relief", ends), ("tip relief", tips), ("light load", light)] {
        let [usual, many] = [None, Some(513)].map(|slices| {
            let inputs = Inputs { slices, ..pair.clone() };
            solve(&inputs, Stages::of(Stage::StaticSpectrum).with(Stage::Static)).unwrap()
        });
        let values = |solution: &Solution| {
            let face = solution.face_load.as_ref().expect(name);
            let cycle = solution.face_cycle.as_ref().expect(name);
            let load = solution.static_load.as_ref().unwrap();
            let factor = cycle.peak_line_load / cycle.mean_line_load;
            [face.peak.line_load, factor, load.force_at_start, load.force_at_end]
        };
        for (of, other) in values(&usual).into_iter().zip(values(&many)) {
            assert!((of - other).abs() <= 5e-3 * other.abs(), "{name}: {of} and {other}");
        }
    }
}
