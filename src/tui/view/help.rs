//! The help page, made from the table of bindings.

use crate::tui::commands::{BINDINGS, Binding};
use crate::tui::keys::Place;

const BEFORE: [&str; 5] = [
    "Every edit acts at once: results and chart follow each keystroke that leaves a valid value.",
    "A value stands with its unit: 5 mm, 16 um, 0.2 in, 15 kW, 20 hp, 2000 rpm, 20 deg; a number alone takes the unit of its field.",
    "In a field of a value that is empty, or marked as a whole, / and : are the commands that they are outside a field; no value begins with them.",
    "An empty field shows in brackets what then holds.",
    "D is where the driven tip first touches, E where the normal path of contact begins. The method paper keeps the printed Eqs. 7-20, exact finds D where the gap closes.",
];

/// What the signs mean, each by the place where it stands.
const SIGNS: [&str; 6] = [
    "Before a field: * it is not as the file has it, - it makes no difference here, ! it is wrong, ▸ it is the marked one.",
    "Behind a limit: ok or EXCEEDED (! where there is no room) and how much of it is used; (!) the method itself finds more than the limit on the free impact.",
    "Behind a result and its unit: ← the last edit changed it, ! it is above its limit; – in its place: no value. ▸ above a column: the method of the case.",
    "To base: the difference to the baseline (b pins one), = none; no base: the baseline has no such value; in base: only the baseline has one.",
    "In a chart: dots or * the method of the case, · paper, ∘ exact, × static, + the baseline, ╌ what the value is held against. On its axis: D first contact, E and B ends of the path of contact, L last contact, d another method's D.",
    "In the teeth: solid the flanks, bold those of the incoming pair; solid from E to B the path of contact, dashed the line of action, dotted the base circles and, before E, the path of the driven tip; crosses the named points, bold dots where flanks touch.",
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
    lines.extend(["", "Signs"].into_iter().chain(SIGNS).map(str::to_owned));
    let mut told = vec![false; BINDINGS.len()];
    for (title, place) in PLACES {
        lines.extend([String::new(), title.to_owned()]);
        let is_here = |binding: &Binding| {
            if place == Place::WORK {
                binding.places.holds(place)
            } else {
                binding.places.meets(place)
            }
        };
        let mut here: Vec<_> = (0..BINDINGS.len())
            .filter(|&at| !told[at] && is_here(&BINDINGS[at]))
            .collect();
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
    let keys = if binding.chords.is_empty() {
        format!(":{}", binding.name)
    } else {
        binding.keys()
    };
    (!binding.sentence.is_empty()).then(|| format!("  {keys:<24} {}", binding.sentence))
}
