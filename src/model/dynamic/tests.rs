//! Tests of the motion against the linear oscillator and the balance of energy.

use super::motion::{Course, Step};
use super::motion::{Motion, State};
use super::watch::Watch;
use super::*;
use crate::model::compliance::Teeth;
use crate::model::compliance::flanks::Flanks;
use crate::model::inputs::{Inputs, Method, ToothCompliance};
use crate::model::mesh::sharing::with_neighbours;
use crate::model::sample::standard_pair;
use crate::model::static_load;
use crate::model::stations::Spacing;
use crate::model::{Solution, Stage, Stages, solve};
use crate::numeric::polynomial::Polynomial;
use crate::numeric::quadrature;

/// A pair that strikes, with its static balance.
pub(super) fn at_rest(adjust: impl FnOnce(&mut Inputs)) -> (Inputs, Solution) {
    let mut inputs = standard_pair(20, 30, 5e-3);
    inputs.base_pitch_deviation = 12e-6;
    inputs.method = Method::Static;
    inputs.tooth_compliance = Some(ToothCompliance::KUANG_YANG);
    adjust(&mut inputs);
    let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
    (inputs, solution)
}

/// A pair that strikes, its mesh, and its settings.
fn struck(adjust: impl FnOnce(&mut Inputs)) -> (Mesh, Settings) {
    let (inputs, solution) = at_rest(adjust);
    let error = solution.deviation.equivalent_error;
    let mesh =
        Mesh::new(&inputs.mesh(), &solution.geometry, (solution.mesh_force, error), 1e-3, None)
            .unwrap();
    (mesh, settings(&inputs, solution.reduced_mass))
}

/// The pair with coupled teeth.
fn coupled(adjust: impl FnOnce(&mut Inputs)) -> (Mesh, Settings) {
    let (inputs, solution) = at_rest(adjust);
    let flanks =
        Flanks::new(&Teeth::of(&inputs.elasticity(), &solution.geometry).unwrap()).unwrap();
    let load = (solution.mesh_force, solution.deviation.equivalent_error);
    let scale = inputs.common_width() / solution.mesh.as_ref().unwrap().mean_stiffness();
    let by_radii = |rear: [f64; 2], front: [f64; 2], pitches| {
        let share = if pitches == 1 { 0.3 } else { 0.12 };
        let place = 40.0 * (rear[0] + 2.0 * front[1] - 0.2);
        share * scale * (1.0 + 0.4 * place.sin())
    };
    let mesh = with_neighbours(by_radii, |neighbours| {
        let parts = (&flanks.into(), Some(neighbours), None);
        Mesh::of_parts(&inputs.mesh(), &solution.geometry, parts, load, 1e-3).unwrap()
    });
    (mesh, settings(&inputs, solution.reduced_mass))
}

pub(super) fn settings(inputs: &Inputs, mass: f64) -> Settings {
    Settings {
        mass,
        damping_ratio: inputs.damping_ratio,
        warmup_cycles: 5,
        backlash: None,
        tolerance: 1e-10,
        spacing: Spacing::Even(16),
        approach_samples: 0,
    }
}

pub(super) fn ran<'a>(motion: &'a Motion<'a>, settings: &Settings, meter: &'a Meter) -> Run<'a> {
    let mut run = Run::begin(motion, settings.tolerance, meter).unwrap();
    while !run.is_over() {
        run.cross_window().unwrap();
    }
    run
}

#[test]
fn a_step_reuses_stiffness_and_load_of_the_base_pitch_before() {
    for (mesh, settings) in [struck(|_| ()), coupled(|_| ())] {
        let (motion, pitch) = (Motion::new(&mesh, &settings), mesh.base_pitch);
        let borders = mesh.borders(-4.0 * pitch, -3.0 * pitch);
        let taken = |pitches: f64, begins_even| {
            let [from, to] = [0, 1].map(|at| borders[at] + pitches * pitch);
            let window = motion.window(from, to).unwrap();
            let course = Course::new(&motion, &window, Touching::NONE.with(0));
            let (t, end) = (motion.time(from), motion.time(to));
            let taken = course.step(t, &State::new(2e-5, 0.0), end, (1.0, begins_even));
            taken.ok().unwrap()
        };
        let first = taken(0.0, true);
        let kept = motion.bytes();
        let [later, fresh] = [true, false].map(|begins_even| taken(1.0, begins_even));
        assert!(kept > 0 && motion.bytes() == kept);
        assert!((later.step.length / first.step.length - 1.0).abs() < 1e-9);
        let (later, fresh) = (later.step.state(1.0), fresh.step.state(1.0));
        assert!((later - fresh).norm() <= 1e-10 * fresh.norm());
    }
}

/// With one touching pair of nearly constant stiffness, the motion is the closed form of the damped
/// oscillator.
#[test]
fn a_pair_of_constant_stiffness_follows_the_linear_oscillator() {
    // The speed is so low that neither stiffness nor place change within a few oscillations.
    let (mesh, settings) = struck(|inputs| inputs.speed = 1e-9);
    let motion = Motion::new(&mesh, &settings);
    let middle = 0.5 * mesh.length;
    let window = motion.window(middle, middle + 1e-9).unwrap();
    let balance = static_load::balance(&mesh, middle, middle);
    let pairs = mesh.pair_set(middle, middle);
    let touching: Vec<PairName> = pairs
        .pairs()
        .iter()
        .filter(|pair| pair.gap < balance.displacement)
        .map(|pair| PairName::working(pair.ahead))
        .collect();
    let stiffness: f64 = pairs
        .pairs()
        .iter()
        .filter(|pair| touching.contains(&PairName::working(pair.ahead)))
        .map(|pair| pair.stiffness)
        .sum();
    let course = Course::new(&motion, &window, window.touching(&touching).unwrap());
    let start = motion.time(middle);
    let swing = 0.1 * balance.displacement;
    let frequency = (stiffness / settings.mass).sqrt();
    let decay = settings.damping_ratio * (mesh.mean_stiffness() / settings.mass).sqrt();
    let damped = (frequency * frequency - decay * decay).sqrt();
    let (mut y, mut time) = (State::new(balance.displacement + swing, 0.0), 0.0);
    let allowed = 1e-13 * balance.displacement;
    // At large times the last digit of the time has an effect. In the equation the gears stand
    // still.
    for number in 1..=20 {
        let taken = course.step(start, &y, start + 1.0, (allowed, true));
        let step = taken.ok().unwrap().step;
        assert!(step.length * frequency > 1.0, "step {number} is short");
        for part in [0.25, 0.5, 0.75, 1.0] {
            let time = time + part * step.length;
            let (sine, cosine) = (damped * time).sin_cos();
            let expected = balance.displacement
                + swing * (-decay * time).exp() * (cosine + decay / damped * sine);
            let found = step.state(part)[0];
            assert!(
                (found - expected).abs() < 1e-10 * swing,
                "step {number}: {found} and not {expected}"
            );
        }
        (y, time) = (step.state(1.0), time + step.length);
    }
}

/// The work of the mean force and of the moving mesh equals the energy of motion, springs, damper
/// and friction.
#[test]
fn energies_balance_to_the_tolerance() {
    for (damping_ratio, torque, friction) in [
        (0.07, 100.0, 0.0),
        (0.0, 100.0, 0.0),
        (0.02, 3.0, 0.0),
        (0.3, 400.0, 0.0),
        (0.07, 100.0, 0.08),
        (0.0, 30.0, 0.2),
    ] {
        let adjust = |inputs: &mut Inputs| {
            inputs.damping_ratio = damping_ratio;
            inputs.friction_coefficient = Some(friction);
            inputs.drive = crate::model::inputs::Drive::Torque(torque);
            inputs.driven.tip_relief = 5e-6;
        };
        for (teeth, (mesh, settings)) in [("alone", struck(adjust)), ("coupled", coupled(adjust))] {
            let motion = Motion::new(&mesh, &settings);
            let meter = Meter::new(MOTION_WORK);
            let run = ran(&motion, &settings, &meter);
            let (unexplained, turned_over) = run.watch.energies(&motion, &mesh);
            let text = format!(
                "teeth {teeth}, damping {damping_ratio}, friction {friction}: {unexplained:e} of \
                 {turned_over:e} J"
            );
            assert!(unexplained < 1e-9 * turned_over, "{text}");
        }
    }
}

/// At low speed the forces are those of the static balance of coupled pairs.
#[test]
fn slow_coupled_gears_carry_the_static_load() {
    let (mesh, settings) = coupled(|inputs| {
        inputs.speed /= 2000.0;
        inputs.damping_ratio = 0.5;
    });
    let settings = Settings { warmup_cycles: 1, tolerance: 1e-8, ..settings };
    let moved = dynamic(&mesh, &settings, &|_| true).unwrap();
    let still = static_load::static_load(&mesh, settings.spacing).unwrap();
    let (moving, resting) =
        (moved.first_contact_angle.unwrap(), still.first_contact_angle.unwrap());
    assert!((moving / resting - 1.0).abs() < 1e-2, "{moving} {resting}");
    assert!((moved.peak_force / still.peak_force - 1.0).abs() < 1e-2, "{moved:?} {still:?}");
}

/// A motion stops at its limit of work. The refusal has the number of steps and the computed part.
#[test]
fn a_motion_that_exceeds_its_work_is_refused_with_what_is_done() {
    let (mesh, settings) = struck(|_| ());
    let meter = Meter::new(300);
    let refused = approach(&mesh, &settings, &meter, &|_| true).unwrap_err();
    let Refusal::MotionTooLong { steps, done } = refused else {
        panic!("{refused}");
    };
    assert!(steps > 20 && done > 0.0 && done < 1.0, "{refused}");
    assert!(meter.spent() < 300 + 64, "{}", meter.spent());
    let sentence = format!("the limit of {steps} steps");
    assert!(refused.to_string().contains(&sentence), "{refused}");
}

impl Watch {
    /// The unexplained energy over all stored steps, and the converted energy, in J.
    pub(super) fn energies(&self, motion: &Motion<'_>, mesh: &Mesh) -> (f64, f64) {
        let (mut unexplained, mut turned_over) = (0.0, 0.0);
        for (course, _, step) in self.steps(motion) {
            let put_in =
                step.length * over_halves(3, &|part| course.power(motion, mesh, step, part));
            unexplained +=
                course.stored(motion, step, 1.0) - course.stored(motion, step, 0.0) - put_in;
            turned_over += put_in.abs();
        }
        (unexplained.abs(), turned_over)
    }
}

/// ∫ of `f` from 0 to 1, with repeated halving.
fn over_halves(times: u32, f: &dyn Fn(f64) -> f64) -> f64 {
    if times == 0 {
        return quadrature::unit_interval(f);
    }
    0.5 * (over_halves(times - 1, &|part| f(0.5 * part))
        + over_halves(times - 1, &|part| f(0.5 + 0.5 * part)))
}

impl Course<'_> {
    /// Energy of the motion and of the loaded springs, in J.
    fn stored(&self, motion: &Motion<'_>, step: &Step, part: f64) -> f64 {
        let (t, y) = (step.t + part * step.length, step.state(part));
        let springs = (0..self.pairs()).filter(|&pair| self.touches(pair));
        let spring = |pair: usize| {
            let (side, index) = self.side_of(pair);
            let overlap = side.sign * y[0] - side.gap(index, motion.place(t));
            0.5 * self.force(pair, t, y[0]) * overlap
        };
        0.5 * motion.mass * y[1] * y[1] + springs.map(spring).sum::<f64>()
    }

    /// Power from the mean force, the moving mesh and friction minus the damping power, in W.
    fn power(&self, motion: &Motion<'_>, mesh: &Mesh, step: &Step, part: f64) -> f64 {
        let rate = step.state(part)[1];
        let touching = (0..self.pairs()).filter(|&pair| self.touches(pair));
        let moved = touching.clone().map(|pair| self.mesh_power(pair, step, part)).sum::<f64>();
        let damped = if touching.clone().count() > 0 { motion.damping * rate * rate } else { 0.0 };
        let rubbed =
            touching.clone().map(|pair| self.friction(pair, step, part)).sum::<f64>() * rate;
        mesh.force * rate - damped + moved + rubbed
    }

    /// Contribution of friction at a pair to the driving force, in N.
    fn friction(&self, pair: usize, step: &Step, part: f64) -> f64 {
        let (side, index) = self.side_of(pair);
        let (s, way) = self.way_of(step);
        let turning = side.turning(&side.pairs[index], &Polynomial([1.0]), s, way);
        side.sign * (1.0 - turning.at(part)) * self.force_along(pair, step).at(part)
    }

    /// Power from the moving mesh at a pair, in W: its gap closes on a loaded spring, and its
    /// stiffness changes.
    fn mesh_power(&self, pair: usize, step: &Step, part: f64) -> f64 {
        // At a fixed displacement d(k p²/2)/dt is k p p' + k' p²/2, and the rate of the force is k
        // p' + k' p.
        let still =
            Step { ahead: Polynomial::ZERO.plus(step.ahead.at(part), &Polynomial([1.0])), ..*step };
        let force = self.force_along(pair, &still);
        let (side, index) = self.side_of(pair);
        let (s, way) = self.way_of(step);
        let [_, gap] = side.spring_along(&side.pairs[index], s, way);
        let pressed = side.sign * still.ahead.0[0] - gap.at(part);
        0.5 * (force.slope(part) * pressed - force.at(part) * gap.slope(part)) / step.length
    }
}

#[test]
fn the_stations_include_every_peak() {
    for stations in [Some(8), Some(64), None] {
        let inputs = Inputs {
            stations,
            base_pitch_deviation: 30e-6,
            method: Method::Dynamic,
            ..standard_pair(20, 20, 5e-3)
        };
        let dynamic = solve(&inputs, Stages::EVERY).unwrap().dynamic.unwrap();
        let highest = dynamic.stations.iter().map(|station| station.force).fold(0.0, f64::max);
        assert!(
            (highest / dynamic.peak_force - 1.0).abs() < 2e-3,
            "{highest} {}",
            dynamic.peak_force
        );
        assert!(dynamic.stations.is_sorted_by(|one, other| one.time() < other.time()));
    }
}

#[test]
fn an_impact_ends_at_a_valley_and_not_at_a_ripple() {
    let most = |forces: &[f64]| forces.iter().copied().fold(0.0, f64::max);
    let valley = |forces: &[f64]| first_valley(forces.iter().copied(), most(forces));
    assert_eq!(valley(&[0.0, 5.0, 10.0, 9.95, 12.0, 6.0, 6.05, 5.5, 7.0]), Some(7));
    assert_eq!(valley(&[0.0, 3.0, 0.0, 0.0, 2.0]), Some(2));
    // Where contact is lost the force is 0 but for its rounding.
    assert_eq!(valley(&[0.0, 3.0, 1e-13, 0.0, 2.0]), Some(2));
    assert_eq!(valley(&[0.0, 1.0, 2.0]), None);
}
