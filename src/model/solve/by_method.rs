//! A solve by one method: runs the stages in order.

use std::cell::{Cell, OnceCell};

use twofloat::TwoFloat;

use crate::model::clearing::{ClearingInputs, clearing};
use crate::model::compliance::Teeth;
use crate::model::deviation::{Deflected, GivenDeviations, LoadedPairs};
use crate::model::geometry::{GeometryInputs, LoadInputs, mesh_force, precise};
use crate::model::impact::{FrictionInputs, ImpactInputs};
use crate::model::inputs::Inputs;
use crate::model::masses::{MassInputs, Masses};
use crate::model::position::{GapSeries, PositionInputs, VelocityInputs};
use crate::model::relief::check_reliefs;
use crate::model::request::{Earlier, Request};
use crate::model::stage::{Stage, Stages};
use crate::model::stations::{StationsInputs, stations};
use crate::model::{
    Deviation, Geometry, Kept, Outcome, Position, Refusal, Solution, deviation, geometry, impact,
    load_sharing, position,
};
use crate::numeric::Real;

/// Solves by the method of the inputs, which is not `auto`. Ignores an earlier solve by another
/// method.
///
/// # Errors
/// Those of [`solve_after`](super::solve_after).
pub(super) fn solve_by_method(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let earlier = earlier.filter(|earlier| earlier.solution.method == inputs.method);
    let asked = Request {
        inputs,
        wanted: wanted.within(inputs.method.stages()),
        earlier,
        changed: Cell::default(),
    };
    Solving { asked, setup: &Setup::of(inputs) }.run(go_on)
}

/// The stages of every solve.
const ALWAYS: Stages = Stages::of(Stage::Deviation).with(Stage::Masses);

/// The state of a solve.
pub(super) struct Solving<'a> {
    asked: Request<'a>,
    setup: &'a Setup,
}

impl<'a> Solving<'a> {
    /// A solve that begins with the load.
    pub(super) fn from_load(inputs: &'a Inputs, wanted: Stages, setup: &'a Setup) -> Solving<'a> {
        Solving {
            asked: Request {
                inputs,
                wanted: wanted.within(inputs.method.stages()),
                earlier: None,
                changed: Cell::default(),
            },
            setup,
        }
    }

    /// Recomputes the stages from the load on in place. Geometry and masses of the solution stay.
    pub(super) fn repeat(&self, solution: &mut Solution) -> Result<(), Refusal> {
        let inputs = self.asked.inputs;
        check_reliefs(inputs, &solution.geometry)?;
        solution.mesh_force = mesh_force(&LoadInputs::of(inputs), &solution.geometry);
        let deviation = self.deviation(&solution.geometry, solution.mesh_force)?;
        solution.deviation = deviation.rounded();
        solution.kept.deviation = deviation;
        solution.outcome = outcome(&deviation);
        solution.stages = ALWAYS;
        solution.ran = Stages::NONE.with(Stage::Load).with(Stage::Deviation);
        solution.position = None;
        solution.velocity = None;
        solution.compliance = None;
        solution.impact = None;
        solution.friction = None;
        solution.band = None;
        solution.stations.clear();
        solution.clearing = None;
        solution.withheld = None;
        solution.stations_withheld = None;
        if self.asked.wanted.has(Stage::Position) {
            self.locate(solution)?;
        }
        Ok(())
    }
}

/// Whether the deviation makes the tooth early.
fn outcome(deviation: &Deviation<TwoFloat>) -> Outcome {
    if deviation.total.rounded() > 0.0 { Outcome::CornerContact } else { Outcome::NoCornerContact }
}

impl Solving<'_> {
    fn deviation(
        &self,
        geometry: &Geometry,
        mesh_force: f64,
    ) -> Result<Deviation<TwoFloat>, Refusal> {
        let given = GivenDeviations::of(self.asked.inputs);
        let by_load = || self.setup.deflected(&given, geometry, mesh_force);
        deviation::deviation(&given, by_load)
    }

    fn run(&self, go_on: &dyn Fn(f64) -> bool) -> Result<Solution, Refusal> {
        let mut solution = self.begun()?;
        if self.asked.wanted.has(Stage::Position) {
            self.locate(&mut solution)?;
        }
        if self.asked.wanted.has(Stage::Mesh) {
            load_sharing::share(&mut solution, &self.asked, go_on)?;
        }
        if self.asked.wanted.has(Stage::Clearing) {
            self.clear(&mut solution, go_on)?;
        }
        Ok(solution)
    }

    /// The required relief, after the outcome is known.
    fn clear(&self, solution: &mut Solution, go_on: &dyn Fn(f64) -> bool) -> Result<(), Refusal> {
        let held = self.asked.kept(Stage::Clearing).and_then(|earlier| earlier.clearing);
        if held.is_none() {
            solution.ran = solution.ran.with(Stage::Clearing);
        }
        solution.clearing = Some(held.map_or_else(
            || clearing(&ClearingInputs::of(self.asked.inputs), solution, go_on),
            Ok,
        )?);
        solution.stages = solution.stages.with(Stage::Clearing);
        Ok(())
    }

    /// Geometry, load and deviation.
    fn begun(&self) -> Result<Solution, Refusal> {
        let inputs = self.asked.inputs;
        let mut ran = Stages::NONE;
        let geometry = match self.asked.kept(Stage::Geometry) {
            Some(earlier) => earlier.geometry,
            None => self.geometry(&mut ran)?,
        };
        check_reliefs(inputs, &geometry)?;
        let mesh_force = if let Some(earlier) = self.asked.kept(Stage::Load) {
            earlier.mesh_force
        } else {
            ran = ran.with(Stage::Load);
            let force = mesh_force(&LoadInputs::of(inputs), &geometry);
            self.asked.note(Stage::Load, |s| s.mesh_force.to_bits() == force.to_bits());
            force
        };
        let masses = if let Some(earlier) = self.asked.kept(Stage::Masses) {
            earlier.kept.masses
        } else {
            ran = ran.with(Stage::Masses);
            let bodies = MassInputs::of(inputs);
            let masses = self
                .precise(&geometry)?
                .map_or_else(|| Masses::of(&bodies, &geometry), |pair| Masses::of(&bodies, pair))?;
            self.asked.note(Stage::Masses, |s| s.kept.masses == masses);
            masses
        };
        let deviation = if let Some(earlier) = self.asked.kept(Stage::Deviation) {
            earlier.kept.deviation
        } else {
            ran = ran.with(Stage::Deviation);
            let deviation = self.deviation(&geometry, mesh_force)?;
            self.asked.note(Stage::Deviation, |s| s.kept.deviation == deviation);
            deviation
        };
        Ok(Solution {
            method: inputs.method,
            choice: None,
            outcome: outcome(&deviation),
            stages: ALWAYS,
            ran,
            geometry,
            mesh_force,
            reduced_mass: masses.reduced(),
            deviation: deviation.rounded(),
            kept: Kept { masses, deviation },
            position: None,
            velocity: None,
            compliance: None,
            impact: None,
            friction: None,
            band: None,
            stations: Vec::new(),
            mesh: None,
            static_load: None,
            dynamic: None,
            resonance: None,
            static_spectrum: None,
            steady: None,
            over_speed: None,
            clearing: None,
            withheld: None,
            stations_withheld: None,
            beside: None,
        })
    }

    fn geometry(&self, ran: &mut Stages) -> Result<Geometry, Refusal> {
        *ran = ran.with(Stage::Geometry);
        // The earlier result can differ beyond its rounded digits.
        self.asked.note(Stage::Geometry, |_| false);
        let inputs = GeometryInputs::of(self.asked.inputs);
        let plain = geometry::geometry::<f64>(&inputs.shape);
        let precise = precise(&inputs, plain.as_ref().ok())?;
        let rounded = precise.map(Geometry::rounded);
        let _ = self.setup.precise.set(precise);
        rounded.map_or(plain, Ok)
    }

    /// Geometry in double-double arithmetic if it is requested or if small differences need it.
    fn precise(&self, plain: &Geometry) -> Result<Option<&Geometry<TwoFloat>>, Refusal> {
        let known = &self.setup.precise;
        if known.get().is_none() {
            let inputs = GeometryInputs::of(self.asked.inputs);
            let _ = known.set(precise(&inputs, Some(plain))?);
        }
        Ok(known.get().and_then(Option::as_ref))
    }

    /// D and all later stages.
    fn locate(&self, solution: &mut Solution) -> Result<(), Refusal> {
        let found = if let Some(earlier) = self.asked.kept(Stage::Position) {
            Ok(earlier.position)
        } else {
            solution.ran = solution.ran.with(Stage::Position);
            let precise = self.precise(&solution.geometry)?;
            let found = position::position(
                &self.setup.position,
                &solution.geometry,
                precise,
                self.setup.series(&solution.geometry),
                &solution.kept.deviation,
            );
            self.asked
                .note(Stage::Position, |s| s.position == found.as_ref().ok().copied().flatten());
            found
        };
        solution.stages = solution.stages.with(Stage::Position);
        match found {
            Ok(Some(position)) => {
                solution.position = Some(position);
                solution.withheld = self.strike(solution, &position).err();
            }
            Ok(None) => solution.outcome = Outcome::NoCornerContact,
            // Methods with load sharing do not need the position.
            Err(refusal) if self.asked.inputs.method.shares_load() => {
                solution.stages = solution.stages.without(Stage::Position);
                solution.withheld = Some(refusal);
            }
            Err(refusal) => return Err(refusal),
        }
        Ok(())
    }

    /// The wanted stages from the velocity on that can be computed.
    fn strike(&self, solution: &mut Solution, position: &Position) -> Result<(), Refusal> {
        let (inputs, tip) = (self.asked.inputs, &position.contact);
        let setup = self.setup;
        let Solution { geometry, kept: Kept { masses, .. }, stages, ran, .. } = solution;
        let mut done = Done { stages, ran };
        solution.velocity = self.stage(
            &mut done,
            Stage::Velocity,
            |s| s.velocity,
            || Ok(position::velocity(&setup.velocity, tip)),
        )?;
        let place = setup.impact.compliance.place(geometry, tip);
        let borne = || setup.teeth(geometry)?.at(&place);
        solution.compliance = self.stage(&mut done, Stage::Compliance, |s| s.compliance, borne)?;
        let (Some(velocity), Some(teeth)) = (solution.velocity, solution.compliance) else {
            return Ok(());
        };
        let struck = || {
            let spring = setup.teeth(geometry)?.spring(&place)?;
            let elastic = (&teeth, &spring);
            impact::impact(&setup.impact, geometry, masses, tip, elastic, &velocity)
        };
        solution.impact = self.stage(&mut done, Stage::Impact, |s| s.impact, struck)?;
        let Some(impact) = &solution.impact else {
            return Ok(());
        };
        let rubbed = || {
            let reduced = masses.reduced();
            Ok(impact::friction(&setup.friction, geometry, tip, &velocity, impact, reduced))
        };
        solution.friction = self.stage(&mut done, Stage::Friction, |s| s.friction, rubbed)?;
        solution.band = self.stage(
            &mut done,
            Stage::Band,
            |s| s.band,
            || Ok(impact::band(inputs, impact.force, force)),
        )?;
        let stood = || {
            let inputs = StationsInputs::of(inputs);
            Ok(stations(&inputs, geometry, masses, position, impact.force))
        };
        let earlier = |s: &Solution| Some((s.stations.clone(), s.stations_withheld));
        if let Some((stations, withheld)) =
            self.stage(&mut done, Stage::Stations, earlier, stood)?
        {
            (solution.stations, solution.stations_withheld) = (stations, withheld);
        }
        Ok(())
    }

    /// The result of a stage: the earlier result if it is valid, otherwise a new one if wanted.
    fn stage<T: PartialEq>(
        &self,
        done: &mut Done<'_>,
        stage: Stage,
        earlier: impl Fn(&Solution) -> Option<T>,
        new: impl FnOnce() -> Result<T, Refusal>,
    ) -> Result<Option<T>, Refusal> {
        if !self.asked.wanted.has(stage) {
            return Ok(None);
        }
        if let Some(held) = self.asked.kept(stage).and_then(&earlier) {
            *done.stages = done.stages.with(stage);
            return Ok(Some(held));
        }
        let found = new()?;
        self.asked.note(stage, |s| earlier(s).as_ref() == Some(&found));
        *done.stages = done.stages.with(stage);
        *done.ran = done.ran.with(stage);
        Ok(Some(found))
    }
}

/// The stages of a solution, and the stages that ran.
struct Done<'a> {
    stages: &'a mut Stages,
    ran: &'a mut Stages,
}

/// The impact force, if the tooth strikes.
fn force(inputs: &Inputs) -> Option<f64> {
    let solution = solve_by_method(inputs, Stages::of(Stage::Impact), None, &|_| true).ok()?;
    Some(solution.impact?.force)
}

/// Values that a closed-form solve computes before load and deviations. All belong to one geometry,
/// which the caller passes.
#[derive(Debug, Clone)]
pub struct Setup {
    pub(super) position: PositionInputs,
    pub(super) velocity: VelocityInputs,
    /// Inputs of the impact, with the elasticity.
    pub(super) impact: ImpactInputs,
    pub(super) friction: FrictionInputs,
    /// Geometry in double-double arithmetic if it is needed.
    pub(super) precise: OnceCell<Option<Geometry<TwoFloat>>>,
    series: OnceCell<GapSeries>,
    teeth: OnceCell<Result<Teeth, Refusal>>,
    loaded: OnceCell<Result<LoadedPairs, Refusal>>,
}

impl Setup {
    pub(super) fn of(inputs: &Inputs) -> Setup {
        Setup {
            position: PositionInputs::of(inputs),
            velocity: VelocityInputs::of(inputs),
            impact: ImpactInputs::of(inputs),
            friction: FrictionInputs::of(inputs),
            precise: OnceCell::new(),
            series: OnceCell::new(),
            teeth: OnceCell::new(),
            loaded: OnceCell::new(),
        }
    }

    pub(super) fn series(&self, geometry: &Geometry) -> &GapSeries {
        self.series.get_or_init(|| GapSeries::of(geometry))
    }

    pub(super) fn teeth(&self, geometry: &Geometry) -> Result<&Teeth, Refusal> {
        let teeth = || Teeth::of(&self.impact.compliance.elasticity, geometry);
        let known = self.teeth.get_or_init(teeth);
        known.as_ref().map_err(|refusal| *refusal)
    }

    /// The deflection from the load.
    pub(super) fn deflected(
        &self,
        given: &GivenDeviations,
        geometry: &Geometry,
        mesh_force: f64,
    ) -> Result<Deflected, Refusal> {
        let teeth = || self.teeth(geometry);
        let loaded = || LoadedPairs::of(given.method, geometry, teeth);
        let pairs = self.loaded.get_or_init(loaded);
        let pairs = pairs.as_ref().map_err(|refusal| *refusal)?;
        pairs.deflected(teeth()?, mesh_force)
    }
}
