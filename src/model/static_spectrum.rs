//! The static transmission error over the mesh period, without base pitch deviations.

use super::Refusal;
use super::harmonics::{Fourier, Spectrum};
use super::mesh::Mesh;
use super::static_load::{balance, reaches_ends};
use crate::numeric::root;
use crate::numeric::root::greatest;

/// Samples between two borders of the mesh to find changes of the pairs in contact.
const LOOKS: usize = 16;

/// Static transmission error and tooth force of equal pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticSpectrum {
    /// The transmission error over a base pitch.
    pub spectrum: Spectrum,
    /// Greatest force of a tooth, in N.
    pub tooth_force: f64,
}

/// The static displacement of the driver over one base pitch, for a mesh without base pitch
/// deviations.
///
/// # Formula
/// ```text
/// x(s) by Σ w_k F_k = F0 with e_k = 0,   s from 0 to pb
/// ```
/// Every border of the mesh and every gain or loss of contact divides the pitch, so that each piece
/// of x is smooth.
///
/// # Source
/// The balance of [`static_load`](super::static_load::static_load). Gregory, Harris & Munro 1963
/// name the transmission error as the cause of whine.
///
/// # Errors
/// [`Refusal::BeyondReach`] if the deflection of the pairs exceeds the computed range of the mesh.
pub fn static_spectrum(mesh: &Mesh) -> Result<StaticSpectrum, Refusal> {
    let mesh = &mesh.without_error();
    if reaches_ends(mesh) {
        return Err(Refusal::BeyondReach);
    }
    let mut fourier = Fourier::new();
    let mut tooth_force = 0.0f64;
    for ends in mesh.borders(0.0, mesh.base_pitch).windows(2) {
        let inside = f64::midpoint(ends[0], ends[1]);
        for piece in pieces(mesh, (ends[0], ends[1]), inside).windows(2) {
            let (from, to) = (piece[0], piece[1]);
            let place = |part: f64| from + part * (to - from);
            let ahead = |s: f64| balance(mesh, s, inside).displacement;
            let pitch = mesh.base_pitch;
            fourier.add((from / pitch, to / pitch), |part| ahead(place(part)));
            for sign in [-1.0, 1.0] {
                let (_, most) = peak((from, to), |s| sign * ahead(s));
                fourier.include(sign * most);
            }
            let force = |s: f64| {
                let forces = mesh.pair_set(s, inside).shared(mesh.force).1;
                forces.into_iter().fold(0.0, f64::max)
            };
            tooth_force = tooth_force.max(peak((from, to), force).1);
        }
    }
    Ok(StaticSpectrum { spectrum: fourier.spectrum(1), tooth_force })
}

/// The greatest value of a smooth function and its place.
fn peak((from, to): (f64, f64), value: impl Fn(f64) -> f64) -> (f64, f64) {
    const PLACES: usize = 8;
    let known: Vec<(f64, f64)> = (0..=PLACES)
        .map(|step| from + (to - from) * step as f64 / PLACES as f64)
        .map(|s| (s, value(s)))
        .collect();
    greatest(&known, value)
}

/// The borders of the pieces with the same touching pairs, between two borders of the mesh.
fn pieces(mesh: &Mesh, (from, to): (f64, f64), inside: f64) -> Vec<f64> {
    let touching = |s: f64| {
        let pairs = mesh.pair_set(s, inside);
        let (_, forces) = pairs.shared(mesh.force);
        let carries = pairs.pairs().iter().zip(forces);
        let carries = carries.filter(|(_, force)| *force > 0.0);
        carries.map(|(pair, _)| pair.ahead).collect::<Vec<i32>>()
    };
    let places: Vec<f64> =
        (0..=LOOKS).map(|step| from + (to - from) * step as f64 / LOOKS as f64).collect();
    let sets: Vec<Vec<i32>> = places.iter().map(|&s| touching(s)).collect();
    let mut cuts = vec![from, to];
    for (ends, sets) in places.windows(2).zip(sets.windows(2)) {
        let turned = sets[0].iter().chain(&sets[1]);
        let turned = turned.filter(|pair| sets[0].contains(pair) != sets[1].contains(pair));
        cuts.extend(turned.map(|&pair| {
            root::between(ends[0], ends[1], |s| {
                let lead = mesh.pair_set(s, inside).lead(pair, mesh.force);
                lead.clamp(-mesh.length, mesh.length)
            })
        }));
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|one, other| *one - *other <= 1e-12 * mesh.base_pitch);
    cuts
}
