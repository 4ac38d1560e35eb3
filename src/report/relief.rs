//! The tip relief to specify as text, JSON or CSV, and the diagram of reliefs over the roll angle.

use super::chart::{Axis, Chart, Kind, Series};
use super::table::{Cell, Column, Table};
use super::table::{Json, json, with};
use super::table::{Named, Results};
use super::table::{WIDTH, item};
use crate::case::Case;
use crate::case::fields::index_of;
use crate::case::spread::Shape;
use crate::case::units::{self, System};
use crate::model::Inputs;
use crate::model::explanation::tidy;
use crate::model::geometry::Geometry;
use crate::model::inputs::{Method, ReliefShape};
use crate::model::relief::{GearReliefs, Relief, Reliefs};
use crate::numeric::decimal::shortest;
use crate::study::relief::{
    Begin, Choice, Criterion, Figures, MOST_LOAD, MapPoint, Off, RULE, Specification, TipReliefs,
};

impl Specification {
    /// The specification with one of its choices, without its gains if these are shown elsewhere:
    /// rows of tables of at most 80 columns, and unwrapped sentences.
    pub fn of_choice(&self, at: usize, has_gains: bool, units: System) -> Vec<String> {
        let (figure, greatest) = (self.figure(), percent(self.demand.greatest_load()));
        let um = units.unit("um");
        let costs = ["least_load_error", "least_load_change", "unloaded_contact_ratio", "margin"];
        let costs: Vec<&str> = costs.into_iter().chain(["greatest_load"]).collect();
        let force = if self.is_moving() { "in motion" } else { "at rest" };
        let map_mark = self.map_mark();
        let gains = has_gains.then(|| {
            (format!("What each relief gains; {}", self.legend(units)), self.gains(units, WIDTH))
        });
        let compared = self.compared(at);
        let before = (
            format!(
                "Before and after with \"{}\", forces {force} at {greatest} % of the load",
                self.choices[compared].name
            ),
            self.before_and_after(compared, units),
        );
        let others = [
            (
                format!(
                    "What each relief costs; TE in {um} at {} % of the load, contact ratio of the \
                     unrelieved flanks; gap in {um} within the tolerances, load at which it closes",
                    percent(self.loads[0])
                ),
                self.of_choices(&costs, units),
            ),
            (
                format!(
                    "Transmission error peak to peak over the load, without deviations, {um} \
                     (Harris map)"
                ),
                self.harris(units),
            ),
            (
                format!(
                    "Map of the {figure} transmission error over length and amount, {um}; - corner \
                     contact at the greatest load, {map_mark} the {} relief",
                    if map_mark == '*' { "specified" } else { "best" }
                ),
                self.map(units),
            ),
        ];
        let advice = self.advice(units);
        let mut lines: Vec<String> = advice.into_iter().chain([self.demand(units)]).collect();
        let drawn = self.drawn(at);
        if self.choices[drawn].reliefs.removed() > 0.0 {
            if drawn != at {
                let name = self.choices[drawn].name;
                lines.extend([String::new(), format!("The best relief, \"{name}\"")]);
            }
            lines.push(String::new());
            lines.extend(self.drawing(drawn, units).lines());
        }
        lines.push(String::new());
        lines.extend(self.sentences(drawn, units));
        for (title, table) in [before].into_iter().chain(gains).chain(others) {
            lines.extend([String::new(), title]);
            lines.extend(table.lines());
        }
        lines
    }

    /// The columns of the gains, and the rule by which one of the reliefs is specified.
    pub fn legend(&self, units: System) -> String {
        let [um, force] = ["um", "N"].map(|unit| units.unit(unit));
        let mm = if units == System::Inch { "inches" } else { "mm" };
        let figure = match self.demand.minimise {
            Criterion::Te => "worst TE".to_owned(),
            _ => self.criterion(),
        };
        let rule = match self.demand.minimise.worth() {
            0.0 => "without force before E".to_owned(),
            worth => format!("with {figure} within {:.0} % of the least", 100.0 * worth),
        };
        let factor = if self.is_moving() { ", dynamic factor K" } else { "" };
        format!(
            "Ca, TE (transmission error) in {um}, La in {mm}{factor}; worst TE, entry and peak force \
             ({force}): in tolerance; * smallest advised relief {rule}, else the case"
        )
    }

    /// Why no relief is advised.
    fn advice(&self, units: System) -> Vec<String> {
        let other = if self.choices[0].reliefs.removed() > 0.0 { "other " } else { "" };
        let criterion = self.criterion();
        let reason = match self.compared(0) {
            _ if self.is_advised() => return Vec::new(),
            0 => format!("the relief of the case has the least {criterion}"),
            best => {
                let name = self.choices[best].name;
                format!("the best, \"{name}\", changes the {}", self.changes(best, units))
            }
        };
        let none = format!("No {other}relief is advised by the {criterion}");
        vec![format!("{none}: within the tolerances, {reason}."), RULE.to_owned()]
    }

    /// Changes of the figures of a choice within the tolerances, that of the criterion first.
    fn changes(&self, at: usize, units: System) -> String {
        const LEAST: f64 = 0.005;
        let names = [
            ("transmission error", "um", 3),
            ("peak force", "N", 4),
            ("peak line load", "N/mm", 4),
            ("force before E", "N", 3),
            ("dynamic factor", "1", 3),
        ];
        let criterion = self.criterion();
        let [from, to] = [0, at].map(|at| self.choices[at].compared());
        let mut all = names.into_iter().zip(from.into_iter().zip(to)).collect::<Vec<_>>();
        all.sort_by_key(|((name, ..), _)| *name != criterion);
        let texts = all.into_iter().filter_map(|((name, unit, digits), (from, to))| {
            let (from, to) = from.zip(to)?;
            let is_shown = name == criterion || (to - from).abs() > LEAST * from;
            let unit = if unit == "1" { "" } else { unit };
            let [shown, other] = [from, to].map(|value| units.number(value, unit, digits));
            let other = format!("{other} {}", units.unit(unit));
            let change =
                if from > 0.0 { format!(" ({})", change(from, to)) } else { String::new() };
            is_shown.then(|| format!("{name} from {shown} to {}{change}", other.trim_end()))
        });
        texts.collect::<Vec<_>>().join(", ")
    }

    fn demand(&self, units: System) -> String {
        let Specification { demand, torque, method, .. } = self;
        // Why the method is not that of the case.
        let reason = match self.asked {
            own if own == *method => String::new(),
            _ if self.is_over_face => ", over the face width".to_owned(),
            Method::Auto => ", chosen by auto".to_owned(),
            own => {
                let own = own.name();
                format!(", because method {own} does not share the load among pairs")
            }
        };
        let tilt = match demand.misalignment {
            0.0 => String::new(),
            tilt => format!(", misalignment +-{}", units.text(tilt, "um", 3)),
        };
        let sum: f64 = demand.spectrum.iter().map(|(_, share)| share).sum();
        let share = |(load, share)| format!("{}%:{}", percent(load), tidy(share, 4));
        let loads = if demand.spectrum.is_empty() || (sum - 1.0).abs() < 1e-9 {
            demand.loads_text().replace("..", " to ")
        } else {
            let used: Vec<String> = demand.loads().into_iter().map(share).collect();
            format!("{} (shares of the sum {})", used.join(", "), tidy(sum, 4))
        };
        format!(
            "Tip relief for {loads} of {} with the least {}, tolerances {} on amounts and {} on \
             lengths{tilt}; computed by method {}{reason}.",
            units.text(*torque, "N m", 4),
            self.criterion(),
            units.text(demand.tolerance, "um", if units == System::Inch { 2 } else { 3 }),
            units.text(self.tolerance_length(), "mm", 3),
            method.name()
        )
    }

    /// The figure to minimise.
    fn criterion(&self) -> String {
        match self.demand.minimise {
            Criterion::Peak if self.is_over_face => "peak line load".to_owned(),
            other => other.to_string(),
        }
    }

    fn tolerance_length(&self) -> f64 {
        self.demand.tolerance_length.unwrap_or_default()
    }

    /// The figure over the loads.
    fn figure(&self) -> &'static str {
        if self.demand.spectrum.is_empty() { "greatest" } else { "mean" }
    }

    /// The choice whose drawing is shown for a choice: without a relief the best one.
    fn drawn(&self, at: usize) -> usize {
        if self.choices[at].reliefs.removed() > 0.0 { at } else { self.best }
    }

    /// What a drawing states of a choice.
    fn drawing(&self, at: usize, units: System) -> Table {
        let Specification { choices, demand, geometry, is_over_face, .. } = self;
        let (reliefs, off) = (choices[at].reliefs, self.tolerance_length());
        let row = |title: &str, of: &dyn Fn(usize) -> String| {
            let cell = |at: usize| if reliefs.amounts[at] > 0.0 { of(at) } else { "-".to_owned() };
            vec![format!("  {title}"), cell(0), cell(1)]
        };
        let within = |own: f64, by: f64, unit| {
            format!("{} +-{}", drawn(own, unit, units), drawn(by, unit, units))
        };
        let places = BEGINS.map(|(label, _, unit, of)| {
            row(&format!("{label}, {}", units.unit(unit)), &|at| {
                let [own, by] = begins(of, &reliefs, geometry, [off; 4])[at];
                within(own, by, unit)
            })
        });
        let [um, mm] = ["um", "mm"].map(|unit| units.unit(unit));
        let mut rows = vec![
            row(&format!("tip relief Ca, {um}"), &|at| {
                within(reliefs.amounts[at], demand.tolerance, "um")
            }),
            row(&format!("length along path of contact La, {mm}"), &|at| {
                within(reliefs.lengths[at], off, "mm")
            }),
        ];
        rows.extend(places);
        rows.push(row("shape", &|_| name(reliefs.shape).to_owned()));
        if *is_over_face {
            let crownings = [reliefs.crowning, self.driven_crowning];
            let [own, other] = crownings.map(|crowning| drawn(crowning, "um", units));
            rows.push(vec![format!("  crowning Cβ, {um}"), own, other]);
        }
        let head = ["  For the drawing", "driver", "driven gear"].map(str::to_owned);
        let mut table = Table::of_texts(head.to_vec(), rows);
        table.columns[1..].iter_mut().for_each(|column| column.gap = 3);
        table
    }

    /// Margin, gain, cost and alternative of a choice.
    fn sentences(&self, at: usize, units: System) -> Vec<String> {
        let (case, own) = (&self.choices[0], &self.choices[at]);
        let greatest = self.demand.greatest_load();
        let load = match own.greatest_load {
            Some(load) => format!("the load can rise to {:.1} %", 100.0 * floor(load)),
            None => {
                format!("no load up to {} % causes corner contact", percent(MOST_LOAD * greatest))
            }
        };
        let Figures { gap, strikes, entry, .. } = own.worst;
        let contact =
            format!("orner contact at {} % of the load within the tolerances", percent(greatest));
        let [remains, overlap] = [gap, -gap].map(|gap| units.text(gap, "um", 2));
        let entry = units.text(entry, "N", 3);
        let mut lines = vec![match strikes {
            false => {
                format!("No c{contact}: a gap of {remains} remains; at rest, {load}.")
            }
            true if gap < 0.0 => format!(
                "C{contact}: the teeth overlap by {overlap} at rest, the force before E is \
                 {entry}."
            ),
            true if self.is_over_face => format!("C{contact} after B."),
            true => "Corner contact in motion within the tolerances.".to_owned(),
        }];
        if at > 0 {
            let changed = |from: f64, to: f64| {
                let (shown, other) = (units.number(from, "um", 3), units.text(to, "um", 3));
                format!("from {shown} to {other} ({})", change(from, to))
            };
            let over_loads = changed(case.nominal.error, own.nominal.error);
            let at_first = changed(case.errors[0], own.errors[0]);
            let at_first = if at_first == over_loads {
                String::new()
            } else {
                format!(", at {} % of the load {at_first}", percent(self.loads[0]))
            };
            lines.push(format!(
                "The {} transmission error over the loads without deviations changes \
                 {over_loads}{at_first}.",
                self.figure(),
            ));
            // The reason why no relief is advised has them.
            if self.is_advised() || at != self.compared(0) {
                let changes = self.changes(at, units);
                lines.push(format!("Gain and cost within the tolerances: {changes}."));
            }
        }
        let ratio = own.unloaded_contact_ratio + self.helix.overlap_ratio;
        if ratio < 1.0 {
            lines.push(format!(
                "The unrelieved flanks alone have a contact ratio of {ratio:.3}, below 1: under \
                 light load the pairs change on the reliefs, which raises TE."
            ));
        }
        if self.helix.base_helix_angle > 0.0 {
            lines.push(format!(
                "The amounts are lengths in the transverse plane along the base tangent; normal to \
                 the flank they are {:.3} of this.",
                self.helix.base_helix_angle.cos()
            ));
        }
        lines.extend(self.alternative(own, units).filter(|_| self.is_advised()));
        if self.is_cut {
            lines.push("The search ended with its budget; a better relief may exist.".to_owned());
        }
        lines
    }

    /// The choice with the best figure, if it is another one than `own`.
    fn alternative(&self, own: &Choice, units: System) -> Option<String> {
        let figure = |choice: &Choice| choice.worst.of(self.demand.minimise);
        let best = &self.choices[self.least()?];
        let gain = 1.0 - figure(best) / figure(own);
        let cost = best.reliefs.removed() - own.reliefs.removed();
        (gain >= 0.005 && cost > 0.0).then(|| {
            format!(
                "The relief \"{}\" has {:.0} % less {} within the tolerances, for {} {} more \
                 relief on both gears together.",
                best.name,
                100.0 * gain,
                self.criterion(),
                drawn(cost, "um", units),
                units.unit("um")
            )
        })
    }

    /// The figures with the relief of the case, with a choice, and at the limits of its tolerances.
    fn before_and_after(&self, at: usize, units: System) -> Table {
        type Value<'v> = &'v dyn Fn(&Figures) -> Option<f64>;
        let Specification { choices, mesh_force, is_over_face, .. } = self;
        let (case, own) = (&choices[0], &choices[at]);
        let error = format!("{} TE over the loads", self.figure());
        let gap = if *is_over_face { "gap before E at rest" } else { BOTH_GAPS };
        let rows: [(&str, &str, usize, Value); 9] = [
            (&error, "um", 3, &|found| Some(found.error)),
            ("TE_st,pp at the load of the case", "um", 4, &|found| Some(found.own_errors?[0])),
            ("TE_st, the same with deviations", "um", 4, &|found| Some(found.own_errors?[1])),
            ("force before E", "N", 4, &|found| Some(found.entry)),
            ("peak force of a tooth", "N", 4, &|found| Some(found.peak)),
            ("peak force/mesh force", "1", 3, &|found| Some(found.peak / mesh_force)),
            ("peak line load", "N/mm", 4, &|found| found.line_load),
            ("dynamic factor K_mesh", "1", 3, &|found| found.factor),
            (gap, "um", 2, &|found| Some(found.gap)),
        ];
        let rows = rows.iter().filter_map(|(title, unit, digits, of)| {
            let values = [&case.nominal, &own.nominal, &own.worst].map(of);
            let cell = |value: Option<f64>| {
                value.map_or("-".to_owned(), |value| units.number(value, unit, *digits))
            };
            let is_shown = values.iter().any(Option::is_some);
            let unit = Some(units.unit(unit)).filter(|unit| *unit != "1");
            let unit = unit.map_or_else(String::new, |unit| format!(", {unit}"));
            is_shown.then(|| [vec![format!("  {title}{unit}")], values.map(cell).to_vec()].concat())
        });
        let head = ["", "case", "relief", "in tolerance"].map(str::to_owned).to_vec();
        Table::of_texts(head, rows)
    }

    fn is_moving(&self) -> bool {
        self.method == Method::Dynamic
    }

    /// One row per choice: the relief, its transmission error, its forces and its dynamic factor, in
    /// `room` columns.
    pub fn gains(&self, units: System, room: usize) -> Table {
        let [amounts, lengths] = KEYS;
        let reliefs = [amounts[0], lengths[0], amounts[1], lengths[1]].into_iter();
        let crowning = self.is_over_face.then_some(CROWNING);
        let results = ["worst_transmission_error", "worst_entry_force", "worst_peak_force"];
        let results = results.into_iter().chain(self.is_moving().then_some("dynamic_factor"));
        let errors = ["transmission_error", CHANGE];
        let mut keys: Vec<&str> = reliefs.chain(crowning).chain(errors).chain(results).collect();
        let all = self.of_choices(&keys, units);
        // Without room the change is left out.
        if all.lines().iter().all(|line| line.chars().count() <= room) {
            return all;
        }
        keys.retain(|key| *key != CHANGE);
        self.of_choices(&keys, units)
    }

    /// One row per choice with these columns of the whole table, and a mark at the relief to
    /// specify.
    fn of_choices(&self, keys: &[&str], units: System) -> Table {
        let all = self.choices(units);
        let place = |key| all.columns.iter().position(|column| column.key == key);
        let columns: Vec<usize> =
            [0].into_iter().chain(keys.iter().filter_map(|key| place(*key))).collect();
        let mut table = all.of(&columns);
        for (at, row) in table.rows.iter_mut().enumerate() {
            row[0] = self.marked(at).into();
        }
        table
    }

    fn marked(&self, at: usize) -> String {
        let mark = if at == self.specified() { '*' } else { ' ' };
        format!("{mark} {}", self.choices[at].name)
    }

    /// The columns of numbers of the pair.
    fn numbers(&self) -> &'static [Numbers] {
        if self.is_over_face { &NUMBERS } else { &NUMBERS[..NUMBERS.len() - OVER_FACE] }
    }

    /// Every result of each choice.
    fn choices(&self, units: System) -> Table {
        let texts = [("choice", "  relief"), ("best", ""), ("shape", "")];
        let texts = texts.map(|(key, title)| Column::text(key, title).wide(0, 0)).into_iter();
        let numbers = self.numbers().iter();
        let columns = numbers.map(|&(key, title, unit, shown, _)| {
            Column::number(key, title, unit, shown).wide(1, 0)
        });
        let rows = self.choices.iter().enumerate().map(|(at, choice)| {
            let best = if at == self.specified() { "true" } else { "false" };
            let texts = [choice.name, best, name(choice.reliefs.shape)].map(Cell::from);
            let numbers = self.numbers().iter().map(|(key, .., (shown, digits), of)| {
                let Some(value) = of(self, choice) else { return Cell::None("-".into()) };
                let text = match *shown {
                    "%" => format!("{:+.0} %", 100.0 * value),
                    "% load" => format!("{:.1} %", 100.0 * value),
                    unit => {
                        let number = units::per(value, units.unit(unit));
                        let steps = steps(key, unit, units);
                        let number = steps.map_or(number, |by| (number * by).round() / by);
                        match decimals(key, self, units) {
                            Some(decimals) => format!("{number:.decimals$}"),
                            None => tidy(number, *digits),
                        }
                    }
                };
                Cell::Shown(value, text)
            });
            texts.into_iter().chain(numbers).collect()
        });
        Table::new("", texts.chain(columns).collect()).with(rows)
    }

    /// One row per choice: the transmission error over the load.
    fn harris(&self, units: System) -> Table {
        let loads = self.loads.iter().map(|&load| format!("{} %", percent(load)));
        let rows = self.choices.iter().enumerate().map(|(at, choice)| {
            let errors = choice.errors.iter().map(|error| units.number(*error, "um", 3));
            [self.marked(at)].into_iter().chain(errors).collect()
        });
        Table::of_texts(["  relief".to_owned()].into_iter().chain(loads).collect(), rows)
    }

    /// The mark of the best relief in the map, which is not that of the relief to specify if another
    /// one is specified.
    fn map_mark(&self) -> char {
        if self.specified() == self.best { '*' } else { '>' }
    }

    /// One row per length: the figure of the transmission error by amount. The amounts are in one
    /// row, or in one per gear.
    fn map(&self, units: System) -> Table {
        let (chosen, mark) = (self.chosen().reliefs, self.map_mark());
        let near = |one: [f64; 2], other: [f64; 2]| (one[0] - other[0]).abs() < 1e-9;
        let cell = |point: &MapPoint| {
            let error = match point.margin {
                margin if margin < 0.0 => "-".to_owned(),
                _ => units.number(point.error, "um", 2),
            };
            let is_chosen = near(point.reliefs.amounts, chosen.amounts)
                && near(point.reliefs.lengths, chosen.lengths);
            if is_chosen { format!("{mark}{error}") } else { error }
        };
        let points = self.map.first().map_or(&[][..], Vec::as_slice);
        let amounts = |at: usize| {
            points.iter().map(move |point| drawn(point.reliefs.amounts[at], "um", units))
        };
        let [um, mm] = ["um", "mm"].map(|unit| units.unit(unit));
        let head = |name: &str, at: usize| {
            [format!("  amount{name}, {um}")].into_iter().chain(amounts(at)).collect::<Vec<_>>()
        };
        let (first, second) = if amounts(0).eq(amounts(1)) {
            (head("", 0), None)
        } else {
            (head(" driver", 0), Some(head(" driven", 1)))
        };
        let rows = self.map.iter().map(|row| {
            let [driver, driven] = row[0].reliefs.lengths.map(|length| drawn(length, "mm", units));
            let both = if driver == driven { driver } else { format!("{driver}/{driven}") };
            [format!("  length {both} {mm}")].into_iter().chain(row.iter().map(cell)).collect()
        });
        Table::of_texts(first, second.into_iter().chain(rows))
    }

    /// A relief with the points at which it begins.
    fn relief(&self, reliefs: &TipReliefs) -> Json {
        let begins = reliefs.begins(&self.geometry);
        let crowning = self.is_over_face.then_some(reliefs.crowning);
        let gear = |at: usize| {
            json!({
                "tip_relief": reliefs.amounts[at],
                "tip_relief_length": reliefs.lengths[at],
                "begin_roll_angle": begins[at].roll_angle,
                "begin_diameter": begins[at].diameter,
                "crowning": crowning.filter(|_| at == 0),
            })
        };
        json!({"shape": name(reliefs.shape), "driver": gear(0), "driven": gear(1)})
    }

    /// A choice as values of the fields of a case, rounded as the report prints them, with the
    /// tolerances of the demand as distributions. The empty distribution is that of a relief that is
    /// not larger than its tolerance; without a tolerance the distributions stay. `system` gives the
    /// units of a field.
    pub fn settings(
        &self,
        at: usize,
        system: impl Fn(&str) -> System,
    ) -> Vec<(&'static str, String)> {
        let ([amounts, lengths], reliefs) = (KEYS, &self.choices[at].reliefs);
        let mut settings = vec![("model.relief_shape", name(reliefs.shape).to_owned())];
        let of_drawing = |key, length: f64, unit| {
            format!("{} {}", drawn(length, unit, system(key)), system(key).unit(unit))
        };
        let uniform =
            |key, width: f64, unit| format!("uniform {}", system(key).text(width, unit, 4));
        for at in 0..2 {
            let has_relief = reliefs.amounts[at] > 0.0;
            let length = if has_relief { reliefs.lengths[at] } else { 0.0 };
            let ends = [
                (amounts[at], reliefs.amounts[at], self.demand.tolerance, "um"),
                (lengths[at], length, self.tolerance_length(), "mm"),
            ];
            for (keys, (key, nominal, tolerance, unit)) in SPREADS.iter().zip(ends) {
                if tolerance > 0.0 {
                    let is_larger = nominal > tolerance;
                    let text = is_larger.then(|| uniform(key, tolerance, unit));
                    settings.push((keys[at], text.unwrap_or_default()));
                }
            }
            settings.push((amounts[at], of_drawing(amounts[at], reliefs.amounts[at], "um")));
            let length = has_relief.then(|| of_drawing(lengths[at], length, "mm"));
            settings.push((lengths[at], length.unwrap_or_default()));
        }
        if self.is_over_face {
            settings.push((CROWNING, of_drawing(CROWNING, reliefs.crowning, "um")));
        }
        if self.demand.misalignment > 0.0 {
            let text = uniform("deviations.misalignment", self.demand.misalignment, "um");
            settings.push(("spread.deviations.misalignment", text));
        }
        settings
    }
}

impl Results for Specification {
    /// The diagram of the relief to specify with its tolerances, on the pair of the case; without a
    /// relief to specify that of the best one.
    fn picture(&self, inputs: &Inputs) -> Option<Result<Chart, String>> {
        let (amount, length) = (self.demand.tolerance, self.tolerance_length());
        let Choice { reliefs, name, .. } = &self.choices[self.drawn(self.specified())];
        if reliefs.removed() <= 0.0 {
            let criterion = self.criterion();
            return Some(Err(format!(
                "no relief to draw: none has less {criterion} than the case"
            )));
        }
        let off = [amount, amount, length, length];
        let chart = relief_chart(&reliefs.of(inputs).reliefs(), &self.geometry, off);
        let is_advised = self.drawn(self.specified()) == self.specified();
        Some(chart.map(|chart| {
            let title = format!("{}: \"{name}\", not advised", chart.title);
            if is_advised { chart } else { Chart { title, ..chart } }
        }))
    }

    fn lines(&self, case: Named) -> Vec<String> {
        // Rows of tables fit; only sentences are wrapped.
        let is_short = |line: &String| line.chars().count() <= WIDTH;
        let lines = self.of_choice(self.specified(), true, self.demand.units).into_iter();
        let lines =
            lines.flat_map(|line| if is_short(&line) { vec![line] } else { item("", &line) });
        std::iter::once(case.heading()).chain(lines).collect()
    }

    fn json(&self) -> Json {
        // The reliefs have members of their own.
        let results: Vec<usize> = (7..3 + self.numbers().len()).collect();
        let results = self.choices(System::Metric).of(&results).objects();
        let choice = |(choice, results): (&Choice, Json)| {
            let line = json!({
                "name": choice.name,
                "relief": self.relief(&choice.reliefs),
                "transmission_errors": choice.errors,
                "corner_contact": choice.worst.strikes,
            });
            with(line, results)
        };
        let point = |point: &MapPoint| {
            let relief = self.relief(&point.reliefs);
            json!({"relief": relief, "transmission_error": point.error, "margin": point.margin})
        };
        let shares: Vec<f64> = self.demand.loads().into_iter().map(|(_, share)| share).collect();
        let chosen = &self.choices[self.specified()];
        json!({
            "method": self.method.name(),
            "torque": self.torque,
            "loads": self.loads,
            "shares": (!self.demand.spectrum.is_empty()).then_some(shares),
            "tolerance": self.demand.tolerance,
            "tolerance_length": self.demand.tolerance_length,
            "misalignment": self.is_over_face.then_some(self.demand.misalignment),
            "minimise": self.demand.minimise.name(),
            "relief": self.relief(&chosen.reliefs),
            "margin": chosen.worst.gap,
            "greatest_load": chosen.greatest_load,
            "unloaded_contact_ratio": chosen.unloaded_contact_ratio,
            "best": chosen.name,
            "choices": self.choices.iter().zip(results).map(choice).collect::<Json>(),
            "map": self.map.iter().flatten().map(point).collect::<Json>(),
            "tries": self.tries,
            "is_complete": !self.is_cut,
        })
    }

    /// The choices, then the map over amount and length.
    fn table(&self) -> Table {
        let mut table = self.choices(System::Metric);
        for MapPoint { reliefs, error, margin } in self.map.iter().flatten() {
            let begins = reliefs.begins(&self.geometry);
            let known = [
                (KEYS[0][0], reliefs.amounts[0]),
                (KEYS[0][1], reliefs.amounts[1]),
                (KEYS[1][0], reliefs.lengths[0]),
                (KEYS[1][1], reliefs.lengths[1]),
                (CROWNING, reliefs.crowning),
                ("transmission_error", *error),
                ("margin", *margin),
                ("driver.begin_diameter", begins[0].diameter),
                ("driven.begin_diameter", begins[1].diameter),
            ];
            let texts = ["map", "", name(reliefs.shape)].map(Cell::from);
            let number = |column: &Column| {
                let known = known.iter().find(|(key, _)| *key == column.key);
                Cell::number(known.map(|(_, value)| *value), "")
            };
            let row = texts.into_iter().chain(table.columns[3..].iter().map(number)).collect();
            table.rows.push(row);
        }
        table
    }
}

/// A column of numbers: key, header, unit in SI, metric unit and digits in text, value in SI.
type Numbers = (
    &'static str,
    &'static str,
    &'static str,
    (&'static str, usize),
    fn(&Specification, &Choice) -> Option<f64>,
);

/// The columns of numbers.
const NUMBERS: [Numbers; 24] = [
    ("driver.tip_relief", "Ca1", "m", ("um", 3), |_, of| Some(of.reliefs.amounts[0])),
    ("driver.tip_relief_length", "La1", "m", ("mm", 4), |_, of| of.length(0)),
    ("driven.tip_relief", "Ca2", "m", ("um", 3), |_, of| Some(of.reliefs.amounts[1])),
    ("driven.tip_relief_length", "La2", "m", ("mm", 4), |_, of| of.length(1)),
    ("transmission_error", "TE", "m", ("um", 3), |_, of| Some(of.nominal.error)),
    ("margin", "gap", "m", ("um", 2), |_, of| Some(of.worst.gap)),
    (CHANGE, "change", "1", ("%", 2), |all, of| {
        Some(of.nominal.error / all.choices[0].nominal.error - 1.0)
    }),
    ("worst_transmission_error", "worst", "m", ("um", 3), |_, of| Some(of.worst.error)),
    ("least_load_error", "TE", "m", ("um", 3), |_, of| of.errors.first().copied()),
    ("least_load_change", "change", "1", ("%", 2), |all, of| {
        Some(of.errors.first()? / all.choices[0].errors.first()? - 1.0)
    }),
    ("unloaded_contact_ratio", "ratio", "1", ("1", 3), |_, of| Some(of.unloaded_contact_ratio)),
    ("worst_entry_force", "entry", "N", ("N", 3), |_, of| Some(of.worst.entry)),
    ("worst_peak_force", "peak", "N", ("N", 4), |_, of| Some(of.worst.peak)),
    ("dynamic_factor", "K", "1", ("1", 3), |_, of| of.nominal.factor),
    ("greatest_load", "load", "1", ("% load", 0), |_, of| of.greatest_load.map(floor)),
    ("entry_force", "", "N", ("N", 3), |_, of| Some(of.nominal.entry)),
    ("peak_force", "", "N", ("N", 4), |_, of| Some(of.nominal.peak)),
    ("driver.begin_diameter", "", "m", ("mm", 5), |all, of| {
        Some(of.reliefs.begins(&all.geometry)[0].diameter)
    }),
    ("driven.begin_diameter", "", "m", ("mm", 5), |all, of| {
        Some(of.reliefs.begins(&all.geometry)[1].diameter)
    }),
    ("static_te_peak_to_peak", "", "m", ("um", 4), |_, of| Some(of.nominal.own_errors?[0])),
    ("static_transmission_error", "", "m", ("um", 4), |_, of| Some(of.nominal.own_errors?[1])),
    (CROWNING, "Cβ1", "m", ("um", 3), |_, of| Some(of.reliefs.crowning)),
    ("peak_line_load", "", "N/m", ("N/mm", 4), |_, of| of.nominal.line_load),
    ("worst_peak_line_load", "", "N/m", ("N/mm", 4), |_, of| of.worst.line_load),
];
/// The number of columns, at the end, of a load that varies over the face width.
const OVER_FACE: usize = 3;

/// The keys of the amounts and of the lengths of both gears.
const KEYS: [[&str; 2]; 2] = [
    ["driver.tip_relief", "driven.tip_relief"],
    ["driver.tip_relief_length", "driven.tip_relief_length"],
];
const SPREADS: [[&str; 2]; 2] = [
    ["spread.driver.tip_relief", "spread.driven.tip_relief"],
    ["spread.driver.tip_relief_length", "spread.driven.tip_relief_length"],
];
const CHANGE: &str = "change";
const CROWNING: &str = "driver.crowning";
const BOTH_GAPS: &str = "gap before E and after B at rest";

type PlaceOf = fn(&Begin) -> f64;

/// Where a tip relief begins: label, symbols, metric unit and place in SI.
pub(super) const BEGINS: [(&str, &str, &str, PlaceOf); 2] = [
    ("begins at roll angle", "ξ1 / ξ2", "deg", |at| at.roll_angle),
    ("begins at diameter dCa", "dCa1 / dCa2", "mm", |at| at.diameter),
];

/// The places at which the reliefs of both gears begin, and their tolerances by those of the reliefs.
pub(super) fn begins(
    of: PlaceOf,
    reliefs: &TipReliefs,
    geometry: &Geometry,
    off: Off,
) -> [[f64; 2]; 2] {
    let ends = [*reliefs, reliefs.off(off.map(|by| -by))].map(|one| one.begins(geometry));
    [0, 1].map(|gear| {
        let [own, shorter] = ends.each_ref().map(|begins| of(&begins[gear]));
        [own, shorter - own]
    })
}

/// The key of the diagram of reliefs.
pub const RELIEF: &str = "relief";

/// The tolerances of the tip reliefs by the distributions of a case.
pub fn tolerances(case: &Case) -> Off {
    let [[one, other], [from, to]] = KEYS;
    [one, other, from, to].map(|key| tolerance(case, key))
}

/// The tolerance of a tip relief or its length by its distribution in a case: the half-width, or three
/// standard deviations of a normal distribution; 0 for another field.
pub(super) fn tolerance(case: &Case, key: &str) -> f64 {
    const DEVIATIONS: f64 = 3.0;
    let is_of_relief = KEYS.as_flattened().contains(&key);
    let spread = case.spread.iter().find(|spread| spread.field == key && is_of_relief);
    let given = spread.filter(|_| index_of(key).and_then(|at| case.value(at)).is_some());
    given.map_or(0.0, |spread| match spread.shape {
        Shape::Normal => DEVIATIONS * spread.width,
        _ => spread.width,
    })
}

/// The diagram of the reliefs of a pair: the deviation of each profile from the involute over the
/// roll angle of its gear, from the start to the end of contact (K-chart), with the band within which
/// it is with deviations of the tip reliefs.
///
/// # Errors
/// The reason if the case has no relief.
pub fn relief_chart(all: &Reliefs, geometry: &Geometry, off: Off) -> Result<Chart, String> {
    /// Points between the ends of contact.
    const POINTS: u32 = 200;
    if all.sum() == 0.0 {
        return Err("the case has no relief".to_owned());
    }
    let none = GearReliefs { tip: 0.0, root: 0.0, ..all.driver };
    let Geometry { start, end, tangent_length, .. } = *geometry;
    let curve = |at: usize, by: f64| {
        let mut own = [Reliefs { driven: none, ..*all }, Reliefs { driver: none, ..*all }][at];
        let gear = if at == 0 { &mut own.driver } else { &mut own.driven };
        if by != 0.0 && gear.tip > 0.0 {
            let length = gear.tip_length.unwrap_or(geometry.shared_length()) + by * off[2 + at];
            gear.tip = (gear.tip + by * off[at]).max(0.0);
            gear.tip_length = Some(length.max(f64::MIN_POSITIVE));
        }
        let own = Relief::of(&own, geometry);
        let base = [geometry.driver.base, geometry.driven.base][at];
        let point = |point| {
            let driver = start + (end - start) * f64::from(point) / f64::from(POINTS);
            let driven = tangent_length - driver;
            let curvature = [driver, driven][at];
            ((curvature / base).to_degrees(), -1e6 * own.at(driver, driven))
        };
        (0..=POINTS).map(point).collect::<Vec<_>>()
    };
    let name = |at: usize| ["driver", "driven gear"][at];
    let series = [0, 1].map(|at| {
        let pieces = vec![curve(at, 0.0)];
        Series { name: name(at).to_owned(), pieces, kind: Kind::Curve }
    });
    let tips = [all.driver.tip, all.driven.tip];
    let has_band = |at: &usize| tips[*at] > 0.0 && off[*at].max(off[2 + at]) > 0.0;
    let pieces = (0..2).filter(has_band).flat_map(|at| [curve(at, 1.0), curve(at, -1.0)]).collect();
    let band = Series { name: "limits of the tolerances".to_owned(), pieces, kind: Kind::Bound };
    let band = Some(band).filter(|band| !band.pieces.is_empty());
    Ok(Chart {
        title: "Reliefs over the roll angle (K-chart)".to_owned(),
        across: Axis::new("roll angle of the gear", "deg"),
        up: Axis::new("Deviation from the involute", "um"),
        series: series.into_iter().chain(band).collect(),
        ..Chart::default()
    })
}

/// A load rounded down to 0.1 %.
fn floor(load: f64) -> f64 {
    (1e3 * load).floor() / 1e3
}

fn name(shape: ReliefShape) -> &'static str {
    match shape {
        ReliefShape::Linear => "linear",
        ReliefShape::Parabolic => "parabolic",
    }
}

/// A length or an angle in SI as a drawing states it, in the unit that corresponds to a metric unit:
/// 51 um, 6.10 mm, 2.01 thou, 0.2402 in.
pub(super) fn drawn(value: f64, metric: &str, units: System) -> String {
    let unit = units.unit(metric);
    let number = units::per(value, unit);
    match unit {
        "um" => shortest((number * 10.0).round() / 10.0),
        "thou" => shortest((number * 100.0).round() / 100.0),
        "in" => format!("{number:.4}"),
        _ => format!("{number:.2}"),
    }
}

/// One over the least step of a length of a choice in inch units, so that a row has at most 80
/// columns.
fn steps(key: &str, metric: &str, units: System) -> Option<f64> {
    let is_relief = KEYS[0].contains(&key) || key == CROWNING;
    match (units, metric) {
        (System::Inch, "mm") => Some(1e3),
        (System::Inch, "um") => Some(if is_relief { 1e2 } else { 1e4 }),
        _ => None,
    }
}

/// The decimals of a column of lengths, the same in each row.
fn decimals(key: &str, all: &Specification, units: System) -> Option<usize> {
    let at = KEYS[1].iter().position(|length| *length == key)?;
    let is_coarse = |length: f64| (length * 1e4 - (length * 1e4).round()).abs() < 1e-6;
    Some(match units {
        System::Inch => 3,
        System::Metric => {
            2 - usize::from(
                all.choices.iter().filter_map(|choice| choice.length(at)).all(is_coarse),
            )
        }
    })
}

fn percent(part: f64) -> String {
    tidy(100.0 * part, 4)
}

/// A change in percent.
fn change(from: f64, to: f64) -> String {
    format!("{:+.0} %", 100.0 * (to / from - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Stage, Stages, solve};

    #[test]
    fn a_relief_with_tolerances_has_a_band_around_its_curve() {
        let mut case = Case::table_1();
        for (key, text) in [("driven.tip_relief", "40 um"), ("driven.tip_relief_length", "5 mm")] {
            case.set(key, text).unwrap();
        }
        let inputs = case.inputs().unwrap();
        let geometry = solve(&inputs, Stages::of(Stage::Geometry)).unwrap().geometry;
        let chart = relief_chart(&inputs.reliefs(), &geometry, [6e-6, 6e-6, 0.0, 1e-4]).unwrap();
        let [_, driven, band] = &chart.series[..] else { panic!("{:?}", chart.series) };
        let [greater, smaller] = &band.pieces[..] else { panic!("{band:?}") };
        for (at, own) in driven.pieces[0].iter().enumerate() {
            assert!(greater[at].1 <= own.1 && own.1 <= smaller[at].1, "{own:?}");
        }
        // The tip is at the start of the path.
        assert!((driven.pieces[0][0].1 + 40.0).abs() < 1e-9, "{:?}", driven.pieces[0][0]);
        assert!((greater[0].1 + 46.0).abs() < 1e-9 && (smaller[0].1 + 34.0).abs() < 1e-9);
    }
}
