//! Stamps of texts: whether a file is still the one that was edited.

use std::hash::Hasher;

use siphasher::sip::SipHasher24;

/// What tells one text from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    /// In bytes.
    pub length: u64,
    /// SipHash-2-4 of the bytes.
    pub hash: u64,
}

impl Stamp {
    /// The stamp of a text.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Stamp {
        Stamp {
            length: bytes.len() as u64,
            hash: hash(bytes),
        }
    }
}

/// SipHash-2-4 with a key of zeros: the same on every machine and in every version.
#[must_use]
pub fn hash(bytes: &[u8]) -> u64 {
    let mut hasher = SipHasher24::new();
    hasher.write(bytes);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_same_for_ever() {
        // SipHash-2-4 (Aumasson & Bernstein 2012) of nothing, under the key of zeros.
        assert_eq!(hash(b""), 0x1e92_4b9d_7377_00d7);
    }
}
