//! The load at rest over the face width: one base pitch without deviations, and the passage of the
//! incoming tooth.

use super::balance::{Loads, Until};
use super::{Face, Slice};
use crate::model::Refusal;
use crate::model::budget::STATIONS;
use crate::model::static_load::{HARMONICS, Spectrum, StaticLoad, StaticSpectrum};
use crate::model::stations::{Own, Spacing, Station};
use crate::numeric::root::{self, greatest};
use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A place of contact on the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacePlace {
    /// Place along the axis from the middle of the common face, in m.
    pub z: f64,
    /// Path of the pair since E in the plane across the axis at z, in m.
    pub path: f64,
}

/// The greatest line load of a part of the path, in N/m, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePeak {
    /// Line load, in N/m.
    pub line_load: f64,
    /// Where it acts.
    pub place: FacePlace,
}

/// The load over the face width.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceLoad {
    /// First contact of the incoming tooth.
    pub first: FacePlace,
    /// Last contact of the incoming tooth.
    pub last: FacePlace,
    /// Greatest line load of the incoming tooth.
    pub peak: LinePeak,
    /// The same before E, at the driven tip.
    pub before_start: Option<LinePeak>,
    /// The same after B, at the driver's tip.
    pub after_end: Option<LinePeak>,
    /// Path of the incoming tooth in the middle of the face at each row of `pattern`, in m.
    pub paths: Vec<f64>,
    /// Line load of the incoming tooth at each slice, in N/m, for each of the `paths`.
    pub pattern: Vec<Vec<f64>>,
}

/// One base pitch without deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceCycle {
    /// Mean displacement of the driver ahead, in m.
    pub mean_displacement: f64,
    /// Mean change of the force with the displacement, in N/m.
    pub mean_slope: f64,
    /// K_Hβ: greatest line load of all pairs, averaged over a base pitch, over its mean.
    pub face_load_factor: f64,
    /// Line load of all pairs at each slice, averaged over a base pitch, in N/m.
    pub line_loads: Vec<f64>,
    /// Swing of the point of attack of the force along the face, in m.
    pub swing: f64,
    /// Greatest line load, and the same before E and after B.
    pub peaks: [Option<LinePeak>; 3],
}

/// The part of the path of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    BeforeStart,
    AfterEnd,
}

impl Part {
    const ALL: [Part; 3] = [Part::All, Part::BeforeStart, Part::AfterEnd];

    /// A place just inside the end of the part at the path of contact, in m.
    fn border(self, length: f64) -> Option<f64> {
        const INSIDE: f64 = 1e-9;
        match self {
            Part::All => None,
            Part::BeforeStart => Some(-INSIDE * length),
            Part::AfterEnd => Some((1.0 + INSIDE) * length),
        }
    }

    fn has(self, path: f64, length: f64) -> bool {
        match self {
            Part::All => true,
            Part::BeforeStart => path < 0.0,
            Part::AfterEnd => path > length,
        }
    }
}

impl Face {
    /// Number of places in a base pitch at which the load is solved; more for narrow slices.
    fn steps(&self) -> usize {
        const LEAST: usize = 64;
        const SLICES: usize = 4;
        LEAST.max(self.slices.len() / SLICES)
    }

    /// The path of a pair at a slice, in m.
    fn path(&self, loads: &Loads, ahead: i32, slice: usize) -> f64 {
        loads.s + f64::from(ahead) * self.mesh.base_pitch + self.slices[slice].ahead
    }

    /// The greatest line load of some pairs in a part of the path.
    fn line_peak(&self, loads: &Loads, pairs: impl Iterator<Item = i32>, part: Part) -> LinePeak {
        let place = FacePlace { z: 0.0, path: 0.0 };
        let mut best = LinePeak { line_load: 0.0, place };
        let mut include = |line_load: f64, place: FacePlace| {
            if line_load > best.line_load {
                best = LinePeak { line_load, place };
            }
        };
        for ahead in pairs {
            for (number, slice) in self.slices.iter().enumerate() {
                let path = self.path(loads, ahead, number);
                if part.has(path, self.mesh.length) {
                    include(loads.at(ahead, number), FacePlace { z: slice.z, path });
                }
            }
            // The load rises up to the end of the part, which is between two slices.
            if let Some(path) = part.border(self.mesh.length)
                && let Some((line_load, z)) = self.load_at(loads, ahead, path)
            {
                include(line_load, FacePlace { z, path });
            }
        }
        best
    }

    /// How far before E the incoming tooth touches, in the plane where this is farthest, in m.
    fn deepest(&self, loads: &Loads) -> f64 {
        let touching = (0..self.slices.len()).filter(|&at| loads.at(0, at) > 0.0);
        touching.map(|at| -self.path(loads, 0, at)).fold(0.0, f64::max)
    }

    /// The force of a pair in a part of the path, in N.
    fn force(&self, loads: &Loads, ahead: i32, part: Part) -> f64 {
        let of_slice = |number: usize| {
            let is_here = part.has(self.path(loads, ahead, number), self.mesh.length);
            let line_load = if is_here { loads.at(ahead, number) } else { 0.0 };
            line_load * self.slices[number].width
        };
        (0..self.slices.len()).map(of_slice).sum()
    }

    /// ∫ of a value over the face.
    fn over_face(&self, values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
        let parts = values.iter().zip(&self.slices);
        parts.map(|(value, slice)| value * of(slice.z) * slice.width).sum()
    }

    /// The balance with the incoming pair at `s`.
    fn balance(&self, s: f64, error: f64) -> Result<Loads, Refusal> {
        let loads = self.loads(s, error, Until::Force(self.mesh.force), None)?;
        if loads.displacement.is_finite() { Ok(loads) } else { Err(Refusal::BeyondReach) }
    }

    /// One base pitch without deviations, and the harmonics of its transmission error.
    ///
    /// # Formula
    /// ```text
    /// K_Hβ = b max w(z)/F0,   w(z) = mean of Σ_k p_k(z) over a base pitch
    /// ```
    ///
    /// # Source
    /// K_Hβ of ISO 6336-1:2019, 7.2, by the line load of all pairs.
    ///
    /// # Errors
    /// Those of [`Face::loads`].
    pub fn cycle(&self) -> Result<(FaceCycle, StaticSpectrum), Refusal> {
        let (pitch, steps) = (self.mesh.base_pitch, self.steps());
        let place = |number: usize| pitch * number as f64 / steps as f64;
        let all: Vec<Loads> =
            (0..steps).map(|number| self.balance(place(number), 0.0)).collect::<Result<_, _>>()?;
        let mean = |of: &dyn Fn(&Loads) -> f64| all.iter().map(of).sum::<f64>() / steps as f64;
        let mut line_loads = vec![0.0; self.slices.len()];
        for loads in &all {
            for (sum, line_load) in line_loads.iter_mut().zip(loads.of_all()) {
                *sum += line_load / steps as f64;
            }
        }
        let mut sums = [[0.0; 2]; HARMONICS];
        for (number, loads) in all.iter().enumerate() {
            for (order, sum) in (1..).zip(&mut sums) {
                let (sine, cosine) =
                    (TAU * f64::from(order) * number as f64 / steps as f64).sin_cos();
                *sum = [sum[0] + loads.displacement * cosine, sum[1] + loads.displacement * sine];
            }
        }
        let extreme = |of: &dyn Fn(&Loads) -> f64| {
            let known = all.iter().chain([&all[0]]).enumerate();
            let known: Vec<_> = known.map(|(number, loads)| (place(number), of(loads))).collect();
            greatest(&known, |s| self.balance(s, 0.0).map_or(f64::NEG_INFINITY, |loads| of(&loads)))
                .1
        };
        let middle = |loads: &Loads| {
            let line_loads = loads.of_all();
            self.over_face(&line_loads, |z| z) / self.over_face(&line_loads, |_| 1.0)
        };
        let most = line_loads.iter().copied().fold(0.0, f64::max);
        let cycle = FaceCycle {
            mean_displacement: mean(&|loads| loads.displacement),
            mean_slope: mean(&|loads| loads.stiffness),
            face_load_factor: most * self.inputs.width / self.over_face(&line_loads, |_| 1.0),
            swing: extreme(&middle) + extreme(&|loads| -middle(loads)),
            peaks: Part::ALL.map(|part| {
                let known = all.iter().chain([&all[0]]).enumerate();
                let peak = |loads: &Loads| self.line_peak(loads, loads.pairs(), part);
                let known: Vec<_> =
                    known.map(|(at, loads)| (place(at), peak(loads).line_load)).collect();
                let at = |s: f64| self.balance(s, 0.0).ok().map(|loads| peak(&loads));
                let (s, _) = greatest(&known, |s| at(s).map_or(0.0, |peak| peak.line_load));
                at(s).filter(|peak| peak.line_load > 0.0)
            }),
            line_loads,
        };
        let spectrum = Spectrum {
            amplitudes: sums.map(|[cosine, sine]| 2.0 * cosine.hypot(sine) / steps as f64),
            peak_to_peak: extreme(&|loads| loads.displacement)
                + extreme(&|loads| -loads.displacement),
        };
        let tooth_force = extreme(&|loads| {
            loads.pairs().map(|ahead| self.force(loads, ahead, Part::All)).fold(0.0, f64::max)
        });
        Ok((cycle, StaticSpectrum { spectrum, tooth_force }))
    }

    /// The greatest lead of the incoming tooth before E over the face, in m: the displacement by the
    /// other pairs less its gap. Above 0 the tip touches before E.
    ///
    /// # Errors
    /// Those of [`Face::loads`].
    pub fn lead_before_start(&self) -> Result<f64, Refusal> {
        let (mesh, step) = (&self.mesh, self.mesh.base_pitch / self.steps() as f64);
        let (from, to) = (mesh.ends().0 - self.reach, self.reach);
        let lead = |s: f64| -> Result<f64, Refusal> {
            let loads = self.loads(s, mesh.error, Until::Force(mesh.force), Some(0))?;
            let all = self.slices.iter().enumerate().filter(|(_, slice)| s + slice.ahead <= 0.0);
            let leads = all.map(|(number, _)| loads.lead_at(0, number));
            Ok(leads.fold(f64::NEG_INFINITY, f64::max).max(-mesh.length))
        };
        let count = ((to - from) / step).ceil() as usize;
        let places = (0..=count).map(|number| from + (to - from) * number as f64 / count as f64);
        let known: Vec<(f64, f64)> =
            places.map(|s| Ok((s, lead(s)?))).collect::<Result<_, Refusal>>()?;
        Ok(greatest(&known, |s| lead(s).unwrap_or(f64::NEG_INFINITY)).1)
    }

    /// The station of the incoming tooth. Gap, compliance and velocities are those of the slice with the
    /// least gap.
    fn station(&self, loads: &Loads) -> Station {
        let mesh = &self.mesh;
        let kept = |slice: &Slice| mesh.zone_at(loads.s + slice.ahead);
        let gap = |slice: &Slice| {
            let (zone, place) = kept(slice);
            mesh.values(zone, place)[1] + slice.gap
        };
        let nearest = self.slices.iter().min_by(|one, other| gap(one).total_cmp(&gap(other)));
        let nearest = nearest.copied().unwrap_or(self.slices[0]);
        let (zone, place) = kept(&nearest);
        let [stiffness, _, _, sliding] = mesh.values(zone, place);
        let force = self.force(loads, 0, Part::All);
        let total: f64 = self.over_face(&loads.of_all(), |_| 1.0);
        Station {
            roll_angle_driver: 0.0 - loads.s / mesh.base_radii.0,
            roll_angle_driven: 0.0 - loads.s / mesh.base_radii.1,
            force,
            normal_velocity: 0.0 - mesh.gap_slope(zone, place) * mesh.speed,
            sliding_velocity: mesh.sliding(sliding),
            gap: gap(&nearest),
            pair_compliance: Some(mesh.width / stiffness),
            own: Own::Shared {
                part: if total > 0.0 { force / total } else { 0.0 },
                displacement: loads.displacement,
                motion: None,
            },
        }
    }

    /// The load of the incoming tooth from its first to its last contact.
    ///
    /// # Errors
    /// Those of [`Face::loads`].
    #[expect(clippy::too_many_lines, reason = "one value after the other from the same samples")]
    pub fn static_load(
        &self,
        spacing: Spacing,
    ) -> Result<(StaticLoad, Option<Arc<FaceLoad>>), Refusal> {
        /// Looks for the ends of the contact in a base pitch.
        const LOOKS: f64 = 16.0;
        let (mesh, error) = (&self.mesh, self.mesh.error);
        let (from, to) = mesh.ends();
        let (from, to) = (from - self.reach, to + self.reach);
        let count = (LOOKS * (to - from) / mesh.base_pitch).ceil() as usize;
        let place = |number: usize| from + (to - from) * number as f64 / count as f64;
        let lead = |s: f64| -> Result<(f64, usize), Refusal> {
            let loads = self.loads(s, error, Until::Force(mesh.force), Some(0))?;
            Ok(loads.lead(0))
        };
        let carries = |number: &usize| lead(place(*number)).is_ok_and(|(lead, _)| lead > 0.0);
        let mut ends = [0, count];
        for (end, is_first) in ends.iter_mut().zip([true, false]) {
            let found =
                if is_first { (0..=count).find(carries) } else { (0..=count).rev().find(carries) };
            match found {
                Some(number) => *end = number,
                None => return Ok((StaticLoad::default(), None)),
            }
        }
        let root = |carrying: usize, apart: usize| {
            let of = |s: f64| {
                lead(s).map_or(f64::NAN, |(lead, _)| lead.clamp(-mesh.length, mesh.length))
            };
            root::between(place(apart), place(carrying), of)
        };
        if ends[0] == 0 || ends[1] == count {
            return Err(Refusal::BeyondReach);
        }
        let first = root(ends[0], ends[0] - 1);
        let last = root(ends[1], ends[1] + 1);
        let face_place = |s: f64| -> Result<FacePlace, Refusal> {
            let (_, slice) = lead(s)?;
            let Slice { z, ahead, .. } = self.slices[slice];
            Ok(FacePlace { z, path: s + ahead })
        };
        let (first_place, last_place) = (face_place(first)?, face_place(last)?);
        let steps = (0.5 * self.steps() as f64 * (last - first) / mesh.base_pitch).ceil().max(2.0);
        let place = |step: u32| first + (last - first) * f64::from(step) / steps;
        let places: Vec<f64> = (0..=steps as u32).map(place).collect();
        let all: Vec<Loads> =
            places.iter().map(|&s| self.balance(s, error)).collect::<Result<_, _>>()?;
        let extreme = |of: &dyn Fn(&Loads) -> f64| {
            let known: Vec<_> = places.iter().zip(&all).map(|(&s, loads)| (s, of(loads))).collect();
            let at = |s: f64| self.balance(s, error).map_or(f64::NEG_INFINITY, |loads| of(&loads));
            greatest(&known, at)
        };
        let line_peak = |part: Part| {
            let peak = |loads: &Loads| self.line_peak(loads, std::iter::once(0), part);
            let (s, _) = extreme(&|loads| peak(loads).line_load);
            self.balance(s, error)
                .ok()
                .map(|loads| peak(&loads))
                .filter(|peak| peak.line_load > 0.0)
        };
        let peak_force = extreme(&|loads| self.force(loads, 0, Part::All)).1;
        let failed = Cell::new(None);
        let (stations, rough) = Station::through_start(first, last, |from, to| {
            spacing.stations(&[from, to], peak_force, STATIONS, |s| {
                let station = self.balance(s, error).map(|loads| self.station(&loads));
                match station {
                    Ok(station) => (station.force, station),
                    Err(refusal) => {
                        failed.set(Some(refusal));
                        (0.0, self.station(&all[0]))
                    }
                }
            })
        });
        if let Some(refusal) = failed.into_inner() {
            return Err(refusal);
        }
        let ahead = |place: &FacePlace| -place.path / mesh.base_radii.1;
        let behind = |place: &FacePlace| (place.path - mesh.length) / mesh.base_radii.0;
        let before_start = line_peak(Part::BeforeStart);
        // Reliefs can let the tooth touch after E at its end and before E farther inside.
        let (_, deepest) = extreme(&|loads| self.deepest(loads));
        let strikes = before_start.is_some().then_some(deepest / mesh.base_radii.1);
        let first_angle = Some(ahead(&first_place)).filter(|angle| *angle > 0.0).or(strikes);
        let load = StaticLoad {
            first_contact_angle: first_angle,
            last_contact_angle: Some(behind(&last_place)).filter(|angle| *angle > 0.0),
            force_at_end: extreme(&|loads| self.force(loads, 0, Part::AfterEnd)).1,
            force_at_start: extreme(&|loads| self.force(loads, 0, Part::BeforeStart)).1,
            peak_force,
            transmission_error: extreme(&|loads| loads.displacement).1
                + extreme(&|loads| -loads.displacement).1,
            pitch_jump: None,
            stations,
            rough,
        };
        let at_slices = |loads: &Loads| (0..self.slices.len()).map(|at| loads.at(0, at)).collect();
        let face = FaceLoad {
            first: first_place,
            last: last_place,
            peak: line_peak(Part::All).ok_or(Refusal::BeyondReach)?,
            before_start,
            after_end: line_peak(Part::AfterEnd),
            pattern: all.iter().map(at_slices).collect(),
            paths: places,
        };
        Ok((load, Some(Arc::new(face))))
    }
}
