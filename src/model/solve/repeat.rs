//! Repeats a closed-form solve in place with other load or deviations, as studies do.

use super::by_method::Solving;
use super::setup::Setup;
use crate::model::inputs::{Combination, Drive, Inputs, Method};
use crate::model::stage::Stages;
use crate::model::{Refusal, Solution};

/// Solves again in place if `inputs` differ from those of the solution only in load and deviations
/// and the wanted stages have a closed form. The results have the bits of [`solve`](super::solve)
/// without the comparisons of the other stages' inputs. `setup` stores the common values of all
/// repeats and is empty at first. Returns `None` if more differs; inputs, solution and setup then
/// stay unchanged.
///
/// # Errors
/// Those of [`solve`](super::solve). The solution is then invalid.
pub fn solve_repeated(
    (before, change): (&mut Inputs, Change),
    solution: &mut Solution,
    setup: &mut Option<Setup>,
    inputs: &Inputs,
    wanted: Stages,
) -> Option<Result<(), Refusal>> {
    if let (Change::LoadAlone, Some(setup)) = (change, &setup) {
        LoadAndDeviation::of(inputs).put(before);
        debug_assert_eq!(before, inputs);
        return Some(Solving::from_load(inputs, wanted, setup).repeat(solution));
    }
    let wanted = wanted.within(inputs.method.stages());
    let has_closed_form =
        Method::CLOSED_FORM.contains(&inputs.method) && Stages::ALL.covers(wanted);
    if !has_closed_form || inputs.accurate || solution.geometry.needs_precision(inputs.bores()) {
        return None;
    }
    let earlier = LoadAndDeviation::of(before);
    LoadAndDeviation::of(inputs).put(before);
    if before != inputs {
        earlier.put(before);
        return None;
    }
    let setup = setup.get_or_insert_with(|| Setup::of(inputs));
    Some(Solving::from_load(inputs, wanted, setup).repeat(solution))
}

/// The difference between the inputs of a solve and the previous inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// Only load and deviations differ.
    LoadAlone,
    /// A comparison must find the difference.
    Unknown,
}

/// Whether inputs differ only in load and deviations, as [`solve_repeated`] needs.
#[must_use]
pub fn differ_in_load_alone(one: &Inputs, other: &Inputs) -> bool {
    let mut same_load = one.clone();
    LoadAndDeviation::of(other).put(&mut same_load);
    same_load == *other
}

/// The inputs of the stages load and deviation, which no other closed-form stage reads.
struct LoadAndDeviation {
    drive: Drive,
    deflection: Option<f64>,
    base_pitch_deviation: f64,
    base_pitches: [Option<f64>; 2],
    combination: Combination,
    backlash: f64,
    driven_tip_relief: f64,
    driver_root_relief: f64,
}

impl LoadAndDeviation {
    fn of(inputs: &Inputs) -> LoadAndDeviation {
        LoadAndDeviation {
            drive: inputs.drive,
            deflection: inputs.deflection,
            base_pitch_deviation: inputs.base_pitch_deviation,
            base_pitches: [inputs.driver.base_pitch, inputs.driven.base_pitch],
            combination: inputs.combination,
            backlash: inputs.backlash,
            driven_tip_relief: inputs.driven.tip_relief,
            driver_root_relief: inputs.driver.root_relief,
        }
    }

    fn put(&self, inputs: &mut Inputs) {
        inputs.drive = self.drive;
        inputs.deflection = self.deflection;
        inputs.base_pitch_deviation = self.base_pitch_deviation;
        [inputs.driver.base_pitch, inputs.driven.base_pitch] = self.base_pitches;
        inputs.combination = self.combination;
        inputs.backlash = self.backlash;
        inputs.driven.tip_relief = self.driven_tip_relief;
        inputs.driver.root_relief = self.driver_root_relief;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, solve};

    fn edits() -> [fn(&mut Inputs); 9] {
        [
            |inputs| inputs.drive = Drive::Torque(123.0),
            |inputs| inputs.deflection = Some(17e-6),
            |inputs| inputs.base_pitch_deviation = 9e-6,
            |inputs| inputs.driver.base_pitch = Some(7e-6),
            |inputs| inputs.driven.base_pitch = Some(8e-6),
            |inputs| inputs.combination = Combination::Sum,
            |inputs| inputs.backlash = 3e-6,
            |inputs| inputs.driven.tip_relief = 4e-6,
            |inputs| inputs.driver.root_relief = 5e-6,
        ]
    }

    fn pair() -> Inputs {
        Inputs { base_pitch_deviation: 16e-6, ..standard_pair(20, 31, 5e-3) }
    }

    #[test]
    fn only_their_own_stages_read_load_and_deviations() {
        let before = pair();
        for edit in edits() {
            let mut after = before.clone();
            edit(&mut after);
            for stage in Stages::CLOSED_FORM.iter() {
                let is_own = matches!(stage, Stage::Load | Stage::Deviation);
                assert!(
                    is_own || stage.has_equal_inputs(&before, &after),
                    "{} reads {after:?}",
                    stage.name()
                );
            }
        }
    }

    #[test]
    fn a_repeated_solve_has_the_bits_of_a_plain_one() {
        for method in Method::CLOSED_FORM {
            let mut before = Inputs { method, ..pair() };
            let mut solution = solve(&before, Stages::CLOSED_FORM).unwrap();
            let (mut inputs, mut setup) = (before.clone(), None);
            for edit in edits() {
                edit(&mut inputs);
                let cases = [Stages::of(Stage::Impact), Stages::CLOSED_FORM].into_iter().flat_map(
                    |wanted| [Change::Unknown, Change::LoadAlone].map(|change| (wanted, change)),
                );
                for (wanted, change) in cases {
                    let before = (&mut before, change);
                    let repeated =
                        solve_repeated(before, &mut solution, &mut setup, &inputs, wanted);
                    assert_eq!(repeated, Some(Ok(())), "{inputs:?}");
                    let plain = solve(&inputs, wanted).unwrap();
                    let ran = solution.ran;
                    assert_eq!(Solution { ran, ..plain }, solution);
                }
            }
        }
    }

    #[test]
    fn a_solve_with_another_gear_is_not_repeated() {
        let mut before = pair();
        let mut solution = solve(&before, Stages::CLOSED_FORM).unwrap();
        let (inputs, kept) = (before.clone(), solution.clone());
        let mut other = Inputs { backlash: 1e-6, ..inputs.clone() };
        other.driven.density *= 1.1;
        let wanted = Stages::CLOSED_FORM;
        let repeated = solve_repeated(
            (&mut before, Change::Unknown),
            &mut solution,
            &mut None,
            &other,
            wanted,
        );
        assert_eq!(repeated, None);
        assert_eq!((before, solution), (inputs, kept));
    }
}
