//! Solves pairs one after the other and reuses the results of the previous pair.

use crate::model::inputs::Method;
use crate::model::solve::{Earlier, Lazy, solve_after};
use crate::model::{Inputs, Refusal, Solution, Stage, Stages};

/// The last solve by each method.
#[derive(Debug, Clone, Default)]
pub struct Evaluator {
    solved: Vec<Solved>,
    /// Whether all pairs differ only in load and deviations.
    pub(crate) has_same_gears: bool,
}

#[derive(Debug, Clone)]
struct Solved {
    inputs: Inputs,
    solution: Solution,
    gears: Lazy,
}

impl Evaluator {
    /// An evaluator of pairs that differ, if `has_same_gears`, only in load and deviations.
    pub fn new(has_same_gears: bool) -> Evaluator {
        Evaluator { has_same_gears, solved: Vec::new() }
    }

    /// Solves a pair by the given method, whatever the inputs name. Runs only the wanted stages
    /// whose inputs differ from the last solve by this method; [`Solution::ran`] lists these
    /// stages.
    ///
    /// # Errors
    /// Those of [`solve_after`]. The last results then stay.
    pub fn solve(
        &mut self,
        inputs: &Inputs,
        method: Method,
        wanted: Stages,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<Solution, Refusal> {
        self.solve_kept(inputs, method, wanted, go_on).cloned()
    }

    /// Like [`Evaluator::solve`], without a copy of the solution.
    ///
    /// # Errors
    /// Those of [`solve_after`]. The last results then stay.
    pub fn solve_kept(
        &mut self,
        inputs: &Inputs,
        method: Method,
        wanted: Stages,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<&Solution, Refusal> {
        let by_method;
        let inputs = if inputs.method == method {
            inputs
        } else {
            by_method = Inputs { method, ..inputs.clone() };
            &by_method
        };
        let own = self.solved.iter().position(|solved| solved.inputs.method == method);
        let last = own.and_then(|at| self.solved.get(at));
        let rests = |last: &Solved| {
            let mut stages = Stages::of(Stage::Static).iter();
            stages.all(|stage| stage.has_equal_inputs(&last.inputs, inputs))
        };
        let earlier = self.motion_of(inputs).filter(|_| !last.is_some_and(rests)).or(last);
        let earlier = earlier.map(|Solved { inputs, solution, gears }| Earlier {
            inputs,
            solution,
            gears: self.has_same_gears.then_some(gears),
        });
        let solution = solve_after(inputs, wanted, earlier, go_on)?;
        let gears = own.map(|at| self.solved.swap_remove(at).gears).unwrap_or_default();
        self.solved.push(Solved { inputs: inputs.clone(), solution, gears });
        Ok(&self.solved[self.solved.len() - 1].solution)
    }

    /// The motion of a pair to be solved at rest, whose mesh and load at rest are those of `static`.
    fn motion_of(&self, inputs: &Inputs) -> Option<&Solved> {
        let moving = |solved: &&Solved| {
            solved.inputs.method == Method::Dynamic
                && solved.inputs == Inputs { method: Method::Dynamic, ..inputs.clone() }
        };
        self.solved.iter().filter(|_| inputs.method == Method::Static).find(moving)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::case::fields::{FIELDS, index_of, keeps_gears};
    use crate::model::inputs::Drive;
    use crate::model::{QUANTITIES, solve};

    fn edited(key: &str, text: &str) -> Case {
        let mut case = Case::table_1();
        case.write(index_of(key).unwrap(), text);
        case
    }

    /// The stages that run after an edit of this field in a solved case of Table 1.
    fn ran(method: Method, key: &str, text: &str) -> Stages {
        let mut evaluator = Evaluator::default();
        let (before, after) = (Case::table_1(), edited(key, text));
        let mut run = |case: &Case| {
            evaluator.solve(&case.inputs().unwrap(), method, Stages::EVERY, &|_| true).unwrap()
        };
        assert_eq!(run(&before).ran, run_fresh(method, &before).ran);
        let (kept, fresh) = (run(&after), run_fresh(method, &after));
        assert_equal(&kept, &fresh, key);
        kept.ran
    }

    fn assert_equal(kept: &Solution, fresh: &Solution, key: &str) {
        assert_eq!(kept.stages, fresh.stages);
        for quantity in QUANTITIES {
            let [kept, fresh] = [kept, fresh].map(quantity.value);
            assert_eq!(kept, fresh, "{} after an edit of {key}", quantity.key);
        }
    }

    fn run_fresh(method: Method, case: &Case) -> Solution {
        solve(&Inputs { method, ..case.inputs().unwrap() }, Stages::EVERY).unwrap()
    }

    #[test]
    fn an_edit_runs_only_the_stages_that_depend_on_it() {
        for method in [Method::Paper, Method::Exact, Method::Static, Method::Dynamic] {
            assert_eq!(ran(method, "title", "another"), Stages::NONE);
            let density = ran(method, "driver.density", "7900 kg/m3");
            for stage in
                [Stage::Geometry, Stage::Position, Stage::Velocity, Stage::Mesh, Stage::Static]
            {
                assert!(!density.has(stage), "{}: density runs {}", method.name(), stage.name());
            }
            assert!(density.has(Stage::Masses) && density.has(Stage::Impact));
            assert_eq!(density.has(Stage::Dynamic), method == Method::Dynamic);
            assert!(!ran(method, "operation.speed", "1900 rpm").has(Stage::Geometry));
            assert!(ran(method, "pair.module", "5.5 mm").has(Stage::Geometry));
        }
        let damping = ran(Method::Dynamic, "model.damping_ratio", "0.1");
        assert_eq!(
            damping,
            Stages::NONE.with(Stage::Dynamic).with(Stage::SteadyMotion).with(Stage::Clearing)
        );
        let stations = ran(Method::Exact, "model.stations", "32");
        assert_eq!(stations, Stages::NONE.with(Stage::Stations));
    }

    #[test]
    fn a_load_or_deviation_keeps_the_gears() {
        let fields = (0..FIELDS.len()).filter(|field| keeps_gears(*field));
        for (field, method) in fields.flat_map(|field| Method::CLOSED_FORM.map(|by| (field, by))) {
            let mut evaluator = Evaluator::new(true);
            let mut after = edited("operation.power", "");
            after.write(index_of("operation.torque").unwrap(), "60 N m");
            let before = after.inputs().unwrap();
            after.write(field, FIELDS[field].example());
            if FIELDS[field].key == "operation.power" {
                after.write(index_of("operation.torque").unwrap(), "");
            }
            let mut run = |inputs: &Inputs| {
                evaluator.solve(inputs, method, Stages::EVERY, &|_| true).unwrap()
            };
            run(&before);
            let kept = run(&after.inputs().unwrap());
            assert_equal(&kept, &run_fresh(method, &after), FIELDS[field].key);
        }
    }

    /// The first solve stores the load sharing of the pairs in the mesh.
    #[test]
    fn a_reused_mesh_of_coupled_pairs_gives_the_bits_of_a_fresh_one() {
        let at = |speed: &str| {
            let mut case = Case::table_1();
            for (key, text) in
                [("model.tooth_compliance", "finite-element"), ("operation.speed", speed)]
            {
                case.write(index_of(key).unwrap(), text);
            }
            // The same torque gives the same mesh.
            Inputs { drive: Drive::Torque(71.6), method: Method::Dynamic, ..case.inputs().unwrap() }
        };
        let mut evaluator = Evaluator::default();
        let wanted = Stages::of(Stage::Dynamic);
        for speed in ["2000 rpm", "300 rpm", "9000 rpm"] {
            let inputs = at(speed);
            let kept = evaluator.solve_kept(&inputs, Method::Dynamic, wanted, &|_| true).unwrap();
            assert_eq!(kept.ran.has(Stage::Mesh), speed == "2000 rpm");
            let fresh = solve(&inputs, wanted).unwrap();
            assert_eq!(kept.dynamic, fresh.dynamic, "{speed}");
        }
    }

    #[test]
    fn the_load_at_rest_after_a_motion_is_that_of_the_motion() {
        let (mut evaluator, case) = (Evaluator::default(), edited("operation.speed", "300 rpm"));
        let inputs = case.inputs().unwrap();
        let mut run = |method| evaluator.solve(&inputs, method, Stages::EVERY, &|_| true).unwrap();
        run(Method::Dynamic);
        let kept = run(Method::Static);
        assert!(!kept.ran.has(Stage::Mesh) && !kept.ran.has(Stage::Static));
        assert_equal(&kept, &run_fresh(Method::Static, &case), "the method");
    }

    #[test]
    fn only_newly_wanted_stages_run() {
        let (mut evaluator, case) = (Evaluator::default(), Case::table_1());
        let inputs = case.inputs().unwrap();
        let mut ran =
            |wanted| evaluator.solve(&inputs, Method::Exact, wanted, &|_| true).unwrap().ran;
        assert!(ran(Stages::of(Stage::Position)).has(Stage::Position));
        assert_eq!(ran(Stages::of(Stage::Velocity)), Stages::NONE.with(Stage::Velocity));
        assert_eq!(ran(Stages::of(Stage::Velocity)), Stages::NONE);
    }
}
