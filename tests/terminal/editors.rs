//! The same faults for the workbench and for common editors: the state of the file and of the typed
//! text.
use crate::tty::{Launch, PROGRAM, TABLE_1, Tty, is_there, skip};

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use std::{fs, thread};

/// The typed text, which no file contains before.
const TYPED: &str = "6.8125 mm";
const QUIET: Duration = Duration::from_millis(150);
const ATTEMPTS: usize = 20;
const WHOLE: &str = "file whole";
/// Up to this length of comments a case fits one page.
const PAGE: usize = 4096;

/// A program that edits a text file.
struct Editor {
    name: &'static str,
    /// A text on its screen when it is ready.
    ready: &'static str,
    /// Keys before and after the typed text.
    typing: (&'static str, &'static str),
    save: &'static str,
}

const EDITORS: [Editor; 4] = [
    Editor { name: "tipstrike", ready: "Corner contact", typing: ("\x15", ""), save: "\x13" },
    Editor { name: "vim", ready: "format = 1", typing: ("i# ", "\x1b"), save: ":w\r" },
    Editor { name: "nano", ready: "format = 1", typing: ("# ", ""), save: "\x13" },
    Editor { name: "micro", ready: "format = 1", typing: ("# ", ""), save: "\x13" },
];

const FAULTS: [&str; 4] = [
    "dies at the first write of a save",
    "the disk is full",
    "the terminal hangs up",
    "kill -9 after 2.2 s",
];

/// The state after a fault.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Left {
    file: String,
    typed: bool,
}

impl Left {
    fn words(&self) -> String {
        format!("{}, typed text {}", self.file, if self.typed { "kept" } else { "**lost**" })
    }
}

#[test]
fn the_workbench_loses_nothing_where_editors_do() {
    if !is_there("strace") {
        return;
    }
    let editors: Vec<_> = EDITORS
        .iter()
        .filter(|editor| editor.name == "tipstrike" || is_there(editor.name))
        .collect();
    let heads: Vec<_> = editors.iter().map(|editor| editor.name).collect();
    println!("| | {} |\n|---|{}", heads.join(" | "), "---|".repeat(heads.len()));
    for fault in FAULTS {
        let left: Vec<_> = thread::scope(|scope| {
            let runs: Vec<_> =
                editors.iter().map(|editor| scope.spawn(move || under(editor, fault))).collect();
            runs.into_iter().map(|run| run.join().expect("it runs to its end")).collect()
        });
        let cells: Vec<_> = left
            .iter()
            .map(|left| left.as_ref().map_or("not tried".to_owned(), Left::words))
            .collect();
        println!("| {fault} | {} |", cells.join(" | "));
        if let Some(ours) = &left[0] {
            assert!(ours.typed && ours.file == WHOLE, "{fault}: {ours:?}");
        }
    }
}

fn under(editor: &Editor, fault: &str) -> Option<Left> {
    match fault {
        "dies at the first write of a save" if editor.name == "tipstrike" => {
            Some(killed_at_the_write_beside(editor))
        }
        "dies at the first write of a save" => Some(killed_at_its_write(editor)),
        "the disk is full" => on_a_full_disk(editor),
        "the terminal hangs up" => Some(after(editor, Tty::hang_up)),
        _ => Some(after(editor, |tty| {
            let end = Instant::now() + Duration::from_millis(2200);
            while Instant::now() < end {
                tty.take_output(QUIET);
            }
            tty.send_signal("KILL");
        })),
    }
}

/// An editor on the case, run through another program.
fn launch(editor: &Editor, folder: Launch, wrapper: &[&str]) -> Launch {
    let home = folder.folder.path().to_str().expect("a name in UTF-8").to_owned();
    let program = if editor.name == "tipstrike" { PROGRAM } else { editor.name };
    folder.instead(program).through(wrapper).variable("HOME", &home)
}

/// Opens the editor and types. Returns false if it ended before.
fn type_in(tty: &mut Tty, editor: &Editor) -> bool {
    let keys = [editor.typing.0, TYPED, editor.typing.1].concat();
    wait(tty, editor.ready) && {
        tty.settle(QUIET);
        tty.try_to_type(keys.as_bytes()).is_ok() && wait(tty, TYPED)
    }
}

/// Waits for a text or for the end. Returns whether the text appeared.
fn wait(tty: &mut Tty, text: &str) -> bool {
    let text = text.to_owned();
    tty.wait_until(&format!("{text:?} or the end"), |tty| tty.shows(&text) || tty.has_ended());
    !tty.has_ended()
}

fn after(editor: &Editor, fault: impl Fn(&mut Tty)) -> Left {
    let folder = Launch::on_table_1();
    fs::write(folder.case(), old_text()).expect("room on the disk");
    let mut tty = launch(editor, folder, &[]).start();
    assert!(type_in(&mut tty, editor), "{}", editor.name);
    fault(&mut tty);
    tty.wait_for_end();
    left(&tty)
}

/// Killed at the first write to the file itself.
fn killed_at_its_write(editor: &Editor) -> Left {
    let folder = Launch::on_table_1();
    fs::write(folder.case(), old_text()).expect("room on the disk");
    let case = folder.case();
    let fault = "signal=KILL:when=1";
    let launch = launch(editor, folder, &[]);
    let mut tty = launch.under_fault("write,pwrite64,writev", fault, Some(&case)).start();
    assert!(type_in(&mut tty, editor), "{}", editor.name);
    tty.type_in(editor.save);
    tty.wait_for_end();
    left(&tty)
}

/// Killed at the first write of a save to a temporary file, which is found by its position among
/// the writes; this position varies slightly.
fn killed_at_the_write_beside(editor: &Editor) -> Left {
    let mut step = usize::MAX;
    for _ in 0..ATTEMPTS {
        let folder = Launch::on_table_1();
        fs::write(folder.case(), old_text()).expect("room on the disk");
        let log = folder.folder.path().join("log").display().to_string();
        let beside = folder.folder.path().join(".tipstrike-").display().to_string();
        let inject = format!("inject=write:signal=KILL:when={}", step.min(usize::from(u16::MAX)));
        let strace =
            ["strace", "-f", "-y", "-qq", "-o", &log, "-e", "trace=write", "-e", &inject, "--"];
        let mut tty = launch(editor, folder, &strace).start();
        if type_in(&mut tty, editor) && tty.try_to_type(editor.save.as_bytes()).is_ok() {
            tty.wait_until("the save or the end", |tty| tty.shows("saved ") || tty.has_ended());
        }
        let (has_died, left, log) =
            (tty.has_ended(), left(&tty), fs::read_to_string(&log).unwrap_or_default());
        assert_eq!(left.file, WHOLE);
        let writes: Vec<_> = log.lines().filter(|line| line.contains(" write(")).collect();
        let at = writes.iter().position(|line| line.contains(&beside));
        match at {
            Some(at) if has_died && at + 1 == writes.len() => return left,
            // Counted separately for each thread.
            Some(at) => {
                step = writes[..=at]
                    .iter()
                    .filter(|line| thread_of(line) == thread_of(writes[at]))
                    .count();
            }
            None => step += 1,
        }
    }
    panic!("no write of a save was hit in {ATTEMPTS} attempts");
}

fn thread_of(line: &str) -> Option<&str> {
    line.split_whitespace().next()
}

/// On a full disk, which requires a mount namespace.
fn on_a_full_disk(editor: &Editor) -> Option<Left> {
    let may =
        Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "none", "/mnt"]).output();
    if !may.is_ok_and(|output| output.status.success()) {
        skip("no mounts without privileges here (unshare -rm)");
        return None;
    }
    let folder = Launch::on_table_1();
    let (case, disk, last) =
        (folder.case(), folder.folder.path().join("disk"), folder.folder.path().join("last"));
    fs::write(&case, old_text()).expect("room on the disk");
    // The fallback folder of vim if there is no room beside the file.
    fs::create_dir(&disk)
        .and_then(|()| fs::create_dir(folder.folder.path().join("tmp")))
        .expect("a folder");
    // The editor works on a copy on the full disk; the final content is copied back.
    let script = r#"trap : HUP
        mount -t tmpfs -o size=16k none "$0" && cp "$1" "$0/case.toml" || exit 9
        head -c 100k /dev/zero >"$0/filler" 2>/dev/null
        shift; last=$1; shift
        "$@" "$0/case.toml"; cp "$0/case.toml" "$last""#;
    let program = if editor.name == "tipstrike" { PROGRAM } else { editor.name };
    let (case, disk) = (case.display().to_string(), disk.display().to_string());
    let words = ["-rm", "sh", "-c", script, &disk, &case, &last.display().to_string(), program];
    let bare = Launch::of(folder.folder.clone())
        .instead("unshare")
        .variable("HOME", &folder.folder.path().display().to_string());
    let mut tty = words.iter().fold(bare, Launch::argument).start();
    assert!(type_in(&mut tty, editor), "{}", editor.name);
    tty.type_in(editor.save);
    tty.settle(QUIET);
    let typed = tty.shows(TYPED);
    // The whole process group is killed, so that the shell writes the file last.
    let all = format!("-{}", tty.id());
    assert!(
        Command::new("kill")
            .args(["-s", "HUP", "--", &all])
            .status()
            .is_ok_and(|status| status.success())
    );
    tty.wait_until("the copy", |_| last.exists());
    tty.settle(QUIET);
    Some(Left { file: file(&last), typed: typed || kept(tty.folder.path()) })
}

fn left(tty: &Tty) -> Left {
    Left { file: file(&tty.case()), typed: kept(tty.folder.path()) }
}

fn old_text() -> String {
    let text = TABLE_1.to_owned();
    let rest = PAGE - text.len() - "# \n".len() - 1;
    text + "# " + &".".repeat(rest) + "\n"
}

/// The old text, or the new one: the typed text replaces a value or precedes the first line.
fn file(path: &Path) -> String {
    let (text, old) = (fs::read_to_string(path).unwrap_or_default(), old_text());
    let new = [old.replace("\"5 mm\"", &format!("\"{TYPED}\"")), format!("# {TYPED}{old}")];
    if text == old || new.contains(&text) {
        WHOLE.to_owned()
    } else {
        format!("**file cut to {} bytes**", text.len())
    }
}

/// Whether any file contains the typed text.
fn kept(folder: &Path) -> bool {
    files(folder).iter().filter(|path| !path.ends_with("log")).any(|path| {
        fs::read(path)
            .is_ok_and(|bytes| bytes.windows(TYPED.len()).any(|part| part == TYPED.as_bytes()))
    })
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}
