//! The zones of a mesh: the line of action, and the ranges before and after it with contact of a
//! tip.

use super::MeshInputs;
use crate::model::Refusal;
use crate::model::compliance::ContactPlace;
use crate::model::compliance::flanks::Flanks;
use crate::model::geometry::{Geometry, geometry};
use crate::model::position::first_contact;
use crate::model::position::{TipContact, angle_at_curvature, gap, tip_at};
use crate::model::relief::Relief;
use crate::numeric::chebyshev::Series;
use crate::numeric::{bounds, distinct, root};

/// Greatest angle of a tip beyond its end of the path of contact, in rad.
const LARGEST_ANGLE: f64 = 1.5;

pub(super) const STIFFNESS: usize = 0;
pub(super) const GAP: usize = 1;
pub(super) const LEVER: usize = 2;
pub(super) const SLIDING: usize = 3;

/// A part of the path in which all functions are smooth.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Zone {
    pub(super) from: f64,
    pub(super) to: f64,
    /// Stiffness, gap, arm of the friction force, and sliding velocity per unit of speed.
    pub(super) series: Series<4>,
    /// What the last terms of the gap may be, in m.
    pub(super) gap_rest: f64,
}

impl Zone {
    /// The zone of the back flanks, with pairs that move backwards from `length` and slide in the
    /// opposite direction.
    pub(super) fn reversed(&self, length: f64) -> Zone {
        let mut signs = [1.0; 4];
        signs[SLIDING] = -1.0;
        Zone {
            from: length - self.to,
            to: length - self.from,
            series: self.series.reversed(length, signs),
            gap_rest: self.gap_rest,
        }
    }
}

/// The pair at one end of its path of contact: the run-in, or with swapped gears the run-out.
pub(super) struct End {
    pub(super) inputs: MeshInputs,
    pub(super) geometry: Geometry,
    pub(super) flanks: Flanks,
    /// −1 if s falls with the distance from the path of contact.
    pub(super) side: f64,
}

/// Adds the zones between the borders, in which the four functions of `f` are smooth, with a
/// relative error of 1e-13. The precision of a gap, which grows from `edge`, is that of the
/// distance from `edge` and of the relief.
fn push_zones(
    borders: Vec<f64>,
    (size, edge, relief): ([f64; 4], f64, &Relief),
    f: &impl Fn(f64) -> Result<[f64; 4], Refusal>,
    zones: &mut Vec<Zone>,
) -> Result<(), Refusal> {
    const REST: f64 = 1e-13;
    let relief_rounding = relief.rounding();
    let rest = |from: f64, to: f64| {
        let mut rest = size.map(|size| REST * size);
        rest[GAP] += 16.0 * f64::EPSILON * (from - edge).abs().max((to - edge).abs());
        rest[GAP] = rest[GAP].max(relief_rounding);
        rest
    };
    let (first, last) = bounds(borders.iter().copied());
    for ends in distinct(borders, 1e-9 * (last - first)).windows(2) {
        let (from, to) = (ends[0], ends[1]);
        zones.push(Zone {
            from,
            to,
            series: Series::of(from, to, &rest, f)?,
            gap_rest: rest(from, to)[GAP],
        });
    }
    Ok(())
}

/// The zones of the line of action, and the places where the load on a flank begins or stops to
/// move off the corner of the tip.
pub(super) fn line_zones(
    inputs: &MeshInputs,
    geometry: &Geometry,
    (flanks, relief): (&Flanks, &Relief),
    force: f64,
    zones: &mut Vec<Zone>,
) -> Result<Vec<f64>, Refusal> {
    let length = geometry.end - geometry.start;
    let rest = geometry.tangent_length - geometry.start;
    let speeds = inputs.speed + inputs.driven_speed();
    let at = |s: f64| {
        let along = geometry.start + s;
        let place = ContactPlace::on_line_of_action(geometry, along);
        let compliances =
            flanks.at_load(&inputs.elasticity, geometry, &place, (along, rest - s), force)?;
        Ok([
            inputs.elasticity.width / compliances.iter().sum::<f64>(),
            relief.at(along, rest - s),
            along / geometry.driver.base,
            speeds * (geometry.approach_length - s),
        ])
    };
    let pitch_point = [geometry.approach_length];
    let driver_ends = relief.ends_on_driver().map(|curvature| curvature - geometry.start);
    let driven_ends = relief.ends_on_driven().map(|curvature| rest - curvature);
    let bends = flanks.bends((0.0, length), |s| {
        let along = geometry.start + s;
        let place = ContactPlace::on_line_of_action(geometry, along);
        let half_width = inputs.elasticity.half_width(&place, force);
        ((along, rest - s), half_width)
    });
    let ends = driver_ends.chain(driven_ends).chain(pitch_point);
    let mut borders: Vec<f64> = ends.chain(bends.iter().copied()).collect();
    borders.retain(|&border| border > 0.0 && border < length);
    borders.extend([0.0, length]);
    let stiffness = at(0.5 * length)?[STIFFNESS];
    push_zones(
        borders,
        ([stiffness, relief.most(), 1.0, speeds * length], 0.0, relief),
        &at,
        zones,
    )?;
    Ok(bends)
}

/// Compliance of both teeth without the contact at a place on the line of action, in m²/N.
pub(super) fn teeth_on_line(
    inputs: &MeshInputs,
    geometry: &Geometry,
    flanks: &Flanks,
    force: f64,
    s: f64,
) -> Result<[f64; 2], Refusal> {
    let along = geometry.start + s;
    let (place, arms) = (
        ContactPlace::on_line_of_action(geometry, along),
        (along, geometry.tangent_length - along),
    );
    let [driver, driven, _] = flanks.at_load(&inputs.elasticity, geometry, &place, arms, force)?;
    Ok([driver, driven])
}

impl End {
    /// Compliance of both teeth without the contact at an angle from the end of the path of contact,
    /// in m²/N.
    pub(super) fn teeth(&self, force: f64, angle: f64) -> Result<[f64; 2], Refusal> {
        let tip = tip_at(&self.geometry, angle);
        let (place, arms) = (self.place_of(&tip), self.arms(&tip));
        let elasticity = &self.inputs.elasticity;
        let found = self.flanks.at_load(elasticity, &self.geometry, &place, arms, force)?;
        Ok([found[0], found[1]])
    }

    /// The other end, with the gears swapped: the driver's tip touches the driven flank.
    pub(super) fn swapped(&self) -> Result<End, Refusal> {
        let inputs = self.inputs.swapped();
        let geometry = geometry(&inputs.shape).map_err(|refusal| match refusal {
            Refusal::Interference { start } => Refusal::InterferenceAtEnd { start },
            other => other,
        })?;
        Ok(End { inputs, geometry, flanks: self.flanks.swapped(), side: 1.0 })
    }

    /// The angle up to which gaps are below `reach`, and whether the circle of the tip ends there.
    pub(super) fn angle_of_reach(&self, reach: f64) -> (f64, bool) {
        let circle = angle_at_curvature(&self.geometry, self.geometry.end);
        let whole = if circle.is_finite() { circle.min(LARGEST_ANGLE) } else { LARGEST_ANGLE };
        let whole = self.end_of_rounding(whole);
        match first_contact(&self.geometry, reach) {
            Ok(angle) if angle < whole => (angle, false),
            _ => (whole, true),
        }
    }

    /// The zones from the end of the path of contact at `edge` to the angle `reach`, and the places
    /// where the load on a flank begins or stops to move off the corner of the tip.
    pub(super) fn zones(
        &self,
        relief: &Relief,
        force: f64,
        reach: f64,
        edge: f64,
        zones: &mut Vec<Zone>,
    ) -> Result<Vec<f64>, Refusal> {
        let base = self.geometry.driven.base;
        let angle_of = |s: f64| (self.side * (s - edge) / base).max(0.0);
        let at = |s: f64| self.at(relief, force, angle_of(s));
        let bends = self.angles_of_bends(force, reach);
        let turns = self
            .angles_of_relief_ends(relief)
            .chain(self.angle_of_rolling(reach))
            .chain(bends.iter().copied());
        let turns = turns.filter(|&angle| angle > 0.0 && angle < reach);
        let place_of = |angle: f64| edge + self.side * base * angle;
        let borders = turns.chain([0.0, reach]).map(place_of).collect();
        let (start, end) = (at(edge)?, at(edge + self.side * base * reach)?);
        let size = |function: usize| start[function].abs().max(end[function].abs());
        push_zones(
            borders,
            ([start[STIFFNESS], 0.0, size(LEVER), size(SLIDING)], edge, relief),
            &at,
            zones,
        )?;
        Ok(bends.into_iter().map(place_of).collect())
    }

    fn angles_of_bends(&self, force: f64, reach: f64) -> Vec<f64> {
        self.flanks.bends((0.0, reach), |angle| {
            let tip = tip_at(&self.geometry, angle);
            let place = self.place_of(&tip);
            let half_width = self.inputs.elasticity.half_width(&place, force);
            (self.arms(&tip), half_width)
        })
    }

    /// Distances of the load points from N₁ and N₂, in m.
    fn arms(&self, tip: &TipContact) -> (f64, f64) {
        (tip.curvature_driver, tip.load_arm_driven(&self.geometry))
    }

    /// The contact place of the tip at an angle from the end of the path of contact.
    pub(super) fn place(&self, angle: f64) -> ContactPlace {
        self.place_of(&tip_at(&self.geometry, angle))
    }

    fn place_of(&self, tip: &TipContact) -> ContactPlace {
        ContactPlace::at_tip(self.inputs.tip_radii[1], &self.geometry, tip)
    }

    /// The four values at an angle from the end of the path of contact.
    fn at(&self, relief: &Relief, force: f64, angle: f64) -> Result<[f64; 4], Refusal> {
        let tip = tip_at(&self.geometry, angle);
        let place = self.place_of(&tip);
        let (elasticity, arms) = (&self.inputs.elasticity, self.arms(&tip));
        let compliances = self.flanks.at_load(elasticity, &self.geometry, &place, arms, force)?;
        let sliding = self.inputs.driven_speed() * tip.sliding_arm;
        let (relief, lever) = if self.side < 0.0 {
            (
                relief.at(tip.curvature_driver, self.geometry.driven.tip_curvature),
                tip.curvature_driver / self.geometry.driver.base,
            )
        } else {
            (
                relief.at(self.geometry.driven.tip_curvature, tip.curvature_driver),
                self.lever_of_tip(&tip),
            )
        };
        Ok([
            elasticity.width / compliances.iter().sum::<f64>(),
            gap(&self.geometry, &tip) + relief,
            lever,
            -self.side * sliding,
        ])
    }

    /// After B the arm of the driver is that of its tip.
    fn lever_of_tip(&self, tip: &TipContact) -> f64 {
        tip.normal_length_driven / self.geometry.driven.base
    }

    fn angles_of_relief_ends(&self, relief: &Relief) -> impl Iterator<Item = f64> {
        let ends: Vec<f64> = if self.side < 0.0 {
            relief.ends_on_driver().collect()
        } else {
            relief.ends_on_driven().collect()
        };
        let geometry = self.geometry;
        ends.into_iter()
            .filter(move |&end| end > geometry.start)
            .map(move |end| angle_at_curvature(&geometry, end))
    }

    /// The angle, at most `whole`, at which the contact leaves the arc of a rounded tip.
    fn end_of_rounding(&self, whole: f64) -> f64 {
        let arm = |angle: f64| tip_at(&self.geometry, angle).normal_radius_driven;
        if self.geometry.driven.edge > 0.0 && arm(whole) < 0.0 {
            root::between(0.0, whole, arm)
        } else {
            whole
        }
    }

    /// The angle at which the tip rolls without sliding and friction reverses.
    fn angle_of_rolling(&self, reach: f64) -> Option<f64> {
        let sliding = |angle: f64| tip_at(&self.geometry, angle).sliding_arm;
        (sliding(0.0) * sliding(reach) < 0.0).then(|| root::between(0.0, reach, sliding))
    }
}
