//! The table of attributes that give the fields of a case, and the driver with its speed and load.

use super::model::{Index, Node};
use crate::case::fields::{self, FIELDS};
use crate::case::sanitize::{cut, quoted};
use crate::case::units::{self, Dimension};

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
struct Problem {
    words: String,
    /// Two readings of the same value differ.
    is_unequal: bool,
}

impl From<String> for Problem {
    fn from(words: String) -> Problem {
        Problem { words, is_unequal: false }
    }
}

type Read = Result<Option<Reading>, Problem>;

/// Where an attribute is.
#[derive(Clone, Copy)]
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

/// One attribute that gives a field.
#[derive(Clone, Copy)]
struct Source {
    /// The key of the field; within its table if both gears have the field.
    field: &'static str,
    place: Place,
    attribute: &'static str,
    /// The unit in a case, and that of an attribute without a unit.
    unit: &'static str,
    /// Converts the reading for gear 0 or 1 of the pair.
    convert: Option<Convert>,
}

/// Converts a reading for gear 0 or 1 of a pair.
type Convert = fn(&Pair, usize, &Reading) -> Option<Reading>;

/// A field and its sources. The first source that gives a value is used.
struct Row {
    sources: &'static [Source],
    /// The reason if no source gives a value, unless its attribute says enough.
    missing: &'static str,
    /// A stage with unequal values is refused.
    is_strict: bool,
    /// A row of the length of a relief is used only if the gear has the relief.
    only_with: Option<Place>,
}

const fn from(
    field: &'static str,
    place: Place,
    attribute: &'static str,
    unit: &'static str,
) -> Source {
    Source { field, place, attribute, unit, convert: None }
}

impl Source {
    const fn by(self, convert: Convert) -> Source {
        Source { convert: Some(convert), ..self }
    }
}

const fn row(sources: &'static [Source], missing: &'static str) -> Row {
    Row { sources, missing, is_strict: false, only_with: None }
}

const fn strict(sources: &'static [Source]) -> Row {
    Row { is_strict: true, ..row(sources, "") }
}

const TEETH: Source = from("teeth", Place::Gear, "number_of_teeth", "");
const MODULE: Source = from("pair.module", Place::Gear, "normal_module", "mm");
const ANGLE: Source = from("pair.pressure_angle", Place::Flanks, "normal_pressure_angle", "deg");
const TIP: Source = from("tip_diameter", Place::Gear, "tip_diameter", "mm");

const PAIR: &[Row] = &[
    strict(&[MODULE]),
    strict(&[ANGLE]),
    row(&[from("pair.centre_distance", Place::Stage, "center_distance", "mm")], ""),
];

const GEAR: &[Row] = &[
    row(&[TEETH], ""),
    strict(&[
        from("profile_shift", Place::Flanks, "addendum_modification_coefficient", ""),
        from("profile_shift", Place::Flanks, "addendum_modification", "mm").by(|pair, _, shift| {
            let module = pair.shared(MODULE).ok()??;
            Some(shift.derived(1.0 / module.value, "", "the module and ", ""))
        }),
        from(
            "profile_shift",
            Place::Flanks,
            "addendum_modification_coefficient_after_finishing",
            "",
        ),
    ]),
    row(&[from("face_width", Place::Gear, "face_width", "mm")], ""),
    row(
        &[from("bore_radius", Place::Gear, "inner_diameter", "mm")
            .by(|_, _, bore| Some(bore.derived(0.5, "mm", "half of ", "")))],
        "",
    ),
    row(
        &[from("young", Place::Linked("material"), "elastic_modulus", "MPa")],
        "no material of the gear has elastic_modulus",
    ),
    row(
        &[from("poisson", Place::Linked("material"), "poisson_ratio", "")],
        "no material of the gear has poisson_ratio",
    ),
    row(
        &[from("density", Place::Linked("material"), "density", "kg/dm3")],
        "no material of the gear has density",
    ),
    row(&[from("tip_chamfer", Place::Flanks, "tooth_tip_chamfer", "mm")], ""),
    row(
        &[TIP, from("addendum", Place::Flanks, "addendum_coefficient_basic_profile", "")],
        "the model gives neither tip_diameter nor the basic profile",
    ),
    // The addendum of the rack cuts the dedendum of the gear.
    row(
        &[
            from("root_diameter", Place::Gear, "root_diameter", "mm"),
            from(
                "dedendum",
                Place::Linked("rack_shaped_tool"),
                "addendum_coefficient_reference_profile",
                "",
            ),
        ],
        "the model gives neither root_diameter nor the rack",
    ),
    row(
        &[from("tip_relief", TIP_RELIEF, "tip_relief_depth", "mm")],
        "the model gives no tip relief",
    ),
    Row {
        only_with: Some(TIP_RELIEF),
        ..row(
            &[
                from("tip_relief_length", TIP_RELIEF, "tip_relief_datum_length", "mm"),
                from("tip_relief_length", TIP_RELIEF, "tip_relief_datum_diameter", "mm")
                    .by(length_from_diameter),
            ],
            "the model gives neither its length nor its start diameter",
        )
    },
    row(
        &[from("root_relief", ROOT_RELIEF, "root_relief_depth", "mm")],
        "the model gives no root relief",
    ),
    Row {
        only_with: Some(ROOT_RELIEF),
        ..row(
            &[from("root_relief_length", ROOT_RELIEF, "root_relief_datum_length", "mm")],
            "the model gives no length",
        )
    },
];

const TIP_RELIEF: Place = Place::Relief("tip_relief");
const ROOT_RELIEF: Place = Place::Relief("root_relief");

const BASE_PITCH: &str = "deviations.base_pitch";
const BASE_PITCHES: Row = row(
    &[
        from(BASE_PITCH, Place::Stage, "transverse_base_pitch_deviation_iso_6336_2019", "um"),
        from(BASE_PITCH, Place::Stage, "transverse_base_pitch_deviation_iso_6336_2006", "um"),
        from(BASE_PITCH, Place::EitherGear, "base_pitch_deviation_din_3962_1978", "um"),
    ],
    "the model gives no base pitch deviation",
);

const BACKLASH_KEY: &str = "deviations.backlash";
const BACKLASHES: [Source; 2] = [
    from(BACKLASH_KEY, Place::Stage, "minimum_normal_backlash", "mm"),
    from(BACKLASH_KEY, Place::Stage, "maximum_normal_backlash", "mm"),
];

const SPEED: Source = from("operation.speed", Place::Gear, "rotational_speed", "rpm");
const TORQUE_OF_GEAR: Source = from("operation.torque", Place::Gear, "torque", "N m");
const TORQUE: Source = from("operation.torque", Place::Gear, "torque_around_u_axis", "N m");
const POWER: Source = from("operation.power", Place::Gear, "power", "kW");

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
        for row in PAIR {
            self.row(row, |source| (source.field, pair.shared(source)));
        }
        for (gear, table) in ["driver", "driven"].into_iter().enumerate() {
            for row in GEAR {
                if row.only_with.is_none_or(|place| !pair.parts(gear, place).concat().is_empty()) {
                    self.row(row, |source| {
                        let field = fields::index_of(&format!("{table}.{}", source.field));
                        let key = field.map_or(source.field, |field| FIELDS[field].key);
                        (key, pair.read(gear, source))
                    });
                }
            }
            self.relief_shape(pair, gear);
        }
        self.row(&BASE_PITCHES, |source| (source.field, pair.read(0, source)));
        let [least, greatest] = BACKLASHES.map(|source| pair.read(0, source));
        let backlash = least.and_then(|least| agreed(least, greatest?));
        self.put(BACKLASH_KEY, backlash, "the model gives no normal backlash");
        let missing = "neither gear nor its shaft has a rotational_speed";
        self.put(SPEED.field, pair.speed(), missing);
        let load = pair.load();
        let key = load.as_ref().ok().and_then(Option::as_ref).map_or(TORQUE.field, |(key, _)| key);
        let load = load.map(|load| load.map(|(_, reading)| reading));
        self.put(key, load, "no load is given on a shaft that carries this gear alone");
    }

    /// Writes the field of a row from the first source that gives a value or a problem.
    fn row(&mut self, row: &Row, read: impl Fn(Source) -> (&'static str, Read)) {
        let mut found = row.sources.iter().map(|source| read(*source));
        let mut last = None;
        while !matches!(last, Some((_, Ok(Some(_)) | Err(_)))) {
            match found.next() {
                None => break,
                next => last = next,
            }
        }
        match (last, row.sources) {
            (Some((_, Err(problem))), _) if row.is_strict && problem.is_unequal => {
                self.refusals.push(problem.words);
            }
            (Some((key, read)), [first, ..]) if row.missing.is_empty() => {
                self.put(key, read, &format!("the model gives no {}", first.attribute));
            }
            (Some((key, read)), _) => self.put(key, read, row.missing),
            (None, _) => {}
        }
    }

    fn put(&mut self, key: &'static str, read: Read, missing: &str) {
        let found = read.map_err(|problem| problem.words);
        let found = found.and_then(|reading| reading.ok_or_else(|| missing.to_owned()));
        self.fields.push((key, found));
    }

    /// The shape of the first relief that gives it.
    fn relief_shape(&mut self, pair: &Pair, gear: usize) {
        const KEY: &str = "model.relief_shape";
        for relief in
            [TIP_RELIEF, ROOT_RELIEF].map(|place| pair.parts(gear, place).concat()).concat()
        {
            let is_read = self.fields.iter().any(|(known, _)| *known == KEY);
            if let Some(shape) = relief.given("shape_of_relief").next().filter(|_| !is_read) {
                let source = format!("shape_of_relief of {}", relief.label());
                let text = shape.value.to_string();
                let found = match &*text {
                    "linear" | "parabolic" => Ok(Reading { text, value: f64::NAN, source }),
                    other => Err(format!(
                        "{source} is {}; a case has linear or parabolic",
                        quoted(other)
                    )),
                };
                self.fields.push((KEY, found));
            }
        }
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
        if pair.gears.iter().any(|gear| &*gear.kind == "ring_gear") {
            return Err("a stage with a ring gear".to_owned());
        }
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
        HELIX.iter().find_map(|id| match self.value(gear, from("", Place::Gear, id, "deg")) {
            Ok(Some(angle)) if angle.value.abs() > NONE => Some(angle.text),
            Ok(_) => None,
            Err(_) => gear.given(id).next().map(|angle| cut(&angle.value)),
        })
    }

    /// The numbers of teeth as text, such as `20/40`.
    pub(super) fn teeth(&self) -> String {
        [0, 1]
            .map(|gear| match self.read(gear, TEETH) {
                Ok(Some(teeth)) => teeth.text,
                _ => "unknown".to_owned(),
            })
            .join("/")
    }

    /// The driver and the driven gear. A model may not name the driving gear.
    fn ordered(&self, remarks: &mut Vec<String>) -> Pair<'m> {
        let drives = self.gears.map(|gear| {
            self.gear_data(gear).any(|data| {
                let driving = data.given("is_driving_gear").next();
                driving.is_some_and(|flag| matches!(&*flag.value, "true" | "1"))
            })
        });
        let [first, second] = self.gears;
        match drives {
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
            Place::Stage => [vec![self.stage], Vec::new()],
            Place::Gear => [vec![gear], Vec::new()],
            Place::EitherGear => self.gears.map(|gear| vec![gear]),
            Place::Flanks => flanks(),
            Place::Linked(kind) => [index.linked(&gear.id, kind).collect(), Vec::new()],
            Place::Relief(kind) => flanks().map(|flank| {
                let own: Vec<&Node> =
                    flank.iter().flat_map(|part| index.linked(&part.id, kind)).collect();
                if own.is_empty() { index.linked(&gear.id, kind).collect() } else { own }
            }),
        }
    }

    /// The value of a source for a gear. Both flanks must agree.
    fn read(&self, gear: usize, source: Source) -> Read {
        let sides = self.parts(gear, source.place);
        if let (Place::Relief(_), [left, right]) = (source.place, &sides) {
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
            (Some(left), Some(right)) if matches!(source.place, Place::EitherGear) => {
                Some(if right.value > left.value { right } else { left })
            }
            (left, right) => agreed(left, right)?,
        };
        if reading.is_none() && matches!(source.place, Place::Flanks) {
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

    /// A value of a component or of its load cases, which must agree.
    fn value(&self, part: &Node, source: Source) -> Read {
        let (label, id) = (part.label(), source.attribute);
        let mut cases: Vec<(&str, Reading)> = Vec::new();
        for (case, loaded) in self.index.loads_of(&part.id) {
            if let Some(attribute) = loaded.given(id).next() {
                let place = format!("{id} of {label} in load case {}", case.id);
                cases.push((&case.id, reading(attribute, source.unit, place)?));
            }
        }
        if let Some((_, first)) = cases.first() {
            if cases.iter().all(|(_, other)| other.text == first.text) {
                return Ok(Some(first.clone()));
            }
            let texts =
                cases.iter().map(|(case, reading)| format!("{} in load case {case}", reading.text));
            let texts: Vec<String> = texts.collect();
            return Err(format!("{id} of {label} is {}", texts.join(", ")).into());
        }
        let mut given = part.given(id);
        let Some(first) = given.next() else { return Ok(None) };
        if let Some(other) = given.find(|other| *other != first) {
            return Err(format!(
                "{label} has two values of {id}, {} and {}",
                quoted(&first.value),
                quoted(&other.value),
            )
            .into());
        }
        reading(first, source.unit, format!("{id} of {label}")).map(Some).map_err(Problem::from)
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
            for part in std::iter::once(gear).chain(self.shafts(gear)?) {
                if let Some(reading) = self.value(part, SPEED)? {
                    return Ok(Some(reading.transferred(factor, SPEED.unit)));
                }
            }
        }
        Ok(None)
    }

    /// The torque or power of the driver, and its field.
    fn load(&self) -> Result<Option<(&'static str, Reading)>, Problem> {
        let factors = [1.0, 1.0 / self.ratio()];
        for (gear, factor) in self.gears.into_iter().zip(factors) {
            for data in self.gear_data(gear) {
                if let Some(torque) = self.acting(data, TORQUE_OF_GEAR, factor)? {
                    return Ok(Some(torque));
                }
            }
        }
        for (gear, factor) in self.gears.into_iter().zip(factors) {
            for shaft in self.shafts(gear)? {
                if let Some(found) = self.load_on(shaft, factor)? {
                    return Ok(Some(found));
                }
            }
        }
        Ok(None)
    }

    /// The load on a shaft if the shaft has exactly one gear and one load.
    fn load_on(
        &self,
        shaft: &Node,
        factor: f64,
    ) -> Result<Option<(&'static str, Reading)>, Problem> {
        let parts = || self.index.related("assembly", ("assembly", &shaft.id), "part");
        if parts().filter(|part| part.kind.ends_with("gear")).count() != 1 {
            return Ok(None);
        }
        let mut loads = Vec::new();
        for part in parts().filter(|part| &*part.kind == "external_load") {
            match self.acting(part, TORQUE, factor)? {
                None => loads.extend(self.acting(part, POWER, 1.0)?),
                torque => loads.extend(torque),
            }
        }
        if loads.len() > 1 {
            return Err(format!("{} has several loads", shaft.label()).into());
        }
        Ok(loads.pop())
    }

    /// A load that is not zero, at the driver.
    fn acting(
        &self,
        part: &Node,
        source: Source,
        factor: f64,
    ) -> Result<Option<(&'static str, Reading)>, Problem> {
        let load = self.value(part, source)?.filter(|load| load.value != 0.0);
        Ok(load.map(|load| (source.field, load.transferred(factor, source.unit))))
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
    fn shafts(&self, gear: &Node) -> Result<Vec<&'m Node>, Problem> {
        const MOST: usize = 10;
        let assemblies = self.index.related("assembly", ("part", &gear.id), "assembly");
        let shafts = assemblies.filter(|assembly| &*assembly.kind == "shaft");
        let shafts: Vec<&Node> = shafts.take(MOST + 1).collect();
        if shafts.len() > MOST {
            return Err(format!("{} is on more than {MOST} shafts", gear.label()).into());
        }
        Ok(shafts)
    }
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
    /// The reading times a factor, with words around its source.
    fn derived(&self, factor: f64, unit: &str, before: &str, after: &str) -> Reading {
        let value = self.value * factor;
        Reading {
            text: units::text(value, unit),
            value,
            source: format!("{before}{} = {}{after}", self.source, self.text),
        }
    }

    /// The reading at the driver without its sign, which gives the direction.
    fn transferred(self, factor: f64, unit: &str) -> Reading {
        let text = self.text.trim_start_matches(['-', '+']).to_owned();
        let own = Reading { value: self.value.abs(), ..self };
        if (factor - 1.0).abs() < f64::EPSILON {
            return Reading { text, ..own };
        }
        own.derived(factor, unit, "", " and the ratio")
    }
}

/// The first of two readings that must agree within the rounding of a printed value. One of them
/// can be missing.
fn agreed(first: Option<Reading>, second: Option<Reading>) -> Read {
    let are_equal = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
    match (first, second) {
        (Some(first), Some(second)) if !are_equal(first.value, second.value) => Err(Problem {
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
    /// Greatest length of a number, in bytes.
    const MOST_DIGITS: usize = 100;
    let unit = match &*attribute.unit {
        "none" | "" => usual,
        "mum" | "µm" | "μm" => "um",
        "°" => "deg",
        "N / mm^2" => "MPa",
        "kg / dm^3" => "kg/dm3",
        "1 / min" => "rpm",
        "rad / s" => "rad/s",
        known if units::factor(known).is_some() => known,
        unknown => return Err(format!("{source}: the unit {unknown:?} is unknown here")),
    };
    let number = attribute.value.strip_suffix(".0").unwrap_or(&attribute.value);
    if number.len() > MOST_DIGITS {
        return Err(format!("{source}: {} is too long for a number", quoted(number)));
    }
    let text = format!("{number} {unit}").trim_end().to_owned();
    let dimension = Dimension::of_unit(usual).unwrap_or(Dimension::Number);
    match units::parse(&text, dimension, usual) {
        Ok(value) => Ok(Reading { text, value, source }),
        Err(error) => Err(format!("{source}: {}", error.cause)),
    }
}
