use std::fmt;

use serde::{Deserialize, Serialize};

use crate::Pair;

/// Something that runs the emitted shaders.
pub trait Device {
    /// Name of the adapter, as the report shows it.
    fn name(&self) -> String;

    /// `f cos_theta_i`, linear RGB, of a material for pairs `(wi, wo)` of unit directions: one value per pair, in
    /// order.
    ///
    /// # Errors
    /// What went wrong, in words for the user.
    fn evaluate(&self, form: Form, material: u32, pairs: &[Pair]) -> Result<Vec<[f32; 3]>, String>;
}

/// The two shaders of a bake.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// Reads the tables.
    Baked,
    /// Evaluates everything in ALU, at three wavelengths.
    Full,
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Baked => "baked",
            Self::Full => "full",
        })
    }
}
