//! The options of `compare`.
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "the help names tables of the case file, such as [variants.NAME]"
)]

use super::changes::{Edits, Setting, Settings, by_method, methods};
use super::quantities::QuantityList;
use crate::model::Quantity;
use crate::model::inputs::Method;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

const COMPARE_SHAPE: &str = "A variant is a table [variants.NAME] of the case file with the keys \
    that it changes, such as \"driven.tip_relief\" = \"48 um\". The first column is the reference \
    of all differences. A difference is in the unit of the quantity, or in percent if the \
    quantity cannot be negative and its value is at most ten times the reference. A refused case \
    or variant keeps its column, with the reason. CSV: one row per quantity in SI units. JSON: \
    one object in SI units; missing values are absent.";

/// The options of `compare`.
#[derive(Debug, Args)]
#[command(after_help = COMPARE_SHAPE)]
pub struct Compare {
    /// Case files, each with its variants; - is standard input
    #[arg(required = true, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub cases: Vec<PathBuf>,
    /// Compare these variants alone
    #[arg(long = "variant", value_name = "NAME,...", value_delimiter = ',')]
    pub variants: Vec<String>,
    /// Solve on this method instead of the cases'
    #[arg(long, value_parser = methods())]
    method: Option<Method>,
    /// Change a field of every case and variant, such as "operation.speed=3000 rpm"
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = Settings)]
    settings: Vec<Setting>,
    /// Compare these quantities alone, by name or symbol; `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: CompareFormat,
}

/// Format of a comparison.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum CompareFormat {
    /// Tables for a person
    #[default]
    Text,
    /// One row per quantity
    Csv,
    /// One object
    Json,
    /// Tables in Markdown
    Md,
}

impl Compare {
    /// The changes of every case, on that variant or on the case itself.
    #[must_use]
    pub fn edits(&self, variant: Option<&str>) -> Edits {
        let settings = self.settings.iter().cloned();
        Edits {
            variant: variant.map(str::to_owned),
            settings: settings.chain(by_method(self.method)).collect(),
        }
    }
}
