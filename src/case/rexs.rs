//! Reads a gear model of another program (REXS 1.0 to 2.0) as a case.

mod archive;
mod fields;
mod gear;
mod json;
mod model;
mod operation;
mod refusal;
mod relief;
mod scalar;
mod source;
mod stage;
mod units;
mod xml;

use std::path::{Path, PathBuf};

use super::file::{MOST_MODEL_BYTES, ReadError, read_bytes};
use super::{Case, Document};
use model::Model;
pub use refusal::Refusal;
use source::{Found, Values};
use stage::Kind;
pub use stage::Stage;

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

/// Whether the file name belongs to a REXS model.
#[must_use]
pub fn is_model(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name = name.to_ascii_lowercase();
    [".rexs", ".rexsj", ".rexsz", ".rexs.zip"].iter().any(|ending| name.ends_with(ending))
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
    import(path, &bytes, None)
        .map(|imported| imported.document)
        .map_err(|refusal| ReadError::Model(refusal.to_string()))
}

/// Reads a stage of a REXS model as a case. Without an id, the only spur stage.
///
/// # Errors
/// If the bytes are not a REXS model, or the stage is not a spur gear pair.
pub fn import(path: &Path, bytes: &[u8], stage: Option<&str>) -> Result<Imported, Refusal> {
    let name = path.display().to_string();
    let model = archive::text(bytes).and_then(|text| parse(text.trim_start_matches('\u{feff}')));
    let chosen = model.and_then(|model| {
        let stages = stage::list(&model);
        let chosen = choose(&stages, stage)?.clone();
        Ok((model, stages, chosen))
    });
    let (model, stages, chosen) = chosen.map_err(|refusal| refusal.of(&name))?;
    let values = read(&model, &chosen).map_err(|refusal| refusal.of(&name))?;
    let remarks = values.remarks.clone();
    let (document, absent) = document(&name, &model, &chosen, values);
    Ok(Imported { document, stages, stage: chosen.id, absent, remarks })
}

/// The values of the model for the fields of the case.
fn read(model: &Model, stage: &Stage) -> Result<Values, Refusal> {
    let mut values = Values::default();
    let component = |id: &str| model.component(id);
    let parts = match &stage.kind {
        Kind::Spur { gears, .. } => gears.each_ref().map(|id| component(id)),
        _ => [None, None],
    };
    if let (Some(own), [Some(first), Some(second)]) = (component(&stage.id), parts) {
        let gears = operation::ordered(model, &stage.id, [first, second], &mut values);
        fields::read(model, own, gears, &mut values);
        operation::read(model, &stage.id, gears, &mut values);
    }
    match values.refusals.first() {
        None => Ok(values),
        Some(reason) => Err(Refusal::new(
            format!("stage {} has unequal teeth: {reason}", stage.label()),
            "a case has one module, one pressure angle and symmetric teeth; correct the model",
        )),
    }
}

fn parse(text: &str) -> Result<Model, Refusal> {
    let model = match text.trim_start().chars().next() {
        Some('<') => xml::parse(text)?,
        Some('{') => json::parse(text)?,
        _ => {
            return Err(Refusal::new(
                "the file is neither XML nor JSON",
                "export the model as REXS (.rexs, .rexsj or .rexsz)",
            ));
        }
    };
    let is_known = matches!(model.version.split('.').next(), Some("1" | "2"));
    if is_known {
        return model.indexed();
    }
    Err(Refusal::new(
        format!("the model is of REXS version {:?}", model.version),
        "export it as REXS 1.0 to 2.0",
    ))
}

fn choose<'a>(stages: &'a [Stage], wanted: Option<&str>) -> Result<&'a Stage, Refusal> {
    let listed = || stage::listed(stages);
    if let Some(id) = wanted {
        let found = stages.iter().find(|stage| stage.id == id);
        let stage = found.ok_or_else(|| {
            Refusal::new(
                format!("the model has no stage {id:?}"),
                format!("choose one of its stages: {}", listed()),
            )
        })?;
        return match &stage.kind {
            Kind::Spur { .. } => Ok(stage),
            other => Err(Refusal::new(
                format!("stage {} is {other}", stage.label()),
                "choose a spur stage; other stages cannot become a case",
            )),
        };
    }
    let mut spur = stages.iter().filter(|stage| matches!(stage.kind, Kind::Spur { .. }));
    match (spur.next(), spur.next()) {
        (Some(only), None) => Ok(only),
        (Some(_), Some(_)) => Err(Refusal::new(
            "the model has several spur stages",
            format!("choose one with `tipstrike import --stage ID`: {}", listed()),
        )),
        _ if stages.is_empty() => {
            Err(Refusal::new("the model has no gear stage", "choose a model with a spur stage"))
        }
        _ => Err(Refusal::new(
            "the model has no spur stage",
            format!("choose a model with one; here {}", listed()),
        )),
    }
}

/// The case with these values, the source of each value, and the empty fields.
fn document(
    name: &str,
    model: &Model,
    stage: &Stage,
    values: Values,
) -> (Document, Vec<(&'static str, String)>) {
    let mut case = Case::empty();
    let mut sources: Vec<(&'static str, String)> = Vec::new();
    let mut absent: Vec<(&'static str, String)> = Vec::new();
    for (key, found) in values.into_fields() {
        match found {
            Found::Value { text, source } => match case.set(key, &text) {
                Ok(()) => sources.push((key, format!("From {source}."))),
                Err(problem) => absent.push((key, format!("{source}: {}", problem.cause))),
            },
            Found::Absent(reason) => absent.push((key, reason)),
        }
    }
    let comments = absent.iter().map(|(key, reason)| (*key, format!("Left empty: {reason}.")));
    sources.extend(comments);
    let file = Path::new(name).file_name().unwrap_or_default();
    let notes = format!(
        "stage {} of {} (REXS {}, {} {})",
        stage.id,
        file.to_string_lossy(),
        model.version,
        model.application,
        model.application_version
    );
    // Both are text fields, which accept any text.
    let _ = case.set("title", &stage.title());
    let _ = case.set("notes", &notes);
    let document = Document::commented(format!("{name} (as a case)"), case, &sources);
    (document, absent)
}
