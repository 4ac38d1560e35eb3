//! The example cases of the program, from the folder `cases`, each with its source.

use super::Document;
use super::sanitize::suggestion;

/// An example case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Example {
    /// The file name without its extension.
    pub name: &'static str,
    /// The text of its file.
    pub text: &'static str,
}

macro_rules! examples {
    ($($name:literal),+ $(,)?) => {
        &[$(Example { name: $name, text: include_str!(concat!("../../cases/", $name, ".toml")) }),+]
    };
}

/// Every example. The workbench opens the first one by default.
pub static EXAMPLES: &[Example] = examples![
    "zhou-chen-2014",
    "fzg-type-c",
    "nasa-lewis-28-28",
    "high-contact-ratio",
    "tip-relief-enough",
    "hydro-speed-up",
    "mill-coarse-slow",
    "turbo-fine-fast",
    "helical-20-35",
];

impl Example {
    /// The example with this name, with or without the file extension.
    ///
    /// # Errors
    /// If no example has this name. The message suggests a name.
    pub fn find(name: &str) -> Result<&'static Example, String> {
        let name = name.strip_suffix(".toml").unwrap_or(name);
        let found = EXAMPLES.iter().find(|example| example.name == name);
        let names = EXAMPLES.iter().map(|example| example.name);
        found.ok_or_else(|| {
            suggestion(name, names.clone(), || {
                format!("use one of {}", names.collect::<Vec<_>>().join(", "))
            })
        })
    }

    /// The example as a document without a file.
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
        // The workbench keeps the lock file of an open case beside it.
        let kept: BTreeSet<String> = names.filter(|name| !name.starts_with('.')).collect();
        let known: BTreeSet<String> =
            EXAMPLES.iter().map(|example| format!("{}.toml", example.name)).collect();
        assert_eq!(kept, known, "list it in src/case/examples.rs");
        for example in EXAMPLES {
            assert!(
                Document::parse(example.name, example.text)
                    .is_ok_and(|document| document.case.inputs().is_ok())
            );
        }
    }

    #[test]
    fn a_misspelled_name_suggests_the_example() {
        assert_eq!(Example::find("fzg-type-c.toml").map(|example| example.name), Ok("fzg-type-c"));
        assert_eq!(Example::find("fzg-type"), Err("did you mean fzg-type-c?".to_owned()));
    }
}
