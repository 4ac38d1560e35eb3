//! Case files are read, edited and saved without loss: bytes, comments, modes, links, and changes
//! by other programs.

use std::fs;
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::program::has;
use tipstrike::case::fields::index_of;
use tipstrike::case::file::{MOST_BYTES, ReadError, SaveError};
use tipstrike::case::{Case, Document, FIELDS, Variant};
use tipstrike::model::Stages;

const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");

fn cases() -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    assert!(paths.len() >= 8);
    paths.into_iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

fn parsed(text: &str) -> Document {
    Document::parse("case.toml", text).unwrap_or_else(|faults| panic!("{}", faults[0]))
}

fn write(document: &mut Document, key: &str, text: &str) {
    document.case.write(index_of(key).unwrap(), text);
}

/// Table 1 in a temporary folder.
fn on_disk() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, TABLE_1).unwrap();
    (folder, path)
}

fn changed(path: &Path) -> Document {
    let mut document = Document::read(path).unwrap();
    write(&mut document, "pair.module", "6 mm");
    document
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn every_case_is_valid_names_its_source_and_has_limits() {
    for (path, text) in cases() {
        let document = Document::read(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(document.case.inputs().is_ok(), "{}", path.display());
        assert!(!document.case.limits.is_empty(), "{}", path.display());
        assert!(
            text.starts_with("# ") && text.contains("ssumed") || text.contains("econstructed"),
            "{}",
            path.display()
        );
    }
}

#[test]
fn the_cases_have_the_features_that_their_files_state() {
    let solved = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(name);
        let inputs = Document::read(&path).unwrap().case.inputs().unwrap();
        let solution = tipstrike::model::solve(&inputs, Stages::CLOSED_FORM).unwrap();
        (inputs, solution)
    };
    let (_, fzg) = solved("fzg-type-c.toml");
    assert!((fzg.geometry.driver.tip * 2e3 - 82.46).abs() < 1e-4, "{}", fzg.geometry.driver.tip);
    assert!((fzg.geometry.driven.tip * 2e3 - 118.36).abs() < 1e-4, "{}", fzg.geometry.driven.tip);
    let (nasa, _) = solved("nasa-lewis-28-28.toml");
    assert!((nasa.module - 3.175e-3).abs() < 1e-15 && (nasa.torque() - 71.75).abs() < 0.01);
    let (speed_up, _) = solved("hydro-speed-up.toml");
    assert!(speed_up.ratio() < 1.0);
    let (_, relieved) = solved("tip-relief-enough.toml");
    assert_eq!(relieved.outcome.name(), "no-corner-contact");
    let (_, long) = solved("high-contact-ratio.toml");
    assert!(long.geometry.contact_ratio > 2.0);
}

#[test]
fn a_changed_value_changes_nothing_else() {
    for (from, key, to, line) in [
        (
            "base_pitch = \"16 um\" # normal",
            "deviations.base_pitch",
            "18 µm",
            "base_pitch = \"18 µm\" # normal",
        ),
        ("teeth = 20\n", "driver.teeth", "23", "teeth = 23\n"),
        (
            "title = \"Zhou & Chen 2014, Table 1\"",
            "title",
            "a \"b\" \\ c",
            "title = 'a \"b\" \\ c'",
        ),
        ("profile_shift = 0.0", "driver.profile_shift", ".5", "profile_shift = 0.5"),
        ("impact_force = \"2500 N\"", "limits.impact_force", "3 kN", "impact_force = \"3 kN\""),
    ] {
        for line_end in ["\n", "\r\n"] {
            let text = TABLE_1.replace('\n', line_end);
            let (from, line) = (from.replace('\n', line_end), line.replace('\n', line_end));
            let mut document = parsed(&text);
            document.case.set(key, to).unwrap();
            assert!(document.is_changed());
            assert_eq!(document.render(), text.replacen(&from, &line, 1), "{key}");
        }
    }
}

#[test]
fn removing_a_field_removes_only_its_own_comment() {
    let mut document = parsed(TABLE_1);
    write(&mut document, "model.deflection", "");
    let line = "deflection = \"24.7 um\" # as the paper takes it from its reference 20\n";
    assert_eq!(document.render(), TABLE_1.replace(line, ""));
    document.case.set("limits.impact_force", "").unwrap();
    let without = TABLE_1.replace(line, "").replace("impact_force = \"2500 N\"\n", "");
    assert_eq!(document.render(), without);
}

#[test]
fn a_new_field_is_inserted_at_its_place_in_its_table() {
    let mut document = parsed(TABLE_1);
    write(&mut document, "pair.centre_distance", "101 mm");
    write(&mut document, "operation.friction_coefficient", "0.06");
    document.case.set("limits.normal_velocity", "2 m/s").unwrap();
    let expected = TABLE_1
        .replace("\"20 deg\"\n", "\"20 deg\"\ncentre_distance = \"101 mm\"\n")
        .replace("\"2000 rpm\"\n", "\"2000 rpm\"\nfriction_coefficient = 0.06\n")
        .replace("\"2500 N\"\n", "\"2500 N\"\nnormal_velocity = \"2 m/s\"\n");
    assert_eq!(document.render(), expected);
}

#[test]
fn a_new_table_is_appended_to_any_file() {
    let short = TABLE_1.split("[limits]").next().unwrap().trim_end();
    for (text, line_end) in [
        (short.to_owned(), "\n"),
        (format!("{short}\n"), "\n"),
        (format!("{short}\n").replace('\n', "\r\n"), "\r\n"),
    ] {
        let mut document = parsed(&text);
        document.case.set("limits.impact_force", "1 kN").unwrap();
        let added = format!("{line_end}[limits]{line_end}impact_force = \"1 kN\"{line_end}");
        let kept = if text.ends_with('\n') { text.clone() } else { format!("{text}{line_end}") };
        assert_eq!(document.render(), kept + &added);
    }
}

/// Variants in every layout of TOML, with comments.
const VARIANTS: &str = "
# what the workshop offers
[variants.relieved] # longer
\"driven.tip_relief\" = \"48 um\" # amount
model.method = \"paper\"
operation = { speed = \"500 rpm\" }

[variants.slow.operation]
speed = \"100 rpm\" # crawling
";

#[test]
fn changed_variants_are_edited_in_place_and_keep_their_comments() {
    let text = format!("{TABLE_1}{VARIANTS}");
    let mut document = parsed(&text);
    assert_eq!(document.render(), text);
    let mut edited = document.case.clone();
    for (key, value) in [
        ("driven.tip_relief", "30 um"),
        ("operation.speed", "700 rpm"),
        ("operation.torque", "50 N m"),
        ("limits.impact_force", "1 kN"),
    ] {
        edited.set(key, value).unwrap();
    }
    let variant = Variant::between("relieved", &document.case, &edited);
    document.case.keep_variant(variant);
    let expected = text
        .replace("48 um\" # amount", "30 um\" # amount")
        .replace("model.method = \"paper\"\n", "")
        .replace(
            "{ speed = \"500 rpm\" }\n",
            "{ speed = \"700 rpm\" }\n\"operation.torque\" = \"50 N m\"\n\"limits.impact_force\" = \
                \"1 kN\"\n",
        );
    assert_eq!(document.render(), expected);
    assert_eq!(parsed(&document.render()).case, document.case);

    document.case.variants.remove(0);
    let slow = VARIANTS.split("\n\n").nth(1).unwrap();
    assert!(document.render().contains(slow), "{}", document.render());
    assert_eq!(parsed(&document.render()).case, document.case);
}

#[test]
fn a_new_variant_is_appended_without_other_changes() {
    let mut document = parsed(TABLE_1);
    let mut edited = document.case.clone();
    edited.set("model.deflection", "").unwrap();
    edited.set("title", "no deflection").unwrap();
    let variant = Variant::between("computed", &document.case, &edited);
    document.case.keep_variant(variant);
    let added = "\n[variants.computed]\ntitle = \"no deflection\"\n\"model.deflection\" = \"\"\n";
    assert_eq!(document.render(), format!("{TABLE_1}{added}"));
    assert_eq!(parsed(&document.render()).case, document.case);
    let template = Document::new(document.case.clone()).render();
    assert!(template.contains(added), "{template}");
    assert_eq!(parsed(&template).case, document.case);
}

#[test]
fn a_new_document_is_a_commented_text_with_every_field() {
    let text = Document::new(Case::table_1()).render();
    let mut document = parsed(&text);
    assert_eq!(document.case, Case::table_1());
    document.case.apply("about.drawing no.", Some("7")).unwrap();
    assert!(document.render().contains("keys.\n[about]\n\"drawing no.\" = \"7\"\n\n#"));
    assert_eq!(parsed(&document.render()).case, document.case);
    for field in &FIELDS {
        let line =
            |line: &str| line.trim_start_matches("# ").starts_with(&format!("{} = ", field.name()));
        assert!(text.lines().any(line), "{}", field.key);
        assert!(text.contains(field.help), "{}", field.key);
    }
}

#[test]
fn a_draft_gets_its_values_in_place_and_may_be_saved_incomplete() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("draft.toml");
    let mut draft = Document::new(Case::fresh());
    draft.save(&path).unwrap();
    assert!(Document::read(&path).is_err());
    write(&mut draft, "driven.teeth", "40");
    write(&mut draft, "operation.torque", "70 N m");
    draft.save(&path).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    has(
        &text,
        &["\nteeth = 40  # required, such as 20\n", "\nteeth = \"\"  # required, such as 20\n"],
    );
    let mut again = Document::read_draft(&path).unwrap();
    assert_eq!((&again.case, again.render()), (&draft.case, text));
    let missing = again.case.inputs().unwrap_err();
    let keys: Vec<&str> = missing.iter().map(|one| one.field.as_str()).collect();
    let widths = ["driver.face_width", "driven.face_width"];
    assert_eq!(keys, ["pair.module", "driver.teeth", widths[0], widths[1], "operation.speed"]);
    write(&mut again, "pair.module", "wide");
    again.save(&path).unwrap();
    assert!(Document::read_draft(&path).is_err(), "a wrong value is no missing value");
}

#[test]
fn invalid_text_is_saved_as_typed() {
    let mut document = parsed(TABLE_1);
    write(&mut document, "driver.teeth", "twenty");
    write(&mut document, "pair.module", "5");
    let expected =
        TABLE_1.replacen("teeth = 20", "teeth = \"twenty\"", 1).replace("\"5 mm\"", "\"5\"");
    assert_eq!(document.render(), expected);
}

#[test]
fn a_refusal_of_the_model_is_placed() {
    let document = parsed(TABLE_1);
    assert_eq!(document.place("driven.addendum"), (29, 12));
    assert_eq!(document.place("pair.centre_distance"), (10, 1));
    assert_eq!(document.place("limits.impact_force"), (55, 16));
}

#[test]
fn a_new_file_has_the_mode_of_any_new_file() {
    let folder = tempfile::tempdir().unwrap();
    let (saved, plain) = (folder.path().join("saved.toml"), folder.path().join("plain"));
    fs::write(&plain, "").unwrap();
    let mut document = Document::table_1();
    document.save(&saved).unwrap();
    assert_eq!(fs::metadata(&saved).unwrap().mode(), fs::metadata(&plain).unwrap().mode());
    assert_eq!(document.path(), Some(fs::canonicalize(&saved).unwrap().as_path()));
}

#[test]
fn a_chain_of_links_stays_and_its_end_is_written() {
    let (folder, path) = on_disk();
    let (first, second) = (folder.path().join("first.toml"), folder.path().join("second.toml"));
    symlink("second.toml", &first).unwrap();
    symlink(&path, &second).unwrap();
    changed(&first).save(&first).unwrap();
    assert!([first, second].iter().all(|link| fs::symlink_metadata(link).unwrap().is_symlink()));
    assert!(fs::read_to_string(&path).unwrap().contains("6 mm"));
    let dangling = folder.path().join("dangling.toml");
    symlink("new.toml", &dangling).unwrap();
    Document::table_1().save(&dangling).unwrap();
    assert_eq!(fs::read_to_string(folder.path().join("new.toml")).unwrap(), TABLE_1);
    let circle = folder.path().join("loop.toml");
    symlink("loop.toml", &circle).unwrap();
    assert!(matches!(Document::table_1().save(&circle), Err(SaveError::Unwritable(..))));
}

#[test]
fn a_file_with_two_names_is_refused() {
    let (folder, path) = on_disk();
    fs::hard_link(&path, folder.path().join("other.toml")).unwrap();
    let error = changed(&path).save(&path).unwrap_err();
    assert!(error.to_string().contains("2 names"), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), TABLE_1);
}

#[test]
fn unreadable_files_are_distinguished() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::write(path("bad.toml"), TABLE_1.replace("5 mm", "5")).unwrap();
    fs::write(path("newer.toml"), TABLE_1.replace("format = 1", "format = 2")).unwrap();
    fs::write(path("large.toml"), vec![b'#'; MOST_BYTES + 1]).unwrap();
    assert!(matches!(Document::read(&path("none.toml")), Err(ReadError::NotFound(_))));
    assert!(matches!(Document::read(&path("none/none.toml")), Err(ReadError::NotFound(_))));
    assert!(matches!(Document::read(&path("newer.toml")), Err(ReadError::NewerFormat(_))));
    assert!(matches!(Document::read(&path("large.toml")), Err(ReadError::TooLarge(..))));
    let Err(ReadError::Bad(faults)) = Document::read(&path("bad.toml")) else {
        panic!("a bad file was read")
    };
    let start = format!("{}:11:10: pair.module: ", path("bad.toml").display());
    assert!(faults[0].to_string().starts_with(&start), "{}", faults[0]);
}

#[test]
fn a_read_only_file_is_refused_and_not_changed() {
    let (folder, path) = on_disk();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o444)).unwrap();
    let error = changed(&path).save(&path).unwrap_err();
    assert!(matches!(error, SaveError::ReadOnly(_)), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), TABLE_1);
    assert_eq!(names(folder.path()), ["case.toml"]);
}

#[test]
fn a_folder_that_cannot_be_written_leaves_file_and_changes() {
    let missing = tempfile::tempdir().unwrap().path().join("gone/case.toml");
    let error = Document::table_1().save(&missing).unwrap_err();
    let SaveError::NoFolder(_, folder) = &error else { panic!("{error}") };
    assert_eq!(missing.parent(), Some(Path::new(folder)));
    assert!(error.to_string().contains("mkdir -p"), "{error}");
    // A folder of the system, in which no user can write.
    let mut document = Document::table_1();
    write(&mut document, "pair.module", "6 mm");
    assert!(document.save(Path::new("/proc/case.toml")).is_err());
    assert!(document.is_changed());
}

#[test]
fn a_touch_or_a_new_inode_with_the_same_bytes_does_not_stop_a_save() {
    let (_folder, path) = on_disk();
    let mut document = changed(&path);
    let earlier = SystemTime::now() - Duration::from_secs(86400);
    fs::File::options().write(true).open(&path).unwrap().set_modified(earlier).unwrap();
    document.save(&path).unwrap();
    write(&mut document, "pair.module", "7 mm");
    let copy = path.with_extension("copy");
    fs::copy(&path, &copy).unwrap();
    fs::rename(&copy, &path).unwrap();
    document.save(&path).unwrap();
    write(&mut document, "pair.module", "8 mm");
    fs::remove_file(&path).unwrap();
    document.save(&path).unwrap();
    assert!(fs::read_to_string(&path).unwrap().contains("8 mm"));
}
