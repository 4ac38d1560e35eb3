//! Corner contact in spur and helical gear pairs: where, how hard and how long the tip of an
//! incoming driven tooth strikes the driver's flank before the normal path of contact begins.
//!
//! The program `tipstrike` is a terminal workbench with headless commands. This library is its
//! computation. A case is a TOML file; a solve turns the case into a [`Solution`]:
//!
//! ```
//! use tipstrike::case::Document;
//! use tipstrike::model::{Stages, solve};
//!
//! let text = include_str!("../cases/zhou-chen-2014.toml");
//! let document = Document::parse("zhou-chen-2014.toml", text).expect("a valid file");
//! let inputs = document.case.inputs().expect("a valid case");
//!
//! let solution = solve(&inputs, Stages::ALL).expect("the pair meshes");
//! let impact = solution.impact.expect("the tooth strikes");
//! assert_eq!(format!("{:.1} N", impact.force), "2191.0 N");
//! ```
//!
//! # Modules
//!
//! Data flows one way. A module imports only the modules above it:
//!
//! | module | contents |
//! |---|---|
//! | [`system`] | interfaces that differ between operating systems |
//! | [`numeric`] | root finding, series and quadrature, independent of gears |
//! | [`model`] | the computation, stage by stage, without files, threads or printing |
//! | [`case`](mod@case) | the case file: fields, units, reading, checking, saving |
//! | [`study`] | many solves of one case: sweeps, crossings, tolerances, speed against accuracy |
//! | [`report`] | results as text, JSON, CSV and explanations |
//! | [`cli`] | the commands |
//! | [`tui`] | the workbench; the only module that uses a terminal |
//! | `python` | the Python module, with the feature `python` |
//!
//! The computation builds without the command line and the workbench (`--no-default-features`). All
//! units are SI.
//!
//! # Pages
//!
//! [Guide](docs::guide), [methods and limits](docs::methods), [numerical
//! accuracy](docs::accuracy), [speed](docs::speed), [scripting](docs::scripting),
//! [studies](docs::studies), [case format](docs::case_format), [platforms](docs::platforms),
//! [contributing](docs::contributing).
//!
//! [`Solution`]: model::Solution

#![cfg_attr(not(feature = "python"), forbid(unsafe_code))]

pub mod case;
#[cfg(feature = "cli")]
pub mod cli;
pub mod model;
pub mod numeric;
#[cfg(feature = "python")]
mod python;
pub mod report;
pub mod study;
pub mod system;
#[cfg(all(unix, feature = "tui"))]
pub mod tui;

/// The pages of the folder `docs`.
#[cfg(all(doc, not(doctest)))]
pub mod docs {
    #[doc = include_str!("../docs/guide.md")]
    pub mod guide {}

    #[doc = include_str!("../docs/methods.md")]
    pub mod methods {}

    #[doc = include_str!("../docs/accuracy.md")]
    pub mod accuracy {}

    #[doc = include_str!("../docs/speed.md")]
    pub mod speed {}

    #[doc = include_str!("../docs/scripting.md")]
    pub mod scripting {}

    #[doc = include_str!("../docs/studies.md")]
    pub mod studies {}

    #[doc = include_str!("../docs/case-format.md")]
    pub mod case_format {}

    #[doc = include_str!("../docs/platforms.md")]
    pub mod platforms {}

    #[doc = include_str!("../CONTRIBUTING.md")]
    pub mod contributing {}
}
