//! The explanation of a result: formula, the formula with the numbers of the case, source,
//! corrections to the paper, validity, accuracy and sensitivity.
//!
//! The sentences and formulas of a quantity are in its row of
//! [`QUANTITIES`](crate::model::QUANTITIES).

mod derivation;

use super::{Shown, shown, value, value_as_in};
use crate::case::dependencies::{Dependence, fields_of, value_of};
use crate::case::fields::index_of;
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Case, FIELDS, Field};
use crate::model::compliance::model_of;
use crate::model::explanation::{Context, Finding};
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Solution, Stage, Stages, auto};
use crate::numeric::bounds;
use crate::numeric::decimal::significant;
use crate::report::table::{Cell, Column, Table, WIDTH, count, flow, json, with, write_line};
use crate::report::verdict::{Absence, Beside};
use derivation::{GLUE, Known, factor};
pub use derivation::{How, Leaf, STEP_UNITS, Token, Work, tokens};
use serde::Serialize;
use std::io::{self, Write};

/// An explained quantity.
#[derive(Debug, Clone, Serialize)]
pub struct Page {
    /// The quantity.
    #[serde(skip)]
    pub quantity: &'static Quantity,
    /// Its symbol in the method of the solution.
    pub symbol: &'static str,
    /// Its label in the method of the solution.
    pub label: &'static str,
    /// The method of the solution.
    pub method: &'static str,
    /// Whether method `auto` chose this method.
    #[serde(skip)]
    pub is_by_auto: bool,
    /// The value in SI, if any.
    pub value: Option<f64>,
    /// The value as text.
    pub shown: Option<Shown>,
    /// Why the value is absent.
    pub missing: Option<String>,
    /// The meaning and the use of the quantity.
    pub meaning: String,
    /// For a quantity of the free impact, its counterpart in the method.
    pub beside: Option<String>,
    /// The formula of the quantity, then the formula of each step.
    pub derivation: Vec<Work>,
    /// The other quantities and the fields in the formulas.
    #[serde(rename = "with")]
    pub leaves: Vec<Leaf>,
    /// Author, year, equation.
    pub source: &'static str,
    /// Corrected misprints.
    pub corrections: Vec<&'static Correction>,
    /// The assumptions of the formula.
    pub assumptions: String,
    /// The ranges of validity with the values of the case.
    #[serde(skip)]
    pub validity: Vec<Finding>,
    /// Sentences on the accuracy.
    pub accuracy: Vec<String>,
    /// The fields that the quantity depends on, with its change for a small step of each.
    #[serde(rename = "sensitivity")]
    pub effects: Vec<Effect>,
}

/// The stages that the page of a quantity shows: also those of its counterpart in the method.
pub fn stages_of(quantity: &'static Quantity, method: Method) -> Stages {
    quantity.stages().and(quantity.by(method).map_or(Stages::NONE, Quantity::stages))
}

/// Explains a quantity of a solved case. The solution must include [`stages_of`] it. `go_on`
/// receives the number of changed fields and of all fields behind the quantity; once it returns false,
/// the page is without the accuracy and the effects of these changes.
pub fn explain(
    quantity: &'static Quantity,
    case: &Case,
    inputs: &Inputs,
    solution: &Solution,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Page {
    let (chosen, solution) = (solution.method, solution.having(quantity.stage));
    let quantity = quantity.row_in(solution.method);
    let is_auto = inputs.method == Method::Auto;
    let used = if is_auto { auto::taken(inputs, solution.method) } else { inputs.clone() };
    let context = Context { inputs: &used, given: inputs, solution };
    let known = Known { case, context };
    let value = value(quantity, solution);
    let (derivation, leaves) = derivation::derivation_of(quantity, &known);
    let accuracy = if go_on(0, FIELDS.len()) { accuracy_of(quantity, &known) } else { Vec::new() };
    let effects = effects_of(quantity, &known, go_on);
    Page {
        quantity,
        symbol: quantity.symbol_in(solution.method),
        label: quantity.label_in(solution.method).trim_start(),
        method: solution.method.name(),
        is_by_auto: is_auto && chosen == solution.method,
        value,
        shown: value.map(|value| shown(quantity, value)),
        missing: value.is_none().then(|| format!("No value: {}", Absence::of(quantity, solution))),
        meaning: quantity.meaning_in(&used),
        beside: Beside::of(quantity, solution)
            .map(|beside| format!("This is the free impact. {}.", beside.sentence(System::Metric))),
        derivation,
        leaves,
        source: quantity.source,
        corrections: quantity.corrections.iter().filter_map(correction_of).collect(),
        assumptions: quantity.assumptions_in(&used),
        validity: quantity.checks.iter().filter_map(|check| check(&known.context)).collect(),
        accuracy,
        effects,
    }
}

/// Writes the page as one line; `name` is the name of the case.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(page: &Page, name: &str, out: &mut dyn Write) -> io::Result<()> {
    let quantity = page.quantity;
    let validity = page.validity.iter().map(
        |Finding { range, here, inside }| json!({"range": range, "here": here, "inside": inside}),
    );
    let line = json!({
        "case": name,
        "key": quantity.key,
        "equation": quantity.equation,
        "unit": quantity.unit,
        "validity": validity.collect::<Vec<_>>(),
    });
    write_line(&with(line, json!(page)), out)
}

/// A misprint and its correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Correction {
    /// The equation, or another place in the paper.
    pub equation: &'static str,
    /// The error.
    pub error: &'static str,
    /// The form that the program uses.
    pub used: &'static str,
}

const fn row(equation: &'static str, error: &'static str, used: &'static str) -> Correction {
    Correction { equation, error, used }
}

/// Every misprint that affects a quantity.
pub static CORRECTIONS: &[Correction] = &[
    row(
        "Eq. 1",
        "scales the modification e_m by 1/√2 with the random pitch errors, as if a \
        ground relief were random",
        "method paper keeps this; the other methods count e_m in full",
    ),
    row(
        "Eqs. 7-20",
        "differences of arctangents, linear in Δ, place D next to E, where the tip \
        has closed almost nothing of Δ",
        "method paper keeps them; the other methods solve S(u) = Δ",
    ),
    row(
        "Eq. 14",
        "arctan(r_b1/(N1E - Δf)) jumps by π if Δf > N1E",
        "the difference of Eq. 15 as \
        one atan2; Eqs. 17-19 likewise",
    ),
    row(
        "Eqs. 16, 20",
        "compute N1E from a rounded contact ratio, 0.6 um off for Table 1",
        "N1E = a sin α_w - √(r_a2² - r_b2²)",
    ),
    row("Eq. 22", "has the label ΔV_Dr", "ΔV_Dτ"),
    row(
        "Eqs. 27, 42, 60",
        "print the law of cosines as a root times a root: the approach \
        velocity at E would be 1.32 m/s for Table 1 instead of 0",
        "the law of cosines",
    ),
    row(
        "Eq. 31",
        "adds an impulse along V_D2 and divides by kg/m instead of kg",
        "as printed, with m_red in kg",
    ),
    row(
        "Eq. 32",
        "omits Hertz's prefactor 4.53398, and m_red is per width",
        "as printed with m_red in kg; also with the prefactor, and by the spring of \
        the model, which method exact uses",
    ),
    row(
        "Eq. 33, Eq. 50",
        "define two reduced masses, with r_b2 and with r_b2'",
        "Eq. 33 for T_S,32, Eq. 50 for F_S",
    ),
    row(
        "Eq. 34",
        "uses Δθ for another angle at O1 in its triangle",
        "method paper keeps this; \
        method exact uses the driven tip at u - ω_2 T_S,32, at most at E",
    ),
    row("Eq. 36", "uses the arc for the chord", "the chord"),
    row(
        "Eqs. 44, 45",
        "do not define V_D'n and V_Dn",
        "the changes of ΔV_n and ΔV_τ between D \
        and D'",
    ),
    row(
        "Eq. 46",
        "J/(b r_b²) is a mass per width",
        "J/r_b² in kg; energies are of the whole \
        width",
    ),
    row("Eq. 47", "divides by 2 g", "J = π ρ b/2 (r_b⁴ - r_h⁴)"),
    row("Eq. 53", "δ_s = F_S/(b q_s) is inverted", "δ_s = F_S q_s/b, which agrees with Eq. 57"),
    row("Eq. 54", "names the teeth 1-2", "the pair in contact at D, 3-4"),
    row(
        "Eq. 55",
        "does not define a",
        "Hertz's half-width under F_S, solved together with F_S; \
        1/E' = Σ (1 - ν²)/E",
    ),
    row(
        "Eq. 56",
        "is a cubic in z and diverges outside its range",
        "outside z 12..100 and |x| <= 0.6, kuang-yang is refused; with a given model.deflection, \
            methods paper and exact omit only force, energy and duration. Outside this range the \
            default is another tooth compliance",
    ),
    row(
        "Eq. 64",
        "is 0/0 without contact, and no Coulomb coefficient limits it",
        "no value \
        without contact; the μ of the case and stick_limit beside it",
    ),
    row(
        "Table 1",
        "prints no face width, and calls a radius of 20 mm d0",
        "the face width of the case; 20 mm as the bore radius",
    ),
    row(
        "section 6",
        "no consistent reading of Table 1 gives F_0 = 1260.8 N and f = 0.1811",
        "F_0 = T1/r_b1, 1524.3 N there; f by Eq. 64",
    ),
];

/// The correction of an equation.
fn correction_of(equation: &&str) -> Option<&'static Correction> {
    CORRECTIONS.iter().find(|correction| correction.equation == *equation)
}

/// The tolerance of the motion at which a small step is distinguishable.
const FINE: f64 = 1e-6;

/// A field and the change of the quantity for a small step of the field.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Effect {
    /// The field's key.
    pub key: &'static str,
    /// The field's symbol.
    #[serde(skip)]
    pub symbol: &'static str,
    /// The field's text.
    pub text: String,
    /// The step; empty for a choice or a field without a value.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub step: String,
    /// The change of the quantity; empty without a change.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub change: String,
}

/// The fields behind a quantity, in the order of the form. For method `auto`, the tolerance follows
/// from `model.within`.
fn effects_of(
    quantity: &Quantity,
    known: &Known,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Vec<Effect> {
    // Every step would need a motion at every speed, and the greatest of them moves from speed to
    // speed.
    if quantity.stage == Stage::SpeedRun || !go_on(0, FIELDS.len()) {
        return Vec::new();
    }
    // The change must exceed the error of the motion, and a step must not switch the stiffness
    // model.
    let tolerance = known.context.inputs.tolerance.min(FINE);
    let fixed = Inputs {
        tooth_compliance: Some(model_of(known.context.inputs)),
        tolerance,
        ..known.context.inputs.clone()
    };
    let is_coarse = quantity.stage_in(fixed.method) == Stage::Dynamic
        && tolerance < known.context.inputs.tolerance;
    let own = value(quantity, known.context.solution);
    let own = if is_coarse { value_of(quantity, &fixed) } else { own };
    let [within, tolerance] = ["model.within", "model.tolerance"].map(index_of);
    let is_by_auto = known.context.given.method == Method::Auto;
    let noise = noise(quantity, &fixed);
    let effect = |Dependence { field, step }: Dependence| {
        let is_of_auto = is_by_auto && Some(field) == tolerance;
        let (field, step) = if is_of_auto { (within?, None) } else { (field, step) };
        let change = own.zip(step.as_ref());
        let change = change.map(|(own, step)| change_of(quantity, own, step.value, noise));
        let Field { key, symbol, .. } = FIELDS[field];
        Some(Effect {
            key,
            symbol,
            text: known.case.effective(field).map(sanitize).unwrap_or_default(),
            step: step.map(|step| step.text.to_owned()).unwrap_or_default(),
            change: change.unwrap_or_default(),
        })
    };
    let fields = fields_of(quantity, known.case, (&fixed, own), go_on);
    fields.into_iter().filter_map(effect).collect()
}

/// A change of the value, relative or in the unit of the quantity.
fn change_of(quantity: &Quantity, own: f64, found: Option<f64>, noise: f64) -> String {
    let Some(found) = found else {
        return "no value".to_owned();
    };
    let change = found - own;
    if quantity.is_flag() {
        let becomes = || format!("becomes {}", shown(quantity, found));
        return if change == 0.0 { String::new() } else { becomes() };
    }
    if change.abs() <= noise * own.abs() {
        return String::new();
    }
    let sign = if change > 0.0 { "+" } else { "-" };
    if own == 0.0 {
        let in_unit = change.abs() / factor(quantity.shown).unwrap_or(1.0);
        return format!("{sign}{} {}", significant(in_unit, 3), quantity.shown);
    }
    format!("{sign}{} %", significant(100.0 * change.abs() / own.abs(), 3))
}

/// The relative change below which a value is unchanged: rounding, or the step error of the motion.
fn noise(quantity: &Quantity, inputs: &Inputs) -> f64 {
    const ROUNDING: f64 = 1e-11;
    const AT_REST: f64 = 1e-10;
    const STEPS: f64 = 10.0;
    const CLOSENESS: f64 = 1e-4;
    const STEADY: f64 = 1e-5;
    match quantity.stage_in(inputs.method) {
        Stage::Dynamic => STEPS * inputs.tolerance,
        Stage::Clearing if inputs.method.shares_load() => CLOSENESS,
        Stage::SteadyMotion | Stage::SpeedRun => STEADY,
        Stage::Mesh | Stage::Static | Stage::Resonance | Stage::StaticSpectrum => AT_REST,
        _ => ROUNDING,
    }
}

/// Sentences on the accuracy of a quantity.
fn accuracy_of(quantity: &Quantity, known: &Known) -> Vec<String> {
    let Some(own) = value(quantity, known.context.solution) else {
        return Vec::new();
    };
    let spread = (!quantity.is_flag()).then(|| over_models(quantity, own, known)).flatten();
    [numerical(quantity, known), spread, over_methods(quantity, known)]
        .into_iter()
        .flatten()
        .collect()
}

fn numerical(quantity: &Quantity, known: &Known) -> Option<String> {
    let inputs = known.context.inputs;
    let error = match quantity.stage_in(inputs.method) {
        _ if quantity.is_flag() => return None,
        Stage::Dynamic => format!("at most {} of the peak force", tolerance(known)),
        Stage::Clearing if inputs.method.shares_load() => {
            "with 1/20,000 less relief the tooth touches".to_owned()
        }
        Stage::SteadyMotion => "at most 1e-5 of the greatest amplitude".to_owned(),
        Stage::SpeedRun => "the speeds are 1/120 of their range apart, at a peak an eighth of this".to_owned(),
        Stage::Static | Stage::StaticSpectrum if inputs.face().is_some() => {
            "at most 1e-11 of the value with these slices; the usual number leaves transmission error \
             and load shares within 0.1 %, line loads and forces on the tips within about 0.5 %"
                .to_owned()
        }
        Stage::Static | Stage::StaticSpectrum => "at most 1e-11 of the value".to_owned(),
        _ if inputs.accurate => "at most 1e-13 of the value".to_owned(),
        _ => "below 1e-12 of the value in most cases, at most 1e-9".to_owned(),
    };
    let digits = quantity.digits;
    Some(format!("Numerical error: {error}; {digits} digits shown."))
}

/// The tolerance of the motion and its origin.
fn tolerance(known: &Known) -> String {
    let given = known.context.given;
    let used = known.context.inputs.tolerance;
    if given.method == Method::Auto {
        let (within, tolerance) = (given.within, given.tolerance);
        format!(
            "{used:e} (chosen by auto for model.within = {within}; model.tolerance = \
                {tolerance:e} is not used)"
        )
    } else {
        format!("model.tolerance = {used:e}")
    }
}

/// The values of the quantity by every stiffness model that covers the pair.
fn over_models(quantity: &Quantity, own: f64, known: &Known) -> Option<String> {
    let inputs = known.context.inputs;
    let found = StiffnessModels::covering(inputs)
        .filter_map(|models| value_of(quantity, &models.in_place_of(inputs)));
    let (least, most) = bounds(found.chain([own]));
    let share = |value: f64| format!("{:+.1} %", 100.0 * (value - own) / own.abs());
    (most - least > noise(quantity, inputs) * own.abs()).then(|| {
        format!(
            "All stiffness models: {} to {} ({} to {}). docs/validation.md compares \
             the stiffness with published figures.",
            shown(quantity, least),
            shown(quantity, most),
            share(least),
            share(most)
        )
    })
}

/// The values by other methods, if they differ.
fn over_methods(quantity: &Quantity, known: &Known) -> Option<String> {
    let inputs = known.context.inputs;
    let by = |method: Method| {
        let inputs = Inputs { method, ..inputs.clone() };
        let solution = model::solve(&inputs, quantity.stages()).ok()?;
        let own = known.context.solution.method;
        Some((method, value_as_in(quantity, &solution, own)?))
    };
    let own = Some(inputs.method).filter(|method| !Method::CLOSED_FORM.contains(method));
    let found: Vec<(Method, f64)> =
        Method::CLOSED_FORM.into_iter().chain(own).filter_map(by).collect();
    let (&(_, first), others) = found.split_first()?;
    let differs =
        |(_, value): &(Method, f64)| (value - first).abs() > noise(quantity, inputs) * first.abs();
    let listed: Vec<String> = found
        .iter()
        .map(|&(method, value)| format!("{} {}", name(quantity, method), shown(quantity, value)))
        .collect();
    others.iter().any(differs).then(|| format!("Methods: {}.", listed.join(", ")))
}

/// The name of the method. A free impact in a method that resolves the impact is the closed form
/// with the deflection of that method.
fn name(quantity: &Quantity, method: Method) -> String {
    let is_beside = method.shares_load() && quantity.is_of_free_impact();
    if is_beside {
        format!("exact with the deflection that {} computes", method.name())
    } else {
        method.name().to_owned()
    }
}

/// The kind of a line, which decides its style.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The quantity and its value.
    Title,
    /// The name of a section.
    Heading,
    /// A formula in symbols.
    Formula,
    /// A formula with numbers, or its result.
    Numbers,
    /// Sentences and tables.
    Text,
    /// A validity range that does not contain the case.
    Outside,
}

/// A line of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// The kind of the line.
    pub kind: Kind,
    /// The text of the line.
    pub text: String,
}

/// The page as text, 80 columns wide.
pub fn render(page: &Page, name: &str) -> String {
    let lines = lines(page, name, WIDTH);
    lines.iter().map(|line| line.text.trim_end().to_owned() + "\n").collect()
}

/// The page as lines of at most `width` columns; `name` is the name of the case.
pub fn lines(page: &Page, name: &str, width: usize) -> Vec<Line> {
    let mut out = Writer { width: width.max(20), lines: Vec::new() };
    out.head(page, name);
    out.section("Formula", |out| page.derivation.iter().for_each(|work| out.worked(work)));
    out.section("Values used", |out| out.leaves(&page.leaves));
    out.section("Source", |out| out.paragraph(page.source, 2));
    out.section("Corrections to the paper", |out| out.corrections(&page.corrections));
    out.section("Validity", |out| out.validity(page));
    out.section("Accuracy", |out| page.accuracy.iter().for_each(|line| out.paragraph(line, 2)));
    out.section("Sensitivity", |out| out.effects(&page.effects));
    out.lines
}

/// The lines of a page so far.
struct Writer {
    width: usize,
    lines: Vec<Line>,
}

impl Writer {
    fn push(&mut self, kind: Kind, text: impl Into<String>) {
        self.lines.push(Line { kind, text: text.into() });
    }

    /// Adds words wrapped into lines: the first starts with `lead`, the others with `more`.
    fn block(&mut self, kind: Kind, text: &str, lead: &str, more: &str) {
        let room = self.width.saturating_sub(count(lead).max(count(more))).max(8);
        let rows = flow(text.split(' ').filter(|word| !word.is_empty()), room);
        for (at, row) in rows.iter().enumerate() {
            let start = if at == 0 { lead } else { more };
            self.push(kind, start.to_owned() + &row.replace(GLUE, " "));
        }
    }

    fn paragraph(&mut self, text: &str, indent: usize) {
        let lead = " ".repeat(indent);
        self.block(Kind::Text, text, &lead, &lead);
    }

    /// Adds a heading before the lines of a section, unless there are none.
    fn section(&mut self, title: &str, write: impl FnOnce(&mut Writer)) {
        let start = self.lines.len();
        write(self);
        if self.lines.len() > start {
            let head = [(Kind::Text, ""), (Kind::Heading, title)];
            let head = head.map(|(kind, text)| Line { kind, text: text.to_owned() });
            self.lines.splice(start..start, head);
        }
    }

    fn head(&mut self, page: &Page, name: &str) {
        let quantity = page.quantity;
        let (comma, equals) = if page.symbol.is_empty() { ("", "") } else { (", ", " = ") };
        let title = format!("{}{comma}{} ({})", page.label, page.symbol, quantity.equation);
        let value = match (&page.shown, &page.missing) {
            (Some(shown), _) => format!("{}{equals}{shown}", page.symbol),
            (None, reason) => reason.clone().unwrap_or_default(),
        };
        let by = if page.is_by_auto { ", chosen by auto" } else { "" };
        let of = format!("{} · {} · method {}{by}", quantity.key, sanitize(name), page.method);
        self.block(Kind::Title, &title, "", "");
        self.block(Kind::Title, &value, "", "  ");
        self.block(Kind::Text, &of, "", "");
        self.push(Kind::Text, "");
        self.paragraph(&page.meaning, 0);
        if let Some(beside) = &page.beside {
            self.paragraph(beside, 0);
        }
    }

    /// Adds a value, its formula and its numbers.
    fn worked(&mut self, work: &Work) {
        let Work { symbol, meaning, formula, how, .. } = work;
        let sign = match how {
            How::Equals => " = ",
            How::Solves => " from ",
            How::Described => ": ",
        };
        let (lead, deep) = (format!("  {symbol}{sign}"), " ".repeat(count(symbol) + 3));
        let more = format!("{deep}  ");
        if *how == How::Described && !meaning.is_empty() {
            self.block(Kind::Formula, &format!("{meaning}; {formula}"), &lead, &more);
        } else {
            self.block(Kind::Formula, formula, &lead, &more);
            self.meaning(meaning, &more);
        }
        let shown = work.shown.as_ref().map(|shown| shown.to_string().replace(' ', GLUE));
        let numbers = work.numbers.clone().filter(|numbers| Some(numbers) != shown.as_ref());
        let parts: Vec<String> = numbers.into_iter().chain(shown).collect();
        let parts = parts.join(&format!(" ={GLUE}"));
        self.block(Kind::Numbers, &parts, &format!("{deep}= "), &more);
        self.block(Kind::Text, work.residual.as_deref().unwrap_or_default(), &more, &more);
    }

    /// Adds the meaning of a step to the right of its formula, or below it if it does not fit.
    fn meaning(&mut self, meaning: &str, more: &str) {
        const COLUMN: usize = 38;
        let room = self.lines.last().map_or(0, |line| count(&line.text) + 2).max(COLUMN);
        match self.lines.last_mut() {
            _ if meaning.is_empty() => {}
            Some(line) if line.kind == Kind::Formula && room + count(meaning) <= self.width => {
                line.text = format!("{:room$}{meaning}", line.text);
            }
            _ => self.block(Kind::Text, meaning, more, more),
        }
    }

    fn leaves(&mut self, leaves: &[Leaf]) {
        let columns = ["symbol", "value", "meaning"].map(|key| Column::text(key, "").wide(2, 0));
        let rows = leaves.iter().map(|leaf| {
            let meaning = format!("{} ({})", leaf.meaning, leaf.key);
            vec![leaf.symbol.into(), leaf.shown.as_str().into(), meaning.into()]
        });
        let table = Table::new("", columns.to_vec()).with(rows);
        table.wrapped(self.width).into_iter().for_each(|line| self.push(Kind::Text, line));
    }

    fn corrections(&mut self, corrections: &[&Correction]) {
        if corrections.is_empty() {
            self.paragraph("None.", 2);
        }
        for Correction { equation, error, used } in corrections {
            let text = format!("{equation}: {error}. Used: {used}.");
            self.block(Kind::Text, &text, "  ", "    ");
        }
    }

    fn validity(&mut self, page: &Page) {
        self.paragraph(&page.assumptions, 2);
        for Finding { range, here, inside } in &page.validity {
            let (kind, mark) =
                if *inside { (Kind::Text, "  ok   ") } else { (Kind::Outside, "  NOT  ") };
            self.block(kind, &format!("{range}. Here: {here}."), mark, "       ");
        }
    }

    fn effects(&mut self, effects: &[Effect]) {
        let (acting, idle): (Vec<&Effect>, Vec<&Effect>) =
            effects.iter().partition(|effect| !effect.change.is_empty());
        let column = Column::text("", "").wide(2, 0);
        let number = column.clone().to_the_right();
        let columns = vec![column.clone(), column.clone(), column, number.clone(), number];
        let row = |effect: &&Effect| {
            let Effect { key, symbol, text, step, change } = effect;
            [symbol, key, text.as_str(), step, change].map(Cell::from).to_vec()
        };
        let table = Table::new("", columns).with(acting.iter().map(row));
        let fits = |lines: &Vec<String>| lines.iter().all(|line| count(line) <= self.width);
        let rows = [table.lines(), table.of(&[1, 2, 3, 4]).lines()].into_iter().find(fits);
        match rows {
            Some(rows) => rows.into_iter().for_each(|row| self.push(Kind::Text, row)),
            None => {
                for Effect { key, text, step, change, .. } in &acting {
                    self.paragraph(&format!("{key} = {text}: {step} gives {change}"), 2);
                }
            }
        }
        if !idle.is_empty() {
            let lead = if acting.is_empty() {
                "Fields read:"
            } else {
                "Other inputs (choices, defaults, or fields without effect in this case):"
            };
            let field =
                |effect: &&Effect| format!("{} = {}", effect.key, effect.text).replace(' ', GLUE);
            self.paragraph(lead, 2);
            self.paragraph(&idle.iter().map(field).collect::<Vec<_>>().join(", "), 4);
        }
    }
}
