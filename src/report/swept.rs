//! The chart of a sweep from its CSV.

use super::chart::{self, Axis, Chart, Series, Span};
use super::charts::pieces;
use super::{common_unit, name_of, shown_with, svg};
use crate::case::changes::label;
use crate::case::fields::index_of;
use crate::case::units::{self, System};
use crate::model::Quantity;
use crate::model::explanation::tidy;
use csv::StringRecord;
use std::collections::BTreeSet;

/// Whether numbers have equal ratios, and no equal steps.
fn are_geometric(numbers: &[f64]) -> bool {
    let [first, second, third, ..] = *numbers else { return false };
    let are_near = |one: f64, other: f64| (one / other - 1.0).abs() < 1e-6;
    (first > 0.0 && (second - first).abs() > 0.0)
        && !are_near(third - second, second - first)
        && numbers.windows(2).all(|pair| are_near(pair[1] / pair[0], second / first))
}

/// Curves of at most so many points have marks at them.
const FEW_POINTS: usize = 21;
/// A sweep of two fields with at least so many numbers each is a map.
const MAP_POINTS: usize = 5;
/// Significant digits of the places of a map.
const MAP_DIGITS: usize = 5;

/// Marks the points of each curve of few points.
pub fn with_marks(series: &mut [Series]) {
    for series in series.iter_mut().filter(|series| series.kind == chart::Kind::Curve) {
        if series.pieces.iter().map(Vec::len).sum::<usize>() <= FEW_POINTS {
            series.kind = chart::Kind::Marks(None);
        }
    }
}

/// The map of a quantity over the points of two fields, across and up, by their indices: the texts of
/// the points, and the cells row by row.
pub fn map_chart(
    known: &Quantity,
    axes: [(Axis, Vec<String>); 2],
    cells: Vec<chart::Cell>,
    unit: &'static str,
) -> Chart {
    let number = |cell: &chart::Cell| match *cell {
        chart::Cell::Value(value) => Some(value),
        _ => None,
    };
    let values = Span::of(cells.iter().filter_map(number));
    let worded = |value| (value, shown_with(known, value, unit).to_string());
    let places = [0, 1].map(|axis| (0..axes[axis].1.len()).map(|at| at as f64).collect());
    let [across, up] = axes.map(|(axis, texts)| {
        let last = texts.len().saturating_sub(1);
        let mut points = vec![0, last / 2, last];
        points.dedup();
        let labels = points.into_iter().map(|at| (at as f64, texts[at].clone()));
        Axis { labels: labels.collect(), ..axis }
    });
    Chart {
        title: format!("{} over {} and {}", known.label.trim(), across.name, up.name),
        across,
        up,
        map: Some(chart::Map {
            value: Axis::new(known.symbol, unit),
            places,
            cells,
            ends: (values.from <= values.to).then(|| [values.from, values.to].map(worded)),
            limit: None,
        }),
        ..Chart::default()
    }
}

/// The picture of a sweep from its CSV: the quantities, or the selected ones, with the unit of the
/// first, over the varied field with the most values, with a curve for each combination of the other
/// fields. A single quantity over two fields with at least five numbers each is a map. The second text
/// names the quantities that the picture leaves out.
///
/// # Errors
/// The reason if the text is no sweep or has no values.
pub fn picture(
    text: &str,
    only: &[&Quantity],
    caption: &str,
) -> Result<(String, Option<String>), String> {
    let sweep = Sweep::read(text, only)?;
    let (chart, gaps) = drawn(&sweep)?;
    let gaps = if gaps.is_empty() { gaps } else { format!("\nno curve: {gaps}") };
    let keys = sweep.omitted.join(",");
    let remark = format!("another unit, not drawn: {keys}; --only selects");
    let drawn = svg::draw(&chart, &(caption.to_owned() + &gaps));
    Ok((drawn, Some(remark).filter(|_| !keys.is_empty())))
}

/// The chart of a sweep, and why points have no value, empty if every point has a value.
fn drawn(sweep: &Sweep) -> Result<(Chart, String), String> {
    // The first of equal numbers of values.
    let across = sweep.fields.iter().rev().max_by_key(|&&at| sweep.distinct(&[at]).len()).copied();
    let across = across.ok_or(NONE)?;
    let count = sweep.distinct(&[across]).len();
    // A field that varies with the first has no curves of its own.
    let is_apart = |at: &usize| *at != across && sweep.distinct(&[across, *at]).len() > count;
    let others: Vec<usize> = sweep.fields.iter().copied().filter(is_apart).collect();
    let map = match others[..] {
        [other] => sweep.map([across.max(other), across.min(other)]),
        _ => None,
    };
    Ok(match map {
        Some(chart) => (chart, String::new()),
        None => (sweep.curves(across, &others)?, sweep.gaps()),
    })
}

const NONE: &str = "this is no CSV of `tipstrike sweep` with a varied field and the quantity";

/// The name and the unit in the head of a column.
fn named(head: &str) -> (&str, &str) {
    head.strip_suffix(']').and_then(|name| name.split_once(" [")).unwrap_or((head, ""))
}

fn number(row: &StringRecord, at: usize) -> Option<f64> {
    row[at].parse().ok()
}

/// The rows of a sweep, and what its columns are.
struct Sweep {
    head: StringRecord,
    rows: Vec<StringRecord>,
    fields: Vec<usize>,
    outcome: Option<usize>,
    /// The drawn quantities with their columns, all with a unit, and the keys of those with another
    /// one.
    known: Vec<(usize, &'static Quantity)>,
    omitted: Vec<&'static str>,
    /// The unit that is shown.
    unit: &'static str,
}

impl Sweep {
    fn read(text: &str, only: &[&Quantity]) -> Result<Sweep, String> {
        let invalid = |error: csv::Error| format!("this is no CSV of `tipstrike sweep`: {error}");
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let head = reader.headers().map_err(invalid)?.clone();
        let rows = reader.records().collect::<Result<Vec<StringRecord>, _>>().map_err(invalid)?;
        let columns = || head.iter().map(|head| named(head).0).enumerate();
        let fields = columns().filter(|(_, key)| index_of(key).is_some()).map(|(at, _)| at);
        let is_wanted =
            |known: &Quantity| only.is_empty() || only.iter().any(|wanted| wanted.key == known.key);
        let known = columns().filter_map(|(at, key)| Some((at, Quantity::find(key)?)));
        let known: Vec<(usize, &Quantity)> = known.filter(|(_, known)| is_wanted(known)).collect();
        let &(_, first) = known.first().ok_or(NONE)?;
        let (known, omitted): (Vec<_>, Vec<_>) =
            known.into_iter().partition(|(_, quantity)| quantity.unit == first.unit);
        let values =
            rows.iter().flat_map(|row| known.iter().filter_map(|&(at, _)| number(row, at)));
        Ok(Sweep {
            unit: common_unit(first, values, System::Metric),
            fields: fields.collect(),
            outcome: columns().find(|(_, key)| *key == "outcome").map(|(at, _)| at),
            omitted: omitted.into_iter().map(|(_, quantity)| quantity.key).collect(),
            known,
            head,
            rows,
        })
    }

    /// The different texts in some columns.
    fn distinct(&self, columns: &[usize]) -> Vec<Vec<&str>> {
        let mut found: Vec<Vec<&str>> = Vec::new();
        for row in &self.rows {
            let cells = columns.iter().map(|&at| &row[at]).collect();
            if !found.contains(&cells) {
                found.push(cells);
            }
        }
        found
    }

    /// The map of a single quantity over two fields, across and up.
    fn map(&self, fields: [usize; 2]) -> Option<Chart> {
        let &[(at, quantity)] = &self.known[..] else { return None };
        let points = fields.map(|field| self.distinct(&[field]));
        let [texts, other_texts] = [0, 1].map(|axis| {
            let numbers = points[axis].iter().map(|cells| cells[0].parse::<f64>().ok());
            let texts = numbers.map(|number| Some(tidy(number?, MAP_DIGITS)));
            texts.collect::<Option<Vec<String>>>().filter(|texts| texts.len() >= MAP_POINTS)
        });
        let (texts, other_texts) = (texts?, other_texts?);
        if self.rows.len() != texts.len() * other_texts.len() {
            return None;
        }
        let mut cells = vec![chart::Cell::Blank; self.rows.len()];
        for row in &self.rows {
            let place =
                |axis: usize| points[axis].iter().position(|cells| cells[0] == &row[fields[axis]]);
            cells[place(1)? * texts.len() + place(0)?] =
                match (number(row, at), &row[self.outcome.unwrap_or(at)]) {
                    (Some(value), _) => chart::Cell::Value(value),
                    (None, "no-corner-contact") => chart::Cell::NoContact,
                    (None, "refused") => chart::Cell::Refused,
                    (None, _) => chart::Cell::Blank,
                };
        }
        let axes = fields.map(|field| named(&self.head[field]));
        let [across, up] = axes.map(|(key, unit)| Axis::new(label(key), unit));
        Some(map_chart(quantity, [(across, texts), (up, other_texts)], cells, self.unit))
    }

    /// The curves over a field, one for each combination of the others.
    fn curves(&self, across: usize, others: &[usize]) -> Result<Chart, String> {
        let (_, first) = self.known[0];
        let places = self.distinct(&[across]);
        let is_number = places.iter().all(|place| place[0].parse::<f64>().is_ok());
        let numbers = places.iter().map(|place| place[0].parse().ok());
        let is_log = numbers.collect::<Option<Vec<f64>>>().is_some_and(|all| are_geometric(&all));
        let place = |text: &str| match text.parse::<f64>() {
            Ok(number) if is_log => number.log10(),
            Ok(number) if is_number => number,
            _ => places.iter().position(|place| place[0] == text).unwrap_or_default() as f64,
        };
        let factor = units::factor(self.unit).unwrap_or(1.0);
        let mut series = Vec::new();
        for &(at, quantity) in &self.known {
            for combination in self.distinct(others) {
                let is_of = |row: &&StringRecord| {
                    others.iter().zip(&combination).all(|(&at, &text)| &row[at] == text)
                };
                let value = |row| number(row, at).map(|value| value / factor);
                let rows = self.rows.iter().filter(is_of);
                let pieces =
                    pieces(rows.map(|row| (place(&row[across]), value(row))), f64::INFINITY);
                let fixed = others.iter().zip(&combination).map(|(&at, text)| {
                    let (key, unit) = named(&self.head[at]);
                    format!("{} {text} {unit}", label(key)).trim_end().to_owned()
                });
                let own = (self.known.len() > 1 || others.is_empty()).then(|| name_of(quantity));
                let name = own.into_iter().chain(fixed).collect::<Vec<_>>().join(", ");
                series.push(Series { name, pieces, kind: chart::Kind::Curve });
            }
        }
        series.retain(|series| !series.pieces.is_empty());
        with_marks(&mut series);
        if series.is_empty() {
            return Err(format!("the sweep has no values of {}", first.key));
        }
        let (key, across_unit) = named(&self.head[across]);
        let step = if is_log { (places.len() - 1).div_ceil(4) } else { 1 };
        let labels =
            places.iter().step_by(step).map(|cells| (place(cells[0]), cells[0].to_owned()));
        let labels = labels.filter(|_| is_log || !is_number).collect();
        let dimension = units::Dimension::of_unit(self.unit).map_or("", units::Dimension::name);
        let common = dimension.trim_start_matches("an ").trim_start_matches("a ");
        let (name, up) = match self.known.len() {
            1 => (first.label.trim_start(), name_of(first)),
            _ => (common, common.to_owned()),
        };
        let varied = Span::of(places.iter().map(|cells| place(cells[0])));
        Ok(Chart {
            title: format!("{name} over {}", label(key)),
            across: Axis { labels, least: Some(varied), ..Axis::new(label(key), across_unit) },
            up: Axis::new(up, units::named(self.unit)),
            series,
            ..Chart::default()
        })
    }

    /// Why rows have no value.
    fn gaps(&self) -> String {
        let is_gap = |row: &&StringRecord| self.known.iter().all(|&(at, _)| row[at].is_empty());
        let reasons = self.rows.iter().filter(is_gap);
        let reasons: BTreeSet<String> =
            reasons.filter_map(|row| Some(row[self.outcome?].replace('-', " "))).collect();
        reasons.into_iter().collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_ratios_alone_are_geometric() {
        for (numbers, expected) in [
            (&[1.0, 10.0, 100.0][..], true),
            (&[1.0, 2.0, 3.0], false),
            (&[1.0, 1.0, 1.0], false),
            (&[1.0, 10.0], false),
            (&[-1.0, -10.0, -100.0], false),
            (&[1.0, 2.0, 4.0, 9.0], false),
        ] {
            assert_eq!(are_geometric(numbers), expected, "{numbers:?}");
        }
    }

    #[test]
    fn a_sweep_has_a_curve_for_each_combination_with_gaps_without_values() {
        let text = "operation.speed [rpm],driven.teeth,impact_force [N],outcome\n\
            500,20,1500.0,corner-contact\n500,30,,no-corner-contact\n\
            1000,20,2500.0,corner-contact\n1000,30,1000.0,corner-contact\n\
            1500,20,3500.0,corner-contact\n1500,30,1100.0,corner-contact\n";
        let of = |text: &str| drawn(&Sweep::read(text, &[])?);
        let (found, gaps) = of(text).unwrap();
        assert_eq!(
            (gaps.as_str(), found.across.least),
            ("no corner contact", Some(Span::new(500.0, 1500.0)))
        );
        assert_eq!((found.across.unit.as_str(), found.up.unit.as_str()), ("rpm", "N"));
        let names: Vec<&str> = found.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["driven number of teeth 20", "driven number of teeth 30"]);
        assert_eq!(found.series[0].pieces[0].len(), 3);
        assert_eq!(found.series[1].pieces, [vec![(1000.0, 1000.0), (1500.0, 1100.0)]]);
        let choices = "model.method,impact_force [N],outcome\nexact,2.0,x\npaper,1.0,x\n";
        assert_eq!(of(choices).unwrap().0.across.labels[1], (1.0, "paper".to_owned()));
        assert!(of("a,b\n1,2\n").is_err() && of("").is_err());
    }

    #[test]
    fn a_sweep_of_two_fields_with_several_numbers_each_is_a_map_with_the_later_field_across() {
        let head = "driven.tip_relief [um],driver.tip_relief [um],impact_force [N],outcome\n";
        let mut text = head.to_owned();
        for (up, across) in (0..5).flat_map(|up| (0..6).map(move |across| (up, across))) {
            let line = match up {
                4 => format!("{up},{across},,no-corner-contact\n"),
                _ => format!("{up},{across},{}.0,corner-contact\n", 10 * up + across),
            };
            text.push_str(&line);
        }
        let (found, gaps) = drawn(&Sweep::read(&text, &[]).unwrap()).unwrap();
        let map = found.map.unwrap();
        assert_eq!((map.places[0].len(), map.places[1].len(), gaps.as_str()), (6, 5, ""));
        assert_eq!((found.across.unit.as_str(), found.across.labels[1].1.as_str()), ("um", "2"));
        assert_eq!(map.cells[7], chart::Cell::Value(11.0));
        assert_eq!(map.cells[24], chart::Cell::NoContact);
        assert_eq!(map.ends.as_ref().map(|[least, most]| (least.0, most.0)), Some((0.0, 35.0)));
    }
}
