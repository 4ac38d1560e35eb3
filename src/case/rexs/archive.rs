//! The text of a model from its bytes: plain, or from a zip archive with one model, of limited
//! size.

use std::borrow::Cow;
use std::io::{Cursor, Read};

use zip::ZipArchive;
use zip::result::ZipError;

use super::refusal::Refusal;
use crate::case::file::MOST_MODEL_BYTES;

const ZIP: &[u8] = b"PK";
const DIRECTORY_ENTRY: &[u8] = b"PK\x01\x02";
const MOST_FILES: usize = 1000;

/// The text of a model.
pub(super) fn text(bytes: &[u8]) -> Result<Cow<'_, str>, Refusal> {
    let bytes =
        if bytes.starts_with(ZIP) { Cow::Owned(unpacked(bytes)?) } else { Cow::Borrowed(bytes) };
    let text = match bytes {
        Cow::Borrowed(bytes) => std::str::from_utf8(bytes).map(Cow::Borrowed).ok(),
        Cow::Owned(bytes) => String::from_utf8(bytes).map(Cow::Owned).ok(),
    };
    text.ok_or_else(|| {
        Refusal::new("the text of the model is not UTF-8", "export the model as UTF-8")
    })
}

fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Refusal> {
    // Each entry of the directory takes memory, so the entries are counted before it is read.
    let entries = bytes.windows(DIRECTORY_ENTRY.len());
    let entries = entries.filter(|four| *four == DIRECTORY_ENTRY);
    if entries.count() > MOST_FILES {
        return Err(Refusal::new(
            format!("the archive has more than {MOST_FILES} files"),
            "pack the model alone",
        ));
    }
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| damaged(&error))?;
    let models: Vec<String> = archive
        .file_names()
        .filter_map(Result::ok)
        .map(Cow::into_owned)
        .filter(|name| is_model(name))
        .collect();
    let [model] = models.as_slice() else {
        return Err(Refusal::new(
            format!("the archive has {} models", models.len()),
            "pack exactly one .rexs or .rexsj file",
        ));
    };
    let file = archive.by_name(model).map_err(|error| damaged(&error))?;
    let mut text = Vec::new();
    // The size in the directory can be wrong, so the bytes are counted.
    let read = file.take(MOST_MODEL_BYTES as u64 + 1).read_to_end(&mut text);
    read.map_err(|error| damaged(&ZipError::Io(error)))?;
    if text.len() > MOST_MODEL_BYTES {
        return Err(Refusal::new(
            format!("the model is longer than {} MiB unpacked", MOST_MODEL_BYTES >> 20),
            "export the model without results",
        ));
    }
    Ok(text)
}

fn is_model(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    [".rexs", ".rexsj", ".xml", ".json"].iter().any(|ending| name.ends_with(ending))
}

fn damaged(error: &ZipError) -> Refusal {
    Refusal::new(
        format!("the archive cannot be unpacked: {error}"),
        "pack it again as a plain zip file, deflated and without password",
    )
}
