//! Maps that vary a surface from place to place.

use luthier_lut::Image;
use luthier_manifest::MapSlot;
use luthier_material::{FlakeSource, Material, VariationSource};

use crate::kinds::thickness::relief::{Field, Relief};

/// Side of the maps that noise is baked to.
const NOISE_SIDE: u32 = 256;

/// A map of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialMap {
    /// Quantity that the map varies.
    pub slot: MapSlot,
    /// The layer that it is of; `None` for those of the whole surface.
    pub layer: Option<u32>,
    /// Where it comes from.
    pub source: MapSource,
}

/// Where a map comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum MapSource {
    /// An image, by its path relative to the material file: shipped as it is.
    File(String),
    /// Fractal gradient noise.
    Noise {
        /// Seed of the noise.
        seed: u32,
        /// Lattice cells of the first octave along one repeat.
        frequency: f64,
        /// Octaves.
        octaves: u32,
    },
}

impl MapSource {
    /// The source in words, for manifests.
    pub fn label(&self) -> String {
        match self {
            Self::File(path) => path.clone(),
            Self::Noise { seed, frequency, octaves } => {
                format!("Perlin noise, seed {seed}, frequency {frequency}, {octaves} octaves")
            }
        }
    }

    /// The texels of noise, one channel in 0..=1, centres at (i + 1/2) / size; `None` for a file.
    pub fn texels(&self) -> Option<Image> {
        let &Self::Noise { seed, frequency, octaves } = self else { return None };
        let relief = Relief::Noise { seed, frequency, octaves };
        let field = Field::new(&relief, [NOISE_SIDE; 2]);
        let mut image = Image::zeros(NOISE_SIDE, NOISE_SIDE, 1);
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(NOISE_SIDE);
        for j in 0..NOISE_SIDE {
            for i in 0..NOISE_SIDE {
                image.texel_mut(i, j)[0] = field.unit([at(i), at(j)]) as f32;
            }
        }
        Some(image)
    }
}

/// The maps of a material: layers from the top down, then effects.
pub(crate) fn maps(material: &Material) -> Vec<MaterialMap> {
    let file = |slot, layer, path: &str| MaterialMap { slot, layer, source: MapSource::File(path.to_owned()) };
    let mut maps = Vec::new();
    for (i, layer) in material.layers.iter().enumerate() {
        maps.extend(layer.maps.named().map(|map| file(map.slot, Some(i as u32), map.path)));
    }
    if let Some(flakes) = &material.effects.flakes
        && let FlakeSource::NormalMap { path } = &flakes.source
    {
        maps.push(file(MapSlot::FlakeNormal, None, path));
    }
    if let Some(patina) = &material.effects.patina {
        let source = match &patina.map {
            VariationSource::Image { path } => MapSource::File(path.clone()),
            &VariationSource::Noise { seed, frequency, octaves } => MapSource::Noise { seed, frequency, octaves },
        };
        maps.push(MaterialMap { slot: MapSlot::Patina, layer: None, source });
    }
    maps
}
