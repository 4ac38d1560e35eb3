//! The range of a study: around the present value of a field, in the unit of the field's text.

use crate::case::dependencies::value_of;
use crate::case::fields::{FIELDS, Field, Kind, index_of};
use crate::case::units::{self, System};
use crate::case::{Case, Problem, field_range};
use crate::model::{Inputs, Quantity};
use crate::numeric::decimal::significant;
use crate::study::axis::{Axis, AxisRange, Sampling};
use crate::tui::rows;
use crate::tui::text::symbol;

/// Points of a curve over a range.
pub(crate) const CURVE_POINTS: usize = 101;
/// Relative difference of a point from the present value by rounding.
pub(crate) const SAME: f64 = 1e-5;
/// Greatest number of halvings or doublings of a range.
pub(crate) const MOST_ZOOM: i32 = 12;
/// Distance of both ends from the value, relative to the value.
const REACH: f64 = 0.5;
/// Distance of both ends from a length of 0 in um, relative to the module.
const REACH_OF_MODULE: f64 = 0.01;
/// Distance of both ends from a centre distance or a diameter, relative to the module: beyond it
/// most pairs have no contact or no room.
const REACH_OF_CIRCLE: f64 = 0.25;
/// Distance of both ends from a number of 0.
const REACH_OF_NUMBER: f64 = 0.5;
/// Distance of both ends from another value of 0, relative to the limits of the field.
const REACH_OF_LIMITS: f64 = 0.01;
/// Digits of the ends of a range.
const DIGITS: usize = 6;
/// Digits of a number that needs no rounding.
const SHORT: usize = 4;
/// Digits of round numbers; further digits are rounding errors.
const ROUND_DIGITS: usize = 14;

/// The points of a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Steps {
    /// A number of equal steps between the ends.
    Equal(usize),
    /// At most this many points with steps of few digits.
    Round(usize),
}

/// The state that ranges depend on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RangeOf<'a> {
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// The display units.
    pub(crate) units: System,
    /// Number of halvings of the range.
    pub(crate) zoom: i32,
}

impl RangeOf<'_> {
    /// The axis of a field.
    ///
    /// # Errors
    /// Returns the reason if the field has no range.
    pub(crate) fn axis(self, field: usize, steps: Steps) -> Result<Axis, String> {
        let known = &FIELDS[field];
        match known.kind {
            Kind::Text | Kind::List(_) => {
                Err(format!("{} is a text: go to a field with a value.", known.full_label()))
            }
            Kind::Choice(names, _) => {
                let text = format!("{}={}", known.key, names.join(","));
                let axis = Axis::parse(&text, Sampling::default());
                axis.map_err(|problem| worded(known, &problem.cause))
            }
            Kind::Number(..) => {
                let range = self.number_range(field);
                let now = value(self.case, field) / units::factor(&range.unit).unwrap_or(1.0);
                let axis =
                    |steps| Ok(with_present(stepped(&range, now, steps)?, &range, self.case));
                let found = match (axis(steps), steps) {
                    (Ok(found), Steps::Round(most)) if found.points.len() > most => {
                        axis(Steps::Round(most - 1))
                    }
                    (found, _) => found,
                };
                found.map_err(|problem: Problem| worded(known, &problem.cause))
            }
            Kind::Count(from, to, _) => {
                let range = count_range(self.case, field, self.zoom, (from, to));
                let axis = match steps {
                    Steps::Equal(_) => range.axis(Sampling::default()),
                    Steps::Round(most) => thinned(&range, value(self.case, field), most),
                };
                axis.map_err(|problem| worded(known, &problem.cause))
            }
        }
    }

    fn number_range(self, field: usize) -> AxisRange {
        let unit = self.unit(field);
        let factor = units::factor(&unit).unwrap_or(1.0);
        let value = value(self.case, field);
        let is_circle =
            ["centre_distance", "tip_diameter", "root_diameter"].contains(&FIELDS[field].name());
        let usual = match module(self.case) {
            Some(module) if is_circle => REACH_OF_CIRCLE * module,
            _ if value == 0.0 => around_zero(self.case, field),
            _ => REACH * value.abs(),
        };
        let reach = usual * 2f64.powi(-self.zoom.clamp(-MOST_ZOOM, MOST_ZOOM));
        let (least, most) = field_range(field);
        // A metric value is rarely round in inch units: the ends get two digits of the distance.
        let scale = 10f64.powi(1 - (reach / factor).log10().floor() as i32);
        let digits = |number: f64, count| significant(number, count).parse().unwrap_or(number);
        let greatest = (value + reach) / factor;
        let is_short = (digits(greatest, SHORT) / greatest - 1.0).abs() < SAME;
        let is_rounded = self.units == System::Inch && reach > 0.0 && !is_short;
        let rounded = |si: f64| {
            let is_limit = si <= least || si >= most;
            let number = si / factor;
            let number =
                if is_rounded && !is_limit { (number * scale).round() / scale } else { number };
            digits(number, DIGITS)
        };
        let end = |si: f64| {
            let number: f64 = rounded(si);
            // Rounding must not exceed the limits of the field.
            if number * factor < least || number * factor > most {
                units::in_unit(si.clamp(least, most), &unit)
            } else {
                number
            }
        };
        let (from, to) = (end((value - reach).max(least)), end((value + reach).min(most)));
        AxisRange { field, unit, from, to }
    }

    /// The unit of the value as written, otherwise the usual unit, or its inch unit if inches are
    /// shown.
    fn unit(self, field: usize) -> String {
        let usual = match FIELDS[field].kind {
            Kind::Number(_, range, _) => range.unit,
            _ => "",
        };
        let written = rows::written_unit(self.case, field);
        match written.as_deref().map(|unit| self.units.unit(unit)) {
            Some(unit) => unit.to_owned(),
            None => self.units.unit(usual).to_owned(),
        }
    }
}

/// The equal or round steps of a range.
fn stepped(range: &AxisRange, present: f64, steps: Steps) -> Result<Axis, Problem> {
    let points = match steps {
        Steps::Equal(points) => points,
        Steps::Round(most) => round(range, present, most),
    };
    range.axis(Sampling { points: Some(points.max(2)), is_log: false })
}

/// The axis with the present value of the field as one of its points.
fn with_present(mut axis: Axis, range: &AxisRange, case: &Case) -> Axis {
    let written = rows::written_unit(case, axis.field).unwrap_or_default();
    let is_written = case.value(axis.field).is_some() && written == range.unit;
    let digits = if is_written { ROUND_DIGITS } else { DIGITS };
    let rounded = |number: f64| significant(number, digits).parse::<f64>().unwrap_or(number);
    let Some(point) = present(&axis, case).and_then(|number| range.at(rounded(number)).ok()) else {
        return axis;
    };
    let Some(own) = point.number.map(rounded) else {
        return axis;
    };
    // A point that differs only by rounding is the present value.
    let rounding = own.abs() * 10f64.powi(1 - i32::try_from(digits).unwrap_or(0));
    let is_own = |number: f64| (number - own).abs() <= rounding;
    if axis.points.iter().any(|other| other.number.is_some_and(is_own)) {
        return axis;
    }
    let at = axis.points.partition_point(|other| other.number < Some(own));
    axis.points.insert(at, point);
    axis
}

/// The number of points of the whole range, at most `most` and at least half of that: one of them is the
/// present number if possible, and the steps have few digits.
fn round(range: &AxisRange, present: f64, most: usize) -> usize {
    let intervals = most.saturating_sub(1).max(1);
    let digits = |steps: usize| {
        let step = significant((range.to - range.from) / steps as f64, ROUND_DIGITS);
        step.trim_end_matches('0').trim_matches(['0', '.']).len()
    };
    let counts = intervals.div_ceil(2)..=intervals;
    let part = (present - range.from) / (range.to - range.from);
    let is_off = |steps: usize| {
        let place = part * steps as f64;
        (place - place.round()).abs() > SAME
    };
    1 + counts.rev().min_by_key(|&steps| (is_off(steps), digits(steps))).unwrap_or(1)
}

fn worded(field: &Field, cause: &str) -> String {
    format!("{}: {cause}.", field.full_label())
}

/// The number of a field in SI, given or derived.
fn number(case: &Case, field: usize) -> Option<f64> {
    case.value(field).or_else(|| {
        let (inputs, _) = case.read();
        let derived = case.derived(field, &inputs);
        derived.or_else(|| without_backlash(field, &inputs))
    })
}

/// For the field of the centre distance: the centre distance without backlash, in m.
fn without_backlash(field: usize, inputs: &Inputs) -> Option<f64> {
    let quantity = Quantity::find(FIELDS[field].name())?;
    (quantity.key == "centre_distance").then(|| value_of(quantity, inputs)).flatten()
}

/// The present value in SI: as written, otherwise the default or an example.
fn value(case: &Case, field: usize) -> f64 {
    let known = &FIELDS[field];
    let example = || match known.kind {
        Kind::Number(dimension, range, _) => {
            units::parse(known.example(), dimension, range.unit).ok()
        }
        _ => known.example().parse().ok(),
    };
    number(case, field).or_else(example).unwrap_or(0.0)
}

fn module(case: &Case) -> Option<f64> {
    number(case, index_of("pair.module")?)
}

fn around_zero(case: &Case, field: usize) -> f64 {
    let (least, most) = field_range(field);
    let limits = REACH_OF_LIMITS * (most - least);
    match FIELDS[field].kind {
        Kind::Number(_, range, _) if range.unit == "um" => {
            module(case).map_or(limits, |module| REACH_OF_MODULE * module)
        }
        Kind::Number(_, range, _) if range.unit.is_empty() => REACH_OF_NUMBER,
        _ => limits,
    }
}

fn count_range(case: &Case, field: usize, zoom: i32, (least, most): (u32, u32)) -> AxisRange {
    const REACH: f64 = 10.0;
    let value = value(case, field).clamp(least.into(), most.into());
    let reach = (REACH * 2f64.powi(-zoom.clamp(-MOST_ZOOM, MOST_ZOOM))).round();
    let reach = reach.clamp(1.0, (CURVE_POINTS / 2) as f64);
    AxisRange {
        field,
        unit: String::new(),
        from: (value - reach).max(least.into()),
        to: (value + reach).min(most.into()),
    }
}

/// At most `most` whole numbers of a range, but its ends and the present number in any case.
fn thinned(range: &AxisRange, present: f64, most: usize) -> Result<Axis, Problem> {
    let [from, to, present] = [range.from, range.to, present].map(|number| number as u32);
    let numbers = |step: u32| {
        let is_point = |number: &u32| {
            [from, to].contains(number) || number.abs_diff(present).is_multiple_of(step)
        };
        (from..=to).filter(is_point).map(|number| number.to_string()).collect::<Vec<_>>()
    };
    let mut all = (1..=to).map(numbers);
    let numbers = all.find(|numbers| numbers.len() <= most.max(3)).unwrap_or_default();
    Axis::parse(&format!("{}={}", FIELDS[range.field].key, numbers.join(",")), Sampling::default())
}

/// Greatest number of points of typed ranges.
const MOST_POINTS: usize = 20_000;
/// Number of points of each of two typed ranges.
const POINTS_OF_MAP: usize = 31;

/// The axes of a typed text such as `1000..3000 rpm, 31 points`, or of two such ranges separated by a
/// semicolon: that of the curve, then the second one. `KEY =` names another field than `fields`.
/// Numbers without a unit get that of the study.
///
/// # Errors
/// Returns the reason if the text is not valid.
pub(crate) fn typed_axes(
    of: RangeOf<'_>,
    fields: [Option<usize>; 2],
    text: &str,
) -> Result<Vec<Axis>, String> {
    let parts: Vec<&str> = text.split(';').map(str::trim).filter(|part| !part.is_empty()).collect();
    if parts.is_empty() || parts.len() > 2 {
        return Err("type a range such as 50..200 rpm, or two with a semicolon between".to_owned());
    }
    let usual = (parts.len() == 2).then_some(POINTS_OF_MAP);
    let axis = |(part, field): (&&str, Option<usize>)| {
        if part.matches("..").count() > 1 {
            return Err(format!("{part}: a semicolon separates two ranges"));
        }
        let key = || field.map(|field| FIELDS[field].key);
        let (key, mut values) = match part.split_once('=') {
            Some((key, values)) => (named(key.trim()), values),
            None => (key().ok_or("name the field: KEY = FROM..TO")?, *part),
        };
        let mut sampling = Sampling::default();
        while let Some((rest, word)) = last_word(values) {
            values = match word {
                "log" => {
                    sampling.is_log = true;
                    rest
                }
                "points" => {
                    let counted =
                        last_word(rest).and_then(|(rest, count)| Some((rest, count.parse().ok()?)));
                    let (rest, count) = counted.ok_or("type a number before points")?;
                    sampling.points = Some(count);
                    rest
                }
                _ => break,
            };
            values = values.trim_end_matches([',', ' ']);
        }
        if let Some((range, count)) = last_word(values)
            && range.split_once("..").is_some_and(|(_, to)| to.contains(char::is_alphabetic))
            && count.parse::<usize>().is_ok()
        {
            let range = range.trim_end_matches([',', ' ']);
            return Err(format!(
                "{count} is no unit: for {count} points type {range}, {count} points"
            ));
        }
        if let Some(count) = sampling.points.filter(|count| *count > MOST_POINTS) {
            return Err(too_many(count));
        }
        let is_bare = !values.contains(char::is_alphabetic);
        let unit = index_of(key).filter(|_| is_bare).map_or(String::new(), |at| of.unit(at));
        let text = format!("{key}={} {unit}", values.trim_end());
        let is_count = index_of(key).is_some_and(|at| matches!(FIELDS[at].kind, Kind::Count(..)));
        if Axis::is_range(&text) && !is_count {
            sampling.points = sampling.points.or(usual);
        }
        Axis::parse(text.trim_end(), sampling).map_err(|problem| problem.for_form().to_string())
    };
    let axes = parts.iter().zip(fields).map(axis).collect::<Result<Vec<_>, String>>()?;
    let count: usize = axes.iter().map(|axis| axis.points.len()).product();
    if count > MOST_POINTS { Err(too_many(count)) } else { Ok(axes) }
}

/// The text before its last word, and this word; commas and blanks separate words.
fn last_word(text: &str) -> Option<(&str, &str)> {
    text.trim_end().rsplit_once([',', ' '])
}

/// The key of the only field with this symbol, or with this last part of its key.
fn named(name: &str) -> &str {
    let is_named = |field: &&Field| {
        [symbol(field.symbol, true), field.symbol.into(), field.name().into()]
            .contains(&name.into())
    };
    let mut fields = FIELDS.iter().filter(is_named);
    match (fields.next(), fields.next()) {
        (Some(field), None) => field.key,
        _ => name,
    }
}

fn too_many(count: usize) -> String {
    format!("{count} points are more than {MOST_POINTS}: type fewer points")
}

/// The argument of `--vary` that gives an axis, with or without `--log`, and its number of points if it
/// is a range.
pub(crate) fn vary(axis: &Axis, is_log: bool) -> (String, Option<usize>) {
    let (count, key) = (axis.points.len(), axis.key());
    let first = axis.points.first().map_or("", |point| point.text.as_str());
    let range = format!("{key}={first}..{}", axis.with_unit(count - 1));
    let sampling = Sampling { points: Some(count), is_log };
    if count > 1 && Axis::parse(&range, sampling).as_ref() == Ok(axis) {
        return (range, Some(count));
    }
    let texts: Vec<&str> = axis.points.iter().map(|point| point.text.as_str()).collect();
    (format!("{key}={} {}", texts.join(","), axis.unit).trim_end().to_owned(), None)
}

/// An axis as the user would type it: a curve without the present value between its equal steps.
pub(crate) fn typed(axis: &Axis) -> String {
    let without = |at: usize| {
        let mut equal = axis.clone();
        equal.points.remove(at);
        Some(vary(&equal, false)).filter(|(_, count)| count.is_some())
    };
    let present = Some(axis.points.len()).filter(|count| *count == CURVE_POINTS + 1);
    let steps = present.and_then(|count| (1..count - 1).find_map(without));
    let (text, count) = steps.unwrap_or_else(|| vary(axis, axis.is_log));
    let text = text.replacen('=', " = ", 1);
    let log = if axis.is_log { ", log" } else { "" };
    count.map_or(text.clone(), |count| format!("{text}, {count} points{log}"))
}

/// The point of an axis nearest to the present value of its field.
pub(crate) fn nearest(axis: &Axis, case: &Case) -> Option<usize> {
    if let Some(number) = present(axis, case) {
        let distance = |at: &usize| {
            let own = axis.points[*at].number.unwrap_or(f64::INFINITY);
            (own - number).abs()
        };
        let points = 0..axis.points.len();
        return points.min_by(|one, other| distance(one).total_cmp(&distance(other)));
    }
    let text = case.effective(axis.field)?;
    axis.points.iter().position(|point| point.text == text)
}

/// The present value of the field, in the unit of the axis.
pub(crate) fn present(axis: &Axis, case: &Case) -> Option<f64> {
    let factor = units::factor(&axis.unit).unwrap_or(1.0);
    Some(number(case, axis.field)? / factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range_of(case: &Case, zoom: i32) -> RangeOf<'_> {
        let units = System::Metric;
        RangeOf { case, units, zoom }
    }

    fn ends(key: &str, zoom: i32) -> (String, String) {
        let field = index_of(key).expect("a field");
        let axis =
            range_of(&Case::table_1(), zoom).axis(field, Steps::Equal(101)).expect("a range");
        (axis.with_unit(0), axis.with_unit(axis.points.len() - 1))
    }

    #[test]
    fn a_range_is_around_the_value_in_its_unit_and_inside_the_limits() {
        for (key, zoom, from, to) in [
            ("operation.speed", 0, "1000 rpm", "3000 rpm"),
            ("operation.speed", 1, "1500 rpm", "2500 rpm"),
            ("deviations.base_pitch", 0, "8 um", "24 um"),
            ("driven.tip_relief", 0, "0 um", "50 um"),
            ("driver.profile_shift", 0, "-0.5", "0.5"),
            ("pair.centre_distance", 0, "98.75 mm", "101.25 mm"),
            ("driver.poisson", -3, "0", "0.499"),
            ("driver.teeth", 0, "10", "30"),
            ("driver.teeth", -9, "5", "70"),
        ] {
            assert_eq!(ends(key, zoom), (from.to_owned(), to.to_owned()), "{key} {zoom}");
        }
    }

    #[test]
    fn a_typed_range_has_its_points_and_is_written_as_typed() {
        let case = Case::table_1();
        let (of, torque) = (range_of(&case, 0), index_of("operation.torque"));
        let relief = "driven.tip_relief = 0..50 um";
        for (text, expected) in [
            ("50..200 N m", "operation.torque = 50..200 N m, 101 points"),
            ("50..200 N m, 31 points", "operation.torque = 50..200 N m, 31 points"),
            ("50, 80, 200", "operation.torque = 50,80,200 N m"),
            ("driver.teeth = 18..22", "driver.teeth = 18..22, 5 points"),
            ("1..100 N m, 3 points, log", "operation.torque = 1..100 N m, 3 points, log"),
            ("f_pb1 = 0..10 um, 3 points", "driver.base_pitch = 0..10 um, 3 points"),
            ("zeta = 0..0.1, 3 points", "model.damping_ratio = 0..0.1, 3 points"),
            ("torque = 50..80, 3 points", "operation.torque = 50..80 N m, 3 points"),
        ] {
            let axes = typed_axes(of, [torque, None], text).expect("a range");
            assert_eq!(typed(&axes[0]), expected);
            assert_eq!(typed_axes(of, [None, None], expected).expect("a range"), axes);
        }
        let map = typed_axes(of, [torque, None], &format!("50..200; {relief}")).expect("a map");
        assert_eq!(map.iter().map(|axis| axis.points.len()).collect::<Vec<_>>(), [31, 31]);
        for wrong in ["", "200..50 N m", "50..200 mm", "50..200, x points", "q=1..2", "1;2;3"] {
            assert!(typed_axes(of, [torque, None], wrong).is_err(), "{wrong}");
        }
        assert!(typed_axes(of, [torque, None], "50..200 N m, 30000 points").is_err());
        let comma = typed_axes(of, [torque, None], &format!("50..200 N m, {relief}"));
        assert!(comma.is_err_and(|reason| reason.contains("semicolon")));
        let damping = index_of("model.damping_ratio");
        let wrong = typed_axes(of, [damping, None], "100..400 N m").expect_err("a wrong unit");
        assert!(wrong.ends_with("write a range within 0..2"), "{wrong}");
    }

    #[test]
    fn the_range_of_a_curve_is_typed_as_its_ends_and_points() {
        for (key, text, units, expected) in [
            ("driver.face_width", "30 mm", System::Inch, "0.59..1.77 in, 101 points"),
            ("operation.torque", "885.075 lbf in", System::Inch, "440..1330 lbf in, 101 points"),
            ("operation.torque", "100 N m", System::Inch, "37..111 lbf ft, 101 points"),
            ("pair.module", "0.125 in", System::Inch, "0.0625..0.1875 in, 101 points"),
            ("pair.pressure_angle", "20 deg", System::Inch, "14.5..30 deg, 101 points"),
            ("pair.pressure_angle", "20 deg", System::Metric, "14.5..30 deg, 101 points"),
        ] {
            let mut case = Case::table_1();
            case.set(key, text).expect("a value");
            let range = RangeOf { units, ..range_of(&case, 0) };
            let field = index_of(key).expect("a field");
            let axis = range.axis(field, Steps::Equal(CURVE_POINTS)).expect("a range");
            assert_eq!(typed(&axis), format!("{key} = {expected}"));
        }
    }

    #[test]
    fn a_map_has_the_whole_range_in_round_steps_for_any_number_of_cells() {
        let case = Case::table_1();
        for (key, zoom, most, expected) in [
            ("operation.speed", 0, 30, ["1000 rpm", "1100 rpm", "3000 rpm"]),
            ("operation.speed", 0, 60, ["1000 rpm", "1040 rpm", "3000 rpm"]),
            ("operation.speed", 2, 30, ["1750 rpm", "1775 rpm", "2250 rpm"]),
            ("driven.tip_relief", 0, 60, ["0 um", "1 um", "50 um"]),
            ("driver.teeth", 0, 30, ["10", "11", "30"]),
            ("driver.teeth", 0, 8, ["10", "12", "30"]),
        ] {
            let field = index_of(key).expect("a field");
            let axis = range_of(&case, zoom).axis(field, Steps::Round(most)).expect("a range");
            let last = axis.points.len() - 1;
            assert!(last < most, "{key}: {last}");
            assert_eq!([0, 1, last].map(|at| axis.with_unit(at)), expected, "{key}");
        }
    }

    #[test]
    fn every_field_with_a_value_has_a_range_at_every_zoom() {
        let case = Case::table_1();
        for (at, field) in FIELDS.iter().enumerate() {
            for zoom in [-MOST_ZOOM, -1, 0, 5, MOST_ZOOM] {
                for points in [2, 30, 101] {
                    for steps in [Steps::Equal(points), Steps::Round(points)] {
                        let found = range_of(&case, zoom).axis(at, steps);
                        assert_eq!(
                            found.is_err(),
                            matches!(field.kind, Kind::Text | Kind::List(_)),
                            "{found:?}"
                        );
                    }
                }
            }
        }
    }
}
