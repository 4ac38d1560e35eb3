//! The table of quantities: each row has the name, the value, the explanation and the inputs of a
//! quantity.
//!
//! Results pane, text, JSON, CSV, limits, `--only`, the explanation and the dependencies use these
//! rows. A new quantity needs a stage that computes it and a row here. The rows are Rust constants,
//! not a data file: the compiler checks the names of checks and conditions, and the program starts
//! without a parser.

mod at_rest;
mod checks;
pub mod conditions;
mod deviation;
mod face;
mod figures;
mod friction;
mod geometry;
mod impact;
mod motion;
mod position;
mod whine;

pub use impact::spread_force;

use super::explanation::{Check, Formula, Step, When};
use super::inputs::{Inputs, Method};
use super::{Solution, Stage, Stages};

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// The name in JSON, in `--only` and in `[limits]`.
    pub key: &'static str,
    /// The symbol in formulas.
    pub symbol: &'static str,
    /// A short description.
    pub label: &'static str,
    /// The SI unit, "1" for a number.
    pub unit: &'static str,
    /// The unit of the shown value.
    pub shown: &'static str,
    /// Significant digits of the shown value.
    pub digits: usize,
    /// The equation or standard that defines the value. A numbered equation, such as `Eq. 57`, must
    /// also be in the source. Other words need their first word in the source, the meaning or the
    /// assumptions, except `by the method`.
    pub equation: &'static str,
    /// The last stage that the value needs.
    pub stage: Stage,
    /// Another stage that the value reads in the methods that have it.
    pub also: Option<Stage>,
    /// The value in SI. `None` if the solution has no value.
    pub value: fn(&Solution) -> Option<f64>,
    /// Meaning and use of the quantity, or the words with which every variant begins.
    pub meaning: &'static str,
    /// How the value is computed.
    pub formula: Formula,
    /// Author, year, equation.
    pub source: &'static str,
    /// The equations with printing errors that the quantity uses.
    pub corrections: &'static [&'static str],
    /// The assumptions of the formula.
    pub assumptions: &'static str,
    /// Ranges of validity.
    pub checks: &'static [Check],
    /// Texts in some cases. The first variant whose condition is true is used.
    pub variants: &'static [Variant],
    /// Whether the value can be negative.
    pub is_signed: bool,
    /// Whether only a corner contact at the exit gives it a value.
    pub is_at_exit: bool,
    /// What the case must give for the quantity.
    pub needs: Need,
    /// The key of the result of `static` that corresponds to a quantity of the free impact.
    pub by_static: Option<&'static str>,
    /// The corresponding key for `dynamic`.
    pub by_dynamic: Option<&'static str>,
}

/// A row is the only one with its key.
impl PartialEq for Quantity {
    fn eq(&self, other: &Quantity) -> bool {
        self.key == other.key
    }
}

/// An input that is not required in a case but that a quantity needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// None.
    Nothing,
    /// A load that varies over the face width: a helical, misaligned or crowned pair.
    Slices,
    /// A friction coefficient.
    Friction,
    /// A backlash.
    Backlash,
    /// A tip radius.
    TipRadius,
}

/// A row without texts, from which every row begins.
const PLAIN: Quantity = Quantity {
    key: "",
    symbol: "",
    label: "",
    unit: "",
    shown: "",
    digits: 0,
    equation: "",
    stage: Stage::Geometry,
    also: None,
    value: |_| None,
    meaning: "",
    formula: Formula::Text(""),
    source: "",
    corrections: &[],
    assumptions: "",
    checks: &[],
    variants: &[],
    is_signed: false,
    is_at_exit: false,
    needs: Need::Nothing,
    by_static: None,
    by_dynamic: None,
};

/// Methods that set one member.
macro_rules! setters {
    ($($member:ident: $type:ty),*) => {
        $(const fn $member(self, $member: $type) -> Quantity { Quantity { $member, ..self } })*
    };
}

impl Quantity {
    /// A row with key, symbol and label; SI unit, shown unit and digits; value, meaning, formula. The
    /// other members are those of `self`.
    const fn row(
        self,
        [key, symbol, label]: [&'static str; 3],
        (unit, shown, digits): (&'static str, &'static str, usize),
        value: fn(&Solution) -> Option<f64>,
        meaning: &'static str,
        formula: Formula,
    ) -> Quantity {
        Quantity { key, symbol, label, unit, shown, digits, value, meaning, formula, ..self }
    }

    setters! {
        equation: &'static str, stage: Stage, source: &'static str,
        corrections: &'static [&'static str], assumptions: &'static str,
        checks: &'static [Check], variants: &'static [Variant], needs: Need
    }

    const fn signed(self) -> Quantity {
        Quantity { is_signed: true, ..self }
    }

    const fn also(self, stage: Stage) -> Quantity {
        Quantity { also: Some(stage), ..self }
    }

    const fn at_exit(self) -> Quantity {
        Quantity { is_at_exit: true, ..self }
    }

    /// The corresponding quantities of the methods `static` and `dynamic`.
    const fn counterparts(self, at_rest: &'static str, in_motion: &'static str) -> Quantity {
        Quantity { by_static: Some(at_rest), by_dynamic: Some(in_motion), ..self }
    }
}

/// The plane of the results of a helical pair.
pub const PLANE: &str = "Lengths, angles, forces and velocities are in the transverse plane, unless \
            name or meaning say otherwise.";

/// Texts of a quantity in some cases: the end of the meaning, and other assumptions.
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    when: When,
    meaning: &'static str,
    assumptions: Option<&'static str>,
}

impl Variant {
    const fn meaning(when: When, meaning: &'static str) -> Variant {
        Variant { when, meaning, assumptions: None }
    }

    const fn words(when: When, meaning: &'static str, assumptions: &'static str) -> Variant {
        Variant { when, meaning, assumptions: Some(assumptions) }
    }
}

impl Quantity {
    /// The value in SI if it is finite. Zero has no sign.
    pub fn finite_value(&self, solution: &Solution) -> Option<f64> {
        (self.value)(solution.having(self.stage))
            .filter(|value| value.is_finite())
            .map(|value| value + 0.0)
    }

    /// Whether a list of every quantity has the quantity: rows of the face width are only in those of
    /// a pair whose load varies over it.
    pub fn is_listed(&self, solution: &Solution) -> bool {
        self.needs != Need::Slices || solution.is_over_face
    }

    /// The stages that the value needs.
    pub fn stages(&self) -> Stages {
        Stages::of(self.stage).and(self.also.map_or(Stages::NONE, Stages::of))
    }

    /// The last stage that the value needs in a method.
    pub fn stage_in(&self, method: Method) -> Stage {
        let also = self.also.filter(|also| method.stages().has(*also));
        also.map_or(self.stage, |also| also.max(self.stage))
    }

    /// Whether the value is true (1) or false (0).
    pub fn is_flag(&self) -> bool {
        self.shown == "yes/no"
    }

    /// The symbol in a method. It differs from the closed form if the definition differs.
    pub fn symbol_in(&self, method: Method) -> &'static str {
        if self.leaves_reliefs_out(method) { "Δf_0" } else { self.symbol }
    }

    /// The label in a method.
    pub fn label_in(&self, method: Method) -> &'static str {
        if self.leaves_reliefs_out(method) { "error without reliefs" } else { self.label }
    }

    // `static` and `dynamic` apply the reliefs to the flanks and exclude them from Δf.
    fn leaves_reliefs_out(&self, method: Method) -> bool {
        self.key == "equivalent_error" && method.shares_load()
    }

    /// Meaning and use of the quantity in a case with these inputs.
    pub fn meaning_in(&self, inputs: &Inputs) -> String {
        let end = self.variant(inputs).map_or("", |variant| variant.meaning);
        format!("{}{end}", self.meaning)
    }

    /// The assumptions of the formula in a case with these inputs.
    pub fn assumptions_in(&self, inputs: &Inputs) -> String {
        let own = self.variant(inputs).and_then(|variant| variant.assumptions);
        let plane = if conditions::helical(inputs) { PLANE } else { "" };
        [own.unwrap_or(self.assumptions), plane].join(" ").trim().to_owned()
    }

    fn variant(&self, inputs: &Inputs) -> Option<&'static Variant> {
        self.variants.iter().find(|variant| (variant.when)(inputs))
    }

    /// Whether the quantity belongs to the free impact at D. Every method computes this closed form
    /// besides its own results.
    pub fn is_of_free_impact(&self) -> bool {
        FREE_IMPACT.contains(&self.stage)
    }

    /// The corresponding quantity of a method for a quantity of the free impact. For a closed-form
    /// method, the quantity itself.
    pub fn by(&'static self, method: Method) -> Option<&'static Quantity> {
        match method {
            Method::Paper | Method::Exact => Some(self),
            Method::Static => self.by_static.and_then(Quantity::find),
            Method::Dynamic => self.by_dynamic.and_then(Quantity::find),
            Method::Auto => None,
        }
    }

    /// Every quantity that has a name: those of the table, and the peak force by the method.
    pub fn all() -> impl Iterator<Item = &'static Quantity> {
        QUANTITIES.iter().chain([&at_rest::PEAK_FORCE])
    }

    /// The row of a method for a name that is no row, otherwise this row.
    pub fn row_in(&'static self, method: Method) -> &'static Quantity {
        self.by(method).filter(|_| self.key == at_rest::PEAK_FORCE.key).unwrap_or(self)
    }

    /// The quantity of a key.
    pub fn find(key: &str) -> Option<&'static Quantity> {
        Quantity::all().find(|quantity| quantity.key == key)
    }

    /// The quantity of a key or of its symbol in any method.
    pub fn named(name: &str) -> Option<&'static Quantity> {
        let has_symbol = |quantity: &&Quantity| {
            let mut symbols = Method::ALL.map(|method| quantity.symbol_in(method)).into_iter();
            symbols.any(|symbol| symbol == name)
        };
        Quantity::find(name).or_else(|| Quantity::all().find(has_symbol))
    }
}

/// The stages of the free impact at D.
const FREE_IMPACT: [Stage; 7] = [
    Stage::Position,
    Stage::Velocity,
    Stage::Compliance,
    Stage::Impact,
    Stage::Friction,
    Stage::Band,
    Stage::Stations,
];

/// The rows by groups, in the order of the results.
const GROUPS: [&[Quantity]; 10] = [
    geometry::TABLE,
    figures::TABLE,
    deviation::TABLE,
    position::TABLE,
    impact::TABLE,
    friction::TABLE,
    at_rest::TABLE,
    motion::TABLE,
    whine::TABLE,
    face::TABLE,
];

const COUNT: usize = {
    let (mut count, mut group) = (0, 0);
    while group < GROUPS.len() {
        count += GROUPS[group].len();
        group += 1;
    }
    count
};

/// Every quantity, in the order of the results.
pub static QUANTITIES: &[Quantity] = &{
    let mut all = [GROUPS[0][0]; COUNT];
    let (mut at, mut group) = (0, 0);
    while group < GROUPS.len() {
        let mut row = 0;
        while row < GROUPS[group].len() {
            all[at] = GROUPS[group][row];
            (at, row) = (at + 1, row + 1);
        }
        group += 1;
    }
    all
};

/// Every step between the fields and the quantities, except the steps of the compliance models.
pub fn steps() -> impl Iterator<Item = &'static Step> {
    [
        geometry::STEPS,
        face::STEPS,
        figures::STEPS,
        deviation::STEPS,
        position::STEPS,
        impact::STEPS,
        friction::STEPS,
        at_rest::STEPS,
        motion::STEPS,
    ]
    .into_iter()
    .flatten()
}

/// The driver's angle over the same arc of the base circles, in rad.
fn of_driver(solution: &Solution, angle_driven: f64) -> f64 {
    angle_driven * solution.geometry.driven.base / solution.geometry.driver.base
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_complete_and_names_only_rows_of_the_table() {
        for row in Quantity::all() {
            let words = [
                row.key,
                row.symbol,
                row.label,
                row.unit,
                row.shown,
                row.equation,
                row.meaning,
                row.source,
                row.assumptions,
            ];
            assert!(words.iter().all(|word| !word.is_empty()), "{}", row.key);
            assert!(row.digits > 0 || row.is_flag(), "{}", row.key);
            for key in [row.by_static, row.by_dynamic].into_iter().flatten() {
                assert!(Quantity::find(key).is_some(), "{}: {key}", row.key);
            }
        }
    }

    #[test]
    fn no_two_symbols_differ_by_case_alone() {
        let symbols = |quantity: &'static Quantity| {
            Method::ALL.map(|method| (quantity.key, quantity.symbol_in(method)))
        };
        let symbols: Vec<_> = Quantity::all().flat_map(symbols).collect();
        let stem = |symbol: &'static str| symbol.split(',').next().unwrap_or_default();
        for (key, symbol) in &symbols {
            let clash = |(_, theirs): &&(&str, &'static str)| {
                stem(theirs) != stem(symbol) && stem(theirs).eq_ignore_ascii_case(stem(symbol))
            };
            assert_eq!(symbols.iter().find(clash), None, "{key} {symbol}");
            assert_eq!(Quantity::named(symbol).map(|found| found.key), Some(*key), "{symbol}");
        }
    }
}
