//! Every invalid file is refused at the correct place with cause and fix: a syntax error alone,
//! otherwise all faults in one run.
use tipstrike::case::file::{Fault, MOST_BYTES};
use tipstrike::case::{Document, NEWER_FORMAT};

const GOOD: &str = include_str!("../../cases/zhou-chen-2014.toml");

fn faults(text: &str) -> Vec<Fault> {
    Document::parse("bad.toml", text).err().unwrap_or_default()
}

fn printed(faults: &[Fault]) -> String {
    faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n")
}

/// An expected fault: line, column, field, part of the cause, part of the fix.
type Row<'r> = (usize, usize, &'r str, &'r str, &'r str);

#[track_caller]
fn expect(text: &str, rows: &[Row<'_>]) {
    let found = faults(text);
    assert_eq!(found.len(), rows.len(), "{text:?}\n{}", printed(&found));
    for (fault, &(line, column, field, cause, fix)) in found.iter().zip(rows) {
        let shown = printed(&found);
        assert_eq!(
            (fault.line, fault.column, fault.problem.field.as_str()),
            (line, column, field),
            "{text:?}\n{shown}"
        );
        let problem = &fault.problem;
        assert!(problem.cause.contains(cause), "cause {cause:?} of {shown}");
        assert!(problem.fix.contains(fix), "fix {fix:?} of {shown}");
    }
}

const MODULE: &str = "module = \"5 mm\"";
const LIMIT: &str = "impact_force = \"2500 N\"";

/// A line of the valid case, its replacement, the number of lines to the fault and its column, its
/// field, a part of its cause and a part of its fix.
type OneLine = (&'static str, &'static str, usize, usize, &'static str, &'static str, &'static str);

#[rustfmt::skip]
const ONE_BAD_LINE: &[OneLine] = &[
    // values with units
    (MODULE, "module = 5", 0, 10, "pair.module", "has no unit, and a length", "\"5 mm\""),
    (MODULE, "module = 5.0", 0, 10, "pair.module", "has no unit", "\"5.0 mm\""),
    (MODULE, "module = \"5\"", 0, 10, "pair.module", "has no unit", "\"5 mm\""),
    (MODULE, "module = \"4,5 mm\"", 0, 10, "pair.module", "comma", "write 4.5, not 4,5"),
    (MODULE, "module = \"−5 mm\"", 0, 10, "pair.module", "not the minus sign", "write -5 mm"),
    (MODULE, "module = \"1e-400 mm\"", 0, 10, "pair.module", "too close to zero", "write 0"),
    (MODULE, "module = \"1e400 mm\"", 0, 10, "pair.module", "too large", "smaller"),
    (MODULE, "module = \"nan mm\"", 0, 10, "pair.module", "not a finite number", "20 mm"),
    (MODULE, "module = \"inf mm\"", 0, 10, "pair.module", "not a finite number", "20 mm"),
    (MODULE, "module = nan", 0, 10, "pair.module", "not a finite number", "20 mm"),
    (MODULE, "module = -inf", 0, 10, "pair.module", "not a finite number", "20 mm"),
    (MODULE, "module = \"16 kg\"", 0, 10, "pair.module", "unit of mass, not of length", "use one of mm"),
    (MODULE, "module = \"5 mmm\"", 0, 10, "pair.module", "unknown unit `mmm`", "did you mean mm?"),
    (MODULE, "module = \"mm\"", 0, 10, "pair.module", "does not begin with a number", "20 mm"),
    (MODULE, "module = \"\"", 0, 10, "pair.module", "neither pair.module nor pair.diametral_pitch",
        "module = \"5 mm\" under [pair]"),
    (MODULE, "module = \"five mm\"", 0, 10, "pair.module", "does not begin with a number", "20 mm"),
    (MODULE, "module = \"5 mm wide\"", 0, 10, "pair.module", "unknown unit", "use one of"),
    (MODULE, "module = \"0 mm\"", 0, 10, "pair.module", "below the limit of 0.05 mm", "from 0.05 to 50 mm"),
    (MODULE, "module = \"51 mm\"", 0, 10, "pair.module", "above the limit of 50 mm", "from 0.05 to 50 mm"),
    (MODULE, "module = [\"5 mm\"]", 0, 10, "pair.module", "an array", "module = \"5 mm\""),
    (MODULE, "module = { value = \"5 mm\" }", 0, 10, "pair.module", "a table", "module = \"5 mm\""),
    (MODULE, "module = 1979-05-27", 0, 10, "pair.module", "a date", "module = \"5 mm\""),
    (MODULE, "module = true", 0, 10, "pair.module", "true or false", "module = \"5 mm\""),
    ("pressure_angle = \"20 deg\"", "pressure_angle = \"20 mm\"", 0, 18, "pair.pressure_angle", "length, not of angle", "deg"),
    ("pressure_angle = \"20 deg\"", "pressure_angle = \"20 grad\"", 0, 18, "pair.pressure_angle", "unknown unit", "rad"),
    ("face_width = \"8 mm\"", "face_width = \"-8 mm\"", 0, 14, "driver.face_width", "below the limit", "from 0.1"),
    ("power = \"15 kW\"", "power = \"15 kNm\"", 0, 9, "operation.power", "torque, not of power", "kW"),
    ("speed = \"2000 rpm\"", "speed = \"2000 Hz\"", 0, 9, "operation.speed", "unit of frequency", "use one of rpm"),
    ("young = \"205 GPa\"", "young = \"205 gpa\"", 0, 9, "driver.young", "unknown unit `gpa`", "did you mean GPa?"),
    // bare numbers
    ("teeth = 20", "teeth = 20.5", 0, 9, "driver.teeth", "not a whole number", "such as 20"),
    ("teeth = 20", "teeth = -20", 0, 9, "driver.teeth", "below the limit of 5", "from 5 to 1000"),
    ("teeth = 20", "teeth = \"20\"", 0, 9, "driver.teeth", "quotes", "without quotes"),
    ("teeth = 20", "teeth = 1e400", 0, 9, "driver.teeth", "too large", "whole number"),
    ("teeth = 20", "teeth = 20 mm", 0, 9, "driver.teeth", "such as `mm`", "such as 20"),
    ("teeth = 20", "teeth = 020", 0, 9, "driver.teeth", "not how TOML writes", "write 20"),
    ("poisson = 0.3", "poisson = 0,3", 0, 11, "driver.poisson", "comma", "write 0.3, not 0,3"),
    ("poisson = 0.3", "poisson = .3", 0, 11, "driver.poisson", "not how TOML writes", "write 0.3"),
    ("poisson = 0.3", "poisson = \"0.3\"", 0, 11, "driver.poisson", "quotes", "without quotes"),
    ("poisson = 0.3", "poisson = inf", 0, 11, "driver.poisson", "not a finite number", "0.5"),
    ("poisson = 0.3", "poisson = 1e-400", 0, 11, "driver.poisson", "too close to zero", "from 0 to"),
    ("poisson = 0.3", "poisson = −0.3", 0, 11, "driver.poisson", "not the minus sign", "write -0.3"),
    ("stations = 64", "stations = 0", 0, 12, "model.stations", "below the limit of 1", "from 1 to 10000"),
    ("teeth = 20", "teeth = twenty", 0, 9, "driver.teeth", "does not begin with a number",
        "whole number from 5 to 1000, such as 20"),
    ("poisson = 0.3", "poisson = \"30 %\"", 0, 11, "driver.poisson", "quotes",
        "write poisson = 0.3, without quotes"),
    ("stations = 64", "stations = \"many\"", 0, 12, "model.stations", "quotes", "write stations = "),
    ("young = \"205 GPa\"", "young = \"205000\"", 0, 9, "driver.young", "has no unit", "\"205000 MPa\""),
    (MODULE, "module = “5 mm”", 0, 10, "pair.module", "has curly quotes", "\"5 mm\""),
    (MODULE, "module: \"5 mm\"", 0, 7, "pair.module", "`:` instead of `=`", "module = \"5 mm\""),
    // texts and choices
    ("method = \"exact\"", "method = \"exat\"", 0, 10, "model.method", "unknown choice `exat`", "did you mean exact?"),
    ("method = \"exact\"", "method = \"dinamic\"", 0, 10, "model.method", "unknown choice `dinamic`", "did you mean dynamic?"),
    ("method = \"exact\"", "method = 2", 0, 10, "model.method",
        "expected a text in quotes, found a number", "\"auto\""),
    ("method = \"exact\"", "method = exact", 0, 10, "model.method", "not in quotes", "write \"exact\""),
    ("title = \"Zhou & Chen 2014, Table 1\"", "title = [1]", 0, 9, "title", "an array", "title = "),
    // keys and tables
    (MODULE, "modul = \"5 mm\"\nmodule = \"5 mm\"", 0, 1, "pair.modul", "unknown key `modul`", "did you mean module?"),
    (MODULE, "module = \"5 mm\"\nteeth = 20", 1, 1, "pair.teeth", "unknown key `teeth`", "belongs under [driver]"),
    (MODULE, "module = \"5 mm\"\nmodule = \"6 mm\"", 1, 1, "pair.module", "appears twice", "keep one"),
    ("[limits]", "[lmits]", 0, 2, "lmits", "unknown key or table", "did you mean limits?"),
    ("[limits]", "[limits]\n[limits]", 1, 2, "limits", "appears twice", "under one header"),
    ("impact_force = \"2500 N\"", "impact_forse = \"2500 N\"", 0, 1, "limits.impact_forse", "unknown quantity",
        "did you mean impact_force?"),
    ("impact_force = \"2500 N\"", "F_d,max = \"3 kN\"", 0, 1, "limits", "symbol of dynamic_peak_force",
        "write dynamic_peak_force"),
    ("impact_force = \"2500 N\"", "F_S = \"2500 N\"", 0, 1, "limits.F_S", "symbol of impact_force", "write impact_force"),
    ("impact_force = \"2500 N\"", "dynamic_contact_lost = false", 0, 24,
        "limits.dynamic_contact_lost", "true or false", "dynamic_contact_lost = 0"),
    ("impact_force = \"2500 N\"", "normal_velocity = [1]", 0, 19, "limits.normal_velocity", "an array",
        "normal_velocity = \"1 m/s\""),
    ("impact_force = \"2500 N\"", "impact_force = 2500", 0, 16, "limits.impact_force", "has no unit", "\"2500 N\""),
    ("impact_force = \"2500 N\"", "dynamic_contact_lost = inf", 0, 24, "limits.dynamic_contact_lost",
        "not a finite number", "write 0 to forbid it"),
    ("tip_relief = \"0 um\"", "tip_relief = 0.0375", 0, 14, "driver.tip_relief",
        "has no unit", "\"0.0375 um\" or \"0.0375 mm\""),
    ("impact_force = \"2500 N\"", "impact_force = \"2500 mm\"", 0, 16, "limits.impact_force", "length, not of force", "use one of N"),
    ("impact_force = \"2500 N\"", "dynamic_factor = \"1.5 N\"", 0, 18, "limits.dynamic_factor", "quotes", "without quotes"),
    ("impact_force = \"2500 N\"", "[spread]\n\"driver.teet\" = { normal = \"1 um\" }", 1, 1, "spread.\"driver.teet\"", "unknown key", "driver.teeth"),
    ("impact_force = \"2500 N\"", "[spread]\n\"pair.module\" = { norml = \"1 um\" }", 1, 17, "spread.\"pair.module\"", "unknown distribution", "normal"),
    ("impact_force = \"2500 N\"", "[spread]\n\"pair.module\" = \"1 um\"", 1, 17, "spread.\"pair.module\"", "not a distribution", "normal"),
    ("impact_force = \"2500 N\"", "[spread]\n\"pair.module\" = { normal = \"1 kg\" }", 1, 17, "spread.\"pair.module\"", "mass, not of length", "mm"),
    ("impact_force = \"2500 N\"", "[spread]\n\"pair.module\" = { normal = 1 }", 1, 17, "spread.\"pair.module\"", "has no unit", "\"1 mm\""),
    // variants
    (LIMIT, "[variants.a]\n\"driven.tip_relif\" = \"1 um\"", 1, 1, "variants.a.driven.tip_relif",
        "unknown key `tip_relif`", "did you mean tip_relief?"),
    (LIMIT, "[variants.a]\ndriven.tip_relief = \"1 kg\"", 1, 21, "variants.a.driven.tip_relief", "mass, not of length", "mm"),
    (LIMIT, "[variants.a.driver]\nteeth = 2", 1, 9, "variants.a.driver.teeth", "below the limit of 5", "from 5 to 1000"),
    (LIMIT, "[variants.a]\n\"driver.teeth\" = \"\"", 1, 18, "variants.a.driver.teeth",
        "the case needs this value", "teeth = 20"),
    (LIMIT, "[variants.a]\nlimits.impact_forse = \"1 N\"", 1, 8, "variants.a.limits.impact_forse", "unknown quantity",
        "did you mean impact_force?"),
    (LIMIT, "[variants.a]\n\"limits.impact_force\" = \"1 m\"", 1, 25,
        "variants.a.limits.impact_force", "length, not of force", "use one of N"),
    (LIMIT, "[variants.a]\nspread.\"pair.module\" = { norml = \"1 um\" }", 1, 24,
        "variants.a.spread.\"pair.module\"", "unknown distribution", "normal"),
    (LIMIT, "[variants.a]\noperation.power = \"1 kW\"\noperation.torque = \"1 N m\"", 2, 20,
        "variants.a.operation.torque", "both given", "remove one of them"),
    (LIMIT, "[variants.a]\n\"pair.module\" = \"1 mm\"\npair.module = \"2 mm\"", 2, 15, "variants.a.pair.module", "twice", "keep one"),
    (LIMIT, "[variants.a]\nformat = 1", 1, 1, "variants.a.format", "the format of its case", "remove this key"),
    (LIMIT, "[variants.a]\npinion = 1", 1, 1, "variants.a.pinion", "unknown key or table", "[driver] and [driven]"),
    (LIMIT, "[variants.a]\nmodule = \"1 mm\"", 1, 1, "variants.a.module", "unknown key or table", "put it under [pair]"),
    (LIMIT, "[variants.a]", 0, 11, "variants.a", "changes nothing", "remove the table"),
    (LIMIT, "[variants.\"a b\"]\nmodel.method = \"exact\"", 0, 11, "variants.a b", "no name of a variant", "letters, digits"),
    (LIMIT, "[variants]\na = 1", 1, 5, "variants.a", "expected a table of overrides, found a number", "[variants.a]"),
    ("title = \"Zhou & Chen 2014, Table 1\"", "variants = 1", 0, 12, "variants",
        "expected the table [variants], found a number", "[variants]"),
    (LIMIT, "[variants.a]\n\"pair.module\" = 5 mm", 1, 17, "pair.module", "not in quotes", "\"5 mm\""),
    // fields that contradict each other
    ("bore_radius = \"20 mm\"", "bore_radius = \"50 mm\"", 0, 15, "driver.bore_radius", "root circle's 43.75 mm",
        "radius (not a diameter)"),
    ("power = \"15 kW\"", "power = \"15 kW\"\ntorque = \"71.6 N m\"", 1, 10, "operation.torque", "both given", "remove one"),
    // TOML itself
    (MODULE, "module = 5 mm", 0, 10, "pair.module", "not in quotes", "write \"5 mm\""),
    (MODULE, "module = 4,5 mm", 0, 10, "pair.module", "comma", "write 4.5"),
    (MODULE, "module =", 0, 9, "pair.module", "no value", "module = \"5 mm\""),
    (MODULE, "module = \"5 mm", 0, 15, "pair.module", "string", "close the string"),
    (MODULE, "module", 0, 7, "toml", "no value", "key = value"),
    (MODULE, "module = \"5\" mm", 0, 14, "pair.module", "unexpected", "# comment"),
    (MODULE, "module = \"5\\q mm\"", 0, 13, "pair.module", "escape", "backslash"),
    (MODULE, "module = \"5 \u{1b}[2Jmm\"", 0, 13, "pair.module", r"control character `\u{1b}`", "remove it"),
    (MODULE, "module = \"5 \\u001b[2Jmm\"", 0, 10, "pair.module", r"unknown unit `\u{1b}[2Jmm`", "use one of"),
    (MODULE, "mod\u{1b}ule = \"5 mm\"\nmodule = \"5 mm\"", 0, 4, "toml", "control character", "remove it"),
    (MODULE, "\u{202e}x = 1\nmodule = \"5 mm\"", 0, 1, "toml", "invalid unquoted key", "letters, digits"),
    (MODULE, "\"\u{202e}x\" = 1\nmodule = \"5 mm\"", 0, 1, "pair.\u{202e}x", r"unknown key `\u{202e}x`", "module"),
    (MODULE, "mod\0ule = 1\nmodule = \"5 mm\"", 0, 4, "toml", r"control character `\u{0}`", "remove it"),
];

#[test]
fn one_bad_line() {
    for &(line, bad, down, column, field, cause, fix) in ONE_BAD_LINE {
        let at = GOOD.find(line).unwrap_or_else(|| panic!("the good case has no {line}"));
        let number = GOOD[..at].matches('\n').count() + 1 + down;
        expect(&GOOD.replacen(line, bad, 1), &[(number, column, field, cause, fix)]);
    }
}

/// The valid case without the lines of one table.
fn without(table: &str) -> String {
    let mut inside = false;
    let keep = |line: &&str| {
        inside = if line.starts_with('[') { line.trim() == format!("[{table}]") } else { inside };
        !inside
    };
    GOOD.split_inclusive('\n').filter(keep).collect()
}

#[test]
fn a_missing_value_is_reported_at_its_key_its_table_or_the_end() {
    expect(
        &GOOD.replace("teeth = 20\n", ""),
        &[
            (14, 1, "driver.teeth", "missing", "write teeth = 20 under [driver]"),
            (25, 1, "driven.teeth", "missing", "write teeth = 20 under [driven]"),
        ],
    );
    expect(
        &GOOD.replace("power = \"15 kW\"\n", ""),
        &[(42, 1, "operation.power", "neither", "power = \"15 kW\"")],
    );
    expect(
        &without("driven"),
        &[
            (44, 1, "driven.teeth", "missing", "under [driven]"),
            (44, 1, "driven.face_width", "missing", "face_width = \"8 mm\" under [driven]"),
        ],
    );
    expect(&GOOD.replace("format = 1\n", ""), &[(1, 1, "format", "missing", "format = 1")]);
}

#[test]
fn an_empty_file_lacks_every_required_value() {
    for text in ["", "\u{feff}", "\n\n", "# a comment"] {
        let found = faults(text);
        let fields: Vec<&str> = found.iter().map(|fault| fault.problem.field.as_str()).collect();
        let needed = "format pair.module driver.teeth driver.face_width driven.teeth \
            driven.face_width operation.power operation.speed";
        assert_eq!(fields.join(" "), needed, "{text:?}");
    }
}

#[test]
fn one_run_reports_all_faults_in_their_order_in_the_file() {
    let text = GOOD
        .replacen(MODULE, "module = 5", 1)
        .replacen("teeth = 20", "teeth = 20.5", 1)
        .replacen("poisson = 0.3", "poison = 0.3", 1)
        .replacen("method = \"exact\"", "method = \"papr\"", 1);
    expect(
        &text,
        &[
            (11, 10, "pair.module", "has no unit", "write \"5 mm\""),
            (15, 9, "driver.teeth", "not a whole number", "20"),
            (21, 1, "driver.poison", "unknown key", "did you mean poisson?"),
            (47, 10, "model.method", "unknown choice", "did you mean paper?"),
        ],
    );
    let broken = text.replacen("speed = \"2000 rpm\"", "speed = \"2000", 1);
    expect(&broken, &[(44, 14, "operation.speed", "invalid basic string", "close the string")]);
}

#[test]
fn faults_of_one_field_do_not_hide_those_between_others() {
    let text = GOOD.replacen("young = \"205 GPa\"", "young = 205", 1);
    let text = text.replacen("bore_radius = \"20 mm\"", "bore_radius = \"60 mm\"", 1);
    expect(
        &text,
        &[
            (19, 15, "driver.bore_radius", "root circle", "radius"),
            (20, 9, "driver.young", "has no unit", "\"205 GPa\""),
        ],
    );
}

#[test]
fn columns_count_characters_and_lines_end_in_either_way() {
    let text = GOOD.replacen("base_pitch = \"16 um\"", "\"bäse·pitch\" = 1", 1);
    expect(&text, &[(39, 1, "deviations.bäse·pitch", "unknown key", "")]);
    let windows = GOOD.replace('\n', "\r\n").replacen(MODULE, "module = 5", 1);
    expect(&windows, &[(11, 10, "pair.module", "has no unit", "\"5 mm\"")]);
    let marked = format!("\u{feff}{}", GOOD.replacen("format = 1", "format = 0", 1));
    expect(&marked, &[(6, 10, "format", "format is unknown", "format = 1")]);
    let inline = "format = 1\npair = { modul = \"5 mm\" }\n".to_owned()
        + &without("pair").replace("format = 1\n", "");
    expect(
        &inline,
        &[
            (2, 8, "pair.module", "neither", "module = \"5 mm\" under [pair]"),
            (2, 10, "pair.modul", "unknown key", "did you mean module?"),
        ],
    );
}

#[test]
fn tables_of_the_wrong_kind() {
    expect(&GOOD.replace("[driver]", "[[driver]]"), &[(14, 1, "driver", "an array", "[driver]")]);
    let text = GOOD.replacen("format = 1", "format = 1\npair = 5", 1).replace("[pair]", "[par]");
    expect(
        &text,
        &[
            (7, 8, "pair", "a number", "[pair]"),
            (11, 2, "par", "unknown key or table", "did you mean pair?"),
        ],
    );
    expect(&GOOD.replace("[pair]", "[pair"), &[(10, 6, "toml", "unclosed table", "]")]);
    expect(
        &GOOD.replacen("format = 1", "format = 1\nteeth = 3", 1),
        &[(7, 1, "teeth", "unknown key", "put it under [driver]")],
    );
}

#[test]
fn a_newer_format_is_reported_alone() {
    let found =
        faults(&GOOD.replacen("format = 1", "format = 2", 1).replacen(MODULE, "modulus = 5", 1));
    assert_eq!(found.len(), 1, "{}", printed(&found));
    assert_eq!((&*found[0].problem.code, found[0].line, found[0].column), (NEWER_FORMAT, 6, 10));
    assert!(found[0].to_string().contains("newer tipstrike"));
    let text = faults(&GOOD.replacen("format = 1", "format = \"1\"", 1));
    assert_eq!((text.len(), &*text[0].problem.code), (1, ""));
}

#[test]
fn no_depth_and_no_length_is_too_much() {
    let deep = GOOD.replacen(MODULE, &format!("module = {}", "[".repeat(5000)), 1);
    let fault = &faults(&deep)[0];
    assert_eq!((fault.line, fault.problem.field.as_str()), (11, "pair.module"));
    let keys = GOOD.replacen(MODULE, &format!("{}x = 1", "a.".repeat(5000)), 1);
    assert!(!faults(&keys).is_empty());
    let long = format!("{GOOD}#{}", "x".repeat(MOST_BYTES));
    expect(&long, &[(1, 1, "toml", "longer than 1024 KiB", "case file")]);
    let most = format!("{GOOD}#{}", "x".repeat(MOST_BYTES - GOOD.len() - 1));
    assert!(faults(&most).is_empty());
}

#[test]
fn a_flood_of_faults_is_cut() {
    for (line, table, first) in [
        ("a# = 1", "", "a0"),
        ("a# = 1", "[pair]\n", "pair.a0"),
        ("a# = 1", "[limits]\n", "limits.a0"),
        ("a# = 1", "[spread]\n", "spread.\"a0\""),
        ("[a#]", "", "a0"),
    ] {
        let flood: Vec<_> =
            (0..50_000).map(|number| line.replace('#', &number.to_string())).collect();
        let found = faults(&format!("format = 1\n{table}{}\n", flood.join("\n")));
        assert_eq!(found.len(), 101, "{line}");
        assert!(found.iter().any(|fault| fault.problem.field == first), "{line}: {}", found[0]);
        assert_eq!(found[100].problem.cause, "and more faults", "{line}");
    }
}

#[test]
fn bytes_that_are_no_text_are_placed() {
    let mut bytes = GOOD.as_bytes().to_vec();
    let at = GOOD.find("5 mm\"").unwrap_or(0) + "5 ".len();
    bytes[at] = 0xff;
    let found = Document::parse("bad.toml", &bytes).map(|_| ()).unwrap_err();
    let message = "bad.toml:11:13: toml: byte 0xff is not UTF-8 text: save the file as UTF-8";
    assert_eq!(found[0].to_string(), message);
}
