//! Series against the functions that they fit.

use super::*;

fn series<const N: usize>(from: f64, to: f64, f: impl Fn(f64) -> [f64; N]) -> Series<N> {
    Series::of(from, to, &|_, _| [1e-14; N], &|x| Ok::<_, ()>(f(x))).unwrap()
}

#[test]
fn smooth_functions_and_their_slopes_keep_their_digits() {
    let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp()]);
    for step in 0..=900 {
        let x = -2.0 + 0.01 * f64::from(step);
        let [sine, growth] = found.at(x);
        let slope = found.slope(0, x);
        assert!(
            (sine - x.sin()).abs() < 2e-14 && (growth / (0.3 * x).exp() - 1.0).abs() < 2e-14,
            "{x}"
        );
        assert!((slope - x.cos()).abs() < 1e-11, "{x}: {slope}");
        assert!((found.one(1, x) - growth).abs() == 0.0);
    }
    assert!((found.integral(0) - (2f64.cos() - 7f64.cos())).abs() < 1e-13);
}

#[test]
fn groups_on_the_same_pieces_are_the_series_of_their_functions() {
    let functions = |x: f64| [[x.sin(), (0.3 * x).exp()], [x.cos(), 1.0 / (3.0 + x)]];
    let found = Series::<2>::groups(-2.0, 7.0, &[[1e-14; 2]; 2], &|places, values| {
        for (at, &x) in places.iter().enumerate() {
            let [one, other] = functions(x);
            (values[0][at], values[1][at]) = (one, other);
        }
    });
    assert_eq!(found[0].pieces.len(), found[1].pieces.len());
    for step in 0..=90 {
        let x = -2.0 + 0.1 * f64::from(step);
        for (group, expected) in found.iter().zip(functions(x)) {
            let values: [f64; 2] = group.at(x);
            for (value, expected) in values.iter().zip(expected) {
                assert!((value - expected).abs() < 3e-14 * expected.abs().max(1.0), "{x}");
            }
        }
    }
}

#[test]
fn values_side_by_side_are_those_of_each_place_whatever_its_piece() {
    let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp(), x.cos()]);
    assert!(found.pieces.len() > 1);
    for (from, to) in [(-1.9, -1.8), (-2.0, 7.0), (6.0, 6.0)] {
        let places = std::array::from_fn(|at| to + (from - to) * at as f64 / 15.0);
        let [growth, cosine] = found.many(1, &places);
        for (at, x) in places.iter().enumerate() {
            let off = (growth.0[at] / (0.3 * x).exp() - 1.0).abs();
            assert!(off < 3e-14, "{x}: {off:e}");
            assert!((cosine.0[at] - x.cos()).abs() < 3e-14, "{x}");
        }
    }
}

#[test]
fn no_value_on_a_piece_is_beyond_its_bounds() {
    let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp()]);
    for step in 0..90 {
        let x = -2.0 + 0.1 * f64::from(step);
        let (low, high) = found.bounds(1, (x, 1e-12));
        let value = (0.3 * x).exp();
        assert!(low <= value && value <= high, "{x}: {low} {high}");
    }
}

#[test]
fn reversed_pieces_are_the_functions_from_the_other_end() {
    let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp()]);
    let turned = found.reversed(5.0, [1.0, -1.0]);
    assert!((turned.start() + 2.0).abs() < 1e-15);
    for step in 0..=90 {
        let x = -2.0 + 0.1 * f64::from(step);
        let [sine, growth] = turned.at(5.0 - x);
        let [expected_sine, expected_growth] = found.at(x);
        assert!((sine - expected_sine).abs() < 1e-14, "{x}");
        assert!((growth + expected_growth).abs() < 1e-14 * expected_growth, "{x}");
    }
}

#[test]
fn a_branch_point_at_the_end_costs_pieces_and_no_digits() {
    let found = series(0.0, 1.0, |x| [x.sqrt()]);
    assert!(found.pieces.len() < 50, "{}", found.pieces.len());
    for step in 0..=1000 {
        let x = 1e-3 * f64::from(step);
        let allowed = if step == 0 { 1e-5 } else { 1e-13 };
        assert!((found.one(0, x) - x.sqrt()).abs() < allowed, "{x}");
    }
}

#[test]
fn about_another_place_the_pieces_are_the_same_functions() {
    let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp(), x.abs()]);
    let mut x = -2.0;
    while x < 7.0 - 1e-9 {
        let length = found.serves_until(x, 1e-12).min(7.0).min(x + 0.7) - x;
        let [growth, distance] = found.local(1, (x, 1e-12), length);
        for part in [0.0, 0.3, 1.0] {
            let at = x + part * length;
            assert!((growth.at(part) / (0.3 * at).exp() - 1.0).abs() < 1e-13, "{at}");
            assert!((distance.at(part) - at.abs()).abs() < 1e-6, "{at}");
        }
        x += length;
    }
}

#[test]
fn a_place_beside_a_piece_as_narrow_as_rounding_has_the_value_of_its_end() {
    let (from, to) = (1.0, 1.0 + 4.0 * f64::EPSILON);
    assert_eq!(series(from, to, |x| [(1e20 * x).sin()]).pieces.len(), 1);
    let found = series(from, to, |x| [x, (1e20 * x).sin()]);
    for beside in [from - 100.0 * f64::EPSILON, to + 100.0 * f64::EPSILON] {
        let [line, rough] = found.at(beside);
        assert!((line - 1.0).abs() < 1e-13 && rough.abs() < 2.0, "{line} {rough}");
        let [rough] = found.local(1, (beside, 0.0), f64::EPSILON);
        assert!(rough.at(0.0).abs() < 2.0, "{rough:?}");
    }
}

#[test]
fn what_the_function_refuses_is_passed_on() {
    let refused = Series::of(0.0, 1.0, &|_, _| [1e-14], &|x| {
        if x > 0.5 { Err("beyond") } else { Ok([x]) }
    });
    assert_eq!(refused, Err("beyond"));
}
