//! Reasons why a gear has no elastic field.

use thiserror::Error;

use crate::numeric::decimal::significant;

/// Range of Poisson's ratio.
pub(in crate::model) const POISSON: (f64, f64) = (0.0, 0.49);

/// The reason why a gear has no field.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum FieldRefusal {
    /// The flanks meet at or below the tip circle.
    #[error("pointed tip: the tooth's thickness there is {} mm and must be at least {} mm", millimetres(*.thickness), millimetres(*.least))]
    PointedTip {
        /// Thickness at the tip circle, in m.
        thickness: f64,
        /// Least thickness, in m.
        least: f64,
    },
    /// The undercut leaves nearly no neck below the tooth.
    #[error("undercut tooth: its neck is {} mm thick and must be at least {} mm", millimetres(*.thickness), millimetres(*.least))]
    CutThrough {
        /// Least thickness of the fillet, in m.
        thickness: f64,
        /// Least thickness, in m.
        least: f64,
    },
    /// The cutting rack's flanks meet above its tip.
    #[error("no space between the teeth: its width at the root circle is {} mm", millimetres(*.width))]
    NoSpace {
        /// Width of the space at the root circle, in m, below 0.
        width: f64,
    },
    /// Nearly no involute is left between fillet and tip.
    #[error("short flank: its involute is {} mm long and must be at least {} mm", millimetres(*.length), millimetres(*.least))]
    ShortFlank {
        /// Arc length of the involute, in m.
        length: f64,
        /// Least length, in m.
        least: f64,
    },
    /// The rim is too thin for the elements.
    #[error("thin rim: it is {} mm thick and must be at least {} mm", millimetres(*.thickness), millimetres(*.least))]
    ThinRim {
        /// r_f − r_h, in m.
        thickness: f64,
        /// Least thickness, in m.
        least: f64,
    },
    /// Plane strain is impossible with this Poisson's ratio.
    #[error("Poisson's ratio is {poisson} and must be between 0 and {}", POISSON.1)]
    Poisson {
        /// ν.
        poisson: f64,
    },
    /// The outline of the tooth folds the mesh.
    #[error("the mesh folds on this outline: element {element} of {count}")]
    FoldedMesh {
        /// Number of the element.
        element: usize,
        /// Number of elements.
        count: usize,
    },
    /// Rounding errors make the stiffness matrix indefinite.
    #[error("the stiffness matrix is not positive definite with {unknowns} unknowns")]
    NotPositive {
        /// Unknowns.
        unknowns: usize,
    },
}

fn millimetres(length: f64) -> String {
    significant(length / 1e-3, 4)
}
