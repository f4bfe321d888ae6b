//! Jobs: pure computations, as values.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use luthier_lut::TableKind;
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::graph::Inputs;

/// Changes whenever the same inputs give other bytes than before; part of every key.
const REVISION: u32 = 5;

/// SHA-256 of a job's inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Key([u8; 32]);

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// Kind of a job, by its name: the kind of the table that it makes a tile of, or an intermediate result.
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

/// Result of a job: `TileData` for tiles, a type of its own for intermediate results.
pub(crate) type Output = Box<dyn Any + Send + Sync>;

/// A computation, with everything that decides the result.
pub(crate) trait Job: Any + fmt::Debug + Send + Sync {
    /// The kind, part of the key.
    fn kind(&self) -> JobKind;

    /// Everything that decides the result.
    fn inputs(&self) -> Value;

    /// Jobs whose results this one needs.
    fn dependencies(&self) -> Vec<Arc<dyn Job>> {
        Vec::new()
    }

    /// The result, from those of the dependencies.
    fn run(&self, inputs: &Inputs<'_>) -> Output;

    /// The hash of kind and inputs.
    fn key(&self) -> Key {
        let text = json!({"kind": self.kind().name(), "revision": REVISION, "inputs": self.inputs()}).to_string();
        Key(Sha256::digest(text.as_bytes()).into())
    }
}
