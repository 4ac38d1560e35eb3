//! A study as its user asked for it: enough to set it up again on another machine.

use serde::{Deserialize, Serialize};

use super::sweep::Grid;
use super::tolerance::{Size, Tolerance};
use crate::case::{Case, Document, Problem, stamp, unknown_quantity};
use crate::model::{Inputs, Quantity};

/// A case and what is done with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// The case's name, as the user gave it.
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
    /// Those of `sweep`.
    Sweep {
        /// Each `--vary`.
        vary: Vec<String>,
        /// Each `--points`.
        points: Vec<usize>,
        /// Whether `--log` is given.
        log: bool,
    },
    /// Those of `tolerance`.
    Tolerance {
        /// Number of samples.
        samples: usize,
        /// Seed of the samples.
        seed: u64,
        /// Number of samples of the ranking.
        ranked: usize,
    },
}

/// A study that is set up again.
pub struct Restored {
    /// The case.
    pub case: Case,
    /// What the model reads of it.
    pub inputs: Inputs,
    /// The quantities.
    pub quantities: Vec<&'static Quantity>,
    /// The points.
    pub study: Study,
}

/// The points of a study that is set up again.
pub enum Study {
    /// Of `sweep`.
    Sweep(Grid),
    /// Of `tolerance`.
    Tolerance(Tolerance),
}

impl Request {
    /// A hash of the study and of this version of the program.
    #[must_use]
    pub fn hash(&self) -> String {
        let text = serde_json::to_string(self).unwrap_or_default();
        let versioned = format!("{} {text}", env!("CARGO_PKG_VERSION"));
        format!("{:016x}", stamp::hash(versioned.as_bytes()))
    }

    /// Sets the study up again.
    ///
    /// # Errors
    /// Where the request is not one that this version wrote.
    pub fn restore(&self) -> Result<Restored, Problem> {
        let document = Document::parse(&self.name, &self.case).map_err(|faults| Problem {
            field: "case".to_owned(),
            cause: faults.first().map(ToString::to_string).unwrap_or_default(),
            fix: "run the shard again".to_owned(),
        })?;
        let case = document.case;
        let inputs = case
            .inputs()
            .map_err(|mut problems| problems.swap_remove(0))?;
        let quantities = self
            .quantities
            .iter()
            .map(|key| Quantity::find(key).ok_or_else(|| unknown_quantity("quantities", key)))
            .collect::<Result<Vec<_>, _>>()?;
        let study = match &self.points {
            PointsRequest::Sweep { vary, points, log } => {
                Study::Sweep(Grid::parse(vary, points, *log).map_err(|(_, problem)| problem)?)
            }
            PointsRequest::Tolerance {
                samples,
                seed,
                ranked,
            } => {
                let size = Size {
                    samples: *samples,
                    seed: *seed,
                    ranked: Some(*ranked),
                };
                Study::Tolerance(Tolerance::of(&case, &inputs, &quantities, size)?)
            }
        };
        Ok(Restored {
            case,
            inputs,
            quantities,
            study,
        })
    }
}
