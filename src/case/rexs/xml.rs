//! Reads a model from XML. Refuses a document type, which could define entities.

use roxmltree::{Document, Node, ParsingOptions};

use super::model::{Attribute, Component, LoadCase, Model, Relation};
use super::refusal::Refusal;

const MOST_NODES: u32 = 4_000_000;

pub(super) fn parse(text: &str) -> Result<Model, Refusal> {
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options).map_err(|error| refused(&error))?;
    let root = document.root_element();
    if root.tag_name().name() != "model" {
        return Err(Refusal::new(
            format!("the root element is {:?}", root.tag_name().name()),
            "choose a REXS model, whose root element is \"model\"",
        ));
    }
    Ok(Model {
        version: attribute(root, "version"),
        application: format!(
            "{} {}",
            attribute(root, "applicationId"),
            attribute(root, "applicationVersion")
        ),
        components: grandchildren(root, "components", "component")
            .map(component)
            .collect(),
        relations: grandchildren(root, "relations", "relation")
            .map(relation)
            .collect(),
        load_cases: grandchildren(root, "load_spectrum", "load_case")
            .map(load_case)
            .collect(),
    })
}

fn refused(error: &roxmltree::Error) -> Refusal {
    let place = error.pos();
    let refusal = match error {
        roxmltree::Error::DtdDetected => Refusal::new(
            "the file declares a document type, which may hide entities",
            "remove the <!DOCTYPE ...> part",
        ),
        other => {
            let words = other.to_string();
            let cause = words
                .rsplit_once(" at ")
                .map_or(words.as_str(), |(cause, _)| cause);
            Refusal::new(
                format!("this is not XML: {cause}"),
                "export the model again",
            )
        }
    };
    refusal.at(place.row as usize, place.col as usize)
}

fn attribute(node: Node, name: &str) -> String {
    node.attribute(name).unwrap_or_default().trim().to_owned()
}

fn children<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children()
        .filter(move |child| child.is_element() && child.tag_name().name() == name)
}

fn grandchildren<'a, 'i>(
    node: Node<'a, 'i>,
    child: &'static str,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    children(node, child).flat_map(move |child| children(child, name))
}

fn component(node: Node) -> Component {
    Component {
        id: attribute(node, "id"),
        kind: attribute(node, "type"),
        name: attribute(node, "name"),
        attributes: attributes(node),
    }
}

fn attributes(node: Node) -> Vec<Attribute> {
    let scalar = |node: &Node| !node.children().any(|child| child.is_element());
    children(node, "attribute")
        .filter(scalar)
        .map(|node| Attribute {
            id: attribute(node, "id"),
            unit: attribute(node, "unit"),
            value: node.text().unwrap_or_default().trim().to_owned(),
        })
        .collect()
}

fn relation(node: Node) -> Relation {
    Relation {
        kind: attribute(node, "type"),
        refs: children(node, "ref")
            .map(|node| (attribute(node, "role"), attribute(node, "id")))
            .collect(),
    }
}

fn load_case(node: Node) -> LoadCase {
    LoadCase {
        id: attribute(node, "id"),
        components: children(node, "component")
            .map(|node| (attribute(node, "id"), attributes(node)))
            .collect(),
    }
}
