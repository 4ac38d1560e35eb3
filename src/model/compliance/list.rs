//! Names and help texts of a list of models, joined while the program is compiled.

/// How long the help of a list is, in bytes.
pub(super) const fn help_length(names: &[&str], helps: &[&str]) -> usize {
    let mut length = 0;
    let mut at = 0;
    while at < names.len() {
        length += names[at].len() + helps[at].len() + ": . ".len();
        at += 1;
    }
    length - 1
}

/// `name: help. name: help.` as bytes.
pub(super) const fn help_bytes<const N: usize>(names: &[&str], helps: &[&str]) -> [u8; N] {
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

/// The bytes as text.
pub(super) const fn text(bytes: &'static [u8]) -> &'static str {
    match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(_) => "",
    }
}
