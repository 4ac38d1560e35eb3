//! Reads a gear model of another program (REXS 1.0 to 2.0) as a case.

mod map;
mod model;

use std::borrow::Cow;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

use zip::ZipArchive;
use zip::result::ZipError;

use super::file::{MOST_MODEL_BYTES, ReadError, read_bytes};
use super::sanitize::sanitize;
use super::{Case, Document};
use map::{Pair, Values};
use model::{Index, Model, Node};

/// A stage of a model, converted to a case.
#[derive(Debug)]
pub struct Imported {
    /// The case, without a file, with the source of each value.
    pub document: Document,
    /// The stages of the model, in its order.
    pub stages: Vec<Stage>,
    /// The id of the imported stage.
    pub stage: String,
    /// The empty fields: the key of each field and the reason.
    pub absent: Vec<(&'static str, String)>,
    /// The assumptions of the case, one sentence each.
    pub remarks: Vec<String>,
}

/// A gear stage of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stage {
    /// The id of its component.
    pub id: String,
    /// Its name, which may be empty.
    pub name: String,
    /// Its kind with its article.
    pub kind: String,
    is_spur: bool,
}

impl Stage {
    /// The id and the name of the stage.
    #[must_use]
    pub fn label(&self) -> String {
        if self.name.is_empty() { self.id.clone() } else { format!("{} {:?}", self.id, self.name) }
    }
}

/// Why a model of another program cannot become a case: place, cause and fix.
pub type Refusal = String;

fn refusal(cause: impl std::fmt::Display, fix: impl std::fmt::Display) -> Refusal {
    format!("{cause}: {fix}")
}

/// A refusal at a place of the text.
fn at(line: usize, column: usize, refusal: &str) -> Refusal {
    format!("{line}:{column}: {refusal}")
}

/// Refuses more than `most` of the named parts.
fn within(count: usize, most: usize, parts: &str) -> Result<(), Refusal> {
    if count <= most {
        return Ok(());
    }
    Err(refusal(
        format!("the model has more than {most} {parts}"),
        "export the gear pair alone and without results",
    ))
}

/// Whether the file name belongs to a REXS model.
#[must_use]
pub fn is_model(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    ends_with_any(&name, &[".rexs", ".rexsj", ".rexsz", ".rexs.zip"])
}

fn ends_with_any(name: &str, endings: &[&str]) -> bool {
    let name = name.to_ascii_lowercase();
    endings.iter().any(|ending| name.ends_with(ending))
}

/// The path of the case file beside a model. For a case, the path itself.
#[must_use]
pub fn case_path(path: &Path) -> PathBuf {
    if is_model(path) { path.with_extension("toml") } else { path.to_owned() }
}

/// Reads the only spur stage of a REXS model as a case.
///
/// # Errors
/// If the file cannot be read, or no stage can become a case.
pub fn read_document(path: &Path) -> Result<Document, ReadError> {
    let bytes = read_bytes(path, MOST_MODEL_BYTES)?;
    import(path, &bytes, None).map(|imported| imported.document).map_err(ReadError::Model)
}

/// Reads a stage of a REXS model as a case. Without an id, the only spur stage.
///
/// # Errors
/// If the bytes are not a REXS model, or the stage is not a spur gear pair.
pub fn import(path: &Path, bytes: &[u8], stage: Option<&str>) -> Result<Imported, Refusal> {
    let file = path.display();
    read(path, bytes, stage).map_err(|refusal| sanitize(&format!("{file}: {refusal}")))
}

fn read(path: &Path, bytes: &[u8], wanted: Option<&str>) -> Result<Imported, Refusal> {
    let model = parse(text(bytes)?.trim_start_matches('\u{feff}'))?;
    let index = Index::of(&model)?;
    let components = model::stages(&model);
    let read: Vec<(Stage, Option<Pair>)> =
        components.map(|component| stage(&index, component)).collect();
    let stages: Vec<Stage> = read.iter().map(|(stage, _)| stage.clone()).collect();
    let chosen = choose(&stages, wanted)?;
    let mut values = Values::default();
    if let Some((_, Some(pair))) = read.iter().find(|(stage, _)| stage.id == chosen.id) {
        values.read(pair);
    }
    if let Some(reason) = values.refusals.first() {
        return Err(refusal(
            format!("stage {} has unequal teeth: {reason}", chosen.label()),
            "a case has one module, one pressure angle and symmetric teeth; correct the model",
        ));
    }
    let (stage, remarks) = (chosen.id.clone(), values.remarks);
    let (document, absent) = document(path, &model, chosen, values.fields);
    Ok(Imported { document, stages, stage, absent, remarks })
}

/// The text of a model: plain, or from a zip archive with one model.
fn text(bytes: &[u8]) -> Result<Cow<'_, str>, Refusal> {
    let text = if bytes.starts_with(b"PK") {
        String::from_utf8(unpacked(bytes)?).ok().map(Cow::Owned)
    } else {
        std::str::from_utf8(bytes).ok().map(Cow::Borrowed)
    };
    text.ok_or_else(|| refusal("the text of the model is not UTF-8", "export the model as UTF-8"))
}

fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, Refusal> {
    const DIRECTORY_ENTRY: &[u8] = b"PK\x01\x02";
    const MOST_FILES: usize = 1000;
    let damaged = |error: ZipError| {
        refusal(
            format!("the archive cannot be unpacked: {error}"),
            "pack it again as a plain zip file, deflated and without password",
        )
    };
    // Each entry of the directory takes memory, so the entries are counted before it is read.
    let entries = bytes.windows(DIRECTORY_ENTRY.len()).filter(|four| *four == DIRECTORY_ENTRY);
    if entries.count() > MOST_FILES {
        return Err(refusal(
            format!("the archive has more than {MOST_FILES} files"),
            "pack the model alone",
        ));
    }
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(damaged)?;
    let names = archive.file_names().filter_map(Result::ok).map(Cow::into_owned);
    let models: Vec<String> =
        names.filter(|name| ends_with_any(name, &[".rexs", ".rexsj", ".xml", ".json"])).collect();
    let [model] = models.as_slice() else {
        return Err(refusal(
            format!("the archive has {} models", models.len()),
            "pack exactly one .rexs or .rexsj file",
        ));
    };
    let file = archive.by_name(model).map_err(damaged)?;
    let mut text = Vec::new();
    // The size in the directory can be wrong, so the bytes are counted.
    let read = file.take(MOST_MODEL_BYTES as u64 + 1).read_to_end(&mut text);
    read.map_err(|error| damaged(ZipError::Io(error)))?;
    if text.len() > MOST_MODEL_BYTES {
        return Err(refusal(
            format!("the model is longer than {} MiB unpacked", MOST_MODEL_BYTES >> 20),
            "export the model without results",
        ));
    }
    Ok(text)
}

fn parse(text: &str) -> Result<Model, Refusal> {
    let model = match text.trim_start().chars().next() {
        Some('<') => model::parse_xml(text)?,
        Some('{') => model::parse_json(text)?,
        _ => {
            return Err(refusal(
                "the file is neither XML nor JSON",
                "export the model as REXS (.rexs, .rexsj or .rexsz)",
            ));
        }
    };
    if matches!(model.version.split('.').next(), Some("1" | "2")) {
        return Ok(model);
    }
    Err(refusal(
        format!("the model is of REXS version {:?}", model.version),
        "export it as REXS 1.0 to 2.0",
    ))
}

/// The stage of a component, with its gears if it is a spur stage.
fn stage<'m>(index: &'m Index<'m>, stage: &'m Node) -> (Stage, Option<Pair<'m>>) {
    let pair = Pair::of(index, stage);
    let kind = match &pair {
        Ok(pair) => format!("a spur stage ({} teeth)", pair.teeth()),
        Err(kind) => kind.clone(),
    };
    let (id, name) = (stage.id.to_string(), stage.name.to_string());
    (Stage { id, name, kind, is_spur: pair.is_ok() }, pair.ok())
}

fn choose<'a>(stages: &'a [Stage], wanted: Option<&str>) -> Result<&'a Stage, Refusal> {
    let line = |stage: &Stage| format!("stage {} is {}", stage.label(), stage.kind);
    let listed = || stages.iter().map(line).collect::<Vec<_>>().join("; ");
    let spur: Vec<&Stage> = stages.iter().filter(|stage| stage.is_spur).collect();
    let named = wanted.map(|id| stages.iter().find(|stage| stage.id == id).ok_or(id));
    match (named, &*spur) {
        (Some(Ok(stage)), _) if stage.is_spur => Ok(stage),
        (Some(Ok(other)), _) => {
            Err(refusal(line(other), "choose a spur stage; other stages cannot become a case"))
        }
        (Some(Err(id)), _) => Err(refusal(
            format!("the model has no stage {id:?}"),
            format!("choose one of its stages: {}", listed()),
        )),
        (None, [only]) => Ok(only),
        (None, []) if stages.is_empty() => {
            Err(refusal("the model has no gear stage", "choose a model with a spur stage"))
        }
        (None, []) => Err(refusal(
            "the model has no spur stage",
            format!("choose a model with one; here {}", listed()),
        )),
        (None, _) => Err(refusal(
            "the model has several spur stages",
            format!("choose one with `tipstrike import --stage ID`: {}", listed()),
        )),
    }
}

/// The case with these values, the source of each value, and the empty fields.
fn document(
    path: &Path,
    model: &Model,
    stage: &Stage,
    fields: Vec<map::Found>,
) -> (Document, Vec<(&'static str, String)>) {
    let mut case = Case::empty();
    let (mut comments, mut absent) = (Vec::new(), Vec::new());
    for (key, found) in fields {
        let set = found.and_then(|reading| {
            let problem = case.set(key, &reading.text).err();
            problem.map_or(Ok(reading.source.clone()), |problem| {
                Err(format!("{}: {}", reading.source, problem.cause))
            })
        });
        match set {
            Ok(source) => comments.push((key, format!("From {source}."))),
            Err(reason) => {
                comments.push((key, format!("Left empty: {reason}.")));
                absent.push((key, reason));
            }
        }
    }
    let Stage { id, name, .. } = stage;
    let title = if name.is_empty() { format!("Stage {id}") } else { name.clone() };
    let notes = format!(
        "stage {id} of {} (REXS {}, {} {})",
        path.file_name().unwrap_or_default().to_string_lossy(),
        model.version,
        model.application,
        model.application_version
    );
    // Both are text fields, which accept any text.
    let _ = case.set("title", &title);
    let _ = case.set("notes", &notes);
    let name = format!("{} (as a case)", path.display());
    (Document::commented(name, case, &comments), absent)
}
