//! Typed text survives: journaled in time, offered again, not trusted if damaged; and only one
//! session writes a case.
use crate::tty::{Launch, PATIENCE, TABLE_1, Tty, has_faults_on_demand, is_there, journals, stat};

use std::fs;
use std::fs::Permissions;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use ratatui::layout::Size;
use tipstrike::case::{Document, fields};
use tipstrike::tui::testing::{App, Autosave, Journal, JournalWriter, Look, State};

const SECOND: Duration = Duration::from_secs(1);
const OFFER: &str = "Unsaved edits found";

/// The workbench on Table 1, ready for keys, with the focus on the module.
fn opened() -> Tty {
    let mut tty = Tty::open();
    tty.wait_for("Corner contact");
    tty
}

/// The same case in the same folder in a second session.
fn again(tty: &Tty) -> Tty {
    let case = tty.case();
    Launch::of(Arc::clone(&tty.folder)).argument(case).start()
}

fn wait_for_journal(tty: &mut Tty, text: &str) {
    let state = tty.folder.path().to_owned();
    let has = |path: &PathBuf| fs::read_to_string(path).is_ok_and(|kept| kept.contains(text));
    tty.wait_until(&format!("journal with {text:?}"), |_| journals(&state).iter().any(has));
}

/// A case in memory, with its autosave.
fn bench(folder: &Path) -> (App, Autosave, Arc<JournalWriter>) {
    let path = folder.join("case.toml");
    fs::write(&path, TABLE_1).expect("room on the disk");
    let document = Document::read(&path).expect("a good case");
    let app = tipstrike::tui::testing::opened(document, Some(path), Look::FULL, Size::new(80, 24));
    let journal_writer = JournalWriter::open(|warning| panic!("{warning}")).expect("a thread");
    let state = State::choose(Some(folder.join("tipstrike")), []);
    (app, Autosave::new(state, Arc::clone(&journal_writer)), journal_writer)
}

fn write(app: &mut App, key: &str, text: &str) {
    app.tab.case.write(fields::index_of(key).expect("a field"), text);
}

#[test]
fn edits_are_journaled_a_second_after_the_last_and_every_two_during_typing() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut app, mut autosave, _chest) = bench(folder.path());
    let start = Instant::now();
    assert!(autosave.follow(&app.sheets(), start).is_empty());
    assert_eq!(autosave.deadline(), None, "without edits there is no deadline");
    write(&mut app, "pair.module", "6 mm");
    autosave.follow(&app.sheets(), start);
    assert!(autosave.deadline().is_some_and(|deadline| deadline <= start + SECOND));
    for tenth in 1..40 {
        let now = start + SECOND / 10 * tenth;
        write(&mut app, "pair.module", &format!("6.{tenth} mm"));
        autosave.follow(&app.sheets(), now);
        let deadline = autosave.deadline().expect("there is something to keep");
        assert!(deadline <= start + 2 * SECOND && deadline <= now + SECOND, "{tenth}");
    }
    autosave.keep_if_due(start + 2 * SECOND);
    assert_eq!(autosave.deadline(), None, "journaled edits have no deadline");
    autosave.follow(&app.sheets(), start + 3 * SECOND);
    assert_eq!(autosave.deadline(), None, "journaled edits are not written again");
    autosave.end();
}

#[test]
fn a_journal_is_there_as_long_as_there_are_unsaved_edits() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut app, mut autosave, _chest) = bench(folder.path());
    autosave.follow(&app.sheets(), Instant::now());
    write(&mut app, "pair.module", "no \u{1b}[2J number");
    autosave.follow(&app.sheets(), Instant::now());
    autosave.keep();
    let path = journals(folder.path()).pop().expect("a journal");
    let journal =
        Journal::from_text(&fs::read_to_string(path).expect("it is there")).expect("whole");
    assert_eq!(journal.case.as_deref(), Some(folder.path().join("case.toml").as_path()));
    assert_eq!(journal.changes.len(), 1);
    assert_eq!(journal.changes[0].to.as_deref(), Some("no \u{1b}[2J number"));
    app.tab.case = app.tab.document.loaded().clone();
    autosave.follow(&app.sheets(), Instant::now());
    autosave.keep();
    assert!(journals(folder.path()).is_empty());
    write(&mut app, "pair.module", "6 mm");
    autosave.follow(&app.sheets(), Instant::now());
    autosave.end();
    assert!(journals(folder.path()).is_empty(), "an intended end leaves no journal");
    assert!(!folder.path().join(".case.toml.tipstrike").exists());
}

#[test]
fn a_failed_journal_is_written_as_soon_as_possible() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut app, mut autosave, journal_writer) = bench(folder.path());
    autosave.follow(&app.sheets(), Instant::now());
    write(&mut app, "pair.module", "6 mm");
    autosave.follow(&app.sheets(), Instant::now());
    let place = folder.path().join("tipstrike/journals");
    fs::remove_dir_all(&place).expect("our own folder");
    assert!(journal_writer.write(false).is_err() && journal_writer.is_needed());
    fs::create_dir(&place).expect("our own folder");
    assert!(journal_writer.write(false).is_ok());
    let kept = journals(folder.path()).pop().expect("a journal");
    assert!(fs::read_to_string(kept).is_ok_and(|text| text.contains("6 mm")));
    autosave.end();
}

#[test]
fn the_journal_of_recovered_edits_is_replaced_in_one_step() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut app, mut autosave, _chest) = bench(folder.path());
    autosave.follow(&app.sheets(), Instant::now());
    let old = folder.path().join("tipstrike/journals/case-old.toml");
    fs::create_dir_all(old.parent().expect("a folder")).expect("our own folder");
    fs::write(&old, "the edits of an earlier session").expect("room on the disk");
    write(&mut app, "pair.module", "6 mm");
    autosave.adopt(old.clone());
    autosave.follow(&app.sheets(), Instant::now());
    assert!(old.exists(), "no other file has the edits");
    autosave.keep();
    assert_eq!(journals(folder.path()), std::slice::from_ref(&old));
    assert!(fs::read_to_string(old).is_ok_and(|text| text.contains("6 mm")));
    autosave.end();
    assert!(journals(folder.path()).is_empty());
}

#[test]
fn edits_that_cannot_be_written_to_a_journal_are_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut app, mut autosave, _chest) = bench(folder.path());
    autosave.follow(&app.sheets(), Instant::now());
    fs::write(folder.path().join("tipstrike"), "no folder").expect("room on the disk");
    write(&mut app, "pair.module", "6 mm");
    let claims = autosave.follow(&app.sheets(), Instant::now());
    let [Err(text)] = &claims[..] else { panic!("{claims:?}") };
    assert!(text.contains("save the case, or a crash loses the edits"), "{text}");
    drop(autosave);
    let mut homeless = Autosave::new(State::choose(None, []), Arc::new(JournalWriter::default()));
    let claims = homeless.follow(&app.sheets(), Instant::now());
    assert!(matches!(&claims[..], [Ok(claim)] if claim.notices[0].contains("HOME")), "{claims:?}");
}

#[test]
fn a_case_without_a_lock_is_named_and_its_file_is_still_compared() {
    for cause in ["is a symbolic link", "is a folder"] {
        let launch = Launch::on_table_1().size(24, 200);
        let lock = launch.folder.path().join(".case.toml.tipstrike");
        let planted = match cause {
            "is a folder" => fs::create_dir(lock),
            _ => symlink("/nonexistent", lock),
        };
        planted.expect("our own folder");
        let mut tty = launch.shown("case.toml is not locked, so other sessions may save it too");
        tty.wait_for(&format!("{cause}: remove that"));
        let mut second = again(&tty);
        second.wait_for("case.toml is not locked");
        tty.type_for("\x156 mm\x13", "saved ");
        second.type_for("\x157 mm\x13", "The file has changed on disk");
        second.type_for("c\x11", "has unsaved edits");
        second.type_in("d");
        second.wait_for_end();
        tty.quit();
        assert!(fs::read_to_string(tty.case()).is_ok_and(|text| text.contains("6 mm")));
    }
}

#[test]
fn a_folder_or_file_system_without_locks_is_reported() {
    if !is_there("strace") {
        return;
    }
    for (call, error, cause) in [
        ("openat", "EROFS", "its folder is read-only: save it elsewhere"),
        ("openat", "EACCES", "its folder is read-only: save it elsewhere"),
        ("openat", "EIO", "Input/output error: open it only once"),
        ("flock", "EOPNOTSUPP", "Operation not supported: open it only once"),
    ] {
        let launch = Launch::on_table_1().size(24, 200);
        let lock = launch.folder.path().join(".case.toml.tipstrike");
        let mut tty = launch.under_fault(call, &format!("error={error}"), Some(&lock)).shown(cause);
        tty.type_for("\x156 mm\x13", "saved ");
        tty.quit();
        assert!(fs::read_to_string(tty.case()).is_ok_and(|text| text.contains("6 mm")));
    }
}

#[test]
fn journals_of_other_cases_are_reported_once_and_deleted_in_one_place() {
    let mut tty = opened();
    tty.type_in("\x151.25 in");
    wait_for_journal(&mut tty, "1.25 in");
    tty.end_by("KILL");
    let other = tty.folder.path().join("other.toml");
    fs::write(&other, TABLE_1).expect("room on the disk");
    let mut next = Launch::of(Arc::clone(&tty.folder)).argument(&other).start();
    next.wait_for("case.toml: unsaved edits of an ended session");
    next.type_for("\x156 mm\x1bOQthird\r", "saved ");
    next.settle(Duration::from_millis(100));
    assert!(next.shows("saved ") && !next.shows("ended session"));
    next.type_for("\x10journals\r", "case.toml: 1 edit");
    next.type_in("d");
    next.wait_until("no question", |tty| !tty.shows("Delete all"));
    assert!(journals(next.folder.path()).is_empty());
    next.type_for("\x10journals\r", "no ended session left unsaved edits");
    next.quit();
}

#[test]
fn journals_keep_away_from_a_folder_that_others_may_write() {
    let launch = Launch::on_table_1().size(24, 200);
    let folder = Arc::clone(&launch.folder);
    let state = folder.path().join("tipstrike");
    let (elsewhere, run) = (folder.path().join("theirs"), folder.path().join("run"));
    for place in [&state, &elsewhere, &run] {
        fs::create_dir(place).expect("our own folder");
    }
    symlink(&elsewhere, state.join("journals")).expect("a link");
    fs::set_permissions(&run, Permissions::from_mode(0o700)).expect("our own folder");
    fs::set_permissions(&state, Permissions::from_mode(0o777)).expect("our own folder");
    let run = run.to_str().expect("UTF-8");
    let mut tty = launch.variable("XDG_RUNTIME_DIR", run).shown("others may write in");
    tty.wait_for("Until then the journals are in");
    tty.type_for("\x156 mm", "6 mm");
    tty.end_by("TERM");
    let is_empty = |place: &Path| fs::read_dir(place).is_ok_and(|mut files| files.next().is_none());
    assert!(is_empty(&elsewhere));
    assert!(!state.join("last-case").exists());
    let kept = fs::read_dir(folder.path().join("run/tipstrike/journals"));
    assert_eq!(kept.expect("a folder").count(), 1);
    let next = Launch::of(Arc::clone(&folder)).argument(folder.path().join("case.toml"));
    let mut next = next.variable("XDG_RUNTIME_DIR", run).shown(OFFER);
    next.type_for("\r", "the edits are restored");
    next.type_for("\x13", "saved ");
    next.quit();
    assert!(is_empty(&folder.path().join("run/tipstrike/journals")));
}

#[test]
fn a_journal_folder_that_disappears_is_reported_and_a_save_still_works() {
    let mut tty = opened();
    tty.type_in("\x151.25 in");
    wait_for_journal(&mut tty, "1.25 in");
    fs::remove_dir_all(tty.folder.path().join("tipstrike/journals")).expect("our own folder");
    tty.type_for("\x151.5 in", "a crash would lose unsaved edits");
    tty.type_for("\x13", "saved ");
    tty.quit();
    assert!(fs::read_to_string(tty.case()).is_ok_and(|text| text.contains("1.5 in")));
}

#[test]
fn kill_9_after_two_seconds_loses_nothing() {
    let mut tty = opened();
    let typed = Instant::now();
    tty.type_in("\x151.2");
    wait_for_journal(&mut tty, "1.2");
    println!("kept {:.2?} after the last key", typed.elapsed());
    tty.type_in("5 in");
    let end = Instant::now() + Duration::from_millis(2200);
    while Instant::now() < end {
        tty.take_output(SECOND / 10);
    }
    tty.end_by("KILL");
    let mut next = again(&tty);
    next.wait_for(OFFER);
    next.assert(next.shows("module: 5 mm -> 1.25 in"));
    assert!(!next.shows("*unsaved*"), "nothing is taken over unasked");
    next.type_for("\r", "the edits are restored");
    next.assert(next.shows("1.25 in") && next.shows("*unsaved*"));
    next.type_in("\x1a");
    next.wait_until("the edits to be undone", |tty| !tty.shows("*unsaved*"));
    next.type_for("\x19\x13", "saved ");
    next.quit();
    assert_eq!(
        fs::read_to_string(next.case()).expect("it is there"),
        TABLE_1.replace("\"5 mm\"", "\"1.25 in\"")
    );
    assert!(journals(next.folder.path()).is_empty());
}

#[test]
fn of_several_ended_sessions_the_latest_edits_are_offered_first() {
    let mut tty = opened();
    tty.type_for("\x156 mm", "6 mm");
    tty.end_by("TERM");
    let first = journals(tty.folder.path()).pop().expect("a journal");
    let text = fs::read_to_string(&first).expect("it is there");
    let journal = Journal::from_text(&text).expect("whole");
    // The seconds of `written` differ.
    std::thread::sleep(SECOND + SECOND / 10);
    let mut next = again(&tty);
    next.wait_for(OFFER);
    next.type_in("l");
    next.wait_until("the question to go", |tty| !tty.shows(OFFER));
    next.type_for("\x157 mm", "7 mm");
    next.end_by("TERM");
    assert_eq!((journals(tty.folder.path()).len(), journal.changes.len()), (2, 1));
    let mut last = again(&tty);
    last.wait_for("5 mm -> 7 mm");
    last.type_for("d", "5 mm -> 6 mm");
    last.type_in("d");
    last.quit();
    assert!(journals(last.folder.path()).is_empty());
}

/// `pty` sends every signal.
#[test]
fn text_typed_just_before_a_signal_is_offered_and_discarded_on_request() {
    let mut tty = opened();
    tty.type_for("\x15 1.25 in", "1.25 in");
    tty.end_by("HUP");
    tty.assert(tty.shows("unsaved edits are kept"));
    let mut next = again(&tty);
    next.wait_for(OFFER);
    next.wait_for("1.25 in");
    next.type_in("d\x11");
    assert_eq!(next.wait_for_end().exit_code(), 0);
    assert!(journals(next.folder.path()).is_empty());
    assert_eq!(fs::read_to_string(next.case()).expect("it is there"), TABLE_1);
}

#[test]
fn a_hang_up_ends_the_workbench_at_once_without_loss() {
    let mut tty = opened();
    tty.type_for("\x151.25 in", "1.25 in");
    let kept = hang_up(&mut tty);
    assert!(kept.contains("1.25 in"), "{kept}");
}

#[test]
fn a_workbench_that_is_stuck_is_ended_by_a_hang_up_without_loss_and_without_work() {
    if !has_faults_on_demand() {
        return;
    }
    let mut tty = Launch::on_table_1().variable("TIPSTRIKE_FAULT", "stuck screen").start();
    tty.wait_for("Corner contact");
    tty.type_for("\x151.25 in", "1.25 in");
    // From here on it draws nothing, reads nothing and does not end by itself.
    tty.type_in("\x0c");
    tty.settle(Duration::from_millis(100));
    tty.type_in("7");
    assert_eq!(tty.settle(Duration::from_millis(200)), 0, "it is stuck");
    let kept = hang_up(&mut tty);
    assert!(kept.contains("1.25 in"), "{kept}");
}

#[test]
fn a_terminal_closed_without_a_signal_is_noticed() {
    if !is_there("setsid") || !has_faults_on_demand() {
        return;
    }
    for fault in ["", "stuck screen"] {
        // In its own session the program has no controlling terminal, so no signal reports the end
        // of the terminal.
        let launch =
            Launch::on_table_1().through(&["setsid", "--wait"]).variable("TIPSTRIKE_FAULT", fault);
        let mut tty = launch.shown("Corner contact");
        tty.type_for("\x151.25 in", "1.25 in");
        tty.type_in("\x0c");
        tty.settle(Duration::from_millis(100));
        let children =
            fs::read_to_string(format!("/proc/{0}/task/{0}/children", tty.id())).expect("it runs");
        let child = children.split_whitespace().next().expect("a child");
        let kept = hang_up_of(&mut tty, child.parse().expect("its number"));
        assert!(kept.contains("1.25 in"), "{fault}: {kept}");
    }
}

/// Closes the terminal and waits for the end. Returns the content of the journal.
fn hang_up(tty: &mut Tty) -> String {
    let id = tty.id();
    hang_up_of(tty, id)
}

fn hang_up_of(tty: &mut Tty, id: u32) -> String {
    let ticks = |id| {
        let words = stat(id).unwrap_or_default().into_iter().skip(11).take(2);
        words.map(|word| word.parse::<u64>().unwrap_or(0)).sum::<u64>()
    };
    let before = ticks(id);
    assert!(journals(tty.folder.path()).is_empty(), "no journal is written yet");
    let broken = Instant::now();
    tty.hang_up();
    let (mut kept, mut burnt) = (None, before);
    // An ended process may remain as a zombie.
    while !tty.has_ended() || stat(id).is_some_and(|words| words[0] != "Z") {
        kept = kept.or_else(|| (!journals(tty.folder.path()).is_empty()).then(|| broken.elapsed()));
        burnt = burnt.max(ticks(id));
        assert!(broken.elapsed() < PATIENCE, "it stays without a terminal");
        std::thread::sleep(Duration::from_millis(2));
    }
    let gone = broken.elapsed();
    let (kept, burnt) = (kept.unwrap_or(gone), burnt - before);
    println!("journal after {kept:.1?}, end after {gone:.1?}, {burnt} ticks of 10 ms");
    // The promises are 0.2 s and 1 s; a busy machine may wake the process later.
    assert!(kept < SECOND / 2 && gone < 5 * SECOND, "{kept:.1?} {gone:.1?}");
    assert!(burnt <= 8, "it burns {burnt} ticks on its way out");
    let kept = journals(tty.folder.path()).pop();
    kept.and_then(|path| fs::read_to_string(path).ok()).unwrap_or_default()
}

#[test]
fn edits_of_the_built_in_case_are_journaled() {
    let folder = Arc::new(tempfile::tempdir().expect("a folder"));
    let mut tty = Launch::of(Arc::clone(&folder)).shown("built-in");
    tty.wait_for("quit");
    tty.type_for("\x151.25 in", "1.25 in");
    tty.end_by("TERM");
    // On another case, they are only reported.
    let other = folder.path().join("other.toml");
    fs::write(&other, TABLE_1).expect("room on the disk");
    let mut tty = Launch::of(Arc::clone(&folder)).argument(&other).start();
    tty.wait_for("the built-in case: unsaved edits of an ended session");
    // A new case has no file either, but is another case.
    tty.type_for("\x0e", "required fields are empty");
    assert!(!tty.shows(OFFER));
    tty.type_for("\x1bt", OFFER);
    tty.type_in("l");
    tty.wait_until("the question to go", |tty| !tty.shows(OFFER));
    tty.quit();
    assert_eq!(journals(folder.path()).len(), 1, "later means later");
    fs::remove_file(folder.path().join("tipstrike/last-case")).expect("it is there");
    let mut tty = Launch::of(folder).shown(OFFER);
    tty.type_for("r", "1.25 in");
    tty.type_in("\x11d");
    assert_eq!(tty.wait_for_end().exit_code(), 0);
    assert!(journals(tty.folder.path()).is_empty());
}

#[test]
fn an_offer_for_a_changed_file_shows_the_present_differences() {
    let mut tty = opened();
    tty.type_for("\x156 mm", "6 mm");
    tty.end_by("TERM");
    fs::write(tty.case(), TABLE_1.replace("\"5 mm\"", "\"7 mm\"")).expect("room on the disk");
    let case = tty.case();
    let next = Launch::of(Arc::clone(&tty.folder)).argument(case);
    let mut next = next.size(24, 160).shown(OFFER);
    next.wait_for("The file has changed");
    next.assert(next.shows("module: 7 mm -> 6 mm"));
    next.type_in("l");
    next.quit();
    // Edits equal to the present file are not offered.
    fs::write(tty.case(), TABLE_1.replace("\"5 mm\"", "\"6 mm\"")).expect("room on the disk");
    let mut next = again(&tty);
    next.wait_for("quit");
    next.settle(Duration::from_millis(300));
    assert!(!next.shows(OFFER));
    next.quit();
    assert!(journals(next.folder.path()).is_empty());
}

#[test]
fn a_damaged_journal_is_set_aside_reported_and_never_trusted_nor_deleted() {
    let mut tty = opened();
    tty.type_for("\x156 mm", "6 mm");
    tty.end_by("TERM");
    let path = journals(tty.folder.path()).pop().expect("a journal");
    let whole = fs::read_to_string(&path).expect("it is there");
    let half = whole.as_bytes()[..whole.len() / 2].to_vec();
    let changed = whole.replace("6 mm", "9 mm").into_bytes();
    for (count, text) in [half, changed, b"\xff\xfe".to_vec()].into_iter().enumerate() {
        fs::write(&path, &text).expect("room on the disk");
        let mut next = again(&tty);
        next.wait_for("unsaved edits of this case cannot be restored: ");
        assert!(!next.shows(OFFER) && !next.shows("9 mm"));
        next.quit();
        assert!(!path.exists());
        let folder = fs::read_dir(path.parent().expect("a folder")).expect("a folder");
        let aside: Vec<_> = folder.flatten().map(|entry| fs::read(entry.path())).collect();
        assert_eq!(aside.len(), count + 1, "none is deleted");
        assert!(aside.into_iter().any(|bytes| bytes.is_ok_and(|bytes| bytes == text)));
    }
    symlink("/dev/zero", &path).expect("a link");
    let mut next = again(&tty);
    next.wait_for("unsaved edits of this case cannot be restored: ");
    next.quit();
}

#[test]
fn a_second_session_reads_names_the_first_and_may_save_elsewhere() {
    let mut first = opened();
    let mut second = again(&first);
    second.wait_for("*read-only*");
    second.wait_for(&format!("process {}", first.id()));
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    assert!(second.shows(&format!("on {} for ", host.trim())), "{}", second.screen().contents());
    second.type_in("\x156 mm");
    wait_for_journal(&mut second, "6 mm");
    second.assert(second.shows("*unsaved*"));
    second.type_for("\x13", "Open elsewhere");
    second.type_for("c\x11", "has unsaved edits");
    second.type_for("c\x13", "Open elsewhere");
    second.type_for("s", "Save as");
    second.type_for("\x15other.toml\r", "saved other.toml");
    assert!(!second.shows("*read-only*"));
    // It may not save over the first session's file under another path either.
    second.type_for(format!("\x1bs\x15{}\r", first.case().display()), "Open elsewhere");
    second.type_in("c\x1b");
    second.wait_until("the questions to go", |tty| {
        !tty.shows("Open elsewhere") && !tty.shows("Save as")
    });
    first.type_for("\x157 mm\x13", "saved ");
    second.quit();
    first.quit();
    let read =
        |name: &str| fs::read_to_string(first.folder.path().join(name)).expect("it is there");
    assert!(read("case.toml").contains("7 mm") && read("other.toml").contains("6 mm"));
    let left = fs::read_dir(first.folder.path()).expect("a folder").flatten();
    let mut left = left.map(|entry| entry.file_name().to_string_lossy().into_owned());
    assert!(left.all(|name| !name.ends_with(".tipstrike")), "a lock is left");
}

#[test]
fn when_the_first_session_has_ended_the_second_may_save() {
    let mut first = opened();
    let link = first.folder.path().join("link.toml");
    symlink("case.toml", &link).expect("a link");
    // Under any name.
    let mut second = Launch::of(Arc::clone(&first.folder)).argument(&link).shown("*read-only*");
    first.end_by("KILL");
    second.type_for("\x156 mm\x13", "saved ");
    second.wait_until("the mark to go", |tty| !tty.shows("*read-only*"));
    second.quit();
    assert!(fs::read_to_string(first.case()).is_ok_and(|text| text.contains("6 mm")));
}
