//! A REXS model as a small tree, independent of its file format, and its index.

use std::collections::HashMap;

use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

use super::{Refusal, at, refusal, within};

/// Greatest number of nodes. It limits the memory of a model. A usual model has
/// 225,000 in 16 MiB.
pub(super) const MOST_ENTRIES: usize = 250_000;
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
