//! Textures of glTF as pictures of material files.

use std::collections::BTreeMap;
use std::sync::Arc;

use luthier_mesh::Asset;

use super::document::{Texture, Transform};
use crate::draft::number;
use crate::pictures::{Pictures, Texels};
use crate::rules;

/// The wrapping mode of samplers that repeats, and the default.
const REPEAT: u64 = 10497;

/// Largest scale and offset of a placement, and 1 over the smallest scale. Others show no picture, and are left out.
const PLACED_MAX: f64 = 1e6;

/// Use of the texels of a picture as it is.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Use {
    pub(super) channel: Option<&'static str>,
    pub(super) is_srgb: bool,
    /// Factor on slopes of normals.
    pub(super) scale: Option<f64>,
}

/// The textures of a file, and the pictures made of them.
pub(super) struct Textures<'a> {
    asset: &'a Asset<'a>,
    pictures: Pictures,
}

impl<'a> Textures<'a> {
    pub(super) fn new(asset: &'a Asset<'a>) -> Self {
        Self { asset, pictures: Pictures::default() }
    }

    pub(super) fn into_files(self) -> BTreeMap<String, Vec<u8>> {
        self.pictures.into_files()
    }

    /// The picture of a texture as it is, as TOML.
    pub(super) fn unchanged(&mut self, texture: &Texture, used: Use) -> Result<String, String> {
        let image = self.image(texture)?;
        let (asset, name) = (self.asset, self.name(image));
        let path = self.pictures.unchanged(image, &name, || bytes(asset, image))?;
        let words = [
            used.channel.map(|channel| format!("channel = \"{channel}\"")),
            used.is_srgb.then(|| "srgb = true".to_owned()),
            used.scale.filter(|scale| *scale != 1.0).map(|scale| format!("scale = {}", number(scale))),
            transform(texture),
        ];
        Ok(rules::picture(&path, words))
    }

    /// The texels of a texture.
    pub(super) fn texels(&mut self, texture: &Texture) -> Result<Arc<Texels>, String> {
        let image = self.image(texture)?;
        let asset = self.asset;
        self.pictures.texels(image, || bytes(asset, image))
    }

    /// A computed picture of one number a texel, as TOML; `key` says by what it was computed, and `name` what it is.
    pub(super) fn number(
        &mut self,
        name: &str,
        key: &str,
        sources: [Option<&Texture>; 2],
        of: impl Fn([f64; 4], [f64; 4]) -> f64,
    ) -> Result<String, String> {
        let (name, key, texels) = self.named(name, key, sources)?;
        let path = self.pictures.computed(&name, &key, texels.each_ref().map(Option::as_deref), |a, b| [of(a, b)])?;
        Ok(table(&path, sources))
    }

    /// A computed picture of three numbers a texel, as TOML.
    pub(super) fn color(
        &mut self,
        name: &str,
        key: &str,
        sources: [Option<&Texture>; 2],
        of: impl Fn([f64; 4], [f64; 4]) -> [f64; 3],
    ) -> Result<String, String> {
        let (name, key, texels) = self.named(name, key, sources)?;
        let path = self.pictures.computed(&name, &key, texels.each_ref().map(Option::as_deref), of)?;
        Ok(table(&path, sources))
    }

    /// One white texel, as TOML.
    pub(super) fn white(&mut self) -> Result<String, String> {
        let path = self.pictures.computed("white", "white", [None, None], |_, _| [1.0])?;
        Ok(rules::picture(&path, []))
    }

    #[expect(clippy::type_complexity, reason = "a name, a key, and texels of up to two pictures")]
    fn named(
        &mut self,
        name: &str,
        key: &str,
        sources: [Option<&Texture>; 2],
    ) -> Result<(String, String, [Option<Arc<Texels>>; 2]), String> {
        let mut texels = [None, None];
        let (mut stem, mut full_key) = (String::new(), key.to_owned());
        for (source, place) in sources.into_iter().zip(&mut texels) {
            let Some(texture) = source else {
                full_key.push_str(" -");
                continue;
            };
            let image = self.image(texture)?;
            if stem.is_empty() {
                stem = self.name(image);
            }
            full_key.push_str(&format!(" {image}"));
            *place = Some(self.texels(texture)?);
        }
        Ok((format!("{stem}-{name}"), full_key, texels))
    }

    /// Whether a texture is repeated where coordinates leave 0 to 1.
    pub(super) fn repeats(&self, texture: &Texture) -> bool {
        let sampler = self.asset.json["textures"][texture.index]["sampler"].as_u64();
        let sampler = sampler.map(|number| &self.asset.json["samplers"][number as usize]);
        let wraps = |name: &str| sampler.and_then(|sampler| sampler[name].as_u64()).is_none_or(|mode| mode == REPEAT);
        wraps("wrapS") && wraps("wrapT")
    }

    fn image(&self, texture: &Texture) -> Result<usize, String> {
        let found = &self.asset.json["textures"][texture.index];
        if found.is_null() {
            return Err(format!("there is no texture {}", texture.index));
        }
        let webp = found["extensions"]["EXT_texture_webp"]["source"].as_u64();
        let source = found["source"].as_u64().or(webp);
        source.map(|source| source as usize).ok_or_else(|| {
            match found["extensions"].as_object().and_then(|names| names.keys().next()) {
                Some(name) => format!("its picture is there as {name} alone, which is not read"),
                None => "it names no picture".to_owned(),
            }
        })
    }

    fn name(&self, image: usize) -> String {
        self.asset.picture_name(image).map_or_else(|| format!("picture-{image}"), str::to_owned)
    }
}

fn bytes(asset: &Asset<'_>, image: usize) -> Result<Vec<u8>, String> {
    asset.picture(image).map_err(|error| error.to_string())
}

fn table(path: &str, sources: [Option<&Texture>; 2]) -> String {
    rules::picture(path, [sources.into_iter().flatten().next().and_then(transform)])
}

/// The placement of a texture over texture coordinates, as TOML. glTF turns by the same angle the other way round: from v towards u.
fn transform(texture: &Texture) -> Option<String> {
    let Transform { offset, rotation, scale, .. } = shown(texture.extensions.transform.as_ref()?);
    rules::placement(offset, -rotation.to_degrees(), scale)
}

/// Texture coordinates in the placement of a texture.
pub(super) fn placed(texture: &Texture, uv: [f64; 2]) -> [f64; 2] {
    let Some(transform) = &texture.extensions.transform else { return uv };
    let Transform { offset, rotation, scale, .. } = shown(transform);
    let ([u, v], (sin, cos)) = ([scale[0] * uv[0], scale[1] * uv[1]], libm::sincos(rotation));
    [cos * u + sin * v + offset[0], cos * v - sin * u + offset[1]]
}

/// A placement without numbers that are left out, see [`PLACED_MAX`].
fn shown(transform: &Transform) -> Transform {
    Transform {
        offset: transform.offset.map(|v| if v.abs() < PLACED_MAX { v } else { 0.0 }),
        rotation: libm::fmod(transform.rotation, std::f64::consts::TAU),
        scale: transform.scale.map(|v| if v.abs() < PLACED_MAX && v.abs() * PLACED_MAX > 1.0 { v } else { 1.0 }),
        tex_coord: transform.tex_coord,
    }
}

/// Whether a placement has numbers that are left out: see [`PLACED_MAX`].
pub(super) fn is_odd(texture: &Texture) -> bool {
    texture.extensions.transform.as_ref().is_some_and(|Transform { offset, scale, .. }| {
        offset.iter().any(|v| v.abs() >= PLACED_MAX)
            || scale.iter().any(|v| v.abs() >= PLACED_MAX || v.abs() * PLACED_MAX <= 1.0)
    })
}

/// The set of texture coordinates of a texture.
pub(super) fn set(texture: &Texture) -> u32 {
    texture.extensions.transform.as_ref().and_then(|transform| transform.tex_coord).unwrap_or(texture.tex_coord)
}
