//! Run time against accuracy: every method with several settings and every compliance, each timed
//! and compared with one reference.

use std::fmt;
use std::hint::black_box;
use std::time::{Duration, Instant};

use super::seek::distinct;
use crate::case::Case;
use crate::case::fields::{AUTO, index_of};
use crate::model::compliance::ElasticGear;
use crate::model::impact::StiffnessModels;
use crate::model::inputs::{Gear, Method};
use crate::model::{self, Inputs, Outcome, Quantity, Refusal, Solution, Stage, Stages, auto};

/// How long each setting is timed for a reliable figure; no time means a single run.
pub const STEADY: Duration = Duration::from_millis(25);

/// The methods and their settings, measured on one case.
#[derive(Debug, Clone)]
pub struct Trade {
    /// The accepted error of a setting.
    pub within: f64,
    /// Number of settings to measure.
    pub planned: usize,
    /// The settings measured so far.
    pub settings: Vec<MeasuredSetting>,
    /// The finest setting of each method, or of each coupling over the face width.
    pub finest: Vec<Finest>,
    /// Whether the load varies over the face width: slices are compared in place of methods.
    pub is_over_face: bool,
    /// Seconds to build the fields of driver and driven gear, or the reason why one has none. Later
    /// solves read the cached fields.
    pub build: Result<[f64; 2], Refusal>,
}

/// Relative differences in the order of [`Subject::ALL`]; `None` if a method has no such quantity.
pub type Differences = [Option<f64>; Subject::ALL.len()];

/// The finest setting of a method. That of `dynamic` by the default compliance is the reference: by
/// finite elements if both gears have them. Over the face width it is that with both couplings.
#[derive(Debug, Clone)]
pub struct Finest {
    /// The setting.
    pub setting: Setting,
    /// The outcome, or the refusal.
    pub outcome: Result<Outcome, Refusal>,
    /// The values in SI, in the order of [`Subject::ALL`].
    pub values: [Option<f64>; Subject::ALL.len()],
    /// Difference from the reference: the model error of the method.
    pub off: Differences,
}

/// A setting with its time and errors.
#[derive(Debug, Clone)]
pub struct MeasuredSetting {
    /// The setting.
    pub setting: Setting,
    /// Whether it is the setting of the case.
    pub is_current: bool,
    /// The measured figures, or the refusal of the case.
    pub found: Result<Figures, Refusal>,
}

/// Time and errors.
#[derive(Debug, Clone)]
pub struct Figures {
    /// The setting that the solve used: another one if method `auto` chose it.
    pub taken: Setting,
    /// Time of a solve of the stages that the answer needs.
    pub time: Time,
    /// Evaluations of the motion in method `dynamic`, see
    /// [`Dynamic`](crate::model::Dynamic).
    pub evaluations: Option<u64>,
    /// Difference from the finest setting of the same method.
    pub numerical: Differences,
    /// Difference from the reference.
    pub total: Differences,
}

/// The run time of a solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// The median of the runs, in s.
    pub seconds: f64,
    /// Half the interquartile range of the runs, in s.
    pub spread: f64,
    /// Number of measured runs.
    pub runs: usize,
}

/// Measures error and time of every setting on the case, each for `patience`. The accepted error is
/// that of the inputs. `show` receives the results after each setting.
///
/// # Errors
/// [`Refusal::Stopped`] if `go_on` returns false; the refusal of the model if no method solves the
/// case.
pub fn trade(
    inputs: &Inputs,
    patience: Duration,
    go_on: &dyn Fn() -> bool,
    show: &mut dyn FnMut(&Trade),
) -> Result<Trade, Refusal> {
    let current = Setting::of(inputs);
    let settings = distinct(Setting::all(inputs).into_iter().chain([current]));
    let own = (current.models.is_some() && current.method != Method::Auto).then(|| current.best());
    let is_over_face = inputs.face().is_some();
    let finest = if is_over_face {
        let slices = Some(BEST_SLICES);
        Setting::coupled(inputs).map(|setting| Setting { slices, ..setting }).to_vec()
    } else {
        METHODS.map(|method| Setting::usual(method, inputs).best()).to_vec()
    };
    let own = own.filter(|_| !is_over_face);
    let finest = distinct(finest.into_iter().chain(own));
    let answer = |setting: Setting| {
        let solution = Refusal::unless_stopped(solve(&setting.inputs(inputs), go_on))?;
        Ok((setting, solution.map(|solution| Answer::of(&solution))))
    };
    let finest = finest.into_iter().map(answer).collect::<Result<Vec<_>, Refusal>>()?;
    let truth = &finest[reference(is_over_face)].1;
    let off = |found: &Answer, truth: &Result<Answer, Refusal>| {
        let truth = truth.as_ref().ok();
        Subject::ALL.map(|subject| found.off(truth?, subject))
    };
    let model = |(setting, found): &(Setting, Result<Answer, Refusal>)| Finest {
        setting: *setting,
        outcome: found.as_ref().map(|found| found.outcome).map_err(|refusal| *refusal),
        values: found.as_ref().map_or([None; Subject::ALL.len()], |found| found.values),
        off: found.as_ref().map_or([None; Subject::ALL.len()], |found| off(found, truth)),
    };
    let build = |gear: &Gear| {
        let begun = Instant::now();
        black_box(ElasticGear::of(inputs, gear).build_field()?);
        Ok::<f64, Refusal>(begun.elapsed().as_secs_f64())
    };
    let build = build(&inputs.driver).and_then(|driver| Ok([driver, build(&inputs.driven)?]));
    let mut trade = Trade {
        within: inputs.within,
        planned: settings.len(),
        // The capacity is exact, because a measurement stays in memory with its case.
        settings: Vec::with_capacity(settings.len()),
        finest: finest.iter().map(model).collect(),
        is_over_face,
        build,
    };
    show(&trade);
    for setting in settings {
        let of_setting = setting.inputs(inputs);
        let found = Refusal::unless_stopped(timed(patience, || solve(&of_setting, go_on)))?;
        let found = found.map(|(solution, time)| {
            let answer = Answer::of(&solution);
            let by_taken = Inputs { method: answer.method, ..of_setting };
            let models = Some(StiffnessModels::of(&by_taken));
            let taken = Setting { method: answer.method, models, ..setting };
            let best = finest.iter().find(|(best, _)| best.is_finer_or_coarser(&taken));
            Figures {
                taken,
                time,
                evaluations: solution.dynamic.as_ref().map(|dynamic| dynamic.evaluations),
                numerical: best.map_or([None; Subject::ALL.len()], |(_, best)| off(&answer, best)),
                total: off(&answer, truth),
            }
        });
        trade.settings.push(MeasuredSetting { setting, is_current: setting == current, found });
        show(&trade);
    }
    match trade.settings.iter().find(|measured| measured.found.is_ok()) {
        Some(_) => Ok(trade),
        None => Err(trade.settings[0].found.as_ref().err().copied().unwrap_or(Refusal::Stopped)),
    }
}

/// The index of the reference among the finest settings.
fn reference(is_over_face: bool) -> usize {
    if is_over_face { 0 } else { METHODS.len() - 1 }
}

/// Solves once, then repeats the solve for a time. The first run fills the caches: it counts only
/// if it is the only one.
fn timed(
    patience: Duration,
    solve: impl Fn() -> Result<Solution, Refusal>,
) -> Result<(Solution, Time), Refusal> {
    let run = || {
        let begun = Instant::now();
        let solution = black_box(solve()?);
        Ok((solution, begun.elapsed().as_secs_f64()))
    };
    let (solution, first) = run()?;
    let (begun, mut seconds) = (Instant::now(), Vec::new());
    while begun.elapsed() < patience {
        seconds.push(run()?.1);
    }
    if seconds.is_empty() {
        seconds.push(first);
    }
    seconds.sort_by(f64::total_cmp);
    let runs = seconds.len();
    let quarter = |part: usize| seconds[(runs - 1) * part / 4];
    let spread = 0.5 * (quarter(3) - quarter(1));
    Ok((solution, Time { seconds: quarter(2), spread, runs }))
}

/// The greatest difference, if any.
pub fn greatest(differences: &Differences) -> Option<f64> {
    differences.iter().flatten().copied().reduce(f64::max)
}

impl Trade {
    /// The progress of the measurement, from 0 to 1.
    pub fn part(&self) -> f64 {
        self.settings.len() as f64 / self.planned as f64
    }

    /// The finest setting of the method and compliance of a setting.
    pub fn model(&self, setting: &Setting) -> Option<&Finest> {
        self.finest.iter().find(|model| model.setting.is_finer_or_coarser(setting))
    }

    /// The reference, or the refusal.
    ///
    /// # Errors
    /// The refusal of the case by the method of the reference.
    pub fn reference(&self) -> Result<&Finest, Refusal> {
        let reference = &self.finest[reference(self.is_over_face)];
        reference.outcome.map(|_| reference)
    }

    /// The compared compliances, first that of the reference.
    pub fn compliances(&self) -> Vec<StiffnessModels> {
        let reference = self.reference().into_iter().map(|reference| reference.setting);
        let settings = self.settings.iter().map(|measured| measured.setting);
        distinct(reference.chain(settings).filter_map(|setting| setting.models))
    }

    /// The default setting of a method and compliance.
    pub fn usual(&self, method: Method, models: StiffnessModels) -> Option<&MeasuredSetting> {
        let usual = Setting::of_method(method, Some(models));
        self.settings.iter().find(|measured| measured.setting == usual)
    }

    /// The fastest setting that qualifies; `None` without corner contact: without a force, no setting
    /// can reduce its error.
    pub fn recommended(&self) -> Option<&MeasuredSetting> {
        self.cheapest_where(|_| true).filter(|_| !self.is_without_contact())
    }

    /// Whether the reference finds no corner contact.
    pub fn is_without_contact(&self) -> bool {
        let reference = &self.finest[reference(self.is_over_face)];
        reference.outcome == Ok(Outcome::NoCornerContact)
    }

    /// Whether the error of a setting is within the accepted error.
    pub fn qualifies(&self, measured: &MeasuredSetting) -> bool {
        measured.total().is_some_and(|total| total <= self.within)
    }

    /// Whether no other setting is both faster and more accurate.
    pub fn is_on_front(&self, measured: &MeasuredSetting) -> bool {
        let point = |one: &MeasuredSetting| Some((one.total()?, one.seconds()));
        point(measured).is_some_and(|own| {
            let mut others = self.settings.iter().filter_map(point);
            !others.any(|other| other.0 <= own.0 && other.1 <= own.1 && other != own)
        })
    }

    /// The fastest of the admitted settings that qualifies, among the methods from which `auto`
    /// chooses: `auto` itself uses one of these, and `paper` repeats `exact`. Of settings whose
    /// times are not distinguishable, the most accurate.
    pub fn cheapest_where(&self, admitted: impl Fn(&Setting) -> bool) -> Option<&MeasuredSetting> {
        let is_candidate = |measured: &&MeasuredSetting| {
            self.qualifies(measured)
                && auto::METHODS.contains(&measured.setting.method)
                && admitted(&measured.setting)
        };
        let candidates = || self.settings.iter().filter(is_candidate);
        let fastest =
            candidates().min_by(|one, other| one.seconds().total_cmp(&other.seconds()))?;
        let spread = |measured: &MeasuredSetting| {
            measured.found.as_ref().map_or(0.0, |figures| figures.time.spread)
        };
        let ties = |measured: &&MeasuredSetting| {
            measured.seconds() - fastest.seconds() <= spread(measured) + spread(fastest)
        };
        let error = |measured: &MeasuredSetting| measured.total().unwrap_or(f64::INFINITY);
        candidates().filter(ties).min_by(|one, other| error(one).total_cmp(&error(other)))
    }
}

impl MeasuredSetting {
    /// Time of a solve in s; infinite without a solve.
    pub fn seconds(&self) -> f64 {
        self.found.as_ref().map_or(f64::INFINITY, |figures| figures.time.seconds)
    }

    /// The greatest total error, if the setting answers all needed subjects.
    pub fn total(&self) -> Option<f64> {
        let total = &self.found.as_ref().ok()?.total;
        let is_answered = |subject: &Subject| total[*subject as usize].is_some();
        greatest(total).filter(|_| Subject::NEEDED.iter().all(is_answered))
    }
}

/// The compared methods, fastest first.
pub const METHODS: [Method; 4] = [Method::Paper, Method::Exact, Method::Static, Method::Dynamic];
/// The compared numbers of intervals between stations.
pub const STATIONS: [usize; 3] = [8, 64, 1024];
/// The compared numbers of slices.
pub const SLICES: [usize; 5] = [9, 17, 33, 65, 129];
/// Number of slices of the finest setting.
const BEST_SLICES: usize = 513;
/// Number of intervals of the finest setting of a method.
const BEST_STATIONS: usize = 4096;
/// Tolerance of the finest setting.
const BEST_TOLERANCE: f64 = 1e-12;

/// A method with a compliance and a fineness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// The method.
    pub method: Method,
    /// Compliance of teeth and contact; `None` if method `auto` chooses it.
    pub models: Option<StiffnessModels>,
    /// Number of intervals between the first contact and E; `None` for as many as the curve needs.
    pub stations: Option<usize>,
    /// Relative tolerance of the peak force; in method `dynamic` only.
    pub tolerance: Option<f64>,
    /// Geometry and position in double-double arithmetic.
    pub accurate: bool,
    /// Number of slices of the face width; `None` for as many as the pair needs.
    pub slices: Option<usize>,
    /// Whether a force on a slice displaces the slices beside it.
    pub slice_coupling: bool,
    /// Whether a force on a tooth displaces its neighbours.
    pub tooth_coupling: bool,
}

impl Setting {
    /// Every compared setting: each method coarse and fine with the default compliance, then the
    /// default setting of each method with every other compliance that covers the pair. Over the face
    /// width, each number of slices with and without coupling, and teeth without coupling.
    pub fn all(inputs: &Inputs) -> Vec<Setting> {
        let usual = |method| Setting::usual(method, inputs);
        if inputs.face().is_some() {
            let counts = || SLICES.into_iter().map(Some).chain([None]);
            let [both, teeth, slices] = Setting::coupled(inputs);
            let with_counts = |of: Setting| counts().map(move |slices| Setting { slices, ..of });
            let others = StiffnessModels::covering(inputs)
                .map(|models| Setting::of_method(Method::Static, Some(models)));
            return distinct(
                with_counts(both).chain(with_counts(teeth)).chain([slices]).chain(others),
            );
        }
        // With every number of stations, and with as many as the curve needs. The tolerance of `dynamic`
        // changes neither time nor error noticeably, because its steps are exact while the same pairs touch.
        let stations = |setting: Setting| {
            let counts = STATIONS.into_iter().map(Some).chain([None]);
            counts.map(move |stations| Setting { stations, ..setting })
        };
        let fineness = METHODS
            .into_iter()
            .flat_map(|method| stations(usual(method)))
            .chain([Setting { stations: None, ..Setting::of_method(Method::Auto, None) }]);
        let others = StiffnessModels::covering(inputs)
            .flat_map(|models| METHODS.map(|method| Setting::of_method(method, Some(models))));
        distinct(fineness.chain(others))
    }

    /// A method and compliance with the default fineness.
    pub fn of_method(method: Method, models: Option<StiffnessModels>) -> Setting {
        Setting::with(&Inputs { method, ..Inputs::default() }, models)
    }

    /// The setting of a case that sets only the method.
    pub fn usual(method: Method, inputs: &Inputs) -> Setting {
        let inputs = Inputs { method, ..inputs.clone() };
        Setting::of_method(method, Some(StiffnessModels::by_default(&inputs)))
    }

    /// The finest setting of the same method and compliance, the reference of the numerical error.
    pub fn best(self) -> Setting {
        Setting {
            stations: Some(BEST_STATIONS),
            tolerance: (self.method == Method::Dynamic).then_some(BEST_TOLERANCE),
            accurate: !self.method.shares_load(),
            ..self
        }
    }

    /// The settings over the face width with both couplings, of teeth alone and of slices alone.
    fn coupled(inputs: &Inputs) -> [Setting; 3] {
        let usual = Setting::usual(Method::Static, inputs);
        let teeth = Setting { slice_coupling: false, ..usual };
        [usual, teeth, Setting { tooth_coupling: false, ..usual }]
    }

    /// Whether both settings differ only in their fineness.
    pub fn is_finer_or_coarser(&self, other: &Setting) -> bool {
        let of = |one: &Setting| (one.method, one.models, one.slice_coupling, one.tooth_coupling);
        of(self) == of(other)
    }

    /// The setting of some inputs.
    pub fn of(inputs: &Inputs) -> Setting {
        let is_left_to_auto = inputs.method == Method::Auto && inputs.tooth_compliance.is_none();
        Setting::with(inputs, (!is_left_to_auto).then(|| StiffnessModels::of(inputs)))
    }

    fn with(inputs: &Inputs, models: Option<StiffnessModels>) -> Setting {
        Setting {
            method: inputs.method,
            models,
            stations: inputs.stations,
            tolerance: (inputs.method == Method::Dynamic).then_some(inputs.tolerance),
            accurate: inputs.accurate,
            slices: inputs.slices,
            slice_coupling: inputs.slice_coupling,
            tooth_coupling: inputs.tooth_coupling,
        }
    }

    /// The inputs of the same pair with this setting.
    pub fn inputs(&self, inputs: &Inputs) -> Inputs {
        Inputs {
            method: self.method,
            stations: self.stations,
            tolerance: self.tolerance.unwrap_or(inputs.tolerance),
            accurate: self.accurate,
            slices: self.slices,
            slice_coupling: self.slice_coupling,
            tooth_coupling: self.tooth_coupling,
            ..match self.models {
                Some(models) => models.in_place_of(inputs),
                None => Inputs { tooth_compliance: None, ..inputs.clone() },
            }
        }
    }

    /// The number of stations in the syntax of a case file.
    pub fn stations_text(&self) -> String {
        or_auto(self.stations)
    }

    /// The number of slices in the syntax of a case file.
    pub fn slices_text(&self) -> String {
        or_auto(self.slices)
    }

    /// Writes the setting into a case. If the case names no compliance and the setting has the
    /// default compliance, the case still names none.
    pub fn apply(&self, case: &mut Case) {
        let flag = |is_set| Some(if is_set { "true" } else { "false" });
        write(case, "model.method", Some(self.method.name()));
        write(case, "model.stations", Some(&self.stations_text()));
        write(case, "model.accurate", flag(self.accurate));
        let tolerance = self.tolerance.map(|tolerance| format!("{tolerance:e}"));
        write(case, "model.tolerance", tolerance.as_deref());
        let own = case.inputs().ok().map(|inputs| Setting::of(&inputs));
        let of_face = |one: &Setting| (one.slices, one.slice_coupling, one.tooth_coupling);
        if own.as_ref().map(of_face) != Some(of_face(self)) {
            write(case, "model.slices", Some(&self.slices_text()));
            write(case, "model.slice_coupling", flag(self.slice_coupling));
            write(case, "model.tooth_coupling", flag(self.tooth_coupling));
        }
        if own.and_then(|own| own.models) != self.models {
            let tooth = self.models.map_or("", |models| models.tooth.name());
            write(case, "model.tooth_compliance", Some(tooth));
            let contact = self.models.and_then(|models| Some(models.contact?.name()));
            write(case, "model.contact_compliance", contact);
        }
    }
}

fn or_auto(count: Option<usize>) -> String {
    count.map_or_else(|| AUTO.to_owned(), |count| count.to_string())
}

fn write(case: &mut Case, key: &str, text: Option<&str>) {
    if let Some((field, text)) = index_of(key).zip(text) {
        case.write(field, text);
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with ", self.method.name())?;
        if let Some(models) = self.models {
            write!(f, "{}, ", models.names())?;
        }
        write!(f, "{} stations", self.stations_text())?;
        if let Some(tolerance) = self.tolerance {
            write!(f, " and tolerance {tolerance:e}")?;
        }
        match (self.slices, self.slice_coupling) {
            (None, true) => {}
            (_, true) => write!(f, ", {} slices", self.slices_text())?,
            (_, false) => write!(f, ", {} independent slices", self.slices_text())?,
        }
        if !self.tooth_coupling {
            f.write_str(", independent teeth")?;
        }
        if self.accurate { f.write_str(", accurate") } else { Ok(()) }
    }
}

/// A result that several methods compute, each as a quantity of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd)]
pub enum Subject {
    /// Driven gear's angle before E at the first contact.
    FirstContact,
    /// Greatest force of the incoming tooth.
    PeakForce,
    /// Greatest force of the incoming tooth before E.
    PeakApproachForce,
    /// Duration of the first impact.
    Duration,
    /// The kinematic friction ratio.
    FrictionRatio,
    /// The force over the driver's roll angle from D to E.
    Curve,
    /// The greatest line load over the face width.
    LineLoad,
    /// The transmission error of a passage, of a load that varies over the face width.
    TransmissionError,
}

impl Subject {
    /// Every subject, in order.
    pub const ALL: [Subject; 8] = [
        Subject::FirstContact,
        Subject::PeakForce,
        Subject::PeakApproachForce,
        Subject::Duration,
        Subject::FrictionRatio,
        Subject::Curve,
        Subject::LineLoad,
        Subject::TransmissionError,
    ];
    /// The subjects that a setting must answer to qualify.
    pub const NEEDED: [Subject; 3] = [Subject::FirstContact, Subject::PeakForce, Subject::Curve];

    /// The name in JSON, and the key of the quantity of the free impact; empty for the curve.
    const fn names(self) -> (&'static str, &'static str) {
        match self {
            Subject::FirstContact => ("first_contact_angle", "approach_angle_driven"),
            Subject::PeakForce => ("peak_force", "impact_force"),
            Subject::PeakApproachForce => ("peak_approach_force", "impact_force"),
            Subject::Duration => ("impact_duration", "impact_duration"),
            Subject::FrictionRatio => ("friction_ratio", "friction_ratio"),
            Subject::Curve => ("curve", ""),
            Subject::LineLoad => ("peak_line_load", "static_peak_line_load"),
            Subject::TransmissionError => ("transmission_error", "static_transmission_error"),
        }
    }

    /// The name in JSON.
    pub fn key(self) -> &'static str {
        self.names().0
    }

    /// The quantity of a method for this subject; `None` for the curve, and if the method has no
    /// such quantity.
    pub fn quantity(self, method: Method) -> Option<&'static Quantity> {
        match (self, method) {
            (Subject::PeakForce, Method::Static) => Quantity::find("static_peak_force"),
            (Subject::PeakForce, Method::Dynamic) => Quantity::find("dynamic_peak_force"),
            (Subject::LineLoad | Subject::TransmissionError, Method::Static) => {
                Quantity::find(self.names().1)
            }
            (Subject::LineLoad | Subject::TransmissionError, _) => None,
            _ => Quantity::find(self.names().1)?.by(method),
        }
    }

    /// Whether the method computes the subject.
    pub fn is_of(self, method: Method) -> bool {
        self == Subject::Curve || self.quantity(method).is_some()
    }
}

/// The answer of a solve.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The method of the solve; for `auto`, the chosen method.
    pub method: Method,
    /// Whether the tooth strikes.
    pub outcome: Outcome,
    /// Values of [`Subject::quantity`], in SI, in the order of [`Subject::ALL`].
    values: [Option<f64>; Subject::ALL.len()],
    /// Driver's angle before E in rad and force in N, from the first contact to E.
    curve: Vec<(f64, f64)>,
}

/// The stages that the answer of a method needs.
pub fn stages(method: Method) -> Stages {
    match method {
        Method::Paper | Method::Exact => Stages::CLOSED_FORM.with(Stage::Stations),
        Method::Static => Stages::of(Stage::Static),
        Method::Dynamic => Stages::of(Stage::Dynamic),
        // `static` replaces `dynamic` if `auto` chooses it.
        Method::Auto => Stages::CLOSED_FORM.with(Stage::Stations).and(Stages::of(Stage::Dynamic)),
    }
}

/// Solves the stages of the answer only.
///
/// # Errors
/// The refusal, also if a part of the answer is withheld; [`Refusal::Stopped`] if `go_on` returns
/// false.
fn solve(inputs: &Inputs, go_on: &dyn Fn() -> bool) -> Result<Solution, Refusal> {
    if !go_on() {
        return Err(Refusal::Stopped);
    }
    let solution = model::solve_while(inputs, stages(inputs.method), &|_| go_on())?;
    match solution.withheld.or(solution.stations_withheld) {
        Some(refusal) => Err(refusal),
        None => Ok(solution),
    }
}

impl Answer {
    /// The answer of a solve.
    pub fn of(solution: &Solution) -> Answer {
        let Solution { method, outcome, .. } = *solution;
        let value = |subject: Subject| match subject {
            Subject::TransmissionError if solution.face_load.is_none() => None,
            _ => {
                let known = subject.quantity(method).filter(|known| known.is_listed(solution));
                known.and_then(|known| (known.value)(solution))
            }
        };
        let stations = solution.own_stations().iter();
        let before_end = stations.filter(|station| station.roll_angle_driver >= 0.0);
        let curve = before_end.map(|station| (station.roll_angle_driver, station.force));
        Answer { method, outcome, values: Subject::ALL.map(value), curve: curve.collect() }
    }

    /// The value in SI, if any.
    pub fn value(&self, subject: Subject) -> Option<f64> {
        self.values[subject as usize]
    }

    /// The error of this answer, relative to `truth`; `None` if one of the methods has no such
    /// quantity. If neither finds a strike the error is 0; if only one does, it is 1.
    pub fn off(&self, truth: &Answer, subject: Subject) -> Option<f64> {
        if !(subject.is_of(self.method) && subject.is_of(truth.method)) {
            return None;
        }
        let strikes = [self, truth].map(|answer| answer.outcome == Outcome::CornerContact);
        let values = [self, truth].map(|answer| answer.value(subject));
        Some(match (values, strikes) {
            (_, [true, true]) if subject == Subject::Curve => self.curve_error(truth),
            ([Some(found), Some(expected)], _) => relative(found - expected, expected),
            ([None, None], _) if subject > Subject::Curve => return None,
            ([None, None], _) if subject != Subject::Curve => 0.0,
            (_, [false, false]) => 0.0,
            _ => 1.0,
        })
    }

    /// The greatest difference of the forces over the driver's roll angle from the earlier first
    /// contact to E, over the true peak. With linear interpolation the greatest difference is at a
    /// station of one of the curves.
    fn curve_error(&self, truth: &Answer) -> f64 {
        let angles = self.curve.iter().chain(&truth.curve).map(|&(angle, _)| angle);
        let apart = angles
            .map(|angle| (self.force_at(angle) - truth.force_at(angle)).abs())
            .fold(0.0, f64::max);
        relative(apart, truth.value(Subject::PeakForce).unwrap_or_default())
    }

    /// The force at the driver's angle before E, by linear interpolation between stations; 0 before
    /// the first contact.
    pub fn force_at(&self, angle: f64) -> f64 {
        /// First contacts that differ by no more than rounding are equal.
        const ROUNDING: f64 = 1e-9;
        let next = self.curve.partition_point(|station| station.0 > angle);
        match (next.checked_sub(1).map(|before| self.curve[before]), self.curve.get(next)) {
            (Some(before), Some(&after)) => {
                before.1 + (after.1 - before.1) * (before.0 - angle) / (before.0 - after.0)
            }
            (None, Some(&first)) if angle <= first.0 * (1.0 + ROUNDING) => first.1,
            (None, _) => 0.0,
            (Some(last), None) => last.1,
        }
    }
}

/// A difference over a size; 1 if the size is 0.
fn relative(difference: f64, size: f64) -> f64 {
    if difference == 0.0 {
        return 0.0;
    }
    let relative = (difference / size).abs();
    if relative.is_finite() { relative } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    fn answer(method: Method, stations: usize) -> Answer {
        let inputs =
            Inputs { method, stations: Some(stations), ..Case::table_1().inputs().unwrap() };
        Answer::of(&solve(&inputs, &|| true).unwrap())
    }

    #[test]
    fn a_curve_is_interpolated_linearly_and_is_zero_before_the_first_contact() {
        let shared = answer(Method::Static, 4);
        let (first, second) = (shared.curve[0], shared.curve[1]);
        assert_eq!((shared.curve.len(), shared.curve[4].0), (5, 0.0));
        assert!(
            (shared.force_at(f64::midpoint(first.0, second.0)) - f64::midpoint(first.1, second.1))
                .abs()
                < 1e-9
        );
        assert!(
            (shared.force_at(0.0) - shared.value(Subject::PeakApproachForce).unwrap()).abs() < 1e-9
        );
        assert!(shared.force_at(1.01 * first.0).abs() < f64::MIN_POSITIVE);
        let impact = answer(Method::Exact, 4);
        assert_eq!(
            Some(impact.force_at(impact.curve[0].0 * (1.0 + 1e-15))),
            impact.value(Subject::PeakForce)
        );
    }

    #[test]
    fn an_answer_differs_from_others_and_not_from_itself() {
        let (shared, impact) = (answer(Method::Static, 16), answer(Method::Exact, 16));
        for subject in Subject::ALL {
            let has_value = subject.is_of(Method::Static) && subject <= Subject::Curve;
            assert_eq!(shared.off(&shared, subject), has_value.then_some(0.0), "{subject:?}");
        }
        assert_eq!(impact.off(&shared, Subject::Duration), None);
        assert!(impact.off(&shared, Subject::Curve).unwrap() > 0.5);
        let on_time = Answer {
            outcome: Outcome::NoCornerContact,
            values: [None; Subject::ALL.len()],
            curve: Vec::new(),
            ..impact.clone()
        };
        assert_eq!(on_time.off(&shared, Subject::FirstContact), Some(1.0));
        assert_eq!(on_time.off(&shared, Subject::Curve), Some(1.0));
        let also = Answer { outcome: Outcome::NoCornerContact, ..shared };
        assert!(Subject::NEEDED.iter().all(|&subject| on_time.off(&also, subject) == Some(0.0)));
    }

    fn table_1() -> Inputs {
        Case::table_1().inputs().unwrap()
    }

    #[test]
    fn every_setting_is_listed_once_and_applies_to_the_case() {
        let settings = Setting::all(&table_1());
        for models in StiffnessModels::covering(&table_1()) {
            for method in METHODS {
                let is_it = |one: &&Setting| one.method == method && one.models == Some(models);
                assert!(settings.iter().any(|one| is_it(&one)), "{method:?} {models:?}");
            }
        }
        for (at, setting) in settings.iter().enumerate() {
            assert!(!settings[..at].contains(setting), "{setting} twice");
            let mut case = Case::table_1();
            setting.apply(&mut case);
            assert_eq!(Setting::of(&case.inputs().unwrap()), *setting);
        }
    }

    #[test]
    fn the_usual_setting_is_that_of_a_case_that_names_the_method_alone() {
        let mut case = Case::table_1();
        let usual = Setting::usual(Method::Dynamic, &table_1());
        case.set("model.tooth_compliance", "").unwrap();
        usual.apply(&mut case);
        let compliance = index_of("model.tooth_compliance").unwrap();
        assert_eq!(case.text(compliance), None, "the default needs no name");
        for key in ["model.stations", "model.tolerance", "model.accurate"] {
            case.set(key, "").unwrap();
        }
        assert_eq!(Setting::of(&case.inputs().unwrap()), usual);
    }

    #[test]
    fn a_setting_prints_method_models_and_fineness() {
        let inputs = table_1();
        assert_eq!(
            Setting::usual(Method::Dynamic, &inputs).best().to_string(),
            "dynamic with finite-element, 4096 stations and tolerance 1e-12"
        );
        let auto = Setting::all(&inputs).into_iter().find(|one| one.method == Method::Auto);
        assert_eq!(auto.unwrap().to_string(), "auto with auto stations");
        assert_eq!(
            Setting::usual(Method::Paper, &inputs).best().to_string(),
            "paper with kuang-yang and logarithmic, 4096 stations, accurate"
        );
    }
}
