//! The table of pictures: every chart and the teeth, each with its key, its results and its drawing.

use std::fmt;

use super::chart::Chart;
use super::charts::{
    NamedCase, SPECTRUM, SPEED, TOOTH_KEYS, graph_chart, spectrum_chart, speed_chart, tooth_chart,
};
use super::graphs::{GRAPHS, Graph};
use super::pattern::{PATTERN, pattern_chart};
use super::relief::{RELIEF, relief_chart, tolerances};
use super::solve::{Part, Subject, Unsolved};
use super::{Report, svg};
use crate::model::Refusal;
use crate::model::compliance::model_of;

/// The pictures that are not charts of [`GRAPHS`]; they follow those charts.
const OTHERS: [Picture; 7] = [
    Picture { is_on_page: false, ..of_one(TOOTH_KEYS[0], Part::Flanks, |cases| tooth(0, cases)) },
    Picture { is_on_page: false, ..of_one(TOOTH_KEYS[1], Part::Flanks, |cases| tooth(1, cases)) },
    Picture { is_of_one_case: false, ..of_one(SPECTRUM, Part::Stations, spectrum) },
    Picture { is_of_one_case: false, ..of_one(SPEED, Part::Speeds, speed) },
    of_one(RELIEF, Part::Stations, reliefs),
    of_one(PATTERN, Part::Stations, pattern),
    of_one("teeth", Part::Stations, teeth),
];

/// A picture of solved cases.
#[derive(Debug, Clone, Copy)]
pub struct Picture {
    /// The key, as in `plot --chart`.
    pub key: &'static str,
    /// The results that the picture shows.
    pub part: Part,
    /// Whether each case has a separate picture.
    pub is_of_one_case: bool,
    /// Whether the page of a report includes the picture.
    pub is_on_page: bool,
    drawing: Drawing,
}

/// The SVG of solved cases.
type Draw = fn(&[NamedCase]) -> Result<String, String>;

#[derive(Debug, Clone, Copy)]
enum Drawing {
    Graph(&'static Graph),
    Other(Draw),
}

const fn of_one(key: &'static str, part: Part, draw: Draw) -> Picture {
    let drawing = Drawing::Other(draw);
    Picture { key, part, is_of_one_case: true, is_on_page: true, drawing }
}

fn first<'a>(cases: &[NamedCase<'a>]) -> Result<(&'a Subject, &'a Report), String> {
    let case = cases.first().map(|(_, case)| *case);
    case.and_then(|case| Some((case, case.own()?))).ok_or_else(|| "no case is solved".to_owned())
}

fn tooth(gear: usize, cases: &[NamedCase]) -> Result<String, String> {
    let (case, report) = first(cases)?;
    match &case.flanks {
        Some(Ok(flanks)) => tooth_chart(gear, flanks, model_of(&report.inputs)).map(draw),
        Some(Err(refusal)) => Err(refusal.to_string()),
        None => Err("it is not computed".to_owned()),
    }
}

fn spectrum(cases: &[NamedCase]) -> Result<String, String> {
    spectrum_chart(cases).map(draw)
}

fn speed(cases: &[NamedCase]) -> Result<String, String> {
    let named = cases.iter().filter_map(|(name, case)| Some((*name, case.speeds.as_ref()?)));
    speed_chart(&named.collect::<Vec<_>>()).map(draw)
}

fn reliefs(cases: &[NamedCase]) -> Result<String, String> {
    let (_, report) = first(cases)?;
    let (reliefs, geometry) = (report.inputs.reliefs(), &report.solution.geometry);
    relief_chart(&reliefs, geometry, tolerances(&report.case)).map(draw)
}

fn pattern(cases: &[NamedCase]) -> Result<String, String> {
    let (case, report) = first(cases)?;
    let solutions = case.reports.iter().map(|report| &report.solution);
    pattern_chart(&report.inputs, &solutions.collect::<Vec<_>>()).map(draw)
}

fn teeth(cases: &[NamedCase]) -> Result<String, String> {
    let (_, report) = first(cases)?;
    Ok(svg::teeth::teeth(&report.inputs, &report.solution))
}

#[expect(clippy::needless_pass_by_value, reason = "it is mapped over charts that nobody else has")]
fn draw(chart: Chart) -> String {
    svg::draw(&chart)
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq)]
pub enum NoPicture {
    /// The model refuses the case, or the computation is stopped.
    Refused(Refusal),
    /// The case has no values for the picture.
    Absent(String),
}

/// Every picture: the charts of the stations, the charts with their own axes, the teeth.
pub fn pictures() -> impl Iterator<Item = Picture> + Clone {
    let graph = |graph: &'static Graph| Picture {
        key: graph.key,
        part: if graph.by_model.is_some() { Part::Path } else { Part::Stations },
        is_of_one_case: false,
        is_on_page: graph.is_on_page,
        drawing: Drawing::Graph(graph),
    };
    GRAPHS.iter().map(graph).chain(OTHERS)
}

/// The picture with a key.
#[must_use]
pub fn find(key: &str) -> Option<Picture> {
    pictures().find(|picture| picture.key == key)
}

impl Picture {
    /// Draws solved cases; a picture of one case draws the first.
    ///
    /// # Errors
    /// The reason if no case has values for the picture.
    pub fn draw(self, cases: &[NamedCase]) -> Result<String, String> {
        match self.drawing {
            Drawing::Graph(graph) => graph_chart(graph, cases).map(draw),
            Drawing::Other(draw) => draw(cases),
        }
    }

    /// Solves a case and draws it. `go_on` receives the number of computed parts and their total,
    /// and stops the computation by returning false.
    ///
    /// # Errors
    /// The refusal of the model, or the reason why the case has no such picture.
    pub fn of_case(
        self,
        source: Unsolved<'_>,
        go_on: &dyn Fn(usize, usize) -> bool,
    ) -> Result<String, NoPicture> {
        let fix = if self.part == Part::Speeds { "" } else { ": choose another chart" };
        self.draw(&[("", &source.part(self.part, go_on)?)])
            .map_err(|reason| NoPicture::Absent(format!("{self} has no curve: {reason}{fix}")))
    }
}

/// The name of the picture in a sentence.
impl fmt::Display for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.key {
            "teeth" => f.write_str("the teeth"),
            key => write!(f, "the chart {key}"),
        }
    }
}

impl PartialEq for Picture {
    fn eq(&self, other: &Picture) -> bool {
        self.key == other.key
    }
}

impl Eq for Picture {}

impl From<Refusal> for NoPicture {
    fn from(refusal: Refusal) -> NoPicture {
        NoPicture::Refused(refusal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_picture_has_a_key_of_its_own() {
        let keys: Vec<&str> = pictures().map(|picture| picture.key).collect();
        for (at, key) in keys.iter().enumerate() {
            assert_eq!(keys.iter().position(|other| other == key), Some(at), "{key}");
            assert_eq!(find(key).map(|picture| picture.key), Some(*key));
        }
        assert!(["force", "spectrum", "speed", "teeth"].iter().all(|key| keys.contains(key)));
    }
}
