//! Values as bytes that are taken up whole and unchanged, or not at all.
//!
//! ```text
//! kind (8 bytes) | version (4) | length of the content (8) | content | XXH3 of all that comes before (8)
//! ```
//!
//! Numbers are little-endian. The content is in the format of the crate postcard, in which every number keeps its bits.
//! XXH3 (Collet; 64 bits, seed 0) is a checksum, no signature: it tells damage, not intent. So whoever takes up a content
//! still looks whether its parts fit together.

use serde::{Serialize, de::DeserializeOwned};
use twox_hash::XxHash3_64;

/// What the bytes are of, and in which layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seal {
    /// How the bytes begin.
    pub kind: [u8; 8],
    /// Raised whenever the content changes its layout.
    pub version: u32,
}

/// Why bytes were not taken up.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SealError {
    /// They begin otherwise.
    #[error("it does not begin as one")]
    OtherKind,
    /// Another layout.
    #[error("it is of version {found}, and this is for version {wanted}: make it again")]
    Version {
        /// Of the bytes.
        found: u32,
        /// What can be read.
        wanted: u32,
    },
    /// Bytes were changed, lost or added.
    #[error("it is damaged: {0}")]
    Damaged(&'static str),
    /// The checksum is right and the content is none.
    #[error("its content is not readable: {0}")]
    Content(String),
}

const HEAD: usize = 20;
const SUM: usize = 8;

/// XXH3, 64 bits: the same on every machine.
pub fn digest(bytes: &[u8]) -> u64 {
    XxHash3_64::oneshot(bytes)
}

impl Seal {
    /// The value as bytes.
    ///
    /// # Panics
    /// If the value's `Serialize` fails, as no derived one does.
    pub fn close<T: Serialize>(self, value: &T) -> Vec<u8> {
        let mut bytes = vec![0; HEAD];
        bytes = postcard::to_extend(value, bytes).expect("numbers, names and lists of them are always written");
        let length = (bytes.len() - HEAD) as u64;
        bytes[..8].copy_from_slice(&self.kind);
        bytes[8..12].copy_from_slice(&self.version.to_le_bytes());
        bytes[12..HEAD].copy_from_slice(&length.to_le_bytes());
        let sum = digest(&bytes);
        bytes.extend(sum.to_le_bytes());
        bytes
    }

    /// The value again, bit for bit.
    ///
    /// # Errors
    /// [`SealError`] for any bytes but those that [`Self::close`] gave for such a value.
    pub fn open<T: DeserializeOwned>(self, bytes: &[u8]) -> Result<T, SealError> {
        let damaged = SealError::Damaged;
        if !bytes.starts_with(&self.kind) {
            return Err(SealError::OtherKind);
        }
        let end = bytes.len().checked_sub(SUM).filter(|&end| end >= HEAD).ok_or(damaged("it is cut short"))?;
        let (sealed, sum) = bytes.split_at(end);
        if word(&sealed[12..HEAD]) != (end - HEAD) as u64 {
            return Err(damaged("it has another length than it says"));
        }
        if word(sum) != digest(sealed) {
            return Err(damaged("its checksum is another one"));
        }
        let found = word(&sealed[8..12]) as u32;
        if found != self.version {
            return Err(SealError::Version { found, wanted: self.version });
        }
        match postcard::take_from_bytes(&sealed[HEAD..]) {
            Ok((value, [])) => Ok(value),
            Ok(_) => Err(SealError::Content("there is more than one value".into())),
            Err(error) => Err(SealError::Content(error.to_string())),
        }
    }
}

/// Up to eight bytes as a little-endian number.
fn word(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte))
}

#[cfg(test)]
mod tests {
    use super::{HEAD, Seal, SealError, digest};

    const SEAL: Seal = Seal { kind: *b"TESTKIND", version: 7 };
    type Value = (String, Vec<f64>, Option<u64>);

    fn value() -> Value {
        ("a name".into(), vec![-0.0, f64::NAN, f64::INFINITY, 5e-324], Some(u64::MAX))
    }

    #[test]
    fn every_number_keeps_its_bits() {
        let (name, numbers, word): Value = SEAL.open(&SEAL.close(&value())).unwrap();
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!((name, bits(&numbers), word), (value().0, bits(&value().1), value().2));
    }

    /// Published in the reference implementation's test vectors: XXH3_64bits of nothing with seed 0.
    #[test]
    fn the_checksum_is_xxh3() {
        assert_eq!(digest(b""), 0x2d06_8005_38d3_94c2);
    }

    #[test]
    fn every_change_of_a_bit_is_noticed() {
        let bytes = SEAL.close(&value());
        for bit in 0..8 * bytes.len() {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert!(SEAL.open::<Value>(&changed).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn more_or_fewer_bytes_are_noticed() {
        let bytes = SEAL.close(&value());
        (0..bytes.len()).for_each(|length| assert!(SEAL.open::<Value>(&bytes[..length]).is_err(), "{length}"));
        let longer = [&bytes[..], &[0]].concat();
        assert!(matches!(SEAL.open::<Value>(&longer), Err(SealError::Damaged(_))));
        assert!(SEAL.open::<Value>(&[&bytes[..], &bytes[..]].concat()).is_err());
    }

    #[test]
    fn another_kind_or_version_is_refused() {
        let bytes = SEAL.close(&value());
        let other = Seal { kind: *b"TESTKINE", ..SEAL };
        assert_eq!(other.open::<Value>(&bytes).unwrap_err(), SealError::OtherKind);
        let newer = Seal { version: 8, ..SEAL };
        assert_eq!(newer.open::<Value>(&bytes).unwrap_err(), SealError::Version { found: 7, wanted: 8 });
    }

    /// With a right checksum too: a length that promises more than there is costs no memory.
    #[test]
    fn a_forged_content_is_no_value() {
        let endless = SEAL.close(&(String::new(), u64::MAX / 16));
        assert!(matches!(SEAL.open::<Value>(&endless), Err(SealError::Content(_))));
        let two = SEAL.close(&(value(), 0_u8));
        assert!(matches!(SEAL.open::<Value>(&two), Err(SealError::Content(_))));
        assert!(two.len() > HEAD);
    }
}
