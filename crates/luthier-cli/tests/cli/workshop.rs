//! The command under test.

use luthier_workshop::Program;

pub(crate) struct Luthier;

impl Program for Luthier {
    const NAME: &'static str = "luthier";
    const PATH: &'static str = env!("CARGO_BIN_EXE_luthier");
}

/// A folder where `luthier` runs.
pub(crate) type Workshop = luthier_workshop::Workshop<Luthier>;
