//! The parts of the path of contact that chamfers and roundings of the tips remove.

use super::circles::Circles;
use super::shape::{GearShape, PairShape};

/// The removed parts of the path of contact.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TipLosses {
    /// The sum of the removed parts, in m.
    pub total: f64,
    /// The key of the tip chamfer or tip radius that removes the greatest part; `None` for whole
    /// tips.
    pub greatest: Option<&'static str>,
}

/// The removed parts of the path of contact of a pair, with the circles of driver and driven gear.
#[must_use]
pub(super) fn tip_losses(shape: &PairShape, driver: &Circles, driven: &Circles) -> TipLosses {
    let [driver_chamfer, driver_radius] = losses(&shape.driver, driver);
    let [driven_chamfer, driven_radius] = losses(&shape.driven, driven);
    let all = [
        (driver_chamfer, "driver.tip_chamfer"),
        (driver_radius, "driver.tip_radius"),
        (driven_chamfer, "driven.tip_chamfer"),
        (driven_radius, "driven.tip_radius"),
    ];
    let greatest = all.iter().max_by(|one, other| one.0.total_cmp(&other.0));
    TipLosses {
        total: all.iter().map(|(loss, _)| loss).sum(),
        greatest: greatest.filter(|(loss, _)| *loss > 0.0).map(|(_, key)| *key),
    }
}

/// The parts that the chamfer and the rounding of one gear remove, in m.
fn losses(gear: &GearShape, circles: &Circles) -> [f64; 2] {
    let curvature = |radius: f64| ((radius - circles.base) * (radius + circles.base)).sqrt();
    let chamfered = curvature(circles.tip);
    [curvature(circles.tip + gear.tip_chamfer) - chamfered, chamfered - circles.tip_curvature]
        .map(|loss| loss.max(0.0))
}
