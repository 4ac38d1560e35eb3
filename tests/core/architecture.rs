//! Architecture: the folders of `src` import only the planned ones, no files import each other in a
//! circle, and every file is short and starts with a sentence.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

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

/// Crates that use a terminal.
const TERMINAL: [&str; 3] = ["ratatui", "crossterm", "tui_input"];

/// Interfaces of Unix, which only the folder `system` may name outside tests.
const UNIX: [&str; 7] = ["std::os", "os::unix", "rustix", "nix", "libc", "signal_hook", "xattr"];

/// Names that the computation core may not use: file formats, files, threads, printing.
const OUTSIDE: [&str; 10] = [
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
];

const MOST_LINES: usize = 900;

struct Source {
    path: PathBuf,
    /// The text without comments.
    code: String,
    lines: usize,
    opening: String,
}

impl Source {
    fn read(path: PathBuf) -> Source {
        let text = fs::read_to_string(&path).unwrap();
        let code = text
            .lines()
            .map(|line| line.split("//").next().unwrap_or_default())
            .collect::<Vec<_>>()
            .join("\n");
        let opening = text.lines().next().unwrap_or_default().to_owned();
        Source { code, lines: text.lines().count(), opening, path }
    }

    /// The path from `src`, module by module: `["report", "json"]`.
    fn modules(&self) -> Vec<String> {
        let parts = self
            .path
            .components()
            .map(|part| part.as_os_str().to_string_lossy().replace(".rs", ""));
        parts.skip_while(|part| part != "src").skip(1).collect()
    }

    fn folder(&self) -> Option<&'static str> {
        let first = self.modules().first()?.clone();
        FOLDERS.iter().map(|&(folder, _)| folder).find(|folder| *folder == first)
    }

    /// The folders that the code names, in any syntax.
    fn folders_named(&self) -> BTreeSet<String> {
        let to_root = "super::".repeat(self.modules().len());
        let roots = ["crate::", "tipstrike::", to_root.as_str()];
        let named = roots.iter().flat_map(|root| after(&self.code, root)).flat_map(heads);
        named
            .filter(|name| FOLDERS.iter().any(|(folder, _)| folder == name))
            .map(str::to_owned)
            .collect()
    }

    /// The modules of this folder that the code names outside its tests.
    fn neighbours_named(&self, folder: &[&str]) -> BTreeSet<String> {
        let code = self.code.split("mod tests {").next().unwrap_or_default();
        let whole = format!("crate::{}::", folder.join("::"));
        let upwards = "super::".repeat(self.modules().len() - folder.len());
        let from_here =
            |rest: &&str| !code[..code.len() - rest.len() - upwards.len()].ends_with("super::");
        after(code, &whole)
            .chain(after(code, &upwards).filter(from_here))
            .flat_map(heads)
            .map(str::to_owned)
            .collect()
    }

    fn names(&self, word: &str) -> bool {
        after(&self.code, word).any(|rest| !rest.starts_with(is_word))
    }
}

/// The text after each occurrence of `word` that is not the tail of a longer word.
fn after<'a>(code: &'a str, word: &'a str) -> impl Iterator<Item = &'a str> {
    let whole = move |at: usize| !code[..at].ends_with(is_word);
    code.match_indices(word)
        .filter(move |&(at, _)| whole(at))
        .map(move |(at, _)| &code[at + word.len()..])
}

/// The first names of a path; a group in braces has several.
fn heads(path: &str) -> Vec<&str> {
    let Some(group) = path.strip_prefix('{') else {
        return vec![head(path)];
    };
    let mut found = vec![head(group)];
    let mut depth = 0;
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
}

fn head(path: &str) -> &str {
    path.trim_start().split(|c| !is_word(c)).next().unwrap_or_default()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn sources(folder: &str) -> Vec<Source> {
    let mut found = Vec::new();
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut found);
    assert!(!found.is_empty());
    found
}

fn collect(folder: &Path, found: &mut Vec<Source>) {
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(Source::read(path));
        }
    }
}

#[test]
fn a_folder_imports_only_those_of_the_plan() {
    for source in sources("src") {
        let Some((folder, upstream)) =
            FOLDERS.iter().find(|(folder, _)| source.folder() == Some(folder))
        else {
            continue;
        };
        let wrong: Vec<String> = source
            .folders_named()
            .into_iter()
            .filter(|name| name != folder && !upstream.contains(&name.as_str()))
            .collect();
        assert!(wrong.is_empty(), "{} names {wrong:?}", source.path.display());
    }
}

/// Every folder below `src`, as its modules: `["report", "explain"]`.
fn folders() -> BTreeSet<Vec<String>> {
    let parents = |source: Source| {
        let modules = source.modules();
        (1..modules.len()).map(move |depth| modules[..depth].to_vec())
    };
    sources("src").into_iter().flat_map(parents).collect()
}

/// A file and its own folder count as one.
#[test]
fn no_files_import_each_other_in_a_circle() {
    for modules in &folders() {
        let folder = modules.join("/");
        let modules: Vec<_> = modules.iter().map(String::as_str).collect();
        let mut needs: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        let are_no_tests =
            |source: &Source| source.modules().last().is_none_or(|last| last != "tests");
        for source in sources(&format!("src/{folder}")).into_iter().filter(are_no_tests) {
            let own = source.modules()[modules.len()].clone();
            needs.entry(own).or_default().extend(source.neighbours_named(&modules));
        }
        // Removes each module that imports none of the remaining ones; modules that remain form a
        // circle.
        while let Some(free) = needs.iter().find(|(own, others)| {
            others.iter().all(|other| other == *own || !needs.contains_key(other))
        }) {
            let free = free.0.clone();
            needs.remove(&free);
        }
        assert!(needs.is_empty(), "in {folder}: {needs:#?}");
    }
}

#[test]
fn update_names_no_view_and_a_pane_does_not_name_the_workbench() {
    let rules: [(&str, &[&str]); 3] = [
        ("update", &["view"]),
        ("panes", &["app", "tab", "update", "view"]),
        ("app", &["update", "view"]),
    ];
    for source in sources("src/tui") {
        let modules = source.modules();
        let Some((_, foreign)) = rules.iter().find(|(own, _)| modules[1] == *own) else { continue };
        let named = source.neighbours_named(&["tui"]);
        let wrong: Vec<_> = foreign.iter().filter(|name| named.contains(**name)).collect();
        assert!(wrong.is_empty(), "{} names {wrong:?}", source.path.display());
    }
}

#[test]
fn a_compliance_model_is_named_in_its_file_and_in_the_list_only() {
    for model in sources("src/model/compliance/tooth") {
        let name = model.modules().pop().unwrap();
        let constant = format!("ToothCompliance::{}", name.to_uppercase());
        let module = format!("{name}::");
        for source in sources("src") {
            let code = source.code.split("mod tests {").next().unwrap_or_default();
            let path = source.path.display().to_string();
            let is_test = path.ends_with("tests.rs");
            let is_home =
                path.ends_with("compliance/tooth.rs") || path == model.path.display().to_string();
            let is_named = code.contains(&constant) || after(code, &module).next().is_some();
            assert!(is_test || is_home || !is_named, "{path} names the compliance model {name}");
        }
    }
}

#[test]
fn every_file_of_the_library_is_in_a_folder_of_the_plan() {
    for source in sources("src") {
        let known =
            source.folder().is_some() || ["lib", "main"].contains(&source.modules()[0].as_str());
        assert!(known, "{} is in no folder of the plan", source.path.display());
    }
}

#[test]
fn only_the_workbench_names_the_terminal() {
    for source in sources("src").iter().filter(|source| source.folder() != Some("tui")) {
        let named: Vec<_> = TERMINAL.iter().filter(|name| source.names(name)).collect();
        assert!(named.is_empty(), "{} names {named:?}", source.path.display());
    }
}

#[test]
fn only_the_folder_system_names_an_interface_of_unix() {
    for source in sources("src").iter().filter(|source| source.folder() != Some("system")) {
        let code = source.code.split("mod tests {").next().unwrap_or_default();
        let named: Vec<_> = UNIX
            .iter()
            .filter(|word| after(code, word).any(|rest| rest.starts_with("::")))
            .collect();
        assert!(named.is_empty(), "{} names {named:?}", source.path.display());
    }
}

#[test]
fn the_core_knows_no_files_no_threads_and_no_printing() {
    let is_test = |source: &Source| source.path.ends_with("tests.rs");
    for source in sources("src")
        .iter()
        .filter(|source| matches!(source.folder(), Some("numeric" | "model")) && !is_test(source))
    {
        let named: Vec<_> = OUTSIDE.iter().filter(|name| source.names(name)).collect();
        assert!(named.is_empty(), "{} names {named:?}", source.path.display());
    }
}

#[test]
fn every_file_begins_with_a_sentence_and_is_short() {
    for source in sources("src").iter().chain(&sources("tests")) {
        let path = source.path.display();
        assert!(source.opening.starts_with("//! "), "{path} opens with {:?}", source.opening);
    }
    for source in sources("src") {
        assert!(source.lines <= MOST_LINES, "{} has {} lines", source.path.display(), source.lines);
    }
}

#[test]
fn paths_are_read_in_every_way_they_are_written() {
    let code = "use crate::{case::{Case, fields}, model, report::json}; use super::tui::App; \
            tipstrike::cli::run(); mycrate::numeric";
    let source = Source {
        path: "src/report.rs".into(),
        code: code.to_owned(),
        lines: 1,
        opening: String::new(),
    };
    let named: Vec<String> = source.folders_named().into_iter().collect();
    assert_eq!(named, ["case", "cli", "model", "report", "tui"]);
}
