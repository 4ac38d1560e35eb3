//! Results of a relief from whole solves: transmission error at each load, gaps at the corners,
//! greatest load.

use std::cell::Cell;

use super::bench::{PreparedMesh, tolerances};
use super::search::Grid;
use super::{Choice, Demand, MOST_LOAD, NoRelief, TipReliefs};
use crate::model::inputs::{Drive, Gear};
use crate::model::static_load::{lead_after_end, lead_before_start};
use crate::model::{Inputs, Refusal, Solution, Stage, Stages, solve_while};

/// Steps by which the amount of a relief grows if a whole solve finds an overlap.
const GROWTHS: [i32; 12] = [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48];

/// The case with a fraction of its load.
pub(super) fn loaded(inputs: &Inputs, part: f64) -> Inputs {
    Inputs { drive: Drive::Torque(part * inputs.torque()), ..inputs.clone() }
}

/// The case with other tip reliefs and their deviations.
fn relieved(inputs: &Inputs, reliefs: &TipReliefs, off: [f64; 2]) -> Inputs {
    let gear = |gear: &Gear, at: usize| Gear {
        tip_relief: (reliefs.amounts[at] + off[at]).max(0.0),
        tip_relief_length: Some(reliefs.lengths[at]),
        ..gear.clone()
    };
    Inputs {
        driver: gear(&inputs.driver, 0),
        driven: gear(&inputs.driven, 1),
        relief_shape: reliefs.shape,
        ..inputs.clone()
    }
}

/// Inputs of the results of a relief.
pub(super) struct Figures<'a> {
    pub(super) inputs: &'a Inputs,
    /// The case with method `dynamic`, if this method decides.
    pub(super) motion: Option<&'a Inputs>,
    /// The case under the greatest load of the demand, and its solution.
    pub(super) at_most: (&'a Inputs, &'a Solution),
    pub(super) demand: &'a Demand,
    pub(super) loads: &'a [f64],
    pub(super) grid: &'a Grid,
    pub(super) go_on: &'a dyn Fn(f64) -> bool,
    /// The progress so far.
    pub(super) part: Cell<f64>,
}

impl Figures<'_> {
    /// The reliefs of the case.
    pub(super) fn present(&self) -> Result<Choice, NoRelief> {
        let inputs = self.inputs;
        let usual = self.at_most.1.geometry.shared_length();
        let length = |gear: &Gear| gear.tip_relief_length.unwrap_or(usual);
        self.choice(
            "relief of the case",
            TipReliefs {
                shape: inputs.relief_shape,
                amounts: [inputs.driver.tip_relief, inputs.driven.tip_relief],
                lengths: [length(&inputs.driver), length(&inputs.driven)],
            },
        )
    }

    /// Increases a relief until no whole solve finds corner contact.
    pub(super) fn cleared(
        &self,
        name: &'static str,
        reliefs: TipReliefs,
    ) -> Result<Choice, NoRelief> {
        let (mut greatest, mut overlap) = (reliefs, f64::INFINITY);
        for steps in GROWTHS {
            let Some(greater) = self.grid.greater(&reliefs, steps) else {
                break;
            };
            (greatest, overlap) = (greater, self.overlap(&greater)?);
            if overlap <= 0.0 && !self.strikes_in_motion(&greater)? {
                return self.choice(name, greater);
            }
        }
        let most = greatest.amounts[0].max(greatest.amounts[1]);
        Err(if overlap > 0.0 {
            NoRelief::Beyond { most, overlap }
        } else {
            NoRelief::InMotion { most }
        })
    }

    fn choice(&self, name: &'static str, reliefs: TipReliefs) -> Result<Choice, NoRelief> {
        let errors = self.loads.iter().map(|&part| {
            let inputs = relieved(&loaded(self.inputs, part), &reliefs, [0.0; 2]);
            let solution = self.solve(&inputs, Stage::StaticSpectrum)?;
            let found = solution.static_spectrum.transpose()?;
            Ok(found.map_or(0.0, |found| found.spectrum.peak_to_peak))
        });
        Ok(Choice {
            name,
            reliefs,
            errors: errors.collect::<Result<_, NoRelief>>()?,
            margin: -self.overlap(&reliefs)?,
        })
    }

    /// Overlap of the teeth at the greatest load with the least favourable tolerance, in m.
    fn overlap(&self, reliefs: &TipReliefs) -> Result<f64, NoRelief> {
        let mut worst = f64::NEG_INFINITY;
        for off in tolerances(self.demand.tolerance) {
            let solution = self.solve(&relieved(self.at_most.0, reliefs, off), Stage::Static)?;
            if let Some(mesh) = &solution.mesh {
                let leads = [lead_before_start(mesh)?, lead_after_end(mesh)?];
                worst = leads.into_iter().fold(worst, f64::max);
            }
        }
        Ok(worst)
    }

    /// Whether a tip touches off the path of contact in motion at the greatest load.
    fn strikes_in_motion(&self, reliefs: &TipReliefs) -> Result<bool, NoRelief> {
        let Some(inputs) = self.motion else {
            return Ok(false);
        };
        let inputs = loaded(inputs, self.demand.loads.1);
        for off in tolerances(self.demand.tolerance) {
            let solution = self.solve(&relieved(&inputs, reliefs, off), Stage::Dynamic)?;
            let strikes = solution.dynamic.is_some_and(|found| {
                found.first_contact_angle.is_some() || found.last_contact_angle.is_some()
            });
            if strikes {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn solve(&self, inputs: &Inputs, stage: Stage) -> Result<Solution, NoRelief> {
        Ok(solve_while(inputs, Stages::of(stage), &|_| (self.go_on)(self.part.get()))?)
    }

    /// The greatest load without overlap at rest, relative to the load of the case. `None` if even
    /// [`MOST_LOAD`] times the greatest load of the range has no overlap.
    pub(super) fn greatest_load(
        &self,
        bench: &PreparedMesh,
        reliefs: &TipReliefs,
    ) -> Result<Option<f64>, NoRelief> {
        const CLOSE: f64 = 1e-3;
        let greatest = self.demand.loads.1;
        let clears = |times: f64| {
            let overlap = bench.overlap_under(reliefs, self.at_most, times)?;
            Ok::<bool, NoRelief>(overlap <= 0.0)
        };
        let (mut low, mut high) = (1.0, 2.0);
        while clears(high)? {
            if high >= MOST_LOAD {
                return Ok(None);
            }
            (low, high) = (high, 2.0 * high);
        }
        while high - low > CLOSE * high {
            if !(self.go_on)(self.part.get()) {
                return Err(NoRelief::Refused(Refusal::Stopped));
            }
            let middle = f64::midpoint(low, high);
            if clears(middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(Some(greatest * low))
    }
}
