//! The teeth pane: snapshots, keys, and properties over pairs, zooms, angles, sizes and terminals.
#[allow(dead_code, reason = "each test file uses its own part")]
use crate::envelope::{Corner, Random, pair};

use crate::harness::{Desk, LARGE, SMALL};

use std::path::Path;

use insta::assert_snapshot;
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::symbols::Marker;
use tipstrike::case::Document;
use tipstrike::case::units::System;
use tipstrike::model::inputs::{Method, ToothCompliance};
use tipstrike::model::{self, Inputs, Solution, Stage, Stages, contact_state};
use tipstrike::tui::testing::{Action, Centre, Look, MONO, Picture, TeethView, ascii, teeth};

const ASCII: Look = Look { theme: &MONO, ascii: true };

fn solved(case: &str) -> (Inputs, Solution) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(case);
    let inputs = Document::read(&path).unwrap().case.inputs().unwrap();
    let solution = model::solve(&inputs, Stages::ALL).unwrap();
    (inputs, solution)
}

fn picture<'a>(
    (inputs, solution): &'a (Inputs, Solution),
    view: &'a TeethView,
    part: f64,
) -> Picture<'a> {
    let cursor = solution.position.map(|position| part * position.approach_angle_driver);
    Picture {
        inputs,
        solution,
        cursor,
        z: 0.0,
        view,
        look: Look::FULL,
        marker: Marker::Braille,
        units: System::Metric,
        is_stale: false,
    }
}

fn drawn(picture: &Picture, (width, height): (u16, u16)) -> Buffer {
    let area = Rect::new(0, 0, width, height);
    let mut buffer = Buffer::empty(area);
    teeth::draw(picture, area, &mut buffer);
    ascii::finish(&mut buffer, picture.look.ascii);
    buffer
}

fn screen(picture: &Picture, size: (u16, u16)) -> String {
    let buffer = drawn(picture, size);
    let rows = buffer.content.chunks(size.0.max(1).into());
    let text = |row: &[Cell]| row.iter().map(Cell::symbol).collect::<String>();
    rows.map(|row| text(row).trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_views_of_the_pair() {
    let table_1 = solved("zhou-chen-2014.toml");
    let turbo = solved("turbo-fine-fast.toml");
    for (name, pair, centre, part) in [
        ("before_d", &table_1, Centre::Strike, 1.5),
        ("path_of_contact", &table_1, Centre::PitchPoint, 1.0),
        ("whole_pair", &table_1, Centre::Pair, 1.0),
        ("whole_pair_of_fine_teeth", &turbo, Centre::Pair, 1.0),
    ] {
        let view = TeethView { centre, ..TeethView::default() };
        assert_snapshot!(name, screen(&picture(pair, &view, part), (100, 30)));
    }
}

#[test]
fn no_corner_contact_shows_the_flanks_apart() {
    let relieved = solved("tip-relief-enough.toml");
    let view = TeethView::default();
    assert_snapshot!("no_corner_contact", screen(&picture(&relieved, &view, 1.0), (100, 30)));
}

#[test]
fn other_markers_and_ascii_draw_the_same_picture() {
    let table_1 = solved("zhou-chen-2014.toml");
    let view = TeethView::default();
    let plain = picture(&table_1, &view, 1.5);
    let ascii = screen(&Picture { look: ASCII, ..plain }, (80, 24));
    assert!(ascii.is_ascii());
    assert_snapshot!("ascii", ascii);
    let half_block = Picture { marker: Marker::HalfBlock, ..plain };
    assert_snapshot!("half_block", screen(&half_block, (80, 24)));
}

#[test]
fn the_cursor_turns_the_gears_and_shows_the_values_of_the_solution() {
    let table_1 = solved("zhou-chen-2014.toml");
    let view = TeethView::default();
    let at_d = screen(&picture(&table_1, &view, 1.0), (140, 30));
    let (speeds, rest) = ("ΔV_n 0.82106 m/s, ΔV_τ 5.2227 m/s", "S 47.327 um, open 0 um");
    for values in ["1.3663 deg, O1J 47.891 mm, F_S 2191.0 N", speeds, rest] {
        assert!(values.split(", ").all(|value| at_d.contains(value)), "{values}\n{at_d}");
    }
    let without = Picture { cursor: None, ..picture(&table_1, &view, 1.0) };
    assert_eq!(screen(&without, (140, 30)), at_d, "without a cursor D is shown");
    let before = screen(&picture(&table_1, &view, 1.5), (140, 30));
    assert!(before.contains("F_S –") && before.contains("open 58.13 um"), "{before}");
    let rows_that_differ =
        at_d.lines().zip(before.lines()).filter(|(one, other)| one != other).count();
    assert!(rows_that_differ > 10, "the gears do not move");
}

#[test]
fn static_and_dynamic_show_their_own_first_contact_and_force() {
    for (method, angle_driven, expected) in
        [(Method::Static, "u_st", ["F ", "x "]), (Method::Dynamic, "u_d", ["t ", "F/ΣF "])]
    {
        let (mut inputs, _) = solved("zhou-chen-2014.toml");
        inputs.method = method;
        let solution = model::solve(&inputs, Stages::EVERY).unwrap();
        let (angle, solved) =
            (contact_state::first_contact(&solution).unwrap(), (inputs, solution));
        let view = TeethView::default();
        let at = |part: f64| {
            let cursor = Some(part * angle * solved.0.ratio());
            screen(&Picture { cursor, ..picture(&solved, &view, 1.0) }, (200, 40))
        };
        let exact = angle.to_degrees();
        let shown = format!("{angle_driven} {exact:.4}");
        assert!(at(1.0).contains(&shown), "{method:?} {exact} {}", at(1.0));
        for word in expected {
            let (inside, outside, none) = (at(0.5), at(1.5), format!("{word}–"));
            assert!(inside.contains(word) && !inside.contains(&none), "{method:?}\n{inside}");
            assert!(outside.contains(&none), "{method:?}\n{outside}");
        }
        for part in [3.0, 1.5, 0.9, 0.0, -5.0, -13.0, -20.0] {
            assert!(!at(part).contains("n/a"), "{}", at(part));
        }
    }
}

#[test]
fn the_factor_is_shown_and_decreases_to_one() {
    let table_1 = solved("zhou-chen-2014.toml");
    let shown = |view: TeethView| screen(&picture(&table_1, &view, 1.2), (100, 30));
    assert!(shown(TeethView::default()).contains("gap x20"));
    assert!(shown(TeethView { has_true_gap: true, ..TeethView::default() }).contains("gap x1"));
    assert!(
        shown(TeethView { zoom: 10, ..TeethView::default() }).contains("gap x1"),
        "a large gap is drawn true to scale"
    );
    let far = screen(&picture(&table_1, &TeethView::default(), 3.0), (100, 30));
    let number = |name: &str| -> f64 {
        let rest = far.split(name).nth(1).unwrap();
        rest.split_whitespace().next().unwrap().parse().unwrap()
    };
    let (factor, opening) = (number("gap x"), number("open "));
    assert!((factor * opening / 1500.0 - 1.0).abs() < 0.02, "{factor} {opening}");
}

#[test]
fn zoom_ends_at_the_whole_pair_and_at_a_micrometre() {
    let (inputs, solution) = solved("zhou-chen-2014.toml");
    for centre in [Centre::Strike, Centre::PitchPoint, Centre::Pair] {
        let view = TeethView { centre, ..TeethView::default() };
        let out = view.zoomed(-1000, &inputs, &solution);
        assert_eq!(out.zoomed(-1, &inputs, &solution), out);
        let extent = out.extent(&inputs, &solution);
        assert!((0.2..0.4).contains(&extent), "{centre:?}: {extent} m");
        let closest = view.zoomed(i32::MAX, &inputs, &solution);
        assert!(closest.extent(&inputs, &solution) < 1e-3, "{centre:?}");
        assert_eq!(closest.zoomed(-1, &inputs, &solution).zoom, closest.zoom - 1);
    }
}

#[test]
fn a_run_starts_before_d_and_ends_at_e() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "4", "z", "Space"]);
    desk.assert(desk.ticks && !desk.shows("open 0 um"));
    let mut screens = vec![desk.screen()];
    while desk.ticks {
        desk.act(Action::Tick);
        screens.push(desk.screen());
    }
    let closed = screens.iter().position(|screen| screen.contains("open 0 um")).expect("it closes");
    assert!((10..30).contains(&closed), "closed after {closed} of {} pictures", screens.len());
    assert!(screens[closed..].iter().all(|screen| screen.contains("open 0 um")));
    assert!(screens.windows(2).all(|pair| pair[0] != pair[1]), "a picture repeats");
    assert!(desk.app.cursor == Some(0.0) && desk.shows("θ 0 deg"));
}

#[test]
fn the_pane_on_the_screen() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Esc", "4"]);
    assert_snapshot!("pane_140x45", desk.screen());
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "4"]);
    assert_snapshot!("pane_80x24", desk.screen());
}

/// Solved pairs of the whole envelope, some by method static.
fn some_pairs(count: u64) -> impl Iterator<Item = (Inputs, Solution, Random)> {
    (0..count).filter_map(|number| {
        let mut random = Random::new(number + 1);
        let corner = Corner::ALL[(number % Corner::ALL.len() as u64) as usize];
        let mut inputs = pair(&mut random, corner);
        // A picture does not show the stiffness, and finite elements are a thousand times as
        // expensive.
        inputs.tooth_compliance = inputs.tooth_compliance.or(Some(ToothCompliance::BEAM));
        if number % 48 == 1 {
            inputs.method = Method::Static;
        }
        let stages = Stages::CLOSED_FORM.and(inputs.method.stages());
        let solution = model::solve(&inputs, stages.without(Stage::Band)).ok()?;
        Some((inputs, solution, random))
    })
}

fn any_view(random: &mut Random) -> TeethView {
    let centre = random.one_of(&[Centre::Strike, Centre::Strike, Centre::PitchPoint, Centre::Pair]);
    TeethView {
        centre,
        zoom: random.one_of(&[0, 0, 0, -1, -3, -8, -40, 2, 5, 9, 14, 20, 60, i32::MIN, i32::MAX]),
        has_true_gap: random.chance(0.3),
    }
}

fn any_cursor(solution: &Solution, random: &mut Random) -> Option<f64> {
    let contact = solution.position.map_or(0.01, |position| position.approach_angle_driver);
    let part = random.even(-3.0, 4.0);
    random.one_of(&[
        None,
        Some(0.0),
        Some(part * contact),
        Some(part * contact),
        Some(part),
        Some(1e300),
        Some(-1e300),
        Some(f64::NAN),
    ])
}

#[test]
fn every_pair_zoom_angle_and_size_gives_a_valid_picture() {
    const WIDTHS: [u16; 10] = [0, 1, 2, 5, 11, 20, 40, 80, 140, 200];
    const HEIGHTS: [u16; 10] = [0, 1, 2, 3, 5, 8, 16, 24, 45, 60];
    let mut drawn_pairs = 0;
    for (inputs, solution, mut random) in some_pairs(1_500) {
        for _ in 0..4 {
            let view = any_view(&mut random);
            let cursor = any_cursor(&solution, &mut random);
            let look = random.one_of(&[Look::FULL, Look::FULL, ASCII]);
            let marker =
                random.one_of(&[Marker::Braille, Marker::Braille, Marker::HalfBlock, Marker::Dot]);
            let is_stale = random.chance(0.2);
            let picture = Picture {
                inputs: &inputs,
                solution: &solution,
                cursor,
                z: 0.0,
                view: &view,
                look,
                marker,
                units: random.one_of(&System::ALL),
                is_stale,
            };
            let size = (random.one_of(&WIDTHS), random.one_of(&HEIGHTS));
            let screen = screen(&picture, size);
            let is_sound = !["NaN", "inf", "n/a"].iter().any(|bad| screen.contains(bad));
            let is_right = is_sound && (!look.ascii || screen.is_ascii());
            assert!(is_right, "{screen}\n{view:?} {cursor:?} {size:?} {marker:?} {inputs:?}");
        }
        drawn_pairs += 1;
    }
    assert!(drawn_pairs > 1_000, "only {drawn_pairs}");
}
