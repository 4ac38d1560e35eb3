//! The table of pictures: every chart and the teeth, each with its key, its results and its drawing.

use std::fmt;

use super::charts::{
    NamedCase, SPECTRUM, SPEED, TOOTH_KEYS, graph_chart, spectrum_chart, speed_chart, tooth_chart,
};
use super::graphs::{GRAPHS, Graph};
use super::relief::{RELIEF, relief_chart, tolerances};
use super::solve::{Part, Unsolved};
use super::svg;
use crate::model::Refusal;
use crate::model::compliance::model_of;

/// The pictures that are not charts of [`GRAPHS`]; they follow those charts.
const OTHERS: [Picture; 6] = [
    Picture { key: TOOTH_KEYS[0], drawing: Drawing::ToothCompliance(0) },
    Picture { key: TOOTH_KEYS[1], drawing: Drawing::ToothCompliance(1) },
    Picture { key: SPECTRUM, drawing: Drawing::Spectrum },
    Picture { key: SPEED, drawing: Drawing::Speed },
    Picture { key: RELIEF, drawing: Drawing::Relief },
    Picture { key: "teeth", drawing: Drawing::Teeth },
];

/// A picture of solved cases.
#[derive(Debug, Clone, Copy)]
pub struct Picture {
    /// The key, as in `plot --chart`.
    pub key: &'static str,
    drawing: Drawing,
}

#[derive(Debug, Clone, Copy)]
enum Drawing {
    Graph(&'static Graph),
    /// The driver (0) or the driven gear (1).
    ToothCompliance(usize),
    Spectrum,
    Speed,
    Relief,
    Teeth,
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
    let graph = |graph: &'static Graph| Picture { key: graph.key, drawing: Drawing::Graph(graph) };
    GRAPHS.iter().map(graph).chain(OTHERS)
}

/// The picture with a key.
#[must_use]
pub fn find(key: &str) -> Option<Picture> {
    pictures().find(|picture| picture.key == key)
}

impl Picture {
    /// Whether the page of a report includes the picture.
    #[must_use]
    pub fn is_on_page(self) -> bool {
        match self.drawing {
            Drawing::Graph(graph) => graph.is_on_page,
            Drawing::ToothCompliance(_) => false,
            Drawing::Spectrum | Drawing::Speed | Drawing::Relief | Drawing::Teeth => true,
        }
    }

    /// The results that the picture shows.
    #[must_use]
    pub fn part(self) -> Part {
        match self.drawing {
            Drawing::Graph(Graph { by_model: Some(_), .. }) => Part::Path,
            Drawing::ToothCompliance(_) => Part::Flanks,
            Drawing::Speed => Part::Speeds,
            Drawing::Graph(_) | Drawing::Spectrum | Drawing::Relief | Drawing::Teeth => {
                Part::Stations
            }
        }
    }

    /// Whether each case has a separate picture.
    #[must_use]
    pub fn is_of_one_case(self) -> bool {
        matches!(self.drawing, Drawing::Teeth | Drawing::Relief | Drawing::ToothCompliance(_))
    }

    /// Draws solved cases; a picture of one case draws the first.
    ///
    /// # Errors
    /// The reason if no case has values for the picture.
    pub fn draw(self, cases: &[NamedCase]) -> Result<String, String> {
        let first = || {
            let case = cases.first().map(|(_, case)| *case);
            case.and_then(|case| Some((case, case.own()?))).ok_or("no case is solved")
        };
        let chart = match self.drawing {
            Drawing::Graph(graph) => graph_chart(graph, cases),
            Drawing::ToothCompliance(gear) => {
                let (case, report) = first()?;
                match &case.flanks {
                    Some(Ok(flanks)) => tooth_chart(gear, flanks, model_of(&report.inputs)),
                    Some(Err(refusal)) => Err(refusal.to_string()),
                    None => Err("it is not computed".to_owned()),
                }
            }
            Drawing::Spectrum => spectrum_chart(cases),
            Drawing::Speed => {
                let named =
                    cases.iter().filter_map(|(name, case)| Some((*name, case.speeds.as_ref()?)));
                speed_chart(&named.collect::<Vec<_>>())
            }
            Drawing::Relief => {
                let (_, report) = first()?;
                let reliefs = report.inputs.reliefs();
                relief_chart(&reliefs, &report.solution.geometry, tolerances(&report.case))
            }
            Drawing::Teeth => {
                let (_, report) = first()?;
                return Ok(svg::teeth::teeth(&report.inputs, &report.solution));
            }
        };
        chart.map(|chart| svg::draw(&chart))
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
        let part = self.part();
        let fix = if part == Part::Speeds { "" } else { ": choose another chart" };
        self.draw(&[("", &source.part(part, go_on)?)])
            .map_err(|reason| NoPicture::Absent(format!("{self} has no curve: {reason}{fix}")))
    }
}

/// The name of the picture in a sentence.
impl fmt::Display for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.drawing {
            Drawing::Teeth => f.write_str("the teeth"),
            _ => write!(f, "the chart {}", self.key),
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
