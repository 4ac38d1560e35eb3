//! The contact pattern: the line load of the incoming tooth over roll angle and face width, and the
//! contact lines on the plane of action.

use super::chart::{Axis, Cell, Chart, Kind, Map, Point, Series, Span};
use super::shown_in;
use crate::case::units;
use crate::case::units::System;
use crate::model::face::FaceInputs;
use crate::model::slices::load::LinePeak;
use crate::model::{FaceLoad, Inputs, Quantity, Solution};

/// The key of the picture.
pub const PATTERN: &str = "contact_pattern";

/// Places of the map along the path of contact.
const COLUMNS: usize = 120;
/// The names of the parts of the contact lines.
const LINES: [&str; 2] = ["contact lines", "outside E to B"];

/// The line load of the incoming tooth over the plane of action.
#[derive(Debug, Clone)]
pub struct Pattern<'a> {
    load: &'a FaceLoad,
    /// Whether it is the load in motion, not at rest.
    is_moving: bool,
    face: FaceInputs,
    /// Length of the path of contact and base pitch, in m.
    length: f64,
    base_pitch: f64,
    /// Base radius of the driver, in m.
    radius: f64,
    /// z of each slice, in m.
    places: Vec<f64>,
}

impl<'a> Pattern<'a> {
    /// The pattern of a solution that has slices.
    #[must_use]
    pub fn of(inputs: &Inputs, solution: &'a Solution) -> Option<Pattern<'a>> {
        let motion = solution.face_motion.as_deref();
        let (load, face) = (motion.or(solution.face_load.as_deref())?, inputs.face()?);
        let geometry = &solution.geometry;
        let places = face.places(face.count(geometry.base_pitch));
        let is_whole = load.pattern.iter().all(|row| row.len() == places.len());
        is_whole.then(|| Pattern {
            load,
            is_moving: motion.is_some(),
            face,
            length: geometry.end - geometry.start,
            base_pitch: geometry.base_pitch,
            radius: geometry.driver.base,
            places,
        })
    }

    /// The driver's roll angles in the middle of the face, counted from E against the rotation, in rad,
    /// z of the slices, in m, and the line load at each angle and slice, in N/m.
    #[must_use]
    pub fn grid(&self) -> (Vec<f64>, &[f64], impl Iterator<Item = f64>) {
        let angles = self.load.paths.iter().map(|path| 0.0 - path / self.radius).collect();
        (angles, &self.places, self.load.pattern.iter().flatten().copied())
    }

    /// The driver's angle by which the slice at z is ahead of the middle of the face, in rad.
    #[must_use]
    pub fn ahead(&self, z: f64) -> f64 {
        self.face.lead * z / self.radius
    }

    /// Gap of the unloaded flanks at z by misalignment and flank lines, in m.
    #[must_use]
    pub fn gap(&self, z: f64) -> f64 {
        self.face.gap(z)
    }

    /// The driver's angle after E of the tooth in the plane at z, in rad, from its first to its last
    /// contact.
    #[must_use]
    pub fn span(&self) -> Span {
        let [first, last] = [&self.load.first, &self.load.last].map(|place| place.path);
        Span::new(0.0, self.length).with(first).with(last).scaled(1.0 / self.radius)
    }

    /// z of the slice `by` slices from the one at z, in m.
    #[must_use]
    pub fn beside(&self, z: f64, by: isize) -> f64 {
        let at = super::chart::nearest(&self.places, z).saturating_add_signed(by);
        self.places[at.min(self.places.len() - 1)]
    }

    /// The line load of the incoming tooth at a driver's angle after E in the plane of the slice
    /// nearest to z, in N/m.
    #[must_use]
    pub fn line_load(&self, angle: f64, z: f64) -> f64 {
        let slice = super::chart::nearest(&self.places, z);
        let s = angle * self.radius - self.face.lead * self.places[slice];
        let paths = &self.load.paths;
        let after = paths.partition_point(|path| *path < s);
        let Some(before) = after.checked_sub(1).filter(|_| after < paths.len()) else { return 0.0 };
        let [one, next] = [before, after].map(|row| self.load.pattern[row][slice]);
        one + (next - one) * (s - paths[before]) / (paths[after] - paths[before])
    }

    /// The driver's angle after E in the middle of the face at the greatest line load before E, or at
    /// the greatest line load of the tooth, in rad.
    #[must_use]
    pub fn at_peak(&self) -> f64 {
        let place = self.load.before_start.unwrap_or(self.load.peak).place;
        place.path / self.radius - self.ahead(place.z)
    }

    /// The pattern in a range of the driver's angle after E in each plane, in deg, with the contact
    /// lines at an angle of the middle of the face, in rad.
    #[must_use]
    pub fn chart(&self, angle: f64, window: Span, system: System) -> Chart {
        let unit = system.unit("mm");
        let height = |z: f64| z / units::factor(unit).unwrap_or(1.0);
        let step = window.length() / COLUMNS as f64;
        let across: Vec<f64> = (0..=COLUMNS).map(|at| window.from + at as f64 * step).collect();
        let loads = self
            .places
            .iter()
            .flat_map(|z| across.iter().map(|angle| self.line_load(angle.to_radians(), *z)));
        let cell = |load: f64| if load > 0.0 { Cell::Value(load) } else { Cell::Blank };
        let cells = loads.map(cell).collect();
        let words = |load: f64| {
            let known = Quantity::find("static_peak_line_load");
            known.map_or_else(String::new, |known| shown_in(known, load, system).to_string())
        };
        let ends = [0.0, self.load.peak.line_load].map(|load| (load, words(load)));
        let degrees = |path: f64| (path / self.radius).to_degrees();
        let peak = |peak: LinePeak| (degrees(peak.place.path), height(peak.place.z));
        let peaks = [Some(self.load.peak), self.load.before_start, self.load.after_end];
        let mut peaks: Vec<Point> = peaks.into_iter().flatten().map(peak).collect();
        peaks.dedup();
        let lines = |is_outside: bool| {
            let lines = self.lines(angle * self.radius, is_outside);
            let line = |line: [Point; 2]| line.map(|(path, z)| (degrees(path), height(z))).to_vec();
            let (name, kind) = (LINES[usize::from(is_outside)].to_owned(), Kind::Curve);
            Series { name, pieces: lines.into_iter().map(line).collect(), kind }
        };
        // No line joins the peaks.
        let pieces = peaks.into_iter().map(|peak| vec![peak]).collect();
        let peaks = Series { name: "peaks".to_owned(), pieces, kind: Kind::Marks(None) };
        let state = if self.is_moving { "in motion" } else { "at rest" };
        let is_drawn = |series: &Series| !series.pieces.is_empty();
        Chart {
            title: format!("Contact pattern: line load of the tooth {state}"),
            across: Axis::new("driver roll angle after E in each plane", "deg"),
            up: Axis::new("z", unit),
            series: [lines(false), lines(true), peaks].into_iter().filter(is_drawn).collect(),
            marks: vec![(0.0, "E"), (degrees(self.length), "B")],
            map: Some(Map {
                value: Axis::new(format!("Line load {state}"), system.unit("N/mm")),
                places: [across, self.places.iter().map(|z| height(*z)).collect()],
                cells,
                ends: Some(ends),
                limit: None,
            }),
        }
    }

    /// The contact lines with the incoming pair at a path s in the middle of the face: the parts from
    /// E to B, or those outside as far as the tooth touches anywhere, as paths and z, in m.
    fn lines(&self, s: f64, is_outside: bool) -> Vec<[Point; 2]> {
        let half = 0.5 * self.face.width;
        let span = self.span().scaled(self.radius);
        let reach = half * self.face.lead.abs();
        let [first, last] =
            [span.from - reach, span.to + reach].map(|to| (to - s) / self.base_pitch);
        let pairs = (first.ceil() as i32)..=(last.floor() as i32);
        let of_pair = |pair: i32| {
            let path = move |z: f64| s + f64::from(pair) * self.base_pitch + self.face.lead * z;
            let z = |to: f64| (to - path(0.0)) / self.face.lead;
            let borders = [span.from, 0.0, self.length, span.to].map(z);
            let inner = borders.into_iter().filter(|z| z.abs() < half);
            let mut ends: Vec<f64> = inner.chain([-half, half]).collect();
            ends.sort_by(f64::total_cmp);
            let parts: Vec<[f64; 2]> = ends.windows(2).map(|ends| [ends[0], ends[1]]).collect();
            let is_drawn = move |[from, to]: &[f64; 2]| {
                let middle = path(f64::midpoint(*from, *to));
                let is_inside = (0.0..=self.length).contains(&middle);
                is_inside != is_outside && (span.from..=span.to).contains(&middle)
            };
            parts.into_iter().filter(is_drawn).map(move |part| part.map(|z| (path(z), z)))
        };
        pairs.flat_map(of_pair).collect()
    }
}

/// The contact pattern at the greatest line load before E.
///
/// # Errors
/// The reason if the pair has no slices, or the method no line load.
pub fn pattern_chart(inputs: &Inputs, solutions: &[&Solution]) -> Result<Chart, String> {
    let found = solutions.iter().find_map(|solution| Pattern::of(inputs, solution));
    match (found, inputs.face()) {
        (Some(pattern), _) => {
            let window = pattern.span().scaled(1f64.to_degrees());
            Ok(pattern.chart(pattern.at_peak(), window, System::Metric))
        }
        (None, Some(_)) => Err("no method computed the line load of the pair".to_owned()),
        (None, None) => {
            Err("a spur pair without misalignment and flank line modification has the \
            same load all over its face"
                .to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::examples::Example;
    use crate::model::{Stage, Stages, solve};

    #[test]
    fn the_load_is_on_the_contact_lines_and_the_parts_outside_e_and_b_are_apart() {
        let case = Example::find("helical-20-35").unwrap().document().case;
        let inputs = case.inputs().unwrap();
        let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
        let pattern = Pattern::of(&inputs, &solution).unwrap();
        let load = solution.face_load.as_ref().unwrap();
        let peak = load.peak;
        let found = pattern.line_load(peak.place.path / pattern.radius, peak.place.z);
        assert!((found / peak.line_load - 1.0).abs() < 0.05, "{found} {peak:?}");
        for (is_outside, span) in [(false, Span::new(0.0, pattern.length)), (true, pattern.span())]
        {
            let all = (0..20).flat_map(|at| {
                pattern.lines(pattern.base_pitch * f64::from(at) / 20.0, is_outside)
            });
            let all: Vec<_> = all.collect();
            assert!(!all.is_empty());
            let rounding = 1e-9;
            let is_inside = |x: f64| x > -rounding && x < pattern.length + rounding;
            for ends in &all {
                assert!(
                    ends.iter().all(|(x, z)| z.abs() <= 0.5 * pattern.face.width + rounding
                        && (is_outside || is_inside(*x))),
                    "{ends:?} {span:?}"
                );
                let middle = f64::midpoint(ends[0].0, ends[1].0);
                assert_eq!(is_inside(middle), !is_outside);
            }
        }
        let spur = Example::find("zhou-chen-2014").unwrap().document().case.inputs().unwrap();
        assert!(pattern_chart(&spur, &[]).is_err());
    }
}
