//! Errors: settings out of range.

use thiserror::Error;

/// A map, sky or size that no environment can be made of.
///
/// ```
/// let square = luthier_lut::Image { width: 2, height: 2, channels: 3, data: vec![1.0; 12] };
/// let error = luthier_environment::Environment::new(square).unwrap_err();
/// assert!(error.to_string().ends_with("an RGB map is twice as wide as high"));
/// ```
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
