//! What `luthier bake` wrote, as a material of Bevy.

use std::fs;
use std::path::Path;

use bevy::asset::{RenderAssetUsages, uuid_handle};
use bevy::image::{CompressedImageFormats, ImageSampler, ImageType};
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, TextureDimension};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;
use serde_json::Value;

/// The text of the bake behind `ball.wgsl`; a material of Bevy knows its shader before there is a bake.
const SHADER: Handle<Shader> = uuid_handle!("6d1d9c0e-53f5-4c0e-9c5d-0d1c2f0f7a3b");

/// A material of the bake. The numbers are those of every bake (docs/bindings.md); a table that no material needs stays
/// out of the shader, and `None` binds Bevy's white texel in its place.
#[derive(Asset, TypePath, AsBindGroup, Debug, Clone)]
pub struct BakedMaterial {
    #[texture(0)]
    #[sampler(5)]
    fresnel: Option<Handle<Image>>,
    #[texture(1)]
    distribution: Option<Handle<Image>>,
    #[texture(2)]
    fgd: Option<Handle<Image>>,
    #[texture(3)]
    phase: Option<Handle<Image>>,
    #[texture(4)]
    thickness: Option<Handle<Image>>,
    #[texture(7)]
    film: Option<Handle<Image>>,
    #[texture(8)]
    escape: Option<Handle<Image>>,
    #[texture(9)]
    lobes: Option<Handle<Image>>,
    #[storage(6, read_only)]
    materials: Handle<ShaderBuffer>,
    /// Number of the material in the bake. Bindings of a program's own start at 16.
    #[uniform(16)]
    material: u32,
}

impl Material for BakedMaterial {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }
}

impl BakedMaterial {
    /// Reads material `name` of the bake in `folder`.
    pub fn open(
        folder: &Path,
        name: &str,
        images: &mut Assets<Image>,
        buffers: &mut Assets<ShaderBuffer>,
        shaders: &mut Assets<Shader>,
    ) -> Result<Self> {
        let manifest: Value = serde_json::from_str(&fs::read_to_string(folder.join("manifest.json"))?)?;
        if manifest["schema"] != 4 {
            return Err(format!("this program reads schema 4 of the manifest, not {}", manifest["schema"]).into());
        }
        let material = entries(&manifest["materials"])?.iter().position(|material| material["name"] == name);
        let material = material.ok_or_else(|| format!("no material `{name}` in the bake"))? as u32;

        let shader = entries(&manifest["shaders"])?.iter();
        let mut shader = shader.filter(|shader| shader["target"] == "wgsl" && shader["form"] == "baked");
        let shader = shader.next().ok_or("no WGSL in the bake")?;
        // Group 0 is Bevy's own.
        let wgsl = fs::read_to_string(folder.join(text(&shader["file"]["path"])?))?
            .replace("@group(0)", "@group(#{MATERIAL_BIND_GROUP})");
        shaders.insert(&SHADER, Shader::from_wgsl(format!("{}\n{wgsl}", include_str!("ball.wgsl")), "ball.wgsl"))?;

        let tables = entries(&manifest["tables"])?;
        // Bindings of a material of Bevy are fixed when it is compiled: here all tables are textures.
        if tables.iter().any(|table| table["format"] == "rgba16float-steps") {
            return Err("a table is in a buffer: bake with --layout filtered".into());
        }
        let mut table = |kind: &str| -> Result<Option<Handle<Image>>> {
            let Some(entry) = tables.iter().find(|table| table["kind"] == kind) else { return Ok(None) };
            let mut image = Image::from_buffer(
                &fs::read(folder.join(text(&entry["texture"]["path"])?))?,
                ImageType::Extension("ktx2"),
                CompressedImageFormats::NONE,
                false,
                ImageSampler::linear(),
                RenderAssetUsages::RENDER_WORLD,
            )?;
            // Bevy takes a texture of one row for a one-dimensional one.
            image.texture_descriptor.dimension = TextureDimension::D2;
            Ok(Some(images.add(image)))
        };
        let words = fs::read(folder.join(text(&manifest["material_buffer"]["path"])?))?;
        Ok(Self {
            fresnel: table("fresnel")?,
            distribution: table("distribution")?,
            fgd: table("fgd")?,
            phase: table("phase")?,
            thickness: table("thickness")?,
            film: table("film")?,
            escape: table("escape")?,
            lobes: table("lobes")?,
            materials: buffers.add(ShaderBuffer::new(&words, RenderAssetUsages::RENDER_WORLD)),
            material,
        })
    }
}

fn entries(value: &Value) -> Result<&[Value]> {
    Ok(value.as_array().ok_or_else(|| format!("{value} should be a list"))?)
}

fn text(value: &Value) -> Result<&str> {
    Ok(value.as_str().ok_or_else(|| format!("{value} should be a string"))?)
}
