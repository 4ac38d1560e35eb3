//! Values for fields: valid ones of every range, and invalid ones.

use proptest::prelude::*;
use proptest::sample::{Index, select};
use tipstrike::case::fields::{FIELDS, Kind, Range};
use tipstrike::case::units::{self, Dimension};

/// Texts that almost no field of a measure accepts.
#[rustfmt::skip]
pub(crate) const HOSTILE: [&str; 42] = [
    "", " ", "nan", "-inf mm", "1e400 mm", "1e-400 mm", "1e308 mm", "-1e-320 um",
        "1e999999999999999999999 mm", "0", "-0",
    "-0.0 um", "5", "5,0 mm", "−5 mm", "5 mm mm", "5 kg", "0x10", "1_000", "+.5e+1 mm", "5. mm", ".5", "1/2", "5µm",
    "5 \u{202e}mm", "5\u{a0}mm", "\u{1b}[2J", "\u{9b}2J", "5\u{200b} mm", "\u{feff}5 mm", "a\nb", "a\r\nb\t", "\"5 mm\"",
    "\"\"\"", "# no", "\\u001b", "歯車 🦷", "e\u{301}\u{34f}", "\u{ffa0}a",
        "\u{180b}\u{1d173}\u{e0041}b", "👩\u{200d}🔧", "static",
];

/// A field and a text for it: mostly a valid value, near its default or anywhere in its range.
pub(crate) fn field_and_text() -> impl Strategy<Value = (usize, String)> {
    any::<Index>().prop_flat_map(|at| {
        let field = at.index(FIELDS.len());
        text_of(field).prop_map(move |text| (field, text))
    })
}

fn text_of(field: usize) -> BoxedStrategy<String> {
    let hostile = select(&HOSTILE[..]).prop_map(str::to_owned);
    prop_oneof![10 => sound(field), 1 => Just(String::new()), 2 => hostile].boxed()
}

/// A text that the field accepts by itself.
fn sound(field: usize) -> BoxedStrategy<String> {
    let known = &FIELDS[field];
    match known.kind {
        Kind::Text => prop_oneof![".{0,12}", select(&HOSTILE[..]).prop_map(str::to_owned)].boxed(),
        Kind::List(_) => Just(known.example().to_owned()).boxed(),
        Kind::Choice(names, _) => select(names).prop_map(str::to_owned).boxed(),
        Kind::Count(from, to, _) => {
            let usual: u32 = known.example().parse().unwrap_or(from);
            let near = (usual / 2).max(from)..=(usual * 2).min(to);
            prop_oneof![6 => near, 1 => from..=to, 1 => select(vec![from, to])]
                .prop_map(|count| count.to_string())
                .boxed()
        }
        Kind::Number(dimension, range, _) => measure(dimension, range, known.example()),
    }
}

fn measure(dimension: Dimension, range: Range, example: &'static str) -> BoxedStrategy<String> {
    let usual = units::parse(example, dimension, range.unit).unwrap_or(0.0)
        / units::factor(range.unit).unwrap_or(1.0);
    let span = (range.to - range.from) / 1e3;
    let near =
        (0.7..1.4).prop_map(
            move |times: f64| {
                if usual == 0.0 { times * span.min(20.0) } else { usual * times }
            },
        );
    let anywhere =
        (0.0..1.0).prop_map(move |part: f64| range.from + (range.to - range.from) * part.powi(8));
    prop_oneof![8 => near, 1 => anywhere, 1 => select(vec![range.from, range.to])]
        .prop_map(move |value| {
            format!("{} {}", value.clamp(range.from, range.to), range.unit).trim_end().to_owned()
        })
        .boxed()
}
