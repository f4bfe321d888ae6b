//! Hashes of files.

use sha2::{Digest, Sha256};

/// SHA-256 in hex.
///
/// ```
/// let hash = luthier_export::sha256(b"abc");
/// assert_eq!(hash, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
/// ```
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
