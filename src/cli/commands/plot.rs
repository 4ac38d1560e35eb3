//! `plot`: writes a chart of a case, or its teeth, as a picture.

use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{CaseFile, Changes, Destination};
use crate::cli::output::{check_out, write_to};
use crate::cli::progress::follow;
use crate::report::Report;
use crate::report::pictures::{NoPicture, find, pictures};
use clap::Args;
use clap::builder::PossibleValuesParser;
use std::io::Write;
use std::path::Path;

const AFTER_HELP: &str = "The chart shows the method of the case. If the method has no \
    such chart, the command draws another method: load_share of paper and exact shows static; \
    impact_energy of static and dynamic shows exact. The legend names the method. The chart speed \
    shows method dynamic at the torque of the case, with the speed rising and falling. The \
    picture follows the light or dark setting of the browser.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// The chart to draw
    #[arg(long, value_name = "NAME", default_value = "force", value_parser = charts())]
    pub chart: String,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = options.destination.out.as_deref();
    if let (Some(out), Some(ending)) = (out, out.and_then(Path::extension))
        && !ending.eq_ignore_ascii_case("svg")
    {
        let out = out.display();
        return Err(Failure::Usage(format!(
            "--out {out}: a picture is SVG: use the extension .svg"
        )));
    }
    check_out(out, &[&options.input.case])?;
    let opened = cases::open(&options.input.case, &options.changes.edits(), streams)?;
    let text = draw(&opened, options, streams)?;
    write_to(out, streams.output.as_mut(), |sink| sink.write_all(text.as_bytes()))?;
    Ok(Exit::Done)
}

fn draw(opened: &Opened, options: &Options, streams: &mut Streams) -> Result<String, Exit> {
    let Some(picture) = find(&options.chart) else {
        return Err(Exit::Usage);
    };
    let source = opened.unsolved();
    let drawn = if picture.needs_speeds() {
        follow("speeds", |go_on| picture.of_case(source, go_on))
    } else {
        picture.of_case(source, &|_, _| true)
    };
    drawn.map_err(|reason| match reason {
        NoPicture::Refused(refusal) => opened.refused(&refusal, streams),
        NoPicture::Absent(reason) => {
            streams.say(&format!("{}: {reason}", opened.name));
            Exit::BadCase
        }
    })
}

/// Solves a case with every quantity, and the stations on request.
pub(super) fn solve(
    opened: &Opened,
    stations: bool,
    streams: &mut Streams,
) -> Result<Report, Exit> {
    let solved = opened.unsolved().solve(stations);
    solved.map_err(|refusal| opened.refused(&refusal, streams))
}

fn charts() -> PossibleValuesParser {
    PossibleValuesParser::new(pictures().map(|picture| picture.key))
}
