//! The dynamic factors of a pair over speed, in a run-up and a run-down.

use std::cell::Cell;
use std::sync::Arc;

use super::budget::Meter;
use super::dynamic::Settings;
use super::dynamic::steady::{Start, steady};
use super::mesh::Mesh;
use super::slices::Face;
use super::slices::motion::{self, Springs};
use super::static_load::static_spectrum;
use super::{Inputs, Refusal, Resonance, Solution};

/// Number of speeds of a run.
pub const SPEEDS: usize = 121;

/// Least resonance ratio of the curve.
const FROM: f64 = 0.1;
/// Greatest resonance ratio of the curve, unless the ratio of the case is close to it or above.
const TO: f64 = 1.6;
/// In that case the greatest ratio is this multiple of the ratio of the case.
const BEYOND_PRESENT: f64 = 1.15;

/// Work of one speed.
const WORK_OF_SPEED: u64 = 60_000;
/// Work of all speeds.
const WORK: u64 = 5_000_000;

/// A run-down factor that differs by more than this from the run-up belongs to another motion.
const SAME: f64 = 1e-3;

/// The steady motion at one speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtSpeed {
    /// Speed of the driver, in rad/s.
    pub speed: f64,
    /// Resonance ratio N = f_z/f_n.
    pub ratio: f64,
    /// Greatest tooth force in motion over that at rest.
    pub tooth_factor: f64,
    /// Peak-to-peak transmission error, in m.
    pub peak_to_peak: f64,
    /// Whether all pairs lose contact at some moment.
    pub contact_lost: bool,
}

/// The steady motions over the speed, at the torque of the case.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedCurve {
    /// The speeds, in rad/s, in rising order.
    pub speeds: Vec<f64>,
    /// The run-up, in the order of the speeds; `None` if the speed has no steady motion or is not
    /// computed yet.
    pub up: Vec<Option<AtSpeed>>,
    /// The run-down, in the same order.
    pub down: Vec<Option<AtSpeed>>,
    /// The greatest peaks of run-up and run-down, between two speeds; `None` until both are complete.
    pub peaks: [Option<AtSpeed>; 2],
    /// The speed of the case, in rad/s.
    pub present: f64,
    /// The speed at which N = 1, in rad/s.
    pub resonance: f64,
    /// Whether the budget ended before the last speed.
    pub is_cut: bool,
}

impl SpeedCurve {
    /// The points of the run-down whose motion differs from the run-up.
    pub fn jumps(&self) -> impl Iterator<Item = &AtSpeed> {
        let pairs = self.up.iter().zip(&self.down);
        pairs.filter_map(|(up, down)| {
            let (up, down) = (up.as_ref()?, down.as_ref()?);
            let differs = (up.tooth_factor - down.tooth_factor).abs() > SAME * up.tooth_factor;
            differs.then_some(down)
        })
    }

    /// The point of the run-up with the greatest dynamic factor of a tooth.
    pub fn peak_rising(&self) -> Option<&AtSpeed> {
        self.peaks[0].as_ref().or_else(|| greatest(&self.up))
    }

    /// The point of the run-down with the greatest dynamic factor of a tooth.
    pub fn peak_falling(&self) -> Option<&AtSpeed> {
        self.peaks[1].as_ref().or_else(|| greatest(&self.down))
    }

    /// The greatest peak of the run-up whose N differs from `ratio` by less than 0.18: 1/2 and 1/3 have no
    /// common peak.
    pub fn peak_near(&self, ratio: f64) -> Option<&AtSpeed> {
        const NEAR: f64 = 0.18;
        let points: Vec<&AtSpeed> = self.up.iter().flatten().collect();
        let is_peak = |of: &[&AtSpeed]| {
            let around = of[0].tooth_factor.max(of[2].tooth_factor);
            of[1].tooth_factor >= around && (of[1].ratio / ratio - 1.0).abs() < NEAR
        };
        let peaks = points.windows(3).filter(|of| is_peak(of)).map(|of| of[1]);
        peaks.max_by(|one, other| one.tooth_factor.total_cmp(&other.tooth_factor))
    }

    /// The intervals of speed with loss of contact in the run-up or run-down, in rad/s.
    pub fn lost(&self) -> Vec<(f64, f64)> {
        let mut found: Vec<(usize, usize)> = Vec::new();
        for (at, (up, down)) in self.up.iter().zip(&self.down).enumerate() {
            let is_lost = [up, down].into_iter().flatten().any(|one| one.contact_lost);
            match found.last_mut() {
                _ if !is_lost => {}
                Some((_, to)) if *to + 1 == at => *to = at,
                _ => found.push((at, at)),
            }
        }
        let speed = |(from, to): (usize, usize)| (self.speeds[from], self.speeds[to]);
        found.into_iter().map(speed).collect()
    }
}

fn greatest(run: &[Option<AtSpeed>]) -> Option<&AtSpeed> {
    let points = run.iter().flatten();
    points.max_by(|one, other| one.tooth_factor.total_cmp(&other.tooth_factor))
}

/// Computes the steady motion of a pair at each of [`SPEEDS`] speeds, first with rising speed, then
/// with falling speed. Each motion starts from the previous one. `show` receives the growing curve.
/// The solution has geometry, load, masses and deviation. `go_on` receives the number of computed motions
/// and the total.
///
/// # Errors
/// The [`Refusal`] of the pair; [`Refusal::Stopped`] if `go_on` returns false.
pub(crate) fn over_speed(
    inputs: &Inputs,
    solution: &Solution,
    show: &mut dyn FnMut(&SpeedCurve),
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<SpeedCurve, Refusal> {
    let range = |present: f64| (FROM, TO.max(BEYOND_PRESENT * present), SPEEDS);
    over_range(inputs, solution, range, show, go_on)
}

/// Like [`over_speed`], from a least to a greatest resonance ratio at a number of speeds, which depend on
/// the ratio of the case.
fn over_range(
    inputs: &Inputs,
    solution: &Solution,
    range: impl FnOnce(f64) -> (f64, f64, usize),
    show: &mut dyn FnMut(&SpeedCurve),
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<SpeedCurve, Refusal> {
    let mesh = Arc::new(wide_mesh(inputs, solution)?);
    let resonance = Resonance::of(inputs.speed, &mesh, solution.reduced_mass);
    let at_resonance = inputs.speed / resonance.ratio();
    let (from, to, count) = range(resonance.ratio());
    let step = (to - from) / (count - 1) as f64;
    let speeds = (0..count).map(|at| (from + step * at as f64) * at_resonance);
    let mut curve = SpeedCurve {
        speeds: speeds.collect(),
        up: vec![None; count],
        down: vec![None; count],
        peaks: [None; 2],
        present: inputs.speed,
        resonance: at_resonance,
        is_cut: false,
    };
    let settings = Settings::steady(inputs, solution.reduced_mass);
    let face = inputs.face().map(|face| Face::new(&face, &solution.geometry, &mesh)).transpose()?;
    let springs = face
        .as_ref()
        .map(|face| Springs::new(face, &settings, curve.speeds[0] * mesh.base_radii.0));
    let tooth_force = match &face {
        Some(face) => face.cycle()?.1.tooth_force,
        None => static_spectrum(&mesh)?.tooth_force,
    };
    let done = Cell::new(0);
    let runs = Runs {
        mesh: &mesh,
        springs: springs.as_ref(),
        settings,
        tooth_force,
        resonance: at_resonance,
        work: Meter::new(WORK),
        go_on: &|_| go_on(done.get(), 2 * count),
    };
    let (mut last, mut highest) = (None, [const { None }; 2]);
    let rising = (0..count).map(|at| (at, true));
    for (at, rises) in rising.clone().chain(rising.rev().map(|(at, _)| (at, false))) {
        let found = runs.at(curve.speeds[at], &mut last)?;
        let run = if rises { &mut curve.up } else { &mut curve.down };
        run[at] = found;
        let highest: &mut Option<(AtSpeed, Start)> = &mut highest[usize::from(!rises)];
        if let Some((found, start)) = found.zip(last.as_ref())
            && highest.as_ref().is_none_or(|(best, _)| found.tooth_factor > best.tooth_factor)
        {
            *highest = Some((found, start.clone()));
        }
        done.set(done.get() + 1);
        show(&curve);
    }
    for (peak, highest) in curve.peaks.iter_mut().zip(highest) {
        *peak = highest.map(|highest| runs.summit(highest, step * at_resonance)).transpose()?;
    }
    curve.is_cut = !runs.work.spend(0);
    Ok(curve)
}

/// The mesh of the pair without deviations, with a range wide enough for the motion in resonance.
fn wide_mesh(inputs: &Inputs, solution: &Solution) -> Result<Mesh, Refusal> {
    const REACH: f64 = 60.0;
    let yields = solution.deviation.loaded_deflection() + inputs.reliefs().sum();
    let load = (solution.mesh_force, 0.0);
    Mesh::new(&inputs.mesh(), &solution.geometry, load, REACH * yields, None)
}

struct Runs<'a> {
    mesh: &'a Arc<Mesh>,
    /// The force over the face width, if the pair is in slices.
    springs: Option<&'a Springs<'a>>,
    settings: Settings,
    /// Greatest force of a tooth at rest, in N.
    tooth_force: f64,
    resonance: f64,
    work: Meter,
    go_on: &'a dyn Fn(f64) -> bool,
}

impl Runs<'_> {
    /// The greatest motion on the branch of a motion, by small steps of the speed to both sides, up to
    /// `step` away.
    fn summit(&self, (from, start): (AtSpeed, Start), step: f64) -> Result<AtSpeed, Refusal> {
        /// Parts of the step.
        const PARTS: u32 = 8;
        let mut best = from;
        for side in [1.0, -1.0] {
            let mut last = Some(start.clone());
            for part in 1..=PARTS {
                let speed = from.speed + side * step * f64::from(part) / f64::from(PARTS);
                match self.at(speed, &mut last)? {
                    Some(next) if next.tooth_factor > best.tooth_factor => best = next,
                    _ => break,
                }
            }
        }
        Ok(best)
    }

    /// The steady motion at a speed, starting from the motion at the previous speed.
    fn at(&self, speed: f64, last: &mut Option<Start>) -> Result<Option<AtSpeed>, Refusal> {
        let meter = Meter::new(WORK_OF_SPEED.min(WORK.saturating_sub(self.work.spent())));
        let mesh = self.mesh.turning_at(speed);
        let (settings, last_start) = (&self.settings, last.as_ref());
        let found = match self.springs {
            Some(springs) => motion::steady(springs, settings, mesh.speed, last_start, self.go_on),
            None => steady(&mesh, settings, last_start, &meter, self.go_on),
        };
        self.work.spend(meter.spent());
        let Ok(steady) = Refusal::unless_stopped(found)? else {
            // The next speed starts at rest.
            *last = None;
            return Ok(None);
        };
        *last = Some(steady.start);
        Ok(Some(AtSpeed {
            speed,
            ratio: speed / self.resonance,
            tooth_factor: steady.tooth_force / self.tooth_force,
            peak_to_peak: steady.spectrum.peak_to_peak,
            contact_lost: steady.contact_lost,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Method;
    use crate::model::sample::standard_pair;
    use crate::model::{Stage, Stages, solve};

    /// Points from tooth factor and loss of contact.
    fn run(points: &[Option<(f64, bool)>]) -> Vec<Option<AtSpeed>> {
        let at = |(tooth_factor, contact_lost)| AtSpeed {
            speed: 0.0,
            ratio: 0.0,
            tooth_factor,
            peak_to_peak: 0.0,
            contact_lost,
        };
        points.iter().map(|point| point.map(at)).collect()
    }

    fn curve(up: &[Option<(f64, bool)>], down: &[Option<(f64, bool)>]) -> SpeedCurve {
        SpeedCurve {
            speeds: (0..up.len()).map(|speed| speed as f64).collect(),
            up: run(up),
            down: run(down),
            peaks: [None; 2],
            present: 1.0,
            resonance: 1.0,
            is_cut: false,
        }
    }

    /// The dynamic factor of a tooth at falling speeds near resonance, and whether contact is lost.
    fn falling(inputs: &Inputs) -> Vec<(f64, bool)> {
        let inputs = Inputs { method: Method::Dynamic, ..inputs.clone() };
        let solution = solve(&inputs, Stages::of(Stage::Mesh).with(Stage::Masses)).unwrap();
        let range = |_| (0.65, 1.05, 17);
        let curve = over_range(&inputs, &solution, range, &mut |_| (), &|_, _| true).unwrap();
        let all = curve.down.into_iter().rev();
        all.map(|found| found.map(|found| (found.tooth_factor, found.contact_lost)).unwrap())
            .collect()
    }

    #[test]
    fn a_pair_over_the_face_repeats_after_loss_of_contact_as_the_spur_pair_does() {
        let mut inputs = standard_pair(16, 24, 4.5e-3);
        let spur = falling(&inputs);
        inputs.helix_angle = 1e-8;
        let over_face = falling(&inputs);
        assert!(spur.iter().any(|(_, is_lost)| *is_lost));
        for ((one, is_lost), (other, is_lost_too)) in spur.into_iter().zip(over_face) {
            assert!((one / other - 1.0).abs() < 1e-3 && is_lost == is_lost_too, "{one} {other}");
        }
    }

    #[test]
    fn contact_is_lost_over_each_gap_of_the_run_up_or_down() {
        let (lost, kept) = (Some((1.0, true)), Some((1.0, false)));
        let curve = curve(
            &[lost, kept, kept, lost, lost, kept, None],
            &[kept, kept, None, kept, lost, kept, lost],
        );
        assert_eq!(curve.lost(), [(0.0, 0.0), (3.0, 4.0), (6.0, 6.0)]);
    }

    #[test]
    fn the_run_down_jumps_where_its_motion_differs() {
        let up = [Some((1.2, false)), Some((2.0, false)), None, Some((1.5, false))];
        let down = [Some((1.2001, false)), Some((1.4, true)), Some((9.0, true)), None];
        let curve = curve(&up, &down);
        let jumps: Vec<f64> = curve.jumps().map(|point| point.tooth_factor).collect();
        assert_eq!(jumps, [1.4]);
    }
}
