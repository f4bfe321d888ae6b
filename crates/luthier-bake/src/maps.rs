//! Maps that vary a surface from place to place.

use luthier_layers::effects::flakes::Flakes;
use luthier_lut::Image;
use luthier_manifest::{LiveEntry, LiveRange, MapSlot};
use luthier_material::{FlakeSource, Material, PictureRef, TexelUse, VariationSource};
use luthier_optics::stack::Base;

use crate::relief::{Field, Relief};

/// Side of the maps that noise is baked to.
const NOISE_SIDE: u32 = 256;

/// A map of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialMap {
    /// Quantity that the map varies.
    pub slot: MapSlot,
    /// Number of the layer; `None` for maps of the whole surface.
    pub layer: Option<u32>,
    /// Source of its values.
    pub source: MapSource,
    /// Constant of the material file that the map multiplies, see [`luthier_manifest::MapEntry`].
    pub factor: Option<[f64; 3]>,
}

/// Source of the values of a map.
///
/// ```
/// use luthier_bake::MapSource;
///
/// let noise = MapSource::Noise { seed: 7, frequency: 4.0, octaves: 3 };
/// let texels = noise.texels().expect("noise has texels");
/// assert!(texels.data.iter().all(|value| (0.0..=1.0).contains(value)));
/// assert!(noise.label().contains("seed 7"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub enum MapSource {
    /// A picture and the meaning of its texels.
    Picture(PictureRef, TexelUse),
    /// Heights in a picture, from which normals are made.
    Heights {
        /// The picture.
        picture: PictureRef,
        /// Height of white above black, as a share of the width of the picture.
        height: f64,
    },
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
            Self::Picture(picture, _) => picture.label(),
            Self::Heights { picture, height } => format!("{}, normals of heights up to {height}", picture.label()),
            Self::Noise { seed, frequency, octaves } => {
                format!("Perlin noise, seed {seed}, frequency {frequency}, {octaves} octaves")
            }
        }
    }

    /// The texels of noise, one channel in 0..=1, centres at (i + 1/2) / size; `None` for a picture.
    pub fn texels(&self) -> Option<Image> {
        let &Self::Noise { seed, frequency, octaves } = self else { return None };
        let relief = Relief::Noise { seed, frequency, octaves };
        let field = Field::new(&relief, [NOISE_SIDE; 2]);
        let mut image = Image::zeros(NOISE_SIDE, NOISE_SIDE, 1);
        for j in 0..NOISE_SIDE {
            for i in 0..NOISE_SIDE {
                let uv = [i, j].map(|texel| (f64::from(texel) + 0.5) / f64::from(NOISE_SIDE));
                image.texel_mut(i, j)[0] = field.unit(uv) as f32;
            }
        }
        Some(image)
    }
}

/// Normals of a periodic height field, in RGB as [`MapSlot::Normal`] stores them, rounded to steps of 1/255 as in a
/// PNG. `height` is the height of white, as a share of the width.
pub fn height_normals(heights: &Image, height: f64) -> Image {
    let (width, rows) = (heights.width, heights.height);
    // Texels are square.
    let side = 1.0 / f64::from(width);
    let mut normals = Image::zeros(width, rows, 3);
    for y in 0..rows {
        for x in 0..width {
            let neighbours = [[x + width - 1, y], [x + 1, y], [x, y + rows - 1], [x, y + 1]];
            let neighbours = neighbours.map(|[x, y]| height * f64::from(heights.texel(x % width, y % rows)[0]));
            let normal = Flakes::of_heights(neighbours, [side; 2]).to_array();
            let texel = normal.map(|c| ((0.5 + 0.5 * c) * 255.0).round() as f32 / 255.0);
            normals.texel_mut(x, y).copy_from_slice(&texel);
        }
    }
    normals
}

/// The numbers of a material that a program sets at run time.
pub fn live_numbers(material: &Material) -> Vec<LiveEntry> {
    let mut found = Vec::new();
    for (i, (layer, extras)) in material.stack.layers.iter().zip(&material.layers).enumerate() {
        let mut add = |slot: MapSlot, factors: Option<[f64; 2]>| {
            let from = |most: Option<f64>| Some(LiveRange { least: 0.0, most });
            let slab = match &layer.base {
                Base::Dielectric { slab, .. } => (vec![slab.thickness_um], slab.absorption_per_um.to_vec()),
                _ => Default::default(),
            };
            let slopes = || factors.map(|[least, most]| LiveRange { least, most: Some(most) });
            let (default, range, number) = match slot {
                MapSlot::Normal | MapSlot::Bumps | MapSlot::Lean | MapSlot::FlakeNormal => {
                    (vec![0.0, 0.0, 1.0], None, Vec::new())
                }
                MapSlot::Tangent => (vec![1.0, 0.0], None, Vec::new()),
                MapSlot::Roughness | MapSlot::Patina => (vec![1.0], from(Some(1.0)), Vec::new()),
                MapSlot::Thickness => (vec![1.0], from(None), slab.0),
                MapSlot::Absorption => (vec![1.0; 3], from(None), slab.1),
                MapSlot::Weight => {
                    let most = (extras.weight > 0.0).then(|| 1.0 / extras.weight);
                    (vec![1.0], from(most), vec![extras.weight])
                }
                MapSlot::Alpha | MapSlot::AlphaX => (vec![1.0], slopes(), vec![layer.surface.alpha_x]),
                MapSlot::AlphaY => (vec![1.0], slopes(), vec![layer.surface.alpha_y]),
                MapSlot::Albedo => match &layer.base {
                    Base::Diffuse(base) => (base.albedo.to_vec(), from(Some(1.0)), Vec::new()),
                    _ => return,
                },
                // No program sets an F0.
                MapSlot::F0 => return,
                MapSlot::BaseColor | MapSlot::Metallic => {
                    let Some(surface) = extras.metallic else { return };
                    let is_color = slot == MapSlot::BaseColor;
                    let default = if is_color { surface.base_color.to_vec() } else { vec![surface.metallic] };
                    (default, from(Some(1.0)), Vec::new())
                }
            };
            let member = LiveEntry::member_of(slot, i as u32);
            found.push(LiveEntry { slot, layer: i as u32, member, default, range, number });
        };
        let is_live = |slot| extras.live.of(slot).is_some();
        // Functions that take how metallic a place is take its colour, too.
        if is_live(MapSlot::Metallic) && !extras.varies(MapSlot::BaseColor) {
            add(MapSlot::BaseColor, None);
        }
        for number in extras.live.numbers() {
            add(number.slot, number.factors);
        }
    }
    found
}

/// The maps of a material: layers from the top down, then effects.
pub(crate) fn maps(material: &Material) -> Vec<MaterialMap> {
    let mut maps = Vec::new();
    for (i, layer) in material.layers.iter().enumerate() {
        let albedo = match &material.stack.layers[i].base {
            Base::Diffuse(diffuse) => Some(diffuse.albedo),
            _ => None,
        };
        let f0 = match &material.stack.layers[i].base {
            Base::Dielectric { ior, .. } => ior.f0(),
            _ => None,
        };
        let is_metal = layer.metallic.is_some_and(|surface| surface.is_metal);
        maps.extend(layer.maps.named().map(|map| MaterialMap {
            // The F0 of a metal is its base colour.
            slot: if is_metal && map.slot == MapSlot::F0 { MapSlot::BaseColor } else { map.slot },
            layer: Some(i as u32),
            source: MapSource::Picture(map.picture.clone(), map.texels()),
            factor: match map.slot {
                MapSlot::Albedo => albedo,
                MapSlot::F0 if !is_metal => f0,
                MapSlot::BaseColor | MapSlot::F0 => layer.metallic.map(|surface| surface.base_color),
                MapSlot::Metallic => layer.metallic.map(|surface| [surface.metallic; 3]),
                _ => None,
            },
        }));
    }
    let flakes = material.effects.flakes.as_ref().and_then(|flakes| match &flakes.source {
        FlakeSource::NormalMap(normals) => Some(MapSource::Picture(normals.clone(), TexelUse::Normal)),
        FlakeSource::HeightMap { picture, height } => {
            Some(MapSource::Heights { picture: picture.clone(), height: *height })
        }
        FlakeSource::Cells { .. } => None,
    });
    let patina = material.effects.patina.as_ref().map(|patina| match &patina.map {
        VariationSource::Image(picture) => MapSource::Picture(picture.clone(), TexelUse::Number),
        &VariationSource::Noise { seed, frequency, octaves } => MapSource::Noise { seed, frequency, octaves },
    });
    for (slot, source) in [(MapSlot::FlakeNormal, flakes), (MapSlot::Patina, patina)] {
        maps.extend(source.map(|source| MaterialMap { slot, layer: None, source, factor: None }));
    }
    maps
}
