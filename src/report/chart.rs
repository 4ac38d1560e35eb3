//! A chart as a value: curves, bars and points between two axes, for pictures and the workbench.

use crate::case::units::{self, System};

/// A point of a curve.
pub type Point = (f64, f64);

/// A chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    /// The title of a picture.
    pub title: String,
    /// The horizontal axis.
    pub across: Axis,
    /// The vertical axis.
    pub up: Axis,
    /// The curves; the first is on top of the others.
    pub series: Vec<Series>,
    /// Marks on the horizontal axis, with their names.
    pub marks: Vec<(f64, &'static str)>,
    /// Values over both axes, below the curves.
    pub map: Option<Map>,
}

/// Values over both axes in shaded cells.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// The quantity of the values.
    pub value: Axis,
    /// The places of the cells on the horizontal and on the vertical axis, in rising order.
    pub places: [Vec<f64>; 2],
    /// The cells, row by row from the lowest place.
    pub cells: Vec<Cell>,
    /// The least and the greatest value, with their texts, if there are values.
    pub ends: Option<[(f64, String); 2]>,
    /// The value of a contour, with its text.
    pub limit: Option<(f64, String)>,
}

/// A cell of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell {
    /// No value.
    Blank,
    /// A value.
    Value(f64),
    /// No corner contact.
    NoContact,
    /// A point that the model refuses.
    Refused,
}

/// The quantity of an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// The name of the quantity.
    pub name: String,
    /// Its unit; empty for a number.
    pub unit: String,
    /// Labels of values in place of numbers.
    pub labels: Labels,
    /// The least range of the axis, if the curves are no measure of it.
    pub least: Option<Span>,
}

/// Values of an axis with their labels.
pub type Labels = Vec<(f64, String)>;

/// A curve, bars or points.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Pieces with gaps between them.
    pub pieces: Vec<Vec<Point>>,
    /// Style of the series.
    pub kind: Kind,
}

/// Style of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A line.
    Curve,
    /// A thin comparison line.
    Bound,
    /// A mark at each point; the point with this index has a ring.
    Marks(Option<usize>),
    /// Bars from 0 at whole numbers, beside those of the other series.
    Bars,
}

/// Width of all bars at a whole number; 1 is the distance of two numbers.
pub const BARS: f64 = 0.7;

/// A range of values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Span {
    /// The lower end.
    pub from: f64,
    /// The upper end.
    pub to: f64,
}

/// Ends of an axis that begins at 0, times a power of ten.
const ENDS: [f64; 9] = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
/// With this number of additional intervals an axis always has two ticks.
const CLOSER: u16 = 4;
/// Steps from tick to tick, times a power of ten.
const STEPS: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// The axis does not include 0 if the least value exceeds this fraction of the greatest value.
const FAR_FROM_ZERO: f64 = 0.5;

/// A value below this fraction of the greatest value is a rounding error of 0.
const NOTHING: f64 = 1e-9;

/// The axis includes 0 if the values differ by a smaller fraction, which the labels could not show.
const ALIKE: f64 = 1e-3;

impl Chart {
    /// The ranges of both axes.
    pub fn spans(&self) -> (Span, Span) {
        if let Some(map) = &self.map {
            let half = |span: Span| if span.is_empty() { 0.5 } else { 0.0 };
            let [across, up] =
                map.spans().map(|span| Span::new(span.from - half(span), span.to + half(span)));
            return (across, up);
        }
        let points = || self.series.iter().flat_map(|series| series.pieces.iter().flatten());
        let has_bars = self.has_bars();
        let marks = Span::of(self.marks.iter().map(|mark| mark.0));
        let across = Span::of(points().map(|point| point.0)).and(marks).and(self.across.span());
        let values = Span::of(points().map(|point| point.1).chain(has_bars.then_some(0.0)));
        let up = if self.up.labels.is_empty() { values.axis() } else { values.and(self.up.span()) };
        let half = match across.length() {
            _ if has_bars => 0.5,
            0.0 if across.from != 0.0 => across.from.abs() / 10.0,
            0.0 => 1.0,
            _ => 0.0,
        };
        let sound = |span: Span| if span.is_empty() { Span::new(0.0, 1.0) } else { span };
        (sound(Span::new(across.from - half, across.to + half)), sound(up))
    }

    /// The chart with its axes in the units of a system. The values of a map keep their unit.
    #[must_use]
    pub fn in_units(mut self, units: System) -> Chart {
        let converted = |axis: &mut Axis| {
            let own = units::factor(&axis.unit).unwrap_or(1.0);
            axis.unit = units.unit(&axis.unit).to_owned();
            let factor = own / units::factor(&axis.unit).unwrap_or(1.0);
            axis.labels.iter_mut().for_each(|(value, _)| *value *= factor);
            factor
        };
        let [x, y] = [&mut self.across, &mut self.up].map(converted);
        let points = self.series.iter_mut().flat_map(|series| series.pieces.iter_mut().flatten());
        points.for_each(|point| *point = (x * point.0, y * point.1));
        self.marks.iter_mut().for_each(|(place, _)| *place *= x);
        let places = self.map.iter_mut().flat_map(|map| map.places.iter_mut().zip([x, y]));
        for (place, factor) in places.flat_map(|(all, by)| all.iter_mut().map(move |at| (at, by))) {
            *place *= factor;
        }
        self
    }

    /// Whether the chart has bars at whole numbers.
    pub fn has_bars(&self) -> bool {
        self.series.iter().any(|series| series.kind == Kind::Bars)
    }

    /// The quantities of the axes as a title.
    pub fn quantities(&self) -> String {
        // The axis has the remark behind its unit.
        let name = |axis: &Axis| axis.in_unit().split(';').next().unwrap_or_default().to_owned();
        let [across, up] = [&self.across, &self.up].map(name);
        match &self.map {
            Some(map) => format!("{} over {up} and {across}", map.value.in_unit()),
            None => format!("{up} over {across}"),
        }
    }
}

impl Map {
    /// The cell nearest to a point.
    pub fn at(&self, x: f64, y: f64) -> Cell {
        let [column, row] =
            [(0, x), (1, y)].map(|(axis, place)| nearest(&self.places[axis], place));
        self.cells.get(row * self.places[0].len() + column).copied().unwrap_or(Cell::Blank)
    }

    /// The shade of a value, of so many.
    pub fn level(&self, value: f64, shades: usize) -> usize {
        let span =
            self.ends.as_ref().map_or(Span::NONE, |[least, most]| Span::new(least.0, most.0));
        let part = if span.is_empty() { 0.5 } else { span.part(value) };
        ((part * shades as f64) as usize).min(shades - 1)
    }

    /// Whether the value exceeds the limit.
    pub fn is_above(&self, cell: Cell) -> bool {
        let limit = self.limit.as_ref().map(|limit| limit.0);
        matches!((cell, limit), (Cell::Value(value), Some(limit)) if value > limit)
    }

    /// The ranges of both axes.
    fn spans(&self) -> [Span; 2] {
        [0, 1].map(|axis| Span::of(self.places[axis].iter().copied()))
    }
}

impl Cell {
    /// Whether the teeth touch before E.
    pub fn is_contact(self) -> bool {
        matches!(self, Cell::Blank | Cell::Value(_))
    }
}

/// The index of the number nearest to a place, in rising numbers.
pub fn nearest(places: &[f64], place: f64) -> usize {
    let after = places.partition_point(|other| *other < place).min(places.len().max(1) - 1);
    let is_before = after > 0 && place - places[after - 1] < places[after] - place;
    after - usize::from(is_before)
}

impl Axis {
    /// An axis of numbers in a unit.
    pub fn new(name: impl Into<String>, unit: impl Into<String>) -> Axis {
        let unit = Some(unit.into()).filter(|unit| unit != "1");
        Axis { name: name.into(), unit: unit.unwrap_or_default(), ..Axis::default() }
    }

    /// The name with the unit.
    pub fn in_unit(&self) -> String {
        match self.unit.as_str() {
            "" => self.name.clone(),
            "in" => format!("{} in inches", self.name),
            unit => format!("{} in {unit}", self.name),
        }
    }

    /// An axis of logarithms to base 10, with a label for the number at each power of ten.
    pub fn logarithmic(
        name: impl Into<String>,
        logarithms: impl Iterator<Item = f64>,
        label: fn(f64) -> String,
    ) -> Axis {
        let Span { from, to } = Span::of(logarithms);
        if from > to {
            return Axis::new(name, "");
        }
        let (first, last) = (from.floor() as i32, to.ceil() as i32);
        let decades = first..=last.max(first + 1);
        let labels = decades.map(|power| (f64::from(power), label(10f64.powi(power))));
        Axis { labels: labels.collect(), ..Axis::new(name, "") }
    }

    /// The range of the labels, and the least range.
    pub fn span(&self) -> Span {
        Span::of(self.labels.iter().map(|label| label.0)).and(self.least.unwrap_or(Span::NONE))
    }

    /// Labels of at most `most` intervals of a range.
    pub fn ticks(&self, span: Span, most: u16) -> Labels {
        match self.labels.len().checked_sub(1) {
            None => span.ticks(most),
            Some(last) => {
                let every = 1 + last / (usize::from(most) + 1);
                self.labels.iter().step_by(every).cloned().collect()
            }
        }
    }
}

impl Series {
    /// The width of a bar and the distance of its left edge from its number, for the series with
    /// this index among all series.
    pub fn bar(at: usize, all: usize) -> (f64, f64) {
        let width = BARS / all.max(1) as f64;
        (width, width * at as f64 - 0.5 * BARS)
    }
}

impl Span {
    /// The empty range.
    pub const NONE: Span = Span { from: f64::INFINITY, to: f64::NEG_INFINITY };

    /// The range between two ends.
    pub fn new(from: f64, to: f64) -> Span {
        Span { from, to }
    }

    /// The range of the values that are finite.
    pub fn of(values: impl Iterator<Item = f64>) -> Span {
        values.filter(|value| value.is_finite()).fold(Span::NONE, Span::with)
    }

    /// The length of the range.
    pub fn length(self) -> f64 {
        self.to - self.from
    }

    /// The range times a factor above 0.
    pub fn scaled(self, factor: f64) -> Span {
        Span { from: factor * self.from, to: factor * self.to }
    }

    /// The range shifted by a length.
    pub fn shifted(self, by: f64) -> Span {
        Span { from: self.from + by, to: self.to + by }
    }

    /// Whether the range is empty or a single point.
    pub fn is_empty(self) -> bool {
        self.length().is_nan() || self.length() <= 0.0
    }

    /// The range extended to a point.
    pub fn with(self, value: f64) -> Span {
        Span { from: self.from.min(value), to: self.to.max(value) }
    }

    /// The range that covers both.
    pub fn and(self, other: Span) -> Span {
        Span { from: self.from.min(other.from), to: self.to.max(other.to) }
    }

    /// Whether the range contains the other.
    pub fn covers(self, other: Span) -> bool {
        self.from <= other.from && other.to <= self.to
    }

    /// The position of a value, 0 at the lower end and 1 at the upper end.
    pub fn part(self, value: f64) -> f64 {
        if self.is_empty() { 0.0 } else { (value - self.from) / self.length() }
    }

    /// The range, shifted into a longer one.
    pub fn within(self, other: Span) -> Span {
        let from = self.from.min(other.to - self.length()).max(other.from);
        Span { from, to: (from + self.length()).min(other.to) }
    }

    /// An axis with round ends that covers the values; empty if there are no values.
    pub fn axis(self) -> Span {
        self.axis_near(FAR_FROM_ZERO)
    }

    /// Such an axis that includes 0 only if the values have both signs or are alike, so that the
    /// differences of compared curves are visible.
    pub fn close_axis(self) -> Span {
        self.axis_near(0.0)
    }

    fn axis_near(self, far_from_zero: f64) -> Span {
        let is_finite = self.from.is_finite() && self.to.is_finite();
        if is_finite { rounded(with_zero(self, far_from_zero)) } else { Span::default() }
    }

    /// Ticks at multiples of 1, 2 or 5, with at most `most` intervals but at least two ticks.
    pub fn ticks(self, most: u16) -> Labels {
        let greatest = self.from.abs().max(self.to.abs());
        let intervals =
            (most.max(1)..=most.max(1) + CLOSER).map(|most| self.length() / f64::from(most));
        let step = intervals
            .map(|step| round_up(step, &STEPS))
            .find(|step| (self.to / step + 1e-6).floor() - (self.from / step - 1e-6).ceil() >= 1.0);
        let Some(step) =
            step.filter(|step| (1e-250..1e250).contains(&greatest) && *step > 1e-12 * greatest)
        else {
            return Labels::new();
        };
        let power = |value: f64| (value * (1.0 + 1e-9)).log10().floor() as i32;
        let (is_plain, lowest) = ((1e-3..1e6).contains(&greatest), power(step));
        let label = |value: f64| match value {
            0.0 => "0".to_owned(),
            _ if is_plain => format!("{value:.0$}", (-lowest).max(0) as usize),
            _ => format!("{value:.0$e}", (power(greatest) - lowest).max(0) as usize),
        };
        let first = (self.from / step - 1e-6).ceil() as i64;
        let last = (self.to / step + 1e-6).floor() as i64;
        let values = (first..=last).map(|count| count as f64 * step);
        values.map(|value| (value, label(value))).collect()
    }
}

// Extends the values to 0 unless they are far from it.
fn with_zero(values: Span, far_from_zero: f64) -> Span {
    let least = values.from.abs().min(values.to.abs());
    let greatest = values.from.abs().max(values.to.abs());
    let sound = |value: f64| {
        if value.abs() <= NOTHING * greatest { 0.0 } else { value }
    };
    let values = Span::new(sound(values.from), sound(values.to));
    let one_side = values.from.signum() == values.to.signum();
    let apart = one_side && least > far_from_zero * greatest && values.length() > ALIKE * greatest;
    if apart { values } else { values.with(0.0) }
}

// Rounds the ends: from 0 to a round end, or to multiples of a step.
fn rounded(values: Span) -> Span {
    let end = |value: f64| round_up(value, &ENDS);
    match (values.from, values.to) {
        (0.0, 0.0) => Span::new(0.0, 1.0),
        (0.0, to) => Span::new(0.0, end(to)),
        (from, 0.0) => Span::new(-end(-from), 0.0),
        (from, to) => {
            let step = round_up((to - from) / 16.0, &STEPS);
            Span::new((from / step - 1e-9).floor() * step, (to / step + 1e-9).ceil() * step)
        }
    }
}

// The least round number that is not below the value, at least `LEAST`.
fn round_up(value: f64, round: &[f64]) -> f64 {
    const LEAST: f64 = 1e-30;
    if !value.is_normal() || value < LEAST {
        return LEAST;
    }
    let power = 10f64.powi(value.log10().floor() as i32);
    let step = round.iter().find(|&&step| step * power >= value * (1.0 - 1e-12));
    step.unwrap_or(&10.0) * power
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn to(value: f64) -> Span {
        Span::new(0.0, value)
    }

    #[test]
    fn an_axis_is_round_has_both_signs_if_the_curve_has_and_leaves_out_a_distant_zero() {
        assert_eq!(to(2191.0).axis(), to(3000.0));
        assert_eq!(to(1700.0).axis(), to(2000.0));
        assert_eq!(Span::new(-1.366, 24.6).axis(), Span::new(-2.0, 26.0));
        assert_eq!(Span::new(-1.366, 0.0).axis(), Span::new(-1.5, 0.0));
        let axis = Span::new(47.34, 47.89).axis();
        assert!((axis.from - 47.3).abs() < 1e-9 && (axis.to - 47.9).abs() < 1e-9, "{axis:?}");
        assert_eq!(Span::new(1.0, 1.0).axis(), to(1.0));
        assert!(Span::NONE.axis().is_empty());
    }

    #[test]
    fn labels_are_short_and_far_numbers_have_a_power() {
        let labels = |from, to, most| {
            let ticks = Span::new(from, to).ticks(most);
            ticks.into_iter().map(|(_, label)| label).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(labels(0.0, 3000.0, 2), "0 2000");
        assert_eq!(labels(-1.5, 0.0, 8), "-1.4 -1.2 -1.0 -0.8 -0.6 -0.4 -0.2 0");
        assert_eq!(labels(0.0, 3e7, 3), "0 1e7 2e7 3e7");
        assert_eq!(labels(0.0, 2e-6, 4), "0 5.0e-7 1.0e-6 1.5e-6 2.0e-6");
        assert_eq!(labels(47.3, 47.9, 6), "47.3 47.4 47.5 47.6 47.7 47.8 47.9");
    }

    #[test]
    fn a_logarithmic_axis_has_whole_decades_and_drops_labels_without_room() {
        let label = |value: f64| format!("{value:e}");
        let axis = Axis::logarithmic("x", [2e-6f64, 3e-2].into_iter().map(f64::log10), label);
        let ticks = axis.ticks(Span::NONE, 9);
        assert_eq!((ticks.len(), ticks[0].1.as_str()), (6, "1e-6"));
        assert_eq!(axis.ticks(Span::NONE, 3).len(), 3);
    }

    proptest! {
        #[test]
        fn an_axis_covers_its_values(from in -1e6..1e6f64, length in 0.0..1e6f64, shrunk in -12..3i32) {
            let length = length * 10f64.powi(shrunk);
            let axis = Span::new(from, from + length).axis();
            prop_assert!(axis.covers(Span::new(from + 1e-9 * length, from + length * (1.0 - 1e-9))) || length < 1e-9);
        }

        #[test]
        fn ticks_are_multiples_of_1_2_or_5_and_every_label_is_another(
            from in -1e9..1e9f64, length in 1e-4..1.0f64, power in -20..12i32, most in 1..30u16,
        ) {
            let size = 10f64.powi(power);
            let span = Span::new(from * 1e-9 * size, (from * 1e-9 + length) * size);
            let ticks = span.ticks(most);
            let labels: Vec<_> = ticks.iter().map(|(_, label)| label.clone()).collect();
            prop_assert!((2..=usize::from(most).max(4) + 1).contains(&labels.len()), "{labels:?}");
            let mut distinct = labels.clone();
            distinct.dedup();
            prop_assert_eq!(&labels, &distinct);
            for pair in ticks.windows(2) {
                let step = pair[1].0 - pair[0].0;
                let digit = step / 10f64.powf((step * (1.0 + 1e-6)).log10().floor());
                prop_assert!([1.0, 2.0, 5.0].iter().any(|round| (digit - round).abs() < 1e-3), "{digit}");
            }
            for (value, label) in &ticks {
                let read: f64 = label.parse().unwrap();
                prop_assert!((read - value).abs() <= 1e-9 * size, "{label} {value}");
                prop_assert!(label != "-0" && label.len() <= 14, "{label}");
            }
        }
    }
}
