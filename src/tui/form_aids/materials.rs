//! Materials of gears. A material fills three fields, and the values of these fields identify the
//! material.

use std::sync::LazyLock;

use serde::Deserialize;

use crate::case::fields::index_of;
use crate::case::{Case, Problem, put_field};
use crate::model::Inputs;
use crate::model::inputs::Gear;

/// A material with the values of its fields as text, and their source.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(crate) struct Material {
    /// Its name, such as `42CrMo4`.
    pub(crate) name: String,
    /// The group of the material, such as `case-hardening steel`.
    pub(crate) group: String,
    /// Young's modulus with its unit.
    pub(crate) young: String,
    /// Poisson's ratio.
    pub(crate) poisson: String,
    /// Density with its unit.
    pub(crate) density: String,
    /// The source of the values.
    pub(crate) source: String,
    /// A note on the values.
    pub(crate) note: String,
    /// The three values in SI.
    #[serde(skip)]
    constants: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct Catalogue {
    material: Vec<Material>,
}

const TEXT: &str = include_str!("../../../assets/materials.toml");

static ALL: LazyLock<Vec<Material>> = LazyLock::new(|| {
    let mut all =
        toml::from_str::<Catalogue>(TEXT).map_or_else(|_| Vec::new(), |file| file.material);
    for material in &mut all {
        let mut made = Case::empty();
        let applied = apply(&mut made, "driver", material);
        material.constants = applied.ok().and_then(|()| constants(&made, "driver"));
    }
    all
});

/// Relative difference below which values are equal: a value may be written in another unit.
const SAME: f64 = 1e-9;

/// Every material, ordered by group.
pub(crate) fn all() -> &'static [Material] {
    &ALL
}

impl Material {
    /// The fields of a gear that the material fills, with their values.
    pub(crate) fn texts(&self) -> [(&'static str, &str); 3] {
        [("young", &self.young), ("poisson", &self.poisson), ("density", &self.density)]
    }
}

/// Writes the three fields of a material into a gear, `driver` or `driven`.
///
/// # Errors
/// As [`Case::set`], if there is no such gear; the case then does not change.
pub(crate) fn apply(case: &mut Case, gear: &str, material: &Material) -> Result<(), Problem> {
    let mut changed = case.clone();
    for (name, text) in material.texts() {
        changed.set(&format!("{gear}.{name}"), text)?;
    }
    *case = changed;
    Ok(())
}

/// The materials with the three values of the gear: several if they have equal values, none if no
/// material matches.
pub(crate) fn of_gear(case: &Case, gear: &str) -> Vec<&'static Material> {
    let Some(own) = constants(case, gear) else {
        return Vec::new();
    };
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * b.abs();
    let fits = |known: [f64; 3]| known.into_iter().zip(own).all(|(a, b)| same(a, b));
    all().iter().filter(|material| material.constants.is_some_and(fits)).collect()
}

/// The material name beside the fields of a gear: `42CrMo4`, or `Steel, 18CrNiMo7-6 or 20CrMnTi` if
/// several materials have these values.
pub(crate) fn name_of_gear(case: &Case, gear: &str) -> Option<String> {
    let found = of_gear(case, gear);
    let (last, others) = found.split_last()?;
    let others: Vec<&str> = others.iter().map(|material| material.name.as_str()).collect();
    let or = if others.is_empty() { "" } else { " or " };
    Some(format!("{}{or}{}", others.join(", "), last.name))
}

/// Young's modulus, Poisson's ratio and density of a gear in SI, if all three are valid.
fn constants(case: &Case, gear: &str) -> Option<[f64; 3]> {
    let mut inputs = Inputs::default();
    for name in ["young", "poisson", "density"] {
        put_field(case, index_of(&format!("{gear}.{name}"))?, &mut inputs).ok()?;
    }
    let Gear { young, poisson, density, .. } =
        if gear == "driver" { inputs.driver } else { inputs.driven };
    Some([young, poisson, density])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn named(name: &str) -> &'static Material {
        let found = all().iter().find(|material| material.name == name);
        found.expect("a material of that name")
    }

    #[test]
    fn every_material_fits_the_fields_and_names_its_source() {
        assert!(all().len() >= 12, "{} materials were read", all().len());
        for material in all() {
            for gear in ["driver", "driven"] {
                let mut case = Case::table_1();
                assert_eq!(apply(&mut case, gear, material), Ok(()), "{}", material.name);
                assert!(case.inputs().is_ok(), "{}", material.name);
            }
            let texts = [&material.name, &material.group, &material.source, &material.note];
            assert!(
                texts.iter().all(|text| !text.trim().is_empty() && text.is_ascii()),
                "{material:?}"
            );
            assert!(
                material.source.len() > 15 && material.source.chars().any(|c| c.is_ascii_digit()),
                "{}",
                material.source
            );
        }
    }

    #[test]
    fn material_names_are_unique_and_sorted_by_group() {
        let names: BTreeSet<String> =
            all().iter().map(|material| material.name.to_lowercase()).collect();
        assert_eq!(names.len(), all().len());
        let mut groups: Vec<&str> = all().iter().map(|material| material.group.as_str()).collect();
        groups.dedup();
        assert_eq!(groups.iter().collect::<BTreeSet<_>>().len(), groups.len(), "{groups:?}");
    }

    #[test]
    fn elastic_constants_are_those_of_their_kind() {
        for material in all() {
            let mut case = Case::empty();
            apply(&mut case, "driver", material).unwrap();
            let [young, poisson, density] = constants(&case, "driver").unwrap();
            let (moduli, densities) = match material.group.as_str() {
                group if group.ends_with("steel") => (195e9..215e9, 7650.0..7900.0),
                "grey cast iron" => (80e9..140e9, 7000.0..7400.0),
                "nodular cast iron" => (165e9..180e9, 7000.0..7300.0),
                "bronze" => (95e9..130e9, 7400.0..8900.0),
                "plastic" => (1e9..5e9, 1000.0..1500.0),
                other => panic!("{other} is a new group"),
            };
            assert!(moduli.contains(&young) && densities.contains(&density), "{material:?}");
            assert!((0.25..=0.4).contains(&poisson), "{material:?}");
        }
    }

    #[test]
    fn a_material_fills_three_fields_and_is_identified_by_them() {
        let mut case = Case::table_1();
        assert_eq!(name_of_gear(&case, "driver"), None);
        apply(&mut case, "driver", named("42CrMo4")).unwrap();
        let text = |key: &str| case.text(index_of(key).unwrap());
        assert_eq!(
            (text("driver.young"), text("driver.density")),
            (Some("210 GPa"), Some("7720 kg/m3"))
        );
        assert_eq!(text("driven.young"), Some("205 GPa"));
        assert_eq!(name_of_gear(&case, "driver").as_deref(), Some("42CrMo4"));
        case.set("driver.young", "210000 N/mm2").unwrap();
        assert_eq!(name_of_gear(&case, "driver").as_deref(), Some("42CrMo4"));
        case.set("driver.density", "7721 kg/m3").unwrap();
        assert_eq!(name_of_gear(&case, "driver"), None);
        case.write(index_of("driver.density").unwrap(), "heavy");
        assert_eq!(name_of_gear(&case, "driver"), None);
    }

    #[test]
    fn materials_of_the_same_values_are_all_named() {
        let mut case = Case::table_1();
        apply(&mut case, "driven", named("Steel")).unwrap();
        assert_eq!(
            name_of_gear(&case, "driven").as_deref(),
            Some("Steel, 18CrNiMo7-6 or 20CrMnTi")
        );
    }

    #[test]
    fn an_unknown_gear_changes_nothing() {
        let mut case = Case::table_1();
        assert!(apply(&mut case, "idler", &all()[0]).is_err());
        assert_eq!(case, Case::table_1());
        assert!(of_gear(&case, "idler").is_empty());
    }
}
