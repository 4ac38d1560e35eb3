//! Runs of the built program, without input.

use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// Table 1 with more lines, in a temporary folder.
pub(crate) fn table_1_with(lines: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let text = std::fs::read_to_string("cases/zhou-chen-2014.toml").unwrap();
    std::fs::write(&path, text + lines).unwrap();
    (folder, path.to_str().unwrap().to_owned())
}

/// The program with arguments, in the source folder.
pub(crate) fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tipstrike"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).stdin(Stdio::null());
    command
}

pub(crate) fn output(arguments: &[&str]) -> Output {
    program(arguments).output().unwrap()
}

/// Exit code, standard output and standard error of a run.
pub(crate) fn run(arguments: &[&str]) -> (i32, String, String) {
    texts(output(arguments))
}

/// The exit code, standard output and standard error of a run.
pub(crate) fn texts(output: Output) -> (i32, String, String) {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let code = output.status.code().unwrap();
    (code, text(output.stdout), text(output.stderr))
}

/// Standard output of a run that must succeed without messages.
pub(crate) fn stdout_of(arguments: &[&str]) -> String {
    let (code, text, errors) = run(arguments);
    assert_eq!((code, errors.as_str()), (0, ""), "{arguments:?}");
    text
}

/// Checks that a text has every part.
#[track_caller]
pub(crate) fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is missing: {text}");
    }
}

/// The words of a command line; blanks between single quotes stay.
pub(crate) fn words(line: &str) -> Vec<&str> {
    let mut all = Vec::new();
    for (at, part) in line.split('\'').enumerate() {
        if at % 2 == 1 {
            all.push(part);
        } else {
            all.extend(part.split_whitespace());
        }
    }
    all
}

/// A text with blanks in place of line ends.
pub(crate) fn in_a_line(page: &str) -> String {
    page.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A run of a command line, in which `TABLE_1` is that case.
pub(crate) fn ran(line: &str) -> (i32, String, String) {
    run(&words(&line.replace("TABLE_1", "cases/zhou-chen-2014.toml")))
}

/// Standard output of such a run, which must succeed without messages.
pub(crate) fn page(line: &str) -> String {
    let (code, text, errors) = ran(line);
    assert_eq!((code, errors.as_str()), (0, ""), "{line}");
    text
}

/// The JSON object that such a run prints.
pub(crate) fn json(line: &str) -> Value {
    serde_json::from_str(&page(line)).unwrap()
}

/// Checks that the page of each command line, without line ends, has every part and lacks those
/// behind `!`.
#[track_caller]
pub(crate) fn prints(rows: &[(&str, &[&str])]) {
    for (line, parts) in rows {
        let page = in_a_line(&page(line));
        for part in *parts {
            let is_right = match part.strip_prefix('!') {
                Some(absent) => !page.contains(absent),
                None => page.contains(part),
            };
            assert!(is_right, "{line}: {part:?}: {page}");
        }
    }
}
