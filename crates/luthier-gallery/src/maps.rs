//! Textures of materials for a page.

use luthier_export::Package;
use luthier_lut::{Image, Picture};
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
    /// Two rows each, which make the texture coordinates of the surface's.
    turns: Vec<[[f64; 3]; 2]>,
    texels: String,
}

impl PageMaps {
    /// The textures of a material that the page shows, or `None` where there are none.
    pub(crate) fn of(package: &Package, number: u32) -> Option<Self> {
        let entry = package.manifest.materials.get(number as usize)?;
        let mut maps = Self { slots: Vec::new(), sizes: Vec::new(), turns: Vec::new(), texels: String::new() };
        let mut images = Vec::new();
        for map in package.maps.iter().filter(|map| map.material == number) {
            let Some(slot) = place(map.layer, map.slot).filter(|slot| !maps.slots.contains(slot)) else { continue };
            let stated = entry.maps.iter().find(|stated| (stated.slot, stated.layer) == (map.slot, map.layer));
            let factor = stated.and_then(|stated| stated.factor).unwrap_or([1.0; 3]);
            // Flakes are told apart, and are not averaged.
            let mut image = shrunk(&map.picture, if map.slot == MapSlot::FlakeNormal { u32::MAX } else { LARGEST });
            let channels = image.channels as usize;
            for texel in image.data.chunks_exact_mut(channels) {
                for (value, factor) in texel.iter_mut().zip(factor) {
                    *value *= factor as f32;
                }
            }
            maps.slots.push(slot);
            maps.sizes.push(image.size());
            maps.turns.push(stated.and_then(|stated| stated.transform).unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
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
    let is_map = |layer: u32, slot| entry.maps.iter().any(|map| (map.layer, map.slot) == (Some(layer), slot));
    let shown = entry.shown_layer_maps(Form::Baked).filter(move |(layer, slot)| is_map(*layer, *slot));
    shown.filter(|(layer, slot)| place(Some(*layer), *slot).is_none())
}

/// Place of a map in `view.glsl`, if the page shows it: a map of the whole surface, the albedo of the base, or a lean.
fn place(layer: Option<u32>, map: MapSlot) -> Option<usize> {
    let is_own = layer.is_some_and(|layer| map.is_of_layer_place(layer));
    slot(map).filter(|_| !is_own)
}

/// The texels of a picture, averaged down by halves to so many columns and rows at most; a last odd one is left out.
fn shrunk(picture: &Picture, largest: u32) -> Image {
    let mut image = picture.image();
    while image.width.max(image.height) > largest {
        image = image.halved();
    }
    image
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
        MapSlot::Lean => Some(6),
        MapSlot::Weight => Some(7),
        _ => None,
    }
}
