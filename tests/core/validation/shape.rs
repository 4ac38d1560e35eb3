//! The shape of the mesh stiffness over a base pitch, compared with a closed form.

use std::f64::consts::PI;
use std::fmt::Write as _;

use tipstrike::model::Inputs;
use tipstrike::model::inputs::{Drive, ToothCompliance};

use super::sources::{exact, mesh_stiffness, of_slices};
use super::with_model;
use crate::support::{inputs, range as peak_to_peak};

/// Even places over a base pitch.
const PLACES: u32 = 400;
const HARMONICS: u32 = 4000;

const PAIRS: [(&str, f64); 4] = [
    ("fzg-c14", 1.0),
    ("gearpie-h501", 0.554),
    ("gearpie-h501", 1.0),
    ("iso-6336-30-1-helical", 1.0),
];

const FAIR: &str = "
Is it fair? Partly. In the source each pair of teeth has a parabola of stiffness over its path, 0.61 of the greatest
value at both ends and the same for all gears. Teeth and slices are independent, contact is only on the path, and
the load has no effect. The last two rows of a case have independent teeth and slices too. Reasons of the differences:

- Corner contact: under load our teeth touch before E and after B, so the steps of the spur pair are ramps. The
  greatest difference is on a ramp. At a thousandth of the load the ramps are short, and most of the difference of
  the spur pair is gone. At an overlap ratio near 1 the variation is so small that corner contact is most of the
  difference.
- Coupling: two coupled pairs of teeth are less than twice as stiff as one, so `finite-element` varies less than
  the beam.
- The parabola: for z 16/24 a pair has 0.65 (beam) to 0.73 (finite-element) of its greatest stiffness at the ends of
  the path. Two pairs near their ends are then stiffer than in the source, so the independent beam at a light load
  varies more.
";

fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) }
}

/// k/k_mean at a distance from the middle of the path, in base pitches: Gu, Velex et al. 2015 with the
/// time τ from the first contact, 2τ − ε_α − ε_β = 2 place.
fn closed_form(place: f64, contact: f64, overlap: f64) -> f64 {
    let harmonic = |number: u32| {
        let (number, way) = (f64::from(number), f64::from(number) * contact);
        let curved = 0.09 / (way * way);
        let part = (0.7 + curved) * sinc(way) - (PI * way).cos() * curved;
        part * sinc(number * overlap) * (2.0 * PI * number * place).cos()
    };
    1.0 + 2.0 * (1..=HARMONICS).map(harmonic).sum::<f64>()
}

/// k/k_mean of the load at rest at the same places.
fn ours(inputs: &Inputs, contact: f64) -> Vec<f64> {
    let curve = mesh_stiffness(inputs).unwrap();
    let at = |number: u32| {
        let place = f64::from(number) / f64::from(PLACES);
        let way = 0.5 * contact + if place < 0.5 { place } else { place - 1.0 };
        let after = curve.partition_point(|one| one.0 < way).clamp(1, curve.len() - 1);
        let (one, next) = (curve[after - 1], curve[after]);
        one.1 + (next.1 - one.1) * (way - one.0) / (next.0 - one.0)
    };
    let stiffness: Vec<f64> = (0..PLACES).map(at).collect();
    let mean = stiffness.iter().sum::<f64>() / f64::from(PLACES);
    stiffness.iter().map(|one| one / mean).collect()
}

pub(super) fn section() -> String {
    let mut text = format!(
        "\n## Shape of the mesh stiffness\n\nSource: Gu, Velex et al. 2015 (doi 10.1115/1.4030272), closed form \
         of k/k_mean with {HARMONICS} harmonics, compared at {PLACES} places of a base pitch. Ours is the \
         force over the displacement by `static`. The second row has the case `gearpie-h501` at 0.554 of its width \
         and torque. Difference: ours less the source, root mean square and greatest; the place of the greatest \
         in base pitches after the middle of the path.\n\n\
         | case | ε_α | ε_β | tooth compliance | peak to peak, source | tipstrike | difference, rms | greatest | place |\n\
         |---|---|---|---|---|---|---|---|---|\n"
    );
    for (file, part) in PAIRS {
        let mut pair = inputs(&format!("tests/validation/{file}.toml"));
        pair.driver.face_width *= part;
        pair.driven.face_width *= part;
        // A light load touches in few slices.
        pair.slices = Some(257);
        let contact = exact(&pair, "contact_ratio").unwrap();
        let overlap = exact(&pair, "overlap_ratio").unwrap_or(0.0);
        let place = |number: u32| f64::from(number) / f64::from(PLACES);
        let source: Vec<f64> =
            (0..PLACES).map(|number| closed_form(place(number), contact, overlap)).collect();
        let torque = part * pair.torque();
        let field = with_model(&pair, ToothCompliance::FINITE_ELEMENT);
        let beam = of_slices(&with_model(&pair, ToothCompliance::BEAM));
        let mut head = format!("`{file}` | {contact:.3} | {overlap:.3}");
        for (name, model, load) in [
            ("finite-element", &field, 1.0),
            ("finite-element, a thousandth of the load", &field, 1e-3),
            ("beam, independent slices", &beam, 1.0),
            ("beam, independent slices, a thousandth of the load", &beam, 1e-3),
        ] {
            let ours =
                ours(&Inputs { drive: Drive::Torque(load * torque), ..model.clone() }, contact);
            let difference: Vec<f64> =
                ours.iter().zip(&source).map(|(one, other)| one - other).collect();
            let square = difference.iter().map(|one| one * one).sum::<f64>() / f64::from(PLACES);
            let size = |number: &u32| difference[*number as usize].abs();
            let number = (0..PLACES).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap();
            writeln!(
                text,
                "| {head} | {name} | {:.3} | {:.3} | {:.3} | {:+.3} | {:.2} |",
                peak_to_peak(&source),
                peak_to_peak(&ours),
                square.sqrt(),
                difference[number as usize],
                place(number)
            )
            .unwrap();
            " | | ".clone_into(&mut head);
        }
    }
    text + FAIR
}
