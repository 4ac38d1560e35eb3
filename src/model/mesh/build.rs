//! Computes a mesh from a case: its zones, its couplings and its mean stiffness.

use std::sync::Arc;

use super::Mesh;
use super::back::back_place;
use super::couplings::{Couplings, Neighbours, Way};
use super::inputs::MeshInputs;
use super::zones::{End, LEVER, STIFFNESS, Zone, line_zones};
use crate::model::Refusal;
use crate::model::budget::PAIRS;
use crate::model::compliance::flanks::Flanks;
use crate::model::compliance::{ContactPlace, Teeth};
use crate::model::geometry::Geometry;
use crate::model::relief::Relief;
use crate::numeric::chebyshev::TERMS;
use crate::numeric::lanes::Lanes;
use crate::numeric::quadrature;

/// The teeth of a pair under the mesh force, in N.
struct UnderLoad {
    teeth: Teeth,
    force: f64,
}

impl Neighbours for UnderLoad {
    fn is_coupled(&self) -> bool {
        self.teeth.is_coupled()
    }

    fn abscissas(&self, place: &ContactPlace) -> Result<[f64; 2], Refusal> {
        self.teeth.abscissas(&self.teeth.under(place, self.force))
    }

    fn displacements(
        &self,
        rear: [Lanes<TERMS>; 2],
        front: [Lanes<TERMS>; 2],
        pitches: i32,
    ) -> Lanes<TERMS> {
        self.teeth.couplings(rear, front, pitches)
    }
}

impl Mesh {
    /// The mesh in the range where the gaps before E and after B are at most `reach`, in m.
    ///
    /// # Formula
    /// ```text
    /// x + e_k − S(s_k) = Σ_j Q_kj F_j/b  if F_k > 0,   s_k = s + k pb
    /// Q_kk = q1(r1) + q2(r2) + qH(F0)
    /// ```
    /// S is the normal gap with the reliefs of both flanks, x the displacement of the driver ahead
    /// along the line of action, and e_k the equivalent error: Δf without reliefs for the incoming
    /// pair, 0 for all other pairs. Q_kj is the displacement of the pair k by the force on the pair
    /// j, up to [`PITCHES`](crate::model::field::PITCHES) away. With a tooth model without coupling
    /// the pairs are independent springs. On the line of action the load points are the crossings
    /// of the line with both flanks. Before E the load point is the driven tip, after B the
    /// driver's tip. A sharp tip has the radius of curvature of its flank, a rounded tip that of
    /// its edge.
    ///
    /// # Errors
    /// A [`Refusal`] if a compliance cannot be computed, the run-out interferes, or more pairs may
    /// touch at a time than the [budget](crate::model::budget) allows.
    pub fn new(
        inputs: &MeshInputs,
        geometry: &Geometry,
        force: f64,
        error: f64,
        reach: f64,
    ) -> Result<Mesh, Refusal> {
        let flanks = Arc::new(Flanks::new(&inputs.elasticity, geometry)?);
        Mesh::of_flanks(inputs, geometry, &flanks, (force, error), reach)
    }

    /// Like [`Mesh::new`], with a known compliance of the teeth, which does not depend on reliefs,
    /// load and reach.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub(in crate::model) fn of_flanks(
        inputs: &MeshInputs,
        geometry: &Geometry,
        flanks: &Arc<Flanks>,
        load: (f64, f64),
        reach: f64,
    ) -> Result<Mesh, Refusal> {
        let neighbours = UnderLoad {
            teeth: Teeth::of(&inputs.elasticity, geometry)?,
            force: load.0,
        };
        Mesh::with_neighbours(inputs, geometry, flanks, load, reach, &neighbours)
    }

    /// Like [`Mesh::new`], with the couplings from `neighbour`.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub(in crate::model) fn with_neighbours(
        inputs: &MeshInputs,
        geometry: &Geometry,
        flanks: &Arc<Flanks>,
        (force, error): (f64, f64),
        reach: f64,
        neighbours: &dyn Neighbours,
    ) -> Result<Mesh, Refusal> {
        let relief = Relief::of(&inputs.reliefs, geometry);
        let pace = inputs.speed;
        let inputs = &inputs.at_speed(1.0);
        let run_in = End {
            inputs: *inputs,
            geometry: *geometry,
            flanks: Flanks::clone(flanks),
            side: -1.0,
        };
        let run_out = run_in.swapped()?;
        let length = geometry.end - geometry.start;
        let (before, is_whole_before) = run_in.angle_of_reach(reach);
        let (after, is_whole_after) = run_out.angle_of_reach(reach);
        let (mut zones, mut bends) = (Vec::new(), vec![0.0, length]);
        bends.extend(run_in.zones(&relief, force, before, 0.0, &mut zones)?);
        let lines = line_zones(inputs, geometry, (flanks, &relief), force, &mut zones)?;
        bends.extend(lines);
        bends.extend(run_out.zones(&relief, force, after, length, &mut zones)?);
        zones.sort_by(|one, other| one.from.total_cmp(&other.from));
        check_pairs(length_of(&zones) / geometry.base_pitch)?;
        let levers = zones
            .iter()
            .flat_map(|zone| [zone.from, zone.to].map(|s| zone.series.one(LEVER, s)));
        let friction = inputs.friction;
        let limit = 1.0 / levers.fold(0.0, f64::max);
        if friction >= limit {
            return Err(Refusal::FrictionLocks { friction, limit });
        }
        let way = Way {
            ends: (
                zones.first().map_or(0.0, |zone| zone.from),
                zones.last().map_or(0.0, |zone| zone.to),
            ),
            bends,
            base_pitch: geometry.base_pitch,
        };
        let place = |s: f64| match s {
            s if s < 0.0 => run_in.place(-s / geometry.driven.base),
            s if s > length => run_out.place((s - length) / geometry.driver.base).swapped(),
            s => ContactPlace::on_line_of_action(geometry, geometry.start + s),
        };
        let width = inputs.elasticity.width;
        let own = zones
            .first()
            .map_or(0.0, |zone| zone.series.one(STIFFNESS, zone.to))
            .recip();
        let couplings = Couplings::of(&way, (own, width), neighbours, &place)?;
        let coupling_work = couplings.as_ref().map_or(0, Couplings::evaluations) as u64;
        let mesh = Mesh {
            base_pitch: geometry.base_pitch,
            length,
            force,
            speed: pace * geometry.driver.base,
            driver_speed: pace,
            error,
            mean_stiffness: 0.0,
            base_radii: (geometry.driver.base, geometry.driven.base),
            width,
            friction,
            pitch_point: geometry.approach_length,
            work: coupling_work
                + zones
                    .iter()
                    .map(|zone| zone.series.evaluations() as u64)
                    .sum::<u64>(),
            flanks: Arc::clone(flanks),
            zones: Arc::new(zones),
            couplings: couplings.map(Arc::new),
            sharing: Arc::default(),
            back_place: back_place(&inputs.shape, geometry),
            back: Arc::default(),
            reach,
            is_whole: is_whole_before && is_whole_after,
        };
        mesh.check_couplings()?;
        Ok(mesh.with_mean_stiffness())
    }

    /// The mesh without coupling.
    #[must_use]
    pub fn uncoupled(&self) -> Mesh {
        let alone = Mesh {
            couplings: None,
            back: Arc::default(),
            ..self.clone()
        };
        alone.with_mean_stiffness()
    }

    fn with_mean_stiffness(self) -> Mesh {
        Mesh {
            mean_stiffness: self.stiffness_on_line() / self.base_pitch,
            ..self
        }
    }

    /// Refuses compliances that are not positive definite.
    fn check_couplings(&self) -> Result<(), Refusal> {
        if self.couplings.is_none() {
            return Ok(());
        }
        for ends in self.borders(0.0, self.base_pitch).windows(2) {
            let middle = f64::midpoint(ends[0], ends[1]);
            for s in [ends[0], middle, ends[1]] {
                if !self.pair_set(s, middle).is_definite() {
                    return Err(Refusal::IndefiniteCompliance);
                }
            }
        }
        Ok(())
    }

    /// ∫ of the stiffness of all pairs on the line of action over a base pitch, in N.
    fn stiffness_on_line(&self) -> f64 {
        let on_line = |zone: &&Zone| zone.from >= 0.0 && zone.to <= self.length;
        let zones = self.zones.iter().filter(on_line);
        if self.couplings.is_none() {
            return zones.map(|zone| zone.series.integral(STIFFNESS)).sum();
        }
        let line = Mesh {
            zones: Arc::new(zones.cloned().collect()),
            ..self.clone()
        };
        let stiffness = |s: f64, inside: f64| {
            let pairs = line.pair_set(s, inside).of_no_gap();
            pairs.forces(1.0).iter().sum::<f64>()
        };
        let borders = self.borders(0.0, self.base_pitch);
        let over = |ends: &[f64]| {
            let (from, to) = (ends[0], ends[1]);
            let at = |part: f64| stiffness(from + part * (to - from), f64::midpoint(from, to));
            (to - from) * quadrature::unit_interval(at)
        };
        borders.windows(2).map(over).sum()
    }
}

/// Length of the line of action over which a pair may touch, in m.
fn length_of(zones: &[Zone]) -> f64 {
    zones.last().map_or(0.0, |zone| zone.to) - zones.first().map_or(0.0, |zone| zone.from)
}

/// Refuses more pairs in contact than a set can contain. `pitches` is the length of contact in base
/// pitches.
fn check_pairs(pitches: f64) -> Result<(), Refusal> {
    let pairs = 1 + pitches as usize;
    if pairs > PAIRS {
        return Err(Refusal::TooManyPairs {
            pairs,
            limit: PAIRS,
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_pairs_than_a_set_can_contain_are_refused() {
        assert_eq!(check_pairs(63.9), Ok(()));
        let refusal = check_pairs(64.0).unwrap_err();
        assert_eq!(refusal.code(), "too-many-pairs");
        assert_eq!(
            refusal.to_string(),
            "65 tooth pairs may touch at a time, and the limit is 64"
        );
    }
}
