//! Spring and sliding of one pair, at a place and as polynomials over a part of its path.

use super::Mesh;
use super::zones::{GAP, LEVER, STIFFNESS};
use crate::numeric::chebyshev::TERMS;
use crate::numeric::polynomial::Polynomial;

impl Mesh {
    /// Stiffness and gap of a pair, including its error.
    pub(in crate::model) fn spring(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let at = s + f64::from(ahead) * self.base_pitch;
        let [stiffness, gap] = self.zones[zone].series.at(at);
        (stiffness, gap - self.error_of(ahead))
    }

    /// Stiffness of the incoming pair just after E over its stiffness just before E.
    #[must_use]
    pub fn stiffness_step(&self) -> f64 {
        let beside = 1e-9 * self.base_pitch;
        let [before, after] = [-beside, beside].map(|s| self.spring(0, self.zone(s), 0.0).0);
        after / before
    }

    /// Stiffness and gap of a pair from `s` to `s + length`, including its error, as polynomials
    /// from 0 to 1.
    pub(in crate::model) fn spring_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [stiffness, mut gap] =
            self.zones[zone].series.local(STIFFNESS, self.above(ahead, s), length);
        gap.0[0] -= self.error_of(ahead);
        [stiffness, gap]
    }

    /// The gap of a pair, see [`Mesh::spring_along`].
    pub(in crate::model) fn gap_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> Polynomial<TERMS> {
        let [mut gap] = self.zones[zone].series.local(GAP, self.above(ahead, s), length);
        gap.0[0] -= self.error_of(ahead);
        gap
    }

    /// Between what values its gap is on the piece that serves from `s` up.
    pub(in crate::model) fn gap_bounds(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let (low, high) = self.zones[zone].series.bounds(GAP, self.above(ahead, s));
        let error = self.error_of(ahead);
        (low - error, high - error)
    }

    /// Arm of the friction force over the driver's base radius, and sliding velocity, as
    /// polynomials, see [`Mesh::spring_along`].
    pub(in crate::model) fn slide_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [lever, sliding] = self.zones[zone].series.local(LEVER, self.above(ahead, s), length);
        [lever, sliding.scaled(self.driver_speed)]
    }

    /// Length from `s` on in which these polynomials are valid, within the zone.
    pub(in crate::model) fn serves_until(&self, ahead: i32, zone: usize, s: f64) -> f64 {
        let (at, least) = self.above(ahead, s);
        s + (self.zones[zone].series.serves_until(at, least) - at)
    }

    /// The place of a pair, and the distance below which two places are equal.
    pub(in crate::model) fn above(&self, ahead: i32, s: f64) -> (f64, f64) {
        (s + f64::from(ahead) * self.base_pitch, 16.0 * f64::EPSILON * s.abs())
    }

    /// Arm of the friction force over the driver's base radius, and sliding velocity in m/s.
    pub(in crate::model) fn slide(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let at = s + f64::from(ahead) * self.base_pitch;
        let [_, _, lever, sliding] = self.zones[zone].series.at(at);
        (lever, self.driver_speed * sliding)
    }
}
