//! Values that a mesh computes when they are first needed.

/// A cached value, which does not affect the equality of meshes.
#[derive(Debug, Default)]
pub(super) struct Cache<T>(pub(super) T);

impl<T> PartialEq for Cache<T> {
    fn eq(&self, _: &Cache<T>) -> bool {
        true
    }
}
