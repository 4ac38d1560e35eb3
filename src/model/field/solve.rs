//! From a gear to the displacements under its loads, without twist and shift of the body.

use std::f64::consts::PI;

use super::body;
use super::boundary::Boundary;
use super::element::{self, Material};
use super::grading::Grading;
use super::harmonics::{self, Displacements};
use super::load::Load;
use super::mesh::{self, Mesh};
use super::mode::{self, Mode};
use super::{FieldInput, FieldRefusal};
use crate::model::limits::field::POISSON;

/// Least thickness of the rim, in modules.
const LEAST_RIM: f64 = 1e-3;

/// The boundary of a gear, checked for the mesh.
pub(super) fn boundary(input: &FieldInput) -> Result<Boundary, FieldRefusal> {
    let boundary = Boundary::of(input)?;
    // The displacements are measured on the centre line, that of the lowest load at this radius.
    let lowest = boundary.base / boundary.load_angle(boundary.junction_roll).cos();
    let (thickness, least) = (
        boundary.root * input.module - input.bore_radius,
        ((boundary.root - lowest).max(0.0) + LEAST_RIM) * input.module,
    );
    if thickness.is_nan() || thickness < least {
        return Err(FieldRefusal::ThinRim { thickness, least });
    }
    if !(POISSON.0..=POISSON.1).contains(&input.poisson) {
        return Err(FieldRefusal::Poisson { poisson: input.poisson });
    }
    Ok(boundary)
}

/// Refuses a gear whose outline folds the elements.
pub(super) fn check(input: &FieldInput, grading: &Grading) -> Result<(), FieldRefusal> {
    let boundary = boundary(input)?;
    let bore = input.bore_radius / input.module;
    let bores = if is_extrapolated(bore, &boundary) {
        RATIOS.map(|ratio| boundary.root / ratio).to_vec()
    } else {
        vec![bore]
    };
    for bore in bores {
        let mesh = Mesh::of(&boundary, bore, grading);
        let elements = mesh.elements.iter();
        let folds = |nodes: &mesh::Nodes| element::folds(&nodes.map(|node| mesh.places[node]));
        if let Some((element, _)) = elements.enumerate().find(|(_, nodes)| folds(nodes)) {
            return Err(folded(element, &mesh));
        }
    }
    Ok(())
}

fn folded(element: usize, mesh: &Mesh) -> FieldRefusal {
    FieldRefusal::FoldedMesh { element, count: mesh.elements.len() }
}

/// Two ratios r_f/r_h from which the field of a smaller bore is extrapolated.
const RATIOS: [f64; 2] = [5.0, 7.0];

/// Whether the field of a bore in modules is extrapolated from larger bores.
fn is_extrapolated(bore: f64, boundary: &Boundary) -> bool {
    bore * RATIOS[1] < boundary.root
}

/// The displacements without the twist of the body, and for a gear without a bore without its
/// shift.
///
/// A small bore affects the field only by twist and shift, up to the square of its radius. Its
/// field is extrapolated from two larger bores, because the twist would be most of the result.
pub(super) fn without_twist(
    input: &FieldInput,
    boundary: &Boundary,
    grading: &Grading,
) -> Result<(Vec<Load>, Displacements), FieldRefusal> {
    let bore = input.bore_radius / input.module;
    if !is_extrapolated(bore, boundary) {
        return solved(input, boundary, bore, grading);
    }
    let (loads, mut far) = solved(input, boundary, boundary.root / RATIOS[0], grading)?;
    let (_, mut near) = solved(input, boundary, boundary.root / RATIOS[1], grading)?;
    add_shift(&mut far, &loads, input, -RATIOS[0].ln());
    add_shift(&mut near, &loads, input, -RATIOS[1].ln());
    let [outer, inner] = RATIOS.map(|ratio| 1.0 / (ratio * ratio));
    let share = ((bore / boundary.root).powi(2) - inner) / (outer - inner);
    let mut values = near;
    for (value, far) in all(&mut values).zip(all(&mut far)) {
        *value += share * (*far - *value);
    }
    if bore > 0.0 {
        add_shift(&mut values, &loads, input, (boundary.root / bore).ln());
    }
    Ok((loads, values))
}

/// All displacements.
fn all(values: &mut Displacements) -> impl Iterator<Item = &mut f64> {
    let own = values.surface.iter_mut().chain(&mut values.centre);
    own.chain(values.cross.iter_mut().flatten())
}

/// Adds the body's shift for ln(r_f/r_h).
fn add_shift(values: &mut Displacements, loads: &[Load], input: &FieldInput, logarithm: f64) {
    let shift = body::shift(input.poisson) * logarithm;
    for value in values.surface.iter_mut().chain(&mut values.centre) {
        *value += shift;
    }
    for (pitches, cross) in (1..).zip(&mut values.cross) {
        let turn = 2.0 * PI * f64::from(pitches) / f64::from(input.teeth);
        let pairs = loads.iter().flat_map(|load| loads.iter().map(move |other| (load, other)));
        for (value, (load, measured)) in cross.iter_mut().zip(pairs) {
            *value += shift * (turn + load.angle - measured.angle).cos();
        }
    }
}

/// The loads of the mesh, and the displacements under them for a bore in modules.
fn solved(
    input: &FieldInput,
    boundary: &Boundary,
    bore: f64,
    grading: &Grading,
) -> Result<(Vec<Load>, Displacements), FieldRefusal> {
    let mesh = Mesh::of(boundary, bore, grading);
    let places = mesh.loads.iter();
    let loads: Vec<_> = places.map(|place| Load::at(&mesh, boundary, place)).collect();
    let mut values = under_loads(input, boundary, &mesh, &loads)?;
    let twist = body::twist(boundary.base, boundary.root, bore, input.poisson);
    for value in all(&mut values) {
        *value -= twist;
    }
    Ok((loads, values))
}

/// The displacements under the loads of the mesh, twist included.
pub(super) fn under_loads(
    input: &FieldInput,
    boundary: &Boundary,
    mesh: &Mesh,
    loads: &[Load],
) -> Result<Displacements, FieldRefusal> {
    let stiffnesses = stiffnesses(mesh, boundary, input.poisson)?;
    let condense = |mode| mode::condense(mesh, &stiffnesses, loads, mode);
    let solve = || {
        let (even, odd) = (condense(Mode::Symmetric)?, condense(Mode::Antisymmetric)?);
        harmonics::displacements(&even, &odd, loads, input.teeth)
    };
    solve().ok_or(FieldRefusal::NotPositive { unknowns: 2 * mesh.places.len() })
}

/// The stiffnesses of the elements, with radial and tangential components on the cut.
fn stiffnesses(
    mesh: &Mesh,
    boundary: &Boundary,
    poisson: f64,
) -> Result<Vec<element::Stiffness>, FieldRefusal> {
    let material = Material::of(poisson);
    let cut = mesh.inner()..mesh.inner() + mesh.on_cut();
    let mut stiffnesses = Vec::with_capacity(mesh.elements.len());
    for (index, nodes) in mesh.elements.iter().enumerate() {
        let places = nodes.map(|node| mesh.places[node]);
        let mut stiffness =
            element::stiffness(&places, material).ok_or_else(|| folded(index, mesh))?;
        let is_on_cut = nodes.map(|node| cut.contains(&node));
        mode::turn(&mut stiffness, is_on_cut, boundary.half_pitch);
        element::take_middle_out(&mut stiffness);
        stiffnesses.push(stiffness);
    }
    Ok(stiffnesses)
}
