//! The appearance: the colours, the capabilities of the terminal, and the settings for every case, in
//! a separate file.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use toml_edit::{DocumentMut, Item, Value};

use crate::case::file::{self, SaveError};
use crate::case::sanitize::sanitize;
use crate::case::units::System;

/// Markers and their names in the file.
const MARKERS: [(&str, Marker); 3] =
    [("braille", Marker::Braille), ("halfblock", Marker::HalfBlock), ("dot", Marker::Dot)];

/// Greatest size of a settings file.
const MOST_BYTES: u64 = 64 * 1024;

/// Settings for every case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Settings {
    /// The marker of a chart's points.
    pub marker: Marker,
    /// Whether the workbench uses the mouse.
    pub mouse: bool,
    /// The colours; by default those of the environment.
    pub(crate) theme: Option<&'static Theme>,
    /// The display units.
    pub units: System,
    /// Whether the screen uses only ASCII, even if the terminal supports Unicode.
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
    /// Parses the settings; missing keys and unknown values become the defaults.
    pub(crate) fn parse(text: &str) -> Settings {
        let usual = Settings::default();
        let Ok(file) = text.parse::<DocumentMut>() else {
            return usual;
        };
        let word = |key| file.get(key).and_then(|item| item.as_str());
        let flag = |key| file.get(key).and_then(Item::as_bool);
        Settings {
            marker: word("marker").and_then(marker_of).unwrap_or(usual.marker),
            mouse: flag("mouse").unwrap_or(usual.mouse),
            theme: word("theme").and_then(Theme::find),
            units: word("units").and_then(System::find).unwrap_or(usual.units),
            ascii: flag("ascii").unwrap_or(usual.ascii),
        }
    }

    /// The text of a settings file with these settings; other lines of the text do not change.
    ///
    /// # Errors
    /// Returns an error if the old text is not valid TOML: the user has to fix it.
    pub(crate) fn render(self, old: &str) -> Result<String, String> {
        let mut file: DocumentMut = old
            .parse()
            .map_err(|_| "the settings are not valid TOML: fix or delete the file".to_owned())?;
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
        set("theme", self.theme.map(|theme| theme.name.into()));
        set("units", Some(self.units.name().into()));
        set("ascii", self.ascii.then(|| true.into()));
        Ok(file.to_string())
    }

    /// Saved settings, or the defaults if there are none.
    pub(crate) fn read() -> Settings {
        let text = file().and_then(|file| old_text(&file).ok());
        Settings::parse(&text.unwrap_or_default())
    }

    /// Writes the settings as a save writes a case: follows links, keeps the mode, and leaves
    /// either the old or the complete new file if an error occurs.
    ///
    /// # Errors
    /// The reason, as text.
    pub(crate) fn keep(self) -> Result<(), String> {
        let file = file().ok_or("HOME and XDG_CONFIG_HOME name no folder")?;
        self.write_to(&file)
    }

    fn write_to(self, file: &Path) -> Result<(), String> {
        let name = || sanitize(&file.display().to_string());
        let in_words = |error: io::Error| format!("{}: {error}", name());
        if let Some(folder) = file.parent() {
            fs::create_dir_all(folder).map_err(in_words)?;
        }
        let text = self.render(&old_text(file).map_err(in_words)?);
        let text = text.map_err(|reason| format!("{}: {reason}", name()))?;
        file::write(file, text.as_bytes(), true).map_err(|error| match error {
            SaveError::ReadOnly(name) => {
                format!("{name}: the file is read-only: make it writable (chmod u+w)")
            }
            SaveError::HardLinked(name, count) => format!(
                "{name}: the file has {count} names (hard links): use a symbolic link instead"
            ),
            other => other.to_string(),
        })
    }
}

/// The name of a marker in the file.
pub(crate) fn marker_name(marker: Marker) -> &'static str {
    MARKERS.iter().find(|(_, known)| *known == marker).map_or("braille", |(name, _)| name)
}

fn marker_of(name: &str) -> Option<Marker> {
    MARKERS.iter().find(|(known, _)| *known == name).map(|&(_, marker)| marker)
}

fn old_text(file: &Path) -> io::Result<String> {
    match fs::metadata(file) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
        Err(error) => Err(error),
        Ok(about) if !about.is_file() || about.len() > MOST_BYTES => {
            Err(io::Error::other("this is not a settings file"))
        }
        Ok(_) => fs::read_to_string(file),
    }
}

fn file() -> Option<PathBuf> {
    let own = env::var_os("XDG_CONFIG_HOME").map(PathBuf::from).filter(|path| path.is_absolute());
    let folder = own.map(|path| path.join("tipstrike"));
    let folder =
        folder.or_else(|| Some(ProjectDirs::from("", "", "tipstrike")?.config_dir().to_owned()));
    folder.map(|folder| folder.join("settings.toml"))
}

/// The style of each kind of text. No meaning depends on colour alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Theme {
    /// The name in the settings.
    pub(crate) name: &'static str,
    /// Titles of panes and groups.
    pub(crate) title: Style,
    /// Rules and axes.
    pub(crate) rule: Style,
    /// The focused line.
    pub(crate) focus: Style,
    /// Defaults of empty fields, and outdated results.
    pub(crate) faint: Style,
    /// Errors.
    pub(crate) problem: Style,
    /// Notes.
    pub(crate) note: Style,
    /// The method of the case, and its curve.
    pub(crate) active: Style,
    /// Another method, and its curve.
    pub(crate) other: Style,
    /// The name of a key, and the title of the focused pane.
    pub(crate) key: Style,
    /// The pinned results, and their curve.
    pub(crate) baseline: Style,
    /// The driver's outline.
    pub(crate) driver: Style,
    /// The driven gear's outline.
    pub(crate) driven: Style,
    /// The path of contact.
    pub(crate) path: Style,
}

/// Every theme.
pub(crate) static THEMES: [&Theme; 3] = [&QUIET, &CONTRAST, &MONO];

impl Theme {
    /// The theme with a name in the settings.
    pub(crate) fn find(name: &str) -> Option<&'static Theme> {
        THEMES.into_iter().find(|theme| theme.name == name)
    }

    /// The next theme, wrapping around.
    pub(crate) fn next(&self) -> &'static Theme {
        let at = THEMES.iter().position(|theme| *theme == self).unwrap_or(0);
        THEMES[(at + 1) % THEMES.len()]
    }
}

/// The capabilities of the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// Colours and attributes.
    pub theme: &'static Theme,
    /// Whether the screen uses only ASCII.
    pub ascii: bool,
}

/// Attributes and a few of the terminal's own colours.
pub(crate) static QUIET: Theme = Theme {
    name: "quiet",
    title: Style::new().cyan().bold(),
    rule: Style::new(),
    focus: Style::new().bold(),
    faint: Style::new().dim(),
    problem: Style::new().red().bold(),
    note: Style::new().yellow(),
    active: Style::new().green().bold(),
    other: Style::new().magenta(),
    key: Style::new().reversed(),
    // Plain blue is hard to read on black.
    baseline: Style::new().light_blue(),
    driver: Style::new().cyan(),
    driven: Style::new().yellow(),
    path: Style::new().magenta(),
};

/// Bright colours and bold letters, for terminals on which the quiet ones are hard to read.
pub static CONTRAST: Theme = Theme {
    name: "contrast",
    title: Style::new().light_cyan().bold(),
    focus: Style::new().bold().underlined(),
    faint: Style::new(),
    problem: Style::new().light_red().bold(),
    note: Style::new().light_yellow().bold(),
    active: Style::new().light_green().bold(),
    other: Style::new().light_magenta().bold(),
    baseline: Style::new().light_blue().bold(),
    driver: Style::new().light_cyan(),
    driven: Style::new().light_yellow(),
    path: Style::new().light_magenta(),
    ..QUIET
};

/// Attributes only.
pub static MONO: Theme = Theme {
    name: "mono",
    title: Style::new().bold(),
    problem: Style::new().bold(),
    note: Style::new(),
    active: Style::new().bold(),
    other: Style::new(),
    baseline: Style::new(),
    driver: Style::new(),
    driven: Style::new(),
    path: Style::new(),
    ..QUIET
};

impl Look {
    /// Colours and full Unicode.
    pub const FULL: Look = Look { theme: &QUIET, ascii: false };

    /// The settings, limited by the environment: `NO_COLOR`, `TERM`, and the locale by `LC_ALL`,
    /// `LC_CTYPE`, `LANG`. No setting restores colours or characters that the environment lacks.
    pub(crate) fn of(settings: &Settings, variable: impl Fn(&str) -> Option<OsString>) -> Look {
        let set = |name| variable(name).filter(|value| !value.is_empty());
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(set).unwrap_or_default();
        let locale = locale.to_string_lossy().to_ascii_lowercase();
        let utf8 = locale.contains("utf-8") || locale.contains("utf8");
        let term = set("TERM").unwrap_or_default();
        let bare = term == "linux" || term.to_string_lossy().starts_with("vt");
        let usual = settings.theme.unwrap_or(&QUIET);
        Look {
            theme: if set("NO_COLOR").is_some() { &MONO } else { usual },
            ascii: settings.ascii || bare || !utf8,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::Permissions;
    use std::os::unix::fs::{PermissionsExt, symlink};

    #[test]
    fn unknown_settings_remain_in_the_file() {
        let old =
            "# mine\nlater = 3\nmarker = \"dot\" # small\nmouse = false\n\n[future]\nkey = 1\n";
        let settings = Settings { mouse: true, ..Settings::parse(old) };
        let new = settings.render(old).expect("it is TOML");
        assert_eq!(Settings::parse(&new), settings);
        for kept in
            ["# mine", "later = 3", "[future]\nkey = 1", "marker = \"dot\" # small", "mouse = true"]
        {
            assert!(new.contains(kept), "{new}");
        }
    }

    #[test]
    fn every_setting_is_saved_and_read() {
        for theme in THEMES.map(Some).into_iter().chain([None]) {
            for (units, ascii) in
                [(System::Metric, false), (System::Inch, true), (System::Inch, false)]
            {
                let settings = Settings { marker: Marker::Dot, mouse: true, theme, units, ascii };
                assert_eq!(
                    Settings::parse(&settings.render("").expect("nothing is TOML")),
                    settings
                );
            }
        }
    }

    #[test]
    fn a_linked_file_stays_a_link_and_its_target_keeps_its_mode() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let dotfile = path("dotfile.toml");
        fs::write(&dotfile, "# mine\n").expect("room on the disk");
        fs::set_permissions(&dotfile, Permissions::from_mode(0o640)).expect("our own file");
        symlink("dotfile.toml", path("settings.toml")).expect("a link");
        let settings = Settings { mouse: true, ..Settings::default() };
        assert_eq!(settings.write_to(&path("settings.toml")), Ok(()));
        assert!(path("settings.toml").is_symlink());
        let text = fs::read_to_string(&dotfile).expect("it is there");
        assert!(text.contains("# mine") && text.contains("mouse = true"), "{text}");
        let mode = fs::metadata(&dotfile).expect("it is there").permissions().mode();
        assert_eq!(mode & 0o7777, 0o640);
    }

    #[test]
    fn settings_that_cannot_be_written_name_the_fix() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        fs::write(path("settings.toml"), "").expect("room on the disk");
        fs::hard_link(path("settings.toml"), path("other")).expect("a link");
        let refused = Settings::default().write_to(&path("settings.toml"));
        assert!(refused.is_err_and(|reason| reason.ends_with("use a symbolic link instead")));
        symlink("none/settings.toml", path("dangling")).expect("a link");
        let refused = Settings::default().write_to(&path("dangling"));
        assert!(refused.is_err_and(|reason| reason.contains("mkdir -p")));
    }

    #[test]
    fn invalid_toml_is_not_overwritten() {
        assert_eq!(Settings::parse("no toml ["), Settings::default());
        assert!(Settings::default().render("no toml [").is_err());
    }

    #[test]
    fn no_color_overrides_the_theme_of_the_settings() {
        let settings = Settings { theme: Some(&CONTRAST), ..Settings::default() };
        assert_eq!(Look::of(&settings, |_| Some("1".into())).theme, &MONO);
        assert_eq!(Look::of(&settings, |_| None).theme, &CONTRAST);
    }

    fn look(variables: &[(&str, &str)]) -> Look {
        Look::of(&Settings::default(), |name| {
            variables.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).into())
        })
    }

    #[test]
    fn unicode_needs_a_utf8_locale_and_a_terminal_with_the_fonts() {
        assert!(!look(&[("TERM", "xterm"), ("LANG", "en_GB.UTF-8")]).ascii);
        assert!(!look(&[("TERM", "xterm"), ("LC_ALL", "C.utf8"), ("LANG", "C")]).ascii);
        for variables in [
            &[("TERM", "xterm"), ("LANG", "C")][..],
            &[("TERM", "xterm")],
            &[("TERM", "linux"), ("LANG", "C.UTF-8")],
            &[("TERM", "vt100"), ("LANG", "C.UTF-8")],
            &[("TERM", "xterm"), ("LC_ALL", "POSIX"), ("LANG", "C.UTF-8")],
        ] {
            assert!(look(variables).ascii, "{variables:?}");
        }
    }

    #[test]
    fn no_color_leaves_no_colour() {
        let theme = look(&[("NO_COLOR", "1")]).theme;
        for style in [
            theme.title,
            theme.problem,
            theme.note,
            theme.active,
            theme.other,
            theme.key,
            theme.baseline,
            theme.driver,
            theme.driven,
            theme.path,
        ] {
            assert_eq!(style.fg.or(style.bg), None);
        }
        assert_eq!(look(&[("NO_COLOR", "")]).theme, &QUIET);
    }
}
