//! Compliance of a gear's teeth and body, from plane-strain finite elements on the whole gear.

pub mod body;
mod boundary;
pub mod cache;
mod element;
mod envelope;
mod fit;
mod grading;
mod harmonics;
mod load;
mod mesh;
mod mode;
mod solve;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

pub use super::limits::field::FieldRefusal;
use super::profile::Profile;
use crate::numeric::real::Lanes;
use boundary::Boundary;
use fit::{Abscissa, CrossSeries, Flank, Interpolation, Series};
use grading::Grading;
use harmonics::Displacements;
use load::Load;

/// Greatest distance, in pitches, at which a force on one tooth displaces another. Pairs in contact
/// are not farther apart if the contact ratio is below 4.
pub const PITCHES: usize = 3;

/// Input of the field of a gear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldInput {
    /// Profile of its teeth.
    pub profile: Profile,
    /// Number of teeth z.
    pub teeth: u32,
    /// Module m, in m.
    pub module: f64,
    /// Bore radius r_h at which the body is clamped, in m; 0 for a gear without a bore.
    pub bore_radius: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
}

/// The elastic field of a gear, for Young's modulus 1 and unit face width. A value divided by E is
/// a compliance in m²/N: the displacement in m for a load in N/m.
///
/// A load acts on a flank at a radius, along the tangent to the base circle. Displacements are
/// along the same tangent of the tooth on which they are measured. They exclude the twist of the
/// body about its bore, and without a bore the shift of the body.
///
/// Radii outside of [`Field::radii`] use the nearest radius inside, so that the patch of a load
/// does not extend beyond the tip's corner.
///
/// # Source
/// Finite elements on half a tooth pitch with cyclic symmetry: Thomas 1979 ("Dynamics of
/// rotationally periodic structures").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    flank: Flank,
    /// The abscissas of the surface's series and of the other series.
    abscissas: [Abscissa; 2],
    /// Module, in m.
    module: f64,
    poisson: f64,
    /// Roll angle minus the force's angle to the normal of the centre line, in rad.
    base_half_angle: f64,
    twist: Option<f64>,
    /// Displacement at the centre of a patch of unit half width in modules.
    surface: Series,
    /// Displacement on the centre line under a patch of width 0.
    depth: Series,
    /// Displacement of teeth behind the load.
    cross: [CrossSeries; PITCHES],
}

impl Field {
    /// The field of a gear.
    ///
    /// # Errors
    /// A [`FieldRefusal`] if the gear has no tooth, flank or rim for the elements.
    pub fn build(input: &FieldInput) -> Result<Field, FieldRefusal> {
        Field::graded(input, &Grading::STANDARD)
    }

    /// Checks whether the elements fit the gear, without computing displacements.
    ///
    /// # Errors
    /// Those of [`Field::build`] except [`FieldRefusal::NotPositive`].
    pub fn check(input: &FieldInput) -> Result<(), FieldRefusal> {
        solve::check(input, &Grading::STANDARD)
    }

    fn graded(input: &FieldInput, grading: &Grading) -> Result<Field, FieldRefusal> {
        let boundary = solve::boundary(input)?;
        let (loads, values) = solve::without_twist(input, &boundary, grading)?;
        Ok(Field::fitted(input, &boundary, &loads, &values))
    }

    /// The displacement under a load at the crossing of the line of force and the centre line of
    /// the tooth: tooth and body without the contact.
    ///
    /// `half_width` of the elliptical patch is in m and can be 0.
    ///
    /// # Formula
    /// ```text
    /// q(a) = q(0) − (1 + ν)(2 − ν)/(4π h²) a²
    /// ```
    /// h is the depth of the centre line below the flank, along the force.
    #[must_use]
    pub fn depth(&self, radius: f64, half_width: f64) -> f64 {
        let roll = self.flank.roll(radius);
        let share = half_width / self.centre_depth(radius);
        self.depth.at(self.abscissas[1].at(roll)) - depth_loss(self.poisson) * share * share
    }

    /// The displacement at the centre of the elliptical patch of a load, contact included.
    /// `half_width` is in m and above 0.
    ///
    /// # Formula
    /// ```text
    /// q(a) = q(m) + 2 (1 − ν²)/π ln(m/a)
    /// ```
    #[must_use]
    pub fn surface(&self, radius: f64, half_width: f64) -> f64 {
        let roll = self.flank.roll(radius);
        self.surface.at(self.abscissas[0].at(roll))
            + surface_slope(self.poisson) * (self.module / half_width).ln()
    }

    /// Decrease of the displacement under a patch per unit of ln a.
    ///
    /// # Formula
    /// ```text
    /// 2 (1 − ν²)/π
    /// ```
    #[must_use]
    pub fn surface_slope(&self) -> f64 {
        surface_slope(self.poisson)
    }

    /// The displacement at radius `measured` of the tooth `pitches` ahead of the tooth loaded at
    /// radius `loaded`. Teeth in the direction of the force are ahead; teeth behind have negative
    /// numbers.
    ///
    /// 0 for the loaded tooth itself, and for teeth more than [`PITCHES`] away.
    #[must_use]
    pub fn cross(&self, loaded: f64, measured: f64, pitches: i32) -> f64 {
        let at = |radius: f64| Lanes([self.abscissa(radius)]);
        let Lanes([found]) = self.cross_at([at(loaded), at(measured)], pitches);
        found
    }

    /// The same by the [abscissas](Field::abscissa) of load and displacement, several side by side.
    #[must_use]
    pub fn cross_at<const L: usize>(
        &self,
        [loaded, measured]: [Lanes<L>; 2],
        pitches: i32,
    ) -> Lanes<L> {
        let series = self.cross.get((pitches.unsigned_abs() as usize).wrapping_sub(1));
        series.map_or(Lanes::all(0.0), |series| {
            if pitches < 0 { series.at(loaded, measured) } else { series.at(measured, loaded) }
        })
    }

    /// The place at a radius in which displacements of other teeth are smooth, from −1 at the tip's
    /// load to 1 at the junction of fillet and involute.
    #[must_use]
    pub fn abscissa(&self, radius: f64) -> f64 {
        self.abscissas[1].at(self.flank.roll(radius))
    }

    /// The radius of the load whose pressure over ± `half_width`, in m, ends at the tip's corner,
    /// at most the radius of the load next to the tip.
    ///
    /// # Formula
    /// ```text
    /// r² = rb² + La² − 2 rb a
    /// ```
    /// La is the length of the tangent from the base circle to the corner. The arc length of an
    /// involute is L²/(2 rb).
    #[must_use]
    pub fn last_radius(&self, half_width: f64) -> f64 {
        let ([form, last], base) = (self.radii(), self.flank.base);
        let corner = base * self.flank.tip_roll;
        let tangent = (corner * corner - 2.0 * base * half_width).max(0.0).sqrt();
        base.hypot(tangent).clamp(form, last)
    }

    /// The radii from the junction of fillet and involute to the load next to the tip, in m.
    #[must_use]
    pub fn radii(&self) -> [f64; 2] {
        self.flank.radii
    }

    /// The displacement of all teeth by the twist of the body about its bore, which the other
    /// values exclude. `None` without a bore.
    #[must_use]
    pub fn twist(&self) -> Option<f64> {
        self.twist
    }

    /// Depth of the centre line below the flank at a radius along the force, in m. The contact is
    /// inside the tooth if its half-width is smaller.
    #[must_use]
    pub fn centre_depth(&self, radius: f64) -> f64 {
        self.module * self.depth_in_modules(self.flank.roll(radius))
    }

    /// Depth of the centre line below the flank along the force, in modules.
    fn depth_in_modules(&self, roll: f64) -> f64 {
        let angle = roll - self.base_half_angle;
        self.flank.base / self.module * (roll - angle.tan())
    }

    fn fitted(
        input: &FieldInput,
        boundary: &Boundary,
        loads: &[Load],
        values: &Displacements,
    ) -> Field {
        /// Lengths of δ and ε, in modules, for the series of the surface and for the others.
        const BEYOND: [[f64; 2]; 2] = [[0.1, 1.0], [0.2, 1.5]];
        let rolls = [loads[loads.len() - 1].roll, loads[0].roll];
        let flank = Flank::of(input.module * boundary.base, boundary.tip_roll, rolls);
        let abscissas =
            BEYOND.map(|beyond| Abscissa::of(&flank, beyond.map(|length| length * input.module)));
        let [steep, smooth] = abscissas.each_ref().map(|abscissa| {
            Interpolation::new(loads.iter().map(|load| abscissa.at(load.roll)).collect())
        });
        let per_load = |values: &[f64], extra: &dyn Fn(&Load) -> f64| -> Vec<f64> {
            let pairs = values.iter().zip(loads);
            pairs.map(|(value, load)| value + extra(load)).collect()
        };
        let surface =
            per_load(&values.surface, &|load| surface_slope(input.poisson) * load.half_width.ln());
        let depth = per_load(&values.centre, &|load| {
            depth_loss(input.poisson) * (load.half_width / load.depth).powi(2)
        });
        Field {
            flank,
            abscissas,
            module: input.module,
            poisson: input.poisson,
            base_half_angle: input.profile.base_half_angle(),
            twist: (input.bore_radius > 0.0).then(|| {
                let bore = input.bore_radius / input.module;
                body::twist(boundary.base, boundary.root, bore, input.poisson)
            }),
            surface: steep.series(&surface),
            depth: smooth.series(&depth),
            cross: values.cross.each_ref().map(|cross| smooth.cross_series(cross)),
        }
    }
}

/// 2 (1 − ν²)/π.
fn surface_slope(poisson: f64) -> f64 {
    2.0 * (1.0 - poisson * poisson) / PI
}

/// (1 + ν)(2 − ν)/(4π).
fn depth_loss(poisson: f64) -> f64 {
    (1.0 + poisson) * (2.0 - poisson) / (4.0 * PI)
}
