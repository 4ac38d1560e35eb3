//! A REXS model as a list of components and relations, independent of its file format.

use std::collections::HashSet;

#[derive(Debug, Default)]
pub(super) struct Model {
    /// The REXS version, such as "1.4".
    pub(super) version: String,
    /// The program and its version.
    pub(super) application: String,
    pub(super) components: Vec<Component>,
    pub(super) relations: Vec<Relation>,
    pub(super) load_cases: Vec<LoadCase>,
}

/// A part, a material, a load.
#[derive(Debug)]
pub(super) struct Component {
    pub(super) id: String,
    /// Its type, such as "cylindrical_gear".
    pub(super) kind: String,
    pub(super) name: String,
    pub(super) attributes: Vec<Attribute>,
}

/// A scalar value of a component.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Attribute {
    pub(super) id: String,
    /// Empty if no unit is given.
    pub(super) unit: String,
    pub(super) value: String,
}

#[derive(Debug)]
pub(super) struct Relation {
    /// Its type, such as "stage".
    pub(super) kind: String,
    /// The role and the id of each component.
    pub(super) refs: Vec<(String, String)>,
}

/// Attributes that one load case of the load spectrum adds to components.
#[derive(Debug)]
pub(super) struct LoadCase {
    pub(super) id: String,
    /// The id of the component and its attributes.
    pub(super) components: Vec<(String, Vec<Attribute>)>,
}

impl Model {
    /// An id of two components.
    pub(super) fn repeated_id(&self) -> Option<&str> {
        let mut known = HashSet::new();
        let mut ids = self
            .components
            .iter()
            .map(|component| component.id.as_str());
        ids.find(|id| !known.insert(*id))
    }

    pub(super) fn component(&self, id: &str) -> Option<&Component> {
        self.components.iter().find(|component| component.id == id)
    }

    /// The components with the role `other` in the relations of this type in which the component
    /// `id` has the role `role`.
    pub(super) fn related<'a>(
        &'a self,
        kind: &'a str,
        (role, id): (&'a str, &'a str),
        other: &'a str,
    ) -> impl Iterator<Item = &'a Component> {
        self.relations
            .iter()
            .filter(move |relation| relation.kind == kind && relation.role(role) == Some(id))
            .filter_map(move |relation| self.component(relation.role(other)?))
    }

    /// The components of a type that share any relation with this component.
    pub(super) fn linked<'a>(
        &'a self,
        id: &'a str,
        kind: &'a str,
    ) -> impl Iterator<Item = &'a Component> {
        self.relations
            .iter()
            .filter(move |relation| relation.refs.iter().any(|(_, other)| other == id))
            .flat_map(|relation| &relation.refs)
            .filter(move |(_, other)| other != id)
            .filter_map(|(_, other)| self.component(other))
            .filter(move |component| component.kind == kind)
    }
}

impl Relation {
    /// The id of the component in a role.
    pub(super) fn role(&self, role: &str) -> Option<&str> {
        let found = self.refs.iter().find(|(own, _)| own == role);
        found.map(|(_, id)| id.as_str())
    }
}

impl Component {
    pub(super) fn attribute(&self, id: &str) -> Option<&Attribute> {
        find(&self.attributes, id)
    }

    /// Every attribute of this id with a value. A valid model has one.
    pub(super) fn given<'a>(&'a self, id: &'a str) -> impl Iterator<Item = &'a Attribute> {
        self.attributes
            .iter()
            .filter(move |attribute| attribute.id == id && !attribute.value.is_empty())
    }

    /// Whether a boolean is given and true.
    pub(super) fn is_true(&self, id: &str) -> bool {
        let value = self.attribute(id).map(|attribute| attribute.value.as_str());
        matches!(value, Some("true" | "1"))
    }

    /// The label in messages, such as `cylindrical_gear 23 "pinion"`.
    pub(super) fn label(&self) -> String {
        if self.name.is_empty() {
            format!("{} {}", self.kind, self.id)
        } else {
            format!("{} {} {:?}", self.kind, self.id, self.name)
        }
    }
}

/// An attribute with a value.
pub(super) fn find<'a>(attributes: &'a [Attribute], id: &str) -> Option<&'a Attribute> {
    attributes
        .iter()
        .find(|attribute| attribute.id == id && !attribute.value.is_empty())
}
