//! The JSON Schemas contain every key of a case and of a result.

use std::collections::BTreeSet;

use crate::program::json;
use serde_json::Value;
use tipstrike::case::FIELDS;
use tipstrike::model::QUANTITIES;

fn keys(object: &Value) -> BTreeSet<&str> {
    object.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn the_schema_of_a_case_has_every_field_and_limit() {
    let schema = json("schema");
    let properties = &schema["properties"];
    for field in &FIELDS {
        let table = match field.table() {
            "" => properties,
            table => &properties[table]["properties"],
        };
        let known = &table[field.name()];
        assert!(known["description"].is_string(), "{}", field.key);
    }
    let limits = keys(&properties["limits"]["properties"]);
    assert!(QUANTITIES.iter().all(|quantity| limits.contains(quantity.key)));
    assert!(properties["spread"]["properties"]["pair.module"]["properties"]["normal"].is_object());
    let variant = &properties["variants"]["additionalProperties"]["properties"];
    for field in &FIELDS {
        assert!(!variant[field.key].is_null(), "{}", field.key);
    }
    assert!(variant["driven"]["properties"]["tip_relief"].is_object());
    assert!(variant["limits.impact_force"].is_object());
    assert_eq!(schema["additionalProperties"], false);
}

#[test]
fn the_schema_of_the_results_has_every_key_that_solve_prints() {
    let schema = json("schema --results");
    for method in ["exact", "dynamic"] {
        let solved = json(&format!("solve TABLE_1 --format json --method {method}"));
        let properties = &schema["properties"];
        assert!(keys(&solved).is_subset(&keys(properties)));
        let quantities = keys(&properties["quantities"]["properties"]);
        assert!(keys(&solved["quantities"]).is_subset(&quantities));
        let stations = keys(&properties["stations"]["items"]["properties"]);
        assert!(keys(&solved["stations"][0]).is_subset(&stations));
    }
}
