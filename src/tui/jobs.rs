//! What must not keep the screen waiting: looking into folders and files, explaining a result. Each
//! kind has a thread of its own, begun when it is first wanted; of a kind the latest request wins.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::{io, thread};

use super::fault;
use super::latest_request::LatestRequest;
use super::store::case_search::{self, Below};
use super::store::folder::{self, Listing};
use super::store::preview::{self, Preview, Viewport};
use super::store::recents::{self, Recent};
use crate::case::units::System;
use crate::case::{Case, EXAMPLES};
use crate::model::{self, Inputs, Quantity, Stages};
use crate::report::digest::Digest;
use crate::report::explain::{self, Page};

/// Something to look into.
#[derive(Debug, Clone)]
pub enum Job {
    /// What stands in a folder: where the browser is, and the folders typed after it.
    Folder(PathBuf, String),
    /// Which cases stand below a folder.
    Below(PathBuf, String),
    /// What a file or a folder holds.
    Preview(Viewport, System),
    /// Which cases were open last.
    Recents,
    /// What the examples are.
    Examples(System),
    /// Where a result comes from.
    Explain(Box<Asked>),
}

/// What an errand found.
#[derive(Debug, Clone)]
pub enum Finding {
    /// What stands in a folder.
    Folder(Box<Listing>),
    /// Which cases stand below a folder.
    Below(Box<Below>),
    /// What a file or a folder holds.
    Preview(Viewport, Box<Preview>),
    /// The cases that were open last, the latest first.
    Recents(Vec<Recent>),
    /// What the examples are, in their order.
    Examples(Vec<Digest>),
    /// Where a result comes from.
    Explained(Box<Explained>),
    /// A fault of the program, in words.
    Failed(String),
}

/// A result to be explained.
#[derive(Debug, Clone)]
pub struct Asked {
    /// The result.
    pub quantity: &'static Quantity,
    /// The case.
    pub case: Case,
    /// The pair that it describes.
    pub inputs: Inputs,
}

/// The explanation of a result, or why there is none.
#[derive(Debug, Clone)]
pub struct Explained {
    /// The result.
    pub quantity: &'static Quantity,
    /// The page.
    pub page: Result<Box<Page>, String>,
}

/// The threads.
pub struct Jobs {
    tell: Arc<dyn Fn(Finding) -> bool + Send + Sync>,
    slots: [Option<Arc<LatestRequest<Job>>>; Job::KINDS],
}

impl Job {
    const KINDS: usize = 6;

    const fn kind(&self) -> (usize, &'static str) {
        match self {
            Job::Folder(..) => (0, "folders"),
            Job::Preview(..) => (1, "previews"),
            Job::Recents => (2, "recents"),
            Job::Examples(_) => (3, "examples"),
            Job::Explain(_) => (4, "explain"),
            Job::Below(..) => (5, "search"),
        }
    }
}

impl Jobs {
    /// No thread yet; each tells what it found until `tell` says that nobody listens.
    pub fn new(tell: impl Fn(Finding) -> bool + Send + Sync + 'static) -> Jobs {
        Jobs {
            tell: Arc::new(tell),
            slots: [const { None }; Job::KINDS],
        }
    }

    /// Ask, in place of an errand of that kind that has not begun.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn ask(&mut self, errand: Job) -> io::Result<()> {
        let (kind, name) = errand.kind();
        let slot = match &self.slots[kind] {
            Some(slot) => slot,
            None => self.slots[kind].insert(begin(name, Arc::clone(&self.tell))?),
        };
        slot.put(errand);
        Ok(())
    }
}

impl Drop for Jobs {
    fn drop(&mut self) {
        self.slots.iter().flatten().for_each(|slot| slot.close());
    }
}

fn begin(
    name: &'static str,
    tell: Arc<dyn Fn(Finding) -> bool + Send + Sync>,
) -> io::Result<Arc<LatestRequest<Job>>> {
    let slot = Arc::new(LatestRequest::default());
    let theirs: Arc<LatestRequest<Job>> = Arc::clone(&slot);
    thread::Builder::new()
        .name(name.to_owned())
        .spawn(move || {
            while let Some(errand) = theirs.take() {
                let done = catch_unwind(AssertUnwindSafe(|| {
                    fault::on_demand(name);
                    perform(errand, &|_| theirs.is_idle())
                }));
                let told = done.unwrap_or_else(|_| {
                    Some(Finding::Failed(format!(
                        "a fault of the program: {name} cannot be shown"
                    )))
                });
                if told.is_some_and(|told| !tell(told)) {
                    return;
                }
            }
        })?;
    Ok(slot)
}

/// Do an errand; nothing to tell where `go_on` says that it is wanted no more.
#[must_use]
pub fn perform(errand: Job, go_on: &dyn Fn(f64) -> bool) -> Option<Finding> {
    Some(match errand {
        Job::Folder(base, typed) => Finding::Folder(Box::new(folder::list(base, typed))),
        Job::Below(base, typed) => Finding::Below(Box::new(case_search::find(base, typed, go_on)?)),
        Job::Preview(sight, system) => {
            let preview = preview::of(&sight, system, go_on)?;
            Finding::Preview(sight, Box::new(preview))
        }
        Job::Recents => Finding::Recents(recents::looked_at(recents::list())),
        Job::Examples(system) => Finding::Examples(examples(system, go_on)?),
        Job::Explain(asked) => Finding::Explained(Box::new(explained(*asked))),
    })
}

fn examples(system: System, go_on: &dyn Fn(f64) -> bool) -> Option<Vec<Digest>> {
    let digest = |case: &Case| match case.inputs() {
        Ok(inputs) => Digest::solve(case, &inputs, system, go_on),
        Err(_) => Some(Digest::default()),
    };
    EXAMPLES
        .iter()
        .map(|example| digest(&example.document().case))
        .collect()
}

// As `tipstrike explain` does it.
fn explained(asked: Asked) -> Explained {
    let Asked {
        quantity,
        case,
        inputs,
    } = asked;
    let page = match model::solve(&inputs, Stages::of(quantity.stage)) {
        Ok(solution) => Ok(Box::new(explain::explain(
            quantity, &case, &inputs, &solution,
        ))),
        Err(refusal) => Err(format!(
            "Not solved: {refusal}. Correction: {}.",
            refusal.mend()
        )),
    };
    Explained { quantity, page }
}
