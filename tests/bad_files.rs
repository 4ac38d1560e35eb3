//! Every bad file is refused at the right place, with the cause and the mend, all faults in one run.

use tipstrike::case::Document;
use tipstrike::case::file::{Fault, FaultKind, MOST_BYTES};

const GOOD: &str = include_str!("../cases/zhou-chen-2014.toml");

fn faults(text: &str) -> Vec<Fault> {
    Document::parse("bad.toml", text).map(|_| Vec::new()).unwrap_or_else(|faults| faults)
}

fn printed(faults: &[Fault]) -> String {
    faults.iter().map(|fault| format!("{fault}\n")).collect()
}

/// A fault as a row expects it: line, column, field, part of the cause, part of the mend.
type Row<'r> = (usize, usize, &'r str, &'r str, &'r str);

#[track_caller]
fn expect(text: &str, rows: &[Row<'_>]) {
    let found = faults(text);
    assert_eq!(found.len(), rows.len(), "{text:?}\n{}", printed(&found));
    for (fault, &(line, column, field, cause, mend)) in found.iter().zip(rows) {
        let shown = printed(&found);
        assert_eq!((fault.line, fault.column, fault.field.as_str()), (line, column, field), "{text:?}\n{shown}");
        assert!(fault.cause.contains(cause), "cause {cause:?} of {shown}");
        assert!(fault.mend.contains(mend), "mend {mend:?} of {shown}");
    }
}

/// The good case with one line of it replaced; the faults stand on that line.
#[track_caller]
fn expect_on_line(line: &str, bad: &str, rows: &[(usize, &str, &str, &str)]) {
    assert!(GOOD.contains(line), "{line}");
    let number = GOOD[..GOOD.find(line).unwrap_or(0)].matches('\n').count() + 1;
    let rows: Vec<Row<'_>> = rows.iter().map(|&(column, field, cause, mend)| (number, column, field, cause, mend)).collect();
    expect(&GOOD.replacen(line, bad, 1), &rows);
}

const MODULE: &str = "module = \"5 mm\"";

#[test]
fn one_bad_line() {
    for (line, bad, column, field, cause, mend) in [
        // values with units
        (MODULE, "module = 5", 10, "pair.module", "bare number where a length", "\"5 mm\""),
        (MODULE, "module = 5.0", 10, "pair.module", "bare number", "\"5.0 mm\""),
        (MODULE, "module = \"5\"", 10, "pair.module", "bare number", "\"5 mm\""),
        (MODULE, "module = \"4,5 mm\"", 10, "pair.module", "comma", "write 4.5, not 4,5"),
        (MODULE, "module = \"−5 mm\"", 10, "pair.module", "not the minus sign", "write -5 mm"),
        (MODULE, "module = \"1e-400 mm\"", 10, "pair.module", "too near to zero", "write 0"),
        (MODULE, "module = \"1e400 mm\"", 10, "pair.module", "too large", "smaller"),
        (MODULE, "module = \"nan mm\"", 10, "pair.module", "not a finite number", "20 mm"),
        (MODULE, "module = \"inf mm\"", 10, "pair.module", "not a finite number", "20 mm"),
        (MODULE, "module = nan", 10, "pair.module", "not a finite number", "20 mm"),
        (MODULE, "module = -inf", 10, "pair.module", "not a finite number", "20 mm"),
        (MODULE, "module = \"16 kg\"", 10, "pair.module", "unit of mass, not of length", "use one of mm"),
        (MODULE, "module = \"5 mmm\"", 10, "pair.module", "unknown unit `mmm`", "did you mean mm?"),
        (MODULE, "module = \"mm\"", 10, "pair.module", "does not begin with a number", "20 mm"),
        (MODULE, "module = \"\"", 10, "pair.module", "no value", "module = \"5 mm\""),
        (MODULE, "module = \"five mm\"", 10, "pair.module", "does not begin with a number", "20 mm"),
        (MODULE, "module = \"5 mm wide\"", 10, "pair.module", "unknown unit", "use one of"),
        (MODULE, "module = \"0 mm\"", 10, "pair.module", "below the limit of 0.05 mm", "from 0.05 to 50 mm"),
        (MODULE, "module = \"51 mm\"", 10, "pair.module", "above the limit of 50 mm", "from 0.05 to 50 mm"),
        (MODULE, "module = [\"5 mm\"]", 10, "pair.module", "an array", "module = \"5 mm\""),
        (MODULE, "module = { value = \"5 mm\" }", 10, "pair.module", "a table", "module = \"5 mm\""),
        (MODULE, "module = 1979-05-27", 10, "pair.module", "a date", "module = \"5 mm\""),
        (MODULE, "module = true", 10, "pair.module", "true or false", "module = \"5 mm\""),
        ("pressure_angle = \"20 deg\"", "pressure_angle = \"20 mm\"", 18, "pair.pressure_angle", "length, not of angle", "deg"),
        ("pressure_angle = \"20 deg\"", "pressure_angle = \"20 grad\"", 18, "pair.pressure_angle", "unknown unit", "rad"),
        ("face_width = \"8 mm\"", "face_width = \"-8 mm\"", 14, "driver.face_width", "below the limit", "from 0.1"),
        ("power = \"15 kW\"", "power = \"15 kNm\"", 9, "operation.power", "torque, not of power", "kW"),
        ("speed = \"2000 rpm\"", "speed = \"2000 Hz\"", 9, "operation.speed", "unknown unit `Hz`", "use one of rpm"),
        ("young = \"205 GPa\"", "young = \"205 gpa\"", 9, "driver.young", "unknown unit `gpa`", "did you mean GPa?"),
        // bare numbers
        ("teeth = 20", "teeth = 20.5", 9, "driver.teeth", "not a whole number", "such as 20"),
        ("teeth = 20", "teeth = -20", 9, "driver.teeth", "below the limit of 5", "from 5 to 1000"),
        ("teeth = 20", "teeth = \"20\"", 9, "driver.teeth", "quotes", "without quotes"),
        ("teeth = 20", "teeth = 1e400", 9, "driver.teeth", "too large", "whole number"),
        ("teeth = 20", "teeth = 20 mm", 9, "driver.teeth", "unit `mm`", "write 20"),
        ("teeth = 20", "teeth = 020", 9, "driver.teeth", "not written as TOML", "20"),
        ("poisson = 0.3", "poisson = 0,3", 11, "driver.poisson", "comma", "write 0.3, not 0,3"),
        ("poisson = 0.3", "poisson = .3", 11, "driver.poisson", "not written as TOML", "0.5"),
        ("poisson = 0.3", "poisson = \"0.3\"", 11, "driver.poisson", "quotes", "without quotes"),
        ("poisson = 0.3", "poisson = inf", 11, "driver.poisson", "not a finite number", "0.5"),
        ("poisson = 0.3", "poisson = 1e-400", 11, "driver.poisson", "too near to zero", "write 0"),
        ("poisson = 0.3", "poisson = −0.3", 11, "driver.poisson", "not the minus sign", "write -0.3"),
        ("stations = 64", "stations = 0", 12, "model.stations", "below the limit of 1", "from 1 to 10000"),
        // words and choices
        ("rung = \"exact\"", "rung = \"exat\"", 8, "model.rung", "unknown choice `exat`", "did you mean exact?"),
        ("rung = \"exact\"", "rung = \"dynamic\"", 8, "model.rung", "not in this version", "use `exact`"),
        ("rung = \"exact\"", "rung = 2", 8, "model.rung", "unknown choice", "paper, exact"),
        ("rung = \"exact\"", "rung = exact", 8, "model.rung", "not in quotes", "write \"exact\""),
        ("title = \"Zhou & Chen 2014, Table 1\"", "title = [1]", 9, "title", "an array", "title = "),
        // keys and tables
        (MODULE, "modul = \"5 mm\"\nmodule = \"5 mm\"", 1, "pair.modul", "unknown key `modul`", "did you mean module?"),
        (MODULE, "module = \"5 mm\"\nteeth = 20", 0, "pair.teeth", "unknown key `teeth`", "belongs under [driver]"),
        (MODULE, "module = \"5 mm\"\nmodule = \"6 mm\"", 0, "pair.module", "there twice", "keep one"),
        ("[limits]", "[lmits]", 2, "lmits", "unknown key or table", "did you mean limits?"),
        ("[limits]", "[driver]", 2, "driver", "there twice", "under one header"),
        (
            "impact_force = \"2500 N\"",
            "impact_forse = \"2500 N\"",
            1,
            "limits.impact_forse",
            "unknown quantity",
            "did you mean impact_force?",
        ),
        ("impact_force = \"2500 N\"", "impact_force = 2500", 16, "limits.impact_force", "bare number", "\"2500 N\""),
        (
            "impact_force = \"2500 N\"",
            "impact_force = \"2500 mm\"",
            16,
            "limits.impact_force",
            "length, not of force",
            "use one of N",
        ),
        ("impact_force = \"2500 N\"", "dynamic_factor = \"1.5 N\"", 18, "limits.dynamic_factor", "quotes", "without quotes"),
        (
            "impact_force = \"2500 N\"",
            "[spread]\n\"driver.teet\" = { normal = \"1 um\" }",
            0,
            "spread.\"driver.teet\"",
            "unknown key",
            "driver.teeth",
        ),
        (
            "impact_force = \"2500 N\"",
            "[spread]\n\"pair.module\" = { norml = \"1 um\" }",
            0,
            "spread.\"pair.module\"",
            "unknown distribution",
            "normal",
        ),
        (
            "impact_force = \"2500 N\"",
            "[spread]\n\"pair.module\" = \"1 um\"",
            0,
            "spread.\"pair.module\"",
            "no distribution",
            "normal",
        ),
        (
            "impact_force = \"2500 N\"",
            "[spread]\n\"pair.module\" = { normal = \"1 kg\" }",
            0,
            "spread.\"pair.module\"",
            "mass, not of length",
            "mm",
        ),
        (
            "impact_force = \"2500 N\"",
            "[spread]\n\"pair.module\" = { normal = 1 }",
            0,
            "spread.\"pair.module\"",
            "bare number",
            "\"1 mm\"",
        ),
        // one field against another
        (
            "bore_radius = \"20 mm\"",
            "bore_radius = \"50 mm\"",
            15,
            "driver.bore_radius",
            "root circle's 43.75 mm",
            "radius (not a diameter)",
        ),
        ("power = \"15 kW\"", "power = \"15 kW\"\ntorque = \"71.6 N m\"", 0, "operation.torque", "both given", "take one"),
        ("power = \"15 kW\"", "", 0, "operation.power", "neither", "power = \"15 kW\""),
        // TOML itself
        (MODULE, "module = 5 mm", 10, "pair.module", "not in quotes", "write \"5 mm\""),
        (MODULE, "module = 4,5 mm", 10, "pair.module", "comma", "write 4.5"),
        (MODULE, "module =", 0, "pair.module", "no value", "module = \"5 mm\""),
        (MODULE, "module = \"5 mm", 0, "pair.module", "string", "close the string"),
        (MODULE, "module", 0, "toml", "no value", "key = value"),
        (MODULE, "module = \"5\" mm", 0, "pair.module", "unexpected", "new line"),
        (MODULE, "module = \"5\\q mm\"", 0, "pair.module", "escape", "backslash"),
        (MODULE, "module = \"5 \u{1b}[2Jmm\"", 0, "pair.module", r"control character `\u{1b}`", "take it out"),
        (MODULE, "module = \"5 \\u001b[2Jmm\"", 10, "pair.module", r"unknown unit `\u{1b}[2Jmm`", "use one of"),
        (MODULE, "mod\u{1b}ule = \"5 mm\"\nmodule = \"5 mm\"", 4, "toml", "control character", "take it out"),
        (MODULE, "\u{202e}x = 1\nmodule = \"5 mm\"", 1, "toml", "invalid unquoted key", "letters, digits"),
        (MODULE, "\"\u{202e}x\" = 1\nmodule = \"5 mm\"", 1, "pair.\u{202e}x", r"unknown key `\u{202e}x`", "module"),
        (MODULE, "mod\0ule = 1\nmodule = \"5 mm\"", 4, "toml", r"control character `\u{0}`", "take it out"),
    ] {
        let first = GOOD[..GOOD.find(line).unwrap_or_else(|| panic!("{line}"))].matches('\n').count() + 1;
        let found = faults(&GOOD.replacen(line, bad, 1));
        let shown = printed(&found);
        assert_eq!(found.len(), 1, "{bad:?}\n{shown}");
        let fault = &found[0];
        let expected = if column == 0 { (fault.line, fault.column) } else { (first, column) };
        assert_eq!((fault.line, fault.column, fault.field.as_str()), (expected.0, expected.1, field), "{bad:?}\n{shown}");
        assert!(fault.cause.contains(cause), "cause {cause:?} of {shown}");
        assert!(fault.mend.contains(mend), "mend {mend:?} of {shown}");
        assert!(!shown.trim_end().contains(|c: char| c.is_control() || c == '\u{202e}'), "{shown:?}");
    }
}

#[test]
fn places_beside_the_bad_value() {
    // the second of two keys, the end of an open string, the header of a table with a gap
    expect_on_line("power = \"15 kW\"", "power = \"15 kW\" x", &[(9, "operation.power", "x", "")]);
    expect(
        &GOOD.replace("teeth = 20\n", ""),
        &[
            (14, 1, "driver.teeth", "missing", "add teeth = 20 to [driver]"),
            (25, 1, "driven.teeth", "missing", "add teeth = 20 to [driven]"),
        ],
    );
}
