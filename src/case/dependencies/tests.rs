//! Changes every field in every case and compares the bits of the results.

use std::collections::BTreeSet;
use std::sync::LazyLock;
use std::thread;

use super::{fields_of, finite, is_read, stages_of, value_of};
use crate::case::fields::{Kind, index_of};
use crate::case::{Case, EXAMPLES, Example, FIELDS};
use crate::model::Earlier;
use crate::model::inputs::{ContactCompliance, Method, ToothCompliance};
use crate::model::solve::solve_after;
use crate::model::{self, Inputs, QUANTITIES, Quantity, Refusal, Solution, Stage, Stages};

struct Solved {
    name: String,
    variant: &'static str,
    case: Case,
    inputs: Inputs,
    solution: Solution,
}

type Change = fn(&mut Inputs);

/// Changes of a case that make other fields relevant.
const VARIANTS: &[(&str, Change)] = &[
    ("as it is", |_| {}),
    ("paper", |inputs| inputs.method = Method::Paper),
    ("static", |inputs| inputs.method = Method::Static),
    ("static, relieved, with friction", |inputs| {
        relieved(inputs, Method::Static);
    }),
    ("static, contact ratio 1.94", |inputs| {
        nearly_double_contact(inputs, 1.15);
    }),
    ("static, contact ratio 1.97", |inputs| {
        nearly_double_contact(inputs, 1.17);
    }),
    ("dynamic", |inputs| {
        relieved(inputs, Method::Dynamic);
        (inputs.warmup_cycles, inputs.tolerance) = (2, 1e-5);
    }),
    ("dynamic, beam", |inputs| {
        (inputs.method, inputs.friction_coefficient) = (Method::Dynamic, Some(0.05));
        (inputs.warmup_cycles, inputs.tolerance) = (2, 1e-5);
        inputs.tooth_compliance = Some(ToothCompliance::BEAM);
    }),
    ("deflection computed", |inputs| inputs.deflection = None),
    ("stations as needed", |inputs| inputs.stations = None),
    ("a grade of the driver", |inputs| {
        inputs.driver.grade = Some(6);
    }),
    ("a grade of the driven gear", |inputs| {
        inputs.driven.grade = Some(6);
    }),
    ("inertia given", |inputs| {
        (inputs.driver.inertia, inputs.driven.inertia) = (Some(1e-3), Some(2e-3));
    }),
    ("auto", |inputs| inputs.method = Method::Auto),
    ("beam, deflection given", |inputs| {
        inputs.tooth_compliance = Some(ToothCompliance::BEAM);
        inputs.deflection = Some(21e-6);
    }),
    ("weber", |inputs| {
        inputs.contact_compliance = ContactCompliance::WEBER;
    }),
    ("constant", |inputs| {
        inputs.contact_compliance = ContactCompliance::CONSTANT;
    }),
    ("edge radius", |inputs| {
        inputs.driven.tip_radius = Some(0.3e-3);
    }),
    ("outside the fit", |inputs| {
        inputs.pressure_angle = 22f64.to_radians();
        inputs.centre_distance = None;
        inputs.tooth_compliance = Some(ToothCompliance::KUANG_YANG);
    }),
    ("softer than the fit", |inputs| {
        inputs.tooth_compliance = Some(ToothCompliance::KUANG_YANG);
        (inputs.driver.young, inputs.driven.young) = (90e9, 90e9);
    }),
    ("static, misaligned", |inputs| {
        relieved(inputs, Method::Static);
        (inputs.helix_angle, inputs.misalignment, inputs.slices) = (0.3, 5e-6, Some(9));
    }),
];

/// The variants that are also solved by other methods.
const AS_IT_IS: [&str; 2] = ["as it is", "static, relieved, with friction"];

fn relieved(inputs: &mut Inputs, method: Method) {
    (inputs.method, inputs.friction_coefficient, inputs.base_pitch_deviation) =
        (method, Some(0.05), 0.0);
    for gear in [&mut inputs.driver, &mut inputs.driven] {
        (gear.tip_relief, gear.root_relief) = (3e-6, 2e-6);
    }
}

/// At the ends of contact, a pair two base pitches ahead is just outside the line of action.
fn nearly_double_contact(inputs: &mut Inputs, addendum: f64) {
    relieved(inputs, Method::Static);
    inputs.centre_distance = None;
    for gear in [&mut inputs.driver, &mut inputs.driven] {
        (gear.teeth, gear.profile_shift, gear.addendum) = (40, 0.0, addendum);
    }
}

/// Every stage. Excludes inertia for very slow pairs, whose motion has too many oscillations.
fn wanted(inputs: &Inputs) -> Stages {
    const SLOW: f64 = 500.0;
    if inputs.speed < SLOW { Stages::ALL.and(Stages::of(Stage::Static)) } else { Stages::EVERY }
}

fn few_stations(inputs: &Inputs) -> Inputs {
    Inputs { stations: inputs.stations.map(|count| count.min(2)), ..inputs.clone() }
}

fn solve(inputs: &Inputs) -> Result<Solution, Refusal> {
    model::solve(&few_stations(inputs), wanted(inputs))
}

/// The solution after another solve, with reuse of its results.
fn resolved(before: &Solved, inputs: &Inputs) -> Solution {
    let inputs_before = &few_stations(&before.inputs);
    let earlier = Earlier { inputs: inputs_before, solution: &before.solution, gears: None };
    solve_after(&few_stations(inputs), wanted(inputs), Some(earlier), &|_| true).unwrap()
}

/// Every case with its variants, solved once for all tests.
fn solved_cases() -> &'static [Solved] {
    static CASES: LazyLock<Vec<Solved>> = LazyLock::new(|| {
        let of = |example: &Example| variants(&example.document().case, example.name);
        EXAMPLES.iter().flat_map(of).collect()
    });
    &CASES
}

fn variants(case: &Case, name: &str) -> Vec<Solved> {
    /// Load sharing takes a thousand times as long: three kinds of pairs share its variants.
    const SHARING: [&str; 3] = ["zhou", "turbo", "high-contact"];
    let kind = SHARING.iter().position(|kind| name.contains(kind));
    let of = |(index, &(variant, change)): (usize, &(&'static str, Change))| {
        let mut inputs = case.inputs().unwrap();
        (inputs.stations, inputs.warmup_cycles, inputs.tolerance) = (Some(1), 1, 1e-3);
        // A change along the face width makes slices.
        inputs.slices = Some(5);
        change(&mut inputs);
        let costly = inputs.method.shares_load() || variant != "as it is";
        let is_own =
            kind == Some(index % SHARING.len()) || kind == Some(0) && LISTED.contains(&variant);
        if costly && !is_own {
            return None;
        }
        let solution = solve(&inputs).ok()?;
        Some(Solved {
            name: format!("{name}, {variant}"),
            variant,
            case: case.clone(),
            inputs,
            solution,
        })
    };
    VARIANTS.iter().enumerate().filter_map(of).collect()
}

/// The inputs with a small and a large change of the field, and with the field given or removed.
fn changed(solved: &Solved, field: usize) -> Vec<Inputs> {
    let with = |put: &dyn Fn(&mut Inputs)| {
        let mut inputs = solved.inputs.clone();
        put(&mut inputs);
        inputs
    };
    match FIELDS[field].kind {
        Kind::Text => Vec::new(),
        Kind::List(put) => [0.1, -0.2].map(|value| with(&|inputs| put(inputs, [value; 8]))).into(),
        // A change of the method is tested as another case.
        Kind::Choice(..)
            if FIELDS[field].key == "model.method" && !AS_IT_IS.contains(&solved.variant) =>
        {
            Vec::new()
        }
        Kind::Choice(names, put) => {
            (0..names.len()).map(|choice| with(&|inputs| put(inputs, choice))).collect()
        }
        Kind::Count(_, _, put) => {
            let now = solved.case.value(field).unwrap_or(1.0) as u32;
            [1, 9].map(|more| with(&|inputs| put(inputs, now + more))).into()
        }
        Kind::Number(_, range, put) => {
            let values = match solved.case.value(field) {
                Some(now) if now != 0.0 => vec![now * 0.997, now * 1.2],
                _ => offered(solved, FIELDS[field].key, range.unit),
            };
            values.into_iter().map(|value| with(&|inputs| put(inputs, value))).collect()
        }
    }
}

/// Values for a field that is zero or not given.
fn offered(solved: &Solved, key: &str, unit: &str) -> Vec<f64> {
    match (key, unit) {
        ("pair.centre_distance", _) => {
            [1.0002, 1.003].map(|part| part * solved.solution.geometry.centre_distance).into()
        }
        ("operation.power", _) => vec![1e4],
        ("operation.torque", _) => vec![50.0],
        (key, _) if key.ends_with("relief_length") => vec![0.2e-3, 1.5e-3, 30e-3],
        (_, "um") => vec![2e-6, 9e-6],
        (_, "mm") => vec![0.2e-3, 1.5e-3],
        _ => vec![0.02, 0.3],
    }
}

/// Whether the results of a stage are the same to the last bit.
fn same(stage: Stage, one: &Solution, other: &Solution) -> bool {
    match stage {
        Stage::Geometry => one.geometry == other.geometry,
        Stage::Load => one.mesh_force.to_bits() == other.mesh_force.to_bits(),
        Stage::Masses => one.reduced_mass.to_bits() == other.reduced_mass.to_bits(),
        Stage::Figures => one.figures == other.figures,
        Stage::Deviation => one.deviation == other.deviation,
        Stage::Position => one.position == other.position,
        Stage::Velocity => one.velocity == other.velocity,
        Stage::Compliance => one.compliance == other.compliance,
        Stage::Impact => (one.impact, one.withheld) == (other.impact, other.withheld),
        Stage::Friction => one.friction == other.friction,
        Stage::Band => one.band == other.band,
        Stage::Stations => {
            (&one.stations, one.stations_withheld) == (&other.stations, other.stations_withheld)
        }
        Stage::Mesh => one.mesh == other.mesh,
        Stage::Static => one.static_load == other.static_load,
        Stage::Dynamic => one.dynamic == other.dynamic,
        Stage::Resonance => one.resonance == other.resonance,
        Stage::StaticSpectrum => one.static_spectrum == other.static_spectrum,
        Stage::SteadyMotion => one.steady == other.steady,
        Stage::SpeedRun => one.over_speed == other.over_speed,
        Stage::Clearing => one.clearing == other.clearing,
    }
}

/// What is wrong after changes of one field of a case.
fn wrongly_reused(solved: &Solved, field: usize) -> BTreeSet<String> {
    let (mut wrong, key) = (BTreeSet::new(), FIELDS[field].key);
    for inputs in changed(solved, field) {
        let Ok(found) = solve(&inputs) else {
            if !is_read(field, &solved.inputs) && !is_read(field, &inputs) {
                wrong.insert(format!("no stage reads {key}, {}", solved.name));
            }
            continue;
        };
        let reused = resolved(solved, &inputs);
        let differ = Stage::ALL.into_iter().filter(|&stage| !same(stage, &reused, &found));
        let words = |stage: Stage| {
            format!("{} after {key} differs from a fresh solve, {}", stage.name(), solved.name)
        };
        wrong.extend(differ.map(words));
    }
    wrong
}

/// For every stage, case and change of a field, a solve that reuses earlier results has the bits of
/// a fresh solve.
#[test]
fn results_are_reused_only_if_a_change_does_not_affect_them() {
    let cases = solved_cases();
    let share = |part: usize| {
        let fields = (part..FIELDS.len()).step_by(2);
        let pairs = fields.flat_map(|field| cases.iter().map(move |solved| (solved, field)));
        pairs.flat_map(|(solved, field)| wrongly_reused(solved, field)).collect::<Vec<_>>()
    };
    let wrong = thread::scope(|scope| {
        let other = scope.spawn(|| share(1));
        [share(0), other.join().unwrap()].concat()
    });
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Relative changes below this value can be rounding.
const ROUNDING: f64 = 1e-9;

/// The variants in which every quantity is compared with the list of its fields.
const LISTED: [&str; 4] = ["as it is", "static, relieved, with friction", "dynamic", "edge radius"];

#[test]
fn a_quantity_lists_every_field_whose_change_alters_it() {
    let mut missing: BTreeSet<String> = BTreeSet::new();
    let is_listed =
        |solved: &&Solved| LISTED.contains(&solved.variant) && solved.name.contains("zhou");
    // The peaks over the speed move from one computed speed to another, so that the pages of
    // `explain` list no fields for them.
    let listing = || QUANTITIES.iter().filter(|quantity| quantity.stage != Stage::SpeedRun);
    let all = listing().map(|quantity| Stages::of(quantity.stage));
    let all = all.fold(Stages::NONE, Stages::and);
    for solved in solved_cases().iter().filter(is_listed) {
        let after = |field| {
            let few = changed(solved, field).into_iter().map(|inputs| few_stations(&inputs));
            few.map(|inputs| (model::solve(&inputs, all), inputs)).collect::<Vec<_>>()
        };
        let after: Vec<_> = (0..FIELDS.len()).map(after).collect();
        let few = few_stations(&solved.inputs);
        for quantity in listing() {
            let Some(own) = value_of(quantity, &few) else {
                continue;
            };
            let listed: Vec<usize> =
                fields_of(quantity, &solved.case, (&few, Some(own)), &|_, _| true)
                    .into_iter()
                    .map(|dependence| dependence.field)
                    .collect();
            // A later stage than that of the quantity may refuse the pair.
            let value = |(found, inputs): &(Result<Solution, _>, Inputs)| match found {
                Ok(solution) => finite(quantity, solution),
                Err(_) => value_of(quantity, inputs),
            };
            let is_moved = |found: f64| (found - own).abs() > ROUNDING * own.abs();
            // The list excludes fields replaced by their alternative, such as torque by power.
            let is_missing =
                |field: &usize| !listed.contains(field) && !solved.case.is_replaced(*field);
            for field in (0..FIELDS.len()).filter(is_missing) {
                if after[field].iter().filter_map(value).any(is_moved) {
                    missing.insert(format!(
                        "{}: {}, {}",
                        quantity.key, FIELDS[field].key, solved.name
                    ));
                }
            }
        }
    }
    assert!(missing.is_empty(), "{missing:#?}");
}

#[test]
fn a_quantity_lists_no_field_without_effect() {
    let listed = |key: &str, case: &Case| {
        let quantity = Quantity::find(key).unwrap();
        let inputs = case.inputs().unwrap();
        let found = fields_of(quantity, case, (&inputs, value_of(quantity, &inputs)), &|_, _| true);
        let keys = found.iter().map(|dependence| FIELDS[dependence.field].key);
        keys.collect::<Vec<_>>()
    };
    let mut case = Case::table_1();
    let base_pitch = ["pair.module", "pair.pressure_angle", "pair.helix_angle", "model.accurate"];
    assert_eq!(listed("base_pitch", &case), base_pitch);
    // The case of Table 1 gives the deflection, which then needs no load and no stiffness.
    for key in ["operation.power", "driver.young", "model.tooth_compliance"] {
        assert!(!listed("approach_angle_driven", &case).contains(&key), "{key}");
    }
    case.set("model.deflection", "").unwrap();
    for key in ["operation.power", "driver.young", "model.tooth_compliance"] {
        assert!(listed("approach_angle_driven", &case).contains(&key), "{key}");
    }
    // Other gears do not fit a given centre distance, but the contact ratio depends on their
    // fields.
    let mut fixed = Case::table_1();
    fixed.set("pair.centre_distance", "100.2 mm").unwrap();
    assert!(listed("contact_ratio", &fixed).contains(&"driver.teeth"));
    assert!(!listed("centre_distance", &fixed).contains(&"driver.teeth"));
    // A field that the case does not give.
    assert!(listed("contact_ratio", &case).contains(&"pair.centre_distance"));
}

#[test]
fn a_stage_reads_only_its_own_fields() {
    let inputs = Case::table_1().inputs().unwrap();
    let stages = |key: &str| stages_of(index_of(key).unwrap(), &inputs);
    assert_eq!(stages("driver.density"), Stages::NONE.with(Stage::Masses));
    // The case of Table 1 gives the deflection, so that load and stiffness do not change D.
    assert_eq!(stages("operation.power"), Stages::NONE.with(Stage::Load));
    assert!(!stages("driver.young").has(Stage::Deviation));
    let computed = Inputs { deflection: None, ..inputs.clone() };
    assert!(stages_of(index_of("driver.young").unwrap(), &computed).has(Stage::Deviation));
    for silent in ["title", "notes", "operation.friction_coefficient"] {
        assert_eq!(stages(silent), Stages::NONE, "{silent}");
    }
    assert_eq!(stages("model.stations"), Stages::NONE.with(Stage::Stations));
}
