//! The cases that come with the program, each with its source: the texts of the folder `cases`.

use super::Document;
use super::suggest::fix;

/// A case to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Example {
    /// The name of its file, without the ending.
    pub name: &'static str,
    /// The text of its file.
    pub text: &'static str,
}

macro_rules! examples {
    ($($name:literal),+ $(,)?) => {
        &[$(Example { name: $name, text: include_str!(concat!("../../cases/", $name, ".toml")) }),+]
    };
}

/// Every example, the one on which the workbench opens first.
pub static EXAMPLES: &[Example] = examples![
    "zhou-chen-2014",
    "fzg-type-c",
    "nasa-lewis-28-28",
    "high-contact-ratio",
    "tip-relief-enough",
    "hydro-speed-up",
    "mill-coarse-slow",
    "turbo-fine-fast",
];

impl Example {
    /// The example of that name, with or without the ending of its file.
    ///
    /// # Errors
    /// Where there is none: what to write instead.
    pub fn find(name: &str) -> Result<&'static Example, String> {
        let name = name.strip_suffix(".toml").unwrap_or(name);
        let found = EXAMPLES.iter().find(|example| example.name == name);
        found.ok_or_else(|| {
            fix(name, EXAMPLES.iter().map(|example| example.name), || {
                "use one of the list".to_owned()
            })
        })
    }

    /// The example as a document without a file.
    #[must_use]
    pub fn document(&self) -> Document {
        Document::parse(self.name, self.text).unwrap_or_else(|_| Document::table_1())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::Path;

    #[test]
    fn every_case_of_the_folder_is_an_example_and_opens() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
        let names = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap());
        // A workbench that has one open keeps its lock beside it.
        let kept: BTreeSet<String> = names.filter(|name| !name.starts_with('.')).collect();
        let known: BTreeSet<String> = EXAMPLES
            .iter()
            .map(|example| format!("{}.toml", example.name))
            .collect();
        assert_eq!(kept, known, "list it in src/case/examples.rs");
        for example in EXAMPLES {
            assert!(
                Document::parse(example.name, example.text)
                    .is_ok_and(|document| document.case.inputs().is_ok())
            );
        }
    }

    #[test]
    fn a_slip_in_a_name_finds_it() {
        assert_eq!(
            Example::find("fzg-type-c.toml").map(|example| example.name),
            Ok("fzg-type-c")
        );
        assert_eq!(
            Example::find("fzg-type"),
            Err("did you mean fzg-type-c?".to_owned())
        );
    }
}
