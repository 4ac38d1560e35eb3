//! The charts of whine in the workbench: harmonics of the transmission error, and dynamic factor
//! over speed. A worker computes them.

use crate::model::Inputs;
use crate::report::svg::Chart;
use crate::report::whine::charts::{self, NamedSpectra};
use crate::study::speeds::SpeedCurve;

/// A chart of whine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhineChart {
    /// Harmonics of the transmission error.
    Spectrum,
    /// Dynamic factor over speed.
    Speed,
}

impl WhineChart {
    /// Every chart, in their order after the charts of the stations.
    pub const ALL: [WhineChart; 2] = [WhineChart::Spectrum, WhineChart::Speed];

    /// The key, as in `plot --chart`.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            WhineChart::Spectrum => charts::SPECTRUM,
            WhineChart::Speed => charts::SPEED,
        }
    }

    /// The description in lists.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            WhineChart::Spectrum => {
                "Show the harmonics of the transmission error at rest and in motion."
            }
            WhineChart::Speed => {
                "Show the dynamic factor over speed, up and down, with the resonances."
            }
        }
    }

    /// Titles with their units for axes without labels, the longest first.
    #[must_use]
    pub fn short_titles(self) -> [&'static str; 2] {
        match self {
            WhineChart::Spectrum => ["Transmission error harmonics in um", "TE harmonics in um"],
            WhineChart::Speed => [
                "Dynamic factor over speed in rpm",
                "Dynamic factor over rpm",
            ],
        }
    }

    /// The description in the status line.
    #[must_use]
    pub fn hint(self) -> &'static str {
        match self {
            WhineChart::Spectrum => {
                "The amplitude of each harmonic of the mesh frequency, at rest and in motion."
            }
            WhineChart::Speed => {
                "N is the mesh frequency over the natural frequency. N = 1, 1/2 and 1/3 mark the \
                    resonances."
            }
        }
    }

    /// The name in lists.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            WhineChart::Spectrum => "Spectrum",
            WhineChart::Speed => "Dynamic factor over speed",
        }
    }
}

/// A request for a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct WhineRequest {
    /// Unique serial of the request.
    pub serial: u64,
    /// The chart.
    pub chart: WhineChart,
    /// The pair.
    pub inputs: Inputs,
}

/// The values of a chart.
#[derive(Debug, Clone, PartialEq)]
pub enum WhineFound {
    /// The spectra, by name.
    Spectra(NamedSpectra),
    /// The computed part of the curve over speed.
    Speeds(Box<SpeedCurve>),
    /// The reason why there is no chart.
    Refused(String),
}

/// A part of the result of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct WhinePart {
    /// The serial of the request.
    pub serial: u64,
    /// The values so far; `None` if the computation ends without values.
    pub found: Option<WhineFound>,
    /// Whether the computation has ended.
    pub is_over: bool,
}

/// The chart of a case: the last request and its values.
#[derive(Debug, Clone, Default)]
pub struct Whine {
    /// The last request.
    pub request: Option<WhineRequest>,
    /// The values; those of an earlier request until the first values of the last one arrive.
    pub found: Option<(WhineChart, WhineFound)>,
    /// Whether the worker still computes the last request.
    pub is_running: bool,
}

impl Whine {
    /// Adds a part of the result of the last request.
    pub fn take(&mut self, part: WhinePart) {
        let Some(request) = self
            .request
            .as_ref()
            .filter(|request| request.serial == part.serial)
        else {
            return;
        };
        if let Some(found) = part.found {
            self.found = Some((request.chart, found));
        }
        self.is_running = !part.is_over;
    }

    /// The computed part of the chart.
    #[must_use]
    pub fn drawn(&self, chart: WhineChart) -> Option<Chart> {
        let (_, found) = self.found.as_ref().filter(|(own, _)| *own == chart)?;
        match found {
            WhineFound::Spectra(spectra) => charts::spectrum_chart(spectra.clone()),
            WhineFound::Speeds(curve) => charts::speed_chart(&[("", curve)]),
            WhineFound::Refused(_) => None,
        }
    }

    /// The reason why there is no chart.
    #[must_use]
    pub fn missing(&self, chart: WhineChart) -> String {
        match &self.found {
            Some((own, WhineFound::Refused(reason))) if *own == chart => reason.clone(),
            _ if self.is_running => "computing".to_owned(),
            Some(_) => "The motion does not become steady: increase the damping ratio.".to_owned(),
            None => "The form is not valid: no chart.".to_owned(),
        }
    }
}
