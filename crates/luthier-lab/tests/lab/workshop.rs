//! The command under test.

use luthier_workshop::Program;

pub(crate) struct Lab;

impl Program for Lab {
    const NAME: &'static str = "luthier-lab";
    const PATH: &'static str = env!("CARGO_BIN_EXE_luthier-lab");
}

/// A folder where `luthier-lab` runs.
pub(crate) type Workshop = luthier_workshop::Workshop<Lab>;
