//! The load that coupled pairs share, compared with a whole gear by other finite elements.
//!
//! The couplings are those of the whole gears. The gaps and the compliance of each pair alone are
//! those of the program: `core::rounded` and `core::reference` check the gaps, `field::tests` the
//! compliances.
mod whole_gear;

use std::fs;

use nalgebra::{DMatrix, DVector};
use tipstrike::case::Document;
use tipstrike::model::compliance::{ContactPlace, Teeth};
use tipstrike::model::geometry::{PairShape, geometry};
use tipstrike::model::inputs::{Drive, Gear, Method, ToothCompliance};
use tipstrike::model::mesh::Mesh;
use tipstrike::model::position::tip_at;
use tipstrike::model::static_load::balance;
use tipstrike::model::{Geometry, Inputs, Outline, Solution, Stage, Stages, notes, solve};
use tipstrike::numeric::root;

use crate::support::{range, standard_pair};
use whole_gear::{Line, WholeGear};

/// A pair with the finite elements of the program, and with both gears by other elements.
struct Check {
    inputs: Inputs,
    solution: Solution,
    mesh: Mesh,
    /// Shape with the gears exchanged, for the places after B.
    swapped: Geometry,
    gears: [WholeGear; 2],
}

/// The pairs that may touch, the last one first.
struct Pairs {
    /// Number of base pitches of each pair ahead of the incoming one.
    ahead: Vec<i32>,
    gaps: Vec<f64>,
    compliance: DMatrix<f64>,
}

fn pair(teeth: [u32; 2], addendum: f64, torque: f64, deviation: f64) -> Inputs {
    let mut inputs = standard_pair(teeth[0], teeth[1], 3e-3);
    inputs.tooth_compliance = Some(ToothCompliance::FINITE_ELEMENT);
    inputs.method = Method::Static;
    inputs.drive = Drive::Torque(torque);
    inputs.base_pitch_deviation = deviation;
    for gear in [&mut inputs.driver, &mut inputs.driven] {
        gear.bore_radius = 0.5 * inputs.module * (f64::from(gear.teeth) / 2.0 - 1.25);
        gear.addendum = addendum;
        gear.dedendum = addendum + 0.25;
    }
    inputs
}

impl Check {
    fn of(inputs: Inputs) -> Check {
        let solution = solve(&inputs, Stages::EVERY).expect("a solution");
        let shape = inputs.shape();
        let swapped = PairShape { driver: shape.driven, driven: shape.driver, ..shape };
        let load = (solution.mesh_force, solution.deviation.equivalent_error);
        let mesh = Mesh::new(&inputs.mesh(), &solution.geometry, load, 3e-4, None);
        let gear = |gear: &Gear, circles| {
            let outline = Outline::of(&inputs, gear, circles);
            WholeGear::new(outline, gear.teeth, gear.bore_radius, gear.poisson)
        };
        Check {
            gears: [
                gear(&inputs.driver, &solution.geometry.driver),
                gear(&inputs.driven, &solution.geometry.driven),
            ],
            mesh: mesh.expect("a mesh"),
            swapped: geometry(&swapped).expect("a geometry"),
            inputs,
            solution,
        }
    }

    /// Radii of the load points of a pair on driver and driven gear: at the contact of the flanks,
    /// or at the greatest radius at which the pressure ends at the corner of the tip.
    fn radii(&self, s: f64) -> [f64; 2] {
        let geometry = &self.solution.geometry;
        let length = geometry.end - geometry.start;
        let radii = if s < 0.0 {
            let tip = tip_at(geometry, -s / geometry.driven.base);
            [tip.radius_driver, geometry.driven.tip]
        } else if s > length {
            let tip = tip_at(&self.swapped, (s - length) / geometry.driver.base);
            [geometry.driver.tip, tip.radius_driver]
        } else {
            let place = ContactPlace::on_line_of_action(geometry, geometry.start + s);
            [place.radius_driver, place.radius_driven]
        };
        let circles = [&geometry.driver, &geometry.driven];
        let square = |at: usize, radius: f64| radius.powi(2) - circles[at].base.powi(2);
        let curvatures = [0, 1].map(|at| square(at, radii[at]).sqrt());
        let reduced = curvatures[0] * curvatures[1] / (curvatures[0] + curvatures[1]);
        let gears = [&self.inputs.driver, &self.inputs.driven];
        let give = gears.map(|gear| (1.0 - gear.poisson.powi(2)) / gear.young);
        let pressure = self.mesh.force / self.inputs.common_width();
        let half_width =
            (4.0 * pressure * reduced * (give[0] + give[1]) / std::f64::consts::PI).sqrt();
        [0, 1].map(|at| {
            let base = circles[at].base;
            let corner = square(at, circles[at].tip) - 2.0 * base * half_width;
            radii[at].min(base.hypot(corner.sqrt()))
        })
    }

    /// The pairs for the incoming one at `s`, coupled by the whole gears.
    fn pairs(&self, s: f64) -> Pairs {
        let standing = self.mesh.pair_set(s, s);
        let standing = standing.pairs();
        let width = self.inputs.common_width();
        let lines: Vec<[Line; 2]> = standing
            .iter()
            .map(|pair| {
                let radii = self.radii(s + f64::from(pair.ahead) * self.mesh.base_pitch);
                [0, 1].map(|gear| self.gears[gear].line(radii[gear]))
            })
            .collect();
        let young = [self.inputs.driver.young, self.inputs.driven.young];
        let compliance = |row: usize, column: usize| {
            if row == column {
                return 1.0 / standing[row].stiffness;
            }
            // Earlier teeth of a driver that turns anticlockwise are further anticlockwise. In the
            // view in which the force pushes clockwise, those of the driven gear are in the
            // opposite direction.
            let earlier = column.cast_signed() as i32 - row.cast_signed() as i32;
            let by_gear = [0, 1].map(|gear| {
                let pitches = if gear == 0 { earlier } else { -earlier };
                let (measured, loaded) = (&lines[row][gear], &lines[column][gear]);
                self.gears[gear].displacement(measured, loaded, pitches) / young[gear]
            });
            (by_gear[0] + by_gear[1]) / width
        };
        Pairs {
            ahead: standing.iter().map(|pair| pair.ahead).collect(),
            gaps: standing.iter().map(|pair| pair.gap).collect(),
            compliance: DMatrix::from_fn(standing.len(), standing.len(), compliance),
        }
    }

    fn balance(&self, s: f64) -> (f64, f64) {
        let (displacement, forces, incoming) = self.pairs(s).shared(self.mesh.force, None);
        (displacement, incoming.map_or(0.0, |incoming| forces[incoming]))
    }

    /// Overlap of the incoming pair under the forces of the other pairs.
    fn lead(&self, s: f64) -> f64 {
        let pairs = self.pairs(s);
        let (displacement, forces, incoming) = pairs.shared(self.mesh.force, Some(0));
        let incoming = incoming.expect("it is there");
        displacement
            - pairs.gaps[incoming]
            - pairs.compliance.row(incoming).transpose().dot(&forces)
    }
}

impl Pairs {
    /// Displacement and forces by trying every set of touching pairs, and the index of the incoming
    /// pair; optionally without one pair.
    fn shared(&self, total: f64, without: Option<i32>) -> (f64, DVector<f64>, Option<usize>) {
        let count = self.gaps.len();
        let fits = (1..1u32 << count).find_map(|set| {
            let members: Vec<usize> = (0..count).filter(|pair| set >> pair & 1 == 1).collect();
            if members.iter().any(|&pair| Some(self.ahead[pair]) == without) {
                return None;
            }
            let size = members.len();
            let mut rows = DMatrix::zeros(size + 1, size + 1);
            let mut right = DVector::zeros(size + 1);
            for (row, &pair) in members.iter().enumerate() {
                for (column, &other) in members.iter().enumerate() {
                    rows[(row, column)] = self.compliance[(pair, other)] * 1e9;
                }
                (rows[(row, size)], rows[(size, row)]) = (-1.0, 1.0);
                right[row] = -self.gaps[pair] * 1e9;
            }
            right[size] = total;
            let found = rows.lu().solve(&right)?;
            let mut forces = DVector::zeros(count);
            for (row, &pair) in members.iter().enumerate() {
                forces[pair] = found[row];
            }
            let displacement = found[size] * 1e-9;
            let pushed = &self.compliance * &forces;
            let is_right = (0..count).all(|pair| {
                let overlap = displacement - self.gaps[pair] - pushed[pair];
                let is_left_out = Some(self.ahead[pair]) == without;
                forces[pair] >= 0.0 && (is_left_out || overlap <= 1e-15)
            });
            is_right.then_some((displacement, forces))
        });
        let (displacement, forces) = fits.expect("one set fits");
        (displacement, forces, self.ahead.iter().position(|&ahead| ahead == 0))
    }
}

/// A pair with up to four pairs of teeth on the line of action, and with a thin rim.
fn pair_of_high_contact_ratio() -> Inputs {
    let mut inputs = pair([50, 55], 1.6, 600.0, 3e-6);
    inputs.pressure_angle = 14.5f64.to_radians();
    for (gear, ratio) in [(&mut inputs.driver, 1.3), (&mut inputs.driven, 3.0)] {
        let root = inputs.module * (f64::from(gear.teeth) / 2.0 - gear.dedendum);
        gear.bore_radius = root / ratio;
    }
    inputs
}

fn checks() -> Vec<Check> {
    let pairs = [
        pair([18, 25], 1.0, 90.0, 8e-6),
        pair([26, 34], 1.3, 250.0, 0.0),
        pair_of_high_contact_ratio(),
    ];
    pairs.map(Check::of).into()
}

#[test]
fn coupled_pairs_share_the_load_as_two_whole_gears_do() {
    for check in checks() {
        let (mesh, name) = (&check.mesh, format!("z {}", check.inputs.driver.teeth));
        let ratio = check.solution.geometry.contact_ratio;
        println!("{name}: contact ratio {ratio:.3}");
        let load = check.solution.static_load.as_ref().expect("method static");
        let first = -load.first_contact_angle.expect("it strikes") * mesh.base_radii.1;
        let other = root::between(2.0 * first, 0.0, |s| check.lead(s));
        assert!((first / other - 1.0).abs() < 0.01, "{name}: first contact {first} {other}");
        let (_, at_start) = check.balance(0.0);
        let off = load.force_at_start / at_start - 1.0;
        assert!(off.abs() < 0.025, "{name}: force at E off by {off}");
        let places =
            (0..=12).map(|step| first + (mesh.length - 2.0 * first) * f64::from(step) / 12.0);
        let (mut own, mut others) = (Vec::new(), Vec::new());
        for s in places {
            let found = balance(mesh, s, s);
            let (displacement, force) = check.balance(s);
            let off = (found.force - force) / mesh.force;
            assert!(off.abs() < 0.01, "{name}: force at {s} off by {off}");
            own.push(found.displacement);
            others.push(displacement);
        }
        let off = range(&own) / range(&others) - 1.0;
        println!(
            "{name}: first contact {:+.4}, force at E {:+.4}, transmission error {off:+.4}",
            first / other - 1.0,
            load.force_at_start / at_start - 1.0
        );
        assert!(off.abs() < 0.01, "{name}: transmission error off by {off}");
    }
}

/// A pair with its answers by another finite-element program. That program computes whole gears in
/// contact with their own compliances, and moves a load whose pressure would extend beyond the
/// corner of the tip.
struct Answers {
    teeth: [u32; 2],
    shifts: [f64; 2],
    heights: [f64; 2],
    degrees: f64,
    /// r_f/r_h of both gears.
    ratios: [f64; 2],
    /// Torque in N m and deviation in um.
    load: [f64; 2],
    /// First contact before E, in modules; force at E, in N.
    first_contact: f64,
    force_at_start: f64,
}

/// Pairs at loads whose half-width of contact is above 0.02 modules, of contact ratio 1.54, 2.00,
/// 1.35, 2.19 and 3.14.
#[rustfmt::skip]
const ANSWERS: [Answers; 5] = [
    Answers { teeth: [17, 31], shifts: [0.2, -0.1], heights: [1.0, 1.25], degrees: 20.0, ratios: [1.6, 2.5], load: [60.0, 0.0], first_contact: 0.25883, force_at_start: 1489.9 },
    Answers { teeth: [24, 24], shifts: [0.0, 0.0], heights: [1.3, 1.55], degrees: 20.0, ratios: [3.0, 1.3], load: [200.0, 8.0], first_contact: 0.37443, force_at_start: 3054.3 },
    Answers { teeth: [13, 19], shifts: [0.5, 0.4], heights: [1.0, 1.25], degrees: 20.0, ratios: [1.4, 2.0], load: [150.0, 15.0], first_contact: 0.38635, force_at_start: 6930.5 },
    Answers { teeth: [30, 41], shifts: [0.0, 0.0], heights: [1.35, 1.6], degrees: 20.0, ratios: [1.2, 1.15], load: [400.0, -6.0], first_contact: 0.48146, force_at_start: 3000.7 },
    Answers { teeth: [60, 75], shifts: [0.0, 0.0], heights: [1.5, 1.75], degrees: 14.5, ratios: [1.3, 3.0], load: [300.0, 3.0], first_contact: 0.57413, force_at_start: 1138.0 },
];

impl Answers {
    fn inputs(&self) -> Inputs {
        let mut inputs = standard_pair(self.teeth[0], self.teeth[1], 2e-3);
        inputs.tooth_compliance = Some(ToothCompliance::FINITE_ELEMENT);
        inputs.method = Method::Static;
        inputs.pressure_angle = self.degrees.to_radians();
        inputs.drive = Drive::Torque(self.load[0]);
        inputs.base_pitch_deviation = 1e-6 * self.load[1];
        for (at, gear) in [&mut inputs.driver, &mut inputs.driven].into_iter().enumerate() {
            gear.profile_shift = self.shifts[at];
            [gear.addendum, gear.dedendum] = self.heights;
            let root = f64::from(gear.teeth) / 2.0 - gear.dedendum + gear.profile_shift;
            gear.bore_radius = inputs.module * root / self.ratios[at];
        }
        inputs
    }
}

#[test]
fn the_shared_load_is_that_of_another_finite_element_program() {
    for answers in &ANSWERS {
        let inputs = answers.inputs();
        let solution = solve(&inputs, Stages::of(Stage::Static)).expect("a solution");
        let load = solution.static_load.expect("method static");
        let first = load.first_contact_angle.expect("it strikes") * solution.geometry.driven.base;
        let found = [
            (first / inputs.module / answers.first_contact, 1e-3),
            (load.force_at_start / answers.force_at_start, 5e-3),
        ];
        println!("z {:?}: {found:?}", answers.teeth);
        for (ratio, allowed) in found {
            assert!((ratio - 1.0).abs() < allowed, "z {:?}: {found:?}", answers.teeth);
        }
    }
}

#[test]
fn neighbours_yield_as_those_of_a_whole_gear() {
    for check in checks() {
        let elasticity = check.inputs.elasticity();
        let teeth = Teeth::of(&elasticity, &check.solution.geometry).expect("teeth");
        let geometry = &check.solution.geometry;
        for pitches in [1, 2, 3] {
            let way = check.mesh.length - f64::from(pitches) * check.mesh.base_pitch;
            for step in 0..=4 {
                let rear = 0.98 * way * f64::from(step) / 4.0 + 0.01 * way;
                if way < 0.0 {
                    continue;
                }
                let front = rear + f64::from(pitches) * check.mesh.base_pitch;
                let place = |s: f64| {
                    let place = ContactPlace::on_line_of_action(geometry, geometry.start + s);
                    teeth.under(&place, check.mesh.force)
                };
                let found =
                    teeth.coupling(&place(rear), &place(front), pitches).expect("a coupling");
                let radii = [check.radii(rear), check.radii(front)];
                let of = |gear: usize, pitches: i32, young: f64| {
                    let lines = radii.each_ref().map(|radii| check.gears[gear].line(radii[gear]));
                    check.gears[gear].displacement(&lines[0], &lines[1], pitches) / young
                };
                let expected = of(0, pitches, check.inputs.driver.young)
                    + of(1, -pitches, check.inputs.driven.young);
                let own = teeth.pair_at_load(&place(rear), check.mesh.force).expect("a compliance");
                println!(
                    "{pitches} at {step}: {found:e} {expected:e} {:+.4} {:+.4}",
                    found / expected - 1.0,
                    (found - expected) / own
                );
                assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
            }
        }
    }
}

#[test]
fn coupling_changes_the_cases_as_much_as_the_documentation_says() {
    let folder = format!("{}/cases", env!("CARGO_MANIFEST_DIR"));
    let mut seen = 0;
    for entry in fs::read_dir(folder).expect("the cases") {
        let path = entry.expect("an entry").path();
        let document = Document::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let case = document.case.inputs().expect("a valid case");
        // The whole gear in two dimensions has no slices.
        let parts = if case.face().is_some() { &[][..] } else { &[0.2, 1.0] };
        for part in parts {
            let inputs = Inputs {
                tooth_compliance: Some(ToothCompliance::FINITE_ELEMENT),
                method: Method::Static,
                drive: Drive::Torque(part * case.torque()),
                ..case.clone()
            };
            let [(load, mesh), (springs, alone)] = [true, false].map(|tooth_coupling| {
                let inputs = Inputs { tooth_coupling, ..inputs.clone() };
                let solution = solve(&inputs, Stages::EVERY).expect("a solution");
                (solution.static_load.expect("a load"), solution.mesh.expect("a mesh"))
            });
            assert!(mesh.is_coupled() && !alone.is_coupled());
            let ratios = [
                (load.first_contact_angle.zip(springs.first_contact_angle), 0.885..0.996),
                (Some((load.force_at_start, springs.force_at_start)), 0.94..1.075),
                (Some((load.transmission_error, springs.transmission_error)), 0.87..1.13),
                (Some((mesh.mean_stiffness(), alone.mean_stiffness())), 0.835..0.945),
            ];
            for (values, range) in ratios {
                let Some((coupled, alone)) = values.filter(|(_, alone)| *alone > 0.0) else {
                    continue;
                };
                println!("{} {part}: {:+.3}", path.display(), coupled / alone - 1.0);
                assert!(
                    range.contains(&(coupled / alone)),
                    "{}: {coupled} {alone}",
                    path.display()
                );
                seen += 1;
            }
        }
    }
    assert!(seen > 40, "{seen}");
}

/// The note on a compliance without coupling states the range over the cases in `cases/`.
#[test]
fn the_error_without_coupling_is_as_the_note_states() {
    let mut changes = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for path in crate::table::cases() {
        let inputs =
            Inputs { method: Method::Dynamic, deflection: None, ..crate::table::inputs(&path) };
        let [coupled, alone] = [true, false].map(|tooth_coupling| {
            let inputs = Inputs { tooth_coupling, ..inputs.clone() };
            solve(&inputs, Stages::EVERY).expect("a solution").dynamic.expect("the method")
        });
        let angles = alone.first_contact_angle.zip(coupled.first_contact_angle);
        let found = [
            angles.map(|(alone, coupled)| alone / coupled),
            Some(alone.peak_force / coupled.peak_force),
            angles.map(|_| alone.peak_approach_force / coupled.peak_approach_force),
        ];
        println!("{}: {found:?}", path.display());
        for (range, found) in changes.iter_mut().zip(found) {
            if let Some(ratio) = found {
                let change = 100.0 * (ratio - 1.0);
                *range = [range[0].min(change), range[1].max(change)];
            }
        }
    }
    let beam = Inputs {
        tooth_compliance: Some(ToothCompliance::BEAM),
        method: Method::Dynamic,
        ..crate::table::inputs(&crate::table::cases()[0])
    };
    let solution = solve(&beam, Stages::of(Stage::Dynamic)).expect("a solution");
    let found = notes(&beam, &solution);
    let note = found.iter().find(|note| note.code == "no-coupling");
    let message = &note.expect("a note").message;
    let [angles, peaks, _] = changes;
    let earlier = format!("{:.0} to {:.0} % earlier", angles[0], angles[1]);
    let force = format!("{:+.0} to {:+.0} %", peaks[0], peaks[1]);
    assert!(message.contains(&earlier) && message.contains(&force), "{message}: {changes:?}");
    let own = crate::table::inputs(&crate::table::cases()[0]);
    let solution = solve(&own, Stages::CLOSED_FORM).expect("a solution");
    let notes = notes(&own, &solution);
    assert!(notes.iter().all(|note| note.code != "no-coupling"), "{notes:?}");
}
