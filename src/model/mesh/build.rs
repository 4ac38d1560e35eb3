//! Computes a mesh from a case: its zones, its couplings, its range of gaps, and the mirrored mesh of
//! the back flanks.

use super::sharing::{Couplings, Neighbours, Way};
use super::zones::{End, LEVER, Zone, line_zones, teeth_on_line};
use super::{Mesh, MeshInputs};
use crate::model::budget::PAIRS;
use crate::model::compliance::flanks::Flanks;
use crate::model::compliance::{ContactPlace, Teeth};
use crate::model::geometry::{Geometry, PairShape, involute};
use crate::model::relief::Relief;
use crate::model::{Refusal, Solution};
use crate::numeric::chebyshev::Series;
use std::sync::Arc;

/// The flanks, and what is known of the influence of neighbouring teeth: how to compute it, or the
/// couplings, if any.
type MeshParts<'a> = (&'a Arc<Flanks>, Option<&'a Neighbours<'a>>, Option<Option<Arc<Couplings>>>);

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
    /// Parts of an `earlier` mesh of this geometry that do not change are used again.
    ///
    /// # Errors
    /// A [`Refusal`] if a compliance cannot be computed, the run-out interferes, or more pairs may
    /// touch at a time than the [budget](crate::model::budget) allows.
    pub fn new(
        inputs: &MeshInputs,
        geometry: &Geometry,
        (force, error): (f64, f64),
        reach: f64,
        earlier: Option<&Mesh>,
    ) -> Result<Mesh, Refusal> {
        // The compliance of the teeth depends on the elasticity alone, the couplings also on load,
        // reach and tips, and all but the error of the mesh on everything else.
        let earlier = earlier.filter(|earlier| earlier.inputs.elasticity == inputs.elasticity);
        let has_same_load = |earlier: &&Mesh| {
            earlier.force.to_bits() == force.to_bits() && earlier.reach.to_bits() == reach.to_bits()
        };
        let alike = earlier.filter(has_same_load);
        if let Some(same) = alike.filter(|alike| alike.inputs == inputs.at_speed(1.0)) {
            return Ok(Mesh { error, ..same.at_speed(inputs.speed) });
        }
        let has_same_tips = |alike: &&Mesh| {
            alike.inputs.shape == inputs.shape && alike.inputs.tip_radii == inputs.tip_radii
        };
        let couplings = alike.filter(has_same_tips).map(|alike| alike.couplings.clone());
        let teeth = Teeth::of(&inputs.elasticity, geometry)?;
        let flanks = match earlier {
            Some(earlier) => Arc::clone(&earlier.flanks),
            None => Arc::new(Flanks::new(&teeth)?),
        };
        let abscissas = |place: &ContactPlace| teeth.abscissas(&teeth.under(place, force));
        let displacements = |rear, front, pitches| teeth.couplings(rear, front, pitches);
        let neighbours = Neighbours { abscissas: &abscissas, displacements: &displacements };
        let neighbours = teeth.is_coupled().then_some(neighbours);
        let parts = (&flanks, neighbours.as_ref(), couplings);
        Mesh::of_parts(inputs, geometry, parts, (force, error), reach)
    }

    /// Like [`Mesh::new`], with the compliance of the teeth, their coupling, and perhaps the known
    /// couplings of the pairs.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub(crate) fn of_parts(
        inputs: &MeshInputs,
        geometry: &Geometry,
        (flanks, neighbours, known): MeshParts,
        (force, error): (f64, f64),
        reach: f64,
    ) -> Result<Mesh, Refusal> {
        let relief = Relief::of(&inputs.reliefs, geometry);
        let pace = inputs.speed;
        let inputs = &inputs.at_speed(1.0);
        let run_in =
            End { inputs: *inputs, geometry: *geometry, flanks: Flanks::clone(flanks), side: -1.0 };
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
        let ends = (zones[0].from, zones[zones.len() - 1].to);
        check_pairs((ends.1 - ends.0) / geometry.base_pitch)?;
        let levers =
            zones.iter().flat_map(|zone| [zone.from, zone.to].map(|s| zone.series.one(LEVER, s)));
        let friction = inputs.friction;
        let limit = 1.0 / levers.fold(0.0, f64::max);
        if friction >= limit {
            return Err(Refusal::FrictionLocks { friction, limit });
        }
        let way = Way { ends, bends, base_pitch: geometry.base_pitch };
        let place = |s: f64| match s {
            s if s < 0.0 => run_in.place(-s / geometry.driven.base),
            s if s > length => run_out.place((s - length) / geometry.driver.base).swapped(),
            s => ContactPlace::on_line_of_action(geometry, geometry.start + s),
        };
        let width = inputs.elasticity.width;
        let ends = (geometry.start, geometry.tangent_length - geometry.start);
        let at_start = (&place(0.0), ends);
        let own = flanks.at_load(&inputs.elasticity, geometry, at_start.0, at_start.1, force)?;
        let own: f64 = own.iter().sum();
        let couplings = match (known, neighbours) {
            (Some(known), _) => known,
            (None, Some(neighbours)) => {
                Couplings::of(&way, (own / width, width), neighbours, &place)?
            }
            (None, None) => None,
        };
        let coupling_work = couplings.as_deref().map_or(0, Couplings::evaluations) as u64;
        let mesh = Mesh {
            base_pitch: geometry.base_pitch,
            length,
            force,
            speed: pace * geometry.driver.base,
            driver_speed: pace,
            error,
            base_radii: (geometry.driver.base, geometry.driven.base),
            width,
            friction,
            pitch_point: geometry.approach_length,
            work: coupling_work
                + zones.iter().map(|zone| zone.series.evaluations() as u64).sum::<u64>(),
            flanks: Arc::clone(flanks),
            zones: Arc::new(zones),
            couplings,
            inputs: *inputs,
            sharing: Arc::default(),
            mean_stiffness: Arc::default(),
            sections: Arc::default(),
            back_place: back_place(&inputs.shape, geometry),
            back: Arc::default(),
            reach,
            is_whole: is_whole_before && is_whole_after,
        };
        mesh.check_couplings()?;
        Ok(mesh)
    }

    /// What a slice of the face needs of a pair at a place of its path: the gap, in m, and the integrals
    /// over the path of the gap, of the compliances of the contact, of the driver's tooth and of the
    /// driven tooth per unit width, in m²/N, and of the arm of the friction force over the driver's
    /// base radius with the sign of the sliding velocity.
    ///
    /// # Errors
    /// Those of the compliances.
    pub(in crate::model) fn sections(
        &self,
        geometry: &Geometry,
    ) -> Result<Arc<Series<6>>, Refusal> {
        /// Of each value in the middle of the path.
        const REST: f64 = 1e-12;
        /// Least part of the compliance of a pair that is in its contact.
        const LEAST: f64 = 1e-3;
        if let Some(known) = self.sections.0.get() {
            return Ok(Arc::clone(known));
        }
        let (inputs, force, flanks) = (&self.inputs, self.force, Flanks::clone(&self.flanks));
        let run_in = End { inputs: *inputs, geometry: *geometry, flanks, side: -1.0 };
        let run_out = run_in.swapped()?;
        let teeth = |s: f64| match s {
            s if s < 0.0 => run_in.teeth(force, -s / geometry.driven.base),
            s if s > self.length => {
                let angle = (s - self.length) / geometry.driver.base;
                run_out.teeth(force, angle).map(|[driven, driver]| [driver, driven])
            }
            s => teeth_on_line(inputs, geometry, &self.flanks, force, s),
        };
        let of_zone = |zone: &Zone| {
            let [_, _, _, turns] = zone.series.at(f64::midpoint(zone.from, zone.to));
            let at = |s: f64| {
                let [stiffness, gap, lever] = zone.series.at(s);
                let ([driver, driven], compliance) = (teeth(s)?, self.width / stiffness);
                let contact = (compliance - driver - driven).max(LEAST * compliance);
                let part = (compliance - contact) / (driver + driven);
                Ok([gap, contact, part * driver, part * driven, lever * turns.signum()])
            };
            let [_, size, ..] = at(f64::midpoint(zone.from, zone.to))?;
            let rest = [zone.gap_rest, REST * size, REST * size, REST * size, REST];
            Series::of(zone.from, zone.to, &|_, _| rest, &at)
        };
        let zones: Vec<Series<5>> = self.zones.iter().map(of_zone).collect::<Result<_, _>>()?;
        let sections = || Arc::new(Series::joined(zones).with_integrals());
        Ok(Arc::clone(self.sections.0.get_or_init(sections)))
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
}

/// Refuses more pairs in contact than a set can contain. `pitches` is the length of contact in base
/// pitches.
fn check_pairs(pitches: f64) -> Result<(), Refusal> {
    let pairs = 1 + pitches as usize;
    if pairs > PAIRS {
        return Err(Refusal::TooManyPairs { pairs, limit: PAIRS });
    }
    Ok(())
}

impl Mesh {
    /// The mesh of the back flanks as a function of the path of a back pair since B' in the mirror,
    /// in m. Back flanks have no deviation.
    ///
    /// # Formula
    /// ```text
    /// s' = EB − σ,   k'(s') = k(σ),   S'(s') = S(σ),   Q'_kj(s') = Q_jk(σ)
    /// ```
    /// σ is the path since E' in the mirror. The driver keeps its direction of rotation, so a back
    /// pair moves from B', where the driver's tip meets the root of the driven gear, to E'.
    ///
    /// # Valid for
    /// Symmetric teeth with the same reliefs on both flanks.
    pub fn back(&self) -> Mesh {
        let back = self.back.0.get_or_init(|| self.reversed());
        Mesh { speed: self.speed, driver_speed: self.driver_speed, ..back.clone() }
    }

    /// The path s' of a back pair with the incoming pair at E, from 0 to a base pitch, in m.
    pub fn back_place(&self) -> f64 {
        self.back_place
    }

    fn reversed(&self) -> Mesh {
        let zones = self.zones.iter().rev();
        let couplings = self.couplings.as_ref();
        Mesh {
            error: 0.0,
            pitch_point: self.length - self.pitch_point,
            zones: Arc::new(zones.map(|zone| zone.reversed(self.length)).collect()),
            couplings: couplings
                .map(|couplings| Arc::new(couplings.reversed(self.length, self.base_pitch))),
            sharing: Arc::default(),
            sections: Arc::default(),
            back: Arc::default(),
            ..self.clone()
        }
    }
}

/// The path s' of a back pair with the incoming pair at E, from 0 to a base pitch, in m.
///
/// # Formula
/// ```text
/// s' = s + EB − σ_0 + k p_b,   σ_0 = 2 EP + p_b/2 + r_b1 ψ_1 − r_b2 ψ_2
/// ψ = π/(2 z) + 2 x tan α/z + inv α − inv α_w
/// ```
/// ψ is half the angle of a tooth on its working pitch circle. The flanks of a driver's tooth cross
/// the two lines of action at the same distance from N1 after a rotation by 2 EP + 2 `r_b1` ψ_1.
/// Each gear has half of the backlash and turns by half of it until the back flanks touch, so that
/// σ_0 does not depend on the backlash.
pub(super) fn back_place(shape: &PairShape, geometry: &Geometry) -> f64 {
    let alpha = shape.pressure_angle;
    let common = involute(alpha) - involute(geometry.working_pressure_angle);
    let half_tooth = |teeth: f64, shift: f64| {
        (std::f64::consts::FRAC_PI_2 + 2.0 * shift * alpha.tan()) / teeth + common
    };
    let (driver, driven) = (&shape.driver, &shape.driven);
    let start = 2.0 * geometry.approach_length
        + 0.5 * geometry.base_pitch
        + geometry.driver.base * half_tooth(driver.teeth, driver.profile_shift)
        - geometry.driven.base * half_tooth(driven.teeth, driven.profile_shift);
    (geometry.end - geometry.start - start).rem_euclid(geometry.base_pitch)
}

/// The first range of gaps of the mesh, in m: a power of √2, so that cases with similar load,
/// deviation and reliefs have the same range. A deviation above the deflection lets the pairs lose
/// contact and move farther. Few motions need a larger range.
fn first_reach(inputs: &MeshInputs, solution: &Solution) -> f64 {
    const TIMES: f64 = 2.5;
    const TIMES_APART: f64 = 4.0;
    let deviation = &solution.deviation;
    let (deflection, error) = (deviation.loaded_deflection(), deviation.equivalent_error.abs());
    let times = if error > deflection { TIMES_APART } else { TIMES };
    let reach = times * (deflection + error + inputs.reliefs.sum());
    (0.5 * (2.0 * reach.log2()).ceil()).exp2()
}

/// The meshes of a pair with geometry, load and deviation of a solution, each with a larger range of
/// gaps than the one before. Every result uses the first mesh that is wide enough for it, because
/// the range changes its last digits.
pub(crate) struct Meshes<'a> {
    inputs: &'a MeshInputs,
    geometry: Geometry,
    /// F₀ in N, and the equivalent error in m.
    load: (f64, f64),
    /// A mesh of the same geometry.
    alike: Option<&'a Arc<Mesh>>,
    first_reach: f64,
    computed: Vec<Arc<Mesh>>,
}

impl<'a> Meshes<'a> {
    /// `alike` is a mesh of the same geometry, if known, and `same` one of the same inputs.
    pub(crate) fn new(
        inputs: &'a MeshInputs,
        solution: &Solution,
        alike: Option<&'a Arc<Mesh>>,
        same: Option<&Arc<Mesh>>,
    ) -> Meshes<'a> {
        let first_reach = first_reach(inputs, solution);
        let is_first = |mesh: &&Arc<Mesh>| mesh.reach.to_bits() == first_reach.to_bits();
        let computed = same.filter(is_first).cloned().into_iter().collect();
        let load = (solution.mesh_force, solution.deviation.equivalent_error);
        Meshes { inputs, geometry: solution.geometry, load, alike, first_reach, computed }
    }

    /// The result of `find` on the first mesh that is wide enough for it.
    ///
    /// # Errors
    /// Those of [`Mesh::new`] and of `find`.
    pub(crate) fn find<T>(
        &mut self,
        find: impl Fn(&Arc<Mesh>) -> Result<T, Refusal>,
    ) -> Result<T, Refusal> {
        let mut number = 0;
        loop {
            let mesh = self.mesh(number)?;
            match find(&mesh) {
                Err(Refusal::BeyondReach) if !mesh.is_whole => number += 1,
                found => return found,
            }
        }
    }

    fn mesh(&mut self, number: usize) -> Result<Arc<Mesh>, Refusal> {
        const FURTHER: f64 = 4.0;
        if let Some(mesh) = self.computed.get(number) {
            return Ok(Arc::clone(mesh));
        }
        let (geometry, load) = (&self.geometry, self.load);
        let last = self.computed.last();
        let reach = last.map_or(self.first_reach, |mesh| FURTHER * mesh.reach);
        let earlier = last.or(self.alike).map(|earlier| &**earlier);
        let mesh = Arc::new(Mesh::new(self.inputs, geometry, load, reach, earlier)?);
        self.computed.push(Arc::clone(&mesh));
        Ok(mesh)
    }

    /// The widest mesh, and whether it is another one than `same`, which stays if no result needs a
    /// wider one.
    ///
    /// # Errors
    /// Those of [`Mesh::new`].
    pub(crate) fn last(mut self, same: Option<Arc<Mesh>>) -> Result<(Arc<Mesh>, bool), Refusal> {
        match same {
            Some(same) if self.computed.len() <= 1 => Ok((same, false)),
            _ => {
                self.mesh(0)?;
                Ok((self.computed.swap_remove(self.computed.len() - 1), true))
            }
        }
    }
}

/// The result of a stage whose refusal does not affect other results.
pub(crate) fn late<T>(
    mesh: &Mesh,
    found: Result<T, Refusal>,
) -> Result<Result<T, Refusal>, Refusal> {
    match found {
        Err(Refusal::BeyondReach) if !mesh.is_whole => Err(Refusal::BeyondReach),
        found => Refusal::unless_stopped(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::dynamic::{Settings, dynamic};
    use crate::model::inputs::{Inputs, Method, ToothCompliance};
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};
    use crate::numeric::root;

    #[test]
    fn a_mesh_after_another_is_that_of_its_inputs_and_computes_only_what_changes() {
        let mut inputs = standard_pair(23, 31, 3e-3);
        (inputs.method, inputs.driven.tip_relief) = (Method::Static, 10e-6);
        let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
        let (first, geometry) = (solution.mesh.unwrap(), &solution.geometry);
        let (force, error, reach) = (first.force, first.error, first.reach);
        let mut eased = inputs.mesh();
        eased.reliefs.driven.tip = 15e-6;
        let faster = inputs.mesh().at_speed(2.0 * inputs.speed);
        for (name, inputs, force, error, reach, same) in [
            ("speed", faster, force, error, reach, [true, true, true]),
            ("deviation", inputs.mesh(), force, error + 2e-6, reach, [true, true, true]),
            ("relief", eased, force, error, reach, [true, true, false]),
            ("load", inputs.mesh(), 1.5 * force, error, reach, [true, false, false]),
            ("reach", inputs.mesh(), force, error, 2.0 * reach, [true, false, false]),
        ] {
            let mesh = Mesh::new(&inputs, geometry, (force, error), reach, Some(&first)).unwrap();
            let parts = [
                Arc::ptr_eq(&mesh.flanks, &first.flanks),
                mesh.couplings.as_ref().map(Arc::as_ptr)
                    == first.couplings.as_ref().map(Arc::as_ptr),
                Arc::ptr_eq(&mesh.zones, &first.zones),
            ];
            assert_eq!(parts, same, "{name}");
            assert!(mesh.couplings.is_some());
            let new = Mesh::new(&inputs, geometry, (force, error), reach, None).unwrap();
            assert!(mesh == new, "{name}");
        }
    }

    #[test]
    fn more_pairs_than_a_set_can_contain_are_refused() {
        assert_eq!(check_pairs(63.9), Ok(()));
        let refusal = check_pairs(64.0).unwrap_err();
        assert_eq!(refusal.code(), "too-many-pairs");
        assert_eq!(refusal.to_string(), "65 tooth pairs may touch at a time, and the limit is 64");
    }

    /// The back flank of a driver's tooth, turned with its working flank, crosses the other line of
    /// action at the place in the mesh.
    #[test]
    fn the_back_flanks_agree_with_turned_involutes() {
        for (teeth, shifts, more) in [
            ((20, 30), (0.0, 0.0), None),
            ((17, 43), (0.3, -0.1), None),
            ((25, 25), (0.1, 0.2), Some(0.6e-3)),
        ] {
            let mut inputs = standard_pair(teeth.0, teeth.1, 5e-3);
            inputs.method = Method::Static;
            inputs.tooth_compliance = Some(ToothCompliance::KUANG_YANG);
            (inputs.driver.profile_shift, inputs.driven.profile_shift) = shifts;
            let wide =
                solve(&inputs, Stages::of(Stage::Geometry)).unwrap().geometry.centre_distance;
            inputs.centre_distance = more.map(|more| wide + more);
            let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
            let (geometry, mesh) = (&solution.geometry, solution.mesh.as_ref().unwrap());
            let (base, working) = (geometry.driver.base, geometry.working_pressure_angle);
            let at_reference = (std::f64::consts::FRAC_PI_2
                + 2.0 * shifts.0 * inputs.pressure_angle.tan())
                / f64::from(teeth.0);
            let half = |radius: f64| {
                at_reference + involute(inputs.pressure_angle) - involute((base / radius).acos())
            };
            // A point of a line of action at a distance from N1: its radius and its angle.
            let point = |along: f64, side: f64| {
                let (sine, cosine) = working.sin_cos();
                let x = base * cosine + along * sine;
                let y = side * (along * cosine - base * sine);
                (x.hypot(y), y.atan2(x))
            };
            let s = 0.3 * mesh.length;
            let (radius, angle) = point(geometry.start + s, 1.0);
            let tooth = angle - half(radius);
            let crosses = |along: f64| {
                let (radius, angle) = point(along, -1.0);
                angle - (tooth - half(radius))
            };
            let along = root::between(1e-6, 4.0 * mesh.length, crosses);
            let way = along - geometry.start + 0.5 * geometry.backlash(&inputs.shape());
            let expected = mesh.length - way - s;
            let pitches = (mesh.back_place() - expected) / mesh.base_pitch;
            assert!((pitches - pitches.round()).abs() < 1e-9, "{teeth:?}: {pitches}");
        }
    }

    #[test]
    fn a_motion_beyond_the_computed_gaps_is_refused() {
        let inputs = Inputs {
            method: Method::Dynamic,
            base_pitch_deviation: 12e-6,
            ..standard_pair(20, 30, 5e-3)
        };
        let solution = solve(&inputs, Stages::of(Stage::Dynamic)).unwrap();
        let stations = &solution.dynamic.as_ref().unwrap().stations;
        let most = stations.iter().filter_map(crate::model::Station::transmission_error);
        let most = most.fold(0.0, f64::max) + solution.deviation.equivalent_error;
        let motion = |reach: f64| {
            let load = (solution.mesh_force, solution.deviation.equivalent_error);
            let mesh = Mesh::new(&inputs.mesh(), &solution.geometry, load, reach, None)?;
            let settings = Settings::of(&inputs, solution.reduced_mass);
            dynamic(&mesh, &settings, &|_| true)
        };
        assert_eq!(motion(0.95 * most).err(), Some(Refusal::BeyondReach));
        assert_eq!(motion(4.0 * most).err(), None);
    }
}
