//! Accuracy against run time as a picture (SVG), both on logarithmic scales.

use crate::report::svg::{self, Chart, Kind, Labelled, Scale};

/// The content of the plot.
#[derive(Debug, Clone)]
pub struct Plot<'a> {
    /// Title above the picture.
    pub title: &'a str,
    /// Label of the horizontal axis.
    pub across: &'a str,
    /// Label of the vertical axis.
    pub up: &'a str,
    /// The series; a line joins the settings of each in the given order.
    pub series: &'a [Series],
}

/// Settings of one kind.
#[derive(Debug, Clone)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
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
    /// Whether it is the default setting of its kind, which has a ring.
    pub is_usual: bool,
}

/// Errors below this are rounding.
const ROUNDING: f64 = 1e-16;
/// Greater errors are not drawn.
const GREATEST: f64 = 1e4;

/// A logarithmic axis: its decades and its positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    from: i32,
    to: i32,
    start: f64,
    end: f64,
}

impl Axis {
    /// Whole decades around the values, from one position to the other.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>, start: f64, end: f64) -> Axis {
        let logs = values.map(f64::log10).filter(|log| log.is_finite());
        let (least, most) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), log| {
            (least.min(log), most.max(log))
        });
        if least > most {
            return Axis { from: 0, to: 1, start, end };
        }
        let from = least.floor() as i32;
        Axis { from, to: (most.ceil() as i32).max(from + 1), start, end }
    }

    /// The position of a value.
    #[must_use]
    pub fn at(&self, value: f64) -> f64 {
        let part = (value.log10() - f64::from(self.from)) / f64::from(self.to - self.from);
        self.start + part * (self.end - self.start)
    }

    /// Decades at equal steps from one end, at most `most` of them.
    pub fn marks(&self, most: usize) -> impl Iterator<Item = i32> + use<> {
        let decades = (self.to - self.from) as usize;
        (self.from..=self.to).step_by(1 + decades / most.max(2))
    }
}

/// Draws the plot.
#[must_use]
pub fn svg(plot: &Plot<'_>) -> String {
    let axis = |label: &str, tick: fn(f64) -> String| Labelled {
        label: label.to_owned(),
        scale: Scale::Logarithmic,
        tick: Some(tick),
    };
    let series = plot.series.iter().map(|series| {
        let points = series.points.iter();
        svg::Series {
            name: series.name.clone(),
            pieces: vec![points.map(|point| (point.seconds, shown(point.error))).collect()],
            kind: Kind::Marks(series.points.iter().position(|point| point.is_usual)),
        }
    });
    svg::chart(&Chart {
        title: plot.title.to_owned(),
        across: axis(plot.across, |seconds| time(seconds.log10().round() as i32)),
        up: axis(plot.up, |error| format!("{error:.0e}")),
        series: series.collect(),
        marks: Vec::new(),
    })
}

/// An error limited to the range of the logarithmic axis.
#[must_use]
pub fn shown(error: f64) -> f64 {
    error.clamp(ROUNDING, GREATEST)
}

/// A power of ten in seconds, as text.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<Point>) -> String {
        let series = [Series { name: "exact & <co>".to_owned(), points }];
        svg(&Plot { title: "Error against time", across: "time", up: "error", series: &series })
    }

    #[test]
    fn every_setting_has_a_mark_and_the_default_one_has_a_ring() {
        let point = |seconds, error, is_usual| Point { seconds, error, is_usual };
        let drawn = plot(vec![point(1e-6, 1e-3, false), point(2e-5, 0.0, true)]);
        // The label of the upward axis, two marks and the legend.
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
    fn an_empty_plot_is_drawn_without_a_panic() {
        assert!(!plot(Vec::new()).contains("NaN"));
    }
}
