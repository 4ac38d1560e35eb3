//! A solve: the stages in their order, each run only where it is wanted and no earlier result is valid
//! holds.

use std::cell::{Cell, OnceCell};

use twofloat::TwoFloat;

use super::impact::Masses;
use super::inputs::{Inputs, Method};
use super::request::{Earlier, Request};
use super::spacing::Spacing;
use super::stage::{Stage, Stages};
use super::{
    Choice, Geometry, Kept, Outcome, Position, Refusal, Solution, auto, clearing, compliance,
    deviation, friction, geometry, impact, load_sharing, position, stations, stiffness_spread,
    velocity,
};
use crate::numeric::Real;

/// Solve the pair, running only the wanted stages and what they need.
///
/// Geometry, load and deviation always run, since they tell the outcome. Where a small difference
/// decides, geometry and position are computed in double-double arithmetic, asked for or not.
///
/// # Errors
/// A [`Refusal`] where the pair cannot mesh, or D does not exist. Where only the force cannot be
/// computed, the rest is given and [`Solution::withheld`] says why.
pub fn solve(inputs: &Inputs, wanted: Stages) -> Result<Solution, Refusal> {
    solve_while(inputs, wanted, &|_| true)
}

/// The same, asked now and then whether to go on, with the part that is done, from 0 to 1.
///
/// # Errors
/// Those of [`solve`], and [`Refusal::Stopped`] where `go_on` says no.
pub fn solve_while(
    inputs: &Inputs,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    solve_after(inputs, wanted, None, go_on)
}

/// The same after an earlier solve: what still holds of it is kept, and [`Solution::ran`] tells
/// what was not.
///
/// # Errors
/// Those of [`solve_while`].
pub fn solve_after(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    if inputs.method == Method::Auto {
        return solve_by_choice(inputs, wanted, earlier, go_on);
    }
    let earlier = earlier.filter(|earlier| earlier.solution.method == inputs.method);
    let asked = Request {
        inputs,
        wanted: wanted.within(inputs.method.stages()),
        earlier,
        changed: Cell::default(),
    };
    Solving {
        asked,
        precise: OnceCell::new(),
    }
    .run(go_on)
}

/// Solve with the method that the closed form calls for, or with the motion as a trial where it
/// cannot tell; with the one taken before where nothing has changed since. The least relief is that
/// of the method that was taken.
fn solve_by_choice(
    inputs: &Inputs,
    wanted: Stages,
    earlier: Option<Earlier<'_>>,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let before =
        earlier.filter(|earlier| earlier.inputs == inputs && earlier.solution.choice.is_some());
    let chosen = match before {
        Some(earlier) => Solution {
            ran: Stages::NONE,
            ..earlier.solution.clone()
        },
        None => chosen(inputs, wanted.except(Stages::LATE), go_on)?,
    };
    if before.is_none() && wanted.within(Stages::LATE) == Stages::NONE {
        return Ok(chosen);
    }
    let taken = auto::taken(inputs, chosen.method);
    let wanted = if chosen.method == Method::Static {
        at_rest(wanted)
    } else {
        wanted
    };
    let earlier = Earlier {
        inputs: &taken,
        solution: &chosen,
    };
    let whole = solve_after(&taken, wanted, Some(earlier), go_on)?;
    Ok(Solution {
        ran: whole.ran.and(chosen.ran),
        choice: chosen.choice,
        ..whole
    })
}

/// The method that is taken, solved. Where `static` is, it stands for `dynamic` where that is
/// wanted. One that is too slow to be followed in time is at rest.
fn chosen(
    inputs: &Inputs,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Solution, Refusal> {
    let read = wanted.within(Stages::CLOSED_FORM).and(auto::READS);
    let closed_form = solve(&auto::taken(inputs, Method::Exact), read);
    let choice = auto::choose(inputs, &closed_form);
    let still = || solve_while(&auto::taken(inputs, Method::Static), at_rest(wanted), go_on);
    let (solved, choice) = match (choice.method, &closed_form) {
        (Method::Exact, Ok(known)) => {
            let taken = auto::taken(inputs, Method::Exact);
            let earlier = Earlier {
                inputs: &taken,
                solution: known,
            };
            let found = solve_after(&taken, wanted, Some(earlier), go_on)?;
            (
                Ok(Solution {
                    ran: found.ran.and(known.ran),
                    ..found
                }),
                choice,
            )
        }
        (Method::Static, _) => (still(), choice),
        _ => match solve_while(&auto::taken(inputs, Method::Dynamic), wanted, go_on) {
            Err(Refusal::TooSlow { .. }) => (still(), choice),
            Ok(moved) if choice.is_open() => decided(inputs, choice, moved, wanted, go_on),
            found => (found, choice),
        },
    };
    let solution = solved?;
    Ok(Solution {
        choice: Some(Choice {
            method: solution.method,
            ..choice
        }),
        ..solution
    })
}

/// The motion, or the load at rest on the same mesh where inertia turns out to add little.
fn decided(
    inputs: &Inputs,
    choice: Choice,
    moved: Solution,
    wanted: Stages,
    go_on: &dyn Fn(f64) -> bool,
) -> (Result<Solution, Refusal>, Choice) {
    let choice = auto::added_by_inertia(&moved).map_or(choice, |adds| choice.tried(inputs, adds));
    if choice.method == Method::Dynamic {
        return (Ok(moved), choice);
    }
    let known = Solution {
        method: Method::Static,
        ..moved
    };
    let taken = auto::taken(inputs, Method::Static);
    let earlier = Earlier {
        inputs: &taken,
        solution: &known,
    };
    let found = solve_after(&taken, at_rest(wanted), Some(earlier), go_on);
    (
        found.map(|found| Solution {
            ran: found.ran.and(known.ran),
            ..found
        }),
        choice,
    )
}

/// What is wanted of the load at rest, which stands for the motion.
fn at_rest(wanted: Stages) -> Stages {
    if wanted.has(Stage::Dynamic) {
        wanted.and(Stages::of(Stage::Static))
    } else {
        wanted
    }
}

/// The impact force alone, where there is one.
fn force(inputs: &Inputs) -> Option<f64> {
    Some(solve(inputs, Stages::of(Stage::Impact)).ok()?.impact?.force)
}

/// A solve on its way.
struct Solving<'a> {
    asked: Request<'a>,
    /// Geometry in double-double arithmetic, where it is called for.
    precise: OnceCell<Option<Geometry<TwoFloat>>>,
}

impl Solving<'_> {
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

    /// The required relief, once the outcome is known.
    fn clear(&self, solution: &mut Solution, go_on: &dyn Fn(f64) -> bool) -> Result<(), Refusal> {
        let held = self
            .asked
            .kept(Stage::Clearing)
            .and_then(|earlier| earlier.clearing);
        if held.is_none() {
            solution.ran = solution.ran.with(Stage::Clearing);
        }
        solution.clearing = Some(held.map_or_else(
            || clearing::clearing(self.asked.inputs, solution, go_on),
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
        let mesh_force = if let Some(earlier) = self.asked.kept(Stage::Load) {
            earlier.mesh_force
        } else {
            ran = ran.with(Stage::Load);
            let force = inputs.torque() / geometry.driver.base;
            self.asked
                .note(Stage::Load, |s| s.mesh_force.to_bits() == force.to_bits());
            force
        };
        let masses = if let Some(earlier) = self.asked.kept(Stage::Masses) {
            earlier.kept.masses
        } else {
            ran = ran.with(Stage::Masses);
            let bodies = inputs.bodies();
            let masses = self.precise(&geometry)?.map_or_else(
                || Masses::of(&bodies, &geometry),
                |pair| Masses::of(&bodies, &pair),
            )?;
            self.asked.note(Stage::Masses, |s| s.kept.masses == masses);
            masses
        };
        let deviation = if let Some(earlier) = self.asked.kept(Stage::Deviation) {
            earlier.kept.deviation
        } else {
            ran = ran.with(Stage::Deviation);
            let deviation = deviation::deviation(&inputs.deviation(), &geometry, mesh_force)?;
            self.asked
                .note(Stage::Deviation, |s| s.kept.deviation == deviation);
            deviation
        };
        let strikes = deviation.total.rounded() > 0.0;
        Ok(Solution {
            method: inputs.method,
            choice: None,
            outcome: if strikes {
                Outcome::CornerContact
            } else {
                Outcome::NoCornerContact
            },
            stages: Stages::of(Stage::Deviation).with(Stage::Masses),
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
            clearing: None,
            withheld: None,
            stations_withheld: None,
        })
    }

    fn geometry(&self, ran: &mut Stages) -> Result<Geometry, Refusal> {
        *ran = ran.with(Stage::Geometry);
        // More digits may be behind the same rounded ones.
        self.asked.note(Stage::Geometry, |_| false);
        let plain = geometry::geometry::<f64>(&self.asked.inputs.shape());
        let precise = self.precise_of(plain.as_ref().ok())?;
        let _ = self.precise.set(precise);
        precise.map_or(plain, |precise| Ok(precise.rounded()))
    }

    /// Geometry in double-double arithmetic, where it is asked for or small differences call for
    /// it.
    fn precise(&self, plain: &Geometry) -> Result<Option<Geometry<TwoFloat>>, Refusal> {
        match self.precise.get() {
            Some(&known) => Ok(known),
            None => self.precise_of(Some(plain)),
        }
    }

    fn precise_of(&self, plain: Option<&Geometry>) -> Result<Option<Geometry<TwoFloat>>, Refusal> {
        let close_call =
            plain.is_none_or(|geometry| geometry.is_close_call(self.asked.inputs.bores()));
        (self.asked.inputs.accurate || close_call)
            .then(|| geometry::geometry::<TwoFloat>(&self.asked.inputs.shape()))
            .transpose()
    }

    /// D, and everything after it.
    fn locate(&self, solution: &mut Solution) -> Result<(), Refusal> {
        let found = if let Some(earlier) = self.asked.kept(Stage::Position) {
            Ok(earlier.position)
        } else {
            solution.ran = solution.ran.with(Stage::Position);
            let precise = self.precise(&solution.geometry)?;
            let found = position::position(
                &self.asked.inputs.contact_search(),
                &solution.geometry,
                precise.as_ref(),
                &solution.kept.deviation,
            );
            let position = found.as_ref().ok().copied().flatten();
            self.asked.note(Stage::Position, |s| s.position == position);
            found
        };
        solution.stages = solution.stages.with(Stage::Position);
        match found {
            Ok(Some(position)) => {
                solution.position = Some(position);
                solution.withheld = self.strike(solution, &position).err();
            }
            Ok(None) => solution.outcome = Outcome::NoCornerContact,
            // The methods that share the load do not need it.
            Err(refusal) if self.asked.inputs.method.shares_load() => {
                solution.stages = solution.stages.without(Stage::Position);
                solution.withheld = Some(refusal);
            }
            Err(refusal) => return Err(refusal),
        }
        Ok(())
    }

    /// The stages from the velocity on, as far as they are wanted and can be computed.
    fn strike(&self, solution: &mut Solution, position: &Position) -> Result<(), Refusal> {
        let (inputs, geometry, tip) = (self.asked.inputs, solution.geometry, &position.contact);
        let strike = inputs.impact();
        let masses = solution.kept.masses;
        solution.velocity = self.stage(
            solution,
            Stage::Velocity,
            |s| s.velocity,
            || Ok(velocity::velocity(inputs.driven_speed(), tip)),
        )?;
        let place = || compliance::ContactPlace::at_tip(strike.tip_radius, &geometry, tip);
        let borne = || compliance::Teeth::of(&strike.elasticity, &geometry)?.at(&place());
        solution.compliance = self.stage(solution, Stage::Compliance, |s| s.compliance, borne)?;
        let (Some(velocity), Some(teeth)) = (solution.velocity, solution.compliance) else {
            return Ok(());
        };
        let struck = || {
            let spring = compliance::Teeth::of(&strike.elasticity, &geometry)?.spring(&place())?;
            let elastic = (&teeth, &spring);
            impact::impact(&strike, &geometry, &masses, tip, elastic, &velocity)
        };
        let Some(impact) = self.stage(solution, Stage::Impact, |s| s.impact, struck)? else {
            return Ok(());
        };
        solution.impact = Some(impact);
        let rubbed = || {
            Ok(friction::friction(
                &strike,
                &geometry,
                tip,
                &velocity,
                &impact,
                masses.reduced(),
            ))
        };
        solution.friction = self.stage(solution, Stage::Friction, |s| s.friction, rubbed)?;
        solution.band = self.stage(
            solution,
            Stage::Band,
            |s| s.band,
            || Ok(stiffness_spread::band(inputs, impact.force, force)),
        )?;
        let stood = || {
            Ok(stations::stations(
                (&strike, Spacing::of(inputs)),
                &geometry,
                &masses,
                position,
                impact.force,
            ))
        };
        let earlier = |s: &Solution| Some((s.stations.clone(), s.stations_withheld));
        if let Some((stations, withheld)) = self.stage(solution, Stage::Stations, earlier, stood)? {
            (solution.stations, solution.stations_withheld) = (stations, withheld);
        }
        Ok(())
    }

    /// A stage's result: the earlier one where it still holds, else a new one where it is wanted.
    fn stage<T: PartialEq>(
        &self,
        solution: &mut Solution,
        stage: Stage,
        earlier: impl Fn(&Solution) -> Option<T>,
        new: impl FnOnce() -> Result<T, Refusal>,
    ) -> Result<Option<T>, Refusal> {
        if !self.asked.wanted.has(stage) {
            return Ok(None);
        }
        if let Some(held) = self.asked.kept(stage).and_then(&earlier) {
            solution.stages = solution.stages.with(stage);
            return Ok(Some(held));
        }
        let found = new()?;
        self.asked
            .note(stage, |s| earlier(s).as_ref() == Some(&found));
        solution.stages = solution.stages.with(stage);
        solution.ran = solution.ran.with(stage);
        Ok(Some(found))
    }
}
