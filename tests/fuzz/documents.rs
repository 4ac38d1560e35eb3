//! Cases as texts: read, checked, solved, edited, saved, and read again.

use std::cell::Cell;
use std::ffi::OsString;
use std::fs;
use std::path::Path;

use proptest::prelude::*;
use proptest::sample::Index;
use tipstrike::case::{Case, Document, FIELDS, Variant};
use tipstrike::cli::{self, Exit, Streams};
use tipstrike::model::QUANTITIES;

use crate::properties::{Fate, assert_placed, assert_same, read_and_solve};
use crate::values::{HOSTILE, field_and_text};
use crate::{assert_safe, hold, texts};

/// An edit of a document in the form or by `--set`.
#[derive(Debug, Clone)]
pub(crate) enum Edit {
    Field(usize, String),
    Limit(Index, String),
    Unspread,
    /// A variant with this override, if the field accepts it.
    Variant(usize, String),
    /// No variants.
    Invariant,
}

#[test]
fn no_stored_failure_occurs_again() {
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/kept");
    for entry in fs::read_dir(kept).expect("a folder") {
        let path = entry.expect("an entry").path();
        let bytes = fs::read(&path).expect("a file");
        match String::from_utf8(bytes) {
            Ok(text) => {
                read_and_solve(&text);
                assert_safe_headless(&text);
            }
            Err(error) => assert_bytes(error.as_bytes()),
        }
    }
}

#[test]
fn a_text_is_solved_or_refused_or_its_errors_are_reported_with_their_places() {
    let [all, toml, cases, solved] = [const { Cell::new(0u32) }; 4];
    let count = |counter: &Cell<u32>, is_one: bool| counter.set(counter.get() + u32::from(is_one));
    hold(1200, &texts::mutated(), |text| {
        let fate = read_and_solve(&text);
        count(&all, true);
        count(&toml, text.parse::<toml_edit::DocumentMut>().is_ok());
        count(&cases, fate != Fate::Faulty);
        count(&solved, fate == Fate::Solved);
    });
    let part = |counter: &Cell<u32>| f64::from(counter.get()) / f64::from(all.get());
    let shares = (part(&toml), part(&cases), part(&solved));
    assert!(shares.0 > 0.5 && shares.1 > 0.2 && shares.2 > 0.1, "{shares:?}");
}

#[test]
fn bytes_that_are_no_text_are_reported_with_their_places() {
    let spoilt = prop::collection::vec((any::<Index>(), any::<u8>()), 0..4);
    hold(500, &(texts::mutated(), spoilt, any::<Index>()), |(text, spoilt, end)| {
        let mut bytes = text.into_bytes();
        bytes.truncate(end.index(bytes.len() + 1).max(bytes.len() / 2));
        for (at, byte) in spoilt {
            if !bytes.is_empty() {
                let at = at.index(bytes.len());
                bytes[at] = byte;
            }
        }
        assert_bytes(&bytes);
    });
    hold(300, &prop::collection::vec(any::<u8>(), 0..300), |bytes| {
        assert_bytes(&bytes);
    });
    hold(300, &".{0,200}", |text| {
        read_and_solve(&text);
    });
}

#[test]
fn a_save_keeps_edits_and_comments() {
    let comments = prop::collection::vec((any::<Index>(), any::<bool>()), 0..4);
    let edited = Cell::new(0u32);
    let texts = prop_oneof![texts::written(), texts::mutated()];
    hold(1500, &(texts, comments, edits()), |(text, comments, edits)| {
        let Ok(plain) = Document::parse("case", &text) else { return };
        let commented = with_comments(&text, &comments);
        let Ok(mut document) = Document::parse("case", &commented) else { return };
        let is_same = document.case == plain.case;
        for edit in &edits {
            edit.apply(&mut document.case);
        }
        let rendered = document.render();
        if document.case.inputs().is_err() {
            return;
        }
        edited.set(edited.get() + 1);
        let again = Document::parse("case", &rendered)
            .unwrap_or_else(|faults| panic!("{}\n{rendered}", faults[0]));
        assert_same(&document, &again);
        assert_eq!(again.render(), rendered);
        let template = Document::new(document.case.clone()).render();
        assert_same(&document, &Document::parse("case", &template).expect("a case"));
        // A comment inside a multi-line text is not a comment, and removing a variant also
        // removes the comments inside it.
        let is_same = is_same && !edits.iter().any(|edit| matches!(edit, Edit::Invariant));
        let is_kept = |index: &usize| rendered.contains(&format!("# kept {index}"));
        let lost = (0..comments.len()).filter(|index| !is_kept(index)).count();
        assert!(!is_same || lost == 0, "a comment is lost:\n{commented}\nbecame\n{rendered}");
    });
    assert!(edited.get() > 300, "only {} edits left a valid case", edited.get());
}

#[test]
fn a_saved_case_is_read_unchanged() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case.toml");
    hold(60, &(texts::written(), edits()), |(text, edits)| {
        fs::write(&path, &text).expect("room on the disk");
        let Ok(mut document) = Document::read(&path) else { return };
        for edit in &edits {
            edit.apply(&mut document.case);
        }
        let rendered = document.render();
        document.save(&path).expect("a save");
        assert_eq!(fs::read_to_string(&path).expect("the file"), rendered);
        assert_eq!(document.render(), rendered);
        if document.case.inputs().is_ok() {
            let again = Document::read(&path).expect("it opens again");
            assert_same(&document, &again);
            assert_eq!(again.render(), rendered);
        }
    });
}

#[test]
fn a_setting_is_accepted_or_does_not_change_the_case() {
    let keys = prop_oneof![
        (0..FIELDS.len()).prop_map(|field| FIELDS[field].key.to_owned()),
        "limits\\.[a-z_]{0,20}",
        ".{0,20}"
    ];
    let value = prop_oneof![field_and_text().prop_map(|(_, text)| text), ".{0,20}"];
    hold(1500, &(keys, value), |(key, value)| {
        let mut case = Case::table_1();
        match case.set(&key, &value) {
            Ok(()) => drop(Document::new(case).render()),
            Err(problem) => {
                let message = problem.to_string();
                assert_safe(&message);
                assert!(!message.contains('\n'), "{message}");
                assert_eq!(case, Case::table_1());
            }
        }
    });
}

#[test]
fn the_headless_commands_report_errors_without_control_characters() {
    hold(30, &texts::mutated(), |text| assert_safe_headless(&text));
}

pub(crate) fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let text = prop_oneof![
        Just(String::new()),
        Just("2 kN".to_owned()),
        Just("1.50".to_owned()),
        prop::sample::select(&HOSTILE[..]).prop_map(str::to_owned)
    ];
    let edit = prop_oneof![
        8 => field_and_text().prop_map(|(field, text)| Edit::Field(field, text)),
        2 => (any::<Index>(), text).prop_map(|(at, text)| Edit::Limit(at, text)),
        1 => Just(Edit::Unspread),
        1 => field_and_text().prop_map(|(field, text)| Edit::Variant(field, text)),
        1 => Just(Edit::Invariant),
    ];
    prop::collection::vec(edit, 0..6)
}

impl Edit {
    pub(crate) fn apply(&self, case: &mut Case) {
        match self {
            Edit::Field(field, text) => case.write(*field, text),
            // An invalid limit does not change the case.
            Edit::Limit(at, text) => {
                drop(case.set_limit(QUANTITIES[at.index(QUANTITIES.len())].key, text));
            }
            Edit::Unspread => case.spread.clear(),
            Edit::Variant(field, text) => {
                let (mut edited, base) = (case.clone(), case.clone());
                edited.write(*field, text);
                let variant = Variant::between("fuzzed", &base, &edited);
                if edited.check_field(*field).is_ok() && !variant.overrides.is_empty() {
                    case.keep_variant(variant);
                }
            }
            Edit::Invariant => case.variants.clear(),
        }
    }
}

/// Comments on separate lines, or at the end of lines with only a table name.
fn with_comments(text: &str, comments: &[(Index, bool)]) -> String {
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    for (index, (at, at_header)) in comments.iter().enumerate() {
        let comment = format!("# kept {index}");
        let at = at.index(lines.len());
        match lines[at..].iter().position(|line| line.starts_with('[') && !line.contains('#')) {
            Some(below) if *at_header => lines[at + below].extend([" ", &comment]),
            _ => lines.insert(at, comment),
        }
    }
    lines.join("\n")
}

fn assert_bytes(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        read_and_solve(text);
    } else {
        let faults = Document::parse("bytes", bytes).expect_err("no text");
        assert_placed(&faults, &String::from_utf8_lossy(bytes));
    }
}

/// Checks that each command reports its outcome by the exit code and prints no control characters.
fn assert_safe_headless(text: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case \u{1b}[2J\u{202e}.toml");
    fs::write(&path, text).expect("room on the disk");
    for words in [
        &["solve"][..],
        &["solve", "--format", "json"],
        &["solve", "--format", "csv", "--stations", "3"],
        &["check"],
    ] {
        let (exit, output, errors) = run(words, path.as_os_str().to_owned());
        assert_safe(&output);
        assert_safe(&errors);
        assert!(exit != Exit::Usage && exit != Exit::Unreadable, "{exit:?}: {errors}");
        let is_silent = errors.is_empty();
        assert!((exit == Exit::Done) == is_silent || exit == Exit::Exceeded, "{exit:?}: {errors}");
    }
}

fn run(words: &[&str], case: OsString) -> (Exit, String, String) {
    let (mut output, mut errors) = (Vec::new(), Vec::new());
    let mut streams = Streams { output: Box::new(&mut output), errors: Box::new(&mut errors) };
    let line = ["tipstrike"].iter().chain(words).map(OsString::from).chain([case]);
    let exit = cli::parse(line, &mut streams)
        .and_then(|arguments| arguments.command.ok_or(Exit::Usage))
        .map_or_else(|exit| exit, |command| cli::run(&command, &mut streams));
    drop(streams);
    let text = |bytes| String::from_utf8(bytes).expect("a command writes text");
    (exit, text(output), text(errors))
}
