//! Reads a model from XML, element by element, so that time and memory grow with the file only.
//! Refuses a document type, which could define entities.

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesRef, BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::model::{MOST_ENTRIES, Model, Node};
use super::{Refusal, at, refusal, within};

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

pub(super) fn parse(text: &str) -> Result<Model, Refusal> {
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
