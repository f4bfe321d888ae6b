//! Lights without a body, and their words in the kernel's buffer.

use crate::GpuError;
use crate::context::word;
use crate::error::{check_direction, setting};

/// A light without a visible body. Linear RGB; +y is up.
///
/// ```
/// use luthier_gpu::Light;
///
/// let sun = Light::Directional { direction: [0.0, 1.0, 0.0], irradiance: [3.0; 3] };
/// let red = sun.with_color([1.0, 0.0, 0.0]);
/// assert_eq!(red, Light::Directional { direction: [0.0, 1.0, 0.0], irradiance: [1.0, 0.0, 0.0] });
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// Far away.
    Directional {
        /// Direction to the light; need not be unit.
        direction: [f32; 3],
        /// Irradiance that the light gives to a patch that faces it.
        irradiance: [f32; 3],
    },
    /// Near: irradiance falls with the square of the distance.
    Point {
        /// Its position.
        position: [f32; 3],
        /// Irradiance that the light gives to a patch that faces it at distance 1.
        intensity: [f32; 3],
    },
}

impl Light {
    /// The light with another irradiance or intensity.
    #[must_use]
    pub fn with_color(self, color: [f32; 3]) -> Self {
        match self {
            Self::Directional { direction, .. } => Self::Directional { direction, irradiance: color },
            Self::Point { position, .. } => Self::Point { position, intensity: color },
        }
    }

    pub(crate) fn check(&self) -> Result<(), GpuError> {
        let color = match self {
            Self::Directional { direction, irradiance } => {
                check_direction("lights.direction", *direction)?;
                irradiance
            }
            Self::Point { position, intensity } => {
                if !position.iter().all(|v| v.is_finite()) {
                    return Err(setting("lights.position", format!("{position:?}"), "finite"));
                }
                intensity
            }
        };
        if color.iter().all(|v| v.is_finite() && *v >= 0.0) {
            return Ok(());
        }
        Err(setting("lights", format!("{color:?}"), "irradiance and intensity are finite and not negative"))
    }

    /// Irradiance that the light gives to a place with a unit normal.
    pub(crate) fn irradiance(&self, at: [f64; 3], normal: [f64; 3]) -> [f64; 3] {
        let (to_light, color, falls) = match self {
            Self::Directional { direction, irradiance } => (direction.map(f64::from), irradiance, false),
            Self::Point { position, intensity } => ([0, 1, 2].map(|c| f64::from(position[c]) - at[c]), intensity, true),
        };
        let length_sq: f64 = to_light.iter().map(|v| v * v).sum();
        let cosine = (0..3).map(|c| to_light[c] * normal[c]).sum::<f64>() / length_sq.sqrt();
        let factor = cosine.max(0.0) / if falls { length_sq } else { 1.0 };
        color.map(|v| f64::from(v) * factor)
    }

    /// The words of a light in `picture.wgsl`: direction and 0, or position and 1; then its colour.
    pub(crate) fn words(&self) -> [[f32; 4]; 2] {
        match self {
            Self::Directional { direction, irradiance } => {
                let length = direction.iter().map(|x| x * x).sum::<f32>().sqrt();
                [word(direction.map(|x| x / length), 0.0), word(*irradiance, 0.0)]
            }
            Self::Point { position, intensity } => [word(*position, 1.0), word(*intensity, 0.0)],
        }
    }
}
