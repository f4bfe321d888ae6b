//! Pictures of surroundings that the command line names.

use std::path::Path;

use luthier_environment::Environment;
use luthier_export::{input, sha256};
use luthier_terminal::{Failure, Outcome, complain, files};
use luthier_texture::radiance::{self, Picture};

/// A picture of surroundings, read.
pub(crate) struct Surroundings {
    pub(crate) environment: Environment,
    /// Hash of the file.
    pub(crate) sha256: String,
    /// Texels across and down.
    pub(crate) size: [u32; 2],
    /// Number of values below 0, which were set to 0.
    pub(crate) negative: usize,
}

/// Reads a Radiance HDR or OpenEXR file. Warnings name what was converted, left out or set to 0.
pub(crate) fn read(path: &Path) -> Outcome<Surroundings> {
    let bytes = input::image(path).map_err(files(path, "read"))?;
    let decoded = radiance::decode(&bytes).map_err(|source| unusable(path, source.into()))?;
    let Picture { image: mut map, notes } = decoded;
    for note in notes {
        complain(&format!("warning: {}: {note}", path.display()));
    }
    // Resampling leaves small negative values in many maps.
    let mut negative = 0;
    for value in map.data.iter_mut().filter(|value| **value < 0.0) {
        *value = 0.0;
        negative += 1;
    }
    if negative > 0 {
        complain(&format!("warning: {}: {negative} values are below 0 and count as 0", path.display()));
    }
    let size = [map.width, map.height];
    let environment = Environment::new(map).map_err(|source| unusable(path, source.into()))?;
    Ok(Surroundings { environment, sha256: sha256(&bytes), size, negative })
}

fn unusable(path: &Path, source: anyhow::Error) -> Failure {
    Failure::Input(source.context(path.display().to_string()))
}
