//! The part of a mesh in which pairs are close to contact.

use std::sync::Arc;

use super::Mesh;
use super::zones::{GAP, Zone};
use crate::numeric::root;

impl Mesh {
    /// The mesh without the places before E and after B where the gap exceeds `gap`, in m. Pairs
    /// at these places are no longer part of it.
    pub(in crate::model) fn within(&self, gap: f64) -> Mesh {
        let (mut from, mut to) = self.ends();
        for zone in self.zones.iter().filter(|zone| zone.to <= 0.0) {
            from = zone.border(gap, (zone.from, zone.to)).unwrap_or(from);
        }
        let after = self.zones.iter().filter(|zone| zone.from >= self.length);
        for zone in after.rev() {
            to = zone.border(gap, (zone.to, zone.from)).unwrap_or(to);
        }
        let kept = self.zones.iter().filter(|zone| zone.to > from && zone.from < to);
        let zones = kept.map(|zone| Zone {
            from: zone.from.max(from),
            to: zone.to.min(to),
            ..zone.clone()
        });
        Mesh {
            zones: Arc::new(zones.collect()),
            sharing: Arc::default(),
            back: Arc::default(),
            is_whole: false,
            ..self.clone()
        }
    }
}

impl Zone {
    /// The place between the end far from the line of action and the near end where the gap is
    /// `gap`. `None` if the gap does not pass this value.
    fn border(&self, gap: f64, (far, near): (f64, f64)) -> Option<f64> {
        let beyond = |s: f64| self.series.one(GAP, s) - gap;
        (beyond(far) > 0.0 && beyond(near) <= 0.0).then(|| root::between(far, near, beyond))
    }
}
