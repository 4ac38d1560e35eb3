//! An axis of a picture: positions of values, and round ticks.

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

#[cfg(test)]
mod tests {
    use super::*;

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
