//! Did you mean: the known name nearest to a mistyped one.

/// A longer text is no mistyped name, and comparing it would take long.
const LONGEST: usize = 64;

/// The nearest of the known names, where one is near enough to be meant.
pub(crate) fn nearest<'n>(typed: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    if typed.len() > LONGEST {
        return None;
    }
    let short = typed.chars().count() <= 2;
    let limit = if short { 0.4 } else { 0.65 };
    let likeness = |name: &str| {
        let same_letters = typed.eq_ignore_ascii_case(name);
        if same_letters { 1.0 } else { strsim::normalized_damerau_levenshtein(&typed.to_lowercase(), &name.to_lowercase()) }
    };
    known
        .map(|name| (likeness(name), name))
        .filter(|&(likeness, _)| likeness >= limit)
        .max_by(|(a, _), (b, _)| a.total_cmp(b))
        .map(|(_, name)| name)
}

/// "did you mean X?" in front of what fits, or what fits alone.
pub(crate) fn mend<'n>(typed: &str, known: impl Iterator<Item = &'n str>, otherwise: impl FnOnce() -> String) -> String {
    nearest(typed, known).map_or_else(otherwise, |name| format!("did you mean {name}?"))
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_slip_finds_its_name_and_another_word_finds_none() {
        let known = ["module", "pressure_angle", "centre_distance"];
        assert_eq!(nearest("modul", known.into_iter()), Some("module"));
        assert_eq!(nearest("center_distance", known.into_iter()), Some("centre_distance"));
        assert_eq!(nearest("colour", known.into_iter()), None);
    }
}
