//! Accuracy against run time: the promises of the trade study, and the stored errors of the cases
//! in `cases/`.
//!
//! `TIPSTRIKE_REGENERATE=1` writes the stored errors again.
use crate::table;

use std::cell::Cell;
use std::sync::LazyLock;
use std::time::Duration;

use serde_json::Value;
use tipstrike::case::Case;
use tipstrike::model::impact::StiffnessModels;
use tipstrike::model::inputs::{Method, ToothCompliance};
use tipstrike::model::{Inputs, Refusal, Stage, Stages, solve};
use tipstrike::report::table::Named;
use tipstrike::study::shard::Format;
use tipstrike::study::trade::{
    Answer, METHODS, MeasuredSetting, STATIONS, Setting, Subject, Trade, trade,
};

fn table_1() -> Inputs {
    Case::table_1().inputs().expect("the built-in case is valid")
}

fn traded(inputs: &Inputs, within: f64) -> Trade {
    let inputs = Inputs { within, ..inputs.clone() };
    let found = trade(&inputs, Duration::ZERO, &|| true, &mut |_| ());
    found.unwrap_or_else(|refusal| panic!("{refusal}"))
}

/// The trade study of Table 1, computed once for all tests.
fn traded_table_1() -> &'static Trade {
    static TRADE: LazyLock<Trade> = LazyLock::new(|| traded(&table_1(), 0.05));
    &TRADE
}

fn of<'a>(trade: &'a Trade, setting: &Setting) -> &'a MeasuredSetting {
    let found = trade.settings.iter().find(|measured| measured.setting == *setting);
    found.unwrap_or_else(|| panic!("no {setting}"))
}

fn numerical(measured: &MeasuredSetting, subject: Subject) -> f64 {
    let figures =
        measured.found.as_ref().unwrap_or_else(|refusal| panic!("{}: {refusal}", measured.setting));
    figures.numerical[subject as usize].unwrap_or_else(|| panic!("no {}", subject.key()))
}

fn written(trade: &Trade, format: Format) -> String {
    let (case, mut out) = (Named { name: "case.toml", title: "a title" }, Vec::new());
    case.write(trade, format, &mut out).expect("memory");
    String::from_utf8(out).expect("text")
}

fn json(trade: &Trade) -> Value {
    serde_json::from_str(&written(trade, Format::Json)).expect("JSON")
}

fn text(trade: &Trade) -> String {
    written(trade, Format::Text)
}

#[test]
fn table_1_within_five_percent_needs_the_method_dynamic() {
    let trade = traded_table_1();
    let best = trade.recommended().expect("one qualifies");
    assert_eq!(best.setting.method, Method::Dynamic, "{}", best.setting);
    assert!(trade.qualifies(best) && best.total().unwrap() <= 0.05);
    for measured in &trade.settings {
        let dynamic =
            measured.found.as_ref().is_ok_and(|figures| figures.taken.method == Method::Dynamic);
        assert!(dynamic || !trade.qualifies(measured), "{}", measured.setting);
    }
    assert!(text(trade).contains("\nWithin 5.0 %: dynamic with"), "{}", text(trade));
}

#[test]
fn every_method_is_compared_with_every_compliance_of_the_pair() {
    let trade = traded_table_1();
    let reference = trade.reference().unwrap();
    let compliances = trade.compliances();
    assert_eq!(compliances.len(), StiffnessModels::covering(&table_1()).count());
    assert_eq!(Some(compliances[0]), reference.setting.models);
    for models in compliances {
        for method in METHODS {
            let measured = trade.usual(method, models).expect("a setting");
            let is_reference =
                (method, Some(models)) == (Method::Dynamic, reference.setting.models);
            assert_eq!(measured.total().unwrap() < 0.01, is_reference, "{}", measured.setting);
        }
    }
    let build = trade.build.expect("both gears have a field");
    assert!(build.iter().all(|&seconds| seconds > 0.0));
    let (text, json) = (text(trade), json(trade));
    assert!(text.contains("> kuang-yang logarithmic"), "{text}");
    assert!(text.contains("are solved once per gear"), "{text}");
    assert_eq!(json["reference"]["tooth_compliance"], "finite-element");
    assert_eq!(json["field_seconds"].as_array().unwrap().len(), 2);
    let has =
        |line: &Value| line["tooth_compliance"] == "beam" && line["contact_compliance"] == "weber";
    assert_eq!(json["settings"].as_array().unwrap().iter().filter(|line| has(line)).count(), 4);
}

/// The rim is too thin for elements, and the beam replaces the field.
#[test]
fn a_pair_without_a_field_is_compared_with_the_beam_and_the_page_says_why() {
    let mut inputs = table_1();
    inputs.driver.bore_radius = 0.999 * (inputs.module * (10.0 - 1.25));
    inputs.driver.poisson = 0.495;
    inputs.tooth_compliance = None;
    let trade = traded(&inputs, 0.05);
    let models = trade.reference().unwrap().setting.models.unwrap();
    assert_eq!(models.tooth.name(), ToothCompliance::BEAM.name());
    assert!(matches!(trade.build, Err(Refusal::NoField { .. })), "{:?}", trade.build);
    let words = text(&trade).replace('\n', " ");
    assert!(words.contains("There are no finite elements to compare with: "), "{words}");
    assert!(json(&trade).get("field_seconds").is_none());
}

#[test]
fn no_setting_qualifies_for_an_unreachable_tolerance() {
    let trade = traded(&table_1(), 1e-15);
    assert!(trade.recommended().is_none());
    assert!(text(&trade).ends_with("%: none\n"));
    assert!(json(&trade).get("recommended").is_none());
}

#[test]
fn no_setting_of_the_front_is_worse_than_another_in_both() {
    let trade = traded_table_1();
    let point = |one: &MeasuredSetting| Some((one.total()?, one.seconds(), trade.is_on_front(one)));
    let points: Vec<(f64, f64, bool)> = trade.settings.iter().filter_map(point).collect();
    assert!(points.iter().filter(|point| point.2).count() >= 3);
    for point in &points {
        let beaten = points.iter().any(|other| {
            other.0 <= point.0 && other.1 <= point.1 && (other.0, other.1) != (point.0, point.1)
        });
        assert_eq!(beaten, !point.2, "{point:?}");
    }
}

#[test]
fn errors_fall_with_stations_and_are_below_the_tolerance() {
    let trade = traded_table_1();
    for method in METHODS {
        let usual = Setting::usual(method, &table_1());
        let off = |stations| {
            numerical(of(trade, &Setting { stations: Some(stations), ..usual }), Subject::Curve)
        };
        for pair in STATIONS.windows(2) {
            assert!(off(pair[1]) < off(pair[0]), "{method:?} {pair:?} {:e}", off(pair[0]));
        }
        // At a corner of the curve the error is proportional to the distance to the nearest
        // station, which falls with their number; the position of the corner between two stations
        // adds scatter.
        assert!(off(1024) < 5.0 * 8.0 / 1024.0 * off(8), "{method:?}");
    }
    for tolerance in [1e-3, 1e-6, 1e-10] {
        let usual = Setting::usual(Method::Dynamic, &table_1());
        let by = |setting: Setting| {
            let inputs = Inputs { tolerance, ..setting.inputs(&table_1()) };
            let solution = solve(&inputs, Stages::of(Stage::Dynamic)).expect("a solution");
            Answer::of(&solution).value(Subject::PeakApproachForce).expect("a force")
        };
        let best = usual.best().inputs(&table_1());
        let truth = Answer::of(&solve(&best, Stages::of(Stage::Dynamic)).expect("a solution"));
        let truth = truth.value(Subject::PeakApproachForce).expect("a force");
        let off = (by(usual) / truth - 1.0).abs();
        assert!(off < 0.1 * tolerance, "{tolerance:e}: {off:e}");
    }
}

#[test]
fn only_needed_subjects_count_if_a_method_lacks_some() {
    let trade = traded_table_1();
    let is_fine = |measured: &&MeasuredSetting| trade.model(&measured.setting).is_some();
    for measured in trade.settings.iter().filter(is_fine) {
        let figures = measured.found.as_ref().unwrap();
        let has_ratio = figures.numerical[Subject::FrictionRatio as usize].is_some();
        let is_closed = matches!(figures.taken.method, Method::Paper | Method::Exact);
        assert_eq!(has_ratio, is_closed, "{}", measured.setting);
        assert_eq!(figures.total[Subject::FrictionRatio as usize], None);
        let has_duration = figures.total[Subject::Duration as usize].is_some();
        assert_eq!(has_duration, figures.taken.method != Method::Static);
        assert!(measured.total().is_some());
    }
}

#[test]
fn the_cases_own_setting_is_there_and_marked() {
    let inputs =
        Inputs { method: Method::Dynamic, stations: Some(77), tolerance: 3e-5, ..table_1() };
    let trade = traded(&inputs, 0.05);
    let own: Vec<&MeasuredSetting> =
        trade.settings.iter().filter(|measured| measured.is_current).collect();
    assert_eq!(own.len(), 1);
    assert_eq!(own[0].setting, Setting::of(&inputs));
    assert_eq!(trade.planned, trade.settings.len());
}

#[test]
fn no_corner_contact_by_both_is_agreement() {
    let mut cases = table::cases().into_iter();
    let relieved = cases.find(|path| path.ends_with("tip-relief-enough.toml"));
    let inputs = table::inputs(&relieved.unwrap());
    let trade = traded(&inputs, 0.05);
    let exact = of(&trade, &Setting::usual(Method::Exact, &table_1()));
    assert_eq!(exact.found.as_ref().unwrap().total[Subject::FirstContact as usize], Some(0.0));
    assert!(trade.qualifies(exact), "{:?}", exact.total());
    let says = "There is no corner contact: no setting is recommended.\n";
    assert!(text(&trade).ends_with(says), "{}", text(&trade));
    assert!(trade.recommended().is_none() && json(&trade).get("recommended").is_none());
    assert!(!text(traded_table_1()).contains("no setting is recommended"));
}

#[test]
fn a_method_that_refuses_is_listed_with_its_reason() {
    let mut case = Case::table_1();
    for (key, value) in [
        ("operation.power", "2 W"),
        ("operation.speed", "0.002 rpm"),
        ("model.deflection", "24.7 um"),
    ] {
        case.set(key, value).unwrap();
    }
    let trade = traded(&case.inputs().unwrap(), 0.05);
    assert!(matches!(trade.reference(), Err(Refusal::TooSlow { .. })));
    let dynamic = of(&trade, &Setting::usual(Method::Dynamic, &table_1()));
    assert!(dynamic.found.is_err() && !trade.qualifies(dynamic) && !trade.is_on_front(dynamic));
    assert!(trade.recommended().is_none());
    let (text, json) = (text(&trade), json(&trade));
    assert!(text.contains("No reference: method dynamic refuses the case"), "{text}");
    assert!(json["no_reference"].is_string() && json.get("reference").is_none());
    let all = json["settings"].as_array().unwrap().iter();
    let refused: Vec<&Value> = all.filter(|one| one["refusal"].is_string()).collect();
    assert!(!refused.is_empty() && refused.iter().all(|one| one.get("seconds").is_none()));
}

#[test]
fn a_trade_reports_its_progress_and_stops_on_request() {
    let (seen, asked) = (Cell::new(0), Cell::new(0u32));
    let go_on = || {
        asked.set(asked.get() + 1);
        seen.get() < 5
    };
    let stopped = trade(&table_1(), Duration::ZERO, &go_on, &mut |sofar| {
        assert!(sofar.settings.len() <= sofar.planned);
        seen.set(sofar.settings.len());
    });
    assert_eq!((stopped.err(), seen.get()), (Some(Refusal::Stopped), 5));
    assert!(asked.get() > 5);
    let never = trade(&table_1(), Duration::ZERO, &|| false, &mut |_| panic!("no benchmark"));
    assert_eq!(never.err(), Some(Refusal::Stopped));
}

#[test]
fn json_has_every_setting_with_its_errors() {
    let trade = traded_table_1();
    let object = json(trade);
    assert_eq!((&object["case"], &object["title"]), (&"case.toml".into(), &"a title".into()));
    assert_eq!(object["within"], 0.05);
    assert_eq!(object["reference"]["tolerance"], 1e-12);
    assert!(object["reference"]["quantities"]["dynamic_peak_force"].as_f64().unwrap() > 1000.0);
    let settings = object["settings"].as_array().unwrap();
    assert_eq!(settings.len(), trade.settings.len());
    for setting in settings {
        let keys = "method stations accurate seconds spread errors total pareto qualifies";
        assert!(keys.split(' ').all(|key| setting.get(key).is_some()), "{setting}");
        let dynamic = setting["method"] == "dynamic";
        assert_eq!(setting.get("tolerance").is_some(), dynamic, "{setting}");
        let total = setting["errors"]["curve"]["total"].as_f64().unwrap();
        assert!(total <= setting["total"].as_f64().unwrap());
        let is_measured = setting["errors"]["curve"]["numerical"].is_number();
        assert_eq!(setting["errors"]["curve"]["model"].is_number(), is_measured);
    }
    assert_eq!(object["recommended"]["method"], "dynamic");
    assert_eq!(object["recommended"]["qualifies"], true);
}

/// Over the face width slices are compared: coupled slices converge, and independent slices have a
/// model error of the greatest line load.
#[test]
fn couplings_of_a_helical_pair_are_compared() {
    let helical = Inputs {
        helix_angle: 20f64.to_radians(),
        tooth_compliance: Some(ToothCompliance::KUANG_YANG),
        method: Method::Static,
        deflection: None,
        ..table_1()
    };
    let mut inputs = helical;
    (inputs.driver.face_width, inputs.driven.face_width) = (30e-3, 30e-3);
    let trade = traded(&inputs, 0.05);
    let off = |slices: usize, is_coupled: bool| {
        let is_it = |one: &&MeasuredSetting| {
            (one.setting.slices, one.setting.slice_coupling) == (Some(slices), is_coupled)
        };
        let found = trade.settings.iter().find(is_it).expect("a setting");
        let figures = found.found.as_ref().expect("a solve");
        let of = |subject: Subject| figures.total[subject as usize].expect("a value");
        [Subject::FirstContact, Subject::LineLoad, Subject::TransmissionError].map(of)
    };
    let (few, many) = (off(9, true), off(129, true));
    assert!(many[0] <= few[0] && many[1] <= few[1] && many[2] < 1e-3, "{few:?} {many:?}");
    assert!(many[1] < 0.02 && off(129, false)[1] > 0.05, "{many:?} {:?}", off(129, false));
    let (text, json) = (text(&trade), json(&trade));
    assert!(text.contains("slices, teeth") && text.lines().all(|line| line.chars().count() <= 80));
    let line = &json["settings"][0];
    assert_eq!((&line["slices"], &line["slice_coupling"]), (&9.into(), &true.into()));
    let has_alone = trade.settings.iter().any(|one| !one.setting.tooth_coupling);
    assert!(has_alone && line["tooth_coupling"] == true);
    assert!(line["errors"]["peak_line_load"]["total"].is_number());
    assert_eq!(json["reference"]["slices"], 513);
}

/// Twice as many cycles or stations take twice as many evaluations, plus a constant; cycles only
/// while they differ.
#[test]
fn cost_grows_linearly_with_cycles_and_stations() {
    let evaluations = |damping_ratio, cycles, stations| {
        let inputs = Inputs {
            method: Method::Dynamic,
            warmup_cycles: cycles,
            stations: Some(stations),
            deflection: None,
            ..table_1()
        };
        let solution = solve(&Inputs { damping_ratio, ..inputs }, Stages::of(Stage::Dynamic))
            .expect("a solution");
        solution.dynamic.expect("the method").evaluations as f64
    };
    let slope = |from: f64, to: f64, steps: f64| (to - from) / steps;
    let (few, some, many) =
        (evaluations(0.0, 20, 64), evaluations(0.0, 40, 64), evaluations(0.0, 160, 64));
    let ratio = slope(some, many, 120.0) / slope(few, some, 20.0);
    assert!((0.8..1.25).contains(&ratio), "{ratio} {few} {some} {many}");
    let (few, many) = (evaluations(0.07, 20, 64), evaluations(0.07, 1000, 64));
    assert!(many < 1.1 * few, "a repeated cycle is free: {few} {many}");
    let (few, some, many) =
        (evaluations(0.07, 20, 64), evaluations(0.07, 20, 128), evaluations(0.07, 20, 1024));
    let ratio = slope(some, many, 896.0) / slope(few, some, 64.0);
    assert!((0.9..1.1).contains(&ratio), "{ratio} {few} {some} {many}");
}

#[test]
fn stored_errors_agree_within_a_factor_of_two() {
    let (stored, made) = (table::Table::stored(), table::Table::of(table::traded_once()));
    if std::env::var_os("TIPSTRIKE_REGENERATE").is_some() {
        made.keep();
    } else {
        stored.holds(&made);
    }
}
