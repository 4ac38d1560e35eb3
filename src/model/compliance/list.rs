//! Names and help texts of a list of models.

/// Implements names, help and entries of a choice of models, such as `ToothCompliance`, from the
/// list `MODELS` of the calling file.
macro_rules! listed {
    ($choice:ident, $model:ident) => {
        impl $choice {
            /// Every model, in the order of the list.
            pub const ALL: [$choice; MODELS.len()] = {
                let mut all = [$choice::named(MODELS[0].name); MODELS.len()];
                let mut at = 0;
                while at < MODELS.len() {
                    all[at] = $choice::named(MODELS[at].name);
                    at += 1;
                }
                all
            };

            /// The names in a case file.
            pub const NAMES: [&str; MODELS.len()] = {
                let mut names = [""; MODELS.len()];
                let mut at = 0;
                while at < MODELS.len() {
                    names[at] = MODELS[at].name;
                    at += 1;
                }
                names
            };

            /// One sentence for each model, for the form.
            pub const HELP: &'static str = {
                const HELPS: [&str; MODELS.len()] = {
                    let mut helps = [""; MODELS.len()];
                    let mut at = 0;
                    while at < MODELS.len() {
                        helps[at] = MODELS[at].help;
                        at += 1;
                    }
                    helps
                };
                const LENGTH: usize =
                    $crate::model::compliance::list::length(&$choice::NAMES, &HELPS);
                const BYTES: [u8; LENGTH] =
                    $crate::model::compliance::list::bytes(&$choice::NAMES, &HELPS);
                $crate::model::compliance::list::text(&BYTES)
            };

            /// The entry of the list.
            #[must_use]
            pub fn model(self) -> &'static $model {
                let named = |model: &&'static $model| model.name == self.name();
                MODELS.into_iter().find(named).unwrap_or(MODELS[0])
            }
        }
    };
}

pub(super) use listed;

/// Length of the help of a list, in bytes.
pub(super) const fn length(names: &[&str], helps: &[&str]) -> usize {
    let mut total = 0;
    let mut at = 0;
    while at < names.len() {
        total += names[at].len() + helps[at].len() + ": . ".len();
        at += 1;
    }
    total - 1
}

/// `name: help. name: help.` as bytes.
pub(super) const fn bytes<const N: usize>(names: &[&str], helps: &[&str]) -> [u8; N] {
    let mut bytes = [b' '; N];
    let mut end = 0;
    let mut at = 0;
    while at < names.len() {
        (bytes, end) = put(bytes, end, names[at]);
        (bytes, end) = put(bytes, end, ": ");
        (bytes, end) = put(bytes, end, helps[at]);
        (bytes, end) = put(bytes, end, ".");
        end += 1;
        at += 1;
    }
    bytes
}

const fn put<const N: usize>(mut bytes: [u8; N], mut end: usize, text: &str) -> ([u8; N], usize) {
    let text = text.as_bytes();
    let mut at = 0;
    while at < text.len() {
        bytes[end] = text[at];
        (at, end) = (at + 1, end + 1);
    }
    (bytes, end)
}

pub(super) const fn text(bytes: &'static [u8]) -> &'static str {
    match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => "",
    }
}
