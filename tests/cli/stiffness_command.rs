//! The command `stiffness`: its text, CSV and JSON, and gears without values.
use crate::program::{has, json, page, ran};

const HEADER: &str = "gear,radius [m],kuang_yang [m2/N],beam [m2/N],finite_element [m2/N],\
    contact_half_width [m],finite_element_surface [m2/N],neighbour_ahead [m2/N],\
    neighbour_behind [m2/N]";

/// Columns of the finite-element values.
const FIELD_COLUMNS: [usize; 4] = [4, 6, 7, 8];

/// The rows of the CSV without its header, and the lines on standard error.
fn csv(options: &str) -> (Vec<Vec<String>>, String) {
    let (code, text, errors) = ran(&format!("stiffness TABLE_1 {options} --format csv"));
    assert_eq!(code, 0, "{errors}");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(HEADER));
    let row = |line: &str| line.split(',').map(str::to_owned).collect();
    (lines.map(row).collect(), errors)
}

#[test]
fn text_of_table_1_fits_80_columns() {
    let text = page("stiffness TABLE_1");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    insta::assert_snapshot!("stiffness_zhou", text);
}

#[test]
fn csv_has_one_row_per_gear_and_radius_from_the_form_circle_to_the_tip() {
    let (rows, errors) = csv("--points 5");
    assert_eq!(errors, "");
    let gears: Vec<&str> = rows.iter().map(|row| row[0].as_str()).collect();
    assert_eq!(gears, [["driver"; 5].as_slice(), &["driven"; 5]].concat());
    let values: Vec<Vec<f64>> = rows
        .iter()
        .map(|row| row[1..].iter().map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert!((values[4][0] - 55e-3).abs() < 1e-15, "{}", values[4][0]);
    for pair in values[..5].windows(2) {
        assert!(pair[0][0] < pair[1][0] && pair[0][3] < pair[1][3], "{pair:?}");
    }
    for row in &values {
        let [depth, surface, ahead, behind] = FIELD_COLUMNS.map(|column| row[column - 1]);
        assert!(0.0 < ahead.abs() && ahead < depth && behind < depth && depth < surface);
    }
}

#[test]
fn json_agrees_with_the_csv() {
    let found = json("stiffness TABLE_1 --points 3 --format json");
    let (rows, _) = csv("--points 3");
    let gears = found["gears"].as_array().unwrap();
    let points = gears.iter().flat_map(|gear| gear["points"].as_array().unwrap());
    let names = HEADER.split(',').map(|name| name.split(' ').next().unwrap());
    let keys: Vec<&str> = names.skip(1).collect();
    assert_eq!(points.clone().count(), rows.len());
    for (point, row) in points.zip(&rows) {
        for (key, cell) in
            keys.iter().zip(&row[1..]).filter(|(key, _)| **key != "contact_half_width")
        {
            let (left, right) = (point[*key].as_f64().unwrap(), cell.parse::<f64>().unwrap());
            assert!((left / right - 1.0).abs() < 1e-15, "{key}: {left} {right}");
        }
    }
    assert!(gears.iter().all(|gear| gear["twist"].as_f64() > Some(0.0)));
}

#[test]
fn a_gear_outside_the_fit_has_empty_cells_and_the_other_gear_has_values() {
    let options = "--set driven.teeth=120 --points 3";
    let (rows, _) = csv(options);
    let is_empty: Vec<bool> = rows.iter().map(|row| row[2].is_empty()).collect();
    assert_eq!(is_empty, [false, false, false, true, true, true]);
    assert!(rows.iter().all(|row| !row[3].is_empty() && !row[4].is_empty()));
    let text = page(&format!("stiffness TABLE_1 {options}"));
    has(&text, &["no value by kuang-yang: covers z 12..100"]);
}

#[test]
fn a_gear_without_a_field_is_named_and_keeps_the_values_of_the_models() {
    let options = "--set driver.poisson=0.495 --points 3";
    let reason = "no finite-element values: Poisson's ratio is 0.495";
    let (rows, errors) = csv(options);
    let end = " and must be between 0 and 0.49\n";
    assert_eq!(errors, format!("cases/zhou-chen-2014.toml: driver: {reason}{end}"));
    for (index, row) in rows.iter().enumerate() {
        let is_driver = index < 3;
        assert!(!row[2].is_empty() && !row[3].is_empty());
        assert!(FIELD_COLUMNS.iter().all(|&column| row[column].is_empty() == is_driver));
    }
    has(&page(&format!("stiffness TABLE_1 {options}")), &[&format!("  - {reason}")]);
}

#[test]
fn a_wrong_number_of_points_and_a_refused_case_have_exit_codes() {
    for points in ["1", "-3", "many", "10001"] {
        let (code, text, errors) = ran(&format!("stiffness TABLE_1 --points {points}"));
        assert_eq!((code, text.as_str()), (2, ""), "{points}");
        has(&errors, &["from 2 to 10000"]);
    }
    let (code, text, errors) = ran("stiffness TABLE_1 --set 'driver.bore_radius=46 mm'");
    assert_eq!((code, text.as_str()), (3, ""));
    has(&errors, &["driver.bore_radius"]);
}
