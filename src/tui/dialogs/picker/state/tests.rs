//! Tests of the order of matches in lists.

use super::*;

fn first(list: List, typed: &str) -> Option<String> {
    let picker = Picker { input: typed.into(), ..Picker::new(list) };
    picker.fitting().into_iter().next().map(|item| item.name)
}

#[test]
fn a_few_letters_find_the_command() {
    for (typed, name) in [
        ("und", "undo"),
        ("save a", "save as"),
        ("base", "baseline"),
        ("themme", "theme"),
        ("colours", "theme"),
    ] {
        assert_eq!(first(List::Commands, typed).as_deref(), Some(name), "{typed}");
    }
    for (typed, name) in [
        ("next tab", "next case"),
        ("switch", "switch"),
        ("compare", "baseline"),
        ("static", "method static"),
        ("dynamic", "method dynamic"),
        ("method", "method"),
    ] {
        let results = QUANTITIES.iter().map(|quantity| quantity.key).collect();
        let picker = Picker {
            input: typed.into(),
            ..Picker::over(
                List::Commands,
                Context { results, are_results_first: true, ..Context::default() },
            )
        };
        let found = picker.fitting().into_iter().take(3).map(|item| item.name).collect::<Vec<_>>();
        assert!(found.contains(&name.to_owned()), "{typed}: {found:?}");
    }
    assert_eq!(first(List::Commands, "xyzzy"), None);
}

#[test]
fn a_field_is_found_by_key_label_and_symbol() {
    for (typed, key) in [
        ("speed", "operation.speed"),
        ("driven face", "driven.face_width"),
        ("rho2", "driven.density"),
        ("backl", "deviations.backlash"),
        ("ca1", "driver.tip_relief"),
    ] {
        assert_eq!(first(List::Places, typed).as_deref(), Some(key), "{typed}");
    }
}

#[test]
fn fields_with_effect_come_first_unless_a_symbol_is_typed() {
    let idle: Vec<_> =
        (0..FIELDS.len()).filter(|&at| FIELDS[at].key.starts_with("driver.tip_relief")).collect();
    for (typed, key) in [
        ("relief", "driven.tip_relief"),
        ("tip relief", "driven.tip_relief"),
        ("driver tip relief", "driver.tip_relief"),
        ("ca1", "driver.tip_relief"),
    ] {
        let picker = Picker {
            input: typed.into(),
            ..Picker::over(List::Places, Context { idle: idle.clone(), ..Context::default() })
        };
        assert_eq!(picker.fitting()[0].name, key, "{typed}");
    }
}

#[test]
fn a_field_comes_before_a_result_with_a_longer_name() {
    for are_results_first in [false, true] {
        let context = Context {
            results: QUANTITIES.iter().map(|quantity| quantity.key).collect(),
            are_results_first,
            ..Context::default()
        };
        for (typed, name) in [
            ("tip rel", "driven.tip_relief"),
            ("impact force", "impact_force"),
            (
                "combined deflection",
                ["model.deflection", "combined_deflection"][usize::from(are_results_first)],
            ),
        ] {
            for list in [List::Commands, List::Places] {
                let picker = Picker { input: typed.into(), ..Picker::over(list, context.clone()) };
                assert_eq!(picker.fitting()[0].name, name, "{typed}");
            }
        }
    }
}

#[test]
fn a_typed_key_is_the_first_match() {
    let fields = FIELDS.iter().map(|field| field.key);
    let results: Vec<_> = QUANTITIES.iter().map(|quantity| quantity.key).collect();
    for are_results_first in [false, true] {
        let context = Context {
            results: results.clone(),
            are_results_first,
            idle: (0..FIELDS.len()).collect(),
            ..Context::default()
        };
        for key in fields.clone().chain(results.iter().copied()) {
            let picker =
                Picker { input: key.into(), ..Picker::over(List::Places, context.clone()) };
            assert_eq!(picker.fitting()[0].name, key);
        }
    }
}

#[test]
fn a_list_of_fields_names_the_gear() {
    let items = Picker::new(List::Places).fitting();
    for gear in ["driver", "driven"] {
        let own = items.iter().filter(|item| item.name.starts_with(gear));
        assert!(own.clone().count() > 10);
        for item in own {
            let (_, label) = item.about.split_once(' ').unwrap();
            assert!(label.starts_with(&format!("{gear} ")), "{}", item.about);
        }
    }
}

#[test]
fn an_empty_filter_shows_the_whole_list() {
    let all = Picker::new(List::Commands).fitting();
    let charts = GRAPHS.len() + WorkerChart::ALL.len();
    assert_eq!(all.len(), commands::commands().count() + charts);
    assert_eq!(Picker::new(List::Places).fitting().len(), FIELDS.len());
}
