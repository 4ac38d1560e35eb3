//! A solve: runs the wanted stages and reuses valid earlier results.

use super::auto::{self, Choice, Reason};
use super::budget::{MOTION_WORK, Meter};
use super::clearing::clearing;
use super::compliance::{ContactPlace, Teeth};
use super::deviation::{deflected, deflected_over_face, deviation, earliness};
use super::dynamic::steady::steady;
use super::dynamic::{Settings, dynamic};
use super::face::{FaceInputs, check_face};
use super::figures::{Figures, Hertz};
use super::geometry::{geometry, mesh_force, precise};
use super::inputs::{Inputs, Method};
use super::masses::Masses;
use super::mesh::build::{Meshes, late};
use super::position::{position, velocity};
use super::relief::check_reliefs;
use super::slices::Face;
use super::slices::motion::{self, Springs};
use super::speeds::over_speed;
use super::stage::{Stage, Stages};
use super::static_load::{Resonance, static_load, static_spectrum};
use super::stations::{Spacing, stations};
use super::{Geometry, Kept, Mesh, Outcome, Position, Refusal, Solution, SpeedCurve, impact};
use std::cell::OnceCell;
use std::sync::Arc;
use twofloat::TwoFloat;

/// Solves the pair. Runs only the wanted stages and the stages that they need.
///
/// Geometry, load and deviation always run, because they decide the outcome. If small differences
/// decide, geometry and position use double-double arithmetic, requested or not.
///
/// # Errors
/// A [`Refusal`] if the pair cannot mesh, or D does not exist. If only the force cannot be
/// computed, the solution has the other results and the reason in [`Solution::withheld`].
pub fn solve(inputs: &Inputs, wanted: Stages) -> Result<Solution, Refusal> {
    solve_while(inputs, wanted, &|_| true)
}

/// Like [`solve`]. Calls `go_on` from time to time with the computed part, from 0 to 1.
///
/// # Errors
/// Those of [`solve`], and [`Refusal::Stopped`] if `go_on` returns false.
pub fn solve_while(
    inputs: &Inputs,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    solve_after(inputs, wanted, None, go_on)
}

/// Like [`solve_while`] after an earlier solve. Reuses valid earlier results; [`Solution::ran`]
/// lists the stages that ran.
///
/// # Errors
/// Those of [`solve_while`].
pub fn solve_after(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    match inputs.method {
        Method::Auto => solve_by_choice(inputs, wanted, earlier, go_on),
        _ => solve_by_method(inputs, wanted, earlier, go_on),
    }
}

/// The steady motion over the speed, rising and falling, by the method `dynamic`. `show` receives the
/// growing curve, `go_on` the number of computed motions and the total.
///
/// # Errors
/// Those of [`solve_while`].
pub fn speeds(
    inputs: &Inputs,
    show: &mut dyn FnMut(&SpeedCurve),
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<SpeedCurve, Refusal> {
    let inputs = Inputs { method: Method::Dynamic, ..inputs.clone() };
    let solution = solve(&inputs, Stages::of(Stage::Deviation))?;
    over_speed(&inputs, &solution, show, go_on)
}

/// An earlier solve, by any method but `auto`, or by `auto` of these inputs.
#[derive(Debug, Clone, Copy)]
pub struct Earlier<'a> {
    /// Its inputs.
    pub inputs: &'a Inputs,
    /// Its results.
    pub solution: &'a Solution,
    /// What the solves of its gears share, if the inputs differ only in load and deviations.
    pub gears: Option<&'a Lazy>,
}

/// Solves by the method of the inputs, which is not `auto`.
///
/// # Errors
/// Those of [`solve_after`].
pub(crate) fn solve_by_method(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let face = inputs.face();
    if face.is_some() && inputs.method == Method::Paper {
        return Err(Refusal::NotOverFace { method: inputs.method });
    }
    let mut run = Run {
        inputs,
        face,
        wanted: wanted.within(inputs.method.stages()),
        earlier,
        go_on,
        changed: Stages::NONE,
        done: Stages::NONE,
        ran: Stages::NONE,
    };
    let own = Lazy::default();
    let lazy = run.earlier.and_then(|earlier| earlier.gears).unwrap_or(&own);
    let (geometry, mesh_force, kept) = run.begin(lazy)?;
    let mut solution = Solution::new(inputs, geometry, mesh_force, kept);
    let figures = || {
        let Solution { geometry, mesh_force, reduced_mass, .. } = &solution;
        Ok(Figures::of(inputs, geometry, *mesh_force, *reduced_mass))
    };
    solution.figures = run.stage(Stage::Figures, |s| s.figures, figures)?;
    run.locate(lazy, &mut solution)?;
    run.share(&mut solution)?;
    solution.clearing =
        run.stage(Stage::Clearing, |s| s.clearing, || clearing(inputs, &solution, go_on))?;
    (solution.stages, solution.ran) = (run.done, run.ran);
    Ok(solution)
}

/// The state of a solve.
struct Run<'a> {
    inputs: &'a Inputs,
    /// The face width, if its slices differ.
    face: Option<FaceInputs>,
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
        /// The stages that read neither load nor deviations.
        const OF_GEARS: Stages = Stages::of(Stage::Geometry).with(Stage::Masses);
        let Earlier { inputs, solution, gears } = self.earlier?;
        let is_valid = solution.stages.within(self.inputs.method.stages()).has(stage)
            && stage.depends_on().within(self.changed) == Stages::NONE
            && (gears.is_some() && OF_GEARS.has(stage)
                || stage.has_equal_inputs(self.inputs, inputs));
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

    /// The result of a stage if it is wanted, or if it is late and the earlier result is valid.
    fn stage<T: PartialEq>(
        &mut self,
        stage: Stage,
        of: impl Fn(&Solution) -> Option<T>,
        new: impl FnOnce() -> Result<T, Refusal>,
    ) -> Result<Option<T>, Refusal> {
        let is_had =
            self.wanted.has(stage) || Stages::LATE.has(stage) && self.kept(stage).is_some();
        is_had.then(|| self.result(stage, of, new)).transpose()
    }

    /// Geometry, load, masses and deviation.
    fn begin(&mut self, lazy: &Lazy) -> Result<(Geometry, f64, Kept), Refusal> {
        let inputs = self.inputs;
        let geometry =
            self.result(Stage::Geometry, |s| Some(s.geometry), || lazy.geometry(inputs))?;
        if self.ran.has(Stage::Geometry) {
            // The earlier result can differ beyond its rounded digits.
            self.changed = self.changed.with(Stage::Geometry);
        }
        check_reliefs(inputs, &geometry)?;
        if let Some(face) = &self.face {
            check_face(face, &geometry)?;
        }
        let force = || Ok(mesh_force(inputs.torque(), &geometry));
        let mesh_force = self.result(Stage::Load, |s| Some(s.mesh_force), force)?;
        let masses = || match lazy.precise(inputs, &geometry)? {
            Some(precise) => Masses::of(inputs, precise),
            None => Masses::of(inputs, &geometry),
        };
        let masses = self.result(Stage::Masses, |s| Some(s.kept.masses), masses)?;
        let teeth = || lazy.teeth(inputs, &geometry);
        let face = self.face;
        let by_load = || match &face {
            Some(face) => deflected_over_face(face, &geometry, teeth()?, mesh_force),
            None => deflected(inputs.method, &geometry, teeth, mesh_force),
        };
        let deviation = || deviation(inputs, by_load).map(|found| (found.rounded(), found));
        // The rounded one first: double-double numbers are slow to compare.
        let of = |s: &Solution| Some((s.deviation, s.kept.deviation));
        let (_, deviation) = self.result(Stage::Deviation, of, deviation)?;
        Ok((geometry, mesh_force, Kept { masses, deviation, hertz: Hertz::of(inputs) }))
    }

    /// D and all later stages of the impact.
    fn locate(&mut self, lazy: &Lazy, solution: &mut Solution) -> Result<(), Refusal> {
        let (inputs, geometry) = (self.inputs, &solution.geometry);
        if self.face.is_some() && inputs.method.shares_load() {
            return Ok(());
        }
        let located = || {
            let precise = lazy.precise(inputs, geometry)?;
            position(inputs, geometry, precise, &solution.kept.deviation)
        };
        match self.stage(Stage::Position, |s| Some(s.position), located) {
            Ok(None) => {}
            Ok(Some(Some(position))) => {
                solution.position = Some(position);
                solution.withheld = self.strike(lazy, solution, &position).err();
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
        lazy: &Lazy,
        solution: &mut Solution,
        position: &Position,
    ) -> Result<(), Refusal> {
        let (inputs, tip) = (self.inputs, &position.contact);
        let Solution { geometry, kept: Kept { masses, .. }, .. } = solution;
        let new = || Ok(velocity(inputs.driven_speed(), tip));
        solution.velocity = self.stage(Stage::Velocity, |s| s.velocity, new)?;
        if self.face.is_some() {
            return Err(Refusal::NotOverFace { method: inputs.method });
        }
        let place = ContactPlace::at_tip(inputs.driven.tip_radius, geometry, tip);
        let new = || lazy.teeth(inputs, geometry)?.at(&place);
        solution.compliance = self.stage(Stage::Compliance, |s| s.compliance, new)?;
        let (Some(velocity), Some(compliance)) = (solution.velocity, solution.compliance) else {
            return Ok(());
        };
        let new = || {
            let teeth = lazy.teeth(inputs, geometry)?;
            impact::impact(inputs, teeth, masses, tip, &compliance, &velocity)
        };
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

    /// The result of a stage on the first mesh that is wide enough for it, if it is wanted.
    fn on_mesh<T: PartialEq>(
        &mut self,
        stage: Stage,
        of: impl Fn(&Solution) -> Option<T>,
        meshes: &mut Meshes<'_>,
        find: impl Fn(&Arc<Mesh>) -> Result<T, Refusal>,
    ) -> Result<Option<T>, Refusal> {
        let speed = self.inputs.speed;
        self.stage(stage, of, || meshes.find(|mesh| find(&mesh.turning_at(speed))))
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
        let (face, geometry) = (self.face, solution.geometry);
        let over_face =
            |mesh: &Arc<Mesh>| face.map(|face| Face::new(&face, &geometry, mesh)).transpose();
        let find = |mesh: &Arc<Mesh>| {
            let spacing = Spacing::of(inputs);
            match over_face(mesh)? {
                Some(face) => face.static_load(spacing),
                None => Ok((static_load(mesh, spacing)?, None)),
            }
        };
        let of = |s: &Solution| Some((s.static_load.clone()?, s.face_load.clone()));
        if let Some((load, face)) = self.on_mesh(Stage::Static, of, &mut meshes, find)? {
            (solution.static_load, solution.face_load) = (Some(load), face);
        }
        let find = |mesh: &Arc<Mesh>| {
            let settings = Settings::of(inputs, mass);
            match over_face(mesh)? {
                Some(face) => motion::dynamic(&face, &settings, go_on),
                None => Ok((dynamic(mesh, &settings, go_on)?, None)),
            }
        };
        let of = |s: &Solution| Some((s.dynamic.clone()?, s.face_motion.clone()));
        if let Some((load, face)) = self.on_mesh(Stage::Dynamic, of, &mut meshes, find)? {
            (solution.dynamic, solution.face_motion) = (Some(load), face);
        }
        let find = |mesh: &Arc<Mesh>| Ok(Resonance::of(inputs.speed, mesh, mass));
        solution.resonance = self.on_mesh(Stage::Resonance, |s| s.resonance, &mut meshes, find)?;
        let find = |mesh: &Arc<Mesh>| match over_face(mesh)? {
            Some(face) => late(mesh, face.cycle()).map(|found| match found {
                Ok((cycle, spectrum)) => (Ok(spectrum), Some(cycle)),
                Err(refusal) => (Err(refusal), None),
            }),
            None => Ok((late(mesh, static_spectrum(mesh))?, None)),
        };
        let of = |s: &Solution| Some((s.static_spectrum?, s.face_cycle.clone()));
        if let Some((found, cycle)) = self.on_mesh(Stage::StaticSpectrum, of, &mut meshes, find)? {
            (solution.static_spectrum, solution.face_cycle) = (Some(found), cycle);
        }
        let find = |mesh: &Arc<Mesh>| {
            let settings = Settings::steady(inputs, mass);
            let steady = match over_face(mesh)? {
                Some(face) => {
                    let springs = Springs::new(&face, &settings, mesh.speed);
                    motion::steady(&springs, &settings, mesh.speed, None, go_on)
                }
                None => steady(mesh, &settings, None, &Meter::new(MOTION_WORK), go_on),
            };
            late(mesh, steady)
        };
        let of = |s: &Solution| s.steady.clone();
        solution.steady = self.on_mesh(Stage::SteadyMotion, of, &mut meshes, find)?;
        let find = |mesh: &Arc<Mesh>| {
            let go_on = |done: usize, of: usize| go_on(done as f64 / of as f64);
            late(mesh, over_speed(inputs, solution, &mut |_| (), &go_on).map(Arc::new))
        };
        let of = |s: &Solution| s.over_speed.clone();
        solution.over_speed = self.on_mesh(Stage::SpeedRun, of, &mut meshes, find)?;
        self.done = self.done.with(Stage::Mesh);
        let (mesh, is_new) = meshes.last(kept)?;
        if is_new {
            self.ran = self.ran.with(Stage::Mesh);
        }
        solution.mesh = Some(mesh.turning_at(inputs.speed));
        let load = solution.static_load.as_ref();
        let motion = solution.dynamic.as_ref();
        let found = [
            load.map(|load| (load.first_contact_angle, load.rough)),
            motion.map(|motion| (motion.first_contact_angle, motion.rough)),
        ];
        for (angle, rough) in found.into_iter().flatten() {
            solution.outcome = Outcome::of_contact(angle.is_some());
            solution.stations_withheld = solution.stations_withheld.or(rough);
        }
        Ok(())
    }
}

/// The impact force, if the tooth strikes.
fn force(inputs: &Inputs) -> Option<f64> {
    let solution = solve_by_method(inputs, Stages::of(Stage::Impact), None, &|_| true).ok()?;
    Some(solution.impact?.force)
}

/// Values that several stages need, each computed once for a pair of gears. The caller passes the
/// geometry of the pair.
#[derive(Debug, Clone, Default)]
pub struct Lazy {
    /// Geometry in double-double arithmetic if it is needed.
    precise: OnceCell<Option<Geometry<TwoFloat>>>,
    teeth: OnceCell<Result<Teeth, Refusal>>,
}

impl Lazy {
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

    fn teeth(&self, inputs: &Inputs, geometry: &Geometry) -> Result<&Teeth, Refusal> {
        let known = self.teeth.get_or_init(|| Teeth::of(&inputs.elasticity(), geometry));
        known.as_ref().map_err(|refusal| *refusal)
    }
}

/// Solves with the method that the closed form suggests, or decides by a trial motion. Reuses the
/// earlier choice for equal inputs. The required relief is that of the chosen method.
fn solve_by_choice(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let auto = Auto { inputs, go_on };
    let wanted = wanted.and(Method::Auto.deciding_stages());
    let before =
        earlier.filter(|earlier| earlier.inputs == inputs && earlier.solution.choice.is_some());
    let chosen = match before {
        Some(earlier) => Solution { ran: Stages::NONE, ..earlier.solution.clone() },
        None => auto.with_beside(auto.chosen(wanted.except(Stages::LATE))?)?,
    };
    if before.is_none() && wanted.within(Stages::LATE) == Stages::NONE {
        return Ok(chosen);
    }
    let whole = auto.solve(chosen.method, wanted, Some(&chosen))?;
    Ok(Solution { choice: chosen.choice, beside: chosen.beside, ..whole })
}

/// A case that leaves the method open.
struct Auto<'a> {
    inputs: &'a Inputs,
    go_on: &'a dyn Fn(f64) -> bool,
}

impl Auto<'_> {
    /// Solves by one method after a known solution. For `static` its results replace the wanted
    /// results of `dynamic`.
    fn solve(
        &self,
        method: Method,
        wanted: Stages,
        known: Option<&Solution>,
    ) -> Result<Solution, Refusal> {
        let inputs = auto::taken(self.inputs, method);
        let wanted = if method == Method::Static && wanted.has(Stage::Dynamic) {
            wanted.and(Stages::of(Stage::Static))
        } else {
            wanted
        };
        let earlier = known.map(|solution| (auto::taken(self.inputs, solution.method), solution));
        let earlier =
            earlier.as_ref().map(|(inputs, solution)| Earlier { inputs, solution, gears: None });
        let found = solve_by_method(&inputs, wanted, earlier, self.go_on)?;
        let ran = known.map_or(Stages::NONE, |known| known.ran);
        Ok(Solution { ran: found.ran.and(ran), ..found })
    }

    /// Adds the results that limits or selected quantities need from a slower method.
    fn with_beside(&self, solution: Solution) -> Result<Solution, Refusal> {
        let Some(method) = auto::beside(self.inputs, solution.method) else {
            return Ok(Solution { beside: None, ..solution });
        };
        let missing = self.inputs.needs.except(solution.method.stages());
        // A quantity compares the motion with the load at rest.
        let wanted = missing.iter().map(Stages::of).fold(Stages::of(Stage::Static), Stages::and);
        // A trial motion, or the motion of an earlier solve.
        let known = solution.beside.as_ref().and_then(|known| known.as_deref().ok());
        let beside = Refusal::unless_stopped(self.solve(method, wanted, known))?.map(Box::new);
        let ran = beside.as_ref().map_or(Stages::NONE, |beside| beside.ran);
        Ok(Solution { ran: solution.ran.and(ran), beside: Some(beside), ..solution })
    }

    /// Solves by the chosen method. Uses static balance if the speed is too low for a motion.
    fn chosen(&self, wanted: Stages) -> Result<Solution, Refusal> {
        let exact = auto::taken(self.inputs, Method::Exact);
        let read = wanted.within(Stages::CLOSED_FORM).and(auto::READS);
        let closed_form = match self.inputs.face() {
            Some(_) => Err(Refusal::NotOverFace { method: Method::Exact }),
            None => solve_by_method(&exact, read, None, &|_| true),
        };
        let choice = auto::choose(self.inputs, &closed_form);
        let still = || self.solve(Method::Static, wanted, None);
        let (solution, choice) = match (choice.method, &closed_form) {
            (Method::Exact, Ok(known)) => (self.solve(Method::Exact, wanted, Some(known))?, choice),
            (Method::Static, _) => (still()?, choice),
            _ => match self.solve(Method::Dynamic, wanted, None) {
                Err(Refusal::TooSlow { .. } | Refusal::BackFlanksOverFace) => (still()?, choice),
                // The slower the pair turns, the longer its motion.
                Err(Refusal::MotionTooLong { .. } | Refusal::MotionTooLarge { .. })
                    if choice.reason == Reason::NoContact =>
                {
                    (still()?, choice)
                }
                Ok(moved) if choice.is_open() => self.decided(choice, moved, wanted)?,
                found => (found?, choice),
            },
        };
        Ok(Solution { choice: Some(Choice { method: solution.method, ..choice }), ..solution })
    }

    /// The motion, or the static balance on the same mesh if the effect of inertia is small.
    fn decided(
        &self,
        choice: Choice,
        moved: Solution,
        wanted: Stages,
    ) -> Result<(Solution, Choice), Refusal> {
        let at_rest = || self.solve(Method::Static, wanted, Some(&moved));
        let still = moved.face_motion.as_ref().map(|_| at_rest()).transpose()?;
        let adds = auto::added_by_inertia(&moved, still.as_ref());
        let choice = adds.map_or(choice, |adds| choice.tried(self.inputs, adds));
        if choice.method == Method::Dynamic {
            return Ok((moved, choice));
        }
        let found = still.map_or_else(at_rest, Ok)?;
        Ok((Solution { beside: Some(Ok(Box::new(moved))), ..found }, choice))
    }
}

impl Stage {
    /// Whether the inputs of the stage are equal in two cases.
    pub fn has_equal_inputs(self, one: &Inputs, other: &Inputs) -> bool {
        let cases = [one, other];
        let stages =
            |stages: &[Stage]| stages.iter().all(|stage| stage.has_equal_inputs(one, other));
        match self {
            Stage::Geometry => {
                let helix =
                    |i: &Inputs| (i.helix_angle > 0.0).then(|| (i.helix_angle, i.common_width()));
                equal(cases, |i| (i.shape(), i.bores(), i.accurate, helix(i)))
            }
            Stage::Load => {
                equal(cases, |i| (i.torque(), (i.helix_angle > 0.0).then_some(i.driver_hand)))
            }
            Stage::Masses => equal(cases, |i| (i.body(&i.driver), i.body(&i.driven))),
            Stage::Figures => equal(cases, figured),
            // The load causes the deflection if the case does not give it.
            Stage::Deviation => {
                let face =
                    |i: &Inputs| i.face().map(|face| (face.width, face.lead.abs(), earliness(i)));
                equal(cases, |i| (given_deviations(i), face(i)))
                    && (one.given_deflection().is_some() || equal(cases, Inputs::elasticity))
            }
            Stage::Position => equal(cases, |i| (i.method, i.shape(), i.driven.tip_radius)),
            Stage::Velocity => equal(cases, Inputs::driven_speed),
            Stage::Compliance => equal(cases, |i| (i.driven.tip_radius, i.elasticity())),
            Stage::Impact => equal(cases, |i| i.method) && stages(&[Stage::Compliance]),
            Stage::Friction => equal(cases, |i| (i.method, i.speed)),
            Stage::Band => {
                stages(&[Stage::Deviation, Stage::Position, Stage::Velocity, Stage::Impact])
            }
            Stage::Stations => {
                stages(&[Stage::Velocity, Stage::Impact]) && equal(cases, Spacing::of)
            }
            Stage::Mesh => equal(cases, |i| i.mesh().at_speed(1.0)),
            Stage::Resonance => equal(cases, |i| i.speed),
            Stage::Static => equal(cases, |i| (i.face(), i.speed, Spacing::of(i))),
            Stage::Dynamic => equal(cases, |i| (i.face(), i.speed, Settings::of(i, 0.0))),
            Stage::StaticSpectrum => equal(cases, Inputs::face),
            Stage::SteadyMotion => equal(cases, |i| (i.face(), i.speed, Settings::steady(i, 0.0))),
            // The torque stays the same at every speed.
            Stage::SpeedRun => stages(&[Stage::SteadyMotion]) && equal(cases, Inputs::torque),
            Stage::Clearing => {
                equal(cases, |i| (i.method, i.driven.tip_relief))
                    && match one.method {
                        Method::Exact | Method::Auto => true,
                        Method::Paper => equal(cases, Inputs::shape),
                        Method::Static => equal(cases, |i| (i.mesh(), i.face())),
                        Method::Dynamic => equal(cases, |i| {
                            (i.mesh(), i.face(), i.speed, Settings::approach(i, 0.0))
                        }),
                    }
            }
        }
    }
}

/// Inputs of the figures besides load and masses.
fn figured(inputs: &Inputs) -> impl PartialEq + use<> {
    let materials = [&inputs.driver, &inputs.driven].map(|gear| (gear.young, gear.poisson));
    let classes = [&inputs.driver, &inputs.driven].map(|gear| inputs.class_of(gear));
    let relief = [inputs.driven.tip_relief, inputs.driver.root_relief];
    let width = inputs.common_width();
    let pair = (inputs.shape(), inputs.helix_angle, inputs.module);
    (pair, inputs.speed, materials, classes, inputs.base_pitches(), relief, width)
}

/// Deviations, reliefs and deflection that the case gives. Only `paper` subtracts the backlash.
fn given_deviations(inputs: &Inputs) -> impl PartialEq + use<> {
    let backlash = if inputs.method == Method::Paper { inputs.backlash } else { 0.0 };
    let reliefs = [inputs.driven.tip_relief, inputs.driver.root_relief];
    let pitches = (inputs.base_pitches(), inputs.effective_combination());
    (inputs.method, pitches, backlash, reliefs, inputs.given_deflection())
}

/// Whether the inputs of a stage are equal in two cases.
fn equal<T: PartialEq>([one, other]: [&Inputs; 2], of: impl Fn(&Inputs) -> T) -> bool {
    of(one) == of(other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::{Combination, Drive};
    use crate::model::sample::standard_pair;

    #[test]
    fn only_their_own_stages_read_load_and_deviations_and_reuse_has_the_bits_of_a_plain_solve() {
        let edits: [fn(&mut Inputs); 9] = [
            |inputs| inputs.drive = Drive::Torque(123.0),
            |inputs| inputs.deflection = Some(17e-6),
            |inputs| inputs.base_pitch_deviation = 9e-6,
            |inputs| inputs.driver.base_pitch = Some(7e-6),
            |inputs| inputs.driven.base_pitch = Some(8e-6),
            |inputs| inputs.combination = Combination::Sum,
            |inputs| inputs.backlash = 3e-6,
            |inputs| inputs.driven.tip_relief = 4e-6,
            |inputs| inputs.driver.root_relief = 5e-6,
        ];
        let pair = Inputs { base_pitch_deviation: 16e-6, ..standard_pair(20, 31, 5e-3) };
        for method in Method::CLOSED_FORM {
            let mut inputs = Inputs { method, ..pair.clone() };
            let mut before = (inputs.clone(), solve(&inputs, Stages::CLOSED_FORM).unwrap());
            let gears = Lazy::default();
            for edit in edits {
                edit(&mut inputs);
                for stage in Stages::CLOSED_FORM.iter() {
                    let is_own = matches!(stage, Stage::Load | Stage::Deviation);
                    let is_equal = stage.has_equal_inputs(&before.0, &inputs);
                    assert!(is_own || is_equal, "{} reads {inputs:?}", stage.name());
                }
                let impact = Stages::of(Stage::Impact);
                for (wanted, gears) in
                    [(impact, None), (Stages::CLOSED_FORM, None), (impact, Some(&gears))]
                {
                    let earlier = Earlier { inputs: &before.0, solution: &before.1, gears };
                    let after = solve_after(&inputs, wanted, Some(earlier), &|_| true).unwrap();
                    let plain = solve(&inputs, wanted).unwrap();
                    assert_eq!(Solution { ran: after.ran, ..plain }, after, "{inputs:?}");
                    before = (inputs.clone(), after);
                }
            }
        }
    }
}
