//! Loads what `luthier bake` wrote.

use std::collections::HashMap;

use bevy::asset::io::Reader;
use bevy::asset::{
    Asset, AssetLoader, Handle, LoadContext, ParseAssetPathError, ReadAssetBytesError, RenderAssetUsages,
};
use bevy::image::{
    CompressedImageFormats, Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor, ImageType,
    TextureError,
};
use bevy::reflect::TypePath;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::Shader;
use image::imageops::{self, FilterType};
use luthier_manifest::{Form, FunctionGroup, Manifest, ManifestError, MapEntry, MapSlot, ShaderEntry, Target};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::material::LuthierMaterial;
use crate::shader::program;
use crate::surface::Surface;

/// A bake: its manifest and its materials.
#[derive(Asset, TypePath, Debug)]
pub struct LuthierBake {
    /// What the bake says of itself.
    pub manifest: Manifest,
    /// The materials by their names; the label `#NAME` of the manifest's path is the same.
    pub materials: HashMap<String, Handle<LuthierMaterial>>,
}

/// Why a bake is not shown.
#[derive(Debug, Error)]
pub enum LuthierError {
    /// A file cannot be read.
    #[error("{path}: {error}")]
    Read { path: String, error: ReadAssetBytesError },
    /// The manifest cannot be read.
    #[error("{path}: {error}")]
    Manifest { path: String, error: ManifestError },
    /// A file is no text.
    #[error("{0} is no text")]
    Text(String),
    /// A table is no texture that Bevy reads.
    #[error("{path}: {error}")]
    Table { path: String, error: TextureError },
    /// A map is no picture.
    #[error("{path}: {error}")]
    Map { path: String, error: image::ImageError },
    /// The manifest names a path that is none.
    #[error("the manifest names the file {path}: {error}")]
    Path { path: String, error: ParseAssetPathError },
    /// The bake is for another program.
    #[error("{path}: {problem}")]
    Bake { path: String, problem: &'static str },
    /// A material has too many maps.
    #[error("{name} has {maps} maps, and a material has 8 here at most")]
    Maps { name: String, maps: usize },
}

/// How a bake is loaded.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct LuthierSettings {
    /// Whether maps get mipmaps. `luthier preview` reads level 0 alone.
    pub mipmaps: bool,
}

impl Default for LuthierSettings {
    fn default() -> Self {
        Self { mipmaps: true }
    }
}

/// Loads `manifest.json` of a bake, and the shader, tables and maps that it names. Any of them that changes has the bake loaded again.
#[derive(Debug, Default, TypePath)]
pub struct LuthierLoader;

impl AssetLoader for LuthierLoader {
    type Asset = LuthierBake;
    type Settings = LuthierSettings;
    type Error = LuthierError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        settings: &LuthierSettings,
        context: &mut LoadContext<'_>,
    ) -> Result<LuthierBake, LuthierError> {
        let path = context.path().to_string();
        let mut json = String::new();
        if bevy::tasks::futures_lite::AsyncReadExt::read_to_string(reader, &mut json).await.is_err() {
            return Err(LuthierError::Text(path));
        }
        let manifest =
            Manifest::from_json(&json).map_err(|error| LuthierError::Manifest { path: path.clone(), error })?;
        let shader = shown(&manifest).map_err(|problem| LuthierError::Bake { path, problem })?;

        let text = String::from_utf8(read(context, &shader.file.path).await?)
            .map_err(|_| LuthierError::Text(shader.file.path.clone()))?;
        let interface = shader.interface.clone().unwrap_or_default();
        let surface = Surface::new(&manifest, &interface, &text)?;
        let wgsl = program(&text, &surface);
        let shader = context.add_labeled_asset("shader", Shader::from_wgsl(wgsl, format!("{}#shader", context.path())));

        let mut tables = HashMap::new();
        for table in &manifest.tables {
            let bytes = read(context, &table.texture.path).await?;
            let image =
                table_image(&bytes).map_err(|error| LuthierError::Table { path: table.texture.path.clone(), error })?;
            tables.insert(
                format!("luthier_{}", table.kind),
                context.add_labeled_asset(format!("table/{}", table.kind), image),
            );
        }
        let table = |name: &str| tables.get(name).cloned();
        let words = read(context, &manifest.material_buffer.path).await?;
        let words = context.add_labeled_asset("numbers", ShaderBuffer::new(&words, RenderAssetUsages::RENDER_WORLD));

        let mut maps = HashMap::<_, Handle<Image>>::new();
        let mut materials = HashMap::new();
        for (number, entry) in (0..).zip(&manifest.materials) {
            let mut textures = Vec::new();
            for map in surface.maps_of(entry) {
                let key = (map.file.path.clone(), map.srgb, map.slot == MapSlot::FlakeNormal);
                if !maps.contains_key(&key) {
                    let bytes = read(context, &map.file.path).await?;
                    let image = map_image(&bytes, map, settings.mipmaps)
                        .map_err(|error| LuthierError::Map { path: map.file.path.clone(), error })?;
                    maps.insert(key.clone(), context.add_labeled_asset(format!("map/{}", maps.len()), image));
                }
                textures.push(maps[&key].clone());
            }
            let map = |i: usize| textures.get(i).cloned();
            let material = LuthierMaterial {
                shader: shader.clone(),
                fresnel: table("luthier_fresnel"),
                distribution: table("luthier_distribution"),
                fgd: table("luthier_fgd"),
                phase: table("luthier_phase"),
                thickness: table("luthier_thickness"),
                film: table("luthier_film"),
                escape: table("luthier_escape"),
                lobes: table("luthier_lobes"),
                materials: words.clone(),
                environment: None,
                irradiance: None,
                numbers: surface.numbers(entry, number),
                map_0: map(0),
                map_1: map(1),
                map_2: map(2),
                map_3: map(3),
                map_4: map(4),
                map_5: map(5),
                map_6: map(6),
                map_7: map(7),
            };
            materials.insert(entry.name.clone(), context.add_labeled_asset(entry.name.clone(), material));
        }
        Ok(LuthierBake { manifest, materials })
    }

    fn extensions(&self) -> &[&str] {
        &["json"]
    }
}

/// The shader of a bake that this crate can draw with, or how to bake anew.
fn shown(manifest: &Manifest) -> Result<&ShaderEntry, &'static str> {
    let shader = manifest.shaders.iter().find(|shader| shader.target == Target::Wgsl && shader.form == Form::Baked);
    let shader = shader.ok_or("the bake has no baked shader in WGSL: bake with --target wgsl --form baked")?;
    if !manifest.functions.has(FunctionGroup::Surface) {
        return Err("the shader takes no normals and maps of a renderer: bake with --functions surface");
    }
    if !manifest.names.is_default() {
        return Err(
            "the names of the bake have a prefix or places of their own: bake without --prefix, --group and --first-binding",
        );
    }
    if manifest.bindings.iter().any(|binding| binding.resource == "buffer<vec4<u32>>") {
        // Bindings of a material of Bevy are fixed when it is compiled: here all tables are textures.
        return Err("a table is in a buffer: bake with --layout filtered");
    }
    Ok(shader)
}

/// The bytes of a file beside the manifest. The bake is loaded again where they change.
async fn read(context: &mut LoadContext<'_>, path: &str) -> Result<Vec<u8>, LuthierError> {
    let file =
        context.path().resolve_embed_str(path).map_err(|error| LuthierError::Path { path: path.to_owned(), error })?;
    context.read_asset_bytes(file).await.map_err(|error| LuthierError::Read { path: path.to_owned(), error })
}

/// The texture of a table, which ends at its edges.
fn table_image(bytes: &[u8]) -> Result<Image, TextureError> {
    let kind = ImageType::Extension("ktx2");
    let mut image = Image::from_buffer(
        bytes,
        kind,
        CompressedImageFormats::NONE,
        false,
        ImageSampler::linear(),
        RenderAssetUsages::RENDER_WORLD,
    )?;
    // Bevy takes a texture of one row for a one-dimensional one.
    image.texture_descriptor.dimension = TextureDimension::D2;
    Ok(image)
}

/// The texture of a map, which repeats; its texels have 8 bits. Normals of flakes have no mipmaps.
fn map_image(bytes: &[u8], map: &MapEntry, mipmaps: bool) -> Result<Image, image::ImageError> {
    let picture = image::load_from_memory(bytes)?.to_rgba8();
    let (width, height) = picture.dimensions();
    let is_cells = map.slot == MapSlot::FlakeNormal;
    let levels = if mipmaps && !is_cells { width.max(height).ilog2() + 1 } else { 1 };
    let mut texels = picture.as_raw().clone();
    for level in 1..levels {
        let smaller =
            imageops::resize(&picture, (width >> level).max(1), (height >> level).max(1), FilterType::Triangle);
        texels.extend_from_slice(smaller.as_raw());
    }
    let size = Extent3d { width, height, depth_or_array_layers: 1 };
    let format = if map.srgb { TextureFormat::Rgba8UnormSrgb } else { TextureFormat::Rgba8Unorm };
    let mut image = Image::new_uninit(size, TextureDimension::D2, format, RenderAssetUsages::RENDER_WORLD);
    image.data = Some(texels);
    image.texture_descriptor.mip_level_count = levels;
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        ..ImageSamplerDescriptor::default()
    });
    Ok(image)
}
