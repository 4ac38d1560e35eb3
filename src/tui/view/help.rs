//! The help page, made from the table of bindings.

use crate::tui::commands::{BINDINGS, Binding};
use crate::tui::keys::Place;

const BEFORE: [&str; 5] = [
    "Every edit acts at once: results and chart follow each keystroke that leaves a valid value.",
    "A value stands with its unit: 5 mm, 16 um, 0.2 in, 15 kW, 20 hp, 2000 rpm, 20 deg; a number alone takes the unit of its field.",
    "An empty field shows in brackets what then holds.",
    "Before a field: * it is not as the file has it, - it makes no difference here, ! it is wrong.",
    "D is where the driven tip first touches, E where the normal path of contact begins. The rung paper keeps the printed Eqs. 7-20, exact finds D where the gap closes.",
];

const PLACES: [(&str, Place); 12] = [
    ("Everywhere", Place::WORK),
    ("In a field", Place::TEXT),
    ("Outside a field (Esc leaves one)", Place::FIELD),
    ("In a field of names", Place::CHOICE),
    ("In the results", Place::RESULTS),
    ("In chart and teeth", Place::CURSOR),
    ("In error against time", Place::TRADE),
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
    let mut told = vec![false; BINDINGS.len()];
    for (title, place) in PLACES {
        lines.extend([String::new(), title.to_owned()]);
        let is_here = |binding: &Binding| {
            if place == Place::WORK { binding.places.holds(place) } else { binding.places.meets(place) }
        };
        let mut here: Vec<_> = (0..BINDINGS.len()).filter(|&at| !told[at] && is_here(&BINDINGS[at])).collect();
        for &at in &here {
            told[at] = true;
        }
        // What the status line shows everywhere comes first.
        here.sort_by_key(|&at| place == Place::WORK && !BINDINGS[at].footer.holds(place));
        lines.extend(here.into_iter().filter_map(|at| line(&BINDINGS[at])));
    }
    lines
}

fn line(binding: &Binding) -> Option<String> {
    let keys = if binding.chords.is_empty() { format!(":{}", binding.name) } else { binding.keys() };
    (!binding.sentence.is_empty()).then(|| format!("  {keys:<24} {}", binding.sentence))
}
