//! Reads a gear model of another program (REXS 1.0 to 2.0) as a case.

mod map;

use std::borrow::Cow;
use std::collections::HashMap;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesRef, BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;
use zip::ZipArchive;
use zip::result::ZipError;

use super::file::{MOST_MODEL_BYTES, ReadError, read_bytes};
use super::sanitize::sanitize;
use super::{Case, Document};
use map::{Pair, Values};

/// A stage of a model, converted to a case.
#[derive(Debug)]
pub struct Imported {
    /// The case, without a file, with the source of each value.
    pub document: Document,
    /// The stages of the model, in its order.
    pub stages: Vec<Stage>,
    /// The id of the imported stage.
    pub stage: String,
    /// The empty fields: the key of each field and the reason.
    pub absent: Vec<(&'static str, String)>,
    /// The assumptions of the case, one sentence each.
    pub remarks: Vec<String>,
}

/// A gear stage of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stage {
    /// The id of its component.
    pub id: String,
    /// Its name, which may be empty.
    pub name: String,
    /// Its kind with its article.
    pub kind: String,
    is_pair: bool,
}

impl Stage {
    /// The id and the name of the stage.
    pub fn label(&self) -> String {
        if self.name.is_empty() { self.id.clone() } else { format!("{} {:?}", self.id, self.name) }
    }
}

/// Why a model of another program cannot become a case: place, cause and fix.
pub type Refusal = String;

fn refusal(cause: impl std::fmt::Display, fix: impl std::fmt::Display) -> Refusal {
    format!("{cause}: {fix}")
}

/// A refusal at a place of the text.
fn at(line: usize, column: usize, refusal: &str) -> Refusal {
    format!("{line}:{column}: {refusal}")
}

/// Refuses more than `most` of the named parts.
fn within(count: usize, most: usize, parts: &str) -> Result<(), Refusal> {
    if count <= most {
        return Ok(());
    }
    Err(refusal(
        format!("the model has more than {most} {parts}"),
        "export the gear pair alone and without results",
    ))
}

/// Whether the file name belongs to a REXS model.
pub fn is_model(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    ends_with_any(&name, &[".rexs", ".rexsj", ".rexsz", ".rexs.zip"])
}

fn ends_with_any(name: &str, endings: &[&str]) -> bool {
    let name = name.to_ascii_lowercase();
    endings.iter().any(|ending| name.ends_with(ending))
}

/// The path of the case file beside a model. For a case, the path itself.
pub fn case_path(path: &Path) -> PathBuf {
    if is_model(path) { path.with_extension("toml") } else { path.to_owned() }
}

/// Reads the first stage of a REXS model that can become a case.
///
/// # Errors
/// If the file cannot be read, or no stage can become a case.
pub fn read_document(path: &Path) -> Result<Document, ReadError> {
    let bytes = read_bytes(path, MOST_MODEL_BYTES)?;
    import(path, &bytes, None).map(|imported| imported.document).map_err(ReadError::Model)
}

/// Reads a stage of a REXS model as a case. Without an id, the first one that can
/// become a case.
///
/// # Errors
/// If the bytes are not a REXS model, or the stage is not a pair of external cylindrical
/// gears.
pub fn import(path: &Path, bytes: &[u8], stage: Option<&str>) -> Result<Imported, Refusal> {
    let file = path.display();
    read(path, bytes, stage).map_err(|refusal| sanitize(&format!("{file}: {refusal}")))
}

fn read(path: &Path, bytes: &[u8], wanted: Option<&str>) -> Result<Imported, Refusal> {
    let model = parse(text(bytes)?.trim_start_matches('\u{feff}'))?;
    let index = Index::of(&model)?;
    let components = gear_stages(&model);
    let read: Vec<(Stage, Option<Pair>)> =
        components.map(|component| stage(&index, component)).collect();
    let stages: Vec<Stage> = read.iter().map(|(stage, _)| stage.clone()).collect();
    let chosen = choose(&stages, wanted)?;
    let mut values = Values::default();
    if let Some((_, Some(pair))) = read.iter().find(|(stage, _)| stage.id == chosen.id) {
        values.read(pair);
    }
    if let Some(reason) = values.refusals.first() {
        return Err(refusal(
            format!("stage {} cannot become a case: {reason}", chosen.label()),
            "a case has symmetric teeth with one module, one pressure angle and one helix angle up \
             to 45 deg; correct the model",
        ));
    }
    if wanted.is_none() {
        let others = stages.iter().filter(|other| other.is_pair && other.id != chosen.id);
        let others: Vec<&str> = others.map(|other| &*other.id).collect();
        if !others.is_empty() {
            values
                .remarks
                .insert(0, format!("`tipstrike import --stage` imports {}", others.join(", ")));
        }
    }
    let (stage, remarks) = (chosen.id.clone(), values.remarks);
    let (document, absent) = document(path, &model, chosen, values.fields);
    Ok(Imported { document, stages, stage, absent, remarks })
}

/// The text of a model: plain, or from a zip archive with one model.
fn text(bytes: &[u8]) -> Result<Cow<'_, str>, Refusal> {
    let text = if bytes.starts_with(b"PK") {
        String::from_utf8(unpacked(bytes)?).ok().map(Cow::Owned)
    } else {
        std::str::from_utf8(bytes).ok().map(Cow::Borrowed)
    };
    text.ok_or_else(|| refusal("the text of the model is not UTF-8", "export the model as UTF-8"))
}

fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Refusal> {
    const DIRECTORY_ENTRY: &[u8] = b"PK\x01\x02";
    const MOST_FILES: usize = 1000;
    let damaged = |error: ZipError| {
        refusal(
            format!("the archive cannot be unpacked: {error}"),
            "pack it again as a plain zip file, deflated and without password",
        )
    };
    // Each entry of the directory takes memory, so the entries are counted before it is read.
    let entries = bytes.windows(DIRECTORY_ENTRY.len()).filter(|four| *four == DIRECTORY_ENTRY);
    if entries.count() > MOST_FILES {
        return Err(refusal(
            format!("the archive has more than {MOST_FILES} files"),
            "pack the model alone",
        ));
    }
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(damaged)?;
    let names = archive.file_names().filter_map(Result::ok).map(Cow::into_owned);
    let models: Vec<String> =
        names.filter(|name| ends_with_any(name, &[".rexs", ".rexsj", ".xml", ".json"])).collect();
    let [model] = models.as_slice() else {
        return Err(refusal(
            format!("the archive has {} models", models.len()),
            "pack exactly one .rexs or .rexsj file",
        ));
    };
    let file = archive.by_name(model).map_err(damaged)?;
    let mut text = Vec::new();
    // The size in the directory can be wrong, so the bytes are counted.
    let read = file.take(MOST_MODEL_BYTES as u64 + 1).read_to_end(&mut text);
    read.map_err(|error| damaged(ZipError::Io(error)))?;
    if text.len() > MOST_MODEL_BYTES {
        return Err(refusal(
            format!("the model is longer than {} MiB unpacked", MOST_MODEL_BYTES >> 20),
            "export the model without results",
        ));
    }
    Ok(text)
}

fn parse(text: &str) -> Result<Model, Refusal> {
    let model = match text.trim_start().chars().next() {
        Some('<') => parse_xml(text)?,
        Some('{') => parse_json(text)?,
        _ => {
            return Err(refusal(
                "the file is neither XML nor JSON",
                "export the model as REXS (.rexs, .rexsj or .rexsz)",
            ));
        }
    };
    if matches!(model.version.split('.').next(), Some("1" | "2")) {
        return Ok(model);
    }
    Err(refusal(
        format!("the model is of REXS version {:?}", model.version),
        "export it as REXS 1.0 to 2.0",
    ))
}

/// The stage of a component, with its gears if it can become a case.
fn stage<'m>(index: &'m Index<'m>, stage: &'m Node) -> (Stage, Option<Pair<'m>>) {
    let pair = Pair::of(index, stage);
    let (id, name) = (stage.id.to_string(), stage.name.to_string());
    let kind = pair.as_ref().map_or_else(String::clone, Pair::kind);
    (Stage { id, name, kind, is_pair: pair.is_ok() }, pair.ok())
}

fn choose<'a>(stages: &'a [Stage], wanted: Option<&str>) -> Result<&'a Stage, Refusal> {
    const FIX: &str = "choose a stage of two external cylindrical gears";
    let line = |stage: &Stage| format!("stage {} is {}", stage.label(), stage.kind);
    let listed = || stages.iter().map(line).collect::<Vec<_>>().join("; ");
    let Some(id) = wanted else {
        return stages.iter().find(|stage| stage.is_pair).ok_or_else(|| match stages {
            [] => refusal("the model has no gear stage", FIX),
            _ => refusal(
                "the model has no stage that can become a case",
                format!("{FIX}; here {}", listed()),
            ),
        });
    };
    match stages.iter().find(|stage| stage.id == id) {
        Some(stage) if stage.is_pair => Ok(stage),
        Some(other) => Err(refusal(line(other), FIX)),
        None => Err(refusal(
            format!("the model has no stage {id:?}"),
            format!("choose one of its stages: {}", listed()),
        )),
    }
}

/// The case with these values, the source of each value, and the empty fields.
fn document(
    path: &Path,
    model: &Model,
    stage: &Stage,
    fields: Vec<map::Found>,
) -> (Document, Vec<(&'static str, String)>) {
    let mut case = Case::empty();
    let (mut comments, mut absent) = (Vec::new(), Vec::new());
    for (key, found) in fields {
        let set = found.and_then(|reading| {
            let problem = case.set(key, &reading.text).err();
            problem.map_or(Ok(reading.source.clone()), |problem| {
                Err(format!("{}: {}", reading.source, problem.cause))
            })
        });
        match set {
            Ok(source) => comments.push((key, format!("From {source}."))),
            Err(reason) => {
                comments.push((key, format!("Left empty: {reason}.")));
                absent.push((key, reason));
            }
        }
    }
    let Stage { id, name, .. } = stage;
    let title = if name.is_empty() { format!("Stage {id}") } else { name.clone() };
    let notes = format!(
        "stage {id} of {} (REXS {}, {} {})",
        path.file_name().unwrap_or_default().to_string_lossy(),
        model.version,
        model.application,
        model.application_version
    );
    // Both are text fields, which accept any text.
    let _ = case.set("title", &title);
    let _ = case.set("notes", &notes);
    let name = format!("{} (as a case)", path.display());
    (Document::commented(name, case, &comments), absent)
}

/// Greatest number of nodes. It limits the memory of a model. A usual model has
/// 225,000 in 16 MiB.
const MOST_ENTRIES: usize = 250_000;
const MOST_STAGES: usize = 200;
const MOST_REFS_OF_RELATION: usize = 50;
/// Greatest number of attributes, relations and load cases of one component.
const MOST_OF_COMPONENT: usize = 1000;
/// Greatest length of a name, an id or a type, in bytes.
const MOST_NAME: usize = 1000;

#[derive(Debug, Default, Deserialize)]
struct Model {
    /// The REXS version, such as "1.4".
    #[serde(deserialize_with = "scalar")]
    version: Box<str>,
    #[serde(default, rename = "applicationId", deserialize_with = "scalar")]
    application: Box<str>,
    #[serde(default, rename = "applicationVersion", deserialize_with = "scalar")]
    application_version: Box<str>,
    /// Parts, materials and loads with their attributes.
    #[serde(default)]
    components: Vec<Node>,
    /// Relations with their references.
    #[serde(default)]
    relations: Vec<Node>,
    /// Load cases with the components to which they add attributes.
    #[serde(
        default,
        rename = "load_spectrum",
        alias = "load_spectrums",
        deserialize_with = "load_cases"
    )]
    load_cases: Vec<Node>,
}

/// A component, an attribute, a relation, a reference or a load case. Members that it lacks are
/// empty.
#[derive(Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default)]
struct Node {
    #[serde(deserialize_with = "scalar")]
    id: Box<str>,
    /// The type of a component or a relation, such as "cylindrical_gear".
    #[serde(rename = "type", deserialize_with = "scalar")]
    kind: Box<str>,
    #[serde(deserialize_with = "scalar")]
    name: Box<str>,
    /// The role of a reference.
    #[serde(deserialize_with = "scalar")]
    role: Box<str>,
    #[serde(deserialize_with = "scalar")]
    unit: Box<str>,
    /// The value of an attribute, empty if it is neither a scalar nor a short array. In JSON, the
    /// name of the key is the kind of the value.
    #[serde(
        alias = "floating_point",
        alias = "integer",
        alias = "boolean",
        alias = "string",
        alias = "enum",
        alias = "floating_point_array",
        deserialize_with = "scalar"
    )]
    value: Box<str>,
    #[serde(alias = "attributes", alias = "refs", alias = "components")]
    nodes: Vec<Node>,
}

impl Node {
    /// The attributes of this id with a value. A valid model has one.
    fn given<'a>(&'a self, id: &'a str) -> impl Iterator<Item = &'a Node> {
        self.nodes.iter().filter(move |node| &*node.id == id && !node.value.is_empty())
    }

    /// The id of the component in a role of a relation.
    fn role(&self, role: &str) -> Option<&str> {
        self.nodes.iter().find(|own| &*own.role == role).map(|own| &*own.id)
    }

    /// The label in messages, such as `cylindrical_gear 23 "pinion"`.
    fn label(&self) -> String {
        let name = if self.name.is_empty() { "" } else { &*format!(" {:?}", self.name) };
        format!("{} {}{name}", self.kind, self.id)
    }

    fn longest_name(&self) -> usize {
        let own = [&self.id, &self.kind, &self.name, &self.role, &self.unit].map(|text| text.len());
        own.into_iter().chain(self.nodes.iter().map(Node::longest_name)).max().unwrap_or_default()
    }
}

/// The components of a model, their relations and their load cases by id.
#[derive(Debug, Default)]
struct Index<'m> {
    components: HashMap<&'m str, &'m Node>,
    relations: HashMap<&'m str, Vec<&'m Node>>,
    /// Load cases, each with the node of the component.
    loads: HashMap<&'m str, Vec<(&'m Node, &'m Node)>>,
}

impl<'m> Index<'m> {
    /// Refuses a model beyond the limits, and an id of two components.
    fn of(model: &'m Model) -> Result<Index<'m>, Refusal> {
        let mut index = Index::default();
        check_limits(model)?;
        for component in &model.components {
            if index.components.insert(&*component.id, component).is_some() {
                return Err(refusal(
                    format!("two components have the id {:?}", component.id),
                    "correct the model, in which each component has its own id",
                ));
            }
        }
        for relation in &model.relations {
            for reference in &relation.nodes {
                let known = index.relations.entry(&*reference.id).or_default();
                if known.last().is_none_or(|last| !std::ptr::eq(*last, relation)) {
                    known.push(relation);
                }
                within(known.len(), MOST_OF_COMPONENT, "relations of one component")?;
            }
        }
        for case in &model.load_cases {
            for component in &case.nodes {
                let known = index.loads.entry(&*component.id).or_default();
                known.push((case, component));
                within(known.len(), MOST_OF_COMPONENT, "load cases of one component")?;
            }
        }
        Ok(index)
    }

    fn component(&self, id: &str) -> Option<&'m Node> {
        self.components.get(id).copied()
    }

    fn loads_of(&self, id: &str) -> &[(&'m Node, &'m Node)] {
        self.loads.get(id).map_or(&[], Vec::as_slice)
    }

    fn relations_of(&self, id: &str) -> &[&'m Node] {
        self.relations.get(id).map_or(&[], Vec::as_slice)
    }

    /// The components with the role `other` in the relations of this type in which the component
    /// `id` has the role `role`.
    fn related(
        &self,
        kind: &str,
        (role, id): (&str, &str),
        other: &str,
    ) -> impl Iterator<Item = &'m Node> {
        self.relations_of(id)
            .iter()
            .filter(move |relation| &*relation.kind == kind && relation.role(role) == Some(id))
            .filter_map(move |relation| self.component(relation.role(other)?))
    }

    /// The components that share any relation with this component.
    fn linked(&self, id: &str) -> impl Iterator<Item = &'m Node> {
        self.relations_of(id)
            .iter()
            .flat_map(|relation| &relation.nodes)
            .filter(move |other| &*other.id != id)
            .filter_map(|other| self.component(&other.id))
    }
}

/// The gear stages of a model.
fn gear_stages(model: &Model) -> impl Iterator<Item = &Node> {
    model.components.iter().filter(|component| component.kind.ends_with("_stage"))
}

fn check_limits(model: &Model) -> Result<(), Refusal> {
    let loaded = model.load_cases.iter().flat_map(|case| &case.nodes);
    for component in model.components.iter().chain(loaded) {
        within(component.nodes.len(), MOST_OF_COMPONENT, "attributes of one component")?;
    }
    for relation in &model.relations {
        within(relation.nodes.len(), MOST_REFS_OF_RELATION, "references of one relation")?;
    }
    within(gear_stages(model).count(), MOST_STAGES, "stages")?;
    let all = [&model.components, &model.relations, &model.load_cases].into_iter().flatten();
    let texts = [&model.version, &model.application, &model.application_version];
    let names = all.map(Node::longest_name).chain(texts.map(|text| text.len()));
    within(names.max().unwrap_or_default(), MOST_NAME, "bytes in a name")
}

/// Reads a model from JSON.
fn parse_json(text: &str) -> Result<Model, Refusal> {
    #[derive(Deserialize)]
    struct File {
        model: Model,
    }
    within(objects_and_lists(text), MOST_ENTRIES, "objects and lists")?;
    let file: File = serde_json::from_str(text).map_err(|error| {
        let words = error.to_string();
        let cause = words.split(" at line ").next().unwrap_or(&words);
        let cause = format!("this is not a REXS model in JSON: {cause}");
        at(error.line(), error.column(), &refusal(cause, "export the model again"))
    })?;
    Ok(file.model)
}

/// The number of objects and lists: each can become a node of the model.
fn objects_and_lists(text: &str) -> usize {
    let mut bytes = text.bytes();
    let (mut count, mut is_string) = (0, false);
    while let Some(byte) = bytes.next() {
        match byte {
            b'"' => is_string = !is_string,
            b'\\' => drop(bytes.next()),
            b'{' | b'[' if !is_string => count += 1,
            _ => {}
        }
    }
    count
}

/// Greatest length of the text of an array that is read, such as a vector.
const MOST_ARRAY: usize = 200;

/// The text of a scalar, or of a short array with blanks between its numbers. Empty for null, an
/// object and a long array, which take no memory.
fn scalar<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Box<str>, D::Error> {
    let text = <&RawValue>::deserialize(deserializer)?.get();
    match text.as_bytes().first() {
        Some(b'"') => {
            let text: String = serde_json::from_str(text).map_err(D::Error::custom)?;
            Ok(text.trim().into())
        }
        Some(b'[') if text.len() < MOST_ARRAY => {
            Ok(text.replace(['[', ']', ','], " ").trim().into())
        }
        Some(b'[' | b'{' | b'n') => Ok("".into()),
        _ => Ok(text.into()),
    }
}

/// The load cases of one load spectrum or of a list of load spectra.
fn load_cases<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Node>, D::Error> {
    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct Spectrum {
        load_cases: Vec<Node>,
    }
    let text = <&RawValue>::deserialize(deserializer)?.get();
    let spectra: Result<Option<Vec<Spectrum>>, _> = if text.starts_with('{') {
        serde_json::from_str(text).map(|only| Some(vec![only]))
    } else {
        serde_json::from_str(text)
    };
    let spectra = spectra.map_err(D::Error::custom)?.unwrap_or_default();
    Ok(spectra.into_iter().flat_map(|spectrum| spectrum.load_cases).collect())
}

/// Greatest number of elements and references, which need time but no memory.
const MOST_ELEMENTS: usize = 2_000_000;

/// The known elements, each below its parent. Other elements are skipped.
const ELEMENTS: [(&str, &str); 12] = [
    (ROOT, "model"),
    ("model", "components"),
    ("model", "relations"),
    ("model", "load_spectrum"),
    ("components", "component"),
    ("relations", "relation"),
    ("load_spectrum", "load_case"),
    ("load_case", "component"),
    ("component", "attribute"),
    ("relation", "ref"),
    ("attribute", "array"),
    ("array", "c"),
];
/// The parent of the root element.
const ROOT: &str = "/";

/// Reads a model from XML, element by element, so that time and memory grow with the file only.
/// Refuses a document type, which could define entities.
fn parse_xml(text: &str) -> Result<Model, Refusal> {
    let mut reader = Reader::from_str(text);
    let mut state = State::default();
    loop {
        let start = reader.buffer_position();
        let event = reader.read_event().map_err(malformed);
        match event.and_then(|event| state.read(&event)) {
            Ok(true) => return Ok(state.model),
            Ok(false) => {}
            Err(refusal) => {
                let before = usize::try_from(start).ok().and_then(|at| text.get(..at));
                let before = before.unwrap_or(text);
                let line = before.rsplit('\n').next().unwrap_or_default();
                let place = (before.matches('\n').count() + 1, line.chars().count() + 1);
                return Err(at(place.0, place.1, &refusal));
            }
        }
    }
}

fn malformed(cause: impl std::fmt::Display) -> Refusal {
    refusal(format!("this is not XML: {cause}"), "export the model again")
}

/// The model up to the current event.
#[derive(Default)]
struct State {
    model: Model,
    /// The open elements by name, empty for unknown elements, with the nodes that they become.
    open: Vec<(&'static str, Option<Box<Node>>)>,
    /// The text of the open attribute.
    text: String,
    entries: usize,
    elements: usize,
    has_root: bool,
}

impl State {
    /// Whether the text ends with this event.
    fn read(&mut self, event: &Event) -> Result<bool, Refusal> {
        if matches!(event, Event::Start(_) | Event::Empty(_) | Event::GeneralRef(_)) {
            self.elements += 1;
            within(self.elements, MOST_ELEMENTS, "elements and references")?;
        }
        match event {
            Event::Start(element) => self.open(element)?,
            Event::Empty(element) => {
                self.open(element)?;
                self.close();
            }
            Event::End(_) => self.close(),
            Event::Text(text) => self.add(text)?,
            Event::CData(text) => self.add(text)?,
            Event::GeneralRef(reference) => self.add(&referenced(reference)?)?,
            Event::DocType(_) => {
                return Err(refusal(
                    "the file declares a document type, which may hide entities",
                    "remove the <!DOCTYPE ...> part",
                ));
            }
            Event::Eof if self.has_root && self.open.is_empty() => return Ok(true),
            Event::Eof => return Err(malformed("the text ends before its last element")),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
        }
        Ok(false)
    }

    fn open(&mut self, element: &BytesStart) -> Result<(), Refusal> {
        let parent = self.open.last().map_or(ROOT, |(name, _)| *name);
        let own = element.local_name();
        let known = ELEMENTS.iter().find(|(above, name)| *above == parent && *name == own.as_ref());
        let name = known.map_or("", |(_, name)| name);
        match (name, parent) {
            (_, ROOT) if self.has_root => return Err(malformed("it has two root elements")),
            ("", ROOT) => {
                return Err(refusal(
                    format!("the root element is {:?}", own.as_ref()),
                    "choose a REXS model, whose root element is \"model\"",
                ));
            }
            (_, ROOT) => self.has_root = true,
            ("attribute", _) => self.text.clear(),
            ("c", _) => self.text.push(' '),
            _ => {}
        }
        let mut node = Node::default();
        for attribute in element.attributes().with_checks(false) {
            let attribute = attribute.map_err(malformed)?;
            let member = match (name, attribute.key.as_ref()) {
                ("", _) => continue,
                ("model", "version") => &mut self.model.version,
                ("model", "applicationId") => &mut self.model.application,
                ("model", "applicationVersion") => &mut self.model.application_version,
                (_, "id") => &mut node.id,
                (_, "type") => &mut node.kind,
                (_, "name") => &mut node.name,
                (_, "role") => &mut node.role,
                (_, "unit") => &mut node.unit,
                _ => continue,
            };
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            *member = value.map_err(malformed)?.trim().into();
        }
        let is_node = matches!(name, "component" | "relation" | "load_case" | "attribute" | "ref");
        if is_node {
            self.entries += 1;
            within(self.entries, MOST_ENTRIES, "entries")?;
        }
        self.open.push((name, is_node.then(|| node.into())));
        Ok(())
    }

    /// Moves the node of the last open element into its parent.
    fn close(&mut self) {
        let Some((name, Some(mut node))) = self.open.pop() else { return };
        if name == "attribute" {
            node.value = self.text.trim().into();
            if node.value.is_empty() {
                // An array that is not read, such as a table of results.
                self.entries -= 1;
                return;
            }
        }
        let Model { components, relations, load_cases, .. } = &mut self.model;
        let siblings = match (name, self.open.last_mut()) {
            (_, Some((_, Some(parent)))) => &mut parent.nodes,
            ("component", _) => components,
            ("relation", _) => relations,
            _ => load_cases,
        };
        siblings.push(*node);
    }

    fn add(&mut self, text: &str) -> Result<(), Refusal> {
        match self.open.last() {
            None if !text.trim().is_empty() => {
                Err(malformed("it has text outside its root element"))
            }
            Some(("attribute", _)) => {
                self.text.push_str(text);
                Ok(())
            }
            Some(("c", _)) if self.text.len() < MOST_ARRAY => {
                self.text.push_str(text.trim());
                Ok(())
            }
            Some(("c", _)) => {
                self.text.clear();
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// The text of a character reference or a predefined entity.
fn referenced(reference: &BytesRef) -> Result<String, Refusal> {
    let text = reference.resolve_char_ref().map_err(malformed)?.map(String::from);
    let text = text.or_else(|| resolve_predefined_entity(reference).map(str::to_owned));
    text.ok_or_else(|| malformed("it has an unknown entity"))
}
