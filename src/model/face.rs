//! The inputs of the face width: helix, misalignment and flank lines, and the coupling along a tooth.

use super::Refusal;
use super::geometry::Geometry;
use super::inputs::{Gear, GearSide, Inputs};
use crate::numeric::distinct;

/// The inputs of the face width. z is the place along the axis from the middle of the common face, in
/// m; the driver turns positively about +z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceInputs {
    /// h tan β_b: the path of a slice ahead of the middle per unit of z. h is 1 for a right-hand
    /// driver and −1 for a left-hand one.
    pub lead: f64,
    /// 1/cos β_b.
    pub oblique: f64,
    /// Common face width b, in m.
    pub width: f64,
    /// Misalignment F_βx over the common face, in m.
    pub misalignment: f64,
    /// The flank lines of driver and driven gear.
    pub flanks: [FlankLine; 2],
    /// Number of slices; `None` for as many as the pair needs.
    pub slices: Option<usize>,
    /// Length L over which a force displaces the slices beside it, in m; 0 for independent slices.
    pub coupling_length: f64,
    /// Softening of the acute end and stiffening of the obtuse end of a tooth, times its compliance.
    pub ends: [f64; 2],
    /// Length over which the effect of an end decays, in m.
    pub end_decay: f64,
}

/// The flank line of a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankLine {
    /// z of the middle of the face, in m.
    pub middle: f64,
    /// Face width, in m.
    pub width: f64,
    /// Opening of the flanks from one end of the face to the other by the helix slope deviation, in m.
    pub slope: f64,
    /// Crowning C_β, in m.
    pub crowning: f64,
    /// End relief at −z and +z, in m.
    pub end_reliefs: [f64; 2],
    /// Length of the end reliefs, in m.
    pub end_relief_length: f64,
}

impl FlankLine {
    /// Gap at z by this flank, in m.
    ///
    /// # Formula
    /// ```text
    /// f (z − c)/b + C_β (2 (z − c)/b)² + end reliefs, linear over their length
    /// ```
    fn gap(&self, z: f64) -> f64 {
        let part = (z - self.middle) / self.width;
        let end =
            |relief: f64, depth: f64| relief * (1.0 - depth / self.end_relief_length).max(0.0);
        let [minus, plus] = self.depths(z);
        let ends = end(self.end_reliefs[0], minus) + end(self.end_reliefs[1], plus);
        self.slope * part + self.crowning * (2.0 * part).powi(2) + ends
    }

    /// Distances of z from the ends of the face at −z and +z, in m.
    fn depths(&self, z: f64) -> [f64; 2] {
        let aside = z - self.middle;
        [0.5 * self.width + aside, 0.5 * self.width - aside].map(|depth| depth.max(0.0))
    }
}

impl Inputs {
    /// The inputs of the face width. `None` if all slices of the pair are equal: a spur pair without
    /// misalignment and flank line modification.
    pub fn face(&self) -> Option<FaceInputs> {
        /// Coupling length over the whole depth of a tooth.
        const OF_DEPTH: f64 = 0.58;
        let is_even =
            |gear: &Gear| gear.helix_slope == 0.0 && gear.crowning == 0.0 && !gear.has_end_relief();
        let is_plain = self.helix_angle == 0.0 && self.misalignment == 0.0;
        if is_plain && is_even(&self.driver) && is_even(&self.driven) {
            return None;
        }
        let (first, last) = self.common_face();
        let (hand, middle) = (self.driver_hand.sign(), f64::midpoint(first, last));
        let flank = |gear: &Gear, middle: f64, sign: f64| FlankLine {
            middle,
            width: gear.face_width,
            slope: sign * hand * gear.helix_slope,
            crowning: gear.crowning,
            end_reliefs: gear.end_reliefs,
            end_relief_length: gear.length_of_end_relief(),
        };
        let depth = |gear: &Gear| self.module * (self.addendum_of(gear) + self.dedendum_of(gear));
        let length = OF_DEPTH * 0.5 * (depth(&self.driver) + depth(&self.driven));
        let tangent = self.helix_angle.tan();
        let given = self.elasticity().given;
        Some(FaceInputs {
            lead: hand * self.base_helix_angle().tan(),
            oblique: self.base_helix_angle().cos().recip(),
            width: last - first,
            misalignment: self.misalignment,
            flanks: [
                flank(&self.driver, -middle, -1.0),
                flank(&self.driven, self.face_offset - middle, 1.0),
            ],
            slices: self.slices,
            coupling_length: match given {
                _ if !self.slice_coupling => 0.0,
                Some(given) => given.coupling_length.unwrap_or(0.0),
                None => length,
            },
            ends: match given {
                _ if !self.slice_coupling => [0.0; 2],
                Some(given) => [given.end_acute, given.end_obtuse],
                None => [tangent * (0.75 + 1.3 * tangent), tangent * (0.62 - 0.5 * tangent)],
            },
            end_decay: given.and_then(|given| given.end_decay).unwrap_or(length),
        })
    }
}

impl FaceInputs {
    /// Overlap ratio ε_β = b tan β_b/p_bt.
    pub fn overlap_ratio(&self, geometry: &Geometry) -> f64 {
        self.width * self.lead.abs() / geometry.base_pitch
    }

    /// Total contact ratio ε_γ = ε_α + ε_β.
    pub fn total_contact_ratio(&self, geometry: &Geometry) -> f64 {
        geometry.contact_ratio + self.overlap_ratio(geometry)
    }

    /// Gap of the unloaded flanks at z by misalignment and flank lines, in m.
    pub fn gap(&self, z: f64) -> f64 {
        let [driver, driven] = self.flanks.map(|flank| flank.gap(z));
        self.misalignment * z / self.width + driver + driven
    }

    /// Mean of this gap over the face, the least gap and its z, in m.
    pub fn gaps(&self) -> (f64, f64, f64) {
        let (mut sum, mut least) = (0.0, (f64::INFINITY, 0.0));
        // Each piece is a parabola.
        for ends in self.places(2).windows(2) {
            let (middle, half) = (f64::midpoint(ends[0], ends[1]), 0.5 * (ends[1] - ends[0]));
            let [start, inner, end] = [ends[0], middle, ends[1]].map(|z| self.gap(z));
            sum += (start + 4.0 * inner + end) * half / 3.0;
            let bend = start - 2.0 * inner + end;
            let bottom =
                if bend > 0.0 { (0.5 * (start - end) / bend).clamp(-1.0, 1.0) } else { 0.0 };
            for z in [ends[0], middle + bottom * half, ends[1]] {
                let gap = self.gap(z);
                least = if gap < least.0 { (gap, z) } else { least };
            }
        }
        (sum / self.width, least.0, least.1)
    }

    /// Factor of the compliance of a gear's tooth at z.
    ///
    /// # Formula
    /// ```text
    /// 1 + c_a exp(−d_a/L) − c_o exp(−d_o/L)
    /// ```
    /// d_a and d_o are the distances from the acute and the obtuse end of the loaded flank. The
    /// driver's flank is acute at its leading end, the driven flank at the other one.
    ///
    /// # Source
    /// Own finite elements in three dimensions, for 10, 20 and 30 deg: an end is softer by 17, 44
    /// and 87 % and stiffer by 9, 16 and 19 %.
    pub(super) fn end_factor(&self, gear: usize, z: f64) -> f64 {
        let [minus, plus] = self.flanks[gear].depths(z);
        let is_acute_plus = (self.lead >= 0.0) == (gear == 0);
        let (acute, obtuse) = if is_acute_plus { (plus, minus) } else { (minus, plus) };
        let part = |factor: f64, depth: f64| factor * (-depth / self.end_decay).exp();
        1.0 + part(self.ends[0], acute) - part(self.ends[1], obtuse)
    }

    /// z of the places where an end relief begins.
    pub fn bends(&self) -> impl Iterator<Item = f64> {
        let begins = self.flanks.iter().flat_map(|flank| {
            let inner = 0.5 * flank.width - flank.end_relief_length;
            let [minus, plus] = flank.end_reliefs.map(|relief| relief > 0.0);
            let places = [(minus, flank.middle - inner), (plus, flank.middle + inner)];
            places.into_iter().filter(|(is_given, _)| *is_given).map(|(_, z)| z)
        });
        begins.filter(|z| z.abs() < 0.5 * self.width)
    }

    /// z of about `count` slices: both ends of the face, the places where an end relief begins, and
    /// even steps between them.
    pub fn places(&self, count: usize) -> Vec<f64> {
        let (first, last) = (-0.5 * self.width, 0.5 * self.width);
        let borders = self.bends().chain([first, last]);
        let borders = distinct(borders.collect(), 1e-9 * self.width);
        let step = self.width / (count - 1) as f64;
        let mut places = vec![first];
        for ends in borders.windows(2) {
            let steps = ((ends[1] - ends[0]) / step - 1e-9).ceil().max(1.0);
            let inner = (1..=steps as u32)
                .map(|part| ends[0] + (ends[1] - ends[0]) * f64::from(part) / steps);
            places.extend(inner);
        }
        places
    }

    /// Number of slices: that of the case, or so many that loads are within about 0.1 %, and the harmonics of
    /// the transmission error within about 1e-5 of the mean deflection.
    pub fn count(&self, base_pitch: f64) -> usize {
        /// Overlap ratio, slices and coupling lengths of the usual number.
        const LEAST: usize = 41;
        const PER_PITCH: f64 = 45.0;
        const PER_LENGTH: f64 = 6.0;
        let overlap = self.width * self.lead.abs() / base_pitch;
        let lengths = self.width / self.coupling_length;
        let by_length = if lengths.is_finite() { PER_LENGTH * lengths } else { 0.0 };
        let needed = (PER_PITCH * overlap).max(by_length).ceil() as usize;
        self.slices.unwrap_or((needed | 1).clamp(LEAST, MOST_SLICES))
    }
}

/// Greatest number of slices.
pub const MOST_SLICES: usize = 4097;

/// The refusals of a face width.
///
/// # Errors
/// [`Refusal::TotalContactRatioBelowOne`] if no pair is in contact at times,
/// [`Refusal::EndReliefsOverlap`], [`Refusal::TooFewSlices`].
pub(super) fn check_face(inputs: &FaceInputs, geometry: &Geometry) -> Result<(), Refusal> {
    /// Least number of slices in a base pitch of the overlap.
    const PER_PITCH: f64 = 8.0;
    let ratio = inputs.total_contact_ratio(geometry);
    if ratio < 1.0 {
        return Err(Refusal::TotalContactRatioBelowOne { ratio });
    }
    let sides = [GearSide::Driver, GearSide::Driven];
    for (side, flank) in sides.into_iter().zip(&inputs.flanks) {
        let ends = flank.end_reliefs.iter().filter(|relief| **relief > 0.0).count() as f64;
        let (length, width) = (ends * flank.end_relief_length, flank.width);
        // A conversion to another unit rounds.
        if length > width * (1.0 + 1e-12) {
            return Err(Refusal::EndReliefsOverlap { gear: side, length, width });
        }
    }
    let least = (PER_PITCH * inputs.overlap_ratio(geometry)).ceil() as usize;
    match inputs.slices {
        Some(slices) if slices < least => Err(Refusal::TooFewSlices { slices, least }),
        _ => Ok(()),
    }
}
