//! The table of attributes that give the fields of a case, and the driver with its speed and load.

use std::collections::BTreeSet;

use super::{Index, Node};
use crate::case::fields::{FIELDS, index_of};
use crate::case::sanitize::quoted;
use crate::case::units::{self, Dimension};
use crate::numeric::decimal::rounded;

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

/// An attribute that gives a value: of the stage, of the gear, of its flanks, or of the material, the
/// tools and the modifications of one of them.
#[derive(Clone, Copy)]
struct Source {
    /// The name, after the type of its component where the name repeats.
    attribute: &'static str,
    /// Another attribute that must agree, or empty.
    also: &'static str,
    /// The unit in a case, and that of an attribute without a unit.
    unit: &'static str,
    /// Converts the reading for gear 0 or 1 of the pair.
    convert: Option<Convert>,
}

type Convert = fn(&Pair, usize, &Reading) -> Option<Reading>;

const fn from(attribute: &'static str, unit: &'static str) -> Source {
    both(attribute, "", unit)
}

const fn both(attribute: &'static str, also: &'static str, unit: &'static str) -> Source {
    Source { attribute, also, unit, convert: None }
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

#[derive(Clone, Copy)]
enum Need {
    Usual,
    /// A stage with unequal values is refused.
    Equal,
    /// Like `Equal`; a spur stage has no value.
    Helix,
    /// Only some gears have the value.
    Optional,
    /// Only gears with a value in a field of this beginning have the value.
    After(&'static str),
}
use Need::{After, Equal, Helix, Optional, Usual};

const fn row(field: &'static str, need: Need, sources: &'static [Source]) -> Row {
    Row { field, sources, need }
}

/// Components that describe a gear or a flank.
const PARTS: [&str; 8] = [
    "material",
    "rack_shaped_tool",
    "tip_relief",
    "root_relief",
    "helix_slope",
    "helix_crowning",
    "end_relief_datum_face",
    "end_relief_non_datum_face",
];
/// Modifications and deviations without a field.
const UNUSED: [&str; 6] = [
    "profile_crowning",
    "profile_deviation",
    "helix_deviation",
    "topographical_modification",
    "triangular_tip_relief",
    "triangular_root_relief",
];

const TEETH: Source = from("number_of_teeth", "");
const MODULE: Source = from("normal_module", "mm");
const ANGLE: Source = from("normal_pressure_angle", "deg");
const TIP: Source = from("tip_diameter", "mm");
const HELIX: [Source; 3] = [
    from("helix_angle_reference_diameter", "deg").by(magnitude),
    from("helix_angle_base_diameter", "deg").by(at_reference_diameter),
    from("helix_angle_base_circle", "deg").by(at_reference_diameter),
];
const BASE_PITCH: Source = from("base_pitch_deviation_din_3962_1978", "um");
/// The unit of a text.
const TEXT: &str = "text";

#[rustfmt::skip]
const ROWS: &[Row] = &[
    row("pair.module", Equal, &[MODULE]),
    row("pair.pressure_angle", Equal, &[ANGLE]),
    row("pair.helix_angle", Helix, &HELIX),
    row("pair.driver_hand", Helix, &[HELIX[0].by(hand), HELIX[1].by(hand), HELIX[2].by(hand)]),
    row("pair.centre_distance", Usual, &[from("center_distance", "mm")]),
    row("teeth", Usual, &[TEETH]),
    row("profile_shift", Equal, &[
        from("addendum_modification_coefficient", ""),
        from("addendum_modification", "mm").by(coefficient),
        from("addendum_modification_coefficient_after_finishing", ""),
    ]),
    row("face_width", Usual, &[from("face_width", "mm")]),
    row("bore_diameter", Usual, &[from("inner_diameter", "mm")]),
    row("young", Usual, &[from("elastic_modulus", "MPa")]),
    row("poisson", Usual, &[from("poisson_ratio", "")]),
    row("density", Usual, &[from("density", "kg/dm3")]),
    row("tip_chamfer", Usual, &[from("tooth_tip_chamfer", "mm")]),
    row("tip_diameter", Usual, &[TIP]),
    row("addendum", Usual, &[from("addendum_coefficient_basic_profile", "")]),
    row("root_diameter", Usual, &[from("root_diameter", "mm")]),
    // The addendum of the rack cuts the dedendum of the gear.
    row("dedendum", Usual, &[from("addendum_coefficient_reference_profile", "")]),
    row("tip_relief", Usual, &[from("tip_relief_depth", "mm")]),
    row("tip_relief_length", After("tip_relief"), &[
        from("tip_relief_datum_length", "mm"),
        from("tip_relief_datum_diameter", "mm").by(length_from_diameter),
    ]),
    row("root_relief", Usual, &[from("root_relief_depth", "mm")]),
    row("root_relief_length", After("root_relief"), &[from("root_relief_datum_length", "mm")]),
    row("model.relief_shape", Optional, &[
        from("tip_relief.shape_of_relief", TEXT),
        from("root_relief.shape_of_relief", TEXT),
    ]),
    row("helix_slope", Optional, &[from("helix_slope", "mm")]),
    row("crowning", Optional, &[both(
        "helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face", "mm",
    )]),
    row("end_relief_minus", Optional, &[from("end_relief_depth_datum_face", "mm")]),
    row("end_relief_plus", Optional, &[from("end_relief_depth_non_datum_face", "mm")]),
    row("end_relief_length", After("end_relief"), &[both(
        "end_relief_length_datum_face", "end_relief_length_non_datum_face", "mm",
    )]),
    row("deviations.base_pitch", Usual, &[
        from("transverse_base_pitch_deviation_iso_6336_2019", "um"),
        from("transverse_base_pitch_deviation_iso_6336_2006", "um"),
        BASE_PITCH.by(greater),
    ]),
    row("deviations.backlash", Usual, &[both(
        "minimum_normal_backlash", "maximum_normal_backlash", "mm",
    )]),
];

/// The attributes of the position of a gear.
const PLACE: [&str; 4] = [
    "support_vector",
    "u_axis_vector",
    "reference_component_for_position",
    "datum_face_orientation",
];
const SPEED: Source = from("rotational_speed", "rpm");
const TORQUE_OF_GEAR: Source = from("torque", "N m");
const TORQUE_OF_LOAD: Source = from("torque_around_u_axis", "N m");
const POWER_OF_LOAD: Source = from("power", "kW");
/// Greatest helix angle of a case, in rad.
const MOST_HELIX: f64 = std::f64::consts::FRAC_PI_4;
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
        let mut pair = pair.ordered(&mut self.remarks);
        let speed = pair.speed();
        pair.is_negative = matches!(&speed, Ok(Some(speed)) if speed.value < 0.0);
        let pair = &pair;
        for row in ROWS {
            if row.field.contains('.') {
                self.row(row, row.field, &[0, 1], pair);
                continue;
            }
            for (gear, table) in ["driver", "driven"].into_iter().enumerate() {
                let name = pair.named_by_side(gear, row.field);
                self.row(row, &format!("{table}.{name}"), &[gear], pair);
            }
        }
        let angle = self.fields.iter().find(|(key, _)| *key == "pair.helix_angle");
        if let Some((_, Ok(angle))) = angle
            && angle.value > MOST_HELIX
        {
            let Reading { source, text, .. } = angle;
            self.refusals.push(format!("{source} is {text}, more than 45 deg"));
        }
        if let Some(offset) = pair.offset() {
            self.fields.push(("pair.face_offset", Ok(offset)));
        }
        let missing = "neither gear nor a connected shaft has a rotational_speed";
        self.put("operation.speed", speed, missing);
        let (key, load) = match pair.load() {
            Ok(Some((key, load))) => (key, Ok(Some(load))),
            other => (TORQUE, other.map(|_| None)),
        };
        self.put(key, load, "no load is given on a shaft at the end of the gear train");
        self.fields.sort_by_key(|(key, _)| index_of(key));
        self.remarks.extend(pair.of_sun().map(|(.., remark)| remark));
        let unused: Vec<String> = pair.unused().iter().map(|part| part.label()).collect();
        if !unused.is_empty() {
            self.remarks.push(format!("left out: {}", unused.join(", ")));
        }
        let unread = pair.unread();
        if !unread.is_empty() {
            self.remarks
                .push(format!("attributes without a field: {}", Vec::from_iter(unread).join(", ")));
        }
    }

    /// Writes the field of a row of these gears, unless its alternative has a value.
    fn row(&mut self, row: &Row, key: &str, gears: &[usize], pair: &Pair) {
        let Some(field) = index_of(key).map(|field| &FIELDS[field]) else { return };
        let is_other = |(key, read): &Found| field.alternative == Some(*key) && read.is_ok();
        if self.fields.iter().any(is_other) {
            return;
        }
        let is_silent = match row.need {
            Usual | Equal => false,
            Helix | Optional => true,
            After(part) => {
                let start = format!("{}.{part}", field.table());
                !self.fields.iter().any(|(other, read)| other.starts_with(&start) && read.is_ok())
            }
        };
        match (pair.find(gears, row.sources), row.need) {
            (Err(unread), Equal) if unread.is_unequal => self.refusals.push(unread.words),
            (Err(unread), Helix) => self.refusals.push(unread.words),
            (Ok(None), _) if is_silent => {}
            (found, _) => {
                let names: Vec<_> = row.sources.iter().map(|source| source.attribute).collect();
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

/// A stage of two external cylindrical gears; after [`Pair::ordered`] the driver is first.
#[derive(Debug, Clone)]
pub(super) struct Pair<'m> {
    index: &'m Index<'m>,
    stage: &'m Node,
    gears: [&'m Node; 2],
    /// The planetary stage of the mesh.
    planetary: Option<&'m Node>,
    /// Whether the driver turns negatively about its axis, so that z of the case is opposite to it.
    is_negative: bool,
}

/// A gear that turns with the pair.
#[derive(Clone, Copy)]
struct Turning<'m> {
    gear: &'m Node,
    /// The speed of the driver over that of the gear, below 0 in the opposite direction.
    speed: f64,
    /// The torque of the driver over that of the gear, if the whole load of the pair passes the gear.
    torque: Option<f64>,
}

/// The kind of a load on a shaft.
const LOAD: &str = "external_load";

impl<'m> Pair<'m> {
    /// The pair of a stage.
    ///
    /// # Errors
    /// The kind of a stage that cannot become a case, with its article.
    pub(super) fn of(index: &'m Index<'m>, stage: &'m Node) -> Result<Pair<'m>, String> {
        if &*stage.kind != "cylindrical_stage" {
            let name = stage.kind.trim_end_matches("_stage").replace('_', " ");
            return Err(format!("a {name} stage"));
        }
        let gear = |role| index.related("stage", ("stage", &stage.id), role).next();
        let (Some(first), Some(second)) = (gear("gear_1"), gear("gear_2")) else {
            return Err("a stage without two gears".to_owned());
        };
        let gears = [first, second];
        if let Some(gear) = gears.iter().find(|gear| &*gear.kind != "cylindrical_gear") {
            return Err(format!("a stage with a {}", gear.kind.replace('_', " ")));
        }
        let mut assemblies = index.related("assembly", ("part", &stage.id), "assembly");
        let planetary = assemblies.find(|assembly| &*assembly.kind == "planetary_stage");
        Ok(Pair { index, stage, gears, planetary, is_negative: false })
    }

    /// The kind of the stage with its article, such as `a helical stage (20/40 teeth, 15 deg)`.
    pub(super) fn kind(&self) -> String {
        let teeth = [0, 1].map(|gear| match self.read(gear, TEETH) {
            Ok(Some(teeth)) => teeth.text,
            _ => "unknown".to_owned(),
        });
        let teeth = teeth.join("/");
        let of = self.planetary.map_or(String::new(), |own| format!(" of {} {}", own.kind, own.id));
        match self.find(&[0, 1], &HELIX) {
            Ok(Some(helix)) if helix.value != 0.0 => {
                format!("a helical stage{of} ({teeth} teeth, {})", helix.text)
            }
            Err(_) => format!("a helical stage{of} ({teeth} teeth)"),
            Ok(_) => format!("a spur stage{of} ({teeth} teeth)"),
        }
    }

    /// The driver and the driven gear. A model may not name the driving gear. The sun gear drives
    /// its planets.
    fn ordered(&self, remarks: &mut Vec<String>) -> Pair<'m> {
        let is_driving = |data: &Node| {
            let driving = data.given("is_driving_gear").next();
            driving.is_some_and(|flag| matches!(&*flag.value, "true" | "1"))
        };
        let [first, second] = self.gears;
        let swapped = Pair { gears: [second, first], ..self.clone() };
        if self.planetary.is_some() {
            let is_planet = self.ring(first).is_some();
            return if is_planet { swapped } else { self.clone() };
        }
        match self.gears.map(|gear| self.gear_data(gear).any(is_driving)) {
            [true, false] => {}
            [false, true] => return swapped,
            _ => remarks.push(format!(
                "the model does not name the driving gear; the driver is gear_1, {}",
                first.label()
            )),
        }
        self.clone()
    }

    /// The left and the right flank of a gear.
    fn flanks(&self, gear: usize) -> [Option<&'m Node>; 2] {
        let gear = ("gear", &*self.gears[gear].id);
        ["left", "right"].map(|side| self.index.related("flank", gear, side).next())
    }

    /// Both gears and their flanks.
    fn bodies(&self) -> impl Iterator<Item = &'m Node> {
        [0, 1].into_iter().flat_map(|gear| {
            let [left, right] = self.flanks(gear);
            [Some(self.gears[gear]), left, right].into_iter().flatten()
        })
    }

    /// The attributes of the stage, of gears and flanks and of the components that describe them that
    /// give no field, in alphabetical order.
    fn unread(&self) -> BTreeSet<&'m str> {
        let linked = self.bodies().flat_map(|part| self.index.linked(&part.id));
        let parts = linked.filter(|part| PARTS.contains(&&*part.kind));
        let parts = parts.chain(self.bodies()).chain([self.stage]);
        let sources = ROWS.iter().flat_map(|row| row.sources).chain([&SPEED]);
        let read: Vec<&str> = sources
            .flat_map(|source| [source.attribute, source.also])
            .map(|name| name.rsplit('.').next().unwrap_or(name))
            .chain(PLACE)
            .collect();
        let given = parts.flat_map(|part| &part.nodes).filter(|own| !own.value.is_empty());
        given.map(|own| &*own.id).filter(|id| !read.contains(id)).collect()
    }

    /// Modifications without a field.
    fn unused(&self) -> Vec<&'m Node> {
        let linked = self.bodies().flat_map(|part| self.index.linked(&part.id));
        let mut unused: Vec<&Node> = linked.filter(|part| UNUSED.contains(&&*part.kind)).collect();
        unused.dedup_by(|one, other| std::ptr::eq(*one, *other));
        unused
    }

    /// The value of the first source that has one, for one gear or equal for both.
    fn find(&self, gears: &[usize], sources: &[Source]) -> Read {
        let read = |source: &Source| match gears {
            [gear] => self.read(*gear, *source),
            _ => agreed(self.read(0, *source)?, self.read(1, *source)?),
        };
        let mut found = sources.iter().map(read);
        found.find(|read| !matches!(read, Ok(None))).unwrap_or(Ok(None))
    }

    /// The number from these sources, in SI, if it can be read.
    fn number(&self, gears: &[usize], sources: &[Source]) -> Option<f64> {
        self.find(gears, sources).ok()?.map(|reading| reading.value)
    }

    /// The value of a source for a gear: of both flanks, which must agree, or else of the gear and the
    /// stage.
    fn read(&self, gear: usize, source: Source) -> Read {
        let [left, right] = self.flanks(gear).map(|flank| match flank {
            Some(flank) => self.described(flank, source),
            None => Ok(None),
        });
        let reading = match (left?, right?) {
            (Some(left), Some(right)) => agreed(Some(left), Some(right))?,
            (left, right) => {
                let whole = self.described(self.gears[gear], source)?;
                let whole = agreed(whole, self.value(self.stage, source)?)?;
                match (left.or(right), whole) {
                    (Some(one), None) => {
                        let Reading { source, text, .. } = one;
                        return Err(format!("only one flank has it: {source} is {text}").into());
                    }
                    (one, whole) => agreed(one, whole)?,
                }
            }
        };
        let reading = if source.also.is_empty() {
            reading
        } else {
            let also = Source { attribute: source.also, also: "", ..source };
            agreed(reading, self.read(gear, also)?)?
        };
        Ok(match source.convert {
            Some(convert) => reading.and_then(|reading| convert(self, gear, &reading)),
            None => reading,
        })
    }

    /// The value of a gear or a flank and of the components that describe it, which must agree.
    fn described(&self, part: &'m Node, source: Source) -> Read {
        let linked = self.index.linked(&part.id).filter(|part| PARTS.contains(&&*part.kind));
        let mut parts = std::iter::once(part).chain(linked);
        parts.try_fold(None, |found, part| agreed(found, self.value(part, source)?))
    }

    /// A value of a component in its load cases, or in general. All must agree.
    fn value(&self, part: &Node, source: Source) -> Read {
        let (kind, attribute) = source.attribute.split_once('.').unwrap_or(("", source.attribute));
        if !kind.is_empty() && *part.kind != *kind {
            return Ok(None);
        }
        let place = format!("{attribute} of {}", part.label());
        let loads = self.index.loads_of(&part.id).iter().filter_map(|(case, loaded)| {
            let attribute = loaded.given(attribute).next()?;
            Some((attribute, format!(" in load case {}", case.id)))
        });
        let mut given: Vec<(&Node, String)> = loads.collect();
        if given.is_empty() {
            given = part.given(attribute).map(|own| (own, String::new())).collect();
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

    /// The name of a field by the side of its end of the face. The datum face of a gear is at the
    /// negative end of its axis unless the model has another orientation.
    fn named_by_side(&self, gear: usize, field: &'static str) -> &'static str {
        let mut orientation = self.gears[gear].given("datum_face_orientation");
        let is_positive = orientation.next().is_some_and(|own| &*own.value == "positive");
        match field {
            "end_relief_minus" if is_positive != self.is_negative => "end_relief_plus",
            "end_relief_plus" if is_positive != self.is_negative => "end_relief_minus",
            _ => field,
        }
    }

    /// The middle of the driven face less that of the driver, along z. The support vector of a gear
    /// leads to the middle of its face.
    fn offset(&self) -> Option<Reading> {
        let vector = |gear: usize, id| -> Option<[f64; 3]> {
            let text = &self.gears[gear].given(id).next()?.value;
            let numbers = text.split_whitespace().map(|number| number.parse().ok());
            numbers.collect::<Option<Vec<f64>>>()?.try_into().ok()
        };
        let reference = |gear: &Node| {
            gear.given("reference_component_for_position").next().map(|own| own.value.clone())
        };
        let [first, second] = self.gears.map(reference);
        if first != second {
            return None;
        }
        let middle = |gear| vector(gear, "support_vector");
        let (first, second, axis) = (middle(0)?, middle(1)?, vector(0, "u_axis_vector")?);
        let along: f64 = (0..3).map(|at| (second[at] - first[at]) * axis[at]).sum();
        let along = rounded(if self.is_negative { -along } else { along });
        (along.abs() > 1e-6).then(|| Reading {
            text: format!("{} mm", units::text(along, "")),
            value: along / 1e3,
            source: "the support_vector of both gears".to_owned(),
        })
    }

    /// The speed relative to the carrier over the speed, and the torque of one mesh over the torque,
    /// of a sun gear with planets, in words. `None` for any other stage.
    fn of_sun(&self) -> Option<(f64, f64, String)> {
        self.planetary?;
        let [sun, planet] = self.gears;
        let ring = self.ring(planet)?;
        let teeth = self.value(ring, TEETH).ok()??.value.abs();
        let is_loaded =
            self.shafts(ring).iter().any(|shaft| self.parts_on(shaft, LOAD).next().is_some());
        let (still, relative) = if is_loaded {
            ("the carrier", 1.0)
        } else {
            ("the ring gear", teeth / (teeth + self.number(&[0], &[TEETH])?))
        };
        let count = self.mates(sun).count();
        let remark = format!(
            "the speed is relative to the planet carrier while {still} stands still; {count} planets \
             share the load equally"
        );
        Some((relative, 1.0 / count as f64, remark))
    }

    /// The ring gear that a planet meshes with.
    fn ring(&self, planet: &Node) -> Option<&'m Node> {
        self.index.linked(&planet.id).find(|part| &*part.kind == "ring_gear")
    }

    /// The gears that mesh with a gear.
    fn mates(&self, gear: &'m Node) -> impl Iterator<Item = &'m Node> {
        let stages = self.index.relations_of(&gear.id).iter();
        let stages = stages.filter(|relation| &*relation.kind == "stage");
        let ids = stages.flat_map(|stage| [stage.role("gear_1"), stage.role("gear_2")]);
        let others = ids.flatten().filter(move |id| **id != *gear.id);
        others.filter_map(|id| self.index.component(id))
    }

    /// The gears that turn with the pair, from near to far.
    fn train(&self) -> Vec<Turning<'m>> {
        /// A longer train is no gear unit.
        const MOST: usize = 100;
        let ratio = |one: &Node, two: &Node| {
            let teeth = |gear| Some(self.value(gear, TEETH).ok()??.value);
            Some(teeth(two)? / teeth(one)?)
        };
        let [driver, driven] = self.gears;
        let (speed, torque, _) = self.of_sun().unwrap_or((1.0, 1.0, String::new()));
        let mut train = vec![Turning { gear: driver, speed, torque: Some(torque) }];
        if self.planetary.is_some() {
            return train;
        }
        train.extend(ratio(driver, driven).map(|ratio| Turning {
            gear: driven,
            speed: -ratio,
            torque: Some(-1.0 / ratio),
        }));
        let mut at = 0;
        while let Some(&Turning { gear, speed, torque }) = train.get(at) {
            at += 1;
            for shaft in self.shafts(gear) {
                let gears: Vec<&Node> = self.parts_on(shaft, "gear").collect();
                let passes = gears.len() == 2 && self.parts_on(shaft, LOAD).next().is_none();
                for &other in gears.iter().filter(|other| other.id != gear.id) {
                    for mate in self.mates(other) {
                        let is_new = train.iter().all(|known| known.gear.id != mate.id);
                        let ratio = ratio(other, mate).filter(|_| is_new && train.len() < MOST);
                        train.extend(ratio.map(|ratio| Turning {
                            gear: mate,
                            speed: -speed * ratio,
                            torque: torque.filter(|_| passes).map(|torque| -torque / ratio),
                        }));
                    }
                }
            }
        }
        train
    }

    /// The speed of the driver with its direction, from the nearest gear or shaft with a speed.
    fn speed(&self) -> Read {
        for Turning { gear, speed, .. } in self.train() {
            for part in std::iter::once(gear).chain(self.shafts(gear)) {
                if let Some(speed) = self.acting(part, SPEED, speed)? {
                    return Ok(Some(speed));
                }
            }
        }
        Ok(None)
    }

    /// The torque or power of the driver, and its field: by the data of a gear for this stage, or by
    /// the only load on the shaft of a gear that has its shaft alone.
    fn load(&self) -> Read<(&'static str, Reading)> {
        let train = self.train();
        for (gear, factor) in self.gears.into_iter().zip(train.iter().map(|own| 1.0 / own.speed)) {
            let factor = if self.planetary.is_some() { 1.0 } else { factor };
            for data in self.gear_data(gear) {
                if let Some(torque) = self.acting(data, TORQUE_OF_GEAR, factor)? {
                    return Ok(Some((TORQUE, torque)));
                }
            }
        }
        for Turning { gear, speed, torque } in train {
            let Some(factor) = torque else { continue };
            for shaft in self.shafts(gear) {
                if self.parts_on(shaft, "gear").count() != 1 {
                    continue;
                }
                let mut loads = Vec::new();
                for part in self.parts_on(shaft, LOAD) {
                    if let Some(torque) = self.acting(part, TORQUE_OF_LOAD, factor)? {
                        loads.push((TORQUE, torque));
                    } else if let Some(power) = self.acting(part, POWER_OF_LOAD, speed * factor)? {
                        loads.push((POWER, power));
                    }
                }
                if loads.len() > 1 {
                    return Err(format!("{} has several loads", shaft.label()).into());
                }
                if let Some(load) = loads.pop() {
                    return Ok(Some(load));
                }
            }
        }
        Ok(None)
    }

    /// A speed or load that is not zero, at the driver. Its text has no sign.
    fn acting(&self, part: &Node, source: Source, factor: f64) -> Read {
        let acting = self.value(part, source)?.filter(|reading| reading.value != 0.0);
        Ok(acting.map(|own| {
            let text = own.text.trim_start_matches(['-', '+']).to_owned();
            if (factor - 1.0).abs() < 1e-12 {
                return Reading { text, ..own };
            }
            let size = Reading { value: own.value.abs(), text, ..own };
            let derived = size.derived(factor.abs(), source.unit, " and the ratio");
            Reading { value: own.value * factor, ..derived }
        }))
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

    /// The gears or the loads on a shaft, by the end of the name of their kind.
    fn parts_on(&self, shaft: &Node, kind: &'static str) -> impl Iterator<Item = &'m Node> {
        let parts = self.index.related("assembly", ("assembly", &shaft.id), "part");
        parts.filter(move |part| part.kind.ends_with(kind))
    }
}

/// The size of a helix angle. A model can have a rounded zero.
fn magnitude(_: &Pair, _: usize, angle: &Reading) -> Option<Reading> {
    const NONE: f64 = 1e-8;
    let size = angle.value.abs();
    let text = angle.text.trim_start_matches(['-', '+']);
    let (value, text) = if size > NONE { (size, text) } else { (0.0, "0 deg") };
    let source = angle.source.clone();
    size.is_finite().then(|| Reading { text: text.to_owned(), value, source })
}

/// The helix angle at the reference diameter from that at the base diameter:
/// sin β_b = sin β cos α_n (ISO 21771).
fn at_reference_diameter(pair: &Pair, gear: usize, base: &Reading) -> Option<Reading> {
    let angle = pair.number(&[0, 1], &[ANGLE])?;
    let value = (base.value.sin() / angle.cos()).asin();
    if base.value == 0.0 {
        return magnitude(pair, gear, base);
    }
    magnitude(pair, gear, &base.derived(value / base.value, "deg", ""))
}

/// The hand of the driver from the sign of a helix angle, above 0 for a right hand (ISO 21771).
/// The other gear has the other hand.
fn hand(_: &Pair, gear: usize, angle: &Reading) -> Option<Reading> {
    const NONE: f64 = 1e-8;
    let is_right = (angle.value > 0.0) == (gear == 0);
    let (text, value) = if is_right { ("right", 1.0) } else { ("left", -1.0) };
    let source = format!("the hand of the driver by {} = {}", angle.source, angle.text);
    (angle.value.abs() > NONE).then(|| Reading { text: text.to_owned(), value, source })
}

/// The greater value of both gears.
fn greater(pair: &Pair, gear: usize, own: &Reading) -> Option<Reading> {
    let other = pair.read(1 - gear, BASE_PITCH).ok().flatten();
    other.filter(|other| other.value > own.value).or_else(|| Some(own.clone()))
}

/// The profile shift coefficient from the shift.
fn coefficient(pair: &Pair, _: usize, shift: &Reading) -> Option<Reading> {
    let own = shift.derived(1.0 / pair.number(&[0, 1], &[MODULE])?, "", "");
    Some(Reading { source: format!("the module and {}", own.source), ..own })
}

/// The length of a tip relief along the path of contact from its start diameter.
fn length_from_diameter(pair: &Pair, gear: usize, start: &Reading) -> Option<Reading> {
    let both = |source| pair.number(&[0, 1], &[source]);
    let own = |source| pair.number(&[gear], &[source]);
    let helix = pair.number(&[0, 1], &HELIX).unwrap_or_default().cos();
    let angle = (both(ANGLE)?.tan() / helix).atan();
    let base = both(MODULE)? * own(TEETH)? / helix * angle.cos();
    let roll = |diameter: f64| (diameter * diameter - base * base).max(0.0).sqrt() / 2.0;
    let value = roll(own(TIP)?) - roll(start.value);
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
        let number = rounded(units::per(value, unit));
        Reading {
            text: format!("{} {unit}", units::text(number, "")).trim_end().to_owned(),
            value,
            source: format!("{} = {}{after}", self.source, self.text),
        }
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
    // A computed value such as 0.5131000000000001 has more digits than its file meant.
    let short = number
        .parse::<f64>()
        .ok()
        .filter(|_| number.len() > 16)
        .map(|number| units::text(rounded(number), ""));
    let number = short.as_deref().unwrap_or(number);
    let text = format!("{number} {unit}").trim_end().to_owned();
    let dimension = Dimension::of_unit(usual).unwrap_or(Dimension::Number);
    match units::parse(&text, dimension, usual) {
        Ok(value) => Ok(Reading { text, value, source }),
        Err(error) => Err(format!("{source}: {}", error.cause)),
    }
}
