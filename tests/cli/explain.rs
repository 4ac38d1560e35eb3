//! Every quantity has an explanation, and the printed numbers of the explanation are correct.

mod formula;

use formula::{evaluate, factor, formula_value};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;
use tipstrike::case::{Case, EXAMPLES};
use tipstrike::model::{Inputs, QUANTITIES, Quantity, Solution, Stage, Stages, solve};
use tipstrike::report::explain::{CORRECTIONS, How, Page, Work, explain, lines, render};

type Settings = &'static [(&'static str, &'static str)];

/// Settings for which a case has other formulas.
const VARIANTS: [Settings; 11] = [
    &[],
    &[("model.method", "static")],
    &[("model.method", "dynamic")],
    &[("model.method", "paper")],
    &[("model.deflection", "")],
    &[
        ("model.tooth_compliance", "beam"),
        ("model.contact_compliance", "weber"),
        ("model.deflection", ""),
    ],
    &[
        ("model.contact_compliance", "constant"),
        ("driven.tip_radius", "0.3 mm"),
        ("model.accurate", "true"),
    ],
    &[
        ("operation.torque", "40 lbf ft"),
        ("driven.tip_relief", "2 um"),
        ("deviations.backlash", "1 um"),
    ],
    &[
        ("operation.speed", "1.5 rad/s"),
        ("operation.friction_coefficient", "0.07"),
        ("driven.tip_chamfer", "0.01 in"),
    ],
    &[
        ("deviations.base_pitch", "-0.3 um"),
        ("driver.profile_shift", "-0.02"),
        ("model.method", "paper"),
    ],
    &[("pair.helix_angle", "12 deg"), ("pair.driver_hand", "left"), ("model.method", "exact")],
];

struct Explained {
    name: String,
    pages: Vec<Page>,
}

fn cases() -> Vec<(String, Case)> {
    let case = |name: &str| format!("cases/{name}.toml");
    EXAMPLES.iter().map(|example| (case(example.name), example.document().case)).collect()
}

/// The pages of a case with settings, by `page`; none if the model refuses the case.
fn explained(
    name: &str,
    case: &Case,
    settings: &[(&str, &str)],
    page: impl Fn(&'static Quantity, &Case, &Inputs, &Solution) -> Option<Page>,
) -> Option<Explained> {
    let mut case = case.clone();
    for (key, value) in settings {
        case.set(key, value).unwrap();
    }
    let inputs = case.inputs().unwrap();
    let stages = Stages::EVERY.without(Stage::SpeedRun).without(Stage::SteadyMotion);
    let solution = solve(&inputs, stages).ok()?;
    let pages = QUANTITIES.iter().filter_map(|quantity| page(quantity, &case, &inputs, &solution));
    Some(Explained { name: format!("{name} {settings:?}"), pages: pages.collect() })
}

/// Every case with every variant, without accuracy and effects.
static DERIVED: LazyLock<Vec<Explained>> = LazyLock::new(|| {
    let derived = |(name, case): (String, Case)| {
        let variants = VARIANTS.iter();
        let pages = variants.filter_map(move |settings| {
            explained(&name, &case, settings, |quantity, case, inputs, solution| {
                Some(explain(quantity, case, inputs, solution, &|_, _| false))
            })
        });
        pages.collect::<Vec<_>>()
    };
    cases().into_iter().flat_map(derived).collect()
});

/// The whole pages of some cases.
static WHOLE: LazyLock<Vec<Explained>> = LazyLock::new(|| {
    let shared = |method: &'static str| {
        let page = move |quantity: &'static Quantity,
                         case: &Case,
                         inputs: &Inputs,
                         solution: &Solution| {
            let is_own = match quantity.stage {
                Stage::Mesh | Stage::Static => method == "static",
                Stage::Dynamic => quantity.key.contains("first_contact"),
                _ => false,
            };
            is_own.then(|| explain(quantity, case, inputs, solution, &|_, _| true))
        };
        explained("cases/zhou.toml", &Case::table_1(), &[("model.method", method)], page)
    };
    let is_closed = |settings: &&Settings| {
        let sets = |name: &str| settings.iter().any(|(key, value)| [*key, *value].contains(&name));
        !["pair.helix_angle", "static", "dynamic"].into_iter().any(sets)
    };
    let closed = VARIANTS.iter().filter(is_closed).filter_map(|settings| {
        let page =
            |quantity: &'static Quantity, case: &Case, inputs: &Inputs, solution: &Solution| {
                let is_closed = Stages::CLOSED_FORM.has(quantity.stage);
                is_closed.then(|| explain(quantity, case, inputs, solution, &|_, _| true))
            };
        let mut case = Case::table_1();
        case.set("model.tooth_compliance", "beam").unwrap();
        explained("cases/zhou.toml", &case, settings, page)
    });
    closed.chain(shared("static")).chain(shared("dynamic")).collect()
});

fn every_page(cases: &[Explained], mut look: impl FnMut(&str, &Page)) {
    for case in cases {
        case.pages.iter().for_each(|page| look(&case.name, page));
    }
}

fn page(case: &str, key: &str, settings: &[(&str, &str)]) -> Page {
    let (name, case) = cases().into_iter().find(|(name, _)| name.contains(case)).unwrap();
    let case = explained(&name, &case, settings, |quantity, case, inputs, solution| {
        (quantity.key == key).then(|| explain(quantity, case, inputs, solution, &|_, _| true))
    });
    let case = case.unwrap();
    case.pages.into_iter().next().unwrap()
}

/// One unit of the last printed digit of a value, in the printed unit.
fn last_place(work: &Work) -> f64 {
    let shown: f64 = work.shown.as_ref().unwrap().number.parse().unwrap();
    let magnitude = format!("{shown:e}").split('e').nth(1).unwrap().to_owned();
    let digits = i32::try_from(work.digits).unwrap();
    10f64.powi(magnitude.parse::<i32>().unwrap() + 1 - digits)
}

/// The printed value after the last equals sign, and the value that the numbers before it give.
fn printed(work: &Work) -> Option<(f64, f64)> {
    let (numbers, shown) = (work.numbers.as_ref()?, work.shown.as_ref()?);
    let unit = factor(shown.unit).unwrap_or_else(|| panic!("{shown}"));
    Some((shown.number.parse().unwrap(), evaluate(numbers) / unit))
}

#[test]
fn the_printed_numbers_make_the_printed_value() {
    let mut checked = 0;
    every_page(&DERIVED, |name, page| {
        for work in &page.derivation {
            let Some((shown, found)) = printed(work) else { continue };
            // The terms of a difference of close numbers have ten digits.
            let lost = if work.formula.contains(" - ") { 1e-4 } else { 0.0 };
            let agree = (found - shown).abs() <= last_place(work).max(lost * shown.abs());
            assert!(agree, "{name} {} {} {:?}", page.quantity.key, work.symbol, work.numbers);
            checked += 1;
        }
    });
    assert!(checked > 10_000, "{checked}");
}

#[test]
fn every_formula_gives_the_value_of_the_solver() {
    let (mut checked, mut wrong) = (0, BTreeMap::new());
    every_page(&DERIVED, |name, page| {
        let steps = page.derivation.iter().map(|work| (work.symbol, work.value));
        let leaves = page.leaves.iter().map(|leaf| (leaf.symbol, leaf.value));
        let values: BTreeMap<&str, f64> =
            steps.chain(leaves).filter_map(|(symbol, value)| Some((symbol, value?))).collect();
        for work in page.derivation.iter().filter(|work| work.how == How::Equals) {
            let Some(value) = work.value else { continue };
            let found = formula_value(&work.formula, &|symbol| values.get(symbol).copied());
            let is_right = |found: f64| (found - value).abs() <= 1e-6 * value.abs() + 1e-18;
            if !found.is_some_and(is_right) {
                let formula = format!("{}: {} = {}", page.quantity.key, work.symbol, work.formula);
                wrong.entry(formula).or_insert((name.to_owned(), found, value));
            }
            checked += 1;
        }
    });
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(checked > 20_000, "{checked}");
}

#[test]
fn every_value_with_a_formula_is_shown_with_its_numbers() {
    let mut wrong = BTreeMap::new();
    every_page(&DERIVED, |name, page| {
        for work in page.derivation.iter().filter(|work| work.shown.is_some()) {
            let is_right = match work.how {
                How::Equals => work.numbers.is_some(),
                How::Solves => {
                    work.residual.as_deref() == Some("both sides agree within 1e-12 of either")
                }
                How::Described => true,
            };
            if !is_right {
                let formula = format!("{}: {} = {}", page.quantity.key, work.symbol, work.formula);
                wrong.entry(formula).or_insert((name.to_owned(), work.residual.clone()));
            }
        }
    });
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_quantity_is_explained_in_all_its_parts() {
    every_page(&WHOLE, |name, page| {
        let key = page.quantity.key;
        let parts = [page.meaning.as_str(), page.source, page.assumptions.as_str()];
        assert!(parts.iter().all(|part| part.ends_with('.')), "{key}");
        assert_eq!(page.derivation.first().map(|work| work.symbol), Some(page.symbol), "{key}");
        assert_eq!(page.value.is_some(), page.missing.is_none(), "{name}, {key}");
        assert_eq!(page.value.is_some(), !page.accuracy.is_empty(), "{name}, {key}");
        assert!(page.missing.is_some() || !page.effects.is_empty(), "{name}, {key}");
        let given = page.derivation[0].how == How::Described;
        let sides = !page.derivation[0].formula.is_empty()
            && (given || page.derivation.len() + page.leaves.len() > 1);
        assert!(sides, "{name}, {key}");
    });
}

#[test]
fn every_equation_that_is_cited_is_one() {
    let mut cited_errors = BTreeSet::new();
    every_page(&DERIVED, |_, page| {
        cited_errors.extend(page.corrections.iter().map(|row| row.equation));
        let equation = page.quantity.equation;
        let cited = [page.source, &page.meaning, &page.assumptions];
        let named = if let [number] = equations(equation)[..] {
            equations(page.source).contains(&number)
        } else {
            let head = equation.split(' ').next().unwrap();
            equation == "by the method" || cited.iter().any(|part| part.contains(head))
        };
        assert!(named, "{}: {equation} in {}", page.quantity.key, page.source);
        for text in cited {
            assert!(equations(text).iter().all(|number| (1..=64).contains(number)), "{text}");
        }
    });
    let table: BTreeSet<&str> = CORRECTIONS.iter().map(|row| row.equation).collect();
    assert_eq!(cited_errors, table);
    for row in CORRECTIONS {
        let known = equations(row.equation).iter().all(|number| (1..=64).contains(number));
        assert!(known && !row.error.is_empty() && !row.used.is_empty(), "{}", row.equation);
    }
}

/// The numbers after every "Eq." and "Eqs." of a text, with ranges expanded.
fn equations(text: &str) -> Vec<u32> {
    let lists = text
        .match_indices("Eq")
        .filter_map(|(at, _)| text[at + 2..].trim_start_matches('s').strip_prefix(". "));
    let end = |rest: &str| {
        rest.find(|c: char| !c.is_ascii_digit() && !"-, and".contains(c)).unwrap_or(rest.len())
    };
    let words =
        lists.flat_map(|rest| rest[..end(rest)].split([',', ' ']).filter(|word| !word.is_empty()));
    words.filter_map(span).flatten().collect()
}

/// The numbers of "7" or of "7-20".
fn span(word: &str) -> Option<std::ops::RangeInclusive<u32>> {
    let (from, to) = word.split_once('-').unwrap_or((word, word));
    Some(from.parse().ok()?..=to.parse().ok()?)
}

#[test]
fn no_line_is_wider_than_asked_for() {
    every_page(&WHOLE, |name, page| {
        let case = name.split(' ').next().unwrap_or(name);
        for width in [38, 58, 80, 100] {
            let lines = lines(page, case, width);
            let wide = lines.iter().find(|line| line.text.chars().count() > width);
            assert_eq!(wide, None, "{width}, {name}, {}", page.quantity.key);
        }
    });
}

#[test]
fn a_step_of_a_field_changes_the_result_as_a_solve_does() {
    let page = page("zhou", "impact_force", &[]);
    let of = |key: &str| page.effects.iter().find(|effect| effect.key == key).unwrap();
    let settings = [("deviations.base_pitch", "17 um")];
    let more = explained("", &Case::table_1(), &settings, |quantity, case, inputs, solution| {
        (quantity.key == "impact_force")
            .then(|| explain(quantity, case, inputs, solution, &|_, _| false))
    });
    let force = more.unwrap().pages[0].value.unwrap();
    let share = 100.0 * (force / page.value.unwrap() - 1.0);
    assert_eq!(of("deviations.base_pitch").change, format!("+{share:.2} %"));
    assert_eq!(of("deviations.base_pitch").text, "16 um");
    assert_eq!((of("model.method").step.as_str(), of("model.method").change.as_str()), ("", ""));
    assert!(page.effects.iter().all(|effect| !["title", "operation.torque", "driver.tip_relief"].contains(&effect.key)));
}

#[test]
fn an_absent_quantity_has_a_reason() {
    let relieved = page("tip-relief-enough", "impact_force", &[]);
    assert!(relieved.missing.unwrap().starts_with("No value: no corner contact"));
    let withheld =
        page("zhou", "impact_force", &[("driver.teeth", "120"), ("driven.teeth", "120")]);
    assert!(withheld.missing.unwrap().contains("outside the Kuang-Yang fit"));
}

#[test]
fn pages_read_as_they_did() {
    let samples: [(&str, &str, Settings); 6] = [
        ("zhou", "impact_force", &[]),
        ("zhou", "approach_angle_driver", &[("model.method", "paper")]),
        ("zhou", "friction_ratio", &[("model.method", "paper")]),
        ("fzg", "pair_compliance", &[]),
        ("mill", "working_pressure_angle", &[]),
        ("tip-relief", "normal_velocity", &[]),
    ];
    for (case, key, settings) in samples {
        let method = settings.first().map(|(_, method)| format!("_{method}")).unwrap_or_default();
        let page = render(&page(case, key, settings), case);
        insta::assert_snapshot!(format!("{case}_{key}{method}"), page);
    }
}
