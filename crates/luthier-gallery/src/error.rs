//! Reasons why there is no page.

use luthier_environment::EnvironmentError;
use luthier_export::PackageError;
use luthier_shader::ShaderError;
use thiserror::Error;

/// An error of a page.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum GalleryError {
    /// Two materials of one name, which is their address in the page.
    #[error("two materials are named `{name}`, and a name is an address in the page: rename one, or leave one out")]
    Twice {
        /// The name.
        name: String,
    },
    /// A look of a material that is not there.
    #[error("`{name}` has no look, or one of a material that no package has")]
    NoLook {
        /// Name of the exhibit.
        name: String,
    },
    /// No shader came out.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// Texels that are not those of their format.
    #[error(transparent)]
    Package(#[from] PackageError),
    /// Surroundings that cannot be filtered.
    #[error(transparent)]
    Environment(#[from] EnvironmentError),
}
