//! A REXS model as a list of components and relations, independent of its file format.

use serde::{Deserialize, Deserializer};

use super::refusal::{Refusal, within};
use super::scalar::{one_or_list, scalar};

/// Greatest number of components, references, attributes with a value and so on, together. It
/// limits the memory of a model. A usual model has 225,000 in 16 MiB.
pub(super) const MOST_ENTRIES: usize = 300_000;
const MOST_COMPONENTS: usize = 50_000;
const MOST_STAGES: usize = 200;
const MOST_REFS: usize = 100_000;
const MOST_REFS_OF_RELATION: usize = 50;
/// Greatest number of attributes, relations and load cases of one component.
const MOST_OF_COMPONENT: usize = 1000;
/// Greatest length of a name, an id or a type, in bytes.
const MOST_NAME: usize = 1000;

#[derive(Debug, Default, Deserialize)]
pub(super) struct Model {
    /// The REXS version, such as "1.4".
    #[serde(deserialize_with = "scalar")]
    pub(super) version: String,
    #[serde(default, rename = "applicationId", deserialize_with = "scalar")]
    pub(super) application: String,
    #[serde(default, rename = "applicationVersion", deserialize_with = "scalar")]
    pub(super) application_version: String,
    #[serde(default)]
    pub(super) components: Vec<Component>,
    #[serde(default)]
    pub(super) relations: Vec<Relation>,
    #[serde(
        default,
        rename = "load_spectrum",
        alias = "load_spectrums",
        deserialize_with = "load_cases"
    )]
    pub(super) load_cases: Vec<LoadCase>,
    #[serde(skip)]
    index: Index,
}

/// Positions in the model, sorted by id.
#[derive(Debug, Default)]
struct Index {
    components: Vec<usize>,
    /// A relation and the first of its references to the id.
    refs: Vec<(usize, usize)>,
    /// A load case and its component.
    loads: Vec<(usize, usize)>,
}

/// A part, a material, a load.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Component {
    #[serde(deserialize_with = "scalar")]
    pub(super) id: String,
    /// Its type, such as "cylindrical_gear".
    #[serde(default, rename = "type", deserialize_with = "scalar")]
    pub(super) kind: String,
    #[serde(default, deserialize_with = "scalar")]
    pub(super) name: String,
    #[serde(default)]
    pub(super) attributes: Vec<Attribute>,
}

/// A value of a component, empty if it is not scalar.
#[derive(Debug, PartialEq, Eq, Deserialize)]
pub(super) struct Attribute {
    #[serde(deserialize_with = "scalar")]
    pub(super) id: String,
    /// Empty if no unit is given.
    #[serde(default, deserialize_with = "scalar")]
    pub(super) unit: String,
    /// In JSON, the name of the key is the kind of the value.
    #[serde(
        default,
        alias = "floating_point",
        alias = "integer",
        alias = "boolean",
        alias = "string",
        alias = "enum",
        deserialize_with = "scalar"
    )]
    pub(super) value: String,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct Relation {
    /// Its type, such as "stage".
    #[serde(rename = "type", deserialize_with = "scalar")]
    pub(super) kind: String,
    #[serde(default)]
    pub(super) refs: Vec<Ref>,
}

/// The role and the id of a component in a relation.
#[derive(Debug, Deserialize)]
pub(super) struct Ref {
    #[serde(default, deserialize_with = "scalar")]
    pub(super) role: String,
    #[serde(deserialize_with = "scalar")]
    pub(super) id: String,
}

/// Attributes that one load case of the load spectrum adds to components.
#[derive(Debug, Default, Deserialize)]
pub(super) struct LoadCase {
    #[serde(deserialize_with = "scalar")]
    pub(super) id: String,
    #[serde(default)]
    pub(super) components: Vec<Component>,
}

#[derive(Deserialize)]
struct Spectrum {
    #[serde(default)]
    load_cases: Vec<LoadCase>,
}

fn load_cases<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<LoadCase>, D::Error> {
    let spectra: Vec<Spectrum> = one_or_list(deserializer)?;
    let cases = spectra.into_iter().flat_map(|spectrum| spectrum.load_cases);
    Ok(cases.collect())
}

/// The entries of an id in a list that is sorted by id.
fn of_id<'a, T>(sorted: &'a [T], id: impl Fn(&T) -> &'a str, wanted: &str) -> &'a [T] {
    let start = sorted.partition_point(|entry| id(entry) < wanted);
    let end = sorted.partition_point(|entry| id(entry) <= wanted);
    &sorted[start..end]
}

impl Model {
    /// The model with its index. Refuses a model beyond the limits, and an id of two components.
    pub(super) fn indexed(mut self) -> Result<Model, Refusal> {
        self.check_limits()?;
        let mut components: Vec<usize> = (0..self.components.len()).collect();
        components.sort_unstable_by_key(|&at| self.components[at].id.as_str());
        let mut pairs = components.windows(2);
        let id = |at: usize| &self.components[at].id;
        if let Some(pair) = pairs.find(|pair| id(pair[0]) == id(pair[1])) {
            return Err(Refusal::new(
                format!("two components have the id {:?}", id(pair[0])),
                "correct the model, in which each component has its own id",
            ));
        }
        let refs = self.relations.iter().map(|relation| relation.refs.len());
        let mut refs = places(refs);
        refs.sort_unstable_by_key(|&place| (self.id_of_ref(place), place));
        refs.dedup_by_key(|&mut place| (place.0, self.id_of_ref(place)));
        let groups = refs.chunk_by(|&a, &b| self.id_of_ref(a) == self.id_of_ref(b));
        let most = groups.map(<[_]>::len).max().unwrap_or_default();
        within(most, MOST_OF_COMPONENT, "relations of one component")?;
        let loads = self.load_cases.iter().map(|case| case.components.len());
        let mut loads = places(loads);
        loads.sort_unstable_by_key(|&place| (self.id_of_load(place), place));
        let groups = loads.chunk_by(|&a, &b| self.id_of_load(a) == self.id_of_load(b));
        let most = groups.map(<[_]>::len).max().unwrap_or_default();
        within(most, MOST_OF_COMPONENT, "load cases of one component")?;
        self.index = Index { components, refs, loads };
        Ok(self)
    }

    fn check_limits(&self) -> Result<(), Refusal> {
        within(self.components.len(), MOST_COMPONENTS, "components")?;
        let stages = self.stages().count();
        within(stages, MOST_STAGES, "stages")?;
        let refs = self.relations.iter().map(|relation| relation.refs.len());
        within(refs.clone().sum(), MOST_REFS, "references of relations")?;
        let refs = refs.max().unwrap_or_default();
        within(refs, MOST_REFS_OF_RELATION, "references of one relation")?;
        let loads = self.load_cases.iter().flat_map(|case| &case.components);
        within(loads.clone().count(), MOST_COMPONENTS, "loaded components")?;
        let components = || self.components.iter().chain(loads.clone());
        let attributes = components().map(|component| component.attributes.len());
        let attributes = attributes.max().unwrap_or_default();
        within(attributes, MOST_OF_COMPONENT, "attributes of one component")?;
        let of_components = components().flat_map(|component| {
            let attributes = component.attributes.iter();
            let of_attributes = attributes.flat_map(|attribute| [&attribute.id, &attribute.unit]);
            of_attributes.chain([&component.id, &component.kind, &component.name])
        });
        let of_refs = self.relations.iter().flat_map(|relation| &relation.refs);
        let names = of_components
            .chain(of_refs.flat_map(|one| [&one.id, &one.role]))
            .chain(self.load_cases.iter().map(|case| &case.id))
            .chain([&self.version, &self.application, &self.application_version]);
        let longest = names.map(String::len).max().unwrap_or_default();
        within(longest, MOST_NAME, "bytes in a name")
    }

    fn id_of_ref(&self, (relation, at): (usize, usize)) -> &str {
        &self.relations[relation].refs[at].id
    }

    fn id_of_load(&self, (case, at): (usize, usize)) -> &str {
        &self.load_cases[case].components[at].id
    }

    pub(super) fn stages(&self) -> impl Iterator<Item = &Component> {
        let components = self.components.iter();
        components.filter(|component| component.kind.ends_with("_stage"))
    }

    pub(super) fn component(&self, id: &str) -> Option<&Component> {
        let found = of_id(&self.index.components, |&at| self.components[at].id.as_str(), id);
        found.first().map(|&at| &self.components[at])
    }

    /// The relations of a component.
    pub(super) fn relations_of(&self, id: &str) -> impl Iterator<Item = &Relation> + use<'_> {
        let found = of_id(&self.index.refs, |&place| self.id_of_ref(place), id);
        found.iter().map(|&(relation, _)| &self.relations[relation])
    }

    /// The load cases of a component, each with its attributes.
    pub(super) fn loads_of(
        &self,
        id: &str,
    ) -> impl Iterator<Item = (&LoadCase, &[Attribute])> + use<'_> {
        let found = of_id(&self.index.loads, |&place| self.id_of_load(place), id);
        found.iter().map(|&(case, at)| {
            let case = &self.load_cases[case];
            (case, case.components[at].attributes.as_slice())
        })
    }

    /// The components with the role `other` in the relations of this type in which the component
    /// `id` has the role `role`.
    pub(super) fn related<'a>(
        &'a self,
        kind: &'a str,
        (role, id): (&'a str, &'a str),
        other: &'a str,
    ) -> impl Iterator<Item = &'a Component> {
        self.relations_of(id)
            .filter(move |relation| relation.kind == kind && relation.role(role) == Some(id))
            .filter_map(move |relation| self.component(relation.role(other)?))
    }

    /// The components of a type that share any relation with this component.
    pub(super) fn linked<'a>(
        &'a self,
        id: &'a str,
        kind: &'a str,
    ) -> impl Iterator<Item = &'a Component> {
        self.relations_of(id)
            .flat_map(|relation| &relation.refs)
            .filter(move |other| other.id != id)
            .filter_map(|other| self.component(&other.id))
            .filter(move |component| component.kind == kind)
    }
}

/// Each entry of several lists by its list and its position there.
fn places(lengths: impl Iterator<Item = usize>) -> Vec<(usize, usize)> {
    let lists = lengths.enumerate();
    lists.flat_map(|(list, length)| (0..length).map(move |at| (list, at))).collect()
}

impl Relation {
    /// The id of the component in a role.
    pub(super) fn role(&self, role: &str) -> Option<&str> {
        let found = self.refs.iter().find(|own| own.role == role);
        found.map(|own| own.id.as_str())
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
    attributes.iter().find(|attribute| attribute.id == id && !attribute.value.is_empty())
}
