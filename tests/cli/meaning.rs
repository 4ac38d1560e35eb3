//! A result, a verdict or a hint has one meaning in a method, and the text says so where another
//! method differs.
use crate::program::{has, output as run, run as texts_of, words};
use serde_json::Value;
use tipstrike::case::fields::{Kind, index_of};
use tipstrike::case::{Acting, Case, EXAMPLES, FIELDS, partial_relevance, relevance};
use tipstrike::model::{self, Quantity, Solution};
use tipstrike::report::{shown, value};

const TABLE_1: &str = "cases/zhou-chen-2014.toml";
const METHODS: [&str; 5] = ["paper", "exact", "static", "dynamic", "auto"];

fn stdout_of(arguments: &[&str]) -> String {
    texts_of(arguments).1
}

/// The error line of a refusing command, and its exit code.
fn refused(arguments: &[&str]) -> (i32, String) {
    let (code, _, line) = texts_of(arguments);
    assert_eq!(line.lines().count(), 1, "{line}");
    (code, line.trim_end().to_owned())
}

/// The text of a solve of Table 1 with reliefs, without line ends.
fn relieved(method: &str, command: &[&str]) -> String {
    let reliefs = [
        "--method",
        method,
        "--set",
        "driven.tip_relief=10 um",
        "--set",
        "driver.root_relief=5 um",
    ];
    stdout_of(&[command, &reliefs].concat()).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_modification_is_printed_by_every_method_and_means_the_same() {
    for method in METHODS {
        let page = relieved(method, &["solve", TABLE_1]);
        assert!(page.contains("e_m modification at entry -15.000 um Eq. 1"), "{method}: {page}");
    }
}

#[test]
fn an_equivalent_error_without_the_reliefs_is_named_so() {
    for (method, row) in [
        ("paper", "Δf equivalent error 12.021 um"),
        ("exact", "Δf equivalent error 7.6274 um"),
        ("static", "Δf_0 error without reliefs 22.627 um"),
        ("dynamic", "Δf_0 error without reliefs 22.627 um"),
    ] {
        let page = relieved(method, &["solve", TABLE_1]);
        assert!(page.contains(row), "{method}: {page}");
    }
    let of = |method| -> Value {
        let line = stdout_of(&words(&format!(
            "solve {TABLE_1} --method {method} --only equivalent_error --format json"
        )));
        serde_json::from_str::<Value>(&line).unwrap()["quantities"]["equivalent_error"]["of"]
            .clone()
    };
    assert_eq!((of("exact"), of("static")), (Value::Null, "deviations-without-reliefs".into()));
    let page = relieved("static", &["explain", "equivalent_error"]);
    assert!(page.contains("Δf_0 = 2 f_pb/√2"), "{page}");
    assert!(page.contains("Methods: ") == page.contains("paper 22.6"), "{page}");
    assert!(!page.contains("exact 7.6"), "the page has two definitions: {page}");
    let page = relieved("static", &["explain", "total_deviation"]);
    assert!(page.contains("Δ = Δf_0 + e_m + δ"), "{page}");
}

#[test]
fn an_explanation_describes_its_method() {
    let strikes = "Above 0 the tip strikes before E";
    for (method, holds) in
        [("paper", false), ("exact", true), ("static", false), ("dynamic", false), ("auto", false)]
    {
        assert_eq!(
            relieved(method, &["explain", "total_deviation"]).contains(strikes),
            holds,
            "{method}"
        );
    }
    let in_full = "Relief reduces it by its full amount";
    for (method, holds) in [("paper", false), ("exact", true), ("static", false)] {
        assert_eq!(
            relieved(method, &["explain", "equivalent_error"]).contains(in_full),
            holds,
            "{method}"
        );
    }
    let deflects = "It deflects the teeth";
    assert!(
        !relieved("exact", &["explain", "mesh_force"]).contains(deflects),
        "the deflection is given"
    );
    assert!(relieved("static", &["explain", "mesh_force"]).contains(deflects));
}

#[test]
fn a_limit_on_an_absent_value_is_not_met_and_has_a_reason() {
    let output = run(&["check", TABLE_1, "--set", "limits.dynamic_peak_force=2 kN"]);
    let page = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1));
    has(
        &page,
        &["unknown cases/zhou-chen-2014.toml: dynamic_peak_force has no value (limit 2 kN): "],
    );
    has(&page, &["method exact does not compute this quantity; dynamic and auto do"]);
    // Without corner contact, a limit on the impact is met, and one on the motion is unknown.
    let relieved = ["check", TABLE_1, "--set", "driven.tip_relief=80 um"];
    assert_eq!(run(&relieved).status.code(), Some(0));
    assert_eq!(
        run(&[&relieved[..], &["--set", "limits.dynamic_peak_force=2 kN"]].concat()).status.code(),
        Some(1)
    );
}

#[test]
fn a_verdict_names_what_to_limit_for_the_force_of_the_method() {
    let limit = ["check", TABLE_1, "--method", "dynamic", "--set", "limits.impact_force=2.1 kN"];
    let page = stdout_of(&limit);
    let own = " for the free impact. Method dynamic: dynamic_peak_approach_force 1410.8 N; this quantity \
            has no limit\n";
    assert!(page.ends_with(own), "{page}");
    let line: Value =
        serde_json::from_str(&stdout_of(&[&limit[..], &["--format", "json"]].concat())).unwrap();
    assert_eq!((&line["standing"], &line["of"]), (&"within".into(), &"free-impact".into()));
    assert_eq!(line["own"]["quantity"], "dynamic_peak_approach_force");
    assert!((line["own"]["value"].as_f64().unwrap() - 1410.76).abs() < 0.1);
    let both =
        stdout_of(&[&limit[..], &["--set", "limits.dynamic_peak_approach_force=1400 N"]].concat());
    has(
        &both,
        &["EXCEEDED cases/zhou-chen-2014.toml: dynamic_peak_approach_force 1410.8 N > 1400 N"],
    );
    assert!(!both.contains("has no limit"), "{both}");
}

#[test]
fn a_hint_offers_the_usual_unit_and_names_the_command_line() {
    let set = |text: &str| refused(&["solve", TABLE_1, "--set", text]);
    let (code, line) = set("operation.power=15");
    assert_eq!((code, line.ends_with("write \"15 kW\" or \"15 W\"")), (2, true), "{line}");
    assert!(line.contains("--set operation.power=15: "), "{line}");
    let (_, line) = set("deviations.base_pitch=48 mu");
    assert!(line.contains("did you mean um?"), "{line}");
    let (code, line) = set("pair.centre_distance=80 mm");
    assert_eq!(code, 3);
    assert!(
        line.starts_with(
            "cases/zhou-chen-2014.toml, --set pair.centre_distance=80 mm: the centre distance jams"
        ),
        "{line}"
    );
    let (_, line) = set("driver.bore_radius=44 mm");
    assert!(
        line.starts_with("cases/zhou-chen-2014.toml, --set driver.bore_radius=44 mm: "),
        "{line}"
    );
    // The line of the file belongs to another field, which contradicts the set one.
    let (_, line) = set("driver.teeth=5");
    assert!(
        line.starts_with("cases/zhou-chen-2014.toml:")
            && line.ends_with("(with --set driver.teeth=5)"),
        "{line}"
    );
}

#[test]
fn a_quantity_is_found_by_its_symbol_and_after_a_slip() {
    for command in [["solve", TABLE_1, "--only"], ["explain", "--method", "exact"]] {
        let asked = |name| refused(&[&command[..], &[name]].concat());
        let (code, line) = asked("f_s");
        assert_eq!(
            (code, line.ends_with("unknown quantity `f_s`: did you mean F_S, impact_force?")),
            (2, true),
            "{line}"
        );
        assert!(asked("impact_forces").1.ends_with("did you mean impact_force?"));
        assert!(asked("impact_force normal_velocity").1.ends_with("put commas between names"));
        assert!(asked("colour").1.ends_with("`tipstrike fields --results` lists every quantity"));
    }
}

#[test]
fn a_contradictory_command_line_is_refused_in_one_line() {
    for (arguments, exit, says) in [
        (&["slove", TABLE_1][..], 2, "error: slove: there is no such command: did you mean solve?"),
        (
            &["improve", TABLE_1],
            2,
            "error: improve: there is no such command: `tipstrike help` lists the commands",
        ),
        (
            &["solve", TABLE_1, "--only", "impact_force,"],
            2,
            "error: --only: no quantity is named: write names with commas between them, such as \
                impact_force",
        ),
        (
            &[
                "solve",
                TABLE_1,
                "--set",
                "operation.power=15 kW",
                "--set",
                "operation.torque=70 N m",
            ],
            2,
            "--set operation.torque=70 N m: --set operation.power excludes this field: remove one \
                of the two --set options",
        ),
        (
            &["solve", TABLE_1, "--set", "driver.young=205000"],
            2,
            "error: --set driver.young=205000: 205000 has no unit",
        ),
        (
            &["solve", TABLE_1, "--set", "pair.centre_distance=200 mm"],
            3,
            "cases/zhou-chen-2014.toml, --set pair.centre_distance=200 mm: the tips do not reach \
                each other",
        ),
    ] {
        let (code, line) = refused(arguments);
        assert!(code == exit && line.starts_with(says), "{arguments:?}: {code} {line}");
    }
    assert!(
        refused(&["solve", TABLE_1, "--set", "driver.young=205000"])
            .1
            .ends_with("write \"205000 MPa\"")
    );
    let negative = run(&["solve", TABLE_1, "--stations", "-1"]);
    assert!(String::from_utf8(negative.stderr).unwrap().contains("`-1` is below the limit of 1"));
}

#[test]
fn the_printed_equations_have_a_note_on_their_error() {
    // Notes that are true of almost every case are in JSON and in `explain` alone.
    let notes = |case: &str, method| {
        stdout_of(&["solve", case, "--method", method, "--format", "json", "--only", "f,κ,E_k"])
    };
    let open = "the printed equations leave the gap open: at D the tip has closed 0.0";
    assert!(notes(TABLE_1, "paper").contains(open) && !notes(TABLE_1, "exact").contains(open));
    assert!(!relieved("paper", &["solve", TABLE_1]).contains("leave the gap open"));
    let page = notes("cases/mill-coarse-slow.toml", "paper");
    assert!(
        page.contains("Eq. 32 describes two spheres") && !page.contains("lacks Hertz"),
        "{page}"
    );
    let page = notes("cases/turbo-fine-fast.toml", "paper");
    has(&page, &["the friction ratio is not computed: the triangle of Eq. 34 does not close"]);
    // 60 um of relief count as 42 um as printed: only by the printed equations the tooth strikes.
    let page =
        stdout_of(&["solve", TABLE_1, "--method", "paper", "--set", "driven.tip_relief=60 um"]);
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    has(
        &page,
        &["exact finds no corner contact; paper governs: the case selects it. Method exact: no \
                corner contact, Δ = -12.673 um."],
    );
    assert!(page.contains(" um more tip relief on the driven gear, "), "{page}");
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
            model::solve(&case.inputs().ok()?, case.inputs().ok()?.method.stages()).ok()
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
fn a_note_reports_that_a_given_deflection_replaces_the_load() {
    let note = "the deflection of 24.70 um is given: power and torque change only F_0";
    for (method, says) in [("paper", true), ("exact", true), ("static", false), ("dynamic", false)]
    {
        assert_eq!(relieved(method, &["solve", TABLE_1]).contains(note), says, "{method}");
    }
    assert!(
        !relieved("exact", &["solve", TABLE_1, "--set", "model.deflection="]).contains("is given")
    );
}

#[test]
fn auto_computes_what_a_limit_or_a_selected_quantity_needs_besides_its_choice() {
    const MILL: &str = "cases/mill-coarse-slow.toml";
    let by_auto = |command: &[&str]| {
        // Inertia changes the load of this slow pair by less than 1 %.
        texts_of(&[command, &[MILL, "--method", "auto"]].concat())
    };
    let (_, text, _) = by_auto(&["solve"]);
    assert!(text.contains("auto chose static"), "{text}");
    for quantity in ["dynamic_peak_force", "static_te_peak_to_peak", "mesh_force"] {
        let (code, text, errors) = by_auto(&["solve", "--format", "json", "--only", quantity]);
        let report: Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!((code, report["method"].as_str()), (0, Some("static")));
        assert!(report["quantities"][quantity]["value"].is_number(), "{text} {errors}");
    }
    let limit = "limits.dynamic_peak_force=1 MN";
    let (code, text, errors) = by_auto(&["check", "--set", limit]);
    assert!(
        text.contains("ok cases/mill-coarse-slow.toml: dynamic_peak_force"),
        "{code} {text} {errors}"
    );
    let (_, rows, _) = by_auto(&[
        "sweep",
        "--vary",
        "driven.tip_relief=0..10 um",
        "--points",
        "2",
        "--only",
        "dynamic_peak_force",
    ]);
    let has_value = |row: &str| row.split(',').all(|cell| !cell.is_empty());
    assert!(rows.lines().skip(1).all(has_value), "{rows}");
}
