//! Results of work beside the loop that panes show: the benchmark and the charts with their own axes.

use crate::model::Inputs;
use crate::report::chart::Chart;
use crate::report::charts;
use crate::report::pattern::PATTERN;
use crate::study::trade::{Setting, Trade};

/// The benchmark of a case, with error and time of every setting.
#[derive(Debug, Clone)]
pub struct Traded {
    /// The number of its work.
    pub(crate) work: u64,
    /// The pair at the time of the request.
    pub(crate) inputs: Inputs,
    /// The results so far.
    pub trade: Option<Trade>,
    /// The selected setting.
    pub marked: Option<Setting>,
}

/// The view of the trade pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum TradeView {
    /// Error against time of every setting.
    #[default]
    Chart,
    /// Time and error of every method with every compliance.
    Table,
}

impl TradeView {
    /// The other view.
    pub(crate) fn other(self) -> TradeView {
        match self {
            TradeView::Chart => TradeView::Table,
            TradeView::Table => TradeView::Chart,
        }
    }
}

impl Traded {
    /// Whether the case has changed since the benchmark, apart from its setting.
    pub(crate) fn is_stale(&self, inputs: &Inputs) -> bool {
        let with_setting = Inputs {
            method: inputs.method,
            tooth_compliance: inputs.tooth_compliance,
            contact_compliance: inputs.contact_compliance,
            tolerance: inputs.tolerance,
            within: inputs.within,
            stations: inputs.stations,
            station_tolerance: inputs.station_tolerance,
            accurate: inputs.accurate,
            ..self.inputs.clone()
        };
        with_setting != *inputs
    }
}

/// A chart with its own axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnChart {
    /// Compliance of a tooth of the driver (0) or of the driven gear (1) over its flank.
    ToothCompliance(usize),
    /// Harmonics of the transmission error.
    Spectrum,
    /// Dynamic factor over speed.
    Speed,
    /// Line load over roll angle and face width, with the contact lines; not computed by the worker.
    Pattern,
}

impl OwnChart {
    /// Every chart, in their order after the charts of the stations.
    pub const ALL: [OwnChart; 5] = [
        OwnChart::ToothCompliance(0),
        OwnChart::ToothCompliance(1),
        OwnChart::Spectrum,
        OwnChart::Speed,
        OwnChart::Pattern,
    ];

    /// The key, as in `plot --chart`.
    pub fn key(self) -> &'static str {
        match self {
            OwnChart::ToothCompliance(gear) => charts::TOOTH_KEYS[gear],
            OwnChart::Spectrum => charts::SPECTRUM,
            OwnChart::Speed => charts::SPEED,
            OwnChart::Pattern => PATTERN,
        }
    }

    /// The name and the description in lists, and the description in the status line.
    pub fn words(self) -> [&'static str; 3] {
        const TOOTH: &str = "The deflection of the loaded tooth per unit load; surface includes the \
            contact. C is the pitch circle.";
        match self {
            OwnChart::ToothCompliance(0) => [
                "Driver tooth compliance",
                "Show the compliance of a tooth of the driver over its flank, by every model.",
                TOOTH,
            ],
            OwnChart::ToothCompliance(_) => [
                "Driven tooth compliance",
                "Show the compliance of a tooth of the driven gear over its flank, by every model.",
                TOOTH,
            ],
            OwnChart::Spectrum => [
                "Spectrum",
                "Show the harmonics of the transmission error at rest and in motion.",
                "The amplitude of each harmonic of the mesh frequency, at rest and in motion.",
            ],
            OwnChart::Speed => [
                "Dynamic factor over speed",
                "Show the dynamic factor over speed, up and down, with the resonances.",
                "N is the mesh frequency over the natural frequency. N = 1, 1/2 and 1/3 mark the \
                    resonances.",
            ],
            OwnChart::Pattern => [
                "Contact pattern",
                "Show the line load over roll angle and face width of a pair with slices, and its \
                    contact lines.",
                "The line load of the incoming tooth. h and l turn the gears, Up and Down move the \
                    cursor along the contact line.",
            ],
        }
    }
}

/// A request for a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartRequest {
    /// The chart.
    pub chart: OwnChart,
    /// The pair.
    pub inputs: Inputs,
}

/// The chart, or the reason why there is none.
pub(super) type ChartValues = Result<Chart, String>;

/// The chart of a case: the last request and its values.
#[derive(Debug, Clone, Default)]
pub struct ChartWork {
    /// The last request.
    pub request: Option<ChartRequest>,
    /// The values; those of an earlier request until the first values of the last one arrive.
    pub found: Option<(OwnChart, ChartValues)>,
    /// Whether the last request is not computed yet.
    pub is_running: bool,
    /// The number of its work.
    pub(crate) work: u64,
}

impl ChartWork {
    /// The computed part of the chart.
    pub fn drawn(&self, chart: OwnChart) -> Option<&Chart> {
        self.values(chart)?.as_ref().ok()
    }

    /// The reason why there is no chart.
    pub fn missing(&self, chart: OwnChart) -> String {
        match self.values(chart) {
            Some(Err(reason)) => format!("No chart: {reason}."),
            _ if self.is_running => "Computing.".to_owned(),
            _ => "The form is not valid: no chart.".to_owned(),
        }
    }

    fn values(&self, chart: OwnChart) -> Option<&ChartValues> {
        let (_, found) = self.found.as_ref().filter(|(own, _)| *own == chart)?;
        Some(found)
    }
}
