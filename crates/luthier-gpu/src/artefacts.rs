use std::path::Path;

use luthier_lut::{Image, TableKind, TexelFormat};
use luthier_manifest::{Form, Manifest, MapEntry, MapSlot, Target};
use luthier_texture::BakeFolder;

use crate::GpuError;

/// Parts of a bake that the runtime needs: the manifest, the texels of its tables, the text of its WGSL shaders.
#[derive(Debug, Clone, PartialEq)]
pub struct Artefacts {
    /// Manifest of the bake.
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
    /// Quantity that the map varies.
    pub slot: MapSlot,
    /// The layer that it is of; `None` for those of the whole surface.
    pub layer: Option<u32>,
    /// RGBA, linear.
    pub image: Image,
}

/// The texels of a table as they ship.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableTexels {
    /// Kind of the table.
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
    /// How it evaluates a material.
    pub form: Form,
    /// The text.
    pub wgsl: String,
}

impl Artefacts {
    /// Loads a bake from its folder: `manifest.json`, then the textures, WGSL shaders and maps that it names.
    ///
    /// # Errors
    /// [`GpuError::Folder`] when a file is missing, damaged, from another bake or outside the folder; those of [`Artefacts::from_parts`].
    pub fn load(folder: &Path) -> Result<Self, GpuError> {
        Self::read(&BakeFolder::open(folder)?)
    }

    /// Loads a bake from a folder whose manifest has been read.
    ///
    /// # Errors
    /// As [`Artefacts::load`].
    pub fn read(folder: &BakeFolder) -> Result<Self, GpuError> {
        let manifest = folder.manifest();
        let mut tables = Vec::with_capacity(manifest.tables.len());
        for entry in &manifest.tables {
            let luthier_texture::Texture { format, width, height, bytes } = folder.texture(entry)?;
            tables.push(TableTexels { kind: entry.kind, format, width, height, bytes });
        }
        let mut shaders = Vec::new();
        for entry in manifest.shaders.iter().filter(|s| s.target == Target::Wgsl) {
            shaders.push(WgslShader { form: entry.form, wgsl: folder.text(&entry.file)? });
        }
        Self::from_parts(manifest.clone(), tables, shaders)?.with_maps(|map| Ok(folder.map(map)?))
    }

    /// The artefacts with the maps that the manifest lists; `image` gives one, RGBA.
    ///
    /// # Errors
    /// Those of `image`.
    pub fn with_maps(mut self, image: impl Fn(&MapEntry) -> Result<Image, GpuError>) -> Result<Self, GpuError> {
        self.maps.clear();
        for (material, entry) in self.manifest.materials.iter().enumerate() {
            for map in &entry.maps {
                let (slot, layer, image) = (map.slot, map.layer, image(map)?);
                self.maps.push(MapTexels { material: material as u32, slot, layer, image });
            }
        }
        Ok(self)
    }

    /// Artefacts from parts in memory, without maps. Tables may come in any order.
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
            entry.check([table.width, table.height], table.format, table.bytes.len())?;
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
    pub fn shader(&self, form: Form) -> Result<&WgslShader, GpuError> {
        self.shaders.iter().find(|s| s.form == form).ok_or_else(|| GpuError::NoShader {
            form,
            known: self.shaders.iter().map(|s| s.form.name()).collect::<Vec<_>>().join(", "),
        })
    }
}
