//! The charts with their own axes in the workbench: compliance of a tooth over its flank, harmonics
//! of the transmission error, and dynamic factor over speed. A worker computes the visible chart.

use crate::model::Inputs;
use crate::model::dynamic::speeds::SpeedCurve;
use crate::model::inputs::ToothCompliance;
use crate::report::svg::Chart;
use crate::report::tooth_chart::{self, tooth_chart};
use crate::report::whine::charts::{self, NamedSpectra};
use crate::study::stiffness::Flanks;

/// A chart with its own axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorkerChart {
    /// Compliance of a tooth of the driver (0) or of the driven gear (1) over its flank.
    ToothCompliance(usize),
    /// Harmonics of the transmission error.
    Spectrum,
    /// Dynamic factor over speed.
    Speed,
}

impl WorkerChart {
    /// Every chart, in their order after the charts of the stations.
    pub const ALL: [WorkerChart; 4] = [
        WorkerChart::ToothCompliance(0),
        WorkerChart::ToothCompliance(1),
        WorkerChart::Spectrum,
        WorkerChart::Speed,
    ];

    /// The key, as in `plot --chart`.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            WorkerChart::ToothCompliance(gear) => tooth_chart::KEYS[gear],
            WorkerChart::Spectrum => charts::SPECTRUM,
            WorkerChart::Speed => charts::SPEED,
        }
    }

    /// The description in lists.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            WorkerChart::ToothCompliance(0) => {
                "Show the compliance of a tooth of the driver over its flank, by every model."
            }
            WorkerChart::ToothCompliance(_) => {
                "Show the compliance of a tooth of the driven gear over its flank, by every model."
            }
            WorkerChart::Spectrum => {
                "Show the harmonics of the transmission error at rest and in motion."
            }
            WorkerChart::Speed => {
                "Show the dynamic factor over speed, up and down, with the resonances."
            }
        }
    }

    /// Titles with their units for axes without labels, the longest first.
    #[must_use]
    pub fn short_titles(self) -> &'static [&'static str] {
        match self {
            WorkerChart::ToothCompliance(0) => &[
                "Driver tooth compliance in um mm/N over radius in mm",
                "Driver q in um mm/N over r in mm",
                "Driver q in um mm/N",
            ],
            WorkerChart::ToothCompliance(_) => &[
                "Driven tooth compliance in um mm/N over radius in mm",
                "Driven q in um mm/N over r in mm",
                "Driven q in um mm/N",
            ],
            WorkerChart::Spectrum => &["Transmission error harmonics in um", "TE harmonics in um"],
            WorkerChart::Speed => &["Dynamic factor over speed in rpm", "Dynamic factor over rpm"],
        }
    }

    /// The description in the status line.
    #[must_use]
    pub fn hint(self) -> &'static str {
        match self {
            WorkerChart::ToothCompliance(_) => {
                "The deflection of the loaded tooth per unit load; surface includes the contact. C \
                    is the pitch circle."
            }
            WorkerChart::Spectrum => {
                "The amplitude of each harmonic of the mesh frequency, at rest and in motion."
            }
            WorkerChart::Speed => {
                "N is the mesh frequency over the natural frequency. N = 1, 1/2 and 1/3 mark the \
                    resonances."
            }
        }
    }

    /// The name in lists.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            WorkerChart::ToothCompliance(0) => "Driver tooth compliance",
            WorkerChart::ToothCompliance(_) => "Driven tooth compliance",
            WorkerChart::Spectrum => "Spectrum",
            WorkerChart::Speed => "Dynamic factor over speed",
        }
    }
}

/// A request for a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartRequest {
    /// Unique serial of the request.
    pub serial: u64,
    /// The chart.
    pub chart: WorkerChart,
    /// The pair.
    pub inputs: Inputs,
}

/// The values of a chart.
#[derive(Debug, Clone, PartialEq)]
pub enum ChartValues {
    /// The tooth compliances of both gears, and the model of the case.
    Flanks(Box<Flanks>, ToothCompliance),
    /// The spectra, by name.
    Spectra(NamedSpectra),
    /// The computed part of the curve over speed.
    Speeds(Box<SpeedCurve>),
    /// The reason why there is no chart.
    Refused(String),
}

/// A part of the result of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartPart {
    /// The serial of the request.
    pub serial: u64,
    /// The values so far; `None` if the computation ends without values.
    pub found: Option<ChartValues>,
    /// Whether the computation has ended.
    pub is_over: bool,
}

/// The chart of a case: the last request and its values.
#[derive(Debug, Clone, Default)]
pub struct ChartWork {
    /// The last request.
    pub request: Option<ChartRequest>,
    /// The values; those of an earlier request until the first values of the last one arrive.
    pub found: Option<(WorkerChart, ChartValues)>,
    /// Whether the worker still computes the last request.
    pub is_running: bool,
}

impl ChartWork {
    /// Adds a part of the result of the last request.
    pub fn take(&mut self, part: ChartPart) {
        let Some(request) = self.request.as_ref().filter(|request| request.serial == part.serial)
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
    pub fn drawn(&self, chart: WorkerChart) -> Option<Chart> {
        let (_, found) = self.found.as_ref().filter(|(own, _)| *own == chart)?;
        match (found, chart) {
            (ChartValues::Flanks(flanks, own), WorkerChart::ToothCompliance(gear)) => {
                tooth_chart(gear, flanks, *own)
            }
            (ChartValues::Spectra(spectra), _) => charts::spectrum_chart(spectra.clone()),
            (ChartValues::Speeds(curve), _) => charts::speed_chart(&[("", curve)]),
            (ChartValues::Flanks(..) | ChartValues::Refused(_), _) => None,
        }
    }

    /// The reason why there is no chart.
    #[must_use]
    pub fn missing(&self, chart: WorkerChart) -> String {
        match &self.found {
            Some((own, ChartValues::Refused(reason))) if *own == chart => reason.clone(),
            _ if self.is_running => "computing".to_owned(),
            Some(_) => "The motion does not become steady: increase the damping ratio.".to_owned(),
            None => "The form is not valid: no chart.".to_owned(),
        }
    }
}
