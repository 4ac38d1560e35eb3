//! The boundary of half a tooth and half a space, by the arc length from the tip's corner.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use nalgebra::Vector2;

use super::{FieldInput, FieldRefusal};
use crate::model::profile::Profile;

/// Number of intervals in the table of the fillet.
const FILLET_STEPS: usize = 128;
/// Least length of the loaded involute, in modules.
const LEAST_FLANK: f64 = 0.15;
/// Least thickness of the tooth at its tip and at its neck, in modules.
const LEAST_THICKNESS: f64 = 0.004;

/// Rounding tolerance of half a space's angle at the root circle, in rad.
const LEAST_ANGLE: f64 = 1e-12;

/// The boundary in modules: x across the tooth from its centre line, y along it from the gear's
/// centre.
#[derive(Debug, Clone)]
pub(super) struct Boundary {
    profile: Profile,
    module: f64,
    /// Radius of the base circle.
    pub(super) base: f64,
    /// Radius of the root circle.
    pub(super) root: f64,
    /// Radius of the tip circle.
    pub(super) tip: f64,
    /// Half of the pitch angle, in rad.
    pub(super) half_pitch: f64,
    /// Roll angle at the tip, in rad.
    pub(super) tip_roll: f64,
    /// Roll angle at the junction of involute and fillet, in rad.
    pub(super) junction_roll: f64,
    /// Length of the involute.
    pub(super) flank_length: f64,
    /// Arc length of the fillet from the junction, and the angle of the rack's normal there.
    fillet: Vec<(f64, f64)>,
    /// Length from the junction down to the point where the fillet has turned by 45 degrees.
    pub(super) turned_length: f64,
    /// Half of the tooth's angle at the root circle, in rad.
    root_half_angle: f64,
}

impl Boundary {
    /// The boundary of the gear's teeth.
    ///
    /// # Errors
    /// A [`FieldRefusal`] if the tooth is pointed, cut through, or has nearly no involute.
    pub(super) fn of(input: &FieldInput) -> Result<Boundary, FieldRefusal> {
        let (profile, module) = (input.profile, input.module);
        let circles = profile.circles();
        let base = circles.base / module;
        let (tip_roll, junction_roll) =
            (circles.tip_curvature / circles.base, profile.junction.roll);
        let flank_length = base * (tip_roll - junction_roll) * (tip_roll + junction_roll) / 2.0;
        let mut boundary = Boundary {
            profile,
            module,
            base,
            root: circles.root / module,
            tip: circles.tip / module,
            half_pitch: profile.half_pitch(),
            tip_roll,
            junction_roll,
            flank_length,
            fillet: Vec::new(),
            turned_length: 0.0,
            root_half_angle: profile.root_half_angle(),
        };
        if flank_length.is_nan() || flank_length < LEAST_FLANK {
            return Err(FieldRefusal::ShortFlank {
                length: flank_length * module,
                least: LEAST_FLANK * module,
            });
        }
        let space = boundary.half_pitch - boundary.root_half_angle;
        if space.is_nan() || space < -LEAST_ANGLE {
            return Err(FieldRefusal::NoSpace { width: 2.0 * space * circles.root });
        }
        boundary.walk_fillet()?;
        boundary.check_tip()?;
        Ok(boundary)
    }

    /// Length of the boundary from the tip's corner to the middle of the space.
    pub(super) fn length(&self) -> f64 {
        self.root_start() + self.root * (self.half_pitch - self.root_half_angle)
    }

    /// Length of the fillet.
    pub(super) fn fillet_length(&self) -> f64 {
        self.fillet.last().map_or(0.0, |end| end.0)
    }

    /// Roll angle of the involute at an arc length from the tip, in rad.
    pub(super) fn roll(&self, arc: f64) -> f64 {
        let squared = self.tip_roll * self.tip_roll - 2.0 * arc / self.base;
        squared.max(0.0).sqrt().max(self.junction_roll)
    }

    /// Angle between the force on the flank and the normal of the centre line, in rad.
    pub(super) fn load_angle(&self, roll: f64) -> f64 {
        self.profile.load_angle(roll)
    }

    /// The boundary at an arc length from the tip's corner.
    pub(super) fn at(&self, arc: f64) -> Vector2<f64> {
        if arc <= self.flank_length {
            let section = self.profile.involute_at(self.roll(arc));
            Vector2::new(section.half_thickness, section.along) / self.module
        } else if arc < self.root_start() {
            self.fillet_point(self.normal(arc - self.flank_length))
        } else {
            let angle = self.root_half_angle + (arc - self.root_start()) / self.root;
            Vector2::new(angle.sin(), angle.cos()) * self.root
        }
    }

    fn root_start(&self) -> f64 {
        self.flank_length + self.fillet_length()
    }

    fn fillet_point(&self, normal: f64) -> Vector2<f64> {
        let section = self.profile.fillet_at(normal);
        Vector2::new(section.half_thickness, section.along) / self.module
    }

    /// Angle of the rack's normal at an arc length of the fillet, in rad.
    fn normal(&self, arc: f64) -> f64 {
        let next = self.fillet.partition_point(|entry| entry.0 < arc);
        let (to, from) = (next.clamp(1, FILLET_STEPS), next.clamp(1, FILLET_STEPS) - 1);
        let ((low, start), (high, end)) = (self.fillet[from], self.fillet[to]);
        start + (end - start) * (arc - low) / (high - low)
    }

    /// Fills the table of the fillet and finds the point where it has turned by 45 degrees.
    fn walk_fillet(&mut self) -> Result<(), FieldRefusal> {
        const TURNED: (f64, f64) = (0.15, 0.9);
        let first = self.profile.junction.normal;
        let normals = (0..=FILLET_STEPS)
            .map(|step| first + (FRAC_PI_2 - first) * step as f64 / FILLET_STEPS as f64);
        let (mut arc, mut turned, mut neck) = (0.0, None, f64::INFINITY);
        let mut last: Option<Vector2<f64>> = None;
        for normal in normals {
            let point = self.fillet_point(normal);
            let chord = last.map_or(-Vector2::y(), |last| point - last);
            if turned.is_none() && chord.x.atan2(-chord.y) >= FRAC_PI_4 {
                turned = Some(arc);
            }
            arc += last.map_or(0.0, |_| chord.norm());
            neck = neck.min(point.x);
            self.fillet.push((arc, normal));
            last = Some(point);
        }
        self.turned_length = turned.unwrap_or(arc).clamp(TURNED.0 * arc, TURNED.1 * arc);
        if neck.is_nan() || 2.0 * neck < LEAST_THICKNESS {
            return Err(FieldRefusal::CutThrough {
                thickness: 2.0 * neck * self.module,
                least: LEAST_THICKNESS * self.module,
            });
        }
        Ok(())
    }

    fn check_tip(&self) -> Result<(), FieldRefusal> {
        let thickness = self.profile.tip_thickness();
        let least = LEAST_THICKNESS * self.module;
        if thickness.is_nan() || thickness < least {
            return Err(FieldRefusal::PointedTip { thickness, least });
        }
        Ok(())
    }
}
