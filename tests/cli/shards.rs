//! Shards of a study: together they give the whole study, and other files are refused.

use crate::program::{has, ran, words};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A sweep with corner contact, without it, and with refused points.
const SWEEP: &str = "sweep TABLE_1 --vary 'driven.tip_relief=0..80 um' \
    --vary 'driver.bore_radius=30,40,50 mm' --points 7";

/// Writes the shards of a study into a folder, the last one first.
fn shards(folder: &Path, study: &str, of: usize) -> Vec<PathBuf> {
    let write = |number: usize| {
        let path = folder.join(format!("{of}-{number}.shard"));
        assert_eq!(ran(&format!("{study} --shard {number}/{of} --out {}", path.display())).0, 0);
        path
    };
    (1..=of).rev().map(write).collect()
}

fn gather(files: &[PathBuf]) -> (i32, String, String) {
    let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    ran(&format!("gather {}", names.join(" ")))
}

/// Table 1 with a distribution of two fields.
fn spread(folder: &Path) -> String {
    let case = folder.join("spread.toml");
    let spread = "[spread]\n\"driven.tip_relief\" = { uniform = \"12 um\" }\n\
                  \"deviations.base_pitch\" = { normal = \"2 um\" }\n";
    let text = fs::read_to_string("cases/zhou-chen-2014.toml").unwrap();
    fs::write(&case, format!("{text}\n{spread}")).unwrap();
    format!("tolerance {} --set 'driven.tip_relief=40 um'", case.display())
}

#[test]
fn gathered_shards_are_the_bytes_of_the_whole() {
    let folder = tempfile::tempdir().unwrap();
    let tolerance = format!("{} --samples 200 --seed 3", spread(folder.path()));
    let as_csv = format!("{tolerance} --format csv --ranking 20");
    for study in [SWEEP, &format!("{SWEEP} --format json"), &tolerance, &as_csv] {
        let whole = ran(study);
        for of in [1, 3, 40] {
            assert_eq!(gather(&shards(folder.path(), study, of)), whole, "{study} in {of}");
        }
    }
    // The extension of a shard selects the format as that of the whole does.
    let file = |name| folder.path().join(name).display().to_string();
    let [shard, out] = ["1.csv", "whole.csv"].map(file);
    assert_eq!(ran(&format!("{tolerance} --shard 1/1 --out {shard}")).0, 0);
    assert_eq!(ran(&format!("gather --out {out} {shard}")).0, 0);
    let whole = ran(&format!("{tolerance} --format csv")).1;
    assert_eq!(fs::read_to_string(out).unwrap(), whole);
}

#[test]
fn missing_repeated_half_changed_and_foreign_shards_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let files = shards(folder.path(), SWEEP, 3);
    let other_folder = tempfile::tempdir().unwrap();
    let others = shards(other_folder.path(), &format!("{SWEEP} --method paper"), 3);
    let refusal = |files: &[PathBuf]| {
        let (code, text, errors) = gather(files);
        assert_eq!((code, text.as_str()), (3, ""), "{errors}");
        errors
    };
    has(&refusal(&files[1..]), &["1 of 3 shards are missing: run --shard 3/3"]);
    let copy = folder.path().join("copy.shard");
    fs::copy(&files[0], &copy).unwrap();
    let message = refusal(&[files.clone(), vec![copy.clone()]].concat());
    has(&message, &["shard 3/3 is in", "too"]);
    let message = refusal(&[files[0].clone(), files[1].clone(), others[2].clone()]);
    assert!(message.contains("belongs to another study than"), "{message}");

    let text = fs::read_to_string(&files[0]).unwrap();
    let whole_lines: Vec<&str> = text.split_inclusive('\n').collect();
    let without_end = whole_lines[..whole_lines.len() - 1].concat();
    let without_row = [&whole_lines[..2], &whole_lines[3..]].concat().concat();
    let half_line = text[..text.len() - 9].to_owned();
    let other_case = text.replacen("2000 rpm", "2001 rpm", 1);
    assert_ne!(other_case, text);
    for broken in [without_end, without_row, half_line, other_case] {
        fs::write(&copy, broken).unwrap();
        let message = refusal(&[copy.clone(), files[1].clone(), files[2].clone()]);
        has(&message, &["copy.shard: shard 3/3 is incomplete or changed: run it"]);
    }
    // A changed first line: other parts of the study, a part that does not exist, fewer parts.
    let renumbered = |file: &Path, part: &str| {
        let text = fs::read_to_string(file).unwrap();
        let (first, rest) = text.split_once('\n').unwrap();
        let start = first.find("\"number\":").unwrap();
        let end = start + first[start..].find('}').unwrap();
        format!("{}{part}{}\n{rest}", &first[..start], &first[end..])
    };
    let swapped = folder.path().join("swapped.shard");
    fs::write(&copy, renumbered(&files[0], "\"number\":2,\"of\":3")).unwrap();
    fs::write(&swapped, renumbered(&files[1], "\"number\":3,\"of\":3")).unwrap();
    has(&refusal(&[copy.clone(), swapped, files[2].clone()]), &["incomplete or changed"]);
    for part in ["1,\"of\":1", "1,\"of\":0", "0,\"of\":0", "5,\"of\":3"] {
        fs::write(&copy, renumbered(&files[2], &format!("\"number\":{part}"))).unwrap();
        refusal(std::slice::from_ref(&copy));
    }
    // A line without end, in the place of the study and of a row.
    let first = text.split_inclusive('\n').next().unwrap();
    for start in ["", first] {
        fs::write(&copy, start).unwrap();
        let file = fs::File::options().append(true).open(&copy).unwrap();
        file.set_len(1 << 40).unwrap();
        refusal(std::slice::from_ref(&copy));
    }
    for file in ["/dev/zero", "cases/zhou-chen-2014.toml"] {
        has(&refusal(&[PathBuf::from(file)]), &["this is not a shard"]);
    }
    let (code, _, errors) = gather(&[folder.path().join("missing.shard")]);
    assert!(code == 5 && errors.contains("file not found"), "{errors}");
    let (code, _, errors) = ran(&format!("{SWEEP} --shard 4/3"));
    assert!(code == 2 && errors.contains("write 1/3 to 3/3"), "{errors}");
}

/// Starts the program in a shell with `trap`, sends it the signals one after the other once it has
/// written a file into the folder, and returns the number of the signal that ended it.
#[cfg(unix)]
fn stopped_by(signals: &[&str], trap: &str, study: &str, folder: &Path) -> Option<i32> {
    use std::os::unix::process::ExitStatusExt;
    // The tests may run under `nohup`.
    let script = format!("ulimit -c 0; {trap} exec \"$@\"");
    let mut program = Command::new("env")
        .args(["--default-signal", "sh", "-c", &script, "sh"])
        .arg(env!("CARGO_BIN_EXE_tipstrike"))
        .args(words(study))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let has_rows = || {
        let mut files = fs::read_dir(folder).unwrap();
        files.any(|file| file.unwrap().metadata().is_ok_and(|file| file.len() > 100_000))
    };
    while !has_rows() {
        assert!(begun.elapsed() < Duration::from_secs(300), "no row is written");
        assert_eq!(program.try_wait().unwrap(), None, "{study}");
        std::thread::sleep(Duration::from_millis(20));
    }
    for signal in signals {
        let sent = Command::new("kill").args(["-s", signal, &program.id().to_string()]).status();
        assert!(sent.unwrap().success());
        std::thread::sleep(Duration::from_millis(200));
    }
    program.wait().unwrap().signal()
}

#[cfg(unix)]
#[test]
fn a_signal_ends_a_study_while_it_solves_or_writes_and_leaves_no_file() {
    let (folder, out) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let study =
        format!("{} --ranking 0 --out {}", spread(folder.path()), out.path().join("out").display());
    // With so many samples it runs until a signal stops it.
    let shard = format!("{study} --samples 20000000 --shard 1/2");
    let rows = format!("{study} --samples 300000 --format csv");
    let ends = |signals: &[&str], trap: &str, number: i32, study: &str| {
        let ended = stopped_by(signals, trap, study, out.path());
        assert_eq!(ended, Some(number), "{signals:?} {study}");
        let left: Vec<_> = fs::read_dir(out.path()).unwrap().collect();
        assert!(left.is_empty(), "{signals:?}: {left:?}");
    };
    for (signal, number) in [("HUP", 1), ("INT", 2), ("QUIT", 3), ("USR1", 10), ("TERM", 15)] {
        ends(&[signal], "", number, &shard);
    }
    ends(&["INT"], "", 2, &rows);
    // An ignored signal stays ignored, as under `nohup`.
    ends(&["HUP", "TERM"], "trap '' HUP;", 15, &shard);
}
