//! The loads of a face width that are in balance.

use std::rc::Rc;

/// The pairs and the slices in which they are within the computed pairs. A slice has a slot for each pair
/// that can be there at once: those of all pairs are their numbers, modulo the slots.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairs {
    /// Base pitches by which the first pair is ahead of the incoming one.
    pub first: i32,
    /// The slices of each pair.
    pub slices: Vec<std::ops::Range<usize>>,
    /// Number of slots of a slice.
    pub slots: usize,
}

impl Pairs {
    /// The number of a pair.
    pub fn index(&self, ahead: i32) -> Option<usize> {
        usize::try_from(ahead - self.first).ok().filter(|pair| *pair < self.slices.len())
    }

    /// The pairs as base pitches ahead of the incoming pair.
    pub fn all(&self) -> impl Iterator<Item = i32> + use<> {
        (self.first..).take(self.slices.len())
    }

    /// The slices of a pair, each with the index of the pair there.
    pub fn of(&self, pair: usize) -> impl DoubleEndedIterator<Item = (usize, usize)> + use<> {
        let (slots, slot) = (self.slots, pair % self.slots);
        self.slices[pair].clone().map(move |slice| (slice, slice * slots + slot))
    }

    /// The index of a pair at a slice.
    fn at(&self, pair: usize, slice: usize) -> Option<usize> {
        let is_here = self.slices[pair].contains(&slice);
        is_here.then(|| slice * self.slots + pair % self.slots)
    }
}

/// The line loads of all pairs at a position of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Loads {
    /// Path of the incoming pair since E in the middle of the face, in m.
    pub s: f64,
    /// The pairs.
    pub pairs: Rc<Pairs>,
    /// Displacement of the driver ahead x, in m.
    pub displacement: f64,
    /// Deviation of the incoming pair, in m.
    pub(super) error: f64,
    /// Line load of each pair in the middle of each slice, slot by slot, in N/m.
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
        self.index(ahead, slice).map_or(0.0, |at| self.line_loads[at])
    }

    /// Mean line load of a pair over a slice, in N/m.
    pub fn mean_at(&self, ahead: i32, slice: usize) -> f64 {
        self.index(ahead, slice).map_or(0.0, |at| self.mean_loads[at])
    }

    /// The line load of all pairs at a slice, in N/m.
    pub fn of_all_at(&self, slice: usize) -> f64 {
        self.line_loads[slice * self.pairs.slots..][..self.pairs.slots].iter().sum()
    }

    /// Its mean over the slice, in N/m.
    pub fn mean_of_all_at(&self, slice: usize) -> f64 {
        self.mean_loads[slice * self.pairs.slots..][..self.pairs.slots].iter().sum()
    }

    /// Mean line load of all pairs over each slice, in N/m.
    pub fn of_all(&self) -> Vec<f64> {
        let slots = self.pairs.slots.max(1);
        self.mean_loads.chunks(slots).map(|of_slice| of_slice.iter().sum()).collect()
    }

    /// The greatest lead of a pair over the face, in m, with the number of its slice.
    pub fn lead(&self, ahead: i32) -> (f64, usize) {
        let of_pair = self.pairs.index(ahead).into_iter().flat_map(|pair| self.pairs.of(pair));
        of_pair.fold((f64::NEG_INFINITY, 0), |best, (slice, at)| {
            if self.leads[at] > best.0 { (self.leads[at], slice) } else { best }
        })
    }

    /// The lead of a pair at a slice, in m.
    pub(super) fn lead_at(&self, ahead: i32, slice: usize) -> f64 {
        self.index(ahead, slice).map_or(f64::NEG_INFINITY, |at| self.leads[at])
    }

    /// `teeth` of the pair with a number at a slice.
    pub(super) fn teeth_at(&self, pair: usize, slice: usize) -> [f64; 2] {
        self.pairs.at(pair, slice).map_or([0.0; 2], |at| self.teeth[at])
    }

    /// The index of a pair at a slice.
    fn index(&self, ahead: i32, slice: usize) -> Option<usize> {
        self.pairs.at(self.pairs.index(ahead)?, slice)
    }
}
