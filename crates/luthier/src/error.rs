//! Why no package came of files.

use std::io;
use std::path::Path;

use luthier_bake::BakeError;
use luthier_export::PackageError;
use luthier_material::Diagnostic;
use luthier_shader::ShaderError;
use thiserror::Error;

/// Why no package came of files.
///
/// ```
/// use luthier::Error;
///
/// let error = luthier::parse("gold.toml", "schema = 1\nname = \"gold\"\n").unwrap_err();
/// assert!(matches!(&error, Error::Refused { .. }));
/// assert_eq!(error.diagnostics()[0].label, "gold.toml");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read, or a folder not listed.
    #[error("cannot {action} {path}: {source}")]
    File {
        /// The action in words.
        action: &'static str,
        /// The file or folder.
        path: String,
        /// Error of the system.
        source: io::Error,
    },
    /// A folder without material files.
    #[error("no *.toml in the folder {folder}")]
    NoFiles {
        /// The folder.
        folder: String,
    },
    /// Materials that are not valid, or outside the domain of their model.
    #[error("{sentence}")]
    Refused {
        /// The refusal in a sentence.
        sentence: String,
        /// All that is wrong.
        diagnostics: Vec<Diagnostic>,
    },
    /// The materials do not go together, no tables hold their budget, or the observer cancelled the bake.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// No shader came out.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// A map that a material names is no picture.
    #[error("{material}: map {map}: {reason}")]
    Map {
        /// The material file.
        material: String,
        /// The map, as the file names it.
        map: String,
        /// Fault of the picture.
        reason: String,
    },
    /// The parts do not make a package, or it cannot be written.
    #[error(transparent)]
    Package(#[from] PackageError),
}

impl Error {
    /// Diagnostics with places in files, as far as the error has any.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Refused { diagnostics, .. } | Self::Bake(BakeError::Budget { diagnostics, .. }) => diagnostics,
            _ => &[],
        }
    }

    /// An error of the system about a file.
    pub(crate) fn file(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::File { action, path: path.display().to_string(), source }
    }
}
