//! Studies compared with plain solves: every row equals a plain solve, for any number of threads.

use tipstrike::case::spread::Shape;
use tipstrike::case::{Case, Spread};
use tipstrike::model::inputs::Method;
use tipstrike::model::{Inputs, QUANTITIES, Quantity, Refusal, Stage, Stages, solve};
use tipstrike::study::axis::{AxisRange, Grid, Sampling};
use tipstrike::study::batch::{Batch, Control, PointOutcome, Points, Row, solve_all};
use tipstrike::study::seek::{Condition, Found, State, seek};
use tipstrike::study::statistics::{Estimate, Indices, Ranked, indices};
use tipstrike::study::tolerance::{Design, Distribution, Member, Samples, Size, Tolerance};

/// Every quantity except the required relief and the peaks over the speed, which are slow.
fn quick_quantities() -> Vec<&'static Quantity> {
    let slow = [Stage::Clearing, Stage::SpeedRun];
    let is_quick = |quantity: &&Quantity| !slow.contains(&quantity.stage);
    QUANTITIES.iter().filter(is_quick).collect()
}

fn grid(texts: &[&str], points: usize) -> Grid {
    let texts: Vec<String> = texts.iter().map(|text| (*text).to_owned()).collect();
    Grid::parse(&texts, &[points], false).unwrap()
}

fn solved(inputs: &Inputs, grid: &Grid, jobs: usize, quantities: &[&'static Quantity]) -> Vec<Row> {
    let batch = Batch { inputs, points: grid, quantities };
    let control = Control { jobs: Some(jobs), ..Control::PLAIN };
    let mut all = Vec::new();
    let solved = solve_all(&batch, 0..grid.count(), &control, &mut |first, rows| {
        assert_eq!(first, all.len());
        all.extend_from_slice(rows);
        true
    });
    solved.unwrap();
    all
}

/// The outcome and the values of a plain solve of the case with the settings of a point.
fn plain(
    case: &Case,
    grid: &Grid,
    index: usize,
    quantities: &[&'static Quantity],
) -> (PointOutcome, Vec<Option<u64>>) {
    let mut case = case.clone();
    for (axis, at) in grid.places(index) {
        case.set(axis.key(), &axis.with_unit(at)).unwrap();
    }
    let wanted = |method: Method| {
        let stages = quantities.iter().map(|quantity| Stages::of(quantity.stage));
        stages.fold(method.deciding_stages(), Stages::and)
    };
    let solution = case.inputs().ok();
    let solution = solution.and_then(|inputs| solve(&inputs, wanted(inputs.method)).ok());
    match solution.filter(|solution| solution.withheld.is_none()) {
        Some(solution) => {
            let values = quantities.iter().map(|quantity| quantity.finite_value(&solution));
            let bits = values.map(|value| value.map(f64::to_bits)).collect();
            (PointOutcome::Solved(solution.outcome), bits)
        }
        None => (PointOutcome::Refused, vec![None; quantities.len()]),
    }
}

fn bits(row: &Row) -> Vec<Option<u64>> {
    row.values.iter().map(|value| value.map(f64::to_bits)).collect()
}

#[test]
fn every_row_of_a_sweep_is_a_plain_solve_to_the_last_bit() {
    let mut case = Case::table_1();
    case.set("model.deflection", "").unwrap();
    let quantities = quick_quantities();
    let grids: [&[&str]; 5] = [
        &["operation.speed=50..9000 rpm"],
        &["driven.tip_relief=0..70 um", "operation.power=1,15 kW"],
        &["pair.module=4..6 mm", "deviations.base_pitch=-10..40 um"],
        &["driver.bore_radius=10..50 mm", "driver.profile_shift=-0.2,0.3"],
        &["operation.torque=5..300 N m", "model.damping_ratio=0.02,0.1"],
    ];
    for method in Method::ALL {
        case.set("model.method", method.name()).unwrap();
        let inputs = case.inputs().unwrap();
        for texts in grids {
            let grid = grid(texts, 4);
            let rows = solved(&inputs, &grid, 1, &quantities);
            for (index, row) in rows.iter().enumerate() {
                let plain = plain(&case, &grid, index, &quantities);
                let place = format!("{} at {}", method.name(), grid.point(index));
                assert_eq!((row.outcome, bits(row)), plain, "{place}");
            }
        }
    }
}

#[test]
fn the_user_or_the_reader_can_stop_a_study() {
    let inputs = Case::table_1().inputs().unwrap();
    let grid = grid(&["operation.speed=1..9000 rpm"], 100_000);
    let batch = Batch { inputs: &inputs, points: &grid, quantities: &[] };
    let mut rows = 0;
    let by_reader = solve_all(&batch, 0..grid.count(), &Control::PLAIN, &mut |_, arrived| {
        rows += arrived.len();
        false
    });
    assert_eq!(by_reader, Err(Refusal::Stopped));
    assert!(0 < rows && rows < grid.count());
    let control = Control { go_on: &|_, _| false, ..Control::PLAIN };
    let by_user = solve_all(&batch, 0..grid.count(), &control, &mut |_, _| true);
    assert_eq!(by_user, Err(Refusal::Stopped));
}

fn sought(inputs: &Inputs, range: &str, condition: &str) -> Found {
    let range = AxisRange::parse(range).unwrap();
    let condition = Condition::parse(condition).unwrap();
    let scan = range.axis(Sampling { points: Some(41), is_log: false }).unwrap();
    seek(inputs, &range, &condition, &scan, &Control::PLAIN).unwrap()
}

#[test]
fn a_crossing_is_located_to_1e_9_and_agrees_with_plain_solves() {
    let case = Case::table_1();
    let found =
        sought(&case.inputs().unwrap(), "deviations.base_pitch=0..40 um", "impact_force<=2000 N");
    let crossings = found.crossings();
    let [[lower, upper]] = crossings[..] else { panic!("one crossing: {crossings:?}") };
    assert_eq!((&lower.state, &upper.state), (&State::Met, &State::NotMet));
    assert!(upper.at - lower.at <= 1e-9 * upper.at && lower.at < upper.at);
    for sample in [lower, upper] {
        let mut case = case.clone();
        case.set("deviations.base_pitch", &format!("{} um", sample.at)).unwrap();
        let solution = solve(&case.inputs().unwrap(), Stages::of(Stage::Impact)).unwrap();
        let force = solution.impact.unwrap().force;
        assert_eq!(Some(force.to_bits()), sample.value.map(f64::to_bits));
    }
}

#[test]
fn never_always_and_unknown_are_answers_of_a_search() {
    let inputs = Case::table_1().inputs().unwrap();
    let states = |range, condition| {
        let found = sought(&inputs, range, condition);
        let segments = found.segments().into_iter();
        segments.map(|[first, _]| first.state.clone()).collect::<Vec<_>>()
    };
    let relief = "driven.tip_relief=0..20 um";
    assert_eq!(states(relief, "impact_force<=9 kN"), [State::Met]);
    assert_eq!(states(relief, "impact_force<=9 N"), [State::NotMet]);
    assert_eq!(states(relief, "outcome=no-corner-contact"), [State::NotMet]);
    // Without contact there is no force, and hence none above or below a limit.
    let beyond = "driven.tip_relief=60..90 um";
    assert_eq!(states(beyond, "impact_force<=9 N"), [State::Met]);
    assert_eq!(states(beyond, "impact_force>9 N"), [State::NotMet]);
    let bore = states("driver.bore_radius=45..60 mm", "impact_force<=9 kN");
    assert!(matches!(bore[..], [State::Unknown(_)]), "{bore:?}");
}

#[test]
fn the_end_of_contact_is_where_the_deviation_vanishes() {
    let inputs = Case::table_1().inputs().unwrap();
    let found = sought(&inputs, "driven.tip_relief=0..90 um", "outcome=no-corner-contact");
    let solution = solve(&inputs, Stages::of(Stage::Deviation)).unwrap();
    let end = solution.deviation.total * 1e6;
    let crossings = found.crossings();
    assert_eq!(crossings.len(), 1);
    assert!((crossings[0][1].at / end - 1.0).abs() < 1e-9);
}

#[test]
fn every_crossing_is_found_although_the_quantity_turns_back_between_points_of_the_scan() {
    // The dynamic peak has a narrow resonance at 3312 rpm.
    let mut case = Case::table_1();
    case.set("model.method", "dynamic").unwrap();
    case.set("model.warmup_cycles", "3").unwrap();
    let inputs = case.inputs().unwrap();
    let grid = grid(&["operation.speed=3000..3600 rpm"], 401);
    let quantities = [Quantity::find("dynamic_peak_force").unwrap()];
    let rows = solved(&inputs, &grid, 2, &quantities);
    let most = rows.iter().filter_map(|row| row.values[0]).fold(0.0, f64::max);
    let limit = 0.999_99 * most;
    let until = format!("dynamic_peak_force<={limit} N");
    let found = sought(&inputs, "operation.speed=3000..3600 rpm", &until);
    let count = found.crossings().len();
    assert!(count == 2, "{count} of {most} N");
}

/// A design with uniform fields between -pi and pi, for the test functions of the literature.
fn uniform_design(fields: usize, samples: usize) -> Design {
    let distribution = Distribution {
        field: 0,
        range: (0.0, 0.0),
        centre: 0.0,
        width: std::f64::consts::PI,
        shape: Shape::Uniform,
    };
    Design { seed: 7, distributions: vec![distribution; fields], samples, ranked: samples }
}

fn ranked(design: &Design, function: impl Fn(&[f64]) -> f64) -> Vec<Indices> {
    let value = |member| {
        let values = design.values(design.index(member));
        function(&values)
    };
    let fields = design.distributions.len();
    let samples: Vec<Ranked> = (0..design.ranked)
        .map(|number| Ranked {
            first: value(Member::Sample(number)),
            second: value(Member::Second(number)),
            swapped: (0..fields).map(|field| value(Member::Swapped(number, field))).collect(),
        })
        .collect();
    indices(&samples).unwrap()
}

fn assert_within(estimate: Estimate, exact: f64, name: &str) {
    // Twice the 95 % interval: almost four standard errors.
    let half = estimate.to - estimate.from;
    assert!(half < 0.1, "{name}: {estimate:?}");
    assert!((estimate.value - exact).abs() <= half, "{name}: {estimate:?}, exact {exact}");
}

#[test]
fn the_indices_of_the_ishigami_function_are_those_of_the_literature() {
    let function =
        |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
    let found = ranked(&uniform_design(3, 16_384), function);
    for (field, (first, total)) in
        [(0.3139, 0.5576), (0.4424, 0.4424), (0.0, 0.2437)].into_iter().enumerate()
    {
        assert_within(found[field].first_order, first, "first-order");
        assert_within(found[field].total, total, "total");
    }
}

#[test]
fn the_indices_of_a_linear_model_are_the_squares_of_its_factors() {
    let factors = [1.0, 2.0, 0.5, 0.0];
    let function = |x: &[f64]| x.iter().zip(factors).map(|(x, a)| a * x).sum::<f64>();
    let whole: f64 = factors.iter().map(|a| a * a).sum();
    for (found, factor) in ranked(&uniform_design(4, 8192), function).iter().zip(factors) {
        assert_within(found.first_order, factor * factor / whole, "first-order");
        assert_within(found.total, factor * factor / whole, "total");
    }
    assert_eq!(indices(&[Ranked { first: 1.0, second: 1.0, swapped: vec![1.0] }]), None);
}

fn spread_case(lines: &[(&str, &str, &str)]) -> Case {
    let mut case = Case::table_1();
    case.set("model.deflection", "").unwrap();
    for (field, shape, width) in lines {
        case.spread.push(Spread::new(field, &format!("{shape} {width}")).unwrap());
    }
    case
}

fn toleranced(case: &Case, samples: usize, seed: u64, jobs: usize) -> (Tolerance, Samples) {
    let inputs = case.inputs().unwrap();
    let size = Size { samples, seed, ranked: Some(samples / 4) };
    let study = Tolerance::of(case, &inputs, &[], size).unwrap();
    let control = Control { jobs: Some(jobs), ..Control::PLAIN };
    let found = study.run(&inputs, &control).unwrap();
    (study, found)
}

#[test]
fn the_percentiles_of_a_monotone_case_are_those_of_the_transformed_distribution() {
    let case = spread_case(&[("deviations.base_pitch", "normal", "2 um")]);
    let (study, samples) = toleranced(&case, 4000, 3, 2);
    let summary = study.summary(&samples);
    let of = &summary.quantities[0];
    assert_eq!(of.quantity.key, "impact_force");
    let figures = of.figures.as_ref().unwrap();
    for (part, found) in [0.05, 0.5, 0.95].into_iter().zip(figures.percentiles) {
        let mut inputs = case.inputs().unwrap();
        let distribution = &study.design.distributions[0];
        distribution.put(distribution.quantile(part), &mut inputs);
        let exact = solve(&inputs, Stages::of(Stage::Impact)).unwrap().impact.unwrap().force;
        let (from, to) = found.interval.unwrap();
        assert!(to / from < 1.03);
        assert!((found.value - exact).abs() < to - from, "{part}: {found:?}, {exact}");
    }
}

#[test]
fn a_sample_depends_on_seed_and_number_alone() {
    let case = spread_case(&[
        ("deviations.base_pitch", "truncated", "9 um"),
        ("operation.power", "uniform", "3 kW"),
        ("driven.young", "triangular", "9 GPa"),
    ]);
    let (study, one) = toleranced(&case, 600, 7, 1);
    let (_, three) = toleranced(&case, 600, 7, 3);
    let (longer, more) = toleranced(&case, 900, 7, 2);
    let (_, other) = toleranced(&case, 600, 8, 2);
    let bits = |samples: &Samples, at| samples.value(0, at).map(f64::to_bits);
    for at in 0..study.design.count() {
        assert_eq!(bits(&one, at), bits(&three, at));
        let same = longer.design.index(study.design.member(at));
        assert_eq!(bits(&one, at), bits(&more, same));
    }
    assert_ne!(bits(&one, 0), bits(&other, 0));
}

#[test]
fn every_sample_is_a_plain_solve_of_its_settings() {
    let case = spread_case(&[
        ("deviations.base_pitch", "grade", "7"),
        ("operation.speed", "uniform", "100 rpm"),
        ("driver.profile_shift", "normal", "0.01"),
    ]);
    let (study, samples) = toleranced(&case, 40, 1, 2);
    for index in 0..study.design.count() {
        let mut case = case.clone();
        for setting in study.design.point(index).split(", ") {
            let (key, value) = setting.split_once(" = ").unwrap();
            case.set(key, value).unwrap();
        }
        let force = solve(&case.inputs().unwrap(), Stages::of(Stage::Impact)).unwrap();
        let force = force.impact.map(|impact| impact.force.to_bits());
        assert_eq!(force, samples.value(0, index).map(f64::to_bits), "{index}");
    }
}

#[test]
fn probabilities_count_contact_and_limits_and_leave_refused_samples_out() {
    let mut case = spread_case(&[("driven.tip_relief", "uniform", "20 um")]);
    case.set("driven.tip_relief", "48 um").unwrap();
    case.set("model.deflection", "24.7 um").unwrap();
    case.set_limit("impact_force", "500 N").unwrap();
    let (study, samples) = toleranced(&case, 3000, 1, 2);
    let summary = study.summary(&samples);
    let found = summary.contact.unwrap();
    // Contact ends at a relief of 47.33 um of 28 to 68 um.
    assert_within(found, 0.4832, "contact");
    let limit = &summary.limits[0];
    assert_eq!((limit.known, summary.solved), (3000, 3000));
    assert!(limit.probability.unwrap().value < found.value);
    assert!(summary.quantities[0].figures.as_ref().unwrap().count < 3000);
    // A bore beyond the root circle of 43.75 mm is refused; every other sample strikes.
    let mut case = spread_case(&[("driver.bore_radius", "uniform", "1 mm")]);
    case.set("driver.bore_radius", "43.5 mm").unwrap();
    let (study, samples) = toleranced(&case, 200, 1, 2);
    let summary = study.summary(&samples);
    assert!((20..180).contains(&summary.solved), "{}", summary.solved);
    assert_eq!(summary.limits[0].known, summary.solved);
    assert_eq!(summary.contact.unwrap().value.to_bits(), 1f64.to_bits());
}

/// The power varies by 10 %: a limit on the force that follows the mesh force is exceeded by all
/// samples or by none.
#[test]
fn a_relative_limit_follows_the_result_of_each_sample() {
    let exceeded = |limit: &str| {
        let mut case = spread_case(&[("operation.power", "uniform", "1.5 kW")]);
        case.set("model.deflection", "24.7 um").unwrap();
        case.set_limit("mesh_force", limit).unwrap();
        let (study, samples) = toleranced(&case, 200, 1, 2);
        let summary = study.summary(&samples);
        let mut limits = summary.limits.iter();
        let of = limits.find(|limit| limit.limit.quantity.key == "mesh_force").unwrap();
        assert_eq!(of.known, 200);
        of.probability.unwrap().value
    };
    let [below, above] = ["0.99 x nominal", "1.01 x nominal"].map(exceeded);
    assert_eq!([below, above].map(f64::to_bits), [1.0f64, 0.0].map(f64::to_bits));
    assert!((0.2..0.8).contains(&exceeded("1524 N")));
}
