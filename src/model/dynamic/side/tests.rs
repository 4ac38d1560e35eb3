//! Tests of the motion across the backlash against steps without events on an independent mesh, and
//! by the balance of energy.

use crate::model::compliance::Teeth;
use crate::model::compliance::flanks::Flanks;
use crate::model::dynamic::motion::{Motion, State};
use crate::model::dynamic::steady::steady;
use crate::model::dynamic::tests::{at_rest, ran, settings};
use crate::model::dynamic::*;
use crate::model::inputs::{Drive, Inputs};
use crate::model::mesh::MeshInputs;
use crate::model::mesh::sharing::with_neighbours;
use crate::model::pair_forces::PairSet;
use crate::model::static_load;
use crate::model::{Stage, Stages, solve};

/// A pair that rattles, with mesh and settings. The mesh of its back flanks comes from swapped
/// gears.
struct Rattling {
    mesh: Mesh,
    back: Mesh,
    settings: Settings,
}

/// A change of a case.
type Adjust<'a> = &'a dyn Fn(&mut Inputs);

/// Four pairs: independent springs and coupled springs, with reliefs and unequal gears.
fn rattling() -> Vec<(&'static str, Rattling)> {
    let light = |inputs: &mut Inputs| {
        inputs.drive = Drive::Torque(3.0);
        inputs.damping_ratio = 0.03;
    };
    let springs = of_case(false, 6e-6, &|inputs| {
        light(inputs);
        inputs.speed *= 1.7;
    });
    let coupled = of_case(true, 9e-6, &|inputs| {
        light(inputs);
        inputs.speed *= 2.5;
    });
    let relieved = of_case(false, 4e-6, &|inputs| {
        light(inputs);
        inputs.driven.tip_relief = 5e-6;
        inputs.driver.tip_relief = 8e-6;
        inputs.driver.tip_relief_length = Some(2e-3);
    });
    let shifted = of_case(true, 3e-6, &|inputs| {
        light(inputs);
        inputs.driver.profile_shift = 0.3;
        inputs.driven.profile_shift = -0.1;
        inputs.driven.teeth = 37;
    });
    vec![
        ("springs", springs),
        ("coupled", coupled),
        ("reliefs", relieved),
        ("shifted, coupled", shifted),
    ]
}

fn of_case(couples: bool, backlash: f64, adjust: Adjust<'_>) -> Rattling {
    let (inputs, solution) = at_rest(adjust);
    let error = solution.deviation.equivalent_error;
    let swapped = Inputs {
        driver: inputs.driven,
        driven: inputs.driver,
        speed: inputs.driven_speed(),
        ..inputs.clone()
    };
    let swapped_geometry = solve(&swapped, Stages::of(Stage::Geometry)).unwrap().geometry;
    let of = |inputs: &MeshInputs, geometry, error, turned: bool| {
        let flanks = Flanks::new(&Teeth::of(&inputs.elasticity, geometry).unwrap()).unwrap();
        let by_radii = |rear: [f64; 2], front: [f64; 2], pitches| {
            // In the mirror the rear pair is the front pair, and the gears are swapped.
            let radii = if turned { [front[1], rear[0]] } else { [rear[0], front[1]] };
            let share = if pitches == 1 { 8e-10 } else { 3e-10 };
            let place = 40.0 * (radii[0] + 2.0 * radii[1] - 0.2);
            share * inputs.elasticity.width * (1.0 + 0.4 * place.sin())
        };
        let load = (solution.mesh_force, error);
        let flanks = flanks.into();
        if couples {
            with_neighbours(by_radii, |neighbours| {
                let parts = (&flanks, Some(neighbours), None);
                Mesh::of_parts(inputs, geometry, parts, load, 1e-3).unwrap()
            })
        } else {
            Mesh::new(inputs, geometry, load, 1e-3, None).unwrap()
        }
    };
    Rattling {
        mesh: of(&inputs.mesh(), &solution.geometry, error, false),
        back: of(&swapped.mesh(), &swapped_geometry, 0.0, true),
        settings: Settings {
            backlash: Some(backlash),
            warmup_cycles: 2,
            ..settings(&inputs, solution.reduced_mass)
        },
    }
}

/// The equation in Runge-Kutta steps with the forces of the complementarity problem of each side.
/// Steps end where the touching pairs change or a pair passes a border of a mesh.
struct Plain<'a> {
    pair: &'a Rattling,
    damping: f64,
    /// Borders in reverse order of the incoming pair's motion.
    borders: Vec<f64>,
    /// A place before the next border.
    inside: f64,
    t: f64,
    y: State,
    back_force: f64,
    strikes: u32,
}

impl Plain<'_> {
    fn new(pair: &Rattling) -> Plain<'_> {
        let Rattling { mesh, back, settings } = pair;
        let start = -f64::from(settings.warmup_cycles) * mesh.base_pitch;
        let inside = start + 1e-9 * mesh.base_pitch;
        let critical = 2.0 * (mesh.mean_stiffness() * settings.mass).sqrt();
        let (offset, end) = (mesh.back_place(), 2.0 * mesh.length);
        let behind = back.borders(start + offset, end + offset);
        let behind = behind.into_iter().map(|place| place - offset);
        let mut borders: Vec<f64> = mesh.borders(start, end).into_iter().chain(behind).collect();
        borders.retain(|border| *border > inside);
        borders.sort_by(|one, other| other.total_cmp(one));
        Plain {
            pair,
            damping: settings.damping_ratio * critical,
            inside: f64::midpoint(start, *borders.last().unwrap()),
            borders,
            t: start / mesh.speed,
            y: State::new(static_load::balance(mesh, start, inside).displacement, 0.0),
            back_force: 0.0,
            strikes: 0,
        }
    }

    /// The pairs of the working flanks and of the back flanks, with the displacement of each side.
    fn sides(&self, t: f64, x: f64) -> [(PairSet, f64); 2] {
        let Rattling { mesh, back, settings } = self.pair;
        let (s, offset) = (t * mesh.speed, mesh.back_place());
        let fallen = -x - settings.backlash.unwrap();
        [
            (mesh.pair_set(s, self.inside), x),
            (back.pair_set(s + offset, self.inside + offset), fallen),
        ]
    }

    fn forces(&self, t: f64, x: f64) -> [Vec<f64>; 2] {
        self.sides(t, x).map(|(pairs, displaced)| pairs.forces(displaced).into_vec())
    }

    /// The pairs in contact.
    fn touching(&self, t: f64, x: f64) -> [Vec<i32>; 2] {
        self.sides(t, x).map(|(pairs, displaced)| {
            let forces = pairs.forces(displaced);
            let all = pairs.pairs().iter().zip(forces);
            all.filter(|(_, force)| *force > 0.0).map(|(pair, _)| pair.ahead).collect()
        })
    }

    fn slope(&self, t: f64, y: State) -> State {
        let Rattling { mesh, settings, .. } = self.pair;
        let [working, struck] = self.forces(t, y[0]);
        let sum = working.iter().sum::<f64>() - struck.iter().sum::<f64>();
        let touches = working.iter().chain(&struck).any(|&force| force > 0.0);
        let drag = if touches { self.damping * y[1] } else { 0.0 };
        State::new(y[1], (mesh.force - sum - drag) / settings.mass)
    }

    fn stepped(&self, h: f64) -> State {
        let (t, y) = (self.t, self.y);
        let one = self.slope(t, y);
        let two = self.slope(t + 0.5 * h, y + 0.5 * h * one);
        let three = self.slope(t + 0.5 * h, y + 0.5 * h * two);
        let four = self.slope(t + h, y + h * three);
        y + h / 6.0 * (one + 2.0 * (two + three) + four)
    }

    /// Advances to a time in steps of at most `length`.
    fn go_to(&mut self, end: f64, length: f64) {
        let speed = self.pair.mesh.speed;
        while self.t < end {
            let border = self.borders.last().map_or(f64::INFINITY, |border| border / speed);
            self.smooth_to(end.min(border), length);
            if border <= end {
                let passed = self.borders.pop().unwrap();
                let next = self.borders.last().copied().unwrap_or(passed);
                self.inside = f64::midpoint(passed, next);
            }
        }
    }

    fn smooth_to(&mut self, end: f64, length: f64) {
        while self.t < end {
            let mut h = length.min(end - self.t);
            let before = self.touching(self.t, self.y[0]);
            let changes = |h: f64| self.touching(self.t + h, self.stepped(h)[0]) != before;
            if changes(h) {
                let (mut same, mut other) = (0.0, h);
                while other - same > 1e-9 * length {
                    let middle = f64::midpoint(same, other);
                    if changes(middle) {
                        other = middle;
                    } else {
                        same = middle;
                    }
                }
                // Damping jumps when the last pair loses contact: one step to this time, then one
                // across.
                h = if same > 1e-6 * length { same } else { other };
            }
            self.y = self.stepped(h);
            self.t = if h >= end - self.t { end } else { self.t + h };
            let [_, struck] = self.forces(self.t, self.y[0]);
            if self.t * self.pair.mesh.speed >= -self.pair.mesh.base_pitch {
                self.back_force = struck.iter().copied().fold(self.back_force, f64::max);
                let strikes = before[1].is_empty() && struck.iter().any(|&force| force > 0.0);
                self.strikes += u32::from(strikes);
            }
        }
    }
}

/// Greatest difference of the displacement relative to its scale, and the run with plain steps.
fn compared<'a>(pair: &'a Rattling, found: &Dynamic, part: f64) -> (f64, Plain<'a>) {
    let scale = pair.mesh.force / pair.mesh.mean_stiffness();
    let mut plain = Plain::new(pair);
    let length = part * pair.mesh.base_pitch / pair.mesh.speed;
    let mut worst = 0.0f64;
    for station in &found.stations {
        plain.go_to(station.time().unwrap(), length);
        worst = worst.max((station.transmission_error().unwrap() - plain.y[0]).abs() / scale);
    }
    (worst, plain)
}

#[test]
fn plain_steps_across_the_backlash_give_the_same_motion_and_strikes() {
    for (name, pair) in rattling() {
        let found = dynamic(&pair.mesh, &pair.settings, &|_| true).unwrap();
        let rattle = found.rattle.unwrap();
        let (worst, plain) = compared(&pair, &found, 5e-5);
        let off = (plain.back_force / rattle.force - 1.0).abs();
        assert_eq!(plain.strikes, rattle.strikes, "{name}");
        assert!(rattle.strikes > 0 && worst < 1e-9, "{name}: {worst:e}");
        assert!(off < 1e-4, "{name}: {off:e}");
    }
}

/// The work of the mean force and of the moving meshes equals the energy of motion, springs and
/// damper, also with back flanks.
#[test]
fn energies_balance_across_the_backlash() {
    for friction in [0.0, 0.08] {
        for (name, pair) in rattling() {
            let mut mesh = pair.mesh.clone();
            if friction > 0.0 {
                mesh =
                    of_case(name.contains("coupled"), pair.settings.backlash.unwrap(), &|inputs| {
                        inputs.drive = Drive::Torque(3.0);
                        inputs.friction_coefficient = Some(friction);
                        inputs.speed *= 2.0;
                    })
                    .mesh;
            }
            let motion = Motion::new(&mesh, &pair.settings).with_back();
            let meter = Meter::new(MOTION_WORK);
            let run = ran(&motion, &pair.settings, &meter);
            let (unexplained, turned_over) = run.watch.energies(&motion, &mesh);
            let text = format!("{name}, friction {friction}: {unexplained:e} of {turned_over:e} J");
            assert!(unexplained < 1e-9 * turned_over, "{text}");
        }
    }
}

#[test]
fn a_backlash_that_does_not_close_changes_no_bit() {
    let (_, pair) = rattling().swap_remove(1);
    let far = |backlash| {
        let settings = Settings { backlash, ..pair.settings };
        dynamic(&pair.mesh, &settings, &|_| true).unwrap()
    };
    let (without, with) = (far(None), far(Some(5e-3)));
    assert_eq!(with.rattle, Some(Rattle::default()));
    assert_eq!(without.rattle, None);
    assert_eq!(Dynamic { rattle: None, ..with }, without);
}

/// Plain steps converge to the steady motion across the backlash.
#[test]
fn the_steady_motion_has_the_strikes_of_a_motion_after_a_long_warm_up() {
    let (name, pair) = rattling().swap_remove(0);
    let mesh = pair.mesh.without_error();
    let steady = steady(&mesh, &pair.settings, None, &Meter::new(MOTION_WORK), &|_| true).unwrap();
    let settings = Settings { warmup_cycles: 400, ..pair.settings };
    let motion = Motion::new(&mesh, &settings).with_back();
    let meter = Meter::new(MOTION_WORK);
    let mut run = Run::begin(&motion, settings.tolerance, &meter).unwrap();
    let (mut strikes, mut last) = (0, Touching::NONE);
    let period = f64::from(steady.periods) * mesh.base_pitch;
    while run.borders.get(run.next).is_some_and(|&border| border < -1e-9) {
        let window = motion.window(run.borders[run.next - 1], run.borders[run.next]).unwrap();
        let mut touching = window.touching(&run.touching).unwrap();
        let end = motion.time(window.ends.1);
        run.next += 1;
        run.turned = Touching::NONE;
        while run.t < end {
            let (next, _) = run.advance(&window, touching, end).unwrap();
            let was_apart = window.back(touching).next().is_none();
            let counts = motion.place(run.t) > -2.0 * mesh.base_pitch - period;
            if counts && motion.place(run.t) < -2.0 * mesh.base_pitch {
                strikes += u32::from(was_apart && window.back(next).next().is_some());
            }
            touching = next;
        }
        run.touching = window.names(touching);
        last = touching;
    }
    assert!(!last.is_none() || strikes > 0);
    assert_eq!(strikes, steady.rattle.unwrap().strikes, "{name}: {steady:?}");
}
