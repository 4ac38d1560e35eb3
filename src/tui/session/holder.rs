//! The process that has a case open, as its lock file names it.

use std::fs::{self, File};
use std::io::{Read, Seek};

use toml_edit::{DocumentMut, Item, value};

use super::clock;
use crate::system::users;

/// Greatest size of a lock file.
const MOST_BYTES: u64 = 4096;

/// The holder of a lock; the process is 0 if the file does not name it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Holder {
    /// The host name.
    pub(crate) host: String,
    /// The process id.
    pub(crate) process: u32,
    /// Start time of the process, in clock ticks since boot: process ids are reused.
    pub(crate) started: u64,
    /// The boot id of the machine.
    pub(crate) boot: String,
    /// Time of the lock, in seconds since 1970.
    pub(crate) since: u64,
}

impl Holder {
    /// This process.
    #[must_use]
    pub(crate) fn ourselves() -> Holder {
        let process = std::process::id();
        Holder {
            host: host(),
            process,
            started: started(process).unwrap_or(0),
            boot: boot(),
            since: clock::now(),
        }
    }

    /// The holder as text for a message.
    #[must_use]
    pub(crate) fn words(&self, now: u64) -> String {
        if self.process == 0 {
            return "an unknown process".to_owned();
        }
        format!(
            "process {} on {} for {}",
            self.process,
            self.host,
            clock::age(now.saturating_sub(self.since))
        )
    }

    /// Whether the same process is still running, as far as this machine can tell.
    pub(crate) fn is_alive(&self) -> bool {
        self.host == host() && self.boot == boot() && started(self.process) == Some(self.started)
    }

    /// The text of the lock file.
    pub(crate) fn to_text(&self) -> String {
        let mut toml = DocumentMut::new();
        toml["host"] = value(&self.host);
        toml["process"] = value(i64::from(self.process));
        toml["started"] = value(self.started.cast_signed());
        toml["boot"] = value(&self.boot);
        toml["since"] = value(self.since.cast_signed());
        format!("# tipstrike has this case open.\n{toml}")
    }

    pub(super) fn read(file: &mut File) -> Option<Holder> {
        let mut text = String::new();
        file.rewind().ok()?;
        file.take(MOST_BYTES).read_to_string(&mut text).ok()?;
        let toml: DocumentMut = text.parse().ok()?;
        let text = |key| toml.get(key).and_then(Item::as_str).map(str::to_owned);
        let number = |key| {
            toml.get(key).and_then(Item::as_integer).and_then(|number| u64::try_from(number).ok())
        };
        Some(Holder {
            host: text("host")?,
            process: number("process")?.try_into().ok()?,
            started: number("started")?,
            boot: text("boot")?,
            since: number("since")?,
        })
    }
}

pub(super) fn host() -> String {
    users::host()
}

fn boot() -> String {
    fs::read_to_string("/proc/sys/kernel/random/boot_id")
        .map(|text| text.trim().to_owned())
        .unwrap_or_default()
}

// Field 22 of `/proc/PID/stat`. Field 2, the name, may contain blanks and brackets.
fn started(process: u32) -> Option<u64> {
    let state = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    state.rsplit_once(')')?.1.split_whitespace().nth(19)?.parse().ok()
}
