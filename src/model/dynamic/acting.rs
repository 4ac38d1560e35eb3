//! Stiffness and load of a step with the same touching pairs, cached because they repeat after a
//! base pitch.

use std::cell::RefCell;
use std::rc::Rc;

use super::lead::TERMS;
use crate::model::mesh::Mesh;
use crate::model::pair_forces::Touching;
use crate::numeric::polynomial::Polynomial;

/// Places within this distance, relative to the base pitch, are equal.
pub(super) const ALIKE: f64 = 1e-9;

/// Stiffness and load over a stretch, as polynomials of the part of the stretch.
#[derive(Debug)]
pub(super) struct Acting {
    /// Stiffness of the touching pairs, in N/m.
    pub(super) stiffness: Polynomial<TERMS>,
    /// The load and the forces from the gaps, in N.
    pub(super) load: Polynomial<TERMS>,
}

/// Cached stiffness and load between two borders of the mesh.
#[derive(Debug)]
pub(super) struct Crossing {
    /// The number of working pairs, then the zones of all pairs.
    zones: Vec<usize>,
    /// Index of the incoming pair, the only pair with a deviation.
    incoming: Option<usize>,
    known: RefCell<Vec<Known>>,
}

#[derive(Debug)]
struct Known {
    stretch: Stretch,
    acting: Rc<Acting>,
}

/// A part of the motion with the same touching pairs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    pub(super) touching: Touching,
    /// Place of the rearmost pair at the beginning, in m.
    pub(super) from: f64,
    /// Its length, in m.
    pub(super) way: f64,
}

impl Crossing {
    /// Stiffness and load of a stretch. Calls `new` if they are not cached.
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
        all.push(Known { stretch, acting: Rc::clone(&acting) });
        acting
    }
}

/// The cached crossings of a motion.
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
        let crossing =
            Rc::new(Crossing { zones: zones.collect(), incoming, known: RefCell::default() });
        all.push(Rc::clone(&crossing));
        crossing
    }
}
