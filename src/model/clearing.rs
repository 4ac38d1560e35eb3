//! The least tip relief of the driven gear with which the incoming tooth does not touch before E, by each rung itself.

use std::cell::Cell;

use super::dynamic::{self, Settings};
use super::inputs::{Gear, Inputs, Rung};
use super::load_sharing::on_mesh;
use super::position::printed_relief_to_clear;
use super::static_load;
use super::{Outcome, Refusal, Solution};

/// What was found of that relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearing {
    /// The relief beyond what the gear has, in m; none where the tooth comes in on time anyhow, or where `withheld` says why.
    pub relief: Option<f64>,
    /// Why there is none for a tooth that touches.
    pub withheld: Option<Refusal>,
    /// How many balances or motions were tried.
    pub runs: u32,
}

impl Clearing {
    const NEEDLESS: Clearing = Clearing { relief: None, withheld: None, runs: 0 };
}

pub(super) fn clearing(inputs: &Inputs, solution: &Solution, go_on: &dyn Fn(f64) -> bool) -> Result<Clearing, Refusal> {
    if solution.outcome == Outcome::NoCornerContact {
        return Ok(Clearing::NEEDLESS);
    }
    match inputs.rung {
        Rung::Paper => {
            let relief = printed_relief_to_clear(inputs, &solution.kept.deviation)?;
            Ok(Clearing { relief, ..Clearing::NEEDLESS })
        }
        Rung::Static | Rung::Dynamic => searched(inputs, solution, go_on),
        _ => Ok(Clearing { relief: Some(solution.deviation.total), ..Clearing::NEEDLESS }),
    }
}

fn searched(inputs: &Inputs, solution: &Solution, go_on: &dyn Fn(f64) -> bool) -> Result<Clearing, Refusal> {
    let runs = Cell::new(0);
    let lead = |more: f64| {
        runs.set(runs.get() + 1);
        lead_with(more, inputs, solution, go_on)
    };
    let deviation = &solution.deviation;
    let most = MOST * (deviation.combined_deflection + deviation.equivalent_error.abs() + inputs.driven.tip_relief);
    match least(lead, most) {
        Ok(relief) => Ok(Clearing { relief: Some(relief), withheld: None, runs: runs.get() }),
        Err(Refusal::Stopped) => Err(Refusal::Stopped),
        Err(refusal) => Ok(Clearing { relief: None, withheld: Some(refusal), runs: runs.get() }),
    }
}

const MOST: f64 = 8.0;

/// How far the incoming tooth of the pair with so much more tip relief is early, in m.
pub fn lead_with(more: f64, inputs: &Inputs, solution: &Solution, go_on: &dyn Fn(f64) -> bool) -> Result<f64, Refusal> {
    let relieved = Inputs { driven: Gear { tip_relief: inputs.driven.tip_relief + more, ..inputs.driven.clone() }, ..inputs.clone() };
    let settings = Settings::of(inputs, solution.reduced_mass);
    on_mesh(&relieved, solution, |mesh| match inputs.rung {
        Rung::Dynamic => dynamic::lead_before_start(mesh, &settings, &|_| go_on(1.0)),
        _ => static_load::lead_before_start(mesh),
    })
}

/// A relief and how far the tooth is early with it.
type Tried = (f64, f64);

fn least(lead: impl Fn(f64) -> Result<f64, Refusal>, most: f64) -> Result<f64, Refusal> {
    let mut below = (0.0, lead(0.0)?);
    if below.1 <= 0.0 {
        return Ok(0.0);
    }
    let mut more = below.1;
    let above = loop {
        more += 0.4 * width(more);
        let tried = (more, lead(more)?);
        if tried.1 <= 0.0 {
            break tried;
        }
        if more > most {
            return Err(Refusal::NoClearing { most });
        }
        let slope = ((tried.0 - below.0) / (below.1 - tried.1)).clamp(1.0, 4.0);
        let slope = if slope.is_nan() { 4.0 } else { slope };
        more = tried.0 + slope * tried.1;
        below = tried;
    };
    between(lead, below, above)
}

fn between(lead: impl Fn(f64) -> Result<f64, Refusal>, mut below: Tried, mut above: Tried) -> Result<f64, Refusal> {
    let mut before = f64::INFINITY;
    for step in 0..100 {
        let (from, to, width) = (below.0, above.0, width(above.0));
        if to - from <= width {
            break;
        }
        let crossing = from + (to - from) * below.1 / (below.1 - above.1);
        let aside = if to - crossing > crossing - from { 0.4 } else { -0.4 } * width;
        let halve = step % 3 == 2 && to - from > 0.5 * before;
        if step % 3 == 2 {
            before = to - from;
        }
        let more = if halve { f64::midpoint(from, to) } else { (crossing + aside).clamp(from + 0.2 * width, to - 0.2 * width) };
        let tried = (more, lead(more)?);
        if tried.1 > 0.0 { below = tried } else { above = tried }
    }
    Ok(above.0)
}

fn width(relief: f64) -> f64 {
    (1e-5 * relief).max(1e-13)
}
