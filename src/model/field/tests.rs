//! Tests of the field against closed forms, finer meshes, and gears of all kinds.

use super::*;
use crate::model::profile::Rack;
use crate::model::sample::circles;
use nalgebra::Vector2;
use serde_json::Value;

/// A gear of module 1 m.
fn gear(teeth: u32, shift: f64, degrees: f64, heights: [f64; 2], rounding: f64) -> FieldInput {
    let rack = Rack {
        module: 1.0,
        pressure_angle: degrees.to_radians(),
        teeth: teeth.into(),
        profile_shift: shift,
        dedendum: heights[1],
        rounding,
    };
    FieldInput {
        profile: Profile::cut_by(&rack, &circles(&rack, heights[0]), rounding),
        teeth: teeth.into(),
        module: 1.0,
        bore_radius: 0.0,
        poisson: 0.3,
    }
}

/// The gear with a bore of r_f/`ratio`.
fn bored(mut input: FieldInput, ratio: f64) -> FieldInput {
    input.bore_radius = input.profile.circles().root / ratio;
    input
}

fn gears() -> [FieldInput; 4] {
    [
        bored(gear(20, 0.0, 20.0, [1.0, 1.25], 0.38), 2.5),
        bored(gear(9, 0.1, 20.0, [1.0, 1.25], 0.38), 1.6),
        bored(gear(60, -0.3, 20.0, [1.0, 1.4], 0.3), 1.1),
        gear(33, 0.5, 25.0, [1.0, 1.1], 0.25),
    ]
}

/// Greatest differences between two fields over the flank: surface, depth and coupling.
fn differences(left: &Field, right: &Field) -> [f64; 3] {
    let [from, to] = left.radii();
    let mut worst = [0.0_f64; 3];
    for step in 0..=20 {
        let radius = from + (to - from) * f64::from(step) / 20.0;
        let other = to - 0.6 * (radius - from);
        let values = |field: &Field| {
            let surface = field.surface(radius, 0.02);
            let cross = field.cross(radius, other, 1);
            [
                surface / right.surface(radius, 0.02),
                field.depth(radius, 0.0) / right.depth(radius, 0.0),
                cross / right.surface(radius, 0.02),
            ]
        };
        for (worst, (left, right)) in
            worst.iter_mut().zip(values(left).into_iter().zip(values(right)))
        {
            *worst = worst.max((left - right).abs());
        }
    }
    worst
}

#[test]
fn field_converges_as_the_mesh_is_halved() {
    for input in gears() {
        let at = |grading| Field::graded(&input, &grading).unwrap();
        let fine = at(Grading::STANDARD.halved());
        let standard = differences(&at(Grading::STANDARD), &fine);
        let coarse = differences(&at(Grading::STANDARD.doubled()), &fine);
        for (standard, coarse) in standard.into_iter().zip(coarse) {
            assert!(
                standard < 3e-3 && standard < 0.6 * coarse.max(1e-3),
                "z {}: {coarse:e} {standard:e}",
                input.teeth
            );
        }
    }
}

#[test]
fn series_agree_with_loads_between_their_sampled_loads() {
    for input in gears() {
        let boundary = boundary(&input).unwrap();
        let grading = Grading::STANDARD.with_more_loads();
        let (loads, values) = without_twist(&input, &boundary, &grading).unwrap();
        let kept: Vec<_> =
            (0..loads.len()).filter(|load| load % 2 == 0 || load + 1 == loads.len()).collect();
        let pick = |all: &[f64]| kept.iter().map(|&load| all[load]).collect::<Vec<_>>();
        let fewer = Displacements {
            surface: pick(&values.surface),
            centre: pick(&values.centre),
            cross: values.cross.each_ref().map(|cross| {
                kept.iter()
                    .flat_map(|&load| pick(&cross[load * loads.len()..][..loads.len()]))
                    .collect()
            }),
        };
        let fewer_loads: Vec<_> = kept.iter().map(|&load| loads[load].clone()).collect();
        let field = Field::fitted(&input, &boundary, &fewer_loads, &fewer);
        let mut worst = [0.0_f64; 3];
        for (index, load) in loads.iter().enumerate() {
            let radius = boundary.base.hypot(boundary.base * load.roll);
            let off = [
                field.surface(radius, load.half_width) / values.surface[index] - 1.0,
                field.depth(radius, load.half_width) / values.centre[index] - 1.0,
                (field.cross(radius, radius, 1) - values.cross[0][index * (loads.len() + 1)])
                    / values.surface[index],
            ];
            for (worst, off) in worst.iter_mut().zip(off) {
                *worst = worst.max(off.abs());
            }
        }
        let limits = [1.5e-3, 1e-3, 1e-4];
        assert!(
            worst.iter().zip(limits).all(|(&worst, limit)| worst < limit),
            "z {}: {worst:?}",
            input.teeth
        );
    }
}

#[test]
fn neighbours_ahead_and_behind_agree_with_the_reference() {
    let rows: Vec<Value> =
        serde_json::from_str(include_str!("../../../tests/reference/field/teeth.json")).unwrap();
    for row in rows {
        let number = |key: &str| row[key].as_f64().unwrap();
        let (teeth, heights) = (number("teeth") as u32, [number("addendum"), number("dedendum")]);
        let mut input = gear(
            teeth,
            number("profile_shift"),
            number("pressure_angle_deg"),
            heights,
            number("tip_rounding"),
        );
        (input.bore_radius, input.poisson) = (number("bore_radius"), number("poisson"));
        let boundary = boundary(&input).unwrap();
        let mesh = mesh::Mesh::of(&boundary, input.bore_radius, &Grading::STANDARD);
        let mut loads: Vec<_> =
            mesh.loads.iter().map(|place| Load::at(&mesh, &boundary, place)).collect();
        let half = loads.len();
        for load in 0..half {
            loads.push(Load { force: loads[load].centre.clone(), ..loads[load].clone() });
        }
        let values = under_loads(&input, &boundary, &mesh, &loads).unwrap();
        let roll = (number("radius").powi(2) / boundary.base.powi(2) - 1.0).sqrt();
        let rolls: Vec<_> = loads[..half].iter().map(|load| load.roll).collect();
        let Some(nearest) =
            (0..half - 1).find(|&load| rolls[load] >= roll && roll >= rolls[load + 1])
        else {
            continue;
        };
        let part = (rolls[nearest] - roll) / (rolls[nearest] - rolls[nearest + 1]);
        let at = |index: &dyn Fn(usize) -> usize| {
            let value = |load| values.cross[0][index(load)];
            value(nearest) + part * (value(nearest + 1) - value(nearest))
        };
        let behind = at(&|load| load * 2 * half + half + load) / number("qE_behind_depth");
        let ahead = at(&|load| (half + load) * 2 * half + load) / number("qE_ahead_depth");
        assert!(
            (behind - 1.0).abs() < 5e-3 && (ahead - 1.0).abs() < 5e-3,
            "z {teeth} at {}: {ahead} {behind}",
            number("fraction")
        );
    }
}

#[test]
fn two_bores_differ_by_twist_and_shift_in_closed_form() {
    let input = gear(40, 0.0, 20.0, [1.0, 1.25], 0.38);
    let boundary = boundary(&input).unwrap();
    let at = |ratio: f64| {
        let mesh = mesh::Mesh::of(&boundary, boundary.root / ratio, &Grading::STANDARD);
        let places = mesh.loads.iter();
        let loads: Vec<_> = places.map(|place| Load::at(&mesh, &boundary, place)).collect();
        under_loads(&input, &boundary, &mesh, &loads).unwrap()
    };
    let (near, far) = (at(7.0), at(5.0));
    let twist = |ratio: f64| body_twist(boundary.base, boundary.root, boundary.root / ratio, 0.3);
    let shift = body_shift(0.3) * (7.0_f64 / 5.0).ln();
    for (pitches, (near, far)) in (1..).zip(near.cross.iter().zip(&far.cross)) {
        let expected = twist(7.0) - twist(5.0) + shift * (PI * f64::from(pitches) / 20.0).cos();
        let rise = near[0] - far[0];
        assert!((rise - expected).abs() < 0.02 * expected, "{rise} against {expected}");
    }
}

/// A pseudo-random number from 0 to 1.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

fn random_gear(state: &mut u64) -> FieldInput {
    let mut between = |from: f64, to: f64| from + (to - from) * random(state);
    let teeth = between(5.0_f64.ln(), 1000.0_f64.ln()).exp().round() as u32;
    let (shift, degrees) = (between(-0.7, 1.2), between(14.5, 30.0));
    let heights = [between(0.5, 1.5), between(1.0, 1.7)];
    let input = gear(teeth, shift, degrees, heights, between(0.0, 0.5));
    let ratio = 1.0 + between(-7.0, 4.0).exp();
    if between(0.0, 1.0) < 0.15 { input } else { bored(input, ratio) }
}

fn check(input: &FieldInput, field: &Field) {
    let [from, to] = field.radii();
    for step in 0..=12 {
        let radius = from + (to - from) * f64::from(step) / 12.0;
        let (surface, depth) = (field.surface(radius, 0.01), field.depth(radius, 0.0));
        assert!(surface > 0.0 && surface.is_finite(), "{surface} {input:?}");
        assert!(depth > 0.0 && depth < surface + 0.5, "{depth} {surface} {input:?}");
        for pitches in [-2, -1, 1, 2] {
            let cross = field.cross(radius, to, pitches);
            assert!(cross.is_finite(), "{cross} {surface} {input:?}");
        }
    }
}

#[test]
fn every_gear_has_a_field_or_a_refusal_of_its_shape() {
    const GEARS: usize = 60;
    const LEAST_FIELDS: usize = 30;
    let (mut state, mut fields) = (5, 0);
    for _ in 0..GEARS {
        let input = random_gear(&mut state);
        if input.profile.circles().root <= 0.5 {
            continue;
        }
        match Field::build(&input) {
            Ok(field) => {
                check(&input, &field);
                fields += 1;
            }
            Err(refusal) => assert!(
                !matches!(
                    refusal,
                    FieldRefusal::FoldedMesh { .. } | FieldRefusal::NotPositive { .. }
                ),
                "{refusal}: {input:?}"
            ),
        }
    }
    assert!(fields >= LEAST_FIELDS, "{fields} fields");
}

/// The displacement of the load circle v = u_θ r_b/r at the rim for a unit force along the base
/// circle, by integration of the shear strain: dv/dr = τ/(G r), τ = F r_b/(2π r²).
#[test]
fn twist_is_the_integral_of_the_shear_strain_over_the_ring() {
    for (bore, root, base, poisson) in [(4.0, 8.75, 9.4, 0.3), (28.0, 28.6, 28.2, 0.0)] {
        let shear_modulus = 0.5 / (1.0 + poisson);
        let turn = crate::numeric::quadrature::adaptive(bore, root, 1e-13, |radius| {
            base / (2.0 * PI * radius.powi(2)) / (shear_modulus * radius)
        });
        let found = body_twist(base, root, bore, poisson);
        assert!((found / (base * turn) - 1.0).abs() < 1e-12, "{found} {turn}");
    }
}

#[test]
fn elimination_gives_the_schur_complement_and_the_reduced_border() {
    let dense =
        [[4.0, 1.0, 0.0, 0.5], [1.0, 5.0, 2.0, 0.0], [0.0, 2.0, 6.0, 1.0], [0.5, 0.0, 1.0, 7.0]];
    let border = [1.0, -2.0, 3.0, 0.5];
    let mut matrix = mode::Envelope::new(vec![0, 0, 1, 0, 0], 4);
    for (row, entries) in dense.iter().enumerate() {
        for (column, &entry) in entries.iter().enumerate().take(row + 1) {
            if entry != 0.0 {
                matrix.add(row, column, entry);
            }
        }
    }
    for (column, &entry) in border.iter().enumerate() {
        matrix.add(4, column, entry);
    }
    assert!(matrix.eliminate(2));
    let [inner, coupling, outer] = [[0, 0], [2, 0], [2, 2]].map(|[row, column]| {
        nalgebra::Matrix2::from_fn(|i: usize, j: usize| dense[row + i][column + j])
    });
    let factor = inner.cholesky().unwrap().l();
    let schur = outer - coupling * inner.try_inverse().unwrap() * coupling.transpose();
    let half = factor.try_inverse().unwrap() * Vector2::new(border[0], border[1]);
    let rest = Vector2::new(border[2], border[3])
        - coupling * factor.transpose().try_inverse().unwrap() * half;
    let near = |found: f64, expected: f64| {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    };
    near(matrix.row(2, 2).1[0], schur.m11);
    near(matrix.row(3, 2).1[0], schur.m21);
    near(matrix.row(3, 2).1[1], schur.m22);
    let solved = matrix.row(4, 0).1;
    for (found, expected) in solved.iter().zip([half.x, half.y, rest.x, rest.y]) {
        near(*found, expected);
    }
}

#[test]
fn a_matrix_that_is_not_positive_definite_is_not_eliminated() {
    let mut matrix = mode::Envelope::new(vec![0, 0], 2);
    for (row, column, value) in [(0, 0, 1.0), (1, 0, 2.0), (1, 1, 3.0)] {
        matrix.add(row, column, value);
    }
    assert!(!matrix.eliminate(2));
}

/// The series agree with their own loads and with other loads of the same mesh. The other loads are
/// also between rows of equal height, because elements under a patch between unequal rows have
/// errors of up to 1e-2.
#[test]
fn the_series_of_the_surface_is_within_1e_4_of_the_loads_of_its_mesh() {
    let mut seen = 0;
    for input in gears() {
        let boundary = boundary(&input).unwrap();
        let bore = input.bore_radius.max(boundary.root / 5.0);
        let mesh = mesh::Mesh::of(&boundary, bore, &Grading::STANDARD);
        let places = mesh.all_load_places(&boundary, bore, &Grading::STANDARD);
        let loads: Vec<_> = places.iter().map(|place| Load::at(&mesh, &boundary, place)).collect();
        let values = under_loads(&input, &boundary, &mesh, &loads).unwrap();
        let even = |all: &[f64]| all.iter().copied().step_by(2).collect::<Vec<_>>();
        let own: Vec<_> = loads.iter().step_by(2).cloned().collect();
        let fitted = Field::fitted(
            &input,
            &boundary,
            &own,
            &Displacements {
                surface: even(&values.surface),
                centre: even(&values.centre),
                cross: values.cross.each_ref().map(|cross| {
                    let rows = cross.chunks_exact(loads.len()).step_by(2);
                    rows.flat_map(even).collect()
                }),
            },
        );
        for (index, (load, place)) in loads.iter().zip(&places).enumerate() {
            let [above, below] = place.heights;
            if index % 2 == 1 && (above / below - 1.0).abs() > 1e-6 {
                continue;
            }
            let radius = boundary.base.hypot(boundary.base * load.roll);
            let found = fitted.surface(radius, load.half_width);
            let off = found / values.surface[index] - 1.0;
            assert!(off.abs() < 1e-4, "z {} at load {index}: {off:e}", input.teeth);
            seen += index % 2;
        }
    }
    assert!(seen >= 10, "{seen}");
}

/// A whole number of virtual teeth is that of a spur gear, and no value jumps beside it.
#[test]
fn the_field_is_continuous_over_virtual_teeth() {
    for teeth in [11, 20, 33, 80] {
        let input = gear(teeth, 0.1, 20.0, [1.0, 1.25], 0.3);
        let [before, here, after] = [-1e-6, 0.0, 1e-6].map(|more| {
            let field = Field::build(&FieldInput { teeth: input.teeth + more, ..input }).unwrap();
            let radius = f64::midpoint(field.radii()[0], field.radii()[1]);
            [
                field.depth(radius, 0.0),
                field.cross(radius, radius, 1),
                field.cross(radius, radius, -2),
            ]
        });
        for beside in [before, after] {
            for (one, other) in beside.into_iter().zip(here) {
                assert!((one - other).abs() <= 2e-6 * here[0], "z {teeth}: {one:e} for {other:e}");
            }
        }
    }
}
