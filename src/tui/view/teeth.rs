//! The teeth, drawn: the pair true to scale around the strike, with every value at the cursor.

pub mod ink;
pub mod labels;
pub mod pen;
pub mod picture;
pub mod readings;
pub mod scene;
pub mod trace;
pub mod window;
pub mod zoom;

pub use picture::Picture;
pub use zoom::{Centre, Exaggeration, TeethView};
