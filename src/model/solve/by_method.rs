//! A solve by one method: runs the wanted stages in order, and takes the results of stages with equal
//! inputs from an earlier solve.

use std::sync::{Arc, OnceLock};

use twofloat::TwoFloat;

use crate::model::budget::{MOTION_WORK, Meter};
use crate::model::clearing::clearing;
use crate::model::compliance::{ContactPlace, Teeth};
use crate::model::deviation::{Deflected, GivenDeviations, LoadedPairs, deviation};
use crate::model::dynamic::speeds::{SPEEDS, over_speed};
use crate::model::dynamic::steady::steady;
use crate::model::dynamic::{Settings, dynamic};
use crate::model::geometry::{geometry, mesh_force, precise};
use crate::model::inputs::Inputs;
use crate::model::masses::Masses;
use crate::model::mesh::range::{Meshes, late};
use crate::model::position::{GapSeries, position, velocity};
use crate::model::relief::check_reliefs;
use crate::model::spacing::Spacing;
use crate::model::stage::{Stage, Stages};
use crate::model::static_load::static_load;
use crate::model::static_spectrum::{Resonance, static_spectrum};
use crate::model::stations::stations;
use crate::model::{Geometry, Kept, Outcome, Position, Refusal, Solution, impact};

/// An earlier solve by the same method.
#[derive(Debug, Clone, Copy)]
pub struct Earlier<'a> {
    /// Its inputs.
    pub inputs: &'a Inputs,
    /// Its results.
    pub solution: &'a Solution,
}

/// Solves by the method of the inputs, which is not `auto`. Ignores an earlier solve by another
/// method.
///
/// # Errors
/// Those of [`solve_after`](super::solve_after).
pub(in crate::model) fn solve_by_method(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let earlier = earlier.filter(|earlier| earlier.solution.method == inputs.method);
    let alike = earlier.filter(|earlier| differ_in_load_alone(earlier.inputs, inputs));
    let kept = alike.map(|earlier| earlier.solution.kept.setup.clone().unwrap_or_default());
    let own = Setup::default();
    let setup = kept.as_deref().unwrap_or(&own);
    let mut run = Run {
        inputs,
        wanted: wanted.within(inputs.method.stages()),
        earlier,
        go_on,
        changed: Stages::NONE,
        done: Stages::NONE,
        ran: Stages::NONE,
    };
    let mut solution = run.begin(setup)?;
    run.locate(setup, &mut solution)?;
    run.share(&mut solution)?;
    solution.clearing =
        run.stage(Stage::Clearing, |s| s.clearing, || clearing(inputs, &solution, go_on))?;
    solution.kept.setup = kept;
    Ok(Solution { stages: run.done, ran: run.ran, ..solution })
}

/// The state of a solve.
struct Run<'a> {
    inputs: &'a Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'a>>,
    go_on: &'a dyn Fn(f64) -> bool,
    /// The stages whose results differ from the earlier ones.
    changed: Stages,
    /// The stages with results.
    done: Stages,
    /// The stages that ran.
    ran: Stages,
}

impl<'a> Run<'a> {
    /// The earlier solution if its result of this stage is still valid: the stage has the same
    /// inputs from the case and from other stages.
    fn kept(&self, stage: Stage) -> Option<&'a Solution> {
        let Earlier { inputs, solution } = self.earlier?;
        let is_valid = solution.stages.has(stage)
            && stage.depends_on().within(self.changed) == Stages::NONE
            && stage.has_equal_inputs(self.inputs, inputs);
        is_valid.then_some(solution)
    }

    /// The result of a stage: the earlier result if it is valid, otherwise a new one.
    fn result<T: PartialEq>(
        &mut self,
        stage: Stage,
        of: impl Fn(&Solution) -> Option<T>,
        new: impl FnOnce() -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        if let Some(held) = self.kept(stage).and_then(&of) {
            self.done = self.done.with(stage);
            return Ok(held);
        }
        let found = new()?;
        let earlier = self.earlier.filter(|earlier| earlier.solution.stages.has(stage));
        if earlier.and_then(|earlier| of(earlier.solution)).as_ref() != Some(&found) {
            self.changed = self.changed.with(stage);
        }
        (self.done, self.ran) = (self.done.with(stage), self.ran.with(stage));
        Ok(found)
    }

    /// The result of a stage if it is wanted.
    fn stage<T: PartialEq>(
        &mut self,
        stage: Stage,
        of: impl Fn(&Solution) -> Option<T>,
        new: impl FnOnce() -> Result<T, Refusal>,
    ) -> Result<Option<T>, Refusal> {
        self.wanted.has(stage).then(|| self.result(stage, of, new)).transpose()
    }

    /// Geometry, load, masses and deviation.
    fn begin(&mut self, setup: &Setup) -> Result<Solution, Refusal> {
        let inputs = self.inputs;
        let geometry =
            self.result(Stage::Geometry, |s| Some(s.geometry), || setup.geometry(inputs))?;
        if self.ran.has(Stage::Geometry) {
            // The earlier result can differ beyond its rounded digits.
            self.changed = self.changed.with(Stage::Geometry);
        }
        check_reliefs(inputs, &geometry)?;
        let force = || Ok(mesh_force(inputs.torque(), &geometry));
        let mesh_force = self.result(Stage::Load, |s| Some(s.mesh_force), force)?;
        let masses = self.result(
            Stage::Masses,
            |s| Some(s.kept.masses),
            || match setup.precise(inputs, &geometry)? {
                Some(precise) => Masses::of(&inputs.bodies(), precise),
                None => Masses::of(&inputs.bodies(), &geometry),
            },
        )?;
        let deviation = self.result(
            Stage::Deviation,
            |s| Some(s.kept.deviation),
            || {
                let given = GivenDeviations::of(inputs);
                deviation(&given, || setup.deflected(inputs, &geometry, mesh_force))
            },
        )?;
        Ok(Solution::new(
            inputs.method,
            geometry,
            mesh_force,
            Kept { masses, deviation, setup: None },
        ))
    }

    /// D and all later stages of the impact.
    fn locate(&mut self, setup: &Setup, solution: &mut Solution) -> Result<(), Refusal> {
        let (inputs, geometry) = (self.inputs, &solution.geometry);
        let deviation = &solution.kept.deviation;
        let located = || {
            let precise = setup.precise(inputs, geometry)?;
            position(inputs, geometry, precise, setup.series(geometry), deviation)
        };
        match self.stage(Stage::Position, |s| Some(s.position), located) {
            Ok(None) => {}
            Ok(Some(Some(position))) => {
                solution.position = Some(position);
                solution.withheld = self.strike(setup, solution, &position).err();
            }
            Ok(Some(None)) => solution.outcome = Outcome::NoCornerContact,
            // Methods with load sharing do not need the position.
            Err(refusal) if inputs.method.shares_load() => solution.withheld = Some(refusal),
            Err(refusal) => return Err(refusal),
        }
        Ok(())
    }

    /// The wanted stages from the velocity on that can be computed.
    fn strike(
        &mut self,
        setup: &Setup,
        solution: &mut Solution,
        position: &Position,
    ) -> Result<(), Refusal> {
        let (inputs, tip) = (self.inputs, &position.contact);
        let Solution { geometry, kept: Kept { masses, .. }, .. } = solution;
        let new = || Ok(velocity(inputs.driven_speed(), tip));
        solution.velocity = self.stage(Stage::Velocity, |s| s.velocity, new)?;
        let teeth = || setup.teeth(inputs, geometry);
        let place = ContactPlace::at_tip(inputs.driven.tip_radius, geometry, tip);
        let new = || teeth()?.at(&place);
        solution.compliance = self.stage(Stage::Compliance, |s| s.compliance, new)?;
        let (Some(velocity), Some(compliance)) = (solution.velocity, solution.compliance) else {
            return Ok(());
        };
        let new = || impact::impact(inputs, teeth()?, masses, tip, &compliance, &velocity);
        solution.impact = self.stage(Stage::Impact, |s| s.impact, new)?;
        let Some(impact) = &solution.impact else {
            return Ok(());
        };
        let new = || {
            let reduced = masses.reduced();
            Ok(impact::friction(inputs, geometry, tip, &velocity, impact, reduced))
        };
        solution.friction = self.stage(Stage::Friction, |s| s.friction, new)?;
        let new = || Ok(impact::band(inputs, impact.force, force));
        solution.band = self.stage(Stage::Band, |s| s.band, new)?;
        let new = || Ok(stations(inputs, geometry, masses, position, impact.force));
        let of = |s: &Solution| Some((s.stations.clone(), s.stations_withheld));
        if let Some((stations, withheld)) = self.stage(Stage::Stations, of, new)? {
            (solution.stations, solution.stations_withheld) = (stations, withheld);
        }
        Ok(())
    }

    /// The mesh in the needed range, and the stages that are computed on it. The last of `static`
    /// and `dynamic` decides whether the tooth strikes.
    fn share(&mut self, solution: &mut Solution) -> Result<(), Refusal> {
        if !self.wanted.has(Stage::Mesh) {
            return Ok(());
        }
        let (inputs, mass, go_on) = (self.inputs, solution.reduced_mass, self.go_on);
        let of_mesh = inputs.mesh();
        let kept = self.kept(Stage::Mesh).and_then(|earlier| earlier.mesh.clone());
        if kept.is_none() {
            self.changed = self.changed.with(Stage::Mesh);
        }
        let alike = self.kept(Stage::Geometry).and_then(|earlier| earlier.mesh.as_ref());
        let mut meshes = Meshes::new(&of_mesh, solution, alike, kept.as_ref());
        let static_load = self.stage(
            Stage::Static,
            |s| s.static_load.clone(),
            || meshes.find(|mesh| static_load(&mesh.turning_at(inputs.speed), Spacing::of(inputs))),
        )?;
        let dynamic = self.stage(
            Stage::Dynamic,
            |s| s.dynamic.clone(),
            || {
                let settings = Settings::of(inputs, mass);
                meshes.find(|mesh| dynamic(&mesh.turning_at(inputs.speed), &settings, go_on))
            },
        )?;
        let resonance = self.stage(
            Stage::Resonance,
            |s| s.resonance,
            || meshes.find(|mesh| Ok(Resonance::of(inputs.speed, mesh, mass))),
        )?;
        let static_spectrum = self.stage(
            Stage::StaticSpectrum,
            |s| s.static_spectrum,
            || meshes.find(|mesh| late(mesh, static_spectrum(mesh))),
        )?;
        let steady = self.stage(
            Stage::SteadyMotion,
            |s| s.steady.clone(),
            || {
                let settings = Settings::steady(inputs, mass);
                meshes.find(|mesh| {
                    let (mesh, meter) = (mesh.turning_at(inputs.speed), Meter::new(MOTION_WORK));
                    late(&mesh, steady(&mesh, &settings, None, &meter, go_on))
                })
            },
        )?;
        let over_speed = self.stage(
            Stage::SpeedRun,
            |s| s.over_speed.clone(),
            || {
                let total = (2 * SPEEDS) as f64;
                meshes.find(|mesh| {
                    let found = over_speed(inputs, solution, &mut |curve| {
                        go_on(curve.up.iter().chain(&curve.down).flatten().count() as f64 / total)
                    });
                    late(mesh, found.map(Arc::new))
                })
            },
        )?;
        self.done = self.done.with(Stage::Mesh);
        let (mesh, is_new) = meshes.last(kept)?;
        if is_new {
            self.ran = self.ran.with(Stage::Mesh);
        }
        let found = [
            static_load.as_ref().map(|load| (load.first_contact_angle, load.resolution)),
            dynamic.as_ref().map(|motion| (motion.first_contact_angle, motion.resolution)),
        ];
        for (angle, resolution) in found.into_iter().flatten() {
            solution.outcome = Outcome::of_contact(angle.is_some());
            solution.stations_withheld = solution.stations_withheld.or(resolution.refusal());
        }
        solution.mesh = Some(mesh.turning_at(inputs.speed));
        solution.static_load = static_load;
        solution.dynamic = dynamic;
        solution.resonance = resonance;
        solution.static_spectrum = static_spectrum;
        solution.steady = steady;
        solution.over_speed = over_speed;
        Ok(())
    }
}

/// The impact force, if the tooth strikes.
fn force(inputs: &Inputs) -> Option<f64> {
    let solution = solve_by_method(inputs, Stages::of(Stage::Impact), None, &|_| true).ok()?;
    Some(solution.impact?.force)
}

/// Values that a solve computes before load and deviations, for all solves that differ only in
/// these. The caller passes the geometry of the pair.
#[derive(Debug, Default)]
pub(in crate::model) struct Setup {
    /// Geometry in double-double arithmetic if it is needed.
    precise: OnceLock<Option<Geometry<TwoFloat>>>,
    series: OnceLock<GapSeries>,
    teeth: OnceLock<Result<Teeth, Refusal>>,
    loaded: OnceLock<Result<LoadedPairs, Refusal>>,
}

impl Setup {
    fn geometry(&self, inputs: &Inputs) -> Result<Geometry, Refusal> {
        let plain = geometry::<f64>(&inputs.shape());
        let precise = precise(inputs, plain.as_ref().ok())?;
        let rounded = precise.map(Geometry::rounded);
        let _ = self.precise.set(precise);
        rounded.map_or(plain, Ok)
    }

    /// Geometry in double-double arithmetic if it is requested or if small differences need it.
    fn precise(
        &self,
        inputs: &Inputs,
        plain: &Geometry,
    ) -> Result<Option<&Geometry<TwoFloat>>, Refusal> {
        if self.precise.get().is_none() {
            let _ = self.precise.set(precise(inputs, Some(plain))?);
        }
        Ok(self.precise.get().and_then(Option::as_ref))
    }

    fn series(&self, geometry: &Geometry) -> &GapSeries {
        self.series.get_or_init(|| GapSeries::of(geometry))
    }

    fn teeth(&self, inputs: &Inputs, geometry: &Geometry) -> Result<&Teeth, Refusal> {
        let known = self.teeth.get_or_init(|| Teeth::of(&inputs.elasticity(), geometry));
        known.as_ref().map_err(|refusal| *refusal)
    }

    /// The deflection from the load.
    fn deflected(
        &self,
        inputs: &Inputs,
        geometry: &Geometry,
        mesh_force: f64,
    ) -> Result<Deflected, Refusal> {
        let teeth = || self.teeth(inputs, geometry);
        let loaded = || LoadedPairs::of(inputs.method, geometry, teeth);
        let pairs = self.loaded.get_or_init(loaded).as_ref().map_err(|refusal| *refusal)?;
        pairs.deflected(teeth()?, mesh_force)
    }
}

/// Whether inputs differ only in load and deviations, which no stage but those two reads before the
/// first contact.
#[must_use]
pub fn differ_in_load_alone(one: &Inputs, other: &Inputs) -> bool {
    let mut alike = one.clone();
    alike.drive = other.drive;
    alike.deflection = other.deflection;
    alike.base_pitch_deviation = other.base_pitch_deviation;
    alike.driver.base_pitch = other.driver.base_pitch;
    alike.driven.base_pitch = other.driven.base_pitch;
    alike.combination = other.combination;
    alike.backlash = other.backlash;
    alike.driven.tip_relief = other.driven.tip_relief;
    alike.driver.root_relief = other.driver.root_relief;
    alike == *other
}
