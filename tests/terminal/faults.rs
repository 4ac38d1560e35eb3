//! Saves under injected faults: at every step that can fail or be the last, the old file or the new
//! one is complete.
use crate::tty::{Launch, PROGRAM, TABLE_1, is_there, skip};

use std::io::Write;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::sync::LazyLock;
use std::{env, fs};

use tempfile::TempDir;
use tipstrike::case::{Document, fields};

/// Every system call that creates, writes or renames a file.
const CALLS: &str = "openat,write,fsync,fdatasync,fchmod,fchown,lgetxattr,fgetxattr,fsetxattr,rename,renameat,renameat2,link,linkat,unlink,close,ftruncate";
/// More steps than any save has; the loop ends earlier, when no call is hit.
const MOST_STEPS: usize = 100;
/// Environment variable with the target of the disturbed save.
const TARGET: &str = "TIPSTRIKE_SAVE_TARGET";
const LIST: &str = "system.posix_acl_access";
const SAVED: i32 = 0;
const REFUSED: i32 = 5;

/// Not a test: the process whose calls are made to fail. It edits and saves the case, and reports
/// the result.
#[test]
fn saver() {
    let Some(path) = env::var_os(TARGET).map(std::path::PathBuf::from) else { return };
    let Ok(mut document) = Document::read(&path) else { std::process::exit(REFUSED) };
    document.case.write(fields::index_of("pair.module").expect("a field"), "6 mm");
    let result = document.save(&path);
    let is_unsaved = document.is_changed();
    assert_eq!(is_unsaved, result.is_err(), "the buffer is unsaved until the file is in place");
    match result {
        Ok(_) => std::process::exit(SAVED),
        Err(error) => {
            assert!(!error.to_string().contains('\n'));
            // Written directly, because the test harness captures the output.
            std::io::stderr().write_all(error.to_string().as_bytes()).expect("someone reads");
            std::process::exit(REFUSED)
        }
    }
}

/// The command that saves, without the output of the test harness.
fn saver_command(wrapper: &[&str], target: &Path) -> Command {
    let own = env::current_exe().expect("a path");
    let own = own.to_str().expect("a name in UTF-8");
    let test = [own, "--exact", "faults::saver", "--test-threads=1", "--quiet"];
    let words = [wrapper, &test].concat();
    let mut command = Command::new(words[0]);
    command
        .args(&words[1..])
        .env(TARGET, target)
        .env("RUST_BACKTRACE", "0")
        .env_remove("LD_LIBRARY_PATH")
        .stdin(Stdio::null());
    command
}

fn folder_with_case() -> (TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case.toml");
    fs::write(&path, TABLE_1).expect("room on the disk");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("our own file");
    if let Err(error) = xattr::set(&path, LIST, &entries(0)) {
        skip(&format!("access lists: {error}"));
    }
    (folder, path)
}

fn list(path: &Path) -> Option<Vec<u8>> {
    xattr::get(path, LIST).ok().flatten()
}

/// The access list of a new case; `None` if the file system does not support access lists.
fn list_of_a_case() -> Option<Vec<u8>> {
    static FRESH: LazyLock<Option<Vec<u8>>> = LazyLock::new(|| list(&folder_with_case().1));
    FRESH.clone()
}

fn new_text() -> String {
    TABLE_1.replace("\"5 mm\"", "\"6 mm\"")
}

/// Checks that the old file or the new one is complete, with its mode; and which one, if the saver
/// reported its result.
#[track_caller]
fn assert_old_or_new(path: &Path, code: Option<i32>, fault: &str) {
    let text = fs::read_to_string(path).expect("the file is there");
    let is_old = text == TABLE_1;
    assert!(is_old || text == new_text(), "{fault}: half a file: {text:?}");
    let mode = fs::metadata(path).expect("it is there").permissions().mode();
    assert_eq!(mode & 0o7777, 0o640, "{fault}");
    assert_eq!(list(path), list_of_a_case(), "{fault}");
    match code {
        Some(SAVED) => assert!(!is_old, "{fault}: reported as saved, but is not"),
        Some(REFUSED) => assert!(is_old, "{fault}: reported as refused, but is saved"),
        _ => {}
    }
}

/// Makes the N-th call of every kind fail or be the last, for rising N until no call is hit.
/// Returns their number.
fn under_every_fault(fault: &str, run: impl Fn(&[&str]) -> Output) -> usize {
    let mut hits = 0;
    for call in made(&run) {
        for step in 1.. {
            assert!(step <= MOST_STEPS, "{fault} is hit for ever");
            let inject = format!("inject={call}:{fault}:when={step}");
            let (output, log) = traced(&["-e", &format!("trace={call}"), "-e", &inject], &run);
            let is_injected = log.contains("(INJECTED)");
            if !is_injected && output.status.success() {
                break;
            }
            hits += 1;
            assert!(is_injected || output.status.signal().is_some(), "{fault} {output:?}");
        }
    }
    hits
}

/// The calls of an undisturbed save.
fn made(run: &impl Fn(&[&str]) -> Output) -> Vec<&'static str> {
    let (output, log) = traced(&["-e", &format!("trace={CALLS}")], run);
    assert!(output.status.success(), "{output:?}");
    let is_save = ["openat(", "write(", "fsync(", "rename"].iter().all(|call| log.contains(call));
    assert!(is_save, "not the calls of a save: {log}");
    // The data is on the disk before the rename, and the folder before the save returns.
    let calls: Vec<_> =
        log.lines().filter(|line| line.contains("fsync(") || line.contains("rename")).collect();
    let at = calls.iter().position(|line| line.contains("rename")).expect("a name");
    assert!(calls[..at].iter().any(|line| line.contains("fsync(")), "{log}");
    assert!(calls[at..].iter().any(|line| line.contains("fsync(")), "{log}");
    CALLS.split(',').filter(|call| log.contains(&format!(" {call}("))).collect()
}

fn traced(options: &[&str], run: &impl Fn(&[&str]) -> Output) -> (Output, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("log");
    let place = log.to_str().expect("a name in UTF-8");
    let output =
        run(&[&["strace", "-f", "-qq", "--signal=none", "-o", place], options, &["--"]].concat());
    (output, fs::read_to_string(&log).expect("strace writes its log"))
}

fn error_of(fault: &str) -> bool {
    fault.starts_with("error")
}

const FAULTS: [&str; 6] =
    ["error=ENOSPC", "error=EIO", "error=EDQUOT", "error=EROFS", "error=EINTR", "signal=KILL"];

#[test]
fn a_save_leaves_the_old_file_or_the_new_one_at_every_fault() {
    if !is_there("strace") {
        return;
    }
    for fault in FAULTS {
        let steps = under_every_fault(fault, |strace| {
            let (_folder, path) = folder_with_case();
            let output = saver_command(strace, &path).output().expect("strace starts");
            assert_old_or_new(&path, output.status.code().filter(|_| error_of(fault)), fault);
            output
        });
        println!("a save, {fault}: {steps} steps");
        assert!(steps >= 12, "{fault}: a save has more than {steps} steps");
    }
}

#[test]
fn a_new_case_is_there_whole_or_not_at_all_at_every_fault() {
    if !is_there("strace") {
        return;
    }
    let whole = Command::new(PROGRAM).arg("new").output().expect("the program starts").stdout;
    for fault in FAULTS {
        let steps = under_every_fault(fault, |strace| {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("new.toml");
            let mut command = Command::new(strace[0]);
            command.args(&strace[1..]).args([PROGRAM, "new"]).arg(&path);
            let output = command.env_remove("LD_LIBRARY_PATH").output().expect("strace starts");
            match fs::read(&path) {
                Ok(text) => assert_eq!(text, whole, "{fault}: half a file"),
                Err(_) => assert!(!output.status.success(), "{fault}: reported as written"),
            }
            let left = fs::read_dir(folder.path()).expect("a folder").count();
            assert!(!error_of(fault) || left <= usize::from(path.exists()), "{fault}");
            output
        });
        println!("new, {fault}: {steps} steps");
        assert!(steps >= 15, "{fault}: it has more than {steps} steps");
    }
}

#[test]
fn a_limit_on_the_size_of_files_is_reported_and_leaves_the_old_file() {
    if !is_there("prlimit") {
        return;
    }
    // With the signal of that limit ignored, as under many job systems, and with the signal.
    for (ignored, shell) in [(true, r#"trap '' XFSZ; exec "$@""#), (false, r#"exec "$@""#)] {
        for most in [0, 1, 500] {
            let (folder, path) = folder_with_case();
            let limit = format!("--fsize={most}");
            let limited = ["sh", "-c", shell, "sh", "prlimit", &limit];
            let output = saver_command(&limited, &path).output().expect("sh starts");
            let code = output.status.code();
            assert!(!ignored || code == Some(REFUSED), "{most}: {output:?}");
            assert_old_or_new(&path, code, "file size limit");
            assert_eq!(fs::read_to_string(&path).expect("it is there"), TABLE_1);
            let new = folder.path().join("new.toml");
            let mut command = Command::new("sh");
            command.args([&limited[1..], &[PROGRAM, "new"]].concat()).arg(&new);
            let output = command.output().expect("sh starts");
            assert_eq!(output.status.code(), Some(REFUSED), "{output:?}");
            let words = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(words.contains("new.toml: cannot be written"), "{words}");
            assert!(words.lines().count() == 1 && !new.exists(), "{words}");
        }
    }
}

#[test]
fn a_full_disk_is_reported_and_leaves_the_old_file() {
    let script = r#"mount -t tmpfs -o size=16k none "$0" && cp "$1" "$0/case.toml" && chmod 640 "$0/case.toml" || exit 9
        head -c 100k /dev/zero >"$0/filler" 2>/dev/null
        "$2" --exact faults::saver --test-threads=1 --quiet; saved=$?
        "$3" new "$0/new.toml"; made=$?
        cmp "$0/case.toml" "$1" && test ! -e "$0/new.toml" && echo same $saved $made"#;
    let may =
        Command::new("unshare").args(["-rm", "mount", "-t", "tmpfs", "none", "/mnt"]).output();
    if !may.as_ref().is_ok_and(|output| output.status.success()) {
        return skip("no mounts without privileges here (unshare -rm)");
    }
    let (folder, path) = folder_with_case();
    let disk = folder.path().join("disk");
    fs::create_dir(&disk).expect("a folder");
    let own = env::current_exe().expect("a path");
    let mut command = Command::new("unshare");
    command.args(["-rm", "sh", "-c", script]).args([&disk, &path, &own]).arg(PROGRAM);
    let output = command
        .env(TARGET, disk.join("case.toml"))
        .env("RUST_BACKTRACE", "0")
        .output()
        .expect("unshare starts");
    let words = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(words.contains(&format!("same {REFUSED} 5")), "{output:?}");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("make room on the disk"),
        "{output:?}"
    );
}

#[test]
fn a_folder_that_may_not_be_written_leaves_the_old_file() {
    let (folder, path) = folder_with_case();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).expect("our own folder");
    // The superuser runs this as nobody; folder and file then also belong to nobody.
    let is_root = fs::File::create(folder.path().join("probe")).is_ok();
    let wrapper: &[&str] = if is_root {
        &["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--inh-caps=-all", "--"]
    } else {
        &[]
    };
    if is_root {
        let status = Command::new("chown").args(["-R", "65534:65534"]).arg(folder.path()).status();
        if !is_there("setpriv") || !status.expect("chown is there").success() {
            return;
        }
    }
    let output = saver_command(wrapper, &path).output().expect("it starts");
    let code = output.status.code();
    if code != Some(REFUSED) && code != Some(SAVED) {
        skip(&format!("the test cannot be started as nobody: {output:?}"));
    } else {
        assert_eq!(code, Some(REFUSED), "{output:?}");
        assert_old_or_new(&path, code, "closed folder");
    }
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).expect("our own folder");
}

/// An access list in the format of the kernel: version 2, then tag, permissions and id, 8 bytes
/// each.
fn entries(group: u16) -> Vec<u8> {
    const NOBODY_IN_PARTICULAR: u32 = u32::MAX;
    let entries: [(u16, u16, u32); 5] = [
        (1, 6, NOBODY_IN_PARTICULAR),
        (2, 4, 65533),
        (4, group, NOBODY_IN_PARTICULAR),
        (16, 4, NOBODY_IN_PARTICULAR),
        (32, 0, NOBODY_IN_PARTICULAR),
    ];
    let bytes = entries.iter().flat_map(|(tag, may, who)| {
        [&tag.to_le_bytes()[..], &may.to_le_bytes(), &who.to_le_bytes()].concat()
    });
    2_u32.to_le_bytes().into_iter().chain(bytes).collect()
}

#[test]
fn a_save_keeps_the_access_list_and_inherits_none() {
    let (folder, path) = folder_with_case();
    let save = |path: &Path| {
        let output = saver_command(&[], path).output().expect("it starts");
        assert_eq!(output.status.code(), Some(SAVED), "{output:?}");
        assert_eq!(fs::read_to_string(path).expect("it is there"), new_text());
    };
    if list_of_a_case().is_none() {
        return;
    }
    save(&path);
    assert_eq!(list(&path), list_of_a_case(), "the group gains no rights from the mask");
    assert_eq!(fs::metadata(&path).expect("it is there").permissions().mode() & 0o7777, 0o640);
    // A folder whose default list opens new files to others does not open an old file.
    let plain = folder.path().join("plain.toml");
    fs::write(&plain, TABLE_1).expect("room on the disk");
    let of_new_files = "system.posix_acl_default";
    xattr::set(folder.path(), of_new_files, &entries(4)).expect("a list for new files");
    save(&plain);
    assert_eq!(list(&plain), None);
}

#[test]
fn a_file_of_another_user_keeps_its_owner_or_is_not_changed() {
    let nobody =
        "setpriv --reuid=65534 --regid=65534 --clear-groups --inh-caps=-all --bounding-set=-all --";
    let nobody: Vec<&str> = nobody.split(' ').collect();
    let become_nobody = || Command::new(nobody[0]).args(&nobody[1..]).arg("true").status();
    if !is_there("setpriv") || !become_nobody().is_ok_and(|status| status.success()) {
        return skip("this process cannot become nobody");
    }
    // In writable folders: one in which everybody may rename every file, and one in which everybody
    // may rename only his own.
    for mode in [0o777, 0o1777].map(fs::Permissions::from_mode) {
        let (folder, path) = folder_with_case();
        fs::set_permissions(folder.path(), mode).expect("our own folder");
        // The access list permits nobody to read only.
        drop(xattr::remove(&path, LIST));
        fs::set_permissions(&path, fs::Permissions::from_mode(0o666)).expect("our own file");
        let output = saver_command(&nobody, &path).output().expect("it starts");
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        if ![Some(SAVED), Some(REFUSED)].contains(&output.status.code()) {
            return skip(&format!("the test cannot be started as nobody: {output:?}"));
        }
        assert_eq!(output.status.code(), Some(REFUSED), "{words}");
        let is_told = words.contains("belongs to user 0");
        assert!(is_told && words.contains("save under another name"), "{words}");
        assert_eq!(fs::read_to_string(&path).expect("it is there"), TABLE_1);
        let left = fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(left, 1, "no other file remains");
    }
    // The superuser may change the owner of files.
    let (_folder, path) = folder_with_case();
    std::os::unix::fs::chown(&path, Some(65534), Some(65534)).expect("we may");
    assert_eq!(saver_command(&[], &path).output().expect("it starts").status.code(), Some(SAVED));
    let about = fs::metadata(&path).expect("it is there");
    assert_eq!((about.uid(), about.gid(), about.mode() & 0o7777), (65534, 65534, 0o640));
}

#[test]
fn a_failed_save_of_the_workbench_is_reported_and_the_edits_stay() {
    if !is_there("strace") {
        return;
    }
    for call in ["fsync", "fchmod", "rename,renameat,renameat2"] {
        for fault in ["error=ENOSPC", "error=EIO"] {
            let mut tty = Launch::on_table_1().under_fault(call, fault, None).start();
            tty.wait_for("Corner contact");
            tty.type_for("\x156 mm\x13", "not saved: ");
            assert!(tty.shows("*unsaved*"), "{call} {fault}");
            assert_eq!(fs::read_to_string(tty.case()).expect("it is there"), TABLE_1);
            tty.discard();
            let left = fs::read_dir(tty.folder.path()).expect("a folder").flatten();
            let mut left = left.map(|entry| entry.file_name().to_string_lossy().into_owned());
            assert!(left.all(|name| !name.starts_with(".tipstrike")), "{call} {fault}");
        }
    }
}

#[test]
fn a_read_error_during_a_save_is_named_and_is_no_change_on_disk() {
    if !is_there("strace") {
        return;
    }
    // The first calls on the file open and read it when the program starts.
    for (call, step) in [("openat", 2), ("openat", 3), ("read", 9), ("read", 14)] {
        let launch = Launch::on_table_1();
        let case = launch.case();
        let fault = format!("error=EIO:when={step}");
        let mut tty = launch.under_fault(call, &fault, Some(&case)).shown("Corner contact");
        tty.type_for("\x156 mm\x13", "not saved: ");
        tty.wait_for("Input/output error");
        assert!(!tty.shows("has changed on disk"), "{call} {step}");
        assert!(tty.shows("*unsaved*"), "{call} {step}");
        tty.type_for("\x13", "saved ");
        tty.wait_until("the mark to go", |tty| !tty.shows("*unsaved*"));
        tty.quit();
        assert!(fs::read_to_string(case).is_ok_and(|text| text == new_text()));
    }
}

#[test]
fn a_full_output_is_reported_and_a_closed_one_is_not() {
    let commands = "new,fields,man,completions bash,solve case.toml,solve --format json case.toml";
    for command in commands.split(',') {
        let (folder, _) = folder_with_case();
        let run = |shell: &str| {
            let line = format!("{PROGRAM} {command} {shell}");
            let mut bash = Command::new("bash");
            bash.args(["-c", &line]).current_dir(folder.path()).output().expect("bash starts")
        };
        let full = run(">/dev/full");
        let words = String::from_utf8_lossy(&full.stderr).into_owned();
        assert_eq!(full.status.code(), Some(5), "{command}: {words}");
        let is_told = words.contains("standard output: cannot be written");
        assert!(is_told && words.lines().count() == 1, "{command}: {words}");
        for reader in ["head -c 1 >/dev/null", "true"] {
            let closed = run(&format!("| {reader}; exit ${{PIPESTATUS[0]}}"));
            assert_eq!(closed.status.code(), Some(0), "{command} | {reader}");
            assert!(closed.stderr.is_empty(), "{command} | {reader}: {closed:?}");
        }
    }
}
