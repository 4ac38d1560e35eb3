//! Writes a chart of a case, or its teeth, as a picture.

use crate::case::file;
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::Changes;
use crate::cli::progress::follow;
use crate::model::{Inputs, Refusal};
use crate::report::charts::{Drawn, find, no_curve, picture, with_other_method};
use crate::report::graphs::GRAPHS;
use crate::report::svg::teeth::teeth;
use crate::report::whine::charts::{SPECTRUM, SPEED, spectrum, speed};
use crate::report::{Report, Selection};
use crate::study::speeds::{SPEEDS, SpeedCurve, speeds};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueHint};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The chart that shows the teeth.
const TEETH: &str = "teeth";

const AFTER_HELP: &str = "The chart shows the method of the case. If the method has no \
    such chart, the command draws another method: load_share of paper and exact shows static; \
    impact_energy of static and dynamic shows exact. The legend names the method. The chart speed \
    shows method dynamic at the torque of the case, with the speed rising and falling. The \
    picture follows the light or dark setting of the browser.";

/// What the command line gives.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// The chart to draw
    #[arg(long, value_name = "NAME", default_value = "force", value_parser = charts())]
    pub chart: String,
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let ending = options.out.as_deref().and_then(Path::extension);
    if let (Some(out), Some(ending)) = (&options.out, ending)
        && !ending.eq_ignore_ascii_case("svg")
    {
        let out = out.display();
        return Err(Failure::Usage(format!(
            "--out {out}: a picture is SVG: use the ending .svg"
        )));
    }
    let opened = cases::open(&options.case, &options.changes.edits(), streams)?;
    let text = draw(&opened, options, streams)?;
    write(options.out.as_deref(), &text, streams)
}

fn draw(opened: &Opened, options: &Options, streams: &mut Streams) -> Result<String, Exit> {
    if options.chart == SPEED {
        let curve =
            speeds_of(&opened.inputs).map_err(|refusal| opened.refused(&refusal, streams))?;
        return speed(&[("", &curve)]).ok_or_else(|| {
            streams.say(&format!(
                "{}: the chart {SPEED} has no curve: no motion becomes steady: give a greater \
                 model.damping_ratio",
                opened.name
            ));
            Exit::BadCase
        });
    }
    let report = solve(opened, true, streams)?;
    if options.chart == TEETH {
        return Ok(teeth(&report.inputs, &report.solution));
    }
    let reports = with_other_method(report);
    let subject = Drawn {
        name: "",
        reports: &reports,
    };
    let drawn = if options.chart == SPECTRUM {
        spectrum(&[subject])
    } else {
        find(&options.chart).and_then(|graph| picture(graph, &[subject]))
    };
    drawn.ok_or_else(|| {
        let reason = no_curve(&options.chart, &reports);
        streams.say(&format!("{}: {reason}", opened.name));
        Exit::BadCase
    })
}

/// The dynamic factor over speed, with a bar while it takes long.
pub(super) fn speeds_of(inputs: &Inputs) -> Result<SpeedCurve, Refusal> {
    follow("speeds", |report| {
        speeds(inputs, &mut |curve| {
            let done = curve.up.iter().chain(&curve.down).flatten().count();
            report(done, 2 * SPEEDS)
        })
    })
}

/// Solves a case with every quantity, and the stations on request.
pub(super) fn solve(
    opened: &Opened,
    stations: bool,
    streams: &mut Streams,
) -> Result<Report, Exit> {
    let selection = Selection {
        only: Vec::new(),
        stations,
    };
    let solved = Report::solve(
        opened.name.clone(),
        opened.document.case.clone(),
        opened.inputs.clone(),
        selection,
    );
    solved.map_err(|refusal| opened.refused(&refusal, streams))
}

/// Writes a picture or a page, over an older one, or to standard output.
pub(super) fn write(
    out: Option<&Path>,
    text: &str,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    match out.filter(|path| path.as_os_str() != "-") {
        Some(path) => file::write(path, text.as_bytes(), true)?,
        None => streams.output.write_all(text.as_bytes())?,
    }
    Ok(Exit::Done)
}

fn charts() -> PossibleValuesParser {
    let names = GRAPHS.iter().map(|graph| graph.key);
    PossibleValuesParser::new(names.chain([SPECTRUM, SPEED, TEETH]))
}
