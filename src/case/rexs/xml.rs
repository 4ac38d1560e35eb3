//! Reads a model from XML, element by element, so that time and memory grow with the file only.
//! Refuses a document type, which could define entities.

use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesRef, BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::model::{MOST_ENTRIES, Model, Node};
use super::{Refusal, within};

/// Greatest number of elements and references, which need time but no memory.
const MOST_ELEMENTS: usize = 2_000_000;
const MOST_DEPTH: usize = 100;
const MOST_XML_ATTRIBUTES: usize = 100;

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
                return Err(refusal.at(before.matches('\n').count() + 1, line.chars().count() + 1));
            }
        }
    }
}

fn malformed(cause: &dyn std::fmt::Display) -> Refusal {
    Refusal::new(format!("this is not XML: {cause}"), "export the model again")
}

/// The model up to the current event.
#[derive(Default)]
struct State {
    model: Model,
    /// The open elements by name, empty for unknown elements. An attribute has a node while it can
    /// be scalar.
    open: Vec<(&'static str, Option<Node>)>,
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
                self.close()?;
            }
            Event::End(_) => self.close()?,
            Event::Text(text) => self.add(text)?,
            Event::CData(text) => self.add(text)?,
            Event::GeneralRef(reference) => self.add(&referenced(reference)?)?,
            Event::DocType(_) => {
                return Err(Refusal::new(
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
        let parent = self.open.last().map_or(ROOT, |(parent, _)| parent);
        let own = element.local_name();
        let known = ELEMENTS.iter().find(|(above, name)| *above == parent && *name == own.as_ref());
        let name = known.map_or("", |(_, name)| name);
        if parent == ROOT {
            if self.has_root {
                return Err(malformed(&"it has two root elements"));
            }
            if name.is_empty() {
                return Err(Refusal::new(
                    format!("the root element is {:?}", own.as_ref()),
                    "choose a REXS model, whose root element is \"model\"",
                ));
            }
            self.has_root = true;
        }
        if let Some((_, node)) = self.open.last_mut().filter(|(parent, _)| *parent == "attribute") {
            *node = None;
        }
        within(self.open.len() + 1, MOST_DEPTH, "nested elements")?;
        let mut count = 0;
        for attribute in element.attributes().with_checks(false) {
            attribute.map_err(|error| malformed(&error))?;
            count += 1;
            within(count, MOST_XML_ATTRIBUTES, "attributes in one element")?;
        }
        self.text.clear();
        let text = |name| attribute(element, name);
        let node = match name {
            "model" => {
                self.model.version = text("version")?;
                self.model.application = text("applicationId")?;
                self.model.application_version = text("applicationVersion")?;
                None
            }
            "" | "components" | "relations" | "load_spectrum" => None,
            _ => Some(Node {
                id: text("id")?,
                kind: text("type")?,
                name: text("name")?,
                role: text("role")?,
                unit: text("unit")?,
                ..Node::default()
            }),
        };
        self.open.push((name, node));
        Ok(())
    }

    fn close(&mut self) -> Result<(), Refusal> {
        let Some((name, Some(mut node))) = self.open.pop() else {
            return Ok(());
        };
        if name == "attribute" {
            node.value = self.text.trim().into();
            if node.value.is_empty() {
                return Ok(());
            }
        }
        let nodes = match self.open.last_mut() {
            Some((_, Some(parent))) => &mut parent.nodes,
            Some(("components", _)) => &mut self.model.components,
            Some(("relations", _)) => &mut self.model.relations,
            _ => &mut self.model.load_cases,
        };
        nodes.push(node);
        self.entries += 1;
        within(self.entries, MOST_ENTRIES, "entries")
    }

    fn add(&mut self, text: &str) -> Result<(), Refusal> {
        match self.open.last_mut() {
            None if !text.trim().is_empty() => {
                return Err(malformed(&"it has text outside its root element"));
            }
            Some(("attribute", Some(_))) => self.text.push_str(text),
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

/// An attribute of an element, empty if it is not given.
fn attribute(element: &BytesStart, name: &str) -> Result<Box<str>, Refusal> {
    let mut given = element.attributes();
    let mut given = given.with_checks(false).filter_map(Result::ok);
    let Some(found) = given.find(|given| given.key.as_ref() == name) else {
        return Ok("".into());
    };
    let value = found.normalized_value(XmlVersion::Implicit1_0);
    Ok(value.map_err(|error| malformed(&error))?.trim().into())
}
