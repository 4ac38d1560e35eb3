//! Method `dynamic` agrees with an independent computation, which shares only the mesh: equal steps of
//! the extrapolated midpoint rule, and contact changes found by checking each step.

use std::f64::consts::TAU;

use nalgebra::{SVector, Vector2};
use tipstrike::model::inputs::Method;
use tipstrike::model::mesh::Mesh;
use tipstrike::model::pair_forces::{Pair, PairSet, Touching};
use tipstrike::model::{Inputs, Refusal, Solution, Stage, Stages, solve};
use tipstrike::numeric::root;
use tipstrike::study::trade::Setting;

use crate::table;

/// With the finite elements, whose pairs are coupled, and the finest setting.
#[test]
fn two_ways_to_the_motion_agree() {
    let mut compared = 0;
    for path in table::cases() {
        let inputs = table::inputs(&path);
        let inputs = Setting::usual(Method::Dynamic, &inputs).best().inputs(&inputs);
        let Ok(solution) = solve(&inputs, Stages::of(Stage::Dynamic)) else { continue };
        let first = solution.dynamic.as_ref().expect("a motion");
        let second = match independent_solution(&inputs, &solution) {
            Err(Refusal::TooSlow { .. }) => continue,
            found => found.expect("a second motion"),
        };
        compared += 1;
        assert_eq!(first.first_contact_angle.is_some(), second.first_contact_angle.is_some());
        let angles = first.first_contact_angle.zip(second.first_contact_angle);
        for (first, second) in angles.into_iter().chain([
            (first.peak_force, second.peak_force),
            (first.peak_approach_force, second.peak_approach_force),
        ]) {
            let off = if first.to_bits() == second.to_bits() {
                0.0
            } else {
                (second - first).abs() / first.abs()
            };
            assert!(off < 1e-9, "{}: {first} {second} {off:e}", path.display());
        }
    }
    assert!(compared >= 6, "{compared}");
}

/// Displacement of the driver ahead in m and its rate in m/s.
type State = Vector2<f64>;

/// Results of the second computation, in SI.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Second {
    first_contact_angle: Option<f64>,
    peak_force: f64,
    peak_approach_force: f64,
}

/// Computes the case again, from the static balance to a base pitch after B.
fn independent_solution(inputs: &Inputs, solution: &Solution) -> Result<Second, Refusal> {
    const GROWTH: f64 = 16.0;
    let error = solution.deviation.equivalent_error;
    let mut reach = error.abs() + 4.0 * solution.deviation.loaded_deflection();
    loop {
        let mesh = Mesh::new(
            &inputs.mesh(),
            &solution.geometry,
            (solution.mesh_force, error),
            reach,
            None,
        )?;
        let mut run = Run::begin(&mesh, inputs, solution.reduced_mass)?;
        run.go();
        if run.most_ahead + error.max(0.0) < reach || mesh.is_whole() {
            return Ok(run.found());
        }
        reach *= GROWTH;
    }
}

/// The oscillator while the same pairs touch.
struct Oscillator<'a> {
    mesh: &'a Mesh,
    mass: f64,
    damping: f64,
    /// A place between two borders, which identifies the smooth section of the mesh.
    inside: f64,
    /// The touching pairs, each as its number of base pitches ahead.
    touching: Vec<i32>,
}

struct PairState {
    pairs: PairSet,
    touching: Touching,
    /// See [`PairSet::leads`].
    leads: Vec<f64>,
}

impl PairState {
    /// Margin of each pair against a change of contact, in m: approach of a touching pair, gap of a
    /// separated pair.
    fn margins(&self) -> impl Iterator<Item = f64> {
        let of = |(index, lead): (usize, &f64)| {
            if self.touching.has(index) { *lead } else { -lead }
        };
        self.leads.iter().enumerate().map(of)
    }

    /// Each touching pair with its force, in N.
    fn forces(&self) -> impl Iterator<Item = (&Pair, f64)> {
        let all = self.pairs.pairs().iter().zip(&self.leads).enumerate();
        all.filter(|(index, _)| self.touching.has(*index))
            .map(|(_, (pair, lead))| (pair, pair.stiffness * lead))
    }
}

impl Oscillator<'_> {
    fn place(&self, t: f64) -> f64 {
        t * self.mesh.speed
    }

    fn pair_state(&self, t: f64, displacement: f64) -> PairState {
        let pairs = self.mesh.pair_set(self.place(t), self.inside);
        let touches = |pair: &Pair| self.touching.contains(&pair.ahead);
        let touching = pairs.pairs().iter().enumerate().filter(|(_, pair)| touches(pair));
        let touching = touching.fold(Touching::NONE, |set, (index, _)| set.with(index));
        PairState { leads: pairs.leads(touching, displacement), pairs, touching }
    }

    /// The least margin of all pairs, in m.
    fn least_margin(&self, t: f64, y: &State) -> f64 {
        self.pair_state(t, y[0]).margins().fold(f64::INFINITY, f64::min)
    }

    /// Changes the contact of the pair with the least margin.
    fn change_contact(&mut self, t: f64, y: &State) -> Option<i32> {
        let state = self.pair_state(t, y[0]);
        let (index, _) =
            state.margins().enumerate().min_by(|one, other| one.1.total_cmp(&other.1))?;
        let changed = state.pairs.pairs()[index].ahead;
        match self.touching.iter().position(|&ahead| ahead == changed) {
            Some(at) => drop(self.touching.swap_remove(at)),
            None => self.touching.push(changed),
        }
        Some(changed)
    }

    /// Force of the incoming tooth, in N.
    fn force(&self, t: f64, y: &State) -> f64 {
        let state = self.pair_state(t, y[0]);
        let incoming = state.forces().find(|(pair, _)| pair.ahead == 0);
        incoming.map_or(0.0, |(_, force)| force.max(0.0))
    }
}

impl Equation<2> for Oscillator<'_> {
    fn slope(&self, t: f64, y: &State) -> State {
        let state = self.pair_state(t, y[0]);
        let carried: f64 = state.forces().map(|(pair, force)| pair.weight * force).sum();
        let damping = if self.touching.is_empty() { 0.0 } else { self.damping * y[1] };
        State::new(y[1], (self.mesh.force - carried - damping) / self.mass)
    }
}

/// An interval in which the same pairs touch, short compared with the period.
#[derive(Debug, Clone, Copy)]
struct Interval {
    t: f64,
    y: State,
    length: f64,
}

struct Run<'a> {
    oscillator: Oscillator<'a>,
    borders: Vec<f64>,
    t: f64,
    y: State,
    /// The longest interval, in s.
    longest: f64,
    first_touch: Option<f64>,
    peak_force: f64,
    peak_approach_force: f64,
    most_ahead: f64,
}

impl<'a> Run<'a> {
    fn begin(mesh: &'a Mesh, inputs: &Inputs, mass: f64) -> Result<Run<'a>, Refusal> {
        const INTERVALS_PER_PERIOD: f64 = 16.0;
        /// A run time of two or three seconds.
        const MOST_SWINGS: f64 = 8e3;
        let frequency = (mesh.mean_stiffness() / mass).sqrt();
        let start = -f64::from(inputs.warmup_cycles) * mesh.base_pitch;
        let swings = (mesh.length - start) / mesh.speed * frequency / TAU;
        if swings > MOST_SWINGS {
            return Err(Refusal::TooSlow { swings, limit: MOST_SWINGS });
        }
        let borders = mesh.borders(start, mesh.ends().1.min(mesh.length + mesh.base_pitch));
        let inside = f64::midpoint(borders[0], borders[1]);
        let pairs = mesh.pair_set(start, inside);
        let (displacement, forces) = pairs.shared(mesh.force);
        let carries = pairs.pairs().iter().zip(forces).filter(|(_, force)| *force > 0.0);
        let touching = carries.map(|(pair, _)| pair.ahead);
        Ok(Run {
            oscillator: Oscillator {
                mesh,
                mass,
                damping: 2.0 * inputs.damping_ratio * mass * frequency,
                inside,
                touching: touching.collect(),
            },
            borders,
            t: start / mesh.speed,
            y: State::new(displacement, 0.0),
            longest: TAU / (INTERVALS_PER_PERIOD * frequency),
            first_touch: None,
            peak_force: 0.0,
            peak_approach_force: 0.0,
            most_ahead: 0.0,
        })
    }

    /// Integrates from border to border.
    fn go(&mut self) {
        let mesh = self.oscillator.mesh;
        for at in 1..self.borders.len() {
            let (from, to) = (self.borders[at - 1], self.borders[at]);
            self.oscillator.inside = f64::midpoint(from, to);
            let end = to / mesh.speed;
            while self.t < end {
                self.advance(end);
            }
        }
    }

    /// Integrates one interval, at most to `end` and to the next change of a contact.
    fn advance(&mut self, end: f64) {
        let intervals = ((end - self.t) / self.longest).ceil().max(1.0);
        let whole = Interval { t: self.t, y: self.y, length: (end - self.t) / intervals };
        let change = self.next_contact_change(&whole);
        let interval = Interval { length: change.unwrap_or(whole.length), ..whole };
        self.watch(&interval);
        self.y = self.after(&interval, interval.length);
        self.most_ahead = self.most_ahead.max(self.y[0]);
        self.t = if change.is_none() && intervals < 1.5 { end } else { self.t + interval.length };
        if change.is_some() {
            let changed = self.oscillator.change_contact(self.t, &self.y);
            if changed == Some(0) && self.first_touch.is_none() {
                self.first_touch = Some(self.t);
            }
        }
    }

    /// Time of the next contact change, as far as checks at the middle and the end of the interval
    /// find it.
    fn next_contact_change(&self, interval: &Interval) -> Option<f64> {
        /// The margin of a pair that has just changed contact is 0 within rounding.
        const SHORTEST: f64 = 1e-9;
        let margin = |after: f64| {
            self.oscillator.least_margin(interval.t + after, &self.after(interval, after))
        };
        let checks = [SHORTEST * interval.length, 0.5 * interval.length, interval.length];
        let at = (0..checks.len()).find(|&at| margin(checks[at]) < 0.0)?;
        Some(if at == 0 { checks[0] } else { root::between(checks[at - 1], checks[at], margin) })
    }

    fn after(&self, interval: &Interval, length: f64) -> State {
        step(&self.oscillator, interval.t, &interval.y, length)
    }

    /// Updates the peak forces of the incoming tooth.
    fn watch(&mut self, interval: &Interval) {
        if !self.oscillator.touching.contains(&0) {
            return;
        }
        let peak = self.peak(interval);
        self.peak_force = self.peak_force.max(peak);
        // E is a border, within rounding.
        if interval.t + 0.5 * interval.length < 0.0 {
            self.peak_approach_force = self.peak_approach_force.max(peak);
        }
    }

    /// The greatest force in an interval. If the force rises first and falls later, the peak is
    /// found by a root of its slope.
    fn peak(&self, interval: &Interval) -> f64 {
        /// Half the step of the difference quotient, relative to the interval. A peak closer to an
        /// end of the interval is missed; its error is of second order.
        const STEP: f64 = 1e-5;
        let force =
            |after: f64| self.oscillator.force(interval.t + after, &self.after(interval, after));
        let slope = |after: f64| {
            let half_step = STEP * interval.length;
            force((after + half_step).min(interval.length)) - force((after - half_step).max(0.0))
        };
        let (start, end) = (force(0.0), force(interval.length));
        if slope(0.0) > 0.0 && slope(interval.length) < 0.0 {
            let top = root::between(0.0, interval.length, slope);
            return force(top).max(start).max(end);
        }
        start.max(end)
    }

    fn found(&self) -> Second {
        let mesh = self.oscillator.mesh;
        let angle = self.first_touch.map(|t| -self.oscillator.place(t) / mesh.base_radii.1);
        Second {
            first_contact_angle: angle.filter(|&angle| angle > 0.0),
            peak_force: self.peak_force,
            peak_approach_force: self.peak_approach_force,
        }
    }
}

/// An equation y' = f(t, y).
trait Equation<const N: usize> {
    /// f(t, y).
    fn slope(&self, t: f64, y: &SVector<f64, N>) -> SVector<f64, N>;
}

/// Number of extrapolations in a step. Each raises the order by two.
const COLUMNS: usize = 6;

/// The state after a step of `length` from the time `t` and the state `y`, of order 12.
///
/// # Formula
/// ```text
/// z1 = z0 + h f(t0, z0),   z(m+1) = z(m−1) + 2 h f(tm, zm),   h = length/n,   n = 2, 4 .. 12
/// T(j, k+1) = T(j, k) + (T(j, k) − T(j−1, k))/((n_j/n_(j−k−1))² − 1)
/// ```
///
/// # Source
/// Gragg's rule without smoothing, extrapolated by Aitken and Neville: Hairer, Norsett & Wanner
/// 1993, "Solving Ordinary Differential Equations I", section II.9.
fn step<const N: usize>(
    equation: &impl Equation<N>,
    t: f64,
    y: &SVector<f64, N>,
    length: f64,
) -> SVector<f64, N> {
    let slope = equation.slope(t, y);
    let mut row_before = [*y; COLUMNS];
    let mut best = *y;
    for row in 0..COLUMNS {
        let parts = 2 * (row + 1);
        best = midpoint(equation, t, (y, &slope), length, parts);
        for (column, before) in row_before.iter_mut().enumerate().take(row) {
            let ratio = parts as f64 / (2 * (row - column)) as f64;
            let better = best + (best - *before) / (ratio * ratio - 1.0);
            *before = best;
            best = better;
        }
        row_before[row] = best;
    }
    best
}

/// The midpoint rule with an even number of parts.
fn midpoint<const N: usize>(
    equation: &impl Equation<N>,
    t: f64,
    (y, slope): (&SVector<f64, N>, &SVector<f64, N>),
    length: f64,
    parts: usize,
) -> SVector<f64, N> {
    let part = length / parts as f64;
    let (mut before, mut here) = (*y, y + slope * part);
    for number in 1..parts {
        let next = before + equation.slope(t + number as f64 * part, &here) * (2.0 * part);
        (before, here) = (here, next);
    }
    here
}

/// y'' = 0.1 t - y; from (1, 0.1) on y = cos t + 0.1 t.
struct Swing;

impl Equation<2> for Swing {
    fn slope(&self, t: f64, y: &Vector2<f64>) -> Vector2<f64> {
        Vector2::new(y[1], -y[0] + 0.1 * t)
    }
}

fn error_after(steps: u32) -> f64 {
    let length = 6.0 / f64::from(steps);
    let start = Vector2::new(1.0, 0.1);
    let end =
        (0..steps).fold(start, |y, number| step(&Swing, f64::from(number) * length, &y, length));
    (end[0] - 6f64.cos() - 0.6).abs()
}

#[test]
fn halving_the_step_divides_the_error_by_two_to_the_twelfth() {
    let order = (error_after(3) / error_after(6)).log2();
    assert!((11.0..14.0).contains(&order), "order {order}");
    assert!(error_after(24) < 1e-14);
}
