use std::path::{Component, Path, PathBuf};

use luthier_lut::{AtlasLayout, FileEntry, Image, Manifest, MapEntry, MapSlot, TableEntry, TableKind, TexelFormat};
use luthier_texture::{ktx2, png};
use sha2::{Digest, Sha256};

use crate::GpuError;
use crate::error::describe;

/// What the runtime needs of a bake: the manifest, the texels of its tables, the text of its WGSL shaders.
#[derive(Debug, Clone, PartialEq)]
pub struct Artefacts {
    /// What the bake made.
    pub manifest: Manifest,
    /// One entry per table of the manifest, in its order.
    pub tables: Vec<TableTexels>,
    /// The WGSL shaders, one per form.
    pub shaders: Vec<WgslShader>,
    /// Maps of the materials; a surface without them is the same everywhere.
    pub maps: Vec<MapTexels>,
}

/// A map of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct MapTexels {
    /// Number of the material.
    pub material: u32,
    /// What it says.
    pub slot: MapSlot,
    /// The layer that it is of; `None` for those of the whole surface.
    pub layer: Option<u32>,
    /// RGBA, linear.
    pub image: Image,
}

/// The texels of a table as they ship.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableTexels {
    /// Which table.
    pub kind: TableKind,
    /// Texel format.
    pub format: TexelFormat,
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// Row by row from the top, little-endian.
    pub bytes: Vec<u8>,
}

/// An emitted shader: functions only, no entry point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WgslShader {
    /// `baked` or `full`.
    pub form: String,
    /// The text.
    pub wgsl: String,
}

impl Artefacts {
    /// Loads a bake from its folder: `manifest.json`, then the textures, WGSL shaders and maps that it names. The hash of
    /// every file is checked against the manifest.
    ///
    /// # Errors
    /// When a file is missing, damaged, from another bake or outside the folder, and when the manifest contradicts
    /// itself.
    pub fn load(folder: &Path) -> Result<Self, GpuError> {
        let path = folder.join("manifest.json");
        let json = std::fs::read_to_string(&path).map_err(|source| GpuError::Read { path: path.clone(), source })?;
        let manifest = Manifest::from_json(&json).map_err(|source| GpuError::Manifest { path, source })?;

        let mut tables = Vec::with_capacity(manifest.tables.len());
        for entry in &manifest.tables {
            let (path, bytes) = read(folder, &entry.texture)?;
            let texture = ktx2::decode(&bytes).map_err(|source| GpuError::Texture { path, source })?;
            tables.push(TableTexels {
                kind: entry.kind,
                format: texture.format,
                width: texture.width,
                height: texture.height,
                bytes: texture.bytes,
            });
        }
        let mut shaders = Vec::new();
        for entry in manifest.shaders.iter().filter(|s| s.target == "wgsl") {
            let (path, bytes) = read(folder, &entry.file)?;
            let wgsl = String::from_utf8(bytes).map_err(|_| GpuError::ShaderText { path })?;
            shaders.push(WgslShader { form: entry.form.clone(), wgsl });
        }
        Self::from_parts(manifest, tables, shaders)?.with_maps(|entry| Ok(read(folder, &entry.file)?.1))
    }

    /// The same with the maps that the manifest lists; `read` gives the bytes of their files, PNG.
    ///
    /// # Errors
    /// Those of `read`, and [`GpuError::Texture`].
    pub fn with_maps(mut self, read: impl Fn(&MapEntry) -> Result<Vec<u8>, GpuError>) -> Result<Self, GpuError> {
        self.maps.clear();
        for (material, entry) in self.manifest.materials.iter().enumerate() {
            for map in &entry.maps {
                let path = PathBuf::from(&map.file.path);
                let image = png::decode(&read(map)?).map_err(|source| GpuError::Texture { path, source })?;
                let (slot, layer) = (map.slot, map.layer);
                self.maps.push(MapTexels { material: material as u32, slot, layer, image });
            }
        }
        Ok(self)
    }

    /// The same from memory, without maps. Tables may come in any order.
    ///
    /// # Errors
    /// When a table of the manifest has no texels or others than its entry says, and when there is nothing to shade.
    pub fn from_parts(
        manifest: Manifest,
        mut tables: Vec<TableTexels>,
        shaders: Vec<WgslShader>,
    ) -> Result<Self, GpuError> {
        if manifest.materials.is_empty() {
            return Err(GpuError::NoMaterials);
        }
        if let Some(material) = manifest.materials.iter().find(|m| m.layers.is_empty()) {
            return Err(GpuError::NoLayers { name: material.name.clone() });
        }
        let mut ordered = Vec::with_capacity(manifest.tables.len());
        for entry in &manifest.tables {
            let position = tables.iter().position(|t| t.kind == entry.kind);
            let table = tables.swap_remove(position.ok_or(GpuError::MissingTexels { kind: entry.kind })?);
            check(entry, &table)?;
            ordered.push(table);
        }
        Ok(Self { manifest, tables: ordered, shaders, maps: Vec::new() })
    }

    /// The texels of a table, if the bake has it.
    pub fn table(&self, kind: TableKind) -> Option<&TableTexels> {
        self.tables.iter().find(|t| t.kind == kind)
    }

    /// The shader of a form.
    ///
    /// # Errors
    /// [`GpuError::NoShader`].
    pub fn shader(&self, form: &str) -> Result<&WgslShader, GpuError> {
        self.shaders.iter().find(|s| s.form == form).ok_or_else(|| GpuError::NoShader {
            form: form.to_owned(),
            known: self.shaders.iter().map(|s| s.form.as_str()).collect::<Vec<_>>().join(", "),
        })
    }
}

/// Reads a file of the bake and checks its hash.
fn read(folder: &Path, entry: &FileEntry) -> Result<(PathBuf, Vec<u8>), GpuError> {
    let relative = Path::new(&entry.path);
    if relative.as_os_str().is_empty() || !relative.components().all(|c| matches!(c, Component::Normal(_))) {
        return Err(GpuError::OutsideFolder { path: entry.path.clone() });
    }
    let path = folder.join(relative);
    let bytes = match std::fs::read(&path) {
        Ok(bytes) => bytes,
        Err(source) => return Err(GpuError::Read { path, source }),
    };
    let found: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
    if !found.eq_ignore_ascii_case(&entry.sha256) {
        return Err(GpuError::Hash { path, found, expected: entry.sha256.clone() });
    }
    Ok((path, bytes))
}

fn check(entry: &TableEntry, table: &TableTexels) -> Result<(), GpuError> {
    let kind = entry.kind;
    let size = checked_size(&entry.layout).ok_or(GpuError::Layout { kind })?;
    let bytes = u64::from(size[0]) * u64::from(size[1]) * u64::from(entry.format.texel_bytes());
    let expected = (size, entry.format, bytes);
    let found = ([table.width, table.height], table.format, table.bytes.len() as u64);
    if expected != found {
        return Err(GpuError::TableMismatch {
            kind,
            found: describe(found.0, found.1, found.2),
            expected: describe(expected.0, expected.1, expected.2),
        });
    }
    Ok(())
}

/// [`AtlasLayout::size`] for a layout that may be nonsense: `None` where that would overflow, or where an axis has no
/// interval.
fn checked_size(layout: &AtlasLayout) -> Option<[u32; 2]> {
    let apron = layout.apron.checked_mul(2)?;
    let sizes = [Some(layout.x.size), layout.y.as_ref().map(|y| y.size)];
    if layout.columns == 0 || layout.tiles == 0 || sizes.iter().flatten().any(|&size| size < 2) {
        return None;
    }
    let header = layout.base.header_texels();
    let width = layout.x.size.checked_add(apron)?.checked_add(header)?.checked_mul(layout.columns)?;
    let tile_height = layout.y.as_ref().map_or(Some(1), |y| y.size.checked_add(apron))?;
    let height = tile_height.checked_mul(layout.tiles.div_ceil(layout.columns))?;
    Some([width, height])
}
