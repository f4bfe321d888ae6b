use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::LutError;

/// How a shader evaluates a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// Reads the baked tables.
    Baked,
    /// Computes everything, at three wavelengths; binds the material buffer only.
    Full,
}

impl Form {
    /// Both forms.
    pub const ALL: [Self; 2] = [Self::Baked, Self::Full];

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baked => "baked",
            Self::Full => "full",
        }
    }
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Form {
    type Err = LutError;

    fn from_str(s: &str) -> Result<Self, LutError> {
        Self::ALL.into_iter().find(|form| form.name() == s).ok_or_else(|| LutError::UnknownForm(s.to_owned()))
    }
}
