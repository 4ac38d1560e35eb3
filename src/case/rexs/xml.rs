//! Reads a model from XML, element by element, so that time and memory grow with the file only.
//! Refuses a document type, which could define entities.

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesRef, BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::model::{Attribute, Component, LoadCase, MOST_ENTRIES, Model, Ref, Relation};
use super::refusal::{Refusal, within};

/// Greatest number of elements and references, which need time but no memory.
const MOST_ELEMENTS: usize = 2_000_000;
const MOST_DEPTH: usize = 100;
const MOST_XML_ATTRIBUTES: usize = 100;

pub(super) fn parse(text: &str) -> Result<Model, Refusal> {
    let mut reader = Reader::from_str(text);
    let mut state = State::default();
    loop {
        let start = reader.buffer_position();
        let is_done = match reader.read_event() {
            Ok(Event::Eof) => state.end().map(|()| true),
            Ok(event) => state.read(&event).map(|()| false),
            Err(error) => Err(malformed(&error)),
        };
        match is_done {
            Ok(true) => return Ok(state.model),
            Ok(false) => {}
            Err(refusal) => return Err(placed(refusal, text, start)),
        }
    }
}

fn malformed(cause: &dyn std::fmt::Display) -> Refusal {
    Refusal::new(format!("this is not XML: {cause}"), "export the model again")
}

fn placed(refusal: Refusal, text: &str, start: u64) -> Refusal {
    let before = usize::try_from(start).ok().and_then(|at| text.get(..at));
    let before = before.unwrap_or(text);
    let line = before.rsplit('\n').next().unwrap_or_default();
    refusal.at(before.matches('\n').count() + 1, line.chars().count() + 1)
}

/// The model up to the current event.
#[derive(Default)]
struct State {
    model: Model,
    /// The names of the open elements, empty for unknown names.
    path: Vec<&'static str>,
    /// The open attribute while it can be scalar.
    attribute: Option<Attribute>,
    entries: usize,
    elements: usize,
    has_root: bool,
}

const NAMES: [&str; 9] = [
    "model",
    "components",
    "component",
    "attribute",
    "relations",
    "relation",
    "ref",
    "load_spectrum",
    "load_case",
];

impl State {
    fn read(&mut self, event: &Event) -> Result<(), Refusal> {
        if matches!(event, Event::Start(_) | Event::Empty(_) | Event::GeneralRef(_)) {
            self.elements += 1;
            within(self.elements, MOST_ELEMENTS, "elements and references")?;
        }
        match event {
            Event::Start(element) => self.open(element),
            Event::Empty(element) => {
                self.open(element)?;
                self.close();
                Ok(())
            }
            Event::End(_) => {
                self.close();
                Ok(())
            }
            Event::Text(text) => self.add(text),
            Event::CData(text) => self.add(text),
            Event::GeneralRef(reference) => self.add(&referenced(reference)?),
            Event::DocType(_) => Err(Refusal::new(
                "the file declares a document type, which may hide entities",
                "remove the <!DOCTYPE ...> part",
            )),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::Eof => Ok(()),
        }
    }

    fn end(&self) -> Result<(), Refusal> {
        if self.has_root && self.path.is_empty() {
            return Ok(());
        }
        Err(malformed(&"the text ends before its last element"))
    }

    fn open(&mut self, element: &BytesStart) -> Result<(), Refusal> {
        let name = element.local_name();
        let known = NAMES.iter().find(|known| **known == name.as_ref());
        if self.path.is_empty() {
            if self.has_root {
                return Err(malformed(&"it has two root elements"));
            }
            if known != Some(&"model") {
                return Err(Refusal::new(
                    format!("the root element is {:?}", name.as_ref()),
                    "choose a REXS model, whose root element is \"model\"",
                ));
            }
            self.has_root = true;
        }
        self.path.push(known.unwrap_or(&""));
        within(self.path.len(), MOST_DEPTH, "nested elements")?;
        let mut count = 0;
        for attribute in element.attributes().with_checks(false) {
            attribute.map_err(|error| malformed(&error))?;
            count += 1;
            within(count, MOST_XML_ATTRIBUTES, "attributes in one element")?;
        }
        if known.is_none() {
            self.attribute = None;
            return Ok(());
        }
        let text = |name| attribute(element, name);
        let component = || {
            Ok(Component {
                id: text("id")?,
                kind: text("type")?,
                name: text("name")?,
                attributes: Vec::new(),
            })
        };
        let model = &mut self.model;
        match *self.path {
            ["model"] => {
                model.version = text("version")?;
                model.application = text("applicationId")?;
                model.application_version = text("applicationVersion")?;
            }
            ["model", "components", "component"] => model.components.push(component()?),
            ["model", "relations", "relation"] => {
                model.relations.push(Relation { kind: text("type")?, refs: Vec::new() });
            }
            ["model", "relations", "relation", "ref"] => {
                if let Some(relation) = model.relations.last_mut() {
                    let (role, id) = (text("role")?, text("id")?);
                    relation.refs.push(Ref { role, id });
                }
            }
            ["model", "load_spectrum", "load_case"] => {
                model.load_cases.push(LoadCase { id: text("id")?, components: Vec::new() });
            }
            ["model", "load_spectrum", "load_case", "component"] => {
                if let Some(case) = model.load_cases.last_mut() {
                    case.components.push(component()?);
                }
            }
            ["model", "components", "component", "attribute"]
            | ["model", "load_spectrum", "load_case", "component", "attribute"] => {
                self.attribute =
                    Some(Attribute { id: text("id")?, unit: text("unit")?, value: String::new() });
                return Ok(());
            }
            _ => {
                self.attribute = None;
                return Ok(());
            }
        }
        self.entries += 1;
        within(self.entries, MOST_ENTRIES, "entries")
    }

    fn close(&mut self) {
        self.path.pop();
        let Some(mut attribute) = self.attribute.take() else {
            return;
        };
        let component = if let ["model", "components", ..] = *self.path {
            self.model.components.last_mut()
        } else {
            let case = self.model.load_cases.last_mut();
            case.and_then(|case| case.components.last_mut())
        };
        attribute.value = attribute.value.trim().into();
        if let Some(component) = component.filter(|_| !attribute.value.is_empty()) {
            component.attributes.push(attribute);
            self.entries += 1;
        }
    }

    fn add(&mut self, text: &str) -> Result<(), Refusal> {
        if self.path.is_empty() && !text.trim().is_empty() {
            return Err(malformed(&"it has text outside its root element"));
        }
        if let Some(attribute) = &mut self.attribute {
            attribute.value.push_str(text);
        }
        within(self.entries, MOST_ENTRIES, "entries")
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

/// An attribute of an element, empty if it is not given.
fn attribute(element: &BytesStart, name: &str) -> Result<String, Refusal> {
    let mut given = element.attributes();
    let mut given = given.with_checks(false).filter_map(Result::ok);
    let Some(found) = given.find(|given| given.key.as_ref() == name) else {
        return Ok(String::new());
    };
    let value = found.normalized_value(XmlVersion::Implicit1_0);
    let value = value.map_err(|error| malformed(&error))?;
    Ok(value.trim().to_owned())
}
