//! The commands. Each file has the options, the help and the execution of several commands.
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "the help names tables of the case file, such as [limits]"
)]

mod results;
mod studies;

use super::{Done, Streams};
use crate::cli::questions::{Accuracy, Excitation, Seek, Stiffness};
use crate::study::relief::Demand;
use clap::Subcommand;

/// A headless command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve cases and print the results
    ///
    /// D is the first contact of the driven tip, E the start and B the end of the path of contact,
    /// as in the paper; ISO 21771 has A for E, and E for B. CSV has one row per case and one column
    /// per quantity in SI units, such as `impact_force [N]`; with --stations one row per station.
    /// JSON has one object per case and line, in SI units, without missing values.
    Solve(results::Solve),
    /// Print the verdict of each case and check its [limits], one line each
    ///
    /// A limit on impact_force applies to the free impact in every method. With static and dynamic
    /// the line of the limit also has the force by the method, which can have its own limit.
    /// Without corner contact every limit on the impact is met. If a quantity has no value, its
    /// line is `unknown` with the reason, and the exit code is 1. JSON has one object per limit, in
    /// SI units.
    Check(results::Check),
    /// Explain a quantity of a case: formula, numbers, source, validity and sensitivity
    Explain(results::Explain),
    /// Measure accuracy against run time of every method on a case, on this machine
    ///
    /// Each setting is timed on this machine. Its total error is the greatest relative difference
    /// of first contact, forces and curve from the finest setting of method dynamic. The model
    /// error is that of the finest setting of the same method; the rest is numerical. For a pair
    /// with a load over the face width the settings are numbers of slices, coupled and independent.
    /// Where no method finds corner contact, no setting is recommended. JSON is one object in SI
    /// units, without missing values.
    Trade(studies::Asked<Accuracy>),
    /// Compare the tooth compliance of every model over the flank with finite elements
    ///
    /// The finite elements are plane strain on the whole gear, as in tooth_compliance =
    /// "finite-element". CSV has one row per gear and radius, in SI units; a cell is empty where a
    /// model does not cover the gear. JSON is one object in SI units, in which gaps and refusal
    /// give the reason of a missing value.
    Stiffness(studies::Asked<Stiffness>),
    /// Export stiffness, transmission error and forces of the mesh for other solvers
    ///
    /// The part `period` is the mesh at rest over one base pitch of equal pairs, also as Fourier
    /// series. The part `passage` is the passage of the incoming tooth with its deviation. The
    /// equation of motion is m x'' + c x' + sum of k_j max(0, x - g_j) = F0 with x = rb1 phi1 - rb2
    /// phi2, positive where the driver is ahead: reduced_mass m, damping c, stiffness_ k_j and gap_
    /// g_j of each pair in reach, mesh_force F0. The linear equation is m x'' + c x' + k(t) (x -
    /// e(t)) = F0 with mesh_stiffness k and displacement_excitation e. CSV has one row per place,
    /// JSON is one object with the constants and the series; all in SI units. The page
    /// docs/scripting.md describes every column.
    Excitation(studies::Asked<Excitation>),
    /// Solve a case over a range of one or more fields, as a table
    ///
    /// CSV has one row per point: the varied fields in the units of --vary, then the quantities in
    /// SI units, then the outcome. A cell is empty where a quantity has no value, such as an impact
    /// force without corner contact. A refused point has the outcome `refused` and no values;
    /// standard error counts the refused points and gives the reason. JSON has one object per line
    /// and point. Without --only the quantities are those of [limits], or else the impact force of
    /// the method. --out FILE.svg draws the curves; `tipstrike plot --sweep FILE.csv` draws those
    /// of a CSV file.
    Sweep(studies::Sweep),
    /// Sample the distributions of [spread]: percentiles, probabilities, ranking of the fields
    ///
    /// A distribution is a line of [spread]: the field in quotes, then { normal = WIDTH } with the
    /// standard deviation; { uniform = WIDTH }, { triangular = WIDTH } or { truncated = WIDTH } (a
    /// normal distribution cut off at three standard deviations) with half the span; or { grade =
    /// CLASS } with a flank tolerance class of ISO 1328-1, for a base pitch deviation. The
    /// quantities of [limits] are always computed. CSV has one row per solve in SI units: the
    /// samples (set a), then the points of the ranking (set b, and b:FIELD with the value of b in
    /// that field). JSON is one object in SI units.
    Tolerance(studies::Tolerance),
    /// Merge the shards of a sweep or a tolerance study
    Gather(studies::Gather),
    /// Compare the variants of a case, or several cases, side by side with their differences
    ///
    /// A variant is a table [variants.NAME] of the case file with the keys that it changes, such as
    /// "driven.tip_relief" = "48 um". The first column is the reference of all differences. A
    /// difference is in the unit of the quantity, or in percent if the quantity cannot be negative
    /// and its value is at most ten times the reference. If auto chose several methods, its cases
    /// are solved by the most detailed one. A refused case or variant keeps its column, with the
    /// reason. CSV has one row per differing input and per quantity, in SI units. JSON is one object
    /// in SI units, without missing values.
    Compare(results::Compare),
    /// Find the values of a field at which a condition on the results changes
    ///
    /// A crossing is a value at which the condition changes, with a bracket of 1e-9 of the value.
    /// `always` and `never` are answers for the whole range. Without corner contact a quantity of
    /// the impact is below every limit. JSON is one object; its numbers are in the unit of
    /// --vary, and those of the quantity in SI.
    Seek(studies::Asked<Seek>),
    /// Find the tip relief to specify on both gears: no corner contact, least transmission error
    ///
    /// The answer is what a drawing states: amounts in whole um, lengths in steps of 0.1 mm (0.05
    /// mm or 0.01 mm on short paths of contact), and the roll angle and diameter where each relief
    /// begins. Corner contact counts before the start and after the end of the path of contact, at
    /// the greatest load. Every figure is that of the least favourable combination of the
    /// tolerances. Of the kinds of relief within 10 % of the least transmission error, or 5 % of
    /// the least peak force, the command chooses the one with the smallest amounts. A relief is
    /// advised if, within the tolerances, it lowers the figure to minimise by at least 5 % (the
    /// force before E by 5 % of the mesh force) and raises no other figure (transmission error,
    /// peak force, peak line load, dynamic factor) by a greater percentage. The
    /// transmission error is peak to peak, at rest and without base pitch deviations: the greatest
    /// over six loads of the range, over the face width at its ends, or the mean over a spectrum. With method dynamic the motion
    /// must have no corner contact either. --out FILE.svg draws the relief with its tolerances. CSV
    /// has one row per choice and point of the map, JSON is one object; both are in SI units.
    Relief(studies::Asked<Demand>),
    /// Write a chart of a case, or its teeth, as a picture (SVG)
    ///
    /// The chart shows the method of the case. If the method has no such chart, the command draws
    /// another method: load_share of paper and exact shows static; impact_energy of static and
    /// dynamic shows exact. The legend names the method. The chart speed shows method dynamic at
    /// the torque of the case, with the speed rising and falling; relief shows the reliefs of both
    /// gears over the roll angle, and contact_pattern the line load over the face width. The
    /// picture follows the light or dark setting of the browser. A sweep is drawn over the field
    /// with the most values, with a curve for each combination of the others; a quantity over two
    /// fields with at least 5 numbers each is drawn as a map, with the later field across.
    #[command(
        override_usage = "tipstrike plot [OPTIONS] <CASE>\n       tipstrike plot [OPTIONS] --sweep <FILE.csv>"
    )]
    Plot(results::Plot),
    /// Write cases side by side as one page or as data: .html, .md, .csv or .json
    ///
    /// The HTML page needs no other file. Verdict, limits, inputs, main results and charts of one
    /// case print on one sheet, A4 or letter; the appendix has the rest. Markdown has the same
    /// without charts. The page shows the keys of the table [about] of the case file, such as
    /// project, author, date and drawing. CSV and JSON are those of `solve`, JSON with the
    /// stations.
    Report(results::Report),
    /// List every field of a case with its unit, range, default and meaning
    Fields(results::Fields),
    /// Write the JSON Schema of a case file; editors use it to complete keys
    Schema(results::Schema),
    /// Write a commented case to start from
    New(results::New),
    /// Import a spur or helical stage of a REXS model as a commented case
    ///
    /// REXS is the exchange format of gear programs such as FVA-Workbench and Bearinx. Versions
    /// 1.0 to 2.0 are read. Each value of the case has its source as a comment; standard error
    /// lists the stages of the model and each field that stays empty, with the reason. Stages of
    /// ring, bevel and other gears are refused.
    Import(results::Import),
    /// Write a shell's completions to standard output
    Completions(results::Completions),
    /// Write the manual page (roff) to standard output
    Man(results::Man),
}

impl Command {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        match self {
            Command::Solve(command) => command.run(streams),
            Command::Check(command) => command.run(streams),
            Command::Explain(command) => command.run(streams),
            Command::Trade(command) => command.run(streams),
            Command::Stiffness(command) => command.run(streams),
            Command::Excitation(command) => command.run(streams),
            Command::Sweep(command) => command.run(streams),
            Command::Tolerance(command) => command.run(streams),
            Command::Gather(command) => command.run(streams),
            Command::Compare(command) => command.run(streams),
            Command::Seek(command) => command.run(streams),
            Command::Relief(command) => command.run(streams),
            Command::Plot(command) => command.run(streams),
            Command::Report(command) => command.run(streams),
            Command::Fields(command) => command.run(streams),
            Command::Schema(command) => command.run(streams),
            Command::New(command) => command.run(streams),
            Command::Import(command) => command.run(streams),
            Command::Completions(command) => command.run(streams),
            Command::Man(command) => command.run(streams),
        }
    }
}
