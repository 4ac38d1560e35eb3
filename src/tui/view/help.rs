//! The help page, made from the table of bindings.

use crate::tui::actions::{BINDINGS, Place};

const BEFORE: [&str; 4] = [
    "Every edit acts at once: results and chart follow each keystroke that leaves a valid value.",
    "A value stands with its unit: 5 mm, 16 um, 0.2 in, 15 kW, 20 hp, 2000 rpm, 20 deg.",
    "An empty field shows in brackets what then holds.",
    "D is where the driven tip first touches, E where the normal path of contact begins. The rung paper keeps the printed Eqs. 7-20, exact finds D where the gap closes.",
];

const PLACES: [(&str, Place); 5] = [
    ("In the form", Place::TEXT),
    ("In a field of names", Place::CHOICE),
    ("In the list of files", Place::BROWSE),
    ("In a question (or its first letter)", Place::ASK),
    ("In a page like this", Place::READ),
];

/// The lines of the help.
#[must_use]
pub fn lines() -> Vec<String> {
    let mut lines: Vec<String> = BEFORE.iter().map(|&line| line.to_owned()).collect();
    let mut told = vec![false; BINDINGS.len()];
    for (title, place) in PLACES {
        lines.extend([String::new(), title.to_owned()]);
        for (binding, told) in BINDINGS.iter().zip(&mut told) {
            if !*told && binding.places.meets(place) {
                lines.push(format!("  {:<24} {}", binding.keys(), binding.sentence));
                *told = true;
            }
        }
    }
    lines
}
