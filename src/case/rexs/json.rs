//! Reads a model from JSON.

use serde::Deserialize;

use super::model::{MOST_ENTRIES, Model};
use super::refusal::{Refusal, within};

#[derive(Deserialize)]
struct File {
    model: Model,
}

pub(super) fn parse(text: &str) -> Result<Model, Refusal> {
    within(entries(text), MOST_ENTRIES, "objects and lists")?;
    let file: File = serde_json::from_str(text).map_err(|error| {
        let words = error.to_string();
        let cause = words.split(" at line ").next().unwrap_or(&words);
        Refusal::new(format!("this is not a REXS model in JSON: {cause}"), "export the model again")
            .at(error.line(), error.column())
    })?;
    Ok(file.model)
}

/// The number of objects and lists: each can become an entry of the model.
fn entries(text: &str) -> usize {
    let mut bytes = text.bytes();
    let (mut count, mut is_string) = (0, false);
    while let Some(byte) = bytes.next() {
        match byte {
            b'"' => is_string = !is_string,
            b'\\' => {
                bytes.next();
            }
            b'{' | b'[' if !is_string => count += 1,
            _ => {}
        }
    }
    count
}
