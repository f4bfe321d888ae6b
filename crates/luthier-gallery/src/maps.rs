//! Textures of materials for a page.

use luthier_export::Package;
use luthier_lut::Image;
use luthier_manifest::{Form, MapSlot, MaterialEntry};
use serde::Serialize;

use crate::pack;

/// Columns and rows at most; larger textures are averaged down.
const LARGEST: u32 = 512;

/// Textures of a material.
#[derive(Debug, Serialize)]
pub(crate) struct PageMaps {
    /// Places among the slots of the shader.
    slots: Vec<usize>,
    sizes: Vec<[u32; 2]>,
    texels: String,
}

impl PageMaps {
    /// The textures of a material that the page shows, or `None` where there are none.
    pub(crate) fn of(package: &Package, number: u32) -> Option<Self> {
        let entry = package.manifest.materials.get(number as usize)?;
        let mut maps = Self { slots: Vec::new(), sizes: Vec::new(), texels: String::new() };
        let mut images = Vec::new();
        for map in package.maps.iter().filter(|map| map.material == number) {
            let Some(slot) = place(map.layer, map.slot).filter(|slot| !maps.slots.contains(slot)) else { continue };
            let stated = entry.maps.iter().find(|stated| (stated.slot, stated.layer) == (map.slot, map.layer));
            let factor = stated.and_then(|stated| stated.factor).unwrap_or([1.0; 3]);
            // Flakes are told apart, and are not averaged.
            let mut image = map.image.clone();
            while map.slot != MapSlot::FlakeNormal && image.width.max(image.height) > LARGEST {
                image = halved(&image);
            }
            let channels = image.channels as usize;
            for texel in image.data.chunks_exact_mut(channels) {
                for (value, factor) in texel.iter_mut().zip(factor) {
                    *value *= factor as f32;
                }
            }
            maps.slots.push(slot);
            maps.sizes.push([image.width, image.height]);
            images.push(image);
        }
        if images.is_empty() {
            return None;
        }
        maps.texels = pack::images(&images, true);
        Some(maps)
    }
}

/// The maps of single layers that the model of a material shows in the form `baked`, and a page does not.
pub fn hidden_maps(entry: &MaterialEntry) -> impl Iterator<Item = (u32, MapSlot)> {
    entry.shown_layer_maps(Form::Baked).filter(|(layer, slot)| place(Some(*layer), *slot).is_none())
}

/// Place of a map in `view.glsl`: of one of the whole surface, or of an albedo, of which a material has one.
fn place(layer: Option<u32>, map: MapSlot) -> Option<usize> {
    let is_own = map != MapSlot::Albedo && layer.is_some_and(|layer| map.layer_feature(layer).is_some());
    slot(map).filter(|_| !is_own)
}

/// Half the columns and rows; a last odd one is left out.
fn halved(image: &Image) -> Image {
    let [width, height] = [image.width, image.height].map(|side| (side / 2).max(1));
    let mut half = Image::zeros(width, height, image.channels);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let at = |dx: u32, dy: u32| image.texel((2 * x + dx).min(image.width - 1), (2 * y + dy).min(image.height - 1));
        let texels = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        for (c, value) in half.texel_mut(x, y).iter_mut().enumerate() {
            *value = texels.iter().map(|texel| texel[c]).sum::<f32>() / 4.0;
        }
    }
    half
}

/// Place of a texture in `view.glsl`.
fn slot(slot: MapSlot) -> Option<usize> {
    match slot {
        MapSlot::Normal => Some(0),
        MapSlot::Roughness => Some(1),
        MapSlot::Thickness => Some(2),
        MapSlot::Patina => Some(3),
        MapSlot::FlakeNormal => Some(4),
        MapSlot::Albedo => Some(5),
        _ => None,
    }
}
