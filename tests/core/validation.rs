//! `docs/validation.md`: published figures beside those of the program.
//!
//! `TIPSTRIKE_REGENERATE=1 cargo test --test core validation::` writes the page again.

mod changes;
mod compliance;
mod shape;
mod sources;

use std::fmt::Write as _;

use tipstrike::model::Inputs;
use tipstrike::model::inputs::ToothCompliance;
use tipstrike::numeric::decimal::significant;

use sources::SOURCES;

use crate::support::{inputs, path};

const HEAD: &str = "# Validation

Nothing on this page is a measurement, and nothing in tipstrike is compared with one. We found
no published measurement with all its inputs. The tooth forces of NASA's gear noise rig and the
dynamic transmission errors of Kubur and Kahraman are candidates for a later comparison.

This page compares tipstrike with figures of other programs and of standards. These figures are model
results too, so agreement only shows that two models agree. The page also lists disagreements.
RIKOR's standard test 001 is not compared: we know its forces, mesh stiffness and face load factor, but
not its gear pair and its shafts. KISSsoft's planets with their rings are not compared because tipstrike
has no internal gears, and its line load w_Bt because tipstrike has no application factor. The cases are
in `tests/validation/`. `TIPSTRIKE_REGENERATE=1 cargo test --test core validation::` writes the page
again, and the same test without the variable checks it.
";

type Text = &'static str;

/// A program or standard with published figures.
pub(crate) struct Source {
    title: Text,
    /// The origin of the figures.
    from: Text,
    /// The file in `tests/validation`, without its extension.
    case: Text,
    figures: &'static [Figure],
}

/// A value of the program.
type Ours = fn(&Inputs) -> Option<f64>;

/// A published figure.
pub(crate) struct Figure {
    name: Text,
    unit: Text,
    published: f64,
    ours: Ours,
    /// Whether it depends on the tooth compliance.
    by_model: bool,
    /// The value with the finite elements and without a coupling, which has this name.
    without: Option<(Text, Ours)>,
    /// Whether the comparison is fair, and the reason for the deviation.
    fair: Text,
}

/// A figure that depends on the tooth compliance.
const fn figure(name: Text, unit: Text, published: f64, ours: Ours, fair: Text) -> Figure {
    Figure { name, unit, published, ours, by_model: true, without: None, fair }
}

impl Figure {
    const fn by_no_model(self) -> Figure {
        Figure { by_model: false, ..self }
    }

    const fn without(self, name: Text, ours: Ours) -> Figure {
        Figure { without: Some((name, ours)), ..self }
    }
}

/// The same inputs with a tooth compliance.
pub(crate) fn with_model(inputs: &Inputs, model: ToothCompliance) -> Inputs {
    Inputs { tooth_compliance: Some(model), ..inputs.clone() }
}

fn row(figure: &Figure, published: &str, model: &str, ours: Option<f64>) -> String {
    let ours = ours.filter(|value| value.is_finite());
    let shown = ours.map_or("outside its range".to_owned(), |value| significant(value, 4));
    let deviation = ours.map_or("-".to_owned(), |value| {
        format!("{:+.1} %", 100.0 * (value / figure.published - 1.0))
    });
    format!("| {published} | {model} | {shown} | {deviation} |\n")
}

fn rows(figure: &Figure, inputs: &Inputs) -> String {
    let unit = if figure.unit.is_empty() { String::new() } else { format!(" {}", figure.unit) };
    let published = format!("{} | {}{unit}", figure.name, figure.published);
    if !figure.by_model {
        return row(figure, &published, "any", (figure.ours)(inputs));
    }
    let mut text = String::new();
    for (at, model) in ToothCompliance::ALL.into_iter().enumerate() {
        let ours = (figure.ours)(&with_model(inputs, model));
        let published = if at == 0 { published.as_str() } else { " | " };
        text += &row(figure, published, model.name(), ours);
    }
    if let Some((name, ours)) = figure.without {
        let ours = ours(&with_model(inputs, ToothCompliance::FINITE_ELEMENT));
        text += &row(figure, " | ", &format!("finite-element, {name}"), ours);
    }
    text
}

fn source(source: &Source) -> String {
    let file = format!("tests/validation/{}.toml", source.case);
    let inputs = inputs(&file);
    let mut text = format!(
        "\n## {}\n\nSource: {}. Inputs: `{file}`.\n\n| figure | published | tooth compliance | \
            tipstrike | deviation |\n|---|---|---|---|---|\n",
        source.title, source.from
    );
    for one in source.figures {
        text += &rows(one, &inputs);
    }
    text += "\nIs it fair?\n\n";
    for one in source.figures.iter().filter(|one| !one.fair.is_empty()) {
        writeln!(text, "- {}: {}", one.name, one.fair).unwrap();
    }
    text
}

fn page() -> String {
    let mut text = HEAD.to_owned();
    for one in SOURCES {
        text += &source(one);
    }
    text += &sources::iso_table();
    text += &shape::section();
    text += &compliance::section();
    text += &changes::section();
    text
}

#[test]
fn the_validation_page_shows_what_the_program_computes() {
    let path = path("docs/validation.md");
    let page = page();
    if std::env::var_os("TIPSTRIKE_REGENERATE").is_some() {
        std::fs::write(path, page).unwrap();
        return;
    }
    let stored = std::fs::read_to_string(path).unwrap();
    for (number, (stored, made)) in stored.lines().zip(page.lines()).enumerate() {
        assert_eq!(stored, made, "docs/validation.md, line {}", number + 1);
    }
    assert_eq!(stored.lines().count(), page.lines().count());
}
