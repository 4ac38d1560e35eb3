//! The motion against what is known of it: the linear oscillator, and the balance of energies.

use std::cell::Cell;

use super::motion::{Forces, Motion, State};
use super::watch::Watch;
use super::*;
use crate::model::inputs::{Inputs, Rung};
use crate::model::sample::standard_pair;
use crate::model::{Stage, Stages, solve};
use crate::numeric::ode::Equation;

/// A pair that strikes, its mesh, and how it is run.
fn struck(adjust: impl FnOnce(&mut Inputs)) -> (Mesh, Settings) {
    let mut inputs = standard_pair(20, 30, 5e-3);
    inputs.base_pitch_deviation = 12e-6;
    inputs.rung = Rung::Static;
    adjust(&mut inputs);
    let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
    let error = solution.deviation.equivalent_error;
    let mesh = Mesh::new(&inputs, &solution.geometry, solution.mesh_force, error, 1e-3).unwrap();
    let settings = Settings {
        mass: solution.reduced_mass,
        damping_ratio: inputs.damping_ratio,
        warmup_cycles: 5,
        tolerance: 1e-10,
        spacing: Spacing::Even(16),
    };
    (mesh, settings)
}

fn ran<'a>(motion: &'a Motion<'a>, settings: &Settings) -> Run<'a> {
    let mut run = Run::begin(motion, settings.tolerance).unwrap();
    while !run.is_over() {
        run.cross_window().unwrap();
    }
    run
}

/// While one pair of a stiffness that hardly changes touches, the motion is the damped oscillator's closed form.
#[test]
fn a_pair_of_constant_stiffness_swings_as_the_linear_oscillator() {
    // A rack of a gear pair: so large that neither stiffness nor place change within a few swings.
    let (mesh, settings) = struck(|inputs| inputs.speed = 1e-9);
    let motion = Motion::new(&mesh, &settings);
    let middle = 0.5 * mesh.length;
    let window = motion.window(middle, middle + 1e-9);
    let balance = static_load::balance(&mesh, middle, middle);
    let touching: Vec<i32> =
        mesh.pairs(middle, middle).filter(|pair| pair.place.gap < balance.displacement).map(|pair| pair.ahead).collect();
    let stiffness: f64 =
        mesh.pairs(middle, middle).filter(|pair| touching.contains(&pair.ahead)).map(|pair| pair.place.stiffness).sum();
    let evaluations = Cell::new(0);
    let forces = Forces::new(&motion, &window, window.touching(&touching).unwrap(), &evaluations);
    let start = motion.time(middle);
    let swing = 0.1 * balance.displacement;
    let frequency = (stiffness / settings.mass).sqrt();
    let decay = settings.damping_ratio * (mesh.mean_stiffness / settings.mass).sqrt();
    let damped = (frequency * frequency - decay * decay).sqrt();
    // The time itself is so large that its last digit would be felt; the equation sees only that the gears stand still.
    let mut point = Point::new(&forces, start, State::new(balance.displacement + swing, 0.0, 0.0));
    let length = 0.05 / frequency;
    for step in 1..=400 {
        point = Point { t: start, ..Point::new(&forces, start, forces.after(&point, length)) };
        let time = f64::from(step) * length;
        let (sine, cosine) = (damped * time).sin_cos();
        let expected = balance.displacement + swing * (-decay * time).exp() * (cosine + decay / damped * sine);
        assert!((point.y[0] - expected).abs() < 1e-10 * swing, "after {step} steps: {} and not {expected}", point.y[0]);
    }
}

/// Work of the mean force and of the moving mesh goes into motion, springs and damper.
#[test]
fn energies_balance_to_the_tolerance() {
    for (damping_ratio, torque) in [(0.07, 100.0), (0.0, 100.0), (0.02, 3.0), (0.3, 400.0)] {
        let (mesh, settings) = struck(|inputs| {
            inputs.damping_ratio = damping_ratio;
            inputs.drive = crate::model::inputs::Drive::Torque(torque);
            inputs.driven.tip_relief = 5e-6;
        });
        let motion = Motion::new(&mesh, &settings);
        let run = ran(&motion, &settings);
        let (unexplained, turned_over) = run.watch.energies(&motion, &mesh);
        assert!(unexplained < 1e-9 * turned_over, "damping {damping_ratio}: {unexplained:e} of {turned_over:e} J");
    }
}

impl Watch {
    /// What the energies leave unexplained over all kept steps, and how much energy was turned over, in J.
    fn energies(&self, motion: &Motion<'_>, mesh: &Mesh) -> (f64, f64) {
        let (mut unexplained, mut turned_over) = (0.0, 0.0);
        self.each_step(motion, |forces, from, length, to| {
            let stored = |t: f64, y: &State| forces.stored(t, y);
            let power = |after: f64| {
                let y = forces.after(from, after);
                let t = from.t + after;
                mesh.force * y[1] - forces.damped(t, &y) + forces.mesh_power(t, &y)
            };
            let put_in = length * crate::numeric::quadrature::unit_interval(|part| power(part * length));
            unexplained += stored(from.t + length, to) - stored(from.t, &from.y) - put_in;
            turned_over += put_in.abs();
        });
        (unexplained.abs(), turned_over)
    }
}

impl Forces<'_> {
    /// Energy of the motion and of the springs that touch, in J.
    fn stored(&self, t: f64, y: &State) -> f64 {
        let springs = (0..self.pairs()).filter(|&pair| self.touches(pair));
        let spring = |pair: usize| 0.5 * self.force(pair, t, y).0 * self.pressed(pair, t, y).0;
        0.5 * self.mass() * y[1] * y[1] + springs.map(spring).sum::<f64>()
    }

    /// Power of the damper, in W.
    fn damped(&self, t: f64, y: &State) -> f64 {
        // The equation itself says what the damper takes.
        let resting = State::new(y[0], 0.0, 0.0);
        self.mass() * y[1] * (self.slope(t, &resting)[1] - self.slope(t, y)[1])
    }

    /// Power that the moving mesh puts in: its gaps close on springs that are pressed, and its stiffness changes, in W.
    fn mesh_power(&self, t: f64, y: &State) -> f64 {
        let still = State::new(y[0], 0.0, 0.0);
        let power = |pair: usize| {
            let (force, rate) = self.force(pair, t, &still);
            let (pressed, closing) = self.pressed(pair, t, &still);
            // d(k p^2/2)/dt at rest is k p p' + k' p^2/2, and the rate of the force is k p' + k' p.
            0.5 * (rate * pressed + force * closing)
        };
        (0..self.pairs()).filter(|&pair| self.touches(pair)).map(power).sum()
    }
}

#[test]
fn no_peak_falls_between_two_stations() {
    for stations in [Some(8), Some(64), None] {
        let inputs = Inputs { stations, base_pitch_deviation: 30e-6, rung: Rung::Dynamic, ..standard_pair(20, 20, 5e-3) };
        let dynamic = solve(&inputs, Stages::EVERY).unwrap().dynamic.unwrap();
        let highest = dynamic.stations.iter().map(|station| station.force).fold(0.0, f64::max);
        assert!((highest / dynamic.peak_force - 1.0).abs() < 2e-3, "{highest} {}", dynamic.peak_force);
        assert!(dynamic.stations.is_sorted_by(|one, other| one.time < other.time));
    }
}
