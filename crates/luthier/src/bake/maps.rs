//! Maps as they ship.

use luthier_bake::{MapSource, MaterialMap, height_normals};
use luthier_export::sha256;
use luthier_lut::{Image, Picture, PictureSamples};
use luthier_manifest::{FileEntry, MapEntry};
use luthier_material::Material;
use luthier_texture::{TextureError, png};

use crate::{Error, pictures};

/// A map as it ships: a picture as its material reads it, noise as a grey PNG.
pub(super) fn shipped(material: &Material, map: &MaterialMap) -> Result<(MapEntry, Picture, Vec<u8>), Error> {
    let unusable = |reason| Error::Map { material: material.source.clone(), map: map.source.label(), reason };
    let sentence = |source: TextureError| unusable(source.to_string());
    let (named, (picture, bytes)) = match &map.source {
        MapSource::Picture(named, texels) => {
            let read = pictures::read(&material.source, named, *texels).map_err(unusable)?;
            (Some(named), pictures::file(read, named).map_err(unusable)?)
        }
        MapSource::Heights { picture: named, height } => {
            let heights = pictures::read_image(&material.source, named).map_err(unusable)?;
            let normals = height_normals(&heights, *height);
            let bytes = png::encode_rgb(normals.width, normals.height, &codes(&normals)).map_err(sentence)?;
            (Some(named), (bits8(&normals), bytes))
        }
        MapSource::Noise { .. } => {
            let texels = map.source.texels().unwrap_or_else(|| Image::zeros(1, 1, 1));
            (None, (bits8(&texels), png::encode_gray(&texels).map_err(sentence)?))
        }
    };
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

/// Values from 0 to 1 as codes of 8 bits.
fn codes(image: &Image) -> Vec<u8> {
    image.data.iter().map(|value| (255.0 * value.clamp(0.0, 1.0)).round() as u8).collect()
}

/// An image of values from 0 to 1 in steps of 1/255.
fn bits8(image: &Image) -> Picture {
    let Image { width, height, channels, .. } = *image;
    Picture { width, height, channels, is_srgb: false, samples: PictureSamples::Bits8(codes(image)) }
}
