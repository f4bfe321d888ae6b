//! Lists of directions that the command line names.

use std::path::Path;

pub(crate) use luthier_layers::angles::Angles;
use luthier_layers::angles::pairs;
use luthier_terminal::{Failure, Outcome};

use crate::input;

/// Pairs (wi, wo) of a CSV file, or of standard input for `-`.
pub(crate) fn read(path: &Path) -> Outcome<Vec<[Angles; 2]>> {
    let (text, label) = input::labelled(path)?;
    pairs(&text).map_err(|what| Failure::Input(anyhow::anyhow!("{label}{what}")))
}
