//! Error against time as a picture (SVG), both on logarithmic scales.

use std::fmt::Write;

/// What is drawn.
#[derive(Debug, Clone)]
pub struct Plot<'a> {
    /// Above the picture.
    pub title: &'a str,
    /// Below the horizontal axis.
    pub across: &'a str,
    /// Beside the vertical axis.
    pub up: &'a str,
    /// Settings of one kind, joined by a line in the order given.
    pub series: &'a [Series],
}

/// Settings of one kind.
#[derive(Debug, Clone)]
pub struct Series {
    /// In the legend.
    pub name: String,
    /// What a mark looks like.
    pub look: Look,
    /// Time in s and relative error of each setting.
    pub points: Vec<Point>,
}

/// A setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Time, in s.
    pub seconds: f64,
    /// Relative error.
    pub error: f64,
    /// Whether it is the usual setting of its kind, which has a ring.
    pub is_usual: bool,
}

/// Shape and colour of a mark; either tells the series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    shape: &'static str,
    colour: &'static str,
}

/// One look a series, in order.
pub const LOOKS: [Look; 6] = [
    Look {
        shape: "M-4-4H4V4H-4Z",
        colour: "#8a4b08",
    },
    Look {
        shape: "M0-5.5L5.5 0L0 5.5L-5.5 0Z",
        colour: "#0b6e99",
    },
    Look {
        shape: "M0-5L5 4.5H-5Z",
        colour: "#2b7a3d",
    },
    Look {
        shape: "M-4.5 0a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0-9 0Z",
        colour: "#b3261e",
    },
    Look {
        shape: "M0 5L5-4.5H-5Z",
        colour: "#6a3fa0",
    },
    Look {
        shape: "M-1.5-5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5v-3h3.5Z",
        colour: "#555555",
    },
];

const SIZE: (f64, f64) = (760.0, 420.0);
/// Left, top, right, bottom of the field.
const FIELD: (f64, f64, f64, f64) = (80.0, 40.0, 600.0, 370.0);
/// Below this an error is rounding.
const ROUNDING: f64 = 1e-16;
/// Numbers on an axis.
const MARKS: usize = 10;
/// What no picture is needed for.
const GREATEST: f64 = 1e4;

/// Decades from one end of an axis to the other, and where they lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    from: i32,
    to: i32,
    start: f64,
    end: f64,
}

impl Axis {
    /// Whole decades around the values, from one place to the other.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>, start: f64, end: f64) -> Axis {
        let logs = values.map(f64::log10).filter(|log| log.is_finite());
        let (least, most) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), log| {
            (least.min(log), most.max(log))
        });
        if least > most {
            return Axis {
                from: 0,
                to: 1,
                start,
                end,
            };
        }
        let from = least.floor() as i32;
        Axis {
            from,
            to: (most.ceil() as i32).max(from + 1),
            start,
            end,
        }
    }

    /// Where a value lies.
    #[must_use]
    pub fn at(&self, value: f64) -> f64 {
        let part = (value.log10() - f64::from(self.from)) / f64::from(self.to - self.from);
        self.start + part * (self.end - self.start)
    }

    /// Decades from one end on, evenly and no more than `most`.
    pub fn marks(&self, most: usize) -> impl Iterator<Item = i32> + use<> {
        let decades = (self.to - self.from) as usize;
        (self.from..=self.to).step_by(1 + decades / most.max(2))
    }
}

/// The picture.
#[must_use]
pub fn svg(plot: &Plot<'_>) -> String {
    let points = || plot.series.iter().flat_map(|series| &series.points);
    let across = Axis::of(points().map(|point| point.seconds), FIELD.0, FIELD.2);
    let up = Axis::of(points().map(|point| shown(point.error)), FIELD.3, FIELD.1);
    let mut lines = vec![frame(plot)];
    lines.extend(
        across
            .marks(MARKS)
            .map(|decade| upright(decade, across.at(10f64.powi(decade)))),
    );
    lines.extend(
        up.marks(MARKS)
            .map(|decade| level(decade, up.at(10f64.powi(decade)))),
    );
    for (at, series) in plot.series.iter().enumerate() {
        lines.push(drawn(series, &across, &up));
        lines.push(legend(series, at));
    }
    lines.join("\n") + "\n</svg>\n"
}

/// An error that has a place on a logarithmic scale.
#[must_use]
pub fn shown(error: f64) -> f64 {
    error.clamp(ROUNDING, GREATEST)
}

fn frame(plot: &Plot<'_>) -> String {
    let (left, top, right, bottom) = FIELD;
    let (middle, half) = (f64::midpoint(left, right), f64::midpoint(top, bottom));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" \
         font-size=\"12\">\n<title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n\
         <text x=\"{left}\" y=\"24\" font-size=\"14\" font-weight=\"bold\">{title}</text>\n\
         <text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n\
         <text transform=\"translate(20 {half}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n\
         <path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"#333333\"/>",
        SIZE.0,
        SIZE.1,
        bottom + 38.0,
        escaped(plot.across),
        escaped(plot.up),
        title = escaped(plot.title),
    )
}

fn upright(decade: i32, x: f64) -> String {
    let (_, top, _, bottom) = FIELD;
    format!(
        "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"#dddddd\"/><text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
        bottom + 18.0,
        time(decade)
    )
}

fn level(decade: i32, y: f64) -> String {
    let (left, _, right, _) = FIELD;
    format!(
        "<path d=\"M{left} {y:.1}H{right}\" stroke=\"#dddddd\"/><text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">1e{decade}</text>",
        left - 8.0,
        y + 4.0
    )
}

/// A power of ten seconds.
#[must_use]
pub fn time(decade: i32) -> String {
    let (unit, zero) = match decade {
        ..=-7 => ("ns", -9),
        -6..=-4 => ("us", -6),
        -3..=-1 => ("ms", -3),
        0.. => ("s", 0),
    };
    format!("{} {unit}", 10f64.powi(decade - zero))
}

fn drawn(series: &Series, across: &Axis, up: &Axis) -> String {
    let Look { shape, colour } = series.look;
    let places: Vec<(f64, f64)> = series
        .points
        .iter()
        .map(|point| (across.at(point.seconds), up.at(shown(point.error))))
        .collect();
    let way: Vec<String> = places
        .iter()
        .map(|(x, y)| format!("{x:.1},{y:.1}"))
        .collect();
    let mut text = format!(
        "<g fill=\"{colour}\" stroke=\"{colour}\">\n<polyline points=\"{}\" fill=\"none\" stroke-opacity=\"0.5\"/>",
        way.join(" ")
    );
    for ((x, y), point) in places.iter().zip(&series.points) {
        let ring = if point.is_usual {
            "<circle r=\"9\" fill=\"none\"/>"
        } else {
            ""
        };
        let _ = write!(
            text,
            "\n<g transform=\"translate({x:.1} {y:.1})\"><path d=\"{shape}\" stroke=\"none\"/>{ring}</g>"
        );
    }
    text + "\n</g>"
}

fn legend(series: &Series, at: usize) -> String {
    let Look { shape, colour } = series.look;
    let (x, y) = (FIELD.2 + 16.0, FIELD.1 + 12.0 + 20.0 * at as f64);
    format!(
        "<path d=\"{shape}\" transform=\"translate({x} {y})\" fill=\"{colour}\"/><text x=\"{}\" y=\"{}\">{}</text>",
        x + 12.0,
        y + 4.0,
        escaped(&series.name)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<Point>) -> String {
        let series = [Series {
            name: "exact & <co>".to_owned(),
            look: LOOKS[1],
            points,
        }];
        svg(&Plot {
            title: "Error against time",
            across: "time",
            up: "error",
            series: &series,
        })
    }

    #[test]
    fn every_setting_has_a_mark_and_the_usual_one_a_ring() {
        let point = |seconds, error, is_usual| Point {
            seconds,
            error,
            is_usual,
        };
        let drawn = plot(vec![point(1e-6, 1e-3, false), point(2e-5, 0.0, true)]);
        assert_eq!(drawn.matches("translate(").count(), 1 + 2 + 1, "{drawn}");
        assert_eq!(drawn.matches("<circle").count(), 1);
        assert!(
            drawn.contains("1 us") && drawn.contains("100 us") && drawn.contains("1e-16"),
            "{drawn}"
        );
        assert!(
            drawn.contains("exact &amp; &lt;co&gt;")
                && !drawn.contains("NaN")
                && !drawn.contains("inf")
        );
    }

    #[test]
    fn nothing_to_draw_is_no_reason_to_fail() {
        assert!(!plot(Vec::new()).contains("NaN"));
    }
}
