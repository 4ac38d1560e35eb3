//! Accuracy against run time over spur and helical pairs of every size: `cargo bench --bench trade`
//! prints the tables. With `TIPSTRIKE_REGENERATE=1` it writes those of docs/speed.md and `assets/trade.svg`.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a benchmark prints its results"
)]

use tipstrike::case::Case;
use tipstrike::model::impact::StiffnessModels;
use tipstrike::report::chart::{Axis, Chart, Kind, Point, Series};
use tipstrike::report::svg;
use tipstrike::report::trade::{duration, percent, plotted_error, power_of_time};
use tipstrike::study::trade::{METHODS, MeasuredSetting, STEADY, Setting, Subject, Trade, trade};

/// Module in mm, teeth, profile shifts, helix angle in deg.
type Pair = (f64, [u32; 2], [f64; 2], f64);

const SPUR: [Pair; 18] = [
    (0.1, [12, 60], [0.3, 0.0], 0.0),
    (0.2, [8, 40], [0.5, 0.0], 0.0),
    (0.3, [20, 20], [0.0, 0.0], 0.0),
    (0.5, [17, 43], [0.0, 0.0], 0.0),
    (0.8, [30, 120], [0.0, 0.0], 0.0),
    (1.0, [1000, 1000], [0.0, 0.0], 0.0),
    (1.0, [25, 500], [0.2, 0.0], 0.0),
    (1.5, [18, 36], [0.2, 0.0], 0.0),
    (2.0, [10, 10], [0.5, 0.5], 0.0),
    (2.5, [23, 47], [0.3, 0.1], 0.0),
    (3.0, [28, 28], [0.0, 0.0], 0.0),
    (4.0, [16, 24], [0.2, 0.2], 0.0),
    (6.0, [20, 60], [0.0, 0.0], 0.0),
    (8.0, [200, 300], [0.0, 0.0], 0.0),
    (12.0, [24, 95], [0.3, 0.3], 0.0),
    (20.0, [18, 36], [0.39, 0.5], 0.0),
    (35.0, [19, 17], [0.6, 0.8], 0.0),
    (50.0, [15, 30], [0.3, 0.0], 0.0),
];
const HELICAL: [Pair; 10] = [
    (0.1, [15, 45], [0.3, 0.0], 20.0),
    (0.3, [20, 40], [0.0, 0.0], 30.0),
    (0.5, [17, 43], [0.0, 0.0], 20.0),
    (1.0, [60, 90], [0.0, 0.0], 10.0),
    (1.5, [300, 900], [0.0, 0.0], 12.0),
    (2.0, [20, 35], [0.0, 0.0], 20.0),
    (4.0, [5, 30], [0.5, 0.0], 25.0),
    (8.0, [17, 103], [0.145, 0.0], 15.8),
    (14.0, [24, 95], [0.48, 0.6691], 10.0),
    (50.0, [20, 60], [0.0, 0.0], 8.0),
];

fn main() {
    // `cargo test --benches` and `cargo bench -- --test` only check that the benchmark starts.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let traded = |pairs: &[Pair]| pairs.iter().map(measured).collect::<Vec<_>>();
    let (spur, helical) = (traded(&SPUR), traded(&HELICAL));
    let usual = inputs(&SPUR[10]);
    let is_usual_contact = |setting: &Setting| {
        let contact = setting.models.and_then(|models| models.contact);
        contact.is_none_or(|contact| contact == usual.contact_compliance)
    };
    let methods = METHODS.map(|method| {
        let models = StiffnessModels::covering(&usual);
        let settings = models.map(|models| Setting::of_method(method, Some(models)));
        settings.filter(is_usual_contact).collect::<Vec<_>>()
    });
    let auto = Setting::all(&usual).into_iter().find(|one| one.models.is_none());
    let over_face: Vec<Setting> =
        Setting::all(&inputs(&HELICAL[5])).into_iter().filter(is_usual_contact).collect();
    let table_of = |settings: &[Setting], trades, subjects: [(&str, Subject); 3]| {
        let names = subjects.map(|(name, _)| name).join(" | ");
        let rows = settings.iter().filter_map(|setting| row(setting, trades, subjects));
        let rows: Vec<String> = rows.collect();
        format!(
            "| setting | pairs | time | {names} | greatest |\n|---|---|---|---|---|---|---|\n{}\n",
            rows.join("\n")
        )
    };
    let first = ("first contact", Subject::FirstContact);
    let of_spur = [first, ("peak force", Subject::PeakForce), ("curve", Subject::Curve)];
    let of_face = [
        first,
        ("peak line load", Subject::LineLoad),
        ("transmission error", Subject::TransmissionError),
    ];
    let settings: Vec<Setting> = methods.iter().flatten().copied().chain(auto).collect();
    let tables = [
        ("spur pairs", table_of(&settings, &spur, of_spur)),
        ("helical pairs", table_of(&over_face, &helical, of_face)),
    ];
    let of_methods = METHODS.into_iter().zip(&methods);
    let mut series: Vec<Series> =
        of_methods.map(|(method, settings)| marks(method.name(), settings, &spur)).collect();
    let is_slices = |setting: &&Setting| setting.is_finer_or_coarser(&over_face[0]);
    let slices: Vec<Setting> = over_face.iter().filter(is_slices).copied().collect();
    series.push(marks("static, helical: slices", &slices, &helical));
    for (name, table) in &tables {
        println!("{name}\n\n{table}");
    }
    if std::env::var_os("TIPSTRIKE_REGENERATE").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/trade.svg");
        std::fs::write(path, picture(series)).expect("the picture is written");
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/speed.md");
        let mut text = std::fs::read_to_string(path).expect("docs/speed.md");
        for (name, table) in &tables {
            let marks = [format!("<!-- {name} -->\n"), format!("<!-- /{name} -->")];
            let (before, rest) = text.split_once(&marks[0]).expect("the first mark");
            let (_, after) = rest.split_once(&marks[1]).expect("the second mark");
            text = format!("{before}{}{table}{}{after}", marks[0], marks[1]);
        }
        std::fs::write(path, text).expect("docs/speed.md is written");
    }
}

/// A steel pair at 10 m/s with a K factor of 3 N/mm2, at most 30 N/mm2 of tangential force over width and
/// module, and a base pitch deviation of about grade 7. Five teeth have a short addendum.
fn inputs(&(module, teeth, shifts, helix): &Pair) -> tipstrike::model::Inputs {
    let mut case = Case::empty();
    let mut set = |key: &str, value: String| {
        case.set(key, &value).unwrap_or_else(|problem| panic!("{key}: {problem}"));
    };
    let (width, is_short) = (10.0 * module, teeth[0] < 8);
    let diameter = module * f64::from(teeth[0]) / helix.to_radians().cos();
    let ratio = f64::from(teeth[1]) / f64::from(teeth[0]);
    // N mm = mJ
    let load = (3.0 * diameter * ratio / (1.0 + ratio)).min(30.0 * module);
    let torque = 1e-3 * load * width * diameter / 2.0;
    set("pair.module", format!("{module} mm"));
    set("pair.pressure_angle", "20 deg".to_owned());
    if helix > 0.0 {
        set("pair.helix_angle", format!("{helix} deg"));
    }
    for (gear, (teeth, shift)) in
        ["driver", "driven"].into_iter().zip(teeth.into_iter().zip(shifts))
    {
        set(&format!("{gear}.teeth"), teeth.to_string());
        set(&format!("{gear}.profile_shift"), shift.to_string());
        if is_short {
            set(&format!("{gear}.addendum"), "0.8".to_owned());
        }
        set(&format!("{gear}.face_width"), format!("{width} mm"));
    }
    set("operation.torque", format!("{torque} N m"));
    set("operation.speed", format!("{} rad/s", 10.0 / (0.5e-3 * diameter)));
    let base_pitch = 8.0 + 0.6 * (module + 0.4 * diameter.sqrt());
    set("deviations.base_pitch", format!("{base_pitch} um"));
    case.inputs().unwrap_or_else(|problems| panic!("{module} mm, {teeth:?}: {}", problems[0]))
}

fn measured(pair: &Pair) -> Trade {
    let found = trade(&inputs(pair), STEADY, &|| true, &mut |_| ());
    found.unwrap_or_else(|refusal| panic!("{pair:?}: {refusal}"))
}

/// Median and greatest; the number of values.
fn median(mut values: Vec<f64>) -> Option<(f64, f64, usize)> {
    values.sort_by(f64::total_cmp);
    Some((*values.get(values.len() / 2)?, *values.last()?, values.len()))
}

/// Median time and median / greatest errors in %, over the pairs that the setting solves.
fn row(setting: &Setting, trades: &[Trade], subjects: [(&str, Subject); 3]) -> Option<String> {
    let measured = || {
        let all = trades.iter().flat_map(|trade| &trade.settings);
        all.filter(|one| one.setting == *setting)
    };
    let figures = || measured().filter_map(|one| one.found.as_ref().ok());
    let (seconds, _, count) = median(figures().map(|found| found.time.seconds).collect())?;
    let error = |errors: Vec<f64>| {
        let of = |(median, most, _)| format!("{} / {} %", percent(median), percent(most));
        median(errors).map_or_else(|| "-".to_owned(), of)
    };
    let of_subject =
        |subject| error(figures().filter_map(|found| found.total[subject as usize]).collect());
    let errors = subjects.map(|(_, subject)| of_subject(subject)).join(" | ");
    let greatest = error(measured().filter_map(MeasuredSetting::total).collect());
    Some(format!("| {setting} | {count} | {} | {errors} | {greatest} |", duration(seconds)))
}

/// The settings at their median time and error, with a ring around the default.
fn marks(name: &str, settings: &[Setting], trades: &[Trade]) -> Series {
    let point = |setting: &Setting| {
        let all = || {
            trades.iter().flat_map(|trade| &trade.settings).filter(|one| one.setting == *setting)
        };
        let (error, ..) = median(all().filter_map(MeasuredSetting::total).collect())?;
        let solved = all().filter(|one| one.found.is_ok());
        let (seconds, ..) = median(solved.map(MeasuredSetting::seconds).collect())?;
        Some((seconds.log10(), plotted_error(error).log10()))
    };
    let is_usual = |setting: &Setting| {
        setting.slices.is_none()
            && setting.models == Setting::usual(setting.method, &inputs(&SPUR[10])).models
    };
    Series {
        name: name.to_owned(),
        kind: Kind::Marks(settings.iter().position(is_usual)),
        pieces: vec![settings.iter().filter_map(point).collect()],
    }
}

/// Total error against time: a mark per setting.
fn picture(series: Vec<Series>) -> String {
    let axis = |name: &str, of: fn(&Point) -> f64, label: fn(f64) -> String| {
        let points = series.iter().flat_map(|series| series.pieces.iter().flatten());
        Axis::logarithmic(name, points.map(of), label)
    };
    let chart = Chart {
        title: "Error against time: medians over 18 spur and 10 helical pairs".to_owned(),
        across: axis("time of a whole solve", |point| point.0, power_of_time),
        up: axis("greatest error", |point| point.1, |error| format!("{} %", percent(error))),
        series,
        ..Chart::default()
    };
    svg::draw(&chart, "")
}
