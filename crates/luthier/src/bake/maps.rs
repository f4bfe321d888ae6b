//! Maps as they ship.

use luthier_bake::{MapSource, MaterialMap, height_normals};
use luthier_export::sha256;
use luthier_lut::{Image, Picture, PictureSamples};
use luthier_manifest::{FileEntry, MapEntry};
use luthier_material::Material;
use luthier_texture::png;

use crate::{Error, pictures};

/// A map as it ships: a picture as its material reads it, noise as a grey PNG.
pub(super) fn shipped(material: &Material, map: &MaterialMap) -> Result<(MapEntry, Picture, Vec<u8>), Error> {
    let named = match &map.source {
        MapSource::Picture(named, _) | MapSource::Heights { picture: named, .. } => Some(named),
        MapSource::Noise { .. } => None,
    };
    let (picture, bytes) = drawn(&material.source, &map.source).map_err(|reason| Error::Map {
        material: material.source.clone(),
        map: map.source.label(),
        reason,
    })?;
    let layer = map.layer.map_or_else(String::new, |layer| format!("-{layer}"));
    let path = format!("maps/{}-{}{layer}.png", material.name, map.slot.name());
    let entry = MapEntry {
        slot: map.slot,
        layer: map.layer,
        source: map.source.label(),
        file: FileEntry { path, sha256: sha256(&bytes) },
        width: picture.width,
        height: picture.height,
        factor: map.factor,
        srgb: picture.is_srgb,
        transform: named.and_then(|named| named.transform).map(|transform| transform.matrix()),
    };
    Ok((entry, picture, bytes))
}

/// The texels of a map, and their file.
fn drawn(material: &str, map: &MapSource) -> Result<(Picture, Vec<u8>), String> {
    match map {
        MapSource::Picture(named, texels) => pictures::file(pictures::read(material, named, *texels)?, named),
        MapSource::Heights { picture: named, height } => {
            let normals = height_normals(&pictures::read_image(material, named)?, *height);
            let bytes = png::encode_rgb(normals.width, normals.height, &codes(&normals));
            Ok((bits8(&normals), bytes.map_err(|source| source.to_string())?))
        }
        MapSource::Noise { .. } => {
            let texels = map.texels().unwrap_or_else(|| Image::zeros(1, 1, 1));
            Ok((bits8(&texels), png::encode_gray(&texels).map_err(|source| source.to_string())?))
        }
    }
}

/// Values from 0 to 1 as codes of 8 bits.
fn codes(image: &Image) -> Vec<u8> {
    image.data.iter().map(|value| (255.0 * value.clamp(0.0, 1.0)).round() as u8).collect()
}

/// An image of values from 0 to 1 in steps of 1/255.
fn bits8(image: &Image) -> Picture {
    let Image { width, height, channels, .. } = *image;
    Picture { width, height, channels, is_srgb: false, samples: PictureSamples::Bits8(codes(image)) }
}
