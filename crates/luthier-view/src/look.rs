//! Light, exposure and surroundings.

use std::sync::{Arc, OnceLock};

use luthier_gpu::{Backdrop, Environment, GpuError, Light, RenderSettings, Scenery, Sky, ToneMapping};

/// Lighting and display of a material; edited in the window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Exposure in stops.
    pub exposure_stops: f32,
    /// Around +y from +z towards +x, where the light comes from, in degrees.
    pub azimuth_deg: f32,
    /// Elevation above the horizon, in degrees.
    pub elevation_deg: f32,
    /// Factor on the irradiance of the light; 0 is off.
    pub strength: f32,
    /// Number of the surroundings.
    pub surroundings: usize,
    /// True where the surroundings are seen behind the shape.
    pub background: bool,
    /// Tone curve.
    pub tone: ToneMapping,
}

/// Irradiance of the light at strength 1, as in [`RenderSettings::new`].
const IRRADIANCE: [f32; 3] = [1.75, 1.7, 1.62];

impl Look {
    /// The look of the settings: their first directional light, their environment as the first of the surroundings.
    pub fn of(settings: &RenderSettings, tone: ToneMapping) -> Self {
        let light = settings.lights.iter().find_map(|light| match light {
            Light::Directional { direction, irradiance } => Some((*direction, *irradiance)),
            Light::Point { .. } => None,
        });
        let ([x, y, z], irradiance) = light.unwrap_or(([-0.45, 0.7, 0.6], [0.0; 3]));
        Self {
            exposure_stops: libm::log2f(settings.exposure.max(1e-6)),
            azimuth_deg: libm::atan2f(x, z).to_degrees(),
            elevation_deg: libm::atan2f(y, libm::hypotf(x, z)).to_degrees(),
            strength: irradiance[1] / IRRADIANCE[1],
            surroundings: 0,
            background: settings.backdrop == Backdrop::Environment,
            tone,
        }
    }

    /// The direction to the light.
    pub fn direction(&self) -> [f32; 3] {
        let (sin_azimuth, cos_azimuth) = libm::sincosf(self.azimuth_deg.to_radians());
        let (sin_elevation, cos_elevation) = libm::sincosf(self.elevation_deg.to_radians());
        [sin_azimuth * cos_elevation, sin_elevation, cos_azimuth * cos_elevation]
    }

    /// The lights: the one that can be edited, and the others of the settings.
    pub(crate) fn lights(&self, settings: &RenderSettings) -> Vec<Light> {
        let mut others = settings.lights.clone();
        if let Some(edited) = others.iter().position(|light| matches!(light, Light::Directional { .. })) {
            others.remove(edited);
        }
        let irradiance = IRRADIANCE.map(|e| e * self.strength);
        if self.strength > 0.0 {
            others.insert(0, Light::Directional { direction: self.direction(), irradiance });
        }
        others
    }
}

/// Rows of the maps of surroundings that are made of formulas.
const SKY_ROWS: u32 = 256;

/// Environments to choose from.
#[derive(Debug)]
pub(crate) struct Surroundings {
    ready: Vec<(&'static str, Arc<Environment>)>,
    /// Environments that are made when they are chosen, because they take a moment.
    made: Vec<(Scenery, OnceLock<Arc<Environment>>)>,
}

impl Surroundings {
    /// The environment of the settings first, then the built-in ones.
    pub(crate) fn new(settings: &RenderSettings, name: Option<&'static str>) -> Result<Self, GpuError> {
        let studio = Sky::default();
        let dark = Sky::uniform([0.0; 3]);
        let overcast = Sky { ground: [0.12; 3], horizon: [0.55; 3], zenith: [1.0, 1.0, 1.02], ..dark };
        let make = |sky: &Sky| Environment::sky(sky).map(Arc::new);
        let mut all = vec![(name.unwrap_or("studio"), Arc::clone(&settings.environment))];
        if name.is_some() {
            all.push(("studio", make(&studio)?));
        }
        all.push(("overcast", make(&overcast)?));
        all.push(("white furnace", make(&Sky::uniform([1.0; 3]))?));
        all.push(("darkness", make(&dark)?));
        let others = Scenery::ALL.into_iter().filter(|scenery| name != Some(scenery.name()));
        Ok(Self { ready: all, made: others.map(|scenery| (scenery, OnceLock::new())).collect() })
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.ready.iter().map(|(name, _)| *name).chain(self.made.iter().map(|(scenery, _)| scenery.name()))
    }

    /// The environment of a number; the first where there is none.
    pub(crate) fn environment(&self, number: usize) -> &Arc<Environment> {
        match number.checked_sub(self.ready.len()).and_then(|number| self.made.get(number)) {
            Some((scenery, made)) => made
                .get_or_init(|| scenery.environment(SKY_ROWS).map_or_else(|_| Arc::clone(&self.ready[0].1), Arc::new)),
            None => &self.ready.get(number).unwrap_or(&self.ready[0]).1,
        }
    }
}

#[cfg(test)]
mod tests {
    use luthier_gpu::Shape;

    use super::*;

    #[test]
    fn a_look_shows_what_the_settings_show() {
        let settings = RenderSettings::new(Shape::Sphere).unwrap();
        let look = Look::of(&settings, ToneMapping::Shoulder);
        let [Light::Directional { direction, irradiance }] = settings.lights[..] else { panic!("one light") };
        let length = direction.iter().map(|v| v * v).sum::<f32>().sqrt();
        let [Light::Directional { direction: same, irradiance: as_much }] = look.lights(&settings)[..] else {
            panic!("one light")
        };
        direction.iter().zip(same).for_each(|(a, b)| assert!((a / length - b).abs() < 1e-5));
        irradiance.iter().zip(as_much).for_each(|(a, b)| assert!((a - b).abs() < 1e-5));
        assert!(look.exposure_stops.abs() < 1e-6 && !look.background);
    }

    #[test]
    fn a_light_without_strength_is_none() {
        let mut settings = RenderSettings::new(Shape::Sphere).unwrap();
        settings.lights.push(Light::Point { position: [0.0, 2.0, 0.0], intensity: [1.0; 3] });
        let look = Look { strength: 0.0, ..Look::of(&settings, ToneMapping::None) };
        assert!(matches!(look.lights(&settings)[..], [Light::Point { .. }]));
    }
}
