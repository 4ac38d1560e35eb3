//! A REXS model as a small tree, independent of its file format, and its index.

use std::collections::HashMap;

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesRef, BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use super::{Refusal, at, refusal, within};

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
pub(super) struct Model {
    /// The REXS version, such as "1.4".
    #[serde(deserialize_with = "scalar")]
    pub(super) version: Box<str>,
    #[serde(default, rename = "applicationId", deserialize_with = "scalar")]
    pub(super) application: Box<str>,
    #[serde(default, rename = "applicationVersion", deserialize_with = "scalar")]
    pub(super) application_version: Box<str>,
    /// Parts, materials and loads with their attributes.
    #[serde(default)]
    pub(super) components: Vec<Node>,
    /// Relations with their references.
    #[serde(default)]
    pub(super) relations: Vec<Node>,
    /// Load cases with the components to which they add attributes.
    #[serde(
        default,
        rename = "load_spectrum",
        alias = "load_spectrums",
        deserialize_with = "load_cases"
    )]
    pub(super) load_cases: Vec<Node>,
}

/// A component, an attribute, a relation, a reference or a load case. Members that it lacks are
/// empty.
#[derive(Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    #[serde(deserialize_with = "scalar")]
    pub(super) id: Box<str>,
    /// The type of a component or a relation, such as "cylindrical_gear".
    #[serde(rename = "type", deserialize_with = "scalar")]
    pub(super) kind: Box<str>,
    #[serde(deserialize_with = "scalar")]
    pub(super) name: Box<str>,
    /// The role of a reference.
    #[serde(deserialize_with = "scalar")]
    pub(super) role: Box<str>,
    #[serde(deserialize_with = "scalar")]
    pub(super) unit: Box<str>,
    /// The value of an attribute, empty if it is not scalar. In JSON, the name of the key is the
    /// kind of the value.
    #[serde(
        alias = "floating_point",
        alias = "integer",
        alias = "boolean",
        alias = "string",
        alias = "enum",
        deserialize_with = "scalar"
    )]
    pub(super) value: Box<str>,
    #[serde(alias = "attributes", alias = "refs", alias = "components")]
    pub(super) nodes: Vec<Node>,
}

impl Node {
    /// The attributes of this id with a value. A valid model has one.
    pub(super) fn given<'a>(&'a self, id: &'a str) -> impl Iterator<Item = &'a Node> {
        self.nodes.iter().filter(move |node| &*node.id == id && !node.value.is_empty())
    }

    /// The id of the component in a role of a relation.
    pub(super) fn role(&self, role: &str) -> Option<&str> {
        self.nodes.iter().find(|own| &*own.role == role).map(|own| &*own.id)
    }

    /// The label in messages, such as `cylindrical_gear 23 "pinion"`.
    pub(super) fn label(&self) -> String {
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
pub(super) struct Index<'m> {
    components: HashMap<&'m str, &'m Node>,
    relations: HashMap<&'m str, Vec<&'m Node>>,
    /// Load cases, each with the node of the component.
    loads: HashMap<&'m str, Vec<(&'m Node, &'m Node)>>,
}

impl<'m> Index<'m> {
    /// Refuses a model beyond the limits, and an id of two components.
    pub(super) fn of(model: &'m Model) -> Result<Index<'m>, Refusal> {
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

    pub(super) fn component(&self, id: &str) -> Option<&'m Node> {
        self.components.get(id).copied()
    }

    pub(super) fn loads_of(&self, id: &str) -> &[(&'m Node, &'m Node)] {
        self.loads.get(id).map_or(&[], Vec::as_slice)
    }

    pub(super) fn relations_of(&self, id: &str) -> &[&'m Node] {
        self.relations.get(id).map_or(&[], Vec::as_slice)
    }

    /// The components with the role `other` in the relations of this type in which the component
    /// `id` has the role `role`.
    pub(super) fn related(
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

    /// The components of a type that share any relation with this component.
    pub(super) fn linked(&self, id: &str, kind: &str) -> impl Iterator<Item = &'m Node> {
        self.relations_of(id)
            .iter()
            .flat_map(|relation| &relation.nodes)
            .filter(move |other| &*other.id != id)
            .filter_map(|other| self.component(&other.id))
            .filter(move |component| &*component.kind == kind)
    }
}

/// The gear stages of a model.
pub(super) fn stages(model: &Model) -> impl Iterator<Item = &Node> {
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
    within(stages(model).count(), MOST_STAGES, "stages")?;
    let all = [&model.components, &model.relations, &model.load_cases].into_iter().flatten();
    let texts = [&model.version, &model.application, &model.application_version];
    let names = all.map(Node::longest_name).chain(texts.map(|text| text.len()));
    within(names.max().unwrap_or_default(), MOST_NAME, "bytes in a name")
}

/// Reads a model from JSON.
pub(super) fn parse_json(text: &str) -> Result<Model, Refusal> {
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

/// The text of a scalar. Empty for null, a list or an object, which take no memory.
fn scalar<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Box<str>, D::Error> {
    let text = <&RawValue>::deserialize(deserializer)?.get();
    match text.as_bytes().first() {
        Some(b'"') => {
            let text: String = serde_json::from_str(text).map_err(D::Error::custom)?;
            Ok(text.trim().into())
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
const ELEMENTS: [(&str, &str); 10] = [
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
];
/// The parent of the root element.
const ROOT: &str = "/";

/// Reads a model from XML, element by element, so that time and memory grow with the file only.
/// Refuses a document type, which could define entities.
pub(super) fn parse_xml(text: &str) -> Result<Model, Refusal> {
    let mut reader = Reader::from_str(text);
    let mut state = State::default();
    loop {
        let start = reader.buffer_position();
        let event = reader.read_event().map_err(|error| malformed(&error));
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

fn malformed(cause: &dyn std::fmt::Display) -> Refusal {
    refusal(format!("this is not XML: {cause}"), "export the model again")
}

/// The model up to the current event.
#[derive(Default)]
struct State {
    model: Model,
    /// The open elements by name, empty for unknown elements and for attributes that are not
    /// scalar.
    open: Vec<&'static str>,
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
            Event::Eof => return Err(malformed(&"the text ends before its last element")),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
        }
        Ok(false)
    }

    fn open(&mut self, element: &BytesStart) -> Result<(), Refusal> {
        let parent = self.open.last().copied().unwrap_or(ROOT);
        let own = element.local_name();
        let known = ELEMENTS.iter().find(|(above, name)| *above == parent && *name == own.as_ref());
        let name = known.map_or("", |(_, name)| name);
        if parent == ROOT {
            if self.has_root {
                return Err(malformed(&"it has two root elements"));
            }
            if name.is_empty() {
                return Err(refusal(
                    format!("the root element is {:?}", own.as_ref()),
                    "choose a REXS model, whose root element is \"model\"",
                ));
            }
            self.has_root = true;
        }
        if let Some(above) = self.open.last_mut().filter(|above| **above == "attribute") {
            *above = "";
            self.entries -= 1;
            if let Some(nodes) = self.nodes("attribute") {
                nodes.pop();
            }
        }
        self.open.push(name);
        self.text.clear();
        let mut node = Node::default();
        for attribute in element.attributes().with_checks(false) {
            let attribute = attribute.map_err(|error| malformed(&error))?;
            let member = match attribute.key.as_ref() {
                _ if name.is_empty() => continue,
                "id" => &mut node.id,
                "type" => &mut node.kind,
                "name" => &mut node.name,
                "role" => &mut node.role,
                "unit" => &mut node.unit,
                _ if name != "model" => continue,
                "version" => &mut self.model.version,
                "applicationId" => &mut self.model.application,
                "applicationVersion" => &mut self.model.application_version,
                _ => continue,
            };
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            *member = value.map_err(|error| malformed(&error))?.trim().into();
        }
        if let Some(nodes) = self.nodes(name) {
            nodes.push(node);
            self.entries += 1;
            within(self.entries, MOST_ENTRIES, "entries")?;
        }
        Ok(())
    }

    /// The list of the open element of this name.
    fn nodes(&mut self, name: &str) -> Option<&mut Vec<Node>> {
        let Model { components, relations, load_cases, .. } = &mut self.model;
        let is_loaded = self.open.contains(&"load_case");
        match name {
            "load_case" => Some(load_cases),
            "relation" => Some(relations),
            "ref" => Some(&mut relations.last_mut()?.nodes),
            "component" | "attribute" => {
                let parts = if is_loaded { &mut load_cases.last_mut()?.nodes } else { components };
                if name == "component" { Some(parts) } else { Some(&mut parts.last_mut()?.nodes) }
            }
            _ => None,
        }
    }

    fn close(&mut self) {
        if self.open.last() == Some(&"attribute") {
            let value = self.text.trim().into();
            if let Some(own) = self.nodes("attribute").and_then(|nodes| nodes.last_mut()) {
                own.value = value;
            }
        }
        self.open.pop();
    }

    fn add(&mut self, text: &str) -> Result<(), Refusal> {
        match self.open.last() {
            None if !text.trim().is_empty() => {
                return Err(malformed(&"it has text outside its root element"));
            }
            Some(&"attribute") => self.text.push_str(text),
            _ => {}
        }
        Ok(())
    }
}

/// The text of a character reference or a predefined entity.
fn referenced(reference: &BytesRef) -> Result<String, Refusal> {
    let character = reference.resolve_char_ref();
    let character = character.map_err(|error| malformed(&error))?;
    let text = character.map(String::from);
    let text = text.or_else(|| resolve_predefined_entity(reference).map(str::to_owned));
    text.ok_or_else(|| malformed(&"it has an unknown entity"))
}
