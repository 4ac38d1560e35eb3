//! The loads of a face width that are in balance.

/// The line loads of all pairs at a position of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Loads {
    /// Path of the incoming pair since E in the middle of the face, in m.
    pub s: f64,
    /// Base pitches by which the first pair is ahead of the incoming one.
    pub first: i32,
    /// Number of pairs.
    pub pairs: usize,
    /// Displacement of the driver ahead x, in m.
    pub displacement: f64,
    /// Deviation of the incoming pair, in m.
    pub(super) error: f64,
    /// Line load of each pair in the middle of each slice, slice by slice, in N/m.
    pub line_loads: Vec<f64>,
    /// Its mean over each slice, in N/m.
    pub mean_loads: Vec<f64>,
    /// Displacement under the loads minus the gap, in m, above 0 where a pair carries.
    pub leads: Vec<f64>,
    /// Displacement of the teeth in the middle of each slice over √q_t, which is smooth along the face,
    /// and its change of slope, in 1/m². Of independent slices by other pairs alone.
    pub(super) teeth: Vec<[f64; 2]>,
    /// Force that turns the driver, in N.
    pub force: f64,
    /// Change of the force with the displacement, in N/m.
    pub stiffness: f64,
    /// Change of the stiffness with the displacement, in N/m².
    pub bend: f64,
    /// Change of the displacement up to which no slice gains or loses contact all at once, in m.
    pub smooth: f64,
}

impl Loads {
    /// The line load of a pair at a slice, in N/m.
    pub fn at(&self, ahead: i32, slice: usize) -> f64 {
        self.index(ahead).map_or(0.0, |pair| self.line_loads[slice * self.pairs + pair])
    }

    /// Mean line load of a pair over a slice, in N/m.
    pub fn mean_at(&self, ahead: i32, slice: usize) -> f64 {
        self.index(ahead).map_or(0.0, |pair| self.mean_loads[slice * self.pairs + pair])
    }

    /// The line load of all pairs at a slice, in N/m.
    pub fn of_all_at(&self, slice: usize) -> f64 {
        self.line_loads[slice * self.pairs..][..self.pairs].iter().sum()
    }

    /// Mean line load of all pairs over each slice, in N/m.
    pub fn of_all(&self) -> Vec<f64> {
        self.mean_loads.chunks(self.pairs.max(1)).map(|of_slice| of_slice.iter().sum()).collect()
    }

    /// The greatest lead of a pair over the face, in m, with the number of its slice.
    pub fn lead(&self, ahead: i32) -> (f64, usize) {
        let Some(pair) = self.index(ahead) else {
            return (f64::NEG_INFINITY, 0);
        };
        let of_pair = self.leads.iter().skip(pair).step_by(self.pairs).enumerate();
        of_pair.fold(
            (f64::NEG_INFINITY, 0),
            |best, (slice, &lead)| {
                if lead > best.0 { (lead, slice) } else { best }
            },
        )
    }

    /// The lead of a pair at a slice, in m.
    pub(super) fn lead_at(&self, ahead: i32, slice: usize) -> f64 {
        self.index(ahead).map_or(f64::NEG_INFINITY, |pair| self.leads[slice * self.pairs + pair])
    }

    pub(super) fn index(&self, ahead: i32) -> Option<usize> {
        usize::try_from(ahead - self.first).ok().filter(|pair| *pair < self.pairs)
    }

    /// The pairs as base pitches ahead of the incoming pair.
    pub fn pairs(&self) -> impl Iterator<Item = i32> + use<> {
        (self.first..).take(self.pairs)
    }
}
