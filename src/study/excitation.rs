//! The mesh as the excitation of another solver: stiffness, transmission error and forces at rest over
//! one base pitch, as Fourier series, and over the passage of the incoming tooth.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::sync::Arc;

use crate::model::dynamic::Settings;
use crate::model::inputs::{GearSide, Method};
use crate::model::masses::Inertia;
use crate::model::pair_forces::{PairSet, Touching};
use crate::model::slices::Face;
use crate::model::slices::balance::Until;
use crate::model::static_load::pieces;
use crate::model::{Geometry, Inputs, Mesh, Refusal, Solution, Stage, Stages, solve};
use crate::numeric::{quadrature, steps};

/// Number of values of a [`Sample`].
pub const VALUES: usize = 6;
/// Place of a value in a sample.
pub const STIFFNESS: usize = 0;
const ERROR: usize = 1;
const DISPLACEMENT: usize = 2;

/// Least, usual and greatest number of places in a base pitch.
pub const POINTS: [usize; 3] = [8, 256, 4096];
/// Number of harmonics of a Fourier series, the mean excluded.
pub const ORDERS: usize = 20;

/// The balance at rest at one place of the incoming pair.
///
/// # Formula
/// ```text
/// k = d(Σ w_k F_k)/dx,   e = x − F0/k,   Σ w_k F_k ≈ k (x − e) near the balance
/// k_0 = dF_0/dx,         F_0 ≈ F_0 + k_0 (x − x_rest) of the incoming tooth
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Path of the incoming pair since E along the line of action, in m.
    pub way: f64,
    /// In order: mesh stiffness k, in N/m; displacement of the driver ahead x (the loaded
    /// transmission error), in m; displacement excitation e, in m; sum of the forces of all pairs,
    /// in N; stiffness k_0, in N/m, and force F_0, in N, of the incoming tooth.
    pub values: [f64; VALUES],
    /// Of each pair of [`Excitation::pairs`] the displacement at which it begins to carry, in m, and
    /// the stiffness that it adds to the mesh and to the incoming tooth from there on, in N/m.
    pub springs: Vec<Spring>,
}

/// Gap in m, and stiffness for the mesh and for the incoming tooth, in N/m.
pub type Spring = [f64; 3];

/// The mesh at rest as an excitation, with all that an equation of motion needs.
///
/// # Formula
/// ```text
/// m x'' + c x' + Σ_j k_j(t) max(0, x − g_j(t)) = F0,   x = rb1 φ1 − rb2 φ2
/// m x'' + c x' + k(t) (x − e(t)) = F0 linear about the balance at rest
/// J1 φ1'' = T1 − rb1 F,   J2 φ2'' = rb2 F − T2,   1/m = rb1²/J1 + rb2²/J2,   c = 2 ζ √(k_m m)
/// ```
/// Both angles count in the direction of rotation of their gear.
///
/// # Source
/// The balance of [`static_load`](crate::model::static_load::static_load); the oscillator of
/// [`dynamic`](crate::model::dynamic::dynamic). The force is linear between the displacements at
/// which pairs begin to carry, also if a force displaces the other pairs.
///
/// # Valid for
/// Displacements up to four times the greatest one at rest, within the range of the mesh that
/// `dynamic` needs. In the linear equation pairs gain and lose contact where they do at rest.
#[derive(Debug, Clone)]
pub struct Excitation {
    /// The pairs with springs, as base pitches ahead of the incoming pair. A pair in slices has one
    /// spring for the whole mesh, linear about the balance at rest.
    pub pairs: Vec<i32>,
    /// One base pitch of equal pairs, from E on.
    pub period: Vec<Sample>,
    /// Whole base pitches around the passage of the incoming tooth, which alone deviates.
    pub passage: Vec<Sample>,
    /// Coefficients of cosine and sine of each value of `period` and each order, from the mean on:
    /// v(t) = Σ a_n cos(2 π n f_z t) + b_n sin(2 π n f_z t), with t = 0 at E.
    pub harmonics: Vec<[[f64; 2]; VALUES]>,
    /// p_b, in m.
    pub base_pitch: f64,
    /// Base radii of driver and driven gear, in m.
    pub base_radii: [f64; 2],
    /// Moments of inertia of driver and driven gear, in kg m².
    pub inertias: [f64; 2],
    /// Mass at the line of action m, in kg.
    pub mass: f64,
    /// c, in N s/m.
    pub damping: f64,
    /// Mean stiffness of the mesh on the line of action k_m, which the damping uses, in N/m.
    pub stiffness: f64,
    /// F0, in N.
    pub force: f64,
    /// Speed of the driver, in rad/s.
    pub speed: f64,
}

impl Excitation {
    /// The excitation of a pair, with `points` places in a base pitch.
    ///
    /// # Errors
    /// The refusal of method `static`; [`Refusal::Stopped`] if `go_on` returns false.
    pub fn of(
        inputs: &Inputs,
        points: usize,
        go_on: &dyn Fn(usize, usize) -> bool,
    ) -> Result<Excitation, Refusal> {
        let inputs = Inputs { method: Method::Static, ..inputs.clone() };
        let wanted = Stages::of(Stage::Static).and(Stages::of(Stage::StaticSpectrum));
        let solution = solve(&inputs, wanted)?;
        if let Some(Err(refusal)) = solution.static_spectrum {
            return Err(refusal);
        }
        let Some(mesh) = mesh(&inputs, &solution) else { return Err(Refusal::BeyondReach) };
        let pair = At::of(&inputs, &solution.geometry, mesh)?;
        let pitch = pair.mesh.base_pitch;
        let (first, last) = pitches(&solution, pitch);
        let of_passage = (last - first) as usize * points;
        let total = points + of_passage + 1;
        let sample = |number: usize, from: f64, step: usize, deviates: bool| {
            if !go_on(number, total) {
                return Err(Refusal::Stopped);
            }
            let way = pitch * (from + step as f64 / points as f64);
            Ok(Sample { way, values: pair.at(way, deviates)?, springs: Vec::new() })
        };
        let period = (0..points).map(|step| sample(step, 0.0, step, false));
        let mut period = period.collect::<Result<Vec<Sample>, Refusal>>()?;
        let passage = (0..=of_passage).map(|step| sample(points + step, first, step, true));
        let mut passage = passage.collect::<Result<Vec<Sample>, Refusal>>()?;
        let pairs = pair.add_springs(&mut period, &mut passage);
        let Geometry { driver, driven, .. } = &solution.geometry;
        let inertias = [
            Inertia::of(&inputs, GearSide::Driver, driver)?.moment,
            Inertia::of(&inputs, GearSide::Driven, driven)?.moment,
        ];
        let settings = Settings::of(&inputs, solution.reduced_mass);
        let stiffness = pair.mesh.mean_stiffness();
        Ok(Excitation {
            pairs,
            period,
            passage,
            harmonics: pair.harmonics()?,
            base_pitch: pitch,
            base_radii: [driver.base, driven.base],
            inertias,
            mass: settings.mass,
            damping: 2.0 * settings.damping_ratio * (stiffness * settings.mass).sqrt(),
            stiffness,
            force: solution.mesh_force,
            speed: inputs.speed,
        })
    }

    /// Time of a base pitch, in s.
    pub fn mesh_period(&self) -> f64 {
        self.base_pitch / (self.speed * self.base_radii[0])
    }
}

/// The first and the last border between base pitches around the passage of the incoming tooth, in
/// base pitches after E.
fn pitches(solution: &Solution, pitch: f64) -> (f64, f64) {
    let base = solution.geometry.driver.base;
    let ends = solution.static_load.as_ref().map(|load| &load.stations);
    let ends = ends.and_then(|all| Some([all.first()?, all.last()?]));
    let length = solution.geometry.end - solution.geometry.start;
    let [first, last] = ends
        .map_or([0.0, length], |ends| ends.map(|station| 0.0 - station.roll_angle_driver * base));
    ((first / pitch).floor().min(-1.0), (last / pitch).ceil())
}

/// The mesh in the range that the motion needs, otherwise that of the load at rest.
fn mesh(inputs: &Inputs, at_rest: &Solution) -> Option<Arc<Mesh>> {
    let inputs = Inputs { method: Method::Dynamic, ..inputs.clone() };
    let is_spur = inputs.face().is_none();
    let moving = is_spur.then(|| solve(&inputs, Stages::of(Stage::Dynamic)).ok()).flatten();
    moving.and_then(|solution| solution.mesh).or_else(|| at_rest.mesh.clone())
}

/// The pair at any place.
struct At {
    mesh: Arc<Mesh>,
    /// The mesh of equal pairs.
    equal: Mesh,
    /// The face width in slices.
    face: Option<Face>,
}

impl At {
    fn of(inputs: &Inputs, geometry: &Geometry, mesh: Arc<Mesh>) -> Result<At, Refusal> {
        let face = inputs.face().map(|face| Face::new(&face, geometry, &mesh)).transpose()?;
        Ok(At { equal: mesh.without_error(), mesh, face })
    }

    /// A place slightly behind another one, on the next side of a border.
    fn beside(&self, s: f64) -> f64 {
        const BESIDE: f64 = 1e-9;
        s + BESIDE * self.mesh.base_pitch
    }

    /// The values with the incoming pair at a place, on the side behind it.
    fn at(&self, s: f64, deviates: bool) -> Result<[f64; VALUES], Refusal> {
        let mesh = if deviates { &self.mesh } else { &self.equal };
        let mut values = match &self.face {
            Some(face) => over_face(face, mesh, s)?,
            None => in_plane(mesh, s, self.beside(s)),
        };
        values[DISPLACEMENT] = values[ERROR] - mesh.force / values[STIFFNESS];
        let is_finite = values.iter().all(|value| value.is_finite());
        if is_finite { Ok(values) } else { Err(Refusal::BeyondReach) }
    }

    /// Adds the springs to the samples. Returns their pairs.
    fn add_springs(&self, period: &mut [Sample], passage: &mut [Sample]) -> Vec<i32> {
        /// Displacements that a motion may reach, in greatest displacements at rest.
        const TIMES: f64 = 4.0;
        if self.face.is_some() {
            for sample in period.iter_mut().chain(passage) {
                let [stiffness, _, gap, _, _, tooth] = sample.values;
                let part = tooth / self.mesh.force;
                sample.springs = vec![[gap, stiffness, stiffness * part]];
            }
            return vec![0];
        }
        let displacements = period.iter().chain(&*passage).map(|sample| sample.values[ERROR]);
        let most = TIMES * displacements.fold(0.0, f64::max);
        let parts = [(&self.equal, &*period), (&*self.mesh, &*passage)];
        let of = |(mesh, samples): (&Mesh, &[Sample])| {
            let samples = samples.iter().map(|sample| sample.way);
            samples.map(|s| springs(mesh, s, self.beside(s), most)).collect::<Vec<_>>()
        };
        let found = parts.map(of);
        let pairs: BTreeSet<i32> =
            found.iter().flatten().flatten().map(|(ahead, _)| *ahead).collect();
        for (samples, found) in [period, passage].into_iter().zip(found) {
            for (sample, found) in samples.iter_mut().zip(found) {
                let of_pair = |pair: &i32| {
                    let own = found.iter().find(|(ahead, _)| ahead == pair);
                    own.map_or([most, 0.0, 0.0], |(_, spring)| *spring)
                };
                sample.springs = pairs.iter().map(of_pair).collect();
            }
        }
        pairs.into_iter().collect()
    }

    /// The places between which the same pairs carry, over a base pitch of equal pairs.
    fn cuts(&self) -> Vec<f64> {
        const LOOKS: usize = 16;
        let (mesh, pitch) = (&self.equal, self.equal.base_pitch);
        if self.face.is_some() {
            return steps(0.0, pitch, LOOKS).collect();
        }
        let borders = mesh.borders(0.0, pitch);
        let between =
            |ends: &[f64]| pieces(mesh, (ends[0], ends[1]), f64::midpoint(ends[0], ends[1]));
        let mut cuts: Vec<f64> = borders.windows(2).flat_map(between).collect();
        cuts.dedup();
        cuts
    }

    /// The Fourier series of all values of equal pairs. Between two cuts each value is smooth.
    fn harmonics(&self) -> Result<Vec<[[f64; 2]; VALUES]>, Refusal> {
        /// Quadrature intervals in a base pitch, which resolve the highest order.
        const INTERVALS: f64 = 16.0;
        let pitch = self.equal.base_pitch;
        let mut sums = vec![[[0.0; 2]; VALUES]; ORDERS + 1];
        for ends in self.cuts().windows(2) {
            let length = ends[1] - ends[0];
            let count = (INTERVALS * length / pitch).ceil().max(1.0);
            for interval in 0..count as u32 {
                for (node, weight) in quadrature::nodes() {
                    let s = ends[0] + length * (f64::from(interval) + node) / count;
                    let values = self.at(s, false)?;
                    for (order, sum) in sums.iter_mut().enumerate() {
                        let twice = if order == 0 { 1.0 } else { 2.0 };
                        let height = twice * weight * length / (count * pitch);
                        let (sine, cosine) = (TAU * order as f64 * s / pitch).sin_cos();
                        for ([a, b], value) in sum.iter_mut().zip(values) {
                            *a += height * value * cosine;
                            *b += height * value * sine;
                        }
                    }
                }
            }
        }
        Ok(sums)
    }
}

/// The values of a spur pair; on a border of the mesh `inside` selects the side.
fn in_plane(mesh: &Mesh, s: f64, inside: f64) -> [f64; VALUES] {
    let pairs = mesh.pair_set(s, inside);
    let (displacement, forces) = pairs.shared(mesh.force);
    let carries = (0..forces.len()).filter(|&at| forces[at] > 0.0);
    let touching = carries.fold(Touching::NONE, Touching::with);
    let [stiffness, of_tooth] = stiffnesses(&pairs, touching);
    let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0);
    let force = incoming.map_or(0.0, |at| forces[at]);
    [stiffness, displacement, 0.0, forces.iter().sum(), of_tooth, force]
}

/// Slope and value at 0 of the lead of each pair over the displacement.
fn leads(pairs: &PairSet, touching: Touching) -> Vec<[f64; 2]> {
    if touching.is_none() {
        return pairs.pairs().iter().map(|pair| [1.0, 0.0 - pair.gap]).collect();
    }
    let [held, moved] = [0.0, 1.0].map(|x| pairs.leads(touching, x));
    held.into_iter().zip(moved).map(|(held, moved)| [moved - held, held]).collect()
}

/// Stiffness of the mesh and of the incoming tooth, in N/m.
fn stiffnesses(pairs: &PairSet, touching: Touching) -> [f64; 2] {
    let mut sum = [0.0; 2];
    let all = pairs.pairs().iter().zip(leads(pairs, touching)).enumerate();
    for (_, (pair, [slope, _])) in all.filter(|&(at, _)| touching.has(at)) {
        let stiffness = slope * pair.stiffness;
        sum[0] += pair.weight * stiffness;
        if pair.ahead == 0 {
            sum[1] = stiffness;
        }
    }
    sum
}

/// The springs of the pairs that begin to carry up to the displacement `most`, each by its pair.
fn springs(mesh: &Mesh, s: f64, inside: f64, most: f64) -> Vec<(i32, Spring)> {
    let pairs = mesh.pair_set(s, inside);
    let (mut touching, mut before, mut found) = (Touching::NONE, [0.0; 2], Vec::new());
    loop {
        let known = leads(&pairs, touching);
        let apart = (0..known.len()).filter(|&at| !touching.has(at));
        let gaps = apart.map(|at| (0.0 - known[at][1] / known[at][0], at));
        let next =
            gaps.filter(|(gap, _)| *gap <= most).min_by(|one, other| one.0.total_cmp(&other.0));
        let Some((gap, at)) = next else { return found };
        touching = touching.with(at);
        let now = stiffnesses(&pairs, touching);
        found.push((pairs.pairs()[at].ahead, [gap, now[0] - before[0], now[1] - before[1]]));
        before = now;
    }
}

/// The values of a pair in slices.
fn over_face(face: &Face, mesh: &Mesh, s: f64) -> Result<[f64; VALUES], Refusal> {
    /// Of the displacement.
    const STEP: f64 = 1e-5;
    let loads = face.loads(s, mesh.error, Until::Force(mesh.force))?;
    let x = loads.displacement;
    let further = face.loads(s, mesh.error, Until::Displacement(x * (1.0 + STEP)))?;
    let tooth = face.pair_force(&loads, 0);
    let force = loads.pairs.all().map(|ahead| face.pair_force(&loads, ahead)).sum();
    let of_tooth = (face.pair_force(&further, 0) - tooth) / (x * STEP);
    Ok([loads.stiffness, x, 0.0, force, of_tooth, tooth])
}
