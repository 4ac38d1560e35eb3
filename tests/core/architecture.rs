//! Architecture: the folders of `src` import only the planned ones, no files import each other in a
//! circle, and every file is short and starts with a sentence.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::PathBuf;

use crate::support::path;

/// Each folder of `src` and the folders that it may import.
const FOLDERS: [(&str, &[&str]); 9] = [
    ("system", &[]),
    ("numeric", &[]),
    ("model", &["numeric"]),
    ("case", &["system", "numeric", "model"]),
    ("study", &["numeric", "model", "case"]),
    ("report", &["numeric", "model", "case", "study"]),
    ("cli", &["system", "numeric", "model", "case", "study", "report"]),
    ("tui", &["system", "numeric", "model", "case", "study", "report"]),
    // The command and the workbench of the wheel are `main` alone.
    ("python", &["system", "numeric", "model", "case", "study", "report", "cli", "tui"]),
];

/// Names of crates, files, threads and printing, and the only folders that may use them outside tests.
const NAMES: [(&[&str], &[&str]); 3] = [
    (&["ratatui", "crossterm", "tui_input"], &["tui"]),
    // Interfaces of Unix.
    (
        &["std::os::", "os::unix::", "rustix::", "nix::", "libc::", "signal_hook::", "xattr::"],
        &["system"],
    ),
    // The computation core has no file formats, files, threads or printing.
    (
        &[
            "serde",
            "serde_json",
            "toml",
            "csv",
            "std::fs",
            "std::io",
            "std::thread",
            "println",
            "print",
            "eprintln",
        ],
        &["system", "case", "study", "report", "cli", "tui", "python", ""],
    ),
];

const MOST_LINES: usize = 900;

struct Source {
    path: PathBuf,
    /// The modules from `src` on: `["report", "json"]`.
    modules: Vec<String>,
    text: String,
    /// The text without comments.
    whole: String,
}

impl Source {
    fn read(path: PathBuf) -> Source {
        let text = fs::read_to_string(&path).unwrap();
        let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
        let whole = lines.collect::<Vec<_>>().join("\n");
        let names = path.components().map(|part| part.as_os_str().to_string_lossy().into_owned());
        let modules = names.skip_while(|name| name != "src").skip(1);
        let modules = modules.map(|name| name.replace(".rs", "")).collect();
        Source { path, modules, text, whole }
    }

    fn is_test(&self) -> bool {
        self.path.ends_with("tests.rs")
    }

    /// The code without comments and tests.
    fn code(&self) -> &str {
        self.whole.split("mod tests {").next().unwrap_or_default()
    }

    /// The folder of `src`; empty for the roots of library and program.
    fn folder(&self) -> &str {
        let first = self.modules[0].as_str();
        if ["lib", "main"].contains(&first) { "" } else { first }
    }

    /// The folders that the code and its tests name, in any syntax.
    fn folders_named(&self) -> BTreeSet<&str> {
        let to_root = "super::".repeat(self.modules.len());
        let roots = ["crate::", "tipstrike::", &to_root];
        let named = roots.iter().flat_map(|root| heads(&self.whole, root));
        named.filter(|name| FOLDERS.iter().any(|(folder, _)| folder == name)).collect()
    }

    /// The modules of this folder that the code names.
    fn neighbours_named(&self, folder: &[String]) -> BTreeSet<&str> {
        let whole = format!("crate::{}::", folder.join("::"));
        let upwards = "super::".repeat(self.modules.len() - folder.len());
        heads(self.code(), &whole).into_iter().chain(heads(self.code(), &upwards)).collect()
    }
}

/// The text after each occurrence of `word` that is not the tail of a longer word or path.
fn after<'a>(code: &'a str, word: &str) -> Vec<&'a str> {
    let is_whole = |at: usize| {
        let before = &code[..at];
        !(before.ends_with(is_word) || word.starts_with("super") && before.ends_with("super::"))
    };
    let places = code.match_indices(word).filter(|(at, _)| is_whole(*at));
    places.map(|(at, _)| &code[at + word.len()..]).collect()
}

/// The first names of the paths after a prefix; a group in braces has several.
fn heads<'a>(code: &'a str, prefix: &str) -> Vec<&'a str> {
    let head = |path: &'a str| path.trim_start().split(|c| !is_word(c)).next().unwrap_or_default();
    let of = |path: &'a str| {
        let Some(group) = path.strip_prefix('{') else { return vec![head(path)] };
        let (mut found, mut depth) = (vec![head(group)], 0);
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => found.push(head(&group[at + 1..])),
                _ => {}
            }
        }
        found
    };
    after(code, prefix).into_iter().flat_map(of).collect()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn sources(folder: &str) -> Vec<Source> {
    let (mut found, mut folders) = (Vec::new(), vec![path(folder)]);
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                found.push(Source::read(path));
            }
        }
    }
    assert!(!found.is_empty());
    found
}

#[test]
fn a_folder_imports_only_those_of_the_plan() {
    for source in sources("src").iter().filter(|source| !source.folder().is_empty()) {
        let (path, own) = (source.path.display(), source.folder());
        let planned = FOLDERS.iter().find(|(folder, _)| *folder == own);
        let (_, upstream) = planned.unwrap_or_else(|| panic!("{path} is in no folder of the plan"));
        let mut named = source.folders_named();
        named.retain(|name| *name != own && !upstream.contains(name));
        assert!(named.is_empty(), "{path} names {named:?}");
    }
}

/// A file and its own folder count as one.
#[test]
fn no_files_import_each_other_in_a_circle() {
    let all: Vec<Source> = sources("src").into_iter().filter(|source| !source.is_test()).collect();
    let parents = |source: &Source| -> Vec<Vec<String>> {
        (1..source.modules.len()).map(|depth| source.modules[..depth].to_vec()).collect()
    };
    for folder in all.iter().flat_map(parents).collect::<BTreeSet<_>>() {
        let mut needs: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        let is_inside = |source: &&Source| {
            source.modules.len() > folder.len() && source.modules.starts_with(&folder)
        };
        for source in all.iter().filter(is_inside) {
            let own = source.modules[folder.len()].as_str();
            needs.entry(own).or_default().extend(source.neighbours_named(&folder));
        }
        // Removes each module that imports none of the remaining ones; modules that remain form a
        // circle.
        let is_free = |own: &str, others: &BTreeSet<&str>, needs: &BTreeMap<&str, _>| {
            others.iter().all(|other| *other == own || !needs.contains_key(other))
        };
        while let Some(free) =
            needs.iter().find(|(own, others)| is_free(own, others, &needs)).map(|(own, _)| *own)
        {
            needs.remove(free);
        }
        assert!(needs.is_empty(), "in {folder:?}: {needs:#?}");
    }
}

#[test]
fn the_state_names_neither_update_nor_view_and_update_no_view() {
    let rules: [(&str, &[&str]); 2] = [("update", &["view"]), ("app", &["update", "view"])];
    for source in sources("src/tui") {
        let Some((_, foreign)) = rules.iter().find(|(own, _)| source.modules[1] == *own) else {
            continue;
        };
        let mut named = source.neighbours_named(&["tui".to_owned()]);
        named.retain(|name| foreign.contains(name));
        assert!(named.is_empty(), "{} names {named:?}", source.path.display());
    }
}

#[test]
fn a_compliance_model_is_named_in_its_file_and_in_the_list_only() {
    let all = sources("src");
    for model in sources("src/model/compliance/tooth") {
        let name = model.modules.last().unwrap();
        let constant = format!("ToothCompliance::{}", name.to_uppercase());
        let is_home = |source: &&Source| {
            source.is_test()
                || source.path == model.path
                || source.path.ends_with("compliance/tooth.rs")
        };
        for source in all.iter().filter(|source| !is_home(source)) {
            let is_named = source.code().contains(&constant)
                || !after(source.code(), &format!("{name}::")).is_empty();
            assert!(!is_named, "{} names the compliance model {name}", source.path.display());
        }
    }
}

#[test]
fn terminal_system_and_files_are_named_in_their_folders_only() {
    for source in sources("src").iter().filter(|source| !source.is_test()) {
        for (words, folders) in NAMES {
            let is_named = |word: &&&str| {
                let mut places = after(source.code(), word).into_iter();
                places.any(|rest| word.ends_with(':') || !rest.starts_with(is_word))
            };
            let named: Vec<_> = words.iter().filter(is_named).collect();
            let may = folders.contains(&source.folder()) || named.is_empty();
            assert!(may, "{} names {named:?}", source.path.display());
        }
    }
}

#[test]
fn every_file_begins_with_a_sentence_and_is_short() {
    for source in sources("src").iter().chain(&sources("tests")) {
        let path = source.path.display();
        assert!(source.text.starts_with("//! "), "{path} has no first sentence");
        let lines = source.text.lines().count();
        let is_short = lines <= MOST_LINES || source.modules.is_empty();
        assert!(is_short, "{path} has {lines} lines");
    }
}

#[test]
fn paths_are_read_in_every_way_they_are_written() {
    let code = "use crate::{case::{Case, fields}, model, report::json}; use super::tui::App; \
            tipstrike::cli::run(); mycrate::numeric";
    let source = Source {
        path: "src/report.rs".into(),
        modules: vec!["report".to_owned()],
        text: String::new(),
        whole: code.to_owned(),
    };
    let named: Vec<&str> = source.folders_named().into_iter().collect();
    assert_eq!(named, ["case", "cli", "model", "report", "tui"]);
}
