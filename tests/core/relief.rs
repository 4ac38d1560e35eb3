//! The tip relief to specify, against whole solves and against every relief of a grid.
use tipstrike::case::Document;
use tipstrike::model::inputs::{Drive, Gear, Method, ReliefShape, ToothCompliance};
use tipstrike::model::{Inputs, Outcome, Solution, Stage, Stages, solve};
use tipstrike::study::relief::{AMOUNT_STEP, Demand, NoRelief, Specification, TipReliefs, specify};

fn inputs(path: &str) -> Inputs {
    let path = format!("{}/{path}.toml", env!("CARGO_MANIFEST_DIR"));
    let document = Document::read(path.as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let inputs = document.case.inputs().expect("a valid case");
    Inputs {
        method: Method::Static,
        ..inputs
    }
}

fn specified(inputs: &Inputs, demand: &Demand) -> Specification {
    specify(inputs, demand, &|_| true).unwrap_or_else(|none| panic!("{none}"))
}

fn with(inputs: &Inputs, reliefs: &TipReliefs, off: [f64; 2], load: f64) -> Inputs {
    let gear = |gear: &Gear, at: usize| Gear {
        tip_relief: (reliefs.amounts[at] + off[at]).max(0.0),
        tip_relief_length: Some(reliefs.lengths[at]),
        ..gear.clone()
    };
    Inputs {
        driver: gear(&inputs.driver, 0),
        driven: gear(&inputs.driven, 1),
        relief_shape: reliefs.shape,
        drive: Drive::Torque(load * inputs.torque()),
        ..inputs.clone()
    }
}

fn solved(inputs: &Inputs) -> Solution {
    let stages = Stages::of(Stage::Static).and(Stages::of(Stage::StaticSpectrum));
    solve(inputs, stages).unwrap_or_else(|refusal| panic!("{refusal}"))
}

/// Whether no tip touches off the path of contact with each relief off by the tolerance.
fn clears(inputs: &Inputs, demand: &Demand, reliefs: &TipReliefs) -> bool {
    let both = [-demand.tolerance, demand.tolerance];
    both.into_iter().all(|one| {
        both.into_iter().all(|other| {
            let solution = solved(&with(inputs, reliefs, [one, other], demand.loads.1));
            let found = solution.static_load.unwrap();
            solution.outcome == Outcome::NoCornerContact && found.last_contact_angle.is_none()
        })
    })
}

/// The greatest peak-to-peak transmission error over the ends and the middle of the loads.
fn error(inputs: &Inputs, loads: &[f64], reliefs: &TipReliefs) -> f64 {
    let of = |&load: &f64| {
        let solution = solved(&with(inputs, reliefs, [0.0; 2], load));
        solution
            .static_spectrum
            .unwrap()
            .unwrap()
            .spectrum
            .peak_to_peak
    };
    loads.iter().map(of).fold(0.0, f64::max)
}

const DEMAND: Demand = Demand {
    loads: (0.25, 1.1),
    tolerance: 3e-6,
};

/// Pairs whose teeth are independent springs, so that whole solves are quick.
fn pairs() -> [(&'static str, Inputs); 3] {
    [
        "tests/validation/dias-27-35",
        "cases/zhou-chen-2014",
        "cases/fzg-type-c",
    ]
    .map(|path| {
        let inputs = Inputs {
            tooth_compliance: Some(ToothCompliance::KUANG_YANG),
            stations: Some(4),
            ..inputs(path)
        };
        (path, inputs)
    })
}

#[test]
fn whole_solves_find_the_figures_of_the_relief_and_no_corner_contact() {
    for (name, inputs) in pairs() {
        let found = specified(&inputs, &DEMAND);
        let chosen = found.chosen();
        assert!(clears(&inputs, &DEMAND, &chosen.reliefs), "{name}");
        assert!(chosen.margin >= 0.0 && found.greatest_load >= DEMAND.loads.1);
        let beyond = Demand {
            loads: (1.0, 1.02 * found.greatest_load),
            ..DEMAND
        };
        let is_clear = clears(&inputs, &beyond, &chosen.reliefs);
        assert!(!is_clear || found.greatest_load > 3.0, "{name}");
        let own = error(&inputs, &found.loads, &chosen.reliefs);
        assert!((own / chosen.greatest_error() - 1.0).abs() < 1e-9, "{name}");
        for (amount, length) in chosen.reliefs.amounts.iter().zip(chosen.reliefs.lengths) {
            let steps = amount / AMOUNT_STEP;
            assert!((steps - steps.round()).abs() < 1e-6 && length > 0.0);
        }
    }
}

/// Every relief of a grid around the amounts of the answer and over all lengths: none that clears
/// has a smaller transmission error, but for what round figures cost.
#[test]
fn no_relief_of_a_grid_is_better() {
    const ROUND: f64 = 0.97;
    for (name, inputs) in pairs() {
        let found = specified(&inputs, &DEMAND);
        let chosen = found.chosen();
        let loads = [found.loads[0], found.loads[2], found.loads[5]];
        let own = chosen.greatest_error();
        let longest = found.map.last().unwrap()[0].reliefs.lengths;
        let longest = longest[0].max(longest[1]);
        let mut tried = 0;
        for shape in [ReliefShape::Linear, ReliefShape::Parabolic] {
            for index in 0..400u32 {
                let digit = |place: u32, base: u32| f64::from(index / place % base);
                let amounts = [digit(1, 5), digit(5, 5)].map(|part| 0.86 + 0.06 * part);
                let lengths = [digit(25, 4), digit(100, 4)].map(|part| 0.31 + 0.23 * part);
                let reliefs = TipReliefs {
                    shape,
                    amounts: [
                        amounts[0] * chosen.reliefs.amounts[0],
                        amounts[1] * chosen.reliefs.amounts[1],
                    ],
                    lengths: lengths.map(|part| (part * longest).min(longest)),
                };
                // The cheaper test first.
                if error(&inputs, &loads[2..], &reliefs) >= ROUND * own
                    || error(&inputs, &loads[..2], &reliefs) >= ROUND * own
                {
                    continue;
                }
                tried += 1;
                assert!(
                    !clears(&inputs, &DEMAND, &reliefs),
                    "{name}: {reliefs:?} has {:e} m, the answer {own:e} m",
                    error(&inputs, &found.loads, &reliefs)
                );
            }
        }
        println!("{name}: {tried} with a smaller error do not clear");
    }
}

#[test]
fn a_relief_for_the_motion_has_no_corner_contact_in_motion() {
    let inputs = Inputs {
        method: Method::Dynamic,
        tooth_compliance: Some(ToothCompliance::KUANG_YANG),
        ..inputs("cases/fzg-type-c")
    };
    let found = specified(&inputs, &DEMAND);
    assert_eq!(found.method, Method::Dynamic);
    let worst = with(
        &inputs,
        &found.chosen().reliefs,
        [-DEMAND.tolerance; 2],
        1.1,
    );
    let solution = solve(&worst, Stages::of(Stage::Dynamic)).unwrap();
    assert_eq!(solution.outcome, Outcome::NoCornerContact);
    assert!(solution.dynamic.unwrap().last_contact_angle.is_none());
}

#[test]
fn where_auto_chooses_the_motion_the_relief_is_that_of_the_motion() {
    let (_, zhou_chen) = &pairs()[1];
    let by = |method| {
        let inputs = Inputs {
            method,
            within: 0.05,
            ..zhou_chen.clone()
        };
        specify(&inputs, &DEMAND, &|_| true)
    };
    let (chosen, motion) = (by(Method::Auto), by(Method::Dynamic));
    assert_eq!(chosen, motion);
    assert_eq!(motion.unwrap().method, Method::Dynamic);
}

#[test]
fn where_no_relief_serves_the_reason_is_given() {
    let (_, dias) = &pairs()[0];
    let none = |inputs: &Inputs, loads| {
        let demand = Demand {
            loads,
            tolerance: 3e-6,
        };
        specify(inputs, &demand, &|_| true).unwrap_err()
    };
    let mut pointed = dias.clone();
    (pointed.driver.addendum, pointed.driven.addendum) = (1.3, 1.3);
    (pointed.driver.dedendum, pointed.driven.dedendum) = (1.5, 1.5);
    (pointed.driver.profile_shift, pointed.driven.profile_shift) = (0.45, 0.45);
    let refusal = none(&pointed, (0.25, 8.0));
    assert!(matches!(refusal, NoRelief::ThinTip { .. }), "{refusal}");
    let mut short = dias.clone();
    (short.driver.addendum, short.driven.addendum) = (0.59, 0.59);
    let refusal = none(&short, (0.25, 1.1));
    assert!(matches!(refusal, NoRelief::ShortPath { .. }), "{refusal}");
    assert!(refusal.to_string().contains("contact ratio"), "{refusal}");
}

/// The source chooses 43.58 um on both gears, the deflection of its own teeth at 353.2 N/um. Kuang
/// and Yang's teeth are stiffer; under as much more load they deflect as far and need the same
/// relief.
#[test]
fn at_the_deflection_of_the_source_the_pair_of_dias_needs_the_published_relief() {
    const PUBLISHED: [f64; 2] = [353.2e6, 43.58e-6];
    let (_, dias) = pairs().into_iter().next().unwrap();
    let load = solved(&dias).mesh.unwrap().mean_stiffness / PUBLISHED[0];
    let demand = Demand {
        loads: (load, load),
        tolerance: 0.0,
    };
    let found = specified(&dias, &demand);
    let chosen = found.chosen();
    let amount = chosen.reliefs.amounts[0].min(chosen.reliefs.amounts[1]);
    let needed = amount - chosen.margin;
    assert!((needed - PUBLISHED[1]).abs() < 1e-6, "{needed:e}");
}

#[test]
fn a_search_ends_where_its_user_stops_it() {
    let (_, dias) = &pairs()[0];
    let stopped = specify(dias, &DEMAND, &|_| false).unwrap_err();
    assert_eq!(
        stopped,
        NoRelief::Refused(tipstrike::model::Refusal::Stopped)
    );
}
