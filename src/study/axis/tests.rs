//! Ranges and lists as a user writes them.

use super::*;

fn texts(axis: &Axis) -> Vec<&str> {
    axis.points.iter().map(|point| point.text.as_str()).collect()
}

fn parsed(text: &str, points: usize) -> Axis {
    let sampling = Sampling { points: Some(points), is_log: false };
    Axis::parse(text, sampling).unwrap()
}

fn refused(text: &str, points: Option<usize>, is_log: bool) -> String {
    Axis::parse(text, Sampling { points, is_log }).unwrap_err().to_string()
}

#[test]
fn a_range_keeps_the_unit_that_was_given_first() {
    for (text, unit) in [
        ("operation.speed=500..1500 rpm", "rpm"),
        ("operation.speed=500 rpm..1500", "rpm"),
        ("operation.speed = 500 rpm .. 1500 rpm", "rpm"),
    ] {
        let axis = parsed(text, 5);
        assert_eq!((axis.key(), axis.unit.as_str()), ("operation.speed", unit));
        assert_eq!(texts(&axis), ["500", "750", "1000", "1250", "1500"]);
    }
    let mixed = parsed("deviations.base_pitch=0 um..0.04 mm", 3);
    assert_eq!((mixed.unit.as_str(), texts(&mixed)), ("um", vec!["0", "20", "40"]));
}

#[test]
fn every_point_has_the_value_of_its_text() {
    let axis = parsed("operation.speed=1/3..1000 rpm".replace("1/3", "0.3").as_str(), 37);
    for at in 0..axis.points.len() {
        let value = field_value(axis.field, &axis.with_unit(at)).unwrap();
        assert_eq!(value, axis.points[at].value);
    }
}

#[test]
fn steps_read_as_a_person_writes_them() {
    let axis = parsed("model.damping_ratio=0..1", 11);
    assert_eq!(
        texts(&axis),
        ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1"]
    );
    let sampling = Sampling { points: Some(4), is_log: true };
    let axis = Axis::parse("operation.torque=0.1..100 N m", sampling).unwrap();
    assert_eq!(texts(&axis), ["0.1", "1", "10", "100"]);
}

#[test]
fn lists_take_units_counts_and_choices() {
    let speeds = parsed("operation.speed=500,1000,2000 rpm", 0);
    assert_eq!((speeds.unit.as_str(), texts(&speeds)), ("rpm", vec!["500", "1000", "2000"]));
    assert_eq!(texts(&parsed("driven.teeth=20, 35", 0)), ["20", "35"]);
    assert_eq!(texts(&parsed("model.method=exact,static", 0)), ["exact", "static"]);
    assert_eq!(texts(&parsed("driven.tip_relief=16 um,0.02 mm", 0)), ["16", "20"]);
}

#[test]
fn a_list_accepts_auto_if_its_field_does() {
    let axis = parsed("model.stations=auto,32", 0);
    assert_eq!(texts(&axis), ["auto", "32"]);
    let stations = |at: usize| {
        let mut inputs = Inputs::default();
        axis.points[at].put(axis.field, &mut inputs);
        inputs.stations
    };
    assert_eq!([stations(0), stations(1)], [None, Some(32)]);
    assert!(refused("driver.teeth=auto,32", None, false).contains("`auto`"));
}

#[test]
fn neither_a_choice_nor_a_whole_number_has_a_crossing() {
    for text in ["model.method=exact,paper", "driver.teeth=18..21"] {
        let message = AxisRange::parse(text).unwrap_err().to_string();
        let fix = format!("has no crossing between its values: use sweep --vary '{text}'");
        assert!(message.ends_with(&fix), "{message}");
    }
}

#[test]
fn a_range_of_whole_numbers_has_every_one() {
    let axis = Axis::parse("driver.teeth=18..21", Sampling::default()).unwrap();
    assert_eq!(texts(&axis), ["18", "19", "20", "21"]);
    assert_eq!(texts(&parsed("driver.teeth=18..30", 3)), ["18", "24", "30"]);
    assert!(refused("driver.teeth=18..30", Some(4 + 2), false).contains("leave --points out"));
}

#[test]
fn a_bad_axis_gets_place_cause_and_fix() {
    for (text, points, is_log, part) in [
        (
            "operation.sped=1..2 rpm",
            None,
            false,
            "operation.sped: unknown key `operation.sped`: did you mean operation.speed?",
        ),
        (
            "operation.speed=3000..500 rpm",
            None,
            false,
            "operation.speed: the range is reversed: 3000 rpm is above 500 rpm: write \
                operation.speed=500 rpm..3000 rpm",
        ),
        ("operation.speed=500..500 rpm", None, false, "operation.speed: the range is empty"),
        (
            "operation.speed=500..3000 rpm",
            Some(0),
            false,
            "operation.speed: a range has 2 to 1000000 points, and not 0: write --points with a number from 2",
        ),
        ("operation.speed=500..3000 rpm", Some(1), false, "1000000 points, and not 1"),
        ("operation.speed=500..3000", None, false, "write \"500 rpm\""),
        ("operation.speed=500..3000 mm", None, false, "unit of length"),
        ("title=1..2", None, false, "title: title is a text"),
        ("=1..2", None, false, "=1..2: the key is missing: write KEY=FROM..TO"),
        (
            "model.method=paper..exact",
            None,
            false,
            "model.method: a choice has no range: write a list, such as model.method=paper,exact",
        ),
        ("model.method=exact,dinamic", None, false, "did you mean dynamic?"),
        ("driven.tip_relief=-10..40 um", None, false, "below the limit of 0 um"),
        ("driven.tip_relief=0..40 um", None, true, "--log needs a start above 0, and 0 um is not"),
        ("operation.speed", None, false, "no values are given: write KEY=FROM..TO"),
        ("driver.teeth=18.5..30", None, false, "whole number"),
    ] {
        let message = refused(text, points, is_log);
        assert!(message.contains(part), "{text}: {message}");
    }
}
