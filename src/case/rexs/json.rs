//! A model from JSON.

use serde::Deserialize;
use serde_json::Value;

use super::model::{Attribute, Component, LoadCase, Model, Relation};
use super::refusal::Refusal;

#[derive(Deserialize)]
struct File {
    model: Root,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Root {
    version: String,
    #[serde(default)]
    application_id: String,
    #[serde(default)]
    application_version: String,
    #[serde(default)]
    relations: Vec<RawRelation>,
    #[serde(default)]
    components: Vec<RawComponent>,
    #[serde(default, rename = "load_spectrum", alias = "load_spectrums")]
    load_spectrum: Option<Spectra>,
}

#[derive(Deserialize)]
struct RawRelation {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    refs: Vec<RawRef>,
}

#[derive(Deserialize)]
struct RawRef {
    id: Value,
    #[serde(default)]
    role: String,
}

#[derive(Deserialize)]
struct RawComponent {
    id: Value,
    #[serde(default, rename = "type")]
    kind: String,
    #[serde(default)]
    name: Option<String>,
    #[serde(default)]
    attributes: Vec<RawAttribute>,
}

/// The scalar values. The name of the key is the kind.
#[derive(Deserialize)]
struct RawAttribute {
    id: String,
    #[serde(default)]
    unit: Option<String>,
    #[serde(
        alias = "floating_point",
        alias = "integer",
        alias = "boolean",
        alias = "string",
        alias = "enum"
    )]
    value: Option<Value>,
}

/// One load spectrum, or a list of them.
#[derive(Deserialize)]
#[serde(untagged)]
enum Spectra {
    One(Spectrum),
    Several(Vec<Spectrum>),
}

#[derive(Deserialize)]
struct Spectrum {
    #[serde(default)]
    load_cases: Vec<RawLoadCase>,
}

#[derive(Deserialize)]
struct RawLoadCase {
    id: Value,
    #[serde(default)]
    components: Vec<RawComponent>,
}

pub(super) fn parse(text: &str) -> Result<Model, Refusal> {
    let file: File = serde_json::from_str(text).map_err(|error| {
        let words = error.to_string();
        let cause = words.split(" at line ").next().unwrap_or(&words);
        Refusal::new(
            format!("this is not a REXS model in JSON: {cause}"),
            "export the model again",
        )
        .at(error.line(), error.column())
    })?;
    let root = file.model;
    let spectra = match root.load_spectrum {
        None => Vec::new(),
        Some(Spectra::One(spectrum)) => vec![spectrum],
        Some(Spectra::Several(spectra)) => spectra,
    };
    Ok(Model {
        version: root.version,
        application: format!("{} {}", root.application_id, root.application_version),
        components: root.components.into_iter().map(component).collect(),
        relations: root.relations.into_iter().map(relation).collect(),
        load_cases: spectra
            .into_iter()
            .flat_map(|spectrum| spectrum.load_cases)
            .map(load_case)
            .collect(),
    })
}

fn scalar(value: &Value) -> String {
    match value {
        Value::String(text) => text.trim().to_owned(),
        Value::Number(_) | Value::Bool(_) => value.to_string(),
        Value::Null | Value::Array(_) | Value::Object(_) => String::new(),
    }
}

fn relation(raw: RawRelation) -> Relation {
    let refs = raw.refs.into_iter();
    Relation {
        kind: raw.kind,
        refs: refs.map(|one| (one.role, scalar(&one.id))).collect(),
    }
}

fn component(raw: RawComponent) -> Component {
    Component {
        id: scalar(&raw.id),
        kind: raw.kind,
        name: raw.name.unwrap_or_default().trim().to_owned(),
        attributes: raw.attributes.into_iter().filter_map(attribute).collect(),
    }
}

fn attribute(raw: RawAttribute) -> Option<Attribute> {
    Some(Attribute {
        id: raw.id,
        unit: raw.unit.unwrap_or_default().trim().to_owned(),
        value: scalar(&raw.value?),
    })
}

fn load_case(raw: RawLoadCase) -> LoadCase {
    LoadCase {
        id: scalar(&raw.id),
        components: raw
            .components
            .into_iter()
            .map(component)
            .map(|component| (component.id, component.attributes))
            .collect(),
    }
}
