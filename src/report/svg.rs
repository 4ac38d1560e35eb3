//! Draws charts as self-contained pictures (SVG): true axes, a legend below the field, light and
//! dark.

pub mod teeth;

use std::fmt::Write;

use crate::case::sanitize::sanitize;

/// A chart.
#[derive(Debug, Clone)]
pub struct Chart {
    /// Title above the field.
    pub title: String,
    /// The horizontal axis.
    pub across: Labelled,
    /// The vertical axis.
    pub up: Labelled,
    /// The curves; the first is on top of the others.
    pub series: Vec<Series>,
    /// Marks on the horizontal axis, with names above the field.
    pub marks: Vec<(f64, &'static str)>,
}

/// An axis with its label.
#[derive(Debug, Clone)]
pub struct Labelled {
    /// The quantity and its unit.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// Formats the value of a tick; `None` for a plain number.
    pub tick: Option<fn(f64) -> String>,
}

impl Labelled {
    /// A linear axis with plain numbers.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Labelled {
        Labelled { label: label.into(), scale: Scale::Linear, tick: None }
    }
}

/// A curve, or single points joined by a thin line.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Pieces with gaps between them.
    pub pieces: Vec<Vec<(f64, f64)>>,
    /// Style of the series.
    pub kind: Kind,
}

/// Style of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A line.
    Curve,
    /// A thin grey comparison line.
    Bound,
    /// A mark at each point; the point with this index has a ring.
    Marks(Option<usize>),
    /// Bars from 0 at whole numbers: the index of this series in each group, and the number of
    /// series.
    Bars(usize, usize),
}

impl Series {
    fn is_bars(&self) -> bool {
        matches!(self.kind, Kind::Bars(..))
    }

    /// The outer ends of the bars on the horizontal axis.
    fn bar_edges(&self) -> impl Iterator<Item = f64> {
        let points = self.pieces.iter().flatten();
        points.flat_map(|point| [point.0 - BARS, point.0 + BARS])
    }
}

const WIDTH: f64 = 760.0;
/// Left, top, right and bottom of the field.
const FIELD: (f64, f64, f64, f64) = (92.0, 58.0, 736.0, 316.0);
/// Vertical position of the first line of the legend.
const LEGEND: f64 = 388.0;
const LINE: f64 = 23.0;
/// Width of all bars at a whole number; 1 is the distance of two numbers.
const BARS: f64 = 0.7;
/// Greatest width of a letter of the legend.
const LETTER: f64 = 9.4;
/// Width of a symbol of the legend with its gaps.
const SYMBOL: f64 = 52.0;
/// Greatest number of letters of a name in the legend.
const MOST_LETTERS: usize = 62;

/// Draws the chart.
#[must_use]
pub fn chart(chart: &Chart) -> String {
    let (left, top, right, bottom) = FIELD;
    let points = || chart.series.iter().flat_map(|series| series.pieces.iter().flatten());
    let bars = || chart.series.iter().filter(|series| series.is_bars());
    let edges = bars().flat_map(Series::bar_edges);
    let marks = chart.marks.iter().map(|(place, _)| *place);
    let across = Axis::of(
        chart.across.scale,
        points().map(|point| point.0).chain(edges).chain(marks),
        left,
        right,
        false,
    );
    let up = Axis::of(
        chart.up.scale,
        points().map(|point| point.1).chain(bars().map(|_| 0.0)),
        bottom,
        top,
        true,
    );
    let places = places(&chart.series);
    let lines = places.last().map_or(0.0, |(_, y)| y - LEGEND + LINE);
    let mut text = frame(chart, LEGEND + lines);
    grid(&mut text, &across, &up, chart);
    // Single marks are below the curves.
    let is_mark = |series: &Series| matches!(series.kind, Kind::Marks(_));
    let order = chart.series.iter().enumerate().rev();
    let (below, above): (Vec<_>, Vec<_>) = order.partition(|(_, series)| is_mark(series));
    for (at, series) in below.into_iter().chain(above) {
        draw(&mut text, series, at, |(x, y)| (across.at(x), up.at(y)));
    }
    for ((at, series), (x, y)) in chart.series.iter().enumerate().zip(places) {
        legend(&mut text, series, at, x, y);
    }
    text + "</svg>\n"
}

fn frame(chart: &Chart, height: f64) -> String {
    let (left, top, right, bottom) = FIELD;
    let (middle, half) = (f64::midpoint(left, right), f64::midpoint(top, bottom));
    let (title, across, up) =
        (escaped(&chart.title), escaped(&chart.across.label), escaped(&chart.up.label));
    let below = bottom + 46.0;
    format!(
        "{}<text x=\"{left}\" y=\"24\" class=\"title\">{title}</text>\n\
         <text x=\"{middle}\" y=\"{below}\" text-anchor=\"middle\">{across}</text>\n\
         <text transform=\"translate(20 {half}) rotate(-90)\" text-anchor=\"middle\">{up}</text>\n",
        opening(&title, WIDTH, height),
    )
}

/// The root element, the styles and the background of a picture; the title must be escaped.
fn opening(title: &str, width: f64, height: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
         class=\"tipstrike\">\n<title>{title}</title>\n<style>{STYLE}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" class=\"ground\"/>\n"
    )
}

fn grid(text: &mut String, across: &Axis, up: &Axis, chart: &Chart) {
    let (left, top, right, bottom) = FIELD;
    let printed = |labelled: &Labelled, axis: &Axis, value: f64| {
        labelled.tick.map_or_else(|| axis.number(value), |tick| tick(value))
    };
    for value in across.ticks(9) {
        let x = across.at(value);
        let number = escaped(&printed(&chart.across, across, value));
        let below = bottom + 21.0;
        let _ = writeln!(
            text,
            "<path d=\"M{x:.1} {top}V{bottom}\" class=\"grid\"/><text x=\"{x:.1}\" y=\"{below}\" \
                text-anchor=\"middle\">{number}</text>"
        );
    }
    for value in up.ticks(6) {
        let y = up.at(value);
        let number = escaped(&printed(&chart.up, up, value));
        let (beside, base) = (left - 8.0, y + 5.0);
        let _ = writeln!(
            text,
            "<path d=\"M{left} {y:.1}H{right}\" class=\"grid\"/><text x=\"{beside}\" \
                y=\"{base:.1}\" text-anchor=\"end\">{number}</text>"
        );
    }
    let _ = writeln!(text, "<path d=\"M{left} {top}V{bottom}H{right}\" class=\"axis\"/>");
    // The ends of the names in each row.
    let mut ends = [f64::NEG_INFINITY; 2];
    for (value, name) in &chart.marks {
        let (x, half) = (across.at(*value), 0.5 * LETTER * name.chars().count() as f64);
        if !(left..=right).contains(&x) {
            continue;
        }
        let _ = writeln!(text, "<path d=\"M{x:.1} {top}V{bottom}\" class=\"mark\"/>");
        if let Some(row) = (0..ends.len()).find(|&row| x - half > ends[row]) {
            ends[row] = x + half + LETTER;
            let above = top - 5.0 - 15.0 * row as f64;
            let _ = writeln!(
                text,
                "<text x=\"{x:.1}\" y=\"{above}\" text-anchor=\"middle\">{name}</text>"
            );
        }
    }
}

fn draw(text: &mut String, series: &Series, at: usize, place: impl Fn((f64, f64)) -> (f64, f64)) {
    let look = at % LOOKS.len();
    let class = match series.kind {
        Kind::Curve => format!("curve s{look}"),
        Kind::Bound => "bound".to_owned(),
        Kind::Marks(_) => format!("thin s{look}"),
        Kind::Bars(slot, slots) => {
            bars(text, series, (slot, slots), look, &place);
            return;
        }
    };
    for piece in &series.pieces {
        if let ([point], Kind::Curve | Kind::Bound) = (piece.as_slice(), series.kind) {
            // A line with a single point is invisible.
            let (x, y) = place(*point);
            let _ =
                writeln!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\" class=\"f{look}\"/>");
            continue;
        }
        let points: Vec<String> = piece
            .iter()
            .map(|&point| place(point))
            .map(|(x, y)| format!("{x:.1},{y:.1}"))
            .collect();
        let _ = writeln!(text, "<polyline points=\"{}\" class=\"{class}\"/>", points.join(" "));
    }
    let Kind::Marks(ringed) = series.kind else {
        return;
    };
    for (number, &point) in series.pieces.iter().flatten().enumerate() {
        let (x, y) = place(point);
        let ring = if ringed == Some(number) {
            format!("<circle r=\"9\" class=\"thin s{look}\"/>")
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "<g transform=\"translate({x:.1} {y:.1})\"><path d=\"{}\" class=\"f{look}\"/>{ring}</g>",
            LOOKS[look]
        );
    }
}

/// Bars from 0. All bars at a whole number are [`BARS`] wide together.
fn bars(
    text: &mut String,
    series: &Series,
    (slot, slots): (usize, usize),
    look: usize,
    place: &impl Fn((f64, f64)) -> (f64, f64),
) {
    let width = BARS / slots.max(1) as f64;
    for &(x, y) in series.pieces.iter().flatten() {
        let from = x - 0.5 * BARS + width * slot as f64;
        let ((left, top), (right, bottom)) = (place((from, y)), place((from + width, 0.0)));
        let (across, up) = (right - left, bottom - top);
        let _ = writeln!(
            text,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{across:.1}\" height=\"{up:.1}\" \
                class=\"f{look}\"/>"
        );
    }
}

/// The positions of the names in the legend, in rows.
fn places(series: &[Series]) -> Vec<(f64, f64)> {
    let (mut x, mut y) = (FIELD.0, LEGEND);
    let mut places = Vec::new();
    for one in series {
        let width = SYMBOL + LETTER * cut(&one.name).chars().count() as f64;
        if x > FIELD.0 && x + width > FIELD.2 {
            (x, y) = (FIELD.0, y + LINE);
        }
        places.push((x, y));
        x += width;
    }
    places
}

fn cut(name: &str) -> String {
    if name.chars().count() <= MOST_LETTERS {
        return name.to_owned();
    }
    name.chars().take(MOST_LETTERS - 1).chain(['…']).collect()
}

fn legend(text: &mut String, series: &Series, at: usize, x: f64, y: f64) {
    let look = at % LOOKS.len();
    let middle = y - 5.0;
    let symbol = match series.kind {
        Kind::Curve => format!("<path d=\"M{x} {middle}h30\" class=\"curve s{look}\"/>"),
        Kind::Bound => format!("<path d=\"M{x} {middle}h30\" class=\"bound\"/>"),
        Kind::Bars(..) => format!(
            "<rect x=\"{}\" y=\"{}\" width=\"14\" height=\"12\" class=\"f{look}\"/>",
            x + 8.0,
            middle - 6.0
        ),
        Kind::Marks(_) => format!(
            "<path d=\"{}\" transform=\"translate({} {middle})\" class=\"f{look}\"/>",
            LOOKS[look],
            x + 15.0
        ),
    };
    let (beside, name) = (x + 38.0, escaped(&cut(&series.name)));
    let _ = writeln!(text, "{symbol}<text x=\"{beside}\" y=\"{y}\">{name}</text>");
}

/// The scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    Linear,
    /// Logarithmic; values must be above 0.
    Logarithmic,
}

/// An axis between two positions of the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    scale: Scale,
    /// First value, or first decade of a logarithmic axis.
    from: f64,
    to: f64,
    start: f64,
    end: f64,
}

/// Greater values are drawn at this value.
const GREATEST: f64 = 1e290;

impl Axis {
    /// An axis around the values, from one position to the other. `with_room` adds room at both
    /// ends of a linear axis, and includes 0 if the values are close to 0.
    #[must_use]
    pub fn of(
        scale: Scale,
        values: impl Iterator<Item = f64>,
        start: f64,
        end: f64,
        with_room: bool,
    ) -> Axis {
        let on_axis = values.map(|value| match scale {
            Scale::Linear => value.clamp(-GREATEST, GREATEST),
            Scale::Logarithmic => value.log10(),
        });
        let (least, most) = on_axis
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
                (least.min(value), most.max(value))
            });
        let (from, to) = match scale {
            _ if least > most => (0.0, 1.0),
            Scale::Linear => linear_ends(least, most, with_room),
            Scale::Logarithmic => (least.floor(), most.ceil().max(least.floor() + 1.0)),
        };
        Axis { scale, from, to, start, end }
    }

    /// The position of a value; the nearer end if the value is outside.
    #[must_use]
    pub fn at(&self, value: f64) -> f64 {
        let value = match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => value.log10(),
        };
        let part = (value - self.from) / (self.to - self.from);
        let part = if part.is_finite() { part.clamp(-0.1, 1.1) } else { 0.0 };
        self.start + part * (self.end - self.start)
    }

    /// Round values on the axis, about `most` of them.
    #[must_use]
    pub fn ticks(&self, most: usize) -> Vec<f64> {
        match self.scale {
            Scale::Linear => {
                let step = self.step(most);
                let (first, last) = ((self.from / step).ceil(), (self.to / step).floor());
                let count = (last - first).clamp(0.0, 100.0) as usize;
                (0..=count).map(|at| (first + at as f64) * step).collect()
            }
            Scale::Logarithmic => {
                let decades = (self.to - self.from) as usize;
                let every = 1 + decades / most.max(2);
                (0..=decades).step_by(every).map(|at| 10f64.powf(self.from + at as f64)).collect()
            }
        }
    }

    /// The value of a tick as a plain number with enough digits to distinguish the ticks.
    #[must_use]
    pub fn number(&self, value: f64) -> String {
        if self.scale == Scale::Logarithmic {
            return format!("{value:e}");
        }
        let size = self.from.abs().max(self.to.abs());
        let step = self.step(9);
        let value = if value.abs() < step / 2.0 { 0.0 } else { value };
        if (1e-3..1e6).contains(&size) {
            let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
            return format!("{value:.decimals$}");
        }
        let digits = (size / step).log10().ceil().clamp(0.0, 12.0) as usize;
        format!("{value:.digits$e}")
    }

    /// 1, 2 or 5 times a power of ten.
    fn step(&self, most: usize) -> f64 {
        let raw = (self.to - self.from) / most.max(2) as f64;
        let power = 10f64.powf(raw.log10().floor());
        let times = [1.0, 2.0, 5.0, 10.0].into_iter().find(|times| times * power >= raw * 0.999);
        times.unwrap_or(10.0) * power
    }
}

/// The room between a curve and the ends of its axis, as a fraction of its span.
const ROOM: f64 = 0.05;

fn linear_ends(least: f64, most: f64, with_room: bool) -> (f64, f64) {
    // Values that differ only by rounding get an axis of a tenth of their size.
    let size = least.abs().max(most.abs());
    if most - least <= 1e-9 * size {
        let half = if size > 0.0 { size / 10.0 } else { 1.0 };
        return (least - half, most + half);
    }
    if !with_room {
        return (least, most);
    }
    let room = ROOM * (most - least);
    let near_zero = 0.5 * (most - least);
    let from = if (0.0..=near_zero).contains(&least) { 0.0 } else { least - room };
    let to = if (-near_zero..=0.0).contains(&most) { 0.0 } else { most + room };
    (from, to)
}

/// The mark of each series.
const LOOKS: [&str; 6] = [
    "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0Z",
    "M-4-4H4V4H-4Z",
    "M0-5.5L5.5 0L0 5.5L-5.5 0Z",
    "M0-5L5 4.5H-5Z",
    "M0 5L5-4.5H-5Z",
    "M-1.5-5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5Z",
];

/// The style sheet of every picture. Its rules apply only to pictures, so that a page may contain
/// several.
const STYLE: &str = "\
.tipstrike{font:15px 'DejaVu Sans',Helvetica,Arial,sans-serif;fill:#222}\
.tipstrike .title{font-size:17px;font-weight:bold}\
.tipstrike .ground{fill:#fff}\
.tipstrike .grid{stroke:#ddd;fill:none}\
.tipstrike .axis{stroke:#333;fill:none}\
.tipstrike .mark{stroke:#888;fill:none;stroke-dasharray:2 3}\
.tipstrike .curve{fill:none;stroke-width:2;stroke-linejoin:round}\
.tipstrike .thin{fill:none;stroke-opacity:.6}\
.tipstrike .bound{fill:none;stroke:#777;stroke-dasharray:1 3;stroke-width:1.5}\
.tipstrike .s0{stroke:#0b6e99}.tipstrike .f0{fill:#0b6e99}\
.tipstrike .s1{stroke:#b3261e;stroke-dasharray:9 3}.tipstrike .f1{fill:#b3261e}\
.tipstrike .s2{stroke:#2b7a3d;stroke-dasharray:3 2}.tipstrike .f2{fill:#2b7a3d}\
.tipstrike .s3{stroke:#8a4b08;stroke-dasharray:9 3 2 3}.tipstrike .f3{fill:#8a4b08}\
.tipstrike .s4{stroke:#6a3fa0;stroke-dasharray:14 4}.tipstrike .f4{fill:#6a3fa0}\
.tipstrike .s5{stroke:#555;stroke-dasharray:2 4}.tipstrike .f5{fill:#555}\
.tipstrike .thin{stroke-dasharray:none}\
.tipstrike .body1{fill:#d7e9f2;stroke:#0b6e99;stroke-width:1.5}\
.tipstrike .body2{fill:#f6e3d0;stroke:#8a4b08;stroke-width:1.5}\
.tipstrike .path{fill:none;stroke:#2b7a3d;stroke-width:2.5}\
.tipstrike .halo{paint-order:stroke;stroke:#fff;stroke-width:4px;stroke-linejoin:round}\
@media screen and (prefers-color-scheme:dark){\
.tipstrike{fill:#ddd}.tipstrike .ground{fill:#16181b}.tipstrike .grid{stroke:#33373c}\
.tipstrike .axis{stroke:#aaa}.tipstrike .path{stroke:#84d394}.tipstrike .bound{stroke:#999}.tipstrike .halo{stroke:#16181b}\
.tipstrike .s0{stroke:#62c3ee}.tipstrike .f0{fill:#62c3ee}\
.tipstrike .s1{stroke:#ff8a80}.tipstrike .f1{fill:#ff8a80}\
.tipstrike .s2{stroke:#84d394}.tipstrike .f2{fill:#84d394}\
.tipstrike .s3{stroke:#e8a862}.tipstrike .f3{fill:#e8a862}\
.tipstrike .s4{stroke:#c5a4f2}.tipstrike .f4{fill:#c5a4f2}\
.tipstrike .s5{stroke:#bbb}.tipstrike .f5{fill:#bbb}\
.tipstrike .body1{fill:#1d3642;stroke:#62c3ee}.tipstrike .body2{fill:#3f2d1a;stroke:#e8a862}}";

/// Escapes a text for an element or an attribute.
pub(crate) fn escaped(text: &str) -> String {
    sanitize(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(points: Vec<(f64, f64)>, kind: Kind) -> String {
        chart(&Chart {
            title: "a < b".to_owned(),
            across: Labelled::linear("x, deg"),
            up: Labelled::linear("y, N"),
            series: vec![Series { name: "exact & <co>".to_owned(), pieces: vec![points], kind }],
            marks: vec![(0.0, "E"), (0.001, "D")],
        })
    }

    #[test]
    fn names_are_escaped_and_marks_do_not_cover_each_other() {
        let text = drawn(vec![(-1.0, 5.0), (1.0, 2000.0)], Kind::Curve);
        assert!(text.contains("a &lt; b") && text.contains("exact &amp; &lt;co&gt;"), "{text}");
        let row = |name: &str| text.lines().find(|line| line.contains(name)).unwrap();
        assert!(
            row(">E</text>").contains("y=\"53\"") && row(">D</text>").contains("y=\"38\""),
            "{text}"
        );
        assert_eq!(text.matches("<polyline").count(), 1);
    }

    #[test]
    fn every_single_point_has_a_mark_and_the_chosen_one_has_a_ring() {
        let text = drawn(vec![(1e-6, 1e-3), (2e-5, 1e-16)], Kind::Marks(Some(1)));
        // The label of the upward axis, two marks and the legend.
        assert_eq!(text.matches("translate(").count(), 1 + 2 + 1, "{text}");
        assert_eq!(text.matches("<circle").count(), 1);
    }

    #[test]
    fn no_points_one_point_and_extreme_values_are_drawn_without_invalid_numbers() {
        for points in [
            vec![],
            vec![(0.0, 0.0)],
            vec![(1e300, -1e300), (-1e300, 1e300)],
            vec![(f64::NAN, 1.0), (1.0, f64::INFINITY)],
            vec![(1.0, 5.0), (1.0 + 1e-15, 5.0)],
        ] {
            let text = drawn(points, Kind::Marks(Some(0)));
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }

    #[test]
    fn a_long_legend_takes_more_lines() {
        let one = Series {
            name: "a name of forty letters in the legend....".to_owned(),
            pieces: Vec::new(),
            kind: Kind::Curve,
        };
        let places = places(&vec![one; 4]);
        assert!(places.windows(2).all(|pair| pair[0] != pair[1]));
        assert!(places[3].1 > places[0].1);
    }

    fn axis(values: &[f64]) -> Axis {
        Axis::of(Scale::Linear, values.iter().copied(), 0.0, 100.0, true)
    }

    #[test]
    fn ticks_are_round_inside_the_axis_and_distinct() {
        for values in [[0.0, 2191.0], [-1.4, 0.0], [3.0, 3.01], [1e-7, 9e-7], [2e8, 9e9]] {
            let axis = axis(&values);
            let ticks = axis.ticks(7);
            assert!((3..=9).contains(&ticks.len()), "{ticks:?}");
            let texts: Vec<String> = ticks.iter().map(|tick| axis.number(*tick)).collect();
            assert!(texts.windows(2).all(|pair| pair[0] != pair[1]), "{texts:?}");
            assert!(ticks.iter().all(|tick| (-0.1..=100.1).contains(&axis.at(*tick))));
        }
        assert_eq!(axis(&[0.0, 2191.0]).number(500.0), "500");
        assert_eq!(axis(&[-1.4, 0.0]).number(-0.5), "-0.5");
    }

    #[test]
    fn a_logarithmic_axis_has_whole_decades() {
        let values = [2e-6, 3e-2];
        let axis = Axis::of(Scale::Logarithmic, values.into_iter(), 0.0, 100.0, true);
        assert_eq!(axis.ticks(10).len(), 6);
        assert!((axis.at(1e-1) - 100.0).abs() < 1e-9 && axis.at(1e-6).abs() < 1e-9);
        assert_eq!(axis.number(1e-3), "1e-3");
    }
}
