//! Judges that a shader passed before it was given out.

use serde::{Deserialize, Serialize};

use crate::target::Target;

/// One judge that a shader passed when it was emitted.
///
/// ```
/// use luthier_manifest::{Check, Target};
///
/// let check = Check { by: "naga 30".to_owned(), read: Target::Wgsl, capabilities: Some(Vec::new()) };
/// // naga read the WGSL from which this GLSL was translated, not the GLSL.
/// assert!(check.is_of_text(Target::Wgsl) && !check.is_of_text(Target::Glsl450));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Check {
    /// Name and version of the judge: `naga 30.0.1`.
    pub by: String,
    /// Language of the text that it read: that of the shader, or WGSL where it read the module from which the shader was translated.
    pub read: Target,
    /// Names of the capabilities that it allowed beyond core WebGPU; absent for a judge that does not know capabilities.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub capabilities: Option<Vec<String>>,
}

impl Check {
    /// Whether the judge read the very text of a shader in a language.
    pub fn is_of_text(&self, target: Target) -> bool {
        self.read == target
    }
}
