//! The help page, generated from the table of bindings.

use crate::tui::commands::{BINDINGS, Binding};
use crate::tui::keys::Place;

const BEFORE: [&str; 6] = [
    "Every valid edit updates the results and the chart.",
    "Enter a value with its unit: 5 mm, 16 um, 0.2 in, 15 kW, 20 hp, 2000 rpm, 20 deg. To a \
        number without a unit, the workbench adds the unit of the field.",
    "The frame of a pane shows the keys that select the pane: a digit outside a field, Esc and \
        the digit in a field. In a field, digits are part of the value. Esc after the first digit \
        restores the value.",
    "In an empty or fully selected field, / and : start a command.",
    "An empty field shows its default in brackets; (required) marks a missing required value.",
    "D is the first contact of the driven tip, E the start of the normal path of contact. The \
        method paper uses the printed Eqs. 7-20; exact solves for D.",
];

/// The signs, by pane.
const SIGNS: [&str; 6] = [
    "Signs before a field: * changed since the last save; - no effect in this case; ! error or \
        missing required value; ▸ selected.",
    "Signs after a limit: ok, or EXCEEDED (! in a narrow pane), with the value in percent of the \
        limit; (!) the free impact meets the limit, but the force by the method exceeds the \
        limit.",
    "Signs after a result: ← changed by the last edit; ! above its limit; – no value. ▸ marks the \
        column of the case's method.",
    "Column vs baseline: the difference from the baseline; b pins the baseline. \"was none\": the \
        baseline has no value. \"was\" and a value: the program prints no percentage.",
    "Chart curves: dots or * the method of the case; · paper; ∘ exact; × static; + the baseline; \
        ╌ a reference value, such as Δ in the gap chart. Compared stiffness models alternate in the \
        columns that several of them cross. Points on the x axis: D first contact; E \
        and B ends of the path of contact; L last contact; d first contact of another method.",
    "Lines of the teeth: solid: flanks (bold: incoming pair) and, from E to B, the path of \
        contact; dashed: line of action; dotted: base circles and the path of the driven tip \
        before E. Crosses: named points. Bold dots: contacts.",
];

const PLACES: [(&str, Place); 14] = [
    ("Everywhere", Place::WORK),
    ("In a field", Place::TEXT),
    ("Outside a field (Esc leaves the field)", Place::FIELD),
    ("In a field of choices", Place::CHOICE),
    ("In the results", Place::RESULTS),
    ("In chart and teeth", Place::CURSOR),
    ("In accuracy against run time", Place::TRADE),
    ("In the study", Place::STUDY),
    ("In the tolerance", Place::TOLERANCE),
    ("In a list", Place::PICK),
    ("In the list of files", Place::BROWSE),
    ("In a question (or its first letter)", Place::ASK),
    ("In a page like this", Place::READ),
    ("In the explanation of a result", Place::EXPLAIN),
];

/// The lines of the help.
#[must_use]
pub fn lines() -> Vec<String> {
    let mut lines: Vec<String> = BEFORE.iter().map(|&line| line.to_owned()).collect();
    lines.extend(["", "Signs"].into_iter().chain(SIGNS).map(str::to_owned));
    let mut is_listed = vec![false; BINDINGS.len()];
    for (title, place) in PLACES {
        lines.extend([String::new(), title.to_owned()]);
        let is_here = |binding: &Binding| {
            if place == Place::WORK {
                binding.places.holds(place)
            } else {
                binding.places.meets(place)
            }
        };
        let mut here: Vec<_> =
            (0..BINDINGS.len()).filter(|&at| !is_listed[at] && is_here(&BINDINGS[at])).collect();
        for &at in &here {
            is_listed[at] = true;
        }
        // Commands of every status line are listed first.
        here.sort_by_key(|&at| place == Place::WORK && !BINDINGS[at].footer.holds(place));
        lines.extend(here.into_iter().filter_map(|at| line(&BINDINGS[at])));
    }
    lines
}

fn line(binding: &Binding) -> Option<String> {
    let keys =
        if binding.chords.is_empty() { format!(":{}", binding.name) } else { binding.keys() };
    (!binding.sentence.is_empty()).then(|| format!("  {keys:<24} {}", binding.sentence))
}
