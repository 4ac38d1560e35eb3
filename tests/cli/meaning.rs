//! A result, a verdict or a hint has one meaning in a method, and the text says so where another
//! method differs.
use crate::program::{has, in_a_line, json, page, prints, ran};
use serde_json::Value;
use tipstrike::case::fields::{Kind, index_of};
use tipstrike::case::{Acting, Case, EXAMPLES, FIELDS, partial_relevance, relevance};
use tipstrike::model::{self, Quantity, Solution, Stage, Stages};
use tipstrike::report::{shown, value};

const METHODS: [&str; 5] = ["paper", "exact", "static", "dynamic", "auto"];

/// The error line of a refusing command, and its exit code.
fn refused(line: &str) -> (i32, String) {
    let (code, _, errors) = ran(line);
    assert_eq!(errors.lines().count(), 1, "{errors}");
    (code, errors.trim_end().to_owned())
}

/// The page of a command with reliefs by a method, without line ends.
fn relieved(method: &str, command: &str) -> String {
    in_a_line(&page(&format!(
        "{command} --method {method} --set 'driven.tip_relief=10 um' --set 'driver.root_relief=5 um'"
    )))
}

#[test]
fn the_reliefs_are_printed_by_every_method_and_mean_the_same() {
    for (method, row) in [
        ("paper", "Δf equivalent error 12.021 um"),
        ("exact", "Δf equivalent error 7.6274 um"),
        ("static", "Δf_0 error without reliefs 22.627 um"),
        ("dynamic", "Δf_0 error without reliefs 22.627 um"),
        ("auto", ""),
    ] {
        let page = relieved(method, "solve TABLE_1");
        has(&page, &["e_m modification at entry -15.000 um Eq. 1", row]);
    }
    let of = |method: &str| -> Value {
        let command = "solve TABLE_1 --only equivalent_error --format json --method";
        json(&format!("{command} {method}"))["quantities"]["equivalent_error"]["of"].clone()
    };
    assert_eq!((of("exact"), of("static")), (Value::Null, "deviations-without-reliefs".into()));
    let page = relieved("static", "explain equivalent_error");
    has(&page, &["Δf_0 = 2 f_pb/√2"]);
    assert!(page.contains("Methods: ") == page.contains("paper 22.6"), "{page}");
    assert!(!page.contains("exact 7.6"), "the page has two definitions: {page}");
    has(&relieved("static", "explain total_deviation"), &["Δ = Δf_0 + e_m + δ"]);
}

/// Sentences that only some methods have.
#[test]
fn an_explanation_and_a_note_describe_their_method() {
    let given = "the deflection of 24.70 um is given: power and torque change only F_0";
    for (command, sentence, methods) in [
        ("explain total_deviation", "Above 0 the tip strikes before E", &["exact"][..]),
        ("explain equivalent_error", "Relief reduces it by its full amount", &["exact"]),
        // The deflection is given, but static and dynamic compute it.
        ("explain mesh_force", "It deflects the teeth", &["static", "dynamic"]),
        ("solve TABLE_1", given, &["paper", "exact"]),
        ("solve TABLE_1 --set model.deflection=", "is given", &[]),
    ] {
        for method in &METHODS[..4] {
            let page = relieved(method, command);
            assert_eq!(page.contains(sentence), methods.contains(method), "{command} {method}");
        }
    }
}

#[test]
fn a_limit_on_an_absent_value_is_not_met_and_has_a_reason() {
    let limit = "--set 'limits.peak_force=1.3 x nominal'";
    let (code, page, _) = ran(&format!("check TABLE_1 {limit}"));
    has(
        &page,
        &[
            "unknown cases/zhou-chen-2014.toml: peak force F_max has no value (limit 1.3 x nominal (mesh_force) = 1981.6 N): ",
            "method exact does not compute this quantity; static, dynamic and auto do",
        ],
    );
    // Without corner contact, a limit on the impact is met, and one on the motion is unknown.
    let relieved = "check TABLE_1 --set 'driven.tip_relief=80 um'";
    assert_eq!((code, ran(relieved).0, ran(&format!("{relieved} {limit}")).0), (1, 0, 1));
    for (method, standing) in [("static", "ok"), ("dynamic", "EXCEEDED")] {
        let (_, page, _) = ran(&format!("check TABLE_1 {limit} --method {method}"));
        has(&page, &[&format!("{standing} cases/zhou-chen-2014.toml: peak force F_max ")]);
    }
}

#[test]
fn a_verdict_names_what_to_limit_for_the_force_of_the_method() {
    let limit = "check TABLE_1 --method dynamic --set 'limits.impact_force=2.1 kN'";
    let (_, page, _) = ran(limit);
    let own = " for the free impact. Method dynamic computes F_d,DE (peak before E) = 1410.8 N. \
            F_d,DE has no limit\n";
    assert!(page.ends_with(own), "{page}");
    let line = json(&format!("{limit} --format json"));
    assert_eq!((&line["standing"], &line["of"]), (&"within".into(), &"free-impact".into()));
    assert_eq!(line["own"]["quantity"], "dynamic_peak_approach_force");
    assert!((line["own"]["value"].as_f64().unwrap() - 1410.76).abs() < 0.1);
    let (_, both, _) = ran(&format!("{limit} --set 'limits.dynamic_peak_approach_force=1400 N'"));
    has(&both, &["EXCEEDED cases/zhou-chen-2014.toml: dynamic: peak before E F_d,DE 1410.8 N > "]);
    assert!(!both.contains("has no limit"), "{both}");
}

/// Wrong command lines with the start and the end of their only line.
#[test]
fn a_refusal_names_the_command_line_and_offers_a_fix_in_one_line() {
    let place = "cases/zhou-chen-2014.toml";
    let set = |text: &str| format!("solve TABLE_1 --set '{text}'");
    for (line, exit, start, end) in [
        (
            set("operation.power=15"),
            2,
            "error: --set operation.power=15: ",
            "write \"15 kW\" or \"15 W\"",
        ),
        (
            set("deviations.base_pitch=48 mu"),
            2,
            "error: ",
            "did you mean um? Units here: mm, um, m, cm, nm, in, thou, ft",
        ),
        (
            set("pair.centre_distance=200 mm"),
            3,
            ", --set pair.centre_distance=200 mm: the tips do not reach each other",
            "",
        ),
        // The line of the file belongs to another field, which contradicts the set one.
        (set("driver.teeth=5"), 3, ":", "(with --set driver.teeth=5)"),
        (
            set("operation.power=15 kW' --set 'operation.torque=70 N m"),
            2,
            "error: --set operation.torque=70 N m: --set operation.power excludes this field: ",
            "remove one of the two --set options",
        ),
        (
            "slove TABLE_1".into(),
            2,
            "error: slove: there is no such command: did you mean solve?",
            "",
        ),
        (
            "improve TABLE_1".into(),
            2,
            "error: improve: there is no such command: `tipstrike help` lists the commands",
            "",
        ),
        (
            "solve TABLE_1 --only impact_force,".into(),
            2,
            "error: --only: no quantity is named: write names with commas between them",
            "such as impact_force,contact_ratio",
        ),
    ] {
        let (code, found) = refused(&line);
        let start = if code == 3 { format!("{place}{start}") } else { start.to_owned() };
        assert!(code == exit && found.starts_with(&start) && found.ends_with(end), "{line} {code}");
    }
    for command in ["solve TABLE_1 --only", "explain --method exact"] {
        for (name, end) in [
            ("f_s", "unknown quantity `f_s`: did you mean F_S, impact_force?"),
            ("impact_forces", "did you mean impact_force?"),
            ("exit_force", " or static_exit_line_load or dynamic_exit_line_load?"),
            ("exit_outcome", "`seek` takes exit_outcome=no-corner-contact"),
            ("'impact_force normal_velocity'", "put commas between names"),
            ("colour", "`tipstrike fields --results` lists every quantity"),
        ] {
            let (code, found) = refused(&format!("{command} {name}"));
            assert!(code == 2 && found.ends_with(end), "{command} {name}: {found}");
        }
    }
    has(&ran("solve TABLE_1 --stations -1").2, &["`-1` is below the limit of 1"]);
}

#[test]
fn the_printed_equations_have_a_note_on_their_error() {
    // Notes that are true of almost every case are in JSON and in `explain` alone.
    let open = "the printed equations leave the gap open: at D the tip has closed 0.0";
    let options = "--format json --only f,κ,E_k --method";
    prints(&[
        (&format!("solve TABLE_1 {options} paper"), &[open]),
        (&format!("solve TABLE_1 {options} exact"), &["!the gap open: at D"]),
        ("solve TABLE_1 --method paper", &["!leave the gap open"]),
        (
            &format!("solve cases/mill-coarse-slow.toml {options} paper"),
            &["Eq. 32 describes two spheres", "!lacks Hertz"],
        ),
        (
            &format!("solve cases/turbo-fine-fast.toml {options} paper"),
            &["the friction ratio is not computed: the triangle of Eq. 34 does not close"],
        ),
        // 60 um of relief count as 42 um as printed: only by the printed equations the tooth strikes.
        (
            "solve TABLE_1 --method paper --set 'driven.tip_relief=60 um'",
            &[
                "exact finds no corner contact; paper governs: the case selects it. Method exact: no \
                 corner contact, Δ = -12.673 um.",
                " um more tip relief on the driven gear (",
            ],
        ),
    ]);
}

/// The most important results of a method.
fn headlines(solution: &Solution) -> Vec<String> {
    let keys: &[&str] = match solution.method.name() {
        "static" => &[
            "static_force_at_start",
            "static_peak_force",
            "static_first_contact_angle",
            "static_transmission_error",
            "contact_ratio",
        ],
        "dynamic" => {
            &["dynamic_peak_approach_force", "dynamic_peak_force", "dynamic_first_contact_angle"]
        }
        _ => &[
            "impact_force",
            "impact_duration",
            "approach_angle_driven",
            "friction_ratio",
            "normal_velocity",
        ],
    };
    let printed = |key: &&str| {
        let quantity = Quantity::find(key).unwrap();
        value(quantity, solution)
            .map_or_else(|| "none".to_owned(), |value| shown(quantity, value).to_string())
    };
    std::iter::once(solution.outcome.name().to_owned()).chain(keys.iter().map(printed)).collect()
}

/// Every number of every case without an effect on the most important results has a reason in each
/// method.
#[test]
fn a_field_without_effect_has_a_reason() {
    let mut silent = Vec::new();
    for (method, example) in METHODS[..4]
        .iter()
        .flat_map(|method| EXAMPLES.iter().take(3).map(move |example| (method, example)))
    {
        let mut case = example.document().case;
        case.set("model.method", method).unwrap();
        let inputs = case.inputs().unwrap();
        let solve = |case: &Case| {
            let inputs = case.inputs().ok()?;
            let slow = [Stage::Clearing, Stage::SpeedRun, Stage::SteadyMotion, Stage::Band];
            let stages = slow.into_iter().fold(inputs.method.stages(), Stages::without);
            model::solve(&inputs, stages).ok()
        };
        let Some(before) = solve(&case) else { continue };
        for (index, field) in FIELDS.iter().enumerate() {
            let Kind::Number(..) = field.kind else { continue };
            let (Some(now), Some(text)) = (case.value(index), case.effective(index)) else {
                continue;
            };
            if relevance(index, &inputs) != Acting::Yes
                || partial_relevance(index, &inputs).is_some()
                || now == 0.0
            {
                continue;
            }
            let unit = text.split_once(' ').map_or("", |(_, unit)| unit);
            let more = now * 1.1 / tipstrike::case::units::factor(unit).unwrap();
            let mut changed = case.clone();
            let is_silent = changed.set(field.key, format!("{more} {unit}").trim()).is_ok()
                && solve(&changed).is_some_and(|after| headlines(&after) == headlines(&before));
            if is_silent {
                silent.push(format!("{} of {} at {method}", field.key, example.name));
            }
        }
    }
    assert_eq!(silent, [""; 0], "these fields have no effect and no reason");
    assert!(index_of("operation.power").is_some_and(|power| {
        partial_relevance(power, &Case::table_1().inputs().unwrap())
            .is_some_and(|why| why.contains("with the deflection given"))
    }));
}

#[test]
fn auto_computes_what_a_limit_or_a_selected_quantity_needs_besides_its_choice() {
    // Inertia changes the load of this slow pair by less than 1 %.
    let mill = "cases/mill-coarse-slow.toml --method auto";
    has(&ran(&format!("solve {mill}")).1, &["auto chose static"]);
    for quantity in ["peak_force_ratio", "static_te_peak_to_peak", "peak_force"] {
        let report = json(&format!("solve {mill} --format json --only {quantity}"));
        assert_eq!(report["method"], "static");
        assert!(report["quantities"][quantity]["value"].is_number(), "{report}");
    }
    let (_, text, _) = ran(&format!("check {mill} --set 'limits.dynamic_peak_force=1 MN'"));
    has(&text, &["ok cases/mill-coarse-slow.toml: dynamic: peak force F_d,max"]);
    let (_, rows, _) = ran(&format!(
        "sweep {mill} --vary 'driven.tip_relief=0..10 um' --points 2 --only dynamic_peak_force"
    ));
    let has_value = |row: &str| row.split(',').all(|cell| !cell.is_empty());
    assert!(rows.lines().skip(1).all(has_value), "{rows}");
}
