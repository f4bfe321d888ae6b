//! Light of pictures that are measured and not shown.

use std::sync::Arc;

use luthier_gpu::{Backdrop, Environment, GpuError, Light, RenderSettings, Sky};
use luthier_terminal::Outcome;

/// Direction of a light that comes from the eye.
pub(crate) const FROM_EYE: [f32; 3] = [0.0, 0.0, 1.0];

/// Direction of the key light of all figures.
pub(crate) const KEY: [f32; 3] = [-0.45, 0.7, 0.6];

/// Surroundings of one radiance.
pub(crate) fn even_sky(radiance: f32) -> Outcome<Arc<Environment>> {
    Ok(Arc::new(Environment::sky(&Sky::uniform([radiance; 3])).map_err(GpuError::from)?))
}

/// One white light far away in dark surroundings.
pub(crate) fn one_light(settings: &mut RenderSettings, dark: &Arc<Environment>, direction: [f32; 3]) {
    settings.lights = vec![Light::Directional { direction, irradiance: [1.0; 3] }];
    settings.environment = dark.clone();
    settings.backdrop = Backdrop::Plain([0.0; 3]);
    // Dark from wherever it comes.
    settings.environment_samples = 1;
}
