//! Changes of the command line to a case: a variant, fields and the method.

use std::ffi::OsStr;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::Error;
use clap::{Arg, Args};

use super::misused;
use crate::case::Case;
use crate::model::inputs::Method;

/// Values that replace those of a case: those of a variant first, then single fields.
#[derive(Debug, Clone, Default, PartialEq, Eq, Args)]
pub struct Edits {
    /// Use this variant of the case, a table [variants.NAME]
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
    /// Change a field of the case, such as "operation.speed=3000 rpm"
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = Settings)]
    pub settings: Vec<Setting>,
}

/// The method and the values that replace those of a case.
#[derive(Debug, Args)]
pub struct Changes {
    /// Use this method instead of the method of the case
    #[arg(long, value_parser = methods())]
    method: Option<Method>,
    /// The values
    #[command(flatten)]
    edits: Edits,
}

impl Changes {
    /// The variant and the fields; the method is the last field.
    #[must_use]
    pub fn edits(&self) -> Edits {
        let mut edits = self.edits.clone();
        edits.settings.extend(by_method(self.method));
        edits
    }
}

/// `--method` as a setting of a field.
pub(in crate::cli) fn by_method(method: Option<Method>) -> Option<Setting> {
    method.map(|method| Setting::by("--method", "model.method", method.name()))
}

/// A field and its new value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// The key of the field or limit.
    pub key: String,
    /// The new text of the field.
    pub value: String,
    /// The option of the setting.
    option: &'static str,
}

impl Setting {
    /// The setting of a field by an option.
    #[must_use]
    pub fn by(option: &'static str, key: &str, value: &str) -> Setting {
        Setting { key: key.to_owned(), value: value.to_owned(), option }
    }

    /// The setting in the syntax of the command line.
    #[must_use]
    pub fn written(&self) -> String {
        match self.option {
            SET => format!("{SET} {}={}", self.key, self.value),
            option => format!("{option} {}", self.value),
        }
    }
}

/// The option that changes any field.
const SET: &str = "--set";

/// Parser of a field and its value; checks each separately.
#[derive(Clone)]
pub(in crate::cli) struct Settings;

impl TypedValueParser for Settings {
    type Value = Setting;

    fn parse_ref(
        &self,
        _: &clap::Command,
        _: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Setting, Error> {
        let text = value.to_string_lossy();
        setting(&text).map_err(|cause| misused(format!("{SET} {text}: {cause}")))
    }
}

/// Parses a setting and checks that the field accepts the value in some case.
fn setting(text: &str) -> Result<Setting, String> {
    let (key, value) = text
        .split_once('=')
        .ok_or("no value is given: write KEY=VALUE, such as \"operation.speed=3000 rpm\"")?;
    Case::empty()
        .set(key.trim(), value)
        .map_err(|problem| format!("{}: {}", problem.cause, problem.fix))?;
    Ok(Setting::by(SET, key.trim(), value))
}

/// Parses a number of stations.
pub(in crate::cli) fn station_count(text: &str) -> Result<String, String> {
    setting(&format!("model.stations={text}")).map(|setting| setting.value)
}

pub(in crate::cli) fn methods() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name)).try_map(|name| {
        Method::ALL.into_iter().find(|method| method.name() == name).ok_or("no such method")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_is_split_at_the_first_equals_sign() {
        assert_eq!(setting("title=a=b"), Ok(Setting::by(SET, "title", "a=b")));
        assert!(setting("pair.modul=5 mm").unwrap_err().contains("did you mean pair.module?"));
        assert!(setting("pair.module").unwrap_err().contains("KEY=VALUE"));
    }
}
