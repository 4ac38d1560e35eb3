//! `import`: imports a spur stage of a REXS model as a commented case.

use super::new;
use crate::cli::Streams;
use crate::cli::cases;
use crate::cli::exit::{Exit, Failure};
use clap::{Args, ValueHint};
use std::path::PathBuf;

const AFTER_HELP: &str = "REXS is the exchange format of gear programs such as FVA-Workbench and Bearinx. Versions 1.0 to 2.0 \
    are read. Each value of the case has its source as a comment; standard error lists the stages of the model and each field \
    that stays empty, with the reason. Helical, planetary, bevel and other stages are refused.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// REXS model (.rexs, .rexsj or .rexsz); - is standard input
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: PathBuf,
    /// Import the stage with this id (default: the only spur stage of the model)
    #[arg(long, value_name = "ID")]
    pub stage: Option<String>,
    /// File to write (default: standard output); must not exist yet
    #[arg(long, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let imported = cases::read_model(&options.model, options.stage.as_deref(), streams)?;
    new::write(options.out.as_deref(), &imported.document.render(), streams)
}
