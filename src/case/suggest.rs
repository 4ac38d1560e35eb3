//! Suggestions of the known name nearest to a mistyped one.

/// Length limit of a mistyped name, because a comparison of long texts is slow.
const LONGEST: usize = 64;

/// The nearest known name if it is near enough.
pub(crate) fn nearest<'n>(typed: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    if typed.len() > LONGEST {
        return None;
    }
    let short = typed.chars().count() <= 2;
    let limit = if short { 0.4 } else { 0.65 };
    let likeness = |name: &str| {
        let same_letters = typed.eq_ignore_ascii_case(name);
        if same_letters {
            1.0
        } else {
            strsim::normalized_damerau_levenshtein(&typed.to_lowercase(), &name.to_lowercase())
        }
    };
    let letters = sorted(typed);
    // With equal distances, prefers the name with the same letters: "mu" is a transposed "um", not
    // "m".
    let known = known.map(|name| (likeness(name), sorted(name) == letters, name));
    let near = known.filter(|&(likeness, ..)| likeness >= limit);
    near.min_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1))).map(|(.., name)| name)
}

fn sorted(name: &str) -> Vec<char> {
    let mut letters: Vec<char> = name.to_lowercase().chars().collect();
    letters.sort_unstable();
    letters
}

/// "did you mean X?" if a name is near enough, otherwise the fallback.
pub(crate) fn fix<'n>(
    typed: &str,
    known: impl Iterator<Item = &'n str>,
    fallback: impl FnOnce() -> String,
) -> String {
    nearest(typed, known).map_or_else(fallback, |name| format!("did you mean {name}?"))
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_misspelling_finds_its_name_and_another_word_finds_none() {
        let known = ["module", "pressure_angle", "centre_distance"];
        assert_eq!(nearest("modul", known.into_iter()), Some("module"));
        assert_eq!(nearest("center_distance", known.into_iter()), Some("centre_distance"));
        assert_eq!(nearest("colour", known.into_iter()), None);
        assert_eq!(nearest("mu", ["mm", "um", "m"].into_iter()), Some("um"));
    }
}
