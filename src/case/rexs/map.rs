//! The table of attributes that give the fields of a case, and the driver with its speed and load.

use super::model::{Index, Node};
use crate::case::fields::{FIELDS, index_of};
use crate::case::sanitize::{cut, quoted};
use crate::case::units::{self, Dimension};
use crate::numeric::decimal::rounded;
use Place::{EitherGear, Flanks, Gear, Linked, Relief, Stage};

/// A value for a field, as written in the case file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    /// The value with its unit.
    pub(super) text: String,
    /// The value in SI.
    value: f64,
    /// The source, such as `normal_module of cylindrical_gear 23`.
    pub(super) source: String,
}

/// A field with its value, or with the reason why it stays empty.
pub(super) type Found = (&'static str, Result<Reading, String>);

/// The reason why the model gives no value.
struct Unread {
    words: String,
    /// Two readings of the same value differ.
    is_unequal: bool,
}

impl From<String> for Unread {
    fn from(words: String) -> Unread {
        Unread { words, is_unequal: false }
    }
}

type Read<T = Reading> = Result<Option<T>, Unread>;

/// Where an attribute is.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Stage,
    Gear,
    /// The gear with the greater value.
    EitherGear,
    /// Both flanks of the gear, which must agree, or the gear itself.
    Flanks,
    /// The first component of this type that is linked to the gear.
    Linked(&'static str),
    /// The only relief of this type on each flank; a relief of the gear applies to both flanks.
    Relief(&'static str),
}

/// An attribute that gives a value.
#[derive(Clone, Copy)]
struct Source {
    place: Place,
    attribute: &'static str,
    /// The unit in a case, and that of an attribute without a unit.
    unit: &'static str,
    /// Converts the reading for gear 0 or 1 of the pair.
    convert: Option<Convert>,
}

type Convert = fn(&Pair, usize, &Reading) -> Option<Reading>;

const fn from(place: Place, attribute: &'static str, unit: &'static str) -> Source {
    Source { place, attribute, unit, convert: None }
}

impl Source {
    const fn by(self, convert: Convert) -> Source {
        Source { convert: Some(convert), ..self }
    }
}

/// A field and its sources, of which the first one with a value is used.
struct Row {
    /// The key; within its table for a field of each gear. Both gears must agree on other fields.
    field: &'static str,
    sources: &'static [Source],
    need: Need,
}

#[derive(Clone, Copy, PartialEq)]
enum Need {
    Usual,
    /// A stage with unequal values is refused.
    Equal,
    /// Only a relief has the value.
    Relief,
}
use Need::{Equal, Usual};

const fn row(field: &'static str, need: Need, sources: &'static [Source]) -> Row {
    Row { field, sources, need }
}

const TEETH: Source = from(Gear, "number_of_teeth", "");
const MODULE: Source = from(Gear, "normal_module", "mm");
const ANGLE: Source = from(Flanks, "normal_pressure_angle", "deg");
const TIP: Source = from(Gear, "tip_diameter", "mm");
const MATERIAL: Place = Linked("material");
const RACK: Place = Linked("rack_shaped_tool");
const TIP_RELIEF: Place = Relief("tip_relief");
const ROOT_RELIEF: Place = Relief("root_relief");
/// The unit of a text.
const TEXT: &str = "text";

#[rustfmt::skip]
const ROWS: &[Row] = &[
    row("pair.module", Equal, &[MODULE]),
    row("pair.pressure_angle", Equal, &[ANGLE]),
    row("pair.centre_distance", Usual, &[from(Stage, "center_distance", "mm")]),
    row("teeth", Usual, &[TEETH]),
    row("profile_shift", Equal, &[
        from(Flanks, "addendum_modification_coefficient", ""),
        from(Flanks, "addendum_modification", "mm").by(coefficient),
        from(Flanks, "addendum_modification_coefficient_after_finishing", ""),
    ]),
    row("face_width", Usual, &[from(Gear, "face_width", "mm")]),
    row("bore_diameter", Usual, &[from(Gear, "inner_diameter", "mm")]),
    row("young", Usual, &[from(MATERIAL, "elastic_modulus", "MPa")]),
    row("poisson", Usual, &[from(MATERIAL, "poisson_ratio", "")]),
    row("density", Usual, &[from(MATERIAL, "density", "kg/dm3")]),
    row("tip_chamfer", Usual, &[from(Flanks, "tooth_tip_chamfer", "mm")]),
    row("tip_diameter", Usual, &[TIP]),
    row("addendum", Usual, &[from(Flanks, "addendum_coefficient_basic_profile", "")]),
    row("root_diameter", Usual, &[from(Gear, "root_diameter", "mm")]),
    // The addendum of the rack cuts the dedendum of the gear.
    row("dedendum", Usual, &[from(RACK, "addendum_coefficient_reference_profile", "")]),
    row("tip_relief", Usual, &[from(TIP_RELIEF, "tip_relief_depth", "mm")]),
    row("tip_relief_length", Need::Relief, &[
        from(TIP_RELIEF, "tip_relief_datum_length", "mm"),
        from(TIP_RELIEF, "tip_relief_datum_diameter", "mm").by(length_from_diameter),
    ]),
    row("root_relief", Usual, &[from(ROOT_RELIEF, "root_relief_depth", "mm")]),
    row("root_relief_length", Need::Relief, &[
        from(ROOT_RELIEF, "root_relief_datum_length", "mm"),
    ]),
    row("model.relief_shape", Need::Relief, &[
        from(TIP_RELIEF, "shape_of_relief", TEXT),
        from(ROOT_RELIEF, "shape_of_relief", TEXT),
    ]),
    row("deviations.base_pitch", Usual, &[
        from(Stage, "transverse_base_pitch_deviation_iso_6336_2019", "um"),
        from(Stage, "transverse_base_pitch_deviation_iso_6336_2006", "um"),
        from(EitherGear, "base_pitch_deviation_din_3962_1978", "um"),
    ]),
];

const BACKLASHES: [Source; 2] =
    [from(Stage, "minimum_normal_backlash", "mm"), from(Stage, "maximum_normal_backlash", "mm")];
const SPEED: Source = from(Gear, "rotational_speed", "rpm");
const TORQUE_OF_GEAR: Source = from(Gear, "torque", "N m");
const TORQUE_OF_LOAD: Source = from(Gear, "torque_around_u_axis", "N m");
const POWER_OF_LOAD: Source = from(Gear, "power", "kW");
const TORQUE: &str = "operation.torque";
const POWER: &str = "operation.power";

/// The values of a pair, field by field.
#[derive(Debug, Default)]
pub(super) struct Values {
    pub(super) fields: Vec<Found>,
    /// Reasons why the stage cannot become a case.
    pub(super) refusals: Vec<String>,
    /// Assumptions and hints for the reader of the case.
    pub(super) remarks: Vec<String>,
}

impl Values {
    pub(super) fn read(&mut self, pair: &Pair) {
        let pair = &pair.ordered(&mut self.remarks);
        for row in ROWS {
            if row.field.contains('.') {
                self.row(row, row.field, &[0, 1], pair);
            } else {
                self.row(row, &format!("driver.{}", row.field), &[0], pair);
                self.row(row, &format!("driven.{}", row.field), &[1], pair);
            }
        }
        let [least, greatest] = BACKLASHES.map(|source| pair.read(0, source));
        let backlash = least.and_then(|least| agreed(least, greatest?));
        self.put("deviations.backlash", backlash, "the model gives no normal backlash");
        let missing = "neither gear nor its shaft has a rotational_speed";
        self.put("operation.speed", pair.speed(), missing);
        let (key, load) = match pair.load() {
            Ok(Some((key, load))) => (key, Ok(Some(load))),
            Ok(None) => (TORQUE, Ok(None)),
            Err(unread) => (TORQUE, Err(unread)),
        };
        self.put(key, load, "no load is given on a shaft that carries this gear alone");
        self.fields.sort_by_key(|(key, _)| index_of(key));
    }

    /// Writes the field of a row of these gears, unless its alternative has a value.
    fn row(&mut self, row: &Row, key: &str, gears: &[usize], pair: &Pair) {
        let Some(field) = index_of(key).map(|field| &FIELDS[field]) else { return };
        let is_other = |(key, read): &Found| field.alternative == Some(*key) && read.is_ok();
        let has_part = |source: &Source| {
            gears.iter().any(|&gear| !pair.parts(gear, source.place).concat().is_empty())
        };
        let is_needed = row.need != Need::Relief || row.sources.iter().any(has_part);
        if !is_needed || self.fields.iter().any(is_other) {
            return;
        }
        let read = |source: &Source| match gears {
            [gear] => pair.read(*gear, *source),
            _ => pair.shared(*source),
        };
        let mut found = row.sources.iter().map(read);
        match found.find(|read| !matches!(read, Ok(None))).unwrap_or(Ok(None)) {
            Err(unread) if row.need == Equal && unread.is_unequal => {
                self.refusals.push(unread.words);
            }
            found => {
                let mut names: Vec<_> = row.sources.iter().map(|source| source.attribute).collect();
                names.dedup();
                if matches!(found, Ok(Some(_))) {
                    self.fields.retain(|(other, _)| field.alternative != Some(*other));
                }
                self.put(field.key, found, &format!("the model gives no {}", names.join(" or ")));
            }
        }
    }

    fn put(&mut self, key: &'static str, read: Read, missing: &str) {
        let found = read.map_err(|unread| unread.words);
        let found = found.and_then(|reading| reading.ok_or_else(|| missing.to_owned()));
        self.fields.push((key, found));
    }
}

/// A spur stage with its gears; after [`Pair::ordered`] the driver is first.
#[derive(Debug, Clone)]
pub(super) struct Pair<'m> {
    index: &'m Index<'m>,
    stage: &'m Node,
    gears: [&'m Node; 2],
}

const HELIX: [&str; 3] =
    ["helix_angle_reference_diameter", "helix_angle_base_diameter", "helix_angle_base_circle"];

impl<'m> Pair<'m> {
    /// The pair of a spur stage.
    ///
    /// # Errors
    /// The kind of any other stage, with its article.
    pub(super) fn of(index: &'m Index<'m>, stage: &'m Node) -> Result<Pair<'m>, String> {
        match &*stage.kind {
            "cylindrical_stage" => {}
            "planetary_stage" => return Err("a planetary stage".to_owned()),
            other => {
                let name = other.trim_end_matches("_stage").replace('_', " ");
                return Err(format!("a {name} stage"));
            }
        }
        let mut assemblies = index.related("assembly", ("part", &stage.id), "assembly");
        if let Some(planetary) = assemblies.find(|assembly| &*assembly.kind == "planetary_stage") {
            return Err(format!("a mesh of the planetary stage {}", planetary.id));
        }
        let gear = |role| index.related("stage", ("stage", &stage.id), role).next();
        let (Some(first), Some(second)) = (gear("gear_1"), gear("gear_2")) else {
            return Err("a stage without two gears".to_owned());
        };
        let pair = Pair { index, stage, gears: [first, second] };
        if let Some(gear) = pair.gears.iter().find(|gear| &*gear.kind != "cylindrical_gear") {
            return Err(format!("a stage with a {}", gear.kind.replace('_', " ")));
        }
        match pair.gears.iter().find_map(|gear| pair.helix(gear)) {
            Some(angle) => Err(format!("a helical stage (helix angle {angle})")),
            None => Ok(pair),
        }
    }

    /// The helix angle if it is not zero or cannot be read. A model can have a rounded zero.
    fn helix(&self, gear: &Node) -> Option<String> {
        const NONE: f64 = 1e-8;
        HELIX.iter().find_map(|id| match self.value(gear, from(Gear, id, "deg")) {
            Ok(Some(angle)) if angle.value.abs() > NONE => Some(angle.text),
            Ok(_) => None,
            Err(_) => gear.given(id).next().map(|angle| cut(&angle.value)),
        })
    }

    /// The numbers of teeth as text, such as `20/40`.
    pub(super) fn teeth(&self) -> String {
        let teeth = [0, 1].map(|gear| match self.read(gear, TEETH) {
            Ok(Some(teeth)) => teeth.text,
            _ => "unknown".to_owned(),
        });
        teeth.join("/")
    }

    /// The driver and the driven gear. A model may not name the driving gear.
    fn ordered(&self, remarks: &mut Vec<String>) -> Pair<'m> {
        let is_driving = |data: &Node| {
            let driving = data.given("is_driving_gear").next();
            driving.is_some_and(|flag| matches!(&*flag.value, "true" | "1"))
        };
        let [first, second] = self.gears;
        match self.gears.map(|gear| self.gear_data(gear).any(is_driving)) {
            [true, false] => {}
            [false, true] => return Pair { gears: [second, first], ..*self },
            _ => remarks.push(format!(
                "the model does not name the driving gear; the driver is gear_1, {}",
                first.label()
            )),
        }
        self.clone()
    }

    /// The components at a place, of the left and of the right flank.
    fn parts(&self, gear: usize, place: Place) -> [Vec<&'m Node>; 2] {
        let (index, gear) = (self.index, self.gears[gear]);
        let flanks = || {
            ["left", "right"].map(|side| -> Vec<&Node> {
                index.related("flank", ("gear", &gear.id), side).collect()
            })
        };
        match place {
            Stage => [vec![self.stage], Vec::new()],
            Gear => [vec![gear], Vec::new()],
            EitherGear => self.gears.map(|gear| vec![gear]),
            Flanks => flanks(),
            Linked(kind) => [index.linked(&gear.id, kind).collect(), Vec::new()],
            Relief(kind) => flanks().map(|flank| {
                let own: Vec<&Node> =
                    flank.iter().flat_map(|part| index.linked(&part.id, kind)).collect();
                if own.is_empty() { index.linked(&gear.id, kind).collect() } else { own }
            }),
        }
    }

    /// The value of a source for a gear. Both flanks must agree.
    fn read(&self, gear: usize, source: Source) -> Read {
        let sides = self.parts(gear, source.place);
        if let (Relief(_), [left, right]) = (source.place, &sides) {
            if left.is_empty() != right.is_empty() {
                return Err("only one flank has the relief".to_owned().into());
            }
            if let Some(flank) = sides.iter().find(|flank| flank.len() > 1) {
                let first = flank[0].label();
                return Err(format!("{first} is not the only relief of its flank").into());
            }
        }
        let [left, right] = sides.map(|parts| -> Read {
            let mut found = parts.iter().map(|part| self.value(part, source));
            found.find(|read| !matches!(read, Ok(None))).unwrap_or(Ok(None))
        });
        let mut reading = match (left?, right?) {
            (Some(left), Some(right)) if source.place == EitherGear => {
                Some(if right.value > left.value { right } else { left })
            }
            (left, right) => agreed(left, right)?,
        };
        if reading.is_none() && source.place == Flanks {
            reading = self.value(self.gears[gear], source)?;
        }
        Ok(match source.convert {
            Some(convert) => reading.and_then(|reading| convert(self, gear, &reading)),
            None => reading,
        })
    }

    /// A value that both gears must share.
    fn shared(&self, source: Source) -> Read {
        agreed(self.read(0, source)?, self.read(1, source)?)
    }

    /// A value of a component in its load cases, or in general. All must agree.
    fn value(&self, part: &Node, source: Source) -> Read {
        let place = format!("{} of {}", source.attribute, part.label());
        let loads = self.index.loads_of(&part.id).iter().filter_map(|(case, loaded)| {
            let attribute = loaded.given(source.attribute).next()?;
            Some((attribute, format!(" in load case {}", case.id)))
        });
        let mut given: Vec<(&Node, String)> = loads.collect();
        if given.is_empty() {
            given = part.given(source.attribute).map(|own| (own, String::new())).collect();
        }
        let read =
            |(own, case): &(&Node, String)| reading(own, source.unit, format!("{place}{case}"));
        let read = given.iter().map(read).collect::<Result<Vec<Reading>, String>>()?;
        if read.iter().any(|other| other.text != read[0].text) {
            let texts = read.iter().zip(&given);
            let texts: Vec<String> =
                texts.map(|(own, (_, case))| format!("{}{case}", own.text)).collect();
            return Err(format!("{place} is {}", texts.join(", ")).into());
        }
        Ok(read.into_iter().next())
    }

    /// The speed ratio, the teeth of the driven gear over the teeth of the driver.
    fn ratio(&self) -> f64 {
        match [0, 1].map(|gear| self.read(gear, TEETH)) {
            [Ok(Some(driver)), Ok(Some(driven))] => driven.value / driver.value,
            _ => f64::NAN,
        }
    }

    /// The speed of the driver or of its shaft, or the speed of the driven gear times the ratio.
    fn speed(&self) -> Read {
        for (gear, factor) in self.gears.into_iter().zip([1.0, self.ratio()]) {
            for part in std::iter::once(gear).chain(self.shafts(gear)) {
                if let Some(speed) = self.acting(part, SPEED, factor)? {
                    return Ok(Some(speed));
                }
            }
        }
        Ok(None)
    }

    /// The torque or power of the driver, and its field.
    fn load(&self) -> Read<(&'static str, Reading)> {
        let gears = || self.gears.into_iter().zip([1.0, 1.0 / self.ratio()]);
        for (gear, factor) in gears() {
            for data in self.gear_data(gear) {
                if let Some(torque) = self.acting(data, TORQUE_OF_GEAR, factor)? {
                    return Ok(Some((TORQUE, torque)));
                }
            }
        }
        for (gear, factor) in gears() {
            for shaft in self.shafts(gear) {
                if let Some(found) = self.load_on(shaft, factor)? {
                    return Ok(Some(found));
                }
            }
        }
        Ok(None)
    }

    /// The load on a shaft if the shaft has exactly one gear and one load.
    fn load_on(&self, shaft: &Node, factor: f64) -> Read<(&'static str, Reading)> {
        let parts = || self.index.related("assembly", ("assembly", &shaft.id), "part");
        if parts().filter(|part| part.kind.ends_with("gear")).count() != 1 {
            return Ok(None);
        }
        let mut loads = Vec::new();
        for part in parts().filter(|part| &*part.kind == "external_load") {
            if let Some(torque) = self.acting(part, TORQUE_OF_LOAD, factor)? {
                loads.push((TORQUE, torque));
            } else if let Some(power) = self.acting(part, POWER_OF_LOAD, 1.0)? {
                loads.push((POWER, power));
            }
        }
        if loads.len() > 1 {
            return Err(format!("{} has several loads", shaft.label()).into());
        }
        Ok(loads.pop())
    }

    /// A speed or load that is not zero, at the driver.
    fn acting(&self, part: &Node, source: Source, factor: f64) -> Read {
        let acting = self.value(part, source)?.filter(|reading| reading.value != 0.0);
        Ok(acting.map(|reading| reading.transferred(factor, source.unit)))
    }

    /// The data of a gear for this stage only.
    fn gear_data(&self, gear: &'m Node) -> impl Iterator<Item = &'m Node> {
        let relations = self.index.relations_of(&gear.id).iter().filter(|relation| {
            &*relation.kind == "stage_gear_data"
                && relation.role("stage") == Some(&*self.stage.id)
                && relation.role("gear") == Some(&*gear.id)
        });
        relations.filter_map(|relation| self.index.component(relation.role("stage_gear_data")?))
    }

    /// The shafts of a gear: one in a usual model.
    fn shafts(&self, gear: &Node) -> Vec<&'m Node> {
        let assemblies = self.index.related("assembly", ("part", &gear.id), "assembly");
        assemblies.filter(|assembly| &*assembly.kind == "shaft").collect()
    }
}

/// The profile shift coefficient from the shift.
fn coefficient(pair: &Pair, _: usize, shift: &Reading) -> Option<Reading> {
    let module = pair.shared(MODULE).ok()??;
    let own = shift.derived(1.0 / module.value, "", "");
    Some(Reading { source: format!("the module and {}", own.source), ..own })
}

/// The length of a tip relief along the path of contact from its start diameter.
fn length_from_diameter(pair: &Pair, gear: usize, start: &Reading) -> Option<Reading> {
    let value = |read: Read| Some(read.ok()??.value);
    let teeth = value(pair.read(gear, TEETH))?;
    let base = value(pair.shared(MODULE))? * teeth * value(pair.shared(ANGLE))?.cos();
    let tip = value(pair.read(gear, TIP))?;
    let roll = |diameter: f64| (diameter * diameter - base * base).max(0.0).sqrt() / 2.0;
    let value = roll(tip) - roll(start.value);
    let micrometres = (value * 1e9).round() / 1e3;
    Some(Reading {
        text: format!("{} mm", units::text(micrometres / 1e3, "")),
        value,
        source: format!("{} = {}", start.source, start.text),
    })
}

impl Reading {
    /// The reading times a factor, with words after its source.
    fn derived(&self, factor: f64, unit: &str, after: &str) -> Reading {
        let value = self.value * factor;
        let number = rounded(value / units::factor(unit).unwrap_or(1.0));
        Reading {
            text: format!("{} {unit}", units::text(number, "")).trim_end().to_owned(),
            value,
            source: format!("{} = {}{after}", self.source, self.text),
        }
    }

    /// The reading at the driver without its sign, which gives the direction.
    fn transferred(self, factor: f64, unit: &str) -> Reading {
        let text = self.text.trim_start_matches(['-', '+']).to_owned();
        let own = Reading { value: self.value.abs(), ..self };
        if (factor - 1.0).abs() < f64::EPSILON {
            return Reading { text, ..own };
        }
        own.derived(factor, unit, " and the ratio")
    }
}

/// The first of two readings that must agree within the rounding of a printed value. One of them
/// can be missing.
fn agreed(first: Option<Reading>, second: Option<Reading>) -> Read {
    let are_equal = |first: &Reading, second: &Reading| {
        let (a, b) = (first.value, second.value);
        first.text == second.text || (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
    };
    match (first, second) {
        (Some(first), Some(second)) if !are_equal(&first, &second) => Err(Unread {
            words: format!(
                "{} is {}, {} is {}",
                first.source, first.text, second.source, second.text
            ),
            is_unequal: true,
        }),
        (first, second) => Ok(first.or(second)),
    }
}

/// The value of an attribute in the unit of a case file.
fn reading(attribute: &Node, usual: &str, source: String) -> Result<Reading, String> {
    /// Greatest length of a value, in bytes.
    const LONGEST: usize = 100;
    if attribute.value.len() > LONGEST {
        return Err(format!("{source}: {} is too long", quoted(&attribute.value)));
    }
    if usual == TEXT {
        return Ok(Reading { text: attribute.value.to_string(), value: f64::NAN, source });
    }
    let unit = match &*attribute.unit {
        "none" | "" => usual,
        "mum" => "um",
        other => units::symbol(other)
            .ok_or_else(|| format!("{source}: the unit {other:?} is unknown here"))?,
    };
    let number = attribute.value.strip_suffix(".0").unwrap_or(&attribute.value);
    let text = format!("{number} {unit}").trim_end().to_owned();
    let dimension = Dimension::of_unit(usual).unwrap_or(Dimension::Number);
    match units::parse(&text, dimension, usual) {
        Ok(value) => Ok(Reading { text, value, source }),
        Err(error) => Err(format!("{source}: {}", error.cause)),
    }
}
