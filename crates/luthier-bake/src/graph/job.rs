//! Jobs: pure computations, as values.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use luthier_lut::TableKind;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::graph::{Artefact, Inputs};
use crate::tile::TileData;

/// Revision of the kinds of jobs without a revision of their own.
const REVISION: u32 = 5;

/// SHA-256 of a job's inputs.
///
/// ```
/// use luthier_bake::Key;
///
/// let key = Key::of(b"abc");
/// assert!(key.to_string().starts_with("ba7816bf8f01cfea")); // FIPS 180-2, appendix B.1
/// assert_eq!(Key::parse(&key.to_string()), Some(key));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key([u8; 32]);

impl Key {
    /// The SHA-256 of some bytes.
    pub fn of(bytes: &[u8]) -> Self {
        Self(Sha256::digest(bytes).into())
    }

    /// The hash of all that decides a result.
    pub(super) fn of_inputs(kind: JobKind, revision: u32, inputs: &Value) -> Self {
        Self::of(json!({"kind": kind.name(), "revision": revision, "inputs": inputs}).to_string().as_bytes())
    }

    /// Parses 64 hexadecimal digits, as [`fmt::Display`] writes them.
    pub fn parse(hex: &str) -> Option<Self> {
        let digits: Vec<u8> = hex.chars().map(|c| c.to_digit(16).map(|digit| digit as u8)).collect::<Option<_>>()?;
        let bytes: Vec<u8> = digits.chunks_exact(2).map(|pair| pair[0] << 4 | pair[1]).collect();
        Some(Self(bytes.try_into().ok().filter(|_| digits.len() == 64)?))
    }

    /// The bytes of the hash.
    pub fn bytes(&self) -> &[u8; 32] {
        &self.0
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Kind of a job, by its name: the kind of the table that its tile belongs to, or an intermediate result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JobKind(&'static str);

impl JobKind {
    /// The kind of jobs with an intermediate result.
    pub(crate) const fn part(name: &'static str) -> Self {
        Self(name)
    }

    /// The kind of jobs that make tiles.
    pub(crate) const fn tile(kind: TableKind) -> Self {
        Self(kind.name())
    }

    /// The name in keys and progress reports.
    pub fn name(self) -> &'static str {
        self.0
    }
}

/// A computation, with everything that decides the result.
pub(crate) trait Job: Any + fmt::Debug + Send + Sync {
    /// The kind, part of the key.
    fn kind(&self) -> JobKind;

    /// Number that changes whenever equal inputs give other bytes than before; part of the key. A change of a
    /// dependency's revision need not change it: stores combine the keys of both.
    fn revision(&self) -> u32 {
        REVISION
    }

    /// Everything that decides the result.
    fn inputs(&self) -> Value;

    /// Jobs whose results this one needs.
    fn dependencies(&self) -> Vec<Arc<dyn Job>> {
        Vec::new()
    }

    /// The result, from those of the dependencies.
    fn run(&self, inputs: &Inputs<'_>) -> Artefact;

    /// Reads the bytes that a store kept; `None` for bytes of something else.
    fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        Artefact::decode::<TileData>(bytes)
    }

    /// Whether stores on disk keep the result. False where a read would take as long as the computation.
    fn is_kept(&self) -> bool {
        true
    }

    /// The hash of kind and inputs.
    fn key(&self) -> Key {
        Key::of_inputs(self.kind(), self.revision(), &self.inputs())
    }
}
