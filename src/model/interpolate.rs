//! Results for the incoming tooth at any roll angle, at stations and between stations.

use super::compliance::Teeth;
use super::inputs::Inputs;
use super::masses::Masses;
use super::mesh::Mesh;
use super::static_load::balance;
use super::stations;
use super::{MeshStation, Solution, Station};

/// An angle beyond the first contact by less than this part counts as the first contact.
const ROUNDING: f64 = 1e-9;

/// The results for the incoming tooth at a roll angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Interpolated {
    /// From D to E: an impact at this angle.
    Impact(Station),
    /// From the first to the last contact: the shared load.
    Load(MeshStation),
    /// The shared load between two stations of a motion, with [`DIGITS_BETWEEN`] correct digits of
    /// force and displacement.
    Between(MeshStation),
}

/// Correct digits of the force between two stations of a motion, relative to the greatest force,
/// with 64 stations.
pub const DIGITS_BETWEEN: usize = 3;

impl Interpolated {
    /// The results of the solution's method at `roll_angle` before E, in rad of the driver. `None`
    /// if the tooth is not in contact or has no force.
    ///
    /// # Formula
    /// ```text
    /// paper, exact:  as at a station
    /// static:        as at a station
    /// dynamic:       F of the load shared at x,
    ///                x by the cubic with x and x' of both neighbouring stations
    /// ```
    ///
    /// # Valid for
    /// Full precision for the closed form, for `static`, and at the stations of `dynamic`. Between
    /// 64 stations of `dynamic` the error of the force is at most 5e-3 of the peak.
    #[must_use]
    pub fn at(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Option<Interpolated> {
        match (&solution.dynamic, &solution.static_load) {
            (Some(dynamic), _) => moving(solution.mesh.as_deref()?, &dynamic.stations, roll_angle),
            (None, Some(load)) => at_rest(solution.mesh.as_deref()?, &load.stations, roll_angle)
                .map(Interpolated::Load),
            (None, None) => struck(inputs, solution, roll_angle).map(Interpolated::Impact),
        }
    }

    /// The impact of the methods `paper` and `exact`.
    #[must_use]
    pub fn impact(&self) -> Option<&Station> {
        if let Interpolated::Impact(station) = self { Some(station) } else { None }
    }

    /// The load, in the methods `static` and `dynamic`.
    #[must_use]
    pub fn load(&self) -> Option<&MeshStation> {
        if let Interpolated::Load(station) | Interpolated::Between(station) = self {
            Some(station)
        } else {
            None
        }
    }
}

/// The impact from D to E.
fn struck(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Option<Station> {
    let angle = roll_angle / inputs.ratio();
    let first = solution.position?.approach_angle_driven * (1.0 + ROUNDING);
    let masses = Masses::of(&inputs.bodies(), &solution.geometry)
        .ok()
        .filter(|_| (0.0..=first).contains(&angle))?;
    let geometry = &solution.geometry;
    let teeth = Teeth::of(&inputs.elasticity(), geometry).ok()?;
    let station = stations::station(inputs, &teeth, &masses, angle).ok()?;
    station.impact_force.is_finite().then_some(station)
}

/// The balance from the first contact to the last.
fn at_rest(mesh: &Mesh, stations: &[MeshStation], roll_angle: f64) -> Option<MeshStation> {
    let (first, last) = (stations.first()?.roll_angle_driver, stations.last()?.roll_angle_driver);
    let s = (last..=first).contains(&roll_angle).then_some(0.0 - roll_angle * mesh.base_radii.0)?;
    let balance = balance(mesh, s, s);
    Some(MeshStation::at(mesh, s, balance.force, balance.total, balance.displacement, None))
}

/// The motion from the first contact to the last.
fn moving(mesh: &Mesh, stations: &[MeshStation], roll_angle: f64) -> Option<Interpolated> {
    let next = stations.partition_point(|station| station.roll_angle_driver > roll_angle);
    let to = stations.get(next)?;
    if (to.roll_angle_driver..=to.roll_angle_driver).contains(&roll_angle) {
        return Some(Interpolated::Load(*to));
    }
    let from = stations.get(next.checked_sub(1)?)?;
    let part =
        (from.roll_angle_driver - roll_angle) / (from.roll_angle_driver - to.roll_angle_driver);
    let (displacement, time) = cubic(from, to, part)?;
    let s = 0.0 - roll_angle * mesh.base_radii.0;
    let pairs = mesh.pair_set(s, s);
    let forces = pairs.forces(displacement);
    let total = forces.iter().sum();
    let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0);
    let force = incoming.map_or(0.0, |incoming| forces[incoming]);
    Some(Interpolated::Between(MeshStation::at(mesh, s, force, total, displacement, Some(time))))
}

/// Displacement and time between two stations, by the cubic through value and slope at both
/// stations.
fn cubic(from: &MeshStation, to: &MeshStation, part: f64) -> Option<(f64, f64)> {
    let (begin, end) = (from.time?, to.time?);
    let rest = 1.0 - part;
    let values = from.transmission_error * (1.0 + 2.0 * part) * rest * rest
        + to.transmission_error * (3.0 - 2.0 * part) * part * part;
    let rates = part * rest * (end - begin) * (from.rate? * rest - to.rate? * part);
    Some((values + rates, begin + part * (end - begin)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::{InertiaModel, Method};
    use crate::model::sample::standard_pair;
    use crate::model::{Stages, solve};

    fn solved(method: Method, stations: usize) -> (Inputs, Solution) {
        let mut inputs = standard_pair(20, 30, 5e-3);
        inputs.inertia = InertiaModel::BaseCircle;
        (inputs.method, inputs.base_pitch_deviation, inputs.stations) =
            (method, 10e-6, Some(stations));
        let solution = solve(&inputs, Stages::EVERY).unwrap();
        (inputs, solution)
    }

    fn curve(method: Method, stations: usize) -> (Inputs, Solution, Vec<(f64, f64)>) {
        let (inputs, solution) = solved(method, stations);
        let of = |stations: &[MeshStation]| {
            stations.iter().map(|one| (one.roll_angle_driver, one.force)).collect()
        };
        let curve = match method {
            Method::Dynamic => of(&solution.dynamic.as_ref().unwrap().stations),
            Method::Static => of(&solution.static_load.as_ref().unwrap().stations),
            _ => solution
                .stations
                .iter()
                .map(|one| (one.roll_angle_driver, one.impact_force))
                .collect(),
        };
        (inputs, solution, curve)
    }

    fn force(interpolated: Interpolated) -> f64 {
        interpolated
            .impact()
            .map_or_else(|| interpolated.load().unwrap().force, |station| station.impact_force)
    }

    #[test]
    fn values_between_stations_agree_with_those_of_a_finer_solve() {
        for (method, good_to) in
            [(Method::Exact, 1e-12), (Method::Static, 1e-9), (Method::Dynamic, 5e-3)]
        {
            let (inputs, coarse, _) = curve(method, 64);
            let (_, _, fine) = curve(method, 2048);
            let peak = fine.iter().map(|(_, force)| *force).fold(0.0, f64::max);
            let off = |(angle, expected): &(f64, f64)| {
                Some((force(Interpolated::at(&inputs, &coarse, *angle)?) - expected).abs())
            };
            let off: Vec<f64> = fine[1..fine.len() - 1].iter().filter_map(off).collect();
            assert!(off.len() > 2000, "{method:?} {}", off.len());
            let most = off.into_iter().fold(0.0, f64::max);
            assert!(most <= good_to * peak, "{method:?} {:e}", most / peak);
        }
    }

    /// Contact begins and ends without force. There the balance is a difference of large numbers.
    #[test]
    fn the_force_at_the_ends_of_contact_is_zero_without_rounding() {
        for (teeth, deviation) in [(30, 10e-6), (25, 16e-6), (41, 23e-6), (67, 7e-6)] {
            for method in [Method::Static, Method::Dynamic] {
                let mut inputs = standard_pair(20, teeth, 5e-3);
                (inputs.method, inputs.base_pitch_deviation) = (method, deviation);
                let solution = solve(&inputs, Stages::EVERY).unwrap();
                let stations = match method {
                    Method::Static => &solution.static_load.as_ref().unwrap().stations,
                    _ => &solution.dynamic.as_ref().unwrap().stations,
                };
                let of_stations = stations.iter().map(|station| station.force);
                let interpolated = stations.iter().map(|station| {
                    let angle = station.roll_angle_driver;
                    force(Interpolated::at(&inputs, &solution, angle).unwrap())
                });
                for force in of_stations.chain(interpolated) {
                    let is_rounding = force != 0.0 && force < 1e-9 * solution.mesh_force;
                    assert!(!is_rounding, "20/{teeth} {method:?}: {force:e} N");
                }
                assert_eq!(stations[0].force.to_bits(), 0f64.to_bits());
            }
        }
    }

    #[test]
    fn there_are_no_values_without_contact() {
        for method in [Method::Paper, Method::Exact, Method::Static, Method::Dynamic] {
            let (inputs, solution, curve) = curve(method, 64);
            let (first, last) = (curve[0].0, curve[curve.len() - 1].0);
            for angle in [first * 1.001, last - 1e-3, f64::NAN, f64::INFINITY] {
                assert_eq!(Interpolated::at(&inputs, &solution, angle), None, "{method:?} {angle}");
            }
            assert!(
                Interpolated::at(&inputs, &solution, first).is_some()
                    && Interpolated::at(&inputs, &solution, 0.5 * first).is_some()
            );
        }
    }
}
