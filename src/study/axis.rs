//! Varied fields with their values in the user's unit and in SI, and the grid of a sweep over them.

use crate::case::fields::{AUTO, FIELDS, Field, Kind, Range, Value, index_of, keeps_gears};
use crate::case::units::{self, Dimension};
use crate::case::{Case, Problem, field_value, unknown_key};
use crate::model::Inputs;
use crate::model::inputs::Method;
use crate::numeric::decimal::{rounded, shortest};
use crate::study::batch::{Points, Writer, with_unit};

/// Default number of points of a range.
pub const USUAL_POINTS: usize = 101;

/// Greatest number of points of a range.
pub const MOST_POINTS: usize = 1_000_000;

/// A varied field and its values, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Index in [`FIELDS`].
    pub field: usize,
    /// Other fields with the same values.
    pub also: Vec<usize>,
    /// The unit in which the user gave the values; empty for a bare number or a choice.
    pub unit: String,
    /// The values.
    pub points: Vec<AxisPoint>,
    /// Whether they have equal ratios.
    pub is_log: bool,
}

/// One value of a varied field.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisPoint {
    /// The value in the unit of the axis, or the name of a choice or "auto".
    pub text: String,
    /// The number in the unit of the axis; `None` for a choice or "auto".
    pub number: Option<f64>,
    value: Value,
}

/// How the points of a range are distributed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sampling {
    /// Number of points; by default [`USUAL_POINTS`], or every whole number of the range.
    pub points: Option<usize>,
    /// Equal ratios instead of equal steps.
    pub is_log: bool,
}

impl AxisPoint {
    fn at(number: f64, unit: &str, field: usize) -> Result<AxisPoint, Problem> {
        let text = shortest(number);
        let value = field_value(field, &with_unit(&text, unit))?;
        Ok(AxisPoint { text, number: Some(number), value })
    }

    fn named(name: &str, field: usize) -> Result<AxisPoint, Problem> {
        Ok(AxisPoint { text: name.to_owned(), number: None, value: field_value(field, name)? })
    }

    /// Writes the value into the inputs of a model.
    pub fn put(&self, field: usize, inputs: &mut Inputs) {
        FIELDS[field].put(self.value, inputs);
    }
}

impl Axis {
    /// Parses a text such as `operation.speed=500..3000 rpm`, `driven.teeth=20,30,40` or, for two
    /// fields with the same values, `driver.grade,driven.grade=5..9`.
    ///
    /// # Errors
    /// Returns an error if the field does not exist or does not accept the values, if the range is
    /// reversed or empty, or if the number of points does not suit the range.
    pub fn parse(text: &str, sampling: Sampling) -> Result<Axis, Problem> {
        let (keys, values) = text.split_once('=').unwrap_or((text, ""));
        if let Some((first, others)) = keys.split_once(',') {
            let mut axis = Axis::parse(&format!("{first}={values}"), sampling)?;
            for key in others.split(',').map(str::trim) {
                let field = index_of(key).ok_or_else(|| unknown_key(key))?;
                for (at, point) in axis.points.iter().enumerate() {
                    if field_value(field, &axis.with_unit(at))? != point.value {
                        let cause = format!("{key} is of another kind than {}", axis.key());
                        return Err(Problem::new(key, cause, "vary it with its own --vary"));
                    }
                }
                axis.also.push(field);
            }
            return Ok(axis);
        }
        let (field, values) = assignment(text)?;
        if values.contains(TO) {
            return AxisRange::of(field, values)?.axis(sampling);
        }
        let known = &FIELDS[field];
        let is_name = |item: &str| {
            matches!(known.kind, Kind::Choice(..)) || known.takes_auto() && item == AUTO
        };
        let items = || values.split(',').map(str::trim);
        let unit = unit_of(known, items().filter(|item| !is_name(item)))?;
        let point = |item: &str| {
            if is_name(item) {
                return AxisPoint::named(item, field);
            }
            AxisPoint::at(number_in(field, item, &unit)?, &unit, field)
        };
        let points = items().map(point).collect::<Result<_, _>>()?;
        Ok(Axis { field, also: Vec::new(), unit, points, is_log: false })
    }

    /// Whether a text is a range, so that a number of points applies.
    pub fn is_range(text: &str) -> bool {
        text.split_once('=').is_some_and(|(_, values)| values.contains(TO))
    }

    /// The key of the field.
    pub fn key(&self) -> &'static str {
        FIELDS[self.field].key
    }

    /// Every field of the axis.
    pub fn fields(&self) -> impl Iterator<Item = usize> {
        [self.field].into_iter().chain(self.also.iter().copied())
    }

    /// The value at an index with its unit, in the syntax of `--set`.
    pub fn with_unit(&self, at: usize) -> String {
        with_unit(&self.points[at].text, &self.unit)
    }
}

/// A range of a varied field, in the unit in which the user gave it.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisRange {
    /// Index in [`FIELDS`].
    pub field: usize,
    /// The unit; empty for a bare number.
    pub unit: String,
    /// The start of the range, in that unit.
    pub from: f64,
    /// The end of the range, in that unit.
    pub to: f64,
}

impl AxisRange {
    /// Parses a text such as `operation.speed=500..3000 rpm`.
    ///
    /// # Errors
    /// As [`Axis::parse`]; also if the text is not the range of a number field.
    pub fn parse(text: &str) -> Result<AxisRange, Problem> {
        let (field, values) = assignment(text)?;
        let Field { key, kind, .. } = &FIELDS[field];
        let uncrossed = match kind {
            Kind::Choice(..) => "a choice",
            Kind::Count(..) => "a whole number",
            _ if values.contains(TO) => return AxisRange::of(field, values),
            _ => {
                let fix = format!("write {key}=FROM..TO");
                return Err(Problem::new(key, "this is not a range", fix));
            }
        };
        let cause = format!("{uncrossed} has no crossing between its values");
        Err(Problem::new(key, cause, format!("use sweep --vary '{key}={values}'")))
    }

    fn of(field: usize, values: &str) -> Result<AxisRange, Problem> {
        let known = &FIELDS[field];
        let key = known.key;
        if let Kind::Choice(names, _) = known.kind {
            let fix = format!("write a list, such as {key}={}", names.join(","));
            return Err(Problem::new(key, "a choice has no range", fix));
        }
        let (from, to) = values.split_once(TO).unwrap_or((values, ""));
        let unit = unit_of(known, [from, to])?;
        let limits = known.range().filter(|_| !unit.is_empty());
        let end = |end| number_in(field, end, &unit).map_err(|problem| within(problem, limits));
        let [from, to] = [end(from)?, end(to)?];
        let [first, last] = [from, to].map(|end| with_unit(&shortest(end), &unit));
        let (cause, fix) = if from < to {
            return Ok(AxisRange { field, unit, from, to });
        } else if from > to {
            let cause = format!("the range is reversed: {first} is above {last}");
            (cause, format!("write {key}={last}..{first}"))
        } else {
            let cause = "the range is empty: both ends are equal".to_owned();
            (cause, format!("write {key}={first} for one value"))
        };
        Err(Problem::new(key, cause, fix))
    }

    /// The point at a number in the unit of the range.
    ///
    /// # Errors
    /// Returns an error if the field does not accept the value.
    pub fn at(&self, number: f64) -> Result<AxisPoint, Problem> {
        AxisPoint::at(number, &self.unit, self.field)
    }

    /// The points of the range.
    ///
    /// # Errors
    /// Returns an error if there are fewer than 2 points, if the points do not fall on whole
    /// numbers as the field requires, or if a logarithmic range begins at 0 or below.
    pub fn axis(&self, Sampling { points, is_log }: Sampling) -> Result<Axis, Problem> {
        let Field { key, kind, .. } = &FIELDS[self.field];
        let refused = |cause: String, fix: String| Err(Problem::new(key, cause, fix));
        let mut count = points.unwrap_or(USUAL_POINTS);
        if matches!(kind, Kind::Count(..)) {
            let span = (self.to - self.from) as usize;
            count = points.unwrap_or(span + 1);
            if is_log {
                let fix = format!("write a list, such as {key}=20,40,80");
                return refused("--log gives no whole numbers".to_owned(), fix);
            }
            if count >= 2 && !span.is_multiple_of(count - 1) {
                let all = span + 1;
                return refused(
                    format!("{count} points do not fall on whole numbers"),
                    format!("leave --points out for all {all} values, or write a list"),
                );
            }
        }
        if !(2..=MOST_POINTS).contains(&count) {
            return refused(
                format!("a range has 2 to {MOST_POINTS} points, and not {count}"),
                format!("write --points with a number from 2 to {MOST_POINTS}"),
            );
        }
        if is_log && self.from <= 0.0 {
            let from = with_unit(&shortest(self.from), &self.unit);
            return refused(
                format!("--log needs a start above 0, and {from} is not"),
                "start the range above 0, or leave --log out".to_owned(),
            );
        }
        let last = count - 1;
        let number = |index: usize| {
            let (from, to, part) = (self.from, self.to, index as f64 / last as f64);
            match index {
                0 => from,
                _ if index == last => to,
                // Decades of a range of decades are exact.
                _ if is_log => {
                    let [low, high] = [from, to].map(f64::log10);
                    rounded(10f64.powf(low + (high - low) * part))
                }
                _ => rounded(from + (to - from) * index as f64 / last as f64),
            }
        };
        let points = (0..count).map(|index| self.at(number(index))).collect::<Result<_, _>>()?;
        Ok(Axis { field: self.field, also: Vec::new(), unit: self.unit.clone(), points, is_log })
    }
}

/// The sign between the ends of a range.
const TO: &str = "..";

/// Splits `KEY=VALUES` into the index of the field and the values.
fn assignment(text: &str) -> Result<(usize, &str), Problem> {
    const FIX: &str = "write KEY=FROM..TO or KEY=A,B,C, such as 'operation.speed=500..3000 rpm'";
    let unwritten = |cause: &str| Problem::new(text, cause, FIX);
    let (key, values) = text.split_once('=').ok_or_else(|| unwritten("no values are given"))?;
    let key = key.trim();
    if key.is_empty() {
        return Err(unwritten("the key is missing"));
    }
    let field = index_of(key).ok_or_else(|| unknown_key(key))?;
    if let Kind::Text = FIELDS[field].kind {
        let cause = format!("{key} is a text and has no values to vary");
        let fix = "vary a field with a value; `tipstrike fields` lists every key";
        return Err(Problem::new(key, cause, fix));
    }
    let values = values.trim();
    match with_other_sign(values) {
        Some((from, to)) => {
            let cause = format!("the ends of a range have `{TO}` between them");
            Err(Problem::new(key, cause, format!("write {key}={from}{TO}{to}")))
        }
        None => Ok((field, values)),
    }
}

/// The ends of a range with another sign, such as `50-250 N m` or `50...250 N m`.
fn with_other_sign(values: &str) -> Option<(&str, &str)> {
    let ends = ["...", "…", " to ", "–", "-"].iter().find_map(|sign| values.split_once(sign));
    let (from, to) = ends.map(|(from, to)| (from.trim(), to.trim()))?;
    let is_number = |end: &str| end.starts_with(|first: char| first.is_ascii_digit());
    let is_exponent = from.ends_with(['e', 'E']);
    let is_whole = !from.contains(TO) && !to.contains(TO);
    (is_number(from) && is_number(to) && !is_exponent && is_whole).then_some((from, to))
}

/// The first unit among the values, which applies to values without a unit.
fn unit_of<'t>(
    field: &Field,
    values: impl IntoIterator<Item = &'t str>,
) -> Result<String, Problem> {
    for value in values {
        let split = units::split(value, field.usual_unit());
        let (_, unit) = split.map_err(|error| error.at(field.key))?;
        if !unit.is_empty() {
            return Ok(unit.to_owned());
        }
    }
    Ok(String::new())
}

/// The problem of an end of a range with a unit; its fix is a range that the field accepts.
fn within(problem: Problem, limits: Option<Range>) -> Problem {
    let Some(limits) = limits else { return problem };
    let [from, to] = [limits.from, limits.to].map(shortest);
    let to = with_unit(&to, limits.unit);
    Problem { fix: format!("write a range within {from}..{to}"), ..problem }
}

/// The value in `unit`; a bare number is already in that unit.
fn number_in(field: usize, value: &str, unit: &str) -> Result<f64, Problem> {
    let (number, own) = units::split(value, FIELDS[field].usual_unit()).unwrap_or((value, ""));
    let is_bare = own.is_empty();
    let text = if is_bare { with_unit(number, unit) } else { value.trim().to_owned() };
    let plain = |number| units::parse(number, Dimension::Number, "").unwrap_or_default();
    Ok(match field_value(field, &text)? {
        Value::Number(si) if !is_bare && own != unit => {
            let converted = units::text(si, unit);
            units::split(&converted, "").map_or(si, |(number, _)| plain(number))
        }
        Value::Number(_) => plain(number),
        Value::Count(count) => f64::from(count),
        _ => 0.0,
    })
}

/// Greatest number of points of a sweep.
pub const MOST_SWEPT: usize = 100_000_000;

/// How deviations add if [`add_by_sign`].
pub const ADDED: &str = "Where the base pitch deviations of the gears are of unlike sign, they add as \
    a sum, and elsewhere as sqrt(f_pb1^2 + f_pb2^2)";

/// Whether the base pitch deviations of a point add as a sum only because of their signs.
pub fn add_by_sign(axes: &[Axis], inputs: &Inputs) -> bool {
    let varies_them = |axis: &Axis| {
        let mut names = axis.fields().map(|field| FIELDS[field].name());
        names.any(|name| matches!(name, "base_pitch" | "grade" | "combination"))
    };
    let Some(at) = axes.iter().position(varies_them) else {
        return inputs.effective_combination() != inputs.combination;
    };
    axes[at].points.iter().any(|point| {
        let mut inputs = inputs.clone();
        axes[at].fields().for_each(|field| point.put(field, &mut inputs));
        add_by_sign(&axes[at + 1..], &inputs)
    })
}

/// The grid of a sweep. The first axis varies slowest.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// The varied fields.
    pub axes: Vec<Axis>,
}

impl Grid {
    /// A grid over axes.
    ///
    /// # Errors
    /// Returns an error if two axes vary one field, or fields that exclude each other.
    pub fn of(axes: Vec<Axis>) -> Result<Grid, Problem> {
        for (at, axis) in axes.iter().enumerate() {
            apart(&axes[..at], axis)?;
        }
        Ok(Grid { axes })
    }

    /// Parses texts such as `operation.speed=500..3000 rpm`. `points` has one number for all
    /// ranges, or one for each range in order.
    ///
    /// # Errors
    /// Returns the invalid text and its problem.
    pub fn parse<'t>(
        texts: &'t [String],
        points: &[usize],
        is_log: bool,
    ) -> Result<Grid, (&'t str, Problem)> {
        let mut axes: Vec<Axis> = Vec::new();
        let (mut ranges, mut count) = (0, 1_usize);
        for text in texts {
            let points = if points.len() == 1 { points.first() } else { points.get(ranges) };
            let sampling = Sampling { points: points.copied(), is_log };
            ranges += usize::from(Axis::is_range(text));
            let axis = Axis::parse(text, sampling)
                .and_then(|axis| apart(&axes, &axis).map(|()| axis))
                .map_err(|problem| (text.as_str(), problem))?;
            count = count.saturating_mul(axis.points.len());
            axes.push(axis);
        }
        let problem = if points.len() > 1 && points.len() != ranges {
            let cause = format!("--points is given {} times for {ranges} ranges", points.len());
            Problem::new("--points", cause, "give it once for all ranges, or once for each")
        } else if count > MOST_SWEPT {
            let cause = format!("the grid has more than {MOST_SWEPT} points");
            Problem::new(axes.last().map_or("", Axis::key), cause, "write fewer --points")
        } else {
            return Ok(Grid { axes });
        };
        Err((texts.last().map_or("", String::as_str), problem))
    }

    /// The axes of a point with the index of its value on each axis.
    pub fn places(&self, index: usize) -> impl Iterator<Item = (&Axis, usize)> {
        let mut step = self.count();
        let mut rest = index;
        self.axes.iter().map(move |axis| {
            step /= axis.points.len();
            let at = rest / step;
            rest %= step;
            (axis, at)
        })
    }

    /// Every method of the points.
    pub fn methods(&self, inputs: &Inputs) -> Vec<Method> {
        let Some(axis) = self.axes.iter().find(|axis| axis.key() == "model.method") else {
            return vec![inputs.method];
        };
        let of = |point: &AxisPoint| {
            let mut inputs = inputs.clone();
            point.put(axis.field, &mut inputs);
            inputs.method
        };
        axis.points.iter().map(of).collect()
    }
}

impl Points for Grid {
    fn count(&self) -> usize {
        self.axes.iter().map(|axis| axis.points.len()).product()
    }

    /// The varied fields in their units.
    fn columns(&self) -> Vec<(String, &str)> {
        let of = |axis| {
            let axis: &Axis = axis;
            axis.fields().map(|field| (FIELDS[field].key.to_owned(), axis.unit.as_str()))
        };
        self.axes.iter().flat_map(of).collect()
    }

    fn cells(&self, index: usize) -> Vec<String> {
        let of = |(axis, at): (&Axis, usize)| {
            let text = axis.points[at].text.clone();
            vec![text; 1 + axis.also.len()]
        };
        self.places(index).flat_map(of).collect()
    }

    fn have_same_gears(&self) -> bool {
        self.axes.iter().flat_map(Axis::fields).all(keeps_gears)
    }

    fn writer(&self) -> Writer<'_> {
        Box::new(|index, inputs| {
            for (axis, at) in self.places(index) {
                axis.fields().for_each(|field| axis.points[at].put(field, inputs));
            }
            Ok(())
        })
    }
}

/// Checks that an axis varies other fields than the previous axes.
fn apart(others: &[Axis], axis: &Axis) -> Result<(), Problem> {
    for key in axis.fields().map(|field| FIELDS[field].key) {
        for other in others.iter().flat_map(Axis::fields).map(|field| FIELDS[field].key) {
            let cause = match other {
                own if own == key => format!("{key} is varied twice"),
                _ if Case::are_exclusive(other, key) => {
                    format!("{other} and {key} exclude each other")
                }
                _ => continue,
            };
            return Err(Problem::new(key, cause, "leave one of them out"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
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
            (
                "driven.tip_relief=0..40 um",
                None,
                true,
                "--log needs a start above 0, and 0 um is not",
            ),
            ("operation.speed", None, false, "no values are given: write KEY=FROM..TO"),
            ("driver.teeth=18.5..30", None, false, "whole number"),
        ] {
            let message = refused(text, points, is_log);
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
