//! Draws charts as self-contained pictures (SVG): true axes, a legend below the field, light and
//! dark.

use crate::case::units::System;
use crate::model::contact_state::{first_contact_of_driver, first_contact_point};
use crate::model::outline::on_line_of_action;
use crate::model::{ContactState, Inputs, Solution};
use crate::report::chart::{Axis, Cell, Chart, Kind, Map, Point, Series, Span};
use crate::report::table::{escaped, parts};
use crate::report::teeth::{Ink, Scene, Window, scale_bar};
use nalgebra::{Point2, Vector2};
use std::fmt::Write;
use std::ops::Range;

/// Half the width of a printed page shows letters of about 7 pt.
const WIDTH: f64 = 560.0;
/// Left, top, right and bottom of the field.
const FIELD: (f64, f64, f64, f64) = (84.0, 58.0, 536.0, 238.0);
/// Vertical position of the first line of the legend.
const LEGEND: f64 = 306.0;
const LINE: f64 = 21.0;
/// Greatest width of a letter of the legend.
const LETTER: f64 = 9.4;
/// Width of a symbol of the legend with its gaps.
const SYMBOL: f64 = 52.0;
/// Greatest number of letters of a name in a legend below the field; a legend with a longer name
/// begins at the left edge, with smaller letters.
const SHORT_NAME: usize = 43;
const LEFT_EDGE: f64 = 18.0;
/// Greatest number of letters of a name in the legend.
const MOST_LETTERS: usize = 64;

/// Draws the chart. The caption names the pair; it is empty where the page names it.
pub fn draw(chart: &Chart, caption: &str) -> String {
    let legend = legend(chart);
    let places = places(legend.iter().map(|(_, name)| name.as_str()));
    let end = places.last().map_or(LEGEND, |(_, y)| y + LINE);
    let spans = chart.spans();
    let mut text = frame(chart, end + caption_height(caption));
    text += &caption_line(caption, FIELD.0, end);
    if let Some(map) = &chart.map {
        draw_map(&mut text, map, spans);
    }
    grid(&mut text, chart, spans);
    // Single marks are below the curves.
    let is_mark = |series: &Series| matches!(series.kind, Kind::Marks(_));
    let order = chart.series.iter().enumerate().rev();
    let (below, above): (Vec<_>, Vec<_>) = order.partition(|(_, series)| is_mark(series));
    let place = |(x, y): Point| (horizontal(spans.0, x), vertical(spans.1, y));
    for (at, series) in below.into_iter().chain(above) {
        draw_series(&mut text, series, (at, chart.series.len()), place);
    }
    for ((symbol, name), (x, y)) in legend.into_iter().zip(places) {
        let beside = x + 38.0;
        let size = fitted(&name, 15.0, WIDTH - beside);
        let size =
            if size < 15.0 { format!(" style=\"font-size:{size:.1}px\"") } else { String::new() };
        let name = typeset(&name);
        let _ = writeln!(
            text,
            "<g transform=\"translate({x} {y})\">{symbol}</g>\
             <text x=\"{beside}\" y=\"{y}\"{size}>{name}</text>"
        );
    }
    text + "</svg>\n"
}

fn caption_height(caption: &str) -> f64 {
    LINE * caption.lines().count() as f64
}

/// The name of the pair in a line of its own, and remarks below it.
fn caption_line(caption: &str, left: f64, y: f64) -> String {
    let line = |(at, line): (usize, &str)| {
        let (y, size, text) =
            (y + LINE * at as f64, fitted(line, 15.0, WIDTH - left), escaped(line));
        format!("<text x=\"{left}\" y=\"{y}\" style=\"font-size:{size:.1}px\">{text}</text>\n")
    };
    caption.lines().enumerate().map(line).collect()
}

/// A size of letters, smaller for a text that is longer than its room.
fn fitted(text: &str, size: f64, room: f64) -> f64 {
    size * (room / (LETTER * text.chars().count() as f64)).min(1.0)
}

/// Escapes a text with the indices of its symbols as subscripts.
fn typeset(text: &str) -> String {
    let mut is_low = false;
    let part = |(part, is_index): (&str, bool)| {
        let (part, was_low) = (escaped(part), std::mem::replace(&mut is_low, is_index));
        match (is_index, was_low) {
            (true, _) => format!("<tspan dy=\"4\" font-size=\"11\">{part}</tspan>"),
            (false, true) => format!("<tspan dy=\"-4\">{part}</tspan>"),
            (false, false) => part,
        }
    };
    parts(text).into_iter().filter(|(part, _)| !part.is_empty()).map(part).collect()
}

/// The symbols and names of the legend.
fn legend(chart: &Chart) -> Vec<(String, String)> {
    let shades = |shades: Range<usize>| {
        let shade = |(at, shade): (usize, usize)| {
            format!("<path d=\"M{}-11h4v12h-4z\" class=\"m{shade}\"/>", 4 * at)
        };
        shades.enumerate().map(shade).collect::<String>()
    };
    let line = |class: &str| format!("<path d=\"M0-5h30\" class={class}/>");
    let mut legend = Vec::new();
    if let Some(map) = &chart.map {
        let ends = map.ends.as_ref().map(|[least, most]| format!("{} to {}", least.1, most.1));
        let limit = map.limit.as_ref().map(|limit| limit.1.clone());
        let has = |cell: Cell, name: &str| map.cells.contains(&cell).then(|| name.to_owned());
        let parts = [
            (shades(0..NO_CONTACT), ends),
            (line("\"bound\""), limit),
            (shades(NO_CONTACT..REFUSED), has(Cell::NoContact, "no contact")),
            (shades(REFUSED..SHADES), has(Cell::Refused, "refused")),
        ];
        legend.extend(parts.into_iter().filter_map(|(symbol, name)| Some((symbol, name?))));
    }
    legend.extend(chart.series.iter().enumerate().map(|(at, series)| {
        let look = at % LOOKS.len();
        let symbol = match series.kind {
            Kind::Curve => line(&curve(at)),
            Kind::Bound => line("\"bound\""),
            Kind::Bars => {
                format!("<rect x=\"8\" y=\"-11\" width=\"14\" height=\"12\" class=\"f{look}\"/>")
            }
            Kind::Marks(_) => {
                let shape = LOOKS[look];
                format!("<path d=\"{shape}\" transform=\"translate(15 -5)\" class=\"f{look}\"/>")
            }
        };
        (symbol, cut(&series.name))
    }));
    legend
}

/// Draws the cells of a map, in each row the cells of one shade as one rectangle, and the contour of
/// the limit.
fn draw_map(text: &mut String, map: &Map, (across, up): (Span, Span)) {
    let [xs, ys] = [(0, across), (1, up)].map(|(axis, span)| {
        let places = &map.places[axis];
        let inner = places.windows(2).map(|pair| f64::midpoint(pair[0], pair[1]));
        let ends = std::iter::once(span.from).chain(inner).chain([span.to]);
        ends.map(|value| if axis == 0 { horizontal(span, value) } else { vertical(span, value) })
            .collect::<Vec<f64>>()
    });
    let shade = |cell: Cell| match cell {
        Cell::Blank => None,
        Cell::Value(value) => Some(map.level(value, NO_CONTACT)),
        Cell::NoContact => Some(NO_CONTACT),
        Cell::Refused => Some(REFUSED),
    };
    let mut areas = vec![String::new(); SHADES];
    let mut contour = String::new();
    let rows: Vec<&[Cell]> = map.cells.chunks(map.places[0].len().max(1)).collect();
    for (row, cells) in rows.iter().enumerate() {
        let (bottom, top, mut from) = (ys[row], ys[row + 1], 0);
        for run in cells.chunk_by(|one, next| shade(*one) == shade(*next)) {
            let (left, right) = (xs[from], xs[from + run.len()]);
            if let Some(shade) = shade(run[0]) {
                let _ =
                    write!(areas[shade], "M{left:.1} {bottom:.1}H{right:.1}V{top:.1}H{left:.1}z");
            }
            from += run.len();
        }
        let is_edge = |one: Cell, next: Option<&Cell>| {
            next.is_some_and(|next| map.is_above(one) != map.is_above(*next))
        };
        for (at, cell) in cells.iter().enumerate() {
            let (left, right) = (xs[at], xs[at + 1]);
            if is_edge(*cell, cells.get(at + 1)) {
                let _ = write!(contour, "M{right:.1} {bottom:.1}V{top:.1}");
            }
            if is_edge(*cell, rows.get(row + 1).and_then(|next| next.get(at))) {
                let _ = write!(contour, "M{left:.1} {top:.1}H{right:.1}");
            }
        }
    }
    for (shade, area) in areas.iter().enumerate().filter(|(_, area)| !area.is_empty()) {
        let _ = writeln!(text, "<path d=\"{area}\" class=\"m{shade}\"/>");
    }
    if !contour.is_empty() {
        let _ = writeln!(text, "<path d=\"{contour}\" class=\"bound\"/>");
    }
}

fn horizontal(span: Span, value: f64) -> f64 {
    FIELD.0 + part(span, value) * (FIELD.2 - FIELD.0)
}

fn vertical(span: Span, value: f64) -> f64 {
    FIELD.3 + part(span, value) * (FIELD.1 - FIELD.3)
}

/// The position of a value, not far outside the axis.
fn part(span: Span, value: f64) -> f64 {
    let part = span.part(value);
    if part.is_finite() { part.clamp(-0.1, 1.1) } else { 0.0 }
}

fn frame(chart: &Chart, height: f64) -> String {
    let (left, top, right, bottom) = FIELD;
    let (middle, half, below) =
        (f64::midpoint(left, right), f64::midpoint(top, bottom), bottom + 42.0);
    let label = |axis: &Axis| match axis.unit.as_str() {
        "" => axis.name.clone(),
        unit => format!("{}, {unit}", axis.name),
    };
    let (title, up) = (escaped(&chart.title), label(&chart.up));
    let size = fitted(&chart.title, 17.0, right - left);
    let small = fitted(&up, 15.0, bottom + 40.0);
    let [across, up] = [label(&chart.across), up].map(|label| typeset(&label));
    format!(
        "{}<text x=\"{left}\" y=\"17\" class=\"title\" style=\"font-size:{size:.1}px\">{title}</text>\n\
         <text x=\"{middle}\" y=\"{below}\" text-anchor=\"middle\">{across}</text>\n\
         <text transform=\"translate(18 {half}) rotate(-90)\" text-anchor=\"middle\" \
             style=\"font-size:{small:.1}px\">{up}</text>\n",
        opening(&title, WIDTH, height),
    )
}

/// The root element, the styles and the background of a picture; the title must be escaped.
fn opening(title: &str, width: f64, height: f64) -> String {
    let style: String = STYLE.lines().map(str::trim).collect();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" \
         class=\"tipstrike\">\n<title>{title}</title>\n<style>{style}</style>\n\
         <rect width=\"{width}\" height=\"{height}\" class=\"ground\"/>\n"
    )
}

fn grid(text: &mut String, chart: &Chart, (across, up): (Span, Span)) {
    let (left, top, right, bottom) = FIELD;
    let (below, beside) = (bottom + 19.0, left - 7.0);
    for (value, label) in chart.across.ticks(across, 6) {
        let (x, label) = (horizontal(across, value), escaped(&label));
        let _ = writeln!(
            text,
            "<path d=\"M{x:.1} {top}V{bottom}\" class=\"grid\"/><text x=\"{x:.1}\" y=\"{below}\" \
                text-anchor=\"middle\">{label}</text>"
        );
    }
    for (value, label) in chart.up.ticks(up, 5) {
        let (y, label) = (vertical(up, value), escaped(&label));
        let base = y + 5.0;
        let _ = writeln!(
            text,
            "<path d=\"M{left} {y:.1}H{right}\" class=\"grid\"/><text x=\"{beside}\" \
                y=\"{base:.1}\" text-anchor=\"end\">{label}</text>"
        );
    }
    let _ = writeln!(text, "<path d=\"M{left} {top}V{bottom}H{right}\" class=\"axis\"/>");
    // The ends of the names in each row.
    let mut ends = [f64::NEG_INFINITY; 2];
    for (value, name) in &chart.marks {
        let (x, half) = (horizontal(across, *value), 0.5 * LETTER * name.chars().count() as f64);
        if !(left..=right).contains(&x) {
            continue;
        }
        let _ = writeln!(text, "<path d=\"M{x:.1} {top}V{bottom}\" class=\"mark\"/>");
        if let Some(row) = (0..ends.len()).find(|&row| x - half > ends[row] + LETTER) {
            ends[row] = x + half;
            let above = top - 8.0 - 14.0 * row as f64;
            let _ = writeln!(
                text,
                "<text x=\"{x:.1}\" y=\"{above}\" text-anchor=\"middle\">{name}</text>"
            );
        }
    }
}

/// Draws the series with the index `at` among `all` series.
fn draw_series(
    text: &mut String,
    series: &Series,
    (at, all): (usize, usize),
    place: impl Fn(Point) -> Point,
) {
    let look = at % LOOKS.len();
    let points = || series.pieces.iter().flatten().copied();
    let class = match series.kind {
        Kind::Curve => curve(at),
        Kind::Bound => "\"bound\"".to_owned(),
        Kind::Marks(_) => format!("\"thin s{look}\""),
        Kind::Bars => {
            let (width, from) = Series::bar(at, all);
            for (x, y) in points() {
                let ((left, top), (right, bottom)) =
                    (place((x + from, y)), place((x + from + width, 0.0)));
                let (across, up) = (right - left, bottom - top);
                let _ = writeln!(
                    text,
                    "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{across:.1}\" \
                     height=\"{up:.1}\" class=\"f{look}\"/>"
                );
            }
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
        let points = piece.iter().map(|&point| place(point));
        let points: Vec<String> = points.map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(text, "<polyline points=\"{}\" class={class}/>", points.join(" "));
    }
    if let Kind::Marks(ringed) = series.kind {
        let ring = format!("<circle r=\"9\" class=\"thin s{look}\"/>");
        for (number, point) in points().enumerate() {
            let ((x, y), ring) = (place(point), if ringed == Some(number) { &ring } else { "" });
            let _ = writeln!(
                text,
                "<g transform=\"translate({x:.1} {y:.1})\"><path d=\"{}\" class=\"f{look}\"/>{ring}</g>",
                LOOKS[look]
            );
        }
    }
}

/// The positions of the names in the legend, in rows.
fn places<'a>(names: impl Iterator<Item = &'a str> + Clone) -> Vec<Point> {
    let has_long = names.clone().any(|name| name.chars().count() > SHORT_NAME);
    let left = if has_long { LEFT_EDGE } else { FIELD.0 };
    let (mut x, mut y) = (left, LEGEND);
    let mut places = Vec::new();
    for name in names {
        let width = SYMBOL + LETTER * name.chars().count() as f64;
        if x > left && x + width > FIELD.2 {
            (x, y) = (left, y + LINE);
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

/// The class of the curve of a series. A colour that returns has the dashes of another colour and a
/// wider line, so that no two curves look alike in grey.
fn curve(at: usize) -> String {
    let (look, round) = (at % LOOKS.len(), at / LOOKS.len());
    let dashes = DASHES[(look + round) % LOOKS.len()];
    let style = format!(" style=\"stroke-dasharray:{dashes};stroke-width:{}\"", 2 + 2 * round);
    format!("\"curve s{look}\"{}", if round > 0 { &style } else { "" })
}

/// The dashes of each series in the style sheet.
const DASHES: [&str; 6] = ["none", "9 3", "3 2", "9 3 2 3", "14 4", "2 4"];

/// The mark of each series.
const LOOKS: [&str; 6] = [
    "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0Z",
    "M-4-4H4V4H-4Z",
    "M0-5.5L5.5 0L0 5.5L-5.5 0Z",
    "M0-5L5 4.5H-5Z",
    "M0 5L5-4.5H-5Z",
    "M-1.5-5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5Z",
];

/// The style sheet, one rule per line: `s` and `f` with a number are line and area of a series, `m` a
/// shade of a map. Its rules apply only to pictures, so that a page may contain several.
const STYLE: &str = include_str!("../../assets/picture.css");

/// The number of shades of a map; the last two are of no contact and of a refused point.
const SHADES: usize = 10;
const NO_CONTACT: usize = SHADES - 2;
const REFUSED: usize = SHADES - 1;

const HEIGHT: f64 = 388.0;
/// Left, top, width and height of the window.
const WINDOW: (f64, f64, f64, f64) = (10.0, 34.0, 540.0, 296.0);
/// Additional height of the window, relative to the length of the path of contact.
const MARGIN: f64 = 0.35;
/// Size of the smallest visible detail, and least distance of two named points.
const DOT: f64 = 0.2;
const APART: f64 = 14.0;
/// Greatest length of the scale bar.
const BAR: f64 = 110.0;

/// Draws the teeth at the first contact, or at E without corner contact.
pub fn teeth(inputs: &Inputs, solution: &Solution, pair: &str, units: System) -> String {
    let contact = first_contact_of_driver(solution);
    let title = if contact.is_some() {
        "Teeth at the first contact D"
    } else {
        "Teeth at E, without corner contact"
    };
    let (window, scale) = window(solution);
    let moment = ContactState::at(inputs, solution, contact.unwrap_or(0.0));
    let lead = moment.as_ref().map_or(0.0, |moment| moment.lead(1.0));
    let scene = Scene::of(inputs, solution, moment.as_ref(), lead, &window);
    let at = |point: Point2<f64>| {
        let off = (point - window.centre) * scale;
        (WINDOW.2 / 2.0 + off.x, WINDOW.3 / 2.0 - off.y)
    };
    let (left, top, width, height) = WINDOW;
    let mut text = opening(&escaped(title), WIDTH, HEIGHT + caption_height(pair));
    let _ = writeln!(
        text,
        "<text x=\"{left}\" y=\"22\" class=\"title\">{title}</text>\n\
         <svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" overflow=\"hidden\">"
    );
    let listed = |points: &mut dyn Iterator<Item = Point2<f64>>| {
        points.map(&at).map(|(x, y)| format!("{x:.2},{y:.2}")).collect::<Vec<_>>().join(" ")
    };
    let centres = [Point2::origin(), Point2::new(solution.geometry.centre_distance, 0.0)];
    for (gear, centre) in centres.into_iter().enumerate() {
        let (inks, count) = [
            ([Ink::Driver, Ink::StruckTooth], inputs.driver.teeth),
            ([Ink::Driven, Ink::IncomingTooth], inputs.driven.teeth),
        ][gear];
        let teeth: Vec<_> = scene.lines.iter().filter(|(ink, _)| inks.contains(ink)).collect();
        // Unless the whole gear is visible, the outline is closed at the centre.
        let end = (teeth.len() < count as usize).then_some(centre);
        let outline = teeth.iter().flat_map(|(_, points)| points.iter().copied());
        let points = listed(&mut outline.chain(end));
        let _ = writeln!(text, "<polygon points=\"{points}\" class=\"body{}\"/>", gear + 1);
    }
    for (ink, points) in &scene.lines {
        let class = match ink {
            Ink::BaseCircle | Ink::LineOfAction => "mark",
            Ink::PathOfContact => "path",
            _ => continue,
        };
        let points = listed(&mut points.iter().copied());
        let _ = writeln!(text, "<polyline points=\"{points}\" class=\"{class}\"/>");
    }
    for (name, point) in scene.distinct_points(&window, APART / scale) {
        let (x, y) = at(point);
        let (anchor, beside) = if name == "D" { ("end", x - 9.0) } else { ("start", x + 9.0) };
        // A label at the frame stays inside.
        let base = (y + 4.0).clamp(14.0, WINDOW.3 - 5.0);
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" class=\"f1\"/>\
             <text x=\"{beside:.1}\" y=\"{base:.1}\" text-anchor=\"{anchor}\" class=\"title \
                 halo\">{name}</text>"
        );
    }
    let (length, name) = scale_bar(BAR / scale, units);
    let (dots, base) = (length * scale, HEIGHT - 14.0);
    let (first, bar, above) = (base - 21.0, WIDTH - left - dots, base - 8.0);
    let middle = bar + dots / 2.0;
    let caption = caption_line(pair, left, HEIGHT + 6.0);
    text + &format!(
        "</svg>\n<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" class=\"axis\"/>\n\
         <text x=\"{left}\" y=\"{first}\">Driver left, driven gear right; thick line: path of contact.</text>\n\
         <text x=\"{left}\" y=\"{base}\">Reliefs are not drawn.</text>\n\
         <path d=\"M{bar:.1} {base}v-5v5h{dots:.1}v-5\" class=\"axis\"/>\
         <text x=\"{middle:.1}\" y=\"{above}\" text-anchor=\"middle\">{name}</text>\n{caption}</svg>\n"
    )
}

/// The part of the plane around the path of contact, with the pixels per metre.
fn window(solution: &Solution) -> (Window, f64) {
    let geometry = &solution.geometry;
    let ends = [geometry.start, geometry.end].map(|length| on_line_of_action(geometry, length));
    let tip = first_contact_point(solution).unwrap_or(ends[0]);
    let high = [ends[0].y, ends[1].y, tip.y];
    let least = high.into_iter().fold(f64::INFINITY, f64::min);
    let most = high.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let scale = WINDOW.3 / ((most - least) * (1.0 + MARGIN) + geometry.base_pitch * 0.4);
    let centre = Point2::new(f64::midpoint(ends[0].x, ends[1].x), f64::midpoint(least, most));
    let half = Vector2::new(WINDOW.2, WINDOW.3) / (2.0 * scale);
    (Window { centre, half, dot: DOT / scale }, scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(points: Vec<Point>, kind: Kind) -> String {
        let chart = Chart {
            title: "a < b".to_owned(),
            across: Axis::new("x", "deg"),
            up: Axis::new("y", "N"),
            series: vec![Series { name: "exact & <co>".to_owned(), pieces: vec![points], kind }],
            marks: vec![(0.0, "E"), (0.001, "D")],
            map: None,
        };
        draw(&chart, "")
    }

    #[test]
    fn names_are_escaped_and_marks_do_not_cover_each_other() {
        let text = drawn(vec![(-1.0, 5.0), (1.0, 2000.0)], Kind::Curve);
        assert!(text.contains("a &lt; b") && text.contains("exact &amp; &lt;co&gt;"), "{text}");
        let row = |name: &str| text.lines().find(|line| line.contains(name)).unwrap();
        assert!(
            row(">E</text>").contains("y=\"50\"") && row(">D</text>").contains("y=\"36\""),
            "{text}"
        );
        assert_eq!(text.matches("<polyline").count(), 1);
    }

    #[test]
    fn every_single_point_has_a_mark_and_the_chosen_one_has_a_ring() {
        let text = drawn(vec![(1e-6, 1e-3), (2e-5, 1e-16)], Kind::Marks(Some(1)));
        // The label of the upward axis, two marks, and the symbol of the legend in its place.
        assert_eq!(text.matches("translate(").count(), 1 + 2 + 2, "{text}");
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
    fn nine_curves_differ_without_colour() {
        let look = |at: usize| match curve(at).split_once("stroke-dasharray:") {
            Some((_, style)) => style.trim_end_matches('"').to_owned(),
            None => format!("{};stroke-width:2", DASHES[at]),
        };
        let looks: std::collections::HashSet<String> = (0..9).map(look).collect();
        assert_eq!(looks.len(), 9, "{looks:?}");
    }

    #[test]
    fn a_long_legend_takes_more_lines() {
        let name = "a name of forty letters in the legend....".to_owned();
        let places = places(std::iter::repeat_n(name.as_str(), 4));
        assert!(places.windows(2).all(|pair| pair[0] != pair[1]));
        assert!(places[3].1 > places[0].1);
    }
}
