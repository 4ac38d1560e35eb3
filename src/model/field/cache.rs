//! Cache of the fields of recent gears, shared by all solves. A field depends only on its gear, and
//! building takes thousands of times as long as reading.

use std::cell::RefCell;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::{Field, FieldInput, FieldRefusal};
use crate::model::Refusal;
use crate::model::geometry::{GearShape, circles};
use crate::model::profile::{Profile, Rack};

/// Greatest number of cached gears, 2 kB each. A new gear replaces the least recently used one.
const MOST: usize = 256;

/// All inputs of a gear's field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FieldGear {
    /// The rack that cuts the profile.
    pub rack: Rack,
    /// Shape of the gear.
    pub shape: GearShape,
    /// Bore radius r_h, in m; 0 without a bore.
    pub bore_radius: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
}

impl FieldGear {
    /// The field of the gear, built if no recent solve has built it.
    ///
    /// # Errors
    /// [`Refusal::NoField`] if the gear has no field, and the refusals of its circles.
    pub fn field(&self) -> Result<Arc<Field>, Refusal> {
        let entry = self.entry();
        // The list is not locked while a field is built, so that other gears do not wait.
        entry.field.get_or_init(|| self.build().map(Arc::new)).clone()
    }

    /// The field of the gear, built without the cache.
    ///
    /// # Errors
    /// Those of [`FieldGear::field`].
    pub fn build(&self) -> Result<Field, Refusal> {
        Field::build(&self.input()?).map_err(|reason| self.refusal(reason))
    }

    /// Whether the gear has a field, without building it.
    ///
    /// # Errors
    /// Those of [`FieldGear::field`].
    pub fn check(&self) -> Result<(), Refusal> {
        let check = || Field::check(&self.input()?).map_err(|reason| self.refusal(reason));
        *self.entry().check.get_or_init(check)
    }

    /// Whether the field of the gear is built.
    #[must_use]
    pub fn is_built(&self) -> bool {
        self.entry().field.get().is_some()
    }

    fn input(&self) -> Result<FieldInput, Refusal> {
        let (module, alpha) = (self.rack.module, self.rack.pressure_angle);
        let circles = circles(module, alpha, &self.shape)?;
        Ok(FieldInput {
            profile: Profile::of(&self.rack, &circles),
            teeth: self.rack.teeth,
            module,
            bore_radius: self.bore_radius,
            poisson: self.poisson,
        })
    }

    fn refusal(&self, reason: FieldRefusal) -> Refusal {
        Refusal::NoField { teeth: self.rack.teeth, reason }
    }

    /// The entry of the gear. Needs no lock for the two gears that this thread used last.
    fn entry(&self) -> Arc<Entry> {
        LAST_READ.with_borrow_mut(|last| {
            let known = last.iter().position(|entry| entry.gear == *self);
            if let Some(at) = known {
                return Arc::clone(&last[at]);
            }
            let entry = self.shared_entry();
            last.truncate(GEARS_OF_A_PAIR - 1);
            last.insert(0, Arc::clone(&entry));
            entry
        })
    }

    fn shared_entry(&self) -> Arc<Entry> {
        let mut entries = RECENT.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(at) = entries.iter().rposition(|entry| entry.gear == *self) {
            let last = entries.len() - 1;
            entries[at..=last].rotate_left(1);
            return Arc::clone(&entries[last]);
        }
        if entries.len() == MOST {
            entries.remove(0);
        }
        let entry = Arc::new(Entry { gear: *self, check: OnceLock::new(), field: OnceLock::new() });
        entries.push(Arc::clone(&entry));
        entry
    }
}

/// A gear and its field after the first request.
struct Entry {
    gear: FieldGear,
    check: OnceLock<Result<(), Refusal>>,
    field: OnceLock<Result<Arc<Field>, Refusal>>,
}

/// Recent gears, the most recently used one last.
static RECENT: Mutex<Vec<Arc<Entry>>> = Mutex::new(Vec::new());

/// Number of entries cached per thread.
const GEARS_OF_A_PAIR: usize = 2;

thread_local! {
    /// The gears that this thread used last, the newest first.
    static LAST_READ: RefCell<Vec<Arc<Entry>>> = const { RefCell::new(Vec::new()) };
}
