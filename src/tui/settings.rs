//! What the user chose for every case: marker, mouse, theme, units, ASCII; kept in a file of its
//! own.

use std::env;
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use directories::ProjectDirs;
use ratatui::symbols::Marker;
use tempfile::NamedTempFile;
use toml_edit::{DocumentMut, Item, Value};

use super::theme::{Look, ThemeName};
use crate::case::units::System;

/// Markers by their names in the file.
const MARKERS: [(&str, Marker); 3] = [
    ("braille", Marker::Braille),
    ("halfblock", Marker::HalfBlock),
    ("dot", Marker::Dot),
];

/// A longer file is none of ours.
const MOST_BYTES: u64 = 64 * 1024;

/// What the user chose for every case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// How the chart draws a point.
    pub marker: Marker,
    /// Whether the workbench takes the mouse.
    pub mouse: bool,
    /// The colours; else what the environment asks for.
    pub theme: Option<ThemeName>,
    /// The units in which values are shown beside what was typed.
    pub units: System,
    /// Whether nothing but ASCII is drawn, whatever the environment is able to show.
    pub ascii: bool,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings {
            marker: Marker::Braille,
            mouse: false,
            theme: None,
            units: System::Metric,
            ascii: false,
        }
    }
}

impl Settings {
    /// The settings of a file's text. What it does not say, or says in words that are not known
    /// here, is as usual.
    #[must_use]
    pub fn parse(text: &str) -> Settings {
        let usual = Settings::default();
        let Ok(file) = text.parse::<DocumentMut>() else {
            return usual;
        };
        let word = |key| file.get(key).and_then(|item| item.as_str());
        let flag = |key| file.get(key).and_then(Item::as_bool);
        Settings {
            marker: word("marker").and_then(marker_of).unwrap_or(usual.marker),
            mouse: flag("mouse").unwrap_or(usual.mouse),
            theme: word("theme").and_then(|name| {
                ThemeName::ALL
                    .into_iter()
                    .find(|theme| theme.name() == name)
            }),
            units: word("units").and_then(System::find).unwrap_or(usual.units),
            ascii: flag("ascii").unwrap_or(usual.ascii),
        }
    }

    /// The text of the file with these settings; all else that stands in it stays.
    ///
    /// # Errors
    /// Where the old text is no TOML: then it is the user's to mend.
    pub fn render(&self, old: &str) -> Result<String, String> {
        let mut file: DocumentMut = old
            .parse()
            .map_err(|_| "the settings are no TOML: mend or delete the file".to_owned())?;
        let mut set = |key: &str, new: Option<Value>| match (
            new,
            file.get_mut(key).and_then(Item::as_value_mut),
        ) {
            (Some(mut new), Some(old)) => {
                *new.decor_mut() = old.decor().clone();
                *old = new;
            }
            (Some(new), None) => file[key] = Item::Value(new),
            (None, _) => drop(file.remove(key)),
        };
        set("marker", Some(marker_name(self.marker).into()));
        set("mouse", Some(self.mouse.into()));
        set("theme", self.theme.map(|theme| theme.name().into()));
        set("units", Some(self.units.name().into()));
        set("ascii", self.ascii.then(|| true.into()));
        Ok(file.to_string())
    }

    /// What the user kept, as usual where there is nothing to be read.
    #[must_use]
    pub fn read() -> Settings {
        file()
            .and_then(|file| old_text(&file).ok())
            .map_or_else(Settings::default, |text| Settings::parse(&text))
    }

    /// Keep them: the old file or the new one, never half of one.
    ///
    /// # Errors
    /// The reason, in words.
    pub fn keep(&self) -> Result<(), String> {
        let file = file().ok_or("the system names no folder for settings")?;
        let told = |error: io::Error| format!("{}: {error}", file.display());
        let folder = file
            .parent()
            .ok_or("the system names no folder for settings")?;
        fs::create_dir_all(folder).map_err(told)?;
        let text = self
            .render(&old_text(&file).map_err(told)?)
            .map_err(|reason| format!("{}: {reason}", file.display()))?;
        let write = || {
            let mut new = NamedTempFile::new_in(folder)?;
            new.write_all(text.as_bytes())?;
            new.as_file().sync_all()?;
            new.persist(&file).map_err(|error| error.error).map(drop)
        };
        write().map_err(told)
    }

    /// What the terminal is able to show, as far as the user does not want it otherwise. No setting
    /// brings colours or letters back that the environment takes away.
    #[must_use]
    pub fn look(&self, able: Look, variable: impl Fn(&str) -> bool) -> Look {
        let theme = self
            .theme
            .filter(|_| !variable("NO_COLOR"))
            .map_or(able.theme, ThemeName::theme);
        Look {
            theme,
            ascii: self.ascii || able.ascii,
        }
    }
}

/// The name of a marker in the file.
#[must_use]
pub fn marker_name(marker: Marker) -> &'static str {
    MARKERS
        .iter()
        .find(|(_, known)| *known == marker)
        .map_or("braille", |(name, _)| name)
}

fn marker_of(name: &str) -> Option<Marker> {
    MARKERS
        .iter()
        .find(|(known, _)| *known == name)
        .map(|&(_, marker)| marker)
}

fn old_text(file: &PathBuf) -> io::Result<String> {
    match fs::metadata(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
        Err(error) => Err(error),
        Ok(about) if !about.is_file() || about.len() > MOST_BYTES => {
            Err(io::Error::other("this is no file of settings"))
        }
        Ok(_) => fs::read_to_string(file),
    }
}

fn file() -> Option<PathBuf> {
    let own = env::var_os("XDG_CONFIG_HOME")
        .map(PathBuf::from)
        .filter(|path| path.is_absolute());
    let folder = own.map(|path| path.join("tipstrike"));
    let folder = folder.or_else(|| {
        Some(
            ProjectDirs::from("", "", "tipstrike")?
                .config_dir()
                .to_owned(),
        )
    });
    folder.map(|folder| folder.join("settings.toml"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::theme::{MONO, QUIET};

    #[test]
    fn what_is_not_known_here_stays_in_the_file() {
        let old =
            "# mine\nlater = 3\nmarker = \"dot\" # small\nmouse = false\n\n[future]\nkey = 1\n";
        let settings = Settings {
            mouse: true,
            ..Settings::parse(old)
        };
        let new = settings.render(old).expect("it is TOML");
        assert_eq!(Settings::parse(&new), settings);
        for kept in [
            "# mine",
            "later = 3",
            "[future]\nkey = 1",
            "marker = \"dot\" # small",
            "mouse = true",
        ] {
            assert!(new.contains(kept), "{new}");
        }
    }

    #[test]
    fn every_setting_comes_back() {
        for theme in ThemeName::ALL.map(Some).into_iter().chain([None]) {
            for (units, ascii) in [
                (System::Metric, false),
                (System::Inch, true),
                (System::Inch, false),
            ] {
                let settings = Settings {
                    marker: Marker::Dot,
                    mouse: true,
                    theme,
                    units,
                    ascii,
                };
                assert_eq!(
                    Settings::parse(&settings.render("").expect("nothing is TOML")),
                    settings
                );
            }
        }
    }

    #[test]
    fn what_is_no_toml_is_not_written_over() {
        assert_eq!(Settings::parse("no toml ["), Settings::default());
        assert!(Settings::default().render("no toml [").is_err());
    }

    #[test]
    fn a_theme_of_the_settings_gives_way_to_no_color() {
        let settings = Settings {
            theme: Some(ThemeName::Quiet),
            ..Settings::default()
        };
        assert_eq!(
            settings
                .look(
                    Look {
                        theme: &MONO,
                        ascii: false
                    },
                    |_| true
                )
                .theme,
            &MONO
        );
        assert_eq!(
            settings
                .look(
                    Look {
                        theme: &MONO,
                        ascii: false
                    },
                    |_| false
                )
                .theme,
            &QUIET
        );
    }
}
