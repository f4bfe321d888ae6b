//! Errors: settings out of range.

use thiserror::Error;

/// A map, sky or size that no environment can be made of.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{name} = {value}; {allowed}")]
pub struct EnvironmentError {
    /// Name of the setting.
    pub name: &'static str,
    /// Its value.
    pub value: String,
    /// Values that are allowed.
    pub allowed: &'static str,
}

pub(crate) fn setting(name: &'static str, value: String, allowed: &'static str) -> EnvironmentError {
    EnvironmentError { name, value, allowed }
}
