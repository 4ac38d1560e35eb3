//! A study as a serializable request, from which another machine can run the same study.

use serde::{Deserialize, Serialize};

use super::sweep::Grid;
use super::tolerance::{Size, Tolerance};
use crate::case::{Case, Document, Problem, unknown_quantity};
use crate::model::{Inputs, Quantity};

/// A case and the study of that case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// The name of the case, as the user gave it.
    pub name: String,
    /// The text of the case with the changes of the command line.
    pub case: String,
    /// The keys of the quantities.
    pub quantities: Vec<String>,
    /// The format of the output.
    pub format: String,
    /// The points.
    pub points: PointsRequest,
}

/// The points of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "study", rename_all = "lowercase")]
pub enum PointsRequest {
    /// The points of `sweep`.
    Sweep {
        /// The arguments of each `--vary`.
        vary: Vec<String>,
        /// The arguments of each `--points`.
        points: Vec<usize>,
        /// Whether `--log` is given.
        log: bool,
    },
    /// The points of `tolerance`.
    Tolerance {
        /// Number of samples.
        samples: usize,
        /// Seed of the samples.
        seed: u64,
        /// Number of samples of the ranking.
        ranked: usize,
    },
}

/// A study that is restored from a request.
pub struct Restored {
    /// The case.
    pub case: Case,
    /// The inputs of the model.
    pub inputs: Inputs,
    /// The quantities.
    pub quantities: Vec<&'static Quantity>,
    /// The points.
    pub study: Study,
}

/// The points of a restored study.
pub enum Study {
    /// The points of `sweep`.
    Sweep(Grid),
    /// The points of `tolerance`.
    Tolerance(Tolerance),
}

impl Request {
    /// Restores the study.
    ///
    /// # Errors
    /// Returns an error if this version did not write the request.
    pub fn restore(&self) -> Result<Restored, Problem> {
        let document = Document::parse(&self.name, &self.case).map_err(|faults| Problem {
            field: "case".to_owned(),
            cause: faults.first().map(ToString::to_string).unwrap_or_default(),
            fix: "run the shard again".to_owned(),
        })?;
        let case = document.case;
        let inputs = case.inputs().map_err(|mut problems| problems.swap_remove(0))?;
        let quantities = self
            .quantities
            .iter()
            .map(|key| Quantity::find(key).ok_or_else(|| unknown_quantity("quantities", key)))
            .collect::<Result<Vec<_>, _>>()?;
        let study = match &self.points {
            PointsRequest::Sweep { vary, points, log } => {
                Study::Sweep(Grid::parse(vary, points, *log).map_err(|(_, problem)| problem)?)
            }
            PointsRequest::Tolerance { samples, seed, ranked } => {
                let size = Size { samples: *samples, seed: *seed, ranked: Some(*ranked) };
                Study::Tolerance(Tolerance::of(&case, &inputs, &quantities, size)?)
            }
        };
        Ok(Restored { case, inputs, quantities, study })
    }
}
