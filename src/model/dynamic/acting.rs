//! What acts on the driver while the same pairs touch, and what a motion keeps of it: a base pitch
//! later it is the same.

use std::cell::RefCell;
use std::rc::Rc;

use super::lead::{Lead, TERMS};
use crate::model::mesh::Mesh;
use crate::model::pair_forces::Touching;
use crate::numeric::polynomial::Polynomial;

/// Places that lie no further apart, over the base pitch, are the same.
pub(super) const ALIKE: f64 = 1e-9;

/// What acts over a way, as polynomials of the part of it.
#[derive(Debug, Clone)]
pub(super) struct Acting {
    /// Stiffness of the touching pairs, in N/m.
    pub(super) stiffness: Polynomial<TERMS>,
    /// The load with the forces that the gaps take from it, in N.
    pub(super) load: Polynomial<TERMS>,
    /// Of every pair.
    pub(super) leads: Vec<Lead>,
}

/// What acts between two borders of the mesh, step by step, as far as a motion has met it there.
#[derive(Debug)]
pub(super) struct Crossing {
    /// How many pairs are of the working flanks, and the zones of all pairs.
    zones: Vec<usize>,
    /// The incoming pair among them, which alone deviates.
    incoming: Option<usize>,
    known: RefCell<Vec<Known>>,
}

#[derive(Debug)]
struct Known {
    stretch: Stretch,
    acting: Rc<Acting>,
}

/// A part of the way on which the same pairs touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) touching: Touching,
    /// Where the rearmost pair begins it, in m.
    pub(super) from: f64,
    /// Its length, in m.
    pub(super) way: f64,
}

impl Crossing {
    /// What acts over a stretch, computed by `new` if it is not known.
    pub(super) fn acting(
        &self,
        stretch: Stretch,
        mesh: &Mesh,
        new: impl FnOnce() -> Acting,
    ) -> Rc<Acting> {
        let is_near = |one: f64, other: f64| (one - other).abs() <= ALIKE * mesh.base_pitch;
        let is_alike = |known: &&Known| {
            let other = known.stretch;
            other.touching == stretch.touching
                && is_near(other.from, stretch.from)
                && is_near(other.way, stretch.way)
        };
        let mut all = self.known.borrow_mut();
        if let Some(known) = all.iter().find(is_alike) {
            return Rc::clone(&known.acting);
        }
        let acting = Rc::new(new());
        all.push(Known {
            stretch,
            acting: Rc::clone(&acting),
        });
        acting
    }
}

/// The crossings of a motion.
#[derive(Debug, Default)]
pub(super) struct Crossings(RefCell<Vec<Rc<Crossing>>>);

impl Crossings {
    /// The crossing of pairs in these zones; `incoming` is the incoming pair among them.
    pub(super) fn of(
        &self,
        zones: impl Iterator<Item = usize> + Clone,
        incoming: Option<usize>,
    ) -> Rc<Crossing> {
        let mut all = self.0.borrow_mut();
        let is_alike = |known: &&Rc<Crossing>| {
            known.incoming == incoming && known.zones.iter().copied().eq(zones.clone())
        };
        if let Some(crossing) = all.iter().find(is_alike) {
            return Rc::clone(crossing);
        }
        let crossing = Rc::new(Crossing {
            zones: zones.collect(),
            incoming,
            known: RefCell::default(),
        });
        all.push(Rc::clone(&crossing));
        crossing
    }
}
