//! Spring and sliding of one pair, at a place and as polynomials over a piece of its way.

use super::Mesh;
use super::zones::{GAP, LEVER, STIFFNESS};
use crate::numeric::chebyshev::TERMS;
use crate::numeric::polynomial::Polynomial;

impl Mesh {
    /// Stiffness and gap of a pair, its error counted.
    pub(in crate::model) fn spring(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let at = s + f64::from(ahead) * self.base_pitch;
        let [stiffness, gap] = self.zones[zone].series.at(at);
        (stiffness, gap - self.error_of(ahead))
    }

    /// Stiffness and gap of a pair over the way from `s` up by `length`, its error counted, as
    /// polynomials of the part of it.
    pub(in crate::model) fn spring_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [stiffness, mut gap] =
            self.zones[zone]
                .series
                .local(STIFFNESS, self.above(ahead, s), length);
        gap.0[0] -= self.error_of(ahead);
        [stiffness, gap]
    }

    /// Its gap alone, over the same way.
    pub(in crate::model) fn gap_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> Polynomial<TERMS> {
        let [mut gap] = self.zones[zone]
            .series
            .local(GAP, self.above(ahead, s), length);
        gap.0[0] -= self.error_of(ahead);
        gap
    }

    /// Arm of the friction force over the driver's base radius, and sliding velocity, over the same
    /// way.
    pub(in crate::model) fn slide_along(
        &self,
        ahead: i32,
        zone: usize,
        s: f64,
        length: f64,
    ) -> [Polynomial<TERMS>; 2] {
        let [lever, sliding] = self.zones[zone]
            .series
            .local(LEVER, self.above(ahead, s), length);
        [lever, sliding.scaled(self.driver_speed)]
    }

    /// How far up from `s` those polynomials serve, within the zone.
    pub(in crate::model) fn serves_until(&self, ahead: i32, zone: usize, s: f64) -> f64 {
        let (at, least) = self.above(ahead, s);
        s + (self.zones[zone].series.serves_until(at, least) - at)
    }

    /// The place of a pair, and the distance below which two places are the same.
    pub(in crate::model) fn above(&self, ahead: i32, s: f64) -> (f64, f64) {
        (
            s + f64::from(ahead) * self.base_pitch,
            16.0 * f64::EPSILON * s.abs(),
        )
    }

    /// Arm of the friction force over the driver's base radius, and sliding velocity in m/s.
    pub(in crate::model) fn slide(&self, ahead: i32, zone: usize, s: f64) -> (f64, f64) {
        let at = s + f64::from(ahead) * self.base_pitch;
        let [_, _, lever, sliding] = self.zones[zone].series.at(at);
        (lever, self.driver_speed * sliding)
    }
}
