//! The one table of what a station between D and E tells, for text, JSON and CSV.

use crate::model::Station;

/// A value that every station has.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// The name in JSON and CSV.
    pub key: &'static str,
    /// The symbol in the field's writing.
    pub symbol: &'static str,
    /// The SI unit.
    pub unit: &'static str,
    /// The unit in which a person reads it.
    pub shown: &'static str,
    /// Significant digits that a person reads.
    pub digits: usize,
    /// The value in SI.
    pub value: fn(&Station) -> f64,
}

/// Every column, in the order of a row.
#[rustfmt::skip]
pub static COLUMNS: [Column; 6] = [
    Column { key: "roll_angle_driver", symbol: "θ_1", unit: "rad", shown: "deg", digits: 5, value: |s| s.roll_angle_driver },
    Column { key: "roll_angle_driven", symbol: "u", unit: "rad", shown: "deg", digits: 5, value: |s| s.roll_angle_driven },
    Column { key: "radius_driver", symbol: "O1J", unit: "m", shown: "mm", digits: 6, value: |s| s.radius_driver },
    Column { key: "normal_velocity", symbol: "ΔV_n", unit: "m/s", shown: "m/s", digits: 5, value: |s| s.normal_velocity },
    Column { key: "sliding_velocity", symbol: "ΔV_τ", unit: "m/s", shown: "m/s", digits: 5, value: |s| s.sliding_velocity },
    Column { key: "impact_force", symbol: "F_S", unit: "N", shown: "N", digits: 5, value: |s| s.impact_force },
];

impl Column {
    /// The station's value in SI where it is a number, zero without a sign.
    #[must_use]
    pub fn of(&self, station: &Station) -> Option<f64> {
        Some((self.value)(station)).filter(|value| value.is_finite()).map(|value| value + 0.0)
    }

    /// The station's value as a person reads it, without the unit.
    #[must_use]
    pub fn told(&self, station: &Station) -> String {
        super::number((self.value)(station), self.shown, self.digits)
    }
}
