//! Tests of the table of commands and of the lists.

use crossterm::event::KeyCode;
use ratatui::layout::Size;

use super::*;
use crate::tui::settings::Look;
use crate::tui::store;
use crate::tui::update::opened;

#[test]
fn no_key_has_two_meanings_in_a_place() {
    for (index, binding) in BINDINGS.iter().enumerate() {
        for other in &BINDINGS[index + 1..] {
            let mut parts = binding.keys.split([' ', '/']);
            let shared = parts.find(|key| !key.is_empty() && other.way(key).is_some());
            assert!(
                !binding.places.meets(other.places) || shared.is_none(),
                "{shared:?}: {}",
                binding.sentence
            );
        }
    }
}

/// Letters with similar meanings in several panes: move, more or less, start again, other view, copy.
const ALIKE: &str = "hjklHLgG+=-0vy";

#[test]
fn a_letter_has_one_meaning_in_all_panes() {
    for letter in ('!'..='~').filter(|letter| !ALIKE.contains(*letter)) {
        let key = letter.to_string();
        let bound = BINDINGS
            .iter()
            .filter(|one| one.places.meets(Place::OUTSIDE) && one.way(&key).is_some());
        let mut commands: Vec<_> = bound.map(|one| one.sentence).collect();
        commands.dedup();
        assert!(commands.len() <= 1, "{letter}: {commands:?}");
    }
}

#[test]
fn the_letters_that_move_do_so_in_every_pane() {
    for place in [
        Place::FIELD,
        Place::RESULTS,
        Place::CHART,
        Place::TEETH,
        Place::TRADE,
        Place::STUDY,
        Place::TOLERANCE,
    ] {
        for (letter, arrow) in [("h", "Left"), ("j", "Down"), ("k", "Up"), ("l", "Right")] {
            let meant = |key| called(key, place).map(|(binding, way)| (binding.sentence, way));
            let moved = meant(letter);
            assert!(moved.is_some(), "{letter} in {place:?}");
            assert_eq!(moved, meant(arrow), "{letter} in {place:?}");
        }
    }
}

#[test]
fn one_name_has_one_sentence() {
    for binding in BINDINGS.iter().filter(|binding| is_listed(binding)) {
        assert!(named(binding.name).all(|other| other.sentence == binding.sentence));
    }
}

fn plain(letter: char) -> KeyEvent {
    KeyCode::Char(letter).into()
}

#[test]
fn letters_are_text_and_not_commands_inside_a_field() {
    for letter in ('a'..='z').chain(['?', ' ', 'Q', ':', '/', '1']) {
        for place in [Place::TEXT, Place::PATH, Place::PICK] {
            assert!(
                matches!(of_key(plain(letter), place), Some(Action::Insert(typed)) if typed == letter),
                "{letter}"
            );
        }
    }
}

#[test]
fn outside_a_field_no_letter_is_text() {
    let panes = Pane::ALL.map(Pane::place);
    for place in panes.into_iter().chain([Place::TOLERANCE, Place::OWN_CHART, Place::READ]) {
        for letter in '!'..='~' {
            assert!(!matches!(of_key(plain(letter), place), Some(Action::Insert(_))));
        }
    }
}

type List = fn(&Context) -> Picker;

fn commands() -> Vec<Item> {
    items(&opened(store::built_in(), None, Look::FULL, Size::new(80, 24)))
}

const PALETTE: List = |context| context.palette(commands());

fn found(list: List, context: &Context, typed: &str) -> Vec<String> {
    let mut picker = list(context);
    picker.input = typed.into();
    picker.fitting().into_iter().map(|item| item.name.clone()).collect()
}

fn first(list: List, typed: &str) -> Option<String> {
    found(list, &Context::default(), typed).into_iter().next()
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
        assert_eq!(first(PALETTE, typed).as_deref(), Some(name), "{typed}");
    }
    for (typed, name) in [
        ("next tab", "next case"),
        ("switch", "switch"),
        ("compare", "baseline"),
        ("static", "method static"),
        ("dynamic", "method dynamic"),
        ("method", "method"),
    ] {
        let results = QUANTITIES.iter().map(|quantity| (quantity, None)).collect();
        let context = Context { results, are_results_first: true, ..Context::default() };
        let found = found(PALETTE, &context, typed);
        assert!(found.iter().take(3).any(|one| one == name), "{typed}: {found:?}");
    }
    assert_eq!(first(PALETTE, "xyzzy"), None);
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
        assert_eq!(first(Context::search, typed).as_deref(), Some(key), "{typed}");
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
        let context = Context { idle: idle.clone(), ..Context::default() };
        assert_eq!(found(Context::search, &context, typed)[0], key, "{typed}");
    }
}

#[test]
fn a_field_comes_before_a_result_with_a_longer_name() {
    for are_results_first in [false, true] {
        let context = Context {
            results: QUANTITIES.iter().map(|quantity| (quantity, None)).collect(),
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
            for list in [PALETTE, Context::search] {
                assert_eq!(found(list, &context, typed)[0], name, "{typed}");
            }
        }
    }
}

#[test]
fn a_typed_key_is_the_first_match() {
    let fields = FIELDS.iter().map(|field| field.key);
    let results: Vec<_> = QUANTITIES.iter().map(|quantity| (quantity, None)).collect();
    for are_results_first in [false, true] {
        let context = Context {
            results: results.clone(),
            are_results_first,
            idle: (0..FIELDS.len()).collect(),
        };
        for key in fields.clone().chain(QUANTITIES.iter().map(|quantity| quantity.key)) {
            assert_eq!(found(Context::search, &context, key)[0], key);
        }
    }
}

#[test]
fn a_list_of_fields_names_the_gear() {
    let items = Context::default().search().fitting();
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
    let all = PALETTE(&Context::default()).fitting();
    let charts = GRAPHS.len() + OwnChart::ALL.len();
    assert_eq!(all.len(), commands().len() + charts);
    assert_eq!(Context::default().search().fitting().len(), FIELDS.len());
}
