//! Quantities on the command line, by name or symbol.

use std::ffi::OsStr;

use clap::Arg;
use clap::builder::{PossibleValue, TypedValueParser};
use clap::error::Error;

use super::misused;
use crate::case::{Problem, unknown_quantity};
use crate::model::{QUANTITIES, Quantity};

/// Parser of a quantity by its name or its symbol.
#[derive(Clone)]
pub(in crate::cli) struct Quantities;

impl TypedValueParser for Quantities {
    type Value = &'static Quantity;

    fn parse_ref(
        &self,
        _: &clap::Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, Error> {
        let text = value.to_string_lossy();
        let name = argument
            .and_then(Arg::get_long)
            .map_or("QUANTITY".to_owned(), |long| format!("--{long}"));
        Quantity::named(text.trim()).ok_or_else(|| {
            let Problem { cause, fix, .. } = unknown_quantity("", &text);
            misused(format!("{name}: {cause}: {fix}"))
        })
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(QUANTITIES.iter().map(|quantity| PossibleValue::new(quantity.key))))
    }
}

/// Parser of a comma-separated list of quantities; a comma may be part of a symbol, as in
/// `F_d,max`.
#[derive(Clone)]
pub(in crate::cli) struct QuantityList;

impl TypedValueParser for QuantityList {
    type Value = Vec<&'static Quantity>;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, Error> {
        let text = value.to_string_lossy();
        let one = |name: &String| Quantities.parse_ref(command, argument, OsStr::new(name));
        names(&text).iter().map(one).collect()
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Quantities.possible_values()
    }
}

/// The names in a list: a part that continues a symbol is joined with the previous part.
fn names(list: &str) -> Vec<String> {
    let is_symbol = |name: &str| {
        let mut symbols = QUANTITIES.iter().map(|quantity| quantity.symbol);
        symbols.any(|symbol| symbol.eq_ignore_ascii_case(name))
    };
    let mut names: Vec<String> = Vec::new();
    for part in list.split(',').map(str::trim) {
        let joined = names.last().map(|before| format!("{before},{part}"));
        match joined.filter(|joined| is_symbol(joined)) {
            Some(joined) => {
                names.pop();
                names.push(joined);
            }
            None => names.push(part.to_owned()),
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_in_a_symbol_does_not_end_a_name() {
        assert_eq!(
            names("F_d,max, F_d,DE,impact_force,F_S,T_S,32"),
            ["F_d,max", "F_d,DE", "impact_force", "F_S", "T_S,32"]
        );
        let list = QUANTITIES.iter().map(|quantity| quantity.symbol);
        assert!(list.clone().eq(names(&list.collect::<Vec<_>>().join(","))));
    }
}
