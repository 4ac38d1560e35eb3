//! The visible panes and their areas, and the places that receive keys.

use ratatui::layout::Constraint::{Fill, Length};
use ratatui::layout::{Layout as Layouts, Rect, Size};

use crate::model::{Stage, Stages};

/// The smallest useful terminal.
pub(crate) const SMALLEST: Size = Size { width: 60, height: 12 };
/// Least height of a terminal with the results beside the form.
const RESULTS_FROM: u16 = 16;
/// Least height of a terminal with a lower area in addition to form and results.
const LOWER_FROM: u16 = 20;
/// Least size with the teeth beside the chart.
const BESIDE_FROM: Size = Size { width: 120, height: 36 };
/// Least size with form, results and the lower panes side by side.
const THREE_FROM: Size = Size { width: 200, height: 50 };
/// Greatest useful width of the form, and of the results beside other panes.
const WIDEST: u16 = 66;
const WIDEST_RESULTS: u16 = 90;
/// Width of the form between the results and the edge of a wide screen.
const FORM_OF_THREE: u16 = 56;

/// A part of the screen with its own title and keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pane {
    /// Every field of the case.
    Form,
    /// Every quantity of the model.
    Results,
    /// Curves over the driver's roll angle.
    Chart,
    /// The teeth as they touch.
    Teeth,
    /// Accuracy of every method against its run time.
    Trade,
    /// A result over the range of a field, a map of two fields, or the tolerance.
    Study,
}

impl Pane {
    /// Every pane, in the order of its number.
    pub const ALL: [Pane; 6] =
        [Pane::Form, Pane::Results, Pane::Chart, Pane::Teeth, Pane::Trade, Pane::Study];
    /// The panes that share the lower area.
    pub(crate) const LOWER: [Pane; 4] = [Pane::Chart, Pane::Teeth, Pane::Trade, Pane::Study];

    /// The name of the pane.
    pub(crate) const fn name(self) -> &'static str {
        ["Form", "Results", "Chart", "Teeth", "Trade", "Study"][self as usize]
    }

    /// The digit that selects the pane, from 1.
    pub const fn number(self) -> usize {
        self as usize + 1
    }

    /// The pane of a digit.
    pub(crate) fn of_digit(digit: char) -> Option<Pane> {
        Pane::ALL.get((digit.to_digit(10)? as usize).checked_sub(1)?).copied()
    }

    /// Whether it shares the lower area.
    pub(crate) const fn is_lower(self) -> bool {
        !matches!(self, Pane::Form | Pane::Results)
    }

    /// The stages of a solve that the pane shows, if the method has them.
    pub(crate) const fn needs(self) -> Stages {
        match self {
            Pane::Form | Pane::Trade | Pane::Study => Stages::NONE,
            Pane::Results => Stages::CLOSED_FORM
                .with(Stage::Figures)
                .with(Stage::Band)
                .and(Stages::of(Stage::Static))
                .and(Stages::of(Stage::Resonance))
                .and(Stages::of(Stage::SteadyMotion))
                .and(Stages::of(Stage::SpeedRun))
                .and(Stages::of(Stage::Clearing)),
            Pane::Chart => Stages::STATIONS,
            Pane::Teeth => {
                Stages::of(Stage::Impact).and(Stages::of(Stage::Static)).with(Stage::Dynamic)
            }
        }
    }

    /// The place of keys while the pane has the focus and no field is edited.
    pub(crate) const fn place(self) -> Place {
        [Place::FIELD, Place::RESULTS, Place::CHART, Place::TEETH, Place::TRADE, Place::STUDY]
            [self as usize]
    }

    /// The pane `by` places further, wrapping around.
    pub(crate) fn beside(self, by: isize) -> Pane {
        let count = Pane::ALL.len();
        Pane::ALL[(self as usize + count).saturating_add_signed(by) % count]
    }
}

/// The visible panes, whose areas follow from the size of the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// The size of the terminal.
    pub size: Size,
    /// The pane with the focus.
    pub focus: Pane,
    /// The pane of the lower area that is shown if they do not all fit.
    pub(crate) lower: Pane,
    /// Whether the focused pane fills the screen.
    pub(crate) is_zoomed: bool,
}

impl Layout {
    /// The default panes on a terminal of a size.
    pub(crate) fn new(size: Size) -> Layout {
        Layout { size, focus: Pane::Form, lower: Pane::Chart, is_zoomed: false }
    }

    /// The areas of the screen.
    pub fn plan(self) -> Plan {
        let size = self.size;
        if is_too_small(size) {
            return Plan::default();
        }
        // A field of the form alone shows its whole description.
        let hint = if self.is_zoomed && self.focus == Pane::Form { 5 } else { 2 };
        let rows = Layouts::vertical([Length(1), Fill(1), Length(hint), Length(1)]);
        let [header, body, hint, keys] = Rect::from(size).layout(&rows);
        let mut plan = Plan { header, hint, keys, ..Plan::default() };
        // The pane of the lower area beside the teeth, if these have an area of their own.
        let beside = if self.lower == Pane::Teeth { Pane::Chart } else { self.lower };
        let is_lower = size.height < LOWER_FROM && self.focus.is_lower();
        if self.is_zoomed || size.height < RESULTS_FROM || is_lower {
            plan.place([self.focus], [body]);
        } else if size.height < LOWER_FROM {
            plan.place([Pane::Form, Pane::Results], split(body));
        } else if holds(size, THREE_FROM) {
            let results = (body.width * 2 / 5).min(WIDEST_RESULTS);
            let columns = [Length(FORM_OF_THREE), Length(results), Fill(1)];
            let [form, results, right] = body.layout(&Layouts::horizontal(columns));
            let rows = [Length(right.height / 2), Fill(1)];
            let [teeth, below] = right.layout(&Layouts::vertical(rows));
            plan.place([Pane::Form, Pane::Results], [form, results]);
            plan.place([Pane::Teeth, beside], [teeth, below]);
        } else if holds(size, BESIDE_FROM) {
            let [upper, lower] = two_rows(body);
            plan.place([Pane::Form, Pane::Results], split(upper));
            let widths = Layouts::horizontal([Length(lower.width * 60 / 100), Fill(1)]);
            plan.place([beside, Pane::Teeth], lower.layout(&widths));
        } else if self.focus.is_lower() {
            let [upper, lower] = two_rows(body);
            plan.place([Pane::Form, Pane::Results], split(upper));
            plan.place([self.lower], [lower]);
        } else {
            // The results use the whole height until the lower pane gets the focus.
            let [left, results] = split(body);
            plan.place([Pane::Form, self.lower], two_rows(left));
            plan.place([Pane::Results], [results]);
        }
        plan
    }
}

/// The areas of the screen. A hidden part has an empty area.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Plan {
    /// The name of the case.
    pub(crate) header: Rect,
    /// The areas of the panes with their titles, in the order of [`Pane::ALL`].
    panes: [Rect; Pane::ALL.len()],
    /// The hint of the focused field, and messages.
    pub(crate) hint: Rect,
    pub(crate) keys: Rect,
}

/// Whether a terminal is too small to use.
pub(crate) fn is_too_small(size: Size) -> bool {
    !holds(size, SMALLEST)
}

impl Plan {
    /// The area of a pane; empty if the pane is hidden.
    pub fn area(&self, pane: Pane) -> Rect {
        self.panes[pane as usize]
    }

    /// Whether a pane is visible.
    pub(crate) fn shows(&self, pane: Pane) -> bool {
        !self.area(pane).is_empty()
    }

    /// The hidden panes.
    pub(crate) fn hidden(self) -> impl Iterator<Item = Pane> {
        Pane::ALL.into_iter().filter(move |&pane| !self.shows(pane))
    }

    /// The pane whose title lists the hidden panes: the lowest visible pane whose area they can
    /// use.
    pub(crate) fn names_hidden(&self) -> Option<Pane> {
        let lowest =
            [Pane::Study, Pane::Trade, Pane::Chart, Pane::Teeth, Pane::Results, Pane::Form];
        lowest.into_iter().find(|&pane| self.shows(pane))
    }

    fn place<const COUNT: usize>(&mut self, panes: [Pane; COUNT], areas: [Rect; COUNT]) {
        for (pane, area) in panes.into_iter().zip(areas) {
            self.panes[pane as usize] = area;
        }
    }
}

/// The areas of form and results.
fn split(area: Rect) -> [Rect; 2] {
    let width = (area.width / 2).clamp(34, WIDEST);
    area.layout(&Layouts::horizontal([Length(width), Fill(1)]))
}

/// The upper area and the lower one.
fn two_rows(area: Rect) -> [Rect; 2] {
    let height = (area.height.saturating_add(4) / 3).clamp(7, 20);
    area.layout(&Layouts::vertical([Fill(1), Length(height)]))
}

fn holds(size: Size, least: Size) -> bool {
    size.width >= least.width && size.height >= least.height
}

/// The key of the command that goes to the next error.
pub(crate) const NEXT_FAULT: &str = "Alt-E";

/// A set of places that receive keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place(u32);

impl Place {
    /// No place.
    pub(crate) const NONE: Place = Place(0);
    /// A field of text or of a value.
    pub(crate) const TEXT: Place = Place(1);
    /// A field with a list of choices.
    pub(crate) const CHOICE: Place = Place(2);
    /// A prompt for a path, with a list.
    pub(crate) const BROWSE: Place = Place(4);
    /// A prompt with a line: a path or an angle.
    pub(crate) const PATH: Place = Place(8);
    /// A question with buttons.
    pub(crate) const ASK: Place = Place(16);
    /// A page of text.
    pub(crate) const READ: Place = Place(32);
    /// A list with a filter.
    pub(crate) const PICK: Place = Place(64);
    /// The form, outside its fields.
    pub(crate) const FIELD: Place = Place(128);
    /// The results.
    pub(crate) const RESULTS: Place = Place(256);
    /// The chart.
    pub(crate) const CHART: Place = Place(512);
    /// The teeth.
    pub(crate) const TEETH: Place = Place(1024);
    /// Accuracy against run time.
    pub(crate) const TRADE: Place = Place(2048);
    /// The explanation of a result.
    pub(crate) const EXPLAIN: Place = Place(4096);
    /// An empty or fully selected field: `/` and `:` are commands.
    pub(crate) const FRESH: Place = Place(8192);
    /// The study.
    pub(crate) const STUDY: Place = Place(16384);
    /// A chart with its own axes, which has no roll angle.
    pub(crate) const OWN_CHART: Place = Place(32768);
    /// The contact pattern, a chart over roll angle and face width.
    pub(crate) const PATTERN: Place = Place(131_072);
    /// The contact pattern of a case that has none.
    pub(crate) const MISSING_CHART: Place = Place(262_144);
    /// The tolerance, which replaces the study.
    pub(crate) const TOLERANCE: Place = Place(65536);
    /// A field that takes text or a name.
    pub(crate) const FORM: Place = Place::TEXT.or(Place::CHOICE);
    /// The panes in which letters are commands.
    pub(crate) const OUTSIDE: Place = Place::VALUES.or(Place::STUDY).or(Place::TOLERANCE);
    /// The panes in which a value can be copied.
    pub(crate) const VALUES: Place = Place::FIELD
        .or(Place::RESULTS)
        .or(Place::CURSOR)
        .or(Place::TRADE)
        .or(Place::OWN_CHART)
        .or(Place::PATTERN)
        .or(Place::MISSING_CHART);
    /// Every place except prompts.
    pub(crate) const WORK: Place = Place::FORM.or(Place::OUTSIDE);
    /// The places where `/` and `:` are commands.
    pub(crate) const COMMANDED: Place = Place::OUTSIDE.or(Place::CHOICE).or(Place::FRESH);
    /// Every chart.
    pub(crate) const CHARTS: Place = Place::CHART.or(Place::OWN_CHART).or(Place::MISSING_CHART);
    /// The panes with the cursor of the roll angle.
    pub(crate) const CURSOR: Place = Place::CHART.or(Place::TEETH);
    pub(crate) const PAGE: Place = Place::READ.or(Place::EXPLAIN);
    pub(crate) const LIST: Place = Place::BROWSE.or(Place::PICK);
    pub(crate) const LINE: Place = Place::TEXT.or(Place::LIST).or(Place::PATH);
    pub(crate) const PROMPT: Place = Place::LIST.or(Place::PATH).or(Place::ASK).or(Place::PAGE);
    /// Every place except pages of text, which `F1` closes.
    pub(crate) const HELPED: Place =
        Place::WORK.or(Place::LIST).or(Place::PATH).or(Place::ASK).or(Place::EXPLAIN);
    pub(crate) const ALL: Place = Place::WORK.or(Place::PROMPT);
    /// The places where letters are more than commands of the table.
    pub(crate) const TYPED: Place = Place::LINE.or(Place::CHOICE).or(Place::ASK);

    /// Whether both sets have a place in common.
    pub const fn meets(self, other: Place) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether this set contains every place of the other set.
    pub(crate) const fn holds(self, other: Place) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether letters go into a line of text.
    pub(crate) const fn is_line(self) -> bool {
        self.meets(Place::LINE)
    }

    pub(crate) const fn or(self, other: Place) -> Place {
        Place(self.0 | other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(size: (u16, u16), focus: Pane, lower: Pane, is_zoomed: bool) -> Vec<Pane> {
        let plan = Layout { size: size.into(), focus, lower, is_zoomed }.plan();
        Pane::ALL.into_iter().filter(|&pane| plan.shows(pane)).collect()
    }

    #[test]
    fn the_visible_panes_at_common_sizes() {
        use Pane::{Chart, Form, Results, Teeth, Trade};
        assert_eq!(seen((59, 16), Form, Chart, false), []);
        assert_eq!(seen((60, 12), Results, Chart, false), [Results]);
        assert_eq!(seen((60, 16), Form, Chart, false), [Form, Results]);
        assert_eq!(seen((60, 16), Teeth, Chart, false), [Teeth]);
        assert_eq!(seen((80, 24), Form, Chart, false), [Form, Results, Chart]);
        assert_eq!(seen((80, 24), Form, Teeth, false), [Form, Results, Teeth]);
        assert_eq!(seen((140, 45), Form, Chart, false), [Form, Results, Chart, Teeth]);
        assert_eq!(seen((140, 45), Form, Trade, false), [Form, Results, Teeth, Trade]);
        assert_eq!(seen((240, 70), Form, Chart, false), [Form, Results, Chart, Teeth]);
        assert_eq!(seen((240, 70), Form, Chart, true), [Form]);
        assert_eq!(seen((80, 24), Results, Chart, true), [Results]);
        assert_eq!(seen((240, 70), Trade, Chart, true), [Trade]);
    }

    #[test]
    fn at_every_size_the_areas_are_on_the_screen_and_apart() {
        const WIDTHS: [u16; 12] = [0, 59, 60, 61, 80, 119, 120, 140, 199, 200, 240, 261];
        const HEIGHTS: [u16; 13] = [0, 15, 16, 19, 20, 24, 35, 36, 45, 49, 50, 70, 81];
        for (width, height) in
            WIDTHS.iter().flat_map(|width| HEIGHTS.iter().map(move |height| (*width, *height)))
        {
            for focus in Pane::ALL {
                for (lower, is_zoomed) in
                    Pane::LOWER.into_iter().flat_map(|lower| [(lower, false), (lower, true)])
                {
                    let size = Size { width, height };
                    let plan = Layout { size, focus, lower, is_zoomed }.plan();
                    let parts = [plan.header, plan.hint, plan.keys];
                    let areas: Vec<Rect> = plan.panes.into_iter().chain(parts).collect();
                    let used: u32 = areas.iter().map(|area| area.area()).sum();
                    let screen = Rect::new(0, 0, width, height);
                    assert!(
                        areas
                            .iter()
                            .all(|area| area.is_empty() || screen.intersection(*area) == *area)
                    );
                    let apart = |(at, one): (usize, &Rect)| {
                        areas[at + 1..].iter().all(|two| !one.intersects(*two))
                    };
                    assert!(areas.iter().enumerate().all(apart), "{plan:?}");
                    assert!(used == screen.area() || is_too_small(size), "{plan:?}");
                }
            }
        }
    }
}
